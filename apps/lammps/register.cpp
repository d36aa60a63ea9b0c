/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * register.cpp - puts the styles into the tables that LAMMPS makes them from.
 */
#include "register.h"

#include "compute_narc_contact.h"
#include "fix_narc_shapes.h"
#include "fix_nve_narc.h"
#include "fix_wall_narc.h"
#include "force.h"
#include "lammps.h"
#include "modify.h"
#include "pair_narc.h"

using namespace LAMMPS_NS;

namespace {

template <class Style> Pair *make_pair_style(LAMMPS *lammps) { return new Style(lammps); }
template <class Style> Fix *make_fix(LAMMPS *lammps, int count, char **arguments) {
    return new Style(lammps, count, arguments);
}
template <class Style> Compute *make_compute(LAMMPS *lammps, int count, char **arguments) {
    return new Style(lammps, count, arguments);
}

} // namespace

void narc_lammps::register_styles(LAMMPS *lammps) {
    (*lammps->force->pair_map)["narc/hooke/history"] = make_pair_style<PairNarcHooke>;
    (*lammps->force->pair_map)["narc/hertz/history"] = make_pair_style<PairNarcHertz>;
    (*lammps->force->pair_map)["narc/mindlin/rescale"] = make_pair_style<PairNarcMindlin>;
    (*lammps->modify->fix_map)["narc/shapes"] = make_fix<FixNarcShapes>;
    (*lammps->modify->fix_map)["narc/nve"] = make_fix<FixNVENarc>;
    (*lammps->modify->fix_map)["wall/narc"] = make_fix<FixWallNarc>;
    (*lammps->modify->compute_map)["narc/contact"] = make_compute<ComputeNarcContact>;
}
