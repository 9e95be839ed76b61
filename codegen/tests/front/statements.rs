//! What statements become in the mechanism.

use super::{accept, assert_close, output, refuse_each, refuse_saying, state, warnings, with};
use bricard_codegen::internals::model::{Direction, Shape};

#[test]
fn a_vector_constraint_has_one_row_for_each_component() {
    let m = accept(&with("constraint [q, w*t] = [cos(w), 1];"));
    assert_eq!(m.constraints.len(), 2);
    assert!(m.constraints.iter().all(|c| c.holonomic));
    assert_close(
        m.graph.evaluate(m.constraints[1].residual, &state),
        0.8 * 0.37 - 1.0,
    );
}

#[test]
fn a_constraint_with_a_derivative_restricts_velocities() {
    let m = accept(&with(
        "constraint sin(w)*der(q) - cos(w)*der(w) = t; constraint q = w;",
    ));
    let kinds: Vec<_> = m.constraints.iter().map(|c| c.holonomic).collect();
    assert_eq!(kinds, [false, true]);
}

#[test]
fn a_row_that_says_nothing_is_left_out_with_a_warning() {
    let source = with("constraint [q, 0, w] = [w, 0, 1];");
    assert_eq!(accept(&source).constraints.len(), 2);
    assert_eq!(warnings(&source), "");
    assert!(warnings(&with("constraint q = q;")).contains("this equation always holds"));
}

#[test]
fn a_row_that_an_identity_makes_hold_says_nothing() {
    for row in [
        "cos(q)^2 + sin(q)^2 = 1",
        "(q + w)^2 = q^2 + 2*q*w + w^2",
        "sin(q + w) = sin(q)*cos(w) + cos(q)*sin(w)",
        "dot(rotx(q)*[1, 0, 0], rotx(w)*[0, 1, 0]) = 0",
        "dot(rotx(0.7)*[0, 0, 1], rotx(0.7)*[0, 1, 0]) = 0",
        "norm2(rotx(0.7)*roty(q)*[w, t, 2]) = w^2 + t^2 + 4",
        "cos(q)^2*der(w) = der(w) - sin(q)^2*der(w)",
        "max(sqrt(2), 1) = sqrt(2)",
    ] {
        let source = with(&format!("constraint {row};"));
        assert!(
            warnings(&source).contains("this equation always holds"),
            "{row}"
        );
        assert!(accept(&source).constraints.is_empty(), "{row}");
    }
    for row in [
        "cos(q)^2 + sin(q)^2 = 1 + 1e-9*w",
        "cos(q)^2 + sin(w)^2 = 1",
        "1e-20*q = 0",
    ] {
        let source = with(&format!("constraint {row};"));
        assert_eq!(accept(&source).constraints.len(), 1, "{row}");
    }
}

/// A hinge of space in a plane: that it does not tilt is no news.
#[test]
fn a_part_may_say_what_holds_anyway() {
    let turned = "rotx(0.7)*rotz(q)";
    let hinge = format!("let h = Revolute([0, 0, 0], rotx(0.7), [0, 0, 0], {turned});");
    let source = with(&format!("use parts; {hinge} constraint w = 0;"));
    assert_eq!(accept(&source).constraints.len(), 1);
    assert_eq!(warnings(&source), "");
}

#[test]
fn a_force_works_on_coordinates_lengths_and_points() {
    let m = accept(&with(
        "input u = 1; force u on q; force [u, 2*der(q)] on [cos(q), w]; force -abs(w) on norm([q, w]);",
    ));
    let nothing = accept(&with(
        "force 0 on [q, w]; const d = 0; dissipation d*der(q)^2;",
    ));
    assert_eq!(nothing.forces[0].force.len(), 2);
    assert!(nothing.dissipation.is_empty());
    let sizes: Vec<_> = m
        .forces
        .iter()
        .map(|f| (f.force.len(), f.on.len()))
        .collect();
    assert_eq!(sizes, [(1, 1), (2, 2), (1, 1)]);
}

