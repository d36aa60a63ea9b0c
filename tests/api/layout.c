/* SPDX-License-Identifier: MIT
 *
 * layout.c - where the fields of public structures lie: what programs that were compiled with another version of the
 * headers of the same SONAME count on, and what other languages read rows by. The library's own table says the same, and has
 * no structure that is not here.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_chains.h"
#include "narc_contacts.h"
#include "narc_files.h"
#include "narc_fit.h"
#include "narc_layouts.h"
#include "narc_methods.h"
#include "narc_scene.h"

#define AT(field, offset) (offsetof(type, field) == (offset))
#define LAYOUT(structure, size, fields)                                                                                \
    do {                                                                                                               \
        typedef structure type;                                                                                        \
        _Static_assert(sizeof(type) == (size) && (fields), #structure);                                                \
        check_table(#structure, size, #fields);                                                                        \
    } while (0)

/* Which structures stand here, by their numbers in the library's table. */
enum { MOST = 256 };
static bool stands_here[MOST];

/* The library's table has the fields that stand here, "AT(x, 0) && AT(y, 8)", each of them and in this order. */
static void check_table(const char *structure, size_t size, const char *fields) {
    const narc_layout *const layout = narc_find_layout(structure);
    char text[4096] = "";
    for (size_t k = 0, end = 0; layout && k < layout->member_count; k++)
        end += (size_t)snprintf(text + end, sizeof text - end, "%sAT(%s, %zu)", k ? " && " : "",
                                layout->members[k].name, layout->members[k].offset);
    if (!layout || layout->size != size || strcmp(text, fields) != 0) {
        printf("%s: the table has %zu bytes, %s; here stand %zu, %s\n", structure, layout ? layout->size : 0, text,
               size, fields);
        exit(1);
    }
    for (size_t k = 0; k < MOST && narc_get_layout(k); k++)
        stands_here[k] = stands_here[k] || narc_get_layout(k) == layout;
}

/* On every platform: rows, and what is made of numbers alone. */
static void check_numbers(void) {
    LAYOUT(narc_contact, 36,
           AT(pair, 0) && AT(feature, 4) && AT(count, 6) && AT(separation, 8) && AT(normal_x, 12) && AT(normal_y, 16) &&
               AT(point_x, 20) && AT(point_y, 24) && AT(radius_a, 28) && AT(radius_b, 32));
    LAYOUT(narc_refined_contact, 40,
           AT(separation, 0) && AT(normal_x, 8) && AT(normal_y, 16) && AT(point_x, 24) && AT(point_y, 32));
    LAYOUT(narc_manifold_point, 16, AT(x, 0) && AT(y, 4) && AT(separation, 8) && AT(feature, 12));
    LAYOUT(narc_manifold, 64,
           AT(pair, 0) && AT(count, 4) && AT(normal_x, 8) && AT(normal_y, 12) && AT(radius_a, 16) && AT(radius_b, 20) &&
               AT(reach_a, 24) && AT(reach_b, 28) && AT(point, 32));
    LAYOUT(narc_ray_hit, 36,
           AT(ray, 0) && AT(body, 4) && AT(feature, 8) && AT(count, 10) && AT(fraction, 12) && AT(normal_x, 16) &&
               AT(normal_y, 20) && AT(point_x, 24) && AT(point_y, 28) && AT(radius, 32));
    LAYOUT(narc_impact, 44,
           AT(pair, 0) && AT(body, 4) && AT(feature, 8) && AT(count, 10) && AT(fraction, 12) && AT(separation, 16) &&
               AT(normal_x, 20) && AT(normal_y, 24) && AT(point_x, 28) && AT(point_y, 32) && AT(radius_a, 36) &&
               AT(radius_b, 40));
    LAYOUT(narc_distance, 36,
           AT(point, 0) && AT(body, 4) && AT(feature, 8) && AT(count, 10) && AT(separation, 12) && AT(normal_x, 16) &&
               AT(normal_y, 20) && AT(place_x, 24) && AT(place_y, 28) && AT(radius, 32));
    LAYOUT(narc_chain_entry, 32,
           AT(shape, 0) && AT(run, 4) && AT(x, 8) && AT(y, 16) && AT(first_arc, 24) && AT(arc_count, 28));
    LAYOUT(narc_point, 16, AT(x, 0) && AT(y, 8));
    LAYOUT(narc_arc, 40, AT(center_x, 0) && AT(center_y, 8) && AT(radius, 16) && AT(start, 24) && AT(end, 32));
    LAYOUT(narc_four_arc, 40,
           AT(radius_low, 0) && AT(radius_high, 8) && AT(distance, 16) && AT(radius_left, 24) && AT(radius_right, 32));
    LAYOUT(narc_mass, 32, AT(area, 0) && AT(centroid_x, 8) && AT(centroid_y, 16) && AT(second_moment, 24));
    LAYOUT(narc_circle, 24, AT(x, 0) && AT(y, 8) && AT(radius, 16));
    LAYOUT(narc_aabb, 32, AT(min_x, 0) && AT(min_y, 8) && AT(max_x, 16) && AT(max_y, 24));
    LAYOUT(narc_motion, 12, AT(x, 0) && AT(y, 4) && AT(angle, 8));
    LAYOUT(narc_body, 32, AT(x, 0) && AT(y, 8) && AT(cosine, 16) && AT(sine, 20) && AT(scale, 24) && AT(shape, 28));
    LAYOUT(narc_box, 16, AT(min_x, 0) && AT(min_y, 4) && AT(max_x, 8) && AT(max_y, 12));
    LAYOUT(narc_touch_event, 24,
           AT(slot, 0) && AT(marks, 4) && AT(parted, 5) && AT(unused, 6) && AT(id_a, 8) && AT(id_b, 16));
    LAYOUT(narc_curve_arc, 64, AT(start, 0) && AT(end, 16) && AT(center, 32) && AT(radius, 48) && AT(turn, 56));
}

