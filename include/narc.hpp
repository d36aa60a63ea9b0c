// SPDX-License-Identifier: MIT
//
// narc.hpp - narc in C++17: owners, columns, queries and answers. Header only, above the headers in C.
//
// The mental model
//
//   Names are those of C without the prefix, and mean what narc_shapes.h, narc.h, narc_broad_phase.h and narc_scene.h
//   say there.
//   Bodies, pairs, columns and rows are the structures of C; beside them there are
//
//       narc::shapes, narc::broad_phase, narc::contacts,
//       narc::index                       owners: they move, are not copied, and pass as pointers to all functions of C.
//                                         One that was moved from, or had no memory, is a NULL there
//       narc::result                      an answer or an error: if (result) ... else result.error().message. value()
//                                         is for those who want exceptions: without an answer it throws
//                                         narc::exception, or ends the program where exceptions are switched off
//       narc::span                        the caller's array: a container with data() and size(), an array, a pointer
//                                         and a size. Like columns, it must not outlive what it looks at
//       narc::query, narc::step           and other options: the structures of C with functions that set their fields
//
//   No call allocates what C would not, but for rows in a std::vector, which is made longer where it is too short and
//   never shorter: the span that is returned tells how many there are.
//
// Example
//
//     struct Entity { b2Vec2 position; b2Rot rotation; uint32_t shape; };       (the engine's own)
//     narc::shapes shapes;
//     narc::contacts contacts = narc::contacts::make(NARC_MANIFOLD_ROWS, sizeof(Impulses)).value();
//     uint32_t crate = shapes.add(narc::box(1, 1, 0.05)).value();
//     narc_bodies bodies = narc::bodies_of(entities, &Entity::position, &Entity::rotation, &Entity::shape);
//     const narc_step_result *r = contacts.update(shapes, bodies, narc::step().margin(0.02f).skin(0.05f)).value();
//     for (size_t k = 0; k < r->touching_count; k++)
//         solve(r->manifolds[r->touching[k]], static_cast<Impulses *>(r->user)[r->touching[k]]);
#ifndef NARC_HPP
#define NARC_HPP

#if __cplusplus < 201703L
#error "narc.hpp is C++17"
#endif

#include <exception>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "narc.h"
#include "narc_broad_phase.h"
#include "narc_chains.h"
#include "narc_contacts.h"
#include "narc_scene.h"

namespace narc {

// ------------------------------------------------------------------------------------------------ errors and answers

// What value() throws.
struct exception : std::exception {
    explicit exception(const narc_error &e) noexcept : error(e) {}
    const char *what() const noexcept override { return error.message; }
    narc_error error;
};

template <class T> class result;

// Whether it went well; its error has status NARC_OK then.
template <> class [[nodiscard]] result<void> {
  public:
    explicit result(const narc_error &error) noexcept : error_(error) {}
    explicit operator bool() const noexcept { return error_.status == NARC_OK; }
    const narc_error &error() const noexcept { return error_; }
    void value() const {
        if (error_.status == NARC_OK)
            return;
#ifdef __cpp_exceptions
        throw exception(error_);
#else
        std::terminate();
#endif
    }

  private:
    narc_error error_;
};

// The same with an answer.
template <class T> class [[nodiscard]] result : public result<void> {
  public:
    using result<void>::result;
    explicit result(T value) : result<void>(narc_error()), value_(std::move(value)) {}
    T &value() & { return result<void>::value(), *value_; }
    const T &value() const & { return result<void>::value(), *value_; }
    T value() && { return result<void>::value(), std::move(*value_); }

  private:
    std::optional<T> value_;
};

// ------------------------------------------------------------------------------------------------ spans

template <class Item> class span {
  public:
    constexpr span() noexcept = default;
    constexpr span(Item *data, size_t size) noexcept : data_(data), size_(size) {}
    template <size_t Size> constexpr span(Item (&items)[Size]) noexcept : span(items, Size) {}
    template <class Container, class Of = std::remove_pointer_t<decltype(std::declval<Container &>().data())>,
              class = std::enable_if_t<std::is_convertible_v<Of (*)[], Item (*)[]>>>
    constexpr span(Container &&items) noexcept : span(items.data(), items.size()) {}

    constexpr Item *data() const noexcept { return data_; }
    constexpr size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0; }
    constexpr Item *begin() const noexcept { return data_; }
    constexpr Item *end() const noexcept { return data_ + size_; }
    constexpr Item &operator[](size_t k) const { return data_[k]; }
    constexpr span first(size_t count) const noexcept { return {data_, count < size_ ? count : size_}; }

  private:
    Item *data_ = nullptr;
    size_t size_ = 0;
};

// ------------------------------------------------------------------------------------------------ what it is made of

