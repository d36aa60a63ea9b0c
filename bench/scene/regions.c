/* SPDX-License-Identifier: MIT
 *
 * regions.c - regions beside Box2D and Chipmunk, in batches and one by one; builds and refits of an index; and a step
 * with still scenery, all bodies by the broad phase or an index of what stands still. Settled piles and sparse scenes of
 * polygons. What is compared takes turns within one process.
 *
 *     bench_regions [--bodies=1000 and 30000] [--regions=10000] [--rounds=7]
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "common.h"
#include "narc_broad_phase.h"
#include "own.h"
#include "peers.h"
#include "random.h"
#include "scenes.h"

enum { MOST_ROUNDS = 100, STEPS = 10, MOST_FOUND = 200 /* of a region, in the mean */ };

struct setting {
    size_t bodies, regions, rounds;
};

/* Appends pairs as keys a << 32 | b, of bodies that begin at first_a and first_b. */
static size_t add_keys(const narc_pairs *pairs, uint64_t first_a, uint64_t first_b, uint64_t *keys, size_t count) {
    const uint32_t *const a = pairs->a.base, *const b = pairs->b.base;
    for (size_t k = 0; k < pairs->count; k++)
        keys[count++] = (first_a + a[k]) << 32 | (first_b + b[k]);
    return count;
}

static int compare_keys(const void *left, const void *right) {
    const uint64_t l = *(const uint64_t *)left, r = *(const uint64_t *)right;
    return (l > r) - (l < r);
}

/* How many keys only one of the two has. Sorts both. */
static size_t count_differences(uint64_t *left, size_t left_count, uint64_t *right, size_t right_count) {
    size_t differences = 0, l = 0, r = 0;
    qsort(left, left_count, sizeof *left, compare_keys);
    qsort(right, right_count, sizeof *right, compare_keys);
    while (l < left_count && r < right_count) {
        differences += left[l] != right[r];
        const bool next_left = left[l] <= right[r], next_right = right[r] <= left[l];
        l += next_left;
        r += next_right;
    }
    return differences + (left_count - l) + (right_count - r);
}

static void find_medians(double ns[][MOST_ROUNDS], size_t rounds, size_t ways, double *out) {
    for (size_t way = 0; way < ways; way++)
        out[way] = quantile(ns[way], rounds, 0.5);
}

/* ------------------------------------------------------------------------------------------------ regions */

/* Squares that meet so many boxes in the mean, were these everywhere as dense. */
static void make_regions(const struct own *own, double found, narc_box *regions, size_t count) {
    const size_t bodies = own->bodies.count;
    uint64_t random = 79;
    double width = 0;
    for (size_t k = 0; k < bodies; k++)
        width += (double)(own->boxes[k].max_x - own->boxes[k].min_x) / (double)bodies;
    const double size = fmax(0, 2 * own->half * sqrt(found / (double)bodies) - width);
    for (size_t k = 0; k < count; k++) {
        const double x = random_between(&random, -own->half, own->half - size);
        const double y = random_between(&random, -own->half, own->half - size);
        regions[k] = (narc_box){(float)x, (float)y, (float)(x + size), (float)(y + size)};
    }
}

/* So many regions in a call; the pairs of the last one. */
static narc_pairs find_own(narc_index *index, const narc_box *regions, size_t count, size_t batch) {
    narc_pairs pairs = {0};
    narc_error error;
    for (size_t k = 0; k < count; k += batch)
        must(narc_query_index(index, regions + k, batch, NULL, &pairs, &error), &error);
    return pairs;
}

static void compare_regions(const struct setting *s, const char *name, const struct own *own, void *tree, void *space,
                            double found) {
    enum { BATCH, ONE_BY_ONE, BOX2D, CHIPMUNK, WAYS };
    narc_box *const regions = allocate(s->regions, sizeof *regions);
    uint64_t *keys[3];
    size_t counts[3] = {0}; /* this library's, Box2D's, Chipmunk's */
    for (int k = 0; k < 3; k++)
        keys[k] = allocate(MOST_FOUND * s->regions, sizeof *keys[k]);
    double ns[WAYS][MOST_ROUNDS], median[WAYS];
    make_regions(own, found, regions, s->regions);
    for (size_t round = 0; round < s->rounds; round++)
        for (int way = 0; way < WAYS; way++) {
            const double start = now();
            if (way == BOX2D)
                counts[1] = box2d_find_regions(tree, regions, s->regions, keys[1]);
            else if (way == CHIPMUNK)
                counts[2] = chipmunk_find_regions(space, regions, s->regions, keys[2]);
            else
                find_own(own->index, regions, s->regions, way == BATCH ? s->regions : 1);
            ns[way][round] = (now() - start) / (double)s->regions;
        }
    find_medians(ns, s->rounds, WAYS, median);
    const narc_pairs pairs = find_own(own->index, regions, s->regions, s->regions);
    counts[0] = add_keys(&pairs, 0, 0, keys[0], 0);
    const size_t box2d = count_differences(keys[0], counts[0], keys[1], counts[1]);
    const size_t chipmunk = count_differences(keys[0], counts[0], keys[2], counts[2]);
    printf("| %zu %s | %.1f | %.0f | %.0f | %.0f (%.1f, %.1f) | %.0f (%.1f, %.1f) | %zu, %zu |\n", own->bodies.count,
           name, (double)counts[0] / (double)s->regions, median[BATCH], median[ONE_BY_ONE], median[BOX2D],
           median[BOX2D] / median[BATCH], median[BOX2D] / median[ONE_BY_ONE], median[CHIPMUNK],
           median[CHIPMUNK] / median[BATCH], median[CHIPMUNK] / median[ONE_BY_ONE], box2d, chipmunk);
    fflush(stdout);
    for (int k = 0; k < 3; k++)
        free(keys[k]);
    free(regions);
}

