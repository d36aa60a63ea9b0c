# SPDX-License-Identifier: MIT
"""view.py NARC SVG - narc view: what a page holds is read again; in headless Chromium, where there is one, it is looked at."""
import base64
import html
import json
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

NARC, SVG = os.path.abspath(sys.argv[1]), sys.argv[2:] != ["OFF"]
os.chdir(folder := tempfile.mkdtemp())
QUARTERS = [{"center": [0, 0], "radius": 10, "start": k * math.pi / 2 - 7, "end": (k + 1) * math.pi / 2 - 7} for k in range(4)]
SHAPES = {"shapes": [
    {"name": "tee/2", "box": {"width": 4, "height": 8}, "origin": [20, 4]}, {"name": "a<b\\", "circle": 3, "origin": [1e6, 0]},
    {"name": "tee/1", "box": {"width": 30, "height": 4}, "origin": [20, 10]}, {"name": "ring", "arcs": QUARTERS, "origin": [30, -40]},
    {"name": "ground", "chain": {"closed": False, "arcs": [
        {"center": [-4, 0], "radius": 2, "start": math.pi / 2, "end": math.pi},
        {"center": [-8, 0], "radius": -2, "start": math.pi, "end": math.pi / 2}]}}]}
RING = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="10 20 40 40"><circle cx="30" cy="40" r="10" fill="lime"/></svg>'
rows = b"".join(b"\0" + b"".join(b"\xff\0\0\xff" if 5 <= x < 35 and y < 12 else bytes(4) for x in range(40)) for y in range(12))
chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
PNG = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 40, 12, 8, 6, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
for name, data in ("shapes.json", json.dumps(SHAPES).encode()), ("ring.svg", RING.encode()), ("tee.png", PNG):
    with open(name, "wb") as file:
        file.write(data)
drawings = ["tee.png"] + ["ring.svg"] * SVG


def narc(*arguments):
    done = subprocess.run([NARC, *arguments], capture_output=True, encoding="utf-8")
    return done.returncode, done.stdout, done.stderr


assert narc("view", "shapes.json", *drawings, "--out", "page.html") == (0, "", "")
with open("page.html", encoding="utf-8") as file:
    page = file.read()
assert narc("view", "shapes.json", *drawings)[1] == page
bodies = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>\s*</html>\s*$', page, re.S)[1])["bodies"]
tee, odd, ring, ground = sorted(bodies, key=lambda body: ["tee", "a<b\\", "ring", "ground"].index(body["name"]))
assert [part["name"] for part in tee["parts"]] == ["tee/1", "tee/2"] and len(bodies) == 4
assert abs(tee["area"] - 152) < 1e-9 and abs(odd["area"] - 9 * math.pi) < 1e-9 and ground["area"] == 0
(arc,) = odd["parts"][0]["arcs"]
assert arc[:3] == [1e6, 0, 3] and abs(arc[4] - math.tau) < 1e-15
for arc, known in zip(ring["parts"][0]["arcs"], QUARTERS):
    assert arc[:4] == [30, -40, known["radius"], known["start"]] and abs(arc[4] - math.pi / 2) < 1e-12
(part,) = ground["parts"]
assert part["chain"] and not part["closed"] and [round(arc[4], 9) for arc in part["arcs"]] == [1.570796327, -1.570796327]
assert base64.b64decode(tee["image"].removeprefix("data:image/png;base64,")) == PNG
xs, ys = tee["outline"][0][::2], tee["outline"][0][1::2]
assert [min(xs), min(ys), max(xs), max(ys)] == [5, 0, 35, 12], tee["outline"]
if SVG:
    assert base64.b64decode(ring["image"].removeprefix("data:image/svg+xml;base64,")) == RING.encode()
    assert all(abs(math.hypot(x - 30, y + 40) - 10) < 1e-3 for x, y in zip(ring["outline"][0][::2], ring["outline"][0][1::2]))
assert not re.search(r"\b(src|href)=|@import|url\(|fetch\(", page.split('id="data"')[0])
code, out, err = narc("view", "shapes.json", "tee.png", "--out", "tee.png")
assert code == 2 and "one of the inputs" in err
code, out, err = narc("view", "absent.json")
assert code == 2 and err.startswith("narc: absent.json: ")

