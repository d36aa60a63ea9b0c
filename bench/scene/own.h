/* SPDX-License-Identifier: MIT
 *
 * own.h - the scenes that this library and its peers are asked about.
 */
#ifndef NARC_BENCH_SCENE_OWN_H
#define NARC_BENCH_SCENE_OWN_H

#include "narc_scene.h"
#include "workload.h"

/* Bodies, their boxes and an index of these; `half` is that of the square around the origin that has all positions. */
struct own {
    const struct workload *scene;
    narc_bodies bodies;
    narc_box *boxes;
    narc_index *index;
    double half;
};

/* The shapes of a settled pile, `spread` times as far apart. It stays until the program's end. */
struct own make_own(enum family family, size_t bodies, double spread);

#endif
