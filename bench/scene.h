/* SPDX-License-Identifier: MIT
 *
 * scene.h - what the rows run on: shapes, bodies and pairs, by two words of a row's name.
 */
#ifndef NARC_BENCH_SCENE_H
#define NARC_BENCH_SCENE_H

#include "narc_broad_phase.h"
#include "narc_contacts.h"
#include "narc_scene.h"
#include "shapes.h"

/* A pair whose exact separation is closer to 0 than this may have either answer. */
#define TOUCHING 1e-5

/* A pair's boxes in a pile are at most this apart, in x and in y: a tenth of a body's size, which is some 2. */
#define SKIN 0.2

/* The shapes of a scene: "n8", "boxes". Some stand for those of another family, in the same places. */
struct family {
    const char *name;
    enum form form;
    unsigned edges; /* arcs of an n-arc, vertices of a polygon */
    const char *source;
};

/* Where bodies are. */
enum layout {
    LAYOUT_PYRAMID, /* equal squares at rest, each with a gap to the next in its row */
    LAYOUT_PILE,    /* bodies that hold each other in place, as a simulation has them: see pile.c */
};

struct layout_kind {
    const char *name;
    enum layout layout;
    size_t shapes; /* how many different ones */
    size_t size;   /* pairs; of piles, bodies; by 65,536 pairs that a scene is asked to have */
};

struct pair {
    uint32_t a, b;
};

struct scene {
    const struct family *family;
    const struct layout_kind *kind;
    bool moved; /* the next frame: in piles every body moved by up to 0.1 % of its size, and turned by up to 0.001 */
    size_t shape_count, body_count, pair_count;
    struct outline *outlines;
    narc_shapes *shapes; /* the same */
    struct body *bodies;
    struct pair *pairs;
    double *gaps;                /* exact, one per pair, once they were asked for */
    const struct vector *ground; /* a chain from right to left, the air above; with a peer's step alone */
    size_t ground_count;

    /* Of the bodies, once they were asked for; `half` is half the width of the square around the origin. */
    narc_box *boxes;
    narc_index *index;
    double half;
};

/* By name; NULL if there is none. Behind the last one comes NULL. */
const struct family *find_family(const char *name);
const struct layout_kind *find_layout(const char *name);

bool is_pile(const struct layout_kind *kind);

/* How many of something there are, if scenes have `set_pairs` pairs instead of 65,536. */
size_t scaled(size_t count);
void set_pairs(size_t pairs);

/* Makes a scene, or finds the one made before. The same arguments always give the same one. */
struct scene *get_scene(const struct family *family, const struct layout_kind *kind, bool moved);
const double *gaps_of(struct scene *scene);
void index_scene(struct scene *scene);

narc_bodies bodies_of_scene(const struct scene *scene);
narc_pairs pairs_of_scene(const struct scene *scene);

/* Boxes around bodies, with `room` on each side. */
void find_boxes(const struct scene *scene, double room, const narc_workers *workers, narc_box *out_boxes);

/* Bodies and pairs of a scene that has shapes. */
void make_pyramid(struct scene *scene);
void make_pile(struct scene *scene);

#endif
