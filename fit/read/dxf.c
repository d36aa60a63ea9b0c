/* SPDX-License-Identifier: MIT
 *
 * dxf.c - DXF drawings: what is checked before dxflib sees it, blocks, curves, and loose lines joined to contours.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "lines.h"
#include "number.h"
#include "outline/ellipse.h"
#include "outline/path.h"
#include "outline/vector.h"
#include "read/dxf_entities.h"

/* Ends this near, in parts of the drawing's extent, meet. */
static const double NEAR = 1e-6;

/* Directions and weights that differ by less are the same. */
static const double ROUND = 1e-9;

enum { DEEPEST = 16, MOST_PIECES = 1000000, MOST_DEGREE = 3 };

/* A point (x, y) goes to x a + y b + c. */
typedef struct frame {
    narc_point a, b, c;
} frame;

typedef struct entity {
    narc_dxf_entity from;
    size_t line;
} entity;

/* From the end of the piece before to its own: a line (degree 1), cubic, or arc (2, by its middle). */
typedef struct piece {
    unsigned degree;
    narc_point a, b, end;
} piece;

/* Pieces that are one stroke. */
typedef struct strand {
    narc_point start, end;
    size_t first, count, layer;
    bool used;
} strand;

typedef struct reader {
    char *text; /* what dxflib reads */
    size_t size, capacity;
    size_t *lines; /* of each entity that dxflib tells */
    size_t line_count, line_capacity;
    entity *entities;
    size_t entity_count, entity_capacity;
    piece *pieces;
    size_t piece_count, piece_capacity;
    strand *strands;
    size_t strand_count, strand_capacity;
    const char **layers;
    size_t layer_count, layer_capacity;
    double unit;
    narc_status status;
    narc_error *error;
} reader;

static bool fail_at(reader *r, narc_status status, size_t line, double value, const char *what, const char *text) {
    if (!r->status)
        r->status =
            narc_fail(r->error, status, line, value, "line %zu: %s '%s'", line, what, narc_make_excerpt(text).text);
    return false;
}

