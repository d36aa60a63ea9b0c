# SPDX-License-Identifier: MIT
"""Outlines, fits, parts, chains and shapes files, beside closed forms."""

import os
import pathlib
import signal
import threading
import time

import numpy as np
import pytest

import narc

pytest.importorskip("narc._fit", reason="built without the fit library")

HERE = pathlib.Path(__file__).parent.parent
L_SHAPE = np.array([[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]], float)


def circle(count=400, radius=2.0):
    angle = np.arange(count) * 2 * np.pi / count
    return radius * np.stack([np.cos(angle), np.sin(angle)], 1)


def area(points):
    x, y = points.T
    return 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()


def test_a_fit_bounds_what_it_is_of():
    fit = narc.fit(L_SHAPE, 6)
    assert len(fit.arcs) <= 6 and fit.hull_area == pytest.approx(9) and fit.area >= 9 and fit.clearance > 0
    assert narc.depths(fit.arcs, L_SHAPE - fit.origin).max() < 0
    assert narc.mass(fit.arcs)["area"] == pytest.approx(fit.area)
    assert narc.Shapes().add(fit.arcs) == 0


def test_cuts_without_tolerance():
    parts = narc.cut_exactly(L_SHAPE)
    assert len(parts) == 2 and sum(part.area for part in parts) == pytest.approx(area(np.array(L_SHAPE, float)), rel=1e-6)
    teeth = [[x, y] for k in range(39, -1, -1) for x, y in ((2 * k + 1, 0), (2 * k + 1, 1), (2 * k, 1), (2 * k, 0))]
    comb = [[-1, 0], [-1, -1], [80, -1], [80, 0], *teeth]
    parts = narc.cut_exactly(comb)
    assert len(parts) > 16 and sum(part.area for part in parts) == pytest.approx(area(np.array(comb, float)), rel=1e-6)
    with pytest.raises(narc.Error, match="cross|touch"):
        narc.cut_exactly([[0, 0], [1, 1], [1, 0], [0, 1]])


def test_plain_shapes_are_seen():
    plain = narc.fit(circle() + 1, 0, tolerance=0.01, family="plain")
    assert len(plain.arcs) == 1 and plain.arcs["radius"][0] == pytest.approx(2, abs=0.01)
    with pytest.raises(narc.Error):
        narc.fit(L_SHAPE, 0, tolerance=0.01, family="plain")


def test_few_arcs_serve_where_they_can():
    assert len(narc.fit(circle(), 0, tolerance=1e-3, goal="nearest").arcs) == 1
    box = narc.fit([[0, 0], [3, 0], [3, 1], [0, 1]], 4, family="edges")
    assert box.edge_count == 4 and box.area == pytest.approx(3, rel=2e-6)
    round_box = narc.fit([[0, 0], [3, 0], [3, 1], [0, 1]], 4, family="edges", min_radius=0.2)
    assert round_box.arcs["radius"].min() >= 0.2


def test_a_quick_fit_is_near():
    usual, quick = narc.fit(L_SHAPE, 6), narc.fit(L_SHAPE, 6, quick=True)
    assert area(L_SHAPE) < quick.area < 1.02 * usual.area
    with pytest.raises(narc.Error, match="quick fit"):
        narc.fit(L_SHAPE, 6, quick=True, starts=2)


def test_contours_come_back():
    outline = narc.Outline([circle(), circle(radius=1.0)[::-1]])
    assert [len(c) for c in outline.contours()] == [400, 400] and "contours 2" in repr(outline)
    assert np.array_equal(outline.contours()[0], circle())
    assert narc.hull(np.vstack([L_SHAPE, [[0.5, 0.5]]])).tolist() == [[0, 0], [4, 0], [4, 1], [1, 3], [0, 3]]


def test_parts_are_convex_and_hold_the_inside():
    parts = narc.cut(L_SHAPE, 0.01)
    polygons = [part.contours()[0] for part in parts]
    assert len(parts) == 2 and sum(map(area, polygons)) >= 6 - 1e-6
    for polygon in polygons:
        along = np.roll(polygon, -1, 0) - polygon
        after = np.roll(along, -1, 0)
        assert (along[:, 0] * after[:, 1] - along[:, 1] * after[:, 0] > -1e-9).all()


def test_chains_follow_within_the_tolerance():
    closed, = narc.fit_chains(circle(), 1e-3)
    assert len(closed) <= 4 and np.allclose(closed["radius"], 2, atol=2e-3)
    shapes = narc.Shapes()
    assert len(shapes.chain(closed, closed=1)) > 0
    # Two halves, which join smoothly. (A corner is a row of its own: more rows may be fewer pieces.)
    fewest, = narc.fit_chains(circle(), 1e-3, smooth=False)
    assert len(fewest) == 2 < len(narc.fit_chains(circle(), 1e-3)[0])
    ground, = narc.fit_chains(np.array([[3, 0], [2, 0.5], [0, 0]]), 1e-3, open=True)
    assert len(shapes.chain(ground)) > 0


