#!/bin/sh
# SPDX-License-Identifier: MIT
#
# cast.sh NARC [FONT] - narc cast: what rays hit, rays that begin within bodies, pictures, errors.
. "$(dirname "$0")/common.sh"

cat >rays.csv <<'END'
x,y,motion_x,motion_y
-5,0,10,0
10,5,0,-10
20,10,0,-20
-5,50,10,0
0,0,3,0
32.75,-3,0,1.5
END
header="ray,body,fraction,normal_x,normal_y,point_x,point_y,arc"

# hit FILE LINE VALUES: the first seven columns of a row are these numbers, within 2e-7.
hit() {
    awk -F, -v line="$2" -v want="$3" 'BEGIN { n = split(want, w, " "); bad = 1 }
        NR == 1 { columns = NF }
        NR == line { bad = NF != columns; for (i = 1; i <= n; i++) { d = $i - w[i]; if (d > 2e-7 || d < -2e-7) bad = 1 } }
        END { exit bad }' "$1"
}

works "cast" cast $known --rays rays.csv --out hits.csv
check "header of the hits" test "$(head -n 1 hits.csv)" = "$header"
check "four rays hit; one passes, one ends before the disc" lines hits.csv 5
check "disc" hit hits.csv 2 "0 0 0.4 -1 0 -1 0"
check "side of a square" hit hits.csv 3 "1 2 0.4 0 1 10 1"
check "the nearer of two" hit hits.csv 4 "2 5 0.3875 0 1 20 2.25"
check "within a disc: it stops at once" hit hits.csv 5 "4 0 0 0 0"
check "report: rays" reports "all rays" 6
check "report: rays that hit" reports "rays that hit" 4
check "report: skipped" reports "skipped rays" 0

works "leaves" cast $known --rays rays.csv --inside leaves --most 3 --out leaves.csv
check "the next disc is nearer than the way out" hit leaves.csv 7 "4 1 0.166666667 -1 0 0.5 0"
check "the way out, its normal outwards" hit leaves.csv 8 "4 0 0.333333333 1 0 1 0"
works "ignores" cast $known --rays rays.csv --inside ignores --out ignores.csv
check "the next disc" hit ignores.csv 5 "4 1 0.166666667 -1 0 0.5 0"
works "most" cast $known --rays rays.csv --most 2 --out most.csv
check "both discs, the nearer first" hit most.csv 2 "0 0 0.4 -1 0 -1 0"
check "and then" hit most.csv 3 "0 1 0.55 -1 0 0.5 0"

works "hits on standard output" cast $known --rays rays.csv --out -
check "they are the same" cmp out.txt hits.csv
check "the report is on standard error" grep -q "rays that hit" err.txt
for isa in $isas; do
    for threads in 1 3; do
        works "$isa, $threads threads" cast $known --rays rays.csv --isa "$isa" --threads $threads --out same.csv
        check "the same hits" cmp same.csv hits.csv
    done
done
works "no bodies" cast --shapes shapes.json --bodies none.csv --rays rays.csv --out none.txt --picture none.png
check "only the header" lines none.txt 1
works "pictures" cast $known --rays rays.csv --picture rays.png
check "PNG" begins_with rays.png "XPNG"
# A bar of three tiles is one body: seams are not met.
cat > bar.json <<'END'
{"shapes": [{"name": "bar/1", "box": {"width": 1, "height": 1}, "origin": [0, 0]},
            {"name": "bar/2", "box": {"width": 1, "height": 1}, "origin": [1, 0]},
            {"name": "bar/3", "box": {"width": 1, "height": 1}, "origin": [2, 0]}]}
END
printf 'shape,x,y,angle\nbar,1,0,0\n' > bar.csv
printf 'x,y,motion_x,motion_y\n0,0,10,0\n-5,0,10,0\n' > bar_rays.csv
bar="--shapes bar.json --bodies bar.csv --rays bar_rays.csv"
works "leaves a whole" cast $bar --inside leaves --most 3 --out bar_hits.csv
check "by its end" hit bar_hits.csv 2 "0 0 0.25 1 0 2.5 0"
check "and enters it once" hit bar_hits.csv 3 "1 0 0.45 -1 0 -0.5 0"
works "ignores a whole" cast $bar --inside ignores --out bar_hits.csv
check "not from inside" hit bar_hits.csv 2 "1 0 0.45 -1 0 -0.5 0"
works "SVG" cast $known --rays rays.csv --most 2 --picture rays.svg
check "SVG" begins_with rays.svg "<?xml"

printf 'shape,x,y,angle\ndisc,0,0,0\ndisc,1e39,0,0\n' >far.csv
works "a body without a box" cast --shapes shapes.json --bodies far.csv --rays rays.csv --out far.txt
check "it is told of" says "without a box 1 bodies, beyond the range of single precision"
printf 'shape,x,y,angle\nbar,1,0,0\nbar,1e39,0,0\n' >far.csv
works "a body of three parts without a box" cast --shapes bar.json --bodies far.csv --rays bar_rays.csv --out far.txt
check "it is one" says "without a box 1 bodies, beyond the range of single precision"

fails "rays are missing" "narc: --rays is missing" cast $known --out new.csv
fails "inside" "narc: --inside must be stops, leaves or ignores 'out'" cast $known --rays rays.csv --inside out --out new.csv
printf 'x,y,motion_x\n0,0,1\n' >short.csv
fails "a column is missing" "short.csv:1: " cast $known --rays short.csv --out new.csv
printf 'x,y,motion_x,motion_y\n0,0,1,0\n0,0,0,0\n' >zero.csv
fails "no length" "zero.csv:3: motion_x and motion_y make a ray of no length '0'" cast $known --rays zero.csv --out new.csv
printf 'x,y,motion_x,motion_y\n0,0,1e39,0\n' >long.csv
fails "too long" "long.csv:2: motion_x is beyond the range of single precision '1e39'" cast $known --rays long.csv --out new.csv
finish
