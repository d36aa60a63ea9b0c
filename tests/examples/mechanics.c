/* SPDX-License-Identifier: MIT
 *
 * mechanics.c - the example world against textbook mechanics, and its errors.
 */
#include <math.h>
#include <string.h>

#include "runs.h"
#include "world.h"

static const double g = 9.81;

/* A world with a floor whose top is y = 0, and gravity as on a slope that falls to the right. */
static world create_slope(double angle) {
    world w;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    uint32_t floor;
    world_settings settings = world_defaults;
    settings.gravity = (vec){(float)(g * sin(angle)), (float)(-g * cos(angle))};
    assert_int_equal(world_create(&w, settings, 8), NARC_OK);
    assert_int_equal(narc_build_box(200, 2, 0, arcs, &count, NULL), NARC_OK);
    assert_int_equal(world_add_shape(&w, arcs, count, &floor), NARC_OK);
    const world_body body = {.position = {0, -1}, .cosine = 1, .shape = floor, .kind = NARC_STATIC, .friction = 0.5f};
    assert_int_equal(world_add_body(&w, body), NARC_OK);
    return w;
}

static world_body *add_to(world *w, const narc_arc *arcs, size_t count, float x, float y) {
    uint32_t shape;
    assert_int_equal(world_add_shape(w, arcs, count, &shape), NARC_OK);
    const world_body body = {.position = {x, y}, .cosine = 1, .shape = shape, .friction = 0.5f};
    assert_int_equal(world_add_body(w, body), NARC_OK);
    return &w->bodies[w->body_count - 1];
}

static world_body *add_box(world *w, float x, float y) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    assert_int_equal(narc_build_box(1, 1, 0, arcs, &count, NULL), NARC_OK);
    return add_to(w, arcs, count, x, y);
}

static world_body *add_circle(world *w, double radius, float x, float y) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    assert_int_equal(narc_build_circle(radius, arcs, &count, NULL), NARC_OK);
    return add_to(w, arcs, count, x, y);
}

static void step_for(world *w, double seconds) {
    for (long step = 0; step < lround(seconds * 60); step++)
        assert_int_equal(world_step(w), NARC_OK);
}

static void assert_near(double value, double expected, double tolerance) {
    print_message("%.6f, expected %.6f\n", value, expected);
    assert_true(fabs(value - expected) <= tolerance);
}

/* Friction 0.5 holds a box on any slope below atan 0.5. It may give way by what a soft contact does. */
TEST(test_box_stays_on_slope) {
    AUTO(world_destroy) world w = create_slope(0.95 * atan(0.5));
    const world_body *box = add_box(&w, 0, 0.5f);
    step_for(&w, 10);
    assert_near((double)box->position.x, 0, 0.01);
}

/* On a steeper one it slides with g (sin - 0.5 cos). */
TEST(test_box_slides) {
    const double angle = 0.7;
    AUTO(world_destroy) world w = create_slope(angle);
    const world_body *box = add_box(&w, 0, 0.5f);
    step_for(&w, 2);
    const double speed = 2 * g * (sin(angle) - 0.5 * cos(angle));
    assert_near((double)box->velocity.x, speed, 0.01 * speed);
    assert_near((double)box->spin, 0, 0.01);
}

/* A disc's moment of inertia leaves it two thirds of the acceleration, after the torque of rolling friction. */
TEST(test_circle_rolls) {
    const double angle = 0.2, radius = 0.5;
    AUTO(world_destroy) world w = create_slope(angle);
    const world_body *circle = add_circle(&w, radius, -90, (float)radius);
    step_for(&w, 4);
    const double arm = (double)w.settings.rolling_arm;
    const double speed = 4 * g * (sin(angle) - cos(angle) * arm / radius) * 2 / 3;
    assert_near((double)circle->velocity.x, speed, 0.01 * speed);
    assert_near((double)circle->spin, -speed / radius, 0.01 * speed / radius);
}

