/* SPDX-License-Identifier: MIT
 *
 * recycle.c - rows that are kept while their bodies have hardly moved against each other, and follow them: what is kept,
 * and who asks the kernel (kernels/sat/recycle.c).
 */
#include "column.h"
#include "contacts.h"
#include "dispatch.h"
#include "store.h"

#include <math.h>
#include <string.h>

typedef struct vector {
    float x, y;
} vector;

static vector unrotate(vector q, vector v) { return (vector){q.x * v.x + q.y * v.y, q.x * v.y - q.y * v.x}; }
static vector add(vector a, float s, vector b) { return (vector){a.x + s * b.x, a.y + s * b.y}; }

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
    if (r.count == 0 || !(s->step->recycling > 0))
        return;
    const placed_pair pair = place_pair(s->step->bodies, a, b);
    const bool rolls = r.count == 1 && !(isinf(r.radius_a) && isinf(r.radius_b));
    const float diameter_a = find_diameter(s, a), diameter_b = find_diameter(s, b);
    const vector relative = unrotate(pair.a, pair.b), normal = unrotate(pair.a, r.normal);
    *kept = (narc_kept_row){.rotation = {relative.x, relative.y},
                            .normal = {normal.x, normal.y},
                            .radius_a = rolls && !isinf(r.radius_a) ? r.radius_a : 0,
                            .radius_b = rolls && !isinf(r.radius_b) ? r.radius_b : 0,
                            .lever = diameter_a < diameter_b ? diameter_a : diameter_b};
    for (unsigned i = 0; i < r.count; i++) {
        const float half = 0.5f * r.separation[i];
        const vector at_a = unrotate(pair.a, add(r.point[i], -half - kept->radius_a, r.normal));
        const vector from_b = add(r.point[i], -1, pair.way);
        const vector at_b = unrotate(pair.b, add(from_b, half + kept->radius_b, r.normal));
        memcpy(kept->point[i], (const float[]){at_a.x, at_a.y, at_b.x, at_b.y}, sizeof kept->point[i]);
    }
    kept->apart = r.separation[0] + kept->radius_a + kept->radius_b;
}

bool narc_may_follow(const narc_contact_step *s, uint32_t pair, uint32_t item, const narc_kept_row *kept) {
    narc_status status = NARC_OK;
    const narc_kernel_table *const kernels = narc_kernels(&status, NULL);
    const narc_query query = {.selection = {&pair, 0}, .selection_count = 1};
    narc_batch batch;
    uint32_t left;
    if (!kernels || narc_fill_batch(s->shapes, s->step->bodies, &s->list->pairs, &query, &batch, NULL) != NARC_OK)
        return false;
    batch.row_size = s->contacts->row_size;
    return NARC_KERNELS_FOR(1, kernels)->recycle(&batch, 0, 1, &item, kept, s->step->recycling, NULL, &left) == 0;
}

typedef struct follow_job {
    const narc_contact_step *step;
    const narc_batch *batch;
    const narc_kernel_table *kernels;
} follow_job;

/* Behind the pairs that are left of a part there is one that is none. */
static void follow_part(void *argument, size_t part, size_t first, size_t end) {
    const follow_job *const job = argument;
    const narc_contacts *const c = job->step->contacts;
    const narc_rows rows = {.base = c->rows, .stride = (ptrdiff_t)c->row_size};
    (void)part;
    const size_t left = job->kernels->recycle(job->batch, first, end - first, NULL, c->kept, job->step->step->recycling,
                                              &rows, c->left + first);
    if (left < end - first)
        c->left[first + left] = UINT32_MAX;
}

/* The further rows of a pair of ground, which may follow, as it was found out before. */
static void follow_more(const narc_contact_step *s, const narc_pairs *pairs, const narc_kernel_table *kernels,
                        uint32_t slot) {
    narc_contacts *const c = s->contacts;
    const narc_rows rows = {.base = c->more.rows, .stride = (ptrdiff_t)c->row_size};
    const narc_more_rows more = c->more_of[slot];
    const narc_query query = {.selection = {&slot, 0}, .selection_count = 1};
    narc_batch batch;
    if (narc_fill_batch(s->shapes, s->step->bodies, pairs, &query, &batch, NULL) != NARC_OK)
        return;
    batch.row_size = c->row_size;
    for (uint32_t i = more.first; i < more.first + more.count; i++) {
        uint32_t left;
        kernels->recycle(&batch, 0, 1, &i, c->more.kept, s->step->recycling, &rows, &left);
    }
}

narc_status narc_follow_rows(const narc_contact_step *s, const narc_pairs *pairs) {
    narc_contacts *const c = s->contacts;
    const size_t count = c->candidate_count;
    const narc_query query = {.selection = {c->candidates, sizeof *c->candidates}, .selection_count = count};
    narc_batch batch;
    if (count == 0)
        return NARC_OK;
    narc_status status = narc_fill_batch(s->shapes, s->step->bodies, pairs, &query, &batch, s->error);
    follow_job job = {s, &batch, narc_kernels(&status, s->error)};
    if (status != NARC_OK)
        return status;
    batch.row_size = c->row_size;
    narc_run_ranges(s->step->workers, count, NARC_SLOT_PART, follow_part, &job);
    for (size_t first = 0; first < count; first += NARC_SLOT_PART) {
        const uint32_t *left = c->left + first, *const end = c->left + count;
        for (size_t k = first; k < first + NARC_SLOT_PART && k < count; k++) {
            const uint32_t slot = c->candidates[k];
            if (left < end && *left == slot) {
                c->asked[c->asked_count++] = slot;
                left++;
                continue;
            }
            narc_mark_slot(c, slot, NARC_FOLLOWED);
            if (c->more_of[slot].count > 0)
                follow_more(s, pairs, job.kernels, slot);
        }
    }
    return NARC_OK;
}
