#!/bin/sh
# SPDX-License-Identifier: MIT
#
# usage: sh program.sh DEM: the discrete element program from outside: runs, restarts, signals, and inputs that are wrong.
dem=$1
. "$(dirname "$0")/common.sh"

cat >good.json <<'END'
{
  "materials": [{"name": "sand", "density": 1000}, {"name": "steel", "density": 7800}],
  "shapes": "shapes.json",
  "grains": [
    {"place": "random", "count": 20, "region": [0.2, 0.2, 3.8, 6], "shapes": ["disc", "brick"], "size": {"normal": [0.4, 0.1], "low": 0.3, "high": 0.5}, "material": "sand"},
    {"place": "lattice", "region": [0, 7, 4, 9], "spacing": [1, 1], "jitter": 0.2, "shapes": ["disc"], "size": 0.4, "material": "sand", "upright": true},
    {"place": "list", "grains": [{"shape": "brick", "material": "sand", "at": [2, 9.5], "size": 0.4, "velocity": [1, 0], "spin": 3}]}
  ],
  "walls": [
    {"name": "floor", "material": "steel", "plate": {"point": [0, 0], "normal": [0, 1]}},
    {"name": "block", "material": "steel", "box": {"width": 0.5, "height": 0.5, "radius": 0.1}, "at": [2, 0], "angle": 0.3, "spin": 1, "pivot": [2.1, 0]},
    {"name": "lid", "material": "steel", "plate": {"point": [0, 12], "normal": [0, -1]}, "servo": {"direction": [0, -1], "stress": 100, "between": ["floor", "block"], "gain": 1, "max_speed": 1}}
  ],
  "boundary": {"x": [0, 4]},
  "gravity": [0, -9.81],
  "thickness": 0.5,
  "contact": {"law": "linear", "kn": 1e7, "restitution": 0.5, "friction": 0.5, "rolling_friction": 0.01, "pairs": [{"materials": ["sand", "steel"], "friction": 0.2}]},
  "time_step": 1e-4,
  "skin": 0.1,
  "stages": [
    {"name": "fall", "duration": 0.1},
    {"name": "shear", "duration": 0.1, "friction": 0.4, "gravity": [1, -9], "walls": {"floor": {"velocity": [0.5, 0]}, "block": {"spin": -1}}}
  ],
  "output": {"every": 0.02, "csv": "out.csv", "restart": "out.restart", "restart_every": 0.1, "region": [0, 1, 4, 3]}
}
END

# ------------------------------------------------------------------------------------------- runs and restarts
"$dem" --help | grep -q 'usage: dem INPUT.json' || miss "help"
"$dem" good.json --threads 1 >whole.txt 2>err.txt || miss "a run"
[ "$(wc -l <out.csv)" -eq 12 ] || miss "a line for each 0.02 s, the start and a title: $(wc -l <out.csv)"
grep -q '^steps 2000, time 0.2' whole.txt || miss "a report"
cp out.csv whole.csv
# Cut short: the first stage alone, whose restart goes on with both.
sed 's/^    {"name": "shear".*//; s/"duration": 0.1},/"duration": 0.1}/' good.json >first.json
"$dem" first.json --threads 1 >/dev/null 2>err.txt || miss "the first stage"
"$dem" good.json --restart out.restart --threads 1 >half.txt 2>err.txt || miss "a restart"
[ "$(grep state half.txt)" = "$(grep state whole.txt)" ] || miss "a restart has other bits"
cmp -s out.csv whole.csv || miss "a restart goes on with another table"
# Nothing is left to run: the report is that of the end, and the table stays.
"$dem" good.json --restart out.restart --threads 1 >over.txt 2>err.txt || miss "a restart after the end"
cmp -s over.txt half.txt || miss "a restart after the end has another report: $(cat over.txt)"
cmp -s out.csv whole.csv || miss "a restart after the end changes the table"
grep -q '^dem: nothing was left to run: all stages of the input were over$' err.txt || miss "a restart after the end says so"
# A wall whose servo ends stands where it is.
sed 's/"block": {"spin": -1}/"lid": {"servo": null}/; s/"out\./"stands./g' good.json >stands.json
"$dem" stands.json --threads 1 >/dev/null 2>err.txt || miss "a servo that ends"
awk -F , 'NR == 1 { while ($(++i) != "lid_y") { } next }
    { y[$1] = $i }
    END { exit !(y[200] < y[0] && y[1000] < y[800] && y[1200] == y[1000] && y[2000] == y[1000]) }' stands.csv ||
    miss "a wall whose servo has ended moves on: $(cat stands.csv)"
