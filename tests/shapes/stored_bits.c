/* SPDX-License-Identifier: MIT
 *
 * stored_bits.c - the bits of what builders make and the store keeps, recorded: the same with every C library, compiler
 * and processor.
 *
 * The builders' inputs come from whole numbers, sums, products and quotients alone.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "elementary.h"
#include "narc_chains.h"
#include "store.h"
#include "support.h"

enum builder {
    CIRCLE,
    CAPSULE,
    BOX,
    POLYGON,
    REGULAR,
    FOUR_ARC,
    POINTS,
    RADIUS,
    RING,
    ELLIPSE,
    SEGMENT,
    SKIN,
    BUILDERS
};

static const char *const names[BUILDERS] = {
    "circle", "capsule",           "box",  "polygon", "regular polygon", "four-arc",
    "points", "points and radius", "ring", "ellipse", "segment",         "skin"};
static const uint64_t golden[BUILDERS] = {0x32d0c1d12682ffe7u, 0xf4aed7aa5f4410f0u, 0xbfb41d8dd9361945u,
                                          0xef160edd6bca8261u, 0x1dff18254f1a94afu, 0xadbbe1add4299e8bu,
                                          0xd0f1731352af5e2au, 0x5690721c9ea0ac2du, 0x5bac51c76593e09fu,
                                          0xe97510eea0c5314bu, 0x9ac4c379d5d78aa0u, 0xfd08ff1c66c383c0u};

static const uint64_t golden_unions = 0x07e27e56f1e0d697u, golden_chains = 0x8e62fd504576384du;

/* Of each builder. An ellipse takes much longer than the others. */
static size_t shapes_of(enum builder builder) { return builder == ELLIPSE ? 8 : 100; }

/* Corners of a convex polygon: on the unit circle, at ((1 - t^2) / (1 + t^2), 2 t / (1 + t^2)) turned by quarter turns,
 * then stretched and moved. */
static void place_corners(struct test_random *random, size_t count, narc_point *out_points) {
    const double across = random_between(random, 0.25, 4), up = random_between(random, 0.25, 4);
    const double x = random_between(random, -2, 2), y = random_between(random, -2, 2);
    for (size_t i = 0; i < count; i++) {
        const double turn = ((double)i + random_between(random, 0.1, 0.9)) * 4 / (double)count;
        const int quarter = (int)turn;
        const double t = turn - quarter, c = (1 - t * t) / (1 + t * t), s = 2 * t / (1 + t * t);
        const double turned_c = quarter % 2 ? -s : c, turned_s = quarter % 2 ? c : s;
        out_points[i].x = x + across * (quarter / 2 ? -turned_c : turned_c);
        out_points[i].y = y + up * (quarter / 2 ? -turned_s : turned_s);
    }
}

/* The k-th shape of a builder. */
static narc_status build(enum builder builder, struct test_random *random, size_t k, narc_arc *out_arcs,
                         size_t *out_count) {
    narc_point corners[NARC_MAX_ARCS], points[NARC_MAX_ARCS];
    const double a = random_between(random, 0.125, 8), b = random_between(random, 0.125, 8), part = random_unit(random);
    const size_t count = 3 + random_below(random, k % 4 ? 8 : 30);
    const double radius = k % 2 ? part * (a < b ? a : b) / 2 : 0;
    double least, most, chosen;
    place_corners(random, count, corners);
    switch (builder) {
    case CIRCLE:
        return narc_build_circle(a, out_arcs, out_count, NULL);
    case CAPSULE:
        return narc_build_capsule(a, b, out_arcs, out_count, NULL);
    case BOX:
        return narc_build_box(a, b, radius, out_arcs, out_count, NULL);
    case POLYGON:
        return narc_build_polygon(corners, count, radius / (double)(count * count), out_arcs, out_count, NULL);
    case REGULAR:
        return narc_build_regular_polygon(count, a, k % 2 ? part * a / 4 : 0, out_arcs, out_count, NULL);
    case FOUR_ARC: {
        const double distance = a + b - part * (a < b ? a : b), tip = k % 2 ? (a + b - distance) / 8 : 0;
        return narc_build_four_arc(&(narc_four_arc){a, b, distance, tip, tip / 2}, out_arcs, out_count, NULL);
    }
    case POINTS:
    case RADIUS: {
        narc_status status = narc_adjust_polygon(corners, count, points, NULL);
        if (status == NARC_OK)
            status = narc_find_radius_range(points, count, &least, &most, &chosen, NULL);
        if (status != NARC_OK || builder == POINTS)
            return status == NARC_OK ? narc_build_points(points, count, 0, out_arcs, out_count, NULL) : status;
        return narc_build_points(points, count, least + (chosen - least) * part, out_arcs, out_count, NULL);
    }
    case RING:
        return narc_build_ring(corners, count, out_arcs, out_count, NULL);
    case SEGMENT:
        return narc_build_segment(&corners[0], &corners[1], radius, out_arcs, out_count, NULL);
    case SKIN:
        return narc_build_skin_polygon(corners, count, part, out_arcs, out_count, NULL);
    default:
        return narc_build_ellipse(a, b, 4 * (1 + k % 8), out_arcs, out_count, NULL, NULL);
    }
}

