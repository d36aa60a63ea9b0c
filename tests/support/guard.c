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
static void unmap_pages(void *pages, size_t size) {
    (void)size;
    VirtualFree(pages, 0, MEM_RELEASE);
}
static size_t page_size(void) { return 4096; }
#elif defined(__wasm__)
/* No page can be forbidden: what is written there is found at the end, what is read is not. */
#define FORBIDDEN_IS_JUNK

static void *map_pages(size_t size) { return malloc(size); }
static bool forbid_pages(void *pages, size_t size) { return memset(pages, GUARD_JUNK, size) != NULL; }
static void unmap_pages(void *pages, size_t size) {
    (void)size;
    free(pages);
}
static size_t page_size(void) { return 256; }
#else
#include <sys/mman.h>
#include <unistd.h>

static void *map_pages(size_t size) {
    void *pages = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return pages == MAP_FAILED ? NULL : pages;
}
static bool forbid_pages(void *pages, size_t size) { return mprotect(pages, size, PROT_NONE) == 0; }
static void unmap_pages(void *pages, size_t size) { munmap(pages, size); }
static size_t page_size(void) { return (size_t)sysconf(_SC_PAGESIZE); }
#endif

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
    size_t page = page_size(), inside = (size + page - 1) / page * page + (size == 0 ? page : 0);
    unsigned char *map = map_pages(inside + 2 * page);
    assert_non_null(map);
    memset(map + page, GUARD_JUNK, inside);
    assert_true(forbid_pages(map, page) && forbid_pages(map + page + inside, page));
    *block = (struct block){blocks, map, inside + 2 * page, page, map + page + inside - size};
    blocks = block;
    return block->memory;
}

static bool is_junk(const unsigned char *from, const unsigned char *to) {
    bool whole = true;
    for (const unsigned char *byte = from; byte < to; byte++)
        whole = whole && *byte == GUARD_JUNK;
    return whole;
}

void guard_release(void *memory) {
    struct block **link = &blocks;
    while (*link && (*link)->memory != memory)
        link = &(*link)->next;
    struct block *block = *link;
    assert_non_null(block);
    assert_true(is_junk(block->map + block->page, block->memory));
#ifdef FORBIDDEN_IS_JUNK
    const unsigned char *end = block->map + block->map_size;
    assert_true(is_junk(block->map, block->map + block->page) && is_junk(end - block->page, end));
#endif
    *link = block->next;
    unmap_pages(block->map, block->map_size);
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
