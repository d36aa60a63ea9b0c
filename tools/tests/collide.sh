#!/bin/sh
# SPDX-License-Identifier: MIT
#
# collide.sh NARC [FONT] - narc collide: answers, margins, pairs, pictures, progress.
. "$(dirname "$0")/common.sh"

works "collide" collide $known --out known.csv
check "header of the contacts" \
    test "$(head -n 1 known.csv)" = "a,b,separation,normal_x,normal_y,point_x,point_y,arc_a,arc_b"
check "six contacts; touching is not colliding" lines known.csv 7
check "disc and disc, 0.5 deep" contact known.csv 2 "0 1 -0.5 1 0 0.75 0"
check "disc in the side of a square" contact known.csv 3 "2 3 -0.25 1 0 10.875 0.5"
check "disc over a standing pill" contact known.csv 4 "4 5 -0.25 0 1 20 1.375"
check "disc on the arc of a lens" contact known.csv 5 "8 9 -0.1 0 1 40 0.95"
check "disc under a triangle" contact known.csv 6 "12 13 -0.25 0 -1 62 0.125"
check "side against side" contact known.csv 7 "14 15 -0.25 1 0 70.875 0"
check "report: shapes" reports shapes 8
check "report: bodies" reports bodies 18
check "report: threads are an upper bound" grep -Eq "^threads *(at most [0-9]|1 \(built without OpenMP)" out.txt
check "report: colliding" reports "colliding pairs" 6
for word in "candidate pairs" "instruction set" threads "broad phase" "narrow phase" "million pairs per second"; do
    check "report tells $word" grep -q "$word" out.txt
done

works "margin" collide $known --margin 0.5 --out margin.csv
check "margin finds the near pairs too" test "$(tail -n +2 margin.csv | cut -d, -f1,2 | tr '\n' ' ')" = \
    "0,1 2,3 4,5 6,7 8,9 10,11 12,13 14,15 16,17 "
check "near pair: corner of a turned square" contact margin.csv 5 "6 7 0.335786438 1 0 31.5821068 0"
check "near pair: n-arc from points" contact margin.csv 7 "10 11 0.25 0 -1 50 -1.125"
check "touching: separation 0" contact margin.csv 10 "16 17 0 1 0 101 0"
check "margin does not change what collides" reports "colliding pairs" 6
works "negative margin" collide $known --margin -0.3 --out deep.csv
check "only the deep pair" lines deep.csv 2
check "negative margin does not change what collides" reports "colliding pairs" 6

printf 'a,b\r\n0,1\r\n1,0\r\n0,17\r\n\r\n' >pairs.csv
works "pairs from a file with CR LF" collide $known --pairs pairs.csv --all --out all.csv
check "--all reports every pair in order" test "$(tail -n +2 all.csv | cut -d, -f1,2 | tr '\n' ' ')" = "0,1 1,0 0,17 "
check "swapped pair has the opposite normal" contact all.csv 3 "1 0 -0.5 -1 0 0.75 0"
check "far pair" contact all.csv 4 "0 17 100 1 0 51 0"
works "contacts on standard output" collide $known --out -
check "they are the same" cmp out.txt known.csv
check "the report is on standard error" grep -q "colliding pairs" err.txt
works "no output asked for" collide $known

# Tables as spreadsheets write them, their columns in any order.
awk -F, 'BEGIN { OFS = ";" } NR == 1 { print "id", "Angle", "\"x\"", "y", "note", "SHAPE" }
    NR > 1 { for (k = 2; k <= 4; k++) sub(/\./, ",", $k); print NR - 2, $4, "\"" $2 "\"", $3, "\"a;\"\"b\"\"\"", "\"" $1 "\"" }
    END { print ";;;;;" }' bodies.csv >sheet.csv
printf '\357\273\277' | cat - sheet.csv | sed 's/$/\r/' >marked.csv
sed 's/,/\t/g' bodies.csv >tabs.csv
sed 's/,/  /g' bodies.csv >blanks.csv
for sheet in sheet marked tabs blanks; do
    works "bodies of a spreadsheet, $sheet" collide --shapes shapes.json --bodies $sheet.csv --out $sheet.txt
    check "bodies of a spreadsheet, $sheet: the same" cmp $sheet.txt known.csv
done
printf 'b,n,A\n1,0,0\n0,1,1\n17,2,0\n' >swapped.csv
works "pairs with columns in another order" collide $known --pairs swapped.csv --all --out swapped.txt
check "are the same pairs" cmp swapped.txt all.csv
works "contacts as pairs" collide $known --pairs known.csv --out again.csv
check "are found again" cmp again.csv known.csv

printf 'shape,x,y,angle,scale\ndisc,1e7,0,0,2\n1,10000002.25,0,0,1\n' >scaled.csv
works "scale, far away" collide --shapes shapes.json --bodies scaled.csv --out scaled.txt
check "scale multiplies the size" contact scaled.txt 2 "0 1 -0.25 1 0"
works "no bodies" collide --shapes shapes.json --bodies none.csv --out none.txt --picture none.png
check "only the header" lines none.txt 1


