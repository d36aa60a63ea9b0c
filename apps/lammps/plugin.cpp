/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * plugin.cpp - the styles as a plugin, for versions of LAMMPS that have the command: plugin load narcplugin.so
 */
#include "register.h"

/* LAMMPS looks for a function of this name. */
extern "C" void lammpsplugin_init(void *lammps, void *, void *) {
    narc_lammps::register_styles(static_cast<LAMMPS_NS::LAMMPS *>(lammps));
}
