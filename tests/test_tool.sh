#!/bin/sh
# SPDX-License-Identifier: MIT
#
# test_tool.sh NARC [FONT] - the narc command from outside: files in, files, reports and errors out.
# FONT is a font with the ghost, house, rocket and tree; without one the checks of glyphs are skipped.
set -u
unset NARC_ISA

narc=$1
font=${2:-}
case $narc in */*) narc=$(cd "$(dirname "$narc")" && pwd)/$(basename "$narc") ;; esac
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0
known="--shapes shapes.json --bodies bodies.csv" five="--shapes shapes.json --bodies 5"

# In a build with the leak sanitizer: fontconfig, which cairo asks for a picture's font, never frees its cache.
echo "leak:libfontconfig" >suppressions
export LSAN_OPTIONS="${LSAN_OPTIONS:+$LSAN_OPTIONS:}suppressions=$folder/suppressions:print_suppressions=0"

pass() { echo "ok    $1"; }
miss() {
    echo "WRONG $1"
    failures=$((failures + 1))
}
# check NAME COMMAND...: the command succeeds.
check() {
    name=$1
    shift
    if "$@" >check.log 2>&1; then pass "$name"; else miss "$name"; sed 's/^/      /' check.log; fi
}
# works NAME ARGUMENTS...: narc succeeds; its outputs stay in out.txt and err.txt.
works() {
    name=$1
    shift
    if "$narc" "$@" >out.txt 2>err.txt; then pass "$name"; else miss "$name"; sed 's/^/      /' err.txt; fi
}
# fails NAME PATTERN ARGUMENTS...: narc exits with status 2 and one line on standard error that begins with PATTERN (a
# basic regular expression), prints nothing else, and leaves no file behind: neither targets new.* nor temporary ones.
fails() {
    name=$1 pattern=$2
    shift 2
    "$narc" "$@" >out.txt 2>err.txt
    status=$?
    if [ $status -eq 2 ] && [ "$(wc -l <err.txt)" -eq 1 ] && grep -q "^$pattern" err.txt && [ ! -s out.txt ] &&
        [ -z "$(find . -name 'new*' -o -name '.narc-*')" ]; then
        pass "$name"
    else
        miss "$name (status $status, expected: $pattern)"
        sed 's/^/      /' err.txt out.txt
        find . -name 'new*' -o -name '.narc-*' | sed 's/^/      left behind: /'
        rm -f new* .narc-*
    fi
}
# contact FILE LINE VALUES: the first seven columns of a row of a contacts file are these numbers, within 2e-7.
contact() {
    awk -F, -v line="$2" -v want="$3" 'BEGIN { n = split(want, w, " "); bad = 1 }
        NR == line { bad = NF != 9; for (i = 1; i <= n; i++) { d = $i - w[i]; if (d > 2e-7 || d < -2e-7) bad = 1 } }
        END { exit bad }' "$1"
}
lines() { [ "$(wc -l <"$1")" -eq "$2" ]; }
reports() { [ "$(awk -v key="$1" 'index($0, key) == 1 { print $NF }' out.txt)" = "$2" ]; }
begins_with() { [ "$(head -c "${#2}" "$1" | tr '\211' 'X')" = "$2" ]; }

# ------------------------------------------------------------------------------------------- help
for command in "" fit collide scene info; do
    works "help $command" $command --help
    check "help $command says how to call it" grep -q "^usage: narc" out.txt
done
works "version" --version
check "version has three numbers" grep -Eq '^narc [0-9]+\.[0-9]+\.[0-9]+$' out.txt
works "info" info
for word in narc "processor features" "instruction sets" scalar "in use" overlap contact threads; do
    check "info tells $word" grep -q "$word" out.txt
done
isas=$(awk '$NF == "supported" && $(NF - 1) != "not" { print $(NF - 1) }' out.txt)
check "the scalar instruction set is supported" test -n "$(echo "$isas" | grep scalar)"

# ------------------------------------------------------------------------------------------- answers known by hand
cat >shapes.json <<'EOF'
{"shapes": [
  {"name": "disc", "circle": 1},
  {"name": "small", "circle": 0.5},
  {"name": "square", "box": {"width": 2, "height": 2, "radius": 0}},
  {"name": "pill", "capsule": {"length": 2, "radius": 0.5}},
  {"name": "triangle", "polygon": [[0, 0], [4, 0], [0, 3]]},
  {"name": "soft", "polygon": [[-1, -1], [1, -1], [1, 1], [-1, 1]], "radius": 0.25},
  {"name": "ring", "points": [[1, 0], [0, 1], [-1, 0], [0, -1]], "radius": 1},
  {"name": "lens", "arcs": [
    {"center": [0, -4], "radius": 5, "start": 0.92729521800161223, "end": 2.2142974355881810},
    {"center": [-3, 0], "radius": 0, "start": 2.2142974355881810, "end": 4.0688878715914053},
    {"center": [0, 4], "radius": 5, "start": 4.0688878715914053, "end": 5.3558900891779739},
    {"center": [3, 0], "radius": 0, "start": 5.3558900891779739, "end": 7.2104805251811984}]}
]}
EOF
cat >bodies.csv <<'EOF'
shape,x,y,angle
disc,0,0,0
disc,1.5,0,1
square,10,0,0
small,11.25,0.5,0
pill,20,0,1.5707963267948966
small,20,1.75,0
2,30,0,0.78539816339744828
disc,32.75,0,0
lens,40,0,0
disc,40,1.9,0
ring,50,0,0
disc,50,-2.25,0
triangle,60,0,0
small,62,-0.25,0
soft,70,0,0
soft,71.75,0,0
disc,100,0,0
disc,102,0,0
EOF
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
check "report: threads are an upper bound" grep -q "^threads *at most [0-9]" out.txt
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

printf 'shape,x,y,angle,scale\ndisc,1e7,0,0,2\n1,10000002.25,0,0,1\n' >scaled.csv
works "scale, far away" collide --shapes shapes.json --bodies scaled.csv --out scaled.txt
check "scale multiplies the size" contact scaled.txt 2 "0 1 -0.25 1 0"
printf 'shape,x,y,angle\n' >none.csv
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
for kind in png svg; do
    fails "too far apart to draw, $kind" "narc: new.$kind: .*too far apart" collide --shapes shapes.json \
        --bodies wide.csv --picture new.$kind --out new.csv
done
works "very many bodies" scene --shapes shapes.json --bodies 200001 --density 0.1 --seed 1 --out many.csv
fails "too many for an SVG" "narc: new.svg: 200001 .*200000.*png" collide --shapes shapes.json --bodies many.csv \
    --picture new.svg
rm many.csv
works "SVG" collide --shapes shapes.json --bodies few.csv --picture few.svg --margin 1
check "SVG beginning" begins_with few.svg "<?xml"
check "SVG end" grep -q "</svg>" few.svg

# Progress is for terminals: `script` gives the command one, where it is installed and is that of util-linux.
awk 'BEGIN { print "shape,x,y,angle"; for (i = 0; i < 3000; i++) print "disc,0,0,0" }' >pile.csv
works "a pile of bodies" collide --shapes shapes.json --bodies pile.csv
check "all of them collide" reports "colliding pairs" 4498500
check "no progress line in a file" test ! -s err.txt
if command -v script >/dev/null && script -qec true /dev/null >script.txt 2>&1 </dev/null; then
    script -qec "'$narc' collide --shapes shapes.json --bodies pile.csv" /dev/null >script.txt 2>&1 </dev/null
    check "progress on a terminal" grep -q "narrow phase, 4498500 pairs" script.txt
else
    echo "skipped: progress on a terminal (no script command)"
fi

# ------------------------------------------------------------------------------------------- methods
# says TEXT: a line of the report is this, blanks aside.
says() { sed 's/  */ /g' out.txt | grep -qx "$1"; }

