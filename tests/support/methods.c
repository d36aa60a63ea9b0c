/* SPDX-License-Identifier: MIT
 *
 * methods.c - calls on scenes, and pairs of everything with their exact answers.
 */
#include "methods.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "placements.h"

/* ------------------------------------------------------------------------------------------------ shapes and pairs */

enum { SHAPES_PER_KIND = 4 };

/* The kinds that have polygons: all numbers below FAMILY_COUNT are families, the rest are hard ones. */
static const size_t polygon_kinds[] = {FAMILY_POLYGON,
                                       FAMILY_BOX,
                                       FAMILY_COUNT + HARD_CORNERS,
                                       FAMILY_COUNT + HARD_REGULAR,
                                       FAMILY_COUNT + HARD_STACK,
                                       FAMILY_COUNT + HARD_LONG};
enum { POLYGON_KINDS = sizeof(polygon_kinds) / sizeof(polygon_kinds[0]) };

static bool is_polygon(const struct shape *shape) {
    bool polygon = true;
    for (size_t i = 0; i < shape->count; i++)
        polygon = polygon && shape->arcs[i].radius == 0;
    return polygon;
}

static struct shape make_kind(struct test_random *random, size_t kind, bool polygon) {
    struct shape shape;
    do {
        shape = make_any_shape(random, kind);
    } while (polygon && !is_polygon(&shape));
    return shape;
}

/* By how much the arcs of a shape fail to join, in all: across the normals of the junctions, and where an edge would
 * run backwards. The support function is not certain by more than that. */
static double find_misfit(const struct shape *shape) {
    double misfit = 0;
    for (size_t i = 0; i < shape->count; i++) {
        const narc_arc *from = &shape->arcs[i], *to = &shape->arcs[(i + 1) % shape->count];
        const double n_x = cos(to->start), n_y = sin(to->start);
        const double x = to->center_x - from->center_x + (to->radius - from->radius) * n_x,
                     y = to->center_y - from->center_y + (to->radius - from->radius) * n_y;
        misfit += fabs(x * n_x + y * n_y) + fmax(0, x * n_y - y * n_x);
    }
    return misfit;
}

static double bounding_radius(const struct shape *shape) {
    narc_circle circle;
    assert_true(narc_compute_bounding_circle(shape->arcs, shape->count, &circle));
    return circle.radius;
}

/* What is exact of pair k. */
static void find_exact(struct corpus *corpus, size_t k) {
    const struct scene *scene = &corpus->scene;
    const uint32_t index_a = scene->pairs[k].a, index_b = scene->pairs[k].b;
    const struct shape *a = &scene->shapes[scene->bodies[index_a].shape],
                       *b = &scene->shapes[scene->bodies[index_b].shape];
    struct exact_pair *pair = &corpus->pairs[k];
    pair->a = scene_reference(scene, index_a);
    pair->b = scene_reference(scene, index_b);
    const struct reference_gap found = reference_find_gap(&pair->a, &pair->b);
    pair->gap = found.gap;
    pair->normal_x = found.normal_x;
    pair->normal_y = found.normal_y;
    pair->reach = reference_reach(&pair->a, &pair->b);
    pair->size = pair->a.scale * bounding_radius(a) + pair->b.scale * bounding_radius(b);
    pair->bound =
        separation_bound(&pair->a, &pair->b) + pair->a.scale * find_misfit(a) + pair->b.scale * find_misfit(b);
}

/* Names for the pairs from number `first` on. */
static void name_pairs(struct corpus *corpus, size_t first, size_t kind_a, size_t kind_b, const char *place) {
    for (size_t k = first; k < corpus->scene.pair_count; k++) {
        corpus->pairs[k].kind_a = kind_a;
        corpus->pairs[k].kind_b = kind_b;
        corpus->pairs[k].place = place;
    }
}

static uint32_t pick_shape(struct test_random *random, size_t kind_number) {
    return (uint32_t)(kind_number * SHAPES_PER_KIND + random_below(random, SHAPES_PER_KIND));
}

/* Number i of `count`: one of `all` cases, in turn, or as evenly as it gets where there are fewer than all. */
static size_t spread(size_t i, size_t count, size_t all) { return count < all ? i * all / count : i % all; }

