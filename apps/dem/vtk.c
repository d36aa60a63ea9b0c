/* SPDX-License-Identifier: MIT
 *
 * vtk.c - files for ParaView: for each frame a .vtp file of bodies and one of contacts, and a .pvd file of each kind that
 * lists the frames so far.
 */
#include <math.h>
#include <stdlib.h>

#include "frames.h"
#include "vtk_xml.h"

/* A polygon is nowhere further from the outline than this share of the shape's extent; its corners are on it. */
static const double OUTLINE_TOLERANCE = 1.0 / 400;

enum { MOST_CORNERS = 4096 };

static bool fail_memory(char *error) {
    snprintf(error, 512, "not enough memory for a VTK file");
    return false;
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

/* Of each shape. */
static outline *sample_shapes(const dem *d) {
    outline *outlines = calloc(d->shape_count, sizeof *outlines);
    for (size_t k = 0; outlines && k < d->shape_count; k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        const size_t count = narc_get_arcs(d->store, (uint32_t)k, arcs);
        outlines[k].corners = malloc(MOST_CORNERS * sizeof *outlines[k].corners);
        if (!outlines[k].corners) {
            free_outlines(outlines, d->shape_count);
            return NULL;
        }
        outlines[k].count = sample_arcs(arcs, count, OUTLINE_TOLERANCE * d->shapes[k].extent, outlines[k].corners);
    }
    return outlines;
}

/* ------------------------------------------------------------------------------------------------ bodies */

static void add_outline(const dem *d, const outline *outlines, const dem_region *all, size_t k, vtk_column *points) {
    const dem_bodies *b = &d->bodies;
    const outline *form = &outlines[b->shape[k]];
    const double c = (double)b->scale[k] * b->cosine[k], s = (double)b->scale[k] * b->sine[k];
    dem_vec corners[4];
    if (k >= d->grain_count && d->walls[k - d->grain_count].kind == DEM_PLATE) {
        dem_outline_plate(d, k - d->grain_count, all, corners);
        for (size_t i = 0; i < 4; i++)
            vtk_add_place(points, corners[i].x, corners[i].y);
        return;
    }
    for (size_t i = 0; i < form->count; i++) {
        const dem_vec p = form->corners[i];
        vtk_add_place(points, b->x[k] + c * p.x - s * p.y, b->y[k] + s * p.x + c * p.y);
    }
}

static void write_fields(FILE *file, const dem *d, const dem_load *loads, vtk_column *c) {
    static const char *const words[] = {"id", "wall", "shape", "material", "coordination", "bearing"};
    static const char *const numbers[] = {"speed", "spin", "size", "pressure"};
    const dem_bodies *b = &d->bodies;
    for (size_t i = 0; i < 6; i++) {
        for (size_t k = 0; k < b->count; k++)
            vtk_add_word(c, (const uint32_t[]){(uint32_t)k, k >= d->grain_count, b->shape[k], b->material[k],
                                               loads[k].contacts, loads[k].bearing}[i]);
        vtk_write_column(file, c, "Int32", words[i], 1);
    }
    for (size_t k = 0; k < b->count; k++)
        vtk_add_place(c, b->vx[k], b->vy[k]);
    vtk_write_column(file, c, "Float32", "velocity", 3);
    for (size_t i = 0; i < 4; i++) {
        for (size_t k = 0; k < b->count; k++)
            vtk_add_number(c, (const double[]){hypot(b->vx[k], b->vy[k]), b->spin[k], b->extent[k],
                                               0.5 * (loads[k].stress_xx + loads[k].stress_yy)}[i]);
        vtk_write_column(file, c, "Float32", numbers[i], 1);
    }
    for (size_t k = 0; k < b->count; k++) { /* a full tensor: ParaView's filters want nine */
        const dem_load *l = &loads[k];
        const double nine[9] = {l->stress_xx, l->stress_xy, 0, l->stress_yx, l->stress_yy, 0, 0, 0, 0};
        for (size_t i = 0; i < 9; i++)
            vtk_add_number(c, nine[i]);
    }
    vtk_write_column(file, c, "Float32", "stress", 9);
}

static bool write_polygons(FILE *file, const dem *d, const outline *outlines, const dem_load *loads, vtk_column *c,
                           vtk_column *ends) {
    const dem_region all = dem_bound_all(d);
    for (size_t k = 0; k < d->bodies.count; k++) {
        add_outline(d, outlines, &all, k, c);
        vtk_add_word(ends, (uint32_t)(c->count / 3));
    }
    const size_t points = c->count / 3;
    vtk_write_head(file, d, points, 0, d->bodies.count);
    vtk_open_section(file, "Points");
    vtk_write_column(file, c, "Float32", "points", 3);
    vtk_close_section(file, "Points");
    vtk_open_section(file, "Polys");
    for (size_t i = 0; i < points; i++)
        vtk_add_word(c, (uint32_t)i);
    vtk_write_column(file, c, "Int32", "connectivity", 1);
    vtk_write_column(file, ends, "Int32", "offsets", 1);
    vtk_close_section(file, "Polys");
    vtk_open_section(file, "CellData");
    write_fields(file, d, loads, c);
    vtk_close_section(file, "CellData");
    vtk_write_tail(file);
    return !c->failed && !ends->failed;
}

static bool write_bodies(FILE *file, const dem *d, char *error) {
    outline *outlines = sample_shapes(d);
    dem_load *loads = dem_find_loads(d, error);
    vtk_column numbers = {.words = NULL}, ends = {.words = NULL};
    const bool ok =
        (outlines && loads && write_polygons(file, d, outlines, loads, &numbers, &ends)) || fail_memory(error);
    free_outlines(outlines, d->shape_count);
    free(loads);
    free(numbers.words);
    free(ends.words);
    return ok;
}

/* ------------------------------------------------------------------------------------------------ contacts */

/* A radius of curvature; of an edge -1. */
static double show_radius(float radius) { return isinf(radius) ? -1 : (double)radius; }

/* Tangential by friction times normal force. */
static double find_mobilised_friction(const dem *d, size_t k) {
    const size_t p = d->contacts.rows[k].pair;
    const uint8_t *material = d->bodies.material;
    const double bound = d->laws[material[d->pairs.a[p]]][material[d->pairs.b[p]]].friction;
    const double most = bound * fabs(dem_normal_force(d, k));
    return most > 0 ? fmin(fabs(dem_tangential_force(d, k)) / most, 1) : 0;
}

static void write_forces(FILE *file, const dem *d, vtk_column *c) {
    static const char *const numbers[] = {"normal_force", "tangential_force", "mobilised_friction",
                                          "separation",   "radius_a",         "radius_b"};
    const dem_contacts *list = &d->contacts;
    const narc_contact *row = list->rows;
    for (size_t k = 0; k < list->count; k++)
        vtk_add_place(c, list->forces[k].x, list->forces[k].y);
    vtk_write_column(file, c, "Float32", "force", 3);
    for (size_t k = 0; k < list->count; k++)
        vtk_add_place(c, (double)row[k].normal_x, (double)row[k].normal_y);
    vtk_write_column(file, c, "Float32", "normal", 3);
    for (size_t i = 0; i < 6; i++) {
        for (size_t k = 0; k < list->count; k++)
            vtk_add_number(c, (const double[]){dem_normal_force(d, k), dem_tangential_force(d, k),
                                               find_mobilised_friction(d, k), (double)row[k].separation,
                                               show_radius(row[k].radius_a), show_radius(row[k].radius_b)}[i]);
        vtk_write_column(file, c, "Float32", numbers[i], 1);
    }
}

static bool write_points(FILE *file, const dem *d, vtk_column *c) {
    const dem_contacts *list = &d->contacts;
    vtk_write_head(file, d, list->count, list->count, 0);
    vtk_open_section(file, "Points");
    for (size_t k = 0; k < list->count; k++) {
        const size_t a = d->pairs.a[list->rows[k].pair];
        vtk_add_place(c, d->bodies.x[a] + (double)list->rows[k].point_x,
                      d->bodies.y[a] + (double)list->rows[k].point_y);
    }
    vtk_write_column(file, c, "Float32", "points", 3);
    vtk_close_section(file, "Points");
    vtk_open_section(file, "Verts");
    for (size_t k = 0; k < list->count; k++)
        vtk_add_word(c, (uint32_t)k);
    vtk_write_column(file, c, "Int32", "connectivity", 1);
    for (size_t k = 0; k < list->count; k++)
        vtk_add_word(c, (uint32_t)k + 1);
    vtk_write_column(file, c, "Int32", "offsets", 1);
    vtk_close_section(file, "Verts");
    vtk_open_section(file, "PointData");
    for (size_t k = 0; k < list->count; k++)
        vtk_add_word(c, d->pairs.a[list->rows[k].pair]);
    vtk_write_column(file, c, "Int32", "body_a", 1);
    for (size_t k = 0; k < list->count; k++)
        vtk_add_word(c, d->pairs.b[list->rows[k].pair]);
    vtk_write_column(file, c, "Int32", "body_b", 1);
    write_forces(file, d, c);
    vtk_close_section(file, "PointData");
    vtk_write_tail(file);
    return !c->failed;
}

static bool write_contacts(FILE *file, const dem *d, char *error) {
    vtk_column numbers = {.words = NULL};
    const bool ok = write_points(file, d, &numbers) || fail_memory(error);
    free(numbers.words);
    return ok;
}

/* ------------------------------------------------------------------------------------------------ both */

/* A file, then the list with it. */
static bool write_part(const dem *d, const char *stem, uint64_t frame, bool (*write)(FILE *, const dem *, char *),
                       char *error) {
    char path[DEM_PATH_SIZE];
    dem_file file;
    snprintf(path, sizeof path, "%.1000s-%06llu.vtp", stem, (unsigned long long)frame);
    if (!dem_open_file(&file, path, error))
        return false;
    const bool ok = write(file.file, d, error);
    return dem_close_file(&file, ok, error) && vtk_list_frame(d, stem, frame, error);
}

bool dem_write_vtk(const dem *d, const char *stem, uint64_t frame, char *error) {
    char contacts[DEM_PATH_SIZE];
    snprintf(contacts, sizeof contacts, "%.1000s-contacts", stem);
    return write_part(d, stem, frame, write_bodies, error) && write_part(d, contacts, frame, write_contacts, error);
}
