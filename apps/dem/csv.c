/* SPDX-License-Identifier: MIT
 *
 * csv.c - the table of measures, and tables of all grains.
 */
#define _XOPEN_SOURCE 700 /* ftruncate */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "dem.h"

static const char HEAD[] = "step,time,kinetic,potential,elastic,damping,friction,walls,stress_xx,stress_xy,stress_yx,"
                           "stress_yy,contacts,coordination,deepest,fastest";

static FILE *fail_csv(dem *d, const char *path, const char *reason, FILE *file) {
    dem_fail(d, "%.400s: %s", path, reason);
    if (file)
        fclose(file);
    return NULL;
}

static void write_head(FILE *csv, const dem *d) {
    fprintf(csv, "%s", HEAD);
    for (size_t w = 0; w < d->wall_count; w++) {
        const char *name = d->walls[w].name;
        fprintf(csv, ",%s_x,%s_y,%s_fx,%s_fy", name, name, name, name);
    }
    fprintf(csv, "\n");
}

/* Does the file begin as a table does, and does a line end at the position, of a step that has been? */
static bool is_table(const dem *d, FILE *file, uint64_t position) {
    char head[sizeof HEAD];
    if (!fgets(head, sizeof head, file) || strcmp(head, HEAD) != 0)
        return false;
    uint64_t step = UINT64_MAX; /* of the line that begins after the last line's end */
    int before = 0, letter = 0;
    bool in_step = false;
    for (uint64_t at = sizeof HEAD - 1; at < position; at++) {
        before = letter;
        if ((letter = getc(file)) == EOF)
            return false;
        if (before == '\n')
            step = 0;
        in_step = letter >= '0' && letter <= '9' && (before == '\n' || in_step);
        if (in_step)
            step = 10 * step + (uint64_t)(letter - '0');
    }
    return letter == '\n' && (step == UINT64_MAX || step <= d->step);
}

FILE *dem_open_csv(dem *d, const char *path, uint64_t *position) {
    FILE *file = *position > 0 ? fopen(path, "r+") : NULL;
    if (!file && (*position == 0 || errno == ENOENT)) {
        file = fopen(path, "w");
        *position = 0;
    }
    if (!file)
        return fail_csv(d, path, strerror(errno), NULL);
    if (*position == 0) {
        write_head(file, d);
        *position = (uint64_t)ftell(file);
        return file;
    }
    if (fseek(file, 0, SEEK_END) != 0 || ftell(file) < 0 || (uint64_t)ftell(file) < *position)
        return fail_csv(d, path, "it is shorter than the table was when the restart was written", file);
    rewind(file);
    if (!is_table(d, file, *position))
        return fail_csv(d, path, "it is not the table that the restart goes on with", file);
    if (ftruncate(fileno(file), (off_t)*position) != 0 || fseek(file, (long)*position, SEEK_SET) != 0)
        return fail_csv(d, path, strerror(errno), file);
    return file;
}

bool dem_write_csv(FILE *csv, const dem *d, const dem_measures *m) {
    const dem_energies *e = &m->energy;
    fprintf(csv, "%" PRIu64 ",%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%zu,%.6g,%.6g,%.6g", d->step,
            d->time, e->kinetic, e->potential, e->elastic, e->damping, e->friction, e->walls, m->stress_xx,
            m->stress_xy, m->stress_yx, m->stress_yy, m->contacts, m->coordination, m->deepest, m->fastest);
    for (size_t w = 0; w < d->wall_count; w++) {
        const size_t k = d->grain_count + w;
        const dem_vec force = dem_wall_force(d, w);
        fprintf(csv, ",%.9g,%.9g,%.9g,%.9g", d->bodies.x[k], d->bodies.y[k], force.x, force.y);
    }
    fprintf(csv, "\n");
    return fflush(csv) == 0 && !ferror(csv);
}

/* ------------------------------------------------------------------------------------------------ grains */

static void write_grain(FILE *file, const dem *d, size_t k, const dem_load *load) {
    const dem_bodies *b = &d->bodies;
    fprintf(file, "%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%u,%u,%.9g,%.9g,%d,%d\n", d->shapes[b->shape[k]].name,
            b->x[k], b->y[k], atan2(b->sine[k], b->cosine[k]), (double)b->scale[k], b->extent[k], b->vx[k], b->vy[k],
            b->spin[k], load->contacts, load->bearing, 0.5 * (load->stress_xx + load->stress_yy), b->mass[k],
            (int)b->cell_x[k], (int)b->cell_y[k]);
}

bool dem_write_grains(dem *d, const char *path) {
    dem_load *loads = dem_find_loads(d);
    dem_file file;
    if (!loads || !dem_open_file(&file, path, d->error)) {
        free(loads);
        return false;
    }
    fprintf(file.file, "shape,x,y,angle,scale,size,vx,vy,spin,contacts,bearing,pressure,mass,cell_x,cell_y\n");
    for (size_t k = 0; k < d->grain_count; k++)
        write_grain(file.file, d, k, &loads[k]);
    free(loads);
    return dem_close_file(&file, true, d->error);
}
