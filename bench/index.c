/* SPDX-License-Identifier: MIT
 *
 * index.c - builds and refits of an index.
 */
#include "common.h"
#include "rows.h"

enum build { GOOD, FAST, REFIT };

static void run_build(struct row *row) {
    struct scene *scene = row->scene;
    const narc_index_options options = {.fast = row->question->what == FAST,
                                        .workers = row->threads > 1 ? &row->workers : NULL};
    narc_index *index = row->state;
    narc_error error;
    if (row->question->what == REFIT)
        must(narc_refit_index(index, scene->boxes, scene->body_count, &options, NULL, &error), &error);
    else
        must(narc_build_index(index, scene->boxes, scene->body_count, &options, &error), &error);
}

static void prepare_build(struct row *row) {
    narc_index *index;
    index_scene(row->scene);
    row->bench.count = row->scene->body_count;
    must(narc_create_index(NULL, &index), NULL);
    must(narc_build_index(index, row->scene->boxes, row->scene->body_count, NULL, NULL), NULL);
    row->state = index;
}

const struct question index_questions[] = {{"index-good", prepare_build, run_build, GOOD, false},
                                           {"index-fast", prepare_build, run_build, FAST, false},
                                           {"index-refit", prepare_build, run_build, REFIT, false},
                                           {.name = NULL}};
