// SPDX-License-Identifier: MIT
// The page: scenes of the example engine in page.wasm, drawn by arcs, moved by the pointer; and two of the package for
// JavaScript, pairs.js and many.js.
import { makeMany } from "./many.js";
import { makePairs } from "./pairs.js";

const $ = (id) => document.getElementById(id);
const canvas = $("canvas"), context = canvas.getContext("2d");
const TITLES = { well: "A thousand bodies", wheels: "Who is smooth?", draw: "Draw", ground: "Ground", rays: "Rays", plates: "Bullets", pairs: "Two shapes",
    many: "20,000", looping: "Looping", pyramid: "Pyramid", dominoes: "Dominoes", platforms: "Platforms", rain: "Rain", stack: "Stack of 30" };
// Scenes that others stand for, and what is switched on with them.
const SAME = { rays: "well" }, WITH = { wheels: "arcs", rays: "rays", draw: "draw", ground: "draw" };
const ORDER = Object.keys(TITLES);
const STEP = 1 / 60, BODY = 6, POINT = 4, ARC = 5, NODE = 5, GROUND = 0.2;

let core, narc, load, own = {}, scenes, current, seed = 1, paths, lit, extents, view, memory = {};
let owed = 0, last = 0, held = false, stroke = null, shown = null, fits = null;
let pointer = null, ground = null, speeds = [], shots = { flown: 0, through: 0 }, steps = 0;
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
    if (current === "well" || current === "rays")
        box = [-21, -1, 21, 35];
    if (current === "rain")
        box = [-9, -4, 9, 11];
    if (current === "draw")
        box = [-10, -1, 10, 10];
    if (current === "plates")
        box = [-11, -1, 11, 8];
    if (current === "ground") {
        const xs = ground.map(([x]) => x), ys = ground.map(([, y]) => y);
        box = [Math.min(...xs) - 1, Math.min(...ys) - 2, Math.max(...xs) + 1, Math.max(...ys) + 6];
    }
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
            context.strokeStyle = flags & 2 ? colors.ground : colors.face; // a thin plate is to be seen
            context.lineWidth = (flags & 2 ? 2 : 1) * view.ratio / s;
            context.stroke(path);
        }
    }
    context.globalAlpha = 1;
    if (on("arcs"))
        drawArcs(count, base, place);
    if (on("boxes"))
        drawBoxes(count, base);
    context.setTransform(s, 0, 0, -s, view.x, view.y);
    if (on("tree"))
        drawTree();
    if (on("rays"))
        drawRays();
    if (on("contacts"))
        drawContacts();
    if (stroke)
        drawLine(stroke, colors.accent, 2);
    if (fits)
        drawFits();
    if (current === "wheels")
        drawSpeeds();
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

/** The four n-arcs of the last outline beside their polygons, along the upper edge. */
function drawFits() {
    const { ratio } = view, many = fits.all.length, width = Math.min(230 * ratio, canvas.width / many), size = 0.62 * width, top = 34 * ratio;
    const { x0, y0, x1, y1 } = fits, scale = 0.82 * size / Math.max(x1 - x0, y1 - y0);
    fits.all.forEach(({ arcs, polygon, count, told }, k) => {
        const middle = (k + 0.5) * width;
        context.setTransform(1, 0, 0, 1, 0, 0);
        context.fillStyle = colors.face;
        context.globalAlpha = 0.85;
        context.fillRect(middle - width / 2, top, width, size + 66 * ratio);
        context.globalAlpha = 1;
        context.setTransform(scale, 0, 0, -scale, middle - scale * (x0 + x1) / 2, top + size / 2 + scale * (y0 + y1) / 2);
        const line = (points, color, pixels, dash = []) => {
            context.setLineDash(dash.map((d) => d * ratio / scale));
            context.beginPath();
            points.forEach(([x, y]) => context.lineTo(x, y));
            context.closePath();
            context.strokeStyle = color;
            context.lineWidth = pixels * ratio / scale;
            context.stroke();
            context.setLineDash([]);
        };
        line(fits.stroke, colors.line, 4);
        line(polygon, colors.quiet, 1.2, [5, 4]);
        context.beginPath();
        for (let i = 0; i < arcs.length; i += ARC)
            context.arc(...arcs.subarray(i, i + ARC));
        context.closePath();
        context.strokeStyle = colors.accent;
        context.lineWidth = 2 * ratio / scale;
        context.stroke();
        context.setTransform(1, 0, 0, 1, 0, 0);
        context.textAlign = "center";
        context.fillStyle = colors.ink;
        context.font = `600 ${Math.min(13 * ratio, width / 13)}px system-ui, sans-serif`;
        context.fillText(`${count} arcs`, middle, top + size + 14 * ratio);
        context.font = `${Math.min(12 * ratio, width / 15)}px system-ui, sans-serif`;
        context.fillStyle = colors.accent;
        context.fillText(told.arcs, middle, top + size + 32 * ratio);
        context.fillStyle = colors.quiet;
        context.fillText(told.polygon, middle, top + size + 50 * ratio);
        context.textAlign = "start";
    });
}

