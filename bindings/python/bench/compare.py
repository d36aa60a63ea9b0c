# SPDX-License-Identifier: MIT
"""narc from Python beside shapely, SciPy, matplotlib and pymunk, as far as they are installed. One thread, processor time, the median
of some runs; ratios are what counts.

    python bench/compare.py"""

import importlib
import statistics
import time

import numpy as np

import narc

COUNT, SIDE = 10000, 170.0


def clock(call, least=0.2):
    """Seconds of a call."""
    times = []
    while sum(times) < least or len(times) < 5:
        begin = time.process_time()
        call()
        times.append(time.process_time() - begin)
    return statistics.median(times)


def have(name):
    try:
        return importlib.import_module(name)
    except ImportError:
        print(f"{name} is not there: its rows are left out")
        return None


def row(what, ours, unit, number, others=None, who=""):
    scale = {"us": 1e6, "ns": 1e9, "ms": 1e3}[unit] / number
    beside = f"{others * scale:10.4g} {who}, {others / ours:.1f} times" if others else ""
    print(f"{what:<44}{ours * scale:10.4g} {unit} {beside}")


def main():
    random = np.random.default_rng(1)
    shapes = narc.Shapes()
    kinds = np.array([shapes.box(2, 1), shapes.regular(6, 1.0), shapes.regular(8, 0.9)])
    angle = random.random(COUNT) * 7
    bodies = narc.bodies(random.random((COUNT, 2)) * SIDE, angle, random.choice(kinds, COUNT))
    pairs = narc.pairs(shapes, bodies, margin=1.0)
    every = random.integers(0, COUNT, (100000, 2)).astype(np.uint32)
    near = pairs[np.arange(100000) % len(pairs)]
    print(f"narc {narc.__version__}, {narc.get_isa()}; {COUNT} polygons, {len(pairs)} pairs nearer than 1\n")

    # what a call costs beside its pairs is less than one of a single pair
    out = np.zeros(100000, narc.CONTACT)
    one = np.zeros(1, narc.CONTACT)
    first, first_thousand = near[:1].copy(), near[:1000].copy()
    single = clock(lambda: [narc.contacts(shapes, bodies, first, out=one) for _ in range(1000)]) / 1000
    thousand = clock(lambda: [narc.contacts(shapes, bodies, first_thousand, out=out) for _ in range(20)]) / 20
    all_pairs = clock(lambda: narc.contacts(shapes, bodies, near, out=out))
    a, b = bodies[near[0]]
    row("contacts, one pair in a batch", single, "us", 1)
    row("contact of two bodies", clock(lambda: [narc.contact(shapes, a, b) for _ in range(1000)]) / 1000, "us", 1)
    row("contacts of 100,000 pairs, each", all_pairs, "ns", 100000)
    row("contacts of 1,000 pairs, each", thousand, "ns", 1000)
    print(f"{'what is not pairs: less than':<44}{single / thousand:10.1%} of 1,000, {single / all_pairs:.2%} of 100,000")
    row("manifolds, each", clock(lambda: narc.manifolds(shapes, bodies, near)), "ns", 100000)
    row("separations of any two, each", clock(lambda: narc.separations(shapes, bodies, every)), "ns", 100000)

    points = random.random((100000, 2)) * SIDE
    index = narc.Index(shapes, bodies)
    shapely = have("shapely")
    if shapely:
        geometry, strtree, prepared = (importlib.import_module(f"shapely.{m}") for m in ("geometry", "strtree", "prepared"))
        polygons = [geometry.Polygon(outline) for outline in narc.outlines(shapes, bodies)]
        some = near[:4000]
        who = f"shapely {shapely.__version__}"
        ready = [prepared.prep(polygon) for polygon in polygons]
        if hasattr(shapely, "intersects"):  # 2: arrays
            array = np.array(polygons, object)
            shapely.prepare(array)
            hits, far = (lambda: shapely.intersects(array[near[:, 0]], array[near[:, 1]]),
                         lambda: shapely.distance(array[every[:, 0]], array[every[:, 1]]))
            tree = shapely.STRtree(array)
            found = clock(lambda: tree.query(array, predicate="intersects"))
            theirs = clock(hits), clock(far)
        else:
            hits = lambda: [ready[i].intersects(polygons[j]) for i, j in some]
            far = lambda: [polygons[i].distance(polygons[j]) for i, j in every[:4000]]
            tree = strtree.STRtree(polygons)
            number = {id(polygon): k for k, polygon in enumerate(polygons)}
            found = clock(lambda: [number[id(other)] for k in range(1000) for other in tree.query(polygons[k])
                                   if ready[k].intersects(other)]) * COUNT / 1000
            theirs = clock(hits) * 25, clock(far) * 25
        row("overlaps, each", clock(lambda: narc.overlaps(shapes, bodies, near)), "ns", 100000, theirs[0], who)
        row("distances of any two, each", clock(lambda: narc.separations(shapes, bodies, every)), "ns", 100000, theirs[1], who)
        row("all pairs that overlap, from poses", clock(lambda: narc.contacts(shapes, bodies)), "ms", 1, found, who)
    scipy = have("scipy")
    if scipy:
        kd = importlib.import_module("scipy.spatial").cKDTree(bodies["xy"])
        row("nearest body (SciPy: nearest centre), each", clock(lambda: index.nearest(points)), "ns", 100000,
            clock(lambda: kd.query(points)), f"SciPy {scipy.__version__}")
    if have("matplotlib"):
        path = importlib.import_module("matplotlib.path").Path
        outline = narc.outlines(shapes, bodies[:1])[0]
        close = bodies["xy"][0] + random.normal(0, 1, (100000, 2))
        row("points in one polygon, each", clock(lambda: narc.inside(shapes, bodies[:1], close, 0)), "ns", 100000,
            clock(lambda: path(outline).contains_points(close)), "matplotlib")

    pymunk = have("pymunk")
    if pymunk:  # a step without solver iterations is little but its broad phase and contacts
        space = pymunk.Space()
        space.iterations = 1
        for body, outline in zip(bodies, narc.outlines(shapes, bodies)):
            own = pymunk.Body(1, 1)
            own.position = tuple(body["xy"])
            space.add(own, pymunk.Poly(own, (outline - body["xy"]).tolist()))
        kept = narc.Contacts()
        row("a step of 10,000 polygons (pymunk: with solver)", clock(lambda: kept.update(shapes, bodies)), "ms", 1,
            clock(lambda: space.step(1e-9)), f"pymunk {pymunk.version}")
    if shapely:  # where narc is not the tool
        one, other = polygons[0], geometry.Polygon(narc.outlines(shapes, bodies[:2])[0] + 0.3)
        print(f"{'areas of what two have in common, each':<44}{'none':>10} us {clock(lambda: one.intersection(other)) * 1e6:10.4g} {who}")

    # 4,096 worlds of 32, all of them in one step
    count = 4096 * 32
    corner = 40.0 * np.stack([np.arange(4096) % 64, np.arange(4096) // 64], 1)
    many = narc.bodies((corner[:, None] + random.random((4096, 32, 2)) * 8).reshape(-1, 2), random.random(count) * 7,
                       random.choice(kinds, count))
    contacts = narc.Contacts("contacts")

    def step():
        many["xy"] += 0.01
        contacts.update(shapes, many, skin=0.1)

    row("a step of 4,096 worlds of 32, all moving", clock(step, 1.0), "ms", 1)
    row("the same as a batch", clock(lambda: narc.contacts(shapes, many), 1.0), "ms", 1)


if __name__ == "__main__":
    main()
