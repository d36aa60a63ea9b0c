/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * fix_narc_shapes.h - what grains are: the form of each atom type or atom, and the memory of the contacts between
 * grains, which goes with the atoms from rank to rank and into restart files.
 *
 *   fix ID all narc/shapes FILE NAME ... [density RHO] [shape i_PROPERTY] [mesh PREFIX]
 */
#ifndef NARC_LAMMPS_FIX_NARC_SHAPES_H
#define NARC_LAMMPS_FIX_NARC_SHAPES_H

#include <vector>

#include "atom.h"
#include "contact_law.h"
#include "fix.h"
#include "shape_file.h"

namespace LAMMPS_NS {

class PairNarc;

class FixNarcShapes : public Fix {
  public:
    FixNarcShapes(class LAMMPS *lammps, int count, char **arguments);
    ~FixNarcShapes() override;

    int setmask() override;
    void init() override;
    void setup_post_neighbor() override;
    void pre_exchange() override;
    void post_neighbor() override;
    void post_run() override;

    void grow_arrays(int most) override;
    void copy_arrays(int from, int to, int) override;
    void set_arrays(int i) override;
    int pack_exchange(int i, double *buffer) override;
    int unpack_exchange(int i, double *buffer) override;
    int pack_reverse_comm_size(int count, int first) override;
    int pack_reverse_comm(int count, int first, double *buffer) override;
    void unpack_reverse_comm(int count, int *list, double *buffer) override;
    void write_restart(FILE *file) override;
    void restart(char *) override {}
    int pack_restart(int i, double *buffer) override;
    void unpack_restart(int i, int nth) override;
    int size_restart(int i) override;
    int maxsize_restart() override;
    double memory_usage() override;

    /* The one fix of this style; ends the run with an error if there is none. */
    static FixNarcShapes *find(class LAMMPS *lammps, const char *who);

    /* The form of a local or ghost atom. */
    const narc_lammps::Form &form(int i) const { return forms[form_index(i)]; }
    /* By which the form is drawn larger. */
    double scale(int i) const { return atom->radius[i] / form(i).reach; }
    double inertia_by_mass(int i) const { return form(i).inertia_ratio * atom->radius[i] * atom->radius[i]; }
    double equal_radius(int i) const; /* of the disc of equal area */
    touch_grain outline(int i, size_t part) const {
        const std::vector<touch_side> &sides = form(i).parts[part].sides;
        return {sides.data(), sides.size(), atom->mu[i][0], atom->mu[i][1], scale(i)};
    }

    /* Sees to it that an atom has an orientation: that of angle 0 if it has none. */
    void orient(int i);

    /* A part of a local or ghost atom as the library wants it, as it is now. And a row for each part of each atom: as
     * they are numbered when there is a new neighbour list. */
    narc_body body(int i, size_t part) const;
    void number_rows();
    narc_bodies bodies();
    std::vector<uint32_t> row_atom, first_row; /* the atom of a row, an atom's first row */
    std::vector<touch_grain> row_outline;      /* as bodies() has found it */
    size_t row_part(uint32_t row) const { return row - first_row[row_atom[row]]; }

    narc_shapes *store = nullptr;
    std::vector<narc_lammps::Form> forms; /* those that the command names, in its order; their parts are in the store */
    size_t most_parts = 0;                /* of a form */
    PairNarc *pair = nullptr;             /* whose contacts are remembered; it registers itself */

    /* The memory of a contact: between which parts, that of the grain with the lower ID first; and the springs
     * of the contact law. */
    struct Memory {
        tagint other;
        uint32_t parts[2];
        narc_lammps::Springs springs;
    };
    /* Of local atoms, between the end of a neighbour list and the next; while a list lives the pair style has it. */
    std::vector<std::vector<Memory>> memories;

    unsigned form_index(int i) const {
        return static_cast<unsigned>((property_index < 0 ? atom->type[i] : atom->ivector[property_index][i]) - 1);
    }

  private:
    void read_forms(const char *path, int count, char **names);
    void set_mass(int i);
    void refuse_what_does_not_fit();
    void refuse_spin_without_turn();
    void save_memories();
    static int pack(const std::vector<Memory> &list, double *buffer);
    static int unpack(const double *buffer, std::vector<Memory> &list);

    double density = 0;
    std::string mesh;     /* where meshes of the forms go */
    std::string property; /* without its "i_"; empty: the type decides */
    int property_index = -1;
    std::vector<uint32_t> first_part; /* of each form, in the store */
    std::vector<narc_body> rows;
};

} // namespace LAMMPS_NS

#endif
