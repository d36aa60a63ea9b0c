/* SPDX-License-Identifier: MIT
 *
 * restart.c - the state in a binary file, from which a run goes on bit for bit.
 *
 *     "narc-dem" | version | byte order mark | size of what follows the header | its checksum | input hash
 *     counts, sums, progress of the run, laws
 *     walls, bodies, the contacts with their forces, their histories by parts
 *
 * Shapes, materials and settings are not there: the input has them, and the input's hash says that it is the same. What
 * stages have changed is.
 */
#include <stdlib.h>
#include <string.h>

#include "dem.h"

typedef struct header {
    char magic[8];
    uint32_t version, byte_order;
    uint64_t size, checksum, input;
} header;

static const char MAGIC[8] = {'n', 'a', 'r', 'c', '-', 'd', 'e', 'm'};
enum { VERSION = 8, BYTE_ORDER_MARK = 0x01020304 };

typedef struct counts {
    uint64_t bodies, walls, contacts;
} counts;

/* Of a contact: its parts, and what is known of them. */
typedef struct history {
    uint32_t a, b;
    dem_memory memory;
} history;

/* Writing, to `file`; reading, from `bytes`. */
typedef struct stream {
    FILE *file;
    const char *bytes;
    size_t size, used;
    uint64_t checksum;
    bool ok;
} stream;

static void pass(stream *s, void *data, size_t size) {
    if (s->file) {
        fwrite(data, 1, size, s->file); /* closing tells of errors */
        s->checksum = dem_hash_bytes(s->checksum, data, size);
    } else if ((s->ok = s->ok && size <= s->size - s->used) && size > 0)
        memcpy(data, s->bytes + s->used, size);
    s->used += size;
}

#define PASS(thing)            pass(s, &(thing), sizeof(thing))
#define PASS_ALL(array, count) pass(s, array, (count) * sizeof *(array))

/* The checksum has passed: what is checked here and below only fails for a file that was made to fail. What bodies are
 * made of is the same. */
static void pass_wall(stream *s, dem *d, size_t index) {
    dem_wall *wall = &d->walls[index], now = *wall;
    const int count = (int)d->wall_count;
    PASS(now);
    const int first = now.servo.between[0], second = now.servo.between[1];
    s->ok = s->ok && strncmp(now.name, wall->name, sizeof now.name) == 0 && now.kind == wall->kind &&
            now.group == wall->group && first >= -1 && second >= -1 && first < count && second < count &&
            (first < 0) == (second < 0);
    *wall = s->ok ? now : *wall;
}

static void pass_body(stream *s, dem_body *b) {
    dem_body now = *b;
    PASS(now);
    s->ok = s->ok && now.shape == b->shape && now.material == b->material && now.first_part == b->first_part &&
            now.inverse_mass == b->inverse_mass && now.inverse_inertia == b->inverse_inertia && now.mass == b->mass &&
            now.inertia == b->inertia && now.extent == b->extent && now.disc == b->disc && now.reach == b->reach &&
            now.scale == b->scale;
    *b = s->ok ? now : *b;
}

static void pass_all(stream *s, dem *d, const counts *n, dem_progress *progress, history *histories) {
    PASS(*progress);
    PASS(d->step);
    PASS(d->time);
    PASS(d->renewals);
    PASS(d->account);
    PASS(d->offset);
    PASS(d->last_offset);
    PASS(d->last_size);
    PASS(d->sides);
    PASS(d->stress);
    PASS(d->pull);
    PASS(d->shear_work);
    PASS(d->settings.rates);
    PASS(d->settings.low);
    PASS(d->settings.high);
    PASS(d->settings.gravity);
    PASS(d->laws);
    for (size_t w = 0; w < d->wall_count; w++)
        pass_wall(s, d, w);
    for (size_t k = 0; k < d->body_count; k++)
        pass_body(s, &d->bodies[k]);
    PASS_ALL(d->contacts, n->contacts); /* a run that has no more steps is asked for them */
    PASS_ALL(histories, n->contacts);
}

