/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * fix_narc_shapes.cpp - forms of grains, and the memory of their contacts between two neighbour lists.
 */
#include "fix_narc_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "atom.h"
#include "comm.h"
#include "compute.h"
#include "domain.h"
#include "error.h"
#include "modify.h"
#include "pair_narc.h"
#include "update.h"

using namespace LAMMPS_NS;
using narc_lammps::Form;

namespace {

constexpr int memory_size = 7; /* doubles of a packed memory */

/* The text of a file, which rank 0 reads; false if it cannot. */
bool read_file(MPI_Comm world, const char *path, std::string &text) {
    int rank;
    MPI_Comm_rank(world, &rank);
    long long size = -1;
    if (rank == 0) {
        std::ifstream file(path, std::ios::binary);
        std::stringstream bytes;
        if (file && bytes << file.rdbuf()) {
            text = bytes.str();
            size = static_cast<long long>(text.size());
        }
    }
    MPI_Bcast(&size, 1, MPI_LONG_LONG, 0, world);
    if (size < 0 || size > INT_MAX)
        return false;
    text.resize(static_cast<size_t>(size));
    MPI_Bcast(&text[0], static_cast<int>(size), MPI_CHAR, 0, world);
    return true;
}

/* Newer versions of LAMMPS have another name for it. */
template <class Comm> auto reverse_variable(Comm *comm, Fix *fix, int) -> decltype(comm->reverse_comm_variable(fix)) {
    comm->reverse_comm_variable(fix);
}
template <class Comm> void reverse_variable(Comm *comm, Fix *fix, long) { comm->reverse_comm_fix_variable(fix); }

} // namespace

/* ---------------------------------------------------------------------------- the command */

FixNarcShapes::FixNarcShapes(LAMMPS *lammps, int count, char **arguments) : Fix(lammps, count, arguments) {
    if (count < 5)
        error->all(FLERR,
                   std::string("fix narc/shapes: FILE NAME ... [density RHO] [shape i_PROPERTY] [mesh PREFIX] is "
                               "wanted"));
    if (!atom->radius_flag || !atom->rmass_flag || !atom->omega_flag || !atom->torque_flag || !atom->mu_flag)
        error->all(FLERR, std::string("fix narc/shapes wants atom_style hybrid sphere dipole"));
    int names = 0;
    while (4 + names < count && std::strcmp(arguments[4 + names], "density") != 0 &&
           std::strcmp(arguments[4 + names], "shape") != 0 && std::strcmp(arguments[4 + names], "mesh") != 0)
        names++;
    for (int i = 4 + names; i < count; i += 2) {
        if (i + 1 >= count)
            error->all(FLERR, std::string("fix narc/shapes: a value is missing after ") + arguments[i]);
        if (!std::strcmp(arguments[i], "density")) {
            density = utils::numeric(FLERR, arguments[i + 1], false, lmp);
            if (!(density > 0))
                error->all(FLERR, std::string("fix narc/shapes: density is not positive: ") + arguments[i + 1]);
        } else if (!std::strcmp(arguments[i], "shape") && !std::strncmp(arguments[i + 1], "i_", 2)) {
            property = arguments[i + 1] + 2;
        } else if (!std::strcmp(arguments[i], "mesh")) {
            mesh = arguments[i + 1];
        } else {
            error->all(FLERR, std::string("fix narc/shapes: unknown keyword or value: ") + arguments[i] + " " +
                                  arguments[i + 1]);
        }
    }
    read_forms(arguments[3], names, arguments + 4);
    if (property.empty() && names < atom->ntypes)
        error->all(FLERR, "fix narc/shapes: there are " + std::to_string(atom->ntypes) + " atom types, but " +
                              std::to_string(names) + " names of shapes");

    restart_global = 1; /* so that write_restart() is called before atoms are packed */
    restart_peratom = 1;
    create_attribute = 1;
    maxexchange_dynamic = 1;
    maxexchange = 1;
    grow_arrays(atom->nmax);
    atom->add_callback(Atom::GROW);
    atom->add_callback(Atom::RESTART);
}

FixNarcShapes::~FixNarcShapes() {
    atom->delete_callback(id, Atom::GROW);
    atom->delete_callback(id, Atom::RESTART);
    narc_destroy_shapes(store);
}

