/* SPDX-License-Identifier: MIT
 *
 * steps.h - the steps of narc_find_pairs() and narc_update_pairs(). Internal.
 */
#ifndef NARC_BROAD_PHASE_STEPS_H
#define NARC_BROAD_PHASE_STEPS_H

#include "broad_phase.h"
#include "column.h"
#include "narc_broad_phase.h"
#include "narc_contacts.h"
#include "narc_workers.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* "`owner`.`name` is ...": it is at least 0 and finite. */
narc_status narc_check_length(float length, const char *owner, const char *name, narc_error *error);

/* The items of each of `parts` parts of equal size, at least 1. */
static inline size_t narc_part_size(size_t count, size_t parts) { return count / parts + (count % parts || !count); }

/* Both bodies of a pair as one number; pairs in order have rising numbers. */
static inline uint64_t narc_join_pair(uint32_t a, uint32_t b) { return (uint64_t)a << 32 | b; }

/* narc_match_pairs() of two lists in order. */
void narc_match_in_order(const narc_pairs *old_pairs, const narc_pairs *new_pairs, const narc_workers *workers,
                         uint32_t *out_match);

/* The first pair of a list in order that is not before `pair`. */
size_t narc_find_pair(const narc_pairs *pairs, uint64_t pair);

/* Sorts broad->entries by their strips, which are below `limit`, in `parts` parts or fewer. Equal ones stay in order. */
void narc_sort_by_strip(narc_broad_phase *broad, size_t count, uint64_t limit, size_t parts,
                        const narc_workers *workers);

/* Sorts entries by min_x, and returns where they are then: here, or in `spare`. */
narc_box_entry *narc_sort_by_min_x(narc_box_entry *entries, narc_box_entry *spare, size_t count);

/* Sorts indices in place: a few by insertion, more by a heap with the last in front. Compiled for each `before`. */
static inline void narc_sort_indices(uint32_t *items, size_t count,
                                     bool (*before)(const void *context, uint32_t one, uint32_t other),
                                     const void *context) {
    enum { FEW = 32 };
    for (size_t k = 1; k < count && count <= FEW; k++) {
        const uint32_t moved = items[k];
        size_t to = k;
        for (; to > 0 && before(context, moved, items[to - 1]); to--)
            items[to] = items[to - 1];
        items[to] = moved;
    }
    for (size_t root = count / 2, end = count; end > 1 && count > FEW;) {
        const uint32_t moved = root > 0 ? items[--root] : items[--end];
        if (end < count)
            items[end] = items[0];
        size_t to = root;
        for (size_t child; (child = 2 * to + 1) < end; to = child) {
            child += child + 1 < end && before(context, items[child], items[child + 1]);
            if (!before(context, moved, items[child]))
                break;
            items[to] = items[child];
        }
        items[to] = moved;
    }
}

/* A box that is not empty. False for NaN too. */
static inline bool narc_is_box(const narc_box *box) {
    return box->min_x >= -FLT_MAX && box->min_y >= -FLT_MAX && box->max_x <= FLT_MAX && box->max_y <= FLT_MAX &&
           box->min_x <= box->max_x && box->min_y <= box->max_y;
}

static inline uint32_t narc_read_world(const narc_pair_filter *filter, size_t body) {
    return filter && filter->world.base ? narc_index_at(filter->world, body) : 0;
}

/* What the filter says of one body. */
static inline narc_body_filter narc_read_filter(const narc_pair_filter *filter, size_t body) {
    const narc_word_column category = filter->category, mask = filter->mask;
    return (narc_body_filter){.category = category.base ? narc_word_at(category, body) : UINT64_MAX,
                              .mask = mask.base ? narc_word_at(mask, body) : UINT64_MAX,
                              .owner = filter->owner.base ? narc_index_at(filter->owner, body) : UINT32_MAX,
                              .world = narc_read_world(filter, body),
                              .kind = filter->kind.base ? narc_byte_at(filter->kind, body) & NARC_KINDS : 0};
}

static inline narc_box narc_empty_box(void) { return (narc_box){INFINITY, INFINITY, -INFINITY, -INFINITY}; }

/* A box that is larger on each side by at least `by`, hardly more, and finite. */
narc_box narc_widen_box(narc_box box, float by);

static inline bool narc_has_motions(const narc_step *step) {
    return step->motion_x.base || step->motion_y.base || step->reach.base || step->ahead.base || step->run.base;
}

