#!/bin/sh
# SPDX-License-Identifier: MIT
#
# fit.sh NARC [FONT] - narc fit: every kind of input, goal and family.
. "$(dirname "$0")/common.sh"

# ------------------------------------------------------------------------------------------- fits
# One outline in every format: a square with side 2. A polygon's arcs are its corners.
mkdir fits fits/more
printf '1,1\n3,1\n3,3\n1,3\n' >fits/square.csv
printf '\357\273\277x,y\r\n1,1\r\n1,3\r\n3,3\r\n3,1\r\n' >fits/header.csv
echo '[[1, 1], [3, 1], [3, 3], [1, 3]]' >fits/list.json
echo '{"points": [[1, 1], [3, 1], [3, 3], [1, 3]]}' >fits/object.json
squares="fits/square.csv fits/header.csv fits/list.json fits/object.json"

works "fit" fit $squares --arcs 4 --starts 2 --out fits.json --picture fits.svg
check "a shape for each file, named after it" names fits.json "square header list object "
check "picture of the fits" begins_with fits.svg "<?xml"
check "its end" grep -q "</svg>" fits.svg
for one in square header list object; do
    check "$one: area of the hull" is $one 5 4
    check "$one: larger than the hull" less 0.99999 "$(value $one 6)"
    check "$one: at most 4 arcs" less "$(value $one 2)" 5
    check "$one: no edges" test "$(value $one 3)" = 0
done
works "fit to standard output" fit $squares --arcs=4 --starts=2 --bound --objective area
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

# One shape with arcs, edges and corners has the longest legend: all its text lies on the page.
awk 'BEGIN { print "0,0\n4,0"; for (k = 0; k <= 40; k++) print 4 * cos(k * 0.03927) "," 1 + 3 * sin(k * 0.03927) }' \
    >fits/quarter.csv
works "the longest legend" fit fits/quarter.csv --arcs 6 --edges --starts 1 --out quarter.json --picture quarter.svg
check "the longest legend: it is not cut" awk '/viewBox/ { split($0, view, /viewBox="/); split(view[2], size, /[ "]/) }
    /#glyph/ { split($0, x, /" x="/); n++; if (x[2] + 0 < 0 || x[2] + 0 > size[3] - 5) bad = 1 }
    END { exit bad || n < 50 }' quarter.svg

# The distance of the circle around the square is 0.414, of the nearest 0.207.
works "tolerance for a circle" fit fits/square.csv --tolerance 0.42 --out one.json
check "tolerance for a circle: one arc" test "$(value square 2)" = 1
works "tolerance for the nearest circle" fit fits/square.csv --tolerance 0.21 --approximate --out one.json
check "tolerance for the nearest circle: one arc" test "$(value square 2)" = 1
check "tolerance for the nearest circle: kept" less "$(value square 8)" 0.21
works "a circle is not enough" fit fits/square.csv --tolerance 0.1 --out some.json
check "a circle is not enough: arcs" less 3 "$(value square 2)"
check "a circle is not enough: kept" less "$(value square 8)" 0.1
check "a circle is not enough: a box, with its numbers" grep -q '"box": {"width": 2.00000[0-9]*, "height": 2.00000[0-9]*}' some.json
works "no edges, not even a box's" fit fits/square.csv --tolerance 0.1 --no-edges --starts 1 --out some.json
check "no edges, not even a box's: arcs" grep -q '"arcs"' some.json
works "tolerance with edges" fit fits/square.csv --tolerance 1e-3 --edges --out some.json
check "tolerance with edges: kept" less "$(value square 8)" 1e-3
# A collider lies over its outline, at its origin or with the input's own coordinates: discs of radius 0.01 at the
# outline's corners reach 0.01 deep into the polygon.
printf '101,51\n103,51\n103.5,53\n101,53.3\n' >fits/far.csv
for option in "" --keep-origin; do
    works "a far polygon $option" fit fits/far.csv --arcs 4 --polygon $option --out far.json
    check "a far polygon $option: the table tells the origin" less 101 "$(value far 10)"
    origin=$(grep -o '"origin": \[[^]]*' far.json | cut -d'[' -f2)
    check "a far polygon $option: its origin" sh -c "[ '$option' = '' ] || [ '$origin' = '0, 0' ]"
    sed 's/"shapes": \[/&{"name": "pin", "circle": 0.01},/' far.json >laid.json
    awk -v origin="$origin" 'BEGIN { print "shape,x,y,angle"; print "far," origin ",0" } { print "pin," $0 ",0" }' \
        fits/far.csv >laid.csv
    works "a far polygon $option: laid over its outline" collide --shapes laid.json --bodies laid.csv --out laid.txt
    check "a far polygon $option: coincides" awk -F, 'NR > 1 && ($1 != 0 || $3 < -0.01001 || $3 > -0.00999) { exit bad = 1 }
        END { exit bad || NR != 5 }' laid.txt
