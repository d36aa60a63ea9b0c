/* SPDX-License-Identifier: MIT
 *
 * study.h - what the parts of the study share: subjects, their hulls' properties, their fits.
 */
#ifndef NARC_STUDY_H
#define NARC_STUDY_H

#include <stdio.h>

#include "hull.h"
#include "narc_fit.h"

enum { SIZES = 3 };
extern const size_t sizes[SIZES]; /* 4, 6, 8 */

typedef enum family { N_ARC, ARCS_AND_EDGES, N_GON, ROUTE, FAMILIES } family;
extern const char *const family_names[FAMILIES];
extern const narc_fit_family family_requests[FAMILIES];

typedef enum kind { PAPER, LETTERS, ANIMALS, PLANTS, TOOLS, SIGNS, GRAINS, IMAGE, KINDS } kind;
extern const char *const kind_names[KINDS];

typedef struct fit {
    bool found; /* the paper's route may find nothing */
    narc_fit_result made;
} fit;

/* n-arcs, relative to the area: larger than with more starts by so much; largest over least of the outline turned. NAN for
 * grains, which are many. */
typedef struct trial {
    double excess, spread;
} trial;

typedef struct subject {
    const char *name;
    kind of;
    uint32_t character; /* a glyph of the font, */
    const char *file;   /* or a drawing of the folder, */
    const char *image;  /* or pixels made of the subject with this name, */
    const char *sand;   /* or a grain of this sand: */
    unsigned number;    /* its number, from 1, */
    char label[24];     /* and its name */
    narc_path *path;
    narc_contours contours;
    hull around;
    double extent;         /* the larger side of the bounding box */
    double corner_share;   /* part of the full turn that the hull makes at corners */
    double straight_share; /* part of the hull's perimeter in long straight sides */
    double greedy[SIZES];  /* area of the n-gon that is left when sides are taken away one by one */
    fit fits[FAMILIES][SIZES];
    trial trials[SIZES];
} subject;

typedef struct study {
    subject *subjects; /* the paper's four come first */
    size_t count;
} study;
enum { PAPER_SUBJECTS = 4, MOST_SUBJECTS = 128 };

/* Grains are many: the first of each sand stand for them in the picture and in the table of all outlines. */
enum { SHOWN_GRAINS = 6 };

/* Relative to the hull's area; NAN if there is no such fit. */
double area_of(const subject *of, family which, size_t size);

/* Area of the n-arc over that of the n-gon. */
double ratio_of(const subject *of, size_t size);

typedef enum quantity { AREA, LARGEST, MEAN, SECONDS, QUANTITIES } quantity;

/* Area as area_of(), distances in percent of the extent; NAN if there is no such fit. */
double value_of(const subject *of, family which, size_t size, quantity what);

/* ---- subjects.c. `drawings` NULL: only the paper's four. `grains` NULL: without them. */
study load_subjects(const char *font, const char *drawings, const char *grains);
void free_subjects(study *all);

/* The bytes of a file in a folder, NULL if there is none. */
char *read_from(const char *folder, const char *name, size_t *out_size);
narc_path *make_path(void);

/* Hull and properties of a subject whose path was read. */
void measure_subject(subject *of);

/* ---- grains.c. Adds river-01.csv, river-02.csv ... and sea-01.csv ... of a folder. */
void add_grains(study *all, const char *folder);
void name_grain_file(const subject *of, char *out_name, size_t size);
void print_grains(const study *all, FILE *out);

/* ---- bounds.c. Around an outline: the least circle, boxes and 8-gon; areas relative to the hull's. */
typedef enum bound { CIRCLE, AABB, OBB, POLYGON, BOUNDS } bound;
extern const char *const bound_names[BOUNDS];
narc_fit_result find_disc(const subject *of);
void measure_bounds(const subject *of, double out_areas[BOUNDS]);
void print_bounds(const study *all, FILE *out);
void draw_bounds(const subject *of, const char *path);

/* ---- claims.c */
void print_claims(const study *all, FILE *out);

/* ---- corners.c */
void measure_corners(subject *of);
double find_greedy_area(const hull *around, size_t sides);

/* ---- fits.c. Fits all, with progress on standard error; `starts` 0: the usual number. */
void find_fits(study *all, unsigned starts);

/* No shape is smaller than the hull it must hold? If one is, it is told on standard error. */
bool check_bounds(const study *all);

/* How much two areas of one outline may differ by rounding, relative to the hull's area. */
double find_slack(const fit *of);

/* ---- trials.c. No fit is larger than one with fewer arcs? If some are, it is told on standard error. */
void find_trials(study *all, unsigned starts);
void print_trials(const study *all, FILE *out);
bool check_trials(const study *all);

/* ---- tables.c, summary.c, numbers.c, fits.c */
void print_shortfalls(const study *all, FILE *out);
void print_paper_tables(const study *all, FILE *out);
void print_verdicts(const study *all, FILE *out);
void print_all(const study *all, FILE *out);
void print_summary(const study *all, FILE *out);
void print_relation(const study *all, FILE *out);
void print_csv(const study *all, FILE *out);
void print_points(const study *all, FILE *out); /* for plots.gp */

/* ---- pictures.c */
void draw_subject(const subject *of, const char *path);
size_t count_others(const study *all); /* neither the paper's, nor grains, nor images */
void draw_others(const study *all, const char *path);
void draw_grains(const study *all, const char *path);

#endif
