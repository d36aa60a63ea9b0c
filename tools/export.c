/* SPDX-License-Identifier: MIT
 *
 * export.c - narc export: shapes files to files of editors and engines.
 *
 * A shape becomes an outline of corners with bulges, and is then a circle, a capsule or a box if the target has these.
 * Where it has no arcs, the polygon bounds: its edges are tangents of convex arcs and chords of concave ones.
 */
#include "export.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "draw_fit.h"
#include "fail.h"
#include "options.h"
#include "output.h"
#include "report.h"
#include "sheets.h"
#include "system.h"
#include "text.h"
#include "turn.h"

enum { TO, TOLERANCE, SCALE, Y_DOWN, ORIGIN, OUT, DRY_RUN, REPORT, IMAGE, GRID, OPTIONS };
typedef enum origin { INPUT, CENTER, BOTTOM, ORIGINS } origin;
static const char *const origin_names[ORIGINS] = {"input", "center", "bottom"};

typedef struct exporting {
    const char *path;
    const export_format *to;
    double tolerance, scale;
    bool y_down;
    origin origin;
    const char *folder, *image; /* of the output; of tiles, maybe with {name}, from there */
    grid cells;
    bool each; /* body has a file of its own */
} exporting;

/* In parts of a piece's size: what is nearer is the same to engines, whose numbers are single precision. */
static const double MERGED = 1e-7;

/* An arc has no more corners. */
enum { MOST_STEPS = 1000 };

/* ---------------------------------------------------------------------------- outlines */

bent bend(const corner *from, const corner *to) {
    const double b = from->bulge, dx = to->x - from->x, dy = to->y - from->y, side = (1 - b * b) / (2 * b);
    const narc_point center = {from->x + (dx - side * dy) / 2, from->y + (dy + side * dx) / 2};
    return (bent){center, hypot(dx, dy) * (1 + b * b) / (4 * fabs(b)), atan2(from->y - center.y, from->x - center.x),
                  4 * atan(b)};
}

static const corner *next_corner(const piece *of, size_t k) { return &of->corners[(k + 1) % of->count]; }

static narc_aabb bound_piece(const piece *of) {
    narc_aabb box = EMPTY_BOX;
    for (size_t k = 0; k < of->count; k++) {
        const corner *at = &of->corners[k];
        box = join_boxes(box, (narc_aabb){at->x, at->y, at->x, at->y});
        if (at->bulge == 0)
            continue;
        const bent arc = bend(at, next_corner(of, k));
        for (int quarter = 0; quarter < 4; quarter++) { /* the circle's outermost points, if they are on the arc */
            double away = fmod(quarter * FULL_TURN / 4 - arc.start, FULL_TURN);
            if (away * arc.turn < 0)
                away += copysign(FULL_TURN, arc.turn);
            if (fabs(away) < fabs(arc.turn)) {
                const double x = arc.center.x + (quarter % 2 ? 0
                                                 : quarter   ? -arc.radius
                                                             : arc.radius),
                             y = arc.center.y + (quarter % 2 ? quarter == 1 ? arc.radius : -arc.radius : 0);
                box = join_boxes(box, (narc_aabb){x, y, x, y});
            }
        }
    }
    return box;
}

static double measure_piece(const piece *of) { return box_size(bound_piece(of)); }

static void add_corner(piece *to, size_t *capacity, double x, double y, double bulge) {
    to->corners = grow(to->corners, capacity, to->count + 1, sizeof *to->corners);
    to->corners[to->count++] = (corner){x, y, bulge};
}

/* An arc begins, or ends, as near to the last corner as single precision has the arcs of fits: at one corner, in the middle. */
static bool join_corners(corner *end, double x, double y, double bulge, double near) {
    if (!(hypot(x - end->x, y - end->y) <= near))
        return false;
    *end = (corner){(end->x + x) / 2, (end->y + y) / 2, bulge};
    return true;
}