namespace detail {

template <class Item, class Field> auto &get(Item &item, Field field) {
    if constexpr (std::is_member_object_pointer_v<Field>)
        return item.*field;
    else
        return field(item);
}
template <class Item> Item *field_of(Item *item) { return item; }
template <class Item, class Field, class... Fields> auto *field_of(Item *item, Field field, Fields... fields) {
    return field_of(item ? &get(*item, field) : nullptr, fields...);
}

template <class R> auto cosine_of(R &rotation) -> decltype((rotation.c)) { return rotation.c; }
template <class R> auto cosine_of(R &rotation) -> decltype((rotation.cosine)) { return rotation.cosine; }
template <class R> auto sine_of(R &rotation) -> decltype((rotation.s)) { return rotation.s; }
template <class R> auto sine_of(R &rotation) -> decltype((rotation.sine)) { return rotation.sine; }

// call(arguments ..., out, error), where there is an `out`.
template <class T, class Call, class... Arguments> result<T> ask(Call call, Arguments... arguments) {
    narc_error error = {};
    if constexpr (std::is_void_v<T>) {
        call(arguments..., &error);
        return result<T>(error);
    } else {
        T value{};
        return call(arguments..., &value, &error) ? result<T>(error) : result<T>(std::move(value));
    }
}

inline narc_error too_short(size_t needed) {
    return {NARC_ERROR_CAPACITY, 0, static_cast<double>(needed), "a span is too short"};
}

// What owns an object of C: one that something else has made, or a new one.
template <class Object, auto Create, auto Destroy> class owner {
  public:
    explicit owner(Object *owned) noexcept : object_(owned) {}
    explicit owner(const narc_allocator *allocator = nullptr) noexcept {
        Object *object = nullptr;
        if (Create(allocator, &object) == NARC_OK)
            object_.reset(object);
    }
    Object *get() const noexcept { return object_.get(); }
    operator Object *() noexcept { return get(); }
    operator const Object *() const noexcept { return get(); }

  private:
    struct destroy {
        void operator()(Object *object) const noexcept { Destroy(object); }
    };
    std::unique_ptr<Object, destroy> object_;
};

// A structure of C with functions that set its fields.
template <class Self, class Structure> class options : public Structure {
  public:
    options() noexcept : Structure() {}
    Self &workers(const narc_workers &value) noexcept { return set(&Structure::workers, &value); }
    Self &workers(const narc_workers &&) = delete; // they must outlive the call

  protected:
    template <class Field, class Value> Self &set(Field Structure::*field, Value value) noexcept {
        this->*field = value;
        return static_cast<Self &>(*this);
    }
};

inline size_t asked(const narc_pairs &pairs, const narc_query &query) {
    return query.selection.base || query.selection.stride ? query.selection_count : pairs.count;
}

template <class Rows> void make_room(Rows &, size_t) {}
template <class Row, class Allocator> void make_room(std::vector<Row, Allocator> &rows, size_t needed) {
    if (rows.size() < needed)
        rows.resize(needed);
}

template <class Call, class Rows, class... Fields>
auto find_rows(Call call, const narc_shapes *shapes, const narc_bodies &bodies, const narc_pairs &pairs,
               narc_query query, Rows &rows, Fields... fields) {
    using item = std::remove_pointer_t<decltype(data_of(rows))>;
    query.row_stride = sizeof(item);
    // Room for a row for each pair.
    make_room(rows, query.dense ? pairs.count : asked(pairs, query));
    const span<item> items(rows);
    narc_error error = {};
    size_t found = 0;
    return call(shapes, &bodies, &pairs, &query, field_of(items.data(), fields...), items.size(), &found, &error)
               ? result<span<item>>(error)
               : result<span<item>>(items.first(query.dense ? pairs.count : found));
}

// call(rows, capacity, error) with room for so many rows, which are the result.
template <class Row, class Rows, class Call> result<span<Row>> fill_rows(Rows &rows, size_t needed, Call call) {
    make_room(rows, needed);
    const span<Row> items(rows);
    if (items.size() < needed)
        return result<span<Row>>(too_short(needed));
    narc_error error = {};
    return call(items.data(), items.size(), &error) ? result<span<Row>>(error) : result<span<Row>>(items.first(needed));
}

// call(items, capacity, out_count, error) with a guess of how many items there are, and again with room for them.
template <class Item, class Call> result<std::vector<Item>> fill_vector(size_t guess, Call call) {
    std::vector<Item> items(guess);
    narc_error error = {};
    size_t count = 0;
    narc_status status = call(items.data(), items.size(), &count, &error);
    if (status == NARC_ERROR_CAPACITY) {
        items.resize(count);
        status = call(items.data(), items.size(), &count, &error);
    }
    items.resize(status == NARC_OK ? count : 0);
    return status == NARC_OK ? result<std::vector<Item>>(std::move(items)) : result<std::vector<Item>>(error);
}

// What call(out) says, where it says true.
template <class T, class Call> std::optional<T> get_if(Call call) {
    T value{};
    return call(&value) ? std::optional<T>(value) : std::nullopt;
}

inline size_t at_least_one(size_t most) { return most > 0 ? most : 1; }

} // namespace detail

// ------------------------------------------------------------------------------------------------ columns and bodies

// The column of all items in a container, of a field of each, or of a field of a field: column(entities, &Entity::pose,
// &Pose::c). A field is a pointer to a member, or a function from an item to a reference. Its type is the column's, so
// that doubles where floats are meant do not compile.
template <class Items, class... Fields> auto column(const Items &items, Fields... fields) {
    return make_column(detail::field_of(data_of(items), fields...), sizeof *data_of(items));
}
// Floats or doubles.
template <class Items, class... Fields> narc_position_column positions(const Items &items, Fields... fields) {
    return make_positions(detail::field_of(data_of(items), fields...), sizeof *data_of(items));
}

// Bodies in a container; their `scale` may be set afterwards.
template <class Items, class X, class Y, class Cosine, class Sine, class Shape>
narc_bodies bodies_of(const Items &items, X x, Y y, Cosine cosine, Sine sine, Shape shape) {
    return {std::size(items),     positions(items, x),
            positions(items, y),  column(items, cosine),
            column(items, sine),  {},
            column(items, shape), {}};
}
// The same of structures: a position has x and y, a rotation c and s, or cosine and sine.
template <class Items, class Position, class Rotation, class Shape>
narc_bodies bodies_of(const Items &items, Position position, Rotation rotation, Shape shape) {
    return bodies_of(
        items, [=](auto &item) -> auto & { return detail::get(item, position).x; },
        [=](auto &item) -> auto & { return detail::get(item, position).y; },
        [=](auto &item) -> auto & { return detail::cosine_of(detail::get(item, rotation)); },
        [=](auto &item) -> auto & { return detail::sine_of(detail::get(item, rotation)); }, shape);
}
inline narc_bodies bodies_of(span<const narc_body> rows) {
    narc_bodies bodies;
    narc_view_bodies(rows.data(), rows.size(), &bodies);
    return bodies;
}

