# SPDX-License-Identifier: MIT
"""reports.py NARC - reports as JSON, and an output for each shape or body."""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

NARC = os.path.abspath(sys.argv[1])
os.chdir(folder := tempfile.mkdtemp())
os.mkdir("out")
os.mkdir("in")
for name, text in {
        "el.csv": "0,0\n4,0\n4,1\n1,1\n1,3\n0,3\n", "in.csv": "1,2\nx,3\n",
        "disc.csv": "\n".join(f"{5 + math.cos(k / 50)},{math.sin(k / 50)}" for k in range(315)), "odd.zzz": "?"}.items():
    with open(name, "w", encoding="utf-8") as file:
        file.write(text)


def narc(code, *arguments):
    done = subprocess.run([NARC, *arguments], capture_output=True, encoding="utf-8")
    assert done.returncode == code, (arguments, done)
    return done


def shapes(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)["shapes"]


fit = ["fit", "el.csv", "in.csv", "disc.csv", "odd.zzz", "in", "--keep-going", "--report", "json"]
inputs = json.loads(narc(1, *fit, "--tolerance", "0.1", "--out", "out/{name}.json").stdout)["inputs"]
assert [at["file"] for at in inputs] == ["el.csv", "in.csv", "disc.csv", "odd.zzz", "in"]
assert [len(at["errors"]) for at in inputs] == [0, 1, 0, 1, 1] and not any(at["warnings"] for at in inputs)
(wrong,), (empty,) = inputs[1]["errors"], inputs[4]["errors"]
assert wrong["line"] == 2 and "is not a number" in wrong["text"] and "a folder without" in empty["text"] and "line" not in empty
(el,), none, (disc,), _, _ = (at["shapes"] for at in inputs)
assert none == [] and sorted(os.listdir("out")) == ["disc.json", "el.json"]
assert (disc["kind"], disc["arcs"], disc["way"], disc["out"]) == ("circle", 1, "geometry", "out/disc.json")
(circle,) = shapes("out/disc.json")
assert abs(disc["area"] - math.pi * circle["circle"] ** 2) < 1e-6 and 0 <= disc["distance"] <= 0.1 and circle["name"] == "disc"
assert el["kind"] == "arcs" and el["hull_area"] == 9 and el["area"] >= 9 and len(shapes("out/el.json")[0]["arcs"]) == el["arcs"]

# Parts and chains; the shapes on standard output leave standard error to the report.
done = narc(0, "fit", "el.csv", "--parts", "2", "--report=json", "--out", "out/{name}.json")
(el,) = json.loads(done.stdout)["inputs"][0]["shapes"]
assert (el["kind"], el["parts"], el["area"], el["outline_area"], el["distance"]) == ("parts", 2, 6, 6, 0), el
assert [shape["name"] for shape in shapes("out/el.json")] == ["el/1", "el/2"]
done = narc(0, "fit", "el.csv", "--chain", "--tolerance", "0.01", "--report", "json")
(el,) = json.loads(done.stderr)["inputs"][0]["shapes"]
assert (el["kind"], el["arcs"], el["edges"], el["out"]) == ("chain", 0, 6, "-") and "chain" in json.loads(done.stdout)["shapes"][0]
done = narc(2, "fit", "in.csv", "--keep-going", "--arcs", "3", "--report", "json", "--out", "new.json")
assert json.loads(done.stdout)["inputs"][0]["errors"] and done.stderr.endswith("no outline is left to fit\n")

with open("thin.tmj", "w", encoding="utf-8") as file:
    json.dump({"type": "map", "layers": [{"name": "a", "objects": [{"width": 1, "height": 1}, {"width": 0, "height": 1}]}]}, file)
done = narc(2, "fit", "thin.tmj", "in.csv", "--arcs", "3", "--report", "json") # a report that does not come leaves the lines
assert done.stderr.startswith("narc: thin.tmj: 'a': 1 objects without") and done.stderr.splitlines()[1].startswith("in.csv:2: "), done
done = narc(0, "fit", "el.csv", "thin.tmj", "el.csv", "thin.tmj", "--arcs", "3", "--report", "json", "--out", "new.json") # told once
assert [(len(at["shapes"]), len(at["warnings"])) for at in json.loads(done.stdout)["inputs"]] == [(1, 0), (1, 1)] * 2, done
os.remove("new.json")

