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

/* Must a pair be asked, whatever has moved: is it new, a sensor's for the first time, or was it at rest while something
 * changed? One that is marked as at rest stays so. One that is turned has bodies with other numbers, which have changed. */
static inline unsigned find_stale(unsigned flags, unsigned marks) {
    return (flags & NARC_SLOT_STALE & ~(marks / NARC_RESTS)) | ((flags ^ marks) & NARC_SENSOR);
}

static inline bool is_ground(const pair_view *v, size_t k) {
    return !(v->marks[k] & NARC_SENSOR) & ((v->grounds[v->b[k]] | (v->grounds[v->a[k]] & NARC_IS_PIECE)) != 0);
}

/* Was a pair ground that is none, or no sensor's? */
static inline bool was_ground(const pair_view *v, size_t k) {
    const uint32_t slot = slot_of(v, k);
    return slot != UINT32_MAX && (v->changed[v->b[k]] & NARC_RESHAPED || (v->marks[k] ^ v->flags[slot]) & NARC_SENSOR);
}

/* What is known of a pair with ground while it is planned. FIRST: it is the first one of its body; RESTS: neither body moves.
 * OLD: it must be asked, whatever has moved; OTHER: so must all ground of the body, as a pair was ground, or is no sensor's
 * any more. HELD: its bodies have not moved too far for what is kept of it. What all pairs of the body are lies in the bits
 * from OF_BODY on of its first one. */
enum {
    OF_FIRST = 1,
    OF_RESTS = 2,
    OF_OTHER = 4,
    OF_CHANGED = 8,
    OF_OLD = 16,
    OF_MOVING = 32,
    OF_KEPT = 64,
    OF_BARE = 128,
    OF_HELD = 256,
    OF_TOUCHING = 512,
    OF_BODY = 1024
};

/* Of the body of pair k, was another pair ground that is none? */
static unsigned find_other(const pair_view *v, size_t k, size_t count) {
    const uint32_t a = v->a[k];
    while (k > 0 && v->a[k - 1] == a)
        k--;
    for (; k < count && v->a[k] == a; k++)
        if (!is_ground(v, k) && was_ground(v, k))
            return OF_OTHER | OF_CHANGED;
    return 0;
}

/* Lists all pairs of ground. */
static void list_ground(const narc_contact_step *s, const pair_view *v) {
    narc_contacts *const c = s->contacts;
    const size_t count = s->list->pairs.count;
    narc_pair_work *to = c->ground_pairs;
    for (size_t k = 0; k < count; k++) {
        if (!is_ground(v, k))
            continue;
        const unsigned first = to == c->ground_pairs || v->a[to[-1].pair] != v->a[k] ? OF_FIRST : 0;
        const unsigned rests = is_at_rest(s, v->a[k]) && is_at_rest(s, v->b[k]) ? OF_RESTS : 0;
        *to++ = (narc_pair_work){(uint32_t)k, slot_of(v, k), first | rests};
    }
    c->ground_pair_count = (size_t)(to - c->ground_pairs);
}

/* What is known of a pair, by what its bodies and its slot are: a number below LOOKS, from find_look(). */
enum { LOOK_TOUCHING = 2, LOOK_CHANGED = 16, LOOK_CHANGED_B = 64, LOOKS = 256 };
_Static_assert((NARC_SLOT_STALE | NARC_SLOT_SENSOR | NARC_SLOT_KEPT) == 13,
               "with LOOK_TOUCHING all below LOOK_CHANGED");

static void list_looks(uint32_t out[LOOKS]) {
    for (unsigned look = 0; look < LOOKS; look++) {
        const unsigned changed = look / LOOK_CHANGED & NARC_ALL_CHANGED;
        const bool old = look & (NARC_SLOT_STALE | NARC_SLOT_SENSOR) || changed & NARC_RESHAPED;
        out[look] = (changed || old ? OF_CHANGED : 0u) | (old ? OF_OLD : 0u) |
                    (look / LOOK_CHANGED_B ? OF_MOVING : 0u) | (look & NARC_SLOT_KEPT && !old ? OF_KEPT : 0u) |
                    (look & LOOK_TOUCHING ? OF_TOUCHING : OF_BARE);
    }
}

