/* SPDX-License-Identifier: MIT
 *
 * ground.c - pieces of chains: contacts, overlaps and rays are those of an independent search in double precision, and
 * the same in every form in which they can be asked for.
 *
 * Against a run, the gap of its closed shape by tests/support/reference.h counts if its normal is one of the front's.
 * Against a concave arc, the body's outline is sampled, and where its distance from the arc's centre is largest, among
 * points near by, is a contact if that direction is among the arc's.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "families.h"
#include "layouts.h"
#include "narc_broad_phase.h"
#include "narc_chains.h"
#include "narc_scene.h"
#include "plain_kernels.h"
#include "reference.h"
#include "scene.h"
#include "support.h"
#include "turtle.h"

enum { ENTRIES = 400, SAMPLES = 300, MOST_ROWS = 64 };

/* A chain of the caller's arcs, and the scene with its entries as bodies 0 .. entry_count - 1. */
struct ground {
    struct scene scene;
    narc_chain_entry entries[ENTRIES];
    size_t entry_count;
    narc_arc arcs[128];
    size_t arc_count;
    struct turtle walk; /* while it is made */
};

static const float margin = 0.05f;

/* ------------------------------------------------------------------------------------------------ chains */

static void begin_chain(struct ground *g, double x, double y, double angle) {
    memset(g, 0, sizeof *g);
    g->walk = create_turtle(x, y, angle);
    walk_arc(&g->walk, 0, 0);
}

/* A scene with the chain's entries. False if it crosses itself. */
static bool place_chain(struct ground *g, const narc_chain_options *options, size_t bodies, size_t pairs) {
    narc_error error;
    assert_in_range(g->walk.count, 1, sizeof g->arcs / sizeof *g->arcs);
    g->arc_count = g->walk.count;
    memcpy(g->arcs, g->walk.arcs, g->arc_count * sizeof *g->arcs);
    free(g->walk.arcs);
    g->scene = create_scene(NARC_FLOAT32, ENTRIES + bodies, ENTRIES + bodies, pairs);
    const narc_status status =
        narc_add_chain(g->scene.store, g->arcs, g->arc_count, options, g->entries, ENTRIES, &g->entry_count, &error);
    if (status == NARC_ERROR_NOT_SIMPLE) {
        destroy_scene(&g->scene);
        return false;
    }
    if (status != NARC_OK)
        fail_msg("%s", error.message);
    for (size_t k = 0; k < g->entry_count; k++) {
        const narc_chain_entry *e = &g->entries[k];
        struct shape *shape = &g->scene.shapes[e->shape];
        shape->count = narc_get_arcs(g->scene.store, e->shape, shape->arcs);
        struct body body = {.x = e->x, .y = e->y, .cosine = 1, .scale = 1, .shape = e->shape};
        scene_add_body(&g->scene, body);
    }
    g->scene.shape_count = narc_count_shapes(g->scene.store);
    return true;
}

/* A hilly country from right to left. */
static bool make_country(struct test_random *random, struct ground *g, size_t bodies, size_t pairs) {
    bool was_sharp = true;
    begin_chain(g, 10, 0, PI / 2);
    for (int k = 0; k < 24; k++) {
        const double lean = g->walk.normal - PI / 2;
        const double turn = random_between(random, 0.1, 0.9), radius = random_log_between(random, 0.2, 6);
        const bool dips = random_below(random, 2) ? lean > -0.3 : lean > 0.6, is_sharp = !random_below(random, 4);
        if (is_sharp || was_sharp || random_below(random, 3) == 0)
            walk_line(&g->walk, random_between(random, 0.2, 2));
        walk_arc(&g->walk, is_sharp ? 0 : radius, dips ? -turn : turn);
        was_sharp = is_sharp;
    }
    walk_line(&g->walk, 1);
    walk_arc(&g->walk, 0, 0);
    return place_chain(g, &(narc_chain_options){.first_run = 7}, bodies, pairs);
}

static struct shape make_body(struct test_random *random) {
    const enum family families[] = {FAMILY_SMOOTH, FAMILY_POLYGON, FAMILY_BOX,    FAMILY_CAPSULE, FAMILY_ROUNDED,
                                    FAMILY_CIRCLE, FAMILY_MIXED,   FAMILY_SMOOTH, FAMILY_HALF};
    return make_shape(random, families[random_below(random, sizeof families / sizeof *families)]);
}

/* Bodies near the outline, each with a pair with every entry, as A and as B. */
static void add_movers(struct test_random *random, struct ground *g, size_t count) {
    struct scene *scene = &g->scene;
    for (size_t k = 0; k < count; k++) {
        const struct shape shape = make_body(random);
        const narc_arc *near = &g->arcs[1 + random_below(random, g->arc_count - 2)];
        const double angle = random_between(random, near->start, near->end), scale = random_between(random, 0.1, 0.8);
        const double away = near->radius + scale * random_between(random, 0.2, 1.2);
        struct body body = turned_body(random_between(random, -PI, PI), scale);
        body.x = near->center_x + away * cos(angle);
        body.y = near->center_y + away * sin(angle);
        body.shape = scene_add_shape(scene, &shape);
        const uint32_t mover = scene_add_body(scene, body);
        for (uint32_t e = 0; e < g->entry_count; e++)
            scene_add_pair(scene, (e + k) % 2 ? e : mover, (e + k) % 2 ? mover : e);
    }
}

/* ------------------------------------------------------------------------------------------------ the reference */

struct spot {
    double x, y;
};

static bool is_concave(const struct reference_body *b) { return b->count == 1 && signbit(b->arcs->radius); }
static bool is_run(const struct scene *scene, uint32_t body) {
    return narc_shape_flags(scene->store, scene->bodies[body].shape) & NARC_SHAPE_RUN;
}

static struct spot place_point(const struct reference_body *b, double x, double y) {
    return (struct spot){b->x + b->scale * (b->cosine * x - b->sine * y),
                         b->y + b->scale * (b->sine * x + b->cosine * y)};
}

/* The outline of a body: edges and arcs that are longer than nothing, each from a whole number to the next. Piece
 * 2 k is the edge before arc k, piece 2 k + 1 that arc. */
struct outline {
    const struct reference_body *body;
    size_t count, piece[2 * NARC_MAX_ARCS];
};

static struct spot find_arc_point(const struct reference_body *b, size_t k, double part) {
    const narc_arc *arc = &b->arcs[k];
    const double sweep = arc->end - arc->start, angle = arc->start + part * (sweep > 0 ? sweep : sweep + 2 * PI);
    return place_point(b, arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle));
}

