/* SPDX-License-Identifier: MIT
 *
 * casts.c - times of impact against the reference's separation over the whole way, in double precision. Pairs are
 * placed where tests of contacts are hard, and moved back from there along a motion.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "expect.h"
#include "guard.h"
#include "hard.h"
#include "narc_scene.h"
#include "placements.h"

/* A scene whose bodies move: body k by motion[k]. */
struct moving {
    struct scene scene;
    narc_motion *motion;
    float target, tolerance, parting;
};

static narc_impact *cast_all(const struct moving *m, size_t *out_skipped) {
    const narc_bodies bodies = scene_bodies(&m->scene);
    const narc_pairs pairs = scene_pairs(&m->scene);
    const narc_motions motions = view_motions(m->motion);
    const narc_cast_options options = {
        .target = m->target, .tolerance = m->tolerance, .out_skipped = out_skipped, .parting = m->parting};
    narc_impact *rows = guard_allocate(pairs.count * sizeof *rows);
    narc_error error;
    expect_ok(narc_cast_pairs(m->scene.store, &bodies, &motions, &pairs, NULL, &options, rows, pairs.count, &error),
              &error);
    for (size_t k = 0; k < pairs.count; k += 8) { /* two bodies without a batch have the same row */
        const uint32_t a = m->scene.pairs[k].a, b = m->scene.pairs[k].b;
        const narc_body of_a = scene_body(&m->scene, a), of_b = scene_body(&m->scene, b);
        narc_cast_options own = options;
        narc_impact row;
        own.out_skipped = NULL;
        expect_ok(narc_cast_pair(m->scene.store, &of_a, &m->motion[a], &of_b, &m->motion[b], &own, &row, &error),
                  &error);
        assert_true(row.pair == 0 && row.body <= 1);
        row.pair = (uint32_t)k;
        row.body = row.count > 0 ? b : 0;
        assert_memory_equal(&row, &rows[k], sizeof row);
    }
    return rows;
}

/* ------------------------------------------------------------------------------------------------ the reference */

/* A pair on its way: A at the origin of the frame. */
struct way {
    struct reference_body a, b;
    double x, y, motion_x, motion_y; /* B's, from A's */
    double angle_a, angle_b, start_a, start_b;
};

static struct way find_way(const struct moving *m, size_t pair) {
    const uint32_t a = m->scene.pairs[pair].a, b = m->scene.pairs[pair].b;
    struct way w = {.a = scene_reference(&m->scene, a), .b = scene_reference(&m->scene, b)};
    w.x = w.b.x - w.a.x;
    w.y = w.b.y - w.a.y;
    w.motion_x = (double)m->motion[b].x - (double)m->motion[a].x;
    w.motion_y = (double)m->motion[b].y - (double)m->motion[a].y;
    w.angle_a = (double)m->motion[a].angle;
    w.angle_b = (double)m->motion[b].angle;
    w.start_a = atan2(w.a.sine, w.a.cosine);
    w.start_b = atan2(w.b.sine, w.b.cosine);
    w.a.x = w.a.y = 0;
    return w;
}

static void turn_to(struct reference_body *body, double angle) {
    body->cosine = cos(angle);
    body->sine = sin(angle);
}

static void go_to(struct way *w, double time) {
    w->b.x = w->x + time * w->motion_x;
    w->b.y = w->y + time * w->motion_y;
    turn_to(&w->a, w->start_a + time * w->angle_a);
    turn_to(&w->b, w->start_b + time * w->angle_b);
}

static double separation_at(struct way *w, double time) {
    go_to(w, time);
    return reference_solve_gap(&w->a, &w->b).gap;
}

static bool turns(const struct way *w) { return w->angle_a != 0 || w->angle_b != 0; }

/* Golden-section search for a least separation between two times. */
static double descend(struct way *w, double low, double high, double enough) {
    const double ratio = 0.618033988749894848;
    double left = high - ratio * (high - low), right = low + ratio * (high - low);
    double at_left = separation_at(w, left), at_right = separation_at(w, right), least = fmin(at_left, at_right);
    for (int k = 0; k < 50 && high - low > 1e-9 && least >= enough; k++) {
        if (at_left < at_right) {
            high = right;
            right = left;
            at_right = at_left;
            at_left = separation_at(w, left = high - ratio * (high - low));
        } else {
            low = left;
            left = right;
            at_left = at_right;
            at_right = separation_at(w, right = low + ratio * (high - low));
        }
        least = fmin(least, fmin(at_left, at_right));
    }
    return least;
}

/* The least separation of the times 0 .. end, as far as it is below `enough`. Without turning it is convex in time. Else
 * it changes by at most `speed` in a step: what can't come below `enough` between two times is passed over. */
