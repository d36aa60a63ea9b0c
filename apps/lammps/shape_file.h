/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * shape_file.h - narc's shapes file as forms of grains: centred, with their integrals and the radius around them.
 */
#ifndef NARC_LAMMPS_SHAPE_FILE_H
#define NARC_LAMMPS_SHAPE_FILE_H

#include <string>
#include <vector>

#include <narc.h>

#include "touch.h"

namespace narc_lammps {

/* A form of grains, its centroid at the origin. */
struct Form {
    std::string name;
    std::vector<narc_arc> arcs;
    std::vector<touch_side> sides;
    double area;
    double reach; /* distance of the furthest point from the centroid: a grain's radius is `reach` times its size */
    bool is_disc; /* about the centroid; `reach` is its radius */
    double inertia_ratio; /* moment of inertia of unit mass and unit radius: I = inertia_ratio * mass * radius^2 */
};

/* The forms of a shapes file, in its order. `path` is for messages only. Throws std::runtime_error, whose message names
 * file, line, shape and arc. */
std::vector<Form> parse_forms(const std::string &path, const std::string &text);

/* Writes a form as a Wavefront OBJ file: its outline as one polygon, scaled so that it reaches 1 from the centroid. A
 * particle's mesh is this one times its radius. Throws std::runtime_error. */
void write_mesh(const Form &form, const std::string &path);

} // namespace narc_lammps

#endif
