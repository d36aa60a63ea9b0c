#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh rolling.sh PROGRAM FOLDER [SED]: the case rolling.json with discs, and with the same circle given as eight
# arcs. Files go to FOLDER. rolling.dat has, for each friction, the accelerations of disc and arcs along the slope, over
# the second half of the time, those of their rims, and what theory says of both. speeds.dat has, for each frame, the
# time and the speeds of all discs. Prints the largest errors, as shares of the acceleration. SED changes the input
# besides.
set -eu
program=$1 folder=$2 change=${3:-}
cases=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder"
cp "$cases/shapes.json" "$folder"
cd "$folder"
for shape in disc round; do
    sed "s/\"shape\": \"disc\"/\"shape\": \"$shape\"/; s/\"rolling.csv\"/\"$shape.csv\"/g; $change" \
        "$cases/rolling.json" >"$shape.json"
    "$program" "$shape.json" --threads 1 >"$shape.txt"
done
every=$(sed -n 's/.*"every": \([0-9.]*\),.*/\1/p' disc.json)
gravity=$(sed -n 's/.*"gravity": \[\([^]]*\)\].*/\1/p' disc.json | tr -d ,)
frictions=$(sed -n 's/.*"materials": \["slope", .*"friction": \([0-9.]*\)}.*/\1/p' disc.json | paste -s -d ' ' -)
last=$(find . -name 'disc-0*.csv' | sort | tail -n 1 | sed 's/.*-0*//; s/\.csv//')
half=$(printf '%06d' $((last / 2))) end=$(printf '%06d' "$last")
awk -F , -v every="$every" '
FNR == 1 { if (NR > 1) print line; line = every * frame++; next }
{ line = line " " $7 }
END { print line }' disc-0*.csv >speeds.dat
# Below a third of tan(angle) friction is too weak: the grain slides, and turns as fast as friction makes it.
awk -F , -v every="$every" -v frames=$((last - last / 2)) -v gravity="$gravity" -v frictions="$frictions" '
FNR == 1 { file++; next }
file % 2 { speed[file, FNR] = $7; rim[file, FNR] = $9 * $6 / 2; next }
{
    along[file / 2, FNR] = ($7 - speed[file - 1, FNR]) / (every * frames)
    turn[file / 2, FNR] = -($9 * $6 / 2 - rim[file - 1, FNR]) / (every * frames)
    count = FNR
}
END {
    split(gravity, g, " "); split(frictions, mu, " ")
    for (k = 2; k <= count; k++) {
        slides = -mu[k - 1] * g[2] < g[1] / 3
        a = slides ? g[1] + mu[k - 1] * g[2] : g[1] * 2 / 3
        b = slides ? -2 * mu[k - 1] * g[2] : a
        printf "%g %.6f %.6f %.6f %.6f %.6f %.6f\n", mu[k - 1], along[1, k], along[2, k], turn[1, k], turn[2, k], a, b
    }
}' "disc-$half.csv" "disc-$end.csv" "round-$half.csv" "round-$end.csv" >rolling.dat
awk 'function off(found, right) { return found > right ? found - right : right - found }
{
    if ($6 == $7) { for (i = 2; i <= 5; i++) if (off($i, $6) / $6 > rolls) rolls = off($i, $6) / $6; next }
    for (i = 2; i <= 5; i++) if (off($i, $(i < 4 ? 6 : 7)) / $6 > slides) slides = off($i, $(i < 4 ? 6 : 7)) / $6
}
END { printf "largest error, rolling %.1e, sliding %.1e\n", rolls, slides }' rolling.dat
