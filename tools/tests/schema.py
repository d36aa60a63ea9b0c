# SPDX-License-Identifier: MIT
"""schema.py NARC - docs/shapes.schema.json says yes to what narc reads and writes, and no to what it refuses for its form.
Needs python3-jsonschema."""
import copy
import functools
import glob
import json
import math
import operator
import os
import re
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    sys.exit(77)

NARC = os.path.abspath(sys.argv[1])
ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
with open(os.path.join(ROOT, "docs/shapes.schema.json"), encoding="utf-8") as schema:
    JUDGE = jsonschema.Draft202012Validator(json.load(schema))
JUDGE.check_schema(JUDGE.schema)


def complaint(value):
    done = subprocess.run([NARC, "view", "-"], input=json.dumps(value), capture_output=True, encoding="utf-8")
    return done.stderr


QUARTERS = [{"center": [0, 0], "radius": 1, "start": k * math.pi / 2, "end": (k + 1) * math.pi / 2} for k in range(4)]
GOOD = [
    {"name": "disc", "circle": 1, "user": {"any": [None]}}, {"name": "ring", "arcs": QUARTERS, "origin": [1, -2]},
    {"name": "pill", "capsule": {"length": 2, "radius": 0.5}}, {"name": "box", "box": {"width": 2, "height": 1, "radius": 0.25}},
    {"name": "square", "polygon": [[0, 0], [1, 0], [1, 1], [0, 1]], "radius": 0.125},
    {"name": "arcs", "points": [[1, 0], [0, 1], [-1, 0], [0, -1]], "radius": 1},
    {"name": "lens", "four_arc": {"radius_low": 5, "radius_high": 5, "distance": 8, "radius_left": 0.25}},
    {"name": "floor", "half_plane": True}, {"name": "ground", "chain": {"closed": False, "arcs": [
        {"center": [-4, 0], "radius": 2, "start": math.pi / 2, "end": math.pi},
        {"center": [-8, 0], "radius": -2, "start": math.pi, "end": math.pi / 2}]}}]
BAD = [{"shapes": [{"name": "a", "circle": 1, "box": {"width": 1, "height": 1}}]}, {"shapes": [{"name": "a", "circle": 1, "origin": [1]}]}, {}, [], {"shapes": []}, {"shapes": [], "x": 1}, {"shapes": [{"circle": 1}]}, {"shapes": [{"name": "a"}]}]
for name in "", " a", "a ", "a,b", 'a"b', "a\tb", "a\n", 7:
    BAD.append({"shapes": [{"name": name, "circle": 1}]})
for shape in {"circle": 0}, {"capsule": {"length": 2, "radius": 0}}, {"box": {"width": 0, "height": 1}}, {"box": {"width": 1, "height": 0}}:
    BAD.append({"shapes": [{"name": "a", **shape}]})
BAD.append({"$schema": 1, "shapes": GOOD})
for shape in GOOD:
    kind = next(key for key in shape if key not in ("name", "origin", "radius", "user"))
    BAD.append({"shapes": [{**shape, "x": 1}]})
    if kind not in ("points", "polygon"):
        BAD.append({"shapes": [{**shape, "radius": 1}]})
for value in {"shapes": GOOD}, {"$schema": "shapes.schema.json", "shapes": GOOD[:1], "user": None}, {"shapes": [{"name": "\u00a0", "circle": 1}]}, *({"shapes": [shape]} for shape in GOOD):
    assert not complaint(value) and JUDGE.is_valid(value), value
for value in BAD:
    assert complaint(value) and not JUDGE.is_valid(value), value

# Each value left out, and in its place one of another kind: what narc reads the schema takes, and where narc finds the form wrong
# the schema does, too.
FORM = re.compile("is missing|unknown key|is not|is neither|is an empty list|items, at most|it has both|none of|takes no|a name cannot")


def places(value, at=()):
    for key, item in value.items() if isinstance(value, dict) else enumerate(value[:1]) if isinstance(value, list) else ():
        yield (*at, key)
        yield from places(item, (*at, key))


def change(value, at, put):
    value = inner = copy.deepcopy(value)
    for key in at[:-1]:
        inner = inner[key]
    put(inner, at[-1])
    return value


for shape in GOOD:
    for at in places({key: item for key, item in shape.items() if key != "name"}):
        old = functools.reduce(lambda v, k: v[k], at, shape)
        kinds = [7] if isinstance(old, str) else [[]] if isinstance(old, list) else ["x"]
        for put in operator.delitem, *(lambda inner, key, new=new: operator.setitem(inner, key, new) for new in kinds):
            value = {"shapes": [change(shape, at, put)]}
            said = complaint(value)
            valid = JUDGE.is_valid(value)
            assert valid if not said else not valid or not FORM.search(said), (value, said, valid)

# Files that are held and written.
held = [name for pattern in ("apps/dem/cases/shapes.json", "apps/lammps/*.json", "apps/lammps/tests/bad/*.json", "tests/fuzz/seeds/shapes/*.json")
        for name in glob.glob(os.path.join(ROOT, pattern))]
for name in held:
    with open(name, encoding="utf-8-sig") as file:
        value = json.load(file)
    said = complaint(value)
    assert JUDGE.is_valid(value) == (not said or not FORM.search(said)), (name, said)
assert len(held) >= 5, held
with tempfile.TemporaryDirectory() as folder:
    points = os.path.join(folder, "el.csv")
    with open(points, "w", encoding="utf-8") as file:
        file.write("0,0\n4,0\n4,1\n1,1\n1,3\n0,3\n")
    for options in (["--arcs", "4", "--starts", "1"], ["--chain", "--tolerance", "0.2"],
                    ["--parts", "2", "--polygon", "--arcs", "4", "--starts", "1"]):
        out = subprocess.run([NARC, "fit", points, *options], check=True, capture_output=True).stdout
        JUDGE.validate(json.loads(out))
print("all checks passed")