void FixNarcShapes::read_forms(const char *path, int count, char **names) {
    std::string text;
    if (!read_file(world, path, text))
        error->all(FLERR, std::string("fix narc/shapes: ") + path + ": cannot be read");
    std::string problem;
    try {
        const std::vector<Form> all = narc_lammps::parse_forms(path, text);
        for (int i = 0; i < count; i++) {
            const auto found =
                std::find_if(all.begin(), all.end(), [&](const Form &form) { return form.name == names[i]; });
            if (found == all.end())
                throw std::runtime_error(std::string(path) + ": it has no shape '" + names[i] + "'");
            first_part.push_back(i ? first_part.back() + static_cast<uint32_t>(forms.back().parts.size()) : 0);
            forms.push_back(*found);
            most_parts = std::max(most_parts, found->parts.size());
            if (!mesh.empty() && comm->me == 0)
                narc_lammps::write_mesh(*found, mesh + "." + found->name + ".obj");
        }
        narc_lammps::store_parts(forms, &store);
    } catch (const std::runtime_error &failure) {
        problem = failure.what();
    }
    int failed = !problem.empty(), any_failed; /* meshes are rank 0's */
    MPI_Allreduce(&failed, &any_failed, 1, MPI_INT, MPI_MAX, world);
    if (any_failed)
        error->all(FLERR, "fix narc/shapes: " + problem);
}

FixNarcShapes *FixNarcShapes::find(LAMMPS *lammps, const char *who) {
    Modify *modify = lammps->modify;
    for (int i = 0; i < modify->nfix; i++)
        if (!std::strcmp(modify->fix[i]->style, "narc/shapes"))
            return static_cast<FixNarcShapes *>(modify->fix[i]);
    lammps->error->all(FLERR, std::string(who) + " wants a fix narc/shapes before it");
}

int FixNarcShapes::setmask() { return FixConst::PRE_EXCHANGE | FixConst::POST_NEIGHBOR | FixConst::POST_RUN; }

/* What would run without an error, and not do what it says. */
void FixNarcShapes::refuse_what_does_not_fit() {
    if (update->whichflag == 2)
        error->all(FLERR, std::string("fix narc/shapes: grains cannot be minimized: rotations are no variables of it"));
    if (!std::strncmp(update->integrate_style, "respa", 5))
        error->all(FLERR, std::string("fix narc/shapes: run_style respa is not known, use verlet"));
    for (int i = 0; i < modify->ncompute; i++) {
        const std::string kind = modify->compute[i]->style;
        if (kind == "erotate/sphere" || kind == "temp/sphere")
            error->all(FLERR, "fix narc/shapes: compute " + kind +
                                  " has the moments of inertia of spheres, take the scalar of fix narc/nve");
    }
    for (int i = 0; i < modify->nfix; i++) {
        const Fix *fix = modify->fix[i];
        if (!std::strncmp(fix->style, "wall/gran", 9))
            error->all(FLERR, std::string("fix narc/shapes: fix ") + fix->style +
                                  " takes grains for discs, use fix wall/narc");
        if (fix->time_integrate && std::strcmp(fix->style, "narc/nve") != 0 && std::strcmp(fix->style, "move") != 0)
            error->all(FLERR, std::string("fix narc/shapes: fix ") + fix->id + " of style " + fix->style +
                                  " moves grains and does not turn them, use fix narc/nve");
    }
}

void FixNarcShapes::init() {
    if (domain->dimension != 2)
        error->all(FLERR, std::string("fix narc/shapes wants dimension 2"));
    refuse_what_does_not_fit();
    for (int i = 0; i < modify->nfix; i++)
        if (modify->fix[i] != this && !std::strcmp(modify->fix[i]->style, style))
            error->all(FLERR, std::string("there is more than one fix narc/shapes"));
    if (!property.empty()) {
        int is_double, columns;
        property_index = atom->find_custom(property.c_str(), is_double, columns);
        if (property_index < 0 || is_double || columns)
            error->all(FLERR, "fix narc/shapes: there is no integer property i_" + property + "; fix property/atom i_" +
                                  property + " ghost yes makes one");
    }
    int bad = 0;
    for (int i = 0; i < atom->nlocal; i++)
        bad = bad || !(atom->radius[i] > 0) ||
              (!property.empty() && (atom->ivector[property_index][i] < 1 ||
                                     atom->ivector[property_index][i] > static_cast<int>(forms.size())));
    int any_bad;
    MPI_Allreduce(&bad, &any_bad, 1, MPI_INT, MPI_MAX, world);
    if (any_bad)
        error->all(FLERR, std::string("fix narc/shapes: an atom has no radius, or a shape number out of 1 .. ") +
                              std::to_string(forms.size()));
    for (int i = 0; i < atom->nlocal; i++) {
        orient(i);
        set_mass(i);
    }
}

