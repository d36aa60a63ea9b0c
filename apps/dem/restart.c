/* SPDX-License-Identifier: MIT
 *
 * restart.c - the state in a binary file, from which a run goes on bit for bit.
 *
 *     "narc-dem" | version | byte order mark | size of what follows the header | its checksum | input hash
 *     grain, wall, pair counts, sums, place in the run
 *     walls, the arrays of bodies, the pair list with its hints and histories, the contacts with their forces
 *
 * Shapes, materials and laws are not there: the input has them, and the input's hash says that it is the same. What
 * stages have changed is: gravity, laws, walls.
 */
#define _XOPEN_SOURCE 700 /* open_memstream */
#include <stdlib.h>
#include <string.h>

#include "dem.h"

typedef struct header {
    char magic[8];
    uint32_t version, byte_order;
    uint64_t size, checksum, input;
} header;

static const char MAGIC[8] = {'n', 'a', 'r', 'c', '-', 'd', 'e', 'm'};
enum { VERSION = 5, BYTE_ORDER_MARK = 0x01020304 };

typedef struct counts {
    uint64_t bodies, walls, pairs, contacts, extra;
} counts;

/* ------------------------------------------------------------------------------------------------ one way for both */

/* Writing, to `file`; reading, from `bytes`. */
typedef struct stream {
    FILE *file;
    const char *bytes;
    size_t size, used;
    bool ok;
} stream;

static void pass(stream *s, void *data, size_t size) {
    if (s->file)
        s->ok = fwrite(data, 1, size, s->file) == size && s->ok;
    else if ((s->ok = s->ok && size <= s->size - s->used) && size > 0)
        memcpy(data, s->bytes + s->used, size);
    s->used += size;
}

/* What is not an array. */
static void pass_sums(stream *s, dem *d, dem_place *place) {
    pass(s, &d->step, sizeof d->step);
    pass(s, &d->list_builds, sizeof d->list_builds);
    double *const sums[] = {&d->time,           &d->damping, &d->friction,    &d->normal_energy, &d->tangential_energy,
                            &d->rolling_energy, &d->offset,  &d->list_offset, &d->pull,          &d->shear_work,
                            &d->settings.shear};
    for (size_t i = 0; i < sizeof sums / sizeof sums[0]; i++)
        pass(s, sums[i], sizeof *sums[i]);
    pass(s, &d->settings.gravity, sizeof d->settings.gravity);
    pass(s, d->laws, sizeof d->laws);
    pass(s, place, sizeof *place);
}

/* Walls without their names and whatever else does not change. */
static void pass_walls(stream *s, dem *d) {
    for (size_t i = 0; i < d->wall_count; i++) {
        dem_wall *w = &d->walls[i];
        dem_servo *servo = &w->servo;
        int32_t on[2] = {servo->on, 0};
        double *const numbers[] = {&w->spin,       &w->work,     &w->idle_way,      &servo->force,
                                   &servo->stress, &servo->gain, &servo->max_speed, &servo->travel};
        pass(s, &w->velocity, sizeof w->velocity);
        pass(s, &w->pivot, sizeof w->pivot);
        pass(s, &servo->direction, sizeof servo->direction);
        for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++)
            pass(s, numbers[k], sizeof *numbers[k]);
        pass(s, servo->between, sizeof servo->between);
        pass(s, on, sizeof on);
        servo->on = on[0] != 0;
    }
}

static void pass_arrays(stream *s, dem *d) {
    const dem_pairs *p = &d->pairs;
    void *column;
    size_t size;
    for (size_t i = 0; (column = dem_body_column(d, i, &size)) != NULL; i++)
        pass(s, column, d->bodies.count * size);
    pass(s, p->a, p->count * sizeof *p->a);
    pass(s, p->b, p->count * sizeof *p->b);
    pass(s, p->shift_x, p->count * sizeof *p->shift_x);
    pass(s, p->shift_y, p->count * sizeof *p->shift_y);
    pass(s, p->hints, p->count * sizeof *p->hints);
    pass(s, p->memory, p->count * sizeof *p->memory);
    pass(s, p->rolling, p->count * sizeof *p->rolling);
    /* What the last step found: a run that has no more steps is asked for it. */
    pass(s, d->contacts.rows, d->contacts.count * sizeof *d->contacts.rows);
}

static void pass_all(stream *s, dem *d, dem_place *place) {
    pass_sums(s, d, place);
    pass_walls(s, d);
    pass_arrays(s, d);
}

/* ------------------------------------------------------------------------------------------------ writing */

