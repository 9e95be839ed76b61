//! Units where they are given.

use super::{accept, refuse_each, refuse_saying};

/// A slider and a crank with units, and more statements.
fn with(statements: &str) -> String {
    format!(
        "mechanism Test {{ const g: m/s^2 = 9.81; param L: m = 1; param m: kg = 2; param J: kg*m^2 = 1;
        param k: N/m = 3; param c: N*s/m = 1; param free = 1; coord x: m; coord phi: rad;
        kinetic 1/2*m*der(x)^2 + 1/2*J*der(phi)^2;
        {statements} }}"
    )
}

#[test]
fn sums_have_one_unit() {
    let table = "
        let a = L + m; ⇒ this sum mixes m and kg
        let a = 2*L - J/m; ⇒ this sum mixes m and m^2
        let a = [L, L] + [x, phi]; ⇒ this sum mixes m and no unit
        let a = L + phi; ⇒ this is in m
    ";
    refuse_each(with, table);
    accept(&with(
        "let a = L + x - 0.1 + sqrt(J/m) + L*cos(phi) + norm([L, x]); output b: m = a;",
    ));
}

#[test]
fn a_unit_of_several_that_are_not_si_is_written_anew_as_a_whole() {
    for (unit, si, factor) in [
        ("km/h", "m/s", "1e3/3600"),
        ("kN/mm^2", "N/m^2", "1e3/(1e-3)^2"),
        ("1/(mm*g)", "1/(m*kg)", "1/(1e-3*1e-3)"),
        ("rpm/ms", "(rad/s)/s", "(2*pi/60)/1e-3"),
        ("Nm/ms", "(N*m)/s", "1/1e-3"),
    ] {
        let help = format!("write SI: `{si}`, and multiply the value by `{factor}`");
        refuse_saying(&with(&format!("param a: {unit} = 2;")), &help);
        accept(&with(&format!(
            "const a: {si} = 2*{factor}; output b: {si} = a;"
        )));
    }
}

#[test]
fn functions_take_angles_and_ratios() {
    let table = "
        let a = sin(L); ⇒ the argument of `sin` is in m
        let a = exp(m*g); ⇒ the argument of `exp` is in N
        let a = rotz(x); ⇒ the angle of a rotation is in m
        let a = L^phi; ⇒ the exponent of what has a unit is a number
        let a = 2^L; ⇒ an exponent has no unit
        let a = atan2(L, m); ⇒ `atan2` mixes m and kg
        let a = max(L, m); ⇒ `max` mixes m and kg
        output a = if L < m then 1 else 2; ⇒ this comparison mixes m and kg
        output a = if L < x then L else m; ⇒ this choice mixes m and kg
    ";
    refuse_each(with, table);
    accept(&with(
        "output a: rad = atan2(x, L) + asin(x/L) + 45*deg; output b = sin(2*t) + cos(phi + pi/4);",
    ));
}

#[test]
fn energies_are_in_joules_and_dissipation_in_watts() {
    let table = "
        kinetic m*der(x); ⇒ the kinetic energy is in J, this is in N*s
        potential m*g; ⇒ the potential energy is in J, this is in N
        dissipation c*der(x); ⇒ the dissipation function is in W, this is in N
    ";
    refuse_each(with, table);
    accept(&with(
        "potential m*g*x + 1/2*k*(x - 0.3)^2; dissipation 1/2*c*der(x)^2;",
    ));
}

#[test]
fn forces_fit_what_they_work_on() {
    let table = "
        force k on x; ⇒ this force is in N/m, here it has to be in N
        force m*g on phi; ⇒ this force is in N, here it has to be in N*m
        force [m*g, m] on [x, L]; ⇒ this force is in kg, here it has to be in N
    ";
    refuse_each(with, table);
    accept(&with(
        "force m*g on x; force m*g*L on phi; force [0, -m*g] on [x, L*sin(phi)]; force 3 on x;",
    ));
}

#[test]
fn both_sides_of_an_equation_have_one_unit() {
    let table = "
        constraint x = phi; ⇒ this equation mixes m and no unit
        constraint der(x) = x; ⇒ this equation mixes m/s and m
        start { x = 45*deg; } ⇒ this equation mixes m and no unit
        param a: m = m*2; ⇒ the default of a parameter is built of
        const a: m = g; ⇒ `a` is declared in m, its value is in m/s^2
        output a: m = phi; ⇒ `a` is declared in m, its value has no unit
        input u: N = k; ⇒ `u` is declared in N, its value is in N/m
    ";
    refuse_each(with, table);
    accept(&with(
        "constraint x = L*phi; constraint der(x) = L*der(phi); start { x = 0.5; der(phi) = 3; }",
    ));
}

