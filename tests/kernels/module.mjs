// SPDX-License-Identifier: MIT
// The core as a WebAssembly module, from JavaScript: node module.mjs MODULE MOST_BYTES ISA. It has at most so many bytes as
// gzip packs it, imports nothing, but for shared memory, has this instruction set, builds a capsule, stores it and gives it back.
import assert from "node:assert";
import { readFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

const [path, most, isa] = process.argv.slice(2), bytes = readFileSync(path), packed = gzipSync(bytes, { level: 9 }).length;
console.log(`${path}: ${bytes.length} bytes, ${packed} packed, at most ${most}`);
assert(packed <= Number(most));

const module = await WebAssembly.compile(bytes), imports = WebAssembly.Module.imports(module);
assert.deepEqual(imports.filter(({ module, name, kind }) => `${module} ${name} ${kind}` !== "env memory memory"), []);
const shared = imports.length > 0 ? new WebAssembly.Memory({ initial: 64, maximum: 32768, shared: true }) : undefined;
const { exports: narc } = await WebAssembly.instantiate(module, { env: { memory: shared } }), memory = shared ?? narc.memory;
narc._initialize();
const view = () => new DataView(memory.buffer), place = narc.malloc(4096);
const name = new Uint8Array(memory.buffer, narc.narc_get_isa(), isa.length + 1);
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
