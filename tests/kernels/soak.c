/* SPDX-License-Identifier: MIT
 *
 * soak.c - random and hard pairs of all families without end: overlaps, contacts and manifolds beside the reference, and
 * all queries on every instruction set, byte for byte. An interrupt ends it, or NARC_SOAK_SECONDS; it begins with round
 * NARC_SOAK_ROUND, and NARC_SOAK_MOVES=0 leaves the instruction sets out, which takes a seventh of the time. Each minute it
 * prints how far it is; the first pairs that are wrong in full, and then its status is 1.
 */
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "check.h"
#include "corpus.h"
#include "everywhere.h"
#include "narc.h"
#include "placements.h"
#include "ray_reference.h"

/* The pairs of a call, and what is asked of a part of their bodies, which takes longer. */
enum { PAIRS = 4096, CASTS = 256, SCENE = 64, RAYS = 512 };

/* How often the bodies of a scene move, and are asked of everywhere again, per comparison with the reference. */
static size_t moves = 10;

/* How many wrong pairs are shown. */
enum { SHOWN = 10 };

/* Of so many pairs one is searched for its separation, which takes ten times as long as to solve for it. */
enum { SEARCHED = 64 };

struct report {
    struct contact_summary contacts[ALL_FAMILIES];
    struct manifold_summary manifolds[ALL_FAMILIES];
    uint64_t pairs, searched, moved, casts, rays, points, wrong;
    size_t round;
    double unlike; /* between solving and searching, as a fraction of the bound */
};

static volatile sig_atomic_t interrupted;

static void interrupt(int number) {
    (void)number;
    interrupted = 1;
}

static void print_report(const struct report *report) {
    printf("%" PRIu64 " pairs beside the reference, of these %" PRIu64 " by search, %.2g of the bound apart\n",
           report->pairs, report->searched, report->unlike);
    printf("on every instruction set: %" PRIu64 " pairs; %" PRIu64 " casts, %" PRIu64 " rays, %" PRIu64 " points\n",
           report->moved, report->casts, report->rays, report->points);
    printf("wrong: %" PRIu64 "; next round: %zu\n", report->wrong, report->round);
}

static void print_table(const struct report *report) {
    printf("%-10s %11s %10s %9s %10s %6s %6s %8s %9s   (largest errors, as fractions of what is allowed)\n", "",
           "pairs", "colliding", "in band", "separation", "normal", "point", "manifold", "doubtful");
    for (size_t k = 0; k < ALL_FAMILIES; k++) {
        const struct contact_summary *const row = &report->contacts[k];
        printf("%-10s %11zu %10zu %9zu %10.3f %6.3f %6.3f %8.3f %9zu\n", any_family_name(k), row->pairs, row->colliding,
               row->inside_band, row->worst.separation, row->worst.normal, row->worst.point, report->manifolds[k].worst,
               report->manifolds[k].doubtful);
    }
}

/* ------------------------------------------------------------------------------------------------ the reference */

/* What is wrong with pair k, or NULL. */
static const char *check_exact(struct corpus *corpus, size_t k, bool overlap, const narc_contact *contact,
                               const narc_manifold *manifold, struct report *report) {
    const struct scene *const scene = &corpus->scene;
    struct exact_pair *const pair = &corpus->pairs[k];
    pair->a = scene_reference(scene, scene->pairs[k].a);
    pair->b = scene_reference(scene, scene->pairs[k].b);
    pair->gap = reference_solve_gap(&pair->a, &pair->b).gap;
    const double bound = separation_bound(&pair->a, &pair->b);
    if (report->pairs++ % SEARCHED == 0) {
        report->searched++;
        const double unlike = fabs(reference_find_gap(&pair->a, &pair->b).gap - pair->gap) / bound;
        report->unlike = fmax(report->unlike, unlike);
        if (!(unlike <= 1e-3))
            return "solution, by search";
    }
    struct fractions errors = {0};
    struct manifold_summary tally = {0};
    const char *wrong = check_answer(&pair->a, &pair->b, pair->gap, k, overlap, contact, &errors);
    wrong = wrong ? wrong : check_manifold(&pair->a, &pair->b, contact, manifold, &tally);
    for (int side = 0; side < 2; side++) {
        const size_t kind = side ? pair->kind_b : pair->kind_a;
        count_pair(&report->contacts[kind], pair->gap, bound, &errors);
        report->manifolds[kind].worst = fmax(report->manifolds[kind].worst, tally.worst);
        report->manifolds[kind].doubtful += tally.doubtful;
    }
    return wrong;
}

