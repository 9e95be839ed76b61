"""What the tests share: the command, and mechanisms that are compiled once."""

import os
import subprocess
from pathlib import Path

import matplotlib
import pytest

import bricard

matplotlib.use("Agg")

ROOT = Path(__file__).resolve().parents[2]

#: A slider–crank with a motor, an output and an event.
ENGINE = (ROOT / "tests/embedding/engine.mech").read_text(encoding="utf-8")


def command(*arguments: str) -> str:
    """What the command itself says."""
    name = os.environ.get("BRICARD", "bricard")
    done = subprocess.run([name, *arguments], capture_output=True, text=True, check=True)
    return done.stdout


@pytest.fixture(scope="session")
def slider_crank() -> bricard.Mechanism:
    return bricard.library.slider_crank


@pytest.fixture(scope="session")
def cart_pole() -> bricard.Mechanism:
    return bricard.library.cart_pole


@pytest.fixture(scope="session")
def engine() -> bricard.Mechanism:
    return bricard.Mechanism(ROOT / "tests/embedding/engine.mech")
