#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh world.sh WORLD: the example world from its command line, and what it draws.
set -eu
world=$1
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
"$world" stack --picture "$folder/none/world.svg" >/dev/null 2>&1 && fail "no error for a folder that does not exist"

"$world" car --seconds 4 --seed 3 --substeps 4 --flat-angle 20 --threads 2 --picture "$folder/world.svg" --every 2 \
    >"$folder/report"
[ "$(wc -l <"$folder/report")" -eq 6 ] || fail "a line for each second, a title, and the hash: $(cat "$folder/report")"
[ "$(grep -c '<path.*fill=.hsl' "$folder/world.svg")" -eq 9 ] || fail "three bodies at three times"
[ "$(grep -c '<path.*fill=.none' "$folder/world.svg")" -gt 9 ] || fail "ground"
[ "$(head -n 1 "$folder/world.svg" | grep -c "viewBox='.*[1-9].*'")" -eq 1 ] || fail "the picture has no size"