/* Where a pointer and a size have 64 bits. A structure that a caller fills grows into its `reserved`, so that its size
 * stays. */
static void check_pointers(void) {
#if UINTPTR_MAX == UINT64_MAX && SIZE_MAX == UINT64_MAX
    LAYOUT(narc_member, 40, AT(name, 0) && AT(type, 8) && AT(offset, 16) && AT(size, 24) && AT(count, 32));
    LAYOUT(narc_layout, 40, AT(name, 0) && AT(size, 8) && AT(alignment, 16) && AT(members, 24) && AT(member_count, 32));
    LAYOUT(narc_constant, 16, AT(name, 0) && AT(value, 8));
    LAYOUT(narc_float_column, 16, AT(base, 0) && AT(stride, 8));
    LAYOUT(narc_index_column, 16, AT(base, 0) && AT(stride, 8));
    LAYOUT(narc_word_column, 16, AT(base, 0) && AT(stride, 8));
    LAYOUT(narc_byte_column, 16, AT(base, 0) && AT(stride, 8));
    LAYOUT(narc_position_column, 24, AT(base, 0) && AT(stride, 8) && AT(precision, 16));
    LAYOUT(narc_motions, 64, AT(x, 0) && AT(y, 16) && AT(angle, 32) && AT(reserved, 48));
    LAYOUT(narc_cast_options, 56,
           AT(target, 0) && AT(tolerance, 4) && AT(workers, 8) && AT(out_skipped, 16) && AT(targets, 24) &&
               AT(front_only, 40) && AT(parting, 44) && AT(reserved, 48));
    LAYOUT(narc_chain_options, 56,
           AT(closed, 0) && AT(first_run, 4) && AT(weld, 8) && AT(least_radius, 16) && AT(thickness, 24) &&
               AT(both_sides, 28) && AT(reserved, 32));
    LAYOUT(narc_workers, 24, AT(context, 0) && AT(count, 8) && AT(run, 16));
    LAYOUT(narc_error, 216, AT(status, 0) && AT(index, 8) && AT(value, 16) && AT(message, 24));
    LAYOUT(narc_allocator, 24, AT(allocate, 0) && AT(release, 8) && AT(context, 16));
    LAYOUT(narc_bodies, 136,
           AT(count, 0) && AT(x, 8) && AT(y, 32) && AT(cosine, 56) && AT(sine, 72) && AT(scale, 88) && AT(shape, 104) &&
               AT(reserved, 120));
    LAYOUT(narc_pairs, 96,
           AT(count, 0) && AT(a, 8) && AT(b, 24) && AT(other_bodies, 40) && AT(shift_x, 48) && AT(shift_y, 64) &&
               AT(reserved, 80));
    LAYOUT(narc_pair_filter, 80, AT(kind, 0) && AT(category, 16) && AT(mask, 32) && AT(owner, 48) && AT(world, 64));
    LAYOUT(narc_contacts_settings, 64,
           AT(rows, 0) && AT(user_size, 8) && AT(row_offset, 16) && AT(allocator, 24) && AT(reserved, 32));
    LAYOUT(narc_step, 216,
           AT(bodies, 0) && AT(margin, 8) && AT(second_margin, 12) && AT(flat_angle, 16) && AT(front_only, 20) &&
               AT(skin, 24) && AT(recycling, 28) && AT(pairs, 32) && AT(same_pairs, 40) && AT(motion_x, 48) &&
               AT(motion_y, 64) && AT(reach, 80) && AT(ahead, 96) && AT(id, 112) && AT(run, 128) && AT(filter, 144) &&
               AT(moved, 152) && AT(moved_count, 168) && AT(workers, 176) && AT(origin, 184) &&
               AT(out_world_count, 192) && AT(world_count, 200) && AT(reserved, 208));
    LAYOUT(narc_step_result, 240,
           AT(pairs, 0) && AT(order, 96) && AT(count, 104) && AT(state, 112) && AT(manifolds, 120) &&
               AT(contacts, 128) && AT(more, 136) && AT(more_count, 144) && AT(user, 152) && AT(touching, 160) &&
               AT(sensors, 168) && AT(touching_count, 176) && AT(sensor_count, 184) && AT(began, 192) &&
               AT(ended, 200) && AT(began_count, 208) && AT(ended_count, 216) && AT(skipped, 224) &&
               AT(asked_count, 232));
    LAYOUT(narc_query, 144,
           AT(margin, 0) && AT(second_margin, 4) && AT(flat_angle, 8) && AT(dense, 12) && AT(margins, 16) &&
               AT(selection, 32) && AT(selection_count, 48) && AT(first, 56) && AT(count, 64) && AT(row_stride, 72) &&
               AT(workers, 80) && AT(out_skipped, 88) && AT(front_only, 96) && AT(reserved, 104));
    LAYOUT(narc_refinement, 176,
           AT(arcs, 0) && AT(cosine, 8) && AT(sine, 32) && AT(other_cosine, 56) && AT(other_sine, 80) &&
               AT(shift_x, 104) && AT(shift_y, 128) && AT(workers, 152) && AT(reserved, 160));
    LAYOUT(narc_box_options, 104,
           AT(margin, 0) && AT(motion_x, 8) && AT(motion_y, 24) && AT(first, 40) && AT(count, 48) && AT(workers, 56) &&
               AT(out_skipped, 64) && AT(origin, 72) && AT(reserved, 80));
    LAYOUT(narc_index_options, 64,
           AT(category, 0) && AT(fast, 16) && AT(workers, 24) && AT(origin, 32) && AT(world, 40) && AT(reserved, 56));
    LAYOUT(narc_index_statistics, 64,
           AT(boxes, 0) && AT(bodies, 8) && AT(nodes, 16) && AT(leaves, 24) && AT(depth, 32) && AT(bytes, 40) &&
               AT(mean_perimeter, 48) && AT(slack, 56));
    LAYOUT(narc_owners, 64, AT(owner, 0) && AT(ignored, 16) && AT(reserved, 32));
    LAYOUT(narc_index_query, 72,
           AT(mask, 0) && AT(ignored, 16) && AT(workers, 32) && AT(owners, 40) && AT(world, 48) && AT(reserved, 64));
    LAYOUT(narc_rays, 120,
           AT(count, 0) && AT(x, 8) && AT(y, 32) && AT(motion_x, 56) && AT(motion_y, 72) && AT(fraction, 88) &&
               AT(reserved, 104));
    LAYOUT(narc_ray_options, 128,
           AT(search, 0) && AT(inside, 72) && AT(any, 76) && AT(most, 80) && AT(out_skipped, 88) && AT(out_order, 96) &&
               AT(reserved, 104));
    LAYOUT(narc_points, 72, AT(count, 0) && AT(x, 8) && AT(y, 32) && AT(reserved, 56));
    LAYOUT(narc_nearest_options, 120,
           AT(search, 0) && AT(distance, 72) && AT(inside, 76) && AT(most, 80) && AT(reserved, 88));
    LAYOUT(narc_method_options, 56,
           AT(method, 0) && AT(tolerance, 4) && AT(iterations, 8) && AT(out_outcomes, 16) && AT(simplexes, 24) &&
               AT(reserved, 32));
    LAYOUT(narc_named_shape, 48,
           AT(name, 0) && AT(arcs, 8) && AT(arc_count, 16) && AT(origin, 24) && AT(index, 40) && AT(form, 44));
    LAYOUT(narc_shape_list, 16, AT(count, 0) && AT(items, 8));
    LAYOUT(narc_contours, 40, AT(points, 0) && AT(point_count, 8) && AT(ends, 16) && AT(count, 24) && AT(flatness, 32));
    LAYOUT(narc_image_request, 48,
           AT(silhouette, 0) && AT(threshold, 8) && AT(out_whole, 16) && AT(element, 24) && AT(trace, 32) &&
               AT(out_exact, 40));
    LAYOUT(narc_dxf_request, 40, AT(layer, 0) && AT(out_unit, 8) && AT(out_open, 16) && AT(reserved, 24));
    LAYOUT(narc_parts_request, 48,
           AT(most, 0) && AT(tolerance, 8) && AT(lap, 16) && AT(flatness, 24) && AT(reserved, 32));
    LAYOUT(narc_parts, 32, AT(paths, 0) && AT(count, 8) && AT(distance, 16) && AT(area, 24));
    LAYOUT(narc_fit_request, 64,
           AT(arc_count, 0) && AT(tolerance, 8) && AT(family, 16) && AT(goal, 20) && AT(flatness, 24) &&
               AT(min_radius, 32) && AT(keep_origin, 40) && AT(quick, 41) && AT(starts, 44) && AT(progress, 48) &&
               AT(context, 56));
    LAYOUT(narc_fit_result, 2672,
           AT(arcs, 0) && AT(arc_count, 2560) && AT(edge_count, 2568) && AT(origin, 2576) && AT(area, 2592) &&
               AT(perimeter, 2600) && AT(hull_area, 2608) && AT(hull_perimeter, 2616) && AT(max_distance, 2624) &&
               AT(mean_distance, 2632) && AT(difference_area, 2640) && AT(clearance, 2648) && AT(flatness, 2656) &&
               AT(seconds, 2664));
    LAYOUT(narc_arc_chains, 40, AT(arcs, 0) && AT(arc_count, 8) && AT(ends, 16) && AT(count, 24) && AT(distance, 32));
#endif
}

/* As another program is to read it, into as much room as it asks for; what has no room is not written. */
static char *make_json(void) {
    const size_t size = narc_write_layouts(NULL, 0);
    char *const text = malloc(size + 1), end = 'x';
    memset(text, end, size + 1);
    if (narc_write_layouts(text, size / 2) != size || text[size / 2 - 1] != 0 || text[size / 2] != end ||
        narc_write_layouts(text, size + 1) != size || strlen(text) != size)
        exit(1);
    return text;
}

int main(int argc, char **argv) {
    char *const json = make_json();
    if (argc > 1 && strcmp(argv[1], "json") == 0) {
        fputs(json, stdout);
        free(json);
        return 0;
    }
    free(json);
    check_numbers();
    check_pointers();
    const narc_layout *layout;
    for (size_t k = 0; sizeof(void *) == 8 && (layout = narc_get_layout(k)); k++)
        if (layout->member_count > 0 && (k >= MOST || !stands_here[k])) {
            printf("%s is in the table, and does not stand here\n", layout->name);
            return 1;
        }
    puts("structures are where they were");
}
