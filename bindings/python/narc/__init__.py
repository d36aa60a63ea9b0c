# SPDX-License-Identifier: MIT
"""Exact collision of many two-dimensional shapes at once: outlines made of circular arcs and straight edges.

    import narc, numpy as np

    shapes = narc.Shapes()
    box, ball = shapes.box(2, 1), shapes.circle(0.5)
    bodies = narc.bodies(np.random.rand(1000, 2) * 50, angle=np.random.rand(1000), shape=np.tile([box, ball], 500))
    rows, pairs = narc.contacts(shapes, bodies)
    rows["separation"], rows["normal"], pairs[rows["pair"]]

Answers are the same to the last bit on every processor and with any number of threads. Rows are structured arrays; bodies and
columns stay in your arrays and are not copied. Errors are narc.Error (a ValueError) with `status`, `index`, `value`."""

from ._batch import (bodies, box_pairs, boxes, contacts, manifolds, overlaps, pairs, place_parts, separations, validate)
from ._narc import Error, NoAnswer, OutOfRange, get_isa, set_isa
from ._narc import version as __version__
from ._scene import Contacts, Index, Step, casts, distances
from ._shapes import Shapes, mass, move, union_mass
from ._tables import (ARC, BODY, BOX, CHAIN_ENTRY, CIRCLE, CONSTANTS, CONTACT, DISTANCE, IMPACT, MANIFOLD, MASS, RAY_HIT,
                      TOUCH_EVENT)

__all__ = ["ARC", "BODY", "BOX", "CHAIN_ENTRY", "CIRCLE", "CONSTANTS", "CONTACT", "Contacts", "DISTANCE", "Error", "IMPACT",
           "Index", "MANIFOLD", "MASS", "NoAnswer", "OutOfRange", "RAY_HIT", "Shapes", "Step", "TOUCH_EVENT", "__version__",
           "bodies", "box_pairs", "boxes", "casts", "contacts", "distances", "get_isa", "manifolds", "mass", "move", "overlaps",
           "pairs", "place_parts", "separations", "set_isa", "union_mass", "validate"]
