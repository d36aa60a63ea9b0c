/* SPDX-License-Identifier: MIT
 *
 * input_bodies.c - the JSON file's shapes, walls and grains; and how walls move: at the start, and in stages.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <narc_files.h>

#include "input.h"

/* ------------------------------------------------------------------------------------------------ shapes */

/* NAME/1, NAME/2 ... are the parts of NAME, where their origins tell, if there is no shape of that name. */
static void read_parts(const json_value *file, const narc_shape_list *shapes, const char *name, int length, dem *d) {
    char base[1024], text[1056];
    narc_arc *arcs = dem_allocate(shapes->count, NARC_MAX_ARCS * sizeof *arcs);
    size_t *counts = dem_allocate(shapes->count, sizeof *counts), count = 0, used = 0;
    uint32_t index;
    snprintf(base, sizeof base, "%.*s", length, name);
    const bool ok = narc_find_named_shape(shapes, base) == shapes->count;
    for (size_t k; ok; used += counts[count++]) {
        snprintf(text, sizeof text, "%s/%zu", base, count + 1);
        if ((k = narc_find_named_shape(shapes, text)) == shapes->count)
            break;
        const narc_named_shape *part = &shapes->items[k];
        narc_error error;
        counts[count] = part->arc_count;
        if (narc_move_arcs(part->arcs, part->arc_count, part->origin.x, part->origin.y, 0, 1, arcs + used, &error) !=
            NARC_OK)
            fail("%s: shape '%s': %s", file->file, text, error.message);
    }
    if (ok && !dem_add_compound(d, base, arcs, counts, count, &index))
        dem_fail_at(file, d);
    free(arcs);
    free(counts);
}

void dem_read_shapes(const json_value *name, const char *path, dem *d) {
    narc_shape_list *shapes;
    narc_error error;
    size_t size;
    char *text = dem_read_file(path, &size, d->error);
    if (!text)
        fail("%s", d->error);
    if (narc_read_shapes(text, size, NULL, NULL, &shapes, &error) != NARC_OK)
        fail("%s: %s", path, error.message);
    free(text);
    for (size_t k = 0; k < shapes->count; k++) {
        const narc_named_shape *shape = &shapes->items[k];
        uint32_t index;
        if (shape->form != NARC_FORM_SHAPE)
            fail("%s: shape '%s' is a chain: grains and walls are shapes, or parts", path, shape->name);
        if (!dem_add_shape(d, shape->name, shape->arcs, shape->arc_count, &index))
            dem_fail_at(name, d);
    }
    for (size_t k = 0; k < shapes->count; k++) {
        const char *slash = strrchr(shapes->items[k].name, '/');
        if (slash && strcmp(slash, "/1") == 0)
            read_parts(name, shapes, shapes->items[k].name, (int)(slash - shapes->items[k].name), d);
    }
    narc_destroy_shape_list(shapes);
}

static uint32_t find_shape(const json_value *name, const dem *d) {
    return (uint32_t)json_find(name, d->shapes, d->shape_count, sizeof *d->shapes, "is not the name of a shape");
}

/* ------------------------------------------------------------------------------------------------ motion of walls */

/* A plate moves across itself. A servo's direction has at least this share across it. */
static const double LEAST_ACROSS = 1e-6;

/* The two walls that a stress acts between. */
static void read_between(const json_value *between, const dem *d, size_t wall, int out_walls[2]) {
    for (json_value name = {0}; json_next(between, &name);) {
        out_walls[name.index] = (int)json_find(&name, d->walls, d->wall_count, sizeof *d->walls,
                                               "is not the name of a wall that stands before");
        if (out_walls[name.index] == (int)wall)
            json_fail(&name, "is the wall that moves: a stress acts on the distance of two others");
    }
    if (out_walls[0] == out_walls[1])
        json_fail(between, "names one wall twice");
}

