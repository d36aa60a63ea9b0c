/* SPDX-License-Identifier: MIT
 *
 * input_bodies.c - the JSON file's shapes, walls and grains; and how walls move: at the start, and in stages.
 */
#include <math.h>
#include <string.h>

#include <narc_files.h>

#include "input.h"

void dem_go_to(dem *d, const json_value *at) {
    snprintf(d->input_path, sizeof d->input_path, "%.100s: %s%s", at->file, at->path, at->path[0] ? ": " : "");
}

void *dem_allocate(size_t count, size_t size) {
    char *memory = NULL;
    dem_grow(&memory, count, size);
    memset(memory, 0, count * size);
    return memory;
}

json_names dem_materials(const dem *d) {
    return (json_names){d->materials, d->material_count, sizeof *d->materials, "is not a material"};
}

/* ------------------------------------------------------------------------------------------------ shapes */

/* NAME/1, NAME/2 ... are the parts of NAME, where their origins tell, if there is no shape of that name. */
static void read_parts(const narc_shape_list *shapes, const char *name, int length, dem *d) {
    char base[1024], text[1056];
    narc_arc *arcs = dem_allocate(shapes->count, NARC_MAX_ARCS * sizeof *arcs);
    size_t *counts = dem_allocate(shapes->count, sizeof *counts), count = 0, used = 0;
    snprintf(base, sizeof base, "%.*s", length, name);
    for (;; used += counts[count++]) {
        snprintf(text, sizeof text, "%s/%zu", base, count + 1);
        const size_t k = narc_find_named_shape(shapes, text);
        if (k == shapes->count)
            break;
        const narc_named_shape *part = &shapes->items[k];
        narc_error error;
        counts[count] = part->arc_count;
        dem_demand(
            d, narc_move_arcs(part->arcs, part->arc_count, part->origin.x, part->origin.y, 0, 1, arcs + used, &error),
            text, &error);
    }
    if (narc_find_named_shape(shapes, base) == shapes->count)
        dem_add_compound(d, base, arcs, counts, count);
    dem_release(arcs);
    dem_release(counts);
}

void dem_read_shapes(const json_value *name, const char *path, dem *d) {
    narc_shape_list *shapes;
    narc_error error;
    size_t size;
    char *text = dem_read_file(path, &size);
    if (narc_read_shapes(text, size, NULL, NULL, &shapes, &error) != NARC_OK)
        dem_quit("%s: %s", path, error.message);
    dem_release(text);
    dem_go_to(d, name);
    for (const narc_named_shape *s = shapes->items; s < shapes->items + shapes->count; s++)
        if (s->form == NARC_FORM_SHAPE)
            dem_add_shape(d, s->name, s->arcs, s->arc_count);
        else if (s->form == NARC_FORM_HALF_PLANE)
            dem_quit("%s: shape '%s' is a half-plane: a plate is one", path, s->name);
        else
            dem_add_chain(d, s->name, s->arcs, s->arc_count, s->form == NARC_FORM_CLOSED_CHAIN);
    for (size_t k = 0; k < shapes->count; k++) {
        const char *slash = strrchr(shapes->items[k].name, '/');
        if (slash && strcmp(slash, "/1") == 0)
            read_parts(shapes, shapes->items[k].name, (int)(slash - shapes->items[k].name), d);
    }
    narc_destroy_shape_list(shapes);
}

static json_names find_shapes(const dem *d) {
    return (json_names){d->shapes, d->shape_count, sizeof *d->shapes, "is not the name of a shape"};
}

/* No grain is one. */
static void refuse_chain(const json_value *item, const dem *d, uint32_t shape) {
    if (d->shapes[shape].is_chain)
        json_fail(item, "names a chain, which only walls can be");
}

/* ------------------------------------------------------------------------------------------------ motion of walls */

/* A plate moves across itself. A servo's direction has at least this share across it. */
static const double LEAST_ACROSS = 1e-6;

