// SPDX-License-Identifier: MIT
// What a scene is asked: an index of bodies; and contacts that stay from step to step.
import { type CastOptions, constants, type Contact, type ContactsSettingsOptions, type Distance, type Impact, type IndexOptions, type IndexQueryOptions,
    type IndexStatistics, layouts, type Manifold, type MotionsOptions, type NearestOptions, type PointsOptions, type RayHit, type RayOptions,
    type RaysOptions, type StepOptions as AllStepOptions, type StepResult, type TouchEvent, type Box } from "./layouts.js";
import { type Bodies, countOf, Cursor, cursorOf, type Memory, Owned, Rows, rowsOf, whole } from "./memory.js";
import type { Narc } from "./narc.js";
import type { Shapes } from "./outlines.js";

/** Which bodies count: mask, ignored, world, owners, for each question. */
export type Search = IndexQueryOptions;

/** A tree over the boxes of bodies. It keeps the bodies, not a copy: update() after they have moved. */
export class Index extends Owned {
    readonly #narc: Narc;
    readonly #shapes: Shapes;
    readonly #boxes: Rows<Box>;
    #bodies: Bodies;
    #options: IndexOptions | undefined;

    /** @internal: Narc.index() makes it. */
    constructor(narc: Narc, shapes: Shapes, bodies: Bodies, options?: IndexOptions) {
        const { memory } = narc;
        memory.check(memory.function("narc_create_index")(0, memory.out));
        super(memory, "Index", memory.u32[memory.out >> 2]!, "narc_destroy_index");
        this.#narc = narc;
        this.#shapes = shapes;
        this.#boxes = new Rows(memory, layouts.Box, countOf(bodies));
        this.#bodies = bodies;
        this.#options = options;
        this.#boxOf(bodies);
        memory.begin();
        memory.call("narc_build_index", this.pointer, this.#boxes.pointer, this.#boxes.count, memory.options(layouts.IndexOptions, options, countOf(bodies)));
    }

    #boxOf(bodies: Bodies): void {
        const { origin } = this.#options ?? {};
        this.#narc.boxes(this.#shapes, bodies, origin === undefined ? undefined : { origin }, this.#boxes);
    }
    override free(): void {
        super.free();
        this.#boxes.free();
    }

