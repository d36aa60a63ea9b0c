/* SPDX-License-Identifier: MIT
 *
 * lists.h - lists of "title = value", divided by ";": what tables have in lines and columns.
 */
#ifndef NARC_BENCH_LISTS_H
#define NARC_BENCH_LISTS_H

#include <stddef.h>

enum { MOST_ITEMS = 16, ITEM_TITLE = 112, ITEM_VALUE = 96 };

struct item {
    char title[ITEM_TITLE], value[ITEM_VALUE];
    size_t over; /* "/ 2" behind a value: the number of another one, from 1 on; 0: none */
};

/* The items of a list; how many. An empty list has one without words. */
size_t read_items(const char *list, struct item items[MOST_ITEMS]);

/* Copies `text` with `value` in the place of each word `key`. */
void replace_word(const char *text, const char *key, const char *value, char *out, size_t size);

#endif