check "the report names the exact method" says "method sat"
check "and does not compare it with itself" sh -c '! grep -q "differs from sat" out.txt'
works "sat by name" collide $known --method sat --out sat.csv
check "is the default" cmp sat.csv known.csv
check "sat: the call that was timed" grep -q "^narrow phase .*(narc_find_contacts, " out.txt

# Two flat lenses. From the second to the first, d = (-4, -2), two pairs of arcs pass the test of sat-first. Upper arc
# of the second against lower arc of the first: u = d + (0, 8) = (-4, 6), 2 sqrt(13) - 10; it comes first. Lower arc
# against upper: u = d - (0, 8) = (-4, -10), 2 sqrt(29) - 10: the separation. From the first to the second, u = (4, 10)
# comes first.
printf 'shape,x,y,angle\nlens,0,0,0\nlens,4,2,0\n' >lenses.csv
printf 'a,b\n0,1\n1,0\n' >both.csv
lenses="--shapes shapes.json --bodies lenses.csv --pairs both.csv"
works "flat lenses, exactly" collide $lenses --all --out lenses.txt
check "lenses: separation" contact lenses.txt 2 "0 1 0.770329614 0.371390676 0.928476691 2 1"
check "lenses: separation of the swapped pair" contact lenses.txt 3 "1 0 0.770329614 -0.371390676 -0.928476691 2 1"
works "flat lenses by sat-first" collide $lenses --all --method sat-first --out lenses.txt
check "sat-first: right where the right arcs come first" contact lenses.txt 2 \
    "0 1 0.770329614 0.371390676 0.928476691"
check "sat-first: wrong where others do" contact lenses.txt 3 "1 0 -2.78889745 -0.554700196 0.832050294"
check "sat-first: the method" says "method sat-first"
check "sat-first: colliding" reports "colliding pairs" 1
check "sat-first: the wrong answer is told" says "differs from sat 1 pairs: 0 missed, 1 extra"
check "sat-first: the call that was timed" grep -q "^narrow phase .*(narc_query_contacts, " out.txt
check "sat-first: both ended well" sh -c '! grep -q "^outcome" out.txt'
works "sat-first, only deep pairs" collide $lenses --margin -5 --method sat-first --out lenses.txt
check "sat-first, only deep pairs: none" lines lenses.txt 1
check "sat-first, only deep pairs: still colliding" reports "colliding pairs" 1

# Squares that overlap, their corners too far apart for any pair of them to pass.
printf 'shape,x,y,angle\nsquare,0,0,0\nsquare,1.5,0.25,0\nsquare,5,6,0\n' >squares.csv
printf 'a,b\n0,1\n0,2\n' >both.csv
squares="--shapes shapes.json --bodies squares.csv --pairs both.csv"
works "squares by sat-first" collide $squares --method sat-first
check "squares: no pair of corners" says "outcome none 1 pairs: no two arcs pass the test"
check "squares: a collision is missed" says "differs from sat 1 pairs: 1 missed, 0 extra"
works "squares by polygon-sat" collide $squares --all --method polygon-sat --out squares.txt
check "polygon-sat: depth" contact squares.txt 2 "0 1 -0.5 1 0"
check "polygon-sat: the gap along an edge normal, 4, not the distance, 5" contact squares.txt 3 "0 2 4 0 1"
check "polygon-sat: same answers" says "differs from sat 0 pairs: 0 missed, 0 extra"
printf 'a,b\n2,12\n12,2\n' >polygons.csv
works "polygon-sat where only pairs have to be polygons" collide $known --pairs polygons.csv --method polygon-sat
fails "polygon-sat and a disc" "bodies.csv:2: .*'polygon-sat'.*'disc'" collide $known --method polygon-sat \
    --out new.csv --picture new.png
printf 'a,b\n2,12\n12,14\n' >polygons.csv
fails "polygon-sat and round corners" "bodies.csv:16: .*'soft'" collide $known --pairs polygons.csv \
    --method polygon-sat --out new.csv

# GJK's separation lies at most the tolerance times both bounding radii below the exact one; of these pairs lens and
# disc are the largest, 3 + 1. It is never above, but for the rounding of either, which `contact` allows as well.
for tolerance in 0.0001 0.01; do
    works "gjk, $tolerance" collide $known --method gjk --tolerance $tolerance --iterations 60 --out gjk.csv
    check "gjk, $tolerance: the method" says "method gjk, tolerance $tolerance, at most 60 iterations"
    check "gjk, $tolerance: same answers" says "differs from sat 0 pairs: 0 missed, 0 extra"
    paste -d, known.csv gjk.csv | tail -n +2 >pasted.csv
    check "gjk, $tolerance: separations" awk -F, -v most="$tolerance" '
        { below = $3 - $12; if ($1 != $10 || $2 != $11 || below < -4e-7 || below > 4 * most + 4e-7) exit bad = 1 }
        END { exit bad || NR != 6 }' pasted.csv
done
works "gjk without settings" collide $known --method gjk
check "gjk without settings: the library's" says "method gjk, tolerance 0.0001, at most 128 iterations"
check "gjk: the call that was timed" grep -q "^narrow phase .*(narc_query_contacts, " out.txt
works "gjk, fine" collide --shapes shapes.json --bodies scene.csv --method gjk --tolerance 1e-5 --out fine.csv
works "gjk, coarse" collide --shapes shapes.json --bodies scene.csv --method gjk --tolerance 0.5 --out coarse.csv
check "gjk, coarse: depths are further off" sh -c 'paste -d, fine.csv coarse.csv |
    awk -F, "NR > 1 && \$1 == \$10 && \$2 == \$11 && \$12 < \$3 - 0.01 { n++ } END { exit !(n > 20) }"'
works "gjk out of breath" collide --shapes shapes.json --bodies scene.csv --method gjk --tolerance 1e-9 --iterations 1
check "gjk out of breath: it is told" grep -q "^outcome limit  *[1-9][0-9]* pairs: iterations ran out$" out.txt
check "gjk out of breath: so are the wrong answers" grep -q "^differs from sat  *[1-9][0-9]* pairs: [1-9]" out.txt

