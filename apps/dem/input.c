/* SPDX-License-Identifier: MIT
 *
 * input.c - the JSON file: its head, materials, contact laws, stages, outputs.
 */
#define _XOPEN_SOURCE 700 /* stat */
#include "input.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

void dem_fail_at(const json_value *value, const dem *d) {
    fail("%s: %s%s%s", value->file, value->place, value->place[0] ? ": " : "", d->error);
}

void *dem_allocate(size_t count, size_t size) {
    void *memory = calloc(count + 1, size);
    if (!memory)
        fail("not enough memory for the input");
    return memory;
}

/* ------------------------------------------------------------------------------------------------ materials */

uint32_t dem_find_material(const json_value *name, const dem *d) {
    return (uint32_t)json_find(name, d->materials, d->material_count, sizeof *d->materials, "is not a material");
}

static void read_materials(const json_value *list, dem *d) {
    for (json_value item = {0}; json_next(list, &item);) {
        dem_material *material = &d->materials[d->material_count];
        json_read(&item, (json_key[]){{"name", MUST | TEXT, material->name, 0, sizeof material->name},
                                      {"density", MUST | POSITIVE, &material->density},
                                      {"young", POSITIVE, &material->young},
                                      {"poisson", NUMBER, &material->poisson, 0, 0.5},
                                      {NULL}});
        for (size_t m = 0; m < d->material_count; m++)
            if (strcmp(d->materials[m].name, material->name) == 0)
                json_refuse(&item, "name", "is the name of another material");
        if (d->settings.law == DEM_LINEAR)
            json_refuse(&item, "young poisson", "is of the Hertz law: the linear law's stiffness is kn");
        else {
            json_require(&item, "young");
            json_require(&item, "poisson");
        }
        d->material_count++;
    }
}

/* ------------------------------------------------------------------------------------------------ laws */

/* What is there replaces what `law` has. A list of pairs, or the materials of a pair, goes to `list`. */
static void read_law(const json_value *object, dem_law kind, dem_contact_law *law, json_value *list) {
    double restitution = 1;
    json_read(object, (json_key[]){{"law", ANY},
                                   {"pairs", LIST, list},
                                   {"materials", LIST, list, 2, 2},
                                   {"kn", POSITIVE, &law->kn},
                                   {"kt", NUMBER, &law->kt, 0, 1e300},
                                   {"restitution", NUMBER, &restitution, 1e-6, 1},
                                   {"gamma_n", NUMBER, &law->gamma_n, 0, 1e300},
                                   {"gamma_t", NUMBER, &law->gamma_t, 0, 1e300},
                                   {"tangential_damping", NUMBER, &law->tangential_share, 0, 100},
                                   {"friction", NUMBER, &law->friction, 0, 1e6},
                                   {"rolling_friction", NUMBER, &law->rolling_friction, 0, 1e6},
                                   {NULL}});
    if (kind == DEM_HERTZ)
        json_refuse(object, "kn kt", "is not of the Hertz law: stiffness comes from the materials");
    if (json_has(object, "kn") && !json_has(object, "kt"))
        law->kt = 2.0 / 7 * law->kn; /* as LAMMPS has it */
    if (json_has(object, "restitution")) {
        json_refuse(object, "gamma_n", "excludes restitution");
        law->damping_ratio = dem_damping_ratio(kind, restitution);
    }
    if (json_has(object, "gamma_n")) {
        law->gamma_t = json_has(object, "gamma_t") ? law->gamma_t : 0.5 * law->gamma_n;
        law->damping_ratio = -1;
    }
    if (law->damping_ratio < 0 && law->gamma_n < 0)
        json_fail(object, "has neither restitution nor gamma_n");
    if (law->damping_ratio < 0)
        json_refuse(object, "tangential_damping", "is for restitution; with gamma_n it is gamma_t");
    else
        json_refuse(object, "gamma_t", "is for gamma_n; with restitution it is tangential_damping");
}

/* The law is asked before the materials, which depend on it. */
static dem_law find_law(const json_value *contact) {
    static const char names[][8] = {[DEM_LINEAR] = "linear", [DEM_HERTZ] = "hertz"};
    json_require(contact, "law");
    const json_value law = json_member(contact, "law");
    return (dem_law)json_find(&law, names, 2, sizeof names[0], "is neither linear nor hertz");
}

