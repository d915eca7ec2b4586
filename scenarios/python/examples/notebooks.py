"""Writes each example as a notebook beside it: its cells, and one that shows its pictures. Writing again gives the same bytes.

python3 scenarios/python/examples/notebooks.py [--check]
"""

import argparse
import pathlib
import sys

import nbformat
from nbformat import v4

FOLDER = pathlib.Path(__file__).resolve().parent
EXAMPLES = ["centroid_tracker", "snr_against_range", "labelled_pictures", "emissivity_from_picture", "apparent_temperature"]
SHOW = """from IPython.display import Image, display

for picture in sorted(asked.out.glob("NAME*.png")):
    display(Image(picture))"""


def cells_of(script: str) -> list[tuple[str, str]]:
    """Kind ("markdown" or "code") and text of each cell of a script in the percent format."""
    cells: list[tuple[str, list[str]]] = []
    for line in script.splitlines():
        if line in ("# %%", "# %% [markdown]"):
            cells.append(("markdown" if line.endswith("[markdown]") else "code", []))
        elif cells:
            kind, lines = cells[-1]
            lines.append(line.removeprefix("#").removeprefix(" ") if kind == "markdown" else line)
        elif line.strip():
            raise ValueError(f"'{line}' stands before the first '# %%'")
    return [(kind, "\n".join(lines).strip("\n")) for kind, lines in cells]


def notebook_of(name: str) -> str:
    """The text of an example's notebook."""
    cells = cells_of((FOLDER / f"{name}.py").read_text()) + [("code", SHOW.replace("NAME", name))]
    make = {"markdown": v4.new_markdown_cell, "code": v4.new_code_cell}
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    book = v4.new_notebook(
        cells=[make[kind](text, id=f"cell-{k}") for k, (kind, text) in enumerate(cells)], metadata={"kernelspec": kernel, "language_info": {"name": "python"}}
    )
    nbformat.validate(book)
    return nbformat.writes(book) + "\n"


def main() -> int:
    options = argparse.ArgumentParser(description="Writes each example as a notebook beside it.")
    options.add_argument("--check", action="store_true", help="only say which are not as their scripts (exit code 1)")
    check = options.parse_args().check
    stale = [name for name in EXAMPLES if not (file := FOLDER / f"{name}.ipynb").exists() or file.read_text() != notebook_of(name)]
    for name in stale:
        if check:
            print(f"{name}.ipynb is not as {name}.py; fix: run {pathlib.Path(__file__).name}", file=sys.stderr)
        else:
            (FOLDER / f"{name}.ipynb").write_text(notebook_of(name))
            print(f"{name}.ipynb written")
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
