/* SPDX-License-Identifier: MIT
 *
 * rows.c - which rows are timed, and how; and numbers by their names.
 */
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "lists.h"
#include "paper.h"
#include "random.h"

/* ------------------------------------------------------------------------------------------------ values */

static struct value {
    char name[64];
    double value;
} * values;
static size_t value_count;

void put_value(double value, const char *format, ...) {
    va_list list;
    if (value_count % 1024 == 0) {
        values = realloc(values, (value_count + 1024) * sizeof *values);
        if (!values)
            fail("out of memory");
    }
    va_start(list, format);
    vsnprintf(values[value_count].name, sizeof values->name, format, list);
    va_end(list);
    values[value_count++].value = value;
}

double value_of(const char *name) {
    for (size_t k = 0; k < value_count; k++)
        if (strcmp(values[k].name, name) == 0)
            return values[k].value;
    return NAN;
}

double value_at(const char *pattern, const char *column, const char *isa, size_t n) {
    char size[24], one[ITEM_VALUE], two[ITEM_VALUE], name[ITEM_VALUE];
    snprintf(size, sizeof size, "%zu", n);
    replace_word(pattern, "COL", column, one, sizeof one);
    replace_word(one, "ISA", isa, two, sizeof two);
    replace_word(two, "N", size, name, sizeof name);
    return value_of(name);
}

/* ------------------------------------------------------------------------------------------------ rows */

/* What is timed: a question asked by a method of all pairs of one or more frames. */
struct row {
    char name[64];
    const struct shapes *shapes;
    const struct body *frames[FRAMES]; /* each is asked about in turn; one frame: a scene that stands still */
    size_t frame_count, pair_count;
    enum question question;
    narc_method_options options;
    narc_query query;
    const char *isa;
    int claim; /* what every answer must be: 1 colliding, 0 apart, -1: not known */

    size_t passes; /* over all frames, in one repetition */
    double times[MAX_REPETITIONS];
};

static struct row *rows;
static size_t row_count;

/* Its name becomes its number's. */
static void add_row(struct row row) {
    for (size_t k = 0; k < row_count; k++)
        if (strcmp(rows[k].name, row.name) == 0)
            return;
    if (row_count % 256 == 0) {
        rows = realloc(rows, (row_count + 256) * sizeof *rows);
        if (!rows)
            fail("out of memory");
    }
    rows[row_count++] = row;
}

static struct row row_of(const struct scene *scene, enum kind kind, enum question question, narc_method method,
                         const char *isa) {
    return (struct row){.shapes = &scene->templates->kinds[kind],
                        .frames = {scene->bodies},
                        .frame_count = 1,
                        .pair_count = scene->pair_count,
                        .question = question,
                        .options = {.method = method},
                        .isa = isa,
                        .claim = scene->situation == COLLIDING};
}

static const struct algorithm {
    const char *name;
    enum kind kind;
    narc_method method;
} algorithms[] = {{"sat", KIND_ARC, NARC_METHOD_SAT},     {"first", KIND_ARC, NARC_METHOD_SAT_FIRST},
                  {"gjk", KIND_ARC, NARC_METHOD_GJK},     {"gon-sat", KIND_GON, NARC_METHOD_POLYGON_SAT},
                  {"gon-gjk", KIND_GON, NARC_METHOD_GJK}, {"circle", KIND_ARC, NARC_METHOD_CIRCLE},
                  {"aabb", KIND_ARC, NARC_METHOD_AABB},   {"obb", KIND_ARC, NARC_METHOD_OBB}};
enum { ALGORITHMS = sizeof algorithms / sizeof algorithms[0], CIRCLE = 5 };

static const struct test {
    const char *name;
    enum situation situation;
    enum question question;
} tests[] = {{"apart", APART, QUESTION_OVERLAP},
             {"contact", COLLIDING, QUESTION_CONTACT},
             {"overlap", COLLIDING, QUESTION_OVERLAP}};
enum { TESTS = sizeof tests / sizeof tests[0] };

/* Filters have no contacts; boxes are asked for n = 8 alone, and so are instruction sets between the best and one lane. */
static void add_figures(const struct paper *paper, const char *isa) {
    const bool all_sizes = strcmp(isa, paper->best) == 0 || strcmp(isa, "scalar") == 0;
    for (size_t test = 0; test < TESTS; test++)
        for (size_t k = 0; k < ALGORITHMS; k++)
            for (size_t size = 0; size < paper->settings.size_count; size++) {
                const size_t n = paper->settings.sizes[size];
                const enum question question = tests[test].question;
                const struct algorithm *a = &algorithms[k];
                if ((k >= CIRCLE && question == QUESTION_CONTACT) || (n != 8 && (!all_sizes || k > CIRCLE)))
                    continue;
                const struct scene *scene = &paper->scenes[size][tests[test].situation];
                struct row row = row_of(scene, a->kind, question, a->method, isa);
                if (k >= CIRCLE)
                    row.claim = -1;
                snprintf(row.name, sizeof row.name, "%s/%s/%s/%zu", tests[test].name, a->name, isa, n);
                add_row(row);
            }
}

