#!/bin/sh
# SPDX-License-Identifier: MIT
#
# fit_errors.sh NARC [FONT] - narc fit: wrong options and damaged inputs.
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
nofit "neither arcs nor tolerance" "narc: --arcs or --tolerance is missing"
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
nofit "no edges and edges" "narc: --no-edges and --edges exclude" --arcs 4 --edges --no-edges --parts 3
nofit "no edges without parts" "narc: --no-edges is for --parts" --arcs 4 --no-edges
nofit "a word that is no UTF-8" "narc: --objective must be .* not '?x'" --arcs 4 --objective "$(printf '\377x')"
nofit "a chain without a tolerance" "narc: --arcs or --tolerance is missing" --chain
nofit "characters without a font" "narc: --characters is for fonts" --arcs 4 --characters a
nofit "threshold without an image" "narc: --threshold is for PNG and SVG" --arcs 4 --threshold 0.4
nofit "silhouette without an image" "narc: --silhouette is for PNG and SVG" --arcs 4 --silhouette dark
fails "fit: picture of another kind" "narc: .*new.jpg" fit fits/square.csv --arcs 4 --out new.json --picture new.jpg
fails "fit: picture in no folder" "narc: absent/new.png" fit fits/square.csv --arcs 4 --out new.json \
    --picture absent/new.png
fails "fit: output is an input" "narc: fits/square.csv: .*input" fit fits/square.csv --arcs 4 --out fits/square.csv
fails "fit: no such font" "narc: absent.ttf: " fit absent.ttf --characters a --arcs 8 --out new.json
fails "fit: one missing file of two" "narc: absent.csv: " fit fits/square.csv absent.csv --arcs 8 --out new.json
fails "fit: a folder" "narc: fits: " fit fits --arcs 8 --out new.json
fails "fit: a shapes file" "\(narc: \)*shapes.json:" fit shapes.json --arcs 8 --out new.json

# damaged SUFFIX NAME PATTERN TEXT: a file with this text (printf's notation) is refused.
damaged() {
    printf "$4" >"bad.$1"
    fails "fit: $1, $2" "$3" fit fits/square.csv "bad.$1" --arcs 4 --out new.json --picture new.png
}
damaged csv "empty" "narc: bad.csv: " ''
damaged csv "word for a number" "bad.csv:3: .*'up'" '0,0\n1,0\n1,up\n'
damaged csv "three columns" "bad.csv:2: .*'1,0,5'" '0,0\n1,0,5\n1,1\n'
damaged csv "not in a plane" "bad.csv:2: z changes, .*'1,0,5'" '0,0,4\n1,0,5\n1,1,4\n'
damaged csv "no column x" "bad.csv:1: the header has no column 'x': 'east;north'" 'east;north\n1;2\n'
damaged csv "a column named" "bad.csv:3: y is not a number: 'up'" 'id,y,x\n1,0,0\n2,up,1\n3,0,1\n'
damaged csv "NaN" "bad.csv:4: .*'nan'" 'x,y\n0,0\n1,0\nnan,1\n'
damaged csv "too large" "bad.csv:2: x is 2000000000," '0,0\n2e9,0\n1,1\n'
damaged csv "NUL byte" "bad.csv:2: " '0,0\n1,0\000\n1,1\n'
damaged csv "two points" "narc: bad.csv: " '0,0\n1,0\n'
damaged csv "points on a line" "narc: bad.csv: " '0,0\n1,0\n2,0\n'
damaged json "nested too deep" "bad.json:1: lists and objects nested more than 1000 deep" \
    "$(printf '%01100d' 0 | tr 0 '[')"
damaged json "cut off" "bad.json:2: .*JSON" '[[0, 0],\n [1, 0'
damaged json "no point" "narc: bad.json: point 1 of contour 0 .*'7'" '[[0, 0],\n 7, [1, 1]]\n'
damaged json "one coordinate" "narc: bad.json: point 2 .*'\[1]'" '[[0, 0],\n [1, 0],\n [1]]\n'
damaged ttf "no font" "narc: bad.ttf: .*--characters" 'hello\n'
damaged dat "no known kind" "narc: bad.dat: .*SVG" 'hello\n'
head -c 200 fits/disc.png >bad.png
fails "fit: png, cut off" "narc: bad.png: " fit bad.png --arcs 4 --out new.json
printf '0,0\n1,1\n2,2\n' >flat.csv
fails "fit: points on a line" "narc: flat.csv: .*line" fit flat.csv --arcs 4 --out new.json

# Errors in some of many files.
: >none.csv && cp fits/square.csv 0.csv && printf '0,0\n1,x\n' >word.csv
fails "fit: one empty file of many" "narc: none.csv: the text is empty" fit 0.csv none.csv fits/square.csv --arcs 4 \
    --out new.json
for kind in "--arcs 4" "--chain --tolerance 0.1"; do
    "$narc" fit none.csv 0.csv flat.csv word.csv absent.csv fits/square.csv fits $kind --keep-going --out some.json \
        --picture some.png >out.txt 2>err.txt
    check "keep going, $kind: status 1" test $? -eq 1
    left="shape-0 square "
    check "keep going, $kind: the others" \
        test "$(grep -o '"name": "[^"]*"' some.json | cut -d'"' -f4 | tr '\n' ' ')" = "$left"
    check "keep going, $kind: their table" test "$(tail -n +2 out.txt | cut -d' ' -f1 | tr '\n' ' ')" = "$left"
    cat >expected.txt <<EOT
narc: none.csv: the text is empty
word.csv:2: y is not a number: 'x'
narc: absent.csv: No such file or directory
narc: fits: Is a directory
narc: flat.csv: all points of the outline lie on a line, it has no area
narc: errors: 5; shapes written: 2
EOT
    [ "$kind" = "--arcs 4" ] ||
        sed -i 's/^narc: flat.csv: .*/narc: flat.csv: contour 0: line 2 meets line 0 of contour 0 at (1, 1)/' expected.txt
    check "keep going, $kind: each error and their number" cmp err.txt expected.txt
done
works "keep going without errors" fit 0.csv --arcs 4 --keep-going --out some.json
"$narc" fit none.csv absent.csv --arcs 4 --keep-going --out new.json >out.txt 2>err.txt
check "keep going with nothing left: status 2" test $? -eq 2 -a ! -e new.json
check "keep going with nothing left: it is told" grep -q "^narc: no outline is left to fit" err.txt
if [ -n "$font" ]; then
    "$narc" fit "$font" --characters "a b" --arcs 4 --keep-going --out some.json >out.txt 2>err.txt
    check "keep going in a font: status 1" test $? -eq 1
    check "keep going in a font: the other glyphs" test "$(grep -o '"name": "[^"]*"' some.json | tr '\n' ' ')" = \
        '"name": "a" "name": "b" '
    check "keep going in a font: the error" grep -q "^narc: $font: .*U+0020" err.txt
fi

finish
