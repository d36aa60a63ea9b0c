/* SPDX-License-Identifier: MIT
 *
 * save.c - contacts as bytes, and back: a start (struct start), and behind it every array that a step leaves to the next, as
 * it lies in memory, filled up with zeros to a multiple of 8 bytes.
 *
 * Loading checks all that a later step takes for granted where it reads or writes by what it finds. What is not checked,
 * such as a separation, can only be wrong.
 */
#include "broad_phase/steps.h"
#include "contacts.h"
#include "dispatch.h"
#include "error.h"

#include <string.h>

/* VERSION is another one whenever what is saved is. */
enum { VERSION = 3, BYTE_ORDER_MARK = 0x01020304, BROAD_ARRAYS = 16, SAVED_ARRAYS = NARC_ARRAYS + BROAD_ARRAYS };

static const char magic[8] = "NARCCNTS";

/* Everything but arrays. */
typedef struct start {
    char magic[8];
    uint32_t version, byte_order;
    uint64_t size, checksum; /* all bytes; the sum counts all but itself */
    uint64_t rows, user_size, row_offset;
    uint64_t slots, free, parted, pairs, touching, sensors, began, ended, more, bodies, known;
    uint64_t skipped, asked, history;
    narc_asked last;
    narc_point origin;
    float known_margin, known_skin;
    uint32_t wait, waits, precision;
    uint8_t has_ids, has_gone, is_current, is_given, has_filter, has_sets, is_marked, has_motions, has_boxes,
        unused[11];
} start;

_Static_assert(sizeof(start) % 8 == 0 && sizeof(start) == offsetof(start, unused) + 11 && sizeof(narc_asked) == 24,
               "no padding, and arrays begin at a multiple of 8");

/* Bytes of contacts: those of `contacts`, a copy that knows all counts. */
typedef struct saved {
    narc_contacts contacts;
    narc_broad_phase broad;
    narc_array arrays[SAVED_ARRAYS];
    size_t offset[SAVED_ARRAYS], size[SAVED_ARRAYS], total;
    const char *bytes;
} saved;

/* ------------------------------------------------------------------------------------------------ what is saved */

/* Of the broad phase it is the list number `list`; of boxes and poses nothing if they are not those of the list. */
static void list_saved(narc_contacts *c, int list, narc_array out[SAVED_ARRAYS]) {
    narc_broad_phase *const b = c->broad;
    narc_kept_list *const l = &b->lists[list];
    narc_known_poses *const known = &b->known;
    const size_t ids = l->has_ids, current = b->is_current, filter = current * b->has_filter;
    const size_t slack = known->has_boxes && narc_find_slack(known->skin, known->has_motions) > 0;
    const size_t count = narc_list_arrays(c, out);
#define ARRAY(pointer, size, count)                                                                                    \
    { NARC_OF_BODIES, (void **)(void *)&(pointer), size, count }
    const narc_array arrays[BROAD_ARRAYS] = {
        ARRAY(l->a, sizeof *l->a, &c->result.count),
        ARRAY(l->b, sizeof *l->b, &c->result.count),
        ARRAY(l->marks, 1, &c->result.count),
        ARRAY(l->ids, ids * sizeof *l->ids, &l->body_count),
        ARRAY(l->gone, ids, &l->body_count),
        ARRAY(b->kept_boxes, current * sizeof *b->kept_boxes, &l->body_count),
        ARRAY(b->filters, filter * sizeof *b->filters, &l->body_count),
        ARRAY(b->kinds, filter, &l->body_count),
        ARRAY(b->boxes_now, known->has_boxes * sizeof *b->boxes_now, &known->count),
        ARRAY(known->poses, sizeof *known->poses, &known->count),
        ARRAY(known->motions, known->has_motions * sizeof *known->motions, &known->count),
        ARRAY(known->slack, slack * sizeof *known->slack, &known->count),
        ARRAY(known->moved, 1, &known->count),
        ARRAY(known->changed, 1, &known->count),
        ARRAY(c->room, sizeof *c->room, &known->count),
        ARRAY(c->grounds, 1, &known->count)};
#undef ARRAY
    memcpy(out + count, arrays, sizeof arrays);
}

