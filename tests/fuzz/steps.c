/* SPDX-License-Identifier: MIT
 *
 * steps.c - contacts that stay, from arbitrary calls: bodies that move, come, go, change all that there is of them, pairs that
 * are found or given, ground, two objects of which one goes on from the other's bytes, damaged bytes, memory that ends.
 * Rows are those of plain calls, twins give the same bytes, an error leaves the last result as it was.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "narc.h"
#include "narc_chains.h"
#include "narc_contacts.h"
#include "turtle.h"

enum { MOST = 13, GROUND = 14, ALL = MOST + GROUND, SHAPES = 5, CALLS = 64, LOADS = 8, PAIRS = ALL * ALL, IDS = 32 };

/* How the last step of an object that did not fail was called, and what has changed since. */
struct object {
    narc_contacts *contacts;
    const narc_step_result *r; /* NULL: none */
    bool tainted;              /* it was loaded from damaged bytes: what it says may be wrong */
    bool given;                /* its pairs are the caller's of now */
    bool unknown;              /* anything may have changed */
    bool changed[ALL];
    bool forgotten[IDS]; /* by id: it was taken out */
    size_t touched;      /* so many pairs did in the last step */
};

struct world {
    narc_shapes *store;
    narc_body body[ALL];
    uint64_t id[ALL];
    uint8_t kind[ALL];
    uint32_t owner[ALL], world[ALL], run[ALL];
    float motion[ALL], ahead[ALL];
    size_t count, ground; /* bodies, and entries behind them */
    uint32_t pair_a[PAIRS], pair_b[PAIRS];
    size_t pair_count;
    bool give_pairs, use_filter, use_motion, use_run, use_ids;
    narc_contacts_settings settings;
    float margin, skin, recycling;
    narc_point origin;
    struct object object[2];
    bool twins; /* both objects are the same */
    char *saved;
    size_t saved_size;
};

static size_t allowed; /* allocations until one fails; SIZE_MAX: none does */

static void *allocate(size_t size, void *context) {
    (void)context;
    if (allowed == 0)
        return NULL;
    allowed -= allowed != SIZE_MAX;
    return malloc(size);
}

static void release(void *memory, void *context) {
    (void)context;
    free(memory);
}

static const narc_allocator scarce = {allocate, release, NULL};

/* ------------------------------------------------------------------------------------------------ the world */

static size_t count_all(const struct world *w) { return w->count + w->ground; }

static void note_change(struct world *w, size_t k) { w->object[0].changed[k] = w->object[1].changed[k] = true; }

static void note_all(struct world *w) { w->object[0].unknown = w->object[1].unknown = true; }

static uint64_t take_id(struct bytes *from, const struct world *w) {
    uint64_t id = take_below(from, IDS);
    for (size_t k = 0; k < count_all(w); k++)
        if (w->id[k] == id) {
            id = (id + 1) % IDS;
            k = (size_t)-1;
        }
    return id;
}

static void put_body(struct bytes *from, struct world *w, size_t k) {
    static const float turns[][2] = {{1, 0}, {0, 1}, {-0.6f, 0.8f}, {0.8f, 0.6f}};
    const float *const turn = turns[take_below(from, 4)];
    w->body[k].x = take_number(from, 1.5);
    w->body[k].y = take_number(from, 1.5);
    w->body[k].cosine = turn[0];
    w->body[k].sine = turn[1];
}

static void copy_body(struct world *w, size_t to, size_t of) {
    w->body[to] = w->body[of];
    w->id[to] = w->id[of];
    w->kind[to] = w->kind[of];
    w->owner[to] = w->owner[of];
    w->world[to] = w->world[of];
    w->run[to] = w->run[of];
    w->motion[to] = w->motion[of];
    w->ahead[to] = w->ahead[of];
}