static dem_servo read_servo(const json_value *value, const dem *d, size_t wall) {
    dem_servo servo = {.between = {-1, -1}};
    json_value between;
    if (cJSON_IsNull(value->item))
        return servo;
    json_read(value, (json_key[]){{"direction", MUST | PAIR, &servo.direction},
                                  {"force", NUMBER, &servo.force},
                                  {"stress", NUMBER, &servo.stress},
                                  {"between", LIST, &between, 2, 2},
                                  {"gain", MUST | POSITIVE, &servo.gain},
                                  {"max_speed", MUST | POSITIVE, &servo.max_speed},
                                  {"travel", POSITIVE, &servo.travel},
                                  {NULL}});
    const vec normal = d->walls[wall].normal;
    const double length = hypot(servo.direction.x, servo.direction.y);
    if (!(length > 0))
        json_refuse(value, "direction", "has no length");
    servo.on = true;
    servo.direction = (vec){servo.direction.x / length, servo.direction.y / length};
    if (d->walls[wall].kind == DEM_PLATE &&
        fabs(servo.direction.x * normal.x + servo.direction.y * normal.y) < LEAST_ACROSS)
        json_refuse(value, "direction", "runs along the plate, which has no ends");
    if (json_has(value, "force") == json_has(value, "stress"))
        json_fail(value, "has not either force or stress");
    if (json_has(value, "force"))
        json_refuse(value, "between", "is for stress, not for force");
    else {
        json_require(value, "between");
        read_between(&between, d, wall, servo.between);
    }
    return servo;
}

/* `change` has what stands there of velocity and spin; has_servo: until now. */
static void finish_change(const json_value *object, const dem *d, bool has_servo, dem_wall_change *change) {
    const json_value servo = json_member(object, "servo");
    change->sets_velocity = json_has(object, "velocity");
    change->sets_spin = json_has(object, "spin");
    change->sets_servo = servo.item != NULL;
    if (change->sets_servo)
        change->servo = read_servo(&servo, d, change->wall);
    if (change->sets_servo ? change->servo.on : has_servo)
        json_refuse(object, "velocity", "is of a wall that its servo moves");
    if (change->spin != 0 && d->walls[change->wall].kind == DEM_PLATE)
        json_refuse(object, "spin", "turns a plate, which has no ends");
}