# A symbolic link stays one, its file is replaced and keeps its permissions; names may be as long as names can be.
long=$(printf '%0241d' 0)
mkdir -p elsewhere
echo old >elsewhere/real
chmod 640 elsewhere/real
ln -s elsewhere/real linked
sed "s/\"out.csv\"/\"linked.csv\"/; s/\"out.restart\"/\"linked\"/; s/\"restart_every\"/\"grains\": \"$long.csv\", &/" first.json >linked.json
"$dem" linked.json --threads 1 >/dev/null 2>err.txt || miss "a restart behind a link"
[ -L linked ] || miss "a link is replaced"
[ "$(head -c 8 elsewhere/real)" = narc-dem ] || miss "the file behind a link has no restart"
[ "$(stat -c %a elsewhere/real)" = 640 ] || miss "other permissions: $(stat -c %a elsewhere/real)"
[ -f "$long-000000.csv" ] || miss "no file with a long name"
[ -z "$(find . -name '.narc-*')" ] || miss "a temporary file stays"
# What is read-only stays, also for root.
chmod 444 elsewhere/real
cp elsewhere/real kept.real
"$dem" linked.json --threads 1 >/dev/null 2>err.txt && miss "a restart in place of a read-only file"
grep -q "linked: Permission denied" err.txt || miss "a read-only file is not told: $(cat err.txt)"
cmp -s elsewhere/real kept.real || miss "a read-only file is replaced"
[ -z "$(find . -name '.narc-*')" ] || miss "a temporary file stays beside a read-only one"
# Where there is no room for a file the reason is told, and nothing stays.
for output in vtk.vtk grains.csv; do
    name=$output
    [ "$output" = grains.csv ] || name=vtk
    sed "s/\"csv\": \"out.csv\"/\"${output%.*}\": \"$name\"/" first.json >full.json
    (ulimit -f 1 && exec "$dem" full.json --threads 1) >/dev/null 2>err.txt && miss "a full disk: $output"
    grep -q "^dem: ${output%.*}-000000.${output#*.}: File too large$" err.txt || miss "a full disk is not told: $(cat err.txt)"
    [ -z "$(find . -name '.narc-*' -o -name "${output%.*}-0*")" ] || miss "a file stays on a full disk: $output"
done
echo old >full.restart
sed 's/"csv": "out.csv", "restart": "out.restart"/"restart": "full.restart"/' first.json >full.json
(ulimit -f 1 && exec "$dem" full.json --threads 1) >/dev/null 2>err.txt && miss "a restart on a full disk"
grep -q "^dem: full.restart: " err.txt || miss "a restart on a full disk is not told: $(cat err.txt)"
{ [ "$(cat full.restart)" = old ] && [ -z "$(find . -name '.narc-*')" ]; } || miss "a restart is lost on a full disk"
# At a restart outputs may have other names, and files of theirs may be gone: they begin anew.
"$dem" first.json --threads 1 >/dev/null 2>err.txt || miss "the first stage again"
cp out.restart first.restart
sed 's/"csv": "out.csv"/"csv": "new.csv", "grains": "new.csv", "vtk": "new"/' good.json >other.json
"$dem" other.json --restart first.restart --threads 1 >half.txt 2>err.txt || miss "a restart with other outputs"
[ "$(grep state half.txt)" = "$(grep state whole.txt)" ] || miss "a restart with other outputs has other bits"
{ head -n 1 whole.csv; tail -n 5 whole.csv; } | cmp -s - new.csv || miss "a new table: $(cat new.csv)"
{ [ -f new-000006.csv ] && [ -f new-contacts-000010.vtk ] && [ ! -f new-000005.vtk ]; } || miss "frames of a restart with other outputs"
"$dem" other.json --restart out.restart --threads 1 >/dev/null 2>err.txt || miss "a restart with the new outputs"
{ head -n 1 whole.csv; tail -n 5 whole.csv; } | cmp -s - new.csv || miss "the new table again: $(cat new.csv)"
rm out.csv
"$dem" good.json --restart first.restart --threads 1 >/dev/null 2>err.txt || miss "a restart without its table"
cmp -s out.csv new.csv || miss "a table in place of one that is gone"
NARC_ISA=scalar "$dem" good.json --threads 2 >scalar.txt 2>err.txt || miss "a run with scalar"
[ "$(grep state scalar.txt)" = "$(grep state whole.txt)" ] || miss "scalar has other bits"
sed 's/"law": "linear", "kn": 1e7/"law": "hertz"/; s/"density": \([0-9]*\)/"density": \1, "young": 1e8, "poisson": 0.3/g' good.json >hertz.json
"$dem" hertz.json --threads 1 >/dev/null 2>err.txt || miss "a run with the Hertz law"
# A signal at any time, in either stage: the run goes on to the same end.
sed 's/"duration": 0.1/"duration": 5/g' good.json >long.json
"$dem" long.json --threads 1 >long.txt 2>err.txt || miss "a long run"
for signal in "INT 130 5" "TERM 143 300"; do
    # shellcheck disable=SC2086 # its name, the status, and after how many lines of the table
    set -- $signal
    rm -f out.restart out.csv
    "$dem" long.json --threads 1 >cut.txt 2>err.txt &
    process=$!
    while [ ! -f out.csv ] || [ "$(wc -l <out.csv)" -lt "$3" ]; do
        kill -0 $process || break
    done 2>/dev/null
    kill -s "$1" $process 2>/dev/null
    wait $process
    status=$?
    [ $status -eq "$2" ] || miss "status $status after signal $1"
    grep -q "^dem: signal .* at step [0-9]*: go on with --restart out.restart$" err.txt || miss "signal $1 says so"
    "$dem" long.json --restart out.restart --threads 1 >cut.txt 2>err.txt || miss "going on after a signal"
    [ "$(grep state cut.txt)" = "$(grep state long.txt)" ] || miss "other bits after a signal"
