# SPDX-License-Identifier: MIT
"""python3 cases.py PROGRAM FOLDER [--sand SHAPES] [--jobs N] CASE ...: runs cases of apps/dem/README.md and tells what
they found; inputs, tables and pictures go to FOLDER. --small PROGRAM FOLDER CASE: a small version, which must be right.
--lammps NARC_LAMMPS: LAMMPS runs them, by the inputs of apps/lammps/cases, from the grains that PROGRAM places.
--seed N: other places and sizes of grains than those of the inputs.
CASE is one of the functions below: rolling, collision, sand (with --sand), pile, biaxial, band, hopper,
packing, angularity, flow, drum; or all."""
import argparse
import concurrent.futures
import json
import math
import os
import re
import shutil
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
sys.dont_write_bytecode = True
LAMMPS_INPUTS = os.path.join(os.path.dirname(os.path.dirname(HERE)), "lammps", "cases")
import grains  # noqa: E402
import lammps_input  # noqa: E402

SHAPES = os.path.join(HERE, "shapes.json")


class Cases:
    def __init__(self, program, folder, small, sand, jobs, lammps, seed):
        self.program, self.folder = os.path.abspath(program), folder
        self.small, self.sand, self.seed = small, sand, seed
        self.lammps = lammps and os.path.abspath(lammps)
        self.pool = concurrent.futures.ThreadPoolExecutor(jobs)

    def run(self, case, name, change, shapes=SHAPES):
        """The case's input, changed, in a folder of its own, and run there. Returns the folder and the input."""
        folder = os.path.join(self.folder, name)
        os.makedirs(folder, exist_ok=True)
        shutil.copy(shapes, os.path.join(folder, "shapes.json"))
        with open(os.path.join(HERE, case + ".json"), encoding="utf-8") as file:
            world = json.load(file)
        world["seed"] = self.seed
        if self.small:
            world["output"].pop("vtk", None)
        change(world)
        with open(os.path.join(folder, case + ".json"), "w", encoding="utf-8") as file:
            json.dump(world, file, indent=1)
        command = [self.program, case + ".json", "--threads", "1"]
        if self.lammps:
            for old in find_frames(folder, case) + find_frames(folder, case + "-contacts"):
                os.remove(old)
            lammps_input.write_start(self.program, folder, case, world, grains.read_table)
            command = [self.lammps, "-in", os.path.join(LAMMPS_INPUTS, case + ".in"), "-log", "none",
                       "-var", "here", LAMMPS_INPUTS, "-var", "case", case]
        with open(os.path.join(folder, "report.txt"), "w", encoding="utf-8") as report:
            subprocess.run(command, cwd=folder, stdout=report, check=True, stderr=subprocess.DEVNULL)
        return folder, world

    def tell(self, text, *conditions):
        """What was found; a small case must fulfil all conditions."""
        print(text, flush=True)
        if self.small and not all(conditions):
            sys.exit("not as it should be: %s" % (conditions,))

    def save(self, figure, name):
        figure.tight_layout()
        figure.savefig(os.path.join(self.folder, name), dpi=110)


def find_frames(folder, case):
    return sorted(os.path.join(folder, name) for name in os.listdir(folder)
                  if re.fullmatch(case + r"-\d+\.(csv|dump)", name))


def read_frame(path, least=2):
    """Grains; those of LAMMPS as apps/dem has them. Who has fewer than `least` contacts is a rattler."""
    table = grains.read_table(path)
    if path.endswith(".csv"):
        return table
    start = grains.read_table(os.path.join(os.path.dirname(path), "start-000000.csv"))
    rows = grains.read_table("-contacts-".join(path.rsplit("-", 1)))
    table.update(spin=table["omegaz"], cell_y=table["iy"], size=start["size"], shape=start["shape"])
    ends = np.zeros((0, 2), int)
    if rows:
        columns = [rows["c_contacts[%d]" % (k + 1)] for k in range(9)]
        push = columns[4] * columns[6] + columns[5] * columns[7]
        ends = np.maximum(np.transpose(columns[:2]).astype(int)[push > 0] - 1, -1)
    return {**table, "bearing": grains.find_bearing(len(table["x"]), ends, least)}


