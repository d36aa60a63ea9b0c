# SPDX-License-Identifier: MIT
"""python -m narc: version, instruction set, layouts. python -m narc pages FOLDER: help pages, made from docstrings."""

import inspect
import pathlib
import re
import sys
from typing import Any

import numpy as np

import narc

from . import _narc, _tables


def tell() -> None:
    names = _narc.names()
    print("version        ", narc.__version__)
    print("instruction set", narc.get_isa(), "of", " ".join(names["isa"]))
    print("processor      ", " ".join(names["cpu"]))
    print("kernels        ", " ".join(names["kernel"]))
    print("package        ", pathlib.Path(__file__).parent)
    print("help pages      python -m narc pages FOLDER")
    for name in ("narc_body", "narc_contact", "narc_manifold", "narc_ray_hit", "narc_distance", "narc_impact"):
        fields = fields_of(_tables.row_type(name)).items()
        print(f"{name:<15}", ", ".join(f"{field} {kind} at {offset}" for field, (kind, offset) in fields))


def words(thing: object) -> str:
    return inspect.getdoc(thing) or ""


def fields_of(kind: np.dtype[np.void]) -> dict[str, tuple[str, int]]:
    """What each field is, and at which byte."""
    fields: Any = kind.fields
    return {name: (f"{of.base} x {of.shape[0]}" if of.shape else str(of), offset) for name, (of, offset, *_) in fields.items()}


def signature(thing: object) -> str:
    """With the names of types as they are written."""
    try:
        return re.sub(r"(: |-> )'([^']*)'", r"\1\2", str(inspect.signature(thing)))  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return "(...)"


def page_of_rows() -> list[str]:
    """A table for each type of rows."""
    lines = ["# Rows", "", "Structured types of NumPy, made from the library's own table of structures.", ""]
    for name in narc.__all__:
        kind = getattr(narc, name)
        if isinstance(kind, np.dtype):
            lines += [f"## narc.{name}", "", f"{kind.itemsize} bytes", "", "| field | type | at byte |", "| --- | --- | ---: |"]
            lines += [f"| `{field}` | {of} | {offset} |" for field, (of, offset) in fields_of(kind).items()] + [""]
    return lines


def write_pages(folder: pathlib.Path) -> None:
    """narc.md: all functions and classes; rows.md: the fields of rows; constants.md: the library's constants."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = [f"# narc {narc.__version__}", "", "[Rows](rows.md), [constants](constants.md)", "", words(narc), ""]
    things = [(name, getattr(narc, name)) for name in narc.__all__ if callable(getattr(narc, name))]
    for name, thing in sorted(things, key=lambda pair: (not isinstance(pair[1], type), pair[0])):
        lines += [f"## narc.{name}", "", "```python", f"narc.{name}{signature(thing)}", "```", "", words(thing), ""]
        own: dict[str, Any] = dict(vars(thing)) if isinstance(thing, type) else {}
        for method, value in own.items():
            if not method.startswith("_") and words(value):
                lines += [f"### narc.{name}.{method}{signature(getattr(thing, method))}", "", words(value), ""]
    constants = ["# Constants", "", "`narc.CONSTANTS` by name.", "", "| name | value |", "| --- | ---: |"]
    constants += [f"| `{name}` | {value} |" for name, value in sorted(_tables.CONSTANTS.items())] + [""]
    for page, text in (("narc.md", lines), ("rows.md", page_of_rows()), ("constants.md", constants)):
        (folder / page).write_text("\n".join(text))
        print(folder / page)


def main(arguments: list[str]) -> int:
    if not arguments:
        tell()
    elif arguments[0] == "pages" and len(arguments) == 2:
        write_pages(pathlib.Path(arguments[1]))
    else:
        print("python -m narc [pages FOLDER]", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
