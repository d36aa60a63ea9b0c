/* SPDX-License-Identifier: MIT
 *
 * searches.c - rays, points and movers through an index against each body asked by itself, to the last bit: with all
 * options, masks, worlds, ignored bodies and owners, in any tree, by any workers, in any order.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "expect.h"
#include "guard.h"
#include "narc_broad_phase.h"
#include "ray_room.h"

/* A room and what is looked for in it. */
struct search {
    struct room room;
    size_t count;
    struct test_ray *items; /* rays; points are where they begin, and movers, which go the same way */
    struct body *movers;
    narc_motion *motion;
    float *targets; /* of movers */
    uint64_t *mask;
    uint32_t *ignored, *ignored_owner, *owner; /* the latter: of bodies, */
    uint32_t *world, *asked_world;             /* and the former of these */
    bool longest;                              /* 2^-24 of a motion is more than the whole room */
};

struct options {
    size_t most;
    narc_inside inside;
    bool any, within, masks, ignored, owners, worlds;
    float distance;
};

/* How rows of all kinds begin. */
struct found {
    uint32_t number, body;
    uint16_t feature, count;
    float key;
};

/* ------------------------------------------------------------------------------------------------ asking */

static narc_bodies movers_of(const struct search *s) {
    struct scene scene = s->room.scene;
    scene.bodies = s->movers;
    scene.body_count = s->count;
    return scene_bodies(&scene);
}

static narc_points points_of(const struct search *s) {
    const narc_rays rays = view_rays(s->items, s->count);
    return (narc_points){.count = s->count, .x = rays.x, .y = rays.y};
}

static narc_status ask_rays(const struct search *s, const narc_bodies *bodies, const struct options *o,
                            const narc_index_query *search, void *rows, narc_error *error) {
    const narc_rays rays = view_rays(s->items, s->count);
    const narc_ray_options options = {.search = *search, .inside = o->inside, .any = o->any, .most = o->most};
    return narc_cast_rays(s->room.index, s->room.scene.store, bodies, &rays, &options, rows, s->count * o->most, error);
}

static narc_status ask_points(const struct search *s, const narc_bodies *bodies, const struct options *o,
                              const narc_index_query *search, void *rows, narc_error *error) {
    const narc_points points = points_of(s);
    const narc_nearest_options options = {
        .search = *search, .distance = o->distance, .inside = o->within, .most = o->most};
    return narc_find_nearest(s->room.index, s->room.scene.store, bodies, &points, &options, rows, s->count * o->most,
                             error);
}

static narc_status ask_movers(const struct search *s, const narc_bodies *bodies, const struct options *o,
                              const narc_index_query *search, void *rows, narc_error *error) {
    const narc_bodies movers = movers_of(s);
    const narc_motions motions = view_motions(s->motion);
    const narc_cast_options options = {.targets = {s->targets, sizeof *s->targets}};
    (void)o;
    return narc_cast_shapes(s->room.index, s->room.scene.store, bodies, &movers, &motions, search, &options, rows,
                            s->count, error);
}

/* Of all items and a body by itself. */
static narc_status ask_body_for_rays(const struct search *s, uint32_t body, narc_inside inside, void *rows,
                                     narc_error *error) {
    struct search alone = *s;
    alone.room.scene.bodies += body;
    alone.room.scene.body_count = 1;
    const narc_bodies bodies = scene_bodies(&alone.room.scene);
    expect_ok(narc_create_index(NULL, &alone.room.index), error);
    expect_ok(narc_build_index(alone.room.index, &s->room.boxes[body], 1, NULL, error), error);
    const narc_status status =
        ask_rays(&alone, &bodies, &(struct options){.most = 1, .inside = inside}, &(narc_index_query){0}, rows, error);
    narc_destroy_index(alone.room.index);
    return status;
}

static narc_status ask_body_for_points(const struct search *s, uint32_t body, narc_inside inside, void *rows,
                                       narc_error *error) {
    const narc_bodies bodies = scene_bodies(&s->room.scene);
    const narc_points points = points_of(s);
    (void)inside;
    return narc_find_distances(s->room.scene.store, &bodies, &points, &(narc_index_column){&body, 0}, NULL, rows,
                               error);
}

