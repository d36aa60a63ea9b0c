# SPDX-License-Identifier: MIT
"""export.py NARC - narc export: every format is read again by a parser that is not narc's, and compared with the shapes,
which are known by formulas. python3-ezdxf, godot3-server: where they are installed."""
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

NARC = os.path.abspath(sys.argv[1])
T = 0.01
os.chdir(folder := tempfile.mkdtemp())

LENS = [[0, -4, 5, 0.92729521800161223, 2.2142974355881810], [-3, 0, 0, 2.2142974355881810, 4.0688878715914053],
        [0, 4, 5, 4.0688878715914053, 5.3558900889779739], [3, 0, 0, 5.3558900881779739, 7.2104805251811984]]
LENS[2][4] = LENS[3][3] = 5.3558900881779739
ARCS = [dict(center=a[:2], radius=a[2], start=a[3], end=a[4]) for a in LENS]
SHAPES = {"shapes": [
    {"name": "a&b", "circle": 1.5, "origin": [3, 4]},
    {"name": "pill", "capsule": {"length": 4, "radius": 1}},
    {"name": "box", "box": {"width": 4, "height": 2}, "origin": [1, 0]},
    {"name": "soft", "box": {"width": 4, "height": 2, "radius": 0.5}},
    {"name": "house/1", "polygon": [[0, 0], [4, 0], [0, 3]]},
    {"name": "lens", "arcs": ARCS},
    {"name": "house/2", "arcs": ARCS, "origin": [5, 1]},
    {"name": "many", "polygon": [[math.cos(k * math.tau / 30), math.sin(k * math.tau / 30)] for k in range(30)]},
]}
# Ground: a valley, then a hill; a closed one with a quarter cut out of a square.
CHAINS = {"shapes": [
    {"name": "ground", "chain": {"closed": False, "arcs": [
        {"center": [-4, 0], "radius": 2, "start": math.pi / 2, "end": math.pi},
        {"center": [-8, 0], "radius": -2, "start": math.pi, "end": math.pi / 2}]}},
    {"name": "bay", "chain": {"closed": True, "arcs": [
        {"center": [0, 0], "radius": 0, "start": math.pi, "end": 1.5 * math.pi},
        {"center": [4, 0], "radius": 0, "start": -math.pi / 2, "end": 0},
        {"center": [4, 2], "radius": 0, "start": 0, "end": math.pi / 2},
        {"center": [4, 4], "radius": -2, "start": math.pi / 2, "end": 0},
        {"center": [2, 4], "radius": 0, "start": 0, "end": math.pi / 2},
        {"center": [0, 4], "radius": 0, "start": math.pi / 2, "end": math.pi}]}}]}
for name, value in ("shapes.json", SHAPES), ("chains.json", CHAINS):
    with open(name, "w", encoding="utf-8") as file:
        json.dump(value, file)


def lens_support(x, y):
    angle = math.atan2(y, x) % math.tau
    for cx, cy, radius, start, end in LENS:
        if start <= angle <= end or start <= angle + math.tau <= end:
            return cx * x + cy * y + radius
    raise AssertionError(angle)


# How far each body reaches along a direction, in the coordinates of its input.
SUPPORT = {
    "a&b": lambda x, y: 3 * x + 4 * y + 1.5,
    "pill": lambda x, y: 2 * abs(x) + 1,
    "box": lambda x, y: x + 2 * abs(x) + abs(y),
    "soft": lambda x, y: 1.5 * abs(x) + 0.5 * abs(y) + 0.5,
    "house": lambda x, y: max(0, 4 * x, 3 * y, 5 * x + y + lens_support(x, y)),
    "lens": lens_support,
    "many": lambda x, y: max(math.cos(k * math.tau / 30) * x + math.sin(k * math.tau / 30) * y for k in range(30)),
}


def narc(*arguments):
    done = subprocess.run([NARC, *arguments], capture_output=True, encoding="utf-8")
    return done.returncode, done.stdout, done.stderr


