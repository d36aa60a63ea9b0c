# SPDX-License-Identifier: MIT
"""The examples do what they are for."""

import importlib.util
import pathlib

import numpy as np
import pytest

import narc

FOLDER = pathlib.Path(__file__).parent.parent / "examples"


def load(name):
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_robot_maps_what_is_there():
    shapes, bodies, path, seen, _ = load("lidar").drive(steps=25)
    index = narc.Index(shapes, bodies)
    assert len(seen) > 5000 and (index.nearest(path)["separation"] > 0).all()
    still = load("lidar").drive(steps=1)  # of one scan all points lie on outlines
    near = narc.Index(still[0], still[1]).nearest(still[3])
    assert np.abs(near["separation"]).max() < 1e-4


def test_parts_are_pushed_apart():
    packing = load("packing")
    shapes, parts, walls, areas = packing.make_parts(np.random.default_rng(1), share=0.5)
    depths = packing.push_apart(shapes, parts, walls, areas, steps=200)
    assert depths[0] > 1 and depths[-1] < 0.05
    assert packing.deepest(shapes, parts, walls) < 0.05


def test_worlds_are_stepped_and_rewarded():
    worlds = load("worlds")
    some = worlds.Worlds(64, threads=2)
    seen, _ = some.reset()
    assert seen.shape == (64, worlds.RAYS + 2)
    reached = 0
    for _ in range(80):
        seen, reward, terminated, truncated, _ = some.step(worlds.policy(seen))
        reached += terminated.sum()
    place = (some.bodies["xy"].reshape(64, -1, 2) - some.corner[:, None])
    assert reached > 20 and place.min() >= 0.39 and place.max() <= worlds.SIDE - 0.39 and not truncated.any()
    rows = narc.contacts(some.shapes, some.bodies)[0]
    assert rows["separation"].min() > -0.35


def test_grains_come_to_rest_in_a_pile():
    dem = load("dem")
    rough, smooth = dem.Pile(50), dem.Pile(50, friction=0.0)
    for pile in (rough, smooth):
        found, push = pile.settle(3000)
        assert -found.rows["separation"].min() < 0.03
    assert rough.place[:-1, 1].max() > 1.4 * smooth.place[:-1, 1].max() and (rough.place[:-1, 1] > 0).mean() > 0.9
    assert len(rough.step()[0].pairs) > 50 and rough.energy() < 5e-2 and max(angle for angle, _ in rough.slopes()) > 10


def test_a_drawing_is_bounded_and_cut():
    pytest.importorskip("narc._fit")
    drawing = load("drawing")
    outline = narc.Outline.read(FOLDER / "drawing.svg")
    whole = drawing.fit_whole(outline, (4, 6))
    assert 0 < whole[6].area - whole[6].hull_area < whole[4].area - whole[4].hull_area
    assert len(narc.cut(outline, 5)) > 3


@pytest.mark.parametrize("name", ["dem", "lidar", "packing", "worlds"])
def test_pictures_are_drawn(name, tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    module = load(name)
    if name == "lidar":
        monkeypatch.setattr(module, "drive", lambda drive=module.drive: drive(steps=4))
    if name == "packing":
        monkeypatch.setattr(module, "push_apart", lambda *given, push=module.push_apart: push(*given, steps=4))
    more = {"worlds": {"count": 64, "steps": 3}, "dem": {"count": 24, "steps": 1500}}.get(name, {})
    module.main(str(tmp_path / "picture.png"), **more)
    assert (tmp_path / "picture.png").stat().st_size > 20000