/* ---------------------------------------------------------------------------- grains */

double FixNarcShapes::equal_radius(int i) const { return scale(i) * std::sqrt(form(i).area / std::acos(-1.0)); }

void FixNarcShapes::set_mass(int i) {
    if (density > 0 && (atom->mask[i] & groupbit))
        atom->rmass[i] = density * form(i).area * scale(i) * scale(i);
}

void FixNarcShapes::orient(int i) {
    double *mu = atom->mu[i];
    const double length = std::sqrt(mu[0] * mu[0] + mu[1] * mu[1]);
    mu[0] = length > 0 ? mu[0] / length : 1;
    mu[1] = length > 0 ? mu[1] / length : 0;
    mu[2] = 0;
    mu[3] = 1;
}

narc_body FixNarcShapes::body(int i, size_t part) const {
    const double *x = atom->x[i], *mu = atom->mu[i];
    return {x[0],
            x[1],
            static_cast<float>(mu[0]),
            static_cast<float>(mu[1]),
            static_cast<float>(scale(i)),
            first_part[form_index(i)] + static_cast<uint32_t>(part)};
}

void FixNarcShapes::number_rows() {
    row_atom.clear();
    first_row.clear();
    for (int i = 0; i < atom->nlocal + atom->nghost; i++) {
        first_row.push_back(static_cast<uint32_t>(row_atom.size()));
        row_atom.insert(row_atom.end(), form(i).parts.size(), static_cast<uint32_t>(i));
    }
}

narc_bodies FixNarcShapes::bodies() {
    rows.resize(row_atom.size());
    row_outline.resize(rows.size());
    for (int row = 0, i = 0; row < static_cast<int>(rows.size()); i++) {
        const unsigned index = form_index(i);
        const std::vector<narc_lammps::Part> &parts = forms[index].parts;
        const double *x = atom->x[i], *mu = atom->mu[i], scale = atom->radius[i] / forms[index].reach;
        narc_body *body = &rows[static_cast<size_t>(row)];
        touch_grain *outline = &row_outline[static_cast<size_t>(row)];
        row += static_cast<int>(parts.size());
        for (uint32_t part = 0; part < parts.size(); part++) {
            body[part] = {x[0],
                          x[1],
                          static_cast<float>(mu[0]),
                          static_cast<float>(mu[1]),
                          static_cast<float>(scale),
                          first_part[index] + part};
            outline[part] = {parts[part].sides.data(), parts[part].sides.size(), mu[0], mu[1], scale};
        }
    }
    narc_bodies bodies;
    narc_view_bodies(rows.data(), rows.size(), &bodies);
    return bodies;
}

/* ---------------------------------------------------------------------------- memory of contacts */

void FixNarcShapes::setup_post_neighbor() { post_neighbor(); }

void FixNarcShapes::post_neighbor() {
    if (pair)
        pair->build_pairs();
}

void FixNarcShapes::pre_exchange() {
    save_memories();
    refuse_spin_without_turn();
}

/* fix move lets grains spin that it does not turn. */
void FixNarcShapes::refuse_spin_without_turn() {
    for (int k = 0; k < modify->nfix; k++) {
        if (std::strcmp(modify->fix[k]->style, "move") != 0)
            continue;
        for (int i = 0; i < atom->nlocal; i++)
            if ((atom->mask[i] & modify->fix[k]->groupbit) && atom->omega[i][2] != 0)
                error->one(FLERR, std::string("fix narc/shapes: fix ") + modify->fix[k]->id +
                                      " of style move does not turn grains, and atom " + std::to_string(atom->tag[i]) +
                                      " has a spin");
    }
}

/* Commands between two runs find memories with their atoms. */
void FixNarcShapes::post_run() {
    pre_exchange();
    if (pair)
        pair->forget_pairs();
}

/* From the pair style's arrays to both atoms of each contact. With Newton's third law a rank also computes pairs that
 * it has half of, and tells the owner of the ghost. */
void FixNarcShapes::save_memories() {
    if (!pair || !pair->has_pairs())
        return;
    for (auto &list : memories)
        list.clear();
    pair->save_memories(memories);
    if (pair->remembers_for_ghosts())
        reverse_variable(comm, this, 0);
    size_t most = 0;
    for (int i = 0; i < atom->nlocal; i++)
        most = std::max(most, memories[static_cast<size_t>(i)].size());
    maxexchange = memory_size * static_cast<int>(most) + 2;
}