def read_outlines(path, table):
    if path.endswith(".csv"):
        return grains.read_vtk(path.replace(".csv", ".vtk"))
    folder = os.path.dirname(path)
    meshes = {name: grains.read_mesh(os.path.join(folder, "form.%s.obj" % name)) for name in set(table["shape"])}
    return grains.make_frame(table, [meshes[name] for name in table["shape"]])


# ----------------------------------------------------------------------------------------------- a slope


def rolling(cases):
    """Accelerations along a slope and of the rims, of discs and of the same circle as eight arcs, over the second half
    of the time; theory: below a third of tan(angle) friction is too weak, and the grain slides."""

    def change(world):
        for grain in world["grains"][0]["grains"]:
            grain["shape"] = shape
        if cases.small:
            world["stages"][0]["duration"] = 4

    found, speeds = [], {}
    for shape in "disc", "round":
        folder, world = cases.run("rolling", "rolling-" + shape, change)
        tables = [read_frame(path) for path in find_frames(folder, "rolling")]
        speeds[shape] = np.array([table["vx"] for table in tables])
        rims = np.array([-table["spin"] * table["size"] / 2 for table in tables])
        half, every = (len(tables) - 1) // 2, world["output"]["every"]
        for values in speeds[shape], rims:
            found.append((values[-1] - values[half]) / (every * (len(tables) - 1 - half)))
    down, across = world["gravity"]
    mu = np.array([pair["friction"] for pair in world["contact"]["pairs"]])

    def theory(mu):
        slides = -mu * across < down / 3
        return slides, np.where(slides, down + mu * across, down * 2 / 3), np.where(slides, -2 * mu * across,
                                                                                    down * 2 / 3)

    slides, along, rim = theory(mu)
    errors = np.max([abs(found[k] - (along, rim)[k % 2]) / along for k in range(4)], axis=0)
    same = np.sum((found[0] - found[2]) ** 2 + (found[1] - found[3]) ** 2)
    cases.tell("rolling: largest error, rolling %.1e, sliding %.1e" % (errors[~slides].max(), errors[slides].max()),
               len(mu) == 10, 0 < errors[~slides].max() < 5e-4, errors[slides].max() < 5e-4, same <= 1e-8)
    if cases.small:
        return
    pyplot = grains.open_plots()
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.8))
    time = every * np.arange(len(speeds["disc"]))
    for k, name in (0, "no friction"), (2, "0.1: slides"), (4, "0.18: slides"), (8, "0.4: rolls"):
        line = left.plot(time, along[k] * time)[0]
        left.plot(time, speeds["disc"][:, k], "o", color=line.get_color(), label="friction " + name)
    left.set(xlabel="time", ylabel="speed")
    left.legend()
    fine = np.linspace(0, 0.52, 1000)
    right.plot(fine, theory(fine)[1], color="#999999")
    right.plot(fine, theory(fine)[2], "--", color="#999999")
    for values, mark, name in zip(found, ("o", "o", "s", "s"), ("disc", "its rim", "eight arcs", "their rim")):
        right.plot(mu, values, mark, fillstyle="full" if mark == "o" else "none",
                   markersize=5 if mark == "o" else 9, label=name)
    right.set(xlabel="friction", ylabel="acceleration / gravity")
    right.legend()
    cases.save(figure, "rolling.png")


# ----------------------------------------------------------------------------------------------- collisions

YOUNG = 20000


def find_step(law, speed, steps):
    """For an elastic collision. Linear: it lasts pi sqrt(m / kn). Hertz: 2.943275 times the depth over the speed, the
    depth being (5 m v^2 / (4 k))^(2/5) with k = 4/3 E* sqrt(R)."""
    m, k = math.pi / 8, 4 / 3 * YOUNG / 2 * math.sqrt(1 / 4)
    time = 2.943275 * (5 * m * speed**2 / (4 * k)) ** 0.4 / speed if law == "hertz" else math.pi * math.sqrt(m / 1000)
    return time / steps


