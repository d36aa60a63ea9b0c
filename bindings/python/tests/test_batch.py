# SPDX-License-Identifier: MIT
"""Batches beside plain NumPy and shapely; arrays in all layouts; what is refused."""

import collections
import pickle

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import narc


def polygon_gap(one, other):
    """The largest gap of two convex polygons along the normals of their sides: their separation where it is below 0."""
    gap = -np.inf
    for p, q in ((one, other), (other, one)):
        edge = np.roll(p, -1, 0) - p
        normal = np.stack([edge[:, 1], -edge[:, 0]], 1) / np.linalg.norm(edge, axis=1)[:, None]
        gap = max(gap, ((q @ normal.T).min(0) - (p * normal).sum(1)).max())
    return gap


def test_circles_are_as_a_formula_says(random):
    shapes = narc.Shapes()
    ball = shapes.circle(0.5)
    bodies = narc.bodies(random.random((2000, 2)) * 20, shape=ball, scale=1 + random.random(2000))
    pairs = random.integers(0, 2000, (5000, 2))
    gap = np.linalg.norm(bodies["xy"][pairs[:, 0]] - bodies["xy"][pairs[:, 1]], axis=1)
    gap -= 0.5 * (bodies["scale"][pairs[:, 0]] + bodies["scale"][pairs[:, 1]])
    apart = pairs[:, 0] != pairs[:, 1]
    assert np.allclose(narc.separations(shapes, bodies, pairs)[apart], gap[apart], atol=1e-5)
    sure = apart & (np.abs(gap) > 1e-4)
    assert (narc.overlaps(shapes, bodies, pairs)[sure] == (gap < 0)[sure]).all()
    rows = narc.contacts(shapes, bodies, pairs)
    way = bodies["xy"][pairs[rows["pair"], 1]] - bodies["xy"][pairs[rows["pair"], 0]]
    length = np.linalg.norm(way, axis=1)
    assert np.allclose(rows["normal"][length > 0.1], (way / np.maximum(length, 1e-9)[:, None])[length > 0.1], atol=1e-4)


def test_polygons_are_as_their_sides_say(scene):
    pairs = narc.pairs(scene.shapes, scene.bodies)
    rows = narc.contacts(scene.shapes, scene.bodies, pairs)
    found = dict(zip(rows["pair"], rows["separation"]))
    tested = 0
    for k, (a, b) in enumerate(pairs):
        if scene.ball in (scene.bodies["shape"][a], scene.bodies["shape"][b]):
            continue
        gap = polygon_gap(scene.outline(a), scene.outline(b))
        assert abs(gap) < 1e-5 or (gap < 0) == (k in found)
        assert gap > -1e-5 or abs(found[k] - gap) < 1e-4
        tested += 1
    assert tested > 50


def test_separations_are_distances_of_shapely(scene):
    pytest.importorskip("shapely")
    geometries = [scene.geometry(k) for k in range(80)]
    pairs = np.array([(a, b) for a in range(80) for b in range(a)], np.uint32)
    separations = narc.separations(scene.shapes, scene.bodies, pairs)
    for (a, b), separation in zip(pairs, separations):
        distance = geometries[a].distance(geometries[b])
        assert abs(max(separation, 0) - distance) < 2e-3  # shapely's circles are polygons


@settings(max_examples=30, deadline=None, database=None)
@given(st.lists(st.tuples(*[st.floats(-10, 10)] * 2, st.floats(-7, 7)), min_size=2, max_size=12))
def test_overlaps_and_contacts_agree(places):
    shapes = narc.Shapes()
    box = shapes.box(3, 2, 0.25)
    xy = np.array([place[:2] for place in places])
    bodies = narc.bodies(xy, [place[2] for place in places], box)
    pairs = np.array([(a, b) for a in range(len(xy)) for b in range(a)], np.uint32)
    rows = narc.contacts(shapes, bodies, pairs)
    assert (np.flatnonzero(narc.overlaps(shapes, bodies, pairs)) == rows["pair"]).all()
    points = narc.manifolds(shapes, bodies, pairs)
    assert (points["pair"] == rows["pair"]).all() and (points["count"] >= 1).all()
    assert (points["normal"] == rows["normal"]).all()


