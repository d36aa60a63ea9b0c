// SPDX-License-Identifier: MIT
// The page's engine without a browser: node engine.mjs PAGE_WASM WORLD. Every scene of the examples has, after 600 steps, the bits of
// the native program WORLD, which has the same sines. And bullets of 400 m/s do not pass a plate.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";

const [file, world] = process.argv.slice(2), { instance } = await WebAssembly.instantiate(readFileSync(file)), core = instance.exports;
assert.deepEqual(WebAssembly.Module.imports(new WebAssembly.Module(readFileSync(file))), []);
core._initialize?.();
const text = (pointer) => {
    const bytes = new Uint8Array(core.memory.buffer, pointer);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
};
const hash = () => [core.hash_high(), core.hash_low()].map((half) => (half >>> 0).toString(16).padStart(8, "0")).join("");
const own = new Set(["draw", "ground"]);
let count = 0;
for (let k = 0; text(core.scene_name(k)); k++) {
    const name = text(core.scene_name(k));
    assert.equal(core.start(k, 1), 0, name);
    const right = []; // of the plate; each flies from its side again every 120 steps, and between may go over the top
    for (let step = 0; step < 600; step++) {
        assert.equal(core.step(), 0, name);
        if (name === "plates")
            for (let body = 2; body < 18; body++) {
                core.draw();
                const [x, y] = new Float32Array(core.memory.buffer, core.drawn() + 24 * body, 2);
                right[body] = step === 0 || step % 120 === 119 ? body % 2 === 1 : y > 7 ? x > 0 : right[body];
                assert((x > 0) === right[body], `step ${step}: body ${body} came through`);
            }
    }
    if (own.has(name))
        continue;
    assert.equal(hash(), /state ([0-9a-f]+)/.exec(execFileSync(world, [name, "--seconds", "10"], { encoding: "utf8" }))[1], name);
    count++;
}
assert(count > 10);
console.log(`${count} scenes have the native bits`);
