/* SPDX-License-Identifier: MIT
 *
 * pair_lists.c - narc_update_pairs() step by step against all pairs of boxes in double precision: which list is kept,
 * its pairs, what was added and lost, as bodies come, go, change their numbers, sleep and wake.
 *
 * Boxes and margins are eighths, so that single precision has no rounding to hide behind: a box that is a little larger
 * overlaps no other one. The skin is no whole number of eighths, so that no body is just about to leave its box.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "boxes.h"
#include "broad_phase.h"
#include "expect.h"
#include "families.h"
#include "guard.h"
#include "ledger.h"
#include "narc.h"

/* One object for each number of threads, and one that finds all pairs whenever it makes a list. */
enum { OBJECTS = 5, WHOLE = 4, MOST_BODIES = 9000 };
static const unsigned thread_counts[OBJECTS] = {1, 2, 3, 7, 2};

typedef struct body {
    uint64_t id, category, mask;
    narc_box box;
    uint32_t group;
    float reach;
    uint8_t kind;
} body;

typedef struct wide_box {
    double min_x, min_y, max_x, max_y;
    bool exists;
} wide_box;

typedef struct known_pair {
    uint64_t id_a, id_b; /* of the body with the lower number */
    uint32_t a, b, index;
    uint8_t kinds;
    bool seen;
} known_pair;

/* The reference, the last list by ids, and what is compared with it. */
typedef struct reference {
    wide_box kept[MOST_BODIES];
    body bodies[MOST_BODIES];
    size_t count;
    bool begun;
    known_pair *pairs, *next;
    size_t pair_count, next_count, capacity;
    uint32_t *table; /* hash table of pairs: one more than their index */
    narc_broad_phase *broads[OBJECTS];
} reference;

/* No more unsorted boxes than there is room for. */
static void check_unsorted(const narc_broad_phase *broad) {
    assert_true(broad->unsorted_count <= narc_most_unsorted(broad->box_capacity));
}

/* The calls where nothing fails. */
static const narc_pair_list *update_boxes(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                                          const narc_pair_options *options) {
    const narc_pair_list *list = NULL;
    assert_int_equal(narc_update_box_pairs(broad, boxes, count, options, &list, NULL), NARC_OK);
    check_unsorted(broad);
    return list;
}

static const narc_pair_list *update(narc_broad_phase *broad, const narc_shapes *shapes, const narc_bodies *bodies,
                                    const narc_pair_options *options) {
    const narc_pair_list *list = NULL;
    assert_int_equal(narc_update_pairs(broad, shapes, bodies, options, &list, NULL), NARC_OK);
    check_unsorted(broad);
    return list;
}

static double half_of_margin, skin;
static bool kinds_alone; /* bodies have no categories, masks and groups, and kinds next to each other */

/* bare: neither skin nor margin. */
static void choose(bool bare, bool kinds) {
    half_of_margin = bare ? 0 : 0.25;
    skin = bare ? 0 : 0.5625;
    kinds_alone = kinds;
}

static wide_box widen(const wide_box *b, double by) {
    return (wide_box){b->min_x - by, b->min_y - by, b->max_x + by, b->max_y + by, b->exists};
}

static wide_box reach_of(const body *b) {
    const wide_box box = {(double)b->box.min_x, (double)b->box.min_y, (double)b->box.max_x, (double)b->box.max_y,
                          !is_empty(&b->box) && b->reach >= 0 && isfinite(b->reach)};
    return widen(&box, half_of_margin + (double)b->reach);
}

static bool is_inside(const wide_box *box, const wide_box *around) {
    return box->exists == around->exists &&
           (!box->exists || (box->min_x >= around->min_x && box->min_y >= around->min_y &&
                             box->max_x <= around->max_x && box->max_y <= around->max_y));
}

static bool meet(const wide_box *a, const wide_box *b) {
    return a->exists && b->exists && a->min_x <= b->max_x && b->min_x <= a->max_x && a->min_y <= b->max_y &&
           b->min_y <= a->max_y;
}

static bool may_pair(const body *a, const body *b) {
    return !(a->kind & b->kind & (NARC_STATIC | NARC_SENSOR)) && (a->group != b->group || a->group == 0) &&
           (a->category & b->mask) && (b->category & a->mask);
}

static bool is_at_rest(const body *b) { return b->kind & (NARC_STATIC | NARC_ASLEEP); }

/* ------------------------------------------------------------------------------------------------ sets of pairs */

static size_t find_slot(const reference *r, uint64_t one, uint64_t other) {
    const uint64_t low = one < other ? one : other, high = one < other ? other : one;
    size_t slot = (size_t)((low * 31 + high * 0x9e3779b97f4a7c15u) >> 20) % (2 * r->capacity);
    for (; r->table[slot]; slot = (slot + 1) % (2 * r->capacity)) {
        const known_pair *p = &r->pairs[r->table[slot] - 1];
        if ((p->id_a == one && p->id_b == other) || (p->id_a == other && p->id_b == one))
            break;
    }
    return slot;
}

static void hash_pairs(reference *r) {
    memset(r->table, 0, 2 * r->capacity * sizeof *r->table);
    for (size_t k = 0; k < r->pair_count; k++)
        r->table[find_slot(r, r->pairs[k].id_a, r->pairs[k].id_b)] = (uint32_t)k + 1;
}

static reference *create_reference(size_t capacity) {
    reference *r = calloc(1, sizeof *r);
    assert_non_null(r);
    r->capacity = capacity;
    r->pairs = calloc(capacity, sizeof *r->pairs);
    r->next = calloc(capacity, sizeof *r->next);
    r->table = calloc(2 * capacity, sizeof *r->table);
    assert_true(r->pairs && r->next && r->table);
    for (size_t t = 0; t < OBJECTS; t++)
        r->broads[t] = create_broad_phase(NULL);
    return r;
}

