/* SPDX-License-Identifier: MIT
 *
 * frames.c - GJK from the last frame's simplex (a warm start) against GJK from nothing, while bodies move.
 *
 * Half of the pairs are those of the scene without collisions, half of that with them, in turn. The second body of each
 * goes round a regular octagon whose first corner is where that scene has it, in a random direction, one side in a
 * frame, and turns as far to and fro: eight frames, after which all is as at first, so that a run may have any length
 * and every step is as long as every other.
 */
#include <math.h>
#include <stdlib.h>

#include "paper.h"
#include "random.h"

/* One side of the octagon in parts of half the sum of both bounding radii; the turn in radians. */
static const double motions[MOTIONS] = {0, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3};

static const char *const starts[STARTS] = {"GJK, cold", "GJK, warm", "exact SAT", "exact SAT with hints"};

double motion_of(size_t index) { return motions[index]; }

/* ------------------------------------------------------------------------------------------------ scenes */

struct moving {
    const struct templates *templates;
    size_t pair_count;
    struct body *frames[MAX_FRAMES];
};

/* The second body of a pair, frame after frame. */
static void move_second(const struct moving *moving, size_t place, double motion, uint64_t *random) {
    const struct body *start = &moving->frames[0][place];
    const double heading = random_between(random, -pi, pi), side = random_unit(random) < 0.5 ? -1 : 1;
    const double length = motion * size_of(moving->templates->bounds[KIND_ARC], start - 1) / 2;
    const double angle = atan2((double)start->sine, (double)start->cosine);
    double x = start->x, y = start->y, turn = 0;
    for (int frame = 1; frame < MAX_FRAMES; frame++) {
        const double direction = heading + side * 2 * pi / MAX_FRAMES * frame;
        struct body *pose = &moving->frames[frame][place];
        x += length * cos(direction);
        y += length * sin(direction);
        turn += frame <= MAX_FRAMES / 2 ? motion : -motion;
        *pose = *start;
        pose->x = (float)x;
        pose->y = (float)y;
        pose->cosine = (float)cos(angle + turn);
        pose->sine = (float)sin(angle + turn);
    }
}

static struct moving make_moving(const struct paper *paper, size_t size, double motion, uint64_t *random) {
    struct moving moving = {.templates = &paper->templates[size], .pair_count = paper->settings.pair_count / 2};
    for (int frame = 0; frame < MAX_FRAMES; frame++)
        moving.frames[frame] = allocate(2 * moving.pair_count, sizeof(struct body));
    for (size_t k = 0; k < moving.pair_count; k++) {
        const struct body *pair = &paper->scenes[size][k % SITUATIONS].bodies[2 * k];
        moving.frames[0][2 * k] = pair[0];
        moving.frames[0][2 * k + 1] = pair[1];
        for (int frame = 1; frame < MAX_FRAMES; frame++)
            moving.frames[frame][2 * k] = pair[0];
        move_second(&moving, 2 * k + 1, motion, random);
    }
    return moving;
}

/* ------------------------------------------------------------------------------------------------ rows */

static size_t add_moving_row(struct paper *paper, const struct moving *moving, enum question question, enum start start,
                             const char *isa) {
    struct row row = {.methods = moving->templates->methods[KIND_ARC],
                      .frame_count = MAX_FRAMES,
                      .pair_count = moving->pair_count,
                      .question = question,
                      .options = {.method = start < SAT_COLD ? NARC_METHOD_GJK : NARC_METHOD_SAT},
                      .isa = isa,
                      .claim = -1};
    for (int frame = 0; frame < MAX_FRAMES; frame++)
        row.frames[frame] = moving->frames[frame];
    if (start == GJK_WARM || start == SAT_HINTED)
        row.query.hints = NARC_HINT_ARRAY((uint32_t *)allocate(moving->pair_count, sizeof(uint32_t)));
    return add_row(&paper->rows, row);
}

/* How many booleans of two rounds through all frames are wrong; those of the first frame of all are cold ones. */
static size_t count_wrong(const struct moving *moving, bool warm) {
    const size_t count = moving->pair_count;
    const narc_pairs pairs = neighbours(count);
    uint32_t *hints = warm ? allocate(count, sizeof *hints) : NULL;
    uint64_t *bits = allocate(NARC_BIT_WORDS(count), sizeof *bits);
    narc_contact *exact = allocate(count, sizeof *exact);
    const narc_method_options options = {.method = NARC_METHOD_GJK};
    const narc_query query = {.hints = NARC_HINT_ARRAY(hints), .workers = all_workers()};
    size_t wrong = 0;
    narc_error error;
    for (int frame = 0; frame < 2 * MAX_FRAMES; frame++) {
        const struct body *frame_bodies = moving->frames[frame % MAX_FRAMES];
        const narc_bodies bodies = bodies_of(frame_bodies, 2 * count);
        must(narc_find_overlaps_by(moving->templates->methods[KIND_ARC], &bodies, &pairs, &options, &query, bits,
                                   &error),
             &error);
        separate(moving->templates->shapes[KIND_ARC], frame_bodies, count, exact);
        for (size_t k = 0; k < count; k++)
            wrong += fabs((double)exact[k].separation) >
                         rounding_of(moving->templates->bounds[KIND_ARC], &frame_bodies[2 * k]) &&
                     (exact[k].separation < 0) != (bits[k / 64] >> k % 64 & 1);
    }
    free(exact);
    free(bits);
    free(hints);
    return wrong;
}