static narc_status ask_body_for_movers(const struct search *s, uint32_t body, narc_inside inside, void *rows,
                                       narc_error *error) {
    const narc_bodies movers = movers_of(s), bodies = scene_bodies(&s->room.scene);
    const narc_motions motions = view_motions(s->motion);
    AUTO(guard_release_at) uint32_t *const numbers = guard_allocate(s->count * sizeof *numbers);
    for (uint32_t k = 0; k < s->count; k++)
        numbers[k] = k;
    const narc_pairs pairs = {.count = s->count, .a = NARC_ARRAY(numbers), .b = {&body, 0}, .other_bodies = &bodies};
    const narc_cast_options options = {.targets = {s->targets, sizeof *s->targets}};
    (void)inside;
    return narc_cast_pairs(s->room.scene.store, &movers, &motions, &pairs, NULL, &options, rows, s->count, error);
}

static const struct kind {
    const char *name;
    size_t size;
    narc_status (*ask)(const struct search *s, const narc_bodies *bodies, const struct options *o,
                       const narc_index_query *search, void *rows, narc_error *error);
    narc_status (*ask_body)(const struct search *s, uint32_t body, narc_inside inside, void *rows, narc_error *error);
} kinds[] = {{"rays", sizeof(narc_ray_hit), ask_rays, ask_body_for_rays},
             {"points", sizeof(narc_distance), ask_points, ask_body_for_points},
             {"movers", sizeof(narc_impact), ask_movers, ask_body_for_movers}};
enum { RAYS, POINTS, MOVERS, KINDS };

/* Row b * count + k: item k and body b. */
static char *ask_one_by_one(const struct search *s, const struct kind *kind, narc_inside inside) {
    const size_t bodies = s->room.scene.body_count, size = kind->size;
    char *const all = make_junk(s->count * bodies * size);
    narc_error error;
    for (uint32_t b = 0; b < bodies; b++) {
        char *const rows = all + b * s->count * size;
        expect_ok(kind->ask_body(s, b, inside, rows, &error), &error);
        for (size_t k = 0; k < s->count; k++) {
            struct found found;
            memcpy(&found, rows + k * size, sizeof found);
            found.body = found.count ? b : 0;
            memcpy(rows + k * size, &found, sizeof found);
        }
    }
    return all;
}

/* ------------------------------------------------------------------------------------------------ what is right */

struct candidate {
    struct found found;
    const char *row;
};

static int compare_candidates(const void *left, const void *right) {
    const struct found *const a = &((const struct candidate *)left)->found, *const b =
                                                                                &((const struct candidate *)right)
                                                                                     ->found;
    if (a->key < b->key || a->key > b->key)
        return a->key < b->key ? -1 : 1;
    return (a->body > b->body) - (a->body < b->body);
}

static bool is_wanted(const struct search *s, const struct options *o, bool categories, size_t item,
                      const struct found *found) {
    const uint64_t mask = o->masks ? s->mask[item] : UINT64_MAX;
    const bool near = o->distance == 0 || found->key < o->distance;
    return found->count && !(o->worlds && s->world[found->body] != s->asked_world[item]) &&
           (mask & (categories ? s->room.category[found->body] : UINT64_MAX)) != 0 && near &&
           !(o->within && found->key >= 0) && !(o->ignored && s->ignored[item] == found->body) &&
           !(o->owners && s->ignored_owner[item] != UINT32_MAX && s->owner[found->body] == s->ignored_owner[item]);
}

/* Those that the options let pass, in order; of each owner the first. */
static size_t list_candidates(const struct search *s, const struct kind *kind, const struct options *o, bool categories,
                              const char *all, size_t item, struct candidate *list) {
    size_t count = 0, kept = 0;
    for (size_t b = 0; b < s->room.scene.body_count; b++) {
        struct candidate *const next = &list[count];
        next->row = all + (b * s->count + item) * kind->size;
        memcpy(&next->found, next->row, sizeof next->found);
        count += is_wanted(s, o, categories, item, &next->found);
    }
    qsort(list, count, sizeof *list, compare_candidates);
    for (size_t k = 0; k < count; k++) {
        const uint32_t owner = s->owner[list[k].found.body];
        bool first = true;
        for (size_t i = 0; i < kept && o->owners && owner != UINT32_MAX; i++)
            first = first && s->owner[list[i].found.body] != owner;
        if (first)
            list[kept++] = list[k];
    }
    return kept;
}