/* A ball that falls from h rises to e^2 h. */
TEST(test_ball_bounces) {
    AUTO(world_destroy) world w = create_slope(0);
    world_body *ball = add_circle(&w, 0.5, 0, 4.5f);
    ball->restitution = 0.7f;
    double highest = 0, last = 4;
    bool rises = false;
    for (int step = 0; step < 120; step++) {
        step_for(&w, 1.0 / 60);
        const double height = (double)ball->position.y - 0.5;
        rises = rises || height > last;
        highest = rises ? fmax(highest, height) : highest;
        last = height;
    }
    assert_near(highest, 0.7 * 0.7 * 4, 0.04 * 0.7 * 0.7 * 4);
}

/* Where nothing pulls, momentum and angular momentum stay. */
TEST(test_momentum) {
    AUTO(world_destroy) world w = create_slope(0);
    w.settings.gravity = (vec){0, 0};
    w.settings.rolling_arm = 0.02f;
    const world_body *bodies[] = {add_box(&w, -3, 10), add_box(&w, 0, 10.3f), add_circle(&w, 0.4, 0.2f, 13)};
    w.bodies[1].velocity = (vec){5, 0};
    w.bodies[3].velocity = (vec){0, -4};
    w.bodies[3].spin = 10;
    w.bodies[2].restitution = 0.5f;
    double x[2], y[2], angular[2];
    for (int i = 0; i < 2; i++) {
        x[i] = y[i] = angular[i] = 0;
        for (int k = 0; k < 3; k++) {
            const world_body *body = bodies[k];
            const double mass = 1 / (double)body->inverse_mass;
            x[i] += mass * (double)body->velocity.x;
            y[i] += mass * (double)body->velocity.y;
            angular[i] += mass * (double)cross(body->position, body->velocity) +
                          (double)body->spin / (double)body->inverse_inertia;
        }
        step_for(&w, 3);
    }
    assert_true((double)w.bodies[2].velocity.x > 1); /* it was hit */
    assert_near(x[1], x[0], 1e-4);
    assert_near(y[1], y[0], 1e-4);
    /* A contact's anchors stay while bodies move on within the step, by up to 5 / 60 here: so far off its line may an
     * impulse act, which is up to 5 times the mass, 1. */
    assert_near(angular[1], angular[0], 5 * 5 / 60.0);
}

/* An ellipse that rocks on its flat side keeps its energy: it gains none, and loses 15 % at most in ten seconds, 5 times
 * in and out. If its point stayed where it was at the beginning of each step it would gain 19 %. */
TEST(test_ellipse_rocks) {
    AUTO(world_destroy) world w = create_slope(0);
    w.settings.rolling_arm = 0;
    w.settings.sleep_time = INFINITY;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    assert_int_equal(narc_build_ellipse(1, 0.5, 16, arcs, &count, NULL, NULL), NARC_OK);
    const double tilt = 0.5, height = hypot(sin(tilt), 0.5 * cos(tilt)); /* of the centre, when it touches */
    world_body *ellipse = add_to(&w, arcs, count, 0, (float)height);
    ellipse->cosine = cosf((float)tilt);
    ellipse->sine = sinf((float)tilt);
    const double lowest = 0.5 * g * (double)w.shapes[ellipse->shape].mass, start = world_energy(&w) - lowest;
    double greatest = 0, last = 0;
    for (int step = 0; step < 600; step++) {
        step_for(&w, 1.0 / 60);
        last = world_energy(&w) - lowest;
        greatest = fmax(greatest, last);
    }
    assert_near(greatest / start, 1, 0.01);
    assert_near(last / start, 0.925, 0.075);
}

/* Bodies that have turned together, as in a column that falls over, have another normal. */
TEST(test_turned_together) {
    AUTO(world_destroy) world w = create_slope(0);
    w.settings.gravity = (vec){0, 0};
    w.settings.sleep_time = INFINITY;
    add_box(&w, 0, 10);
    add_box(&w, 0, 11);
    world_body *const boxes[] = {&w.bodies[1], &w.bodies[2]};
    step_for(&w, 0.1);
    assert_int_equal(w.active_count, 1);
    assert_near((double)w.active[0]->points[0].normal.y, 1, 1e-6);
    for (int k = 0; k < 2; k++) {
        boxes[k]->cosine = 0.8f;
        boxes[k]->sine = 0.6f;
    }
    boxes[1]->position = (vec){-0.6f, 10.8f};
    step_for(&w, 1.0 / 60);
    assert_int_equal(w.active_count, 1);
    assert_near((double)w.active[0]->points[0].normal.x, -0.6, 1e-4);
}

