/* SPDX-License-Identifier: MIT
 *
 * layouts.c - prints the table of layouts, of which layouts.mjs makes the module's types.
 */
#include <stdio.h>
#include <stdlib.h>

#include <narc_layouts.h>

int main(void) {
    const size_t size = narc_write_layouts(NULL, 0) + 1;
    char *const text = malloc(size);
    if (!text)
        return 1;
    narc_write_layouts(text, size);
    return puts(text) < 0;
}
