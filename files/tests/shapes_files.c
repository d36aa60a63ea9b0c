/* SPDX-License-Identifier: MIT
 *
 * shapes_files.c - shapes files: every form, bits that survive, lines of errors, damage, memory that runs out.
 */
#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "expect.h"
#include "families.h"
#include "ledger.h"
#include "narc_files.h"
#include "support.h"
#include "turtle.h"

RELEASE_AT(narc_destroy_shape_list)

static const char every_form[] =
    "\xef\xbb\xbf{\"shapes\": [\n"
    "  {\"name\": \"disc\", \"origin\": [-0.0, 1e-310], \"circle\": 1.5},\n"
    "  {\"name\": \"kapsel-\\u00e4\", \"capsule\": {\"length\": 4, \"radius\": 1}},\n"
    "  {\"name\": \"2\", \"box\": {\"width\": 4, \"height\": 2, \"radius\": 0.5}},\n"
    "  {\"name\": \"back\\\\slash\", \"polygon\": [[0, 0], [4, 0], [0, 3]], \"radius\": 0.25},\n"
    "  {\"name\": \"p\", \"points\": [[0, 0], [4, 0], [4, 3], [0, 3]], \"radius\": 2.5},\n"
    "  {\"name\": \"f\", \"four_arc\": {\"radius_low\": 5, \"radius_high\": 5, \"distance\": 8, \"radius_left\": "
    "0.25}},\n"
    "  {\"name\": \"half\", \"arcs\": [\n"
    "    {\"center\": [0, 0], \"radius\": 1, \"start\": 0, \"end\": 3.141592653589793},\n"
    "    {\"center\": [0, -1], \"radius\": 1, \"start\": 3.141592653589793, \"end\": 6.283185307179586}]}]}\n";
enum { FORMS = 7 };

/* Reads from a block of exactly that size, so that reading behind its end shows. */
static narc_status read_exactly(const char *text, size_t size, const narc_allocator *allocator, narc_shapes *store,
                                narc_shape_list **out_list, narc_error *error) {
    AUTO(free_at) char *data = malloc(size ? size : 1);
    assert_non_null(data);
    memcpy(data, text, size);
    return narc_read_shapes(data, size, allocator, store, out_list, error);
}

static narc_shape_list *read_text(const char *text, narc_shapes *store) {
    narc_shape_list *list = NULL;
    narc_error error;
    expect_ok(read_exactly(text, strlen(text), NULL, store, &list, &error), &error);
    return list;
}

static void expect_arcs(const narc_named_shape *shape, const char *name, const narc_arc *arcs, size_t count) {
    assert_string_equal(shape->name, name);
    assert_int_equal(shape->arc_count, count);
    assert_memory_equal(shape->arcs, arcs, count * sizeof *arcs);
}