done

# ------------------------------------------------------------------------------------------- wrong inputs
# fails NAME MESSAGE ARGUMENTS: status 2, one line that begins with the message (a basic regular expression).
fails() {
    what=$1 message=$2
    shift 2
    "$dem" "$@" >out.txt 2>err.txt
    status=$?
    { [ $status -eq 2 ] && [ "$(wc -l <err.txt)" -eq 1 ] && grep -q "^$message" err.txt; } ||
        miss "$what: status $status, expected $message"
}
# wrong SED MESSAGE: the good input, changed by a sed script.
wrong() {
    sed "$1" good.json >bad.json
    cmp -s good.json bad.json && miss "the script changes nothing: $1"
    fails "$1" "dem: bad.json: $2" bad.json --threads 1
}
fails "no file" "dem: none.json: " none.json
fails "no input" "dem: INPUT is missing"
fails "an option" "dem: unrecognized option.*fly" good.json --fly
fails "threads" "dem: --threads" good.json --threads 0
fails "no restart" "dem: none: it cannot be read" good.json --restart none
printf 'hello' >foreign
fails "a foreign restart" "dem: foreign: it is not a restart file" good.json --restart foreign
"$dem" good.json --threads 1 >/dev/null 2>&1
sed 's/"density": 1000/"density": 1001/' good.json >bad.json
fails "another input" "dem: out.restart: it belongs to another input" bad.json --restart out.restart
head -c 1000 out.restart >short
fails "a short restart" "dem: short: it has 1000 bytes" good.json --restart short
printf 'dear\ndiary\n' >diary.csv
sed 's/"csv": "out.csv"/"csv": "diary.csv"/' good.json >bad.json
fails "a short file for a table" "dem: diary.csv: it is shorter than the table was" bad.json --restart out.restart
cat good.json good.json >diary.csv
cp diary.csv before.csv
fails "a foreign file for a table" "dem: diary.csv: it is not the table that the restart goes on with" bad.json --restart out.restart
cmp -s diary.csv before.csv || miss "a foreign file is changed"
sed 's/^[1-9]\([0-9]*,\)/9\1/' whole.csv >diary.csv
fails "a table of a later time" "dem: diary.csv: it is not the table" bad.json --restart out.restart
printf '{"materials": [}' >bad.json
fails "no JSON" "dem: bad.json: line 1: not valid JSON here: '}'" bad.json
printf '{\n"comment": "a\\u0000b"}' >bad.json
fails "a NUL character" "dem: bad.json: line 2: not valid JSON here: '.u0000b" bad.json
printf '[1]' >bad.json
fails "no object" "dem: bad.json: is not an object '\[1\]'" bad.json