void dem_write_restart(dem *d, const dem_progress *progress, const char *path) {
    counts n = {d->body_count, d->wall_count, d->contact_count};
    history *histories = NULL;
    dem_progress where = *progress;
    header head = {.version = VERSION, .byte_order = BYTE_ORDER_MARK, .input = progress->input};
    dem_file file = dem_open_file(d, path);
    stream out = {.file = file.file, .checksum = DEM_HASH_START, .ok = true};
    memcpy(head.magic, MAGIC, sizeof head.magic);
    dem_grow(&histories, d->contact_count, sizeof *histories);
    for (size_t k = 0; k < d->contact_count; k++) {
        const size_t pair = d->contacts[k].pair;
        histories[k] = (history){d->pairs[pair].a, d->pairs[pair].b, *dem_memory_of(d, pair)};
    }
    fwrite(&head, 1, sizeof head, file.file); /* room for it */
    pass(&out, &n, sizeof n);
    pass_all(&out, d, &n, &where, histories);
    dem_release(histories);
    head.size = out.used;
    head.checksum = out.checksum;
    rewind(file.file);
    fwrite(&head, 1, sizeof head, file.file);
    dem_close_file(d, &file);
}

/* ------------------------------------------------------------------------------------------------ reading */

/* What is wrong with the file, in `problem`. */
static bool check_header(const char *bytes, size_t size, uint64_t input, char *problem, size_t problem_size) {
    header head;
    memcpy(&head, bytes, size < sizeof head ? 0 : sizeof head);
    if (size < sizeof head || memcmp(bytes, MAGIC, sizeof MAGIC) != 0)
        snprintf(problem, problem_size, "it is not a restart file");
    else if (head.byte_order != BYTE_ORDER_MARK)
        snprintf(problem, problem_size, "it comes from a machine with another order of bytes");
    else if (head.version != VERSION)
        snprintf(problem, problem_size, "its version is %u, this program reads %d", (unsigned)head.version, VERSION);
    else if (head.size != size - sizeof head)
        snprintf(problem, problem_size, "it has %zu bytes, and should have %llu", size,
                 (unsigned long long)head.size + sizeof head);
    else if (head.checksum != dem_hash_bytes(DEM_HASH_START, bytes + sizeof head, size - sizeof head))
        snprintf(problem, problem_size, "it is damaged, its checksum does not fit");
    else if (head.input != input)
        snprintf(problem, problem_size, "it belongs to another input: grains, walls, laws, boundary or shapes differ");
    else
        return true;
    return false;
}

/* Finds images and pairs again, and gives the pairs their histories. */
static bool take_histories(dem *d, const counts *n, const history *histories) {
    bool ok = true;
    dem_find_images(d);
    dem_find_pairs(d, true);
    for (size_t k = 0; k < n->contacts && ok; k++) {
        const size_t pair = d->contacts[k].pair;
        ok = pair < d->pair_count && histories[k].a == d->pairs[pair].a && histories[k].b == d->pairs[pair].b;
        if (ok)
            *dem_memory_of(d, pair) = histories[k].memory;
    }
    d->contact_count = ok ? n->contacts : 0;
    return ok;
}

void dem_read_restart(dem *d, dem_progress *progress, const char *path) {
    size_t size;
    char *bytes = dem_read_file(path, &size), problem[128] = "its bodies do not fit the input";
    bool ok = check_header(bytes, size, progress->input, problem, sizeof problem);
    if (ok) {
        stream in = {.bytes = bytes + sizeof(header), .size = size - sizeof(header), .ok = true};
        counts n = {0};
        history *histories = NULL;
        pass(&in, &n, sizeof n);
        ok = n.bodies == d->body_count && n.walls == d->wall_count && n.contacts <= in.size / sizeof(history);
        if (ok) {
            dem_grow(&histories, n.contacts, sizeof *histories);
            dem_grow(&d->contacts, n.contacts, sizeof *d->contacts);
            pass_all(&in, d, &n, progress, histories);
            ok = in.ok && in.used == in.size && take_histories(d, &n, histories);
        }
        dem_release(histories);
    }
    dem_release(bytes);
    if (!ok)
        dem_fail(d, "%s: %s", path, problem);
}
