// SPDX-License-Identifier: MIT
// Two shapes and the test of their arcs: what narc answers, and why. docs/algorithm.md tells it in full.
const ARC = 5, TURN = 2 * Math.PI, EDGE = 0x40;

const turnTo = (from, angle) => ((angle - from) % TURN + TURN) % TURN;
/** The arcs of outlines, as objects. */
const listOf = (arcs) => Array.from({ length: arcs.length / ARC }, (_, k) => {
    const [x, y, radius, start, end] = arcs.subarray(ARC * k, ARC * k + ARC);
    return { x, y, radius, start, end: end < start ? end + TURN : end };
});
/** Is the direction within the sector of the arc? */
const holds = (arc, angle) => turnTo(arc.start - 1e-9, angle) <= arc.end - arc.start + 2e-9;
const pointOf = (arc, angle) => [arc.x + arc.radius * Math.cos(angle), arc.y + arc.radius * Math.sin(angle)];
/** How far a shape reaches in a direction. */
const reachOf = (list, angle) => {
    const arc = list.find((one) => holds(one, angle)) ?? list[0];
    return arc.x * Math.cos(angle) + arc.y * Math.sin(angle) + arc.radius;
};

/** All pairs of arcs that pass the paper's test: the centre of each lies in the sector of the other one. */
function passing(a, b) {
    const out = [];
    a.forEach((p, i) => b.forEach((q, j) => {
        const angle = Math.atan2(q.y - p.y, q.x - p.x);
        if (holds(p, angle) && holds(q, angle + Math.PI))
            out.push({ i, j, angle, gap: Math.hypot(q.x - p.x, q.y - p.y) - p.radius - q.radius });
    }));
    return out;
}

