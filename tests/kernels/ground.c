/* SPDX-License-Identifier: MIT
 *
 * ground.c - pieces of chains: contacts are the same in every form in which they can be asked for; cuts and junctions.
 * (Which contacts there are: ground_minima.c.)
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chains.h"
#include "expect.h"
#include "guard.h"
#include "merge.h"
#include "narc_broad_phase.h"
#include "plain.h"
#include "plain_kernels.h"

enum { ENTRIES = 400, MOST_ROWS = 64 };

/* A chain, and a scene with its entries as bodies 0 .. entry_count - 1. */
struct ground_bodies {
    struct scene scene;
    narc_chain_entry entries[ENTRIES];
    size_t entry_count;
    struct chain chain;
    struct turtle walk; /* while it is made */
};

static const float margin = 0.05f;

/* ------------------------------------------------------------------------------------------------ chains */

static struct ground_bodies *begin_chain(double x, double y, double angle) {
    struct ground_bodies *g = calloc(1, sizeof *g);
    assert_non_null(g);
    g->walk = create_turtle(x, y, angle);
    walk_arc(&g->walk, 0, 0);
    return g;
}

static void end_chain(struct ground_bodies *g) {
    destroy_scene(&g->scene);
    free(g->chain.arcs);
    free(g);
}

/* A scene with the entries of what was walked. */
static void place_chain(struct ground_bodies *g, const narc_chain_options *options, size_t bodies, size_t pairs) {
    narc_error error;
    g->chain = end_walk(&g->walk, options && options->closed);
    g->scene = create_scene(NARC_FLOAT32, ENTRIES + bodies, ENTRIES + bodies, pairs);
    if (narc_add_chain(g->scene.store, g->chain.arcs, g->chain.count, options, g->entries, ENTRIES, &g->entry_count,
                       &error) != NARC_OK)
        fail_msg("%s", error.message);
    for (size_t k = 0; k < g->entry_count; k++) {
        const narc_chain_entry *e = &g->entries[k];
        scene_add_body(&g->scene, (struct body){.x = e->x, .y = e->y, .cosine = 1, .scale = 1, .shape = e->shape});
    }
    g->scene.shape_count = narc_count_shapes(g->scene.store);
}

static struct shape make_body(struct test_random *random) {
    const enum family families[] = {FAMILY_SMOOTH, FAMILY_POLYGON, FAMILY_BOX,    FAMILY_CAPSULE, FAMILY_ROUNDED,
                                    FAMILY_CIRCLE, FAMILY_MIXED,   FAMILY_SMOOTH, FAMILY_HALF};
    return make_shape(random, families[random_below(random, sizeof families / sizeof *families)]);
}

