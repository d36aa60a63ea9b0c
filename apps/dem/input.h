/* SPDX-License-Identifier: MIT
 *
 * input.h - what the JSON file says: the world, the stages of the run, what is written.
 */
#ifndef DEM_INPUT_H
#define DEM_INPUT_H

#include "dem.h"
#include "json_path.h"

/* What a stage does to a wall. */
typedef struct dem_wall_change {
    size_t wall;
    bool sets_velocity, sets_spin, sets_servo;
    dem_vec velocity;
    double spin;
    dem_servo servo;
} dem_wall_change;

typedef struct dem_stage {
    char name[DEM_NAME_SIZE];
    uint64_t steps;
    bool sets_gravity, sets_friction, sets_shear;
    dem_vec gravity;
    double friction; /* of all contacts */
    double shear;
    dem_wall_change *changes;
    size_t change_count;
} dem_stage;

/* File names are empty for what is not wanted. */
typedef struct dem_output {
    uint64_t every, restart_every; /* steps */
    char csv[DEM_PATH_SIZE], grains[DEM_PATH_SIZE], vtk[DEM_PATH_SIZE], restart[DEM_PATH_SIZE];
    dem_region region; /* of stresses */
} dem_output;

typedef struct dem_input {
    dem_stage *stages;
    size_t stage_count;
    dem_output output;
    uint64_t hash;   /* of all but stages and output */
    uint64_t random; /* the generator's state */
} dem_input;

/* Reads the file, makes the world and starts it. Errors end the program: "dem: file: place: problem 'value'". */
void dem_read_input(const char *path, unsigned threads, dem *d, dem_input *out_input);
void dem_free_input(dem_input *input);

/* Its parts: input_grains.c, input_walls.c, input_run.c. */
void dem_read_shapes(const json_value *root, dem *d);
enum { DEM_SHAPES_PATH_SIZE = 2 * DEM_PATH_SIZE };
void dem_find_shapes_file(const json_value *root, char path[DEM_SHAPES_PATH_SIZE]);
void dem_read_grains(const json_value *root, dem *d, uint64_t *random);
void dem_read_walls(const json_value *root, dem *d);
void dem_read_motion(const json_value *object, const dem *d, bool has_servo, dem_wall_change *out_change);
void dem_apply_change(dem *d, const dem_wall_change *change);
void dem_read_stages(const json_value *root, dem *d, dem_input *input);
void dem_read_output(const json_value *root, const dem *d, dem_output *out_output);

/* Names to indices; a name that is not known is an error. */
uint8_t dem_find_material(const json_value *name, const dem *d);
uint32_t dem_find_shape(const json_value *name, const dem *d);
dem_region dem_read_region(const json_value *list);

/* Ends the program with the world's error, which came from this value. */
_Noreturn void dem_fail_at(const json_value *value, const dem *d);

#endif