/* Drops corners that lie where the next one is, and with `straight` those between two edges in one line. */
static void drop_corners(piece *of, bool straight) {
    const double near = MERGED * measure_piece(of);
    const bool closed = of->kind != LINE;
    for (size_t k = 0; k < of->count && of->count > 2;) {
        const corner *at = &of->corners[k], *next = next_corner(of, k),
                     *before = &of->corners[(k + of->count - 1) % of->count];
        const double dx = next->x - before->x, dy = next->y - before->y,
                     away = fabs(dx * (at->y - before->y) - dy * (at->x - before->x));
        const bool is_end = !closed && (k == 0 || k + 1 == of->count);
        const bool same = hypot(next->x - at->x, next->y - at->y) <= near;
        if (!is_end && (same || (straight && away <= near * hypot(dx, dy)))) {
            memmove(&of->corners[k], &of->corners[k + 1], (of->count - k - 1) * sizeof *at);
            of->count--;
        } else {
            k++;
        }
    }
}

double find_turn(const narc_arc *arc) {
    const double way = arc->radius > 0 ? 1 : -1, turn = way * (arc->end - arc->start), nothing = 1e-6;
    if (arc->radius == 0 || fabs(turn) < nothing)
        return 0;
    const double rest = turn - FULL_TURN * floor(turn / FULL_TURN);
    return way * (rest < nothing || rest > FULL_TURN - nothing ? FULL_TURN : rest);
}

/* The shape's arcs as corners with bulges, in the target's coordinates, but around a point of the input. */
static piece outline_shape(const narc_named_shape *shape, narc_point around, const exporting *how) {
    piece made = {.kind = shape->form == NARC_FORM_SHAPE        ? OUTLINE
                          : shape->form == NARC_FORM_OPEN_CHAIN ? LINE
                                                                : LOOP,
                  .name = shape->name};
    size_t capacity = 0;
    const double s = how->scale, up = how->y_down ? -s : s, move_x = shape->origin.x - around.x,
                 move_y = shape->origin.y - around.y;
    double near = 0, first_near = 0; /* of this arc or the one before, and of the first one */
    for (size_t i = 0; i < shape->arc_count; i++) {
        const narc_arc *arc = &shape->arcs[i];
        const double turn = find_turn(arc);
        const int steps = turn == 0 ? 0 : fabs(turn) > 0.51 * FULL_TURN ? 2 : 1;
        const double before = near;
        near = 4 * (double)FLT_EPSILON * s * (hypot(arc->center_x, arc->center_y) + fabs(arc->radius));
        first_near = i == 0 ? near : first_near;
        for (int k = 0; k <= steps; k++) {
            const double at = arc->start + (steps ? turn * k / steps : 0),
                         bulge = k < steps ? tan(turn / steps / 4) : 0,
                         x = s * (arc->center_x + arc->radius * cos(at) + move_x),
                         y = up * (arc->center_y + arc->radius * sin(at) + move_y);
            if (made.count == 0 || !join_corners(&made.corners[made.count - 1], x, y, bulge, fmax(before, near)))
                add_corner(&made, &capacity, x, y, bulge);
        }
    }
    const corner *const begin = made.corners;
    if (made.kind != LINE && made.count > 3 &&
        join_corners(&made.corners[made.count - 1], begin->x, begin->y, begin->bulge, fmax(near, first_near))) {
        made.corners[0] = made.corners[made.count - 1];
        made.count--;
    }
    /* Turned over, arcs turn the other way; backwards, as before. */
    for (size_t i = 0, j = made.count - 1; how->y_down && i < j; i++, j--) {
        const corner kept = made.corners[i];
        made.corners[i] = made.corners[j];
        made.corners[j] = kept;
    }
    if (how->y_down) { /* a bulge belongs to the corner before its arc */
        const double first = made.corners[0].bulge;
        for (size_t k = 0; k + 1 < made.count; k++)
            made.corners[k].bulge = made.corners[k + 1].bulge;
        made.corners[made.count - 1].bulge = first;
    }
    drop_corners(&made, false);
    return made;
}

