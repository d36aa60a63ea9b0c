/* SPDX-License-Identifier: MIT
 *
 * vtk.c - files for ParaView, in VTK's old binary format: for each frame one of bodies, which are polygons, and one of
 * contacts, which are points. All numbers are big-endian.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "frames.h"
#include "internal.h"

/* A polygon is nowhere further from its outline than this share of the diameter of the disc of equal area;
 * its corners are on it. */
static const double PI = 3.14159265358979323846;
static const double OUTLINE_TOLERANCE = 1.0 / 400;

enum { MOST_CORNERS = 4096 };

/* ------------------------------------------------------------------------------------------------ numbers */

static void put_word(FILE *file, uint32_t word) {
    for (int shift = 24; shift >= 0; shift -= 8)
        putc((int)(word >> shift & 0xff), file);
}

static void put_number(FILE *file, double value) {
    const float rounded = (float)value;
    uint32_t word;
    memcpy(&word, &rounded, sizeof word);
    put_word(file, word);
}

static void put_place(FILE *file, double x, double y) {
    put_number(file, x);
    put_number(file, y);
    put_number(file, 0);
}

static void put_head(FILE *file, const dem *d, size_t points) {
    uint64_t bits;
    memcpy(&bits, &d->time, sizeof bits);
    fprintf(file,
            "# vtk DataFile Version 3.0\nstep %llu, time %.9g\nBINARY\nDATASET POLYDATA\nFIELD FieldData 1\n"
            "TimeValue 1 1 double\n",
            (unsigned long long)d->step, d->time);
    put_word(file, (uint32_t)(bits >> 32));
    put_word(file, (uint32_t)bits);
    fprintf(file, "\nPOINTS %zu float\n", points);
}

/* ------------------------------------------------------------------------------------------------ outlines */

typedef struct outline {
    dem_vec *corners;
    size_t count;
} outline;

/* A chord that spans the angle 2 a is r (1 - cos a) from its arc. An arc's end is left out where the next one, or the
 * first, starts there. */
static size_t sample_arcs(const narc_arc *arcs, size_t count, double tolerance, dem_vec *out) {
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        const narc_arc *arc = &arcs[i], *next = &arcs[(i + 1) % count];
        const double turn = 6.283185307179586477;
        const double sweep = arc->end - arc->start + (arc->end < arc->start ? turn : 0);
        const double share = fmin(tolerance / fmax(arc->radius, tolerance), 1);
        const size_t chords = arc->radius > tolerance ? (size_t)ceil(sweep / (2 * acos(1 - share))) : 1;
        for (size_t j = 0; j <= chords && used < MOST_CORNERS; j++) {
            const double angle = arc->start + sweep * (double)j / (double)chords;
            const dem_vec p = {arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
            const double next_x = next->center_x + next->radius * cos(next->start) - p.x;
            const double next_y = next->center_y + next->radius * sin(next->start) - p.y;
            if (j < chords || hypot(next_x, next_y) > 0.1 * tolerance)
                out[used++] = p;
        }
    }
    return used;
}

static void free_outlines(outline *outlines, size_t count) {
    for (size_t k = 0; outlines && k < count; k++)
        free(outlines[k].corners);
    free(outlines);
}

/* Of each shape. NULL: there is not enough memory. */
static outline *sample_shapes(const dem *d) {
    outline *outlines = calloc(d->outline_count, sizeof *outlines);
    for (size_t k = 0; outlines && k < d->outline_count; k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        const size_t count = narc_get_arcs(d->store, (uint32_t)k, arcs);
        outlines[k].corners = malloc(MOST_CORNERS * sizeof *outlines[k].corners);
        if (!outlines[k].corners) {
            free_outlines(outlines, d->outline_count);
            return NULL;
        }
        narc_mass mass;
        narc_compute_mass(arcs, count, &mass);
        outlines[k].count = sample_arcs(arcs, count, OUTLINE_TOLERANCE * 2 * sqrt(mass.area / PI), outlines[k].corners);
    }
    return outlines;
}

