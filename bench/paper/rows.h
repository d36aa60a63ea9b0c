/* SPDX-License-Identifier: MIT
 *
 * rows.h - what is timed: a question asked by a method of all pairs of one or more frames.
 */
#ifndef NARC_PAPER_ROWS_H
#define NARC_PAPER_ROWS_H

#include "situations.h"

enum question { QUESTION_OVERLAP, QUESTION_CONTACT, QUESTIONS };

enum { MAX_REPETITIONS = 16, MAX_FRAMES = 8 };

struct row {
    const narc_methods *methods;
    const struct body *frames[MAX_FRAMES]; /* each is asked about in turn; one frame: a scene that stands still */
    size_t frame_count, pair_count;
    enum question question;
    narc_method_options options;
    narc_query query;
    const char *isa;
    int claim; /* what every answer must be: 1 colliding, 0 apart, -1: not known */

    size_t wrong;  /* answers that are not what `claim` says */
    size_t passes; /* over all frames, in one repetition */
    double times[MAX_REPETITIONS];
    double ns, spread; /* of one check: the median, and how far the middle half of the repetitions lies apart */
};

/* "3/40 what" on stderr; the number of steps is set once. */
void set_steps(int count);
void begin_step(const char *what);

struct rows {
    struct row *list;
    size_t count, capacity;
};

/* The index of the row in the list. */
size_t add_row(struct rows *rows, struct row row);

/* Row of a scene. */
struct row row_of(const struct scene *scene, enum kind kind, enum question question, narc_method method,
                  const char *isa);

/* Times all rows, one thread. Repetition after repetition goes through all rows, each time in another random order; in
 * each a row runs for `least_time` ns or once. The row's time is the median of its repetitions. */
void time_rows(struct rows *rows, int repetitions, double least_time, uint64_t *random);

#endif
