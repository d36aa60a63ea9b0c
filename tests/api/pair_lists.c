/* SPDX-License-Identifier: MIT
 *
 * pair_lists.c - narc_update_pairs(), the list of pairs under contacts that stay, step by step against all pairs of boxes in
 * double precision: which list is kept, its pairs, what was added and lost, as bodies come, go, change their numbers, shapes
 * and sizes, sleep and wake. Internal.
 *
 * Bodies are boxes along the axes. Their places, sides and margins are eighths, so that single precision has no rounding to
 * hide behind: a box that is a little larger overlaps no other one. The skin is no whole number of eighths, so that no body
 * is just about to leave its box.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "broad_phase/steps.h"
#include "families.h"
#include "guard.h"
#include "ledger.h"
#include "narc.h"

/* One object for each number of threads, and one that finds all pairs whenever it makes a list. */
enum { OBJECTS = 5, WHOLE = 4, MOST_BODIES = 9000, SHAPES = 16, LONG = 2 };
static const unsigned thread_counts[OBJECTS] = {1, 2, 3, 7, 2};

/* `near_x`, `near_y`: the position in single precision. */
typedef struct body {
    narc_body at;
    uint64_t id, category, mask;
    float near_x, near_y, reach;
    uint32_t owner, world;
    uint8_t kind;
} body;

typedef struct wide_box {
    double min_x, min_y, max_x, max_y;
    bool exists;
} wide_box;

typedef struct known_pair {
    uint64_t id_a, id_b; /* of the body with the lower number */
    uint32_t a, b;
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

/* The call where nothing fails. No more boxes are unsorted than there is room for. */
static const narc_pair_list *update(narc_broad_phase *broad, const narc_shapes *shapes, const narc_step *step) {
    const narc_pair_list *list = NULL;
    assert_int_equal(narc_update_pairs(broad, shapes, step, &list, NULL), NARC_OK);
    assert_true(broad->unsorted_count <= narc_most_unsorted(broad->box_capacity));
    return list;
}

/* Boxes, and their half sides; the first LONG are long ones. */
static narc_shapes *store;
static double half_x[SHAPES], half_y[SHAPES];

static void give_size(uint32_t shape, double x, double y) {
    const struct shape box = box_of(2 * x, 2 * y, 0);
    half_x[shape] = x;
    half_y[shape] = y;
    if (shape == narc_count_shapes(store))
        store_shape(store, box);
    else
        assert_int_equal(narc_replace_shape(store, shape, box.arcs, box.count, NULL), NARC_OK);
}

static int set_up(void **state) {
    (void)state;
    store = empty_store();
    for (uint32_t k = 0; k < SHAPES; k++)
        give_size(k, k == 0 ? 25 : 0.25 * (1 + k % 4), k == 1 ? 12.5 : 0.25 * (1 + k / 4));
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    narc_destroy_shapes(store);
    return 0;
}

static double half_of_margin, skin;
static bool kinds_alone; /* bodies have no categories, masks, owners and worlds, and kinds next to each other */
static bool in_singles;  /* positions are */

static narc_bodies view(const body *bodies, size_t count) {
    narc_bodies all = {.count = count,
                       .x = NARC_POSITION_COLUMN(bodies, at.x),
                       .y = NARC_POSITION_COLUMN(bodies, at.y),
                       .cosine = NARC_COLUMN(bodies, at.cosine),
                       .sine = NARC_COLUMN(bodies, at.sine),
                       .scale = NARC_COLUMN(bodies, at.scale),
                       .shape = NARC_COLUMN(bodies, at.shape)};
    if (in_singles) {
        all.x = NARC_POSITION_COLUMN(bodies, near_x);
        all.y = NARC_POSITION_COLUMN(bodies, near_y);
    }
    return all;
}

static wide_box widen(const wide_box *b, double by) {
    return (wide_box){b->min_x - by, b->min_y - by, b->max_x + by, b->max_y + by, b->exists};
}

static wide_box reach_of(const body *b) {
    const bool turned = b->at.sine != 0;
    const double scale = (double)b->at.scale, x = scale * (turned ? half_y : half_x)[b->at.shape],
                 y = scale * (turned ? half_x : half_y)[b->at.shape];
    const wide_box box = {b->at.x - x, b->at.y - y, b->at.x + x, b->at.y + y,
                          isfinite(b->at.y) && b->reach >= 0 && isfinite(b->reach)};
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
    return !(a->kind & b->kind & (NARC_STATIC | NARC_SENSOR)) && (a->owner != b->owner || a->owner == UINT32_MAX) &&
           (a->category & b->mask) && (b->category & a->mask) && a->world == b->world;
}

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
    return now->category != then->category || now->mask != then->mask || now->owner != then->owner ||
           now->world != then->world || ((now->kind ^ then->kind) & lasting) || !is_inside(&box, &r->kept[k]);
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
static void check_pairs(reference *r, const narc_pair_list *list, bool renew) {
    const uint32_t *a = list->pairs.a.base, *b = list->pairs.b.base;
    size_t added = 0;
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
    }
    assert_int_equal(list->added_count, added);
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
    size_t kept, renewed, few, flipped, lost, added, broken;
} totals;

