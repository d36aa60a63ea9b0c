/* SPDX-License-Identifier: MIT
 *
 * fits.c - fits of arbitrary contours: the arcs are a valid shape, what bounds holds every point, and chains join and
 * keep their tolerance.
 */
#include <math.h>

#include "fuzz.h"
#include "outlines.h"

static struct outline take_outline(struct bytes *from) {
    struct outline outline = make_outline("fuzz");
    const double scale = pow(10, (double)take_below(from, 7) - 3);
    narc_point points[10];
    for (unsigned contours = 1 + take_below(from, 2); contours > 0; contours--) {
        const size_t count = 3 + take_below(from, 8);
        for (size_t k = 0; k < count; k++) {
            const double x = take_number(from, 4), y = take_number(from, 4);
            points[k] = (narc_point){fabs(x) < 1e6 ? scale * x : scale, fabs(y) < 1e6 ? scale * y : scale};
        }
        if (take_below(from, 3) == 0 && count >= 4) {
            add_cubic(&outline, points);
            add_cubic(&outline, (narc_point[4]){points[3], points[2], points[1], points[0]});
        } else {
            add_corners(&outline, points, count);
        }
    }
    return outline;
}

static void check_result(struct bytes *from, const struct outline *outline) {
    const narc_fit_request request = {.arc_count = 1 + take_below(from, 5),
                                      .family = (narc_fit_family)take_below(from, 4),
                                      .goal = (narc_fit_goal)take_below(from, 5),
                                      .keep_origin = take_below(from, 2),
                                      .starts = 1};
    narc_fit_result result;
    narc_error error = {.message = ""};
    const narc_status status = narc_fit_path(outline->path, &request, &result, &error);
    if (status != NARC_OK) {
        expect_error(status, error.status, &error, "");
        return;
    }
    assert_int_equal(narc_validate_arcs(result.arcs, result.arc_count, NULL), NARC_OK);
    if (request.goal <= NARC_FIT_BOUND_DISTANCE)
        check_contained(outline, &result, "fuzz");
}

static double find_extent(const struct outline *outline) {
    double size = 0;
    for (size_t k = 0; k < outline->count; k++)
        size = fmax(size, fmax(fabs(outline->points[k].x), fabs(outline->points[k].y)));
    return size;
}

static void check_plain(const struct outline *outline, double tolerance) {
    const narc_fit_request request = {.family = NARC_FIT_PLAIN, .tolerance = tolerance};
    narc_fit_result result;
    if (narc_fit_path(outline->path, &request, &result, NULL) != NARC_OK)
        return;
    assert_int_equal(narc_validate_arcs(result.arcs, result.arc_count, NULL), NARC_OK);
    assert_true(result.max_distance <= tolerance);
    check_contained(outline, &result, "a plain shape");
}

static void check_chains(const struct outline *outline, double tolerance, bool fewest) {
    narc_arc_chains chains;
    if ((fewest ? narc_fit_fewest_chains : narc_fit_chains)(outline->path, tolerance, false, &chains, NULL) != NARC_OK)
        return;
    assert_true(chains.distance <= tolerance);
    for (size_t k = 0, first = 0; k < chains.count; first = chains.ends[k++])
        for (size_t i = first; i < chains.ends[k]; i++) {
            const narc_point end = chains.arcs[i].end,
                             start = chains.arcs[i + 1 < chains.ends[k] ? i + 1 : first].start;
            assert_true(end.x == start.x && end.y == start.y);
        }
    narc_release_chains(&chains);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct bytes from = {data, size};
    struct outline outline = take_outline(&from);
    check_result(&from, &outline);
    const double tolerance = pow(10, -(double)take_below(&from, 6));
    check_chains(&outline, tolerance, false);
    /* Within a part of the size: finer ones have thousands of corners of curves, which take seconds. */
    const double extent = find_extent(&outline);
    check_chains(&outline, fmax(tolerance, 1e-3 * extent), true);
    check_plain(&outline, fmax(tolerance, 0.01) * extent);
    free_outline(&outline);
    return 0;
}
