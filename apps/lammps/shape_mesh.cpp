/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * shape_mesh.cpp - forms as Wavefront OBJ files, for programs that draw a mesh in the place of each particle.
 */
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "shape_file.h"

namespace narc_lammps {
namespace {

/* Of an arc's sweep in one side of the polygon that is drawn: a chord is then 0.1 % of the radius off the arc. */
constexpr double largest_sweep = 0.09;

/* The points of an arc; how many they are. */
int write_arc(const narc_arc &arc, double reach, FILE *file) {
    const double turn = 2 * std::acos(-1.0);
    const double sweep = arc.end > arc.start ? arc.end - arc.start : arc.end - arc.start + turn;
    const int sides = arc.radius > 0 ? static_cast<int>(std::ceil(sweep / largest_sweep)) : 0;
    for (int k = 0; k <= sides; k++) {
        const double angle = arc.start + (sides ? sweep * k / sides : 0);
        std::fprintf(file, "v %.9g %.9g 0\n", (arc.center_x + arc.radius * std::cos(angle)) / reach,
                     (arc.center_y + arc.radius * std::sin(angle)) / reach);
    }
    return sides + 1;
}

} // namespace

void write_mesh(const Form &form, const std::string &path) {
    if (form.name.find('/') != std::string::npos)
        throw std::runtime_error(path + ": the shape's name has a / and cannot be a file's");
    const std::string part = path + ".part";
    FILE *file = std::fopen(part.c_str(), "w");
    if (!file)
        throw std::runtime_error(path + ": cannot be written");
    std::fprintf(file, "# %s, reaching 1 from its centroid\n", form.name.c_str());
    int corners = 0;
    for (const Part &outline : form.parts) {
        const int before = corners;
        for (const narc_arc &arc : outline.arcs)
            corners += write_arc(arc, form.reach, file);
        std::fprintf(file, "f");
        for (int corner = before + 1; corner <= corners; corner++)
            std::fprintf(file, " %d", corner);
        std::fprintf(file, "\n");
    }
    const bool failed = std::ferror(file) != 0;
    if (std::fclose(file) != 0 || failed || std::rename(part.c_str(), path.c_str()) != 0) {
        std::remove(part.c_str());
        throw std::runtime_error(path + ": cannot be written");
    }
}

} // namespace narc_lammps
