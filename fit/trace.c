/* SPDX-License-Identifier: MIT
 *
 * trace.c - contours of an image by marching squares, each followed from cell to cell until it closes.
 */
#include "trace.h"

#include <stdlib.h>

#include "error.h"

/* The four neighbours counter-clockwise (rows grow downwards): east, north, west, south. */
enum { EAST, NORTH, WEST, SOUTH };
static const ptrdiff_t step_column[4] = {1, 0, -1, 0}, step_row[4] = {0, -1, 0, 1};

struct tracer {
    const narc_image *image;
    double level;
    unsigned char *seen; /* a bit for each sample: its crossing to the west belongs to a contour that was followed */
};

/* Where a contour crosses from one sample, which is above the level, to its neighbour, which is not. */
struct crossing {
    ptrdiff_t column, row;
    int side;
};

static double sample(const struct tracer *t, ptrdiff_t column, ptrdiff_t row) {
    const narc_image *image = t->image;
    const bool inside = column >= 0 && row >= 0 && (size_t)column < image->width && (size_t)row < image->height;
    return inside ? image->samples[(size_t)row * image->width + (size_t)column] : 0;
}

static double neighbour(const struct tracer *t, struct crossing at, int side) {
    return sample(t, at.column + step_column[side], at.row + step_row[side]);
}

static narc_point locate(const struct tracer *t, struct crossing at) {
    const double high = sample(t, at.column, at.row), low = neighbour(t, at, at.side);
    const double part = (high - t->level) / (high - low);
    return (narc_point){(double)at.column + 0.5 + part * (double)step_column[at.side],
                        (double)t->image->height - (double)at.row - 0.5 - part * (double)step_row[at.side]};
}

/* The next crossing with what is above on the left. The contour goes on through the cell ahead, whose corners are the
 * crossing's two samples P (above) and Q, and the next ones in the walking direction, R beside P and S beside Q:
 *
 *        R  S      It leaves between P and R if R is low, between R and S if only S is low, else between S and Q.
 *        P ^ Q     If R is low and S is high, the cell is a saddle: P and S are connected if the middle is high.
 */
static struct crossing advance(const struct tracer *t, struct crossing at) {
    const int ahead = (at.side + 1) % 4;
    const struct crossing r = {at.column + step_column[ahead], at.row + step_row[ahead], at.side};
    const struct crossing s = {r.column + step_column[at.side], r.row + step_row[at.side], (ahead + 2) % 4};
    const double r_value = sample(t, r.column, r.row), s_value = sample(t, s.column, s.row);
    if (r_value > t->level) {
        return s_value > t->level ? s : r;
    }
    if (s_value > t->level) {
        const double sum = sample(t, at.column, at.row) + neighbour(t, at, at.side) + r_value + s_value;
        if (sum > 4 * t->level) {
            return s;
        }
    }
    return (struct crossing){at.column, at.row, ahead};
}

static size_t bit_of(const struct tracer *t, struct crossing at) {
    return (size_t)at.row * t->image->width + (size_t)at.column;
}

static narc_status follow(const struct tracer *t, struct crossing start, narc_path *path) {
    struct crossing at = start;
    narc_status status = narc_move_to(path, locate(t, start), NULL);
    while (!status) {
        if (at.side == WEST) {
            const size_t bit = bit_of(t, at);
            t->seen[bit / 8] = (unsigned char)(t->seen[bit / 8] | 1u << bit % 8);
        }
        at = advance(t, at);
        if (at.column == start.column && at.row == start.row && at.side == start.side) {
            return NARC_OK;
        }
        status = narc_line_to(path, locate(t, at), NULL);
    }
    return status;
}

/* Every contour passes the west side of some sample above the level: of the leftmost that it goes round, or, if it is a
 * hole, of the one to the right of the hole. */
narc_status narc_trace_image(const narc_image *image, double level, narc_path *path, narc_error *error) {
    struct tracer t = {image, level, calloc(image->width * image->height / 8 + 1, 1)};
    narc_status status = t.seen ? NARC_OK : NARC_ERROR_MEMORY;
    for (size_t row = 0; row < image->height && !status; row++) {
        for (size_t column = 0; column < image->width && !status; column++) {
            const struct crossing at = {(ptrdiff_t)column, (ptrdiff_t)row, WEST};
            const size_t bit = bit_of(&t, at);
            if (sample(&t, at.column, at.row) > level && neighbour(&t, at, WEST) < level &&
                !(t.seen[bit / 8] >> bit % 8 & 1)) {
                status = follow(&t, at, path);
            }
        }
    }
    free(t.seen);
    return status ? narc_fail(error, status, 0, 0, "no memory for the outline of the image") : NARC_OK;
}
