/* SPDX-License-Identifier: MIT
 *
 * plan.c - what a step does with each pair whose bodies are others than in the last one: ask, follow, or nothing. Pairs of
 * ground are planned first, as their rows may need memory, all others once each has its slot.
 */
#include "column.h"
#include "compiler.h"
#include "contacts.h"
#include "narc_chains.h"
#include "store.h"

#include <math.h>
#include <string.h>

static inline bool is_at_rest(const narc_contact_step *s, uint32_t body) {
    const narc_broad_phase *const broad = s->contacts->broad;
    return broad->has_filter && broad->kinds[body] & (NARC_STATIC | NARC_ASLEEP);
}

/* Bodies that are not listed as moved may have any number as their shape: it is no shape, until its pairs are asked. */
static const narc_shape_header *header_of(const narc_contact_step *s, uint32_t body) {
    static const narc_shape_header none;
    const uint32_t shape = narc_index_at(s->step->bodies->shape, body);
    return shape < s->shapes->count ? &s->shapes->headers[shape] : &none;
}

bool narc_are_smooth(const narc_contact_step *s, uint32_t a, uint32_t b) {
    return header_of(s, a)->flags & header_of(s, b)->flags & NARC_SHAPE_SMOOTH;
}

float narc_find_margin(const narc_contact_step *s, uint32_t a, uint32_t b) {
    const narc_float_column ahead = s->step->ahead;
    return s->step->margin + (ahead.base ? narc_float_at(ahead, a) + narc_float_at(ahead, b) : 0);
}

/* Twice 2^-18 of a body's extent; infinite where it is not known, or has no end. */
static float find_room(const narc_contact_step *s, uint32_t body) {
    const narc_shape_header *const header = header_of(s, body);
    const float scale = narc_float_or(s->step->bodies->scale, body, 1);
    return header->extent_ratio == UINT8_MAX || narc_is_plane(header)
               ? INFINITY
               : 0x1p-17f * (float)header->extent_ratio * header->bound_radius * scale;
}

static uint8_t find_ground(const narc_contact_step *s, uint32_t body) {
    const bool of_run = s->step->run.base && narc_index_at(s->step->run, body) != NARC_NO_RUN;
    return (uint8_t)((narc_is_of_chain(header_of(s, body)) ? NARC_IS_PIECE : 0) | (of_run ? NARC_IS_OF_RUN : 0));
}

/* What is looked at of each pair, in one place: the loop over all pairs is as long as much of what follows. */
typedef struct pair_view {
    const uint32_t *a, *b, *previous, *order;                 /* previous NULL: the list is the last one */
    const uint8_t *marks, *flags, *state, *changed, *grounds; /* `grounds` NULL: none is of ground */
    const narc_box *boxes;
    const float *room;
    float margin_room; /* INFINITY: no pair is known to have no row by its boxes */
} pair_view;

static pair_view view_pairs(const narc_contact_step *s) {
    const narc_contacts *const c = s->contacts;
    return (pair_view){.a = s->list->pairs.a.base,
                       .b = s->list->pairs.b.base,
                       .previous = s->list->kept ? NULL : s->list->previous,
                       .order = c->order,
                       .marks = s->list->marks,
                       .flags = c->flags,
                       .state = c->state,
                       .changed = c->broad->known.changed,
                       .grounds = s->has_ground ? c->grounds : NULL,
                       .boxes = c->broad->boxes_now,
                       .room = c->room,
                       .margin_room = s->step->ahead.base || s->step->pairs ? INFINITY : 0x1p-18f * s->step->margin};
}

/* The slot that a pair has, or NARC_NO_MATCH. */
static inline uint32_t slot_of(const pair_view *v, size_t k) {
    const uint32_t place = v->previous ? v->previous[k] : (uint32_t)k;
    return place == UINT32_MAX ? UINT32_MAX : v->order[place];
}

