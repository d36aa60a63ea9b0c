# SPDX-License-Identifier: MIT
"""python3 cases.py PROGRAM FOLDER [--sand SHAPES] [--jobs N] [--seeds M] CASE ...: runs cases of apps/dem/README.md and
tells what they found; inputs, tables and pictures go to FOLDER. Bars are deviations over seeds of places and sizes.
--small: one seed and fewer points, which must be right. CASE is a function below: sand (with --sand), pile, gas, packing,
shear, hopper; or all."""
import argparse
import concurrent.futures
import json
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
    def __init__(self, options):
        self.program, self.folder = os.path.abspath(options.program), options.folder
        self.small, self.sand = options.small, options.sand
        self.seeds = range(1, 2 if options.small else 1 + options.seeds)
        self.pool = concurrent.futures.ThreadPoolExecutor(options.jobs)

    def run(self, case, name, seed, change, shapes=SHAPES):
        """The case's input, changed, in a folder of its own, and run there. Returns the folder and the input."""
        folder = os.path.join(self.folder, name)
        os.makedirs(folder, exist_ok=True)
        shutil.copy(shapes, os.path.join(folder, "shapes.json"))
        with open(os.path.join(HERE, case + ".json"), encoding="utf-8") as file:
            world = json.load(file)
        world["seed"] = seed
        change(world)
        with open(os.path.join(folder, case + ".json"), "w", encoding="utf-8") as file:
            json.dump(world, file, indent=1)
        with open(os.path.join(folder, "report.txt"), "w", encoding="utf-8") as report:
            subprocess.run([self.program, case + ".json", "--threads", "1"], cwd=folder, stdout=report, check=True,
                           stderr=subprocess.DEVNULL)
        return folder, world

    def over(self, one, values=(None,)):
        """one(seed, value) of all seeds and values: an array with a row for each seed."""
        jobs = [[self.pool.submit(one, seed, value) for value in values] for seed in self.seeds]
        return np.array([[job.result() for job in row] for row in jobs])

    def tell(self, text, *conditions):
        """What was found; a small case must fulfil all conditions."""
        print(text, flush=True)
        if self.small and not all(conditions):
            sys.exit("not as it should be: %s" % (conditions,))

    def save(self, figure, name):
        for kind in ".png", ".pdf":
            figure.savefig(os.path.join(self.folder, name + kind), dpi=110, bbox_inches="tight")


def bar(values):
    """The mean, and the deviation over seeds."""
    return "%.4g" % np.mean(values) + (" +- %.2g" % np.std(values, ddof=1) if len(values) > 1 else "")


def open_axes(**names):
    axes = grains.open_plots().subplots(figsize=(4.5, 3.4))[1]
    axes.set(**names)
    return axes


def draw_bars(axes, x, found, **style):
    axes.errorbar(x, found.mean(0), found.std(0, ddof=1) if len(found) > 1 else None, fmt="o", capsize=3, **style)


def find_frames(folder, case):
    return sorted(os.path.join(folder, name) for name in os.listdir(folder)
                  if re.fullmatch(case + r"-\d+\.csv", name))


# ----------------------------------------------------------------------------------------------- piles


def run_pile(cases, name, seed, shapes, begin):
    def change(world):
        filling, walls = world["grains"][0], {wall["name"]: wall for wall in world["walls"]}
        with open(shapes, encoding="utf-8") as file:
            names = [shape["name"] for shape in json.load(file)["shapes"]]
        filling["shapes"] = [shape for shape in names if shape.startswith(begin)]
        if not begin:
            return
        del world["output"]["vtk"]
        filling.update(count=1100, region=[-0.025, 0.0005, 0.025, 0.150], spacing=[0.0016, 0.0016], jitter=0.02)
        walls["table"]["box"]["width"] = 0.050
        for side, sign in ("left", -1), ("right", 1):
            walls[side + "_edge"]["at"][0], walls[side + "_gate"]["at"][0] = sign * 0.0255, sign * 0.027
            walls[side]["plate"]["point"][0] = sign * 0.070
        world["contact"]["kn"], world["time_step"], world["max_overlap"] = 50, 2e-5, 0.3
        for stage, duration in zip(world["stages"], (0.25, 0.13, 0.6, 0.2)):
            stage["duration"] = duration

    folder, world = cases.run("pile", name, seed, change, shapes)
    width = next(wall["box"]["width"] for wall in world["walls"] if wall["name"] == "table")
    last = grains.read_table(find_frames(folder, "pile")[-1])
    return np.mean(grains.find_repose(last["x"], last["y"], last["size"] / 2, width / 2))


