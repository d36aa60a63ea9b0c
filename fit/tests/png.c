/* SPDX-License-Identifier: MIT
 *
 * png.c - silhouettes in PNG images: where contours are, formats, which channel counts, opaque tiles.
 */
#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

#include "png_files.h"

enum { FULL = 65535 };

static const struct png_format gray_alpha_8 = {8, PNG_COLOR_TYPE_GRAY_ALPHA, false};
static const struct png_format gray_alpha_16 = {16, PNG_COLOR_TYPE_GRAY_ALPHA, false};

static void expect_points(struct png_file file, double threshold, const narc_point *points, size_t count,
                          double tolerance) {
    AUTO(narc_release_contours) narc_contours contours = read_png(file, threshold);
    assert_int_equal(contours.count, 1);
    assert_int_equal(contours.point_count, count);
    for (size_t k = 0; k < count; k++) {
        const narc_point p = contours.points[k];
        if (!(fabs(p.x - points[k].x) <= tolerance && fabs(p.y - points[k].y) <= tolerance))
            fail_msg("point %zu is (%.17g, %.17g)", k, p.x, p.y);
    }
    free(file.bytes);
}

/* ---------------------------------------------------------------------------- where contours are */

/* Values between two samples are linear: from `value` at a pixel's centre to 0 at its neighbour's, a threshold is
 * passed (value - threshold) / value behind the centre. The level is between two of 65535 steps, at most half of one
 * off. */
TEST(passes_between_centres) {
    static const struct {
        unsigned value;
        double threshold, reach;
    } cases[] = {{FULL, 0, 0.5}, {FULL, 0.5, 0.5}, {FULL, 0.25, 0.75}, {FULL, 0.9, 0.1}, {FULL / 5 * 4, 0.2, 0.75}};
    for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
        const double r = cases[k].reach;
        uint16_t alpha[9] = {0}, gray[9] = {0};
        alpha[4] = (uint16_t)cases[k].value;
        /* Round the middle of 3 x 3 pixels, counter-clockwise from the west. */
        const narc_point middle[4] = {{1.5 - r, 1.5}, {1.5, 1.5 - r}, {1.5 + r, 1.5}, {1.5, 1.5 + r}};
        expect_points(write_png(gray_alpha_16, 3, 3, gray, alpha), cases[k].threshold, middle, 4, 1.0 / FULL);
        /* An image of one pixel: what surrounds it is outside. */
        const narc_point only[4] = {{0.5 - r, 0.5}, {0.5, 0.5 - r}, {0.5 + r, 0.5}, {0.5, 0.5 + r}};
        if (cases[k].value < FULL)
            expect_points(write_png(gray_alpha_16, 1, 1, gray, alpha + 4), cases[k].threshold, only, 4, 1.0 / FULL);
    }
    /* The upper right pixel of 3 x 2: y is up. */
    uint16_t alpha[6] = {0, 0, FULL}, gray[6] = {0};
    const narc_point corner[4] = {{2, 1.5}, {2.5, 1}, {3, 1.5}, {2.5, 2}};
    expect_points(write_png(gray_alpha_8, 3, 2, gray, alpha), 0, corner, 4, 0);
}

/* How far from a straight edge the contour is, for pixels that are covered exactly: the crossing on a line of pixels
 * that meets the edge at `angle`. For an edge across the line and a pixel whose centre is a <= 1/2 inside, the two
 * values are 1/2 + a and 0, so the crossing is a / (1/2 + a) from that centre instead of a. The difference a (1/2 - a)
 * / (1/2 + a) is largest at a = (sqrt 2 - 1) / 2: 3/2 - sqrt 2. Other angles have no more: of 90
 * angles and 50 places of the edge none has. */
static const double EDGE_ERROR = 1.5 - 1.4142135623730951;

/* The part of a pixel that a disc covers, in strips: each of exact height in its middle. */
static double cover_disc(double x, double y, double radius) {
    enum { STRIPS = 256 };
    double sum = 0;
    for (int k = 0; k < STRIPS; k++) {
        const double u = x - 0.5 + (k + 0.5) / STRIPS, square = radius * radius - u * u;
        const double half = square > 0 ? sqrt(square) : 0;
        sum += fmax(0, fmin(y + 0.5, half) - fmax(y - 0.5, -half));
    }
    return sum / STRIPS;
}

