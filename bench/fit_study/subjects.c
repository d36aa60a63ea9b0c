/* SPDX-License-Identifier: MIT
 *
 * subjects.c - the outlines of the study: which they are, how they are read, what their hulls are like.
 */
#include "study.h"

#include <stdlib.h>
#include <string.h>

#include "draw_fit.h"
#include "fail.h"
#include "text.h"

const size_t sizes[SIZES] = {4, 6, 8};
const char *const family_names[FAMILIES] = {"n-arc", "arcs + edges", "n-gon", "paper's route"};
const char *const kind_names[KINDS] = {"the paper's four",   "letters and digits", "animals",    "plants and fruit",
                                       "tools and vehicles", "plain signs",        "sand grains"};

static const subject chosen[] = {
    {.name = "ghost", .of = PAPER, .character = 0x1f47b},
    {.name = "house", .of = PAPER, .character = 0x1f3e0},
    {.name = "rocket", .of = PAPER, .character = 0x1f680},
    {.name = "tree", .of = PAPER, .character = 0x1f333},
    {.name = "A", .of = LETTERS, .character = 'A'},
    {.name = "D", .of = LETTERS, .character = 'D'},
    {.name = "O", .of = LETTERS, .character = 'O'},
    {.name = "R", .of = LETTERS, .character = 'R'},
    {.name = "S", .of = LETTERS, .character = 'S'},
    {.name = "8", .of = LETTERS, .character = '8'},
    {.name = "elephant", .of = ANIMALS, .character = 0x1f418},
    {.name = "turtle", .of = ANIMALS, .character = 0x1f422},
    {.name = "crow", .of = ANIMALS, .file = "animals/birds/crow_01.svg"},
    {.name = "kangaroo", .of = ANIMALS, .file = "animals/mammals/contour_kangaroo.svg"},
    {.name = "ladybird", .of = ANIMALS, .file = "animals/bugs/ladybug_01.svg"},
    {.name = "fish", .of = ANIMALS, .file = "animals/fish/yellow_gourami_01.svg"},
    {.name = "mushroom", .of = PLANTS, .character = 0x1f344},
    {.name = "maple leaf", .of = PLANTS, .character = 0x1f341},
    {.name = "lemon", .of = PLANTS, .file = "food/fruit/lemon_simple.svg"},
    {.name = "pear", .of = PLANTS, .file = "food/fruit/pear_simple.svg"},
    {.name = "plum", .of = PLANTS, .file = "food/fruit/prune.svg"},
    {.name = "acorn", .of = PLANTS, .file = "plants/acorn_jonathan_dietrich_01.svg"},
    {.name = "bell", .of = TOOLS, .character = 0x1f514},
    {.name = "spanner", .of = TOOLS, .character = 0x1f527},
    {.name = "aeroplane", .of = TOOLS, .file = "transportation/vehicles/plane_silhouet_mo_01.svg"},
    {.name = "car", .of = TOOLS, .file = "transportation/vehicles/car.svg"},
    {.name = "teapot", .of = TOOLS, .file = "food/beverages/teapot_ganson.svg"},
    {.name = "cog", .of = TOOLS, .file = "tools/cog_01.svg"},
    {.name = "disc", .of = SIGNS, .character = 0x25cf},
    {.name = "ellipse", .of = SIGNS, .character = 0x2b2e},
    {.name = "half disc", .of = SIGNS, .character = 0x25d7},
    {.name = "heart", .of = SIGNS, .character = 0x2665},
    {.name = "triangle", .of = SIGNS, .character = 0x25b2},
    {.name = "pentagon", .of = SIGNS, .character = 0x2b20},
};

static const char *const sands[] = {"river", "sea"};

/* A long side of a hull, as a part of the perimeter. */
static const double LONG_SIDE = 0.05;

/* ---------------------------------------------------------------------------- readers */

narc_path *make_path(void) {
    narc_path *path;
    if (narc_create_path(&path) != NARC_OK)
        fail("not enough memory for an outline");
    return path;
}

