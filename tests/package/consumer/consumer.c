/* SPDX-License-Identifier: MIT
 *
 * consumer.c - two circles that overlap and two that do not, through the installed library.
 */
#include <narc.h>
#include <stdio.h>

int main(void) {
    static const float x[] = {0.0f, 1.5f, 9.0f}, zero = 0.0f, one = 1.0f;
    static const uint32_t a[] = {0, 1}, b[] = {1, 2}, circle = 0;
    narc_shapes *shapes = NULL;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count = 0;
    uint64_t bits[NARC_BIT_WORDS(2)];
    narc_error error = {NARC_OK, 0, 0.0, ""};
    narc_bodies bodies = {
        .count = 3, .y = {&zero, 0, NARC_FLOAT32}, .cosine = {&one, 0}, .sine = {&zero, 0}, .shape = {&circle, 0}};
    narc_pairs pairs = {.count = 2, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    bodies.x = NARC_POSITION_ARRAY(x);

    if (narc_create_shapes(NULL, &shapes) || narc_build_circle(1.0, arcs, &arc_count, &error) ||
        narc_add_shape(shapes, arcs, arc_count, NULL, &error) ||
        narc_find_overlaps(shapes, &bodies, &pairs, NULL, bits, &error)) {
        fprintf(stderr, "narc: %s\n", error.message);
        return 1;
    }
    narc_destroy_shapes(shapes);
    printf("narc %s, %s, bits %llu\n", narc_version(), narc_get_isa(), (unsigned long long)bits[0]);
    return bits[0] == 1 ? 0 : 1;
}