def layouts(bodies):
    """The same bodies as callers have them."""
    count = len(bodies)
    yield "backwards twice", bodies[::-1].copy()[::-1]
    wide = np.zeros((count, 3), bodies.dtype)
    wide[:, 1] = bodies
    yield "every third row", wide[:, 1]
    own = np.zeros(count, [("name", "S5"), ("shape", "<u4"), ("y", "<f8"), ("vertices", "<f4", (3, 2)), ("x", "<f8"), ("scale", "<f4"),
                           ("sine", "<f4"), ("flag", "?"), ("pad", "V3"), ("cosine", "<f4"), ("z", "<c8")])
    own = np.zeros(count, np.dtype(own.dtype.descr, align=True))
    for field in ("cosine", "sine", "scale", "shape"):
        own[field] = bodies[field]
    own["x"], own["y"] = bodies["xy"].T
    yield "records with others", own
    columns = {field: bodies[field].copy() for field in ("xy", "cosine", "sine", "scale", "shape")}
    yield "columns", columns
    yield "columns with gaps", {name: np.repeat(column, 2, axis=0)[::2] for name, column in columns.items()}
    yield "shapes of 64 bits", {**columns, "shape": columns["shape"].astype(np.int64)}
    yield "x and y", {**{name: columns[name] for name in ("cosine", "sine", "scale", "shape")}, "x": columns["xy"][:, 0],
                      "y": columns["xy"][:, 1]}
    yield "a memoryview", memoryview(own)


def test_layouts_give_the_same_bytes(scene):
    pairs = narc.pairs(scene.shapes, scene.bodies)
    expected = narc.contacts(scene.shapes, scene.bodies, pairs).tobytes()
    for name, bodies in layouts(scene.bodies):
        assert narc.contacts(scene.shapes, bodies, pairs).tobytes() == expected, name
    for name, same in (("int64", pairs.astype(np.int64)), ("columns", {"a": pairs[:, 0], "b": pairs[:, 1]}),
                       ("Fortran", np.asfortranarray(pairs)), ("uint8", None), ("backwards", pairs[::-1].copy()[::-1])):
        if same is not None:
            assert narc.contacts(scene.shapes, scene.bodies, same).tobytes() == expected, name
    out = np.zeros(len(pairs), narc.CONTACT)
    rows = narc.contacts(scene.shapes, scene.bodies, pairs, out=out, threads=4)
    assert rows.tobytes() == expected and rows.base is out


def test_one_value_is_that_of_all(random):
    shapes = narc.Shapes()
    box = shapes.box(1, 1)
    xy = random.random((100, 2)) * 5
    plain = narc.contacts(shapes, narc.bodies(xy, 0.0, box))
    same = narc.contacts(shapes, {"xy": xy, "cosine": 1.0, "sine": 0.0, "shape": box})
    assert plain[0].tobytes() == same[0].tobytes() and (plain[1] == same[1]).all()
    assert narc.contacts(shapes, {"xy": xy})[0].tobytes() == plain[0].tobytes()


def test_numbers_of_numpy_are_numbers(scene):
    shapes, bodies = scene.shapes, scene.bodies
    assert (shapes.arcs(bodies["shape"][0]) == shapes.arcs(int(bodies["shape"][0]))).all()
    assert shapes.uses(np.int64(0)) == shapes.uses(np.array(0)) == 1
    assert (narc.pairs(shapes, bodies, threads=np.int32(2)) == narc.pairs(shapes, bodies)).all()
    index = narc.Index(shapes, bodies)
    assert index.nearest(bodies["xy"][:3], most=np.int64(2)).shape == (3, 2)
    ray = np.float32([[9, 9]])
    for half in (np.float64(0.5), np.float32(0.5), np.array(0.5)):
        assert (index.rays((0, 0), ray, fraction=half) == index.rays((0, 0), ray, fraction=0.5)).all()
    plain = {"xy": bodies["xy"], "sine": 0.0, "shape": int(scene.ball), "cosine": 1.0}
    given = {**plain, "sine": np.float64(0), "shape": np.int64(scene.ball), "cosine": np.int32(1)}
    assert (narc.boxes(shapes, given) == narc.boxes(shapes, plain)).all()
    with pytest.raises(TypeError):
        shapes.arcs(np.float64(1))