done

# A thousand sizes away the store's coordinates are coarser: the shape still holds the outline there, by being larger.
printf '1000.1,1000\n1002.03,1000.33\n1001.7,1002.21\n999.7,1001.4\n' >fits/away.csv
works "kept far away" fit fits/away.csv --arcs 4 --edges --starts 1 --keep-origin --out away.json
check "kept far away: larger" less 2e-5 "$(value away 8)"
check "kept far away: by as little as that takes" less "$(value away 8)" 5e-4
works "kept far away: collide" collide --shapes away.json --bodies none.csv
printf '900000000,0\n900000001,0\n900000000,1\n' >fits/away.csv
fails "kept too far away" "narc: fits/away.csv: .*9e+08 from its origin, where single precision rounds by" fit \
    fits/away.csv --arcs 4 --starts 1 --keep-origin --out new.json

if has_terminal; then
    awk 'BEGIN { for (k = 0; k < 60; k++) print cos(k * 0.1047) "," 0.4 * sin(k * 0.1047) }' >fits/ellipse.csv
    script -qec "'$narc' fit fits/ellipse.csv --arcs 12 --edges --objective distance --out long.json" /dev/null \
        >script.txt 2>&1 </dev/null
    check "a long fit tells how far it is" grep -q "fitting ellipse: [1-9][0-9]* %" script.txt
else
    echo "skipped: progress on a terminal"
fi

# Chains: lines are edges between corners; of a hole these are valleys. Open strokes end in plain points.
works "a chain of lines" fit fits/square.csv --chain --tolerance 0.1 --out chain.json --picture chain.svg
check "a chain of lines: 4 of them" test "$(tail -n 1 out.txt | awk '{ print $1, $2, $3, $4 }')" = "square 1 0 4"
check "a chain of lines: 4 corners" test "$(grep -c '"radius": 0,' chain.json)" = 4
check "a chain of lines: closed" grep -q '"chain": {"closed": true' chain.json
check "a chain of lines: a picture" grep -q "</svg>" chain.svg
printf '0,0\n4,0\n4,4\n0,4\n\n1,1\n3,1\n3,3\n1,3\n' >fits/frame.csv
works "a chain round a hole" fit fits/frame.csv --chain --tolerance 0.1 --out chain.json
check "a chain round a hole: two chains" names chain.json "frame/1 frame/2 "
check "a chain round a hole: 4 valleys" test "$(grep -c '"radius": -0.0,' chain.json)" = 4

# What is written was shown to the store: flat arcs become lines, lines that cross are told.
taken() { # taken NAME FILE ARGUMENTS...: the chain is written, and a body of it is ground.
    name=$1 file=$2
    shift 2
    works "$name" fit fits/$file.csv --chain "$@" --out chain.json
    cp out.txt table.txt
    printf 'shape,x,y,angle\n%s,0,0,0\n' $file >one.csv
    works "$name: taken" collide --shapes chain.json --bodies one.csv --out /dev/null
}
printf '0,0\n50,0.1\n100,0\n100,100\n0,100\n' >fits/bent.csv
taken "a chain that is nearly straight" bent --tolerance 0.05
check "a chain that is nearly straight: kept" less "$(awk 'END { print $5 }' table.txt)" 0.0500001
awk 'BEGIN { for (k = 0; k <= 400; k++) print k "," 0.00002 * (k - 200) * (k - 200) / 200; print "400,-9\n0,-9" }' >fits/flat.csv
for tolerance in 1 0.01 0.0001; do
    taken "a chain of a flat arc, $tolerance" flat --tolerance $tolerance