# ------------------------------------------------------------------------------------------- scenes, splits, pictures
works "scene" scene --shapes shapes.json --bodies 3000 --density 0.6 --seed 7 --out scene.csv
check "one line for each body" lines scene.csv 3001
works "scene on standard output" scene --shapes shapes.json --bodies 3000 --density 0.6 --seed 7
check "the same seed gives the same file" cmp out.txt scene.csv
works "another seed" scene --shapes shapes.json --bodies 3000 --density 0.6 --seed 8 --out other.csv
check "gives another file" sh -c '! cmp -s scene.csv other.csv'
works "collide the scene" collide --shapes shapes.json --bodies scene.csv --out scene.txt --threads 1 --isa scalar
check "there are contacts" test "$(wc -l <scene.txt)" -gt 1000
for isa in $isas; do
    for threads in 1 2 5; do
        works "$isa, $threads threads" collide --shapes shapes.json --bodies scene.csv --out split.csv \
            --threads $threads --isa "$isa"
        check "$isa, $threads threads: same bytes" cmp scene.txt split.csv
    done
done
# The broad phase misses nothing: all pairs of 200 bodies, given one by one.
head -n 201 scene.csv >few.csv
awk 'BEGIN { print "a,b"; for (a = 0; a < 200; a++) for (b = a + 1; b < 200; b++) print a "," b }' >every.csv
works "candidates" collide --shapes shapes.json --bodies few.csv --margin 3 --out found.csv
works "all pairs" collide --shapes shapes.json --bodies few.csv --margin 3 --pairs every.csv --out asked.csv
check "the broad phase misses no pair" cmp found.csv asked.csv
check "there are pairs to miss" test "$(wc -l <found.csv)" -gt 20

# A row, a column, a giant under both and a body far away: sweeps along one axis alone would be slow or miss.
awk 'BEGIN { print "shape,x,y,angle,scale"; print "disc,0,0,0,200"; print "disc,1e9,-1e9,0,1"
    for (i = 0; i < 150; i++) { print "square," 1.9 * i ",0,0,1"; print "pill,0," 2.9 * i ",1.5707963,1" } }' >cross.csv
awk 'BEGIN { print "a,b"; for (a = 0; a < 302; a++) for (b = a + 1; b < 302; b++) print a "," b }' >every.csv
works "candidates of a cross" collide --shapes shapes.json --bodies cross.csv --out found.csv
works "all pairs of a cross" collide --shapes shapes.json --bodies cross.csv --pairs every.csv --out asked.csv
check "the broad phase misses no pair of a cross" cmp found.csv asked.csv
check "neighbours and the giant collide" test "$(wc -l <found.csv)" -gt 400

works "PNG" collide --shapes shapes.json --bodies few.csv --picture few.png --out few.txt
check "PNG signature" begins_with few.png XPNG
printf 'shape,x,y,angle\ndisc,-1e300,0,0\ndisc,1e300,0,0\n' >wide.csv
works "bodies far apart" collide --shapes shapes.json --bodies wide.csv
check "no pair of them" reports "skipped pairs" 0
printf 'a,b\n0,0\n0,1\n' >wide-pairs.csv
works "a pair too far apart for an answer" collide --shapes shapes.json --bodies wide.csv --pairs wide-pairs.csv
check "it is told" reports "skipped pairs" 1
for kind in png svg; do
    fails "too far out to draw, $kind" "narc: new.$kind: .*too far from the origin" collide --shapes shapes.json \
        --bodies wide.csv --picture new.$kind --out new.csv
done
printf 'shape,x,y,angle\ndisc,0,0,0\ndisc,1.5,0,0\n' >near.csv
{ cat near.csv; echo disc,1e24,0,0; echo disc,-1e300,0,0; } >stray.csv
works "picture of two bodies" collide --shapes shapes.json --bodies near.csv --picture near.svg
works "and of two that are far away" collide --shapes shapes.json --bodies stray.csv --picture stray.svg
check "these are told" grep -q "stray.svg: 2 of 4 bodies.* left out" err.txt
check "and left out" cmp near.svg stray.svg
awk 'BEGIN { print "shape,x,y,angle"; for (i = 0; i < 1100; i++) print "disc,0,0,0" }' >pile.csv
fails "too many contacts for an SVG" "narc: new.svg: 1100 bodies and 604450 contacts, .*500000 .*png" collide \
    --shapes shapes.json --bodies pile.csv --picture new.svg
works "SVG" collide --shapes shapes.json --bodies few.csv --picture few.svg --margin 1
check "SVG beginning" begins_with few.svg "<?xml"
check "SVG end" grep -q "</svg>" few.svg