def pile(cases):
    """Angles of repose. The flanks of discs, which roll, are less steep than those of long grains, which do not."""
    found = cases.over(lambda seed, begin: run_pile(cases, "pile-%s-%d" % (begin, seed), seed, SHAPES, begin),
                       ("disc", "long"))
    cases.tell("pile: angle of repose of discs %s degrees, of capsules 2:1 %s" % tuple(map(bar, found.T)))
    # 50 grains along the table tell it within some degrees.
    disc, long = found.mean(0)
    cases.tell("", 10 < disc < 27, 22 < long < 45, long > disc + 4)


def sand(cases):
    """A pile of fitted grains, and pictures of it."""
    cases.tell("sand: angle of repose %.1f degrees" % run_pile(cases, "pile", 1, cases.sand, ""))
    last = find_frames(os.path.join(cases.folder, "pile"), "pile")[-1].replace(".csv", ".vtk")
    for kind in ".png", ".pdf":
        grains.draw(last, os.path.join(cases.folder, "pile" + kind), color="pressure", unit="m",
                    region=[-0.064, -0.006, 0.064, 0.034])


# ----------------------------------------------------------------------------------------------- cells


def gas(cases):
    """Haff's law: without forces from outside the energy of a gas of restitution e falls as (1 + t / tau)^-2. It is that
    about the common velocity, which stays; and while the gas is even: later vortices, which a larger cell has sooner, lose
    less. So it is looked at from some collisions of each grain on until it is down to 3 %."""

    def one(seed, _):
        def change(world):
            side = 60
            world["boundary"] = {"x": [0, side], "y": [0, side]}
            world["contact"].update(restitution=0.8, friction=0)
            world["grains"][0].update(region=[0, 0, side, side], spacing=[2.6, 2.6], speed=1)
            world["stages"][0].update(name="cool", duration=200)

        folder, _ = cases.run("cell", "gas-%d" % seed, seed, change)
        energies = []
        for frame in find_frames(folder, "cell"):
            table = grains.read_table(frame)
            energies.append(sum(np.cov(table[v], aweights=table["mass"], ddof=0) for v in ("vx", "vy")))
        return grains.read_table(os.path.join(folder, "cell.csv"))["time"], np.array(energies) / energies[0]

    found = cases.over(one)[:, 0]
    time, energies, exponents = found[0, 0], found[:, 1], []
    late = time >= 10
    for energy in energies[:, late]:  # the tau with which the power law fits best
        fits = [np.polyfit(np.log(1 + time[late] / tau), np.log(energy), 1, full=True)[:2]
                for tau in np.geomspace(5, 500, 200)]
        exponents.append(-min(fits, key=lambda fit: fit[1][0])[0][0])
    cases.tell("gas: energy falls with the power %s of time (2, Haff 1983)" % bar(exponents), 1.6 < np.mean(exponents) < 2.4)
    if not cases.small:
        axes = open_axes(xlabel="time", ylabel="(energy at the start / energy)^(1/2)")
        line = np.polyfit(time[late], np.mean(energies[:, late] ** -0.5, 0), 1)
        axes.plot(time, np.polyval(line, time), color="#999999", linewidth=1)
        draw_bars(axes, time[::5], energies[:, ::5] ** -0.5, markersize=3)
        cases.save(axes.figure, "gas")


def packing(cases):
    """Discs without friction are jammed by a small stress at 0.84 of the area (O'Hern and others 2003), with 4 contacts of a
    grain that bears."""

    def one(seed, _):
        folder, _ = cases.run("cell", "packing-%d" % seed, seed, lambda world: world["contact"].update(friction=0))
        table = grains.read_table(os.path.join(folder, "cell.csv"))
        last = grains.read_table(find_frames(folder, "cell")[-1])
        share = np.sum(np.pi / 4 * last["size"] ** 2) / (table["width"][-1] * table["height"][-1])
        return share, last["bearing"][last["bearing"] > 0].mean()

    found = cases.over(one)[:, 0]
    cases.tell("packing: %s of the area is discs (0.842, O'Hern 2003), %s contacts (4)" % tuple(map(bar, found.T)),
               0.82 < found[:, 0].mean() < 0.86, 3.7 < found[:, 1].mean() < 4.3)