static double find_least(struct way *w, double end, double enough) {
    enum { SAMPLES = 160 };
    double at[SAMPLES + 1], least = fmin(separation_at(w, 0), separation_at(w, end));
    if (!turns(w))
        return end > 0 ? fmin(least, descend(w, 0, end, enough)) : least;
    const double speed = hypot(w->motion_x, w->motion_y) + fabs(w->angle_a) * reference_extent(&w->a) +
                         fabs(w->angle_b) * reference_extent(&w->b);
    for (int k = 0; k <= SAMPLES; k++)
        at[k] = separation_at(w, end * k / SAMPLES);
    for (int k = 0; k <= SAMPLES; k++)
        least = fmin(least, at[k]);
    for (int k = 0; k < SAMPLES; k++) {
        const bool valley = (k == 0 || at[k] <= at[k - 1]) || (k + 2 > SAMPLES || at[k + 1] <= at[k + 2]);
        if (valley && fmin(at[k], at[k + 1]) - speed * end / SAMPLES < enough)
            least = fmin(least, descend(w, end * k / SAMPLES, end * (k + 1) / SAMPLES, enough));
    }
    return least;
}

/* ------------------------------------------------------------------------------------------------ what is right */

struct summary {
    size_t outcomes[3], at_start, rounded;
    struct fractions worst;
};

static void fail_cast(const struct moving *m, size_t pair, const narc_impact *row, const char *what, double found,
                      double allowed) {
    struct way w = find_way(m, pair);
    print_pair(&w.a, &w.b);
    fail_msg(
        "pair %zu: %s: %.9g, allowed %.9g; outcome %d at %.9g, separation %.9g; way (%.17g, %.17g) + (%.17g, %.17g) "
        "t, turning %.9g and %.9g, target %.9g",
        pair, what, found, allowed, row->count, (double)row->fraction, (double)row->separation, w.x, w.y, w.motion_x,
        w.motion_y, w.angle_a, w.angle_b, (double)m->target);
}

static void check_row(const struct moving *m, size_t pair, const narc_impact *row, struct summary *summary) {
    struct way w = find_way(m, pair);
    const double target = (double)m->target, fraction = (double)row->fraction;
    go_to(&w, fraction);
    const double bound = separation_bound(&w.a, &w.b);
    const double turning = fabs(w.angle_a) * reference_extent(&w.a) + fabs(w.angle_b) * reference_extent(&w.b);
    const double rounding = 0x1p-24 * (hypot(w.motion_x, w.motion_y) + 3 * turning);
    assert_int_equal(row->pair, pair);
    assert_in_range(row->count, 0, 2);
    summary->outcomes[row->count]++;
    if (row->count == NARC_CAST_MISS) {
        const narc_impact none = {.pair = (uint32_t)pair};
        assert_memory_equal(row, &none, sizeof none);
        const double least = find_least(&w, 1, target - bound);
        if (least < target - bound)
            fail_cast(m, pair, row, "missed", least - target, -bound);
        return;
    }
    assert_int_equal(row->body, m->scene.pairs[pair].b);
    assert_true(fraction >= 0 && fraction <= 1);
    const double now = separation_at(&w, fraction);
    const narc_contact contact = {
        row->pair,     row->feature, 1, row->separation, row->normal_x, row->normal_y, row->point_x, row->point_y,
        row->radius_a, row->radius_b};
    const char *const wrong = check_contact(&w.a, &w.b, now, &contact, &summary->worst);
    if (wrong)
        fail_cast(m, pair, row, wrong, (double)row->separation, now);
    summary->at_start += fraction == 0;
    if (fraction == 0 && now < target) /* as deep as they were */
        return;
    const double smaller = fmin((double)m->scene.bodies[m->scene.pairs[pair].a].scale,
                                (double)m->scene.bodies[m->scene.pairs[pair].b].scale);
    const double usual = fmin(smaller * 4 / 1024, turning / 16 + bound);
    double tolerance = !turns(&w) ? bound : m->tolerance > 0 ? (double)m->tolerance : usual;
    if (row->count == NARC_CAST_HIT && now - target > bound + tolerance + rounding)
        fail_cast(m, pair, row, "not there", now - target, bound + tolerance);
    if (now - target < -1.5 * bound)
        fail_cast(m, pair, row, "too deep", now - target, -bound);
    const double least = find_least(&w, fraction, target - 1.5 * bound);
    if (least < target - 1.5 * bound)
        fail_cast(m, pair, row, "too late", least - target, -bound);
}

static void check_moving(const struct moving *m, struct summary *summary) {
    size_t skipped = 9;
    AUTO(guard_release_at) narc_impact *rows = cast_all(m, &skipped);
    assert_int_equal(skipped, 0);
    for (size_t k = 0; k < m->scene.pair_count; k++)
        check_row(m, k, &rows[k], summary);
}

static void print_summary(const char *name, const struct summary *t) {
    print_message("%s: %zu miss, %zu hit (%zu at once), %zu unfinished; of the bounds: separation %.2f, normal %.2f, "
                  "point %.2f\n",
                  name, t->outcomes[0], t->outcomes[1], t->at_start, t->outcomes[2], t->worst.separation,
                  t->worst.normal, t->worst.point);
}

/* ------------------------------------------------------------------------------------------------ what is cast */

/* A way to a place: its length is of the order of the size, or far longer; sometimes there is none. */
static narc_motion random_motion(struct test_random *random, double size, double turning) {
    const double angle = random_between(random, -4, 4);
    const double way = random_below(random, 8) == 0 ? 0 : size * random_log_between(random, 0.05, 60);
    double turn = random_below(random, 4) == 0 ? 0 : turning * random_between(random, -1, 1);
    return (narc_motion){(float)(way * cos(angle)), (float)(way * sin(angle)), (float)turn};
}