/* Is there no row, as the boxes of both, which have half of the margin each, are further apart than a separation may be
 * off? Its error bound is 2^-19 of the distance of the positions and both extents (narc.h); the distance is the gap between
 * the boxes, the margin and both extents at most. */
static inline bool are_apart(const pair_view *v, uint32_t a, uint32_t b) {
    if (!(v->margin_room < INFINITY)) /* there may be no boxes */
        return false;
    const narc_box *const p = &v->boxes[a], *const q = &v->boxes[b];
    const float left = p->min_x - q->max_x, right = q->min_x - p->max_x;
    const float below = p->min_y - q->max_y, above = q->min_y - p->max_y;
    const float x = left > right ? left : right, y = below > above ? below : above, gap = x > y ? x : y;
    return gap * (1 - 0x1p-18f) > v->room[a] + v->room[b] + v->margin_room;
}

/* Must a pair be asked, whatever has moved: is it new, turned, a sensor's for the first time, or was it at rest while
 * something changed? One that is marked as at rest stays so. */
static inline unsigned find_stale(unsigned flags, unsigned marks) {
    const unsigned old = flags & NARC_SLOT_STALE & ~(marks / NARC_RESTS);
    return old | (marks & NARC_FLIPPED) | ((flags ^ marks) & NARC_SENSOR);
}

static inline bool is_ground(const pair_view *v, size_t k) {
    return !(v->marks[k] & NARC_SENSOR) && (v->grounds[v->b[k]] | (v->grounds[v->a[k]] & NARC_IS_PIECE));
}

/* Was a pair ground that is none, or no sensor's? */
static inline bool was_ground(const pair_view *v, size_t k) {
    const uint32_t slot = slot_of(v, k);
    return slot != UINT32_MAX && (v->changed[v->b[k]] & NARC_RESHAPED || (v->marks[k] ^ v->flags[slot]) & NARC_SENSOR);
}

/* What is known of a pair with ground while it is planned. OF_OLD: it must be asked, whatever has moved. OF_OTHER: so must
 * all ground of the body, as a pair was ground, or is no sensor's any more. OF_HELD: what is kept of it still counts.
 * OF_FIRST: it is the first one of its body. */
enum {
    OF_CHANGED = 1,
    OF_OLD = 2,
    OF_BARE = 4,
    OF_KEPT = 8,
    OF_MOVING = 16,
    OF_OTHER = 32,
    OF_HELD = 64,
    OF_FIRST = 128
};

static inline unsigned look_at_ground(const pair_view *v, size_t k, uint32_t slot, unsigned changed_a) {
    const unsigned changed_b = v->changed[v->b[k]], moves = changed_b ? OF_MOVING : 0u;
    if (slot == UINT32_MAX)
        return OF_OLD | OF_CHANGED | OF_BARE | moves;
    const unsigned flags = v->flags[slot], bare = v->state[slot] & NARC_TOUCHING ? 0u : OF_BARE;
    if (find_stale(flags, v->marks[k]) || (changed_a | changed_b) & NARC_RESHAPED)
        return OF_OLD | OF_CHANGED | bare | moves;
    return (changed_a | changed_b ? OF_CHANGED : 0u) | (flags & NARC_SLOT_KEPT ? OF_KEPT : 0u) | bare | moves;
}

/* Of the pairs from `first` on, those of one body: these with ground are listed, and what is kept of them and may decide, if
 * something has changed. Returns the end. */
