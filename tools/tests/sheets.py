# SPDX-License-Identifier: MIT
"""sheets.py NARC - narc fit: folders, grids, the JSON of TexturePacker and Aseprite. A frame gives the shape that its image
by itself gives."""
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

NARC = os.path.abspath(sys.argv[1])
os.chdir(folder := tempfile.mkdtemp())


def write_png(name, rows):
    """rows: lists of (red, green, blue, alpha)."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    data = b"".join(b"\0" + bytes(v for pixel in row for v in pixel) for row in rows)
    with open(name, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 6, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b""))


def image(width, height, *boxes):
    return [[(200, 90, 20, 255) if any(x <= c < x + w and y <= r < y + h for x, y, w, h in boxes) else (0, 0, 0, 0)
             for c in range(width)] for r in range(height)]


def turn(rows):
    """A quarter clockwise."""
    return [list(row) for row in zip(*rows[::-1])]


def paste(onto, rows, x, y):
    for r, row in enumerate(rows):
        onto[y + r][x:x + len(row)] = row


def fit(*arguments):
    done = subprocess.run([NARC, "fit", *arguments, "--tolerance", "0.1", "--polygon", "--starts", "1", "--out", "out.json"],
                          capture_output=True, text=True)
    assert done.returncode == 0, (arguments, done.stderr)
    with open("out.json", encoding="utf-8") as file:
        return {shape.pop("name"): shape for shape in json.load(file)["shapes"]}


def fails(message, *arguments):
    done = subprocess.run([NARC, "fit", *arguments, "--arcs", "4", "--out", "new.json"], capture_output=True, text=True)
    assert done.returncode == 2 and re.match(message, done.stderr) and done.stderr.count("\n") == 1, (arguments, done.stderr)
    assert not os.path.exists("new.json")


# Two frames that no turn and no mirror brings onto themselves, and what is left of them without their borders.
walk, jump = image(20, 14, (3, 2, 9, 3), (3, 5, 4, 7)), image(12, 16, (1, 4, 6, 2), (5, 6, 6, 9))
os.mkdir("alone")
write_png("alone/walk-1.png", walk)
write_png("alone/jump.png", jump)
with open("alone/notes.txt", "w", encoding="utf-8") as file:
    file.write("no picture\n")
alone = fit("alone")
assert sorted(alone) == ["jump", "walk-1"], alone
assert fit("alone/walk-1.png", "alone/") == {"walk-1": alone["walk-1"], "jump": alone["jump"],
                                             "walk-1-2": alone["walk-1"]}

sheet = image(40, 30)
paste(sheet, [row[3:12] for row in walk[2:12]], 4, 6)
paste(sheet, turn([row[1:11] for row in jump[4:15]]), 20, 3)
os.mkdir("packed")
write_png("packed/sheet.png", sheet)
FRAMES = {
    "walk/1.png": {"frame": {"x": 4, "y": 6, "w": 9, "h": 10}, "rotated": False, "trimmed": True,
                   "spriteSourceSize": {"x": 3, "y": 2, "w": 9, "h": 10}, "sourceSize": {"w": 20, "h": 14}},
    "jump.png": {"frame": {"x": 20, "y": 3, "w": 10, "h": 11}, "rotated": True, "trimmed": True,
                 "spriteSourceSize": {"x": 1, "y": 4, "w": 10, "h": 11}, "sourceSize": {"w": 12, "h": 16}}}
LIST = [{"filename": name, **frame} for name, frame in FRAMES.items()]


def write_json(value):
    with open("packed/sheet.json", "w", encoding="utf-8") as file:
        json.dump(value, file)


META = {"app": "https://www.codeandweb.com/texturepacker", "image": "sheet.png"}
for value in ({"frames": FRAMES, "meta": META}, {"frames": LIST, "meta": {**META, "image": "art/out/sheet.png"}},
              {"textures": [{"image": "sheet.png", "frames": LIST}], "meta": {}}):
    write_json(value)
    assert fit("packed/sheet.json") == alone, value

# A grid: the middle cell has no ink.
cells = image(36, 16)
paste(cells, jump, 0, 0)
paste(cells, jump, 24, 0)
write_png("cells.png", cells)
assert fit("cells.png", "--grid", "12x16") == {"cells-0": alone["jump"], "cells-2": alone["jump"]}

fails("narc: cells.png: the image has 36 x 16 pixels, no whole number of --grid cells of 10 x 16", "cells.png", "--grid",
      "10x16")
for wrong in "x", "8", "8x", "0x8", "8x8x8", "-1x4":
    fails("narc: --grid must be a cell's width and height in pixels, such as 32x48, not '" + wrong, "cells.png", "--grid=" + wrong)
with open("points.csv", "w", encoding="utf-8") as file:
    file.write("0,0\n4,0\n0,3\n")
fails("narc: --grid is for PNG, and none is given", "points.csv", "--grid", "8x8")
write_png("empty.png", image(8, 8))
fails("narc: empty.png: all cells of its --grid are transparent", "empty.png", "--grid", "4x4")
os.mkdir("nothing")
fails("narc: nothing: a folder without .svg or .png files", "nothing")
write_json({"frames": FRAMES})
fails('narc: packed/sheet.json: it has frames, but does not tell their image under "meta", "image"', "packed/sheet.json")
write_json({"frames": FRAMES, "meta": {"image": "other.png"}})
fails("narc: packed/other.png: No such file", "packed/sheet.json")
FRAMES["jump.png"]["frame"]["x"] = 30
write_json({"frames": FRAMES, "meta": META})
fails("narc: packed/sheet.json: frame 'jump.png' goes to 41, 13, and the image has 40 x 30 pixels", "packed/sheet.json")
FRAMES["jump.png"]["sourceSize"]["w"] = 5
write_json({"frames": FRAMES, "meta": META})
fails("narc: packed/sheet.json: frame 'jump.png': frame, spriteSourceSize and sourceSize must be whole", "packed/sheet.json")

os.chdir("/")
shutil.rmtree(folder)
print("all checks passed")
