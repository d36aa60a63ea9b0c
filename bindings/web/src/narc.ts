// SPDX-License-Identifier: MIT
// narc: exact collision of many pairs of shapes that are made of arcs. load() gives the module; all else hangs on it.
import { type Body, type BoxOptions, type CastOptions, type ChainEntry, type Contact, type ContactsSettingsOptions, type Distance,
    type IndexOptions, layouts, type Manifold, type MotionsOptions, type PairFilterOptions, type PairsOptions, type PointsOptions,
    type QueryOptions, type RaysOptions, type RayOptions, type Box as BoxRow, type Impact, type RayHit, type RefinedContact, version } from "./layouts.js";
import { type Bodies, countOf, type IndexColumn, Memory, number, Numbers, Rows, rowsOf, whole } from "./memory.js";
import { type NamedShape, Outlines, readShapes, Shapes, writeShapes } from "./outlines.js";
import { Contacts, Index } from "./scene.js";
import { type Range, Threads } from "./threads.js";

export * from "./layouts.js";
export { type Bodies, type ByteColumn, Column, Cursor, type FloatColumn, type IndexColumn, type Items, NarcError, Numbers, Owned, type PositionColumn, Rows,
    type WordColumn } from "./memory.js";
export { type Arcs, type Extent, type NamedShape, Outlines, type Points, Shapes } from "./outlines.js";
export { Contacts, Index, type Search } from "./scene.js";

/** Pairs of bodies: numbers a, b of one pair after the other, or columns and more (narc_pairs). */
export type PairList = Uint32Array | Numbers<Uint32Array> | (PairsOptions & { count?: number | undefined });

export interface LoadOptions {
    /** The fast one needs simd128, the small one has no chains and no compounds. By default what runs here. */
    build?: "fast" | "small";
    /** Where the module is, its bytes, or itself compiled; by default the file beside this one, which bundlers are to copy.
     * With threads it is narc_threads.wasm. */
    module?: URL | BufferSource | WebAssembly.Module;
    /** So many workers take parts of large batches of pairs: 0, none, by default. They need shared memory, which pages have that are
     * isolated (crossOriginIsolated), and the fast build. */
    threads?: number;
}

const BODIES = rowsOf(layouts.Body);

/** Does WebAssembly have vectors here? */
export function hasSimd(): boolean {
    const vector = [0xfd, 0x0c, ...Array<number>(16).fill(0)]; // v128.const 0
    return WebAssembly.validate(Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 22, 1, 20, 0, ...vector, 11));
}

async function fetchModule(url: URL): Promise<BufferSource> {
    if (url.protocol !== "file:") {
        const response = await fetch(url);
        if (!response.ok)
            throw new Error(`${url}: ${response.status} ${response.statusText}; where a bundler does not copy it, load({ module: url }) tells where it is`);
        return response.arrayBuffer();
    }
    const files = "node:fs/promises";
    const { readFile } = await import(/* webpackIgnore: true */ /* @vite-ignore */ files) as { readFile: (url: URL) => Promise<Uint8Array<ArrayBuffer>> };
    return readFile(url);
}

/** Loads the module. Each call gives one with a memory of its own. */
export async function load(options: LoadOptions = {}): Promise<Narc> {
    if (typeof WebAssembly !== "object")
        throw new Error("this browser lacks WebAssembly");
    const build = options.build ?? (hasSimd() ? "fast" : "small");
    if (build !== "fast" && build !== "small")
        throw new TypeError(`build: "fast" or "small" is wanted`);
    const threads = whole(options.threads ?? 0, "threads", 65);
    if (threads > 0 && build === "small")
        throw new TypeError("threads: the small build has none");
    if (threads > 0 && typeof SharedArrayBuffer !== "function")
        throw new Error("threads: there is no shared memory here; the page is to be isolated (crossOriginIsolated)");
    const from = options.module ?? (threads > 0 ? new URL("./narc_threads.wasm", import.meta.url)
        : build === "fast" ? new URL("./narc.wasm", import.meta.url) : new URL("./narc_small.wasm", import.meta.url));
    const given = from instanceof URL ? await fetchModule(from) : from;
    const module = given instanceof WebAssembly.Module ? given : await WebAssembly.compile(given);
    if (threads === 0)
        return new Narc(new Memory(await WebAssembly.instantiate(module), build));
    const shared = new WebAssembly.Memory({ initial: 64, maximum: 32768, shared: true });
    const memory = new Memory(await WebAssembly.instantiate(module, { env: { memory: shared } }), build, shared);
    return new Narc(memory, await Threads.start(memory, module, shared, threads));
}

