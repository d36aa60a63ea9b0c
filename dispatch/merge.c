/* SPDX-License-Identifier: MIT
 *
 * merge.c - what several entries of a chain tell of one body: rows that are merged.
 */
#include <math.h>
#include <stdbool.h>

#include "chain.h"
#include "column.h"
#include "merge.h"
#include "store.h"

#define SAME_RUN_NORMAL  1e-4f
#define SAME_SEAM_NORMAL 1e-3f
#define SAME_POINT       0x1p-12f

/* What separations of one contact differ by where rows round them, relative to the points' coordinates. */
#define SAME_SEPARATION 0x1p-16f

/* The cosine of the angle between faces that may look away from each other, and the room for rounding there, relative to
 * the points' coordinates. */
#define BACK_TO_BACK (-0.5f)
#define BACK_ROOM    0x1p-18f

enum { LOOK_BACK = 64 };

static narc_manifold get_row(const narc_merging *list, size_t k) {
    if (list->manifolds)
        return list->manifolds[k];
    const narc_contact *c = &list->contacts[k];
    return (narc_manifold){.pair = c->pair,
                           .count = c->count,
                           .normal_x = c->normal_x,
                           .normal_y = c->normal_y,
                           .radius_a = c->radius_a,
                           .radius_b = c->radius_b,
                           .point = {{c->point_x, c->point_y, c->separation, c->feature}}};
}

static void drop_row(const narc_merging *list, size_t k) {
    if (list->manifolds)
        list->manifolds[k].count = 0;
    else
        list->contacts[k].count = 0;
}

static void move_row(const narc_merging *list, size_t from, size_t to) {
    if (from == to)
        return;
    if (list->manifolds)
        list->manifolds[to] = list->manifolds[from];
    else
        list->contacts[to] = list->contacts[from];
}

static uint32_t get_count(const narc_merging *list, size_t k) {
    return list->manifolds ? list->manifolds[k].count : list->contacts[k].count;
}

static size_t find_body_of(const narc_merging *list, size_t k) {
    const narc_pairs *const pairs = list->pairs;
    const uint32_t pair = list->manifolds ? list->manifolds[k].pair : list->contacts[k].pair;
    if (pairs->a.base)
        return narc_index_at(pairs->a, pair);
    return pairs->other_bodies ? pair : 2 * (size_t)pair;
}

static size_t find_entry_of(const narc_pairs *pairs, uint32_t pair) {
    return pairs->b.base ? narc_index_at(pairs->b, pair) : pairs->other_bodies ? pair : 2 * (size_t)pair + 1;
}

static uint32_t find_run(const narc_merging *list, uint32_t pair) {
    return list->run.base ? narc_index_at(list->run, find_entry_of(list->pairs, pair)) : NARC_NO_RUN;
}

/* So far an entry of a run goes on where a corner is cut, or less: its bounding circle holds the far corners. */
static float find_fin(const narc_merging *list, uint32_t pair) {
    if (!list->shapes)
        return 0;
    const size_t entry = find_entry_of(list->pairs, pair);
    const narc_shape_header *const header = &list->shapes->headers[narc_index_at(list->bodies->shape, entry)];
    return (float)(NARC_FIN * 2 / NARC_FAR) * header->bound_radius * narc_float_or(list->bodies->scale, entry, 1);
}

/* ------------------------------------------------------------------------------------------------ two rows */

static bool has_same_normal(const narc_manifold *a, const narc_manifold *b, float limit) {
    const float x = a->normal_x - b->normal_x, y = a->normal_y - b->normal_y;
    return x * x + y * y <= limit * limit;
}

static float find_size(const narc_manifold_point *p, const narc_manifold_point *q) {
    return sqrtf(fmaxf(p->x * p->x + p->y * p->y, q->x * q->x + q->y * q->y));
}

static bool is_near(float x, float y, float room) { return x * x + y * y <= room * room; }

