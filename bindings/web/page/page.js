// SPDX-License-Identifier: MIT
// The page: scenes of the example engine in page.wasm, drawn by arcs, moved by the pointer.
const $ = (id) => document.getElementById(id);
const canvas = $("canvas"), context = canvas.getContext("2d");
const TITLES = { well: "A thousand bodies", wheels: "Who is smooth?", looping: "Looping", car: "Car on arcs", bullets: "Bullets", dominoes: "Dominoes", platforms: "Platforms",
    rain: "Rain", pyramid: "Pyramid", stack: "Stack of 30" };
const ORDER = Object.keys(TITLES);
const STEP = 1 / 60, BODY = 6, POINT = 4, ARC = 5, GROUND = 0.2;

let core, scenes, current, seed = 1, paths, lit, extents, view, memory = {};
let owed = 0, last = 0, held = false, stroke = null, shown = null;
let pointer = null;
const times = { step: 0, draw: 0, rays: 0 };
const on = (id) => $(id).getAttribute("aria-pressed") === "true";

function text(pointer) {
    const bytes = new Uint8Array(core.memory.buffer, pointer);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
}

/** Views of the module's memory, made again when it has grown. */
function views() {
    const { buffer } = core.memory;
    if (memory.buffer !== buffer)
        memory = { buffer, f32: new Float32Array(buffer), u32: new Uint32Array(buffer), f64: new Float64Array(buffer) };
    return memory;
}

// ------------------------------------------------------------------------------------------------ shapes as paths

/** The outline of a shape by true arcs; ground is open. Straight edges are what joins one arc to the next. */
function pathOf(shape, open) {
    const count = core.arcs(shape), { f64 } = views(), path = new Path2D(), list = core.arc_list() / 8;
    let extent = 0;
    for (let k = 0; k < count; k++) {
        const [x, y, given, start, end] = f64.subarray(list + ARC * k, list + ARC * k + ARC);
        const radius = given - (open ? GROUND / 2 : 0); // a band below the surface
        extent = Math.max(extent, Math.hypot(x, y) + Math.abs(radius));
        if (radius < 0) // concave: its points lie on the other side of the circle
            path.arc(x, y, -radius, start + Math.PI, end + Math.PI, end < start);
        else
            path.arc(x, y, radius, start, end, end < start);
    }
    if (!open)
        path.closePath();
    extents[shape] = extent;
    return path;
}

/** Each arc by itself, for the overlay. */
function arcsOf(shape) {
    const count = core.arcs(shape), { f64 } = views(), list = core.arc_list() / 8, out = [];
    for (let k = 0; k < count; k++) {
        const path = new Path2D();
        path.arc(...f64.subarray(list + ARC * k, list + ARC * k + ARC));
        out.push(path);
    }
    return out;
}

// ------------------------------------------------------------------------------------------------ drawing

let colors = {};
function readColors() {
    const style = getComputedStyle(document.documentElement), get = (name) => style.getPropertyValue(name).trim();
    colors = { fills: [0, 1, 2, 3, 4, 5].map((k) => get(`--c${k}`)), ink: get("--ink"), ground: get("--ground"), face: get("--face"), accent: get("--accent"), line: get("--line"), quiet: get("--quiet") };
}

/** What of the world is seen: all of it, as the scene begins. */
function frame() {
    const count = core.draw(), { f32, u32 } = views(), base = core.drawn() / 4;
    let box = [Infinity, Infinity, -Infinity, -Infinity];
    for (let k = 0; k < count; k++) {
        const at = base + BODY * k, flags = u32[at + 5], shape = u32[at + 4], e = flags & 4 || !(flags & 2) ? extentOf(shape, flags) : 0;
        if (flags & 8)
            continue;
        box = [Math.min(box[0], f32[at] - e), Math.min(box[1], f32[at + 1] - e), Math.max(box[2], f32[at] + e), Math.max(box[3], f32[at + 1] + e)];
    }
    if (current === "well")
        box = [-21, -1, 21, 35];
    if (current === "rain")
        box = [-9, -4, 9, 11];
    view = { box };
    resize();
}