static bool fail_memory(reader *r) {
    if (!r->status)
        r->status = narc_fail(r->error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a drawing");
    return false;
}

/* ---------------------------------------------------------------------------- lines of the text */

typedef enum kind_of_value { TEXT, REAL, WHOLE } kind_of_value;

static kind_of_value kind_of(long code) {
    if ((code >= 10 && code < 60) || (code >= 110 && code < 150) || (code >= 210 && code < 240))
        return REAL;
    return (code >= 60 && code < 80) || (code >= 90 && code < 100) || (code >= 170 && code < 180) ? WHOLE : TEXT;
}

static bool append(reader *r, const char *text, size_t length) {
    char *grown = narc_grow(r->text, &r->capacity, r->size + length + 1, 1);
    if (!grown)
        return fail_memory(r);
    r->text = grown;
    memcpy(grown + r->size, text, length);
    r->size += length;
    grown[r->size++] = '\n';
    return true;
}

/* The next line without blanks around it, in place; NULL at the end. */
static char *next_line(char **rest, size_t *number) {
    char *line = *rest;
    if (!line || !*line)
        return NULL;
    char *end = line + strcspn(line, "\r\n");
    *rest = end + (end[0] == '\r' && end[1] == '\n' ? 2 : end[0] != 0);
    ++*number;
    line += strspn(line, " \t");
    while (end > line && (end[-1] == ' ' || end[-1] == '\t'))
        end--;
    *end = 0;
    return line;
}

/* What an entity may have: short enough for dxflib, and no more corners than lines. */
enum { LONGEST = 250 };

static bool check_value(reader *r, long code, char *value, size_t line, size_t most) {
    double number;
    const kind_of_value kind = kind_of(code);
    if (kind != TEXT && !narc_parse_number(value, strlen(value), &number))
        return fail_at(r, NARC_ERROR_FORMAT, line, 0, "not a number", value);
    if (kind == REAL && !(fabs(number) <= NARC_MAX_COORDINATE))
        return fail_at(r, NARC_ERROR_SIZE, line, number, "beyond 1e9:", value);
    if (kind == WHOLE && !(number == floor(number) && fabs(number) < 1e9))
        return fail_at(r, NARC_ERROR_FORMAT, line, number, "not a whole number", value);
    if ((code == 90 || (code >= 70 && code <= 74)) && !(number >= 0 && number <= (double)most))
        return fail_at(r, NARC_ERROR_FORMAT, line, number, "no such number of items is in this file:", value);
    if (strlen(value) > LONGEST)
        value[LONGEST] = 0;
    return true;
}

static bool is_one_of(const char *word, const char *const *words) {
    for (; *words; words++)
        if (strcmp(word, *words) == 0)
            return true;
    return false;
}

/* Blocks and entities that are drawn, in model space, go to dxflib; of the header the unit is taken. What has no outline,
 * such as texts and measures, is left out. */
static bool sift(reader *r, char *text) {
    static const char *const drawn[] = {"LINE",   "ARC",    "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "VERTEX",
                                        "SEQEND", "SPLINE", "INSERT", "BLOCK",   "ENDBLK",     NULL};
    static const double units[] = {0,       0.0254, 0.3048, 1609.344, 0.001, 0.01, 1,  1000,  2.54e-8,
                                   2.54e-5, 0.9144, 1e-10,  1e-9,     1e-6,  0.1,  10, 100.0, 1e9};
    const size_t most = strlen(text);
    bool drawing = false, header = false, kept = false, counted = false, unit = false, ended = false;
    size_t line = 0, begin = 0, section = 0;
    char *rest = text, *found;
    while (!ended && (found = next_line(&rest, &line))) {
        char *end;
        const long code = strtol(found, &end, 10);
        if (end == found || *end || labs(code) > 9999)
            return fail_at(r, NARC_ERROR_FORMAT, line, 0, "not the number of a kind of value", found);
        char *value = next_line(&rest, &line);
        if (!value)
            return fail_at(r, NARC_ERROR_FORMAT, line, 0, "the file ends behind", found);
        if (code == 0) {
            ended = strcmp(value, "EOF") == 0;
            section = strcmp(value, "SECTION") == 0 ? line : section;
            const bool bounds = ended || is_one_of(value, (const char *const[]){"SECTION", "ENDSEC", NULL});
            kept = bounds || (drawing && is_one_of(value, drawn));
            begin = r->size;
            counted = kept && !bounds && !is_one_of(value, (const char *const[]){"VERTEX", "SEQEND", NULL});
            if (counted) {
                size_t *lines = narc_grow(r->lines, &r->line_capacity, r->line_count + 1, sizeof *lines);
                if (!lines)
                    return fail_memory(r);
                r->lines = lines;
                lines[r->line_count++] = line;
            }
        } else if (code == 2 && section && section + 2 == line) {
            drawing = strcmp(value, "BLOCKS") == 0 || strcmp(value, "ENTITIES") == 0;
            header = strcmp(value, "HEADER") == 0;
        } else if (code == 9) {
            unit = header && strcmp(value, "$INSUNITS") == 0;
        } else if (code == 70 && unit) {
            const long number = strtol(value, NULL, 10);
            r->unit = number > 0 && (size_t)number < sizeof units / sizeof *units ? units[number] : 0;
            unit = false;
        } else if (code == 67 && kept && drawing && strcmp(value, "1") == 0) { /* paper space */
            r->size = begin;
            r->line_count -= counted;
            kept = counted = false;
        }
        if (!kept || code > 239 || (header && code > 2))
            continue;
        char digits[16];
        snprintf(digits, sizeof digits, "%ld", code);
        if (!check_value(r, code, value, line, most) || !append(r, digits, strlen(digits)) ||
            !append(r, value, strlen(value)))
            return false;
    }
    return ended || fail_at(r, NARC_ERROR_FORMAT, line, 0, "EOF is missing: the file is not whole, it ends behind",
                            line ? "" : text);
}

/* ---------------------------------------------------------------------------- entities */

static char *copy_text(const char *text) {
    char *copy = malloc(strlen(text) + 1);
    return copy ? strcpy(copy, text) : NULL;
}

static bool keep_entity(const narc_dxf_entity *from, void *context) {
    reader *r = context;
    entity *grown = narc_grow(r->entities, &r->entity_capacity, r->entity_count + 1, sizeof *grown);
    if (!grown)
        return fail_memory(r);
    r->entities = grown;
    entity *kept = &grown[r->entity_count++];
    *kept = (entity){*from, r->entity_count <= r->line_count ? r->lines[r->entity_count - 1] : 0};
    double *more = from->more_count ? malloc(from->more_count * sizeof *more) : NULL;
    if (from->more_count && more)
        memcpy(more, from->more, from->more_count * sizeof *more);
    kept->from.more = more;
    kept->from.layer = copy_text(from->layer);
    kept->from.name = copy_text(from->name);
    return (kept->from.layer && kept->from.name && (more || !from->more_count)) || fail_memory(r);
}

static narc_point place(const frame *f, narc_point p) { return along(along(f->c, p.x, f->a), p.y, f->b); }

static narc_point place_way(const frame *f, narc_point p) {
    return (narc_point){p.x * f->a.x + p.y * f->b.x, p.x * f->a.y + p.y * f->b.y};
}

/* What flat entities see from behind is mirrored. */
static bool face(reader *r, const entity *e, frame *f) {
    if (fabs(fabs(e->from.up) - 1) > ROUND)
        return fail_at(r, NARC_ERROR_FORMAT, e->line, e->from.up,
                       "it does not lie in the drawing's plane:", "extrusion");
    if (e->from.up < 0)
        f->a = minus((narc_point){0, 0}, f->a);
    return true;
}

/* ---------------------------------------------------------------------------- strands */

static bool begin_strand(reader *r, narc_point at, size_t layer) {
    strand *grown = narc_grow(r->strands, &r->strand_capacity, r->strand_count + 1, sizeof *grown);
    if (!grown)
        return fail_memory(r);
    r->strands = grown;
    grown[r->strand_count++] = (strand){at, at, r->piece_count, 0, layer, false};
    return true;
}

static bool add_piece(reader *r, piece added) {
    if (r->piece_count >= MOST_PIECES) {
        if (!r->status)
            r->status =
                narc_fail(r->error, NARC_ERROR_SIZE, 0, MOST_PIECES, "more than %d lines and curves", MOST_PIECES);
        return false;
    }
    piece *grown = narc_grow(r->pieces, &r->piece_capacity, r->piece_count + 1, sizeof *grown);
    if (!grown)
        return fail_memory(r);
    r->pieces = grown;
    grown[r->piece_count++] = added;
    r->strands[r->strand_count - 1].end = added.end;
    r->strands[r->strand_count - 1].count++;
    return true;
}

/* A part of an ellipse in the frame; `middle` and `end`, there too, are those of an arc of at most half a turn. */
static bool add_ellipse(reader *r, const frame *f, const ellipse *e, double from, double to, const narc_point *middle,
                        const narc_point *end) {
    const ellipse placed = {place(f, e->center), place_way(f, e->u), place_way(f, e->v)};
    const ellipse_part part = divide_ellipse(&placed, from, to);
    for (double k = 0; k < part.count; k++) {
        const narc_point q = k + 1 < part.count || !end ? end_step(&part, k) : place(f, *end);
        narc_point c[2] = {part.count == 1 && middle ? place(f, *middle) : halve_step(&part, k)};
        if (!part.round)
            bend_step(&part, k, r->strands[r->strand_count - 1].end, q, c);
        if (!add_piece(r, (piece){part.round ? 2 : 3, c[0], c[1], q}))
            return false;
    }
    return true;
}

static bool draw_arc(reader *r, const entity *e, frame f, size_t layer) {
    const double *n = e->from.numbers, radius = n[2];
    const bool whole = e->from.kind == NARC_DXF_CIRCLE;
    if (!face(r, e, &f))
        return false;
    if (!(radius > 0))
        return fail_at(r, NARC_ERROR_RADIUS, e->line, radius, "its radius is not above 0:", whole ? "CIRCLE" : "ARC");
    const double from = whole ? 0 : n[3] * PI / 180;
    double to = whole ? 2 * PI : n[4] * PI / 180;
    to += to <= from ? 2 * PI * ceil((from - to) / (2 * PI) + (to == from)) : 0;
    const ellipse circle = {{n[0], n[1]}, {radius, 0}, {0, radius}};
    return begin_strand(r, place(&f, find_on(&circle, from)), layer) &&
           add_ellipse(r, &f, &circle, from, to, NULL, NULL);
}

static bool draw_ellipse(reader *r, const entity *e, const frame *f, size_t layer) {
    const double *n = e->from.numbers;
    const narc_point u = {n[2], n[3]}, side = turned(u);
    const double up = e->from.up < 0 ? -1 : 1;
    const ellipse drawn = {{n[0], n[1]}, u, {up * n[4] * side.x, up * n[4] * side.y}};
    if (!(length(u) > 0 && fabs(n[4]) > 0))
        return fail_at(r, NARC_ERROR_SIZE, e->line, n[4], "it has no width:", "ELLIPSE");
    const double turn = n[6] - n[5],
                 to = n[5] + (turn <= 0 ? turn + 2 * PI * ceil(-turn / (2 * PI) + (turn == 0)) : turn);
    return begin_strand(r, place(f, find_on(&drawn, n[5])), layer) && add_ellipse(r, f, &drawn, n[5], to, NULL, NULL);
}

static bool draw_polyline(reader *r, const entity *e, frame f, size_t layer) {
    const double *n = e->from.more;
    const size_t count = e->from.more_count / 3;
    const int flags = (int)e->from.numbers[0];
    if (flags & (8 | 16 | 64))
        return fail_at(r, NARC_ERROR_FORMAT, e->line, flags,
                       "it is none in a plane, but in space or a mesh:", "POLYLINE");
    if (!face(r, e, &f) || count < 2)
        return !r->status;
    if (!begin_strand(r, place(&f, (narc_point){n[0], n[1]}), layer))
        return false;
    for (size_t k = 0; k < (flags & 1 ? count : count - 1); k++) {
        const double *from = &n[3 * k], *to = &n[3 * ((k + 1) % count)], bulge = from[2];
        const narc_point p = {from[0], from[1]}, q = {to[0], to[1]}, chord = minus(q, p);
        const narc_point middle = along(along(p, 0.5, chord), -bulge / 2, turned(chord));
        if (bulge == 0 || is_same(p, q)) {
            if (!add_piece(r, (piece){1, p, p, place(&f, q)}))
                return false;
            continue;
        }
        const narc_curve_arc arc = narc_find_arc(&(narc_drawn_move){.controls = (narc_point[]){p, middle, q}});
        const ellipse circle = {arc.center, {arc.radius, 0}, {0, arc.radius}};
        const narc_point away = minus(p, arc.center);
        const double start = narc_atan2(away.y, away.x), turn = 4 * narc_atan2(bulge, 1);
        if (isinf(arc.radius)
                ? !add_piece(r, (piece){1, p, p, place(&f, q)})
                : !add_ellipse(r, &f, &circle, start, start + turn, fabs(turn) <= PI * (1 + 1e-9) ? &middle : NULL, &q))
            return false;
    }
    return true;
}

/* A value of the polar form of the part that is on knots[at .. at + 1]: what de Boor's algorithm makes of an argument for
 * each round. */
static narc_point blossom(const double *knots, const double *controls, size_t degree, size_t at,
                          const double *arguments) {
    narc_point p[MOST_DEGREE + 1];
    for (size_t i = 0; i <= degree; i++)
        p[i] = (narc_point){controls[3 * (at - degree + i)], controls[3 * (at - degree + i) + 1]};
    for (size_t round = 1; round <= degree; round++)
        for (size_t i = degree; i >= round; i--) {
            const double low = knots[at - degree + i], high = knots[at + i - round + 1];
            p[i] = along(p[i - 1], (arguments[round - 1] - low) / (high - low), minus(p[i], p[i - 1]));
        }
    return p[degree];
}

static bool draw_spline(reader *r, const entity *e, const frame *f, size_t layer) {
    const size_t knot_count = (size_t)e->from.numbers[2], count = (e->from.more_count - knot_count) / 3;
    const double given = e->from.numbers[0], *knots = e->from.more, *controls = knots ? knots + knot_count : NULL;
    const size_t degree = given >= 1 && given <= MOST_DEGREE ? (size_t)given : 0;
    if (degree == 0)
        return fail_at(r, NARC_ERROR_FORMAT, e->line, given, "its degree is not 1 to 3:", "SPLINE");
    if (count <= degree || knot_count != count + degree + 1)
        return fail_at(r, NARC_ERROR_FORMAT, e->line, (double)knot_count,
                       "it has not as many knots as control points ask for, or only points to go through:", "SPLINE");
    for (size_t k = 0; k < count; k++)
        if (fabs(controls[3 * k + 2] - controls[2]) > ROUND)
            return fail_at(r, NARC_ERROR_FORMAT, e->line, controls[3 * k + 2],
                           "its control points have weights:", "SPLINE");
    for (size_t k = 0; k + 1 < knot_count; k++)
        if (!(knots[k] <= knots[k + 1]))
            return fail_at(r, NARC_ERROR_FORMAT, e->line, knots[k + 1], "its knots do not rise:", "SPLINE");
    bool begun = false;
    for (size_t at = degree; at < count; at++) {
        const double low = knots[at], high = knots[at + 1];
        narc_point b[MOST_DEGREE + 1];
        if (low == high)
            continue;
        for (size_t i = 0; i <= degree; i++) {
            double arguments[MOST_DEGREE];
            for (size_t k = 0; k < degree; k++)
                arguments[k] = k < i ? high : low;
            b[i] = place(f, blossom(knots, controls, degree, at, arguments));
        }
        if (!begun && !begin_strand(r, b[0], layer))
            return false;
        begun = true;
        const narc_point last = r->strands[r->strand_count - 1].end;
        piece added = {degree == 1 ? 1 : 3, b[degree == 3 ? 1 : 0], b[degree == 3 ? 2 : 0], b[degree]};
        if (degree == 2) { /* as a cubic */
            added.a = along(last, 2.0 / 3, minus(b[1], last));
            added.b = along(b[2], 2.0 / 3, minus(b[1], b[2]));
        }
        if (!add_piece(r, added))
            return false;
    }
    return true;
}

/* ---------------------------------------------------------------------------- blocks */

static size_t find_layer(reader *r, const char *name) {
    for (size_t k = 0; k < r->layer_count; k++)
        if (strcmp(r->layers[k], name) == 0)
            return k;
    const char **grown = narc_grow(r->layers, &r->layer_capacity, r->layer_count + 1, sizeof *grown);
    if (!grown) {
        fail_memory(r);
        return 0;
    }
    r->layers = grown;
    grown[r->layer_count] = name;
    return r->layer_count++;
}

static bool draw(reader *r, size_t begin, size_t end, const frame *f, const char *layer, size_t depth);

static bool draw_insert(reader *r, const entity *e, frame f, const char *layer, size_t depth) {
    const double *n = e->from.numbers;
    size_t block = 0, end;
    while (block < r->entity_count &&
           (r->entities[block].from.kind != NARC_DXF_BLOCK || strcmp(r->entities[block].from.name, e->from.name) != 0))
        block++;
    if (block == r->entity_count)
        return fail_at(r, NARC_ERROR_FORMAT, e->line, 0, "there is no block", e->from.name);
    for (end = block + 1; end < r->entity_count && r->entities[end].from.kind != NARC_DXF_END_OF_BLOCK;)
        end++;
    if (depth == DEEPEST)
        return fail_at(r, NARC_ERROR_FORMAT, e->line, DEEPEST, "blocks in blocks, too deep at", e->from.name);
    if (!face(r, e, &f))
        return false;
    const double columns = fmax(1, n[5]), rows = fmax(1, n[6]);
    if (columns * rows > MOST_PIECES)
        return fail_at(r, NARC_ERROR_SIZE, e->line, columns * rows, "too many copies of", e->from.name);
    const narc_point x = unit_at(n[4] * PI / 180), y = turned(x),
                     base = {r->entities[block].from.numbers[0], r->entities[block].from.numbers[1]};
    frame inner = {place_way(&f, (narc_point){n[2] * x.x, n[2] * x.y}),
                   place_way(&f, (narc_point){n[3] * y.x, n[3] * y.y}),
                   {0, 0}};
    for (double row = 0; row < rows; row++)
        for (double column = 0; column < columns; column++) {
            const narc_point at = along(along((narc_point){n[0], n[1]}, column * n[7], x), row * n[8], y);
            inner.c = (narc_point){0, 0};
            inner.c = minus(place(&f, at), place(&inner, base));
            if (!draw(r, block + 1, end, &inner, layer, depth + 1))
                return false;
        }
    return true;
}

/* In blocks layer 0 is that of the block. */
static bool draw(reader *r, size_t begin, size_t end, const frame *f, const char *layer, size_t depth) {
    size_t within = 0;
    bool done = true;
    for (size_t k = begin; k < end && done; k++) {
        const entity *e = &r->entities[k];
        within += e->from.kind == NARC_DXF_BLOCK;
        if (within > 0) {
            within -= e->from.kind == NARC_DXF_END_OF_BLOCK;
            continue;
        }
        const char *own = depth && strcmp(e->from.layer, "0") == 0 ? layer : e->from.layer;
        if (e->from.kind == NARC_DXF_INSERT) {
            done = draw_insert(r, e, *f, own, depth);
            continue;
        }
        const size_t number = find_layer(r, own);
        const double *n = e->from.numbers;
        switch (e->from.kind) {
        case NARC_DXF_LINE:
            done = begin_strand(r, place(f, (narc_point){n[0], n[1]}), number) &&
                   add_piece(r, (piece){1, {0, 0}, {0, 0}, place(f, (narc_point){n[2], n[3]})});
            break;
        case NARC_DXF_ARC:
        case NARC_DXF_CIRCLE:
            done = draw_arc(r, e, *f, number);
            break;
        case NARC_DXF_ELLIPSE:
            done = draw_ellipse(r, e, f, number);
            break;
        case NARC_DXF_POLYLINE:
            done = draw_polyline(r, e, *f, number);
            break;
        case NARC_DXF_SPLINE:
            done = draw_spline(r, e, f, number);
            break;
        default:
            break;
        }
        done = done && !r->status;
    }
    return done;
}

/* ---------------------------------------------------------------------------- contours */

static void reverse(reader *r, strand *s) {
    piece *of = &r->pieces[s->first];
    narc_point at = s->start;
    for (size_t k = 0; k < s->count; k++) { /* each ends where it began */
        const narc_point end = of[k].end;
        of[k].end = at;
        at = end;
        if (of[k].degree == 3) {
            const narc_point a = of[k].a;
            of[k].a = of[k].b;
            of[k].b = a;
        }
    }
    for (size_t k = 0; k < s->count / 2; k++) {
        const piece kept = of[k];
        of[k] = of[s->count - 1 - k];
        of[s->count - 1 - k] = kept;
    }
    at = s->start;
    s->start = s->end;
    s->end = at;
}

/* Where lines meet an arc nearly, the line's end moves. */
static narc_status put_strand(const reader *r, const strand *s, const strand *next, narc_path *path,
                              narc_error *error) {
    narc_status status = NARC_OK;
    for (size_t k = 0; k < s->count && !status; k++) {
        const piece *p = &r->pieces[s->first + k];
        const bool last = k + 1 == s->count && next && p->degree == 1;
        const narc_point end = last ? next->start : p->end;
        status = p->degree == 1   ? narc_line_to(path, &end, error)
                 : p->degree == 2 ? narc_arc_to(path, &p->a, &end, error)
                                  : narc_cubic_to(path, &p->a, &p->b, &end, error);
    }
    return status;
}

typedef struct tip {
    narc_point at;
    size_t strand;
} tip;

static int compare_tips(const void *left, const void *right) {
    const tip *a = left, *b = right;
    const int order = compare_points(&a->at, &b->at);
    return order ? order : (a->strand > b->strand) - (a->strand < b->strand);
}

/* The strand that goes on from a point, nearest first; turned round if need be. */
static strand *find_next(reader *r, const tip *tips, size_t count, narc_point at, double near, size_t layer) {
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (tips[middle].at.x < at.x - near)
            low = middle + 1;
        else
            high = middle;
    }
    strand *best = NULL;
    double least = near;
    for (; low < count && tips[low].at.x <= at.x + near; low++) {
        strand *s = &r->strands[tips[low].strand];
        if (!s->used && s->layer == layer && length(minus(tips[low].at, at)) <= least) {
            least = length(minus(tips[low].at, at));
            best = s;
        }
    }
    if (best && length(minus(best->start, at)) > length(minus(best->end, at)))
        reverse(r, best);
    return best;
}

