// SPDX-License-Identifier: MIT
// The package in node, both builds: node --expose-gc --test.
import assert from "node:assert/strict";
import { test } from "node:test";
import { constants, load, NarcError, Numbers, Rows } from "../package/narc.js";

const builds = [await load({ build: "fast" }), await load({ build: "small" })];
const [fast, small] = builds;

/** The same numbers everywhere: a linear congruence of 48 bits. */
function random(seed) {
    let state = BigInt(seed);
    return (low, high) => {
        state = (state * 25214903917n + 11n) & ((1n << 48n) - 1n);
        return low + (high - low) * Number(state >> 16n) / 2 ** 32;
    };
}

function hash(bytes) {
    let h = 0x811c9dc5;
    for (const byte of bytes)
        h = Math.imul(h ^ byte, 0x01000193) >>> 0;
    return h;
}

const bytesOf = (list) => list instanceof Rows ? list.u8.slice(0, list.count * list.size) : new Uint8Array(list.array.slice(0, list.count).buffer);

function scene(narc, count = 400, seed = 1) {
    const next = random(seed), shapes = narc.shapes();
    const kinds = [shapes.circle(0.5), shapes.box(1, 0.7), shapes.box(0.9, 0.6, 0.15), shapes.capsule(0.6, 0.25), shapes.ellipse(0.6, 0.4, 8),
        shapes.polygon([[0.5, 0], [0.3, 0.4], [-0.2, 0.4], [-0.5, 0.1], [-0.3, -0.4], [0.2, -0.4]]), shapes.ring([[0, 0], [1, 0], [1.2, 0.6], [0.4, 1]])];
    const bodies = narc.bodies(count);
    for (let k = 0; k < count; k++) {
        const body = bodies.at(k), cosine = next(-1, 1);
        body.x = next(0, 14);
        body.y = next(0, 14);
        body.cosine = cosine;
        body.sine = Math.sqrt(1 - Math.fround(cosine) ** 2);
        body.shape = kinds[Math.floor(next(0, kinds.length))];
    }
    return { narc, shapes, bodies, next };
}

// What every question answers has the same bytes in both builds, and as recorded.
test("both builds give the same bytes", () => {
    const answers = builds.map((narc) => {
        const { shapes, bodies, next } = scene(narc), all = [];
        const pairs = narc.pairs(shapes, bodies, { margin: 0.3 });
        assert(pairs.count > 1000);
        all.push(pairs, narc.contacts(shapes, bodies, pairs, { margin: 0.3 }), narc.manifolds(shapes, bodies, pairs), narc.overlaps(shapes, bodies, pairs),
            narc.separations(shapes, bodies, pairs), narc.refine(shapes, bodies, pairs, narc.contacts(shapes, bodies, pairs)));
        const index = narc.index(shapes, bodies), many = (low, high) => Float32Array.from({ length: 300 }, () => next(low, high));
        const rays = { x: many(0, 14), y: many(0, 14), motionX: many(-9, 9), motionY: many(-9, 9) };
        all.push(index.rays(rays, { most: 3 }), index.nearest({ x: rays.x, y: rays.y }, { most: 2 }), narc.distances(shapes, bodies, { x: rays.x, y: rays.y }, 7),
            narc.inside(shapes, bodies, { x: rays.x, y: rays.y }, 7), narc.rayPairs(shapes, bodies, rays, 3));
        const { depth, nodes } = index.statistics, levels = Array.from({ length: depth }, (_, level) => index.nodes(level));
        assert.equal(levels.reduce((sum, level) => sum + level.count, 0), nodes);
        assert.equal(levels[depth - 1].count, 1);
        assert.equal(index.nodes(depth).count, 0);
        all.push(...levels);
        const motions = { x: Float32Array.from(bodies, () => next(-5, 5)), y: 1, angle: 0.5 };
        all.push(narc.castPairs(shapes, bodies, motions, pairs), index.casts(bodies, motions, { parting: 0.01 }));
        const stay = narc.contactsThatStay();
        for (let step = 0; step < 3; step++) {
            stay.update(shapes, bodies, { margin: 0.02, skin: 0.05 });
            bodies.at(step).x += 0.3;
        }
        const saved = stay.save(), before = stay.touchingCount;
        assert.equal(narc.contactsThatStay().load(shapes, saved).touchingCount, before);
        return [...all.map(bytesOf), saved, shapes.save()];
    });
    answers[0].forEach((bytes, k) => assert.deepEqual(bytes, answers[1][k], `answer ${k}`));
});