function extentOf(shape, flags) {
    paths[shape] ??= pathOf(shape, (flags & 4) !== 0);
    return Math.min(extents[shape], 12);
}

function resize() {
    const { width, height } = canvas.getBoundingClientRect(), ratio = Math.min(devicePixelRatio || 1, 2);
    if (width === 0 || !view)
        return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const [x0, y0, x1, y1] = view.box, scale = Math.min(canvas.width / (x1 - x0), canvas.height / (y1 - y0)) * 0.96;
    Object.assign(view, { ratio, scale, x: canvas.width / 2 - scale * (x0 + x1) / 2, y: canvas.height / 2 + scale * (y0 + y1) / 2 });
}

const toWorld = (event) => {
    const { left, top } = canvas.getBoundingClientRect();
    return [((event.clientX - left) * view.ratio - view.x) / view.scale, (view.y - (event.clientY - top) * view.ratio) / view.scale];
};

function draw() {
    const begin = performance.now(), count = core.draw(), { f32, u32 } = views(), base = core.drawn() / 4, { scale: s } = view;
    const sleeping = on("sleep"), place = (at) => {
        const c = s * f32[at + 2], d = s * f32[at + 3];
        context.setTransform(c, -d, -d, -c, view.x + s * f32[at], view.y - s * f32[at + 1]);
    };
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.lineJoin = context.lineCap = "round";
    for (let k = 0; k < count; k++) {
        const at = base + BODY * k, shape = u32[at + 4], flags = u32[at + 5], path = paths[shape] ??= pathOf(shape, (flags & 4) !== 0);
        place(at);
        if (flags & 4) {
            context.strokeStyle = colors.ground;
            context.lineWidth = GROUND;
            context.stroke(path);
        } else if (flags & 8)
            continue;
        else {
            context.fillStyle = flags & 2 ? colors.ground : colors.fills[shape % colors.fills.length];
            context.globalAlpha = sleeping && flags & 1 ? 0.3 : 1;
            context.fill(path);
            context.strokeStyle = colors.face;
            context.lineWidth = view.ratio / s;
            context.stroke(path);
        }
    }
    context.globalAlpha = 1;
    if (on("arcs"))
        drawArcs(count, base, place);
    if (on("boxes"))
        drawBoxes(count, base);
    context.setTransform(s, 0, 0, -s, view.x, view.y);
    if (on("rays"))
        drawRays();
    if (on("contacts"))
        drawContacts();
    if (stroke)
        drawLine(stroke, colors.accent, 2);
    if (shown && performance.now() < shown.until) {
        context.setLineDash([6 / s, 6 / s]);
        drawLine([...shown.polygon, shown.polygon[0]], colors.quiet, 1.5);
        context.setLineDash([]);
        context.strokeStyle = colors.accent;
        context.lineWidth = 2.5 / s;
        context.stroke(shown.path);
    }
    times.draw += 0.05 * (performance.now() - begin - times.draw);
}

function drawLine(points, color, width) {
    context.beginPath();
    for (const [x, y] of points)
        context.lineTo(x, y);
    context.strokeStyle = color;
    context.lineWidth = width / view.scale * view.ratio;
    context.stroke();
}

function drawArcs(count, base, place) {
    const { u32 } = views();
    for (let k = 0; k < count; k++) {
        const at = base + BODY * k, shape = u32[at + 4];
        if (u32[at + 5] & 12)
            continue;
        const arcs = lit[shape] ??= arcsOf(shape);
        place(at);
        context.lineWidth = 2 / view.scale;
        arcs.forEach((path, i) => {
            context.strokeStyle = `hsl(${i * 360 / arcs.length} 85% 45%)`;
            context.stroke(path);
        });
    }
}

