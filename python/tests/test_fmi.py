"""FMUs in FMPy: valid, and the motion of the command's own run, in both versions of FMI."""

import os
import re
import shutil
import subprocess
import zipfile
from ctypes import c_double
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, command

import bricard

fmpy = pytest.importorskip("fmpy")

from fmpy import fmi2, fmi3  # noqa: E402
from fmpy.fmi1 import FMICallException  # noqa: E402
from fmpy.validation import validate_fmu  # noqa: E402

#: What co-simulation may differ by from the run in one piece: both keep a tolerance of
#: 1e-12, and the motion doubles small differences a few times in eight seconds.
SAME = 1e-9
VERSIONS = {"fmi2": "2.0", "fmi3": "3.0"}


def exported(folder, version, name):
    """An FMU of a description beside the tests of C."""
    path = folder / f"{name}.fmu"
    description = str(ROOT / f"tests/embedding/{name}.mech")
    said = command("export", description, "--to", version, "--out", str(path))
    assert f"is an FMU of FMI {VERSIONS[version]}" in said
    return str(path)


@pytest.fixture(scope="module", params=VERSIONS)
def version(request):
    return request.param


@pytest.fixture(scope="module")
def fmu(version, tmp_path_factory):
    return exported(tmp_path_factory.mktemp(version), version, "engine")


@pytest.fixture(scope="module")
def motor_fmu(version, tmp_path_factory):
    return exported(tmp_path_factory.mktemp(version), version, "motor")


@pytest.fixture(scope="module")
def motor():
    return bricard.Mechanism(ROOT / "tests/embedding/motor.mech")


def simulate(fmu, kind, **more):
    """Rows of a simulation by FMPy."""
    return fmpy.simulate_fmu(fmu, fmi_type=kind, validate=True, relative_tolerance=1e-12, **more)


def described(fmu):
    """The description of an FMU, and its variables by name."""
    description = fmpy.read_model_description(fmu)
    return description, {variable.name: variable for variable in description.modelVariables}


def test_fmpy_finds_nothing_wrong(fmu, motor_fmu):
    assert validate_fmu(fmu) == []
    assert validate_fmu(motor_fmu) == []


def test_variables_have_units_defaults_and_documentation(fmu, version):
    description, variables = described(fmu)
    assert description.fmiVersion == VERSIONS[version]
    assert variables["L"].causality == "parameter" and float(variables["L"].start) == 0.5
    assert variables["L"].unit == "m" and "length" in variables["L"].description
    assert variables["torque"].causality == "input"
    assert float(variables["start(crank)"].start) == pytest.approx(np.pi / 4)
    assert variables["der(crank)"].derivative.name == "crank"
    assert variables["der(der(crank))"].derivative.name == "der(crank)"
    assert variables["time"].causality == "independent"
    if version == "fmi2":
        assert description.numberOfEventIndicators == 1
    else:
        assert [unknown.variable.name for unknown in description.eventIndicators] == ["event(top)"]


def test_states_of_the_first_order_are_states_and_their_integrals_are_nowhere(motor_fmu):
    description, variables = described(motor_fmu)
    states = [unknown.variable.derivative.name for unknown in description.derivatives]
    assert states == ["angle", "der(angle)", "current"]
    assert variables["current"].unit == "A"
    assert variables["der(current)"].derivative.name == "current"
    assert float(variables["start(current)"].start) == 0.5
    assert "start(der(current))" not in variables and "r(current)" not in variables


def test_co_simulation_is_the_native_run_through_singular_positions(fmu, engine):
    names = ["crank", "rod", "slider", "power", "r(slider)", "kinetic"]
    rows = simulate(fmu, "CoSimulation", stop_time=8, output_interval=0.1, output=names)
    run = engine.simulate(until=8, rtol=1e-12, every=0.1)
    assert len(run.passages) > 2
    assert np.allclose(rows["time"], run.t)
    for name in names[:3]:
        assert np.allclose(rows[name], run[name], rtol=0, atol=SAME), name
    assert np.allclose(rows["kinetic"], run["kinetic"], rtol=0, atol=1e-7)