/* Is it one of the plain shapes? */
static void recognise(piece *of) {
    const double near = MERGED * measure_piece(of);
    const corner *c = of->corners;
    const narc_aabb box = bound_piece(of);
    of->low = (narc_point){box.min_x, box.min_y};
    of->center = (narc_point){(box.min_x + box.max_x) / 2, (box.min_y + box.max_y) / 2};
    of->width = box.max_x - box.min_x;
    of->height = box.max_y - box.min_y;
    if (of->kind != OUTLINE)
        return;
    bool circle = true, sharp = of->count == 4;
    const double radius = of->width / 2;
    for (size_t k = 0; k < of->count; k++) {
        const bent arc = c[k].bulge > 0 ? bend(&c[k], next_corner(of, k)) : (bent){of->center, INFINITY, 0, 0};
        circle = circle && fabs(arc.radius - radius) <= near &&
                 hypot(arc.center.x - of->center.x, arc.center.y - of->center.y) <= near;
        sharp = sharp && c[k].bulge == 0 && fabs(fabs(c[k].x - of->center.x) - of->width / 2) <= near &&
                fabs(fabs(c[k].y - of->center.y) - of->height / 2) <= near;
    }
    const size_t k = of->count == 4 && c[0].bulge == 0 ? 1 : 0; /* the first arc of a capsule */
    if (circle || sharp) {
        of->kind = circle ? CIRCLE : BOX;
        of->radius = radius;
    } else if (of->count == 4 && c[k].bulge > 0 && c[k + 2].bulge > 0 && c[k + 1].bulge == 0 &&
               c[(k + 3) % 4].bulge == 0) {
        const bent a = bend(&c[k], &c[k + 1]), b = bend(&c[k + 2], &c[(k + 3) % 4]);
        const double dx = b.center.x - a.center.x, dy = b.center.y - a.center.y, half = FULL_TURN / 2;
        if (fabs(a.radius - b.radius) <= near && fabs(a.turn - half) < 1e-6 && fabs(b.turn - half) < 1e-6) {
            of->kind = CAPSULE;
            of->radius = (a.radius + b.radius) / 2;
            of->width = hypot(dx, dy) + 2 * of->radius;
            of->angle = atan2(dy, dx);
        }
    }
}

/* ---------------------------------------------------------------------------- polygons */

/* How many edges an arc needs: the corners of tangents, the middles of chords are within the tolerance. */
static size_t count_steps(const exporting *how, const piece *of, const bent *arc) {
    const double t = how->tolerance / arc->radius, turn = fabs(arc->turn);
    const double widest = fmin(2 * (arc->turn > 0 ? acos(1 / (1 + t)) : acos(fmax(1 - t, 0))), FULL_TURN / 4);
    const double steps = ceil(turn / widest - 1e-9);
    if (!(how->tolerance > 0))
        fail_at(how->path, 0,
                "shape '%s' has arcs and %s has none: --tolerance, in units of the output, is missing (%.2g is 1 %% of "
                "this shape's size)",
                of->name, how->to->name, 0.01 * measure_piece(of));
    if (!(steps <= MOST_STEPS))
        fail_at(how->path, 0, "shape '%s': an arc has more than %d corners with --tolerance %g; %.2g will do", of->name,
                MOST_STEPS, how->tolerance, 1.1 * arc->radius * (1 / cos(turn / MOST_STEPS / 2) - 1));
    return (size_t)fmax(steps, 1);
}

/* Of a convex shape's polygon, whatever was rounded, the convex hull: no further out than the tolerance either. False: it
 * has no area. */
static bool make_convex(piece *of) {
    narc_point *points = allocate(of->count, sizeof *points);
    size_t count;
    for (size_t k = 0; k < of->count; k++)
        points[k] = (narc_point){of->corners[k].x, of->corners[k].y};
    const bool made = narc_compute_hull(points, of->count, points, &count, NULL) == NARC_OK && count > 2;
    for (size_t k = 0; made && k < count; k++)
        of->corners[k] = (corner){points[k].x, points[k].y, 0};
    of->count = made ? count : of->count;
    free(points);
    return made;
}

static void flatten_piece(piece *of, const exporting *how) {
    piece flat = *of;
    size_t capacity = 0;
    flat.corners = NULL;
    flat.count = 0;
    for (size_t k = 0; k < of->count; k++) {
        const corner *at = &of->corners[k];
        add_corner(&flat, &capacity, at->x, at->y, 0);
        if (at->bulge == 0)
            continue;
        const bent arc = bend(at, next_corner(of, k));
        const size_t steps = count_steps(how, of, &arc);
        const double step = arc.turn / (double)steps, reach = arc.turn > 0 ? arc.radius / cos(step / 2) : arc.radius;
        for (size_t i = arc.turn > 0 ? 0 : 1; i < steps; i++) {
            const double to = arc.start + step * ((double)i + (arc.turn > 0 ? 0.5 : 0));
            add_corner(&flat, &capacity, arc.center.x + reach * cos(to), arc.center.y + reach * sin(to), 0);
        }
    }
    drop_corners(&flat, true);
    if (flat.kind == OUTLINE)
        make_convex(&flat);
    free(of->corners);
    *of = flat;
}