function drawBoxes(count, base) {
    const { f32, u32 } = views(), { scale: s } = view;
    context.setTransform(s, 0, 0, -s, view.x, view.y);
    context.strokeStyle = colors.quiet;
    context.lineWidth = 1 / s;
    context.beginPath();
    for (let k = 0; k < count; k++) {
        const at = base + BODY * k, shape = u32[at + 4];
        if (u32[at + 5] & 14)
            continue;
        const list = core.arc_list() / 8, arcs = core.arcs(shape), { f64 } = views(), c = f32[at + 2], d = f32[at + 3];
        let x0 = Infinity, y0 = Infinity, x1 = -Infinity, y1 = -Infinity;
        for (let i = 0; i < arcs; i++) { // around the circles of all arcs
            const x = c * f64[list + ARC * i] - d * f64[list + ARC * i + 1], y = d * f64[list + ARC * i] + c * f64[list + ARC * i + 1], r = f64[list + ARC * i + 2];
            const own = Math.min(r, extents[shape] ?? r);
            x0 = Math.min(x0, x - own); x1 = Math.max(x1, x + own); y0 = Math.min(y0, y - own); y1 = Math.max(y1, y + own);
        }
        const e = extents[shape] ?? 1;
        x0 = Math.max(x0, -e); y0 = Math.max(y0, -e); x1 = Math.min(x1, e); y1 = Math.min(y1, e);
        context.rect(f32[at] + x0, f32[at + 1] + y0, x1 - x0, y1 - y0);
    }
    context.stroke();
}

/** A scanner at the pointer, or in the middle: what it sees, and where its rays end. */
function drawRays() {
    const [x0, y0, x1, y1] = view.box, [x, y] = pointer ?? [(x0 + x1) / 2, y0 + 0.75 * (y1 - y0)];
    const begin = performance.now(), count = core.scan(x, y, x1 - x0), { f32 } = views(), base = core.points() / 4;
    times.rays += 0.1 * (performance.now() - begin - times.rays);
    context.beginPath();
    for (let k = 0; k < count; k++)
        context.lineTo(f32[base + POINT * k], f32[base + POINT * k + 1]);
    context.closePath();
    context.fillStyle = context.strokeStyle = colors.accent;
    context.globalAlpha = 0.22;
    context.fill();
    context.globalAlpha = 1;
    context.beginPath();
    const dot = 3 * view.ratio / view.scale;
    for (let k = 0; k < count; k++)
        if (f32[base + POINT * k + 2] || f32[base + POINT * k + 3])
            context.rect(f32[base + POINT * k] - dot / 2, f32[base + POINT * k + 1] - dot / 2, dot, dot);
    context.rect(x - 2 * dot, y - 2 * dot, 4 * dot, 4 * dot);
    context.fill();
}

function drawContacts() {
    const count = core.touch(), { f32 } = views(), base = core.points() / 4, length = 14 / view.scale, dot = 3 / view.scale;
    context.strokeStyle = context.fillStyle = colors.accent;
    context.lineWidth = 1.5 / view.scale;
    context.beginPath();
    for (let k = 0; k < count; k++) {
        const at = base + POINT * k, x = f32[at], y = f32[at + 1];
        context.moveTo(x, y);
        context.lineTo(x + length * f32[at + 2], y + length * f32[at + 3]);
    }
    context.stroke();
    context.beginPath();
    for (let k = 0; k < count; k++)
        context.rect(f32[base + POINT * k] - dot / 2, f32[base + POINT * k + 1] - dot / 2, dot, dot);
    context.fill();
}

// ------------------------------------------------------------------------------------------------ time

function step() {
    const begin = performance.now(), status = core.step();
    times.step += 0.05 * (performance.now() - begin - times.step);
    if (status !== 0)
        say(`The engine stops: ${text(core.error())}`);
    return status === 0;
}

