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
#include <stdlib.h>
#include <string.h>

#include "internal.h"

typedef struct header {
    char magic[8];
    uint32_t version, byte_order;
    uint64_t size, checksum, input;
} header;

static const char MAGIC[8] = {'n', 'a', 'r', 'c', '-', 'd', 'e', 'm'};
enum { VERSION = 3, BYTE_ORDER_MARK = 0x01020304 };

/* What is not an array. */
typedef struct sums {
    uint64_t bodies, walls, pairs, contacts, extra, step, list_builds;
    double time, damping, friction, normal_energy, tangential_energy, rolling_energy;
    dem_vec gravity;
    dem_contact_law laws[DEM_MAX_MATERIALS][DEM_MAX_MATERIALS];
    dem_place place;
} sums;

/* A wall without its name and whatever else does not change. Every byte is told. */
typedef struct wall_state {
    dem_vec velocity, pivot, direction;
    double spin, work, resistance, idle_way, force, stress, gain, max_speed, travel;
    int32_t between[2], on, padding;
} wall_state;

/* ------------------------------------------------------------------------------------------------ one way for both */

/* Writing, `file`; reading, from `bytes`; or only counting and hashing. */
typedef struct stream {
    FILE *file;
    const unsigned char *bytes; /* reading */
    size_t size, used;
    uint64_t hash;
    bool reads, ok;
} stream;

static void pass(stream *s, void *data, size_t size) {
    if (s->reads) {
        s->ok = s->ok && size <= s->size - s->used;
        if (s->ok && size > 0)
            memcpy(data, s->bytes + s->used, size);
    } else {
        s->hash = dem_hash_bytes(s->hash, data, size);
        if (s->file && size > 0)
            s->ok = fwrite(data, 1, size, s->file) == size && s->ok;
    }
    s->used += size;
}