static void check_reference(struct corpus *corpus, struct report *report) {
    uint64_t *const bits = scene_overlaps(&corpus->scene);
    struct contacts contacts = scene_contacts(&corpus->scene, INFINITY);
    struct manifolds manifolds = scene_manifolds(&corpus->scene, INFINITY);
    for (size_t k = 0; k < corpus->scene.pair_count; k++) {
        const bool overlap = bit_is_set(bits, k);
        const narc_manifold *const m = &manifolds.rows[k];
        const char *const wrong = check_exact(corpus, k, overlap, &contacts.rows[k], m, report);
        if (wrong && report->wrong++ < SHOWN) {
            const struct exact_pair *const pair = &corpus->pairs[k];
            print_error("round %zu: %s - %s, %s: wrong %s\n", report->round, any_family_name(pair->kind_a),
                        any_family_name(pair->kind_b), pair->place, wrong);
            print_answer(&pair->a, &pair->b, pair->gap, overlap, &contacts.rows[k]);
            for (size_t i = 0; i < m->count; i++)
                print_error("  point %zu of the manifold: (%.9g, %.9g), separation %.9g, feature %04x\n", i,
                            (double)m->point[i].x, (double)m->point[i].y, (double)m->point[i].separation,
                            m->point[i].feature);
        }
    }
    free(bits);
    free(contacts.rows);
    free(manifolds.rows);
}

/* ------------------------------------------------------------------------------------------------ everywhere */

struct motion {
    float x, y, angle;
};

/* A part of a corpus: pairs of two bodies each. */
struct question {
    struct scene scene;
    narc_query query;
    narc_cast_options cast;
    narc_inside inside;
    narc_index *index;
    uint32_t hints[PAIRS], numbers[PAIRS];
    struct motion motions[2 * PAIRS];
    struct test_ray rays[RAYS], points[PAIRS]; /* points are where rays begin */
};

struct answer {
    uint64_t bits[PAIRS / 64];
    uint32_t hints[PAIRS];
    narc_contact contacts[PAIRS];
    narc_manifold manifolds[PAIRS];
    narc_impact impacts[CASTS], first[SCENE];
    narc_ray_hit hits[RAYS];
    narc_distance distances[PAIRS], nearest[2 * SCENE];
    size_t counts[2], skipped[4];
};

/* Where an answer's rows begin, to tell which one differs. Those of pairs go on with the pair's number. */
static const struct {
    const char *name;
    size_t begin, row;
    bool of_pairs;
} rows[] = {
    {"overlaps", offsetof(struct answer, bits), 8, false},
    {"hints", offsetof(struct answer, hints), sizeof(uint32_t), true},
    {"contacts", offsetof(struct answer, contacts), sizeof(narc_contact), true},
    {"manifolds", offsetof(struct answer, manifolds), sizeof(narc_manifold), true},
    {"casts of pairs", offsetof(struct answer, impacts), sizeof(narc_impact), true},
    {"casts of shapes", offsetof(struct answer, first), sizeof(narc_impact), false},
    {"rays", offsetof(struct answer, hits), sizeof(narc_ray_hit), false},
    {"distances", offsetof(struct answer, distances), sizeof(narc_distance), true},
    {"nearest bodies", offsetof(struct answer, nearest), sizeof(narc_distance), false},
    {"counts", offsetof(struct answer, counts), sizeof(size_t), false},
};

/* The first bodies of a question alone, and as many pairs. */
static struct scene take_bodies(const struct scene *scene, size_t bodies, size_t pairs) {
    struct scene part = *scene;
    part.body_count = bodies;
    part.pair_count = pairs;
    return part;
}