struct corpus make_corpus(const char *name, narc_precision precision, double rounds, bool polygons) {
    struct test_random random = test_random_named(name);
    const size_t kinds = polygons ? POLYGON_KINDS : ALL_FAMILIES;
    const size_t places = kinds * kinds * PLACE_COUNT, hard_places = kinds * HARD_PLACES;
    const size_t placed = test_trials((size_t)(rounds * (double)places)),
                 hard = test_trials((size_t)(rounds * (double)hard_places));
    const size_t most = placed + hard * HARD_BODIES / 2;
    struct corpus corpus = {.scene = create_scene(precision, kinds * SHAPES_PER_KIND, 2 * most, most),
                            .pairs = calloc(most, sizeof(struct exact_pair))};
    assert_non_null(corpus.pairs);
    size_t kind[ALL_FAMILIES];
    for (size_t k = 0; k < kinds; k++) {
        kind[k] = polygons ? polygon_kinds[k] : k;
        for (size_t i = 0; i < SHAPES_PER_KIND; i++) {
            const struct shape shape = make_kind(&random, kind[k], polygons);
            scene_add_shape(&corpus.scene, &shape);
        }
    }
    for (size_t i = 0; i < placed; i++) {
        const size_t k = spread(i, placed, places), a = k % kinds, b = k / kinds % kinds;
        const size_t first = corpus.scene.pair_count;
        const enum placement placement = (enum placement)(k / kinds / kinds);
        const uint32_t shape_a = pick_shape(&random, a), shape_b = pick_shape(&random, b);
        scene_add_placed(&random, &corpus.scene, placement, shape_a, shape_b);
        name_pairs(&corpus, first, kind[a], kind[b], placement_name(placement));
    }
    for (size_t i = 0; i < hard; i++) {
        const size_t k = spread(i, hard, hard_places), a = k % kinds, b = random_below(&random, kinds);
        const size_t first = corpus.scene.pair_count;
        const enum hard_placement placement = (enum hard_placement)(k / kinds);
        const uint32_t shape_a = pick_shape(&random, a), shape_b = pick_shape(&random, b);
        add_hard_pairs(&random, &corpus.scene, placement, shape_a, shape_b);
        name_pairs(&corpus, first, kind[a], kind[b], hard_placement_name(placement));
    }
    return corpus;
}

void solve_corpus(struct corpus *corpus) {
    for (size_t k = 0; k < corpus->scene.pair_count; k++)
        find_exact(corpus, k);
}

void destroy_corpus(struct corpus *corpus) {
    destroy_scene(&corpus->scene);
    free(corpus->pairs);
}

void print_corpus_pair(const struct corpus *corpus, size_t k) {
    const struct exact_pair *pair = &corpus->pairs[k];
    const struct scene *scene = &corpus->scene;
    print_error("  pair %zu: %s - %s, %s; exact gap %.9g, normal (%.9g, %.9g), bound %.3g, size %.6g, reach %.6g\n", k,
                any_family_name(pair->kind_a), any_family_name(pair->kind_b), pair->place, pair->gap, pair->normal_x,
                pair->normal_y, pair->bound, pair->size, pair->reach);
    const struct reference_body a = scene_reference(scene, scene->pairs[k].a),
                                b = scene_reference(scene, scene->pairs[k].b);
    print_pair(&a, &b);
}

void show_wrong_pair(const struct corpus *corpus, size_t k, const char *name, const char *wrong,
                     const narc_contact *told, unsigned outcome, size_t *count) {
    enum { SHOWN = 3 };
    if ((*count)++ >= SHOWN)
        return;
    print_error("wrong, %s: %s\n", name, wrong);
    print_corpus_pair(corpus, k);
    if (told)
        print_error("  answer: outcome %u, separation %.9g, normal (%.9g, %.9g), point (%.9g, %.9g), arcs %d and %d, "
                    "point off %.3g\n",
                    outcome, (double)told->separation, (double)told->normal_x, (double)told->normal_y,
                    (double)told->point_x, (double)told->point_y, arc_of_a(told->feature), arc_of_b(told->feature),
                    distance_from_outlines(&corpus->pairs[k], told));
}

/* ------------------------------------------------------------------------------------------------ calls */

uint64_t *query_overlaps(const struct scene *scene, const narc_method_options *options, const narc_query *query) {
    uint64_t *bits = make_junk(NARC_BIT_WORDS(scene->pair_count) * sizeof *bits);
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    narc_error error;
    if (narc_find_overlaps_by(scene_methods(scene), &bodies, &pairs, options, query, bits, &error) != NARC_OK)
        fail_msg("narc_find_overlaps_by, %s: %s", narc_method_name(options->method), error.message);
    return bits;
}