function tick(now) {
    const passed = Math.min((now - last) / 1000, 0.05);
    last = now;
    if (!on("pause")) {
        owed += passed * (on("slow") ? 0.2 : 1);
        for (let k = 0; k < 2 && owed >= STEP; k++, owed -= STEP)
            if (!step())
                setPressed("pause", true);
        owed = Math.min(owed, STEP);
    }
    draw();
    $("numbers").textContent = `${core.body_count().toLocaleString("en")} bodies, ${core.moving_count()} awake · ${core.pair_count().toLocaleString("en")} pairs · ` +
        `step ${times.step.toFixed(1)} ms, drawing ${times.draw.toFixed(1)} ms${on("rays") ? `, 1,080 rays and their tree ${times.rays.toFixed(2)} ms` : ""} · one thread of WebAssembly`;
    requestAnimationFrame(tick);
}

function say(message) {
    $("message").textContent = message;
}

function setPressed(id, pressed) {
    $(id).setAttribute("aria-pressed", String(pressed));
}

function start(name, from = seed) {
    const number = scenes.indexOf(name);
    current = name;
    seed = from;
    paths = [];
    lit = [];
    extents = [];
    stroke = shown = pointer = null;
    held = false;
    owed = 0;
    if (core.start(number, seed) !== 0)
        say(`The scene cannot be built: ${text(core.error())}`);
    else
        say(text(core.scene_purpose(number)).replace(/^./, (first) => first.toUpperCase()));
    frame();
    for (const tab of $("tabs").children) {
        const selected = tab.dataset.scene === name;
        tab.setAttribute("aria-selected", String(selected));
        tab.tabIndex = selected ? 0 : -1;
    }
    history.replaceState(null, "", `#scene=${name}&seed=${seed}`);
}

// ------------------------------------------------------------------------------------------------ the pointer

/** So many corners on the way around the stroke, as far apart along it. */
function corners(points, count) {
    const ring = [...points, points[0]], lengths = [0];
    for (let k = 1; k < ring.length; k++)
        lengths.push(lengths[k - 1] + Math.hypot(ring[k][0] - ring[k - 1][0], ring[k][1] - ring[k - 1][1]));
    const out = [];
    for (let i = 0, k = 0; i < count; i++) {
        const along = lengths.at(-1) * i / count;
        while (lengths[k + 1] < along)
            k++;
        const t = (along - lengths[k]) / (lengths[k + 1] - lengths[k] || 1);
        out.push([ring[k][0] + t * (ring[k + 1][0] - ring[k][0]), ring[k][1] + t * (ring[k + 1][1] - ring[k][1])]);
    }
    return out;
}

function addOutline(points) {
    const polygon = corners(points, Number($("count").value)), { f64 } = views(), at = core.outline() / 8;
    polygon.forEach(([x, y], k) => f64.set([x, y], at + 2 * k));
    const count = core.add_outline(polygon.length);
    if (count < 0)
        return say("That outline crosses itself or is too small: draw around something.");
    const list = core.arc_list() / 8, path = new Path2D(), now = views();
    let doubled = 0;
    for (let k = 0; k < count; k++)
        path.arc(...now.f64.subarray(list + ARC * k, list + ARC * k + ARC));
    path.closePath();
    polygon.forEach(([x, y], k) => {
        const [u, v] = polygon[(k + 1) % polygon.length];
        doubled += x * v - u * y;
    });
    shown = { path, polygon, until: performance.now() + 2500 };
    say(`An n-arc of ${count} arcs follows your outline; the dashed polygon has as many corners and an area of ${Math.abs(doubled / 2).toFixed(2)} m².`);
}

