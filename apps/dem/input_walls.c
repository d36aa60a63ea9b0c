/* SPDX-License-Identifier: MIT
 *
 * input_walls.c - the JSON file's walls, and how they move: at the start, and in stages.
 */
#include <math.h>
#include <string.h>

#include "input.h"

/* A plate moves across itself. A servo's direction has at least this share across it. */
static const double LEAST_ACROSS = 1e-6;

/* ------------------------------------------------------------------------------------------------ motion */

/* The two walls that a stress acts between. */
static void read_between(const json_value *between, const dem *d, size_t wall, int out_walls[2]) {
    if (json_list(between) != 2)
        json_fail(between, "is not a list of two walls");
    for (size_t i = 0; i < 2; i++) {
        const json_value name = json_at(between, i);
        out_walls[i] = (int)json_find(&name, d->walls, d->wall_count, sizeof *d->walls,
                                      "is not the name of a wall that stands before");
        if (out_walls[i] == (int)wall)
            json_fail(&name, "is the wall that moves: a stress acts on the distance of two others");
    }
    if (out_walls[0] == out_walls[1])
        json_fail(between, "names one wall twice");
}

static dem_servo read_servo(const json_value *value, const dem *d, size_t wall) {
    dem_servo servo = {.on = true, .between = {-1, -1}};
    if (cJSON_IsNull(value->item))
        return (dem_servo){.between = {-1, -1}};
    json_check_object(value, "direction force stress between gain max_speed travel");
    const json_value direction = json_require(value, "direction");
    const json_value force = json_member(value, "force"), stress = json_member(value, "stress");
    const dem_vec along = json_vec(&direction);
    const double length = hypot(along.x, along.y);
    if (!(length > 0))
        json_fail(&direction, "has no length");
    servo.direction = (dem_vec){along.x / length, along.y / length};
    const dem_vec normal = d->walls[wall].normal;
    if (d->walls[wall].kind == DEM_PLATE &&
        fabs(servo.direction.x * normal.x + servo.direction.y * normal.y) < LEAST_ACROSS)
        json_fail(&direction, "runs along the plate, which has no ends");
    servo.gain = json_positive(value, "gain");
    servo.max_speed = json_positive(value, "max_speed");
    servo.travel = json_member(value, "travel").item ? json_positive(value, "travel") : 0;
    if ((force.item != NULL) == (stress.item != NULL))
        json_fail(value, "has not either force or stress");
    const json_value between = json_member(value, "between");
    if (force.item) {
        if (between.item)
            json_fail(&between, "is for stress, not for force");
        servo.force = json_number(&force, -1e300, 1e300, false);
        return servo;
    }
    json_require(value, "between");
    servo.stress = json_number(&stress, -1e300, 1e300, false);
    read_between(&between, d, wall, servo.between);
    return servo;
}

void dem_read_motion(const json_value *object, const dem *d, bool has_servo, dem_wall_change *out_change) {
    const json_value velocity = json_member(object, "velocity"), spin = json_member(object, "spin");
    const json_value servo = json_member(object, "servo");
    dem_wall_change change = {.wall = out_change->wall,
                              .sets_velocity = velocity.item != NULL,
                              .velocity = json_vec_or(object, "velocity", (dem_vec){0, 0}),
                              .sets_spin = spin.item != NULL,
                              .spin = json_number_or(object, "spin", -1e300, 1e300, 0),
                              .sets_servo = servo.item != NULL};
    if (change.sets_servo)
        change.servo = read_servo(&servo, d, change.wall);
    if (velocity.item && (change.sets_servo ? change.servo.on : has_servo))
        json_fail(&velocity, "is of a wall that its servo moves");
    if (change.sets_spin && d->walls[change.wall].kind == DEM_PLATE && change.spin != 0)
        json_fail(&spin, "turns a plate, which has no ends");
    *out_change = change;
}