/* A disc is between two half planes near its outline: that of the tangent at the nearest point, and the same moved in
 * by d^2 / (2 R), d being how far points of the two pixels in question can be from there: hypot(3/2, 1/2) and the error
 * itself, 1.67. Coverage grows with what is covered, so the crossing is between those of the half planes. Values are
 * rounded to `step`, half of it at most, which the slope of 1/2 or more turns into as much of a pixel as a step is. A
 * sum over 256 strips is off by at most half a strip's width times how much the heights vary, which is 1 at each of two
 * sides: 1/256, and twice that of a pixel. */
TEST(keeps_the_place_of_discs) {
    enum { SIZE = 64 };
    struct test_random random = test_random_named("png discs");
    static const struct {
        struct png_format format;
        double step;
    } kinds[] = {{{8, PNG_COLOR_TYPE_RGB_ALPHA, false}, 1.0 / 255},
                 {{16, PNG_COLOR_TYPE_GRAY_ALPHA, true}, 1.0 / FULL},
                 {{8, PNG_COLOR_TYPE_GRAY, false}, 1.0 / 255}};
    for (size_t trial = 0; trial < test_trials(30); trial++) {
        const double radius = random_between(&random, 10, 28), x = random_between(&random, 30, 34),
                     y = random_between(&random, 30, 34);
        uint16_t alpha[SIZE * SIZE], gray[SIZE * SIZE];
        for (size_t k = 0; k < SIZE * SIZE; k++) {
            const double column = (double)(k % SIZE) + 0.5, row = SIZE - (double)(k / SIZE) - 0.5;
            alpha[k] = (uint16_t)lround(FULL * fmin(1, cover_disc(column - x, row - y, radius)));
            gray[k] = (uint16_t)(FULL - alpha[k]); /* black on white */
        }
        AUTO(free_at) const struct png_file file = write_png(kinds[trial % 3].format, SIZE, SIZE, gray, alpha);
        AUTO(narc_release_contours)
        narc_contours contours =
            read_silhouette(file, (narc_image_request){trial % 3 == 2 ? NARC_SILHOUETTE_DARK : NARC_SILHOUETTE_ALPHA,
                                                       .threshold = 0.5});
        assert_int_equal(contours.count, 1);
        const double bound = EDGE_ERROR + 1.67 * 1.67 / (2 * radius) + kinds[trial % 3].step + 2.0 / 256;
        for (size_t k = 0; k < contours.point_count; k++) {
            const double off = hypot(contours.points[k].x - x, contours.points[k].y - y) - radius;
            if (!(fabs(off) <= bound))
                fail_msg("radius %g: a point is %g off; at most %g is right", radius, off, bound);
        }
        /* It goes round once: a crossing in each row and each column that it meets, to both sides. */
        const double round = (double)contours.point_count;
        assert_true(round > 7 * radius && round < 9 * radius);
    }
}

/* ---------------------------------------------------------------------------- contours are right */

struct segment {
    narc_point a, b;
};

/* A segment of the marching squares, by the cell's crossings at its sides: 0 below, 1 right, 2 above, 3 left. */
static size_t add_cell(const double v[4], double level, double x, double y, struct segment *segments) {
    /* Corners: 0 lower left, then counter-clockwise; side k is from corner k to k + 1. */
    static const narc_point corners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    narc_point crossings[4];
    int sides[4], count = 0;
    for (int k = 0; k < 4; k++) {
        const int next = (k + 1) % 4;
        if ((v[k] > level) != (v[next] > level)) {
            const double t = (level - v[k]) / (v[next] - v[k]);
            crossings[count] = (narc_point){x + corners[k].x + t * (corners[next].x - corners[k].x),
                                            y + corners[k].y + t * (corners[next].y - corners[k].y)};
            sides[count++] = k;
        }
    }
    if (count == 2) {
        segments[0] = (struct segment){crossings[0], crossings[1]};
    } else if (count == 4) {
        /* A saddle: corners on the other side of the level than the middle are cut off. Corner k is between sides
         * k - 1 and k. */
        const bool high = v[0] + v[1] + v[2] + v[3] > 4 * level;
        const int first = (v[0] > level) != high ? 0 : 1;
        for (int k = 0; k < 2; k++) {
            const int corner = first + 2 * k;
            segments[k] = (struct segment){crossings[(corner + 3) % 4], crossings[corner]};
        }
    }
    (void)sides;
    return (size_t)count / 2;
}

static bool is_near(narc_point a, narc_point b) { return fabs(a.x - b.x) < 1e-9 && fabs(a.y - b.y) < 1e-9; }

/* On random small images: the contours' sides are exactly the segments of all cells, each once, with what is above the
 * level on their left. */
