/* SPDX-License-Identifier: MIT
 *
 * contacts.c - the smallest whole program: three capsules, two pairs, one contact. The README prints it.
 *   cc contacts.c $(pkg-config --cflags --libs narc)
 */
/* code: begin */
#include <narc.h>
#include <stdio.h>

int main(void) {
    struct {
        float x, y, c, s;
        uint32_t shape;
    } body[] = {{0, 0, 1, 0, 0}, {4, 4, 0, 1, 0}, {20, 0, 1, 0, 0}};
    struct {
        uint32_t a, b;
    } pair[] = {{0, 1}, {1, 2}};
    narc_bodies bodies = {.count = 3,
                          .x = NARC_POSITION_COLUMN(body, x),
                          .y = NARC_POSITION_COLUMN(body, y),
                          .cosine = NARC_COLUMN(body, c),
                          .sine = NARC_COLUMN(body, s),
                          .shape = NARC_COLUMN(body, shape)};
    narc_pairs pairs = {.count = 2, .a = NARC_COLUMN(pair, a), .b = NARC_COLUMN(pair, b)};
    float separation[2], normal_x[2], normal_y[2];
    narc_contacts contacts = {.capacity = 2, .separation = separation, .normal_x = normal_x, .normal_y = normal_y};
    narc_arc arcs[NARC_MAX_ARCS];
    narc_shapes *shapes = NULL;
    size_t arc_count, found;
    if (narc_create_shapes(NULL, &shapes) || narc_build_capsule(6, 1, arcs, &arc_count, NULL) ||
        narc_add_shape(shapes, arcs, arc_count, NULL, NULL) ||
        narc_find_contacts(shapes, &bodies, &pairs, 0, 0, &contacts, &found, NULL))
        return 1;
    for (size_t k = 0; k < found; k++)
        printf("separation %g, normal %g %g\n", separation[k], normal_x[k], normal_y[k]);
    narc_destroy_shapes(shapes);
}
/* code: end */
