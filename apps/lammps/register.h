/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * register.h - makes the styles known to LAMMPS.
 */
#ifndef NARC_LAMMPS_REGISTER_H
#define NARC_LAMMPS_REGISTER_H

namespace LAMMPS_NS {
class LAMMPS;
}

namespace narc_lammps {

/* From now on this instance of LAMMPS has the styles, as if it were built with them. */
void register_styles(LAMMPS_NS::LAMMPS *lammps);

} // namespace narc_lammps

#endif
