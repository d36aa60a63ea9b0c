#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh all.sh PROGRAM FOLDER SAND PROCESSES: slopes, collisions, piles of discs and long grains, biaxial tests,
# hoppers, some at a time; SAND is a file of fitted grains. What each found goes to FOLDER/results.txt.
set -eu
program=$1 sand=$3 processes=$4
mkdir -p "$2"
folder=$(cd "$2" && pwd)
cases=$(cd "$(dirname "$0")" && pwd)
sand=$(cd "$(dirname "$sand")" && pwd)/$(basename "$sand")
shapes=$cases/shapes.json
# Long grains need more room before they fall.
wider='s/\[0.0015, 0.0015\]/[0.0016, 0.0016]/; s/0.060, 0.150\]/0.060, 0.160]/; s/"jitter": 0.1/"jitter": 0.05/'

# A command a line.
cat >"$folder/jobs.txt" <<END
sh '$cases/rolling.sh' '$program' '$folder/rolling' > '$folder/rolling.txt'
sh '$cases/collision.sh' '$program' '$folder/collision' > '$folder/collision.txt'
sh '$cases/pile.sh' '$program' '$folder/pile-disc' '$shapes' disc > '$folder/pile-disc.txt'
sh '$cases/pile.sh' '$program' '$folder/pile-long' '$shapes' long '$wider' > '$folder/pile-long.txt'
sh '$cases/biaxial.sh' '$program' '$folder/biaxial-smooth' '$shapes' disc 0 > '$folder/biaxial-smooth.txt'
sh '$cases/biaxial.sh' '$program' '$folder/biaxial-disc' '$shapes' disc 0.5 > '$folder/biaxial-disc.txt'
sh '$cases/biaxial.sh' '$program' '$folder/biaxial-sand' '$sand' '' 0.5 > '$folder/biaxial-sand.txt'
sh '$cases/hopper.sh' '$program' '$folder/hopper' > '$folder/hopper.txt'
END
tr '\n' '\0' <"$folder/jobs.txt" | xargs -0 -n 1 -P "$processes" sh -c
rm "$folder/jobs.txt"
cd "$folder"
for name in rolling collision pile pile-disc pile-long biaxial-smooth biaxial-disc biaxial-sand hopper; do
    [ ! -e "$name.txt" ] || printf '%s: %s\n' "$name" "$(cat "$name.txt")"
done >results.txt