/* Gives all objects the same step. */
static void check_step(reference *r, const body *bodies, size_t count, bool with_ids, totals *sums) {
    AUTO(guard_release_at) uint8_t *const kinds = guard_allocate(count);
    for (size_t k = 0; k < count; k++)
        kinds[k] = bodies[k].kind;
    const narc_pair_filter alone = {.kind = NARC_ARRAY(kinds)}, all = {.kind = NARC_COLUMN(bodies, kind),
                                                                       .category = NARC_COLUMN(bodies, category),
                                                                       .mask = NARC_COLUMN(bodies, mask),
                                                                       .owner = NARC_COLUMN(bodies, owner),
                                                                       .world = NARC_COLUMN(bodies, world)};
    const narc_bodies of_step = view(bodies, count);
    narc_step step = {.bodies = &of_step,
                      .margin = 2 * (float)half_of_margin,
                      .skin = (float)skin,
                      .reach = NARC_COLUMN(bodies, reach),
                      .filter = kinds_alone ? &alone : &all};
    if (with_ids)
        step.id = (narc_word_column){&bodies->id, sizeof *bodies};
    const bool renew = find_expected(r, bodies, count);
    const narc_pair_list *first = NULL;
    for (size_t t = 0; t < OBJECTS; t++) {
        const narc_workers workers = openmp_workers(thread_counts[t]);
        size_t none;
        step.workers = &workers;
        if (t == WHOLE)
            assert_int_equal(narc_find_pairs(r->broads[t], NULL, 0, NULL, NULL, NULL, NULL, 0, 0, &none, NULL),
                             NARC_OK);
        const narc_pair_list *const list = update(r->broads[t], store, &step);
        first = first ? first : list;
        check_equal_lists(list, first);
        check_pairs(r, list, renew);
        sums->lost += check_lost(r, list);
        assert_int_equal(list->skipped, count_broken(bodies, count));
        sums->added += list->added_count;
        sums->broken += list->skipped;
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
}

/* ------------------------------------------------------------------------------------------------ a world */

static double eighths(struct test_random *random, size_t most) { return (double)random_below(random, most + 1) / 8; }

static void put(body *b, double x, double y) {
    b->at.x = x;
    b->at.y = y;
    b->near_x = (float)x;
    b->near_y = (float)y;
}

static body body_at(double x, double y, uint32_t shape) {
    body b = {.at = {.cosine = 1, .scale = 1, .shape = shape}, .owner = UINT32_MAX};
    put(&b, x, y);
    return b;
}

static uint64_t choose_mask(struct test_random *random) {
    return kinds_alone || random_below(random, 8) ? UINT64_MAX : (uint64_t)1 << (31 + random_below(random, 4));
}

static body random_body(struct test_random *random, size_t side, uint64_t id) {
    const double half = (double)side / 2, x = eighths(random, 8 * side) - half, y = eighths(random, 8 * side) - half;
    const size_t shape =
        random_below(random, 100) ? LONG + random_below(random, SHAPES - LONG) : random_below(random, LONG);
    body b = body_at(x, y, (uint32_t)shape);
    b.id = id * 0x9e3779b97f4a7c15u;
    b.category = choose_mask(random);
    b.mask = choose_mask(random);
    b.owner = kinds_alone || random_below(random, 4) ? UINT32_MAX : (uint32_t)random_below(random, 3);
    b.world = kinds_alone || random_below(random, 4) ? 0 : 1000 * (uint32_t)random_below(random, 3);
    b.kind = random_below(random, 2) ? 0 : (uint8_t)random_below(random, 8);
    return b;
}

static void shift(body *b, double x, double y) { put(b, b->at.x + x, b->at.y + y); }

/* All that a box is made from. Without a skin there is no room for rounding. */
static void change_box(struct test_random *random, body *b) {
    switch (random_below(random, skin > 0 ? 7 : 0)) {
    case 0:
        b->reach = random_below(random, 6) ? (float)eighths(random, 4) : random_below(random, 2) ? NAN : -1;
        break;
    case 1: {
        const float cosine = b->at.cosine;
        b->at.cosine = -b->at.sine;
        b->at.sine = cosine;
        break;
    }
    case 2:
        b->at.scale = 3 - b->at.scale;
        break;
    case 3:
        b->at.shape = LONG + (uint32_t)random_below(random, SHAPES - LONG);
        break;
    case 4:
        give_size(LONG + (uint32_t)random_below(random, SHAPES - LONG), 0.125 + eighths(random, 7),
                  0.125 + eighths(random, 7));
        break;
    case 5:
        in_singles = !in_singles;
        break;
    default:
        half_of_margin = random_below(random, 2) ? 0.25 : 0.375;
        skin = random_below(random, 4) ? 0.5625 : 0.3125;
        break;
    }
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
    body *const b = &bodies[k];
    switch (random_below(random, with_ids ? 28 : 22)) {
    case 0:
        b->kind ^= (uint8_t)(1 << random_below(random, 3));
        break;
    case 1:
        b->category = choose_mask(random);
        break;
    case 2:
        if (random_below(random, 2))
            b->owner = kinds_alone ? UINT32_MAX : (uint32_t)random_below(random, 3) - 1;
        else
            b->world = kinds_alone ? 0 : 1000 * (uint32_t)random_below(random, 2);
        break;
    case 3:
        if (skin > 0)
            change_box(random, b);
        break;
    case 4:
        put(b, b->at.x, (double)NAN);
        break;
    case 5:
        return count - 1;
    case 6:
    case 7: {
        const body elsewhere = random_body(random, side, 0);
        put(b, elsewhere.at.x, elsewhere.at.y);
        break;
    }
    default: /* within the skin, mostly */
        shift(b, eighths(random, 2) - 0.125, eighths(random, 2) - 0.125);
        break;
    case 22: /* swap with last */
    case 23:
        *b = bodies[count - 1];
        return count - 1;
    case 24: /* all behind it move up */
        memmove(b, b + 1, (count - k - 1) * sizeof *bodies);
        return count - 1;
    case 25: /* one goes and one comes: the count stays */
        *b = random_body(random, side, ++*next_id);
        ++*next_id;
        break;
    case 26: {
        const body moved = *b;
        *b = bodies[other];
        bodies[other] = moved;
        break;
    }
    case 27:
        b->kind ^= NARC_ASLEEP;
        break;
    }
    return count;
}

/* bare: neither skin nor margin; movers: so many move far in a step at most, and else hardly anything happens. */
typedef struct world {
    const char *name;
    size_t steps, start, most, side, movers;
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
    reference *r = create_reference(w->most * 40 + 1000);
    AUTO(free_at) body *bodies = calloc(w->most + 1, sizeof *bodies);
    uint64_t next_id = w->start;
    totals sums = {0};
    half_of_margin = w->bare ? 0 : 0.25;
    skin = w->bare ? 0 : 0.5625;
    kinds_alone = w->kinds;
    for (size_t k = 0; k < w->start; k++) {
        bodies[k] = random_body(&random, w->side, k);
        bodies[k].id = w->with_ids ? bodies[k].id : k;
    }
    size_t count = w->start;
    for (size_t step = 0; step < w->steps; step++) {
        if (step % 100 == 50)
            forget_pairs(r);
        check_step(r, bodies, count, w->with_ids, &sums);
        if (w->movers > 0) { /* one of them ever further down */
            shift(&bodies[0], 0, -1.5 * (double)step);
            for (size_t moves = (size_t)random_below(&random, w->movers); moves-- > 0;)
                shift(&bodies[random_below(&random, count)], eighths(&random, 16) - 1, eighths(&random, 16) - 1);
        } else if (random_below(&random, 3) == 0) { /* sleep alone renews nothing */
            bodies[random_below(&random, count + 1)].kind ^= NARC_ASLEEP;
            continue;
        }
        const size_t changes = w->movers == 0 ? random_below(&random, 4) : random_below(&random, 3) == 0;
        for (size_t k = 0; k < changes; k++)
            count = change(&random, bodies, count, w->most, w->side, w->with_ids, &next_id);
    }
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
                            {"thousands", 6 + test_trials(6), MOST_BODIES - 10, MOST_BODIES, 150, .with_ids = true},
                            {"kinds", 100 + test_trials(900), 40, 60, 10, .kinds = true}};
    for (size_t k = 0; k < sizeof worlds / sizeof *worlds; k++) {
        const world *const w = &worlds[k];
        const totals sums = run_world(w);
        assert_true(w->with_ids || sums.flipped == 0);
        if (w->bare || w->start < 40 || w->start > 1000)
            continue;
        assert_true(sums.kept > w->steps / 40 && sums.renewed > w->steps / 40 && sums.lost > 0 && sums.added > 0);
        assert_true(sums.broken > 0);
        assert_int_equal(sums.flipped > 0, w->with_ids);
    }
}

