#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh hopper.sh PROGRAM FOLDER [OPENINGS SED]: the case hopper.json with openings of 6, 8, 10 and 13 grains, or of those
# in the list. Writes hopper.dat (opening, mass that flows in a unit of time, and that to the power of 2/3) and prints
# Beverloo's law as it is fitted to it: W = c (D - k d)^(3/2). SED changes the input besides.
set -eu
program=$1 folder=$2 openings=${3:-6 8 10 13} change=${4:-}
cases=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder"
cd "$folder"
cp "$cases/shapes.json" .
echo "# opening  flow  flow^(2/3)" >hopper.dat
for opening in $openings; do
    place=$(awk "BEGIN { print 10.5 + $opening / 2 }")
    sed "s/14\.5, 3\]/$place, 3]/; s/\"hopper/\"hopper-$opening/g; $change" "$cases/hopper.json" >"hopper-$opening.json"
    "$program" "hopper-$opening.json" --threads 1 >"hopper-$opening.txt"
    # The mass that has crossed the periodic border below the opening: over the last two thirds of the time.
    last=$(find . -name "hopper-$opening-0*.csv" | sort | tail -n 1)
    number=$(echo "$last" | sed 's/.*-0*//; s/\.csv//')
    first=$(printf 'hopper-%s-%06d.csv' "$opening" $((number / 3)))
    every=$(sed -n 's/.*"every": \([0-9.]*\),.*/\1/p' "hopper-$opening.json")
    awk -F , -v opening="$opening" -v time="$(awk "BEGIN { print $every * ($number - int($number / 3)) }")" '
    FNR > 1 { sum[FILENAME] -= $13 * $15 }
    END {
        flow = (sum[ARGV[2]] - sum[ARGV[1]]) / time
        print opening, flow, flow ^ (2 / 3)
    }' "$first" "$last" >>hopper.dat
done
# W^(2/3) is a line over D, by least squares; the scatter is the largest relative distance of W from it. And the slope of
# log W over log(D - 1.4 d), with the k that Beverloo found.
awk '!/^#/ { n++; d[n] = $1; w[n] = $2; x += $1; y += $3; xx += $1 * $1; xy += $1 * $3 }
END {
    slope = (n * xy - x * y) / (n * xx - x * x)
    k = -(y - slope * x) / n / slope
    for (i = 1; i <= n; i++) {
        off = w[i] / (slope * (d[i] - k)) ^ 1.5 - 1
        if (off < 0) off = -off
        if (off > scatter) scatter = off
        a = log(d[i] - 1.4); b = log(w[i])
        p += a; q += b; pp += a * a; pq += a * b
    }
    printf "k %.2f, c %.3f, scatter %.3f, exponent with k = 1.4: %.2f\n", k, slope ^ 1.5, scatter, (n * pq - p * q) / (n * pp - p * p)
}' hopper.dat
