"""FMUs in FMPy: valid, and the motion of the command's own run."""

import numpy as np
import pytest
from conftest import ROOT, command

fmpy = pytest.importorskip("fmpy")

from fmpy import fmi2  # noqa: E402
from fmpy.fmi1 import FMICallException  # noqa: E402
from fmpy.validation import validate_fmu  # noqa: E402

#: What co-simulation may differ by from the run in one piece: both keep a tolerance of
#: 1e-12, and the motion doubles small differences a few times in eight seconds.
SAME = 1e-9


@pytest.fixture(scope="module")
def fmu(tmp_path_factory):
    path = tmp_path_factory.mktemp("fmu") / "engine.fmu"
    description = str(ROOT / "tests/embedding/engine.mech")
    said = command("export", description, "--to", "fmi2", "--out", str(path))
    assert "is an FMU of FMI 2.0" in said
    return str(path)


def simulate(fmu, kind, **more):
    """Rows of a simulation by FMPy."""
    return fmpy.simulate_fmu(fmu, fmi_type=kind, validate=True, relative_tolerance=1e-12, **more)


def test_fmpy_finds_nothing_wrong(fmu):
    assert validate_fmu(fmu) == []


def test_variables_have_units_defaults_and_documentation(fmu):
    description = fmpy.read_model_description(fmu)
    variables = {variable.name: variable for variable in description.modelVariables}
    assert variables["L"].causality == "parameter" and float(variables["L"].start) == 0.5
    assert variables["L"].unit == "m" and "length" in variables["L"].description
    assert variables["torque"].causality == "input"
    assert float(variables["start(crank)"].start) == pytest.approx(np.pi / 4)
    assert variables["der(crank)"].derivative.name == "crank"
    assert variables["der(der(crank))"].derivative.name == "der(crank)"
    assert description.numberOfEventIndicators == 1


def test_co_simulation_is_the_native_run_through_singular_positions(fmu, engine):
    names = ["crank", "rod", "slider", "power", "r(slider)", "kinetic"]
    rows = simulate(fmu, "CoSimulation", stop_time=8, output_interval=0.1, output=names)
    run = engine.simulate(until=8, rtol=1e-12, every=0.1)
    assert len(run.passages) > 2
    assert np.allclose(rows["time"], run.t)
    for name in names[:3]:
        assert np.allclose(rows[name], run[name], rtol=0, atol=SAME), name
    assert np.allclose(rows["kinetic"], run["kinetic"], rtol=0, atol=1e-7)


def test_parameters_starts_and_inputs_are_set(fmu, engine):
    values = {"ms": 0.8, "start(crank)": 1.0, "start(der(crank))": 2.0}
    signals = np.array([(0.0, 1.5), (2.0, 1.5)], dtype=[("time", float), ("torque", float)])
    rows = simulate(
        fmu, "CoSimulation", stop_time=2, output_interval=0.1, start_values=values, input=signals
    )
    run = engine.simulate(
        until=2,
        rtol=1e-12,
        every=0.1,
        parameters={"ms": 0.8},
        start={"crank": 1.0, "der(crank)": bricard_guess(2.0)},
        inputs={"torque": 1.5},
    )
    assert np.allclose(rows["crank"], run["crank"], rtol=0, atol=SAME)


def bricard_guess(value):
    """Velocities are guesses where the description holds none."""
    import bricard

    return bricard.guess(value)


def test_model_exchange_stays_on_the_constraints_between_singular_positions(fmu, engine):
    run = engine.simulate(until=0.6, rtol=1e-12, every=0.1)
    assert not run.passages
    names = ["crank", "rod", "slider"]
    rows = simulate(
        fmu, "ModelExchange", stop_time=0.6, output_interval=0.1, output=names, solver="CVode"
    )
    assert np.allclose(rows["crank"], run["crank"], rtol=0, atol=1e-6)
    gap = 0.5 * np.sin(rows["crank"]) - 0.5 * np.sin(rows["rod"])
    assert abs(gap).max() < 1e-8


def instance(fmu, folder):
    """An instance for calls one by one."""
    description = fmpy.read_model_description(fmu)
    slave = fmi2.FMU2Slave(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="one",
    )
    slave.instantiate()
    return slave, {variable.name: variable.valueReference for variable in description.modelVariables}


def begin(slave):
    slave.setupExperiment(startTime=0.0, tolerance=1e-10)
    slave.enterInitializationMode()
    slave.exitInitializationMode()


def test_two_of_them_in_one_process_and_states_that_come_back(fmu):
    folder = fmpy.extract(fmu)
    one, names = instance(fmu, folder)
    two, _ = instance(fmu, folder)
    crank = [names["crank"]]
    for slave in (one, two):
        begin(slave)
    for step in range(10):
        one.doStep(step * 0.1, 0.1)
    state = one.getFMUState()
    kept = one.serializeFMUstate(state)
    for step in range(10):
        two.doStep(step * 0.1, 0.1)
    assert one.getReal(crank) == two.getReal(crank)
    one.doStep(1.0, 0.5)
    ahead = one.getReal(crank)
    one.setFMUState(state)
    assert one.getReal(crank) == two.getReal(crank)
    one.doStep(1.0, 0.5)
    assert one.getReal(crank) == ahead
    other = two.deSerializeFMUstate(kept)
    two.setFMUState(other)
    two.doStep(1.0, 0.5)
    assert two.getReal(crank) == pytest.approx(ahead, abs=1e-7)
    for slave, held in ((one, state), (two, other)):
        slave.freeFMUState(held)
        slave.terminate()
        slave.freeInstance()


def test_calls_out_of_order_and_nonsense_are_refused_until_a_reset(fmu):
    slave, names = instance(fmu, fmpy.extract(fmu))
    with pytest.raises(FMICallException):
        slave.doStep(0.0, 0.1)
    with pytest.raises(FMICallException):
        slave.enterInitializationMode()
    slave.reset()
    with pytest.raises(FMICallException):
        slave.setReal([names["L"]], [float("nan")])
    slave.reset()
    with pytest.raises(FMICallException):
        slave.getReal([10_000])
    slave.reset()
    begin(slave)
    with pytest.raises(FMICallException):
        slave.setReal([names["L"]], [0.6])
    slave.reset()
    begin(slave)
    with pytest.raises(FMICallException):
        slave.doStep(3.0, 0.1)
    slave.reset()
    begin(slave)
    slave.doStep(0.0, 0.1)
    slave.freeInstance()


def test_it_is_one_file(tmp_path):
    import subprocess

    with pytest.raises(subprocess.CalledProcessError) as refused:
        command("export", "slider_crank", "--to", "fmi2", "--out", str(tmp_path))
    assert "write `--out NAME.fmu`" in refused.value.stderr
