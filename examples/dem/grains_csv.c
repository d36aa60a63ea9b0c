/* SPDX-License-Identifier: MIT
 *
 * grains_csv.c - a table of all grains.
 */
#include <math.h>
#include <stdlib.h>

#include "frames.h"

static void write_grain(FILE *file, const dem *d, size_t k, const dem_load *load) {
    const dem_bodies *b = &d->bodies;
    fprintf(file, "%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%u,%u,%.9g,%.9g,%d,%d\n", d->shapes[b->shape[k]].name,
            b->x[k], b->y[k], atan2(b->sine[k], b->cosine[k]), (double)b->scale[k], b->extent[k], b->vx[k], b->vy[k],
            b->spin[k], load->contacts, load->bearing, 0.5 * (load->stress_xx + load->stress_yy), b->mass[k],
            (int)b->cell_x[k], (int)b->cell_y[k]);
}

bool dem_write_grains(const dem *d, const char *path, char *error) {
    dem_load *loads = dem_find_loads(d, error);
    dem_file file;
    if (!loads || !dem_open_file(&file, path, error)) {
        free(loads);
        return false;
    }
    fprintf(file.file, "shape,x,y,angle,scale,size,vx,vy,spin,contacts,bearing,pressure,mass,cell_x,cell_y\n");
    for (size_t k = 0; k < d->grain_count; k++)
        write_grain(file.file, d, k, &loads[k]);
    free(loads);
    return dem_close_file(&file, true, error);
}