def test_two_bodies_are_a_batch_of_one(scene):
    pairs = narc.pairs(scene.shapes, scene.bodies, margin=1.0)[:200]
    dense = narc.contacts(scene.shapes, scene.bodies, pairs, dense=True, margin=0.5)
    points = narc.manifolds(scene.shapes, scene.bodies, pairs, dense=True)
    for k, (a, b) in enumerate(pairs):
        row = narc.contact(scene.shapes, scene.bodies[a], scene.bodies[b], margin=0.5)
        row["pair"] = k
        assert row.tobytes() == dense[k].tobytes()
        assert narc.manifold(scene.shapes, scene.bodies[a], scene.bodies[b])["count"] == points["count"][k]


def test_a_cast_of_two_bodies_is_a_batch_of_one(scene, random):
    ways = random.uniform(-3, 3, (len(scene.bodies), 3)).astype(np.float32)
    pairs = narc.pairs(scene.shapes, scene.bodies, margin=3.0)[:200]
    for options in ({}, {"target": 0.1, "tolerance": 0.01}, {"parting": 0.1}):
        rows = narc.casts(scene.shapes, scene.bodies, ways[:, :2], pairs, angle=ways[:, 2], **options)
        assert (rows["count"] == 1).sum() > 20
        for k, (a, b) in enumerate(pairs):
            row = narc.impact(scene.shapes, scene.bodies[a], scene.bodies[b], ways[a], ways[b].tolist(), **options)
            row["pair"], row["body"] = k, b if row["count"] else 0
            assert row.tobytes() == rows[k].tobytes()
    broken = scene.bodies[0].copy()
    broken["xy"] = np.nan
    with pytest.warns(narc.NoAnswer, match="1 of"):
        assert narc.impact(scene.shapes, broken, scene.bodies[1])["count"] == 0


def test_rows_again_in_double_precision(scene):
    pairs = narc.pairs(scene.shapes, scene.bodies)
    rows = narc.contacts(scene.shapes, scene.bodies, pairs)
    fine = narc.refine(scene.shapes, scene.bodies, pairs, rows)
    assert fine["separation"].dtype == np.float64 and np.allclose(fine["separation"], rows["separation"], atol=1e-5)
    assert np.allclose(np.linalg.norm(fine["normal"], axis=1), 1, atol=1e-12)


def test_pairs_of_two_sets(scene):
    one, other = scene.bodies[:100].copy(), scene.bodies[100:].copy()
    rows, pairs = narc.contacts(scene.shapes, one, others=other, margin=0.2)
    every = np.stack(np.meshgrid(np.arange(100), np.arange(200), indexing="ij"), -1).reshape(-1, 2)
    all_rows = narc.contacts(scene.shapes, scene.bodies, every + [0, 100], margin=0.2)
    assert (pairs[rows["pair"]] == every[all_rows["pair"]]).all()
    assert (rows["separation"] == all_rows["separation"]).all() and len(rows) > 20


def test_pairs_are_all_whose_boxes_touch(scene):
    boxes = narc.boxes(scene.shapes, scene.bodies, margin=0.5)
    low, high = boxes["min"], boxes["max"]
    meet = ((low[:, None] <= high[None]) & (low[None] <= high[:, None])).all(-1)
    assert (narc.pairs(scene.shapes, scene.bodies, margin=1.0) == np.argwhere(np.triu(meet, 1))).all()
    static = np.full(len(boxes), narc.CONSTANTS["NARC_STATIC"], np.uint8)
    assert len(narc.box_pairs(boxes, kind=static)) == 0


