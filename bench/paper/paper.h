/* SPDX-License-Identifier: MIT
 *
 * paper.h - the parts of the evaluation: scenes, rows that are timed together, and one list of all that was measured, by
 * names from which tables, plots and statements take it.
 */
#ifndef NARC_PAPER_H
#define NARC_PAPER_H

#include <stdbool.h>

#include "bodies.h"
#include "common.h"

enum { MAX_SIZES = 16, MAX_REPETITIONS = 16, FRAMES = 8 /* of moving pairs */, THRESHOLDS = 6, MOTIONS = 7 };

/* ------------------------------------------------------------------------------------------------ shapes, scenes */

/* What stands for an outline. */
enum kind { KIND_ARC, KIND_GON, KINDS };
extern const char *const kind_names[KINDS];

/* Two lists of `count` arcs of a random smooth convex outline: the n-arc and the n-gon that stand for it. */
void make_twins(uint64_t *random, size_t count, narc_arc *out_arcs, narc_arc *out_gon);

/* Random shapes, easy and hard ones, for counting wrong answers. */
enum family { FAMILY_ROUND, FAMILY_THIN, FAMILY_LENS, FAMILY_UNEQUAL, FAMILY_POLYGON, FAMILIES };
extern const char *const family_names[FAMILIES];

/* A shape with a bounding radius from 0.5 to 2 around its centroid; the number of its arcs is returned. */
size_t make_shape(enum family family, uint64_t *random, narc_arc *out_arcs);

/* Shapes in a store, with their bounding radii, and the extents that narc.h's error bound speaks of. */
struct shapes {
    size_t count;
    narc_shapes *shapes;
    narc_methods *methods;
    struct bound {
        double x, y, radius, extent;
    } * bounds;
};

struct shapes make_store(size_t capacity);
void add_arcs(struct shapes *shapes, const narc_arc *arcs, size_t count);
void finish_store(struct shapes *shapes);

/* Outline k is shape k of either store: there an n-arc, here an n-gon. */
struct templates {
    size_t n;
    struct shapes kinds[KINDS];
};

/* Pairs that never collide, pairs that always do. */
enum situation { APART, COLLIDING, SITUATIONS };
extern const char *const situation_names[SITUATIONS];

/* Pair k is of the bodies 2 k and 2 k + 1, so that what a pair reads lies together. */
struct scene {
    const struct templates *templates;
    enum situation situation;
    size_t pair_count;
    struct body *bodies;
};

struct templates make_templates(size_t n, size_t count, uint64_t *random);
struct scene make_scene(const struct templates *templates, enum situation situation, size_t pair_count,
                        uint64_t *random);

/* How far rounding may move the separation of a pair (narc.h): one closer to 0 than that may have either answer. */
double rounding_of(const struct bound *bounds, const struct body *pair);

/* The sum of both bounding radii: the unit of GJK's tolerance. */
double size_of(const struct bound *bounds, const struct body *pair);

/* ------------------------------------------------------------------------------------------------ what is measured */

struct settings {
    const char *folder;
    size_t sizes[MAX_SIZES]; /* numbers of arcs and edges, ascending */
    size_t size_count;
    size_t figure_sizes; /* how many of them the paper's figures show: up to 12 */
    size_t template_count, pair_count;
    int repetitions;
    double least_time;   /* ns */
    size_t answer_pairs; /* of each family of wrong answers */
    size_t chunk;        /* that many of them at a time */
};

struct paper {
    struct settings settings;
    const char *best; /* instruction set */
    struct templates templates[MAX_SIZES];
    struct scene scenes[MAX_SIZES][SITUATIONS];
};

extern const char *const thresholds[THRESHOLDS]; /* of EPA */
extern const char *const motions[MOTIONS];       /* of moving pairs, in a frame */

/* A number by its name, such as "apart/gjk/avx2/8", ns of a check. NaN: it was not measured. */
void put_value(double value, const char *format, ...) __attribute__((format(printf, 2, 3)));
double value_of(const char *name);

/* The same with "COL", "ISA" and "N" replaced. */
double value_at(const char *pattern, const char *column, const char *isa, size_t n);

enum question { QUESTION_OVERLAP, QUESTION_CONTACT, QUESTIONS };

/* Figures 4 and 5 on the best instruction set and on one lane, n = 8 on all; EPA by threshold; moving pairs, from last frame's simplexes and
 * without. Then all are timed, one thread: repetition after repetition goes through all rows, each time in another random
 * order. Returns the wrong booleans of methods that must have none; prints how far repetitions differ. */
void add_rows(const struct paper *paper, uint64_t *random);
size_t time_rows(const struct settings *settings, uint64_t *random, FILE *out);

/* Depths of EPA against exact ones; support points; polygon SAT with computed perpendiculars; bytes of a shape. */
void measure_depths(const struct paper *paper);
void count_points(const struct paper *paper);
void time_perpendiculars(const struct paper *paper);
void count_bytes(const struct paper *paper);

/* The number of the step and what it is, on stderr. */
void begin_step(const char *what);

/* ------------------------------------------------------------------------------------------------ what is written */

void print_claims(const struct paper *paper, FILE *out);
void print_tables(const struct paper *paper, FILE *out);
void write_plots(const struct paper *paper);

/* Asks all methods about random pairs of several families of shapes, and prints the tables. Returns the number of
 * answers that break what narc_methods.h promises. */
size_t print_answers(const struct settings *settings, uint64_t *random, FILE *out);

#endif