def collide(cases, law, speed, steps, restitution=None, oblique=False):
    """The tables of grains before and after, and that of measures."""

    def change(world):
        world["time_step"] = find_step(law, speed, steps)
        world["stages"][0]["duration"] = world["output"]["every"] = 0.4 / speed
        for grain in world["grains"][0]["grains"]:
            if "velocity" in grain:
                grain["velocity"] = [speed, 0.4 if oblique else 0]
        if law == "hertz":
            world["contact"]["law"] = world["contact"].pop("kn") and law
            for material in world["materials"]:
                material.update(young=YOUNG, poisson=0)
        if oblique:
            world["contact"]["friction"] = 0.5
        for pair in world["contact"]["pairs"]:
            pair["restitution"] = restitution or pair["restitution"]

    folder, world = cases.run("collision", "collision", change)
    tables = [read_frame(path) for path in find_frames(folder, "collision")]
    given = np.array([pair["restitution"] for pair in world["contact"]["pairs"]])
    after = tables[1]["vx"]
    measures = {} if cases.lammps else grains.read_table(os.path.join(folder, "collision.csv"))
    return given, (after[1::2] - after[::2]) / speed, tables, measures


def collision(cases):
    """Restitutions with 100 steps a contact; the order of their errors; what an oblique collision conserves."""
    given, linear = collide(cases, "linear", 1, 100)[:2]
    hertz, slow = collide(cases, "hertz", 1, 100)[1], collide(cases, "hertz", 0.1, 100)[1]
    largest = max(abs(found - given).max() for found in (linear, hertz, slow))
    numbers = [20, 80] if cases.small else [10, 20, 40, 80, 160, 320, 640]
    kinds = [(law, wanted) for law in ("linear", "hertz") for wanted in (1, 0.5)]
    errors = np.array([[math.sqrt(np.mean((collide(cases, law, 1, steps, wanted)[1] - wanted) ** 2))
                        for law, wanted in kinds] for steps in numbers])
    tables, table = collide(cases, "linear", 1, 100, oblique=True)[2:]
    pairs = 1 + np.arange(len(given))

    def conserve(values):
        return np.add.reduceat(values, np.arange(0, len(values), 2))

    # A disc's moment of inertia is m size^2 / 8. The table has nine digits.
    before, after = [{"x": conserve(t["mass"] * t["vx"]), "y": conserve(t["mass"] * t["vy"]),
                      "turn": conserve(t["mass"] * (t["x"] * t["vy"] - t["y"] * t["vx"] + t["size"] ** 2 / 8
                                                    * t["spin"]))} for t in tables]
    momentum = max((abs(after[k] - before[k]) / before["x"]).max() for k in "xy")
    turn = (abs(after["turn"] - before["turn"]) / (1 + 3 * pairs)).max()
    energy = math.nan  # LAMMPS does not tell what dashpots and friction take
    if table:
        total = table["kinetic"] + table["elastic"] + table["damping"] + table["friction"]
        energy = abs(total[1] / total[0] - 1)
    ratios = errors[0] / errors[-1]
    # With four times as many steps the error of damped collisions is a quarter, that of undamped ones a 64th.
    cases.tell("collision: restitution off by %.4f, momentum by %.0e, angular momentum by %.0e, energy by %.0e"
               % (largest, momentum, turn, energy), largest < 0.01, momentum < 1e-8,
               cases.lammps or (turn < 1e-8 and energy < 2e-3),  # LAMMPS has friction at two depths, no sum of losses
               30 < ratios[0] < 120, 2 < ratios[1] < 8, 20 < ratios[2] < 120, 2 < ratios[3] < 12)
    if cases.small:
        return
    pyplot = grains.open_plots()
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.8))
    left.plot([0, 1], [0, 1], color="#999999")
    for found, mark, name in (linear, "o", "linear"), (hertz, "s", "Hertz"), (slow, "x", "Hertz, a tenth of the speed"):
        left.plot(given, found, mark, fillstyle="none", label=name)
    left.set(xlabel="restitution that is given", ylabel="restitution that is found")
    left.legend()
    right.loglog(numbers, 0.3 / np.array(numbers), color="#999999", label="first order")
    right.loglog(numbers, 1.4 / np.array(numbers) ** 3.0, "--", color="#999999", label="third order")
    for (law, wanted), values, mark in zip(kinds, errors.T, "soxd"):
        right.loglog(numbers, values, mark, label="%s, %g" % (law, wanted))
    right.set(xlabel="steps a contact", ylabel="error of restitution, root mean square")
    right.legend(ncol=2)
    cases.save(figure, "collision.png")


