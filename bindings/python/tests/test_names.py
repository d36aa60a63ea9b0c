# SPDX-License-Identifier: MIT
"""Is everything that the headers declare there from Python, or left out for a reason?"""

import ctypes
import pathlib
import re
import subprocess
import sys
import textwrap

import pytest

import narc

HERE = pathlib.Path(__file__).parent.parent
INCLUDE = HERE.parent.parent / "include"
BEGIN = "# From the table of calls, by tests/test_names.py:\n"

# Python has these itself, or needs them not.
OWN = """create_shapes destroy_shapes create_index destroy_index create_contacts destroy_contacts create_broad_phase
destroy_broad_phase get_layout get_constant find_layout write_layouts view_bodies openmp_workers copy_pairs status_name version
reserve_shapes get_aabb""".split()
# Fits read whole drawings, so a pen, one curve and lists of characters and layers are left out; readers of files have their places here.
OWN += """create_path destroy_path release_contours release_parts release_chains close_font quadratic_to cubic_to arc_to ellipse_to
next_character fit_bezier list_dxf_layers find_named_shape destroy_shape_list""".split()
# A library of its own, which wheels don't hold: other algorithms' answers, for those who compare them in C (docs/methods.md).
METHODS = """create_methods refresh_methods destroy_methods method_name find_overlaps_by find_contacts_by""".split()


def without_comments(text):
    return re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.S)


@pytest.mark.skipif(not INCLUDE.exists(), reason="the headers are not here")
def test_all_functions_are_called():
    declared = set()
    for header in INCLUDE.glob("narc*.h"):
        declared.update(re.findall(r"NARC_API[^;(]*?\bnarc_(\w+)\(", without_comments(header.read_text())))
    sources = without_comments("".join(path.read_text() for path in (HERE / "src").glob("*.*")))
    called = set(re.findall(r"\bnarc_(\w+)(?=\(|\})", sources))  # or named at the end of a table's row
    used = set(re.findall(r"_narc\.(\w+)", "".join(path.read_text() for path in (HERE / "narc").glob("*.py"))))
    assert len(declared) > 110
    left_out = set(OWN) | set(METHODS)
    assert sorted(declared - called - left_out) == [] and sorted(left_out - declared) == []
    table = set(re.findall(r"^CALL\((\w+),", sources, flags=re.M))
    assert sorted(table - used) == []


def make_stubs():
    """What _narc.pyi says of the extension's calls, from their table: python tests/test_names.py writes it."""
    kept = (HERE / "narc" / "_narc.pyi").read_text().split(BEGIN)[0]
    results = {"COUNT": "int", "PAIRS": "bytearray", "SLOTS": "bytearray", "STEP": "tuple[Any, ...]"}
    numbers = {"double": "SupportsFloat", "size": "SupportsIndex", "threads": "SupportsIndex"}
    lines = []
    for name, arguments, result in re.findall(r'^CALL\((\w+), "([^"]*)", (\w+)', (HERE / "src" / "calls.inl").read_text(), re.M):
        given = []
        for word, kind in (argument.split(":") for argument in arguments.split()):
            handle = kind[0].isupper()
            given.append(f"{word}: " + ("Handle" if handle else "ArrayLike | None" if kind[0] == "<" else "NDArray[Any]" if kind[0] == ">"
                                        else numbers.get(kind, "Any")))
        lines.append(f"def {name}({', '.join(given)}, /) -> {results[result]}: ...\n")
    return kept + BEGIN + "".join(lines)


@pytest.mark.skipif(not INCLUDE.exists(), reason="the table of calls is not here")
def test_stubs_are_those_of_the_table():
    assert (HERE / "narc" / "_narc.pyi").read_text() == make_stubs()


def test_functions_of_c_are_not_shown_to_others():
    library = ctypes.CDLL(narc._narc.__file__)
    assert hasattr(library, "PyInit__narc") and not hasattr(library, "narc_version")


def test_the_first_page_runs():
    scope: dict = {}
    for text in ((HERE / "README.md").read_text().split("```python\n")[1].split("```")[0], narc.__doc__.split("\n\n")[1]):
        exec(textwrap.dedent(text), scope)
    assert len(scope["rows"]) > 0 and len(scope["hits"]) == 2


def test_plots_are_there_at_once():
    pytest.importorskip("matplotlib")
    assert narc.plot.draw_bodies and not hasattr(narc, "plots")


def test_what_is_public_has_words():
    for name in narc.__all__:
        thing = getattr(narc, name)
        if callable(thing):
            assert thing.__doc__ and len(thing.__doc__) > 20, name
            for method, value in vars(thing).items() if isinstance(thing, type) else ():
                assert method.startswith("_") or not callable(value) or value.__doc__, f"{name}.{method}"


def test_help_pages_have_all_that_is_public(tmp_path):
    subprocess.run([sys.executable, "-m", "narc", "pages", tmp_path], check=True, capture_output=True)
    text = (tmp_path / "narc.md").read_text() + (tmp_path / "rows.md").read_text()
    for name in set(narc.__all__) - {"CONSTANTS", "__version__"}:
        assert f"## narc.{name}\n" in text, name
    assert "### narc.Shapes.box(self, width: float, height: float, radius: float = 0.0) -> int" in text
    assert "| `normal` | float32 x 2 | 12 |" in text and "NARC_MAX_ARCS" in (tmp_path / "constants.md").read_text()
    assert subprocess.run([sys.executable, "-m", "narc", "page"], capture_output=True).returncode == 2


if __name__ == "__main__":
    (HERE / "narc" / "_narc.pyi").write_text(make_stubs())
