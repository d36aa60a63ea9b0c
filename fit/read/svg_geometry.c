/* SPDX-License-Identifier: MIT
 *
 * svg_geometry.c - plain SVG drawings by their geometry: circles, ellipses, rectangles, lines, polygons and paths, filled,
 * with transforms; strokes of circles, rectangles and lines.
 *
 * Whatever is not known here for certain makes the drawing not plain, and librsvg draws it. Elements are read in turn;
 * each adds contours. What they show together is the union of their insides: if no contours meet, a contour is a part
 * of its outline where some element is inside on one side of it alone.
 */
#include "read/svg_geometry.h"

#include <glib.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline/crossings.h"
#include "outline/ellipse.h"
#include "outline/path.h"

/* A point (x, y) goes to x a + y b + c. */
struct frame {
    narc_point a, b, c;
};

/* What an element hands on to those inside it. */
struct state {
    struct frame frame;
    bool skipped, shown, visible, fill, even_odd, stroke;
    double alpha, fill_alpha, stroke_alpha, width, miter;
    int cap, join; /* butt or miter, round, square or bevel */
};

/* The contours of one element's fill or stroke: up to the one before `end`. */
struct shape {
    size_t end;
    bool even_odd;
};

enum { DEPTH = 64, MOST_SHAPES = 4096 };

struct reader {
    narc_path *path;
    struct state states[DEPTH];
    size_t depth;
    const char *element;
    double threshold;
    struct shape *shapes;
    size_t shape_count, shape_capacity, contour_count;
    bool plain;
    narc_status status;
    narc_error *error;
    struct frame frame; /* of the element that is drawn */
    narc_point pen, first;
    bool begun;
};

/* ---------------------------------------------------------------------------- the pen, in the element's own units */

static narc_point place(const struct frame *f, narc_point p) { return along(along(f->c, p.x, f->a), p.y, f->b); }

static void note(struct reader *r, narc_status status) {
    r->status = r->status ? r->status : status == NARC_ERROR_MEMORY ? status : NARC_OK;
    r->plain = r->plain && !status;
}

static void move_to(struct reader *r, narc_point p) {
    r->pen = r->first = p;
    r->begun = false;
}

/* A contour begins with what is drawn first, so that moves alone begin none. */
static void begin(struct reader *r) {
    if (!r->begun) {
        const narc_point p = place(&r->frame, r->pen);
        note(r, narc_move_to(r->path, &p, r->error));
        r->contour_count++;
    }
    r->begun = true;
}

static void line_to(struct reader *r, narc_point p) {
    begin(r);
    const narc_point q = place(&r->frame, p);
    note(r, narc_line_to(r->path, &q, r->error));
    r->pen = p;
}

static void close_contour(struct reader *r) {
    if (r->begun && !is_same(r->pen, r->first))
        line_to(r, r->first);
    r->pen = r->first;
    r->begun = false;
}

static void cubic_to(struct reader *r, narc_point p, narc_point q, narc_point end) {
    begin(r);
    const narc_point c[] = {place(&r->frame, p), place(&r->frame, q), place(&r->frame, end)};
    note(r, narc_cubic_to(r->path, &c[0], &c[1], &c[2], r->error));
    r->pen = end;
}

static void quadratic_to(struct reader *r, narc_point p, narc_point end) {
    begin(r);
    const narc_point c[] = {place(&r->frame, p), place(&r->frame, end)};
    note(r, narc_quadratic_to(r->path, &c[0], &c[1], r->error));
    r->pen = end;
}

/* The part of an ellipse from one parameter to another, where the pen is, to `end`. */
static void ellipse_to(struct reader *r, const ellipse *e, double from, double to, narc_point end) {
    const struct frame straight = {r->frame.a, r->frame.b, {0, 0}};
    const narc_point c = place(&r->frame, e->center), u = place(&straight, e->u), v = place(&straight, e->v),
                     p = place(&r->frame, end);
    if (from == to)
        return;
    begin(r);
    note(r, narc_ellipse_to(r->path, &c, &u, &v, from, to, &p, r->error));
    r->pen = end;
}