wrong 's/"skin": 0.1/"skn": 0.1/' "skn: is an unknown key"
wrong 's/"skin": 0.1/"skin": 0.1, "skin thickness": 2/' "skin thickness: is an unknown key with the value '2'"
wrong 's/"skin": 0.1/"skin": 0.1, "": 2/' "is an unknown key"
wrong 's/"skin": 0.1/"skin": 0.1, "skin": 2/' "skin: is there twice"
wrong '/"skin"/d' "skin: is missing"
wrong 's/"skin": 0.1/"skin": "x"/' "skin: is not a number '\"x\"'"
wrong 's/"skin": 0.1/"skin": 1e999/' "skin: is not finite"
wrong 's/-9.81\]/-9.81, 0]/' "gravity: is not a list of 2 numbers"
wrong 's/"x": \[0, 4\]/"x": [4, 0]/' "boundary.x: is not a range \[low, high\] '\[4,0\]'"
wrong 's/"x": \[0, 4\]/"x": [0, 1]/' "the periodic cell is too small"
wrong 's/"x": \[0, 4\]/"y": [0, 20]/' "wall 'floor': a plate with normal 0, 1 crosses a periodic border"
wrong 's/"x": \[0, 4\]/"x": [0, 4], "shear": 1/; s/"gravity": \[1, -9\], //' "a cell that is sheared or strained is periodic in x and y, and has neither walls nor gravity"
wrong 's/"x": \[0, 4\]/"x": [0, 4], "shear": 1/' "stages\[1\].gravity: is not for a sheared or strained cell"
wrong 's/"friction": 0.4/"friction": 0.4, "shear": 1/' "stages\[1\].shear: is of a cell whose boundary has shear '1'"
wrong 's/"name": "steel"/"name": "sand"/' "materials\[1\].name: is the name of another material 'sand'\|materials\[1\].name: is the name of another material"
wrong 's/"shapes.json"/"none.json"/' "\|dem: none.json"
wrong 's/"shapes": \["disc", "brick"\]/"shapes": ["ball"]/' "grains\[0\].shapes\[0\]: is not the name of a shape '\"ball\"'"
wrong 's/"count": 20/"count": 2.5/' "grains\[0\].count: is not a whole number '2.5'"
wrong 's/"count": 20/"count": 2000, "tries": 50/' "grains\[0\]: grain [0-9]* of 2000 found no free place in 50 tries"
wrong 's/\[0.2, 0.2, 3.8, 6\]/[0.2, 6, 3.8, 0.2]/' "grains\[0\].region: is not a region"
wrong 's/"normal": \[0.4, 0.1\]/"normal": [0.2, 0.1]/' "grains\[0\].size: does not have its middle between low and high"
wrong 's/"normal": \[0.4, 0.1\]/"normal": [0.4, 1e9]/' "grains\[0\].size: leaves fewer than one in 1000 sizes between low and high"
wrong 's/"size": {"normal": \[0.4, 0.1\], /"size": {/' "grains\[0\].size: is not one of uniform, normal and lognormal"
wrong 's/"place": "random"/"place": "rain"/' "grains\[0\].place: is not one of list, random and lattice"
wrong 's/"spacing": \[1, 1\]/"spacing": [9, 1]/' "grains\[1\]: a lattice of 0 by 2 places has no room"
wrong 's/"upright": true/"upright": 1/' "grains\[1\].upright: is neither true nor false"
wrong 's/"name": "block"/"name": "floor"/' "walls\[1\].name: is the name of another wall"
wrong 's/"name": "block"/"name": "a,b"/' "walls\[1\].name: has a comma"
wrong 's/"name": "fall"/"name": "a\\u001bb"/' "stages\[0\].name: has a comma, a quote, a control character"
wrong 's/"csv": "out.csv"/"csv": "bad.json"/' "output.csv: is the input itself"
wrong 's/"restart": "out.restart"/"restart": ".\/shapes.json"/' "output.restart: is the file of shapes"
wrong 's/"restart": "out.restart"/"restart": "out.csv"/' "output: names one file twice"
wrong 's/"plate": {"point": \[0, 0\], "normal": \[0, 1\]}/"at": [0, 0]/' "walls\[0\]: is not one of plate, box and shape"
wrong 's/"normal": \[0, 1\]/"normal": [0, 0]/' "walls\[0\].plate.normal: has no length"
wrong 's/"radius": 0.1/"radius": 1/' "walls\[1\].box: "
wrong 's/\["floor", "block"\]/["floor", "roof"]/' "walls\[2\].servo.between\[1\]: is not the name of a wall"
wrong 's/"stress": 100/"stress": 100, "force": 2/' "walls\[2\].servo: has not either force or stress"
wrong 's/"law": "linear"/"law": "magic"/' "contact.law: is neither linear nor hertz"
wrong 's/"law": "linear"/"law": "hertz"/' "materials\[0\].young: is missing"
wrong 's/"restitution": 0.5, //' "contact: has neither restitution nor gamma_n"
wrong 's/"restitution": 0.5/"restitution": 0.5, "gamma_n": 3/' "contact.gamma_n: excludes restitution"
wrong 's/\["sand", "steel"\]/["sand", "tin"]/' "contact.pairs\[0\].materials\[1\]: is not a material"
# What would not be used.
wrong 's/"density": 1000/"density": 1000, "young": 1/' "materials\[0\].young: is of the Hertz law: the linear law's stiffness is kn '1'"
wrong 's/"restitution": 0.5/"gamma_n": 5, "tangential_damping": 0.1/' "contact.tangential_damping: is for restitution; with gamma_n it is gamma_t '0.1'"
wrong 's/"restitution": 0.5/"restitution": 0.5, "gamma_t": 3/' "contact.gamma_t: is for gamma_n; with restitution it is tangential_damping '3'"
wrong 's/"restitution": 0.5/"gamma_n": 5/; s/"friction": 0.2/"friction": 0.2, "restitution": 0.5, "gamma_t": 1/' "contact.pairs\[0\].gamma_t: is for gamma_n"
wrong 's/"friction": 0.2}/"friction": 0.2}, {"materials": ["steel", "sand"], "kn": 2e7}/' "contact.pairs\[1\].materials: is a pair that stands before"
wrong 's/"size": {"normal": \[0.4, 0.1\]/"size": {"uniform": [0.3, 0.4]/' "grains\[0\].size.low: is not for uniform, which has limits '0.3'"
wrong 's/"normal": \[0, -1\]}/"normal": [0, -1]}, "at": [0, 12]/' "walls\[2\].at: is not for a plate"
wrong 's/"at": \[2, 0\]/"at": [2, 0], "size": 3/' "walls\[1\].size: is not for a box, which has width and height '3'"
wrong 's/\["floor", "block"\]/["floor", "floor"]/' "walls\[2\].servo.between: names one wall twice"
wrong 's/\["floor", "block"\]/["floor", "lid"]/' "walls\[2\].servo.between\[1\]: is the wall that moves: .* '\"lid\"'"
wrong 's/"stress": 100/"force": 100/' "walls\[2\].servo.between: is for stress, not for force"
wrong 's/"between": \["floor", "block"\], //' "walls\[2\].servo.between: is missing"
wrong 's/"direction": \[0, -1\]/"direction": [1, 0]/' "walls\[2\].servo.direction: runs along the plate, which has no ends '\[1,0\]'"
wrong 's/"gain": 1, "max_speed": 1}/"gain": 1, "max_speed": 1}, "velocity": [0, 1]/' "walls\[2\].velocity: is not across the direction of the wall's servo"
wrong 's/"block": {"spin": -1}/"lid": {"velocity": [1, 0.1]}/' "stages\[1\].walls.lid.velocity: is not across the direction of the wall's servo"
sed 's/"law": "hertz"/"law": "hertz", "kn": 1e7/' hertz.json >bad.json
fails "kn with hertz" "dem: bad.json: contact.kn: is not of the Hertz law: stiffness comes from the materials" bad.json

