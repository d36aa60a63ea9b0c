/* SPDX-License-Identifier: MIT
 *
 * walker.h - a character that walks among bodies: no rigid body, which forces push, but a shape that goes where it is told
 * and slides along what is in its way.
 *
 * A motion is clipped by the planes of what touches already: their contacts. What is further away stops it by a cast, and has
 * its plane then. The cast lets go what touches (narc_cast_options.parting), as the planes see to that.
 */
#ifndef WALKER_H
#define WALKER_H

#include <narc.h>
#include <narc_scene.h>

/* What it walks among. */
typedef struct walker_scene {
    const narc_shapes *shapes;
    narc_index *index; /* of the bodies */
    const narc_bodies *bodies;
    narc_index_query search;  /* whom it may meet; {0}: all */
    const narc_point *origin; /* of the index's boxes, as in narc_box_options; NULL: (0, 0) */
} walker_scene;

typedef struct walker {
    narc_body body;
    float skin;         /* so far from others it stays */
    float step;         /* it climbs over as much */
    float steepest;     /* slopes on which it stands have normals whose y is no less: the cosine of their angle */
    uint32_t stands_on; /* a body of the scene, or UINT32_MAX: it is in the air */
} walker;

/* It may move by as much along the unit normal, not more; less than 0: it is to move back. */
typedef struct walker_plane {
    double x, y, room;
} walker_plane;

/* The motion nearest to (*x, *y) that no plane forbids; if there is none, no motion. */
void walker_clip(const walker_plane *planes, size_t count, double *x, double *y);

/* Moves it by (x, y), or as far as that goes, sliding. */
narc_status walker_move(walker *w, const walker_scene *scene, double x, double y, narc_error *error);

/* To the side by x on foot: up by a step, as far as there is room, along, and down on to what is there, no lower than a step
 * below. So it climbs stairs, and stays on slopes and stairs that lead down. */
narc_status walker_step(walker *w, const walker_scene *scene, double x, narc_error *error);

/* Lets it down by `most` at most, on to what is below. On slopes that are too steep it slides; on a corner it stands, if that
 * is no higher above its feet than a step. */
narc_status walker_fall(walker *w, const walker_scene *scene, double most, narc_error *error);

#endif
