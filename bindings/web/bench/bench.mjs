// SPDX-License-Identifier: MIT
// narc's world beside engines from npm: node bench.mjs MODULES PACKAGE PAGE OUT [--bodies 1000,5000] [--scenes boxes,mixed] [--steps 60] [--engines narc,rapier].
// Each engine has a process of its own; they step in turns, from one start, which narc's world has settled, and which each of
// them is asked for before the first step. What comes out is judged by the package, not by the engines.
import assert from "node:assert/strict";
import { fork } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import { cpus } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { parseArgs } from "node:util";

const { values, positionals: [modules, packed, page, out] } = parseArgs({ allowPositionals: true, options: {
    bodies: { type: "string", default: "1000,5000,20000" }, scenes: { type: "string", default: "boxes,octagons,mixed,falling" }, steps: { type: "string", default: "60" },
    settle: { type: "string", default: "240" }, warm: { type: "string", default: "20" }, limit: { type: "string", default: "20" },
    engines: { type: "string", default: "narc,rapier,box2d,planck,matter,detect-collisions" } } });
const { load } = await import(pathToFileURL(resolve(packed, "narc.js"))), narc = await load();
const at = (list, part) => [...list].sort((a, b) => a - b)[Math.floor(part * list.length)], median = (list) => at(list, 0.5);
/** What a step takes that nothing else disturbs. */
const quick = (list) => at(list, 0.1);

/** Process and what it answers. */
class Engine {
    constructor(name, start) {
        this.name = name;
        this.child = fork(fileURLToPath(new URL("./engines.mjs", import.meta.url)), [name, modules, packed, page, start], 
            { serialization: "advanced", execArgv: ["--no-liftoff", "--no-wasm-tier-up", "--no-wasm-lazy-compilation"] }); // compiled well before the first step
    }
    answer() {
        return new Promise((done, fail) => {
            const gone = (code) => fail(new Error(`${this.name} ended: ${code}`));
            this.child.once("exit", gone);
            this.child.once("message", ({ answer }) => {
                this.child.off("exit", gone);
                done(answer);
            });
        });
    }
    ask(word, given) {
        this.child.send({ word, given });
        return this.answer();
    }
    end() {
        this.child.removeAllListeners("exit");
        this.child.kill();
    }
}

let state = 1;
const random = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
const octagon = { points: Array.from({ length: 8 }, (_, k) => [0.55 * Math.cos(Math.PI * (k + 0.5) / 4), 0.55 * Math.sin(Math.PI * (k + 0.5) / 4)]) };
const box = { points: [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]] };
const KINDS = { boxes: [box], octagons: [octagon], mixed: [box, octagon, { radius: 0.5 }] };

/** A grid of bodies a little turned, between two walls: twice as wide as high. */
function grid(kind, count, apart) {
    state = 1;
    const columns = Math.round(Math.sqrt(2 * count)), half = apart * columns / 2, shapes = KINDS[kind];
    const bodies = Array.from({ length: count }, (_, k) => ({ x: apart * (k % columns + 0.5) - half + 0.02 * (random() - 0.5), y: apart * (Math.floor(k / columns) + 0.6), angle: 0.1 * (random() - 0.5), shape: k % shapes.length }));
    const walls = [{ x: 0, y: -1, width: 2 * half + 8, height: 2 }, ...[-1, 1].map((side) => ({ x: side * (half + 1.2), y: 1000, width: 2, height: 2004 }))];
    return { shapes, bodies, walls, half, top: apart * Math.ceil(count / columns) };
}

/** How deep bodies are in each other, how many touch, and how fast they are. */
function judge({ shapes, bodies, walls }, poses) {
    const store = narc.shapes(), rows = narc.bodies(bodies.length + walls.length);
    const numbers = shapes.map((shape) => shape.radius ? store.circle(shape.radius) : store.polygon(shape.points)), masses = shapes.map((shape) => narc.outlines.mass(shape.radius ? narc.outlines.circle(shape.radius) : narc.outlines.polygon(shape.points)));
    let energy = 0;
    bodies.forEach(({ shape }, k) => {
        const [x, y, angle, vx, vy, spin] = poses[k], { area, secondMoment } = masses[shape];
        Object.assign(rows.at(k), { x, y, cosine: Math.cos(angle), sine: Math.sin(angle), shape: numbers[shape] });
        energy += area * (vx * vx + vy * vy) / 2 + secondMoment * spin * spin / 2;
    });
    walls.forEach(({ x, y, width, height }, k) => Object.assign(rows.at(bodies.length + k), { x, y, shape: store.box(width, height) }));
    const pairs = narc.pairs(store, rows, { margin: 0.01 }), found = narc.contacts(store, rows, pairs, { margin: 0.01 });
    let deepest = 0, contacts = 0;
    for (const { pair, separation } of found) {
        if (pairs.array[2 * pair] >= bodies.length && pairs.array[2 * pair + 1] >= bodies.length)
            continue; // walls
        deepest = Math.max(deepest, -separation);
        contacts++;
    }
    for (const one of [store, rows, pairs, found])
        one.free();
    return { deepest, contacts, energy: energy / bodies.length };
}

const file = join(out, "start.json"), lines = [];
const say = (line) => {
    lines.push(line);
    console.log(line);
};

