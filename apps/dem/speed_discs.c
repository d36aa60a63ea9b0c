/* SPDX-License-Identifier: MIT
 *
 * speed_discs.c - a step of discs by hand: what a program for discs alone would do. It knows radii, so a contact is a
 * distance, and the narrow phase, the law and the sum of forces are one loop over the list.
 */
#include "speed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a contact reads of a disc lies together. */
typedef struct disc {
    double x, y, vx, vy, spin, radius, inverse_mass, inverse_inertia;
} disc;

typedef struct force {
    double x, y, torque;
} force;

/* A contact's force on B, and its torques. */
typedef struct push {
    double x, y, torque_a, torque_b;
} push;

typedef struct pair {
    uint32_t a, b;
} pair;

typedef struct plate {
    double x, y; /* the normal */
    double offset;
} plate;

typedef struct memory {
    double slide;
    uint64_t step;
} memory;

struct discs {
    size_t count, pair_count, plate_count;
    disc *disc;
    force *force;
    push *pushes; /* of pairs, for several threads */
    double *list_x, *list_y;
    pair *pairs;
    float *shift_x;
    memory *memory;
    plate plates[8];
    uint32_t *first_a, *first_b, *of_b;
    uint64_t step;
    dem_contact_law law;
    double dt, skin, gx, gy;
};

static void copy_arrays(discs *s, const dem *d) {
    const dem_pairs *p = &d->pairs;
    const size_t n = s->count;
    for (size_t k = 0; k < n; k++) {
        const dem_bodies *b = &d->bodies;
        s->disc[k] = (disc){b->x[k],
                            b->y[k],
                            b->vx[k],
                            b->vy[k],
                            b->spin[k],
                            0.5 * b->extent[k],
                            b->inverse_mass[k],
                            b->inverse_inertia[k]};
        s->force[k] = (force){b->fx[k], b->fy[k], b->torque[k]};
        s->list_x[k] = b->list_x[k];
        s->list_y[k] = b->list_y[k];
    }
    for (size_t k = 0; k < p->count; k++) {
        s->pairs[k] = (pair){p->a[k], p->b[k]};
        s->shift_x[k] = p->shift_x[k];
        s->memory[k] = (memory){p->memory[k].slide, p->memory[k].step};
    }
    memcpy(s->first_a, d->incidence.first_a, (n + 1) * sizeof *s->first_a);
    memcpy(s->first_b, d->incidence.first_b, (n + 1) * sizeof *s->first_b);
    memcpy(s->of_b, d->incidence.of_b, p->count * sizeof *s->of_b);
}

discs *discs_copy(const dem *d) {
    const size_t n = d->grain_count, m = d->pairs.count + 1;
    discs *s = calloc(1, sizeof *s);
    if (!s || d->wall_count > sizeof s->plates / sizeof s->plates[0])
        return NULL;
    s->count = n;
    s->pair_count = d->pairs.count;
    s->plate_count = d->wall_count;
    s->disc = malloc(n * sizeof *s->disc);
    s->force = malloc(n * sizeof *s->force);
    s->pushes = malloc(m * sizeof *s->pushes);
    s->list_x = malloc(n * sizeof *s->list_x);
    s->list_y = malloc(n * sizeof *s->list_y);
    s->pairs = malloc(m * sizeof *s->pairs);
    s->shift_x = malloc(m * sizeof *s->shift_x);
    s->memory = malloc(m * sizeof *s->memory);
    s->first_a = malloc((n + 1) * sizeof *s->first_a);
    s->first_b = malloc((n + 1) * sizeof *s->first_b);
    s->of_b = malloc(m * sizeof *s->of_b);
    for (size_t w = 0; w < d->wall_count; w++) {
        const dem_wall *wall = &d->walls[w];
        const double offset = wall->normal.x * wall->place.x + wall->normal.y * wall->place.y;
        s->plates[w] = (plate){wall->normal.x, wall->normal.y, offset};
    }
    s->step = d->step;
    s->law = d->laws[0][0];
    s->dt = d->settings.time_step;
    s->skin = d->settings.skin;
    s->gx = d->settings.gravity.x;
    s->gy = d->settings.gravity.y;
    if (s->disc && s->force && s->pushes && s->list_x && s->list_y && s->pairs && s->shift_x && s->memory &&
        s->first_a && s->first_b && s->of_b) {
        copy_arrays(s, d);
        return s;
    }
    discs_free(s);
    return NULL;
}

void discs_free(discs *s) {
    if (!s)
        return;
    void *const arrays[] = {s->disc,    s->force,  s->pushes,  s->list_x,  s->list_y, s->pairs,
                            s->shift_x, s->memory, s->first_a, s->first_b, s->of_b};
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++)
        free(arrays[i]);
    free(s);
}

/* ------------------------------------------------------------------------------------------------ a step */

/* Half of a step's change of velocity. */
static inline void kick_disc(const discs *s, size_t k) {
    disc *b = &s->disc[k];
    const force f = s->force[k];
    const double half = 0.5 * s->dt;
    b->vx += half * (f.x * b->inverse_mass + s->gx);
    b->vy += half * (f.y * b->inverse_mass + s->gy);
    b->spin += half * (f.torque * b->inverse_inertia);
}

static bool move(discs *s, unsigned threads) {
    const double dt = s->dt, limit = 0.25 * s->skin * s->skin;
    const size_t count = s->count;
    int moved = 0;
    (void)threads;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1) reduction(| : moved)
    for (size_t k = 0; k < count; k++) {
        disc *b = &s->disc[k];
        kick_disc(s, k);
        b->x += dt * b->vx;
        b->y += dt * b->vy;
        const double x = b->x - s->list_x[k], y = b->y - s->list_y[k];
        moved |= !(x * x + y * y <= limit);
    }
    return moved == 0;
}

