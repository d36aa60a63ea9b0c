#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Do the tests notice when the library is wrong? Changes one operator, constant or statement of soa/, kernels/ or
dispatch/ at a time, at random, in copies of the tree in build/mutants with the plain C kernels alone, and runs those of
its tests that run this line, until one fails: first with a tenth of the trials, then with all.

usage: python3 tests/mutants.py SEED COUNT [PATTERN]     PATTERN: of the files to change, as 'soa/store.c'

A mutant counts if it compiles to other libraries than the original. Each gets a line, and the last line is the sum. One
that has a line in build/mutants/<seed>-<hash of the sources>.txt is not tried again: a run goes on where it was
interrupted, and tries survivors again when their lines are deleted. NARC_TEST_TRIALS=0.1: with a tenth alone."""
import collections, filecmp, glob, hashlib, json, os, random, re, resource, shutil, subprocess, sys, threading

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FOLDER = ROOT + "/build/mutants"
OPTIONS = ["-GNinja", "--no-warn-unused-cli", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_FLAGS_RELEASE=-O1 -DNDEBUG",
           "-DCMAKE_LINK_DEPENDS_NO_SHARED=ON", "-DNARC_SLEEF=OFF", "-DNARC_BUILD_FILES=OFF", "-DNARC_BUILD_FIT=OFF",
           "-DNARC_BUILD_TOOLS=OFF", "-DNARC_INSTALL=OFF"]
ISAS = re.findall(r"^NARC_ISA\((\w+)", open(ROOT + "/kernels/isa.def").read(), re.M)
OPTIONS += ["-DNARC_COMPILES_%s=OFF" % isa for isa in ISAS if isa != "scalar"]
TESTS = "^(shapes|api|.*isa-scalar)$"  # labels
SKIPPED = "slow"
TRIALS = os.environ.get("NARC_TEST_TRIALS", "0.1 1").split()

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


def find_changes(path, text):
    """Every (path, line number, column, old text, new text) of a file."""
    text = re.sub(r'/\*.*?\*/|//[^\n]*|"(\\.|[^"\n])*"|^ *#(\\\n|[^\n])*|_Static_assert[^;]*;', blank, text,
                  flags=re.S | re.M)
    before = ";"
    for number, line in enumerate(text.split("\n")):
        for match in OPERATOR.finditer(line):
            old = match.group()
            new = CHANGES.get(old, "" if old == "!" else str(int(old) + 1) if old.isdigit() else "(%s * 2)" % old)
            yield path, number, match.start(), old, new
        if STATEMENT.match(line) and before[-1] in ";{})":
            yield path, number, len(line) - len(line.lstrip()), line.strip(), ";"
        before = line.rstrip() or before


def write(path, text):
    with open(path, "w") as file:
        file.write(text)


class Copy:
    """A copy of the tree with its build: each tries a mutant at a time."""

    def __init__(self, folder, options=()):
        self.tree, self.build = folder + "/tree", folder + "/build"
        names = subprocess.run(["git", "ls-files"], cwd=ROOT, stdout=subprocess.PIPE, check=True, text=True).stdout
        self.hash = hashlib.sha256(b"".join(open(ROOT + "/" + name, "rb").read() for name in names.split())).hexdigest()
        for name in names.split():
            path = self.tree + "/" + name
            os.makedirs(os.path.dirname(path), exist_ok=True)
            if not os.path.exists(path) or not filecmp.cmp(ROOT + "/" + name, path, shallow=False):
                shutil.copyfile(ROOT + "/" + name, path)  # what differs is built again
        command = ["cmake", "-S", self.tree, "-B", self.build] + OPTIONS + list(options)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        if self.run_ninja([]):
            sys.exit("mutants: the original does not compile in " + self.build)
        command = ["ctest", "--test-dir", self.build, "--show-only=json-v1", "-L", TESTS, "-LE", SKIPPED]
        listed = subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout
        self.tests = {}
        for test in json.loads(listed)["tests"]:
            if test["command"][0].startswith(self.build):
                variables = [item["value"] for item in test["properties"] if item["name"] == "ENVIRONMENT"]
                self.tests[test["name"]] = test["command"], dict(text.split("=", 1) for text in sum(variables, []))
        self.original = self.make()

    def run_ninja(self, targets):
        return subprocess.run(["ninja", "-C", self.build, "-j1"] + targets, stdout=subprocess.DEVNULL).returncode

    def make(self):
        """A hash of the libraries; None if they or the tests do not compile."""
        if self.run_ninja(sorted({os.path.relpath(command[0], self.build) for command, _ in self.tests.values()})):
            return None
        paths = [self.build + "/libnarc.so"] + glob.glob(self.build + "/**/libnarc_methods.so", recursive=True)
        return hashlib.sha256(b"".join(open(path, "rb").read() for path in paths)).hexdigest()

    def passes(self, name, trials, seconds):
        """Does a test end with success, or as skipped, in this time of the processor?"""
        command, environment = self.tests[name]
        environment = {**os.environ, **environment, "NARC_TEST_TRIALS": trials}
        command = ["sh", "-c", 'ulimit -t %d && exec "$@"' % seconds, "sh"] + command
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=environment,
                                   cwd=self.build)
        timer = threading.Timer(600, process.kill)
        timer.start()
        failed = False
        for line in process.stderr:
            if b"[  FAILED  ]" in line:
                failed = True
                process.kill()
        timer.cancel()
        return process.wait() in (0, 77) and not failed

    def attempt(self, mutant, text, tests, kills):
        """The test that kills a mutant, the likeliest and quickest ones first, or another fate."""
        path, number, column, old, new = mutant
        lines = text.split("\n")
        lines[number] = lines[number][:column] + new + lines[number][column + len(old):]
        write(self.tree + "/" + path, "\n".join(lines))
        try:
            made = self.make()
            if not made or made == self.original:
                return "same program" if made else "does not compile"
            for trials in TRIALS:
                chances = {name: kills[name, path] + 0.1 * kills[name] + 0.05 for name in tests}
                for name in sorted(tests, key=lambda name: tests[name] / chances[name]):
                    if not self.passes(name, trials, (10 * tests[name] + 2) * float(trials) / float(TRIALS[0])):
                        kills[name, path] += 1
                        kills[name] += 1
                        return name
            return "SURVIVED"
        finally:
            write(self.tree + "/" + path, text)


class Lines:
    """Which tests run a line, and what they take with a tenth of the trials; they must pass without a mutant."""

    def __init__(self):
        copy = Copy(FOLDER + "/lines", ["-DCMAKE_C_FLAGS=--coverage"])
        path = "%s/lines-%s.json" % (FOLDER, copy.hash[:8])
        if not os.path.exists(path):
            self.seconds, self.tests = {}, {}  # by name; by path:line, and by path for lines that are no code
            for name in copy.tests:
                self.measure(copy, name)
            write(path, json.dumps([self.seconds, {key: sorted(self.tests[key]) for key in self.tests}]))
        self.seconds, self.tests = json.load(open(path))
        print("%d tests, %.0f seconds without a mutant" % (len(self.seconds), sum(self.seconds.values())), flush=True)

    def measure(self, copy, name):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        if not copy.passes(name, TRIALS[0], 600):
            sys.exit("mutants: %s fails without a mutant in %s" % (name, copy.build))
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.seconds[name] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        counts = glob.glob(copy.build + "/**/*.gcda", recursive=True)
        command = ["gcov", "--json-format", "--stdout"] + counts
        for text in subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout.splitlines():
            unit = json.loads(text)
            for file in unit["files"]:
                path = os.path.relpath(os.path.join(unit["current_working_directory"], file["file"]), copy.tree)
                for line in file["lines"]:
                    tests = self.tests.setdefault("%s:%d" % (path, line["line_number"]), set())
                    if line["count"]:
                        tests.add(name)
                        self.tests.setdefault(path, set()).add(name)
        for path in counts:
            os.remove(path)

    def find_tests(self, path, number):
        names = self.tests.get("%s:%d" % (path, number), self.tests.get(path, self.seconds))
        return {name: self.seconds[name] for name in names}


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    seed, count, pattern = int(sys.argv[1]), int(sys.argv[2]), (sys.argv[3:] or [""])[0]
    texts = {}
    for folder in ("soa", "kernels", "dispatch"):
        for path in sorted(glob.glob(folder + "/**/*.*", root_dir=ROOT, recursive=True)):
            if not re.search(r"/narc[^/]*$|/simd/(?!scalar)|\.def$", path):
                texts[path] = open(ROOT + "/" + path).read()
    mutants = [mutant for path in texts if pattern in path for mutant in find_changes(path, texts[path])]
    random.Random(seed).shuffle(mutants)
    copies = [Copy("%s/%d" % (FOLDER, number)) for number in range(os.cpu_count())]
    code = Lines()
    log = open("%s/%d-%s.txt" % (FOLDER, seed, hashlib.sha256(repr(texts).encode()).hexdigest()[:8]), "a+")
    log.seek(0)
    known = dict(reversed(line.rstrip("\n").split("\t")) for line in log)
    fates, kills, left, lock = collections.Counter(), collections.Counter(), iter(mutants), threading.Lock()

    def work(copy):
        while True:
            with lock:
                mutant = next(left, None)
                if not mutant or fates["killed"] + fates["SURVIVED"] >= count:
                    return
            path, number, column, old, new = mutant
            line = "%s:%d:%d: '%s' -> '%s'" % (path, number + 1, column + 1, old.strip(), new.strip())
            fate = known.get(line) or copy.attempt(mutant, texts[path], code.find_tests(path, number + 1), kills)
            with lock:
                fates["killed" if fate in copy.tests else fate] += 1
                if line not in known:
                    print(fate, line, sep="\t", file=log, flush=True)
                    print("%-18s %s" % (fate, line), flush=True)

    threads = [threading.Thread(target=work, args=(copy,)) for copy in copies]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    print("seed %d: %d mutants of %d possible ones, %d killed, %d survived" %
          (seed, fates["killed"] + fates["SURVIVED"], len(mutants), fates["killed"], fates["SURVIVED"]))


main()
