/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * fix_wall_narc.h - a wall of infinite mass, at rest or in motion. It has no periodic images.
 *
 *   fix ID group wall/narc LAW WALL [velocity VX VY] [spin OMEGA PX PY] [every N]
 *
 *   LAW    hooke/history, hertz/history or mindlin/rescale, and the numbers of the pair styles
 *   WALL   plate PX PY NX NY                a half plane: its border goes through (PX, PY), grains are where N points
 *          box CX CY WIDTH HEIGHT DEGREES   a box around (CX, CY), turned
 *          chain FILE NAME X Y DEGREES      a chain of a shapes file: ground, whose origin is (X, Y), turned
 *
 *   VX VY OMEGA   numbers, or equal-style variables (v_NAME), which may look at the wall's force: a servo. They are
 *                 evaluated in steps whose number is a multiple of N, each if left out
 *   PX PY         about which a box or a chain turns; it moves with the wall
 *
 * Vector: 1, 2 the force on the wall; 3, 4 how far it has moved; 5 the torque on it about (PX, PY); 6 the angle by
 * which it has turned. Scalar: the elastic energy of its contacts. With fix_modify ID virial yes pressures and stresses
 * know its contacts.
 */
#ifndef NARC_LAMMPS_FIX_WALL_NARC_H
#define NARC_LAMMPS_FIX_WALL_NARC_H

#include <vector>

#include "contact_law.h"
#include "fix.h"
#include "fix_narc_shapes.h"
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
    int size_restart(int) override { return 1 + maxexchange; }
    int maxsize_restart() override { return 1 + maxexchange; }

    bool keeps_rows = false;                   /* set by who wants them */
    std::vector<narc_lammps::ContactRow> rows; /* of this rank, in the last step; ID 0 is the wall */

  private:
    /* A box, or a piece of a chain. */
    struct Piece {
        uint32_t shape; /* in the store */
        double x, y;    /* its origin in the wall */
        std::vector<touch_side> sides;
    };

    /* A grain that touches, A, and the wall's place from its centre. */
    struct Contact {
        int grain;
        touch_parts parts;
        size_t memory; /* index of its springs */
    };

    /* The memory of a part of a grain: of so many pieces at once. */
    struct Memory {
        double piece; /* 1 + its index; 0: none */
        narc_lammps::Springs springs;
    };
    static constexpr size_t memory_size = sizeof(Memory) / sizeof(double);
    size_t most_memories() const { return shapes->most_parts * (pieces.size() > 1 ? 4 : 1); }

    Memory *memories_of(int i) { return &memories[static_cast<size_t>(i) * most_memories()]; }
    size_t find_memory(const Contact &contact);
    int read_wall(int i, int count, char **arguments);
    void read_chain(const char *path, const char *name);
    void add_contact(int i, size_t part, size_t piece, const touch_grain &wall, double way_x, double way_y,
                     unsigned feature);
    void join_contacts();
    int read_motion(int i, int count, char **arguments);
    void place_pieces();
    void find_plate_contacts();
    void find_piece_contacts();
    void apply_contact(const Contact &contact, double step);
    void sum_ranks();

    narc_lammps::ContactLaw law;
    FixNarcShapes *shapes = nullptr;
    bool plate = false;
    double place_x = 0, place_y = 0, normal_x = 0, normal_y = 0; /* at the start; else of its angle, cosine and sine */
    double pivot[2] = {0, 0};                                    /* at the start */
    double reach = 0;               /* from its place to its furthest point; of a plate 0 */
    double velocity[3] = {0, 0, 0}; /* the third is the spin */
    int every = 1;
    std::string variables[3]; /* equal-style ones that give them; empty: constant */
    double moved[3] = {0, 0, 0};
    std::vector<Piece> pieces;                           /* of a plate a segment, which lies under each grain */
    uint32_t forms = 0;                                  /* parts of grains */
    narc_shapes *store = nullptr;                        /* all parts of grains, and the pieces behind them */
    double wall_x = 0, wall_y = 0, cosine = 1, sine = 0; /* where it is now */
    narc_lammps::Motion motion = {0, 0, 0};              /* of the wall, at the middle of a box */

    std::vector<Contact> contacts;
    std::vector<Memory> memories;   /* of each atom */
    std::vector<char> touched;      /* of these: in the last step */
    double mine[4] = {0, 0, 0, 0};  /* force on the wall, torque, energy: of this rank */
    double total[4] = {0, 0, 0, 0}; /* and of all, if summed */
    bool summed = false;
};

} // namespace LAMMPS_NS

#endif