/** The speeds of both wheels over time. */
function drawSpeeds() {
    const { ratio } = view, w = Math.min(380 * ratio, 0.6 * canvas.width), h = Math.min(150 * ratio, 0.25 * canvas.height), left = canvas.width - w - 12 * ratio, top = 12 * ratio;
    const most = Math.max(4, ...speeds.flat()), long = Math.max(speeds.length, 300);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.strokeStyle = colors.line;
    context.lineWidth = ratio;
    context.strokeRect(left, top, w, h);
    context.font = `${12 * ratio}px system-ui, sans-serif`;
    ["n-arc", "polygon"].forEach((name, k) => {
        context.strokeStyle = context.fillStyle = k === 0 ? colors.accent : colors.quiet;
        context.lineWidth = 2 * ratio;
        context.beginPath();
        speeds.forEach((pair, i) => context.lineTo(left + w * i / long, top + h - h * pair[k] / most));
        context.stroke();
        context.fillText(`${name} ${(speeds.at(-1)?.[k] ?? 0).toFixed(2)} m/s`, left + 8 * ratio, top + (18 + 16 * k) * ratio);
    });
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

/** The boxes of the tree that rays and regions go through, the larger ones thicker. */
function drawTree() {
    const count = core.grow(), { f32, u32 } = views(), base = core.nodes() / 4;
    for (let k = 0, level = -1; k < count; k++) {
        const at = base + NODE * k, [x0, y0, x1, y1] = f32.subarray(at, at + 4);
        if (u32[at + 4] !== level) {
            if (level >= 0)
                context.stroke();
            level = u32[at + 4];
            context.beginPath();
            context.strokeStyle = level === 0 ? colors.quiet : colors.accent;
            context.lineWidth = (0.5 + 0.8 * level) * view.ratio / view.scale;
        }
        if (x0 <= x1)
            context.rect(x0, y0, x1 - x0, y1 - y0);
    }
    if (count > 0)
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
    steps++;
    if (current === "wheels" && speeds.length < 3600)
        speeds.push([core.speed(0), core.speed(1)]);
    if (current === "plates")
        countShots();
    if (status !== 0)
        say(`The engine stops: ${text(core.error())}`);
    return status === 0;
}

/** Bodies 2 to 17 fly in turns from the left and from the right: has one of them come to the other side? */
function countShots() {
    const count = core.draw(), { f32 } = views(), base = core.drawn() / 4;
    shots.flown = 16 * (1 + Math.floor(steps / 120));
    shots.through = 0;
    for (let k = 2; k < Math.min(count, 18); k++)
        shots.through += Number((f32[base + BODY * k] > 0) === (k % 2 === 0) && f32[base + BODY * k + 1] > 0.1 && f32[base + BODY * k + 1] < 7);
}

/** A scene of the package. */
function tickOwn(scene, paused) {
    if (!paused && scene.step) {
        const begin = performance.now();
        scene.step();
        times.step += 0.05 * (performance.now() - begin - times.step);
    }
    const begin = performance.now(), { scale: s } = view;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.setTransform(s, 0, 0, -s, view.x, view.y);
    const told = scene.draw(context, { ...view, colors });
    context.setTransform(1, 0, 0, 1, 0, 0);
    scene.plot?.(context, told, { width: canvas.width, height: canvas.height, ratio: view.ratio, colors });
    say(scene.describe(told));
    times.draw += 0.05 * (performance.now() - begin - times.draw);
    return scene.numbers?.() ?? scene.purpose();
}

function tick(now) {
    const passed = Math.min((now - last) / 1000, 0.05);
    last = now;
    requestAnimationFrame(tick);
    if (current in OWN) {
        if (own[current])
            $("numbers").textContent = `${tickOwn(own[current], on("pause"))} · drawing ${times.draw.toFixed(1)} ms · one thread of WebAssembly`;
        return;
    }
    if (!on("pause")) {
        owed += passed * (on("slow") ? 0.2 : 1);
        for (let k = 0; k < 2 && owed >= STEP; k++, owed -= STEP)
            if (!step())
                setPressed("pause", true);
        owed = Math.min(owed, STEP);
    }
    draw();
    const also = { plates: `${shots.flown} shots, ${shots.through} through · ` }[current] ?? "";
    $("numbers").textContent = `${core.body_count().toLocaleString("en")} bodies, ${core.moving_count()} awake · ${core.pair_count().toLocaleString("en")} pairs · ${also}` +
        `step ${times.step.toFixed(1)} ms, drawing ${times.draw.toFixed(1)} ms${on("rays") ? `, 1,080 rays and their tree ${times.rays.toFixed(2)} ms` : ""} · one thread of WebAssembly`;
}

function say(message) {
    if ($("message").textContent !== message)
        $("message").textContent = message;
}

/** Scenes that need the package wait for it. */
const OWN = { pairs: () => makePairs(narc), many: () => makeMany(load, narc) };
let asked;
async function needNarc() {
    asked ??= import("./narc/narc.js").then(async (module) => {
        ({ load } = module);
        narc = await load();
    });
    await asked;
}
async function startOwn(name) {
    try {
        await needNarc();
        own[name] ??= await OWN[name]();
        if (current !== name)
            return;
        own[name].start(seed);
        view = { box: own[name].box };
        resize();
    } catch (error) {
        say(`The package does not start: ${error.message}`);
    }
}

function setPressed(id, pressed) {
    $(id).setAttribute("aria-pressed", String(pressed));
}

function start(name, from = seed) {
    const number = scenes.indexOf(SAME[name] ?? name);
    for (const toggle of ["arcs", "rays", "draw"])
        if (name !== current)
            setPressed(toggle, WITH[name] === toggle);
    current = name;
    seed = from;
    paths = [];
    lit = [];
    extents = [];
    stroke = shown = pointer = fits = null;
    speeds = [];
    steps = 0;
    shots = { flown: 16, through: 0 };
    held = false;
    owed = 0;
    if (name in OWN) {
        say("One moment ...");
        startOwn(name);
    } else {
        if (name === "ground")
            layTrack();
        if (core.start(number, seed) !== 0)
            say(`The scene cannot be built: ${text(core.error())}`);
        else
            say(text(core.scene_purpose(number)).replace(/^./, (first) => first.toUpperCase()));
        frame();
    }
    for (const tab of $("tabs").children) {
        const selected = tab.dataset.scene === name;
        tab.setAttribute("aria-selected", String(selected));
        tab.tabIndex = selected ? 0 : -1;
    }
    const track = name === "ground" && ground !== HILLS ? `&ground=${ground.map(([x, y]) => `${Math.round(10 * x)},${Math.round(10 * y)}`).join(";")}` : "";
    history.replaceState(null, "", `#scene=${name}&seed=${seed}${track}`);
}

// ------------------------------------------------------------------------------------------------ ground

const HILLS = Array.from({ length: 33 }, (_, k) => [1.5 * k, Math.round(10 * (2.2 * Math.sin(0.42 * k) * Math.sin(0.13 * k))) / 10]);

/** Knots of a stroke from left to right, some way apart, in tenths of a metre; undefined where it leads nowhere. */
function knotsOf(points) {
    const turned = points[0][0] > points.at(-1)[0] ? [...points].reverse() : points, knots = [];
    let from = -Infinity;
    for (let k = 0; k < turned.length; k++) {
        if (turned[k][0] < from + 1.2)
            continue;
        const near = turned.filter(([x]) => Math.abs(x - turned[k][0]) < 0.5); // their mean is where the hand wanted to go
        from = turned[k][0];
        knots.push([from, near.reduce((sum, [, y]) => sum + y, 0) / near.length].map((value) => Math.round(10 * value) / 10));
    }
    return knots.length > 3 ? knots : undefined;
}

/** The chain through the middles between knots, from its right end to its left one: a straight line of which each corner is an arc. */
function layTrack() {
    ground ??= HILLS;
    const line = [...ground].reverse(), { f64 } = views(), at = core.track() / 8, room = core.track_room();
    let count = 0;
    const put = (...arc) => {
        if (count < room)
            f64.set(arc, at + ARC * count++);
    };
    const way = (k) => [line[k + 1][0] - line[k][0], line[k + 1][1] - line[k][1]], length = (k) => Math.hypot(...way(k));
    const normal = (k) => Math.atan2(way(k)[1], way(k)[0]) - Math.PI / 2;
    put(...line[0], 0, normal(0), normal(0));
    for (let k = 1; k + 1 < line.length; k++) {
        let turn = normal(k) - normal(k - 1);
        turn -= 2 * Math.PI * Math.round(turn / (2 * Math.PI));
        if (Math.abs(turn) < 2e-5)
            continue;
        const reach = 0.499 * Math.min(length(k - 1), length(k)), gentle = Math.abs(turn) < 0.02;
        const radius = gentle ? 0 : reach / Math.tan(turn / 2), [x, y] = gentle ? line[k] : [line[k][0] - reach * way(k - 1)[0] / length(k - 1), line[k][1] - reach * way(k - 1)[1] / length(k - 1)];
        const from = normal(k - 1);
        put(x - radius * Math.cos(from), y - radius * Math.sin(from), radius === 0 && turn < 0 ? -0 : radius, from, from + turn);
    }
    put(...line.at(-1), 0, normal(line.length - 2), normal(line.length - 2));
    const top = Math.max(...ground.filter(([x]) => x < ground[0][0] + 4).map(([, y]) => y));
    core.set_track(count, ground[0][0], top + 0.3, ...ground.at(-1));
}

function addGround(points) {
    const knots = knotsOf(points), before = ground;
    if (!knots)
        return say("Draw the ground from one side to the other.");
    ground = knots;
    start("ground", seed);
    if (core.error_status() !== 0) {
        const told = text(core.error());
        ground = before;
        start("ground", seed);
        say(`That ground cannot be driven: ${told}`);
    } else
        say("The car drives it. Draw again for another one; the address of this page has it.");
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

const areaOf = (ring) => Math.abs(ring.reduce((sum, [x, y], k) => {
    const [u, v] = ring[(k + 1) % ring.length];
    return sum + (x * v - u * y) / 2;
}, 0));

/** How far the points are from a polygon at most. */
const awayFrom = (polygon, points) => Math.max(...points.map(([x, y]) => Math.min(...polygon.map(([ax, ay], k) => {
    const [bx, by] = polygon[(k + 1) % polygon.length], dx = bx - ax, dy = by - ay;
    const t = Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
    return Math.hypot(x - ax - t * dx, y - ay - t * dy);
}))));

/** What n-arcs and polygons of 4 to 12 make of an outline, told beside each other. */
async function compare(points) {
    await needNarc();
    const { outlines } = narc, ring = corners(points, 160), area = areaOf(ring), all = [];
    for (const count of [4, 6, 8, 12]) {
        const polygon = corners(points, count);
        let arcs;
        try {
            arcs = outlines.ring(polygon);
        } catch {
            continue;
        }
        const away = Math.max(...ring.map(([x, y]) => Math.abs(outlines.distance(arcs, x, y))));
        const tell = (name, own, off) => `${name}: area ${own >= area ? "+" : "−"}${(100 * Math.abs(own / area - 1)).toFixed(1)} %, ${(100 * off).toFixed(0)} cm off`;
        all.push({ arcs, polygon, count, away, told: { arcs: tell("n-arc", outlines.mass(arcs).area, away), polygon: tell("polygon", areaOf(polygon), awayFrom(polygon, ring)) } });
    }
    const xs = ring.map(([x]) => x), ys = ring.map(([, y]) => y);
    fits = { all, stroke: ring, x0: Math.min(...xs), x1: Math.max(...xs), y0: Math.min(...ys), y1: Math.max(...ys) };
}

function addOutline(points) {
    const polygon = corners(points, Number($("count").value)), { f64 } = views(), at = core.outline() / 8;
    polygon.forEach(([x, y], k) => f64.set([x, y], at + 2 * k));
    const count = core.add_outline(polygon.length);
    if (count < 0)
        return say("That outline crosses itself or is too small: draw around something.");
    const list = core.arc_list() / 8, path = new Path2D(), now = views();
    for (let k = 0; k < count; k++)
        path.arc(...now.f64.subarray(list + ARC * k, list + ARC * k + ARC));
    path.closePath();
    shown = { path, polygon, until: performance.now() + 2500 };
    say(`An n-arc of ${count} arcs follows your outline, by Algorithm 1 of the paper; dashed is the polygon of as many corners.`);
    if (current === "draw")
        compare(points);
}

function listen() {
    canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        const [x, y] = toWorld(event);
        if (current in OWN)
            own[current]?.down?.([x, y]);
        else if (on("draw"))
            stroke = [[x, y]];
        else
            held = core.grab(x, y, 12 * view.ratio / view.scale) !== 0;
    });
    canvas.addEventListener("pointermove", (event) => {
        if (!view)
            return;
        const [x, y] = pointer = toWorld(event);
        if (current in OWN)
            own[current]?.move?.([x, y]);
        else if (stroke)
            stroke.push([x, y]);
        else if (held)
            core.move(x, y);
    });
    const end = () => {
        const drawn = stroke;
        stroke = null;
        held = false;
        own[current]?.up?.();
        if (drawn && drawn.length > 3)
            (current === "ground" ? addGround : addOutline)(drawn);
        core.release();
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    const toggles = ["pause", "slow", "draw", "contacts", "arcs", "boxes", "tree", "sleep", "rays"];
    for (const id of toggles)
        $(id).addEventListener("click", () => setPressed(id, !on(id)));
    $("single").addEventListener("click", () => {
        setPressed("pause", true);
        if (current in OWN)
            own[current]?.step?.();
        else
            step();
    });
    $("share").addEventListener("click", async () => {
        try {
            await navigator.clipboard.writeText(location.href);
            say("The address of this scene is in the clipboard.");
        } catch {
            say(`The address of this scene: ${location.href}`);
        }
    });
    $("again").addEventListener("click", () => start(current, seed % 1e6 + 1));
    $("more").addEventListener("click", more);
    const keys = { " ": "pause", ".": "single", s: "slow", r: "again", d: "draw", m: "more", c: "contacts", a: "arcs", b: "boxes", t: "tree", z: "sleep", l: "rays", u: "share" };
    for (const [key, id] of Object.entries(keys))
        $(id).dataset.key = key === " " ? "␣" : key;
    addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("select") || (event.key === " " && event.target.closest("button")))
            return;
        const number = event.key === "0" ? 10 : Number(event.key), turn = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (event.key !== " " && number >= 1 && number <= 10)
            start(ORDER[number - 1], 1);
        else if (turn && current in OWN && own[current]?.turn && !event.target.closest("#tabs"))
            own[current].turn(-0.05 * turn);
        else if (turn && event.target.closest("#tabs")) {
            start(ORDER[(ORDER.indexOf(current) + turn + ORDER.length) % ORDER.length], 1);
            $("tabs").querySelector("[aria-selected=true]").focus();
        } else if (keys[event.key.toLowerCase()])
            $(keys[event.key.toLowerCase()]).click();
        else
            return;
        event.preventDefault();
    });
    const showKeys = (shown) => document.documentElement.classList.toggle("keys", shown);
    showKeys(matchMedia("(hover: hover) and (pointer: fine)").matches);
    for (const kind of ["pointerdown", "pointermove"])
        addEventListener(kind, (event) => showKeys(event.pointerType === "mouse"), { capture: true });
    addEventListener("keydown", () => showKeys(true), { capture: true });
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
        tab.textContent = TITLES[name];
        if (k < 10)
            tab.dataset.key = String((k + 1) % 10);
        tab.setAttribute("role", "tab");
        tab.setAttribute("aria-controls", "stage");
        tab.dataset.scene = name;
        tab.addEventListener("click", () => start(name, 1));
        $("tabs").append(tab);
    });
    listen();
    const asked = new URLSearchParams(location.hash.slice(1)), name = asked.get("scene"), from = Number(asked.get("seed"));
    const knots = (asked.get("ground") ?? "").split(";").map((pair) => pair.split(",").map((value) => Number(value) / 10));
    if (knots.length > 3 && knots.every((pair, k) => pair.length === 2 && pair.every((value) => Math.abs(value) < 1000) && (k === 0 || pair[0] > knots[k - 1][0])))
        ground = knots;
    if (matchMedia("(prefers-reduced-motion: reduce)").matches)
        setPressed("pause", true);
    start(ORDER.includes(name) ? name : ORDER[0], Number.isInteger(from) && from > 0 ? from : 1);
    // What tests ask.
    globalThis.page = { core, own, shots: () => shots, fits: () => fits, ground: () => ground, speeds: () => speeds, draw, start, step, times, text, view: () => view, lit: () => lit, hash: () => (core.hash_high() >>> 0).toString(16).padStart(8, "0") + (core.hash_low() >>> 0).toString(16).padStart(8, "0") };
    last = performance.now();
    requestAnimationFrame(tick);
}

main();