test("two bodies, a batch and contacts that stay say the same", () => {
    for (const narc of builds) {
        const { shapes, bodies } = scene(narc), pairs = narc.pairs(shapes, bodies), rows = narc.contacts(shapes, bodies, pairs, { margin: Infinity, dense: true });
        const stay = narc.contactsThatStay({ rows: constants.CONTACT_ROWS, userSize: 8 }).update(shapes, bodies);
        assert.equal(stay.count, rows.count);
        for (let k = 0; k < rows.count; k++) {
            const row = rows.at(k), { array } = pairs, one = narc.contact(shapes, bodies, array[2 * k], array[2 * k + 1], Infinity);
            assert.deepEqual([one.separation, one.normalX, one.pointY, one.feature], [row.separation, row.normalX, row.pointY, row.feature]);
            const slot = stay.slot(k);
            assert.deepEqual([stay.a(slot), stay.b(slot)], [array[2 * k], array[2 * k + 1]]);
            if (row.separation < 0)
                assert.equal(stay.contact(slot).separation, row.separation);
        }
        assert.equal(narc.memory.view.getFloat64(stay.user(stay.slot(0)), true), 0);
    }
});

test("wrong calls are errors with names", () => {
    for (const narc of builds) {
        const { shapes, bodies } = scene(narc, 4), pair = Uint32Array.of(0, 1);
        const bad = (call, kind, pattern) => assert.throws(call, (error) => error instanceof kind && pattern.test(error.message) || assert.fail(`${error}`));
        bad(() => narc.contacts(shapes, bodies, pair, { margins: new Float32Array(2) }), RangeError, /margins: 2 items, 1 are wanted/);
        bad(() => narc.contacts(shapes, bodies, pair, { margins: new Float64Array(1) }), TypeError, /margins: Float32Array is wanted, not Float64Array/);
        bad(() => narc.contacts(shapes, bodies, pair, { margn: 1 }), TypeError, /margn: Query has no such member/);
        bad(() => narc.contacts(shapes, bodies, pair, { margin: "1" }), TypeError, /margin: a number is wanted/);
        bad(() => narc.contacts(shapes, bodies, pair, { outSkipped: 1 }), TypeError, /outSkipped/);
        bad(() => narc.contacts(shapes, bodies, pair, { selection: Uint32Array.of(0, 0) }), NarcError, /selection/);
        bad(() => narc.index(shapes, bodies).rays({ x: 0, y: 0, motionX: 1, motionY: 1 }, { owners: { owner: new Uint32Array(3) } }), RangeError, /owner: 3 items, 4 are wanted/);
        bad(() => narc.contacts(shapes, bodies, Uint32Array.of(0)), RangeError, /pairs: 1 numbers/);
        bad(() => narc.contacts(shapes, bodies, [0, 1]), TypeError, /pairs/);
        bad(() => narc.contacts(shapes, narc.contactRows(1), pair), TypeError, /rows of Body/);
        bad(() => narc.contacts(shapes, bodies, Uint32Array.of(0, 9)), NarcError, /body b is 9/);
        bad(() => narc.contact(shapes, bodies, 0, 4), RangeError, /there are 4/);
        bad(() => narc.contact(shapes, bodies, 0, 0.5), RangeError, /0.5/);
        bad(() => bodies.at(4), RangeError, /there are 4/);
        bad(() => bodies.at(0.5), RangeError, /row 0.5/);
        bad(() => bodies.column("z"), TypeError, /z/);
        bad(() => shapes.circle(-1), NarcError, /radius/);
        bad(() => shapes.circle("1"), TypeError, /radius/);
        bad(() => shapes.add(new Float64Array(4)), RangeError, /five/);
        bad(() => shapes.remove(99), NarcError, /99/);
        bad(() => shapes.remove(-1), RangeError, /-1/);
        bad(() => narc.index(shapes, bodies).rays({ x: 0, y: 0, motionX: new Float32Array(2), motionY: new Float32Array(3) }), RangeError, /motionY/);
        bad(() => narc.contactsThatStay().count, Error, /update/);
        bad(() => narc.loadShapes(new Uint8Array(64)), NarcError, /./);
        const gone = narc.shapes();
        gone.free();
        gone.free();
        bad(() => gone.count, Error, /freed/);
    }
    assert.throws(() => small.placeParts(small.bodies(1), small.bodies(1), 0), /not in the small build/);
    assert.throws(() => small.shapes().addChain(new Float64Array(5)), /not in the small build/);
    assert.throws(() => small.shapes().halfPlane(), /not in the small build/);
    const shapes = fast.shapes(), disc = shapes.circle(1), ground = shapes.halfPlane(), bodies = fast.bodies(2);
    Object.assign(bodies.at(0), { x: 1e6, y: 0.5, shape: disc });
    bodies.at(1).shape = ground;
    assert.equal(fast.contact(shapes, bodies, 0, 1).separation, -0.5);
});