static void pass_walls(stream *s, dem *d) {
    for (size_t i = 0; i < d->wall_count && s->ok; i++) {
        dem_wall *w = &d->walls[i];
        dem_servo *servo = &w->servo;
        wall_state state = {.velocity = w->velocity,
                            .pivot = w->pivot,
                            .direction = servo->direction,
                            .spin = w->spin,
                            .work = w->work,
                            .resistance = w->resistance,
                            .idle_way = w->idle_way,
                            .force = servo->force,
                            .stress = servo->stress,
                            .gain = servo->gain,
                            .max_speed = servo->max_speed,
                            .travel = servo->travel,
                            .between = {servo->between[0], servo->between[1]},
                            .on = servo->on};
        pass(s, &state, sizeof state);
        w->velocity = state.velocity;
        w->pivot = state.pivot;
        w->spin = state.spin;
        w->work = state.work;
        w->resistance = state.resistance;
        w->idle_way = state.idle_way;
        *servo = (dem_servo){.on = state.on != 0,
                             .direction = state.direction,
                             .force = state.force,
                             .stress = state.stress,
                             .between = {state.between[0], state.between[1]},
                             .gain = state.gain,
                             .max_speed = state.max_speed,
                             .travel = state.travel};
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
}

/* What the last step found: a run that has no more steps is asked for it. */
static void pass_contacts(stream *s, const dem *d) {
    const dem_contacts *c = &d->contacts;
    pass(s, c->rows, c->count * sizeof *c->rows);
    pass(s, c->forces, c->count * sizeof *c->forces);
}

/* ------------------------------------------------------------------------------------------------ writing */

static sums collect_sums(const dem *d, const dem_place *place) {
    sums all;
    memset(&all, 0, sizeof all);
    all.bodies = d->bodies.count;
    all.walls = d->wall_count;
    all.pairs = d->pairs.count;
    all.contacts = d->contacts.count;
    all.extra = d->scratch->extra_count;
    all.step = d->step;
    all.list_builds = d->list_builds;
    all.time = d->time;
    all.damping = d->damping;
    all.friction = d->friction;
    all.normal_energy = d->normal_energy;
    all.tangential_energy = d->tangential_energy;
    all.rolling_energy = d->rolling_energy;
    all.gravity = d->settings.gravity;
    memcpy(all.laws, d->laws, sizeof all.laws);
    all.place = *place;
    return all;
}

static void pass_all(stream *s, dem *d, sums *all) {
    pass(s, all, sizeof *all);
    pass_walls(s, d);
    pass_arrays(s, d);
    pass_contacts(s, d);
}

bool dem_write_restart(const dem *d, const dem_place *place, const char *path, char *error) {
    sums all = collect_sums(d, place);
    dem state = *d; /* pass() reads it only */
    stream count = {.hash = DEM_HASH_START, .ok = true}, out = {.hash = DEM_HASH_START, .ok = true};
    pass_all(&count, &state, &all);
    header head = {.version = VERSION,
                   .byte_order = BYTE_ORDER_MARK,
                   .size = count.used,
                   .checksum = count.hash,
                   .input = place->input};
    memcpy(head.magic, MAGIC, sizeof head.magic);
    dem_file file;
    if (!dem_open_file(&file, path, error))
        return false;
    out.file = file.file;
    pass(&out, &head, sizeof head);
    pass_all(&out, &state, &all);
    return dem_close_file(&file, true, error);
}

/* ------------------------------------------------------------------------------------------------ reading */

static unsigned char *read_all(dem *d, const char *path, size_t *out_size) {
    unsigned char *bytes = NULL;
    size_t capacity = 0, size = 0;
    FILE *file = fopen(path, "rb");
    if (!file) {
        dem_fail(d, "%s: it cannot be read", path);
        return NULL;
    }
    for (size_t got = 1; got > 0; size += got) {
        if (!dem_reserve(d, &bytes, &capacity, size + 65536, 1))
            break;
        got = fread(bytes + size, 1, capacity - size, file);
    }
    const bool ok = !ferror(file) && feof(file);
    fclose(file);
    if (!ok) {
        dem_fail(d, "%s: it cannot be read", path);
        free(bytes);
        return NULL;
    }
    *out_size = size;
    return bytes;
}

static bool check_header(dem *d, const char *path, const unsigned char *bytes, size_t size, uint64_t input) {
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
        if (d->pairs.a[k] >= d->pairs.b[k] || d->pairs.b[k] >= d->bodies.count || d->pairs.a[k] >= d->grain_count)
            return false;
    for (size_t k = 0; k < d->contacts.count; k++)
        if (d->contacts.rows[k].pair >= d->pairs.count)
            return false;
    for (size_t k = 0; k < d->bodies.count; k++)
        if (d->bodies.shape[k] >= d->shape_count || d->bodies.material[k] >= d->material_count)
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

static bool take_sums(dem *d, const sums *all) {
    if (all->bodies != d->bodies.count || all->walls != d->wall_count || all->pairs >= UINT32_MAX ||
        all->contacts > all->pairs || !dem_grow_pairs(d, &d->pairs, all->pairs) || !dem_make_room_for_contacts(d))
        return false;
    d->pairs.count = all->pairs;
    d->contacts.count = all->contacts;
    d->scratch->extra_count = all->extra;
    d->step = all->step;
    d->list_builds = all->list_builds;
    d->time = all->time;
    d->damping = all->damping;
    d->friction = all->friction;
    d->normal_energy = all->normal_energy;
    d->tangential_energy = all->tangential_energy;
    d->rolling_energy = all->rolling_energy;
    d->settings.gravity = all->gravity;
    memcpy(d->laws, all->laws, sizeof d->laws);
    return true;
}

bool dem_read_restart(dem *d, dem_place *place, const char *path) {
    size_t size;
    unsigned char *bytes = read_all(d, path, &size);
    if (!bytes)
        return false;
    bool ok = check_header(d, path, bytes, size, place->input);
    if (ok) {
        stream in = {.bytes = bytes + sizeof(header), .size = size - sizeof(header), .reads = true, .ok = true};
        sums all;
        pass(&in, &all, sizeof all);
        ok = in.ok && take_sums(d, &all);
        if (ok) {
            pass_walls(&in, d);
            pass_arrays(&in, d);
            pass_contacts(&in, d);
            *place = all.place;
        }
        if (!ok || !in.ok || in.used != in.size || !check_indices(d) || !dem_index_pairs(d))
            ok = dem_fail(d, "%s: its counts do not fit the input", path);
    }
    free(bytes);
    return ok;
}