/* Moves a body back from where it is after a part of its motion. */
static void move_back(struct body *body, const narc_motion *motion, double time, narc_precision precision) {
    const double angle = atan2((double)body->sine, (double)body->cosine) - time * (double)motion->angle;
    body->x -= time * (double)motion->x;
    body->y -= time * (double)motion->y;
    if (motion->angle != 0) {
        body->cosine = (float)cos(angle);
        body->sine = (float)sin(angle);
    }
    round_position(body, precision);
}

/* Makes all bodies of a scene, two of each pair, move so that they are where they are now after some time. A third of
 * the ways are across the normal: they graze. */
static struct moving set_in_motion(struct test_random *random, struct scene scene, double turning) {
    struct moving m = {.scene = scene, .motion = calloc(scene.body_count, sizeof *m.motion)};
    assert_non_null(m.motion);
    for (size_t k = 0; k < scene.pair_count; k++) {
        const uint32_t two[2] = {scene.pairs[k].a, scene.pairs[k].b};
        const struct reference_body a = scene_reference(&scene, two[0]), b = scene_reference(&scene, two[1]);
        const double size = fmin(reference_extent(&a), reference_extent(&b));
        const double time = random_below(random, 4) ? random_unit(random) : (double)random_below(random, 3) / 2;
        for (int side = 0; side < 2; side++)
            m.motion[two[side]] = random_motion(random, size, turning);
        if (random_below(random, 3) == 0) {
            const struct reference_gap gap = reference_solve_gap(&a, &b);
            const double way = size * random_log_between(random, 0.05, 60);
            m.motion[two[0]].x = m.motion[two[0]].y = 0;
            m.motion[two[1]].x = (float)(-gap.normal_y * way);
            m.motion[two[1]].y = (float)(gap.normal_x * way);
        }
        for (int side = 0; side < 2; side++)
            move_back(&scene.bodies[two[side]], &m.motion[two[side]], time, scene.precision);
    }
    return m;
}

static void destroy_moving(struct moving *m) {
    free(m->motion);
    destroy_scene(&m->scene);
}

static enum family random_family(struct test_random *random) { return (enum family)random_below(random, FAMILY_COUNT); }

/* Two shapes of any families, in all places. */
static struct scene make_placed(struct test_random *random, narc_precision precision) {
    const enum family a = random_family(random), b = random_family(random);
    return make_placed_scene(random, precision, a, b, PLACE_COUNT * 4);
}

static struct scene make_hard(struct test_random *random, narc_precision precision) {
    struct scene scene = create_scene(precision, 2, HARD_BODIES, HARD_BODIES / 2);
    for (int side = 0; side < 2; side++) {
        const struct shape shape = make_hard_shape(random, (enum hard_family)random_below(random, HARD_COUNT));
        scene_add_shape(&scene, &shape);
    }
    add_hard_pairs(random, &scene, (enum hard_placement)random_below(random, HARD_PLACES), 0, 1);
    return scene;
}

static struct scene make_deep(struct test_random *random, narc_precision precision) {
    static const enum family families[] = {FAMILY_SMOOTH, FAMILY_LENS, FAMILY_THIN, FAMILY_UNEQUAL};
    struct scene scene = create_scene(precision, 2, 48, 24);
    for (int side = 0; side < 2; side++) {
        const struct shape shape = make_shape(random, families[random_below(random, 4)]);
        scene_add_shape(&scene, &shape);
    }
    for (int pair = 0; pair < 24; pair++)
        scene_add_placed(random, &scene, PLACE_DEEP, 0, 1);
    return scene;
}

/* Circles and others on arms: beside their positions, by up to four times their size. */
static struct scene make_arms(struct test_random *random, narc_precision precision) {
    struct scene scene = create_scene(precision, 2, 96, 48);
    for (size_t side = 0; side < 2; side++) {
        struct shape shape = random_below(random, 2) ? circle_of(1) : make_shape(random, random_family(random));
        const double arm = random_between(random, 0, 4);
        for (size_t arc = 0; arc < shape.count; arc++)
            shape.arcs[arc].center_x += arm;
        scene_add_shape(&scene, &shape);
    }
    for (size_t pair = 0; pair < 48; pair++)
        scene_add_placed(random, &scene, (enum placement)random_below(random, PLACE_COUNT), 0, 1);
    return scene;
}

/* `deepest`: targets are down to that; 0: a few. `unfinished`: at most this share of all. */
static void check_scenes(const char *name, struct scene (*make)(struct test_random *, narc_precision), double turning,
                         double deepest, size_t trials, double unfinished) {
    static const float targets[] = {0, 0, 0.05f, -0.05f, 1};
    struct test_random random = test_random_named(name);
    struct summary summary = {.at_start = 0};
    for (size_t k = 0; k < test_trials(trials); k++) {
        AUTO(destroy_moving) struct moving m = set_in_motion(&random, make(&random, (narc_precision)(k % 2)), turning);
        m.target =
            deepest > 0 ? (float)-random_log_between(&random, 0.005, deepest) : targets[random_below(&random, 5)];
        check_moving(&m, &summary);
    }
    print_summary(name, &summary);
    assert_true(test_trials(trials) < 5 || (summary.outcomes[0] > 0 && summary.outcomes[1] > 0));
    assert_true((double)summary.outcomes[2] <=
                (unfinished > 0) + unfinished * (double)(summary.outcomes[0] + summary.outcomes[1]));
}