static uint64_t hash_double(uint64_t hash, double value) { return test_hash_items(hash, &value, 1, sizeof value); }

/* All that the store keeps of its last shape. */
static uint64_t hash_stored(uint64_t hash, const narc_shapes *shapes) {
    const narc_shape_header *const header = &shapes->headers[shapes->count - 1];
    const narc_record *const records = &shapes->records[header->first_record];
    const size_t angles = narc_angle_records(header->count);
    const uint8_t bytes[] = {header->count, header->first_arc, header->flags, header->extent_ratio};
    hash = test_hash(hash, bytes, sizeof bytes);
    hash = test_hash_items(hash, &header->bound_x, 6, sizeof(float));
    hash = test_hash_items(hash, records, angles * NARC_RECORD_ANGLES, sizeof(int16_t));
    return test_hash_items(hash, &records[angles], (narc_count_records(header) - angles) * 8, sizeof(float));
}

/* What is told of a list of arcs and of the stored shape. */
static uint64_t hash_derived(uint64_t hash, const narc_shapes *shapes, const narc_arc *arcs, size_t count) {
    narc_arc stored[NARC_MAX_ARCS];
    narc_mass mass;
    narc_aabb box;
    narc_point point;
    double perimeter = 0;
    assert_true(narc_compute_mass(arcs, count, &mass) && narc_compute_perimeter(arcs, count, &perimeter) &&
                narc_compute_aabb(arcs, count, 0.7, &box) && narc_find_support(arcs, count, 1, 2, &point, NULL));
    hash = hash_double(hash_double(hash, mass.second_moment), perimeter);
    hash = hash_double(hash_double(hash_double(hash, box.max_x), point.x), point.y);
    const size_t stored_count = narc_get_arcs(shapes, (uint32_t)narc_count_shapes(shapes) - 1, stored);
    return test_hash_items(hash, stored, stored_count * 5, sizeof(double));
}

TEST(test_builders) {
    bool same = true;
    for (enum builder builder = 0; builder < BUILDERS; builder++) {
        struct test_random random = {builder < SEGMENT ? builder : builder + 2}; /* not of NARC_TEST_SEED */
        uint64_t hash = TEST_HASH_START;
        size_t built = 0;
        AUTO(narc_destroy_shapes_at) narc_shapes *shapes;
        assert_int_equal(narc_create_shapes(NULL, &shapes), NARC_OK);
        for (size_t k = 0; k < shapes_of(builder); k++) {
            narc_arc arcs[NARC_MAX_ARCS];
            size_t count = 0;
            narc_status status = build(builder, &random, k, arcs, &count);
            if (status == NARC_OK && k % 3 == 1)
                status = narc_center_arcs(arcs, count, arcs, NULL, NULL);
            if (status == NARC_OK && k % 3 == 2)
                status = narc_mirror_arcs(arcs, count, arcs, NULL);
            if (status == NARC_OK)
                status = narc_add_shape(shapes, arcs, count, NULL, NULL);
            hash = hash_double(hash, status);
            if (status != NARC_OK)
                continue;
            built++;
            hash = hash_stored(test_hash_items(hash, arcs, count * 5, sizeof(double)), shapes);
            hash = hash_derived(hash, shapes, arcs, count);
        }
        printf("  %s: %zu of %zu, 0x%016" PRIx64 "\n", names[builder], built, shapes_of(builder), hash);
        assert_true(built > shapes_of(builder) * 3 / 4);
        same = same && hash == golden[builder];
    }
    assert_true(same);
}

