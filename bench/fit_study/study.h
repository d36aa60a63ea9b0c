/* SPDX-License-Identifier: MIT
 *
 * study.h - the outlines of the study, their hulls and their fits: subjects.c.
 */
#ifndef NARC_STUDY_H
#define NARC_STUDY_H

#include <math.h>
#include <stdio.h>

#include "narc_fit.h"

#define PI 3.14159265358979323846

enum { SIZES = 3 };
extern const size_t sizes[SIZES]; /* 4, 6, 8 */

typedef enum family { N_ARC, ARCS_AND_EDGES, N_GON, ROUTE, FAMILIES } family;
extern const char *const family_names[FAMILIES];

typedef enum kind { PAPER, LETTERS, ANIMALS, PLANTS, TOOLS, SIGNS, GRAINS, KINDS } kind;
extern const char *const kind_names[KINDS];

/* Of n-arcs, relative to the area: larger than with more starts by so much; largest over least of the outline turned. NAN
 * for grains, which are many. */
typedef struct trial {
    double excess, spread;
} trial;

typedef struct fit {
    bool found; /* the paper's route may find nothing */
    narc_fit_result made;
} fit;

typedef struct subject {
    const char *name;
    kind of;
    uint32_t character; /* a glyph of the font, */
    const char *file;   /* or a drawing of the folder, */
    unsigned number;    /* or a grain: its number, from 1, */
    char label[24];     /* and its name */
    narc_path *path;
    narc_contours contours;
    narc_point *corners; /* of its hull */
    size_t corner_count;
    double hull_area, perimeter;
    double extent;         /* the larger side of the bounding box */
    double straight_share; /* part of the hull's perimeter in long straight sides */
    fit fits[FAMILIES][SIZES];
    trial trials[SIZES];
} subject;

typedef struct study {
    subject *subjects; /* the paper's four come first */
    size_t count;
} study;
enum { PAPER_SUBJECTS = 4, MOST_SUBJECTS = 128, SHOWN_GRAINS = 6 /* of each sand, in the picture */ };

/* `drawings` NULL: only the paper's four. `grains` NULL: without them. */
study load_subjects(const char *font, const char *drawings, const char *grains);
void free_subjects(study *all);

/* Those of a kind, or for KINDS all but the grains, which are more than all others; returns how many. */
size_t pick(const study *all, kind which, const subject **out_some);

/* Relative to the hull's area, in percent of the extent, or in seconds; NAN if there is no such fit. */
typedef enum quantity { AREA, LARGEST, MEAN, SECONDS, QUANTITIES } quantity;
double value_of(const subject *of, family which, size_t size, quantity what);

/* Area of the n-arc over that of the n-gon. */
double ratio_of(const subject *of, size_t size);

narc_path *make_path(void);

/* The least circle around an outline, boxes, and the 8-gon, which was fitted: corners of boxes, and areas, hull = 1. */
typedef enum bound { CIRCLE, AABB, OBB, POLYGON, BOUNDS } bound;
extern const char *const bound_names[BOUNDS];
typedef struct bounds {
    narc_fit_result circle;
    narc_point boxes[BOUNDS][4];
    double areas[BOUNDS];
} bounds;
bounds find_bounds(const subject *of);

#endif