static void add_piece(export_body *to, const piece *added) {
    to->pieces = grow(to->pieces, &to->capacity, to->count + 1, sizeof *to->pieces);
    to->pieces[to->count++] = *added;
}

/* A convex polygon as the fewest with at most so many corners, of about the same number: chords part it. */
static void split_outline(export_body *to, const piece *of, size_t most) {
    const size_t pieces = most ? (of->count - 2 + most - 3) / (most - 2) : 1;
    if (pieces <= 1) {
        add_piece(to, of);
        return;
    }
    const size_t left = (of->count - 2) * (pieces / 2) / pieces + 2, right = of->count - left + 2;
    piece a = *of, b = *of;
    a.count = left;
    b.count = right;
    b.corners = allocate(right, sizeof *b.corners);
    memcpy(b.corners, of->corners + left - 1, (right - 1) * sizeof *b.corners);
    b.corners[right - 1] = of->corners[0];
    split_outline(to, &a, most);
    split_outline(to, &b, most);
}

/* ---------------------------------------------------------------------------- bodies */

/* Where NAME/1, NAME/2 ... are parts of a body NAME: how long that name is, and the part's number, which does not begin with
 * 0; else 0. */
static size_t find_number(const char *name, uint64_t *number) {
    const char *slash = strrchr(name, '/');
    return slash && slash > name && slash[1] != '0' && parse_whole(slash + 1, 1000000, number) ? (size_t)(slash - name)
                                                                                               : 0;
}

static size_t find_part(const narc_shape_list *shapes, const char *name, size_t length, uint64_t number) {
    char suffix[24] = "";
    if (number)
        snprintf(suffix, sizeof suffix, "/%u", (unsigned)number);
    char *part = join_text(name, length, suffix);
    const size_t found = narc_find_named_shape(shapes, part);
    free(part);
    return found;
}

size_t list_parts(const narc_shape_list *shapes, size_t k, size_t *out_parts, char **out_name) {
    const char *name = shapes->items[k].name;
    uint64_t number = 0;
    const size_t length = find_number(name, &number);
    const bool is_part = length && number && find_part(shapes, name, length, 0) == shapes->count;
    if (is_part && number > 1 && find_part(shapes, name, length, number - 1) < shapes->count)
        return 0;
    const bool compound = is_part && number == 1;
    size_t count = 0;
    *out_name = join_text(name, compound ? length : strlen(name), "");
    for (size_t at = k; at < shapes->count; at = compound ? find_part(shapes, name, length, ++number) : shapes->count)
        out_parts[count++] = at;
    return count;
}

/* Numbers of a shape of this size, as they are written: ten digits, fewer of what is smaller, up to 15 of what is larger. */
static double shorten(double value, double size) {
    const double digits = 10 + floor(log10(fabs(value))) - floor(log10(size));
    char text[40];
    if (!(digits >= 1))
        return 0;
    snprintf(text, sizeof text, "%.*g", (int)fmin(digits, 15), value);
    return strtod(text, NULL) + 0.0;
}

/* Moves a piece to where it is written, and shortens its numbers. */
static void write_numbers(piece *p, narc_point offset, double size, const exporting *how) {
    const double allowed = fmin(how->tolerance > 0 ? how->tolerance / 10 : INFINITY, 1e-4 * measure_piece(p));
    double *const own[] = {&p->radius, &p->width, &p->height, &p->angle};
    narc_point *const points[] = {&p->center, &p->low};
    double moved = 0;
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++)
        *own[i] = shorten(*own[i], fabs(*own[i]));
    for (size_t i = 0; i < sizeof points / sizeof points[0]; i++)
        *points[i] = (narc_point){shorten(points[i]->x + offset.x, size), shorten(points[i]->y + offset.y, size)};
    for (size_t i = 0; i < p->count; i++) {
        const corner c = p->corners[i], to = {shorten(c.x + offset.x, size), shorten(c.y + offset.y, size),
                                              shorten(c.bulge, fabs(c.bulge))};
        moved = fmax(moved, fmax(fabs(to.x - offset.x - c.x), fabs(to.y - offset.y - c.y)));
        p->corners[i] = to;
    }
    const bool is_polygon = p->kind == OUTLINE && !(how->to->keeps & ARCS);
    if (!(moved <= allowed) || (is_polygon && !make_convex(p))) /* convex in the digits that are written, too */
        fail_at(how->path, 0,
                "shape '%s' is too thin, or at (%.3g, %.3g) too far from the origin, for numbers of 15 digits: "
                "--origin center brings it near",
                p->name, p->corners[0].x, p->corners[0].y);
}

