/* SPDX-License-Identifier: MIT
 *
 * svg_path.c - the grammar of SVG path data: commands, implicit repeats, numbers that need no separators.
 */
#include <math.h>
#include <string.h>

#include "svg_pen.h"

/* Commands in lower case, and how many numbers each takes. */
static const char commands[] = "mlhvcsqtaz";
static const unsigned char argument_counts[] = {2, 2, 1, 1, 6, 4, 4, 2, 7, 0};
enum { MOST_ARGUMENTS = 7 };

struct reader {
    narc_svg_pen *pen;
    narc_svg_fault *fault;
    const char *at;
    narc_point control; /* the last control point, which S and T mirror; else where the pen is */
    char kind;          /* the last command in lower case; 0: none */
};

/* A flag is one digit: "a1 1 0 0010 10" has the flags 0 and 0. */
static bool take_flag(const char **text, double *out_flag) {
    if (**text != '0' && **text != '1') {
        return false;
    }
    *out_flag = **text - '0';
    (*text)++;
    return true;
}

static narc_status take_arguments(struct reader *r, char kind, size_t count, double *numbers) {
    for (size_t k = 0; k < count; k++) {
        const bool flag = kind == 'a' && (k == 3 || k == 4);
        r->at = k ? narc_skip_comma(r->at) : narc_skip_space(r->at);
        const char *start = r->at;
        if (!(flag ? take_flag(&r->at, &numbers[k]) : narc_take_number(&r->at, &numbers[k]))) {
            return narc_set_fault(r->fault, NARC_ERROR_FORMAT,
                                  flag ? "a flag 0 or 1 is missing" : "a number is missing", start, 0);
        }
        if (!isfinite(numbers[k])) {
            return narc_set_fault(r->fault, NARC_ERROR_NOT_FINITE, "a number that is not finite", start, numbers[k]);
        }
    }
    return NARC_OK;
}

/* The control point that goes on smoothly from the last curve, if that was of one of these kinds. */
static narc_point mirror_control(const struct reader *r, const char *kinds) {
    const narc_point at = r->pen->at;
    return r->kind && strchr(kinds, r->kind) ? (narc_point){2 * at.x - r->control.x, 2 * at.y - r->control.y} : at;
}

static narc_status draw_curve(struct reader *r, char kind, const narc_point *points, const double *numbers) {
    const bool smooth = kind == 's' || kind == 't';
    narc_point controls[2] = {smooth ? mirror_control(r, kind == 's' ? "cs" : "qt") : points[0]};
    if (kind == 'a') {
        const narc_svg_arc arc = {numbers[0], numbers[1], numbers[2], numbers[3] != 0, numbers[4] != 0};
        return narc_pen_arc(r->pen, &arc, points[0], r->fault);
    }
    if (kind == 'q' || kind == 't') {
        r->control = controls[0];
        return narc_pen_quadratic(r->pen, controls[0], points[smooth ? 0 : 1], r->fault);
    }
    controls[1] = r->control = points[smooth ? 0 : 1];
    return narc_pen_cubic(r->pen, controls, points[smooth ? 1 : 2], r->fault);
}

static narc_status draw_command(struct reader *r, char kind, bool relative, const double *numbers) {
    const narc_point pen = r->pen->at, base = relative ? pen : (narc_point){0, 0};
    /* The arc's point stands behind its five other numbers. */
    const double *n = kind == 'a' ? numbers + 5 : numbers;
    const narc_point points[3] = {
        {base.x + n[0], base.y + n[1]}, {base.x + n[2], base.y + n[3]}, {base.x + n[4], base.y + n[5]}};
    switch (kind) {
    case 'm':
        narc_pen_move(r->pen, points[0]);
        return NARC_OK;
    case 'l':
        return narc_pen_line(r->pen, points[0], r->fault);
    case 'h':
        return narc_pen_line(r->pen, (narc_point){points[0].x, pen.y}, r->fault);
    case 'v':
        return narc_pen_line(r->pen, (narc_point){pen.x, base.y + n[0]}, r->fault);
    case 'z':
        narc_pen_close(r->pen);
        return NARC_OK;
    default:
        return draw_curve(r, kind, points, numbers);
    }
}

/* One command letter with all its repeats. More points after a move are lines. */
static narc_status read_command(struct reader *r, char kind, bool relative) {
    const char *start = r->at - 1;
    const size_t count = argument_counts[strchr(commands, kind) - commands];
    do {
        double numbers[5 + 6] = {0}; /* an arc's point stands from number 5 on and is read as if three might follow */
        narc_status status = take_arguments(r, kind, count, numbers);
        if (status) {
            r->fault->at = *r->fault->at ? r->fault->at : start; /* at the text's end: what it lacks */
            return status;
        }
        status = draw_command(r, kind, relative, numbers);
        if (status) {
            r->fault->at = start;
            return status;
        }
        r->kind = kind;
        kind = kind == 'm' ? 'l' : kind;
        start = narc_skip_space(r->at);
        r->at = narc_skip_comma(r->at);
    } while (count && *r->at && strchr("+-.0123456789", *r->at));
    if (memchr(start, ',', (size_t)(r->at - start))) {
        return narc_set_fault(r->fault, NARC_ERROR_FORMAT, "a number is missing after the comma", start, 0);
    }
    return NARC_OK;
}

narc_status narc_draw_svg_path(const char *text, narc_svg_pen *pen, narc_svg_fault *fault) {
    struct reader r = {.pen = pen, .fault = fault, .at = narc_skip_space(text)};
    while (*r.at) {
        const char letter = *r.at, *start = r.at++;
        const bool upper = letter >= 'A' && letter <= 'Z';
        const char kind = (char)(upper ? letter - 'A' + 'a' : letter);
        if (!strchr(commands, kind)) {
            return narc_set_fault(fault, NARC_ERROR_FORMAT, "no path command", start, 0);
        }
        if (!r.kind && kind != 'm') {
            return narc_set_fault(fault, NARC_ERROR_FORMAT, "a path begins with M", start, 0);
        }
        const narc_status status = read_command(&r, kind, !upper);
        if (status) {
            return status;
        }
        r.at = narc_skip_space(r.at);
    }
    return NARC_OK;
}
