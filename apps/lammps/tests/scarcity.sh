#!/bin/sh
# SPDX-License-Identifier: GPL-2.0-or-later
#
# scarcity.sh MPIEXEC NARC_LAMMPS SHAPES PRELOAD - an allocation of narc or of its styles fails, on one rank of two: the
# program tells of it and ends on both, or does what it does otherwise. LAMMPS' and MPI's own allocations do not fail.
# And a disk that is full, where a mesh is drawn.
set -u
mpiexec=$1 program=$2 shapes=$3 preload=$4 failures=0
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
miss() {
    echo "WRONG allocation $1"
    cat said.txt
    failures=$((failures + 1))
}

cat >grains.in <<'END'
units lj
dimension 2
newton off
atom_style hybrid sphere 1 dipole
atom_modify map array
comm_modify vel yes
region box block 0 4 0 4 -0.5 0.5
create_box 1 box
mass * 1
create_atoms 1 single 1.6 0.4 0
create_atoms 1 single 2.4 0.4 0
fix shapes all narc/shapes ${shapes} ellipse4 density 1 ${mesh}
pair_style narc/hooke/history 1e4 NULL 50 NULL 0.5 1
pair_coeff * *
fix nve all narc/nve
fix floor all wall/narc hooke/history 1e4 NULL 50 NULL 0.5 1 plate 0 0 0 1
compute contacts all narc/contact
timestep 0.001
dump out all custom 50 grains.dump id x y mux muy
dump contacts all local 50 contacts.dump c_contacts[*]
run 50
END

if [ -c /dev/full ]; then
    ln -s /dev/full full.ellipse4.obj.part
    "$mpiexec" -np 2 "$program" -in grains.in -log none -var shapes "$shapes" -var mesh "mesh full" >said.txt 2>&1 &&
        miss "none, on a full disk"
    grep -q "ERROR: fix narc/shapes: full.ellipse4.obj: cannot be written" said.txt || miss "none: no word of the disk"
    [ ! -e full.ellipse4.obj ] && [ ! -L full.ellipse4.obj.part ] || miss "none: a part of a mesh stays"
fi

# once NUMBER: what two ranks end with, where that allocation of the first one fails. 0: none.
once() {
    rm -f *.dump
    timeout 60 "$mpiexec" -np 1 env LD_PRELOAD="$preload" NARC_ALLOCATIONS=allocations.txt NARC_DENIED_TO=narc \
        NARC_DENIED="$1" "$program" -in grains.in -log none -var shapes "$shapes" -var mesh "" : \
        -np 1 "$program" -in grains.in -log none -var shapes "$shapes" -var mesh "" >said.txt 2>&1
}

once 0 || miss none
[ -f allocations.txt ] || exit 77 # another C library
count=$(cat allocations.txt)
mv grains.dump grains.usual
mv contacts.dump contacts.usual
number=1 ended=0
while [ "$number" -le "$count" ]; do
    if once "$number"; then
        cmp -s grains.dump grains.usual || miss "$number: other grains"
        cmp -s contacts.dump contacts.usual || miss "$number: other contacts"
    else
        [ $? -ne 124 ] || miss "$number: goes on"
        grep -q 'ERROR.*memory' said.txt || miss "$number: no word of memory"
        ended=$((ended + 1))
    fi
    number=$((number + 1 + number / 8))
done
[ $ended -gt 0 ] || miss "that matters: none"
echo "$count allocations, $ended runs ended early"
[ $failures -eq 0 ] || exit 1