/* ------------------------------------------------------------------------------------------------ bodies */

static size_t count_corners(const dem *d, const outline *outlines, size_t part) {
    const size_t k = d->parts.body[part];
    const bool is_plate = k >= d->grain_count && d->walls[k - d->grain_count].kind == DEM_PLATE;
    return is_plate ? 4 : outlines[d->parts.outline[part]].count;
}

static void put_outline(FILE *file, const dem *d, const outline *outlines, const dem_region *all, size_t part) {
    const dem_bodies *b = &d->bodies;
    const outline *form = &outlines[d->parts.outline[part]];
    const size_t k = d->parts.body[part];
    const double c = (double)b->scale[k] * b->cosine[k], s = (double)b->scale[k] * b->sine[k];
    dem_vec corners[4];
    if (k >= d->grain_count && d->walls[k - d->grain_count].kind == DEM_PLATE) {
        dem_outline_plate(d, k - d->grain_count, all, corners);
        for (size_t i = 0; i < 4; i++)
            put_place(file, corners[i].x, corners[i].y);
        return;
    }
    for (size_t i = 0; i < form->count; i++) {
        const dem_vec p = form->corners[i];
        put_place(file, b->x[k] + c * p.x - s * p.y, b->y[k] + s * p.x + c * p.y);
    }
}

/* Of each part those of its body. */
static void put_fields(FILE *file, const dem *d, const dem_load *loads) {
    static const char *const words[] = {"id", "wall", "shape", "material", "coordination", "bearing"};
    static const char *const numbers[] = {"speed", "spin", "size", "pressure"};
    static const char *const vectors[] = {"velocity", "centre"};
    const dem_bodies *b = &d->bodies;
    const size_t count = d->parts.count;
    const uint32_t *body = d->parts.body, *end = body + count;
    fprintf(file, "\nCELL_DATA %zu\nFIELD FieldData 13", count);
    for (size_t i = 0; i < 6; i++) {
        fprintf(file, "\n%s 1 %zu int\n", words[i], count);
        for (const uint32_t *k = body; k < end; k++)
            put_word(file, (const uint32_t[]){*k, *k >= d->grain_count, b->shape[*k], b->material[*k],
                                              loads[*k].contacts, loads[*k].bearing}[i]);
    }
    for (size_t i = 0; i < 4; i++) {
        fprintf(file, "\n%s 1 %zu float\n", numbers[i], count);
        for (const uint32_t *k = body; k < end; k++)
            put_number(file, (const double[]){hypot(b->vx[*k], b->vy[*k]), b->spin[*k], b->extent[*k],
                                              0.5 * (loads[*k].stress_xx + loads[*k].stress_yy)}[i]);
    }
    for (size_t i = 0; i < 2; i++) {
        fprintf(file, "\n%s 3 %zu float\n", vectors[i], count);
        for (const uint32_t *k = body; k < end; k++)
            put_place(file, (i ? b->x : b->vx)[*k], (i ? b->y : b->vy)[*k]);
    }
    fprintf(file, "\nstress 9 %zu float\n", count);
    for (const uint32_t *k = body; k < end; k++) {
        put_place(file, loads[*k].stress_xx, loads[*k].stress_xy);
        put_place(file, loads[*k].stress_yx, loads[*k].stress_yy);
        put_place(file, 0, 0);
    }
}

