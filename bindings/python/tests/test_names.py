# SPDX-License-Identifier: MIT
"""Is everything that the headers declare there from Python, or left out for a reason?"""

import pathlib
import re

import pytest

import narc

HERE = pathlib.Path(__file__).parent.parent
INCLUDE = HERE.parent.parent / "include"

# Python has these itself, or needs them not.
OWN = """create_shapes destroy_shapes create_index destroy_index create_contacts destroy_contacts create_broad_phase
destroy_broad_phase get_layout get_constant find_layout write_layouts view_bodies openmp_workers copy_pairs status_name version
get_isa set_isa reserve_shapes get_aabb compute_aabb""".split()
# Not there yet.
MISSING = """validate_arcs isa_name isa_supported kernel_name cpu_feature weld_polygon build_four_arc find_radius_range
adjust_polygon find_support compute_distance contains_point add_shape_at find_contact find_manifold refine_contacts
find_body_slots compute_inscribed_circle compute_poses""".split()
LIBRARIES = ["narc_files.h", "narc_fit.h", "narc_methods.h"]


@pytest.mark.skipif(not INCLUDE.exists(), reason="the headers are not here")
def test_all_functions_are_called():
    declared = set()
    for header in INCLUDE.glob("narc*.h"):
        if header.name not in LIBRARIES:
            text = re.sub(r"/\*.*?\*/", "", header.read_text(), flags=re.S)
            declared.update(re.findall(r"NARC_API[^;(]*?\bnarc_(\w+)\(", text))
    sources = "".join(path.read_text() for path in (HERE / "src").glob("*.*"))
    called = set(re.findall(r"\bnarc_(\w+)\(", sources))
    used = set(re.findall(r"_narc\.(\w+)", "".join(path.read_text() for path in (HERE / "narc").glob("*.py"))))
    assert len(declared) > 90
    assert sorted(declared - called - set(OWN)) == sorted(set(MISSING) - called)
    table = set(re.findall(r"^CALL\((\w+),", sources, flags=re.M))
    assert sorted(table - used) == sorted(set(MISSING) & table)


def test_what_is_public_has_words():
    for name in narc.__all__:
        thing = getattr(narc, name)
        if callable(thing):
            assert thing.__doc__ and len(thing.__doc__) > 20, name
            for method, value in vars(thing).items() if isinstance(thing, type) else ():
                assert method.startswith("_") or not callable(value) or value.__doc__, f"{name}.{method}"
