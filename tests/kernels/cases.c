/* SPDX-License-Identifier: MIT
 *
 * cases.c - pairs whose answer is known by hand: exact touch, faces on faces, corners, coincident centres.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "check.h"

static struct shape half_disc(void) {
    return (struct shape){{{0, -1, 0, -PI / 2, 0}, {0, 1, 0, 0, PI / 2}, {0, 0, 1, PI / 2, 3 * PI / 2}}, 3};
}

/* The answer for one pair: A at the origin, turned, B at (x, y); checked against the reference before anything else. */
struct answer {
    bool overlap;
    float separation, normal_x, normal_y, point_x, point_y;
    unsigned arc_a, arc_b;
};

static struct answer ask_bodies(const struct shape *a, struct body body_a, const struct shape *b, struct body body_b) {
    AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, 2, 2, 1);
    scene_add_shape(&scene, a);
    scene_add_shape(&scene, b);
    body_b.shape = 1;
    scene_add_body(&scene, body_a);
    scene_add_body(&scene, body_b);
    scene_add_pair(&scene, 0, 1);
    AUTO(free_at) uint64_t *bits = scene_overlaps(&scene);
    AUTO(free_at) struct contacts all = scene_contacts(&scene, INFINITY);
    struct reference_body at_a = scene_reference(&scene, 0), at_b = scene_reference(&scene, 1);
    struct fractions errors = {0};
    const char *wrong = check_contact(&at_a, &at_b, reference_solve_gap(&at_a, &at_b).gap, &all.rows[0], &errors);
    if (wrong) {
        fail_msg("B at (%a, %a): wrong %s; separation %.9g, normal (%.9g, %.9g), point (%.9g, %.9g), errors %.3g, "
                 "%.3g, %.3g",
                 body_b.x, body_b.y, wrong, (double)all.rows[0].separation, (double)all.rows[0].normal_x,
                 (double)all.rows[0].normal_y, (double)all.rows[0].point_x, (double)all.rows[0].point_y,
                 errors.separation, errors.normal, errors.point);
    }
    struct answer answer = {bit_is_set(bits, 0),           all.rows[0].separation,       all.rows[0].normal_x,
                            all.rows[0].normal_y,          all.rows[0].point_x,          all.rows[0].point_y,
                            arc_of_a(all.rows[0].feature), arc_of_b(all.rows[0].feature)};
    return answer;
}

static struct answer ask_turned(const struct shape *a, double angle, const struct shape *b, double x, double y) {
    return ask_bodies(a, turned_body(angle, 1), b, (struct body){.x = x, .y = y, .cosine = 1, .scale = 1});
}

static struct answer ask(const struct shape *a, const struct shape *b, double x, double y) {
    return ask_turned(a, 0, b, x, y);
}

/* Touching is not colliding, and the next float closer is. */
TEST(test_circles_touch) {
    struct shape one = circle_of(1);
    struct answer apart = ask(&one, &one, 2, 0), deeper = ask(&one, &one, 2 - 0x1p-22, 0);
    assert_false(apart.overlap);
    assert_true(apart.separation == 0);
    assert_true(deeper.overlap);
    assert_true(deeper.separation == -0x1p-22f);
}

/* Side on side, corner on corner, and corner on side. */
TEST(test_boxes_touch) {
    struct shape box = box_of(2, 1, 0);
    assert_false(ask(&box, &box, 2, 0).overlap);
    assert_false(ask(&box, &box, 0, 1).overlap);
    assert_false(ask(&box, &box, -2, 1).overlap);
    assert_false(ask(&box, &box, -2, 0.25).overlap);
    assert_true(ask(&box, &box, -2 + 0x1p-20, 0.25).overlap);
}

