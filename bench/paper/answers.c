/* SPDX-License-Identifier: MIT
 *
 * answers.c - how often the methods are wrong: random pairs of several families of shapes, against the exact answer
 * (method sat).
 *
 * The second body of a pair is anywhere where the axis-aligned boxes of both overlap, all equally likely: what a broad
 * phase hands on.
 */
#include <math.h>
#include <stdlib.h>

#include "paper.h"
#include "random.h"
#include "store.h"

enum { SHAPES = 512, METHODS = 3 };

static const narc_method methods[METHODS] = {NARC_METHOD_SAT_FIRST, NARC_METHOD_GJK, NARC_METHOD_POLYGON_SAT};

/* A separation farther than this from the exact one, in parts of the sum of both bounding radii, is wrong. */
static const double much = 1e-3;

/* A normal farther than this from the exact one, in radians, is another one. */
static const double another_normal = 0.1;

/* Of a family and a method. Pairs so near to touching that rounding decides are not counted. */
struct count {
    size_t apart, colliding;
    size_t false_hits, missed, distance_wrong, depth_wrong; /* by more than `much` */
    size_t normal_wrong;                                    /* of pairs that collide, and for the method too */
    double worst;                                           /* the largest error of a separation */
    size_t outcomes[4], broken;                             /* answers that are not what narc_methods.h promises */
};

/* Pairs, and all that is known of them. */
struct chunk {
    size_t count;
    struct body *bodies;
    uint64_t *bits;
    uint8_t *outcomes;
    narc_contact *exact, *found;
};

/* What rounding may change of a separation, the unit of errors, and what the store adds to that. */
struct scales {
    double rounding, size, slack;
};

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

static void count_pair(const struct shapes *made, const struct chunk *chunk, size_t k, narc_method method,
                       struct count *count) {
    const struct body *pair = &chunk->bodies[2 * k];
    const struct bound *a = &made->bounds[pair[0].shape], *b = &made->bounds[pair[1].shape];
    const struct scales scales = {rounding_of(made->bounds, pair), size_of(made->bounds, pair),
                                  NARC_ROUNDING_ROOM * (a->extent + b->extent)};
    const narc_contact *exact = &chunk->exact[k], *found = &chunk->found[k];
    const double separation = exact->separation, told = found->separation,
                 error = fabs(told - separation) / scales.size;
    const bool hit = chunk->bits[k / 64] >> k % 64 & 1, near = fabs(separation) <= scales.rounding;
    count->apart += !near && separation > 0;
    count->colliding += !near && separation < 0;
    count->false_hits += !near && hit && separation > 0;
    count->missed += !near && !hit && separation < 0;
    count->outcomes[chunk->outcomes[k]]++;
    count->broken += !is_as_promised(method, separation, told, chunk->outcomes[k], &scales);
    if (isinf(told)) /* no answer: counted as such */
        return;
    count->distance_wrong += separation > 0 && error > much;
    count->depth_wrong += separation <= 0 && error > much;
    count->worst = fmax(count->worst, error);
    count->normal_wrong +=
        separation <= 0 && told < 0 &&
        (double)exact->normal_x * found->normal_x + (double)exact->normal_y * found->normal_y < cos(another_normal);
}

static void ask_method(const struct shapes *made, struct chunk *chunk, narc_method method, struct count *count) {
    const narc_bodies bodies = bodies_of(chunk->bodies, 2 * chunk->count);
    const narc_pairs pairs = neighbours(chunk->count);
    const narc_method_options options = {.method = method, .out_outcomes = chunk->outcomes};
    const narc_query query = {.margin = INFINITY, .workers = all_workers()}; /* overlaps have no margin */
    size_t found;
    narc_error error;
    must(narc_find_overlaps_by(made->methods, &bodies, &pairs, &options, &query, chunk->bits, &error), &error);
    must(narc_find_contacts_by(made->methods, &bodies, &pairs, &options, &query, chunk->found, chunk->count, &found,
                               &error),
         &error);
    for (size_t k = 0; k < chunk->count; k++)
        count_pair(made, chunk, k, method, count);
}