wrong 's/"walls": {"floor"/"walls": {"roof"/' "stages\[1\].walls.roof: is of no wall of that name"
wrong 's/{"velocity": \[0.5, 0\]}/{"velocity": 3}/' "stages\[1\].walls.floor.velocity: is not a list of 2 numbers '3'"
wrong 's/{"velocity": \[0.5, 0\]}/{"spin": 3}/' "stages\[1\].walls.floor.spin: turns a plate"
wrong 's/"restart": "out.restart", //' "output.restart_every: is there without restart"
wrong 's/"csv": "out.csv"/"csv": 7/' "output.csv: is not a string '7'"
wrong 's/"csv": "out.csv"/"grains": "out"/' "output.grains: does not end in .csv '\"out\"'"
wrong 's/"csv": "out.csv"/"vtk": "out.vtk"/' "output.vtk: has a suffix"
sed 's|"csv": "out.csv"|"csv": "no/folder/out.csv"|' good.json >bad.json
fails "no folder for the table" "dem: no/folder/out.csv: " bad.json

# A lid that goes away from the grains.
sed 's/"direction": \[0, -1\], "stress": 100, "between": \["floor", "block"\], "gain": 1, "max_speed": 1/"direction": [0, 1], "force": 1, "gain": 50, "max_speed": 50, "travel": 1.999/' \
    good.json >bad.json
