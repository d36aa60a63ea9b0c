#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Do the tests notice when the library is wrong? Changes one operator, constant or statement of soa/, kernels/ or
dispatch/ at a time, at random, in a copy of the tree in build/mutants with the plain C kernels alone, and runs its
tests until one fails.

usage: python3 tests/mutants.py SEED COUNT [PATTERN]     PATTERN: of the files to change, as 'soa/store.c'

A mutant counts if it compiles to another library than the original. Each gets a line, and the last line is the sum.
With NARC_TEST_TRIALS=0.1 survivors take a tenth of the time, and some of them are none."""
import glob, hashlib, json, os, random, re, shutil, subprocess, sys, time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TREE, BUILD = ROOT + "/build/mutants/tree", ROOT + "/build/mutants/build"
CONFIGURE = ["cmake", "-S", TREE, "-B", BUILD, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_FLAGS_RELEASE=-O1 -DNDEBUG",
             "-DCMAKE_LINK_DEPENDS_NO_SHARED=ON", "-DNARC_OPENMP=OFF", "-DNARC_SLEEF=OFF", "-DNARC_BUILD_FILES=OFF",
             "-DNARC_BUILD_FIT=OFF", "-DNARC_BUILD_TOOLS=OFF"]
CONFIGURE += ["-DNARC_COMPILES_%s=OFF" % isa for isa in ("avx512", "avx2", "sse41", "neon", "wasm128")]
TESTS = "^(shapes|api|.*isa-scalar)$"  # labels
SKIPPED = "slow"

# What stands for what. In C, both sides of an operator have a space.
SWAPS = [("<", "<="), (">", ">="), ("==", "!="), ("&&", "||"), ("+", "-"), ("*", "/"), ("&", "|"), ("<<", ">>"),
         ("+=", "-="), ("&=", "|=")]
SWAPS = [(" %s " % a, " %s " % b) for a, b in SWAPS]
SWAPS += [("v_add(", "v_sub("), ("v_mul(", "v_div("), ("v_min(", "v_max("), ("v_lt(", "v_le("), ("vm_and(", "vm_or("),
          ("vi_add(", "vi_sub("), ("vi_shift_left(", "vi_shift_right("), ("true", "false"), ("fmin(", "fmax("),
          ("fminf(", "fmaxf(")]
CHANGES = dict(SWAPS + [(b, a) for a, b in SWAPS])
CHANGES.update({"vm_and_not(": "vm_and(", "vm_not(": "(", "v_neg(": "(", "v_abs(": "(", "++": "--", "break;": ";",
                "continue;": ";"})
KEYS = [("" if key[0] in " +" else r"\b") + re.escape(key) for key in sorted(CHANGES, key=len, reverse=True)]
OPERATOR = re.compile("|".join(KEYS) + r"|!(?=[a-z])|(?<![\w.])\d+\.?\d*f?(?![\w.])")
STATEMENT = re.compile(r"^ +(?!return|if|for|while|else|do|assert|case|const|static)"
                       r"(\*?[\w.>\[\]-]+ [-+*/|&^]?= [^;]*;|\w+\([^;]*\);)$")


def blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def find_changes(path):
    """Every (path, line number, column, old text, new text) of a file."""
    text = re.sub(r'/\*.*?\*/|//[^\n]*|"(\\.|[^"\n])*"|^ *#(\\\n|[^\n])*|_Static_assert[^;]*;', blank,
                  open(path).read(), flags=re.S | re.M)
    before = ";"
    for number, line in enumerate(text.split("\n")):
        for match in OPERATOR.finditer(line):
            old = match.group()
            new = CHANGES.get(old, "" if old == "!" else str(int(old) + 1) if old.isdigit() else "(%s * 2)" % old)
            yield path, number, match.start(), old, new
        if STATEMENT.match(line) and before[-1] in ";{})":
            yield path, number, len(line) - len(line.lstrip()), line.strip(), ";"
        before = line.rstrip() or before


def change(path, number, column, old, new):
    lines = open(path).read().split("\n")
    line = lines[number]
    lines[number] = line[:column] + new + line[column + len(old):]
    with open(path, "w") as file:
        file.write("\n".join(lines))


def run(command, seconds, environment={}):
    """Has it ended with success, or with the code of a skipped test, in time?"""
    with open(BUILD + "/last.txt", "w") as out:
        try:
            return subprocess.run(command, stdout=out, stderr=out, timeout=seconds, env={**os.environ, **environment},
                                  cwd=BUILD).returncode in (0, 77)
        except subprocess.TimeoutExpired:
            return False


def build():
    if not run(["cmake", "--build", BUILD], 600):
        return None
    return hashlib.sha256(open(glob.glob(BUILD + "/libnarc.so.*.*.*")[0], "rb").read()).hexdigest()


def find_tests():
    """The tests, each with what it takes when nothing is wrong."""
    command = ["ctest", "--test-dir", BUILD, "--show-only=json-v1", "-L", TESTS, "-LE", SKIPPED]
    tests = []
    for test in json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)["tests"]:
        variables = {"NARC_TEST_TRIALS": os.environ.get("NARC_TEST_TRIALS", "1")}
        for item in test["properties"]:
            if item["name"] == "ENVIRONMENT":
                variables.update(text.split("=", 1) for text in item["value"])
        begin = time.time()
        if not run(test["command"], 600, variables):
            sys.exit("mutants: %s fails without a mutant: %s/last.txt" % (test["name"], BUILD))
        tests.append({"name": test["name"], "command": test["command"], "environment": variables, "kills": 0,
                      "seconds": time.time() - begin})
    return tests


def kill(tests):
    """The test that fails, the likeliest and quickest ones first; None: none does."""
    for test in sorted(tests, key=lambda test: test["seconds"] / (test["kills"] + 0.5)):
        if not run(test["command"], 10 * test["seconds"] + 10, test["environment"]):
            test["kills"] += 1
            return test["name"]
    return None


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    seed, count, pattern = int(sys.argv[1]), int(sys.argv[2]), (sys.argv[3:] or [""])[0]
    shutil.rmtree(TREE, ignore_errors=True)
    os.makedirs(BUILD, exist_ok=True)
    files = subprocess.run(["git", "ls-files"], cwd=ROOT, stdout=subprocess.PIPE, check=True, text=True).stdout
    for path in files.split():
        os.makedirs(os.path.dirname(TREE + "/" + path), exist_ok=True)
        shutil.copy2(ROOT + "/" + path, TREE + "/" + path)
    subprocess.run(CONFIGURE, check=True, stdout=subprocess.DEVNULL)
    original = build() or sys.exit("mutants: the original does not compile: " + BUILD + "/last.txt")
    tests = find_tests()
    print("%d tests, %.0f seconds without a mutant" % (len(tests), sum(test["seconds"] for test in tests)), flush=True)
    changes = []
    for folder in ("soa", "kernels", "dispatch"):
        for path in sorted(glob.glob(TREE + "/" + folder + "/**/*.*", recursive=True)):
            if pattern in path and not re.search(r"/narc[^/]*$|/simd/(?!scalar)|\.def$", path):
                changes += find_changes(path)
    random.Random(seed).shuffle(changes)
    killed, survived = 0, 0
    for path, number, column, old, new in changes:
        if killed + survived == count:
            break
        kept = open(path).read()
        change(path, number, column, old, new)
        made = build()
        result = "does not compile" if not made else "same program" if made == original else kill(tests)
        killed += result in [test["name"] for test in tests]
        survived += result is None
        print("%-18s %s:%d: '%s' -> '%s'" %
              (result or "SURVIVED", path[len(TREE) + 1:], number + 1, old.strip(), new.strip()), flush=True)
        with open(path, "w") as file:
            file.write(kept)
    print("seed %d: %d mutants of %d possible ones, %d killed, %d survived" %
          (seed, killed + survived, len(changes), killed, survived))


main()