// Each load() has a memory of its own: a place in one is another thing, or nothing, in the other.
test("what is of another module is refused", async () => {
    const other = await load({ build: "fast" });
    for (const narc of builds) {
        const { shapes, bodies } = scene(narc, 4), far = scene(other, 4), pair = Uint32Array.of(0, 1), index = narc.index(shapes, bodies), stay = narc.contactsThatStay();
        const point = { x: 0, y: 0 }, refuse = (call, name) => assert.throws(call, (error) => error instanceof TypeError && error.message.startsWith(`${name}: it is of another module`) || assert.fail(`${error}`));
        refuse(() => narc.contacts(far.shapes, bodies, pair), "shapes");
        refuse(() => narc.contacts(shapes, far.bodies, pair), "bodies");
        refuse(() => narc.contacts(shapes, bodies, other.indices(2)), "pairs");
        refuse(() => narc.contacts(shapes, bodies, pair, {}, other.contactRows(1)), "out");
        refuse(() => narc.contacts(shapes, bodies, pair, { margins: other.floats(1).column }), "margins");
        refuse(() => narc.contact(far.shapes, bodies, 0, 1), "shapes");
        refuse(() => narc.contact(shapes, far.bodies, 0, 1), "bodies");
        refuse(() => narc.pairs(far.shapes, bodies), "shapes");
        refuse(() => narc.pairs(shapes, bodies, {}, other.indices(8)), "out");
        refuse(() => narc.overlaps(far.shapes, bodies, pair), "shapes");
        refuse(() => narc.separations(shapes, bodies, pair, {}, other.floats(1)), "out");
        refuse(() => narc.index(far.shapes, bodies), "shapes");
        refuse(() => narc.index(shapes, far.bodies), "bodies");
        refuse(() => index.nearest(point, {}, other.distanceRows(1)), "out");
        refuse(() => index.update(far.bodies), "bodies");
        refuse(() => stay.update(far.shapes, bodies), "shapes");
        refuse(() => stay.load(far.shapes, new Uint8Array(8)), "shapes");
        refuse(() => narc.castPairs(shapes, bodies, { x: other.floats(4).column, y: 0, angle: 0 }, pair), "x");
        assert.equal(narc.readShapes('{"shapes": [{"name": "c", "circle": 1}]}', far.shapes)[0].shape, far.shapes.circle(1)); // a text is of none
        // Nor are rows of another structure written over.
        assert.throws(() => narc.manifolds(shapes, bodies, pair, {}, narc.contactRows(1)), /out: rows of Manifold wanted, not rows of Contact/);
        assert.throws(() => narc.contacts(bodies, bodies, pair), /shapes: Shapes wanted, not rows of Body/);
        assert.throws(() => narc.contacts(null, bodies, pair), /shapes: Shapes wanted/);
    }
});

// Rows, bits and errors of batches that threads divide are those of one thread, whatever their number; memory that grows is seen by all.
test("threads give the same bytes", async () => {
    for (const count of [1, 3]) {
        const threads = await load({ threads: count }), pair = [fast, threads].map((narc) => scene(narc, 6000, 5));
        for (const round of [0, 1]) {
            const answers = pair.map(({ narc, shapes, bodies }) => {
                const pairs = narc.pairs(shapes, bodies, { margin: 0.1 }), query = { margin: 0.05 };
                assert(pairs.count > 40000);
                bodies.at(17).cosine = round === 0 ? bodies.at(18).cosine : NaN; // a broken body: pairs that are skipped
                const made = [narc.contacts(shapes, bodies, pairs, query), narc.manifolds(shapes, bodies, pairs, query), narc.contacts(shapes, bodies, pairs, { ...query, dense: true }),
                    narc.overlaps(shapes, bodies, pairs), narc.separations(shapes, bodies, pairs)].map((rows) => [narc.skipped, rows.count, bytesOf(rows)]);
                assert(round === 0 || narc.skipped > 0);
                const bad = pairs.array.slice(0, pairs.count);
                bad[bad.length - 2] = 6001;
                assert.throws(() => narc.contacts(shapes, bodies, bad), (error) => error instanceof NarcError && error.index === bad.length / 2 - 1);
                return made;
            });
            assert.deepEqual(answers[1], answers[0]);
            if (round === 0)
                pair[1].narc.floats(3e6);
        }
        threads.end();
        assert.equal(threads.contacts(pair[1].shapes, pair[1].bodies, Uint32Array.of(0, 1), { margin: Infinity }).count, 1);
    }
    await assert.rejects(load({ build: "small", threads: 2 }), /small build has none/);
});