TEST(test_lines) { check_scenes("lines", make_placed, 0, 0, 24, 0); }

TEST(test_turning) { check_scenes("turning", make_placed, 2, 0, 10, 0.001); }

TEST(test_full_turns) { check_scenes("full turns", make_placed, 14, 0, 6, 0.001); }

/* So fast that floats of time are a sixteenth of a radian apart, and more: what comes near has turned too often to tell. */
TEST(test_fast_turns) { check_scenes("fast turns", make_placed, 0x1p23, 0, 5, 0.5); }

TEST(test_hard_lines) { check_scenes("hard lines", make_hard, 0, 0, 20, 0); }

TEST(test_hard_turning) { check_scenes("hard turning", make_hard, 3, 0, 8, 0.01); }

/* Gaps bend as they may on the ways of arms: a step along their series that is too long misses what grazes. */
TEST(test_series_of_turning_gaps) { check_scenes("series of turning gaps", make_arms, 8, 0, 30, 0.001); }

/* So deep that the arcs which touch on the way are not those that touch at the target, or that it is never reached. */
TEST(test_deep_targets) { check_scenes("deep targets", make_deep, 0, 0.6, 60, 0); }

/* ------------------------------------------------------------------------------------------------ let go */

/* Bodies where they are placed, which part, slide, or come deeper, or any of it while they turn. */
static struct moving let_move(struct test_random *random, struct scene scene, double turning) {
    struct moving m = {.scene = scene, .motion = calloc(scene.body_count, sizeof *m.motion)};
    assert_non_null(m.motion);
    for (size_t k = 0; k < scene.pair_count; k++) {
        const uint32_t of = scene.pairs[k].a, to = scene.pairs[k].b;
        const struct reference_body a = scene_reference(&scene, of), b = scene_reference(&scene, to);
        const struct reference_gap gap = reference_solve_gap(&a, &b);
        const double size = fmin(reference_extent(&a), reference_extent(&b));
        m.motion[to] = random_motion(random, size, turning);
        if (random_below(random, 3) > 0) { /* along the normal, or across it */
            const double way =
                hypot((double)m.motion[to].x, (double)m.motion[to].y) * (random_below(random, 2) ? 1 : -1);
            const bool across = random_below(random, 2);
            m.motion[to].x = (float)(way * (across ? -gap.normal_y : gap.normal_x));
            m.motion[to].y = (float)(way * (across ? gap.normal_x : gap.normal_y));
        }
    }
    return m;
}

/* What became of those that were let go. */
struct let_go {
    size_t missed, deeper, again, lost; /* lost: they were clear, and hit at the start */
};

/* The largest separation up to a time at which it is `deep`. */
static double find_most(struct way *w, double end, double deep) {
    enum { SAMPLES = 400 };
    double most = -INFINITY;
    for (int k = 0; k <= SAMPLES; k++) {
        const double now = separation_at(w, end * k / SAMPLES);
        if (now <= deep)
            break;
        most = fmax(most, now);
    }
    return most;
}

static void check_let_go(const struct moving *m, size_t pair, const narc_impact *row, struct summary *summary,
                         struct let_go *out) {
    struct way w = find_way(m, pair);
    const double target = (double)m->target, fraction = (double)row->fraction, start = separation_at(&w, 0);
    const double bound = separation_bound(&w.a, &w.b), speed = hypot(w.motion_x, w.motion_y);
    const double turning = fabs(w.angle_a) * reference_extent(&w.a) + fabs(w.angle_b) * reference_extent(&w.b);
    const double tolerance = turns(&w) ? (double)m->tolerance : bound,
                 rounding = bound + 0x1p-23 * (speed + 3 * turning);
    if (start > target + tolerance + bound)
        check_row(m, pair, row, summary);
    if (start > target - bound)
        return;
    const double deep = start - (double)m->parting, deepest = deep - 2 * tolerance - 2 * rounding;
    if (row->count == NARC_CAST_MISS) {
        const double least = find_least(&w, 1, deepest);
        if (least < deepest)
            fail_cast(m, pair, row, "let go, and so deep", least - start, deepest - start);
        out->missed++;
    } else if (fraction == 0) {
        const double least = find_least(&w, 1, deep + rounding);
        if (least > deep + rounding)
            fail_cast(m, pair, row, "it comes no deeper", least - start, deep + rounding - start);
        assert_true(fabs((double)row->separation - start) <= bound);
        out->deeper++;
        out->lost += turns(&w) && find_most(&w, 1, deep) > target + 4 * tolerance + rounding;
    } else if (row->count == NARC_CAST_HIT) {
        const double now = separation_at(&w, fraction),
                     least = find_least(&w, fraction, fmin(deepest, target - rounding));
        if (!turns(&w) || now > target + tolerance + rounding || now < target - 1.5 * rounding || least < deepest)
            fail_cast(m, pair, row, "not again", now - target, tolerance);
        assert_true(find_most(&w, fraction, -INFINITY) > target);
        out->again++;
    }
}