/* Is a plain shape where its numbers alone have it: around (0, 0), a capsule upright? */
static bool is_at_origin(const piece *p, narc_point offset) {
    return hypot(p->center.x + offset.x, p->center.y + offset.y) <= MERGED * measure_piece(p) &&
           (p->kind != CAPSULE || fabs(cos(p->angle)) < 1e-6);
}

/* Gives a body's pieces the kinds that the format has, and moves them to its origin. */
static void place_body(export_body *of, const exporting *how) {
    const double s = how->scale, up = how->y_down ? -s : s;
    narc_aabb box = EMPTY_BOX;
    double size = how->tolerance > 0 ? 1e6 * how->tolerance : INFINITY; /* of what must not move */
    for (size_t k = 0; k < of->count; k++) {
        box = join_boxes(box, bound_piece(&of->pieces[k]));
        size = fmin(size, measure_piece(&of->pieces[k]));
    }
    const double low = how->y_down ? box.max_y : box.min_y;
    const narc_point offset =
        how->origin == INPUT
            ? (narc_point){s * of->origin.x, up * of->origin.y + of->height}
            : (narc_point){-(box.min_x + box.max_x) / 2, -(how->origin == CENTER ? (box.min_y + box.max_y) / 2 : low)};
    export_body placed = {.name = of->name,
                          .image = of->image,
                          .tile = of->tile,
                          .width = of->width,
                          .height = of->height,
                          .box = {shorten(box.min_x + offset.x, size), shorten(box.min_y + offset.y, size),
                                  shorten(box.max_x + offset.x, size), shorten(box.max_y + offset.y, size)}};
    for (size_t k = 0; k < of->count; k++) {
        piece *p = &of->pieces[k];
        recognise(p);
        if (p->kind & (LOOP | LINE) & ~how->to->keeps)
            fail_at(how->path, 0, "shape '%s' is a chain, and %s has only convex pieces: narc fit --parts makes these",
                    p->name, how->to->name);
        if (!(p->kind & how->to->keeps) || (how->to->one && !is_at_origin(p, offset)))
            p->kind = p->kind & (LOOP | LINE) ? p->kind : OUTLINE;
        if (!(how->to->keeps & ARCS) && p->kind & (OUTLINE | LOOP | LINE))
            flatten_piece(p, how);
        split_outline(&placed, p, p->kind == OUTLINE ? how->to->most_corners : 0);
    }
    for (size_t k = 0; k < placed.count; k++)
        write_numbers(&placed.pieces[k], offset, size, how);
    free(of->pieces);
    *of = placed;
}

/* The size of a PNG file in its header. */
static void measure_png(const exporting *how, const char *image, unsigned *width, unsigned *height) {
    size_t size;
    char *path = join_text(how->folder, folder_length(how->folder), image);
    unsigned char *bytes = (unsigned char *)read_bytes(path, &size);
    if (size < 24 || memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) != 0)
        fail_at(path, 0, "--image must be PNG, whose size tilesets have");
    *width = (unsigned)bytes[16] << 24 | (unsigned)bytes[17] << 16 | (unsigned)bytes[18] << 8 | bytes[19];
    *height = (unsigned)bytes[20] << 24 | (unsigned)bytes[21] << 16 | (unsigned)bytes[22] << 8 | bytes[23];
    if (*width == 0 || *height == 0)
        fail_at(path, 0, "an image of no pixels");
    free(bytes);
    free(path);
}

/* Each is on the sheet, and no two are the same. */
static void check_cells(const exported *made, const exporting *how) {
    const size_t count = made->sheet_width / how->cells.width * (made->sheet_height / how->cells.height);
    const char **names = allocate(count + 1, sizeof *names);
    for (size_t k = 0; k < count; k++)
        names[k] = NULL;
    for (const export_body *body = made->bodies; body < made->bodies + made->count; body++) {
        if (body->tile >= count)
            fail_at(how->path, 0, "shape '%s' is cell %u of a sheet that has %zu", body->name, body->tile, count);
        if (names[body->tile])
            fail_at(how->path, 0, "shapes '%s' and '%s' are the same cell", names[body->tile], body->name);
        names[body->tile] = body->name;
    }
    free(names);
}

