/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * compute_narc_atom.h - what a picture of grains needs, for dumps.
 *
 *   compute ID group narc/atom
 *
 * Columns: the angle, z and w of its quaternion (x and y are 0), the number of the shape in the order of fix
 * narc/shapes, and the scale.
 */
#ifndef NARC_LAMMPS_COMPUTE_NARC_ATOM_H
#define NARC_LAMMPS_COMPUTE_NARC_ATOM_H

#include "compute.h"

namespace LAMMPS_NS {

class ComputeNarcAtom : public Compute {
  public:
    ComputeNarcAtom(class LAMMPS *lammps, int count, char **arguments);
    ~ComputeNarcAtom() override;
    void init() override;
    void compute_peratom() override;
    double memory_usage() override;

  private:
    class FixNarcShapes *shapes = nullptr;
    int room = 0;
};

} // namespace LAMMPS_NS

#endif