/* Compounds of a few shapes over each other. */
TEST(test_unions) {
    struct test_random random = {10};
    uint64_t hash = TEST_HASH_START;
    for (size_t k = 0; k < 60; k++) {
        narc_arc arcs[4 * NARC_MAX_ARCS];
        size_t counts[4], used = 0, parts = 0;
        narc_mass mass;
        while (parts < 4) {
            narc_arc *const next = arcs + used;
            const enum builder builder = (enum builder)random_below(&random, ELLIPSE);
            const double x = random_between(&random, -4, 4), y = random_between(&random, -4, 4);
            if (build(builder, &random, k, next, &counts[parts]) == NARC_OK &&
                narc_move_arcs(next, counts[parts], x, y, x * y, 1, next, NULL) == NARC_OK)
                used += counts[parts++];
        }
        assert_int_equal(narc_compute_union_mass(arcs, counts, parts, NULL, &mass, NULL), NARC_OK);
        hash = hash_double(hash_double(hash, mass.area), mass.centroid_x);
        hash = hash_double(hash_double(hash, mass.centroid_y), mass.second_moment);
    }
    printf("  unions: 0x%016" PRIx64 "\n", hash);
    assert_true(hash == golden_unions);
}

/* Ground from right to left: arcs and corners both ways, edges between them. */
static size_t walk_ground(struct test_random *random, size_t steps, narc_arc *out_arcs) {
    const double level = 1.5707963267948966;
    double x = 0, y = 0, angle = level, c, s;
    for (size_t k = 0; k < steps; k++) {
        const double to = k % 5 && k + 1 < steps ? level + random_between(random, -1, 1) : angle,
                     length = random_between(random, 0, 2);
        const double size = k % 3 && to != angle ? random_between(random, 0.25, 4) : 0,
                     radius = to < angle ? -size : size;
        narc_find_cosine(angle, &c, &s);
        out_arcs[k] = (narc_arc){x - radius * c, y - radius * s, radius, angle, to};
        narc_find_cosine(to, &c, &s);
        x = out_arcs[k].center_x + radius * c - (k % 4 ? length * s : 0);
        y = out_arcs[k].center_y + radius * s + (k % 4 ? length * c : 0);
        angle = to;
    }
    return steps;
}

/* What chains are divided into: ground, and rings. */
TEST(test_chains) {
    enum { ENTRIES = 256 };
    struct test_random random = {11};
    uint64_t hash = TEST_HASH_START;
    size_t divided = 0;
    for (size_t k = 0; k < 200; k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        size_t length = 0;
        if (k % 4 || build(RING, &random, k, arcs, &length) != NARC_OK)
            length = walk_ground(&random, 11 + k % 2, arcs);
        const narc_chain_options options = {.closed = k % 4 == 0, .weld = k % 2 ? 0 : 2};
        const size_t first = options.closed ? 0 : k % 5; /* any arc may be the first one */
        narc_chain_entry entries[ENTRIES];
        AUTO(narc_destroy_shapes_at) narc_shapes *shapes;
        size_t count = 0;
        assert_int_equal(narc_create_shapes(NULL, &shapes), NARC_OK);
        divided +=
            narc_add_chain(shapes, arcs + first, length - first, &options, entries, ENTRIES, &count, NULL) == NARC_OK;
        for (size_t i = 0; i < count; i++) {
            const uint32_t numbers[] = {entries[i].shape, entries[i].run, entries[i].first_arc, entries[i].arc_count};
            hash = test_hash_items(hash, numbers, 4, sizeof *numbers);
            hash = hash_double(hash_double(hash, entries[i].x), entries[i].y);
        }
        if (count > 0)
            hash = hash_stored(hash, shapes);
    }
    printf("  chains: %zu of 200, 0x%016" PRIx64 "\n", divided, hash);
    assert_true(divided > 150);
    assert_true(hash == golden_chains);
}

TEST_MAIN("stored bits")
