// SPDX-License-Identifier: MIT
//
// engine.cpp - a C++ engine's loop by narc.hpp: its own structures through columns, its own threads, contacts that stay
// from step to step, and a solver that starts with the impulses of the last one. world.c is a larger world, in C.
//   c++ -std=c++17 -pthread engine.cpp -o engine $(pkg-config --cflags --libs narc)
#include <narc.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <thread>

namespace {

using Vec = std::complex<float>;
float dot(Vec a, Vec b) { return a.real() * b.real() + a.imag() * b.imag(); }
float cross(Vec a, Vec b) { return a.real() * b.imag() - a.imag() * b.real(); }
Vec quarter_turn(Vec a) { return {-a.imag(), a.real()}; }

struct Position {
    double x, y; // far from the origin too: narc subtracts positions before it rounds
};
struct Rotation {
    float cosine, sine;
};
struct Entity {
    uint64_t id; // what its pairs are known by, whatever its place in the array
    uint32_t shape;
    Position position;
    Rotation rotation = {1, 0};
    float inverse_mass = 0, inverse_inertia = 0; // of what never moves
    Vec velocity = 0;
    float spin = 0;
};

struct Point {
    uint32_t feature;
    float normal_impulse, tangent_impulse;
    Vec anchor_a, anchor_b;
};
struct Pair { // narc keeps it as long as its bodies are near each other; zeros at first
    Entity *a, *b;
    const narc_manifold *manifold;
    Vec normal;
    Point points[2];
};

// The threads of the engine, which may as well be those of a pool: returns when all tasks have ended.
const auto run_tasks = [](unsigned count, const auto &task) {
    std::vector<std::thread> threads;
    for (unsigned index = 0; index < count; index++)
        threads.emplace_back(task, index);
    for (std::thread &thread : threads)
        thread.join();
};

// ------------------------------------------------------------------------------------------------ a solver

void push(const Pair &c, const Point &p, Vec impulse) {
    c.a->velocity -= c.a->inverse_mass * impulse;
    c.a->spin -= c.a->inverse_inertia * cross(p.anchor_a, impulse);
    c.b->velocity += c.b->inverse_mass * impulse;
    c.b->spin += c.b->inverse_inertia * cross(p.anchor_b, impulse);
}
// Pushes along a direction towards a speed of B's point against A's, with an impulse in all between `least` and `most`.
void drive(const Pair &c, const Point &p, Vec direction, float speed, float least, float most, float &impulse) {
    const float arm_a = cross(p.anchor_a, direction), arm_b = cross(p.anchor_b, direction);
    const float inverse_mass = c.a->inverse_mass + c.b->inverse_mass + c.a->inverse_inertia * arm_a * arm_a +
                               c.b->inverse_inertia * arm_b * arm_b;
    const float now = dot(c.b->velocity - c.a->velocity, direction) + c.b->spin * arm_b - c.a->spin * arm_a;
    const float before = impulse;
    impulse = std::clamp(before + (speed - now) / inverse_mass, least, most);
    push(c, p, (impulse - before) * direction);
}
// Friction 0.6; a gap may close within the step, and of an overlap of more than 5 mm a fifth goes.
void solve(Pair &c, uint32_t i, float time) {
    Point &p = c.points[i];
    const float limit = 0.6f * p.normal_impulse, separation = c.manifold->point[i].separation;
    drive(c, p, quarter_turn(c.normal), 0, -limit, limit, p.tangent_impulse);
    const float change = separation > 0 ? separation : 0.2f * std::min(0.0f, separation + 0.005f);
    drive(c, p, c.normal, -change / time, 0, INFINITY, p.normal_impulse);
}

// ------------------------------------------------------------------------------------------------ the world

// What is wrong throws narc::exception: value() does, where there is none.
class World {
  public:
    std::vector<Entity> entities; // which come and go in any way

