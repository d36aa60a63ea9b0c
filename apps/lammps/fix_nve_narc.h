/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * fix_nve_narc.h - moves and turns grains in the plane: velocity Verlet, with the moments of inertia of their forms.
 *
 *   fix ID group narc/nve
 *
 * Its scalar is the kinetic energy of the rotation of its group.
 */
#ifndef NARC_LAMMPS_FIX_NVE_NARC_H
#define NARC_LAMMPS_FIX_NVE_NARC_H

#include "fix.h"

namespace LAMMPS_NS {

class FixNVENarc : public Fix {
  public:
    FixNVENarc(class LAMMPS *lammps, int count, char **arguments);
    int setmask() override;
    void init() override;
    void initial_integrate(int) override;
    void final_integrate() override;
    double compute_scalar() override;

  private:
    template <bool moves> void integrate();
    class FixNarcShapes *shapes = nullptr;
};

} // namespace LAMMPS_NS

#endif