/* Straight edges have no arcs for sat-first; polygon-sat takes nothing else. */
static bool takes(narc_method method, enum family family) {
    return method == NARC_METHOD_GJK || (method == NARC_METHOD_POLYGON_SAT) == (family == FAMILY_POLYGON);
}

static void count_family(const struct settings *settings, enum family family, struct chunk *chunk, uint64_t *random,
                         struct count counts[METHODS]) {
    struct shapes made = make_store(SHAPES);
    for (size_t k = 0; k < SHAPES; k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        const size_t count = make_shape(family, random, arcs);
        add_arcs(&made, arcs, count);
    }
    finish_store(&made);
    for (size_t left = settings->answer_pairs; left > 0; left -= chunk->count) {
        chunk->count = left < settings->chunk ? left : settings->chunk;
        for (size_t k = 0; k < chunk->count; k++) {
            struct body *pair = &chunk->bodies[2 * k];
            pair[0] = random_body(random, random_below(random, SHAPES), 0);
            pair[1] = random_body(random, random_below(random, SHAPES), 0);
            put_in_boxes(made.shapes, &pair[0], &pair[1], random);
        }
        separate(made.shapes, chunk->bodies, chunk->count, chunk->exact);
        for (size_t method = 0; method < METHODS; method++)
            if (takes(methods[method], family))
                ask_method(&made, chunk, methods[method], &counts[method]);
    }
    narc_destroy_methods(made.methods);
    narc_destroy_shapes(made.shapes);
}

static void print_part(FILE *out, size_t count, size_t of) {
    fprintf(out, " %zu", count);
    if (count > 0 && of > 0)
        fprintf(out, " (%.2g %%)", 100 * (double)count / (double)of);
    fprintf(out, " |");
}

size_t print_answers(const struct settings *settings, uint64_t *random, FILE *out) {
    const size_t most = settings->chunk;
    struct chunk chunk = {0,
                          allocate(2 * most, sizeof(struct body)),
                          allocate(NARC_BIT_WORDS(most), sizeof(uint64_t)),
                          allocate(most, 1),
                          allocate(most, sizeof(narc_contact)),
                          allocate(most, sizeof(narc_contact))};
    size_t broken = 0;
    fprintf(out,
            "\n### Wrong answers of %zu pairs; errors in parts of the sum of both bounding radii\n\n"
            "| family | method | false collisions | missed collisions | distance wrong | depth wrong | largest error | "
            "another normal | no answer, LIMIT, ROUNDING |\n"
            "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
            settings->answer_pairs);
    for (enum family family = 0; family < FAMILIES; family++) {
        struct count counts[METHODS] = {{0}};
        begin_step(family_names[family]);
        count_family(settings, family, &chunk, random, counts);
        for (size_t method = 0; method < METHODS; method++) {
            const struct count *c = &counts[method];
            if (!takes(methods[method], family))
                continue;
            fprintf(out, "| %s | %s |", family_names[family], narc_method_name(methods[method]));
            print_part(out, c->false_hits, c->apart);
            print_part(out, c->missed, c->colliding);
            print_part(out, c->distance_wrong, c->apart);
            print_part(out, c->depth_wrong, c->colliding);
            fprintf(out, " %.2g |", c->worst);
            print_part(out, c->normal_wrong, c->colliding);
            fprintf(out, " %zu, %zu, %zu |\n", c->outcomes[NARC_OUTCOME_NONE], c->outcomes[NARC_OUTCOME_LIMIT],
                    c->outcomes[NARC_OUTCOME_ROUNDING]);
            broken += c->broken;
        }
    }
    free(chunk.bodies);
    free(chunk.bits);
    free(chunk.outcomes);
    free(chunk.exact);
    free(chunk.found);
    fprintf(out, "\nAnswers that break what `narc_methods.h` promises of gjk and polygon-sat: %zu\n", broken);
    return broken;
}
