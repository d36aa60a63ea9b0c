# SPDX-License-Identifier: MIT
#
# common.sh - what the scripts beside it share: a folder of their own, two shapes, what is said of a check that fails.
set -u
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0
miss() {
    echo "WRONG $1"
    sed 's/^/      /' err.txt
    failures=$((failures + 1))
}

cat >shapes.json <<'END'
{"shapes": [{"name": "disc", "circle": 1}, {"name": "brick", "box": {"width": 2, "height": 1, "radius": 0.2}}]}
END