done
awk 'BEGIN { for (k = 0; k < 40; k++) print k * 0.25 "," 2e-6 * k * k "\n" }' | grep . >fits/bowed.csv
taken "a stroke that hardly turns" bowed --tolerance 0.0001 --open
printf '0,0\n4,4\n4,0\n0,4\n' >fits/cross.csv
printf '0,0\n4,0\n4,4\n0,4\n\n2,2\n6,2\n6,6\n2,6\n' >fits/two.csv
printf '0,0\n10,0\n10,10\n5,10\n5,20\n5,10\n0,10\n' >fits/spike.csv
printf '0,0\n4,0\n8,0\n' >fits/line.csv
printf '1e-300,0\n4e-300,0\n0,1e-300\n' >fits/tiny.csv
crossing() { # crossing FILE MESSAGE ARGUMENTS...
    file=$1 message=$2
    shift 2
    fails "a chain: $file $*" "narc: fits/$file.csv: $message" fit fits/$file.csv --chain --tolerance 0.05 "$@" \
        --out new.json
}
for open in "" --open; do
    crossing cross "contour 0: line 0 crosses line 2 of contour 0 at (2, 2)" $open
    crossing spike "contour 0: line 3 meets line 4 of contour 0 at (5, 10)" $open
    crossing two "contour 0: line 1 crosses line 0 of contour 1 at (4, 2)" $open
    crossing tiny "contour 0: its size is 3e-300" $open
done
printf '0,0\n1,-1e-7\n2,0\n1,1e-7\n' >fits/thin.csv
for tolerance in 0.5 1e-07; do
    fails "a chain that is too thin, $tolerance" \
        "narc: fits/thin.csv: contour 0: it is too thin for the tolerance $tolerance: its sides meet" \
        fit fits/thin.csv --chain --tolerance $tolerance --out new.json
done
crossing line "contour 0: line 2 meets line 0 of contour 0 at (4, 0)"
printf '0,0\n4,0\n4,4\n0,4\n0,0\n' >fits/ring.csv
crossing ring "contour 0: it ends where it begins" --open

# Parts of the same: they are resolved, or have no area.
works "parts of a bow-tie" fit fits/cross.csv --parts 4 --tolerance 0.05 --starts 1 --out parts.json
check "parts of a bow-tie: its area" is cross 6 8
check "parts of a bow-tie: two" test "$(value cross 2)" = 2
works "parts of a spike" fit fits/spike.csv --parts 4 --tolerance 0.1 --starts 1 --out parts.json
check "parts of a spike: the area without it" is spike 6 100
works "parts that overlap" fit fits/two.csv --parts 4 --tolerance 0.1 --starts 1 --out parts.json
check "parts that overlap: the area of both" is two 6 28
fails "parts of a line" "narc: fits/line.csv: its lines enclose no area" fit fits/line.csv --parts 4 --tolerance 0.05 \
    --out new.json
fails "parts of what is tiny" "narc: fits/tiny.csv: its size is 4e-300" fit fits/tiny.csv --parts 4 --tolerance 0.05 \
    --out new.json
# Ground as a body: a level stretch, a rim and a bowl. A ball on the level, a box that stands in the bowl on two corners.
cat >ground.json <<'END'
{"shapes": [{"name": "ball", "arcs": [{"center": [0, 0], "radius": 0.5, "start": 0, "end": 6.283185307179586}]},
            {"name": "box", "box": {"width": 1.4, "height": 0.6}},
            {"name": "hill", "chain": {"closed": false, "arcs": [
              {"center": [9, 0], "radius": 0, "start": 1.5707963267948966, "end": 1.5707963267948966},
              {"center": [0, -2], "radius": 2, "start": 1.5707963267948966, "end": 2.0707963267948966},
              {"center": [-3.3559787702294297, 4.14307793323261], "radius": -5, "start": 2.0707963267948966,
               "end": 0.7707963267948966}]}}]}