def export(form, *options, shapes="shapes.json"):
    code, out, err = narc("export", shapes, "--to", form, "--out", "out." + form, *options)
    assert code == 0, (form, out, err)
    with open("out." + form, encoding="utf-8") as file:
        return file.read()


def fails(message, *arguments):
    code, out, err = narc(*arguments)
    assert code == 2 and re.match("narc: " + message, err) and not out and err.count("\n") == 1, (arguments, code, err)
    assert not [name for name in os.listdir() if name.startswith(("new", ".narc"))], arguments


def area(points):
    x, y = points[0]
    return sum((p[0] - x) * (q[1] - y) - (q[0] - x) * (p[1] - y) for p, q in zip(points, points[1:] + points[:1])) / 2


def check(bodies, y_down, most=0, moved=None, tolerance=T, scale=1, inside=2e-6):
    """bodies: name to pieces, circles (x, y, radius) or convex polygons. They bound the shapes, within the tolerance."""
    assert sorted(bodies) == sorted(SUPPORT), sorted(bodies)
    for name, pieces in bodies.items():
        x, y = moved(name) if moved else (0, 0)
        for polygon in (p for p in pieces if isinstance(p, list)):
            assert area(polygon) > 0 and (not most or len(polygon) <= most), (name, polygon)
            for k, p in enumerate(polygon):
                q, r = polygon[k - 1], polygon[k - 2]
                turn = (q[0] - r[0]) * (p[1] - q[1]) - (q[1] - r[1]) * (p[0] - q[0])
                assert turn > 0, (name, r, q, p)
        for k in range(180):
            u, v = math.cos(k * math.tau / 180), math.sin(k * math.tau / 180)
            reach = max((p[0] - x) * u + (p[1] - y) * v + p[2] if isinstance(p, tuple)
                        else max((a - x) * u + (b - y) * v for a, b in p) for p in pieces)
            want = SUPPORT[name](u, -v if y_down else v) * scale
            assert -inside * scale <= reach - want <= tolerance, (name, k, reach, want)


def pairs(text):
    return [tuple(map(float, pair.split(","))) for pair in text.split()]


def xy(points):
    return [(p["x"], p["y"]) for p in points]


def read_tmx(text):
    bodies = {}
    for group in xml.fromstring(text.encode()).iter("objectgroup"):
        for thing in group:
            x, y = float(thing.get("x")), float(thing.get("y"))
            w, h = float(thing.get("width", 0)), float(thing.get("height", 0))
            shape = [list(pairs(p.get("points"))) for p in thing if p.tag == "polygon"]
            if thing.find("ellipse") is not None:
                assert w == h
                shape = [(x + w / 2, y + h / 2, w / 2)]
            bodies.setdefault(group.get("name"), []).extend(shape or [[(x, y), (x + w, y), (x + w, y + h), (x, y + h)]])
    return bodies


def read_tmj(text):
    bodies = {}
    for layer in json.loads(text)["layers"]:
        for o in layer["objects"]:
            x, y, w, h = o["x"], o["y"], o["width"], o["height"]
            bodies.setdefault(layer["name"], []).append(
                xy(o["polygon"]) if "polygon" in o else (x + w / 2, y + h / 2, w / 2) if o.get("ellipse")
                else [(x, y), (x + w, y), (x + w, y + h), (x, y + h)])
    return bodies


SECTION = re.compile(r'\[(gd_scene|sub_resource|node)((?: \w+=(?:"[^"\\]*"|\d+))*)\]\n((?:\w+ = [^\n]+\n)*)\n*')
VALUE = re.compile(r'-?[\d.e+-]+$|(?:Vector2|PackedVector2Array|PoolVector2Array)\([-\d.e+, ]*\)$|SubResource\( ?"?\d+"? ?\)$')


def numbers(text):
    return [float(n) for n in re.findall(r"-?\d[\d.]*(?:e[-+]\d+)?", re.sub(r"^\w+", "", text))]