inline narc_body body(double x, double y, uint32_t shape, float cosine = 1, float sine = 0, float scale = 1) {
    return {x, y, cosine, sine, scale, shape};
}

// Pairs in a container.
template <class Items, class A, class B> narc_pairs pairs_of(const Items &items, A a, B b) {
    return {std::size(items), column(items, a), column(items, b), nullptr, {}, {}, {}};
}
// Pairs that bring their own poses.
inline narc_pairs pairs_of(size_t count) { return {count, {}, {}, nullptr, {}, {}, {}}; }

// OpenMP's threads; 0: as many as it would use.
inline narc_workers openmp_workers(unsigned count = 0) noexcept {
    narc_workers workers = {};
    narc_openmp_workers(count, &workers);
    return workers;
}
// Workers that are the caller's loop: run(8, task) calls task(index) for each index below 8 and returns when all have
// ended. `run` must outlive the workers and let no exception out.
template <class Run> narc_workers workers_of(unsigned count, Run &run) {
    return {const_cast<std::remove_const_t<Run> *>(std::addressof(run)), count,
            [](void *context, unsigned task_count, void (*task)(void *, unsigned), void *argument) noexcept {
                (*static_cast<Run *>(context))(
                    task_count, [=](unsigned index) { task(argument, index); });
            }};
}

// ------------------------------------------------------------------------------------------------ shapes

// The arcs of one shape, as builders make them.
struct outline {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    const narc_arc *data() const noexcept { return arcs; }
    size_t size() const noexcept { return count; }
};
using arcs = span<const narc_arc>;
using points = span<const narc_point>;

// Any builder of C: build(narc_build_box, 1.0, 2.0, 0.1).
template <class Build, class... Arguments> result<outline> build(Build call, Arguments... arguments) {
    return detail::ask<outline>(
        [=](outline *out, narc_error *error) { return call(arguments..., out->arcs, &out->count, error); });
}
inline auto circle(double radius) { return build(narc_build_circle, radius); }
inline auto capsule(double length, double radius) { return build(narc_build_capsule, length, radius); }
inline auto segment(narc_point from, narc_point to, double radius = 0) {
    return build(narc_build_segment, &from, &to, radius);
}
inline auto box(double width, double height, double radius = 0) { return build(narc_build_box, width, height, radius); }
inline auto polygon(points corners, double radius = 0) {
    return build(narc_build_polygon, corners.data(), corners.size(), radius);
}
inline auto skin_polygon(points corners, double radius) {
    return build(narc_build_skin_polygon, corners.data(), corners.size(), radius);
}
inline auto regular_polygon(size_t corners, double circumradius, double radius = 0) {
    return build(narc_build_regular_polygon, corners, circumradius, radius);
}
inline auto ellipse(double half_x, double half_y, size_t arc_count) {
    return build([=](narc_arc *out, size_t *count, narc_error *error) {
        return narc_build_ellipse(half_x, half_y, arc_count, out, count, nullptr, error);
    });
}
inline auto four_arc(const narc_four_arc &form) { return build(narc_build_four_arc, &form); }
inline auto through_points(points junctions, double radius = 0) {
    return build(narc_build_points, junctions.data(), junctions.size(), radius);
}
inline auto ring(points around) { return build(narc_build_ring, around.data(), around.size()); }
inline auto hull(points around, double tolerance = 0, double radius = 0) {
    return build(narc_build_hull, around.data(), around.size(), tolerance, radius);
}

// Corners for builders, and what these take.
inline result<std::vector<narc_point>> weld_polygon(points corners, double tolerance) {
    return detail::fill_vector<narc_point>(
        corners.size(),
        [&](narc_point *out, size_t, size_t *count, narc_error *error) {
            return narc_weld_polygon(corners.data(), corners.size(), tolerance, out, count, error);
        });
}
inline result<std::vector<narc_point>> adjust_polygon(points corners) {
    return detail::fill_vector<narc_point>(
        corners.size(),
        [&](narc_point *out, size_t, size_t *count, narc_error *error) {
            *count = corners.size();
            return narc_adjust_polygon(corners.data(), corners.size(), out, error);
        });
}
struct radius_range {
    double min, max, chosen;
};
inline result<radius_range> find_radius_range(points junctions) {
    return detail::ask<radius_range>([&](radius_range *out, narc_error *error) {
        return narc_find_radius_range(junctions.data(), junctions.size(), &out->min, &out->max, &out->chosen, error);
    });
}

// The same shape elsewhere; with its centroid at the origin; mirrored.
inline result<outline> move(arcs shape, double x, double y, double angle = 0, double scale = 1) {
    return build([=](narc_arc *out, size_t *count, narc_error *error) {
        *count = shape.size();
        return narc_move_arcs(shape.data(), shape.size(), x, y, angle, scale, out, error);
    });
}
inline result<outline> center(arcs shape, narc_point *centroid = nullptr) {
    return build([=](narc_arc *out, size_t *count, narc_error *error) {
        *count = shape.size();
        return narc_center_arcs(shape.data(), shape.size(), out, centroid, error);
    });
}
inline result<outline> mirror(arcs shape) {
    return build([=](narc_arc *out, size_t *count, narc_error *error) {
        *count = shape.size();
        return narc_mirror_arcs(shape.data(), shape.size(), out, error);
    });
}