/* What of the skin lies around broad->boxes_now, so that bodies that tremble keep theirs. Kept boxes are larger than
 * these by what is left without it again: a body may be out of its box by as much, and pairs that are listed are not further
 * apart than they may be. */
static inline float narc_find_slack(float skin, bool has_motions) { return has_motions ? 0 : skin / 16; }

static inline float narc_find_kept_skin(const narc_step *step) {
    return step->skin - 2 * narc_find_slack(step->skin, narc_has_motions(step));
}

/* Computes broad->boxes_now, larger by the slack. Bodies that have hardly moved keep theirs, and without a look at them if those
 * that have moved are `listed`. Errors as narc_compute_boxes() has them. */
narc_status narc_compute_step_boxes(narc_broad_phase *broad, const narc_shapes *shapes, const narc_step *step,
                                    bool listed, narc_error *error);

/* Does what is known of all poses still count? */
bool narc_are_poses_known(const narc_broad_phase *broad, const narc_shapes *shapes, const narc_step *step);

/* The pairs of bodies that are closer than the step's margin, and perhaps others, none further apart than margin + 3 * skin
 * and the motion (of boxes, and but for rounding, NARC_BOX_ROOM) when the list was made; or the caller's own pairs.
 *   A list has all pairs of KEPT BOXES that overlap and may form a pair. When a body has left its kept box, or has
 * another filter, it and all bodies with less than half of the kept skin (narc_find_kept_skin()), or more than one and a
 * half, left on a side get new ones, larger than boxes_now by the kept skin. All bodies do if there are more or fewer than in
 * the last call, or others by their ids, with the first filter, after narc_forget_pairs(), and perhaps after a call that failed.
 *   step      its lengths and reserved pointers are checked
 *   out_list  see narc_pair_list. A broken body (narc_bodies; also one whose motion or reach is NaN, infinite, or below 0 as
 *             a reach) is in no pair that was found, and counted in `skipped`
 * The list depends on the bodies of this call and of those before. For the same calls it is the same, bit by bit, for any
 * number of threads and whichever way it was made.
 *   Time: a look at each body, and narc_compute_boxes() of those whose scale or shape differs from the last call's, or which
 * may have gone as far as the slack since theirs (of all where the store of shapes has changed). With a new list also a walk
 * over all pairs, and a search for those of the bodies with new boxes; if these are more than one in 16, or others by their
 * ids, the time of narc_find_pairs() and narc_match_pairs().
 *   Memory: some 245 bytes for each body, 265 with ids, and some 55 for each pair, and a quarter of it for growth; kept
 * from step to step.
 *   On an error the last list is as it was and valid, and the next call goes on from there. */
narc_status narc_update_pairs(narc_broad_phase *broad, const narc_shapes *shapes, const narc_step *step,
                              const narc_pair_list **out_list, narc_error *error);

/* What follows, or came before, the last call failed: the next one makes a list from nothing that is kept, and compares it
 * with the last list, or, if that was `made` in the last call, with the one before. */
void narc_take_back_pairs(narc_broad_phase *broad, bool made);

/* Knows no pose: all bodies may have moved. */
void narc_forget_poses(narc_broad_phase *broad);

/* Takes bodies with these ids out of the last list, which has their pairs still: the next one has lost them, and a body with
 * such an id is new. NARC_ERROR_MEMORY: none is taken out. */
narc_status narc_forget_ids(narc_broad_phase *broad, const uint64_t *ids, size_t count, narc_error *error);

/* Forgets the list, and keeps the memory: all pairs of the next list are new, and none is lost. */
void narc_forget_pairs(narc_broad_phase *broad);

/* For each pair of a new list: its index in an old list, or NARC_NO_MATCH. Pairs (a, b) and (b, a) are different. Both
 * lists may be in any order; two lists in the order of (a, b) are matched without memory, in one walk. Others take up to 15
 * bytes for each old pair and time that grows with n log n at most, whatever the pairs are. If a pair stands several times
 * in the old list, the first counts. At most 2^32 - 2 pairs each. NARC_ERROR_MEMORY. */
narc_status narc_match_pairs(narc_broad_phase *broad, const narc_pairs *old_pairs, const narc_pairs *new_pairs,
                             const narc_workers *workers, uint32_t *out_match);

