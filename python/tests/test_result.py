"""Results in the forms that other packages take."""

import html.parser
import json
import re

import matplotlib.pyplot as pyplot
import numpy as np
import pytest
from conftest import ROOT

import bricard


@pytest.fixture(scope="module")
def run(engine):
    return engine.simulate(until=3, every=0.01)


def test_columns_are_there_by_name(run):
    assert run.keys()[:4] == ["t", "crank", "rod", "slider"]
    assert {"der(slider)", "power", "pin_at.x", "r(crank)", "energy"} <= set(run)
    assert np.array_equal(run["der(rod)"], run.v[:, 1])
    assert np.array_equal(run["energy"], run["kinetic"] + run["potential"])
    assert run.reactions.shape == (301, 3) and len(run) == 301
    assert run.units["r(slider)"] == "N" and run.units["der(crank)"] == "rad/s"
    assert abs(run["constraint_error"]).max() < 1e-12
    with pytest.raises(bricard.UnknownName, match="there are t, crank"):
        run["cronk"]
    with pytest.raises(bricard.UnknownName):
        run[0]
    assert "steps" in str(run.summary) and "Engine: 301 rows" in repr(run)


def test_reactions_are_left_out_on_demand(engine):
    run = engine.simulate(until=0.1, reactions=False)
    assert "r(crank)" not in run
    with pytest.raises(bricard.UnknownName):
        run.reactions


def test_pandas_has_the_columns(run):
    frame = run.to_pandas()
    assert frame.index.name == "t" and list(frame.columns) == run.keys()[1:]
    assert np.array_equal(frame["slider"].to_numpy(), run["slider"])
    assert frame["slider"].loc[0.5] == run["slider"][50]


def test_xarray_has_units(run):
    data = run.to_xarray()
    assert data["slider"].attrs == {"units": "m"}
    assert data["t"].attrs == {"units": "s"}
    assert np.array_equal(data["crank"].values, run["crank"])


def test_a_plot_has_lines_with_units_and_marks_of_passages(run):
    axes = run.plot("crank", "slider", axes=pyplot.figure().gca())
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["crank (rad)", "slider (m)"]
    assert len(axes.lines) == 2 + len(run.passages)
    assert len(run.plot(axes=pyplot.figure().gca()).lines) == 3 + len(run.passages)
    pyplot.close("all")


class Elements(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.seen = [], []

    def handle_starttag(self, tag, attrs):
        self.seen.append(tag)
        if tag != "input":
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_moving_picture_is_whole(run):
    page = run._repr_html_()
    parser = Elements()
    parser.feed(page)
    assert parser.open == [] and {"svg", "script", "input"} <= set(parser.seen)
    assert "http" not in page.replace("http://www.w3.org/2000/svg", "")
    frames = json.loads(re.search(r"const frames = (\[.*?\]), times", page).group(1))
    times = json.loads(re.search(r"times = (\[.*?\]), paper", page).group(1))
    assert len(frames) == len(times) == 240 and times[-1] == 3
    ((kind, data),) = frames[-1]
    points = [tuple(map(float, point.split(","))) for point in data["points"].split()]
    assert kind == "polyline" and points[0] == (0, 0)
    assert points[2][0] == pytest.approx(run["slider"][-1], abs=1e-4)


def test_a_mechanism_without_a_picture_has_its_summary_instead():
    text = (ROOT / "tests/embedding/engine.mech").read_text(encoding="utf-8")
    text = re.sub(r"draw .*;", "", text).replace("Engine", "Undrawn")
    page = bricard.Mechanism.from_text(text, "undrawn").simulate(until=0.1)._repr_html_()
    assert page.startswith("<p>Undrawn: t = 0.1 s after")