bool dem_write_restart(dem *d, const dem_place *place, const char *path) {
    counts n = {d->bodies.count, d->wall_count, d->pairs.count, d->contacts.count, d->scratch->extra_count};
    dem_place where = *place;
    dem_file file;
    char *bytes = NULL;
    size_t size = 0;
    stream out = {.file = open_memstream(&bytes, &size), .ok = true};
    if (out.file) {
        pass(&out, &n, sizeof n);
        pass_all(&out, d, &where);
        out.ok = fclose(out.file) == 0 && out.ok;
    }
    bool ok = out.file && out.ok;
    if (!ok)
        dem_fail(d, "%.400s: not enough memory for a restart", path);
    else if ((ok = dem_open_file(&file, path, d->error))) {
        header head = {.version = VERSION,
                       .byte_order = BYTE_ORDER_MARK,
                       .size = size,
                       .checksum = dem_hash_bytes(DEM_HASH_START, bytes, size),
                       .input = place->input};
        memcpy(head.magic, MAGIC, sizeof head.magic);
        fwrite(&head, 1, sizeof head, file.file); /* closing tells of errors */
        fwrite(bytes, 1, size, file.file);
        ok = dem_close_file(&file, true, d->error);
    }
    free(bytes);
    return ok;
}

/* ------------------------------------------------------------------------------------------------ reading */

static bool check_header(dem *d, const char *path, const char *bytes, size_t size, uint64_t input) {
    header head;
    if (size < sizeof head || memcmp(bytes, MAGIC, sizeof MAGIC) != 0)
        return dem_fail(d, "%s: it is not a restart file", path);
    memcpy(&head, bytes, sizeof head);
    if (head.byte_order != BYTE_ORDER_MARK)
        return dem_fail(d, "%s: it comes from a machine with another order of bytes", path);
    if (head.version != VERSION)
        return dem_fail(d, "%s: its version is %u, this program reads %d", path, (unsigned)head.version, VERSION);
    if (head.size != size - sizeof head)
        return dem_fail(d, "%s: it has %zu bytes, and should have %llu", path, size,
                        (unsigned long long)head.size + sizeof head);
    if (head.checksum != dem_hash_bytes(DEM_HASH_START, bytes + sizeof head, size - sizeof head))
        return dem_fail(d, "%s: it is damaged, its checksum does not fit", path);
    if (head.input != input)
        return dem_fail(d, "%s: it belongs to another input: grains, walls, laws, boundary or shapes differ", path);
    return true;
}

/* The checksum has passed: what is checked here only fails for a file that was made to fail. */
static bool check_indices(const dem *d) {
    for (size_t k = 0; k < d->pairs.count; k++)
        if (d->pairs.a[k] >= d->pairs.b[k] || d->pairs.b[k] >= d->parts.count || dem_body_a(d, k) >= d->grain_count)
            return false;
    for (size_t k = 0; k < d->contacts.count; k++)
        if (d->contacts.rows[k].pair >= d->pairs.count)
            return false;
    for (size_t k = 0; k < d->bodies.count; k++)
        if (d->bodies.shape[k] >= d->shape_count || d->parts.body[d->bodies.first_part[k]] != k ||
            d->bodies.material[k] >= d->material_count)
            return false;
    for (size_t w = 0; w < d->wall_count; w++)
        for (size_t i = 0; i < 2; i++) {
            const int other = d->walls[w].servo.between[i];
            if (other < -1 || (other >= 0 && (size_t)other >= d->wall_count) ||
                (other < 0) != (d->walls[w].servo.between[0] < 0))
                return false;
        }
    return true;
}

static bool make_room(dem *d, const counts *n) {
    if (n->bodies != d->bodies.count || n->walls != d->wall_count || n->pairs >= UINT32_MAX || n->contacts > n->pairs ||
        !dem_grow_pairs(d, &d->pairs, n->pairs) || !dem_make_room_for_contacts(d))
        return false;
    d->pairs.count = n->pairs;
    d->contacts.count = n->contacts;
    d->scratch->extra_count = n->extra;
    return true;
}

bool dem_read_restart(dem *d, dem_place *place, const char *path) {
    size_t size;
    char *bytes = dem_read_file(path, &size, d->error);
    if (!bytes)
        return false;
    bool ok = check_header(d, path, bytes, size, place->input);
    if (ok) {
        stream in = {.bytes = bytes + sizeof(header), .size = size - sizeof(header), .ok = true};
        counts n;
        pass(&in, &n, sizeof n);
        ok = in.ok && make_room(d, &n);
        if (ok)
            pass_all(&in, d, place);
        if (!ok || !in.ok || in.used != in.size || !check_indices(d))
            ok = dem_fail(d, "%s: its counts do not fit the input", path);
        else
            dem_find_dashpots(d);
    }
    free(bytes);
    return ok;
}