static void ask(const void *question, const narc_workers *workers, void *out_answer) {
    const struct question *const q = question;
    struct answer *const answer = out_answer;
    const narc_shapes *const store = q->scene.store;
    const struct scene part = take_bodies(&q->scene, SCENE, CASTS);
    const narc_bodies bodies = scene_bodies(&q->scene), few = scene_bodies(&part);
    const narc_pairs pairs = scene_pairs(&q->scene), cast_pairs = scene_pairs(&part);
    const size_t count = pairs.count;
    const narc_rays rays = view_rays(q->rays, RAYS), points = view_rays(q->points, count);
    const narc_points all_points = {.count = count, .x = points.x, .y = points.y},
                      few_points = {.count = SCENE, .x = points.x, .y = points.y};
    const narc_motions motions = {
        NARC_COLUMN(q->motions, x), NARC_COLUMN(q->motions, y), NARC_COLUMN(q->motions, angle), {NULL}};
    const narc_index_query search = {.workers = workers};
    narc_query query = q->query;
    narc_cast_options cast = q->cast;
    memset(answer, 0, sizeof *answer);
    memcpy(answer->hints, q->hints, sizeof answer->hints);
    query.workers = cast.workers = workers;
    query.out_skipped = &answer->skipped[0];
    assert_int_equal(narc_find_overlaps(store, &bodies, &pairs, &query, answer->bits, NULL), NARC_OK);
    query.hints = hint_column(answer->hints);
    query.out_skipped = &answer->skipped[1];
    assert_int_equal(
        narc_find_contacts(store, &bodies, &pairs, &query, answer->contacts, PAIRS, &answer->counts[0], NULL), NARC_OK);
    assert_int_equal(
        narc_find_manifolds(store, &bodies, &pairs, &query, answer->manifolds, PAIRS, &answer->counts[1], NULL),
        NARC_OK);
    assert_int_equal(
        narc_find_distances(store, &bodies, &all_points, NARC_ARRAY(q->numbers), workers, answer->distances, NULL),
        NARC_OK);
    cast.out_skipped = &answer->skipped[2];
    assert_int_equal(narc_cast_pairs(store, &bodies, &motions, &cast_pairs, NULL, &cast, answer->impacts, CASTS, NULL),
                     NARC_OK);
    cast.out_skipped = &answer->skipped[3];
    assert_int_equal(
        narc_cast_shapes(q->index, store, &few, &few, &motions, &search, &cast, answer->first, SCENE, NULL), NARC_OK);
    const narc_ray_options through = {.search = search, .inside = q->inside};
    assert_int_equal(narc_cast_rays(q->index, store, &few, &rays, &through, answer->hits, RAYS, NULL), NARC_OK);
    const narc_nearest_options near = {.search = search, .distance = 5, .most = 2};
    assert_int_equal(narc_find_nearest(q->index, store, &few, &few_points, &near, answer->nearest, 2 * SCENE, NULL),
                     NARC_OK);
}

static void show(const struct question *q, const struct difference *difference) {
    size_t k = sizeof rows / sizeof *rows - 1;
    while (rows[k].begin > difference->at)
        k--;
    const size_t row = (difference->at - rows[k].begin) / rows[k].row;
    print_error(
        "%s answers otherwise than %s: %s, row %zu; margins %a and %a, flat angle %a, target %a, %s positions\n",
        difference->isa, difference->first, rows[k].name, row, (double)q->query.margin, (double)q->query.second_margin,
        (double)q->query.flat_angle, (double)q->cast.target, q->scene.precision == NARC_FLOAT32 ? "single" : "double");
    if (rows[k].of_pairs) {
        const struct reference_body a = scene_reference(&q->scene, q->scene.pairs[row].a);
        const struct reference_body b = scene_reference(&q->scene, q->scene.pairs[row].b);
        const struct motion *const motion = &q->motions[2 * row];
        print_pair(&a, &b);
        print_error("  hint %08" PRIx32 ", point (%a, %a), motions (%a, %a, %a) and (%a, %a, %a)\n", q->hints[row],
                    q->points[row].x, q->points[row].y, (double)motion[0].x, (double)motion[0].y,
                    (double)motion[0].angle, (double)motion[1].x, (double)motion[1].y, (double)motion[1].angle);
    }
}