// What is known of an outline; nothing of one without arcs.
inline auto mass(arcs shape) {
    return detail::get_if<narc_mass>(
        [=](narc_mass *out) { return narc_compute_mass(shape.data(), shape.size(), out); });
}
inline auto bounding_circle(arcs shape) {
    return detail::get_if<narc_circle>(
        [=](narc_circle *out) { return narc_compute_bounding_circle(shape.data(), shape.size(), out); });
}
inline auto inscribed_circle(arcs shape) {
    return detail::get_if<narc_circle>(
        [=](narc_circle *out) { return narc_compute_inscribed_circle(shape.data(), shape.size(), out); });
}
// Turned by an angle.
inline auto aabb(arcs shape, double angle = 0) {
    return detail::get_if<narc_aabb>(
        [=](narc_aabb *out) { return narc_compute_aabb(shape.data(), shape.size(), angle, out); });
}
inline auto perimeter(arcs shape) {
    return detail::get_if<double>([=](double *out) { return narc_compute_perimeter(shape.data(), shape.size(), out); });
}
inline auto distance(arcs shape, narc_point to) {
    return detail::get_if<double>(
        [=](double *out) { return narc_compute_distance(shape.data(), shape.size(), &to, out); });
}
struct support {
    narc_point point;
    size_t arc;
};
inline auto find_support(arcs shape, double direction_x, double direction_y) {
    return detail::get_if<support>([=](support *out) {
        return narc_find_support(shape.data(), shape.size(), direction_x, direction_y, &out->point, &out->arc);
    });
}
inline bool contains(arcs shape, narc_point point) noexcept {
    return narc_contains_point(shape.data(), shape.size(), &point);
}

// Of all that any of some parts covers: the arcs of all, and how many each has.
inline result<narc_mass> union_mass(arcs all, span<const size_t> counts, const narc_allocator *allocator = nullptr) {
    return detail::ask<narc_mass>(narc_compute_union_mass, all.data(), counts.data(), counts.size(), allocator);
}

// As a polyline, of a shape or a chain; of a body, or in the arcs' own axes.
inline result<std::vector<narc_point>> flatten(arcs outline, bool closed, double tolerance,
                                               const narc_body *body = nullptr) {
    return detail::fill_vector<narc_point>(
        4 * outline.size(),
        [&](narc_point *out, size_t capacity, size_t *count, narc_error *error) {
            return narc_flatten_arcs(outline.data(), outline.size(), closed, body, tolerance, out, capacity, count,
                                     error);
        });
}

// A store.
class shapes : public detail::owner<narc_shapes, narc_create_shapes, narc_destroy_shapes> {
  public:
    using owner::owner;
    static result<shapes> load(const void *bytes, size_t size, const narc_allocator *allocator = nullptr) {
        const auto store = detail::ask<narc_shapes *>(narc_load_shapes, allocator, bytes, size);
        return store ? result<shapes>(shapes(store.value())) : result<shapes>(store.error());
    }

    result<uint32_t> add(arcs shape) {
        return detail::ask<uint32_t>(narc_add_shape, get(), shape.data(), shape.size());
    }
    // With the builder's error, if that has one.
    result<uint32_t> add(const result<outline> &shape) {
        return shape ? add(shape.value()) : result<uint32_t>(shape.error());
    }
    result<uint32_t> add_half_plane() { return detail::ask<uint32_t>(narc_add_half_plane, get()); }
    result<void> add_at(uint32_t index, arcs shape) {
        return detail::ask<void>(narc_add_shape_at, get(), index, shape.data(), shape.size());
    }
    result<void> replace(uint32_t index, arcs shape) {
        return detail::ask<void>(narc_replace_shape, get(), index, shape.data(), shape.size());
    }
    result<void> remove(uint32_t index) { return detail::ask<void>(narc_remove_shape, get(), index); }
    result<void> reserve(size_t shape_count, size_t arc_count) {
        return detail::ask<void>([&](narc_error *error) {
            *error = {};
            return error->status = narc_reserve_shapes(get(), shape_count, arc_count);
        });
    }
    // Ground: its entries, which are to be bodies.
    result<std::vector<narc_chain_entry>> add_chain(arcs chain, const narc_chain_options &options = {}) {
        return detail::fill_vector<narc_chain_entry>(
            2 * chain.size() + 8,
            [&](narc_chain_entry *out, size_t capacity, size_t *count, narc_error *error) {
                return narc_add_chain(get(), chain.data(), chain.size(), &options, out, capacity, count, error);
            });
    }
    uint32_t uses(uint32_t index) const noexcept { return narc_count_uses(get(), index); }
    unsigned flags(uint32_t index) const noexcept { return narc_shape_flags(get(), index); }
    std::optional<narc_aabb> aabb(uint32_t index, float cosine = 1, float sine = 0, float scale = 1) const noexcept {
        return detail::get_if<narc_aabb>(
            [&](narc_aabb *out) { return narc_get_aabb(get(), index, cosine, sine, scale, out); });
    }
    result<std::vector<char>> save() const {
        std::vector<char> bytes(narc_count_saved_bytes(get()));
        const auto saved = detail::ask<void>(narc_save_shapes, get(), bytes.data(), bytes.size());
        return saved ? result<std::vector<char>>(std::move(bytes)) : result<std::vector<char>>(saved.error());
    }
    size_t size() const noexcept { return narc_count_shapes(get()); }
    outline operator[](uint32_t index) const noexcept {
        outline shape;
        shape.count = narc_get_arcs(get(), index, shape.arcs);
        return shape;
    }
};

