# SPDX-License-Identifier: MIT
"""objects.py NARC SVG - collision objects of Tiled, R.U.B.E. and PhysicsEditor come in as they went out, and as they are known;
tilesets, resources and DXF go out."""
import json
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib

NARC, SVG = os.path.abspath(sys.argv[1]), sys.argv[2:] != ["OFF"]
os.chdir(folder := tempfile.mkdtemp())


def narc(code, *arguments):
    done = subprocess.run([NARC, *arguments], capture_output=True, encoding="utf-8")
    assert done.returncode == code, (arguments, done)
    return done


def write(name, value):
    with open(name, "w", encoding="utf-8") as file:
        file.write(value if isinstance(value, str) else json.dumps(value))


def fitted(file, *options):
    """Names to kind, area and middle of the box of what a file has."""
    report = json.loads(narc(0, "fit", file, "--parts", "1", "--out", "fitted.json", "--report", "json", *options).stdout)
    with open("fitted.json", encoding="utf-8") as made:
        origins = {shape["name"]: shape["origin"] for shape in json.load(made)["shapes"]}
    return {shape["name"]: (shape["kind"], shape["area"], origins[shape["name"]]) for shape in report["inputs"][0]["shapes"]}


def same(found, known, **slack):
    assert sorted(found) == sorted(known), (found, known)
    for name, (kind, area, middle) in known.items():
        assert (found[name][0] == "circle") == (kind == "circle") and abs(found[name][1] - area) < slack.get(name, 1e-3) and math.dist(found[name][2], middle) < 1e-3, (name, found[name])


# What went out comes in: a circle, a box, a triangle of a compound with its box.
write("shapes.json", {"shapes": [
    {"name": "disc", "circle": 1.5, "origin": [3, 4]}, {"name": "box", "box": {"width": 4, "height": 2}, "origin": [1, -7]},
    {"name": "house/1", "polygon": [[-2, -1], [2, -1], [0, 2]], "origin": [20, 5]}, {"name": "house/2", "box": {"width": 2, "height": 3}, "origin": [20, 1]}]})
KNOWN = {"disc": ("circle", 2.25 * math.pi, [3, 4]), "box": ("box", 8, [1, -7]), "house/1": ("polygon", 6, [20, 5]), "house/2": ("box", 6, [20, 1])}
for form in ("tmj", "box2d", *(["tmx"] if SVG else [])):
    narc(0, "export", "shapes.json", "--to", form, "--tolerance", "1e-5", "--out", "out." + form)
    same(fitted("out." + form), KNOWN)
narc(0, "export", "shapes.json", "--to", "phaser", "--tolerance", "2e-3", "--out", "out.phaser")
same(fitted("out.phaser"), {**KNOWN, "disc": ("polygon", *KNOWN["disc"][1:])}, disc=0.02)
tiled = shutil.which("tiled")
if tiled and SVG: # as Tiled itself reads it
    subprocess.run([tiled, "--export-map", "json", "out.tmx", "tiled.tmj"], check=True, capture_output=True, timeout=120, env={**os.environ, "HOME": folder, "QT_QPA_PLATFORM": "offscreen"})
    same(fitted("tiled.tmj"), KNOWN)
else:
    print("skipped: Tiled, without tiled")

# Tiled's own: turned about the upper left corner, clockwise; ellipses; tiles, whose lower left corner is 0, 0; what is no outline.
TILESET = {"type": "tileset", "tileheight": 32, "tilewidth": 32, "tiles": [
    {"id": 3, "objectgroup": {"objects": [
        {"id": 1, "name": "", "x": 4, "y": 8, "width": 8, "height": 4, "rotation": 90}, {"id": 2, "name": "", "x": 1, "y": 1, "width": 6, "height": 6, "ellipse": True},
        {"id": 3, "name": "spot", "x": 1, "y": 1, "point": True}]}},
    {"id": 5, "imageheight": 16, "objectgroup": {"objects": [{"id": 1, "name": "roof", "x": 2, "y": 10, "polygon": [{"x": 0, "y": 0}, {"x": 6, "y": 0}, {"x": 3, "y": -6}]}]}}]}
