/* SPDX-License-Identifier: MIT
 *
 * pile.c - bodies and pairs of a settled pile: what a simulation hands to the narrow phase step after step.
 *
 * Bodies in a square, so dense that they hold each other in place: put there at random, and pushed apart until what
 * overlaps does so by 2 % of the size on average. They are numbered row by row. Pairs are those whose boxes, enlarged
 * by half of the skin, overlap. Large piles are made of copies, next to each other.
 */
#include "scene.h"

#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "random.h"

/* The area of the bodies divided by that of the square; the mean overlap to reach; steps at most. A step takes this
 * part of each overlap away: a body has about five neighbours, which all push it. */
static const double density = 0.82, mean_overlap = 0.04, push = 0.5;
enum { STEPS = 400 };

/* Copies of a pile of more bodies than that. */
enum { MAX_BODIES = 100000, COPIES = 6 /* in x and in y */ };

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

static narc_pairs find_close(struct search *search, const struct scene *scene, double room) {
    narc_error error;
    find_boxes(scene, room, all_workers(), search->boxes);
    must(narc_find_pairs(search->broad, search->boxes, scene->body_count, NULL, all_workers(), search->a, search->b, 0,
                         search->capacity, &search->found, &error),
         &error);
    return (narc_pairs){.count = search->found, .a = NARC_ARRAY(search->a), .b = NARC_ARRAY(search->b)};
}

static void list_pairs(struct scene *scene) {
    struct search search = begin_search(scene->body_count);
    find_close(&search, scene, SKIN / 2);
    scene->pairs = allocate(search.found, sizeof *scene->pairs);
    for (size_t k = 0; k < search.found; k++) {
        const bool unlike = (scene->bodies[search.a[k]].shape + scene->bodies[search.b[k]].shape) % 2;
        scene->pairs[scene->pair_count] = (struct pair){search.a[k], search.b[k]};
        scene->pair_count += scene->family->form != FORM_BALLS_BOXES || unlike;
    }
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
static double push_all(struct scene *scene, double half_width, struct search *search, narc_contact *contacts,
                       struct motion *motions) {
    const size_t body_count = scene->body_count;
    const narc_bodies bodies = bodies_of(scene->bodies, body_count);
    const narc_pairs pairs = find_close(search, scene, 0);
    const narc_query query = {.workers = all_workers()};
    narc_error error;
    size_t count = 0;
    double sum = 0;
    must(narc_find_contacts(scene->shapes, &bodies, &pairs, &query, contacts, search->capacity, &count, &error),
         &error);
    for (size_t k = 0; k < body_count; k++)
        motions[k] = (struct motion){0};
    for (size_t k = 0; k < count; k++) {
        const uint32_t pair = contacts[k].pair;
        push_apart(scene->bodies, search->a[pair], search->b[pair], &contacts[k], motions);
        sum -= contacts[k].separation;
    }
    for (size_t k = 0; k < body_count; k++)
        move(&scene->bodies[k], &motions[k], half_width);
    return count > 0 ? sum / (double)count : 0;
}

static void settle(struct scene *scene, double half_width) {
    struct search search = begin_search(scene->body_count);
    narc_contact *contacts = allocate(search.capacity, sizeof *contacts);
    struct motion *motions = allocate(scene->body_count, sizeof *motions);
    int step = 0;
    while (push_all(scene, half_width, &search, contacts, motions) > mean_overlap)
        if (++step == STEPS)
            fail("a pile that does not settle");
    free(motions);
    free(contacts);
    end_search(&search);
}

/* ------------------------------------------------------------------------------------------------ piles */

/* By rows as high as a body, each from the left to the right. */
static int compare_rows(const void *left, const void *right) {
    const struct body *l = left, *r = right;
    const double row_l = floor(l->y / 2), row_r = floor(r->y / 2);
    return row_l != row_r ? (row_l > row_r) - (row_l < row_r) : (l->x > r->x) - (l->x < r->x);
}

/* Each body anywhere in a cell of its own: what is denser at first takes long to flow apart. */
static void place_in_cells(struct scene *scene, double half_width, uint64_t *random) {
    const size_t columns = (size_t)ceil(sqrt((double)scene->body_count));
    const double cell = 2 * half_width / (double)columns;
    for (size_t k = 0; k < scene->body_count; k++) {
        struct body *body = &scene->bodies[k];
        *body = random_body(random, k % scene->shape_count, cell / 2);
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

void make_pile(struct scene *scene) {
    uint64_t random = 4000 + scene->family->edges;
    const size_t body_count = scaled(scene->kind->size);
    const bool copies = body_count > MAX_BODIES;
    const size_t copy_count = copies ? COPIES * COPIES : 1;
    const size_t count = body_count / copy_count;
    double area = 0;
    scene->bodies = allocate(count * copy_count, sizeof *scene->bodies);
    scene->body_count = count;
    for (size_t k = 0; k < count; k++)
        area += area_of(&scene->outlines[k % scene->shape_count]);
    const double half_width = sqrt(area / density) / 2;
    place_in_cells(scene, half_width, &random);
    settle(scene, half_width);
    scene->body_count = count * copy_count;
    if (copies)
        copy_pile(scene->bodies, count, half_width);
    qsort(scene->bodies, scene->body_count, sizeof *scene->bodies, compare_rows);
    list_pairs(scene);
}
