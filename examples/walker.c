/* SPDX-License-Identifier: MIT
 *
 * walker.c - a character that walks: planes, casts, sliding.
 */
#include "walker.h"

#include <math.h>
#include <stdbool.h>

#include <narc_broad_phase.h>

/* Pairs that are asked at a time, and their rows: pairs with concave arcs have more than one. */
enum { MOST_PLANES = 16, MOST_SLIDES = 6, FEW = 16, MOST_ROWS = 256 };

static bool is_free(const walker_plane *planes, size_t count, double x, double y) {
    bool free = true;
    for (size_t k = 0; k < count; k++)
        free = free && planes[k].x * x + planes[k].y * y <= planes[k].room + 1e-9;
    return free;
}

/* The wanted motion, or the nearest place on the border of one plane, or where two borders meet. */
void walker_clip(const walker_plane *planes, size_t count, double *x, double *y) {
    const double wanted_x = *x, wanted_y = *y;
    double nearest = INFINITY;
    if (is_free(planes, count, wanted_x, wanted_y))
        return;
    *x = *y = 0;
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i <= k; i++) {
            const walker_plane *const p = &planes[k], *const q = &planes[i];
            const double over = p->x * wanted_x + p->y * wanted_y - p->room, sine = p->x * q->y - p->y * q->x;
            double to_x = wanted_x - over * p->x, to_y = wanted_y - over * p->y;
            if (i < k) {
                to_x = (p->room * q->y - q->room * p->y) / sine;
                to_y = (q->room * p->x - p->room * q->x) / sine;
            }
            const double away = hypot(to_x - wanted_x, to_y - wanted_y);
            if (away < nearest && is_free(planes, count, to_x, to_y)) { /* not if they are parallel: NaN, or far */
                nearest = away;
                *x = to_x;
                *y = to_y;
            }
        }
}

/* Keeps those with least room. */
static void add_plane(walker_plane plane, walker_plane *planes, size_t *count) {
    size_t k = *count < MOST_PLANES ? (*count)++ : MOST_PLANES;
    for (; k > 0 && planes[k - 1].room > plane.room; k--)
        if (k < MOST_PLANES)
            planes[k] = planes[k - 1];
    if (k < MOST_PLANES)
        planes[k] = plane;
}

/* The planes of what is nearer than a skin and as much again. However many pairs there are, few are asked at a time. */
static narc_status find_planes(const walker *w, const walker_scene *scene, walker_plane *out, size_t *out_count,
                               narc_error *error) {
    const narc_box_options around = {.margin = 2 * w->skin, .origin = scene->origin};
    narc_contact rows[MOST_ROWS];
    narc_bodies own;
    narc_box box;
    narc_pairs pairs;
    narc_view_bodies(&w->body, 1, &own);
    narc_status status = narc_compute_boxes(scene->shapes, &own, &around, &box, error);
    if (status == NARC_OK)
        status = narc_query_index(scene->index, &box, 1, &scene->search, &pairs, error);
    *out_count = 0;
    for (size_t first = 0; status == NARC_OK && first < pairs.count; first += FEW) {
        const size_t count = pairs.count - first < FEW ? pairs.count - first : FEW;
        const narc_query query = {.margin = 2 * w->skin, .first = first, .count = count};
        size_t found = 0;
        pairs.other_bodies = scene->bodies;
        status = narc_find_contacts(scene->shapes, &own, &pairs, &query, rows, MOST_ROWS, &found, error);
        for (size_t k = 0; status == NARC_OK && k < found; k++)
            add_plane((walker_plane){(double)rows[k].normal_x, (double)rows[k].normal_y,
                                     (double)rows[k].separation - (double)w->skin},
                      out, out_count);
    }
    return status;
}

/* Moves it until it meets something, and says what. */
static narc_status cast(walker *w, const walker_scene *scene, double x, double y, narc_impact *out, narc_error *error) {
    const float way_x = (float)x, way_y = (float)y;
    const narc_motions motion = {.x = {&way_x, 0}, .y = {&way_y, 0}};
    const narc_cast_options options = {.target = w->skin, .parting = 0.25f * w->skin};
    narc_bodies own;
    narc_view_bodies(&w->body, 1, &own);
    const narc_status status = narc_cast_shapes(scene->index, scene->shapes, scene->bodies, &own, &motion,
                                                &scene->search, &options, out, 1, error);
    const double part = out->count == NARC_CAST_MISS ? 1 : (double)out->fraction;
    if (status != NARC_OK)
        return status;
    w->body.x += part * (double)way_x;
    w->body.y += part * (double)way_y;
    return NARC_OK;
}

narc_status walker_move(walker *w, const walker_scene *scene, double x, double y, narc_error *error) {
    const double to_x = w->body.x + x, to_y = w->body.y + y;
    for (int slide = 0; slide < MOST_SLIDES; slide++) {
        walker_plane planes[MOST_PLANES];
        size_t count;
        narc_impact hit = {.count = NARC_CAST_MISS};
        narc_status status = find_planes(w, scene, planes, &count, error);
        if (status != NARC_OK)
            return status;
        x = to_x - w->body.x;
        y = to_y - w->body.y;
        walker_clip(planes, count, &x, &y);
        if (hypot(x, y) < 1e-3 * (double)w->skin)
            break;
        status = cast(w, scene, x, y, &hit, error);
        if (status != NARC_OK)
            return status;
        if (hit.count == NARC_CAST_MISS)
            break;
    }
    return NARC_OK;
}

/* Does it stand on what it met? */
static bool stands(const walker *w, const walker_scene *scene, const narc_impact *hit) {
    narc_aabb box;
    narc_get_aabb(scene->shapes, w->body.shape, w->body.cosine, w->body.sine, w->body.scale, &box);
    return hit->count != NARC_CAST_MISS &&
           (-hit->normal_y >= w->steepest ||
            (hit->radius_b == 0 && (double)hit->point_y <= box.min_y + (double)w->step));
}

narc_status walker_fall(walker *w, const walker_scene *scene, double most, narc_error *error) {
    narc_impact hit = {.count = NARC_CAST_MISS};
    const double to = w->body.y - most;
    const narc_status status = cast(w, scene, 0, -most, &hit, error);
    if (status != NARC_OK)
        return status;
    w->stands_on = stands(w, scene, &hit) ? hit.body : UINT32_MAX;
    return hit.count == NARC_CAST_MISS || w->stands_on != UINT32_MAX ? NARC_OK
                                                                     : walker_move(w, scene, 0, to - w->body.y, error);
}

narc_status walker_step(walker *w, const walker_scene *scene, double x, narc_error *error) {
    narc_impact unused = {.count = NARC_CAST_MISS};
    const double low = w->body.y - (double)w->step;
    narc_status status = cast(w, scene, 0, (double)w->step, &unused, error);
    if (status == NARC_OK)
        status = walker_move(w, scene, x, 0, error);
    return status == NARC_OK ? walker_fall(w, scene, w->body.y - low, error) : status;
}
