// SPDX-License-Identifier: MIT
//
// cpp.cpp - narc.hpp: every part of it, with the answers of the functions in C, in empty containers and after moves.
#include <narc.hpp>
#include <narc_chains.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#if __has_include(<span>)
#include <span>
#endif

#define CHECK(condition) check(static_cast<bool>(condition), #condition, __LINE__)

namespace {

void check(bool holds, const char *condition, int line) {
    if (!holds) {
        std::fprintf(stderr, "cpp.cpp:%d: %s\n", line, condition);
        std::exit(1);
    }
}

struct Vector {
    double x, y;
};
struct Rotation {
    float c, s;
};
struct Pose {
    Vector position;
    Rotation rotation;
};
struct Entity {
    char name[12];
    float scale;
    Pose pose;
    Vector position;
    Rotation rotation;
    uint32_t shape;
    float motion;
    bool is_static;
};
struct Flat {
    float x, y, cosine, sine;
    uint32_t shape;
};
struct Words {
    float cosine, sine;
};
struct Named {
    Vector position;
    Words rotation;
    uint32_t shape;
};
struct Pair {
    uint32_t a, b;
    float margin;
};
// A row within what a solver keeps of a pair.
struct Slot {
    double impulse;
    narc_manifold manifold;
    narc_contact contact;
    uint32_t age;
};

narc_status status_of(const narc::result<void> &result) { return result.error().status; }

template <class Row> bool same(const Row &a, const Row &b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same(const narc_float_column &a, const narc_float_column &b) { return a.base == b.base && a.stride == b.stride; }
bool same(const narc_index_column &a, const narc_index_column &b) { return a.base == b.base && a.stride == b.stride; }
bool same(const narc_position_column &a, const narc_position_column &b) {
    return a.base == b.base && a.stride == b.stride && a.precision == b.precision;
}
bool same(const narc_bodies &a, const narc_bodies &b) {
    return a.count == b.count && same(a.x, b.x) && same(a.y, b.y) && same(a.cosine, b.cosine) && same(a.sine, b.sine) &&
           same(a.scale, b.scale) && same(a.shape, b.shape);
}

// A few bodies of a box and a circle in a row, each turned a little; every one touches the next.
struct Scene {
    narc::shapes shapes;
    std::vector<Entity> entities;
    std::vector<Pair> pairs;
    narc_bodies bodies = {};
    narc_pairs batch = {};
};

Scene make_scene(uint32_t count) {
    Scene scene;
    const uint32_t box = scene.shapes.add(narc::box(1, 1, 0.05)).value();
    const uint32_t circle = scene.shapes.add(narc::circle(0.5)).value();
    for (uint32_t k = 0; k < count; k++) {
        Entity entity = {};
        const float angle = 0.1f * static_cast<float>(k);
        entity.scale = 1;
        entity.position = {0.98 * k, 0.01 * k};
        entity.rotation = {std::cos(angle), std::sin(angle)};
        entity.pose = {entity.position, entity.rotation};
        entity.shape = k % 3 == 2 ? circle : box;
        scene.entities.push_back(entity);
        if (k > 0)
            scene.pairs.push_back({k - 1, k, 0.5f});
    }
    scene.bodies = narc::bodies_of(scene.entities, &Entity::position, &Entity::rotation, &Entity::shape);
    scene.batch = narc::pairs_of(scene.pairs, &Pair::a, &Pair::b);
    return scene;
}

// ---------------------------------------------------------------------------- spans and columns

void test_spans() {
    std::vector<int> numbers = {1, 2, 3};
    const std::vector<int> constant = {4, 5};
    std::array<int, 4> array = {6, 7, 8, 9};
    int plain[] = {1, 2};
    const narc::span<const int> of_vector(numbers), of_constant(constant), of_array(array), of_plain(plain),
        of_pointer(plain, 1), none;
    CHECK(of_vector.size() == 3 && of_vector.data() == numbers.data() && of_vector[2] == 3);
    CHECK(of_constant.size() == 2 && of_array.size() == 4 && of_plain.size() == 2 && of_pointer.size() == 1);
    CHECK(none.empty() && none.begin() == none.end() && none.first(3).empty());
    CHECK(of_vector.first(2).size() == 2 && of_vector.first(7).size() == 3);
    const narc::span<int> writes(numbers);
    const narc::span<const int> reads = writes;
    writes[0] = 10;
    int sum = 0;
    for (const int number : reads)
        sum += number;
    CHECK(sum == 15);
    static_assert(!std::is_convertible_v<std::vector<double> &, narc::span<const float>>, "of another type");
    static_assert(!std::is_convertible_v<const std::vector<int> &, narc::span<int>>, "not to be written");
    static_assert(!std::is_constructible_v<narc::span<narc_query>, narc::span<narc::query>>, "of another size");
#ifdef __cpp_lib_span
    const std::span<int> standard = writes;
    const narc::span<const int> back = standard;
    CHECK(standard.size() == 3 && back.data() == numbers.data() && back.size() == 3);
#endif
}

void test_columns() {
    std::vector<Entity> entities(3);
    const std::vector<Entity> &constant = entities;
    const narc_float_column scale = narc::column(constant, &Entity::scale);
    CHECK(scale.base == &entities[0].scale && scale.stride == sizeof(Entity));
    const narc_float_column cosine = narc::column(entities, &Entity::pose, &Pose::rotation, &Rotation::c);
    CHECK(cosine.base == &entities[0].pose.rotation.c && cosine.stride == sizeof(Entity));
    const narc_byte_column kind = narc::column(entities, &Entity::is_static);
    CHECK(static_cast<const void *>(kind.base) == &entities[0].is_static);
    const narc_position_column x = narc::positions(
        entities, [](const Entity &e) -> auto & { return e.position.x; });
    CHECK(x.base == &entities[0].position.x && x.precision == NARC_FLOAT64);
    const float floats[] = {1, 2};
    CHECK(narc::positions(floats).precision == NARC_FLOAT32 && narc::column(floats).stride == sizeof(float));
    const std::array<uint64_t, 2> words = {1, 2};
    CHECK(narc::column(words).base == words.data());
    const std::vector<uint32_t> indices(2);
    CHECK(narc::column(indices).base == indices.data() &&
          narc::column(narc::span<const uint32_t>(indices)).stride == 4);

    const std::vector<Entity> nobody;
    CHECK(!narc::column(nobody, &Entity::pose, &Pose::rotation, &Rotation::c).base);
    CHECK(narc::positions(nobody, &Entity::position, &Vector::y).precision == NARC_FLOAT64);
    CHECK(!narc::column(std::vector<Pair>(), &Pair::margin).base);
}

void test_bodies() {
    const std::vector<Entity> entities(3);
    narc_bodies expected = {};
    expected.count = 3;
    expected.x = NARC_POSITION_COLUMN(entities, position.x);
    expected.y = NARC_POSITION_COLUMN(entities, position.y);
    expected.cosine = NARC_COLUMN(entities, rotation.c);
    expected.sine = NARC_COLUMN(entities, rotation.s);
    expected.shape = NARC_COLUMN(entities, shape);
    CHECK(same(narc::bodies_of(entities, &Entity::position, &Entity::rotation, &Entity::shape), expected));

    const Flat flat[2] = {};
    narc_bodies bodies = narc::bodies_of(flat, &Flat::x, &Flat::y, &Flat::cosine, &Flat::sine, &Flat::shape);
    CHECK(bodies.count == 2 && bodies.x.base == &flat[0].x && bodies.x.precision == NARC_FLOAT32);
    CHECK(bodies.sine.base == &flat[0].sine && bodies.shape.base == &flat[0].shape && !bodies.scale.base);
    const std::array<Named, 2> named = {};
    bodies = narc::bodies_of(named, &Named::position, &Named::rotation, &Named::shape);
    CHECK(bodies.cosine.base == &named[0].rotation.cosine && bodies.sine.base == &named[0].rotation.sine);

    const narc_body rows[] = {narc::body(1, 2, 3), narc::body(4, 5, 6, 0, 1, 2)};
    CHECK(rows[0].cosine == 1 && rows[0].sine == 0 && rows[0].scale == 1 && rows[0].shape == 3 && rows[0].y == 2);
    CHECK(rows[1].cosine == 0 && rows[1].sine == 1 && rows[1].scale == 2);
    narc_view_bodies(rows, 2, &bodies);
    CHECK(same(narc::bodies_of(rows), bodies));
    CHECK(narc::bodies_of(std::vector<narc_body>()).count == 0 && narc::pairs_of(7).count == 7);
}

// ---------------------------------------------------------------------------- shapes

bool same_arcs(const narc::result<narc::outline> &made, const narc_arc *arcs, size_t count) {
    return made && made.value().size() == count && std::memcmp(made.value().data(), arcs, count * sizeof *arcs) == 0;
}

void test_builders() {
    narc_arc a[NARC_MAX_ARCS];
    size_t n = 0;
    const std::vector<narc_point> square = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
    const narc_point *p = square.data();
    CHECK(!narc_build_circle(2, a, &n, nullptr) && same_arcs(narc::circle(2), a, n));
    CHECK(!narc_build_capsule(3, 2, a, &n, nullptr) && same_arcs(narc::capsule(3, 2), a, n));
    CHECK(!narc_build_segment(&p[0], &p[2], 0, a, &n, nullptr) && same_arcs(narc::segment(p[0], p[2]), a, n));
    CHECK(!narc_build_box(3, 2, 0.5, a, &n, nullptr) && same_arcs(narc::box(3, 2, 0.5), a, n));
    CHECK(!narc_build_polygon(p, 4, 0.1, a, &n, nullptr) && same_arcs(narc::polygon(square, 0.1), a, n));
    CHECK(!narc_build_skin_polygon(p, 4, 0.1, a, &n, nullptr) && same_arcs(narc::skin_polygon(square, 0.1), a, n));
    CHECK(!narc_build_regular_polygon(5, 2, 0.1, a, &n, nullptr) && same_arcs(narc::regular_polygon(5, 2, 0.1), a, n));
    CHECK(!narc_build_ellipse(2, 1, 8, a, &n, nullptr, nullptr) && same_arcs(narc::ellipse(2, 1, 8), a, n));
    const narc_four_arc lens = {5, 5, 8, 0.25, 0.25};
    CHECK(!narc_build_four_arc(&lens, a, &n, nullptr) && same_arcs(narc::four_arc(lens), a, n));
    CHECK(!narc_build_points(p, 4, 0, a, &n, nullptr) && same_arcs(narc::through_points(square), a, n));
    CHECK(!narc_build_ring(p, 4, a, &n, nullptr) && same_arcs(narc::ring(square), a, n));
    CHECK(same_arcs(narc::build(narc_build_ring, p, 4u), a, n));
    CHECK(narc::validate(narc::box(1, 1).value()));

    narc_error error;
    const auto bad = narc::box(1, 1, 2);
    CHECK(narc_build_box(1, 1, 2, a, &n, &error) == NARC_ERROR_RADIUS);
    CHECK(!bad && status_of(bad) == NARC_ERROR_RADIUS && std::string(bad.error().message) == error.message);
    CHECK(status_of(narc::polygon({})) != NARC_OK && status_of(narc::validate(narc::arcs())) != NARC_OK);
}

void test_shapes() {
    narc::shapes shapes;
    const uint32_t box = shapes.add(narc::box(1, 1)).value();
    const narc::outline circle = narc::circle(2).value();
    CHECK(shapes.add(circle).value() != box && shapes.size() == 2 && shapes[1].size() == 1 && shapes[9].size() == 0);
    CHECK(shapes.add(narc::box(1, 1)).value() == box && narc_count_uses(shapes, box) == 2);
    CHECK(status_of(shapes.replace(box, circle)) == NARC_ERROR_IN_USE && shapes.remove(box));
    CHECK(shapes.replace(box, narc::capsule(1, 1).value()) && shapes[box].size() == 2);
    CHECK(shapes.add_at(7, circle) && status_of(shapes.add_at(7, circle)) == NARC_ERROR_IN_USE && shapes.size() == 8);
    CHECK(status_of(shapes.remove(5)) == NARC_ERROR_INDEX);
    CHECK(status_of(shapes.add(narc::box(1, 1, 2))) == NARC_ERROR_RADIUS);
    CHECK(status_of(shapes.add(std::vector<narc_arc>())) != NARC_OK);

    std::vector<unsigned char> bytes(narc_count_saved_bytes(shapes));
    CHECK(narc_save_shapes(shapes, bytes.data(), bytes.size(), nullptr) == NARC_OK);
    narc::shapes loaded = narc::shapes::load(bytes.data(), bytes.size()).value();
    CHECK(loaded.size() == 8);
    bytes[bytes.size() / 2] ^= 1;
    CHECK(status_of(narc::shapes::load(bytes.data(), bytes.size())) == NARC_ERROR_FORMAT);

    narc::shapes moved = std::move(shapes);
    CHECK(moved.size() == 8 && static_cast<narc_shapes *>(moved));
    loaded = std::move(moved);
    CHECK(loaded.size() == 8);
    // What was moved from is a store that is not there.
    CHECK(!moved.get() && moved.size() == 0 && moved[0].size() == 0);                         // NOLINT
    CHECK(status_of(moved.add(circle)) == NARC_ERROR_ARGUMENT && !narc::validate(moved, {})); // NOLINT
    moved = narc::shapes();
    CHECK(moved.add(circle));
    static_assert(!std::is_copy_constructible_v<narc::shapes> && !std::is_copy_assignable_v<narc::shapes>, "owners");
    static_assert(std::is_nothrow_move_constructible_v<narc::broad_phase>, "owners");
    static_assert(std::is_nothrow_move_constructible_v<narc::index>, "owners");

    narc_shapes *raw = nullptr;
    CHECK(narc_create_shapes(nullptr, &raw) == NARC_OK);
    const narc::shapes adopted(raw);
    CHECK(adopted.get() == raw && static_cast<const narc_shapes *>(adopted) == raw);
    const narc_allocator never = {[](size_t, void *) -> void * { return nullptr; }, [](void *, void *) {}, nullptr};
    narc::shapes without(&never);
    CHECK(!without.get() && status_of(without.add(circle)) == NARC_ERROR_ARGUMENT);
}

// ---------------------------------------------------------------------------- queries

void test_query() {
    size_t skipped = 0;
    narc_workers workers;
    narc_openmp_workers(2, &workers);
    const float margins[] = {1, 2};
    const uint32_t selection[] = {0, 1};
    const narc::query q = narc::query()
                              .margin(1)
                              .margins(narc::column(margins))
                              .second_margin(2)
                              .flat_angle(0.25f)
                              .selection(selection)
                              .range(3, 4)
                              .dense()
                              .workers(workers)
                              .skipped(skipped);
    const narc_query &c = q;
    CHECK(c.margin == 1 && c.margins.base == margins && c.second_margin == 2 && c.flat_angle == 0.25f);
    CHECK(c.selection.base == selection && c.selection_count == 2 && c.first == 3 && c.count == 4);
    CHECK(c.dense == 1 && c.workers == &workers && c.out_skipped == &skipped && c.row_stride == 0 && !c.reserved[0]);
    const narc_query zero = {};
    CHECK(same<narc_query>(narc::query(), zero));
}

void test_contacts() {
    Scene scene = make_scene(20);
    const size_t n = scene.pairs.size();
    std::vector<narc_contact> expected(n), rows;
    std::vector<narc_manifold> expected_manifolds(n), manifolds;
    size_t found = 0, manifolds_found = 0;
    const narc_query plain = {};
    CHECK(!narc_find_contacts(scene.shapes, &scene.bodies, &scene.batch, &plain, expected.data(), n, &found, nullptr));
    CHECK(!narc_find_manifolds(scene.shapes, &scene.bodies, &scene.batch, &plain, expected_manifolds.data(), n,
                               &manifolds_found, nullptr));
    CHECK(found > 5 && manifolds_found == found && narc::validate(scene.shapes, scene.bodies));

    // A vector grows to its rows, and never shrinks.
    const auto in_vector = narc::find_contacts(scene.shapes, scene.bodies, scene.batch, {}, rows).value();
    CHECK(in_vector.size() == found && in_vector.data() == rows.data() && rows.size() == n);
    CHECK(std::memcmp(rows.data(), expected.data(), found * sizeof rows[0]) == 0);
    rows.resize(2 * n);
    CHECK(narc::find_contacts(scene.shapes, scene.bodies, scene.batch, narc::query(), rows).value().size() == found);
    std::vector<narc_refined_contact> refined;
    const narc::span<const narc_contact> contacts(rows.data(), found);
    CHECK(narc::refine_contacts(scene.shapes, scene.bodies, scene.batch, {}, contacts, refined));
    CHECK(refined.size() == found && std::fabs(refined[0].separation - static_cast<double>(rows[0].separation)) < 1e-6);
    CHECK(rows.size() == 2 * n);
    const auto points = narc::find_manifolds(scene.shapes, scene.bodies, scene.batch, narc::query(), manifolds).value();
    CHECK(points.size() == found && same(points[found - 1], expected_manifolds[found - 1]));
    size_t counted = 0;
    for (const narc_manifold &m : narc::find_manifolds(scene.shapes, scene.bodies, scene.batch, {}, manifolds).value())
        counted += m.count > 0;
    CHECK(counted == found);

    // Rows in arrays, in spans of the right and of a wrong length, in larger structures.
    narc_contact array[32];
    CHECK(narc::find_contacts(scene.shapes, scene.bodies, scene.batch, narc::query(), array).value().size() == found);
    CHECK(same(array[found - 1], expected[found - 1]));
    const auto two = narc::find_contacts(scene.shapes, scene.bodies, scene.batch, {}, narc::span(array, 2));
    CHECK(!two && status_of(two) == NARC_ERROR_CAPACITY && two.error().value == static_cast<double>(found));
    std::vector<Slot> slots;
    const auto kept = narc::find_contacts(scene.shapes, scene.bodies, scene.batch, {}, slots, &Slot::contact).value();
    CHECK(kept.size() == found && slots.size() == n);
    for (size_t k = 0; k < found; k++)
        CHECK(same(kept[k].contact, expected[k]) && kept[k].impulse == 0 && kept[k].age == 0);
    CHECK(narc::find_manifolds(scene.shapes, scene.bodies, scene.batch, {}, slots, &Slot::manifold).value().size() ==
          found);
    for (size_t k = 0; k < found; k++)
        CHECK(same(slots[k].manifold, expected_manifolds[k]) && same(slots[k].contact, expected[k]));

    // Margins, a selection, dense rows.
    const uint32_t selection[] = {4, 2};
    size_t skipped = 9;
    narc::query query = narc::query().margins(narc::column(scene.pairs, &Pair::margin)).skipped(skipped);
    query.selection(selection);
    const auto chosen = narc::find_contacts(scene.shapes, scene.bodies, scene.batch, query, rows).value();
    CHECK(chosen.size() == 2 && chosen[0].pair == 4 && chosen[1].pair == 2 && skipped == 0);
    query.dense();
    std::vector<narc_contact> dense;
    CHECK(narc::find_contacts(scene.shapes, scene.bodies, scene.batch, query, dense).value().size() == n);
    CHECK(dense[2].pair == 2 && dense[2].count == 1 && dense[3].count == 0);
    const auto all = narc::query().dense().margin(0.5f);
    CHECK(narc::find_contacts(scene.shapes, scene.bodies, scene.batch, all, dense).value().size() == n);
    const auto none = narc::query().selection(std::vector<uint32_t>());
    CHECK(narc::find_contacts(scene.shapes, scene.bodies, scene.batch, none, rows).value().empty());
    const auto part = narc::query().range(3, 4).margin(0.5f);
    CHECK(narc::find_contacts(scene.shapes, scene.bodies, scene.batch, part, rows).value()[0].pair == 3);
}

void test_overlaps() {
    const Scene scene = make_scene(100);
    std::vector<uint64_t> bits;
    uint64_t expected[2], array[1];
    CHECK(!narc_find_overlaps(scene.shapes, &scene.bodies, &scene.batch, nullptr, expected, nullptr));
    CHECK(narc::find_overlaps(scene.shapes, scene.bodies, scene.batch, narc::query(), bits) && bits.size() == 2);
    CHECK(bits[0] == expected[0] && bits[1] == expected[1] && bits[0] != 0);
    const auto short_by_one = narc::find_overlaps(scene.shapes, scene.bodies, scene.batch, narc::query(), array);
    CHECK(status_of(short_by_one) == NARC_ERROR_CAPACITY && short_by_one.error().value == 2);
    const uint32_t one[] = {5};
    CHECK(narc::find_overlaps(scene.shapes, scene.bodies, scene.batch, narc::query().selection(one), array));
    CHECK(array[0] == (bits[0] >> 5 & 1));
    CHECK(narc::find_overlaps(scene.shapes, scene.bodies, scene.batch,
                              narc::query().selection(narc::span<const uint32_t>()), narc::span<uint64_t>()));
}

void test_separations() {
    const Scene scene = make_scene(100);
    const auto query = narc::query().margin(INFINITY);
    std::vector<float> separations;
    std::vector<narc_contact> contacts;
    float few[1];
    narc_query strided = query;
    strided.row_stride = sizeof(narc_contact); // left over from contacts
    CHECK(narc::find_separations(scene.shapes, scene.bodies, scene.batch, strided, separations));
    const auto found = narc::find_contacts(scene.shapes, scene.bodies, scene.batch, query, contacts).value();
    CHECK(separations.size() == found.size());
    for (size_t k = 0; k < found.size(); k++)
        CHECK(separations[k] <= found[k].separation && separations[k] >= found[k].separation);
    const auto short_by_one = narc::find_separations(scene.shapes, scene.bodies, scene.batch, query, few);
    CHECK(status_of(short_by_one) == NARC_ERROR_CAPACITY &&
          short_by_one.error().value == static_cast<double>(found.size()));
}

void test_small_batches() {
    const Scene scene = make_scene(2);
    // Nothing at all.
    const std::vector<Entity> nobody;
    const std::vector<Pair> nothing;
    std::vector<narc_contact> rows;
    std::vector<narc_manifold> manifolds;
    std::vector<uint64_t> bits;
    const narc_bodies bodies = narc::bodies_of(nobody, &Entity::position, &Entity::rotation, &Entity::shape);
    const narc_pairs pairs = narc::pairs_of(nothing, &Pair::a, &Pair::b);
    CHECK(narc::find_contacts(scene.shapes, bodies, pairs, narc::query(), rows).value().empty());
    CHECK(narc::find_manifolds(scene.shapes, bodies, pairs, narc::query(), manifolds).value().empty());
    CHECK(narc::find_manifolds(scene.shapes, scene.bodies, pairs, narc::query().dense(), manifolds).value().empty());
    CHECK(narc::find_overlaps(scene.shapes, bodies, pairs, narc::query(), bits) &&
          narc::validate(scene.shapes, bodies));
    CHECK(narc::compute_boxes(scene.shapes, bodies, {}) && narc::compute_poses({}, {}, {}));
    // Pairs, but no rows.
    const auto no_rows = narc::find_contacts(scene.shapes, scene.bodies, scene.batch, {}, narc::span<narc_contact>());
    CHECK(status_of(no_rows) == NARC_ERROR_CAPACITY && no_rows.error().value == 1);

    // One pair of bodies of its own.
    const narc_body two[] = {narc::body(0, 0, 0), narc::body(0.75, 0, 0)};
    narc_contact contact[1];
    const auto one = narc::find_contacts(scene.shapes, narc::bodies_of(two), narc::pairs_of(1), {}, contact).value();
    CHECK(one.size() == 1 && std::fabs(one[0].separation + 0.25f) < 1e-6f && one[0].normal_x == 1);
    CHECK(narc::find_contact(scene.shapes, two[0], two[1]).value().separation == one[0].separation);
    CHECK(narc::find_manifold(scene.shapes, two[0], two[1], narc::query().margin(-0.5f)).value().count == 0);
    CHECK(status_of(narc::find_contact(nullptr, two[0], two[1])) == NARC_ERROR_ARGUMENT);

    // Errors: a body that is not there, a store that is not there.
    const Pair wrong[] = {{0, 2, 0}};
    const narc_pairs wrong_pairs = narc::pairs_of(wrong, &Pair::a, &Pair::b);
    CHECK(status_of(narc::find_contacts(scene.shapes, scene.bodies, wrong_pairs, {}, rows)) == NARC_ERROR_INDEX);
    CHECK(status_of(narc::find_overlaps(scene.shapes, scene.bodies, wrong_pairs, {}, bits)) == NARC_ERROR_INDEX);
    CHECK(status_of(narc::find_manifolds(nullptr, scene.bodies, scene.batch, {}, manifolds)) == NARC_ERROR_ARGUMENT);
}

void test_workers() {
    Scene scene = make_scene(20000);
    std::vector<narc_contact> expected, rows;
    const size_t found = narc::find_contacts(scene.shapes, scene.bodies, scene.batch, {}, expected).value().size();
    unsigned tasks = 0;
    auto parallel = [&](unsigned count, auto task) {
        std::vector<std::thread> threads;
        for (unsigned index = 0; index < count; index++)
            threads.emplace_back(task, index);
        for (std::thread &thread : threads)
            thread.join();
        tasks += count;
    };
    const narc_workers workers = narc::workers_of(3, parallel);
    CHECK(workers.count == 3);
    narc::query query;
    query.workers(workers);
    CHECK(narc::find_contacts(scene.shapes, scene.bodies, scene.batch, query, rows).value().size() == found);
    CHECK(tasks > 1 && std::memcmp(rows.data(), expected.data(), found * sizeof rows[0]) == 0);
    // A loop that is constant, from the last to the first.
    const auto backwards = [](unsigned count, const auto &task) {
        while (count > 0)
            task(--count);
    };
    const narc_workers others = narc::workers_of(8, backwards);
    CHECK(narc::find_contacts(scene.shapes, scene.bodies, scene.batch, query.workers(others), rows).value().size() ==
          found);
    CHECK(std::memcmp(rows.data(), expected.data(), found * sizeof rows[0]) == 0);
}

// ---------------------------------------------------------------------------- pairs of a step, poses, sets

void test_broad_phase() {
    Scene scene = make_scene(10);
    narc::broad_phase broad;
    narc_workers workers;
    narc_openmp_workers(1, &workers);
    narc_pair_filter filter = {};
    filter.kind = narc::column(scene.entities, &Entity::is_static);
    std::vector<narc_box> boxes(10);
    CHECK(narc::compute_boxes(scene.shapes, scene.bodies, boxes) && boxes[9].min_x < boxes[9].max_x);
    CHECK(status_of(narc::compute_boxes(scene.shapes, scene.bodies, narc::span(boxes.data(), 9))) ==
          NARC_ERROR_CAPACITY);
    std::vector<uint32_t> a, b(1);
    const size_t count = broad.find_pairs(boxes, a, b, &filter, &workers).value();
    CHECK(count >= 8 && a.size() >= count && b.size() >= count && a[0] < b[0]);
    const size_t all = broad.find_pairs(boxes, a, b).value();
    CHECK(all >= count);
    std::vector<narc_manifold> rows;
    const narc_pairs pairs = {all, narc::column(a), narc::column(b), nullptr, {}, {}, {}};
    CHECK(narc::find_manifolds(scene.shapes, scene.bodies, pairs, {}, rows).value().size() > 3);
    const narc::broad_phase moved = std::move(broad);
    CHECK(moved.get() && !broad.get());                                     // NOLINT
    CHECK(status_of(broad.find_pairs(boxes, a, b)) == NARC_ERROR_ARGUMENT); // NOLINT
    broad = narc::broad_phase();
    CHECK(broad.find_pairs(std::vector<narc_box>(), a, b).value() == 0);
}

void test_contacts_that_stay() {
    Scene scene = make_scene(10);
    narc_pair_filter filter = {};
    filter.kind = narc::column(scene.entities, &Entity::is_static);
    narc_workers workers;
    narc_openmp_workers(1, &workers);
    const std::vector<uint64_t> ids = {9, 8, 7, 6, 5, 4, 3, 2, 1, 0};
    const std::vector<uint32_t> run(10, NARC_NO_RUN), none;
    const narc_float_column motion = narc::column(scene.entities, &Entity::motion);
    auto step = narc::step()
                    .margin(0.02f)
                    .second_margin(0.03f)
                    .flat_angle(0.4f)
                    .front_only()
                    .skin(0.05f)
                    .recycling(0.01f)
                    .motion(motion, motion)
                    .reach(motion)
                    .ahead(motion)
                    .id(narc::column(ids))
                    .run(narc::column(run))
                    .filter(filter)
                    .workers(workers);
    const std::vector<uint32_t> low = {0, 1}, high = {2, 2};
    const narc_pairs pairs = {2, narc::column(low), narc::column(high), nullptr, {}, {}, {}};
    const narc_step &c = step;
    CHECK(c.margin == 0.02f && c.second_margin == 0.03f && c.flat_angle == 0.4f && c.front_only && c.skin == 0.05f);
    CHECK(c.recycling == 0.01f && c.motion_x.base == motion.base && c.motion_y.base == motion.base);
    CHECK(c.reach.base == motion.base && c.ahead.base == motion.base && c.id.base == ids.data());
    CHECK(c.run.base == run.data() && c.filter == &filter && c.workers == &workers && !c.bodies);
    narc::contacts contacts = narc::contacts::make(NARC_MANIFOLD_ROWS, 8).value();
    const narc_step_result *r = contacts.update(scene.shapes, scene.bodies, step).value();
    CHECK(r->count >= 9 && r->touching_count > 3 && r->began_count >= r->touching_count && r->user);
    CHECK(contacts.update(scene.shapes, scene.bodies, step.moved(none)).value()->asked_count == 0);
    CHECK(status_of(contacts.update(scene.shapes, scene.bodies, narc::step().skin(-1))) == NARC_ERROR_ARGUMENT);
    CHECK(status_of(narc::contacts::make(2, 0)) == NARC_ERROR_ARGUMENT);
    CHECK(contacts.update(scene.shapes, scene.bodies, step.pairs(pairs)).value()->count == 2);
    CHECK(c.pairs == &pairs && !c.same_pairs);
    const narc_step_result *kept = contacts.update(scene.shapes, scene.bodies, step.pairs(pairs, true)).value();
    CHECK(c.same_pairs && kept->count == 2 && kept->began_count + kept->ended_count == 0);
    const auto slots = contacts.slots_of(2).value();
    CHECK(slots.size() == 2 && slots[0] == kept->order[0] && slots[1] == kept->order[1]);
    CHECK(status_of(contacts.slots_of(10)) == NARC_ERROR_INDEX);
    const std::vector<char> saved = contacts.save().value();
    CHECK(contacts.forget(std::vector<uint64_t>{9}));
    const narc_step_result *later = contacts.update(scene.shapes, scene.bodies, step).value();
    CHECK(later->state[later->order[0]] & NARC_NEW && !(later->state[later->order[1]] & NARC_NEW));
    CHECK(contacts.load(scene.shapes, saved).value()->count == 2 && contacts.save().value() == saved);
    CHECK(status_of(contacts.load(scene.shapes, narc::span(saved.data(), 9))) == NARC_ERROR_FORMAT);
    narc::contacts plain;
    CHECK(plain.update(scene.shapes, scene.bodies).value()->count > 0);
    CHECK(status_of(plain.load(scene.shapes, saved)) == NARC_ERROR_ARGUMENT);
    plain.forget();
    narc::contacts in_user = narc::contacts::make(NARC_ROWS_IN_USER, sizeof(narc_manifold)).value();
    CHECK(!in_user.update(scene.shapes, scene.bodies).value()->manifolds);
}

// ---------------------------------------------------------------------------- outlines and ground

bool about(double a, double b) { return std::fabs(a - b) < 1e-9; }

void test_outlines() {
    const narc_point corners[] = {{0, 0}, {2, 0}, {2, 1}, {1, 0.5}, {0, 1}, {1, 1}};
    const narc::outline box = narc::hull(corners).value();
    CHECK(box.count == 4 && status_of(narc::hull({corners, 2})) == NARC_ERROR_COUNT);
    CHECK(about(narc::mass(box)->area, 2) && about(*narc::perimeter(box), 6) && !narc::mass({}));
    CHECK(about(narc::aabb(box)->max_x, 2) && about(narc::inscribed_circle(box)->radius, 0.5));
    CHECK(about(narc::bounding_circle(box)->radius, std::sqrt(1.25)));
    CHECK(about(*narc::distance(box, {1, 2}), 1) && narc::contains(box, {1, 0.5}) && !narc::contains(box, {3, 3}));
    CHECK(narc::find_support(box, 1, 1)->point.x == 2 && narc::find_support(box, 1, 1)->arc < 4);
    narc_point centroid;
    const narc::outline centred = narc::center(box, &centroid).value();
    CHECK(about(centroid.x, 1) && about(centroid.y, 0.5) && about(narc::mass(centred)->centroid_x, 0));
    CHECK(about(narc::aabb(narc::mirror(box).value())->min_x, -2));
    const narc::outline moved = narc::move(box, 2, 0, 0, 3).value();
    CHECK(about(narc::aabb(moved)->max_x, 8) && status_of(narc::move(box, 0, 0, 0, -1)) == NARC_ERROR_SIZE);
    std::vector<narc_arc> both(box.arcs, box.arcs + box.count);
    both.insert(both.end(), box.arcs, box.arcs + box.count);
    const size_t counts[] = {4, 4};
    CHECK(about(narc::union_mass(both, counts).value().area, 2));
    const narc_body body = narc::body(10, 0, 0);
    CHECK(narc::flatten(box, true, 0.1).value().size() == 4);
    CHECK(narc::flatten(narc::circle(1).value(), true, 1e-6).value().size() > 1000);
    CHECK(narc::flatten(box, true, 0.1, &body).value()[0].x >= 10);
    CHECK(status_of(narc::flatten(box, true, 0)) == NARC_ERROR_ARGUMENT);
    const narc_point square[] = {{0, 0}, {1, 0}, {1, 1e-9}, {1, 1}, {0, 1}};
    CHECK(narc::weld_polygon(square, 1e-6).value().size() == 4);
    CHECK(narc::adjust_polygon(square).value().size() == 5);
    const narc_point ring[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    CHECK(narc::find_radius_range(ring).value().min < narc::find_radius_range(ring).value().chosen);
    CHECK(std::string(narc::status_name(NARC_OK)) == narc_status_name(NARC_OK) && narc::version() == narc_version());
    CHECK(narc::isa_name(0) && narc::isa_supported(narc::get_isa()) && narc::kernel_name(0) && !narc::cpu_feature(999));
}

void test_ground() {
    narc::shapes shapes;
    CHECK(shapes.reserve(20, 100));
    const narc_arc level[] = {{9, 0, 0, 1.5707963267948966, 1.5707963267948966},
                              {0, 0, 0, 1.5707963267948966, 1.5707963267948966}};
    narc_chain_options options = {};
    options.weld = 0.5; /* more entries than arcs: room is made */
    const auto entries = shapes.add_chain(level, options).value();
    CHECK(entries.size() > 12 && shapes.flags(entries[0].shape) & NARC_SHAPE_RUN);
    CHECK(shapes.uses(entries[1].shape) >= 1 && shapes.aabb(entries[0].shape) && !shapes.aabb(999));
    CHECK(status_of(shapes.add_chain({level, 0})) == NARC_ERROR_COUNT);
    const auto bytes = shapes.save().value();
    CHECK(narc::shapes::load(bytes.data(), bytes.size()).value().size() == shapes.size());
    CHECK(narc::openmp_workers(1).count <= 1);
}

// ---------------------------------------------------------------------------- questions to a scene

void test_index() {
    Scene scene = make_scene(10);
    std::vector<narc_box> boxes(10);
    CHECK(narc::compute_boxes(scene.shapes, scene.bodies, boxes));
    const std::vector<uint64_t> category = {1, 2, 1, 2, 1, 2, 1, 2, 1, 2}, mask = {2};
    const std::vector<uint32_t> ignored = {3};
    narc_workers workers;
    narc_openmp_workers(1, &workers);
    narc::index index;
    const auto options = narc::index_options().category(narc::column(category)).fast().workers(workers);
    const std::vector<uint32_t> world = {0, 1, 0, 1, 0, 1, 0, 1, 0, 1}, asked = {1};
    const auto apart = narc::index_options().world(narc::column(world));
    const narc_index_options &c = options;
    CHECK(c.category.base == category.data() && c.fast == 1 && c.workers == &workers);
    const narc_point far = {1e9, 0};
    std::vector<narc_box> there(10);
    CHECK(narc::compute_boxes(scene.shapes, scene.bodies, there, narc::box_options().origin(far)));
    CHECK(there[0].max_x < -0.99e9f && narc::index_options().origin(far).narc_index_options::origin == &far);
    CHECK(narc::step().origin(far).narc_step::origin == &far);
    std::vector<uint32_t> counts(3);
    const auto counting = narc::step().world_counts(counts);
    CHECK(counting.out_world_count == counts.data() && counting.world_count == 3);
    CHECK(index.build(boxes, options));
    CHECK(index.update(boxes, options) && index.describe().value().bodies == 10);
    const std::vector<uint32_t> changed = {9};
    CHECK(status_of(index.update(narc::span<const narc_box>(boxes.data(), 9), changed)) == NARC_ERROR_INDEX);
    CHECK(index.update(boxes, changed, options) && index.describe().value().boxes == 10);
    CHECK(index.copy_nodes(0, there).value() == index.describe().value().leaves && there[0].min_x <= boxes[3].min_x);
    CHECK(status_of(index.copy_nodes(0, {there.data(), 0})) == NARC_ERROR_CAPACITY);
    CHECK(index.query({&boxes[3], 1}).value().count == 3);
    CHECK(index.build(boxes, apart) && index.query({&boxes[3], 1}).value().count == 3);
    CHECK(index.query({&boxes[3], 1}, narc::index_query().world(narc::column(asked))).value().count == 1);
    CHECK(index.build(boxes, options));
    uint32_t a[3], b[3];
    const std::vector<uint32_t> second = {1};
    CHECK(narc::copy_pairs(index.query({&boxes[3], 1}).value(), a, b).value() == 3 && a[2] == 0);
    CHECK(narc::copy_pairs(index.query({&boxes[3], 1}).value(), a, b, second).value() == 1);
    CHECK(status_of(narc::copy_pairs(index.query({&boxes[3], 1}).value(), {a, 2}, b)) == NARC_ERROR_CAPACITY);
    const auto query = narc::index_query().mask(narc::column(mask)).ignored(narc::column(ignored)).workers(workers);
    CHECK(index.query({&boxes[3], 1}, query).value().count == 0);
    const narc::index moved = std::move(index);
    CHECK(moved.get() && !index.get());                                   // NOLINT
    CHECK(status_of(index.build(boxes)) == NARC_ERROR_ARGUMENT);          // NOLINT
    CHECK(status_of(index.query({&boxes[3], 1})) == NARC_ERROR_ARGUMENT); // NOLINT
    index = narc::index();
    CHECK(index.build({}) && index.query(boxes).value().count == 0);
}

void test_rays_and_points() {
    Scene scene = make_scene(10);
    std::vector<narc_box> boxes(10);
    CHECK(narc::compute_boxes(scene.shapes, scene.bodies, boxes));
    narc::index index;
    CHECK(index.build(boxes));
    const std::vector<uint32_t> ignored = {0, 0};
    const std::vector<Vector> from = {{-5, 0.1}, {3.1, 0.1}};
    const std::vector<float> along = {20, 20}, none = {0, 0};
    const narc_owners owners = {narc::column(ignored), {}, {}};
    const narc_index_query of_owners = narc::index_query().owners(owners);
    CHECK(of_owners.owners == &owners && owners.owner.base == ignored.data());
    const auto search = narc::index_query().ignored(narc::column(ignored));

    size_t skipped = 9;
    narc_rays rays = {};
    rays.count = 2;
    rays.x = narc::positions(from, &Vector::x);
    rays.y = narc::positions(from, &Vector::y);
    rays.motion_x = narc::column(along);
    rays.motion_y = narc::column(none);
    const auto options = narc::ray_options().search(search).inside(NARC_INSIDE_IGNORES).most(3).skipped(skipped);
    std::array<uint32_t, 2> order = {7, 7};
    const narc_ray_options c = narc::ray_options(options).any().order(order.data());
    CHECK(c.out_order == order.data() && c.search.ignored.base == ignored.data() && c.inside == NARC_INSIDE_IGNORES &&
          c.any == 1 && c.most == 3);
    std::vector<narc_ray_hit> hits;
    const auto found = narc::cast_rays(index, scene.shapes, scene.bodies, rays, options, hits).value();
    std::vector<narc_ray_hit> expected(6);
    CHECK(!narc_cast_rays(index, scene.shapes, &scene.bodies, &rays, &options, expected.data(), 6, nullptr));
    CHECK(found.size() == 6 && skipped == 0 && found[0].body == 1 && found[1].body == 2 && found[3].body == 4);
    CHECK(std::memcmp(hits.data(), expected.data(), 6 * sizeof expected[0]) == 0);
    const auto ordered = narc::ray_options(options).order(order.data());
    CHECK(narc::cast_rays(index, scene.shapes, scene.bodies, rays, ordered, expected).value().size() == 6);
    CHECK(std::memcmp(hits.data(), expected.data(), 6 * sizeof expected[0]) == 0 && order[0] + order[1] == 1);
    CHECK(status_of(narc::cast_rays(index, scene.shapes, scene.bodies, rays, options, narc::span(hits.data(), 5))) ==
          NARC_ERROR_CAPACITY);

    narc_points points = {2, rays.x, rays.y, {}};
    const auto near = narc::nearest_options().search(search).distance(7).most(2);
    const narc_nearest_options &n = near;
    CHECK(n.search.ignored.base == ignored.data() && n.distance == 7 && n.inside == 0 && n.most == 2);
    std::vector<narc_distance> rows;
    const auto nearest = narc::find_nearest(index, scene.shapes, scene.bodies, points, near, rows).value();
    CHECK(nearest.size() == 4 && nearest[0].body == 1 && nearest[0].separation > 5 && nearest[2].body == 3);
    const uint32_t bodies[] = {1, 3};
    narc_distance row[2];
    CHECK(narc::find_distances(scene.shapes, scene.bodies, points, narc::column(bodies), row).value().size() == 2);
    CHECK(same(row[0], nearest[0]) && same(row[1], nearest[2]));
    CHECK(narc::find_nearest(index, scene.shapes, scene.bodies, points, narc::nearest_options().inside(), row));
    CHECK(row[0].count == 0 && row[1].body == 3 && row[1].separation < 0);
    CHECK(status_of(narc::find_distances(scene.shapes, scene.bodies, points, {}, narc::span(row, 1))) ==
          NARC_ERROR_CAPACITY);
    CHECK(status_of(narc::find_distances(nullptr, scene.bodies, points, {}, row)) == NARC_ERROR_ARGUMENT);
    narc_ray_hit hit[2];
    CHECK(narc::cast_ray_pairs(scene.shapes, scene.bodies, rays, narc::column(bodies), {}, hit).value().size() == 2);
    CHECK(hit[0].body == 1 && hit[0].count == 1 && hit[1].fraction == 0);
    std::vector<uint64_t> bits;
    CHECK(narc::find_inside(scene.shapes, scene.bodies, points, narc::column(bodies), bits));
    CHECK((bits[0] & 1) == (row[0].separation < 0) && (bits[0] >> 1 & 1) == (row[1].separation < 0));
    CHECK(status_of(narc::find_inside(scene.shapes, scene.bodies, points, {}, narc::span(bits.data(), 0))) ==
          NARC_ERROR_CAPACITY);
}

void test_casts() {
    Scene scene = make_scene(10);
    std::vector<narc_box> boxes(10);
    CHECK(narc::compute_boxes(scene.shapes, scene.bodies, boxes));
    narc::index index;
    CHECK(index.build(boxes));
    const std::vector<narc_body> movers = {narc::body(-5, 0, 1), narc::body(3, -5, 1)};
    const std::vector<float> x = {10, 0}, y = {0, 10};
    narc_motions motions = {};
    motions.x = narc::column(x);
    motions.y = narc::column(y);
    size_t skipped = 9;
    const auto options = narc::cast_options().target(0).tolerance(0.01f).skipped(skipped);
    std::vector<narc_impact> impacts;
    const auto hits =
        narc::cast_shapes(index, scene.shapes, scene.bodies, narc::bodies_of(movers), motions, {}, options, impacts)
            .value();
    CHECK(hits.size() == 2 && hits[0].count == NARC_CAST_HIT && hits[0].body == 0 && hits[1].body == 3 && skipped == 0);
    const uint32_t a[] = {0, 1}, b[] = {0, 3};
    narc_pairs pairs = {};
    pairs.count = 2;
    pairs.a = narc::column(a);
    pairs.b = narc::column(b);
    pairs.other_bodies = &scene.bodies;
    narc_impact impact[2];
    CHECK(narc::cast_pairs(scene.shapes, narc::bodies_of(movers), &motions, pairs, nullptr, options, impact));
    CHECK(same(impact[0], hits[0]) && same(impact[1], hits[1]));
    const narc_impact alone =
        narc::cast_pair(scene.shapes, movers[0], {10, 0, 0}, narc::body(0, 0, 0), {0, 0, 0}).value();
    CHECK(alone.body == 1 && alone.fraction == hits[0].fraction);
    const std::vector<float> targets = {0.5f, 0};
    const auto each = narc::cast_options().target(9).targets(narc::column(targets));
    CHECK(narc::cast_pairs(scene.shapes, narc::bodies_of(movers), &motions, pairs, nullptr, each, impact));
    CHECK(impact[0].fraction < hits[0].fraction && impact[0].separation > 0.49f && impact[0].separation < 0.51f);
    CHECK(impact[1].fraction == hits[1].fraction);
}

void test_poses_and_sets() {
    const std::vector<float> angles = {0, 1};
    std::vector<float> cosines(2), sines(2);
    CHECK(narc::compute_poses(angles, cosines, sines) && cosines[0] == 1 && std::fabs(sines[1] - 0.841471f) < 1e-6f);
    CHECK(status_of(narc::compute_poses(angles, cosines, narc::span(sines.data(), 1))) == NARC_ERROR_CAPACITY);
    const narc_body owners[] = {narc::body(1, 2, 0)}, parts[] = {narc::body(3, 4, 5), narc::body(0, 0, 6)};
    const std::vector<uint32_t> owner = {0, 0};
    std::vector<narc_body> placed;
    const auto all = narc::place_parts(narc::bodies_of(owners), narc::bodies_of(parts), narc::column(owner), placed);
    CHECK(all && all.value().size() == 2 && placed[0].x == 4 && placed[0].y == 6 && placed[1].shape == 6);
    narc_body room[1];
    CHECK(status_of(narc::place_parts(narc::bodies_of(owners), narc::bodies_of(parts), narc::column(owner), room)) ==
          NARC_ERROR_CAPACITY);
    CHECK(narc::set_isa("scalar") && std::string(narc_get_isa()) == "scalar");
    CHECK(status_of(narc::set_isa("none")) == NARC_ERROR_ISA_UNKNOWN && narc::set_isa(nullptr));
}

void test_exceptions() {
#ifdef __cpp_exceptions
    std::string message;
    try {
        (void)narc::box(1, 1, 2).value();
    } catch (const std::exception &exception) {
        message = exception.what();
    }
    CHECK(message == narc::box(1, 1, 2).error().message && !message.empty());
    try {
        narc::set_isa("none").value();
        CHECK(false);
    } catch (const narc::exception &exception) {
        CHECK(exception.error.status == NARC_ERROR_ISA_UNKNOWN);
    }
#endif
}

} // namespace

int main() {
    test_spans();
    test_columns();
    test_bodies();
    test_builders();
    test_shapes();
    test_outlines();
    test_ground();
    test_query();
    test_contacts();
    test_overlaps();
    test_separations();
    test_small_batches();
    test_workers();
    test_broad_phase();
    test_contacts_that_stay();
    test_index();
    test_rays_and_points();
    test_casts();
    test_poses_and_sets();
    test_exceptions();
    std::puts("narc.hpp is what it says");
}