/* `own`: of the wall, or of the group. */
static dem_servo read_servo(const json_value *value, const dem *d, const bool *own) {
    const json_names walls = {d->walls, d->wall_count, sizeof *d->walls, "is not the name of a wall"};
    const bool by_force = json_has(value, "force");
    const json_value between = json_member(value, "between");
    dem_servo servo = {.between = {-1, -1}};
    if (cJSON_IsNull(value->item))
        return servo;
    if (by_force == json_has(value, "stress") && cJSON_IsObject(value->item))
        json_fail(value, "has not either force or stress");
    json_read(value, (json_key[]){{"direction", MUST | PAIR, &servo.direction},
                                  {"force", NUMBER, &servo.force},
                                  {"stress", NUMBER, &servo.stress},
                                  {"between", MUST | SOME_OF, servo.between, 2, 2, &walls,
                                   by_force ? "is for stress, not for force" : NULL},
                                  {"gain", MUST | POSITIVE, &servo.gain},
                                  {"max_speed", MUST | POSITIVE, &servo.max_speed},
                                  {"travel", POSITIVE, &servo.travel},
                                  {NULL}});
    const double length = hypot(servo.direction.x, servo.direction.y);
    if (!(length > 0))
        json_refuse(value, "direction", "has no length");
    servo.on = true;
    servo.direction = (vec){servo.direction.x / length, servo.direction.y / length};
    for (size_t w = 0; w < d->wall_count; w++)
        if (own[w] && d->walls[w].kind == DEM_PLATE && fabs(dot(servo.direction, d->walls[w].normal)) < LEAST_ACROSS)
            json_refuse(value, "direction", "runs along the plate, which has no ends");
    for (json_value name = {0}; json_next(&between, &name);)
        if (own[servo.between[name.index]])
            json_fail(&name, "is the wall that moves: a stress acts on the distance of two others");
    if (!by_force && servo.between[0] == servo.between[1])
        json_fail(&between, "names one wall twice");
    return servo;
}

/* What `object` says of a wall, or of a group, whose index is behind those of the walls; `alone` or among other things. */
static dem_wall_change read_change(const json_value *object, const dem *d, size_t wall, bool has_servo, bool alone) {
    dem_wall_change change = {.wall = wall, .velocity = {NAN, NAN}, .spin = NAN};
    const json_value servo = json_member(object, "servo"), velocity = json_member(object, "velocity");
    bool *own = dem_allocate(d->wall_count, sizeof *own);
    const char *no_spin = wall >= d->wall_count ? "turns a group, whose walls have their own pivots" : NULL;
    const char *no_motion = wall < d->wall_count && d->walls[wall].group > 0 ? "is of the wall's group" : NULL;
    for (size_t w = 0; w < d->wall_count; w++) {
        own[w] = w == wall || (wall >= d->wall_count && d->walls[w].group == wall - d->wall_count + 1);
        if (own[w] && d->walls[w].kind == DEM_PLATE)
            no_spin = "turns a plate, which has no ends";
    }
    const json_key keys[] = {{"velocity", PAIR, &change.velocity, .no = no_motion},
                             {"spin", NUMBER, &change.spin, .no = no_motion ? no_motion : no_spin},
                             {"servo", ANY, .no = no_motion},
                             {NULL}};
    (alone ? json_read : json_read_some)(object, keys);
    change.sets_servo = servo.item != NULL;
    if (change.sets_servo)
        change.servo = read_servo(&servo, d, own);
    change.steers = change.sets_servo ? change.servo.on : has_servo;
    dem_release(own);
    if (change.steers && velocity.item)
        change.checks = velocity;
    return change;
}

/* A servo moves its wall along its direction, a velocity across it. */
static void check_velocity(const dem_wall_change *change, vec direction) {
    const double along = dot(change->velocity, direction), all = hypot(change->velocity.x, change->velocity.y);
    if (change->checks.item && fabs(along) > 1e-9 * all)
        json_fail(&change->checks, "is not across the direction of the wall's servo");
}

