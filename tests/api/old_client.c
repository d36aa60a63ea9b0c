/* SPDX-License-Identifier: MIT
 *
 * old_client.c - a program that was compiled with the headers of 0.3.0: it has its own copy of what it uses of them, as
 * it was then, and asks the library of today. What is below stays as it is for as long as the library's SONAME does.
 */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* ------------------------------------------------------------------------------------------------ 0.3.0 */

typedef struct {
    int status;
    size_t index;
    double value;
    char message[192];
} error_030;

typedef struct {
    double center_x, center_y, radius, start, end;
} arc_030;

typedef struct {
    const void *base;
    ptrdiff_t stride;
} column_030;

typedef struct {
    const void *base;
    ptrdiff_t stride;
    int precision;
} position_column_030;

typedef struct {
    size_t count;
    position_column_030 x, y;
    column_030 cosine, sine, scale, shape;
    void *reserved[2];
} bodies_030;

typedef struct {
    size_t count;
    column_030 a, b;
    const bodies_030 *other_bodies;
    column_030 shift_x, shift_y;
    void *reserved[2];
} pairs_030;

typedef struct {
    void *context;
    unsigned count;
    void (*run)(void *context, unsigned task_count, void (*task)(void *argument, unsigned index), void *argument);
} workers_030;

typedef struct {
    float margin, second_margin, flat_angle;
    uint32_t dense;
    column_030 margins, hints, selection;
    size_t selection_count, first, count;
    ptrdiff_t row_stride;
    const workers_030 *workers;
    size_t *out_skipped;
    void *reserved[4];
} query_030;

typedef struct {
    uint32_t pair;
    uint16_t feature, count;
    float separation, normal_x, normal_y, point_x, point_y, radius_a, radius_b;
} contact_030;

typedef struct {
    uint32_t pair, count;
    float normal_x, normal_y, radius_a, radius_b;
    uint16_t reach_a[2], reach_b[2];
    struct {
        float x, y, separation;
        uint32_t feature;
    } point[2];
} manifold_030;

typedef struct {
    column_030 kind, category, mask, group;
    void *reserved[2];
} filter_030;

typedef struct {
    float margin, skin;
    column_030 motion_x, motion_y, reach, id;
    const filter_030 *filter;
    const workers_030 *workers;
    void *reserved[4];
} pair_options_030;

typedef struct {
    uint32_t pair, a, b, marks;
    uint64_t id_a, id_b;
} lost_pair_030;

typedef struct {
    pairs_030 pairs;
    const uint32_t *previous;
    const uint8_t *marks;
    const uint32_t *contacts;
    size_t contact_count;
    const uint32_t *sensors;
    size_t sensor_count;
    const uint32_t *added;
    size_t added_count;
    const lost_pair_030 *lost;
    size_t lost_count;
    size_t skipped;
    bool kept;
} pair_list_030;

enum { OK_030 = 0, ERROR_ARGUMENT_030 = 1, ERROR_INDEX_030 = 3, ERROR_CAPACITY_030 = 4, MAX_ARCS_030 = 64 };
enum { STATIC_030 = 1, FEATURE_EDGE_030 = 0x40, NO_MATCH_030 = -1 };

int narc_create_shapes(const void *allocator, void **out_shapes);
void narc_destroy_shapes(void *shapes);
int narc_build_box(double width, double height, double radius, arc_030 *out_arcs, size_t *out_count, error_030 *error);
int narc_add_shape(void *shapes, const arc_030 *arcs, size_t count, uint32_t *out_shape, error_030 *error);
int narc_find_overlaps(const void *shapes, const bodies_030 *bodies, const pairs_030 *pairs, const query_030 *query,
                       uint64_t *out_bits, error_030 *error);
int narc_find_contacts(const void *shapes, const bodies_030 *bodies, const pairs_030 *pairs, const query_030 *query,
                       contact_030 *out_rows, size_t capacity, size_t *out_count, error_030 *error);
int narc_find_manifolds(const void *shapes, const bodies_030 *bodies, const pairs_030 *pairs, const query_030 *query,
                        manifold_030 *out_rows, size_t capacity, size_t *out_count, error_030 *error);
int narc_create_broad_phase(const void *allocator, void **out_broad);
void narc_destroy_broad_phase(void *broad);
int narc_update_pairs(void *broad, const void *shapes, const bodies_030 *bodies, const pair_options_030 *options,
                      const pair_list_030 **out_list, error_030 *error);

/* ------------------------------------------------------------------------------------------------ the client */

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "old_client.c:%d: %s\n", __LINE__, #condition);                                            \
            exit(1);                                                                                                   \
        }                                                                                                              \
    } while (0)

