/* SPDX-License-Identifier: MIT
 *
 * reference.c - the separation by searching all directions, and piece by piece.
 */
#include "reference.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static const double full_turn = 6.283185307179586476925;

/* Directions sampled besides the junctions. */
enum { SAMPLES = 128, DIRECTIONS = SAMPLES + 2 * NARC_MAX_ARCS };

/* The search around a maximum stops at this angle: g is flat there, so what is missing is its square times the size. */
static const double angle_resolution = 1e-10;

/* A body's arcs in world axes, relative to its position. */
struct posed {
    size_t count;
    double center_x[NARC_MAX_ARCS], center_y[NARC_MAX_ARCS], radius[NARC_MAX_ARCS];
    double start[NARC_MAX_ARCS]; /* 0 .. full_turn */
};

struct posed_pair {
    struct posed a, b;
    double offset_x, offset_y; /* from A's position to B's */
};

static double wrap(double angle) {
    angle = fmod(angle, full_turn);
    return angle < 0 ? angle + full_turn : angle;
}

static void pose(const struct reference_body *body, struct posed *out) {
    assert(body->count <= NARC_MAX_ARCS);
    double turn = atan2(body->sine, body->cosine), length = hypot(body->sine, body->cosine) * body->scale;
    double c = body->cosine * body->scale, s = body->sine * body->scale;
    out->count = body->count;
    for (size_t i = 0; i < body->count; i++) {
        const narc_arc *arc = &body->arcs[i];
        out->center_x[i] = c * arc->center_x - s * arc->center_y;
        out->center_y[i] = s * arc->center_x + c * arc->center_y;
        out->radius[i] = arc->radius * length;
        out->start[i] = wrap(arc->start + turn);
    }
}

static struct posed_pair pose_pair(const struct reference_body *a, const struct reference_body *b) {
    struct posed_pair pair = {.offset_x = b->x - a->x, .offset_y = b->y - a->y};
    pose(a, &pair.a);
    pose(b, &pair.b);
    return pair;
}

/* h(v): the arc whose sector holds v is the one whose start was passed last, going counter-clockwise. */
static double support(const struct posed *shape, double angle, double v_x, double v_y) {
    double least = INFINITY;
    size_t holder = 0;
    for (size_t i = 0; i < shape->count; i++) {
        double passed = angle - shape->start[i];
        passed = passed < 0 ? passed + full_turn : passed;
        if (passed < least) {
            least = passed;
            holder = i;
        }
    }
    return shape->center_x[holder] * v_x + shape->center_y[holder] * v_y + shape->radius[holder];
}

/* g(n), n at `angle`. */
static double gap_at(const struct posed_pair *pair, double angle) {
    double x = cos(angle), y = sin(angle);
    double offset = pair->offset_x * x + pair->offset_y * y;
    return offset - support(&pair->a, wrap(angle), x, y) - support(&pair->b, wrap(angle + full_turn / 2), -x, -y);
}

/* Golden-section search. Between two neighbouring directions g is one piece of a sinusoid plus a constant, shorter
 * than half a wave: it has one maximum there, or its largest value at an end. */
static double climb(const struct posed_pair *pair, double low, double high) {
    const double ratio = 0.618033988749894848;
    double left = high - ratio * (high - low), right = low + ratio * (high - low);
    double gap_left = gap_at(pair, left), gap_right = gap_at(pair, right);
    while (high - low > angle_resolution) {
        if (gap_left > gap_right) {
            high = right;
            right = left;
            gap_right = gap_left;
            left = high - ratio * (high - low);
            gap_left = gap_at(pair, left);
        } else {
            low = left;
            left = right;
            gap_left = gap_right;
            right = low + ratio * (high - low);
            gap_right = gap_at(pair, right);
        }
    }
    return (low + high) / 2;
}

static int compare_doubles(const void *left, const void *right) {
    double l = *(const double *)left, r = *(const double *)right;
    return (l > r) - (l < r);
}

struct reference_gap reference_find_gap(const struct reference_body *a, const struct reference_body *b) {
    struct posed_pair pair = pose_pair(a, b);
    double angle[DIRECTIONS + 1], gap[DIRECTIONS + 1];
    size_t count = 0;
    for (size_t k = 0; k < SAMPLES; k++)
        angle[count++] = full_turn * (double)k / SAMPLES;
    for (size_t i = 0; i < a->count; i++)
        angle[count++] = pair.a.start[i];
    for (size_t j = 0; j < b->count; j++)
        angle[count++] = wrap(pair.b.start[j] + full_turn / 2);
    qsort(angle, count, sizeof(angle[0]), compare_doubles);
    angle[count] = angle[0] + full_turn;