int FixNarcShapes::pack(const std::vector<Memory> &list, double *buffer) {
    int n = 0;
    buffer[n++] = static_cast<double>(list.size());
    for (const Memory &kept : list) {
        buffer[n++] = static_cast<double>(kept.other);
        buffer[n++] = kept.parts[0];
        buffer[n++] = kept.parts[1];
        buffer[n++] = kept.springs.x;
        buffer[n++] = kept.springs.y;
        buffer[n++] = kept.springs.angle;
        buffer[n++] = kept.springs.stiffening;
    }
    return n;
}

int FixNarcShapes::unpack(const double *buffer, std::vector<Memory> &list) {
    int n = 0;
    const int count = static_cast<int>(buffer[n++]);
    for (int k = 0; k < count; k++, n += memory_size)
        list.push_back({static_cast<tagint>(buffer[n]),
                        {static_cast<uint32_t>(buffer[n + 1]), static_cast<uint32_t>(buffer[n + 2])},
                        {buffer[n + 3], buffer[n + 4], buffer[n + 5], buffer[n + 6]}});
    return n;
}

void FixNarcShapes::grow_arrays(int most) { memories.resize(static_cast<size_t>(most)); }

void FixNarcShapes::copy_arrays(int from, int to, int) {
    memories[static_cast<size_t>(to)] = memories[static_cast<size_t>(from)];
}

void FixNarcShapes::set_arrays(int i) {
    memories[static_cast<size_t>(i)].clear();
    orient(i);
    if (atom->radius[i] > 0 && form_index(i) < forms.size())
        set_mass(i);
}

int FixNarcShapes::pack_exchange(int i, double *buffer) { return pack(memories[static_cast<size_t>(i)], buffer); }

int FixNarcShapes::unpack_exchange(int i, double *buffer) {
    memories[static_cast<size_t>(i)].clear();
    return unpack(buffer, memories[static_cast<size_t>(i)]);
}

int FixNarcShapes::pack_reverse_comm_size(int count, int first) {
    int size = 0;
    for (int i = first; i < first + count; i++)
        size += 1 + memory_size * static_cast<int>(memories[static_cast<size_t>(i)].size());
    return size;
}

int FixNarcShapes::pack_reverse_comm(int count, int first, double *buffer) {
    int n = 0;
    for (int i = first; i < first + count; i++)
        n += pack(memories[static_cast<size_t>(i)], buffer + n);
    return n;
}

void FixNarcShapes::unpack_reverse_comm(int count, int *list, double *buffer) {
    for (int k = 0, n = 0; k < count; k++)
        n += unpack(buffer + n, memories[static_cast<size_t>(list[k])]);
}

void FixNarcShapes::write_restart(FILE *file) {
    save_memories();
    if (comm->me == 0) {
        const int size = 0; /* nothing but what atoms have */
        fwrite(&size, sizeof size, 1, file);
    }
}

/* The first item of an atom's record is its size, as LAMMPS wants it. */
int FixNarcShapes::pack_restart(int i, double *buffer) {
    const int size = 1 + pack(memories[static_cast<size_t>(i)], buffer + 1);
    buffer[0] = size;
    return size;
}

void FixNarcShapes::unpack_restart(int i, int nth) {
    const double *extra = atom->extra[i];
    for (int k = 0; k < nth; k++)
        extra += static_cast<int>(*extra);
    memories[static_cast<size_t>(i)].clear();
    unpack(extra + 1, memories[static_cast<size_t>(i)]);
}

int FixNarcShapes::size_restart(int i) {
    return 2 + memory_size * static_cast<int>(memories[static_cast<size_t>(i)].size());
}

int FixNarcShapes::maxsize_restart() {
    int most = 0, all;
    for (int i = 0; i < atom->nlocal; i++)
        most = std::max(most, size_restart(i));
    MPI_Allreduce(&most, &all, 1, MPI_INT, MPI_MAX, world);
    return all;
}

double FixNarcShapes::memory_usage() {
    size_t bytes = rows.capacity() * sizeof(narc_body);
    for (const std::vector<Memory> &list : memories)
        bytes += sizeof(std::vector<Memory>) + list.capacity() * sizeof(Memory);
    return static_cast<double>(bytes);
}
