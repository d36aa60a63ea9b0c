/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * fix_wall_narc.h - a wall of infinite mass, at rest or in motion. It has no periodic images.
 *
 *   fix ID group wall/narc LAW kn kt gamma_n gamma_t xmu dampflag WALL [velocity VX VY [every N]]
 *
 *   LAW    hooke/history or hertz/history, coefficients as those of the pair styles
 *   WALL   plate PX PY NX NY                a half plane: its border goes through (PX, PY), grains are where N points
 *          box CX CY WIDTH HEIGHT DEGREES   a box around (CX, CY), turned
 *
 *   VX VY  numbers, or equal-style variables (v_NAME), which may look at the wall's force: a servo. They are evaluated
 *          in steps whose number is a multiple of N, each if left out
 *
 * Vector: 1, 2 the force on the wall; 3, 4 how far it has moved. Scalar: the elastic energy of its contacts.
 */
#ifndef NARC_LAMMPS_FIX_WALL_NARC_H
#define NARC_LAMMPS_FIX_WALL_NARC_H

#include <vector>

#include "contact_law.h"
#include "fix.h"
#include "shape_file.h"

namespace LAMMPS_NS {

class FixWallNarc : public Fix {
  public:
    FixWallNarc(class LAMMPS *lammps, int count, char **arguments);
    ~FixWallNarc() override;

    int setmask() override;
    void init() override;
    void setup(int) override;
    void initial_integrate(int) override;
    void post_force(int) override;
    double compute_scalar() override;
    double compute_vector(int k) override;

    void grow_arrays(int most) override;
    void copy_arrays(int from, int to, int) override;
    void set_arrays(int i) override;
    int pack_exchange(int i, double *buffer) override;
    int unpack_exchange(int i, double *buffer) override;
    void write_restart(FILE *file) override;
    void restart(char *buffer) override;
    int pack_restart(int i, double *buffer) override;
    void unpack_restart(int i, int nth) override;
    int size_restart(int) override { return 3; }
    int maxsize_restart() override { return 3; }

  private:
    /* A grain that touches, A, and the wall's place from its centre. */
    struct Contact {
        int grain;
        touch at;
        double way_x, way_y;
    };

    int read_wall(int i, int count, char **arguments);
    void find_plate_contacts();
    void find_box_contacts();
    void apply_contact(const Contact &contact, double step);
    void sum_ranks();

    narc_lammps::ContactLaw law;
    class FixNarcShapes *shapes = nullptr;
    bool plate = false;
    double place_x = 0, place_y = 0, normal_x = 0, normal_y = 0; /* a box: cosine and sine in place of the normal */
    double reach = 0;                                            /* a box: the circle around it */
    double velocity[2] = {0, 0};
    int every = 1;
    std::string velocity_variable[2]; /* equal-style variables that give it; empty: constant */
    double moved[2] = {0, 0};
    std::vector<touch_side> sides; /* of the box; of a plate a segment, which lies under each grain */
    narc_shapes *store = nullptr;  /* a box: all forms of grains, and the box behind them */

    std::vector<Contact> contacts;
    std::vector<double> slips;   /* two of each atom */
    std::vector<char> touched;   /* by the wall, in the last step */
    double mine[3] = {0, 0, 0};  /* force on the wall and energy: of this rank */
    double total[3] = {0, 0, 0}; /* and of all, if summed */
    bool summed = false;
};

} // namespace LAMMPS_NS

#endif
