/* SPDX-License-Identifier: MIT
 *
 * broad_phase.c - allocates the memory of a broad phase. What a step needs is kept, so that the next one allocates
 * nothing unless it is larger.
 */
#include "broad_phase.h"

#include "memory.h"

narc_status narc_create_broad_phase(const narc_allocator *allocator, narc_broad_phase **out_broad) {
    const narc_allocator chosen = narc_choose_allocator(allocator);
    if (!out_broad || !chosen.allocate || !chosen.release)
        return NARC_ERROR_ARGUMENT;
    narc_broad_phase *broad = chosen.allocate(sizeof *broad, chosen.context);
    if (!broad)
        return NARC_ERROR_MEMORY;
    *broad = (narc_broad_phase){.allocator = chosen};
    atomic_init(&broad->block_count, 0);
    *out_broad = broad;
    return NARC_OK;
}

void narc_destroy_broad_phase(narc_broad_phase *broad) {
    if (!broad)
        return;
    const narc_allocator allocator = broad->allocator;
    const narc_kept_list *const one = &broad->lists[0], *const other = &broad->lists[1];
    void *const memory[] = {broad->box_memory,
                            broad->pair_memory,
                            broad->match_memory,
                            broad->body_memory,
                            one->pair_memory,
                            one->lost,
                            one->ids,
                            other->pair_memory,
                            other->lost,
                            other->ids,
                            broad};
    for (size_t k = 0; k < sizeof memory / sizeof memory[0]; k++)
        if (memory[k])
            allocator.release(memory[k], allocator.context);
}

/* Room for a quarter more than is needed, so that a scene that grows slowly does not allocate at every step. */
static size_t with_room(size_t needed, size_t least) {
    const size_t room = needed / 4 < SIZE_MAX - needed ? needed / 4 : SIZE_MAX - needed;
    return needed < least ? least : needed + room;
}

/* Replaces a piece of memory; the old one stays if that fails. */
static bool replace(const narc_broad_phase *broad, void **memory, size_t items, size_t item_size) {
    if (items > SIZE_MAX / item_size)
        return false;
    void *const fresh = broad->allocator.allocate(items * item_size, broad->allocator.context);
    if (!fresh)
        return false;
    if (*memory)
        broad->allocator.release(*memory, broad->allocator.context);
    *memory = fresh;
    return true;
}

/* Makes room for `count` items in an array of its own. */
static narc_status reserve(const narc_broad_phase *broad, void **memory, size_t *capacity, size_t count, size_t least,
                           size_t item_size) {
    const size_t n = with_room(count, least);
    if (count <= *capacity)
        return NARC_OK;
    if (!replace(broad, memory, n, item_size))
        return NARC_ERROR_MEMORY;
    *capacity = n;
    return NARC_OK;
}

/* Takes `count` items of `size` bytes from the front of the memory at `*at`, in whole units of 16 bytes. */
static void *take(char **at, size_t count, size_t size) {
    void *const taken = *at;
    *at += (count * size + 15) / 16 * 16;
    return taken;
}

/* What one box needs in all, generously: the arrays below, and what rounding them up to 16 bytes takes. */
enum { BYTES_PER_BOX = 144 };

narc_status narc_reserve_boxes(narc_broad_phase *broad, size_t count) {
    if (broad->box_memory && count <= broad->box_capacity) /* padding needs memory even without boxes */
        return NARC_OK;
    const size_t n = with_room(count, 1024), unsorted = narc_most_unsorted(n), parts = n / NARC_PART_BOXES + 1;
    const size_t both = n + unsorted, padded = both + NARC_BOX_PADDING;
    if (both > SIZE_MAX - 64 || !replace(broad, &broad->box_memory, both + 64, BYTES_PER_BOX))
        return NARC_ERROR_MEMORY;
    char *at = broad->box_memory;
    broad->entries = take(&at, both, sizeof *broad->entries);
    broad->spare = take(&at, both, sizeof *broad->spare);
    broad->strips = take(&at, n, sizeof *broad->strips);
    broad->levels = take(&at, n, sizeof *broad->levels);
    broad->boxes.min_x = take(&at, padded, sizeof(float));
    broad->boxes.max_x = take(&at, padded, sizeof(float));
    broad->boxes.min_y = take(&at, padded, sizeof(float));
    broad->boxes.max_y = take(&at, padded, sizeof(float));
    broad->boxes.body = take(&at, padded, sizeof(uint32_t));
    broad->ends = take(&at, n + 1, sizeof *broad->ends);
    broad->unsorted = take(&at, unsorted, sizeof *broad->unsorted);
    broad->parts = take(&at, parts < NARC_STRIP_PARTS ? parts : NARC_STRIP_PARTS, sizeof *broad->parts);
    broad->box_capacity = n;
    return NARC_OK;
}