# In the order of the pairs: circles alone overlap; axis-aligned boxes alone (the squares' diagonals lie along x and y);
# both boxes, around discs at a distance of 2.4; everything overlaps; everything overlaps.
cat >filters.csv <<'EOT'
shape,x,y,angle
square,0,0,0
square,2.5,0,0
square,0,20,0.78539816339744828
square,2.1,22.1,0.78539816339744828
disc,0,40,0
disc,1.7,41.7,0
square,0,60,0
square,1.5,60,0
disc,0,80,0
disc,1.5,80,0
EOT
printf 'a,b\n0,1\n2,3\n4,5\n6,7\n9,8\n' >five.csv
filters="--shapes shapes.json --bodies filters.csv"
# filter METHOD EXTRA PAIRS: what a filter lets pass, and how many of it do not collide.
filter() {
    works "$1" collide $filters --pairs five.csv --method $1 --out $1.csv --picture $1.svg
    check "$1: what passes" test "$(tr '\n' ' ' <$1.csv)" = "a,b $3 "
    check "$1: how many pass" reports "passing pairs" "$(($(wc -l <$1.csv) - 1))"
    check "$1: how many of them do not collide" says "differs from sat $2 pairs: 0 missed, $2 extra"
    check "$1: no contacts" sh -c '! grep -q contacts out.txt'
    check "$1: the call that was timed" grep -q "^narrow phase .*(narc_query_overlaps, " out.txt
    works "$1: its output as pairs" collide $filters --pairs $1.csv
    check "$1: no collision is lost" reports "colliding pairs" 2
}
filter circle 1 "0,1 6,7 9,8"
filter aabb 2 "2,3 4,5 6,7 9,8"
filter obb 1 "4,5 6,7 9,8"
works "a filter's pairs on standard output" collide $filters --pairs five.csv --method obb --out -
check "are the same" cmp out.txt obb.csv
check "beside a report on standard error" grep -q "passing pairs" err.txt
# A filter's picture shows the bodies that may collide, and nothing else of it.
works "what circles let pass, again" collide $filters --pairs circle.csv --method circle --picture again.svg
check "looks the same" cmp again.svg circle.svg
check "looks different for other pairs" sh -c '! cmp -s obb.svg circle.svg && ! cmp -s obb.svg aabb.svg'
works "circles around what boxes let pass" collide $filters --pairs obb.csv --method circle --picture some.svg
printf 'a,b\n7,6\n8,9\n' >two.csv
works "boxes around the same, in other order" collide $filters --pairs two.csv --method aabb --picture same.svg
check "look the same" cmp some.svg same.svg

# The candidates are pairs of overlapping boxes: the axis-aligned boxes of the library let them all pass.
works "candidates through aabb" collide --shapes shapes.json --bodies scene.csv --method aabb --out passing.csv
check "all pass" reports "passing pairs" "$(awk '/^candidate pairs/ { print $NF }' out.txt)"
works "the exact test of what passed" collide --shapes shapes.json --bodies scene.csv --pairs passing.csv \
    --out asked.csv
check "finds the same contacts" cmp asked.csv scene.txt

# The same bytes from every instruction set and number of threads.
grep -E '^(shape|square|triangle),' scene.csv >polygons.csv
for method in sat-first gjk obb polygon-sat; do
    bodies=scene.csv
    [ $method = polygon-sat ] && bodies=polygons.csv
    works "$method, scene" collide --shapes shapes.json --bodies $bodies --method $method --out whole.csv \
        --threads 1 --isa scalar
    check "$method: there are answers" test "$(wc -l <whole.csv)" -gt 20
    for isa in $isas; do
        works "$method, $isa" collide --shapes shapes.json --bodies $bodies --method $method --out split.csv \
            --threads 3 --isa "$isa"
        check "$method, $isa: same bytes" cmp whole.csv split.csv
    done
done
works "no bodies, gjk" collide --shapes shapes.json --bodies none.csv --method gjk --out none.txt
check "no bodies, gjk: only the header" lines none.txt 1
works "no bodies, obb" collide --shapes shapes.json --bodies none.csv --method obb --out none.txt --picture none.png
check "no bodies, obb: only the header" test "$(cat none.txt)" = "a,b"