#[test]
fn the_law_of_an_input_may_use_everything_but_inputs() {
    let m = accept(&with(
        "param a = 2; let l = a*q; input u = l + t - der(w); force u on q;",
    ));
    let expected = 1.31 * 0.51 + 0.37 - (-0.83 + 0.47);
    assert_close(m.graph.evaluate(m.inputs[0].law, &state), expected);
    refuse_saying(
        &with("input u = 1; input v = u;"),
        "the law of an input contains an input",
    );
}

#[test]
fn start_entries_hold_or_guess_coordinates_and_velocities() {
    let m = accept(&with(
        "coord p[3]; param a = 1; start { q = 2*a; w ~ 1; der(q) = 0; for i in 0..3 { p[i] ~ i; der(p)[i] = a*i; } }",
    ));
    let entries: Vec<_> = m
        .starts
        .iter()
        .map(|s| (s.coordinate, s.velocity, s.held))
        .collect();
    assert_eq!(
        entries[..3],
        [(0, false, true), (1, false, false), (0, true, true)]
    );
    assert_eq!(entries[7..], [(4, false, false), (4, true, true)]);
}

#[test]
fn start_entries_that_make_no_sense_are_refused() {
    let table = "
        start { q = 1; q ~ 2; } ⇒ this has a start value already
        start { q = w; } ⇒ built of numbers, constants and parameters
        start { q = t; } ⇒ built of numbers, constants and parameters
        param a = 1; start { a = 1; } ⇒ only coordinates, velocities, states and formulas
        coord p[2]; start { p = 1; } ⇒ its start value a number
        start { q == 1; } ⇒ expected `=` or `~`
    ";
    refuse_each(with, table);
}

#[test]
fn outputs_are_split_into_columns() {
    let m = accept(&with(
        "coord p[2]; output v = [q, w]; output r = rotz(q); output a = p; for i in 0..2 { output e = [p[i], 1]; }",
    ));
    let names: Vec<_> = m.outputs.iter().map(|o| o.quantity.name.as_str()).collect();
    assert_eq!(names[..3], ["v.x", "v.y", "r[0][0]"]);
    assert_eq!(
        names[11..],
        ["a[0]", "a[1]", "e[0].x", "e[0].y", "e[1].x", "e[1].y"]
    );
}

#[test]
fn events_have_a_direction() {
    let m = accept(&with(
        "event a: q rising; event b: abs(q) - 1 falling; for i in 0..2 { event c: w - i crossing; }",
    ));
    let found: Vec<_> = m
        .events
        .iter()
        .map(|e| (e.name.as_str(), e.direction))
        .collect();
    let expected = [
        ("a", Direction::Rising),
        ("b", Direction::Falling),
        ("c[0]", Direction::Crossing),
        ("c[1]", Direction::Crossing),
    ];
    assert_eq!(found, expected);
}

#[test]
fn the_picture_is_made_of_points_in_space() {
    let m = accept(&with(
        "let p[i in 0..3] = [q, i]; draw line([0, 0], p); draw circle([q, w, 1], 0.1); draw polygon(p); draw trace([q, w]);",
    ));
    assert!(matches!(&m.shapes[0], Shape::Line(points) if points.len() == 4));
    assert!(
        matches!(&m.shapes[1], Shape::Circle(p, _) if m.graph.as_number(p[2]).is_some_and(|n| n.is_one()))
    );
    assert!(matches!(&m.shapes[2], Shape::Polygon(points) if points.len() == 3));
    assert!(matches!(&m.shapes[3], Shape::Trace(p) if m.graph.is_zero(p[2])));
    let table = "
        draw line([0, 0]); ⇒ a line has two or more points, here is one
        draw circle([0, 0]); ⇒ a circle has a centre and a radius
        draw trace([q, w], [0, 0]); ⇒ a trace has one point, here are 2
        draw line(q, w); ⇒ a point is written `[x, y]` or `[x, y, z]`
        draw trace([der(q), 0]); ⇒ a picture shows positions
    ";
    refuse_each(with, table);
}

