# SPDX-License-Identifier: MIT
"""Shapes: builders of arcs, and the store that knows them by number."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _narc
from ._tables import AABB, ARC, CHAIN_ENTRY, CIRCLE, CONSTANTS, FOUR_ARC, MASS, as_points

Arcs = NDArray[np.void]
_MOST = int(CONSTANTS["NARC_MAX_ARCS"])


def _points(xy: ArrayLike) -> NDArray[np.float64]:
    return as_points("xy", xy)


def as_arcs(arcs: ArrayLike) -> Any:
    """Rows of ARC: from these, from records with its fields in any order, or from five numbers each."""
    given = np.asarray(arcs)
    if names := given.dtype.names:
        if set(names) != set(ARC.names or ()):
            raise TypeError(f"arcs: the fields {', '.join(ARC.names or ())} are wanted, not {', '.join(names)}")
        return np.ascontiguousarray(given[list(ARC.names or ())], ARC)
    if given.dtype.kind not in "fiu":
        raise TypeError(f"arcs: numbers are wanted, not {given.dtype}")
    if given.ndim != 2 or given.shape[1] != 5:
        raise ValueError(f"arcs: rows of five numbers are wanted, not the shape {given.shape}")
    return np.ascontiguousarray(given, np.float64).view(ARC)[:, 0]


def _built(build: Any, *arguments: Any) -> Arcs:
    out = np.zeros(_MOST, ARC)
    return out[: build(*arguments, out)].copy()


def _one(compute: Any, arcs: ArrayLike, kind: Any) -> np.void:
    out = np.zeros(1, kind)
    compute(as_arcs(arcs), out)
    return cast(np.void, out[0])


class Shapes(_narc.Handle):
    """A store of convex outlines made of circular arcs and straight edges, each known by its number.

    Every method that adds a shape returns its number; equal shapes are stored once and have one. Lengths are in your unit,
    angles in radians, all is counter-clockwise, x right and y up. What is no shape raises narc.Error, which names the arc or
    point. Calls may share a store between threads; while it is changed none may use it."""

    def __new__(cls) -> Shapes:
        return super().__new__(cls, "Shapes")

    def add(self, arcs: ArrayLike, shape: int | None = None) -> int:
        """Adds arcs: an array of narc.ARC, or rows of (center x, center y, radius, start, end). `shape`: a number of your
        choice, which is free."""
        if shape is not None:
            _narc.add_shape_at(self, shape, as_arcs(arcs))
            return shape
        out = np.zeros(1, np.uint32)
        _narc.add_shape(self, as_arcs(arcs), out)
        return int(out[0])

    def half_plane(self) -> int:
        """All that is not above its own x axis: ground without end, which a body's position and rotation place."""
        out = np.zeros(1, np.uint32)
        _narc.add_half_plane(self, out)
        return int(out[0])

    def circle(self, radius: float) -> int:
        """A circle around the origin."""
        return self.add(_built(_narc.build_circle, radius))

    def box(self, width: float, height: float, radius: float = 0.0) -> int:
        """A box around the origin, its corners rounded inside it."""
        return self.add(_built(_narc.build_box, width, height, radius))

    def capsule(self, length: float, radius: float) -> int:
        """All within `radius` of a segment of `length` along x around the origin."""
        return self.add(_built(_narc.build_capsule, length, radius))

    def segment(self, ends: ArrayLike, radius: float = 0.0) -> int:
        """All within `radius` of the segment between two points, an array (2, 2)."""
        return self.add(_built(_narc.build_segment, _points(ends), radius))

    def polygon(self, xy: ArrayLike, radius: float = 0.0, *, skin: float = 0.0) -> int:
        """A convex polygon, points (n, 2) counter-clockwise; corners rounded inside it with `radius`, or all within `skin` of
        it."""
        if skin:
            return self.add(_built(_narc.build_skin_polygon, _points(xy), skin))
        return self.add(_built(_narc.build_polygon, _points(xy), radius))

    def regular(self, corners: int, circumradius: float, radius: float = 0.0) -> int:
        """A regular polygon around the origin, corner 0 at (circumradius, 0)."""
        return self.add(_built(_narc.build_regular_polygon, corners, circumradius, radius))

    def ellipse(self, half_x: float, half_y: float, arcs: int = 8) -> int:
        """The smooth shape of 4, 8, 12 ... arcs that is nearest to an ellipse."""
        return self.add(_built(_narc.build_ellipse, half_x, half_y, arcs))

    def four_arc(self, radius_low: float, radius_high: float, distance: float, radius_left: float = 0.0,
                 radius_right: float = 0.0) -> int:
        """A lens of two large circles, whose centres are `distance` apart, with tips of these radii."""
        form = np.array([(radius_low, radius_high, distance, radius_left, radius_right)], FOUR_ARC)
        return self.add(_built(_narc.build_four_arc, form))

    def hull(self, xy: ArrayLike, radius: float = 0.0, tolerance: float = 0.0) -> int:
        """The convex hull of points (n, 2) in any order, with a skin; so far points may stay outside (narc_build_hull())."""
        return self.add(_built(_narc.build_hull, _points(xy), tolerance, radius))

    def smooth(self, xy: ArrayLike, radius: float = 0.0) -> int:
        """The smooth shape whose arcs meet at these points (n, 2), counter-clockwise; `radius` of arc 0: radius_range()."""
        return self.add(_built(_narc.build_points, _points(xy), radius))

    def ring(self, xy: ArrayLike) -> int:
        """A smooth shape of arcs near any simple polygon, points (n, 2) in either orientation."""
        return self.add(_built(_narc.build_ring, _points(xy)))

    def chain(self, arcs: ArrayLike, **options: Any) -> NDArray[np.void]:
        """Adds ground, a chain of arcs with the solid on its left, and returns its parts, rows of narc.CHAIN_ENTRY: each
        becomes a body with its `shape` at its `xy`. `options` are those of narc_chain_options: closed, first_run, weld,
        least_radius, thickness, both_sides."""
        given = as_arcs(arcs)
        room = 4 * len(given) + 16
        while True:
            out = np.zeros(room, CHAIN_ENTRY)
            count = _narc.add_chain(self, given, options or None, out)
            if count <= room:
                return out[:count]
            room = count

    def replace(self, shape: int, arcs: ArrayLike) -> None:
        """Puts another shape in the place of one that is used once."""
        _narc.replace_shape(self, shape, as_arcs(arcs))

    def remove(self, shape: int) -> None:
        """Gives back one use of a shape; with the last one it goes."""
        _narc.remove_shape(self, shape)

    def arcs(self, shape: int) -> Arcs:
        """The arcs of a shape as they are stored, in single precision. Raises narc.OutOfRange where there is none."""
        return _built(_narc.get_arcs, self, shape)

    def flags(self, shape: int) -> int:
        """What the store knows of a shape: bits of CONSTANTS["NARC_SHAPE_..."]."""
        return int(_narc.shape_flags(self, shape))

    def uses(self, shape: int) -> int:
        """How often a shape was added, and not removed."""
        return int(_narc.count_uses(self, shape))

    def mass(self, shape: int) -> np.void:
        """Area, centroid and second moment about it: a row of narc.MASS, to be multiplied by a density."""
        return mass(self.arcs(shape))

    def bounding_circle(self, shape: int) -> np.void:
        """The smallest circle around a shape, a row of narc.CIRCLE."""
        return _one(_narc.compute_bounding_circle, self.arcs(shape), CIRCLE)

    def as_polygon(self, shape: int, tolerance: float = 1e-2) -> NDArray[np.float64]:
        """Points (n, 2) on the outline, counter-clockwise, whose chords are within `tolerance` of it: for plots."""
        return flatten(self.arcs(shape), tolerance)

    def __len__(self) -> int:
        """How many numbers were given out, those of removed shapes included."""
        return int(_narc.count_shapes(self))

    def __repr__(self) -> str:
        return f"<narc.Shapes: {len(self)}>"

    def __reduce__(self) -> tuple[Any, ...]:
        out = np.zeros(_narc.count_saved_bytes(self), np.uint8)
        _narc.save_shapes(self, out)
        return _load, (type(self), out.tobytes())


