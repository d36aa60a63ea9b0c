# SPDX-License-Identifier: MIT
"""A robot drives among bodies that move, and makes a map of what its laser scanner sees: 1,080 rays a scan.

    python lidar.py [PICTURE]"""

import sys

import numpy as np

import narc

SIDE, RANGE, RAYS = 60.0, 18.0, 1080


def make_scene(random, count=220):
    shapes = narc.Shapes()
    kinds = [shapes.box(2.5, 1.2, 0.1), shapes.circle(0.7), shapes.capsule(2, 0.4), shapes.ellipse(1.6, 0.7),
             shapes.ring([[0, 0], [3, 0], [2.5, 1], [1.2, 2.2], [0.2, 1.4]])]
    bodies = narc.bodies(random.random((count, 2)) * SIDE, random.random(count) * 7, random.choice(kinds, count))
    return shapes, bodies[np.linalg.norm(bodies["xy"] - SIDE / 2, axis=1) > 3].copy()


def drive(steps=240, seed=3):
    """Where the robot was, what its rays hit, the scene, and the last scan."""
    random = np.random.default_rng(seed)
    shapes, bodies = make_scene(random)
    moving = random.random(len(bodies)) < 0.2
    speed = np.where(moving[:, None], random.normal(0, 0.04, (len(bodies), 2)), 0)
    index = narc.Index(shapes, bodies)
    angles = np.linspace(0, 2 * np.pi, RAYS, endpoint=False)
    motion = (RANGE * np.stack([np.cos(angles), np.sin(angles)], 1)).astype(np.float32)
    place, heading, path, seen = np.full(2, SIDE / 2), 0.5, [], []
    for _ in range(steps):
        bodies["xy"] += speed
        index.update()
        hits = index.rays(place, motion)
        free = np.where(hits["count"], hits["fraction"], 1) * RANGE
        seen.append((place + hits["fraction"][:, None] * motion)[hits["count"] == 1])
        # to where there is most room within some rays, and not far from straight on
        room = np.minimum.reduce([np.roll(free, k) for k in range(-60, 61, 20)])
        turn = (angles - heading + np.pi) % (2 * np.pi) - np.pi
        inside = np.exp(-0.5 * ((place - SIDE / 2) / (SIDE / 2)) @ np.stack([np.cos(angles), np.sin(angles)]))
        heading = angles[np.argmax(room * (1.2 + np.cos(turn)) * inside)]
        place = place + min(0.25, 0.3 * room.max()) * np.array([np.cos(heading), np.sin(heading)])
        path.append(place)
    return shapes, bodies, np.array(path), np.concatenate(seen), (place, motion, index.rays(place, motion))


def main(picture="lidar.png"):
    shapes, bodies, path, seen, (place, motion, hits) = drive()
    print(f"{len(path)} scans, {len(seen)} points; the robot went {np.linalg.norm(np.diff(path, axis=0), axis=1).sum():.0f}")
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    from narc import plot
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(12, 6), dpi=110)
    plot.draw_bodies(left, shapes, bodies)
    plot.draw_rays(left, place, motion, hits)
    left.plot(*path.T, color="#5f27cd", linewidth=1.5)
    left.set_title("bodies, the robot's way, its last scan")
    right.scatter(*seen.T, s=0.2, color="#222f3e")
    right.set(aspect="equal", title="the map", xlim=left.get_xlim(), ylim=left.get_ylim())
    figure.tight_layout()
    figure.savefig(picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
