#!/bin/sh
# SPDX-License-Identifier: MIT
#
# methods.sh NARC [FONT] - narc collide by every method.
. "$(dirname "$0")/common.sh"

works "collide" collide $known --out known.csv
"$narc" scene --shapes shapes.json --bodies 3000 --density 0.6 --seed 7 --out scene.csv >out.txt
works "collide the scene" collide --shapes shapes.json --bodies scene.csv --out scene.txt
works "sat" collide $known
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
check "sat-first: the call that was timed" grep -q "^narrow phase .*(narc_find_contacts_by, " out.txt
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
check "gjk: the call that was timed" grep -q "^narrow phase .*(narc_find_contacts_by, " out.txt
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
    check "$1: the call that was timed" grep -q "^narrow phase .*(narc_find_overlaps_by, " out.txt
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

finish