    void add(const narc::outline &outline, Position position, bool moves = true) {
        narc_mass mass;
        narc_compute_mass(outline.data(), outline.size(), &mass);
        Entity entity = {++last_id, shapes.add(outline).value(), position};
        if (moves) {
            entity.inverse_mass = static_cast<float>(1 / mass.area);
            entity.inverse_inertia = static_cast<float>(1 / mass.second_moment);
        }
        entities.push_back(entity);
    }
    void step(float time) {
        find_contacts();
        for (Entity &entity : entities)
            entity.velocity -= Vec(0, entity.inverse_mass == 0 ? 0 : 9.81f * time);
        const narc::span<const uint32_t> touching(result->touching, result->touching_count);
        for (const uint32_t slot : touching)
            start(slot);
        for (int round = 0; round < 12; round++)
            for (const uint32_t slot : touching)
                for (uint32_t i = 0; i < result->manifolds[slot].count; i++)
                    solve(pair_of(slot), i, time);
        for (Entity &entity : entities) {
            const Vec r = Vec(entity.rotation.cosine, entity.rotation.sine) * Vec(1, time * entity.spin);
            entity.rotation = {r.real() / std::abs(r), r.imag() / std::abs(r)};
            entity.position.x += static_cast<double>(time * entity.velocity.real());
            entity.position.y += static_cast<double>(time * entity.velocity.imag());
        }
    }

  private:
    void find_contacts() {
        const narc_bodies bodies = narc::bodies_of(entities, &Entity::position, &Entity::rotation, &Entity::shape);
        const narc_workers workers = narc::workers_of(2, run_tasks);
        auto step = narc::step().margin(0.02f).skin(0.05f).id(narc::column(entities, &Entity::id)).workers(workers);
        result = contacts.update(shapes, bodies, step).value();
        for (size_t k = 0; k < result->ended_count; k++) {
            const narc_touch_event &ended = result->ended[k];
            pair_of(ended.slot) = {}; // who is apart keeps nothing
            if (ended.parted)
                std::printf("%d and %d part\n", static_cast<int>(ended.id_a), static_cast<int>(ended.id_b));
        }
        if (result->skipped > 0)
            narc::validate(shapes, bodies).value(); // throws: names the broken body
    }
    Pair &pair_of(uint32_t slot) { return static_cast<Pair *>(result->user)[slot]; }

    // A point starts with the impulses of the point of the last step where the same features touched; but not where the
    // pair's bodies stand in the other order than then.
    void start(uint32_t slot) {
        Pair &c = pair_of(slot);
        const narc_manifold &m = result->manifolds[slot];
        const Point last[2] = {c.points[0], c.points[1]};
        c.a = &entities[result->pairs.a.base[slot]];
        c.b = &entities[result->pairs.b.base[slot]];
        c.manifold = &m;
        c.normal = {m.normal_x, m.normal_y};
        const Vec to_a(static_cast<float>(c.a->position.x - c.b->position.x),
                       static_cast<float>(c.a->position.y - c.b->position.y));
        for (uint32_t i = 0; i < 2; i++) {
            Point &p = c.points[i];
            const Point &same = last[last[0].feature == m.point[i].feature ? 0 : 1];
            const bool warm = same.feature == m.point[i].feature && !(result->state[slot] & NARC_TURNED);
            p = warm && i < m.count ? same : Point{};
            p.feature = m.point[i].feature;
            p.anchor_a = {m.point[i].x, m.point[i].y}; // narc's points count from A's position
            p.anchor_b = p.anchor_a + to_a;
            push(c, p, Vec(p.normal_impulse, p.tangent_impulse) * c.normal);
        }
    }

    narc::shapes shapes;
    narc::contacts contacts = narc::contacts::make(NARC_MANIFOLD_ROWS, sizeof(Pair)).value();
    const narc_step_result *result = nullptr; // the contacts', until the next step
    uint64_t last_id = 0;
};

} // namespace

// A stack of crates comes to rest, one is taken out from between the others, and they come to rest again.
int main() try {
    World world;
    const double far = 1e9;
    world.add(narc::box(20, 2).value(), {far, -1}, false);
    for (int k = 0; k < 5; k++)
        world.add(narc::box(1, 1, 0.05).value(), {far + 0.02 * k, 0.5 + k});
    for (int step = 0; step < 360; step++) {
        if (step == 120) { // the last one takes its place
            world.entities[2] = world.entities.back();
            world.entities.pop_back();
        }
        world.step(1 / 60.0f);
    }
    for (const Entity &entity : world.entities)
        std::printf("%d: height %.2f, speed %.1f\n", static_cast<int>(entity.id), entity.position.y,
                    static_cast<double>(std::abs(entity.velocity)));
} catch (const narc::exception &problem) {
    std::fprintf(stderr, "engine: %s\n", problem.what());
    return 1;
}
