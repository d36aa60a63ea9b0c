// SPDX-License-Identifier: MIT
//
// engine.cpp - narc from C++: an engine's own structures through columns, nothing copied, and its own threads.
//   c++ -std=c++17 engine.cpp $(pkg-config --cflags --libs narc)
#include <narc.h>

#include <cstdio>
#include <thread>
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

// Tasks for the threads of the engine, which may as well be those of a pool: narc waits until all have ended.
void run_tasks(void *, unsigned count, void (*task)(void *argument, unsigned index), void *argument) {
    std::vector<std::thread> threads;
    for (unsigned index = 0; index < count; index++)
        threads.emplace_back(task, argument, index);
    for (std::thread &thread : threads)
        thread.join();
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

    narc_workers workers = {};
    workers.count = 4;
    workers.run = run_tasks;
    narc_query query = {};
    query.workers = &workers;
    std::vector<narc_manifold> manifolds(candidates.size());
    size_t found = 0;
    if (narc_find_manifolds(shapes, &bodies, &pairs, &query, manifolds.data(), manifolds.size(), &found, nullptr))
        return 1;
    manifolds.resize(found);
    for (const narc_manifold &m : manifolds)
        std::printf("%s and %s: separation %g, normal %g %g\n", entities[candidates[m.pair].a].name,
                    entities[candidates[m.pair].b].name, m.point[0].separation, m.normal_x, m.normal_y);
    narc_destroy_shapes(shapes);
}
