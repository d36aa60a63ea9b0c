/* SPDX-License-Identifier: MIT
 *
 * saving.c - a store as bytes: what is loaded is what was saved, the bytes are recorded, and no bytes do harm.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ledger.h"
#include "narc.h"
#include "scene.h"
#include "store.h"
#include "support.h"
#include "tests.h"
#include "turtle.h"

enum { START = 40, AT_VERSION = 8, AT_SIZE = 24, AT_CHECKSUM = 32 };

/* Some shapes of all kinds, some of them used more than once, and holes. */
static narc_shapes *make_store(struct test_random *random, size_t shapes_per_family) {
    narc_shapes *shapes = empty_store();
    for (size_t k = 0; k < shapes_per_family * FAMILY_COUNT; k++) {
        const struct shape shape = make_shape(random, (enum family)(k % FAMILY_COUNT));
        for (size_t uses = 1 + random_below(random, 2); uses > 0; uses--)
            store_shape(shapes, shape);
    }
    for (size_t k = 0; k < shapes_per_family; k++) {
        const uint32_t index = (uint32_t)random_below(random, narc_count_shapes(shapes));
        while (narc_count_uses(shapes, index))
            assert_int_equal(narc_remove_shape(shapes, index, NULL), NARC_OK);
    }
    return shapes;
}

static unsigned char *save(const narc_shapes *shapes, size_t *out_size) {
    *out_size = narc_count_saved_bytes(shapes);
    unsigned char *bytes = malloc(*out_size);
    narc_error error;
    assert_non_null(bytes);
    expect_ok(narc_save_shapes(shapes, bytes, *out_size, &error), &error);
    return bytes;
}

static narc_shapes *load(const unsigned char *bytes, size_t size) {
    narc_shapes *loaded = NULL;
    narc_error error;
    expect_ok(narc_load_shapes(NULL, bytes, size, &loaded, &error), &error);
    return loaded;
}

static void expect_same_store(const narc_shapes *a, const narc_shapes *b) {
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->removed_count, b->removed_count);
    assert_int_equal(a->last_removed, b->last_removed);
    assert_int_equal(a->used_records, b->used_records);
    assert_int_equal(a->box_count, b->box_count);
    assert_int_equal(a->piece_count, b->piece_count);
    for (uint32_t k = 0; k < a->count; k++) {
        narc_shape_header header = a->headers[k];
        assert_int_equal(narc_count_uses(a, k), narc_count_uses(b, k));
        if (!narc_has_shape(a, k)) {
            assert_int_equal(a->entries[k].next, b->entries[k].next);
            assert_int_equal(a->entries[k].before, b->entries[k].before);
            continue;
        }
        header.first_record = b->headers[k].first_record;
        assert_memory_equal(&header, &b->headers[k], sizeof header);
        assert_memory_equal(&a->boxes[k], &b->boxes[k], sizeof *a->boxes);
        if (narc_is_of_chain(&header))
            assert_memory_equal(&a->fronts[k], &b->fronts[k], sizeof *a->fronts);
        assert_memory_equal(&a->records[a->headers[k].first_record], &b->records[header.first_record],
                            narc_count_records(&header) * sizeof(narc_record));
    }
}

/* The same store, from bytes that may lie anywhere, with the same bytes. */
static narc_shapes *save_and_load(const narc_shapes *shapes) {
    size_t size, again;
    AUTO(free_at) unsigned char *const bytes = save(shapes, &size), *const moved = malloc(size + 1);
    assert_non_null(moved);
    narc_shapes *const loaded = load(memcpy(moved + 1, bytes, size), size);
    expect_same_store(shapes, loaded);
    AUTO(free_at) unsigned char *const same = save(loaded, &again);
    assert_int_equal(again, size);
    assert_memory_equal(same, bytes, size);
    return loaded;
}

