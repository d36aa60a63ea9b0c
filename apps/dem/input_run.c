/* SPDX-License-Identifier: MIT
 *
 * input_run.c - the JSON file's stages, and what it wants to be written.
 */
#define _XOPEN_SOURCE 700 /* stat */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "input.h"

/* ------------------------------------------------------------------------------------------------ stages */

static void *allocate(size_t count, size_t size) {
    void *memory = calloc(count + 1, size);
    if (!memory)
        fail("not enough memory for the input");
    return memory;
}

/* {"floor": {"velocity": [0, 1]}, ...} has_servo: of each wall, kept up to date. */
static void read_changes(const json_value *walls, const dem *d, bool *has_servo, dem_stage *stage) {
    const cJSON *item;
    if (!cJSON_IsObject(walls->item))
        json_fail(walls, "is not an object");
    stage->changes = allocate((size_t)cJSON_GetArraySize(walls->item), sizeof *stage->changes);
    cJSON_ArrayForEach(item, walls->item) {
        const json_value change = json_member(walls, item->string);
        size_t w = 0;
        while (w < d->wall_count && strcmp(d->walls[w].name, item->string) != 0)
            w++;
        if (w == d->wall_count)
            json_fail(&change, "is of no wall of that name");
        for (size_t i = 0; i < stage->change_count; i++)
            if (stage->changes[i].wall == w)
                json_fail(&change, "is there twice, the first time as");
        json_check_object(&change, "velocity spin servo");
        dem_wall_change *added = &stage->changes[stage->change_count++];
        added->wall = w;
        dem_read_motion(&change, d, has_servo[w], added);
        has_servo[w] = added->sets_servo ? added->servo.on : has_servo[w];
    }
}

/* A time as a number of steps, at least one. */
static uint64_t read_steps(const json_value *value, const dem *d) {
    const double steps = json_number(value, 0, 1e300, true) / d->settings.time_step;
    if (steps > 1e15)
        json_fail(value, "is more than 1e15 time steps");
    return steps < 1 ? 1 : (uint64_t)(steps + 0.5);
}

void dem_read_stages(const json_value *root, dem *d, dem_input *input) {
    const json_value list = json_require(root, "stages");
    const size_t count = json_list(&list);
    if (count == 0)
        json_fail(&list, "is empty");
    input->stages = allocate(count, sizeof *input->stages);
    bool *has_servo = allocate(d->wall_count, sizeof *has_servo);
    for (size_t w = 0; w < d->wall_count; w++)
        has_servo[w] = d->walls[w].servo.on;
    for (size_t i = 0; i < count; i++) {
        const json_value item = json_at(&list, i);
        json_check_object(&item, "name duration gravity friction shear walls");
        const json_value name = json_member(&item, "name"), duration = json_require(&item, "duration");
        const json_value walls = json_member(&item, "walls"), shear = json_member(&item, "shear");
        dem_stage stage = {.steps = read_steps(&duration, d),
                           .sets_gravity = json_member(&item, "gravity").item != NULL,
                           .gravity = json_vec_or(&item, "gravity", (dem_vec){0, 0}),
                           .sets_friction = json_member(&item, "friction").item != NULL,
                           .friction = json_number_or(&item, "friction", 0, 1e6, 0),
                           .sets_shear = shear.item != NULL,
                           .shear = json_number_or(&item, "shear", -1e300, 1e300, 0)};
        if (shear.item && !d->settings.sheared)
            json_fail(&shear, "is of a cell whose boundary has shear");
        if (stage.sets_gravity && d->settings.sheared)
            json_fail(&item, "has gravity in a sheared cell");
        snprintf(stage.name, sizeof stage.name, "stage %zu", i);
        if (name.item)
            json_name(&name, stage.name, sizeof stage.name);
        if (walls.item)
            read_changes(&walls, d, has_servo, &stage);
        input->stages[input->stage_count++] = stage;
    }
    free(has_servo);
}

/* ------------------------------------------------------------------------------------------------ output */

static bool is_same_file(const char *one, const char *other) {
    struct stat a, b;
    return stat(one, &a) == 0 && stat(other, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/* An output may not take the place of an input. */
static void read_name(const json_value *root, const json_value *object, const char *key, char *out_text) {
    const json_value name = json_member(object, key);
    char shapes[DEM_SHAPES_PATH_SIZE];
    if (!name.item)
        return;
    json_text(&name, out_text, DEM_PATH_SIZE - 32);
    dem_find_shapes_file(root, shapes);
    if (is_same_file(name.file, out_text))
        json_fail(&name, "is the input itself");
    if (is_same_file(shapes, out_text))
        json_fail(&name, "is the file of shapes");
}

/* A table's name. */
static void read_table(const json_value *root, const json_value *object, const char *key, char *out_text) {
    const json_value name = json_member(object, key);
    read_name(root, object, key, out_text);
    const size_t length = strlen(out_text);
    if (name.item && (length < 4 || strcmp(out_text + length - 4, ".csv") != 0))
        json_fail(&name, "does not end in .csv");
}

void dem_read_output(const json_value *root, const dem *d, dem_output *out_output) {
    const json_value output = json_member(root, "output");
    *out_output = (dem_output){.every = UINT64_MAX, .restart_every = UINT64_MAX};
    if (!output.item)
        return;
    json_check_object(&output, "every csv grains vtk restart restart_every region");
    const json_value every = json_require(&output, "every"), restart_every = json_member(&output, "restart_every");
    const json_value region = json_member(&output, "region"), vtk = json_member(&output, "vtk");
    out_output->every = read_steps(&every, d);
    if (restart_every.item)
        out_output->restart_every = read_steps(&restart_every, d);
    if (region.item)
        out_output->region = dem_read_region(&region);
    read_table(root, &output, "csv", out_output->csv);
    read_table(root, &output, "grains", out_output->grains);
    read_name(root, &output, "vtk", out_output->vtk);
    read_name(root, &output, "restart", out_output->restart);
    if (out_output->restart[0] && strcmp(out_output->restart, out_output->csv) == 0)
        json_fail(&output, "names one file twice");
    if (restart_every.item && !out_output->restart[0])
        json_fail(&restart_every, "is there without restart");
    if (vtk.item && strstr(out_output->vtk, ".vtk"))
        json_fail(&vtk, "has a suffix: numbers of frames and .vtk are added");
}