TEST(reads_every_form) {
    const narc_arc circle = {0, 0, 1, 0, 6.283185307179586};
    AUTO(narc_destroy_shapes_at) narc_shapes *store = empty_store();
    assert_int_equal(narc_add_shape(store, &circle, 1, NULL, NULL), NARC_OK);
    AUTO(narc_destroy_shape_list_at) narc_shape_list *list = read_text(every_form, store);
    assert_int_equal(list->count, FORMS);
    assert_int_equal(narc_count_shapes(store), FORMS + 1);
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    const narc_point triangle[] = {{0, 0}, {4, 0}, {0, 3}}, square[] = {{0, 0}, {4, 0}, {4, 3}, {0, 3}};
    assert_int_equal(narc_build_circle(1.5, arcs, &count, NULL), NARC_OK);
    expect_arcs(&list->items[0], "disc", arcs, count);
    assert_true(signbit(list->items[0].origin.x) && list->items[0].origin.y == 1e-310);
    assert_int_equal(narc_build_capsule(4, 1, arcs, &count, NULL), NARC_OK);
    expect_arcs(&list->items[1], "kapsel-\xc3\xa4", arcs, count);
    assert_int_equal(narc_build_box(4, 2, 0.5, arcs, &count, NULL), NARC_OK);
    expect_arcs(&list->items[2], "2", arcs, count);
    assert_int_equal(narc_build_polygon(triangle, 3, 0.25, arcs, &count, NULL), NARC_OK);
    expect_arcs(&list->items[3], "back\\slash", arcs, count);
    assert_int_equal(narc_build_points(square, 4, 2.5, arcs, &count, NULL), NARC_OK);
    expect_arcs(&list->items[4], "p", arcs, count);
    assert_int_equal(narc_build_four_arc(&(narc_four_arc){5, 5, 8, 0.25, 0}, arcs, &count, NULL), NARC_OK);
    expect_arcs(&list->items[5], "f", arcs, count);
    const narc_arc halves[] = {{0, 0, 1, 0, 3.141592653589793}, {0, -1, 1, 3.141592653589793, 6.283185307179586}};
    expect_arcs(&list->items[6], "half", halves, 2);
    for (size_t k = 0; k < FORMS; k++) {
        assert_int_equal(list->items[k].index, k + 1);
        assert_int_equal(narc_get_arcs(store, list->items[k].index, NULL), list->items[k].arc_count);
        assert_int_equal(narc_find_named_shape(list, list->items[k].name), k);
    }
    assert_int_equal(narc_find_named_shape(list, ""), FORMS);
    assert_int_equal(narc_find_named_shape(list, "discs"), FORMS);
    narc_destroy_shape_list(NULL);
}

/* ---------------------------------------------------------------------------- there and back */

static void expect_same(const narc_named_shape *a, const narc_named_shape *b) {
    expect_arcs(a, b->name, b->arcs, b->arc_count);
    assert_memory_equal(&a->origin, &b->origin, sizeof a->origin);
}

TEST(half_planes_are_shapes_without_arcs) {
    AUTO(narc_destroy_shapes_at) narc_shapes *store = empty_store();
    const narc_arc disc = {0, 0, 1, 0, 6.283185307179586};
    const narc_named_shape shapes[] = {{"floor", NULL, 0, {0, 0}, 0, NARC_FORM_HALF_PLANE},
                                       {"disc", &disc, 1, {0, 0}, 0, NARC_FORM_SHAPE}};
    char *text = NULL;
    size_t size;
    narc_error error;
    expect_ok(narc_write_shapes(shapes, 2, NULL, &text, &size, &error), &error);
    assert_non_null(strstr(text, "{\"name\": \"floor\", \"origin\": [0, 0], \"half_plane\": true}"));
    narc_shape_list *list = read_text(text, store);
    assert_int_equal(list->items[0].form, NARC_FORM_HALF_PLANE);
    assert_int_equal(list->items[0].arc_count, 0);
    assert_int_equal(list->items[1].form, NARC_FORM_SHAPE);
    assert_int_equal(narc_shape_flags(store, list->items[0].index), NARC_SHAPE_HALF_PLANE);
    narc_destroy_shape_list(list);
    free(text);
    list = NULL; /* what is in the store before an error is removed again */
    const size_t before = narc_count_shapes(store);
    static const char *const wrong[] = {
        "{\"shapes\": [{\"name\": \"f\", \"half_plane\": true}, {\"name\": \"g\", \"half_plane\": false}]}",
        "{\"shapes\": [{\"name\": \"f\", \"half_plane\": true, \"radius\": 1}]}"};
    for (size_t k = 0; k < 2; k++)
        assert_int_equal(read_exactly(wrong[k], strlen(wrong[k]), NULL, store, &list, &error), NARC_ERROR_FORMAT);
    assert_int_equal(narc_count_shapes(store), before);
}

