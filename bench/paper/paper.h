/* SPDX-License-Identifier: MIT
 *
 * paper.h - the parts of the evaluation, and what they share.
 *
 * Each part first adds its rows to one list, all of which are then timed together, and afterwards prints its tables and
 * writes the data of its plots.
 */
#ifndef NARC_PAPER_H
#define NARC_PAPER_H

#include "rows.h"

enum { MAX_SIZES = 16 };

/* The two columns of most tables. */
enum isa { SCALAR, BEST, ISAS };

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
    const char *isas[ISAS];
    struct templates templates[MAX_SIZES];
    struct scene scenes[MAX_SIZES][SITUATIONS];
    struct rows rows;
};

/* ------------------------------------------------------------------------------------------------ figures 4 and 5 */

enum algorithm { ARC_SAT, ARC_FIRST, ARC_GJK, GON_SAT, GON_GJK, READING, ALGORITHMS };

/* What is asked in which scene. */
enum test { APART_OVERLAP, COLLIDING_CONTACT, COLLIDING_OVERLAP, TESTS };

struct figures {
    size_t rows[ISAS][TESTS][ALGORITHMS][MAX_SIZES];
};

void add_figures(struct paper *paper, struct figures *figures);

/* ns per check; the number of a size is its index. */
double time_of(const struct paper *paper, const struct figures *figures, enum isa isa, enum test test,
               enum algorithm algorithm, size_t size);
/* A title and the head of a table with a column for each n, behind those of `labels` and before `last`, which may be
 * "". */
void print_sizes_head(const struct paper *paper, const char *title, const char *labels, const char *last, FILE *out);

void print_figures(const struct paper *paper, const struct figures *figures, FILE *out);
void write_figures(const struct paper *paper, const struct figures *figures);

/* The exponent of a power law: the slope of the least-squares line through the logarithms, n from 8 on. NaN for fewer
 * than two sizes. */
double slope_of(const struct paper *paper, const double *times);

/* ------------------------------------------------------------------------------------------------ EPA's threshold */

enum { THRESHOLDS = 6 };

struct depth_error {
    double median, high, most; /* relative to the sum of both bounding radii; high: 99 % are below */
    size_t limit, rounding;    /* outcomes other than DONE */
};

struct epa {
    size_t rows[ISAS][KINDS][THRESHOLDS][MAX_SIZES];
    struct depth_error errors[KINDS][THRESHOLDS][MAX_SIZES];
};

double threshold_of(size_t index);
void add_epa(struct paper *paper, struct epa *epa);
void print_epa(const struct paper *paper, const struct epa *epa, FILE *out);
void write_epa(const struct paper *paper, const struct epa *epa);

/* ------------------------------------------------------------------------------------------------ steps */

/* Support points (of each body) that GJK asks for, of a scene's pairs; for contacts in the longer of its two phases. */
struct step_count {
    double mean;
    size_t most;
};

struct steps {
    struct step_count overlap[SITUATIONS][KINDS][MAX_SIZES];
    struct step_count contact[KINDS][THRESHOLDS][MAX_SIZES]; /* colliding pairs */
};

void count_steps(const struct paper *paper, struct steps *steps);
void print_steps(const struct paper *paper, const struct steps *steps, FILE *out);

/* ------------------------------------------------------------------------------------------------ perpendiculars */

/* Polygon SAT in plain C, one pair after the other, with a side's unit normal stored, or computed for each pair: for a
 * yes or no its length does not matter, for a depth it is made 1. */
enum perpendicular { STORED_YES_NO, COMPUTED_YES_NO, STORED_DEPTH, NORMALISED_DEPTH, PERPENDICULARS };

struct perpendiculars {
    double ns[PERPENDICULARS][MAX_SIZES]; /* of one check, collision scene */
};

void time_perpendiculars(const struct paper *paper, struct perpendiculars *times);
void print_perpendiculars(const struct paper *paper, const struct perpendiculars *times, FILE *out);

/* ------------------------------------------------------------------------------------------------ warm starts */

enum { MOTIONS = 7, VERY_SLOW_MOTION = 1, SLOW_MOTION = 3 };

/* How a scene of moving pairs is answered. */
enum start { GJK_COLD, GJK_WARM, SAT_COLD, SAT_HINTED, STARTS };

struct frames {
    size_t rows[ISAS][QUESTIONS][STARTS][MOTIONS];        /* of moving_size */
    size_t size_rows[ISAS][QUESTIONS][STARTS][MAX_SIZES]; /* of SLOW_MOTION; GJK only */
    size_t moving_size;                                   /* index of n = 8, or what is there */
    size_t wrong[2][MOTIONS], checks;                     /* GJK's wrong booleans, cold and warm, of so many */
};

double motion_of(size_t index);
void add_frames(struct paper *paper, struct frames *frames, uint64_t *random);
void print_frames(const struct paper *paper, const struct frames *frames, FILE *out);
void write_frames(const struct paper *paper, const struct frames *frames);

/* ------------------------------------------------------------------------------------------------ vectors */

enum lane_row {
    LANE_ARC_SAT,
    LANE_ARC_FIRST,
    LANE_ARC_GJK,
    LANE_GON_SAT,
    LANE_GON_GJK,
    LANE_CIRCLE,
    LANE_AABB,
    LANE_OBB,
    LANE_ROWS
};
enum { MAX_LANE_ISAS = 4 };

struct lanes {
    size_t size; /* index of n = 8 */
    const char *isas[MAX_LANE_ISAS];
    size_t isa_count;
    size_t rows[QUESTIONS][LANE_ROWS][MAX_LANE_ISAS];
};

/* ns of a yes or no without collision. */
double lane_time(const struct paper *paper, const struct lanes *lanes, enum isa isa, enum lane_row row);
void add_lanes(struct paper *paper, struct lanes *lanes);
void print_lanes(const struct paper *paper, const struct lanes *lanes, FILE *out);

/* ------------------------------------------------------------------------------------------------ wrong answers */

/* Asks all methods about random pairs of several families of shapes, and prints the tables. Returns the number of
 * answers that break what narc_methods.h promises. */
size_t print_answers(const struct settings *settings, uint64_t *random, FILE *out);

/* ------------------------------------------------------------------------------------------------ claims, storage */

/* All that was measured. */
struct results {
    const struct paper *paper;
    const struct figures *figures;
    const struct epa *epa;
    const struct steps *steps;
    const struct perpendiculars *perpendiculars;
    const struct lanes *lanes;
    const struct frames *frames;
};

void print_claims(const struct results *results, FILE *out);

/* Bytes of single precision that the paper's algorithms read of a shape. */
size_t arc_bytes(size_t n);
size_t gon_bytes(size_t n);
void print_storage(const struct paper *paper, FILE *out);

#endif