/* What is asked besides the pairs: casts that come as far as the other body, points near outlines, where contacts are. */
static void fill(struct test_random *random, struct question *q) {
    static const float margins[] = {0, 0.25f, -0.1f, INFINITY};
    const struct scene *const scene = &q->scene;
    const struct scene part = take_bodies(scene, SCENE, 0);
    const narc_bodies few = scene_bodies(&part);
    const struct contacts contacts = scene_contacts(scene, INFINITY);
    narc_box boxes[SCENE];
    q->query = (narc_query){.margin = margins[random_below(random, 4)],
                            .second_margin = (float)random_between(random, -0.1, 0.1),
                            .flat_angle = random_below(random, 2) ? 0 : (float)random_between(random, 0, 1.5),
                            .dense = 1};
    q->cast = (narc_cast_options){.target = random_below(random, 2) ? 0 : (float)random_between(random, -0.1, 0.1)};
    q->inside = (narc_inside)random_below(random, 3);
    for (size_t k = 0; k < scene->pair_count; k++) {
        const struct body *const a = &scene->bodies[2 * k], *const b = a + 1;
        const double far = random_unit(random);
        q->numbers[k] = (uint32_t)(2 * k + k % 2);
        q->points[k] = (struct test_ray){.x = a->x + (double)contacts.rows[k].point_x * far,
                                         .y = a->y + (double)contacts.rows[k].point_y * far};
        q->motions[2 * k] = (struct motion){(float)(b->x - a->x), (float)(b->y - a->y), 0};
        q->motions[2 * k + 1] = (struct motion){0, 0, k % 4 ? 0 : (float)random_between(random, -3, 3)};
    }
    for (size_t k = 0; k < RAYS; k++) {
        const struct body *const body = &scene->bodies[k % SCENE];
        q->rays[k] = make_ray(random, &scene->shapes[body->shape], body, scene->precision,
                              (enum ray_kind)random_below(random, RAY_KINDS));
    }
    q->index = index_bodies(scene->store, &few, NULL, boxes);
    free(contacts.rows);
}

/* The pairs from `first` on: pair k of a corpus is of the bodies 2 k and 2 k + 1. Their hints go on to the next time. */
static void compare_part(struct test_random *random, const struct scene *scene, size_t first, uint32_t *hints,
                         struct report *report) {
    static struct question q;
    struct difference difference;
    const size_t left = scene->pair_count - first, count = left < PAIRS ? left : PAIRS;
    q.scene = take_bodies(scene, 2 * count, count);
    q.scene.bodies += 2 * first;
    memcpy(q.hints, hints + first, count * sizeof *hints);
    fill(random, &q);
    struct answer *const answer = ask_everywhere(ask, &q, sizeof *answer, &difference);
    memcpy(hints + first, answer->hints, count * sizeof *hints);
    free(answer);
    narc_destroy_index(q.index);
    report->moved += count;
    report->casts += CASTS + SCENE;
    report->rays += RAYS;
    report->points += count + SCENE;
    if (difference.isa && report->wrong++ < SHOWN) {
        print_error("round %zu: ", report->round);
        show(&q, &difference);
    }
}

static void compare_everywhere(struct test_random *random, struct scene *scene, struct report *report) {
    uint32_t *const hints = create_hints(scene->pair_count);
    for (size_t move = 0; move < moves; move++) {
        for (size_t first = 0; first + CASTS <= scene->pair_count; first += PAIRS)
            compare_part(random, scene, first, hints, report);
        scene_move_bodies(scene, random, random_log_between(random, 1e-7, 0.1));
    }
    free(hints);
}

/* ------------------------------------------------------------------------------------------------ without end */

static void soak(struct report *report) {
    char name[32];
    snprintf(name, sizeof name, "soak %zu", report->round);
    struct corpus corpus = make_corpus(name, report->round % 2 ? NARC_FLOAT64 : NARC_FLOAT32, 1, false);
    struct test_random random = test_random_named(name);
    check_reference(&corpus, report);
    compare_everywhere(&random, &corpus.scene, report);
    destroy_corpus(&corpus);
}

int main(void) {
    static struct report report;
    const char *const seconds = getenv("NARC_SOAK_SECONDS"), *const first = getenv("NARC_SOAK_ROUND"),
                      *const wanted_moves = getenv("NARC_SOAK_MOVES");
    const time_t start = time(NULL);
    const double most = seconds ? strtod(seconds, NULL) : INFINITY;
    double told = 0, passed;
    if (!test_begin())
        return TEST_SKIPPED;
    signal(SIGINT, interrupt);
    signal(SIGTERM, interrupt);
    report.round = first ? strtoul(first, NULL, 10) : 0;
    moves = wanted_moves ? strtoul(wanted_moves, NULL, 10) : moves;
    do {
        soak(&report);
        report.round++;
        passed = difftime(time(NULL), start);
        if (passed - told >= 60) {
            print_report(&report);
            told = passed;
        }
    } while (!interrupted && passed < most);
    print_table(&report);
    print_report(&report);
    return report.wrong ? EXIT_FAILURE : EXIT_SUCCESS;
}
