#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh biaxial.sh PROGRAM FOLDER SHAPES NAME FRICTION [SED]: the case biaxial.json with the shapes of the file
# SHAPES whose names begin with NAME. Files go to FOLDER. Prints, at the end of the first stage, the mean number of
# contacts of a grain that is no rattler and the share of rattlers; and the angle of friction in degrees, the mean over
# the last third of the second stage: its sine is (s_yy - s_xx) / (s_yy + s_xx). biaxial.dat has the strain of y, both
# stresses, and the strain of the area. SED changes the input besides.
set -eu
program=$1 folder=$2 shapes=$3 name=$4 friction=$5 change=${6:-}
cases=$(cd "$(dirname "$0")" && pwd)
sh "$cases/with_shapes.sh" "$program" biaxial "$folder" "$shapes" "$name" "s/\"friction\": 0.5/\"friction\": $friction/; $change"
cd "$folder"
pressed=$(sed -n 's/.*"press", "duration": \([0-9.]*\).*/\1/p' biaxial.json)
every=$(sed -n 's/.*"every": \([0-9.]*\),.*/\1/p' biaxial.json)
frame=$(awk "BEGIN { printf \"%06d\", $pressed / $every }")
awk -F , -v pressed="$pressed" '$2 > pressed * 0.9999 && $2 < pressed * 1.0001 && $9 > 0.9 && $12 > 0.9 { found = 1 }
    END { if (!found) print "biaxial: the first stage ends before the stress is there" >"/dev/stderr"; exit !found }' biaxial.csv
awk -F , 'NR > 1 { n++; if ($11 > 0) { m++; z += $11 } } END { printf "contacts %.3f, rattlers %.3f, ", z / m, 1 - m / n }' \
    "biaxial-$frame.csv"
# A plate's place is the middle of its block, so distances of plates count from those at the start, which are known.
awk -F , -v pressed="$pressed" '
NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
NR == 2 { wide0 = $(at["right_x"]) - $(at["left_x"]); high0 = $(at["top_y"]) - $(at["bottom_y"]) }
{
    wide = size + $(at["right_x"]) - $(at["left_x"]) - wide0
    high = size + $(at["top_y"]) - $(at["bottom_y"]) - high0
    if ($2 <= pressed * 1.0001) { wide1 = wide; high1 = high }
    if ($2 >= pressed * 0.9999) print (high1 - high) / high1, $12, $9, 1 - wide * high / (wide1 * high1)
}' size="$(sed -n 's/.*"right".*"point": \[\([0-9.]*\),.*/\1/p' biaxial.json | awk '{ print 2 * $1 }')" \
    biaxial.csv >biaxial.dat
awk '{ e[NR] = $1; s[NR] = ($2 - $3) / ($2 + $3) } END {
    for (i = 1; i <= NR; i++) if (e[i] > e[NR] * 2 / 3) { n++; sum += s[i] }
    mean = sum / n
    printf "friction angle %.1f\n", atan2(mean, sqrt(1 - mean * mean)) * 180 / 3.14159265358979
}' biaxial.dat
