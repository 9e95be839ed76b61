"""Descriptions, names, and equations of motion against other programs."""

import os
from pathlib import Path

import numpy as np
import pytest
import scipy.integrate
import sympy
import sympy.physics.mechanics as mechanics
from conftest import ENGINE, ROOT, command

import bricard


def test_a_mechanism_tells_what_it_has(engine):
    assert engine.name == "Engine" and "dead" not in engine.docs
    assert [x.name for x in engine.coordinates] == ["crank", "rod", "slider"]
    assert engine.inputs[0] == ("torque", "N*m", "torque of the motor")
    assert [x.name for x in engine.outputs] == ["power", "pin_at.x", "pin_at.y"]
    assert engine.n == 3 and engine.r == 2
    assert "crank, rod, slider" in repr(engine)


def test_texts_files_and_libraries_are_the_same(engine, tmp_path):
    wanted = engine.simulate(until=1).q
    text = bricard.Mechanism.from_text(ENGINE, "engine")
    assert np.array_equal(text.simulate(until=1).q, wanted)
    path = command("export", str(ROOT / "tests/embedding/engine.mech"), "--to", "library")
    library = bricard.Mechanism.from_library(Path(path.strip()))
    assert np.array_equal(library.simulate(until=1).q, wanted)


def test_a_wrong_description_is_shown_with_its_line():
    with pytest.raises(bricard.DescriptionError) as wrong:
        bricard.Mechanism.from_text("mechanism A {\n    coord q: rad;\n    coord q: m;\n}\n")
    assert "3 |     coord q: m;" in str(wrong.value)
    assert "`q` is declared twice" in str(wrong.value)


def test_what_is_refused_changes_nothing(engine):
    m = engine.copy()
    m.drive({"torque": 5})
    before = m.parameters
    name = next(iter(before))
    for wrong in ({"nope": 1}, {"ms": "heavy"}, {"ms": float("nan")}):
        with pytest.raises(bricard.BricardError):
            m.set({name: 3 + before[name], **wrong})
        assert m.parameters == before
    q, v = m.assemble({"der(crank)": 2})[1:]
    power = m.energy(q, v)["power"]
    assert power == 10
    for law in (7, None, lambda t: 7.0):
        for wrong in ({"nope": 1}, {"nope": lambda t: t}):
            with pytest.raises(bricard.UnknownName):
                m.drive({"torque": law, **wrong})
            assert m.energy(q, v)["power"] == power
    m.set({name: 3 + before[name]})
    m.drive({"torque": None})
    assert m.parameters[name] == 3 + before[name]
    assert m.energy(q, v)["power"] == 0


def test_what_is_not_there_is_said(tmp_path, monkeypatch):
    with pytest.raises(bricard.CompileError, match="could not read"):
        bricard.Mechanism(tmp_path / "none.mech")
    with pytest.raises(bricard.InvalidValue, match="bricard.library.NAME"):
        bricard.Mechanism("slider_crank")
    with pytest.raises(AttributeError, match="did you mean `slider_crank`"):
        bricard.library.slider_crunk
    assert "slider_crank" in dir(bricard.library)
    other = tmp_path / "libbricard_none.so"
    other.write_text("no library")
    with pytest.raises(bricard.CompileError, match="could not be loaded"):
        bricard.Mechanism.from_library(other)
    monkeypatch.setenv("BRICARD", str(tmp_path / "none"))
    with pytest.raises(bricard.CompileError, match="cargo install"):
        bricard.library.slider_crank
    if os.name == "posix":
        monkeypatch.setenv("BRICARD", "/bin/false")
        with pytest.raises(bricard.CompileError, match="status 1"):
            bricard.library.slider_crank


def test_states_of_another_length_are_refused(engine):
    with pytest.raises(bricard.InvalidValue, match="q has 3 numbers"):
        engine.mass_matrix([1, 2])
    with pytest.raises(bricard.InvalidValue, match="v has 3 numbers"):
        engine.acceleration([1, 2, 3], [1])
    with pytest.raises(bricard.InvalidValue, match="has to be numbers"):
        engine.mass_matrix("abc")
    with pytest.raises(bricard.InvalidValue, match="infinite or NaN"):
        engine.mass_matrix([np.nan, 0, 0])
    with pytest.raises(bricard.InvalidValue, match="y holds q and v"):
        engine.rhs(0, [0, 0, 0])