narc_status narc_reserve_blocks(narc_broad_phase *broad, size_t count) {
    if (count <= broad->block_capacity)
        return NARC_OK;
    const size_t n = with_room(count, 4);
    if (!replace(broad, &broad->pair_memory, n, 2 * NARC_PAIR_BLOCK * sizeof(uint32_t) + sizeof(narc_pair_block)))
        return NARC_ERROR_MEMORY;
    broad->pair_a = broad->pair_memory;
    broad->pair_b = broad->pair_a + n * NARC_PAIR_BLOCK;
    broad->blocks = (narc_pair_block *)(void *)(broad->pair_b + n * NARC_PAIR_BLOCK);
    broad->block_capacity = n;
    return NARC_OK;
}

narc_status narc_reserve_matches(narc_broad_phase *broad, size_t first_count, size_t second_count) {
    if (second_count > SIZE_MAX - first_count)
        return NARC_ERROR_MEMORY;
    return reserve(broad, &broad->match_memory, &broad->match_capacity, first_count + second_count, 1024,
                   sizeof(uint32_t));
}

narc_status narc_reserve_bodies(narc_broad_phase *broad, size_t count) {
    enum {
        BYTES = sizeof(narc_pose_bits) + sizeof(narc_motion_bits) + 2 * sizeof(narc_box) + sizeof(narc_body_filter) +
                2 * sizeof(uint32_t) + sizeof(float) + 5
    };
    if (broad->body_memory && count <= broad->body_capacity)
        return NARC_OK;
    const size_t n = with_room(count, 1024);
    if (n > SIZE_MAX - 64 || !replace(broad, &broad->body_memory, n + 64, BYTES))
        return NARC_ERROR_MEMORY;
    char *at = broad->body_memory;
    broad->known.poses = take(&at, n, sizeof *broad->known.poses);
    broad->known.count = 0;
    broad->known.motions = take(&at, n, sizeof *broad->known.motions);
    broad->known.slack = take(&at, n, sizeof *broad->known.slack);
    broad->known.moved = take(&at, n, 1);
    broad->known.changed = take(&at, n, 1);
    broad->boxes_now = take(&at, n, sizeof *broad->boxes_now);
    broad->kept_boxes = take(&at, n, sizeof *broad->kept_boxes);
    broad->filters = take(&at, n, sizeof *broad->filters);
    broad->last_index = take(&at, n, sizeof *broad->last_index);
    broad->place = take(&at, n, sizeof *broad->place);
    broad->kinds = take(&at, n, 1);
    broad->taken = take(&at, n, 1);
    broad->fresh = take(&at, n, 1);
    broad->body_capacity = n;
    broad->is_current = false;
    return NARC_OK;
}

narc_status narc_reserve_pairs(narc_broad_phase *broad, narc_kept_list *list, size_t count) {
    enum { BYTES = 4 * sizeof(uint32_t) + 2 };
    if (list->pair_memory && count <= list->pair_capacity)
        return NARC_OK;
    const size_t n = with_room(count, 1024);
    if (!replace(broad, &list->pair_memory, n, BYTES))
        return NARC_ERROR_MEMORY;
    list->a = list->pair_memory;
    list->b = list->a + n;
    list->previous = list->b + n;
    list->added = list->previous + n;
    list->marks = (uint8_t *)(list->added + n);
    list->matched = list->marks + n;
    list->pair_capacity = n;
    return NARC_OK;
}

narc_status narc_reserve_lost(narc_broad_phase *broad, narc_kept_list *list, size_t count) {
    void *memory = list->lost;
    const narc_status status = reserve(broad, &memory, &list->lost_capacity, count, 64, sizeof *list->lost);
    list->lost = memory;
    return status;
}

narc_status narc_reserve_ids(narc_broad_phase *broad, narc_kept_list *list, size_t count) {
    void *memory = list->ids;
    const narc_status status = reserve(broad, &memory, &list->id_capacity, count, 1024, sizeof *list->ids + 1);
    list->ids = memory;
    list->gone = memory ? (uint8_t *)(list->ids + list->id_capacity) : NULL;
    return status;
}