# An SVG file holds each shape once; each body and contact is one line.
printf 'shape,x,y,angle\ndisc,0,0,0\ndisc,5,0,0\n' >apart.csv
works "SVG of a scene" collide --shapes shapes.json --bodies scene.csv --picture scene.svg
contacts=$(awk '/^reported contacts/ { print $NF }' out.txt)
check "all bodies and contacts are there" test "$(grep -c '<use' scene.svg)" -ge $((3000 + contacts))
check "a tenth of a kilobyte for each" test "$(wc -c <scene.svg)" -lt $((120 * (3000 + contacts) + 50000))

# inside FILE: all text of an SVG lies on the page.
inside() {
    awk '/viewBox/ { split($0, view, /viewBox="/); split(view[2], size, /[ "]/) }
        /#glyph/ { split($0, x, /" x="/); n++; if (x[2] + 0 < 0 || x[2] + 0 > size[3] - 5) exit bad = 1 }
        END { exit bad || n < 10 }' "$1"
}
check "a legend tells what the colours mean" inside few.svg
works "bodies apart" collide --shapes shapes.json --bodies apart.csv --picture apart.svg
check "need no legend" sh -c '! grep -q glyph apart.svg'
printf 'shape,x,y,angle\ndisc,0,0,0\ndisc,0,1,0\ndisc,0,90,0\n' >tower.csv
works "bodies in a narrow column" collide --shapes shapes.json --bodies tower.csv --picture tower.svg --margin 1
check "the whole legend is seen" inside tower.svg
works "circle: a narrow column" collide --shapes shapes.json --bodies tower.csv --picture tower.svg --method circle
check "circle: the whole legend is seen" inside tower.svg

# The shapes of the document.
sed -n '/^```json/,/^```/p' "$docs/formats.md" | sed -e 1d -e '/^```/,$d' >documented.json
printf 'shape,x,y,angle\nlens,0,0,0\np,0,0,0\nq,0,0,0\nc,0,0,0\nk,0,0,0\nb,0,0,0\nf,0,0,0\n' >documented.csv
works "the documented shapes" collide --shapes documented.json --bodies documented.csv --picture documented.svg
check "all of them collide" reports "colliding pairs" 21

"$narc" collide --shapes shapes.json --bodies - --out - <bodies.csv >out.txt 2>err.txt
check "bodies from standard input" cmp out.txt known.csv
"$narc" collide --shapes - --bodies bodies.csv --out - <shapes.json >out.txt 2>err.txt
check "shapes from standard input" cmp out.txt known.csv
fails "standard input twice" "narc: only one input may be -" collide --shapes shapes.json --bodies - --pairs - \
    --out new.csv <bodies.csv
fails "standard input twice, with nothing in it" "narc: only one input may be -" collide --shapes - --bodies - \
    --out new.csv </dev/null
printf 'shape,x,y,angle\ndisc,0,0,0\ndisc,0.1,0,0\ndisc,1e39,0,0\ndisc,-1e300,0,0\n' >far.csv
works "bodies without a box" collide --shapes shapes.json --bodies far.csv
check "they are told of" says "without a box 2 bodies, beyond the range of single precision"

# Half-planes: a slope meets what is on it, level ground nothing above it; a picture has them, what has outlines does not.
cat >plane.json <<'END'
{"shapes": [{"name": "floor", "half_plane": true}, {"name": "disc", "circle": 1}]}
END
printf 'shape,x,y,angle\nfloor,0,0,0.3\ndisc,0,0.5,0\ndisc,3,1.9,0\ndisc,-2,4,0\n' >plane.csv
plane="--shapes plane.json --bodies plane.csv"
works "ground without end" collide $plane --out plane.txt --picture plane.svg
check "the slope meets two discs" test "$(tail -n +2 plane.txt | cut -d, -f1,2 | tr '\n' ' ')" = "0,1 0,2 "
check "deep in the slope" contact plane.txt 2 "0 1 -0.522331755 -0.295520207 0.955336489"
printf 'shape,x,y,angle\nfloor,3,4,0.3\n' >alone.csv
works "a slope alone" collide --shapes plane.json --bodies alone.csv --picture alone.png
printf 'shape,x,y,angle\ndisc,0,0.5,0\nfloor,1e6,-0.25,0\ndisc,2,9,0\nfloor,5,-7,-1.5707963267948966\n' >level.csv
works "level ground, a wall" collide --shapes plane.json --bodies level.csv --out level.txt --picture level.png
check "the disc meets the ground" contact level.txt 2 "0 1 -0.25 0 -1"
fails "a half-plane as a drawing" "narc: plane.json: shape 'floor' is a half-plane" export plane.json --to svg --out new.svg
fails "a half-plane in a scene" "narc: plane.json: shape 'floor' is a half-plane" scene --shapes plane.json --bodies 3 --density 0.1 \
    --seed 1 --out new.csv

finish