static size_t list_ground(const narc_contact_step *s, const pair_view *v, size_t first, size_t count) {
    narc_contacts *const c = s->contacts;
    const uint32_t a = v->a[first];
    size_t k = first;
    while (k < count && v->a[k] == a && !is_ground(v, k))
        k++;
    if (k == count || v->a[k] != a)
        return k;
    const unsigned keeps =
        s->step->recycling > 0 ? OF_KEPT : OF_KEPT | OF_BARE; /* rows follow, or pairs without one stay so */
    narc_pair_work *const work = c->work + c->work_count;
    size_t listed = 0;
    unsigned any = 0;
    for (size_t i = first; i < k; i++)
        any |= was_ground(v, i) ? OF_OTHER | OF_CHANGED : 0u;
    do {
        if (listed == 0 || is_ground(v, k)) {
            const uint32_t slot = slot_of(v, k);
            const unsigned what = look_at_ground(v, k, slot, v->changed[a]);
            any |= what;
            work[listed++] = (narc_pair_work){(uint32_t)k, slot, what};
        } else {
            any |= was_ground(v, k) ? OF_OTHER | OF_CHANGED : 0u;
        }
    } while (++k < count && v->a[k] == a);
    if (!(any & OF_CHANGED))
        return k;
    work->what |= (any & OF_OTHER) | OF_FIRST;
    c->work_count += listed;
    for (size_t i = 0; i < listed; i++) {
        if (s->step->ahead.base)
            c->ground_margins[work[i].pair] = narc_find_margin(s, a, v->b[work[i].pair]);
        if ((work[i].what & keeps) != keeps)
            continue;
        c->known[c->ground_count] = work[i].slot;
        c->ground_asked[c->ground_count++] = work[i].pair;
    }
    return k;
}

/* May all further rows of a slot follow? */
static bool may_more_follow(const narc_contact_step *s, const narc_pair_work *work) {
    const narc_contacts *const c = s->contacts;
    const narc_more_rows more = c->more_of[work->slot];
    bool may = true;
    for (uint32_t i = more.first; may && i < more.first + more.count; i++)
        may = narc_may_follow(s, work->pair, i, c->more.kept);
    return may;
}

/* Do all rows that a body has with ground follow it, and are there some? Rows tell of other ground only while none moves. */
static bool do_all_follow(const narc_contact_step *s, size_t first, size_t end) {
    const narc_pair_work *const work = s->contacts->work;
    unsigned any = 0, bare = OF_BARE;
    for (size_t i = first; i < end; i++) {
        any |= work[i].what;
        bare &= work[i].what;
        if (!(work[i].what & (OF_BARE | OF_HELD)))
            return false;
    }
    if (bare || any & (OF_OLD | OF_OTHER) || (any & OF_MOVING && any & OF_BARE))
        return false;
    for (size_t i = first; i < end; i++)
        if (!(work[i].what & OF_BARE) && !may_more_follow(s, &work[i]))
            return false;
    return true;
}

/* The plan of the listed pairs of one body, which are asked together, as their rows are merged; but those that have none are
 * not while what is kept of them holds. Returns the end of what is planned. */
static size_t plan_ground(const narc_contact_step *s, const pair_view *v, size_t first, size_t end, size_t to) {
    narc_pair_work *const work = s->contacts->work;
    const uint32_t a = v->a[work[first].pair];
    const bool follows = s->step->recycling > 0 && do_all_follow(s, first, end), rests = is_at_rest(s, a);
    unsigned all = OF_HELD | OF_BARE;
    for (size_t i = first; i < end; i++)
        all &= work[i].what;
    bool apart = all == OF_BARE; /* one that touches is better asked */
    for (size_t i = first; i < end && apart && !follows; i++)
        apart = are_apart(v, a, v->b[work[i].pair]);
    const unsigned planned = follows ? NARC_FOLLOW : apart ? NARC_APART : NARC_ASK_GROUND;
    for (size_t i = first; i < end; i++) {
        const narc_pair_work one = work[i];
        const unsigned what = rests && is_at_rest(s, v->b[one.pair]) ? NARC_REST : planned;
        work[to] = (narc_pair_work){one.pair, one.slot, what};
        to += what != NARC_ASK_GROUND || (one.what & (OF_HELD | OF_BARE)) != (OF_HELD | OF_BARE);
    }
    return to;
}