TEST(loads_what_was_saved) {
    struct test_random random = test_random_named("saving");
    for (size_t round = 0; round < test_trials(20); round++) {
        AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = make_store(&random, 1 + round % 5);
        AUTO(narc_destroy_shapes_at) narc_shapes *const loaded = save_and_load(shapes);
        /* It goes on as the saved one does: equal shapes are found, indices come in the same order. */
        for (int k = 0; k < 20; k++) {
            const struct shape shape = make_shape(&random, (enum family)random_below(&random, FAMILY_COUNT));
            const uint32_t index = store_shape(shapes, shape);
            assert_int_equal(store_shape(loaded, shape), index);
            assert_int_equal(store_shape(loaded, shape), index);
        }
    }
}

/* Files with few digits have arcs that do not quite meet: whatever is added is loaded. */
TEST(loads_arcs_that_were_given_apart) {
    struct test_random random = test_random_named("apart");
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    for (double apart = 1e-7; apart < NARC_TOLERANCE; apart *= 2)
        for (size_t k = 0; k < 8 * FAMILY_COUNT; k++) {
            struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
            for (size_t i = 0; i < shape.count; i++)
                shape.arcs[i].center_x += random_between(&random, -apart, apart);
            (void)narc_add_shape(shapes, shape.arcs, shape.count, NULL, NULL); /* some are refused */
        }
    narc_destroy_shapes(save_and_load(shapes));
}

/* So have segments: their middle lies beside them. */
TEST(loads_segments_that_were_given_apart) {
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    for (double apart = 1e-7; apart < NARC_TOLERANCE / 2; apart *= 1.2) {
        const double up = acos(0);
        const narc_arc arcs[] = {{-0.5, 0, 0, up, 3 * up}, {0.5, apart, 0, 3 * up, 5 * up}};
        narc_error error;
        expect_ok(narc_add_shape(shapes, arcs, 2, NULL, &error), &error);
    }
    narc_destroy_shapes(save_and_load(shapes));
}

/* So do edges of ground that turn by less than counts as a corner. */
TEST(loads_ground_that_turns_by_next_to_nothing) {
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
    for (double turn = 1e-6; turn < NARC_TOLERANCE; turn += 1e-6) {
        const double up = acos(0), normal = up + turn;
        const narc_arc arcs[] = {{10, 0, 0, up, up}, {9, 0, 0, up, normal}, {6, -3 * turn, 0, normal, normal}};
        const narc_chain_options options = {.weld = 100};
        narc_chain_entry entry[4];
        size_t count;
        narc_error error;
        expect_ok(narc_add_chain(shapes, arcs, 3, &options, entry, 4, &count, &error), &error);
    }
    narc_destroy_shapes(save_and_load(shapes));
}

/* Far from its origin a shape loses most of its digits; what is left is loaded. */
TEST(loads_shapes_far_from_their_origin) {
    struct test_random random = test_random_named("far saving");
    for (double away = 1; away < 1e9; away *= 10) {
        AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = empty_store();
        size_t size;
        for (size_t k = 0; k < 5 * FAMILY_COUNT; k++) {
            struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
            for (size_t i = 0; i < shape.count; i++)
                shape.arcs[i].center_x += away;
            if (narc_validate_arcs(shape.arcs, shape.count, NULL) == NARC_OK)
                store_shape(shapes, shape);
        }
        assert_true(narc_count_shapes(shapes) > 0);
        AUTO(free_at) unsigned char *bytes = save(shapes, &size);
        AUTO(narc_destroy_shapes_at) narc_shapes *const loaded = load(bytes, size);
        assert_int_equal(narc_count_shapes(loaded), narc_count_shapes(shapes));
    }
}

/* The bytes of builders' shapes, recorded: the same on every platform. */
TEST(saves_recorded_bytes) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count, size;
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    for (int k = 0; k < 8; k++) {
        const double length = 1 + k / 8.0;
        store_shape(shapes, box_of(length, 2, k / 16.0));
        assert_int_equal(narc_build_ellipse(length, 0.75, 12, arcs, &count, NULL, NULL), NARC_OK);
        assert_int_equal(narc_add_shape(shapes, arcs, count, NULL, NULL), NARC_OK);
        assert_int_equal(narc_build_segment(&(narc_point){-1, k}, &(narc_point){2, 1}, k % 2, arcs, &count, NULL),
                         NARC_OK);
        assert_int_equal(narc_add_shape(shapes, arcs, count, NULL, NULL), NARC_OK);
    }
    assert_int_equal(narc_remove_shape(shapes, 4, NULL), NARC_OK);
    assert_int_equal(narc_remove_shape(shapes, 9, NULL), NARC_OK);
    assert_int_equal(narc_add_shape_at(shapes, 30, arcs, count, NULL), NARC_OK);
    AUTO(free_at) unsigned char *bytes = save(shapes, &size);
    const uint64_t hash = test_hash(TEST_HASH_START, bytes, size);
    printf("  %zu bytes, 0x%016" PRIx64 "\n", size, hash);
    assert_true(hash == 0xb3e02012f6908cacu);
}

