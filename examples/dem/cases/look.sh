#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh look.sh PROGRAM FOLDER INPUT RESTART PICTURE REGION WIDTH: one more step from a restart file of that folder, drawn
# to PICTURE (from there) with another region and width. Nothing else is written.
set -eu
program=$1 folder=$2 input=$3 restart=$4 picture=$5 region=$6 width=$7
cd "$folder"
step=$(sed -n 's/.*"time_step": \([^,]*\),.*/\1/p' "$input")
# All stages of the input are over: one is added.
awk -v step="$step" '
/"output": \{/ { exit }
/^  \],?$/ && stages { sub(/\],?/, ""); print "    , {\"duration\": " step "}\n  ],"; stages = 0; next }
/"stages": \[.*\],$/ { sub(/\],$/, ", {\"duration\": " step "}],"); print; next }
/"stages": \[/ { stages = 1 }
{ print }' "$input" >look.json
cat >>look.json <<END
  "output": {"every": $step, "picture": "look.png", "picture_region": [$region], "picture_width": $width,
             "picture_color": "plain"}
}
END
rm -f look-*.png
"$program" look.json --restart "$restart" --threads 1 >/dev/null
mv look-*.png "$picture"
rm look.json