static void plan_all_ground(const narc_contact_step *s, const pair_view *v) {
    narc_contacts *const c = s->contacts;
    const size_t kept_count = c->ground_count, moved_count = narc_find_moved(s, kept_count);
    size_t moved = 0, at = 0, to = 0;
    for (size_t i = 0; i < kept_count; i++) {
        if (moved < moved_count && c->left[moved] == c->ground_asked[i]) {
            moved++;
            continue;
        }
        while (c->work[at].pair != c->ground_asked[i])
            at++;
        c->work[at].what |= OF_HELD;
    }
    for (size_t i = 0, end; i < c->work_count; i = end) {
        for (end = i + 1; end < c->work_count && !(c->work[end].what & OF_FIRST);)
            end++;
        to = plan_ground(s, v, i, end, to);
    }
    c->work_count = to;
}

/* The first slot from `k` on with a body that has changed. Four at a time, as most of them have none. */
static size_t find_changed(const pair_view *v, size_t k, size_t count) {
    const uint32_t *const a = v->a, *const b = v->b;
    const uint8_t *const changed = v->changed;
    while (count - k >= 4 && !(changed[a[k]] | changed[b[k]] | changed[a[k + 1]] | changed[b[k + 1]] |
                               changed[a[k + 2]] | changed[b[k + 2]] | changed[a[k + 3]] | changed[b[k + 3]]))
        k += 4;
    while (k < count && !(changed[a[k]] | changed[b[k]]))
        k++;
    return k;
}

/* Are all pairs those of the last step, asked in the same way, with the same kinds, so that only moves count? */
static bool is_list_kept(const narc_contact_step *s) {
    return s->list->kept && !s->contacts->broad->marked && !s->contacts->again;
}

/* The first body from `k` on that has changed in one of these ways, or `count`. Many at a time, as most have not. */
static size_t find_body(const uint8_t *changed, unsigned how, size_t k, size_t count) {
    enum { MANY = 64 };
    for (; count - k >= MANY; k += MANY) {
        uint8_t any = 0; /* in bytes, so that vectors hold most of them */
        for (size_t i = 0; i < MANY; i++)
            any = (uint8_t)(any | changed[k + i]);
        if (any & how)
            break;
    }
    while (k < count && !(changed[k] & how))
        k++;
    return k;
}

/* Where a pair has parted, rows of the same body may have been merged with its row. */
static void note_lost_ground(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    for (size_t i = 0; i < s->list->lost_count; i++) {
        const size_t at = s->list->lost[i].pair;
        const uint32_t a = c->a[c->order[at]];
        for (size_t k = at; k > 0 && c->a[c->order[k - 1]] == a; k--)
            c->flags[c->order[k - 1]] |= NARC_SLOT_STALE;
        for (size_t k = at + 1; k < c->result.count && c->a[c->order[k]] == a; k++)
            c->flags[c->order[k]] |= NARC_SLOT_STALE;
    }
}

void narc_plan_ground(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    const pair_view v = view_pairs(s);
    const bool has_ground = NARC_PIECES && s->has_ground;
    const size_t count = s->list->pairs.count, bodies = s->step->bodies->count;
    c->work_count = c->ground_count = 0;
    c->changed = !is_list_kept(s) || find_body(v.changed, UINT8_MAX, 0, bodies) < bodies;
    for (size_t k = 0; c->changed && (k = c->again ? k : find_body(v.changed, NARC_RESHAPED, k, bodies)) < bodies;
         k++) {
        c->room[k] = find_room(s, (uint32_t)k);
        c->grounds[k] = find_ground(s, (uint32_t)k);
    }
    for (size_t slot = 0; slot < c->slot_count && c->again; slot++)
        c->flags[slot] |= NARC_SLOT_STALE;
    if (has_ground && !s->list->kept)
        note_lost_ground(s);
    for (size_t k = 0; k < count && has_ground && c->changed;)
        k = list_ground(s, &v, k, count);
    if (NARC_PIECES)
        plan_all_ground(s, &v);
}

