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

void FixNVENarc::init() { shapes = FixNarcShapes::find(lmp, "fix narc/nve"); }

/* Half a step of the velocities. */
void FixNVENarc::kick(int i) {
    const double half_step = 0.5 * update->dt * force->ftm2v;
    atom->v[i][0] += half_step / atom->rmass[i] * atom->f[i][0];
    atom->v[i][1] += half_step / atom->rmass[i] * atom->f[i][1];
    atom->v[i][2] = 0;
    atom->omega[i][0] = atom->omega[i][1] = 0;
    atom->omega[i][2] += half_step / shapes->moment_of_inertia(i) * atom->torque[i][2];
}

void FixNVENarc::initial_integrate(int) {
    for (int i = 0; i < atom->nlocal; i++) {
        if (!(atom->mask[i] & groupbit))
            continue;
        kick(i);
        atom->x[i][0] += update->dt * atom->v[i][0];
        atom->x[i][1] += update->dt * atom->v[i][1];
        /* By 2 atan(omega dt / 2), which is omega dt to the third order and needs no sine. */
        const double half = 0.5 * update->dt * atom->omega[i][2], share = 1 / (1 + half * half);
        const double cosine = (1 - half * half) * share, sine = 2 * half * share;
        double *mu = atom->mu[i];
        const double turned = cosine * mu[0] - sine * mu[1];
        mu[1] = sine * mu[0] + cosine * mu[1];
        mu[0] = turned;
        shapes->orient(i); /* roundings of its length go */
    }
}

void FixNVENarc::final_integrate() {
    for (int i = 0; i < atom->nlocal; i++)
        if (atom->mask[i] & groupbit)
            kick(i);
}

double FixNVENarc::compute_scalar() {
    double mine = 0, all;
    for (int i = 0; i < atom->nlocal; i++)
        if (atom->mask[i] & groupbit)
            mine += shapes->moment_of_inertia(i) * atom->omega[i][2] * atom->omega[i][2];
    mine *= 0.5 * force->mvv2e;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
    return all;
}
