# SPDX-License-Identifier: MIT
"""python3 draw.py pile-000012.vtk pile.svg [--color FIELD] [--top VALUE] [--region LOW_X LOW_Y HIGH_X HIGH_Y]
[--width PIXELS] [--no-forces]: a frame as an SVG picture. Grains have colours for a field of the file (speed; or
--color none), walls are grey. A line runs from centre to contact to centre, as wide as the force is large."""
import argparse
import math
import struct

TYPES = {"float": "f", "double": "d", "int": "i"}


def read_vtk(path):
    """What a file of VTK's old binary format holds: time, points, cells (lists of points), their fields."""
    with open(path, "rb") as file:
        data = file.read()
    at, out = 0, {"fields": {}, "cells": []}

    def line():
        nonlocal at
        end = data.index(b"\n", at)
        text, at = data[at:end].decode(), end + 1
        return text

    def numbers(count, kind):
        nonlocal at
        size = struct.calcsize(kind) * count
        values = struct.unpack_from(">%d%s" % (count, kind), data, at)
        at += size
        return values

    assert line() == "# vtk DataFile Version 3.0"
    out["title"] = line()
    assert line() == "BINARY" and line() == "DATASET POLYDATA"
    while at < len(data):
        words = line().split()
        if not words:
            continue
        if words[0] == "POINTS":
            values = numbers(3 * int(words[1]), "f")
            out["points"] = [values[i : i + 3] for i in range(0, len(values), 3)]
        elif words[0] in ("POLYGONS", "VERTICES"):
            values, i = numbers(int(words[2]), "i"), 0
            while i < len(values):
                out["cells"].append(values[i + 1 : i + 1 + values[i]])
                i += 1 + values[i]
            assert len(out["cells"]) == int(words[1])
        elif words[0] not in ("FIELD", "CELL_DATA", "POINT_DATA"):
            width, count = int(words[1]), int(words[2])
            values = numbers(width * count, TYPES[words[3]])
            out["fields"][words[0]] = [values[i : i + width] for i in range(0, len(values), width)]
    out["time"] = out["fields"].pop("TimeValue")[0][0]
    return out


def color_of(share):
    """From pale blue by yellow to red."""
    stops = [(0xC6, 0xDB, 0xEF), (0xFE, 0xE0, 0x8B), (0xD7, 0x30, 0x27)]
    at = min(max(share, 0), 1) * (len(stops) - 1)
    k = min(int(at), len(stops) - 2)
    return "#%02x%02x%02x" % tuple(round(a + (at - k) * (b - a)) for a, b in zip(stops[k], stops[k + 1]))


def center_of(points):
    return [sum(p[i] for p in points) / len(points) for i in (0, 1)]


def draw(bodies, contacts, out, options):
    outlines = [[bodies["points"][i] for i in cell] for cell in bodies["cells"]]
    walls = [wall for (wall,) in bodies["fields"]["wall"]]
    every = [p for outline in outlines for p in outline]
    low_x, low_y, high_x, high_y = options.region or (
        min(p[0] for p in every), min(p[1] for p in every), max(p[0] for p in every), max(p[1] for p in every))
    scale = options.width / (high_x - low_x)
    values = [0.0] * len(walls) if options.color == "none" else [v for (v,) in bodies["fields"][options.color]]
    top = options.top or max([v for v, wall in zip(values, walls) if not wall], default=0) or 1

    def place(p):
        return "%.2f,%.2f" % ((p[0] - low_x) * scale, (high_y - p[1]) * scale)

    with open(out, "w", encoding="utf-8") as svg:
        svg.write('<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d">\n<title>%s</title>\n'
                  '<rect width="100%%" height="100%%" fill="white"/>\n<g stroke="#666666" stroke-width="0.3">\n'
                  % (options.width, math.ceil((high_y - low_y) * scale), bodies["title"]))
        for outline, wall, value in zip(outlines, walls, values):
            svg.write('<polygon fill="%s" points="%s"/>\n'
                      % ("#aaaaaa" if wall else color_of(value / top), " ".join(map(place, outline))))
        svg.write('</g>\n<g stroke="black" stroke-linecap="round" fill="none">\n')
        ends, forces = contacts["fields"], [math.hypot(f[0], f[1]) for f in contacts["fields"]["force"]]
        size = max([v for (v,), wall in zip(bodies["fields"]["size"], walls) if not wall], default=1)
        most = sorted(forces)[-1 - len(forces) // 50] if forces else 1
        for k, point in enumerate(contacts["points"] if options.forces else []):
            way = [point]
            for end in (ends["body_a"][k][0], ends["body_b"][k][0]):
                center = center_of(outlines[end])
                if not walls[end] and math.hypot(center[0] - point[0], center[1] - point[1]) < 4 * size:
                    way.insert(0 if end == ends["body_a"][k][0] else len(way), center)
            width = 0.25 * size * scale * min(forces[k] / (most or 1), 2)
            if width > 0.05 and len(way) > 1:
                svg.write('<polyline stroke-width="%.2f" points="%s"/>\n' % (width, " ".join(map(place, way))))
        svg.write("</g>\n</svg>\n")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("frame")
    parser.add_argument("out")
    parser.add_argument("--color", default="speed")
    parser.add_argument("--top", type=float)
    parser.add_argument("--region", type=float, nargs=4)
    parser.add_argument("--width", type=float, default=800)
    parser.add_argument("--no-forces", dest="forces", action="store_false")
    options = parser.parse_args()
    stem, number = options.frame.rsplit("-", 1)
    draw(read_vtk(options.frame), read_vtk(stem + "-contacts-" + number), options.out, options)


if __name__ == "__main__":
    main()