static struct spot find_outline_point(const struct outline *o, double s) {
    const double around = fmod(s + (double)o->count, (double)o->count);
    const size_t at = (size_t)around < o->count ? (size_t)around : 0, k = o->piece[at] / 2;
    const double part = around - (double)at;
    if (o->piece[at] % 2)
        return find_arc_point(o->body, k, part);
    const struct spot from = find_arc_point(o->body, (k + o->body->count - 1) % o->body->count, 1),
                      to = find_arc_point(o->body, k, 0);
    return (struct spot){from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
}

static struct outline make_outline(const struct reference_body *b) {
    struct outline o = {.body = b};
    for (size_t k = 0; k < b->count; k++) {
        const struct spot from = find_arc_point(b, (k + b->count - 1) % b->count, 1), to = find_arc_point(b, k, 0);
        if (hypot(to.x - from.x, to.y - from.y) > 1e-5 * b->scale)
            o.piece[o.count++] = 2 * k;
        if (b->arcs[k].radius > 0)
            o.piece[o.count++] = 2 * k + 1;
    }
    return o;
}

static double find_far(const struct outline *o, double s, struct spot center) {
    const struct spot p = find_outline_point(o, s);
    return hypot(p.x - center.x, p.y - center.y);
}

/* What contacts there should be. */
struct expected {
    size_t count;
    double separation[MOST_ROWS];
    struct spot normal[MOST_ROWS]; /* from the piece to the body */
    bool is_doubtful;              /* something is too close to call */
};

/* How wide a body is along a direction of the world. */
static double find_width(const struct reference_body *b, double x, double y) {
    const double own_x = b->cosine * x + b->sine * y, own_y = b->cosine * y - b->sine * x;
    narc_point most, least;
    assert_true(narc_find_support(b->arcs, b->count, own_x, own_y, &most, NULL) &&
                narc_find_support(b->arcs, b->count, -own_x, -own_y, &least, NULL));
    return b->scale * ((most.x - least.x) * own_x + (most.y - least.y) * own_y);
}

static bool holds_place(const struct reference_body *body, double extent, struct spot p) {
    return hypot(p.x - body->x, p.y - body->y) < extent &&
           reference_point_distance(body, p.x - body->x, p.y - body->y) < 0;
}

/* Does a piece's outline, of a run its front, meet a body? Or nearly so. */
static bool meets(const struct reference_body *piece, const struct reference_body *body) {
    const bool run = !is_concave(piece);
    const double extent = reference_extent(body);
    for (size_t k = run ? 1 : 0; run ? k + 5 <= piece->count : k < 1; k++) {
        const narc_arc *arc = &piece->arcs[k], *before = k > 0 ? arc - 1 : arc;
        const double from_x = before->center_x + before->radius * cos(before->end),
                     from_y = before->center_y + before->radius * sin(before->end),
                     to_x = arc->center_x + arc->radius * cos(arc->start),
                     to_y = arc->center_y + arc->radius * sin(arc->start);
        for (int i = 0; i <= SAMPLES; i++) {
            const double part = (double)i / SAMPLES, angle = arc->start + part * (arc->end - arc->start);
            const struct spot p = place_point(piece, from_x + part * (to_x - from_x), from_y + part * (to_y - from_y));
            const struct spot q =
                place_point(piece, arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle));
            if ((run && holds_place(body, extent, p)) ||
                ((!run || k + 5 < piece->count) && holds_place(body, extent, q)))
                return true;
        }
    }
    return false;
}

/* A body that is no piece, and the only one of its pair, is to reach the surface: else what is told is behind it. What
 * meets the next piece alone may be told of or not. */
static bool reaches(const struct reference_body *piece, const struct reference_body *body, double separation,
                    struct spot n, bool *out_doubtful) {
    const double width = find_width(body, n.x, n.y);
    *out_doubtful = *out_doubtful || fabs(separation + width) < 2e-5 + 0.002 * width ||
                    (separation < 0 && separation > -width && !meets(piece, body));
    return separation > -width;
}

/* A place of the outline, 0 .. SAMPLES - 1 in each piece: dense at its ends, where a maximum can be as shallow as
 * may be. */
static double find_sample(int k) {
    const int piece = k >= 0 ? k / SAMPLES : -1;
    return piece + 0.5 - 0.5 * cos(PI * (k - piece * SAMPLES) / SAMPLES);
}

/* The maximum between two places, where there is one. */
static double refine(const struct outline *o, double low, double high, struct spot center) {
    const double ratio = 0.6180339887498949;
    for (int k = 0; k < 60; k++) {
        const double a = high - ratio * (high - low), b = low + ratio * (high - low);
        if (find_far(o, a, center) < find_far(o, b, center))
            low = a;
        else
            high = b;
    }
    return (low + high) / 2;
}

static double wrap(double angle) { return remainder(angle, 2 * PI); }

/* Of a run only its front counts: does what lies at s, or next to it, belong to it? */
static bool lies_on_front(const struct outline *o, double s) {
    const double around = fmod(s + (double)o->count, (double)o->count);
    const size_t before = o->piece[(size_t)(around + (double)o->count - 1e-3) % o->count],
                 after = o->piece[(size_t)(around + 1e-3) % o->count];
    const size_t first = 2, last = 2 * (o->body->count - 5);
    return before >= first && before <= last && after >= first && after <= last;
}

static void expect_concave(const struct reference_body *piece, const struct reference_body *body, bool run,
                           double limit, struct expected *out) {
    const narc_arc *arc = piece->arcs;
    const struct spot center = place_point(piece, arc->center_x, arc->center_y);
    const double radius = -arc->radius * piece->scale, turned = atan2(piece->sine, piece->cosine);
    const double mid = (arc->start + arc->end) / 2 + turned, half = fabs(arc->end - arc->start) / 2;
    const struct outline outline = make_outline(body), *const o = &outline;
    double found[MOST_ROWS];
    size_t count = 0;
    for (int k = 0; k < (int)o->count * SAMPLES; k++) {
        const double here = find_far(o, find_sample(k), center), before = find_sample(k - 1),
                     after = find_sample(k + 1);
        if (here < find_far(o, before, center) || here < find_far(o, after, center))
            continue;
        const double peak = refine(o, before, after, center), far = find_far(o, peak, center);
        const struct spot p = find_outline_point(o, peak);
        const double n_x = (center.x - p.x) / far, n_y = (center.y - p.y) / far,
                     off = fabs(wrap(atan2(n_y, n_x) - mid));
        bool is_known = false;
        for (size_t i = 0; i < count; i++) {
            const struct spot q = find_outline_point(o, found[i]);
            is_known = is_known || hypot(q.x - p.x, q.y - p.y) < 1e-5;
        }
        if (is_known || count == MOST_ROWS)
            continue;
        found[count++] = peak;
        const double separation = radius - far;
        out->is_doubtful = out->is_doubtful || far < 0.02 || fabs(off - half) < 2e-5 || fabs(separation - limit) < 2e-5;
        if (off <= half && separation < -radius * sin(half)) /* perhaps outside of the circle around the arc */
            out->is_doubtful = true;
        if (off > half || separation >= limit || (run && !lies_on_front(o, peak)) ||
            (!run && !reaches(piece, body, separation, (struct spot){n_x, n_y}, &out->is_doubtful)))
            continue;
        out->separation[out->count] = separation;
        out->normal[out->count++] = (struct spot){n_x, n_y};
    }
}

/* Is the gap as large along a normal of the run `run`, too? `sign`: 1 if that is A, else -1. */
static bool is_tie(const struct reference_body *a, const struct reference_body *b, double gap, double sign,
                   double angle) {
    const struct reference_body *const run = sign > 0 ? a : b;
    const double turned = angle + atan2(run->sine, run->cosine);
    return reference_gap_along(a, b, sign * cos(turned), sign * sin(turned)) > gap - 1e-6;
}

/* Is the gap's direction one of the run's front? It is only as good as the root of the gap's precision. */
static bool is_in_front(const struct reference_body *a, const struct reference_body *b, const struct reference_gap *gap,
                        double sign, bool *out_doubtful) {
    const struct reference_body *const run = sign > 0 ? a : b;
    const narc_arc *first = &run->arcs[0], *last = &run->arcs[run->count - 5];
    const double sweep = wrap(last->start - first->end - 1) + 1, turned = atan2(run->sine, run->cosine);
    const double angle = atan2(sign * gap->normal_y, sign * gap->normal_x) - turned;
    const double beyond = fabs(wrap(angle - first->end - sweep / 2)) - sweep / 2;
    const bool is_flat = sweep < 1e-9, in_front = beyond <= (is_flat ? 1e-5 : 0);
    const bool ties = is_tie(a, b, gap->gap, sign, in_front ? first->start : first->end) ||
                      is_tie(a, b, gap->gap, sign, in_front ? last->end : last->start);
    *out_doubtful = *out_doubtful || ties || (is_flat ? beyond > 1e-5 && beyond < 1e-4 : fabs(beyond) < 1e-4);
    return in_front;
}

