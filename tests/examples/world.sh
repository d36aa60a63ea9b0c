#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh world.sh WORLD NARC: the example world from its command line; narc reads and draws what it writes.
set -eu
world=$1 narc=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() {
    echo "$*" >&2
    exit 1
}

"$world" --help | grep -q bullets || fail "--help lists no scenes"
for wrong in "" "nothing" "stack --seconds" "stack --seconds x" "stack --seconds 0" "stack --what 1"; do
    # shellcheck disable=SC2086 # words are arguments
    "$world" $wrong >/dev/null 2>&1 && fail "no error: world $wrong"
done
"$world" stack --out "$folder/none" >/dev/null 2>&1 && fail "no error for a folder that does not exist"

"$world" heap --seconds 4 --seed 3 --substeps 4 --flat-angle 20 --threads 2 --out "$folder" >"$folder/report"
[ "$(wc -l <"$folder/report")" -eq 6 ] || fail "a line for each second, a title, and the hash: $(cat "$folder/report")"
"$narc" collide --shapes "$folder/shapes.json" --bodies "$folder/bodies.csv" --out "$folder/contacts.csv" \
    --picture "$folder/world.png" >/dev/null
[ "$(wc -l <"$folder/bodies.csv")" -eq 204 ] || fail "203 bodies and a header: $(wc -l <"$folder/bodies.csv")"
[ "$(wc -l <"$folder/contacts.csv")" -gt 200 ] || fail "bodies that lie on each other touch"
[ -s "$folder/world.png" ] || fail "no picture"