static void add_shape(struct reader *r, bool even_odd) {
    r->plain = r->plain && r->shape_count < MOST_SHAPES;
    struct shape *shapes =
        r->plain ? narc_grow(r->shapes, &r->shape_capacity, r->shape_count + 1, sizeof *shapes) : NULL;
    if (!shapes) {
        note(r, r->plain ? NARC_ERROR_MEMORY : NARC_ERROR_SIZE);
        return;
    }
    r->shapes = shapes;
    shapes[r->shape_count++] = (struct shape){r->contour_count, even_odd};
}

/* ---------------------------------------------------------------------------- numbers */

static void skip_separators(const char **text, bool comma) {
    *text += strspn(*text, " \t\r\n\f");
    if (comma && **text == ',')
        *text += 1 + strspn(*text + 1, " \t\r\n\f");
}

static bool read_number(const char **text, double *out) {
    const char *start = *text, *digits = start + (*start == '-' || *start == '+');
    char *end;
    if (!(g_ascii_isdigit(*digits) || (*digits == '.' && g_ascii_isdigit(digits[1]))) ||
        (digits[0] == '0' && (digits[1] | 32) == 'x'))
        return false;
    *out = g_ascii_strtod(start, &end);
    *text = end;
    return isfinite(*out);
}

/* Numbers up to the end of a text or `stop`; how many, or more than `most` if anything else is there. */
static size_t read_numbers(const char **text, char stop, double *out, size_t most) {
    size_t count = 0;
    for (skip_separators(text, false); **text && **text != stop; skip_separators(text, true))
        if (count == most || !read_number(text, &out[count++]))
            return most + 1;
    return count;
}

/* A length in user units: of CSS, a 96th of an inch. */
static bool read_length(const char *text, double *out) {
    static const struct {
        const char *unit;
        double size;
    } units[] = {{"", 1}, {"px", 1}, {"in", 96}, {"cm", 96 / 2.54}, {"mm", 96 / 25.4}, {"pt", 96.0 / 72}, {"pc", 16}};
    skip_separators(&text, false);
    if (!read_number(&text, out))
        return false;
    const size_t size = strcspn(text, " \t\r\n\f");
    for (size_t k = 0; k < sizeof units / sizeof units[0]; k++)
        if (strlen(units[k].unit) == size && g_ascii_strncasecmp(text, units[k].unit, size) == 0) {
            *out *= units[k].size;
            text += size;
            skip_separators(&text, false);
            return !*text;
        }
    return false;
}

static struct frame chain_frames(const struct frame *outer, const struct frame *inner) {
    const struct frame straight = {outer->a, outer->b, {0, 0}};
    return (struct frame){place(&straight, inner->a), place(&straight, inner->b), place(outer, inner->c)};
}

static bool read_transform(const char *text, struct frame *frame) {
    enum { MATRIX, TRANSLATE, SCALE, ROTATE, SKEW_X, SKEW_Y, KINDS };
    static const char *const names[] = {"matrix", "translate", "scale", "rotate", "skewX", "skewY"};
    for (skip_separators(&text, false); *text; skip_separators(&text, true)) {
        const size_t size = strspn(text, "abcdefghijklmnopqrstuvwxyzXY");
        int kind = 0;
        while (kind < KINDS && (strlen(names[kind]) != size || strncmp(text, names[kind], size) != 0))
            kind++;
        text += size;
        skip_separators(&text, false);
        double v[6] = {0};
        if (kind == KINDS || *text++ != '(')
            return false;
        const size_t count = read_numbers(&text, ')', v, 6);
        if (*text++ != ')')
            return false;
        struct frame next = {{1, 0}, {0, 1}, {0, 0}};
        const double radians = v[0] * PI / 180;
        const narc_point way =
            fmod(v[0], 90) == 0 ? (narc_point){round(narc_cos(radians)), round(narc_sin(radians))} : unit_at(radians);
        if (kind == MATRIX && count == 6)
            next = (struct frame){{v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}};
        else if (kind == TRANSLATE && (count == 1 || count == 2))
            next.c = (narc_point){v[0], v[1]};
        else if (kind == SCALE && (count == 1 || count == 2))
            next = (struct frame){{v[0], 0}, {0, count == 1 ? v[0] : v[1]}, {0, 0}};
        else if (kind == ROTATE && (count == 1 || count == 3)) {
            next = (struct frame){way, turned(way), {0, 0}};
            next.c = minus((narc_point){v[1], v[2]}, place(&next, (narc_point){v[1], v[2]}));
        } else if (kind == SKEW_X && count == 1)
            next.b.x = tangent(radians);
        else if (kind == SKEW_Y && count == 1)
            next.a.y = tangent(radians);
        else
            return false;
        *frame = chain_frames(frame, &next);
    }
    return true;
}