# ----------------------------------------------------------------------------------------------- piles, biaxial tests


def names_of(shapes, begin):
    with open(shapes, encoding="utf-8") as file:
        return [shape["name"] for shape in json.load(file)["shapes"] if shape["name"].startswith(begin)]


def run_pile(cases, name, shapes, begin):
    def change(world):
        filling, walls = world["grains"][0], {wall["name"]: wall for wall in world["walls"]}
        filling["shapes"] = names_of(shapes, begin)
        if begin == "long":  # they need more room before they fall
            filling.update(spacing=[0.0016, 0.0016], region=[-0.060, 0.0005, 0.060, 0.160], jitter=0.05)
        if not cases.small:
            return
        filling.update(count=1100, region=[-0.025, 0.0005, 0.025, 0.150], spacing=[0.0016, 0.0016], jitter=0.02)
        walls["table"]["box"]["width"] = 0.050
        for side, sign in ("left", -1), ("right", 1):
            walls[side + "_edge"]["at"][0], walls[side + "_gate"]["at"][0] = sign * 0.0255, sign * 0.027
            walls[side]["plate"]["point"][0] = sign * 0.070
        world["contact"]["kn"], world["time_step"], world["max_overlap"] = 50, 2e-5, 0.3
        for stage, duration in zip(world["stages"], (0.25, 0.13, 0.6, 0.2)):
            stage["duration"] = duration

    folder, world = cases.run("pile", name, change, shapes)
    width = next(wall["box"]["width"] for wall in world["walls"] if wall["name"] == "table")
    last = read_frame(find_frames(folder, "pile")[-1])
    return grains.find_repose(last["x"], last["y"], last["size"] / 2, width / 2)


def pile(cases):
    """Angles of repose. The flanks of discs, which roll, are less steep than those of long grains, which do not."""
    kinds = [("pile-disc", SHAPES, "disc"), ("pile-long", SHAPES, "long")]
    angles = list(cases.pool.map(lambda kind: run_pile(cases, *kind), kinds))
    means = [np.mean(both) for both in angles]
    # 50 grains along the table tell it within some degrees.
    cases.tell("\n".join("%s: %.1f and %.1f degrees, mean %.1f" % (kind[0], both[0], both[1], np.mean(both))
                         for kind, both in zip(kinds, angles)),
               10 < means[0] < 27, 22 < means[1] < 45, means[1] > means[0] + 4)


def sand(cases):
    """A pile of fitted grains, and pictures of it."""
    cases.tell("sand: %.1f and %.1f degrees" % tuple(run_pile(cases, "pile", cases.sand, "")))
    if cases.small or cases.lammps:
        return
    last = find_frames(os.path.join(cases.folder, "pile"), "pile")[-1].replace(".csv", ".vtk")
    grains.draw(last, os.path.join(cases.folder, "pile.png"), color="none", region=[-0.064, -0.006, 0.064, 0.034])
    grains.draw(last, os.path.join(cases.folder, "flow.png"), color="none", forces=False)


