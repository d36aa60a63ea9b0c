/* SPDX-License-Identifier: MIT
 *
 * questions.h - what a batch of pairs can be asked for. A test that is the same for all questions is a program once with
 * those of narc.h, and once with those of narc_methods.h.
 */
#ifndef NARC_TEST_QUESTIONS_H
#define NARC_TEST_QUESTIONS_H

#include "scene.h"

/* A call. */
struct asked {
    const void *shapes; /* by take_shapes() */
    const narc_bodies *bodies;
    const narc_pairs *pairs;
    const narc_query *query;
    void *rows; /* or bits */
    size_t capacity, *out_count;
    uint8_t *outcomes; /* for whoever has any, one for each pair */
};

struct question {
    const char *name;
    narc_status (*ask)(const struct question *question, const struct asked *asked, narc_error *error);
    size_t row_size;     /* of rows, which begin with their pair's number; 0: bits */
    const void *options; /* the question's own */
    bool polygons;       /* of polygons alone */
    bool every_layout;   /* each number of pairs in each layout; or each in one */
};

/* Each program has its own. */
extern const struct question questions[];
extern const size_t question_count;

/* What the questions want of a store, in memory of the allocator, and what messages call it. */
const void *take_shapes(const narc_shapes *store, const narc_allocator *allocator);
void release_shapes(const void *shapes);
extern const char *const shapes_name;

/* make_random_scene(), of polygons if the question wants them. */
struct scene make_question_scene(struct test_random *random, const struct question *question, narc_precision precision,
                                 size_t bodies, size_t pairs);

/* What a call leaves behind. */
struct answer {
    void *rows;
    size_t count, skipped;
    uint8_t *outcomes;
};

/* Asks of all pairs of a scene. Outputs are full of junk before; any error fails the test. */
struct answer ask_scene(const struct question *question, const struct scene *scene, narc_query query);
void destroy_answer(struct answer *answer);

/* The bytes of an answer with so many pairs, or rows. */
size_t answer_size(const struct question *question, size_t count);

/* Row k, and the number of its pair. */
static inline void *answer_row(const struct question *question, const void *rows, size_t k) {
    return (char *)(uintptr_t)rows + k * question->row_size;
}
static inline uint32_t *answer_pair(const struct question *question, const void *rows, size_t k) {
    return answer_row(question, rows, k);
}

#endif
