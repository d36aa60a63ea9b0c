# SPDX-License-Identifier: MIT
"""Shapes, scenes and steps."""

import pickle
import subprocess
import sys

import numpy as np
import pytest

import narc


def test_tables_are_those_of_the_library():
    assert narc.CONTACT.itemsize == 36 and narc.MANIFOLD.itemsize == 64 and narc.BODY.itemsize == 32
    assert narc.CONTACT.fields["normal"][1] == 12 and narc.MANIFOLD["point"].base["separation"] == np.float32
    assert narc.BODY.names == ("xy", "cosine", "sine", "scale", "shape")
    assert narc.CONSTANTS["NARC_MAX_ARCS"] == 64 and narc.CONSTANTS["NARC_ERROR_BOUND"] == 32 / 2**24


def test_shapes_have_the_areas_of_formulas():
    shapes = narc.Shapes()
    square = np.array([[0, 0], [2, 0], [2, 2], [0, 2]], float)
    for shape, area in ((shapes.circle(2), 4 * np.pi), (shapes.box(3, 2), 6), (shapes.capsule(4, 1), 8 + np.pi),
                        (shapes.polygon(square), 4), (shapes.polygon(square, skin=1), 4 + 8 + np.pi),
                        (shapes.box(3, 2, 0.5), 6 - 1 + np.pi / 4), (shapes.ellipse(3, 2, 32), 6 * np.pi),
                        (shapes.segment([[0, 0], [3, 4]], 1), 10 + np.pi), (shapes.regular(4, 1), 2)):
        assert shapes.mass(shape)["area"] == pytest.approx(area, rel=1e-5)
    assert shapes.box(3, 2) == 1 and shapes.uses(1) == 2 and len(shapes) == 9
    shapes.remove(1)
    assert shapes.uses(1) == 1 and repr(shapes) == "<narc.Shapes: 9>"
    ring = shapes.ring([[0, 0], [4, 0], [4, 3], [2, 1.5], [0, 3]])
    assert shapes.mass(ring)["area"] > 6 and shapes.bounding_circle(ring)["radius"] > 2
    for ask in (shapes.arcs, shapes.mass, shapes.bounding_circle, shapes.as_polygon):
        with pytest.raises(IndexError, match="there is no shape 99"):
            ask(99)


def test_outlines_are_within_the_tolerance():
    shapes = narc.Shapes()
    for shape in (shapes.circle(5), shapes.box(3, 2, 0.5), shapes.ellipse(3, 1, 8), shapes.capsule(2, 1)):
        for tolerance in (1e-1, 1e-3):
            x, y = shapes.as_polygon(shape, tolerance).T
            area = 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()
            exact = shapes.mass(shape)["area"]
            assert 0 <= exact - area <= 35 * tolerance


def test_outlines_of_bodies_and_chains(random):
    arcs = narc.move([[0, 0, 2, 0, np.pi], [0, 0, 2, np.pi, 2 * np.pi]])
    body = narc.bodies([[30, 40]], angle=1, scale=0.5)[0]
    points = narc.flatten(arcs, 1e-4, body=body)
    assert np.allclose(np.linalg.norm(points - [30, 40], axis=1), 1) and len(points) > 100
    middle = (points + np.roll(points, -1, axis=0)) / 2
    assert (np.linalg.norm(middle - [30, 40], axis=1) > 1 - 1.01e-4).all()
    line = narc.flatten([[0, 0, 0, 0, 0], [3, 0, 0, 0, 0]], 1e-3, closed=False)
    assert (line == [[0, 0], [3, 0]]).all()
    with pytest.raises(narc.Error, match="tolerance"):
        narc.flatten(arcs, 0)


def test_hulls_hold_their_points():
    xy = np.random.default_rng(5).normal(size=(500, 2))
    shapes = narc.Shapes()
    hull = shapes.arcs(shapes.hull(xy, tolerance=1e-3, radius=0.25))
    assert 3 <= len(hull) <= 64 and (narc.depths(hull, xy) < -0.248).all()
    assert len(narc.flatten(hull, 1e-4)) > 64 and len(narc.flatten(hull[:1], 1e-4, closed=False)) >= 2


def test_what_is_no_shape_is_refused():
    shapes = narc.Shapes()
    for call, words in ((lambda: shapes.box(-1, 2), "width is -1"), (lambda: shapes.polygon([[0, 0], [1, 0]]), "points"),
                        (lambda: shapes.circle(np.nan), "radius"), (lambda: shapes.remove(3), "3"),
                        (lambda: shapes.add([[0, 0, 1, 0, 1]]), "turn")):
        with pytest.raises(narc.Error, match=words) as caught:
            call()
        assert caught.value.status.startswith("NARC_ERROR_")
    with pytest.raises(ValueError, match="arcs: rows of five numbers"):
        shapes.add(np.zeros((3, 4)))
    with pytest.raises(TypeError):
        shapes.circle("wide")
    assert len(shapes) == 0