/** All that the core is asked of pairs of bodies, and what makes the rest. Calls take what lies in the module's memory (Rows,
 * Numbers) without a copy, and copy JavaScript's arrays. With `out` they write into rows that there are, which grow where they
 * must: then a step makes no garbage. */
export class Narc {
    readonly version = version;
    readonly outlines: Outlines;
    readonly #boxes: Rows<BoxRow>;
    readonly #broad: number;
    readonly #contact: Rows<Contact>;
    readonly #manifold: Rows<Manifold>;
    readonly #one: number;
    #lastMargin = 0;
    #skipped = 0;

    /** @internal */
    constructor(readonly memory: Memory, readonly threads?: Threads) {
        this.outlines = new Outlines(memory);
        this.#boxes = new Rows(memory, layouts.Box, 64);
        memory.check(memory.function("narc_create_broad_phase")(0, memory.out));
        this.#broad = memory.u32[memory.out >> 2]!;
        this.#contact = new Rows(memory, layouts.Contact, 1, 1);
        this.#manifold = new Rows(memory, layouts.Manifold, 1, 1);
        this.#one = memory.allocate(layouts.Query.size);
    }

    /** Ends the workers, if there are any. */
    end(): void {
        this.threads?.end();
    }

    get build(): "fast" | "small" {
        return this.memory.build;
    }

    // ---------------------------------------------------------------------------- what there is

    shapes(): Shapes {
        return new Shapes(this.memory, this.outlines);
    }
    /** A store from what Shapes.save() gave. */
    loadShapes(bytes: Uint8Array): Shapes {
        const { memory } = this;
        if (!(bytes instanceof Uint8Array))
            throw new TypeError("bytes: Uint8Array is wanted");
        memory.begin();
        memory.call("narc_load_shapes", 0, memory.copy(bytes), bytes.length, memory.out);
        return new Shapes(memory, this.outlines, memory.u32[memory.out >> 2]!);
    }
    /** Reads a shapes file; with a store its shapes are added. */
    readShapes(text: string, store?: Shapes): NamedShape[] {
        return readShapes(this.outlines, text, store);
    }
    writeShapes(shapes: Parameters<typeof writeShapes>[0]): string {
        return writeShapes(shapes);
    }
    /** Room for bodies, `count` of which are there, not turned, of shape 0, scale 1, at (0, 0). */
    bodies(count: number): Rows<Body> {
        const rows = new Rows<Body>(this.memory, layouts.Body, count, count), { f32 } = rows;
        for (let k = 0; k < count; k++) {
            f32[8 * k + layouts.Body.members.cosine.offset / 4] = 1;
            f32[8 * k + layouts.Body.members.scale.offset / 4] = 1;
        }
        return rows;
    }
    contactRows(capacity: number): Rows<Contact> {
        return new Rows(this.memory, layouts.Contact, capacity);
    }
    manifoldRows(capacity: number): Rows<Manifold> {
        return new Rows(this.memory, layouts.Manifold, capacity);
    }
    rayHitRows(capacity: number): Rows<RayHit> {
        return new Rows(this.memory, layouts.RayHit, capacity);
    }
    impactRows(capacity: number): Rows<Impact> {
        return new Rows(this.memory, layouts.Impact, capacity);
    }
    distanceRows(capacity: number): Rows<Distance> {
        return new Rows(this.memory, layouts.Distance, capacity);
    }
    floats(count: number): Numbers<Float32Array> {
        return new Numbers(this.memory, Float32Array, count);
    }
    doubles(count: number): Numbers<Float64Array> {
        return new Numbers(this.memory, Float64Array, count);
    }
    indices(count: number): Numbers<Uint32Array> {
        return new Numbers(this.memory, Uint32Array, count);
    }
    words(count: number): Numbers<BigUint64Array> {
        return new Numbers(this.memory, BigUint64Array, count);
    }
    bytes(count: number): Numbers<Uint8Array> {
        return new Numbers(this.memory, Uint8Array, count);
    }
    /** A tree over bodies, for questions to a scene. */
    index(shapes: Shapes, bodies: Bodies, options?: IndexOptions): Index {
        return new Index(this, shapes, bodies, options);
    }
    /** Contacts that stay from step to step. */
    contactsThatStay(settings?: ContactsSettingsOptions): Contacts {
        return new Contacts(this.memory, settings);
    }

