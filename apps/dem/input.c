/* SPDX-License-Identifier: MIT
 *
 * input.c - the JSON file: its head, materials, contact laws.
 */
#include "input.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

void dem_fail_at(const json_value *value, const dem *d) {
    fail("%s: %s%s%s", value->file, value->place, value->place[0] ? ": " : "", d->error);
}

dem_region dem_read_region(const json_value *list) {
    double n[4];
    json_numbers(list, 4, n);
    if (!(n[2] > n[0] && n[3] > n[1]))
        json_fail(list, "is not a region [low x, low y, high x, high y]");
    return (dem_region){true, n[0], n[2], n[1], n[3]};
}

/* ------------------------------------------------------------------------------------------------ materials */

uint8_t dem_find_material(const json_value *name, const dem *d) {
    return (uint8_t)json_find(name, d->materials, d->material_count, sizeof *d->materials, "is not a material");
}

static void read_materials(const json_value *root, dem *d) {
    const json_value list = json_require(root, "materials");
    const size_t count = json_list(&list);
    if (count == 0)
        json_fail(&list, "is empty");
    for (size_t i = 0; i < count; i++) {
        const json_value item = json_at(&list, i);
        json_check_object(&item, "name density young poisson");
        dem_material material = {.density = json_positive(&item, "density")};
        const json_value name = json_require(&item, "name");
        uint8_t index;
        json_text(&name, material.name, sizeof material.name);
        for (size_t m = 0; m < d->material_count; m++)
            if (strcmp(d->materials[m].name, material.name) == 0)
                json_fail(&name, "is the name of another material");
        if (d->settings.law == DEM_LINEAR)
            json_refuse(&item, "young poisson", "is of the Hertz law: the linear law's stiffness is kn");
        else {
            material.young = json_positive(&item, "young");
            const json_value poisson = json_require(&item, "poisson");
            material.poisson = json_number(&poisson, 0, 0.5, false);
        }
        if (!dem_add_material(d, material, &index))
            dem_fail_at(&item, d);
    }
}

/* ------------------------------------------------------------------------------------------------ laws */

static void read_damping(const json_value *object, const dem *d, dem_contact_law *law) {
    const json_value restitution = json_member(object, "restitution"), gamma = json_member(object, "gamma_n");
    const json_value gamma_t = json_member(object, "gamma_t"), share = json_member(object, "tangential_damping");
    if (restitution.item && gamma.item)
        json_fail(&gamma, "excludes restitution");
    if (restitution.item)
        law->damping_ratio = dem_damping_ratio(d->settings.law, json_number(&restitution, 1e-6, 1, false));
    if (gamma.item) {
        law->gamma_n = json_number(&gamma, 0, 1e300, false);
        law->gamma_t = 0.5 * law->gamma_n;
        law->damping_ratio = -1;
    }
    if (law->damping_ratio < 0 && law->gamma_n < 0)
        json_fail(object, "has neither restitution nor gamma_n");
    if (gamma_t.item && law->damping_ratio >= 0)
        json_fail(&gamma_t, "is for gamma_n; with restitution it is tangential_damping");
    if (share.item && law->damping_ratio < 0)
        json_fail(&share, "is for restitution; with gamma_n it is gamma_t");
    law->gamma_t = json_number_or(object, "gamma_t", 0, 1e300, law->gamma_t);
    law->tangential_share = json_number_or(object, "tangential_damping", 0, 100, law->tangential_share);
}

/* What is there replaces what `law` has. */
static void read_law(const json_value *object, const dem *d, dem_contact_law *law) {
    const json_value kn = json_member(object, "kn");
    if (d->settings.law == DEM_HERTZ)
        json_refuse(object, "kn kt", "is not of the Hertz law: stiffness comes from the materials");
    if (kn.item) {
        law->kn = json_number(&kn, 0, 1e300, true);
        law->kt = 2.0 / 7 * law->kn; /* as LAMMPS has it */
    }
    law->kt = json_number_or(object, "kt", 0, 1e300, law->kt);
    read_damping(object, d, law);
    law->friction = json_number_or(object, "friction", 0, 1e6, law->friction);
    law->rolling_friction = json_number_or(object, "rolling_friction", 0, 1e6, law->rolling_friction);
}

