/* SPDX-License-Identifier: MIT
 *
 * everywhere.c - one question to every instruction set.
 */
#include "everywhere.h"

#include <stdlib.h>
#include <string.h>

#include "narc.h"
#include "scene.h"

static void run_backwards(void *context, unsigned count, void (*task)(void *argument, unsigned index), void *argument) {
    (void)context;
    while (count-- > 0)
        task(argument, count);
}

/* To ask a processor takes longer than most questions. */
static bool is_supported(size_t k) {
    enum { MOST = 16 };
    static signed char known[MOST];
    assert_true(k < MOST);
    if (known[k] == 0)
        known[k] = narc_isa_supported(narc_isa_name(k)) ? 1 : -1;
    return known[k] > 0;
}

static void compare(const unsigned char *first, const unsigned char *rows, size_t size, const char *isa,
                    struct difference *out) {
    if (out->isa || memcmp(first, rows, size) == 0)
        return;
    while (*first++ == *rows++)
        out->at++;
    out->isa = isa;
}

void *ask_everywhere(void (*ask)(const void *question, const narc_workers *workers, void *out_rows),
                     const void *question, size_t size, struct difference *out) {
    static const narc_workers backwards = {NULL, 3, run_backwards};
    struct difference found = {NULL, NULL, 0};
    const char *const usual = narc_get_isa();
    void *first = NULL;
    for (size_t k = 0; narc_isa_name(k); k++) {
        if (!is_supported(k))
            continue;
        test_use_isa(narc_isa_name(k));
        void *const rows = make_junk(size);
        ask(question, first ? &backwards : NULL, rows);
        if (first) {
            compare(first, rows, size, narc_isa_name(k), &found);
            free(rows);
        } else {
            first = rows;
            found.first = narc_isa_name(k);
        }
    }
    test_use_isa(usual);
    if (out)
        *out = found;
    else if (found.isa)
        fail_msg("%s answers otherwise than %s at byte %zu", found.isa, found.first, found.at);
    return first;
}
