#!/bin/sh
# SPDX-License-Identifier: MIT
#
# fit_errors.sh NARC [FONT] - narc fit: damaged inputs.
. "$(dirname "$0")/common.sh"
mkdir fits
printf '1,1\n3,1\n3,3\n1,3\n' >fits/square.csv
printf 'shape,x,y,angle\ndisc,0,0,0\n' >disc.csv
works "an image" collide --shapes shapes.json --bodies disc.csv --picture fits/disc.png

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
mkdir nothing && : >none.csv && cp fits/square.csv 0.csv && printf '0,0\n1,x\n' >word.csv
fails "fit: one empty file of many" "narc: none.csv: the text is empty" fit 0.csv none.csv fits/square.csv --arcs 4 \
    --out new.json
for kind in "--arcs 4" "--chain --tolerance 0.1"; do
    "$narc" fit none.csv 0.csv flat.csv word.csv absent.csv fits/square.csv nothing $kind --keep-going --out some.json \
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
narc: nothing: a folder without .svg or .png files
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