/* A pair that is listed still, but has no point, forgets what pressed and what rolled. */
TEST(test_forgets) {
    AUTO(world_destroy) world w = create_slope(0.2);
    world_body *circle = add_circle(&w, 0.5, 0, 0.5f);
    step_for(&w, 0.5);
    assert_true(world_contact_of(&w, 0)->points[0].normal_impulse > 0 && world_contact_of(&w, 0)->rolling_impulse != 0);
    circle->position.y += 0.03f;
    circle->velocity = (vec){0, 0};
    step_for(&w, 1.0 / 60);
    assert_int_equal(w.result->count, 1);
    assert_int_equal(world_contact_of(&w, 0)->point_count, 0);
    assert_true(world_contact_of(&w, 0)->points[0].normal_impulse == 0 &&
                world_contact_of(&w, 0)->rolling_impulse == 0);
}

/* A step names the body that is broken: no pair would ever show it, because its box overlaps nothing. */
TEST(test_broken_body) {
    AUTO(world_destroy) world w = create_slope(0);
    world_body *box = add_box(&w, 0, 0.5f);
    step_for(&w, 0.1);
    box->position.x = NAN;
    assert_int_equal(world_step(&w), NARC_ERROR_NOT_FINITE);
    assert_int_equal(w.error.index, 1);
    assert_non_null(strstr(w.error.message, "body 1"));
    box->position.x = 0; /* mended, it goes on: what is known of pairs is that of the list, whatever failed */
    step_for(&w, 0.5);
    assert_near((double)box->position.y, 0.5, 0.005);
}

TEST(test_errors) {
    AUTO(world_destroy) world w = create_slope(0);
    narc_arc arcs[NARC_MAX_ARCS] = {{0, 0, -1, 0, 1}};
    assert_int_equal(world_add_shape(&w, arcs, 1, NULL), NARC_ERROR_RADIUS);
    assert_int_equal(world_add_body(&w, (world_body){.cosine = 1, .shape = 1}), NARC_ERROR_INDEX);
    for (int k = 1; k < 8; k++)
        add_circle(&w, 1, 0, (float)(4 * k));
    assert_int_equal(world_add_body(&w, w.bodies[1]), NARC_ERROR_CAPACITY);
    assert_true(strlen(w.error.message) > 0);
}

/* A shape that the world has already needs no room, whatever else it has. */
TEST(test_equal_shapes) {
    AUTO(world_destroy) world w = create_slope(0);
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    uint32_t shape, first = 0;
    for (uint32_t k = 1; k < 8; k++) {
        assert_int_equal(narc_build_box(k, 2, 0, arcs, &count, NULL), NARC_OK);
        assert_int_equal(world_add_shape(&w, arcs, count, &shape), NARC_OK);
        first = k == 1 ? shape : first;
    }
    assert_int_equal(narc_build_box(9, 2, 0, arcs, &count, NULL), NARC_OK);
    assert_int_equal(world_add_shape(&w, arcs, count, &shape), NARC_ERROR_CAPACITY);
    assert_int_equal(narc_build_box(1, 2, 0, arcs, &count, NULL), NARC_OK);
    assert_int_equal(world_add_shape(&w, arcs, count, &shape), NARC_OK);
    assert_int_equal(shape, first);
    for (uint32_t k = 0; k < 7; k++)
        assert_true(fabsf(w.shapes[first + k].mass - 2 * (float)(k + 1)) < 1e-5f);
}

/* What has no mass does not move. */
TEST(test_segment) {
    AUTO(world_destroy) world w = create_slope(0);
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    world_body body = {.cosine = 1};
    assert_int_equal(narc_build_segment(&(narc_point){-5, 1}, &(narc_point){5, 1}, 0, arcs, &count, NULL), NARC_OK);
    assert_int_equal(world_add_shape(&w, arcs, count, &body.shape), NARC_OK);
    assert_int_equal(world_add_body(&w, body), NARC_ERROR_SIZE);
    body.kind = NARC_STATIC;
    assert_int_equal(world_add_body(&w, body), NARC_OK);
}

TEST_MAIN("mechanics")
