# SPDX-License-Identifier: MIT
"""Batches: bodies and pairs in, rows out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, cast, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _narc
from ._shapes import Shapes
from ._tables import (BODY, BOX, CONTACT, IMPACT, MANIFOLD, MOTION, REFINED_CONTACT, Bodies, Pairs, Rows, as_array, as_points,
                      split)

# Ctrl-C is heard between slices of so many pairs or questions; of bits whole words.
SLICE = 1 << 18
_ARRAY = np.ndarray  # looked up often
PairsLike = ArrayLike | dict[str, Any]


def bodies(xy: ArrayLike, angle: ArrayLike = 0.0, shape: ArrayLike = 0, scale: ArrayLike = 1.0) -> Rows:
    """Rows of narc.BODY, one for each place of `xy` (n, 2): fields xy, cosine, sine, scale, shape. `angle` in radians.

    Calls take other arrays, too, without copying them: records with fields of these names, or x and y, in any order and
    with others between them; or a mapping of columns, {"xy": (n, 2), "cosine": (n,), "sine": 0.0, ...}, floats of 32 bits but
    for positions, which may have 64. A single number is that of all bodies; without cosine and sine none is turned."""
    places = as_points("xy", xy)
    count = len(places)
    out = np.zeros(count, BODY)
    turn = _each("angle", angle, count)
    out["xy"], out["cosine"], out["sine"] = places, np.cos(turn), np.sin(turn)
    out["scale"], out["shape"] = _each("scale", scale, count), _each("shape", shape, count, whole=True)
    return out


def _each(name: str, given: ArrayLike, count: int, whole: bool = False) -> NDArray[Any]:
    """One number for all, or one for each."""
    array = np.asarray(given)
    if array.dtype.kind not in ("iu" if whole else "fiub") and array.size:
        raise TypeError(f"{name}: {'whole ' if whole else ''}numbers are wanted, not {array.dtype}")
    if array.ndim and array.shape != (count,):
        raise ValueError(f"{name}: the shape is to be ({count},), not {array.shape}")
    if whole and array.size and not (0 <= array.min() and array.max() < 2**32):
        raise _narc.OutOfRange(f"{name}: {array.min()} to {array.max()} are no numbers of shapes")
    return array


def from_bits(words: NDArray[np.uint64], count: int) -> NDArray[np.bool_]:
    little = words.astype("<u8", copy=False)
    return np.unpackbits(little.view(np.uint8), count=count, bitorder="little").view(np.bool_)


def count_of(of: Any) -> int:
    return len(of) if not isinstance(of, dict) else max((len(column) for column in of.values() if np.ndim(column)), default=1)


def slices(count: int) -> Iterator[slice]:
    """All of it, or parts of SLICE."""
    for k in range(0, max(count, 1), SLICE):
        yield slice(k, min(k + SLICE, count))


def narrow(numbers: ArrayLike) -> NDArray[np.float32]:
    """What is asked once may come as float64, or as a list: as float32, and as it is if it is."""
    given = np.asarray(numbers)
    if given.dtype.kind not in "fiu" and given.size:
        raise TypeError(f"motion, angle and fraction: numbers are wanted, not {given.dtype}")
    return given if given.dtype == np.float32 else given.astype(np.float32)


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


def pairs(shapes: Shapes, bodies: Bodies, *, margin: float = 0.0, others: Bodies | None = None, threads: int = 1,
          **options: Any) -> Pairs:
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
    theirs = boxes(shapes, others, margin=margin / 2, threads=threads, **options)
    _narc.build_index(index, theirs, {"workers": threads, **options})
    return np.frombuffer(_narc.query_index(index, around, {"workers": threads}), np.uint32).reshape(-1, 2)


def _given(pairs: Any, filters: dict[str, Any] | None) -> Any:
    """Pairs that are not to be found."""
    if filters:
        raise TypeError(f"{', '.join(filters)}: this is for pairs that are found by boxes, and these are given")
    if isinstance(pairs, dict) and "other_bodies" in pairs:
        raise TypeError("pairs: other_bodies are given by others=")
    if isinstance(pairs, (list, tuple)):
        return as_array(pairs, "i8", "pairs") if len(pairs) else np.zeros((0, 2), np.uint32)
    return pairs


def _prepare(shapes: Shapes, bodies: Bodies, given: Any, others: Bodies | None, margin: float, threads: int,
             options: dict[str, Any]) -> tuple[Any, Any, dict[str, Any]]:
    """The pairs, found by boxes if there are none; what a call is told of them; and the options that are not of finding."""
    filters, rest = split(options, "narc_pair_filter")
    if "origin" in rest:
        filters = {**(filters or {}), "origin": rest.pop("origin")}
    if given is None:
        if not isinstance(margin, (int, float, np.number)):
            raise TypeError(f"margin: a number is wanted, not {margin!r}")
        if not margin < np.inf:
            raise ValueError("margin: without pairs it must be finite")
        given = pairs(shapes, bodies, margin=max(margin, 0.0), others=others, threads=threads, **(filters or {}))
    else:
        given = _given(given, filters)
    if others is None:
        return given, given, rest
    return given, {**(given if isinstance(given, dict) else {"ab": given}), "other_bodies": others}, rest


def _fill(call: Callable[..., int], shapes: Shapes, bodies: Bodies, told: Any, query: dict[str, Any], out: Any,
          count: int) -> None:
    """Something for each pair, where its number says."""
    if count <= SLICE or {"selection", "first", "count"} & query.keys():
        call(shapes, bodies, told, query, out)
        return
    for part in slices(count):
        call(shapes, bodies, told, {**query, "first": part.start, "count": part.stop - part.start}, out)


def _in_slices(call: Callable[..., int], room: int) -> Callable[..., int]:
    """A call that lists rows, for some of the pairs at a time."""
    def ask(shapes: Shapes, bodies: Bodies, told: Any, query: dict[str, Any] | None, rows: Rows) -> int:
        count = 0
        for part in slices(room):
            some = {**(query or {}), "first": part.start, "count": part.stop - part.start}
            count += call(shapes, bodies, told, some, rows[count:])
        return count
    return ask


def _rows(call: Callable[..., int], kind: np.dtype[np.void], shapes: Shapes, bodies: Bodies, given: Any, margin: float,
          others: Bodies | None, out: Rows | None, threads: int, options: dict[str, Any]) -> Any:
    found = told = given
    if others is not None or options or given.__class__ is not _ARRAY:
        found, told, options = _prepare(shapes, bodies, given, others, margin, threads, options)
    query = {"margin": margin, "workers": threads, **options} if margin or threads != 1 or options else None
    room = len(found) if found.__class__ is _ARRAY else count_of(found)
    if out is None:
        rows = np.zeros(room, kind)
    elif (rows := out).dtype is not kind and rows.dtype != kind:
        raise TypeError(f"out: rows of {kind} are wanted")
    ask = call if room <= SLICE or {"dense", "selection", "first", "count"} & options.keys() else _in_slices(call, room)
    count = ask(shapes, bodies, told, query, rows)
    if count > len(rows):
        if out is not None:
            raise ValueError(f"out has {len(rows)} rows, {count} are needed")
        rows = np.zeros(count, kind)
        ask(shapes, bodies, told, query, rows)
    if options and options.get("dense"):
        count = room
    if count != len(rows):
        rows = rows[:count]
    return rows if given is not None else (rows, found)


@overload
def contacts(shapes: Shapes, bodies: Bodies, pairs: None = None, *, margin: float = 0.0, others: Bodies | None = None,
             out: Rows | None = None, threads: int = 1, **options: Any) -> tuple[Rows, Pairs]: ...
@overload
def contacts(shapes: Shapes, bodies: Bodies, pairs: PairsLike, *, margin: float = 0.0, others: Bodies | None = None,
             out: Rows | None = None, threads: int = 1, **options: Any) -> Rows: ...
def contacts(shapes: Shapes, bodies: Bodies, pairs: PairsLike | None = None, *, margin: float = 0.0, others: Bodies | None = None,
             out: Rows | None = None, threads: int = 1, **options: Any) -> Rows | tuple[Rows, Pairs]:
    """Contacts of the pairs that are closer than `margin`, rows of narc.CONTACT in their order: `pair` is the number of the
    pair, `separation` below 0 is the depth, `normal` points from the first body to the second, `point` is halfway between
    the surfaces, relative to the first body's position.

    `pairs`: (m, 2) of uint32 or int64, or a mapping of a, b and shift; None: found by boxes, and the answer is (rows, pairs).
    `others`: the bodies that second numbers name. `out`: rows to fill, of which those that are filled are returned.
    `options` are those of narc_query: margins, selection, dense, front_only, first, count; and for pairs that are found those
    of pairs(): kind, category, mask, owner, world, origin. Broken bodies touch nothing, and are told of by the warning
    narc.NoAnswer. Raises narc.OutOfRange for numbers that there are not."""
    answer: Rows = _rows(_narc.find_contacts, CONTACT, shapes, bodies, pairs, margin, others, out, threads, options)
    return answer


@overload
def manifolds(shapes: Shapes, bodies: Bodies, pairs: None = None, *, margin: float = 0.0, others: Bodies | None = None,
              out: Rows | None = None, threads: int = 1, **options: Any) -> tuple[Rows, Pairs]: ...
@overload
def manifolds(shapes: Shapes, bodies: Bodies, pairs: PairsLike, *, margin: float = 0.0, others: Bodies | None = None,
              out: Rows | None = None, threads: int = 1, **options: Any) -> Rows: ...
def manifolds(shapes: Shapes, bodies: Bodies, pairs: PairsLike | None = None, *, margin: float = 0.0,
              others: Bodies | None = None, out: Rows | None = None, threads: int = 1,
              **options: Any) -> Rows | tuple[Rows, Pairs]:
    """As contacts(), with one or two points for each pair: rows of narc.MANIFOLD, what a solver wants. Further options:
    second_margin, flat_angle."""
    answer: Rows = _rows(_narc.find_manifolds, MANIFOLD, shapes, bodies, pairs, margin, others, out, threads, options)
    return answer


@overload
def overlaps(shapes: Shapes, bodies: Bodies, pairs: None = None, *, others: Bodies | None = None, threads: int = 1,
             **options: Any) -> tuple[NDArray[np.bool_], Pairs]: ...
@overload
def overlaps(shapes: Shapes, bodies: Bodies, pairs: PairsLike, *, others: Bodies | None = None, threads: int = 1,
             **options: Any) -> NDArray[np.bool_]: ...
def overlaps(shapes: Shapes, bodies: Bodies, pairs: PairsLike | None = None, *, others: Bodies | None = None, threads: int = 1,
             **options: Any) -> NDArray[np.bool_] | tuple[NDArray[np.bool_], Pairs]:
    """Which pairs collide: (m,) of bool. `pairs` None: those whose boxes touch, and the answer is (bools, pairs); `options` are
    then those of pairs()."""
    found, told, rest = _prepare(shapes, bodies, pairs, others, 0.0, threads, options)
    count = count_of(found)
    words = np.zeros((count + 63) // 64, np.uint64)
    _fill(_narc.find_overlaps, shapes, bodies, told, {"workers": threads, **rest}, words, count)
    bits = from_bits(words, count)
    return bits if pairs is not None else (bits, found)


@overload
def separations(shapes: Shapes, bodies: Bodies, pairs: None = None, *, margin: float = np.inf, others: Bodies | None = None,
                threads: int = 1, **options: Any) -> tuple[NDArray[np.float32], Pairs]: ...
@overload
def separations(shapes: Shapes, bodies: Bodies, pairs: PairsLike, *, margin: float = np.inf, others: Bodies | None = None,
                threads: int = 1, **options: Any) -> NDArray[np.float32]: ...
def separations(shapes: Shapes, bodies: Bodies, pairs: PairsLike | None = None, *, margin: float = np.inf,
                others: Bodies | None = None, threads: int = 1,
                **options: Any) -> NDArray[np.float32] | tuple[NDArray[np.float32], Pairs]:
    """How far apart each pair is, (m,) of float32: below 0 the depth; infinity where it is `margin` or more. `pairs` None: those
    whose boxes are closer than `margin`, which must be finite, and the answer is (numbers, pairs); `options` are then those of
    pairs(), too."""
    found, told, rest = _prepare(shapes, bodies, pairs, others, margin, threads, options)
    count = count_of(found)
    out = np.full(count, np.inf, np.float32)
    _fill(_narc.find_separations, shapes, bodies, told, {"margin": margin, "workers": threads, **rest}, out, count)
    return out if pairs is not None else (out, found)


def _hold_turns(shapes: Shapes, bodies: Bodies, around: Rows) -> None:
    """Makes boxes hold their bodies at every angle: no point is further from the position than the arcs' extent, nor, then,
    than twice that from any other point."""
    own: Any = bodies if isinstance(bodies, dict) else np.asarray(bodies)
    names = own.keys() if isinstance(own, dict) else own.dtype.names or ()
    shape = np.asarray(own["shape"] if "shape" in names else 0)
    scale = np.asarray(own["scale"] if "scale" in names else 1.0, np.float64)
    numbers, which = np.unique(shape, return_inverse=True)
    extents = np.array([(np.hypot(*arcs["center"].T) + arcs["radius"]).max(initial=0) for arcs in map(shapes.arcs, numbers)])
    grow = np.nextafter((2 * scale * extents[which].reshape(shape.shape)).astype(np.float32), np.float32(np.inf))
    most = np.finfo(np.float32).max  # as far as boxes of half-planes reach
    with np.errstate(over="ignore"):
        around["min"] = np.maximum(np.nextafter(around["min"] - np.atleast_1d(grow)[:, None], np.float32(-np.inf)), -most)
        around["max"] = np.minimum(np.nextafter(around["max"] + np.atleast_1d(grow)[:, None], np.float32(np.inf)), most)


@overload
def casts(shapes: Shapes, bodies: Bodies, motion: ArrayLike, pairs: None = None, *, angle: ArrayLike | None = None,
          threads: int = 1, **options: Any) -> tuple[Rows, Pairs]: ...
@overload
def casts(shapes: Shapes, bodies: Bodies, motion: ArrayLike, pairs: PairsLike, *, angle: ArrayLike | None = None,
          threads: int = 1, **options: Any) -> Rows: ...
def casts(shapes: Shapes, bodies: Bodies, motion: ArrayLike, pairs: PairsLike | None = None, *, angle: ArrayLike | None = None,
          threads: int = 1, **options: Any) -> Rows | tuple[Rows, Pairs]:
    """When the bodies of each pair meet on their ways: rows of narc.IMPACT. `motion` (n, 2), `angle` (n,) in radians. `pairs`
    None: those whose boxes meet on their ways, and the answer is (rows, pairs). `options` are those of narc_cast_options: target,
    tolerance, targets, front_only, parting; and for pairs that are found those of pairs()."""
    ways: dict[str, Any] = {"xy": narrow(motion), "angle": None if angle is None else narrow(angle)}
    filters, rest = split(options, "narc_pair_filter")
    found: Any
    if pairs is not None:
        found = _given(pairs, filters)
    elif not count_of(bodies):
        found = np.zeros((0, 2), np.uint32)
    else:
        reach = {"origin": rest.pop("origin")} if "origin" in rest else {}
        margin = max(float(rest.get("target", 0.0)), 0.0)
        around = boxes(shapes, bodies, margin=margin, motion=ways["xy"], threads=threads, **reach)
        if angle is not None:
            _hold_turns(shapes, bodies, around)
        found = box_pairs(around, threads=threads, **(filters or {}))
    out = np.zeros(count_of(found), IMPACT)
    _narc.cast_pairs(shapes, bodies, ways, found, {"workers": threads, **rest}, out)
    return out if pairs is not None else (out, cast(Pairs, found))


def _two(call: Callable[..., int], kind: np.dtype[np.void], shapes: Shapes, a: Any, b: Any, margin: float,
         options: dict[str, Any]) -> np.void:
    out = np.zeros(1, kind)
    call(shapes, a, b, {"margin": margin, **options} if margin or options else None, out)
    return out[0]  # type: ignore[no-any-return]


def contact(shapes: Shapes, a: np.void, b: np.void, *, margin: float = 0.0, **options: Any) -> np.void:
    """The contact of two bodies, rows of narc.BODY: a row of narc.CONTACT, `count` 0 where there is none."""
    return _two(_narc.find_contact, CONTACT, shapes, a, b, margin, options)


def manifold(shapes: Shapes, a: np.void, b: np.void, *, margin: float = 0.0, **options: Any) -> np.void:
    """The manifold of two bodies, rows of narc.BODY: a row of narc.MANIFOLD, `count` 0 where there is none."""
    return _two(_narc.find_manifold, MANIFOLD, shapes, a, b, margin, options)


def impact(shapes: Shapes, a: np.void, b: np.void, motion_a: ArrayLike = (0, 0, 0),
           motion_b: ArrayLike = (0, 0, 0), **options: Any) -> np.void:
    """When two bodies, rows of narc.BODY, meet that move and turn by (x, y, angle): a row of narc.IMPACT. `options`: target,
    tolerance, front_only, parting, as in casts()."""
    out, ways = np.zeros(1, IMPACT), [narrow(motion_a), narrow(motion_b)]
    for name, way in zip(("motion_a", "motion_b"), ways):
        if way.shape != (3,):
            raise ValueError(f"{name}: the shape is to be (3,), not {way.shape}")
    rows = np.stack(ways).view(MOTION)
    _narc.cast_pair(shapes, a, rows[0], b, rows[1], options or None, out)
    return out[0]  # type: ignore[no-any-return]


def refine(shapes: Shapes, bodies: Bodies, pairs: PairsLike, rows: Rows, *, others: Bodies | None = None) -> Rows:
    """Contacts of these pairs again in double precision: separation, normal, point."""
    _, told, _ = _prepare(shapes, bodies, pairs, others, 0.0, 1, {})
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
