/* SPDX-License-Identifier: MIT
 *
 * worlds.h - small worlds of grains for the tests of the discrete element program.
 */
#ifndef DEM_WORLDS_H
#define DEM_WORLDS_H

/* cmocka.h needs these before it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "dem.h"

/* A test of this program: main() runs all, those of a file in their order there. */
#define TEST(name)                                                                                                     \
    static void name(void **state);                                                                                    \
    __attribute__((constructor)) static void add_##name(void) { test_add(#name, name); }                               \
    static void name(__attribute__((unused)) void **state)
void test_add(const char *name, CMUnitTestFunction test);

/* AUTO(dem_destroy) dem d = plain_world(); is destroyed where its block ends. */
#define AUTO(release) __attribute__((cleanup(release), unused))

/* Shapes of every world, in this order: a disc of radius 1; the same circle, given as eight arcs; an octagon with
 * rounded corners; eight arcs of two radii; an ellipse; a sharp octagon; a square of side 1; a capsule; a sand
 * grain, fitted; two discs of radius 0.5 that touch, at x = -0.5 and 0.5; two bars with round ends that lie over each
 * other as an L. */
enum { DISC, ROUND, OCTAGON, ARCS, ELLIPSE, SHARP, SQUARE, LONG, SAND, DIMER, ELL };

/* No gravity, thickness 1, one thread, a material of density 1 (and E = 1e6, nu = 0.25), no damping or friction. */
dem_settings plain_settings(void);

/* The same in a cell that is periodic and sheared. */
dem_settings sheared_settings(double side, double rate);
dem make_world(dem_settings settings, dem_contact_law law);

/* With kn = 1e5, kt = 2/7 kn. */
dem_contact_law plain_law(void);

/* Of both: settings and the law, d.laws[0][0], may be changed before there are grains (but for the Hertz law). */
dem plain_world(void);

void add_grain(dem *d, uint32_t shape, double x, double y, double vx, double vy);
dem_wall *add_box(dem *d, uint32_t shape, double scale, double x, double y);
void add_plate(dem *d, const char *name, double x, double y, double normal_x, double normal_y);

/* 120 grains of all shapes in a cell that is periodic in x, between two plates of which the upper one moves along and
 * is held at a stress, with a box that turns. */
dem make_busy_world(unsigned threads);

void step(dem *d, size_t count);

dem_energies energies(const dem *d);

/* Kinetic, potential and elastic energy, and what was dissipated, less what walls gave. */
double total_energy(const dem *d);

/* The call, of this world, ends with an error whose message has this text. */
#define EXPECT_ERROR(d, message, call)                                                                                 \
    do {                                                                                                               \
        watch_errors(d);                                                                                               \
        if (setjmp(error_place) == 0) {                                                                                \
            call;                                                                                                      \
            fail_msg("no error: %s", message);                                                                         \
        }                                                                                                              \
        check_error(d, message);                                                                                       \
    } while (0)
extern jmp_buf error_place;
void watch_errors(dem *d);
void check_error(const dem *d, const char *message);

#endif
