"""The chapters of the documentation: their descriptions and programs, run as they stand."""

import re

import pytest
from conftest import ROOT, command


def read(page: str) -> str:
    return (ROOT / f"docs/{page}.md").read_text(encoding="utf-8")


def blocks(language: str, page: str = "embedding") -> list:
    return re.findall(rf"^```{language}\n(.*?)^```$", read(page), re.S | re.M)


def test_the_programs_of_the_chapter_run(tmp_path, monkeypatch, capsys):
    (tmp_path / "crank.mech").write_text(blocks("mech")[0], encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    names: dict = {}
    programs = blocks("python")
    assert len(programs) == 7
    command("export", "crank.mech", "--to", "fmi3")
    for program in programs:
        exec(compile(program, "docs/embedding.md", "exec"), names)
    said = capsys.readouterr().out
    assert "passages through singular positions" in said and "dead_centre" in said
    assert "at t = " in said


def test_the_errors_of_co_simulation_are_those_of_the_chapter(tmp_path, monkeypatch, capsys):
    pytest.importorskip("fmpy")
    monkeypatch.chdir(tmp_path)
    for description in blocks("mech", "cosimulation"):
        name = re.search(r"mechanism (\w+)", description)[1].lower()
        (tmp_path / f"{name}.mech").write_text(description, encoding="utf-8")
    (lines,) = blocks("bash", "cosimulation")
    for line in lines.splitlines():
        command(*line.split()[1:])
    names: dict = {}
    for program in blocks("python", "cosimulation"):
        exec(compile(program, "docs/cosimulation.md", "exec"), names)
    assert "6 singular positions on the way" in capsys.readouterr().out
    parallel, staggered = (names["errors"][names[name]] for name in ("parallel", "staggered"))
    table = re.findall(r"^\| (\d) \| (\S+) \| (\S+) \|$", read("cosimulation"), re.M)
    rows = zip(names["steps"], parallel, staggered, strict=True)
    for (step, *shown), (measured, *errors) in zip(table, rows, strict=True):
        assert float(step) == pytest.approx(1e3 * measured)
        assert [float(error) for error in shown] == pytest.approx(errors, rel=0.1)
    # Orders one and two in the step.
    for coarse, fine in zip(parallel, parallel[1:]):
        assert 1.8 < coarse / fine < 2.2
    for coarse, fine in zip(staggered, staggered[1:]):
        assert 3.8 < coarse / fine < 4.2