END
printf 'shape,x,y,angle\nhill,0,0,0\nball,4,0.49,0\nbox,-3.4,-0.55,0\nbox,2,2,0.3\n' >ground.csv
works "ground" collide --shapes ground.json --bodies ground.csv --out on_ground.csv --picture ground.svg
check "ground: three contacts" test "$(tail -n +2 on_ground.csv | cut -d, -f1,2,10,11 | tr '\n' ' ')" = "0,1,0,0 0,2,1,0 0,2,1,0 "
check "ground: the ball's" grep -q "^0,1,-0.0099.*,0,1,4,-0.005" on_ground.csv
check "ground: a picture" grep -q "</svg>" ground.svg
printf 'shape,x,y,angle,scale\nhill,0,0,0,1e8\nball,4,0,0,1\n' >large.csv
fails "ground that is too large: what lies behind it counts" "large.csv:2: scale .*'1e8'" \
    collide --shapes ground.json --bodies large.csv
printf 'x,y,motion_x,motion_y\n5,3,0,-6\n-3,3,0,-6\n5,-3,0,6\n' >down.csv
works "rays on ground" cast --shapes ground.json --bodies ground.csv --rays down.csv --out hits.csv
check "rays on ground: two from the air hit" test "$(tail -n +2 hits.csv | cut -d, -f1,2 | tr '\n' ' ')" = "0,0 1,2 "
fails "ground is not strewn" "narc: ground.json: shape 'hill' is a chain" scene --shapes ground.json --bodies 3 --density 1 --seed 1
sed 's/"radius": 2,/"radius": 1,/' ground.json >broken.json
fails "broken ground" "broken.json:5: shape 'hill', arc 1: starts 1 away" collide --shapes broken.json --bodies ground.csv
printf 'shape,x,y,angle\nball,4,0.49,0\n' >ball.csv
fails "broken ground that no body is" "broken.json:5: shape 'hill', arc 1: starts 1 away" collide --shapes broken.json \
    --bodies ball.csv

works "an open stroke" fit fits/square.csv --chain --open --tolerance 0.1 --out chain.json
check "an open stroke: two corners, two ends" test "$(grep -c '"radius": 0,' chain.json)" = 4
check "an open stroke: open" grep -q '"chain": {"closed": false' chain.json

# Exact parts: boxes with their numbers.
printf '0,0\n2,0\n2,1\n1,1\n1,2\n0,2\n' >fits/ell.csv
works "exact parts" fit fits/ell.csv fits/frame.csv --parts 4 --out exact.json
check "exact parts: an L is two boxes" grep -q '"ell/2", "origin": \[0.5, 1.5\], "box": {"width": 1, "height": 1}' exact.json
check "exact parts: the frame has four" test "$(grep -c '"frame/[1-4]".*"box"' exact.json)" = 4
check "exact parts: nothing is off" test "$(value ell 8)" = 0
fails "exact parts: too few" "narc: fits/frame.csv: it takes 4 convex parts, more than 3" fit fits/frame.csv --parts 3 --out new.json
fails "exact parts of a bow-tie" "narc: fits/cross.csv: contour 0, piece 0 crosses" fit fits/cross.csv --parts 3 --out new.json

# Parts: the frame is four boxes; three cannot do it.
works "parts" fit fits/frame.csv fits/square.csv --parts 9 --tolerance 0.1 --starts 1 --out parts.json \
    --picture parts.svg
check "parts: 4 of the frame" test "$(value frame 2)" = 4
check "parts: 1 of the square" test "$(value square 2)" = 1
check "parts: names" names parts.json "frame/1 frame/2 frame/3 frame/4 square "
check "parts: area" is frame 5 12
check "parts: the outline's area" is frame 6 12
check "parts: distance" less "$(value frame 8)" 0.1
check "parts: a picture" grep -q "</svg>" parts.svg
works "parts with arcs" fit fits/frame.csv --parts 4 --arcs 4 --approximate --starts 1 --out some.json
check "parts with arcs: 4" test "$(value frame 2)" = 4
fails "too few parts" "narc: fits/frame.csv: the tolerance .* 3 parts" fit fits/frame.csv --parts 3 --tolerance 0.1 \
    --out new.json