inline result<void> validate(arcs shape) { return detail::ask<void>(narc_validate_arcs, shape.data(), shape.size()); }
inline result<void> validate(const narc_shapes *shapes, const narc_bodies &bodies) {
    return detail::ask<void>(narc_validate_bodies, shapes, &bodies);
}

// ------------------------------------------------------------------------------------------------ queries

struct query : detail::options<query, narc_query> {
    query &margin(float value) noexcept { return set(&narc_query::margin, value); }
    query &margins(narc_float_column value) noexcept { return set(&narc_query::margins, value); }
    query &second_margin(float value) noexcept { return set(&narc_query::second_margin, value); }
    query &flat_angle(float value) noexcept { return set(&narc_query::flat_angle, value); }
    query &range(size_t from, size_t items) noexcept {
        return set(&narc_query::first, from).set(&narc_query::count, items);
    }
    query &front_only() noexcept { return set(&narc_query::front_only, 1u); }
    query &dense() noexcept { return set(&narc_query::dense, 1u); }
    query &skipped(size_t &out) noexcept { return set(&narc_query::out_skipped, &out); }
    // These pairs; of an empty span none.
    query &selection(span<const uint32_t> pairs) noexcept {
        return set(&narc_query::selection, column(pairs)).set(&narc_query::selection_count, pairs.size());
    }
};

// `rows` is a span, an array or a vector of narc_contact, or of larger structures of which `field` is one. The result is
// the span of those that were found, of dense rows all. NARC_ERROR_CAPACITY: error().value is how many were found.
template <class Rows, class... Field>
auto find_contacts(const narc_shapes *shapes, const narc_bodies &bodies, const narc_pairs &pairs,
                   const narc_query &query, Rows &&rows, Field... field) {
    return detail::find_rows(narc_find_contacts, shapes, bodies, pairs, query, rows, field...);
}
// The same of narc_manifold.
template <class Rows, class... Field>
auto find_manifolds(const narc_shapes *shapes, const narc_bodies &bodies, const narc_pairs &pairs,
                    const narc_query &query, Rows &&rows, Field... field) {
    return detail::find_rows(narc_find_manifolds, shapes, bodies, pairs, query, rows, field...);
}

// Of two bodies; count 0: none.
inline result<narc_contact> find_contact(const narc_shapes *shapes, const narc_body &a, const narc_body &b,
                                         const narc_query &query = {}) {
    return detail::ask<narc_contact>(narc_find_contact, shapes, &a, &b, &query);
}
inline result<narc_manifold> find_manifold(const narc_shapes *shapes, const narc_body &a, const narc_body &b,
                                           const narc_query &query = {}) {
    return detail::ask<narc_manifold>(narc_find_manifold, shapes, &a, &b, &query);
}

// Contacts again, as narc_refined_contact: `rows` is a span, an array or a vector of them.
template <class Rows>
auto refine_contacts(const narc_shapes *shapes, const narc_bodies &bodies, const narc_pairs &pairs,
                     const narc_refinement &refinement, span<const narc_contact> contacts, Rows &&rows) {
    return detail::fill_rows<narc_refined_contact>(
        rows, contacts.size(),
        [&](narc_refined_contact *out, size_t, narc_error *error) {
            return narc_refine_contacts(shapes, &bodies, &pairs, &refinement, contacts.data(), contacts.size(), out,
                                        error);
        });
}

// separations[k] is that of pair k: a span, an array or a vector of floats, with room for all pairs.
template <class Floats>
result<void> find_separations(const narc_shapes *shapes, const narc_bodies &bodies, const narc_pairs &pairs,
                              narc_query query, Floats &&separations) {
    query.row_stride = sizeof(float);
    detail::make_room(separations, pairs.count);
    const span<float> room(separations);
    if (room.size() < pairs.count)
        return result<void>(detail::too_short(pairs.count));
    return detail::ask<void>(narc_find_separations, shapes, &bodies, &pairs, &query, room.data());
}

// Bit k % 64 of bits[k / 64] is that of pair k.
template <class Bits>
result<void> find_overlaps(const narc_shapes *shapes, const narc_bodies &bodies, const narc_pairs &pairs,
                           const narc_query &query, Bits &&bits) {
    const size_t words = NARC_BIT_WORDS(detail::asked(pairs, query));
    detail::make_room(bits, words);
    const span<uint64_t> room(bits);
    if (room.size() < words)
        return result<void>(detail::too_short(words));
    return detail::ask<void>(narc_find_overlaps, shapes, &bodies, &pairs, &query, room.data());
}

// ------------------------------------------------------------------------------------------------ boxes and pairs

// One box for each body.
inline result<void> compute_boxes(const narc_shapes *shapes, const narc_bodies &bodies, span<narc_box> boxes,
                                  const narc_box_options &options = {}) {
    return boxes.size() < bodies.count ? result<void>(detail::too_short(bodies.count))
                                       : detail::ask<void>(narc_compute_boxes, shapes, &bodies, &options, boxes.data());
}

struct box_options : detail::options<box_options, narc_box_options> {
    box_options &margin(float value) noexcept { return set(&narc_box_options::margin, value); }
    box_options &motion(narc_float_column x, narc_float_column y) noexcept {
        return set(&narc_box_options::motion_x, x).set(&narc_box_options::motion_y, y);
    }
    box_options &range(size_t from, size_t items) noexcept {
        return set(&narc_box_options::first, from).set(&narc_box_options::count, items);
    }
    box_options &skipped(size_t &out) noexcept { return set(&narc_box_options::out_skipped, &out); }
    box_options &origin(const narc_point &value) noexcept { return set(&narc_box_options::origin, &value); }
    box_options &origin(const narc_point &&) = delete;
};

