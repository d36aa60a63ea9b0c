/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * compute_narc_contact.h - contacts, for dump local: coordination, force chains, fabric.
 *
 *   compute ID all narc/contact
 *
 * A row for each contact of two grains, or of a grain with a wall, in columns: 1, 2 the IDs of A and B; B is -1, -2 ...
 * for the first fix wall/narc, the second and so on; 3, 4 where it is; 5, 6 its unit normal from A to B; 7, 8 the force
 * on B; 9 the overlap.
 */
#ifndef NARC_LAMMPS_COMPUTE_NARC_CONTACT_H
#define NARC_LAMMPS_COMPUTE_NARC_CONTACT_H

#include <vector>

#include "compute.h"
#include "contact_law.h"

namespace LAMMPS_NS {

class ComputeNarcContact : public Compute {
  public:
    ComputeNarcContact(class LAMMPS *lammps, int count, char **arguments);
    void init() override;
    void compute_local() override;
    double memory_usage() override;

  private:
    class PairNarc *pair = nullptr;
    std::vector<class FixWallNarc *> walls;
    std::vector<narc_lammps::ContactRow> rows;
    std::vector<double *> pointers; /* to each row, as LAMMPS wants them */
};

} // namespace LAMMPS_NS

#endif
