# SPDX-License-Identifier: MIT
"""What a scene is asked, and contacts that stay from step to step."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from . import _narc
from ._batch import SLICE, boxes, count_of, from_bits, narrow, slices
from ._shapes import Shapes
from ._tables import (BOX, CONSTANTS, CONTACT, DISTANCE, IMPACT, INDEX_STATISTICS, MANIFOLD, RAY_HIT, TOUCH_EVENT, Bodies, Pairs, Rows,
                      split, whole_numbers)


def _search(options: dict[str, Any], threads: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """What of the options says which bodies count, and the others."""
    chosen, others = split(options, "narc_index_query")
    return {**(chosen or {}), "workers": threads}, others


def _floats(given: ArrayLike) -> Any:
    """As they are if they are floats of some kind; whole numbers and lists become float64."""
    array = np.asarray(given)
    if array.shape == (0,):
        return np.zeros((0, 2))
    return array.astype(np.float64) if array.dtype.kind in "iu" or array.size == 0 else array


def _places(xy: ArrayLike) -> Any:
    """Points (n, 2); one place is (1, 2)."""
    points = _floats(xy)
    return points[None] if points.shape == (2,) else points


def _rays(xy: ArrayLike, motion: ArrayLike, fraction: Any) -> dict[str, Any]:
    start, motion = _floats(xy), narrow(motion)
    motion = motion.reshape(0, 2) if motion.shape == (0,) else motion
    place = {"x": float(start[0]), "y": float(start[1])} if start.shape == (2,) else {"xy": start}
    return {**place, "motion": motion[None] if motion.shape == (2,) else motion,
            "fraction": None if fraction is None else narrow(fraction)}


def _of_all(name: str) -> bool:
    return name in ("owner", "origin")


def _cut(given: Any, part: slice, count: int, name: str) -> Any:
    """Of columns with an item for each question those of a part of the questions."""
    if isinstance(given, dict):
        return {key: value if _of_all(key) else _cut(value, part, count, f"{name}.{key}") for key, value in given.items()}
    if not np.ndim(given):
        return given
    if len(given) != count:
        raise ValueError(f"{name} has {len(given)} items, where there are {count}")
    return given[part]


def _ask(call: Callable[..., int], fixed: tuple[Any, ...], asked: dict[str, Any], out: NDArray[Any], count: int, most: int = 1,
         bits: int = 1) -> None:
    """A call whose questions, by name, have answers in `out`: `most` rows each, or a bit of a word. Of many a part at a time."""
    if count <= SLICE:
        call(*fixed, *asked.values(), out)
        return
    for part in slices(count):
        own = out[part.start * most // bits: -(-part.stop * most // bits)]
        call(*fixed, *(_cut(given, part, count, name) for name, given in asked.items()), own)
        if own.dtype.names:
            own[own.dtype.names[0]] += np.uint32(part.start)  # the number of the question


class Index(_narc.Handle):
    """A tree over the boxes of bodies, for questions to a scene. It keeps the bodies, not a copy: update() after they have
    moved. `options` are those of narc_index_options: category, 64 bits for each body, which `mask` of a question selects; world,
    a number for each body, of which `world` of a question selects one; fast; origin, a place (x, y) near bodies that are far
    from (0, 0).

    Questions go through all bodies, or those that options of narc_index_query select, for each question: mask, 64 bits;
    world; ignored, a body; owners, {"owner": of each body, "ignored": of each question}, which says what bodies are one thing."""

    _shapes: Shapes
    _bodies: Bodies
    _options: dict[str, Any]

    def __new__(cls, shapes: Shapes, bodies: Bodies, *, threads: int = 1, **options: Any) -> Index:
        self = super().__new__(cls, "Index")
        self._shapes, self._bodies, self._options = shapes, bodies, {**options, "workers": threads}
        _narc.build_index(self, self._boxes(bodies, self._options), self._options)
        return self

    def _boxes(self, bodies: Bodies, options: dict[str, Any]) -> Rows:
        return boxes(self._shapes, bodies, origin=options.get("origin"), threads=options["workers"])

    def update(self, bodies: Bodies | None = None, changed: Any = None, *, threads: int | None = None, **options: Any) -> None:
        """Takes bodies as they are now, or others, more or fewer; `changed`: the numbers of those that are not as they were.
        `options` are those that are others from now on, such as columns for more bodies."""
        bodies, options = self._bodies if bodies is None else bodies, {**self._options, **options}
        if threads is not None:
            options["workers"] = threads
        _narc.update_index(self, self._boxes(bodies, options), changed, options)
        self._bodies, self._options = bodies, options

    def statistics(self) -> np.void:
        """How the tree is: boxes, bodies, nodes, leaves, depth, bytes, mean_perimeter, slack."""
        out = np.zeros(1, INDEX_STATISTICS)
        _narc.describe_index(self, out)
        row: np.void = out[0]
        return row

    def nodes(self, level: int) -> Rows:
        """The boxes of a level of the tree, rows of narc.BOX: 0 are the leaves; none from statistics()["depth"] on."""
        out = np.zeros(int(self.statistics()["nodes"]), BOX)
        return out[:_narc.copy_nodes(self, level, out)]

    def __len__(self) -> int:
        return count_of(self._bodies)

    def __repr__(self) -> str:
        return f"<narc.Index of {len(self)} bodies>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _index, (type(self), self._shapes, self._bodies, self._options)

    def regions(self, boxes: ArrayLike, *, threads: int = 1, **options: Any) -> Pairs:
        """Pairs (box, body) of boxes that overlap, (m, 2). `boxes`: rows of narc.BOX, or of (min x, min y, max x, max y) as
        float32."""
        found = _narc.query_index(self, boxes, {**options, "workers": threads})
        return np.frombuffer(found, np.uint32).reshape(-1, 2)

    def rays(self, xy: ArrayLike, motion: ArrayLike, *, most: int = 1, fraction: ArrayLike | None = None, threads: int = 1,
             **options: Any) -> Rows:
        """What each ray hits first: rows of narc.RAY_HIT, `count` 0 where there is nothing. A ray goes from `xy` (n, 2), or
        from one place (2,), to xy + motion, (n, 2); of it the part up to `fraction` counts. `most` rows for each ray, nearest
        first: (n, most). `options` are those of narc_ray_options: inside, any."""
        given = _rays(xy, motion, fraction)
        count = len(given["motion"])
        out = np.zeros(count * max(most, 1), RAY_HIT)
        search, options = _search(options, threads)
        _ask(_narc.cast_rays, (self, self._shapes, self._bodies),
             {"rays": given, "options": {"search": search, "most": most, **options}}, out, count, max(most, 1))
        return out.reshape(-1, most) if most > 1 else out

    def nearest(self, xy: ArrayLike, *, distance: float = 0.0, most: int = 1, threads: int = 1, **options: Any) -> Rows:
        """The bodies nearest to each point of `xy` (n, 2), or to one: rows of narc.DISTANCE, `count` 0 where there is none;
        (n, most) where more than one is wanted. `distance`: only what is nearer; 0: any. `options`: inside, 1: only bodies that
        the point is within."""
        points = _places(xy)
        out = np.zeros(len(points) * max(most, 1), DISTANCE)
        search, options = _search(options, threads)
        _ask(_narc.find_nearest, (self, self._shapes, self._bodies),
             {"points": points, "options": {"search": search, "distance": distance, "most": most, **options}}, out, len(points),
             max(most, 1))
        return out.reshape(-1, most) if most > 1 else out

    def casts(self, movers: Bodies, motion: ArrayLike, angle: ArrayLike | None = None, *, threads: int = 1,
              **options: Any) -> Rows:
        """What each mover hits first on its way, `motion` (n, 2) while it turns by `angle`: rows of narc.IMPACT.
        `options` are those of narc_cast_options: target, tolerance, targets, front_only, parting."""
        count = count_of(movers)
        out = np.zeros(count, IMPACT)
        search, options = _search(options, threads)
        _ask(_narc.cast_shapes, (self, self._shapes, self._bodies),
             {"movers": movers, "motions": {"xy": narrow(motion), "angle": None if angle is None else narrow(angle)},
              "search": search, "options": options or None}, out, count)
        return out


def _index(kind: type[Index], shapes: Shapes, bodies: Bodies, options: dict[str, Any]) -> Index:
    return kind(shapes, bodies, **{("threads" if name == "workers" else name): value for name, value in options.items()})


def distances(shapes: Shapes, bodies: Bodies, xy: ArrayLike, body: ArrayLike | None = None, *, threads: int = 1) -> Rows:
    """How far each point of `xy` (n, 2) is from one body: from number `body`[k], or from body k. Rows of narc.DISTANCE."""
    points = _places(xy)
    out = np.zeros(len(points), DISTANCE)
    _ask(lambda xy, body, out: int(_narc.find_distances(shapes, bodies, xy, body, threads, out)), (),
         {"points": points, "body": body}, out, len(points))
    return out


def inside(shapes: Shapes, bodies: Bodies, xy: ArrayLike, body: ArrayLike | None = None, *,
           threads: int = 1) -> NDArray[np.bool_]:
    """Which points of `xy` (n, 2) are within body number `body`[k], one number for all, or body k: (n,) of bool."""
    points = _places(xy)
    words = np.zeros((len(points) + 63) // 64, np.uint64)
    _ask(lambda xy, body, out: int(_narc.find_inside(shapes, bodies, xy, body, threads, out)), (),
         {"points": points, "body": body}, words, len(points), bits=64)
    return from_bits(words, len(points))


def rays(shapes: Shapes, bodies: Bodies, xy: ArrayLike, motion: ArrayLike, body: ArrayLike | None = None, *,
         fraction: ArrayLike | None = None, threads: int = 1, **options: Any) -> Rows:
    """Where each ray, from `xy` on by `motion` as in Index.rays(), hits body number `body`[k], one for all, or body k: rows of
    narc.RAY_HIT."""
    given = _rays(xy, motion, fraction)
    out = np.zeros(len(given["motion"]), RAY_HIT)
    _ask(_narc.cast_ray_pairs, (shapes, bodies), {"rays": given, "body": body,
                                                  "options": {"search": {"workers": threads}, **options}}, out, len(out))
    return out


class Step(NamedTuple):
    """What a step found; all arrays are copies.

    pairs, slots, rows  of what touches and moves, in the order of pairs: bodies (m, 2); the slot, which is the pair's as long as
                        its bodies stay near each other; narc.MANIFOLD or narc.CONTACT
    more                further rows of pairs with concave arcs
    began, ended        rows of narc.TOUCH_EVENT: what began and ended to touch since the last step
    sensors             slots of sensors' pairs whose bodies overlap
    near, skipped, asked  how many pairs are near each other, bodies are broken, and pairs were asked"""

    pairs: NDArray[np.uint32]
    slots: NDArray[np.uint32]
    rows: Rows
    more: Rows
    began: Rows
    ended: Rows
    sensors: NDArray[np.uint32]
    near: int
    skipped: int
    asked: int


class Contacts(_narc.Handle):
    """Contacts that stay: update() is a step, with work only for what has moved. `rows`: "manifolds" or "contacts". `user`: the
    dtype of what you keep for each pair, such as impulses: all 0 for a new pair, and there as long as its slot is."""

    _rows: str
    _kind: np.dtype[np.void]
    _user: np.dtype[Any]
    _shapes: Shapes | None  # of the last step
    _touching: int

    def __new__(cls, rows: str = "manifolds", user: DTypeLike = np.dtype([])) -> Contacts:
        kinds = {"manifolds": (MANIFOLD, int(CONSTANTS["NARC_MANIFOLD_ROWS"])),
                 "contacts": (CONTACT, int(CONSTANTS["NARC_CONTACT_ROWS"]))}
        if rows not in kinds:
            raise ValueError(f"rows is {rows!r}, it must be 'manifolds' or 'contacts'")
        kept = np.dtype(user)
        if kept.hasobject or kept.itemsize % 4:
            raise TypeError(f"user is {kept}: a dtype without objects is wanted, of 4, 8, 12 ... bytes")
        self = super().__new__(cls, "Contacts", kinds[rows][1], kept.itemsize)
        self._rows, self._kind, self._user, self._shapes, self._touching = rows, kinds[rows][0], kept, None, 0
        return self

    def __repr__(self) -> str:
        kept = f", user {self._user}" if self._user.itemsize else ""
        return f"<narc.Contacts: {self._rows}, {self._touching} of the last step{kept}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _contacts, (type(self), self._rows, self._user, self._shapes, None if self._shapes is None else self.save())

    def update(self, shapes: Shapes, bodies: Bodies, *, margin: float = 0.0, skin: float = 0.0, recycling: float = 0.0,
               threads: int = 1, **options: Any) -> Step:
        """A step: finds what is near, asks again what has moved, and tells what began and ended. `options` are those of
        narc_step: second_margin, flat_angle, front_only, motion, reach, ahead, id, run, moved, pairs, same_pairs, origin; and
        the columns of narc_pair_filter, which say what bodies may meet: kind, category, mask, owner, world. Of broken bodies
        there is no warning: `skipped` counts them."""
        filters, options = split(options, "narc_pair_filter")
        step = _narc.update_contacts(self, shapes, bodies, {"margin": margin, "skin": skin, "recycling": recycling,
                                                            "filter": filters, "workers": threads, **options})
        return self._step(shapes, step)

    def _step(self, shapes: Shapes, step: tuple[Any, ...]) -> Step:
        kinds: tuple[Any, ...] = (np.uint32, np.uint32, self._kind, self._kind, TOUCH_EVENT, TOUCH_EVENT, np.uint32)
        arrays: list[Any] = [np.frombuffer(part, kind) for part, kind in zip(step, kinds)]
        self._shapes, self._touching = shapes, len(arrays[1])
        return Step(arrays[0].reshape(-1, 2), *arrays[1:], *step[7:])

    def user(self, slots: ArrayLike) -> NDArray[Any]:
        """What you keep for these slots of the last step, a copy (n,) of your dtype."""
        given = whole_numbers(slots, "u4", "slots")
        out = np.zeros(len(given), self._user)
        _narc.read_user(self, given, out.view(np.uint8))
        return out

    def keep(self, slots: ArrayLike, rows: ArrayLike) -> None:
        """Keeps rows of your dtype for these slots of the last step."""
        given = whole_numbers(slots, "u4", "slots")
        kept = np.ascontiguousarray(np.broadcast_to(np.asarray(rows, self._user), given.shape))
        _narc.write_user(self, given, kept.view(np.uint8))

    def slots_of(self, body: int) -> NDArray[np.uint32]:
        """The slots of all pairs of a body, by its number in the last step."""
        return np.frombuffer(_narc.find_body_slots(self, body), np.uint32)

    def forget(self, ids: ArrayLike | None = None) -> None:
        """Takes bodies out by their ids, or forgets all pairs."""
        if ids is None:
            _narc.forget_contacts(self)
        else:
            _narc.forget_bodies(self, whole_numbers(ids, "u8", "ids"))

    def save(self) -> bytes:
        """All pairs as bytes: whatever steps follow after load(), each bit is that of the steps that followed here."""
        out = np.zeros(_narc.count_contact_bytes(self), np.uint8)
        _narc.save_contacts(self, out)
        return out.tobytes()

    def load(self, shapes: Shapes, data: bytes) -> Step:
        """Makes contacts what they were when the bytes were saved, and returns the last step before."""
        return self._step(shapes, _narc.load_contacts(self, shapes, np.frombuffer(data, np.uint8)))


def _contacts(kind: type[Contacts], rows: str, user: np.dtype[Any], shapes: Shapes | None, data: bytes | None) -> Contacts:
    contacts = kind(rows, user)
    if shapes is not None and data is not None:
        contacts.load(shapes, data)
    return contacts