TILES = {"tile-3/1": ("box", 32, [2, 20]), "tile-3/2": ("circle", 9 * math.pi, [4, 28]), "roof": ("polygon", 18, [5, 8])}
write("set.tsj", TILESET)
write("map.tmj", {"type": "map", "tilesets": [TILESET, {"source": "other.tsj"}], "layers": [{"type": "group", "layers": [
    {"type": "objectgroup", "name": "walls", "offsetx": 10, "objects": [{"x": 0, "y": 5, "width": 2, "height": 4, "name": ""}, {"x": 1, "y": 2, "gid": 4, "width": 9, "height": 9}]}]}]})
same(fitted("set.tsj"), TILES)
same(fitted("map.tmj"), {**TILES, "walls": ("box", 8, [11, -7])})
write("oval.tmj", {"type": "map", "layers": [{"name": "oval", "objects": [{"x": 0, "y": 0, "width": 8, "height": 4, "rotation": 30, "ellipse": True}]}]})
narc(0, "fit", "oval.tmj", "--chain", "--tolerance", "1e-3", "--out", "oval.json")
with open("oval.json", encoding="utf-8") as file:
    turn = math.radians(30)
    x, y = 4 * math.cos(turn) - 2 * math.sin(turn), -(4 * math.sin(turn) + 2 * math.cos(turn))
    for arc in json.load(file)["shapes"][0]["chain"]["arcs"]:
        u = arc["center"][0] + arc["radius"] * math.cos(arc["start"]) - x
        v = arc["center"][1] + arc["radius"] * math.sin(arc["start"]) - y
        along, aside = u * math.cos(turn) - v * math.sin(turn), u * math.sin(turn) + v * math.cos(turn)
        assert abs(math.hypot(along / 4, aside / 2) - 1) < 1e-3, arc
if SVG:
    write("set.tsx", """<?xml version="1.0" encoding="UTF-8"?>
<tileset version="1.10" name="set" tilewidth="32" tileheight="32" tilecount="8" columns="4"><image source="a.png" width="128" height="64"/>
 <tile id="3"><objectgroup draworder="index" id="2"><object id="1" x="4" y="8" width="8" height="4" rotation="90"/>
  <object id="2" x="1" y="1" width="6" height="6"><ellipse/></object><object id="3" name="spot" x="1" y="1"><point/></object></objectgroup></tile>
 <tile id="5"><image source="b.png" width="16" height="16"/><objectgroup><object id="1" name="roof" x="2" y="10"><polygon points="0,0 6,0 3,-6"/></object></objectgroup></tile>
</tileset>""")
    same(fitted("set.tsx"), TILES)
write("none.tmj", {"type": "map", "layers": []})
write("pills.tmj", {"type": "map", "layers": [{"objects": [{"name": "lies", "x": 1, "y": 2, "width": 6, "height": 2, "rotation": 90, "capsule": True}, {"name": "stands", "width": 2, "height": 6, "capsule": True}, {"name": "round", "width": 4, "height": 4, "capsule": True}, {"name": "disc", "width": 4, "height": 4, "ellipse": True}]}]})
same(fitted("pills.tmj"), {**{name: ("circle", 4 * math.pi, [2, -2]) for name in ("round", "disc")}, "lies": ("capsule", 8 + math.pi, [0, -5]), "stands": ("capsule", 8 + math.pi, [1, -3])})
assert narc(2, "fit", "none.tmj", "--arcs", "3").stderr == "narc: none.tmj: it has no collision objects\n"
write("wrong.json", {"type": "map", "layers": [{"objects": [{"polygon": [{"x": 1e300, "y": 0}]}]}]})
assert narc(2, "fit", "wrong.json", "--arcs", "3").stderr.startswith("narc: wrong.json: ")
for odd in "[]", "{", '{"type": 1}', '{"body": {}}', '{"type": "map", "layers": 7}', '{"a": {"fixtures": [{"vertices": [1]}]}}':
    write("odd.json", odd)
    assert narc(2, "fit", "odd.json", "--arcs", "3").stderr.count("\n") == 1