static void make_body(struct bytes *from, struct world *w, size_t k) {
    w->body[k] = (narc_body){.scale = take_below(from, 4) ? 1 : 0.5f, .shape = take_below(from, SHAPES)};
    put_body(from, w, k);
    w->id[k] = IDS; /* nobody's */
    w->id[k] = take_id(from, w);
    w->kind[k] = take_below(from, 4) ? 0 : (uint8_t)take_below(from, 8);
    w->owner[k] = take_below(from, 4) ? UINT32_MAX : take_below(from, 2);
    w->world[k] = take_below(from, 8) ? 0 : 77 * take_below(from, 3);
    w->run[k] = NARC_NO_RUN;
    w->motion[k] = w->ahead[k] = 0;
}

/* Ground moves up or down by a place. */
static void move_ground(struct world *w, bool up) {
    if (up)
        for (size_t k = count_all(w); k > w->count; k--)
            copy_body(w, k, k - 1);
    else
        for (size_t k = w->count - 1; k + 1 < count_all(w); k++)
            copy_body(w, k, k + 1);
    note_all(w);
}

static void lay_ground(struct bytes *from, struct world *w) {
    narc_chain_entry entry[GROUND];
    AUTO(free_at) struct turtle t = create_turtle(-3, -1, 0);
    for (unsigned k = 2 + take_below(from, 3); k > 0; k--)
        walk_arc(&t, take_below(from, 3) ? 1.5 : 0, (take_number(from, 0.9) < 0 ? -0.8 : 0.8));
    walk_arc(&t, 0, 0);
    if (narc_add_chain(w->store, t.arcs, t.count, NULL, entry, GROUND, &w->ground, NULL) != NARC_OK)
        w->ground = 0;
    for (size_t k = 0; k < w->ground; k++) {
        make_body(from, w, k);
        w->body[k] = (narc_body){entry[k].x, entry[k].y, 1, 0, 1, entry[k].shape};
        w->kind[k] = NARC_STATIC;
        w->owner[k] = UINT32_MAX;
        w->world[k] = 0;
        w->run[k] = entry[k].run;
        w->id[k] = IDS + k;
    }
}

static float take_length(struct bytes *from) {
    const float lengths[] = {0, 0.05f, 0.25f, 1};
    return lengths[take_below(from, 4)];
}

static void change_body(struct bytes *from, struct world *w) {
    const size_t k = take_below(from, (unsigned)count_all(w));
    narc_body *const b = &w->body[k];
    switch (take_below(from, 14)) {
    case 0:
        put_body(from, w, k);
        break;
    case 1:
        b->shape = take_below(from, SHAPES);
        break;
    case 2:
        b->scale = take_below(from, 8) ? 1.5f - b->scale : take_any(from);
        break;
    case 3:
        b->x = take_below(from, 2) ? (double)NAN : 1e24;
        break;
    case 4:
        w->kind[k] = (uint8_t)take_below(from, 8) | (k < w->count ? 0 : NARC_STATIC);
        break;
    case 5:
        w->kind[k] ^= NARC_ASLEEP;
        break;
    case 6:
        w->owner[k] = take_below(from, 3) - 1;
        w->world[k] = 77 * take_below(from, 2);
        break;
    case 7:
        w->motion[k] = (float)take_number(from, 1);
        w->ahead[k] = take_below(from, 6) ? take_length(from) : take_any(from);
        break;
    case 8:
        w->run[k] = k < w->count || take_below(from, 3) == 0 ? NARC_NO_RUN : w->run[w->count];
        break;
    default:
        b->x += take_number(from, 0.03);
        b->y += take_number(from, 0.03);
        break;
    }
    note_change(w, k);
}

/* One comes, goes, or two change places. */
static void change_bodies(struct bytes *from, struct world *w) {
    const unsigned what = take_below(from, 4);
    const size_t j = take_below(from, (unsigned)w->count + 1), k = take_below(from, (unsigned)w->count + 1);
    if (what == 0 && w->count < MOST - 1) {
        move_ground(w, true);
        make_body(from, w, w->count++);
    } else if (what == 1 && k < w->count) {
        copy_body(w, k, w->count - 1);
        move_ground(w, false);
        w->count--;
    } else if (what == 2 && j < w->count && k < w->count) {
        copy_body(w, ALL - 1, j);
        copy_body(w, j, k);
        copy_body(w, k, ALL - 1);
        note_change(w, j);
        note_change(w, k);
    } else if (k < w->count) { /* another body, perhaps one that is known from before */
        make_body(from, w, k);
        note_change(w, k);
    }
}