static void destroy_reference(reference *r) {
    for (size_t t = 0; t < OBJECTS; t++)
        narc_destroy_broad_phase(r->broads[t]);
    free(r->pairs);
    free(r->next);
    free(r->table);
    free(r);
}

/* ------------------------------------------------------------------------------------------------ one step */

static bool are_others(const reference *r, const body *bodies, size_t count) {
    bool others = !r->begun || count != r->count;
    for (size_t k = 0; k < count && !others; k++)
        others = bodies[k].id != r->bodies[k].id;
    return others;
}

/* Has this body left its kept box, or another filter? */
static bool has_left(const reference *r, const body *bodies, size_t k) {
    const uint8_t lasting = NARC_STATIC | NARC_SENSOR;
    const body *now = &bodies[k], *then = &r->bodies[k];
    const wide_box box = reach_of(now);
    return now->category != then->category || now->mask != then->mask || now->group != then->group ||
           ((now->kind ^ then->kind) & lasting) || !is_inside(&box, &r->kept[k]);
}

/* Has a side of its box moved by more than half of the skin? */
static bool has_moved(const reference *r, const body *bodies, size_t k) {
    const wide_box box = reach_of(&bodies[k]), made = widen(&r->kept[k], -skin);
    return box.exists != made.exists ||
           (box.exists && (fabs(box.min_x - made.min_x) > skin / 2 || fabs(box.min_y - made.min_y) > skin / 2 ||
                           fabs(box.max_x - made.max_x) > skin / 2 || fabs(box.max_y - made.max_y) > skin / 2));
}

/* The pairs of this step into r->next; false: those of the last are kept. */
static bool find_expected(reference *r, const body *bodies, size_t count) {
    const bool others = are_others(r, bodies, count);
    bool renew = others;
    for (size_t k = 0; k < count && !renew; k++)
        renew = has_left(r, bodies, k);
    r->begun = true;
    for (size_t k = 0; k < count && renew; k++) {
        const wide_box box = reach_of(&bodies[k]);
        if (others || has_left(r, bodies, k) || has_moved(r, bodies, k))
            r->kept[k] = widen(&box, skin);
    }
    memcpy(r->bodies, bodies, count * sizeof *bodies);
    r->count = count;
    r->next_count = 0;
    if (!renew) {
        memcpy(r->next, r->pairs, r->pair_count * sizeof *r->pairs);
        r->next_count = r->pair_count;
    }
    for (size_t a = 0; a < count && renew; a++)
        for (size_t b = a + 1; b < count; b++)
            if (meet(&r->kept[a], &r->kept[b]) && may_pair(&bodies[a], &bodies[b])) {
                assert_true(r->next_count < r->capacity);
                r->next[r->next_count++] =
                    (known_pair){.id_a = bodies[a].id, .id_b = bodies[b].id, .a = (uint32_t)a, .b = (uint32_t)b};
            }
    for (size_t k = 0; k < r->next_count; k++)
        r->next[k].kinds = (bodies[r->next[k].a].kind | bodies[r->next[k].b].kind) & 7;
    return renew;
}

/* Is it what is expected? Marks in r->pairs the pairs that go on. */
static void check_pairs(reference *r, const body *bodies, const narc_pair_list *list, bool renew) {
    const uint32_t *a = list->pairs.a.base, *b = list->pairs.b.base;
    size_t added = 0, contacts = 0, sensors = 0;
    assert_int_equal(list->kept, !renew);
    assert_int_equal(list->pairs.count, r->next_count);
    for (size_t k = 0; k < r->pair_count; k++)
        r->pairs[k].seen = false;
    for (size_t k = 0; k < r->next_count; k++) {
        const known_pair *p = &r->next[k];
        const uint32_t found = r->table[find_slot(r, p->id_a, p->id_b)];
        uint8_t marks = p->kinds;
        assert_int_equal(a[k], p->a);
        assert_int_equal(b[k], p->b);
        assert_int_equal(list->previous[k], found ? found - 1 : NARC_NO_MATCH);
        if (found) {
            r->pairs[found - 1].seen = true;
            marks |= r->pairs[found - 1].id_a == p->id_b ? NARC_FLIPPED : 0;
        } else
            assert_int_equal(list->added[added++], k);
        assert_int_equal(list->marks[k], marks);
        if (is_at_rest(&bodies[p->a]) && is_at_rest(&bodies[p->b]))
            continue;
        if (p->kinds & NARC_SENSOR)
            assert_int_equal(list->sensors[sensors++], k);
        else
            assert_int_equal(list->contacts[contacts++], k);
    }
    assert_int_equal(list->added_count, added);
    assert_int_equal(list->contact_count, contacts);
    assert_int_equal(list->sensor_count, sensors);
}

static size_t check_lost(const reference *r, const narc_pair_list *list) {
    size_t lost = 0;
    for (size_t k = 0; k < r->pair_count; k++) {
        const known_pair *p = &r->pairs[k];
        if (p->seen)
            continue;
        assert_true(lost < list->lost_count);
        const narc_lost_pair *one = &list->lost[lost++];
        assert_int_equal(one->pair, k);
        assert_int_equal(one->a, p->a);
        assert_int_equal(one->b, p->b);
        assert_int_equal(one->marks, p->kinds);
        assert_true(one->id_a == p->id_a && one->id_b == p->id_b);
    }
    assert_int_equal(list->lost_count, lost);
    return lost;
}

