/* SPDX-License-Identifier: MIT
 *
 * storage.c - how many bytes a shape takes.
 */
#include "paper.h"
#include "store.h"

/* What the paper's algorithms read, in bytes of single precision. SAT and GJK of n-arcs: n centres, directions and
 * radii, and the centroid. Polygons: n vertices and perpendiculars. */
size_t arc_bytes(size_t n) { return sizeof(float) * (2 * n + 2 * n + n + 2); }
size_t gon_bytes(size_t n) { return sizeof(float) * (2 * n + 2 * n); }

/* What this library stores, of whatever shape. */
static size_t store_bytes(size_t n) {
    return sizeof(narc_shape_header) + sizeof(narc_record) * (narc_angle_records(n) + n + 1);
}

void print_storage(const struct paper *paper, FILE *out) {
    static size_t (*const counts[])(size_t) = {arc_bytes, gon_bytes, store_bytes};
    static const char *const titles[] = {
        "n-arc, SAT and GJK: centres, directions, radii, centroid",
        "n-gon, SAT (GJK: half of it): vertices, perpendiculars",
        "this library, n-arc or n-gon, all methods: circles around and inside, junction angles, arcs, box"};
    print_sizes_head(paper, "Bytes of a shape, single precision", "| |", "", out);
    for (size_t what = 0; what < sizeof counts / sizeof counts[0]; what++) {
        fprintf(out, "| %s |", titles[what]);
        for (size_t size = 0; size < paper->settings.size_count; size++)
            fprintf(out, " %zu |", counts[what](paper->settings.sizes[size]));
        fputc('\n', out);
    }
}
