"""States of the first order stand behind the velocities; derivatives are exact."""

import numpy as np
import pytest
from conftest import ROOT, command

import bricard
from bricard import _abi


@pytest.fixture(scope="module")
def motor():
    return bricard.Mechanism(ROOT / "tests/embedding/motor.mech")


def test_a_state_is_no_coordinate(motor):
    assert [quantity.name for quantity in motor.coordinates] == ["angle"]
    assert [quantity.name for quantity in motor.states] == ["current"]
    assert (motor.n, motor.m) == (1, 2)
    state = motor.assemble({"current": 0.25, "der(angle)": 2})
    assert state.q.shape == (1,) and list(state.v) == [2, 0.25]
    with pytest.raises(bricard.UnknownName):
        motor.assemble({"der(current)": 0})


def test_rows_are_those_of_the_command(motor):
    run = motor.simulate(until=2, rtol=1e-9, every=0.25)
    assert run.keys()[:4] == ["t", "angle", "der(angle)", "current"]
    assert run.units["current"] == "A" and "r(current)" not in run
    path = str(ROOT / "tests/embedding/motor.mech")
    said = command("simulate", path, "--until", "2", "--rtol", "1e-9", "--every", "0.25")
    lines = [line.split(",") for line in said.splitlines()]
    assert lines[0][:4] == run.keys()[:4]
    rows = np.array([[float(number) for number in line[:4]] for line in lines[1:]])
    ours = np.column_stack([run[name] for name in lines[0][:4]])
    assert np.array_equal(rows, ours)


def test_a_run_goes_on_from_its_end_and_between_its_rows(motor):
    run = motor.simulate(until=1, rtol=1e-11)
    later = motor.simulate(until=2, rtol=1e-11, start=run.end)
    whole = motor.simulate(until=2, rtol=1e-11, every=0.5)
    assert later["current"][-1] == pytest.approx(whole["current"][-1], abs=1e-9)
    assert run.at(0.5).v[1] == pytest.approx(whole["current"][1], abs=1e-9)


def test_inputs_and_solvers_of_others_see_states(motor):
    integrate = pytest.importorskip("scipy.integrate")
    start = motor.assemble()
    found = integrate.solve_ivp(motor.rhs, (0, 1), [*start.q, *start.v], rtol=1e-10, atol=1e-10)
    run = motor.simulate(until=1, rtol=1e-11)
    assert np.allclose(found.y[:, -1], [*run.end.q, *run.end.v], rtol=0, atol=1e-7)
    braked = motor.simulate(until=1, inputs={"voltage": lambda t, q, v: -v[1]})
    assert abs(braked["current"][-1]) < 0.5


def test_a_clone_that_is_saved_keeps_its_states(motor):
    handle = motor._clone()
    handle.call(handle.table.assemble, 0.0)
    size = handle.number(handle.table.size, _abi.SAVED)
    saved = np.zeros(size)
    handle.call(handle.table.save, _abi.doubles(saved), size)
    other = motor._clone()
    other.call(other.table.load, _abi.doubles(saved), size)
    for ours, theirs in zip(handle.state_if_any(), other.state_if_any()):
        assert np.array_equal(ours, theirs)


@pytest.mark.parametrize("name", ["engine", "motor"])
def test_slopes_are_those_of_central_differences(name):
    m = bricard.Mechanism(ROOT / f"tests/embedding/{name}.mech")
    (input,) = m.inputs
    m.drive({input.name: 0.4})
    state = m.assemble()
    q, v = state.q + 0.1, state.v + np.linspace(0.2, 0.5, m.m)
    slopes = m.slopes(q, v)
    size = 1e-5

    def difference(change):
        ends = [change(side) for side in (size, -size)]
        return (ends[0] - ends[1]) / (2 * size)

    for place in range(m.n):
        one = np.eye(m.n)[place]
        found = difference(lambda side: m.acceleration(q + side * one, v))
        assert np.allclose(slopes.q[:, place], found, rtol=1e-7, atol=1e-7)
    for place in range(m.m):
        one = np.eye(m.m)[place]
        found = difference(lambda side: m.acceleration(q, v + side * one))
        assert np.allclose(slopes.v[:, place], found, rtol=1e-7, atol=1e-7)

    def driven(side):
        m.drive({input.name: 0.4 + side})
        return m.acceleration(q, v)

    assert np.allclose(slopes.u[:, 0], difference(driven), rtol=1e-7, atol=1e-7)
