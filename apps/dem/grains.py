# SPDX-License-Identifier: MIT
"""Measures and pictures of grains, of what apps/dem and LAMMPS write. Needs NumPy, and matplotlib for pictures.

  python3 grains.py draw FRAME.vtk PICTURE [--color FIELD|none] [--top VALUE] [--no-forces]
                    [--region LOW_X LOW_Y HIGH_X HIGH_Y] [--width INCHES]
  python3 grains.py strain BEFORE AFTER PICTURE [--top VALUE]    shear strain between two frames of grains: bands
  python3 grains.py contacts CONTACTS ...        fabric, anisotropy, distribution of forces
  python3 grains.py average TABLE [--from TIME]  means of the columns, and how well they are known
  python3 grains.py repose GRAINS --half WIDTH   angle of repose on a table that wide on either side

TABLE is apps/dem's table of measures or a log of LAMMPS, GRAINS apps/dem's table of grains or a dump of LAMMPS, CONTACTS
apps/dem's .vtk or a dump of LAMMPS' compute narc/contact with the ID contacts; of a dump the last frame counts. A
picture has the kind that its name ends in: .png, .svg, .pdf."""
import argparse
import math

import numpy as np

# ----------------------------------------------------------------------------------------------- files


def read_vtk(path):
    """A file of VTK's old binary format: time, title, points, cells as lists of indices, fields by name."""
    with open(path, "rb") as file:
        data = file.read()
    at, out = 0, {"cells": [], "fields": {}}

    def line():
        nonlocal at
        end = data.index(b"\n", at)
        text, at = data[at:end].decode(), end + 1
        return text

    def numbers(count, kind):
        nonlocal at
        values = np.frombuffer(data, np.dtype({"float": ">f4", "double": ">f8", "int": ">i4"}[kind]), count, at)
        at += values.nbytes
        return values.astype(int if kind == "int" else float)

    assert line() == "# vtk DataFile Version 3.0"
    out["title"] = line()
    assert line() == "BINARY" and line() == "DATASET POLYDATA"
    while at < len(data):
        words = line().split()
        if not words or words[0] in ("FIELD", "CELL_DATA", "POINT_DATA"):
            continue
        if words[0] == "POINTS":
            out["points"] = numbers(3 * int(words[1]), "float").reshape(-1, 3)[:, :2]
        elif words[0] in ("POLYGONS", "VERTICES"):
            values, i = numbers(int(words[2]), "int"), 0
            while i < len(values):
                out["cells"].append(values[i + 1 : i + 1 + values[i]])
                i += 1 + values[i]
            assert len(out["cells"]) == int(words[1])
        else:
            width, count = int(words[1]), int(words[2])
            values = numbers(width * count, words[3])
            out["fields"][words[0]] = values.reshape(count, width) if width > 1 else values
    out["time"] = out["fields"].pop("TimeValue")[0]
    return out


def make_columns(head, rows):
    """Columns by name: numbers where all are."""
    out = {}
    for name, values in zip(head, zip(*rows)):
        try:
            out[name] = np.array(values, float)
        except ValueError:
            out[name] = np.array(values)
    return out


def read_table(path):
    """A table of apps/dem; the tables of a log of LAMMPS, one after the other; the last frame of a dump."""
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    if lines[0].startswith("ITEM:"):
        start = max(i for i, line in enumerate(lines) if line.startswith(("ITEM: ATOMS", "ITEM: ENTRIES")))
        return make_columns(lines[start].split()[2:], [line.split() for line in lines[start + 1 :] if line])
    if lines[0].startswith("LAMMPS"):
        head, rows, inside = [], [], False
        for words in map(str.split, lines):
            if words[:1] == ["Step"]:
                head, inside = words, True
            elif words[:1] == ["Loop"]:
                inside = False
            elif inside and len(words) == len(head):
                rows.append(words)
        return make_columns(head, rows)
    return make_columns(lines[0].split(","), [line.split(",") for line in lines[1:] if line])


# ----------------------------------------------------------------------------------------------- measures


