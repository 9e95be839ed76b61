//! What is legal but probably not meant is said, and nothing is said of what is
//! meant.

use super::mechanisms::library;
use bricard_codegen::CompileSettings;
use bricard_codegen::internals::examine;

/// The warnings about a description, rendered.
fn lints(source: &str) -> String {
    match examine(source, &CompileSettings::default()) {
        Ok((_, warnings)) => warnings.render("test.mech", source),
        Err(errors) => panic!("{}", errors.render("test.mech", source)),
    }
}

/// A mechanism of a point and an angle, and more statements.
fn with(statements: &str) -> String {
    format!(
        "mechanism Test {{ coord x; coord y; coord phi; kinetic der(x)^2 + der(y)^2 + der(phi)^2; {statements} }}"
    )
}

fn says(statements: &str, words: &[&str]) {
    let found = lints(&with(statements));
    for word in words {
        assert!(found.contains(word), "no `{word}` in\n{found}");
    }
}

fn is_silent(statements: &str) {
    assert_eq!(lints(&with(statements)), "");
}

#[test]
fn a_coordinate_without_inertia_is_named_unless_a_constraint_ties_it() {
    let idle = "coord z; potential z^2;";
    says(idle, &["`z` can move without kinetic energy"]);
    is_silent("coord z; potential z^2; constraint z = x + y^2;");
    let pair = "coord a; coord b; kinetic (der(a) + der(b))^2;";
    says(pair, &["can move without kinetic energy"]);
}

#[test]
fn a_negative_kinetic_energy_is_told_once_with_what_makes_it_negative() {
    let massive = |value: &str| {
        format!("param m = {value}; coord z; kinetic m*der(z)^2; potential z^2; constraint z = x;")
    };
    let found = lints(&format!(
        "mechanism Test {{ coord x; kinetic der(x)^2; {} }}",
        massive("-3")
    ));
    assert_eq!(found.matches("warning").count(), 1, "{found}");
    assert!(
        found.contains("the kinetic energy is negative where `z` moves"),
        "{found}"
    );
    assert!(found.contains("kinetic m*der(z)^2"), "{found}");
    says(
        "coord z; kinetic der(x)*der(z); potential z^2;",
        &["negative where"],
    );
    is_silent(&massive("3"));
}

#[test]
fn energies_of_a_chain_without_entries_of_its_mass_matrix_are_looked_at() {
    let chain = |last: &str, inertia: &str| {
        lints(&format!(
            "mechanism Chain {{
                const N = 40;
                coord phi[N]; coord idle;
                let joint[i in 0..N] = if i == 0 then [sin(phi[0]), cos(phi[0])]
                    else joint[i-1] + [sin(phi[i]), cos(phi[i])];
                for i in 0..N {{ kinetic (if i == N-1 then {last} else 1)*norm2(der(joint[i])); }}
                kinetic {inertia}*der(idle)^2; potential idle^2;
            }}"
        ))
    };
    assert_eq!(chain("1", "1"), "");
    let negative = chain("-41", "1");
    assert!(
        negative.contains("the kinetic energy is negative where"),
        "{negative}"
    );
    let idle = chain("1", "0");
    assert!(
        idle.contains("`idle` can move without kinetic energy"),
        "{idle}"
    );
}

#[test]
fn an_equation_whose_derivatives_vanish_where_it_holds_is_named() {
    for flat in ["1 - cos(phi) = 0", "(x - y)^2 = 0", "x^2 + y^2 = 0"] {
        says(
            &format!("constraint {flat};"),
            &["derivatives of", flat, "vanish"],
        );
    }
    let near = "(x - y)^2 = 1e-10";
    for fine in [
        "sin(phi) = x",
        "x^2 + y^2 = 1",
        "x*y = 1/2",
        "x^3 + x = y",
        near,
    ] {
        is_silent(&format!("constraint {fine}; start {{ x ~ 0.6; y ~ 0.8; }}"));
    }
}

#[test]
fn an_equation_that_follows_from_others_is_named_with_them() {
    let redundant =
        "constraint x = sin(phi); constraint y = 1 - cos(phi); constraint x^2 + (y - 1)^2 = 1;";
    says(redundant, &["`x^2 + (y - 1)^2 = 1` follows", "from this"]);
    // Singular at the start alone.
    is_silent("constraint x = sin(phi); constraint y = x*phi;");
}

#[test]
fn a_start_that_cannot_be_assembled_is_told_with_what_each_equation_lacks() {
    let far = "constraint x = 2 + sin(phi); constraint y = x; start { x = 0; }";
    says(
        far,
        &["the start can't be assembled", "left minus right stays -1"],
    );
    is_silent("constraint x = 2 + sin(phi); constraint y = x; start { x = 2.5; }");
    let fast = "constraint x = y; start { der(x) = 1; der(y) = 2; }";
    says(
        fast,
        &["held velocities contradict", "left minus right stays -1"],
    );
    is_silent("constraint x = y; start { der(x) = 1; der(y) ~ 2; }");
}

#[test]
fn a_constraint_without_value_or_derivative_where_a_motion_begins_is_named() {
    let rate = "this has no finite derivative at the start";
    let value = "this is not finite at the start";
    says("constraint norm([x, y]) = 1;", &[rate, "norm([x, y]) = 1"]);
    says("constraint sqrt(x) = y;", &[rate]);
    says("constraint atan2(y, x) = 1;", &[rate]);
    says("constraint 1/x = y;", &[value]);
    says("constraint ln(x) = y; start { x = -1; }", &[value]);
    is_silent("constraint norm([x, y]) = 1; start { y ~ 0.1; }");
    // The guess is moved before the constraint is looked at.
    is_silent("constraint norm([x, y]) = 1; start { x + y ~ 0.5; }");
}

#[test]
fn a_dissipation_without_derivative_at_the_velocities_of_the_start_is_named() {
    let friction = "dissipation norm([der(x), der(y)]);";
    let rate = "this has no finite derivative at the start";
    says(friction, &[rate, "norm([der(x), der(y)])"]);
    says(&format!("{friction} constraint x = y;"), &[rate]);
    is_silent(&format!("{friction} start {{ der(y) = 1; }}"));
    is_silent(&format!(
        "{friction} constraint x = y; start {{ der(y) = 1; }}"
    ));
    is_silent("dissipation sqrt(der(x)^2 + 1e-8);");
}

#[test]
fn no_mechanism_of_the_library_will_hinder_its_simulation() {
    for (path, source) in library() {
        let found = lints(&source);
        let grave = found.lines().filter(|line| line.contains("warning:"));
        let grave: Vec<_> = grave
            .filter(|line| !line.contains(" follows from "))
            .collect();
        assert!(grave.is_empty(), "{}: {grave:?}", path.display());
    }
}
