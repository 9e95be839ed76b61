"""Functions that inputs follow, and what they may ask and raise."""

import threading

import numpy as np
import pytest
from conftest import ROOT

import bricard


@pytest.fixture
def engine(engine):
    return engine.copy()


def test_a_law_may_ask_a_copy_of_its_mechanism(engine):
    model = engine.copy()

    def torque(t, q, v):
        return -0.1 * model.mass_matrix(q)[0, 0] * v[0]

    start = engine.assemble({"der(crank)": 5})
    inertia = engine.mass_matrix(start.q)[0, 0]
    held = engine.copy()
    held.drive({"torque": -0.1 * inertia * start.v[0]})
    engine.drive({"torque": torque})
    found = engine.acceleration(start.q, start.v)
    assert np.allclose(found, held.acceleration(start.q, start.v), rtol=1e-12)
    run = engine.simulate(until=1, start={"der(crank)": 5})
    assert run.summary.energy_error < 1e-6


def test_laws_that_ask_for_themselves_are_refused(engine):
    start = engine.assemble()
    for ask in (engine.acceleration, engine.mass_matrix):
        engine.drive({"torque": lambda t, q, v: float(ask(q, v).flat[0])})
        with pytest.raises(bricard.BricardError, match="in turn"):
            engine.acceleration(start.q, start.v)
        with pytest.raises(bricard.BricardError, match="in turn"):
            engine.simulate(until=1)


@pytest.mark.parametrize("lasting", [True, False])
def test_what_a_law_raises_comes_out(engine, lasting):
    def torque(t):
        raise RuntimeError(f"no torque at {t}")

    inputs = {"torque": torque}
    start = engine.assemble()
    if lasting:
        engine.drive(inputs)
    with pytest.raises(RuntimeError, match="no torque"):
        engine.simulate(until=1, inputs=None if lasting else inputs)
    engine.drive(inputs)
    with pytest.raises(RuntimeError, match="no torque"):
        engine.acceleration(start.q, start.v)


def test_a_run_is_asked_with_its_own_parameters(engine):
    run = engine.simulate(until=1, every=0.1, parameters={"L": 0.3}, start={"der(crank)": 5})
    engine.set(L=0.4)
    for row in (3, 5, 8):
        state = run.at(run.t[row])
        assert np.allclose(state.q, run.q[row], rtol=0, atol=1e-7)
        assert np.allclose(state.v, run.v[row], rtol=0, atol=1e-6)


def test_threads_may_ask_one_run(engine):
    run = engine.simulate(until=1)
    found, failures = {}, []

    def ask(number):
        try:
            found[number] = [run.at(t).q for t in np.linspace(0.1, 0.9, 20)]
        except Exception as error:  # It would end the thread alone.
            failures.append(error)

    threads = [threading.Thread(target=ask, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures
    assert all(np.array_equal(found[0], rows) for rows in found.values())


def test_no_name_has_an_end_within(engine):
    with pytest.raises(bricard.UnknownName):
        engine.set({"L\0nonsense": 1.0})
