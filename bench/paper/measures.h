/* SPDX-License-Identifier: MIT
 *
 * measures.h - what statements are held against: ratios of times over a range of n, exponents, where curves cross.
 */
#ifndef NARC_PAPER_MEASURES_H
#define NARC_PAPER_MEASURES_H

#include "paper.h"

/* The least and the largest of the values that a statement covers. NaN: not measured on this instruction set. */
struct span {
    double least, most;
};

/* All that was measured, on one instruction set. */
struct view {
    const struct results *results;
    enum isa isa;
};

/* A curve of one of the figures. */
struct curve {
    enum test test;
    enum algorithm algorithm;
};

struct span one_value(double value);
extern const struct span not_measured;

/* One time over another, n from `least` to `most`. */
struct span time_ratios(const struct view *view, struct curve above, struct curve below, size_t least, size_t most);

/* Contacts with collisions: the time over that of the faster polygon algorithm. */
struct span against_polygons(const struct view *view, enum algorithm algorithm);

/* The time ratio of two algorithms with collisions over the ratio without. */
struct span more_with_collisions(const struct view *view, enum algorithm above, enum algorithm below, size_t most);

/* Exponents of n from n = 8 on: of time; of the time of GJK from hints, slow motion; of the most support points of EPA
 * on polygons, threshold 1e-6. */
struct span time_exponent(const struct view *view, struct curve curve);
struct span exponent_difference(const struct view *view, struct curve above, struct curve below);
struct span warm_exponent(const struct view *view, enum question question);
struct span epa_exponent(const struct view *view);

/* The n from which on the first curve is below the second, between sizes by interpolation of the logarithms; INFINITY
 * if it is not at the end, the first n if it is everywhere. */
struct span crossing(const struct view *view, struct curve lower, struct curve upper);

/* Contacts of n-arc GJK: the time at the least n over those at each of the others of the figures; the same of support
 * points from each n to the next. */
struct span least_size_against_others(const struct view *view);
struct span support_points_to_next(const struct view *view);

struct span warm_against_cold(const struct view *view, size_t motion);
struct span by_threshold(const struct view *view, size_t small, size_t large);
struct span lane_ratio(const struct view *view, enum lane_row above, enum lane_row below);
struct span perpendicular_ratios(const struct view *view, enum perpendicular above, enum perpendicular below);
struct span storage_ratios(const struct view *view);

/* The index of a size; of the largest one below if it was not measured. */
size_t index_of(const struct paper *paper, size_t n);

#endif
