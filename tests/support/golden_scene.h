/* SPDX-License-Identifier: MIT
 *
 * golden_scene.h - a fixed scene, and hashes of answers to it.
 *
 * It comes from whole numbers, sums, products and quotients alone, so that no library function can make it differ.
 * Rotations are rational, ((1 - t^2) / (1 + t^2), 2 t / (1 + t^2)).
 */
#ifndef NARC_TEST_GOLDEN_SCENE_H
#define NARC_TEST_GOLDEN_SCENE_H

#include "scene.h"

/* The angle of the direction (3, 4) / 5. */
#define ANGLE_5 0.92729521800161224

/* All kinds of shapes. Double positions are the single ones, 2^30 away, and as exact. */
enum { SHAPES = 13, BODIES = 600, PAIRS = 10000 };
struct scene make_golden_scene(narc_precision precision);

/* One number of each row, as if they stood in an array. */
#define HASH_FIELD(hash, list, field)                                                                                  \
    do {                                                                                                               \
        for (size_t hash_k = 0; hash_k < (list).count; hash_k++)                                                       \
            (hash) = test_hash_items(hash, &(list).rows[hash_k].field, 1, sizeof(list).rows[hash_k].field);            \
    } while (0)

/* Of separations, normals, points and arcs. */
uint64_t hash_contacts(uint64_t hash, struct contacts list);

/* Prints a hash, and fails unless it is the recorded one. */
void check_hash(const char *name, uint64_t hash, uint64_t golden);

#endif
