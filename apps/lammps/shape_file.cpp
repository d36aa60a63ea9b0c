/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * shape_file.cpp - forms of grains from a shapes file (docs/formats.md).
 */
#include "shape_file.h"

#include <cmath>
#include <memory>
#include <stdexcept>

#include <narc_files.h>

namespace narc_lammps {
namespace {

/* Distance of the furthest point of an outline from the origin. There the normal points away from the origin, so the
 * arc's centre is on the same line: the point is the support in that direction, or in the opposite one if the arc is
 * flatter. */
double find_reach(const std::vector<narc_arc> &arcs) {
    double reach = 0;
    for (const narc_arc &arc : arcs)
        for (const double sign : {1.0, -1.0}) {
            const bool central = arc.center_x == 0 && arc.center_y == 0;
            narc_point p = {0, 0};
            narc_find_support(arcs.data(), arcs.size(), central ? 1 : sign * arc.center_x, sign * arc.center_y, &p,
                              nullptr);
            reach = std::fmax(reach, std::hypot(p.x, p.y));
        }
    return reach;
}

/* Throws std::runtime_error with the library's message. */
Form make_form(const std::string &name, const std::vector<narc_arc> &arcs) {
    Form form = {name, arcs, std::vector<touch_side>(arcs.size()), 0, 0, false, 0};
    narc_error error;
    if (narc_center_arcs(arcs.data(), arcs.size(), form.arcs.data(), nullptr, &error) != NARC_OK)
        throw std::runtime_error(error.message);
    make_touch_sides(form.arcs.data(), form.arcs.size(), form.sides.data());
    narc_mass mass;
    if (!narc_compute_mass(form.arcs.data(), form.arcs.size(), &mass) || !(mass.area > 0))
        throw std::runtime_error("it has no area");
    form.area = mass.area;
    form.reach = find_reach(form.arcs);
    form.is_disc = form.sides.size() == 1 && form.sides[0].x == 0 && form.sides[0].y == 0;
    form.inertia_ratio = mass.second_moment / (mass.area * form.reach * form.reach);
    return form;
}

} // namespace

std::vector<Form> parse_forms(const std::string &path, const std::string &text) {
    narc_shape_list *list;
    narc_error error;
    if (narc_read_shapes(text.data(), text.size(), nullptr, nullptr, &list, &error) != NARC_OK)
        throw std::runtime_error(path + ": " + error.message);
    const std::unique_ptr<narc_shape_list, void (*)(narc_shape_list *)> owner(list, narc_destroy_shape_list);
    std::vector<Form> forms;
    for (size_t k = 0; k < list->count; k++) {
        const narc_named_shape &shape = list->items[k];
        try {
            if (shape.form != NARC_FORM_SHAPE)
                throw std::runtime_error("is a chain, which no grain can be");
            forms.push_back(make_form(shape.name, std::vector<narc_arc>(shape.arcs, shape.arcs + shape.arc_count)));
        } catch (const std::runtime_error &wrong) {
            throw std::runtime_error(path + ": shape '" + shape.name + "': " + wrong.what());
        }
    }
    return forms;
}

} // namespace narc_lammps
