# SPDX-License-Identifier: MIT
"""Grains poured on a table come to rest in a pile: discrete elements in NumPy, with narc's contacts, and the angle of repose.

Each contact pushes by a spring and a damper along its normal, and holds by a spring along its tangent, which slips at the limit of
friction. That spring's length stays with its pair from step to step (`Contacts(user=...)`).

    python dem.py [PICTURE]"""

import sys

import numpy as np

import narc

GRAVITY, STIFFNESS, TANGENTIAL, DAMPING, FRICTION = 10.0, 2e4, 1e4, 12.0, 0.6
STEP, DRAG = 1 / 900, 2.0
TABLE = 24.0


class Pile:
    """Grains of a few shapes, of which row after row falls on the middle of a table."""

    def __init__(self, count=240, corners=True, friction=FRICTION, seed=3):
        random = np.random.default_rng(seed)
        self.friction = friction
        self.shapes = shapes = narc.Shapes()
        turn = np.sort(random.uniform(0, 2 * np.pi, (12, 6)), axis=1) + np.arange(6)
        kinds = [shapes.hull(0.42 * np.stack([np.cos(t), 0.8 * np.sin(t)], 1), 0.06) for t in turn]
        if not corners:
            kinds = [shapes.circle(0.42)]
        table = shapes.box(TABLE, 2.0)
        shape = random.choice(kinds, count)
        masses = np.array([shapes.mass(k) for k in range(len(shapes))])
        self.centre = masses["centroid"]
        self.shape = np.append(shape, table)
        columns = 7
        row, column = np.divmod(np.arange(count), columns)
        place = np.stack([(column - columns // 2) * 1.05 + random.uniform(-0.1, 0.1, count), 1.0 + row * 1.05], 1)
        self.place = np.vstack([place, [[0, -1]]])  # of centroids
        self.angle = np.append(random.uniform(0, 7, count), 0.0)
        scale = np.append(random.uniform(0.8, 1.2, count), 1)
        self.inverse = np.where(self.shape == table, 0, 1 / (masses["area"][self.shape] * scale**2))[:, None]
        self.inverse_moment = np.where(self.shape == table, 0, 1 / (masses["second_moment"][self.shape] * scale**4))
        self.velocity, self.spin = np.zeros((count + 1, 2)), np.zeros(count + 1)
        self.bodies = narc.bodies(self.place, self.angle, self.shape, scale)
        self.contacts = narc.Contacts("contacts", user=[("spring", "f4")])

    def arm(self):
        """From a body's position to its centroid."""
        c, s = np.cos(self.angle), np.sin(self.angle)
        x, y = (self.centre[self.shape] * self.bodies["scale"][:, None]).T
        return np.stack([c * x - s * y, s * x + c * y], 1)

    def step(self):
        arm = self.arm()
        self.bodies["xy"] = self.place - arm
        self.bodies["cosine"], self.bodies["sine"] = np.cos(self.angle), np.sin(self.angle)
        found = self.contacts.update(self.shapes, self.bodies, skin=0.08)
        a, b = found.pairs.T
        normal = found.rows["normal"].astype(float)
        tangent = np.stack([-normal[:, 1], normal[:, 0]], 1)
        to_a = found.rows["point"] - arm[a]
        to_b = found.rows["point"] + self.bodies["xy"][a] - self.place[b]

        def at(body, lever):
            return self.velocity[body] + self.spin[body, None] * np.stack([-lever[:, 1], lever[:, 0]], 1)

        speed = at(b, to_b) - at(a, to_a)
        opening, sliding = (speed * normal).sum(1), (speed * tangent).sum(1)
        push = np.maximum(-STIFFNESS * found.rows["separation"] - DAMPING * opening, 0)
        kept = self.contacts.user(found.slots)
        hold = -TANGENTIAL * (kept["spring"] + STEP * sliding) - 0.5 * DAMPING * sliding
        hold = np.clip(hold, -self.friction * push, self.friction * push)
        kept["spring"] = -(hold + 0.5 * DAMPING * sliding) / TANGENTIAL
        self.contacts.keep(found.slots, kept)
        force = push[:, None] * normal + hold[:, None] * tangent
        for body, lever, sign in ((a, to_a, -1), (b, to_b, 1)):
            for axis in range(2):
                total = np.bincount(body, sign * force[:, axis], len(self.place))
                self.velocity[:, axis] += STEP * self.inverse[:, 0] * total
            moment = sign * (lever[:, 0] * force[:, 1] - lever[:, 1] * force[:, 0])
            self.spin += STEP * self.inverse_moment * np.bincount(body, moment, len(self.place))
        self.velocity[:-1, 1] -= STEP * GRAVITY
        self.velocity *= 1 - DRAG * STEP
        self.place += STEP * self.velocity
        self.angle += STEP * self.spin
        self.place[-1], self.angle[-1], self.velocity[-1], self.spin[-1] = (0, -1), 0, 0, 0
        return found, push

    def energy(self):
        """Of motion, for each grain that is on the table."""
        here = self.place[:-1, 1] > -2
        own = self.velocity[:-1][here], self.spin[:-1][here]
        return ((own[0]**2).sum(1) / self.inverse[:-1, 0][here] + own[1]**2 / self.inverse_moment[:-1][here]).mean() / 2

    def settle(self, steps):
        """Until hardly anything moves."""
        for k in range(steps):
            found, push = self.step()
            if k > 900 and k % 50 == 0 and self.energy() < 2e-4:
                break
        return found, push

    def slopes(self):
        """(degrees, line) on the left and on the right, from the tops of columns between the foot and the summit, of which a side
        may have too few."""
        here = self.place[:-1][(self.place[:-1, 1] > 0) & (np.abs(self.place[:-1, 0]) < TABLE / 2)]
        edges = np.arange(-TABLE / 2, TABLE / 2 + 0.01, 0.8)
        bins = np.digitize(here[:, 0], edges)
        tops = np.array([(edges[k] - 0.4, here[bins == k, 1].max()) for k in np.unique(bins)])
        summit, high = tops[tops[:, 1].argmax()]
        out = []
        for side in (-1, 1):
            flank = tops[(side * (tops[:, 0] - summit) >= 0) & (tops[:, 1] < 0.9 * high) & (tops[:, 1] > 0.12 * high)]
            if len(flank) < 2:
                continue
            rise, foot = np.polyfit(*flank.T, 1)
            out.append((float(np.degrees(np.arctan(-side * rise))), np.array([[x, rise * x + foot] for x in flank[[0, -1], 0]])))
        return out


def main(picture="dem.png", count=240, steps=16000):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    from matplotlib.collections import LineCollection

    from narc import plot
    figure, axes = pyplot.subplots(2, 1, figsize=(11, 9), dpi=110)
    for axis, corners, what in zip(axes, (False, True), ("discs", "stones")):
        pile = Pile(count, corners)
        found, push = pile.settle(steps)
        slopes = pile.slopes()
        angle = np.mean([degrees for degrees, _ in slopes] or 0)
        print(f"{what}: {(pile.place[:-1, 1] > -1).sum()} of {count} grains stay, {len(push)} contacts, "
              f"angle of repose {angle:.1f} degrees")
        grains = pile.bodies[:-1]
        colours = pyplot.get_cmap("copper")(0.45 + 0.5 * (np.arange(count) % 7) / 7)
        plot.draw_bodies(axis, pile.shapes, grains, facecolor=colours, edgecolor="#5b4636")
        plot.draw_bodies(axis, pile.shapes, pile.bodies[-1:], facecolor="#8395a7")
        a, b = found.pairs.T
        inner = (a < count) & (b < count)
        axis.add_collection(LineCollection(np.stack([pile.place[a], pile.place[b]], 1)[inner], color="#ee5253", capstyle="round",
                                           linewidths=np.sqrt(push[inner]) * 0.25))
        for _, line in slopes:
            axis.plot(*line.T, color="#222f3e", linewidth=1.5, linestyle="--")
        axis.set(xlim=(-TABLE / 2 - 0.5, TABLE / 2 + 0.5), ylim=(-1.2, 9.2), xticks=[], yticks=[],
                 title=f"{what}, friction {FRICTION}: {angle:.0f} degrees; red: forces")
    figure.tight_layout()
    figure.savefig(picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
