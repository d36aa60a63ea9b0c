// SPDX-License-Identifier: MIT
// One engine in a process of its own: node engines.mjs NAME MODULES PACKAGE PAGE START. It is told by its parent what to do, a
// word at a time. START has shapes (points of polygons, or radii), bodies {x, y, angle, shape}, and walls {x, y, width, height}.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [name, modules, packed, page, file] = process.argv.slice(2);
const start = JSON.parse(readFileSync(file, "utf8")), { shapes, bodies, walls } = start;
const require = createRequire(resolve(modules, "x.js")), TIME = 1 / 60, FRICTION = 0.6;
const version = (of) => JSON.parse(readFileSync(resolve(modules, "node_modules", of, "package.json"), "utf8")).version;
const corners = ({ width, height }) => [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => [x * width / 2, y * height / 2]);

const engines = {
    async narc() {
        const { load, version: told } = await import(pathToFileURL(resolve(packed, "narc.js"))), narc = await load();
        const core = (await WebAssembly.instantiate(readFileSync(resolve(page, "page.wasm")))).instance.exports;
        core._initialize?.();
        core.begin(bodies.length + walls.length + 64);
        const add = (arcs) => {
            new Float64Array(core.memory.buffer).set(arcs, core.arc_list() / 8);
            return core.add_shape(arcs.length / 5);
        };
        const outline = (shape) => shape.radius ? narc.outlines.circle(shape.radius) : narc.outlines.polygon(shape.points);
        const numbers = shapes.map((shape) => add(outline(shape)));
        for (const { x, y, angle, shape } of bodies)
            core.add_body(numbers[shape], x, y, Math.cos(angle), Math.sin(angle), 0);
        for (const wall of walls)
            core.add_body(add(narc.outlines.box(wall.width, wall.height)), wall.x, wall.y, 1, 0, 1);
        const read = (k) => {
            const f32 = new Float32Array(core.memory.buffer), at = core.bodies() / 4 + k * core.body_size() / 4, v = at + core.velocity_offset() / 4;
            return [f32[at], f32[at + 1], Math.atan2(f32[at + 3], f32[at + 2]), f32[v], f32[v + 1], f32[v + 2]];
        };
        // The package's index, for questions: the same bodies, as they are then.
        let index, store, rows;
        const ask = () => {
            store ??= narc.shapes();
            rows ??= narc.bodies(bodies.length + walls.length);
            bodies.concat(walls).forEach((body, k) => {
                const [x, y, angle] = read(k);
                Object.assign(rows.at(k), { x, y, cosine: Math.cos(angle), sine: Math.sin(angle), shape: store.add(k < bodies.length ? outline(shapes[body.shape]) : narc.outlines.box(body.width, body.height)) });
            });
            index = narc.index(store, rows);
        };
        const columns = (rays, ...names) => Object.fromEntries(names.map((column, k) => [column, Float32Array.from(rays, (ray) => ray[k])]));
        return { version: told, read, begin: ask,
            step: () => {
                if (core.step() !== 0)
                    throw new Error("narc's world stops");
            },
            rays(rays) {
                const hits = index.rays(columns(rays, "x", "y", "motionX", "motionY"));
                return Array.from(hits, (hit) => hit.count ? hit.fraction : 1);
            },
            regions(boxes) {
                const pairs = index.regions(Float32Array.from(boxes.flat())), counts = new Array(boxes.length).fill(0);
                for (let k = 0; k < pairs.length; k += 2)
                    counts[pairs[k]]++;
                return counts;
            } };
    },
    async rapier() {
        const R = await import(pathToFileURL(resolve(modules, "node_modules/@dimforge/rapier2d-simd-compat/rapier.mjs")));
        await (R.default?.init ?? R.init)();
        const world = new R.World({ x: 0, y: -9.81 }), of = [];
        world.timestep = TIME;
        const collider = (shape) => (shape.radius ? R.ColliderDesc.ball(shape.radius) : R.ColliderDesc.convexHull(Float32Array.from(shape.points.flat()))).setFriction(FRICTION).setDensity(1);
        for (const { x, y, angle, shape } of bodies) {
            const body = world.createRigidBody(R.RigidBodyDesc.dynamic().setTranslation(x, y).setRotation(angle).setCanSleep(false));
            world.createCollider(collider(shapes[shape]), body);
            of.push(body);
        }
        for (const wall of walls)
            world.createCollider(R.ColliderDesc.cuboid(wall.width / 2, wall.height / 2).setFriction(FRICTION), world.createRigidBody(R.RigidBodyDesc.fixed().setTranslation(wall.x, wall.y)));
        return { version: version("@dimforge/rapier2d-simd-compat"), step: () => world.step(), begin() {},
            read: (k) => [of[k].translation().x, of[k].translation().y, of[k].rotation(), of[k].linvel().x, of[k].linvel().y, of[k].angvel()],
            rays: (rays) => rays.map(([x, y, dx, dy]) => world.castRay(new R.Ray({ x, y }, { x: dx, y: dy }), 1, true)?.timeOfImpact ?? 1),
            regions: (boxes) => boxes.map(([x0, y0, x1, y1]) => {
                let count = 0;
                world.collidersWithAabbIntersectingAabb({ x: (x0 + x1) / 2, y: (y0 + y1) / 2 }, { x: (x1 - x0) / 2, y: (y1 - y0) / 2 }, () => { count++; return true; });
                return count;
            }) };
    },
    async box2d() {
        const B = await (await import(pathToFileURL(resolve(modules, "node_modules/box2d3-wasm/build/dist/es/entry.mjs")))).default();
        const def = B.b2DefaultWorldDef();
        def.gravity = new B.b2Vec2(0, -9.81);
        def.enableSleep = false;
        const world = B.b2CreateWorld(def), of = [], made = B.b2DefaultShapeDef();
        made.density = 1;
        made.material.friction = FRICTION;
        const add = (x, y, angle, still) => {
            const body = B.b2DefaultBodyDef();
            body.type = still ? B.b2BodyType.b2_staticBody : B.b2BodyType.b2_dynamicBody;
            body.position = new B.b2Vec2(x, y);
            body.rotation = B.b2MakeRot(angle);
            return B.b2CreateBody(world, body);
        };
        const forms = shapes.map((shape) => shape.radius ? undefined : B.b2MakePolygon(B.b2ComputeHull(shape.points.map(([x, y]) => new B.b2Vec2(x, y))), 0));
        for (const { x, y, angle, shape } of bodies) {
            const body = add(x, y, angle, false);
            if (forms[shape])
                B.b2CreatePolygonShape(body, made, forms[shape]);
            else {
                const circle = new B.b2Circle();
                circle.center = new B.b2Vec2(0, 0);
                circle.radius = shapes[shape].radius;
                B.b2CreateCircleShape(body, made, circle);
            }
            of.push(body);
        }
        for (const wall of walls)
            B.b2CreatePolygonShape(add(wall.x, wall.y, 0, true), made, B.b2MakeBox(wall.width / 2, wall.height / 2));
        const filter = B.b2DefaultQueryFilter();
        return { version: version("box2d3-wasm"), step: () => B.b2World_Step(world, TIME, 4), begin() {}, end: () => B.PThread?.terminateAllThreads?.(),
            read(k) {
                const at = B.b2Body_GetPosition(of[k]), turn = B.b2Body_GetRotation(of[k]), v = B.b2Body_GetLinearVelocity(of[k]);
                return [at.x, at.y, Math.atan2(turn.s, turn.c), v.x, v.y, B.b2Body_GetAngularVelocity(of[k])];
            },
            rays: (rays) => rays.map(([x, y, dx, dy]) => {
                const from = new B.b2Vec2(x, y), way = new B.b2Vec2(dx, dy), told = B.b2World_CastRayClosest(world, from, way, filter), out = told.hit ? told.fraction : 1;
                for (const one of [from, way, told])
                    one.delete();
                return out;
            }),
            regions: (boxes) => boxes.map(([x0, y0, x1, y1]) => {
                const box = new B.b2AABB();
                box.lowerBound = new B.b2Vec2(x0, y0);
                box.upperBound = new B.b2Vec2(x1, y1);
                let count = 0;
                B.b2World_OverlapAABB(world, box, filter, () => { count++; return true; });
                return count;
            }) };
    },
    async planck() {
        const P = require("planck"), world = new P.World({ gravity: { x: 0, y: -9.81 }, allowSleep: false }), of = [];
        for (const { x, y, angle, shape } of bodies) {
            const body = world.createBody({ type: "dynamic", position: { x, y }, angle });
            body.createFixture({ shape: shapes[shape].radius ? new P.Circle(shapes[shape].radius) : new P.Polygon(shapes[shape].points.map(([u, v]) => new P.Vec2(u, v))), density: 1, friction: FRICTION });
            of.push(body);
        }
        for (const wall of walls)
            world.createBody({ position: wall }).createFixture({ shape: new P.Box(wall.width / 2, wall.height / 2), friction: FRICTION });
        return { version: version("planck"), step: () => world.step(TIME), begin() {},
            read: (k) => [of[k].getPosition().x, of[k].getPosition().y, of[k].getAngle(), of[k].getLinearVelocity().x, of[k].getLinearVelocity().y, of[k].getAngularVelocity()],
            rays: (rays) => rays.map(([x, y, dx, dy]) => {
                let out = 1;
                world.rayCast(new P.Vec2(x, y), new P.Vec2(x + dx, y + dy), (fixture, point, normal, fraction) => { out = fraction; return fraction; });
                return out;
            }),
            regions: (boxes) => boxes.map(([x0, y0, x1, y1]) => {
                let count = 0;
                world.queryAABB(new P.AABB(new P.Vec2(x0, y0), new P.Vec2(x1, y1)), () => { count++; return true; });
                return count;
            }) };
    },
    // Pixels, of which 40 are a metre; y grows upwards here too.
    async matter() {
        const M = require("matter-js"), unit = 40, engine = M.Engine.create({ gravity: { x: 0, y: -1, scale: 9.81 * unit / 1e6 } });
        const make = (points, x, y, angle, options) => M.Body.create({ position: { x: unit * x, y: unit * y }, vertices: points.map(([u, v]) => ({ x: unit * u, y: unit * v })), angle, friction: FRICTION, ...options });
        const of = bodies.map(({ x, y, angle, shape }) => shapes[shape].radius ? M.Bodies.circle(unit * x, unit * y, unit * shapes[shape].radius, { friction: FRICTION }) : make(shapes[shape].points, x, y, angle, {}));
        const all = [...of, ...walls.map((wall) => make(corners(wall), wall.x, wall.y, 0, { isStatic: true }))];
        M.Composite.add(engine.world, all);
        return { version: version("matter-js"), step: () => M.Engine.update(engine, 1000 * TIME), begin() {},
            read: (k) => [of[k].position.x / unit, of[k].position.y / unit, of[k].angle, of[k].velocity.x / unit / TIME, of[k].velocity.y / unit / TIME, of[k].angularVelocity / TIME],
            regions: (boxes) => boxes.map(([x0, y0, x1, y1]) => M.Query.region(all, { min: { x: unit * x0, y: unit * y0 }, max: { x: unit * x1, y: unit * y1 } }).length) };
    },
    // Questions alone.
    async "detect-collisions"() {
        const { System } = require("detect-collisions"), system = new System();
        for (const { x, y, angle, shape } of bodies) {
            if (shapes[shape].radius)
                system.createCircle({ x, y }, shapes[shape].radius);
            else
                system.createPolygon({ x, y }, shapes[shape].points.map(([u, v]) => ({ x: u, y: v }))).setAngle(angle);
        }
        for (const wall of walls)
            system.createPolygon(wall, corners(wall).map(([x, y]) => ({ x, y })));
        system.update();
        return { version: version("detect-collisions"), begin() {},
            rays: (rays) => rays.map(([x, y, dx, dy]) => {
                const hit = system.raycast({ x, y }, { x: x + dx, y: y + dy });
                return hit ? Math.hypot(hit.point.x - x, hit.point.y - y) / Math.hypot(dx, dy) : 1;
            }),
            regions: (boxes) => boxes.map(([minX, minY, maxX, maxY]) => system.search({ minX, minY, maxX, maxY }).length) };
    },
};

const engine = await engines[name]();
const poses = () => bodies.map((_, k) => engine.read(k));
const timed = (run) => {
    const begin = performance.now(), out = run();
    return { ms: performance.now() - begin, out };
};
const words = {
    poses: () => engine.read ? poses() : undefined,
    steps({ count, limit }) {
        const all = [];
        for (let k = 0, spent = 0; k < count && spent < limit; k++) {
            all.push(timed(engine.step).ms);
            spent += all.at(-1);
        }
        return all;
    },
    begin: () => engine.begin(),
    rays: (rays) => engine.rays && timed(() => engine.rays(rays)),
    regions: (boxes) => engine.regions && timed(() => engine.regions(boxes)),
};
process.on("message", ({ word, given }) => process.send({ answer: words[word](given) }));
process.on("disconnect", () => process.exit());
process.send({ answer: { version: engine.version, steps: Boolean(engine.step) } });
