// SPDX-License-Identifier: MIT
//
// consumer.cpp - the header for C++: two boxes, one contact, an engine's own array of structures.
#include <narc.hpp>

#include <cmath>
#include <cstdio>

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
} // namespace

int main() {
    narc::shapes shapes;
    const auto box = shapes.add(narc::box(2, 2, 0.25));
    const std::vector<Body> body = {{0, 0, 1, 0, 0}, {1.5, 0, 1, 0, 0}};
    const narc_bodies bodies = narc::bodies_of(body, &Body::x, &Body::y, &Body::cosine, &Body::sine, &Body::shape);
    const narc_pairs pairs = narc::pairs_of(pair, &Pair::a, &Pair::b);
    std::vector<narc_contact> rows, same;
    const auto found = narc::find_contacts(shapes, bodies, pairs, narc::query(), rows);
    if (!box || !found) {
        std::fprintf(stderr, "narc: %s\n", box ? found.error().message : box.error().message);
        return 1;
    }
    // The same pair, of bodies that it brings along; the column of C's macros.
    const narc_body two[] = {narc::body(0, 0, box.value()), narc::body(1.5, 0, box.value())};
    if (found.value().size() != 1 || pairs.a.base != first_of_pair.base || pairs.a.stride != first_of_pair.stride ||
        !narc::find_contacts(shapes, narc::bodies_of(two), narc::pairs_of(1), narc::query(), same) ||
        same[0].separation != rows[0].separation)
        return 1;
    std::printf("narc %s, separation %g, normal x %g\n", narc_version(), rows[0].separation, rows[0].normal_x);
    return std::fabs(rows[0].separation + 0.5f) < 1e-5f && std::fabs(rows[0].normal_x - 1.0f) < 1e-5f ? 0 : 1;
}
