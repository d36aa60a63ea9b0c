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

from importlib import import_module as _import_module
from typing import Any as _Any

from ._batch import (bodies, box_pairs, boxes, casts, contact, contacts, impact, manifold, manifolds, overlaps, pairs, place_parts,
                     poses, refine, separations, validate)
from ._fits import Fit, NamedShape, Outline, cut, cut_exactly, fit, fit_chains, hull, read_shapes, write_shapes
from ._narc import Error, NoAnswer, OutOfRange, get_isa, set_isa
from ._narc import version as __version__
from ._scene import Contacts, Index, Step, distances, inside, rays
from ._shapes import (Shapes, adjust, bounding_box, bounding_circle, center, contains, depths, flatten, inscribed_circle, mass,
                      mirror, move, outlines, perimeter, radius_range, support, union_mass, validate_arcs, weld)
from ._tables import (AABB, ARC, BODY, BOX, CHAIN_ENTRY, CIRCLE, CONSTANTS, CONTACT, DISTANCE, IMPACT, MANIFOLD, MASS, RAY_HIT,
                      REFINED_CONTACT, TOUCH_EVENT)



def __getattr__(name: str) -> _Any:
    if name == "plot":  # which needs matplotlib
        return _import_module("narc.plot")
    raise AttributeError(f"module 'narc' has no attribute {name!r}")


__all__ = ["AABB", "ARC", "BODY", "BOX", "CHAIN_ENTRY", "CIRCLE", "CONSTANTS", "CONTACT", "Contacts", "DISTANCE", "Error",
           "Fit", "IMPACT", "Index", "MANIFOLD", "MASS", "NamedShape", "NoAnswer", "OutOfRange", "Outline", "RAY_HIT",
           "REFINED_CONTACT", "Shapes", "Step", "TOUCH_EVENT", "__version__", "adjust", "bodies", "bounding_box",
           "bounding_circle", "box_pairs", "boxes", "casts", "center", "contact", "contacts", "contains", "cut", "cut_exactly",
           "depths",
           "distances", "fit", "fit_chains", "flatten", "get_isa", "hull", "impact", "inscribed_circle", "inside", "manifold",
           "manifolds", "mass", "mirror", "move", "outlines", "overlaps", "pairs", "perimeter", "place_parts", "poses",
           "radius_range", "rays", "read_shapes", "refine", "separations", "set_isa", "support", "union_mass", "validate",
           "validate_arcs", "weld", "write_shapes"]