/* Here and below what differs from pair to pair as chance has it is without a branch. */
static inline unsigned find_look(const pair_view *v, const narc_pair_work *work) {
    const size_t k = work->pair;
    const unsigned changed_b = v->changed[v->b[k]] & NARC_ALL_CHANGED, changed_a = v->changed[v->a[k]];
    const unsigned changed = ((changed_a & NARC_ALL_CHANGED) | changed_b) * LOOK_CHANGED + changed_b * LOOK_CHANGED_B;
    if (work->slot == UINT32_MAX)
        return changed | NARC_SLOT_STALE;
    return changed | (v->flags[work->slot] & (NARC_SLOT_STALE | NARC_SLOT_SENSOR | NARC_SLOT_KEPT)) |
           (v->state[work->slot] & NARC_TOUCHING) * LOOK_TOUCHING;
}

/* Finds what all pairs of ground are, and lists in `ground_asked` those of which something is kept that may decide, of bodies of
 * which something has changed. Returns how many these are. */
NOINLINE size_t look_at_all_ground(const narc_contact_step *s, const pair_view *v, uint32_t *out, uint32_t keeps) {
    const narc_contacts *const c = s->contacts;
    const narc_pair_work *const pairs = c->ground_pairs;
    const size_t count = c->ground_pair_count;
    uint32_t *const known = c->known, *const asked = c->ground_asked;
    uint32_t looks[LOOKS];
    size_t kept = 0;
    list_looks(looks);
    for (size_t i = 0; i < count;) {
        const size_t first = i, before = kept;
        uint32_t all = c->ground_known ? 0 : find_other(v, pairs[i].pair, s->list->pairs.count);
        do {
            const narc_pair_work pair = pairs[i];
            const uint32_t own = pair.what | looks[find_look(v, &pair)];
            known[kept] = pair.slot;
            asked[kept] = pair.pair;
            kept += (own & keeps) == keeps;
            out[i] = own;
            all |= own;
        } while (++i < count && !(pairs[i].what & OF_FIRST));
        out[first] |= all * OF_BODY;
        kept = all & OF_CHANGED ? kept : before;
    }
    for (size_t i = 0; s->step->ahead.base && i < count; i++)
        c->ground_margins[pairs[i].pair] = narc_find_margin(s, v->a[pairs[i].pair], v->b[pairs[i].pair]);
    return kept;
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

/* Pairs of a body are asked together, as their rows are merged; but those that have none are not while what is kept of them
 * holds. All its rows with ground follow it, if there are some; rows tell of other ground only while none moves. */
static void plan_all_ground(const narc_contact_step *s, const pair_view *v) {
    narc_contacts *const c = s->contacts;
    const narc_pair_work *const pairs = c->ground_pairs;
    narc_pair_work *const work = c->work;
    uint32_t *const asked = c->ground_asked, *const what = c->asked; /* which is not in use yet */
    uint32_t *const left = c->left;                                  /* of `asked`, as it was, in its order */
    const bool recycles = s->step->recycling > 0;                    /* rows follow, or pairs without one stay so */
    const uint32_t keeps = recycles ? OF_KEPT : OF_KEPT | OF_BARE;
    const size_t kept_count = look_at_all_ground(s, v, what, keeps), moved_count = narc_find_moved(s, kept_count);
    const size_t count = c->ground_pair_count;
    size_t to = 0, asked_count = 0, moved = 0;
    left[moved_count] = UINT32_MAX; /* no pair */
    for (size_t first = 0, end = 0; first < count; first = end) {
        const uint32_t all = what[first] / OF_BODY, changed = (all & OF_CHANGED) != 0;
        const bool touches = all & OF_TOUCHING;
        bool all_held = true,
             follows = recycles && touches && !(all & (OF_OLD | OF_OTHER)) && !(all & OF_MOVING && all & OF_BARE);
        do {
            const uint32_t own = what[end], goes = left[moved] == pairs[end].pair;
            const uint32_t held = changed & ((own & keeps) == keeps) & ~goes;
            moved += goes;
            what[end] = own | held * OF_HELD;
            all_held &= held != 0;
            if (follows && own & OF_TOUCHING)
                follows = held && may_more_follow(s, &pairs[end]);
        } while (++end < count && !(what[end] & OF_FIRST));
        if (!changed)
            continue;
        bool apart = !touches && !all_held; /* one that touches is asked, which takes its row away */
        for (size_t i = first; apart && i < end; i++)
            apart = are_apart(v, v->a[pairs[i].pair], v->b[pairs[i].pair]);
        const unsigned planned = follows ? NARC_FOLLOW : apart ? NARC_APART : NARC_ASK_GROUND;
        for (size_t i = first; i < end; i++) {
            const unsigned own = what[i] & OF_RESTS ? NARC_REST : planned, asks = own == NARC_ASK_GROUND;
            const unsigned idle = asks & ((what[i] & (OF_HELD | OF_BARE)) == (OF_HELD | OF_BARE));
            work[to] = (narc_pair_work){pairs[i].pair, pairs[i].slot, own};
            asked[asked_count] = pairs[i].pair;
            to += 1 - idle;
            asked_count += asks - idle;
        }
    }
    c->work_count = to;
    c->ground_count = asked_count;
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
    const bool has_ground = NARC_PIECES && s->has_ground; /* known while it is compiled where there are none */
    const size_t bodies = s->step->bodies->count;
    c->work_count = c->ground_count = 0;
    c->changed = !is_list_kept(s) || find_body(v.changed, UINT8_MAX, 0, bodies) < bodies;
    if (c->ground_known && !has_ground) /* slots have marks of it */
        c->marks_known = false;
    c->ground_known = c->ground_known && has_ground && is_list_kept(s) && c->marks_known;
    for (size_t k = 0; c->changed && (k = c->again ? k : find_body(v.changed, NARC_RESHAPED, k, bodies)) < bodies;
         k++) {
        c->ground_known = false;
        c->room[k] = find_room(s, (uint32_t)k);
        c->grounds[k] = find_ground(s, (uint32_t)k);
    }
    for (size_t slot = 0; slot < c->slot_count && c->again; slot++)
        c->flags[slot] |= NARC_SLOT_STALE;
    if (has_ground && !s->list->kept)
        note_lost_ground(s);
    if (has_ground && !c->ground_known)
        list_ground(s, &v);
    if (has_ground && c->changed)
        plan_all_ground(s, &v);
}

/* ------------------------------------------------------------------------------------------------ slots */

static void mark_slot(const narc_contact_step *s, size_t k) {
    const narc_contacts *const c = s->contacts;
    const uint32_t slot = c->order[k];
    c->marks[slot] = (uint8_t)((s->list->marks[k] & NARC_KINDS) |
                               (is_at_rest(s, c->a[slot]) && is_at_rest(s, c->b[slot]) ? NARC_RESTS : 0u));
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
    for (size_t i = 0; s->has_ground && i < c->ground_pair_count; i++) {
        narc_pair_work *const pair = &c->ground_pairs[i];
        pair->slot = c->order[pair->pair];
        marks[pair->slot] |= NARC_WITH_GROUND;
    }
    c->marks_known = true;
    c->ground_known = s->has_ground;
}

/* What is to be done with a slot whose bodies have changed, or are `stale`, and not both of which move, or which are no
 * plain bodies? */
NOINLINE unsigned find_special(const pair_view *v, uint32_t slot, bool changed) {
    const unsigned marks = v->marks[slot];
    if (marks & NARC_GONE || !changed)
        return NARC_NOTHING;
    if (marks & NARC_RESTS && !(v->state[slot] & NARC_TURNED))
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
    if (what == NARC_ASK_SENSOR)
        c->sensors_asked[c->sensor_count++] = slot;
}

/* Marks of slots that are no plain pair of two bodies that may move. */
enum { SPECIAL = NARC_RESTS | NARC_SENSOR | NARC_GONE | NARC_WITH_GROUND };

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
INLINE void sort_slot(const narc_contact_step *s, const pair_view *v, size_t k, unsigned found, bool more,
                      uint8_t *all_flags, slot_lists *to) {
    const uint32_t slot = (uint32_t)k;
    const unsigned changed = found & NARC_ALL_CHANGED, was = all_flags[k], marks = v->marks[k];
    const unsigned stale = find_stale(was, marks);
    if (!(changed | stale) || marks & NARC_WITH_GROUND) /* that is planned */
        return;
    unsigned what = NARC_ASK;
    if (marks & SPECIAL)
        what = find_special(v, slot, changed | stale);
    const bool touches = v->state[k] & NARC_TOUCHING, reshaped = changed & NARC_RESHAPED;
    if (what == NARC_ASK) { /* one that touches is asked, which takes its row away */
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
    if (more || what == NARC_ASK_SENSOR)
        do_more(s, slot, what);
}

/* In a scene at rest so many slots are looked at at a time, byte by byte, many of which a vector holds. */
enum { CHUNK = 64 };

/* Of the slots first .. first + n - 1, lists those that are as most are at rest, as they were, while a body has moved: as
 * candidates if something is kept of them, as known if they touch and have an entry. Puts the numbers of all others but those
 * of ground, less `first`, into `other`, and what has changed of both bodies into `found`; returns how many these are. As
 * sort_slot() has it, which differs in nothing but time. */
static size_t pass_usual(const pair_view *v, bool kept, size_t first, size_t n, uint8_t found[CHUNK],
                         uint8_t other[CHUNK], slot_lists *lists) {
    enum { DECIDES = NARC_SLOT_KEPT | NARC_SLOT_ENTRY | NARC_SLOT_STALE | NARC_SENSOR };
    const uint32_t *const a = v->a + first, *const b = v->b + first;
    const uint8_t *const changed = v->changed;
    uint8_t flags[CHUNK] = {0}, marks[CHUNK] = {0}, state[CHUNK] = {0}, now[CHUNK] = {0};
    uint8_t follows[CHUNK], known[CHUNK], passed[CHUNK];
    slot_lists to = *lists;
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        now[i] = changed[a[i]] | changed[b[i]];
    memcpy(flags, v->flags + first, n);
    memcpy(marks, v->marks + first, n);
    memcpy(state, v->state + first, n);
    for (size_t i = 0; i < CHUNK; i++) {
        const uint8_t plain = ((marks[i] & SPECIAL) | (now[i] & NARC_RESHAPED)) == 0, decides = flags[i] & DECIDES;
        const uint8_t keeps = plain & (decides == NARC_SLOT_KEPT), moved = (now[i] & NARC_ALL_CHANGED) != 0;
        const uint8_t answers = plain & (decides == NARC_SLOT_ENTRY) & (state[i] & NARC_TOUCHING);
        follows[i] = keeps & moved;
        known[i] = answers & moved;
        passed[i] = keeps | answers | (kept & (now[i] == 0)) | ((marks[i] & NARC_WITH_GROUND) != 0);
    }
    for (size_t i = 0; i < n; i++) {
        *to.candidates = *to.known = (uint32_t)(first + i);
        to.candidates += follows[i];
        to.known += known[i];
        other[count] = (uint8_t)i;
        count += 1u - passed[i];
    }
    memcpy(found, now, sizeof now);
    *lists = to;
    return count;
}

/* Slots are gone through in their own order, in which all that is kept of them lies, and not in that of pairs. What the loop
 * uses lies in variables of its own, as whatever is written in bytes might be any of it. */
void narc_sort_pairs(const narc_contact_step *s) {
    narc_contacts *const c = s->contacts;
    const bool more = s->step->ahead.base || c->more.count > 0;
    const bool known = c->marks_known && (c->ground_known || !s->has_ground);
    const bool kept = (is_list_kept(s) && known) || (!s->list->kept && mark_new_slots(s));
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
    /* As in the last step; where ground lies between other slots, these are picked out. */
    const bool rests = !s->step->ahead.base && (s->has_ground || c->candidate_count + c->known_count > count / 4);
    c->sensor_count = 0;
    for (size_t first = 0; first < count && rests; first += CHUNK) {
        uint8_t found[CHUNK], other[CHUNK];
        const size_t n = count - first < CHUNK ? count - first : CHUNK;
        const size_t others = pass_usual(&v, kept, first, n, found, other, &to);
        for (size_t i = 0; i < others; i++)
            sort_slot(s, &v, first + other[i], found[other[i]], more, flags, &to);
    }
    for (size_t k = 0; k < count && !rests; k++) {
        const unsigned found = v.changed[v.a[k]] | v.changed[v.b[k]];
        if (kept && !found)
            k = find_changed(&v, k, count) - 1;
        else
            sort_slot(s, &v, k, found, more, flags, &to);
    }
    for (size_t i = 0; i < c->work_count; i++) {
        const uint32_t slot = c->work[i].slot = c->order[c->work[i].pair], what = c->work[i].what;
        const bool reshaped = (v.changed[v.a[slot]] | v.changed[v.b[slot]]) & NARC_RESHAPED;
        flags[slot] = (uint8_t)find_flags(flags[slot], reshaped, 0, what);
        *to.candidates = slot;
        to.candidates += what == NARC_FOLLOW && c->state[slot] & NARC_TOUCHING;
        if (s->step->ahead.base)
            do_more(s, slot, what);
    }
    c->asked_count = (size_t)(to.asked - c->asked);
    c->known_count = (size_t)(to.known - c->known);
    c->candidate_count = (size_t)(to.candidates - c->candidates);
}