struct contacts query_contacts(const struct scene *scene, const narc_method_options *options, const narc_query *query) {
    struct contacts found = {make_junk(scene->pair_count * sizeof *found.rows), 0};
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    narc_error error;
    if (narc_find_contacts_by(scene_methods(scene), &bodies, &pairs, options, query, found.rows, pairs.count,
                              &found.count, &error) != NARC_OK)
        fail_msg("narc_find_contacts_by, %s: %s", narc_method_name(options->method), error.message);
    return found;
}

uint8_t *create_outcomes(size_t count) { return make_junk(count); }

uint32_t *create_hints(size_t count) {
    uint32_t *hints = calloc(count + 1, sizeof *hints);
    assert_non_null(hints);
    return hints;
}

/* ------------------------------------------------------------------------------------------------ lists */

void check_same_contacts(const struct contacts *found, const struct contacts *expected, const char *what) {
    if (found->count != expected->count)
        fail_msg("%s: %zu contacts, not %zu", what, found->count, expected->count);
    for (size_t k = 0; k < found->count; k++)
        if (memcmp(&found->rows[k], &expected->rows[k], sizeof *found->rows) != 0)
            fail_msg("%s: contact %zu, of pair %u, differs", what, k, (unsigned)found->rows[k].pair);
}

void check_contacts_below(const struct contacts *found, const struct contacts *all, float margin, const char *what) {
    size_t next = 0;
    for (size_t k = 0; k < all->count; k++) {
        if (all->rows[k].separation < margin) {
            if (next >= found->count || memcmp(&found->rows[next], &all->rows[k], sizeof *found->rows) != 0) {
                fail_msg("%s, margin %g: pair %zu, with separation %.9g, is not reported as it is", what,
                         (double)margin, k, (double)all->rows[k].separation);
            }
            next++;
        }
    }
    assert_int_equal(next, found->count);
}

void check_contacts_are_bits(const struct contacts *found, const uint64_t *bits, size_t count, const char *what) {
    size_t next = 0;
    for (size_t k = 0; k < count; k++) {
        const bool listed = next < found->count && found->rows[next].pair == k;
        if (listed != bit_is_set(bits, k)) {
            fail_msg("%s: pair %zu has bit %d, but %s", what, k, bit_is_set(bits, k),
                     listed ? "a contact" : "no contact");
        }
        next += listed;
    }
    assert_int_equal(next, found->count);
}

/* ------------------------------------------------------------------------------------------------ one contact */

static narc_point place_point(const struct reference_body *body, double x, double y) {
    return (narc_point){body->scale * (body->cosine * x - body->sine * y),
                        body->scale * (body->sine * x + body->cosine * y)};
}

double reference_height(const struct reference_body *body, double x, double y) {
    /* A point at the position: what lies between the two along (x, y) is the height, negative. */
    static const narc_arc point = {0, 0, 0, -PI, PI};
    const struct reference_body at_position = {&point, 1, body->x, body->y, 1, 0, 1};
    return -reference_gap_along(body, &at_position, x, y);
}

/* The point is the mean of two surface points and so off by as much as a separation at most; the separation, half of
 * which says where it must be, adds half of that, and turning it into the world 4 roundings of its length. */
const double point_bounds = 1.5 + 4.0 / 32;

/* A normal this close to an edge's, in radians, is taken for it: kernels/base/contact_point.inl. */
static const double parallel = 0x1p-20;

/* The extent along (-y, x) of a body's support points for all normals within an angle of (x, y) times `sign`. They move
 * along the outline with the normal: those of both ends, and of the middle, say it all. */
static void widen(const struct exact_pair *pair, const struct reference_body *body, double sign, double x, double y,
                  double angle, double *least, double *most) {
    const double c = body->cosine, s = body->sine;
    for (int k = -1; k <= 1; k++) {
        const double m_x = sign * (x - k * angle * y), m_y = sign * (y + k * angle * x);
        narc_point p;
        assert_true(narc_find_support(body->arcs, body->count, c * m_x + s * m_y, c * m_y - s * m_x, &p, NULL));
        const narc_point place = place_point(body, p.x, p.y);
        const double along = x * (place.y + body->y - pair->a.y) - y * (place.x + body->x - pair->a.x);
        *least = fmin(*least, along);
        *most = fmax(*most, along);
    }
}

