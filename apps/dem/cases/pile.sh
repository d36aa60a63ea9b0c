#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh pile.sh PROGRAM FOLDER SHAPES NAME [SED]: the case pile.json with all shapes of the file SHAPES whose names begin
# with NAME. Files go to FOLDER; prints the angle of repose, left, right and mean. SED changes the input besides.
set -eu
program=$1 folder=$2 shapes=$3 name=$4 change=${5:-}
cases=$(cd "$(dirname "$0")" && pwd)
sh "$cases/with_shapes.sh" "$program" pile "$folder" "$shapes" "$name" "$change"
cd "$folder"
last=$(find . -name 'pile-0*.csv' | sort | tail -n 1)
width=$(sed -n 's/.*"table".*"width": \([0-9.]*\),.*/\1/p' pile.json)
awk -F , -v half="$(awk "BEGIN { print $width / 2 }")" -f "$cases/repose.awk" "$last"