static void take_pairs(struct bytes *from, struct world *w) {
    const unsigned kept = 1 + take_below(from, 4), wrong = take_below(from, 8);
    w->pair_count = 0;
    for (uint32_t b = 0; b < count_all(w); b++)
        for (uint32_t a = 0; a < b; a++)
            if ((a * 7 + b * 5) % 4 < kept) {
                const bool turned = (a + b) % 3 == 0;
                w->pair_a[w->pair_count] = turned ? b : a;
                w->pair_b[w->pair_count++] = turned ? a : b;
            }
    if (wrong < 3 && w->pair_count > 1) {
        const size_t k = take_byte(from) % (w->pair_count - 1);
        w->pair_b[k] = wrong == 0 ? w->pair_a[k] : wrong == 1 ? (uint32_t)ALL : w->pair_a[k + 1];
        w->pair_a[k] = wrong == 2 ? w->pair_b[k + 1] : w->pair_a[k]; /* that one a second time */
    }
    w->object[0].given = w->object[1].given = false;
}

static bool are_pairs_fine(const struct world *w) {
    bool there[ALL][ALL] = {{false}};
    for (size_t k = 0; k < w->pair_count; k++) {
        const uint32_t a = w->pair_a[k], b = w->pair_b[k];
        if (a == b || a >= count_all(w) || b >= count_all(w) || there[a][b])
            return false;
        there[a][b] = there[b][a] = true;
    }
    return true;
}

static void change_call(struct bytes *from, struct world *w) {
    switch (take_below(from, 10)) {
    case 0:
        w->margin = take_length(from);
        break;
    case 1:
        w->skin = take_length(from);
        break;
    case 2:
        w->recycling = take_length(from) / 32;
        break;
    case 3:
        w->use_filter = !w->use_filter;
        break;
    case 4:
        w->use_motion = !w->use_motion;
        note_all(w);
        break;
    case 5:
        w->use_run = !w->use_run;
        note_all(w);
        break;
    case 6:
        w->use_ids = !w->use_ids;
        note_all(w);
        break;
    case 7: {
        const struct shape shape = take_shape(from);
        narc_replace_shape(w->store, take_below(from, SHAPES), shape.arcs, shape.count, NULL);
        break;
    }
    default:
        w->give_pairs = !w->give_pairs;
        take_pairs(from, w);
        break;
    }
}

/* ------------------------------------------------------------------------------------------------ checks */

static const void *row_at(const struct world *w, const narc_step_result *r, uint32_t slot) {
    if (w->settings.rows & NARC_ROWS_IN_USER)
        return (const char *)r->user + slot * w->settings.user_size + w->settings.row_offset;
    return r->manifolds ? (const void *)&r->manifolds[slot] : &r->contacts[slot];
}

static size_t row_size(const struct world *w) {
    return w->settings.rows & NARC_CONTACT_ROWS ? sizeof(narc_contact) : sizeof(narc_manifold);
}

/* All that a result shows. */
static uint64_t hash_result(const struct world *w, const narc_step_result *r) {
    uint64_t hash = test_hash(TEST_HASH_START, r->order, r->count * sizeof *r->order);
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k];
        hash = test_hash(hash, &r->pairs.a.base[slot], sizeof slot);
        hash = test_hash(hash, &r->pairs.b.base[slot], sizeof slot);
        hash = test_hash(hash, &r->state[slot], 1);
        hash = test_hash(hash, row_at(w, r, slot), row_size(w));
        hash = test_hash(hash, (const char *)r->user + slot * w->settings.user_size, w->settings.user_size);
    }
    hash = test_hash(hash, r->more, r->more_count * row_size(w));
    hash = test_hash(hash, r->touching, r->touching_count * sizeof *r->touching);
    hash = test_hash(hash, r->sensors, r->sensor_count * sizeof *r->sensors);
    hash = test_hash(hash, r->began, r->began_count * sizeof *r->began);
    hash = test_hash(hash, r->ended, r->ended_count * sizeof *r->ended);
    const size_t counts[] = {r->skipped, r->asked_count};
    return test_hash(hash, counts, sizeof counts);
}

