// SPDX-License-Identifier: MIT
// Twenty thousand bodies that drift, by the package for JavaScript: a batch in the build with vectors, the same in the one without, and one by one.
const COUNT = 20000, WIDTH = 560, HEIGHT = 280, SAMPLE = 3000, TURN = 2 * Math.PI;

export async function makeMany(load, narc) {
    const plain = await load({ build: "small" });
    const sides = [narc, plain].map((of) => {
        const shapes = of.shapes(), { outlines } = of;
        const kinds = [outlines.circle(0.7), outlines.capsule(1, 0.4), outlines.ellipse(0.9, 0.6, 4), outlines.box(1.3, 0.9, 0.2)].map((arcs) => ({ arcs, shape: shapes.add(arcs) }));
        return { of, shapes, kinds, bodies: of.bodies(COUNT), pairs: of.indices(0), rows: of.contactRows(0), ns: 0 };
    });
    const [fast] = sides, speeds = new Float32Array(2 * COUNT), touched = new Uint8Array(COUNT);
    const count = { pairs: 0, contacts: 0 }, ns = { fast: 0, plain: 0, one: 0, boxes: 0 };
    let frames = 0;

    function start(seed) {
        let state = seed >>> 0;
        const next = () => (state = Math.imul(state ^ state >>> 15, 0x2c1b3c6d) + 0x9e3779b9 >>> 0) / 2 ** 32;
        const { f64, f32, u32 } = fast.bodies; // a row: x and y, cosine, sine, scale, shape
        for (let k = 0; k < COUNT; k++) {
            const angle = TURN * next();
            f64[4 * k] = WIDTH * next();
            f64[4 * k + 1] = HEIGHT * next();
            f32[8 * k + 4] = Math.cos(angle);
            f32[8 * k + 5] = Math.sin(angle);
            u32[8 * k + 7] = fast.kinds[Math.floor(next() * fast.kinds.length)].shape;
            speeds[2 * k] = 0.06 * (next() - 0.5);
            speeds[2 * k + 1] = 0.06 * (next() - 0.5);
        }
        frames = 0;
        Object.assign(ns, { fast: 0, plain: 0, one: 0, boxes: 0 });
        for (let k = 0; k < 3; k++) // there is something to tell, even of a scene that stands still, and not how long a browser compiles
            step();
    }

    const clock = (name, items, run) => {
        const begin = performance.now();
        run();
        const each = 1e6 * (performance.now() - begin) / Math.max(items, 1);
        ns[name] = ns[name] === 0 ? each : Math.min(each, 1.05 * ns[name]); // what code takes that nothing disturbs
    };
    const query = { margin: 0.02 };

    /** They drift; pairs are found, and all of them are asked. The other two ways are asked the same at first, and then in turns. */
    function step() {
        const { f64 } = fast.bodies, { of, shapes, bodies, pairs, rows } = fast;
        for (let k = 0; k < COUNT; k++) {
            f64[4 * k] = (f64[4 * k] + speeds[2 * k] + WIDTH) % WIDTH;
            f64[4 * k + 1] = (f64[4 * k + 1] + speeds[2 * k + 1] + HEIGHT) % HEIGHT;
        }
        clock("boxes", COUNT, () => of.pairs(shapes, bodies, query, pairs));
        count.pairs = pairs.count / 2;
        clock("fast", count.pairs, () => of.contacts(shapes, bodies, pairs, query, rows));
        count.contacts = rows.count;
        if (frames % 4 === 0) {
            const other = sides[1];
            other.bodies.u8.set(bodies.u8);
            other.pairs.reserve(pairs.count).count = pairs.count;
            other.pairs.array.set(pairs.array.subarray(0, pairs.count));
            clock("plain", count.pairs, () => plain.contacts(other.shapes, other.bodies, other.pairs, query, other.rows));
        }
        if (frames % 4 === 2 || frames === 0) {
            const { array } = pairs, sample = Math.min(SAMPLE, count.pairs);
            clock("one", sample, () => {
                for (let k = 0; k < sample; k++)
                    of.contact(shapes, bodies, array[2 * k], array[2 * k + 1], 0.02);
            });
        }
        frames++;
    }

    /** By true arcs, all of one shape and state in one path. */
    function draw(context, { colors }) {
        const { bodies, kinds, pairs, rows } = fast, { f64, f32, u32 } = bodies, list = pairs.array, found = rows.u32, size = rows.size / 4;
        touched.fill(0);
        for (let k = 0; k < count.contacts; k++) {
            const pair = found[size * k];
            touched[list[2 * pair]] = touched[list[2 * pair + 1]] = 1;
        }
        kinds.forEach(({ arcs, shape }, kind) => {
            const paths = [new Path2D(), new Path2D()], x0 = arcs[0] + arcs[2] * Math.cos(arcs[3]), y0 = arcs[1] + arcs[2] * Math.sin(arcs[3]);
            for (let k = 0; k < COUNT; k++) {
                if (u32[8 * k + 7] !== shape)
                    continue;
                const c = f32[8 * k + 4], s = f32[8 * k + 5], x = f64[4 * k], y = f64[4 * k + 1], angle = Math.atan2(s, c), path = paths[touched[k]];
                path.moveTo(x + c * x0 - s * y0, y + s * x0 + c * y0);
                for (let i = 0; i < arcs.length; i += 5)
                    path.arc(x + c * arcs[i] - s * arcs[i + 1], y + s * arcs[i] + c * arcs[i + 1], arcs[i + 2], angle + arcs[i + 3], angle + arcs[i + 4]);
            }
            context.fillStyle = colors.fills[[1, 3, 4, 5][kind]];
            context.globalAlpha = 0.5;
            context.fill(paths[0]);
            context.globalAlpha = 1;
            context.fillStyle = colors.accent;
            context.fill(paths[1]);
        });
    }

    function describe() {
        const times = (value) => (value / ns.fast).toFixed(1);
        return `${count.pairs.toLocaleString("en")} pairs near each other, ${count.contacts.toLocaleString("en")} touch. A pair takes ${ns.fast.toFixed(0)} ns in a batch with vectors, ` +
            `${ns.plain.toFixed(0)} ns in a batch of plain C (${times(ns.plain)} times), ${ns.one.toFixed(0)} ns one by one from JavaScript (${times(ns.one)} times).`;
    }

    return { box: [0, 0, WIDTH, HEIGHT], start, step, draw, describe, ns, count, purpose: () => "20,000 bodies", rows: () => sides.map(({ rows }) => rows),
        numbers: () => `${COUNT.toLocaleString("en")} bodies · boxes and pairs ${(ns.boxes * COUNT / 1e6).toFixed(1)} ms, contacts ${(ns.fast * count.pairs / 1e6).toFixed(1)} ms` };
}
