# SPDX-License-Identifier: MIT
"""From drawings to shapes: outlines, the arcs that fit them best, and shapes files. These need narc's fit library."""

from __future__ import annotations

import dataclasses
import operator
import pathlib
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._shapes import Arcs, as_arcs
from ._tables import ARC, as_points

_fit: Any = None
_missing: ImportError | None = None
try:
    from . import _fit
except ImportError as _error:  # of a wheel that was built where the libraries of fits are not, or is where they are not
    _missing = _error

Family = Literal["n-arc", "edges", "polygon", "paper", "plain"]
Goal = Literal["area", "perimeter", "distance", "nearest", "difference"]
_FAMILIES = ("n-arc", "edges", "polygon", "paper", "plain")
_GOALS = ("area", "perimeter", "distance", "nearest", "difference")
_FORMS: tuple[Literal["shape"], Literal["open"], Literal["closed"], Literal["half_plane"]] = ("shape", "open", "closed", "half_plane")
_READERS = ("svg", "png", "dxf", "csv", "json")


def _library() -> Any:
    if _fit is None:
        raise ImportError(f"fits and shapes files need FreeType, libpng, librsvg and cJSON, where narc is built and "
                          f"where it runs (sh cmake/bootstrap.sh python installs them): {_missing}")
    return _fit


def _choose(name: str, value: str, names: Sequence[str]) -> int:
    if value not in names:
        raise ValueError(f"{name} {value!r}: it is one of {', '.join(names)}")
    return names.index(value)


@dataclasses.dataclass(frozen=True, repr=False)
class Fit:
    """An arc shape that was fitted to an outline. Lengths are in the outline's unit."""

    arcs: Arcs  #: rows of narc.ARC around the shape's centroid, for Shapes.add()
    origin: tuple[float, float]  #: where that is in the outline's coordinates
    edge_count: int
    area: float
    perimeter: float
    hull_area: float
    hull_perimeter: float
    max_distance: float  #: from the outline's convex hull, to either side
    mean_distance: float
    difference_area: float  #: between the shape and the hull
    clearance: float  #: of fits that bound: the least distance of the outline from the shape's, above 0
    flatness: float
    seconds: float

    def __repr__(self) -> str:
        return f"<narc.Fit: {len(self.arcs)} arcs, area {self.area:.4g}, within {self.max_distance:.3g} of the outline's hull>"


class Outline:
    """Closed contours: those of points, of a drawing, or of a glyph.

    `contours`: an array (n, 2), or a list of such arrays, one for each contour; what an odd number of contours is around is
    inside. Outline.read() reads files, Outline.glyph() fonts. y points up. What is no outline raises narc.Error, which names
    line and value."""

    def __init__(self, contours: ArrayLike | Sequence[ArrayLike]) -> None:
        parts = [as_points("contours", part) for part in _list_contours(contours)]
        ends = np.cumsum([len(part) for part in parts], dtype=np.uint64)
        self._path = _library().draw(np.concatenate(parts) if parts else np.zeros((0, 2)), ends)

    @classmethod
    def _of(cls, path: Any) -> Outline:
        outline = cls.__new__(cls)
        outline._path = path
        return outline

    @classmethod
    def read(cls, file: str | pathlib.Path, *, silhouette: Literal["alpha", "dark", "light"] = "alpha", threshold: float = 0.0,
             element: str | None = None) -> Outline:
        """Reads a drawing (.svg, .dxf), an image (.png), or points (.csv, .json). Of drawings and images that is what is not
        transparent, or dark, or light, from a threshold on (0: as usual, 0.5 of images and 0.25 of drawings); of a drawing the
        one `element` with that id, or of a DXF drawing that layer, if one is given."""
        path = pathlib.Path(file)
        kind = path.suffix.lower().removeprefix(".")
        _choose("the file's ending", kind, _READERS)
        which = _choose("silhouette", silhouette, ("alpha", "dark", "light"))
        try:
            return cls._of(_library().read(kind, path.read_bytes(), which, threshold, element))
        except ValueError as error:
            error.add_note(f"in {path}")
            raise

    @classmethod
    def glyph(cls, font: str | pathlib.Path, character: str) -> Outline:
        """The glyph of one character in a font file; lengths in em."""
        return cls._of(_library().read_glyph(pathlib.Path(font).read_bytes(), ord(character)))

    def contours(self, flatness: float = 0.0) -> list[NDArray[np.float64]]:
        """The contours as points (n, 2), with curves within `flatness` of their chords; 0: 2e-5 of the extent."""
        points, ends, _ = _fit.contours(self._path, flatness)
        cuts = np.frombuffer(ends, np.uintp)
        return np.split(np.frombuffer(points, np.float64).reshape(-1, 2).copy(), cuts[:-1].astype(np.intp)) if len(cuts) else []

    def __repr__(self) -> str:
        contours = self.contours()
        return f"<narc.Outline: contours {len(contours)}, points {sum(map(len, contours))}>"


def _whole(name: str, value: int, most: int = 2**31 - 1) -> int:
    if not 0 <= operator.index(value) <= most:
        raise ValueError(f"{name} is {value}, it must be between 0 and {most}")
    return operator.index(value)


def _list_contours(contours: Any) -> list[Any]:
    first = contours[0] if len(contours) else None
    return list(contours) if first is not None and np.ndim(first) == 2 else [contours]


