// SPDX-License-Identifier: MIT
// What compiles with strict types, and what must not.
import { type Contact, load, NarcError, type Rows } from "../package/narc.js";

const narc = await load({ build: "small" });
const shapes = narc.shapes(), bodies = narc.bodies(2), pairs = Uint32Array.of(0, 1);
shapes.polygon([[0, 0], [1, 0], [0, 1]]);
const rows: Rows<Contact> = narc.contacts(shapes, bodies, pairs, { margin: 1, margins: narc.floats(1).column });
const separation: number = rows.at(0).separation;
const id: bigint = narc.contactsThatStay().update(shapes, { x: 0, y: new Float64Array(1), cosine: 1, sine: 0, shape: 0 }).began(0).idA;
export const used = [separation, id, NarcError];
await load({ module: new URL("./narc.wasm", import.meta.url), threads: 2 });
// @ts-expect-error: no such option
narc.contacts(shapes, bodies, pairs, { margn: 1 });
// @ts-expect-error: positions of integers
narc.contacts(shapes, { x: new Int32Array(1), y: 0, cosine: 1, sine: 0, shape: 0 }, pairs);
// @ts-expect-error: no such member
rows.at(0).depth;
// @ts-expect-error: a store is wanted
narc.index(bodies, bodies);
