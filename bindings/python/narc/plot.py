# SPDX-License-Identifier: MIT
"""Bodies, contacts and rays in an axis of matplotlib, which only this module needs."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from numpy.typing import NDArray

from ._shapes import Shapes, flatten, outlines
from ._tables import Rows


def draw_bodies(axis: Axes, shapes: Shapes, bodies: Rows, tolerance: float = 1e-2, **style: Any) -> PolyCollection:
    """Draws rows of narc.BODY as polygons within `tolerance` of them. `style` is that of PolyCollection."""
    drawn = PolyCollection(outlines(shapes, bodies, tolerance), **{"facecolor": "#c8d6e5", "edgecolor": "#576574",
                                                                   "linewidth": 0.5, **style})
    axis.add_collection(drawn)
    axis.set_aspect("equal")
    axis.autoscale_view()
    return drawn


def draw_arcs(axis: Axes, arcs: Any, closed: bool = True, tolerance: float = 1e-2, **style: Any) -> LineCollection:
    """Draws a list of arcs, rows of narc.ARC, as lines within `tolerance` of them; of a chain that is not closed without the
    way back."""
    points = flatten(arcs, tolerance, closed)
    drawn = LineCollection([np.concatenate([points, points[:1]]) if closed else points],
                           **{"color": "#576574", "linewidth": 1.0, **style})
    axis.add_collection(drawn)
    axis.set_aspect("equal")
    axis.autoscale_view()
    return drawn


def draw_contacts(axis: Axes, bodies: Rows, rows: Rows, pairs: NDArray[Any], length: float = 0.3, **style: Any) -> LineCollection:
    """Draws rows of narc.CONTACT of these pairs as normals of this length at their points."""
    points = bodies["xy"][pairs[rows["pair"], 0]] + rows["point"]
    drawn = LineCollection(np.stack([points, points + length * rows["normal"]], 1),
                           **{"color": "#ee5253", "linewidth": 1.0, **style})
    axis.add_collection(drawn)
    return drawn


def draw_rays(axis: Axes, xy: Any, motion: NDArray[Any], hits: Rows, **style: Any) -> LineCollection:
    """Draws rays from `xy` to what they hit, and all their way where that is nothing."""
    start = np.broadcast_to(xy, motion.shape)
    fraction = np.where(hits["count"], hits["fraction"], 1)[:, None]
    drawn = LineCollection(np.stack([start, start + fraction * motion], 1),
                           **{"color": "#10ac84", "linewidth": 0.3, "alpha": 0.6, **style})
    axis.add_collection(drawn)
    return drawn