def test_options_have_their_columns(scene):
    pairs = narc.pairs(scene.shapes, scene.bodies, margin=1.0)
    margins = np.linspace(0, 1, len(pairs), dtype=np.float32)
    separations = narc.separations(scene.shapes, scene.bodies, pairs)
    rows = narc.contacts(scene.shapes, scene.bodies, pairs, margins=margins)
    assert (rows["pair"] == np.flatnonzero(separations < margins)).all()
    chosen = np.arange(len(pairs))[::-3].astype(np.uint32)
    rows = narc.contacts(scene.shapes, scene.bodies, pairs, margin=np.inf, selection=chosen)
    assert (rows["pair"] == chosen).all()
    dense = narc.contacts(scene.shapes, scene.bodies, pairs, dense=True)
    assert len(dense) == len(pairs) and ((dense["count"] == 1) == (separations < 0)).all()


def test_pairs_are_found_wherever_they_may_be(scene, random):
    shapes, bodies = scene.shapes, scene.bodies
    every = np.array([(a, b) for a in range(300) for b in range(a + 1, 300)], np.uint32)
    touching, pairs = narc.overlaps(shapes, bodies)
    assert (pairs[touching] == every[narc.overlaps(shapes, bodies, every)]).all() and touching.any()
    gaps, pairs = narc.separations(shapes, bodies, margin=0.7)
    expected = narc.separations(shapes, bodies, every)
    assert (pairs[gaps < 0.7] == every[expected < 0.7]).all() and (gaps[gaps < 0.7] == expected[expected < 0.7]).all()
    motion, angle = random.normal(0, 3, (300, 2)), random.normal(0, 2, 300)
    for turn in (None, angle):
        hits, pairs = narc.casts(shapes, bodies, motion, angle=turn, target=0.2)
        expected = narc.casts(shapes, bodies, motion, every, angle=turn, target=0.2)
        where = np.flatnonzero(expected["count"])
        assert (pairs[hits["count"] > 0] == every[where]).all() and (hits["fraction"][hits["count"] > 0] == expected["fraction"][where]).all()
        assert (pairs[hits["count"] > 0][:, 0] >= 0).sum() > 300
    world = np.arange(300, dtype=np.uint32) % 4
    rows, pairs = narc.contacts(shapes, bodies, world=world, margin=0.2)
    assert (world[pairs[:, 0]] == world[pairs[:, 1]]).all() and len(rows) > 10
    expected, found = narc.contacts(shapes, bodies, margin=0.2)
    a, b = found[expected["pair"]].T
    assert (pairs[rows["pair"]] == found[expected["pair"]][world[a] == world[b]]).all()
    far = bodies.copy()
    far["xy"] += 2.0**30
    assert len(narc.manifolds(shapes, far, origin=(2.0**30, 2.0**30))[1]) < 2 * len(narc.manifolds(shapes, bodies)[1])


def test_lists_are_columns(scene):
    shapes, bodies = scene.shapes, scene.bodies
    plain = {"xy": bodies["xy"][:9], "cosine": bodies["cosine"][:9], "sine": bodies["sine"][:9], "scale": bodies["scale"][:9],
             "shape": bodies["shape"][:9]}
    lists = {name: column.tolist() for name, column in plain.items()}
    pairs = [[0, 1], [3, 4], (2, 8)]
    expected = narc.separations(shapes, plain, np.array(pairs))
    assert (narc.separations(shapes, lists, pairs) == expected).all()
    assert (narc.separations(shapes, lists, ((0, 1), (3, 4), (2, 8))) == expected).all()
    margins = [float(expected[0]) + 1, -99, 0.0]
    assert list(narc.contacts(shapes, lists, pairs, margins=margins)["pair"]) == list(
        narc.contacts(shapes, plain, pairs, margins=np.float32(margins))["pair"])
    index = narc.Index(shapes, lists)
    assert (index.regions([[0, 0, 30, 30], [0, 0, 1, 1]]) == index.regions(np.float32([[0, 0, 30, 30], [0, 0, 1, 1]]))).all()
    ways = [[30, 0], [0, 30], [-1, 2.5]]
    assert (index.rays((3, 3), ways) == index.rays(np.array([(3, 3)] * 3), np.float32(ways))).all()
    assert (narc.distances(shapes, lists, [[0, 0], [1, 1]], [3, 4]) == narc.distances(shapes, plain, np.eye(2)[[0, 0]] * [0, 0] + [[0], [1]],
                                                                                  np.array([3, 4]))).all()
    assert index.nearest((3, 4)).tobytes() == index.nearest([[3, 4]]).tobytes() and narc.inside(shapes, lists, (3, 4), 0).shape == (1,)
    for wrong, words in (([[0, 1], [2]], "pairs: "), ([[0.5, 1]], "pairs: a list of whole numbers is wanted, not of float64"),
                         (["ab"], "pairs: a list of whole numbers is wanted"), ([[0, -1]], "pairs.*item 0 is -1")):
        with pytest.raises((TypeError, ValueError), match=words):
            narc.contacts(shapes, bodies, wrong)
    for name, wrong in (("cosine", ["one"] * 9), ("scale", [1j] * 9), ("shape", [0.5] * 9), ("shape", [-1] * 9), ("xy", [[1, 2, 3]] * 9),
                        ("sine", [[1, 2], [3]])):
        with pytest.raises((TypeError, ValueError), match=f"bodies.{name}"):
            narc.validate(shapes, {**lists, name: wrong})
    with pytest.raises(narc.OutOfRange, match="kind: item 0 is 300"):
        narc.pairs(shapes, bodies, kind=[300] * 300)


