/* SPDX-License-Identifier: MIT
 *
 * input_grains.c - the JSON file's shapes and grains.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <narc_files.h>

#include "input.h"
#include "place.h"

/* ------------------------------------------------------------------------------------------------ shapes */

/* A shapes file as narc fit writes it, named from the input's folder. */
void dem_find_shapes_file(const json_value *root, char path[DEM_SHAPES_PATH_SIZE]) {
    const json_value name = json_require(root, "shapes");
    char text[DEM_PATH_SIZE];
    json_text(&name, text, sizeof text);
    const char *slash = strrchr(root->file, '/');
    if (slash && text[0] != '/' && (size_t)(slash - root->file) < DEM_PATH_SIZE)
        snprintf(path, DEM_SHAPES_PATH_SIZE, "%.*s/%s", (int)(slash - root->file), root->file, text);
    else
        snprintf(path, DEM_SHAPES_PATH_SIZE, "%s", text);
}

/* NAME/1, NAME/2 ... are the parts of NAME, where their origins tell, if there is no shape of that name. */
static void read_parts(const json_value *file, const narc_shape_list *shapes, const char *name, int length, dem *d) {
    char base[1024], text[1056];
    narc_arc *arcs = calloc(shapes->count, NARC_MAX_ARCS * sizeof *arcs);
    size_t *counts = calloc(shapes->count, sizeof *counts), count = 0, used = 0;
    uint32_t index;
    if (!arcs || !counts)
        fail("not enough memory for shapes");
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

void dem_read_shapes(const json_value *root, dem *d) {
    const json_value name = json_require(root, "shapes");
    char path[DEM_SHAPES_PATH_SIZE];
    dem_find_shapes_file(root, path);
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
            dem_fail_at(&name, d);
    }
    for (size_t k = 0; k < shapes->count; k++) {
        const char *slash = strrchr(shapes->items[k].name, '/');
        if (slash && strcmp(slash, "/1") == 0)
            read_parts(&name, shapes, shapes->items[k].name, (int)(slash - shapes->items[k].name), d);
    }
    narc_destroy_shape_list(shapes);
}

uint32_t dem_find_shape(const json_value *name, const dem *d) {
    return (uint32_t)json_find(name, d->shapes, d->shape_count, sizeof *d->shapes, "is not the name of a shape");
}

/* ------------------------------------------------------------------------------------------------ sizes */

/* Sizes beyond the limits are drawn again: so many must be within. */
static const double LEAST_SHARE = 0.001;

/* How far a size is from the middle, in deviations times sqrt(2). */
static double find_deviations(const dem_sizes *sizes, double size) {
    const double off = sizes->kind == DEM_NORMAL ? size - sizes->mean : log(size / sizes->mean);
    return off / (sizes->deviation * 1.4142135623730951);
}

/* The share of sizes that lie within the limits. */
static double find_share(const dem_sizes *sizes) {
    return 0.5 * (erf(find_deviations(sizes, sizes->high)) - erf(find_deviations(sizes, sizes->low)));
}

static dem_sizes read_sizes(const json_value *value) {
    if (cJSON_IsNumber(value->item))
        return (dem_sizes){.kind = DEM_FIXED, .mean = json_number(value, 0, 1e300, true)};
    json_check_object(value, "uniform normal lognormal low high");
    const json_value uniform = json_member(value, "uniform"), normal = json_member(value, "normal");
    const json_value lognormal = json_member(value, "lognormal");
    if ((uniform.item != NULL) + (normal.item != NULL) + (lognormal.item != NULL) != 1)
        json_fail(value, "is not one of uniform, normal and lognormal");
    const json_value *given = uniform.item ? &uniform : normal.item ? &normal : &lognormal;
    const dem_vec n = json_vec(given);
    if (uniform.item) {
        json_refuse(value, "low high", "is not for uniform, which has limits");
        if (!(n.x > 0 && n.y >= n.x))
            json_fail(&uniform, "is not a range of sizes [low, high]");
        return (dem_sizes){.kind = DEM_UNIFORM, .low = n.x, .high = n.y};
    }
    if (!(n.x > 0 && n.y > 0))
        json_fail(given, "is not a size and a deviation above 0");
    const dem_sizes sizes = {.kind = normal.item ? DEM_NORMAL : DEM_LOGNORMAL,
                             .mean = n.x,
                             .deviation = n.y,
                             .low = json_positive(value, "low"),
                             .high = json_positive(value, "high")};
    if (!(sizes.low < sizes.mean && sizes.mean < sizes.high))
        json_fail(value, "does not have its middle between low and high");
    if (find_share(&sizes) < LEAST_SHARE)
        json_fail(value, "leaves fewer than one in 1000 sizes between low and high");
    return sizes;
}

