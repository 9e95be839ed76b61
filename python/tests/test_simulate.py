"""Runs against the command's own, to the last bit, and everything that can be chosen."""

import csv
import io
import math
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from conftest import command

import bricard


def rows_of(*arguments):
    """Rows of the command, by name."""
    table = list(csv.reader(io.StringIO(command("simulate", *arguments))))
    columns = np.array([[float(x) for x in row] for row in table[1:]]).T
    return dict(zip(table[0], columns))


def test_a_run_has_the_bits_of_the_command(slider_crank):
    columns = "energy,kinetic,reactions,x2,constraint_error"
    wanted = rows_of(
        "slider_crank", "--until", "8", "--rtol", "1e-10", "--every", "0.1", "--columns", columns
    )
    run = slider_crank.simulate(until=8, rtol=1e-10, every=0.1)
    assert len(run) == 81
    for name, column in wanted.items():
        # The command's first row is the start as assembled, before it is polished.
        assert np.array_equal(run[name][1:], column[1:]), name
        assert np.allclose(run[name][0], column[0], atol=1e-14), name


def test_choices_are_those_of_the_command(slider_crank):
    wanted = rows_of(
        "slider_crank", "--until", "1", "--method", "radau5", "--rtol", "1e-6",
        "--set", "m1=2", "--start", "q1=1.2", "--form", "full",
    )  # fmt: skip
    run = slider_crank.simulate(
        until=1, method="radau5", rtol=1e-6, parameters={"m1": 2}, start={"q1": 1.2}, form="full"
    )
    assert np.array_equal(run["q1"][1:], wanted["q1"][1:])
    wanted = rows_of("slider_crank", "--until", "1", "--step", "0.01")
    run = slider_crank.simulate(until=1, step=0.01)
    assert np.array_equal(run["q3"][1:], wanted["q3"][1:])


def test_parameters_of_a_run_are_not_kept(slider_crank):
    before = slider_crank.parameters
    slider_crank.simulate(until=0.1, parameters={"L1": 0.6, "L2": 0.7})
    assert slider_crank.parameters == before
    copy = slider_crank.copy()
    copy.set(L1=0.6)
    assert copy.parameters["L1"] == 0.6
    assert slider_crank.parameters == before


def test_passages_and_events_are_located(engine):
    run = engine.simulate(until=8)
    assert run.summary.passages == len(run.passages) > 2
    assert all(passage.rank == 1 and passage.regular == 2 for passage in run.passages)
    assert run.summary.events == len(run.events) > 1
    for event in run.events:
        assert event.name == "top" and event.rising
        assert math.cos(event.q[0]) == pytest.approx(0, abs=1e-12)
        at = run.at(event.t)
        assert np.allclose(at.q, event.q, atol=1e-8)


def test_an_event_may_end_a_run(engine):
    seen = []

    def told(name, state):
        seen.append((name, state.t))
        return len(seen) == 2

    run = engine.simulate(until=100, on_event=told)
    assert run.summary.stopped and len(seen) == 2
    assert run.summary.t == seen[1][1] == run.end.t


def test_a_run_goes_on_from_the_end_of_another(engine):
    whole = engine.simulate(until=4, rtol=1e-11)
    first = engine.simulate(until=2, rtol=1e-11)
    second = engine.simulate(until=4, rtol=1e-11, start=first.end)
    assert second.t[0] == 2
    assert np.allclose(second.end.q, whole.end.q, atol=1e-7)


def test_guesses_give_way_and_held_values_stay(engine):
    start = {"crank": 0.9, "rod": bricard.guess(0.8), "der(crank)": 2.0}
    state = engine.assemble(start)
    assert state.q[0] == 0.9 and state.v[0] == 2.0
    assert abs(engine.residual(state.q)).max() < 1e-14
    with pytest.raises(bricard.AssemblyError, match="crank, slider; turn one"):
        engine.assemble({"slider": 5.0})