def read_godot(text):
    """By the grammar of text scenes: nothing else stands in them."""
    shapes, bodies, at, sections = {}, {}, 0, 0
    while at < len(text):
        found = SECTION.match(text, at)
        assert found, text[at:at + 80]
        at = found.end()
        keys = dict(re.findall(r'(\w+)="?([^" ]*)"?', found[2]))
        values = dict(re.findall(r"(\w+) = ([^\n]+)", found[3]))
        assert all(VALUE.match(v) for v in values.values()), values
        sections += found[1] == "sub_resource"
        if found[1] == "gd_scene":
            is_3, steps = keys["format"] == "2", int(keys["load_steps"])
        elif found[1] == "sub_resource":
            shapes[keys["id"]] = keys["type"], values
        elif keys["type"] == "CollisionShape2D":
            kind, of = shapes[re.search(r"\d+", values["shape"])[0]]
            x, y = numbers(values.get("position", "Vector2(0, 0)"))
            turn = float(values.get("rotation", 0))
            radius, height = float(of.get("radius", 0)), float(of.get("height", 0))
            name = keys["parent"]
            if kind == "CircleShape2D":
                shape = [(x, y, radius)]
            elif kind == "CapsuleShape2D":
                half = height / 2 - (0 if is_3 else radius)
                shape = [(x - s * half * math.sin(turn), y + s * half * math.cos(turn), radius) for s in (-1, 1)]
            elif kind == "RectangleShape2D":
                w, h = numbers(of["extents"]) if is_3 else [n / 2 for n in numbers(of["size"])]
                shape = [[(x - w, y - h), (x + w, y - h), (x + w, y + h), (x - w, y + h)]]
            else:
                flat = numbers(of.get("points") or of["segments"])
                shape = [list(zip(flat[::2], flat[1::2]))]
            bodies.setdefault(name, []).extend(shape)
    assert sections + 1 == steps
    return bodies


def read_phaser(text):
    """Circles would be polygons to Matter, which lie inside by more than the tolerance."""
    return {name: [xy(f["vertices"][0]) for f in body["fixtures"]] for name, body in json.loads(text).items()}


def read_box2d(text):
    bodies = {}
    for body in json.loads(text)["body"]:
        for f in body["fixture"]:
            if "circle" in f:
                c = f["circle"]
                shape = (c["center"]["x"], c["center"]["y"], c["radius"])
            else:
                v = f["polygon" if "polygon" in f else "chain"]["vertices"]
                shape = list(zip(v["x"], v["y"]))
            bodies.setdefault(body["name"], []).append(shape)
    return bodies


def read_libgdx(text):
    return {b["name"]: [(c["cx"], c["cy"], c["r"]) for c in b["circles"]] + [xy(p) for p in b["polygons"]]
            for b in json.loads(text)["rigidBodies"]}


def read_svg(text):
    """Points of the outlines, arcs by the radius and the sweep that their commands have."""
    bodies = {}
    for group in xml.fromstring(text)[:]:
        for thing in group:
            if thing.tag.endswith("circle"):
                shape = tuple(float(thing.get(key)) for key in ("cx", "cy", "r"))
            else:
                shape = []
                for command, rest in re.findall(r"([MLA])([^MLAz]*)", thing.get("d")):
                    n = [float(part) for part in rest.split()]
                    if command == "A":
                        (x, y), (r, _, _, large, sweep, u, v) = shape[-1], n
                        assert large == 0
                        chord = math.hypot(u - x, v - y)
                        high = math.sqrt(max(r * r - chord * chord / 4, 0)) * (1 if sweep else -1) / chord
                        cx, cy = (x + u) / 2 - high * (v - y), (y + v) / 2 + high * (u - x)
                        a, b = math.atan2(y - cy, x - cx), math.atan2(v - cy, u - cx)
                        turn = (b - a) % math.tau if sweep else -((a - b) % math.tau)
                        shape += [(cx + r * math.cos(a + turn * k / 1000), cy + r * math.sin(a + turn * k / 1000))
                                  for k in range(1, 1000)]
                    shape.append(tuple(n[-2:]))
                if shape[0] == shape[-1]:
                    shape.pop()
            bodies.setdefault(group.get("id"), []).append(shape)
    return bodies