/* ------------------------------------------------------------------------------------------------ places */

static void read_choices(const json_value *item, const dem *d, dem_filling *f) {
    const json_value list = json_require(item, "shapes");
    f->shape_count = json_list(&list);
    if (f->shape_count == 0 || f->shape_count > DEM_MAX_CHOICES)
        json_fail(&list, "is empty, or has more than 64 shapes");
    for (size_t i = 0; i < f->shape_count; i++) {
        const json_value name = json_at(&list, i);
        f->shapes[i] = dem_find_shape(&name, d);
    }
}

static dem_filling read_filling(const json_value *item, const dem *d) {
    dem_filling f = {.tries = 20000};
    const json_value material = json_require(item, "material"), region = json_require(item, "region");
    const json_value size = json_require(item, "size"), count = json_member(item, "count");
    const json_value tries = json_member(item, "tries");
    f.material = dem_find_material(&material, d);
    f.region = dem_read_region(&region);
    f.sizes = read_sizes(&size);
    f.count = count.item ? json_whole(&count, 1, 100000000) : 0;
    f.speed = json_number_or(item, "speed", 0, 1e300, 0);
    f.spin = json_number_or(item, "spin", 0, 1e300, 0);
    f.upright = json_bool_or(item, "upright", false);
    f.tries = tries.item ? json_whole(&tries, 1, 1000000000) : f.tries;
    read_choices(item, d, &f);
    return f;
}

static void read_random(const json_value *item, dem *d, uint64_t *random) {
    json_check_object(item, "place count region shapes size material speed spin upright gap tries");
    dem_filling f = read_filling(item, d);
    json_require(item, "count");
    f.gap = json_number_or(item, "gap", 0, 1e300, 0);
    if (!dem_fill_randomly(d, &f, random))
        dem_fail_at(item, d);
}

static void read_lattice(const json_value *item, dem *d, uint64_t *random) {
    json_check_object(item, "place count region shapes size material speed spin upright spacing jitter");
    dem_filling f = read_filling(item, d);
    const json_value spacing = json_require(item, "spacing");
    f.spacing = json_vec(&spacing);
    if (!(f.spacing.x > 0 && f.spacing.y > 0))
        json_fail(&spacing, "is not two lengths above 0");
    f.jitter = json_number_or(item, "jitter", 0, 1, 0);
    if (!dem_fill_lattice(d, &f, random))
        dem_fail_at(item, d);
}

static void read_grain(const json_value *item, dem *d) {
    json_check_object(item, "shape material at angle size velocity spin");
    const json_value form = json_require(item, "shape"), material = json_require(item, "material");
    const json_value at = json_require(item, "at");
    const dem_vec place = json_vec(&at), velocity = json_vec_or(item, "velocity", (dem_vec){0, 0});
    dem_grain grain = {.shape = dem_find_shape(&form, d),
                       .material = dem_find_material(&material, d),
                       .x = place.x,
                       .y = place.y,
                       .angle = json_number_or(item, "angle", -1e6, 1e6, 0),
                       .vx = velocity.x,
                       .vy = velocity.y,
                       .spin = json_number_or(item, "spin", -1e300, 1e300, 0)};
    grain.scale = json_positive(item, "size") / d->shapes[grain.shape].extent;
    if (!dem_add_grain(d, grain))
        dem_fail_at(item, d);
}

static void read_list(const json_value *item, dem *d) {
    json_check_object(item, "place grains");
    const json_value list = json_require(item, "grains");
    json_value grain = {.file = list.file};
    size_t k = 0;
    json_list(&list);
    cJSON_ArrayForEach(grain.item, list.item) { /* not by index, which would count from the start each time */
        snprintf(grain.place, sizeof grain.place, "%.80s[%zu]", list.place, k++);
        read_grain(&grain, d);
    }
}

void dem_read_grains(const json_value *root, dem *d, uint64_t *random) {
    const json_value list = json_require(root, "grains");
    const size_t count = json_list(&list);
    for (size_t i = 0; i < count; i++) {
        const json_value item = json_at(&list, i);
        if (!cJSON_IsObject(item.item))
            json_fail(&item, "is not an object");
        const json_value place = json_require(&item, "place");
        char name[DEM_NAME_SIZE];
        json_text(&place, name, sizeof name);
        if (strcmp(name, "random") == 0)
            read_random(&item, d, random);
        else if (strcmp(name, "lattice") == 0)
            read_lattice(&item, d, random);
        else if (strcmp(name, "list") == 0)
            read_list(&item, d);
        else
            json_fail(&place, "is not one of list, random and lattice");
    }
    if (d->grain_count == 0)
        json_fail(&list, "has no grains");
}