static bool write_bodies(FILE *file, const dem *d, char *error) {
    const dem_region all = dem_bound_all(d);
    outline *outlines = sample_shapes(d);
    dem_load *loads = outlines ? dem_find_loads(d, error) : NULL;
    size_t points = 0, first = 0;
    if (!outlines)
        snprintf(error, 512, "not enough memory for a VTK file");
    for (size_t k = 0; loads && k < d->parts.count; k++)
        points += count_corners(d, outlines, k);
    if (loads) {
        put_head(file, d, points);
        for (size_t k = 0; k < d->parts.count; k++)
            put_outline(file, d, outlines, &all, k);
        fprintf(file, "\nPOLYGONS %zu %zu\n", d->parts.count, d->parts.count + points);
        for (size_t k = 0; k < d->parts.count; k++) {
            const size_t corners = count_corners(d, outlines, k);
            put_word(file, (uint32_t)corners);
            for (size_t i = 0; i < corners; i++)
                put_word(file, (uint32_t)first++);
        }
        put_fields(file, d, loads);
    }
    free_outlines(outlines, d->outline_count);
    free(loads);
    return loads != NULL;
}

/* ------------------------------------------------------------------------------------------------ contacts */

/* Tangential by friction times normal force. */
static double find_mobilised_friction(const dem *d, size_t k) {
    const size_t p = d->contacts.rows[k].pair;
    const uint8_t *material = d->bodies.material;
    const double bound = d->laws[material[dem_body_a(d, p)]][material[dem_body_b(d, p)]].friction;
    const double most = bound * fabs(dem_normal_force(d, k));
    return most > 0 ? fmin(fabs(dem_tangential_force(d, k)) / most, 1) : 0;
}

static bool write_contacts(FILE *file, const dem *d, char *error) {
    static const char *const words[] = {"body_a", "body_b"}, *const vectors[] = {"force", "normal"};
    static const char *const numbers[] = {"normal_force", "tangential_force", "mobilised_friction", "overlap"};
    const size_t count = d->contacts.count;
    const dem_contact *row = d->contacts.rows;
    (void)error;
    put_head(file, d, count);
    for (size_t k = 0; k < count; k++) {
        const size_t a = dem_body_a(d, row[k].pair);
        put_place(file, d->bodies.x[a] + row[k].point.x, d->bodies.y[a] + row[k].point.y);
    }
    fprintf(file, "\nVERTICES %zu %zu\n", count, 2 * count);
    for (size_t k = 0; k < count; k++) {
        put_word(file, 1);
        put_word(file, (uint32_t)k);
    }
    fprintf(file, "\nPOINT_DATA %zu\nFIELD FieldData 8", count);
    for (size_t i = 0; i < 2; i++) {
        fprintf(file, "\n%s 1 %zu int\n", words[i], count);
        for (size_t k = 0; k < count; k++)
            put_word(file, (uint32_t)(i == 0 ? dem_body_a(d, row[k].pair) : dem_body_b(d, row[k].pair)));
    }
    for (size_t i = 0; i < 2; i++) {
        fprintf(file, "\n%s 3 %zu float\n", vectors[i], count);
        for (size_t k = 0; k < count; k++)
            put_place(file, i == 0 ? row[k].force.x : row[k].normal.x, i == 0 ? row[k].force.y : row[k].normal.y);
    }
    for (size_t i = 0; i < 4; i++) {
        fprintf(file, "\n%s 1 %zu float\n", numbers[i], count);
        for (size_t k = 0; k < count; k++)
            put_number(file, (const double[]){dem_normal_force(d, k), dem_tangential_force(d, k),
                                              find_mobilised_friction(d, k), row[k].depth}[i]);
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------ both */

bool dem_write_vtk(const dem *d, const char *stem, uint64_t frame, char *error) {
    bool ok = true;
    for (int i = 0; i < 2 && ok; i++) {
        char path[DEM_PATH_SIZE];
        dem_file file;
        snprintf(path, sizeof path, "%.1000s%s-%06llu.vtk", stem, i ? "-contacts" : "", (unsigned long long)frame);
        if (!dem_open_file(&file, path, error))
            return false;
        ok = i ? write_contacts(file.file, d, error) : write_bodies(file.file, d, error);
        ok = dem_close_file(&file, ok, error);
    }
    return ok;
}