class broad_phase : public detail::owner<narc_broad_phase, narc_create_broad_phase, narc_destroy_broad_phase> {
  public:
    using owner::owner;
    // How many pairs of boxes overlap: their numbers are the first items of a and b, which are made longer where they are
    // too short.
    result<size_t> find_pairs(span<const narc_box> boxes, std::vector<uint32_t> &a, std::vector<uint32_t> &b,
                              const narc_pair_filter *filter = nullptr, const narc_workers *workers = nullptr) {
        const auto ask = [&](size_t *out_count, narc_error *error) {
            return narc_find_pairs(get(), boxes.data(), boxes.size(), filter, workers, a.data(), b.data(), 0,
                                   a.size() < b.size() ? a.size() : b.size(), out_count, error);
        };
        size_t count = 0;
        narc_error error = {};
        narc_status status = ask(&count, &error);
        if (status == NARC_ERROR_CAPACITY) {
            detail::make_room(a, count);
            detail::make_room(b, count);
            status = ask(&count, &error);
        }
        return status == NARC_OK ? result<size_t>(count) : result<size_t>(error);
    }
};

// ------------------------------------------------------------------------------------------------ contacts that stay

struct step : detail::options<step, narc_step> {
    step &margin(float value) noexcept { return set(&narc_step::margin, value); }
    step &second_margin(float value) noexcept { return set(&narc_step::second_margin, value); }
    step &flat_angle(float value) noexcept { return set(&narc_step::flat_angle, value); }
    step &front_only() noexcept { return set(&narc_step::front_only, 1u); }
    step &skin(float value) noexcept { return set(&narc_step::skin, value); }
    step &recycling(float value) noexcept { return set(&narc_step::recycling, value); }
    step &motion(narc_float_column x, narc_float_column y) noexcept {
        return set(&narc_step::motion_x, x).set(&narc_step::motion_y, y);
    }
    step &reach(narc_float_column value) noexcept { return set(&narc_step::reach, value); }
    step &ahead(narc_float_column value) noexcept { return set(&narc_step::ahead, value); }
    step &id(narc_word_column value) noexcept { return set(&narc_step::id, value); }
    step &run(narc_index_column value) noexcept { return set(&narc_step::run, value); }
    step &filter(const narc_pair_filter &value) noexcept { return set(&narc_step::filter, &value); }
    step &filter(const narc_pair_filter &&) = delete;
    // So many touching pairs there are of each world, at `out`, which stays where it is until the update.
    step &world_counts(span<uint32_t> out) noexcept {
        return set(&narc_step::out_world_count, out.data()).set(&narc_step::world_count, out.size());
    }
    step &origin(const narc_point &value) noexcept { return set(&narc_step::origin, &value); }
    step &origin(const narc_point &&) = delete;
    // These are the pairs that there are; `same`: those of the last step.
    step &pairs(const narc_pairs &value, bool same = false) noexcept {
        return set(&narc_step::pairs, &value).set(&narc_step::same_pairs, same ? 1u : 0u);
    }
    step &pairs(const narc_pairs &&, bool = false) = delete;
    // Only these bodies may have moved; they stay where they are until the update.
    step &moved(span<const uint32_t> list) noexcept {
        return set(&narc_step::moved, column(list)).set(&narc_step::moved_count, list.size());
    }
};

namespace detail {
inline narc_status create_contacts(const narc_allocator *allocator, narc_contacts **out_contacts) noexcept {
    narc_contacts_settings settings = {};
    settings.allocator = allocator;
    return narc_create_contacts(&settings, out_contacts, nullptr);
}
} // namespace detail

class contacts : public detail::owner<narc_contacts, detail::create_contacts, narc_destroy_contacts> {
  public:
    using owner::owner;
    // With rows of the kind NARC_MANIFOLD_ROWS or NARC_CONTACT_ROWS, and bytes of the caller's in each slot; and, with
    // NARC_ROWS_IN_USER, where the row lies in these.
    static result<contacts> make(uint32_t rows, size_t user_size, size_t row_offset = 0,
                                 const narc_allocator *allocator = nullptr) {
        narc_contacts_settings settings = {};
        settings.rows = rows;
        settings.user_size = user_size;
        settings.row_offset = row_offset;
        settings.allocator = allocator;
        const auto made = detail::ask<narc_contacts *>(narc_create_contacts, &settings);
        return made ? result<contacts>(contacts(made.value())) : result<contacts>(made.error());
    }
    // Its arrays stay until the next update.
    result<const narc_step_result *> update(const narc_shapes *shapes, const narc_bodies &bodies,
                                            const narc_step &step = narc::step()) {
        narc_step whole = step;
        whole.bodies = &bodies;
        return detail::ask<const narc_step_result *>(narc_update_contacts, get(), shapes, &whole);
    }
    // The slots of a body's pairs, by its number in the last step.
    result<span<const uint32_t>> slots_of(uint32_t body) {
        const uint32_t *slots = nullptr;
        size_t count = 0;
        narc_error error = {};
        return narc_find_body_slots(get(), body, &slots, &count, &error)
                   ? result<span<const uint32_t>>(error)
                   : result<span<const uint32_t>>(span<const uint32_t>(slots, count));
    }
    // Takes bodies out by their ids.
    result<void> forget(span<const uint64_t> ids) {
        return detail::ask<void>(narc_forget_bodies, get(), ids.data(), ids.size());
    }
    void forget() noexcept { narc_forget_contacts(get()); }
    // As bytes, and back.
    result<std::vector<char>> save() const {
        std::vector<char> bytes(narc_count_contact_bytes(get()));
        const auto saved = detail::ask<void>(narc_save_contacts, get(), bytes.data(), bytes.size());
        return saved ? result<std::vector<char>>(std::move(bytes)) : result<std::vector<char>>(saved.error());
    }
    result<const narc_step_result *> load(const narc_shapes *shapes, span<const char> bytes) {
        return detail::ask<const narc_step_result *>(narc_load_contacts, get(), shapes, bytes.data(), bytes.size());
    }
};

