/* SPDX-License-Identifier: MIT
 *
 * input.c - the JSON file: its head, materials, contact laws, stages, outputs.
 */
#define _XOPEN_SOURCE 700 /* stat */
#include "input.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>

/* ------------------------------------------------------------------------------------------------ materials, laws */

static void read_materials(const json_value *list, dem *d) {
    const char *no = d->settings.law == DEM_HERTZ ? NULL : "is of the Hertz law: the linear law's stiffness is kn";
    for (json_value item = {0}; json_next(list, &item);) {
        dem_material *m = &d->materials[d->material_count];
        json_names before = dem_materials(d);
        before.problem = "is the name of another material";
        json_read(&item, (json_key[]){{"name", MUST | TEXT, m->name, 0, sizeof m->name},
                                      {"density", MUST | POSITIVE, &m->density},
                                      {"young", MUST | POSITIVE, &m->young, .no = no},
                                      {"poisson", MUST | NUMBER, &m->poisson, 0, 0.5, .no = no},
                                      {NULL}});
        json_check_new(&item, m->name, before);
        d->material_count++;
    }
}

/* Of all materials, with a list of pairs; or of a pair. What is there replaces what `law` has. */
static void read_law(const json_value *object, const dem *d, json_value *pairs, uint32_t *pair, dem_contact_law *law) {
    const bool hertz = d->settings.law == DEM_HERTZ;
    const bool gamma = json_has(object, "gamma_n"), ratio = json_has(object, "restitution");
    const bool by_ratio = ratio || (law->damping_ratio >= 0 && !gamma);
    const char *no_pair = pair ? "is not for a pair" : NULL;
    const char *no_stiffness = hertz ? "is not of the Hertz law: stiffness comes from the materials" : NULL;
    const char *no_gamma_t = by_ratio ? "is for gamma_n; with restitution it is tangential_damping" : NULL;
    const char *no_share = by_ratio ? NULL : "is for restitution; with gamma_n it is gamma_t";
    const json_names materials = dem_materials(d);
    const int must = pair ? 0 : MUST;
    double restitution = 1;
    json_read(object,
              (json_key[]){{"law", ANY, .no = no_pair},
                           {"pairs", LIST, pairs, .no = no_pair},
                           {"materials", MUST | SOME_OF, pair, 2, 2, &materials, pair ? NULL : "is for pairs"},
                           {"kn", must | POSITIVE, &law->kn, .no = no_stiffness},
                           {"kt", NUMBER, &law->kt, 0, 1e300, .no = no_stiffness},
                           {"restitution", NUMBER, &restitution, 1e-6, 1},
                           {"gamma_n", NUMBER, &law->gamma_n, 0, 1e300, .no = ratio ? "excludes restitution" : NULL},
                           {"gamma_t", NUMBER, &law->gamma_t, 0, 1e300, .no = no_gamma_t},
                           {"tangential_damping", NUMBER, &law->tangential_share, 0, 100, .no = no_share},
                           {"friction", must | NUMBER, &law->friction, 0, 1e6},
                           {"rolling_friction", NUMBER, &law->rolling_friction, 0, 1e6},
                           {"cohesion", NUMBER, &law->cohesion, 0, 1e300},
                           {"range", POSITIVE, &law->range},
                           {NULL}});
    if (law->cohesion > 0 && !(law->range > 0))
        json_fail(object, "has cohesion and no range");
    law->range = law->cohesion > 0 ? law->range : 0;
    if (json_has(object, "kn") && !json_has(object, "kt"))
        law->kt = 2.0 / 7 * law->kn; /* as LAMMPS has it */
    if (gamma && !json_has(object, "gamma_t"))
        law->gamma_t = 0.5 * law->gamma_n;
    law->damping_ratio = ratio ? dem_damping_ratio(d->settings.law, restitution) : gamma ? -1 : law->damping_ratio;
    if (law->damping_ratio < 0 && law->gamma_n < 0)
        json_fail(object, "has neither restitution nor gamma_n");
}

