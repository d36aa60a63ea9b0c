/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * narc_lammps.cpp - LAMMPS with grains of narc's forms: takes LAMMPS' own command line and input files.
 *   mpirun -np 4 narc_lammps -in biaxial.in
 */
#include <mpi.h>

#include "input.h"
#include "lammps.h"
#include "register.h"

int main(int count, char **arguments) {
    MPI_Init(&count, &arguments);
    LAMMPS_NS::LAMMPS *lammps = new LAMMPS_NS::LAMMPS(count, arguments, MPI_COMM_WORLD);
    narc_lammps::register_styles(lammps);
    lammps->input->file();
    delete lammps;
    MPI_Finalize();
    return 0;
}