@pytest.mark.parametrize("kind, near", [("CoSimulation", SAME), ("ModelExchange", 1e-6)])
def test_a_motor_with_a_current_runs_as_the_command_does(motor_fmu, motor, kind, near):
    names = ["angle", "der(angle)", "current", "swing", "power"]
    begin = {"start(current)": -0.5}
    rows = simulate(
        motor_fmu, kind, stop_time=2, output_interval=0.1, output=names, start_values=begin
    )
    run = motor.simulate(until=2, rtol=1e-12, every=0.1, start={"current": -0.5})
    # In model exchange there are rows at events besides.
    same = [np.flatnonzero(np.isclose(rows["time"], t))[-1] for t in run.t]
    for name in names:
        assert np.allclose(rows[name][same], run[name], rtol=0, atol=10 * near), name


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
        start={"crank": 1.0, "der(crank)": 2.0},
        inputs={"torque": 1.5},
    )
    assert np.allclose(rows["crank"], run["crank"], rtol=0, atol=SAME)


def test_a_host_that_sets_every_start_to_what_it_is_changes_nothing(fmu, engine):
    _, variables = described(fmu)
    given = {name: float(v.start) for name, v in variables.items() if name.startswith("start(")}
    assert len(given) == 6
    rows = simulate(fmu, "CoSimulation", stop_time=1, output_interval=0.1, start_values=given)
    run = engine.simulate(until=1, rtol=1e-12, every=0.1)
    assert np.allclose(rows["crank"], run["crank"], rtol=0, atol=SAME)


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


def test_model_exchange_brings_states_back_through_singular_positions(fmu, engine):
    run = engine.simulate(until=8, rtol=1e-12, every=0.1)
    assert len(run.passages) > 2
    rows = simulate(
        fmu, "ModelExchange", stop_time=8, output_interval=0.1, output=["crank"], solver="CVode"
    )
    same = [np.flatnonzero(np.isclose(rows["time"], t))[-1] for t in run.t]
    assert np.allclose(rows["crank"][same], run["crank"], rtol=0, atol=1e-4)


def test_a_state_that_an_integrator_only_tries_may_be_followed_by_another(fmu):
    one = Instance(fmu, fmpy.extract(fmu), "modelExchange")
    one.begin()
    n = 6
    states, slopes = (c_double * n)(), (c_double * n)()
    one.of.getContinuousStates(states, n)
    good = list(states)
    one.set_states([np.nan] + good[1:])
    with pytest.raises(FMICallException) as failure:
        one.slopes(slopes)
    assert failure.value.status == 2
    for name in ("der(der(crank))", "power", "event(top)", "kinetic"):
        with pytest.raises(FMICallException) as failure:
            one.get(name)
        assert failure.value.status == 2, name
    one.set_states(good)
    one.slopes(slopes)
    assert list(slopes)[:3] == good[3:]
    one.of.terminate()
    one.of.freeInstance()


class Instance:
    """An instance for calls one by one, by the same names for both versions."""

    def __init__(self, fmu, folder, kind="coSimulation"):
        description, variables = described(fmu)
        self.names = {name: variable.valueReference for name, variable in variables.items()}
        self.is_new = description.fmiVersion == "3.0"
        classes = {
            ("coSimulation", False): fmi2.FMU2Slave,
            ("coSimulation", True): fmi3.FMU3Slave,
            ("modelExchange", False): fmi2.FMU2Model,
            ("modelExchange", True): fmi3.FMU3Model,
        }
        self.of = classes[kind, self.is_new](
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=getattr(description, kind).modelIdentifier,
            instanceName="one",
        )
        self.of.instantiate()

    def begin(self, tolerance=1e-10):
        if self.is_new:
            self.of.enterInitializationMode(tolerance=tolerance, startTime=0.0)
        else:
            self.of.setupExperiment(startTime=0.0, tolerance=tolerance)
            self.of.enterInitializationMode()
        self.of.exitInitializationMode()

    def initialise(self):
        """Enters the initialisation without what may come before."""
        self.of.enterInitializationMode()

    def step(self, t, span):
        self.of.doStep(t, span)

    def get(self, *names):
        places = [self.names[name] for name in names]
        return list((self.of.getFloat64 if self.is_new else self.of.getReal)(places))

    def set(self, name, value):
        setter = self.of.setFloat64 if self.is_new else self.of.setReal
        setter([self.names[name]], [value])

    def set_states(self, states):
        array = (c_double * len(states))(*states)
        self.of.setContinuousStates(array, len(states))

    def slopes(self, room):
        """Writes the derivatives of all states."""
        if self.is_new:
            self.of.getContinuousStateDerivatives(room, len(room))
        else:
            self.of.getDerivatives(room, len(room))

    def slope(self, unknowns, known):
        """Derivatives by one variable."""
        places = [self.names[name] for name in unknowns]
        return np.array(self.of.getDirectionalDerivative(places, [self.names[known]], [1.0]))

    def keep(self):
        return self.of.getFMUState()

    def write(self, state):
        return (self.of.serializeFMUState if self.is_new else self.of.serializeFMUstate)(state)

    def read(self, kept):
        load = self.of.deserializeFMUState if self.is_new else self.of.deSerializeFMUstate
        return load(kept)