def run_biaxial(cases, name, shapes, begin, friction, count=1250):
    """Contacts of a grain that is no rattler and the share of rattlers before shear; strains and stresses from there;
    the angle of friction, over the last third: its sine is (s_yy - s_xx) / (s_yy + s_xx)."""

    def change(world):
        filling, walls = world["grains"][0], {wall["name"]: wall for wall in world["walls"]}
        filling["shapes"], world["contact"]["friction"] = names_of(shapes, begin), friction
        smaller = math.sqrt((289 if cases.small else count) / 5000)
        if smaller == 1:
            return
        half = 57 * smaller + 1
        filling.update(count=289 if cases.small else count, region=[-half, -half, half, half])
        for wall in walls.values():
            wall["plate"]["point"] = [math.copysign(half, x) if x else 0 for x in wall["plate"]["point"]]
            if "servo" in wall:
                wall["servo"]["gain"] /= smaller
        world["stages"][0]["duration"], world["output"]["every"] = 40 * round(15 * smaller + 1), 5
        world["stages"][1]["walls"]["top"]["velocity"] = [0, -0.01 * smaller]
        world["stages"][1]["duration"] = 250 if cases.small else 500

    folder, world = cases.run("biaxial", name, change, shapes)
    pressed, table = world["stages"][0]["duration"], grains.read_table(os.path.join(folder, "biaxial.csv"))
    start = int(np.argmin(abs(table["time"] - pressed)))
    if min(table["stress_xx"][start], table["stress_yy"][start]) < 0.9:
        sys.exit("biaxial: the first stage ends before the stress is there")
    bearing = read_frame(find_frames(folder, "biaxial")[round(pressed / world["output"]["every"])],
                         2 if friction > 0 else 3)["bearing"]
    # A plate's place is the middle of its block, so distances of plates count from those at the start, which are known.
    size = 2 * next(wall["plate"]["point"][0] for wall in world["walls"] if wall["name"] == "right")
    wide, high = [size + (table[b] - table[a]) - (table[b][0] - table[a][0])
                  for a, b in (("left_x", "right_x"), ("bottom_y", "top_y"))]
    strain = 1 - high[start:] / high[start]
    loss = 1 - (wide * high)[start:] / (wide * high)[start]
    xx, yy = table["stress_xx"][start:], table["stress_yy"][start:]
    sine = (yy - xx) / (yy + xx)
    angle = math.degrees(math.asin(sine[strain > strain[-1] * 2 / 3].mean()))
    return bearing[bearing > 0].mean(), np.mean(bearing == 0), angle, strain, sine, loss


def biaxial(cases):
    """Discs without friction carry a load with 4 contacts each in the limit of small overlaps, counting those with
    walls once, so a little less in a small box; with friction it is between 3 and 4. Their angle of friction is 5 to 6
    degrees, and 15 to 20 with friction of 0.5; 289 of them tell it within 5."""
    kinds = [("biaxial-smooth", SHAPES, "disc", 0), ("biaxial-disc", SHAPES, "disc", 0.5)]
    kinds += [("biaxial-sand", cases.sand, "", 0.5)] if cases.sand else []
    found = list(cases.pool.map(lambda kind: run_biaxial(cases, *kind), kinds))
    smooth, rough = found[:2]
    cases.tell("\n".join("%s: contacts %.3f, rattlers %.3f, angle of friction %.1f" % ((kind[0],) + one[:3])
                         for kind, one in zip(kinds, found)),
               3.7 < smooth[0] < 4.2, smooth[1] < 0.15, smooth[2] < 11, 3 < rough[0] < 3.6, 10 < rough[2] < 25,
               rough[2] > smooth[2] + 3)
    if cases.small:
        return
    pyplot = grains.open_plots()
    figure, both = pyplot.subplots(1, 2, figsize=(9, 3.8))
    for kind, one in zip(kinds, found):
        for axes, values in zip(both, (one[4], 100 * one[5])):
            axes.plot(100 * one[3], values, label="%s, friction %g" % (kind[2] or "sand", kind[3]))
    for axes, label in zip(both, ("sine of the angle of friction", "loss of area, %")):
        axes.set(xlabel="strain, %", ylabel=label)
        axes.legend()
    cases.save(figure, "biaxial.png")
    if cases.sand and not cases.lammps:
        last = find_frames(os.path.join(cases.folder, "biaxial-sand"), "biaxial")[-1].replace(".csv", ".vtk")
        grains.draw(last, os.path.join(cases.folder, "forces.png"), color="coordination", width=6,
                    region=[-22, -22, -6, -12.7])


def band(cases):
    """A larger biaxial test, of grains that interlock: it fails along bands."""
    shapes, begin = (cases.sand, "") if cases.sand else (SHAPES, "square")
    cases.tell("band: angle of friction %.1f" % run_biaxial(cases, "band", shapes, begin, 0.5, 5000)[2])
    frames = find_frames(os.path.join(cases.folder, "band"), "biaxial")
    grains.draw_strain(frames[70], frames[-1], os.path.join(cases.folder, "band.png"))