static void check_letting_go(const char *name, double turning, struct let_go *out) {
    static const float targets[] = {0, 0, 0.05f, 1};
    struct test_random random = test_random_named(name);
    struct summary summary = {.at_start = 0};
    *out = (struct let_go){0};
    for (size_t k = 0; k < test_trials(turning > 0 ? 20 : 40); k++) {
        struct scene scene = k % 3 ? make_placed(&random, (narc_precision)(k % 2)) : make_deep(&random, NARC_FLOAT64);
        AUTO(destroy_moving) struct moving m = let_move(&random, scene, turning);
        m.target = targets[random_below(&random, 4)];
        m.tolerance = 0.001f;
        m.parting = (float)random_log_between(&random, 1e-3, 0.1);
        AUTO(guard_release_at) narc_impact *const rows = cast_all(&m, NULL);
        for (size_t pair = 0; pair < m.scene.pair_count; pair++)
            check_let_go(&m, pair, &rows[pair], &summary, out);
    }
    print_message("%s: %zu let go, %zu came deeper, %zu hit again, %zu unseen\n", name, out->missed, out->deeper,
                  out->again, out->lost);
    assert_true(out->missed > 0 && out->deeper > 0);
}

/* What touches or overlaps parts and slides, and hits only if it comes deeper, and then at once. */
TEST(test_letting_go) {
    struct let_go found;
    check_letting_go("letting go", 0, &found);
    assert_int_equal(found.again, 0);
}

/* With turning it may come clear, and hit again. */
TEST(test_letting_go_turning) {
    struct let_go found;
    check_letting_go("letting go, turning", 3, &found);
    assert_true(test_trials(20) < 10 || found.again > 0);
    assert_true(found.lost * 20 <= found.deeper + found.again);
}

/* The scene by a quarter turn: the same numbers in other places, to the last bit. */
TEST(test_quarter_turn) {
    struct test_random random = test_random_named("quarter turn");
    for (size_t k = 0; k < test_trials(60); k++) {
        AUTO(destroy_moving)
        struct moving m = set_in_motion(&random, make_placed(&random, NARC_FLOAT64), k % 2 ? 3 : 0);
        AUTO(guard_release_at) narc_impact *const rows = cast_all(&m, NULL);
        for (size_t b = 0; b < m.scene.body_count; b++) {
            struct body *const body = &m.scene.bodies[b];
            const struct body was = *body;
            const narc_motion motion = m.motion[b];
            body->x = -was.y;
            body->y = was.x;
            body->cosine = -was.sine;
            body->sine = was.cosine;
            m.motion[b] = (narc_motion){-motion.y, motion.x, motion.angle};
        }
        AUTO(guard_release_at) narc_impact *const turned = cast_all(&m, NULL);
        for (size_t pair = 0; pair < m.scene.pair_count; pair++) {
            const narc_impact *const a = &rows[pair], *const b = &turned[pair];
            assert_true(a->count == b->count && a->feature == b->feature && a->body == b->body);
            assert_true(a->fraction == b->fraction && a->separation == b->separation);
            assert_true(a->normal_x == b->normal_y && a->normal_y == -b->normal_x);
            assert_true(a->point_x == b->point_y && a->point_y == -b->point_x);
        }
    }
}

/* The default tolerance of thin bodies, 0.03 apart: they are not hit by a turn that does not bring them together, and are
 * by one that does, where they touch but for a part of their thickness. So from a turn of nothing to a whole one. */
TEST(test_thin_rods_that_turn) {
    static const double thick[] = {0.02, 1e-4, 0};
    for (size_t kind = 0; kind < 3; kind++) {
        struct scene scene = create_scene(NARC_FLOAT64, 1, 2, 1);
        struct shape rod = box_of(100, 1, 0);
        narc_error error;
        expect_ok(thick[kind] > 0 ? narc_build_box(100, thick[kind], 0, rod.arcs, &rod.count, &error)
                                  : narc_build_segment(&(narc_point){-50, 0}, &(narc_point){50, 0}, 0, rod.arcs,
                                                       &rod.count, &error),
                  &error);
        scene_add_shape(&scene, &rod);
        scene_add_two(&scene, (struct body){.cosine = 1, .scale = 1},
                      (struct body){.y = thick[kind] + 0.03, .cosine = 1, .scale = 1});
        AUTO(destroy_moving) struct moving m = {.scene = scene, .motion = calloc(2, sizeof *m.motion)};
        struct summary summary = {.at_start = 0};
        for (double turn = 1; turn > 1e-12; turn /= 3) {
            m.motion[1].angle = (float)turn;
            AUTO(guard_release_at) narc_impact *const row = cast_all(&m, NULL);
            check_row(&m, 0, row, &summary);
            assert_int_equal(row->count, sin(turn) * 50 > 0.03 ? NARC_CAST_HIT : NARC_CAST_MISS);
            assert_true(row->separation <= 1e-5f + (float)thick[kind] / 128);
        }
    }
}

