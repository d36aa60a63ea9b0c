/* SPDX-License-Identifier: MIT
 *
 * touch.c - depths in double precision: exact where they are known, without jumps, with forces that are their gradient;
 * bricks stand still.
 */
#include <math.h>

#include "worlds.h"

#define PI 3.14159265358979323846

/* Where B is from A, and both angles. */
typedef struct pose {
    double x, y, angle_a, angle_b;
} pose;

/* Both grains are of a shape; `feature` is what the library says, or goes in if `asks` is not set. The deeper end is as
 * deep as the library says, as far as it knows. */
static touch ask(const dem *d, uint32_t shape, pose p, bool asks, unsigned *feature) {
    const touch_side *sides = d->outlines[shape].sides; /* shapes of one outline */
    const size_t count = d->outlines[shape].side_count;
    const touch_grain a = {sides, count, cos(p.angle_a), sin(p.angle_a), 1};
    const touch_grain b = {sides, count, cos(p.angle_b), sin(p.angle_b), 1};
    touch t;
    if (asks) {
        narc_body two[2] = {{0, 0, (float)a.cosine, (float)a.sine, 1, shape},
                            {p.x, p.y, (float)b.cosine, (float)b.sine, 1, shape}};
        narc_bodies bodies;
        narc_view_bodies(two, 2, &bodies);
        const narc_pairs pair = {.count = 1};
        const narc_query query = {.margin = 1e-5F};
        narc_contact row;
        size_t found;
        assert_int_equal(narc_find_contacts(d->store, &bodies, &pair, &query, &row, 1, &found, NULL), NARC_OK);
        if (found == 0)
            return (touch){.count = 0};
        *feature = row.feature;
        find_touch(&a, &b, p.x, p.y, *feature, &t);
        const double depth = t.count == 0 ? 0 : fmax(t.end[0].depth, t.count == 2 ? t.end[1].depth : 0);
        const double told = fmax(-(double)row.separation, 0);
        if (!(fabs(depth - told) < 1e-5))
            fail_msg("shape %u, feature %x: depth %g, the library's is %g", shape, row.feature, depth, told);
    }
    find_touch(&a, &b, p.x, p.y, *feature, &t);
    return t;
}

/* Between 0 and 1. */
static double draw(uint64_t *random) {
    *random = *random * 6364136223846793005u + 1442695040888963407u;
    return (double)(*random >> 11) * 0x1p-53;
}

/* Two grains that overlap by up to 0.01 or so, many with sides that lie on each other. */
static pose draw_pose(const dem *d, uint32_t shape, uint64_t *random) {
    const double direction = 2 * PI * draw(random);
    pose p = {.angle_a = 2 * PI * draw(random)};
    const double side = floor(8 * draw(random)) * PI / 4 + 0.02 * (draw(random) - 0.5);
    p.angle_b = draw(random) < 0.7 ? p.angle_a + side : 2 * PI * draw(random);
    unsigned feature;
    for (double r = 2 * d->shapes[shape].reach;; r -= 0.01) {
        p.x = r * cos(direction);
        p.y = r * sin(direction);
        if (ask(d, shape, p, true, &feature).count > 0)
            return p;
    }
}

static pose move(pose p, const double by[4], double step) {
    return (pose){p.x + step * by[0], p.y + step * by[1], p.angle_a + step * by[2], p.angle_b + step * by[3]};
}

/* Along small ways the depth changes by no more than they are long: 2e-5, and at both ends by sqrt(2) times that. */
TEST(test_depth_never_jumps) {
    AUTO(dem_destroy) dem d = plain_world();
    uint64_t random = 5;
    size_t doubles = 0;
    double worst = 0;
    for (uint32_t shape = OCTAGON; shape <= SAND; shape++)
        for (int trial = 0; trial < 500; trial++) {
            pose p = draw_pose(&d, shape, &random);
            double way[4], last = INFINITY;
            for (int i = 0; i < 4; i++)
                way[i] = 1e-5 * (2 * draw(&random) - 1);
            for (int i = 0; i < 200; i++) {
                unsigned feature;
                p = move(p, way, 1);
                const touch t = ask(&d, shape, p, true, &feature);
                const double depth = t.count > 0 ? t.depth : 0;
                worst = last < INFINITY ? fmax(worst, fabs(depth - last)) : worst;
                doubles += t.count == 2;
                last = depth;
            }
        }
    print_message("largest change %.3g, %zu with two ends\n", worst, doubles);
    assert_true(doubles > 100000);
    assert_true(worst < 1e-4);
}

/* Two circles of radius 1 and 0.5 and their tangents: the library says how deep they are. */
TEST(test_edges_between_unequal_arcs) {
    const double turn = acos(0.25);
    const narc_arc arcs[] = {{0, 0, 1, turn, PI}, {0, 0, 1, PI, 2 * PI - turn}, {2, 0, 0.5, -turn, turn}};
    AUTO(dem_destroy) dem d;
    dem_create(&d, plain_settings());
    const uint32_t shape = dem_add_shape(&d, "drop", arcs, 3);
    uint64_t random = 4;
    for (int trial = 0; trial < 1000; trial++)
        draw_pose(&d, shape, &random);
}