static uint8_t kind_of(const struct world *w, uint32_t k) { return w->use_filter ? w->kind[k] : 0; }

static bool may_pair(const struct world *w, uint32_t a, uint32_t b) {
    const uint32_t owner = w->use_filter ? w->owner[a] : UINT32_MAX;
    if (w->use_filter && w->world[a] != w->world[b])
        return false;
    return !(kind_of(w, a) & kind_of(w, b) & (NARC_STATIC | NARC_SENSOR)) &&
           (owner == UINT32_MAX || owner != w->owner[b]);
}

static bool is_at_rest(const struct world *w, uint32_t k) { return kind_of(w, k) & (NARC_STATIC | NARC_ASLEEP); }

static bool is_ground(const struct world *w, uint32_t a, uint32_t b) {
    return w->body[a].shape >= SHAPES || w->body[b].shape >= SHAPES || (w->use_run && w->run[b] != NARC_NO_RUN);
}

/* A body whose motion is broken, or goes beyond all floats, has no pair but those that are given. */
static bool is_lost(const struct world *w, uint32_t k) {
    return w->use_motion && !(w->ahead[k] >= 0 && w->ahead[k] < 1e30f && fabsf(w->motion[k]) < 1e30f);
}

static bool is_large(const struct world *w, uint32_t k) {
    narc_aabb box;
    narc_get_aabb(w->store, w->body[k].shape, 1, 0, 1, &box);
    return w->body[k].scale > 2 || fmax(fmax(-box.min_x, box.max_x), fmax(-box.min_y, box.max_y)) > 9;
}

/* Is there what is near? Of very large bodies rounding alone is more than a margin. */
static void check_listed(const struct world *w, const narc_step_result *r, const narc_pairs *all,
                         const narc_query *query, const float *margins) {
    static narc_contact rows[4 * PAIRS];
    narc_bodies bodies;
    narc_view_bodies(w->body, count_all(w), &bodies);
    bool there[ALL][ALL] = {{false}};
    size_t found;
    for (size_t k = 0; k < r->count; k++)
        there[r->pairs.a.base[r->order[k]]][r->pairs.b.base[r->order[k]]] = true;
    assert_int_equal(narc_find_contacts(w->store, &bodies, all, query, rows, 4 * PAIRS, &found, NULL), NARC_OK);
    for (size_t k = 0; k < found; k++) {
        const uint32_t a = all->a.base[rows[k].pair], b = all->b.base[rows[k].pair];
        if (!may_pair(w, a, b) || is_lost(w, a) || is_lost(w, b) || is_large(w, a) || is_large(w, b) ||
            rows[k].separation > margins[rows[k].pair] - 1e-4f)
            continue;
        assert_true(there[a][b]);
    }
}

