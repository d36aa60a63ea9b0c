/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * narc_lammps.cpp - LAMMPS with grains of narc's forms: takes LAMMPS' own command line and input files.
 *   mpirun -np 4 narc_lammps -in biaxial.in
 */
#include <cstdio>
#include <new>

#include <mpi.h>

#include "input.h"
#include "lammps.h"
#include "register.h"

static void run(int count, char **arguments) {
    LAMMPS_NS::LAMMPS *lammps = new LAMMPS_NS::LAMMPS(count, arguments, MPI_COMM_WORLD);
    narc_lammps::register_styles(lammps);
    lammps->input->file();
    delete lammps;
}

int main(int count, char **arguments) {
    MPI_Init(&count, &arguments);
    try {
        run(count, arguments);
    } catch (const std::bad_alloc &) { /* on one rank, perhaps: the others must not wait for it */
        std::fputs("ERROR: narc_lammps: out of memory\n", stderr);
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Finalize();
    return 0;
}
