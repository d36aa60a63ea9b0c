/* SPDX-License-Identifier: MIT
 *
 * consumer_files.c - a shapes file into a store and out again, through the installed library of files. C and C++.
 */
#include <narc_files.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(void) {
    static const char file[] = "{\"shapes\": [{\"name\": \"disc\", \"circle\": 2},\n"
                               "{\"name\": \"block\", \"box\": {\"width\": 4, \"height\": 2}}]}\n";
    narc_shapes *shapes = NULL;
    narc_shape_list *list = NULL;
    narc_error error;
    char *text = NULL;
    size_t size = 0;
    memset(&error, 0, sizeof error);
    if (narc_create_shapes(NULL, &shapes) || narc_read_shapes(file, strlen(file), NULL, shapes, &list, &error) ||
        narc_write_shapes(list->items, list->count, NULL, &text, &size, &error)) {
        fprintf(stderr, "narc: %s\n", error.message);
        return 1;
    }
    fputs(text, stdout);
    const size_t block = narc_find_named_shape(list, "block");
    const int good = block == 1 && list->items[block].arc_count == 4 && narc_count_shapes(shapes) == 2 &&
                     narc_find_named_shape(list, "cube") == list->count && text[size] == 0;
    free(text);
    narc_destroy_shape_list(list);
    narc_destroy_shapes(shapes);
    return good ? 0 : 1;
}