static struct expected find_expected(const struct scene *scene, struct pair pair, double limit) {
    struct expected out = {.count = 0};
    const struct reference_body a = scene_reference(scene, pair.a), b = scene_reference(scene, pair.b);
    const bool run_a = is_run(scene, pair.a), run_b = is_run(scene, pair.b);
    if (is_concave(&a) && is_concave(&b))
        return out;
    const double apart = hypot(a.x - b.x, a.y - b.y);
    if (is_concave(&a) || is_concave(&b)) {
        const struct reference_body *const piece = is_concave(&a) ? &a : &b, *const body = is_concave(&a) ? &b : &a;
        const double chord = -piece->arcs->radius * sin((piece->arcs->start - piece->arcs->end) / 2);
        if (apart > chord * 1.001 + reference_extent(body) + limit + 0.01)
            return out;
        expect_concave(piece, body, is_concave(&a) ? run_b : run_a, limit, &out);
        return out;
    }
    const struct reference_gap gap = reference_find_gap(&a, &b);
    out.is_doubtful = fabs(gap.gap - limit) < 2e-5;
    const bool front_a = !run_a || is_in_front(&a, &b, &gap, 1, &out.is_doubtful);
    const bool front_b = !run_b || is_in_front(&a, &b, &gap, -1, &out.is_doubtful);
    const struct spot normal = {gap.normal_x, gap.normal_y};
    const bool reached = run_a == run_b || reaches(run_a ? &a : &b, run_a ? &b : &a, gap.gap, normal, &out.is_doubtful);
    if (gap.gap < limit && front_a && front_b && reached) {
        out.separation[out.count] = gap.gap;
        out.normal[out.count++] = normal;
    }
    return out;
}

/* ------------------------------------------------------------------------------------------------ answers */

static size_t capacity_of(const struct ground *g) { return 8 * g->scene.pair_count + 64; }

static struct contacts ask(const struct ground *g, const narc_query *query) {
    struct contacts out = {make_junk(capacity_of(g) * sizeof *out.rows), 0};
    assert_int_equal(ask_contacts(&g->scene, query, out.rows, capacity_of(g), &out.count, NULL), NARC_OK);
    return out;
}

/* Checks all rows of a query with `margin` against the reference. Returns how many pairs have several. Of so many pairs at
 * most the reference may not be sure. */
static size_t check_rows(const struct ground *g, const struct contacts *rows, size_t most_doubts) {
    const struct scene *scene = &g->scene;
    size_t row = 0, doubts = 0, several = 0;
    for (uint32_t k = 0; k < scene->pair_count; k++) {
        const struct pair pair = scene->pairs[k];
        const struct reference_body a = scene_reference(scene, pair.a), b = scene_reference(scene, pair.b);
        const struct expected e = find_expected(scene, pair, (double)margin);
        size_t count = 0;
        while (row + count < rows->count && rows->rows[row + count].pair == k)
            count++;
        if (!e.is_doubtful && count != e.count) {
            print_pair(&a, &b);
            fail_msg("pair %u has %zu rows, not %zu (first: %g, row: %g, normal %g %g, feature %04x)", k, count,
                     e.count, e.count ? e.separation[0] : 0, count ? (double)rows->rows[row].separation : 0,
                     count ? (double)rows->rows[row].normal_x : 0, count ? (double)rows->rows[row].normal_y : 0,
                     count ? rows->rows[row].feature : 0);
        }
        for (size_t i = 0; i < count && !e.is_doubtful; i++) {
            const narc_contact *c = &rows->rows[row + i];
            const double n_x = is_concave(&b) ? -(double)c->normal_x : (double)c->normal_x,
                         n_y = is_concave(&b) ? -(double)c->normal_y : (double)c->normal_y;
            double least = INFINITY, other = INFINITY, bound = separation_bound(&a, &b);
            if (is_concave(&a) || is_concave(&b)) /* the reference knows no radius below 0 */
                bound += -2 * NARC_ERROR_BOUND * (is_concave(&a) ? &a : &b)->arcs->radius;
            for (size_t j = 0; j < e.count; j++) {
                const double turn = hypot(n_x - e.normal[j].x, n_y - e.normal[j].y);
                other = turn < least ? fabs((double)c->separation - e.separation[j]) : other;
                least = fmin(least, turn);
            }
            if (!(other <= bound) || (is_concave(&a) != is_concave(&b) && !(least < 1e-3)))
                fail_msg("pair %u, row %zu of %zu: separation %g is off by %g, the normal by %g", k, i, count,
                         (double)c->separation, other, least);
            if (i > 0)
                assert_true(c[-1].normal_x * c->normal_y - c[-1].normal_y * c->normal_x >= 0);
            assert_int_equal(c->count, 1);
        }
        several += count > 1;
        doubts += e.is_doubtful;
        row += count;
    }
    assert_int_equal(row, rows->count);
    if (doubts > most_doubts)
        fail_msg("%zu of %zu pairs are doubtful", doubts, scene->pair_count);
    return several;
}

/* The deepest row of a pair, of those from `row` on; NULL if there is none. */
static const narc_contact *find_deepest(const struct contacts *rows, size_t row, uint32_t pair) {
    const narc_contact *deepest = NULL;
    for (; row < rows->count && rows->rows[row].pair == pair; row++)
        if (!deepest || rows->rows[row].separation < deepest->separation)
            deepest = &rows->rows[row];
    return deepest;
}