/* A scene at rest, of which a few move. */
TEST(finds_pairs_of_few_that_move) {
    const world rest = {"rest", 20 + test_trials(60), 1500, 1520, 60, .movers = 50, .with_ids = true};
    for (size_t k = 0; narc_isa_name(k); k++)
        if (narc_isa_supported(narc_isa_name(k))) {
            assert_int_equal(narc_set_isa(narc_isa_name(k), NULL), NARC_OK);
            const totals sums = run_world(&rest);
            assert_true(sums.few > rest.steps / 2 && sums.renewed > sums.few && sums.lost > 0 && sums.added > 0);
        }
    assert_int_equal(narc_set_isa(NULL, NULL), NARC_OK);
}

/* ------------------------------------------------------------------------------------------------ what is noticed */

/* Bodies that move by the last bit of a number, with a skin of some of them: as if no pose were known. */
TEST(notices_the_last_bit) {
    for (int number = 0; number < 4; number++) {
        AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
        AUTO(narc_destroy_broad_phase_at) narc_broad_phase *other = create_broad_phase(NULL);
        body two[] = {body_at(1, 1, LONG), body_at(2, 2, LONG)};
        in_singles = number < 2;
        const narc_bodies bodies = view(two, 2);
        const narc_step step = {.bodies = &bodies, .skin = 0x1p-22f};
        size_t renewed = 0;
        for (int k = 0; k < 40; k++) {
            const narc_pair_list *const list = update(broad, store, &step);
            narc_forget_poses(other);
            check_equal_lists(list, update(other, store, &step));
            renewed += !list->kept;
            if (number % 2)
                put(&two[0], two[0].at.x, (double)nextafterf(two[0].near_y, 2));
            else
                put(&two[0], (double)nextafterf(two[0].near_x, 2), two[0].at.y);
        }
        assert_in_range(renewed, 4, 36);
    }
    in_singles = false;
}

