/* SPDX-License-Identifier: MIT
 *
 * report.h - reports as JSON, for programs.
 */
#ifndef NARC_TOOL_REPORT_H
#define NARC_TOOL_REPORT_H

#include "picture_fits.h"

/* Does --report ask for it? Another value is an error. */
bool wants_json(const option *given);

/* Begins the entry of an input, with what was told of it. */
void put_input(FILE *file, const char *path);

/* One of `fits` and `chains` is NULL. `kinds` are those of all shapes, as a shapes file names them; `out` may have {name}. */
void put_fits(FILE *file, const outline_list *outlines, const collider *fits, const narc_arc_chains *chains,
              char *const *kinds, const char *out);

#endif
