/* SPDX-License-Identifier: MIT
 *
 * memory.c - whichever allocation fails, one or all from it on, readers and fits end with NARC_ERROR_MEMORY and leave
 * their outputs as they were, or with what they give otherwise, and lose no memory. (librsvg ends the process.) The
 * argument: a font.
 * FreeType, libpng and cJSON run out too.
 */
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fit_support.h"
#include "outlines.h"
#include "png_files.h"
#include "scarcity.h"

/* What an operation ends with. */
struct outcome {
    narc_status status;
    narc_error error;
    bool untouched; /* outputs, of an operation that failed */
    narc_fit_result fit;
    narc_path *path; /* what was drawn */
    narc_arc_chains chains;
};

typedef void operation(const void *input, struct outcome *out);

static void watch_all(bool on) { scarcity.counts = on; }

/* Runs an operation whose allocation `denied` fails; 0: none. */
static struct outcome run(operation *operate, const void *input, size_t denied, bool forever) {
    struct outcome out = {.status = NARC_OK, .untouched = true};
    scarcity = (struct scarcity){.denied = denied, .forever = forever};
    operate(input, &out);
    watch_all(false);
    return out;
}

static void release(struct outcome *outcome) {
    narc_destroy_path(outcome->path);
    narc_release_chains(&outcome->chains);
}

static void expect_same(const struct outcome *usual, struct outcome *other) {
    other->fit.seconds = usual->fit.seconds;
    assert_memory_equal(&usual->fit, &other->fit, sizeof usual->fit);
    assert_int_equal(usual->chains.arc_count, other->chains.arc_count);
    if (usual->chains.arc_count)
        assert_memory_equal(usual->chains.arcs, other->chains.arcs,
                            usual->chains.arc_count * sizeof *usual->chains.arcs);
    if (usual->path) {
        AUTO(narc_release_contours) narc_contours one = flatten(usual->path), two = flatten(other->path);
        assert_int_equal(one.point_count, two.point_count);
        assert_memory_equal(one.points, two.points, one.point_count * sizeof *one.points);
    }
}

static operation fit_path;

/* Of the first allocations each one fails, of later ones, which are much the same, some. */
static void fail_all(const char *name, operation *operate, const void *input) {
    const size_t each = test_trials(60);
    struct outcome usual = run(operate, input, 0, false); /* and libraries have what they keep */
    const size_t count = scarcity.count, live = live_blocks;
    if (usual.status)
        fail_msg("%s: %s", name, usual.error.message);
    assert_true(count > 0);
    size_t failures = 0;
    for (int forever = 0; forever < 2; forever++) {
        for (size_t denied = 1; denied <= count; denied += denied < each ? 1 : denied) {
            struct outcome outcome = run(operate, input, denied, forever);
            if (outcome.status == NARC_OK)
                expect_same(&usual, &outcome);
            else if (outcome.status != NARC_ERROR_MEMORY || !strstr(outcome.error.message, "memory"))
                fail_msg("%s, allocation %zu of %zu: %s, %s", name, denied, count, narc_status_name(outcome.status),
                         outcome.error.message);
            else if (!outcome.untouched)
                fail_msg("%s, allocation %zu of %zu: an output is touched", name, denied, count);
            failures += outcome.status != NARC_OK;
            release(&outcome);
            if (live_blocks != live)
                fail_msg("%s, allocation %zu of %zu: %zd blocks are lost", name, denied, count,
                         (ptrdiff_t)(live_blocks - live));
        }
    }
    assert_true(failures > 0);
    release(&usual);
}

/* ------------------------------------------------------------------------------------------------ readers */

struct bytes {
    const void *data;
    size_t size;
};

/* Into a path that is occupied already, by a reader. */
static void read_with(reader *read, const void *input, struct outcome *out) {
    const struct bytes *bytes = input;
    narc_path *path = make_occupied_path();
    watch_all(true);
    out->status = read(bytes->data, bytes->size, path, &out->error);
    watch_all(false);
    if (out->status)
        expect_unchanged(path);
    out->path = path;
}