/* Where sides lie on each other, the point is the middle of what they share; the arc is the one after the side. */
TEST(test_faces_share_a_stretch) {
    struct shape wide = box_of(4, 1, 0), narrow = box_of(1, 1, 0.25);
    /* Tops of A from x = -2 to 2; the side of B without its round corners is 0.5 wide. */
    const struct {
        double x, y;
        float point_x, point_y, separation;
    } cases[] = {
        {0.75, 1, 0.75f, 0.5f, 0},            /* touching, all of B's side */
        {0.75, 0.75, 0.75f, 0.375f, -0.25f},  /* inside */
        {0.75, 1.5, 0.75f, 0.75f, 0.5f},      /* apart */
        {2, 0.75, 1.875f, 0.375f, -0.25f},    /* half of B's side hangs over the end: 1.75 .. 2 */
        {-2.125, 1.5, -1.9375f, 0.75f, 0.5f}, /* -2 .. -1.875 */
    };
    for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
        struct answer up = ask(&wide, &narrow, cases[k].x, cases[k].y);
        assert_true(fabsf(up.separation - cases[k].separation) <= 1e-6f);
        assert_true(fabsf(up.normal_x) <= 1e-6f && fabsf(up.normal_y - 1) <= 1e-6f);
        if (fabsf(up.point_x - cases[k].point_x) > 4e-6f || fabsf(up.point_y - cases[k].point_y) > 4e-6f)
            fail_msg("case %zu: point (%.9g, %.9g)", k, (double)up.point_x, (double)up.point_y);
        /* Arcs of a box, counter-clockwise from the upper right: its top ends at arc 1, its bottom at arc 3. */
        size_t top, bottom;
        narc_find_support(wide.arcs, wide.count, 0, 1, NULL, &top);
        narc_find_support(narrow.arcs, narrow.count, 0, -1, NULL, &bottom);
        assert_int_equal(up.arc_a, top);
        assert_int_equal(up.arc_b, bottom);
    }
}

/* The same with both turned, B's shape by another angle than B: then rounding leaves the normals of the sides apart. */
TEST(test_turned_faces_share_a_stretch) {
    struct test_random random = test_random_named("turned faces");
    struct shape wide = box_of(4, 1, 0), narrow;
    for (size_t trial = 0; trial < test_trials(2000); trial++) {
        double angle = random_between(&random, -PI, PI), c = cos(angle), s = sin(angle);
        double own = random_between(&random, -PI, PI), oc = 0.5 * cos(own), os = 0.5 * sin(own);
        const narc_point corners[4] = {
            {oc - os, os + oc}, {-oc - os, oc - os}, {os - oc, -os - oc}, {oc + os, os - oc}};
        assert_int_equal(narc_build_polygon(corners, 4, 0.25, narrow.arcs, &narrow.count, NULL), NARC_OK);
        double x = random_between(&random, -1.5, 1.5), y = random_between(&random, 0.6, 1.5);
        struct body at_b = turned_body(angle - own, 1);
        at_b.x = c * x - s * y;
        at_b.y = s * x + c * y;
        struct answer up = ask_bodies(&wide, turned_body(angle, 1), &narrow, at_b);
        double middle = (0.5 + (y - 0.5)) / 2; /* between A's top and B's bottom */
        double off_x = (double)up.point_x - (c * x - s * middle), off_y = (double)up.point_y - (s * x + c * middle);
        if (hypot(off_x, off_y) > 1e-5)
            fail_msg("angle %.17g, B at (%.17g, %.17g): point off by (%.3g, %.3g)", angle, x, y, off_x, off_y);
    }
}

/* A circle in another, its three arcs off by a rounding or two so that the gap grows along each of them and falls back
 * where the next begins: no local maximum is to be seen anywhere, and the gap is the same in all directions but for
 * that. */
TEST(test_gap_rises_all_around) {
    struct shape spiral = {.count = 3}, circle = circle_of(1.5);
    for (size_t k = 0; k < 3; k++) {
        double start = 0.1 + 2 * PI / 3 * (double)k, end = start + 2 * PI / 3, ahead = end + 0.5;
        spiral.arcs[k] = (narc_arc){-2e-7 * cos(ahead), -2e-7 * sin(ahead), 1, start, end};
    }
    for (double angle = -3; angle < 3; angle += 0.01) {
        struct answer answer = ask_turned(&spiral, angle, &circle, 0, 0);
        assert_true(answer.overlap && fabsf(answer.separation + 2.5f) < 1e-6f);
    }
}

TEST(test_coincident_circles) {
    struct shape one = circle_of(1), two = circle_of(2);
    struct answer same = ask(&one, &one, 0, 0), other = ask(&one, &two, 0, 0);
    assert_true(same.overlap && other.overlap);
    assert_true(same.separation == -2);
    assert_true(other.separation == -3);
    assert_int_equal(other.arc_a, 0);
    assert_int_equal(other.arc_b, 0);
}

/* A circle beyond the end of an edge, but so little that the edge's normal has the same gap up to a rounding. The
 * contact is at the edge's end, and must not be looked for on the edge's continuation. */
TEST(test_just_beyond_an_edge) {
    struct shape half = half_disc(), circle = circle_of(1);
    for (double beyond = 1e-5; beyond < 0.1; beyond *= 1.004) {
        ask(&half, &circle, 1.3, -1 - beyond);
        ask(&half, &circle, 1.3, 1 + beyond);
        ask(&half, &circle, 0.9, 1 + beyond);
        ask(&circle, &half, -1, 1 + beyond);
    }
}

