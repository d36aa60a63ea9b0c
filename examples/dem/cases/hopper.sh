#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh hopper.sh PROGRAM FOLDER [COUNT DURATION]: the case hopper.json with openings of 6, 8, 11 and 15 grains. Writes
# hopper.dat (opening, mass that flows in a unit of time, and that to the power of 2/3) and prints Beverloo's law as it is
# fitted to it: W = c (D - k d)^(3/2).
set -eu
program=$1 folder=$2 count=${3:-2000} duration=${4:-150}
cases=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder"
cd "$folder"
cp "$cases/shapes.json" .
echo "# opening  flow  flow^(2/3)" >hopper.dat
for opening in 6 8 11 15; do
    place=$(awk "BEGIN { print 10.5 + $opening / 2 }")
    sed "s/14\.5, 14\]/$place, 14]/; s/\"count\": 2000/\"count\": $count/; s/\"duration\": 150/\"duration\": $duration/
        s/\"hopper/\"hopper-$opening/" "$cases/hopper.json" >"hopper-$opening.json"
    "$program" "hopper-$opening.json" --threads 1 >"hopper-$opening.txt"
    # Potential energy counts borders that were crossed: its slope, over the last two thirds, is W g times the cell's
    # height.
    awk -F , -v opening="$opening" -v duration="$duration" 'NR > 1 && $2 > duration / 3 {
        n++; st += $2; se += $4; stt += $2 * $2; ste += $2 * $4
    } END {
        flow = -(n * ste - st * se) / (n * stt - st * st) / 84
        print opening, flow, flow ^ (2 / 3)
    }' "hopper-$opening.csv" >>hopper.dat
done
# W^(2/3) is a line over D, by least squares; the scatter is the largest relative distance of W from it. And the slope of
# log W over log(D - k d).
awk '!/^#/ { n++; d[n] = $1; w[n] = $2; x += $1; y += $3; xx += $1 * $1; xy += $1 * $3 }
END {
    slope = (n * xy - x * y) / (n * xx - x * x)
    k = -(y - slope * x) / n / slope
    for (i = 1; i <= n; i++) {
        off = w[i] / (slope * (d[i] - k)) ^ 1.5 - 1
        if (off < 0) off = -off
        if (off > scatter) scatter = off
        a = log(d[i] - k); b = log(w[i])
        p += a; q += b; pp += a * a; pq += a * b
    }
    printf "k %.2f, c %.3f, scatter %.3f, exponent %.2f\n", k, slope ^ 1.5, scatter, (n * pq - p * q) / (n * pp - p * p)
}' hopper.dat