/* Of a sheet NAME-3 is tile 3; of images each body the next one. */
static void choose_tile(export_body *of, size_t number, const exporting *how) {
    const char *dash = strrchr(of->name, '-');
    uint64_t tile = number;
    if (how->cells.width && !(dash && parse_whole(dash + 1, 1000000000, &tile)))
        fail_at(how->path, 0,
                "shape '%s' is no cell of a sheet: these are NAME-0, NAME-1 ..., as narc fit --grid names them",
                of->name);
    of->tile = (unsigned)tile;
    of->width = (unsigned)how->cells.width;
    of->height = (unsigned)how->cells.height;
    if (!how->cells.width) {
        of->image = expand_pattern(how->image, of->name);
        measure_png(how, of->image, &of->width, &of->height);
    }
}

static exported make_bodies(const exporting *how, const narc_shape_list *shapes) {
    exported made = {.box = EMPTY_BOX};
    size_t *parts = allocate(shapes->count, sizeof *parts);
    for (size_t k = 0; k < shapes->count; k++) {
        made.bodies = grow(made.bodies, &made.capacity, made.count + 1, sizeof *made.bodies);
        export_body *body = &made.bodies[made.count];
        char *name;
        const size_t count = list_parts(shapes, k, parts, &name);
        if (count == 0)
            continue;
        *body = (export_body){.name = name, .origin = shapes->items[k].origin};
        for (size_t i = 0; i < count; i++) {
            if (shapes->items[parts[i]].form == NARC_FORM_HALF_PLANE)
                fail_at(how->path, 0, "shape '%s' is a half-plane, which has no outline: a wide box may do",
                        shapes->items[parts[i]].name);
            const piece part = outline_shape(&shapes->items[parts[i]], body->origin, how);
            add_piece(body, &part);
        }
        if (how->to->tiles)
            choose_tile(body, made.count, how);
        place_body(body, how);
        if (how->to->one && (body->count > 1 || (made.count > 0 && !how->each)))
            fail_at(
                how->path, 0,
                "a file of %s holds one shape: '%s' has %zu pieces; --to godot takes all, {name} in --out each body",
                how->to->name, body->name, body->count);
        made.box = join_boxes(made.box, body->box);
        made.count++;
    }
    free(parts);
    return made;
}

/* ---------------------------------------------------------------------------- command */

static size_t count_corners(const export_body *of) {
    size_t count = 0;
    for (size_t k = 0; k < of->count; k++)
        count += of->pieces[k].kind & (CIRCLE | CAPSULE) ? 0 : of->pieces[k].count;
    return count;
}

static void print_bodies(FILE *report, const exported *what) {
    size_t pieces = 0, corners = 0;
    int width = 4; /* of names */
    for (size_t i = 0; i < what->count; i++)
        width = (int)fmax(width, (double)strlen(what->bodies[i].name));
    fprintf(report, "%-*s %8s %8s\n", width, "body", "pieces", "corners");
    for (size_t i = 0; i < what->count; i++) {
        const export_body *of = &what->bodies[i];
        fprintf(report, "%-*s %8zu %8zu\n", width, of->name, of->count, count_corners(of));
        pieces += of->count;
        corners += count_corners(of);
    }
    fprintf(report, "%-*s %8zu %8zu\n", width, "all", pieces, corners);
}

/* `out` may have {name}; NULL: nothing is written. */
static void put_bodies(FILE *report, const exported *what, const char *path, const char *out) {
    fputs("{\"inputs\": [\n  ", report);
    put_input(report, path);
    fputs(", \"bodies\": [", report);
    for (size_t i = 0; i < what->count; i++) {
        const export_body *of = &what->bodies[i];
        fputs(i ? ",\n    {\"name\": " : "\n    {\"name\": ", report);
        put_json_text(report, of->name);
        fprintf(report, ", \"pieces\": %zu, \"corners\": %zu", of->count, count_corners(of));
        if (out) {
            char *own = expand_pattern(out, of->name);
            fputs(", \"out\": ", report);
            put_json_text(report, own ? own : out);
            free(own);
        }
        fputc('}', report);
    }
    fputs("]}\n]}\n", report);
}

