# SPDX-License-Identifier: MIT
"""Types of rows, from the library's own table of structures."""

from __future__ import annotations

import os
import sys
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _narc

Rows = NDArray[np.void]  # rows of a structure, such as narc.CONTACT
Pairs = NDArray[np.uint32]  # (m, 2)
Bodies = NDArray[Any] | memoryview | dict[str, Any]  # rows of BODY, other records with these fields, or columns by name

_NUMBERS = {"float": "f4", "double": "f8", "uint8_t": "u1", "uint16_t": "u2", "uint32_t": "u4", "uint64_t": "u8", "size_t": "u8"}
_LAYOUTS = _narc.layouts()
CONSTANTS: dict[str, int | float] = _narc.constants()


os.register_at_fork(before=lambda: _narc._fork(0), after_in_parent=lambda: _narc._fork(1), after_in_child=lambda: _narc._fork(2))


def row_type(name: str) -> np.dtype[np.void]:
    """The type of rows of a structure. What is x and y of one thing is a pair: `normal_x`, `normal_y` are `normal`, and a plain
    `x`, `y` is `xy`."""
    size, members = _LAYOUTS[name]
    fields: dict[str, tuple[object, int]] = {}
    for member, (kind, offset, nbytes, count) in members.items():
        number = _NUMBERS.get(kind) or row_type(kind)
        stem = "xy" if member == "x" else member.removesuffix("_x")
        if member.removesuffix("_y") in fields and member.endswith("_y") or (member == "y" and "xy" in fields):
            continue
        pair = (member == "x" and "y" in members) or (member.endswith("_x") and stem + "_y" in members)
        fields[stem if pair else member] = ((number, 2) if pair else (number, count) if count > 1 else number, offset)
    return np.dtype({"names": list(fields), "formats": [f for f, _ in fields.values()],
                     "offsets": [o for _, o in fields.values()], "itemsize": size})


def _known(name: str) -> np.dtype[np.void]:
    kind = row_type(name)
    _narc.know(name, kind)
    return kind


for _format, _number in (("f", np.float32), ("d", np.float64), ("I", np.uint32), ("Q", np.uint64), ("q", np.int64)):
    _narc.know(_format, np.dtype(_number))


def as_array(given: object, kind: str, name: str) -> NDArray[Any]:
    """A list as the numbers of a column; what is not is told of by its name. Whole numbers are not rounded."""
    try:
        made = np.asarray(given)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None
    if made.size == 0:
        made = made.astype(kind)
    if made.dtype.kind not in ("fiub" if kind[0] == "f" else "iub"):
        raise TypeError(f"{name}: a list of {'' if kind[0] == 'f' else 'whole '}numbers is wanted, not of {made.dtype}")
    return made if kind == "i8" and made.dtype.kind != "b" else made.astype(kind)


def whole_numbers(given: object, kind: str, name: str) -> NDArray[Any]:
    """As an array (n,) of this kind, if it has all of them."""
    made = as_array(given, "i8", name)
    if made.ndim != 1:
        raise ValueError(f"{name}: the shape is to be (n,), not {made.shape}")
    if made.size and not (0 <= made.min() and made.max() <= np.iinfo(kind).max):
        raise _narc.OutOfRange(f"{name}: there are no numbers {made.min()} to {made.max()}")
    return np.ascontiguousarray(made, kind)


def as_points(name: str, xy: object) -> NDArray[np.float64]:
    """Points (n, 2) from numbers of any kind."""
    points = np.asarray(xy)
    if points.size == 0:
        points = np.zeros((0, 2))
    if points.dtype.kind not in "fiu":
        raise TypeError(f"{name}: numbers are wanted, not {points.dtype}")
    if points.ndim != 2 or points.shape[1] != 2:
        raise ValueError(f"{name}: the shape is to be (n, 2), not {points.shape}")
    return np.ascontiguousarray(points, np.float64)


def warn_of_skipped(count: int) -> None:
    """Warns at the line outside this package that asked."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back and str(frame.f_globals.get("__name__")).startswith("narc."):
        level, frame = level + 1, frame.f_back
    warnings.warn(f"{count} of what was asked has no answer: a broken body or number", _narc.NoAnswer, level)


def split(options: dict[str, Any], structure: str) -> tuple[dict[str, Any] | None, dict[str, Any]]:
    """Options that are members of a structure, None if there are none, and the others."""
    members = _LAYOUTS[structure][1]
    return ({k: v for k, v in options.items() if k in members} or None, {k: v for k, v in options.items() if k not in members})


ARC = _known("narc_arc")
BODY = _known("narc_body")
BOX = _known("narc_box")
CHAIN_ENTRY = _known("narc_chain_entry")
CIRCLE = _known("narc_circle")
CONTACT = _known("narc_contact")
DISTANCE = _known("narc_distance")
IMPACT = _known("narc_impact")
MANIFOLD = _known("narc_manifold")
MASS = _known("narc_mass")
MOTION = _known("narc_motion")
AABB = _known("narc_aabb")
INDEX_STATISTICS = _known("narc_index_statistics")
FOUR_ARC = row_type("narc_four_arc")
REFINED_CONTACT = _known("narc_refined_contact")
RAY_HIT = _known("narc_ray_hit")
TOUCH_EVENT = _known("narc_touch_event")
