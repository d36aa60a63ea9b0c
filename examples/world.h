/* SPDX-License-Identifier: MIT
 *
 * world.h - a small world of rigid bodies: what a physics engine does between two frames, made to be read.
 *
 *     world.c           shapes and bodies, which come and go; the step
 *     world_contacts.c  from bodies to contacts: everything that narc is for
 *     world_solver.c    from contacts to velocities and positions
 *     world_events.c    what begins and ends, what sleeps and wakes
 *     scenes.c          worlds to look at; world_main.c runs them
 *
 * Of joints it has pins alone, and its solver has one thread. docs/solver.md tells why everything is as it is.
 */
#ifndef WORLD_H
#define WORLD_H

#include <math.h>

#include <narc.h>
#include <narc_chains.h>
#include <narc_contacts.h>
#include <narc_scene.h>

typedef struct vec {
    float x, y;
} vec;

/* A body as this engine likes it. narc reads pose, shape, id and kind in place, through columns. */
typedef struct world_body {
    vec position;       /* of its centre of mass, its shape's origin */
    float cosine, sine; /* next to the position: the kernels load all four at once */
    uint32_t shape;
    uint8_t kind;   /* 0: it moves; NARC_STATIC; NARC_SENSOR: it goes where its velocity takes it, and pushes nothing */
    uint32_t owner; /* bodies of one owner do not meet: those of a machine. Of one that is added, UINT32_MAX: none */
    vec velocity;
    float spin; /* radians per second */
    float friction, restitution;
    bool drops; /* it falls through platforms */

    /* What follows is the world's. */
    uint64_t id;                         /* never given twice, whatever number the body has */
    uint32_t run;                        /* of ground: see narc_chain_entry */
    uint32_t platform;                   /* of ground: its number, from 1 on; 0: it is solid */
    vec start;                           /* where it was added */
    float inverse_mass, inverse_inertia; /* 0 if contacts do not move it */
    vec motion;                          /* in this step, at first if nothing stops it, then as it was */
    float turn, turn_reach;              /* its rotation in this step; how far that may carry its points */
    float ahead;                         /* how much further than the margin its contacts are to be found */
    vec from, from_rotation;             /* its pose before: position, cosine and sine */
    float stop;                          /* the part of the step after which it hits, and waits for the next one; 1 */
    float rest;                          /* for how long it has been slow, seconds */
    struct world_body *island;           /* a body of the same island, in the end its root */
} world_body;

/* With density 1. */
typedef struct world_shape {
    float mass, inertia;
    float reach;     /* the largest distance of a point from the origin */
    float thickness; /* between a quarter of its least width and that */
} world_shape;

typedef struct world_settings {
    vec gravity;
    float time_step;      /* seconds */
    unsigned substeps;    /* the solver's; contacts are found once a step */
    float spring_rate;    /* of contacts, by the rate of sub-steps */
    float rolling_arm;    /* rolling friction: its torque is this length times the normal force */
    float margin;         /* contacts are kept up to this distance */
    float skin;           /* bodies may move by this until pairs are found anew */
    float flat_angle;     /* see narc_query */
    float recycling;      /* a contact serves again while its bodies have moved less than this; 0: never */
    float sleep_speed;    /* of a body's fastest point */
    float sleep_time;     /* what is slower for so long sleeps; INFINITY: nothing does */
    narc_workers workers; /* narc's; none: the calling thread */
} world_settings;

/* Metres and seconds, for bodies of 0.1 to 10 m: 60 steps a second, 4 sub-steps each. */
extern const world_settings world_defaults;

typedef struct world_point {
    uint32_t feature;
    bool walks, edge_a, edge_b;           /* along arcs while the bodies roll; what touches is an edge */
    vec normal, normal_in_a, normal_in_b; /* from A to B: world axes; as it was found, in the frames of A and B */
    vec anchor_a, anchor_b;               /* from the centres of mass, world axes: the lever arms of impulses */
    vec local_a, local_b; /* in the frames of A and B: their surfaces there, or the centres of the arcs that touch */
    float radius_a, radius_b;        /* of these arcs: what lies between the centres and the surfaces */
    uint16_t reach_a[2], reach_b[2]; /* how far the normal may turn on them */
    float separation;                /* as the step begins */
    float approach;                  /* the speed at which it closes then */
    float normal_mass, tangent_mass;
    float normal_impulse, tangent_impulse; /* the next step starts with them */
    float greatest_impulse;                /* in this step */
} world_point;

/* What the engine knows of a pair that is close, in the slot that narc keeps for it; zeros for one that is new. */
typedef struct world_contact {
    world_body *a, *b;
    float margin;
    float depth;   /* above 0: the bodies could pass through each other in this step, and may get so deep */
    bool touching; /* has begun and has not ended */
    bool passes;   /* one of them is a platform, and the other came from behind, or drops: until it is clear of it */
    unsigned point_count;
    float friction, restitution;
    float rolling_impulse; /* of rotation */
    world_point points[2];
} world_contact;

