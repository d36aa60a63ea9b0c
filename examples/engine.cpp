// SPDX-License-Identifier: MIT
//
// engine.cpp - narc from C++: an engine's own structures through columns, nothing copied, and its own threads.
//   c++ -std=c++17 engine.cpp $(pkg-config --cflags --libs narc)
#include <narc.h>

#include <cstdio>
#include <future>
#include <vector>

namespace {
struct Transform {
    double x, y; // far from the origin too: narc subtracts positions before it rounds
    float cosine, sine;
};
struct Entity {
    const char *name;
    Transform transform;
    uint32_t shape;
};
struct Candidate { // from the engine's own broad phase
    float priority;
    uint32_t a, b;
};
struct Touch {
    uint32_t candidate;
    float separation, normal_x, normal_y;
};

// One job: some of the candidates, in the thread that it runs on.
std::vector<Touch> find_touches(const narc_shapes *shapes, const narc_bodies &bodies, const narc_pairs &pairs,
                                size_t first, size_t count) {
    std::vector<uint32_t> pair(count);
    std::vector<float> separation(count), normal_x(count), normal_y(count);
    narc_manifolds found = {}; // arrays that stay NULL are not written
    found.capacity = count;
    found.pair = pair.data();
    found.separation[0] = separation.data();
    found.normal_x = normal_x.data();
    found.normal_y = normal_y.data();
    size_t found_count = 0;
    std::vector<Touch> touches;
    if (narc_find_manifolds_range(shapes, &bodies, &pairs, first, count, nullptr, &found, &found_count, nullptr))
        return touches;
    for (size_t k = 0; k < found_count; k++)
        touches.push_back({pair[k], separation[k], normal_x[k], normal_y[k]});
    return touches;
}
} // namespace

int main() {
    narc_shapes *shapes = nullptr;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count = 0;
    if (narc_create_shapes(nullptr, &shapes) || narc_build_box(2, 2, 0.25, arcs, &arc_count, nullptr) ||
        narc_add_shape(shapes, arcs, arc_count, nullptr, nullptr))
        return 1;
    const double far = 1e9;
    const std::vector<Entity> entities = {
        {"crate", {far, 0, 1, 0}, 0}, {"door", {far + 1.75, 0.5, 1, 0}, 0}, {"cloud", {far, 9, 1, 0}, 0}};
    const std::vector<Candidate> candidates = {{1, 0, 1}, {2, 0, 2}, {3, 1, 2}};

    narc_bodies bodies = {};
    bodies.count = entities.size();
    bodies.x = NARC_POSITION_COLUMN(entities, transform.x);
    bodies.y = NARC_POSITION_COLUMN(entities, transform.y);
    bodies.cosine = NARC_COLUMN(entities, transform.cosine);
    bodies.sine = NARC_COLUMN(entities, transform.sine);
    bodies.shape = NARC_COLUMN(entities, shape);
    narc_pairs pairs = {};
    pairs.count = candidates.size();
    pairs.a = NARC_COLUMN(candidates, a);
    pairs.b = NARC_COLUMN(candidates, b);

    auto first_half = std::async(std::launch::async, find_touches, shapes, bodies, pairs, size_t(0), size_t(2));
    auto second_half = std::async(std::launch::async, find_touches, shapes, bodies, pairs, size_t(2), size_t(1));
    for (auto *half : {&first_half, &second_half})
        for (const Touch &t : half->get())
            std::printf("%s and %s: separation %g, normal %g %g\n", entities[candidates[t.candidate].a].name,
                        entities[candidates[t.candidate].b].name, t.separation, t.normal_x, t.normal_y);
    narc_destroy_shapes(shapes);
}
