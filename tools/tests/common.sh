# SPDX-License-Identifier: MIT
#
# common.sh - what the scripts beside it share. Each is called with the command, NARC [FONT [SVG [SYSTEM]]], and tests it from
# outside: files in, files, reports and errors out, in a folder of its own. FONT is a font with the ghost, house, rocket
# and tree; without one the checks of glyphs are skipped. SVG, ON or OFF: does this build read SVG files? SYSTEM, such as
# Linux or Windows: what the command runs on.
set -u
unset NARC_ISA

narc=$1
font=${2:-} svg=${3:-ON} system=${4:-}
case $narc in */*) narc=$(cd "$(dirname "$narc")" && pwd)/$(basename "$narc") ;; esac
docs=$(cd "$(dirname "$0")/../../docs" && pwd)
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0
known="--shapes shapes.json --bodies bodies.csv" five="--shapes shapes.json --bodies 5"

# In a build with the leak sanitizer: fontconfig never frees its cache, cairo keeps what an SVG file uses many times.
cp "$docs/../cmake/leaks.txt" suppressions
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
# says TEXT: a line of the report is this, blanks aside.
says() { sed 's/  */ /g' out.txt | grep -qx "$1"; }
# value SHAPE COLUMN: a number of the printed table. is SHAPE COLUMN NUMBER: it is this, within 1 %: enough to tell one
# objective from another. Columns: 2 arcs, 3 edges, 4 area, 5 hull area, 6 ratio, 7 perimeter, 8 max, 9 mean distance, 10 and 11 origin.
value() { awk -v shape="$1" -v column="$2" '$1 == shape { print $column }' out.txt; }
is() { less "$(product "$3" 0.99)" "$(value "$1" "$2")" && less "$(value "$1" "$2")" "$(product "$3" 1.01)"; }
less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a + 0 < b + 0) }'; }
product() { awk -v a="$1" -v b="$2" 'BEGIN { print a * b }'; }
names() { [ "$(grep -o '"name": "[^"]*"' "$1" | cut -d'"' -f4 | tr '\n' ' ')" = "$2" ]; }
# Progress is for terminals: `script` gives the command one, where it is installed and is that of util-linux. wine draws a
# console on it.
has_terminal() {
    [ "$system" != Windows ] && command -v script >/dev/null && script -qec true /dev/null >script.txt 2>&1 </dev/null
}
# The last command of a script.
finish() {
    if [ $failures -ne 0 ]; then
        echo "$failures checks went wrong"
        exit 1
    fi
    echo "all checks passed"
}

isas=$("$narc" info | awk '$NF == "supported" && $(NF - 1) != "not" { print $(NF - 1) }')

# Shapes and bodies whose contacts are known by hand.
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
printf 'shape,x,y,angle\n' >none.csv