/* ------------------------------------------------------------------------------------------------ builds */

/* Several threads' time: the clock on the wall, in ns. */
static double read_clock(void) {
    struct timespec time;
    timespec_get(&time, TIME_UTC);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

/* The least time of all rounds: that in which the machine had two cores to give. */
static void compare_builds(const struct setting *s, const char *name, const struct own *own) {
    enum { GOOD, FAST, REFIT, WAYS };
    const size_t count = own->bodies.count;
    const narc_workers two = narc_openmp_workers(2);
    double ns[2 * WAYS][MOST_ROUNDS];
    for (size_t round = 0; round < s->rounds; round++)
        for (int way = 0; way < 2 * WAYS; way++) { /* by one worker, and by two */
            const narc_index_options options = {.fast = way / 2 == FAST, .workers = way % 2 ? &two : NULL};
            const double start = read_clock();
            must(way / 2 == REFIT ? narc_refit_index(own->index, own->boxes, count, &options, NULL, NULL)
                                  : narc_build_index(own->index, own->boxes, count, &options, NULL),
                 NULL);
            ns[way][round] = (read_clock() - start) / (double)count;
        }
    printf("| %zu %s", count, name);
    for (int way = 0; way < 2 * WAYS; way += 2) {
        const double one = quantile(ns[way], s->rounds, 0), by_two = quantile(ns[way + 1], s->rounds, 0);
        printf(" | %.1f, %.1f (%.1f)", one, by_two, one / by_two);
    }
    printf(" |\n");
    fflush(stdout);
}

/* ------------------------------------------------------------------------------------------------ steps */

/* Every eleventh body moves; those stand behind the others. */
struct moving {
    const narc_shapes *shapes;
    struct body *all;
    uint8_t *kinds;
    narc_box *boxes;
    size_t still, count;
    narc_index *index;
    narc_broad_phase *broad_all, *broad_moving;
};

static struct moving make_moving(const struct own *own) {
    const size_t count = own->bodies.count, moving = count / 11;
    struct moving m = {.shapes = own->scene->shapes, .still = count - moving, .count = moving, .index = own->index};
    m.all = allocate(count, sizeof *m.all);
    m.kinds = allocate(count, 1);
    m.boxes = allocate(m.still, sizeof *m.boxes); /* first of what stands still */
    size_t still = 0, end = m.still;
    for (size_t k = 0; k < count; k++)
        m.all[k % 11 == 10 ? end++ : still++] = own->scene->bodies[k];
    for (size_t k = 0; k < m.still; k++)
        m.kinds[k] = NARC_STATIC;
    const narc_bodies scenery = bodies_of(m.all, m.still);
    must(narc_compute_boxes(m.shapes, &scenery, NULL, m.boxes, NULL), NULL);
    must(narc_build_index(m.index, m.boxes, m.still, NULL, NULL), NULL);
    must(narc_create_broad_phase(NULL, &m.broad_all), NULL);
    must(narc_create_broad_phase(NULL, &m.broad_moving), NULL);
    return m;
}

/* All by the broad phase. */
static void step_all(const struct moving *m, float skin, const narc_pair_list **list) {
    const narc_bodies bodies = bodies_of(m->all, m->still + m->count);
    const narc_pair_filter filter = {.kind = {m->kinds, 1}};
    const narc_pair_options options = {.skin = skin, .filter = &filter};
    narc_error error;
    must(narc_update_pairs(m->broad_all, m->shapes, &bodies, &options, list, &error), &error);
}

/* What moves by the broad phase, and against the index. */
static void step_moving(const struct moving *m, float skin, const narc_pair_list **list, narc_pairs *still) {
    const narc_bodies bodies = bodies_of(m->all + m->still, m->count);
    const narc_pair_options options = {.skin = skin};
    narc_error error;
    must(narc_compute_boxes(m->shapes, &bodies, NULL, m->boxes, &error), &error);
    must(narc_query_index(m->index, m->boxes, m->count, NULL, still, &error), &error);
    must(narc_update_pairs(m->broad_moving, m->shapes, &bodies, &options, list, &error), &error);
}

/* Bodies are some 2 in size, and move by up to 0.02 in a step, each in its direction; in every other round back. */
static void compare_steps(const struct setting *s, const char *name, size_t bodies, double spread, float skin) {
    const struct own own = make_own(FAMILY_POLYGONS, bodies / 10 * 11, spread);
    const struct moving m = make_moving(&own);
    const narc_pair_list *all = NULL, *moving = NULL;
    narc_pairs still = {0};
    double us[2][MOST_ROUNDS], median[2];
    step_all(&m, skin, &all);
    step_moving(&m, skin, &moving, &still);
    for (size_t round = 0; round < s->rounds; round++) {
        us[0][round] = us[1][round] = 0;
        for (int step = 0; step < STEPS; step++) {
            uint64_t random = 80;
            const double way = round % 2 ? -1 : 1;
            for (struct body *body = m.all + m.still; body < m.all + m.still + m.count; body++) {
                body->x += (float)(way * random_between(&random, -0.02, 0.02));
                body->y += (float)(way * random_between(&random, -0.02, 0.02));
            }
            const double start = now();
            step_all(&m, skin, &all);
            const double between = now();
            step_moving(&m, skin, &moving, &still);
            us[1][round] += (now() - between) / (1000 * STEPS);
            us[0][round] += (between - start) / (1000 * STEPS);
        }
    }
    find_medians(us, s->rounds, 2, median);
    const size_t most = all->pairs.count, room = still.count + moving->pairs.count;
    uint64_t *const left = allocate(most + 1, sizeof *left), *const right = allocate(room + 1, sizeof *right);
    const size_t left_count = add_keys(&all->pairs, 0, 0, left, 0);
    const narc_pairs turned = {.count = still.count, .a = still.b, .b = still.a};
    const size_t still_count = add_keys(&turned, 0, m.still, right, 0);
    const size_t right_count = add_keys(&moving->pairs, m.still, m.still, right, still_count);
    printf("| %zu, %zu %s | %.1f | %.0f | %.0f | %.1f | %zu, %zu | ", m.still, m.count, name, (double)skin, median[0],
           median[1], median[0] / median[1], left_count, right_count);
    if (skin > 0) /* kept boxes are larger, and not the same in both */
        printf(" |\n");
    else
        printf("%zu |\n", count_differences(left, left_count, right, right_count));
    fflush(stdout);
    free(left);
    free(right);
    narc_destroy_broad_phase(m.broad_all);
    narc_destroy_broad_phase(m.broad_moving);
}

/* ------------------------------------------------------------------------------------------------ tables */

int main(int argc, char **argv) {
    struct setting s = {0, 10000, 7};
    for (int k = 1; k < argc; k++) {
        const char *const bodies = option_value(argv[k], "--bodies="), *const rounds =
                                                                           option_value(argv[k], "--rounds=");
        const char *const regions = option_value(argv[k], "--regions=");
        if (!bodies && !regions && !rounds)
            fail("%s: unknown; see the head of regions.c", argv[k]);
        size_t *const value = bodies ? &s.bodies : regions ? &s.regions : &s.rounds;
        *value = strtoul(bodies ? bodies : regions ? regions : rounds, NULL, 10);
    }
    if (s.rounds < 1 || s.rounds > MOST_ROUNDS || s.regions < 1 || (s.bodies > 0 && s.bodies < 100))
        fail("--rounds=1 .. %d, --regions=1 or more, --bodies=100 or more", MOST_ROUNDS);
    const size_t sizes[] = {s.bodies ? s.bodies : 1000, 30000}, scene_count = s.bodies ? 2 : 4;
    static const char *const names[] = {"pile", "sparse"};
    static const double spreads[] = {1, 3};
    printf("%s, %s, %s; one thread\n\n", processor_name(), compiler_name, choose_best_isa());
    struct own own[4];
    printf("| Scene, ns a region | Found | Batch | one by one | Box2D (times batch, one by one) | Chipmunk | Differ |\n"
           "| --- | --- | --- | --- | --- | --- | --- |\n");
    for (size_t k = 0; k < scene_count; k++) {
        own[k] = make_own(FAMILY_POLYGONS, sizes[k / 2], spreads[k % 2]);
        void *const tree = box2d_create_tree(own[k].boxes, own[k].bodies.count);
        void *const space = chipmunk_scene.create(own[k].scene);
        compare_regions(&s, names[k % 2], &own[k], tree, space, 48);
        compare_regions(&s, names[k % 2], &own[k], tree, space, 3);
    }
    printf("\n| Scene, ns a box by one worker, two (times) | Good | Fast | Refit |\n| --- | --- | --- | --- |\n");
    for (size_t k = 0; k < scene_count; k++)
        compare_builds(&s, names[k % 2], &own[k]);
    printf(
        "\n| Still, moving; us a step | Skin | All by the broad phase | Index of what stands still | Times | Pairs | "
        "Differ |\n| --- | --- | --- | --- | --- | --- | --- |\n");
    for (size_t k = 0; k < 2 * scene_count; k++)
        compare_steps(&s, names[k / 2 % 2], sizes[k / 4], spreads[k / 2 % 2], k % 2 ? 0.2f : 0);
    return 0;
}