READERS = {"tmx": (read_tmx, True, 0), "tmj": (read_tmj, True, 0), "godot": (read_godot, True, 0),
           "godot3": (read_godot, True, 0), "phaser": (read_phaser, True, 0), "box2d": (read_box2d, False, 8),
           "libgdx": (read_libgdx, False, 8), "svg": (read_svg, True, 0)}
for form, (read, y_down, most) in READERS.items():
    with_tolerance = [] if form == "svg" else ["--tolerance", str(T)]
    check(read(export(form, *with_tolerance)), y_down, most, tolerance=1e-6 if form == "svg" else T)
    scaled = [] if form == "svg" else ["--tolerance", str(40 * T)]
    check(read(export(form, *scaled, "--scale", "40", "--y-down")), True, most, tolerance=40 * T, scale=40)


def pivot(place):
    def moved(name):
        left, right = -SUPPORT[name](-1, 0), SUPPORT[name](1, 0)
        low, high = -SUPPORT[name](0, -1), SUPPORT[name](0, 1)
        return -(left + right) / 2, -((low + high) / 2 if place == "center" else low)
    return moved


for place in "center", "bottom":
    check(read_box2d(export("box2d", "--tolerance", str(T), "--origin", place)), False, 8, pivot(place))

# Far from the origin digits are enough, or it is an error that says what to do; around its centre a body is as it is here.
for away, tolerance in (1e4, 1e-5), (1e9, T), (1e9, 1e-5), (1e14, T):
    with open("far.json", "w", encoding="utf-8") as file:
        json.dump({"shapes": [{**s, "origin": [c + d for c, d in zip(s.get("origin", [0, 0]), (away, -away))]}
                              for s in SHAPES["shapes"]]}, file)
    fine, rounded = ["--tolerance", str(tolerance)], 8e-15 * away
    for form in "tmx", "godot", "box2d", "svg":
        read, y_down, most = READERS[form]
        if rounded < tolerance / 10:
            check(read(export(form, *fine, shapes="far.json")), y_down, most, lambda _: (away, away if y_down else -away),
                  tolerance + rounded, inside=2e-6 + rounded)
        else:
            fails("far.json: shape '.*' is too thin, or at .* too far from the origin, .*: --origin center brings",
                  "export", "far.json", "--to", form, *fine, "--out", "new")
    if away == 1e14:
        check(read_box2d(export("box2d", *fine, "--origin", "center", shapes="far.json")), False, 8, pivot("center"), tolerance)

with open("far.json", "w", encoding="utf-8") as file:
    json.dump({"shapes": [{"name": "far", "box": {"width": 64, "height": 64}, "origin": [0, -1e11]}]}, file)
for form in "tmx", "tmj":
    fails(r"what is 1e\+11 from the origin needs a map of more than 2\^31 tiles: --origin center", "export", "far.json", "--to",
          form, "--out", "new")

# No two bodies get one name, and one that can keep its own does: nodes, and layers, which have no case.
NAMES = ["a.b", "a:b", "a_b", "a_b_0", "A_B", "Käse", "日本", "x😀", "x_", "a/b"]
with open("names.json", "w", encoding="utf-8") as file:
    json.dump({"shapes": [{"name": name, "circle": k + 1} for k, name in enumerate(NAMES)]}, file)
for form in "godot", "godot3":
    bodies = read_godot(export(form, shapes="names.json"))
    assert {name: shape[0][2] - 1 for name, shape in bodies.items()} == {
        "a_b_0_0": 0, "a_b_1": 1, "a_b": 2, "a_b_0": 3, "A_B": 4, "Käse": 5, "日本": 6, "x😀": 7, "x_": 8, "a_b_9": 9}, bodies
