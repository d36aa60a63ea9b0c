/* SPDX-License-Identifier: MIT
 *
 * subjects.c - the outlines of the study: which they are, and how they are read.
 */
#include <cairo.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "study.h"
#include "text.h"

const size_t sizes[SIZES] = {4, 6, 8};
const char *const family_names[FAMILIES] = {"n-arc", "arcs + edges", "n-gon", "paper's route"};
const narc_fit_family family_requests[FAMILIES] = {NARC_FIT_N_ARC, NARC_FIT_EDGES, NARC_FIT_POLYGON, NARC_FIT_PAPER};
const char *const kind_names[KINDS] = {"the paper's four",   "letters and digits", "animals",     "plants and fruit",
                                       "tools and vehicles", "plain signs",        "sand grains", "pixels"};

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
    {.name = "pear, as an image", .of = IMAGE, .image = "pear"},
};
enum { CHOSEN = sizeof chosen / sizeof chosen[0] };

double area_of(const subject *of, family which, size_t size) {
    const fit *made = &of->fits[which][size];
    return made->found ? made->made.area / made->made.hull_area : NAN;
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

/* ---------------------------------------------------------------------------- readers */

char *read_from(const char *folder, const char *name, size_t *out_size) {
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

static void read_drawing(const subject *of, const char *folder) {
    size_t size;
    char *bytes = read_from(folder, of->file, &size);
    if (!bytes)
        fail("%s/%s is missing; it belongs to the package openclipart-svg of Debian 12", folder, of->file);
    narc_error error;
    if (narc_read_svg(bytes, size, NULL, of->path, &error) != NARC_OK)
        fail("%s/%s: %s", folder, of->file, error.message);
    free(bytes);
}

typedef struct memory {
    unsigned char *bytes;
    size_t size, capacity;
} memory;

static cairo_status_t append(void *context, const unsigned char *bytes, unsigned count) {
    memory *to = context;
    to->bytes = grow(to->bytes, &to->capacity, to->size + count, 1);
    memcpy(to->bytes + to->size, bytes, count);
    to->size += count;
    return CAIRO_STATUS_SUCCESS;
}

/* A PNG image of another subject's outline, filled, with this many pixels along its larger side and an empty frame. */
static memory draw_pixels(const subject *from) {
    enum { PIXELS = 256, FRAME = 2 };
    double left = INFINITY, low = INFINITY;
    for (size_t k = 0; k < from->around.count; k++) {
        left = fmin(left, from->around.corners[k].x);
        low = fmin(low, from->around.corners[k].y);
    }
    const double scale = PIXELS / from->extent, side = PIXELS + 2 * FRAME;
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, (int)side, (int)side);
    cairo_t *pen = cairo_create(surface);
    size_t start = 0;
    for (size_t k = 0; k < from->contours.count; start = from->contours.ends[k++]) {
        for (size_t i = start; i < from->contours.ends[k]; i++) {
            const narc_point p = from->contours.points[i];
            cairo_line_to(pen, FRAME + scale * (p.x - left), side - FRAME - scale * (p.y - low));
        }
        cairo_close_path(pen);
        cairo_new_sub_path(pen);
    }
    cairo_fill(pen);
    memory png = {0};
    const cairo_status_t status = cairo_surface_write_to_png_stream(surface, append, &png);
    cairo_destroy(pen);
    cairo_surface_destroy(surface);
    if (status != CAIRO_STATUS_SUCCESS)
        fail("%s: %s", from->name, cairo_status_to_string(status));
    return png;
}

static const subject *find_subject(const study *all, const char *name) {
    for (size_t i = 0; i < all->count; i++)
        if (strcmp(all->subjects[i].name, name) == 0)
            return &all->subjects[i];
    fail("no subject is called %s", name);
}

static void read_pixels(const study *all, const subject *of) {
    memory png = draw_pixels(find_subject(all, of->image));
    narc_error error;
    if (narc_read_png(png.bytes, png.size, NULL, of->path, &error) != NARC_OK)
        fail("%s: %s", of->name, error.message);
    free(png.bytes);
}

/* ---------------------------------------------------------------------------- all */

narc_path *make_path(void) {
    narc_path *path;
    if (narc_create_path(&path) != NARC_OK)
        fail("not enough memory for an outline");
    return path;
}

static void find_extent(subject *of) {
    narc_aabb box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; k < of->around.count; k++) {
        const narc_point p = of->around.corners[k];
        box = (narc_aabb){fmin(box.min_x, p.x), fmin(box.min_y, p.y), fmax(box.max_x, p.x), fmax(box.max_y, p.y)};
    }
    of->extent = fmax(box.max_x - box.min_x, box.max_y - box.min_y);
}

void measure_subject(subject *of) {
    narc_error error;
    if (narc_flatten_path(of->path, 0, &of->contours, &error) != NARC_OK)
        fail("%s: %s", of->name, error.message);
    of->around = make_hull(of->name, of->contours.points, of->contours.point_count);
    find_extent(of);
    measure_corners(of);
    for (size_t size = 0; size < SIZES; size++)
        of->greedy[size] = find_greedy_area(&of->around, sizes[size]);
}

static void add_subject(study *all, const subject *from, const char *file, narc_font *font, const char *drawings) {
    subject *of = &all->subjects[all->count];
    *of = *from;
    of->path = make_path();
    narc_error error;
    if (of->file)
        read_drawing(of, drawings);
    else if (of->image)
        read_pixels(all, of);
    else if (narc_read_glyph(font, of->character, of->path, &error) != NARC_OK)
        fail("%s: %s", file, error.message);
    measure_subject(of);
    all->count++;
}

study load_subjects(const char *font, const char *drawings, const char *grains) {
    _Static_assert((int)CHOSEN <= (int)MOST_SUBJECTS, "there is room for the chosen");
    study all = {.subjects = allocate(MOST_SUBJECTS, sizeof *all.subjects)};
    size_t size;
    char *bytes = read_bytes(font, &size);
    narc_font *opened;
    narc_error error;
    if (narc_open_font(bytes, size, &opened, &error) != NARC_OK)
        fail("%s: %s", font, error.message);
    for (size_t i = 0; i < CHOSEN; i++)
        if (drawings || chosen[i].of == PAPER)
            add_subject(&all, &chosen[i], font, opened, drawings);
    narc_close_font(opened);
    free(bytes);
    if (grains)
        add_grains(&all, grains);
    return all;
}

void free_subjects(study *all) {
    for (size_t i = 0; i < all->count; i++) {
        narc_destroy_path(all->subjects[i].path);
        narc_release_contours(&all->subjects[i].contours);
        free_hull(&all->subjects[i].around);
    }
    free(all->subjects);
    *all = (study){0};
}
