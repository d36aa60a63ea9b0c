#!/bin/sh
# SPDX-License-Identifier: MIT
#
# errors.sh NARC [FONT] - help, and errors of command lines, tables and shapes.
. "$(dirname "$0")/common.sh"

# ------------------------------------------------------------------------------------------- help
for command in "" fit export view scene collide cast info; do
    works "help $command" $command --help
    check "help $command says how to call it" grep -q "^usage: narc" out.txt
done
works "version" --version
check "version has three numbers" grep -Eq '^narc [0-9]+\.[0-9]+\.[0-9]+$' out.txt
works "info" info
for word in narc "processor features" "instruction sets" scalar "in use" overlap contact threads; do
    check "info tells $word" grep -q "$word" out.txt
done
check "the scalar instruction set is supported" test -n "$(echo "$isas" | grep scalar)"

# ------------------------------------------------------------------------------------------- wrong command lines
fails "no command" "narc: "
fails "unknown command" "narc: .*'fly'" fly
fails "unknown option" "narc: .*'--fly'" --fly
fails "unknown option of a command" "narc: .*'--fly'" collide $known --fly --out new.csv
fails "missing value" "narc: --out needs a value" collide $known --out
for option in --out --picture; do
    fails "a pattern for one file" "narc: $option is one file, it takes no {name}" collide $known $option "a-{name}.svg"
done
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
for count in 0 -1 4294967296 1e6; do
    fails "max-pairs '$count'" "narc: --max-pairs .*'$count'" collide $known --max-pairs "$count" --out new.csv
done
fails "pairs and max-pairs" "narc: --pairs and --max-pairs exclude" collide $known --pairs bodies.csv --max-pairs 5
printf 'shape,x,y,angle\ndisc,0,up,0\n' | "$narc" collide --shapes shapes.json --bodies - >out.txt 2>err.txt
check "an error in standard input" grep -q "^standard input:2: y .*'up'" err.txt
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
missing=$("$narc" info | awk '/ not built, / { sub(/ not built, .*/, ""); print $NF }')
check "no machine has all instruction sets" test -n "$missing"
for isa in $missing; do
    fails "unsupported $isa" "narc: --isa: .*'$isa'" collide $known --isa $isa --out new.csv
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
bodies "empty" "narc: bad.csv: .*empty" ''
bodies "wrong header" "bad.csv:1: the header has no column 'angle': 'shape,x,y'" 'shape,x,y\ndisc,0,0\n'
bodies "no header" "bad.csv:1: the header has no column 'shape': 'disc,0,0,0'" 'disc,0,0,0\n'
bodies "two columns of a name" "bad.csv:1: the header has two columns 'x': 'shape;x;X;y;angle'" 'shape;x;X;y;angle\n'
bodies "a decimal comma between commas" "bad.csv:2: x has a decimal comma, .* '1,5'" "${head}disc,\"1,5\",0,0\n"
bodies "points and commas" "bad.csv:3: x has a decimal point, .* '1.5'" 'shape;x;y;angle\ndisc;1,5;0;0\ndisc;1.5;0;0\n'
bodies "quotes that do not end" "bad.csv:2: a field in quotes does not end, .*'disc,\"1'" "${head}disc,\"1\n"
bodies "UTF-16" "bad.csv:1: the text is UTF-16" '\377\376s\000'
bodies "too few columns" "bad.csv:3: 3 columns" "${head}disc,0,0,0\ndisc,0,0\n"
bodies "too many columns" "bad.csv:2: 5 columns" "${head}disc,0,0,0,1\n"
bodies "blank line" "bad.csv:3: " "${head}disc,0,0,0\n\ndisc,0,0,0\n"
bodies "line of empty fields" "bad.csv:3: a blank line" "${head}disc,0,0,0\n,,,\n\ndisc,0,0,0\n"
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
bodies "numbers that differ look different" "bad.csv:2: scale .* 1.0001[0-9]*e+09, not in .* 1e+09, '1000100010'" \
    "${scaled}disc,0,0,0,1000100010\n"
bodies "NUL byte" "bad.csv:2: " "${head}disc\\000,0,0,0\n"
bodies "control characters stay on one line" "bad.csv:2: .*'a?b'" "${head}a\\001b,0,0,0\n"
long=$(printf '%02000d' 0)x
bodies "a long field is cut" "bad.csv:2: x is not a number '0\\{40\\}\\.\\.\\.'\$" "${head}disc,$long,0,0\n"
bodies "a long name is cut" "bad.csv:2: shape is no name or index .* '0\\{40\\}\\.\\.\\.'\$" "${head}$long,0,0,0\n"
bodies "a long header is cut" "bad.csv:1: the header .* '0\\{40\\}\\.\\.\\.'\$" "$long\n"
pairs "a long index is cut" "bad.csv:2: b is not a whole number '0\\{40\\}\\.\\.\\.'\$" "a,b\n0,$long\n"
fails "a long option is cut" "narc: --threads .*'0\\{40\\}\\.\\.\\.'\$" collide $known --threads $long --out new.csv
pairs "wrong header" "bad.csv:1: the header has no column 'b': 'a,c'" 'a,c\n0,1\n'
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
fails "shapes: empty file" "narc: bad.json: the text is empty" collide --shapes bad.json --bodies bodies.csv --out new.csv
json "no JSON" "bad.json:1: not valid JSON" 'hello'
json "cut off" "bad.json:[23]: not valid JSON" '{"shapes": [
  {"name": "a", "circle": 1}'
json "comma missing" "bad.json:3: not valid JSON" '{"shapes": [
  {"name": "a",
   "circle" 1}]}'