/* ---------------------------------------------------------------------------- path data */

/* An arc of path data, from the pen to `end`: centre and angles from its ends (SVG 1.1, appendix F.6.5). */
static void draw_arc(struct reader *r, double rx, double ry, double degrees, bool large, bool sweep, narc_point end) {
    const narc_point x = fmod(degrees, 90) == 0
                             ? (narc_point){round(narc_cos(degrees * PI / 180)), round(narc_sin(degrees * PI / 180))}
                             : unit_at(degrees * PI / 180);
    const narc_point y = turned(x),
                     half = minus(along((narc_point){0, 0}, 0.5, r->pen), along((narc_point){0, 0}, 0.5, end));
    if (is_same(r->pen, end))
        return;
    if (rx == 0 || ry == 0) {
        line_to(r, end);
        return;
    }
    rx = fabs(rx);
    ry = fabs(ry);
    const narc_point h = {dot(half, x) / rx,
                          dot(half, y) / ry}; /* half the chord, where the ellipse is the unit circle */
    const double size = length(h), grow = fmax(1, size);
    rx *= grow;
    ry *= grow;
    const double off = sqrt(fmax(0, 1 - size * size / (grow * grow))) * (large != sweep ? 1 : -1);
    const narc_point side = {-off * h.y / size, off * h.x / size};
    const narc_point c = {-side.x, -side.y}, p = {h.x / grow, h.y / grow};
    const narc_point a = minus(p, c), b = minus((narc_point){-p.x, -p.y}, c);
    const double from = narc_atan2(a.y, a.x);
    double turn = narc_atan2(cross(a, b), dot(a, b));
    if (size >= 1)
        turn = sweep ? PI : -PI;
    else if (sweep != (turn > 0))
        turn += sweep ? 2 * PI : -2 * PI;
    const narc_point middle = along(end, 1, half);
    ellipse e = {middle, {rx * x.x, rx * x.y}, {ry * y.x, ry * y.y}};
    e.center = along(along(middle, c.x, e.u), c.y, e.v);
    ellipse_to(r, &e, from, from + turn, end);
}

static bool read_flag(const char **text, double *out) {
    if (**text != '0' && **text != '1')
        return false;
    *out = *(*text)++ - '0';
    return true;
}

/* What follows the first error is not drawn. */
static void draw_path(struct reader *r, const char *text) {
    static const char commands[] = "MLHVCSQTAZ";
    static const unsigned char counts[] = {2, 2, 1, 1, 6, 4, 4, 2, 7, 0};
    narc_point control = {0, 0};
    char letter = 0, last = 0;
    r->begun = false;
    r->pen = r->first = (narc_point){0, 0};
    for (skip_separators(&text, false); *text; skip_separators(&text, letter != 0)) {
        const bool named = g_ascii_isalpha(*text);
        if (named)
            letter = *text++;
        else if (!letter || (letter | 32) == 'z')
            return;
        const char upper = g_ascii_toupper(letter), *place_of = strchr(commands, upper);
        const bool relative = letter != upper;
        double v[7] = {0};
        if (!place_of || (!last && upper != 'M'))
            return;
        for (size_t k = 0; k < counts[place_of - commands]; k++) {
            skip_separators(&text, k > 0 || !named);
            if (!(upper == 'A' && (k == 3 || k == 4) ? read_flag(&text, &v[k]) : read_number(&text, &v[k])))
                return;
        }
        const narc_point from = r->pen, base = relative ? from : (narc_point){0, 0};
        const narc_point p = {base.x + v[0], base.y + v[1]}, q = {base.x + v[2], base.y + v[3]};
        const bool after_cubic = strchr("CS", last), after_quadratic = strchr("QT", last);
        const narc_point mirrored = {2 * from.x - control.x, 2 * from.y - control.y};
        switch (upper) {
        case 'M':
            move_to(r, p);
            letter = relative ? 'l' : 'L';
            break;
        case 'L':
            line_to(r, p);
            break;
        case 'H':
            line_to(r, (narc_point){p.x, from.y});
            break;
        case 'V':
            line_to(r, (narc_point){from.x, base.y + v[0]});
            break;
        case 'C':
            control = q;
            cubic_to(r, p, q, (narc_point){base.x + v[4], base.y + v[5]});
            break;
        case 'S':
            control = p;
            cubic_to(r, after_cubic ? mirrored : from, p, q);
            break;
        case 'Q':
            control = p;
            quadratic_to(r, p, q);
            break;
        case 'T':
            control = after_quadratic ? mirrored : from;
            quadratic_to(r, control, p);
            break;
        case 'A':
            draw_arc(r, v[0], v[1], v[2], v[3] != 0, v[4] != 0, (narc_point){base.x + v[5], base.y + v[6]});
            break;
        default:
            close_contour(r);
        }
        last = upper;
        if (!r->plain)
            return;
    }
}