    /** Takes bodies as they are now, or others; `changed`: the numbers of those that are not as they were. */
    update(bodies: Bodies = this.#bodies, changed?: Uint32Array, options: IndexOptions | undefined = this.#options): this {
        const { memory } = this, count = countOf(bodies);
        this.#options = options;
        this.#boxOf(bodies);
        this.#bodies = bodies;
        memory.begin();
        const list = memory.column(changed, "changed", changed?.length ?? 0);
        memory.call("narc_update_index", this.pointer, this.#boxes.pointer, count, list, changed?.length ?? 0, memory.options(layouts.IndexOptions, options, count));
        return this;
    }

    get statistics(): IndexStatistics {
        const { memory } = this;
        memory.begin();
        const cursor = new (cursorOf(layouts.IndexStatistics))(memory);
        cursor.place = memory.clear(layouts.IndexStatistics.size);
        memory.call("narc_describe_index", this.pointer, cursor.place);
        const out: Record<string, number> = {};
        for (const name in layouts.IndexStatistics.members)
            out[name] = (cursor as unknown as Record<string, number>)[name]!;
        return out as unknown as IndexStatistics;
    }

    /** The boxes of a level of the tree: 0 are the leaves; none from statistics.depth on. */
    nodes(level: number, out: Rows<Box> = new Rows(this.memory, layouts.Box, 1)): Rows<Box> {
        const { memory } = this;
        memory.room(out, "out", rowsOf(layouts.Box), 0);
        for (;;) {
            const fits = memory.fits(memory.function("narc_copy_nodes")(this.pointer, whole(level, "level"), out.pointer, 0, out.capacity, memory.out, memory.error));
            const found = memory.u32[memory.out >> 2]!;
            if (fits) {
                out.count = found;
                return out;
            }
            out.reserve(found);
        }
    }

    /** What each ray hits first, or its first `most`: dense rows, `count` 0 where there is nothing. A ray goes from (x, y) to
     * (x, y) + (motionX, motionY). */
    rays(rays: RaysOptions, options?: Omit<RayOptions, "search"> & Search, out?: Rows<RayHit>): Rows<RayHit> {
        const { memory } = this, count = countOf(rays), wanted = count * Math.max(whole(options?.most ?? 1, "most"), 1);
        const rows = memory.room(out ?? this.#narc.rayHitRows(0), "out", rowsOf(layouts.RayHit), wanted);
        memory.begin();
        memory.things = countOf(this.#bodies);
        const given = memory.bodies(this.#bodies), asked = memory.columns(layouts.Rays, rays);
        memory.call("narc_cast_rays", this.pointer, this.#shapes.pointer, given, asked, memory.searching(layouts.RayOptions, options, count), rows.pointer, rows.capacity);
        rows.count = wanted;
        return rows;
    }
    /** The bodies nearest to each point. */
    nearest(points: PointsOptions, options?: Omit<NearestOptions, "search"> & Search, out?: Rows<Distance>): Rows<Distance> {
        const { memory } = this, count = countOf(points), wanted = count * Math.max(whole(options?.most ?? 1, "most"), 1);
        const rows = memory.room(out ?? this.#narc.distanceRows(0), "out", rowsOf(layouts.Distance), wanted);
        memory.begin();
        memory.things = countOf(this.#bodies);
        const given = memory.bodies(this.#bodies), asked = memory.columns(layouts.Points, points);
        memory.call("narc_find_nearest", this.pointer, this.#shapes.pointer, given, asked, memory.searching(layouts.NearestOptions, options, count), rows.pointer, rows.capacity);
        rows.count = wanted;
        return rows;
    }
    /** What each mover hits first on its way. */
    casts(movers: Bodies, motions: MotionsOptions, options?: CastOptions, search?: Search, out?: Rows<Impact>): Rows<Impact> {
        const { memory } = this, count = countOf(movers), rows = memory.room(out ?? this.#narc.impactRows(0), "out", rowsOf(layouts.Impact), count);
        memory.begin();
        memory.things = countOf(this.#bodies);
        const given = memory.bodies(this.#bodies), moving = memory.bodies(movers), moved = memory.options(layouts.Motions, motions, count);
        memory.call("narc_cast_shapes", this.pointer, this.#shapes.pointer, given, moving, moved, memory.options(layouts.IndexQuery, search, count),
            memory.options(layouts.CastOptions, options, count), rows.pointer, rows.capacity);
        rows.count = count;
        return rows;
    }
    /** Pairs (box, body) of boxes that overlap, numbers of one after the other. Boxes are minX, minY, maxX, maxY of one after the
     * other. */
    regions(boxes: Float32Array, search?: Search): Uint32Array {
        const { memory } = this, count = boxes.length / 4;
        if (!(boxes instanceof Float32Array))
            throw new TypeError("boxes: Float32Array is wanted");
        if (boxes.length % 4 !== 0)
            throw new RangeError(`boxes: ${boxes.length} numbers, four for each box are wanted`);
        memory.begin();
        memory.things = countOf(this.#bodies);
        const given = memory.copy(boxes), pairs = memory.clear(layouts.Pairs.size);
        memory.call("narc_query_index", this.pointer, given, count, memory.options(layouts.IndexQuery, search, count), pairs);
        const { a, b } = layouts.Pairs.members, { u32 } = memory, found = u32[pairs >> 2]!, out = new Uint32Array(2 * found);
        [a, b].forEach(({ offset }, i) => {
            const base = u32[(pairs + offset) >> 2]! >> 2, stride = u32[(pairs + offset + 4) >> 2]! >> 2;
            for (let k = 0; k < found; k++)
                out[2 * k + i] = u32[base + k * stride]!;
        });
        return out;
    }
}

// ------------------------------------------------------------------------------------------------ contacts that stay

/** What a step is told, as narc_step: margin, skin, recycling, filter, id, run, moved ... */
export type StepOptions = Omit<AllStepOptions, "bodies">;

/** Contacts that stay: each pair that is close has a slot, in which its row and `userSize` bytes of yours remain until it parts.
 * What is read here is of the last update(). */
export class Contacts extends Owned {
    readonly #userSize: number;
    readonly #result: StepResult & Cursor;
    readonly #manifold: Cursor;
    readonly #contact: Cursor;
    readonly #event: Cursor;

    /** @internal: Narc.contactsThatStay() makes it. */
    constructor(memory: Memory, settings?: ContactsSettingsOptions) {
        memory.begin();
        memory.call("narc_create_contacts", memory.options(layouts.ContactsSettings, settings, 1), memory.out);
        super(memory, "Contacts", memory.u32[memory.out >> 2]!, "narc_destroy_contacts");
        this.#userSize = settings?.userSize ?? 0;
        this.#result = new (cursorOf(layouts.StepResult))(memory) as StepResult & Cursor;
        this.#manifold = new (cursorOf(layouts.Manifold))(memory);
        this.#contact = new (cursorOf(layouts.Contact))(memory);
        this.#event = new (cursorOf(layouts.TouchEvent))(memory);
    }

    /** A step: boxes, pairs, rows, events, with work for what has changed. */
    update(shapes: Shapes, bodies: Bodies, options?: StepOptions): this {
        const { memory } = this;
        memory.begin();
        const step = memory.clear(layouts.Step.size);
        if (options !== undefined)
            memory.write(step, layouts.Step, options, countOf(bodies));
        memory.u32[(step + layouts.Step.members.bodies.offset) >> 2] = memory.bodies(bodies);
        memory.call("narc_update_contacts", this.pointer, memory.place(shapes, "shapes", "Shapes"), step, memory.out);
        this.#result.place = memory.u32[memory.out >> 2]!;
        return this;
    }

    #read(name: "order" | "touching" | "sensors", count: number, k: number): number {
        if (!(k >= 0 && k < count))
            throw new RangeError(`${name} ${k}: there are ${count}`);
        return this.memory.u32[(this.#result[name] >> 2) + k]!;
    }
    #of(): StepResult {
        if (this.#result.place === 0 || this.pointer === 0)
            throw new Error("contacts: there was no update() yet");
        return this.#result;
    }
    /** How many pairs are near each other, and the slot of number k. */
    get count(): number {
        return this.#of().count;
    }
    slot(k: number): number {
        return this.#read("order", this.count, k);
    }
    /** Slots with a row of which one body moves: what a solver goes through. */
    get touchingCount(): number {
        return this.#of().touchingCount;
    }
    touching(k: number): number {
        return this.#read("touching", this.touchingCount, k);
    }
    /** Slots of sensors that overlap something. */
    get sensorCount(): number {
        return this.#of().sensorCount;
    }
    sensor(k: number): number {
        return this.#read("sensors", this.sensorCount, k);
    }
    get beganCount(): number {
        return this.#of().beganCount;
    }
    began(k: number): TouchEvent {
        return this.#eventAt(this.#result.began, this.beganCount, k);
    }
    get endedCount(): number {
        return this.#of().endedCount;
    }
    ended(k: number): TouchEvent {
        return this.#eventAt(this.#result.ended, this.endedCount, k);
    }
    #eventAt(base: number, count: number, k: number): TouchEvent {
        if (!(k >= 0 && k < count))
            throw new RangeError(`event ${k}: there are ${count}`);
        this.#event.place = base + k * layouts.TouchEvent.size;
        return this.#event as unknown as TouchEvent;
    }
    /** Bodies in no pair because they are broken. */
    get skipped(): number {
        return this.#of().skipped;
    }
    get askedCount(): number {
        return this.#of().askedCount;
    }
    #inSlots(slot: number): number {
        return whole(slot, "slot", this.#of().pairs.count);
    }
    /** Bits of constants.TOUCHING, NEW, ASKED, FOLLOWED, TURNED. */
    state(slot: number): number {
        return this.memory.u8[this.#of().state + this.#inSlots(slot)]!;
    }
    /** The bodies of a slot. */
    a(slot: number): number {
        return this.memory.u32[(this.memory.u32[(this.#of().pairs as unknown as Cursor).place + layouts.Pairs.members.a.offset >> 2]! >> 2) + this.#inSlots(slot)]!;
    }
    b(slot: number): number {
        return this.memory.u32[(this.memory.u32[(this.#of().pairs as unknown as Cursor).place + layouts.Pairs.members.b.offset >> 2]! >> 2) + this.#inSlots(slot)]!;
    }
    /** The row of a slot, of contacts that were made without CONTACT_ROWS. */
    manifold(slot: number): Manifold {
        if (this.#of().manifolds === 0)
            throw new Error("manifold: rows are those of contacts");
        this.#manifold.place = this.#result.manifolds + this.#inSlots(slot) * layouts.Manifold.size;
        return this.#manifold as unknown as Manifold;
    }
    contact(slot: number): Contact {
        if (this.#of().contacts === 0)
            throw new Error(`contact: rows are those of manifolds; { rows: constants.CONTACT_ROWS } makes others (${constants.CONTACT_ROWS})`);
        this.#contact.place = this.#result.contacts + this.#inSlots(slot) * layouts.Contact.size;
        return this.#contact as unknown as Contact;
    }
    /** Where the bytes of a slot lie in memory.view. */
    user(slot: number): number {
        return this.#of().user + this.#inSlots(slot) * this.#userSize;
    }

    /** Forgets all pairs. */
    forget(): void {
        this.memory.function("narc_forget_contacts")(this.pointer);
    }
    /** Takes bodies out, by their ids. */
    forgetBodies(ids: BigUint64Array): void {
        this.memory.begin();
        this.memory.call("narc_forget_bodies", this.pointer, this.memory.copy(ids), ids.length);
    }
    /** All of it as bytes, from which load() goes on with the same bits. */
    save(): Uint8Array {
        const { memory } = this, size = memory.function("narc_count_contact_bytes")(this.pointer);
        memory.begin();
        const out = memory.take(size);
        memory.call("narc_save_contacts", this.pointer, out, size);
        return memory.u8.slice(out, out + size);
    }
    load(shapes: Shapes, bytes: Uint8Array): this {
        const { memory } = this;
        memory.begin();
        memory.call("narc_load_contacts", this.pointer, memory.place(shapes, "shapes", "Shapes"), memory.copy(bytes), bytes.length, memory.out);
        this.#result.place = memory.u32[memory.out >> 2]!;
        return this;
    }
}