/* Byte for byte. */
static void check_equal_lists(const narc_pair_list *one, const narc_pair_list *other) {
    const size_t count = one->pairs.count;
    assert_int_equal(count, other->pairs.count);
    assert_memory_equal(one->pairs.a.base, other->pairs.a.base, count * sizeof(uint32_t));
    assert_memory_equal(one->pairs.b.base, other->pairs.b.base, count * sizeof(uint32_t));
    assert_memory_equal(one->previous, other->previous, count * sizeof(uint32_t));
    assert_memory_equal(one->marks, other->marks, count);
    assert_true(one->kept == other->kept && one->skipped == other->skipped);
    assert_int_equal(one->contact_count, other->contact_count);
    assert_memory_equal(one->contacts, other->contacts, one->contact_count * sizeof(uint32_t));
    assert_int_equal(one->sensor_count, other->sensor_count);
    assert_memory_equal(one->sensors, other->sensors, one->sensor_count * sizeof(uint32_t));
    assert_int_equal(one->added_count, other->added_count);
    assert_memory_equal(one->added, other->added, one->added_count * sizeof(uint32_t));
    assert_int_equal(one->lost_count, other->lost_count);
    if (one->lost_count > 0)
        assert_memory_equal(one->lost, other->lost, one->lost_count * sizeof *one->lost);
}

static size_t count_broken(const body *bodies, size_t count) {
    size_t broken = 0;
    for (size_t k = 0; k < count; k++)
        broken += !reach_of(&bodies[k]).exists;
    return broken;
}

typedef struct totals {
    size_t kept, renewed, few, flipped, lost, added, sleeping, sensors, broken;
} totals;

/* Gives all objects the same step. */
static void check_step(reference *r, body *bodies, size_t count, bool with_ids, totals *sums) {
    narc_box *boxes = guard_allocate(count * sizeof *boxes);
    uint8_t *kinds = guard_allocate(count);
    for (size_t k = 0; k < count; k++) {
        boxes[k] = bodies[k].box;
        kinds[k] = bodies[k].kind;
    }
    const ptrdiff_t stride = sizeof *bodies;
    const narc_pair_filter alone = {.kind = {kinds, 1}}, all = {.kind = {&bodies->kind, stride},
                                                                .category = {&bodies->category, stride},
                                                                .mask = {&bodies->mask, stride},
                                                                .group = {&bodies->group, stride}};
    const narc_pair_filter filter = kinds_alone ? alone : all;
    narc_pair_options options = {
        .margin = 2 * (float)half_of_margin, .skin = (float)skin, .reach = {&bodies->reach, stride}, .filter = &filter};
    if (with_ids)
        options.id = (narc_word_column){&bodies->id, stride};
    const bool renew = find_expected(r, bodies, count);
    const narc_pair_list *first = NULL;
    for (size_t t = 0; t < OBJECTS; t++) {
        const narc_workers workers = narc_openmp_workers(thread_counts[t]);
        size_t none;
        options.workers = &workers;
        if (t == WHOLE)
            assert_int_equal(narc_find_pairs(r->broads[t], NULL, 0, NULL, NULL, NULL, NULL, 0, &none, NULL), NARC_OK);
        const narc_pair_list *const list = update_boxes(r->broads[t], boxes, count, &options);
        first = first ? first : list;
        check_equal_lists(list, first);
        check_pairs(r, bodies, list, renew);
        const size_t lost = check_lost(r, list);
        assert_int_equal(list->skipped, count_broken(bodies, count));
        sums->lost += lost;
        sums->added += list->added_count;
        sums->sensors += list->sensor_count;
        sums->broken += list->skipped;
        sums->sleeping += list->pairs.count - list->contact_count - list->sensor_count;
        for (size_t k = 0; k < list->pairs.count; k++)
            sums->flipped += list->marks[k] >> 7;
    }
    sums->kept += !renew;
    sums->few += renew && r->broads[0]->unsorted_count > 0;
    assert_int_equal(r->broads[WHOLE]->unsorted_count, 0);
    sums->renewed += renew;
    known_pair *const last = r->pairs;
    r->pairs = r->next;
    r->next = last;
    r->pair_count = r->next_count;
    hash_pairs(r);
    guard_release(boxes);
    guard_release(kinds);
}

/* ------------------------------------------------------------------------------------------------ a world */

static float eighths(struct test_random *random, size_t most) { return (float)random_below(random, most + 1) / 8; }

static narc_box eighths_box(struct test_random *random, size_t side) {
    const float half = (float)side / 2, x = eighths(random, 8 * side) - half, y = eighths(random, 8 * side) - half;
    return (narc_box){x, y, x + eighths(random, 16), y + eighths(random, 16)};
}

static uint64_t choose_mask(struct test_random *random) {
    return kinds_alone || random_below(random, 8) ? UINT64_MAX : (uint64_t)1 << (31 + random_below(random, 4));
}

static body random_body(struct test_random *random, size_t side, uint64_t id) {
    return (body){.id = id * 0x9e3779b97f4a7c15u,
                  .category = choose_mask(random),
                  .mask = choose_mask(random),
                  .box = eighths_box(random, side),
                  .group = kinds_alone || random_below(random, 4) ? 0 : 1 + (uint32_t)random_below(random, 3),
                  .kind = random_below(random, 2) ? 0 : (uint8_t)random_below(random, 8)};
}

static void shift(narc_box *box, float x, float y) {
    *box = (narc_box){box->min_x + x, box->min_y + y, box->max_x + x, box->max_y + y};
}

