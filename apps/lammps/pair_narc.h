/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * pair_narc.h - forces between grains that touch. All pairs of a rank's neighbour list go to the library in one batch,
 * but for those of two discs.
 *
 *   pair_style narc/hooke/history LAW
 *   pair_style narc/hertz/history LAW
 *   pair_style narc/mindlin/rescale LAW     the same but for the tangential spring, where its stiffness changes
 *   pair_coeff I J [LAW]
 *
 *   LAW    kn kt gamma_n gamma_t xmu dampflag [limit_damping] [rolling MU] [restitution E] [cohesion F RANGE];
 *          types without one have the pair style's
 */
#ifndef NARC_LAMMPS_PAIR_NARC_H
#define NARC_LAMMPS_PAIR_NARC_H

#include <vector>

#include "contact_law.h"
#include "fix_narc_shapes.h"
#include "pair.h"

namespace LAMMPS_NS {

class PairNarc : public Pair {
  public:
    PairNarc(class LAMMPS *lammps, bool hertz, bool rescaled);
    ~PairNarc() override;

    void compute(int energy, int virial_kind) override;
    void settings(int count, char **arguments) override;
    void coeff(int count, char **arguments) override;
    void init_style() override;
    double init_one(int i, int j) override;
    void write_restart(FILE *file) override;
    void read_restart(FILE *file) override;
    void write_restart_settings(FILE *file) override;
    void read_restart_settings(FILE *file) override;
    double memory_usage() override;

    /* Called by fix narc/shapes when there is a new neighbour list, and when it ends. */
    void build_pairs();
    void forget_pairs() { valid = false; }
    bool has_pairs() const { return valid; }
    bool remembers_for_ghosts() const;
    void save_memories(std::vector<std::vector<FixNarcShapes::Memory>> &memories) const;

    bool keeps_rows = false;                   /* set by who wants them */
    std::vector<narc_lammps::ContactRow> rows; /* of the last step, each contact on one rank */

  private:
    void allocate();
    narc_lammps::ContactLaw read_law(int count, char **arguments);
    void find_radii();
    double find_range() const;
    void check_atoms() const;
    void add_pairs(bool of_discs);
    void find_contacts();
    void apply_discs(double step);
    void apply_others(double step);
    void apply_contact(uint32_t pair, int a, int b, narc_lammps::Contact contact, double step);

    narc_lammps::ContactLaw law;               /* the pair style's */
    std::vector<narc_lammps::ContactLaw> laws; /* of two types: [i * (types + 1) + j] */
    FixNarcShapes *shapes = nullptr;
    int frozen = 0; /* group bit of fix freeze */
    std::vector<double> type_radius;
    double range = 0; /* of cohesion, the largest */

    /* Pairs of parts, by their rows, A of the grain with the lower ID: the order of a pair does not depend on the
     * ranks, nor do its bits. First come those of two discs, which need no search. */
    bool valid = false;
    size_t disc_pairs = 0;
    std::vector<uint32_t> first, second;
    std::vector<narc_lammps::Springs> springs;
    std::vector<uint32_t> touching;     /* the pairs that touched in the last step */
    std::vector<uint32_t> before;       /* and in the one before it */
    std::vector<narc_contact> contacts; /* what may touch, and room for one of each pair of others */
    size_t found_count = 0;
    std::vector<touch_parts> parts; /* of two grains */
};

class PairNarcHooke : public PairNarc {
  public:
    explicit PairNarcHooke(class LAMMPS *lammps) : PairNarc(lammps, false, false) {}
};

class PairNarcHertz : public PairNarc {
  public:
    explicit PairNarcHertz(class LAMMPS *lammps) : PairNarc(lammps, true, false) {}
};

class PairNarcMindlin : public PairNarc {
  public:
    explicit PairNarcMindlin(class LAMMPS *lammps) : PairNarc(lammps, true, true) {}
};

} // namespace LAMMPS_NS

#endif
