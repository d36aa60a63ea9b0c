# SPDX-License-Identifier: MIT
"""python3 cases.py PROGRAM FOLDER [--sand SHAPES] [--jobs N] CASE ...: runs cases of apps/dem/README.md and tells what
they found; inputs, tables and pictures go to FOLDER. --small PROGRAM FOLDER CASE: a small version, which must be right.
--seed N, --seeds M: of places and sizes; bars are deviations over them.
CASE is one of the functions below: sand (with --sand), pile, packing, shear, hopper; or all."""
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
    def __init__(self, program, folder, small, sand, jobs, seed, seeds):
        self.program, self.folder = os.path.abspath(program), folder
        self.small, self.sand, self.seed = small, sand, seed
        self.seeds = range(seed, seed + (1 if small else seeds))
        self.pool = concurrent.futures.ThreadPoolExecutor(jobs)

    def bar(self, values):
        """The mean, and the deviation over seeds."""
        return "%.4f" % np.mean(values) + (" +- %.4f" % np.std(values, ddof=1) if len(values) > 1 else "")

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
        for kind in ".png", ".pdf":
            figure.savefig(os.path.join(self.folder, name + kind), dpi=110, bbox_inches="tight")


def find_frames(folder, case):
    return sorted(os.path.join(folder, name) for name in os.listdir(folder)
                  if re.fullmatch(case + r"-\d+\.csv", name))


# ----------------------------------------------------------------------------------------------- piles, cells


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
    means = []
    for begin in "disc", "long":
        both = []
        for cases.seed in cases.seeds:
            both += run_pile(cases, "pile-%s-%d" % (begin, cases.seed), SHAPES, begin)
        means.append(np.mean(both))
        cases.tell("pile of %s: angle of repose %s degrees, both sides of each" % (begin, cases.bar(both)))
    # 50 grains along the table tell it within some degrees.
    cases.tell("", 10 < means[0] < 27, 22 < means[1] < 45, means[1] > means[0] + 4)


def sand(cases):
    """A pile of fitted grains, and pictures of it."""
    cases.tell("sand: %.1f and %.1f degrees" % tuple(run_pile(cases, "pile", cases.sand, "")))
    if cases.small:
        return
    last = find_frames(os.path.join(cases.folder, "pile"), "pile")[-1].replace(".csv", ".vtk")
    grains.draw(last, os.path.join(cases.folder, "pile.png"), color="none", region=[-0.064, -0.006, 0.064, 0.034])
    grains.draw(last, os.path.join(cases.folder, "flow.png"), color="none", forces=False)


def run_cell(cases, name, change):
    """A periodic cell of discs of 0.7 to 1 that holds a stress of 1 (kn is 1000) with its own sides: no walls."""

    def begin(world):
        count = 300 if cases.small else 1000
        side = 1.15 * math.ceil(math.sqrt(count))
        world["boundary"].update(x=[0, side], y=[0, side])
        world["grains"][0].update(count=count, region=[0, 0, side, side])
        change(world)

    return cases.run("cell", name, begin)


def packing(cases):
    """Discs without friction are jammed by a small stress at 0.84 of the area (O'Hern and others 2003), with 4 contacts of a
    grain that bears."""

    def one(seed):
        cases.seed = seed

        def change(world):
            world["contact"]["friction"] = 0
            world["stages"] = [{"name": "press", "duration": 120 if cases.small else 600}]

        folder, world = run_cell(cases, "packing-%d" % seed, change)
        table = grains.read_table(os.path.join(folder, "cell.csv"))
        last = grains.read_table(find_frames(folder, "cell")[-1])
        share = np.sum(np.pi / 4 * last["size"] ** 2) / (table["width"][-1] * table["height"][-1])
        return share, last["bearing"][last["bearing"] > 0].mean()

    found = np.array([one(seed) for seed in cases.seeds])
    cases.tell("packing: %s of the area is discs (0.842, O'Hern 2003), %s contacts (4)"
               % tuple(map(cases.bar, found.T)), 0.82 < found[:, 0].mean() < 0.86, 3.7 < found[:, 1].mean() < 4.3)


def shear(cases):
    """Simple shear at constant pressure: the ratio of shear stress to pressure and the share of the area, over the inertial
    number I = rate d sqrt(density / pressure)."""

    def one(seed, friction, rate):
        cases.seed = seed

        def change(world):
            world["contact"]["friction"] = friction
            world["boundary"]["shear"] = 0
            time = (1 if cases.small else 2) / rate
            world["stages"] = [{"name": "press", "duration": 100}, {"name": "shear", "duration": time, "shear": rate,
                                                                   "strain": {"x": {"rate": 0}}}]

        folder, world = run_cell(cases, "shear-%g-%g-%d" % (friction, rate, seed), change)
        table = grains.read_table(os.path.join(folder, "cell.csv"))
        late = table["time"] > 100 + world["stages"][1]["duration"] / 2
        ratio = -0.5 * (table["stress_xy"] + table["stress_yx"]) / table["stress_yy"]
        return ratio[late].mean()

    rates = [0.03] if cases.small else [0.003, 0.01, 0.03, 0.1]
    means = {}
    for friction in 0, 0.5:
        found = np.array([[one(seed, friction, rate) for rate in rates] for seed in cases.seeds])
        means[friction] = found
        for rate, values in zip(rates, found.T):
            cases.tell("shear: friction %g, I %.3g: shear stress by pressure %s" % (friction, 0.85 * rate, cases.bar(values)))
    cases.tell("shear: da Cruz and others 2005 have 0.11 and 0.25 to 0.28 for small I", means[0].mean() < means[0.5].mean(),
               0.05 < means[0].mean() < 0.25, 0.2 < means[0.5].mean() < 0.45)
    if cases.small:
        return
    figure, axes = grains.open_plots().subplots(figsize=(5, 3.8))
    for friction, found in means.items():
        axes.errorbar(0.85 * np.array(rates), found.mean(0), found.std(0), fmt="o-", capsize=3, label="friction %g" % friction)
    axes.set(xlabel="inertial number I", ylabel="shear stress by pressure", xscale="log", ylim=(0, None))
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
    cases.save(figure, "shear")


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
    cases.save(figure, "hopper")


# ----------------------------------------------------------------------------------------------- the command


def main():
    known = {case.__name__: case for case in (sand, pile, packing, shear, hopper)}
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--sand", help="a file of fitted grains")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("cases", nargs="+", choices=list(known) + ["all"])
    options = parser.parse_args()
    cases = Cases(options.program, options.folder, options.small, options.sand, options.jobs, options.seed, options.seeds)
    for name in known if options.cases == ["all"] else options.cases:
        known[name](cases)


if __name__ == "__main__":
    main()