fails "nothing to press" "dem: step 400: wall 'lid' has moved by more than 1.999 without touching a grain: its servo has nothing to press" \
    bad.json --threads 1

# Too long a step is told before the run, and one that is rather long in a line on standard error.
sed 's/"time_step": 1e-4/"time_step": 1e-2/; s/"duration": 0.1/"duration": 3/g' good.json >bad.json
fails "too long a step" "dem: bad.json: time step 0.01 is more than a fifth of what the shortest contact lasts" bad.json
sed 's/"time_step": 1e-4/"time_step": 3e-4/' good.json >rather.json
"$dem" rather.json >/dev/null 2>err.txt || miss "a rather long step"
grep -q '^dem: rather.json: time step 0.0003 is more than a 15th of what the shortest contact lasts' err.txt ||
    miss "a rather long step is not told: $(cat err.txt)"
"$dem" good.json >/dev/null 2>err.txt || miss "a run"
grep -q 'time step' err.txt && miss "a step that is short enough is told"
# Too fast: which grain, and what to do.
sed 's/"velocity": \[1, 0\]/"velocity": [300, -800]/' good.json >bad.json
fails "too fast" "dem: step [0-9]*: grain [0-9]* .*Use a shorter time step" bad.json
# Ground is no grain; it may be a wall.
sed 's/\]}$/, {"name": "ground", "chain": {"closed": false, "arcs": [{"center": [0, 0], "radius": 0, "start": 1.5707963267948966, "end": 1.5707963267948966}, {"center": [-2, 0], "radius": 0, "start": 1.5707963267948966, "end": 1.5707963267948966}]}}]}/' \
    shapes.json >ground.json
sed 's/"shapes.json"/"ground.json"/; s/\["disc", "brick"\]/["ground"]/' good.json >bad.json
fails "a chain" "dem: bad.json: grains\[0\].shapes: names a chain, which only walls can be" bad.json
sed 's/"shapes.json"/"ground.json"/; s/"plate": {"point": \[0, 0\], "normal": \[0, 1\]}/"shape": "ground", "size": 1/' good.json >bad.json
fails "a size of a chain" "dem: bad.json: walls\[0\].size: is not for a chain" bad.json
# Grains that overlap before the run begins.
sed 's/"at": \[2, 9.5\]/"at": [2, 0.3]/' good.json >bad.json
fails "grains in a wall" "dem: bad.json: step 0: grain 28 overlaps wall .*They are placed so" bad.json
sed 's/"at": \[2, 9.5\]/"at": [2, -50]/' good.json >bad.json
fails "a grain behind a wall" "dem: bad.json: step 0: grain 28 is behind wall 'floor'. They are placed so" bad.json
# Where the report or the table cannot be written the run has failed.
if [ -c /dev/full ]; then
    "$dem" good.json >/dev/full 2>err.txt && miss "a report on a full disk"
    grep -q '^dem: the report cannot be written' err.txt || miss "a report on a full disk is not told"
    ln -s /dev/full full.csv
    sed 's/"csv": "out.csv"/"csv": "full.csv"/' good.json >full.json
    "$dem" full.json >/dev/null 2>err.txt && miss "a table on a full disk"
    grep -q '^dem: full.csv: it cannot be written: No space left on device$' err.txt || miss "a table on a full disk is not told"
    "$dem" --help >/dev/full 2>err.txt && miss "help on a full disk"
fi
# One thread, unless more are asked for.
OMP_DISPLAY_ENV=false OMP_NUM_THREADS=2 "$dem" long.json >/dev/null 2>err.txt &
process=$!
sleep 0.3
if [ -r /proc/$process/status ]; then
    [ "$(sed -n 's/^Threads:[^0-9]*//p' /proc/$process/status)" = 1 ] || miss "more than one thread by default"
fi
kill $process 2>/dev/null
wait $process
sed 's/"velocity": \[1, 0\]/"velocity": [1e200, 0]/' good.json >bad.json
fails "a grain that leaves" "dem: step 1: grain 28 .*Use a shorter time step" bad.json --threads 1

if [ $failures -ne 0 ]; then
    echo "$failures checks went wrong"
    exit 1
fi
echo "all checks passed"