# ----------------------------------------------------------------------------------------------- shapes


def make_ellipse(aspect, quarter=4):
    """An ellipse as arcs that turn alike, each as long as the ellipse's between the same normals."""
    a, b, angles = math.sqrt(aspect), 1 / math.sqrt(aspect), np.linspace(0, 2 * math.pi, 4 * quarter + 1)
    arcs, at = [], np.array([a, 0.0])
    for start, end in zip(angles, angles[1:]):
        turn = start + (end - start) * (np.arange(1000) + 0.5) / 1000
        radius = np.mean((a * b) ** 2 / ((a * np.cos(turn)) ** 2 + (b * np.sin(turn)) ** 2) ** 1.5)
        center = at - radius * np.array([math.cos(start), math.sin(start)])
        arcs.append({"center": list(center), "radius": radius, "start": start, "end": end})
        at = center + radius * np.array([math.cos(end), math.sin(end)])
    return {"arcs": arcs}


def make_polygon(sides):
    angles = 2 * math.pi * np.arange(sides) / sides
    return {"polygon": np.transpose([np.cos(angles), np.sin(angles)]).tolist()}


def write_shapes(cases, name, shapes):
    path = os.path.join(cases.folder, name + ".json")
    os.makedirs(cases.folder, exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"shapes": shapes}, file)
    return path


def run_packing(cases, name, shapes):
    """The share of the area, contacts of a grain that is no rattler, and the share of rattlers: five grains from walls
    on."""

    def change(world):
        world["grains"][0]["shapes"] = [name]
        if not cases.small:
            return
        world["grains"][0].update(count=400, region=[0, 0, 40, 40])
        for wall in world["walls"][1::2]:
            wall["plate"]["point"] = [40 if x else 0 for x in wall["plate"]["point"]]
        world["stages"][0]["duration"], world["stages"][1]["duration"] = 95, 220
        for change in world["stages"][1]["walls"].values():
            change["servo"]["gain"] *= 35 / 20
        world["output"]["vtk"] = "packing"

    folder, _ = cases.run("packing", "packing-" + name, change, shapes)
    last = find_frames(folder, "packing")[-1]
    stress = grains.read_table(os.path.join(folder, "packing.csv"))
    table = read_frame(last, 3)
    frame = read_outlines(last, table)
    high = np.array([table["x"].max(), table["y"].max()]) - 4.5
    fraction = grains.find_packing_fraction(frame, [5, 5, *high])
    within = (table["x"] > 5) & (table["x"] < high[0]) & (table["y"] > 5) & (table["y"] < high[1])
    bearing = table["bearing"][within]
    return fraction, bearing[bearing > 0].mean(), np.mean(bearing == 0), stress["stress_xx"][-1], stress["kinetic"][-1]


def packing(cases):
    """Packings of ellipses and dimers without friction. Discs have 4 contacts in the limit of small overlaps; what
    turns has at most 6 then, if none is more than stability takes; ellipses fewer, dimers those."""
    aspects = [1, 2] if cases.small else [1, 1.1, 1.2, 1.4, 1.7, 2, 3]
    away = {"dimer-1.25": 0.25, "dimer-1.5": 0.5, "dimer-2": 1}
    shapes = [{"name": "ellipse-%g" % aspect, **make_ellipse(aspect)} for aspect in aspects]
    shapes += [{"name": "%s/%d" % (name, 1 + (x > 0)), "circle": 1, "origin": [x, 0]}
               for name, half in away.items() for x in (-half, half)]
    names = ["ellipse-%g" % aspect for aspect in aspects] + (["dimer-1.5"] if cases.small else list(away))
    path = write_shapes(cases, "shapes-packing", shapes)
    found = list(cases.pool.map(lambda name: run_packing(cases, name, path), names))
    cases.tell("\n".join("%s: fraction %.3f, contacts %.2f, rattlers %.3f (stress %.2f, kinetic %.1g)" % ((name,) + one)
                         for name, one in zip(names, found)),
               all(abs(one[3] - 1) < 0.1 for one in found), 0.82 < found[0][0] < 0.87, 3.7 < found[0][1] < 4.3,
               4.9 < found[1][1] < 6.1, 5.2 < found[2][1] < 6.3, found[1][0] > found[0][0])