def _outline(of: Outline | ArrayLike | Sequence[ArrayLike]) -> Any:
    return (of if isinstance(of, Outline) else Outline(of))._path


def fit(outline: Outline | ArrayLike | Sequence[ArrayLike], arcs: int = 8, *, tolerance: float = 0.0, family: Family = "n-arc",
        goal: Goal = "area", flatness: float = 0.0, min_radius: float = 0.0, keep_origin: bool = False, quick: bool = False,
        starts: int = 0) -> Fit:
    """Fits one convex arc shape to an outline's hull: the best that is found with at most `arcs` arcs, or, with arcs=0, the one
    of fewest arcs whose largest distance from the hull is at most `tolerance`.

    `family`: "n-arc" (arcs with continuous tangents), "edges" (straight edges between arcs, too), "polygon", "paper"; with arcs=0,
    "plain" (a circle, capsule, box, rounded box or regular polygon, if one is within `tolerance`).
    `goal`: shapes that bound the outline with the least "area", "perimeter" or largest "distance", or those with the least
    largest distance ("nearest") or area between ("difference"). It takes some tenths of a second; with `quick` less, and areas are
    mostly within 1 % of the usual ones. Ctrl-C ends it. Raises narc.Error."""
    found, numbers = _library().fit(_outline(outline), _whole("arcs", arcs), tolerance, _choose("family", family, _FAMILIES),
                                    _choose("goal", goal, _GOALS), flatness, min_radius, keep_origin, quick,
                                    _whole("starts", starts))
    return Fit(np.frombuffer(found, ARC).copy(), **numbers)


def cut(outline: Outline | ArrayLike | Sequence[ArrayLike], tolerance: float = 0.0, *, most: int = 256, lap: float = 0.0,
        flatness: float = 0.0) -> list[Outline]:
    """Cuts an outline into convex parts that hold its inside, few within `tolerance` of it, or, with 0, the
    nearest `most`. `lap`: how far parts go on into their neighbours. narc.fit() makes a shape of each. Raises narc.Error."""
    paths, _, _ = _library().cut(_outline(outline), _whole("most", most), tolerance, lap, flatness)
    return [Outline._of(path) for path in paths]


def cut_exactly(outline: Outline | ArrayLike | Sequence[ArrayLike]) -> list[Fit]:
    """Cuts an outline of straight lines and convex arcs into few convex shapes that are just it: an L is two boxes. Each has its
    place in `origin`. Raises narc.Error, which names the contour, where that can't be."""
    return [Fit(np.frombuffer(arcs, ARC).copy(), **numbers) for arcs, numbers in _library().cut_exactly(_outline(outline))]


def fit_chains(outline: Outline | ArrayLike | Sequence[ArrayLike], tolerance: float, *, open: bool = False,
               smooth: bool = True) -> list[Arcs]:
    """Follows each contour with arcs and lines that join with a common tangent, within `tolerance`: rows of narc.ARC for
    Shapes.chain(), closed unless `open`. If not `smooth`, with the fewest, which may join with corners. Raises narc.Error."""
    chains, _ = _library().chains(_outline(outline), tolerance, open, smooth)
    return [np.frombuffer(arcs, ARC).copy() for arcs in chains]


def hull(xy: ArrayLike) -> NDArray[np.float64]:
    """The corners of the convex hull of points (n, 2), counter-clockwise, no three in line."""
    corners = _library().hull(as_points("xy", xy))
    return np.frombuffer(corners, np.float64).reshape(-1, 2).copy()


@dataclasses.dataclass(frozen=True)
class NamedShape:
    """A shape of a shapes file, or a chain, such as ground, or a half-plane, which has no arcs: Shapes.half_plane()."""

    arcs: Arcs  #: rows of narc.ARC, for Shapes.add(), of chains for Shapes.chain()
    origin: tuple[float, float] = (0.0, 0.0)  #: of a fit, where its origin is in its outline's coordinates
    form: Literal["shape", "open", "closed", "half_plane"] = "shape"


def read_shapes(file: str | pathlib.Path) -> dict[str, NamedShape]:
    """Reads a shapes file, such as `narc fit` writes: shapes by name, in the file's order. Raises narc.Error, with the line."""
    try:
        rows = _library().read_shapes(pathlib.Path(file).read_bytes())
    except ValueError as error:
        error.add_note(f"in {file}")
        raise
    return {name: NamedShape(np.frombuffer(arcs, ARC).copy(), origin, _FORMS[form]) for name, arcs, origin, form in rows}


def write_shapes(file: str | pathlib.Path, shapes: Mapping[str, NamedShape | Fit | ArrayLike]) -> None:
    """Writes a shapes file: fits, shapes that were read, or plain lists of arcs, by name. An old file is replaced in one step."""
    rows = []
    for name, shape in shapes.items():
        known = shape if isinstance(shape, (NamedShape, Fit)) else NamedShape(as_arcs(shape))
        form = _FORMS.index(known.form) if isinstance(known, NamedShape) else 0
        rows.append((name, as_arcs(known.arcs).tobytes(), known.origin, form))
    text = _library().write_shapes(rows)
    path = pathlib.Path(file)
    beside = path.with_name(path.name + ".new")
    beside.write_bytes(text)
    beside.replace(path)
