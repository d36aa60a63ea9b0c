// SPDX-License-Identifier: MIT
// The core as a WebAssembly module, from JavaScript: node module.mjs MODULE MOST_BYTES ISA. It has at most so many bytes as
// gzip packs it, imports nothing, has this instruction set, builds a capsule, stores it and gives it back.
import assert from "node:assert";
import { readFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

const [path, most, isa] = process.argv.slice(2), bytes = readFileSync(path), packed = gzipSync(bytes, { level: 9 }).length;
console.log(`${path}: ${bytes.length} bytes, ${packed} packed, at most ${most}`);
assert(packed <= Number(most));

const { instance } = await WebAssembly.instantiate(bytes);
instance.exports._initialize();
const narc = instance.exports, view = () => new DataView(narc.memory.buffer), place = narc.malloc(4096);
const name = new Uint8Array(narc.memory.buffer, narc.narc_get_isa(), isa.length + 1);
assert.equal(String.fromCharCode(...name), `${isa}\0`);
assert.equal(narc.narc_create_shapes(0, place), 0);
const shapes = view().getUint32(place, true);
assert.equal(narc.narc_build_capsule(6, 1, place + 16, place + 8, 0), 0);
assert.equal(narc.narc_add_shape(shapes, place + 16, view().getUint32(place + 8, true), place + 4, 0), 0);
assert.equal(narc.narc_get_arcs(shapes, view().getUint32(place + 4, true), place + 1024), 2);
for (const name of ["overlaps", "contacts", "manifolds", "distances", "nearest"])
    assert.equal(typeof narc[`narc_find_${name}`], "function");
for (const name of ["rays", "pairs", "shapes"])
    assert.equal(typeof narc[`narc_cast_${name}`], "function");