/* The bytes of a file in a folder, NULL if there is none. */
static char *read_from(const char *folder, const char *name, size_t *out_size) {
    enum { LONGEST = 4096 };
    char file[LONGEST];
    if (snprintf(file, sizeof file, "%s/%s", folder, name) >= LONGEST)
        fail("%s: the name is too long", folder);
    FILE *there = fopen(file, "rb");
    if (!there)
        return NULL;
    fclose(there);
    return read_bytes(file, out_size);
}

/* Takes a subject whose path was read, with its hull. */
static void add_subject(study *all, const subject *from) {
    if (all->count == MOST_SUBJECTS)
        fail("too many outlines");
    subject *of = &all->subjects[all->count++];
    narc_error error;
    *of = *from;
    of->name = from->name ? from->name : of->label;
    if (narc_flatten_path(of->path, 0, &of->contours, &error) != NARC_OK)
        fail("%s: %s", of->name, error.message);
    of->corners = allocate(of->contours.point_count, sizeof *of->corners);
    if (narc_compute_hull(of->contours.points, of->contours.point_count, of->corners, &of->corner_count, &error))
        fail("%s: %s", of->name, error.message);
    for (size_t k = 0; k < of->corner_count; k++) {
        const narc_point p = of->corners[k], q = of->corners[(k + 1) % of->corner_count], o = of->corners[0];
        of->perimeter += hypot(q.x - p.x, q.y - p.y);
        of->hull_area += 0.5 * ((p.x - o.x) * (q.y - p.y) - (p.y - o.y) * (q.x - p.x));
    }
    for (size_t k = 0; k < of->corner_count; k++) {
        const narc_point p = of->corners[k], q = of->corners[(k + 1) % of->corner_count];
        const double part = hypot(q.x - p.x, q.y - p.y) / of->perimeter;
        of->straight_share += part >= LONG_SIDE ? part : 0;
    }
    const narc_aabb box = bound_points(of->corners, of->corner_count);
    of->extent = fmax(box.max_x - box.min_x, box.max_y - box.min_y);
}

/* A glyph or drawing. */
static void read_chosen(study *all, const subject *from, narc_font *font, const char *drawings) {
    subject of = *from;
    narc_error error;
    of.path = make_path();
    if (of.file) {
        size_t size;
        char *bytes = read_from(drawings, of.file, &size);
        if (!bytes)
            fail("%s/%s is missing; it belongs to the package openclipart-svg of Debian 12", drawings, of.file);
        if (narc_read_svg(bytes, size, NULL, of.path, &error) != NARC_OK)
            fail("%s/%s: %s", drawings, of.file, error.message);
        free(bytes);
    } else if (narc_read_glyph(font, of.character, of.path, &error) != NARC_OK) {
        fail("%s: %s", of.name, error.message);
    }
    add_subject(all, &of);
}

/* river-01.csv, river-02.csv ... and sea-01.csv ... of a folder. */
static void read_grains(study *all, const char *folder) {
    for (size_t k = 0; k < sizeof sands / sizeof *sands; k++)
        for (unsigned number = 1;; number++) {
            char file[32];
            size_t size;
            narc_error error;
            snprintf(file, sizeof file, "%s-%02u.csv", sands[k], number);
            char *bytes = read_from(folder, file, &size);
            if (!bytes && number == 1)
                fail("%s holds no %s; grains.R of the study writes the grains", folder, file);
            if (!bytes)
                break;
            subject of = {.of = GRAINS, .number = number, .path = make_path()};
            snprintf(of.label, sizeof of.label, "%s %u", sands[k], number);
            if (narc_read_csv(bytes, size, of.path, &error) != NARC_OK)
                fail("%s/%s: %s", folder, file, error.message);
            free(bytes);
            add_subject(all, &of);
        }
}