/* Rows of pairs that move, not of ground. */
static void check_rows(const struct world *w, const narc_step_result *r, const narc_pairs *all,
                       const narc_query *query) {
    static union {
        narc_contact contacts[PAIRS];
        narc_manifold manifolds[PAIRS];
    } plain;
    static uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    narc_bodies bodies;
    narc_view_bodies(w->body, count_all(w), &bodies);
    narc_query dense = *query;
    size_t found;
    dense.dense = 1;
    if (w->settings.rows & NARC_CONTACT_ROWS)
        assert_int_equal(narc_find_contacts(w->store, &bodies, all, &dense, plain.contacts, PAIRS, &found, NULL),
                         NARC_OK);
    else
        assert_int_equal(narc_find_manifolds(w->store, &bodies, all, &dense, plain.manifolds, PAIRS, &found, NULL),
                         NARC_OK);
    assert_int_equal(narc_find_overlaps(w->store, &bodies, all, NULL, bits, NULL), NARC_OK);
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k], a = r->pairs.a.base[slot], b = r->pairs.b.base[slot];
        const size_t pair = (size_t)b * (b - 1) / 2 + a;
        const bool touches = r->state[slot] & NARC_TOUCHING;
        if (is_at_rest(w, a) && is_at_rest(w, b))
            continue;
        if ((kind_of(w, a) | kind_of(w, b)) & NARC_SENSOR) {
            assert_int_equal(touches, bits[pair / 64] >> pair % 64 & 1);
            continue;
        }
        if (is_ground(w, a, b) || is_lost(w, a) || is_lost(w, b))
            continue;
        char *const expected = (char *)&plain + pair * row_size(w);
        const bool has =
            w->settings.rows & NARC_CONTACT_ROWS ? plain.contacts[pair].count : plain.manifolds[pair].count;
        assert_int_equal(touches, has);
        memcpy(expected, &slot, sizeof slot);
        assert_memory_equal(row_at(w, r, slot), expected, row_size(w));
    }
}

static void check_result(const struct world *w, const struct object *o, const narc_step *step) {
    static uint32_t a[PAIRS], b[PAIRS];
    static float margins[PAIRS];
    const narc_step_result *const r = o->r;
    narc_pairs all = {.a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    size_t listed = 0;
    for (uint32_t j = 0; j < count_all(w); j++)
        for (uint32_t i = 0; i < j; i++, all.count++) {
            a[all.count] = i;
            b[all.count] = j;
            margins[all.count] = w->margin + (w->use_motion ? w->ahead[i] + w->ahead[j] : 0);
            if (!(margins[all.count] >= 0)) /* no pair */
                margins[all.count] = 0;
        }
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k], first = r->pairs.a.base[slot], second = r->pairs.b.base[slot];
        const uint32_t before = k > 0 ? r->order[k - 1] : 0;
        assert_true(first < second && second < count_all(w) && may_pair(w, first, second));
        assert_true(k == 0 || r->pairs.a.base[before] < first ||
                    (r->pairs.a.base[before] == first && r->pairs.b.base[before] < second));
    }
    for (size_t k = 0; k < w->pair_count && step->pairs; k++)
        listed += may_pair(w, w->pair_a[k], w->pair_b[k]);
    if (step->pairs)
        assert_int_equal(listed, r->count);
    if (w->recycling > 0)
        return;
    const narc_query query = {.margins = NARC_ARRAY(margins)};
    check_rows(w, r, &all, &query);
    if (!step->pairs)
        check_listed(w, r, &all, &query, margins);
}

static size_t count_touching(const narc_step_result *r) {
    size_t count = 0;
    for (size_t k = 0; k < r->count; k++)
        count += r->state[r->order[k]] & NARC_TOUCHING;
    return count;
}

/* What touches, began and ended. */
static void check_lists(const struct world *w, struct object *o) {
    const narc_step_result *const r = o->r;
    const size_t before = o->touched;
    size_t touching = 0, sensors = 0;
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k], a = r->pairs.a.base[slot], b = r->pairs.b.base[slot];
        if (!(r->state[slot] & NARC_TOUCHING))
            continue;
        if ((kind_of(w, a) | kind_of(w, b)) & NARC_SENSOR)
            assert_true(sensors < r->sensor_count && r->sensors[sensors++] == slot);
        else if (!is_at_rest(w, a) || !is_at_rest(w, b))
            assert_true(touching < r->touching_count && r->touching[touching++] == slot);
    }
    assert_true(touching == r->touching_count && sensors == r->sensor_count);
    o->touched = count_touching(r);
    assert_int_equal(o->touched + r->ended_count, before + r->began_count);
}

