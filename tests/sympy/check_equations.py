#!/usr/bin/env python3
"""Derived equations against SymPy.

Usage: check_equations.py PATH/TO/bricard

For each mechanism the energies, forces and constraints are typed anew below, in
SymPy, from the mechanics and not from the description. SymPy derives M, the
Christoffel matrix C, C q', h, Q, g, G, b and p2 from them, and every entry must be
symbolically equal to the one that `bricard show NAME` prints. One line for each
matrix; exit status 1 if an entry differs.
"""

import re
import subprocess
import sys

import sympy as sp
from sympy import Rational, cos, sin

t = sp.Symbol("t")
g = Rational("9.81")
half = Rational(1, 2)


class Planar:
    """A mechanism as mechanics has it: coordinates, energies, forces, constraints."""

    def __init__(self, coordinates, kinetic, potential, constraints=(), work=(), loss=0):
        self.q = coordinates
        self.v = [rate(x) for x in coordinates]
        self.kinetic = kinetic
        self.potential = potential
        self.constraints = list(constraints)
        self.work = list(work)
        self.loss = loss


def rate(e):
    """The total time derivative of an expression of coordinates and time."""
    e = sp.sympify(e)
    if e.is_Symbol and e.name.startswith("q_"):
        return sp.Symbol("der_" + e.name[2:])
    chain = [sp.diff(e, x) * rate(x) for x in e.free_symbols if x.name.startswith("q_")]
    return sp.diff(e, t) + sum(chain)


def coordinates(names):
    return [sp.Symbol("q_" + name) for name in names.split()]


def symbols(names):
    return sp.symbols(names)


def square(point):
    return sum(rate(x) ** 2 for x in point)


def derive(m):
    """Every array by its name, from Lagrange's equations of the second kind."""
    n, v, q = len(m.q), m.v, m.q
    mass = sp.hessian(sp.expand(m.kinetic), v)

    def christoffel(i, j):
        slopes = [
            sp.diff(mass[i, j], q[k]) + sp.diff(mass[i, k], q[j]) - sp.diff(mass[j, k], q[i])
            for k in range(n)
        ]
        return half * sum(slope * v[k] for k, slope in enumerate(slopes))

    coriolis = sp.Matrix(n, n, christoffel)
    applied = [-sp.diff(m.loss, x) for x in v]
    for force, place in m.work:
        applied = [a + force * sp.diff(place, x) for a, x in zip(applied, q)]
    arrays = {
        "M": mass,
        "C": coriolis,
        "Cv": coriolis * sp.Matrix(v),
        "h": sp.Matrix([sp.diff(m.potential, x) for x in q]),
        "Q": sp.Matrix(applied),
    }
    turning = mass.applyfunc(rate) - 2 * coriolis
    assert sp.simplify(turning + turning.T).is_zero_matrix, "M' - 2C is not skew"
    if m.constraints:
        closure = sp.Matrix(m.constraints)
        slope = closure.jacobian(q)
        drift = closure.diff(t)
        arrays |= {
            "g": closure,
            "G": slope,
            "b": drift,
            "p2": -(slope.applyfunc(rate) * sp.Matrix(v) + drift.applyfunc(rate)),
        }
    return arrays


def slider_crank(moment=None):
    """Crank 1, rod 2 (angle downwards), slider 3; centres of mass half way."""
    q1, q2, q3 = coordinates("q1 q2 q3")
    L1, L2, m1, m2, m3, J1, J2 = symbols("L1 L2 m1 m2 m3 J1 J2")
    pin = sp.Matrix([L1 * cos(q1), L1 * sin(q1)])
    end = pin + L2 * sp.Matrix([cos(q2), -sin(q2)])
    first, second = pin / 2, (pin + end) / 2
    kinetic = half * (
        m1 * square(first)
        + J1 * rate(q1) ** 2
        + m2 * square(second)
        + J2 * rate(q2) ** 2
        + m3 * rate(q3) ** 2
    )
    potential = g * (m1 * first[1] + m2 * second[1])
    work = [(moment, q1)] if moment is not None else []
    return Planar([q1, q2, q3], kinetic, potential, [end[0] - q3, end[1]], work)


def double_four_bar():
    q = coordinates("q1 q2 q3 q4 q5")
    L, e, m, J = (symbols(f"{x}1:6") for x in "LemJ")
    first, second = symbols("L01 L02")
    foot = [sp.zeros(2, 1), None, sp.Matrix([first, 0]), None, sp.Matrix([first + second, 0])]
    along = [sp.Matrix([cos(x), sin(x)]) for x in q]
    foot[1] = L[0] * along[0]
    foot[3] = foot[2] + L[2] * along[2]
    centre = [foot[i] + e[i] * along[i] for i in range(5)]
    kinetic = half * sum(m[i] * square(centre[i]) + J[i] * rate(q[i]) ** 2 for i in range(5))
    potential = g * sum(m[i] * centre[i][1] for i in range(5))
    tip = [foot[i] + L[i] * along[i] for i in range(5)]
    closures = [*(tip[1] - tip[2]), *(tip[3] - tip[4])]
    return Planar(q, kinetic, potential, closures)


def four_bar():
    q1, q2, q3 = coordinates("q1 q2 q3")
    L0, L1, L2, L3, m1, m2, m3, J1, J2, J3 = symbols("L0 L1 L2 L3 m1 m2 m3 J1 J2 J3")
    u = sp.Symbol("u")
    pin = L1 * sp.Matrix([cos(q1), sin(q1)])
    joint = sp.Matrix([L0 + L3 * cos(q3), L3 * sin(q3)])
    coupler = pin + L2 * sp.Matrix([cos(q2), sin(q2)])
    middle = (pin + coupler) / 2
    kinetic = half * (
        J1 * rate(q1) ** 2
        + m2 * square(middle)
        + J2 * rate(q2) ** 2
        + m3 * square(joint / 2)
        + J3 * rate(q3) ** 2
    )
    potential = g * (m1 * pin[1] / 2 + m2 * middle[1] + m3 * joint[1] / 2)
    return Planar([q1, q2, q3], kinetic, potential, list(coupler - joint), [(u, q1)])