void dem_read_changes(const json_value *walls, const dem *d, dem_servo *servos, dem_stage *stage) {
    const json_names names = {d->walls, d->wall_count, sizeof *d->walls, "is of no wall of that name"};
    const json_names groups = {d->groups, d->group_count, sizeof d->groups[0], ""};
    const size_t count = d->wall_count + d->group_count;
    bool *seen = dem_allocate(count, sizeof *seen);
    if (!cJSON_IsObject(walls->item))
        json_fail(walls, "is not an object");
    stage->changes = dem_allocate((size_t)cJSON_GetArraySize(walls->item), sizeof *stage->changes);
    for (json_value item = {0}; json_next(walls, &item);) {
        size_t w = json_find(&names, item.item->string);
        if (w == d->wall_count)
            w += json_find(&groups, item.item->string);
        if (w == count)
            json_fail(&item, names.problem);
        if (seen[w])
            json_fail(&item, "is there twice, the second time as");
        seen[w] = true;
        dem_wall_change *change = &stage->changes[stage->change_count++];
        *change = read_change(&item, d, w, servos[w].on, true);
        servos[w] = change->sets_servo ? change->servo : servos[w];
        check_velocity(change, servos[w].direction);
    }
    dem_release(seen);
}

/* Without servo control a wall has the velocity that it was given, if any. */
void dem_apply_change(dem *d, const dem_wall_change *change) {
    for (size_t w = 0; w < d->wall_count; w++) {
        dem_wall *wall = &d->walls[w];
        if (w != change->wall && (wall->group == 0 || d->wall_count + wall->group - 1 != change->wall))
            continue;
        const bool ends = change->sets_servo && wall->servo.on;
        wall->velocity = !isnan(change->velocity.x) ? change->velocity : ends ? (vec){0, 0} : wall->velocity;
        wall->spin = !isnan(change->spin) ? change->spin : wall->spin;
        wall->servo = change->sets_servo ? change->servo : wall->servo;
        wall->speed = change->sets_servo ? 0 : wall->speed;
        wall->idle_way = change->sets_servo ? 0 : wall->idle_way;
    }
}

/* ------------------------------------------------------------------------------------------------ walls */

/* Groups of walls, as walls name them; a list of what moves them may follow. */
static void find_group(const json_value *item, dem *d, dem_wall *wall) {
    const json_names groups = {d->groups, d->group_count, sizeof d->groups[0], ""};
    char name[DEM_NAME_SIZE] = "";
    json_read_some(item, (json_key[]){{"group", NAME, name, 0, sizeof name}, {NULL}});
    if (!name[0])
        return;
    const size_t k = json_find(&groups, name);
    if (k == d->group_count && k == DEM_MAX_GROUPS)
        json_refuse(item, "group", "is one group too many");
    if (k == d->group_count)
        strcpy(d->groups[d->group_count++], name);
    wall->group = (uint32_t)k + 1;
}