REFUSED = [
    (lambda s: narc.contacts(s.shapes, s.bodies, np.zeros((3, 2))), TypeError, "pairs: uint32 is wanted, not float64"),
    (lambda s: narc.contacts(s.shapes, s.bodies, np.zeros((3, 3), np.uint32)), ValueError, r"pairs: the shape is to be \(n, 2\)"),
    (lambda s: narc.contacts(s.shapes, s.bodies, np.zeros(6, np.uint32)), ValueError, r"pairs: the shape is to be \(n, 2\)"),
    (lambda s: narc.contacts(s.shapes, s.bodies, np.zeros((3, 2), ">u4")), TypeError, "pairs: .*another order of bytes"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 300]]), narc.OutOfRange, "pair 0: body b is 300"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, -1]]), narc.OutOfRange, "pairs: item 0 is -1"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 2**32]]), narc.OutOfRange, "pairs: item 0 is 4294967296"),
    (lambda s: narc.contacts(s.shapes, {"xy": np.zeros((3, 2)), "cosine": np.ones(3)}, [[0, 1]]), TypeError,
     "bodies.cosine: float32 is wanted, not float64"),
    (lambda s: narc.contacts(s.shapes, {"xy": np.zeros((3, 2)), "cosine": np.ones(4, "f4")}, [[0, 1]]), ValueError,
     "bodies.cosine has 4 items, where there are 3"),
    (lambda s: narc.contacts(s.shapes, {"xy": np.zeros((3, 2), "f4").T}, [[0, 1]]), ValueError, "bodies.xy"),
    (lambda s: narc.contacts(s.shapes, {"mass": np.zeros(3)}, [[0, 1]]), TypeError, "bodies: there is no mass"),
    (lambda s: narc.contacts(s.shapes, np.zeros(3, [("p", "f8")]), [[0, 1]]), TypeError, "bodies: records have no field"),
    (lambda s: narc.contacts(s.shapes, "bodies", [[0, 1]]), TypeError, "bodies"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], margins=np.zeros(2, "f4")), ValueError, "query.margins has 2 items"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], margin="wide"), TypeError, "query.margin: a number"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], colour=1), TypeError, "query: there is no colour"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], row_stride=400), TypeError, "query.row_stride can't be given"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], reserved=1), TypeError, "query.reserved can't be given"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], threads=0), ValueError, "threads is 0"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], threads=10000), ValueError, "threads is 10000"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], margin=np.nan), narc.Error, "margin"),
    (lambda s: narc.contacts(s.shapes, s.bodies, margin=np.inf), ValueError, "margin"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], out=np.zeros(1)), TypeError, "out"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[k, k] for k in range(9)], out=np.zeros(3, narc.CONTACT)), ValueError,
     "out has 3 rows, 9 are needed"),
    (lambda s: narc.contacts(None, s.bodies, [[0, 1]]), TypeError, "shapes: a narc.Shapes is wanted"),
    (lambda s: narc.pairs(s.shapes, s.bodies, others=s.bodies, kind=np.zeros(300, "u1")), TypeError, "kind: filters"),
    (lambda s: narc.pairs(s.shapes, s.bodies, kind=256), ValueError, "filter.kind: 256 is out of range"),
    (lambda s: narc.pairs(s.shapes, s.bodies, world=-1), ValueError, "filter.world: -1 is out of range"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], count=-1), ValueError, "query.count: -1 is out of range"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], first=2**64), ValueError, "query.first: 18446744073709551616 is out"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], margin=10**400), ValueError, "query.margin: 1000"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], margin=1e300), ValueError, "query.margin: 1e.300 is out of range"),
    (lambda s: narc.Index(s.shapes, s.bodies).nearest([[0, 0]], distance=1e-50), ValueError, "options.distance: 1e-50 is out of"),
    (lambda s: narc.overlaps(s.shapes, s.bodies, {"ab": [[0, 1]], "other_bodies": s.bodies}), TypeError, "pairs: other_bodies"),
    (lambda s: narc.contacts(s.shapes, s.bodies, np.zeros((1, 3), "u4")), ValueError, r"pairs: the shape is to be .n, 2., not .1, 3."),
    (lambda s: narc.contact(s.shapes, [[0.0, 0, 1, 0]], [[0.1, 0, 1, 0]]), TypeError, "a: rows of narc_body are wanted"),
    (lambda s: narc.impact(s.shapes, *s.bodies[:2], motion_b=(1, 2)), ValueError, r"motion_b: the shape is to be \(3,\), not \(2,\)"),
    (lambda s: narc.impact(s.shapes, *s.bodies[:2], ("a", 0, 0)), TypeError, "numbers are wanted"),
    (lambda s: narc.impact(s.shapes, *s.bodies[:2], target=np.nan), narc.Error, "options.target is nan"),
    (lambda s: narc.impact(s.shapes, *s.bodies[:2], threads=2), TypeError, "threads"),
    (lambda s: narc.pairs(s.shapes, s.bodies, kind=np.full(300, 256)), narc.OutOfRange, "filter.kind: item 0 is 256"),
    (lambda s: s.shapes.circle("wide"), TypeError, "radius: a number is wanted, not 'wide'"),
    (lambda s: s.shapes.regular(3.5, 1), TypeError, "corners: a whole number is wanted, not 3.5"),
    (lambda s: s.shapes.remove("box"), TypeError, "shape: a whole number is wanted, not 'box'"),
    (lambda s: narc.mass(np.zeros((100, 5))), narc.Error, "1 to 64 arcs"),
    (lambda s: narc.mass(np.zeros(2, [("radius", "f8")])), TypeError, "arcs: the fields center, radius, start, end are wanted"),
    (lambda s: narc.contains(s.shapes.arcs(0), [[np.nan, 0]]), narc.Error, "not finite"),
    (lambda s: narc.depths(s.shapes.arcs(0), [[0, np.inf]]), narc.Error, "not finite"),
    (lambda s: narc.bounding_box(s.shapes.arcs(0), np.nan), narc.Error, "not finite"),
    (lambda s: narc.bodies([[1j, 2]]), TypeError, "xy: numbers are wanted, not complex128"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], count=1.5), TypeError, "query.count: a number is wanted, not 1.5"),
    (lambda s: narc.contacts(s.shapes, s.bodies, [[0, 1]], world=np.zeros(300, "u4")), TypeError, "world: this is for pairs that are"),
    (lambda s: narc.separations(s.shapes, s.bodies), ValueError, "margin: without pairs it must be finite"),
    (lambda s: narc.Index(s.shapes, s.bodies).rays((0, 0), [["a", "b"]]), TypeError, "motion"),
    (lambda s: narc.Index(s.shapes, s.bodies).nearest([1, 2, 3]), ValueError, r"points: the shape is to be \(n, 2\)"),
    (lambda s: narc.contacts(s.shapes, np.zeros(3, narc.MANIFOLD), [[0, 1]]), TypeError, "format is narc_manifold"),
    (lambda s: narc._narc.compute_mass(s.shapes.arcs(0), np.zeros(0, narc.MASS)), ValueError, "out has 0 rows, 1 are needed"),
    (lambda s: narc._narc.build_box(1, 1, 0, np.zeros(4, narc.ARC)), ValueError, "out has 4 rows, 64 are needed"),
    (lambda s: narc._narc.compute_boxes(s.shapes, s.bodies, None, np.zeros(9, narc.BOX)), ValueError, "out has 9 rows"),
    (lambda s: narc._narc.find_overlaps(s.shapes, s.bodies, np.zeros((65, 2), "u4"), None, np.zeros(1, "u8")), ValueError,
     "out has 1 rows, where there are 2"),
    (lambda s: narc.bodies([1, 2, 3]), ValueError, "xy: the shape"),
    (lambda s: narc.bodies([[1, 2]], "east"), TypeError, "angle: numbers are wanted"),
    (lambda s: narc.bodies([[1, 2]], scale=[1, 2]), ValueError, r"scale: the shape is to be \(1,\), not \(2,\)"),
    (lambda s: narc.bodies([[1, 2]], shape=0.5), TypeError, "shape: whole numbers are wanted"),
    (lambda s: narc.bodies([[1, 2]], shape=-1), narc.OutOfRange, "shape: -1 to -1"),
    (lambda s: narc.contacts(s.bodies, s.shapes), TypeError, "shapes: a narc.Shapes is wanted, not <class 'numpy.ndarray'>"),
    (lambda s: narc.contacts(s.shapes, s.bodies, margin="3"), TypeError, "margin: a number is wanted"),
    (lambda s: s.shapes.arcs(-1), narc.OutOfRange, "shape is -1"),
    (lambda s: s.shapes.remove(2**70), IndexError, "shape is 1180591620717411303424"),
    (lambda s: narc._narc.compute_mass(np.frombuffer(bytes(81), "u1")[1:].view(narc.ARC), np.zeros(1, narc.MASS)), ValueError,
     "arcs: its rows lie"),
    (lambda s: narc.place_parts(s.bodies, s.bodies[:5], np.zeros(4, np.uint32)), ValueError, "owner has 4 items"),
]