/* Of a mover. */
static bool touches_at_start(const struct search *s, size_t item, const char *row) {
    narc_impact hit;
    memcpy(&hit, row, sizeof hit);
    return hit.fraction == 0 && hit.separation <= s->targets[item];
}

static void check_rows(const struct search *s, const struct kind *kind, const struct options *o, bool categories,
                       const char *all, const char *rows) {
    AUTO(free_at) struct candidate *const list = calloc(s->room.scene.body_count + 1, sizeof *list);
    AUTO(free_at) char *const none = calloc(1, kind->size);
    assert_true(list && none);
    for (uint32_t k = 0; k < s->count; k++) {
        const size_t count = list_candidates(s, kind, o, categories, all, k, list);
        if (o->owners && kind == &kinds[POINTS] && count > 0 && list[0].found.key < 0)
            continue; /* the depth is that of a thing, not of a part: distances.c */
        memcpy(none, &k, sizeof k);
        for (size_t i = 0; i < o->most; i++) {
            const char *const row = rows + (k * o->most + i) * kind->size, *right = i < count ? list[i].row : none;
            if (o->any && i > 0)
                right = none;
            const bool choice = s->longest && kind == &kinds[MOVERS];
            bool open = o->any || choice;
            for (size_t other = 0; open && i == 0 && other < count; other++) {
                if (memcmp(row, list[other].row, kind->size) == 0)
                    right = row;
                open = o->any || !touches_at_start(s, k, list[other].row);
            }
            if (choice && open && memcmp(row, none, kind->size) == 0)
                right = row;
            if (memcmp(row, right, kind->size) != 0)
                fail_msg("row %zu of %s %u differs", i, kind->name, k);
        }
    }
}