static void read_contact(const json_value *contact, dem *d) {
    dem_contact_law common = {.damping_ratio = -1, .gamma_n = -1, .tangential_share = 0.5};
    json_value pairs = {.item = NULL}, names;
    bool seen[DEM_MAX_MATERIALS][DEM_MAX_MATERIALS] = {{false}};
    if (d->settings.law == DEM_LINEAR)
        json_require(contact, "kn");
    json_require(contact, "friction");
    json_refuse(contact, "materials", "is for pairs");
    read_law(contact, d->settings.law, &common, &pairs);
    for (size_t a = 0; a < d->material_count; a++)
        for (size_t b = a; b < d->material_count; b++)
            dem_set_law(d, (uint32_t)a, (uint32_t)b, common);
    for (json_value item = {0}; json_next(&pairs, &item);) {
        dem_contact_law law = common;
        uint32_t index[2];
        json_require(&item, "materials");
        json_refuse(&item, "law pairs", "is not for a pair");
        read_law(&item, d->settings.law, &law, &names);
        for (json_value name = {0}; json_next(&names, &name);)
            index[name.index] = dem_find_material(&name, d);
        if (seen[index[0]][index[1]])
            json_fail(&names, "is a pair that stands before");
        seen[index[0]][index[1]] = seen[index[1]][index[0]] = true;
        dem_set_law(d, index[0], index[1], law);
    }
}

/* ------------------------------------------------------------------------------------------------ stages */

/* At least one. */
static uint64_t count_steps(const json_value *object, const char *key, double time, const dem *d) {
    const double steps = time / d->settings.time_step;
    if (steps > 1e15)
        json_refuse(object, key, "is more than 1e15 time steps");
    return steps < 1 ? 1 : (uint64_t)(steps + 0.5);
}

static void read_stages(const json_value *list, const dem *d, dem_input *input) {
    input->stages = dem_allocate((size_t)cJSON_GetArraySize(list->item), sizeof *input->stages);
    bool *has_servo = dem_allocate(d->wall_count, sizeof *has_servo);
    for (size_t w = 0; w < d->wall_count; w++)
        has_servo[w] = d->walls[w].servo.on;
    for (json_value item = {0}; json_next(list, &item);) {
        dem_stage *stage = &input->stages[item.index];
        double duration;
        json_value walls = {.item = NULL};
        snprintf(stage->name, sizeof stage->name, "stage %zu", item.index);
        json_read(&item, (json_key[]){{"name", NAME, stage->name, 0, sizeof stage->name},
                                      {"duration", MUST | POSITIVE, &duration},
                                      {"gravity", PAIR, &stage->gravity},
                                      {"friction", NUMBER, &stage->friction, 0, 1e6},
                                      {"shear", NUMBER, &stage->shear},
                                      {"walls", ANY, &walls},
                                      {NULL}});
        stage->steps = count_steps(&item, "duration", duration, d);
        stage->sets_gravity = json_has(&item, "gravity");
        stage->sets_friction = json_has(&item, "friction");
        stage->sets_shear = json_has(&item, "shear");
        if (!d->settings.sheared)
            json_refuse(&item, "shear", "is of a cell whose boundary has shear");
        if (stage->sets_gravity && d->settings.sheared)
            json_fail(&item, "has gravity in a sheared cell");
        if (walls.item)
            dem_read_changes(&walls, d, has_servo, stage);
        input->stage_count++;
    }
    free(has_servo);
}

/* ------------------------------------------------------------------------------------------------ output */