def find_fabric(normals):
    """The fabric tensor, the mean of n n over contacts, and its anisotropy: in two dimensions the density of contact
    directions is (1 + a cos 2 (angle - principal)) / (2 pi), whose a is twice the difference of principal values."""
    fabric = normals.T @ normals / len(normals)
    values, vectors = np.linalg.eigh(fabric)
    return fabric, 2 * (values[1] - values[0]), math.degrees(math.atan2(vectors[1, 1], vectors[0, 1])) % 180


def find_bearing(count, ends, least):
    """Contacts of each of so many grains, by pairs of indices (below 0: a wall), without rattlers: who has fewer than
    `least` is taken away until all are held."""
    held = np.ones(count + 1, bool)  # the last one is for walls
    while True:
        both = ends[held[ends].all(1)]
        number = np.bincount(both[both >= 0], minlength=count)
        fall = held[:-1] & (number < least)
        if not fall.any():
            return np.where(held[:-1], number, 0)
        held[:-1] &= ~fall


def find_force_distribution(forces, bins=12, highest=4):
    """The density of forces over their mean, in bins; the last one's beginning is `highest`."""
    edges = np.linspace(0, highest, bins + 1)
    counts, _ = np.histogram(forces / forces.mean(), edges)
    return 0.5 * (edges[1:] + edges[:-1]), counts / (len(forces) * np.diff(edges))


def average(values, blocks=8):
    """The mean, and its standard error by the means of blocks, which are longer than what is correlated."""
    means = [block.mean() for block in np.array_split(values, min(blocks, len(values)))]
    return values.mean(), np.std(means, ddof=1) / math.sqrt(len(means)) if len(means) > 1 else math.nan


def find_repose(x, y, radius, half):
    """Angles of the left and the right flank: the surface is the highest point of each of 40 strips, and a line is
    fitted to it from 15 % off the middle to 15 % off the edge."""
    on = (y > 0) & (abs(x) < half)
    strip, angles = half / 20, []
    index, top = ((x[on] + half) / strip).astype(int), (y + radius)[on]
    for sign in -1, 1:
        flank = [(sign * ((k + 0.5) * strip - half), top[index == k].max()) for k in set(index)]
        flank = np.array([p for p in flank if 0.15 * half <= p[0] <= 0.85 * half])
        angles.append(math.degrees(math.atan(-np.polyfit(flank[:, 0], flank[:, 1], 1)[0])) if len(flank) > 2 else 0.0)
    return angles


def find_packing_fraction(frame, region, rows=800):
    """The share of a region, low x, low y, high x, high y, that grains cover, by a raster of so many rows."""
    low_x, low_y, high_x, high_y = region
    step = (high_y - low_y) / rows
    covered = np.zeros((rows, round((high_x - low_x) / step)), bool)
    for cell, wall in zip(frame["cells"], frame["fields"]["wall"]):
        corners = (frame["points"][cell] - (low_x, low_y)) / step
        (left, down), (right, up) = np.maximum(corners.min(0), 0).astype(int), corners.max(0).astype(int) + 1
        x, y = np.meshgrid(np.arange(left, min(right, covered.shape[1])) + 0.5, np.arange(down, min(up, rows)) + 0.5)
        if wall or x.size == 0:
            continue
        inside = np.ones(x.shape, bool)
        for a, b in zip(corners, np.roll(corners, -1, 0)):  # a part is convex
            inside &= (b[0] - a[0]) * (y - a[1]) >= (b[1] - a[1]) * (x - a[0])
        covered[down:up, left:right] |= inside
    return covered.mean()


def read_mesh(path):
    """The polygons of a form that fix narc/shapes of LAMMPS has drawn, as lists of corners."""
    with open(path, encoding="utf-8") as file:
        lines = [line.split() for line in file]
    corners = np.array([line[1:3] for line in lines if line[0] == "v"], float)
    return [corners[np.array(line[1:], int) - 1] for line in lines if line[0] == "f"]


