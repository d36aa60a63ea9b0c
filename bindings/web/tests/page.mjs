// SPDX-License-Identifier: MIT
// The page in headless Chromium: node page.mjs PAGE TOOLS OUT WORLD. TOOLS has puppeteer-core, OUT gets pictures, WORLD is the example's
// program, whose bits are to be the page's.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { serve } from "./serve.mjs";

const [folder, tools, out, world] = process.argv.slice(2);
const puppeteer = createRequire(resolve(tools, "x.js"))("puppeteer-core");
const { address, end } = await serve(folder);
const browser = await puppeteer.launch({ executablePath: process.env["CHROMIUM"] ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
const said = [];

async function open(hash = "", { width = 1440, height = 900, touch = false, dark = false, calm = false } = {}) {
    const tab = await browser.newPage();
    tab.on("console", (message) => said.push(message.text()));
    tab.on("pageerror", (error) => said.push(String(error)));
    tab.on("requestfailed", (request) => said.push(request.url()));
    tab.on("request", (request) => assert(request.url().startsWith(address) || request.url().startsWith("data:"), request.url()));
    await tab.setViewport({ width, height, hasTouch: touch, isMobile: touch });
    await tab.emulateMediaFeatures([{ name: "prefers-color-scheme", value: dark ? "dark" : "light" },
        { name: "prefers-reduced-motion", value: calm ? "reduce" : "no-preference" }]);
    await tab.goto(`${address}${hash}`);
    await tab.waitForFunction("globalThis.page !== undefined");
    return tab;
}
const steps = (tab, count) => tab.evaluate((n) => {
    for (let k = 0; k < n; k++)
        if (!page.step())
            throw new Error(page.text(page.core.error()));
}, count);
const pressed = (tab, id) => tab.$eval(`#${id}`, (button) => button.getAttribute("aria-pressed"));
const wait = (ms) => new Promise((done) => setTimeout(done, ms));
/** Where a moving body is on the screen, the highest one. */
const bodyAt = (tab, least = -Infinity) => tab.evaluate((low) => {
    const count = page.core.draw(), f32 = new Float32Array(page.core.memory.buffer), u32 = new Uint32Array(page.core.memory.buffer), base = page.core.drawn() / 4, v = page.view();
    let best = null;
    for (let k = 0; k < count; k++)
        if (!(u32[base + 6 * k + 5] & 14) && f32[base + 6 * k + 1] > low && (!best || f32[base + 6 * k + 1] > best.y))
            best = { k, x: f32[base + 6 * k], y: f32[base + 6 * k + 1] };
    const { left, top } = document.getElementById("canvas").getBoundingClientRect();
    return { ...best, px: left + (v.x + v.scale * best.x) / v.ratio, py: top + (v.y - v.scale * best.y) / v.ratio };
}, least);

async function test(name, run) {
    const begin = Date.now();
    await run();
    assert.deepEqual(said, [], name);
    console.log(`ok - ${name} (${((Date.now() - begin) / 1000).toFixed(1)} s)`);
}

try {
    await test("it starts, moves at once, and draws in time", async () => {
        const tab = await open();
        assert.equal(await tab.evaluate(() => page.core.body_count()), 1000);
        const before = await tab.evaluate(() => page.hash());
        for (let k = 0; k < 40 && await tab.evaluate(() => page.hash()) === before; k++) // other programs may run, too
            await wait(250);
        assert.notEqual(await tab.evaluate(() => page.hash()), before);
        await wait(2500);
        await tab.click("#pause");
        await steps(tab, 400);
        await tab.screenshot({ path: join(out, "well.png") });
        const { step, draw } = await tab.evaluate(() => page.times);
        console.log(`  1,000 bodies: step ${step.toFixed(1)} ms, drawing ${draw.toFixed(1)} ms`);
        const frames = await tab.evaluate(() => { // each by itself, while they fall and lie
            const all = [];
            page.start("well", 1);
            for (let k = 0; k < 600; k++) {
                const begin = performance.now();
                page.step();
                const between = performance.now();
                page.draw();
                all.push([between - begin, performance.now() - between]);
            }
            return all;
        });
        const median = (list) => list.sort((a, b) => a - b)[300].toFixed(1);
        console.log(`  median of 600 frames: step ${median(frames.map(([ms]) => ms))} ms, drawing ${median(frames.map(([, ms]) => ms))} ms, both ${median(frames.map(([a, b]) => a + b))} ms`);
        await tab.close();
    });
    await test("after 600 steps the state has the native bits", async () => {
        const tab = await open("", { calm: true });
        for (const name of ["well", "wheels", "looping", "car", "bullets", "plates", "dominoes", "platforms", "rain", "stack"]) {
            await tab.evaluate((scene) => page.start(scene, 1), name);
            await steps(tab, 600);
            const native = /state ([0-9a-f]+)/.exec(execFileSync(world, [name, "--seconds", "10"], { encoding: "utf8" }))[1];
            assert.equal(await tab.evaluate(() => page.hash()), native, name);
        }
        await tab.close();
    });
    await test("bodies come to rest", async () => {
        const tab = await open("#scene=pyramid&seed=1", { calm: true });
        await steps(tab, 600);
        assert.equal(await tab.evaluate(() => page.core.moving_count()), 0);
        await tab.close();
    });
    await test("the pointer moves a body", async () => {
        const tab = await open("#scene=pyramid&seed=2", { calm: true });
        await steps(tab, 60);
        const from = await bodyAt(tab);
        await tab.mouse.move(from.px, from.py);
        await tab.mouse.down();
        await tab.mouse.move(from.px + 150, from.py - 60, { steps: 5 });
        await steps(tab, 60);
        const to = await bodyAt(tab, from.y);
        assert(to.x > from.x + 1, `${from.x} ${to.x}`);
        await tab.mouse.up();
        await steps(tab, 120);
        await tab.close();
    });
    await test("an outline becomes a body", async () => {
        const tab = await open("#scene=stack&seed=1", { calm: true }), count = await tab.evaluate(() => page.core.body_count());
        await tab.keyboard.press("d");
        assert.equal(await pressed(tab, "draw"), "true");
        const { x, y, width, height } = await (await tab.$("#canvas")).boundingBox(), at = (k) => [x + width * 0.25 + 80 * Math.cos(k / 4), y + height * 0.4 - 50 * Math.sin(k / 4)];
        await tab.mouse.move(...at(0));
        await tab.mouse.down();
        for (let k = 1; k < 24; k++)
            await tab.mouse.move(...at(k));
        await wait(100);
        await tab.mouse.up();
        assert.equal(await tab.evaluate(() => page.core.body_count()), count + 1);
        assert.match(await tab.$eval("#message", (p) => p.textContent), /n-arc of 8 arcs/);
        await wait(100);
        await tab.screenshot({ path: join(out, "draw.png") });
        await tab.close();
    });
    await test("all tabs and overlays by keyboard", async () => {
        const tab = await open("", { calm: true }), names = await tab.$$eval("#tabs button", (all) => all.map((button) => button.dataset.scene));
        for (const [k, name] of names.entries()) {
            if (k === 10)
                await tab.focus("#tabs [aria-selected=true]");
            await tab.keyboard.press(k < 10 ? String((k + 1) % 10) : "ArrowRight");
            assert.equal(await tab.$eval("#tabs [aria-selected=true]", (button) => button.dataset.scene), name);
            assert.match(await tab.evaluate(() => location.hash), new RegExp(`scene=${name}&seed=1`));
            if (name === "pairs" || name === "many")
                await tab.waitForFunction((own) => page.own[own], {}, name);
            else
                await steps(tab, 120);
            await wait(60);
            await tab.screenshot({ path: join(out, `${name}-tab.png`) });
        }
        await tab.keyboard.press("1");
        await tab.focus("#tabs [aria-selected=true]");
        await tab.keyboard.press("ArrowRight");
        assert.equal(await tab.$eval("#tabs [aria-selected=true]", (button) => button.dataset.scene), names[1]);
        await tab.keyboard.press("0"); // the pyramid
        await steps(tab, 60);
        for (const [key, id] of [["c", "contacts"], ["a", "arcs"], ["b", "boxes"], ["t", "tree"], ["z", "sleep"], ["l", "rays"], ["s", "slow"]]) {
            await tab.keyboard.press(key);
            assert.equal(await pressed(tab, id), "true", id);
        }
        await wait(100);
        await tab.screenshot({ path: join(out, "overlays.png") });
        const tree = await tab.evaluate(() => { // leaves in larger boxes, up to one around all
            const count = page.core.grow(), f32 = new Float32Array(page.core.memory.buffer), u32 = new Uint32Array(page.core.memory.buffer), base = page.core.nodes() / 4;
            const nodes = Array.from({ length: count }, (_, k) => [...f32.subarray(base + 5 * k, base + 5 * k + 4), u32[base + 5 * k + 4]]), root = nodes.at(-1);
            return { levels: root[4], bodies: page.core.body_count(), leaves: nodes.filter((node) => node[4] === 0).length,
                held: nodes.every(([x0, y0, x1, y1]) => x0 > x1 || (root[0] <= x0 && root[1] <= y0 && x1 <= root[2] && y1 <= root[3])) };
        });
        assert(tree.held && tree.levels > 0 && tree.leaves * 8 >= tree.bodies, JSON.stringify(tree));
        const unlabelled = await tab.$$eval("button, select, [tabindex]", (all) => all.filter((one) => !one.textContent.trim() && !one.getAttribute("aria-label")).length);
        assert.equal(unlabelled, 0);
        // Arcs of the scene before are forgotten: a drawn outline may have had the number of a shape.
        assert(await tab.evaluate(() => page.lit().length) > 0);
        assert.equal(await tab.evaluate(() => (page.start("stack", 1), page.lit().length)), 0);
        await tab.close();
    });
    await test("arcs roll further than corners", async () => {
        const tab = await open("#scene=wheels&seed=1", { calm: true });
        await steps(tab, 300);
        await wait(100);
        await tab.screenshot({ path: join(out, "wheels.png") });
        const [smooth, cornered] = await tab.evaluate(() => {
            page.core.draw();
            const f32 = new Float32Array(page.core.memory.buffer), base = page.core.drawn() / 4;
            return [f32[base], f32[base + 6]];
        });
        assert(smooth > cornered + 3, `${smooth} ${cornered}`);
        const speeds = await tab.evaluate(() => page.speeds());
        assert(speeds.length === 300 && speeds[299][0] > 2 * speeds[299][1], `${speeds[299]}`);
        await tab.close();
    });
    await test("nothing passes a thin plate", async () => {
        const tab = await open("#scene=plates&seed=1", { calm: true });
        for (let k = 0; k < 8; k++) {
            await steps(tab, 90);
            const { flown, through } = await tab.evaluate(() => page.shots());
            assert(flown > 90 * k / 120 * 16 && through === 0, `${through} of ${flown}`);
        }
        await tab.close();
    });
    await test("two shapes: what decides is what the formula says", async () => {
        const tab = await open("#scene=pairs&seed=1", { calm: true });
        await tab.waitForFunction(() => page.own.pairs && page.view());
        const { x, y, width, height } = await (await tab.$("#canvas")).boundingBox();
        const asked = () => tab.evaluate(() => {
            const { separation, features, all, gap } = page.own.pairs.ask();
            return { separation, arcs: features.every((feature) => !(feature & 64)), best: Math.max(...all.map((pair) => pair.gap)), gap };
        });
        const seen = new Set();
        let met = 0;
        for (let seed = 1; seed <= 8; seed++) {
            await tab.evaluate((from) => page.own.pairs.start(from), seed);
            for (let k = 0; k < 12; k++) {
                await tab.mouse.move(x + width * (0.5 + 0.4 * Math.cos(k)), y + height * (0.5 + 0.4 * Math.sin(k)));
                const { separation, arcs, best, gap } = await asked();
                seen.add(separation);
                assert(Math.abs(separation - gap) < 1e-5, `${separation} ${gap}`);
                if (arcs) {
                    assert(Math.abs(separation - best) < 1e-5, `${separation} ${best}`);
                    met++;
                }
            }
        }
        assert(met > 20 && seen.size > 60, `${met} ${seen.size}`);
        await tab.evaluate(() => page.own.pairs.start(1));
        await tab.mouse.move(x + width * 0.66, y + height * 0.5);
        await tab.mouse.down();
        await tab.mouse.move(x + width * 0.9, y + height * 0.4, { steps: 3 });
        await tab.mouse.up();
        assert((await asked()).separation > 0);
        await tab.evaluate(() => page.own.pairs.start(1));
        await wait(100);
        await tab.screenshot({ path: join(out, "pairs.png") });
        await tab.close();
    });
    await test("20,000 bodies: the same rows in both builds", async () => {
        const tab = await open("#scene=many&seed=1", { calm: true });
        await tab.waitForFunction(() => page.own.many && page.view());
        const same = await tab.evaluate(() => {
            page.own.many.start(2);
            page.own.many.step();
            page.own.many.step(); // which asks both
            const [fast, plain] = page.own.many.rows(), bytes = fast.count * fast.size;
            return fast.count > 1000 && fast.count === plain.count && fast.u8.subarray(0, bytes).every((byte, k) => byte === plain.u8[k]);
        });
        assert(same);
        const threads = await tab.evaluate(async () => { // the same in a page that is isolated, by workers
            const { load } = await import("./narc/narc.js"), answers = [];
            for (const narc of [await load(), await load({ threads: 2 })]) {
                const shapes = narc.shapes(), shape = shapes.ellipse(0.6, 0.4, 8), bodies = narc.bodies(4000);
                for (let k = 0; k < 4000; k++)
                    Object.assign(bodies.at(k), { x: 0.7 * (k % 60), y: 0.7 * Math.floor(k / 60), cosine: Math.cos(k), sine: Math.sin(k), shape });
                const rows = narc.contacts(shapes, bodies, narc.pairs(shapes, bodies));
                answers.push(rows.u8.slice(0, rows.count * rows.size));
                narc.end();
            }
            return crossOriginIsolated && answers[0].length > 1e5 && answers[0].length === answers[1].length && answers[0].every((byte, k) => byte === answers[1][k]);
        });
        assert(threads);
        await wait(300);
        assert.match(await tab.$eval("#message", (p) => p.textContent),
            /^[1-9][\d,]+ pairs .* takes [1-9]\d* ns in a batch with vectors, [1-9]\d* ns .*\(\d+\.\d times\), [1-9]\d* ns one by one .*\(\d+\.\d times\)/);
        await tab.close();
    });
    await test("an outline is told as n-arcs beside polygons; a line becomes ground, and the address has it", async () => {
        const tab = await open("#scene=draw&seed=1", { calm: true }), { x, y, width, height } = await (await tab.$("#canvas")).boundingBox();
        const stroke = async (from, way) => {
            await tab.mouse.move(...way(0));
            await tab.mouse.down();
            for (let k = 1; k <= from; k++)
                await tab.mouse.move(...way(k / from));
            await wait(60);
            await tab.mouse.up();
        };
        await stroke(40, (t) => [x + width * 0.5 + 120 * Math.cos(6.1 * t), y + height * 0.7 - 75 * Math.sin(6.1 * t)]);
        await tab.waitForFunction(() => page.fits());
        const away = await tab.evaluate(() => page.fits().all.map((fit) => fit.away));
        assert(away.length === 4 && away[3] < 0.1 && away[3] < away[0], `${away}`);
        await wait(100);
        await tab.screenshot({ path: join(out, "draw-tab.png") });
        await tab.keyboard.press("4");
        await stroke(60, (t) => [x + width * (0.05 + 0.9 * t), y + height * (0.6 + 0.1 * Math.sin(9 * t))]);
        assert.match(await tab.$eval("#message", (p) => p.textContent), /The car drives it/);
        const [ground, hash] = await tab.evaluate(() => [page.ground(), location.hash]);
        const before = await tab.evaluate(() => { page.core.draw(); return new Float32Array(page.core.memory.buffer)[page.core.drawn() / 4]; });
        await steps(tab, 200);
        const after = await tab.evaluate(() => { page.core.draw(); return new Float32Array(page.core.memory.buffer)[page.core.drawn() / 4]; });
        assert(after > before + 5, `${before} ${after}`);
        await wait(100);
        await tab.screenshot({ path: join(out, "ground-tab.png") });
        const state = await tab.evaluate(() => page.hash());
        const other = await open(hash, { calm: true });
        assert.deepEqual(await other.evaluate(() => page.ground()), ground);
        await steps(other, 200);
        assert.equal(await other.evaluate(() => page.hash()), state);
        await other.close();
        await tab.close();
    });
    await test("keys are shown where there are keys", async () => {
        const tab = await open("", { calm: true, touch: true }), shown = () => tab.$eval("#pause", (button) => getComputedStyle(button, "::after").content);
        assert.equal(await shown(), "none");
        await tab.mouse.move(300, 300);
        assert.equal(await shown(), '"␣"');
        await tab.screenshot({ path: join(out, "keys.png") });
        await tab.touchscreen.tap(300, 300);
        assert.equal(await shown(), "none");
        await tab.close();
    });
    await test("rays end where bodies are", async () => {
        const tab = await open("#scene=well&seed=1", { calm: true });
        await steps(tab, 500);
        await tab.keyboard.press("l");
        const { x, y, width, height } = await (await tab.$("#canvas")).boundingBox();
        await tab.mouse.move(x + width / 2, y + height * 0.3);
        await wait(200);
        await tab.screenshot({ path: join(out, "rays.png") });
        const hits = await tab.evaluate(() => {
            const count = page.core.scan(0, 30, 60), f32 = new Float32Array(page.core.memory.buffer), base = page.core.points() / 4;
            return Array.from({ length: count }, (_, k) => [f32[base + 4 * k], f32[base + 4 * k + 1], f32[base + 4 * k + 2]]);
        });
        assert.equal(hits.length, 1080);
        assert(Math.abs(hits[0][0] - 20) < 1e-4 && hits[0][2] === -1, `${hits[0]}`); // the wall on the right
        assert(hits[810][1] > 0 && hits[810][1] < 30); // straight down: what lies on top
        await tab.close();
    });
    await test("a phone: touch, 360 pixels wide, dark", async () => {
        const tab = await open("#scene=pyramid&seed=3", { width: 360, height: 740, touch: true, dark: true, calm: true });
        await steps(tab, 60);
        const from = await bodyAt(tab);
        await tab.touchscreen.touchStart(from.px, from.py);
        await tab.touchscreen.touchMove(from.px + 40, from.py - 30);
        await steps(tab, 40);
        const to = await bodyAt(tab, from.y);
        assert(to.y > from.y + 0.5, `${from.y} ${to.y}`);
        await tab.touchscreen.touchEnd();
        assert(await tab.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
        await tab.setViewport({ width: 1000, height: 500, hasTouch: true, isMobile: true });
        await wait(200);
        const [wide, ratio] = await tab.evaluate(() => [document.getElementById("canvas").width, page.view().ratio]);
        assert(Math.abs(wide / ratio - 1000) < 60, `${wide}`);
        await tab.setViewport({ width: 360, height: 740, hasTouch: true, isMobile: true });
        await tab.evaluate(() => page.start("well", 1));
        await steps(tab, 400);
        await wait(200);
        await tab.screenshot({ path: join(out, "phone.png") });
        await tab.close();
    });
} finally {
    await browser.close();
    end();
}