@pytest.mark.parametrize("call,kind,words", REFUSED, ids=range(len(REFUSED)))
def test_wrong_calls_name_the_argument(scene, call, kind, words):
    with pytest.raises(kind, match=words):
        call(scene)


def test_read_only_outputs_are_refused(scene):
    out = np.zeros(5, narc.CONTACT)
    out.flags.writeable = False
    with pytest.raises(ValueError, match="out"):
        narc.contacts(scene.shapes, scene.bodies, [[0, 1]], out=out)
    scene.bodies.flags.writeable = False
    narc.contacts(scene.shapes, scene.bodies, [[0, 1]])


def test_types_and_values_that_lie_are_refused(scene):
    class Liar(np.ndarray):
        dtype = property(lambda self: narc.BODY)

    with pytest.raises(TypeError, match="bodies: items of 1 bytes are no rows of narc_body"):
        narc.validate(scene.shapes, np.zeros(64, np.uint8).view(Liar))

    class Eraser:
        def __float__(self):
            bodies.clear()
            raise ValueError

        def __repr__(self):
            return "gone"

    for _ in range(20):
        bodies = {"cosine": Eraser(), "xy": np.zeros((3, 2)), "sine": 0.0}
        with pytest.raises(TypeError, match="bodies.cosine: a number or an array is wanted, not gone"):
            narc.validate(scene.shapes, bodies)


