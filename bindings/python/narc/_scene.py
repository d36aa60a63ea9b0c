# SPDX-License-Identifier: MIT
"""What a scene is asked, and contacts that stay from step to step."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _narc
from ._batch import Bodies, Rows, boxes, count_of
from ._shapes import Shapes
from ._tables import CONSTANTS, CONTACT, DISTANCE, IMPACT, MANIFOLD, RAY_HIT, TOUCH_EVENT


def _search(mask: Any, ignored: Any, owners: Any, threads: int) -> dict[str, Any]:
    return {"mask": mask, "ignored": ignored, "owners": owners, "workers": threads}


def _floats(given: ArrayLike) -> Any:
    """As they are if they are float32, or double positions; lists become float64."""
    return given if isinstance(given, np.ndarray) else np.asarray(given, np.float64)


class Index(_narc.Handle):
    """A tree over the boxes of bodies, for questions to a scene. It keeps the bodies, not a copy: update() after they have
    moved. `category`: 64 bits for each body, which `mask` of a question selects."""

    _shapes: Shapes
    _bodies: Bodies
    _options: dict[str, Any]

    def __new__(cls, shapes: Shapes, bodies: Bodies, *, category: Any = None, fast: bool = False, threads: int = 1) -> Index:
        self = super().__new__(cls, "Index")
        self._shapes, self._options = shapes, {"category": category, "fast": fast, "workers": threads}
        self.update(bodies)
        return self

    def update(self, bodies: Bodies = None) -> None:
        """Takes bodies as they are now, or others."""
        self._bodies = self._bodies if bodies is None else bodies
        around = boxes(self._shapes, self._bodies, threads=self._options["workers"])
        _narc.build_index(self, around, self._options)

    def __len__(self) -> int:
        return count_of(self._bodies)

    def __repr__(self) -> str:
        return f"<narc.Index of {len(self)} bodies>"

    def regions(self, boxes: ArrayLike, *, mask: Any = None, ignored: Any = None, threads: int = 1) -> NDArray[np.uint32]:
        """Pairs (box, body) of boxes that overlap, (m, 2). `boxes`: rows of narc.BOX, or of (min x, min y, max x, max y) as
        float32."""
        found = _narc.query_index(self, boxes, {"mask": mask, "ignored": ignored, "workers": threads})
        return np.frombuffer(found, np.uint32).reshape(-1, 2)

    def rays(self, xy: ArrayLike, motion: Any, *, most: int = 1, mask: Any = None, ignored: Any = None, owners: Any = None,
             fraction: Any = None, threads: int = 1, **options: Any) -> Rows:
        """What each ray hits first: rows of narc.RAY_HIT, `count` 0 where there is nothing. A ray goes from `xy` (n, 2), or
        from one place (2,), to xy + motion, (n, 2) of float32; `most` rows for each ray, nearest first. `options` are those of
        narc_ray_options: inside, any."""
        start = _floats(xy)
        rays = {"xy": start} if np.ndim(start) == 2 else {"x": float(start[0]), "y": float(start[1])}
        out = np.zeros(len(motion) * max(most, 1), RAY_HIT)
        _narc.cast_rays(self, self._shapes, self._bodies, {**rays, "motion": motion, "fraction": fraction},
                        {"search": _search(mask, ignored, owners, threads), "most": most, **options}, out)
        return out.reshape(-1, most) if most > 1 else out

    def nearest(self, xy: ArrayLike, *, distance: float = 0.0, most: int = 1, mask: Any = None, ignored: Any = None,
                owners: Any = None, threads: int = 1, **options: Any) -> Rows:
        """The bodies nearest to each point of `xy` (n, 2): rows of narc.DISTANCE, `count` 0 where there is none. `distance`:
        only what is nearer; 0: any. `options`: inside, 1: only bodies that the point is within."""
        points = _floats(xy)
        out = np.zeros(len(points) * max(most, 1), DISTANCE)
        _narc.find_nearest(self, self._shapes, self._bodies, points,
                           {"search": _search(mask, ignored, owners, threads), "distance": distance, "most": most, **options},
                           out)
        return out.reshape(-1, most) if most > 1 else out

    def casts(self, movers: Bodies, motion: Any, angle: Any = None, *, mask: Any = None, ignored: Any = None,
              owners: Any = None, threads: int = 1, **options: Any) -> Rows:
        """What each mover hits first on its way, `motion` (n, 2) of float32 while it turns by `angle`: rows of narc.IMPACT.
        `options` are those of narc_cast_options: target, tolerance, targets, front_only."""
        out = np.zeros(count_of(movers), IMPACT)
        _narc.cast_shapes(self, self._shapes, self._bodies, movers, {"xy": motion, "angle": angle},
                          _search(mask, ignored, owners, threads), options or None, out)
        return out


def distances(shapes: Shapes, bodies: Bodies, xy: ArrayLike, body: Any = None, *, threads: int = 1) -> Rows:
    """How far each point of `xy` (n, 2) is from one body: from number `body`[k], or from body k. Rows of narc.DISTANCE."""
    points = _floats(xy)
    out = np.zeros(len(points), DISTANCE)
    _narc.find_distances(shapes, bodies, points, body, threads, out)
    return out


def casts(shapes: Shapes, bodies: Bodies, motion: Any, pairs: Any, *, angle: Any = None, threads: int = 1,
          **options: Any) -> Rows:
    """When the bodies of each pair meet on their ways: rows of narc.IMPACT. `motion` (n, 2) of float32, `angle` (n,)."""
    out = np.zeros(count_of(pairs), IMPACT)
    _narc.cast_pairs(shapes, bodies, {"xy": motion, "angle": angle}, pairs, {"workers": threads, **options}, out)
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
    """Contacts that stay: update() is a step, with work only for what has moved. `rows`: "manifolds" or "contacts"."""

    _kind: Any

    def __new__(cls, rows: str = "manifolds") -> Contacts:
        kinds = {"manifolds": (MANIFOLD, CONSTANTS["NARC_MANIFOLD_ROWS"]), "contacts": (CONTACT, CONSTANTS["NARC_CONTACT_ROWS"])}
        if rows not in kinds:
            raise ValueError(f"rows is {rows!r}, it must be 'manifolds' or 'contacts'")
        self = super().__new__(cls, "Contacts", kinds[rows][1])
        self._kind = kinds[rows][0]
        return self

    def update(self, shapes: Shapes, bodies: Bodies, *, margin: float = 0.0, skin: float = 0.0, recycling: float = 0.0,
               threads: int = 1, kind: Any = None, category: Any = None, mask: Any = None, group: Any = None,
               **options: Any) -> Step:
        """A step: finds what is near, asks again what has moved, and tells what began and ended. Columns kind, category, mask
        and group say which bodies may meet (narc_pair_filter). `options` are those of narc_step: second_margin, flat_angle,
        front_only, motion, reach, ahead, id, run, moved, pairs, same_pairs."""
        filters = {"kind": kind, "category": category, "mask": mask, "group": group}
        chosen = None if all(column is None for column in filters.values()) else filters
        step = _narc.update_contacts(self, shapes, bodies, {"margin": margin, "skin": skin, "recycling": recycling,
                                                            "filter": chosen, "workers": threads, **options})
        return self._step(step)

    def _step(self, step: tuple[Any, ...]) -> Step:
        kinds = (np.uint32, np.uint32, self._kind, self._kind, TOUCH_EVENT, TOUCH_EVENT, np.uint32)
        arrays = [np.frombuffer(part, kind) for part, kind in zip(step, kinds)]
        return Step(arrays[0].reshape(-1, 2), *arrays[1:], *step[7:])

    def forget(self, ids: ArrayLike | None = None) -> None:
        """Takes bodies out by their ids, or forgets all pairs."""
        if ids is None:
            _narc.forget_contacts(self)
        else:
            _narc.forget_bodies(self, np.ascontiguousarray(ids, np.uint64))

    def save(self) -> bytes:
        """All pairs as bytes: whatever steps follow after load(), each bit is that of the steps that followed here."""
        out = np.zeros(_narc.count_contact_bytes(self), np.uint8)
        _narc.save_contacts(self, out)
        return out.tobytes()

    def load(self, shapes: Shapes, data: bytes) -> Step:
        """Makes contacts what they were when the bytes were saved, and returns the last step before."""
        return self._step(_narc.load_contacts(self, shapes, np.frombuffer(data, np.uint8)))