/* Something that an engine may do between two steps. */
static size_t change(struct test_random *random, body *bodies, size_t count, size_t most, size_t side, bool with_ids,
                     uint64_t *next_id) {
    if (count == 0 || (count < most && random_below(random, 40) == 0)) {
        bodies[count] = random_body(random, side, *next_id);
        bodies[count].id = with_ids ? bodies[count].id : count;
        ++*next_id;
        return count + 1;
    }
    const size_t k = (size_t)random_below(random, count), other = (size_t)random_below(random, count);
    switch (random_below(random, with_ids ? 28 : 22)) {
    case 0:
        bodies[k].kind ^= (uint8_t)(1 << random_below(random, 3));
        break;
    case 1:
        bodies[k].category = choose_mask(random);
        break;
    case 2:
        bodies[k].group = kinds_alone ? 0 : (uint32_t)random_below(random, 3);
        break;
    case 3:
        if (skin > 0) /* without one there is no room for rounding */
            bodies[k].reach = random_below(random, 6) ? eighths(random, 4) : random_below(random, 2) ? NAN : -1;
        break;
    case 4:
        bodies[k].box.max_y = NAN;
        break;
    case 5:
        return count - 1;
    case 6:
    case 7:
        bodies[k].box = eighths_box(random, side);
        break;
    default: /* within the skin, mostly */
        shift(&bodies[k].box, eighths(random, 2) - 0.125f, eighths(random, 2) - 0.125f);
        break;
    case 22: /* swap with last */
    case 23:
        bodies[k] = bodies[count - 1];
        return count - 1;
    case 24: /* all behind it move up */
        memmove(&bodies[k], &bodies[k + 1], (count - k - 1) * sizeof *bodies);
        return count - 1;
    case 25: /* one goes and one comes: the count stays */
        bodies[k] = random_body(random, side, ++*next_id);
        ++*next_id;
        break;
    case 26: {
        const body moved = bodies[k];
        bodies[k] = bodies[other];
        bodies[other] = moved;
        break;
    }
    case 27:
        bodies[k].kind ^= NARC_ASLEEP;
        break;
    }
    return count;
}

typedef struct world {
    const char *name;
    size_t steps, start, most, side;
    bool with_ids, bare, kinds;
} world;

static void forget_pairs(reference *r) {
    for (size_t t = 0; t < OBJECTS; t++)
        narc_forget_pairs(r->broads[t]);
    r->begun = false;
    r->pair_count = 0;
    hash_pairs(r);
}

static totals run_world(const world *w) {
    struct test_random random = test_random_named(w->name);
    reference *r = create_reference(w->most * 16 + 1000);
    body *bodies = calloc(w->most + 1, sizeof *bodies);
    uint64_t next_id = w->start;
    totals sums = {0};
    choose(w->bare, w->kinds);
    for (size_t k = 0; k < w->start; k++) {
        bodies[k] = random_body(&random, w->side, k);
        bodies[k].id = w->with_ids ? bodies[k].id : k;
    }
    size_t count = w->start;
    for (size_t step = 0; step < w->steps; step++) {
        if (step % 100 == 50)
            forget_pairs(r);
        check_step(r, bodies, count, w->with_ids, &sums);
        if (random_below(&random, 3) == 0) { /* sleep alone renews nothing */
            bodies[random_below(&random, count + 1)].kind ^= NARC_ASLEEP;
            continue;
        }
        for (size_t changes = (size_t)random_below(&random, 4); changes-- > 0;)
            count = change(&random, bodies, count, w->most, w->side, w->with_ids, &next_id);
    }
    free(bodies);
    destroy_reference(r);
    return sums;
}

/* By their ids and by their numbers; few and none; so many that several threads share the work; with kinds alone, in an
 * array of bytes that is read eight at a time. */
TEST(follows_bodies) {
    const world worlds[] = {{"ids", 100 + test_trials(3900), 60, 90, 12, .with_ids = true},
                            {"numbers", 100 + test_trials(2900), 40, 60, 10, .with_ids = false},
                            {"few", test_trials(2000), 0, 4, 2, .with_ids = true},
                            {"bare", test_trials(1000), 40, 60, 8, .with_ids = true, .bare = true},
                            {"thousands", 12, MOST_BODIES - 10, MOST_BODIES, 150, .with_ids = true},
                            {"kinds", 100 + test_trials(900), 40, 60, 10, .kinds = true}};
    for (size_t k = 0; k < sizeof worlds / sizeof *worlds; k++) {
        const world *const w = &worlds[k];
        const totals sums = run_world(w);
        assert_true(w->with_ids || sums.flipped == 0);
        if (w->bare || w->start < 40 || w->start > 1000)
            continue;
        assert_true(sums.kept > w->steps / 40 && sums.renewed > w->steps / 40 && sums.lost > 0 && sums.added > 0);
        assert_true(sums.sleeping > 0 && sums.sensors > 0 && sums.broken > 0);
        assert_int_equal(sums.flipped > 0, w->with_ids);
    }
}

/* A scene at rest: boxes of all sizes of which a few move, a little or far away, one of them ever further down; now and
 * then anything else happens. */
static totals run_scene_at_rest(const char *isa, size_t steps) {
    enum { START = 1500, MOST = 1520, SIDE = 60, MOVERS = 50 };
    struct test_random random = test_random_named("rest");
    reference *r = create_reference(40 * MOST);
    body *bodies = calloc(MOST + 1, sizeof *bodies);
    uint64_t next_id = START;
    totals sums = {0};
    choose(false, false);
    assert_int_equal(narc_set_isa(isa, NULL), NARC_OK);
    for (size_t k = 0; k < START; k++) {
        bodies[k] = random_body(&random, SIDE, k);
        if (k % 100 == 1)
            bodies[k].box.max_x += eighths(&random, 400);
        if (k % 100 == 2)
            bodies[k].box.max_y += eighths(&random, 200);
        if (k % 10 == 3)
            bodies[k].box.max_y = bodies[k].box.min_y;
    }
    size_t count = START;
    for (size_t step = 0; step < steps; step++) {
        check_step(r, bodies, count, true, &sums);
        shift(&bodies[0].box, 0, -1.5f * (float)step);
        for (size_t moves = (size_t)random_below(&random, MOVERS); moves-- > 0;)
            shift(&bodies[random_below(&random, count)].box, eighths(&random, 16) - 1, eighths(&random, 16) - 1);
        if (random_below(&random, 3) == 0)
            count = change(&random, bodies, count, MOST, SIDE, random_below(&random, 2), &next_id);
    }
    free(bodies);
    destroy_reference(r);
    return sums;
}