def test_arcs_move_and_parts_have_a_mass():
    shapes = narc.Shapes()
    arcs = shapes.arcs(shapes.box(2, 2))
    there = narc.move(arcs, (1, 0), 0.5, 2.0)
    assert narc.mass(there)["area"] == pytest.approx(16) and np.allclose(narc.mass(there)["centroid"], [1, 0])
    assert narc.union_mass([arcs, narc.move(arcs, (1, 0))])["area"] == pytest.approx(6)
    owners = narc.bodies([[5, 5]], np.pi / 2)
    parts = narc.bodies([[1, 0], [0, 2]])
    assert np.allclose(narc.place_parts(owners, parts, np.zeros(2, np.uint32))["xy"], [[5, 6], [3, 5]], atol=1e-6)


def test_lists_of_arcs_are_asked():
    shapes = narc.Shapes()
    arcs = shapes.arcs(shapes.box(4, 2))
    narc.validate_arcs(arcs)
    with pytest.raises(narc.Error):
        narc.validate_arcs(arcs[:3])
    assert narc.perimeter(arcs) == pytest.approx(12) and narc.inscribed_circle(arcs)["radius"] == pytest.approx(1)
    assert narc.bounding_circle(arcs)["radius"] == pytest.approx(5**0.5)
    assert np.allclose(narc.bounding_box(arcs, np.pi / 2)["max"], [1, 2])
    points = np.array([[0, 0], [3, 0], [2, 1], [-1.5, 0.5]])
    assert np.allclose(narc.depths(arcs, points), [-1, 1, 0, -0.5]) and list(narc.contains(arcs, points)) == [1, 0, 1, 1]
    point, arc = narc.support(arcs, (1, 1))
    assert np.allclose(point, [2, 1]) and np.allclose(arcs[arc]["center"], point)
    assert np.allclose(narc.mirror(narc.move(arcs, (3, 0)))["center"].mean(0), [-3, 0])
    assert np.allclose(narc.mass(narc.center(narc.move(arcs, (3, 1))))["centroid"], 0)
    ring = np.array([[0, 0], [4, 0], [4, 3], [2, 3.001], [0, 3]])
    assert len(narc.weld(ring, 0.01)) == 4
    junctions = narc.adjust([[0, 0], [4, 0], [4, 3], [0, 3]])
    least, most, chosen = narc.radius_range(junctions)
    assert least < chosen < most and shapes.arcs(shapes.smooth(junctions, chosen))[0]["radius"] == pytest.approx(chosen)
    assert shapes.mass(shapes.four_arc(5, 5, 8, 0.25, 0.25))["area"] > 1
    assert shapes.add(arcs, shape=40) == 40 and shapes.uses(40) == 1
    with pytest.raises(narc.Error) as caught:
        shapes.add(arcs, shape=40)
    assert caught.value.status == "NARC_ERROR_IN_USE"
    cosine, sine = narc.poses([0.0, np.pi / 2])
    assert np.allclose(cosine, [1, 0], atol=1e-7) and np.allclose(sine, [0, 1])


def test_shapes_are_pickled():
    shapes = narc.Shapes()
    shapes.circle(1), shapes.ellipse(3, 1)
    again = pickle.loads(pickle.dumps(shapes))
    assert (again.arcs(1) == shapes.arcs(1)).all() and len(again) == 2
    kind, data = shapes.__reduce__()
    with pytest.raises(narc.Error, match="") as caught:
        kind(data[0], data[1][:-1])
    assert caught.value.status == "NARC_ERROR_FORMAT"


def test_ground_holds_balls(random):
    shapes = narc.Shapes()
    up = np.pi / 2
    entries = shapes.chain([[9, 0, 0, up, up], [0, 0, 0, up, up]])
    ground = narc.bodies(entries["xy"], shape=entries["shape"])
    ball = shapes.circle(0.5)
    balls = narc.bodies([[2, 0.4], [5, 0.7], [7, 0.45]], shape=ball)
    rows, pairs = narc.contacts(shapes, balls, others=ground)
    assert sorted(set(pairs[rows["pair"], 0])) == [0, 2] and np.allclose(rows["normal"], [0, -1], atol=1e-6)


