# SPDX-License-Identifier: MIT
"""narc.hpp has all of the core's interface: each function of the headers in C is called there, and each member of a structure
that has setters is set, but for those below, each with its reason.

    python3 cpp_names.py INCLUDE
"""
import pathlib
import re
import sys

HEADERS = ["narc.h", "narc_broad_phase.h", "narc_chains.h", "narc_contacts.h", "narc_pairs.h", "narc_scene.h",
           "narc_shapes.h", "narc_workers.h"]  # narc_layouts.h is for other languages; the rest are libraries of their own
FUNCTIONS = {}
MEMBERS = {
    "narc_step.bodies": "an argument of update()",
    "narc_query.row_stride": "set from the rows that are given",
}

include = pathlib.Path(sys.argv[1])
face = re.sub(r"//.*", "", (include / "narc.hpp").read_text())
text = re.sub(r"/\*.*?\*/", " ", "".join((include / h).read_text() for h in HEADERS), flags=re.S)
functions = [name for name in re.findall(r"NARC_API\s+[^;{]*?(\w+)\((?:[^()]|\([^()]*\))*\);", text)]
faults = [f"{name}() is not in narc.hpp" for name in functions
          if not re.search(rf"\b{name}\b", face) and name not in FUNCTIONS]
faults += [f"{name}() is there, or gone: its reason has no meaning" for name in FUNCTIONS
           if name not in functions or re.search(rf"\b{name}\b", face)]

bodies = dict(re.findall(r"struct (narc_\w+)\s*\{(.*?)\}", text, flags=re.S))
members = set()
for name in re.findall(r"detail::options<\w+, (narc_\w+)>", face):
    for declaration in bodies[name].split(";"):
        names = re.findall(r"(\w+)\s*(?=,|$|\[)", declaration.strip())
        members |= {f"{name}.{n}" for n in names if n not in ("reserved", "workers")}
        faults += [f"{name}.{n} has no setter" for n in names if n not in ("reserved", "workers") and f"{name}.{n}" not in MEMBERS
                   and not re.search(rf"\b{name}::{n}\b", face)]
faults += [f"{name} is set, or gone: its reason has no meaning" for name in MEMBERS
           if name not in members or re.search(rf"\b{name.replace('.', '::')}\b", face)]

for fault in faults:
    print(fault)
print(f"{len(functions)} functions, {len(members)} members, {len(faults)} faults")
sys.exit(bool(faults) or len(functions) < 80 or len(members) < 40)