static void read_contact(const json_value *contact, dem *d) {
    dem_contact_law common = {.damping_ratio = -1, .gamma_n = -1, .tangential_share = 0.5};
    json_value pairs = {.item = NULL};
    bool seen[DEM_MAX_MATERIALS][DEM_MAX_MATERIALS] = {{false}};
    read_law(contact, d, &pairs, NULL, &common);
    for (uint32_t a = 0; a < d->material_count; a++)
        for (uint32_t b = a; b < d->material_count; b++)
            dem_set_law(d, a, b, common);
    for (json_value item = {0}; json_next(&pairs, &item);) {
        dem_contact_law law = common;
        uint32_t of[2];
        read_law(&item, d, NULL, of, &law);
        if (seen[of[0]][of[1]])
            json_refuse(&item, "materials", "is a pair that stands before");
        seen[of[0]][of[1]] = seen[of[1]][of[0]] = true;
        dem_set_law(d, of[0], of[1], law);
    }
}

/* The law is asked before the materials, which depend on it. */
static dem_law find_law(const json_value *contact) {
    static const char laws[][8] = {[DEM_LINEAR] = "linear", [DEM_HERTZ] = "hertz"};
    const json_names names = {laws, 2, sizeof laws[0], "is neither linear nor hertz"};
    uint32_t index;
    json_read_some(contact, (json_key[]){{"law", MUST | ONE_OF, &index, .names = &names}, {NULL}});
    return (dem_law)index;
}

/* ------------------------------------------------------------------------------------------------ stages */

/* At least one. */
static uint64_t count_steps(const json_value *object, const char *key, double time, const dem *d) {
    const double steps = time / d->settings.time_step;
    if (steps > 1e15)
        json_refuse(object, key, "is more than 1e15 time steps");
    return steps < 1 ? 1 : (uint64_t)(steps + 0.5);
}

/* {"x": {"rate"} or {"stress", "gain", "max_rate"}, "y": ...} */
static void read_strain(const json_value *strain, dem_side sides[2]) {
    json_key keys[] = {{"x", ANY}, {"y", ANY}, {NULL}};
    json_read(strain, keys);
    for (int axis = 0; axis < 2; axis++) {
        const json_value side = json_member(strain, axis ? "y" : "x");
        dem_side *s = &sides[axis];
        const bool rate = json_has(&side, "rate");
        if (!side.item)
            continue;
        *s = (dem_side){.on = rate ? -1 : 1};
        json_read(&side, rate ? (json_key[]){{"rate", NUMBER, &s->max_rate}, {NULL}}
                              : (json_key[]){{"stress", MUST | NUMBER, &s->stress},
                                             {"gain", MUST | POSITIVE, &s->gain},
                                             {"max_rate", MUST | POSITIVE, &s->max_rate},
                                             {NULL}});
    }
}

static void set_sides(dem *d, const dem_side sides[2]) {
    dem_rates rates = d->settings.rates;
    for (int axis = 0; axis < 2; axis++) {
        if (sides[axis].on == 0)
            continue;
        *(axis ? &rates.y : &rates.x) = sides[axis].on < 0 ? sides[axis].max_rate : 0;
        d->sides[axis] = sides[axis];
        d->sides[axis].on = sides[axis].on > 0;
    }
    dem_set_rates(d, rates);
}