static void read_pair_laws(const json_value *contact, dem *d, dem_contact_law common) {
    const json_value list = json_member(contact, "pairs");
    const size_t count = list.item ? json_list(&list) : 0;
    bool seen[DEM_MAX_MATERIALS][DEM_MAX_MATERIALS] = {{false}};
    for (size_t i = 0; i < count; i++) {
        const json_value item = json_at(&list, i);
        json_check_object(&item,
                          "materials kn kt gamma_n gamma_t restitution friction rolling_friction tangential_damping");
        const json_value names = json_require(&item, "materials");
        if (json_list(&names) != 2)
            json_fail(&names, "is not a list of two materials");
        const json_value first = json_at(&names, 0), second = json_at(&names, 1);
        const uint8_t a = dem_find_material(&first, d), b = dem_find_material(&second, d);
        if (seen[a][b])
            json_fail(&names, "is a pair that stands before");
        seen[a][b] = seen[b][a] = true;
        dem_contact_law law = common;
        read_law(&item, d, &law);
        dem_set_law(d, a, b, law);
    }
}

static void read_contact(const json_value *root, dem *d) {
    const json_value contact = json_require(root, "contact");
    dem_contact_law law = {.damping_ratio = -1, .gamma_n = -1, .tangential_share = 0.5};
    if (d->settings.law == DEM_LINEAR)
        json_require(&contact, "kn");
    json_require(&contact, "friction");
    read_law(&contact, d, &law);
    for (size_t a = 0; a < d->material_count; a++)
        for (size_t b = a; b < d->material_count; b++)
            dem_set_law(d, (uint8_t)a, (uint8_t)b, law);
    read_pair_laws(&contact, d, law);
    d->settings.max_overlap = json_number_or(root, "max_overlap", 1e-6, 1, d->settings.max_overlap);
}

/* The law is asked before the materials, which depend on it. */
static dem_law read_law_name(const json_value *root) {
    const json_value contact = json_require(root, "contact");
    json_check_object(&contact, "law kn kt gamma_n gamma_t pairs friction restitution rolling_friction "
                                "tangential_damping");
    const json_value law = json_require(&contact, "law");
    char name[DEM_NAME_SIZE];
    json_text(&law, name, sizeof name);
    if (strcmp(name, "linear") != 0 && strcmp(name, "hertz") != 0)
        json_fail(&law, "is neither linear nor hertz");
    return name[0] == 'h' ? DEM_HERTZ : DEM_LINEAR;
}

/* ------------------------------------------------------------------------------------------------ the head */

static void read_cell(const json_value *boundary, const char *axis, bool *out_on, double *out_low, double *out_high) {
    const json_value cell = json_member(boundary, axis);
    if (!cell.item)
        return;
    const dem_vec ends = json_vec(&cell);
    if (!(ends.y > ends.x))
        json_fail(&cell, "is not a range [low, high]");
    *out_on = true;
    *out_low = ends.x;
    *out_high = ends.y;
}

static dem_settings read_settings(const json_value *root, unsigned threads) {
    dem_settings s = dem_defaults;
    s.threads = threads;
    s.law = read_law_name(root);
    s.time_step = json_positive(root, "time_step");
    s.skin = json_positive(root, "skin");
    s.thickness = json_member(root, "thickness").item ? json_positive(root, "thickness") : 1;
    s.gravity = json_vec_or(root, "gravity", s.gravity);
    const json_value boundary = json_member(root, "boundary");
    if (boundary.item) {
        json_check_object(&boundary, "x y shear");
        s.sheared = json_member(&boundary, "shear").item != NULL;
        s.shear = json_number_or(&boundary, "shear", -1e300, 1e300, 0);
        read_cell(&boundary, "x", &s.periodic_x, &s.low_x, &s.high_x);
        read_cell(&boundary, "y", &s.periodic_y, &s.low_y, &s.high_y);
    }
    return s;
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

void dem_read_input(const char *path, unsigned threads, dem *d, dem_input *out_input) {
    json_value root = json_read(path);
    json_check_object(&root, "materials shapes grains walls boundary gravity contact time_step skin thickness "
                             "max_overlap seed stages output comment");
    if (!dem_create(d, read_settings(&root, threads)))
        dem_fail_at(&root, d);
    *out_input = (dem_input){.stage_count = 0};
    const json_value seed = json_member(&root, "seed");
    out_input->random = seed.item ? json_whole(&seed, 0, (size_t)1 << 53) : 1;
    read_materials(&root, d);
    read_contact(&root, d);
    dem_read_shapes(&root, d);
    dem_read_walls(&root, d);
    dem_read_grains(&root, d, &out_input->random);
    dem_read_stages(&root, d, out_input);
    dem_read_output(&root, d, &out_input->output);
    if (!dem_start(d))
        dem_fail_at(&root, d);
    out_input->hash = hash_input(&root, d);
    cJSON_Delete((cJSON *)root.item);
}

void dem_free_input(dem_input *input) {
    for (size_t i = 0; i < input->stage_count; i++)
        free(input->stages[i].changes);
    free(input->stages);
}