def test_two_of_them_in_one_process_and_states_that_come_back(fmu):
    folder = fmpy.extract(fmu)
    one, two = Instance(fmu, folder), Instance(fmu, folder)
    for instance in (one, two):
        instance.begin()
    for step in range(10):
        one.step(step * 0.1, 0.1)
    state = one.keep()
    kept = one.write(state)
    for step in range(10):
        two.step(step * 0.1, 0.1)
    assert one.get("crank") == two.get("crank")
    one.step(1.0, 0.5)
    ahead = one.get("crank")
    one.of.setFMUState(state)
    assert one.get("crank") == two.get("crank")
    one.step(1.0, 0.5)
    assert one.get("crank") == ahead
    other = two.read(kept)
    two.of.setFMUState(other)
    two.step(1.0, 0.5)
    assert two.get("crank") == pytest.approx(ahead, abs=1e-7)
    for instance, held in ((one, state), (two, other)):
        instance.of.freeFMUState(held)
        instance.of.terminate()
        instance.of.freeInstance()


@pytest.mark.parametrize("h, stop", [(0.1, 1.0), (0.2, 2.0), (0.3, 3.0)])
def test_a_loop_of_sums_comes_to_its_end(fmu, h, stop):
    one = Instance(fmu, fmpy.extract(fmu))
    one.begin()
    t = 0.0
    while t < stop:
        span = min(h, stop - t)
        one.step(t, span)
        t += span
    assert span < 1e-15
    # A tool that multiplies may come a trifle before the time that sums have led to.
    one.step(np.nextafter(stop, 0.0), 0.0)
    assert one.get("time") == [stop]


def test_a_state_in_bytes_has_the_tolerance_of_its_run(fmu):
    folder = fmpy.extract(fmu)
    one, two = Instance(fmu, folder), Instance(fmu, folder)
    one.begin(tolerance=1e-13)
    one.step(0.0, 1.0)
    two.of.setFMUState(two.read(one.write(one.keep())))
    for instance in (one, two):
        instance.step(1.0, 7.0)
    # By the tolerance of an instance that was told none it is off by more.
    assert one.get("crank") == pytest.approx(two.get("crank"), abs=3e-10)
    plain = Instance(fmu, folder)
    plain.begin(tolerance=1e-9)
    plain.step(0.0, 8.0)
    assert abs(plain.get("crank")[0] - one.get("crank")[0]) > 2e-9


def test_calls_out_of_order_and_nonsense_are_refused_until_a_reset(fmu):
    one = Instance(fmu, fmpy.extract(fmu))
    with pytest.raises(FMICallException):
        one.step(0.0, 0.1)
    with pytest.raises(FMICallException):
        one.initialise()
    one.of.reset()
    with pytest.raises(FMICallException):
        one.set("L", float("nan"))
    one.of.reset()
    one.names["nothing"] = 10_000
    with pytest.raises(FMICallException):
        one.get("nothing")
    one.of.reset()
    one.begin()
    with pytest.raises(FMICallException):
        one.set("L", 0.6)
    one.of.reset()
    one.begin()
    with pytest.raises(FMICallException):
        one.step(3.0, 0.1)
    one.of.reset()
    one.begin()
    with pytest.raises(FMICallException):
        one.slope(["kinetic"], "crank")
    one.of.reset()
    one.begin()
    with pytest.raises(FMICallException):
        one.slope(["der(der(crank))"], "L")
    one.of.reset()
    one.begin()
    one.step(0.0, 0.1)
    one.of.freeInstance()


def test_directional_derivatives_are_those_of_central_differences(fmu, motor_fmu):
    for path in (fmu, motor_fmu):
        compare_slopes(path)


