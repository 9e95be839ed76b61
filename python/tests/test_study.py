"""The study of the documentation: a notebook, executed as Jupyter does it."""

import os
import re

import nbformat
import pytest
from conftest import ROOT
from nbconvert.preprocessors import ExecutePreprocessor

NOTEBOOK = ROOT / "python/notebooks/study.ipynb"


def made_of_the_chapter():
    """The chapter as cells: its programs are code, all else is text."""
    page = (ROOT / "docs/study.md").read_text(encoding="utf-8")
    cells = []
    for place, part in enumerate(re.split(r"^```(?:python)?\n", page, flags=re.M)):
        make = nbformat.v4.new_code_cell if place % 2 else nbformat.v4.new_markdown_cell
        cell = make(part.strip())
        cell.id = f"cell-{place}"
        # The notebook lies elsewhere than the chapter, and isn't a way to itself.
        cell.source = re.sub(r"\[(`[^`]*`)\]\([^)]*\)", r"\1", cell.source)
        if cell.source:
            cells.append(cell)
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return nbformat.v4.new_notebook(cells=cells, metadata={"kernelspec": kernel})


def test_the_notebook_is_the_chapter():
    made = nbformat.writes(made_of_the_chapter()) + "\n"
    if os.environ.get("BRICARD_BLESS"):
        NOTEBOOK.write_text(made, encoding="utf-8")
    assert NOTEBOOK.read_text(encoding="utf-8") == made


@pytest.fixture(scope="module")
def executed(tmp_path_factory):
    """The cells of code with their outputs."""
    folder = tmp_path_factory.mktemp("study")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    processor = ExecutePreprocessor(timeout=300, kernel_name="python3")
    processor.preprocess(notebook, {"metadata": {"path": str(folder)}})
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def shown(cell, kind):
    """What a cell shows of a kind."""
    return [out.data[kind] for out in cell.outputs if "data" in out and kind in out.data]


def test_the_table_of_the_study_has_the_exact_numbers(executed):
    (text,) = shown(executed[4], "text/plain")
    rows = [[float(word) for word in line.split()] for line in text.splitlines()[2:]]
    assert [row[0] for row in rows] == [0.25, 0.5, 1, 2, 4, 8]
    for _, free, formula, difference, driven in rows:
        # Six digits are printed.
        assert free == pytest.approx(formula, abs=2e-6)
        assert abs(difference) < 1e-6
        assert 0.9 * formula < driven < 1.25 * formula
    # By hand, with the largest x' = 0.10546 m: 1 + 8·0.10546²/0.25 = 1.3559.
    ratio = 1.3559**0.5
    assert rows[0][2] == pytest.approx(2 * (ratio - 1) / (ratio + 1), rel=1e-3)


def test_the_study_ends_with_a_plot_and_the_mechanism_moving(executed):
    *_, plotted, moving = executed
    assert shown(plotted, "image/png")
    said = "".join(out.text for out in plotted.outputs if out.output_type == "stream")
    power = float(re.search(r"to the power (-\d\.\d+)", said)[1])
    assert power == pytest.approx(-1, abs=0.1)
    (page,) = shown(moving, "text/html")
    assert "<svg" in page or "<canvas" in page or "<iframe" in page
    assert not any(out.output_type == "error" for cell in executed for out in cell.outputs)