/* A tolerance that is named holds, however large the other body is: boxes, capsules and discs that spin, against segments
 * and thin boxes of up to 4,000 times their size, told to come a little deeper than they are. So one that moves on does
 * not stand where it is. */
TEST(test_named_tolerances) {
    enum { PAIRS = 40 };
    struct test_random random = test_random_named("named tolerances");
    struct summary summary = {.at_start = 0};
    for (size_t k = 0; k < test_trials(40); k++) {
        struct scene scene = create_scene(NARC_FLOAT64, 2, 2 * PAIRS, PAIRS);
        const double half = random_log_between(&random, 1, 2000);
        struct shape wall = box_of(2 * half, 0.01, 0);
        const struct shape spinning[] = {box_of(0.3, 0.3, 0), box_of(0.6, 0.04, 0), capsule_of(0.6, 0.03),
                                         circle_of(0.1)};
        struct shape body = spinning[k % 4];
        narc_error error;
        if (k % 8 < 4)
            expect_ok(
                narc_build_segment(&(narc_point){-half, 0}, &(narc_point){half, 0}, 0, wall.arcs, &wall.count, &error),
                &error);
        if (k % 4 == 3)
            body.arcs[0].center_x = 0.05; /* else it is as if it did not turn */
        scene_add_shape(&scene, &wall);
        scene_add_shape(&scene, &body);
        AUTO(destroy_moving) struct moving m = {.scene = scene, .motion = calloc(2 * PAIRS, sizeof *m.motion)};
        m.target = -(float)random_log_between(&random, 1e-4, 0.01);
        m.tolerance = (float)random_log_between(&random, 1e-6, 1e-4);
        for (size_t pair = 0; pair < PAIRS; pair++) {
            struct body on = turned_body(pair % 4 ? random_between(&random, -4, 4) : 0, 1), wall_at = turned_body(0, 1);
            on.shape = 1;
            on.x = random_between(&random, -0.5, 0.5) * half;
            on.y = 0;
            scene_add_two(&m.scene, wall_at, on);
            const struct reference_body a = scene_reference(&m.scene, (uint32_t)(2 * pair));
            const double above = (double)m.target + (double)m.tolerance * random_log_between(&random, 1.5, 1000);
            struct body *const placed = &m.scene.bodies[2 * pair + 1];
            for (int step = 0; step < 60; step++) { /* up to where it is so deep */
                const struct reference_body b = scene_reference(&m.scene, (uint32_t)(2 * pair + 1));
                placed->y += above - reference_solve_gap(&a, &b).gap;
            }
            m.motion[2 * pair + 1] =
                (narc_motion){(float)random_between(&random, -1, 1), (float)random_between(&random, -1, 1),
                              (float)random_between(&random, -1.5, 1.5)};
        }
        AUTO(guard_release_at) narc_impact *const rows = cast_all(&m, NULL);
        for (size_t pair = 0; pair < PAIRS; pair++) {
            check_row(&m, pair, &rows[pair], &summary);
            const double most = (double)m.target + (double)m.tolerance + 1e-6;
            if (rows[pair].count == NARC_CAST_HIT && (double)rows[pair].separation > most)
                fail_cast(&m, pair, &rows[pair], "not so near", (double)rows[pair].separation, most);
        }
    }
    print_summary("named tolerances", &summary);
    assert_true(summary.outcomes[NARC_CAST_HIT] > 0 && summary.outcomes[NARC_CAST_UNFINISHED] == 0);
}

/* With next to no turn a cast is the straight one's: what becomes of it, and when, but for what turning moves. */
TEST(test_small_turns) {
    struct test_random random = test_random_named("small turns");
    size_t hits = 0, others = 0;
    for (size_t k = 0; k < test_trials(40); k++) {
        AUTO(destroy_moving) struct moving m = set_in_motion(&random, make_placed(&random, (narc_precision)(k % 2)), 0);
        struct summary summary = {.at_start = 0};
        AUTO(guard_release_at) narc_impact *const straight = cast_all(&m, NULL);
        for (size_t b = 0; b < m.scene.body_count; b++)
            m.motion[b].angle = (float)(random_between(&random, -1, 1) * random_log_between(&random, 1e-30, 1e-8));
        AUTO(guard_release_at) narc_impact *const turning = cast_all(&m, NULL);
        for (size_t pair = 0; pair < m.scene.pair_count; pair++) {
            const narc_impact *const a = &straight[pair], *const b = &turning[pair];
            struct way w = find_way(&m, pair);
            check_row(&m, pair, b, &summary);
            go_to(&w, 0);
            const double bound = separation_bound(&w.a, &w.b) + 0x1p-23 * hypot(w.motion_x, w.motion_y);
            if (a->count == b->count && (a->count == NARC_CAST_MISS || separation_at(&w, (double)a->fraction) < 0))
                continue;
            others += a->count != b->count;
            if (a->count == b->count)
                assert_true(fabs(separation_at(&w, (double)a->fraction) - separation_at(&w, (double)b->fraction)) <=
                            2 * bound);
            hits += a->count == NARC_CAST_HIT && b->count == NARC_CAST_HIT && b->fraction > 0;
        }
    }
    print_message("%zu hits, %zu that only one of both makes\n", hits, others);
    assert_true(hits > 0 && 20 * others <= hits);
}