def shear(cases):
    """Simple shear at constant pressure: the ratio of shear stress to pressure over the inertial number
    I = rate d sqrt(density / pressure), d the mean diameter."""

    def one(seed, at):
        friction, rate = at
        duration = max(0 if cases.small else 100, 1 / rate)  # strains of 1 to 10, of which the second half counts

        def change(world):
            world["contact"]["friction"] = friction
            world["boundary"]["shear"] = 0
            world["stages"] = [{"name": "press", "duration": 100}, {"name": "shear", "duration": duration, "shear": rate,
                                                                   "strain": {"x": {"rate": 0}}}]

        folder, _ = cases.run("cell", "shear-%g-%g-%d" % (friction, rate, seed), seed, change)
        table = grains.read_table(os.path.join(folder, "cell.csv"))
        late = table["time"] > 100 + 0.5 * duration
        return (-0.5 * (table["stress_xy"] + table["stress_yx"])[late] / table["stress_yy"][late]).mean()

    rates = np.array([0.03] if cases.small else [0.003, 0.01, 0.03, 0.1])
    found = {friction: cases.over(one, [(friction, rate) for rate in rates]) for friction in (0, 0.5)}
    for friction, values in found.items():
        for rate, ratios in zip(rates, values.T):
            cases.tell("shear: friction %g, I %.3g: shear stress by pressure %s" % (friction, 0.85 * rate, bar(ratios)))
    cases.tell("shear: da Cruz and others 2005 have 0.11 and 0.25 to 0.28 for small I", found[0].mean() < found[0.5].mean(),
               0.05 < found[0].mean() < 0.25, 0.2 < found[0.5].mean() < 0.45)
    if not cases.small:
        axes = open_axes(xlabel="inertial number I", ylabel="shear stress by pressure", xscale="log")
        for friction, values in found.items():
            draw_bars(axes, 0.85 * rates, values, label="friction %g" % friction)
        axes.set_ylim(0)
        axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
        cases.save(axes.figure, "shear")


# ----------------------------------------------------------------------------------------------- hoppers


def hopper(cases):
    """Beverloo's law in two dimensions, W = c (D - k d)^(3/2): W^(2/3) is a line over D. W is the mass that crosses the
    periodic border below the opening in a unit of time, over the last two thirds."""

    def one(seed, opening):
        def change(world):
            walls = {wall["name"]: wall for wall in world["walls"]}
            walls["left_bottom"]["at"][0], walls["right_bottom"]["at"][0] = -10.5 - opening / 2, 10.5 + opening / 2

        folder, _ = cases.run("hopper", "hopper-%g-%d" % (opening, seed), seed, change)
        tables = [grains.read_table(frame) for frame in find_frames(folder, "hopper")]
        passed = [-np.sum(table["mass"] * table["cell_y"]) for table in tables]
        return (passed[-1] - passed[len(passed) // 3]) / (len(passed) - 1 - len(passed) // 3)

    openings = np.array([5, 6.5, 8.5] if cases.small else [5, 6.5, 8.5, 10])
    flow = cases.over(one, openings) ** (2 / 3)
    fits = np.array([np.polyfit(openings, row, 1) for row in flow])
    k, (slope, height) = -fits[:, 1] / fits[:, 0], fits.mean(0)
    scatter = abs((flow.mean(0) / (slope * openings + height)) ** 1.5 - 1).max()
    cases.tell("hopper: k %s (1 to 2, Beverloo), c %s, within %.3f" % (bar(k), bar(fits[:, 0] ** 1.5), scatter),
               0 < k.mean() < 2.5, scatter < 0.15)
    if not cases.small:
        axes = open_axes(xlabel="opening by mean size", ylabel="flow^(2/3)")
        axes.plot([k.mean(), 12], [0, slope * (12 - k.mean())], color="#999999", linewidth=1)
        draw_bars(axes, openings, flow)
        axes.set(xlim=(0, 12), ylim=(0, None))
        cases.save(axes.figure, "hopper")


def main():
    known = {case.__name__: case for case in (sand, pile, gas, packing, shear, hopper)}
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--sand", help="a file of fitted grains")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("cases", nargs="+", choices=list(known) + ["all"])
    options = parser.parse_args()
    cases = Cases(options)
    for name in known if options.cases == ["all"] else options.cases:
        known[name](cases)


if __name__ == "__main__":
    main()
