#!/bin/sh
# SPDX-License-Identifier: MIT
#
# drawings.sh NARC [FONT [SVG]] - narc fit: SVG files, in a build that reads them, or does not.
. "$(dirname "$0")/common.sh"

mkdir fits
cat >fits/rectangle.svg <<'EOT'
<?xml version="1.0"?>
<svg xmlns="http://www.w3.org/2000/svg" width="10" height="10">
  <g transform="translate(1 1)"><rect width="1" height="1" transform="scale(2)"/></g>
</svg>
EOT
if [ "$svg" = OFF ]; then
    set -f # no names of files
    for ids in "" "--ids a" "--ids *"; do
        fails "no SVG" "narc: fits/rectangle.svg: this build of narc reads no SVG files$" fit fits/rectangle.svg --arcs 4 $ids \
            --out new.json
    done
    finish
    exit
fi
cat >fits/circle.svg <<'EOT'
<svg xmlns="http://www.w3.org/2000/svg"><circle cx="5" cy="5" r="2"/></svg>
EOT
# A square with side 2.
works "a square" fit fits/rectangle.svg --arcs 4 --starts 2 --out fits.json
check "a square: area of the hull" is rectangle 5 4
check "a square: larger than the hull" less 0.99999 "$(value rectangle 6)"
check "a square: at most 4 arcs" less "$(value rectangle 2)" 5
cp fits/rectangle.svg fits/kind.csv
works "a kind told by content" fit fits/kind.csv --arcs 1 --out named.json

# A polygon with 32 sides around a circle of radius 2 has corners that are 2 / cos(pi / 32) - 2 = 0.0097 away; it
# leaves room for a pixel, a 4096th of 4, and tells another, where it is traced.
fails "tolerance beyond reach" "narc: fits/circle.svg: .*0\\.0099.*0\\.005" fit fits/circle.svg --tolerance 0.005 \
    --polygon --starts 1 --out new.json
fails "traced, beyond reach" "narc: fits/circle.svg: .*0\\.011.*0\\.005" fit fits/circle.svg --tolerance 0.005 \
    --polygon --starts 1 --trace --out new.json

# A drawing: its pixels are told.
works "circle" fit fits/circle.svg --arcs 1 --out one.json
check "circle: it bounds" less 0.99999 "$(value circle 6)"
check "circle: closely" less "$(value circle 6)" 1.002

if has_terminal; then
    { printf '<svg viewBox="0 0 4 4" xmlns="http://www.w3.org/2000/svg"><!--' && head -c 100000 /dev/zero | tr '\0' x &&
        printf -- '--><path d="M0 0H3V2z"/></svg>'; } >fits/large.svg
    script -qec "'$narc' fit fits/large.svg --arcs 1 --out large.json" /dev/null >script.txt 2>&1 </dev/null
    check "a large drawing is announced" grep -q "drawing, 97 KB of SVG" script.txt
else
    echo "skipped: progress on a terminal"
fi

# Elements of a drawing by their ids, where they are in it.
cat >fits/layers.svg <<'EOT'
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 10">
  <g id="walls" transform="translate(1 2)"><rect width="2" height="4"/><rect x="4" width="2" height="4" id="right"/></g>
  <circle id="ball" cx="8" cy="8" r="1"/>
</svg>
EOT
echo '<svg xmlns="http://www.w3.org/2000/svg"><rect width="2" height="4"/></svg>' >fits/plain.svg
echo '<svg xmlns="http://www.w3.org/2000/svg"><g id="a"></svg>' >fits/broken.svg
works "elements" fit fits/layers.svg --ids walls,ball,right --arcs 4 --edges --starts 1 --out layers.json
check "elements: names" names layers.json "walls ball right "
check "elements: the layer's hull" is walls 5 24
check "elements: the ball" is ball 5 3.141593
check "elements: the right one's place" is right 10 6
check "elements: the same, y up" less "$(value right 11)" -3.99
works "all elements" fit fits/layers.svg --ids '*' --arcs 4 --edges --starts 1 --out all.json
check "all elements: those of the drawing itself" names all.json "walls ball "
fails "no ids" "narc: fits/plain.svg: no element of the drawing itself has an id" fit fits/plain.svg --ids '*' --arcs 4 --out new.json
fails "ids of a broken drawing" "narc: fits/broken.svg: its ids cannot be listed" fit fits/broken.svg --ids '*' --arcs 4 --out new.json
fails "no such element" "narc: fits/layers.svg: .*'roof'" fit fits/layers.svg --ids roof --arcs 4 --out new.json

# Faint ink of drawings: a shadow to the right of a square.
cat >fits/shadow.svg <<'EOT'
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 10">
  <rect x="5" y="2" width="12" height="6" opacity="0.2"/><rect x="2" y="2" width="6" height="6"/>
</svg>
EOT
works "a faint shadow" fit fits/shadow.svg --arcs 4 --polygon --starts 1 --out shadow.json
check "a faint shadow: the square" is shadow 5 36
works "a faint shadow that counts" fit fits/shadow.svg --arcs 4 --polygon --starts 1 --threshold 0.1 --out shadow.json
check "a faint shadow that counts: with the square" is shadow 5 90
echo '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 4"><rect width="9" height="4" fill="white"/>
<rect x="2" y="1" width="2" height="2"/></svg>' >fits/paper.svg
works "a drawing on paper" fit fits/paper.svg --arcs 4 --polygon --starts 1 --out paper.json
check "a drawing on paper: said" grep -q "^narc: fits/paper.svg: opaque throughout" err.txt
check "a drawing on paper: the page" is paper 5 36
works "a drawing on paper, dark" fit fits/paper.svg --arcs 4 --polygon --starts 1 --silhouette dark --out paper.json
check "a drawing on paper, dark: what is drawn" is paper 5 4

# ------------------------------------------------------------------------------------------- drawings that cannot be
cat >fits/faint.svg <<'EOT'
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 10"><circle cx="5" cy="5" r="2" opacity="0.5"/></svg>
EOT
for threshold in 0 1 -0.5 nan x ""; do
    fails "threshold '$threshold'" "narc: --threshold " fit fits/faint.svg --arcs 4 \
        --threshold "$threshold" --out new.json
done
fails "all too faint" "narc: fits/faint.svg: all ink .* fainter than the threshold 0.6" fit fits/faint.svg --arcs 4 \
    --threshold 0.6 --out new.json
# damaged NAME PATTERN TEXT: a file with this text (printf's notation) is refused.
damaged() {
    printf "$3" >bad.svg
    fails "$1" "$2" fit fits/circle.svg bad.svg --arcs 4 --out new.json --picture new.png
}
damaged "empty" "narc: bad.svg: " ''
damaged "not closed" "bad.svg:[23]: " '<svg xmlns="http://www.w3.org/2000/svg">\n<path d="M0 0H1V1z"/>\n'
damaged "no outline" "\(narc: \)*bad.svg:" '<svg xmlns="http://www.w3.org/2000/svg"><defs><path d="M0 0h9v9z"/></defs></svg>\n'
damaged "no SVG" "\(narc: \)*bad.svg:" '<html><body/></html>\n'

# A font cannot be scaled to that size: Pango's warning becomes one of the command, which names the file.
cat >text.svg <<'EOT'
<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><rect width="50" height="50"/>
<text y="50" font-size="1e-5">A</text><text y="50" font-size="10">A</text></svg>
EOT
works "a text that cannot be drawn" fit text.svg --arcs 4 --out text.json
check "is no warning of a library" sh -c '! grep -v "^narc: text.svg: a part of it, perhaps some text, may be missing: " err.txt'

finish