# ------------------------------------------------------------------------------------------- fits
# value SHAPE COLUMN: a number of the printed table. is SHAPE COLUMN NUMBER: it is this, within 1 %: enough to tell one
# objective from another. Columns: 2 arcs, 3 edges, 4 area, 5 hull area, 6 ratio, 7 perimeter, 8 max, 9 mean distance.
value() { awk -v shape="$1" -v column="$2" '$1 == shape { print $column }' out.txt; }
is() { less "$(product "$3" 0.99)" "$(value "$1" "$2")" && less "$(value "$1" "$2")" "$(product "$3" 1.01)"; }
less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a + 0 < b + 0) }'; }
product() { awk -v a="$1" -v b="$2" 'BEGIN { print a * b }'; }
names() { [ "$(grep -o '"name": "[^"]*"' "$1" | cut -d'"' -f4 | tr '\n' ' ')" = "$2" ]; }

# One outline in every format: a square with side 2. A polygon's arcs are its corners.
mkdir fits fits/more
printf '1,1\n3,1\n3,3\n1,3\n' >fits/square.csv
printf '\357\273\277x,y\r\n1,1\r\n1,3\r\n3,3\r\n3,1\r\n' >fits/header.csv
echo '[[1, 1], [3, 1], [3, 3], [1, 3]]' >fits/list.json
echo '{"points": [[1, 1], [3, 1], [3, 3], [1, 3]]}' >fits/object.json
cat >fits/rectangle.svg <<'EOT'
<?xml version="1.0"?>
<svg xmlns="http://www.w3.org/2000/svg" width="10" height="10">
  <g transform="translate(1 1)"><rect width="1" height="1" transform="scale(2)"/></g>
</svg>
EOT
cat >fits/circle.svg <<'EOT'
<svg xmlns="http://www.w3.org/2000/svg"><circle cx="5" cy="5" r="2"/></svg>
EOT
squares="fits/square.csv fits/header.csv fits/list.json fits/object.json fits/rectangle.svg"

works "fit" fit $squares --arcs 4 --out fits.json --picture fits.svg
check "a shape for each file, named after it" names fits.json "square header list object rectangle "
check "picture of the fits" begins_with fits.svg "<?xml"
check "its end" grep -q "</svg>" fits.svg
for one in square header list object rectangle; do
    check "$one: area of the hull" is $one 5 4
    check "$one: larger than the hull" less 0.99999 "$(value $one 6)"
    check "$one: at most 4 arcs" less "$(value $one 2)" 5
    check "$one: no edges" test "$(value $one 3)" = 0
done
works "fit to standard output" fit $squares --arcs=4 --bound --objective area
check "the same shapes: --bound and area are the defaults" cmp out.txt fits.json
check "the table is on standard error" grep -q "^square " err.txt
works "scene of fits" scene --shapes fits.json --bodies 300 --density 0.5 --seed 1 --out fits.csv
works "collide fits" collide --shapes fits.json --bodies fits.csv --out fits.txt --picture fits.png
check "fits touch" test "$(wc -l <fits.txt)" -gt 50

# A circle is the n-arc of a single arc. Around the square its radius is sqrt(2). Nearest to the square by distance it
# has the mean of 1 and sqrt(2); by area, half of it lies inside: 1 / cos(pi / 8). Centroids are origins.
works "circle around a square" fit fits/square.csv --arcs 1 --out one.json
check "circle: one arc" test "$(value square 2)" = 1
check "circle: area" is square 4 6.283185
check "circle: ratio" is square 6 1.570796
check "circle: perimeter" is square 7 8.885766
check "circle: distance" is square 8 0.414214
check "circle: it is around the origin" sh -c 'grep -o "center.: \[[^]]*" one.json | cut -d[ -f2 |
    awk -F, "{ exit !(\$1 * \$1 < 1e-12 && \$2 * \$2 < 1e-12) }"'
works "circle, least perimeter" fit fits/square.csv --arcs 1 --bound --objective perimeter --out one.json
check "circle, least perimeter: it bounds" is square 7 8.885766
works "circle, least distance" fit fits/square.csv --arcs 1 --bound --objective distance --out one.json
check "circle, least distance: it bounds" is square 8 0.414214
works "circle near a square" fit fits/square.csv --arcs 1 --approximate --out one.json
check "circle near a square: distance" is square 8 0.207107
check "circle near a square: area" is square 4 4.577643
works "circle near a square, by name" fit fits/square.csv --arcs 1 --approximate --objective distance
check "circle near a square, by name: the same" cmp out.txt one.json
works "circle near a square by area" fit fits/square.csv --arcs 1 --approximate --objective area --out one.json
check "circle near a square by area: area" is square 4 3.680578

# More arcs do better, and no objective is worse, by its own measure, than another. (1.001: the searches are local.)
works "least area" fit fits/square.csv --arcs 8 --objective area --out eight.json
area=$(value square 4) perimeter=$(value square 7) distance=$(value square 8)
check "8 arcs are better than 1" less "$area" 6
works "least perimeter" fit fits/square.csv --arcs 8 --objective perimeter --out eight.json
check "not longer than that of least area" less "$(value square 7)" "$(product "$perimeter" 1.001)"
works "least distance" fit fits/square.csv --arcs 8 --objective distance --out eight.json
check "not further than that of least area" less "$(value square 8)" "$(product "$distance" 1.001)"
works "nearest" fit fits/square.csv --arcs 8 --approximate --out eight.json
check "nearer than all that bound" less "$(value square 8)" "$(product "$distance" 0.9)"
works "starts" fit fits/square.csv --arcs 5 --starts 3 --out five.json
works "starts again" fit fits/square.csv --arcs 5 --starts 3
check "the same bits" cmp out.txt five.json

# Straight edges: the square itself, but for single precision.
for family in edges polygon; do
    works "$family" fit fits/square.csv --arcs 4 --$family --out edges.json --picture edges.png
    check "$family: four edges" test "$(value square 3)" = 4
    check "$family: area" is square 4 4
    check "$family: nothing else" less "$(value square 8)" 1e-4
    check "$family: picture" begins_with edges.png XPNG
    works "$family: collide" collide --shapes edges.json --bodies none.csv
done
works "polygon for polygons only" scene --shapes edges.json --bodies 50 --density 1 --seed 1 --out edges.csv
works "a polygon is one" collide --shapes edges.json --bodies edges.csv --method polygon-sat
works "triangle" fit fits/square.csv --arcs 3 --polygon --out edges.json
check "triangle: twice the area" is square 4 8
works "the paper's route" fit fits/square.csv --arcs 4 --paper --out paper.json
check "the paper's route: not smaller" less "$(product "$area" 0.99)" "$(value square 4)"

# The distance of the circle around the square is 0.414, of the nearest 0.207.
works "tolerance for a circle" fit fits/square.csv --tolerance 0.42 --out one.json
check "tolerance for a circle: one arc" test "$(value square 2)" = 1
works "tolerance for the nearest circle" fit fits/square.csv --tolerance 0.21 --approximate --out one.json
check "tolerance for the nearest circle: one arc" test "$(value square 2)" = 1
check "tolerance for the nearest circle: kept" less "$(value square 8)" 0.21
works "a circle is not enough" fit fits/square.csv --tolerance 0.1 --out some.json
check "a circle is not enough: arcs" less 3 "$(value square 2)"
check "a circle is not enough: kept" less "$(value square 8)" 0.1
works "tolerance with edges" fit fits/square.csv --tolerance 1e-3 --edges --out some.json
check "tolerance with edges: kept" less "$(value square 8)" 1e-3
# A polygon with 32 sides around a circle of radius 2 has corners that are 2 / cos(pi / 32) - 2 = 0.0097 away.
fails "tolerance beyond reach" "narc: fits/circle.svg: .*0\\.009.*0\\.005" fit fits/circle.svg --tolerance 0.005 \
    --polygon --starts 1 --out new.json

# Curves: a circle's chords are as near as asked for.
works "circle" fit fits/circle.svg --arcs 1 --out one.json
check "circle: it bounds" less 0.99999 "$(value circle 6)"
check "circle: closely" less "$(value circle 6)" 1.001
fine=$(value circle 8)
works "circle of few chords" fit fits/circle.svg --arcs 1 --flatness 0.01 --out one.json
check "circle of few chords: wider" less "$fine" "$(value circle 8)"

# Images: what narc draws.
printf 'shape,x,y,angle\ndisc,0,0,0\n' >disc.csv
works "an image of a disc" collide --shapes shapes.json --bodies disc.csv --picture fits/disc.png
works "from an image" fit fits/disc.png --arcs 1 --threshold 0.05 --out one.json --picture disc.svg
check "from an image: a disc" less "$(value disc 6)" 1.01
check "from an image: pixels" less 100000 "$(value disc 4)"
works "an image of fits" fit fits/square.csv --arcs 6 --out six.json --picture fits/drawn.png
works "from an image by darkness" fit fits/drawn.png --arcs 6 --out six.json
check "from an image by darkness: named after it" names six.json "drawn "

# Points in no order.
printf '1,1\n3,3\n3,1\n1,3\n2,2\n2.5,1.5\n' >fits/cloud.csv
works "a cloud" fit fits/cloud.csv --arcs 4 --polygon --cloud --out cloud.json --picture cloud.svg
check "a cloud: its hull" is cloud 4 4
fails "a cloud without the option" "narc: fits/cloud.csv: .*(2, 2).*--cloud" fit fits/cloud.csv --arcs 4 --out new.json
echo '[[1, 1], [3, 3], [3, 1], [1, 3]]' >fits/cloud.json
fails "another" "narc: fits/cloud.json: .*(2, 2).*--cloud" fit fits/cloud.json --arcs 4 --out new.json
works "a cloud of JSON" fit fits/cloud.json --arcs 4 --polygon --cloud --out cloud.json
check "a cloud of JSON: its hull" is cloud 4 4

# Names, and kinds told by content.
cp fits/square.csv fits/more/square.csv && cp fits/square.csv fits/7.csv && cp fits/square.csv "fits/ a,b\"c.tar.csv"
cp fits/rectangle.svg fits/kind.csv && cp fits/list.json fits/kind && cp fits/square.csv fits/.csv
works "names" fit fits/square.csv fits/more/square.csv fits/7.csv "fits/ a,b\"c.tar.csv" fits/kind.csv fits/kind \
    fits/.csv fits/square.csv --arcs 3 --out named.json
check "names are made fit and unlike" names named.json "square square-2 shape-7 a_b_c.tar kind kind-2 .csv square-3 "
works "they can be read" collide --shapes named.json --bodies none.csv

if [ -n "$font" ]; then
    works "glyphs" fit "$font" --characters "👻🏠🚀🌳️👻aZ7" --arcs 8 --out glyphs.json --picture glyphs.svg
    check "one shape for each character, once" names glyphs.json "U+1F47B U+1F3E0 U+1F680 U+1F333 a Z U+0037 "
    check "a table is printed" grep -q "^U+1F680  *[1-8] " out.txt
    check "picture of the glyphs" begins_with glyphs.svg "<?xml"
    works "a font beside other files" fit "$font" fits/square.csv "$font" --characters a --arcs=3
    cp out.txt mixed.json
    check "a font beside other files: names" names mixed.json "a square a-2 "
    works "scene of glyphs" scene --shapes glyphs.json --bodies 2000 --density 0.5 --seed 1 --out glyphs.csv
    works "collide glyphs" collide --shapes glyphs.json --bodies glyphs.csv --out glyphs.txt --picture glyphs.png
    check "glyphs touch" test "$(wc -l <glyphs.txt)" -gt 500
    check "picture of the scene" begins_with glyphs.png XPNG

    fails "no glyph" "narc: .*U+10FFFD" fit "$font" --characters "$(printf '\364\217\277\275')" --arcs 8 \
        --out new.json
    fails "a blank has no outline" "narc: .*U+0020" fit "$font" --characters " " --arcs 8 --out new.json
    fails "invalid UTF-8" "narc: --characters .*UTF-8" fit "$font" --characters "$(printf 'a\300\200')" --arcs 8 \
        --out new.json
    fails "selectors only" "narc: --characters" fit "$font" --characters "$(printf '\357\270\217')" --arcs 8 \
        --out new.json
    fails "a font without --characters" "narc: $font: .*--characters" fit "$font" --arcs 8 --out new.json
    head -c 3000 "$font" >fits/cut.ttf
    fails "a font cut off" "narc: fits/cut.ttf: " fit fits/cut.ttf --characters a --arcs 8 --out new.json
    fails "output is the font" "narc: .*input" fit "$font" --characters a --arcs 8 --out "$font"
else
    echo "skipped: glyphs (no font given)"
fi

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
nofit "characters without a font" "narc: --characters is for fonts" --arcs 4 --characters a
nofit "threshold without an image" "narc: --threshold is for PNG" --arcs 4 --threshold 0.4
fails "fit: a cloud of an image" "narc: --cloud is for points" fit fits/drawn.png --arcs 4 --cloud --out new.json
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
damaged csv "NaN" "bad.csv:4: .*'nan'" 'x,y\n0,0\n1,0\nnan,1\n'
damaged csv "too large" "bad.csv:2: .*'2e9'" '0,0\n2e9,0\n1,1\n'
damaged csv "NUL byte" "bad.csv:2: " '0,0\n1,0\000\n1,1\n'
damaged csv "two points" "narc: bad.csv: " '0,0\n1,0\n'
damaged csv "points on a line" "narc: bad.csv: " '0,0\n1,0\n2,0\n'
damaged json "cut off" "bad.json:2: .*JSON" '[[0, 0],\n [1, 0'
damaged json "no point" "bad.json:2: .*'7'" '[[0, 0],\n 7, [1, 1]]\n'
damaged json "one coordinate" "bad.json:3: .*'\[1]'" '[[0, 0],\n [1, 0],\n [1]]\n'
damaged svg "empty" "narc: bad.svg: " ''
damaged svg "not closed" "bad.svg:[23]: " '<svg xmlns="http://www.w3.org/2000/svg">\n<path d="M0 0H1V1z"/>\n'
damaged svg "no outline" "\(narc: \)*bad.svg:" '<svg xmlns="http://www.w3.org/2000/svg"><text>a</text></svg>\n'
damaged svg "wrong path data" "bad.svg:2: " '<svg xmlns="http://www.w3.org/2000/svg">\n<path d="M0 0 L1 x"/></svg>\n'
damaged svg "no SVG" "\(narc: \)*bad.svg:" '<html><body/></html>\n'
damaged ttf "no font" "narc: bad.ttf: .*--characters" 'hello\n'
damaged dat "no known kind" "narc: bad.dat: .*SVG" 'hello\n'
head -c 200 fits/disc.png >bad.png
fails "fit: png, cut off" "narc: bad.png: " fit bad.png --arcs 4 --out new.json
printf '0,0\n1,1\n2,2\n' >flat.csv
fails "fit: a cloud on a line" "narc: flat.csv: .*line" fit flat.csv --cloud --arcs 4 --out new.json

# ------------------------------------------------------------------------------------------- wrong command lines
fails "no command" "narc: "
fails "unknown command" "narc: .*'fly'" fly
fails "unknown option" "narc: .*'--fly'" --fly
fails "unknown option of a command" "narc: .*'--fly'" collide $known --fly --out new.csv
fails "missing value" "narc: --out needs a value" collide $known --out
fails "option for a value" "narc: --out needs a value" collide --shapes shapes.json --out --bodies bodies.csv
fails "value for a flag" "narc: --all takes no value" collide $known --all=1
fails "option twice" "narc: --shapes is given twice" collide --shapes shapes.json --shapes shapes.json
fails "extra argument" "narc: .*'more'" collide $known more
fails "extra argument of info" "narc: .*'more'" info more
fails "no shapes" "narc: --shapes is missing" collide --bodies bodies.csv
fails "no bodies" "narc: --bodies is missing" collide --shapes shapes.json
for margin in x nan inf 1e999 1e40 0x1 ""; do
    fails "margin '$margin'" "narc: --margin" collide $known --margin "$margin" --out new.csv
done
for method in SAT box ""; do
    fails "method '$method'" "narc: --method" collide $known --method "$method" --out new.csv
done
fails "an unknown method is told all" \
    "narc: --method must be one of sat, sat-first, polygon-sat, gjk, circle, aabb, obb, not 'epa'\$" \
    collide $known --method epa --out new.csv
for tolerance in 0 -1e-3 1.5 1e-10 nan inf x ""; do
    fails "tolerance '$tolerance'" "narc: --tolerance " collide $known --method gjk --tolerance "$tolerance" \
        --out new.csv
done
for iterations in 0 129 -1 2.5 x ""; do
    fails "iterations '$iterations'" "narc: --iterations " collide $known --method gjk --iterations "$iterations" \
        --out new.csv
done
for option in "--tolerance 0.01" "--iterations 5"; do
    for method in sat sat-first polygon-sat circle aabb obb; do
        fails "${option% *} with $method" "narc: ${option% *} .*'$method'.*'gjk'" collide $known --method $method \
            $option --out new.csv
    done
    fails "${option% *} without a method" "narc: ${option% *} .*'sat'.*'gjk'" collide $known $option --out new.csv
done
for method in circle aabb obb; do
    fails "--margin with $method" "narc: --margin .*'$method'.*no contacts" collide $known --method $method \
        --margin 1 --out new.csv
    fails "--all with $method" "narc: --all .*'$method'.*no contacts" collide $known --method $method --all \
        --out new.csv
done
for threads in 0 1025 -1 2x 99999999999999999999; do
    fails "threads '$threads'" "narc: --threads .*'$threads'" collide $known \
        --threads "$threads" --out new.csv
done
fails "unknown instruction set" "narc: --isa: .*'sse9'" collide $known --isa sse9 --out new.csv
for isa in neon avx2 avx512; do
    case " $(echo $isas) " in
    *" $isa "*) ;;
    *) fails "unsupported $isa" "narc: --isa: .*'$isa'" collide $known --isa $isa --out new.csv ;;
    esac