def test_drawings_images_points_and_glyphs(tmp_path):
    svg = tmp_path / "two.svg"
    svg.write_text('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 10"><rect id="a" width="4" height="2"/>'
                   '<circle id="b" cx="8" cy="8" r="2"/></svg>')
    assert len(narc.Outline.read(svg).contours()) == 2
    rectangle = narc.fit(narc.Outline.read(svg, element="a"), 4, family="edges")
    assert rectangle.area == pytest.approx(8, rel=0.01)
    (tmp_path / "p.csv").write_text("x,y\n0,0\n2,0\n2,2\n")
    (tmp_path / "p.json").write_text("[[0,0],[2,0],[2,2]]")
    for name in ("p.csv", "p.json"):
        assert area(narc.Outline.read(tmp_path / name).contours()[0]) == pytest.approx(2)
    with pytest.raises(narc.OutOfRange):
        narc.Outline.read(svg, element="c")
    dxf = tmp_path / "plate.dxf"
    dxf.write_text("\n".join("0 SECTION 2 ENTITIES 0 CIRCLE 8 hole 10 3 20 1 40 2 0 ENDSEC 0 EOF".split()) + "\n")
    try:
        assert area(narc.Outline.read(dxf, element="hole").contours()[0]) == pytest.approx(4 * np.pi, rel=1e-3)
    except narc.Error as error:  # a build without dxflib
        assert "DXF" in str(error)
    pyplot = pytest.importorskip("matplotlib.pyplot")
    image = np.zeros((40, 60, 4))
    image[10:30, 10:50] = 1
    pyplot.imsave(tmp_path / "p.png", image)
    assert area(narc.Outline.read(tmp_path / "p.png").contours()[0]) == pytest.approx(800, rel=0.01)
    from matplotlib import get_data_path
    glyph = narc.Outline.glyph(pathlib.Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf"), "o")
    assert len(glyph.contours()) == 2 and 0 < np.ptp(glyph.contours()[0], 0).max() < 1


def test_files_keep_shapes(tmp_path):
    file = tmp_path / "shapes.json"
    fit, box = narc.fit(L_SHAPE, 4), narc.Shapes()
    box = box.arcs(box.box(2, 1))
    ground, = narc.fit_chains(np.array([[3, 0], [2, 0.5], [0, 0]]), 1e-3, open=True)
    narc.write_shapes(file, {"l": fit, "box": box, "hill": narc.NamedShape(ground, form="open")})
    narc.write_shapes(tmp_path / "floor.json", {"floor": narc.NamedShape(np.empty(0, narc.ARC), form="half_plane")})
    floor = narc.read_shapes(tmp_path / "floor.json")["floor"]
    assert floor.form == "half_plane" and len(floor.arcs) == 0
    read = narc.read_shapes(file)
    assert list(read) == ["l", "box", "hill"] and read["l"].origin == fit.origin and read["hill"].form == "open"
    assert (read["l"].arcs == fit.arcs).all() and (read["hill"].arcs == ground).all()
    narc.write_shapes(file, read)
    assert [(read[name].arcs == shape.arcs).all() for name, shape in narc.read_shapes(file).items()] == [True] * 3
    with pytest.raises(narc.Error, match="comma|name"):
        narc.write_shapes(file, {"a,b": fit})
    with pytest.raises(TypeError, match="arcs: the fields"):
        narc.write_shapes(file, {"a": narc.NamedShape(np.zeros(3, narc.BODY))})
    assert list(narc.read_shapes(file)) == list(read)
    circle = [[0, 0, 1, 0, 2 * np.pi]]
    narc.write_shapes(file, {"plain": circle, "rows": narc.NamedShape(np.array(circle))})
    for shape in narc.read_shapes(file).values():
        assert (shape.arcs["center"] == 0).all() and (shape.arcs["radius"], shape.arcs["end"]) == (1, 2 * np.pi)
    file.write_text('{"shapes":\n [{"name": 3}]}')
    with pytest.raises(narc.Error) as raised:
        narc.read_shapes(file)
    assert raised.value.__notes__ == [f"in {file}"] and raised.value.index == 2


@pytest.mark.parametrize("wrong, kind, words", [
    (lambda: narc.fit([[0, 0], [1, 1], [2, 2]]), narc.Error, "line"),
    (lambda: narc.fit(L_SHAPE, 99), narc.Error, "99"),
    (lambda: narc.fit(L_SHAPE, -1), ValueError, "arcs is -1"),
    (lambda: narc.fit(L_SHAPE, starts=2**32 + 2), ValueError, "starts is 4294967298"),
    (lambda: narc.cut(L_SHAPE, most=-1), ValueError, "most is -1"),
    (lambda: narc.hull(np.zeros((4, 3))), ValueError, "xy: the shape is to be"),
    (lambda: narc.hull(np.zeros(7)), ValueError, "xy: the shape is to be"),
    (lambda: narc.fit(L_SHAPE, family="rounds"), ValueError, "family 'rounds': it is one of n-arc"),
    (lambda: narc.fit(L_SHAPE, goal="best"), ValueError, "goal 'best'"),
    (lambda: narc.fit([]), narc.Error, "no points"),
    (lambda: narc.fit(np.zeros((3, 3))), ValueError, "n, 2"),
    (lambda: narc.fit([[0, 0], [np.nan, 1], [2, 2]]), narc.Error, "nan|finite"),
    (lambda: narc.cut(L_SHAPE, -1), narc.Error, "-1"),
    (lambda: narc.Outline.read("drawing.txt"), ValueError, "ending 'txt'"),
    (lambda: narc.Outline.read("nowhere.svg"), FileNotFoundError, "nowhere"),
    (lambda: narc.fit_chains(np.array([[0, 0], [2, 2], [2, 0], [0, 2]]), 0.1), narc.Error, "cross")])
def test_what_is_wrong_is_said(wrong, kind, words):
    with pytest.raises(kind, match=words):
        wrong()


def test_control_c_ends_a_fit(ctrl_c):
    timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        timer.start()
        narc.fit(circle(37) * (1, 0.4) + 0.1 * circle(37) ** 2, 20, starts=4000)
    timer.join()
    assert time.monotonic() - begin < 20 and narc.fit(L_SHAPE, 3).area > 9


def test_without_the_libraries_it_is_said(monkeypatch):
    monkeypatch.setattr(narc._fits, "_fit", None)
    with pytest.raises(ImportError, match="FreeType, libpng"):
        narc.fit(L_SHAPE)