/* The same rows, in every form. */
static void check_forms(const struct ground *g, const struct contacts *right) {
    const struct scene *scene = &g->scene;
    const size_t count = scene->pair_count, size = right->count * sizeof *right->rows;
    const narc_workers two = narc_openmp_workers(2);
    struct contacts rows = ask(g, &(narc_query){.margin = margin, .workers = &two});
    assert_int_equal(rows.count, right->count);
    assert_memory_equal(rows.rows, right->rows, size);
    free(rows.rows);
    test_use_isa("scalar");
    rows = ask(g, &(narc_query){.margin = margin});
    test_use_isa(test_isa());
    assert_int_equal(rows.count, right->count);
    assert_memory_equal(rows.rows, right->rows, size);

    /* little room: the first rows, and how many are needed */
    const size_t rooms[] = {0, 1, 7, right->count / 2, right->count - 1, right->count};
    for (size_t k = 0; k < sizeof rooms / sizeof *rooms; k++) {
        size_t found = 0;
        memset(rows.rows, 0x5a, size);
        const narc_query query = {.margin = margin, .workers = k % 2 ? &two : NULL};
        const narc_status status = ask_contacts(scene, &query, rows.rows, rooms[k], &found, NULL);
        assert_int_equal(status, rooms[k] < right->count ? NARC_ERROR_CAPACITY : NARC_OK);
        assert_int_equal(found, right->count);
        assert_memory_equal(rows.rows, right->rows, rooms[k] * sizeof *rows.rows);
        assert_true(is_junk(rows.rows + right->count, sizeof *rows.rows) || k < 10);
    }

    /* margins of their own, a selection, hints, and one pair at a time */
    float *margins = malloc(count * sizeof *margins);
    uint32_t *selection = malloc(count * sizeof *selection), *hints = calloc(count, sizeof *hints);
    for (size_t k = 0; k < count; k++) {
        margins[k] = margin;
        selection[k] = (uint32_t)(count - 1 - k);
    }
    size_t found = 0;
    const narc_query each = {.margins = NARC_ARRAY(margins), .hints = NARC_HINT_ARRAY(hints)};
    for (int round = 0; round < 2; round++) {
        assert_int_equal(ask_contacts(scene, &each, rows.rows, capacity_of(g), &found, NULL), NARC_OK);
        assert_int_equal(found, right->count);
        assert_memory_equal(rows.rows, right->rows, size);
    }
    const narc_query selected = {.margin = margin, .selection = NARC_ARRAY(selection), .selection_count = count};
    assert_int_equal(ask_contacts(scene, &selected, rows.rows, capacity_of(g), &found, NULL), NARC_OK);
    assert_int_equal(found, right->count);
    size_t row = right->count;
    for (size_t k = 0; k < found;) {
        size_t same = 0;
        while (k + same < found && rows.rows[k + same].pair == rows.rows[k].pair)
            same++;
        row -= same;
        assert_memory_equal(&rows.rows[k], &right->rows[row], same * sizeof *rows.rows);
        k += same;
    }
    for (size_t k = 0, at = 0; k < count; k += 1) {
        const narc_query one = {.margin = margin, .first = k, .count = 1};
        assert_int_equal(ask_contacts(scene, &one, rows.rows, MOST_ROWS, &found, NULL), NARC_OK);
        if (found > 0)
            assert_memory_equal(rows.rows, &right->rows[at], found * sizeof *rows.rows);
        at += found;
        if (k + 1 == count)
            assert_int_equal(at, right->count);
    }

    /* dense rows, the formula alone, and bits */
    const narc_query dense = {.margin = margin, .dense = 1};
    assert_int_equal(ask_contacts(scene, &dense, rows.rows, capacity_of(g), &found, NULL), NARC_OK);
    uint64_t *bits = scene_overlaps(scene);
    size_t deepest_count = 0;
    row = 0;
    for (uint32_t k = 0; k < count; k++) {
        const narc_contact *deepest = find_deepest(right, row, k);
        assert_int_equal(rows.rows[k].count, deepest != NULL);
        if (deepest)
            assert_memory_equal(&rows.rows[k], deepest, sizeof *deepest);
        assert_int_equal(bit_is_set(bits, k), deepest && deepest->separation < 0);
        deepest_count += deepest != NULL;
        while (row < right->count && right->rows[row].pair == k)
            row++;
    }
    assert_int_equal(found, deepest_count);
    test_use_isa("scalar");
    uint64_t *others = scene_overlaps(scene);
    test_use_isa(test_isa());
    assert_memory_equal(bits, others, NARC_BIT_WORDS(count) * sizeof *bits);
    free(others);
    free(bits);
    free(hints);
    free(selection);
    free(margins);
    free(rows.rows);
}

/* Manifolds: as many rows, each with its contact's normal and separation; the same bits from plain C. */
static void check_manifolds(const struct ground *g, const struct contacts *right) {
    const narc_bodies bodies = scene_bodies(&g->scene);
    const narc_pairs pairs = scene_pairs(&g->scene);
    const narc_query query = {.margin = margin};
    narc_manifold *rows = make_junk(capacity_of(g) * sizeof *rows), *others = make_junk(capacity_of(g) * sizeof *rows);
    size_t found = 0, again = 0;
    assert_int_equal(narc_find_manifolds(g->scene.store, &bodies, &pairs, &query, rows, capacity_of(g), &found, NULL),
                     NARC_OK);
    assert_int_equal(found, right->count);
    for (size_t k = 0; k < found; k++) {
        const narc_contact *c = &right->rows[k];
        assert_int_equal(rows[k].pair, c->pair);
        assert_true(rows[k].normal_x == c->normal_x && rows[k].normal_y == c->normal_y);
        assert_in_range(rows[k].count, 1, 2);
        const float first = rows[k].point[0].separation, second = rows[k].point[rows[k].count - 1].separation;
        assert_true(c->separation == (first < second ? first : second));
    }
    test_use_isa("scalar");
    assert_int_equal(narc_find_manifolds(g->scene.store, &bodies, &pairs, &query, others, capacity_of(g), &again, NULL),
                     NARC_OK);
    test_use_isa(test_isa());
    assert_int_equal(found, again);
    assert_memory_equal(rows, others, found * sizeof *rows);
    free(rows);
    free(others);
}

/* The formula alone gives the deepest rows: all batches of a build without shortcuts are answered so. */
static void check_formula(const struct ground *g, const struct contacts *right) {
    const narc_bodies bodies = scene_bodies(&g->scene);
    const narc_pairs pairs = scene_pairs(&g->scene);
    const narc_query query = {.margin = margin};
    const narc_batch batch = {.shapes = g->scene.store,
                              .more_at = NARC_MORE_AT(narc_contact, count),
                              .a = &bodies,
                              .b = &bodies,
                              .pairs = &pairs,
                              .query = &query,
                              .count = pairs.count,
                              .asked = pairs.count};
    narc_contact *rows = make_junk(NARC_ROW_GROUP * sizeof *rows);
    size_t skipped = 0, more = 0, row = 0, all = 0;
    for (size_t first = 0; first < pairs.count; first += NARC_ROW_GROUP) {
        const size_t left = pairs.count - first;
        const narc_rows out = {.base = (char *)rows, .stride = sizeof *rows, .more = &more};
        const size_t found =
            narc_kernels_plain.contact(&batch, first, left < NARC_ROW_GROUP ? left : NARC_ROW_GROUP, &skipped, &out);
        for (size_t k = 0; k < found; k++) {
            const narc_contact *deepest = find_deepest(right, row, rows[k].pair);
            assert_non_null(deepest);
            rows[k].count %= NARC_MORE_ROW;
            assert_memory_equal(&rows[k], deepest, sizeof *deepest);
            while (row < right->count && right->rows[row].pair == rows[k].pair)
                row++;
        }
        all += found;
    }
    assert_int_equal(row, right->count);
    assert_int_equal(all + more, right->count);
    uint64_t *bits = scene_overlaps(&g->scene), *plain = make_junk(NARC_BIT_WORDS(pairs.count) * sizeof *plain);
    narc_kernels_plain.overlap(&batch, 0, pairs.count, &skipped, plain);
    assert_memory_equal(bits, plain, NARC_BIT_WORDS(pairs.count) * sizeof *bits);
    free(bits);
    free(plain);
    free(rows);
}

/* ------------------------------------------------------------------------------------------------ tests */

TEST(test_country) {
    struct test_random random = test_random_named("country");
    size_t several = 0, rows = 0;
    enum { ROUNDS = 12 }; /* fewer do if a pair with several rows is among them */
    const size_t rounds = test_trials(ROUNDS);
    for (size_t round = 0; round < rounds || (several == 0 && round < ROUNDS); round++) {
        struct ground *g = malloc(sizeof *g);
        while (!make_country(&random, g, 120, (size_t)ENTRIES * 120)) {
        }
        add_movers(&random, g, 60);
        struct contacts right = ask(g, &(narc_query){.margin = margin});
        several += check_rows(g, &right, g->scene.pair_count / 20);
        rows += right.count;
        check_forms(g, &right);
        check_manifolds(g, &right);
        check_formula(g, &right);
        free(right.rows);
        destroy_scene(&g->scene);
        free(g);
    }
    assert_true(several > 0 && rows > 0);
}

/* A closed strip that is thinner than bodies: straight, or an arch, turned anyhow. */
static void make_strip(struct test_random *random, struct ground *g, bool is_arch, size_t bodies, size_t pairs) {
    const double thickness = random_log_between(random, 0.02, 0.2), length = random_between(random, 1, 4);
    const double radius = random_between(random, 1, 4), turn = random_between(random, 1, 3);
    begin_chain(g, random_between(random, -1, 1), random_between(random, -1, 1), random_between(random, -PI, PI));
    if (is_arch)
        walk_arc(&g->walk, radius + thickness, turn);
    else
        walk_line(&g->walk, length);
    walk_arc(&g->walk, 0, PI / 2);
    walk_line(&g->walk, thickness);
    walk_arc(&g->walk, 0, PI / 2);
    if (is_arch)
        walk_arc(&g->walk, radius, -turn);
    else
        walk_line(&g->walk, length);
    walk_arc(&g->walk, 0, PI / 2);
    walk_line(&g->walk, thickness);
    walk_arc(&g->walk, 0, PI / 2);
    assert_true(place_chain(g, &(narc_chain_options){.closed = 1}, bodies, pairs));
}

