# SPDX-License-Identifier: MIT
"""4,096 small worlds in one batch, for learning: in each a robot among 31 balls and boxes, which it pushes; it sees by rays, and
wants to come to a goal. The interface is that of vector environments in Gymnasium, which is not needed.

    python worlds.py [PICTURE]"""

import sys
import time

import numpy as np

import narc

SIDE, BODIES, RAYS, SIGHT = 10.0, 32, 16, 4.0
APART = 40.0  # worlds stand so far from each other that none sees another


class Worlds:
    """`count` worlds; actions are pushes (count, 2), observations distances that rays see and the way to the goal."""

    def __init__(self, count=4096, seed=0, threads=1):
        self.count, self.threads, self.random = count, threads, np.random.default_rng(seed)
        self.shapes = narc.Shapes()
        self.kinds = [self.shapes.circle(0.4), self.shapes.circle(0.3), self.shapes.box(0.9, 0.6)]
        columns = int(np.ceil(np.sqrt(count)))
        self.corner = APART * np.stack([np.arange(count) % columns, np.arange(count) // columns], 1)
        angles = np.arange(RAYS) * 2 * np.pi / RAYS
        self.motion = np.tile((SIGHT * np.stack([np.cos(angles), np.sin(angles)], 1)).astype(np.float32), (count, 1))
        self.bodies = narc.bodies(np.zeros((count * BODIES, 2)))
        self.velocity = np.zeros((count * BODIES, 2))
        self.robots = np.arange(count) * BODIES
        self.goal = np.zeros((count, 2))
        self.time = np.zeros(count, int)
        self.contacts = narc.Contacts("contacts")

    def reset(self, which=None):
        which = np.arange(self.count) if which is None else which
        members = (which[:, None] * BODIES + np.arange(BODIES)).ravel()
        grid = 0.9 + 1.45 * np.stack(np.meshgrid(np.arange(6), np.arange(6)), -1).reshape(-1, 2)
        order = self.random.permuted(np.tile(np.arange(36), (len(which), 1)), axis=1)[:, :BODIES]
        place = grid[order] + self.random.uniform(-0.2, 0.2, (len(which), BODIES, 2))
        shape = np.take(self.kinds, self.random.integers(1, 3, (len(which), BODIES)))
        shape[:, 0] = self.kinds[0]
        self.bodies[members] = narc.bodies((place + self.corner[which][:, None]).reshape(-1, 2),
                                           self.random.uniform(0, 7, len(members)), shape.ravel())
        self.velocity[members] = 0
        self.goal[which] = self.corner[which] + self.random.uniform(1, SIDE - 1, (len(which), 2))
        self.time[which] = 0
        return self.observe(), {}

    def observe(self):
        index = narc.Index(self.shapes, self.bodies, fast=True, threads=self.threads)
        start = np.repeat(self.bodies["xy"][self.robots], RAYS, axis=0)
        hits = index.rays(start, self.motion, ignored=np.repeat(self.robots, RAYS).astype(np.uint32), threads=self.threads)
        seen = np.where(hits["count"], hits["fraction"], 1).reshape(self.count, RAYS)
        return np.concatenate([seen, self.goal - self.bodies["xy"][self.robots]], axis=1).astype(np.float32)

    def move(self, actions):
        """One step of all bodies: pushes, contacts, walls."""
        self.velocity *= 0.9
        self.velocity[self.robots] += 0.05 * np.clip(actions, -1, 1)
        self.bodies["xy"] += self.velocity
        step = self.contacts.update(self.shapes, self.bodies, skin=0.1, threads=self.threads)
        a, b = step.pairs.T
        normal = step.rows["normal"].astype(float)
        half = 0.5 * normal * step.rows["separation"][:, None]
        closing = np.maximum(((self.velocity[a] - self.velocity[b]) * normal).sum(1), 0)[:, None] * normal * 0.5
        for body, sign in ((a, 1), (b, -1)):
            for axis in range(2):
                self.bodies["xy"][:, axis] += sign * np.bincount(body, half[:, axis], len(self.bodies))
                self.velocity[:, axis] -= sign * np.bincount(body, closing[:, axis], len(self.bodies))
        low = np.repeat(self.corner, BODIES, axis=0) + 0.4
        np.clip(self.bodies["xy"], low, low + SIDE - 0.8, out=self.bodies["xy"])
        return step

    def step(self, actions):
        before = np.linalg.norm(self.goal - self.bodies["xy"][self.robots], axis=1)
        self.move(actions)
        self.time += 1
        distance = np.linalg.norm(self.goal - self.bodies["xy"][self.robots], axis=1)
        terminated, truncated = distance < 0.5, self.time >= 500
        reward = before - distance + 5 * terminated
        done = np.flatnonzero(terminated | truncated)
        if len(done):
            self.reset(done)
        return self.observe(), reward, terminated, truncated, {}


def policy(seen):
    """To the goal, and away from what is near."""
    way = seen[:, RAYS:] / np.maximum(np.linalg.norm(seen[:, RAYS:], axis=1), 1e-6)[:, None]
    angles = np.arange(RAYS) * 2 * np.pi / RAYS
    near = np.maximum(0.3 - seen[:, :RAYS], 0)
    return way - 2 * near @ np.stack([np.cos(angles), np.sin(angles)], 1)


def main(picture="worlds.png", count=4096, steps=120):
    worlds = Worlds(count)
    seen, _ = worlds.reset()
    reached, moving = 0, 0.0
    for _ in range(steps):
        actions = policy(seen)
        seen, _, terminated, _, _ = worlds.step(actions)
        reached += int(terminated.sum())
    for _ in range(10):
        begin = time.perf_counter()
        worlds.contacts.update(worlds.shapes, worlds.bodies, skin=0.1)
        moving += time.perf_counter() - begin
        worlds.bodies["xy"] += 0.01
    print(f"{count} worlds of {BODIES}, {steps} steps, {reached} goals; contacts of a step {1000 * moving / 10:.1f} ms")
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    from narc import plot
    figure, axes = pyplot.subplots(3, 6, figsize=(12, 6.2), dpi=110)
    for k, axis in enumerate(axes.flat):
        own = worlds.bodies[k * BODIES:(k + 1) * BODIES]
        colours = ["#ee5253"] + ["#c8d6e5"] * (BODIES - 1)
        plot.draw_rays(axis, own["xy"][0], worlds.motion[:RAYS], narc.Index(worlds.shapes, own).rays(
            own["xy"][0], worlds.motion[:RAYS], ignored=np.zeros(RAYS, np.uint32)), linewidth=0.8)
        plot.draw_bodies(axis, worlds.shapes, own, facecolor=colours)
        axis.plot(*worlds.goal[k], "*", color="#ff9f43", markersize=12)
        axis.set(xlim=worlds.corner[k, 0] + (0, SIDE), ylim=worlds.corner[k, 1] + (0, SIDE), xticks=[], yticks=[])
    figure.tight_layout()
    figure.savefig(picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