typedef struct world_event {
    uint64_t id_a, id_b;
    bool begins; /* else it ends */
    bool sensor; /* one of them is */
} world_event;

typedef struct world {
    world_settings settings;
    narc_shapes *store;
    world_shape *shapes;
    world_body *bodies; /* behind them the ground's entries, which nothing but contacts knows of */
    size_t body_count, ground_count, capacity, pair_room;
    uint32_t run_count, platform_count;
    uint64_t last_id;
    narc_contacts *contacts;        /* pairs that are close, their rows, and a world_contact of each */
    const narc_step_result *result; /* of this step; `contacts` owns it */
    world_contact **active;         /* those with points and a body that moves: what the solver goes through */
    world_contact *joints;
    world_event *events;
    size_t active_count, joint_count, event_count;
    narc_error error; /* what went wrong, when a function here says that something did */
} world;

/* Room for `capacity` bodies, entries of ground among them, and as many shapes, and 16 times as many pairs.
 * world_destroy() frees what there is, on an error too. */
narc_status world_create(world *w, world_settings settings, size_t capacity);
void world_destroy(world *w);

/* Adds a shape, moved so that its centroid is its origin. */
narc_status world_add_shape(world *w, const narc_arc *arcs, size_t count, uint32_t *out_shape);

/* Adds a body of density 1, and gives it an id, from 1 on. */
narc_status world_add_body(world *w, world_body body);

/* Adds a chain (narc_chains.h), whose entries are static bodies behind all others. */
narc_status world_add_ground(world *w, const narc_arc *arcs, size_t count, bool closed, float friction);

/* The same of a platform, which bodies stand on, but pass from behind, and where they drop. The first one has number 1. */
narc_status world_add_platform(world *w, const narc_arc *arcs, size_t count, float friction);

/* A platform moves like that from now on, and what stands on it with it. */
void world_move_platform(world *w, uint32_t platform, vec velocity);

/* Joins two bodies at a point, about which they may turn. Neither can be removed, nor the last body in its place. */
narc_status world_pin(world *w, world_body *a, world_body *b, vec point);

/* The body goes, and the last one takes its place. */
void world_remove_body(world *w, world_body *body);

/* The body with this id, or NULL. */
world_body *world_find_body(const world *w, uint64_t id);

/* Who pushes a body wakes it. What it lies among wakes with it. */
void world_wake_body(world_body *body);

/* Afterwards w->events are what began and ended in it. */
narc_status world_step(world *w);

/* ------------------------------------------------------------------------------------------------ parts of the step */

/* Notes what went wrong, and returns the status. */
narc_status world_fail(world *w, narc_status status, const char *message);

/* world_contacts.c: pairs and rows; what the solver wants of them. */
narc_status world_update_contacts(world *w);
void world_make_contacts(world *w);

/* What was so fast that it passed into a body, or through it, stands where the two met: it loses time, no momentum. */
narc_status world_stop_bullets(world *w);

/* world_solver.c: from active contacts to new velocities and positions. */
void world_solve(world *w);

/* world_events.c. */
void world_end_lost_pairs(world *w);
void world_sleep(world *w);
void world_list_events(world *w);

/* What is known of pair k, in the order of pairs. */
static inline world_contact *world_contact_of(const world *w, size_t k) {
    return (world_contact *)w->result->user + w->result->order[k];
}

/* ------------------------------------------------------------------------------------------------ measures */

/* Of motion and height, in joules. */
double world_energy(const world *w);

/* Another number for another state, but for one in 2^64. */
uint64_t world_hash(const world *w);

/* Of the fastest point of a body. */
float world_speed(const world *w, const world_body *body);

static inline vec add(vec a, vec b) { return (vec){a.x + b.x, a.y + b.y}; }
static inline vec subtract(vec a, vec b) { return (vec){a.x - b.x, a.y - b.y}; }
static inline vec scale(float s, vec a) { return (vec){s * a.x, s * a.y}; }
static inline float dot(vec a, vec b) { return a.x * b.x + a.y * b.y; }
static inline float cross(vec a, vec b) { return a.x * b.y - a.y * b.x; }
static inline float length(vec a) { return sqrtf(dot(a, a)); }
/* Not fminf() and fmaxf(): where NaN has to be minded these are calls. */
static inline float smaller(float a, float b) { return a < b ? a : b; }
static inline float larger(float a, float b) { return a > b ? a : b; }

static inline vec quarter_turn(vec a) { return (vec){-a.y, a.x}; }

/* From a body's axes to the world's, and back. */
static inline vec to_world(const world_body *body, vec v) {
    return (vec){body->cosine * v.x - body->sine * v.y, body->sine * v.x + body->cosine * v.y};
}
static inline vec to_local(const world_body *body, vec v) {
    return (vec){body->cosine * v.x + body->sine * v.y, body->cosine * v.y - body->sine * v.x};
}

/* From A's local point to B's, world axes. */
static inline vec find_span(const world_contact *c, const world_point *p) {
    return add(subtract(c->b->position, c->a->position),
               subtract(to_world(c->b, p->local_b), to_world(c->a, p->local_a)));
}

#endif