static void draw_points(struct reader *r, const char *text) {
    narc_point p;
    skip_separators(&text, false);
    for (bool first = true; read_number(&text, &p.x); first = false) {
        skip_separators(&text, true);
        if (!read_number(&text, &p.y))
            break;
        if (first)
            move_to(r, p);
        else
            line_to(r, p);
        skip_separators(&text, true);
    }
    r->begun = false;
}

/* ---------------------------------------------------------------------------- shapes */

static void draw_ellipse(struct reader *r, narc_point c, double rx, double ry, bool backwards) {
    const ellipse e = {c, {rx, 0}, {0, backwards ? -ry : ry}};
    move_to(r, (narc_point){c.x + rx, c.y});
    ellipse_to(r, &e, 0, 2 * PI, r->first);
    r->begun = false;
}

/* A rectangle round a centre, with round corners if their radii are above 0. */
static void draw_rectangle(struct reader *r, narc_point c, narc_point half, double rx, double ry, bool backwards) {
    const double flip = backwards ? -1 : 1;
    const narc_point in = {half.x - rx, flip * (half.y - ry)};
    const bool is_round = rx > 0 && ry > 0;
    for (int k = 0; k < 4; k++) {
        const double sx = k == 1 || k == 2 ? -1 : 1, sy = k >= 2 ? -1 : 1;
        const ellipse e = {{c.x + sx * in.x, c.y + sy * in.y}, {rx, 0}, {0, flip * ry}};
        const narc_point corner = {c.x + sx * half.x, c.y + sy * flip * half.y};
        const narc_point from = is_round ? find_on(&e, k * PI / 2) : corner;
        const narc_point start = k % 2 ? (narc_point){e.center.x, from.y} : (narc_point){from.x, e.center.y};
        const narc_point end =
            k % 2 ? (narc_point){c.x + sx * half.x, e.center.y} : (narc_point){e.center.x, c.y + sy * flip * half.y};
        const narc_point at = is_round ? start : corner;
        if (k == 0)
            move_to(r, at);
        else if (!is_same(at, r->pen))
            line_to(r, at);
        if (is_round)
            ellipse_to(r, &e, k * PI / 2, (k + 1) * PI / 2, end);
    }
    close_contour(r);
}

/* ---------------------------------------------------------------------------- elements */

static const char *find(const char *name, const char **names, const char **values) {
    for (; *names; names++, values++)
        if (strcmp(*names, name) == 0)
            return *values;
    return NULL;
}

/* A length that may be left out. */
static bool has_length(const char *name, const char **names, const char **values, double usual, double *out) {
    const char *text = find(name, names, values);
    *out = usual;
    return !text || read_length(text, out);
}

static bool read_alpha(const char *text, double *out) {
    const bool done = read_number(&text, out);
    *out = fmin(1, fmax(0, *out));
    skip_separators(&text, false);
    return done && !*text;
}

static bool read_paint(const char *text, bool *out) {
    static const char *const special[] = {"currentColor", "context-fill", "context-stroke", "inherit", NULL};
    const size_t size = strlen(text);
    *out = strcmp(text, "none") != 0 && strcmp(text, "transparent") != 0;
    return text[0] == '#' ? (size == 4 || size == 7) && strspn(text + 1, "0123456789abcdefABCDEF") == size - 1
           : strncmp(text, "rgb(", 4) == 0
               ? size > 9 && strcspn(text, ")") == size - 1 && strspn(text + 4, "0123456789.,% ") == size - 5
               : size > 0 && strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ") == size &&
                     !g_strv_contains(special, text);
}

