/* SPDX-License-Identifier: MIT
 *
 * old_client.c - a program that was compiled with the headers of 0.3.0: it has its own copy of what it uses of them, as
 * it was then, and asks the library of today. What is below stays as it is for as long as the library's SONAME does.
 */
#undef NDEBUG
#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* ------------------------------------------------------------------------------------------------ 0.3.0 */

struct error {
    int status;
    size_t index;
    double value;
    char message[192];
};
struct column {
    const void *base;
    ptrdiff_t stride;
};
struct positions {
    struct column of;
    int precision;
};
struct bodies {
    size_t count;
    struct positions x, y;
    struct column cosine, sine, scale, shape;
    void *reserved[2];
};
struct pairs {
    size_t count;
    struct column a, b;
    const struct bodies *other_bodies;
    struct column shift_x, shift_y;
    void *reserved[2];
};
struct workers {
    void *context;
    unsigned count;
    void (*run)(void *context, unsigned task_count, void (*task)(void *argument, unsigned index), void *argument);
};
struct query {
    float margin, second_margin, flat_angle;
    uint32_t dense;
    struct column margins, selection;
    size_t selection_count, first, count;
    ptrdiff_t row_stride;
    const struct workers *workers;
    size_t *out_skipped;
    void *reserved[6];
};
struct contact {
    uint32_t pair;
    uint16_t feature, count;
    float separation, normal_x, normal_y, point_x, point_y, radius_a, radius_b;
};
struct manifold {
    uint32_t pair, count;
    float normal_x, normal_y, radius_a, radius_b;
    uint16_t reach_a[2], reach_b[2];
    struct {
        float x, y, separation;
        uint32_t feature;
    } point[2];
};
struct filter {
    struct column kind, category, mask, group;
    void *reserved[2];
};
struct box {
    float min_x, min_y, max_x, max_y;
};
enum { ERROR_ARGUMENT = 1, ERROR_INDEX = 3, ERROR_CAPACITY = 4, STATIC = 1, FEATURE_EDGE = 0x40 };

typedef int create(const void *allocator, void **out_object);
typedef void destroy(void *object);
typedef int find_rows(const void *shapes, const struct bodies *, const struct pairs *, const struct query *,
                      void *out_rows, size_t capacity, size_t *out_count, struct error *);
create narc_create_shapes, narc_create_broad_phase;
destroy narc_destroy_shapes, narc_destroy_broad_phase;
find_rows narc_find_contacts, narc_find_manifolds;
int narc_build_box(double width, double height, double radius, void *out_arcs, size_t *out_count, struct error *);
int narc_add_shape(void *shapes, const void *arcs, size_t count, uint32_t *out_shape, struct error *);
int narc_find_overlaps(const void *shapes, const struct bodies *, const struct pairs *, const struct query *,
                       uint64_t *out_bits, struct error *);
int narc_compute_boxes(const void *shapes, const struct bodies *, const void *options, struct box *out_boxes,
                       struct error *);
int narc_find_pairs(void *broad, const struct box *, size_t count, const struct filter *, const struct workers *,
                    uint32_t *out_a, uint32_t *out_b, ptrdiff_t, size_t capacity, size_t *out_count, struct error *);

/* ------------------------------------------------------------------------------------------------ the client */

/* Five boxes in a row, 2 wide, whose sides overlap by 0.5; but the last is 0.1 away. */
enum { BODIES = 5, PAIRS = 4, MANY = 100000 };
static struct body {
    double x, y;
    float cosine, sine;
    uint32_t shape;
    uint8_t kind;
} body[BODIES];
static const uint32_t pair[PAIRS][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}};
#define FIELD(member)                                                                                                  \
    { &body[0].member, sizeof body[0] }
static struct bodies bodies = {BODIES, {FIELD(x), 1}, {FIELD(y), 1}, FIELD(cosine), FIELD(sine), .shape = FIELD(shape)};
static const struct pairs pairs = {PAIRS, {&pair[0][0], 8}, {&pair[0][1], 8}, .other_bodies = NULL};
static void *shapes;
static struct error error;
static size_t found, skipped = 9;

static void run(void *context, unsigned task_count, void (*task)(void *argument, unsigned index), void *argument) {
    *(unsigned *)context += task_count;
    for (unsigned index = 0; index < task_count; index++)
        task(argument, index);
}
static unsigned tasks;
static const struct workers workers = {&tasks, 4, run};

static bool near(float a, double b) { return fabs((double)a - b) < 1e-5; }

static void ask_overlaps(void) {
    static uint64_t bits[MANY / 64 + 1];
    const struct pairs many = {MANY, {&pair[2][0], 0}, {&pair[2][1], 0}, .other_bodies = NULL};
    assert(!narc_find_overlaps(shapes, &bodies, &pairs, NULL, bits, &error) && bits[0] == 7);
    assert(!narc_find_overlaps(shapes, &bodies, &many, &(struct query){.workers = &workers}, bits, &error));
    assert(tasks > 1 && bits[0] == UINT64_MAX && bits[MANY / 64] == (UINT64_C(1) << MANY % 64) - 1);
    assert(narc_find_overlaps(shapes, &bodies, &pairs, &(struct query){.first = 3}, bits, &error) == ERROR_ARGUMENT);
    bodies.count--;
    assert(narc_find_overlaps(shapes, &bodies, &pairs, NULL, bits, &error) == ERROR_INDEX && error.index == 3);
    bodies.count++;
}

