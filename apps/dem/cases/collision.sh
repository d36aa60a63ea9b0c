#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh collision.sh PROGRAM FOLDER [STEPS]: the case collision.json with both laws. Files go to FOLDER.
# restitution.dat has the restitution that is given, and those that are found: with the linear law, with the Hertz law,
# and with that at a tenth of the speed, 100 steps a contact. order.dat has, for 10 to 640 steps a contact or those in
# the list, the root mean square of what is off in ten pairs: linear law, restitution 1 and 0.5, Hertz law, the same.
# Prints the largest error of the first table, and by which share of them a collision with friction changes the
# momentum, the angular momentum and the energy.
set -eu
program=$1 folder=$2 numbers=${3:-10 20 40 80 160 320 640}
cases=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder"
cp "$cases/shapes.json" "$folder"
cd "$folder"
young=20000

# find_step LAW SPEED STEPS: the time step, for an elastic collision. Linear: it lasts pi sqrt(m / kn). Hertz: 2.943275
# times the depth over the speed, the depth being (5 m v^2 / (4 k))^(2/5) with k = 4/3 E* sqrt(R).
find_step() {
    awk -v law="$1" -v speed="$2" -v steps="$3" -v young=$young 'BEGIN {
        pi = 3.14159265358979; m = pi / 8
        k = 4 / 3 * young / 2 * sqrt(1 / 4)
        time = law == "hertz" ? 2.943275 * (5 * m * speed ^ 2 / (4 * k)) ^ 0.4 / speed : pi * sqrt(m / 1000)
        printf "%.9g", time / steps
    }'
}

# collide LAW SPEED STEPS [SED]: the table of grains after it is after.csv, that of measures collision.csv.
collide() {
    change=${4:-}
    [ "$1" = linear ] || change="$change; s/\"linear\", \"kn\": 1000/\"hertz\"/
        s/\"density\": 1}/\"density\": 1, \"young\": $young, \"poisson\": 0}/g"
    long=$(awk "BEGIN { print 0.4 / $2 }")
    sed "s/\"time_step\": [0-9.]*/\"time_step\": $(find_step "$1" "$2" "$3")/; s/\[1, 0\]/[$2, 0]/
        s/\"duration\": 0.4/\"duration\": $long/; s/\"every\": 0.4/\"every\": $long/; $change" "$cases/collision.json" \
        >collision.json
    "$program" collision.json --threads 1 >collision.txt
    mv collision-000001.csv after.csv
}

# Speeds apart, over the speed at the start.
find_restitutions() {
    awk -F , -v speed="$1" 'NR > 1 { if (NR % 2) printf "%.9g\n", ($7 - before) / speed; before = $7 }' after.csv
}

collide linear 1 100
sed -n 's/.*"materials": \[.*"restitution": \([0-9.]*\)}.*/\1/p' collision.json >given.txt
find_restitutions 1 >linear.txt
collide hertz 1 100
find_restitutions 1 >hertz.txt
collide hertz 0.1 100
find_restitutions 0.1 >slow.txt
paste -d ' ' given.txt linear.txt hertz.txt slow.txt >restitution.dat
awk '{ for (i = 2; i <= 4; i++) { d = $i > $1 ? $i - $1 : $1 - $i; if (d > most) most = d } }
    END { printf "restitution off by %.4f, ", most }' restitution.dat

for steps in $numbers; do
    echo "$steps"
    for law in linear hertz; do
        for wanted in 1 0.5; do
            collide $law 1 "$steps" "s/\"restitution\": [0-9.]*}/\"restitution\": $wanted}/"
            find_restitutions 1 |
                awk -v wanted=$wanted '{ sum += ($1 - wanted) ^ 2 } END { printf "%.4g\n", sqrt(sum / NR) }'
        done
    done
done | paste -d ' ' - - - - - >order.dat

collide linear 1 100 's/\[1, 0\]/[1, 0.4]/; s/"friction": 0/"friction": 0.5/'
# A disc's moment of inertia is m size^2 / 8. The table has nine digits.
awk -F , 'FNR == 1 { file++; next }
    { k = int(FNR / 2); x[file, k] += $13 * $7; y[file, k] += $13 * $8
      turn[file, k] += $13 * ($2 * $8 - $3 * $7 + $6 * $6 / 8 * $9); count = k }
    function most(now, before, size) { d = now > before ? now - before : before - now; return d / size }
    END {
        for (k = 1; k <= count; k++) {
            m = most(x[2, k], x[1, k], x[1, k]); if (m > a) a = m
            m = most(y[2, k], y[1, k], x[1, k]); if (m > a) a = m
            m = most(turn[2, k], turn[1, k], 1 + 3 * k); if (m > b) b = m
        }
        printf "momentum by %.0e, angular momentum by %.0e, ", a, b
    }' collision-000000.csv after.csv
awk -F , 'NR > 1 { energy[NR] = $3 + $5 + $6 + $7 }
    END { d = energy[3] / energy[2] - 1; printf "energy by %.0e\n", d < 0 ? -d : d }' collision.csv