/* ------------------------------------------------------------------------------------------------ slots */

void narc_clear_row(narc_contacts *c, uint32_t slot) {
    c->flags[slot] &= (uint8_t)~NARC_SLOT_KEPT;
    if (narc_count_points(c->contact_rows, narc_slot_row(c, slot)) > 0 || c->more_of[slot].count > 0) {
        narc_mark_slot(c, slot, NARC_ASKED);
        narc_zero_row(c, slot);
        c->more_of[slot].count = 0;
    }
    narc_set_touching(c, slot, false);
}

static void mark_slot(const narc_contact_step *s, size_t k) {
    const narc_contacts *const c = s->contacts;
    const uint32_t slot = c->order[k];
    c->marks[slot] =
        (uint8_t)(s->list->marks[k] | (is_at_rest(s, c->a[slot]) && is_at_rest(s, c->b[slot]) ? NARC_RESTS : 0u));
}

/* The marks of a new list in which pairs that were there are as they were: those of other slots. Bodies of new pairs are
 * marked, too. False: all marks may be others. */
static bool mark_new_slots(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    const narc_pair_list *const list = s->list;
    if (!c->marks_known || c->broad->has_other_kinds || c->again || s->has_ground)
        return false;
    for (size_t i = 0; i < c->parted_count; i++)
        c->marks[c->parted[i]] = NARC_GONE;
    for (size_t i = 0; i < list->added_count; i++) {
        mark_slot(s, list->added[i]);
        c->broad->known.changed[list->pairs.a.base[list->added[i]]] |= NARC_HAS_NEW;
    }
    return true;
}

/* The marks of slots, in their order; those that are no pair have bodies that are there. */
static void mark_slots(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    uint8_t *const marks = c->marks;
    memset(marks, NARC_GONE, c->slot_count);
    for (size_t k = 0; k < s->list->pairs.count; k++)
        mark_slot(s, k);
    for (size_t slot = 0; slot < c->slot_count; slot++)
        if (marks[slot] == NARC_GONE)
            c->a[slot] = c->b[slot] = 0;
    c->marks_known = true;
}

/* What is to be done with a slot whose bodies have changed, or are `stale`, and not both of which move, or which are no
 * plain bodies? */
NOINLINE unsigned find_special(const narc_contact_step *s, const pair_view *v, uint32_t slot, bool changed) {
    const unsigned marks = v->marks[slot];
    if (marks & NARC_GONE || !changed)
        return NARC_NOTHING;
    s->contacts->marks[slot] = (uint8_t)(marks & ~(unsigned)NARC_FLIPPED); /* but once */
    if (marks & NARC_RESTS && !(marks & NARC_FLIPPED))
        return NARC_REST; /* one that is turned has the other bodies' row */
    return marks & NARC_SENSOR ? NARC_ASK_SENSOR : NARC_ASK;
}

/* What is done with few slots, or in few scenes. */
NOINLINE void do_more(const narc_contact_step *s, uint32_t slot, unsigned what) {
    narc_contacts *const c = s->contacts;
    if (s->step->ahead.base && (what == NARC_ASK || what == NARC_FOLLOW))
        c->margins[slot] = narc_find_margin(s, c->a[slot], c->b[slot]);
    if (what == NARC_ASK)
        c->more_of[slot].count = 0; /* it may have been ground */
    if (what == NARC_APART && c->state[slot] & NARC_TOUCHING)
        narc_clear_row(c, slot);
    if (what == NARC_ASK_SENSOR)
        c->sensors_asked[c->sensor_count++] = slot;
}

/* Marks of slots that are no plain pair of two bodies that may move. */
enum { SPECIAL = NARC_RESTS | NARC_SENSOR | NARC_FLIPPED | NARC_GONE };