/* Lays out the bytes. False if there would be too many. */
static bool lay_out(saved *s) {
    s->total = sizeof(start);
    list_saved(&s->contacts, s->broad.last, s->arrays);
    for (size_t k = 0; k < SAVED_ARRAYS; k++) {
        const size_t count = s->arrays[k].count ? *s->arrays[k].count : 0, size = s->arrays[k].size;
        if (size > 0 && count > (SIZE_MAX - 8 - s->total) / size)
            return false;
        s->offset[k] = s->total;
        s->size[k] = count * size;
        s->total += (s->size[k] + 7) / 8 * 8;
    }
    return true;
}

/* A copy that saves contacts as they are. */
static void copy(const narc_contacts *c, saved *out) {
    out->contacts = *c;
    out->broad = *c->broad;
    out->contacts.broad = &out->broad;
    if (!out->broad.is_current)
        out->broad.known.count = 0;
    lay_out(out); /* memory has so many bytes: there are not too many */
}

static start describe(const saved *s) {
    const narc_contacts *const c = &s->contacts;
    const narc_broad_phase *const b = &s->broad;
    const narc_kept_list *const l = &b->lists[b->last];
    const narc_step_result *const r = &c->result;
    start at = {.version = VERSION,
                .byte_order = BYTE_ORDER_MARK,
                .size = s->total,
                .rows = (c->contact_rows ? NARC_CONTACT_ROWS : 0u) | (c->rows_in_user ? NARC_ROWS_IN_USER : 0u),
                .user_size = c->user_size,
                .row_offset = c->row_offset,
                .slots = c->slot_count,
                .free = c->free_count,
                .parted = c->parted_count,
                .pairs = r->count,
                .touching = r->touching_count,
                .sensors = r->sensor_count,
                .began = r->began_count,
                .ended = r->ended_count,
                .more = c->more.count,
                .bodies = l->body_count,
                .known = b->known.count,
                .skipped = r->skipped,
                .asked = r->asked_count,
                .history = b->known.history,
                .last = c->last,
                .origin = b->origin,
                .known_margin = b->known.margin,
                .known_skin = b->known.skin,
                .wait = c->wait,
                .waits = c->waits,
                .precision = (uint32_t)b->known.precision,
                .has_ids = l->has_ids,
                .has_gone = l->has_gone,
                .is_current = b->is_current,
                .is_given = b->is_given,
                .has_filter = b->has_filter,
                .has_sets = b->has_sets,
                .is_marked = c->marked,
                .has_motions = b->known.has_motions,
                .has_boxes = b->known.has_boxes};
    memcpy(at.magic, magic, sizeof magic);
    return at;
}

/* The other way: everything but the arrays, with the list number `list`. */
static void take_over(narc_contacts *c, int list, const start *at) {
    narc_broad_phase *const b = c->broad;
    narc_kept_list *const l = &b->lists[list];
    narc_step_result *const r = &c->result;
    b->last = list;
    c->slot_count = (size_t)at->slots;
    c->free_count = (size_t)at->free;
    c->parted_count = (size_t)at->parted;
    r->count = (size_t)at->pairs;
    r->touching_count = (size_t)at->touching;
    r->sensor_count = (size_t)at->sensors;
    r->began_count = (size_t)at->began;
    r->ended_count = (size_t)at->ended;
    r->more_count = c->more.count = (size_t)at->more;
    l->body_count = (size_t)at->bodies;
    b->known.count = (size_t)at->known;
    r->skipped = (size_t)at->skipped;
    r->asked_count = (size_t)at->asked;
    b->known.history = at->history;
    c->last = at->last;
    b->origin = at->origin;
    b->known.margin = at->known_margin;
    b->known.skin = at->known_skin;
    c->wait = at->wait;
    c->waits = at->waits;
    b->known.precision = (narc_precision)at->precision;
    l->has_ids = at->has_ids;
    l->has_gone = at->has_gone;
    b->is_current = at->is_current;
    b->is_given = at->is_given;
    b->has_filter = at->has_filter;
    b->has_sets = at->has_sets;
    c->marked = at->is_marked;
    b->known.has_motions = at->has_motions;
    b->known.has_boxes = at->has_boxes;
    b->is_sorted = false;
    b->renewed = true; /* `previous` is not saved */
    c->crossed_count = 0;
    c->marks_known = false;
    c->partners_listed = false;
}