// ------------------------------------------------------------------------------------------------ questions to a scene

struct index_options : detail::options<index_options, narc_index_options> {
    index_options &category(narc_word_column value) noexcept { return set(&narc_index_options::category, value); }
    index_options &world(narc_index_column value) noexcept { return set(&narc_index_options::world, value); }
    index_options &fast() noexcept { return set(&narc_index_options::fast, 1u); }
    index_options &origin(const narc_point &value) noexcept { return set(&narc_index_options::origin, &value); }
    index_options &origin(const narc_point &&) = delete;
};

struct index_query : detail::options<index_query, narc_index_query> {
    index_query &mask(narc_word_column value) noexcept { return set(&narc_index_query::mask, value); }
    index_query &ignored(narc_index_column value) noexcept { return set(&narc_index_query::ignored, value); }
    index_query &world(narc_index_column value) noexcept { return set(&narc_index_query::world, value); }
    index_query &owners(const narc_owners &value) noexcept { return set(&narc_index_query::owners, &value); }
    index_query &owners(const narc_owners &&) = delete;
};

class index : public detail::owner<narc_index, narc_create_index, narc_destroy_index> {
  public:
    using owner::owner;
    result<void> build(span<const narc_box> boxes, const narc_index_options &options = {}) {
        return detail::ask<void>(narc_build_index, get(), boxes.data(), boxes.size(), &options);
    }
    // Of all boxes those that are listed have changed; without a list all may have.
    result<void> update(span<const narc_box> boxes, span<const uint32_t> changed,
                        const narc_index_options &options = {}) {
        const narc_index_column list = {changed.data(), sizeof(uint32_t)};
        return detail::ask<void>(narc_update_index, get(), boxes.data(), boxes.size(), &list, changed.size(), &options);
    }
    result<void> update(span<const narc_box> boxes, const narc_index_options &options = {}) {
        return detail::ask<void>(narc_update_index, get(), boxes.data(), boxes.size(), nullptr, size_t{0}, &options);
    }
    result<narc_index_statistics> describe() const {
        return detail::ask<narc_index_statistics>(narc_describe_index, get());
    }
    // How many nodes the level has, whose boxes are the first ones.
    result<size_t> copy_nodes(size_t level, span<narc_box> out) const {
        return detail::ask<size_t>(narc_copy_nodes, get(), level, out.data(), ptrdiff_t{0}, out.size());
    }
    // Its columns stay until the next query.
    result<narc_pairs> query(span<const narc_box> boxes, const narc_index_query &query = {}) {
        return detail::ask<narc_pairs>(narc_query_index, get(), boxes.data(), boxes.size(), &query);
    }
};

struct ray_options : detail::options<ray_options, narc_ray_options> {
    ray_options &search(const narc_index_query &value) noexcept { return set(&narc_ray_options::search, value); }
    ray_options &inside(narc_inside value) noexcept { return set(&narc_ray_options::inside, value); }
    ray_options &any() noexcept { return set(&narc_ray_options::any, 1u); }
    ray_options &most(size_t value) noexcept { return set(&narc_ray_options::most, value); }
    ray_options &skipped(size_t &out) noexcept { return set(&narc_ray_options::out_skipped, &out); }
    ray_options &order(uint32_t *out) noexcept { return set(&narc_ray_options::out_order, out); }
};

struct cast_options : detail::options<cast_options, narc_cast_options> {
    cast_options &target(float value) noexcept { return set(&narc_cast_options::target, value); }
    cast_options &targets(narc_float_column value) noexcept { return set(&narc_cast_options::targets, value); }
    cast_options &front_only() noexcept { return set(&narc_cast_options::front_only, 1u); }
    cast_options &parting(float value) noexcept { return set(&narc_cast_options::parting, value); }
    cast_options &tolerance(float value) noexcept { return set(&narc_cast_options::tolerance, value); }
    cast_options &skipped(size_t &out) noexcept { return set(&narc_cast_options::out_skipped, &out); }
};

struct nearest_options : detail::options<nearest_options, narc_nearest_options> {
    nearest_options &search(const narc_index_query &value) noexcept {
        return set(&narc_nearest_options::search, value);
    }
    nearest_options &distance(float value) noexcept { return set(&narc_nearest_options::distance, value); }
    nearest_options &inside() noexcept { return set(&narc_nearest_options::inside, 1u); }
    nearest_options &most(size_t value) noexcept { return set(&narc_nearest_options::most, value); }
};

// Of all these, `rows` is a span, an array or a vector of the answer's rows, and the result is the span of all that
// were asked for; those without an answer have count 0.
template <class Rows>
auto cast_rays(const narc_index *index, const narc_shapes *shapes, const narc_bodies &bodies, const narc_rays &rays,
               const narc_ray_options &options, Rows &&rows) {
    return detail::fill_rows<narc_ray_hit>(
        rows, rays.count * detail::at_least_one(options.most),
        [&](narc_ray_hit *out, size_t capacity, narc_error *error) {
            return narc_cast_rays(index, shapes, &bodies, &rays, &options, out, capacity, error);
        });
}

