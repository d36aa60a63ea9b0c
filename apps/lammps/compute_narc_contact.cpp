/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * compute_narc_contact.cpp - the contacts that the pair style and the walls have kept.
 */
#include "compute_narc_contact.h"

#include <cstring>

#include "error.h"
#include "fix_narc_shapes.h"
#include "fix_wall_narc.h"
#include "modify.h"
#include "pair_narc.h"
#include "update.h"

using namespace LAMMPS_NS;

ComputeNarcContact::ComputeNarcContact(LAMMPS *lammps, int count, char **arguments)
    : Compute(lammps, count, arguments) {
    if (count != 3)
        error->all(FLERR, std::string("compute narc/contact takes no arguments"));
    local_flag = 1;
    size_local_cols = sizeof(narc_lammps::ContactRow) / sizeof(double);
}

void ComputeNarcContact::init() {
    pair = FixNarcShapes::find(lmp, "compute narc/contact")->pair;
    if (!pair)
        error->all(FLERR, std::string("compute narc/contact wants a pair style of narc"));
    pair->keeps_rows = true;
    walls.clear();
    for (int i = 0; i < modify->nfix; i++) {
        if (std::strcmp(modify->fix[i]->style, "wall/narc") != 0)
            continue;
        walls.push_back(static_cast<FixWallNarc *>(modify->fix[i]));
        walls.back()->keeps_rows = true;
    }
}

void ComputeNarcContact::compute_local() {
    invoked_local = update->ntimestep;
    rows = pair->rows;
    for (size_t w = 0; w < walls.size(); w++) {
        for (narc_lammps::ContactRow row : walls[w]->rows) {
            row.b = -1.0 - static_cast<double>(w);
            rows.push_back(row);
        }
    }
    pointers.clear();
    for (narc_lammps::ContactRow &row : rows)
        pointers.push_back(&row.a);
    array_local = pointers.data();
    size_local_rows = static_cast<int>(rows.size());
}

double ComputeNarcContact::memory_usage() {
    return static_cast<double>(rows.capacity() * sizeof(narc_lammps::ContactRow) +
                               pointers.capacity() * sizeof(double *));
}