done
NARC_ISA=sse9
export NARC_ISA
fails "NARC_ISA unknown" "narc: NARC_ISA: .*'sse9'" collide $known --out new.csv
fails "NARC_ISA unknown to info" "narc: NARC_ISA: .*'sse9'" info
unset NARC_ISA
fails "picture of another kind" "narc: .*new.gif" collide --shapes absent.json --bodies bodies.csv --picture new.gif
for density in 0 -1 10.5 nan x; do
    fails "density '$density'" "narc: --density .*'$density'" scene $five --density "$density" \
        --seed 1 --out new.csv
done
for count in 0 -5 4294967296 1e3; do
    fails "bodies '$count'" "narc: --bodies .*'$count'" scene --shapes shapes.json --bodies "$count" --density 1 \
        --seed 1 --out new.csv
done
for seed in -1 1.5 18446744073709551616; do
    fails "seed '$seed'" "narc: --seed .*'$seed'" scene $five --density 1 --seed "$seed" --out new.csv
done
fails "scene without a seed" "narc: --seed is missing" scene $five --density 1 --out new.csv

# ------------------------------------------------------------------------------------------- outputs that cannot be
fails "output in no folder" "narc: absent/new.csv: " collide $known --out absent/new.csv
fails "output under a file" "narc: shapes.json/new.csv: " collide $known \
    --out shapes.json/new.csv
