/* SPDX-License-Identifier: MIT
 *
 * progress.h - a clock, and a progress line on standard error, shown only on a terminal and after a second of work.
 */
#ifndef NARC_TOOL_PROGRESS_H
#define NARC_TOOL_PROGRESS_H

#include <stddef.h>

/* Seconds on a clock that never goes back. */
double seconds_now(void);

/* Reports that `done` of `total` items of the stage named `what` are done. Cheap enough to call for every item. */
void show_progress(const char *what, size_t done, size_t total);

/* Clears the line, if there is one. */
void hide_progress(void);

#endif