TEST(finds_pairs_of_few_that_move) {
    const size_t steps = 20 + test_trials(60);
    for (size_t k = 0; narc_isa_name(k); k++)
        if (narc_isa_supported(narc_isa_name(k))) {
            const totals sums = run_scene_at_rest(narc_isa_name(k), steps);
            assert_true(sums.few > steps / 2 && sums.renewed > sums.few && sums.lost > 0 && sums.added > 0);
        }
    assert_int_equal(narc_set_isa(NULL, NULL), NARC_OK);
}

/* ------------------------------------------------------------------------------------------------ bodies */

/* Bodies with all that a box is made from, positions in both precisions. */
typedef struct placed {
    double x, y;
    float near_x, near_y, cosine, sine, scale, motion_x, motion_y;
    uint32_t shape, group;
    uint8_t kind;
} placed;

static narc_bodies view_placed(const placed *bodies, size_t count, bool doubles, bool scales) {
    narc_bodies view = {.count = count,
                        .x = NARC_POSITION_COLUMN(bodies, x),
                        .y = NARC_POSITION_COLUMN(bodies, y),
                        .cosine = NARC_COLUMN(bodies, cosine),
                        .sine = NARC_COLUMN(bodies, sine),
                        .shape = NARC_COLUMN(bodies, shape)};
    if (!doubles) {
        view.x = NARC_POSITION_COLUMN(bodies, near_x);
        view.y = NARC_POSITION_COLUMN(bodies, near_y);
    }
    if (scales)
        view.scale = NARC_COLUMN(bodies, scale);
    return view;
}

static placed place_at(float x, float y, uint32_t shape) {
    return (placed){.x = (double)x, .y = (double)y, .near_x = x, .near_y = y, .cosine = 1, .scale = 1, .shape = shape};
}

static void change_placed(struct test_random *random, placed *one) {
    switch (random_below(random, 9)) {
    case 0:
        one->x += random_between(random, -1, 1);
        one->near_x = (float)one->x;
        break;
    case 1:
        one->y = random_below(random, 4) ? one->y + random_between(random, -0.1, 0.1) : NAN;
        one->near_y = (float)one->y;
        break;
    case 2: { /* the other end */
        const float cosine = one->cosine;
        one->cosine = -one->sine;
        one->sine = cosine;
        break;
    }
    case 3:
        one->scale = one->scale == 1 ? 1.5f : 1;
        break;
    case 4:
        one->shape = 1 - one->shape;
        break;
    case 5:
        one->group = 1 - one->group;
        break;
    case 6:
        one->kind ^= (uint8_t)(1 << random_below(random, 3));
        break;
    case 7:
        one->motion_x = (float)random_between(random, -0.5, 0.5);
        one->motion_y = random_below(random, 8) ? (float)random_between(random, -0.5, 0.5) : INFINITY;
        break;
    default:
        one->y = one->near_y = 0;
        break;
    }
}

/* How bodies are filtered: not, by kinds next to each other, by kinds of their own, or by groups too. */
enum filtered { UNFILTERED, BY_KINDS, BY_OWN_KINDS, BY_GROUPS, WAYS };

static narc_pair_filter filter_placed(const placed *bodies, size_t count, enum filtered way, uint8_t *kinds) {
    narc_pair_filter filter = {.kind = NARC_COLUMN(bodies, kind)};
    for (size_t k = 0; k < count; k++)
        kinds[k] = bodies[k].kind;
    if (way == BY_KINDS)
        filter.kind = (narc_byte_column){kinds, 1};
    if (way == BY_GROUPS)
        filter.group = NARC_COLUMN(bodies, group);
    return filter;
}

