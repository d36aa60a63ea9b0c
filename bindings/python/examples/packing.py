# SPDX-License-Identifier: MIT
"""Irregular parts that lie over each other are pushed apart in a container: each step moves and turns the parts of every
contact by half of its depth.

    python packing.py [PICTURE]"""

import sys

import numpy as np

import narc

WIDTH, HEIGHT = 30.0, 20.0


def make_parts(random, share=0.7):
    """Parts that cover `share` of the container, anywhere in it, and walls."""
    shapes = narc.Shapes()
    kinds = [shapes.box(2.4, 0.9, 0.15), shapes.ellipse(1.3, 0.6), shapes.regular(5, 0.9, 0.1), shapes.capsule(1.6, 0.4),
             shapes.ring([[0, 0], [2.4, 0], [2.2, 0.8], [1, 1.6], [0.2, 1.2]]), shapes.polygon([[0, 0], [2, 0], [0.5, 1.2]], 0.1)]
    areas = np.array([shapes.mass(kind)["area"] for kind in kinds])
    count = int(share * WIDTH * HEIGHT / areas.mean())
    kind = random.integers(0, len(kinds), count)
    parts = narc.bodies(random.random((count, 2)) * (WIDTH, HEIGHT), random.random(count) * 7, np.take(kinds, kind))
    across, along = shapes.box(2 * WIDTH, 10), shapes.box(10, 2 * HEIGHT)
    walls = narc.bodies([[WIDTH / 2, -5], [WIDTH / 2, HEIGHT + 5], [-5, HEIGHT / 2], [WIDTH + 5, HEIGHT / 2]],
                        shape=[across, across, along, along])
    return shapes, parts, walls, areas[kind]


def deepest(shapes, parts, walls):
    """The largest depth of a part in another one, or in a wall."""
    rows = [narc.contacts(shapes, parts)[0], narc.contacts(shapes, parts, others=walls)[0]]
    return max(float(-r["separation"].min(initial=0)) for r in rows)


def push_apart(shapes, parts, walls, areas, steps=600):
    """Moves the parts, and returns the depth after each step."""
    centres = np.array([shapes.mass(k)["centroid"] for k in range(len(shapes))])
    moments = np.array([shapes.mass(k)["second_moment"] / shapes.mass(k)["area"] for k in range(len(shapes))])
    angle = np.arctan2(parts["sine"], parts["cosine"]).astype(float)
    inertia = moments[parts["shape"]]
    count, depths = len(parts), []
    for _ in range(steps):
        move, turn, weight = np.zeros((count, 2)), np.zeros(count), np.zeros(count)
        cosine, sine = np.cos(angle), np.sin(angle)
        local = centres[parts["shape"]]
        offset = np.stack([cosine * local[:, 0] - sine * local[:, 1], sine * local[:, 0] + cosine * local[:, 1]], 1)
        depth = 0.0
        for others in (None, walls):
            rows, pairs = narc.contacts(shapes, parts, others=others)
            depth = max(depth, float(-rows["separation"].min(initial=0)))
            a, b = pairs[rows["pair"]].T
            for body, sign in ((a, -1), (b, 1)) if others is None else ((a, -1),):
                push = sign * rows["normal"] * (-rows["separation"] * (0.5 if others is None else 1.0))[:, None]
                arm = rows["point"] + (parts["xy"][a] - parts["xy"][body]) - offset[body]
                np.add.at(move, body, push)
                np.add.at(turn, body, (arm[:, 0] * push[:, 1] - arm[:, 1] * push[:, 0]) / (inertia[body] + (arm**2).sum(1)))
                np.add.at(weight, body, 1)
        depths.append(depth)
        share = 1 / np.maximum(weight, 1) ** 0.5
        turn = np.clip(turn * share, -0.2, 0.2)
        parts["xy"] += move * share[:, None] + offset
        angle += turn
        parts["cosine"], parts["sine"] = np.cos(angle), np.sin(angle)
        cosine, sine = np.cos(angle), np.sin(angle)
        parts["xy"] -= np.stack([cosine * local[:, 0] - sine * local[:, 1], sine * local[:, 0] + cosine * local[:, 1]], 1)
        if depth < 2e-3:
            break
    return depths


def main(picture="packing.png"):
    shapes, parts, walls, areas = make_parts(np.random.default_rng(5))
    before = parts.copy()
    depths = push_apart(shapes, parts, walls, areas)
    print(f"{len(parts)} parts, {areas.sum() / WIDTH / HEIGHT:.0%} of the container; depth {depths[0]:.2f}, after {len(depths)} "
          f"steps {depths[-1]:.4f}")
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    from narc import plot
    figure, axes = pyplot.subplots(1, 2, figsize=(12, 4.4), dpi=110)
    for axis, shown, title in zip(axes, (before, parts), ("before", f"after {len(depths)} steps")):
        colours = pyplot.get_cmap("Set3")(shown["shape"] % 12)
        plot.draw_bodies(axis, shapes, shown, facecolor=colours, alpha=0.8)
        rows, pairs = narc.contacts(shapes, shown)
        plot.draw_contacts(axis, shown, rows[rows["separation"] < -0.05], pairs)
        axis.set(xlim=(-0.2, WIDTH + 0.2), ylim=(-0.2, HEIGHT + 0.2), title=title)
    figure.tight_layout()
    figure.savefig(picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
