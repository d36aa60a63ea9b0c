#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""drawings.py [--sample FROM:STEP] [--modes A,B] [--root DIR] [--each] COMMAND...: what `narc fit` makes of 100 drawings
and how long it takes, in seconds of processor time with everything, reading too: for each mode and COMMAND, which may be
"narc -- --quick", medians, and areas against those of the first. drawings.txt lists emoji of Debian's ruby-gemojione,
sprites of supertux-data, and glyphs of fonts-dejavu-core and fonts-symbola, taken at even distances by name, without hulls
that are those of others. --sample 0:2 takes every second one, to try on one half what is told of the other.
"""
import argparse
import os
import statistics
import struct
import subprocess
import tempfile

# Tolerances are in parts of the page.
MODES = {"arcs": ("--arcs 8", 0), "tolerance": ("--tolerance {}", 0.01),
         "parts": ("--parts 256 --edges --tolerance {}", 0.01), "chain": ("--chain --tolerance {}", 0.003)}


def run(command, file, options):
    """The table's row by its heads, None if there is none; seconds of processor time; what was printed."""
    with tempfile.TemporaryFile() as out:
        child = subprocess.Popen([*command.split(), "fit", *file, *options.split(), "--out", os.devnull],
                                 stdout=out, stderr=out)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = status
        out.seek(0)
        text = out.read().decode()
    seconds = used.ru_utime + used.ru_stime
    if status:
        return None, seconds, text
    heads, *rows = text[text.index("shape "):].splitlines()
    for name in ("hull area", "outline area", "max distance", "mean distance", "origin x", "origin y"):
        heads = heads.replace(name, name.replace(" ", "_"))
    heads = heads.split()
    return next(dict(zip(heads, row.split())) for row in rows if len(row.split()) == len(heads)), seconds, text


def page(file):
    """The larger side of a drawing's page, in its own lengths."""
    if len(file) > 1:
        return 1
    if file[0].endswith(".svg"):
        return 64
    with open(file[0], "rb") as png:
        return max(struct.unpack(">II", png.read(24)[16:]))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--sample", default="0:1")
    parser.add_argument("--modes", default=",".join(MODES))
    parser.add_argument("--root", default="/")
    parser.add_argument("--each", action="store_true")
    parser.add_argument("commands", nargs="+")
    given = parser.parse_args()
    with open(os.path.join(os.path.dirname(__file__), "drawings.txt"), encoding="utf-8") as lines:
        drawings = [(kind, [os.path.join(given.root, file), *more]) for kind, file, *more in map(str.split, lines)]
    start, step = map(int, given.sample.split(":"))
    drawings = drawings[start::step]
    print(", ".join(f"{sum(d[0] == kind for d in drawings)} {kind}" for kind in ("emoji", "sprites", "glyphs")))
    print("| | | seconds: median | 90 % | pieces | area / hull's or outline's | distance, % of the page: median | largest "
          "| area / first's: median | largest | over 0.1 % | over 1 % | failed |")
    print("| --- " * 13 + "|")
    for mode in given.modes.split(","):
        options, tolerance = MODES[mode]
        first = {}
        for command in given.commands:
            command, _, more = command.partition(" -- ")
            if mode == "chain" and more:
                continue
            seconds, pieces, areas, far, against, failed = [], [], [], [], [], 0
            for number, (kind, file) in enumerate(drawings):
                row, used, text = run(command, file, f"{options.format(tolerance * page(file))} {more}")
                seconds.append(used)
                if not row:
                    failed += 1
                    if given.each:
                        print(mode, command, more, file, text)
                    continue
                pieces.append(int(row["arcs"]) + int(row.get("edges", row.get("lines", 0))))
                far.append(100 * float(row.get("max_distance", row.get("distance", "nan"))) / page(file))
                ratio = float(row.get("ratio", "nan"))
                areas.append(ratio)
                first.setdefault(number, ratio)
                against.append(ratio / first[number])
                if given.each:
                    print(mode, command, more, kind, row["shape"], f"{used:.3f}", pieces[-1], f"{ratio:.5f} "
                          f"{ratio / first[number]:.5f} {far[-1]:.3f}", flush=True)
            seconds.sort()
            print(f"| {mode} | {command} {more} | {statistics.median(seconds):.3f} | {seconds[len(seconds) * 9 // 10]:.3f} "
                  f"| {statistics.median(pieces):g} | {statistics.median(areas):.4f} | {statistics.median(far):.3f} "
                  f"| {max(far):.3f} | {statistics.median(against):.5f} | {max(against):.4f} "
                  f"| {sum(a > 1.001 for a in against)} | {sum(a > 1.01 for a in against)} | {failed} |", flush=True)


main()
