/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * shape_file.cpp - reads a shapes file (docs/formats.md). Strict: an unknown or missing key is an error.
 */
#include "shape_file.h"

#include <cmath>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <set>
#include <stdexcept>

#include <cjson/cJSON.h>

namespace narc_lammps {
namespace {

using Keys = std::initializer_list<const char *>;

/* What is read now, for messages: "shapes.json: shape 'lens', arc 2". */
class Reader {
  public:
    explicit Reader(std::string where) : place(std::move(where)) {}
    Reader in(const std::string &element) const { return Reader(place + element); }

    [[noreturn]] void fail(const std::string &message) const { throw std::runtime_error(place + ": " + message); }

    [[noreturn]] void fail(const cJSON *item, const std::string &message) const {
        const std::unique_ptr<char, void (*)(void *)> text(cJSON_PrintUnformatted(item), cJSON_free);
        fail(message + " '" + std::string(text ? text.get() : "").substr(0, 60) + "'");
    }

    void check_object(const cJSON *object, const std::string &what, Keys keys) const {
        if (!cJSON_IsObject(object))
            fail(object, what + " is not an object");
        std::set<std::string> seen;
        for (const cJSON *item = object->child; item; item = item->next) {
            bool known = false;
            for (const char *key : keys)
                known = known || !std::strcmp(key, item->string);
            if (!known)
                fail("unknown key '" + std::string(item->string).substr(0, 60) + "'");
            if (!seen.insert(item->string).second)
                fail("key '" + std::string(item->string) + "' is there twice");
        }
    }

    double number(const cJSON *item, const std::string &what) const {
        if (!item)
            fail(what + " is missing");
        if (!cJSON_IsNumber(item) || !std::isfinite(item->valuedouble))
            fail(item, what + " is not a finite number");
        return item->valuedouble;
    }

    double get(const cJSON *object, const char *key) const {
        return number(cJSON_GetObjectItemCaseSensitive(object, key), key);
    }

    double get_or_zero(const cJSON *object, const char *key) const {
        const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
        return item ? number(item, key) : 0;
    }

    narc_point point(const cJSON *item, const std::string &what) const {
        if (!item)
            fail(what + " is missing");
        if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 2)
            fail(item, what + " is not a point [x, y]");
        return {number(item->child, what), number(item->child->next, what)};
    }

    /* The elements of a list of at most NARC_MAX_ARCS. */
    std::vector<const cJSON *> list(const cJSON *item, const std::string &what) const {
        if (!cJSON_IsArray(item))
            fail(item, what + " is not a list");
        std::vector<const cJSON *> elements;
        for (const cJSON *element = item->child; element; element = element->next)
            elements.push_back(element);
        if (elements.size() > NARC_MAX_ARCS)
            fail(what + " has " + std::to_string(elements.size()) + " elements, more than " +
                 std::to_string(NARC_MAX_ARCS));
        return elements;
    }

    std::vector<narc_point> points(const cJSON *item, const std::string &what) const {
        std::vector<narc_point> all;
        for (const cJSON *element : list(item, what))
            all.push_back(point(element, what + " " + std::to_string(all.size())));
        return all;
    }

