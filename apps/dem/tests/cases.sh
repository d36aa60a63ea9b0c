#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh cases.sh DEM CASES rolling|collision|pile|biaxial|hopper: small versions of the cases of the page, whose answers are known.
# shellcheck disable=SC2016 # conditions are awk programs
set -eu
dem=$1 cases=$2 case=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
shapes=$cases/shapes.json
quiet='s/"vtk": "[^"]*", //'

# check WORDS CONDITION VALUE...: the condition is awk's, over $1, $2 ...
check() {
    what=$1 condition=$2
    shift 2
    echo "$what: $*"
    echo "$*" | awk "{ exit !($condition) }" || {
        echo "not as it should be: $condition" >&2
        exit 1
    }
}

# Errors of the slip that springs take at the start, of a long way.
rolling() {
    result=$(sh "$cases/rolling.sh" "$dem" "$folder/rolling" "s/\"duration\": 10/\"duration\": 4/" 2>/dev/null)
    check "rolling and sliding" '$4 > 0 && $4 < 5e-4 && $6 < 5e-4' "$(echo "$result" | tr -d ,)"
    check "frictions and arcs" '$1 == 10 && $2 == 0' \
        "$(awk '{ n++; d += ($2 - $3) ^ 2 + ($4 - $5) ^ 2 } END { print n, (d > 1e-8) }' "$folder/rolling/rolling.dat")"
}

# With 100 steps a contact restitution is met within 0.01, and tables have nine digits of what is conserved. With four
# times as many steps the error of damped collisions is a quarter, that of undamped ones a 64th.
collision() {
    result=$(sh "$cases/collision.sh" "$dem" "$folder/collision" "20 80" 2>/dev/null)
    check "collisions" '$4 < 0.01 && $7 < 1e-8 && $11 < 1e-8 && $14 < 2e-3' "$(echo "$result" | tr -d ,)"
    check "ratios of errors" '$1 > 30 && $1 < 120 && $2 > 2 && $2 < 8 && $3 > 20 && $3 < 120 && $4 > 2 && $4 < 12' \
        "$(awk 'NR == 1 { split($0, a) } END { print a[2] / $2, a[3] / $3, a[4] / $4, a[5] / $5 }' \
            "$folder/collision/order.dat")"
}

# The flanks of discs, which roll, are less steep than those of long grains, which do not. 50 grains along the table tell it
# within some degrees.
pile() {
    small='s/"count": 5000/"count": 1100/; s/0\.060/0.025/g; s/"width": 0\.120/"width": 0.050/; s/0\.0605/0.0255/g
        s/0\.062/0.027/g; s/0\.150, 0\]/0.070, 0]/g; s/"duration": 0\.3/"duration": 0.25/; s/"duration": 0\.8/"duration": 0.6/
        s/"duration": 1\.2/"duration": 0.2/; s/"kn": 200/"kn": 50/; s/1e-5/2e-5/; s/"max_overlap": 0\.1/"max_overlap": 0.3/
        s/0\.0015, 0\.0015/0.0016, 0.0016/; s/"jitter": 0\.1/"jitter": 0.02/'
    for shape in disc long; do
        sh "$cases/pile.sh" "$dem" "$folder/$shape" "$shapes" "$shape" "$small; $quiet" >"$folder/$shape.txt"
    done
    check "angles of repose of discs and long grains" '$3 > 10 && $3 < 27 && $6 > 22 && $6 < 45 && $6 > $3 + 4' \
        "$(cat "$folder/disc.txt" "$folder/long.txt" | tr '\n' ' ')"
}

# Discs without friction carry a load with as many contacts as it takes: 4 for each disc in the limit of small overlaps,
# counting those with walls once, so a little less in a small box; with friction it is between 3 and 4. Their angle of
# friction is 5 to 6 degrees, and 15 to 20 with friction of 0.5; 289 of them tell it within 5.
biaxial() {
    small='s/"count": 5000/"count": 289/; s/-57, -57, 57, 57/-15, -15, 15, 15/; s/57, 0\]/15, 0]/; s/\[0, 57/[0, 15/
        s/\[0, -57/[0, -15/; s/"spacing": \[1\.6, 1\.6\]/"spacing": [1.75, 1.75]/; s/"duration": 400/"duration": 110/
        s/"duration": 500/"duration": 150/; s/"every": 10/"every": 5/; s/-0\.01\]/-0.008]/'
    for friction in 0 0.5; do
        sh "$cases/biaxial.sh" "$dem" "$folder/$friction" "$shapes" disc $friction "$small; $quiet" >"$folder/$friction.txt"
    done
    check "without friction" '$2 > 3.7 && $2 < 4.2 && $4 < 0.15 && $7 < 11' "$(tr -d , <"$folder/0.txt")"
    check "with friction" '$2 > 3 && $2 < 3.6 && $7 > 10 && $7 < 25' "$(tr -d , <"$folder/0.5.txt")"
    check "friction angles" '$14 > $7 + 3' "$(cat "$folder/0.txt" "$folder/0.5.txt" | tr -d , | tr '\n' ' ')"
}

# Beverloo's law: a flow in proportion to (D - k d)^(3/2), with k between 1 and 2.
hopper() {
    small='s/\[-25, 0\]/[-16, 0]/; s/\[25, 0\]/[16, 0]/; s/-24\.5, 4\.6, 24\.5, 71/-15.5, 4.6, 15.5, 48/; s/\[0, 83\]/[0, 58]/
        s/"width": 24/"width": 15/; s/\[0, 76\]/[0, 52]/; s/"count": 2000/"count": 800/; s/"duration": 150/"duration": 90/
        s/"kn": 20000/"kn": 5000/; s/0\.0007/0.0014/; s/"max_overlap": 0\.1/"max_overlap": 0.3/; s/"every": 5/"every": 1/'
    result=$(sh "$cases/hopper.sh" "$dem" "$folder/hopper" "5 6.5 8.5" "$small; $quiet" | tr -d ,)
    check "Beverloo's law" '$2 > 0 && $2 < 2.5 && $6 < 0.15 && $12 > 1.25 && $12 < 1.75' "$result"
}

"$case" 2>&1
