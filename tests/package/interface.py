# SPDX-License-Identifier: MIT
"""What other languages count on: no public function takes or returns a structure by value, and the table of layouts
(narc_layouts.h) has all that the headers declare. Headers are read here by another way than cmake/layouts.cmake reads them.

    python3 interface.py HEADERS PROGRAM    PROGRAM prints the table as JSON when it is called with "json"
"""
import json
import pathlib
import re
import subprocess
import sys

text = "".join(p.read_text() for p in sorted(pathlib.Path(sys.argv[1]).glob("*.h")))
text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
table = json.loads(subprocess.run([sys.argv[2], "json"], check=True, capture_output=True, text=True).stdout)
layouts, constants = table["layouts"], table["constants"]
faults = []


def expect(right, message):
    if not right:
        faults.append(message)


# ---------------------------------------------------------------------------- functions
structures = set(re.findall(r"\bstruct (narc_\w+)", text))
functions = re.findall(r"NARC_API\s+([^;{]*?)(\w+)\(((?:[^()]|\([^()]*\))*)\);", text)
expect(len(functions) > 100 and len(functions) == text.count("NARC_API ") - text.count("#define NARC_API "),
       f"{len(functions)} functions of {text.count('NARC_API ')}")
for returned, name, parameters in functions:
    for part in [returned + " "] + parameters.split(","):
        words = re.findall(r"\w+|\*", part)
        expect("*" in words or not structures.intersection(words), f"{name}(): a structure by value: {' '.join(words)}")

# ---------------------------------------------------------------------------- structures
SCALARS = {"float": 4, "double": 8, "uint8_t": 1, "uint16_t": 2, "uint32_t": 4, "uint64_t": 8, "bool": 1, "char": 1,
           "unsigned": 4}
pointer = layouts["narc_float_column"]["members"][0]["size"]
declared = {name: body for name, body in re.findall(r"struct (narc_\w+)\s*\{(.*?)\}", text, flags=re.S)}
for name, body in declared.items():
    wanted = []
    for declaration in filter(None, (" ".join(d.split()) for d in body.split(";"))):
        function = re.search(r"\(\*(\w+)\)\(", declaration)
        if function:
            wanted.append((function[1], "function *", False))
            continue
        first, *others = declaration.split(",")
        kind, stars, member = re.fullmatch(r"((?:const )?\w+)((?: ?const\b| ?\*)*) ?(\w+(?:\[.*\])?)", first).groups()
        for stars, member in [(stars, member)] + [re.fullmatch(r"(\**)(.*)", o.strip()).groups() for o in others]:
            wanted.append((member.split("[")[0], (kind + " " + stars.strip()).strip(), "[" in member))
    got = layouts.get(name, {"members": []})["members"]
    expect(wanted == [(m["name"], m["type"], "reserved" in m["name"] or m["count"] > 1) for m in got],
           f"{name}: {wanted}\n  in the table: {got}")
    end = 0
    for m in got:  # each begins behind the last one, where its alignment lets it
        item = m["size"] // m["count"]
        known = pointer if m["type"].endswith("*") else SCALARS.get(m["type"], layouts.get(m["type"], {}).get("size"))
        aligned = layouts[m["type"]]["alignment"] if m["type"] in layouts else item
        expect(known in (item, None) and end <= m["offset"] < end + aligned, f"{name}.{m['name']}: {m}")
        end = m["offset"] + m["size"]
    if got:
        expect(end <= layouts[name]["size"] < end + layouts[name]["alignment"], f"{name} has {layouts[name]['size']} bytes")
enumerations = set(re.findall(r"typedef enum (narc_\w+)", text))
expect(set(layouts) == set(declared) | enumerations and len(declared) > 50, "layouts: " + str(
    set(layouts) ^ (set(declared) | enumerations)))

# ---------------------------------------------------------------------------- constants
values = {}
for body in re.findall(r"\benum(?: narc_\w+)?\s*\{(.*?)\}", text, flags=re.S):
    values.update(re.findall(r"(NARC_\w+)\s*=\s*(\w+)", body))
    expect(body.strip().rstrip(",").count(",") + 1 == body.count("="), f"an enumerator without a value: {body}")
values.update(re.findall(r"^#define (NARC_\w+) +([(\d].*|UINT\w+)$", text, flags=re.M))
for name, value in values.items():
    value = re.sub(r"(0x[0-9a-f]+|(?<![\w.])[\d.]+(?:e-?\d+)?)[fu]?\b", r"\1", value.replace("UINT32_MAX", "0xffffffff"))
    number = float(eval(value, {"__builtins__": {}}))
    expect(abs(constants.get(name, -1) - number) <= 1e-7 * abs(number), f"{name} is {number}, not {constants.get(name)}")
expect(set(constants) == set(values) and len(values) > 50, f"constants: {set(constants) ^ set(values)}")

for fault in faults:
    print(fault)
print(f"{len(functions)} functions, {len(declared)} structures, {len(values)} constants, {len(faults)} faults")
sys.exit(bool(faults))