mkdir full.csv
fails "output is a folder" "narc: full.csv: " collide $known --out full.csv
fails "picture in no folder, contacts given up" "narc: absent/few.png: " collide $known \
    --out new.csv --picture absent/few.png
fails "one file for both outputs" "narc: .*same" collide $known --out few.svg --picture few.svg
mkdir inside
fails "one new file for both outputs" "narc: .*same" collide $known --out new.svg --picture ./new.svg
fails "one new file, another way to its folder" "narc: .*same" collide $known --out new.svg --picture inside/../new.svg
works "the same name in two folders" collide $known --out few.svg --picture inside/few.svg
check "are two files" sh -c 'cmp few.svg known.csv && ! cmp -s few.svg inside/few.svg'

# An input stays what it is, whatever name an output gives it.
printf 'a,b\n0,1\n' >pair.csv
cp shapes.json kept.json && cp bodies.csv kept.txt && ln pair.csv hard.csv && ln -s bodies.csv soft.csv
for output in shapes.json ./bodies.csv soft.csv hard.csv; do
    fails "output $output is an input" "narc: $output: .*input" collide $known --pairs pair.csv --out $output
done
fails "a scene's output is its input" "narc: shapes.json: .*input" scene $five --density 1 --seed 1 --out shapes.json
check "inputs are unchanged" sh -c 'cmp shapes.json kept.json && cmp bodies.csv kept.txt && [ -L soft.csv ]'

# The longest name that a file system allows has no room for a suffix.
long=$(printf '%0250d' 0)
works "a long name" collide $known --out $long
check "a long name: the contacts" cmp $long known.csv
rm $long

# closed STREAM NAME ARGUMENTS...: with that standard stream closed narc fails and leaves no file behind.
closed() {
    stream=$1 name=$2
    shift 2
    case $stream in
    1) "$narc" "$@" >&- 2>err.txt ;;
    2) "$narc" "$@" 2>&- >out.txt ;;
    esac
    status=$?
    check "closed stream $stream: $name" test $status -eq 2 -a -z "$(find . -name 'new*' -o -name '.narc-*')"
    rm -f new* .narc-*
}
closed 1 "contacts and a picture" collide $known --out - --picture new.png
check "closed stream 1 is told" grep -q "^narc: standard output: " err.txt
closed 1 "a report that cannot be printed" collide $known --out new.csv --picture new.png
closed 1 "a scene" scene $five --density 1 --seed 1
closed 1 "a scene's report" scene $five --density 1 --seed 1 --out new.csv
closed 1 "help" --help
closed 2 "a report beside contacts" collide $known --out - --picture new.png
"$narc" collide $known --out few.txt --picture few.png <&- >out.txt 2>err.txt
check "closed stream 0 is not needed" sh -c "[ $? -eq 0 ] && cmp few.txt known.csv"
check "and no picture" begins_with few.png XPNG
if [ "$(id -u)" -ne 0 ]; then
    mkdir locked && chmod 555 locked
    fails "unwritable folder" "narc: locked/new.csv: " collide $known --out locked/new.csv
fi
if [ -c /dev/full ]; then
    fails "full disk" "narc: /dev/full: " collide --shapes shapes.json --bodies scene.csv --out /dev/full \
        --picture new.png
    ln -s /dev/full full.png
    fails "full disk, picture" "narc: full.png: " collide --shapes shapes.json --bodies few.csv --out new.csv \
        --picture full.png
    "$narc" collide $known --out new.csv --picture new.png >/dev/full 2>err.txt
    check "full disk for the report" test $? -eq 2 -a -z "$(find . -name 'new*' -o -name '.narc-*')"
    "$narc" --help >/dev/full 2>err.txt
    check "full standard output" test $? -eq 2
fi
echo old >kept.csv
fails "a wrong input" "narc: absent.csv: " collide --shapes shapes.json --bodies absent.csv --out kept.csv
check "keeps the old output" test "$(cat kept.csv)" = old
ln -s kept.csv link.csv
works "output through a link" collide $known --out link.csv
check "replaces what the link names" sh -c '[ -L link.csv ] && cmp kept.csv known.csv'