def angularity(cases):
    """The angle of friction of regular polygons, between 5 and 7 % of strain."""
    sides = [4, 5, 6, 8, 12]
    shapes = [{"name": "polygon-%d" % n, **make_polygon(n)} for n in sides] + [{"name": "disc", "circle": 1}]
    path = write_shapes(cases, "shapes-angularity", shapes)
    names = [shape["name"] for shape in shapes]
    found = list(cases.pool.map(lambda name: run_biaxial(cases, "biaxial-" + name, path, name, 0.5), names))
    cases.tell("\n".join("%s: contacts %.3f, rattlers %.3f, angle of friction %.1f" % ((name,) + one[:3])
                         for name, one in zip(names, found)), found[2][2] > found[5][2] + 4)


# ----------------------------------------------------------------------------------------------- flows


def run_flow(cases, share):
    """Of a sheared cell that grains fill to a share: inertial number, and shear stress over pressure with its error."""

    def change(world):
        side = math.sqrt(400 * math.pi / 4 * (1 + 0.4**2 / 12) / share)
        world["boundary"].update(x=[0, side], y=[0, side])
        world["grains"][0].update(region=[0, 0, side, side], spacing=[side / 20.0001, side / 20.0001])
        world["stages"][0]["duration"] = 6 if cases.small else 12

    folder, _ = cases.run("flow", "flow-%g" % share, change)
    table = grains.read_table(os.path.join(folder, "flow.csv"))
    late = table["time"] > 2
    pressure = 0.5 * (table["stress_xx"] + table["stress_yy"])[late]
    shear = -0.5 * (table["stress_xy"] + table["stress_yx"])[late]
    return 1 / math.sqrt(pressure.mean()), shear.mean() / pressure.mean(), grains.average(shear)[1] / pressure.mean()


def flow(cases):
    """Friction of a flow over its inertial number, rate * size * sqrt(density / pressure): more for faster ones."""
    shares = [0.7, 0.79] if cases.small else [0.65, 0.7, 0.74, 0.77, 0.79, 0.8]
    found = list(cases.pool.map(lambda share: run_flow(cases, share), shares))
    cases.tell("\n".join("flow: share %.2f, inertial number %.4f, friction %.3f +- %.3f" % ((share,) + one)
                         for share, one in zip(shares, found)),
               found[0][0] > found[1][0] > 0, 0.2 < found[1][1] < found[0][1] < 0.9)


def drum(cases):
    """Fitted grains in a drum: how far they are carried up, and a picture."""

    def change(world):
        radius, count = 19, 24
        for k in range(count):
            angle = 2 * math.pi * k / count
            world["walls"].append({
                "name": "side%d" % k, "material": "grain", "box": {"width": 1, "height": 2 * math.pi * radius / count},
                "at": [radius * math.cos(angle), radius * math.sin(angle)], "angle": angle, "pivot": [0, 0],
                "spin": 0.05})
        world["grains"][0]["shapes"] = names_of(cases.sand, "") if cases.sand else ["square"]

    folder, _ = cases.run("drum", "drum", change, cases.sand or SHAPES)
    tilts = []
    for path in find_frames(folder, "drum")[5:]:
        table = read_frame(path)
        tilts.append(math.degrees(math.atan2(np.sum(table["mass"] * table["x"]), -np.sum(table["mass"] * table["y"]))))
    cases.tell("drum: the centre of mass is %.1f degrees from the lowest point" % np.mean(tilts))
    if cases.lammps:
        return
    grains.draw(find_frames(folder, "drum")[-1].replace(".csv", ".vtk"), os.path.join(cases.folder, "drum.png"),
                color="speed", forces=False, width=6, top=1.5)


# ----------------------------------------------------------------------------------------------- hoppers


