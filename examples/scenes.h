/* SPDX-License-Identifier: MIT
 *
 * scenes.h - worlds to look at, and what tells whether they do as they should.
 */
#ifndef SCENES_H
#define SCENES_H

#include "world.h"

typedef struct scene {
    const char *name, *purpose;
    float seconds; /* how long it is worth watching */
    size_t capacity;
    void (*build)(world *w, uint64_t seed);  /* notes what goes wrong in w->error */
    narc_status (*act)(world *w, long step); /* before each step, from 1 on; or NULL */
} scene;

extern const scene scenes[]; /* the last one has no name */

/* By name, or NULL. */
const scene *find_scene(const char *name);

/* Builds the scene in a new world. Another seed puts bodies a little elsewhere. */
narc_status build_scene(const scene *chosen, world_settings settings, uint64_t seed, world *out_world);

/* Ground that is walked from right to left with the air above (narc_chains.h): arcs with common tangents, and edges. */
typedef struct track {
    narc_arc arcs[256];
    size_t count;
    double x, y, normal; /* where it is; the angle of the outward normal */
} track;

void put_arc(track *t, double radius, double sweep);
void put_edge(track *t, double length);

/* From left to right. */
void add_platform(world *w, double left, double right, double height);

/* A looping of radius 2 around (x, 2), a ramp on its left, and on the ramp a marble, so far above its lowest place. */
void add_looping(world *w, double x, double height);

/* A car at rest on the ground at (x, y): its hull, then its wheels, the scene's first bodies; and its motor. */
void add_car(world *w, double x, double y);
narc_status act_car(world *w, long step);

typedef struct scene_state {
    double energy;       /* J */
    double displacement; /* the largest distance of a body from where it was added, m */
    double sideways;     /* the same along x alone */
    double overlap;      /* the deepest at the last step, m */
    size_t moving;       /* bodies of which a point is faster than 1 cm/s */
    size_t awake, points;
} scene_state;

/* One step, after what the scene does in it. */
narc_status step_scene(const scene *chosen, world *w, long step);

scene_state measure_scene(const world *w);

#endif
