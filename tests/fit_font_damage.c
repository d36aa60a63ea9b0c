/* SPDX-License-Identifier: MIT
 *
 * fit_font_damage.c - damaged fonts: any bytes end in glyphs or errors.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fit_fonts.h"
#include "fit_support.h"
#include "fit_truetype.h"
#include "fit_type1.h"

/* Opens what may be a font and reads some of what may be its glyphs. Returns how many came out. */
static size_t try_font(const unsigned char *data, size_t size) {
    narc_font *font;
    narc_error error = {0};
    size_t read = 0;
    const narc_status status = narc_open_font(data, size, &font, &error);
    if (status) {
        expect_error(status, NARC_ERROR_FORMAT, &error, "");
        return 0;
    }
    uint32_t c = narc_next_character(font, 0);
    for (int tries = 0; tries < 150 && c; tries++, c = narc_next_character(font, c)) {
        narc_path *path = make_occupied_path();
        const narc_status result = narc_read_glyph(font, c, path, &error);
        const unsigned allowed = 1u << NARC_ERROR_FORMAT | 1u << NARC_ERROR_INDEX | 1u << NARC_ERROR_SIZE;
        read += finish_any_bytes(result, &error, allowed, SIZE_MAX, path);
    }
    narc_close_font(font);
    return read;
}

/* Changes up to 8 bytes of a header, or of any table, mostly to what counts and offsets take badly. */
static void damage(struct test_random *random, const file *whole, unsigned char *data, size_t size) {
    for (size_t changes = 1 + random_below(random, 8); changes > 0; changes--) {
        static const unsigned char values[] = {0, 1, 0x7f, 0x80, 0xfe, 0xff};
        const size_t table =
            read_big_endian(whole->data + 12 + 16 * random_below(random, read_big_endian(whole->data + 4, 2)) + 8, 4);
        size_t at = random_below(random, size);
        switch (random_below(random, 4)) {
        case 0:
            at %= 12 + 16 * 20;
            break;
        case 1:
        case 2:
            at = table + random_below(random, 64);
            break;
        default:
            break;
        }
        data[at < size ? at : size - 1] =
            random_below(random, 2) ? values[random_below(random, sizeof values)] : (unsigned char)random_bits(random);
    }
}

void survives_damage(void **state) {
    (void)state;
    struct test_random random = test_random_named("damaged fonts");
    for (int k = 0; k < file_count; k++) {
        const size_t trials = test_trials(300), whole = try_font(files[k].data, files[k].size);
        size_t opened = 0;
        assert_true(whole > 100);
        for (size_t trial = 0; trial < trials; trial++) {
            /* Truncated, damaged, or both; in a block of exactly that size. */
            size_t size = files[k].size;
            if (trial % 3 != 1) {
                size = (size_t)random_log_between(&random, 1, (double)size);
            }
            unsigned char *data = malloc(size);
            assert_non_null(data);
            memcpy(data, files[k].data, size);
            if (trial % 3 != 0 && size > 400) {
                damage(&random, &files[k], data, size);
            }
            opened += try_font(data, size) > 0;
            free(data);
        }
        printf("%s: %zu of %zu damaged fonts had glyphs to read\n", files[k].name, opened, trials);
        assert_true(opened > trials / 20);
    }
}

/* The same with a font of the other make. */
void survives_damaged_type1(void **state) {
    (void)state;
    struct test_random random = test_random_named("damaged Type 1");
    size_t size, trials = test_trials(2000);
    char *data = make_type1_font(operators, steps, &size);
    for (size_t trial = 0; trial < trials; trial++) {
        const size_t kept = trial % 2 ? size : random_below(&random, size) + 1;
        unsigned char *copy = malloc(kept);
        assert_non_null(copy);
        memcpy(copy, data, kept);
        for (size_t changes = random_below(&random, 4); changes > 0; changes--) {
            copy[random_below(&random, kept)] = (unsigned char)random_bits(&random);
        }
        (void)try_font(copy, kept);
        free(copy);
    }
    free(data);
}