/* Five boxes in a row, 2 wide, whose sides overlap by 0.5; but the last is 0.1 away. */
enum { BODIES = 5, PAIRS = 4 };
struct body {
    double x, y;
    float cosine, sine, motion;
    uint32_t shape;
    uint64_t id;
    uint8_t kind;
};

static void run(void *context, unsigned task_count, void (*task)(void *argument, unsigned index), void *argument) {
    *(unsigned *)context += task_count;
    for (unsigned index = 0; index < task_count; index++)
        task(argument, index);
}

static bool near(float a, double b) { return fabs((double)a - b) < 1e-5; }

static void ask_contacts(const void *shapes, const bodies_030 *bodies, const pairs_030 *pairs) {
    struct {
        contact_030 contact;
        uint32_t after;
    } row[PAIRS];
    const float margins[PAIRS] = {0, 0, 0, 1};
    const uint32_t selection[] = {3, 1};
    uint32_t hints[PAIRS] = {0};
    unsigned tasks = 0;
    size_t found = 0, skipped = 9;
    workers_030 workers = {&tasks, 4, run};
    query_030 query = {.margins = {margins, sizeof margins[0]},
                       .hints = {hints, sizeof hints[0]},
                       .selection = {selection, sizeof selection[0]},
                       .selection_count = 2,
                       .row_stride = sizeof row[0],
                       .workers = &workers,
                       .out_skipped = &skipped};
    error_030 error;
    for (int k = 0; k < PAIRS; k++)
        row[k].after = 77;
    CHECK(narc_find_contacts(shapes, bodies, pairs, &query, &row[0].contact, PAIRS, &found, &error) == OK_030);
    CHECK(found == 2 && skipped == 0 && row[0].after == 77 && row[1].after == 77);
    CHECK(row[0].contact.pair == 3 && near(row[0].contact.separation, 0.1) && row[0].contact.count == 1);
    CHECK(row[1].contact.pair == 1 && near(row[1].contact.separation, -0.5));
    CHECK(near(row[1].contact.normal_x, 1) && near(row[1].contact.normal_y, 0) && near(row[1].contact.point_x, 0.75));
    CHECK((row[1].contact.feature & FEATURE_EDGE_030) && isinf(row[1].contact.radius_a));

    query = (query_030){.margin = 0.2f, .first = 1, .count = 3, .dense = 1};
    contact_030 dense[PAIRS] = {{.pair = 99}};
    CHECK(narc_find_contacts(shapes, bodies, pairs, &query, dense, PAIRS, &found, &error) == OK_030);
    CHECK(found == 3 && dense[0].pair == 99 && dense[1].pair == 1 && dense[3].pair == 3 && dense[3].count == 1);
    CHECK(narc_find_contacts(shapes, bodies, pairs, NULL, dense, 1, &found, &error) == ERROR_CAPACITY_030);
    CHECK(found == 3 && error.status == ERROR_CAPACITY_030 && error.value == 3.0 && error.message[0]);

    uint64_t bits = 0;
    CHECK(narc_find_overlaps(shapes, bodies, pairs, NULL, &bits, &error) == OK_030 && bits == 7);
    query = (query_030){.first = 3};
    CHECK(narc_find_overlaps(shapes, bodies, pairs, &query, &bits, &error) == ERROR_ARGUMENT_030);
}

static void ask_manifolds(const void *shapes, const bodies_030 *bodies, const pairs_030 *pairs) {
    manifold_030 rows[PAIRS];
    size_t found = 0;
    error_030 error;
    query_030 query = {.margin = 0.2f, .second_margin = 0.3f};
    CHECK(narc_find_manifolds(shapes, bodies, pairs, &query, rows, PAIRS, &found, &error) == OK_030 && found == PAIRS);
    for (uint32_t k = 0; k < PAIRS; k++) {
        CHECK(rows[k].pair == k && rows[k].count == 2 && near(rows[k].normal_x, 1) && near(rows[k].normal_y, 0));
        for (int p = 0; p < 2; p++)
            CHECK(near(rows[k].point[p].separation, k < 3 ? -0.5 : 0.1) && near(fabsf(rows[k].point[p].y), 0.75));
    }
    query.flat_angle = -1;
    CHECK(narc_find_manifolds(shapes, bodies, pairs, &query, rows, PAIRS, &found, &error) == OK_030);
    CHECK(found == PAIRS && rows[0].count == 1 && rows[0].point[1].separation == 0 && rows[0].reach_a[0] == 0);

    /* The other set of bodies, and shifts: all 1.5 to the left, and then another 0.1. */
    const double x = -1.5, y = 0;
    const float one = 1, zero = 0, shift[] = {-0.1f, -100};
    const uint32_t shape = 0;
    const bodies_030 other = {
        .count = 2, .x = {&x, 0, 1}, .y = {&y, 0, 1}, .cosine = {&one, 0}, .sine = {&zero, 0}, .shape = {&shape, 0}};
    const pairs_030 shifted = {
        .count = 2, .other_bodies = &other, .shift_x = {shift, sizeof shift[0]}, .shift_y = {&zero, 0}};
    CHECK(narc_find_manifolds(shapes, bodies, &shifted, NULL, rows, PAIRS, &found, &error) == OK_030);
    CHECK(found == 1 && near(rows[0].normal_x, -1) && near(rows[0].point[0].separation, -0.4));
}