static void read_stages(const json_value *list, const dem *d, dem_servo *servos, dem_input *input) {
    const char *no_shear = d->settings.sheared ? NULL : "is of a cell whose boundary has shear";
    const char *no_strain = d->settings.strained ? NULL : "is of a cell whose boundary has strain";
    const char *no_gravity =
        d->settings.sheared || d->settings.strained ? "is not for a sheared or strained cell" : NULL;
    input->stages = dem_allocate((size_t)cJSON_GetArraySize(list->item), sizeof *input->stages);
    for (json_value item = {0}; json_next(list, &item);) {
        dem_stage *stage = &input->stages[input->stage_count++];
        double duration;
        json_value walls = {.item = NULL}, strain = {.item = NULL};
        *stage = (dem_stage){.gravity = {NAN, NAN}, .friction = NAN, .shear = NAN};
        snprintf(stage->name, sizeof stage->name, "stage %zu", item.index);
        json_read(&item, (json_key[]){{"name", NAME, stage->name, 0, sizeof stage->name},
                                      {"duration", MUST | POSITIVE, &duration},
                                      {"gravity", PAIR, &stage->gravity, .no = no_gravity},
                                      {"friction", NUMBER, &stage->friction, 0, 1e6},
                                      {"shear", NUMBER, &stage->shear, .no = no_shear},
                                      {"strain", ANY, &strain, .no = no_strain},
                                      {"walls", ANY, &walls},
                                      {NULL}});
        stage->steps = count_steps(&item, "duration", duration, d);
        if (walls.item)
            dem_read_changes(&walls, d, servos, stage);
        if (strain.item)
            read_strain(&strain, stage->sides);
    }
}

/* Other gravity gives grains another potential energy at once. */
void dem_enter_stage(dem *d, const dem_stage *stage) {
    if (!isnan(stage->gravity.x))
        d->settings.gravity = stage->gravity;
    if (!isnan(stage->shear))
        dem_set_rates(d, (dem_rates){stage->shear, d->settings.rates.x, d->settings.rates.y});
    set_sides(d, stage->sides);
    for (size_t i = 0; i < d->material_count * d->material_count && !isnan(stage->friction); i++)
        d->laws[i / d->material_count][i % d->material_count].friction = stage->friction;
    for (size_t i = 0; i < stage->change_count; i++)
        dem_apply_change(d, &stage->changes[i]);
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
        if (i < 2 && !is_table(names[i]))
            json_refuse(object, keys[i], "does not end in .csv");
    }
    if (o->restart[0] && strcmp(o->restart, o->csv) == 0)
        json_fail(object, "names one file twice");
    if (strstr(o->vtk, ".vtk"))
        json_refuse(object, "vtk", "has a suffix: numbers of frames and .vtk are added");
}

static void read_output(const json_value *object, const dem *d, dem_input *input) {
    dem_output *o = &input->output;
    const char *no = json_has(object, "restart") ? NULL : "is there without restart";
    double every, restart_every = NAN;
    json_read(object, (json_key[]){{"every", MUST | POSITIVE, &every},
                                   {"csv", TEXT, o->csv, 0, sizeof o->csv},
                                   {"grains", TEXT, o->grains, 0, sizeof o->grains},
                                   {"vtk", TEXT, o->vtk, 0, sizeof o->vtk},
                                   {"restart", TEXT, o->restart, 0, sizeof o->restart},
                                   {"restart_every", POSITIVE, &restart_every, .no = no},
                                   {"region", REGION, &o->region},
                                   {NULL}});
    check_names(object, o, input->shapes);
    o->every = count_steps(object, "every", every, d);
    if (!isnan(restart_every))
        o->restart_every = count_steps(object, "restart_every", restart_every, d);
}

/* ------------------------------------------------------------------------------------------------ the whole */

/* The file of shapes is named from the input's folder. */
static void find_shapes_file(const char *input, const char *name, char *out_path, size_t size) {
    const char *slash = strrchr(input, '/');
    const size_t folder = slash && name[0] != '/' && slash - input < DEM_PATH_SIZE ? (size_t)(slash - input) + 1 : 0;
    snprintf(out_path, size, "%.*s%s", (int)folder, input, name);
}

