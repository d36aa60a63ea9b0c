/* SPDX-License-Identifier: MIT
 *
 * scene.c - the tables of shapes and of scenes, scenes by their names, pyramids.
 */
#include "scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "random.h"

enum { MAX_SCENES = 256 };

static const struct family families[] = {
    {"n4", FORM_N_ARC, 4, NULL},
    {"n6", FORM_N_ARC, 6, NULL},
    {"n8", FORM_N_ARC, 8, NULL},
    {"n12", FORM_N_ARC, 12, NULL},
    {"n16", FORM_N_ARC, 16, NULL},
    {"kinds", FORM_KINDS, 8, NULL},
    {"rounded", FORM_ROUNDED, 8, NULL},
    {"rounded5", FORM_ROUNDED, 5, NULL},
    {"balls-boxes", FORM_BALLS_BOXES, 4, NULL},
    {"boxes", FORM_BOX, 4, NULL},
    {"squares", FORM_SQUARE, 4, NULL},
    {"discs", FORM_DISC, 8, NULL},
    {"capsules", FORM_CAPSULE, 4, NULL},
    {"gons4", FORM_POLYGON, 4, "n4"},
    {"gons6", FORM_POLYGON, 6, "n6"},
    {"gons8", FORM_POLYGON, 8, "n8"},
};
enum { FAMILIES = sizeof families / sizeof families[0] };

static const struct layout_kind layouts[] = {
    {"pyramid", LAYOUT_PYRAMID, 4096, 16384},   {"pyramid-templates", LAYOUT_PYRAMID, 16, 16384},
    {"pile-2000", LAYOUT_PILE, 64, 2000},       {"pile-10000", LAYOUT_PILE, 64, 10000},
    {"pile", LAYOUT_PILE, 64, 30000},           {"pile-each", LAYOUT_PILE, 30000, 30000},
    {"pile-1000000", LAYOUT_PILE, 64, 1000008},
};
enum { LAYOUTS = sizeof layouts / sizeof layouts[0] };

static size_t pairs_asked = 65536;

const struct family *find_family(const char *name) {
    for (size_t k = 0; k < FAMILIES; k++)
        if (strcmp(families[k].name, name) == 0)
            return &families[k];
    return NULL;
}

const struct layout_kind *find_layout(const char *name) {
    for (size_t k = 0; k < LAYOUTS; k++)
        if (strcmp(layouts[k].name, name) == 0)
            return &layouts[k];
    return NULL;
}

bool is_pile(const struct layout_kind *kind) { return kind->layout == LAYOUT_PILE; }

void set_pairs(size_t pairs) { pairs_asked = pairs; }

size_t scaled(size_t count) {
    const size_t some = (size_t)((double)count * (double)pairs_asked / 65536);
    return some < 64 ? 64 : some;
}

/* ------------------------------------------------------------------------------------------------ steps */

static void store_shapes(struct scene *scene) {
    scene->shapes = NULL;
    must(narc_create_shapes(NULL, &scene->shapes), NULL);
    for (size_t k = 0; k < scene->shape_count; k++)
        add_outline(scene->shapes, &scene->outlines[k]);
}

static void make_shapes(struct scene *scene) {
    uint64_t random = scene->family->edges;
    scene->shape_count = scene->kind->shapes;
    if (is_pile(scene->kind) && scene->shape_count > scaled(scene->kind->size))
        scene->shape_count = scaled(scene->kind->size);
    scene->outlines = allocate(scene->shape_count, sizeof *scene->outlines);
    for (size_t k = 0; k < scene->shape_count; k++)
        scene->outlines[k] = make_outline(scene->family->form, scene->family->edges, k, &random);
    store_shapes(scene);
}

/* The same bodies and pairs, with polygons in the place of n-arcs, and as large. */
static void replace_shapes(struct scene *scene) {
    struct outline *outlines = allocate(scene->shape_count, sizeof *outlines);
    for (size_t k = 0; k < scene->shape_count; k++)
        outlines[k] = polygon_of(&scene->outlines[k], true);
    scene->outlines = outlines;
    store_shapes(scene);
}

static void move_bodies(struct scene *scene) {
    uint64_t random = 2;
    const double most = is_pile(scene->kind) ? 0.001 : 0;
    struct body *bodies = allocate(scene->body_count, sizeof *bodies);
    for (size_t k = 0; k < scene->body_count; k++) {
        const struct body *body = &scene->bodies[k];
        const double turn = random_between(&random, -most, most), size = extent_of(&scene->outlines[body->shape]);
        const double angle = atan2(body->sine, body->cosine) + turn;
        bodies[k] = (struct body){(float)(body->x + most * size * random_between(&random, -1, 1)),
                                  (float)(body->y + most * size * random_between(&random, -1, 1)), (float)cos(angle),
                                  (float)sin(angle), body->shape};
    }
    scene->bodies = bodies;
}