static narc_status join_strands(reader *r, size_t layer, narc_path *path, size_t *open) {
    narc_aabb box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    tip *tips = malloc((2 * r->strand_count + 1) * sizeof *tips);
    const strand **chain = malloc((r->strand_count + 1) * sizeof *chain);
    size_t count = 0;
    narc_status status = tips && chain ? NARC_OK : NARC_ERROR_MEMORY;
    for (size_t k = 0; k < r->strand_count && !status; k++) {
        tips[count++] = (tip){r->strands[k].start, k};
        tips[count++] = (tip){r->strands[k].end, k};
        for (size_t i = 0; i < r->strands[k].count; i++)
            box = widen_box(box, r->pieces[r->strands[k].first + i].end);
        box = widen_box(box, r->strands[k].start);
    }
    if (!status)
        qsort(tips, count, sizeof *tips, compare_tips);
    const double near = NEAR * extent_of(box);
    for (size_t k = 0; k < r->strand_count && !status; k++) {
        strand *s = &r->strands[k];
        size_t length_of = 1;
        if (s->used || s->count == 0 || (layer != SIZE_MAX && s->layer != layer))
            continue;
        s->used = true;
        chain[0] = s;
        for (int way = 0; way < 2 && length(minus(s->start, chain[length_of - 1]->end)) > near; way++) {
            strand *next;
            while (length(minus(s->start, chain[length_of - 1]->end)) > near &&
                   (next = find_next(r, tips, count, chain[length_of - 1]->end, near, s->layer))) {
                next->used = true;
                chain[length_of++] = next;
            }
            if (way == 0 && length(minus(s->start, chain[length_of - 1]->end)) > near) { /* on from its other end */
                for (size_t i = 0; i < length_of; i++)
                    reverse(r, &r->strands[chain[i] - r->strands]);
                for (size_t i = 0; i < length_of / 2; i++) {
                    const strand *kept = chain[i];
                    chain[i] = chain[length_of - 1 - i];
                    chain[length_of - 1 - i] = kept;
                }
                s = &r->strands[chain[0] - r->strands];
            }
        }
        const bool closed = length(minus(s->start, chain[length_of - 1]->end)) <= near;
        *open += !closed;
        status = narc_move_to(path, &s->start, r->error);
        for (size_t i = 0; i < length_of && !status; i++)
            status = put_strand(r, chain[i],
                                i + 1 < length_of ? chain[i + 1]
                                : closed          ? chain[0]
                                                  : NULL,
                                path, r->error);
    }
    free(tips);
    free(chain);
    return status;
}