static void read_wall(const json_value *item, dem *d) {
    dem_wall wall = {.scale = 1, .servo = {.between = {-1, -1}}};
    const json_names shapes = find_shapes(d), materials = dem_materials(d);
    const json_names before = {d->walls, d->wall_count, sizeof *d->walls, "is the name of another wall"};
    const bool plate = json_has(item, "plate"), box = json_has(item, "box"), shape = json_has(item, "shape");
    const char *no = plate ? "is not for a plate" : NULL,
               *no_size = box ? "is not for a box, which has width and height" : no;
    const json_value of_shape = json_member(item, "shape");
    double size = 1, width, height, radius = 0;
    if (shape) {
        json_take(&of_shape, (json_key){"shape", ONE_OF, &wall.shape, .names = &shapes});
        if (d->shapes[wall.shape].is_chain)
            no_size = "is not for a chain, which has the size that it is drawn in";
    }
    if (plate + box + shape != 1 && cJSON_IsObject(item->item))
        json_fail(item, "is not one of plate, box and shape");
    json_key of_plate[] = {{"point", MUST | PAIR, &wall.position}, {"normal", MUST | PAIR, &wall.normal}, {NULL}};
    json_key of_box[] = {{"width", MUST | POSITIVE, &width},
                         {"height", MUST | POSITIVE, &height},
                         {"radius", NUMBER, &radius, 0, 1e300},
                         {NULL}};
    json_read(item, (json_key[]){{"name", MUST | NAME, wall.name, 0, sizeof wall.name},
                                 {"material", MUST | ONE_OF, &wall.material, .names = &materials},
                                 {"plate", OBJECT, of_plate},
                                 {"box", OBJECT, of_box},
                                 {"shape", ONE_OF, &wall.shape, .names = &shapes},
                                 {"size", MUST | POSITIVE, &size, .no = no_size},
                                 {"at", no_size == no || box ? MUST | PAIR : PAIR, &wall.position, .no = no},
                                 {"angle", NUMBER, &wall.angle, -1e6, 1e6, .no = no},
                                 {"pivot", PAIR, &wall.pivot, .no = no},
                                 {"group", ANY},
                                 {"velocity", ANY},
                                 {"spin", ANY},
                                 {"servo", ANY},
                                 {NULL}});
    json_check_new(item, wall.name, before);
    find_group(item, d, &wall);
    wall.kind = plate ? DEM_PLATE : DEM_BOX;
    const json_value part = json_member(item, plate ? "plate" : "box");
    if (plate && !(hypot(wall.normal.x, wall.normal.y) > 0))
        json_refuse(&part, "normal", "has no length");
    if (box) {
        narc_arc arcs[NARC_MAX_ARCS];
        narc_error error;
        size_t count;
        dem_go_to(d, &part);
        if (narc_build_box(width, height, radius, arcs, &count, &error) != NARC_OK)
            dem_fail(d, "%s", error.message);
        wall.shape = dem_add_shape(d, wall.name, arcs, count);
    }
    if (shape && !d->shapes[wall.shape].is_chain)
        wall.scale = size / d->shapes[wall.shape].extent;
    if (!plate && !json_has(item, "pivot"))
        wall.pivot = wall.position;
    dem_go_to(d, item);
    dem_add_wall(d, wall);
}

void dem_read_walls(const json_value *list, const json_value *groups, dem *d, dem_servo **out_servos) {
    for (json_value item = {0}; json_next(list, &item);)
        read_wall(&item, d);
    const json_names walls = {d->walls, d->wall_count, sizeof *d->walls, ""};
    for (size_t k = 0; k < d->group_count; k++)
        if (json_find(&walls, d->groups[k]) < d->wall_count)
            json_fail(list, "has a group with the name of a wall");
    dem_servo *servos = dem_allocate(d->wall_count + d->group_count, sizeof *servos);
    for (json_value item = {0}; json_next(list, &item);) { /* when all names are known */
        const dem_wall_change begin = read_change(&item, d, item.index, false, false);
        check_velocity(&begin, begin.servo.direction);
        servos[item.index] = begin.servo;
        dem_apply_change(d, &begin);
    }
    dem_stage stage = {.gravity = {0, 0}};
    if (groups->item)
        dem_read_changes(groups, d, servos, &stage);
    for (size_t i = 0; i < stage.change_count; i++)
        dem_apply_change(d, &stage.changes[i]);
    dem_release(stage.changes);
    *out_servos = servos;
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
    const json_value size = json_member(item, "size");
    const bool uniform = json_has(&size, "uniform"), normal = json_has(&size, "normal");
    const char *no = uniform ? "is not for uniform, which has limits" : NULL;
    vec n;
    if (!cJSON_IsObject(size.item)) {
        json_take(&size, (json_key){"size", POSITIVE, &sizes.mean});
        return sizes;
    }
    if (uniform + normal + json_has(&size, "lognormal") != 1)
        json_fail(&size, "is not one of uniform, normal and lognormal");
    json_read(&size, (json_key[]){{"uniform", PAIR, &n},
                                  {"normal", PAIR, &n},
                                  {"lognormal", PAIR, &n},
                                  {"low", MUST | POSITIVE, &sizes.low, .no = no},
                                  {"high", MUST | POSITIVE, &sizes.high, .no = no},
                                  {NULL}});
    if (uniform && !(n.x > 0 && n.y >= n.x))
        json_refuse(&size, "uniform", "is not a range of sizes [low, high]");
    if (uniform)
        return (dem_sizes){.kind = DEM_UNIFORM, .low = n.x, .high = n.y};
    if (!(n.x > 0 && n.y > 0))
        json_refuse(&size, normal ? "normal" : "lognormal", "is not a size and a deviation above 0");
    sizes = (dem_sizes){normal ? DEM_NORMAL : DEM_LOGNORMAL, n.x, n.y, sizes.low, sizes.high};
    if (!(sizes.low < sizes.mean && sizes.mean < sizes.high))
        json_fail(&size, "does not have its middle between low and high");
    if (0.5 * (erf(find_deviations(&sizes, sizes.high)) - erf(find_deviations(&sizes, sizes.low))) < LEAST_SHARE)
        json_fail(&size, "leaves fewer than one in 1000 sizes between low and high");
    return sizes;
}

