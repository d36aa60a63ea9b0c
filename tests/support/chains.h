/* SPDX-License-Identifier: MIT
 *
 * chains.h - random ground of every kind, and bodies put on it where contacts go wrong.
 */
#ifndef NARC_TEST_CHAINS_H
#define NARC_TEST_CHAINS_H

#include "ground_reference.h"
#include "narc_chains.h"
#include "narc_scene.h"
#include "scene.h"

enum chain_family {
    CHAIN_HILLS,  /* convex and concave arcs with common tangents, edges between some */
    CHAIN_MIXED,  /* corners and valleys, too */
    CHAIN_BOWLS,  /* concave arcs in several pieces of one circle, and flat bottoms */
    CHAIN_TIGHT,  /* the same, and bodies of nearly the arcs' radius */
    CHAIN_FINE,   /* pieces smaller than bodies */
    CHAIN_STEPS,  /* edges alone, many in line */
    CHAIN_LONG,   /* 60 .. 150 pieces whose sizes span three orders of magnitude */
    CHAIN_CLOSED, /* a closed outline, arcs at its corners */
    CHAIN_ENDS,   /* one to four pieces, bare ends or capped ones */
    CHAIN_SLAB,   /* closed from here on, and thin, 0.02 to 1: a straight sheet */
    CHAIN_ARCH,   /* a sheet that bends one way, by corners or arcs */
    CHAIN_ZIGZAG, /* a sheet that bends both ways, by corners */
    CHAIN_SHEET,  /* the same by arcs: corrugated */
    CHAIN_ANGLE,  /* L: bent once */
    CHAIN_CUP,    /* bent twice the same way */
    CHAIN_PIPE,   /* all around, but for a slit */
    CHAIN_WALLS,  /* walls that stand on a slab */
    CHAIN_GEAR,
    CHAIN_FAMILIES
};

enum { CHAIN_ARCS = 512 };

const char *chain_family_name(enum chain_family family);

/* A random chain of at most CHAIN_ARCS arcs, which are the caller's to free, as are those of a polygon, counter-clockwise,
 * with corners and the bottoms of valleys. */
struct chain make_chain(struct test_random *random, enum chain_family family);
struct chain fold_chain(const narc_point *point, size_t count);

/* The mean length of its pieces. */
double chain_side(const struct chain *chain);

struct shape regular_of(size_t corners, double size, double radius);
void scale_arcs(narc_arc *arcs, size_t count, double factor);

/* A shape, and a body of it on the chain, at its origin and not turned: a feature of the body over a place of the
 * chain, junctions preferred on both sides, at a distance of up to `margin`, or as deep. */
struct shape make_rider(struct test_random *random, const struct chain *chain, enum chain_family family);
struct body ride_chain(struct test_random *random, const struct chain *chain, const struct shape *shape, double margin);

/* A body that comes out of the air near the chain, any way, until it is `gap` away; or, below 0, goes on by as much from
 * where it would touch. If there is no room for it, it is where it is. */
struct body approach_chain(struct test_random *random, const struct chain *chain, struct ground *ground,
                           const struct shape *shape, double gap);

/* ------------------------------------------------------------------------------------------------ in a store */

enum { GROUND_ENTRIES = 4 * CHAIN_ARCS, TOLD_ROWS = 256 };

/* Chains in a store, and their entries as bodies, all turned and moved by `place`, which may be set while there are none. */
struct ground_scene {
    narc_shapes *store;
    struct body place;
    struct chain chain;    /* the last one */
    struct ground *ground; /* by ground_of() */
    narc_chain_entry entries[GROUND_ENTRIES];
    struct body bodies[GROUND_ENTRIES];
    uint32_t runs[GROUND_ENTRIES];
    size_t count;
};

struct ground_scene *create_ground_scene(void);
void destroy_ground_scene(struct ground_scene *scene);
RELEASE_AT(destroy_ground_scene)

/* Takes a chain with its arcs, whatever comes of it. */
narc_status add_ground(struct ground_scene *scene, struct chain chain, narc_chain_options options, narc_error *error);

/* One chain, which the store must take; or a random one that it takes. */
struct ground_scene *lay_ground(struct chain chain, narc_chain_options options);
struct ground_scene *lay_random_ground(struct test_random *random, enum chain_family family);

/* The reference of the last chain, made when it is first asked for. */
struct ground *ground_of(struct ground_scene *scene);

/* From the chain's coordinates to the world's; back, a direction, and a body of the world as the reference wants it. */
struct body ground_to_world(const struct ground_scene *scene, struct body body);
narc_point rotate_to_ground(const struct ground_scene *scene, double x, double y);
struct reference_body pose_on_ground(const struct ground_scene *scene, const struct shape *shape,
                                     const struct body *body);

narc_bodies view_columns(const struct body *bodies, size_t count);

/* What contacts, manifolds, overlaps and casts say of pairs of other bodies, A, and entries, B: the same on every
 * instruction set, for workers that run backwards, and of each other. Free `counts`, of contacts and of manifolds. */
struct ground_answers {
    size_t *counts;
    uint64_t *bits;
    narc_contact *contacts;
    narc_manifold *manifolds;
    narc_impact *impacts;
};
struct ground_answers ask_ground(const struct ground_scene *scene, const narc_bodies *movers,
                                 const narc_motions *motions, const narc_pairs *pairs, narc_query query);

/* The least separation. */
float find_deepest(const narc_manifold *m);

/* The same of one body with all entries, where it is, on the instruction set in use: its contacts, its manifolds merged, the
 * least separation, INFINITY if there is none, and the cast that does not move of each entry. */
struct told_rows {
    narc_contact contacts[TOLD_ROWS];
    narc_manifold rows[TOLD_ROWS];
    narc_impact impacts[GROUND_ENTRIES];
    size_t contact_count, count;
    float deepest;
};
void ask_body(const struct ground_scene *scene, const struct body *body, narc_query query, struct told_rows *out);

/* The contacts of one body, A, with all entries; and the least separation. */
size_t ground_contacts(const struct ground_scene *scene, const struct body *body, narc_query query, narc_contact *rows,
                       size_t capacity);
double ground_separation(const struct ground_scene *scene, const struct body *body, narc_query query);

#endif