/* Of all that decides what bodies there are and how they push each other. */
static uint64_t hash_input(const json_value *root, const dem *d) {
    uint64_t hash = DEM_HASH_START;
    cJSON *item = (cJSON *)root->item;
    cJSON_DeleteItemFromObjectCaseSensitive(item, "stages");
    cJSON_DeleteItemFromObjectCaseSensitive(item, "output");
    char *text = cJSON_PrintUnformatted(item);
    if (!text)
        dem_quit("not enough memory for the input");
    hash = dem_hash_bytes(hash, text, strlen(text));
    cJSON_free(text);
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
    uint64_t random = 1; /* the generator's state */
    vec x = {0, 1}, y = {0, 1};
    json_value materials, contact, grains, stages, walls = {.item = NULL}, groups = {.item = NULL},
                                                   output = {.item = NULL};
    json_value strain = {.item = NULL};
    dem_side sides[2] = {{0}, {0}};
    dem_servo *servos;
    double shear = NAN;
    *input = (dem_input){.output = {.every = UINT64_MAX, .restart_every = UINT64_MAX}};
    json_key boundary[] = {
        {"x", PAIR, &x}, {"y", PAIR, &y}, {"shear", NUMBER, &shear}, {"strain", ANY, &strain}, {NULL}};
    json_read(&root, (json_key[]){{"comment", ANY},
                                  {"materials", MUST | LIST, &materials, 1, DEM_MAX_MATERIALS},
                                  {"shapes", MUST | TEXT, shapes, 0, sizeof shapes},
                                  {"thickness", POSITIVE, &s.thickness},
                                  {"gravity", PAIR, &s.gravity},
                                  {"boundary", OBJECT, boundary},
                                  {"time_step", MUST | POSITIVE, &s.time_step},
                                  {"skin", MUST | POSITIVE, &s.skin},
                                  {"max_overlap", NUMBER, &s.max_overlap, 1e-6, 1},
                                  {"seed", WHOLE, &random, 0, 0x1p53},
                                  {"contact", MUST | ANY, &contact},
                                  {"drag", NUMBER, &s.drag, 0, 1e300},
                                  {"walls", LIST, &walls},
                                  {"groups", ANY, &groups},
                                  {"grains", MUST | LIST, &grains},
                                  {"stages", MUST | LIST, &stages, 1, 1e9},
                                  {"output", ANY, &output},
                                  {NULL}});
    const json_value cell = json_member(&root, "boundary");
    if (!(x.y > x.x))
        json_refuse(&cell, "x", "is not a range [low, high]");
    if (!(y.y > y.x))
        json_refuse(&cell, "y", "is not a range [low, high]");
    s.periodic_x = json_has(&cell, "x");
    s.periodic_y = json_has(&cell, "y");
    s.low = (vec){x.x, y.x};
    s.high = (vec){x.y, y.y};
    s.sheared = !isnan(shear);
    s.strained = strain.item != NULL;
    s.rates.shear = s.sheared ? shear : 0;
    if (s.strained)
        read_strain(&strain, sides);
    s.threads = threads;
    s.law = find_law(&contact);
    dem_create(d, s);
    find_shapes_file(path, shapes, input->shapes, sizeof input->shapes);
    read_materials(&materials, d);
    read_contact(&contact, d);
    dem_read_shapes(&shapes_file, input->shapes, d);
    dem_read_walls(&walls, &groups, d, &servos);
    dem_read_grains(&grains, d, &random);
    read_stages(&stages, d, servos, input);
    dem_release(servos);
    if (output.item)
        read_output(&output, d, input);
    dem_go_to(d, &root);
    dem_start(d);
    set_sides(d, sides);
    d->shear_work = 0;
    d->input_path[0] = 0;
    input->hash = hash_input(&root, d);
    cJSON_Delete((cJSON *)root.item);
}

void dem_free_input(dem_input *input) {
    for (size_t i = 0; i < input->stage_count; i++)
        dem_release(input->stages[i].changes);
    dem_release(input->stages);
}
