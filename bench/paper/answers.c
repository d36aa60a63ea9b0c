/* SPDX-License-Identifier: MIT
 *
 * answers.c - how often the methods are wrong: random pairs of several families of shapes, against the exact answer
 * (method sat).
 *
 * The second body of a pair is anywhere where the axis-aligned boxes of both overlap, all places equally likely: what a
 * broad phase hands on.
 */
#include <math.h>
#include <stdlib.h>

#include "paper.h"
#include "random.h"
#include "store.h"

enum { SHAPES = 512, METHODS = 3 };

static const narc_method methods[METHODS] = {NARC_METHOD_SAT_FIRST, NARC_METHOD_GJK, NARC_METHOD_POLYGON_SAT};

/* A separation further than this from the exact one, in parts of the sum of both bounding radii, is wrong. */
static const double much = 1e-3;

/* A normal further than this from the exact one, in radians, is another one. */
static const double another_normal = 0.1;

struct count {
    size_t false_hits, missed;
    size_t outcomes[4];                 /* of overlaps */
    size_t distance_wrong, depth_wrong; /* by more than `much` */
    double distance_worst, depth_worst; /* the largest error */
    size_t normal_wrong;                /* of pairs that collide, and for the method too */
    size_t contact_outcomes[4], broken; /* answers that are not what narc_methods.h promises */
};

struct counts {
    size_t pairs, apart, colliding, near;
    struct count of[METHODS];
};

/* A chunk of pairs and all that is known of it. */
struct chunk {
    size_t count;
    struct body *bodies;
    uint64_t *bits;
    uint8_t *outcomes;
    narc_contact *exact, *found;
};

/* ------------------------------------------------------------------------------------------------ pairs */

static struct shapes make_shapes(enum family family, uint64_t *random) {
    struct shapes made = make_store(SHAPES);
    for (size_t k = 0; k < SHAPES; k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        const size_t count = make_shape(family, random, arcs);
        add_arcs(&made, arcs, count);
    }
    finish_store(&made);
    return made;
}

static void place_pairs(const struct shapes *made, struct chunk *chunk, uint64_t *random) {
    for (size_t k = 0; k < chunk->count; k++) {
        struct body *pair = &chunk->bodies[2 * k];
        pair[0] = random_body(random, random_below(random, SHAPES), 0);
        pair[1] = random_body(random, random_below(random, SHAPES), 0);
        put_in_boxes(made->shapes, &pair[0], &pair[1], random);
    }
}

/* ------------------------------------------------------------------------------------------------ counting */

/* What rounding may change of a separation, the unit of errors, and what the store adds to that. */
struct scales {
    double rounding, size, slack;
};

static struct scales scales_of(const struct shapes *made, const struct body *pair) {
    const struct bound *a = &made->bounds[pair[0].shape], *b = &made->bounds[pair[1].shape];
    return (struct scales){rounding_of(made->bounds, pair), size_of(made->bounds, pair),
                           NARC_ROUNDING_ROOM * (a->extent + b->extent)};
}

static void count_overlap(const struct chunk *chunk, size_t k, const struct scales *scales, struct count *count) {
    const double separation = chunk->exact[k].separation;
    const bool hit = chunk->bits[k / 64] >> k % 64 & 1;
    count->outcomes[chunk->outcomes[k]]++;
    if (fabs(separation) <= scales->rounding)
        return;
    count->false_hits += hit && separation > 0;
    count->missed += !hit && separation < 0;
}

/* Is the separation told what narc_methods.h says of it? GJK: the gap along the normal, so at most the exact one, and
 * if it ended well at least that less the tolerance; the library's bounding radii have their slack on top. Polygons'
 * SAT: exact if they collide, else positive and at most exact. All but for the rounding of both. */
