// SPDX-License-Identifier: MIT
//
// consumer.cpp - the headers in C++: two boxes, one contact, an engine's own array of structures.
#include <narc.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace {
struct Body {
    double x, y;
    float cosine, sine;
    uint32_t shape;
};
struct Pair {
    uint32_t a, b;
};
const Pair pair[] = {{0, 1}};
const narc_index_column first_of_pair = NARC_COLUMN_INIT(pair, a);

std::ptrdiff_t stride_of(narc_index_column column) { return column.stride; }
} // namespace

int main() {
    const Body body[] = {{0.0, 0.0, 1.0f, 0.0f, 0}, {1.5, 0.0, 1.0f, 0.0f, 0}};
    narc_error error = {};
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count = 0, contact_count = 0;
    narc_shapes *shapes = nullptr;

    narc_bodies bodies = {};
    bodies.count = 2;
    bodies.x = NARC_POSITION_COLUMN(body, x);
    bodies.y = NARC_POSITION_COLUMN(body, y);
    bodies.cosine = NARC_COLUMN(body, cosine);
    bodies.sine = NARC_COLUMN(body, sine);
    bodies.shape = NARC_COLUMN(body, shape);
    narc_pairs pairs = {};
    pairs.count = 1;
    pairs.a = first_of_pair;
    pairs.b = NARC_COLUMN(pair, b);

    narc_contact contact = {};

    if (narc_create_shapes(nullptr, &shapes) || narc_build_box(2.0, 2.0, 0.25, arcs, &arc_count, &error) ||
        narc_add_shape(shapes, arcs, arc_count, nullptr, &error) ||
        narc_find_contacts(shapes, &bodies, &pairs, nullptr, &contact, 1, &contact_count, &error)) {
        std::fprintf(stderr, "narc: %s\n", error.message);
        return 1;
    }
    const bool is_exact = contact_count == 1 && std::fabs(contact.separation + 0.5f) < 1e-5f &&
                          std::fabs(contact.normal_x - 1.0f) < 1e-5f;

    // The same pair, of bodies that it brings along.
    const narc_body two[] = {{0.0, 0.0, 1.0f, 0.0f, 1.0f, 0}, {1.5, 0.0, 1.0f, 0.0f, 1.0f, 0}};
    bodies = narc_view_bodies(two, 2);
    pairs = {};
    pairs.count = 1;
    narc_contact same = {};
    if (narc_find_contacts(shapes, &bodies, &pairs, nullptr, &same, 1, &contact_count, &error) || contact_count != 1 ||
        same.separation != contact.separation)
        return 1;

    const std::vector<Body> none;
    const std::vector<float> numbers = {1, 2};
    if (stride_of(NARC_COLUMN(pair, a)) != sizeof(Pair) || NARC_COLUMN(none, cosine).base ||
        NARC_POSITION_COLUMN(none, x).precision != NARC_FLOAT64 || NARC_ARRAY(numbers).base != numbers.data())
        return 1;
    narc_destroy_shapes(shapes);
    std::printf("narc %s, separation %g, normal x %g\n", narc_version(), contact.separation, contact.normal_x);
    return is_exact ? 0 : 1;
}
