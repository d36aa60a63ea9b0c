/* SPDX-License-Identifier: MIT
 *
 * recycle.c - rows that are kept while their bodies have hardly moved against each other, and follow them: the same
 * features touch, the normal turns with A, and each point lies where the places of both bodies that touched are now.
 */
#include "column.h"
#include "contacts.h"
#include "store.h"

#include <math.h>

typedef struct vector {
    float x, y;
} vector;

static vector rotate(vector q, vector v) { return (vector){q.x * v.x - q.y * v.y, q.y * v.x + q.x * v.y}; }
static vector unrotate(vector q, vector v) { return (vector){q.x * v.x + q.y * v.y, q.x * v.y - q.y * v.x}; }
static vector add(vector a, float s, vector b) { return (vector){a.x + s * b.x, a.y + s * b.y}; }
static float dot(vector a, vector b) { return a.x * b.x + a.y * b.y; }

/* Two bodies: their rotations, of length 1, and B's position from A's. */
typedef struct placed_pair {
    vector a, b, way;
} placed_pair;

static vector get_rotation(const narc_bodies *bodies, size_t k) {
    const float c = narc_float_at(bodies->cosine, k), s = narc_float_at(bodies->sine, k);
    const float scale = 1.5f - 0.5f * (c * c + s * s);
    return (vector){scale * c, scale * s};
}

static placed_pair place_pair(const narc_bodies *bodies, uint32_t a, uint32_t b) {
    return (placed_pair){get_rotation(bodies, a),
                         get_rotation(bodies, b),
                         {(float)(narc_position_at(bodies->x, b) - narc_position_at(bodies->x, a)),
                          (float)(narc_position_at(bodies->y, b) - narc_position_at(bodies->y, a))}};
}

/* Diameter of a body's circle: no two points of it are further apart. */
static float find_diameter(const narc_contact_step *s, uint32_t body) {
    const narc_bodies *const bodies = s->step->bodies;
    return 2 * s->shapes->headers[narc_index_at(bodies->shape, body)].bound_radius *
           narc_float_or(bodies->scale, body, 1);
}

/* What both kinds of rows have. */
typedef struct row_view {
    unsigned count;
    vector normal, point[2];
    float separation[2], radius_a, radius_b;
} row_view;

static row_view view_row(const narc_contacts *c, const void *row) {
    if (c->contact_rows) {
        const narc_contact *const r = row;
        return (row_view){
            r->count,   {r->normal_x, r->normal_y}, {{r->point_x, r->point_y}}, {r->separation}, r->radius_a,
            r->radius_b};
    }
    const narc_manifold *const r = row;
    return (row_view){r->count,
                      {r->normal_x, r->normal_y},
                      {{r->point[0].x, r->point[0].y}, {r->point[1].x, r->point[1].y}},
                      {r->point[0].separation, r->point[1].separation},
                      r->radius_a,
                      r->radius_b};
}

void narc_keep_row(const narc_contact_step *s, uint32_t a, uint32_t b, const void *row, narc_kept_row *kept) {
    const row_view r = view_row(s->contacts, row);
    kept->lever = -1;
    if (r.count == 0 || !(s->step->recycling > 0))
        return;
    const placed_pair pair = place_pair(s->step->bodies, a, b);
    const bool rolls = r.count == 1 && !(isinf(r.radius_a) && isinf(r.radius_b));
    const float diameter_a = find_diameter(s, a), diameter_b = find_diameter(s, b);
    const vector relative = unrotate(pair.a, pair.b), normal = unrotate(pair.a, r.normal);
    kept->cosine = relative.x;
    kept->sine = relative.y;
    kept->normal_x = normal.x;
    kept->normal_y = normal.y;
    kept->radius_a = rolls && !isinf(r.radius_a) ? r.radius_a : 0;
    kept->radius_b = rolls && !isinf(r.radius_b) ? r.radius_b : 0;
    for (unsigned i = 0; i < r.count; i++) {
        const float half = 0.5f * r.separation[i];
        const vector at_a = unrotate(pair.a, add(r.point[i], -half - kept->radius_a, r.normal));
        const vector from_b = add(r.point[i], -1, pair.way),
                     at_b = unrotate(pair.b, add(from_b, half + kept->radius_b, r.normal));
        kept->a_x[i] = at_a.x;
        kept->a_y[i] = at_a.y;
        kept->b_x[i] = at_b.x;
        kept->b_y[i] = at_b.y;
    }
    kept->apart = r.separation[0] + kept->radius_a + kept->radius_b;
    kept->lever = diameter_a < diameter_b ? diameter_a : diameter_b;
}

/* From A's kept place to B's, in world axes. */
static vector find_span(const placed_pair *pair, const narc_kept_row *kept, unsigned i) {
    const vector a = rotate(pair->a, (vector){kept->a_x[i], kept->a_y[i]});
    return add(add(pair->way, 1, rotate(pair->b, (vector){kept->b_x[i], kept->b_y[i]})), -1, a);
}

bool narc_may_follow(const narc_contact_step *s, uint32_t a, uint32_t b, const narc_kept_row *kept) {
    if (!(kept->lever >= 0))
        return false;
    const placed_pair pair = place_pair(s->step->bodies, a, b);
    const vector relative = unrotate(pair.a, pair.b), normal = {kept->normal_x, kept->normal_y};
    const vector moved = add(unrotate(pair.a, find_span(&pair, kept, 0)), -kept->apart, normal);
    const vector turned = {relative.x - kept->cosine, relative.y - kept->sine};
    return sqrtf(dot(moved, moved)) + kept->lever * sqrtf(dot(turned, turned)) < s->step->recycling;
}

void narc_follow_row(const narc_contact_step *s, uint32_t a, uint32_t b, const narc_kept_row *kept, void *row) {
    const placed_pair pair = place_pair(s->step->bodies, a, b);
    const vector normal = rotate(pair.a, (vector){kept->normal_x, kept->normal_y});
    const unsigned count = view_row(s->contacts, row).count;
    vector point[2] = {{0, 0}, {0, 0}};
    float separation[2] = {0, 0};
    for (unsigned i = 0; i < count; i++) {
        separation[i] = dot(find_span(&pair, kept, i), normal) - kept->radius_a - kept->radius_b;
        const vector at_a = rotate(pair.a, (vector){kept->a_x[i], kept->a_y[i]});
        point[i] = add(at_a, kept->radius_a + 0.5f * separation[i], normal);
    }
    if (s->contacts->contact_rows) {
        narc_contact *const r = row;
        r->separation = separation[0];
        r->normal_x = normal.x;
        r->normal_y = normal.y;
        r->point_x = point[0].x;
        r->point_y = point[0].y;
        return;
    }
    narc_manifold *const r = row;
    r->normal_x = normal.x;
    r->normal_y = normal.y;
    for (unsigned i = 0; i < count; i++) {
        r->point[i].x = point[i].x;
        r->point[i].y = point[i].y;
        r->point[i].separation = separation[i];
    }
}
