/* SPDX-License-Identifier: MIT
 *
 * csv.h - the table of measures: a line for each time. It grows while the run goes on, so that it can be looked at.
 */
#ifndef DEM_CSV_H
#define DEM_CSV_H

#include "dem.h"

/* A new table; or, if the position is above 0 and the file is there, an old one, cut off there: if it is one of this
 * input, and the line that ends there is not of a later step than the world's. Sets the position to its end. Errors go
 * to `error` (512 bytes). */
FILE *dem_open_csv(const dem *d, const char *path, uint64_t *position, char *error);

/* Adds a line; false if it cannot be written. */
bool dem_write_csv(FILE *csv, const dem *d, const dem_measures *m);

#endif
