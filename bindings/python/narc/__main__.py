# SPDX-License-Identifier: MIT
"""python -m narc: version, instruction set, layouts."""

from . import _narc, _tables, __version__, get_isa

print("version        ", __version__)
print("instruction set", get_isa(), "of", " ".join(_narc.names()["isa"]))
print("processor      ", " ".join(_narc.names()["cpu"]))
print("kernels        ", " ".join(_narc.names()["kernel"]))
for name in ("narc_body", "narc_contact", "narc_manifold", "narc_ray_hit", "narc_distance", "narc_impact"):
    print(f"{name:<15}", ", ".join(f"{field} {kind[0]} at {kind[1]}" for field, kind in (_tables.row_type(name).fields or {}).items()))
