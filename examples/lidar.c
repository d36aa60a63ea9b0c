/* SPDX-License-Identifier: MIT
 *
 * lidar.c - a robot drives through a room by what its laser scanner sees, 1,080 rays a turn, and draws a map of it.
 *   cc lidar.c -o lidar $(pkg-config --cflags --libs narc) -lm
 */
#include <math.h>
#include <narc.h>
#include <narc_broad_phase.h>
#include <narc_scene.h>
#include <stdio.h>
#include <stdlib.h>

#include "glyphs.h"

enum { RAYS = 1080, WALLS = 4, BODIES = 60 + WALLS, SCANS = 2000 };

static const float TURN = 6.2831853f, RANGE = 12, ROOM = 10; /* radians; metres: how far it sees, half the room */
static const float RADIUS = 0.25f, STEP = 0.05f,
                   STEERING = 0.25f; /* of the robot; metres and radians a scan, at most */
static const float SIGHT = 2;        /* what is further away does not turn it */

typedef struct room {
    narc_shapes *shapes;
    narc_index *index;
    narc_body body[BODIES];
} room;

typedef struct robot {
    double x, y;
    float heading;
} robot;

static float pick(float from, float to) { return from + (to - from) * (float)rand() / (float)RAND_MAX; }

/* Four walls, and glyphs that lie about, but not where the robot starts. */
static narc_status build_room(room *r, narc_error *error) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_box box[BODIES];
    narc_status status = narc_create_shapes(NULL, &r->shapes);
    for (int k = 0; k < GLYPH_COUNT && status == NARC_OK; k++)
        status = narc_add_shape(r->shapes, glyphs[k], GLYPH_ARCS, NULL, error);
    if (status == NARC_OK)
        status = narc_build_box(2 * ROOM, 0.5f, 0, arcs, &count, error);
    if (status == NARC_OK)
        status = narc_add_shape(r->shapes, arcs, count, NULL, error);
    for (int k = 0; k < BODIES; k++) {
        const float angle = k < WALLS ? TURN / 4 * (float)k : pick(0, TURN), c = cosf(angle), s = sinf(angle);
        const float x = pick(1.5f, ROOM - 1), y = pick(0, TURN);
        r->body[k] = k < WALLS ? (narc_body){(double)(-s * ROOM), (double)(c * ROOM), c, s, 1, GLYPH_COUNT}
                               : (narc_body){(double)(x * cosf(y)), (double)(x * sinf(y)),    c, s,
                                             pick(0.4f, 1.2f),      (uint32_t)k % GLYPH_COUNT};
    }
    narc_bodies bodies;
    narc_view_bodies(r->body, BODIES, &bodies);
    if (status == NARC_OK)
        status = narc_compute_boxes(r->shapes, &bodies, NULL, box, error);
    if (status == NARC_OK)
        status = narc_create_index(NULL, &r->index);
    return status == NARC_OK ? narc_build_index(r->index, box, BODIES, NULL, error) : status;
}

/* One turn of the scanner: ray k points k / RAYS of a turn to the left of where the robot is heading. */
static narc_status scan(const room *r, const robot *at, narc_ray_hit *hits, narc_error *error) {
    float angle[RAYS], x[RAYS], y[RAYS];
    for (int k = 0; k < RAYS; k++)
        angle[k] = at->heading + TURN * (float)k / RAYS;
    const narc_status status = narc_compute_poses(angle, RAYS, x, y, error);
    if (status != NARC_OK)
        return status;
    for (int k = 0; k < RAYS; k++) {
        x[k] *= RANGE;
        y[k] *= RANGE;
    }
    narc_bodies bodies;
    narc_view_bodies(r->body, BODIES, &bodies);
    const narc_rays rays = {.count = RAYS,
                            .x = {&at->x, 0, NARC_FLOAT64}, /* all from one place */
                            .y = {&at->y, 0, NARC_FLOAT64},
                            .motion_x = NARC_ARRAY(x),
                            .motion_y = NARC_ARRAY(y)};
    return narc_cast_rays(r->index, r->shapes, &bodies, &rays, NULL, hits, RAYS, error);
}

static float measure(const narc_ray_hit *hit) { return hit->count ? hit->fraction * RANGE : RANGE; }

/* Turns towards where the robot has room, if it has to: ahead rather than aside. */
static void steer(robot *at, const narc_ray_hit *hits) {
    int best = 0;
    float most = -1;
    for (int k = -RAYS / 2; k <= RAYS / 2; k += 9) {
        float room = SIGHT;
        for (int i = -45; i <= 45; i += 3) { /* 15 degrees to either side */
            const float far = measure(&hits[(k + i + 2 * RAYS) % RAYS]),
                        aside = far * fabsf(sinf(TURN * (float)i / RAYS));
            room = fminf(room, aside < 2 * RADIUS ? far : SIGHT);
        }
        const float gain = room * (1 - 0.5f * fabsf((float)k) / (RAYS / 2));
        if (gain > most) {
            most = gain;
            best = k;
        }
    }
    at->heading = remainderf(at->heading + fmaxf(-STEERING, fminf(STEERING, TURN * (float)best / RAYS)), TURN);
    const float step = fminf(STEP, fmaxf(0, measure(&hits[0]) - 2 * RADIUS));
    at->x += (double)(step * cosf(at->heading));
    at->y += (double)(step * sinf(at->heading));
}

int main(int argc, char **argv) {
    room r = {0};
    robot at = {0, 0, 0};
    narc_error error = {.message = "not enough memory"};
    narc_ray_hit hits[RAYS];
    float nearest = RANGE;
    FILE *map = fopen(argc > 1 ? argv[1] : "map.svg", "w");
    if (!map) {
        perror(argc > 1 ? argv[1] : "map.svg");
        return 2;
    }
    fprintf(map, "<svg xmlns='http://www.w3.org/2000/svg' viewBox='-10 -10 20 20' width='800' height='800'>\n"
                 "<rect x='-10' y='-10' width='20' height='20' fill='white'/><g fill='#d2691e'>\n");
    narc_status status = build_room(&r, &error);
    for (int k = 0; k < SCANS && status == NARC_OK; k++) {
        status = scan(&r, &at, hits, &error);
        for (int i = 0; i < RAYS && status == NARC_OK; i++) {
            nearest = fminf(nearest, measure(&hits[i]));
            if (k % 50 == 0 && hits[i].count) { /* points are relative to their body, and the page's y points down */
                const narc_body *body = &r.body[hits[i].body];
                fprintf(map, "<circle cx='%.3f' cy='%.3f' r='0.02'/>\n", body->x + (double)hits[i].point_x,
                        -body->y - (double)hits[i].point_y);
            }
        }
        if (k % 10 == 0)
            fprintf(map, "<circle cx='%.3f' cy='%.3f' r='0.05' fill='#1a1a47'/>\n", at.x, -at.y);
        if (status == NARC_OK)
            steer(&at, hits);
    }
    fprintf(map, "</g></svg>\n");
    const int failed = fclose(map) != 0 || status != NARC_OK;
    if (status != NARC_OK)
        fprintf(stderr, "lidar: %s: %s\n", narc_status_name(status), error.message);
    printf("%d scans of %d rays, nothing nearer than %.2f m\n", SCANS, RAYS, (double)nearest);
    narc_destroy_index(r.index);
    narc_destroy_shapes(r.shapes);
    return failed ? 2 : 0;
}
