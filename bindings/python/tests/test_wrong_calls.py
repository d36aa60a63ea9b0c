# SPDX-License-Identifier: MIT
"""Thousands of calls with arguments that make no sense: an error or an answer, never a crash."""

import inspect
import os

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

import narc

DTYPES = ["u4", "i8", "f4", "f8", ">u4", ">f4", "i1", "c8", "?", "S4", "O", "f2"]


def anything(random, depth=0):
    """A number, an array of any kind, a mapping, or none of these."""
    kind = random.integers(0, 9 if depth == 0 else 7)
    if kind < 4:
        shape = tuple(random.integers(0, 4, random.integers(0, 4)))
        array = np.zeros(shape, DTYPES[random.integers(len(DTYPES))])
        if array.dtype.kind in "fiu" and array.size:
            array.flat[:] = random.choice([0, 1, 2, 255, 1e30, -1, np.nan] if array.dtype.kind == "f" else [0, 1, 2, 100],
                                          array.size)
        if array.ndim and random.random() < 0.3:
            array = array[::-2]
        array.flags.writeable = random.random() < 0.8
        return array
    if kind == 4:
        return [None, 0, 1, -1, 2**70, 1.5, np.nan, "text", (1, 2), [], b"bytes", narc, True][random.integers(13)]
    if kind == 5:
        return [narc.Shapes(), narc.Contacts(), np.zeros(3, narc.BODY), np.zeros(2, narc.ARC), np.zeros(3, narc.CONTACT),
                np.zeros(4, narc.BOX), np.zeros(2, [("x", "f4"), ("y", "f8")])][random.integers(7)]
    if kind == 6:
        return memoryview(bytes(random.integers(0, 40)))
    names = ["xy", "x", "y", "cosine", "sine", "scale", "shape", "count", "a", "b", "margin", "margins", "selection", "workers",
             "motion", "angle", "search", "most", "owners", "origin", "reserved", "out_skipped", "filter", "pairs", "first"]
    return {random.choice(names): anything(random, depth + 1) for _ in range(random.integers(0, 5))}


@pytest.mark.filterwarnings("ignore")
def test_wrong_calls_are_errors(random, scene):
    calls = [name for name in dir(narc._narc) if callable(getattr(narc._narc, name)) and not name.startswith("_") and
             name not in ("know", "set_isa", "Handle", "Error", "OutOfRange", "NoAnswer")]
    index, contacts = narc.Index(scene.shapes, scene.bodies), narc.Contacts()
    right = {"shapes": scene.shapes, "bodies": scene.bodies, "index": index, "contacts": contacts, "movers": scene.bodies[:5].copy(),
             "pairs": np.array([[0, 1], [2, 3]], np.uint32), "out": np.zeros(4, narc.CONTACT), "query": None, "options": None,
             "threads": 1, "boxes": np.zeros((300, 4), np.float32), "owners": scene.bodies, "parts": scene.bodies[:3].copy()}
    answers = errors = 0
    for _ in range(4000):
        call = getattr(narc._narc, random.choice(calls))
        names = [word.split(":")[0] for word in (call.__doc__ or "").split() if ":" in word]
        given = [right[name] if name in right and random.random() < 0.7 else anything(random) for name in names]
        if random.random() < 0.02:
            given.append(None)
        try:
            call(*given)
            answers += 1
        except (TypeError, ValueError, IndexError, OverflowError, RuntimeError, MemoryError, BufferError):
            errors += 1
    assert answers > 20 and errors > 1000


NUMBERS = st.sampled_from([0, 1, -1, 2, 7, 255, 256, 2**31, 2**32, 2**63, 2**70, 0.5, -1e30, 1e300, np.nan, np.inf, np.float32(2), True])


def make_array(dtype, shape, bits, step):
    array = np.zeros(shape, dtype)
    if dtype != np.dtype("O") and bits is not None:
        array = np.frombuffer(np.random.default_rng(bits).bytes(array.nbytes), np.dtype(dtype)).reshape(shape).copy()
    return array[::step] if array.ndim and step != 1 else array


ARRAYS = st.builds(make_array, st.sampled_from([np.dtype(name) for name in DTYPES] + [narc.BODY, narc.ARC, narc.CONTACT, narc.BOX]),
                   st.lists(st.integers(0, 4), max_size=3).map(tuple), st.none() | st.integers(0, 99), st.sampled_from([1, 1, 2, -1]))
LISTS = st.recursive(NUMBERS | st.text(max_size=2) | st.none(), lambda inner: st.lists(inner, max_size=4) | st.tuples(inner, inner), max_leaves=8)
THINGS = st.one_of(ARRAYS, LISTS, st.builds(narc.Shapes), st.builds(narc.Contacts), st.binary(max_size=40),
                   st.dictionaries(st.sampled_from(["xy", "x", "y", "cosine", "sine", "scale", "shape", "a", "b", "ab", "shift"]), ARRAYS | LISTS,
                                   max_size=4))
OPTIONS = st.dictionaries(st.sampled_from(["margin", "margins", "selection", "dense", "first", "count", "threads", "others", "out", "world",
                                           "kind", "category", "mask", "owner", "origin", "owners", "most", "distance", "fraction", "inside",
                                           "angle", "target", "motion", "skin", "id", "pairs", "run", "ignored", "body", "tolerance", "radius"]),
                          THINGS, max_size=3)
PUBLIC = [getattr(narc, name) for name in narc.__all__ if inspect.isfunction(getattr(narc, name)) and name not in
          ("set_isa", "write_shapes", "read_shapes", "fit", "cut")]


@pytest.mark.filterwarnings("ignore")
@settings(max_examples=max(20, int(1000 * float(os.environ.get("NARC_TEST_TRIALS", 1)))), deadline=None, database=None, suppress_health_check=list(HealthCheck))
@given(st.data())
def test_what_is_public_takes_anything(data):
    """Each function and method, with two right arguments at first and anything behind them."""
    shapes = narc.Shapes()
    shapes.box(2, 1), shapes.circle(1)
    bodies = narc.bodies([[0, 0], [1, 1], [3, 0]], shape=[0, 1, 0])
    index, contacts = narc.Index(shapes, bodies), narc.Contacts()
    methods = [getattr(thing, name) for thing in (shapes, index, contacts) for name in dir(thing) if not name.startswith("_")]
    call = data.draw(st.sampled_from(PUBLIC + methods))
    first = [shapes, bodies][:data.draw(st.integers(0, 2))] if call in PUBLIC or call == contacts.update else []
    rest = data.draw(st.lists(THINGS, max_size=3))
    try:
        call(*first, *rest, **data.draw(OPTIONS if data.draw(st.booleans()) else st.just({})))
    except (TypeError, ValueError, IndexError, OverflowError, MemoryError, RuntimeError, BufferError, AttributeError, KeyError, ImportError):
        pass
    assert narc.contacts(shapes, bodies)[0] is not None
