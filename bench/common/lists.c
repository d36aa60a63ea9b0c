/* SPDX-License-Identifier: MIT
 *
 * lists.c - lists of "title = value".
 */
#include "lists.h"

#include <stdbool.h>
#include <string.h>

#include "common.h"

size_t read_items(const char *list, struct item items[MOST_ITEMS]) {
    size_t count = 0;
    for (bool more = true; more; count++) {
        const size_t length = strcspn(list, ";"), title = strcspn(list, "=");
        if (count == MOST_ITEMS)
            fail("more than %d items: %s", MOST_ITEMS, list);
        struct item *item = &items[count];
        *item = (struct item){.over = 0};
        if (title < length) {
            snprintf(item->title, ITEM_TITLE, "%.*s", (int)title - 1, list);
            snprintf(item->value, ITEM_VALUE, "%.*s", (int)(length - title) - 2, list + title + 2);
        }
        char *over = strstr(item->value, " / ");
        if (over) {
            item->over = (size_t)(over[3] - '0');
            *over = 0;
        }
        more = list[length] == ';';
        list += length + more;
        list += strspn(list, " ");
    }
    return count;
}

void replace_word(const char *text, const char *key, const char *value, char *out, size_t size) {
    size_t length = 0;
    const char *word;
    out[0] = 0;
    for (; (word = strstr(text, key)) != NULL && length < size; text = word + strlen(key))
        length += (size_t)snprintf(out + length, size - length, "%.*s%s", (int)(word - text), text, value);
    if (length < size)
        snprintf(out + length, size - length, "%s", text);
}