static bool is_same_point(const narc_manifold_point *p, const narc_manifold_point *q) {
    return is_near(p->x - q->x, p->y - q->y, SAME_POINT * find_size(p, q));
}

/* Is a point of row a one of row b? Deep ones may agree on one of both surfaces alone: round the bottom of a valley two
 * rows turn about the body's corner. */
static bool is_told_by(const narc_manifold *a, const narc_manifold_point *p, const narc_manifold *b,
                       const narc_manifold_point *q) {
    const float half_a = p->separation / 2, half_b = q->separation / 2, size = find_size(p, q);
    const float x = p->x - q->x, y = p->y - q->y;
    const float turn_x = half_a * a->normal_x - half_b * b->normal_x,
                turn_y = half_a * a->normal_y - half_b * b->normal_y;
    return is_same_point(p, q) ||
           (fabsf(p->separation - q->separation) <= SAME_SEPARATION * size &&
            (is_near(x - turn_x, y - turn_y, SAME_POINT * size) || is_near(x + turn_x, y + turn_y, SAME_POINT * size)));
}

/* Which point of b is that of a, or b->count. */
static uint32_t find_point(const narc_manifold *a, uint32_t i, const narc_manifold *b) {
    uint32_t k = 0;
    while (k < b->count && !is_told_by(a, &a->point[i], b, &b->point[k]))
        k++;
    return k;
}

/* Is each point of a one of b? */
static bool has_all_points(const narc_manifold *a, const narc_manifold *b) {
    bool all = true;
    for (uint32_t i = 0; i < a->count; i++)
        all = all && find_point(a, i, b) < b->count;
    return all;
}

static const narc_manifold_point *find_deepest(const narc_manifold *a) {
    return a->count > 1 && a->point[1].separation < a->point[0].separation ? &a->point[1] : &a->point[0];
}

static float find_separation(const narc_manifold *a) { return find_deepest(a)->separation; }

/* Joins b to a, which have one normal: the outermost points along it turned a quarter turn, and of the deeper row what
 * a row has once. The deepest point takes the place of that which it is, told again, or, where it lies between them, a corner
 * below an edge, of the higher one. */
static void join_rows(narc_manifold *a, const narc_manifold *b) {
    const narc_manifold first = *a, *const deeper = find_separation(b) < find_separation(a) ? b : &first;
    const narc_manifold_point deepest = *find_deepest(deeper);
    narc_manifold_point low = first.point[0], high = low;
    for (uint32_t i = 0; i < first.count + b->count; i++) {
        const narc_manifold_point *p = i < first.count ? &first.point[i] : &b->point[i - first.count];
        const float along = p->y * first.normal_x - p->x * first.normal_y;
        low = along < low.y * first.normal_x - low.x * first.normal_y ? *p : low;
        high = along > high.y * first.normal_x - high.x * first.normal_y ? *p : high;
    }
    const float room = SAME_SEPARATION * find_size(&low, &high);
    if (deepest.separation < fminf(low.separation, high.separation) - room) {
        const bool is_high =
            !is_same_point(&deepest, &low) && (is_same_point(&deepest, &high) || low.separation <= high.separation);
        *(is_high ? &high : &low) = deepest;
    }
    const bool is_one = is_same_point(&low, &high);
    *a = *deeper;
    a->pair = first.pair;
    a->count = is_one ? 1 : 2;
    a->point[0] = is_one ? (low.separation <= high.separation ? low : high) : low;
    a->point[1] = is_one ? (narc_manifold_point){0, 0, 0, 0} : high;
}

/* Is what two rows touch of the ground convex from the one to the other: does either place lie behind the tangent of the
 * other one, and does the normal turn with the way between both? A valley may be too shallow for the first to tell; and what
 * goes on where a corner is cut is none. */
