/* SPDX-License-Identifier: MIT
 *
 * vtk.c - files for ParaView, in VTK's old binary format: for each frame one of bodies, which are polygons, and one of
 * contacts, which are points. All numbers are big-endian.
 */
#include <math.h>
#include <string.h>

#include "dem.h"

/* A polygon is nowhere further from its outline than this share of the diameter of the disc of equal area;
 * its corners are on it. */
static const double OUTLINE_TOLERANCE = 1.0 / 400;

enum { MOST_CORNERS = 4096, WIDEST = 25 };

/* What cells have: `size` numbers each. The last one has size 0. */
typedef struct field {
    const char *name, *type;
    size_t size;
} field;

/* Cells, which are polygons or points, each of corners of its own, and a row of numbers for each: those of the fields.
 * Arrays grow by dem_grow(). */
typedef struct frame {
    const char *cell_name, *data_name;
    const field *fields;
    size_t cell_count, point_count;
    uint32_t *corners; /* how many a cell has */
    vec *points;
    double (*rows)[WIDEST];
} frame;

/* ------------------------------------------------------------------------------------------------ the format */

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

static void put_frame(FILE *file, const dem *d, const frame *f) {
    uint64_t time;
    memcpy(&time, &d->time, sizeof time);
    fprintf(file,
            "# vtk DataFile Version 3.0\nstep %llu, time %.9g\nBINARY\nDATASET POLYDATA\nFIELD FieldData 1\n"
            "TimeValue 1 1 double\n",
            (unsigned long long)d->step, d->time);
    put_word(file, (uint32_t)(time >> 32));
    put_word(file, (uint32_t)time);
    fprintf(file, "\nPOINTS %zu float\n", f->point_count);
    for (size_t i = 0; i < f->point_count; i++) {
        put_number(file, f->points[i].x);
        put_number(file, f->points[i].y);
        put_number(file, 0);
    }
    fprintf(file, "\n%s %zu %zu\n", f->cell_name, f->cell_count, f->cell_count + f->point_count);
    for (size_t k = 0, point = 0; k < f->cell_count; k++) {
        put_word(file, f->corners[k]);
        for (size_t i = 0; i < f->corners[k]; i++)
            put_word(file, (uint32_t)point++);
    }
    size_t count = 0, first = 0;
    while (f->fields[count].size > 0)
        count++;
    fprintf(file, "\n%s %zu\nFIELD FieldData %zu", f->data_name, f->cell_count, count);
    for (const field *at = f->fields; at->size > 0; first += at++->size) {
        fprintf(file, "\n%s %zu %zu %s\n", at->name, at->size, f->cell_count, at->type);
        for (size_t k = 0; k < f->cell_count; k++)
            for (size_t i = first; i < first + at->size; i++)
                if (at->type[0] == 'i')
                    put_word(file, (uint32_t)f->rows[k][i]);
                else
                    put_number(file, f->rows[k][i]);
    }
}

static void open_frame(frame *f, size_t cell_count) {
    f->cell_count = cell_count;
    dem_grow(&f->corners, cell_count, sizeof *f->corners);
    dem_grow(&f->points, cell_count, sizeof *f->points);
    dem_grow(&f->rows, cell_count, sizeof *f->rows);
}

/* ------------------------------------------------------------------------------------------------ outlines */

/* Of a part; of a chain the front of a piece, drawn as thick as a grain. */
static size_t put_outline(const dem *d, const dem_part *part, vec *points) {
    const dem_body *b = &d->bodies[part->body];
    const dem_outline *outline = &d->outlines[part->outline];
    const bool chain = d->shapes[b->shape].is_chain, hollow = chain && outline->side_count == 1;
    narc_arc all[NARC_MAX_ARCS], *arcs = all;
    narc_mass mass = {.area = DEM_PI / 4 * d->grain_extent * d->grain_extent};
    narc_point at[MOST_CORNERS / 2];
    size_t count = narc_get_arcs(d->store, outline->stored, arcs), corners = 0;
    if (chain && !hollow) { /* its front */
        arcs++;
        count -= 6;
    }
    if (!chain)
        narc_compute_mass(arcs, count, &mass);
    narc_flatten_arcs(arcs, count, !chain, NULL, OUTLINE_TOLERANCE * 2 * sqrt(mass.area / DEM_PI), at, MOST_CORNERS / 2,
                      &corners, NULL);
    for (size_t i = 0; i < corners; i++) {
        const vec p = {at[i].x + outline->at.x, at[i].y + outline->at.y};
        points[i] = plus(b->position, rotate(times((double)b->scale, b->turn), p));
    }
    for (size_t i = 0; i < corners && chain; i++) { /* and back, behind it: to the left of its way */
        const vec here = points[corners - 1 - i], way = minus(points[i + 1 < corners ? corners - 1 - i : 1],
                                                              points[i + 1 < corners ? corners - 2 - i : 0]);
        const double length = sqrt(dot(way, way));
        points[corners + i] = plus(here, times(0.5 * d->grain_extent / length, (vec){-way.y, way.x}));
    }
    return chain ? 2 * corners : corners;
}

/* The part of a plate that lies along the box, as a strip as thick as a grain: corners counter-clockwise. */
static void put_plate(const dem *d, const dem_wall *wall, vec block, vec low, vec high, vec *points) {
    const vec n = wall->normal, t = {-n.y, n.x}, face = plus(block, times(wall->half, n));
    const double foot = dot(minus(times(0.5, plus(low, high)), face), t);
    const double reach = 0.5 * (fabs(t.x) * (high.x - low.x) + fabs(t.y) * (high.y - low.y));
    for (int i = 0; i < 4; i++) { /* the tangent is a quarter turn from the normal: the face comes first */
        const double along = foot + (i == 0 || i == 3 ? -reach : reach), depth = i < 2 ? 0 : d->grain_extent;
        points[i] = minus(plus(face, times(along, t)), times(depth, n));
    }
}