json "tail" "bad.json:2: not valid JSON" '{"shapes": [{"name": "a", "circle": 1}]}
more'
json "a list" "bad.json:1: " '[]'
json "nested too deep" "bad.json:2: lists and objects nested more than 1000 deep" "[
$(printf '%01100d' 0 | tr 0 '[')"
json "no list of shapes" "bad.json:1: .*missing" '{}'
json "shapes is no list" "bad.json:1: .*not a list" '{"shapes": 1}'
json "no shape" "bad.json:1: .*empty" '{"shapes": []}'
json "unknown key" "bad.json:1: .*'Shapes'" '{"shapes": [{"name": "a", "circle": 1}], "Shapes": []}'
json "shapes is a word" "bad.json:1: shapes is not a list '\"many\"'" '{"shapes": "many"}'
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
shape "a long value is cut" "bad.json:3: shape 'a': circle .*'\\[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,\\.\\.\\.'\$" \
    '{"name": "a", "circle": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18]}'
shape "no half characters" "bad.json:3: shape 'a': circle is not a number '\"aé\\(é\\)*\\.\\.\\.'\$" \
    '{"name": "a", "circle": "aéééééééééééééééééééééééé"}'
check "the message is valid UTF-8" iconv -f UTF-8 -t UTF-8 err.txt
shape "overflow" "bad.json:3: shape 'a': circle is not finite" '{"name": "a", "circle": 1e999}'
shape "no arcs" "bad.json:3: shape 'a': arcs is an empty list" '{"name": "a", "arcs": []}'
shape "arcs is a number" "bad.json:3: shape 'a': arcs is not a list '3'" '{"name": "a", "arcs": 3}'
shape "arc is a number" "bad.json:3: shape 'a', arc 1: it is not an object '5'" "{\"name\": \"a\", \"arcs\": [$arc, 5]}"
shape "arc without radius" "bad.json:3: shape 'a', arc 0: radius is missing" \
    '{"name": "a", "arcs": [{"center": [0, 0], "start": 0, "end": 1}]}'
shape "arc with one coordinate" "bad.json:3: shape 'a', arc 0: center .*'\\[0]'" \
    '{"name": "a", "arcs": [{"center": [0], "radius": 1, "start": 0, "end": 1}]}'
shape "arc with an unknown key" "bad.json:3: shape 'a', arc 0: unknown key 'r'" \
    '{"name": "a", "arcs": [{"center": [0, 0], "r": 1, "start": 0, "end": 1}]}'
shape "half a circle" "bad.json:3: shape 'a', arc 0: " "{\"name\": \"a\", \"arcs\": [$arc]}"
other='{"center": [0, 0], "radius": -1, "start": 3.141592653589793, "end": 6.283185307179586}'
shape "negative radius" "bad.json:3: shape 'a', arc 1: .*-1" "{\"name\": \"a\", \"arcs\": [$arc, $other]}"
shape "negative radius of arc 0" "bad.json:3: shape 'a', arc 0: .*-1" "{\"name\": \"a\", \"arcs\": [$other, $arc]}"
shape "a corner that turns right" "bad.json:3: shape 'a', point 2: " '{"name": "a", "polygon": [[0, 0], [4, 0], [1, 1], [0, 4]]}'
shape "points that do not suit" "bad.json:3: shape 'a': the exterior" \
    '{"name": "a", "points": [[0, 0], [4, 0], [4, 1], [0, 3]]}'
shape "two points" "bad.json:3: shape 'a': " '{"name": "a", "points": [[0, 0], [1, 0]]}'
shape "point is a number" "bad.json:3: shape 'a', point 1: .*'1'" '{"name": "a", "points": [[0, 0], 1, [0, 1]]}'
shape "polygon that turns right" "bad.json:3: shape 'a', point 0: " '{"name": "a", "polygon": [[0, 0], [0, 1], [1, 0]]}'
shape "corner radius too large" "bad.json:3: shape 'a', side 0: " \
    '{"name": "a", "polygon": [[0, 0], [1, 0], [0, 1]], "radius": 5}'
shape "capsule without length" "bad.json:3: shape 'a': length is missing" '{"name": "a", "capsule": {"radius": 1}}'
shape "capsule is a number" "bad.json:3: shape 'a': capsule is not an object '1'" '{"name": "a", "capsule": 1}'
shape "box with an unknown key" "bad.json:3: shape 'a': unknown key 'depth'" \
    '{"name": "a", "box": {"width": 1, "height": 1, "depth": 1}}'
shape "four_arc without a distance" "bad.json:3: shape 'a': distance is missing" \
    '{"name": "a", "four_arc": {"radius_low": 5, "radius_high": 5}}'
shape "four_arc of circles apart" "bad.json:3: shape 'a': " \
    '{"name": "a", "four_arc": {"radius_low": 5, "radius_high": 5, "distance": 11}}'
shape "origin is a number" "bad.json:3: shape 'a': origin is not a list of two numbers '1'" \
    '{"name": "a", "circle": 1, "origin": 1}'
shape "box rounder than wide" "bad.json:3: shape 'a': " '{"name": "a", "box": {"width": 1, "height": 1, "radius": 1}}'
awk 'BEGIN { printf "{\"shapes\": [\n{\"name\": \"a\", \"polygon\": ["
    for (i = 0; i < 65; i++) printf "%s[%.17g, %.17g]", i ? ", " : "", cos(i * 6.283185 / 65), sin(i * 6.283185 / 65)
    print "]}]}" }' >bad.json
fails "shape: 65 corners" "bad.json:2: shape 'a': .*65" collide --shapes bad.json --bodies bodies.csv --out new.csv

finish
