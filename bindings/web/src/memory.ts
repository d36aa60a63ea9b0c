// SPDX-License-Identifier: MIT
// The module's memory from JavaScript: views, rows, arrays, options as structures, errors, what is to be freed.
import { type Body, constants, enumerations, type Layout, layouts, type Member } from "./layouts.js";

// ------------------------------------------------------------------------------------------------ errors

/** What the core refuses: `code` is the status of the headers, such as "NARC_ERROR_INDEX"; `index` and `value` tell which
 * item and number it is about. */
export class NarcError extends Error {
    override readonly name = "NarcError";
    constructor(readonly code: string, message: string, readonly index: number, readonly value: number) {
        super(message);
    }
}

export function number(value: number, name: string): number {
    if (typeof value !== "number")
        throw new TypeError(`${name}: a number is wanted, not ${describe(value)}`);
    return value;
}

/** A whole number from 0 on that a 32-bit integer holds. */
export function whole(value: number, name: string, end = 2 ** 32): number {
    if (typeof value !== "number" || !Number.isInteger(value))
        throw new TypeError(`${name}: a whole number is wanted, not ${describe(value)}`);
    if (value < 0 || value >= end)
        throw new RangeError(`${name}: ${value} is not in 0 .. ${end - 1}`);
    return value;
}

function describe(value: unknown): string {
    return typeof value === "number" || typeof value === "boolean" ? String(value)
        : typeof value === "object" && value !== null ? value.constructor?.name ?? "an object" : typeof value;
}

// ------------------------------------------------------------------------------------------------ memory

type Function = (...args: number[]) => number;
/** Typed arrays that columns are made of. */
export type Items = Float32Array | Float64Array | Uint8Array | Uint16Array | Uint32Array | BigUint64Array;

const CHUNK = 1 << 16, ERROR = layouts.Error;

/** One module and its memory. All views of it are made in remake(), and again when the memory has grown. */
export class Memory {
    readonly #functions: Record<string, Function | undefined>;
    readonly #memory: WebAssembly.Memory;
    readonly #shared: boolean;
    u8!: Uint8Array;
    u16!: Uint16Array;
    u32!: Uint32Array;
    f32!: Float32Array;
    f64!: Float64Array;
    u64!: BigUint64Array;
    view!: DataView;
    readonly #error: number;
    /** A place of 8 bytes, for what a call gives back. */
    readonly out: number;
    /** How many bodies an index has that is asked: as many owners. */
    things = 0;
    #chunk = 0;
    #chunkSize = 0;
    #used = 0;
    #full: number[] = [];

    /** `shared`: the memory of a module that does not have its own. */
    constructor(instance: WebAssembly.Instance, readonly build: "fast" | "small", shared?: WebAssembly.Memory) {
        this.#functions = instance.exports as unknown as Record<string, Function>;
        this.#memory = shared ?? instance.exports["memory"] as WebAssembly.Memory;
        this.#shared = shared !== undefined;
        this.remake();
        this.function("_initialize")();
        this.#error = this.allocate(ERROR.size);
        this.out = this.allocate(16);
    }

    /** An exported function by its name in C. */
    function(name: string): Function {
        const found = this.#functions[name];
        if (!found)
            throw new Error(`${name}() is not in the small build: load({ build: "fast" }) has it`);
        return found;
    }