static void kick(discs *s, unsigned threads) {
    const size_t count = s->count;
    (void)threads;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (size_t k = 0; k < count; k++)
        kick_disc(s, k);
}

/* The force of the law: normal (nx, ny) from A to B, depth, relative velocity of the surfaces at the point, mass. */
static inline void apply_law(const discs *s, memory *m, double nx, double ny, double depth, double vx, double vy,
                             double mass, double *out_x, double *out_y) {
    const dem_contact_law *law = &s->law;
    const double cn = law->damping_ratio * sqrt(law->kn * mass), ct = law->tangential_share * cn;
    const double vn = vx * nx + vy * ny, vt = vy * nx - vx * ny;
    const double normal = law->kn * depth - cn * vn, bound = law->friction * fabs(normal), dashpot = ct * vt;
    double slide = (m->step + 1 == s->step ? m->slide : 0) + vt * s->dt, drag = law->kt * slide + dashpot;
    if (fabs(drag) > bound) {
        drag = drag > 0 ? bound : -bound;
        slide = (drag - dashpot) / law->kt;
    }
    *m = (memory){slide, s->step};
    *out_x = normal * nx + drag * ny;
    *out_y = normal * ny - drag * nx;
}

/* The contact of two discs; false if they are apart. The point is halfway between both surfaces. */
static inline bool collide(discs *s, size_t k, push *out_push) {
    const pair p = s->pairs[k];
    const disc *a = &s->disc[p.a], *b = &s->disc[p.b];
    const double x = b->x + (double)s->shift_x[k] - a->x, y = b->y - a->y;
    const double square = x * x + y * y, sum = a->radius + b->radius;
    if (square >= sum * sum)
        return false;
    const double distance = sqrt(square), share = 1 / distance, nx = x * share, ny = y * share;
    const double depth = sum - distance, arm_a = a->radius - 0.5 * depth, arm_b = b->radius - 0.5 * depth;
    const double turn = a->spin * arm_a + b->spin * arm_b;
    double fx, fy;
    apply_law(s, &s->memory[k], nx, ny, depth, b->vx - a->vx + turn * ny, b->vy - a->vy - turn * nx,
              1 / (a->inverse_mass + b->inverse_mass), &fx, &fy);
    const double moment = nx * fy - ny * fx;
    *out_push = (push){fx, fy, -arm_a * moment, -arm_b * moment};
    return true;
}

static inline bool collide_plate(discs *s, size_t k, push *out_push) {
    const pair p = s->pairs[k];
    const plate w = s->plates[p.b - s->count];
    const disc *a = &s->disc[p.a];
    const double depth = a->radius - (a->x * w.x + a->y * w.y - w.offset);
    if (depth <= 0)
        return false;
    const double arm = a->radius - 0.5 * depth;
    double fx, fy;
    apply_law(s, &s->memory[k], -w.x, -w.y, depth, -a->vx - a->spin * arm * w.y, -a->vy + a->spin * arm * w.x,
              1 / a->inverse_mass, &fx, &fy);
    *out_push = (push){fx, fy, arm * (w.x * fy - w.y * fx), 0};
    return true;
}

static inline bool find_push(discs *s, size_t k, push *out_push) {
    return s->pairs[k].b >= s->count ? collide_plate(s, k, out_push) : collide(s, k, out_push);
}

static void push_one_thread(discs *s) {
    memset(s->force, 0, s->count * sizeof *s->force);
    for (size_t k = 0; k < s->pair_count; k++) {
        const pair p = s->pairs[k];
        push f;
        if (!find_push(s, k, &f))
            continue;
        force *a = &s->force[p.a];
        *a = (force){a->x - f.x, a->y - f.y, a->torque + f.torque_a};
        if (p.b < s->count) {
            force *b = &s->force[p.b];
            *b = (force){b->x + f.x, b->y + f.y, b->torque + f.torque_b};
        }
    }
}

/* The forces of all pairs, then the sums of all discs. */
static void push_threads(discs *s, unsigned threads) {
    const size_t pairs = s->pair_count, count = s->count;
    (void)threads;
#pragma omp parallel for schedule(static) num_threads(threads)
    for (size_t k = 0; k < pairs; k++)
        if (!find_push(s, k, &s->pushes[k]))
            s->pushes[k] = (push){0, 0, 0, 0};
#pragma omp parallel for schedule(static) num_threads(threads)
    for (size_t i = 0; i < count; i++) {
        force sum = {0, 0, 0};
        for (size_t j = s->first_b[i]; j < s->first_b[i + 1]; j++) {
            const push f = s->pushes[s->of_b[j]];
            sum = (force){sum.x + f.x, sum.y + f.y, sum.torque + f.torque_b};
        }
        for (size_t k = s->first_a[i]; k < s->first_a[i + 1]; k++) {
            const push f = s->pushes[k];
            sum = (force){sum.x - f.x, sum.y - f.y, sum.torque + f.torque_a};
        }
        s->force[i] = sum;
    }
}

bool discs_step(discs *s, unsigned threads) {
    s->step++;
    const bool valid = move(s, threads);
    if (threads == 1)
        push_one_thread(s);
    else
        push_threads(s, threads);
    kick(s, threads);
    return valid;
}

double discs_kinetic(const discs *s) {
    double sum = 0;
    for (size_t k = 0; k < s->count; k++) {
        const disc *b = &s->disc[k];
        sum += 0.5 * ((b->vx * b->vx + b->vy * b->vy) / b->inverse_mass + b->spin * b->spin / b->inverse_inertia);
    }
    return sum;
}
