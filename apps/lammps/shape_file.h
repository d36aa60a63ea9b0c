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

/* A convex outline. */
struct Part {
    std::vector<narc_arc> arcs;
    std::vector<touch_side> sides;
};

/* A form of grains: what one part or several cover, its centroid at the origin. */
struct Form {
    std::string name;
    std::vector<Part> parts;
    double area;
    double reach; /* distance of the furthest point from the centroid: a grain's radius is `reach` times its size */
    bool is_disc; /* about the centroid; `reach` is its radius */
    double inertia_ratio; /* moment of inertia of unit mass and unit radius: I = inertia_ratio * mass * radius^2 */
};

/* The forms of a shapes file, in its order, and behind them those of parts: NAME/1, NAME/2 ... are NAME, if nothing
 * else is. `path` is for messages only. Throws std::runtime_error, whose message names file, line, shape and arc. */
std::vector<Form> parse_forms(const std::string &path, const std::string &text);

/* Stores the parts of all forms, one after the other; how many they are. Throws std::runtime_error. */
uint32_t store_parts(const std::vector<Form> &forms, narc_shapes **out_store);

/* A piece of a chain: its shape in a store, where its origin is in the chain, and its sides there. */
struct ChainPiece {
    uint32_t shape;
    double x, y;
    std::vector<touch_side> sides;
};

/* Reads a chain of a shapes file; `reach` is how far it goes from its origin. Throws std::runtime_error. */
std::vector<ChainPiece> read_chain(const std::string &path, const std::string &name, narc_shapes *store, double &reach);

/* Writes a form as a Wavefront OBJ file: its parts as polygons, scaled so that it reaches 1 from the centroid. A
 * particle's mesh is this one times its radius. Throws std::runtime_error. */
void write_mesh(const Form &form, const std::string &path);

} // namespace narc_lammps

#endif