TEST(refuses_bad_arguments) {
    struct test_random random = test_random_named("saving arguments");
    narc_shapes *shapes = make_store(&random, 1), *loaded = NULL;
    size_t size;
    unsigned char *bytes = save(shapes, &size), junk[8] = {1, 2, 3};
    narc_error error;
    expect_error(narc_save_shapes(NULL, bytes, size, &error), NARC_ERROR_ARGUMENT, &error, "shapes is NULL");
    expect_error(narc_save_shapes(shapes, NULL, size, &error), NARC_ERROR_ARGUMENT, &error, "out_bytes is NULL");
    expect_error(narc_save_shapes(shapes, junk, sizeof junk, &error), NARC_ERROR_CAPACITY, &error, "room for 8 bytes");
    assert_true(error.value == (double)size && junk[0] == 1 && junk[1] == 2);
    expect_error(narc_load_shapes(NULL, NULL, size, &loaded, &error), NARC_ERROR_ARGUMENT, &error, "bytes is NULL");
    expect_error(narc_load_shapes(NULL, bytes, size, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_shapes is NULL");
    expect_error(narc_load_shapes(NULL, junk, sizeof junk, &loaded, &error), NARC_ERROR_FORMAT, &error, "no store");
    struct ledger ledger = {.limited = true};
    const narc_allocator allocator = ledger_allocator(&ledger);
    expect_error(narc_load_shapes(&allocator, bytes, size, &loaded, &error), NARC_ERROR_MEMORY, &error, "no store");
    assert_true(error.value == 0);
    bytes[AT_VERSION] = 2;
    expect_error(narc_load_shapes(NULL, bytes, size, &loaded, &error), NARC_ERROR_FORMAT, &error, "version 2");
    assert_null(loaded);
    assert_int_equal(narc_count_saved_bytes(NULL), START);
    narc_destroy_shapes(shapes);
    free(bytes);
}

/* Whichever allocation of loading fails, nothing is loaded. */
TEST(loading_survives_failing_allocations) {
    struct test_random random = test_random_named("loading without memory");
    narc_shapes *shapes = make_store(&random, 2), *loaded = NULL;
    size_t size, failures = 0;
    AUTO(free_at) unsigned char *bytes = save(shapes, &size);
    narc_error error;
    for (;; failures++) {
        struct ledger ledger = {.limited = true, .left = failures};
        const narc_allocator allocator = ledger_allocator(&ledger);
        const narc_status status = narc_load_shapes(&allocator, bytes, size, &loaded, &error);
        if (status == NARC_OK) {
            expect_same_store(shapes, loaded);
            narc_destroy_shapes(loaded);
            assert_int_equal(ledger.live, 0);
            break;
        }
        expect_error(status, NARC_ERROR_MEMORY, &error, "");
        assert_null(loaded);
        assert_int_equal(ledger.live, 0);
    }
    assert_true(failures >= 3);
    narc_destroy_shapes(shapes);
}

static void write_checksum(unsigned char *bytes, size_t size) {
    const uint64_t hash = test_hash(test_hash(TEST_HASH_START, bytes, AT_CHECKSUM), bytes + START, size - START);
    for (int k = 0; k < 8; k++)
        bytes[AT_CHECKSUM + k] = (unsigned char)(hash >> 8 * k);
}

TEST(damaged_bytes_are_refused) {
    struct test_random random = test_random_named("damage");
    narc_shapes *shapes = make_store(&random, 2), *loaded = NULL;
    size_t size;
    AUTO(free_at) unsigned char *bytes = save(shapes, &size);
    narc_error error;
    for (size_t k = 0; k < test_trials(3000); k++) {
        const size_t at = random_below(&random, size);
        const unsigned char flip = (unsigned char)(1u << random_below(&random, 8));
        bytes[at] ^= flip;
        assert_int_equal(narc_load_shapes(NULL, bytes, size, &loaded, &error), NARC_ERROR_FORMAT);
        bytes[at] ^= flip;
        const size_t shorter = random_below(&random, size);
        AUTO(free_at) unsigned char *part = malloc(shorter ? shorter : 1); /* sanitizers see what reads past it */
        assert_non_null(part);
        memcpy(part, bytes, shorter);
        assert_int_equal(narc_load_shapes(NULL, part, shorter, &loaded, &error), NARC_ERROR_FORMAT);
    }
    assert_null(loaded);
    narc_destroy_shapes(shapes);
}

/* All pairs of a store's shapes in one place and near it: answers are numbers, and agree with each other. */
static void expect_usable(const narc_shapes *shapes) {
    enum { MOST = 40 };
    narc_body body[MOST];
    uint32_t a[MOST * MOST], b[MOST * MOST];
    size_t count = 0;
    for (uint32_t k = 0; k < narc_count_shapes(shapes) && count < MOST; k++)
        if (narc_has_shape(shapes, k)) {
            const narc_shape_header *header = &shapes->headers[k];
            const float x = 0.1f * (float)(count % 7) - header->bound_x,
                        y = 0.1f * (float)(count % 5) - header->bound_y;
            body[count++] = (narc_body){(double)x, (double)y, 1, 0, 1, k};
        }
    for (uint32_t k = 0; k < count * count; k++) {
        a[k] = k / (uint32_t)count;
        b[k] = k % (uint32_t)count;
    }
    narc_bodies bodies;
    narc_view_bodies(body, count, &bodies);
    const narc_pairs pairs = {.count = count * count, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    AUTO(free_at) uint64_t *const bits = find_overlaps(shapes, &bodies, &pairs, NULL);
    AUTO(free_at) struct contacts contacts = find_contacts(shapes, &bodies, &pairs, &(narc_query){.margin = INFINITY});
    assert_int_equal(contacts.count, pairs.count);
    for (size_t k = 0; k < pairs.count; k++) {
        assert_false(isnan(contacts.rows[k].separation) || isnan(contacts.rows[k].normal_x));
        assert_int_equal(bit_is_set(bits, k), contacts.rows[k].separation < 0);
    }
}

static void write_word(unsigned char *bytes, uint32_t word) {
    for (int k = 0; k < 4; k++)
        bytes[k] = (unsigned char)(word >> 8 * k);
}

static void write_float(unsigned char *bytes, float value) {
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    write_word(bytes, word);
}

static void check_forged(struct shape box) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    unsigned char is[4], *at = NULL;
    size_t size;
    store_shape(shapes, box);
    assert_int_equal(shapes->box_count, 1);
    AUTO(free_at) unsigned char *bytes = save(shapes, &size);
    write_float(is, shapes->headers[0].bound_radius);
    for (size_t k = START; k + 4 <= size && !at; k++)
        at = memcmp(bytes + k, is, 4) == 0 ? bytes + k : NULL;
    assert_non_null(at);
    const float forged = 2 * shapes->headers[0].bound_radius;
    write_float(at, forged);
    write_checksum(bytes, size);
    AUTO(narc_destroy_shapes_at) narc_shapes *const loaded = load(bytes, size);
    assert_true(loaded->headers[0].bound_radius == forged);
    assert_int_equal(loaded->box_count, 0);
}

/* Kernels for boxes and capsules go by half of their sizes, the others by the bounding circle: where that is forged,
 * there is no box, and no capsule. */
TEST(forged_circle_makes_no_box) { check_forged(box_of(4, 2, 0)); }

TEST(forged_circle_makes_no_capsule) { check_forged(capsule_of(4, 2)); }

/* Damage with a checksum that fits, as by someone who means it: an error, or a store like any other. */
TEST(forged_bytes_do_no_harm) {
    struct test_random random = test_random_named("forgery");
    size_t loads = 0;
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = make_store(&random, 2);
    size_t size;
    AUTO(free_at) unsigned char *bytes = save(shapes, &size), *forged = malloc(size);
    narc_error error;
    assert_non_null(forged);
    for (size_t k = 0; k < test_trials(8000); k++) {
        AUTO(narc_destroy_shapes_at) narc_shapes *loaded = NULL;
        memcpy(forged, bytes, size);
        for (size_t flips = 1 + random_below(&random, 3); flips > 0; flips--) {
            const size_t at = random_below(&random, 8) ? random_below(&random, size) : random_below(&random, START);
            forged[at] = (unsigned char)(random_below(&random, 2) ? random_below(&random, 256)
                                                                  : forged[at] ^ 1u << random_below(&random, 8));
        }
        size_t given = size;
        if (random_below(&random, 4) == 0) {
            given = START + random_below(&random, size - START);
            for (int i = 0; i < 8; i++)
                forged[AT_SIZE + i] = (unsigned char)((uint64_t)given >> 8 * i);
        }
        write_checksum(forged, given);
        const narc_status status = narc_load_shapes(NULL, forged, given, &loaded, &error);
        if (status != NARC_OK) {
            assert_int_equal(status, NARC_ERROR_FORMAT);
            assert_null(loaded);
            continue;
        }
        if (loads++ % 16 == 0)
            expect_usable(loaded);
        /* It can be saved, loaded, and added to. */
        size_t again;
        AUTO(free_at) unsigned char *copy = save(loaded, &again);
        AUTO(narc_destroy_shapes_at) narc_shapes *const third = load(copy, again);
        for (size_t i = narc_count_shapes(third); i-- > 0;)
            while (narc_count_uses(third, (uint32_t)i) > 0 && narc_count_uses(third, (uint32_t)i) < 10)
                assert_int_equal(narc_remove_shape(third, (uint32_t)i, NULL), NARC_OK);
        for (int i = 0; i < 3; i++)
            store_shape(third, make_shape(&random, FAMILY_BOX));
    }
    printf("  %zu loads of %zu forgeries\n", loads, test_trials(8000));
    assert_true(loads > 0);
    expect_usable(shapes);
}

/* ------------------------------------------------------------------------------------------------ pieces of chains */

static narc_shapes *make_ground_store(struct test_random *random) {
    narc_shapes *shapes = empty_store();
    narc_chain_entry entries[400];
    size_t count;
    narc_error error;
    for (int k = 0; k < 4; k++) {
        AUTO(free_at) struct turtle t = walk_ground(random, 20, 1.2);
        expect_ok(narc_add_chain(shapes, t.arcs, t.count, NULL, entries, 400, &count, &error), &error);
        store_shape(shapes, box_of(1, 2 + k, 0));
    }
    return shapes;
}

TEST(saves_pieces_of_chains) {
    struct test_random random = test_random_named("pieces"), again = random;
    AUTO(narc_destroy_shapes_at) narc_shapes *const shapes = make_ground_store(&random);
    AUTO(narc_destroy_shapes_at) narc_shapes *const loaded = save_and_load(shapes);
    AUTO(narc_destroy_shapes_at)
    narc_shapes *const same = make_ground_store(&again); /* chains are divided into the same bits */
    assert_int_equal(loaded->piece_count, narc_count_shapes(shapes) - 4);
    expect_same_store(shapes, same);
}

/* Where the numbers of a store's first shape are. */
enum { SHAPE = START + 4, MARK = SHAPE + 1, FLAGS = SHAPE + 2, RATIO = SHAPE + 3, CIRCLE = SHAPE + 4 };
enum { ARCS = SHAPE + 28, ARC = 32 };

static void expect_refused(unsigned char *bytes, size_t size, const char *words) {
    narc_shapes *loaded = NULL;
    narc_error error;
    write_checksum(bytes, size);
    expect_error(narc_load_shapes(NULL, bytes, size, &loaded, &error), NARC_ERROR_FORMAT, &error, words);
    assert_null(loaded);
}

/* With a number, or a byte, that is another one. */
static void refuse_number(const unsigned char *bytes, size_t size, size_t at, float number, const char *words) {
    AUTO(free_at) unsigned char *const forged = malloc(size);
    assert_non_null(forged);
    write_float((unsigned char *)memcpy(forged, bytes, size) + at, number);
    expect_refused(forged, size, words);
}

static void refuse_byte(unsigned char *bytes, size_t size, size_t at, unsigned byte, const char *words) {
    const unsigned char was = bytes[at];
    bytes[at] = (unsigned char)byte;
    expect_refused(bytes, size, words);
    bytes[at] = was;
}

/* Arc k becomes that of another place, and ends with the normal that the next one begins with. */
static void put_arcs_in_order(const unsigned char *from, unsigned char *to, size_t count, const size_t *order) {
    for (size_t k = 0; k < count; k++) {
        memcpy(to + ARCS + k * ARC, from + ARCS + order[k] * ARC, ARC);
        memcpy(to + ARCS + k * ARC + 24, from + ARCS + order[(k + 1) % count] * ARC + 16, 8);
    }
}

/* What is stored of a shape is not believed: what is wrong is named. */
TEST(refuses_forged_shapes) {
    enum { CORNERS = 5 };
    static const struct {
        size_t at;
        float value;
        const char *words;
    } numbers[] = {
        {ARCS, INFINITY, "a number that no arc has"},
        {ARCS + 4, NAN, "a number that no arc has"},
        {ARCS + 8, NAN, "a number that no arc has"},
        {ARCS + 8, -1, "a number that no arc has"},
        {ARCS + 16, 1.5f, "normals that do not join"},
        {ARCS + 20, NAN, "normals that do not join"},
        {ARCS + 24, 0.5f, "normals that do not join"},
        {ARCS + 28, 0.5f, "normals that do not join"},
        {ARCS, 1e13f, "arcs that are too large"},
        {ARCS, 10, "arcs that do not meet"},
        {CIRCLE, NAN, "a circle that is out of range"},
        {CIRCLE + 4, INFINITY, "a circle that is out of range"},
        {CIRCLE + 8, 1e-12f, "a circle that is out of range"},
        {CIRCLE + 8, 2e9f, "a circle that is out of range"},
        {CIRCLE + 12, NAN, "a circle that is out of range"},
        {CIRCLE + 16, NAN, "a circle that is out of range"},
        {CIRCLE + 20, INFINITY, "a circle that is out of range"},
        {CIRCLE, 1.1e9f, "a shape too far from its origin"},
        {CIRCLE + 8, 0.9f, "a circle that does not hold its shape"},
        {CIRCLE, 10.1f, "a circle that does not hold its shape"},
        {CIRCLE + 20, 1, "a circle that is not in its shape"},
        {CIRCLE + 12, 10.1f, "a circle that is not in its shape"},
    };
    static const struct {
        size_t order[CORNERS];
        const char *words;
    } orders[] = {{{0, 2, 4, 1, 3}, "arcs that do not make one turn"},
                  {{0, 0, 1, 2, 3}, "an arc that does not turn"},
                  {{1, 2, 3, 4, 0}, "arcs out of order"}};
    struct shape pentagon;
    narc_point points[CORNERS];
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    size_t size;
    for (size_t k = 0; k < CORNERS; k++)
        points[k] = (narc_point){10 + cos(0.4 * PI * (double)k), sin(0.4 * PI * (double)k)};
    assert_int_equal(narc_build_polygon(points, CORNERS, 0, pentagon.arcs, &pentagon.count, NULL), NARC_OK);
    store_shape(shapes, pentagon);
    AUTO(free_at) unsigned char *bytes = save(shapes, &size), *forged = malloc(size);
    assert_non_null(forged);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        refuse_number(bytes, size, numbers[k].at, numbers[k].value, numbers[k].words);
    for (size_t k = 0; k < sizeof orders / sizeof *orders; k++) {
        memcpy(forged, bytes, size);
        put_arcs_in_order(bytes, forged, CORNERS, orders[k].order);
        expect_refused(forged, size, orders[k].words);
    }
    refuse_byte(bytes, size, RATIO, bytes[RATIO] - 1u, "an extent that is too small");
    refuse_byte(bytes, size, FLAGS, bytes[FLAGS] ^ NARC_SHAPE_SMOOTH, "flags that are not the shape's");
}

static float read_float(const unsigned char *bytes) {
    const uint32_t word = bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

/* A lens whose arcs become flatter than arcs may be, all numbers together. */
TEST(refuses_forged_flat_arcs) {
    const double radius = 60, flatter = 70; /* half the chord is 1 */
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    struct shape lens;
    size_t size;
    assert_int_equal(narc_build_four_arc(&(narc_four_arc){radius, radius, 2 * sqrt(radius * radius - 1), 0, 0},
                                         lens.arcs, &lens.count, NULL),
                     NARC_OK);
    store_shape(shapes, lens);
    AUTO(free_at) unsigned char *bytes = save(shapes, &size);
    for (size_t k = 0; k < lens.count; k++) {
        unsigned char *const arc = bytes + ARCS + k * ARC;
        if (read_float(arc + 8) > 0) {
            write_float(arc + 4, copysignf((float)sqrt(flatter * flatter - 1), read_float(arc + 4)));
            write_float(arc + 8, (float)flatter);
        }
        for (size_t at = 16; at < 32; at += 8) {
            write_float(arc + at, copysignf((float)(1 / flatter), read_float(arc + at)));
            write_float(arc + at + 4, copysignf((float)sqrt(1 - 1 / flatter / flatter), read_float(arc + at + 4)));
        }
    }
    expect_refused(bytes, size, "an arc that is too flat");
}

/* The list of removed indices ends where the last one says that there are no more. */
TEST(refuses_a_list_that_goes_on) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
    size_t size;
    store_shape(shapes, circle_of(1));
    store_shape(shapes, circle_of(2));
    assert_int_equal(narc_remove_shape(shapes, 1, NULL), NARC_OK);
    AUTO(free_at) unsigned char *bytes = save(shapes, &size);
    write_word(bytes + size - 4, 0);
    expect_refused(bytes, size, "removed indices are no list");
}

/* What is stored of a piece is not believed: one number that is wrong, and it is refused. */
TEST(refuses_forged_pieces) {
    const struct {
        size_t at;
        float value;
    } numbers[] = {{CIRCLE, 1},      {CIRCLE + 4, NAN}, {CIRCLE + 8, 1e-12f}, {CIRCLE + 8, 3e9f},
                   {CIRCLE + 20, 1}, {ARCS, INFINITY},  {ARCS + 8, 1},        {ARCS + 8, -1e9f},
                   {ARCS + 12, 1},   {ARCS + 16, 2},    {ARCS + 24, NAN}};
    const unsigned char marks[] = {0, NARC_PIECE_RUN, NARC_PIECE_CONCAVE + 1, NARC_PIECE_CONCAVE + NARC_PIECE_RUN};
    for (int concave = 0; concave < 2; concave++) {
        AUTO(free_at) struct turtle t = create_turtle(0, 0, 0);
        narc_chain_entry entry;
        AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store();
        size_t size, count;
        walk_arc(&t, 3, concave ? -1 : 1);
        assert_int_equal(narc_add_chain(shapes, t.arcs, t.count, NULL, &entry, 1, &count, NULL), NARC_OK);
        AUTO(free_at) unsigned char *bytes = save(shapes, &size);
        const unsigned char mark = bytes[MARK];
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers && concave; k++)
            refuse_number(bytes, size, numbers[k].at, numbers[k].value, "");
        for (size_t k = 0; k < sizeof marks && concave; k++)
            refuse_byte(bytes, size, MARK, marks[k], "");
        for (size_t k = 0; k < 7 && !concave; k++) /* a corner of the closure that is none */
            if ((k + (mark & NARC_FIRST_ARC)) % 7 != 1)
                refuse_number(bytes, size, ARCS + k * ARC + 8, 0x1p-21f, "");
        if (!concave)
            refuse_byte(bytes, size, MARK, mark | NARC_PIECE_CONCAVE, "");
    }
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = empty_store(); /* a shape that is no closed run */
    size_t size;
    store_shape(shapes, box_of(1, 2, 0));
    AUTO(free_at) unsigned char *bytes = save(shapes, &size);
    refuse_byte(bytes, size, MARK, bytes[MARK] | NARC_PIECE_RUN, "");
}