/* Adds a pair of the bodies at two positions, if there are such: row y has `width` - y. */
static void add_neighbours(struct scene *scene, size_t width, size_t a, size_t x, size_t y) {
    if (y < width && x < width - y)
        scene->pairs[scene->pair_count++] = (struct pair){(uint32_t)a, (uint32_t)(y * width - y * (y - 1) / 2 + x)};
}

/* Squares in rows, each pair of neighbours. */
void make_pyramid(struct scene *scene) {
    const size_t width = (size_t)sqrt((double)scaled(scene->kind->size) / 1.5);
    scene->pairs = allocate(4 * width * width, sizeof *scene->pairs);
    scene->bodies = allocate(width * width, sizeof *scene->bodies);
    scene->body_count = scene->pair_count = 0;
    for (size_t y = 0; y < width; y++) {
        for (size_t x = 0; x < width - y; x++) {
            const size_t body = scene->body_count++;
            scene->bodies[body] = (struct body){.x = (float)(1.05 * ((double)x + 0.5 * (double)y)),
                                                .y = (float)(0.9995 * (double)y),
                                                .cosine = 1,
                                                .shape = (uint32_t)(body % scene->shape_count)};
            add_neighbours(scene, width, body, x + 1, y);
            add_neighbours(scene, width, body, x - 1, y + 1);
            add_neighbours(scene, width, body, x, y + 1);
        }
    }
}

static int compare_pairs(const void *left, const void *right) {
    const struct pair *l = left, *r = right;
    return l->a != r->a ? (l->a > r->a) - (l->a < r->a) : (l->b > r->b) - (l->b < r->b);
}

/* From another scene by one step, or from nothing. */
static void make_scene(struct scene *scene) {
    const struct family *family = scene->family;
    const struct layout_kind *kind = scene->kind;
    const struct scene made = *scene;
    if (family->source) {
        *scene = *get_scene(find_family(family->source), kind, scene->moved);
        scene->family = family;
        replace_shapes(scene);
    } else if (scene->moved) {
        *scene = *get_scene(family, kind, false);
        move_bodies(scene);
    } else {
        make_shapes(scene);
        (is_pile(kind) ? make_pile : make_pyramid)(scene);
        qsort(scene->pairs, scene->pair_count, sizeof *scene->pairs, compare_pairs);
    }
    scene->family = family;
    scene->kind = kind;
    scene->moved = made.moved;
    scene->gaps = NULL;
    scene->boxes = NULL;
    scene->index = NULL;
    scene->half = 0;
}

struct scene *get_scene(const struct family *family, const struct layout_kind *kind, bool moved) {
    static struct scene *scenes[MAX_SCENES];
    static size_t count;
    for (size_t k = 0; k < count; k++)
        if (scenes[k]->family == family && scenes[k]->kind == kind && scenes[k]->moved == moved)
            return scenes[k];
    struct scene *scene = allocate(1, sizeof *scene);
    *scene = (struct scene){.family = family, .kind = kind, .moved = moved};
    make_scene(scene);
    if (count == MAX_SCENES)
        fail("more than %d scenes", MAX_SCENES);
    scenes[count++] = scene;
    return scene;
}

/* ------------------------------------------------------------------------------------------------ what is asked of it */

const double *gaps_of(struct scene *scene) {
    if (scene->gaps)
        return scene->gaps;
    scene->gaps = allocate(scene->pair_count, sizeof *scene->gaps);
    for (size_t k = 0; k < scene->pair_count; k++) {
        struct vector normal;
        scene->gaps[k] =
            exact_gap(scene->outlines, &scene->bodies[scene->pairs[k].a], &scene->bodies[scene->pairs[k].b], &normal);
    }
    return scene->gaps;
}

narc_bodies bodies_of_scene(const struct scene *scene) { return bodies_of(scene->bodies, scene->body_count); }

narc_pairs pairs_of_scene(const struct scene *scene) {
    return (narc_pairs){
        .count = scene->pair_count, .a = NARC_COLUMN(scene->pairs, a), .b = NARC_COLUMN(scene->pairs, b)};
}

void find_boxes(const struct scene *scene, double room, const narc_workers *workers, narc_box *out_boxes) {
    const narc_bodies bodies = bodies_of_scene(scene);
    const narc_box_options options = {.margin = (float)room, .workers = workers};
    narc_error error;
    must(narc_compute_boxes(scene->shapes, &bodies, &options, out_boxes, &error), &error);
}

void index_scene(struct scene *scene) {
    narc_error error;
    if (scene->index)
        return;
    scene->boxes = allocate(scene->body_count, sizeof *scene->boxes);
    find_boxes(scene, 0, NULL, scene->boxes);
    must(narc_create_index(NULL, &scene->index), NULL);
    must(narc_build_index(scene->index, scene->boxes, scene->body_count, NULL, &error), &error);
    for (size_t k = 0; k < scene->body_count; k++)
        scene->half = fmax(scene->half, fmax(fabs((double)scene->bodies[k].x), fabs((double)scene->bodies[k].y)));
}