static bool is_as_promised(narc_method method, double exact, double told, uint8_t outcome,
                           const struct scales *scales) {
    const double rounding = 2 * scales->rounding;
    const double tolerance = (double)NARC_DEFAULT_TOLERANCE * (scales->size + scales->slack);
    switch (method) {
    case NARC_METHOD_GJK:
        return told <= exact + rounding && (outcome != NARC_OUTCOME_DONE || told >= exact - tolerance - rounding);
    case NARC_METHOD_POLYGON_SAT:
        return told <= exact + rounding && told >= fmin(exact, 0) - rounding;
    default:
        return true;
    }
}

/* The separation of a pair, and the normal if both answers are that it collides. */
static void count_contact(const struct chunk *chunk, size_t k, narc_method method, const struct scales *scales,
                          struct count *count) {
    const double exact = chunk->exact[k].separation, told = chunk->found[k].separation;
    const double error = fabs(told - exact) / scales->size;
    const uint8_t outcome = chunk->outcomes[k];
    count->contact_outcomes[outcome]++;
    count->broken += !is_as_promised(method, exact, told, outcome, scales);
    if (isinf(told)) /* no answer: counted as such */
        return;
    if (exact > 0) {
        count->distance_wrong += error > much;
        count->distance_worst = fmax(count->distance_worst, error);
        return;
    }
    count->depth_wrong += error > much;
    count->depth_worst = fmax(count->depth_worst, error);
    if (told >= 0)
        return;
    const narc_contact *a = &chunk->exact[k], *b = &chunk->found[k];
    const double dot = (double)a->normal_x * b->normal_x + (double)a->normal_y * b->normal_y;
    count->normal_wrong += dot < cos(another_normal);
}

static void ask_method(const struct shapes *made, struct chunk *chunk, narc_method method, struct count *count) {
    const narc_bodies bodies = bodies_of(chunk->bodies, 2 * chunk->count);
    const narc_pairs pairs = neighbours(chunk->count);
    const narc_method_options options = {.method = method, .out_outcomes = chunk->outcomes};
    const narc_query query = {.margin = INFINITY, .workers = all_workers()}; /* overlaps have no margin */
    size_t found;
    narc_error error;
    must(narc_find_overlaps_by(made->methods, &bodies, &pairs, &options, &query, chunk->bits, &error), &error);
    for (size_t k = 0; k < chunk->count; k++) {
        const struct scales scales = scales_of(made, &chunk->bodies[2 * k]);
        count_overlap(chunk, k, &scales, count);
    }
    must(narc_find_contacts_by(made->methods, &bodies, &pairs, &options, &query, chunk->found, chunk->count, &found,
                               &error),
         &error);
    for (size_t k = 0; k < chunk->count; k++) {
        const struct scales scales = scales_of(made, &chunk->bodies[2 * k]);
        count_contact(chunk, k, method, &scales, count);
    }
}

/* Straight edges have no arcs for sat-first; polygon-sat takes nothing else. */
static bool takes(narc_method method, enum family family) {
    return method == NARC_METHOD_GJK || (method == NARC_METHOD_POLYGON_SAT) == (family == FAMILY_POLYGON);
}

static struct counts count_family(const struct settings *settings, enum family family, uint64_t *random) {
    struct shapes made = make_shapes(family, random);
    struct counts counts = {0};
    struct chunk chunk = {.bodies = allocate(2 * settings->chunk, sizeof(struct body)),
                          .bits = allocate(NARC_BIT_WORDS(settings->chunk), sizeof(uint64_t)),
                          .outcomes = allocate(settings->chunk, 1),
                          .exact = allocate(settings->chunk, sizeof(narc_contact)),
                          .found = allocate(settings->chunk, sizeof(narc_contact))};
    for (size_t left = settings->answer_pairs; left > 0;) {
        chunk.count = left < settings->chunk ? left : settings->chunk;
        place_pairs(&made, &chunk, random);
        separate(made.shapes, chunk.bodies, chunk.count, chunk.exact);
        for (size_t k = 0; k < chunk.count; k++) {
            const struct scales scales = scales_of(&made, &chunk.bodies[2 * k]);
            const bool near = fabs((double)chunk.exact[k].separation) <= scales.rounding;
            counts.near += near;
            counts.colliding += !near && chunk.exact[k].separation < 0;
            counts.apart += !near && chunk.exact[k].separation > 0;
        }
        for (size_t method = 0; method < METHODS; method++)
            if (takes(methods[method], family))
                ask_method(&made, &chunk, methods[method], &counts.of[method]);
        counts.pairs += chunk.count;
        left -= chunk.count;
    }
    free(chunk.bodies);
    free(chunk.bits);
    free(chunk.outcomes);
    free(chunk.exact);
    free(chunk.found);
    narc_destroy_methods(made.methods);
    narc_destroy_shapes(made.shapes);
    return counts;
}

