/* SPDX-License-Identifier: MIT
 *
 * own.c - settled piles and sparse scenes with their index.
 */
#include "own.h"

#include <math.h>

#include "common.h"
#include "narc_broad_phase.h"
#include "scenes.h"

struct own make_own(enum family family, size_t bodies, double spread) {
    const struct workload_key key = {
        .edges = 8, .family = family, .scene = SCENE_SETTLED, .variety = FEW, .sorted = true, .body_count = bodies};
    struct workload *const scene = allocate(1, sizeof *scene);
    *scene = *get_workload(&key);
    struct body *const copy = allocate(scene->body_count, sizeof *copy);
    struct own own = {.scene = scene, .boxes = allocate(scene->body_count, sizeof *own.boxes)};
    for (size_t k = 0; k < scene->body_count; k++) {
        copy[k] = scene->bodies[k];
        copy[k].x = (float)(copy[k].x * spread);
        copy[k].y = (float)(copy[k].y * spread);
        own.half = fmax(own.half, fmax(fabs((double)copy[k].x), fabs((double)copy[k].y)));
    }
    scene->bodies = copy;
    own.bodies = bodies_of(copy, scene->body_count);
    must(narc_compute_boxes(scene->shapes, &own.bodies, NULL, own.boxes, NULL), NULL);
    must(narc_create_index(NULL, &own.index), NULL);
    must(narc_build_index(own.index, own.boxes, scene->body_count, NULL, NULL), NULL);
    return own;
}