/* A box that slides along a row of tiles, on them up to rounding, against the next one: it is hit, or not, but never
 * between two faces. */
TEST(test_along_tiles) {
    enum { PAIRS = 400 };
    struct test_random random = test_random_named("along tiles");
    struct scene scene = create_scene(NARC_FLOAT64, 2, 2 * PAIRS, PAIRS);
    const struct shape tile = box_of(2, 1, 0), box = box_of(0.75, 0.5, 0);
    struct summary summary = {.at_start = 0};
    scene_add_shape(&scene, &tile);
    scene_add_shape(&scene, &box);
    AUTO(destroy_moving) struct moving m = {.scene = scene, .motion = calloc(2 * PAIRS, sizeof *m.motion)};
    double angle[PAIRS];
    for (size_t pair = 0; pair < PAIRS; pair++) {
        angle[pair] = pair % 4 ? random_between(&random, -4, 4) : 0;
        const double c = cos(angle[pair]), s = sin(angle[pair]), way = random_between(&random, 0.5, 8);
        const double x = -1.375 - random_between(&random, 0.01, 0.4), y = 0.75 + random_between(&random, -2e-7, 2e-7);
        struct body on = turned_body(angle[pair], 1), next = on;
        next.x = random_between(&random, -20, 20);
        next.y = random_between(&random, -20, 20);
        on.x = next.x + c * x - s * y;
        on.y = next.y + s * x + c * y;
        on.shape = 1;
        m.motion[2 * pair] = (narc_motion){(float)(c * way), (float)(s * way), 0};
        scene_add_two(&m.scene, on, next);
    }
    AUTO(guard_release_at) narc_impact *const rows = cast_all(&m, NULL);
    for (size_t pair = 0; pair < PAIRS; pair++) {
        const double c = cos(angle[pair]), s = sin(angle[pair]);
        const double n_x = (double)rows[pair].normal_x, n_y = (double)rows[pair].normal_y;
        check_row(&m, pair, &rows[pair], &summary);
        assert_true(rows[pair].count != NARC_CAST_HIT || fmin(fabs(c * n_x + s * n_y), fabs(c * n_y - s * n_x)) < 1e-6);
    }
    print_summary("along tiles", &summary);
    assert_true(summary.outcomes[NARC_CAST_HIT] > PAIRS / 3);
}

/* Boxes of 2 by 1 on a lattice, one of them by a quarter turn, whose times are exact: also where they meet at the very end,
 * slide along each other, or pass corner to corner, which counts. */
TEST(test_boxes_on_a_lattice) {
    enum { PAIRS = 1000 };
    static const float steps[] = {0, 0.5f, 1, 2, 4, -0.5f, -1, -2, -4};
    struct test_random random = test_random_named("boxes on a lattice");
    struct scene scene = create_scene(NARC_FLOAT64, 1, 2 * PAIRS, PAIRS);
    const struct shape box = box_of(2, 1, 0);
    AUTO(destroy_moving) struct moving m = {.scene = scene, .motion = calloc(2 * PAIRS, sizeof *m.motion)};
    size_t last = 0, along = 0;
    scene_add_shape(&m.scene, &box);
    for (size_t pair = 0; pair < PAIRS; pair++) {
        const struct body a = {.cosine = 1, .scale = 1};
        const struct body b = {.x = (double)random_below(&random, 17) / 2 - 4,
                               .y = (double)random_below(&random, 17) / 2 - 4,
                               .sine = 1,
                               .scale = 1};
        m.motion[2 * pair + 1] = (narc_motion){steps[random_below(&random, 9)], steps[random_below(&random, 9)], 0};
        scene_add_two(&m.scene, a, b);
    }
    AUTO(guard_release_at) narc_impact *const rows = cast_all(&m, NULL);
    for (size_t pair = 0; pair < PAIRS; pair++) {
        const struct body *const b = &m.scene.bodies[2 * pair + 1];
        const narc_motion *const motion = &m.motion[2 * pair + 1];
        const double way[] = {b->x, b->y}, by[] = {(double)motion->x, (double)motion->y};
        double from = 0, to = 1;
        for (int k = 0; k < 2; k++) {
            if (by[k] == 0 && fabs(way[k]) > 1.5)
                to = -1;
            if (by[k] != 0) {
                from = fmax(from, (-1.5 - copysign(way[k], way[k] * by[k])) / fabs(by[k]));
                to = fmin(to, (1.5 - copysign(way[k], way[k] * by[k])) / fabs(by[k]));
            }
        }
        assert_int_equal(rows[pair].count, from <= to ? NARC_CAST_HIT : NARC_CAST_MISS);
        assert_true(from > to || (double)rows[pair].fraction == from);
        last += from <= to && from == 1;
        along += from <= to && (from == to || fabs(way[0]) == 1.5 || fabs(way[1]) == 1.5);
    }
    assert_true(last > 0 && along > 0);
}