static void add_motions(struct paper *paper, struct frames *frames, uint64_t *random) {
    for (size_t motion = 0; motion < MOTIONS; motion++) {
        const struct moving moving = make_moving(paper, frames->moving_size, motions[motion], random);
        for (enum isa isa = 0; isa < ISAS; isa++)
            for (enum question question = 0; question < QUESTIONS; question++)
                for (enum start start = 0; start < STARTS; start++)
                    if (start != SAT_HINTED || question == QUESTION_CONTACT)
                        frames->rows[isa][question][start][motion] =
                            add_moving_row(paper, &moving, question, start, paper->isas[isa]);
        frames->wrong[0][motion] = count_wrong(&moving, false);
        frames->wrong[1][motion] = count_wrong(&moving, true);
        frames->checks = 2 * MAX_FRAMES * moving.pair_count;
    }
}

void add_frames(struct paper *paper, struct frames *frames, uint64_t *random) {
    frames->moving_size = 0;
    for (size_t size = 0; size < paper->settings.size_count; size++) {
        const struct moving moving = make_moving(paper, size, motions[SLOW_MOTION], random);
        if (paper->settings.sizes[size] == 8)
            frames->moving_size = size;
        for (enum isa isa = 0; isa < ISAS; isa++)
            for (enum question question = 0; question < QUESTIONS; question++)
                for (enum start start = 0; start <= GJK_WARM; start++)
                    frames->size_rows[isa][question][start][size] =
                        add_moving_row(paper, &moving, question, start, paper->isas[isa]);
    }
    add_motions(paper, frames, random);
}

/* ------------------------------------------------------------------------------------------------ tables */

static const char *title_of(enum question question) { return question == QUESTION_OVERLAP ? "overlap" : "contact"; }

static double motion_time(const struct paper *paper, const struct frames *frames, enum isa isa, enum question question,
                          enum start start, size_t motion) {
    return paper->rows.list[frames->rows[isa][question][start][motion]].ns;
}

static void print_motions(const struct paper *paper, const struct frames *frames, FILE *out) {
    fprintf(out,
            "\n### Moving pairs, %zu-arcs: µs for 1,000 checks by the motion in a frame, in parts of the size and in "
            "radians\n\n| | |",
            paper->settings.sizes[frames->moving_size]);
    for (size_t motion = 0; motion < MOTIONS; motion++)
        fprintf(out, " %g |", motions[motion]);
    fprintf(out, "\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    for (enum question question = 0; question < QUESTIONS; question++)
        for (enum start start = 0; start < STARTS; start++)
            for (int isa = ISAS - 1; isa >= 0 && (start != SAT_HINTED || question == QUESTION_CONTACT); isa--) {
                fprintf(out, "| %s, %s | %s |", title_of(question), starts[start], paper->isas[isa]);
                for (size_t motion = 0; motion < MOTIONS; motion++)
                    fprintf(out, " %.1f |", motion_time(paper, frames, (enum isa)isa, question, start, motion));
                fputc('\n', out);
            }
    for (int warm = 0; warm < 2; warm++) {
        fprintf(out, "| wrong overlaps of %zu, %s | any |", frames->checks, starts[warm]);
        for (size_t motion = 0; motion < MOTIONS; motion++)
            fprintf(out, " %zu |", frames->wrong[warm][motion]);
        fputc('\n', out);
    }
}

static void print_sizes(const struct paper *paper, const struct frames *frames, FILE *out) {
    char title[80];
    snprintf(title, sizeof title, "Moving pairs, motion %g: µs for 1,000 checks by n", motions[SLOW_MOTION]);
    print_sizes_head(paper, title, "| | |", "", out);
    for (enum question question = 0; question < QUESTIONS; question++)
        for (enum start start = 0; start <= GJK_WARM; start++)
            for (int isa = ISAS - 1; isa >= 0; isa--) {
                fprintf(out, "| %s, %s | %s |", title_of(question), starts[start], paper->isas[isa]);
                for (size_t size = 0; size < paper->settings.size_count; size++)
                    fprintf(out, " %.1f |", paper->rows.list[frames->size_rows[isa][question][start][size]].ns);
                fputc('\n', out);
            }
}

void print_frames(const struct paper *paper, const struct frames *frames, FILE *out) {
    print_motions(paper, frames, out);
    print_sizes(paper, frames, out);
}

/* ------------------------------------------------------------------------------------------------ plots */

static void write_question(const struct paper *paper, const struct frames *frames, enum question question,
                           const char *name) {
    FILE *file = open_result(paper->settings.folder, name);
    const int count = question == QUESTION_CONTACT ? STARTS : STARTS - 1;
    fprintf(file, "motion");
    for (int start = 0; start < count; start++)
        fprintf(file, "\t\"%s\"", starts[start]);
    for (size_t motion = 0; motion < MOTIONS; motion++) {
        fprintf(file, "\n%g", motions[motion]);
        for (int start = 0; start < count; start++)
            fprintf(file, "\t%.4g", motion_time(paper, frames, BEST, question, (enum start)start, motion));
    }
    fputc('\n', file);
    close_result(file);
}

void write_frames(const struct paper *paper, const struct frames *frames) {
    write_question(paper, frames, QUESTION_OVERLAP, "paper-warm-overlap.dat");
    write_question(paper, frames, QUESTION_CONTACT, "paper-warm-contact.dat");
}