def test_filters_stay_where_rows_need_more_room():
    shapes = narc.Shapes()
    bowl = shapes.chain([[0, 0, -5, np.pi / 2 + 0.9, np.pi / 2 - 0.9]])  # where a bar stands on both ends
    bar = shapes.box(6, 0.2)
    some = narc.bodies([*bowl["xy"], [0, -4], [0, -4]], shape=[*bowl["shape"], bar, bar])
    every, pairs = narc.contacts(shapes, some)
    assert len(pairs) == 3 and len(every) == 5
    rows, pairs = narc.contacts(shapes, some, world=np.array([1, 1, 2], np.uint32))
    assert pairs.tolist() == [[0, 1]] and rows["pair"].tolist() == [0, 0]


def test_steps_that_are_kept_stay_what_they_were(scene):
    contacts, kept = narc.Contacts(), []
    for _ in range(8):
        scene.bodies["xy"] += 0.05 * (np.arange(600).reshape(-1, 2) % 7)
        step = contacts.update(scene.shapes, scene.bodies, margin=0.1)
        kept.append((step.rows[1:], step.rows[1:].copy(), step.pairs, step.pairs.copy()))
        del step
    assert all((rows == own).all() and (pairs == same).all() for rows, own, pairs, same in kept)


def test_half_planes_are_ground_without_end():
    shapes = narc.Shapes()
    ground, ball = shapes.half_plane(), shapes.circle(0.5)
    assert len(shapes.arcs(ground)) == 0 and shapes.flags(ground) == narc.CONSTANTS["NARC_SHAPE_HALF_PLANE"]
    bodies = narc.bodies([[0, 0], [1e6, 0.4], [3, 2]], shape=[ground, ball, ball])
    rows, pairs = narc.contacts(shapes, bodies)
    assert pairs[rows["pair"]].tolist() == [[0, 1]] and rows["separation"] == pytest.approx(-0.1, abs=1e-6)
    hits, pairs = narc.casts(shapes, bodies, [[0, 0], [0, 0], [0, -3]], angle=[0, 0, 1])
    assert pairs[hits["count"] > 0].tolist() == [[0, 1], [0, 2]] and hits["fraction"][-1] == pytest.approx(0.5, abs=1e-3)
    alone = narc.impact(shapes, bodies[0], bodies[2], motion_b=(0, -3, 1))
    assert alone["body"] == 1 and alone["fraction"] == hits["fraction"][-1]


def circle_scene(random, count=400):
    shapes = narc.Shapes()
    bodies = narc.bodies(random.random((count, 2)) * 60, shape=shapes.circle(1.0))
    return shapes, bodies


def test_rays_meet_circles_where_a_formula_says(random):
    shapes, bodies = circle_scene(random)
    index = narc.Index(shapes, bodies)
    turn = random.random(500) * 7
    motion = (np.stack([np.cos(turn), np.sin(turn)], 1) * 80).astype(np.float32)
    start = random.random((500, 2)) * 60
    hits = index.rays(start, motion, inside=2)
    to = bodies["xy"][None] - start[:, None]
    length = np.linalg.norm(motion, axis=1)[:, None]
    along = (to * (motion / length)[:, None]).sum(-1)
    beside = (to**2).sum(-1) - along**2
    at = along - np.sqrt(np.maximum(1 - beside, 0))
    fraction = np.where((beside < 1) & (at > 0) & ((to**2).sum(-1) > 1), at / length, np.inf)
    first = fraction.min(1)
    clear = np.abs(beside - 1).min(1) > 1e-3
    hit = clear & (first < 1)
    assert hit.sum() > 200 and (hits["count"][clear] == (first[clear] < 1)).all()
    assert np.allclose(hits["fraction"][hit], first[hit], atol=1e-5)
    assert (hits["body"][hit] == fraction.argmin(1)[hit]).all()
    again = narc.rays(shapes, bodies, start, motion, hits["body"], inside=2)
    assert (again["fraction"] == hits["fraction"])[hits["count"] == 1].all()
    far = narc.bodies(bodies["xy"] + 1e9, shape=bodies["shape"])
    same = narc.Index(shapes, far, origin=(1e9, 1e9)).rays(start + 1e9, motion, inside=2)
    assert (same["body"] == hits["body"])[hit].mean() > 0.99
    with pytest.raises(TypeError, match="options.origin"):
        narc.Index(shapes, far, origin=(1, "far"))
    fan = index.rays((30, 30), motion, most=3, threads=3)
    assert fan.shape == (500, 3) and (fan["fraction"][:, 1] >= fan["fraction"][:, 0])[fan["count"][:, 1] == 1].all()
    assert index.rays(np.float32([[30, 30]]), motion[:1]).shape == (1,)


