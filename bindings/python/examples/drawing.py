# SPDX-License-Identifier: MIT
"""A drawing becomes arc shapes: as a whole, with more and more arcs, and in convex parts.

    python drawing.py [PICTURE.png [DRAWING.svg]]"""

import pathlib
import sys

import numpy as np

import narc

HERE = pathlib.Path(__file__).parent


def fit_whole(outline: narc.Outline, counts=(4, 6, 8, 12)) -> dict[int, narc.Fit]:
    """The arc shapes of least area around all of it."""
    return {count: narc.fit(outline, count) for count in counts}


def fit_parts(outline: narc.Outline, tolerance: float, arcs: int = 6) -> list[narc.Fit]:
    """A shape for each convex part: edges where it is straight, arcs where it is round."""
    parts = narc.cut(outline, tolerance, lap=0.2 * tolerance)
    return [narc.fit(part, arcs, family="edges", goal="nearest", starts=4) for part in parts]


def draw(outline: narc.Outline, whole: dict[int, narc.Fit], parts: list[narc.Fit], file: str) -> None:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    def patch(contours, **style):
        corners = np.concatenate([np.vstack([c, c[:1]]) for c in contours])
        codes = np.concatenate([[Path.MOVETO, *[Path.LINETO] * (len(c) - 1), Path.CLOSEPOLY] for c in contours])
        return PathPatch(Path(corners, codes), **style)

    def outline_of(fit):
        return narc.flatten(fit.arcs, 0.05) + fit.origin

    figure, axes = pyplot.subplots(1, 3, figsize=(13, 3.6), constrained_layout=True)
    colors = pyplot.get_cmap("tab10").colors
    for axis in axes[:2]:
        axis.add_patch(patch(outline.contours(), facecolor="#dfe6e9", edgecolor="#636e72", linewidth=0.6))
        axis.set_aspect("equal")
        axis.set_axis_off()
    for color, (count, fit) in zip(colors, whole.items()):
        corners = outline_of(fit)
        axes[0].plot(*np.vstack([corners, corners[:1]]).T, color=color, linewidth=1.2, label=f"{count} arcs")
    for k, fit in enumerate(parts):
        axes[1].add_patch(patch([outline_of(fit)], facecolor=(*colors[k % 10], 0.55), edgecolor=colors[k % 10]))
    axes[0].autoscale_view()
    axes[1].autoscale_view()
    axes[0].legend(loc="upper right", fontsize=8, frameon=False)
    axes[0].set_title("arc shapes of least area that bound the drawing", fontsize=10)
    axes[1].set_title(f"{len(parts)} convex parts, {sum(len(fit.arcs) for fit in parts)} arcs", fontsize=10)
    area = next(iter(whole.values())).hull_area
    axes[2].plot(list(whole), [100 * (fit.area / area - 1) for fit in whole.values()], "o-", color="#2d3436")
    axes[2].set(xlabel="arcs", ylabel="area beyond the convex hull, %", ylim=(0, None), xticks=list(whole))
    axes[2].set_title("what more arcs bring", fontsize=10)
    figure.savefig(file, dpi=90)


if __name__ == "__main__":
    drawing = narc.Outline.read(sys.argv[2] if len(sys.argv) > 2 else HERE / "drawing.svg")
    extent = np.ptp(np.concatenate(drawing.contours()), axis=0).max()
    whole, parts = fit_whole(drawing), fit_parts(drawing, 0.015 * extent)
    for count, fit in whole.items():
        print(f"{count:3d} arcs: area {fit.area:10.1f}, {100 * (fit.area / fit.hull_area - 1):.2f} % beyond the hull, {fit.seconds:.1f} s")
    print(f"{len(parts)} convex parts within 1.5 % of the extent, {sum(fit.seconds for fit in parts):.1f} s")
    draw(drawing, whole, parts, sys.argv[1] if len(sys.argv) > 1 else "drawing.png")
