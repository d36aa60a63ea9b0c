/* SPDX-License-Identifier: MIT
 *
 * measures.c - what statements are held against.
 */
#include "measures.h"

#include <math.h>

const struct span not_measured = {NAN, NAN};

struct span one_value(double value) {
    return (struct span){value, value};
}

static void widen(struct span *span, double value) {
    span->least = fmin(span->least, value);
    span->most = fmax(span->most, value);
}

static double at(const struct view *view, struct curve curve, size_t size) {
    return time_of(view->results->paper, view->results->figures, view->isa, curve.test, curve.algorithm, size);
}

static const struct settings *settings_of(const struct view *view) { return &view->results->paper->settings; }

size_t index_of(const struct paper *paper, size_t n) {
    size_t index = 0;
    for (size_t size = 0; size < paper->settings.size_count; size++)
        if (paper->settings.sizes[size] <= n)
            index = size;
    return index;
}

struct span time_ratios(const struct view *view, struct curve above, struct curve below, size_t least, size_t most) {
    struct span span = not_measured;
    for (size_t size = 0; size < settings_of(view)->size_count; size++)
        if (settings_of(view)->sizes[size] >= least && settings_of(view)->sizes[size] <= most)
            widen(&span, at(view, above, size) / at(view, below, size));
    return span;
}

struct span against_polygons(const struct view *view, enum algorithm algorithm) {
    struct span span = not_measured;
    for (size_t size = 0; size < settings_of(view)->figure_sizes; size++) {
        const double sat = at(view, (struct curve){COLLIDING_CONTACT, GON_SAT}, size);
        const double gjk = at(view, (struct curve){COLLIDING_CONTACT, GON_GJK}, size);
        widen(&span, at(view, (struct curve){COLLIDING_CONTACT, algorithm}, size) / fmin(sat, gjk));
    }
    return span;
}

struct span more_with_collisions(const struct view *view, enum algorithm above, enum algorithm below, size_t most) {
    struct span span = not_measured;
    for (size_t size = 0; size <= index_of(view->results->paper, most); size++)
        widen(&span, at(view, (struct curve){COLLIDING_CONTACT, above}, size) /
                         at(view, (struct curve){COLLIDING_CONTACT, below}, size) /
                         (at(view, (struct curve){APART_OVERLAP, above}, size) /
                          at(view, (struct curve){APART_OVERLAP, below}, size)));
    return span;
}

/* ------------------------------------------------------------------------------------------------ exponents */

static double exponent_of(const struct view *view, struct curve curve) {
    double times[MAX_SIZES];
    for (size_t size = 0; size < settings_of(view)->size_count; size++)
        times[size] = at(view, curve, size);
    return slope_of(view->results->paper, times);
}

struct span time_exponent(const struct view *view, struct curve curve) {
    return one_value(exponent_of(view, curve));
}

struct span exponent_difference(const struct view *view, struct curve above, struct curve below) {
    return one_value(exponent_of(view, above) - exponent_of(view, below));
}

struct span warm_exponent(const struct view *view, enum question question) {
    const struct paper *paper = view->results->paper;
    double times[MAX_SIZES];
    for (size_t size = 0; size < paper->settings.size_count; size++)
        times[size] = paper->rows.list[view->results->frames->size_rows[view->isa][question][GJK_WARM][size]].ns;
    return one_value(slope_of(paper, times));
}

struct span epa_exponent(const struct view *view) {
    double most[MAX_SIZES];
    for (size_t size = 0; size < settings_of(view)->size_count; size++)
        most[size] = (double)view->results->steps->contact[KIND_GON][THRESHOLDS - 1][size].most;
    return one_value(slope_of(view->results->paper, most));
}

struct span crossing(const struct view *view, struct curve lower, struct curve upper) {
    const struct settings *settings = settings_of(view);
    double logs[MAX_SIZES];
    size_t size = settings->size_count;
    for (size_t k = 0; k < size; k++)
        logs[k] = log(at(view, lower, k) / at(view, upper, k));
    while (size > 0 && logs[size - 1] < 0)
        size--;
    if (size == 0)
        return one_value((double)settings->sizes[0]);
    if (size == settings->size_count)
        return one_value(INFINITY);
    const double before = log((double)settings->sizes[size - 1]), behind = log((double)settings->sizes[size]);
    return one_value(exp(before + (behind - before) * logs[size - 1] / (logs[size - 1] - logs[size])));
}

/* ------------------------------------------------------------------------------------------------ single methods */

struct span least_size_against_others(const struct view *view) {
    const struct curve curve = {COLLIDING_CONTACT, ARC_GJK};
    struct span span = not_measured;
    for (size_t size = 1; size < settings_of(view)->figure_sizes; size++)
        widen(&span, at(view, curve, 0) / at(view, curve, size));
    return span;
}

struct span support_points_to_next(const struct view *view) {
    enum { LIBRARY_THRESHOLD = 3 }; /* 1e-4 */
    const struct step_count *counts = view->results->steps->contact[KIND_ARC][LIBRARY_THRESHOLD];
    struct span span = not_measured;
    for (size_t size = 1; size < settings_of(view)->figure_sizes; size++)
        widen(&span, counts[size].mean / counts[size - 1].mean);
    return span;
}

struct span warm_against_cold(const struct view *view, size_t motion) {
    const struct row *rows = view->results->paper->rows.list;
    const size_t(*starts)[MOTIONS] = view->results->frames->rows[view->isa][QUESTION_OVERLAP];
    return one_value(rows[starts[GJK_WARM][motion]].ns / rows[starts[GJK_COLD][motion]].ns);
}

struct span by_threshold(const struct view *view, size_t small, size_t large) {
    const struct row *rows = view->results->paper->rows.list;
    const size_t(*thresholds)[MAX_SIZES] = view->results->epa->rows[view->isa][KIND_ARC];
    return one_value(rows[thresholds[small][0]].ns / rows[thresholds[large][0]].ns);
}

struct span lane_ratio(const struct view *view, enum lane_row above, enum lane_row below) {
    const struct paper *paper = view->results->paper;
    const struct lanes *lanes = view->results->lanes;
    return one_value(lane_time(paper, lanes, view->isa, above) / lane_time(paper, lanes, view->isa, below));
}

struct span perpendicular_ratios(const struct view *view, enum perpendicular above, enum perpendicular below) {
    struct span span = not_measured;
    for (size_t size = 0; view->isa == SCALAR && size < settings_of(view)->figure_sizes; size++)
        widen(&span, view->results->perpendiculars->ns[above][size] / view->results->perpendiculars->ns[below][size]);
    return span;
}

struct span storage_ratios(const struct view *view) {
    struct span span = not_measured;
    for (size_t size = 0; size < settings_of(view)->figure_sizes; size++)
        widen(&span,
              (double)arc_bytes(settings_of(view)->sizes[size]) / (double)gon_bytes(settings_of(view)->sizes[size]));
    return span;
}
