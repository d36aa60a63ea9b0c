#!/bin/sh
# SPDX-License-Identifier: MIT
#
# fit_options.sh NARC [FONT] - narc fit: wrong options.
. "$(dirname "$0")/common.sh"
mkdir fits
printf '1,1\n3,1\n3,3\n1,3\n' >fits/square.csv
printf 'shape,x,y,angle\ndisc,0,0,0\n' >disc.csv
works "an image" collide --shapes shapes.json --bodies disc.csv --picture fits/disc.png

# ------------------------------------------------------------------------------------------- fits that cannot be
# nofit NAME PATTERN ARGUMENTS...: a square and these options are refused.
nofit() {
    name=$1 pattern=$2
    shift 2
    fails "fit: $name" "$pattern" fit fits/square.csv "$@" --out new.json --picture new.png
}
fails "fit: no input" "narc: INPUT is missing" fit --arcs 8 --out new.json
nofit "neither arcs nor tolerance" "narc: --arcs, --tolerance or --parts is missing"
nofit "exact parts and a goal" "narc: --bound is for fits: --parts alone" --parts 4 --bound
nofit "arcs and tolerance" "narc: --arcs and --tolerance exclude" --arcs 4 --tolerance 0.1
for arcs in 0 33 8.5 x -1 ""; do
    nofit "arcs '$arcs'" "narc: --arcs .*" --arcs "$arcs"
done
nofit "a polygon of two corners" "narc: --arcs .* 3 to 32, not '2'" --arcs 2 --polygon
nofit "the paper's route from two corners" "narc: --arcs .* 3 to 32, not '2'" --arcs 2 --paper
for tolerance in 0 -0.1 nan x ""; do
    nofit "tolerance '$tolerance'" "narc: --tolerance " --tolerance "$tolerance"
done
for flatness in 0 -1 0.2 1e-10 nan x ""; do
    nofit "flatness '$flatness'" "narc: --flatness " --arcs 4 --flatness "$flatness"
done
for threshold in 0 1 -0.5 nan x ""; do
    fails "fit: threshold '$threshold'" "narc: --threshold " fit fits/disc.png --arcs 4 --threshold "$threshold" \
        --out new.json
done
for silhouette in Alpha darkness 0 ""; do
    fails "fit: silhouette '$silhouette'" "narc: --silhouette .*" fit fits/disc.png --arcs 4 \
        --silhouette "$silhouette" --out new.json
done
fails "fit: silhouette, named" "narc: --silhouette must be one of alpha, dark, light, not 'darkness'" fit \
    fits/disc.png --arcs 4 --silhouette darkness --out new.json
for starts in 0 -1 10001 x ""; do
    nofit "starts '$starts'" "narc: --starts " --arcs 4 --starts "$starts"
done
for objective in length Area ""; do
    nofit "objective '$objective'" "narc: --objective " --arcs 4 --objective "$objective"
done
nofit "bound and approximate" "narc: --bound and --approximate exclude" --arcs 4 --bound --approximate
nofit "approximate perimeter" "narc: --objective perimeter is for --bound" --arcs 4 --approximate --objective perimeter
nofit "tolerance and objective" "narc: --tolerance and --objective exclude" --tolerance 1 --objective distance
nofit "edges and polygon" "narc: --edges and --polygon exclude" --arcs 4 --edges --polygon
nofit "edges and paper" "narc: --edges and --paper exclude" --arcs 4 --paper --edges
nofit "polygon and paper" "narc: --polygon and --paper exclude" --arcs 4 --paper --polygon
for family in polygon paper; do
    nofit "$family approximates" "narc: --$family and --approximate exclude" --arcs 4 --$family --approximate
    nofit "$family of least distance" "narc: --$family .*'distance'" --arcs 4 --$family --objective distance
done
for option in "--arcs 4" --bound --approximate "--objective area" --edges --polygon --paper "--flatness 0.01" \
    "--starts 3" --keep-origin; do
    nofit "a chain and ${option% *}" "narc: --chain and ${option% *} exclude" --chain $option
done
nofit "quick and starts" "narc: --quick and --starts exclude" --arcs 4 --quick --starts 3
nofit "no edges and edges" "narc: --no-edges and --edges exclude" --arcs 4 --edges --no-edges --parts 3
nofit "no edges without parts" "narc: --no-edges is for --parts and --tolerance" --arcs 4 --no-edges
nofit "a word that is no UTF-8" "narc: --objective must be .* not '?x'" --arcs 4 --objective "$(printf '\377x')"
nofit "a chain without a tolerance" "narc: --tolerance, within which chains" --chain
nofit "characters without a font" "narc: --characters is for fonts" --arcs 4 --characters a
nofit "threshold without an image" "narc: --threshold is for PNG and SVG" --arcs 4 --threshold 0.4
nofit "silhouette without an image" "narc: --silhouette is for PNG and SVG" --arcs 4 --silhouette dark
fails "fit: picture of another kind" "narc: .*new.jpg" fit fits/square.csv --arcs 4 --out new.json --picture new.jpg
fails "fit: picture in no folder" "narc: absent/new.png" fit fits/square.csv --arcs 4 --out new.json \
    --picture absent/new.png
fails "fit: output is an input" "narc: fits/square.csv: .*input" fit fits/square.csv --arcs 4 --out fits/square.csv
fails "fit: no such font" "narc: absent.ttf: " fit absent.ttf --characters a --arcs 8 --out new.json
fails "fit: one missing file of two" "narc: absent.csv: " fit fits/square.csv absent.csv --arcs 8 --out new.json
fails "fit: a shapes file" "\(narc: \)*shapes.json:" fit shapes.json --arcs 8 --out new.json

finish
