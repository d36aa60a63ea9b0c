# SPDX-License-Identifier: MIT
"""surprises.py NARC SVG - what an artist's files may be that was not thought of: each is named, and what to do is said."""
import base64
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


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, alpha, extra=b""):
    """The gray image with alpha(x, y); `extra` are chunks before the first image."""
    rows = b"".join(b"\0" + b"".join(b"\0" + bytes([alpha(x, y)]) for x in range(width)) for y in range(min(height, 64)))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 4, 0, 0, 0)) + extra +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def svg(inside):
    return f"<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' viewBox='0 0 64 64'>{inside}</svg>".encode()


def told(file, data, *options):
    with open(file, "wb") as out:
        out.write(data)
    done = subprocess.run([NARC, "fit", file, "--arcs", "3", "--starts", "1", "--out", "new.json", *options], capture_output=True, encoding="utf-8")
    assert done.returncode == (0 if os.path.exists("new.json") else 2), done
    if done.returncode == 0:
        os.remove("new.json")
    return done.returncode, done.stderr


def dot(x, y):
    return 255 if (x - 8) ** 2 + (y - 8) ** 2 < 30 else 0


DOT = "<circle cx='40' cy='40' r='9'/>"
warned = [("moves.png", png(16, 16, dot, chunk(b"acTL", struct.pack(">II", 2, 0))), "an animation (APNG): its first image counts; save all as a sheet for --grid")]
failed = [
    ("clear.png", png(16, 16, lambda x, y: 0), "the image is transparent throughout"),
    ("faint.png", png(16, 16, lambda x, y: dot(x, y) // 4), "no pixel of the image reaches the threshold 0.5; the strongest has 0.247"),
    ("huge.png", png(20001, 20000, lambda x, y: 0), "an image of 20001 x 20000 pixels; at most 20000 a side and 100000000 in all are read, make it smaller"),
    ("empty.png", b"", "the PNG file is empty"), ("empty.csv", b"\n", "the text is empty"),
    ("line.csv", b"0,0\n1,1\n2,2\n", "all points of the outline lie on a line, it has no area"),
    ("a.gif", b"GIF89a", "a GIF image: save it as PNG, an animation as a sheet for --grid"),
    ("jpeg.png", b"\xff\xd8\xff\xe0", "a JPEG image, which has no transparency: save it as PNG"),
    ("a.psd", b"8BPS\0", "a Photoshop document: save it as PNG"), ("a.svgz", b"\x1f\x8b\x08", "compressed: unpack it, of .svgz comes .svg"),
    ("dwg.dxf", b"AC1032", "a DWG drawing: save it as DXF"), ("a.x", b"?", "neither its beginning nor its suffix is that of a font, .*"),
]
if SVG:
    image = "data:image/png;base64," + base64.b64encode(png(16, 16, dot)).decode()
    warned += [
        ("moves.svg", svg(f"<g>{DOT}<animateTransform attributeName='transform' type='scale' to='2'/></g>"), r"it moves \(animate\): what it is before counts; .*"),
        ("style.svg", svg("<style><![CDATA[@keyframes a { to { opacity: 0 } }]]></style>" + DOT), r"it moves \(@keyframes\): .*"),
        ("image.svg", svg(f"<image width='64' height='64' href='{image}'/>"), "it holds an image of pixels, which is traced .*"),
    ] + [("link.svg", svg(link + DOT), f"'{file}' is another file, which is never loaded: embed it") for link, file in (
        ("<image width='9' height='9' href='moves.png'/>", "moves.png"), ("<use xlink:href='other.svg#a'/>", "other.svg#a"),
        ("<rect width='9' height='9' fill='url(other.svg#b)'/>", "other.svg#b"), ("<style>@import 'a.css';</style>", "a.css"), ("<style>@font-face { src: URL(\"f.woff\") }</style>", "f.woff"),
        ("<style>@import url(\"http://example.com/a.css\");</style>", "http://example.com/a.css"))]
    failed += [("none.svg", svg(""), "nothing is seen in the SVG file"), ("empty.svg", b"", "the SVG file is empty")]
    for quiet in f"<defs><linearGradient id='a'/></defs><rect width='9' height='9' fill='url(#a)'/><a href='x.html'>{DOT}</a>", f"<g data-x='see url(http://e.org/)'>{DOT}</g>", DOT:
        assert told("quiet.svg", svg(quiet)) == (0, ""), quiet
LINES = "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\na\n10\n0\n20\n0\n11\n4\n21\n0\n0\nLINE\n8\na\n10\n4\n20\n0\n11\n4\n21\n3\n0\nENDSEC\n0\nEOF\n"
open_lines = "1 of its lines are open, and closed by a straight line each; narc fit --chain --open keeps them as strokes"
warned.append(("open.dxf", LINES.encode(), open_lines))
for expected, cases in (0, warned), (2, failed):
    for file, data, message in cases:
        code, err = told(file, data)
        pattern = message if ".*" in message else re.escape(message)
        assert code == expected and re.fullmatch(f"narc: {file}: {pattern}\n", err), (file, code, err, message)
# Of many in a file an error has the name.
code, err = told("layers.dxf", LINES.replace("0\nLINE\n8\na\n10\n4\n20\n0\n11\n4\n21\n3\n", "").encode(), "--ids", "*")
assert code == 2 and err.endswith("narc: layers.dxf: 'a': all points of the outline lie on a line, it has no area\n"), err
done = subprocess.run([NARC, "fit", "open.dxf", "--chain", "--open", "--tolerance", "0.1", "--out", "new.json"], capture_output=True, encoding="utf-8")
assert done.returncode == 0 and not done.stderr, done
# A tolerance that is not reached: what is said to do does.
with open("comb.csv", "w", encoding="utf-8") as file:
    file.write("0,0\n10,0\n10,2\n2,2\n2,4\n10,4\n10,6\n2,6\n2,8\n10,8\n10,10\n0,10\n")
fit = lambda *options: subprocess.run([NARC, "fit", "comb.csv", "--polygon", "--starts", "1", *options, "--out", "new.json"], capture_output=True, encoding="utf-8")
done = fit("--parts", "2", "--tolerance", "0.5")
said = re.fullmatch("narc: comb.csv: the tolerance 0.5 is not reached with 2 parts, --parts (.*) may do, or --tolerance (.*)\n", done.stderr)
assert done.returncode == 2 and said and fit("--parts", said[1], "--tolerance", "0.5").returncode == 0, done
assert fit("--parts", "2", "--tolerance", said[2]).returncode == 0, said[2]
# Without parts: arcs are too flat, and what is said to do does.
hull = lambda *options: subprocess.run([NARC, "fit", "comb.csv", "--starts", "1", *options, "--out", "new.json"], capture_output=True, encoding="utf-8")
done = hull("--tolerance", "0.01", "--no-edges")
said = re.fullmatch("narc: comb.csv: up to 32 arcs come .* not within the tolerance 0.01: --edges may do, --tolerance (.*) does\n", done.stderr)
assert done.returncode == 2 and said and hull("--tolerance", said[1], "--no-edges").returncode == 0, done
assert hull("--tolerance", "0.01", "--edges").returncode == 0

os.chdir("/")
shutil.rmtree(folder)
print("all checks passed")
