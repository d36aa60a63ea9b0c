/* SPDX-License-Identifier: MIT
 *
 * input.h - what the JSON file says: the world, the stages of the run, what is written.
 */
#ifndef DEM_INPUT_H
#define DEM_INPUT_H

#include "schema.h"

/* What a stage does to a wall. NaN: nothing. */
typedef struct dem_wall_change {
    size_t wall; /* or the number of walls + a group */
    vec velocity;
    double spin;
    bool sets_servo, steers;
    dem_servo servo;
    json_value checks; /* the velocity, if there is a servo */
} dem_wall_change;

/* What a stage changes at its beginning. NaN: nothing. */
typedef struct dem_stage {
    char name[DEM_NAME_SIZE];
    uint64_t steps;
    vec gravity;
    double friction; /* of all contacts */
    double shear;
    dem_side sides[2]; /* of a cell; `on` 0: nothing, 1: a stress, -1: a rate */
    dem_wall_change *changes;
    size_t change_count;
} dem_stage;

enum { DEM_STEM_SIZE = DEM_PATH_SIZE - 32 }; /* frames have numbers and suffixes behind it */

/* File names are empty for what is not wanted. */
typedef struct dem_output {
    uint64_t every, restart_every; /* steps */
    char csv[DEM_STEM_SIZE], grains[DEM_STEM_SIZE], vtk[DEM_STEM_SIZE], restart[DEM_STEM_SIZE];
    dem_region region; /* of stresses */
} dem_output;

typedef struct dem_input {
    char shapes[2 * DEM_PATH_SIZE]; /* the file */
    dem_stage *stages;
    size_t stage_count;
    dem_output output;
    uint64_t hash; /* of all but stages and output */
} dem_input;

/* Reads the file, makes the world and starts it. Errors end the program: "dem: file: path: problem 'value'". */
void dem_read_input(const char *path, unsigned threads, dem *d, dem_input *out_input);
void dem_free_input(dem_input *input);

void dem_enter_stage(dem *d, const dem_stage *stage);

/* input_bodies.c: shapes from the file, which `name` names, then walls and grains. */
void dem_read_shapes(const json_value *name, const char *path, dem *d);
void dem_read_walls(const json_value *list, const json_value *groups, dem *d, dem_servo **out_servos);
void dem_read_grains(const json_value *list, dem *d, uint64_t *random);

/* Of a stage, {"floor": {"velocity": [0, 1]}, ...}. servos: of each wall, and each group, kept up to date. */
void dem_read_changes(const json_value *walls, const dem *d, dem_servo *servos, dem_stage *stage);
void dem_apply_change(dem *d, const dem_wall_change *change);

json_names dem_materials(const dem *d);
void *dem_allocate(size_t count, size_t size); /* zeros, to be released */
void dem_go_to(dem *d, const json_value *at);  /* errors of the world come from this value */

#endif