def test_errors_have_numbers(scene):
    with pytest.raises(narc.Error) as caught:
        narc.contacts(scene.shapes, scene.bodies, [[0, 1], [2, 900]])
    assert (caught.value.status, caught.value.index, caught.value.value) == ("NARC_ERROR_INDEX", 1, 900)
    with pytest.raises(narc.OutOfRange) as caught:
        narc.distances(scene.shapes, scene.bodies, np.zeros((3, 2)), np.array([1, 2, -5]))
    assert (caught.value.status, caught.value.index, caught.value.value) == ("NARC_ERROR_INDEX", 2, -5)
    scene.bodies["cosine"][9] = 3
    with pytest.raises(narc.Error, match="body 9"):
        narc.validate(scene.shapes, scene.bodies)


def test_broken_bodies_are_told_of(scene):
    scene.bodies["xy"][4] = np.nan
    with pytest.warns(narc.NoAnswer, match="2 of") as told:
        narc.contacts(scene.shapes, scene.bodies, [[4, 5], [6, 7], [8, 4]])
    with pytest.warns(narc.NoAnswer) as also:
        narc.contacts(scene.shapes, scene.bodies)
    assert {one.filename for one in (*told, *also)} == {__file__}


def test_nothing_is_an_answer_too(scene):
    none = np.zeros((0, 2), np.uint32)
    assert len(narc.contacts(scene.shapes, scene.bodies, none)) == len(narc.overlaps(scene.shapes, scene.bodies, none)) == 0
    assert len(narc.contacts(scene.shapes, scene.bodies[:0])[0]) == 0
    assert len(narc.contacts(scene.shapes, scene.bodies, [])) == 0