/* What of its flags a slot keeps. */
static const uint8_t stays[] = {[NARC_REST] = 0xff & ~(NARC_SLOT_STALE | NARC_SENSOR),
                                [NARC_FOLLOW] = 0xff & ~(NARC_SLOT_STALE | NARC_SENSOR),
                                [NARC_ASK] = 0xff & ~(NARC_SLOT_STALE | NARC_SENSOR | NARC_SLOT_KEPT),
                                [NARC_ASK_GROUND] = 0xff & ~(NARC_SLOT_STALE | NARC_SENSOR | NARC_SLOT_KEPT),
                                [NARC_NO_GROUND] = 0xff & ~(NARC_SLOT_STALE | NARC_SENSOR | NARC_SLOT_KEPT),
                                [NARC_ASK_SENSOR] = 0xff & ~(NARC_SLOT_STALE | NARC_SENSOR | NARC_SLOT_KEPT),
                                [NARC_APART] = 0xff & ~(NARC_SLOT_STALE | NARC_SENSOR | NARC_SLOT_KEPT)};

static inline unsigned find_flags(unsigned was, bool reshaped, unsigned marks, unsigned what) {
    return (was & (reshaped ? NARC_SLOT_CROSSED : stays[what])) | (marks & NARC_SENSOR) |
           (what == NARC_REST ? NARC_SLOT_STALE : 0);
}

/* The lists that slots are sorted into. */
typedef struct slot_lists {
    uint32_t *asked, *known, *candidates; /* behind the last of each */
} slot_lists;

/* Finds out what is to be done with a slot, the bodies of which have changed in the ways `found`. What differs from slot to
 * slot as chance has it is without a branch. */
INLINE void sort_slot(const narc_contact_step *s, const pair_view *v, size_t k, unsigned found, bool special, bool more,
                      uint8_t *all_flags, slot_lists *to) {
    const uint32_t slot = (uint32_t)k;
    const unsigned changed = found & NARC_ALL_CHANGED, was = all_flags[k], marks = v->marks[k];
    const unsigned stale = find_stale(was, marks);
    if (!(changed | stale))
        return;
    unsigned what = NARC_ASK;
    if (special && is_ground(v, k) && !(marks & NARC_GONE))
        return; /* it is planned */
    if (special || marks & SPECIAL)
        what = find_special(s, v, slot, changed | stale);
    const bool touches = v->state[k] & NARC_TOUCHING, reshaped = changed & NARC_RESHAPED;
    if (what == NARC_ASK) { /* one that touches is better asked */
        const unsigned follows = !stale & !reshaped & ((was & NARC_SLOT_KEPT) != 0);
        what = follows ? NARC_FOLLOW : !touches && are_apart(v, v->a[k], v->b[k]) ? NARC_APART : NARC_ASK;
    }
    if (what == NARC_NOTHING)
        return;
    const unsigned now = find_flags(was, reshaped, marks, what), asks = what == NARC_ASK;
    const unsigned entry = asks & (now / NARC_SLOT_ENTRY);
    all_flags[k] = (uint8_t)now;
    *to->asked = *to->known = *to->candidates = slot;
    to->asked += asks - entry;
    to->known += entry;
    to->candidates += what == NARC_FOLLOW;
    if (more || what == NARC_ASK_SENSOR || (what == NARC_APART) & touches)
        do_more(s, slot, what);
}

/* In a scene at rest so many slots are looked at at a time, byte by byte, many of which a vector holds. */
enum { CHUNK = 64 };

/* Of the slots first .. first + n - 1, lists those as candidates that are as most are at rest: something is kept of them, they
 * are as they were, and a body has moved. Puts the numbers of all others, less `first`, into `other`, and what has changed
 * of both bodies into `found`; returns how many these are. As sort_slot() has it, which differs in nothing but time. */
