#!/bin/sh
# SPDX-License-Identifier: MIT
#
# helgrind.sh NARC FONT VALGRIND - the command's calls with three threads under valgrind's helgrind.
rules=$(cd "$(dirname "$0")" && pwd)/helgrind.supp
. "$(dirname "$0")/common.sh"
valgrind=$3

# races ARGUMENTS...: how many are seen.
races() {
    "$valgrind" --tool=helgrind --fair-sched=yes ${rules:+--suppressions="$rules"} --log-file=races.log "$narc" "$@" >out.txt 2>err.txt
    grep -c "Possible data race" races.log
}
# orderly NAME ARGUMENTS...: no two threads get at the same memory but one after the other.
orderly() {
    name=$1
    shift
    [ "$(races "$@")" = 0 ] && : >races.log
    check "$name" sh -c "head -n 40 races.log | grep . && exit 1; [ -s out.txt ]"
}

works "a scene" scene --shapes shapes.json --bodies 3000 --density 0.6 --seed 7 --out scene.csv
awk 'BEGIN { print "x,y,motion_x,motion_y"; for (k = 0; k < 3000; k++) print k % 90 - 45 "," k % 77 - 40 ",3,2" }' >rays.csv
scene="--shapes shapes.json --bodies scene.csv --threads 3"
orderly "pairs and contacts" collide $scene --out list.csv
orderly "contacts of given pairs" collide $scene --pairs list.csv --all --out all.csv
orderly "bits of overlaps" collide $scene --method circle --out bits.csv
orderly "rays" cast $scene --rays rays.csv --most 2 --out hits.csv
# It would be seen: of atomic variables it is, where helgrind is not told.
rules=
check "threads there are" test "$(races collide $scene --out list.csv)" -gt 0
finish