/* Behind thin ground nothing is told by what faces away, in every form. */
TEST(test_thin_ground) {
    struct test_random random = test_random_named("thin ground");
    size_t unreached = 0;
    for (size_t round = 0; round < test_trials(8); round++) {
        struct ground *g = malloc(sizeof *g);
        make_strip(&random, g, round % 2, 60, (size_t)ENTRIES * 60);
        add_movers(&random, g, 60);
        struct contacts right = ask(g, &(narc_query){.margin = margin});
        (void)check_rows(g, &right, g->scene.pair_count / 3);
        check_forms(g, &right);
        check_manifolds(g, &right);
        check_formula(g, &right);
        for (uint32_t k = 0; k < g->scene.pair_count; k++) {
            const struct pair pair = g->scene.pairs[k];
            const struct reference_body a = scene_reference(&g->scene, pair.a), b = scene_reference(&g->scene, pair.b);
            const bool run_a = is_run(&g->scene, pair.a), run_b = is_run(&g->scene, pair.b);
            bool doubtful = false;
            if (is_concave(&a) || is_concave(&b) || run_a == run_b)
                continue;
            const struct reference_gap gap = reference_find_gap(&a, &b);
            unreached += is_in_front(&a, &b, &gap, run_a ? 1 : -1, &doubtful) &&
                         !reaches(run_a ? &a : &b, run_a ? &b : &a, gap.gap, (struct spot){gap.normal_x, gap.normal_y},
                                  &doubtful);
        }
        free(right.rows);
        destroy_scene(&g->scene);
        free(g);
    }
    assert_true(unreached > 0);
}