def test_threads_give_the_same_bytes(random):
    shapes = narc.Shapes()
    box = shapes.box(2, 1)
    bodies = narc.bodies(random.random((20000, 2)) * 150, random.random(20000) * 7, box)
    one = narc.manifolds(shapes, bodies)
    for threads in (2, 5):
        many = narc.manifolds(shapes, bodies, threads=threads)
        assert one[0].tobytes() == many[0].tobytes() and (one[1] == many[1]).all()


def test_rows_come_in_any_order_and_from_other_programs(scene):
    box = scene.shapes.arcs(0)
    turned = np.zeros(len(box), [("end", "f8"), ("start", "f4"), ("center", "f8", 2), ("radius", "f8")])
    for name in narc.ARC.names:
        turned[name] = box[name]
    assert narc.mass(turned)["area"] == pytest.approx(narc.mass(box)["area"], rel=1e-6)
    a, b = pickle.loads(pickle.dumps(scene.bodies))[:2]
    assert narc.contact(scene.shapes, a, b, margin=np.inf) == narc.contact(scene.shapes, *scene.bodies[:2], margin=np.inf)
    places = [[0.0, 0], [1, 0]]
    for bodies in (places, np.array(places), np.array([(p,) for p in places], [("xy", "f8", 2)])):  # none is turned
        assert (narc.boxes(scene.shapes, bodies) == narc.boxes(scene.shapes, narc.bodies(places))).all()
    one = collections.OrderedDict(xy=np.zeros((1, 2)), cosine=1.0, sine=0.0, scale=1.0, shape=0)
    assert len(narc.boxes(scene.shapes, one)) == 1 and len(narc.pairs(scene.shapes, one)) == 0


def test_nothing_is_asked_of_nothing(scene):
    none = narc.bodies(np.zeros((0, 2)))
    for ask in (narc.contacts, narc.manifolds, narc.overlaps):
        assert [len(found) for found in ask(scene.shapes, none)] == [0, 0] and len(ask(scene.shapes, scene.bodies, [])) == 0
    assert [len(found) for found in narc.casts(scene.shapes, none, np.zeros((0, 2)))] == [0, 0]
    assert len(narc.casts(scene.shapes, scene.bodies, np.zeros((300, 2)), [])) == 0
    index = narc.Index(scene.shapes, scene.bodies)
    assert len(narc.box_pairs([])) == len(index.regions([])) == len(index.nearest([])) == len(index.rays([], [])) == 0
    index.update(threads=2)


def test_errors_have_their_numbers(scene):
    for call in (lambda: scene.shapes.arcs(-1), lambda: narc.bodies([[0, 0]], shape=-1)):
        with pytest.raises(narc.OutOfRange) as caught:
            call()
        assert (caught.value.status, caught.value.index, caught.value.value) == ("NARC_ERROR_INDEX", 0, 0.0)
