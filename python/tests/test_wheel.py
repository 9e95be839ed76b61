"""A wheel of `bricard export --to python`, in an environment that has neither the command nor
a compiler."""

import csv
import hashlib
import os
import subprocess
import sys
import venv
import zipfile
from base64 import urlsafe_b64encode
from io import StringIO

import pytest
from conftest import ROOT, command


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    said = command("export", "slider_crank", "--to", "python", "--out", str(folder))
    (path,) = folder.glob("slider_crank-0.1.0-py3-none-*.whl")
    assert f"pip install {path}" in said
    return path


@pytest.fixture(scope="module")
def python(wheel, tmp_path_factory):
    """The Python of a fresh environment with the wheel; numpy is that of this one."""
    folder = tmp_path_factory.mktemp("environment")
    venv.create(folder, with_pip=True, system_site_packages=False)
    found = [*folder.glob("bin/python"), *folder.glob("Scripts/python.exe")][0]
    pip = [found, "-m", "pip", "--disable-pip-version-check", "install", "--quiet"]
    subprocess.run([*pip, "--no-deps", wheel], check=True)
    return found


def said(python, *arguments):
    """What Python says without the command and without cargo."""
    import numpy

    packages = os.path.dirname(os.path.dirname(numpy.__file__))
    environment = {"PATH": "", "PYTHONPATH": packages}
    done = subprocess.run(
        [python, *arguments], env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout


def test_it_records_what_is_in_it(wheel):
    with zipfile.ZipFile(wheel) as archive:
        assert archive.testzip() is None
        (record,) = [name for name in archive.namelist() if name.endswith("/RECORD")]
        rows = list(csv.reader(StringIO(archive.read(record).decode())))
        assert sorted(row[0] for row in rows) == sorted(archive.namelist())
        for name, kept, size in rows:
            if name == record:
                continue
            content = archive.read(name)
            digest = urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            assert (kept, int(size)) == (f"sha256={digest}", len(content)), name


def test_its_run_is_the_command_s(python):
    program = (
        "import slider_crank\n"
        "run = slider_crank.mechanism.simulate(until=8, rtol=1e-9, every=0.5)\n"
        "assert len(run.passages) > 2\n"
        "for t, q, v in zip(run.t, run.q, run.v): print(*map(repr, map(float, [t, *q, *v])))\n"
    )
    ours = [[float(x) for x in row.split()] for row in said(python, "-c", program).splitlines()]
    rows = command("simulate", "slider_crank", "--until", "8", "--rtol", "1e-9", "--every", "0.5")
    theirs = [[float(x) for x in row.split(",")[:7]] for row in rows.splitlines()[1:]]
    assert ours == theirs


def test_its_example_runs(python):
    lines = said(python, "-m", "slider_crank").splitlines()
    assert lines[0].split() == ["t", "q1", "q2", "q3"]
    assert lines[-2].split()[0] == "10.00" and "passages" in lines[-1]


def test_its_example_shows_the_values_of_states(tmp_path):
    path = str(ROOT / "tests/embedding/motor.mech")
    command("export", path, "--to", "python", "--out", str(tmp_path))
    (wheel,) = tmp_path.glob("motor-*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-m", "motor"], env=environment, capture_output=True, text=True, check=True
    )
    lines = done.stdout.splitlines()
    assert lines[0].split() == ["t", "angle", "current"]
    rows = command("simulate", path, "--until", "10", "--rtol", "1e-9", "--every", "0.5")
    _, angle, _, current = map(float, rows.splitlines()[-1].split(","))
    assert lines[-2].split() == ["10.00", f"{angle:.6f}", f"{current:.6f}"]


def test_it_says_what_is_wrong(python):
    program = (
        "import slider_crank as s\n"
        "try: s.mechanism.set(nothing=1)\n"
        "except s.UnknownName as error: print(error)\n"
        "try: s.Mechanism('x.mech')\n"
        "except s.BricardError as error: print(error)\n"
    )
    lines = said(python, "-c", program).splitlines()
    assert "there is no parameter `nothing`" in lines[0]
    assert "the command `bricard` was not found" in lines[1]
