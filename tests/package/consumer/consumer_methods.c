/* SPDX-License-Identifier: MIT
 *
 * consumer_methods.c - two boxes by two other methods, through the installed library of methods. C and C++.
 */
#include <math.h>
#include <narc_methods.h>
#include <stdio.h>
#include <string.h>

int main(void) {
    static const narc_body two[] = {{0.0, 0.0, 1.0f, 0.0f, 1.0f, 0}, {1.5, 0.0, 1.0f, 0.0f, 1.0f, 0}};
    narc_bodies bodies;
    narc_view_bodies(two, 2, &bodies);
    narc_shapes *shapes = NULL;
    narc_methods *methods = NULL;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count = 0, found = 0;
    uint64_t bits = 0;
    narc_error error;
    narc_pairs pairs;
    narc_contact contact;
    narc_method_options gjk, boxes;
    memset(&error, 0, sizeof error);
    memset(&pairs, 0, sizeof pairs);
    memset(&contact, 0, sizeof contact);
    memset(&gjk, 0, sizeof gjk);
    memset(&boxes, 0, sizeof boxes);
    pairs.count = 1;
    gjk.method = NARC_METHOD_GJK;
    gjk.tolerance = 1e-3f;
    boxes.method = NARC_METHOD_AABB;
    if (narc_create_shapes(NULL, &shapes) || narc_build_box(2.0, 2.0, 0.25, arcs, &arc_count, &error) ||
        narc_add_shape(shapes, arcs, arc_count, NULL, &error) || narc_create_methods(shapes, NULL, &methods, &error) ||
        narc_find_overlaps_by(methods, &bodies, &pairs, &boxes, NULL, &bits, &error) ||
        narc_find_contacts_by(methods, &bodies, &pairs, &gjk, NULL, &contact, 1, &found, &error)) {
        fprintf(stderr, "narc: %s\n", error.message);
        return 1;
    }
    narc_destroy_methods(methods);
    narc_destroy_shapes(shapes);
    printf("narc %s, %s %d, separation by %s %g\n", narc_version(), narc_method_name(boxes.method), (int)bits,
           narc_method_name(gjk.method), (double)contact.separation);
    /* The bounding radii are less than 1.4 each: the error is below 2.8 tolerances, and rounding is far below 0.2. */
    return bits == 1 && found == 1 && fabs((double)contact.separation + 0.5) < 3e-3 ? 0 : 1;
}
