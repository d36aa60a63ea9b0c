# SPDX-License-Identifier: MIT
"""An input of apps/dem as LAMMPS has it. write_start() leaves start.data, the grains as apps/dem places them, and
start.in, which the inputs of apps/lammps/cases include: grains, laws, time step, output, and variables for walls
(law_NAME, NAME_x, NAME_width, the last NAME_vx ...) and stages (steps_NAME)."""
import json
import math
import os
import subprocess

COLUMNS = "id x y vx vy omegaz radius mass iy c_picture[1]"


def place_grains(program, folder, world, read_table):
    """A row for each grain, as apps/dem has it at the start."""
    still = {**world, "stages": [{"duration": world["time_step"]}]}
    still["output"] = {"every": world["time_step"], "grains": "start.csv"}
    with open(os.path.join(folder, "start.json"), "w", encoding="utf-8") as file:
        json.dump(still, file)
    subprocess.run([program, "start.json", "--threads", "1"], cwd=folder, stdout=subprocess.DEVNULL, check=True,
                   stderr=subprocess.DEVNULL)
    return read_table(os.path.join(folder, "start-000000.csv"))


def write_data(folder, world, table, kinds, box):
    """A type is a material and a shape. The diameter is 1; the charge, which means nothing, brings the scale."""
    with open(os.path.join(folder, "start.data"), "w", encoding="utf-8") as file:
        file.write("grains\n\n%d atoms\n%d atom types\n%.17g %.17g xlo xhi\n%.17g %.17g ylo yhi\n-0.5 0.5 zlo zhi\n"
                   % ((len(kinds), len(set(kinds))) + box))
        if "shear" in world.get("boundary", {}):
            file.write("0 0 0 xy xz yz\n")
        names = sorted(set(kinds))
        rows = list(zip(*(table[key] for key in ("x", "y", "angle", "scale", "vx", "vy", "spin"))))
        file.write("\nAtoms # hybrid\n\n")
        for i, (x, y, angle, scale, _, _, _) in enumerate(rows):
            file.write("%d %d %.17g %.17g 0 1 1 %.17g %.17g %.17g 0\n"
                       % (i + 1, 1 + names.index(kinds[i]), x, y, scale, math.cos(angle), math.sin(angle)))
        file.write("\nVelocities\n\n")
        for i, row in enumerate(rows):
            file.write("%d %.17g %.17g 0 0 0 %.17g\n" % ((i + 1,) + row[4:]))
    return names


def find_box(world, table):
    """The periodic cell, else what is around all grains."""
    box, room = (), 2 * max(table["size"])
    for key in "xy":
        box += tuple(world.get("boundary", {}).get(key, (min(table[key]) - room, max(table[key]) + room)))
    return box


def make_law(world, materials):
    """The numbers of a law, of two materials."""
    law = dict(world["contact"])
    for pair in law.pop("pairs", []):
        if sorted(pair["materials"]) == sorted(materials):
            law.update(pair)
    if law["law"] == "hertz":  # of equal materials whose Poisson ratio is 0
        across = world["materials"][0]["young"]
        stiff = 4 / 3 * across / 2
    else:
        stiff, across = law["kn"], law.get("kt", 2 / 7 * law["kn"])
    text = "%.17g %.17g 0 %.17g %.17g 1 restitution %.17g" % (stiff, across, law.get("tangential_damping", 0.5),
                                                            law["friction"], law["restitution"])
    return law["law"].replace("linear", "hooke") + "/history", text


def write_start(program, folder, case, world, read_table):
    table = place_grains(program, folder, world, read_table)
    listed = [grain["material"] for entry in world["grains"] for grain in entry.get("grains", [entry])]
    materials = listed if len(listed) == len(table["x"]) else listed * len(table["x"])
    kinds = list(zip(materials, table["shape"]))
    box = find_box(world, table)
    names = write_data(folder, world, table, kinds, box)
    density = {one["name"]: one["density"] * world.get("thickness", 1) for one in world["materials"]}
    periodic = world.get("boundary", {})
    lines = ["# Written by apps/dem/cases/cases.py.", "units lj", "dimension 2",
             "boundary %s %s p" % tuple("p" if key in periodic else "m" for key in "xy"),
             "atom_style hybrid sphere dipole", "atom_modify map array", "newton off", "comm_modify vel yes",
             "read_data start.data", "fix shapes all narc/shapes shapes.json %s density %.17g mesh form"
             % (" ".join(name[1] for name in names), density[names[0][0]])]
    lines += ["compute picture all narc/atom", "compute reach all reduce max c_picture[5]",
              "thermo_style custom step c_reach", "run 0", "variable size atom q/c_picture[5]",
              "set group all diameter v_size", "neighbor %.17g bin" % world["skin"],
              "neigh_modify delay 0 every 1 check yes", "timestep %.17g" % world["time_step"], "fix nve all narc/nve"]
    if any(world["gravity"]):
        lines.append("fix gravity all gravity %.17g vector %.17g %.17g 0"
                     % (math.hypot(*world["gravity"]), *world["gravity"]))
    for i, (one, _) in enumerate(names):
        for j, (other, _) in enumerate(names[i:], i):
            style, numbers = make_law(world, [one, other])
            if i == j == 0:
                lines.append("pair_style narc/%s %s" % (style, numbers))
            lines.append("pair_coeff %d %d %s" % (i + 1, j + 1, numbers))
    for wall in world.get("walls", []):
        laws = ['"%s"' % " ".join(make_law(world, [name[0], wall["material"]])) for name in names]
        one_law = len(set(laws)) == 1
        lines.append("variable law_%s index %s" % (wall["name"], " ".join(laws[:1] if one_law else laws)))
        later = [stage.get("walls", {}).get(wall["name"], {}) for stage in world["stages"]]
        numbers = dict(zip("xy", wall["plate"]["point"] if "plate" in wall else wall["at"]))
        numbers.update(wall.get("box", {}))
        for one in [wall] + later:
            numbers.update({key: one["servo"][key] for key in ("gain", "max_speed") if one.get("servo")})
            numbers.update(zip(("vx", "vy"), one.get("velocity", [])))
        lines += ["variable %s_%s equal %.17g" % (wall["name"], key, value) for key, value in numbers.items()]
    step = world["time_step"]
    lines += ["variable steps_%s equal %d" % (stage["name"], round(stage["duration"] / step))
              for stage in world["stages"]]
    lines += ["variable every equal %d" % round(world["output"]["every"] / step), "compute contacts all narc/contact",
              "dump grains all custom ${every} %s-*.dump %s" % (case, COLUMNS),
              "dump_modify grains sort id pad 12 format float %.12g",
              "dump contacts all local ${every} %s-contacts-*.dump index %s"
              % (case, " ".join("c_contacts[%d]" % (k + 1) for k in range(9))), "dump_modify contacts pad 12",
              "thermo ${every}", ""]
    with open(os.path.join(folder, "start.in"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines))