    // ---------------------------------------------------------------------------- what calls are given

    /** How many pairs there are. */
    #pairCount(pairs: PairList): number {
        if (pairs instanceof Uint32Array || pairs instanceof Numbers) {
            const length = pairs instanceof Numbers ? pairs.count : pairs.length;
            if (length % 2 !== 0)
                throw new RangeError(`pairs: ${length} numbers, two for each pair are wanted`);
            return length / 2;
        }
        if (typeof pairs !== "object" || pairs === null || Array.isArray(pairs) || ArrayBuffer.isView(pairs))
            throw new TypeError("pairs: Uint32Array, Numbers or columns are wanted");
        return countOf(pairs);
    }
    #pairs(pairs: PairList): number {
        const { memory } = this;
        if (!(pairs instanceof Uint32Array || pairs instanceof Numbers))
            return memory.columns(layouts.Pairs, pairs);
        const pointer = memory.clear(layouts.Pairs.size), { a, b } = layouts.Pairs.members;
        const at = pairs instanceof Numbers ? memory.place(pairs, "pairs", "Uint32Array") : memory.copy(pairs);
        memory.u32[pointer >> 2] = this.#pairCount(pairs);
        memory.u32[(pointer + a.offset) >> 2] = at;
        memory.u32[(pointer + b.offset) >> 2] = at + 4;
        memory.u32[(pointer + a.offset + 4) >> 2] = memory.u32[(pointer + b.offset + 4) >> 2] = 8;
        return pointer;
    }
    /** How many pairs, rays or points of the last call had no answer: a broken body, or one too far away. */
    get skipped(): number {
        return this.#skipped;
    }

    #rows<Row>(name: string, kind: string, out: Rows<Row>, shapes: Shapes, bodies: Bodies, pairs: PairList, options: QueryOptions | undefined): Rows<Row> {
        const { memory } = this, count = this.#pairCount(pairs), dense = Boolean(options?.dense);
        memory.room(out, "out", kind, count);
        for (;;) {
            memory.begin();
            const given = memory.bodies(bodies), asked = this.#pairs(pairs), query = this.#query(options, count);
            const parts = this.#divide(shapes, count, options);
            if (parts) {
                const { size } = out.layout, starts = parts.map(({ first }) => out.pointer + (dense ? 0 : first * size));
                const found = this.#spread(name, shapes, given, asked, query, parts, starts, parts.map((part) => dense ? out.capacity : part.count));
                if (found) {
                    let rows = found[0]!; // the first part's lie where they are to be
                    for (let k = 1; k < parts.length && !dense; rows += found[k++]!)
                        memory.u8.copyWithin(out.pointer + rows * size, starts[k]!, starts[k]! + found[k]! * size);
                    out.count = dense ? count : rows;
                    return out;
                }
            }
            const status = memory.function(name)(memory.place(shapes, "shapes", "Shapes"), given, asked, query, out.pointer, out.capacity, memory.out, memory.error);
            const fits = memory.fits(status), found = memory.u32[memory.out >> 2]!;
            if (fits) {
                this.#skipped = memory.u32[(memory.out >> 2) + 1]!;
                out.count = dense ? count : found;
                return out;
            }
            out.reserve(found);
        }
    }
    /** The parts of a batch for threads; none where one thread is to do it. */
    #divide(shapes: Shapes, count: number, options: QueryOptions | undefined): Range[] | undefined {
        if (!this.threads || shapes.mayHaveChains || options?.selection !== undefined || options?.first !== undefined || options?.count !== undefined || options?.rowStride !== undefined)
            return undefined;
        const parts = this.threads.divide(count);
        return parts.length > 1 ? parts : undefined;
    }
    /** Asks for all parts at once: how many rows each has; nothing on an error, which one thread then tells. */
    #spread(name: string, shapes: Shapes, bodies: number, pairs: number, query: number, parts: Range[], outs: number[], rooms?: number[]): number[] | undefined {
        const { memory } = this, { first, count, outSkipped } = layouts.Query.members, store = memory.place(shapes, "shapes", "Shapes");
        const lists = parts.map((part, k) => {
            const own = memory.take(layouts.Query.size), told = memory.clear(16), error = memory.clear(layouts.Error.size); // told: rows, skipped
            memory.u8.copyWithin(own, query, query + layouts.Query.size);
            memory.u32[(own + first.offset) >> 2] = part.first;
            memory.u32[(own + count.offset) >> 2] = part.count;
            memory.u32[(own + outSkipped.offset) >> 2] = told + 4;
            return [store, bodies, pairs, own, outs[k]!, ...(rooms ? [rooms[k]!, told] : []), error, told];
        });
        const status = this.threads!.run(name, lists.map((list) => list.slice(0, -1)));
        memory.refresh();
        if (status.some((one) => one !== 0))
            return undefined;
        const told = lists.map((list) => list.at(-1)! >> 2);
        this.#skipped = told.reduce((sum, at) => sum + memory.u32[at + 1]!, 0);
        return told.map((at) => memory.u32[at]!);
    }
    #query(options: QueryOptions | undefined, count: number): number {
        const { memory } = this, query = memory.clear(layouts.Query.size);
        if (options !== undefined)
            memory.write(query, layouts.Query, options, count);
        memory.u32[(query + layouts.Query.members.outSkipped.offset) >> 2] = memory.out + 4;
        memory.u32[(memory.out >> 2) + 1] = 0;
        return query;
    }

    // ---------------------------------------------------------------------------- pairs

    /** The boxes of bodies, each reaching `margin` beyond them. */
    boxes(shapes: Shapes, bodies: Bodies, options?: BoxOptions, out = new Rows<BoxRow>(this.memory, layouts.Box, countOf(bodies))): Rows<BoxRow> {
        const { memory } = this, count = countOf(bodies);
        memory.room(out, "out", rowsOf(layouts.Box), count);
        memory.begin();
        memory.call("narc_compute_boxes", memory.place(shapes, "shapes", "Shapes"), memory.bodies(bodies), memory.options(layouts.BoxOptions, options, count), out.pointer);
        out.count = count;
        return out;
    }

    /** All pairs of bodies whose boxes, `margin` wider in all, overlap: numbers a, b of one after the other. */
    pairs(shapes: Shapes, bodies: Bodies, options: PairFilterOptions & { margin?: number; origin?: { x: number; y: number } } = {}, out = this.indices(0)): Numbers<Uint32Array> {
        const { memory } = this, count = countOf(bodies), boxes = this.#boxes, { margin = 0, origin, ...filter } = options;
        this.boxes(shapes, bodies, origin === undefined ? { margin: margin / 2 } : { margin: margin / 2, origin }, boxes);
        memory.room(out, "out", "Uint32Array", 8 * count);
        for (;;) {
            memory.begin();
            const { pointer } = out, room = out.capacity >> 1;
            const status = memory.function("narc_find_pairs")(this.#broad, boxes.pointer, count, memory.options(layouts.PairFilter, filter, count), 0,
                pointer, pointer + 4, 8, room, memory.out, memory.error);
            const fits = memory.fits(status), found = memory.u32[memory.out >> 2]!;
            if (fits) {
                out.count = 2 * found;
                return out;
            }
            out.reserve(2 * found);
        }
    }

    /** Contacts of all pairs that are closer than `margin`, 0 by default: rows in the order of the pairs. */
    contacts(shapes: Shapes, bodies: Bodies, pairs: PairList, options?: QueryOptions, out = this.contactRows(this.#pairCount(pairs))): Rows<Contact> {
        return this.#rows("narc_find_contacts", rowsOf(layouts.Contact), out, shapes, bodies, pairs, options);
    }
    /** The same with one or two points a pair: what a solver wants. */
    manifolds(shapes: Shapes, bodies: Bodies, pairs: PairList, options?: QueryOptions, out = this.manifoldRows(this.#pairCount(pairs))): Rows<Manifold> {
        return this.#rows("narc_find_manifolds", rowsOf(layouts.Manifold), out, shapes, bodies, pairs, options);
    }
    /** Which pairs collide: bit k % 32 of word k >> 5 is that of pair k. */
    overlaps(shapes: Shapes, bodies: Bodies, pairs: PairList, options?: QueryOptions, out?: Numbers<Uint32Array>): Numbers<Uint32Array> {
        const { memory } = this, count = this.#pairCount(pairs), words = 2 * Math.ceil(count / 64), bits = out ?? this.indices(words);
        memory.room(bits, "out", "Uint32Array", words).count = words;
        memory.begin();
        const given = memory.bodies(bodies), asked = this.#pairs(pairs);
        const query = this.#query(options, count), parts = this.#divide(shapes, count, options);
        if (parts && this.#spread("narc_find_overlaps", shapes, given, asked, query, parts, parts.map(() => bits.pointer)))
            return bits;
        memory.call("narc_find_overlaps", memory.place(shapes, "shapes", "Shapes"), given, asked, query, bits.pointer);
        this.#skipped = memory.u32[(memory.out >> 2) + 1]!;
        return bits;
    }
    /** How far apart each pair is, below 0 the depth; Infinity where it is the margin or more, which is Infinity by default. */
    separations(shapes: Shapes, bodies: Bodies, pairs: PairList, options?: QueryOptions, out?: Numbers<Float32Array>): Numbers<Float32Array> {
        const { memory } = this, count = this.#pairCount(pairs), floats = out ?? this.floats(count);
        memory.room(floats, "out", "Float32Array", count).count = count;
        memory.begin();
        const given = memory.bodies(bodies), asked = this.#pairs(pairs), query = this.#query(options, count);
        if (options?.margin === undefined)
            memory.f32[(query + layouts.Query.members.margin.offset) >> 2] = Infinity;
        const parts = this.#divide(shapes, count, options);
        if (parts && this.#spread("narc_find_separations", shapes, given, asked, query, parts, parts.map(() => floats.pointer)))
            return floats;
        memory.call("narc_find_separations", memory.place(shapes, "shapes", "Shapes"), given, asked, query, floats.pointer);
        this.#skipped = memory.u32[(memory.out >> 2) + 1]!;
        return floats;
    }

    #two(name: string, shapes: Shapes, bodies: Rows<Body>, a: number, b: number, margin: number, row: number): void {
        const { memory } = this, size = layouts.Body.size, pointer = memory.place(bodies, "bodies", BODIES), { count } = bodies;
        if (!(a >= 0 && a < count && b >= 0 && b < count) || a % 1 !== 0 || b % 1 !== 0)
            throw new RangeError(`bodies ${a} and ${b}: there are ${count}`);
        if (margin !== this.#lastMargin) {
            memory.f32[(this.#one + layouts.Query.members.margin.offset) >> 2] = number(margin, "margin");
            this.#lastMargin = margin;
        }
        memory.check(memory.function(name)(memory.place(shapes, "shapes", "Shapes"), pointer + a * size, pointer + b * size, this.#one, row, memory.error));
    }
    /** The contact of two bodies, by their numbers: `count` 0 where they are not closer than the margin. It is always the same
     * object. */
    contact(shapes: Shapes, bodies: Rows<Body>, a: number, b: number, margin = 0): Contact {
        this.#two("narc_find_contact", shapes, bodies, a, b, margin, this.#contact.pointer);
        return this.#contact.at(0);
    }
    manifold(shapes: Shapes, bodies: Rows<Body>, a: number, b: number, margin = 0): Manifold {
        this.#two("narc_find_manifold", shapes, bodies, a, b, margin, this.#manifold.pointer);
        return this.#manifold.at(0);
    }

    /** Contacts again in double precision. */
    refine(shapes: Shapes, bodies: Bodies, pairs: PairList, rows: Rows<Contact>, out = new Rows<RefinedContact>(this.memory, layouts.RefinedContact, rows.count)): Rows<RefinedContact> {
        const { memory } = this;
        memory.room(out, "out", rowsOf(layouts.RefinedContact), rows.count);
        memory.begin();
        const given = memory.bodies(bodies);
        memory.call("narc_refine_contacts", memory.place(shapes, "shapes", "Shapes"), given, this.#pairs(pairs), 0, memory.place(rows, "rows", rowsOf(layouts.Contact)), rows.count, out.pointer);
        out.count = rows.count;
        return out;
    }

    /** Throws what is wrong with the first body that is broken. */
    validate(shapes: Shapes, bodies: Bodies): void {
        this.memory.begin();
        this.memory.call("narc_validate_bodies", this.memory.place(shapes, "shapes", "Shapes"), this.memory.bodies(bodies));
    }
    /** Cosines and sines, the same bits on every machine. */
    poses(angles: Float32Array): { cosine: Float32Array; sine: Float32Array } {
        const { memory } = this, count = angles.length;
        if (!(angles instanceof Float32Array))
            throw new TypeError("angles: Float32Array is wanted");
        memory.begin();
        const given = memory.copy(angles), cosine = memory.take(4 * count), sine = memory.take(4 * count);
        memory.call("narc_compute_poses", given, count, cosine, sine);
        return { cosine: memory.f32.slice(cosine >> 2, (cosine >> 2) + count), sine: memory.f32.slice(sine >> 2, (sine >> 2) + count) };
    }
    /** Compounds: where the parts of bodies are; `owner` has for each part the number of its body. Not in the small build. */
    placeParts(owners: Bodies, parts: Bodies, owner: IndexColumn, out = new Rows<Body>(this.memory, layouts.Body, countOf(parts))): Rows<Body> {
        const { memory } = this, count = countOf(parts);
        memory.room(out, "out", rowsOf(layouts.Body), count);
        memory.begin();
        const a = memory.bodies(owners), b = memory.bodies(parts), column = memory.column(owner, "owner", count);
        memory.call("narc_place_parts", a, b, column, 0, out.pointer);
        out.count = count;
        return out;
    }
    /** Bodies of ground, at the entries of a chain. */
    groundBodies(entries: Rows<ChainEntry>): Rows<Body> {
        const bodies = this.bodies(entries.count);
        for (let k = 0; k < entries.count; k++) {
            const entry = entries.at(k), body = bodies.at(k);
            body.x = entry.x;
            body.y = entry.y;
            body.shape = entry.shape;
        }
        return bodies;
    }

    /** When two moving bodies meet: for each pair the first time in 0 .. 1 of its motions. */
    castPairs(shapes: Shapes, bodies: Bodies, motions: MotionsOptions, pairs: PairList, options?: CastOptions, out = this.impactRows(this.#pairCount(pairs))): Rows<Impact> {
        const { memory } = this, count = this.#pairCount(pairs);
        memory.room(out, "out", rowsOf(layouts.Impact), count);
        memory.begin();
        const given = memory.bodies(bodies), moved = memory.options(layouts.Motions, motions, countOf(bodies)), asked = this.#pairs(pairs);
        memory.call("narc_cast_pairs", memory.place(shapes, "shapes", "Shapes"), given, moved, asked, 0, memory.options(layouts.CastOptions, options, count), out.pointer, out.capacity);
        out.count = count;
        return out;
    }
    /** Ray k at body k, or at body[k]. */
    rayPairs(shapes: Shapes, bodies: Bodies, rays: RaysOptions, body?: IndexColumn, options?: Pick<RayOptions, "inside">, out = this.rayHitRows(countOf(rays))): Rows<RayHit> {
        const { memory } = this, count = countOf(rays);
        memory.room(out, "out", rowsOf(layouts.RayHit), count);
        memory.begin();
        const given = memory.bodies(bodies), asked = memory.columns(layouts.Rays, rays), column = memory.column(body, "body", count);
        memory.call("narc_cast_ray_pairs", memory.place(shapes, "shapes", "Shapes"), given, asked, column, memory.options(layouts.RayOptions, options, count), out.pointer, out.capacity);
        out.count = count;
        return out;
    }
    /** How far each point is from one body: point k from body k, or from body[k]. */
    distances(shapes: Shapes, bodies: Bodies, points: PointsOptions, body?: IndexColumn, out = this.distanceRows(countOf(points))): Rows<Distance> {
        const { memory } = this, count = countOf(points);
        memory.room(out, "out", rowsOf(layouts.Distance), count);
        memory.begin();
        const given = memory.bodies(bodies), asked = memory.columns(layouts.Points, points), column = memory.column(body, "body", count);
        memory.call("narc_find_distances", memory.place(shapes, "shapes", "Shapes"), given, asked, column, 0, out.pointer);
        out.count = count;
        return out;
    }
    /** Is each point within one body? Bits as those of overlaps(). */
    inside(shapes: Shapes, bodies: Bodies, points: PointsOptions, body?: IndexColumn, out?: Numbers<Uint32Array>): Numbers<Uint32Array> {
        const { memory } = this, count = countOf(points), words = 2 * Math.ceil(count / 64), bits = out ?? this.indices(words);
        memory.room(bits, "out", "Uint32Array", words).count = words;
        memory.begin();
        const given = memory.bodies(bodies), asked = memory.columns(layouts.Points, points), column = memory.column(body, "body", count);
        memory.call("narc_find_inside", memory.place(shapes, "shapes", "Shapes"), given, asked, column, 0, bits.pointer);
        return bits;
    }
}