/* Boxes of bodies that rest are not computed again: the list is that of boxes that are, whatever changes. */
TEST(notices_all_that_boxes_are_made_from) {
    enum { COUNT = 200 };
    struct test_random random = test_random_named("placed");
    narc_broad_phase *broad = create_broad_phase(NULL), *other = create_broad_phase(NULL);
    narc_shapes *shapes = empty_store();
    placed bodies[COUNT];
    narc_box boxes[COUNT];
    uint8_t kinds[COUNT];
    float margin = 0.25f, skin_now = 0.25f;
    enum filtered way = UNFILTERED;
    bool doubles = true, scales = true, moving = false;
    size_t kept = 0, count = COUNT;
    narc_arc capsule[NARC_MAX_ARCS];
    size_t arc_count;
    store_shape(shapes, circle_of(0.5));
    assert_int_equal(narc_build_capsule(1, 0.25, capsule, &arc_count, NULL), NARC_OK);
    assert_int_equal(narc_add_shape(shapes, capsule, arc_count, NULL, NULL), NARC_OK);
    for (size_t k = 0; k < COUNT; k++) {
        const float x = (float)random_between(&random, 0, 16), y = (float)random_between(&random, 0, 16);
        bodies[k] = place_at(x, y, (uint32_t)k % 2);
    }
    const size_t steps = 40 + test_trials(360);
    for (size_t step = 0; step < steps; step++) {
        const narc_workers workers = narc_openmp_workers(1 + (unsigned)step % 2);
        const narc_bodies view = view_placed(bodies, count, doubles, scales);
        const narc_float_column motion_x = {moving ? &bodies->motion_x : NULL, sizeof *bodies},
                                motion_y = {moving ? &bodies->motion_y : NULL, sizeof *bodies};
        const narc_box_options box_options = {.margin = margin / 2, .motion_x = motion_x, .motion_y = motion_y};
        const narc_pair_filter filter = filter_placed(bodies, count, way, kinds), *const given = way == UNFILTERED
                                                                                                     ? NULL
                                                                                                     : &filter;
        const narc_pair_options without = {.skin = skin_now, .filter = given, .workers = &workers};
        narc_pair_options options = without;
        options.margin = margin;
        assert_int_equal(narc_compute_boxes(shapes, &view, &box_options, boxes, NULL), NARC_OK);
        options.motion_x = motion_x;
        options.motion_y = motion_y;
        const narc_pair_list *const list = update(broad, shapes, &view, &options);
        check_equal_lists(list, update_boxes(other, boxes, count, &without));
        options.motion_x = options.motion_y = (narc_float_column){0};
        kept += list->kept;
        for (size_t changes = (size_t)random_below(&random, 3); changes-- > 0;)
            change_placed(&random, &bodies[random_below(&random, COUNT)]);
        switch (random_below(&random, 40)) {
        case 0:
            margin = random_below(&random, 2) ? 0.25f : 0.5f;
            break;
        case 1:
            skin_now = (float)random_between(&random, 0.05, 0.5);
            break;
        case 2:
            doubles = !doubles;
            break;
        case 3:
            scales = !scales;
            break;
        case 4: {
            const struct shape circle = circle_of(random_between(&random, 0.25, 1));
            assert_int_equal(narc_replace_shape(shapes, 0, circle.arcs, circle.count, NULL), NARC_OK);
            break;
        }
        case 5:
            count = count == COUNT ? COUNT - 7 : COUNT;
            break;
        case 6: /* other boxes in between */
            for (size_t k = 0; k < count; k++)
                boxes[k].max_x += 1;
            update_boxes(broad, boxes, count, &options);
            update_boxes(other, boxes, count, &options);
            break;
        case 7:
            way = (enum filtered)random_below(&random, WAYS);
            break;
        case 8:
            moving = !moving;
            break;
        case 9: /* one that goes and comes back */
            if (narc_remove_shape(shapes, 1, NULL))
                assert_int_equal(store_shape(shapes, circle_of(0.75)), 1);
            break;
        default:
            break;
        }
    }
    assert_true(kept > steps / 10);
    narc_destroy_broad_phase(broad);
    narc_destroy_broad_phase(other);
    narc_destroy_shapes(shapes);
}

/* Bodies that move by the last bit of a number, with a skin of some of them. */
TEST(notices_the_last_bit) {
    const narc_pair_options options = {.skin = 0x1p-22f};
    narc_shapes *shapes = empty_store();
    store_shape(shapes, circle_of(0.5));
    for (int number = 0; number < 4; number++) {
        narc_broad_phase *broad = create_broad_phase(NULL), *other = create_broad_phase(NULL);
        placed two[] = {place_at(1, 1, 0), place_at(2, 2, 0)};
        const narc_bodies bodies = view_placed(two, 2, number >= 2, true);
        size_t renewed = 0;
        for (int step = 0; step < 40; step++) {
            narc_box boxes[2];
            assert_int_equal(narc_compute_boxes(shapes, &bodies, NULL, boxes, NULL), NARC_OK);
            const narc_pair_list *const list = update(broad, shapes, &bodies, &options);
            check_equal_lists(list, update_boxes(other, boxes, 2, &options));
            renewed += !list->kept;
            float *const near = number % 2 ? &two[0].near_y : &two[0].near_x;
            *near = nextafterf(*near, 2);
            *(number % 2 ? &two[0].y : &two[0].x) = (double)*near;
        }
        assert_in_range(renewed, 4, 36);
        narc_destroy_broad_phase(broad);
        narc_destroy_broad_phase(other);
    }
    narc_destroy_shapes(shapes);
}

/* A position of 3 in single precision has the bits of one near 0 in double precision. */
TEST(notices_the_precision_of_positions) {
    narc_broad_phase *broad = create_broad_phase(NULL);
    narc_shapes *shapes = empty_store();
    store_shape(shapes, circle_of(0.5));
    const float three = 3;
    union {
        uint64_t bits;
        double number;
        float parts[2];
    } x[2] = {{0}, {0}};
    uint32_t bits;
    memcpy(&bits, &three, sizeof bits);
    x[1].bits = bits;
    const placed two[] = {place_at(0, 0, 0), place_at(0, 0, 0)};
    narc_bodies bodies = view_placed(two, 2, true, true);
    bodies.x = (narc_position_column){&x[0].number, sizeof x[0], NARC_FLOAT64};
    bodies.y = (narc_position_column){&x[0].number, 0, NARC_FLOAT64};
    assert_int_equal(update(broad, shapes, &bodies, NULL)->pairs.count, 1);
    const int low = x[1].parts[0] == three ? 0 : 1; /* the order of bytes */
    bodies.x = (narc_position_column){&x[0].parts[low], sizeof x[0], NARC_FLOAT32};
    bodies.y = (narc_position_column){&x[0].parts[low], 0, NARC_FLOAT32};
    assert_int_equal(update(broad, shapes, &bodies, NULL)->pairs.count, 0);
    narc_destroy_shapes(shapes);
    narc_destroy_broad_phase(broad);
}

/* Memory that begins anew. */
typedef struct arena {
    _Alignas(64) char bytes[1 << 16];
    size_t used;
} arena;

static void *take_from_arena(size_t size, void *context) {
    arena *all = context;
    void *const taken = all->bytes + all->used;
    all->used += (size + 63) / 64 * 64;
    return all->used <= sizeof all->bytes ? taken : NULL;
}

static void leave_in_arena(void *memory, void *context) {
    (void)memory;
    (void)context;
}