static void add_thresholds(const struct paper *paper, const char *isa) {
    for (enum kind kind = 0; kind < KINDS; kind++)
        for (size_t t = 0; t < THRESHOLDS; t++)
            for (size_t size = 0; size < paper->settings.figure_sizes; size++) {
                struct row row = row_of(&paper->scenes[size][COLLIDING], kind, QUESTION_CONTACT, NARC_METHOD_GJK, isa);
                row.options.tolerance = strtof(thresholds[t], NULL);
                snprintf(row.name, sizeof row.name, "epa/%s/%s/%s/%zu", kind_names[kind], thresholds[t], isa,
                         paper->settings.sizes[size]);
                add_row(row);
            }
}

/* ------------------------------------------------------------------------------------------------ moving pairs */

/* The second body of a pair goes round a regular octagon whose first corner is where the scene has it, in a random
 * direction, one side in a frame (in parts of half the sum of both bounding radii), and turns as far to and fro: eight
 * frames, after which all is as at first, so that a run may have any length and every step is as long as every other. */
static void move_second(struct body **frames, size_t k, const struct bound *bounds, double motion, uint64_t *random) {
    const struct body *start = &frames[0][k];
    const double heading = random_between(random, -pi, pi), side = random_unit(random) < 0.5 ? -1 : 1;
    const double length = motion * size_of(bounds, start - 1) / 2;
    const double angle = atan2((double)start->sine, (double)start->cosine);
    double x = start->x, y = start->y, turn = 0;
    for (int frame = 1; frame < FRAMES; frame++) {
        const double direction = heading + side * 2 * pi / FRAMES * frame;
        x += length * cos(direction);
        y += length * sin(direction);
        turn += frame <= FRAMES / 2 ? motion : -motion;
        frames[frame][k] =
            (struct body){(float)x, (float)y, (float)cos(angle + turn), (float)sin(angle + turn), start->shape};
    }
}

/* Half of the pairs are those of the scene without collisions, half of that with them, in turn. */
static void add_moving(const struct paper *paper, size_t size, const char *motion, uint64_t *random) {
    static const struct start {
        const char *name;
        narc_method method;
        bool warm;
    } starts[] = {{"cold", NARC_METHOD_GJK, false}, {"warm", NARC_METHOD_GJK, true}, {"sat", NARC_METHOD_SAT, false}};
    const struct shapes *arcs = &paper->templates[size].kinds[KIND_ARC];
    const size_t pair_count = paper->settings.pair_count / 2;
    struct body *frames[FRAMES];
    for (int frame = 0; frame < FRAMES; frame++)
        frames[frame] = allocate(2 * pair_count, sizeof(struct body));
    for (size_t k = 0; k < pair_count; k++) {
        for (int frame = 0; frame < FRAMES; frame++)
            frames[frame][2 * k] = paper->scenes[size][k % SITUATIONS].bodies[2 * k];
        frames[0][2 * k + 1] = paper->scenes[size][k % SITUATIONS].bodies[2 * k + 1];
        move_second(frames, 2 * k + 1, arcs->bounds, strtod(motion, NULL), random);
    }
    for (int isa = 0; isa < 2; isa++)
        for (enum question question = 0; question < QUESTIONS; question++)
            for (size_t s = 0; s < sizeof starts / sizeof starts[0]; s++) {
                struct row row = {.shapes = arcs,
                                  .frame_count = FRAMES,
                                  .pair_count = pair_count,
                                  .question = question,
                                  .options = {.method = starts[s].method},
                                  .isa = isa ? "scalar" : paper->best,
                                  .claim = -1};
                memcpy(row.frames, frames, sizeof frames);
                if (starts[s].warm)
                    row.options.simplexes = allocate(pair_count, sizeof(uint32_t));
                snprintf(row.name, sizeof row.name, "moving/%s/%s/%s/%s/%zu", question ? "contact" : "overlap",
                         starts[s].name, motion, row.isa, paper->settings.sizes[size]);
                add_row(row);
            }
}

void add_rows(const struct paper *paper, uint64_t *random) {
    begin_step("rows");
    for (size_t k = 0; narc_isa_name(k); k++)
        if (narc_isa_supported(narc_isa_name(k)))
            add_figures(paper, narc_isa_name(k));
    add_thresholds(paper, paper->best);
    add_thresholds(paper, "scalar");
    for (size_t size = 0; size < paper->settings.size_count; size++)
        for (size_t motion = 0; motion < MOTIONS; motion++)
            if (paper->settings.sizes[size] == 8 || strcmp(motions[motion], "0.01") == 0)
                add_moving(paper, size, motions[motion], random);
}

/* ------------------------------------------------------------------------------------------------ timing */

/* Where answers go; large enough for any row. */
struct answers {
    uint64_t *bits;
    narc_contact *contacts;
    size_t found;
};