/* A circle about its position that turns is one that does not, to the bit, whatever its radius and the other body. */
TEST(test_circles_that_turn) {
    enum { PAIRS = 64 };
    struct test_random random = test_random_named("circles that turn");
    size_t hits = 0;
    for (size_t k = 0; k < test_trials(60); k++) {
        struct scene scene = create_scene((narc_precision)(k % 2), 2, 2 * PAIRS, PAIRS);
        const struct shape circle = circle_of(random_log_between(&random, 0.3, 3));
        const struct shape other = k % 3 ? make_shape(&random, random_family(&random)) : circle;
        scene_add_shape(&scene, k % 4 < 2 ? &circle : &other);
        scene_add_shape(&scene, k % 4 < 2 ? &other : &circle);
        for (int pair = 0; pair < PAIRS; pair++)
            scene_add_placed(&random, &scene, (enum placement)random_below(&random, PLACE_COUNT), 0, 1);
        AUTO(destroy_moving) struct moving m = set_in_motion(&random, scene, k % 2 ? 2 : 0);
        const int of = k % 4 < 2 ? 0 : 1;
        for (size_t pair = 0; pair < scene.pair_count; pair++)
            m.motion[of ? scene.pairs[pair].b : scene.pairs[pair].a].angle = (float)random_between(&random, -7, 7);
        AUTO(guard_release_at) narc_impact *const turning = cast_all(&m, NULL);
        struct summary summary = {.at_start = 0};
        for (size_t pair = 0; pair < scene.pair_count; pair++)
            check_row(&m, pair, &turning[pair], &summary);
        for (size_t pair = 0; pair < scene.pair_count; pair++)
            m.motion[of ? scene.pairs[pair].b : scene.pairs[pair].a].angle = 0;
        AUTO(guard_release_at) narc_impact *const straight = cast_all(&m, NULL);
        for (size_t pair = 0; pair < scene.pair_count; pair++) {
            assert_memory_equal(&turning[pair], &straight[pair], sizeof *straight);
            hits += straight[pair].count == NARC_CAST_HIT && straight[pair].fraction > 0;
        }
    }
    assert_true(test_trials(60) < 10 || hits > 0);
}

/* Rows do not depend on who numbers bodies: in rows of floats and of doubles, as pairs' own bodies, and as two sets, with
 * shifts and without. */
TEST(test_sets_of_bodies) {
    struct test_random random = test_random_named("sets of bodies");
    for (size_t k = 0; k < 2 * test_trials(4); k++) {
        struct scene scene = make_placed_scene(&random, (narc_precision)(k % 2), random_family(&random),
                                               random_family(&random), PLACE_COUNT * 3);
        AUTO(destroy_moving) struct moving m = set_in_motion(&random, scene, k % 3 ? 3 : 0);
        const size_t count = m.scene.pair_count, body_count = m.scene.body_count;
        struct narrow {
            float x, y, cosine, sine;
        } *const rows = guard_allocate(body_count * sizeof *rows);
        AUTO(guard_release_at) narc_body *const wide = guard_allocate(body_count * sizeof *wide);
        AUTO(guard_release_at) float *const shift = guard_allocate(count * sizeof *shift);
        AUTO(guard_release_at) narc_impact *const expected = guard_allocate(count * sizeof *expected);
        AUTO(guard_release_at) narc_impact *const found = guard_allocate(count * sizeof *found);
        for (uint32_t b = 0; b < body_count; b++) {
            const struct body *const body = &m.scene.bodies[b];
            wide[b] = scene_body(&m.scene, b);
            rows[b] = (struct narrow){body->x_single, body->y_single, body->cosine, body->sine};
        }
        for (size_t pair = 0; pair < count; pair++)
            shift[pair] = (float)random_between(&random, -1, 1);
        narc_bodies narrow = scene_bodies(&m.scene);
        if (k % 2 == NARC_FLOAT32) {
            narrow.x = NARC_POSITION_COLUMN(rows, x);
            narrow.y = NARC_POSITION_COLUMN(rows, y);
            narrow.cosine = NARC_COLUMN(rows, cosine);
            narrow.sine = NARC_COLUMN(rows, sine);
        }
        narc_bodies sets[] = {scene_bodies(&m.scene), {0}, narrow};
        narc_view_bodies(wide, body_count, &sets[1]);
        const narc_motions motions = view_motions(m.motion);
        for (int way = 0; way < 2 * 3 * 3; way++) {
            const narc_bodies *const bodies = &sets[way % 3], *const others = &sets[(way + 1) % 3];
            const int numbers = way / 3 % 3; /* their pairs', of two sets, their own */
            narc_pairs pairs = numbers == 2 ? (narc_pairs){.count = count} : scene_pairs(&m.scene);
            pairs.other_bodies = numbers == 1 ? others : NULL;
            if (way >= 9)
                pairs.shift_x = pairs.shift_y = (narc_float_column){shift, sizeof *shift};
            narc_error error;
            expect_ok(narc_cast_pairs(m.scene.store, bodies, &motions, &pairs, numbers == 1 ? &motions : NULL, NULL,
                                      way % 9 ? found : expected, count, &error),
                      &error);
            if (way % 9)
                assert_memory_equal(found, expected, count * sizeof *found);
        }
        guard_release(rows);
    }
}

TEST_MAIN("casts")