study load_subjects(const char *font, const char *drawings, const char *grains) {
    study all = {.subjects = allocate(MOST_SUBJECTS, sizeof *all.subjects)};
    size_t size;
    char *bytes = read_bytes(font, &size);
    narc_font *opened;
    narc_error error;
    if (narc_open_font(bytes, size, &opened, &error) != NARC_OK)
        fail("%s: %s", font, error.message);
    for (size_t i = 0; i < sizeof chosen / sizeof *chosen; i++)
        if (drawings || chosen[i].of == PAPER)
            read_chosen(&all, &chosen[i], opened, drawings);
    narc_close_font(opened);
    free(bytes);
    if (grains)
        read_grains(&all, grains);
    return all;
}

void free_subjects(study *all) {
    for (size_t i = 0; i < all->count; i++) {
        narc_destroy_path(all->subjects[i].path);
        narc_release_contours(&all->subjects[i].contours);
        free(all->subjects[i].corners);
    }
    free(all->subjects);
    *all = (study){0};
}

/* ---------------------------------------------------------------------------- what is asked of them */

size_t pick(const study *all, kind which, const subject **out_some) {
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        if (which == KINDS ? of->of != GRAINS : of->of == which)
            out_some[count++] = of;
    }
    return count;
}

double value_of(const subject *of, family which, size_t size, quantity what) {
    const fit *at = &of->fits[which][size];
    const double values[QUANTITIES] = {at->made.area / at->made.hull_area, 100 * at->made.max_distance / of->extent,
                                       100 * at->made.mean_distance / of->extent, at->made.seconds};
    return at->found ? values[what] : NAN;
}

double ratio_of(const subject *of, size_t size) {
    return of->fits[N_ARC][size].made.area / of->fits[N_GON][size].made.area;
}

/* ---------------------------------------------------------------------------- simple shapes around them */

const char *const bound_names[BOUNDS] = {"circle", "AABB", "OBB", "8-gon"};

/* The rectangle around a hull with a side along `x`, a unit vector, counter-clockwise; its area is returned. */
static double find_box(const subject *of, narc_point x, narc_point out_corners[4]) {
    narc_aabb box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; k < of->corner_count; k++) {
        const narc_point p = of->corners[k];
        const double u = p.x * x.x + p.y * x.y, v = p.y * x.x - p.x * x.y;
        box = (narc_aabb){fmin(box.min_x, u), fmin(box.min_y, v), fmax(box.max_x, u), fmax(box.max_y, v)};
    }
    for (int k = 0; k < 4; k++) {
        const double u = k == 1 || k == 2 ? box.max_x : box.min_x, v = k >= 2 ? box.max_y : box.min_y;
        out_corners[k] = (narc_point){u * x.x - v * x.y, u * x.y + v * x.x};
    }
    return (box.max_x - box.min_x) * (box.max_y - box.min_y);
}

/* The least rectangle around a polygon has a side along one of its sides (Freeman and Shapira 1975). */
bounds find_bounds(const subject *of) {
    const narc_fit_request disc = {.arc_count = 1, .family = NARC_FIT_N_ARC, .goal = NARC_FIT_BOUND_AREA};
    bounds found = {.areas = {[OBB] = INFINITY}};
    narc_error error;
    if (narc_fit_path(of->path, &disc, &found.circle, &error) != NARC_OK)
        fail("%s: %s", of->name, error.message);
    found.areas[CIRCLE] = found.circle.area / found.circle.hull_area;
    found.areas[AABB] = find_box(of, (narc_point){1, 0}, found.boxes[AABB]) / of->hull_area;
    for (size_t k = 0; k < of->corner_count; k++) {
        const narc_point p = of->corners[k], q = of->corners[(k + 1) % of->corner_count];
        const double size = hypot(q.x - p.x, q.y - p.y);
        narc_point corners[4];
        const double area = find_box(of, (narc_point){(q.x - p.x) / size, (q.y - p.y) / size}, corners) / of->hull_area;
        if (area < found.areas[OBB]) {
            found.areas[OBB] = area;
            memcpy(found.boxes[OBB], corners, sizeof corners);
        }
    }
    found.areas[POLYGON] = value_of(of, N_GON, SIZES - 1, AREA);
    return found;
}