/* The place of a chain's arc at a normal. */
static struct spot find_chain_point(const narc_arc *arc, double angle) {
    return (struct spot){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
}

/* No ball falls between two entries, and none finds the ground where it is not. */
TEST(test_seams) {
    struct test_random random = test_random_named("seams");
    const double radius = 0.1, above = 0.01;
    for (size_t round = 0; round < test_trials(12); round++) {
        struct ground *g = malloc(sizeof *g);
        while (!make_country(&random, g, 2000, (size_t)ENTRIES * 2000)) {
        }
        const struct shape ball = circle_of(radius);
        const uint32_t shape = scene_add_shape(&g->scene, &ball);
        for (size_t k = 1; k + 1 < g->arc_count; k++) {
            const narc_arc *arc = &g->arcs[k];
            for (int i = 0; i < 40; i++) {
                const double off = random_below(&random, 3) ? random_log_between(&random, 1e-8, 1e-2) : 0;
                const double part = (arc->end - arc->start) * (0.5 * (double)(i % 3)); /* and where arcs are cut */
                const struct spot p = find_chain_point(arc, arc->start + part);
                const double normal = arc->start + part, side = i % 2 ? off : -off;
                if (arc->radius < 0.15 && signbit(arc->radius))
                    continue;
                const struct body body = {.x = p.x + (radius + above) * cos(normal) + side * sin(normal),
                                          .y = p.y + (radius + above) * sin(normal) - side * cos(normal),
                                          .cosine = 1,
                                          .scale = 1,
                                          .shape = shape};
                if (g->scene.body_count == g->entry_count + 2000)
                    continue;
                const uint32_t mover = scene_add_body(&g->scene, body);
                for (uint32_t e = 0; e < g->entry_count; e++)
                    scene_add_pair(&g->scene, mover, e);
            }
        }
        struct contacts rows = ask(g, &(narc_query){.margin = margin});
        const size_t balls = g->scene.body_count - g->entry_count;
        float *least = malloc(balls * sizeof *least);
        for (size_t k = 0; k < balls; k++)
            least[k] = INFINITY;
        for (size_t k = 0; k < rows.count; k++) {
            float *const of = &least[rows.rows[k].pair / g->entry_count];
            *of = fminf(*of, rows.rows[k].separation);
        }
        for (size_t k = 0; k < balls; k++)
            if (!(fabs((double)least[k] - above) <= 1e-5 + 1e-2 * 1e-2 / radius))
                fail_msg("ball %zu is %g away", k, (double)least[k]);
        free(least);
        free(rows.rows);
        destroy_scene(&g->scene);
        free(g);
    }
}

/* ------------------------------------------------------------------------------------------------ rays */

struct crossing {
    double along;
    struct spot normal;
};

/* Keeps a crossing of the line o + t v, |v| = 1, if it is ahead, comes from the air, and is the first. */
static void keep_crossing(double along, struct spot n, struct spot v, struct crossing *out) {
    if (along > 0 && along < out->along && n.x * v.x + n.y * v.y < 0)
        *out = (struct crossing){along, n};
}

static struct crossing cross_chain(const struct ground *g, struct spot o, struct spot v) {
    struct crossing out = {INFINITY, {0, 0}};
    for (size_t k = 0; k < g->arc_count; k++) {
        const narc_arc *arc = &g->arcs[k];
        const double x = arc->center_x - o.x, y = arc->center_y - o.y, ahead = x * v.x + y * v.y,
                     beside = v.x * y - v.y * x, square = arc->radius * arc->radius - beside * beside;
        for (int side = -1; side <= 1 && square > 0; side += 2) {
            const double along = ahead + side * sqrt(square);
            const struct spot n = {(along * v.x - x) / arc->radius, (along * v.y - y) / arc->radius};
            const double mid = (arc->start + arc->end) / 2, half = fabs(arc->end - arc->start) / 2;
            if (fabs(wrap(atan2(n.y, n.x) - mid)) <= half + 1e-9) /* a ray through a seam meets both */
                keep_crossing(along, n, v, &out);
        }
        if (k == 0)
            continue;
        const struct spot from = find_chain_point(&g->arcs[k - 1], g->arcs[k - 1].end),
                          to = find_chain_point(arc, arc->start), n = {cos(arc->start), sin(arc->start)};
        const double left = v.x * (from.y - o.y) - v.y * (from.x - o.x),
                     right = v.x * (to.y - o.y) - v.y * (to.x - o.x);
        if (hypot(to.x - from.x, to.y - from.y) > 1e-9 && fmin(left, right) <= 1e-9 && fmax(left, right) >= -1e-9 &&
            fabs(left - right) > 0) {
            const double part = left / (left - right);
            const struct spot p = {from.x + part * (to.x - from.x) - o.x, from.y + part * (to.y - from.y) - o.y};
            keep_crossing(p.x * v.x + p.y * v.y, n, v, &out);
        }
    }
    return out;
}

TEST(test_rays) {
    enum { RAYS = 400 };
    struct test_random random = test_random_named("rays");
    for (size_t round = 0; round < test_trials(20); round++) {
        struct ground *g = malloc(sizeof *g);
        while (!make_country(&random, g, 1, 1)) {
        }
        const narc_bodies bodies = scene_bodies(&g->scene);
        narc_box *boxes = malloc(g->entry_count * sizeof *boxes);
        narc_index *index = NULL;
        assert_int_equal(narc_compute_boxes(g->scene.store, &bodies, NULL, boxes, NULL), NARC_OK);
        assert_int_equal(narc_create_index(NULL, &index), NARC_OK);
        assert_int_equal(narc_build_index(index, boxes, g->entry_count, NULL, NULL), NARC_OK);
        double x[RAYS], y[RAYS];
        float motion_x[RAYS], motion_y[RAYS];
        for (size_t k = 0; k < RAYS; k++) {
            const narc_arc *arc = &g->arcs[1 + random_below(&random, g->arc_count - 2)];
            const bool in_ground = fabs(arc->radius) > 0 &&
                                   !random_below(&random, 4); /* not at seams, which reach a little into the ground */
            const bool at_seam = !in_ground && !random_below(&random, 3);
            const double angle = at_seam ? arc->start : random_between(&random, arc->start, arc->end);
            struct spot p = find_chain_point(arc, angle);
            if (!(fabs(arc->radius) > 0)) /* beside a corner */
                p.x += random_between(&random, -0.1, 0.1);
            const double air = fabs(arc->radius) > 0 ? angle : (arc->start + arc->end) / 2;
            const double way = air + random_between(&random, -1.2, 1.2), away = random_log_between(&random, 1e-3, 30);
            const double sign = in_ground ? -1 : 1;
            x[k] = p.x + sign * away * cos(way);
            y[k] = p.y + sign * away * sin(way);
            motion_x[k] = (float)((p.x - x[k]) * 3);
            motion_y[k] = (float)((p.y - y[k]) * 3);
        }
        const narc_rays rays = {.count = RAYS,
                                .x = NARC_POSITION_ARRAY(x),
                                .y = NARC_POSITION_ARRAY(y),
                                .motion_x = NARC_ARRAY(motion_x),
                                .motion_y = NARC_ARRAY(motion_y)};
        narc_ray_hit hits[RAYS], others[RAYS];
        size_t hit_count = 0, doubts = 0;
        for (int inside = NARC_INSIDE_STOPS; inside <= NARC_INSIDE_IGNORES; inside++) {
            const narc_ray_options options = {.inside = (narc_inside)inside};
            assert_int_equal(
                narc_cast_rays(index, g->scene.store, &bodies, &rays, &options, inside ? others : hits, RAYS, NULL),
                NARC_OK);
            if (inside)
                assert_memory_equal(hits, others, sizeof hits);
        }
        test_use_isa("scalar");
        assert_int_equal(narc_cast_rays(index, g->scene.store, &bodies, &rays, NULL, others, RAYS, NULL), NARC_OK);
        test_use_isa(test_isa());
        assert_memory_equal(hits, others, sizeof hits);
        for (size_t k = 0; k < RAYS; k++) {
            const double length = hypot((double)motion_x[k], (double)motion_y[k]), room = 2e-5;
            const struct spot o = {x[k], y[k]}, v = {(double)motion_x[k] / length, (double)motion_y[k] / length};
            const struct spot left = {o.x - room * v.y, o.y + room * v.x}, right = {o.x + room * v.y, o.y - room * v.x};
            const struct crossing here = cross_chain(g, o, v), beside = cross_chain(g, left, v),
                                  other = cross_chain(g, right, v);
            const double along = hits[k].count ? (double)hits[k].fraction * length : INFINITY;
            const bool found = here.along < length;
            /* Rays that graze, meet a corner, or begin by next to nothing in the ground. */
            const bool is_free = !isfinite(here.along) && !isfinite(beside.along) && !isfinite(other.along);
            const bool is_doubtful =
                !is_free && (!(fabs(beside.along - here.along) < 0.01) || !(fabs(other.along - here.along) < 0.01) ||
                             !(hypot(beside.normal.x - other.normal.x, beside.normal.y - other.normal.y) < 1e-2) ||
                             here.along < 1e-4 || fabs(here.along - length) < 1e-3);
            doubts += is_doubtful;
            if (is_doubtful)
                continue;
            hit_count += found;
            const double slope = fabs(here.normal.x * v.x + here.normal.y * v.y);
            if (found != (hits[k].count > 0) || (found && !(fabs(along - here.along) * slope <= 1e-5)))
                fail_msg("ray %zu from (%.9g, %.9g) along (%g, %g): %g, not %g", k, o.x, o.y, v.x, v.y, along,
                         here.along);
            const double turned =
                hypot((double)hits[k].normal_x - here.normal.x, (double)hits[k].normal_y - here.normal.y);
            /* Within a seam it is the neighbour's: 1e-4 of the largest radius, as an angle of the smallest. */
            if (found && !(turned < 1e-4 * (1 + 6 / 0.2) + 2e-4 / slope))
                fail_msg("ray %zu from (%.9g, %.9g) along (%g, %g): at %g the normal is off by %g", k, o.x, o.y, v.x,
                         v.y, along, turned);
        }
        if (!(hit_count > RAYS / 4 && doubts < RAYS / 5))
            fail_msg("of %d rays %zu hit, and %zu are doubtful", RAYS, hit_count, doubts);
        narc_destroy_index(index);
        free(boxes);
        destroy_scene(&g->scene);
        free(g);
    }
}

/* ------------------------------------------------------------------------------------------------ plain cases */

/* The rows of a body of this shape in one place against all entries, as A. */
static struct contacts ask_one(struct ground *g, struct shape shape, double x, double y) {
    const uint32_t mover = scene_add_body(
        &g->scene, (struct body){.x = x, .y = y, .cosine = 1, .scale = 1, .shape = scene_add_shape(&g->scene, &shape)});
    for (uint32_t e = 0; e < g->entry_count; e++)
        scene_add_pair(&g->scene, mover, e);
    struct contacts rows = ask(g, &(narc_query){.margin = margin});
    g->scene.pair_count = 0;
    return rows;
}

static void check_separations(const struct contacts *rows, size_t count, double separation) {
    assert_int_equal(rows->count, count);
    for (size_t k = 0; k < count; k++)
        assert_true(fabs((double)rows->rows[k].separation - separation) < 1e-6);
    free(rows->rows);
}

/* A bowl of radius 2 about the origin with rims that are flat. */
TEST(test_bowl) {
    struct ground *g = malloc(sizeof *g);
    const double half = 0.8, deep = 2 * cos(half);
    begin_chain(g, 2 * sin(half), -deep, PI / 2 + half);
    walk_arc(&g->walk, 2, -2 * half);
    walk_arc(&g->walk, 0, 0);
    assert_true(place_chain(g, NULL, 8, 64));
    assert_int_equal(g->entry_count, 1);

    /* A box on two corners, each sqrt(0.6^2 + 1.87^2) from the centre; the body is A, so that normals point down. */
    struct contacts rows = ask_one(g, box_of(1.2, 1, 0), 0, -1.37);
    assert_int_equal(rows.count, 2);
    const double far = hypot(0.6, 1.87);
    assert_true((double)fabsf(rows.rows[0].normal_x + (float)(0.6 / far)) < 1e-6);
    assert_true((double)fabsf(rows.rows[1].normal_x - (float)(0.6 / far)) < 1e-6);
    assert_true(rows.rows[0].radius_a == 0 && rows.rows[0].radius_b == -2);
    check_separations(&rows, 2, 2 - far);

    /* A ball at the bottom; one that is larger than the bowl touches the rims alone, which are bare ends. */
    rows = ask_one(g, circle_of(0.5), 0, -1.48);
    assert_true(fabs((double)rows.rows[0].point_y + 0.51) < 1e-6);
    check_separations(&rows, 1, 0.02);
    rows = ask_one(g, circle_of(3), 0, 1);
    check_separations(&rows, 0, 0);
    destroy_scene(&g->scene);
    free(g);
}

/* A rounded plateau: a box that is narrower, or wider, lies on its edge, or on the arc. */
TEST(test_plateau) {
    struct ground *g = malloc(sizeof *g);
    begin_chain(g, sin(0.5), cos(0.5) - 1, PI / 2 - 0.5);
    walk_arc(&g->walk, 1, 0.5);
    walk_line(&g->walk, 1);
    walk_arc(&g->walk, 1, 0.5);
    walk_arc(&g->walk, 0, 0);
    assert_true(place_chain(g, NULL, 8, 64));
    struct contacts rows = ask_one(g, box_of(0.5, 0.5, 0), -0.5, 0.26);
    assert_true(rows.rows[0].radius_b == INFINITY);
    check_separations(&rows, 1, 0.01);
    rows = ask_one(g, box_of(3, 0.5, 0), -0.5, 0.24);
    check_separations(&rows, 1, -0.01);
    rows = ask_one(g, box_of(3, 0.5, 0), -0.5, 0.31); /* further than the margin */
    check_separations(&rows, 0, 0);
    destroy_scene(&g->scene);
    free(g);
}

/* A valley with slopes of 45 degrees: a capsule in its bottom touches both, and the bottom itself only if it is
 * below. */
TEST(test_valley) {
    struct ground *g = malloc(sizeof *g);
    begin_chain(g, 2, 2, 3 * PI / 4);
    walk_line(&g->walk, sqrt(8));
    walk_arc(&g->walk, 0, -PI / 2);
    walk_line(&g->walk, sqrt(8));
    walk_arc(&g->walk, 0, 0);
    assert_true(place_chain(g, NULL, 8, 64));
    assert_int_equal(g->entry_count, 3);
    const double height = 0.5 * sqrt(2) + 0.25, above = 0.01 * sqrt(2);
    struct contacts rows = ask_one(g, capsule_of(0.5, 0.5), 0, height + above);
    check_separations(&rows, 2, 0.01);
    rows = ask_one(g, circle_of(0.5), 0, 0.45);
    assert_int_equal(rows.count, 2);
    free(rows.rows);
    rows = ask_one(g, circle_of(0.5), 0, -0.25);
    check_separations(&rows, 1, -0.75);
    destroy_scene(&g->scene);
    free(g);
}

/* ------------------------------------------------------------------------------------------------ cut lines */

static narc_manifold merge_one(const struct scene *scene, const uint32_t *runs, size_t entries) {
    struct pair pairs[ENTRIES];
    for (uint32_t e = 0; e < entries; e++)
        pairs[e] = (struct pair){(uint32_t)entries, e};
    const narc_pairs list = {.count = entries, .a = NARC_COLUMN(pairs, a), .b = NARC_COLUMN(pairs, b)};
    const narc_bodies bodies = scene_bodies(scene);
    struct manifolds rows = find_manifolds(scene->store, &bodies, &list, &(narc_query){.margin = margin});
    const size_t left = narc_merge_manifolds(&list, (narc_index_column){runs, sizeof *runs}, rows.rows, rows.count);
    if (left != 1)
        fail_msg("%zu rows of %zu", left, rows.count);
    const narc_manifold row = rows.rows[0];
    free(rows.rows);
    return row;
}

/* A box as wide as a quarter of `weld`, or less, has the same manifold on a line that is cut as on one that is not,
 * wherever it lies and however little it is tilted. */
TEST(test_cut_lines) {
    struct test_random random = test_random_named("cut lines");
    enum { TRIALS = 2000, LENGTH = 12 };
    static const uint32_t runs[ENTRIES] = {0};
    for (size_t round = 0; round < test_trials(4); round++) {
        struct ground *ground[2];
        const double angle = round % 4 ? random_between(&random, 0, 2 * PI) : PI / 2;
        const double weld = random_between(&random, 0.5, 3);
        for (int cut = 0; cut < 2; cut++) {
            ground[cut] = malloc(sizeof *ground[cut]);
            begin_chain(ground[cut], LENGTH / 2.0 * sin(angle), -LENGTH / 2.0 * cos(angle), angle);
            walk_line(&ground[cut]->walk, LENGTH);
            walk_arc(&ground[cut]->walk, 0, 0);
            assert_true(place_chain(ground[cut], &(narc_chain_options){.weld = cut ? weld : LENGTH}, TRIALS, 1));
        }
        assert_int_equal(ground[0]->entry_count, 1);
        assert_in_range(ground[1]->entry_count, (size_t)(LENGTH / weld), (size_t)(1.5 * LENGTH / weld) + 1);
        size_t pairs = 0;
        for (size_t k = 0; k < TRIALS; k++) {
            const double width = weld / 4 * (k % 3 ? random_between(&random, 0.1, 1) : 1);
            const struct shape box = box_of(width, width / 2, k % 2 ? 0 : 0.1 * width);
            const double tilt = random_below(&random, 4) ? random_log_between(&random, 1e-7, 0.1) : 0;
            const double low = random_between(&random, -0.02, 0.02) * width, up = width / 4 + low;
            const double along = random_between(&random, 0.6 - LENGTH / 2.0, LENGTH / 2.0 - 0.6);
            struct body body = turned_body(angle - PI / 2 + (random_below(&random, 2) ? tilt : -tilt), 1);
            body.x = up * cos(angle) - along * sin(angle);
            body.y = up * sin(angle) + along * cos(angle);
            narc_manifold row[2];
            for (int cut = 0; cut < 2; cut++) {
                struct scene *scene = &ground[cut]->scene;
                body.shape = scene_add_shape(scene, &box);
                scene->body_count = ground[cut]->entry_count;
                scene_add_body(scene, body);
                row[cut] = merge_one(scene, runs, ground[cut]->entry_count);
            }
            pairs += row[0].count == 2;
            assert_int_equal(row[1].count, row[0].count);
            assert_true(
                hypot((double)(row[0].normal_x - row[1].normal_x), (double)(row[0].normal_y - row[1].normal_y)) < 1e-6);
            for (uint32_t i = 0; i < row[0].count; i++) {
                const narc_manifold_point *p = &row[0].point[i], *q = &row[1].point[i];
                assert_true(fabs((double)(p->separation - q->separation)) < 1e-5);
                assert_true(hypot((double)(p->x - q->x), (double)(p->y - q->y)) < 4e-5 * LENGTH);
            }
        }
        assert_true(pairs > TRIALS / 2);
        for (int cut = 0; cut < 2; cut++) {
            destroy_scene(&ground[cut]->scene);
            free(ground[cut]);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ junctions */

/* A ball that rolls over junctions with common tangents, on the ground or a little in it, at and beside them: one contact,
 * with the ground's own normal. */
TEST(test_rolling_over_junctions) {
    struct test_random random = test_random_named("rolling over junctions");
    const double radius = 0.3;
    const struct shape ball = circle_of(radius);
    double worst = 0;
    for (size_t round = 0; round < test_trials(20); round++) {
        struct ground *g = malloc(sizeof *g);
        uint32_t runs[ENTRIES];
        begin_chain(g, 20, 0, PI / 2);
        walk_arc(&g->walk, random_between(&random, 1, 4), 0.2);
        for (int k = 0; k < 20; k++) {
            const double turn = random_between(&random, 0.05, 0.4), large = random_between(&random, 1, 4);
            const bool left = g->walk.normal < PI / 2 && random_below(&random, 4);
            walk_arc(&g->walk, large, left ? turn : -turn);
            if (random_below(&random, 2))
                walk_line(&g->walk, random_between(&random, 0.1, 2));
            if (g->walk.normal < PI / 2 - 0.5)
                walk_arc(&g->walk, large, 0.5);
        }
        walk_arc(&g->walk, 0, 0);
        assert_true(place_chain(g, NULL, 1, 8));
        const uint32_t shape = scene_add_shape(&g->scene, &ball);
        for (uint32_t e = 0; e < g->entry_count; e++)
            runs[e] = g->entries[e].run;
        for (int trial = 0; trial < 400; trial++) {
            const narc_arc *arc = &g->arcs[2 + random_below(&random, g->arc_count - 3)]; /* not at the open end */
            const double part = (double)random_below(&random, 3) * random_log_between(&random, 1e-8, 0.45);
            const double normal = arc->start + part * (arc->end - arc->start), c = cos(normal), s = sin(normal);
            const double deep = (double)random_below(&random, 2) * random_log_between(&random, 1e-6, 0.02);
            const struct spot p = find_chain_point(arc, normal);
            struct body body = turned_body(random_between(&random, -PI, PI), 1);
            body.x = p.x + (radius - deep) * c;
            body.y = p.y + (radius - deep) * s;
            body.shape = shape;
            g->scene.body_count = g->entry_count;
            scene_add_body(&g->scene, body);
            const narc_manifold row = merge_one(&g->scene, runs, g->entry_count);
            worst = fmax(worst, hypot((double)row.normal_x + c, (double)row.normal_y + s));
            assert_true(fabs((double)row.point[0].separation + deep) < 2e-5);
        }
        destroy_scene(&g->scene);
        free(g);
    }
    print_message("  normals off by %.2g at most\n", worst);
    assert_true(worst < 2e-5);
}

/* The separation next to -deep of a box with a corner that points against the normal, `deep` below the place `beside` a chain's
 * arc's start, along the tangent there. */
static double find_corner(struct ground *g, const uint32_t *runs, uint32_t box, double turn, size_t arc, double deep,
                          double beside) {
    struct pair pairs[ENTRIES];
    const double normal = g->arcs[arc].start, c = cos(normal), s = sin(normal), half = 0.2;
    const struct spot p = find_chain_point(&g->arcs[arc], normal);
    struct body body = turned_body(normal - PI / 4 + turn, 1);
    const double x = -half, y = -half, cosine = (double)body.cosine, sine = (double)body.sine;
    body.x = p.x - deep * c - beside * s - (cosine * x - sine * y);
    body.y = p.y - deep * s + beside * c - (sine * x + cosine * y);
    body.shape = box;
    g->scene.body_count = g->entry_count;
    const uint32_t mover = scene_add_body(&g->scene, body);
    for (uint32_t e = 0; e < g->entry_count; e++)
        pairs[e] = (struct pair){mover, e};
    const narc_pairs list = {.count = g->entry_count, .a = NARC_COLUMN(pairs, a), .b = NARC_COLUMN(pairs, b)};
    const narc_bodies bodies = scene_bodies(&g->scene);
    struct manifolds rows = find_manifolds(g->scene.store, &bodies, &list, &(narc_query){.margin = margin});
    const size_t left = narc_merge_manifolds(&list, (narc_index_column){runs, sizeof *runs}, rows.rows, rows.count);
    double best = INFINITY;
    for (size_t k = 0; k < left; k++)
        for (uint32_t i = 0; i < rows.rows[k].count; i++)
            if (fabs((double)rows.rows[k].point[i].separation + deep) < fabs(best + deep))
                best = (double)rows.rows[k].point[i].separation;
    free(rows.rows);
    return best;
}

static void expect_corner(struct ground *g, const uint32_t *runs, uint32_t box, double turn, size_t arc, double deep,
                          double beside) {
    const double found = find_corner(g, runs, box, turn, arc, deep, beside);
    if (!(fabs(found + deep) < 1e-5))
        fail_msg("at arc %zu, %g deep, %g beside, turned by %g: %g", arc, deep, beside, turn, found);
}

static uint32_t add_box(struct ground *g) {
    const struct shape shape = box_of(0.4, 0.4, 0);
    return scene_add_shape(&g->scene, &shape);
}

/* A box whose corner touches a corner that was cut is told of, though the way from one to the other is that of
 * rounding. */
TEST(test_corners_on_cut_corners) {
    struct test_random random = test_random_named("corners on cut corners");
    static const uint32_t runs[ENTRIES] = {0};
    for (size_t round = 0; round < test_trials(40); round++) {
        struct ground *g = calloc(1, sizeof *g);
        const double sides = round % 2 ? 3 : 4, side = random_between(&random, 0.5, 5);
        g->walk = create_turtle(0, 0, random_between(&random, -PI, PI));
        for (int k = 0; k < sides; k++) {
            walk_arc(&g->walk, 0, 2 * PI / sides);
            walk_line(&g->walk, side);
        }
        assert_true(place_chain(g, &(narc_chain_options){.closed = 1}, 2, 8));
        const uint32_t box = add_box(g);
        for (size_t trial = 0; trial < 200; trial++)
            expect_corner(g, runs, box, PI / sides + random_between(&random, -0.5, 0.5),
                          random_below(&random, g->arc_count), 0, 0);
        destroy_scene(&g->scene);
        free(g);
    }
}

/* A box above where a large convex arc and a small concave one meet, its edge along the tangent and its corner there. */
TEST(test_edges_along_junctions) {
    struct test_random random = test_random_named("edges along junctions");
    static const uint32_t runs[ENTRIES] = {0, NARC_NO_RUN, 1};
    for (size_t round = 0; round < test_trials(200); round++) {
        struct ground *g = malloc(sizeof *g);
        const double large = random_between(&random, 0.5, 3), small = large / random_log_between(&random, 3, 300);
        begin_chain(g, random_between(&random, -2, 2), 0, random_between(&random, -PI, PI));
        walk_arc(&g->walk, large, 0.4);
        walk_arc(&g->walk, small, -0.3);
        walk_arc(&g->walk, large, 0.4);
        walk_arc(&g->walk, 0, 0);
        assert_true(place_chain(g, NULL, 2, 8));
        const uint32_t box = add_box(g);
        for (size_t trial = 0; trial < 20; trial++) /* the edge above the convex arc */
            expect_corner(g, runs, box, trial % 2 ? PI / 4 : -PI / 4, trial % 2 ? 3 : 2,
                          -random_log_between(&random, 1e-4, 0.03), 0);
        destroy_scene(&g->scene);
        free(g);
    }
}

/* A corner that is deep below where pieces meet, or next to that, is told of: at concave arcs by lines and by convex arcs,
 * at the bottom of a valley, at a cut. */
TEST(test_corners_below_junctions) {
    struct test_random random = test_random_named("corners below junctions");
    for (size_t round = 0; round < test_trials(20); round++) {
        struct ground *g = malloc(sizeof *g);
        static const uint32_t runs[ENTRIES] = {0, NARC_NO_RUN, 1, NARC_NO_RUN, 2};
        begin_chain(g, 5, 0, PI / 2 + 0.3);
        walk_line(&g->walk, random_between(&random, 0.5, 2)); /* line, concave arc, convex arc, line, valley, line */
        walk_arc(&g->walk, random_between(&random, 0.5, 3), -0.4);
        walk_arc(&g->walk, random_between(&random, 0.5, 2), 0.5);
        walk_line(&g->walk, random_between(&random, 0.5, 2));
        walk_arc(&g->walk, 0, -random_between(&random, 0.1, 0.6));
        walk_line(&g->walk, random_between(&random, 0.5, 2));
        walk_arc(&g->walk, 0, 0);
        assert_true(place_chain(g, NULL, 2, 8));
        assert_int_equal(g->entry_count, 5);
        const uint32_t box = add_box(g);
        for (size_t trial = 0; trial < 300; trial++) {
            const size_t arc = 1 + random_below(&random, 3);
            const double deep = random_log_between(&random, 1e-4, 0.04), turn = random_between(&random, -0.5, 0.5);
            const double beside =
                random_below(&random, 3) ? random_log_between(&random, 1e-9, 1e-3) * deep * (trial % 2 ? 1 : -1) : 0;
            expect_corner(g, runs, box, turn, arc, deep, beside);
        }
        destroy_scene(&g->scene);
        free(g);
    }
}

TEST_MAIN("ground")