    size_t best = 0;
    for (size_t k = 0; k <= count; k++) {
        gap[k] = gap_at(&pair, angle[k]);
        best = gap[k] > gap[best] ? k : best;
    }
    double best_angle = angle[best], best_gap = gap[best];
    /* A sinusoid's peak lies above the nearer end of its interval by at most amplitude * (1 - cos(width / 2)), which is
     * less than amplitude * width^2 / 8: intervals that can't reach the best are passed over. */
    double amplitude = reference_reach(a, b);
    for (size_t k = 0; k < count; k++) {
        double width = angle[k + 1] - angle[k];
        if (fmax(gap[k], gap[k + 1]) + amplitude * width * width / 8 > best_gap) {
            double peak = climb(&pair, angle[k], angle[k + 1]), peak_gap = gap_at(&pair, peak);
            best_angle = peak_gap > best_gap ? peak : best_angle;
            best_gap = fmax(best_gap, peak_gap);
        }
    }
    return (struct reference_gap){best_gap, cos(best_angle), sin(best_angle)};
}

/* Where the pieces of g begin: at A's junctions and opposite to B's, in the order of their angles. */
struct turn {
    double angle;
    size_t arc;
    bool of_b;
};

/* Both lists are in that order already, but for where they begin. */
static size_t merge_turns(const struct posed_pair *pair, struct turn turns[2 * NARC_MAX_ARCS + 1]) {
    const struct posed *const shape[2] = {&pair->a, &pair->b};
    struct turn next[2];
    size_t left[2], count = 0;
    for (int k = 0; k < 2; k++) {
        next[k] = (struct turn){INFINITY, 0, k};
        for (size_t i = 0; i < shape[k]->count; i++) {
            const double angle = wrap(shape[k]->start[i] + k * full_turn / 2);
            if (angle < next[k].angle)
                next[k] = (struct turn){angle, i, k};
        }
        left[k] = shape[k]->count;
    }
    while (left[0] + left[1] > 0) {
        const int k = left[0] == 0 || (left[1] > 0 && next[1].angle < next[0].angle);
        turns[count++] = next[k];
        next[k].arc = (next[k].arc + 1) % shape[k]->count;
        next[k].angle = wrap(shape[k]->start[next[k].arc] + k * full_turn / 2);
        left[k]--;
    }
    turns[count] = turns[0];
    turns[count].angle += full_turn;
    return count;
}

struct reference_gap reference_solve_gap(const struct reference_body *a, const struct reference_body *b) {
    const struct posed_pair pair = pose_pair(a, b);
    struct turn turns[2 * NARC_MAX_ARCS + 1];
    const size_t count = merge_turns(&pair, turns);
    struct reference_gap best = {.gap = -INFINITY};
    /* What holds before the first turn began last. */
    size_t i = 0, j = 0;
    for (size_t k = 0; k < count; k++)
        *(turns[k].of_b ? &j : &i) = turns[k].arc;
    for (size_t k = 0; k < count; k++) {
        *(turns[k].of_b ? &j : &i) = turns[k].arc;
        const double u_x = pair.offset_x + pair.b.center_x[j] - pair.a.center_x[i];
        const double u_y = pair.offset_y + pair.b.center_y[j] - pair.a.center_y[i];
        const double radii = pair.a.radius[i] + pair.b.radius[j], length = sqrt(u_x * u_x + u_y * u_y);
        if (length - radii <= best.gap) /* nowhere more */
            continue;
        double angle = turns[k].angle, x = cos(angle), y = sin(angle), gap = u_x * x + u_y * y - radii;
        if (length > 0 && wrap(atan2(u_y, u_x) - angle) < turns[k + 1].angle - angle) {
            x = u_x / length;
            y = u_y / length;
            gap = length - radii;
        }
        if (gap > best.gap)
            best = (struct reference_gap){gap, x, y};
    }
    return best;
}

double reference_gap_along(const struct reference_body *a, const struct reference_body *b, double x, double y) {
    struct posed_pair pair = pose_pair(a, b);
    return gap_at(&pair, atan2(y, x));
}

double reference_point_distance(const struct reference_body *body, double x, double y) {
    /* A point is a shape too: a circle of radius 0. */
    const narc_arc point = {0, 0, 0, 0, full_turn};
    struct reference_body origin = *body, other = {&point, 1, x, y, 1, 0, 1};
    origin.x = origin.y = 0;
    return reference_find_gap(&origin, &other).gap;
}

double reference_extent(const struct reference_body *body) {
    double extent = 0;
    for (size_t i = 0; i < body->count; i++)
        extent = fmax(extent, hypot(body->arcs[i].center_x, body->arcs[i].center_y) + body->arcs[i].radius);
    return extent * body->scale;
}

double reference_reach(const struct reference_body *a, const struct reference_body *b) {
    return hypot(b->x - a->x, b->y - a->y) + reference_extent(a) + reference_extent(b);
}
