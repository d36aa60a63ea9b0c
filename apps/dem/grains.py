# SPDX-License-Identifier: MIT
"""Measures and pictures of grains, of what apps/dem and LAMMPS write. Needs NumPy, and matplotlib for pictures.

  python3 grains.py draw FRAME.vtk PICTURE [--color FIELD|none] [--top VALUE] [--no-forces]
                    [--region LOW_X LOW_Y HIGH_X HIGH_Y] [--width INCHES] [--unit NAME]
  python3 grains.py contacts CONTACTS ...        fabric, anisotropy, distribution of forces
  python3 grains.py repose GRAINS --half WIDTH   angle of repose on a table that wide on either side

GRAINS is apps/dem's table of grains or a dump of LAMMPS, CONTACTS apps/dem's .vtk or a dump of LAMMPS' compute
narc/contact with the ID contacts; of a dump the last frame counts. A picture has the kind that its name ends in: .png,
.svg, .pdf."""
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
    """A table of apps/dem; the last frame of a dump of LAMMPS."""
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    if lines[0].startswith("ITEM:"):
        start = max(i for i, line in enumerate(lines) if line.startswith(("ITEM: ATOMS", "ITEM: ENTRIES")))
        return make_columns(lines[start].split()[2:], [line.split() for line in lines[start + 1 :] if line])
    return make_columns(lines[0].split(","), [line.split(",") for line in lines[1:] if line])


# ----------------------------------------------------------------------------------------------- measures


def find_fabric(normals):
    """The fabric tensor, the mean of n n over contacts, and its anisotropy: in two dimensions the density of contact
    directions is (1 + a cos 2 (angle - principal)) / (2 pi), whose a is twice the difference of principal values."""
    fabric = normals.T @ normals / len(normals)
    values, vectors = np.linalg.eigh(fabric)
    return fabric, 2 * (values[1] - values[0]), math.degrees(math.atan2(vectors[1, 1], vectors[0, 1])) % 180


def find_force_distribution(forces, bins=12, highest=4):
    """The density of forces over their mean, in bins; the last one's beginning is `highest`."""
    edges = np.linspace(0, highest, bins + 1)
    counts, _ = np.histogram(forces / forces.mean(), edges)
    return 0.5 * (edges[1:] + edges[:-1]), counts / (len(forces) * np.diff(edges))


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


def find_ruler(width):
    """A round length, a fourth to a tenth of the width."""
    decade = 10 ** math.floor(math.log10(width / 4))
    return max(step * decade for step in (1, 2, 5) if step * decade <= width / 4)


def draw(path, out, color="speed", top=None, region=None, width=8, forces=True, dpi=110, unit=""):
    """Grains in colours for a field, walls grey, forces as lines; below them a ruler and what the colours mean."""
    pyplot = open_plots()
    from matplotlib.collections import LineCollection, PolyCollection

    frame = read_vtk(path)
    fields, points = frame["fields"], frame["points"]
    outlines, is_grain = [points[cell] for cell in frame["cells"]], fields["wall"] == 0
    low_x, low_y, high_x, high_y = region or (*points.min(0), *points.max(0))
    strip, height = 0.55, width * (high_y - low_y) / (high_x - low_x)
    pyplot.rcParams["axes.grid"] = False
    figure = pyplot.figure(figsize=(width, height + strip))
    below = strip / (height + strip)
    axes = figure.add_axes([0, below, 1, 1 - below], xlim=(low_x, high_x), ylim=(low_y, high_y), aspect="equal")
    axes.axis("off")
    ruler = find_ruler(high_x - low_x)
    right = 0.97 - ruler / (high_x - low_x)
    bar = figure.add_axes([right, 0.75 * below, 0.97 - right, 0.02 * below], xticks=[], yticks=[], facecolor="black")
    bar.set_xlabel(("%g " + unit) % ruler)
    grains = [outline for outline, grain in zip(outlines, is_grain) if grain]
    axes.add_collection(PolyCollection([o for o, g in zip(outlines, is_grain) if not g], facecolors="#aaaaaa"))
    patches = PolyCollection(grains, edgecolors="#666666", linewidths=0.3, facecolors="#c6dbef")
    if color != "none":
        values = fields[color][is_grain].astype(float)
        top = top or np.quantile(values, 0.99) or values.max() or 1  # a few grains alone are not worth all colours
        patches.set(array=values, cmap="YlOrRd", clim=(0, top))
        patches.set_facecolors(None)
        figure.colorbar(patches, cax=figure.add_axes([0.03, 0.75 * below, 0.4, 0.15 * below]), orientation="horizontal",
                        label=color, extend="max" if values.max() > top else "neither")
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


# ----------------------------------------------------------------------------------------------- the command


def read_contacts(path):
    """Normals, forces along them, and the share of friction that is mobilised, which LAMMPS does not tell."""
    if path.endswith(".vtk"):
        fields = read_vtk(path)["fields"]
        return fields["normal"][:, :2], fields["normal_force"], fields["mobilised_friction"]
    table = read_table(path)
    normals, forces = [np.transpose([table["c_contacts[%d]" % (k + i)] for i in (0, 1)]) for k in (5, 7)]
    return normals, np.sum(normals * forces, axis=1), None


def print_contacts(paths):
    for path in paths:
        normals, forces, mobilised = read_contacts(path)
        fabric, anisotropy, principal = find_fabric(normals)
        print("%s: %d contacts" % (path, len(normals)))
        print("fabric %.4f %.4f %.4f, anisotropy %.4f along %.1f degrees"
              % (fabric[0, 0], fabric[0, 1], fabric[1, 1], anisotropy, principal))
        if mobilised is not None:
            print("mobilised friction %.4f" % mobilised.mean())
        for force, density in zip(*find_force_distribution(forces)):
            print("force / mean %.3f density %.4f" % (force, density))


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
    one.add_argument("--unit", default="")
    one.add_argument("--no-forces", dest="forces", action="store_false")
    commands.add_parser("contacts").add_argument("paths", nargs="+")
    one = commands.add_parser("repose")
    one.add_argument("grains")
    one.add_argument("--half", type=float, required=True)
    options = vars(parser.parse_args())
    command = options.pop("command")
    if command == "draw":
        draw(**options)
    elif command == "contacts":
        print_contacts(options["paths"])
    else:
        print("%.1f %.1f degrees" % tuple(find_repose(*load_grains(options["grains"]), options["half"])))


if __name__ == "__main__":
    main()
