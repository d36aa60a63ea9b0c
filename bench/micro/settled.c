/* SPDX-License-Identifier: MIT
 *
 * settled.c - bodies and pairs of a settled pile.
 */
#include "settled.h"

#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "narc_broad_phase.h"
#include "random.h"
#include "shapes.h"

/* The area of the bodies divided by that of the square; the mean overlap to reach; steps at most. A step takes this
 * part of each overlap away: a body has about five neighbours, which all push it. */
static const double density = 0.82, mean_overlap = 0.04, push = 0.5;
enum { STEPS = 400 };

/* Copies of a pile of more bodies than that. */
enum { MAX_BODIES = 100000, COPIES = 6 /* in x and in y */ };

void find_boxes(const struct workload *workload, double room, const narc_workers *workers, narc_box *out_boxes) {
    const narc_bodies bodies = bodies_of(workload->bodies, workload->body_count);
    const narc_box_options options = {.margin = (float)room, .workers = workers};
    narc_error error;
    must(narc_compute_boxes(workload->shapes, &bodies, &options, out_boxes, &error), &error);
}

/* ------------------------------------------------------------------------------------------------ pairs */

struct search {
    narc_broad_phase *broad;
    narc_box *boxes;
    size_t capacity, found;
    uint32_t *a, *b;
};

static struct search begin_search(size_t body_count) {
    struct search search = {.capacity = 8 * body_count + 64};
    must(narc_create_broad_phase(NULL, &search.broad), NULL);
    search.boxes = allocate(body_count, sizeof *search.boxes);
    search.a = allocate(search.capacity, sizeof *search.a);
    search.b = allocate(search.capacity, sizeof *search.b);
    return search;
}

static void end_search(struct search *search) {
    narc_destroy_broad_phase(search->broad);
    free(search->boxes);
    free(search->a);
    free(search->b);
}

static narc_pairs find_close(struct search *search, const struct workload *workload, double room) {
    narc_error error;
    find_boxes(workload, room, all_workers(), search->boxes);
    must(narc_find_pairs(search->broad, search->boxes, workload->body_count, NULL, all_workers(), search->a, search->b,
                         search->capacity, &search->found, &error),
         &error);
    return (narc_pairs){.count = search->found, .a = NARC_ARRAY(search->a), .b = NARC_ARRAY(search->b)};
}

static void list_pairs(struct workload *workload) {
    struct search search = begin_search(workload->body_count);
    find_close(&search, workload, SETTLED_SKIN / 2);
    workload->pair_count = search.found;
    workload->pairs = allocate(search.found, sizeof *workload->pairs);
    for (size_t k = 0; k < search.found; k++)
        workload->pairs[k] = (struct pair){search.a[k], search.b[k]};
    end_search(&search);
}

/* ------------------------------------------------------------------------------------------------ pushing apart */

/* How a body is pushed in a step. */
struct motion {
    double x, y, turn;
};

/* A body's moment of inertia per mass. */
static const double inertia = 0.4;

/* Splits an overlap between two bodies of equal mass. The point is given from A's position. */
static void push_apart(const struct body *bodies, uint32_t a, uint32_t b, const narc_contact *contact,
                       struct motion *motions) {
    const double x = contact->normal_x, y = contact->normal_y;
    const double from_b_x = contact->point_x - (bodies[b].x - bodies[a].x);
    const double from_b_y = contact->point_y - (bodies[b].y - bodies[a].y);
    const double arm_a = contact->point_x * y - contact->point_y * x, arm_b = from_b_x * y - from_b_y * x;
    const double part = -contact->separation / (2 + (arm_a * arm_a + arm_b * arm_b) / inertia);
    motions[a].x -= part * x, motions[a].y -= part * y, motions[a].turn -= part * arm_a / inertia;
    motions[b].x += part * x, motions[b].y += part * y, motions[b].turn += part * arm_b / inertia;
}

static float within(double value, double limit) { return (float)fmin(fmax(value, -limit), limit); }

static void move(struct body *body, const struct motion *motion, double half_width) {
    const double angle = atan2(body->sine, body->cosine) + push * motion->turn;
    body->x = within(body->x + push * motion->x, half_width);
    body->y = within(body->y + push * motion->y, half_width);
    body->cosine = (float)cos(angle);
    body->sine = (float)sin(angle);
}