static size_t pass_followers(const pair_view *v, bool kept, size_t first, size_t n, uint8_t found[CHUNK],
                             uint8_t other[CHUNK], uint32_t **candidates) {
    const uint32_t *const a = v->a + first, *const b = v->b + first;
    const uint8_t *const changed = v->changed;
    uint8_t flags[CHUNK] = {0}, marks[CHUNK] = {0}, now[CHUNK] = {0}, odd[CHUNK];
    uint32_t *to = *candidates;
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        now[i] = changed[a[i]] | changed[b[i]];
    memcpy(flags, v->flags + first, n);
    memcpy(marks, v->marks + first, n);
    for (size_t i = 0; i < CHUNK; i++)
        odd[i] = ((flags[i] ^ NARC_SLOT_KEPT) & (NARC_SLOT_KEPT | NARC_SLOT_STALE | NARC_SENSOR)) |
                 (marks[i] & SPECIAL) | (now[i] & NARC_RESHAPED);
    for (size_t i = 0; i < n; i++) {
        const unsigned stirs = now[i] & NARC_ALL_CHANGED;
        *to = (uint32_t)(first + i);
        to += (odd[i] == 0) & (stirs != 0);
        other[count] = (uint8_t)i;
        count += (odd[i] != 0) & (!kept | (now[i] != 0));
    }
    memcpy(found, now, sizeof now);
    *candidates = to;
    return count;
}

/* Slots are gone through in their own order, in which all that is kept of them lies, and not in that of pairs. What the loop
 * uses lies in variables of its own, as whatever is written in bytes might be any of it. */
void narc_sort_pairs(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    const bool ground = s->has_ground, more = s->step->ahead.base || c->more.count > 0;
    const bool kept = (is_list_kept(s) && c->marks_known) || (!s->list->kept && mark_new_slots(s));
    c->lists_known = kept;
    if (!kept)
        mark_slots(s);
    pair_view view = view_pairs(s);
    view.a = c->a;
    view.b = c->b;
    view.marks = c->marks;
    const pair_view v = view;
    uint8_t *const flags = c->flags;
    slot_lists to = {c->asked, c->known, c->candidates};
    const size_t count = c->changed && s->list->pairs.count > 0 ? c->slot_count : 0;
    const bool rests = !ground && !more && c->candidate_count > count / 4; /* as in the last step */
    c->sensor_count = 0;
    for (size_t first = 0; first < count && rests; first += CHUNK) {
        uint8_t found[CHUNK], other[CHUNK];
        const size_t n = count - first < CHUNK ? count - first : CHUNK;
        const size_t others = pass_followers(&v, kept, first, n, found, other, &to.candidates);
        for (size_t i = 0; i < others; i++)
            sort_slot(s, &v, first + other[i], found[other[i]], ground, more, flags, &to);
    }
    for (size_t k = 0; k < count && !rests; k++) {
        const unsigned found = v.changed[v.a[k]] | v.changed[v.b[k]];
        if (kept && !found)
            k = find_changed(&v, k, count) - 1;
        else
            sort_slot(s, &v, k, found, ground, more, flags, &to);
    }
    for (size_t i = 0; i < c->work_count; i++) {
        const uint32_t slot = c->work[i].slot = c->order[c->work[i].pair], what = c->work[i].what;
        const bool reshaped = (v.changed[v.a[slot]] | v.changed[v.b[slot]]) & NARC_RESHAPED;
        flags[slot] = (uint8_t)find_flags(flags[slot], reshaped, 0, what);
        *to.candidates = slot;
        to.candidates += what == NARC_FOLLOW && c->state[slot] & NARC_TOUCHING;
        if (s->step->ahead.base || what == NARC_APART)
            do_more(s, slot, what);
    }
    c->asked_count = (size_t)(to.asked - c->asked);
    c->known_count = (size_t)(to.known - c->known);
    c->candidate_count = (size_t)(to.candidates - c->candidates);
}
