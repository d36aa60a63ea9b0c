/* SPDX-License-Identifier: MIT
 *
 * questions.c - asks the questions of a program.
 */
#include "questions.h"

#include <stdlib.h>
#include <string.h>

struct scene make_question_scene(struct test_random *random, const struct question *question, narc_precision precision,
                                 size_t bodies, size_t pairs) {
    struct scene scene = make_random_scene(random, precision, bodies, pairs);
    uint32_t polygon[4 * FAMILY_COUNT], count = 0;
    assert_true(scene.shape_count <= 4 * FAMILY_COUNT);
    for (uint32_t k = 0; k < scene.shape_count; k++)
        if (narc_shape_flags(scene.store, k) & NARC_SHAPE_POLYGON)
            polygon[count++] = k;
    assert_true(count > 3);
    for (size_t k = 0; k < bodies && question->polygons; k++)
        scene.bodies[k].shape = polygon[k % count];
    return scene;
}

size_t answer_size(const struct question *question, size_t count) {
    return question->row_size ? count * question->row_size : NARC_BIT_WORDS(count) * sizeof(uint64_t);
}

struct answer ask_scene(const struct question *question, const struct scene *scene, narc_query query) {
    const size_t count = scene->pair_count;
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const void *shapes = take_shapes(scene->store, NULL);
    struct answer answer = {.rows = make_junk(answer_size(question, count)), .outcomes = make_junk(count)};
    query.out_skipped = &answer.skipped;
    const struct asked asked = {shapes, &bodies, &pairs, &query, answer.rows, count, &answer.count, answer.outcomes};
    narc_error error;
    if (question->ask(question, &asked, &error) != NARC_OK)
        fail_msg("%s: %s", question->name, error.message);
    release_shapes(shapes);
    return answer;
}

void destroy_answer(struct answer *answer) {
    free(answer->rows);
    free(answer->outcomes);
}