static bool choose(const char *text, const char *first, const char *second, const char *third, int *out) {
    const char *const words[] = {first, second, third};
    for (*out = 0; *out < 3; ++*out)
        if (strcmp(text, words[*out]) == 0)
            return true;
    return false;
}

/* Takes a property into account; false: what it does is not known here. */
static bool apply(struct state *state, const char *name, const char *value, bool is_style) {
    static const char *const unknown[] = {"clip-path",  "mask",       "filter",           "marker", "marker-start",
                                          "marker-mid", "marker-end", "stroke-dasharray", NULL};
    static const char *const never[] = {"vector-effect",      "systemLanguage",
                                        "requiredExtensions", "requiredFeatures",
                                        "transform-origin",   "all",
                                        "xml:base",           NULL};
    static const char *const geometry[] = {"x", "y",  "width", "height", "cx",        "cy",
                                           "r", "rx", "ry",    "d",      "transform", NULL};
    int word;
    if (strcmp(name, "fill") == 0)
        return read_paint(value, &state->fill);
    if (strcmp(name, "stroke") == 0)
        return read_paint(value, &state->stroke);
    if (strcmp(name, "fill-opacity") == 0)
        return read_alpha(value, &state->fill_alpha);
    if (strcmp(name, "stroke-opacity") == 0)
        return read_alpha(value, &state->stroke_alpha);
    if (strcmp(name, "stroke-width") == 0)
        return read_length(value, &state->width);
    if (strcmp(name, "stroke-miterlimit") == 0)
        return read_length(value, &state->miter);
    if (strcmp(name, "stroke-linecap") == 0)
        return choose(value, "butt", "round", "square", &state->cap);
    if (strcmp(name, "stroke-linejoin") == 0)
        return choose(value, "miter", "round", "bevel", &state->join);
    if (strcmp(name, "fill-rule") == 0) {
        const bool known = choose(value, "nonzero", "evenodd", "evenodd", &word);
        state->even_odd = word == 1;
        return known;
    }
    if (strcmp(name, "visibility") == 0) {
        const bool known = choose(value, "visible", "hidden", "collapse", &word);
        state->visible = word == 0;
        return known;
    }
    if (strcmp(name, "display") == 0) {
        state->skipped = state->skipped || strcmp(value, "none") == 0;
        return strcmp(value, "inherit") != 0;
    }
    if (g_strv_contains(unknown, name))
        return strcmp(value, "none") == 0;
    return !g_strv_contains(never, name) && !(is_style && g_strv_contains(geometry, name)) &&
           strcmp(value, "inherit") != 0;
}

/* Opacity, of an attribute or a style, which then goes before. */
static bool apply_opacity(struct state *state, const char *own) {
    double alpha = 1;
    if (own && !read_alpha(own, &alpha))
        return false;
    state->alpha *= alpha;
    return true;
}

static bool apply_style(struct state *state, const char *style, char **opacity) {
    char **declarations = g_strsplit(style, ";", -1);
    bool plain = !strstr(style, "/*") && !strstr(style, "!") && !strchr(style, '"') && !strchr(style, '\'');
    for (char **d = declarations; *d && plain; d++) {
        char *colon = strchr(*d, ':');
        if (!colon) {
            plain = !*g_strstrip(*d);
            continue;
        }
        *colon = 0;
        const char *name = g_strstrip(*d), *value = g_strstrip(colon + 1);
        if (strcmp(name, "opacity") == 0) {
            g_free(*opacity);
            *opacity = g_strdup(value);
        } else {
            plain = apply(state, name, value, true);
        }
    }
    g_strfreev(declarations);
    return plain;
}

static bool apply_attributes(struct state *state, const char **names, const char **values) {
    const char *style = find("style", names, values), *transform = find("transform", names, values);
    char *opacity = g_strdup(find("opacity", names, values));
    bool plain = !transform || read_transform(transform, &state->frame);
    for (size_t k = 0; names[k] && plain; k++)
        plain = strcmp(names[k], "opacity") == 0 || apply(state, names[k], values[k], false);
    plain = plain && (!style || apply_style(state, style, &opacity)) && apply_opacity(state, opacity);
    g_free(opacity);
    return plain;
}

/* Does paint of this alpha count? What is fainter than the threshold may add up with others. */
static bool counts(struct reader *r, bool painted, double alpha) {
    static const double ROUNDING = 2.0 / 255;
    if (!painted || alpha == 0)
        return false;
    r->plain = r->plain && alpha > r->threshold + (alpha < 1 ? ROUNDING : 0);
    return r->plain;
}

