/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * shape_file.cpp - forms of grains from a shapes file (docs/formats.md).
 */
#include "shape_file.h"

#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include <narc_chains.h>
#include <narc_files.h>

namespace narc_lammps {
namespace {

/* Of parts in one frame. Throws std::runtime_error with the library's message. */
Form make_form(const std::string &name, const std::vector<narc_arc> &arcs, const std::vector<size_t> &counts) {
    Form form = {name, {}, 0, 0, false, 0};
    narc_error error;
    narc_mass mass;
    if (narc_compute_union_mass(arcs.data(), counts.data(), counts.size(), nullptr, &mass, &error) != NARC_OK)
        throw std::runtime_error(error.message);
    if (counts.size() == 1) /* simpler sums, of fewer roundings */
        narc_compute_mass(arcs.data(), arcs.size(), &mass);
    if (!(mass.area > 0))
        throw std::runtime_error("it has no area");
    const narc_arc *next = arcs.data();
    for (const size_t count : counts) {
        Part part = {std::vector<narc_arc>(count), std::vector<touch_side>(count)};
        if (narc_move_arcs(next, count, -mass.centroid_x, -mass.centroid_y, 0, 1, part.arcs.data(), &error) != NARC_OK)
            throw std::runtime_error(error.message);
        make_touch_sides(part.arcs.data(), count, part.sides.data());
        form.reach = std::fmax(form.reach, find_outline_reach(part.arcs.data(), count));
        form.parts.push_back(part);
        next += count;
    }
    const touch_side &side = form.parts[0].sides[0];
    form.is_disc = arcs.size() == 1 && side.x == 0 && side.y == 0;
    form.area = mass.area;
    form.inertia_ratio = mass.second_moment / (mass.area * form.reach * form.reach);
    return form;
}

/* NAME/1, NAME/2 ... where their origins tell. */
Form make_compound(const narc_shape_list *list, const std::string &name) {
    std::vector<narc_arc> arcs;
    std::vector<size_t> counts;
    for (size_t k;
         (k = narc_find_named_shape(list, (name + "/" + std::to_string(counts.size() + 1)).c_str())) < list->count;) {
        const narc_named_shape &part = list->items[k];
        narc_arc moved[NARC_MAX_ARCS];
        narc_error error;
        if (narc_move_arcs(part.arcs, part.arc_count, part.origin.x, part.origin.y, 0, 1, moved, &error) != NARC_OK)
            throw std::runtime_error(error.message);
        arcs.insert(arcs.end(), moved, moved + part.arc_count);
        counts.push_back(part.arc_count);
    }
    return make_form(name, arcs, counts);
}

} // namespace

std::vector<Form> parse_forms(const std::string &path, const std::string &text) {
    narc_shape_list *list;
    narc_error error;
    if (narc_read_shapes(text.data(), text.size(), nullptr, nullptr, &list, &error) != NARC_OK)
        throw std::runtime_error(path + ": " + error.message);
    const std::unique_ptr<narc_shape_list, void (*)(narc_shape_list *)> owner(list, narc_destroy_shape_list);
    std::vector<Form> forms, compounds;
    for (size_t k = 0; k < list->count; k++) {
        const narc_named_shape &shape = list->items[k];
        const std::string name = shape.name;
        try {
            if (shape.form != NARC_FORM_SHAPE)
                throw std::runtime_error("is a chain, which no grain can be");
            forms.push_back(
                make_form(name, std::vector<narc_arc>(shape.arcs, shape.arcs + shape.arc_count), {shape.arc_count}));
            const std::string whole = name.substr(0, name.rfind('/'));
            if (name == whole + "/1" && narc_find_named_shape(list, whole.c_str()) == list->count)
                compounds.push_back(make_compound(list, whole));
        } catch (const std::runtime_error &wrong) {
            throw std::runtime_error(path + ": shape '" + name + "': " + wrong.what());
        }
    }
    forms.insert(forms.end(), compounds.begin(), compounds.end());
    return forms;
}

uint32_t store_parts(const std::vector<Form> &forms, narc_shapes **out_store) {
    uint32_t next = 0; /* the parts' own indices, also of equal ones */
    if (narc_create_shapes(nullptr, out_store) != NARC_OK)
        throw std::runtime_error("not enough memory for shapes");
    for (const Form &form : forms) {
        for (const Part &part : form.parts) {
            narc_error failure;
            if (narc_add_shape_at(*out_store, next++, part.arcs.data(), part.arcs.size(), &failure) != NARC_OK)
                throw std::runtime_error("shape '" + form.name + "': " + failure.message);
        }
    }
    return next;
}

std::vector<ChainPiece> read_chain(const std::string &path, const std::string &name, narc_shapes *store,
                                   double &reach) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file)
        throw std::runtime_error(path + ": cannot be read");
    narc_shape_list *list;
    narc_error error;
    if (narc_read_shapes(text.str().data(), text.str().size(), nullptr, nullptr, &list, &error) != NARC_OK)
        throw std::runtime_error(path + ": " + error.message);
    const std::unique_ptr<narc_shape_list, void (*)(narc_shape_list *)> owner(list, narc_destroy_shape_list);
    const size_t k = narc_find_named_shape(list, name.c_str());
    if (k == list->count || list->items[k].form == NARC_FORM_SHAPE)
        throw std::runtime_error(path + ": it has no chain '" + name + "'");
    const narc_named_shape &chain = list->items[k];
    narc_chain_options options = {};
    options.closed = chain.form == NARC_FORM_CLOSED_CHAIN;
    size_t count = 0;
    narc_status status = narc_add_chain(store, chain.arcs, chain.arc_count, &options, nullptr, 0, &count, &error);
    std::vector<narc_chain_entry> entries(count);
    if (status == NARC_ERROR_CAPACITY)
        status = narc_add_chain(store, chain.arcs, chain.arc_count, &options, entries.data(), count, &count, &error);
    if (status != NARC_OK)
        throw std::runtime_error(path + ": chain '" + name + "': " + error.message);
    std::vector<ChainPiece> pieces;
    for (const narc_chain_entry &e : entries) {
        narc_arc arcs[NARC_MAX_ARCS];
        ChainPiece piece = {e.shape, e.x, e.y, std::vector<touch_side>(NARC_MAX_ARCS)};
        const size_t sides = narc_get_arcs(store, e.shape, arcs);
        make_touch_sides(arcs, sides, piece.sides.data());
        piece.sides.resize(sides);
        if (sides == 1) { /* the end of a concave arc */
            piece.sides.resize(2);
            make_touch_sides(arcs, 1, piece.sides.data());
        }
        for (touch_side &side : piece.sides) {
            side.x += e.x;
            side.y += e.y;
        }
        pieces.push_back(piece);
    }
    reach = 0;
    for (size_t i = 0; i < chain.arc_count; i++)
        reach = std::fmax(reach,
                          std::hypot(chain.arcs[i].center_x, chain.arcs[i].center_y) + std::fabs(chain.arcs[i].radius));
    return pieces;
}

} // namespace narc_lammps
