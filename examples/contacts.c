/* SPDX-License-Identifier: MIT
 *
 * contacts.c - the smallest whole program: three capsules, two pairs, one contact. The README prints it.
 *   cc contacts.c $(pkg-config --cflags --libs narc)
 */
/* code: begin */
#include <narc.h>
#include <stdio.h>

int main(void) {
    narc_body body[] = {{0, 0, 1, 0, 1, 0}, {4, 4, 0, 1, 1, 0}, {20, 0, 1, 0, 1, 0}}; /* x y cosine sine scale shape */
    uint32_t a[] = {0, 1}, b[] = {1, 2};
    narc_bodies bodies;
    narc_view_bodies(body, 3, &bodies);
    narc_pairs pairs = {.count = 2, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    narc_contact contact[2];
    narc_arc arcs[NARC_MAX_ARCS];
    narc_shapes *shapes = NULL;
    size_t arc_count, found;
    if (narc_create_shapes(NULL, &shapes) || narc_build_capsule(6, 1, arcs, &arc_count, NULL) ||
        narc_add_shape(shapes, arcs, arc_count, NULL, NULL) ||
        narc_find_contacts(shapes, &bodies, &pairs, NULL, contact, 2, &found, NULL))
        return 1;
    for (size_t k = 0; k < found; k++)
        printf("separation %g, normal %g %g\n", contact[k].separation, contact[k].normal_x, contact[k].normal_y);
    narc_destroy_shapes(shapes);
}
/* code: end */