# One tolerance for cuts, laps and shapes, told in the user's numbers. Parts have edges.
printf '0,0\n9,0\n9,1\n1,1\n1,9\n0,9\n' >fits/hook.csv
for goal in --bound --approximate; do
    works "a tolerance of parts, $goal" fit fits/hook.csv --parts 9 --tolerance 0.05 $goal --starts 1 --out some.json
    check "a tolerance of parts, $goal: kept" less "$(value hook 8)" 0.0500001
    fails "a tolerance too small, $goal" "narc: fits/hook.csv: the tolerance 0.005 is too small for 9 parts and their shapes, --tolerance 0.01" \
        fit fits/hook.csv --parts 9 --tolerance 0.005 $goal --out new.json
done
works "edges of parts" fit fits/hook.csv --parts 9 --tolerance 0.03 --starts 1 --out some.json
check "edges of parts: some" less 0 "$(value hook 4)"
fails "edges that are not wanted" "narc: fits/hook.csv: part 1 has .* of the tolerance 0.03, and its shape comes .*: leave --no-edges out, or --tolerance" \
    fit fits/hook.csv --parts 9 --tolerance 0.03 --no-edges --starts 1 --out new.json

# A body named after an outline in parts has all of them, and no contacts with itself.
printf 'shape,x,y,angle,scale\nframe,0,0,0,1\nsquare,0,0,1,0.5\nframe,3.5,0,0,1\n' >frames.csv
works "a body in parts" collide --shapes parts.json --bodies frames.csv --out frames.txt --picture frames.svg
check "a body in parts: columns" grep -q "^a,b,.*,part_a,part_b$" frames.txt
check "a body in parts: the square in the hole touches nothing" sh -c '! grep -qE "^(1,|[02],1,)" frames.txt'
check "a body in parts: two frames touch" grep -q "^0,2," frames.txt
check "a body in parts: not itself" sh -c '! grep -qE "^(0,0|2,2)," frames.txt'
printf 'a,b\n0,2\n' >pair.csv
works "pairs of such bodies" collide --shapes parts.json --bodies frames.csv --pairs pair.csv --out pair.txt
check "pairs of such bodies: the same contacts" cmp frames.txt pair.txt
printf 'x,y,motion_x,motion_y\n-10,0,20,0\n' >rays.csv
works "a ray at a body in parts" cast --shapes parts.json --bodies frames.csv --rays rays.csv --out hit.txt
check "a ray at a body in parts: the first frame" grep -qE "^0,0,0\.(4|39999)" hit.txt

fails "ids without SVG" "narc: --ids is for SVG and DXF" fit fits/square.csv --ids roof --arcs 4 --out new.json

# Images: what narc draws.
printf 'shape,x,y,angle\ndisc,0,0,0\n' >disc.csv
works "an image of a disc" collide --shapes shapes.json --bodies disc.csv --picture fits/disc.png
works "from an image" fit fits/disc.png --arcs 1 --silhouette dark --threshold 0.05 --out one.json --picture disc.svg
check "from an image: a disc" less "$(value disc 6)" 1.01
check "from an image: pixels" less 100000 "$(value disc 4)"
works "an image of fits" fit fits/square.csv --arcs 6 --starts 1 --out six.json --picture fits/drawn.png
works "from an image by darkness" fit fits/drawn.png --silhouette dark --arcs 6 --starts 1 --out six.json
check "from an image by darkness: named after it" names six.json "drawn "


# Opaque images are their rectangle, and that is said; what they show is asked for. Of the picture, the paper is light.
works "an opaque image" fit fits/drawn.png --arcs 4 --polygon --starts 1 --out opaque.json
check "an opaque image: its rectangle" is drawn 6 1
check "an opaque image: said" grep -q "^narc: fits/drawn.png: opaque throughout, its outline is a rectangle" err.txt
check "an opaque image: in one line" lines err.txt 1
rectangle=$(value drawn 5)
works "what is dark" fit fits/drawn.png --arcs 4 --polygon --starts 1 --silhouette dark --out opaque.json
check "what is dark: less" less "$(value drawn 5)" "$(product "$rectangle" 0.98)"
check "what is dark: nothing is said" lines err.txt 0
works "what is light" fit fits/drawn.png --arcs 4 --polygon --starts 1 --silhouette=light --out opaque.json
check "what is light: the paper" is drawn 5 "$rectangle"

