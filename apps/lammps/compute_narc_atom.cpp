/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * compute_narc_atom.cpp - orientations, shapes and scales of grains, for dumps.
 */
#include "compute_narc_atom.h"

#include <algorithm>
#include <cmath>

#include "atom.h"
#include "error.h"
#include "fix_narc_shapes.h"
#include "memory.h"
#include "update.h"

using namespace LAMMPS_NS;

namespace {
constexpr int column_count = 5;
}

ComputeNarcAtom::ComputeNarcAtom(LAMMPS *lammps, int count, char **arguments) : Compute(lammps, count, arguments) {
    if (count != 3)
        error->all(FLERR, std::string("compute narc/atom takes no arguments"));
    peratom_flag = 1;
    size_peratom_cols = column_count;
}

ComputeNarcAtom::~ComputeNarcAtom() { memory->destroy(array_atom); }

void ComputeNarcAtom::init() { shapes = FixNarcShapes::find(lmp, "compute narc/atom"); }

void ComputeNarcAtom::compute_peratom() {
    invoked_peratom = update->ntimestep;
    if (room < atom->nmax) {
        room = atom->nmax;
        memory->destroy(array_atom);
        memory->create(array_atom, room, column_count, "narc/atom:array_atom");
    }
    for (int i = 0; i < atom->nlocal; i++) {
        double *row = array_atom[i];
        std::fill_n(row, column_count, 0.0);
        if (!(atom->mask[i] & groupbit))
            continue;
        row[0] = std::atan2(atom->mu[i][1], atom->mu[i][0]);
        row[1] = std::sin(row[0] / 2);
        row[2] = std::cos(row[0] / 2);
        row[3] = shapes->form_index(i) + 1;
        row[4] = shapes->scale(i);
    }
}

double ComputeNarcAtom::memory_usage() { return 1.0 * room * column_count * sizeof(double); }