static void read_csv(const void *input, struct outcome *out) { read_with(narc_read_csv, input, out); }

static void read_json(const void *input, struct outcome *out) { read_with(narc_read_json, input, out); }

static narc_status read_alpha(const void *data, size_t size, narc_path *path, narc_error *error) {
    return narc_read_png(data, size, NULL, path, error);
}

static void read_image(const void *input, struct outcome *out) { read_with(read_alpha, input, out); }

static narc_status read_letter(const void *data, size_t size, narc_path *path, narc_error *error) {
    AUTO(narc_close_font_at) narc_font *font = NULL;
    const narc_status status = narc_open_font(data, size, &font, error);
    if (status) {
        assert_null(font);
        return status;
    }
    const narc_status drawn = narc_read_glyph(font, 0xe4, path, error); /* a letter of two parts */
    return drawn;
}

static void read_glyph(const void *input, struct outcome *out) { read_with(read_letter, input, out); }

TEST(test_readers) {
    static const char csv[] = "x,y\n0,0\n4,0\n4,3\n\n7,7\n8,7\n8,9\n";
    static const char json[] =
        "{\"name\": \"two\", \"contours\": [[[0, 0], [4, 0], [4, 3]], [[7, 7], [8, 7], [8, 9]]]}";
    enum { WIDTH = 24, HEIGHT = 20 };
    uint16_t gray[WIDTH * HEIGHT], alpha[WIDTH * HEIGHT];
    if (!CAN_FAIL)
        skip();
    for (size_t k = 0; k < WIDTH * HEIGHT; k++) {
        const double x = (double)(k % WIDTH) - 12, y = (double)(k / WIDTH) - 10;
        alpha[k] = (uint16_t)(x * x + y * y < 60 ? 65535 : 0);
        gray[k] = (uint16_t)(65535 - alpha[k]);
    }
    fail_all("CSV", read_csv, &(struct bytes){csv, sizeof csv - 1});
    fail_all("JSON", read_json, &(struct bytes){json, sizeof json - 1});
    const struct png_format formats[] = {{8, PNG_COLOR_TYPE_RGB_ALPHA, false}, {16, PNG_COLOR_TYPE_GRAY, true}};
    for (size_t k = 0; k < sizeof formats / sizeof formats[0]; k++) {
        AUTO(free_at) const struct png_file file = write_png(formats[k], WIDTH, HEIGHT, gray, alpha);
        fail_all("PNG", read_image, &(struct bytes){file.bytes, file.size});
    }
}

static const char *font_name;

TEST(test_fonts) {
    if (!CAN_FAIL || !font_name)
        skip();
    size_t size;
    AUTO(free_at) unsigned char *data = read_file(font_name, &size);
    fail_all("font", read_glyph, &(struct bytes){data, size});
}

/* ------------------------------------------------------------------------------------------------ paths, fits */

static void draw_path(const void *input, struct outcome *out) {
    (void)input;
    narc_path *path = NULL;
    watch_all(true);
    out->status = narc_create_path(&path);
    if (out->status)
        strcpy(out->error.message, "no memory");
    for (int k = 0; k < 200 && !out->status; k++) {
        const narc_point p = {k % 20, k * k % 17}, c = {k % 7, k % 11};
        out->status = k % 50 == 0  ? narc_move_to(path, &p, &out->error)
                      : k % 3 == 0 ? narc_cubic_to(path, &c, &p, &p, &out->error)
                                   : narc_line_to(path, &p, &out->error);
    }
    watch_all(false);
    out->path = path;
}

