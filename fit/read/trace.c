/* SPDX-License-Identifier: MIT
 *
 * trace.c - contours of an image by marching squares, each followed from cell to cell until it closes.
 */
#include "read/trace.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"

/* The four neighbours counter-clockwise (rows grow downwards): east, north, west, south. */
enum { EAST, NORTH, WEST, SOUTH };
static const ptrdiff_t step_column[4] = {1, 0, -1, 0}, step_row[4] = {0, -1, 0, 1};

struct tracer {
    const narc_image *image;
    double level;
    narc_bits fresh; /* samples above the level, those to their west not, whose contour was not followed yet */
};

/* Where a contour crosses from one sample, which is above the level, to its neighbour, which is not. */
struct crossing {
    ptrdiff_t column, row;
    int side;
};

static bool is_set(const narc_bits *bits, size_t column, size_t row) {
    return bits->words[row * bits->stride + column / 64] >> column % 64 & 1;
}

static double sample(const struct tracer *t, ptrdiff_t column, ptrdiff_t row) {
    const narc_image *image = t->image;
    const bool inside = column >= 0 && row >= 0 && (size_t)column < image->width && (size_t)row < image->height;
    if (!inside)
        return 0;
    if (image->samples)
        return image->samples[(size_t)row * image->width + (size_t)column];
    return is_set(&image->bits, (size_t)column, (size_t)row) ? UINT16_MAX : 0;
}

static double neighbour(const struct tracer *t, struct crossing crossing, int side) {
    return sample(t, crossing.column + step_column[side], crossing.row + step_row[side]);
}

static narc_point locate(const struct tracer *t, struct crossing crossing) {
    const double high = sample(t, crossing.column, crossing.row), low = neighbour(t, crossing, crossing.side);
    const double part = (high - t->level) / (high - low);
    const double x = (double)crossing.column + 0.5 + part * (double)step_column[crossing.side];
    const double y = (double)t->image->height - (double)crossing.row - 0.5 - part * (double)step_row[crossing.side];
    return (narc_point){t->image->origin.x + t->image->pixel * x, t->image->origin.y + t->image->pixel * y};
}

/* The next crossing with what is above on the left. The contour goes on through the cell ahead, whose corners are the
 * crossing's two samples P (above) and Q, and the next ones in the walking direction, R beside P and S beside Q:
 *
 *        R  S      It leaves between P and R if R is low, between R and S if only S is low, else between S and Q.
 *        P ^ Q     If R is low and S is high, the cell is a saddle: P and S are connected if the middle is high.
 */
static struct crossing advance(const struct tracer *t, struct crossing crossing) {
    const int ahead = (crossing.side + 1) % 4;
    const struct crossing r = {crossing.column + step_column[ahead], crossing.row + step_row[ahead], crossing.side};
    const struct crossing s = {r.column + step_column[crossing.side], r.row + step_row[crossing.side], (ahead + 2) % 4};
    const double r_value = sample(t, r.column, r.row), s_value = sample(t, s.column, s.row);
    if (r_value > t->level)
        return s_value > t->level ? s : r;
    if (s_value > t->level) {
        const double sum =
            sample(t, crossing.column, crossing.row) + neighbour(t, crossing, crossing.side) + r_value + s_value;
        if (sum > 4 * t->level)
            return s;
    }
    return (struct crossing){crossing.column, crossing.row, ahead};
}

static narc_status follow(const struct tracer *t, struct crossing start, narc_path *path, narc_error *error) {
    struct crossing crossing = start;
    narc_point place = locate(t, start);
    narc_status status = narc_move_to(path, &place, error);
    while (!status) {
        if (crossing.side == WEST)
            t->fresh.words[(size_t)crossing.row * t->fresh.stride + (size_t)crossing.column / 64] &=
                ~((uint64_t)1 << crossing.column % 64);
        crossing = advance(t, crossing);
        if (crossing.column == start.column && crossing.row == start.row && crossing.side == start.side)
            return NARC_OK;
        place = locate(t, crossing);
        status = narc_line_to(path, &place, error);
    }
    return status;
}

/* The samples of a row above the level whose neighbour to the west is not. */
static void list_wests(const struct tracer *t, size_t row) {
    const narc_image *image = t->image;
    uint64_t *const out = t->fresh.words + row * t->fresh.stride;
    uint64_t before = 0;
    for (size_t k = 0; k < t->fresh.stride; k++) {
        uint64_t above = 0;
        if (image->samples)
            for (size_t x = 64 * k; x < 64 * k + 64 && x < image->width; x++)
                above |= (uint64_t)(image->samples[row * image->width + x] > t->level) << x % 64;
        else
            above = image->bits.words[row * image->bits.stride + k];
        out[k] = above & ~(above << 1 | before >> 63);
        before = above;
    }
}

static unsigned lowest_bit(uint64_t word) {
    unsigned bit = 0;
    for (unsigned half = 32; half > 0; half /= 2)
        if ((word >> bit & (((uint64_t)1 << half) - 1)) == 0)
            bit += half;
    return bit;
}

/* Every contour passes the west side of some sample above the level: of the leftmost that it goes round, or, if it is a
 * hole, of the one to the right of the hole. */
narc_status narc_trace_image(const narc_image *image, double level, narc_path *path, narc_error *error) {
    const size_t stride = (image->width + 63) / 64, count = stride * image->height;
    struct tracer t = {image, level, {malloc(count * sizeof *t.fresh.words + 1), stride}};
    if (!t.fresh.words)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for the outline of the image");
    narc_status status = NARC_OK;
    for (size_t row = 0; row < image->height; row++)
        list_wests(&t, row);
    for (size_t k = 0; k < count; k++)
        while (t.fresh.words[k] && !status) {
            const size_t column = 64 * (k % stride) + lowest_bit(t.fresh.words[k]);
            status = follow(&t, (struct crossing){(ptrdiff_t)column, (ptrdiff_t)(k / stride), WEST}, path, error);
        }
    free(t.fresh.words);
    return status;
}

narc_status narc_check_image_request(const void *data, const narc_image_request *request, const narc_path *path,
                                     narc_error *error) {
    const double threshold = request->threshold;
    if (!data || !path)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, data ? "path is NULL" : "data is NULL");
    if ((unsigned)request->silhouette > NARC_SILHOUETTE_LIGHT) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, request->silhouette, "there is no silhouette %d",
                         (int)request->silhouette);
    }
    if (!(threshold >= 0 && threshold < 1)) {
        return narc_fail(error, isnan(threshold) ? NARC_ERROR_NOT_FINITE : NARC_ERROR_SIZE, 0, threshold,
                         "threshold is %g; it must be between 0 and 1", threshold);
    }
    return NARC_OK;
}
