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
    narc_shape_list *list;
    narc_error error;
    if (narc_read_shapes(text.data(), text.size(), nullptr, nullptr, &list, &error) != NARC_OK)
        throw std::runtime_error(path + ": " + error.message);
    const std::unique_ptr<narc_shape_list, void (*)(narc_shape_list *)> owner(list, narc_destroy_shape_list);
    std::vector<Form> forms;
    for (size_t k = 0; k < list->count; k++) {
        const narc_named_shape &shape = list->items[k];
        try {
            forms.push_back(make_form(shape.name, std::vector<narc_arc>(shape.arcs, shape.arcs + shape.arc_count)));
        } catch (const std::runtime_error &wrong) {
            throw std::runtime_error(path + ": shape '" + shape.name + "': " + wrong.what());
        }
        forms.back().index = static_cast<unsigned>(k);
    }
    return forms;
}

} // namespace narc_lammps
