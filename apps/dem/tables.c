/* SPDX-License-Identifier: MIT
 *
 * tables.c - the table of measures, and tables of all grains.
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

/* Does the text begin as a table does, and does a line end at the position, of a step that has been? */
static bool is_table(const dem *d, const char *text, size_t position) {
    const char *line = text + position - 1;
    if (strncmp(text, HEAD, sizeof HEAD - 1) != 0 || *line != '\n')
        return false;
    while (line > text && line[-1] != '\n')
        line--;
    return strtoull(line, NULL, 10) <= d->step; /* of the head 0 */
}

static void check_table(dem *d, const char *path, size_t position) {
    size_t size;
    char *text = dem_read_file(path, &size);
    if (size < position)
        dem_fail(d, "%.400s: it is shorter than the table was when the restart was written", path);
    if (!is_table(d, text, position))
        dem_fail(d, "%.400s: it is not the table that the restart goes on with", path);
    dem_release(text);
}

FILE *dem_open_csv(dem *d, const char *path, uint64_t *position) {
    *position = access(path, F_OK) == 0 ? *position : 0;
    if (*position > 0)
        check_table(d, path, (size_t)*position);
    FILE *file = fopen(path, *position > 0 ? "r+" : "w");
    if (!file || (*position > 0 && (ftruncate(fileno(file), (off_t)*position) || fseek(file, 0, SEEK_END))))
        dem_fail(d, "%.400s: %s", path, strerror(errno));
    if (*position == 0) {
        fprintf(file, "%s", HEAD);
        for (const dem_wall *w = d->walls; w < d->walls + d->wall_count; w++)
            fprintf(file, ",%s_x,%s_y,%s_fx,%s_fy", w->name, w->name, w->name, w->name);
        fprintf(file, d->settings.strained ? ",width,height\n" : "\n");
        *position = (uint64_t)ftell(file);
    }
    return file;
}

bool dem_write_csv(FILE *csv, const dem *d, const dem_measures *m) {
    const dem_energies *e = &m->energy;
    const dem_stress *s = &m->stress;
    fprintf(csv, "%" PRIu64 ",%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%zu,%.6g,%.6g,%.6g", d->step,
            d->time, e->kinetic, e->potential, e->elastic, e->damping, e->friction, e->walls, s->xx, s->xy, s->yx,
            s->yy, m->contacts, m->coordination, m->deepest, m->fastest);
    for (const dem_body *b = d->bodies + d->grain_count; b < d->bodies + d->body_count; b++)
        fprintf(csv, ",%.9g,%.9g,%.9g,%.9g", b->position.x, b->position.y, b->force.x, b->force.y);
    if (d->settings.strained)
        fprintf(csv, ",%.9g,%.9g", dem_cell_size(d).x, dem_cell_size(d).y);
    fprintf(csv, "\n");
    return fflush(csv) == 0 && !ferror(csv);
}

void dem_write_grains(dem *d, const char *path) {
    dem_load *loads = dem_find_loads(d);
    dem_file out = dem_open_file(d, path);
    fprintf(out.file, "shape,x,y,angle,scale,size,vx,vy,spin,contacts,bearing,pressure,mass,cell_x,cell_y\n");
    for (size_t k = 0; k < d->grain_count; k++) {
        const dem_body *b = &d->bodies[k];
        const dem_load *l = &loads[k];
        const double angle = atan2(b->turn.y, b->turn.x), pressure = 0.5 * (l->stress.xx + l->stress.yy);
        fprintf(out.file, "%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%u,%u,%.9g,%.9g,%d,%d\n",
                d->shapes[b->shape].name, b->position.x, b->position.y, angle, (double)b->scale, b->extent,
                b->velocity.x, b->velocity.y, b->spin, l->contacts, l->bearing, pressure, b->mass, (int)b->cell_x,
                (int)b->cell_y);
    }
    dem_release(loads);
    dem_close_file(d, &out);
}