enum kind { CIRCLE, ELLIPSE, RECT, LINE, POLYLINE, POLYGON, PATH, SHAPES };

/* Draws the fill of a shape, or its stroke of a width. */
static void draw_shape(struct reader *r, const struct state *state, enum kind kind, const char **names,
                       const char **values, double width) {
    const bool is_stroke = width > 0;
    const double out = width / 2;
    const char *text = NULL;
    double x = 0, y = 0, w = 0, h = 0, rx = 0, ry = 0;
    bool plain = true;
    switch (kind) {
    case CIRCLE:
    case ELLIPSE:
        plain = has_length("cx", names, values, 0, &x) && has_length("cy", names, values, 0, &y) &&
                has_length(kind == CIRCLE ? "r" : "rx", names, values, kind == CIRCLE ? 0 : -1, &rx) &&
                has_length(kind == CIRCLE ? "r" : "ry", names, values, kind == CIRCLE ? 0 : -1, &ry);
        rx = plain && kind == ELLIPSE && rx < 0 ? ry : rx;
        ry = plain && kind == ELLIPSE && ry < 0 ? rx : ry;
        plain = plain && rx >= 0 && ry >= 0 && !(is_stroke && rx != ry);
        if (!plain || rx == 0 || ry == 0)
            break;
        draw_ellipse(r, (narc_point){x, y}, rx + out, ry + out, false);
        if (is_stroke && rx > out)
            draw_ellipse(r, (narc_point){x, y}, rx - out, ry - out, true);
        break;
    case RECT:
        plain = has_length("x", names, values, 0, &x) && has_length("y", names, values, 0, &y) &&
                has_length("width", names, values, 0, &w) && has_length("height", names, values, 0, &h) &&
                has_length("rx", names, values, -1, &rx) && has_length("ry", names, values, -1, &ry) && w >= 0 &&
                h >= 0;
        if (!plain || w == 0 || h == 0)
            break;
        rx = rx < 0 ? fmax(0, ry) : rx;
        ry = ry < 0 ? rx : ry;
        rx = fmin(rx, w / 2);
        ry = fmin(ry, h / 2);
        const bool sharp = rx == 0 || ry == 0;
        plain = !is_stroke || (sharp ? state->join == 1 || (state->join == 0 && state->miter >= 1.5) : rx == ry);
        if (!plain)
            break;
        const narc_point c = {x + w / 2, y + h / 2}, half = {w / 2, h / 2};
        const double outer = is_stroke && !(sharp && state->join == 0) ? out : 0, in = fmax(0, rx - out);
        draw_rectangle(r, c, (narc_point){half.x + out, half.y + out}, rx + outer, ry + outer, false);
        if (is_stroke && fmin(half.x, half.y) > out)
            draw_rectangle(r, c, (narc_point){half.x - out, half.y - out}, in, in, true);
        break;
    case LINE: {
        double x2 = 0, y2 = 0;
        plain = has_length("x1", names, values, 0, &x) && has_length("y1", names, values, 0, &y) &&
                has_length("x2", names, values, 0, &x2) && has_length("y2", names, values, 0, &y2);
        const narc_point p = {x, y}, q = {x2, y2};
        plain = plain && !(is_stroke && is_same(p, q));
        if (!plain || !is_stroke)
            break;
        const narc_point way = unit(minus(q, p)), side = turned(way);
        const double beyond = state->cap == 2 ? out : 0;
        const narc_point a = along(p, -beyond, way), b = along(q, beyond, way);
        const ellipse at_b = {b, {-out * side.x, -out * side.y}, {out * way.x, out * way.y}};
        const ellipse at_a = {a, {out * side.x, out * side.y}, {-out * way.x, -out * way.y}};
        move_to(r, along(a, -out, side));
        line_to(r, along(b, -out, side));
        if (state->cap == 1)
            ellipse_to(r, &at_b, 0, PI, along(b, out, side));
        else
            line_to(r, along(b, out, side));
        line_to(r, along(a, out, side));
        if (state->cap == 1)
            ellipse_to(r, &at_a, 0, PI, r->first);
        close_contour(r);
        break;
    }
    default:
        plain = !is_stroke;
        text = find(kind == PATH ? "d" : "points", names, values);
        if (!plain || !text)
            break;
        if (kind == PATH)
            draw_path(r, text);
        else
            draw_points(r, text);
    }
    r->plain = r->plain && plain;
}

