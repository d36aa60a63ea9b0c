#!/bin/sh
# SPDX-License-Identifier: MIT
#
# memory.sh DEM PRELOAD - whichever allocation of the discrete element program fails.
dem=$1 preload=$2
. "$(dirname "$0")/../../../tests/support/scarcity.sh"
. "$(dirname "$0")/common.sh"

cat >first.json <<'END'
{
  "materials": [{"name": "sand", "density": 1000}],
  "shapes": "shapes.json",
  "grains": [{"place": "lattice", "region": [0.5, 0.5, 3.5, 3.5], "spacing": [1, 1], "jitter": 0.2, "shapes": ["disc", "brick"], "size": 0.5, "material": "sand"}],
  "walls": [{"name": "floor", "material": "sand", "plate": {"point": [0, 0], "normal": [0, 1]}}],
  "boundary": {"x": [0, 4]},
  "gravity": [0, -9.81],
  "contact": {"law": "linear", "kn": 1e6, "restitution": 0.5, "friction": 0.5},
  "time_step": 1e-3,
  "skin": 0.1,
  "stages": [{"name": "fall", "duration": 0.1}],
  "output": {"every": 0.05, "restart": "first.restart"}
}
END
sed 's/"duration": 0.1/"duration": 0.2/; s/"every": 0.05, "restart": "first/"every": 0.1, "csv": "out.csv", "grains": "g.csv", "vtk": "v", "restart": "out/' \
    first.json >second.json

run_out "a run" 2 first.restart "$dem" first.json --threads 1
"$dem" first.json --threads 1 >usual.txt 2>err.txt || miss "a run, again"
growing=out.csv
run_out "a restart" 2 out.restart "$dem" second.json --restart first.restart --threads 1
[ $failures -eq 0 ] || exit 1