/* ------------------------------------------------------------------------------------------------ tables */

static void print_part(FILE *out, size_t count, size_t of) {
    fprintf(out, " %zu", count);
    if (count > 0 && of > 0)
        fprintf(out, " (%.2g %%)", 100 * (double)count / (double)of);
    fprintf(out, " |");
}

static void print_overlaps(const struct counts *counts, FILE *out) {
    fprintf(out,
            "\n### Wrong booleans\n\n| family | pairs | apart | colliding | not counted | method | false collisions | "
            "missed collisions | NONE | LIMIT | ROUNDING |\n"
            "| --- | ---: | ---: | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: |\n");
    for (enum family family = 0; family < FAMILIES; family++)
        for (size_t method = 0; method < METHODS; method++) {
            const struct counts *c = &counts[family];
            const struct count *count = &c->of[method];
            if (!takes(methods[method], family))
                continue;
            fprintf(out, "| %s | %zu | %zu | %zu | %zu | %s |", family_names[family], c->pairs, c->apart, c->colliding,
                    c->near, narc_method_name(methods[method]));
            print_part(out, count->false_hits, c->apart);
            print_part(out, count->missed, c->colliding);
            fprintf(out, " %zu | %zu | %zu |\n", count->outcomes[NARC_OUTCOME_NONE],
                    count->outcomes[NARC_OUTCOME_LIMIT], count->outcomes[NARC_OUTCOME_ROUNDING]);
        }
}

static void print_contacts(const struct counts *counts, FILE *out) {
    fprintf(out, "\n### Wrong separations and normals; errors in parts of the sum of both bounding radii\n\n"
                 "| family | method | distance wrong | largest error | depth wrong | largest error | another normal | "
                 "NONE | LIMIT | ROUNDING |\n"
                 "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    for (enum family family = 0; family < FAMILIES; family++)
        for (size_t method = 0; method < METHODS; method++) {
            const struct counts *c = &counts[family];
            const struct count *count = &c->of[method];
            if (!takes(methods[method], family))
                continue;
            fprintf(out, "| %s | %s |", family_names[family], narc_method_name(methods[method]));
            print_part(out, count->distance_wrong, c->apart);
            fprintf(out, " %.2g |", count->distance_worst);
            print_part(out, count->depth_wrong, c->colliding);
            fprintf(out, " %.2g |", count->depth_worst);
            print_part(out, count->normal_wrong, c->colliding);
            fprintf(out, " %zu | %zu | %zu |\n", count->contact_outcomes[NARC_OUTCOME_NONE],
                    count->contact_outcomes[NARC_OUTCOME_LIMIT], count->contact_outcomes[NARC_OUTCOME_ROUNDING]);
        }
}

size_t print_answers(const struct settings *settings, uint64_t *random, FILE *out) {
    struct counts counts[FAMILIES];
    size_t broken = 0;
    for (enum family family = 0; family < FAMILIES; family++) {
        char what[64];
        snprintf(what, sizeof what, "wrong answers: %s", family_names[family]);
        begin_step(what);
        counts[family] = count_family(settings, family, random);
        for (size_t method = 0; method < METHODS; method++)
            broken += counts[family].of[method].broken;
    }
    print_overlaps(counts, out);
    print_contacts(counts, out);
    fprintf(out, "\nAnswers that break what `narc_methods.h` promises of gjk and polygon-sat: %zu\n", broken);
    return broken;
}
