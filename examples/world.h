/* SPDX-License-Identifier: MIT
 *
 * world.h - a small world of rigid bodies: what a physics engine does between two frames, made to be read.
 *
 *     world.c         from bodies to contacts: everything that narc is for
 *     world_solver.c  from contacts to velocities and positions
 *     scenes.c        worlds to look at; world_main.c runs them
 *
 * It has friction, restitution and bullets, and leaves out joints, sleeping and a solver on several threads.
 * docs/solver.md tells why everything is as it is.
 */
#ifndef WORLD_H
#define WORLD_H

#include <narc.h>
#include <narc_broad_phase.h>

typedef struct vec {
    float x, y;
} vec;

/* A body as this engine likes it. narc reads pose and shape in place, through columns. */
typedef struct world_body {
    vec position;       /* of its centre of mass, its shape's origin */
    float cosine, sine; /* next to the position: the kernels load all four at once */
    uint32_t shape;
    uint8_t still;  /* 1, which is NARC_STATIC: it never moves */
    uint8_t bullet; /* 1: it may be so fast that in one step it would pass through others */
    vec velocity;
    float spin; /* radians per second */
    float friction, restitution;
    float inverse_mass, inverse_inertia; /* 0 if it is still; world_add_body() sets them */
    vec motion;                          /* in this step, if nothing stops it */
    float turn_reach;                    /* how far rotation may carry a bullet's points in this step */
    vec moved;                           /* since the contacts were found */
    float turned;
} world_body;

/* With density 1. */
typedef struct world_shape {
    float mass, inertia;
    float reach; /* the largest distance of a point from the origin */
} world_shape;

typedef struct world_settings {
    vec gravity;
    float time_step;      /* seconds */
    unsigned substeps;    /* the solver's; contacts are found once a step */
    float rolling_arm;    /* rolling friction: its torque is this length times the normal force */
    float margin;         /* contacts are kept up to this distance */
    float skin;           /* bodies may move by this until pairs are found anew */
    float flat_angle;     /* see narc_query */
    narc_workers workers; /* narc's; none: the calling thread */
} world_settings;

/* Metres and seconds, for bodies of 0.1 to 10 m: 60 steps a second, 8 sub-steps each. */
extern const world_settings world_defaults;

/* What a pair keeps for its next step: the impulses of its points, by what touches there. */
typedef struct world_impulses {
    uint32_t feature[2];
    float normal[2], tangent[2], rolling;
} world_impulses;

/* What the engine knows of each pair in the list of pairs. */
typedef struct world_pair {
    float margin;
    uint32_t hint; /* narc's */
    world_impulses impulses;
} world_pair;

typedef struct world_point {
    vec anchor_a, anchor_b; /* from the centres of mass, world axes */
    float separation;
    float approach; /* the speed at which it closes as the step begins */
    float normal_mass, tangent_mass;
    float normal_impulse, tangent_impulse;
    float greatest_impulse;
} world_point;

typedef struct world_contact {
    uint32_t pair, a, b;
    vec normal;
    float friction, restitution;
    float rolling_impulse; /* of rotation */
    unsigned point_count;
    world_point points[2];
} world_contact;

typedef struct world {
    world_settings settings;
    narc_shapes *store;
    world_shape *shapes;
    world_body *bodies;
    size_t body_count, capacity;
    narc_broad_phase *broad_phase;
    const narc_pair_list *list;     /* pairs of bodies that are close; the broad phase owns it */
    world_pair *pairs, *next_pairs; /* of this list; room for the next one */
    narc_manifold *manifolds;
    world_contact *contacts;
    size_t pair_room, contact_count;
    narc_error error; /* what went wrong, when a function here says that something did */
} world;

/* Room for `capacity` bodies and shapes. On an error too, world_destroy() frees what there is. */
narc_status world_create(world *w, world_settings settings, size_t capacity);
void world_destroy(world *w);

/* Adds a shape, moved so that its centroid is its origin. */
narc_status world_add_shape(world *w, const narc_arc *arcs, size_t count, uint32_t *out_shape);

/* Adds a body of density 1. */
narc_status world_add_body(world *w, world_body body);

narc_status world_step(world *w);

/* Two parts of world_step(): the manifolds of the pairs, and contacts made of `count` manifolds. */
narc_status world_find_manifolds(world *w, size_t *out_count);
void world_make_contacts(world *w, size_t count);

/* The solver: from w->contacts, which world_step() finds, to new velocities and positions. */
void world_solve(world *w);

/* Of motion and height, in joules. */
double world_energy(const world *w);

/* Another number for another state, but for one in 2^64. */
uint64_t world_hash(const world *w);

static inline vec add(vec a, vec b) { return (vec){a.x + b.x, a.y + b.y}; }
static inline vec subtract(vec a, vec b) { return (vec){a.x - b.x, a.y - b.y}; }
static inline vec scale(float s, vec a) { return (vec){s * a.x, s * a.y}; }
static inline float dot(vec a, vec b) { return a.x * b.x + a.y * b.y; }
static inline float cross(vec a, vec b) { return a.x * b.y - a.y * b.x; }
static inline vec quarter_turn(vec a) { return (vec){-a.y, a.x}; }

#endif
