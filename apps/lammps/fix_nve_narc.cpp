/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * fix_nve_narc.cpp - velocity Verlet for grains in the plane.
 */
#include "fix_nve_narc.h"

#include "atom.h"
#include "error.h"
#include "fix_narc_shapes.h"
#include "force.h"
#include "update.h"

using namespace LAMMPS_NS;

FixNVENarc::FixNVENarc(LAMMPS *lammps, int count, char **arguments) : Fix(lammps, count, arguments) {
    if (count != 3)
        error->all(FLERR, std::string("fix narc/nve takes no arguments"));
    time_integrate = 1;
    dynamic_group_allow = 1;
    scalar_flag = 1;
    global_freq = 1;
    extscalar = 1;
}

int FixNVENarc::setmask() { return FixConst::INITIAL_INTEGRATE | FixConst::FINAL_INTEGRATE; }

/* What leads out of the plane never changes. */
void FixNVENarc::init() {
    shapes = FixNarcShapes::find(lmp, "fix narc/nve");
    for (int i = 0; i < atom->nlocal; i++)
        if (atom->mask[i] & groupbit)
            atom->v[i][2] = atom->omega[i][0] = atom->omega[i][1] = 0;
}

/* Half a step of the velocities, and with `moves` a step of the places. */
template <bool moves> void FixNVENarc::integrate() {
    const double step = update->dt, half_step = 0.5 * step, push = half_step * force->ftm2v;
    for (int i = 0; i < atom->nlocal; i++) {
        if (!(atom->mask[i] & groupbit))
            continue;
        double *v = atom->v[i], *x = atom->x[i], *mu = atom->mu[i];
        const double *f = atom->f[i], square = shapes->inertia_by_mass(i), turn = push / (atom->rmass[i] * square);
        const double spin = atom->omega[i][2] + turn * atom->torque[i][2];
        v[0] += turn * square * f[0];
        v[1] += turn * square * f[1];
        atom->omega[i][2] = spin;
        if (!moves)
            continue;
        x[0] += step * v[0];
        x[1] += step * v[1];
        /* By 2 atan(spin step / 2), which is spin times step to the third order and needs no sine. Roundings of the
         * length go: where it is 1 and a little, 1.5 - 0.5 length^2 is its inverse. */
        const double half = half_step * spin, one = 1 - half * half, share = 1 / (1 + half * half);
        const double cosine = share * (one * mu[0] - 2 * half * mu[1]), sine = share * (2 * half * mu[0] + one * mu[1]);
        const double inverse = 1.5 - 0.5 * (cosine * cosine + sine * sine);
        mu[0] = inverse * cosine;
        mu[1] = inverse * sine;
    }
}

void FixNVENarc::initial_integrate(int) { integrate<true>(); }

void FixNVENarc::final_integrate() { integrate<false>(); }

double FixNVENarc::compute_scalar() {
    double mine = 0, all;
    for (int i = 0; i < atom->nlocal; i++)
        if (atom->mask[i] & groupbit)
            mine += atom->rmass[i] * shapes->inertia_by_mass(i) * atom->omega[i][2] * atom->omega[i][2];
    mine *= 0.5 * force->mvv2e;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
    return all;
}
