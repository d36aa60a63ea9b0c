/* SPDX-License-Identifier: MIT
 *
 * vtk.c - files for ParaView.
 */
#include "dem.h"

bool dem_write_vtk(const dem *d, const char *stem, char *error) {
    (void)d;
    snprintf(error, 512, "%s: this build writes no VTK files", stem);
    return false;
}