static bool is_same_file(const char *one, const char *other) {
    struct stat a, b;
    return stat(one, &a) == 0 && stat(other, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

static bool is_table(const char *name) {
    const size_t length = strlen(name);
    return length >= 4 && strcmp(name + length - 4, ".csv") == 0;
}

/* An output may not take the place of an input. */
static void check_names(const json_value *object, const dem_output *o, const char *shapes) {
    static const char *const keys[] = {"csv", "grains", "vtk", "restart"};
    const char *const names[] = {o->csv, o->grains, o->vtk, o->restart};
    for (size_t i = 0; i < 4; i++) {
        if (is_same_file(object->file, names[i]))
            json_refuse(object, keys[i], "is the input itself");
        if (is_same_file(shapes, names[i]))
            json_refuse(object, keys[i], "is the file of shapes");
        if (i < 2 && names[i][0] && !is_table(names[i]))
            json_refuse(object, keys[i], "does not end in .csv");
    }
    if (o->restart[0] && strcmp(o->restart, o->csv) == 0)
        json_fail(object, "names one file twice");
    if (!o->restart[0])
        json_refuse(object, "restart_every", "is there without restart");
    if (strstr(o->vtk, ".vtk"))
        json_refuse(object, "vtk", "has a suffix: numbers of frames and .vtk are added");
}

static void read_output(const json_value *object, const dem *d, dem_input *input) {
    dem_output *o = &input->output;
    double every, restart_every = 1e300;
    json_read(object, (json_key[]){{"every", MUST | POSITIVE, &every},
                                   {"csv", TEXT, o->csv, 0, sizeof o->csv},
                                   {"grains", TEXT, o->grains, 0, sizeof o->grains},
                                   {"vtk", TEXT, o->vtk, 0, sizeof o->vtk},
                                   {"restart", TEXT, o->restart, 0, sizeof o->restart},
                                   {"restart_every", POSITIVE, &restart_every},
                                   {"region", REGION, &o->region},
                                   {NULL}});
    check_names(object, o, input->shapes);
    o->every = count_steps(object, "every", every, d);
    if (json_has(object, "restart_every"))
        o->restart_every = count_steps(object, "restart_every", restart_every, d);
}

/* ------------------------------------------------------------------------------------------------ the whole */

static void read_boundary(const json_value *boundary, dem_settings *s) {
    vec x = {0, 0}, y = {0, 0};
    json_read(boundary, (json_key[]){{"x", PAIR, &x}, {"y", PAIR, &y}, {"shear", NUMBER, &s->shear}, {NULL}});
    s->sheared = json_has(boundary, "shear");
    s->periodic_x = json_has(boundary, "x");
    s->periodic_y = json_has(boundary, "y");
    if (!(x.y > x.x))
        json_refuse(boundary, "x", "is not a range [low, high]");
    if (!(y.y > y.x))
        json_refuse(boundary, "y", "is not a range [low, high]");
    s->low = (vec){x.x, y.x};
    s->high = (vec){x.y, y.y};
}

/* The file of shapes is named from the input's folder. */
static void find_shapes_file(const char *input, const char *name, char *out_path, size_t size) {
    const char *slash = strrchr(input, '/');
    const size_t folder = slash && name[0] != '/' && slash - input < DEM_PATH_SIZE ? (size_t)(slash - input) + 1 : 0;
    snprintf(out_path, size, "%.*s%s", (int)folder, input, name);
}

/* Of all that decides what bodies there are and how they push each other. */
static uint64_t hash_input(const json_value *root, const dem *d) {
    uint64_t hash = DEM_HASH_START;
    const cJSON *item;
    cJSON_ArrayForEach(item, root->item) {
        if (strcmp(item->string, "stages") == 0 || strcmp(item->string, "output") == 0)
            continue;
        char *text = cJSON_PrintUnformatted(item);
        if (!text)
            fail("not enough memory for the input");
        hash = dem_hash_bytes(hash, item->string, strlen(item->string));
        hash = dem_hash_bytes(hash, text, strlen(text));
        cJSON_free(text);
    }
    for (uint32_t k = 0; k < narc_count_shapes(d->store); k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        const size_t count = narc_get_arcs(d->store, k, arcs);
        hash = dem_hash_bytes(hash, arcs, count * sizeof *arcs);
    }
    return hash;
}

void dem_read_input(const char *path, unsigned threads, dem *d, dem_input *input) {
    const json_value root = json_read_file(path), shapes_file = json_member(&root, "shapes");
    dem_settings s = dem_defaults;
    char shapes[DEM_PATH_SIZE];
    json_value materials, contact, grains, stages, none = {.item = NULL}, boundary = none, walls = none, output = none;
    *input = (dem_input){.random = 1, .output = {.every = UINT64_MAX, .restart_every = UINT64_MAX}};
    json_read(&root, (json_key[]){{"comment", ANY},
                                  {"materials", MUST | LIST, &materials, 1, DEM_MAX_MATERIALS},
                                  {"shapes", MUST | TEXT, shapes, 0, sizeof shapes},
                                  {"thickness", POSITIVE, &s.thickness},
                                  {"gravity", PAIR, &s.gravity},
                                  {"boundary", ANY, &boundary},
                                  {"time_step", MUST | POSITIVE, &s.time_step},
                                  {"skin", MUST | POSITIVE, &s.skin},
                                  {"max_overlap", NUMBER, &s.max_overlap, 1e-6, 1},
                                  {"seed", WHOLE, &input->random, 0, 0x1p53},
                                  {"contact", MUST | ANY, &contact},
                                  {"walls", LIST, &walls},
                                  {"grains", MUST | LIST, &grains},
                                  {"stages", MUST | LIST, &stages, 1, 1e9},
                                  {"output", ANY, &output},
                                  {NULL}});
    s.threads = threads;
    s.law = find_law(&contact);
    if (boundary.item)
        read_boundary(&boundary, &s);
    if (!dem_create(d, s))
        dem_fail_at(&root, d);
    find_shapes_file(path, shapes, input->shapes, sizeof input->shapes);
    read_materials(&materials, d);
    read_contact(&contact, d);
    dem_read_shapes(&shapes_file, input->shapes, d);
    dem_read_walls(&walls, d);
    dem_read_grains(&grains, d, &input->random);
    read_stages(&stages, d, input);
    if (output.item)
        read_output(&output, d, input);
    if (!dem_start(d))
        dem_fail_at(&root, d);
    input->hash = hash_input(&root, d);
    cJSON_Delete((cJSON *)root.item);
}

void dem_free_input(dem_input *input) {
    for (size_t i = 0; i < input->stage_count; i++)
        free(input->stages[i].changes);
    free(input->stages);
}