/* The first of places from .. count - 1 with a flag, or `count`. */
static inline size_t narc_find_flag(const uint8_t *flags, size_t from, size_t count) {
    if (from < count && flags[from])
        return from;
    const uint8_t *const found = from < count ? memchr(flags + from, 1, count - from) : NULL;
    return found ? (size_t)(found - flags) : count;
}

/* Finds the pairs of boxes that overlap and may form a pair; *out_count is how many. The broad phase holds as many of
 * them as there is memory for. Errors as narc_find_pairs() has them, but for NARC_ERROR_CAPACITY. */
narc_status narc_sweep_boxes(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                             const narc_pair_filter *filter, const narc_workers *workers, size_t *out_count,
                             narc_error *error);

/* Holds given pairs that the filter lets as if they had been found, of `count` bodies. NARC_ERROR_ARGUMENT, NARC_ERROR_INDEX
 * (`error` names the pair), NARC_ERROR_MEMORY. */
narc_status narc_hold_pairs(narc_broad_phase *broad, const narc_pairs *pairs, size_t count,
                            const narc_pair_filter *filter, size_t *out_count, narc_error *error);

/* The same as narc_sweep_boxes() for those pairs alone that have one of broad->fresh, some `fresh_count` bodies. All other boxes are as they
 * were when narc_sweep_boxes() or this function ended last, for this broad phase. False: that would take as long as all
 * pairs, which are then to be found. */
bool narc_sweep_fresh(narc_broad_phase *broad, const narc_box *boxes, size_t count, size_t fresh_count,
                      const narc_pair_filter *filter, const narc_workers *workers, size_t *out_count);

/* Lists these `found` pairs in their order, sweeping again if not all were held. NARC_ERROR_MEMORY. */
narc_status narc_list_found_pairs(narc_broad_phase *broad, size_t count, const narc_pair_filter *filter,
                                  const narc_workers *workers, size_t found, uint32_t *out_a, uint32_t *out_b,
                                  narc_error *error);

/* Lists the levels and strips that `count` boxes lie in, and puts the boxes into the columns, strip by strip, in the
 * order of min_x. There is room for all boxes and a part for each worker. */
void narc_make_strips(narc_broad_phase *broad, const narc_box *boxes, size_t count, const narc_pair_filter *filter,
                      const narc_workers *workers);

/* Puts the boxes of a strip, whose entries are listed at its places, into the columns in the order of min_x. */
void narc_fill_strip(narc_broad_phase *broad, narc_strip *strip, const narc_box *boxes);

/* Fills what a kernel may read behind the last box of the columns. */
void narc_end_columns(const narc_box_columns *boxes, size_t end);

/* The number of the strip of a level that holds `y`, or of one `offset` strips above it; the nearest one that boxes may
 * lie in. */
uint64_t narc_strip_number(const narc_broad_phase *broad, const narc_level *level, float y, int64_t offset);

/* Puts the bodies of each pair from `first` on into their order, a < b, leaves out pairs that the filter does not let,
 * and returns how many there are then, with those before `first`. */
uint32_t narc_filter_pairs(const narc_pair_filter *filter, uint32_t *a, uint32_t *b, uint32_t first, uint32_t count);

/* What a new list has of the last one. narc_match_lists(): the index that each pair had, and whether its bodies changed
 * their order, by the numbers that they had. narc_list_added(): the pairs that were in none; returns how many are lost.
 * narc_merge_pairs(): both, and pairs: those of the last list without a fresh body, and `count` others, in order like
 * these; there is room for all. Then narc_list_lost(), with room for as many; and narc_mark_pairs(), by kinds. */
void narc_match_lists(const narc_kept_list *last, narc_kept_list *made, const uint32_t *last_index,
                      const narc_workers *workers);
size_t narc_list_added(narc_kept_list *last, narc_kept_list *made);
size_t narc_merge_pairs(const uint8_t *fresh, narc_kept_list *last, narc_kept_list *made, const uint32_t *a,
                        const uint32_t *b, size_t count);
void narc_list_lost(const narc_kept_list *last, narc_kept_list *made, size_t lost_count);
void narc_mark_pairs(const narc_broad_phase *broad, narc_kept_list *made);

/* Writes the pairs of `blocks` blocks in their order. There is room for all. */
void narc_order_pairs(narc_broad_phase *broad, size_t blocks, size_t body_count, const narc_workers *workers,
                      uint32_t *out_a, uint32_t *out_b);

#endif