def double_pendulum():
    q1, q2 = coordinates("q1 q2")
    L1, L2, m1, m2, J1, J2 = symbols("L1 L2 m1 m2 J1 J2")
    pin = L1 * sp.Matrix([sin(q1), -cos(q1)])
    second = pin + L2 / 2 * sp.Matrix([sin(q2), -cos(q2)])
    kinetic = half * (
        m1 * square(pin / 2) + J1 * rate(q1) ** 2 + m2 * square(second) + J2 * rate(q2) ** 2
    )
    return Planar([q1, q2], kinetic, g * (m1 * pin[1] / 2 + m2 * second[1]))


def cart_pole():
    x, phi = coordinates("x phi")
    m1, m2, e, J, d, u = symbols("m1 m2 e J d u")
    centre = sp.Matrix([x + e * sin(phi), e * cos(phi)])
    kinetic = half * (m1 * rate(x) ** 2 + m2 * square(centre) + J * rate(phi) ** 2)
    loss = half * d * rate(x) ** 2
    return Planar([x, phi], kinetic, m2 * g * centre[1], work=[(u, x)], loss=loss)


def driven_pivot():
    y, phi = coordinates("y phi")
    A, w, m, e, J, d = symbols("A w m e J d")
    centre = sp.Matrix([e * sin(phi), y + e * cos(phi)])
    kinetic = half * (m * square(centre) + J * rate(phi) ** 2)
    loss = half * d * rate(phi) ** 2
    return Planar([y, phi], kinetic, m * g * centre[1], [y - A * cos(w * t)], loss=loss)


MECHANISMS = {
    "slider_crank": slider_crank(),
    "slider_crank_driven": slider_crank(sp.Symbol("u")),
    "double_four_bar": double_four_bar(),
    "four_bar": four_bar(),
    "double_pendulum": double_pendulum(),
    "cart_pole": cart_pole(),
    "driven_pivot": driven_pivot(),
}

# What Phong & Hoang (2012) print for Example 2, with the misprint of m12 corrected:
# (array, row, column, entry). Their C has the entries of sin(q1 - q2).
PAPER = [
    ("M", 1, 1, "J1 + m1*e1**2 + m2*L1**2"),
    ("M", 1, 2, "m2*L1*e2*cos(q1 - q2)"),
    ("M", 3, 4, "m4*L3*e4*cos(q3 - q4)"),
    ("M", 5, 5, "J5 + m5*e5**2"),
    ("C", 1, 2, "m2*L1*e2*sin(q1 - q2)*der(q2)"),
    ("C", 2, 1, "-m2*L1*e2*sin(q1 - q2)*der(q1)"),
    ("C", 3, 4, "m4*L3*e4*sin(q3 - q4)*der(q4)"),
]


def read(text, names):
    """An expression as `bricard show` prints it: `^` is a power, `der(x)` a symbol,
    decimals are exact."""
    text = re.sub(r"der\(([^()]*)\)", lambda found: "der_" + found[1], text.replace("^", "**"))
    known = {name: sp.Symbol("q_" + name) for name in names}
    for name in re.findall(r"[A-Za-z_]\w*(?![\w(])", text):
        known.setdefault(name, sp.Symbol(name))
    known |= {"sin": sin, "cos": cos}
    exact = re.sub(r"(?<![\w.])(\d+\.\d+(?:e-?\d+)?)", r'Rational("\1")', text)
    exact = re.sub(r"(?<![\w.\"*])(\d+)(?![\w.\"])", r"Integer(\1)", exact)
    return eval(exact, {"Rational": Rational, "Integer": sp.Integer}, known)


def shown(binary, name, names):
    """The arrays that the command prints, entry by entry."""
    run = subprocess.run([binary, "show", name], capture_output=True, text=True, check=True)
    arrays = {}
    for line in run.stdout.splitlines():
        found = re.fullmatch(r"(\w+)\[(\d+)(?:,(\d+))?\] = (.*)", line.strip())
        if found:
            array, row, column, entry = found.groups()
            arrays.setdefault(array, {})[int(row), int(column or 1)] = read(entry, names)
    return arrays


def equal(a, b):
    return sp.simplify(sp.expand(sp.expand_trig(a - b))) == 0


def compare(name, array, found, exact):
    """Whether an array is what it should be; says so."""
    places = {(i + 1, j + 1) for i in range(exact.rows) for j in range(exact.cols)}
    if set(found) != places:
        print(f"{name} {array}: entries {sorted(set(found) ^ places)} are missing or too many")
        return False
    wrong = [place for place in sorted(places) if not equal(found[place], exact[place[0] - 1, place[1] - 1])]
    verdict = f"entries {wrong} differ" if wrong else "equal"
    print(f"{name} {array} ({exact.rows} x {exact.cols}): {verdict}")
    return not wrong


def main(binary):
    good = True
    for name, mechanism in MECHANISMS.items():
        names = [x.name[2:] for x in mechanism.q]
        arrays = shown(binary, name, names)
        for array, exact in derive(mechanism).items():
            good &= compare(name, array, arrays.get(array, {}), exact)
        if name == "double_four_bar":
            printed = [equal(arrays[a][i, j], read(entry, names)) for a, i, j, entry in PAPER]
            print(f"{name} as the paper prints it: {'equal' if all(printed) else 'differs'}")
            good &= all(printed)
    return 0 if good else 1


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