    /** Calls what returns a status and takes an error last. */
    call(name: string, ...args: number[]): void {
        const status = this.function(name)(...args, this.#error);
        this.check(status);
    }

    /** The same, and whether there was room enough: false is NARC_ERROR_CAPACITY. */
    fits(status: number): boolean {
        if (status !== constants.ERROR_CAPACITY)
            this.check(status);
        else
            this.refresh();
        return status === 0;
    }

    get error(): number {
        return this.#error;
    }

    check(status: number): void {
        this.refresh();
        if (status === 0)
            return;
        const at = (name: keyof typeof ERROR.members): number => this.#error + ERROR.members[name].offset;
        const told = this.view.getInt32(at("status"), true) === status;
        throw new NarcError(this.text(this.function("narc_status_name")(status)),
            told ? this.text(at("message")) : this.text(this.function("narc_status_name")(status)),
            told ? this.view.getUint32(at("index"), true) : 0, told ? this.view.getFloat64(at("value"), true) : 0);
    }

    /** After whatever may have made the memory grow. */
    refresh(): void {
        if (this.#shared ? this.#memory.buffer !== this.u8.buffer : this.u8.length === 0) // shared views do not detach
            this.remake();
    }

    remake(): void {
        const { buffer } = this.#memory;
        this.u8 = new Uint8Array(buffer);
        this.u16 = new Uint16Array(buffer);
        this.u32 = new Uint32Array(buffer);
        this.f32 = new Float32Array(buffer);
        this.f64 = new Float64Array(buffer);
        this.u64 = new BigUint64Array(buffer);
        this.view = new DataView(buffer);
    }

    allocate(size: number): number {
        const pointer = size > 0 && size < 2 ** 31 ? this.function("malloc")(size) >>> 0 : 0;
        this.refresh();
        if (pointer === 0)
            throw new NarcError("NARC_ERROR_MEMORY", `no memory for ${size} bytes`, 0, size);
        this.u8.fill(0, pointer, pointer + size);
        return pointer;
    }

    release(pointer: number): void {
        this.function("free")(pointer);
    }

    text(pointer: number): string {
        const end = this.u8.indexOf(0, pointer);
        return new TextDecoder().decode(this.u8.slice(pointer, end));
    }

    // ---------------------------------------------------------------------------- what a call is given

    /** Begins the arguments of another call: what the last one was given is gone. */
    begin(): void {
        if (this.#full.length > 0) { // one chunk for all of it, so that the next call finds room
            for (const chunk of this.#full)
                this.release(chunk);
            this.#full = [];
            const size = 2 * this.#chunkSize;
            this.release(this.#chunk);
            this.#chunk = 0;
            this.#chunk = this.allocate(size);
            this.#chunkSize = size;
        }
        this.#used = 0;
    }

    /** Bytes for this call, not cleared, aligned to 16. */
    take(size: number): number {
        const place = (this.#used + 15) & ~15;
        if (place + size > this.#chunkSize || this.#chunk === 0) {
            if (this.#chunk !== 0)
                this.#full.push(this.#chunk);
            const chunk = Math.max(CHUNK, 2 * this.#chunkSize, size);
            this.#chunk = this.allocate(chunk);
            this.#chunkSize = chunk;
            this.#used = size;
            return this.#chunk;
        }
        this.#used = place + size;
        return this.#chunk + place;
    }

    /** The same cleared. */
    clear(size: number): number {
        const pointer = this.take(size);
        this.u8.fill(0, pointer, pointer + size);
        return pointer;
    }

    /** A copy of JavaScript's array. */
    copy(items: Items): number {
        const pointer = this.take(items.byteLength), size = items.BYTES_PER_ELEMENT;
        if (items instanceof BigUint64Array)
            this.u64.set(items, pointer / size);
        else
            (size === 1 ? this.u8 : size === 2 ? this.u16 : size === 8 ? this.f64 : items instanceof Float32Array ? this.f32 : this.u32)
                .set(items, pointer / size);
        return pointer;
    }

    /** A structure of options; 0 without any. `count` is how many items columns have. */
    options(layout: Layout, values: object | undefined, count: number): number {
        if (values === undefined)
            return 0;
        const pointer = this.clear(layout.size);
        this.write(pointer, layout, values, count);
        return pointer;
    }

    write(pointer: number, layout: Layout, values: object, count: number): void {
        if (typeof values !== "object" || values === null)
            throw new TypeError(`options: an object is wanted, not ${describe(values)}`);
        for (const name in values) {
            const value = (values as Record<string, unknown>)[name], member = layout.members[name];
            if (!member || /^(workers|allocator|out[A-Z].*|.+Count)$/.test(name))
                throw new TypeError(`${name}: ${layout.name} has no such member`);
            if (value === undefined)
                continue;
            const own = layout.members[`${name}Count`]; // a list of its own length
            let items = layout === layouts.Owners && name === "owner" ? this.things : count;
            if (own) {
                items = value instanceof Column ? value.count : (value as Items).length;
                this.view.setUint32(pointer + own.offset, items, true);
            }
            this.#member(pointer + member.offset, name, member, value, items);
        }
    }

    #member(pointer: number, name: string, member: Member, value: unknown, count: number): void {
        const { type } = member;
        if (type === "float")
            this.view.setFloat32(pointer, number(value as number, name), true);
        else if (type === "double")
            this.view.setFloat64(pointer, number(value as number, name), true);
        else if (type === "uint32_t" || type === "size_t" || enumerations.includes(type))
            this.view.setUint32(pointer, whole(typeof value === "boolean" ? Number(value) : value as number, name), true);
        else if (type === "ptrdiff_t")
            this.view.setInt32(pointer, number(value as number, name), true);
        else if (type.endsWith("_column"))
            this.#column(pointer, name, type, value, count);
        else if (type === "const narc_bodies *")
            this.view.setUint32(pointer, this.bodies(value as Bodies), true);
        else if (type === "const narc_pairs *")
            this.view.setUint32(pointer, this.columns(layouts.Pairs, value as object), true);
        else if (type.endsWith(" *"))
            this.view.setUint32(pointer, this.options(layoutOf(type.slice(6, -2)), value as object, count), true);
        else
            this.write(pointer, layoutOf(type), value as object, count);
    }

    /** A column: one number for all, JavaScript's array, which is copied, or one in this memory, which is not. */
    #column(pointer: number, name: string, type: string, value: unknown, count: number): void {
        const kinds = COLUMNS[type]!;
        let base: number, stride: number, kind: number;
        if (value instanceof Column) {
            kind = kinds.indexOf(value.kind);
            if (kind >= 0 && value.count !== count)
                throw new RangeError(`${name}: ${value.count} items, ${count} are wanted`);
            base = this.place(value.of, name, value.of.kind) + value.offset;
            stride = value.stride;
        } else if (typeof value === "number" || typeof value === "bigint") {
            kind = kinds.length - 1;
            base = this.take(8);
            stride = 0;
            if (type === "narc_word_column")
                this.view.setBigUint64(base, BigInt(value), true);
            else if (type === "narc_float_column")
                this.view.setFloat32(base, number(value as number, name), true);
            else if (type === "narc_position_column")
                this.view.setFloat64(base, number(value as number, name), true);
            else
                this.view.setUint32(base, whole(value as number, name, type === "narc_byte_column" ? 256 : 2 ** 32), true);
        } else {
            const items = value as Items;
            kind = kinds.findIndex((made) => items instanceof made);
            if (kind >= 0 && items.length !== count)
                throw new RangeError(`${name}: ${items.length} items, ${count} are wanted`);
            base = kind < 0 ? 0 : this.copy(items);
            stride = kind < 0 ? 0 : items.BYTES_PER_ELEMENT;
        }
        if (kind < 0)
            throw new TypeError(`${name}: ${kinds.map((made) => made.name).join(" or ")} is wanted, not ${describe(value)}`);
        this.view.setUint32(pointer, base, true);
        this.view.setInt32(pointer + 4, stride, true);
        if (type === "narc_position_column")
            this.view.setUint32(pointer + 8, kind === 1 ? constants.FLOAT64 : constants.FLOAT32, true);
    }

    /** A column by itself; 0 without one. */
    column(value: IndexColumn | undefined, name: string, count: number): number {
        if (value === undefined)
            return 0;
        const pointer = this.clear(layouts.IndexColumn.size);
        this.#column(pointer, name, "narc_index_column", value, count);
        return pointer;
    }

    /** Options with a member `search`, whose own members stand among theirs. */
    searching(layout: Layout, values: object | undefined, count: number): number {
        if (values === undefined)
            return 0;
        const search: Record<string, unknown> = {}, others: Record<string, unknown> = {};
        for (const [name, value] of Object.entries(values))
            (name in layouts.IndexQuery.members ? search : others)[name] = value;
        return this.options(layout, { ...others, search }, count);
    }

    /** Where something lies that a call is given: it is of the kind that is wanted, and of this module. */
    place(given: Owned, name: string, kind: string): number {
        if (!(given instanceof Owned) || given.kind !== kind)
            throw new TypeError(`${name}: ${kind} wanted, not ${given instanceof Owned ? given.kind : describe(given)}`);
        if (given.memory !== this)
            throw new TypeError(`${name}: it is of another module; each load() has a memory of its own`);
        return given.pointer;
    }
    /** Empties rows that a call is to fill, and makes room. */
    room<Out extends List>(out: Out, name: string, kind: string, count: number): Out {
        this.place(out, name, kind);
        out.count = 0;
        out.reserve(count);
        return out;
    }

    /** A narc_bodies for this call. */
    bodies(given: Bodies): number {
        const pointer = this.clear(layouts.Bodies.size);
        if (given instanceof Owned) {
            const rows = this.place(given, "bodies", rowsOf(layouts.Body));
            this.function("narc_view_bodies")(rows, given.count, pointer);
            return pointer;
        }
        const count = countOf(given);
        this.view.setUint32(pointer + layouts.Bodies.members.count.offset, count, true);
        const { count: _, ...columns } = given;
        this.write(pointer, layouts.Bodies, columns, count);
        return pointer;
    }

    /** Something with columns x, y and so on, all of one length. */
    columns(layout: Layout, values: { count?: number | undefined }): number {
        const pointer = this.clear(layout.size), count = countOf(values);
        const { count: _, ...columns } = values;
        this.view.setUint32(pointer + layout.members["count"]!.offset, count, true);
        this.write(pointer, layout, columns, count);
        return pointer;
    }
}

const COLUMNS: Readonly<Record<string, readonly { new (length: number): Items; readonly name: string }[]>> = {
    narc_float_column: [Float32Array],
    narc_index_column: [Uint32Array],
    narc_word_column: [BigUint64Array],
    narc_byte_column: [Uint8Array],
    narc_position_column: [Float32Array, Float64Array],
};

const BY_NAME: Readonly<Record<string, Layout>> = layouts;

function layoutOf(type: string): Layout {
    const words = type.replace(/^narc/, "").replace(/_([a-z0-9])/g, (_, letter: string) => letter.toUpperCase());
    return BY_NAME[words]!;
}

/** How many items the columns have: `count` if it is there, or the length of the first one that has one, or 1. */
export function countOf(of: object): number {
    if (of instanceof Rows)
        return of.count;
    if ("count" in of && typeof of.count === "number")
        return whole(of.count, "count");
    for (const name in of) {
        const value: unknown = (of as Record<string, unknown>)[name];
        if (value instanceof Column)
            return value.count;
        if (ArrayBuffer.isView(value))
            return (value as Items).length;
    }
    return 1;
}

// ------------------------------------------------------------------------------------------------ what is freed

interface Held {
    readonly memory: Memory;
    readonly destroy: string;
    pointer: number;
}

function release(held: Held): void {
    if (held.pointer !== 0)
        held.memory.function(held.destroy)(held.pointer);
    held.pointer = 0;
}

const registry = new FinalizationRegistry<Held>(release);

/** Something in the module's memory. It is freed by free(), or some time after nothing refers to it any more. */
export abstract class Owned {
    readonly memory: Memory;
    readonly kind: string;
    readonly #held: Held;

    protected constructor(memory: Memory, kind: string, pointer: number, destroy: string) {
        this.memory = memory;
        this.kind = kind;
        this.#held = { memory, destroy, pointer };
        registry.register(this, this.#held, this);
    }

    /** Where it is; an error if it was freed. */
    get pointer(): number {
        if (this.#held.pointer === 0)
            throw new Error(`${this.constructor.name}: it was freed`);
        return this.#held.pointer;
    }

    protected move(pointer: number): void {
        this.#held.pointer = pointer;
    }

    free(): void {
        registry.unregister(this);
        release(this.#held);
    }
}

// ------------------------------------------------------------------------------------------------ rows

/** Members of a row at a place: get and set read and write the memory. One object serves many rows, see Rows.at(). */
export class Cursor {
    /** In bytes. */
    place = 0;
    constructor(readonly memory: Memory) {}
}

type CursorClass = new (memory: Memory) => Cursor;
const cursors = new Map<Layout, CursorClass>();

/** For each type the property of a member. Each has functions of its own, which the engine then compiles into their callers,
 * so that no number is boxed. */
const PROPERTIES: Record<string, (offset: number) => PropertyDescriptor & ThisType<Cursor>> = {
    float: (offset) => ({
        get() { return this.memory.view.getFloat32(this.place + offset, true); },
        set(value: number) { this.memory.view.setFloat32(this.place + offset, value, true); } }),
    double: (offset) => ({
        get() { return this.memory.view.getFloat64(this.place + offset, true); },
        set(value: number) { this.memory.view.setFloat64(this.place + offset, value, true); } }),
    uint8_t: (offset) => ({
        get() { return this.memory.view.getUint8(this.place + offset); },
        set(value: number) { this.memory.view.setUint8(this.place + offset, value); } }),
    uint16_t: (offset) => ({
        get() { return this.memory.view.getUint16(this.place + offset, true); },
        set(value: number) { this.memory.view.setUint16(this.place + offset, value, true); } }),
    uint64_t: (offset) => ({
        get() { return this.memory.view.getBigUint64(this.place + offset, true); },
        set(value: bigint) { this.memory.view.setBigUint64(this.place + offset, value, true); } }),
};
const UINT32 = (offset: number): PropertyDescriptor & ThisType<Cursor> => ({
    get() { return this.memory.view.getUint32(this.place + offset, true); },
    set(value: number) { this.memory.view.setUint32(this.place + offset, value, true); } });

/** A class with a property for each member of the layout; an array is a method that takes a number. */
export function cursorOf(layout: Layout): CursorClass {
    const known = cursors.get(layout);
    if (known)
        return known;
    class Row extends Cursor {}
    for (const [name, { type, offset, size, count }] of Object.entries(layout.members)) {
        const inner = BY_NAME[type.startsWith("narc_") && !type.endsWith("*") ? layoutOf(type)?.name ?? "" : ""];
        const item = size / count, end = count;
        if (inner) {
            const Inner = cursorOf(inner), key = Symbol(name);
            const at = function (this: Cursor & { [key]?: Cursor }, index: number): Cursor {
                const cursor = this[key] ??= new Inner(this.memory);
                cursor.place = this.place + offset + index * item;
                return cursor;
            };
            if (count > 1)
                Object.defineProperty(Row.prototype, name, { value(this: Cursor, index: number) { return at.call(this, whole(index, name, end)); } });
            else
                Object.defineProperty(Row.prototype, name, { get(this: Cursor) { return at.call(this, 0); } });
            continue;
        }
        const property = PROPERTIES[type] ?? UINT32;
        if (count === 1) {
            Object.defineProperty(Row.prototype, name, { ...property(offset), enumerable: true });
            continue;
        }
        const items = Array.from({ length: count }, (_, index) => property(offset + item * index).get!);
        Object.defineProperty(Row.prototype, name, { value(this: Cursor, index: number): unknown { return items[whole(index, name, end)]!.call(this); } });
    }
    cursors.set(layout, Row);
    return Row;
}

/** A member of all rows, or an array, for calls that take columns. */
export class Column {
    constructor(readonly of: Rows<unknown> | Numbers<Items>, readonly kind: { new (length: number): Items }, readonly offset: number,
        readonly stride: number) {}
    get pointer(): number {
        return this.of.pointer + this.offset;
    }
    get count(): number {
        return this.of.count;
    }
}

const KIND: Record<string, new (length: number) => Items> = { float: Float32Array, double: Float64Array, uint8_t: Uint8Array,
    uint16_t: Uint16Array, uint32_t: Uint32Array, uint64_t: BigUint64Array, size_t: Uint32Array };

/** Memory of `capacity` items, of which the first `count` are there. */
abstract class List extends Owned {
    #count = 0;
    #capacity: number;

    constructor(memory: Memory, kind: string, readonly itemSize: number, capacity: number) {
        super(memory, kind, memory.allocate(Math.max(whole(capacity, "capacity"), 1) * itemSize), "free");
        this.#capacity = capacity;
    }
    get capacity(): number {
        return this.#capacity;
    }
    get count(): number {
        return this.#count;
    }
    set count(count: number) {
        this.#count = whole(count, "count", this.#capacity + 1);
    }

    /** Room for so many items at least; those that are there stay. */
    reserve(capacity: number): this {
        if (whole(capacity, "capacity") > this.#capacity) {
            const old = this.pointer, grown = Math.max(capacity, Math.ceil(1.5 * this.#capacity));
            const pointer = this.memory.allocate(grown * this.itemSize);
            this.memory.u8.copyWithin(pointer, old, old + this.#count * this.itemSize);
            this.move(pointer);
            this.memory.release(old);
            this.#capacity = grown;
        }
        return this;
    }
}

/** The kind of rows, as errors call it. */
export function rowsOf(layout: Layout): string {
    return `rows of ${layout.name}`;
}

/** Rows of a structure in the module's memory, `count` of them in room for `capacity`. Read them by at(), or as typed arrays,
 * u8 to f64, which reach over the whole capacity and are to be asked for again after a call, as memory may grow or move:
 * member m of row k is rows.f32[k * rows.size / 4 + rows.layout.members.m.offset / 4]. */
export class Rows<Row> extends List {
    readonly #row: Cursor;
    #arrays: { u8?: Uint8Array; u32?: Uint32Array; f32?: Float32Array; f64?: Float64Array } = {};
    #arraysAt = 0;
    #arraysReach = 0;

    constructor(memory: Memory, readonly layout: Layout, capacity: number, count = 0) {
        super(memory, rowsOf(layout), layout.size, capacity);
        this.#row = new (cursorOf(layout))(memory);
        this.count = count;
    }

    /** Bytes of a row. */
    get size(): number {
        return this.layout.size;
    }

    /** Row k: always the same object, which the next call of at() moves on. */
    at(k: number): Row {
        if (!(k >= 0 && k < this.count && (k | 0) === k))
            throw new RangeError(`row ${k}: there are ${this.count}`);
        this.#row.place = this.pointer + k * this.layout.size;
        return this.#row as unknown as Row;
    }

    /** The rows one after the other, all by the same object. */
    *[Symbol.iterator](): Generator<Row, void, undefined> {
        for (let k = 0; k < this.count; k++)
            yield this.at(k);
    }

    #array<Kind extends Items>(name: "u8" | "u32" | "f32" | "f64", Made: new (b: ArrayBufferLike, at: number, n: number) => Kind, size: number): Kind {
        const { pointer } = this;
        if (this.#arraysAt !== pointer || this.#arraysReach !== this.capacity) { // it may be an earlier place, with more room
            this.#arrays = {};
            this.#arraysReach = this.capacity;
            this.#arraysAt = pointer;
        }
        let array = this.#arrays[name];
        if (array === undefined || array.length === 0)
            array = this.#arrays[name] = new Made(this.memory.u8.buffer, pointer, Math.max(this.capacity, 1) * this.layout.size / size) as never;
        return array as unknown as Kind;
    }
    get u8(): Uint8Array {
        return this.#array("u8", Uint8Array, 1);
    }
    get u32(): Uint32Array {
        return this.#array("u32", Uint32Array, 4);
    }
    get f32(): Float32Array {
        return this.#array("f32", Float32Array, 4);
    }
    /** Of structures that have doubles. */
    get f64(): Float64Array {
        return this.#array("f64", Float64Array, 8);
    }

    /** A member of all rows, as a column for calls. */
    column(name: keyof Row & string): Column {
        const member = this.layout.members[name], kind = member && KIND[member.type];
        if (!kind)
            throw new TypeError(`${name}: ${this.layout.name} has no such column`);
        return new Column(this as Rows<unknown>, kind, member.offset, this.layout.size);
    }
}

/** An array in the module's memory, which calls read without a copy. */
export class Numbers<Kind extends Items> extends List {
    readonly #made: { new (buffer: ArrayBufferLike, at: number, length: number): Kind; readonly BYTES_PER_ELEMENT: number };
    #array: Kind | undefined;
    #arrayAt = 0;

    constructor(memory: Memory, made: { new (buffer: ArrayBufferLike, at: number, length: number): Kind; readonly BYTES_PER_ELEMENT: number }, capacity: number) {
        super(memory, made.name, made.BYTES_PER_ELEMENT, capacity);
        this.#made = made;
        this.count = capacity;
    }

    /** All that there is room for; ask again after a call. */
    get array(): Kind {
        const { pointer } = this;
        if (this.#array === undefined || this.#array.length !== Math.max(this.capacity, 1) || this.#arrayAt !== pointer) {
            this.#array = new this.#made(this.memory.u8.buffer, pointer, Math.max(this.capacity, 1));
            this.#arrayAt = pointer;
        }
        return this.#array;
    }

    get column(): Column {
        return new Column(this as unknown as Numbers<Items>, this.#made as unknown as new (length: number) => Items, 0, this.itemSize);
    }
}

export type FloatColumn = Float32Array | Column | number;
export type IndexColumn = Uint32Array | Column | number;
export type WordColumn = BigUint64Array | Column | bigint;
export type ByteColumn = Uint8Array | Column | number;
export type PositionColumn = Float32Array | Float64Array | Column | number;

/** Bodies: rows of Body, which no call copies, or columns of one length. */
export type Bodies = Rows<Body> | {
    count?: number | undefined;
    x: PositionColumn;
    y: PositionColumn;
    cosine: FloatColumn;
    sine: FloatColumn;
    scale?: FloatColumn | undefined;
    shape: IndexColumn;
};
