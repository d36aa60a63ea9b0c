#!/bin/sh
# SPDX-License-Identifier: MIT
#
# limits.sh NARC - millions of contacts; more bodies than a picture takes, more candidates than are counted.
. "$(dirname "$0")/common.sh"

works "very many bodies" scene --shapes shapes.json --bodies 200001 --density 0.1 --seed 1 --out many.csv
fails "too many for an SVG" "narc: new.svg: 200001 .*200000.*png" collide --shapes shapes.json --bodies many.csv \
    --picture new.svg
awk 'BEGIN { print "shape,x,y,angle"; for (i = 0; i < 3000; i++) print "disc,0,0,0" }' >pile.csv
works "a pile of bodies" collide --shapes shapes.json --bodies pile.csv
check "all of them collide" reports "colliding pairs" 4498500
check "no progress line in a file" test ! -s err.txt
works "as many candidates as are allowed" collide --shapes shapes.json --bodies pile.csv --max-pairs 4498500
fails "one more" "narc: pile.csv: 4498500 candidate pairs, .*--max-pairs 4498499$" collide --shapes shapes.json \
    --bodies pile.csv --max-pairs 4498499 --out new.csv
if has_terminal; then
    script -qec "'$narc' collide --shapes shapes.json --bodies pile.csv" /dev/null >script.txt 2>&1 </dev/null
    check "progress on a terminal" grep -q "narrow phase, 4498500 pairs" script.txt
else
    echo "skipped: progress on a terminal"
fi
# The number of candidates is exact up to 2^32; counting stops there: 100,000 bodies in one place have 5e9.
awk 'BEGIN { print "shape,x,y,angle"; for (i = 0; i < 100000; i++) print "disc,0,0,0" }' >heap.csv
fails "a heap of bodies" "narc: heap.csv: more than 4294967295 candidate pairs, .*--max-pairs 100000000$" collide \
    --shapes shapes.json --bodies heap.csv --out new.csv --picture new.png

finish