TEST(follows_all_cells) {
    enum { WIDTH = 9, HEIGHT = 7, MOST = 2 * (WIDTH + 1) * (HEIGHT + 1) };
    struct test_random random = test_random_named("png cells");
    for (size_t trial = 0; trial < test_trials(500); trial++) {
        uint16_t alpha[WIDTH * HEIGHT], gray[WIDTH * HEIGHT] = {0};
        for (size_t k = 0; k < WIDTH * HEIGHT; k++)
            alpha[k] = (uint16_t)(257 * (trial % 2 ? random_below(&random, 256) : 255 * random_below(&random, 2)));
        alpha[0] = 0;
        alpha[20] = FULL;
        const double threshold = random_between(&random, 0.01, 0.99), level = floor(threshold * FULL) + 0.5;
        struct segment segments[MOST];
        size_t count = 0;
        for (int y = -1; y < HEIGHT; y++) { /* rows from below */
            for (int x = -1; x < WIDTH; x++) {
                double v[4];
                for (int k = 0; k < 4; k++) {
                    const int column = x + (k == 1 || k == 2), row = HEIGHT - 1 - (y + k / 2);
                    const bool inside = column >= 0 && column < WIDTH && row >= 0 && row < HEIGHT;
                    v[k] = inside ? alpha[row * WIDTH + column] : 0;
                }
                count += add_cell(v, level, x + 0.5, y + 0.5, segments + count);
            }
        }
        AUTO(free_at) const struct png_file file = write_png(gray_alpha_8, WIDTH, HEIGHT, gray, alpha);
        AUTO(narc_release_contours) narc_contours contours = read_png(file, threshold);
        assert_int_equal(contours.point_count, count);
        for (size_t k = 0, first = 0; k < contours.count; first = contours.ends[k++]) {
            for (size_t i = first; i < contours.ends[k]; i++) {
                const narc_point a = contours.points[i], b = contours.points[i + 1 < contours.ends[k] ? i + 1 : first];
                size_t found = 0;
                while (found < count && !(is_near(segments[found].a, a) && is_near(segments[found].b, b)) &&
                       !(is_near(segments[found].a, b) && is_near(segments[found].b, a)))
                    found++;
                assert_true(found < count);
                segments[found] = segments[--count];
            }
        }
        assert_int_equal(count, 0);
    }
}

/* A ring of 5 x 5 pixels round a hole of 1, at the border of the image: a square of 5 with corners cut by 1/8 each, and
 * a diamond of area 1/2 the other way round. Contours do not cross. */
TEST(turns_round_holes_the_other_way) {
    uint16_t alpha[25], gray[25] = {0};
    for (size_t k = 0; k < 25; k++)
        alpha[k] = k == 12 ? 0 : FULL;
    AUTO(free_at) const struct png_file file = write_png(gray_alpha_8, 5, 5, gray, alpha);
    AUTO(narc_release_contours) narc_contours contours = read_png(file, 0);
    assert_int_equal(contours.count, 2);
    assert_true(measure_area(&contours, 0) == 25 - 4 * 0.125);
    assert_true(measure_area(&contours, 1) == -0.5);
}

/* ---------------------------------------------------------------------------- formats */

/* A blob of which all pixels are one of 16 levels, or one of 2. */
static void make_blob(uint16_t *values, size_t width, size_t height, bool two) {
    for (size_t k = 0; k < width * height; k++) {
        const double x = (double)(k % width) - 5.3, y = (double)(k / width) - 6.1;
        const double level = fmin(15, fmax(0, 8 * (5.2 - hypot(x, 0.8 * y + 0.2 * x))));
        values[k] = (uint16_t)(two ? (level > 7 ? FULL : 0) : 4369 * (unsigned)level);
    }
}

static void expect_same(const narc_contours *expected, struct png_file file, narc_silhouette silhouette,
                        double tolerance, const char *what) {
    AUTO(narc_release_contours)
    narc_contours contours = read_silhouette(file, (narc_image_request){silhouette, .threshold = 0.5});
    if (contours.count != expected->count || contours.point_count != expected->point_count)
        fail_msg("%s: %zu points, not %zu", what, contours.point_count, expected->point_count);
    for (size_t k = 0; k < contours.point_count; k++) {
        const narc_point a = contours.points[k], b = expected->points[k];
        if (!(fabs(a.x - b.x) <= tolerance && fabs(a.y - b.y) <= tolerance))
            fail_msg("%s: point %zu is (%.17g, %.17g), not (%.17g, %.17g)", what, k, a.x, a.y, b.x, b.y);
    }
    free(file.bytes);
}