/* Another store where the last one was, which has changed as often. */
TEST(notices_another_store_in_the_same_place) {
    static arena memory;
    const narc_allocator allocator = {take_from_arena, leave_in_arena, &memory};
    narc_broad_phase *broad = create_broad_phase(NULL);
    const narc_pair_options options = {.skin = 0.125f};
    const placed two[] = {place_at(0, 0, 0), place_at(3, 0, 0)};
    const narc_bodies bodies = view_placed(two, 2, true, true);
    for (int step = 0; step < 4; step++) {
        const struct shape circle = circle_of(step % 2 ? 2.25 : 0.5);
        narc_shapes *shapes = NULL;
        memory.used = 0;
        assert_int_equal(narc_create_shapes(&allocator, &shapes), NARC_OK);
        store_shape(shapes, circle);
        assert_int_equal(update(broad, shapes, &bodies, &options)->pairs.count, step % 2);
        narc_destroy_shapes(shapes);
        narc_forget_pairs(broad); /* or larger boxes are kept */
    }
    narc_destroy_broad_phase(broad);
}

/* Nearly all boxes of a row move a little, again and again: they are all sorted again, though searching for the pairs of
 * each alone would not take long. */
TEST(sorts_again_what_moves) {
    enum { COUNT = 1000 };
    narc_box boxes[COUNT];
    const narc_pair_options options = {.skin = 0.02f};
    narc_broad_phase *broad = create_broad_phase(NULL);
    for (size_t step = 0; step < 8; step++) {
        for (size_t k = 0; k < COUNT; k++) {
            const float x = (float)k * 0.9f + (float)(k % 2 * step) * 0.01f, y = (float)step * 0.3f;
            boxes[k] = (narc_box){x, y, x + 1, y + 1};
        }
        assert_int_equal(update_boxes(broad, boxes, COUNT, &options)->pairs.count, COUNT - 1);
    }
    narc_destroy_broad_phase(broad);
}

/* ------------------------------------------------------------------------------------------------ memory and errors */

TEST(allocates_nothing_once_it_has_grown) {
    enum { COUNT = 3000, STEPS = 30 };
    struct test_random random = test_random_named("steady lists");
    struct ledger ledger = {0};
    narc_broad_phase *broad = create_broad_phase(&ledger);
    const narc_workers workers = narc_openmp_workers(2);
    narc_box boxes[COUNT];
    uint64_t ids[COUNT];
    size_t after = 0;
    for (int step = 0; step < STEPS; step++) {
        const narc_pair_options options = {.margin = 0.5f, .skin = 0.125f, .id = NARC_ARRAY(ids), .workers = &workers};
        for (size_t k = 0; k < COUNT && step % 2 == 0; k++) { /* all others, and all in other places */
            boxes[k] = eighths_box(&random, 60);
            ids[k] = random_bits(&random);
        }
        const narc_pair_list *list = update_boxes(broad, boxes, COUNT, &options);
        assert_int_equal(list->kept, step % 2 == 1);
        assert_true(list->kept || list->added_count == list->pairs.count);
        if (step == 7)
            after = ledger.allocations;
    }
    assert_int_equal(ledger.allocations, after);
    narc_destroy_broad_phase(broad);
}

/* What is given in a step; ids may be none. */
struct step {
    const narc_box *boxes;
    const uint64_t *ids;
    size_t count;
};

static narc_status take_step(narc_broad_phase *broad, const struct step *step, const narc_pair_list **out_list) {
    const narc_pair_options options = {.skin = 0.125f, .id = {step->ids, sizeof *step->ids}};
    return narc_update_box_pairs(broad, step->boxes, step->count, &options, out_list, NULL);
}

/* Every allocation of the second step fails twice: the last list stays, however often the step is tried, and the next
 * one is as if nothing had been: the same, or the one before it again, whose bodies must not be taken for those that the
 * step that failed had. Returns how many allocations there are. */
static size_t fail_allocations(const struct step *before, const struct step *after) {
    for (size_t failures = 0;; failures++) {
        struct ledger ledger = {0}, other_ledger = {0};
        narc_broad_phase *broad = create_broad_phase(&ledger), *whole = create_broad_phase(&other_ledger);
        const narc_pair_list *list = NULL, *whole_list = NULL, *untouched;
        assert_int_equal(take_step(broad, before, &list), NARC_OK);
        assert_int_equal(take_step(whole, before, &whole_list), NARC_OK);
        ledger.limited = true;
        ledger.left = failures / 2;
        untouched = list;
        const narc_status status = take_step(broad, after, &untouched);
        if (status != NARC_OK) {
            assert_int_equal(status, NARC_ERROR_MEMORY);
            ledger.left = 0;
            for (int trial = 0; trial < 2; trial++)
                assert_int_equal(take_step(broad, after, &untouched), NARC_ERROR_MEMORY);
            assert_ptr_equal(untouched, list);
            check_equal_lists(list, whole_list);
            ledger.limited = false;
            if (failures % 2) {
                assert_int_equal(take_step(broad, before, &list), NARC_OK);
                assert_true(list->added_count == 0 && list->lost_count == 0);
            }
            assert_int_equal(take_step(broad, after, &untouched), NARC_OK);
        }
        assert_int_equal(take_step(whole, after, &whole_list), NARC_OK);
        assert_true(whole_list->lost_count > 0 && whole_list->added_count > 0);
        check_equal_lists(untouched, whole_list);
        narc_destroy_broad_phase(broad);
        narc_destroy_broad_phase(whole);
        if (status == NARC_OK)
            return failures / 2;
    }
}

/* More bodies than before; bodies that had no ids get some; few bodies that move into the midst of many; as many bodies
 * as before, of which half meet now: there is memory for them but not for their pairs. */