  private:
    std::string place;
};

/* What a builder needs besides its own value. */
struct Build {
    const Reader &at;
    double radius; /* the key `radius` beside it, 0 if left out */
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_error error;
};

narc_status build_arcs(Build &to, const cJSON *item) {
    for (const cJSON *element : to.at.list(item, "arcs")) {
        const Reader arc_at = to.at.in(", arc " + std::to_string(to.count));
        arc_at.check_object(element, "it", {"center", "radius", "start", "end"});
        const narc_point center = arc_at.point(cJSON_GetObjectItemCaseSensitive(element, "center"), "center");
        to.arcs[to.count++] = {center.x, center.y, arc_at.get(element, "radius"), arc_at.get(element, "start"),
                               arc_at.get(element, "end")};
    }
    return narc_validate_arcs(to.arcs, to.count, &to.error);
}

narc_status build_points(Build &to, const cJSON *item) {
    const std::vector<narc_point> points = to.at.points(item, "point");
    return narc_build_points(points.data(), points.size(), to.radius, to.arcs, &to.count, &to.error);
}

narc_status build_polygon(Build &to, const cJSON *item) {
    const std::vector<narc_point> points = to.at.points(item, "point");
    return narc_build_polygon(points.data(), points.size(), to.radius, to.arcs, &to.count, &to.error);
}

narc_status build_circle(Build &to, const cJSON *item) {
    return narc_build_circle(to.at.number(item, "circle"), to.arcs, &to.count, &to.error);
}

narc_status build_capsule(Build &to, const cJSON *item) {
    to.at.check_object(item, "capsule", {"length", "radius"});
    return narc_build_capsule(to.at.get(item, "length"), to.at.get(item, "radius"), to.arcs, &to.count, &to.error);
}

narc_status build_box(Build &to, const cJSON *item) {
    to.at.check_object(item, "box", {"width", "height", "radius"});
    return narc_build_box(to.at.get(item, "width"), to.at.get(item, "height"), to.at.get_or_zero(item, "radius"),
                          to.arcs, &to.count, &to.error);
}

narc_status build_four_arc(Build &to, const cJSON *item) {
    to.at.check_object(item, "four_arc", {"radius_low", "radius_high", "distance", "radius_left", "radius_right"});
    const narc_four_arc form = {to.at.get(item, "radius_low"), to.at.get(item, "radius_high"),
                                to.at.get(item, "distance"), to.at.get_or_zero(item, "radius_left"),
                                to.at.get_or_zero(item, "radius_right")};
    return narc_build_four_arc(form, to.arcs, &to.count, &to.error);
}

struct Kind {
    const char *key;
    bool takes_radius;
    narc_status (*build)(Build &to, const cJSON *item);
};
const Kind kinds[] = {
    {"arcs", false, build_arcs},         {"points", true, build_points},    {"polygon", true, build_polygon},
    {"circle", false, build_circle},     {"capsule", false, build_capsule}, {"box", false, build_box},
    {"four_arc", false, build_four_arc},
};

const Kind &find_kind(const Reader &at, const cJSON *object) {
    const Kind *found = nullptr;
    for (const Kind &kind : kinds) {
        if (!cJSON_GetObjectItemCaseSensitive(object, kind.key))
            continue;
        if (found)
            at.fail(std::string("it has both '") + found->key + "' and '" + kind.key + "'");
        found = &kind;
    }
    if (!found)
        at.fail("none of arcs, points, polygon, circle, capsule, box and four_arc is there");
    return *found;
}

Form read_form(const std::string &path, const cJSON *object, unsigned index) {
    const Reader unnamed(path + ": shape " + std::to_string(index));
    unnamed.check_object(
        object, "it",
        {"name", "origin", "radius", "arcs", "points", "polygon", "circle", "capsule", "box", "four_arc"});
    const cJSON *name = cJSON_GetObjectItemCaseSensitive(object, "name");
    if (!name || !cJSON_IsString(name) || !name->valuestring[0])
        unnamed.fail("name is missing or not a string");
    const Reader at(path + ": shape '" + std::string(name->valuestring).substr(0, 60) + "'");
    const Kind &kind = find_kind(at, object);
    if (!kind.takes_radius && cJSON_GetObjectItemCaseSensitive(object, "radius"))
        at.fail(std::string("'") + kind.key + "' takes no 'radius' beside it");
    Build to = {at, at.get_or_zero(object, "radius"), {}, 0, {}};
    if (kind.build(to, cJSON_GetObjectItemCaseSensitive(object, kind.key)) != NARC_OK)
        at.fail(to.error.message);
    try {
        Form form = make_form(name->valuestring, std::vector<narc_arc>(to.arcs, to.arcs + to.count));
        form.index = index;
        return form;
    } catch (const std::runtime_error &error) {
        at.fail(error.what());
    }
}

/* Distance of the furthest point of an outline from the origin. Along an arc the distance rises towards the direction
 * of the centre, so it is largest there, if the arc has that normal, or else at an end. */
double find_reach(const std::vector<narc_arc> &arcs) {
    const double turn = 2 * std::acos(-1.0);
    double reach = 0;
    for (const narc_arc &arc : arcs) {
        const double out = std::atan2(arc.center_y, arc.center_x);
        const double after_start = std::fmod(std::fmod(out - arc.start, turn) + turn, turn);
        const double sweep = arc.end > arc.start ? arc.end - arc.start : arc.end - arc.start + turn;
        if (after_start <= sweep)
            reach = std::fmax(reach, std::hypot(arc.center_x, arc.center_y) + arc.radius);
        for (const double angle : {arc.start, arc.end})
            reach = std::fmax(reach, std::hypot(arc.center_x + arc.radius * std::cos(angle),
                                                arc.center_y + arc.radius * std::sin(angle)));
    }
    return reach;
}

} // namespace

Form make_form(const std::string &name, const std::vector<narc_arc> &arcs) {
    Form form = {name, arcs, 0, 0, 0, 0};
    narc_error error;
    if (narc_center_arcs(arcs.data(), arcs.size(), form.arcs.data(), nullptr, &error) != NARC_OK)
        throw std::runtime_error(error.message);
    narc_mass mass;
    if (!narc_compute_mass(form.arcs.data(), form.arcs.size(), &mass) || !(mass.area > 0))
        throw std::runtime_error("it has no area");
    form.area = mass.area;
    form.reach = find_reach(form.arcs);
    form.inertia_ratio = mass.second_moment / (mass.area * form.reach * form.reach);
    return form;
}

std::vector<Form> parse_forms(const std::string &path, const std::string &text) {
    const Reader at(path);
    const char *end = nullptr;
    const std::unique_ptr<cJSON, void (*)(cJSON *)> root(cJSON_ParseWithOpts(text.c_str(), &end, 1), cJSON_Delete);
    if (!root) {
        size_t line = 1;
        for (const char *c = text.c_str(); end && c < end; c++)
            line += *c == '\n';
        throw std::runtime_error(path + ":" + std::to_string(line) + ": not JSON");
    }
    at.check_object(root.get(), "the file's value", {"shapes"});
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(root.get(), "shapes");
    if (!list || !cJSON_IsArray(list) || !list->child)
        at.fail("shapes is missing, not a list, or empty");
    std::vector<Form> forms;
    std::set<std::string> names;
    for (const cJSON *item = list->child; item; item = item->next) {
        forms.push_back(read_form(path, item, static_cast<unsigned>(forms.size())));
        if (!names.insert(forms.back().name).second)
            at.fail("shape " + std::to_string(forms.size() - 1) + ": another shape has that name '" +
                    forms.back().name + "'");
    }
    return forms;
}

} // namespace narc_lammps
