/* SPDX-License-Identifier: MIT
 *
 * guard.c - memory between pages that can't be touched.
 */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "guard.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "support.h"

/* One allocation: a forbidden page, pages that hold the memory at their end, a forbidden page. */
struct block {
    struct block *next;
    unsigned char *map;
    size_t map_size, page;
    unsigned char *memory;
};

static struct block *blocks;

void *guard_allocate(size_t size) {
    struct block *block = malloc(sizeof(*block));
    assert_non_null(block);
    size_t page = (size_t)sysconf(_SC_PAGESIZE), inside = (size + page - 1) / page * page + (size == 0 ? page : 0);
    unsigned char *map = mmap(NULL, inside + 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(map != MAP_FAILED);
    memset(map + page, GUARD_JUNK, inside);
    assert_int_equal(mprotect(map, page, PROT_NONE), 0);
    assert_int_equal(mprotect(map + page + inside, page, PROT_NONE), 0);
    *block = (struct block){blocks, map, inside + 2 * page, page, map + page + inside - size};
    blocks = block;
    return block->memory;
}

void guard_release(void *memory) {
    struct block **link = &blocks;
    while (*link && (*link)->memory != memory)
        link = &(*link)->next;
    struct block *block = *link;
    assert_non_null(block);
    bool whole = true;
    for (const unsigned char *byte = block->map + block->page; byte < block->memory; byte++)
        whole = whole && *byte == GUARD_JUNK;
    assert_true(whole);
    *link = block->next;
    munmap(block->map, block->map_size);
    free(block);
}

void *guard_copy(const void *bytes, size_t size) {
    void *memory = guard_allocate(size);
    if (size > 0)
        memcpy(memory, bytes, size);
    return memory;
}

static void *allocate(size_t size, void *context) {
    (void)context;
    const size_t alignment = 16;
    return guard_allocate((size + alignment - 1) / alignment * alignment);
}

static void release(void *memory, void *context) {
    (void)context;
    if (memory)
        guard_release(memory);
}

const narc_allocator guard_allocator = {allocate, release, NULL};