def test_the_equations_of_motion_hold(engine):
    q, v = engine.project([0.3, 0.31, 0.95], [1.0, 1.1, -0.3], t=0.5)[1:]
    a, r = engine.acceleration(q, v, 0.5), engine.reactions(q, v, 0.5)
    mass, jacobian = engine.mass_matrix(q), engine.jacobian(q)
    assert np.allclose(mass @ a + r, engine.force(q, v, 0.5), atol=1e-12)
    assert np.allclose(jacobian @ a, engine.bias(q, v), atol=1e-12)
    # Reactions lie in the range of the transpose: ideal constraints do no work.
    multipliers = np.linalg.lstsq(jacobian.T, r, rcond=None)[0]
    assert np.allclose(jacobian.T @ multipliers, r, atol=1e-12)
    assert abs(engine.velocity_residual(q, v)).max() < 1e-14
    energy = engine.energy(q, v)
    assert energy["kinetic"] == pytest.approx(0.5 * v @ mass @ v, rel=1e-14)
    assert engine.output(q, v, 0.5)["power"] == pytest.approx(2 * np.sin(0.5) * v[0])


def test_scipy_integrates_the_right_hand_side(cart_pole):
    run = cart_pole.simulate(until=3, rtol=1e-11)
    start = cart_pole.assemble()
    y = np.concatenate([start.q, start.v])
    solved = scipy.integrate.solve_ivp(
        cart_pole.rhs, (0, 3), y, method="DOP853", rtol=1e-11, atol=1e-11
    )
    assert solved.success
    assert np.allclose(solved.y[:2, -1], run.end.q, rtol=0, atol=1e-8)


def test_scipy_integrates_a_closed_loop_between_singular_positions(slider_crank):
    start = slider_crank.assemble()
    y = np.concatenate([start.q, start.v])
    run = slider_crank.simulate(until=0.7, rtol=1e-11)
    assert not run.passages
    solved = scipy.integrate.solve_ivp(
        slider_crank.rhs, (0, 0.7), y, method="DOP853", rtol=1e-11, atol=1e-11
    )
    assert np.allclose(solved.y[:3, -1], run.end.q, rtol=0, atol=1e-8)


def lagrange():
    """The slider–crank of Phong & Hoang (2012), Example 1, by SymPy's own means."""
    q = mechanics.dynamicsymbols("q1:4")
    v = [x.diff() for x in q]
    names = "L1 L2 m1 m2 m3 J1 J2"
    parameters = L1, L2, m1, m2, m3, J1, J2 = sympy.symbols(names)
    g = sympy.Rational(981, 100)
    x = L1 * sympy.cos(q[0]) + L2 / 2 * sympy.cos(q[1])
    y = L1 * sympy.sin(q[0]) - L2 / 2 * sympy.sin(q[1])
    t = mechanics.dynamicsymbols._t
    kinetic = (
        (m1 * L1**2 / 4 + J1) * v[0] ** 2 / 2
        + m2 * (x.diff(t) ** 2 + y.diff(t) ** 2) / 2
        + J2 * v[1] ** 2 / 2
        + m3 * v[2] ** 2 / 2
    )
    potential = m1 * g * L1 / 2 * sympy.sin(q[0]) + m2 * g * y
    constraints = [
        L1 * sympy.cos(q[0]) + L2 * sympy.cos(q[1]) - q[2],
        L1 * sympy.sin(q[0]) - L2 * sympy.sin(q[1]),
    ]
    method = mechanics.LagrangesMethod(kinetic - potential, q, hol_coneqs=constraints)
    method.form_lagranges_equations()
    return method, [*q, *v], parameters, names.split()


def test_sympy_derives_the_same_equations(slider_crank):
    method, state, symbols, names = lagrange()
    m = slider_crank.copy()
    values = dict(zip(names, [0.4, 0.7, 1.1, 1.3, 0.6, 0.12, 0.15]))
    m.set(values)
    arguments = (*state, *symbols)
    mass = sympy.lambdify(arguments, method.mass_matrix[:, :3])
    force = sympy.lambdify(arguments, method.forcing)
    # SymPy puts the constraint forces on the other side.
    jacobian = sympy.lambdify(arguments, -method.lam_coeffs)
    rate = method.lam_coeffs.diff(mechanics.dynamicsymbols._t)
    bias = sympy.lambdify(arguments, rate * sympy.Matrix(state[3:]))
    random = np.random.default_rng(7)
    for _ in range(20):
        q, v = random.uniform(-2, 2, 3), random.uniform(-3, 3, 3)
        at = (*q, *v, *(values[name] for name in names))
        assert np.allclose(m.mass_matrix(q), mass(*at), rtol=1e-13, atol=1e-13)
        assert np.allclose(m.force(q, v), np.ravel(force(*at)), rtol=1e-12, atol=1e-12)
        assert np.allclose(m.jacobian(q), jacobian(*at), rtol=1e-13, atol=1e-13)
        assert np.allclose(m.bias(q, v), np.ravel(bias(*at)), rtol=1e-12, atol=1e-12)