void dem_read_changes(const json_value *walls, const dem *d, bool *has_servo, dem_stage *stage) {
    if (!cJSON_IsObject(walls->item))
        json_fail(walls, "is not an object");
    stage->changes = dem_allocate((size_t)cJSON_GetArraySize(walls->item), sizeof *stage->changes);
    for (json_value item = {0}; json_next(walls, &item);) {
        dem_wall_change *change = &stage->changes[stage->change_count];
        size_t w = 0;
        while (w < d->wall_count && strcmp(d->walls[w].name, item.item->string) != 0)
            w++;
        if (w == d->wall_count)
            json_fail(&item, "is of no wall of that name");
        for (size_t i = 0; i < stage->change_count; i++)
            if (stage->changes[i].wall == w)
                json_fail(&item, "is there twice, the second time as");
        json_read(&item,
                  (json_key[]){
                      {"velocity", PAIR, &change->velocity}, {"spin", NUMBER, &change->spin}, {"servo", ANY}, {NULL}});
        change->wall = w;
        finish_change(&item, d, has_servo[w], change);
        has_servo[w] = change->sets_servo ? change->servo.on : has_servo[w];
        stage->change_count++;
    }
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

static void read_plate(const json_value *item, const json_value *plate, dem_wall *wall) {
    json_refuse(item, "at angle size pivot", "is not for a plate");
    json_read(plate,
              (json_key[]){{"point", MUST | PAIR, &wall->place}, {"normal", MUST | PAIR, &wall->normal}, {NULL}});
    wall->kind = DEM_PLATE;
    if (!(hypot(wall->normal.x, wall->normal.y) > 0))
        json_refuse(plate, "normal", "has no length");
}

static void read_box(const json_value *item, const json_value *box, dem *d, dem_wall *wall) {
    double width, height, radius = 0;
    narc_arc arcs[NARC_MAX_ARCS];
    narc_error error;
    size_t count;
    json_refuse(item, "size", "is not for a box, which has width and height");
    json_read(box, (json_key[]){{"width", MUST | POSITIVE, &width},
                                {"height", MUST | POSITIVE, &height},
                                {"radius", NUMBER, &radius, 0, 1e300},
                                {NULL}});
    const bool built = narc_build_box(width, height, radius, arcs, &count, &error) == NARC_OK;
    if (!(built ? dem_add_shape(d, wall->name, arcs, count, &wall->shape) : dem_fail(d, "%s", error.message)))
        dem_fail_at(box, d);
}

static void read_wall(const json_value *item, dem *d, dem_wall_change *motion) {
    dem_wall wall = {.scale = 1, .servo = {.between = {-1, -1}}};
    json_value material, none = {.item = NULL}, plate = none, box = none, shape = none;
    double size = 1;
    json_read(item, (json_key[]){{"name", MUST | NAME, wall.name, 0, sizeof wall.name},
                                 {"material", MUST | ANY, &material},
                                 {"plate", ANY, &plate},
                                 {"box", ANY, &box},
                                 {"shape", ANY, &shape},
                                 {"size", POSITIVE, &size},
                                 {"at", PAIR, &wall.place},
                                 {"angle", NUMBER, &wall.angle, -1e6, 1e6},
                                 {"pivot", PAIR, &wall.pivot},
                                 {"velocity", PAIR, &motion->velocity},
                                 {"spin", NUMBER, &motion->spin},
                                 {"servo", ANY},
                                 {NULL}});
    for (size_t w = 0; w < d->wall_count; w++)
        if (strcmp(d->walls[w].name, wall.name) == 0)
            json_refuse(item, "name", "is the name of another wall");
    wall.material = dem_find_material(&material, d);
    if ((plate.item != NULL) + (box.item != NULL) + (shape.item != NULL) != 1)
        json_fail(item, "is not one of plate, box and shape");
    if (plate.item)
        read_plate(item, &plate, &wall);
    else
        json_require(item, "at");
    if (box.item)
        read_box(item, &box, d, &wall);
    if (shape.item) {
        json_require(item, "size");
        wall.shape = find_shape(&shape, d);
        wall.scale = size / d->shapes[wall.shape].extent;
    }
    if (!json_has(item, "pivot") && !plate.item)
        wall.pivot = wall.place;
    if (!dem_add_wall(d, wall))
        dem_fail_at(item, d);
}

void dem_read_walls(const json_value *list, dem *d) {
    dem_wall_change *motions = dem_allocate((size_t)cJSON_GetArraySize(list->item), sizeof *motions);
    for (json_value item = {0}; json_next(list, &item);)
        read_wall(&item, d, &motions[item.index]);
    for (json_value item = {0}; json_next(list, &item);) { /* when all names are known */
        motions[item.index].wall = item.index;
        finish_change(&item, d, false, &motions[item.index]);
        dem_apply_change(d, &motions[item.index]);
    }
    free(motions);
}

/* ------------------------------------------------------------------------------------------------ sizes */

/* Sizes beyond the limits are drawn again: so many must be within. */
static const double LEAST_SHARE = 0.001;

/* How far a size is from the middle, in deviations times sqrt(2). */
static double find_deviations(const dem_sizes *sizes, double size) {
    const double off = sizes->kind == DEM_NORMAL ? size - sizes->mean : log(size / sizes->mean);
    return off / (sizes->deviation * 1.4142135623730951);
}

static dem_sizes read_sizes(const json_value *item) {
    dem_sizes sizes = {.kind = DEM_FIXED};
    const json_value given = json_member(item, "size"), *value = &given;
    vec n;
    if (!cJSON_IsObject(value->item)) {
        json_take(value, (json_key){"size", POSITIVE, &sizes.mean});
        return sizes;
    }
    json_read(value, (json_key[]){{"uniform", PAIR, &n},
                                  {"normal", PAIR, &n},
                                  {"lognormal", PAIR, &n},
                                  {"low", POSITIVE, &sizes.low},
                                  {"high", POSITIVE, &sizes.high},
                                  {NULL}});
    const bool uniform = json_has(value, "uniform"), normal = json_has(value, "normal");
    if (uniform + normal + json_has(value, "lognormal") != 1)
        json_fail(value, "is not one of uniform, normal and lognormal");
    if (uniform) {
        json_refuse(value, "low high", "is not for uniform, which has limits");
        if (!(n.x > 0 && n.y >= n.x))
            json_refuse(value, "uniform", "is not a range of sizes [low, high]");
        return (dem_sizes){.kind = DEM_UNIFORM, .low = n.x, .high = n.y};
    }
    if (!(n.x > 0 && n.y > 0))
        json_refuse(value, "normal lognormal", "is not a size and a deviation above 0");
    json_require(value, "low");
    json_require(value, "high");
    sizes = (dem_sizes){normal ? DEM_NORMAL : DEM_LOGNORMAL, n.x, n.y, sizes.low, sizes.high};
    if (!(sizes.low < sizes.mean && sizes.mean < sizes.high))
        json_fail(value, "does not have its middle between low and high");
    if (0.5 * (erf(find_deviations(&sizes, sizes.high)) - erf(find_deviations(&sizes, sizes.low))) < LEAST_SHARE)
        json_fail(value, "leaves fewer than one in 1000 sizes between low and high");
    return sizes;
}

/* ------------------------------------------------------------------------------------------------ grains */

static void fill(const json_value *item, bool lattice, dem *d, uint64_t *random) {
    dem_filling f = {.tries = 20000};
    json_value shapes, material;
    json_read(item, (json_key[]){{"place", ANY},
                                 {"region", MUST | REGION, &f.region},
                                 {"shapes", MUST | LIST, &shapes, 1, DEM_MAX_CHOICES},
                                 {"size", MUST | ANY},
                                 {"material", MUST | ANY, &material},
                                 {"count", WHOLE, &f.count, 1, 1e8},
                                 {"speed", NUMBER, &f.speed, 0, 1e300},
                                 {"spin", NUMBER, &f.spin, 0, 1e300},
                                 {"upright", BOOL, &f.upright},
                                 {"gap", NUMBER, &f.gap, 0, 1e300},
                                 {"tries", WHOLE, &f.tries, 1, 1e9},
                                 {"spacing", PAIR, &f.spacing},
                                 {"jitter", NUMBER, &f.jitter, 0, 1},
                                 {NULL}});
    json_require(item, lattice ? "spacing" : "count");
    json_refuse(item, lattice ? "gap tries" : "spacing jitter", lattice ? "is for random" : "is for lattice");
    f.material = dem_find_material(&material, d);
    f.sizes = read_sizes(item);
    for (json_value name = {0}; json_next(&shapes, &name);)
        f.shapes[f.shape_count++] = find_shape(&name, d);
    if (lattice && !(f.spacing.x > 0 && f.spacing.y > 0))
        json_refuse(item, "spacing", "is not two lengths above 0");
    if (!(lattice ? dem_fill_lattice : dem_fill_randomly)(d, &f, random))
        dem_fail_at(item, d);
}

static void read_grain(const json_value *item, dem *d) {
    dem_grain grain = {.angle = 0};
    double size;
    json_value shape, material;
    json_read(item, (json_key[]){{"shape", MUST | ANY, &shape},
                                 {"material", MUST | ANY, &material},
                                 {"at", MUST | PAIR, &grain.place},
                                 {"size", MUST | POSITIVE, &size},
                                 {"angle", NUMBER, &grain.angle, -1e6, 1e6},
                                 {"velocity", PAIR, &grain.velocity},
                                 {"spin", NUMBER, &grain.spin},
                                 {NULL}});
    grain.shape = find_shape(&shape, d);
    grain.material = dem_find_material(&material, d);
    grain.scale = size / d->shapes[grain.shape].extent;
    if (!dem_add_grain(d, grain))
        dem_fail_at(item, d);
}

void dem_read_grains(const json_value *list, dem *d, uint64_t *random) {
    static const char places[][8] = {"list", "random", "lattice"};
    for (json_value item = {0}; json_next(list, &item);) {
        json_require(&item, "place");
        const json_value name = json_member(&item, "place");
        const size_t place = json_find(&name, places, 3, sizeof places[0], "is not one of list, random and lattice");
        json_value grains = {.item = NULL};
        if (place > 0)
            fill(&item, place == 2, d, random);
        else
            json_read(&item, (json_key[]){{"place", ANY}, {"grains", MUST | LIST, &grains}, {NULL}});
        for (json_value grain = {0}; json_next(&grains, &grain);)
            read_grain(&grain, d);
    }
    if (d->grain_count == 0)
        json_fail(list, "has no grains");
}