/* Does the point lie no further along the support lines than the bodies' points on them? Edges that are parallel to
 * them but for `parallel`, and as much again for the rounding of normals, are theirs. */
static bool is_between_touches(const struct exact_pair *pair, double x, double y, double p_x, double p_y) {
    double least = INFINITY, most = -INFINITY;
    widen(pair, &pair->a, 1, x, y, 2 * parallel, &least, &most);
    widen(pair, &pair->b, -1, x, y, 2 * parallel, &least, &most);
    const double along = x * p_y - y * p_x, band = point_bounds * pair->bound;
    return least - band <= along && along <= most + band;
}

/* A dozen roundings of a float for square root, division and two rotations. */
static const double unit_tolerance = 1e-6;

/* The gap along the normal of the arcs that are told: that of the bodies. Of an edge the arc at its counter-clockwise
 * end is told, the height of which is another by `parallel` times the edge's length, less than the body's diameter. */
static bool are_touching_arcs(const struct exact_pair *pair, const narc_contact *contact, double x, double y,
                              double of_bodies) {
    const size_t i = arc_of_a(contact->feature), j = arc_of_b(contact->feature);
    if (i >= pair->a.count || j >= pair->b.count)
        return false;
    const narc_arc *a = &pair->a.arcs[i], *b = &pair->b.arcs[j];
    const narc_point from = place_point(&pair->a, a->center_x, a->center_y),
                     to = place_point(&pair->b, b->center_x, b->center_y);
    const double u_x = pair->b.x - pair->a.x + to.x - from.x, u_y = pair->b.y - pair->a.y + to.y - from.y;
    const double gap = u_x * x + u_y * y - pair->a.scale * a->radius - pair->b.scale * b->radius;
    return fabs(gap - of_bodies) <= pair->bound + 2 * parallel * pair->size;
}

const char *check_along_normal(const struct exact_pair *pair, const narc_contact *contact, bool unknown) {
    const double separation = (double)contact->separation;
    double x = (double)contact->normal_x, y = (double)contact->normal_y;
    const double length = hypot(x, y), p_x = (double)contact->point_x, p_y = (double)contact->point_y;
    if (!isfinite(separation) || !isfinite(length) || !isfinite(p_x) || !isfinite(p_y))
        return "not finite";
    if (fabs(length - 1) > unit_tolerance)
        return "normal not of length 1";
    x /= length;
    y /= length;
    const double gap = reference_gap_along(&pair->a, &pair->b, x, y);
    if (unknown ? gap > pair->bound || separation != 0 : fabs(gap - separation) > pair->bound)
        return "the gap along the normal is another";
    const double across = reference_height(&pair->a, x, y) + gap / 2;
    if (fabs(p_x * x + p_y * y - across) > point_bounds * pair->bound)
        return "the point does not lie between the support lines";
    return are_touching_arcs(pair, contact, x, y, gap) ? NULL : "the arcs have another gap along the normal";
}

const char *check_between_touches(const struct exact_pair *pair, const narc_contact *contact) {
    const bool fine = is_between_touches(pair, (double)contact->normal_x, (double)contact->normal_y,
                                         (double)contact->point_x, (double)contact->point_y);
    return fine ? NULL : "the point does not lie between the support points";
}

static double distance_to(const struct exact_pair *pair, const struct reference_body *body, double x, double y) {
    const double c = body->cosine, s = body->sine;
    double distance = NAN;
    x -= body->x - pair->a.x;
    y -= body->y - pair->a.y;
    const narc_point local = {(c * x + s * y) / body->scale, (c * y - s * x) / body->scale};
    assert_true(narc_compute_distance(body->arcs, body->count, local, &distance));
    return fabs(distance * body->scale);
}

double distance_from_outlines(const struct exact_pair *pair, const narc_contact *contact) {
    const double half = (double)contact->separation / 2;
    const double half_x = half * (double)contact->normal_x, half_y = half * (double)contact->normal_y;
    const double x = (double)contact->point_x, y = (double)contact->point_y;
    return fmax(distance_to(pair, &pair->a, x - half_x, y - half_y),
                distance_to(pair, &pair->b, x + half_x, y + half_y));
}