static bool is_convex(const narc_merging *list, const narc_manifold *a, const narc_manifold *b) {
    const narc_manifold_point *p = find_deepest(a), *q = find_deepest(b);
    const float x = p->x + a->normal_x * p->separation / 2 - q->x - b->normal_x * q->separation / 2;
    const float y = p->y + a->normal_y * p->separation / 2 - q->y - b->normal_y * q->separation / 2;
    const float size = fmaxf(fabsf(p->x) + fabsf(p->y), fabsf(q->x) + fabsf(q->y)), room = SAME_POINT * size;
    const float at_a = x * a->normal_x + y * a->normal_y, at_b = x * b->normal_x + y * b->normal_y;
    const float turn_x = b->normal_x - a->normal_x, turn_y = b->normal_y - a->normal_y;
    const bool turns_back =
        at_b - at_a < 0 && 4 * (at_b - at_a) * (at_b - at_a) > (x * x + y * y) * (turn_x * turn_x + turn_y * turn_y);
    return (at_a <= room && at_b >= -room &&
            (!turns_back || is_near(x, y, room) || has_same_normal(a, b, SAME_RUN_NORMAL))) ||
           is_near(x, y, fmaxf(find_fin(list, a->pair), find_fin(list, b->pair)));
}

/* Do two rows tell of both sides of a thin solid within the body: faces that look away from each other, where neither place
 * lies before the other one's tangent? Walls on both sides of a body look at each other. */
static bool are_back_to_back(const narc_manifold *a, const narc_manifold *b) {
    const narc_manifold_point *p = find_deepest(a), *q = find_deepest(b);
    if (!(p->separation < 0 && q->separation < 0 &&
          a->normal_x * b->normal_x + a->normal_y * b->normal_y < BACK_TO_BACK))
        return false;
    const float x = q->x + b->normal_x * q->separation / 2 - p->x - a->normal_x * p->separation / 2;
    const float y = q->y + b->normal_y * q->separation / 2 - p->y - a->normal_y * p->separation / 2;
    const float room = BACK_ROOM * find_size(p, q); /* normals point into the ground */
    return x * a->normal_x + y * a->normal_y >= -room && x * b->normal_x + y * b->normal_y <= room;
}

/* Does an edge of a body lie along a line, row a, that goes over into a concave arc, row b, on which the same edge ends? As
 * the line is level there, both tell of one stretch. */
static bool goes_over(const narc_manifold *a, const narc_manifold *b) {
    const narc_manifold_point *p = &a->point[0], *q = &b->point[0], *last = &a->point[a->count - 1];
    const float room = SAME_POINT * find_size(p, q), half_a = p->separation / 2, half_b = q->separation / 2;
    if (!((a->count == 2 || (a->radius_a >= INFINITY && a->radius_b >= INFINITY)) && b->radius_b < 0 && b->count == 1 &&
          fabsf(p->separation - last->separation) <= SAME_SEPARATION * find_size(p, last) &&
          has_same_normal(a, b, SAME_SEAM_NORMAL)))
        return false;
    /* The place of the arc's circle that has the line's normal. */
    const float turn_x = b->radius_b * (b->normal_x - a->normal_x), turn_y = b->radius_b * (b->normal_y - a->normal_y);
    const float x = q->x + half_b * b->normal_x - half_a * a->normal_x + turn_x;
    const float y = q->y + half_b * b->normal_y - half_a * a->normal_y + turn_y;
    const float first = (y - p->y) * a->normal_x - (x - p->x) * a->normal_y,
                second = (y - last->y) * a->normal_x - (x - last->x) * a->normal_y;
    return fabsf((x - p->x) * a->normal_x + (y - p->y) * a->normal_y) <= room &&
           (a->count == 1 || (first >= -room && second <= room));
}

/* Of two rows with the same points that of number `from` goes. What stays is no less deep. */
static void drop_seam(const narc_merging *list, size_t from, size_t to) {
    const narc_manifold gone = get_row(list, from), left = get_row(list, to);
    for (uint32_t i = 0; i < gone.count; i++) {
        const uint32_t k = find_point(&gone, i, &left);
        float *const separation =
            list->manifolds ? &list->manifolds[to].point[k].separation : &list->contacts[to].separation;
        *separation = fminf(*separation, gone.point[i].separation);
    }
    drop_row(list, from);
}