/* What a force of 1 does in a small motion is what the depth loses: by central differences of 1e-6. */
TEST(test_force_is_the_gradient_of_the_depth) {
    AUTO(dem_destroy) dem d = plain_world();
    uint64_t random = 6;
    size_t slides = 0;
    double worst = 0;
    for (uint32_t shape = OCTAGON; shape <= SAND; shape++)
        for (int trial = 0; trial < 4000; trial++) {
            const pose p = draw_pose(&d, shape, &random);
            unsigned feature = 0;
            const touch t = ask(&d, shape, p, true, &feature);
            slides += t.count == 2 && hypot(t.slide_x, t.slide_y) > 1e-4;
            for (int i = 0; i < 4; i++) {
                const double by[4] = {i == 0, i == 1, i == 2, i == 3}, step = 1e-6;
                const touch more = ask(&d, shape, move(p, by, step), false, &feature);
                const touch less = ask(&d, shape, move(p, by, -step), false, &feature);
                if (more.count != t.count || less.count != t.count || t.depth < 1e-4)
                    continue;
                double work = 0; /* of the force on B, and the opposite one on A */
                for (int e = 0; e <= t.count; e++) {
                    const touch_end *end = &t.end[e];
                    const bool slide = e == t.count;
                    const double fx = slide ? (t.count == 2 ? t.slide_x : 0) : end->share * end->normal_x;
                    const double fy = slide ? (t.count == 2 ? t.slide_y : 0) : end->share * end->normal_y;
                    const double x = slide ? t.corner_x : end->x, y = slide ? t.corner_y : end->y;
                    work += i == 0 ? fx : i == 1 ? fy : i == 2 ? -(x * fy - y * fx) : (x - p.x) * fy - (y - p.y) * fx;
                }
                worst = fmax(worst, fabs(work + (more.depth - less.depth) / (2 * step)));
            }
        }
    print_message("largest difference %.3g, %zu slide\n", worst, slides);
    assert_true(slides > 50);
    assert_true(worst < 1e-3);
}

/* A contact of 1e-9 of a grain, far from the origin, is as deep as the places say: to their rounding. */
TEST(test_depth_is_double) {
    static const double depths[] = {1e-3, 1e-6, 1e-9};
    for (int i = 0; i < 3; i++) {
        AUTO(dem_destroy) dem d = plain_world();
        d.laws[0][0].damping_ratio = 0;
        d.settings.time_step = 1e-12;
        add_plate(&d, "floor", 0, 0, 0, 1);
        add_grain(&d, DISC, 100, 1 - depths[i], 0, 0);
        add_grain(&d, SQUARE, 105, 0.5 - depths[i], 0, 0);
        add_grain(&d, SQUARE, 105, 1.5 - 2 * depths[i], 0, 0);
        add_grain(&d, SAND, 110, 5, 0, 0);
        dem_start(&d);
        step(&d, 1);
        assert_int_equal(d.contact_count, 3);
        for (size_t k = 0; k < 3; k++) {
            const double h = d.contacts[k].depth * (k == 0 ? 1 : sqrt(0.5));
            print_message("depth %.12g of %g\n", h, depths[i]);
            assert_true(fabs(h - depths[i]) < 1e-14);
        }
    }
}

/* A wall of bricks in bond, five courses, comes to rest: nothing moves, and the same contacts stay. */
TEST(test_bricks_stand_still) {
    AUTO(dem_destroy) dem d = plain_world();
    d.laws[0][0].damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.3);
    d.laws[0][0].friction = 0.5;
    d.laws[0][0].kn = 1e4;
    d.laws[0][0].kt = 3e3;
    d.settings.gravity = (vec){0, -1};
    d.settings.time_step = 1e-3;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    assert_int_equal(narc_build_box(2, 1, 0, arcs, &count, NULL), NARC_OK);
    const uint32_t brick = dem_add_shape(&d, "brick", arcs, count);
    add_plate(&d, "floor", 0, 0, 0, 1);
    for (int course = 0; course < 5; course++)
        for (int i = 0; i < 5; i++)
            add_grain(&d, brick, 2.01 * i + course % 2, 0.5 + 1.001 * course, 0, 0);
    dem_start(&d);
    step(&d, 60000);
    const size_t contacts = d.contact_count;
    const double x = d.bodies[22].position.x, y = d.bodies[22].position.y;
    for (int i = 0; i < 20000; i++) {
        step(&d, 1);
        assert_int_equal(d.contact_count, contacts);
    }
    dem_measures m;
    dem_measure(&d, NULL, &m);
    print_message("%zu contacts, fastest %.3g, moved by %.3g\n", contacts, m.fastest,
                  hypot(d.bodies[22].position.x - x, d.bodies[22].position.y - y));
    assert_int_equal(contacts, 5 + 4 * 9);
    assert_true(m.fastest < 1e-12 && m.energy.kinetic < 1e-22);
    assert_true(hypot(d.bodies[22].position.x - x, d.bodies[22].position.y - y) < 1e-10);
}