/* The same blob in formats of each kind: as alpha, dark, and light; opaque, and on nothing. Grays of 16 bits are known
 * to 11 bits; where neighbouring values differ by 1/15 or more, as on both sides of the threshold, that is up to 15
 * / 2^11 of a pixel. */
TEST(reads_each_kind_of_format) {
    enum { WIDTH = 13, HEIGHT = 11, COUNT = WIDTH * HEIGHT };
    for (int two = 0; two < 2; two++) {
        uint16_t blob[COUNT], inverse[COUNT], full[COUNT], none[COUNT] = {0};
        make_blob(blob, WIDTH, HEIGHT, two);
        for (size_t k = 0; k < COUNT; k++) {
            inverse[k] = (uint16_t)(FULL - blob[k]);
            full[k] = FULL;
        }
        AUTO(free_at) const struct png_file file = write_png(gray_alpha_8, WIDTH, HEIGHT, full, blob);
        AUTO(narc_release_contours) narc_contours expected = read_png(file, 0.5);
        for (int depth = 8; depth <= 16; depth *= 2) {
            const struct png_format gray = {depth, PNG_COLOR_TYPE_GRAY, false};
            const struct png_format gray_alpha = {depth, PNG_COLOR_TYPE_GRAY_ALPHA, false};
            const struct png_format rgb = {depth, PNG_COLOR_TYPE_RGB, false};
            const struct png_format rgb_alpha = {depth, PNG_COLOR_TYPE_RGB_ALPHA, true};
            const double near = depth == 16 ? 15.0 / 2048 : 0;
            expect_same(&expected, write_png(gray, WIDTH, HEIGHT, inverse, NULL), NARC_SILHOUETTE_DARK, near,
                        "dark gray");
            expect_same(&expected, write_png(gray, WIDTH, HEIGHT, blob, NULL), NARC_SILHOUETTE_LIGHT, near,
                        "light gray");
            expect_same(&expected, write_png(rgb, WIDTH, HEIGHT, inverse, NULL), NARC_SILHOUETTE_DARK, near, "dark");
            expect_same(&expected, write_png(rgb_alpha, WIDTH, HEIGHT, inverse, full), NARC_SILHOUETTE_DARK, near,
                        "dark, opaque");
            expect_same(&expected, write_png(rgb_alpha, WIDTH, HEIGHT, full, blob), NARC_SILHOUETTE_ALPHA, 0,
                        "alpha, white");
            expect_same(&expected, write_png(rgb_alpha, WIDTH, HEIGHT, inverse, blob), NARC_SILHOUETTE_ALPHA, 0,
                        "alpha, colours");
            expect_same(&expected, write_png(gray_alpha, WIDTH, HEIGHT, none, blob), NARC_SILHOUETTE_DARK, near,
                        "dark, on nothing");
            expect_same(&expected, write_png(rgb_alpha, WIDTH, HEIGHT, full, blob), NARC_SILHOUETTE_LIGHT, near,
                        "light, on nothing");
            expect_same(&expected, write_png(gray_alpha, WIDTH, HEIGHT, blob, full), NARC_SILHOUETTE_LIGHT, near,
                        "gray, opaque");
        }
        const struct png_format palette = {8, PNG_COLOR_TYPE_PALETTE, false};
        expect_same(&expected, write_png(palette, WIDTH, HEIGHT, inverse, NULL), NARC_SILHOUETTE_DARK, 0, "palette");
        expect_same(&expected, write_png(palette, WIDTH, HEIGHT, inverse, blob), NARC_SILHOUETTE_ALPHA, 0,
                    "palette with alpha");
    }
}

/* ---------------------------------------------------------------------------- opaque tiles */

/* Textures of a game's tiles: pixel (x, y) of `size`. */
static unsigned paint_tile(int texture, size_t x, size_t y, size_t size, struct test_random *random) {
    switch (texture) {
    case 0: /* plain, dark or light */
        return 0;
    case 1:
        return FULL;
    case 2: /* stripes, a board, a slope */
        return x / 3 % 2 ? FULL : 9000;
    case 3:
        return (x / 4 + y / 4) % 2 ? 60000 : 20000;
    case 4:
        return (unsigned)(FULL * (x + y) / (2 * size));
    case 5: /* noise; dark with a light border, light with a dark one */
        return (unsigned)random_below(random, FULL + 1);
    case 6:
        return x == 0 || y == 0 || x + 1 == size || y + 1 == size ? FULL : 3000;
    default:
        return x == 0 || y == 0 || x + 1 == size || y + 1 == size ? 0 : 50000;
    }
}