/* Bodies near the outline, each with a pair with every entry, as A and as B. */
static void add_movers(struct test_random *random, struct ground_bodies *g, size_t count) {
    struct scene *scene = &g->scene;
    for (size_t k = 0; k < count; k++) {
        const struct shape shape = make_body(random);
        const narc_arc *near = &g->chain.arcs[1 + random_below(random, g->chain.count - 2)];
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

/* ------------------------------------------------------------------------------------------------ answers */

static size_t capacity_of(const struct ground_bodies *g) { return 8 * g->scene.pair_count + 64; }

static struct contacts ask(const struct ground_bodies *g, const narc_query *query) {
    struct contacts out = {make_junk(capacity_of(g) * sizeof *out.rows), 0};
    assert_int_equal(ask_contacts(&g->scene, query, out.rows, capacity_of(g), &out.count, NULL), NARC_OK);
    return out;
}

/* The deepest row of a pair, of those from `row` on; NULL if there is none. */
static const narc_contact *find_deepest_row(const struct contacts *rows, size_t row, uint32_t pair) {
    const narc_contact *deepest = NULL;
    for (; row < rows->count && rows->rows[row].pair == pair; row++)
        if (!deepest || rows->rows[row].separation < deepest->separation)
            deepest = &rows->rows[row];
    return deepest;
}

/* The same rows, in every form. */
static void check_forms(const struct ground_bodies *g, const struct contacts *right) {
    const struct scene *scene = &g->scene;
    const size_t count = scene->pair_count, size = right->count * sizeof *right->rows;
    const narc_workers two = openmp_workers(2);
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

    /* margins of their own, a selection, and one pair at a time */
    AUTO(free_at) float *margins = malloc(count * sizeof *margins);
    AUTO(free_at) uint32_t *selection = malloc(count * sizeof *selection);
    for (size_t k = 0; k < count; k++) {
        margins[k] = margin;
        selection[k] = (uint32_t)(count - 1 - k);
    }
    size_t found = 0;
    const narc_query each = {.margins = NARC_ARRAY(margins)};
    assert_int_equal(ask_contacts(scene, &each, rows.rows, capacity_of(g), &found, NULL), NARC_OK);
    assert_int_equal(found, right->count);
    assert_memory_equal(rows.rows, right->rows, size);
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
    AUTO(free_at) uint64_t *bits = scene_overlaps(scene);
    size_t deepest_count = 0;
    row = 0;
    for (uint32_t k = 0; k < count; k++) {
        const narc_contact *deepest = find_deepest_row(right, row, k);
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
    AUTO(free_at) uint64_t *others = scene_overlaps(scene);
    test_use_isa(test_isa());
    assert_memory_equal(bits, others, NARC_BIT_WORDS(count) * sizeof *bits);
    free(rows.rows);
}

/* The formula alone gives the deepest rows: all batches of a build without shortcuts are answered so. */
static void check_formula(const struct ground_bodies *g, const struct contacts *right) {
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
    AUTO(free_at) narc_contact *rows = make_junk(NARC_ROW_GROUP * sizeof *rows);
    size_t skipped = 0, more = 0, row = 0, all = 0;
    for (size_t first = 0; first < pairs.count; first += NARC_ROW_GROUP) {
        const size_t left = pairs.count - first;
        const narc_rows out = {.base = (char *)rows, .stride = sizeof *rows, .more = &more};
        const size_t found =
            narc_kernels_plain.contact(&batch, first, left < NARC_ROW_GROUP ? left : NARC_ROW_GROUP, &skipped, &out);
        for (size_t k = 0; k < found; k++) {
            const narc_contact *deepest = find_deepest_row(right, row, rows[k].pair);
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
    AUTO(free_at) uint64_t *bits = scene_overlaps(&g->scene);
    AUTO(free_at) uint64_t *plain = make_junk(NARC_BIT_WORDS(pairs.count) * sizeof *plain);
    narc_kernels_plain.overlap(&batch, 0, pairs.count, &skipped, plain);
    assert_memory_equal(bits, plain, NARC_BIT_WORDS(pairs.count) * sizeof *bits);
}

/* The same pairs with both bodies exchanged: the same rows, but where rounding decides which there are. */
static void check_exchanged(struct ground_bodies *g, const struct contacts *right) {
    size_t other = 0, row = 0;
    for (size_t k = 0; k < g->scene.pair_count; k++)
        g->scene.pairs[k] = (struct pair){g->scene.pairs[k].b, g->scene.pairs[k].a};
    struct contacts rows = ask(g, &(narc_query){.margin = margin});
    for (uint32_t k = 0, at = 0; k < g->scene.pair_count; k++) {
        size_t found = 0, count = 0;
        while (at + found < rows.count && rows.rows[at + found].pair == k)
            found++;
        for (; row + count < right->count && right->rows[row + count].pair == k; count++) {
            const narc_contact *c = &right->rows[row + count];
            bool is_there = false;
            for (size_t i = 0; i < found; i++) {
                const narc_contact *d = &rows.rows[at + i];
                is_there |= fabsf(c->separation - d->separation) < 1e-5f && c->radius_a == d->radius_b &&
                            hypotf(c->normal_x + d->normal_x, c->normal_y + d->normal_y) < 1e-3f;
            }
            other += !is_there;
        }
        other += found != count;
        at += (uint32_t)found;
        row += count;
    }
    free(rows.rows);
    if (50 * other > right->count + 50)
        fail_msg("%zu of %zu rows are other ones with bodies exchanged", other, right->count);
}

static bool has_several(const struct contacts *rows) {
    for (size_t k = 1; k < rows->count; k++)
        if (rows->rows[k].pair == rows->rows[k - 1].pair)
            return true;
    return false;
}

/* A chain of a family that makes entries, with room for bodies that each have a pair with every entry. */
static struct ground_bodies *begin_family(struct test_random *random, enum chain_family family, size_t bodies) {
    narc_shapes *probe = empty_store();
    struct chain chain;
    narc_chain_entry entries[ENTRIES];
    size_t count;
    while (chain = make_chain(random, family),
           chain.count < 3 ||
               narc_add_chain(probe, chain.arcs, chain.count, &(narc_chain_options){.closed = chain.closed}, entries,
                              ENTRIES, &count, NULL) != NARC_OK)
        free(chain.arcs);
    narc_destroy_shapes(probe);
    struct ground_bodies *g = begin_chain(0, 0, 0);
    free(g->walk.arcs);
    g->walk.arcs = chain.arcs;
    g->walk.count = chain.count;
    place_chain(g, &(narc_chain_options){.closed = chain.closed, .first_run = 7}, bodies, ENTRIES * bodies);
    return g;
}

/* Hills, bowls, and what is thinner than bodies, so that what faces away is not reached. */
TEST(test_forms) {
    static const enum chain_family families[] = {CHAIN_BOWLS, CHAIN_MIXED, CHAIN_HILLS, CHAIN_ARCH, CHAIN_SHEET};
    enum { MOVERS = 60, FAMILIES = sizeof families / sizeof *families };
    struct test_random random = test_random_named("forms");
    bool several = false;
    const size_t rounds = test_trials(20);
    for (size_t round = 0; round < rounds || !several; round++) {
        struct ground_bodies *g = begin_family(&random, families[round % FAMILIES], MOVERS);
        add_movers(&random, g, MOVERS);
        struct contacts right = ask(g, &(narc_query){.margin = margin});
        several |= has_several(&right);
        check_forms(g, &right);
        check_formula(g, &right);
        check_exchanged(g, &right);
        free(right.rows);
        end_chain(g);
    }
}

/* Circles above and below where arcs and edges meet, and a little beside: on their own origin, and off it. */
TEST(test_circles_at_junctions) {
    static const enum chain_family families[] = {CHAIN_HILLS, CHAIN_MIXED, CHAIN_BOWLS, CHAIN_ARCH, CHAIN_SHEET};
    enum { CIRCLES = 200, FAMILIES = sizeof families / sizeof *families };
    struct test_random random = test_random_named("circles at junctions");
    const size_t rounds = test_trials(40);
    for (size_t round = 0; round < rounds; round++) {
        struct ground_bodies *g = begin_family(&random, families[round % FAMILIES], CIRCLES);
        for (uint32_t k = 0; k < CIRCLES; k++) {
            const narc_arc *near = &g->chain.arcs[random_below(&random, g->chain.count)];
            const double angle = random_below(&random, 2) ? near->start : near->end, c = cos(angle), s = sin(angle);
            const double off = random_below(&random, 2) ? random_between(&random, -2, 2) : 0;
            const struct shape shape = {.count = 1, .arcs = {{off, off / 2, 1, -PI, PI}}};
            const double scale = random_log_between(&random, 0.01, 1);
            const double beside = random_log_between(&random, 1e-9, 0.1) * (random_below(&random, 2) ? 1 : -1);
            const double above =
                random_below(&random, 3)
                    ? scale * (1 + random_log_between(&random, 1e-7, 0.1) * (random_below(&random, 2) ? 1 : -1))
                    : beside * random_between(&random, -8, 8);
            struct body body = turned_body(random_between(&random, -PI, PI), scale);
            const double x = near->center_x + (near->radius + above) * c - beside * s,
                         y = near->center_y + (near->radius + above) * s + beside * c;
            body.x = x - scale * off * ((double)body.cosine - (double)body.sine / 2);
            body.y = y - scale * off * ((double)body.sine + (double)body.cosine / 2);
            body.shape = scene_add_shape(&g->scene, &shape);
            const uint32_t circle = scene_add_body(&g->scene, body);
            for (uint32_t e = 0; e < g->entry_count; e++)
                scene_add_pair(&g->scene, (e + k) % 2 ? e : circle, (e + k) % 2 ? circle : e);
        }
        struct contacts right = ask(g, &(narc_query){.margin = margin});
        check_formula(g, &right);
        free(right.rows);
        end_chain(g);
    }
}

/* Lines, some nearly upright or level, and corners and arcs between them that turn to one side, many of them hardly. */
static struct ground_bodies *begin_lines(struct test_random *random, size_t bodies) {
    const double upright = PI / 2 * (double)random_below(random, 4) - random_log_between(random, 1e-9, 1e-4);
    struct ground_bodies *g = begin_chain(0, 0, random_below(random, 4) ? random_between(random, -PI, PI) : upright);
    const size_t lines = 1 + random_below(random, 3);
    for (size_t k = 0; k < lines; k++) {
        walk_line(&g->walk, random_log_between(random, random_below(random, 4) ? 0.3 : 1e-7, 4));
        const double turn = random_below(random, 3) ? random_log_between(random, 1.1e-5, 1e-3) : 0.15;
        walk_arc(&g->walk, random_below(random, 2) ? 0 : random_log_between(random, 0.1, 2), turn);
    }
    walk_line(&g->walk, 1);
    walk_arc(&g->walk, 0, 0);
    place_chain(g, NULL, bodies, ENTRIES * bodies);
    return g;
}

static void check_manifolds(const struct ground_bodies *g, float flat_angle) {
    const narc_bodies bodies = scene_bodies(&g->scene);
    const narc_pairs pairs = scene_pairs(&g->scene);
    const narc_query query = {.margin = margin, .flat_angle = flat_angle};
    AUTO(free_at) struct manifolds rows = find_manifolds(g->scene.store, &bodies, &pairs, &query);
    AUTO(free_at) struct manifolds plain = find_plain_manifolds(g->scene.store, &bodies, &pairs, &query);
    assert_int_equal(rows.count, plain.count);
    assert_memory_equal(rows.rows, plain.rows, plain.count * sizeof *plain.rows);
}

/* Boxes and capsules on edges and near their ends, a side along them or nearly, or a corner: contacts, and manifolds.
 * Between the normals of an edge and of a side there may be that of the next edge; edges and sides may be as short as
 * rounding, and two sides of a body equally near. */
TEST(test_sides_on_edges) {
    enum { BODIES = 200 };
    struct test_random random = test_random_named("sides on edges");
    for (size_t round = 0; round < test_trials(120); round++) {
        struct ground_bodies *g = begin_lines(&random, BODIES);
        for (uint32_t k = 0; k < BODIES; k++) {
            const double thin = random_below(&random, 4) ? 0.05 : 1e-7; /* a side may be as short as rounding */
            const double x = random_log_between(&random, 0.05, 1), y = random_log_between(&random, thin, 1);
            const double radius = random_below(&random, 2) ? 0 : random_log_between(&random, 0.02, 1);
            const struct shape capsule = {.count = 2,
                                          .arcs = {{x, 0, y, -PI / 2, PI / 2}, {-x, 0, y, PI / 2, 3 * PI / 2}}};
            const struct shape box = box_of(2 * (x + radius), 2 * (y + radius), radius);
            const struct shape shape = random_below(&random, 3) ? box : capsule;
            const narc_arc *near = &g->chain.arcs[1 + random_below(&random, g->chain.count - 1)];
            const double c = cos(near->start), s = sin(near->start), sign = random_below(&random, 2) ? 1 : -1;
            const double length = hypot(near->center_x - near[-1].center_x, near->center_y - near[-1].center_y);
            const double tilts[] = {sign * random_log_between(&random, 1e-8, 1e-3), 0, PI / 4,
                                    random_between(&random, -PI, PI)};
            const double tilt = tilts[random_below(&random, 2) ? 0 : random_below(&random, 4)];
            const double turned = near->start + (double)random_below(&random, 4) * PI / 2 + tilt;
            const double back = random_below(&random, 2)
                                    ? random_between(&random, 0, length)
                                    : (x + radius) * (1 + sign * random_log_between(&random, 1e-7, 1));
            struct body body = turned_body(turned, 1);
            body.shape = scene_add_shape(&g->scene, &shape);
            double reach = 0; /* towards the edge */
            for (size_t i = 0; i < shape.count; i++) {
                const narc_arc *arc = &shape.arcs[i];
                reach = fmax(reach, arc->radius - cos(turned - near->start) * arc->center_x +
                                        sin(turned - near->start) * arc->center_y);
            }
            const double above =
                reach + near->radius + (random_below(&random, 2) ? sign : 1) * random_log_between(&random, 1e-8, x + y);
            body.x = near->center_x + above * c + back * s;
            body.y = near->center_y + above * s - back * c;
            const uint32_t mover = scene_add_body(&g->scene, body);
            for (uint32_t e = 0; e < g->entry_count; e++)
                scene_add_pair(&g->scene, (e + k) % 2 ? e : mover, (e + k) % 2 ? mover : e);
        }
        struct contacts right = ask(g, &(narc_query){.margin = margin});
        check_formula(g, &right);
        const float flats[] = {0, 0.7853982f, NARC_MAX_FLAT_ANGLE, -1};
        check_manifolds(g, flats[round % 4]);
        free(right.rows);
        end_chain(g);
    }
}

/* Capsules that stand upright on an edge before a corner: both their sides are equally near, but for rounding. */
TEST(test_upright_capsules) {
    enum { CAPSULES = 200 };
    const struct shape capsule = {.count = 2, .arcs = {{1, 0, 0.1, -PI / 2, PI / 2}, {-1, 0, 0.1, PI / 2, 3 * PI / 2}}};
    for (int round = 0; round < 20; round++) {
        const double angle = 0.01 * round - 3, c = cos(angle), s = sin(angle);
        struct ground_bodies *g = begin_chain(0, 0, angle);
        walk_line(&g->walk, 2);
        walk_arc(&g->walk, 0, 0.15);
        walk_line(&g->walk, 1);
        walk_arc(&g->walk, 0, 0);
        place_chain(g, NULL, CAPSULES, CAPSULES);
        const uint32_t shape = scene_add_shape(&g->scene, &capsule);
        for (uint32_t k = 0; k < CAPSULES; k++) {
            const double along = 1.9 + 4e-4 * k;
            struct body body = turned_body(angle, 1);
            body.shape = shape;
            body.x = 1.1 * c - along * s;
            body.y = 1.1 * s + along * c;
            const uint32_t mover = scene_add_body(&g->scene, body);
            scene_add_pair(&g->scene, k % 2 ? 0 : mover, k % 2 ? mover : 0);
        }
        check_manifolds(g, 0);
        end_chain(g);
    }
}

/* In a vector with a circle on a run there are pairs of others: nothing is read behind the last shape of all. */
TEST(test_last_shape_beside_runs) {
    enum { PAIRS = 64 };
    const narc_arc hill[] = {{0, -2, 2, 0.8, 1.2}, {0, -2, 2, 1.2, 2}, {0, -2, 2, 2, 2.3}};
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = NULL;
    narc_chain_entry entry;
    size_t count, found;
    uint32_t last = 0;
    assert_int_equal(narc_create_shapes(&guard_allocator, &shapes), NARC_OK);
    assert_int_equal(narc_add_chain(shapes, hill, 3, NULL, &entry, 1, &count, NULL), NARC_OK);
    for (int k = 0; shapes->record_count + 3 <= shapes->record_capacity || k == 0; k++) {
        const narc_arc circle = {0, 0, 1 + 0.01 * k, -PI, PI};
        assert_int_equal(narc_add_shape(shapes, &circle, 1, &last, NULL), NARC_OK);
    }
    const narc_body body[] = {{0, 1, 1, 0, 1, last}, {entry.x, entry.y, 1, 0, 1, entry.shape}, {0, 2, 1, 0, 1, last}};
    uint32_t a[PAIRS] = {0}, b[PAIRS];
    narc_contact contacts[PAIRS];
    for (uint32_t k = 0; k < PAIRS; k++)
        b[k] = 1 + k % 2;
    narc_bodies bodies;
    narc_view_bodies(body, 3, &bodies);
    const narc_pairs pairs = {.count = PAIRS, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    assert_int_equal(narc_find_contacts(shapes, &bodies, &pairs, NULL, contacts, PAIRS, &found, NULL), NARC_OK);
    assert_int_equal(found, PAIRS);
}

/* ------------------------------------------------------------------------------------------------ plain cases */

/* The rows of a body of this shape in one place against all entries, as A. */
static struct contacts ask_one(struct ground_bodies *g, struct shape shape, double x, double y) {
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
    const double half = 0.8, deep = 2 * cos(half);
    struct ground_bodies *g = begin_chain(2 * sin(half), -deep, PI / 2 + half);
    walk_arc(&g->walk, 2, -2 * half);
    walk_arc(&g->walk, 0, 0);
    place_chain(g, NULL, 8, 64);
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
    end_chain(g);
}

/* ------------------------------------------------------------------------------------------------ cut lines */

static narc_manifold merge_one(const struct scene *scene, const uint32_t *runs, size_t entries) {
    struct pair pairs[ENTRIES];
    for (uint32_t e = 0; e < entries; e++)
        pairs[e] = (struct pair){(uint32_t)entries, e};
    const narc_pairs list = {.count = entries, .a = NARC_COLUMN(pairs, a), .b = NARC_COLUMN(pairs, b)};
    const narc_bodies bodies = scene_bodies(scene);
    AUTO(free_at) struct manifolds rows = find_manifolds(scene->store, &bodies, &list, &(narc_query){.margin = margin});
    const size_t left = narc_merge_rows(
        &(narc_merging){&list, {runs, sizeof *runs}, scene->store, &bodies, .manifolds = rows.rows}, rows.count);
    if (left != 1)
        fail_msg("%zu rows of %zu", left, rows.count);
    return rows.rows[0];
}

/* A box as wide as a quarter of `weld`, or less, has the same manifold on a line that is cut as on one that is not,
 * wherever it lies and however little it is tilted. */
TEST(test_cut_lines) {
    struct test_random random = test_random_named("cut lines");
    enum { TRIALS = 2000, LENGTH = 12 };
    static const uint32_t runs[ENTRIES] = {0};
    for (size_t round = 0; round < test_trials(4); round++) {
        struct ground_bodies *ground[2];
        const double angle = round % 4 ? random_between(&random, 0, 2 * PI) : PI / 2;
        const double weld = random_between(&random, 0.5, 3);
        for (int cut = 0; cut < 2; cut++) {
            ground[cut] = begin_chain(LENGTH / 2.0 * sin(angle), -LENGTH / 2.0 * cos(angle), angle);
            walk_line(&ground[cut]->walk, LENGTH);
            walk_arc(&ground[cut]->walk, 0, 0);
            place_chain(ground[cut], &(narc_chain_options){.weld = cut ? weld : LENGTH}, TRIALS, 1);
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
        for (int cut = 0; cut < 2; cut++)
            end_chain(ground[cut]);
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
        struct ground_bodies *g;
        uint32_t runs[ENTRIES];
        g = begin_chain(20, 0, PI / 2);
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
        place_chain(g, NULL, 1, 8);
        const uint32_t shape = scene_add_shape(&g->scene, &ball);
        for (uint32_t e = 0; e < g->entry_count; e++)
            runs[e] = g->entries[e].run;
        for (int trial = 0; trial < 400; trial++) {
            const narc_arc *arc =
                &g->chain.arcs[2 + random_below(&random, g->chain.count - 3)]; /* not at the open end */
            const double part = (double)random_below(&random, 3) * random_log_between(&random, 1e-8, 0.45);
            const double normal = arc->start + part * (arc->end - arc->start), c = cos(normal), s = sin(normal);
            const double deep = (double)random_below(&random, 2) * random_log_between(&random, 1e-6, 0.02);
            const narc_point p = chain_point(arc, normal);
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
        end_chain(g);
    }
    print_message("  normals off by %.2g at most\n", worst);
    assert_true(worst < 2e-5);
}

/* The separation next to -deep of a box with a corner that points against the normal, `deep` below the place `beside` a chain's
 * arc's start, along the tangent there. */
static double find_corner(struct ground_bodies *g, const uint32_t *runs, uint32_t box, double turn, size_t arc,
                          double deep, double beside) {
    struct pair pairs[ENTRIES];
    const double normal = g->chain.arcs[arc].start, c = cos(normal), s = sin(normal), half = 0.2;
    const narc_point p = chain_point(&g->chain.arcs[arc], normal);
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
    AUTO(free_at)
    struct manifolds rows = find_manifolds(g->scene.store, &bodies, &list, &(narc_query){.margin = margin});
    const size_t left = narc_merge_rows(
        &(narc_merging){&list, {runs, sizeof *runs}, g->scene.store, &bodies, .manifolds = rows.rows}, rows.count);
    double best = INFINITY;
    for (size_t k = 0; k < left; k++)
        for (uint32_t i = 0; i < rows.rows[k].count; i++)
            if (fabs((double)rows.rows[k].point[i].separation + deep) < fabs(best + deep))
                best = (double)rows.rows[k].point[i].separation;
    return best;
}

static void expect_corner(struct ground_bodies *g, const uint32_t *runs, uint32_t box, double turn, size_t arc,
                          double deep, double beside) {
    const double found = find_corner(g, runs, box, turn, arc, deep, beside);
    if (!(fabs(found + deep) < 1e-5))
        fail_msg("at arc %zu, %g deep, %g beside, turned by %g: %g", arc, deep, beside, turn, found);
}

static uint32_t add_box(struct ground_bodies *g) {
    const struct shape shape = box_of(0.4, 0.4, 0);
    return scene_add_shape(&g->scene, &shape);
}

/* A box whose corner touches a corner that was cut is told of, though the way from one to the other is that of
 * rounding. */
TEST(test_corners_on_cut_corners) {
    struct test_random random = test_random_named("corners on cut corners");
    static const uint32_t runs[ENTRIES] = {0};
    for (size_t round = 0; round < test_trials(40); round++) {
        struct ground_bodies *g = begin_chain(0, 0, random_between(&random, -PI, PI));
        const double sides = round % 2 ? 3 : 4, side = random_between(&random, 0.5, 5);
        g->walk.count = 0; /* closed: it begins with a corner */
        for (int k = 0; k < sides; k++) {
            walk_arc(&g->walk, 0, 2 * PI / sides);
            walk_line(&g->walk, side);
        }
        place_chain(g, &(narc_chain_options){.closed = 1}, 2, 8);
        const uint32_t box = add_box(g);
        for (size_t trial = 0; trial < 200; trial++)
            expect_corner(g, runs, box, PI / sides + random_between(&random, -0.5, 0.5),
                          random_below(&random, g->chain.count), 0, 0);
        end_chain(g);
    }
}

/* A box above where a large convex arc and a small concave one meet, its edge along the tangent and its corner there. */
TEST(test_edges_along_junctions) {
    struct test_random random = test_random_named("edges along junctions");
    static const uint32_t runs[ENTRIES] = {0, NARC_NO_RUN, 1};
    for (size_t round = 0; round < test_trials(200); round++) {
        struct ground_bodies *g;
        const double large = random_between(&random, 0.5, 3), small = large / random_log_between(&random, 3, 300);
        g = begin_chain(random_between(&random, -2, 2), 0, random_between(&random, -PI, PI));
        walk_arc(&g->walk, large, 0.4);
        walk_arc(&g->walk, small, -0.3);
        walk_arc(&g->walk, large, 0.4);
        walk_arc(&g->walk, 0, 0);
        place_chain(g, NULL, 2, 8);
        const uint32_t box = add_box(g);
        for (size_t trial = 0; trial < 20; trial++) /* the edge above the convex arc */
            expect_corner(g, runs, box, trial % 2 ? PI / 4 : -PI / 4, trial % 2 ? 3 : 2,
                          -random_log_between(&random, 1e-4, 0.03), 0);
        end_chain(g);
    }
}

/* A corner that is deep below where pieces meet, or next to that, is told of: at concave arcs by lines and by convex arcs,
 * at the bottom of a valley, at a cut. */
TEST(test_corners_below_junctions) {
    struct test_random random = test_random_named("corners below junctions");
    for (size_t round = 0; round < test_trials(20); round++) {
        struct ground_bodies *g;
        static const uint32_t runs[ENTRIES] = {0, NARC_NO_RUN, 1, NARC_NO_RUN, 2};
        g = begin_chain(5, 0, PI / 2 + 0.3);
        walk_line(&g->walk, random_between(&random, 0.5, 2)); /* line, concave arc, convex arc, line, valley, line */
        walk_arc(&g->walk, random_between(&random, 0.5, 3), -0.4);
        walk_arc(&g->walk, random_between(&random, 0.5, 2), 0.5);
        walk_line(&g->walk, random_between(&random, 0.5, 2));
        walk_arc(&g->walk, 0, -random_between(&random, 0.1, 0.6));
        walk_line(&g->walk, random_between(&random, 0.5, 2));
        walk_arc(&g->walk, 0, 0);
        place_chain(g, NULL, 2, 8);
        assert_int_equal(g->entry_count, 5);
        const uint32_t box = add_box(g);
        for (size_t trial = 0; trial < 300; trial++) {
            const size_t arc = 1 + random_below(&random, 3);
            const double deep = random_log_between(&random, 1e-4, 0.04), turn = random_between(&random, -0.5, 0.5);
            const double beside =
                random_below(&random, 3) ? random_log_between(&random, 1e-9, 1e-3) * deep * (trial % 2 ? 1 : -1) : 0;
            expect_corner(g, runs, box, turn, arc, deep, beside);
        }
        end_chain(g);
    }
}

TEST_MAIN("ground")
