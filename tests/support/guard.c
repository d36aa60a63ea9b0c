/* SPDX-License-Identifier: MIT
 *
 * guard.c - memory between pages that can't be touched.
 */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "guard.h"

#include <stdlib.h>
#include <string.h>

#include "support.h"

#if defined(_WIN32)
#include <windows.h>

static void *map_pages(size_t size) { return VirtualAlloc(NULL, size, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE); }
static bool forbid_pages(void *pages, size_t size) {
    DWORD old;
    return VirtualProtect(pages, size, PAGE_NOACCESS, &old);
}
static bool allow_pages(void *pages, size_t size) {
    DWORD old;
    return VirtualProtect(pages, size, PAGE_READWRITE, &old);
}
static size_t page_size(void) { return 4096; }
#elif defined(__wasm__)
/* No page can be forbidden: what is written there is found at the end, what is read is not. */
#define FORBIDDEN_IS_JUNK

static void *map_pages(size_t size) { return malloc(size); }
static bool forbid_pages(void *pages, size_t size) { return memset(pages, GUARD_JUNK, size) != NULL; }
static bool allow_pages(void *pages, size_t size) { return pages && size; }
static size_t page_size(void) { return 256; }
#else
#include <sys/mman.h>
#include <unistd.h>

static void *map_pages(size_t size) {
    void *pages = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return pages == MAP_FAILED ? NULL : pages;
}
static bool forbid_pages(void *pages, size_t size) { return mprotect(pages, size, PROT_NONE) == 0; }
static bool allow_pages(void *pages, size_t size) { return mprotect(pages, size, PROT_READ | PROT_WRITE) == 0; }
static size_t page_size(void) { return (size_t)sysconf(_SC_PAGESIZE); }
#endif

/* One allocation: a forbidden page, pages that hold the memory at their end, a forbidden page. */
struct block {
    struct block *next;
    unsigned char *map;
    size_t map_size, page;
    unsigned char *memory;
};

/* Those in use, and those that were, by their number of pages: new pages are slow to come by. Until they are used again
 * they are junk, and forbidden. */
static struct block *blocks, *idle[64];

static bool is_junk(const unsigned char *from, const unsigned char *to) {
    bool whole = true;
    for (const unsigned char *byte = from; byte < to; byte++)
        whole = whole && *byte == GUARD_JUNK;
    return whole;
}

static struct block **find_idle(size_t map_size, size_t page) { return idle + map_size / page % 64; }

static struct block *make_block(size_t map_size, size_t page) {
    struct block *block = malloc(sizeof(*block));
    assert_non_null(block);
    unsigned char *map = map_pages(map_size);
    assert_non_null(map);
    memset(map + page, GUARD_JUNK, map_size - 2 * page);
    assert_true(forbid_pages(map, page) && forbid_pages(map + map_size - page, page));
    *block = (struct block){NULL, map, map_size, page, NULL};
    return block;
}

void *guard_allocate(size_t size) {
    const size_t page = page_size(), inside = (size + page - 1) / page * page + (size == 0 ? page : 0);
    struct block **link = find_idle(inside + 2 * page, page);
    while (*link && (*link)->map_size != inside + 2 * page)
        link = &(*link)->next;
    struct block *block = *link;
    if (block)
        *link = block->next;
    else
        block = make_block(inside + 2 * page, page);
    assert_true(allow_pages(block->map + page, inside));
    assert_true(is_junk(block->map + page, block->map + page + inside));
    block->memory = block->map + page + inside - size;
    block->next = blocks;
    blocks = block;
    return block->memory;
}

void guard_release(void *memory) {
    struct block **link = &blocks;
    while (*link && (*link)->memory != memory)
        link = &(*link)->next;
    struct block *block = *link;
    assert_non_null(block);
    unsigned char *end = block->map + block->map_size;
    assert_true(is_junk(block->map + block->page, block->memory));
#ifdef FORBIDDEN_IS_JUNK
    assert_true(is_junk(block->map, block->map + block->page) && is_junk(end - block->page, end));
#endif
    *link = block->next;
    memset(block->memory, GUARD_JUNK, (size_t)(end - block->page - block->memory));
    assert_true(forbid_pages(block->map + block->page, block->map_size - 2 * block->page));
    link = find_idle(block->map_size, block->page);
    block->next = *link;
    *link = block;
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