/* The caller's bytes stay with the pair's ids, unless one was taken out. */
static void check_marks(const struct world *w, struct object *o) {
    const narc_step_result *const r = o->r;
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t slot = r->order[k], a = r->pairs.a.base[slot], b = r->pairs.b.base[slot];
        const uint64_t one = w->use_ids ? w->id[a] : a, other = w->use_ids ? w->id[b] : b;
        const uint64_t mark = 1 + (one < other ? one << 32 | other : other << 32 | one);
        char *const at = (char *)r->user + slot * w->settings.user_size;
        uint64_t now;
        memcpy(&now, at, sizeof now);
        assert_true(r->state[slot] & NARC_NEW ? now == 0 : now == mark);
        assert_true(r->state[slot] & NARC_NEW ||
                    !((one < IDS && o->forgotten[one]) || (other < IDS && o->forgotten[other])));
        memcpy(at, &mark, sizeof mark);
    }
    memset(o->forgotten, 0, sizeof o->forgotten);
}

/* ------------------------------------------------------------------------------------------------ calls */

static bool step_object(struct bytes *from, struct world *w, struct object *o, bool listed, bool scarce_memory,
                        bool wrong) {
    static uint32_t moved[ALL];
    narc_bodies bodies;
    narc_view_bodies(w->body, count_all(w), &bodies);
    const narc_pair_filter filter = {
        .kind = NARC_ARRAY(w->kind), .owner = NARC_ARRAY(w->owner), .world = NARC_ARRAY(w->world)};
    const narc_pairs pairs = {.count = w->pair_count, .a = NARC_ARRAY(w->pair_a), .b = NARC_ARRAY(w->pair_b)};
    narc_step step = {
        .bodies = &bodies, .margin = w->margin, .skin = w->skin, .recycling = w->recycling, .origin = &w->origin};
    if (w->use_filter)
        step.filter = &filter;
    if (w->use_ids)
        step.id = (narc_word_column){w->id, sizeof *w->id};
    if (w->use_run)
        step.run = (narc_index_column){w->run, sizeof *w->run};
    if (w->use_motion) {
        step.motion_x = step.motion_y = (narc_float_column){w->motion, sizeof *w->motion};
        step.reach = step.ahead = (narc_float_column){w->ahead, sizeof *w->ahead};
    }
    if (w->give_pairs) {
        step.pairs = &pairs;
        step.same_pairs = o->given;
    }
    if (listed && o->r && !o->unknown) {
        step.moved = (narc_index_column){moved, sizeof *moved};
        for (uint32_t k = 0; k < count_all(w); k++)
            if (o->changed[k])
                moved[step.moved_count++] = k;
    }
    if (wrong)
        step.margin = -1;
    const bool may_fail = wrong || scarce_memory || (w->give_pairs && !are_pairs_fine(w));
    const uint64_t before = o->r ? hash_result(w, o->r) : 0;
    narc_error error;
    allowed = scarce_memory ? take_below(from, 24) : SIZE_MAX;
    const narc_status status = narc_update_contacts(o->contacts, w->store, &step, &o->r, &error);
    allowed = SIZE_MAX;
    if (status != NARC_OK) {
        assert_true(may_fail || o->tainted);
        assert_true(!o->r || hash_result(w, o->r) == before);
        return false;
    }
    o->given = w->give_pairs;
    o->unknown = false;
    memset(o->changed, 0, sizeof o->changed);
    if (!o->tainted) {
        check_result(w, o, &step);
        check_lists(w, o);
        check_marks(w, o);
    }
    return true;
}

/* Twins go on together, as long as they are the same. */
static void make_step(struct bytes *from, struct world *w) {
    const unsigned how = take_byte(from);
    const bool failing = how >> 2 & how >> 3 & 1, wrong = how >> 5 == 7;
    const double far[8] = {0, 0, 0, 1, -30, 1000, 1e5, 0};
    w->origin.x += far[how >> 5];
    w->origin.y = w->origin.x > 1e6 ? 0 : w->origin.x;
    struct object *const o = &w->object[how & 1];
    if (w->give_pairs && !are_pairs_fine(w) && take_below(from, 2))
        take_pairs(from, w);
    if (!w->twins) {
        step_object(from, w, o, how & 2, failing, wrong);
        return;
    }
    test_use_isa(how & 16 ? "scalar" : NULL);
    const bool first = step_object(from, w, &w->object[0], how & 2, false, wrong);
    test_use_isa(NULL);
    const bool second = step_object(from, w, &w->object[1], false, false, wrong);
    assert_int_equal(first, second);
    if (first)
        assert_true(hash_result(w, w->object[0].r) == hash_result(w, w->object[1].r));
}