# Each body a scene; a pattern without a folder, and two bodies in one file, are told before anything is made.
narc(0, "fit", "el.csv", "disc.csv", "--parts", "2", "--tolerance", "0.2", "--out", "all.json")
done = narc(0, "export", "all.json", "--to", "godot3", "--out", "out/{name}.tscn", "--tolerance", "0.1", "--report", "json")
(told,) = json.loads(done.stdout)["inputs"]
assert [(body["name"], body["out"]) for body in told["bodies"]] == [("el", "out/el.tscn"), ("disc", "out/disc.tscn")], told
for name, pieces in ("el", told["bodies"][0]["pieces"]), ("disc", 1):
    with open(f"out/{name}.tscn", encoding="utf-8") as file:
        assert file.read().count('type="CollisionShape2D"') == pieces
done = narc(0, "export", "all.json", "--to", "godot3", "--tolerance", "0.1", "--dry-run", "--report", "json")
assert [body.keys() for body in json.loads(done.stdout)["inputs"][0]["bodies"]] == [{"name", "pieces", "corners"}] * 2
kept = sorted(os.listdir("out"))
assert "absent/el.json: No such file" in narc(2, "fit", "el.csv", "--arcs", "3", "--out", "absent/{name}.json").stderr
with open("twins.json", "w", encoding="utf-8") as file:
    json.dump({"shapes": [{"name": "a:b", "circle": 1}, {"name": "a?b", "circle": 1}]}, file)
assert "two outputs are the same file" in narc(2, "export", "twins.json", "--to", "svg", "--out", "out/{name}.svg").stderr
assert "--report must be json" in narc(2, "export", "all.json", "--to", "svg", "--report", "xml").stderr
assert sorted(os.listdir("out")) == kept and not os.path.exists("new.json")

# Names that are no files, each {name}, and parts: a/01 is none.
names = [".", "..", "-", "a/1", "a/01", "a/2"]
with open("odd.json", "w", encoding="utf-8") as file:
    json.dump({"shapes": [{"name": name, "circle": 1} for name in names]}, file)
os.chdir("out")
for pattern in "deep/{name}/{name}.svg", "{name}":
    safe = ["_", "__", "-", "a", "a_01"] if "/" in pattern else ["_", "__", "./-", "a", "a_01"]
    for name in safe:
        os.makedirs(f"deep/{name}", exist_ok=True)
    done = narc(0, "export", "../odd.json", "--to", "svg", "--out", pattern, "--report", "json")
    bodies = json.loads(done.stdout)["inputs"][0]["bodies"]
    assert [body["out"] for body in bodies] == [pattern.replace("{name}", name) for name in safe], bodies
    assert [body["pieces"] for body in bodies] == [1, 1, 1, 2, 1] and all(os.path.isfile(body["out"]) for body in bodies)
os.chdir("..")
assert "--picture is one file" in narc(2, "fit", "el.csv", "--arcs", "3", "--out", "new.json", "--picture", "{name}.png").stderr

# What cannot be replaced is told before anything is fitted; a signal leaves all files or none.
if os.sep == "/":
    with open("out/el.json", "a", encoding="utf-8"):
        os.chmod("out/el.json", 0o444)
    assert "out/el.json: Permission denied" in narc(2, "fit", "disc.csv", "el.csv", "--arcs", "8", "--starts", "560", "--out", "out/{name}.json").stderr
    assert "narc-" not in "".join(os.listdir("out"))
    with open("many.json", "w", encoding="utf-8") as file:
        json.dump({"shapes": [{"name": f"s{k}", "circle": 1} for k in range(1000)]}, file)
    os.mkdir("many")
    running = subprocess.Popen([NARC, "export", "many.json", "--to", "svg", "--out", "many/{name}.svg"], stdout=subprocess.DEVNULL)
    while running.poll() is None and not os.path.exists("many/s0.svg"):
        pass
    running.terminate()
    running.wait()
    assert len(os.listdir("many")) == 1000, (running.returncode, len(os.listdir("many")))

# What is no UTF-8 is U+FFFD; a report on standard error stands alone there.
if os.sep == "/":
    done = narc(0, "export", "odd.json", "--to", "svg", "--out", b"\xff\xc3\xa4.svg", "--report", "json")
    assert json.loads(done.stdout)["inputs"][0]["bodies"][0]["out"] == "\ufffd\u00e4.svg"
for code, files in (1, ["el.csv", "in.csv"]), (2, ["in.csv"]):
    done = narc(code, "fit", *files, "--arcs", "3", "--keep-going", "--report", "json")
    assert json.loads(done.stderr)["inputs"][-1]["errors"], done

os.chdir("/")
shutil.rmtree(folder)
print("all checks passed")