/* Whatever an opaque tile shows, and however it is stored, its outline is the tile, and the caller is told. */
TEST(takes_opaque_tiles_whole) {
    enum { SIZE = 32, TEXTURES = 8 };
    static const struct png_format formats[] = {
        {8, PNG_COLOR_TYPE_GRAY, false}, {8, PNG_COLOR_TYPE_RGB, true},        {8, PNG_COLOR_TYPE_RGB_ALPHA, false},
        {16, PNG_COLOR_TYPE_GRAY, true}, {16, PNG_COLOR_TYPE_RGB_ALPHA, true}, {8, PNG_COLOR_TYPE_PALETTE, false}};
    struct test_random random = test_random_named("png tiles");
    uint16_t gray[SIZE * SIZE], full[SIZE * SIZE];
    for (int texture = 0; texture < TEXTURES; texture++) {
        for (size_t k = 0; k < SIZE * SIZE; k++) {
            gray[k] = (uint16_t)paint_tile(texture, k % SIZE, k / SIZE, SIZE, &random);
            full[k] = FULL;
        }
        for (size_t f = 0; f < sizeof formats / sizeof formats[0]; f++) {
            const bool palette = formats[f].color_type == PNG_COLOR_TYPE_PALETTE;
            const size_t height = 1 + 31 * (f % 2);
            AUTO(free_at) struct png_file file = write_png(formats[f], SIZE, height, gray, palette ? NULL : full);
            for (double threshold = 0; threshold < 1; threshold += 0.45) {
                bool whole = false;
                AUTO(narc_release_contours)
                narc_contours contours =
                    read_silhouette(file, (narc_image_request){.threshold = threshold, .out_whole = &whole});
                assert_true(whole);
                assert_int_equal(contours.point_count, 4);
                assert_true(measure_area(&contours, 0) == (double)(SIZE * height));
            }
        }
    }
}

/* One transparent pixel, and the image is not opaque; dark and light count apart, in opaque tiles too. */
TEST(tells_what_is_whole) {
    enum { SIZE = 8, COUNT = SIZE * SIZE };
    uint16_t gray[COUNT], alpha[COUNT], dark[COUNT] = {0};
    for (size_t k = 0; k < COUNT; k++) {
        gray[k] = k % SIZE < 3 ? 10000 : 60000;
        alpha[k] = k == 0 ? 0 : FULL;
    }
    static const double areas[] = {SIZE * SIZE, 3 * SIZE, 5 * SIZE};
    for (int silhouette = NARC_SILHOUETTE_ALPHA; silhouette <= NARC_SILHOUETTE_LIGHT; silhouette++) {
        bool whole = silhouette != NARC_SILHOUETTE_ALPHA;
        AUTO(free_at)
        struct png_file file = write_png((struct png_format){8, PNG_COLOR_TYPE_GRAY, false}, SIZE, SIZE, gray, NULL);
        AUTO(narc_release_contours)
        narc_contours contours = read_silhouette(
            file, (narc_image_request){(narc_silhouette)silhouette, .threshold = 0.5, .out_whole = &whole});
        assert_int_equal(whole, silhouette == NARC_SILHOUETTE_ALPHA);
        /* Grays of 39 and 234 of 255: darknesses pass 127.5 0.454 pixels behind the centre of the dark one, lightnesses
         * 0.546 before that of the light one, and at the borders 0.41 and 0.455 outside of centres. Corners are cut. */
        assert_true(fabs(measure_area(&contours, 0) - areas[silhouette]) <= 0.1 * (2 * SIZE + 10) + 0.5);
    }
    bool whole = true;
    struct png_file file = write_png(gray_alpha_8, SIZE, SIZE, gray, alpha);
    narc_contours contours = read_silhouette(file, (narc_image_request){.out_whole = &whole});
    assert_false(whole);
    narc_release_contours(&contours);
    free(file.bytes);
    file = write_png((struct png_format){8, PNG_COLOR_TYPE_GRAY, false}, SIZE, SIZE, dark, NULL);
    contours = read_silhouette(file, (narc_image_request){NARC_SILHOUETTE_DARK, .out_whole = &whole});
    assert_true(whole);
    narc_release_contours(&contours);
    free(file.bytes);
}

TEST_MAIN("PNG")