// Whatever is called with whatever: an error that has a name, or an answer; nothing traps, and the module goes on to work.
test("random calls never trap", () => {
    const next = random(7), odd = [0, 1, -1, 0.5, NaN, Infinity, 1e30, undefined, null, "a", {}, [], 2 ** 32, new Float32Array(3), new Uint32Array(4), new Float64Array(10), 3n];
    const pick = () => odd[Math.floor(next(0, odd.length))];
    for (const narc of builds) {
        const { shapes, bodies } = scene(narc, 20), index = narc.index(shapes, bodies), stay = narc.contactsThatStay();
        const calls = [() => narc.outlines.circle(pick()), () => narc.outlines.box(pick(), pick(), pick()), () => narc.outlines.polygon(pick(), pick()),
            () => narc.outlines.ring([[next(-2, 2), next(-2, 2)], [next(-2, 2), pick()], [next(-2, 2), next(-2, 2)]]), () => shapes.add(pick(), pick()),
            () => shapes.arcs(pick()), () => narc.contacts(shapes, bodies, pick(), { margin: pick(), dense: pick(), first: pick(), count: pick(), rowStride: pick() }),
            () => narc.contact(shapes, bodies, pick(), pick(), pick()), () => narc.pairs(shapes, bodies, { margin: pick(), owner: pick(), world: pick() }),
            () => index.rays({ x: pick(), y: pick(), motionX: pick(), motionY: pick() }, { inside: pick(), any: pick(), mask: pick(), most: 2 }),
            () => index.nearest({ x: pick(), y: pick() }, { distance: pick() }), () => index.regions(pick()), () => stay.update(shapes, bodies, { margin: pick(), skin: pick(), recycling: pick() }),
            () => narc.outlines.flatten(narc.outlines.circle(1), pick()), () => stay.manifold(pick()), () => narc.distances(shapes, bodies, { x: pick(), y: pick() }, pick())];
        let answers = 0;
        for (let k = 0; k < 4000; k++) {
            try {
                calls[k % calls.length]();
                answers++;
            } catch (error) {
                assert(!(error instanceof WebAssembly.RuntimeError) && error.message, `${error.stack}`);
            }
        }
        assert(answers > 100);
        assert.equal(narc.contact(shapes, bodies, 3, 3, 1).count, 1);
    }
});

test("views are made again when memory grows", () => {
    const { shapes, bodies } = scene(fast), before = bodies.f32, held = narcBytes(fast);
    const kept = [...bodies.f64.slice(0, 40)];
    const large = fast.floats(4e6);
    assert(narcBytes(fast) > held);
    assert.equal(before.length, 0);
    assert.deepEqual([...bodies.f64.slice(0, 40)], kept);
    assert(fast.contact(shapes, bodies, 0, 0).separation < 0);
    large.free();
});

function narcBytes(narc) {
    return narc.memory.u8.length;
}

