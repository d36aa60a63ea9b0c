# SPDX-License-Identifier: MIT
"""python3 cases.py PROGRAM FOLDER [--sand SHAPES] [--jobs N] CASE ...: runs cases of apps/dem/README.md and tells what
they found; inputs, tables and pictures go to FOLDER. --small PROGRAM FOLDER CASE: a small version, which must be right.
--seed N: other places and sizes of grains than those of the inputs.
CASE is one of the functions below: sand (with --sand), pile, biaxial, hopper; or all."""
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
import grains  # noqa: E402

SHAPES = os.path.join(HERE, "shapes.json")


class Cases:
    def __init__(self, program, folder, small, sand, jobs, seed):
        self.program, self.folder = os.path.abspath(program), folder
        self.small, self.sand, self.seed = small, sand, seed
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
        with open(os.path.join(folder, "report.txt"), "w", encoding="utf-8") as report:
            subprocess.run([self.program, case + ".json", "--threads", "1"], cwd=folder, stdout=report, check=True,
                           stderr=subprocess.DEVNULL)
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
                  if re.fullmatch(case + r"-\d+\.csv", name))


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
    last = grains.read_table(find_frames(folder, "pile")[-1])
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
    if cases.small:
        return
    last = find_frames(os.path.join(cases.folder, "pile"), "pile")[-1].replace(".csv", ".vtk")
    grains.draw(last, os.path.join(cases.folder, "pile.png"), color="none", region=[-0.064, -0.006, 0.064, 0.034])
    grains.draw(last, os.path.join(cases.folder, "flow.png"), color="none", forces=False)


def run_biaxial(cases, name, shapes, begin, friction):
    """Contacts of a grain that is no rattler and the share of rattlers before shear; strains and stresses from there;
    the angle of friction, over the last third: its sine is (s_yy - s_xx) / (s_yy + s_xx)."""

    def change(world):
        filling, walls = world["grains"][0], {wall["name"]: wall for wall in world["walls"]}
        filling["shapes"], world["contact"]["friction"] = names_of(shapes, begin), friction
        count = 289 if cases.small else 1250
        smaller = math.sqrt(count / 5000)
        half = 57 * smaller + 1
        filling.update(count=count, region=[-half, -half, half, half])
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
    bearing = grains.read_table(find_frames(folder, "biaxial")[round(pressed / world["output"]["every"])],
                         )["bearing"]
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
    if cases.sand:
        last = find_frames(os.path.join(cases.folder, "biaxial-sand"), "biaxial")[-1].replace(".csv", ".vtk")
        grains.draw(last, os.path.join(cases.folder, "forces.png"), color="coordination", width=6,
                    region=[-22, -22, -6, -12.7])


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
    tables = [grains.read_table(frames[k]) for k in (first, last)]
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
    known = {case.__name__: case for case in (sand, pile, biaxial, hopper)}
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--sand", help="a file of fitted grains")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("cases", nargs="+", choices=list(known) + ["all"])
    options = parser.parse_args()
    cases = Cases(options.program, options.folder, options.small, options.sand, options.jobs, options.seed)
    for name in known if options.cases == ["all"] else options.cases:
        known[name](cases)


if __name__ == "__main__":
    main()