export function makePairs(narc) {
    const { outlines } = narc, shapes = narc.shapes(), bodies = narc.bodies(2);
    const ring = (count, f) => Array.from({ length: count }, (_, k) => {
        const t = TURN * k / count, r = f(t, k);
        return [r * Math.cos(t), r * Math.sin(t)];
    });
    const kinds = [["an 8-arc", outlines.ring(ring(8, (t) => 1 + 0.16 * Math.cos(2 * t) + 0.1 * Math.sin(t)))], ["a box", outlines.box(1.7, 1.1)],
        ["a 6-arc", outlines.ring(ring(6, (t) => 0.9 + 0.2 * Math.cos(2 * t)))], ["a round box", outlines.box(1.6, 1.2, 0.3)], ["a capsule", outlines.capsule(1.2, 0.45)],
        ["a 4-arc", outlines.ellipse(1.1, 0.6, 4)], ["a hexagon", outlines.regularPolygon(6, 0.95)], ["a lens", outlines.fourArc({ radiusLow: 1.2, radiusHigh: 1.2, distance: 1.4, radiusLeft: 0.15, radiusRight: 0.15 })]]
        .map(([name, arcs]) => ({ name, arcs: outlines.center(arcs) }));
    for (const kind of kinds)
        kind.shape = shapes.add(kind.arcs);
    let a = kinds[0], b = kinds[2], angle = 0.4, x = 1.75, y = 0.35, grip = null;

    function start(seed) {
        a = kinds[(seed - 1) % kinds.length];
        b = kinds[(2 + 3 * (seed - 1)) % kinds.length];
        if (a === b)
            b = kinds[(kinds.indexOf(a) + 1) % kinds.length];
        [angle, x, y, grip] = [0.4, 1.75, 0.35, null];
    }

    /** What narc says of the two, and the formula of docs/algorithm.md, section 4: the largest gap of all candidates. */
    function ask() {
        [[a, 0, 0, 0], [b, x, y, angle]].forEach(([kind, atX, atY, turned], k) => Object.assign(bodies.at(k),
            { x: atX, y: atY, cosine: Math.cos(turned), sine: Math.sin(turned), shape: kind.shape }));
        const row = narc.contact(shapes, bodies, 0, 1, Infinity), { separation, normalX, normalY, pointX, pointY, feature } = row;
        const arcsA = listOf(a.arcs), arcsB = listOf(outlines.move(b.arcs, x, y, angle)), all = passing(arcsA, arcsB);
        const gapAlong = (t) => -reachOf(arcsA, t) - reachOf(arcsB, t + Math.PI);
        const gap = Math.max(...all.map((pair) => pair.gap), ...arcsA.map(({ start: t }) => gapAlong(t)), ...arcsB.map(({ start: t }) => gapAlong(t + Math.PI)));
        return { separation, gap, gapAlong, normal: [normalX, normalY], point: [pointX, pointY], features: [feature & 255, feature >> 8], arcsA, arcsB, all };
    }

    const outline = (context, list) => {
        context.beginPath();
        for (const arc of list)
            context.arc(arc.x, arc.y, arc.radius, arc.start, arc.end);
        context.closePath();
    };
    /** The sector of an arc from its centre, far out. */
    const wedge = (context, arc, far) => {
        context.beginPath();
        context.moveTo(arc.x, arc.y);
        context.arc(arc.x, arc.y, far, arc.start, arc.end);
        context.closePath();
        context.fill();
    };
    const dot = (context, [px, py], size) => {
        context.beginPath();
        context.arc(px, py, size, 0, TURN);
        context.fill();
    };
    const line = (context, from, to) => {
        context.beginPath();
        context.moveTo(...from);
        context.lineTo(...to);
        context.stroke();
    };

    function draw(context, { scale, ratio, colors }) {
        const told = ask(), pixel = ratio / scale, { arcsA, arcsB, normal, separation } = told, far = 40;
        const [nx, ny] = normal, tint = [colors.fills[1], colors.fills[3]];
        context.lineJoin = "round";
        for (const [k, list] of [arcsA, arcsB].entries()) {
            outline(context, list);
            context.fillStyle = tint[k];
            context.globalAlpha = 0.28;
            context.fill();
            context.globalAlpha = 1;
            const feature = told.features[k], lit = feature & EDGE ? -1 : feature & 63;
            list.forEach((arc, i) => {
                context.globalAlpha = 0.2;
                if (i === lit)
                    wedge(context, arc, far);
                context.globalAlpha = 0.5; // the sectors: where one arc ends and the next begins
                context.strokeStyle = tint[k];
                context.lineWidth = pixel;
                const [px, py] = pointOf(arc, arc.start);
                line(context, [px, py], [px + 0.5 * Math.cos(arc.start), py + 0.5 * Math.sin(arc.start)]);
                context.globalAlpha = 1;
                const before = list[(i + list.length - 1) % list.length];
                context.lineWidth = 2 * pixel;
                line(context, pointOf(before, before.end), pointOf(arc, arc.start));
                context.beginPath();
                context.arc(arc.x, arc.y, arc.radius, arc.start, arc.end);
                context.stroke();
            });
            context.strokeStyle = colors.accent;
            context.lineWidth = 5 * pixel;
            const arc = list[feature & 63], before = list[((feature & 63) + list.length - 1) % list.length];
            if (feature & EDGE)
                line(context, pointOf(before, before.end), pointOf(arc, arc.start));
            else if (arc.radius > 0) {
                context.beginPath();
                context.arc(arc.x, arc.y, arc.radius, arc.start, arc.end);
                context.stroke();
            }
            context.fillStyle = colors.accent;
            if (!(feature & EDGE))
                dot(context, [arc.x, arc.y], 3.5 * pixel);
        }
        if (told.features.every((feature) => !(feature & EDGE))) { // from centre to centre
            context.setLineDash([5 * pixel, 4 * pixel]);
            context.lineWidth = 1.5 * pixel;
            const [p, q] = [arcsA[told.features[0] & 63], arcsB[told.features[1] & 63]];
            line(context, [p.x, p.y], [q.x, q.y]);
            context.setLineDash([]);
        }
        const [mx, my] = told.point, half = separation / 2, onA = [mx - half * nx, my - half * ny], onB = [mx + half * nx, my + half * ny];
        context.strokeStyle = context.fillStyle = colors.ink;
        context.lineWidth = 2.5 * pixel;
        line(context, onA, onB);
        dot(context, onA, 4.5 * pixel);
        dot(context, onB, 4.5 * pixel);
        const tip = [mx + 0.55 * nx, my + 0.55 * ny];
        line(context, [mx, my], tip);
        for (const side of [-1, 1])
            line(context, tip, [tip[0] - 0.12 * nx + 0.06 * side * ny, tip[1] - 0.12 * ny - 0.06 * side * nx]);
        return told;
    }

    /** The gap between the two over all directions: its top is the separation. In pixels. */
    function plot(context, told, { width, height, ratio, colors }) {
        const w = Math.min(340 * ratio, 0.5 * width), h = Math.min(130 * ratio, 0.24 * height), left = width - w - 12 * ratio, top = height - h - 12 * ratio, count = 240;
        const gaps = Array.from({ length: count + 1 }, (_, k) => told.gapAlong(TURN * k / count));
        const low = Math.min(...gaps), high = Math.max(0.2, ...gaps), at = (t, gap) => [left + w * t / TURN, top + h * (high - gap) / (high - low)];
        context.fillStyle = colors.face;
        context.globalAlpha = 0.9;
        context.fillRect(left, top, w, h);
        context.globalAlpha = 1;
        context.lineWidth = ratio;
        context.strokeStyle = colors.line;
        context.strokeRect(left, top, w, h);
        line(context, at(0, 0), at(TURN, 0));
        context.beginPath();
        gaps.forEach((gap, k) => context.lineTo(...at(TURN * k / count, gap)));
        context.strokeStyle = colors.ink;
        context.lineWidth = 1.5 * ratio;
        context.stroke();
        context.fillStyle = colors.quiet;
        for (const { angle: t, gap } of told.all)
            dot(context, at(turnTo(0, t), gap), 3.5 * ratio);
        context.fillStyle = colors.accent;
        dot(context, at(turnTo(0, Math.atan2(told.normal[1], told.normal[0])), told.separation), 4.5 * ratio);
        context.font = `${12 * ratio}px system-ui, sans-serif`;
        context.fillStyle = colors.quiet;
        context.fillText("gap over the direction; its top is the separation", left, top - 6 * ratio);
    }

    function describe({ separation, features, arcsA, arcsB, all }) {
        const name = (feature, of) => `${feature & EDGE ? "edge" : "arc"} ${feature & 63} of ${of}`;
        const said = separation < 0 ? `They overlap by ${(-separation).toFixed(4)}` : `They are ${separation.toFixed(4)} apart`;
        const touching = `${name(features[0], "the left one")} and ${name(features[1], "the right one")} decide`;
        return `${said}: ${touching}. Of ${arcsA.length} × ${arcsB.length} pairs of arcs ${all.length} ${all.length === 1 ? "passes" : "pass"} the test: each centre lies in the other's sector. ` +
            "The pointer turns the right shape; drag it to move it.";
    }

    return {
        box: [-2.6, -1.8, 3.4, 2], start, ask,
        purpose: () => `${a.name} and ${b.name}`,
        draw, plot, describe,
        down(at) {
            grip = outlines.contains(outlines.move(b.arcs, x, y, angle), ...at) ? [x - at[0], y - at[1]] : null;
        },
        move(at) {
            if (grip)
                [x, y] = [at[0] + grip[0], at[1] + grip[1]];
            else if (Math.hypot(at[0] - x, at[1] - y) > 0.05)
                angle = Math.atan2(at[1] - y, at[0] - x);
        },
        up() { grip = null; },
        turn(by) { angle += by; },
    };
}