/* A position of 3 in single precision has the bits of one near 0 in double precision. */
TEST(notices_the_precision_of_positions) {
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    const float three = 3;
    union {
        uint64_t bits;
        double number;
        float parts[2];
    } x[2] = {{0}, {0}};
    uint32_t bits;
    memcpy(&bits, &three, sizeof bits);
    x[1].bits = bits;
    const body two[] = {body_at(0, 0, LONG), body_at(0, 0, LONG)};
    narc_bodies bodies = view(two, 2);
    const narc_step step = {.bodies = &bodies};
    bodies.x = (narc_position_column){&x[0].number, sizeof x[0], NARC_FLOAT64};
    bodies.y = (narc_position_column){&x[0].number, 0, NARC_FLOAT64};
    assert_int_equal(update(broad, store, &step)->pairs.count, 1);
    const int low = x[1].parts[0] == three ? 0 : 1; /* the order of bytes */
    bodies.x = (narc_position_column){&x[0].parts[low], sizeof x[0], NARC_FLOAT32};
    bodies.y = (narc_position_column){&x[0].parts[low], 0, NARC_FLOAT32};
    assert_int_equal(update(broad, store, &step)->pairs.count, 0);
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
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    const body two[] = {body_at(0, 0, 0), body_at(3, 0, 0)};
    const narc_bodies bodies = view(two, 2);
    const narc_step step = {.bodies = &bodies, .skin = 0.125f};
    for (int k = 0; k < 4; k++) {
        narc_shapes *shapes = NULL;
        memory.used = 0;
        assert_int_equal(narc_create_shapes(&allocator, &shapes), NARC_OK);
        store_shape(shapes, circle_of(k % 2 ? 2.25 : 0.5));
        assert_int_equal(update(broad, shapes, &step)->pairs.count, k % 2);
        narc_destroy_shapes(shapes);
        narc_forget_pairs(broad); /* or larger boxes are kept */
    }
}

/* Nearly all boxes of a row move a little, again and again: they are all sorted again, though searching for the pairs of
 * each alone would not take long. */
TEST(sorts_again_what_moves) {
    enum { COUNT = 1000 };
    static body row[COUNT];
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    const narc_bodies bodies = view(row, COUNT);
    const narc_step step = {.bodies = &bodies, .skin = 0.02f};
    store_shape(shapes, box_of(1, 1, 0));
    for (size_t round = 0; round < 8; round++) {
        for (size_t k = 0; k < COUNT; k++)
            row[k] = body_at((double)k * 0.9 + (double)(k % 2 * round) * 0.01, (double)round * 0.3, 0);
        assert_int_equal(update(broad, shapes, &step)->pairs.count, COUNT - 1);
    }
}