/* ------------------------------------------------------------------------------------------------ grains */

static void fill(const json_value *item, bool lattice, dem *d, uint64_t *random) {
    const char *no_random = lattice ? NULL : "is for lattice", *no_lattice = lattice ? "is for random" : NULL;
    const json_names shapes = find_shapes(d), materials = dem_materials(d);
    const json_value names = json_member(item, "shapes");
    dem_filling f = {.tries = 20000};
    json_read(item, (json_key[]){{"place", ANY},
                                 {"region", MUST | REGION, &f.region},
                                 {"shapes", MUST | SOME_OF, f.shapes, 1, DEM_MAX_CHOICES, &shapes},
                                 {"size", MUST | ANY},
                                 {"material", MUST | ONE_OF, &f.material, .names = &materials},
                                 {"count", lattice ? WHOLE : MUST | WHOLE, &f.count, 1, 1e8},
                                 {"speed", NUMBER, &f.speed, 0, 1e300},
                                 {"spin", NUMBER, &f.spin, 0, 1e300},
                                 {"upright", BOOL, &f.upright},
                                 {"gap", NUMBER, &f.gap, 0, 1e300, .no = no_lattice},
                                 {"tries", WHOLE, &f.tries, 1, 1e9, .no = no_lattice},
                                 {"spacing", MUST | PAIR, &f.spacing, .no = no_random},
                                 {"jitter", NUMBER, &f.jitter, 0, 1, .no = no_random},
                                 {NULL}});
    f.shape_count = (size_t)cJSON_GetArraySize(names.item);
    for (size_t k = 0; k < f.shape_count; k++)
        refuse_chain(&names, d, f.shapes[k]);
    f.sizes = read_sizes(item);
    if (lattice && !(f.spacing.x > 0 && f.spacing.y > 0))
        json_refuse(item, "spacing", "is not two lengths above 0");
    dem_go_to(d, item);
    (lattice ? dem_fill_lattice : dem_fill_randomly)(d, &f, random);
}

static void read_grain(const json_value *item, dem *d) {
    const json_names shapes = find_shapes(d), materials = dem_materials(d);
    dem_grain grain = {.angle = 0};
    double size;
    json_read(item, (json_key[]){{"shape", MUST | ONE_OF, &grain.shape, .names = &shapes},
                                 {"material", MUST | ONE_OF, &grain.material, .names = &materials},
                                 {"at", MUST | PAIR, &grain.position},
                                 {"size", MUST | POSITIVE, &size},
                                 {"angle", NUMBER, &grain.angle, -1e6, 1e6},
                                 {"velocity", PAIR, &grain.velocity},
                                 {"spin", NUMBER, &grain.spin},
                                 {NULL}});
    refuse_chain(item, d, grain.shape);
    grain.scale = size / d->shapes[grain.shape].extent;
    dem_go_to(d, item);
    dem_add_grain(d, grain);
}

void dem_read_grains(const json_value *list, dem *d, uint64_t *random) {
    static const char places[][8] = {"list", "random", "lattice"};
    const json_names names = {places, 3, sizeof places[0], "is not one of list, random and lattice"};
    for (json_value item = {0}; json_next(list, &item);) {
        uint32_t place = 0;
        json_value grains = {.item = NULL};
        json_read_some(&item, (json_key[]){{"place", MUST | ONE_OF, &place, .names = &names}, {NULL}});
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