def _load(kind: type[Shapes], data: bytes) -> Shapes:
    shapes = kind()
    _narc.load_shapes(shapes, np.frombuffer(data, np.uint8))
    return shapes


def outlines(shapes: Shapes, bodies: NDArray[np.void], tolerance: float = 1e-2) -> list[NDArray[np.float64]]:
    """Points (n, 2) on the outline of each body, rows of narc.BODY, as Shapes.as_polygon() has them: for plots."""
    known = {shape: shapes.as_polygon(int(shape), tolerance) for shape in set(bodies["shape"])}
    out = []
    for body in bodies:
        points = body["scale"] * known[body["shape"]]
        turned = np.stack([body["cosine"] * points[:, 0] - body["sine"] * points[:, 1],
                           body["sine"] * points[:, 0] + body["cosine"] * points[:, 1]], axis=1)
        out.append(body["xy"] + turned)
    return out


def mass(arcs: ArrayLike) -> np.void:
    """Area, centroid and second moment of a list of arcs, a row of narc.MASS."""
    return _one(_narc.compute_mass, arcs, MASS)


def validate_arcs(arcs: ArrayLike) -> None:
    """Raises narc.Error where a list of arcs is no shape, and says why."""
    _narc.validate_arcs(as_arcs(arcs))


def perimeter(arcs: ArrayLike) -> float:
    """The length of arcs and edges."""
    return float(_one(_narc.compute_perimeter, arcs, np.float64))  # type: ignore[arg-type]