def test_inputs_are_numbers_or_functions(engine):
    held = engine.simulate(until=2, inputs={"torque": 1.5})
    constant = engine.simulate(until=2, inputs={"torque": lambda t: 1.5})
    assert np.array_equal(held.q, constant.q)
    law = engine.simulate(until=2, rtol=1e-11)
    same = engine.simulate(until=2, rtol=1e-11, inputs={"torque": lambda t: 2 * math.sin(t)})
    assert np.allclose(law.end.q, same.end.q, atol=1e-8)
    brake = engine.simulate(until=2, inputs={"torque": lambda t, q, v: -0.5 * v[0]})
    assert np.allclose(brake["power"], -0.5 * brake["der(crank)"] ** 2)
    assert brake.summary.energy_supplied < 0


def test_driven_inputs_stay_and_are_returned_to_their_law(engine):
    m = engine.copy()
    m.drive({"torque": lambda t: 1.0})
    driven = m.simulate(until=1)
    m.drive({"torque": None})
    assert np.array_equal(m.simulate(until=1).q, engine.simulate(until=1).q)
    assert not np.array_equal(driven.end.q, engine.simulate(until=1).end.q)


def test_what_a_function_raises_is_raised(engine):
    def fails(t):
        if t > 0.5:
            raise RuntimeError("no more torque")
        return 0.0

    with pytest.raises(RuntimeError, match="no more torque"):
        engine.simulate(until=1, inputs={"torque": fails})
    with pytest.raises(TypeError):
        engine.simulate(until=1, inputs={"torque": lambda t: "a lot"})
    with pytest.raises(bricard.InvalidValue, match="not 2 arguments"):
        engine.simulate(until=1, inputs={"torque": lambda t, q: 0.0})


def test_a_motion_that_fails_says_when_and_keeps_its_rows(engine):
    with pytest.raises(bricard.SimulationError, match="NaN") as failure:
        engine.simulate(until=2, inputs={"torque": lambda t: math.nan if t > 1 else 0.0})
    error = failure.value
    assert 0 < error.result.t[-1] <= 1 < error.t < 2
    assert len(error.q) == len(error.v) == 3
    assert np.array_equal(error.q, error.result.end.q)
    with pytest.raises(bricard.SimulationError, match="2 steps"):
        engine.simulate(until=2, most_steps=2)


@pytest.mark.parametrize(
    "wrong, kind, word",
    [
        ({"parameters": {"Q": 1}}, bricard.UnknownName, "there is no parameter `Q`"),
        ({"parameters": {"L": math.nan}}, bricard.InvalidValue, "`L` can't be NaN"),
        ({"parameters": {"L": "long"}}, bricard.InvalidValue, "`L` has to be a number"),
        ({"inputs": {"tork": 1}}, bricard.UnknownName, "`torque`"),
        ({"start": {"der(cronk)": 1}}, bricard.UnknownName, "coordinate `cronk`"),
        ({"start": {3: 1}}, bricard.UnknownName, "a name is a text"),
        ({"method": "euler"}, bricard.InvalidValue, "rk4, dp5, dop853"),
        ({"form": "odd"}, bricard.InvalidValue, "reduced"),
        ({"method": "rk4"}, bricard.InvalidValue, "error estimate"),
        ({"rtol": 0}, bricard.InvalidValue, "tolerance"),
        ({"step": 0}, bricard.InvalidValue, "positive"),
        ({"step": -1}, bricard.InvalidValue, "positive"),
        ({"step": 0.1, "rtol": 1e-3}, bricard.InvalidValue, "leave out"),
        ({"every": 0}, bricard.InvalidValue, "every"),
        ({"every": math.nan}, bricard.InvalidValue, "every"),
        ({"every": 1e-300}, bricard.InvalidValue, "take fewer"),
        ({"until": -1}, bricard.InvalidValue, "not come earlier"),
        ({"until": math.nan}, bricard.InvalidValue, "end must be"),
        ({"t0": math.inf}, bricard.InvalidValue, "the start can't be"),
        ({"stabilisation": ("baumgarte", 1)}, bricard.InvalidValue, "gains"),
        ({"stabilisation": "glue"}, bricard.InvalidValue, "projection"),
        ({"keep_energy": True}, bricard.InvalidValue, "energy can't be kept"),
    ],
)
def test_what_makes_no_sense_is_refused_in_words(engine, wrong, kind, word):
    with pytest.raises(kind) as refusal:
        engine.simulate(**{"until": 1, **wrong})
    assert word in str(refusal.value)
    assert engine.simulate(until=0.1).t[-1] == 0.1


