# SPDX-License-Identifier: MIT
"""python3 frames.py FOLDER: reads the files for ParaView that frames.sh made, with an XML parser, and checks what
they say against each other, the table of grains and closed forms."""
import base64
import csv
import math
import os
import struct
import sys
import xml.etree.ElementTree as tree

TYPES = {"Float32": "f", "Int32": "i"}


def read_arrays(section):
    arrays = {}
    for item in section.findall("DataArray"):
        data = base64.b64decode(item.text, validate=True)
        size = struct.unpack("=Q", data[:8])[0]
        assert size == len(data) - 8, (item.get("Name"), size, len(data))
        values = struct.unpack("=%d%s" % (size // 4, TYPES[item.get("type")]), data[8:])
        width = int(item.get("NumberOfComponents"))
        arrays[item.get("Name")] = [values[i : i + width] for i in range(0, len(values), width)]
    return arrays


def read_vtp(path):
    root = tree.parse(path).getroot()
    assert root.get("type") == "PolyData" and root.get("header_type") == "UInt64"
    assert root.get("byte_order") == ("LittleEndian" if sys.byteorder == "little" else "BigEndian")
    piece = root.find("PolyData/Piece")
    sections = {part.tag: read_arrays(part) for part in piece}
    assert len(sections["Points"]["points"]) == int(piece.get("NumberOfPoints"))
    time = float(root.find("PolyData/FieldData/DataArray").text)
    return piece, sections, time


def area_of(points):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1])) / 2


def is_near(a, b, tolerance):
    return abs(a - b) <= tolerance


def check_bodies(path, table):
    piece, sections, _ = read_vtp(path)
    cells = sections["CellData"]
    ends = [end for (end,) in sections["Polys"]["offsets"]]
    assert [i for (i,) in sections["Polys"]["connectivity"]] == list(range(ends[-1]))
    assert len(ends) == int(piece.get("NumberOfPolys")) == len(table) + sum(w for (w,) in cells["wall"])
    assert all(len(values) == len(ends) for values in cells.values())
    for k, grain in enumerate(table):
        points = sections["Points"]["points"][ends[k - 1] if k else 0 : ends[k]]
        x, y, size = float(grain["x"]), float(grain["y"]), float(grain["size"])
        # Corners are on the outline, chords at most size / 400 inside: so is the area, times the perimeter.
        area, full = area_of(points), math.pi / 4 * size * size
        assert full * (1 - 4.4 / 400) - 1e-5 <= area <= full + 1e-5, (area, full)
        if grain["shape"] == "disc":
            assert all(is_near(math.hypot(p[0] - x, p[1] - y), size / 2, 1e-5) for p in points)
        assert cells["id"][k] == (k,) and cells["coordination"][k] == (int(grain["contacts"]),)
        assert is_near(cells["velocity"][k][0], float(grain["vx"]), 1e-6 + 1e-6 * abs(float(grain["vx"])))
        assert is_near(cells["speed"][k][0], math.hypot(*cells["velocity"][k]), 1e-5)
        assert is_near(cells["size"][k][0], size, 1e-6)
        stress = cells["stress"][k]
        assert is_near(cells["pressure"][k][0], (stress[0] + stress[4]) / 2, 1e-4 * (1 + abs(stress[0]) + abs(stress[4])))
    return cells, len(table)


def check_contacts(path, cells, grain_count):
    piece, sections, _ = read_vtp(path)
    data = sections["PointData"]
    count = int(piece.get("NumberOfPoints"))
    assert count == int(piece.get("NumberOfVerts")) and all(len(values) == count for values in data.values())
    ends = [0] * len(cells["id"])
    for k in range(count):
        a, b = data["body_a"][k][0], data["body_b"][k][0]
        assert a < b and a < grain_count
        ends[a] += 1
        ends[b] += 1
        n, f = data["normal"][k], data["force"][k]
        assert is_near(math.hypot(n[0], n[1]), 1, 1e-5) and data["separation"][k][0] < 0
        assert is_near(f[0] * n[0] + f[1] * n[1], data["normal_force"][k][0], 1e-4 * (1 + math.hypot(f[0], f[1])))
        assert 0 <= data["mobilised_friction"][k][0] <= 1
        discs = [body for body, radius in ((a, "radius_a"), (b, "radius_b")) if cells["shape"][body] == (0,)]
        for body, radius in ((a, "radius_a"), (b, "radius_b")):
            if body in discs:
                assert is_near(data[radius][k][0], cells["size"][body][0] / 2, 1e-5)
            elif cells["wall"][body] == (1,):
                assert data[radius][k] == (-1,) or data[radius][k] == (0,)  # a plate is flat
    assert [(n,) for n in ends] == cells["coordination"]
    return count


def main(folder):
    os.chdir(folder)
    for name in "out", "out-contacts":
        sets = tree.parse(name + ".pvd").getroot().findall("Collection/DataSet")
        assert [item.get("file") for item in sets] == ["%s-%06d.vtp" % (name, k) for k in range(11)], name
        for item in sets:
            assert is_near(read_vtp(item.get("file"))[2], float(item.get("timestep")), 1e-12)
    contacts = 0
    for k in range(11):
        with open("out-%06d.csv" % k, encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        cells, grain_count = check_bodies("out-%06d.vtp" % k, table)
        contacts += check_contacts("out-contacts-%06d.vtp" % k, cells, grain_count)
    assert contacts > 100, contacts


main(sys.argv[1])
