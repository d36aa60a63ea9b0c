// SPDX-License-Identifier: MIT
// Outlines of arcs: how they are built and measured; the store of shapes; shapes files.
import { type Body, type ChainEntry, type ChainOptions, type Circle, constants, type FourArc, layouts, type Mass } from "./layouts.js";
import { type Memory, number, Owned, Rows, rowsOf, whole } from "./memory.js";

/** Arcs as five numbers each: center x, center y, radius, and the angles of the outward normals at start and end. */
export type Arcs = Float64Array;
/** Points, as x and y of one after the other, or as [x, y] each. */
export type Points = Float64Array | readonly (readonly [number, number])[];

export interface Extent { minX: number; minY: number; maxX: number; maxY: number }

const ARC = 5, MOST = constants.MAX_ARCS;

function flat(points: Points, name: string): Float64Array {
    if (points instanceof Float64Array) {
        if (points.length % 2 !== 0)
            throw new RangeError(`${name}: ${points.length} numbers are no points`);
        return points;
    }
    if (!Array.isArray(points))
        throw new TypeError(`${name}: Float64Array or [x, y] of each point is wanted`);
    const all = new Float64Array(2 * points.length);
    points.forEach((point: readonly number[], k) => {
        if (!Array.isArray(point) || point.length !== 2)
            throw new TypeError(`${name}: point ${k} is no [x, y]`);
        all[2 * k] = number(point[0]!, name);
        all[2 * k + 1] = number(point[1]!, name);
    });
    return all;
}

/** Builders of outlines and what is computed of them, as in narc_shapes.h. */
export class Outlines {
    readonly #memory: Memory;
    readonly #arcs: number;

    constructor(memory: Memory) {
        this.#memory = memory;
        this.#arcs = memory.allocate(MOST * layouts.Arc.size);
    }