layers = re.findall(r"CIRCLE\n8\n(.*)\n", export("dxf", shapes="names.json"))
assert layers == ["a.b", "a_b_1", "a_b", "a_b_0", "A_B_4", r"K\U+00E4se", r"\U+65E5\U+672C", "x__7", "x_", "a_b_9"], layers

# The fewest corners: a circle of 1.5 within 0.01 takes 28; what is plain stays plain; 30 corners are 5 pieces of 8.
bodies = read_godot(export("godot", "--tolerance", str(T)))
assert [len(bodies[n]) for n in ("a&b", "pill", "box", "many")] == [1, 2, 1, 1] and len(bodies["box"][0]) == 4
bodies = read_box2d(export("box2d", "--tolerance", str(T)))
assert len(bodies["many"]) == 5 and abs(sum(map(area, bodies["many"])) - 15 * math.sin(math.tau / 30)) < 1e-9

# Chains: corners lie on the chain or in the solid's air by no more than the tolerance, and go its way.
for form, read in ("tmx", None), ("godot", None), ("box2d", read_box2d), ("svg", read_svg):
    text = export(form, "--tolerance", str(T), shapes="chains.json")
    if not read:
        continue
    chains = read(text)
    sign = -1 if form == "svg" else 1
    line = [(x, sign * y) for x, y in chains["ground"][0]][::sign]
    assert math.dist(line[0], (-4, 2)) < 1e-9 and math.dist(line[-1], (-8, -2)) < 1e-9, line
    for x, y in line:
        away = math.hypot(x + 4, y) - 2 if x >= -6 else 2 - math.hypot(x + 8, y)
        assert -1e-9 <= away <= T, (x, y, away)
    bay = chains["bay"][0]
    assert (bay[0] == bay[-1]) == (form == "box2d")
    if form == "box2d": # over the seam
        loop = json.loads(text)["body"][1]["fixture"][0]["chain"]
        assert loop["hasPrevVertex"] is loop["hasNextVertex"] is True
        assert xy([loop["prevVertex"], loop["nextVertex"]]) == [bay[-2], bay[1]]
        assert "hasPrevVertex" not in json.loads(text)["body"][0]["fixture"][0]["chain"]
    assert -1e-6 <= area(bay) - (16 - math.pi) <= (0.1 if form == "box2d" else 1e-4), area(bay)

# Drawings come back.
export("svg", "--origin", "center")
if sys.argv[2:] != ["OFF"]:
    code, out, err = narc("fit", "out.svg", "--ids", "lens", "--chain", "--tolerance", "1e-4", "--out", "lens.json")
    assert code == 0, err
    with open("lens.json", encoding="utf-8") as file:
        assert len(json.load(file)["shapes"][0]["chain"]["arcs"]) == 4

# Fits, whose arcs meet as nearly as single precision has their centres: convex in the digits that are written, too.
with open("blob.csv", "w", encoding="utf-8") as file:
    for k in range(240):
        t, r = k * math.tau / 240, 100 + 9 * math.sin(k * math.tau / 80) + 30 * math.cos(k * math.tau / 120)
        file.write(f"{r * math.cos(t)},{0.5 * r * math.sin(t)}\n")
for k, options in enumerate((["--arcs", "5"], ["--parts", "5", "--tolerance", "4"])):
    code, out, err = narc("fit", "blob.csv", *options, "--out", f"fit{k}.json")
    assert code == 0, err
    for form, (read, y_down, most) in READERS.items():
        for pieces in read(export(form, "--tolerance", "0.2", shapes=f"fit{k}.json")).values():
            for polygon in pieces:
                assert not most or len(polygon) <= most
                for q, r, p in zip(polygon, polygon[1:] + polygon[:1], polygon[2:] + polygon[:2]):
                    turn = (r[0] - q[0]) * (p[1] - r[1]) - (r[1] - q[1]) * (p[0] - r[0])
                    assert turn > 0, (form, k, q, r, p)