test("nothing leaks, and a step makes garbage for no body", { timeout: 60000 }, async () => {
    const { narc, shapes, bodies } = scene(fast), pairs = narc.indices(0), rows = narc.manifoldRows(0);
    const stay = narc.contactsThatStay(), query = { margin: 0.02 }, told = { margin: 0.02, skin: 0.05 };
    const sums = new Float64Array(1); // a variable of a closure would box each sum
    const step = () => {
        narc.pairs(shapes, bodies, query, pairs);
        narc.manifolds(shapes, bodies, pairs, query, rows);
        for (let k = 0; k < rows.count; k++)
            sums[0] += rows.at(k).normalX;
        stay.update(shapes, bodies, told);
        for (let k = 0; k < stay.touchingCount; k++)
            sums[0] += stay.manifold(stay.touching(k)).normalY;
    };
    const before = () => {
        gc();
        return process.memoryUsage().heapUsed;
    };
    let least = Infinity; // what the compiler does between steps counts too
    step();
    const begin = before();
    for (let batch = 0; batch < 8; batch++) {
        const heap = before();
        for (let k = 0; k < 150; k++)
            step();
        least = Math.min(least, (process.memoryUsage().heapUsed - heap) / 150);
    }
    assert(before() - begin < 400_000, "garbage is all that there is");
    assert(least < 6000, `${least} bytes a step`); // some for each call, whatever the number of rows
    const memory = narcBytes(fast);
    for (let round = 0; round < 200; round++) {
        for (let k = 0; k < 20; k++) {
            narc.floats(20000);
            narc.shapes().circle(1);
        }
        gc();
        await new Promise((resolve) => setTimeout(resolve, 1)); // when the registry is asked
    }
    assert(narcBytes(fast) - memory < 64e6, `${narcBytes(fast) - memory} bytes more`); // 320 MB were taken
    assert(Number.isFinite(sums[0]));
});

test("ground and compounds", () => {
    const shapes = fast.shapes(), half = Math.PI / 2, ground = shapes.addChain(Float64Array.of(9, 0, 0, half, half, 0, 0, 0, half, half));
    const below = fast.groundBodies(ground), ball = fast.bodies(1);
    ball.at(0).shape = shapes.circle(0.5);
    ball.at(0).x = 4;
    ball.at(0).y = 0.4;
    const found = fast.contacts(shapes, ball, { a: Uint32Array.of(0), b: Uint32Array.of(0), otherBodies: below });
    assert(Math.abs(found.at(0).separation + 0.1) < 1e-6 && found.at(0).normalY === -1);
    const parts = fast.placeParts({ x: 1, y: 2, cosine: 0, sine: 1, shape: 0, count: 1 }, { x: Float64Array.of(1, 0), y: 0, cosine: 1, sine: 0, shape: 0 }, Uint32Array.of(0, 0));
    assert.deepEqual([parts.at(0).x, parts.at(0).y], [1, 3]);
});

test("shapes files and stores", () => {
    const file = `{"shapes": [{"name": "p", "points": [[0, 0], [4, 0], [4, 3], [0, 3]], "radius": 2.5}, {"name": "c", "circle": 1.5, "origin": [1, 2]},
        {"name": "b", "box": {"width": 4, "height": 2, "radius": 0.5}}, {"name": "g", "chain": {"closed": false, "arcs": [
        {"center": [9, 0], "radius": 0, "start": 1.5, "end": 1.5}, {"center": [0, 0], "radius": 0, "start": 1.5, "end": 1.5}]}}]}`;
    for (const narc of builds) {
        const store = narc.shapes(), read = narc.readShapes(file, store);
        assert.deepEqual(read.map(({ name, shape, form }) => [name, shape, form]), [["p", 0, "shape"], ["c", 1, "shape"], ["b", 2, "shape"], ["g", undefined, "open chain"]]);
        const floor = '{"shapes": [{"name": "floor", "half_plane": true}]}';
        assert.deepEqual(JSON.parse(narc.writeShapes(narc.readShapes(floor))), JSON.parse(floor));
        assert.throws(() => narc.readShapes(floor.replace("true", "1")), /half_plane is not true/);
        assert.deepEqual(narc.readShapes(narc.writeShapes(read)).map(({ arcs, origin }) => [[...arcs], origin]), read.map(({ arcs, origin }) => [[...arcs], origin]));
        assert.deepEqual(narc.loadShapes(store.save()).save(), store.save());
        for (const [text, pattern] of [["{}", /shapes/], ['{"shapes": []}', /none/], ['{"shapes": [{"name": "a", "circle": 1, "box": 2}]}', /'a'/], ['{"shapes": [{"circle": 1}]}', /name/],
            ['{"shapes": [{"name": "a", "circle": -1}]}', /radius/], ['{"shapes": [{"name": "a,b", "circle": 1}]}', /name/], ['{"shapes": [{"name": "a", "circle": 1, "z": 1}]}', /z is not known/]])
            assert.throws(() => narc.readShapes(text, store), pattern);
        assert.equal(store.count, 3);
    }
});