// Motions of bodies, and of pairs.other_bodies; NULL: they stand still.
template <class Rows>
auto cast_pairs(const narc_shapes *shapes, const narc_bodies &bodies, const narc_motions *motions,
                const narc_pairs &pairs, const narc_motions *other_motions, const narc_cast_options &options,
                Rows &&rows) {
    return detail::fill_rows<narc_impact>(
        rows, pairs.count,
        [&](narc_impact *out, size_t capacity, narc_error *error) {
            return narc_cast_pairs(shapes, &bodies, motions, &pairs, other_motions, &options, out, capacity, error);
        });
}

// Of two bodies.
inline result<narc_impact> cast_pair(const narc_shapes *shapes, const narc_body &a, const narc_motion &motion_a,
                                     const narc_body &b, const narc_motion &motion_b,
                                     const narc_cast_options &options = {}) {
    return detail::ask<narc_impact>(narc_cast_pair, shapes, &a, &motion_a, &b, &motion_b, &options);
}

template <class Rows>
auto cast_shapes(narc_index *index, const narc_shapes *shapes, const narc_bodies &bodies, const narc_bodies &movers,
                 const narc_motions &motions, const narc_index_query &search, const narc_cast_options &options,
                 Rows &&rows) {
    return detail::fill_rows<narc_impact>(
        rows, movers.count,
        [&](narc_impact *out, size_t capacity, narc_error *error) {
            return narc_cast_shapes(index, shapes, &bodies, &movers, &motions, &search, &options, out, capacity, error);
        });
}

// `body`: of each point; {}: point k and body k.
template <class Rows>
auto find_distances(const narc_shapes *shapes, const narc_bodies &bodies, const narc_points &at, narc_index_column body,
                    Rows &&rows, const narc_workers *workers = nullptr) {
    return detail::fill_rows<narc_distance>(
        rows, at.count,
        [&](narc_distance *out, size_t, narc_error *error) {
            return narc_find_distances(shapes, &bodies, &at, &body, workers, out, error);
        });
}

// Whether each ray hits one body, and where; each point one body's inside, a bit. `body` as above.
template <class Rows>
auto cast_ray_pairs(const narc_shapes *shapes, const narc_bodies &bodies, const narc_rays &rays, narc_index_column body,
                    const narc_ray_options &options, Rows &&rows) {
    return detail::fill_rows<narc_ray_hit>(
        rows, rays.count,
        [&](narc_ray_hit *out, size_t capacity, narc_error *error) {
            return narc_cast_ray_pairs(shapes, &bodies, &rays, body.base ? &body : nullptr, &options, out, capacity,
                                       error);
        });
}
template <class Bits>
result<void> find_inside(const narc_shapes *shapes, const narc_bodies &bodies, const narc_points &at,
                         narc_index_column body, Bits &&bits, const narc_workers *workers = nullptr) {
    const size_t words = NARC_BIT_WORDS(at.count);
    detail::make_room(bits, words);
    const span<uint64_t> room(bits);
    if (room.size() < words)
        return result<void>(detail::too_short(words));
    return detail::ask<void>(narc_find_inside, shapes, &bodies, &at, body.base ? &body : nullptr, workers, room.data());
}

template <class Rows>
auto find_nearest(const narc_index *index, const narc_shapes *shapes, const narc_bodies &bodies, const narc_points &at,
                  const narc_nearest_options &options, Rows &&rows) {
    return detail::fill_rows<narc_distance>(
        rows, at.count * detail::at_least_one(options.most),
        [&](narc_distance *out, size_t capacity, narc_error *error) {
            return narc_find_nearest(index, shapes, &bodies, &at, &options, out, capacity, error);
        });
}

// ------------------------------------------------------------------------------------------------ the rest

inline result<void> compute_poses(span<const float> angles, span<float> cosines, span<float> sines) {
    if (cosines.size() < angles.size() || sines.size() < angles.size())
        return result<void>(detail::too_short(angles.size()));
    return detail::ask<void>(narc_compute_poses, angles.data(), angles.size(), cosines.data(), sines.data());
}

// Where the parts of bodies are; `rows` is a span, an array or a vector of narc_body, which bodies_of() takes.
template <class Rows>
auto place_parts(const narc_bodies &owners, const narc_bodies &parts, narc_index_column owner, Rows &&rows,
                 const narc_workers *workers = nullptr) {
    return detail::fill_rows<narc_body>(
        rows, parts.count,
        [&](narc_body *out, size_t, narc_error *error) {
            return narc_place_parts(&owners, &parts, &owner, workers, out, error);
        });
}

// The bodies of pairs that the library owns, of all, or of a selection: as many of each as the result says.
inline result<size_t> copy_pairs(const narc_pairs &pairs, span<uint32_t> a, span<uint32_t> b,
                                 span<const uint32_t> selection = {}) {
    const size_t count = selection.data() ? selection.size() : pairs.count;
    if (a.size() < count || b.size() < count)
        return result<size_t>(detail::too_short(count));
    const auto copied = detail::ask<void>(narc_copy_pairs, &pairs, selection.data(), count, a.data(), b.data(), 0);
    return copied ? result<size_t>(count) : result<size_t>(copied.error());
}

// What there is: versions, instruction sets, kernels, features; NULL behind the last one.
inline const char *version() noexcept { return narc_version(); }
inline const char *status_name(narc_status status) noexcept { return narc_status_name(status); }
inline result<void> set_isa(const char *name) { return detail::ask<void>(narc_set_isa, name); }
inline const char *get_isa() noexcept { return narc_get_isa(); }
inline const char *isa_name(size_t index) noexcept { return narc_isa_name(index); }
inline bool isa_supported(const char *name) noexcept { return narc_isa_supported(name); }
inline const char *kernel_name(size_t index) noexcept { return narc_kernel_name(index); }
inline const char *cpu_feature(size_t index) noexcept { return narc_cpu_feature(index); }

} // namespace narc

#endif