static void save(struct world *w, const struct object *o) {
    free(w->saved);
    w->saved_size = narc_count_contact_bytes(o->contacts);
    w->saved = malloc(w->saved_size);
    assert_int_equal(narc_save_contacts(o->contacts, w->saved, w->saved_size - 1, NULL), NARC_ERROR_CAPACITY);
    assert_int_equal(narc_save_contacts(o->contacts, w->saved, w->saved_size, NULL), NARC_OK);
    AUTO(free_at) char *const copy = malloc(w->saved_size);
    memcpy(copy, w->saved, w->saved_size);
    sum_up_contacts(copy, w->saved_size);
    assert_memory_equal(copy, w->saved, w->saved_size); /* or what is damaged below is refused for its sum alone */
}

/* Into the other object, which is the same then. */
static void make_twins(struct world *w, unsigned number) {
    struct object *const one = &w->object[number], *const other = &w->object[1 - number];
    if (one->tainted)
        return;
    save(w, one);
    assert_int_equal(narc_load_contacts(other->contacts, w->store, w->saved, w->saved_size, &other->r, NULL), NARC_OK);
    if (one->r)
        assert_true(hash_result(w, one->r) == hash_result(w, other->r));
    narc_contacts *const contacts = other->contacts;
    const narc_step_result *const r = other->r;
    *other = *one;
    other->contacts = contacts;
    other->r = r;
    w->twins = true;
    AUTO(free_at) char *const again = malloc(w->saved_size);
    assert_int_equal(narc_save_contacts(other->contacts, again, w->saved_size, NULL), NARC_OK);
    assert_memory_equal(again, w->saved, w->saved_size);
}

/* Bytes of some step before, damaged or not. */
static void load(struct bytes *from, struct world *w, struct object *o) {
    const unsigned damages = take_below(from, 5);
    if (!w->saved)
        return;
    char *const bytes = malloc(w->saved_size);
    memcpy(bytes, w->saved, w->saved_size);
    for (unsigned k = 0; k < damages; k++) { /* any bits, none, all, those of another word */
        const uint32_t words = (uint32_t)(w->saved_size / 4), at = take_word(from) % words;
        const uint32_t with[] = {take_word(from), 0, UINT32_MAX};
        const unsigned what = take_below(from, 5);
        if (what < 3)
            memcpy(bytes + 4 * at, &with[what], sizeof *with);
        else if (what == 3)
            memcpy(bytes + 4 * at, bytes + 4 * (with[0] % words), sizeof *with);
        else
            bytes[4 * at] = (char)(bytes[4 * at] ^ 1 << take_below(from, 8));
    }
    sum_up_contacts(bytes, w->saved_size);
    const size_t size = take_below(from, 8) ? w->saved_size : take_word(from) % w->saved_size;
    const uint64_t before = o->r ? hash_result(w, o->r) : 0;
    allowed = take_below(from, 4) ? SIZE_MAX : take_below(from, 24);
    const narc_status status = narc_load_contacts(o->contacts, w->store, bytes, size, &o->r, NULL);
    assert_true(status == NARC_OK || damages > 0 || size != w->saved_size || allowed != SIZE_MAX);
    allowed = SIZE_MAX;
    free(bytes);
    if (status != NARC_OK) {
        assert_true(!o->r || hash_result(w, o->r) == before);
        return;
    }
    w->twins = false;
    o->tainted = damages > 0;
    o->touched = damages > 0 ? 0 : count_touching(o->r);
    memset(o->forgotten, 0, sizeof o->forgotten);
    o->unknown = true;
    o->given = false;
}