def run_hopper(cases, kind, opening):
    """The mass that crosses the periodic border below the opening in a unit of time, over the last two thirds."""

    def change(world):
        walls = {wall["name"]: wall for wall in world["walls"]}
        walls["left_bottom"]["at"][0], walls["right_bottom"]["at"][0] = -10.5 - opening / 2, 10.5 + opening / 2
        world["grains"][0]["shapes"] = [kind]
        if kind == "long":  # they need more room before they fall
            world["grains"][0].update(count=1400, spacing=[1.5, 1.5])
        if not cases.small:
            return
        walls["left"]["plate"]["point"][0], walls["right"]["plate"]["point"][0] = -16, 16
        walls["lid"]["box"]["width"], walls["lid"]["at"][1] = 15, 52
        world["grains"][0].update(count=800, region=[-15.5, 4.6, 15.5, 48])
        world["contact"]["kn"], world["time_step"], world["max_overlap"] = 5000, 0.0014, 0.3
        world["stages"][0]["duration"], world["output"]["every"] = 90, 1

    folder, world = cases.run("hopper", "hopper-%s-%g" % (kind, opening), change)
    frames = find_frames(folder, "hopper")
    last, first = len(frames) - 1, (len(frames) - 1) // 3
    tables = [read_frame(frames[k]) for k in (first, last)]
    passed = [-np.sum(table["mass"] * table["cell_y"]) for table in tables]
    return (passed[1] - passed[0]) / (world["output"]["every"] * (last - first))


def hopper(cases):
    """Beverloo's law in two dimensions, W = c (D - k d)^(3/2): W^(2/3) is a line over D. And the slope of log W over
    log(D - 1.4 d), with the k that Beverloo found."""
    kinds = {"disc": [5, 6.5, 8.5]} if cases.small else {"disc": [6, 8, 10, 13], "long": [6, 8, 10, 13, 16]}
    runs = {kind: [cases.pool.submit(run_hopper, cases, kind, opening) for opening in openings]
            for kind, openings in kinds.items()}
    figure, axes = (None, None) if cases.small else grains.open_plots().subplots(figsize=(5, 3.8))
    for kind, openings in kinds.items():
        flow, openings = np.array([run.result() for run in runs[kind]]), np.array(openings)
        cases.tell("hopper, %s: %s" % (kind, ", ".join("%g: %.2f" % both for both in zip(openings, flow))))
        flow, openings = flow[flow > 0], openings[flow > 0]  # long grains close an opening of 6 with an arch
        slope, height = np.polyfit(openings, flow ** (2 / 3), 1)
        k = -height / slope
        scatter = abs(flow / (slope * (openings - k)) ** 1.5 - 1).max()
        exponent = np.polyfit(np.log(openings - 1.4), np.log(flow), 1)[0]
        cases.tell("hopper, %s: k %.2f, c %.3f, scatter %.3f, exponent with k = 1.4: %.2f"
                   % (kind, k, slope**1.5, scatter, exponent), 0 < k < 2.5, scatter < 0.15, 1.25 < exponent < 1.75)
        if axes:
            axes.plot([k, 20], [0, slope * (20 - k)], color="#999999")
            axes.plot(openings, flow ** (2 / 3), "o", label="%s: %.2f (D - %.2f)" % (kind, slope, k))
    if not axes:
        return
    axes.set(xlabel="opening, grains", ylabel="flow^(2/3)", xlim=(0, 20), ylim=(0, None))
    axes.legend()
    cases.save(figure, "hopper.png")


# ----------------------------------------------------------------------------------------------- the command


def main():
    known = {case.__name__: case for case in (rolling, collision, sand, pile, biaxial, band, hopper, packing,
                                              angularity, flow, drum)}
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--sand", help="a file of fitted grains")
    parser.add_argument("--lammps", help="runs the cases in the place of the program")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("cases", nargs="+", choices=list(known) + ["all"])
    options = parser.parse_args()
    cases = Cases(options.program, options.folder, options.small, options.sand, options.jobs, options.lammps,
                  options.seed)
    for name in known if options.cases == ["all"] else options.cases:
        known[name](cases)


if __name__ == "__main__":
    main()