static const dem_wall *find_plate(const dem *d, size_t body) {
    const dem_wall *wall = body < d->grain_count ? NULL : &d->walls[body - d->grain_count];
    return wall && wall->kind == DEM_PLATE ? wall : NULL;
}

static void put_polygons(const dem *d, frame *f) {
    vec low = {INFINITY, INFINITY}, high = {-INFINITY, -INFINITY}; /* of all but plates */
    for (size_t i = 0; i < d->part_count; f->point_count += f->corners[i++]) {
        dem_grow(&f->points, f->point_count + MOST_CORNERS, sizeof *f->points);
        const bool plate = find_plate(d, d->parts[i].body) != NULL;
        vec *p = f->points + f->point_count;
        f->corners[i] = plate ? 4 : (uint32_t)put_outline(d, &d->parts[i], p);
        for (vec *end = p + f->corners[i]; p < end && !plate; p++) {
            low = (vec){fmin(low.x, p->x), fmin(low.y, p->y)};
            high = (vec){fmax(high.x, p->x), fmax(high.y, p->y)};
        }
    }
    for (size_t i = 0, first = 0; i < d->part_count; first += f->corners[i++]) {
        const size_t k = d->parts[i].body;
        if (find_plate(d, k))
            put_plate(d, find_plate(d, k), d->bodies[k].position, low, high, f->points + first);
    }
}

/* ------------------------------------------------------------------------------------------------ both frames */

static const field body_fields[] = {
    {"id", "int", 1},           {"wall", "int", 1},       {"shape", "int", 1},      {"material", "int", 1},
    {"coordination", "int", 1}, {"bearing", "int", 1},    {"speed", "float", 1},    {"spin", "float", 1},
    {"size", "float", 1},       {"pressure", "float", 1}, {"velocity", "float", 3}, {"centre", "float", 3},
    {"stress", "float", 9},     {NULL, NULL, 0}};

static void make_bodies(const dem *d, frame *f) {
    *f = (frame){.cell_name = "POLYGONS", .data_name = "CELL_DATA", .fields = body_fields};
    dem_load *loads = dem_find_loads(d);
    open_frame(f, d->part_count);
    put_polygons(d, f);
    for (size_t part = 0; part < d->part_count; part++) { /* of each part those of its body */
        const size_t k = d->parts[part].body;
        const dem_body *b = &d->bodies[k];
        const dem_stress *s = &loads[k].stress;
        /* clang-format off */
        const double row[WIDEST] = {
            (double)k, k >= d->grain_count, b->shape, b->material, loads[k].contacts, loads[k].bearing,
            hypot(b->velocity.x, b->velocity.y), b->spin, b->extent, 0.5 * (s->xx + s->yy),
            b->velocity.x, b->velocity.y, 0, b->position.x, b->position.y, 0, s->xx, s->xy, 0, s->yx, s->yy};
        /* clang-format on */
        memcpy(f->rows[part], row, sizeof row);
    }
    dem_release(loads);
}

static const field contact_fields[] = {{"body_a", "int", 1},
                                       {"body_b", "int", 1},
                                       {"force", "float", 3},
                                       {"normal", "float", 3},
                                       {"normal_force", "float", 1},
                                       {"tangential_force", "float", 1},
                                       {"mobilised_friction", "float", 1},
                                       {"overlap", "float", 1},
                                       {NULL, NULL, 0}};

static void make_contacts(const dem *d, frame *f) {
    *f = (frame){.cell_name = "VERTICES", .data_name = "POINT_DATA", .fields = contact_fields};
    f->point_count = d->contact_count;
    open_frame(f, d->contact_count);
    for (size_t k = 0; k < d->contact_count; k++) {
        const dem_contact *c = &d->contacts[k];
        const dem_body *a = dem_body_a(d, c->pair), *b = dem_body_b(d, c->pair);
        const vec force = c->on.force, n = c->normal;
        const double push = dot(force, n), drag = cross(n, force);
        const double most = d->laws[a->material][b->material].friction * fabs(push);
        const double row[WIDEST] = {(double)(a - d->bodies),
                                    (double)(b - d->bodies),
                                    force.x,
                                    force.y,
                                    0,
                                    n.x,
                                    n.y,
                                    0,
                                    push,
                                    drag,
                                    most > 0 ? fmin(fabs(drag) / most, 1) : 0,
                                    c->depth};
        memcpy(f->rows[k], row, sizeof row);
        f->points[k] = plus(a->position, c->point);
        f->corners[k] = 1;
    }
}

void dem_write_vtk(dem *d, const char *stem, uint64_t number) {
    for (int i = 0; i < 2; i++) {
        char path[DEM_PATH_SIZE];
        frame f;
        snprintf(path, sizeof path, "%.1000s%s-%06llu.vtk", stem, i ? "-contacts" : "", (unsigned long long)number);
        (i ? make_contacts : make_bodies)(d, &f);
        dem_file out = dem_open_file(d, path);
        put_frame(out.file, d, &f);
        dem_release(f.corners);
        dem_release(f.points);
        dem_release(f.rows);
        dem_close_file(d, &out);
    }
}