def make_frame(table, meshes):
    """Grains of a dump of LAMMPS as read_vtk() has them, by the mesh of each."""
    points, cells, count = [], [], 0
    for x, y, radius, angle, mesh in zip(table["x"], table["y"], table["radius"], table["c_picture[1]"], meshes):
        turn = radius * np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        for polygon in mesh:
            points.append(polygon @ turn + (x, y))
            cells.append(count + np.arange(len(polygon)))
            count += len(polygon)
    return {"points": np.concatenate(points), "cells": cells, "fields": {"wall": np.zeros(len(cells))}}


def load_grains(path):
    """Places and radii, of discs of equal area or as LAMMPS has them."""
    table = read_table(path)
    return table["x"], table["y"], table["radius"] if "radius" in table else table["size"] / 2


# ----------------------------------------------------------------------------------------------- pictures


def open_plots():
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    pyplot.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
                            "grid.color": "#cccccc", "grid.linewidth": 0.5, "legend.frameon": False,
                            "axes.prop_cycle": pyplot.cycler(color=["#0072b2", "#d55e00", "#009e73", "#cc79a7"])})
    return pyplot


def find_lines(frame, contacts, centres, size):
    """From centre to contact to centre, but for walls and across borders; and how wide, by the force."""
    ends, force = contacts["fields"], np.linalg.norm(contacts["fields"]["force"], axis=1)
    most = np.sort(force)[-1 - len(force) // 50] if len(force) else 1
    lines, widths = [], []
    for k, point in enumerate(contacts["points"]):
        near = [centres[e] for e in (ends["body_a"][k], ends["body_b"][k])
                if e in centres and np.hypot(*(centres[e] - point)) < 4 * size]
        if near and force[k] > 0:
            lines.append([near[0], point] + near[1:])
            widths.append(0.25 * size * min(force[k] / most, 2))
    return lines, np.array(widths)


def draw(path, out, color="speed", top=None, region=None, width=8, forces=True, dpi=110):
    """Grains in colours for a field, walls grey, forces as lines."""
    pyplot = open_plots()
    from matplotlib.collections import LineCollection, PolyCollection

    frame = read_vtk(path)
    fields, points = frame["fields"], frame["points"]
    outlines, is_grain = [points[cell] for cell in frame["cells"]], fields["wall"] == 0
    low_x, low_y, high_x, high_y = region or (*points.min(0), *points.max(0))
    figure = pyplot.figure(figsize=(width, width * (high_y - low_y) / (high_x - low_x)))
    axes = figure.add_axes([0, 0, 1, 1], xlim=(low_x, high_x), ylim=(low_y, high_y), aspect="equal")
    axes.axis("off")
    grains = [outline for outline, grain in zip(outlines, is_grain) if grain]
    axes.add_collection(PolyCollection([o for o, g in zip(outlines, is_grain) if not g], facecolors="#aaaaaa"))
    patches = PolyCollection(grains, edgecolors="#666666", linewidths=0.3, facecolors="#c6dbef")
    if color != "none":
        values = fields[color][is_grain].astype(float)
        patches.set(array=values, cmap="YlOrRd", clim=(0, top or values.max() or 1))
        patches.set_facecolors(None)
    axes.add_collection(patches)
    if forces:
        centres = {body: fields["centre"][k, :2] for k, body in enumerate(fields["id"]) if is_grain[k]}
        lines, widths = find_lines(frame, read_vtk("-contacts-".join(path.rsplit("-", 1))), centres,
                                   fields["size"][is_grain].max())
        points_by_length = 72 * width / (high_x - low_x)
        axes.add_collection(LineCollection(lines, colors="black", linewidths=widths * points_by_length,
                                           capstyle="round"))
    figure.savefig(out, dpi=dpi)
    pyplot.close(figure)


def find_strain(before, after, triangles):
    """Of each triangle of points how much longer it has become one way than across: the logarithm of the ratio of its
    principal stretches."""
    sides = [points[triangles[:, 1:]] - points[triangles[:, :1]] for points in (before, after)]
    stretches = np.linalg.svd(np.linalg.solve(*sides), compute_uv=False)
    return np.log(stretches[:, 0] / stretches[:, 1])


def draw_strain(before, after, out, top=None, width=6, dpi=110):
    """Shear strain between grains' centres, a mean around each grain. Triangles along the rim that are much longer
    than others are left out."""
    pyplot = open_plots()
    from matplotlib.tri import Triangulation

    tables = [read_table(path) for path in (before, after)]
    places = [np.transpose([table["x"], table["y"]]) for table in tables]
    triangles = Triangulation(*places[0].T).triangles
    sides = np.linalg.norm(places[0][triangles] - places[0][np.roll(triangles, 1, axis=1)], axis=2).max(axis=1)
    triangles = triangles[sides < 3 * np.median(sides)]
    strain, count = find_strain(*places, triangles), len(places[0])
    sums, around = [np.bincount(triangles.ravel(), np.repeat(w, 3), count) for w in (strain, np.ones(len(strain)))]
    means = sums / np.maximum(around, 1)
    (low_x, low_y), (high_x, high_y) = places[1].min(0), places[1].max(0)
    figure = pyplot.figure(figsize=(width, width * (high_y - low_y) / (high_x - low_x)))
    axes = figure.add_axes([0, 0, 1, 1], xlim=(low_x, high_x), ylim=(low_y, high_y), aspect="equal")
    axes.axis("off")
    axes.tripcolor(Triangulation(*places[1].T, triangles), means, shading="gouraud", cmap="YlOrRd",
                   clim=(0, top or np.quantile(means, 0.98)))
    figure.savefig(out, dpi=dpi)
    pyplot.close(figure)


# ----------------------------------------------------------------------------------------------- the command


def print_contacts(paths):
    for path in paths:
        if path.endswith(".vtk"):
            fields = read_vtk(path)["fields"]
            normals, forces, mobilised = fields["normal"][:, :2], fields["normal_force"], fields["mobilised_friction"]
        else:
            table = read_table(path)
            normals, force = [np.transpose([table["c_contacts[%d]" % (k + i)] for i in (0, 1)]) for k in (5, 7)]
            forces, mobilised = np.sum(normals * force, axis=1), None
        fabric, anisotropy, principal = find_fabric(normals)
        print("%s: %d contacts" % (path, len(normals)))
        print("fabric %.4f %.4f %.4f, anisotropy %.4f along %.1f degrees"
              % (fabric[0, 0], fabric[0, 1], fabric[1, 1], anisotropy, principal))
        if mobilised is not None:
            print("mobilised friction %.4f" % mobilised.mean())
        for force, density in zip(*find_force_distribution(forces)):
            print("force / mean %.3f density %.4f" % (force, density))


def print_averages(path, start):
    table = read_table(path)
    time = table["time"] if "time" in table else table["Step"]
    for name, values in table.items():
        print("%s %.6g +- %.2g" % ((name,) + average(values[time >= start])))


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("draw")
    one.add_argument("path")
    one.add_argument("out")
    one.add_argument("--color", default="speed")
    one.add_argument("--top", type=float)
    one.add_argument("--region", type=float, nargs=4)
    one.add_argument("--width", type=float, default=8)
    one.add_argument("--no-forces", dest="forces", action="store_false")
    one = commands.add_parser("strain")
    one.add_argument("before")
    one.add_argument("after")
    one.add_argument("out")
    one.add_argument("--top", type=float)
    commands.add_parser("contacts").add_argument("paths", nargs="+")
    one = commands.add_parser("average")
    one.add_argument("table")
    one.add_argument("--from", dest="start", type=float, default=-math.inf)
    one = commands.add_parser("repose")
    one.add_argument("grains")
    one.add_argument("--half", type=float, required=True)
    options = vars(parser.parse_args())
    command = options.pop("command")
    if command == "draw":
        draw(**options)
    elif command == "strain":
        draw_strain(**options)
    elif command == "contacts":
        print_contacts(options["paths"])
    elif command == "average":
        print_averages(options["table"], options["start"])
    else:
        print("%.1f %.1f degrees" % tuple(find_repose(*load_grains(options["grains"]), options["half"])))


if __name__ == "__main__":
    main()
