/* SPDX-License-Identifier: MIT
 *
 * shape_list.c - named shapes.
 */
#include "shape_list.h"

#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "text.h"

narc_status add_shape(shape_list *shapes, const char *name, const narc_arc *arcs, size_t arc_count, narc_error *error) {
    if (!shapes->store && narc_create_shapes(NULL, &shapes->store) != NARC_OK)
        fail("not enough memory for a store of shapes");
    const narc_status status = narc_add_shape(shapes->store, arcs, arc_count, NULL, error);
    if (status != NARC_OK)
        return status;
    narc_circle bound;
    narc_mass mass;
    narc_compute_bounding_circle(arcs, arc_count, &bound);
    narc_compute_mass(arcs, arc_count, &mass);
    shapes->items = grow(shapes->items, &shapes->capacity, shapes->count + 1, sizeof *shapes->items);
    shape *added = &shapes->items[shapes->count++];
    *added = (shape){.name = strcpy(allocate(strlen(name) + 1, 1), name),
                     .arcs = allocate(arc_count, sizeof *arcs),
                     .arc_count = arc_count,
                     .bound = bound.radius,
                     .area = mass.area};
    memcpy(added->arcs, arcs, arc_count * sizeof *arcs);
    return NARC_OK;
}

static int compare_entries(const void *left, const void *right) {
    const name_entry *a = left, *b = right;
    const int order = strcmp(a->name, b->name);
    return order ? order : (a->index > b->index) - (a->index < b->index);
}

size_t index_shapes(shape_list *shapes) {
    shapes->by_name = allocate(shapes->count, sizeof *shapes->by_name);
    for (size_t i = 0; i < shapes->count; i++)
        shapes->by_name[i] = (name_entry){shapes->items[i].name, (uint32_t)i};
    qsort(shapes->by_name, shapes->count, sizeof *shapes->by_name, compare_entries);
    for (size_t i = 1; i < shapes->count; i++)
        if (strcmp(shapes->by_name[i - 1].name, shapes->by_name[i].name) == 0)
            return shapes->by_name[i].index;
    return shapes->count;
}

size_t find_shape(const shape_list *shapes, const char *text) {
    size_t low = 0, high = shapes->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const int order = strcmp(text, shapes->by_name[middle].name);
        if (order == 0)
            return shapes->by_name[middle].index;
        low = order > 0 ? middle + 1 : low;
        high = order > 0 ? high : middle;
    }
    uint64_t index;
    return shapes->count && parse_whole(text, shapes->count - 1, &index) ? (size_t)index : shapes->count;
}

void free_shapes(shape_list *shapes) {
    for (size_t i = 0; i < shapes->count; i++) {
        free(shapes->items[i].name);
        free(shapes->items[i].arcs);
    }
    free(shapes->items);
    free(shapes->by_name);
    narc_destroy_shapes(shapes->store);
    *shapes = (shape_list){0};
}

/* Moves on over a character; false if a name cannot have it. */
static bool next_of_name(const char **text) {
    uint32_t code;
    return next_code_point(text, &code) && code >= 0x20 && code != 0x7f && code != ',' && code != '"';
}

bool is_shape_name(const char *name) {
    const size_t length = strlen(name);
    if (length == 0 || name[0] == ' ' || name[length - 1] == ' ')
        return false;
    while (*name)
        if (!next_of_name(&name))
            return false;
    return true;
}

char *make_shape_name(const char *text, size_t length) {
    static const char prefix[] = "shape-";
    for (; length && text[0] == ' '; length--)
        text++;
    while (length && text[length - 1] == ' ')
        length--;
    char *name = allocate(length + sizeof prefix, 1);
    memcpy(name, text, length);
    name[length] = 0;
    for (char *c = name; *c;) {
        const char *next = c;
        if (next_of_name(&next))
            c += next - c;
        else
            *c++ = '_';
    }
    if (length == 0) {
        strcpy(name, "shape");
    } else if (!name[strspn(name, "0123456789")]) {
        memmove(name + strlen(prefix), name, length + 1);
        memcpy(name, prefix, strlen(prefix));
    }
    return name;
}