/* What is inside these is not drawn, or only where it is used. */
static const char *const silent[] = {
    "defs",           "symbol",     "clipPath", "mask",      "pattern",  "marker", "filter",  "linearGradient",
    "radialGradient", "solidColor", "title",    "desc",      "metadata", "script", "animate", "animateTransform",
    "animateMotion",  "set",        "font",     "font-face", "cursor",   "view",   NULL};

static const char *const shape_names[] = {"circle", "ellipse", "rect", "line", "polyline", "polygon", "path", NULL};

static void start_element(GMarkupParseContext *context, const char *name, const char **names, const char **values,
                          gpointer user, GError **problem) {
    struct reader *r = user;
    (void)context, (void)problem;
    if (!r->plain || r->depth + 1 >= DEPTH) {
        r->plain = false;
        return;
    }
    r->states[r->depth + 1] = r->states[r->depth];
    struct state *state = &r->states[++r->depth];
    const bool is_root = r->depth == 1, is_group = strcmp(name, "g") == 0 || strcmp(name, "a") == 0;
    const char *id = find("id", names, values), *colon = strchr(name, ':'), *space = find("xmlns", names, values);
    if (r->element && id && strcmp(id, r->element) == 0)
        state->shown = true;
    if (state->skipped)
        return;
    int kind = 0;
    while (kind < SHAPES && strcmp(name, shape_names[kind]) != 0)
        kind++;
    if (is_root) {
        r->plain = strcmp(name, "svg") == 0 && space && strcmp(space, "http://www.w3.org/2000/svg") == 0 &&
                   !find("transform", names, values) && apply_attributes(state, names, values);
    } else if (kind < SHAPES || is_group) {
        r->plain = !space && apply_attributes(state, names, values);
    } else if (g_strv_contains(silent, name) || (colon && strncmp(name, "svg:", 4) != 0)) {
        state->skipped = true;
    } else {
        r->plain = false;
    }
    if (kind == SHAPES || !r->plain || state->skipped || !state->visible || !state->shown)
        return;
    r->frame = state->frame;
    if (counts(r, state->fill && kind != LINE, state->alpha * state->fill_alpha)) {
        draw_shape(r, state, (enum kind)kind, names, values, 0);
        add_shape(r, state->even_odd);
    }
    if (r->plain && counts(r, state->stroke && state->width != 0, state->alpha * state->stroke_alpha)) {
        r->plain = state->width > 0;
        if (r->plain)
            draw_shape(r, state, (enum kind)kind, names, values, state->width);
        add_shape(r, false);
    }
}

static void end_element(GMarkupParseContext *context, const char *name, gpointer user, GError **problem) {
    struct reader *r = user;
    (void)context, (void)name, (void)problem;
    r->depth -= r->depth > 0;
}

/* Style sheets and entities are librsvg's part. */
static void pass(GMarkupParseContext *context, const char *text, gsize size, gpointer user, GError **problem) {
    struct reader *r = user;
    (void)context, (void)problem;
    if (g_strstr_len(text, (gssize)size, "<!ENTITY") || g_strstr_len(text, (gssize)size, "xml-stylesheet"))
        r->plain = false;
}

/* ---------------------------------------------------------------------------- the union */

/* How often a closed contour winds round a point. */
static int wind(const narc_point *points, size_t count, narc_point p) {
    int turns = 0;
    for (size_t k = 0; k < count; k++) {
        const narc_point a = points[k], b = points[k + 1 < count ? k + 1 : 0];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
            turns += b.y > a.y ? 1 : -1;
    }
    return turns;
}

static double measure_area(const narc_point *points, size_t count) {
    double twice = 0;
    for (size_t k = 0; k < count; k++)
        twice += cross(minus(points[k], points[0]), minus(points[k + 1 < count ? k + 1 : 0], points[0]));
    return twice / 2;
}

