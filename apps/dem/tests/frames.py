# SPDX-License-Identifier: MIT
"""python3 frames.py DEM: files for ParaView and tables of grains of a run that was interrupted are checked against each
other and closed forms; so are measures and pictures of ../grains.py."""
import json
import math
import os
import subprocess
import sys
import tempfile

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import grains  # noqa: E402

SHAPES = {"shapes": [{"name": "disc", "circle": 1}, {"name": "brick", "box": {"width": 2, "height": 1, "radius": 0.2}},
                     {"name": "dimer/1", "circle": 0.5, "origin": [-0.4, 0]},
                     {"name": "dimer/2", "circle": 0.5, "origin": [0.4, 0]}]}
WORLD = {
    "materials": [{"name": "sand", "density": 1000}],
    "shapes": "shapes.json",
    "grains": [{"place": "lattice", "region": [0, 1, 6.8, 7.8], "spacing": [0.68, 0.68], "jitter": 0.2,
                "shapes": ["disc", "brick", "dimer"], "size": {"uniform": [0.3, 0.45]}, "material": "sand"}],
    "walls": [
        {"name": "floor", "material": "sand", "plate": {"point": [0, 0], "normal": [0, 1]}},
        {"name": "slope", "material": "sand", "plate": {"point": [-0.2, 0], "normal": [2, 1]}},
        {"name": "block", "material": "sand", "box": {"width": 0.5, "height": 0.5}, "at": [7.2, 0.5], "angle": 0.3}],
    "gravity": [0, -9.81],
    "contact": {"law": "linear", "kn": 4e7, "restitution": 0.5, "friction": 0.5},
    "time_step": 1e-4, "skin": 0.1,
    "stages": [{"duration": 0.6}, {"duration": 0.4}],
    "output": {"every": 0.1, "csv": "table.csv", "grains": "out.csv", "vtk": "out", "restart": "out.restart"},
}


def run(dem, durations, *options, **output):
    with open("in.json", "w", encoding="utf-8") as file:
        stages = [{"duration": d} for d in durations]
        json.dump(dict(WORLD, stages=stages, output=dict(WORLD["output"], **output)), file)
    return subprocess.run([dem, "in.json", "--threads", "1", *options], capture_output=True, check=False, text=True)


def area_of(points):
    after = np.roll(points, -1, 0)
    return np.sum(points[:, 0] * after[:, 1] - after[:, 0] * points[:, 1]) / 2


def check_bodies(path, table):
    frame = grains.read_vtk(path)
    cells, outlines = frame["fields"], frame["cells"]
    count = len(table["x"])
    body, scale = cells["id"], table["scale"]
    assert list(np.concatenate(outlines)) == list(range(len(frame["points"])))
    assert all(len(values) == len(outlines) for values in cells.values()) and np.all(np.diff(body) >= 0)
    assert np.array_equal(np.unique(body), np.arange(count + 3)) and np.array_equal(cells["wall"], body >= count)
    for i, k in enumerate(body[body < count]):
        points = frame["points"][outlines[i]]
        if table["shape"][k] == "dimer":  # their polygons are circles whose places are known
            away = 0.4 * scale[k] * (-1 if i == 0 or body[i - 1] != k else 1)
            angle = table["angle"][k]
            centre = cells["centre"][i, :2] + away * np.array([math.cos(angle), math.sin(angle)])
            assert np.allclose(np.hypot(*(points - centre).T), 0.5 * scale[k], atol=1e-5)
            continue
        # Corners are on the outline, chords at most size / 400 inside: so is the area, times the perimeter.
        area, full = area_of(points), math.pi / 4 * table["size"][k] ** 2
        assert full * (1 - 4.4 / 400) - 1e-5 <= area <= full + 1e-5, (area, full)
        if table["shape"][k] == "disc":
            assert np.allclose(np.hypot(*(points - cells["centre"][i, :2]).T), table["size"][k] / 2, atol=1e-5)
    assert np.sum(table["shape"] == "dimer") > 10
    stress = cells["stress"]
    assert np.allclose(cells["pressure"], (stress[:, 0] + stress[:, 4]) / 2, rtol=1e-4,
                       atol=1e-4 * (1 + abs(stress).max()))
    cells = {name: values[np.unique(body, return_index=True)[1]] for name, values in cells.items()}
    assert np.array_equal(cells["coordination"][:count], table["contacts"])
    for name, columns in ("velocity", ("vx", "vy")), ("centre", ("x", "y")):
        assert np.allclose(cells[name][:count, :2], np.transpose([table[c] for c in columns]), rtol=1e-6, atol=1e-6)
    assert np.allclose(cells["speed"], np.hypot(*cells["velocity"][:, :2].T), atol=1e-5)
    assert np.allclose(cells["size"][:count], table["size"], atol=1e-6)
    return cells, count


