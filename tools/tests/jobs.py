# SPDX-License-Identifier: MIT
"""jobs.py NARC SVG - fits at the same time: what they write, print and refuse is that of one after the other; Ctrl-C leaves what is
done."""
import os
import signal
import subprocess
import sys
import tempfile
import time

NARC = os.path.abspath(sys.argv[1])
os.chdir(tempfile.mkdtemp())

names = [f"{k}.csv" for k in range(7)]
for k, name in enumerate(names):
    with open(name, "w", encoding="ascii") as out:
        out.write(f"0,0\n{4 + k},1\n{5 + k},3\n2,{5 - 0.3 * k}\n-1,2\n")


def fit(jobs, out, *options):
    done = subprocess.run([NARC, "fit", *names, *options, "--arcs", "5", "--quick", "--jobs", str(jobs), "--out", out], capture_output=True)
    with open(out, "rb") as written:
        return done.returncode, done.stderr, written.read()


one = fit(1, "one.json")
assert one[0] == 0 and one[2].count(b'"name"') == len(names), one
assert all(fit(jobs, "more.json") == one for jobs in (2, 5, 16))
names[2:2] = ["line.csv", "point.csv"]
open("line.csv", "w").write("0,0\n1,1\n2,2\n")
open("point.csv", "w").write("1,1\n")
some = fit(1, "one.json", "--keep-going")
assert some[0] == 1 and some[1].index(b"line.csv") < some[1].index(b"point.csv") and some[2] == one[2], some
assert fit(3, "more.json", "--keep-going") == some
for jobs in (1, 4):
    refused = subprocess.run([NARC, "fit", *names, "--arcs", "5", "--quick", "--jobs", str(jobs), "--out", "new.json"], capture_output=True)
    assert refused.returncode == 2 and refused.stderr.startswith(b"narc: line.csv: ") and refused.stderr.count(b"\n") == 1, refused
    assert not os.path.exists("new.json")

# The second takes long; the first is done when it has begun for a while.
with open("long.csv", "w", encoding="ascii") as out:
    out.write("".join(f"{x},{x * x % 97}\n" for x in range(100)))
if os.name == "posix":
    def hear():
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # a shell's background ignores it

    before = set(os.listdir("."))
    with subprocess.Popen([NARC, "fit", "0.csv", "long.csv", "--arcs", "12", "--edges", "--starts", "10000", "--jobs", "2", "--out", "some.json"],
                          stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, preexec_fn=hear) as running:
        while set(os.listdir(".")) <= before and running.poll() is None:  # until there is a temporary file, just before the fits
            time.sleep(0.02)
        time.sleep(2)
        running.send_signal(signal.SIGINT)
        told = running.stderr.read()
        assert running.wait() in (1, 2) and b"outlines are not fitted" in told, (running.returncode, told)
        if running.returncode == 1:
            with open("some.json", encoding="utf-8") as written:
                assert '"shape-0"' in written.read()
        assert set(os.listdir(".")) <= before | {"some.json"}
