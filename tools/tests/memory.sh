#!/bin/sh
# SPDX-License-Identifier: MIT
#
# memory.sh NARC FONT PRELOAD - whichever allocation of the command fails. (Not of SVG files: librsvg ends the process.)
. "$(dirname "$0")/common.sh"
preload=$3
. "$docs/../tests/support/scarcity.sh"

printf '0,0\n4,0\n4,3\n1,4\n' >points.csv
printf 'x,y,motion_x,motion_y\n-5,0,10,0\n10,5,0,-10\n' >rays.csv
printf 'a,b\n0,1\n2,3\n' >pairs.csv
run_out "to standard output" 2 "" "$narc" collide $known --threads 1 --pairs pairs.csv --out -
run_out "pictures" 2 "c.csv c.png" "$narc" collide $known --threads 1 --out c.csv --picture c.png
run_out "scene" 2 s.csv "$narc" scene $five --density 0.5 --seed 1 --out s.csv
run_out "cast" 2 "h.csv h.svg" "$narc" cast $known --threads 1 --rays rays.csv --out h.csv --picture h.svg
run_out "fit" 2 "f.json f.png" "$narc" fit points.csv --arcs 4 --out f.json --picture f.png

# Nor does an input get lost.
cp shapes.json kept.json
number=1
while [ $number -le 30 ]; do
    once "" "" "$narc" scene $five --density 0.5 --seed 1 --out shapes.json && miss "an output is the input, allocation $number"
    cmp -s shapes.json kept.json || miss "the input is gone, allocation $number"
    cp kept.json shapes.json
    number=$((number + 1))
done
finish
