/* SPDX-License-Identifier: MIT
 *
 * fits.h - all fits of all subjects, on all processors, and how far they can be relied on.
 */
#ifndef NARC_STUDY_FITS_H
#define NARC_STUDY_FITS_H

#include "study.h"

/* Of the usual search. TIMES: the longer one of the trials. */
enum { USUAL_STARTS = 56, TIMES = 8 };

/* Fits and trials, with progress on standard error; `starts` 0: the usual number. */
void find_fits(study *all, unsigned starts);

/* How many fits are larger than the one with fewer arcs, or with the size's next smaller one. The paper's route promises
 * nothing. */
size_t count_worse(const study *all, size_t size);

/* No shape is smaller than the hull that it must hold, and none larger than with fewer arcs? Else it is told on standard
 * error. */
bool check_fits(const study *all);

#endif