/* A step of Jacobi's method for all overlaps; returns their mean before it. */
static double push_all(struct workload *workload, double half_width, struct search *search, narc_contact *contacts,
                       struct motion *motions) {
    const size_t body_count = workload->body_count;
    const narc_bodies bodies = bodies_of(workload->bodies, body_count);
    const narc_pairs pairs = find_close(search, workload, 0);
    const narc_query query = {.workers = all_workers()};
    narc_error error;
    size_t count = 0;
    double sum = 0;
    must(narc_find_contacts(workload->shapes, &bodies, &pairs, &query, contacts, search->capacity, &count, &error),
         &error);
    for (size_t k = 0; k < body_count; k++)
        motions[k] = (struct motion){0};
    for (size_t k = 0; k < count; k++) {
        const uint32_t pair = contacts[k].pair;
        push_apart(workload->bodies, search->a[pair], search->b[pair], &contacts[k], motions);
        sum -= contacts[k].separation;
    }
    for (size_t k = 0; k < body_count; k++)
        move(&workload->bodies[k], &motions[k], half_width);
    return count > 0 ? sum / (double)count : 0;
}

static void settle(struct workload *workload, double half_width) {
    struct search search = begin_search(workload->body_count);
    narc_contact *contacts = allocate(search.capacity, sizeof *contacts);
    struct motion *motions = allocate(workload->body_count, sizeof *motions);
    int step = 0;
    while (push_all(workload, half_width, &search, contacts, motions) > mean_overlap)
        if (++step == STEPS)
            fail("a pile that does not settle");
    free(motions);
    free(contacts);
    end_search(&search);
}

/* ------------------------------------------------------------------------------------------------ piles */

/* By rows as high as a body, each from the left to the right. */
static int compare_places(const void *left, const void *right) {
    const struct body *l = left, *r = right;
    const double row_l = floor(l->y / 2), row_r = floor(r->y / 2);
    return row_l != row_r ? (row_l > row_r) - (row_l < row_r) : (l->x > r->x) - (l->x < r->x);
}

/* Each body anywhere in a cell of its own: what is denser at first takes long to flow apart. */
static void place_in_cells(struct workload *workload, double half_width, uint64_t *random) {
    const size_t columns = (size_t)ceil(sqrt((double)workload->body_count));
    const double cell = 2 * half_width / (double)columns;
    for (size_t k = 0; k < workload->body_count; k++) {
        struct body *body = &workload->bodies[k];
        *body = random_body(random, k % workload->shape_count, cell / 2);
        body->x = (float)(body->x + cell * ((double)(k % columns) + 0.5) - half_width);
        body->y = (float)(body->y + cell * ((double)(k / columns) + 0.5) - half_width);
    }
}

/* Puts copies of the first bodies into a square. */
static void copy_pile(struct body *bodies, size_t count, double half_width) {
    for (size_t copy = COPIES * COPIES; copy-- > 0;) {
        const double x = 2 * half_width * ((double)(copy % COPIES) - (COPIES - 1) / 2.0);
        const double y = 2 * half_width * ((double)(copy / COPIES) - (COPIES - 1) / 2.0);
        for (size_t k = 0; k < count; k++) {
            struct body *body = &bodies[copy * count + k];
            *body = bodies[k];
            body->x = (float)(body->x + x);
            body->y = (float)(body->y + y);
        }
    }
}

void make_settled(struct workload *workload) {
    uint64_t random = 4000 + workload->key.edges;
    const bool copies = workload->key.body_count > MAX_BODIES;
    const size_t copy_count = copies ? COPIES * COPIES : 1;
    const size_t count = workload->key.body_count / copy_count;
    double area = 0;
    workload->bodies = allocate(count * copy_count, sizeof *workload->bodies);
    workload->body_count = count;
    for (size_t k = 0; k < count; k++)
        area += area_of(&workload->outlines[k % workload->shape_count]);
    const double half_width = sqrt(area / density) / 2;
    place_in_cells(workload, half_width, &random);
    settle(workload, half_width);
    workload->body_count = count * copy_count;
    if (copies)
        copy_pile(workload->bodies, count, half_width);
    qsort(workload->bodies, workload->body_count, sizeof *workload->bodies, compare_places);
    list_pairs(workload);
}