# A shape and a chain of one name have no area; far away it is measured as well; what no body is named by is told.
chain = SHAPES["shapes"][4]["chain"]
for shapes, area in (({"circle": 1}, {"chain": chain}, {"box": {"width": 1, "height": 1}}), 0), \
        (({"circle": 1, "origin": [1e9, 5]}, {"circle": 1, "origin": [1e9, 15]}), math.tau):
    with open("h.json", "w", encoding="utf-8") as file:
        json.dump({"shapes": [{"name": f"h/{k + 1}", **shape} for k, shape in enumerate(shapes)]}, file)
    code, out, err = narc("view", "h.json", "tee.png")
    assert code == 0 and abs(float(re.search('"name":"h","area":(.*?),', out)[1]) - area) < 1e-6, out[-900:]
    assert err == "narc: tee.png: it is not shown: no body is named 'tee'\n", err
code, out, err = narc("view", "h.json", "--out", "{name}.html")
assert code == 2 and "--out is one file" in err and not os.path.exists("{name}.html")

# Looks at the middle of a body: over the image its parts, or with them hidden the image alone; keys and the wheel move it.
LOOK = """<script>
const wait = setInterval(async () => {
    if (!document.body.dataset.drawn) return;
    clearInterval(wait);
    const next = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))), key = (key) => dispatchEvent(new KeyboardEvent("keydown", { key }));
    const tee = bodies.findIndex((body) => body.name === "tee"), k = SVG ? bodies.findIndex((body) => body.name === "ring") : tee;
    const look = async (x, y) => { await next(); return [...pen.getImageData(x * canvas.width, y * canvas.height, 1, 1).data]; };
    const result = { said, buttons: document.querySelectorAll("nav button").length, paper: getComputedStyle(document.body).backgroundColor };
    choose(k);
    result.parts = await look(0.5, 0.5);
    for (const box of document.querySelectorAll("#tools input")) if (!box.parentElement.textContent.startsWith("image")) box.click();
    result.image = await look(0.5, 0.5);
    result.none = await look(0.02, 0.02);
    const scale = view.scale;
    key("+"); key("ArrowLeft");
    canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: -100 }));
    const at = (type, id, x) => canvas.dispatchEvent(new PointerEvent(type, { pointerId: id, clientX: x, clientY: 300 }));
    canvas.setPointerCapture = () => {};
    at("pointerdown", 1, 400); at("pointerdown", 2, 500); at("pointermove", 2, 600); at("pointerup", 1, 400); at("pointerup", 2, 600);
    result.zoom = view.scale / scale;
    key("0");
    await next();
    result.all = view.x > 0 && view.y > 0 && view.x + view.scale * all.width < canvas.clientWidth && view.y + view.scale * all.height < canvas.clientHeight;
    document.body.dataset.result = JSON.stringify(result);
}, 20);
</script>"""
chromium = shutil.which(os.environ.get("CHROMIUM", "chromium"))
if not chromium:
    print("skipped: the page in a browser, without chromium")
else:
    with open("test.html", "w", encoding="utf-8") as file:
        file.write(page.replace('"use strict";', '"use strict"; const said = [], SVG = %s; globalThis.requestAnimationFrame = (f) => setTimeout(f, 1); onerror = (m) => said.push(m); onunhandledrejection = (e) => document.body.dataset.failed = e.reason; '
                                'document.addEventListener("securitypolicyviolation", (e) => said.push(e.blockedURI));' % str(SVG).lower(), 1)
                   .replace("</html>", LOOK + "</html>"))
    for scheme, paper in (1, "rgb(250, 248, 244)"), (0, "rgb(20, 23, 28)"):
        for budget in 5000, 20000, 60000: # virtual time runs ahead of images that are decoded on a busy machine
            seen = subprocess.run([chromium, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/user", f"--virtual-time-budget={budget}",
                                   f"--blink-settings=preferredColorScheme={scheme}", "--enable-logging=stderr", "--dump-dom", f"file://{folder}/test.html"],
                                  capture_output=True, encoding="utf-8", timeout=120)
            if 'data-result' in seen.stdout:
                break
        assert 'data-result' in seen.stdout, seen.stderr + seen.stdout[-2000:]
        result = json.loads(html.unescape(re.search('data-result="(.*?)"', seen.stdout)[1]))
        assert not result["said"] and result["buttons"] == 4 and result["paper"] == paper and result["all"], result
        assert result["image"] == ([0, 255, 0, 255] if SVG else [255, 0, 0, 255]) and result["none"] == [0] * 4, result
        assert result["parts"] != result["image"] and result["parts"][3] == 255, result
        assert abs(result["zoom"] - 1.25 * math.exp(0.25) * 2) < 1e-9, result

os.chdir("/")
shutil.rmtree(folder)
print("all checks passed")
