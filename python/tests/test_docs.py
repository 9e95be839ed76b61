"""The chapter of the documentation: its descriptions and programs, run as they stand."""

import re

from conftest import ROOT, command


def blocks(language: str) -> list:
    page = (ROOT / "docs/embedding.md").read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", page, re.S | re.M)


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