# Tilesets: of a sheet by its cells, of images by their names; and in again.
def png(name, width, height):
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + b"".join(b"\0\xff" if x % 16 >= 4 and y % 16 >= 8 and (x >= 16 or y >= 16) else bytes(2) for x in range(width)) for y in range(height))
    with open(name, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 4, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


os.mkdir("art")
png("art/sheet.png", 48, 32)
narc(0, "fit", "art/sheet.png", "--grid", "16x16", "--tolerance", "0.3", "--out", "cells.json")
narc(0, "export", "cells.json", "--to", "tsj", "--image", "sheet.png", "--grid", "16x16", "--tolerance", "0.1", "--out", "art/sheet.tsj")
with open("art/sheet.tsj", encoding="utf-8") as file:
    made = json.load(file)
assert (made["image"], made["imagewidth"], made["columns"], made["tilecount"], made["tileheight"]) == ("sheet.png", 48, 3, 6, 16), made
assert [tile["id"] for tile in made["tiles"]] == [1, 2, 3, 4, 5] and "image" not in made["tiles"][0]
for name, (kind, area, middle) in fitted("art/sheet.tsj").items():
    assert kind in ("box", "polygon") and abs(area - 96) < 8 and math.dist(middle, [10, 4]) < 0.5, (name, kind, area, middle)
png("art/crate.png", 32, 16)
narc(0, "fit", "art/crate.png", "--tolerance", "0.3", "--out", "crate.json")
narc(0, "export", "crate.json", "--to", "tsj", "--image", "{name}.png", "--tolerance", "0.1", "--out", "art/crates.tsj")
with open("art/crates.tsj", encoding="utf-8") as file:
    (tile,) = json.load(file)["tiles"]
assert (tile["id"], tile["image"], tile["imagewidth"], tile["imageheight"]) == (0, "crate.png", 32, 16), tile
for message, *options in (("a tileset has images: --image must name", "--to", "tsj"), ("a tileset has images", "--to", "tsj", "--image", "a.png"),
                          ("--image and --grid are for tsj", "--to", "svg", "--grid", "2x2"), ("a tileset has the pixels", "--to", "tsj", "--image", "{name}.png", "--scale", "2"),
                          ("crate.json: shape 'crate' is no cell of a sheet", "--to", "tsj", "--image", "art/sheet.png", "--grid", "16x16"),
                          ("absent/crate.png: No such file", "--to", "tsj", "--image", "absent/{name}.png"), ("crate.json: --image must be PNG", "--to", "tsj", "--image", "{name}.json")):
    assert narc(2, "export", "crate.json", "--tolerance", "1", *options).stderr.startswith("narc: " + message), message

# What is broken is named, and what is left out is told.
def tmx(inside):
    return '<map width="1"><objectgroup name="a">%s</objectgroup></map>' % inside


BOX = '<object id="1" width="4" height="2"/>'
if SVG:
    for number, (text, message) in enumerate((
            (tmx(BOX)[:-8], r"broken0.tmx:1: .*"), (tmx(BOX) + "<x", r"broken1.tmx:1: .*"),
            (tmx('<object id="1" x="inf" width="4" height="2"/>'), r"broken2.tmx: 'a?': x is no number: 'inf'|broken2.tmx: 'objects': x is no number: 'inf'"),
            (tmx('<object id="1" name="b" rotation="30deg" width="4" height="2"/>'), "broken3.tmx: 'b': rotation is no number: '30deg'"),
            (tmx('<object id="1"><polygon points="0,0 5,0 5,5 a,b 7,7"/></object>'), r"broken4.tmx:1: .*a point is not x,y: 'a,b 7,7'"),
            (tmx('<object name="flat"><polyline points="0,0 1,0 2,0"/></object>' + BOX), "broken5.tmx: 'flat': ")), 0):
        write("broken%d.tmx" % number, text)
        assert re.match("(narc: )?(%s)" % message, said := narc(2, "fit", "broken%d.tmx" % number, "--arcs", "3").stderr), (message, said)
    write("some.tmx", '<?xml version="1.0"?><!-- <svg> -->' + tmx(BOX + '<object width="-4" height="2"/>'))
    assert "some.tmx: 'a': 1 objects without width and height" in narc(0, "fit", "some.tmx", "--arcs", "3", "--out", "some.json").stderr
    os.mkdir("kinds")
    write("kinds/pill.tx", '<?xml version="1.0" encoding="UTF-8"?><template><object name="pill" width="6" height="2"><capsule/></object></template>')
    write("kinds/wide.tj", {"type": "template", "object": {"name": "wide", "width": 8, "height": 2, "rotation": 0}})
    write("kinds.tmx", tmx('<object template="kinds/pill.tx" x="10" y="20"/><object template="kinds/wide.tj" name="tall" x="1" y="2" height="9"/>'))
    PILL = ("capsule", 8 + math.pi, [13, -21])
    same(fitted("kinds.tmx"), {"pill": PILL, "tall": ("box", 72, [5, -6.5])})
    for inside, message in (('<object template="kinds/absent.tx"/>', "kinds/absent.tx: No such file"), ('<object template="a.tmx"/>', "a.tmx: it is no template of an object")):
        write("a.tmx", tmx(inside))
        assert message in narc(2, "fit", "a.tmx", "--arcs", "3").stderr
    write("moved.tmx", '<map><group offsetx="100" offsety="50"><objectgroup name="a" offsetx="7">%s</objectgroup></group></map>' % BOX)
    (_, _, middle), = fitted("moved.tmx").values()
    assert math.dist(middle, [109, -51]) < 0.1, middle
    write("drawing.svg", '<!-- see <map> --><svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><circle cx="4" cy="4" r="3"/></svg>')
    narc(0, "fit", "drawing.svg", "--arcs", "3", "--out", "drawing.json")
    write("walls.tmx", tmx("".join('<object name="wall" x="%d" width="4" height="2"/>' % (9 * k) for k in range(2000))))
    begin = time.monotonic()
    narc(0, "fit", "walls.tmx", "--tolerance", "0.5", "--out", "walls.json")
    with open("walls.json", encoding="utf-8") as file:
        names = [shape["name"] for shape in json.load(file)["shapes"]]
    assert names[:2] + names[-1:] == ["wall", "wall-2", "wall-2000"] and time.monotonic() - begin < 60
write("width.json", {"width": {"fixtures": [{"circle": {"x": 1, "y": 2, "radius": 3}}]}})
same(fitted("width.json"), {"width": ("circle", 9 * math.pi, [1, -2])})
write("words.tmj", {"type": "map", "layers": [{"objects": [{"name": "b", "x": "5", "width": 4, "height": 2}]}]})
assert "words.tmj: 'b': x is no number: '5'" in narc(2, "fit", "words.tmj", "--arcs", "3").stderr

write("wrong.json", {"shapes": [{"name": name, "circle": 2} for name in ("walk-1", "jump-1", "late-99")]})
for cells, message in ("16x16", "shapes 'walk-1' and 'jump-1' are the same cell"), ("64x64", "shape 'walk-1' is cell 1 of a sheet that has 0"):
    assert message in narc(2, "export", "wrong.json", "--to", "tsj", "--image", "art/sheet.png", "--grid", cells, "--tolerance", "0.1").stderr

# A Godot resource for each body, plain where its numbers say all; one of two pieces has none.
write("plain.json", {"shapes": [{"name": "far", "box": {"width": 4, "height": 2}, "origin": [1, 0]}, {"name": "box", "box": {"width": 4, "height": 2}}, {"name": "ball", "circle": 1.5},
                                {"name": "up", "arcs": [{"center": [0, y], "radius": 1, "start": start, "end": start + math.pi} for y, start in ((1.5, 0), (-1.5, -math.pi))]}, {"name": "flat", "capsule": {"length": 3, "radius": 1}}]})
NUMBER = r"[-\d., ]*"
for form, words, box, height in ("tres", r"format=3", r"size = Vector2\(4, 2\)", 5), ("tres3", r"format=2", r"extents = Vector2\(2, 1\)", 3):
    polygon = r"ConvexPolygonShape2D", r"points = P\w+Vector2Array\(%s\)" % NUMBER
    narc(0, "export", "plain.json", "--to", form, "--tolerance", "0.1", "--out", "{name}." + form)
    for name, (kind, value) in {"far": polygon, "flat": polygon, "box": ("RectangleShape2D", box), "ball": ("CircleShape2D", "radius = 1.5"),
                                "up": ("CapsuleShape2D", r"radius = 1\nheight = %d" % height)}.items():
        with open(name + "." + form, encoding="utf-8") as file:
            text = file.read()
        assert re.fullmatch(r'\[gd_resource type="%s" %s\]\n\n\[resource\]\n%s\n\n' % (kind, words, value), text), text
    assert "a file of %s holds one shape" % form in narc(2, "export", "shapes.json", "--to", form, "--tolerance", "0.1", "--out", "{name}.x").stderr
    assert "a file of %s holds one shape" % form in narc(2, "export", "plain.json", "--to", form, "--tolerance", "0.1").stderr
godot = shutil.which("godot3-server")
if not godot:
    print("skipped: Godot 3, without godot3-server")
else:
    os.mkdir("game")
    for name in "far", "up":
        shutil.copy(name + ".tres3", "game/%s.tres" % name)
    write("game/project.godot", "config_version=4\n")
    write("game/list.gd", "extends SceneTree\nfunc _init():\n\tfor name in ['far', 'up']:\n\t\tprint('SHAPE ', load('res://' + name + '.tres').get_class())\n\tprint('HEIGHT ', load('res://up.tres').height)\n\tquit()\n")
    listed = subprocess.run([godot, "--path", "game", "-s", "list.gd"], capture_output=True, text=True, timeout=120, env={**os.environ, "HOME": folder})
    assert re.search(r"^SHAPE ConvexPolygonShape2D\nSHAPE CapsuleShape2D\nHEIGHT 3$", listed.stdout, re.M), listed

# DXF: layers and arcs come back; a spline with weights is named.
narc(0, "export", "shapes.json", "--to", "dxf", "--out", "out.dxf")
if "without dxflib" not in subprocess.run([NARC, "fit", "out.dxf", "--arcs", "3"], capture_output=True, encoding="utf-8").stderr:
    same(fitted("out.dxf", "--ids", "disc,box"), {name: KNOWN[name] for name in ("disc", "box")})
    narc(0, "fit", "out.dxf", "--ids", "*", "--parts", "4", "--out", "layers.json")
    spline = "0\nSPLINE\n8\na\n70\n4\n71\n2\n72\n6\n73\n3\n74\n0\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n" + "".join(f"10\n{x}\n20\n{y}\n30\n0\n41\n{w}\n" for x, y, w in ((0, 0, 1), (4, 0, 2), (4, 4, 1)))
    write("spline.dxf", "0\nSECTION\n2\nENTITIES\n" + spline + "0\nENDSEC\n0\nEOF\n")
    assert re.match(r"spline.dxf:\d+: .*its control points have weights", narc(2, "fit", "spline.dxf", "--arcs", "3").stderr)

os.chdir("/")
shutil.rmtree(folder)
print("all checks passed")