# ------------------------------------------------------------------------------------------- malformed tables
# bodies NAME PATTERN TEXT, pairs NAME PATTERN TEXT: a file with this text (printf's notation) is refused.
bodies() {
    printf "$3" >bad.csv
    fails "bodies: $1" "$2" collide --shapes shapes.json --bodies bad.csv --out new.csv --picture new.png
}
pairs() {
    printf "$3" >bad.csv
    fails "pairs: $1" "$2" collide $known --pairs bad.csv --out new.csv
}
head='shape,x,y,angle\n'
scaled='shape,x,y,angle,scale\n'
fails "bodies: no file" "narc: absent.csv: " collide --shapes shapes.json --bodies absent.csv --out new.csv
fails "bodies: a folder" "narc: full.csv: " collide --shapes shapes.json --bodies full.csv --out new.csv
bodies "empty" "bad.csv:1: " ''
bodies "wrong header" "bad.csv:1: .*'shape,x,y'" 'shape,x,y\ndisc,0,0\n'
bodies "no header" "bad.csv:1: .*'disc,0,0,0'" 'disc,0,0,0\n'
bodies "too few columns" "bad.csv:3: 3 columns" "${head}disc,0,0,0\ndisc,0,0\n"
bodies "too many columns" "bad.csv:2: 5 columns" "${head}disc,0,0,0,1\n"
bodies "blank line" "bad.csv:3: " "${head}disc,0,0,0\n\ndisc,0,0,0\n"
bodies "word for a number" "bad.csv:3: y .*'up'" "${head}disc,0,0,0\ndisc,0,up,0\n"
bodies "number with a tail" "bad.csv:2: x .*'1.5m'" "${head}disc,1.5m,0,0\n"
bodies "no number" "bad.csv:2: angle .*''" "${head}disc,1,2,\n"
bodies "hexadecimal" "bad.csv:2: x .*'0x10'" "${head}disc,0x10,0,0\n"
bodies "NaN" "bad.csv:2: angle .*'nan'" "${head}disc,0,0,nan\n"
bodies "infinity" "bad.csv:2: x .*'inf'" "${head}disc,inf,0,0\n"
bodies "overflow" "bad.csv:2: y .*'1e999'" "${head}disc,0,1e999,0\n"
bodies "unknown shape" "bad.csv:2: .*'disk'" "${head}disk,0,0,0\n"
bodies "shape index out of range" "bad.csv:2: .*'8'" "${head}8,0,0,0\n"
bodies "negative shape index" "bad.csv:2: .*'-1'" "${head}-1,0,0,0\n"
bodies "no shape" "bad.csv:2: .*''" "${head},0,0,0\n"
bodies "scale 0" "bad.csv:2: scale .*'0'" "${scaled}disc,0,0,0,0\n"
bodies "negative scale" "bad.csv:3: scale .*'-1'" "${scaled}disc,0,0,0,1\ndisc,0,0,0,-1\n"
bodies "too small" "bad.csv:2: scale .*'1e-10'" "${scaled}disc,0,0,0,1e-10\n"
bodies "too large" "bad.csv:2: scale .*'1e10'" "${scaled}disc,0,0,0,1e10\n"
bodies "numbers that differ look different" "bad.csv:2: scale .* 1.00000001e+09, .*'1000000010'" \
    "${scaled}disc,0,0,0,1000000010\n"
bodies "NUL byte" "bad.csv:2: " "${head}disc\\000,0,0,0\n"
bodies "control characters stay on one line" "bad.csv:2: .*'a?b'" "${head}a\\001b,0,0,0\n"
pairs "wrong header" "bad.csv:1: .*'b,a'" 'b,a\n0,1\n'
pairs "out of range" "bad.csv:3: b .*'18'" 'a,b\n0,1\n0,18\n'
pairs "negative" "bad.csv:2: a .*'-1'" 'a,b\n-1,0\n'
pairs "fraction" "bad.csv:2: b .*'1.5'" 'a,b\n0,1.5\n'
pairs "huge" "bad.csv:2: a .*'4294967296'" 'a,b\n4294967296,0\n'
pairs "one column" "bad.csv:2: 1 columns" 'a,b\n0\n'
fails "pairs: no file" "narc: absent.csv: " collide $known --pairs absent.csv --out new.csv

# ------------------------------------------------------------------------------------------- malformed shapes
# The text of shape number 1 stands on line 3.
shape() {
    printf '{"shapes": [\n  {"name": "first", "circle": 1},\n  %s,\n  {"name": "last", "circle": 1}]}\n' "$3" >bad.json
    fails "shape: $1" "$2" collide --shapes bad.json --bodies bodies.csv --out new.csv
}
json() {
    printf '%s\n' "$3" >bad.json
    fails "shapes: $1" "$2" scene --shapes bad.json --bodies 5 --density 1 --seed 1 --out new.csv
}
arc='{"center": [0, 0], "radius": 1, "start": 0, "end": 3.141592653589793}'
fails "shapes: no file" "narc: absent.json: " collide --shapes absent.json --bodies bodies.csv --out new.csv
: >bad.json
fails "shapes: empty file" "bad.json:1: the file is empty" collide --shapes bad.json --bodies bodies.csv --out new.csv
json "no JSON" "bad.json:1: not valid JSON" 'hello'
json "cut off" "bad.json:[23]: not valid JSON" '{"shapes": [
  {"name": "a", "circle": 1}'
json "comma missing" "bad.json:3: not valid JSON" '{"shapes": [
  {"name": "a",
   "circle" 1}]}'
json "tail" "bad.json:2: not valid JSON" '{"shapes": [{"name": "a", "circle": 1}]}
more'
json "a list" "bad.json:1: " '[]'
json "no list of shapes" "bad.json:1: .*missing" '{}'
json "shapes is no list" "bad.json:1: .*not a list" '{"shapes": 1}'
json "no shape" "bad.json:1: .*empty" '{"shapes": []}'
json "unknown key" "bad.json:1: .*'Shapes'" '{"shapes": [{"name": "a", "circle": 1}], "Shapes": []}'
json "the file's value begins on line 3" "bad.json:3: shapes is missing" '

  {}'
json "shapes is a word" "bad.json:2: shapes is not a list '\"many\"'" '
{"shapes": "many"}'
json "NUL in a name" "bad.json:2: a NUL .*u0000" '{"shapes": [
  {"name": "a\u0000b", "circle": 1}]}'
json "NUL in a key" "bad.json:1: a NUL" '{"shapes": [{"name": "a", "circle\u0000": 1}]}'
json "a backslash before u0000 is no NUL" "bad.json:1: shape .*radius is missing" \
    '{"shapes": [{"name": "a\\u0000", "capsule": {"length": 1}}]}'
shape "no object" "bad.json:3: shape 1: it is not an object '7'" '7'
shape "no name" "bad.json:3: shape 1: name is missing" '{"circle": 1}'
shape "name is a number" "bad.json:3: shape 1: name is not a string '1'" '{"name": 1, "circle": 1}'
shape "name with a comma" "bad.json:3: shape 1: .*'a,b'" '{"name": "a,b", "circle": 1}'
shape "name is another's index" "bad.json:3: shape 1: .*index.*'0'" '{"name": "0", "circle": 1}'
shape "name of digits" "bad.json:3: shape 1: .*index.*'99999999999999999999'" \
    '{"name": "99999999999999999999", "circle": 1}'
