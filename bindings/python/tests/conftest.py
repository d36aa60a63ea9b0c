# SPDX-License-Identifier: MIT
"""Scenes for tests, from a seed that NARC_TEST_SEED may move."""

import os
import signal

import numpy as np
import pytest

import narc


@pytest.fixture
def random():
    return np.random.default_rng(int(os.environ.get("NARC_TEST_SEED", 7)))


class Scene:
    """Circles, boxes and polygons, with their corners for those who compute it another way."""

    def __init__(self, random, count=300, side=30.0):
        self.shapes = narc.Shapes()
        angles = np.arange(7) * 2 * np.pi / 7
        self.corners = {self.shapes.box(2, 1): np.array([[1, .5], [-1, .5], [-1, -.5], [1, -.5]]),
                        self.shapes.regular(7, 1.0): np.stack([np.cos(angles), np.sin(angles)], 1)}
        self.ball = self.shapes.circle(0.75)
        self.angle = random.random(count) * 7
        self.bodies = narc.bodies(random.random((count, 2)) * side, self.angle,
                                  random.choice([self.ball, *self.corners], count), random.random(count) + 0.5)

    def outline(self, k):
        body = self.bodies[k]
        turn = np.array([[np.cos(self.angle[k]), np.sin(self.angle[k])], [-np.sin(self.angle[k]), np.cos(self.angle[k])]])
        return body["xy"] + body["scale"] * self.corners[int(body["shape"])] @ turn

    def geometry(self, k):
        from shapely.geometry import Point, Polygon
        body = self.bodies[k]
        if body["shape"] == self.ball:
            return Point(body["xy"]).buffer(0.75 * body["scale"], 64)
        return Polygon(self.outline(k))


@pytest.fixture
def scene(random):
    return Scene(random)


@pytest.fixture
def ctrl_c():
    """Is heard, as in a terminal: what a shell starts in the background inherits that it is not."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
