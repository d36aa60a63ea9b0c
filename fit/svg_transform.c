/* SPDX-License-Identifier: MIT
 *
 * svg_transform.c - affine maps, and the transforms of an SVG file.
 */
#include "svg_transform.h"

#include <math.h>
#include <string.h>

static const double RADIANS = 3.14159265358979323846 / 180;

narc_point narc_apply_affine(const narc_affine *map, narc_point point) {
    return (narc_point){map->xx * point.x + map->xy * point.y + map->x0,
                        map->yx * point.x + map->yy * point.y + map->y0};
}

narc_affine narc_multiply_affine(const narc_affine *outer, const narc_affine *inner) {
    const narc_point origin = narc_apply_affine(outer, (narc_point){inner->x0, inner->y0});
    return (narc_affine){outer->xx * inner->xx + outer->xy * inner->yx,
                         outer->yx * inner->xx + outer->yy * inner->yx,
                         outer->xx * inner->xy + outer->xy * inner->yy,
                         outer->yx * inner->xy + outer->yy * inner->yy,
                         origin.x,
                         origin.y};
}

static narc_affine rotate(double angle, double x, double y) {
    const double c = cos(angle * RADIANS), s = sin(angle * RADIANS);
    return (narc_affine){c, s, -s, c, x - c * x + s * y, y - s * x - c * y};
}

enum { MATRIX, TRANSLATE, SCALE, ROTATE, SKEW_X, SKEW_Y, FUNCTIONS };

/* Each takes `count` numbers, or `fewer`. */
static const struct function {
    const char *name;
    size_t count, fewer;
} functions[FUNCTIONS] = {{"matrix", 6, 6}, {"translate", 2, 1}, {"scale", 2, 1},
                          {"rotate", 3, 1}, {"skewX", 1, 1},     {"skewY", 1, 1}};

static narc_affine make_map(size_t function, const double *n, size_t count) {
    switch (function) {
    case MATRIX:
        return (narc_affine){n[0], n[1], n[2], n[3], n[4], n[5]};
    case TRANSLATE:
        return (narc_affine){1, 0, 0, 1, n[0], count > 1 ? n[1] : 0};
    case SCALE:
        return (narc_affine){n[0], 0, 0, count > 1 ? n[1] : n[0], 0, 0};
    case ROTATE:
        return rotate(n[0], count > 1 ? n[1] : 0, count > 1 ? n[2] : 0);
    case SKEW_X:
        return (narc_affine){1, 0, tan(n[0] * RADIANS), 1, 0, 0};
    default:
        return (narc_affine){1, tan(n[0] * RADIANS), 0, 1, 0, 0};
    }
}

/* The numbers between parentheses; as a CSS property they may have units. Returns what is wrong, or NULL. */
static const char *take_arguments(const char **text, double *numbers, size_t *out_count) {
    const char *at = narc_skip_space(*text);
    size_t count = 0;
    if (*at != '(') {
        return "a transform without '('";
    }
    for (at = narc_skip_space(at + 1); *at != ')'; at = narc_skip_comma(at)) {
        if (count == 6) {
            return "a transform without ')' or with too many numbers";
        }
        if (!narc_take_number(&at, &numbers[count])) {
            return *at ? "a number is missing in a transform" : "a transform without ')'";
        }
        count++;
        at += strncmp(at, "deg", 3) == 0 ? 3 : strncmp(at, "px", 2) == 0 ? 2 : 0;
    }
    *out_count = count;
    *text = at + 1;
    return NULL;
}

static narc_status take_function(const char **text, narc_affine *out_map, narc_svg_fault *fault) {
    const char *start = *text;
    for (size_t k = 0; k < FUNCTIONS; k++) {
        const size_t size = strlen(functions[k].name);
        if (strncmp(start, functions[k].name, size) == 0) {
            double numbers[6];
            size_t count = 0;
            *text = start + size;
            const char *problem = take_arguments(text, numbers, &count);
            if (problem) {
                return narc_set_fault(fault, NARC_ERROR_FORMAT, problem, start, 0);
            }
            if (count != functions[k].count && count != functions[k].fewer) {
                return narc_set_fault(fault, NARC_ERROR_FORMAT, "a transform with a wrong count of numbers", start,
                                      (double)count);
            }
            *out_map = make_map(k, numbers, count);
            return NARC_OK;
        }
    }
    return narc_set_fault(fault, NARC_ERROR_FORMAT, "a transform that is not known", start, 0);
}

static bool is_finite(const narc_affine *m) {
    return isfinite(m->xx) && isfinite(m->yx) && isfinite(m->xy) && isfinite(m->yy) && isfinite(m->x0) &&
           isfinite(m->y0);
}

narc_status narc_parse_transform(const char *text, size_t size, narc_affine *out_map, narc_svg_fault *fault) {
    narc_affine map = {1, 0, 0, 1, 0, 0};
    const char *at = narc_skip_space(text), *end = text + size;
    if (strncmp(at, "none", 4) == 0 && narc_skip_space(at + 4) >= end) {
        at = end;
    }
    while (at < end) {
        const char *start = at;
        narc_affine next = {0};
        const narc_status status = take_function(&at, &next, fault);
        if (status) {
            return status;
        }
        map = narc_multiply_affine(&map, &next);
        if (!is_finite(&map)) {
            return narc_set_fault(fault, NARC_ERROR_NOT_FINITE, "a transform that is not finite", start, 0);
        }
        at = narc_skip_comma(at);
    }
    *out_map = map;
    return NARC_OK;
}