static void ask_slots(struct bytes *from, const struct object *o) {
    const uint32_t body = take_below(from, ALL), *slots;
    size_t count;
    if (narc_find_body_slots(o->contacts, body, &slots, &count, NULL) != NARC_OK || o->tainted || !o->r)
        return;
    size_t at = 0;
    for (size_t k = 0; k < o->r->count; k++)
        if (o->r->pairs.a.base[o->r->order[k]] == body || o->r->pairs.b.base[o->r->order[k]] == body)
            assert_true(at < count && slots[at++] == o->r->order[k]);
    assert_int_equal(at, count);
}

static void forget(struct bytes *from, struct world *w, struct object *o) {
    if (take_below(from, 3) == 0) {
        narc_forget_contacts(o->contacts);
        o->tainted = o->given = false;
        o->unknown = true;
        o->touched = 0;
    } else {
        const uint64_t ids[] = {take_below(from, IDS), take_below(from, IDS)};
        const size_t count = take_below(from, 3);
        assert_int_equal(narc_forget_bodies(o->contacts, ids, count, NULL), NARC_OK);
        for (size_t k = 0; k < count; k++)
            o->forgotten[ids[k]] = true;
    }
    w->twins = false;
}

static void begin(struct bytes *from, struct world *w) {
    static const size_t offsets[] = {0, 8, 12};
    memset(w, 0, sizeof *w);
    w->store = empty_store();
    while (narc_count_shapes(w->store) < SHAPES)
        store_shape(w->store, take_below(from, 4) ? take_shape(from)
                                                  : circle_of(0.3 + 0.01 * (double)narc_count_shapes(w->store)));
    if (take_below(from, 2))
        lay_ground(from, w);
    for (unsigned k = take_below(from, MOST - 1); k > 0; k--) {
        move_ground(w, true);
        make_body(from, w, w->count++);
    }
    w->margin = take_length(from);
    w->skin = take_length(from);
    w->use_ids = w->use_filter = true;
    w->use_run = take_below(from, 2);
    w->settings = (narc_contacts_settings){.rows = take_below(from, 4), .user_size = 8, .allocator = &scarce};
    if (w->settings.rows & NARC_ROWS_IN_USER) { /* the mark is first */
        w->settings.row_offset = 8 + offsets[take_below(from, 3)];
        w->settings.user_size = w->settings.row_offset + row_size(w);
    }
    allowed = SIZE_MAX;
    for (size_t k = 0; k < 2; k++) {
        assert_int_equal(narc_create_contacts(&w->settings, &w->object[k].contacts, NULL), NARC_OK);
        w->object[k].unknown = true;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static struct world w;
    struct bytes from = {data, size};
    begin(&from, &w);
    for (int call = 0; call < CALLS && from.left > 0; call++) {
        const unsigned what = take_below(&from, 16);
        struct object *const o = &w.object[take_below(&from, 2)];
        for (unsigned changes = take_below(&from, 4); changes > 0 && count_all(&w) > 0; changes--)
            change_body(&from, &w);
        if (what == 0)
            change_bodies(&from, &w);
        else if (what == 1)
            change_call(&from, &w);
        else if (what == 2)
            forget(&from, &w, o);
        else if (what == 3)
            make_twins(&w, o == &w.object[1]);
        else if (what == 4)
            for (unsigned k = 0; k < LOADS && from.left > 0; k++) {
                load(&from, &w, o);
                if (o->tainted)
                    step_object(&from, &w, o, false, false, false);
            }
        else if (what == 5)
            ask_slots(&from, o);
        else if (what == 6 && !o->tainted)
            save(&w, o);
        make_step(&from, &w);
    }
    narc_destroy_contacts(w.object[0].contacts);
    narc_destroy_contacts(w.object[1].contacts);
    narc_destroy_shapes(w.store);
    free(w.saved);
    return 0;
}
