//! Models built by calls.

use super::mechanisms::library;
use bricard_codegen::compile_source;
use bricard_codegen::internals::model::Mechanism;
use bricard_codegen::internals::{analyse, syntax};
use bricard_codegen::{CompileSettings, Crossing, Drawing, Formula, Model};

/// A chain of pendulums, as a person writes it.
const CHAIN: &str = "\
/// Two pendulums, one below the other.
mechanism Chain {
    const g: m/s^2 = 9.81;
    /// length of a rod
    param L: m = 0.5;
    param m: kg = 1.25;
    param d: N*m*s = 1;
    coord q0: rad;
    coord q1: rad;
    input brake: N*m = -0.01*der(q0);
    let p0 = L*[sin(q0), -cos(q0)];
    kinetic 1/2*m*norm2(der(p0));
    potential m*g*p0.y;
    let p1 = p0 + L*[sin(q1), -cos(q1)];
    kinetic 1/2*m*norm2(der(p1));
    potential m*g*p1.y;
    dissipation 0.001*d*(der(q0) - der(q1))^2;
    force brake on q0;
    constraint q1 = 2*q0;
    start {
        q0 = 30*deg;
        q1 ~ 1;
    }
    output tip: m = p1;
    event straight: q1 - q0 falling;
    draw line([0, 0], p0, p1);
    draw trace(p1);
}
";

/// The chain of pendulums by calls, its links in a loop.
fn chain() -> Model {
    let mut model = Model::new("Chain")
        .docs("Two pendulums, one below the other.")
        .constant("g", "m/s^2", 9.81)
        .parameter("L", "m", 0.5)
        .docs("length of a rod")
        .parameter("m", "kg", 1.25)
        .parameter("d", "N*m*s", 1)
        .coordinate("q0", "rad")
        .coordinate("q1", "rad")
        .input("brake", "N*m", -Formula::from(0.01) * "der(q0)");
    let mut before: Option<Formula> = None;
    for i in 0..2 {
        let q = Formula::from(format!("q{i}"));
        let along = [Formula::call("sin", [&q]), -Formula::call("cos", [&q])];
        let rod = Formula::from("L") * Formula::vector(along);
        let place = match before {
            Some(before) => before + rod,
            None => rod,
        };
        let point = Formula::from(format!("p{i}"));
        let speed = Formula::call("norm2", [point.clone().der()]);
        model = model
            .quantity(&format!("p{i}"), place)
            .kinetic(Formula::from(1) / 2 * "m" * speed)
            .potential(format!("m*g*{point}.y"));
        before = Some(point);
    }
    let difference = Formula::from("q0").der() - Formula::from("q1").der();
    model
        .dissipation(Formula::from(0.001) * "d" * difference.powi(2))
        .force("brake", "q0")
        .constraint("q1", "2*q0")
        .held("q0", "30*deg")
        .guess("q1", 1)
        .output("tip", "m", "p1")
        .event("straight", "q1 - q0", Crossing::Falling)
        .draw(Drawing::Line, ["[0, 0]", "p0", "p1"])
        .draw(Drawing::Trace, ["p1"])
}

#[test]
fn a_mechanism_built_by_calls_is_the_one_that_a_person_wrote() {
    let text = chain().text().expect("every part is right");
    assert_eq!(text, CHAIN);
    let code = |source: &str| {
        let compiled = compile_source(source, "chain", "chain.mech", &CompileSettings::default());
        compiled.expect("the chain is right").code
    };
    assert_eq!(code(&text), code(CHAIN));
}