static void ask_pairs(const void *shapes, struct body *body, const bodies_030 *bodies) {
    const ptrdiff_t stride = sizeof body[0];
    const filter_030 filter = {.kind = {&body[0].kind, stride}};
    unsigned tasks = 0;
    const workers_030 workers = {&tasks, 2, run};
    const pair_options_030 options = {.margin = 0.2f,
                                      .skin = 0.05f,
                                      .motion_x = {&body[0].motion, stride},
                                      .id = {&body[0].id, stride},
                                      .filter = &filter,
                                      .workers = &workers};
    void *broad = NULL;
    const pair_list_030 *list = NULL;
    error_030 error;
    CHECK(narc_create_broad_phase(NULL, &broad) == OK_030);
    CHECK(narc_update_pairs(broad, shapes, bodies, &options, &list, &error) == OK_030);
    CHECK(list->pairs.count == PAIRS && list->added_count == PAIRS && list->contact_count == PAIRS && !list->kept);
    CHECK(list->previous[0] == (uint32_t)NO_MATCH_030 && list->marks[3] == STATIC_030 && list->sensor_count == 0);
    ask_manifolds(shapes, bodies, &list->pairs);
    CHECK(narc_update_pairs(broad, shapes, bodies, &options, &list, &error) == OK_030);
    CHECK(list->kept && list->lost_count == 0 && list->added_count == 0 && list->previous[2] == 2);

    body[0].x = -50;
    CHECK(narc_update_pairs(broad, shapes, bodies, &options, &list, &error) == OK_030);
    CHECK(!list->kept && list->pairs.count == PAIRS - 1 && list->lost_count == 1 && list->skipped == 0);
    CHECK(list->lost[0].pair == 0 && list->lost[0].id_a == 100 && list->lost[0].id_b == 101 && list->lost[0].b == 1);
    narc_destroy_broad_phase(broad);
}

int main(void) {
    void *shapes = NULL;
    arc_030 arcs[MAX_ARCS_030];
    size_t arc_count = 0;
    uint32_t shape = 9;
    error_030 error;
    CHECK(narc_create_shapes(NULL, &shapes) == OK_030);
    CHECK(narc_build_box(2, 2, 0.25, arcs, &arc_count, &error) == OK_030 && arc_count == 4);
    CHECK(narc_add_shape(shapes, arcs, arc_count, &shape, &error) == OK_030 && shape == 0);

    struct body body[BODIES];
    struct pair {
        uint32_t a, b;
    } pair[PAIRS];
    for (uint32_t k = 0; k < BODIES; k++)
        body[k] =
            (struct body){.x = k < 4 ? 1.5 * k : 6.6, .cosine = 1, .id = 100 + k, .kind = k == 4 ? STATIC_030 : 0};
    for (uint32_t k = 0; k < PAIRS; k++)
        pair[k] = (struct pair){k, k + 1};
    const ptrdiff_t stride = sizeof body[0];
    bodies_030 bodies = {.count = BODIES,
                         .x = {&body[0].x, stride, 1},
                         .y = {&body[0].y, stride, 1},
                         .cosine = {&body[0].cosine, stride},
                         .sine = {&body[0].sine, stride},
                         .shape = {&body[0].shape, stride}};
    const pairs_030 pairs = {.count = PAIRS, .a = {&pair[0].a, sizeof pair[0]}, .b = {&pair[0].b, sizeof pair[0]}};
    ask_contacts(shapes, &bodies, &pairs);
    ask_manifolds(shapes, &bodies, &pairs);
    ask_pairs(shapes, body, &bodies);
    bodies.count = BODIES - 1;
    CHECK(narc_find_overlaps(shapes, &bodies, &pairs, NULL, &(uint64_t){0}, &error) == ERROR_INDEX_030);
    CHECK(error.index == 3);
    narc_destroy_shapes(shapes);
    puts("a client of 0.3.0 gets its answers");
}