/* One file, or one for each body. */
static void write_bodies(const exported *what, const export_format *to, const char *out) {
    for (size_t i = 0; i < what->count; i++) {
        char *path = expand_pattern(out, what->bodies[i].name);
        FILE *file = open_output(path ? path : out);
        exported alone = *what;
        alone.bodies += i;
        alone.count = 1;
        alone.box = alone.bodies->box;
        to->write(file, path ? &alone : what);
        close_output(file);
        free(path);
        if (!path)
            return;
    }
}

static const export_format *find_format(const char *name) {
    char all[200] = "";
    for (const export_format *format = export_formats; format->name; format++) {
        if (strcmp(name, format->name) == 0)
            return format;
        strcat(strcat(all, *all ? ", " : ""), format->name);
    }
    fail("--to must be one of %s, not '%s'", all, narc_make_excerpt(name).text);
}

static origin find_origin(const char *name) {
    origin found = INPUT;
    while (name && found < ORIGINS && strcmp(name, origin_names[found]) != 0)
        found++;
    if (found == ORIGINS)
        fail("--origin must be one of input, center, bottom, not '%s'", narc_make_excerpt(name).text);
    return found;
}

static void check_tiles(const exporting *how) {
    if (!how->to->tiles && (how->image || how->cells.width))
        fail("--image and --grid are for tsj: %s has no images", how->to->name);
    if (!how->to->tiles)
        return;
    if (!how->image || (!how->cells.width && !strstr(how->image, "{name}")))
        fail("a tileset has images: --image must name that of a sheet, with its --grid, or have {name} for one of each "
             "body");
    if (how->scale != 1 || how->origin != INPUT)
        fail("a tileset has the pixels of its images: --scale and --origin cannot change them");
}

static void run(int argc, char **argv) {
    option options[OPTIONS] = {[TO] = {"--to", true, NULL},
                               [TOLERANCE] = {"--tolerance", true, NULL},
                               [SCALE] = {"--scale", true, NULL},
                               [Y_DOWN] = {"--y-down", false, NULL},
                               [ORIGIN] = {"--origin", true, NULL},
                               [OUT] = {"--out", true, NULL},
                               [DRY_RUN] = {"--dry-run", false, NULL},
                               [REPORT] = {"--report", true, NULL},
                               [IMAGE] = {"--image", true, NULL},
                               [GRID] = {"--grid", true, NULL}};
    const char **files = allocate((size_t)argc + 1, sizeof *files);
    if (parse_options(argc, argv, options, OPTIONS, "SHAPES", files) > 1)
        fail("unexpected argument '%s'", narc_make_excerpt(files[1]).text);
    const export_format *to = find_format(required_option(&options[TO]));
    const char *out = options[OUT].value ? options[OUT].value : "-";
    const exporting how = {.path = files[0],
                           .to = to,
                           .tolerance = number_option(&options[TOLERANCE], DBL_MIN, DBL_MAX, "more than 0", 0),
                           .scale = number_option(&options[SCALE], 1e-9, 1e9, "from 1e-9 to 1e9", 1),
                           .y_down = to->y_down || options[Y_DOWN].value,
                           .origin = find_origin(options[ORIGIN].value),
                           .folder = out,
                           .image = options[IMAGE].value,
                           .cells = parse_grid(options[GRID].value),
                           .each = strstr(out, "{name}")};
    check_tiles(&how);
    const bool json = wants_json(&options[REPORT]);
    narc_shape_list *shapes = read_shapes(files[0], NULL);
    exported made = make_bodies(&how, shapes);
    if (to->tiles && how.cells.width) {
        made.sheet = how.image;
        measure_png(&how, how.image, &made.sheet_width, &made.sheet_height);
        check_cells(&made, &how);
    }
    FILE *report = stdout;
    if (!options[DRY_RUN].value) {
        write_bodies(&made, to, out);
        report = finish_outputs();
    }
    if (json)
        put_bodies(report, &made, files[0], options[DRY_RUN].value ? NULL : out);
    else
        print_bodies(report, &made);
    finish_report(report);
    commit_outputs();
    for (size_t i = 0; i < made.count; i++) {
        for (size_t k = 0; k < made.bodies[i].count; k++)
            free(made.bodies[i].pieces[k].corners);
        free(made.bodies[i].pieces);
        free((char *)made.bodies[i].name);
        free((char *)made.bodies[i].image);
    }
    free(made.bodies);
    narc_destroy_shape_list(shapes);
    free(files);
}

const command export_command = {"export", "shapes for editors and engines", run};