/* Of all words of 8 bytes but the one at `checksum`. A change of any bit changes about half of the sum's. */
static uint64_t sum_up(const char *bytes, size_t size) {
    uint64_t sum = size;
    for (size_t at = 0; at < size; at += sizeof(uint64_t)) {
        uint64_t word;
        memcpy(&word, bytes + at, sizeof word);
        if (at == offsetof(start, checksum))
            continue;
        sum = (sum ^ word) * 0xff51afd7ed558ccdu;
        sum ^= sum >> 32;
    }
    return sum;
}

size_t narc_count_contact_bytes(const narc_contacts *contacts) {
    saved s;
    if (!contacts)
        return 0;
    copy(contacts, &s);
    return s.total;
}

narc_status narc_save_contacts(const narc_contacts *contacts, void *out_bytes, size_t size, narc_error *error) {
    saved s;
    if (!contacts || !out_bytes)
        return narc_fail_missing(error, contacts ? "out_bytes" : "contacts");
    copy(contacts, &s);
    if (size < s.total)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)s.total, "%zu bytes, but there is room for %zu",
                         s.total, size);
    start at = describe(&s);
    char *const bytes = out_bytes;
    memset(bytes, 0, s.total);
    memcpy(bytes, &at, sizeof at);
    for (size_t k = 0; k < SAVED_ARRAYS; k++)
        if (s.size[k] > 0)
            memcpy(bytes + s.offset[k], *s.arrays[k].memory, s.size[k]);
    at.checksum = sum_up(bytes, s.total);
    memcpy(bytes + offsetof(start, checksum), &at.checksum, sizeof at.checksum);
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ checks */

static const char *bytes_of(const saved *s, const void *memory) {
    size_t k = 0;
    while ((const void *)s->arrays[k].memory != memory)
        k++;
    return s->bytes + s->offset[k];
}

static uint32_t word_at(const char *bytes, size_t k) {
    uint32_t word;
    memcpy(&word, bytes + k * sizeof word, sizeof word);
    return word;
}

static bool are_below(const char *words, size_t count, size_t limit) {
    bool fine = true;
    for (size_t k = 0; k < count; k++)
        fine &= word_at(words, k) < limit;
    return fine;
}

static bool are_bits(const char *bytes, size_t count, unsigned mask) {
    unsigned any = 0;
    for (size_t k = 0; k < count; k++)
        any |= (unsigned char)bytes[k];
    return !(any & ~mask);
}

/* Each slot is that of a pair, or free, or its pair has just parted. `used`: zeros for all slots. */
static bool uses_each_once(const saved *s, const char *slots, size_t count, uint8_t *used) {
    for (size_t k = 0; k < count; k++) {
        const uint32_t slot = word_at(slots, k);
        if (slot >= s->contacts.slot_count || used[slot]++)
            return false;
    }
    return true;
}

/* Slots without a pair have none. */
static bool have_no_pairs(const saved *s, const char *slots, size_t count) {
    const char *const a = bytes_of(s, &s->contacts.a), *const b = bytes_of(s, &s->contacts.b);
    bool fine = true;
    for (size_t k = 0; k < count; k++)
        fine &= (word_at(a, word_at(slots, k)) | word_at(b, word_at(slots, k))) == 0;
    return fine;
}

/* Pairs in their order, of bodies that there are; slots that know them; further rows one behind the other. */
static bool are_pairs_fine(const saved *s) {
    const narc_contacts *const c = &s->contacts;
    const narc_kept_list *const l = &s->broad.lists[s->broad.last];
    const char *const a = bytes_of(s, &l->a), *const b = bytes_of(s, &l->b), *const order = bytes_of(s, &c->order);
    const char *const slot_a = bytes_of(s, &c->a), *const slot_b = bytes_of(s, &c->b);
    const char *const more_of = bytes_of(s, &c->more_of);
    uint64_t last = 0, more = 0;
    for (size_t k = 0; k < c->result.count; k++) {
        const uint32_t one = word_at(a, k), other = word_at(b, k), slot = word_at(order, k);
        const uint64_t pair = narc_join_pair(one, other), first = word_at(more_of, 2 * (size_t)slot);
        const uint64_t count = word_at(more_of, 2 * (size_t)slot + 1);
        if (one >= other || other >= l->body_count || (k > 0 && pair <= last) || word_at(slot_a, slot) != one ||
            word_at(slot_b, slot) != other || (count > 0 && first < more))
            return false;
        last = pair;
        more = count > 0 ? first + count : more;
    }
    return more <= c->more.count;
}