/* The same at a smooth junction: a tip of a flat lens, whose large arc ends where the tip begins. */
TEST(test_just_beyond_a_junction) {
    struct test_random random = test_random_named("just beyond a junction");
    struct shape lens, circle = circle_of(1);
    narc_four_arc form = {25, 25, 49.96, 0.002, 0.002};
    assert_int_equal(narc_build_four_arc(&form, lens.arcs, &lens.count, NULL), NARC_OK);
    for (size_t trial = 0; trial < test_trials(10000); trial++) {
        const narc_arc *arc = &lens.arcs[trial % 4];
        double turn = random_between(&random, -PI, PI), c = cos(turn), s = sin(turn);
        double beyond = random_between(&random, -1, 1) * random_log_between(&random, 1e-5, 1e-2);
        double angle = arc->start + beyond, distance = random_between(&random, 1, 4);
        double x = arc->center_x + arc->radius * cos(arc->start) + distance * cos(angle);
        double y = arc->center_y + arc->radius * sin(arc->start) + distance * sin(angle);
        ask_turned(&lens, turn, &circle, c * x - s * y, s * x + c * y);
    }
}

/* Arcs of half a turn: where the normal is at one end of them, the opposite direction is at the other, and rounding may
 * make them a little longer than half a turn. The largest gap must not be lost to the one on the opposite side. */
TEST(test_half_turns) {
    struct test_random random = test_random_named("half turns");
    struct shape shapes[3] = {circle_of(1), half_disc()};
    assert_int_equal(narc_build_capsule(1, 0.5, shapes[2].arcs, &shapes[2].count, NULL), NARC_OK);
    for (size_t trial = 0; trial < test_trials(10000); trial++) {
        const struct shape *a = &shapes[trial % 3], *b = &shapes[trial / 3 % 3];
        double quarter = PI / 2 * (double)random_below(&random, 4);
        double tilt = random_below(&random, 2) ? 0x1p-24 * random_between(&random, -8, 8) : 0;
        double turn = random_below(&random, 2) ? quarter + tilt : random_between(&random, -PI, PI);
        /* Along an end of A's arcs, or along an axis, where B's are; from deep to apart. */
        double direction = random_below(&random, 2) ? turn + PI / 2 * (double)random_below(&random, 4) : quarter;
        double distance = random_between(&random, 0, 3);
        ask_turned(a, turn, b, distance * cos(direction), distance * sin(direction));
    }
}

/* The first junctions of A and B, counter-clockwise from A's x axis, agree up to rounding, and the normal is theirs:
 * the interval that ends with them must end with the one that the first interval began with. */
TEST(test_last_interval_meets_first) {
    struct shape lens,
        mixed = {{{0x1.56102fd2c42edp-2, -0x1.d9db3b05cfe4ep-2, 0, -0x1.9589d6a800c3cp-1, -0x1.f7028ddcac9fep-2},
                  {0x1.bfb62b95f33e4p-2, 0x1.c4f6721a0f70cp-2, 0x1.5806d3f61a82ap-2, -0x1.f7028ddcac9fep-2,
                   0x1.45642e7b3042p-3},
                  {0x1.89b3dc3457d4p-1, 0x1.fb648f678264ep-2, 0, 0x1.45642e7b3042p-3, 0x1.491a0f25ad1d2p+0},
                  {0x1.d50331e7c39e1p-4, -0x1.ba115f5167896p-1, 0x1.7cf80dac65349p+0, 0x1.491a0f25ad1d2p+0,
                   0x1.cd1c6f1176f1cp+0},
                  {-0x1.e38b525d83ce5p-4, -0x1.2ab08260bb1d8p-1, 0x1.2993dcd8a7727p+0, 0x1.cd1c6f1176f1cp+0,
                   0x1.238bb20caa71dp+1},
                  {-0x1.43a10a4bb2887p-1, 0x1.2ddbafd401f3ep-6, 0x1.7bdcd2000ce2bp-2, 0x1.238bb20caa71dp+1,
                   0x1.a3f5aba3688ap+1},
                  {-0x1.ffb82e8b7586ap-1, -0x1.0f2617eb94bbbp-5, 0, 0x1.a3f5aba3688ap+1, 0x1.ffe6f1aa72d6ep+1},
                  {-0x1.d1c0a3ab40a67p-5, -0x1.b26adea68c427p-1, 0, 0x1.ffe6f1aa72d6ep+1, 0x1.5f6e7a6f42b9p+2}},
                 8};
    lens =
        (struct shape){{{0x1.cea7f50158eb1p-1, -0x1.368d36697f931p-2, 0x1.4aba6911bf71fp-7, -0x1.2a414faec6d6dp+0,
                         0x1.0718658603aa1p+0},
                        {0, -0x1.ccde9df41da2ap+0, 0x1.c2389dffe5fe9p+0, 0x1.0718658603aa1p+0, 0x1.0d1d8252d98e2p+1},
                        {-0x1.c3421947e9b8ep-1, -0x1.34ffc8dac4467p-2, 0x1.4aba6911bf71fp-6, 0x1.0d1d8252d98e2p+1,
                         -0x1.f7c332d2b5228p+0},
                        {0, 0x1.ccde9df41da2ap+0, 0x1.2656698978c85p+1, -0x1.f7c332d2b5228p+0, -0x1.2a414faec6d6dp+0}},
                       4};
    const struct body at_a = {.cosine = 0x1.88705p-3f, .sine = 0x1.f6831ep-1f, .scale = 1};
    const struct body at_b = {.x = -0x1.06d629bce93f6p+0,
                              .y = 0x1.88c24b752eadbp+0,
                              .cosine = 0x1.cf4e28p-1f,
                              .sine = -0x1.b3daa8p-2f,
                              .scale = 1};
    assert_false(ask_bodies(&mixed, at_a, &lens, at_b).overlap);
}