/* Does a contour separate what is inside of some element from what is not? */
static bool separates(const struct reader *r, const narc_contours *drawn, size_t contour) {
    const size_t first = begin_of(drawn->ends, contour), count = drawn->ends[contour] - first;
    const narc_point p = drawn->points[first];
    const int own = measure_area(drawn->points + first, count) > 0 ? 1 : -1;
    bool in = false, out = false;
    for (size_t k = 0, other = 0; k < r->shape_count; k++) {
        int turns = 0;
        bool is_own = false;
        for (; other < r->shapes[k].end; other++) {
            const size_t start = begin_of(drawn->ends, other);
            is_own = is_own || other == contour;
            if (other != contour)
                turns += wind(drawn->points + start, drawn->ends[other] - start, p);
        }
        const int mask = r->shapes[k].even_odd ? 1 : -1;
        out = out || (turns & mask) != 0;
        in = in || ((turns + (is_own ? own : 0)) & mask) != 0;
    }
    return in != out;
}

/* Contours and points to be compared with each other at most. */
static const double MOST_WORK = 3e7;

/* Of contours whose crossings are told by chords, those that meet by less than this part of the largest coordinate touch. */
static const double TOUCHING = 1e-9;

static narc_status unite(struct reader *r, const narc_aabb *page, narc_path *out) {
    narc_contours drawn;
    narc_crossings crossings = {0};
    narc_status status = narc_flatten_path(r->path, 0, &drawn, r->error);
    if (status)
        return status;
    const narc_aabb box = bound_points(drawn.points, drawn.point_count);
    const double room = TOUCHING * largest_in(box);
    r->plain = drawn.count > 0 && drawn.count == r->contour_count &&
               (double)drawn.count * (double)drawn.point_count < MOST_WORK &&
               !(page && (box.min_x < page->min_x - room || box.max_x > page->max_x + room ||
                          box.min_y < page->min_y - room || box.max_y > page->max_y + room));
    if (r->plain)
        status = narc_find_crossings(&drawn, true, room, &crossings, r->error);
    r->plain = r->plain && !status && crossings.count == 0;
    const narc_path_mark mark = narc_mark_path(out);
    bool kept = false;
    status = status == NARC_ERROR_MEMORY ? status : NARC_OK;
    for (narc_drawn_move move = {0}; r->plain && !status && narc_next_drawn(r->path, &move);) {
        const narc_point *c = move.controls;
        if (move.begins)
            kept = separates(r, &drawn, move.contour);
        if (move.begins && kept)
            status = narc_move_to(out, &c[0], r->error);
        if (kept && !status)
            status = move.is_arc        ? narc_arc_to(out, &c[1], &c[2], r->error)
                     : move.degree == 1 ? narc_line_to(out, &c[1], r->error)
                     : move.degree == 2 ? narc_quadratic_to(out, &c[1], &c[2], r->error)
                                        : narc_cubic_to(out, &c[1], &c[2], &c[3], r->error);
    }
    r->plain = r->plain && narc_is_drawn_since(out, mark);
    if (status)
        narc_rewind_path(out, mark);
    narc_release_contours(&drawn);
    free(crossings.items);
    return status;
}

narc_status narc_read_svg_geometry(const char *data, size_t size, const char *element, double threshold,
                                   const narc_aabb *page, narc_path *path, bool *out_plain, narc_error *error) {
    const GMarkupParser parser = {.start_element = start_element, .end_element = end_element, .passthrough = pass};
    struct reader *r = calloc(1, sizeof *r);
    *out_plain = false;
    if (!r || narc_create_path(&r->path)) {
        free(r);
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for the geometry of the SVG file");
    }
    r->plain = true;
    r->element = element;
    r->threshold = threshold;
    r->error = error;
    r->states[0] = (struct state){.frame = {{1, 0}, {0, -1}, {0, 0}}, /* y up */
                                  .shown = !element,
                                  .visible = true,
                                  .fill = true,
                                  .alpha = 1,
                                  .fill_alpha = 1,
                                  .stroke_alpha = 1,
                                  .width = 1,
                                  .miter = 4};
    GMarkupParseContext *context = g_markup_parse_context_new(&parser, G_MARKUP_DEFAULT_FLAGS, r, NULL);
    const bool read = g_markup_parse_context_parse(context, data, (gssize)size, NULL) &&
                      g_markup_parse_context_end_parse(context, NULL);
    g_markup_parse_context_free(context);
    narc_status status = r->status;
    if (!status && read && r->plain)
        status = unite(r, page, path);
    *out_plain = read && r->plain && !status;
    narc_destroy_path(r->path);
    free(r->shapes);
    free(r);
    return status == NARC_ERROR_MEMORY ? status : NARC_OK;
}