TEST(survives_failing_allocations) {
    enum { FEW = 300, MANY = 5000, MOVED = 100 };
    static narc_box boxes[MANY], moved[MANY], crowd[FEW];
    static uint64_t ids[MANY], later_ids[MANY];
    struct test_random random = test_random_named("failing lists");
    for (size_t k = 0; k < MANY; k++) {
        boxes[k] = eighths_box(&random, 30);
        moved[k] = k % (MANY / MOVED) ? boxes[k] : (narc_box){0, 0, 6, 6};
        ids[k] = random_bits(&random);
        later_ids[k] = k % 3 ? ids[k] : random_bits(&random);
    }
    for (size_t k = 0; k < 40; k++)
        moved[1 + k * (MANY / 40)] = (narc_box){100, 100, 101, 101}; /* and some go far away */
    for (size_t k = 0; k < FEW; k++)
        crowd[k] = k % 2 ? (narc_box){0, 0, 1, 1} : (narc_box){(float)k, 100, (float)k + 1, 101};
    assert_true(fail_allocations(&(struct step){boxes, ids, FEW}, &(struct step){boxes, later_ids, MANY}) >= 5);
    assert_true(fail_allocations(&(struct step){boxes, NULL, MANY}, &(struct step){boxes, later_ids, MANY}) >= 3);
    assert_true(fail_allocations(&(struct step){boxes, ids, MANY}, &(struct step){moved, ids, MANY}) >= 2);
    assert_true(fail_allocations(&(struct step){boxes, NULL, FEW}, &(struct step){crowd, NULL, FEW}) >= 1);
}

/* Bodies may be none, before any memory is needed and after all are gone. */
TEST(lists_no_bodies) {
    const narc_box boxes[] = {{0, 0, 1, 1}, {1, 0, 2, 1}};
    const uint64_t ids[] = {7, 5};
    const narc_pair_options options = {.skin = 0.125f, .id = NARC_ARRAY(ids)};
    static const size_t counts[] = {0, 0, 2, 0, 1, 2};
    narc_broad_phase *broad = create_broad_phase(NULL);
    for (size_t step = 0, pairs = 0; step < sizeof counts / sizeof *counts; step++) {
        const narc_pair_list *const list = update_boxes(broad, boxes, counts[step], &options);
        assert_int_equal(list->lost_count, pairs);
        pairs = counts[step] == 2;
        assert_int_equal(list->pairs.count, pairs);
        assert_int_equal(list->added_count, pairs);
    }
    narc_forget_pairs(NULL);
    narc_destroy_broad_phase(broad);
}

TEST(refuses_bad_arguments) {
    narc_box boxes[] = {{0, 0, 1, 1}, {1, 0, 2, 1}, {0, 0, 1, 2}};
    const uint64_t ids[] = {5, 6, 7}, twice[] = {6, 5, 5};
    narc_pair_options options = {.id = NARC_ARRAY(ids)};
    const narc_pair_list *list = NULL;
    narc_broad_phase *broad = create_broad_phase(NULL);
    narc_error error;
    narc_shapes *shapes = empty_store();
    const narc_pair_list *const before = update_boxes(broad, boxes, 3, &options);
    assert_int_equal(before->pairs.count, 3);
    expect_error(narc_update_box_pairs(NULL, boxes, 3, NULL, &list, &error), NARC_ERROR_ARGUMENT, &error, "broad");
    expect_error(narc_update_box_pairs(broad, NULL, 3, NULL, &list, &error), NARC_ERROR_ARGUMENT, &error, "boxes");
    expect_error(narc_update_box_pairs(broad, boxes, 3, NULL, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_list");
    expect_error(narc_update_box_pairs(broad, boxes, (size_t)UINT32_MAX, NULL, &list, &error), NARC_ERROR_ARGUMENT,
                 &error, "4294967295 bodies");
    const struct {
        narc_pair_options options;
        narc_status status;
        const char *message;
    } bad[] = {
        {{.skin = -1}, NARC_ERROR_ARGUMENT, "options.skin is -1, less than 0"},
        {{.skin = INFINITY}, NARC_ERROR_NOT_FINITE, "options.skin is inf"},
        {{.margin = NAN}, NARC_ERROR_NOT_FINITE, "options.margin is nan"},
        {{.margin = -2}, NARC_ERROR_ARGUMENT, "options.margin is -2, less than 0"},
        {{.motion_x = NARC_COLUMN(boxes, min_x)},
         NARC_ERROR_ARGUMENT,
         "options.motion with boxes, which hold their motion"},
        {{.reserved = {boxes}}, NARC_ERROR_ARGUMENT, "options.reserved[0] is not NULL"},
        {{.id = NARC_ARRAY(twice)}, NARC_ERROR_ARGUMENT, "body 2: id 5 is also that of a body before it"},
    };
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
        assert_int_equal(narc_update_box_pairs(broad, boxes, 3, &bad[k].options, &list, &error), bad[k].status);
        assert_string_equal(error.message, bad[k].message);
    }
    narc_bodies bodies = {.count = 1};
    assert_int_equal(narc_update_pairs(broad, NULL, &bodies, NULL, &list, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_update_pairs(broad, shapes, NULL, NULL, &list, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_update_pairs(broad, shapes, &bodies, NULL, &list, NULL), NARC_ERROR_ARGUMENT);
    const placed unknown = place_at(0, 0, 3);
    bodies = view_placed(&unknown, 1, true, true);
    assert_int_equal(narc_update_pairs(broad, shapes, &bodies, NULL, &list, NULL), NARC_ERROR_INDEX);
    assert_null(list);
    assert_int_equal(before->pairs.count, 3); /* as it was, and the next step goes on from there */
    list = update_boxes(broad, boxes, 3, &options);
    assert_true(list->kept && list->pairs.count == 3);
    boxes[0].min_x = -INFINITY;
    list = update_boxes(broad, boxes, 3, &options);
    assert_true(list->lost_count == 2 && list->skipped == 1);
    narc_destroy_shapes(shapes);
    narc_destroy_broad_phase(broad);
}

TEST_MAIN("pair lists")