/* No row has more points than there is room for. */
static bool are_rows_fine(const saved *s, const char *rows, size_t stride, size_t count) {
    const narc_contacts *const c = &s->contacts;
    for (size_t k = 0; k < count; k++) {
        narc_contact contact;
        narc_manifold manifold;
        memcpy(c->contact_rows ? (void *)&contact : &manifold, rows + k * stride, c->row_size);
        if (c->contact_rows ? contact.count > 1 : manifold.count > 2)
            return false;
    }
    return true;
}

static bool are_events_fine(const saved *s, const char *events, size_t count) {
    for (size_t k = 0; k < count; k++)
        if (word_at(events + k * sizeof(narc_touch_event), 0) >= s->contacts.slot_count)
            return false;
    return true;
}

/* What is wrong; NULL: nothing. */
static const char *find_fault(const saved *s, uint8_t *used) {
    const narc_contacts *const c = &s->contacts;
    const narc_kept_list *const l = &s->broad.lists[s->broad.last];
    const size_t slots = c->slot_count;
    const unsigned kinds = s->broad.is_current && !s->broad.has_filter ? 0 : NARC_KINDS;
    const char *const rows = c->rows_in_user ? bytes_of(s, &c->user) + c->row_offset : bytes_of(s, &c->own_rows);
    if (!uses_each_once(s, bytes_of(s, &c->order), c->result.count, used) ||
        !uses_each_once(s, bytes_of(s, &c->free), c->free_count, used) ||
        !uses_each_once(s, bytes_of(s, &c->parted), c->parted_count, used))
        return "slots";
    if (!are_pairs_fine(s) || !have_no_pairs(s, bytes_of(s, &c->free), c->free_count) ||
        !have_no_pairs(s, bytes_of(s, &c->parted), c->parted_count))
        return "pairs";
    if (!are_rows_fine(s, rows, c->row_stride, slots) ||
        !are_rows_fine(s, bytes_of(s, &c->more.rows), c->row_size, c->more.count))
        return "rows";
    if (!are_bits(bytes_of(s, &c->state), slots, 31) ||
        !are_bits(bytes_of(s, &c->flags), slots, 127 & ~NARC_SLOT_CROSSED) ||
        !are_bits(bytes_of(s, &l->marks), c->result.count, kinds | NARC_FLIPPED))
        return "flags";
    if (!are_below(bytes_of(s, &c->touching), c->result.touching_count, slots) ||
        !are_below(bytes_of(s, &c->sensors), c->result.sensor_count, slots) ||
        !are_events_fine(s, bytes_of(s, &c->events), c->result.began_count + c->result.ended_count))
        return "lists";
    return NULL;
}

/* Are counts such that the arrays could be? */
static bool are_counts_fine(const start *at) {
    const uint64_t most = UINT32_MAX - 1;
    return at->slots <= most && at->pairs <= most && at->bodies <= most && at->more <= most &&
           at->free + at->parted + at->pairs == at->slots && at->touching <= at->pairs && at->sensors <= at->pairs &&
           at->began <= at->slots && at->ended <= at->slots - at->began &&
           at->known == (at->is_current ? at->bodies : 0) && at->precision <= NARC_FLOAT64;
}

static bool are_flags_fine(const start *at) {
    return are_bits((const char *)&at->has_ids, offsetof(start, unused) - offsetof(start, has_ids), 1);
}

static narc_status fail_format(narc_error *error, const char *what) {
    return narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "not contacts that were saved: %s", what);
}

static narc_status check_start(const narc_contacts *c, const char *bytes, size_t size, start *at, narc_error *error) {
    if (size >= sizeof *at)
        memcpy(at, bytes, sizeof *at);
    if (size < sizeof *at || memcmp(at->magic, magic, sizeof magic) != 0)
        return fail_format(error, "they begin otherwise");
    if (at->version != VERSION || at->byte_order != BYTE_ORDER_MARK)
        return fail_format(error, "another version of the library saved them, or another kind of machine");
    if (at->size != size || size % 8 != 0 || at->checksum != sum_up(bytes, size))
        return fail_format(error, "some are missing, or are not as they were saved");
    const start own = describe(&(saved){.contacts = *c, .broad = *c->broad});
    if (at->rows != own.rows || at->user_size != own.user_size || at->row_offset != own.row_offset)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)at->user_size,
                         "contacts were saved that have other settings: rows %lu, user_size %llu, row_offset %llu",
                         (unsigned long)at->rows, (unsigned long long)at->user_size,
                         (unsigned long long)at->row_offset);
    return are_counts_fine(at) && are_flags_fine(at) ? NARC_OK : fail_format(error, "counts");
}