static void compute_hull(const void *input, struct outcome *out) {
    const struct outline *of = input;
    AUTO(free_at) narc_point *corners = malloc(of->count * sizeof *corners);
    size_t count = SIZE_MAX;
    assert_non_null(corners);
    corners[0] = (narc_point){7, 7};
    watch_all(true);
    out->status = narc_compute_hull(of->points, of->count, corners, &count, &out->error);
    watch_all(false);
    out->untouched = out->status == NARC_OK || (count == SIZE_MAX && corners[0].x == 7 && corners[0].y == 7);
}

static void flatten_path(const void *input, struct outcome *out) {
    const struct outline *of = input;
    narc_contours contours = {.count = 77};
    watch_all(true);
    out->status = narc_flatten_path(of->path, 0, &contours, &out->error);
    watch_all(false);
    out->untouched = contours.count == 77;
    if (out->status == NARC_OK)
        narc_release_contours(&contours);
}

static void fit_chains(const void *input, struct outcome *out) {
    const struct outline *of = input;
    watch_all(true);
    out->status = narc_fit_chains(of->path, 1e-3, false, &out->chains, &out->error);
    watch_all(false);
    out->untouched = out->chains.arc_count == 0 && !out->chains.arcs;
}

static void cut_path(const void *input, struct outcome *out) {
    const struct outline *of = input;
    narc_parts parts = {.count = 77};
    watch_all(true);
    out->status =
        narc_cut_path(of->path, &(narc_parts_request){.most = 40, .tolerance = 0.05, .lap = 0.01}, &parts, &out->error);
    watch_all(false);
    out->untouched = parts.count == 77;
    if (out->status == NARC_OK)
        narc_release_parts(&parts);
}

TEST(test_paths) {
    if (!CAN_FAIL)
        skip();
    struct test_random random = test_random_named("memory");
    struct outline blob = make_blob(&random, 12), star = make_star(), polygon = make_regular("polygon", 300, 0, 1);
    fail_all("drawing", draw_path, NULL);
    fail_all("hull", compute_hull, &star);
    fail_all("flattening", flatten_path, &blob);
    fail_all("parts", cut_path, &star);
    fail_all("chains of curves", fit_chains, &blob);
    fail_all("chains of lines", fit_chains, &polygon);
    free_outline(&blob);
    free_outline(&star);
    free_outline(&polygon);
}

struct wanted {
    const narc_path *path;
    narc_fit_request request;
};

static void fit_path(const void *input, struct outcome *out) {
    const struct wanted *wanted = input;
    static narc_fit_result before;
    memset(&before, 0x5a, sizeof before);
    out->fit = before;
    watch_all(true);
    out->status = narc_fit_path(wanted->path, &wanted->request, &out->fit, &out->error);
    watch_all(false);
    out->untouched = memcmp(&before, &out->fit, sizeof before) == 0;
}

TEST(test_fits) {
    static const narc_fit_request requests[] = {
        {.arc_count = 4, .starts = 1},
        {.arc_count = 4, .starts = 1, .family = NARC_FIT_EDGES, .goal = NARC_FIT_DISTANCE},
        {.arc_count = 4, .starts = 1, .family = NARC_FIT_POLYGON, .goal = NARC_FIT_BOUND_PERIMETER},
        {.arc_count = 4, .starts = 1, .family = NARC_FIT_PAPER},
        {.arc_count = 4, .starts = 1, .goal = NARC_FIT_DIFFERENCE, .min_radius = 0.1},
        {.tolerance = 0.2, .starts = 1, .goal = NARC_FIT_BOUND_DISTANCE},
    };
    if (!CAN_FAIL)
        skip();
    struct outline star = make_star();
    for (size_t k = 0; k < sizeof requests / sizeof requests[0]; k += stride(4)) {
        char name[20];
        snprintf(name, sizeof name, "fit %zu", k);
        fail_all(name, fit_path, &(struct wanted){star.path, requests[k]});
    }
    free_outline(&star);
}

int main(int count, char **arguments) {
    font_name = count > 1 ? arguments[1] : NULL;
    return test_begin() ? test_run("memory", NULL, NULL) : TEST_SKIPPED;
}