/* ------------------------------------------------------------------------------------------------ memory */

TEST(allocates_nothing_once_it_has_grown) {
    enum { COUNT = 3000, STEPS = 30 };
    static body bodies[COUNT];
    struct test_random random = test_random_named("steady lists");
    struct ledger ledger = {0};
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(&ledger);
    const narc_workers workers = openmp_workers(2);
    const narc_bodies all = view(bodies, COUNT);
    const narc_step step = {
        .bodies = &all, .margin = 0.5f, .skin = 0.125f, .id = NARC_COLUMN(bodies, id), .workers = &workers};
    size_t after = 0;
    for (int round = 0; round < STEPS; round++) {
        for (size_t k = 0; k < COUNT && round % 2 == 0; k++) /* all others, and all in other places */
            bodies[k] = random_body(&random, 60, random_bits(&random));
        const narc_pair_list *list = update(broad, store, &step);
        assert_int_equal(list->kept, round % 2 == 1);
        assert_true(list->kept || list->added_count == list->pairs.count);
        if (round == STEPS / 2)
            after = ledger.allocations;
    }
    assert_int_equal(ledger.allocations, after);
}

/* What is given in a step. */
struct given {
    const body *bodies;
    size_t count;
    bool with_ids;
};

static narc_status take_step(narc_broad_phase *broad, const struct given *given, const narc_pair_list **out_list) {
    const narc_bodies bodies = view(given->bodies, given->count);
    const narc_step step = {
        .bodies = &bodies, .skin = 0.125f, .id = {given->with_ids ? &given->bodies->id : NULL, sizeof(body)}};
    return narc_update_pairs(broad, store, &step, out_list, NULL);
}

/* Every allocation of the second step fails twice: the last list stays, however often the step is tried, and the next
 * one is as if nothing had been: the same, or the one before it again, whose bodies must not be taken for those that the
 * step that failed had. Returns how many allocations there are. */
static size_t fail_allocations(const struct given *before, const struct given *after) {
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
    enum { FEW = 150, MANY = 1600, MOVED = 100 };
    static body bodies[MANY], later[MANY], moved[MANY], crowd[FEW];
    struct test_random random = test_random_named("failing lists");
    for (size_t k = 0; k < MANY; k++) {
        later[k] = moved[k] = bodies[k] = random_body(&random, 30, random_bits(&random));
        later[k].id = k % 3 ? bodies[k].id : random_bits(&random);
        if (k % (MANY / MOVED) == 0) {
            put(&moved[k], 0, 0);
            moved[k].at.scale = 6;
        } else if (k % (MANY / 40) == 1) /* and some go far away */
            put(&moved[k], 100, 100);
    }
    for (size_t k = 0; k < FEW; k++)
        crowd[k] = k % 2 ? body_at(0, 0, LONG) : body_at((double)(2 * k), 100, LONG);
    assert_true(fail_allocations(&(struct given){bodies, FEW, true}, &(struct given){later, MANY, true}) >= 5);
    assert_true(fail_allocations(&(struct given){bodies, MANY, false}, &(struct given){later, MANY, true}) >= 3);
    assert_true(fail_allocations(&(struct given){bodies, MANY, true}, &(struct given){moved, MANY, true}) >= 2);
    assert_true(fail_allocations(&(struct given){bodies, FEW, false}, &(struct given){crowd, FEW, false}) >= 1);
}

/* Bodies may be none, before any memory is needed and after all are gone. */
TEST(lists_no_bodies) {
    const body bodies[] = {body_at(0, 0, 0), body_at(0.5, 0, 0)}; /* a shape that no test replaces */
    static const size_t counts[] = {0, 0, 2, 0, 1, 2};
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad = create_broad_phase(NULL);
    for (size_t step = 0, pairs = 0; step < sizeof counts / sizeof *counts; step++) {
        const narc_pair_list *list = NULL;
        assert_int_equal(take_step(broad, &(struct given){bodies, counts[step], false}, &list), NARC_OK);
        assert_int_equal(list->lost_count, pairs);
        pairs = counts[step] == 2;
        assert_int_equal(list->pairs.count, pairs);
        assert_int_equal(list->added_count, pairs);
    }
}

int main(void) { return test_begin() ? test_run("pair lists", set_up, tear_down) : TEST_SKIPPED; }