static void ask(const struct row *row, size_t frame, struct answers *out) {
    const narc_bodies bodies = bodies_of(row->frames[frame], 2 * row->pair_count);
    const narc_pairs pairs = neighbours(row->pair_count);
    narc_error error;
    if (row->question == QUESTION_OVERLAP)
        must(
            narc_find_overlaps_by(row->shapes->methods, &bodies, &pairs, &row->options, &row->query, out->bits, &error),
            &error);
    else
        must(narc_find_contacts_by(row->shapes->methods, &bodies, &pairs, &row->options, &row->query, out->contacts,
                                   row->pair_count, &out->found, &error),
             &error);
}

/* All frames so many times; ns. */
static double run(const struct row *row, size_t passes, struct answers *out) {
    narc_error error;
    must(narc_set_isa(row->isa, &error), &error);
    const double start = now();
    for (size_t pass = 0; pass < passes; pass++)
        for (size_t frame = 0; frame < row->frame_count; frame++)
            ask(row, frame, out);
    return now() - start;
}

/* Of moving pairs every frame is checked against exact separations, GJK's booleans alone. */
static size_t count_wrong(const struct row *row, struct answers *answers) {
    size_t hits = 0, wrong = 0;
    if (row->claim >= 0) {
        for (size_t word = 0; row->question == QUESTION_OVERLAP && word < NARC_BIT_WORDS(row->pair_count); word++)
            hits += (size_t)__builtin_popcountll(answers->bits[word]);
        if (row->question == QUESTION_CONTACT)
            hits = answers->found;
        return row->claim ? row->pair_count - hits : hits;
    }
    if (row->frame_count == 1 || row->options.method != NARC_METHOD_GJK || row->question != QUESTION_OVERLAP)
        return 0;
    for (size_t frame = 0; frame < row->frame_count; frame++) {
        ask(row, frame, answers);
        separate(row->shapes->shapes, row->frames[frame], row->pair_count, answers->contacts);
        for (size_t k = 0; k < row->pair_count; k++)
            wrong += fabs((double)answers->contacts[k].separation) >
                         rounding_of(row->shapes->bounds, &row->frames[frame][2 * k]) &&
                     (answers->contacts[k].separation < 0) != (answers->bits[k / 64] >> k % 64 & 1);
    }
    return wrong;
}

/* Where repetitions of most rows differ by more than this, something else was running. */
static const double busy = 0.1;

/* The middle half of a row's repetitions: how far apart, for the median row and for nine rows of ten. */
static void print_noise(const struct settings *settings, double *spreads, FILE *out) {
    const double median = quantile(spreads, row_count, 0.5), most = quantile(spreads, row_count, 0.9);
    if (median > busy)
        fprintf(stderr, "bench_paper: repetitions differ by %.0f %%: the machine was busy, times mean little\n",
                100 * median);
    fprintf(out,
            "%zu templates, %zu pairs, one thread; medians of %d repetitions, whose middle half lies within %.1f %% "
            "for half of the rows and within %.1f %% for nine of ten.\n",
            settings->template_count, settings->pair_count, settings->repetitions, 100 * median, 100 * most);
}

size_t time_rows(const struct settings *settings, uint64_t *random, FILE *out) {
    const size_t most = settings->pair_count, repetitions = (size_t)settings->repetitions;
    struct answers answers = {allocate(NARC_BIT_WORDS(most), sizeof(uint64_t)), allocate(most, sizeof(narc_contact)),
                              0};
    size_t *order = allocate(row_count, sizeof *order), wrong = 0;
    double *spreads = allocate(row_count, sizeof *spreads);
    begin_step("answers, and how often each row fits in a repetition");
    for (size_t k = 0; k < row_count; k++) {
        struct row *row = &rows[k];
        order[k] = k;
        run(row, 1, &answers);
        row->passes = 1 + (size_t)(settings->least_time / (run(row, 1, &answers) + 1));
        const size_t wrong_here = count_wrong(row, &answers);
        if (wrong_here > 0)
            fprintf(stderr, "bench_paper: %s: %zu answers are wrong\n", row->name, wrong_here);
        if (row->options.method != NARC_METHOD_SAT_FIRST)
            wrong += wrong_here; /* no pair is so close to touching that rounding could decide */
    }
    for (size_t repetition = 0; repetition < repetitions; repetition++) {
        begin_step("a repetition of all rows");
        for (size_t k = row_count; k > 1; k--) {
            const size_t other = random_below(random, k), kept = order[k - 1];
            order[k - 1] = order[other];
            order[other] = kept;
        }
        for (size_t k = 0; k < row_count; k++) {
            struct row *row = &rows[order[k]];
            row->times[repetition] =
                run(row, row->passes, &answers) / (double)(row->passes * row->frame_count * row->pair_count);
        }
    }
    for (size_t k = 0; k < row_count; k++) {
        double *times = rows[k].times;
        const double median = quantile(times, repetitions, 0.5);
        put_value(median, "%s", rows[k].name);
        spreads[k] = (quantile(times, repetitions, 0.75) - quantile(times, repetitions, 0.25)) / median;
    }
    print_noise(settings, spreads, out);
    return wrong;
}