/* Denormals and both zeros are numbers like others: the answer is that of 0. */
TEST(test_denormals) {
    static const float tiny[] = {0.0f, -0.0f, FLT_TRUE_MIN, -FLT_TRUE_MIN, FLT_MIN / 2, -FLT_MIN};
    struct test_random random = test_random_named("denormals");
    enum { DENORMALS = 200 };
    AUTO(destroy_scene) struct scene scene = make_random_scene(&random, NARC_FLOAT32, DENORMALS, 5000);
    for (size_t k = 0; k < DENORMALS; k++) {
        struct body *body = &scene.bodies[k];
        *(random_below(&random, 2) ? &body->x : &body->y) = (double)tiny[random_below(&random, 6)];
        *body = (struct body){
            body->x, body->y,    0, 0, random_below(&random, 2) ? 1.0f : -1.0f, tiny[random_below(&random, 6)],
            1,       body->shape};
        round_position(body, NARC_FLOAT32);
    }
    AUTO(free_at) struct contacts all = scene_contacts(&scene, INFINITY);
    for (size_t k = 0; k < scene.pair_count; k++) {
        struct reference_body a = scene_reference(&scene, scene.pairs[k].a),
                              b = scene_reference(&scene, scene.pairs[k].b);
        struct fractions errors = {0};
        assert_null(check_contact(&a, &b, reference_solve_gap(&a, &b).gap, &all.rows[k], &errors));
    }
}

/* ------------------------------------------------------------------------------------------------ corners */

/* The outward normal of the edge before an arc, in the world; false if there is none to speak of. */
static bool find_face(const struct reference_body *body, size_t arc, narc_point *out_normal) {
    const narc_arc *const own = &body->arcs[arc], *const last = &body->arcs[(arc + body->count - 1) % body->count];
    const double x = cos(own->start), y = sin(own->start);
    *out_normal = (narc_point){body->cosine * x - body->sine * y, body->sine * x + body->cosine * y};
    return fabs(x * (own->center_y - last->center_y) - y * (own->center_x - last->center_x)) > 1e-3;
}

/* Of all edges' normals, from A to B, the largest gap; and the sine of the angle from n to the nearest. */
static double find_best_face(const struct reference_body *a, const struct reference_body *b, double n_x, double n_y,
                             double *out_sine) {
    double most = -INFINITY;
    *out_sine = 1;
    for (int side = 0; side < 2; side++) {
        const struct reference_body *const body = side ? b : a;
        narc_point n;
        for (size_t k = 0; k < body->count; k++) {
            if (!find_face(body, k, &n))
                continue;
            const double x = side ? -n.x : n.x, y = side ? -n.y : n.y;
            most = fmax(most, reference_gap_along(a, b, x, y));
            if (x * n_x + y * n_y > 0)
                *out_sine = fmin(*out_sine, fabs(x * n_y - y * n_x));
        }
    }
    return most;
}

