/* SPDX-License-Identifier: MIT
 *
 * pictures.h - the study's pictures, each a file.
 */
#ifndef NARC_STUDY_PICTURES_H
#define NARC_STUDY_PICTURES_H

#include "study.h"

/* The paper's figures 6 to 9, and figure 2. */
void draw_subject(const subject *of, const char *path);
void draw_bounds(const subject *of, const char *path);

/* The other outlines, or grains: none if there are none. */
void draw_many(const study *all, bool grains, const char *path);

#endif
