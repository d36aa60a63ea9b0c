/* SPDX-License-Identifier: MIT
 *
 * path.c - paths and the pen that draws them.
 */
#include "outline/path.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "error.h"
#include "outline/ellipse.h"

narc_status narc_create_path(narc_path **out_path) {
    if (!out_path)
        return NARC_ERROR_ARGUMENT;
    narc_path *path = calloc(1, sizeof *path);
    if (!path)
        return NARC_ERROR_MEMORY;
    *out_path = path;
    return NARC_OK;
}

void narc_destroy_path(narc_path *path) {
    if (path) {
        free(path->points);
        free(path->degrees);
        free(path);
    }
}

narc_path_mark narc_mark_path(const narc_path *path) { return (narc_path_mark){path->point_count, path->move_count}; }

void narc_rewind_path(narc_path *path, narc_path_mark mark) {
    path->point_count = mark.point_count;
    path->move_count = mark.move_count;
}

bool narc_is_drawn_since(const narc_path *path, narc_path_mark mark) {
    for (size_t k = mark.move_count; k < path->move_count; k++)
        if (path->degrees[k] > 0)
            return true;
    return false;
}

void *narc_grow(void *items, size_t *capacity, size_t count, size_t size) {
    if (count <= *capacity)
        return items;
    size_t wanted = *capacity + *capacity / 2 + 16;
    wanted = wanted < count ? count : wanted;
    if (wanted > SIZE_MAX / 2 / size)
        return NULL;
    void *grown = realloc(items, wanted * size);
    if (grown)
        *capacity = wanted;
    return grown;
}

/* ---------------------------------------------------------------------------- the pen */

static narc_status check_coordinate(double value, const char *what, const char *axis, narc_error *error) {
    if (!isfinite(value))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, value, "%s: %s is not finite: %g", what, axis, value);
    if (fabs(value) > NARC_MAX_COORDINATE) {
        return narc_fail(error, NARC_ERROR_SIZE, 0, value, "%s: %s is %.17g, coordinates reach up to %g", what, axis,
                         value, NARC_MAX_COORDINATE);
    }
    return NARC_OK;
}

/* The last of a move's points is where it goes, those before it are control points. */
static narc_status check_points(const narc_point *points, size_t count, narc_error *error) {
    static const char *const controls[] = {"control point 1", "control point 2"};
    for (size_t i = 0; i < count; i++) {
        const char *what = i + 1 < count ? controls[i] : "the point to go to";
        narc_status status = check_coordinate(points[i].x, what, "x", error);
        status = status ? status : check_coordinate(points[i].y, what, "y", error);
        if (status)
            return status;
    }
    return NARC_OK;
}

/* Makes room for one more move with `count` points. */
static bool make_room(narc_path *path, size_t count) {
    narc_point *points =
        narc_grow(path->points, &path->point_capacity, path->point_count + count, sizeof *path->points);
    if (!points)
        return false;
    path->points = points;
    unsigned char *degrees =
        narc_grow(path->degrees, &path->move_capacity, path->move_count + 1, sizeof *path->degrees);
    if (!degrees)
        return false;
    path->degrees = degrees;
    return true;
}

static narc_status add_move(narc_path *path, unsigned degree, const narc_point *const *given, narc_error *error) {
    const size_t count = narc_count_move_points(degree & ~NARC_ARC_MOVE);
    narc_point points[3];
    if (!path)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "path is NULL");
    for (size_t i = 0; i < count; i++) {
        if (!given[i])
            return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "a point is NULL");
        points[i] = *given[i];
    }
    if (degree > 0 && path->move_count == 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "no contour was begun: narc_move_to() comes first");
    const narc_status status = check_points(points, count, error);
    if (status)
        return status;
    if (!make_room(path, count)) {
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for a path of %zu points",
                         path->point_count + count);
    }
    for (size_t i = 0; i < count; i++)
        path->points[path->point_count++] = points[i];
    path->degrees[path->move_count++] = (unsigned char)degree;
    return NARC_OK;
}

narc_status narc_move_to(narc_path *path, const narc_point *point, narc_error *error) {
    return add_move(path, 0, (const narc_point *const[]){point}, error);
}

narc_status narc_line_to(narc_path *path, const narc_point *point, narc_error *error) {
    return add_move(path, 1, (const narc_point *const[]){point}, error);
}

narc_status narc_quadratic_to(narc_path *path, const narc_point *control, const narc_point *point, narc_error *error) {
    return add_move(path, 2, (const narc_point *const[]){control, point}, error);
}

narc_status narc_cubic_to(narc_path *path, const narc_point *control_1, const narc_point *control_2,
                          const narc_point *point, narc_error *error) {
    return add_move(path, 3, (const narc_point *const[]){control_1, control_2, point}, error);
}

narc_status narc_arc_to(narc_path *path, const narc_point *middle, const narc_point *point, narc_error *error) {
    return add_move(path, NARC_ARC_MOVE + 2, (const narc_point *const[]){middle, point}, error);
}

narc_status narc_ellipse_to(narc_path *path, const narc_point *center, const narc_point *u, const narc_point *v,
                            double from, double to, const narc_point *point, narc_error *error) {
    if (!path || path->move_count == 0 || !center || !u || !v || !point)
        return add_move(path, 1, (const narc_point *const[]){center && u && v ? point : NULL}, error);
    if (!(fabs(to - from) <= 2 * PI * (1 + 1e-9)))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, to - from, "from %g to %g is more than a turn", from, to);
    const narc_path_mark mark = narc_mark_path(path);
    const ellipse_part part = divide_ellipse(&(ellipse){*center, *u, *v}, from, to);
    narc_status status = NARC_OK;
    for (double k = 0; k < part.count && !status; k++) {
        const narc_point begin = path->points[path->point_count - 1];
        const narc_point end = k + 1 < part.count ? end_step(&part, k) : *point, middle = halve_step(&part, k);
        narc_point bend[2];
        bend_step(&part, k, begin, end, bend);
        status =
            part.round ? narc_arc_to(path, &middle, &end, error) : narc_cubic_to(path, &bend[0], &bend[1], &end, error);
    }
    if (status)
        narc_rewind_path(path, mark);
    return status;
}