    #numbers(pointer: number, count: number): Float64Array {
        return this.#memory.f64.slice(pointer / 8, pointer / 8 + count);
    }
    #build(name: string, ...args: number[]): Arcs {
        const { out } = this.#memory;
        this.#memory.call(name, ...args, this.#arcs, out);
        return this.#numbers(this.#arcs, ARC * this.#memory.u32[out >> 2]!);
    }
    /** Where arcs lie for a call, and how many. */
    given(arcs: Arcs): [pointer: number, count: number] {
        if (!(arcs instanceof Float64Array))
            throw new TypeError("arcs: Float64Array is wanted");
        if (arcs.length % ARC !== 0)
            throw new RangeError(`arcs: ${arcs.length} numbers, five for each arc are wanted`);
        this.#memory.begin();
        return [this.#memory.copy(arcs), arcs.length / ARC];
    }
    #points(points: Points): [pointer: number, count: number] {
        const all = flat(points, "points");
        this.#memory.begin();
        return [this.#memory.copy(all), all.length / 2];
    }
    #measure(name: string, arcs: Arcs, count: number, ...args: number[]): Float64Array {
        const given = this.given(arcs), out = this.#memory.clear(8 * count);
        if (!this.#memory.function(name)(...given, ...args, out))
            this.#memory.call("narc_validate_arcs", ...given);
        return this.#numbers(out, count);
    }

    circle(radius: number): Arcs {
        return this.#build("narc_build_circle", number(radius, "radius"));
    }
    capsule(length: number, radius: number): Arcs {
        return this.#build("narc_build_capsule", number(length, "length"), number(radius, "radius"));
    }
    segment(from: readonly [number, number], to: readonly [number, number], radius = 0): Arcs {
        const [ends] = this.#points([from, to]);
        return this.#build("narc_build_segment", ends, ends + layouts.Point.size, number(radius, "radius"));
    }
    box(width: number, height: number, radius = 0): Arcs {
        return this.#build("narc_build_box", number(width, "width"), number(height, "height"), number(radius, "radius"));
    }
    polygon(points: Points, radius = 0): Arcs {
        return this.#build("narc_build_polygon", ...this.#points(points), number(radius, "radius"));
    }
    skinPolygon(points: Points, radius: number): Arcs {
        return this.#build("narc_build_skin_polygon", ...this.#points(points), number(radius, "radius"));
    }
    regularPolygon(corners: number, circumradius: number, radius = 0): Arcs {
        return this.#build("narc_build_regular_polygon", whole(corners, "corners"), number(circumradius, "circumradius"), number(radius, "radius"));
    }
    hull(points: Points, tolerance = 0, radius = 0): Arcs {
        return this.#build("narc_build_hull", ...this.#points(points), number(tolerance, "tolerance"), number(radius, "radius"));
    }
    ellipse(halfX: number, halfY: number, arcCount = 8): Arcs {
        const { out } = this.#memory;
        this.#memory.call("narc_build_ellipse", number(halfX, "halfX"), number(halfY, "halfY"), whole(arcCount, "arcCount"), this.#arcs, out, 0);
        return this.#numbers(this.#arcs, ARC * this.#memory.u32[out >> 2]!);
    }
    fourArc(form: FourArc): Arcs {
        this.#memory.begin();
        return this.#build("narc_build_four_arc", this.#memory.options(layouts.FourArc, form, 1));
    }
    /** The n-arc with these junctions; `radius` is that of arc 0, 0 chooses it. */
    points(points: Points, radius = 0): Arcs {
        return this.#build("narc_build_points", ...this.#points(points), number(radius, "radius"));
    }
    /** An n-arc near any ring of points, as many arcs as points: Algorithm 1 of the paper. */
    ring(points: Points): Arcs {
        return this.#build("narc_build_ring", ...this.#points(points));
    }
    /** The polygon without corners that hardly matter. */
    weld(points: Points, tolerance: number): Float64Array {
        const given = this.#points(points), { out } = this.#memory;
        this.#memory.call("narc_weld_polygon", ...given, number(tolerance, "tolerance"), given[0], out);
        return this.#numbers(given[0], 2 * this.#memory.u32[out >> 2]!);
    }
    center(arcs: Arcs): Arcs {
        const given = this.given(arcs);
        this.#memory.call("narc_center_arcs", ...given, this.#arcs, 0);
        return this.#numbers(this.#arcs, arcs.length);
    }
    mirror(arcs: Arcs): Arcs {
        const given = this.given(arcs);
        this.#memory.call("narc_mirror_arcs", ...given, this.#arcs);
        return this.#numbers(this.#arcs, arcs.length);
    }
    /** Points p go to (x, y) + scale * p, turned by `angle`. */
    move(arcs: Arcs, x: number, y: number, angle = 0, scale = 1): Arcs {
        const given = this.given(arcs);
        this.#memory.call("narc_move_arcs", ...given, number(x, "x"), number(y, "y"), number(angle, "angle"), number(scale, "scale"), this.#arcs);
        return this.#numbers(this.#arcs, arcs.length);
    }
    /** Throws what is wrong with them. */
    validate(arcs: Arcs): void {
        this.#memory.call("narc_validate_arcs", ...this.given(arcs));
    }
    mass(arcs: Arcs): Mass {
        const [area, centroidX, centroidY, secondMoment] = this.#measure("narc_compute_mass", arcs, 4) as unknown as [number, number, number, number];
        return { area, centroidX, centroidY, secondMoment };
    }
    /** Of all that any of these parts covers. Not in the small build. */
    unionMass(parts: readonly Arcs[]): Mass {
        const all = new Float64Array(parts.reduce((sum, part) => sum + part.length, 0));
        let at = 0;
        for (const part of parts) {
            all.set(part, at);
            at += part.length;
        }
        const [pointer] = this.given(all), counts = this.#memory.copy(Uint32Array.from(parts, (part) => part.length / ARC));
        const out = this.#memory.clear(layouts.Mass.size);
        this.#memory.call("narc_compute_union_mass", pointer, counts, parts.length, 0, out);
        const [area, centroidX, centroidY, secondMoment] = this.#numbers(out, 4) as unknown as [number, number, number, number];
        return { area, centroidX, centroidY, secondMoment };
    }
    boundingCircle(arcs: Arcs): Circle {
        const [x, y, radius] = this.#measure("narc_compute_bounding_circle", arcs, 3) as unknown as [number, number, number];
        return { x, y, radius };
    }
    inscribedCircle(arcs: Arcs): Circle {
        const [x, y, radius] = this.#measure("narc_compute_inscribed_circle", arcs, 3) as unknown as [number, number, number];
        return { x, y, radius };
    }
    perimeter(arcs: Arcs): number {
        return this.#measure("narc_compute_perimeter", arcs, 1)[0]!;
    }
    extent(arcs: Arcs, angle = 0): Extent {
        const [minX, minY, maxX, maxY] = this.#measure("narc_compute_aabb", arcs, 4, number(angle, "angle")) as unknown as [number, number, number, number];
        return { minX, minY, maxX, maxY };
    }
    /** Signed distance of a point to the outline, below 0 inside. */
    distance(arcs: Arcs, x: number, y: number): number {
        const given = this.given(arcs), point = this.#memory.copy(Float64Array.of(number(x, "x"), number(y, "y"))), { out } = this.#memory;
        if (!this.#memory.function("narc_compute_distance")(...given, point, out))
            this.#memory.call("narc_validate_arcs", ...given);
        return this.#memory.f64[out / 8]!;
    }
    contains(arcs: Arcs, x: number, y: number): boolean {
        const given = this.given(arcs), point = this.#memory.copy(Float64Array.of(number(x, "x"), number(y, "y")));
        return this.#memory.function("narc_contains_point")(...given, point) !== 0;
    }
    /** The furthest point in a direction, and the arc that it lies on. */
    support(arcs: Arcs, x: number, y: number): { x: number; y: number; arc: number } {
        const given = this.given(arcs), point = this.#memory.clear(layouts.Point.size), { out } = this.#memory;
        if (!this.#memory.function("narc_find_support")(...given, number(x, "x"), number(y, "y"), point, out))
            this.#memory.call("narc_validate_arcs", ...given);
        return { x: this.#memory.f64[point / 8]!, y: this.#memory.f64[point / 8 + 1]!, arc: this.#memory.u32[out >> 2]! };
    }
    /** The outline as points x, y of a polyline, within `tolerance`. */
    flatten(arcs: Arcs, tolerance: number, closed = true, body?: Body): Float64Array {
        number(tolerance, "tolerance");
        for (let room = 256; ; room = this.#memory.u32[this.#memory.out >> 2]!) {
            const given = this.given(arcs), points = this.#memory.take(room * layouts.Point.size);
            let at = 0;
            if (body) {
                at = this.#memory.clear(layouts.Body.size);
                this.#memory.f64.set([body.x, body.y], at / 8);
                this.#memory.f32.set([body.cosine, body.sine, body.scale], at / 4 + 4);
            }
            const status = this.#memory.function("narc_flatten_arcs")(...given, Number(closed), at, tolerance, points, room, this.#memory.out, this.#memory.error);
            if (this.#memory.fits(status))
                return this.#numbers(points, 2 * this.#memory.u32[this.#memory.out >> 2]!);
        }
    }
}

// ------------------------------------------------------------------------------------------------ the store

/** A store of shapes, each known by its number. Equal shapes are stored once and have one number. */
export class Shapes extends Owned {
    readonly #outlines: Outlines;
    /** @internal Rows of chains stand behind all others of a batch. */
    mayHaveChains = false;

    /** @internal `pointer`: a store that there is. */
    constructor(memory: Memory, outlines: Outlines, pointer?: number) {
        const loaded = pointer !== undefined;
        if (pointer === undefined) {
            memory.check(memory.function("narc_create_shapes")(0, memory.out));
            pointer = memory.u32[memory.out >> 2]!;
        }
        super(memory, "Shapes", pointer, "narc_destroy_shapes");
        this.mayHaveChains = loaded;
        this.#outlines = outlines;
    }

    /** Adds arcs, or has one use more of an equal shape; returns its number. With `shape`: at this number, which is free. */
    add(arcs: Arcs, shape?: number): number {
        const { memory } = this, [at, count] = this.#outlines.given(arcs);
        if (shape !== undefined)
            memory.call("narc_add_shape_at", this.pointer, whole(shape, "shape"), at, count);
        else
            memory.call("narc_add_shape", this.pointer, at, count, memory.out);
        return shape ?? memory.u32[memory.out >> 2]!;
    }
    replace(shape: number, arcs: Arcs): void {
        this.memory.call("narc_replace_shape", this.pointer, whole(shape, "shape"), ...this.#outlines.given(arcs));
    }
    remove(shape: number): void {
        this.memory.call("narc_remove_shape", this.pointer, whole(shape, "shape"));
    }
    circle(radius: number): number {
        return this.add(this.#outlines.circle(radius));
    }
    box(width: number, height: number, radius = 0): number {
        return this.add(this.#outlines.box(width, height, radius));
    }
    capsule(length: number, radius: number): number {
        return this.add(this.#outlines.capsule(length, radius));
    }
    polygon(points: Points, radius = 0): number {
        return this.add(this.#outlines.polygon(points, radius));
    }
    ellipse(halfX: number, halfY: number, arcCount = 8): number {
        return this.add(this.#outlines.ellipse(halfX, halfY, arcCount));
    }
    ring(points: Points): number {
        return this.add(this.#outlines.ring(points));
    }

    /** Ground: a chain of arcs with the solid on the left (narc_chains.h). Each entry is to be a body that stands still, its shape
     * at its x and y. Not in the small build. */
    addChain(arcs: Arcs, options?: ChainOptions, out = new Rows<ChainEntry>(this.memory, layouts.ChainEntry, 16)): Rows<ChainEntry> {
        const { memory } = this;
        memory.place(out, "out", rowsOf(layouts.ChainEntry));
        this.mayHaveChains = true;
        for (;;) {
            const given = this.#outlines.given(arcs), asked = memory.options(layouts.ChainOptions, options, 1);
            const status = memory.function("narc_add_chain")(this.pointer, ...given, asked, out.pointer, out.capacity, memory.out, memory.error);
            const fits = memory.fits(status), found = memory.u32[memory.out >> 2]!;
            if (!fits)
                out.reserve(found);
            else {
                out.count = found;
                return out;
            }
        }
    }

    /** Ground without end: the shape of all points below its body's x axis. Not in the small build. */
    halfPlane(): number {
        const { memory } = this;
        memory.call("narc_add_half_plane", this.pointer, memory.out);
        return memory.u32[memory.out >> 2]!;
    }

    /** Numbers that were given out. */
    get count(): number {
        return this.memory.function("narc_count_shapes")(this.pointer);
    }
    uses(shape: number): number {
        return this.memory.function("narc_count_uses")(this.pointer, whole(shape, "shape")) >>> 0;
    }
    /** Bits of constants.SHAPE_... */
    flags(shape: number): number {
        return this.memory.function("narc_shape_flags")(this.pointer, whole(shape, "shape"));
    }
    /** As the kernels see them; of no length if there is no such shape. */
    arcs(shape: number): Arcs {
        const { memory } = this;
        memory.begin();
        const out = memory.take(MOST * layouts.Arc.size), count = memory.function("narc_get_arcs")(this.pointer, whole(shape, "shape"), out);
        return memory.f64.slice(out / 8, out / 8 + ARC * count);
    }
    /** All of it as bytes, the same on every platform; Narc.loadShapes() reads them. */
    save(): Uint8Array {
        const { memory } = this, size = memory.function("narc_count_saved_bytes")(this.pointer);
        memory.begin();
        const out = memory.take(size);
        memory.call("narc_save_shapes", this.pointer, out, size);
        return memory.u8.slice(out, out + size);
    }
}

// ------------------------------------------------------------------------------------------------ shapes files

export interface NamedShape {
    name: string;
    arcs: Arcs;
    /** Of a fit: where its origin is in the coordinates of its outline. */
    origin: readonly [number, number];
    /** A chain is ground, and in no store by itself. */
    form: "shape" | "open chain" | "closed chain" | "half-plane";
    /** In the store that it was added to. */
    shape?: number;
}

type Json = Record<string, unknown>;

/** Reads a shapes file (docs/formats.md), and adds its shapes to a store, if there is one: all or none. */
export function readShapes(outlines: Outlines, text: string, store?: Shapes): NamedShape[] {
    const fail = (message: string): never => {
        throw new SyntaxError(message);
    };
    const file: unknown = JSON.parse(text);
    const only = (of: unknown, what: string, ...keys: string[]): Json => {
        if (typeof of !== "object" || of === null || Array.isArray(of))
            return fail(`${what}: an object is wanted`);
        for (const key in of)
            if (!keys.includes(key))
                fail(`${what}: ${key} is not known`);
        return of as Json;
    };
    const list = (of: unknown, what: string): unknown[] => Array.isArray(of) ? of : fail(`${what}: a list is wanted`);
    const value = (of: Json, key: string, what: string, otherwise?: number): number => {
        const found = of[key] ?? otherwise;
        return typeof found === "number" ? found : fail(found === undefined ? `${what}: ${key} is missing` : `${what}: ${key} is no number`);
    };
    const pair = (of: unknown, what: string): [number, number] => {
        const [x, y, ...more] = list(of, what);
        return typeof x === "number" && typeof y === "number" && more.length === 0 ? [x, y] : fail(`${what}: [x, y] is wanted`);
    };
    const points = (of: unknown, what: string): [number, number][] => list(of, what).map((p, k) => pair(p, `${what}, point ${k}`));
    const arcsOf = (of: unknown, what: string): Arcs => Float64Array.from(list(of, what).flatMap((item, k) => {
        const at = `${what}, arc ${k}`, arc = only(item, at, "center", "radius", "start", "end");
        return [...pair(arc["center"], `${at}, center`), value(arc, "radius", at), value(arc, "start", at), value(arc, "end", at)];
    }));
    const kinds: Record<string, (item: Json, what: string) => Arcs> = {
        arcs: (item, what) => arcsOf(item["arcs"], what),
        points: (item, what) => outlines.points(points(item["points"], what), value(item, "radius", what, 0)),
        polygon: (item, what) => outlines.polygon(points(item["polygon"], what), value(item, "radius", what, 0)),
        circle: (item, what) => outlines.circle(value(item, "circle", what)),
        capsule: (item, what) => {
            const of = only(item["capsule"], what, "length", "radius");
            return outlines.capsule(value(of, "length", what), value(of, "radius", what));
        },
        box: (item, what) => {
            const of = only(item["box"], what, "width", "height", "radius");
            return outlines.box(value(of, "width", what), value(of, "height", what), value(of, "radius", what, 0));
        },
        four_arc: (item, what) => {
            const of = only(item["four_arc"], what, "radius_low", "radius_high", "distance", "radius_left", "radius_right");
            return outlines.fourArc({ radiusLow: value(of, "radius_low", what), radiusHigh: value(of, "radius_high", what), distance: value(of, "distance", what),
                radiusLeft: value(of, "radius_left", what, 0), radiusRight: value(of, "radius_right", what, 0) });
        },
        half_plane: (item, what) => item["half_plane"] === true ? new Float64Array(0) : fail(`${what}: half_plane is not true`),
        chain: (item, what) => arcsOf(only(item["chain"], what, "closed", "arcs")["arcs"], what),
    };
    const names = new Set<string>();
    const read = list(only(file, "the file", "shapes")["shapes"], "shapes").map((given, k): NamedShape => {
        const item = only(given, `shape ${k}`, "name", "origin", "radius", ...Object.keys(kinds)), { name } = item;
        if (typeof name !== "string" || !/^[^\s,"\p{Cc}]([^,"\p{Cc}]*[^\s,"\p{Cc}])?$/u.test(name) || (/^\d+$/.test(name) && name !== String(k)))
            return fail(`shape ${k}: ${name === undefined ? "name is missing" : `${JSON.stringify(name)} is no name`}`);
        const what = `shape '${name}'`, kind = Object.keys(kinds).filter((key) => key in item);
        if (names.has(name))
            fail(`${what} is there twice`);
        names.add(name);
        if (kind.length !== 1)
            fail(`${what}: one of ${Object.keys(kinds).join(", ")} is wanted`);
        if ("radius" in item && kind[0] !== "points" && kind[0] !== "polygon")
            fail(`${what}: radius is not known`);
        const arcs = kinds[kind[0]!]!(item, what), origin = "origin" in item ? pair(item["origin"], `${what}, origin`) : [0, 0] as const;
        if (kind[0] === "half_plane")
            return { name, arcs, origin, form: "half-plane" };
        if (kind[0] !== "chain") {
            outlines.validate(arcs);
            return { name, arcs, origin, form: "shape" };
        }
        return { name, arcs, origin, form: (item["chain"] as Json)["closed"] === true ? "closed chain" : "open chain" };
    });
    if (read.length === 0)
        fail("shapes: there are none");
    if (store)
        for (const shape of read)
            if (shape.form === "shape")
                shape.shape = store.add(shape.arcs);
            else if (shape.form === "half-plane")
                shape.shape = store.halfPlane();
    return read;
}

/** Shapes as the text of a shapes file, numbers with all their digits. */
export function writeShapes(shapes: readonly Pick<NamedShape, "name" | "arcs" | "origin" | "form">[]): string {
    const listed = shapes.map(({ name, arcs, origin, form }) => {
        const list = [];
        for (let k = 0; k < arcs.length; k += ARC)
            list.push({ center: [arcs[k], arcs[k + 1]], radius: arcs[k + 2], start: arcs[k + 3], end: arcs[k + 4] });
        return { name, ...(origin[0] || origin[1] ? { origin } : {}), ...(form === "half-plane" ? { half_plane: true } : form === "shape" ? { arcs: list } : { chain: { closed: form === "closed chain", arcs: list } }) };
    });
    return `${JSON.stringify({ shapes: listed }, null, 1)}\n`;
}