/* Written and read they have the same bits; written again the file has the same bytes. */
static void expect_round_trip(const narc_named_shape *shapes, size_t count) {
    AUTO(free_at) char *text = NULL, *again = NULL;
    size_t size = 0, again_size = 0;
    narc_error error;
    expect_ok(narc_write_shapes(shapes, count, NULL, &text, &size, &error), &error);
    assert_int_equal(strlen(text), size);
    AUTO(narc_destroy_shape_list_at) narc_shape_list *list = read_text(text, NULL);
    assert_int_equal(list->count, count);
    for (size_t k = 0; k < count; k++)
        expect_same(&list->items[k], &shapes[k]);
    expect_ok(narc_write_shapes(list->items, count, NULL, &again, &again_size, &error), &error);
    assert_int_equal(again_size, size);
    assert_memory_equal(again, text, size);
}

static double random_finite(struct test_random *random) {
    for (;;) {
        const uint64_t bits = random_bits(random);
        double value;
        memcpy(&value, &bits, sizeof value);
        if (isfinite(value))
            return value;
    }
}

TEST(keeps_bits) {
    enum { SHAPES = 60 };
    struct test_random random = test_random_named("shapes there and back");
    for (size_t trial = 0; trial < test_trials(20); trial++) {
        AUTO(free_at) struct shape *made = malloc(SHAPES * sizeof *made);
        narc_named_shape shapes[SHAPES];
        char names[SHAPES][40];
        for (size_t k = 0; k < SHAPES; k++) {
            made[k] = make_shape(&random, (enum family)(k % FAMILY_COUNT));
            snprintf(names[k], sizeof names[k], "%s%zu \\\\ \xf0\x9f\x91\xbb", k % 2 ? "a" : "\xc3\xa4", SHAPES - k);
            shapes[k] = (narc_named_shape){
                names[k], made[k].arcs,   made[k].count, {random_finite(&random), random_finite(&random)},
                0,        NARC_FORM_SHAPE};
        }
        shapes[7].name = "7";
        expect_round_trip(shapes, SHAPES);
    }
}

/* Chains come back as they were, signs of zeros and angles that go round more than once too, and not into the store. */
TEST(keeps_chains) {
    struct test_random random = test_random_named("chains there and back");
    for (size_t trial = 0; trial < test_trials(20); trial++) {
        const narc_arc disc = {0, 0, 1, 0, 6.283185307179586};
        AUTO(free_at) struct turtle open = walk_ground(&random, 200, 1.2);
        AUTO(free_at) struct turtle closed = walk_gear(3 + random_below(&random, 20), 1);
        for (size_t k = 0; k < closed.count; k++) {
            const double round = 6.283185307179586 * (double)random_below(&random, 2);
            closed.arcs[k].start -= round;
            closed.arcs[k].end -= round;
        }
        const narc_named_shape shapes[] = {{"open", open.arcs, open.count, {1, 2}, 0, NARC_FORM_OPEN_CHAIN},
                                           {"disc", &disc, 1, {0, 0}, 0, NARC_FORM_SHAPE},
                                           {"closed", closed.arcs, closed.count, {0, 0}, 0, NARC_FORM_CLOSED_CHAIN}};
        expect_round_trip(shapes, 3);
    }
    static const char text[] =
        "{\"shapes\": [{\"name\": \"g\", \"chain\": {\"arcs\": [{\"center\": [1, 2], \"radius\": 0.0, "
        "\"start\": 1, \"end\": 1}, {\"center\": [0.15852901519210347, 2.5403023058681398], \"radius\": -0, \"start\": "
        "1, "
        "\"end\": 0.5}]}}, {\"name\": \"c\", \"circle\": 1}]}";
    AUTO(narc_destroy_shapes_at) narc_shapes *store = empty_store();
    AUTO(narc_destroy_shape_list_at) narc_shape_list *list;
    assert_int_equal(narc_read_shapes(text, strlen(text), NULL, store, &list, NULL), NARC_OK);
    assert_int_equal(narc_count_shapes(store), 1);
    assert_int_equal(list->items[0].form, NARC_FORM_OPEN_CHAIN);
    assert_true(signbit(list->items[0].arcs[1].radius));
    assert_int_equal(list->items[1].form, NARC_FORM_SHAPE);
}

