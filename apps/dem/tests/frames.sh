#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh frames.sh DEM: files for ParaView and tables of grains of a run that was interrupted, and its pictures.
# Without python3 the files are not read: 77, skipped.
set -eu
dem=$1 here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
fail() {
    echo "$*" >&2
    exit 1
}

cat >shapes.json <<'END'
{"shapes": [{"name": "disc", "circle": 1}, {"name": "brick", "box": {"width": 2, "height": 1, "radius": 0.2}}]}
END
cat >in.json <<'END'
{
  "materials": [{"name": "sand", "density": 1000}],
  "shapes": "shapes.json",
  "grains": [{"place": "lattice", "region": [0, 1, 6, 6], "spacing": [0.6, 0.6], "jitter": 0.2, "shapes": ["disc", "brick"], "size": {"uniform": [0.3, 0.45]}, "material": "sand"}],
  "walls": [
    {"name": "floor", "material": "sand", "plate": {"point": [0, 0], "normal": [0, 1]}},
    {"name": "slope", "material": "sand", "plate": {"point": [-0.2, 0], "normal": [2, 1]}},
    {"name": "block", "material": "sand", "box": {"width": 0.5, "height": 0.5}, "at": [6.5, 0.5], "angle": 0.3}
  ],
  "gravity": [0, -9.81],
  "contact": {"law": "linear", "kn": 1e7, "restitution": 0.5, "friction": 0.5},
  "time_step": 1e-4, "skin": 0.1,
  "stages": [{"name": "fall", "duration": 0.6}, {"name": "rest", "duration": 0.4}],
  "output": {"every": 0.1, "csv": "table.csv", "grains": "out.csv", "vtk": "out", "restart": "out.restart"}
}
END

# As if it had been interrupted after frame 6, and another run, given up, had left frames up to 7.
sed 's/"duration": 0.6/"duration": 0.7/; s/, {"name": "rest".*}\]/]/' in.json >longer.json
"$dem" longer.json --threads 1 >/dev/null 2>&1 || fail "the run that was given up"
[ -f out-contacts-000007.vtk ] || fail "there is no frame 7"
sed 's/, {"name": "rest".*}\]/]/' in.json >first.json
"$dem" first.json --threads 1 >/dev/null 2>&1 || fail "the first stage"
"$dem" in.json --restart out.restart --threads 1 >/dev/null 2>&1 || fail "the restart"

sed 's/"vtk": "out"/"vtk": "none\/out"/' in.json >bad.json
"$dem" bad.json >/dev/null 2>err.txt && fail "no error for a folder that does not exist"
grep -q 'none/out-000000.vtk' err.txt || fail "the folder that does not exist: $(cat err.txt)"

command -v python3 >/dev/null || exit 77
python3 "$here/frames.py" "$folder"
# A polygon for each body, and a line for each contact that bears.
python3 "$here/../draw.py" out-000010.vtk drawn.svg --color coordination
{ [ "$(grep -c '<polygon' drawn.svg)" -eq 83 ] && grep -q '<polyline' drawn.svg; } || fail "the picture: $(head -c 300 drawn.svg)"