#[test]
fn a_symbol_without_unit_switches_the_check_off() {
    accept(&with(
        "potential free*phi; constraint x + free*phi = m; let a = sin(free*L); force free on x; output b: kg = a;",
    ));
    accept(&with("output a: m = 5*t; constraint x = L*sin(2*t);"));
}

#[test]
fn numbers_in_the_law_of_an_input_are_gains() {
    accept(&with(
        "input u: N*m = 10 - 2*der(phi); input f: N = -20*x - 3*der(x); force u on phi; force f on x;",
    ));
    refuse_saying(
        &with("input f: N = -k*x - c*x;"),
        "this sum mixes N and N*s",
    );
}

#[test]
fn derivatives_are_per_second() {
    accept(&with(
        "output v: m/s = der(x); output w: 1/s = omega(rotz(phi)).z; output f: Hz = der(phi);",
    ));
    refuse_saying(&with("output v: m = der(x);"), "its value is in m/s");
}

#[test]
fn roots_and_powers_of_units_are_units() {
    accept(&with(
        "output a: m = sqrt(L*x); output b: m^3 = L^2*x; output c: 1/m = L^-1; output d: m = (L^3)^(1/3);",
    ));
    refuse_saying(&with("output a: m = sqrt(L);"), "its value is in m^(1/2)");
}

#[test]
fn units_are_products_and_quotients_of_names() {
    accept(&with(
        "output a: kg*m^2/s^2 = L*m*g; output b: N/(m/s) = c; output c2: s^-2 = g/L; output e: J/rad = m*g*L; output f: 1 = x/L;",
    ));
    let table = "
        output a: m*x = 1; ⇒ unknown unit `x`
        output a: m^2.5 = 1; ⇒ expected a whole exponent
        output a: m^99 = 1; ⇒ lies between -30 and 30
        output a: = 1; ⇒ expected a unit
    ";
    refuse_each(with, table);
}

#[test]
fn units_that_hide_a_factor_are_refused() {
    let table = "
        param a: mm = 1; ⇒ write SI: `m`, and multiply the value by `1e-3`
        param a: deg = 1; ⇒ write SI: `rad`, and multiply the value by `deg`
        param a: N/mm = 1; ⇒ write SI: `m`, and divide the value by `1e-3`
        param a: mm^4 = 1; ⇒ multiply the value by `(1e-3)^4`
        param a: N/mm^2 = 1; ⇒ divide the value by `(1e-3)^2`
        param a: rad/Nm = 1; ⇒ write `(N*m)`
        param a: Nm = 1; ⇒ `Nm` is written `N*m`
        param a: kN = 1; ⇒ `kN` is not an SI unit
    ";
    refuse_each(with, table);
}

#[test]
fn zero_fits_every_unit() {
    accept(&with(
        "let I = [[J, 0, 0], [0, 2*J, 0], [0, 0, J]]; let w = omega(rotx(phi)); kinetic 1/2*dot(w, I*w);
        output a: m = norm(rotz(phi)*[L, 0, 0] + [0, 0, x]); constraint [x, 0*L] = 0;",
    ));
}

#[test]
fn numbers_in_the_picture_are_sizes() {
    accept(&with(
        "draw line([x, 0], [x + 0.5*sin(phi), 0.5*cos(phi)]); draw circle([x + 2*phi, 0], 0.1 + L);",
    ));
}

#[test]
fn a_number_takes_the_unit_of_what_it_stands_beside() {
    accept(&with(
        "output a: m = x - 0.1 + 0.5*sin(phi); output b: m = (x*[1, 0, 0] + rotz(phi)*[0.1, 0.2, 0]).y; constraint x = 2*phi;",
    ));
    let message = "a number that is meant in m is declared: `const a: m = …;`";
    refuse_saying(&with("let a = x + sin(phi);"), message);
    refuse_saying(&with("let a = x + 45*deg;"), message);
    refuse_saying(&with("let a = L*x + 2*L;"), "this sum mixes m^2 and m");
}

#[test]
fn the_rate_of_what_a_bare_number_made_is_per_second() {
    let axis = "param m: kg = 1; param r: m = 1; param a: rad = 1; coord q: rad;
        let axis = rotz(q)*rotx(a)*[0, 0, 1];";
    let with = |energy: &str| format!("mechanism Test {{ {axis} kinetic {energy}; }}");
    accept(&with("1/2*m*r^2*norm2(der(axis))"));
    for energy in ["1/2*m*norm2(der(axis))", "1/2*m*der(q)^2"] {
        refuse_saying(&with(energy), "this is in N/m");
    }
}
