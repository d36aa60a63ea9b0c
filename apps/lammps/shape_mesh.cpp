/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * shape_mesh.cpp - forms as Wavefront OBJ files, for programs that draw a mesh in the place of each particle.
 */
#include <cstdio>
#include <stdexcept>

#include "shape_file.h"

namespace narc_lammps {

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
        narc_point points[1024]; /* an arc of a whole turn has some 70 at most */
        size_t count = 0;
        narc_flatten_arcs(outline.arcs.data(), outline.arcs.size(), true, nullptr, 1e-3 * form.reach, points, 1024,
                          &count, nullptr);
        for (size_t i = 0; i < count; i++)
            std::fprintf(file, "v %.9g %.9g 0\n", points[i].x / form.reach, points[i].y / form.reach);
        std::fprintf(file, "f");
        for (size_t i = 0; i < count; i++)
            std::fprintf(file, " %d", ++corners);
        std::fprintf(file, "\n");
    }
    const bool failed = std::ferror(file) != 0;
    if (std::fclose(file) != 0 || failed || std::rename(part.c_str(), path.c_str()) != 0) {
        std::remove(part.c_str());
        throw std::runtime_error(path + ": cannot be written");
    }
}

} // namespace narc_lammps