static void ask_contacts(void) {
    struct {
        struct contact contact;
        uint32_t after;
    } row[PAIRS] = {{.after = 77}, {.after = 77}};
    const float margins[PAIRS] = {0, 0, 0, 1};
    const uint32_t selection[] = {3, 1};
    struct query query = {0,
                          0,
                          0,
                          0,
                          {margins, 4},
                          {selection, 4},
                          2,
                          .row_stride = sizeof row[0],
                          .workers = &workers,
                          .out_skipped = &skipped};
    assert(!narc_find_contacts(shapes, &bodies, &pairs, &query, &row[0].contact, PAIRS, &found, &error));
    assert(found == 2 && skipped == 0 && row[0].after == 77 && row[1].after == 77);
    const struct contact far = row[0].contact, c = row[1].contact;
    assert(far.pair == 3 && near(far.separation, 0.1) && far.count == 1 && c.pair == 1 && near(c.separation, -0.5));
    assert(near(c.normal_x, 1) && near(c.normal_y, 0) && near(c.point_x, 0.75));
    assert((c.feature & FEATURE_EDGE) && isinf(c.radius_a));
    query = (struct query){.margin = 0.2f, .first = 1, .count = 3, .dense = 1};
    struct contact dense[PAIRS] = {{.pair = 99}};
    assert(!narc_find_contacts(shapes, &bodies, &pairs, &query, dense, PAIRS, &found, &error) && found == 3);
    assert(dense[0].pair == 99 && dense[1].pair == 1 && dense[3].pair == 3 && dense[3].count == 1);
    assert(narc_find_contacts(shapes, &bodies, &pairs, NULL, dense, 1, &found, &error) == ERROR_CAPACITY);
    assert(found == 3 && error.status == ERROR_CAPACITY && error.value == 3.0 && error.message[0]);
}

static void ask_manifolds(const struct pairs *listed) {
    struct manifold rows[PAIRS];
    struct query query = {.margin = 0.2f, .second_margin = 0.3f};
    assert(!narc_find_manifolds(shapes, &bodies, listed, &query, rows, PAIRS, &found, &error) && found == PAIRS);
    for (uint32_t k = 0; k < 2 * PAIRS; k++) {
        const struct manifold *m = &rows[k / 2];
        assert(m->pair == k / 2 && m->count == 2 && near(m->normal_x, 1) && near(m->normal_y, 0));
        assert(near(m->point[k % 2].separation, k < 6 ? -0.5 : 0.1) && near(fabsf(m->point[k % 2].y), 0.75));
    }
    query.flat_angle = -1;
    assert(!narc_find_manifolds(shapes, &bodies, listed, &query, rows, PAIRS, &found, &error) && found == PAIRS);
    assert(rows[0].count == 1 && rows[0].point[1].separation == 0 && rows[0].reach_a[0] == 0);

    /* The other set of bodies, and shifts: all 1.5 to the left, and then another 0.1. */
    struct body left = body[0];
    const float zero = 0, shift[] = {-0.1f, -100};
    left.x = -1.5;
    const struct bodies other = {
        2, {{&left.x, 0}, 1}, {{&left.y, 0}, 1}, {&left.cosine, 0}, {&left.sine, 0}, .shape = {&left.shape, 0}};
    const struct pairs shifted = {2, .other_bodies = &other, .shift_x = {shift, sizeof *shift}, .shift_y = {&zero, 0}};
    assert(!narc_find_manifolds(shapes, &bodies, &shifted, NULL, rows, PAIRS, &found, &error) && found == 1);
    assert(near(rows[0].normal_x, -1) && near(rows[0].point[0].separation, -0.4));
}

static void ask_pairs(void) {
    const struct filter filter = {.kind = FIELD(kind)};
    struct box box[BODIES];
    uint32_t a[PAIRS], b[PAIRS];
    void *broad = NULL;
    assert(!narc_create_broad_phase(NULL, &broad));
    assert(!narc_compute_boxes(shapes, &bodies, NULL, box, &error) && near(box[0].max_x, 1));
    assert(!narc_find_pairs(broad, box, BODIES, &filter, &workers, a, b, 0, PAIRS, &found, &error) &&
           found == PAIRS - 1);
    box[4].min_x -= 0.2f;
    assert(narc_find_pairs(broad, box, BODIES, &filter, &workers, a, b, 0, 1, &found, &error) == ERROR_CAPACITY);
    assert(!narc_find_pairs(broad, box, BODIES, &filter, &workers, a, b, 0, found, &found, &error) && found == PAIRS);
    ask_manifolds(&(struct pairs){PAIRS, {a, sizeof *a}, {b, sizeof *b}, .other_bodies = NULL});
    narc_destroy_broad_phase(broad);
}

int main(void) {
    double arcs[64][5];
    size_t arc_count = 0;
    uint32_t shape = 9;
    assert(!narc_create_shapes(NULL, &shapes) && !narc_build_box(2, 2, 0.25, arcs, &arc_count, &error));
    assert(arc_count == 4 && !narc_add_shape(shapes, arcs, arc_count, &shape, &error) && shape == 0);
    for (uint32_t k = 0; k < BODIES; k++)
        body[k] = (struct body){k < 4 ? 1.5 * k : 6.6, .cosine = 1, .kind = k == 4 ? STATIC : 0};
    ask_overlaps();
    ask_contacts();
    ask_manifolds(&pairs);
    ask_pairs();
    narc_destroy_shapes(shapes);
    puts("a client of 0.3.0 gets its answers");
}