def test_nearest_and_regions_are_as_numpy_says(random):
    shapes, bodies = circle_scene(random)
    index = narc.Index(shapes, bodies)
    points = random.random((300, 2)) * 60
    distance = np.linalg.norm(bodies["xy"][None] - points[:, None], axis=-1) - 1
    near = index.nearest(points)
    assert np.allclose(near["separation"], distance.min(1), atol=1e-5) and (near["count"] == 1).all()
    three = index.nearest(points, most=3)
    assert np.allclose(three["separation"], np.sort(distance, 1)[:, :3], atol=1e-5)
    same = narc.distances(shapes, bodies, points, near["body"])
    assert (same["separation"] == near["separation"]).all()
    masks = np.where(np.arange(len(bodies)) % 2, 1, 2).astype(np.uint64)
    odd = narc.Index(shapes, bodies, category=masks).nearest(points, mask=1)
    assert (odd["body"] % 2 == 1).all()
    with pytest.raises(ValueError, match="owners.owner has 3 items"):
        index.nearest(points, owners={"owner": np.zeros(3, np.uint32)})
    boxes = np.float32([[0, 0, 10, 10], [50, 50, 70, 70]])
    found = index.regions(boxes)
    inside = [((bodies["xy"] >= box[:2] - 1) & (bodies["xy"] <= box[2:] + 1)).all(1) for box in boxes]
    assert (found == np.argwhere(inside)).all()
    deep = narc.inside(shapes, bodies, points, near["body"])
    assert (deep == (near["separation"] < 0))[np.abs(near["separation"]) > 1e-4].all() and deep.any()
    bodies["xy"][:100] += 100
    index.update(changed=np.arange(100))
    assert (index.regions(boxes) == [row for row in found if row[1] >= 100]).all()
    bodies["xy"] += 100
    index.update()
    assert len(index.regions(boxes)) == 0 and repr(index) == "<narc.Index of 400 bodies>"
    index.update(bodies[:50].copy())
    assert len(index) == 50 and index.statistics()["bodies"] == 50
    tree = index.statistics()
    levels = [index.nodes(level) for level in range(tree["depth"])]
    assert sum(map(len, levels)) == tree["nodes"] and len(levels[0]) == tree["leaves"] and len(index.nodes(tree["depth"])) == 0
    of = narc.boxes(shapes, bodies[:50])
    assert len(levels[-1]) == 1 and (levels[-1]["min"][0] == of["min"].min(0)).all() and (levels[-1]["max"][0] == of["max"].max(0)).all()


def test_bodies_that_come_bring_their_worlds(random):
    shapes, bodies = circle_scene(random)
    world = np.arange(len(bodies), dtype=np.uint32) % 3
    index = narc.Index(shapes, bodies[:100], world=world[:100])
    with pytest.raises(ValueError, match="options.world has 100 items, where there are 400"):
        index.update(bodies)
    assert len(index) == 100 and (index.nearest(bodies["xy"][:9], world=0)["body"] % 3 == 0).all()
    index.update(bodies, np.zeros(0, np.uint32), world=world)
    near = index.nearest(bodies["xy"], world=world)
    assert (near["count"] == 1).all() and (near["body"] % 3 == world).all() and near["body"].max() > 300
    index.update()
    assert (index.nearest(bodies["xy"], world=world) == near).all()


def test_casts_hit_when_circles_meet():
    shapes = narc.Shapes()
    ball = shapes.circle(1.0)
    bodies = narc.bodies([[0, 0], [10, 0]], shape=ball)
    hit = narc.casts(shapes, bodies, np.float32([[16, 0], [0, 0]]), np.array([[0, 1]]))
    assert hit["count"][0] == 1 and hit["fraction"][0] == pytest.approx(0.5, abs=1e-6)
    index = narc.Index(shapes, bodies)
    movers = narc.bodies([[5, 9], [5, -9]], shape=ball)
    hits = index.casts(movers, np.float32([[0, -20], [100, 0]]))
    assert (hits["count"] == 0).all()
    assert index.casts(movers, np.float32([[-10, -18], [0, 0]]))["count"][0] == 1