async function scene(kind, count, falling) {
    const start = grid(kind, count, falling ? 1.4 : 1.12), steps = Number(values.steps), settle = falling ? 90 : Number(values.settle);
    writeFileSync(file, JSON.stringify(start));
    const first = new Engine("narc", file);
    await first.answer();
    await first.ask("steps", { count: settle, limit: Infinity });
    const settled = await first.ask("poses");
    first.end();
    settled.forEach(([x, y, angle], k) => Object.assign(start.bodies[k], { x, y, angle })); // from rest: engines do not begin with impulses
    writeFileSync(file, JSON.stringify(start));
    const before = judge(start, settled.map(([x, y, angle]) => [x, y, angle, 0, 0, 0])), engines = [];
    say(`\n### ${count.toLocaleString("en")} ${kind}, ${falling ? "falling" : "settled"}: ${before.contacts.toLocaleString("en")} contacts, deepest ${(1000 * before.deepest).toFixed(2)} mm at the start\n`);
    for (const name of values.engines.split(",")) {
        const engine = new Engine(name, file);
        Object.assign(engine, await engine.answer(), { ms: [] });
        if (!engine.version)
            throw new Error(`${name} does not start`);
        if (engine.steps) // the same start in each
            (await engine.ask("poses")).forEach(([x, y], k) => assert(Math.hypot(x - start.bodies[k].x, y - start.bodies[k].y) < 1e-4, `${name}: body ${k} starts elsewhere`));
        engines.push(engine);
    }
    const top = Math.max(...start.bodies.map(({ y }) => y)) + 1, reach = top + 2;
    const rays = Array.from({ length: 2000 }, () => { const a = -Math.PI / 2 + 1.2 * (random() - 0.5); return [1.8 * start.half * (random() - 0.5), top, reach * Math.cos(a), reach * Math.sin(a)]; });
    const regions = Array.from({ length: 2000 }, () => { const x = 1.8 * start.half * (random() - 0.5), y = (top - 1) * random(); return [x, y, x + 3, y + 3]; });
    for (const engine of engines.filter((one) => one.steps)) // JavaScript is compiled as it runs
        engine.warm = (await engine.ask("steps", { count: Number(values.warm), limit: 1000 * Number(values.limit) })).length;
    const chunk = 5, spent = (engine) => engine.ms.reduce((sum, ms) => sum + ms, 0);
    for (let k = 0; k < steps; k += chunk)
        for (const engine of engines)
            if (engine.steps && spent(engine) < 1000 * Number(values.limit))
                engine.ms.push(...await engine.ask("steps", { count: Math.min(chunk, steps - k), limit: 1000 * Number(values.limit) }));
    say("| engine | ms a step, quickest tenth | of narc's | median | steps | contacts | deepest, mm | energy, mJ a body |\n|---|--:|--:|--:|--:|--:|--:|--:|");
    const own = quick(engines.find(({ name }) => name === "narc")?.ms ?? [NaN]);
    for (const engine of engines.filter((one) => one.steps)) {
        const told = judge(start, await engine.ask("poses")), ms = quick(engine.ms);
        say(`| ${engine.name} ${engine.version} | ${ms.toFixed(2)} | ${(ms / own).toFixed(2)} | ${median(engine.ms).toFixed(2)} | ${engine.warm + engine.ms.length} | ${told.contacts} | ${(1000 * told.deepest).toFixed(2)} | ${(1000 * told.energy).toFixed(2)} |`);
    }
    for (const engine of engines)
        engine.end();
    if (falling)
        return;
    // Questions to the start itself, in turns: the same bodies in all.
    const asked = [];
    for (const { name } of engines) {
        const engine = new Engine(name, file);
        Object.assign(engine, await engine.answer());
        if (engine.steps && name !== "narc" && name !== "matter")
            await engine.ask("steps", { count: 1, limit: Infinity }); // in which they make their trees
        await engine.ask("begin");
        asked.push(Object.assign(engine, { all: { rays: [], regions: [] } }));
    }
    for (let round = 0; round < 8; round++)
        for (const engine of asked)
            for (const [word, given] of [["rays", rays], ["regions", regions]]) {
                const told = await engine.ask(word, given);
                if (told && round > 0) // the first round is for the compiler
                    engine.all[word].push(told);
            }
    say("\n| engine | µs a ray | mean fraction | µs a region | bodies a region |\n|---|--:|--:|--:|--:|");
    for (const engine of asked) {
        const tell = (list, digits) => list.length ? [(1000 * quick(list.map(({ ms }) => ms)) / list[0].out.length).toFixed(2), (list[0].out.reduce((a, b) => a + b, 0) / list[0].out.length).toFixed(digits)] : ["–", "–"];
        say(`| ${engine.name} ${engine.version} | ${tell(engine.all.rays, 4).join(" | ")} | ${tell(engine.all.regions, 2).join(" | ")} |`);
        engine.end();
    }
}

mkdirSync(out, { recursive: true });
say(`node ${process.version}, ${cpus()[0].model.trim()}`);
for (const count of values.bodies.split(",").map(Number)) {
    for (const kind of values.scenes.split(",").filter((one) => one in KINDS))
        await scene(kind, count, false);
    if (values.scenes.includes("falling") && count >= 20000)
        await scene("boxes", count, true);
}
writeFileSync(join(out, "bench-web.md"), `${lines.join("\n")}\n`);