/// What a mechanism is made of, without its places in the file.
fn parts(m: &Mechanism) -> Vec<String> {
    let text = |e| m.graph.text(e, &|symbol| m.symbol_text(symbol));
    let named = |q: &bricard_codegen::internals::model::Quantity| {
        format!("{} {} {}", q.name, q.unit, q.docs)
    };
    let mut parts = vec![m.name.clone(), m.docs.clone()];
    parts.extend(m.coordinates.iter().map(named));
    let parameters = m.parameters.iter();
    parts.extend(parameters.map(|p| format!("{} = {}", named(&p.quantity), text(p.default))));
    let constants = m.constants.iter();
    parts.extend(constants.map(|c| format!("{} = {}", named(&c.quantity), text(c.value))));
    let inputs = m.inputs.iter();
    parts.extend(inputs.map(|u| format!("{} = {}", named(&u.quantity), text(u.law))));
    let summands = m.kinetic.iter().chain(&m.potential).chain(&m.dissipation);
    parts.extend(summands.map(|summand| text(summand.value)));
    let forces = m.forces.iter().flat_map(|f| f.force.iter().chain(&f.on));
    parts.extend(forces.map(|e| text(*e)));
    let rows = m.constraints.iter();
    parts.extend(rows.map(|row| format!("{} {}", row.holonomic, text(row.residual))));
    let starts = m.starts.iter();
    parts.extend(starts.map(|s| {
        format!(
            "{} {} {} {}",
            s.coordinate,
            s.velocity,
            s.held,
            text(s.value)
        )
    }));
    let outputs = m.outputs.iter();
    parts.extend(outputs.map(|o| format!("{} = {}", named(&o.quantity), text(o.value))));
    let events = m.events.iter();
    parts.extend(events.map(|e| format!("{} {:?} {}", e.name, e.direction, text(e.value))));
    parts.push(format!("{:?}", m.shapes));
    parts
}

#[test]
fn every_description_of_the_library_written_down_again_says_the_same() {
    for (path, source) in library() {
        let again = syntax::parse(&source)
            .expect("the library is right")
            .text()
            .expect("what was read can be written");
        let [first, second] = [&source, &again].map(|text| {
            let (mechanism, _) = analyse(text, &CompileSettings::default())
                .unwrap_or_else(|errors| panic!("{}", errors.render("again.mech", text)));
            parts(&mechanism)
        });
        assert_eq!(first, second, "{}", path.display());
        let third = syntax::parse(&again).expect("it is right").text();
        assert_eq!(third.ok(), Some(again), "{}", path.display());
    }
}

#[test]
fn formulas_are_written_with_the_parentheses_they_need_and_no_others() {
    let formulas = [
        "a - (b - c)",
        "a/(b*c)",
        "a*b/c",
        "(a + b)*c",
        "-a^2",
        "(-a)^2",
        "a^-b",
        "a^b^c",
        "(a^b)^c",
        "-(a + b)",
        "-a*b",
        "a*(-b)",
        "(if a < b then c else d)*2",
        "if a < b then c else if a == b then d else 1",
        "sum(i in 0..n + 1, x[i].y)",
        "[a, b][0]",
        "(a + b).x",
        "R[1][2]",
        "0.1 + 1e-30 + 100000 + 0.00000001",
        "f(a, [b, -c])",
    ];
    for text in formulas {
        assert_eq!(Formula::from(text).to_string(), text);
    }
    let spaced = Formula::from("a +b* ((c))- (d*e)");
    assert_eq!(spaced.to_string(), "a + b*c - d*e");
}

#[test]
fn what_is_no_formula_unit_or_name_is_said_with_the_text_underlined() {
    let model = Model::new("2nd")
        .coordinate("q; coord z", "rad")
        .parameter("k", "N/", "1/2*")
        .kinetic(Formula::from("der(q") + 1)
        .potential(f64::NAN);
    let said = format!("{:?}", model.text().expect_err("none of it is right"));
    for part in [
        "`2nd` is no name",
        "`q; coord z` is no name",
        "expected a unit",
        "1/2*\n",
        "this `(` is never closed",
    ] {
        assert!(said.contains(part), "no {part:?} in\n{said}");
    }
}

#[test]
fn what_is_wrong_with_the_whole_is_said_about_the_written_lines() {
    let text = Model::new("Test")
        .coordinate("q", "rad")
        .kinetic("1/2*J*der(q)^2")
        .text()
        .expect("every part is right");
    let errors = analyse(&text, &CompileSettings::default()).expect_err("`J` is missing");
    let said = errors.render("test.mech", &text);
    assert!(
        said.starts_with("test.mech:3:17: error: `J` is not declared"),
        "{said}"
    );
    assert!(said.contains("kinetic 1/2*J*der(q)^2;"), "{said}");
}
