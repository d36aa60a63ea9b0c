# SPDX-License-Identifier: MIT
"""Batches: bodies and pairs in, rows out."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _narc
from ._shapes import Shapes
from ._tables import BODY, BOX, CONTACT, MANIFOLD, REFINED_CONTACT, split

Rows = NDArray[np.void]
Bodies = Any  # rows of BODY, other records with fields of these names, or a mapping of columns


def bodies(xy: ArrayLike, angle: ArrayLike = 0.0, shape: ArrayLike = 0, scale: ArrayLike = 1.0) -> Rows:
    """Rows of narc.BODY, one for each place of `xy` (n, 2): fields xy, cosine, sine, scale, shape. `angle` in radians.

    Calls take other arrays, too, without copying them: records with fields of these names, or x and y, in any order and
    with others between them; or a mapping of columns, {"xy": (n, 2), "cosine": (n,), "sine": 0.0, ...}, floats of 32 bits but
    for positions, which may have 64. A single number is that of all bodies."""
    places = np.asarray(xy, dtype=np.float64)
    if places.ndim != 2 or places.shape[1] != 2:
        raise ValueError(f"xy: the shape is to be (n, 2), not {places.shape}")
    out = np.zeros(len(places), BODY)
    out["xy"] = places
    out["cosine"], out["sine"] = np.cos(angle), np.sin(angle)
    out["scale"], out["shape"] = scale, shape
    return out


def from_bits(words: NDArray[np.uint64], count: int) -> NDArray[np.bool_]:
    little = words.astype("<u8", copy=False)
    return np.unpackbits(little.view(np.uint8), count=count, bitorder="little").view(np.bool_)


def count_of(of: Bodies) -> int:
    if isinstance(of, dict):
        return max((len(column) for column in of.values() if np.ndim(column)), default=1)
    return len(of)


def validate(shapes: Shapes, bodies: Bodies) -> None:
    """Raises narc.Error for the first body that is broken, and says why."""
    _narc.validate_bodies(shapes, bodies)


def boxes(shapes: Shapes, bodies: Bodies, *, margin: float = 0.0, threads: int = 1, **options: Any) -> Rows:
    """The boxes of all bodies, rows of narc.BOX with `min` and `max`. `options` are those of narc_box_options: motion (n, 2),
    origin."""
    out = np.zeros(count_of(bodies), BOX)
    _narc.compute_boxes(shapes, bodies, {"margin": margin, "workers": threads, **options}, out)
    return out


def box_pairs(boxes: ArrayLike, *, threads: int = 1, **filters: Any) -> NDArray[np.uint32]:
    """All pairs a < b of boxes that overlap, (m, 2), in order. `boxes`: rows of narc.BOX, or of four float32. `filters` are
    the columns of narc_pair_filter: kind, category, mask, owner, world."""
    broad = _narc.Handle("BroadPhase")
    room = 4 * len(boxes) + 16  # type: ignore[arg-type]
    while True:
        out = np.zeros((room, 2), np.uint32)
        count = _narc.find_pairs(broad, boxes, filters or None, threads, out)
        if count <= room:
            return out[:count]
        room = count


def pairs(shapes: Shapes, bodies: Bodies, *, margin: float = 0.0, others: Bodies = None, threads: int = 1,
          **options: Any) -> NDArray[np.uint32]:
    """Pairs of bodies whose boxes are closer than `margin`, (m, 2), in order: of `bodies` with each other, or with `others`.
    `options`: the columns of narc_pair_filter, as in box_pairs(), for pairs with each other; `origin`, a place (x, y) near
    bodies that are far from (0, 0)."""
    filters, options = split(options, "narc_pair_filter")
    if filters and others is not None:
        raise TypeError(f"{', '.join(filters)}: filters are for pairs of one set of bodies")
    around = boxes(shapes, bodies, margin=margin / 2, threads=threads, **options)
    if others is None:
        return box_pairs(around, threads=threads, **(filters or {}))
    index = _narc.Handle("Index")
    _narc.build_index(index, boxes(shapes, others, margin=margin / 2, threads=threads, **options), {"workers": threads, **options})
    return np.frombuffer(_narc.query_index(index, around, {"workers": threads}), np.uint32).reshape(-1, 2)


def _prepare(shapes: Shapes, bodies: Bodies, pairs_: Any, others: Bodies, margin: float, threads: int) -> tuple[Any, Any]:
    """The pairs, found if there are none, and what a call is told of them."""
    if pairs_ is None:
        if not margin < np.inf:
            raise ValueError("margin: without pairs it must be finite")
        pairs_ = pairs(shapes, bodies, margin=max(margin, 0.0), others=others, threads=threads)
    if isinstance(pairs_, (list, tuple)):
        pairs_ = np.asarray(pairs_, np.int64).reshape(-1, 2)
    told = pairs_
    if isinstance(pairs_, dict):
        told = {**pairs_, "other_bodies": others}
    elif others is not None:
        told = {"ab": pairs_, "other_bodies": others}
    return pairs_, told


def _rows(call: Any, kind: Any, shapes: Shapes, bodies: Bodies, pairs_: Any, margin: float, others: Bodies, out: Any,
          threads: int, options: dict[str, Any]) -> Any:
    found = told = pairs_
    if others is not None or not isinstance(pairs_, np.ndarray):
        found, told = _prepare(shapes, bodies, pairs_, others, margin, threads)
    if out is not None and out.dtype is not kind and out.dtype != kind:
        raise TypeError(f"out: rows of {kind} are wanted")
    query = {"margin": margin, "workers": threads, **options} if margin or threads != 1 or options else None
    rows = np.zeros(count_of(found), kind) if out is None else out
    while (count := call(shapes, bodies, told, query, rows)) > len(rows):
        if out is not None:
            raise ValueError(f"out has {len(rows)} rows, {count} are needed")
        rows = np.zeros(count, kind)
    rows = rows[: count_of(found) if options.get("dense") else count]
    return (rows, found) if pairs_ is None else rows


def contacts(shapes: Shapes, bodies: Bodies, pairs: Any = None, *, margin: float = 0.0, others: Bodies = None,
             out: Any = None, threads: int = 1, **options: Any) -> Any:
    """Contacts of the pairs that are closer than `margin`, rows of narc.CONTACT in their order: `pair` is the number of the
    pair, `separation` below 0 is the depth, `normal` points from the first body to the second, `point` is halfway between
    the surfaces, relative to the first body's position.

    `pairs`: (m, 2) of uint32 or int64, or a mapping of a, b and shift; None: found by boxes, and the answer is (rows, pairs).
    `others`: the bodies that second numbers name. `out`: rows to fill, of which those that are filled are returned.
    `options` are those of narc_query: margins, selection, dense, front_only, first, count. Broken bodies touch nothing, and
    are told of by the warning narc.NoAnswer. Raises narc.OutOfRange for numbers that there are not."""
    return _rows(_narc.find_contacts, CONTACT, shapes, bodies, pairs, margin, others, out, threads, options)


def manifolds(shapes: Shapes, bodies: Bodies, pairs: Any = None, *, margin: float = 0.0, others: Bodies = None,
              out: Any = None, threads: int = 1, **options: Any) -> Any:
    """As contacts(), with one or two points for each pair: rows of narc.MANIFOLD, what a solver wants. Further options:
    second_margin, flat_angle."""
    return _rows(_narc.find_manifolds, MANIFOLD, shapes, bodies, pairs, margin, others, out, threads, options)


def overlaps(shapes: Shapes, bodies: Bodies, pairs: Any, *, others: Bodies = None, threads: int = 1) -> NDArray[np.bool_]:
    """Which pairs collide: (m,) of bool."""
    _, told = _prepare(shapes, bodies, pairs, others, 0.0, threads)
    count = count_of(pairs)
    words = np.zeros((count + 63) // 64, np.uint64)
    _narc.find_overlaps(shapes, bodies, told, {"workers": threads}, words)
    return from_bits(words, count)


def separations(shapes: Shapes, bodies: Bodies, pairs: Any, *, margin: float = np.inf, others: Bodies = None,
                threads: int = 1, **options: Any) -> NDArray[np.float32]:
    """How far apart each pair is, (m,) of float32: below 0 the depth; infinity where it is `margin` or more."""
    _, told = _prepare(shapes, bodies, pairs, others, margin, threads)
    out = np.full(count_of(pairs), np.inf, np.float32)
    _narc.find_separations(shapes, bodies, told, {"margin": margin, "workers": threads, **options}, out)
    return out


def _two(call: Any, kind: Any, shapes: Shapes, a: Any, b: Any, margin: float, options: dict[str, Any]) -> Any:
    out = np.zeros(1, kind)
    call(shapes, a, b, {"margin": margin, **options} if margin or options else None, out)
    return out[0]


def contact(shapes: Shapes, a: np.void, b: np.void, *, margin: float = 0.0, **options: Any) -> Any:
    """The contact of two bodies, rows of narc.BODY: a row of narc.CONTACT, `count` 0 where there is none."""
    return _two(_narc.find_contact, CONTACT, shapes, a, b, margin, options)


def manifold(shapes: Shapes, a: np.void, b: np.void, *, margin: float = 0.0, **options: Any) -> Any:
    """The manifold of two bodies, rows of narc.BODY: a row of narc.MANIFOLD, `count` 0 where there is none."""
    return _two(_narc.find_manifold, MANIFOLD, shapes, a, b, margin, options)


def refine(shapes: Shapes, bodies: Bodies, pairs: Any, rows: Rows, *, others: Bodies = None) -> Rows:
    """Contacts of these pairs again in double precision: separation, normal, point."""
    _, told = _prepare(shapes, bodies, pairs, others, 0.0, 1)
    out = np.zeros(len(rows), REFINED_CONTACT)
    _narc.refine_contacts(shapes, bodies, told, rows, out)
    return out


def poses(angle: ArrayLike) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Cosines and sines of angles, (n,) each, the same to the last bit on every machine."""
    angles = np.ascontiguousarray(angle, np.float32)
    cosine, sine = np.empty_like(angles), np.empty_like(angles)
    _narc.compute_poses(angles, cosine, sine)
    return cosine, sine


def place_parts(owners: Bodies, parts: Bodies, owner: ArrayLike, *, threads: int = 1) -> Rows:
    """Compounds: where the parts of bodies are, rows of narc.BODY. `parts` are placed within their owners, `owner` has for
    each the number of its owner."""
    out = np.zeros(count_of(parts), BODY)
    _narc.place_parts(owners, parts, owner, threads, out)
    return out
