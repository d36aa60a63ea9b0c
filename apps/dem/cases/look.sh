#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: sh look.sh PROGRAM FOLDER INPUT RESTART PICTURE REGION WIDTH [COLOR]: one more step from a restart file, drawn
# to PICTURE with another region, width and colour; names are from FOLDER. Nothing else is written.
set -eu
program=$1 folder=$2 input=$3 restart=$4 picture=$5 region=$6 width=$7 color=${8:-plain}
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
             "picture_color": "$color"}
}
END
rm -f look-*.png
"$program" look.json --restart "$restart" --threads 1 >/dev/null
mv look-*.png "$picture"
rm look.json