function listen() {
    canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        const [x, y] = toWorld(event);
        if (on("draw"))
            stroke = [[x, y]];
        else
            held = core.grab(x, y, 12 * view.ratio / view.scale) !== 0;
    });
    canvas.addEventListener("pointermove", (event) => {
        const [x, y] = pointer = toWorld(event);
        if (stroke)
            stroke.push([x, y]);
        else if (held)
            core.move(x, y);
    });
    const end = () => {
        if (stroke && stroke.length > 3)
            addOutline(stroke);
        stroke = null;
        held = false;
        core.release();
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    const toggles = ["pause", "slow", "draw", "contacts", "arcs", "boxes", "sleep", "rays"];
    for (const id of toggles)
        $(id).addEventListener("click", () => setPressed(id, !on(id)));
    $("single").addEventListener("click", () => {
        setPressed("pause", true);
        step();
    });
    $("again").addEventListener("click", () => start(current, seed % 1e6 + 1));
    $("more").addEventListener("click", more);
    const keys = { " ": "pause", ".": "single", s: "slow", r: "again", d: "draw", m: "more", c: "contacts", a: "arcs", b: "boxes", z: "sleep", l: "rays" };
    addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("select") || (event.key === " " && event.target.closest("button")))
            return;
        const number = event.key === "0" ? 10 : Number(event.key), turn = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (number >= 1 && number <= ORDER.length)
            start(ORDER[number - 1], 1);
        else if (turn && event.target.closest("#tabs")) {
            start(ORDER[(ORDER.indexOf(current) + turn + ORDER.length) % ORDER.length], 1);
            $("tabs").querySelector("[aria-selected=true]").focus();
        } else if (keys[event.key.toLowerCase()])
            $(keys[event.key.toLowerCase()]).click();
        else
            return;
        event.preventDefault();
    });
    new ResizeObserver(resize).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", readColors);
}

/** Twenty bodies more, from above, of shapes that the scene has. */
function more() {
    const count = core.draw(), { u32 } = views(), base = core.drawn() / 4, [x0, , x1, y1] = view.box, shapes = [];
    for (let k = 0; k < count; k++)
        if (!(u32[base + BODY * k + 5] & 14))
            shapes.push(u32[base + BODY * k + 4]);
    for (let k = 0; k < 20 && shapes.length > 0; k++)
        if (core.drop(shapes[(k * 37) % shapes.length], (x0 + x1) / 2 + (k % 5 - 2) * 1.6, y1 - 1.6 * Math.floor(k / 5) - 1.6) !== 0)
            return say("No room for more bodies.");
}

async function main() {
    if (typeof WebAssembly !== "object")
        return say("This browser lacks WebAssembly, in which the engine is written.");
    readColors();
    try {
        const module = await WebAssembly.instantiate(await (await fetch("page.wasm")).arrayBuffer());
        core = module.instance.exports;
    } catch (error) {
        return say(`The engine does not start: ${error.message} It needs WebAssembly with vectors (simd128).`);
    }
    core._initialize?.();
    scenes = [];
    for (let k = 0; text(core.scene_name(k)); k++)
        scenes.push(text(core.scene_name(k)));
    ORDER.forEach((name, k) => {
        const tab = document.createElement("button");
        Object.assign(tab, { textContent: TITLES[name], title: String((k + 1) % 10) });
        tab.setAttribute("role", "tab");
        tab.setAttribute("aria-controls", "stage");
        tab.dataset.scene = name;
        tab.addEventListener("click", () => start(name, 1));
        $("tabs").append(tab);
    });
    listen();
    const asked = new URLSearchParams(location.hash.slice(1)), name = asked.get("scene"), from = Number(asked.get("seed"));
    if (matchMedia("(prefers-reduced-motion: reduce)").matches)
        setPressed("pause", true);
    start(ORDER.includes(name) ? name : ORDER[0], Number.isInteger(from) && from > 0 ? from : 1);
    // What tests ask.
    globalThis.page = { core, start, step, times, text, view: () => view, lit: () => lit, hash: () => (core.hash_high() >>> 0).toString(16).padStart(8, "0") + (core.hash_low() >>> 0).toString(16).padStart(8, "0") };
    last = performance.now();
    requestAnimationFrame(tick);
}

main();