/* Places B so that the centre of one of its arcs is at that of one of A, but for (x, y); what both reach over it. */
static struct body place_corner(struct test_random *random, const struct shape *a, struct body at_a,
                                const struct shape *b, double x, double y, double *out_radii) {
    struct body at_b = turned_body(random_below(random, 3) ? random_between(random, -4, 4)
                                                           : atan2((double)at_a.sine, (double)at_a.cosine) +
                                                                 PI / 2 * (double)random_below(random, 4),
                                   1);
    const narc_arc *const of_a = &a->arcs[random_below(random, a->count)], *const of_b =
                                                                               &b->arcs[random_below(random, b->count)];
    at_b.x = x + (double)at_a.cosine * of_a->center_x - (double)at_a.sine * of_a->center_y -
             ((double)at_b.cosine * of_b->center_x - (double)at_b.sine * of_b->center_y);
    at_b.y = y + (double)at_a.sine * of_a->center_x + (double)at_a.cosine * of_a->center_y -
             ((double)at_b.sine * of_b->center_x + (double)at_b.cosine * of_b->center_y);
    at_b.shape = 1;
    *out_radii = of_a->radius + of_b->radius;
    return at_b;
}

/* Corner on corner within rounding: where a face has as large a gap, its normal is told, by contacts and manifolds. And
 * corners that are further apart keep the normal between them. */
TEST(test_corners_within_rounding) {
    enum { PAIRS = 60 };
    static const enum family families[] = {FAMILY_BOX, FAMILY_POLYGON, FAMILY_CAPSULE, FAMILY_ROUNDED, FAMILY_SEGMENT};
    struct test_random random = test_random_named("corners within rounding");
    size_t faces = 0, corners = 0;
    for (size_t k = 0; k < test_trials(300); k++) {
        const bool apart = k % 4 == 3;
        const struct shape a = make_shape(&random, families[random_below(&random, 5)]),
                           b = make_shape(&random, families[random_below(&random, 5)]);
        AUTO(destroy_scene) struct scene scene = create_scene(NARC_FLOAT64, 2, 2 * PAIRS, PAIRS);
        scene_add_shape(&scene, &a);
        scene_add_shape(&scene, &b);
        double radii[PAIRS];
        for (int pair = 0; pair < PAIRS; pair++) {
            const struct body at_a = turned_body(random_between(&random, -4, 4), 1);
            const double angle = random_between(&random, -4, 4), way = apart ? random_log_between(&random, 1e-3, 0.1)
                                                                             : random_log_between(&random, 1e-10, 3e-7);
            scene_add_two(&scene, at_a,
                          place_corner(&random, &a, at_a, &b, random_below(&random, 9) ? way * cos(angle) : 0,
                                       random_below(&random, 9) ? way * sin(angle) : 0, &radii[pair]));
        }
        AUTO(free_at) struct contacts contacts = scene_contacts(&scene, INFINITY);
        AUTO(free_at) struct manifolds manifolds = scene_manifolds(&scene, INFINITY);
        assert_true(contacts.count == PAIRS && manifolds.count == PAIRS);
        for (size_t pair = 0; pair < PAIRS; pair++) {
            const struct reference_body at_a = scene_reference(&scene, scene.pairs[pair].a),
                                        at_b = scene_reference(&scene, scene.pairs[pair].b);
            const narc_contact *const row = &contacts.rows[pair];
            const double gap = reference_solve_gap(&at_a, &at_b).gap, bound = separation_bound(&at_a, &at_b);
            const double n_x = (double)row->normal_x, n_y = (double)row->normal_y;
            struct fractions errors = {0};
            double sine;
            assert_null(check_contact(&at_a, &at_b, gap, row, &errors));
            assert_true(row->normal_x == manifolds.rows[pair].normal_x &&
                        row->normal_y == manifolds.rows[pair].normal_y);
            const double best = find_best_face(&at_a, &at_b, n_x, n_y, &sine);
            if (apart) {
                /* Between two arcs that touch there is no gap as large elsewhere. */
                if (gap - best > 8 * bound) {
                    assert_true(sine > 1e-5);
                    corners++;
                }
            } else if (gap - best < bound / 8 && fabs(gap + radii[pair]) < bound / 2) {
                if (sine > 1e-6)
                    fail_msg(
                        "pair %zu of %zu: normal (%.9g, %.9g), %.3g off the nearest face's, of which one has a gap "
                        "that is less by %.3g of the bound",
                        pair, k, n_x, n_y, sine, (gap - best) / bound);
                faces++;
            }
        }
    }
    print_message("%zu told of faces, %zu of corners\n", faces, corners);
    assert_true(test_trials(300) < 8 || (faces > 0 && corners > 0));
}

TEST_MAIN("cases")