/* Builds the index, well, fast, from other boxes and then updated, or with boxes that have grown. */
static void build(struct test_random *random, struct search *s, size_t way, bool categories, bool worlds) {
    static const uint32_t first[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    const size_t count = s->room.scene.body_count;
    AUTO(free_at) narc_box *const boxes = calloc(count + 1, sizeof *boxes);
    narc_index_options options = {.fast = way == 1};
    narc_error error;
    if (categories)
        options.category = (narc_word_column){s->room.category, sizeof *s->room.category};
    if (worlds)
        options.world = (narc_index_column){s->world, sizeof *s->world};
    for (size_t k = 0; k < count; k++) {
        boxes[k] = s->room.boxes[way == 2 ? count - 1 - k : k];
        if (way == 3 && boxes[k].min_x <= boxes[k].max_x) {
            boxes[k].min_x -= (float)random_between(random, 0, 1);
            boxes[k].max_y += (float)random_between(random, 0, 1);
        }
    }
    expect_ok(narc_build_index(s->room.index, boxes, count, &options, &error), &error);
    if (way == 2) /* the first ones by a list, then all */
        for (size_t k = 0; k < 2; k++) {
            const narc_index_column changed = NARC_ARRAY(first);
            expect_ok(narc_update_index(s->room.index, s->room.boxes, count, k ? NULL : &changed,
                                        k || count < 9 ? 0 : 9, &options, &error),
                      &error);
        }
}

static const struct options options[] = {
    {.most = 1},
    {.most = 5, .masks = true},
    {.most = 2, .ignored = true},
    {.most = 40, .masks = true, .ignored = true},
    {.most = 1, .any = true},
    {.most = 3, .any = true, .masks = true, .ignored = true},
    {.most = 1, .owners = true},
    {.most = 3, .owners = true, .masks = true},
    {.most = 5, .within = true, .owners = true, .distance = INFINITY},
    {.most = 5, .distance = 0.3f},
    {.most = 1, .distance = -0.2f},
    {.most = 3, .inside = NARC_INSIDE_LEAVES},
    {.most = 1, .inside = NARC_INSIDE_LEAVES, .any = true, .masks = true},
    {.most = 1, .inside = NARC_INSIDE_IGNORES, .masks = true},
    {.most = 7, .inside = NARC_INSIDE_IGNORES, .ignored = true},
};

/* Asks in all ways. Distances are options of points alone, insides those of rays, and movers have one row each. */
static void check_kind(struct test_random *random, struct search *s, const struct kind *kind) {
    const narc_bodies bodies = scene_bodies(&s->room.scene);
    const narc_owners owners = {.owner = {s->owner, sizeof *s->owner},
                                .ignored = {s->ignored_owner, sizeof *s->ignored_owner}};
    narc_inside inside = NARC_INSIDE_STOPS;
    char *all = ask_one_by_one(s, kind, inside);
    for (size_t k = 0; k < sizeof options / sizeof *options; k++) {
        const narc_workers workers = openmp_workers((unsigned)k % 4);
        const bool categories = k % 5 < 3;
        struct options o = options[k];
        narc_index_query search = {.workers = &workers};
        narc_error error;
        if (kind != &kinds[RAYS])
            o.any = false;
        if (kind != &kinds[POINTS])
            o.distance = o.within = 0;
        if (kind == &kinds[MOVERS])
            o.most = 1;
        if (o.inside != inside && kind == &kinds[RAYS]) {
            inside = o.inside;
            free(all);
            all = ask_one_by_one(s, kind, inside);
        }
        if (o.masks)
            search.mask = (narc_word_column){s->mask, sizeof *s->mask};
        if (o.ignored)
            search.ignored = (narc_index_column){s->ignored, sizeof *s->ignored};
        if (o.owners)
            search.owners = &owners;
        const bool worlds = k / 4 % 2;
        o.worlds = worlds && k % 3;
        if (o.worlds)
            search.world = (narc_index_column){s->asked_world, sizeof *s->asked_world};
        AUTO(guard_release_at) char *const rows = guard_allocate(s->count * o.most * kind->size);
        build(random, s, k % 4, categories, worlds);
        expect_ok(kind->ask(s, &bodies, &o, &search, rows, &error), &error);
        check_rows(s, kind, &o, categories, all, rows);
    }
    free(all);
}

/* ------------------------------------------------------------------------------------------------ what is looked for */

/* Rays of a room; a part begins where a body is, and of doubles some where these are coarse. Movers are of any shape, and
 * most turn. */
static struct search make_search(struct test_random *random, narc_precision precision, size_t bodies, size_t count,
                                 double side) {
    struct search s = {.room = create_room(random, precision, bodies, side), .count = count};
    s.items = make_rays(random, &s.room, count, side);
    s.movers = calloc(count, sizeof *s.movers);
    s.motion = calloc(count, sizeof *s.motion);
    s.targets = calloc(count, sizeof *s.targets);
    s.mask = calloc(count, sizeof *s.mask);
    s.ignored = calloc(count, sizeof *s.ignored);
    s.ignored_owner = calloc(count, sizeof *s.ignored_owner);
    s.owner = calloc(bodies, sizeof *s.owner);
    s.world = calloc(bodies, sizeof *s.world);
    s.asked_world = calloc(count, sizeof *s.asked_world);
    for (size_t k = 0; k < count; k++) {
        struct test_ray *const ray = &s.items[k];
        const double x = (double)ray->motion_x, y = (double)ray->motion_y, length = hypot(x, y);
        const struct body *const at = &s.room.scene.bodies[random_below(random, bodies)];
        if (k % 4 == 1) {
            ray->x = at->x;
            ray->y = at->y;
        } else if (k % 5 == 0 && length > 0 && precision == NARC_FLOAT64) {
            ray->x -= 0x1p44 * (x / length);
            ray->y -= 0x1p44 * (y / length);
            ray->fraction = INFINITY;
        } else if (random_below(random, 64) == 0) {
            ray->x = random_below(random, 2) ? NAN : random_below(random, 2) ? 1e30 : INFINITY;
        }
        s.movers[k] = turned_body(random_between(random, -4, 4), random_log_between(random, 0.05, 1));
        s.movers[k].x = ray->x;
        s.movers[k].y = ray->y;
        s.movers[k].shape = (uint32_t)random_below(random, s.room.scene.shape_count);
        round_position(&s.movers[k], precision);
        s.motion[k] = (narc_motion){ray->motion_x, ray->motion_y, 0};
        if (k % 3)
            s.motion[k].angle = (float)random_between(random, -4, 4);
        if (k % 3 < 2)
            s.targets[k] = (float)random_between(random, -0.1, 0.3);
        const uint64_t bits = random_bits(random); /* a quarter of them is set */
        s.mask[k] = k % 7 ? bits & random_bits(random) : 0;
        s.ignored[k] = k % 5 ? (uint32_t)random_below(random, bodies) : UINT32_MAX;
        s.ignored_owner[k] = k % 3 ? (uint32_t)random_below(random, bodies / 3 + 1) : UINT32_MAX;
        s.asked_world[k] = (uint32_t)(k / 10 % 4) * 0x50000000; /* of the last one there are no bodies */
    }
    for (size_t k = 0; k < bodies; k++)
        s.owner[k] = random_below(random, 8) ? (uint32_t)random_below(random, bodies / 3 + 1) : UINT32_MAX;
    for (size_t k = 0; k < bodies; k++)
        s.world[k] = (uint32_t)(k * k % 3) * 0x50000000;
    return s;
}

static void destroy_search(struct search *s) {
    destroy_room(&s->room);
    free(s->items);
    free(s->movers);
    free(s->motion);
    free(s->targets);
    free(s->mask);
    free(s->ignored);
    free(s->ignored_owner);
    free(s->owner);
    free(s->world);
    free(s->asked_world);
}

TEST(finds_what_asking_every_body_finds) {
    static const size_t counts[] = {1, 2, 7, 8, 9, 63, 64, 65, 200, 513};
    enum { COUNTS = sizeof counts / sizeof *counts };
    struct test_random random = test_random_named("searches");
    for (size_t trial = 0; trial < test_trials(2 * COUNTS); trial++) {
        const size_t bodies = counts[trial % COUNTS];
        const double side = sqrt((double)bodies) * random_between(&random, 0.5, 4);
        AUTO(destroy_search)
        struct search s = make_search(&random, (narc_precision)(trial / COUNTS % 2 ^ trial % 2), bodies,
                                      bodies < 100 ? 120 : 40, side);
        for (int kind = 0; kind < KINDS; kind++)
            check_kind(&random, &s, &kinds[kind]);
    }
}

/* So long that fractions underflow: bodies at different places are met at the same one, and the lower number counts, in any
 * tree. Of movers that holds among those that touch at the start: 2^-24 of the motion, which a fraction may differ by, is
 * more than the whole scene, so that any other body may be hit or passed. */
TEST(longest_ways_go_by_number) {
    enum { BODIES = 65, ITEMS = 100 };
    struct test_random random = test_random_named("longest ways");
    size_t same = 0;
    for (size_t trial = 0; trial < test_trials(4); trial++) {
        AUTO(destroy_search) struct search s = make_search(&random, (narc_precision)(trial % 2), BODIES, ITEMS, 9);
        s.longest = true;
        for (size_t b = 0; b < BODIES; b++) {
            struct body *const body = &s.room.scene.bodies[b];
            body->x = 0x1p-23 * random_between(&random, 0, 9);
            body->y *= 0x1p-23;
            body->scale *= 0x1p-23f;
            round_position(body, s.room.scene.precision);
        }
        for (size_t k = 0; k < ITEMS; k++) {
            const double angle = random_between(&random, -4, 4), length = random_log_between(&random, 1e36, 3.4e38);
            s.items[k] = (struct test_ray){(float)(0x1p-23 * random_between(&random, -9, 18)),
                                           (float)(0x1p-23 * random_between(&random, -9, 18)),
                                           (float)(length * cos(angle)), (float)(length * sin(angle)), 1};
            s.movers[k].x = s.items[k].x;
            s.movers[k].y = s.items[k].y;
            s.movers[k].scale *= 0x1p-23f;
            s.targets[k] *= 0x1p-23f;
            round_position(&s.movers[k], s.room.scene.precision);
            s.motion[k] = (narc_motion){s.items[k].motion_x, s.items[k].motion_y, k % 4 ? 0 : 0.5f};
        }
        index_room(&s.room, false, false);
        for (int kind = 0; kind < KINDS; kind++) {
            AUTO(free_at) char *const all = ask_one_by_one(&s, &kinds[kind], NARC_INSIDE_STOPS);
            for (size_t k = s.count; k < s.count * BODIES && kind != POINTS; k++) {
                struct found a, b;
                memcpy(&a, all + k * kinds[kind].size, sizeof a);
                memcpy(&b, all + (k - s.count) * kinds[kind].size, sizeof b);
                same += a.count && b.count && a.key > 0 && a.key == b.key;
            }
            check_kind(&random, &s, &kinds[kind]);
        }
    }
    assert_true(same > 0);
}

/* Rays in an order of chance and in calls of all sizes. */
TEST(rays_go_in_any_company) {
    enum { COUNT = 700, RAYS_OF_ALL = 1500, MOST = 3 };
    struct test_random random = test_random_named("company");
    const size_t ray_count = test_trials(10) < 10 ? 400 : RAYS_OF_ALL;
    AUTO(destroy_room) struct room room = create_room(&random, NARC_FLOAT64, COUNT, 40);
    AUTO(free_at) struct test_ray *const rays = make_rays(&random, &room, ray_count, 40);
    AUTO(free_at) struct test_ray *const mixed = calloc(ray_count, sizeof *mixed);
    uint32_t owner[COUNT];
    size_t order[RAYS_OF_ALL];
    for (size_t k = 0; k < COUNT; k++)
        owner[k] = (uint32_t)k / 4;
    for (size_t k = 0; k < ray_count; k++) {
        const size_t other = random_below(&random, k + 1);
        order[k] = order[other];
        order[other] = k;
    }
    for (size_t k = 0; k < ray_count; k++)
        mixed[k] = rays[order[k]];
    const narc_owners owners = {.owner = NARC_ARRAY(owner)};
    const narc_ray_options ways[] = {{.most = MOST},
                                     {.most = MOST, .inside = NARC_INSIDE_LEAVES, .search.owners = &owners},
                                     {.most = 1, .inside = NARC_INSIDE_STOPS},
                                     {.most = 1, .inside = NARC_INSIDE_LEAVES},
                                     {.most = 1, .inside = NARC_INSIDE_IGNORES}};
    for (size_t way = 0; way < sizeof ways / sizeof *ways; way++) {
        const size_t most = ways[way].most;
        const narc_rays view = view_rays(rays, ray_count);
        AUTO(guard_release_at) narc_ray_hit *const right = cast_in_room(&room, &view, &ways[way]);
        for (size_t size = 1; size < ray_count; size = size < 10 ? size + 1 : 3 * size)
            for (size_t first = 0; first < ray_count; first += size) {
                const size_t left = ray_count - first, count = left < size ? left : size;
                const narc_rays part = view_rays(mixed + first, count);
                AUTO(guard_release_at) narc_ray_hit *const found = cast_in_room(&room, &part, &ways[way]);
                for (size_t k = 0; k < count * most; k++) {
                    const size_t ray = order[first + k / most];
                    found[k].ray = (uint32_t)ray;
                    assert_memory_equal(&found[k], &right[ray * most + k % most], sizeof *found);
                }
            }
    }
}

/* With room for an order, each ray is asked once, world by world, and its rows are those that it has without. */
TEST(rays_are_put_in_order) {
    enum { COUNT = 700, MOST_RAYS = 3000, MOST = 3, WORLDS = 8 };
    struct test_random random = test_random_named("order of rays");
    size_t moved = 0;
    for (size_t trial = 0; trial < test_trials(12); trial++) {
        const narc_precision precision = trial % 2 ? NARC_FLOAT64 : NARC_FLOAT32;
        AUTO(destroy_room)
        struct room room = create_room(&random, precision, trial % 6 ? COUNT : random_below(&random, 9) + 1, 40);
        const size_t count = trial % 4 < 3 ? 1 + random_below(&random, MOST_RAYS) : random_below(&random, 40);
        AUTO(free_at) struct test_ray *const rays = make_rays(&random, &room, count, 40);
        uint32_t owner[COUNT], world_of[COUNT];
        AUTO(free_at) uint64_t *const mask = calloc(count + 1, sizeof *mask);
        AUTO(free_at) uint32_t *const world = calloc(count + 1, sizeof *world);
        const bool few_worlds = trial % 2;
        AUTO(guard_release_at) uint32_t *const order = guard_allocate(count * sizeof *order);
        AUTO(free_at) bool *const asked = calloc(count + 1, sizeof *asked);
        for (size_t k = 0; k < COUNT; k++)
            owner[k] = (uint32_t)k / 4;
        const uint32_t far = few_worlds ? 1 : UINT32_MAX / (WORLDS - 1);
        for (size_t k = 0; k < COUNT; k++)
            world_of[k] = (uint32_t)k % WORLDS * far;
        for (size_t k = 0; k < count; k++) {
            world[k] = (uint32_t)random_below(&random, WORLDS) * far;
            mask[k] = random_below(&random, 8) ? UINT64_MAX : random_below(&random, 4);
            if (random_below(&random, 30) == 0)
                rays[k].motion_x = rays[k].motion_y = random_below(&random, 2) ? NAN : 0;
            if (random_below(&random, 50) == 0)
                rays[k].x = random_below(&random, 2) ? (double)NAN : -1e30;
        }
        const narc_index_options built = {.category = {trial % 5 ? room.category : NULL, sizeof *room.category},
                                          .world = NARC_ARRAY(world_of),
                                          .fast = trial % 3 > 0};
        narc_error error;
        expect_ok(narc_build_index(room.index, room.boxes, scene_bodies(&room.scene).count, &built, &error), &error);
        const narc_owners owners = {.owner = NARC_ARRAY(owner)};
        const narc_ray_options ways[] = {{.any = 1},
                                         {.search.world = NARC_ARRAY(world)},
                                         {.any = 1, .search.mask = NARC_ARRAY(mask)},
                                         {.most = MOST, .search.mask = NARC_ARRAY(mask)},
                                         {.most = MOST, .inside = NARC_INSIDE_LEAVES, .search.owners = &owners},
                                         {.inside = NARC_INSIDE_STOPS},
                                         {.inside = NARC_INSIDE_LEAVES},
                                         {.inside = NARC_INSIDE_IGNORES}};
        for (size_t way = 0; way < sizeof ways / sizeof *ways; way++) {
            const narc_rays view = view_rays(rays, count);
            size_t skipped = 0, skipped_too = 1;
            narc_ray_options chosen = ways[way];
            chosen.out_skipped = &skipped;
            AUTO(guard_release_at) narc_ray_hit *const right = cast_in_room(&room, &view, &chosen);
            chosen.out_skipped = &skipped_too;
            chosen.out_order = order;
            AUTO(guard_release_at) narc_ray_hit *const found = cast_in_room(&room, &view, &chosen);
            assert_memory_equal(found, right, count * (chosen.most ? chosen.most : 1) * sizeof *found);
            assert_int_equal(skipped, skipped_too);
            memset(asked, 0, count * sizeof *asked);
            for (size_t k = 0; k < count; k++) {
                assert_true(order[k] < count && !asked[order[k]]);
                asked[order[k]] = true;
                moved += order[k] != k;
                if (k > 0 && chosen.search.world.base && few_worlds && count >= 2 * WORLDS)
                    assert_true(world[order[k - 1]] <= world[order[k]]);
            }
        }
    }
    assert_true(moved > 0);
}

TEST_MAIN("searches")