#[test]
fn loops_nest_and_repeat_statements() {
    let m = accept(&with(
        "coord p[6]; for i in 0..2 { for j in 0..3 { let k = 3*i + j; kinetic (k + 1)*der(p[k])^2; } }",
    ));
    assert_eq!(m.kinetic.len(), 1 + 6);
    let m = accept(&with("for i in 2..2 { kinetic 1/0; }"));
    assert_eq!(m.kinetic.len(), 1);
}

#[test]
fn a_mistake_in_a_loop_is_reported_once() {
    let errors = super::refuse(&with(
        "for i in 0..100 { constraint q = x*i; constraint w = y; }",
    ));
    assert_eq!(errors.error_count(), 2);
}

#[test]
fn a_mechanism_has_coordinates_and_kinetic_energy() {
    refuse_saying("mechanism M { const a = 1; }", "`M` has no coordinates");
    refuse_saying(
        "mechanism M { coord q; potential q; }",
        "`M` has no kinetic energy",
    );
    refuse_saying("", "expected `mechanism`");
    refuse_saying("coord q;", "expected `mechanism`, found `coord`");
    refuse_saying(
        "mechanism M { coord q; kinetic der(q)^2; } mechanism N { }",
        "a file holds one mechanism",
    );
}

#[test]
fn constant_outputs_are_fine() {
    assert_close(output(&accept(&with("output y = 3;")), "y"), 3.0);
}

#[test]
fn a_vector_of_coordinates_begins_at_a_vector() {
    let source =
        "mechanism A { coord p[2]; coord x; coord y; kinetic der(x)^2 + der(y)^2 + norm2(der(p));
        start { p = [1, 2]; der([x, y]) ~ [3, 4]; } }";
    let m = accept(source);
    let starts = m.starts.iter().map(|start| {
        let value = m.graph.evaluate(start.value, &|_| f64::NAN);
        (start.coordinate, start.velocity, start.held, value)
    });
    let expected = [
        (0, false, true, 1.0),
        (1, false, true, 2.0),
        (2, true, false, 3.0),
        (3, true, false, 4.0),
    ];
    assert_eq!(starts.collect::<Vec<_>>(), expected);
    let wrong = source.replace("[1, 2]", "[1, 2, 3]");
    refuse_saying(
        &wrong,
        "this is a vector of 2 components, its start value a vector of 3",
    );
    refuse_saying(
        &source.replace("[1, 2]", "1"),
        "a vector begins at a vector",
    );
}

#[test]
fn a_constraint_may_have_a_name_that_messages_call_it_by() {
    let source = "mechanism A { coord x; coord y; kinetic der(x)^2 + der(y)^2;
        constraint pin: x = y; for i in 0..1 { constraint arm: x = i; } }";
    let m = accept(source);
    let texts: Vec<&str> = m.constraints.iter().map(|row| row.text.as_str()).collect();
    assert_eq!(texts, ["pin: x = y", "arm: x = i [i=0]"]);
    let twice = source.replace("constraint pin", "constraint pin: y = 1; constraint pin");
    refuse_saying(&twice, "`pin` is declared twice");
}

/// Random positions near the start of rhombi in a row are all assembled with some of them folded,
/// where the two constraints of each are one.
#[test]
fn a_row_that_the_start_shows_to_be_independent_follows_from_no_others() {
    let source = "mechanism Rhombi {
        const N = 6; param L = 0.2;
        coord u[N]; coord w[N]; coord x[N];
        let left[i in 0..N] = if i == 0 then [0, 0] else [x[i-1], 0];
        for i in 0..N {
            let T = left[i] + L*[cos(u[i]), sin(u[i])];
            let B = left[i] + L*[cos(w[i]), sin(w[i])];
            kinetic norm2(der(T)) + norm2(der(B)) + der(x[i])^2;
            constraint norm2(T - [x[i], 0]) = L^2;
            constraint norm2(B - [x[i], 0]) = L^2;
            start { u[i] = 60*deg; w[i] ~ -60*deg; x[i] ~ 0.2*(i+1); }
        }
    }";
    assert_eq!(warnings(source), "");
}
