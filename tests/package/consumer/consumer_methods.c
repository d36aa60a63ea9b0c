/* SPDX-License-Identifier: MIT
 *
 * consumer_methods.c - two boxes by two other methods, through the installed library of methods. C and C++.
 */
#include <math.h>
#include <narc_methods.h>
#include <stdio.h>
#include <string.h>

int main(void) {
    static const float x[] = {0.0f, 1.5f}, zero = 0.0f, one = 1.0f;
    static const uint32_t a = 0, b = 1, box = 0;
    narc_shapes *shapes = NULL;
    narc_methods *methods = NULL;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count = 0, found = 0;
    uint64_t bits = 0;
    float separation = 0.0f;
    narc_error error;
    narc_bodies bodies;
    narc_pairs pairs;
    narc_contacts contacts;
    narc_method_query gjk, boxes;
    memset(&error, 0, sizeof error);
    memset(&bodies, 0, sizeof bodies);
    memset(&pairs, 0, sizeof pairs);
    memset(&contacts, 0, sizeof contacts);
    memset(&gjk, 0, sizeof gjk);
    memset(&boxes, 0, sizeof boxes);
    bodies.count = 2;
    bodies.x.base = x;
    bodies.x.stride = sizeof x[0];
    bodies.y.base = bodies.sine.base = &zero;
    bodies.cosine.base = &one;
    bodies.shape.base = &box;
    pairs.count = 1;
    pairs.a.base = &a;
    pairs.b.base = &b;
    contacts.capacity = 1;
    contacts.separation = &separation;
    gjk.method = NARC_METHOD_GJK;
    gjk.tolerance = 1e-3f;
    boxes.method = NARC_METHOD_AABB;
    if (narc_create_shapes(NULL, &shapes) || narc_build_box(2.0, 2.0, 0.25, arcs, &arc_count, &error) ||
        narc_add_shape(shapes, arcs, arc_count, NULL, &error) || narc_create_methods(shapes, NULL, &methods, &error) ||
        narc_find_overlaps_by(methods, &bodies, &pairs, &boxes, 0, &bits, &error) ||
        narc_find_contacts_by(methods, &bodies, &pairs, &gjk, 0.0f, 0, &contacts, &found, &error)) {
        fprintf(stderr, "narc: %s\n", error.message);
        return 1;
    }
    narc_destroy_methods(methods);
    narc_destroy_shapes(shapes);
    printf("narc %s, %s %d, separation by %s %g\n", narc_version(), narc_method_name(boxes.method), (int)bits,
           narc_method_name(gjk.method), (double)separation);
    /* The bounding radii are less than 1.4 each: the error is below 2.8 tolerances, and rounding is far below 0.2. */
    return bits == 1 && found == 1 && fabs((double)separation + 0.5) < 3e-3 ? 0 : 1;
}