printf '{"shapes": [{"name": "0", "circle": 1}, {"name": "1", "circle": 2}]}\n' >digits.json
printf 'shape,x,y,angle\n0,0,0,0\n1,2.5,0,0\n' >digits.csv
works "names that are their own index" collide --shapes digits.json --bodies digits.csv --out digits.txt
check "mean what the index means" contact digits.txt 2 "0 1 -0.5 1 0 0.75 0"
shape "empty name" "bad.json:3: shape 1: " '{"name": "", "circle": 1}'
shape "name twice" "bad.json:3: .*'first'" '{"name": "first", "circle": 2}'
shape "no form" "bad.json:3: shape 'a': " '{"name": "a"}'
shape "two forms" "bad.json:3: shape 'a': .*'arcs' and 'points'" '{"name": "a", "points": [[0, 0]], "arcs": []}'
shape "unknown key" "bad.json:3: shape 'a': unknown key 'color'" '{"name": "a", "circle": 1, "color": 3}'
shape "key twice" "bad.json:3: shape 'a': key 'circle'" '{"name": "a", "circle": 1, "circle": 1}'
shape "radius beside circle" "bad.json:3: shape 'a': .*'radius'" '{"name": "a", "circle": 1, "radius": 1}'
shape "negative circle" "bad.json:3: shape 'a': .*-1" '{"name": "a", "circle": -1}'
shape "circle is a word" "bad.json:3: shape 'a': circle is not a number '\"1\"'" '{"name": "a", "circle": "1"}'
shape "a long value is cut" "bad.json:3: shape 'a': circle .*'\\[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,'\\.\\.\\.\$" \
    '{"name": "a", "circle": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18]}'
shape "no half characters" "bad.json:3: shape 'a': circle is not a number '\"aé\\(é\\)*'\\.\\.\\.\$" \
    '{"name": "a", "circle": "aéééééééééééééééééééééééé"}'
check "the message is valid UTF-8" iconv -f UTF-8 -t UTF-8 err.txt
shape "overflow" "bad.json:3: shape 'a': circle is not finite 'inf'" '{"name": "a", "circle": 1e999}'
shape "no arcs" "bad.json:3: shape 'a': arcs is an empty list" '{"name": "a", "arcs": []}'
shape "arcs is a number" "bad.json:3: shape 'a': arcs is not a list '3'" '{"name": "a", "arcs": 3}'
shape "arc is a number" "bad.json:3: shape 'a': arc 1: it is not an object '5'" "{\"name\": \"a\", \"arcs\": [$arc, 5]}"
shape "arc without radius" "bad.json:3: shape 'a': arc 0: radius is missing" \
    '{"name": "a", "arcs": [{"center": [0, 0], "start": 0, "end": 1}]}'
shape "arc with one coordinate" "bad.json:3: shape 'a': arc 0: center .*'\\[0]'" \
    '{"name": "a", "arcs": [{"center": [0], "radius": 1, "start": 0, "end": 1}]}'
shape "arc with an unknown key" "bad.json:3: shape 'a': arc 0: unknown key 'r'" \
    '{"name": "a", "arcs": [{"center": [0, 0], "r": 1, "start": 0, "end": 1}]}'
shape "half a circle" "bad.json:3: shape 'a': " "{\"name\": \"a\", \"arcs\": [$arc]}"
other='{"center": [0, 0], "radius": -1, "start": 3.141592653589793, "end": 6.283185307179586}'
shape "negative radius" "bad.json:3: shape 'a': arc 1.*-1" "{\"name\": \"a\", \"arcs\": [$arc, $other]}"
# Errors of one arc or point tell its own line: element k stands on line 4 + k. Text in between must not confuse.
shape "line of an arc that cannot be read" "bad.json:5: shape 'a': arc 1: radius is not a number 'null'" \
    "{\"name\": \"a\", \"arcs\": [
    $arc,
    {\"center\": [0, 0], \"radius\": null}]}"
shape "line of an arc that cannot be" "bad.json:5: shape 'a': arc 1.*-1" "{\"name\": \"a\", \"arcs\": [
    $arc,
    $other]}"
shape "line of arc 0" "bad.json:5: shape 'a': arc 0.*-1" "{\"arcs\":
  [
    $other, $arc], \"name\": \"a\"}"
shape "line of a point" "bad.json:6: shape 'a': point 2 .*'\\[1]'" '{"name": "a", "points": [
    [0, 0],
    [1, 0],
    [1],
    [0, 1]]}'
shape "line of a corner that turns right" "bad.json:6: shape 'a': point 2: " '{"name": "a", "polygon": [
    [0, 0],
    [4, 0],
    [1, 1],
    [0, 4]]}'
shape "line of a shape with points that do not suit" "bad.json:3: shape 'a': the exterior" '{"name": "a", "points": [
    [0, 0],
    [4, 0],
    [4, 1],
    [0, 3]]}'
json "brackets in strings" "bad.json:4: shape 1: " '{"shapes": [
  {"name": "]\\}[{:", "circle"
     : 1 } ,
  7]}'
shape "two points" "bad.json:3: shape 'a': " '{"name": "a", "points": [[0, 0], [1, 0]]}'
shape "point is a number" "bad.json:3: shape 'a': point 1 .*'1'" '{"name": "a", "points": [[0, 0], 1, [0, 1]]}'
shape "polygon that turns right" "bad.json:3: shape 'a': " '{"name": "a", "polygon": [[0, 0], [0, 1], [1, 0]]}'
shape "corner radius too large" "bad.json:3: shape 'a': " \
    '{"name": "a", "polygon": [[0, 0], [1, 0], [0, 1]], "radius": 5}'
shape "capsule without length" "bad.json:3: shape 'a': length is missing" '{"name": "a", "capsule": {"radius": 1}}'
shape "capsule is a number" "bad.json:3: shape 'a': capsule is not an object '1'" '{"name": "a", "capsule": 1}'
shape "box with an unknown key" "bad.json:3: shape 'a': unknown key 'depth'" \
    '{"name": "a", "box": {"width": 1, "height": 1, "depth": 1}}'
shape "box rounder than wide" "bad.json:3: shape 'a': " '{"name": "a", "box": {"width": 1, "height": 1, "radius": 1}}'
awk 'BEGIN { printf "{\"shapes\": [\n{\"name\": \"a\", \"polygon\": ["
    for (i = 0; i < 65; i++) printf "%s[%.17g, %.17g]", i ? ", " : "", cos(i * 6.283185 / 65), sin(i * 6.283185 / 65)
    print "]}]}" }' >bad.json
fails "shape: 65 corners" "bad.json:2: shape 'a': .*65" collide --shapes bad.json --bodies bodies.csv --out new.csv

echo
if [ $failures -ne 0 ]; then
    echo "$failures checks went wrong"
    exit 1
fi
echo "all checks passed"