def test_steps_have_the_rows_of_batches(scene):
    contacts = narc.Contacts()
    for step in range(5):
        scene.bodies["xy"] += 0.05
        scene.bodies["xy"][::3] += 0.1
        r = contacts.update(scene.shapes, scene.bodies, margin=0.02, skin=0.05)
        rows, pairs = narc.manifolds(scene.shapes, scene.bodies, margin=0.02)
        assert (r.pairs == pairs[rows["pair"]]).all() and (r.rows["normal"] == rows["normal"]).all()
        assert len(set(r.slots)) == len(r.slots) and (r.rows["pair"] == r.slots).all()
        if step == 0:
            assert len(r.began) == len(r.slots) and len(r.ended) == 0
    body = int(r.pairs[0, 0])
    assert set(r.slots[(r.pairs == body).any(1)]) <= set(contacts.slots_of(body))
    data = contacts.save()
    again = narc.Contacts()
    assert again.load(scene.shapes, data).rows.tobytes() == r.rows.tobytes()
    scene.bodies["xy"][::2] += 0.2
    one, other = (c.update(scene.shapes, scene.bodies, margin=0.02, skin=0.05) for c in (contacts, again))
    assert all(np.array_equal(a, b) for a, b in zip(one, other))
    still = np.full(len(scene.bodies), narc.CONSTANTS["NARC_STATIC"], np.uint8)
    contacts.forget()
    one_thing = np.zeros(len(scene.bodies), np.uint32)
    assert len(contacts.update(scene.shapes, scene.bodies, owner=one_thing).slots) == 0
    assert len(contacts.update(scene.shapes, scene.bodies, margin=0.02, kind=still).slots) == 0
    with pytest.raises(ValueError, match="rows is"):
        narc.Contacts("points")


def test_the_module_tells_of_itself():
    text = subprocess.run([sys.executable, "-m", "narc"], check=True, capture_output=True, text=True).stdout
    assert narc.__version__ in text and "narc_contact" in text
    before = narc.get_isa()
    with pytest.raises(narc.Error):
        narc.set_isa("abacus")
    narc.set_isa("scalar")
    assert narc.get_isa() == "scalar"
    narc.set_isa(before)


def test_what_is_kept_stays_with_its_pair(random):
    shapes = narc.Shapes()
    ball = shapes.circle(0.6)
    bodies = narc.bodies(np.stack([np.arange(40.0), np.zeros(40)], 1), shape=ball)
    contacts = narc.Contacts("contacts", user=[("impulse", "f4", 2), ("age", "u4")])
    with pytest.raises(narc.Error, match="no step"):
        contacts.user([0])
    ages = {}
    for _ in range(30):
        bodies["xy"][:, 1] = random.normal(0, 0.4, 40)
        step = contacts.update(shapes, bodies, skin=3.0)
        kept = contacts.user(step.slots)
        assert [int(age) for age in kept["age"]] == [ages.get((a, b), 0) for a, b in step.pairs.tolist()]
        kept["age"] += 1
        contacts.keep(step.slots, kept)
        ages.update({(a, b): int(age) for (a, b), age in zip(step.pairs.tolist(), kept["age"])})
    assert max(ages.values()) > 5
    with pytest.raises(narc.OutOfRange, match="slot 99999"):
        contacts.user([99999])
    with pytest.raises(TypeError, match="user is"):
        narc.Contacts(user="O")
    contacts.forget()
    with pytest.raises(narc.Error, match="no step"):
        contacts.keep([0], ((0, 0), 0))


def test_slots_and_ids_are_whole_numbers(scene):
    contacts = narc.Contacts("contacts", user="f4")
    step = contacts.update(scene.shapes, scene.bodies)
    contacts.keep(step.slots, 7.0)
    for slots in ([2**32], [-2**32], np.array([2**32])):
        with pytest.raises(narc.OutOfRange, match="slots: there are no numbers"):
            contacts.user(slots)
    for call in (lambda: contacts.user([0.7]), lambda: contacts.forget([0.5]), lambda: contacts.keep([0.5], 1)):
        with pytest.raises(TypeError, match="whole numbers"):
            call()
    with pytest.raises(ValueError, match=r"slots: the shape is to be \(n,\)"):
        contacts.keep(step.pairs, 1)


class OwnIndex(narc.Index):
    pass


def test_children_of_an_index_stay_what_they_are(scene):
    again = pickle.loads(pickle.dumps(OwnIndex(scene.shapes, scene.bodies)))
    assert type(again) is OwnIndex and len(again) == 300


def test_plots_have_arcs():
    pyplot = pytest.importorskip("matplotlib.pyplot")
    shapes = narc.Shapes()
    figure, axis = pyplot.subplots()
    drawn = narc.plot.draw_arcs(axis, shapes.arcs(shapes.circle(2)))
    line = drawn.get_paths()[0].vertices
    assert np.allclose(line[0], line[-1]) and np.allclose(np.hypot(*line.T), 2, atol=0.02)
    assert len(narc.plot.draw_arcs(axis, [[0, 0, 1, 0, 1]], closed=False).get_paths()[0].vertices) > 3
    pyplot.close(figure)
