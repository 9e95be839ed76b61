//! What a formula may contain where it stands.

use super::{accept, refuse_each, refuse_saying, with};

#[test]
fn the_kinetic_energy_is_quadratic_in_the_velocities() {
    let table = "
        kinetic q*der(q)^2 + der(w)^3; ⇒ 1:86: error: the kinetic energy has to be quadratic
        kinetic sin(der(q)); ⇒ has to be quadratic in the velocities
        kinetic 1/der(q); ⇒ has to be quadratic in the velocities
        kinetic der(q)^1.5; ⇒ has to be quadratic in the velocities
        let v = der(q)^2; kinetic v*der(w); ⇒ has to be quadratic in the velocities
    ";
    refuse_each(with, table);
}

#[test]
fn terms_of_lower_degree_in_the_velocities_are_kinetic_energy_too() {
    let m = accept(&with(
        "kinetic t*der(q); kinetic sin(w)*q^2; kinetic norm([der(q), der(w)])^2; kinetic der(q)^3/der(q);",
    ));
    assert_eq!(m.kinetic.len(), 5);
}

#[test]
fn the_potential_energy_knows_no_velocities() {
    refuse_saying(
        &with("potential q^2 + der(q);"),
        "the potential energy can't contain a velocity",
    );
    refuse_saying(
        &with("let v = der(q); potential v^2;"),
        "terms with `der(…)` belong in `kinetic`",
    );
}

#[test]
fn energies_and_constraints_are_smooth() {
    for formula in [
        "abs(q)",
        "sign(q)",
        "min(q, w)",
        "max(q, w)",
        "if q < w then q else w",
    ] {
        for statement in [
            "kinetic der(q)^2*X;",
            "potential X;",
            "dissipation der(q)^2*X;",
            "constraint X = 0;",
        ] {
            let statement = statement.replace('X', &format!("({formula})"));
            refuse_saying(&with(&statement), "has to be smooth, this is non-smooth");
        }
        let allowed = "input u = X; force X*u on q; output y = X; event e: X rising;"
            .replace('X', &format!("({formula})"));
        accept(&with(&allowed));
    }
}

#[test]
fn a_choice_between_known_numbers_is_smooth() {
    accept(&with(
        "const N = 2; potential if N == 2 then q^2 else w^2; for i in 0..2 { constraint (if i == 0 then q else w) = t; }",
    ));
}

#[test]
fn inputs_act_through_forces_alone() {
    let table = "
        input u = 1; kinetic u*der(q)^2; ⇒ the kinetic energy can't contain an input
        input u = 1; potential u*q; ⇒ an input acts by `force u on x`
        input u = 1; constraint q = u; ⇒ a constraint can't contain an input
        input u = 1; output y = der(u); ⇒ the derivative of an input is not known
    ";
    refuse_each(with, table);
    accept(&with(
        "input u = 1; dissipation u*der(q)^2; output y = u; event e: u rising;",
    ));
}

#[test]
fn constraints_are_linear_in_the_velocities() {
    let table = "
        constraint der(q)^2 = 1; ⇒ linear in the velocities
        constraint der(q)*der(w) = 1; ⇒ linear in the velocities
        constraint sin(der(q)) = 0; ⇒ linear in the velocities
    ";
    refuse_each(with, table);
    accept(&with("constraint der(q)^2/der(q) = der(w);"));
}

#[test]
fn a_constraint_restricts_coordinates() {
    refuse_saying(&with("constraint 1 = 2;"), "left minus right is -1");
    refuse_saying(
        &with("param a = 1; constraint a = t;"),
        "this equation contains no coordinate",
    );
}

#[test]
fn accelerations_stand_in_outputs_alone() {
    let m = accept(&with(
        "let v = der(q); output y = q*der(v) + 1; output z = v;",
    ));
    let accelerated: Vec<bool> = m.outputs.iter().map(|o| o.accelerated).collect();
    assert_eq!(accelerated, [true, false]);
    for (statement, what) in [
        ("kinetic q*der(der(q));", "an energy"),
        ("force der(der(q)) on q;", "a force"),
        ("force 1 on der(der(q));", "what a force works on"),
        ("constraint der(der(q)) = 0;", "a constraint"),
        (
            "input u = der(der(q)); force u on q;",
            "the law of an input",
        ),
        ("event e: der(der(q)) rising;", "an event function"),
        ("start { der(der(q)) = 0; }", "the start"),
    ] {
        let said = format!("{what} can't contain an acceleration");
        refuse_saying(&with(statement), &said);
    }
    refuse_saying(
        &with("draw circle([der(der(q)), 0], 1);"),
        "a picture shows positions",
    );
    refuse_saying(
        &with("output jerk = der(der(der(q)));"),
        "the derivative of an acceleration is not known",
    );
}

