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

#define PASS(thing) pass(s, &(thing), sizeof(thing))

/* Of walls all but names and whatever else does not change. */
static void pass_all(stream *s, dem *d, dem_place *place) {
    const dem_pairs *p = &d->pairs;
    double *const sums[] = {&d->time,           &d->damping, &d->friction,    &d->normal_energy, &d->tangential_energy,
                            &d->rolling_energy, &d->offset,  &d->list_offset, &d->pull,          &d->shear_work,
                            &d->settings.shear};
    PASS(d->step);
    PASS(d->list_builds);
    for (size_t i = 0; i < sizeof sums / sizeof sums[0]; i++)
        PASS(*sums[i]);
    PASS(d->settings.gravity);
    PASS(d->laws);
    PASS(*place);
    for (dem_wall *w = d->walls; w < d->walls + d->wall_count; w++) {
        dem_servo *servo = &w->servo;
        int32_t on[2] = {servo->on, 0};
        double *const numbers[] = {&w->spin,       &w->work,     &w->idle_way,      &servo->force,
                                   &servo->stress, &servo->gain, &servo->max_speed, &servo->travel};
        PASS(w->velocity);
        PASS(w->pivot);
        PASS(servo->direction);
        for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++)
            PASS(*numbers[k]);
        PASS(servo->between);
        PASS(on);
        servo->on = on[0] != 0;
    }
    void *column;
    size_t size;
    for (size_t i = 0; (column = dem_body_column(d, i, &size)) != NULL; i++)
        pass(s, column, d->bodies.count * size);
    void *const pairs[] = {p->a, p->b, p->shift_x, p->shift_y, p->hints, p->memory, p->rolling};
    const size_t sizes[] = {sizeof *p->a,     sizeof *p->b,      sizeof *p->shift_x, sizeof *p->shift_y,
                            sizeof *p->hints, sizeof *p->memory, sizeof *p->rolling};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        pass(s, pairs[i], p->count * sizes[i]);
    /* What the last step found: a run that has no more steps is asked for it. */
    pass(s, d->contacts.rows, d->contacts.count * sizeof *d->contacts.rows);
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
    bool ok = true;
    for (size_t k = 0; k < d->pairs.count && ok; k++)
        ok = d->pairs.a[k] < d->pairs.b[k] && d->pairs.b[k] < d->parts.count && dem_body_a(d, k) < d->grain_count;
    for (size_t k = 0; k < d->contacts.count && ok; k++)
        ok = d->contacts.rows[k].pair < d->pairs.count;
    for (size_t k = 0; k < d->bodies.count && ok; k++)
        ok = d->bodies.shape[k] < d->shape_count && d->bodies.material[k] < d->material_count &&
             d->bodies.first_part[k] < d->parts.count && d->parts.body[d->bodies.first_part[k]] == k;
    for (size_t i = 0; i < 2 * d->wall_count && ok; i++) {
        const int *between = d->walls[i / 2].servo.between, other = between[i % 2];
        ok = other >= -1 && other < (int)d->wall_count && (other < 0) == (between[0] < 0);
    }
    return ok;
}

bool dem_read_restart(dem *d, dem_place *place, const char *path) {
    size_t size;
    char *bytes = dem_read_file(path, &size, d->error);
    if (!bytes)
        return false;
    const bool belongs = check_header(d, path, bytes, size, place->input);
    bool ok = belongs;
    if (belongs) {
        stream in = {.bytes = bytes + sizeof(header), .size = size - sizeof(header), .ok = true};
        counts n;
        pass(&in, &n, sizeof n);
        ok = in.ok && n.bodies == d->bodies.count && n.walls == d->wall_count && n.pairs < UINT32_MAX &&
             n.contacts <= n.pairs && dem_grow_pairs(d, &d->pairs, n.pairs) && dem_make_room_for_contacts(d);
        if (ok) {
            d->pairs.count = n.pairs;
            d->contacts.count = n.contacts;
            d->scratch->extra_count = n.extra;
            pass_all(&in, d, place);
        }
        ok = ok && in.ok && in.used == in.size && check_indices(d);
    }
    if (belongs && !ok)
        dem_fail(d, "%s: its counts do not fit the input", path);
    free(bytes);
    return ok;
}