# The table alone: nothing is written. An input is no output.
before = sorted(os.listdir())
code, out, err = narc("export", "shapes.json", "--to", "dxf", "--out", "new.dxf", "--dry-run")
assert code == 0 and "house" in out and sorted(os.listdir()) == before, (out, err)
fails(".*one of the inputs", "export", "shapes.json", "--to", "svg", "--out", "./shapes.json")
fails("--to must be one of tmx, .*dxf, not 'x'", "export", "shapes.json", "--to", "x", "--out", "new")
fails("--to is missing", "export", "shapes.json", "--out", "new")
fails("--origin must be one of input, center, bottom, not 'x'", "export", "shapes.json", "--to", "svg", "--origin", "x")
fails("unexpected argument", "export", "shapes.json", "chains.json", "--to", "svg", "--out", "new")
fails("shapes.json: shape 'pill' has arcs and tmx has none: --tolerance.* is missing", "export", "shapes.json", "--to", "tmx",
      "--out", "new")
fails("shapes.json: shape 'pill': an arc has more than 1000 corners with --tolerance 1e-12; ", "export", "shapes.json", "--to",
      "tmx", "--tolerance", "1e-12", "--out", "new")
fails("chains.json: shape 'ground' is a chain, and phaser has only convex pieces", "export", "chains.json", "--to", "phaser",
      "--tolerance", "1", "--out", "new")

try:
    import ezdxf
    from ezdxf import recover
except ImportError:
    print("skipped: DXF, without ezdxf")
else:
    export("dxf", shapes="names.json")
    assert {"Käse", "日本"} < {entity.dxf.layer for entity in recover.readfile("out.dxf")[0].modelspace()}
    export("dxf")
    bodies = {}
    for entity in ezdxf.readfile("out.dxf").modelspace():
        points = [] # of its lines and arcs
        for part in [entity] if entity.dxftype() == "CIRCLE" else entity.virtual_entities():
            points += ([part.dxf.start, part.dxf.end] if part.dxftype() == "LINE" else part.vertices(
                part.angles(2000) if part.dxftype() == "ARC" else [k * 0.1 for k in range(3600)]))
        bodies.setdefault(entity.dxf.layer, []).append([(p[0], p[1]) for p in points])
    assert sorted(bodies) == sorted(SUPPORT), sorted(bodies)
    for name, pieces in bodies.items():
        for k in range(180):
            u, v = math.cos(k * math.tau / 180), math.sin(k * math.tau / 180)
            assert abs(max(a * u + b * v for p in pieces for a, b in p) - SUPPORT[name](u, v)) <= 2e-6, (name, k)

godot = shutil.which("godot3-server")
if not godot:
    print("skipped: Godot 3, without godot3-server")
else:
    os.mkdir("game")
    shutil.copy("out.godot3", "game/scene.tscn")
    export("godot3", "--tolerance", str(T))
    shutil.copy("out.godot3", "game/scene.tscn")
    with open("game/project.godot", "w", encoding="utf-8") as file:
        file.write("config_version=4\n")
    with open("game/list.gd", "w", encoding="utf-8") as file:
        file.write("extends SceneTree\nfunc _init():\n\tfor body in load('res://scene.tscn').instance().get_children():\n"
                   "\t\tfor at in body.get_children():\n\t\t\tprint('PIECE ', body.name, ' ', at.shape.get_class())\n\tquit()\n")
    listed = subprocess.run([godot, "--path", "game", "-s", "list.gd"], capture_output=True, text=True, timeout=60,
                            env={**os.environ, "HOME": folder})
    lines = [line for line in listed.stdout.splitlines() if line.startswith("PIECE")]
    assert "PIECE pill CapsuleShape2D" in lines and "PIECE box RectangleShape2D" in lines and len(lines) == 8, listed

os.chdir("/")
shutil.rmtree(folder)
print("all checks passed")