#[test]
fn states_act_by_forces_alone() {
    let m = accept(&with(
        "state z: m; der(z) = 1 - z - q; input u = z; force u*z on q; start { z = 2; } \
         output y = z; output rate = der(z); event e: z rising; dissipation z^2*der(q)^2;",
    ));
    assert_eq!(m.states, 1);
    assert_eq!(m.coordinates.last().map(|q| q.name.as_str()), Some("z"));
    assert!(m.outputs[1].accelerated && !m.outputs[0].accelerated);
    let start = m.starts.last().map(|start| start.velocity);
    assert_eq!(start, Some(true));
    for (statement, said) in [
        ("kinetic z^2;", "the kinetic energy can't contain a state"),
        (
            "potential z*q;",
            "the potential energy can't contain a state",
        ),
        ("constraint q = z;", "a constraint can't contain a state"),
        ("force 1 on z;", "a force can't work on a state"),
        (
            "start { z*q = 1; }",
            "an equation of the start can't contain a state",
        ),
        ("start { q = z; }", "a start value is built of numbers"),
        ("draw circle([z, 0], 1);", "a picture shows positions"),
        ("der(q) = 1;", "this is a coordinate, not a state"),
        ("der(q + z) = 1;", "only a state has a rate that is written"),
        ("der(z) = 2;", "this state has a rate already"),
        (
            "force der(z) on q;",
            "a force can't contain `der(…)` of a state",
        ),
    ] {
        let text = format!("state z; der(z) = 1 - z; force z on q; {statement}");
        refuse_saying(&with(&text), said);
    }
    let table = "
        state z; force z on q; ⇒ the state `z` has no rate
        param k: N = 1; state z: m; der(z) = k; force z on q; ⇒ the rate of this state is in m/s, this is in N
        state z; der(z) = [1, 2]; force z on q; ⇒ this is a number, its rate a vector
        state z = 1; ⇒ a state has no value of its own
        der(z) + 1 = 2; ⇒ expected `=`
    ";
    refuse_each(with, table);
}

#[test]
fn states_stand_in_arrays_loops_and_parts() {
    let m = accept(&with(
        "const N = 2; state z[N]; for i in 0..N { der(z[i]) = i - z[i]; force z[i] on q; } \
         part Lag(goal) { state f; der(f) = goal - f; } let slow = Lag(q); force slow.f on q; \
         state p[2]; der(p) = [q, 1]; force p[0] on q;",
    ));
    let states = m.coordinates.iter().skip(m.freedoms());
    let names: Vec<&str> = states.map(|q| q.name.as_str()).collect();
    assert_eq!(names, ["z[0]", "z[1]", "slow.f", "p[0]", "p[1]"]);
}

#[test]
fn forces_work_on_what_moves() {
    let table = "
        force 1 on der(q); ⇒ a force can't work on a velocity
        param a = 1; force 1 on a; ⇒ this force does no work
        input u = 1; force 1 on u*q; ⇒ a force can't work on an input
        force 1 on abs(q); ⇒ has to be differentiable
        force 1 on [q, w]; ⇒ the force is a number, it works on a vector of 2 components
        force rotz(q) on rotz(w); ⇒ the force is a 3 × 3 matrix
    ";
    refuse_each(with, table);
}

#[test]
fn dissipation_needs_a_velocity() {
    refuse_saying(
        &with("dissipation q^2;"),
        "the dissipation function needs a velocity",
    );
}

#[test]
fn what_is_not_finite_is_refused() {
    let table = "
        let a = 1/0; ⇒ division by zero
        let a = q/(w - w); ⇒ division by zero
        const N = 0; let a = q/N; ⇒ division by zero
        let a = 0^-1; ⇒ a negative power of zero
        let a = sqrt(-1); ⇒ `sqrt` has no finite value at -1
        let a = ln(0)*q; ⇒ `ln` has no finite value at 0
        let a = asin(2); ⇒ `asin` has no finite value at 2
        let a = (-8)^(1/3); ⇒ this is not a real number
        let a = 1e300*1e300; ⇒ this is not a finite number
        let a = 1e300*q*1e300; ⇒ this is not a finite number
        let a = exp(1e3); ⇒ `exp` has no finite value at 1000
    ";
    refuse_each(with, table);
}

#[test]
fn huge_numbers_and_exponents_are_refused() {
    let table = "
        let a = 1e999; ⇒ `1e999` is too large or too small
        let a = 1e-999; ⇒ is too large or too small
        let a = 1e99999999999999; ⇒ is too large or too small
    ";
    refuse_each(with, table);
    refuse_saying(
        &with(&format!("let a = 1{};", "0".repeat(400))),
        "is too large or too small",
    );
    let table = "
        let a = q^1001; ⇒ an exponent above 1000
        let a = ((q^1000)^1000)^1000; ⇒ a power above 1000000
        let a = q^1000; let b = a^1000; let c = b*b; ⇒ a power above 1000000
    ";
    refuse_each(with, table);
    accept(&with(
        "let a = 1e-300*q; let b = 123456789012345678901234567890*q; output c = a + b;",
    ));
}