def test_any_time_of_a_run_can_be_asked_for(slider_crank):
    run = slider_crank.simulate(until=4, rtol=1e-11)
    fine = slider_crank.simulate(until=4, rtol=1e-11, every=0.05)
    states = run.at(fine.t)
    assert states.q.shape == (81, 3)
    # Both come from the same polynomials.
    assert np.allclose(states.q, fine.q, rtol=0, atol=1e-13)
    assert np.allclose(states.v, fine.v, rtol=0, atol=1e-12)
    assert np.array_equal(run.at(run.t[7], project=False).q, run.q[7])
    none = run.at(np.array([]))
    assert (none.t.shape, none.q.shape, none.v.shape) == ((0,), (0, 3), (0, 3))
    with pytest.raises(bricard.InvalidValue, match="from t = 0.0 s to 4.0 s"):
        run.at(4.1)


def test_every_method_can_be_asked_between_its_rows(slider_crank):
    for method, step in [("rk4", 0.01), ("dp5", None), ("radau5", None), ("radau9", None)]:
        run = slider_crank.simulate(until=1, method=method, step=step)
        fine = slider_crank.simulate(until=1, method=method, step=step, every=0.03)
        assert np.allclose(run.at(fine.t).q, fine.q, rtol=0, atol=1e-12), method


def test_many_threads_move_one_mechanism(slider_crank):
    wanted = slider_crank.simulate(until=2).q
    with ThreadPoolExecutor(4) as pool:
        runs = [pool.submit(slider_crank.simulate, until=2) for _ in range(16)]
        assert all(np.array_equal(run.result().q, wanted) for run in runs)


def test_other_threads_go_on_while_the_library_computes(slider_crank):
    done = threading.Event()

    def long_run():
        slider_crank.simulate(until=300, every=100, reactions=False)
        done.set()

    thread = threading.Thread(target=long_run)
    thread.start()
    turns = 0
    while not done.wait(0.001):
        turns += 1
    thread.join()
    # Were the lock held, this thread would have come to its turn once.
    assert turns > 3


def test_control_c_ends_a_run(tmp_path):
    program = tmp_path / "endless.py"
    program.write_text(
        "import bricard, sys\n"
        "m = bricard.library.slider_crank\n"
        "print('begun', flush=True)\n"
        "try:\n"
        "    m.simulate(until=1e9, every=1e6)\n"
        "except KeyboardInterrupt:\n"
        "    print('interrupted')\n"
        "print(m.simulate(until=1).summary.t)\n"
    )
    # What runs in the background of a shell may have inherited that Ctrl-C is ignored.
    process = subprocess.Popen(
        [sys.executable, program],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    try:
        assert process.stdout.readline() == "begun\n"
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=60)
    finally:
        process.kill()
    assert said == "interrupted\n1.0\n"
    assert process.returncode == 0


def test_a_run_from_python_costs_little_more_than_the_run(slider_crank):
    def best(once):
        times = []
        for _ in range(7):
            begun = time.perf_counter()
            once()
            times.append(time.perf_counter() - begun)
        return min(times)

    choices = {"until": 8, "rtol": 1e-10, "reactions": False}
    # The same without rows is the run itself, but for what Python adds to any call.
    bare = best(lambda: slider_crank.simulate(**choices, every=8))
    with_rows = best(lambda: slider_crank.simulate(**choices, every=0.01))
    # A few milliseconds in all; the bound is wide for machines that others use.
    assert with_rows < 3 * bare + 2e-3