def check_contacts(path, cells, count):
    frame = grains.read_vtk(path)
    data = frame["fields"]
    a, b, n, f = (data[name] for name in ("body_a", "body_b", "normal", "force"))
    assert len(frame["points"]) == len(frame["cells"]) and all(len(v) == len(frame["points"]) for v in data.values())
    assert np.all(a < b) and np.all(a < count) and np.all(data["overlap"] > 0)
    assert np.array_equal(np.bincount(np.append(a, b).astype(int), minlength=len(cells["id"])), cells["coordination"])
    assert np.allclose(np.hypot(*n[:, :2].T), 1, atol=1e-5)
    assert np.allclose(np.sum(f * n, 1), data["normal_force"], rtol=1e-4, atol=1e-4)
    assert np.all((data["mobilised_friction"] >= 0) & (data["mobilised_friction"] <= 1))
    return len(a)


def check_measures():
    """A fabric whose anisotropy is known, forces that are exponential, a wedge."""
    random = np.random.default_rng(1)
    angle = random.uniform(0, 2 * math.pi, 400000)
    angle = angle[random.uniform(0, 1.5, len(angle)) < 1 + 0.5 * np.cos(2 * (angle - 0.4))]
    fabric, anisotropy, principal = grains.find_fabric(np.transpose([np.cos(angle), np.sin(angle)]))
    assert abs(np.trace(fabric) - 1) < 1e-12 and abs(anisotropy - 0.5) < 0.02
    assert abs(principal - math.degrees(0.4)) < 1
    force, density = grains.find_force_distribution(random.exponential(3, 400000))
    assert np.allclose(density, np.exp(-force), rtol=0.05)
    x = np.linspace(-1, 1, 4001)
    left, right = grains.find_repose(x, np.where(x < 0, 1 + 0.5 * x, 1 - 0.25 * x), 0 * x, 1)
    assert abs(left - math.degrees(math.atan(0.5))) < 1 and abs(right - math.degrees(math.atan(0.25))) < 1


def check_lammps():
    with open("dump", "w", encoding="utf-8") as file:
        for y in 1, 2:
            file.write("ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n1\n" % y)
            file.write("ITEM: ATOMS id x y radius\n7 0.5 %d 0.25\n" % y)
    with open("contacts", "w", encoding="utf-8") as file:
        file.write("ITEM: ENTRIES index %s\n1 7 -1 0 0 0.6 0.8 3 4 0.1\n"
                   % " ".join("c_contacts[%d]" % (k + 1) for k in range(9)))
    assert [list(v[0]) for v in grains.read_contacts("contacts")[:1]] == [[0.6, 0.8]]
    assert list(grains.read_contacts("contacts")[1]) == [5]
    assert [list(v) for v in grains.load_grains("dump")] == [[0.5], [2], [0.25]]


def main(dem):
    dem = os.path.abspath(dem)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("shapes.json", "w", encoding="utf-8") as file:
            json.dump(SHAPES, file)
        # As if it had been interrupted after frame 6, and another run, given up, had left frames up to 7.
        assert run(dem, [0.7]).returncode == 0 and os.path.exists("out-contacts-000007.vtk")
        assert run(dem, [0.6]).returncode == 0
        assert run(dem, [0.6, 0.4], "--restart", "out.restart").returncode == 0
        contacts = 0
        for k in range(11):
            cells, count = check_bodies("out-%06d.vtk" % k, grains.read_table("out-%06d.csv" % k))
            contacts += check_contacts("out-contacts-%06d.vtk" % k, cells, count)
            for name in "out", "out-contacts":
                assert abs(grains.read_vtk("%s-%06d.vtk" % (name, k))["time"] - 0.1 * k) < 1e-9
        assert contacts > 100, contacts
        bad = run(dem, [0.6], vtk="none/out")
        assert bad.returncode == 2 and "none/out-000000.vtk" in bad.stderr, bad.stderr
        check_measures()
        check_lammps()
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            return
        # A path for each body, and lines for contacts that bear.
        grains.draw("out-000010.vtk", "drawn.svg", color="coordination")
        with open("drawn.svg", encoding="utf-8") as file:
            svg = file.read()
        assert svg.count("<path") > 83 + 20, svg.count("<path")


main(sys.argv[1])