# Points in any order.
printf '1,1\n3,3\n3,1\n1,3\n2,2\n2.5,1.5\n' >fits/cloud.csv
works "a cloud" fit fits/cloud.csv --arcs 4 --polygon --out cloud.json --picture cloud.svg
check "a cloud: its hull" is cloud 4 4
echo '[[1, 1], [3, 3], [3, 1], [1, 3]]' >fits/cloud.json
works "a cloud of JSON" fit fits/cloud.json --arcs 4 --polygon --out cloud.json
check "a cloud of JSON: its hull" is cloud 4 4

"$narc" fit - --arcs 1 --out stdin.json <fits/square.csv >out.txt 2>err.txt
check "an outline from standard input" names stdin.json "stdin "

# Names, and kinds told by content.
odd=' a,b"c.tar.csv'
[ "$system" != Windows ] || odd=' a,b,c.tar.csv' # whose names have no quotes
cp fits/square.csv fits/more/square.csv && cp fits/square.csv fits/7.csv && cp fits/square.csv "fits/$odd"
cp fits/list.json fits/kind.csv && cp fits/list.json fits/kind && cp fits/square.csv fits/.csv
works "names" fit fits/square.csv fits/more/square.csv fits/7.csv "fits/$odd" fits/kind.csv fits/kind \
    fits/.csv fits/square.csv --arcs 1 --out named.json --picture named.SVG
check "a picture's suffix in capitals" begins_with named.SVG "<?xml"
check "names are made fit and unlike" names named.json "square square-2 shape-7 a_b_c.tar kind kind-2 .csv square-3 "
works "they can be read" collide --shapes named.json --bodies none.csv

if [ -n "$font" ]; then
    works "glyphs" fit "$font" --characters "👻🏠🚀🌳️👻aZ7" --arcs 8 --starts 1 --out glyphs.json --picture glyphs.svg
    check "one shape for each character, once" names glyphs.json "U+1F47B U+1F3E0 U+1F680 U+1F333 a Z U+0037 "
    check "a table is printed" grep -q "^U+1F680  *[1-8] " out.txt
    check "picture of the glyphs" begins_with glyphs.svg "<?xml"
    # Curves: chords are as near as asked for.
    works "few chords" fit "$font" --characters o --arcs 1 --flatness 0.01 --out one.json
    rough=$(value o 8)
    works "many chords" fit "$font" --characters o --arcs 1 --out one.json
    check "many chords: closer" less "$(value o 8)" "$rough"
    works "a font beside other files" fit "$font" fits/square.csv "$font" --characters a --arcs=1
    cp out.txt mixed.json
    check "a font beside other files: names" names mixed.json "a square a-2 "
    works "scene of glyphs" scene --shapes glyphs.json --bodies 2000 --density 0.5 --seed 1 --out glyphs.csv
    works "collide glyphs" collide --shapes glyphs.json --bodies glyphs.csv --out glyphs.txt --picture glyphs.png
    check "glyphs touch" test "$(wc -l <glyphs.txt)" -gt 500
    check "picture of the scene" begins_with glyphs.png XPNG

    works "chain of a glyph" fit "$font" --characters 👻 --chain --tolerance 0.01 --out chain.json --picture chain.png
    check "chain of a glyph: kept" less "$(tail -n 1 out.txt | awk '{ print $5 }')" 0.0100001
    coarse=$(tail -n 1 out.txt | awk '{ print $3 }')
    works "a finer chain" fit "$font" --characters 👻 --chain --tolerance 0.0001
    check "a finer chain: more arcs" less "$coarse" "$(tail -n 1 err.txt | awk '{ print $3 }')"

    fails "no glyph" "narc: .*U+10FFFD" fit "$font" --characters "$(printf '\364\217\277\275')" --arcs 8 \
        --out new.json
    fails "a blank has no outline" "narc: .*U+0020" fit "$font" --characters " " --arcs 8 --out new.json
    [ "$system" = Windows ] || # where arguments are UTF-16
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

finish