/* A valley's radius is written as a number that keeps its sign in other programs, and is one without it. */
TEST(keeps_valleys) {
    AUTO(free_at) struct turtle t = create_turtle(0, 0, PI / 2);
    AUTO(narc_destroy_shapes_at) narc_shapes *store = empty_store();
    narc_chain_entry entries[2][8];
    size_t counts[2], size;
    AUTO(free_at) char *text;
    narc_error error;
    walk_arc(&t, 0, 0);
    walk_line(&t, 2);
    walk_arc(&t, 0, -0.5);
    walk_line(&t, 2);
    walk_arc(&t, 0, 0.25);
    walk_line(&t, 2);
    walk_arc(&t, 0, 0);
    const narc_named_shape shape = {"v", t.arcs, t.count, {0, 0}, 0, NARC_FORM_OPEN_CHAIN};
    expect_ok(narc_write_shapes(&shape, 1, NULL, &text, &size, &error), &error);
    assert_non_null(strstr(text, "\"radius\": -0.0,"));
    assert_null(strstr(text, "\"radius\": -0,"));
    char *const valley = strstr(text, "-0.0"); /* " 0  " */
    valley[0] = valley[2] = valley[3] = ' ';
    AUTO(narc_destroy_shape_list_at) narc_shape_list *list = read_text(text, store);
    assert_false(signbit(list->items[0].arcs[1].radius));
    for (int k = 0; k < 2; k++)
        expect_ok(
            narc_add_chain(store, k ? t.arcs : list->items[0].arcs, t.count, NULL, entries[k], 8, &counts[k], &error),
            &error);
    assert_int_equal(counts[0], counts[1]);
    assert_memory_equal(entries[0], entries[1], counts[0] * sizeof **entries);
}

/* Where the decimal point is a comma, files are the same. Skipped without such a locale. */
TEST(same_in_any_locale) {
    static const char *const names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"};
    narc_shape_list *list = read_text(every_form, NULL);
    char *text = NULL, *other = NULL;
    size_t size = 0, other_size = 0;
    const char *chosen = NULL;
    assert_int_equal(narc_write_shapes(list->items, FORMS, NULL, &text, &size, NULL), NARC_OK);
    for (size_t k = 0; k < 4 && !chosen; k++)
        chosen = setlocale(LC_NUMERIC, names[k]);
    if (chosen) {
        assert_int_equal(narc_write_shapes(list->items, FORMS, NULL, &other, &other_size, NULL), NARC_OK);
        assert_int_equal(other_size, size);
        assert_memory_equal(other, text, size);
        expect_round_trip(list->items, FORMS);
        setlocale(LC_NUMERIC, "C");
    }
    free(text);
    free(other);
    narc_destroy_shape_list(list);
    if (!chosen) {
        print_message("no locale with a decimal comma is installed\n");
        skip();
    }
}

/* ---------------------------------------------------------------------------- what is refused */

