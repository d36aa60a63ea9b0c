# SPDX-License-Identifier: MIT
"""python3 frames.py FOLDER: reads the files for ParaView that frames.sh made, and checks what they say against each
other, the table of grains and closed forms."""
import csv
import math
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from draw import read_vtk  # noqa: E402


def area_of(points):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1])) / 2


def is_near(a, b, tolerance):
    return abs(a - b) <= tolerance


def check_bodies(path, table):
    frame = read_vtk(path)
    cells, outlines = frame["fields"], frame["cells"]
    assert [i for outline in outlines for i in outline] == list(range(len(frame["points"])))
    assert len(outlines) == len(table) + sum(w for (w,) in cells["wall"])
    assert len(cells) == 12 and all(len(values) == len(outlines) for values in cells.values())
    for k, grain in enumerate(table):
        points = [frame["points"][i] for i in outlines[k]]
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
    frame = read_vtk(path)
    data, count = frame["fields"], len(frame["points"])
    assert count == len(frame["cells"]) and all(len(values) == count for values in data.values())
    ends = [0] * len(cells["id"])
    for k in range(count):
        a, b = data["body_a"][k][0], data["body_b"][k][0]
        assert a < b and a < grain_count
        ends[a] += 1
        ends[b] += 1
        n, f = data["normal"][k], data["force"][k]
        assert is_near(math.hypot(n[0], n[1]), 1, 1e-5) and data["overlap"][k][0] > 0
        assert is_near(f[0] * n[0] + f[1] * n[1], data["normal_force"][k][0], 1e-4 * (1 + math.hypot(f[0], f[1])))
        assert 0 <= data["mobilised_friction"][k][0] <= 1
    assert [(n,) for n in ends] == cells["coordination"]
    return count


def main(folder):
    os.chdir(folder)
    for name in "out", "out-contacts":
        for k in range(11):
            assert is_near(read_vtk("%s-%06d.vtk" % (name, k))["time"], 0.1 * k, 1e-9)
    contacts = 0
    for k in range(11):
        with open("out-%06d.csv" % k, encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        cells, grain_count = check_bodies("out-%06d.vtk" % k, table)
        contacts += check_contacts("out-contacts-%06d.vtk" % k, cells, grain_count)
    assert contacts > 100, contacts


main(sys.argv[1])
