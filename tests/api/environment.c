/* SPDX-License-Identifier: MIT
 *
 * environment.c - choosing an instruction set by name and by NARC_ISA, and what the library tells of itself.
 *
 * NARC_ISA is read at the first call of a process, so each case runs in a child of its own; the parent makes no batch
 * call.
 */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_contacts.h"
#include "narc_scene.h"
#include "support.h"

/* In a child: ends it, and the parent's test fails, if `condition` is false. */
#define REQUIRE(condition)                                                                                             \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);                                            \
            _exit(1);                                                                                                  \
        }                                                                                                              \
    } while (0)

static void run_child(const char *narc_isa, void (*body)(void)) {
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        if (narc_isa)
            setenv("NARC_ISA", narc_isa, 1);
        else
            unsetenv("NARC_ISA");
        body();
        exit(0); /* not _exit(): what the child ran counts for coverage */
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

/* One circle on itself: the smallest batch with an answer. */
struct tiny_batch {
    narc_shapes *shapes;
    narc_bodies bodies;
    narc_pairs pairs;
};

static struct tiny_batch make_batch(void) {
    static const narc_body body = {.cosine = 1, .scale = 1};
    static const uint32_t first = 0;
    struct tiny_batch batch = {.pairs = {.count = 1, .a = {&first, 0}, .b = {&first, 0}}};
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_view_bodies(&body, 1, &batch.bodies);
    REQUIRE(narc_create_shapes(NULL, &batch.shapes) == NARC_OK);
    REQUIRE(narc_build_circle(1, arcs, &count, NULL) == NARC_OK);
    REQUIRE(narc_add_shape(batch.shapes, arcs, count, NULL, NULL) == NARC_OK);
    return batch;
}

static void require_error(narc_status expected, const char *name) {
    struct tiny_batch batch = make_batch();
    uint64_t bits = 42;
    float angle = 1, cosine = 42, sine = 42;
    size_t count = 42;
    narc_contact row = {.separation = 42};
    narc_error error = {0};
    REQUIRE(narc_find_overlaps(batch.shapes, &batch.bodies, &batch.pairs, NULL, &bits, &error) == expected);
    REQUIRE(error.status == expected && strstr(error.message, name));
    REQUIRE(narc_find_contacts(batch.shapes, &batch.bodies, &batch.pairs, NULL, &row, 1, &count, NULL) == expected);
    REQUIRE(narc_compute_poses(&angle, 1, &cosine, &sine, NULL) == expected);
    REQUIRE(bits == 42 && row.separation == 42 && count == 42 && cosine == 42 && sine == 42);
    REQUIRE(narc_get_isa() == NULL);
    /* The program's own word still counts. */
    REQUIRE(narc_set_isa("scalar", NULL) == NARC_OK);
    REQUIRE(strcmp(narc_get_isa(), "scalar") == 0);
    REQUIRE(narc_find_overlaps(batch.shapes, &batch.bodies, &batch.pairs, NULL, &bits, NULL) == NARC_OK && bits == 1);
    narc_destroy_shapes(batch.shapes);
}

static void unknown_isa(void) { require_error(NARC_ERROR_ISA_UNKNOWN, "sse9"); }

TEST(test_unknown) { run_child("sse9", unknown_isa); }

static const char *unsupported_name(void) {
    for (size_t k = 0; narc_isa_name(k); k++)
        if (!narc_isa_supported(narc_isa_name(k)))
            return narc_isa_name(k);
    return NULL;
}

/* All calls that compute anything, one after the other: none chooses an instruction set. */
static void all_calls_unknown(void) {
    const struct tiny_batch batch = make_batch();
    const narc_shapes *const shapes = batch.shapes;
    const narc_bodies *const bodies = &batch.bodies;
    const narc_status unknown = NARC_ERROR_ISA_UNKNOWN;
    const float zero = 0, angle = 1;
    const narc_motions motions = {.x = NARC_ARRAY(&zero), .y = NARC_ARRAY(&zero)};
    const narc_position_column place = NARC_POSITION_ARRAY(&zero);
    const narc_points points = {.count = 1, .x = place, .y = place};
    const narc_rays rays = {
        .count = 1, .x = place, .y = place, .motion_x = NARC_ARRAY(&angle), .motion_y = NARC_ARRAY(&zero)};
    const narc_step step = {.bodies = bodies};
    const narc_step_result *r;
    AUTO(narc_destroy_contacts_at) narc_contacts *contacts;
    AUTO(narc_destroy_broad_phase_at) narc_broad_phase *broad;
    AUTO(narc_destroy_index_at) narc_index *index;
    narc_box box = {0, 0, 1, 1};
    narc_pairs pairs;
    narc_contact contact;
    narc_manifold manifold;
    narc_impact impact;
    narc_distance distance;
    narc_ray_hit hit;
    uint64_t bits;
    uint32_t a, b;
    float cosine, sine;
    size_t count;
    REQUIRE(narc_create_broad_phase(NULL, &broad) == NARC_OK && narc_create_index(NULL, &index) == NARC_OK &&
            narc_create_contacts(NULL, &contacts, NULL) == NARC_OK);
    REQUIRE(narc_find_overlaps(shapes, bodies, &batch.pairs, NULL, &bits, NULL) == unknown);
    REQUIRE(narc_find_contacts(shapes, bodies, &batch.pairs, NULL, &contact, 1, &count, NULL) == unknown);
    REQUIRE(narc_find_manifolds(shapes, bodies, &batch.pairs, NULL, &manifold, 1, &count, NULL) == unknown);
    REQUIRE(narc_compute_poses(&angle, 1, &cosine, &sine, NULL) == unknown);
    REQUIRE(narc_compute_boxes(shapes, bodies, NULL, &box, NULL) == unknown);
    REQUIRE(narc_find_pairs(broad, &box, 1, NULL, NULL, &a, &b, 0, 1, &count, NULL) == unknown);
    REQUIRE(narc_update_contacts(contacts, shapes, &step, &r, NULL) == unknown);
    REQUIRE(narc_build_index(index, &box, 1, NULL, NULL) == unknown);
    REQUIRE(narc_update_index(index, &box, 0, NULL, 0, NULL, NULL) == unknown); /* it has no bodies yet */
    REQUIRE(narc_query_index(index, &box, 1, NULL, &pairs, NULL) == unknown);
    REQUIRE(narc_cast_pairs(shapes, bodies, &motions, &batch.pairs, NULL, NULL, &impact, 1, NULL) == unknown);
    REQUIRE(narc_find_distances(shapes, bodies, &points, NULL, NULL, &distance, NULL) == unknown);
    REQUIRE(narc_find_inside(shapes, bodies, &points, NULL, NULL, &bits, NULL) == unknown);
    REQUIRE(narc_cast_ray_pairs(shapes, bodies, &rays, NULL, NULL, &hit, 1, NULL) == unknown);
    const narc_bodies none = {.count = 0}; /* as many as the index has */
    REQUIRE(narc_cast_rays(index, shapes, &none, &rays, NULL, &hit, 1, NULL) == unknown);
    REQUIRE(narc_cast_shapes(index, shapes, &none, bodies, &motions, NULL, NULL, &impact, 1, NULL) == unknown);
    REQUIRE(narc_find_nearest(index, shapes, &none, &points, NULL, &distance, 1, NULL) == unknown);
    REQUIRE(narc_get_isa() == NULL);
    narc_destroy_shapes(batch.shapes);
}

TEST(test_all_calls_unknown) { run_child("sse9", all_calls_unknown); }

static void unsupported_isa(void) { require_error(NARC_ERROR_ISA_UNSUPPORTED, unsupported_name()); }

/* No processor has both NEON and AVX. */
TEST(test_unsupported) {
    assert_non_null(unsupported_name());
    run_child(unsupported_name(), unsupported_isa);
}

static void supported_isa(void) {
    struct tiny_batch batch = make_batch();
    uint64_t bits = 42;
    REQUIRE(narc_find_overlaps(batch.shapes, &batch.bodies, &batch.pairs, NULL, &bits, NULL) == NARC_OK && bits == 1);
    REQUIRE(strcmp(narc_get_isa(), getenv("NARC_ISA")) == 0);
    narc_destroy_shapes(batch.shapes);
}

TEST(test_supported) {
    for (size_t k = 0; narc_isa_name(k); k++)
        if (narc_isa_supported(narc_isa_name(k)))
            run_child(narc_isa_name(k), supported_isa);
}

/* Without a wish: the first of the list that is supported. */
static void best_isa(void) {
    size_t best = 0;
    while (!narc_isa_supported(narc_isa_name(best)))
        best++;
    REQUIRE(strcmp(narc_get_isa(), narc_isa_name(best)) == 0);
    REQUIRE(narc_set_isa("scalar", NULL) == NARC_OK);
    REQUIRE(narc_set_isa(NULL, NULL) == NARC_OK);
    REQUIRE(strcmp(narc_get_isa(), narc_isa_name(best)) == 0);
}

TEST(test_best) { run_child(NULL, best_isa); }

/* A choice that fails leaves the one before. */
static void set_isa(void) {
    narc_error error = {0};
    REQUIRE(narc_set_isa("scalar", NULL) == NARC_OK);
    REQUIRE(narc_set_isa("SCALAR", &error) == NARC_ERROR_ISA_UNKNOWN);
    REQUIRE(error.status == NARC_ERROR_ISA_UNKNOWN && strstr(error.message, "SCALAR"));
    REQUIRE(narc_set_isa("", NULL) == NARC_ERROR_ISA_UNKNOWN);
    REQUIRE(narc_set_isa("a\xff\n\xc3", &error) == NARC_ERROR_ISA_UNKNOWN && strstr(error.message, "'a\?\?\?'"));
    REQUIRE(narc_set_isa(unsupported_name(), &error) == NARC_ERROR_ISA_UNSUPPORTED);
    REQUIRE(error.status == NARC_ERROR_ISA_UNSUPPORTED && strstr(error.message, unsupported_name()));
    REQUIRE(strcmp(narc_get_isa(), "scalar") == 0);
    for (size_t k = 0; narc_isa_name(k); k++) {
        narc_status status = narc_set_isa(narc_isa_name(k), NULL);
        REQUIRE(status == (narc_isa_supported(narc_isa_name(k)) ? NARC_OK : NARC_ERROR_ISA_UNSUPPORTED));
        char other[32]; /* all but the first letter, or one behind the last: no name ends or goes on like that */
        REQUIRE(narc_set_isa(narc_isa_name(k) + 1, NULL) == NARC_ERROR_ISA_UNKNOWN);
        snprintf(other, sizeof other, "%s ", narc_isa_name(k));
        REQUIRE(narc_set_isa(other, NULL) == NARC_ERROR_ISA_UNKNOWN);
    }
}

TEST(test_set_isa) { run_child(NULL, set_isa); }

static bool has_feature(const char *name) {
    for (size_t k = 0; narc_cpu_feature(k); k++)
        if (strcmp(narc_cpu_feature(k), name) == 0)
            return true;
    return false;
}

/* As the compiler's own library finds them. */
TEST(test_features) {
#if defined(__x86_64__) || defined(__i386__)
    assert_int_equal(has_feature("sse4.1"), __builtin_cpu_supports("sse4.1") != 0);
    assert_int_equal(has_feature("popcnt"), __builtin_cpu_supports("popcnt") != 0);
    assert_int_equal(has_feature("avx2"), __builtin_cpu_supports("avx2") != 0);
    assert_int_equal(has_feature("avx512f"), __builtin_cpu_supports("avx512f") != 0);
    assert_int_equal(has_feature("avx512dq"), __builtin_cpu_supports("avx512dq") != 0);
    assert_int_equal(has_feature("avx512bw"), __builtin_cpu_supports("avx512bw") != 0);
    assert_int_equal(has_feature("avx512vl"), __builtin_cpu_supports("avx512vl") != 0);
#elif defined(__aarch64__)
    assert_true(has_feature("neon"));
#endif
    assert_null(narc_cpu_feature(SIZE_MAX));
}

TEST(test_names) {
    char version[32];
    snprintf(version, sizeof(version), "%d.%d.%d", NARC_VERSION_MAJOR, NARC_VERSION_MINOR, NARC_VERSION_PATCH);
    assert_string_equal(narc_version(), version);
    static const char *const names[] = {
#define NARC_ISA(name, needs, processors, flags) #name,
#include "isa.def"
    };
    const size_t count = sizeof names / sizeof *names;
    narc_error error;
    assert_int_equal(narc_set_isa("sse9", &error), NARC_ERROR_ISA_UNKNOWN);
    for (size_t k = 0; k < count; k++) {
        assert_string_equal(narc_isa_name(k), names[k]);
        assert_non_null(strstr(error.message, names[k]));
    }
    assert_string_equal(names[count - 1], "scalar"); /* which is there whatever else is not */
    assert_null(narc_isa_name(count));
    assert_null(narc_isa_name(SIZE_MAX));
    assert_true(narc_isa_supported("scalar"));
    assert_false(narc_isa_supported("sse9"));
    assert_false(narc_isa_supported(NULL));
    static const char *const kernels[] = {
#define NARC_SMALL                          0
#define NARC_KERNEL(type, name, parameters) #name,
#include "kernels.def"
    };
    const size_t kernel_count = sizeof kernels / sizeof *kernels;
    for (size_t k = 0; k < kernel_count; k++)
        assert_string_equal(narc_kernel_name(k), kernels[k]);
    assert_null(narc_kernel_name(kernel_count));
    assert_null(narc_kernel_name(SIZE_MAX));
    const narc_workers workers = openmp_workers(0);
    assert_true(workers.count >= 1);
    assert_string_equal(narc_status_name(NARC_OK), "NARC_OK");
    assert_string_equal(narc_status_name(NARC_ERROR_ISA_UNSUPPORTED), "NARC_ERROR_ISA_UNSUPPORTED");
    assert_string_equal(narc_status_name((narc_status)999), "unknown status");
}

int main(void) { return test_run("environment", NULL, NULL); }