void dem_apply_change(dem *d, const dem_wall_change *change) {
    dem_wall *wall = &d->walls[change->wall];
    if (change->sets_velocity || (change->sets_servo && wall->servo.on))
        wall->velocity = change->velocity; /* without servo control it stays where it is */
    if (change->sets_spin)
        wall->spin = change->spin;
    if (change->sets_servo) {
        wall->servo = change->servo;
        wall->idle_way = 0;
    }
}

/* ------------------------------------------------------------------------------------------------ walls */

static void read_plate(const json_value *value, dem_wall *wall) {
    json_check_object(value, "point normal");
    const json_value at = json_require(value, "point"), direction = json_require(value, "normal");
    wall->kind = DEM_PLATE;
    wall->place = json_vec(&at);
    wall->normal = json_vec(&direction);
    if (!(hypot(wall->normal.x, wall->normal.y) > 0))
        json_fail(&direction, "has no length");
}

static uint32_t add_box_shape(const json_value *value, dem *d, const char *name) {
    narc_arc arcs[NARC_MAX_ARCS];
    narc_error error;
    size_t count;
    uint32_t index;
    json_check_object(value, "width height radius");
    if (narc_build_box(json_positive(value, "width"), json_positive(value, "height"),
                       json_number_or(value, "radius", 0, 1e300, 0), arcs, &count, &error) != NARC_OK) {
        dem_fail(d, "%s", error.message);
        dem_fail_at(value, d);
    }
    if (!dem_add_shape(d, name, arcs, count, &index))
        dem_fail_at(value, d);
    return index;
}

/* A box, or any shape of the shapes file. */
static void read_block(const json_value *item, dem *d, dem_wall *wall) {
    const json_value box = json_member(item, "box"), form = json_member(item, "shape"), at = json_require(item, "at");
    wall->kind = DEM_BOX;
    wall->place = wall->pivot = json_vec(&at);
    wall->angle = json_number_or(item, "angle", -1e6, 1e6, 0);
    wall->scale = 1;
    if (box.item) {
        wall->shape = add_box_shape(&box, d, wall->name);
        return;
    }
    wall->shape = dem_find_shape(&form, d);
    wall->scale = json_positive(item, "size") / d->shapes[wall->shape].extent;
}

static void read_wall(const json_value *item, dem *d) {
    const json_value name = json_require(item, "name"), material = json_require(item, "material");
    const json_value plate = json_member(item, "plate");
    dem_wall wall = {.servo = {.between = {-1, -1}}};
    json_name(&name, wall.name, sizeof wall.name);
    for (size_t w = 0; w < d->wall_count; w++)
        if (strcmp(d->walls[w].name, wall.name) == 0)
            json_fail(&name, "is the name of another wall");
    wall.material = dem_find_material(&material, d);
    if ((plate.item != NULL) + (json_member(item, "box").item != NULL) + (json_member(item, "shape").item != NULL) != 1)
        json_fail(item, "is not one of plate, box and shape");
    if (plate.item)
        json_refuse(item, "at angle size pivot", "is not for a plate");
    if (json_member(item, "box").item)
        json_refuse(item, "size", "is not for a box, which has width and height");
    if (plate.item)
        read_plate(&plate, &wall);
    else
        read_block(item, d, &wall);
    wall.pivot = json_vec_or(item, "pivot", wall.pivot);
    if (!dem_add_wall(d, wall))
        dem_fail_at(item, d);
}

void dem_read_walls(const json_value *root, dem *d) {
    const json_value list = json_member(root, "walls");
    const size_t count = list.item ? json_list(&list) : 0;
    for (size_t i = 0; i < count; i++) {
        const json_value item = json_at(&list, i);
        json_check_object(&item, "name material plate box shape size at angle velocity spin pivot servo");
        read_wall(&item, d);
    }
    for (size_t i = 0; i < count; i++) { /* when all names are known */
        const json_value item = json_at(&list, i);
        dem_wall_change change = {.wall = i};
        dem_read_motion(&item, d, false, &change);
        dem_apply_change(d, &change);
    }
}