def bounding_circle(arcs: ArrayLike) -> np.void:
    """The smallest circle around a list of arcs, a row of narc.CIRCLE."""
    return _one(_narc.compute_bounding_circle, arcs, CIRCLE)


def inscribed_circle(arcs: ArrayLike) -> np.void:
    """A largest circle within a list of arcs, a row of narc.CIRCLE."""
    return _one(_narc.compute_inscribed_circle, arcs, CIRCLE)


def bounding_box(arcs: ArrayLike, angle: float = 0.0) -> np.void:
    """The box around a list of arcs that is turned by `angle`: `min` and `max`."""
    out = np.zeros(1, AABB)
    _narc.compute_aabb(as_arcs(arcs), angle, out)
    return cast(np.void, out[0])


def support(arcs: ArrayLike, direction: ArrayLike) -> tuple[NDArray[np.float64], int]:
    """The point that lies furthest in a direction, and its arc."""
    x, y = np.asarray(direction, np.float64)
    out = np.zeros((1, 2))
    arc = _narc.find_support(as_arcs(arcs), x, y, out)
    return out[0], int(arc)


def flatten(arcs: ArrayLike, tolerance: float, closed: bool = True, *, body: np.void | None = None) -> NDArray[np.float64]:
    """Points (n, 2) on the outline of a list of arcs, of ground if it is not closed, whose chords are within `tolerance`; where
    `body` is, a row of narc.BODY."""
    given = as_arcs(arcs)
    room = 64
    while True:
        out = np.zeros((room, 2))
        count = _narc.flatten_arcs(given, int(closed), body, tolerance, out)
        if count <= room:
            return out[:count]
        room = count


def depths(arcs: ArrayLike, xy: ArrayLike) -> NDArray[np.float64]:
    """How far points (n, 2) are from the outline, below 0 inside: (n,) of float64."""
    points = _points(xy)
    out = np.zeros(len(points))
    _narc.compute_distance(as_arcs(arcs), points, out)
    return out


def contains(arcs: ArrayLike, xy: ArrayLike) -> NDArray[np.bool_]:
    """Which points (n, 2) are inside, or on the outline: (n,) of bool."""
    points = _points(xy)
    out = np.zeros(len(points), np.bool_)
    _narc.contains_point(as_arcs(arcs), points, out)
    return out


def weld(xy: ArrayLike, tolerance: float) -> NDArray[np.float64]:
    """A polygon without the corners that hardly matter: those within `tolerance` of the sides in their place."""
    points = _points(xy)
    out = np.zeros_like(points)
    return out[: _narc.weld_polygon(points, tolerance, out)]


def adjust(xy: ArrayLike) -> NDArray[np.float64]:
    """Points near those of any simple polygon at which the arcs of a smooth shape can meet: for Shapes.smooth()."""
    points = _points(xy)
    out = np.zeros_like(points)
    return out[: _narc.adjust_polygon(points, out)]


def radius_range(xy: ArrayLike) -> tuple[float, float, float]:
    """The least and largest radius of arc 0 that Shapes.smooth() takes for these points, and its choice."""
    out = np.zeros(3)
    _narc.find_radius_range(_points(xy), out)
    return float(out[0]), float(out[1]), float(out[2])


def mirror(arcs: ArrayLike) -> Arcs:
    """The mirror image at the y axis."""
    return _built(_narc.mirror_arcs, as_arcs(arcs))


def center(arcs: ArrayLike) -> Arcs:
    """The same arcs with their centroid at the origin."""
    return _built(_narc.center_arcs, as_arcs(arcs))


def union_mass(parts: list[ArrayLike]) -> np.void:
    """The mass of all that any of the parts, lists of arcs in one frame, covers."""
    arcs = [as_arcs(part) for part in parts]
    out = np.zeros(1, MASS)
    _narc.compute_union_mass(np.concatenate(arcs), np.array([len(a) for a in arcs], np.uint64), out)
    return cast(np.void, out[0])


def move(arcs: ArrayLike, xy: ArrayLike = (0, 0), angle: float = 0.0, scale: float = 1.0) -> Arcs:
    """The same arcs elsewhere: scaled, turned, then moved."""
    x, y = xy  # type: ignore[misc]
    return _built(_narc.move_arcs, as_arcs(arcs), x, y, angle, scale)