/* The line is that of the value, or of the object that lacks one. */
TEST(names_lines) {
    static const struct {
        const char *text;
        narc_status status;
        size_t line;
        double value;
        const char *message;
    } wrong[] = {
        {"", NARC_ERROR_FORMAT, 0, 0, "the text is empty"},
        {"{\"shapes\": [\n{\"name\": \"a\",, \"circle\": 1}]}", NARC_ERROR_FORMAT, 2, 0, "line 2: not valid JSON"},
        {"\n[]", NARC_ERROR_FORMAT, 2, 0, "line 2: the file's value is not an object '[]'"},
        {"{\n}", NARC_ERROR_FORMAT, 1, 0, "line 1: shapes is missing"},
        {"{\"shapes\":\n[]}", NARC_ERROR_COUNT, 2, 0, "line 2: shapes is an empty list"},
        {"{\"shapes\": [{\"name\": \"a\", \"circle\": 1}],\n \"a\": [\"]:,\\\"\"],\n \"b\": 1}", NARC_ERROR_FORMAT, 2,
         0, "line 2: unknown key 'a'"},
        {"{\"shapes\": [{\"name\": \"a\", \"circle\": 1},\n\n7]}", NARC_ERROR_FORMAT, 3, 0,
         "line 3: shape 1: it is not an object '7'"},
        {"{\"shapes\": [{\"name\": \"a\",\n\"circle\":\n-2}]}", NARC_ERROR_SIZE, 3, -2, "line 3: shape 'a': "},
        {"{\"shapes\": [{\"name\": \"a\",\n\"circle\": 1e999}]}", NARC_ERROR_NOT_FINITE, 2, INFINITY,
         "line 2: shape 'a': circle is not finite"},
        {"{\"shapes\": [{\"name\": \"a\", \"arcs\": [\n{\"center\": [0, 0], \"radius\": 1, \"start\": 0, \"end\": 3},\n"
         "{\"center\": [\n0,\n\"1\"], \"radius\": 1}]}]}",
         NARC_ERROR_FORMAT, 5, 0, "line 5: shape 'a', arc 1: center is not a number '\"1\"'"},
        {"{\"shapes\": [{\"name\": \"a\", \"arcs\": [\n{\"center\": [0, 0], \"radius\": 1, \"start\": 0, \"end\": 3},\n"
         "{\"center\": [0, 0], \"start\": 0, \"end\": 3}]}]}",
         NARC_ERROR_FORMAT, 3, 0, "line 3: shape 'a', arc 1: radius is missing"},
        {"{\"shapes\": [{\"name\": \"a\",\n\"polygon\": [[0, 0],\n[4, 0],\n[1, 1],\n[0, 4]]}]}", NARC_ERROR_NOT_CONVEX,
         4, 0, "line 4: shape 'a', point 2: "},
        {"{\"shapes\": [{\"name\": \"a\", \"circle\": 1},\n{\"name\": \"b\", \"circle\": 1},\n{\"circle\": "
         "1,\n\"name\": "
         "\"a\"}]}",
         NARC_ERROR_FORMAT, 4, 0, "line 4: shape 2: another shape has that name 'a'"},
        {"{\"shapes\": [{\"name\": \"a\", \"circle\": 1},\n{\"circle\": 1,\n\"name\":\n\"0\"}]}", NARC_ERROR_FORMAT, 4,
         0, "line 4: shape 1: a name of digits would be taken for the index of another shape '0'"},
        {"{\"shapes\": [{\"name\": \"a\", \"circle\": 1},\n{\"name\": \"g\", \"chain\": {\"arcs\": [\n{\"center\": [0, "
         "0], "
         "\"radius\": -1, \"start\": 0, \"end\": 3}]}}]}",
         NARC_ERROR_SWEEP, 3, 2 * PI - 3,
         "line 3: shape 'g', arc 0: sweep is 3.28318531 rad clockwise, more than half a turn"},
        /* A chain that the store would not take, also if no body is one: an edge with another normal than its ends, lines
         * that cross. */
        {"{\"shapes\": [{\"name\": \"g\", \"chain\": {\"arcs\": [\n{\"center\": [9, 0], \"radius\": 0, \"start\": 1.5, "
         "\"end\": "
         "1.5},\n{\"center\": [0, 5], \"radius\": 0, \"start\": 1.5, \"end\": 1.5}]}}]}",
         NARC_ERROR_NOT_CLOSED, 3, 0, "line 3: shape 'g', arc 1: starts 4.35"},
        {"{\"shapes\": [{\"name\": \"g\", \"chain\": {\"closed\": true, \"arcs\": [\n"
         "{\"center\": [0, 0], \"radius\": 0, \"start\": 3.141592653589793, \"end\": 5.497787143782138},\n"
         "{\"center\": [4, 4], \"radius\": 0, \"start\": 5.497787143782138, \"end\": 3.141592653589793},\n"
         "{\"center\": [4, 0], \"radius\": 0, \"start\": 3.141592653589793, \"end\": 0.7853981633974483},\n"
         "{\"center\": [0, 4], \"radius\": 0, \"start\": 0.7853981633974483, \"end\": 3.141592653589793}]}}]}",
         NARC_ERROR_NOT_SIMPLE, 3, 0,
         "line 3: shape 'g': arc 1, or the edge before it, meets arc 3 or the edge before it"},
        {"{\"shapes\": [{\"name\": \"a\",\n\"polygon\": [[0, 0],\n[0, 4],\n[4, 4],\n[4, 0]]}]}", NARC_ERROR_NOT_CONVEX,
         2, 0, "clockwise: reverse the points"},
        /* Bytes that are no UTF-8, a control character. */
        {"{\"shapes\": [{\"name\": \"a\xff\xc3(\xed\xa0\x80\xc2\x85\xe2\x82\", \"circle\": 1}]}", NARC_ERROR_FORMAT, 1,
         0, "invalid UTF-8 'a\?\?(\?\?\?\?\?\?\?'"},
        {"{\"shapes\": \xff}", NARC_ERROR_FORMAT, 1, 0, "line 1: not valid JSON here: '\?}'"},
        {"{\"shapes\": [{\"name\": \"g\", \"chain\": {\"closed\":\n1, \"arcs\": []}}]}", NARC_ERROR_FORMAT, 2, 0,
         "line 2: shape 'g': closed is neither true nor false '1'"},
        {"{\"shapes\": [{\"name\": \"g\", \"chain\": {\"arcs\":\n[]}}]}", NARC_ERROR_COUNT, 2, 0,
         "line 2: shape 'g': arcs is an empty list"},
        {"{\"shapes\": [{\"name\": \"g\", \"radius\": 1, \"chain\": {\"arcs\": []}}]}", NARC_ERROR_FORMAT, 1, 0,
         "line 1: shape 'g': 'chain' takes no 'radius' beside it"},
        /* Valid, but with room for rounding too large for the store. */
        {"{\"shapes\": [{\"name\": \"b\", \"circle\": 1},\n{\"name\": \"a\", \"arcs\":\n[{\"center\": [9e8, 0], "
         "\"radius\": 1e9, \"start\": 0, \"end\": 6.283185307179586}]}]}",
         NARC_ERROR_SIZE, 3, 1e9, "line 3: shape 'a': the shape's bounding radius"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        narc_shape_list *list = (narc_shape_list *)(void *)&list;
        const void *before = list;
        narc_error error = {.message = "?"};
        uint32_t index = 99;
        AUTO(narc_destroy_shapes_at) narc_shapes *store = empty_store();
        const narc_status status = read_exactly(wrong[k].text, strlen(wrong[k].text), NULL, store, &list, &error);
        expect_error(status, wrong[k].status, &error, wrong[k].message);
        assert_int_equal(error.index, wrong[k].line);
        assert_true(wrong[k].value == 0 || error.value == wrong[k].value);
        assert_int_equal(read_exactly(wrong[k].text, strlen(wrong[k].text), NULL, store, &list, NULL), status);
        assert_ptr_equal(list, before);
        /* The store is as it was. */
        assert_int_equal(narc_add_shape(store, &(narc_arc){0, 0, 1, 0, 6.283185307179586}, 1, &index, NULL), NARC_OK);
        assert_int_equal(index, 0);
    }
}

static void *never(size_t size, void *context) {
    (void)size, (void)context;
    return NULL;
}

TEST(writes_nothing_wrong) {
    const narc_arc disc = {0, 0, 1, 0, 6.283185307179586}, half = {0, 0, 1, 0, 3};
    const narc_named_shape good = {"a", &disc, 1, {0, 0}, 0, NARC_FORM_SHAPE};
    narc_named_shape shapes[2] = {good, good};
    char *text = NULL;
    size_t size = 7;
    narc_error error;
    expect_error(narc_write_shapes(NULL, 1, NULL, &text, &size, &error), NARC_ERROR_ARGUMENT, &error, "shapes is NULL");
    expect_error(narc_write_shapes(shapes, 1, NULL, NULL, &size, &error), NARC_ERROR_ARGUMENT, &error, "out_text");
    expect_error(narc_write_shapes(shapes, 1, NULL, &text, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_size");
    expect_error(narc_write_shapes(shapes, 1, &(narc_allocator){.allocate = never}, &text, &size, &error),
                 NARC_ERROR_ARGUMENT, &error, "allocator");
    expect_error(narc_write_shapes(shapes, 0, NULL, &text, &size, &error), NARC_ERROR_COUNT, &error, "no shape");
    expect_error(narc_write_shapes(shapes, 2, NULL, &text, &size, &error), NARC_ERROR_FORMAT, &error,
                 "shape 1: another shape has that name 'a'");
    assert_int_equal(error.index, 1);
    static const char *const names[] = {"", " b", "b ", "b,c", "b\"c", "b\nc", "\xc3", "0", "99999999999999999999"};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        shapes[1].name = names[k];
        expect_error(narc_write_shapes(shapes, 2, NULL, &text, &size, &error), NARC_ERROR_FORMAT, &error,
                     "shape 1: a name");
    }
    shapes[1] = (narc_named_shape){"b", &half, 1, {0, 0}, 0, NARC_FORM_SHAPE};
    expect_error(narc_write_shapes(shapes, 2, NULL, &text, &size, &error), NARC_ERROR_SWEEP, &error, "shape 'b': ");
    shapes[1] = (narc_named_shape){"b", &disc, 1, {0, NAN}, 0, NARC_FORM_SHAPE};
    expect_error(narc_write_shapes(shapes, 2, NULL, &text, &size, &error), NARC_ERROR_NOT_FINITE, &error, "origin");
    shapes[1] = (narc_named_shape){"b", NULL, 1, {0, 0}, 0, NARC_FORM_SHAPE};
    expect_error(narc_write_shapes(shapes, 2, NULL, &text, &size, &error), NARC_ERROR_ARGUMENT, &error, "arcs is NULL");
    narc_shape_list *list = NULL;
    expect_error(narc_read_shapes(NULL, 0, NULL, NULL, &list, &error), NARC_ERROR_ARGUMENT, &error, "data is NULL");
    expect_error(narc_read_shapes("{}", 2, NULL, NULL, NULL, &error), NARC_ERROR_ARGUMENT, &error,
                 "out_shapes is NULL");
    expect_error(narc_read_shapes("{}", 2, &(narc_allocator){.allocate = never}, NULL, &list, &error),
                 NARC_ERROR_ARGUMENT, &error, "allocator");
    assert_true(!text && size == 7 && !list);
}

/* ---------------------------------------------------------------------------- damage */

/* Whatever the bytes, shapes come out that can be written and read again, or an error whose line there is; then the store
 * is as before. */
TEST(survives_damage) {
    struct test_random random = test_random_named("damaged shapes files");
    size_t read = 0;
    const size_t trials = test_trials(20000);
    for (size_t trial = 0; trial < trials; trial++) {
        char text[sizeof every_form + 8];
        memcpy(text, every_form, sizeof every_form);
        const size_t size = random_damage(&random, text, sizeof every_form - 1);
        narc_shape_list *list = NULL;
        narc_error error = {.status = NARC_OK};
        AUTO(narc_destroy_shapes_at) narc_shapes *store = empty_store();
        const narc_status status = read_exactly(text, size, NULL, store, &list, &error);
        size_t lines = 1;
        for (size_t i = 0; i < size; i++)
            lines += text[i] == '\n';
        if (status) {
            assert_true(!list && error.index <= lines && status != NARC_ERROR_MEMORY && status != NARC_ERROR_ARGUMENT);
            uint32_t index = 99;
            assert_int_equal(narc_add_shape(store, &(narc_arc){0, 0, 1, 0, 6.283185307179586}, 1, &index, NULL),
                             NARC_OK);
            assert_int_equal(index, 0);
        } else {
            assert_int_equal(narc_count_shapes(store), list->count);
            expect_round_trip(list->items, list->count);
            narc_destroy_shape_list(list);
            read++;
        }
    }
    assert_true(read > trials / 20 && read < trials - trials / 4); /* both sorts are really met */
}

/* ---------------------------------------------------------------------------- memory that runs out */

/* Each of the caller's allocations fails, and all behind it: those of the list, then those of the store. */
TEST(tells_missing_memory) {
    for (int of_store = 0; of_store < 2; of_store++) {
        size_t failures = 0;
        for (narc_status status = NARC_ERROR_MEMORY; status; failures += status != NARC_OK) {
            struct ledger ledger = {.limited = true, .left = failures + (size_t)of_store};
            const narc_allocator allocator = ledger_allocator(&ledger);
            narc_shapes *store = NULL;
            narc_shape_list *list = NULL;
            narc_error error = {.status = NARC_OK};
            assert_int_equal(narc_create_shapes(of_store ? &allocator : NULL, &store), NARC_OK);
            status =
                read_exactly(every_form, sizeof every_form - 1, of_store ? NULL : &allocator, store, &list, &error);
            if (status) {
                expect_error(status, NARC_ERROR_MEMORY, &error, "");
                uint32_t index = 99;
                ledger.left = 100;
                assert_int_equal(narc_add_shape(store, &(narc_arc){0, 0, 1, 0, 6.283185307179586}, 1, &index, NULL),
                                 NARC_OK);
                assert_int_equal(index, 0);
            }
            narc_destroy_shape_list(list);
            narc_destroy_shapes(store);
            assert_int_equal(ledger.live, 0);
        }
        assert_true(failures > (of_store ? 1 : FORMS + 1));
    }
    AUTO(narc_destroy_shape_list_at) narc_shape_list *list = read_text(every_form, NULL);
    size_t failures = 0;
    for (narc_status status = NARC_ERROR_MEMORY; status; failures += status != NARC_OK) {
        struct ledger ledger = {.limited = true, .left = failures};
        const narc_allocator allocator = ledger_allocator(&ledger);
        char *text = NULL;
        size_t size = 0;
        narc_error error;
        status = narc_write_shapes(list->items, FORMS, &allocator, &text, &size, &error);
        if (status)
            expect_error(status, NARC_ERROR_MEMORY, &error, "");
        assert_true((text != NULL) == (status == NARC_OK));
        if (text)
            allocator.release(text, &ledger);
        assert_int_equal(ledger.live, 0);
    }
    assert_true(failures > 2); /* a store, names, a text */
}

#ifndef _WIN32 /* where the library has a cJSON of its own */
static size_t json_left;

static void *take_for_json(size_t size) {
    if (json_left-- > 0)
        return malloc(size);
    json_left = 0;
    errno = ENOMEM;
    return NULL;
}

/* So does each of cJSON's. */
TEST(tells_missing_memory_of_json) {
    size_t failures = 0;
    cJSON_InitHooks(&(cJSON_Hooks){take_for_json, free});
    for (narc_status status = NARC_ERROR_MEMORY; status; failures += status != NARC_OK) {
        AUTO(narc_destroy_shape_list_at) narc_shape_list *list = NULL;
        narc_error error = {.status = NARC_OK};
        json_left = failures;
        status = read_exactly(every_form, sizeof every_form - 1, NULL, NULL, &list, &error);
        if (status)
            expect_error(status, NARC_ERROR_MEMORY, &error, "not enough memory for JSON");
    }
    cJSON_InitHooks(NULL);
    assert_true(failures > 50);
}
#endif

TEST_MAIN("shapes_files")