static narc_status check_bytes(const narc_contacts *c, const start *at, const char *bytes, saved *out,
                               narc_error *error) {
    *out = (saved){.contacts = *c, .broad = *c->broad, .bytes = bytes};
    out->contacts.broad = &out->broad;
    take_over(&out->contacts, out->broad.last, at);
    if (!lay_out(out) || out->total != at->size)
        return fail_format(error, "sizes");
    uint8_t *const used = c->allocator.allocate((size_t)at->slots + 1, c->allocator.context);
    if (!used)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)at->slots, "not enough memory for %zu contacts",
                         (size_t)at->slots);
    memset(used, 0, (size_t)at->slots + 1);
    const char *const fault = find_fault(out, used);
    c->allocator.release(used, c->allocator.context);
    return fault ? fail_format(error, fault) : NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ loading */

/* Room for all; until the last of them succeeds nothing is lost. */
static narc_status reserve(narc_contacts *c, const start *at) {
    narc_kept_list *const next = &c->broad->lists[1 - c->broad->last];
    narc_status status = narc_reserve_arrays(c, NARC_OF_SLOTS, &c->slot_capacity, (size_t)at->slots + 1);
    if (status == NARC_OK)
        status = narc_reserve_arrays(c, NARC_OF_PAIRS, &c->order_capacity, (size_t)at->pairs);
    if (status == NARC_OK)
        status = narc_reserve_arrays(c, NARC_OF_BODIES, &c->body_capacity, (size_t)at->bodies);
    if (status == NARC_OK)
        status = narc_reserve_arrays(c, NARC_OF_FILTERED_PAIRS, &c->filtered_capacity, (size_t)at->sensors);
    if (status == NARC_OK)
        status = narc_reserve_arrays(c, NARC_OF_EVENTS, &c->event_capacity, (size_t)(at->began + at->ended));
    if (status == NARC_OK)
        status = narc_reserve_arrays(c, NARC_OF_MORE, &c->more.capacity, (size_t)at->more);
    narc_show_arrays(c);
    if (status == NARC_OK)
        status = narc_reserve_pairs(c->broad, next, (size_t)at->pairs);
    if (status == NARC_OK && at->has_ids)
        status = narc_reserve_ids(c->broad, next, (size_t)at->bodies);
    return status == NARC_OK ? narc_reserve_bodies(c->broad, (size_t)at->bodies) : status;
}

narc_status narc_load_contacts(narc_contacts *c, const narc_shapes *shapes, const void *bytes, size_t size,
                               const narc_step_result **out_result, narc_error *error) {
    saved from, to;
    start at;
    if (!c || !shapes || !bytes)
        return narc_fail_missing(error, !c ? "contacts" : !shapes ? "shapes" : "bytes");
    narc_status status = check_start(c, bytes, size, &at, error);
    if (status == NARC_OK)
        status = check_bytes(c, &at, bytes, &from, error);
    if (status != NARC_OK)
        return status;
    if (reserve(c, &at) != NARC_OK)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)at.pairs, "not enough memory for %zu contacts",
                         (size_t)at.pairs);
    narc_kept_list *const list = &c->broad->lists[1 - c->broad->last];
    take_over(c, 1 - c->broad->last, &at);
    list->list =
        (narc_pair_list){.pairs = {.count = c->result.count, .a = NARC_ARRAY(list->a), .b = NARC_ARRAY(list->b)},
                         .previous = list->previous,
                         .marks = list->marks,
                         .added = list->added,
                         .skipped = c->result.skipped};
    list_saved(c, c->broad->last, to.arrays);
    for (size_t k = 0; k < SAVED_ARRAYS; k++)
        if (from.size[k] > 0)
            memcpy(*to.arrays[k].memory, from.bytes + from.offset[k], from.size[k]);
    c->broad->known.shapes = shapes;
    narc_show_arrays(c);
    if (out_result)
        *out_result = &c->result;
    return NARC_OK;
}
