/* SPDX-License-Identifier: MIT
 *
 * progress.h - a clock, and a progress line on standard error, shown only on a terminal and after a second of work.
 */
#ifndef NARC_TOOL_PROGRESS_H
#define NARC_TOOL_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

/* Seconds on a clock that never goes back. */
double seconds_now(void);

/* Starts the second of patience. Call it first. */
void start_progress(void);

/* Reports that `done` of `total` items of the stage named `what` are done. Cheap enough to call for every item. */
void show_progress(const char *what, size_t done, size_t total);

/* Reports that `share` of a stage, 0 to 1, is done: for work that reports seldom, since it looks at the clock each
 * time. */
void show_share(const char *what, double share);

/* Says what begins now and cannot report how far it is: "what, count items". The line is shown at once if the second is
 * over, or if `is_long` tells that it will be before this is done. */
void show_stage(const char *what, size_t count, const char *items, bool is_long);

/* Clears the line, if there is one. */
void hide_progress(void);

#endif