def claims(path):
    """How often an FMU says that it has directional derivatives; FMPy reads that for FMI 2.0."""
    with zipfile.ZipFile(path) as archive:
        text = archive.read("modelDescription.xml").decode()
    return len(re.findall(r'providesDirectionalDerivatives?="true"', text))


def compare_slopes(path, size=1e-5):
    """Holds directional derivatives by all states and inputs against differences."""
    description, variables = described(path)
    assert claims(path) == 2
    one = Instance(path, fmpy.extract(path), "modelExchange")
    one.begin()
    (given,) = [name for name, variable in variables.items() if variable.causality == "input"]
    derivatives = [unknown.variable for unknown in description.derivatives]
    states = [variable.derivative.name for variable in derivatives]
    unknowns = [variable.name for variable in derivatives]
    unknowns += [unknown.variable.name for unknown in description.outputs]
    unknowns += [name for name in variables if name.startswith("event(")]
    rest = np.array(one.get(*states)) + np.linspace(0.1, 0.3, len(states))

    def at(known, side):
        one.set(given, 0.7 + side * (known == given))
        one.set_states(rest + side * np.array([known == state for state in states]))
        return np.array(one.get(*unknowns))

    for known in [*states, given]:
        differences = (at(known, size) - at(known, -size)) / (2 * size)
        at(known, 0.0)
        slopes = one.slope(unknowns, known)
        assert np.allclose(slopes, differences, rtol=1e-7, atol=1e-7), known
        assert np.any(slopes != 0), known
    one.of.freeInstance()


def chain(links):
    """Bodies that turn about two axes each, with all positions in the world."""
    lines = ["mechanism Chain {", *[f"coord a{i}; coord b{i};" for i in range(links)]]
    point = "[0, 0, 0]"
    for i in range(links):
        turned = "[0, 0, -1]"
        for k in reversed(range(i + 1)):
            turned = f"rotx(a{k})*(roty(b{k})*({turned}))"
        lines += [f"let p{i} = {point} + {turned};", f"kinetic norm2(der(p{i}));"]
        point = f"p{i}"
    return "\n".join([*lines, "start { a0 = 1; b1 = 0.5; } }"])


def test_what_would_be_too_long_is_neither_claimed_nor_provided(version, tmp_path):
    source = tmp_path / "chain.mech"
    source.write_text(chain(4), encoding="utf-8")
    path = tmp_path / "chain.fmu"
    command("export", str(source), "--to", version, "--out", str(path))
    assert validate_fmu(str(path)) == []
    assert claims(path) == 0
    one = Instance(str(path), fmpy.extract(str(path)))
    one.begin()
    with pytest.raises(FMICallException):
        one.slope(["der(der(a0))"], "a0")
    one.of.freeInstance()


@pytest.mark.skipif(shutil.which("cargo") is None, reason="there is no cargo")
def test_the_sources_rebuild_it(fmu, tmp_path):
    folder = Path(fmpy.extract(fmu, unzipdir=tmp_path / "unpacked"))
    description, _ = described(fmu)
    identifier = description.coSimulation.modelIdentifier
    (library,) = folder.glob(f"binaries/*/{identifier}.*")
    before = Instance(fmu, folder)
    # The versions of the workspace, which are on the machine already.
    shutil.copy(ROOT / "Cargo.lock", folder / "sources/Cargo.lock")
    target = os.environ.get("CARGO_TARGET_DIR", str(ROOT / "target"))
    again = tmp_path / "again"
    shutil.copytree(folder, again)
    (copy,) = again.glob(f"binaries/*/{identifier}.*")
    copy.unlink()
    environment = {**os.environ, "CARGO_TARGET_DIR": f"{target}/rebuilt", "CARGO_NET_OFFLINE": "true"}
    subprocess.run(["sh", again / "sources/build.sh", copy], check=True, env=environment)
    after = Instance(fmu, again)
    for instance in (before, after):
        instance.begin()
        instance.step(0.0, 1.0)
    assert before.get("crank") == after.get("crank")
    assert library.is_file()
    for instance in (before, after):
        instance.of.freeInstance()


def test_it_is_one_file(version, tmp_path):
    with pytest.raises(subprocess.CalledProcessError) as refused:
        command("export", "slider_crank", "--to", version, "--out", str(tmp_path))
    assert "write `--out NAME.fmu`" in refused.value.stderr
