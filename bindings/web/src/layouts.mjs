// SPDX-License-Identifier: MIT
// Makes layouts.ts of the JSON that layouts.c prints: node layouts.mjs < JSON > layouts.ts. Names are those of the headers as
// JavaScript writes them: narc_ray_hit is RayHit, normal_x is normalX.
import { readFileSync } from "node:fs";

// What calls answer and are told; structures within come with them.
const ROWS = ["arc", "body", "box", "chain_entry", "circle", "contact", "distance", "error", "four_arc", "impact", "index_statistics", "manifold",
    "mass", "point", "ray_hit", "refined_contact", "step_result", "touch_event"].map((name) => `narc_${name}`);
const OPTIONS = ["bodies", "box_options", "cast_options", "chain_options", "contacts_settings", "four_arc", "index_options", "index_query", "motions",
    "nearest_options", "pair_filter", "pairs", "points", "query", "ray_options", "rays", "step"].map((name) => `narc_${name}`);
const { version, layouts, constants } = JSON.parse(readFileSync(0, "utf8"));
const camel = (name) => name.replace(/_([a-z0-9])/g, (_, letter) => letter.toUpperCase());
const typeName = (name) => camel(name.replace(/^narc/, ""));
const columns = { narc_float_column: "FloatColumn", narc_index_column: "IndexColumn", narc_word_column: "WordColumn",
    narc_byte_column: "ByteColumn", narc_position_column: "PositionColumn" };
const numbers = { float: "number", double: "number", uint8_t: "number", uint16_t: "number", uint32_t: "number", int32_t: "number",
    size_t: "number", ptrdiff_t: "number", uint64_t: "bigint", bool: "boolean" };
const optionsName = (name) => typeName(name).replace(/(Options)?$/, "Options");
const isEnumeration = (type) => layouts[type] && layouts[type].members.length === 0;

// What the core is handed by this package alone: memory, threads, where answers go, lengths of lists.
const own = /^(workers|allocator|reserved|out_.*|.+_count)$/;

// With all that is within them, or that options point to.
function closure(names, pointers) {
    const all = new Set(names);
    for (const name of all)
        for (const { type } of layouts[name].members) {
            const inner = pointers ? type.replace(/^const | \*$/g, "") : type;
            if (layouts[inner]?.members.length && !/^narc_(workers|allocator)$/.test(inner) && !(inner in columns))
                all.add(inner);
        }
    return all;
}
const rows = closure(ROWS, false), options = closure(OPTIONS, true);
const known = new Set([...rows, ...options, ...Object.keys(columns)]);

function memberOfRow({ name, type, count }) {
    const of = numbers[type] ?? (isEnumeration(type) || type.endsWith("*") ? "number" : rows.has(type) ? typeName(type) : undefined);
    return of && (count > 1 ? `    ${camel(name)}(index: number): ${of};` : `    ${camel(name)}: ${of};`);
}

function memberOfOptions({ name, type, count }) {
    if (own.test(name) || count > 1 || type === "function *")
        return undefined;
    const pointed = type.match(/^const (narc_[a-z_]+) \*$/);
    const of = columns[type] ?? numbers[type] ?? (isEnumeration(type) ? "number" : pointed && layouts[pointed[1]]?.members.length
        ? pointed[1] === "narc_bodies" ? "Bodies" : optionsName(pointed[1]) : layouts[type] ? optionsName(type) : undefined);
    return of && `    ${camel(name)}?: ${of} | undefined;`;
}

console.log(`// SPDX-License-Identifier: MIT
// Made by layouts.mjs from the headers of narc ${version}: where members of structures lie, and what constants are.
import type { Bodies, ByteColumn, FloatColumn, IndexColumn, PositionColumn, WordColumn } from "./memory.js";

export const version = ${JSON.stringify(version)};

export interface Member {
    readonly type: string;
    readonly offset: number;
    readonly size: number;
    readonly count: number;
}
export interface Layout {
    readonly name: string;
    readonly size: number;
    readonly members: Readonly<Record<string, Member>>;
}
`);
console.log("export const constants = {");
for (const [name, value] of Object.entries(constants))
    console.log(`    ${name.replace(/^NARC_/, "")}: ${value === null ? "Infinity" : value},`);
console.log("} as const;\n");
const bare = Object.fromEntries([...known].map((name) => [name, layouts[name]]).map(([name, { size, members }]) =>
    [typeName(name), { name: typeName(name), size, members: Object.fromEntries(members.filter((m) => m.name !== "reserved").map((m) =>
        [camel(m.name), { type: m.type, offset: m.offset, size: m.size, count: m.count }])) }]));
console.log(`export const layouts = ${JSON.stringify(bare)} satisfies Record<string, Layout>;\n`);
console.log(`export const enumerations: readonly string[] = ${JSON.stringify(Object.keys(layouts).filter(isEnumeration))};\n`);
const put = (kind, lines) => console.log(`export interface ${kind} {\n${lines.filter(Boolean).join("\n")}\n}\n`);
for (const name of rows)
    put(typeName(name), layouts[name].members.filter((m) => m.name !== "reserved").map(memberOfRow));
for (const name of options)
    if (name !== "narc_bodies")
        put(optionsName(name), layouts[name].members.map(memberOfOptions));
