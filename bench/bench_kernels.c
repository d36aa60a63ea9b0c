/* SPDX-License-Identifier: MIT
 *
 * bench_kernels.c - the kernels on random n-arcs: kernel / arcs / scene / instruction set, one thread.
 *
 * A scene is 65,536 pairs of bodies over 4,096 distinct shapes. `mixed`: the distance between two bodies is spread
 * around the touching distance so that about half of them collide. A circle counts as n1: its pairs are all settled
 * by the filter of bounding and inscribed circles, so this row is the cost of loading a pair.
 */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "narc.h"

enum { PAIRS = 65536, SHAPES = 4096, NAME = 64 };

static const double PI = 3.14159265358979323846;

static uint64_t random_state = 1;

/* splitmix64, as a double in [0, 1). */
static double random_unit(void) {
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

static void fail(const char *what, const narc_error *error) {
    fprintf(stderr, "%s: %s\n", what, error->message);
    exit(1);
}

/* An n-arc of radius about 1. With junction normals at equal angles the outline closes if the radii, as a function of
 * the angle, have no first harmonic: so they get a second and a third one. */
static size_t make_arcs(size_t n, narc_arc arcs[NARC_MAX_ARCS]) {
    const double turn = 2 * PI * random_unit(), second = 0.6 * random_unit(), third = n > 5 ? 0.25 * random_unit() : 0;
    const double phase2 = 2 * PI * random_unit(), phase3 = 2 * PI * random_unit();
    double x = 0, y = 0;
    for (size_t k = 0; k < n; k++) {
        const double start = turn + 2 * PI * (double)k / (double)n, middle = start + PI / (double)n;
        const double radius = 1 + second * cos(2 * middle + phase2) + third * cos(3 * middle + phase3);
        if (k > 0) {
            x += (arcs[k - 1].radius - radius) * cos(start);
            y += (arcs[k - 1].radius - radius) * sin(start);
        }
        arcs[k] = (narc_arc){x, y, radius, start, start + 2 * PI / (double)n};
    }
    narc_mass mass;
    narc_compute_mass(arcs, n, &mass);
    for (size_t k = 0; k < n; k++) {
        arcs[k].center_x -= mass.centroid_x;
        arcs[k].center_y -= mass.centroid_y;
    }
    return n;
}

struct body {
    float x, y, cosine, sine;
    uint32_t shape;
};

struct scene {
    narc_shapes *shapes;
    struct body *bodies;
    struct {
        uint32_t a, b;
    } * pairs;
};

static void *allocate(size_t count, size_t size) {
    void *memory = calloc(count, size);
    if (!memory) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return memory;
}

static struct scene *make_scene(size_t n) {
    struct scene *scene = allocate(1, sizeof *scene);
    narc_error error;
    if (narc_create_shapes(NULL, &scene->shapes) != NARC_OK)
        exit(1);
    for (int k = 0; k < SHAPES; k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        size_t count = n;
        if (n == 1)
            narc_build_circle(1, arcs, &count, NULL);
        else
            make_arcs(n, arcs);
        if (narc_add_shape(scene->shapes, arcs, count, NULL, &error) != NARC_OK)
            fail("shape", &error);
    }
    scene->bodies = allocate(2 * PAIRS, sizeof *scene->bodies);
    scene->pairs = allocate(PAIRS, sizeof *scene->pairs);
    for (uint32_t k = 0; k < 2 * PAIRS; k++) {
        const double angle = 2 * PI * random_unit();
        struct body *body = &scene->bodies[k];
        *body = (struct body){0, 0, (float)cos(angle), (float)sin(angle), (uint32_t)(SHAPES * random_unit())};
        if (k % 2 == 1) {
            const double direction = 2 * PI * random_unit(), distance = 1.7 + 0.6 * random_unit();
            body->x = (float)(distance * cos(direction));
            body->y = (float)(distance * sin(direction));
            scene->pairs[k / 2].a = k - 1;
            scene->pairs[k / 2].b = k;
        }
    }
    return scene;
}

static narc_bodies bodies_of(const struct scene *scene) {
    const narc_bodies bodies = {.count = 2 * PAIRS,
                                .x = NARC_COLUMN(scene->bodies, x),
                                .y = NARC_COLUMN(scene->bodies, y),
                                .cosine = NARC_COLUMN(scene->bodies, cosine),
                                .sine = NARC_COLUMN(scene->bodies, sine),
                                .shape = NARC_COLUMN(scene->bodies, shape)};
    return bodies;
}

struct job {
    const struct scene *scene;
    const char *isa;
};

static void run_overlap(void *argument) {
    static uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    const struct job *job = argument;
    const narc_bodies bodies = bodies_of(job->scene);
    const narc_pairs pairs = {PAIRS, NARC_COLUMN(job->scene->pairs, a), NARC_COLUMN(job->scene->pairs, b)};
    narc_error error;
    if (narc_set_isa(job->isa, &error) != NARC_OK ||
        narc_find_overlaps(job->scene->shapes, &bodies, &pairs, 1, bits, &error) != NARC_OK)
        fail("overlap", &error);
}

static void run_contact(void *argument) {
    static uint32_t pair[PAIRS];
    static float separation[PAIRS], normal_x[PAIRS], normal_y[PAIRS], point_x[PAIRS], point_y[PAIRS];
    static uint8_t arc_a[PAIRS], arc_b[PAIRS];
    const narc_contacts contacts = {PAIRS, pair, separation, normal_x, normal_y, point_x, point_y, arc_a, arc_b};
    const struct job *job = argument;
    const narc_bodies bodies = bodies_of(job->scene);
    const narc_pairs pairs = {PAIRS, NARC_COLUMN(job->scene->pairs, a), NARC_COLUMN(job->scene->pairs, b)};
    narc_error error;
    size_t count;
    if (narc_set_isa(job->isa, &error) != NARC_OK ||
        narc_find_contacts(job->scene->shapes, &bodies, &pairs, 0, 1, &contacts, &count, &error) != NARC_OK)
        fail("contact", &error);
}

static void run_pose(void *argument) {
    static float angles[PAIRS], cosines[PAIRS], sines[PAIRS];
    const struct job *job = argument;
    narc_error error;
    if (angles[1] == 0)
        for (int k = 0; k < PAIRS; k++)
            angles[k] = (float)(20 * random_unit() - 10);
    if (narc_set_isa(job->isa, &error) != NARC_OK ||
        narc_compute_poses(angles, PAIRS, cosines, sines, &error) != NARC_OK)
        fail("pose", &error);
}

static void add(const char *kernel, const struct scene *scene, const char *isa, void (*run)(void *)) {
    char name[NAME];
    snprintf(name, sizeof name, "%s/%s", kernel, isa);
    if (!narc_isa_supported(isa)) {
        bench_skip(name, "not supported here");
        return;
    }
    struct job *job = allocate(1, sizeof *job);
    *job = (struct job){scene, isa};
    bench_add(name, run, job, PAIRS);
}

int main(int argc, char **argv) {
    static const size_t arc_counts[] = {1, 4, 8, 16};
    for (size_t k = 0; k < sizeof arc_counts / sizeof arc_counts[0]; k++) {
        const struct scene *scene = make_scene(arc_counts[k]);
        char name[NAME];
        for (size_t isa = 0; narc_isa_name(isa); isa++) {
            snprintf(name, sizeof name, "overlap/n%zu/mixed", arc_counts[k]);
            add(name, scene, narc_isa_name(isa), run_overlap);
        }
        for (size_t isa = 0; narc_isa_name(isa); isa++) {
            snprintf(name, sizeof name, "contact/n%zu/mixed", arc_counts[k]);
            add(name, scene, narc_isa_name(isa), run_contact);
        }
    }
    for (size_t isa = 0; narc_isa_name(isa); isa++)
        add("pose", NULL, narc_isa_name(isa), run_pose);
    return bench_run(argc, argv);
}