/* ---------------------------------------------------------------------------- the calls */

static void release(reader *r) {
    for (size_t k = 0; k < r->entity_count; k++) {
        free((char *)r->entities[k].from.layer);
        free((char *)r->entities[k].from.name);
        free((double *)r->entities[k].from.more);
    }
    free(r->text);
    free(r->lines);
    free(r->entities);
    free(r->pieces);
    free(r->strands);
    free(r->layers);
}

/* Strands and layers of a text. */
static narc_status read_strands(const void *data, size_t size, reader *r) {
    static const char binary[] = "AutoCAD Binary DXF";
    if (size >= strlen(binary) && memcmp(data, binary, strlen(binary)) == 0)
        return narc_fail(r->error, NARC_ERROR_FORMAT, 0, 0, "a binary DXF file: it must be saved as text (ASCII)");
    char *text = size < SIZE_MAX ? malloc(size + 1) : NULL;
    if (!text)
        return narc_fail(r->error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a drawing");
    memcpy(text, data, size);
    text[size] = 0;
    narc_status status = narc_clean_text(text, size, r->error);
    if (!status && sift(r, text) && !narc_list_dxf_entities(r->text, r->size, keep_entity, r))
        fail_memory(r);
    const frame whole = {{1, 0}, {0, 1}, {0, 0}};
    if (!status && !r->status)
        draw(r, 0, r->entity_count, &whole, "0", 0);
    free(text);
    return status ? status : r->status;
}

static narc_status check(const void *data, const void *out, const char *name, narc_error *error) {
    return data && out ? NARC_OK : narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", data ? name : "data");
}

narc_status narc_read_dxf(const void *data, size_t size, const narc_dxf_request *request, narc_path *path,
                          narc_error *error) {
    narc_status status = check(data, path, "path", error);
    if (status)
        return status;
    reader r = {.error = error};
    size_t layer = SIZE_MAX, open = 0;
    const narc_path_mark mark = narc_mark_path(path);
    status = read_strands(data, size, &r);
    for (size_t k = 0; k < r.layer_count && !status && request && request->layer; k++)
        if (strcmp(r.layers[k], request->layer) == 0)
            layer = k;
    if (!status && request && request->layer && layer == SIZE_MAX)
        status = narc_fail(error, NARC_ERROR_INDEX, 0, 0, "nothing is drawn on a layer '%s'",
                           narc_make_excerpt(request->layer).text);
    if (!status) {
        status = join_strands(&r, layer, path, &open);
        if (status == NARC_ERROR_MEMORY)
            narc_fail(error, status, 0, 0, "not enough memory for a drawing");
    }
    if (!status && !narc_is_drawn_since(path, mark))
        status = narc_fail(error, NARC_ERROR_FORMAT, 0, 0, "nothing is drawn in it that has an outline");
    if (status) {
        narc_rewind_path(path, mark);
    } else if (request) {
        if (request->out_unit)
            *request->out_unit = r.unit;
        if (request->out_open)
            *request->out_open = open;
    }
    release(&r);
    return status;
}

narc_status narc_list_dxf_layers(const void *data, size_t size, char **out_names, narc_error *error) {
    narc_status status = check(data, out_names, "out_names", error);
    if (status)
        return status;
    reader r = {.error = error};
    size_t length_of = 1;
    status = read_strands(data, size, &r);
    for (size_t k = 0; k < r.layer_count; k++)
        length_of += strlen(r.layers[k]) + 1;
    char *names = status ? NULL : malloc(length_of);
    if (!status && !names)
        status = narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for the names of layers");
    if (!status) {
        *out_names = names;
        for (size_t k = 0; k < r.layer_count; k++) {
            const size_t size_of = strlen(r.layers[k]);
            memcpy(names, r.layers[k], size_of);
            names[size_of] = '\n';
            names += size_of + 1;
        }
        *names = 0;
    }
    release(&r);
    return status;
}