/* Is it of an entry of a chain? What is concave has its radius below 0, or -0, and nothing else has. */
static bool is_ground(const narc_merging *list, const narc_manifold *row) {
    return find_run(list, row->pair) != NARC_NO_RUN || signbit(row->radius_b);
}

/* Row k and row j before it: does one go? Of one run both stay where what they touch is not convex: a run that turns far
 * has two sides that face each other. Returns whether row j has grown. */
static bool compare_rows(const narc_merging *list, size_t j, size_t k) {
    const narc_manifold a = get_row(list, j), b = get_row(list, k);
    const uint32_t run = find_run(list, b.pair);
    if (!is_ground(list, &a) || !is_ground(list, &b))
        return false;
    if (are_back_to_back(&a, &b)) {
        drop_row(list, find_separation(&a) < find_separation(&b) ? j : k);
        return false;
    }
    const bool is_one_run = run != NARC_NO_RUN && run == find_run(list, a.pair) && is_convex(list, &a, &b);
    const bool is_seam =
        !is_one_run && has_same_normal(&a, &b, SAME_SEAM_NORMAL) && (has_all_points(&a, &b) || has_all_points(&b, &a));
    const bool is_flush =
        is_one_run ? has_same_normal(&a, &b, SAME_RUN_NORMAL) : !is_seam && (goes_over(&a, &b) || goes_over(&b, &a));
    if (is_one_run || is_flush) {
        const float one = find_separation(&a), other = find_separation(&b);
        if (is_flush && list->manifolds)
            join_rows(&list->manifolds[j], &b);
        const bool is_better = is_flush ? !list->manifolds && other < one : other > one;
        drop_row(list, is_better ? j : k);
        return is_flush && list->manifolds;
    }
    if (has_same_normal(&a, &b, SAME_SEAM_NORMAL)) {
        const bool is_better = b.count == a.count ? b.radius_b < 0 && !(a.radius_b < 0) : b.count > a.count;
        if (is_better ? has_all_points(&a, &b) : has_all_points(&b, &a))
            drop_seam(list, is_better ? j : k, is_better ? k : j);
    }
    return false;
}

/* Compares row k with those from `first` to `last`, and what it is joined to again with all of them. */
static void compare_with(const narc_merging *list, size_t k, size_t first, size_t last) {
    for (size_t i = last + 1; i-- > first && get_count(list, k) > 0;)
        if (i != k && get_count(list, i) > 0 && compare_rows(list, i < k ? i : k, i < k ? k : i)) {
            k = i < k ? i : k;
            i = last + 1;
        }
}

/* ------------------------------------------------------------------------------------------------ lists */

/* Puts rows k .. end - 1, of one body, behind those that are kept, but for those that go. Returns how many rows are
 * kept then. */
static size_t merge_body(const narc_merging *list, size_t kept, size_t k, size_t end) {
    const size_t first = kept;
    for (; k < end; k++) {
        move_row(list, k, kept);
        if (kept > first)
            compare_with(list, kept, kept - first > LOOK_BACK ? kept - LOOK_BACK : first, kept);
        kept += get_count(list, kept) > 0;
    }
    size_t left = first;
    for (size_t j = first; j < kept; j++)
        if (get_count(list, j) > 0)
            move_row(list, j, left++);
    return left;
}

size_t narc_merge_body(const narc_merging *rows, size_t first, size_t end) {
    return merge_body(rows, first, first, end);
}

size_t narc_merge_rows(const narc_merging *list, size_t count) {
    size_t kept = 0, next = count > 0 ? find_body_of(list, 0) : 0;
    for (size_t k = 0, end; k < count; k = end) {
        const size_t body = next;
        for (end = k + 1; end < count && (next = find_body_of(list, end)) == body;)
            end++;
        kept = merge_body(list, kept, k, end);
    }
    return kept;
}
