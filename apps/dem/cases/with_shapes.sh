#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh with_shapes.sh PROGRAM CASE FOLDER SHAPES NAME SED: in FOLDER, runs the case CASE.json with all shapes of the file
# SHAPES whose names begin with NAME, and what the program prints in CASE.txt. SED changes the input besides.
set -eu
program=$1 case=$2 folder=$3 shapes=$4 name=$5 change=$6
cases=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder"
cp "$shapes" "$folder/shapes.json"
cd "$folder"
names=$(grep -o "\"name\": *\"${name}[^\"]*\"" shapes.json | sed 's/"name": *//' | paste -s -d , -)
sed "s/\[\"disc\"\]/[$names]/; $change" "$cases/$case.json" >"$case.json"
"$program" "$case.json" --threads 1 >"$case.txt"
