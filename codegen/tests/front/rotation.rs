//! Rotations and their angular velocity, against numbers.

use super::{accept, assert_close, output, refuse_each, refuse_saying, with};
use bricard_codegen::internals::expr::Symbol;
use bricard_codegen::internals::model::Mechanism;

/// An angle, a body-fixed chain of rotations, Euler parameters.
const SETTING: &str = "coord e[4];
    let R1 = rotz(q)*rotx(w);
    let R2 = R1*roty(2*q + t);
    let R3 = transpose(R2);
    let Q = quat(e[0], e[1], e[2], e[3]);
    let S = R2*Q;
    let H = [[cos(w), -sin(w), 0], [sin(w), cos(w), 0], [0, 0, 1]]*R1;
    kinetic sum(i in 0..4, der(e[i])^2);
    output z = R3*R2; output d = Q; output a = rotx(q); output b = roty(q); output c = rotz(q);";

const NAMES: [&str; 5] = ["R1", "R2", "R3", "S", "H"];

fn setting() -> Mechanism {
    let outputs: String = NAMES
        .iter()
        .map(|name| format!("output {name} = {name}; output w{name} = omega({name}); output d{name} = der({name});"))
        .collect();
    accept(&with(&format!("{SETTING} {outputs} output wQ = omega(Q);")))
}

/// A state with Euler parameters on the unit sphere and rates tangent to it.
fn unit_state(symbol: Symbol) -> f64 {
    let e = [0.5, 0.1, -0.7, 0.5];
    let rate = [0.3, 0.2, 0.5, 0.36];
    match symbol {
        Symbol::Coordinate(i) if i >= 2 => e[i as usize - 2],
        Symbol::Velocity(i) if i >= 2 => rate[i as usize - 2],
        other => super::state(other),
    }
}

fn at(m: &Mechanism, name: &str) -> f64 {
    let found = m.outputs.iter().find(|output| output.quantity.name == name);
    m.graph.evaluate(
        found.unwrap_or_else(|| panic!("no output `{name}`")).value,
        &unit_state,
    )
}

fn matrix(m: &Mechanism, name: &str) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| at(m, &format!("{name}[{i}][{j}]"))))
}

#[test]
fn euler_parameters_of_the_test_lie_on_the_sphere() {
    let part = |i| {
        (
            unit_state(Symbol::Coordinate(i)),
            unit_state(Symbol::Velocity(i)),
        )
    };
    let square: f64 = (2..6).map(|i| part(i).0 * part(i).0).sum();
    let slope: f64 = (2..6).map(|i| part(i).0 * part(i).1).sum();
    assert_close(square, 1.0);
    assert_close(slope, 0.0);
}

#[test]
fn rotations_turn_the_next_axis_towards_the_one_after() {
    let m = setting();
    let (s, c) = (0.51_f64.sin(), 0.51_f64.cos());
    assert_eq!(
        matrix(&m, "c"),
        [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
    );
    assert_eq!(
        matrix(&m, "a"),
        [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]
    );
    assert_eq!(
        matrix(&m, "b"),
        [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]
    );
}

#[test]
fn the_transpose_of_a_rotation_is_its_inverse() {
    let m = setting();
    for (i, row) in matrix(&m, "z").iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            assert_close(*entry, if i == j { 1.0 } else { 0.0 });
        }
    }
}

#[test]
fn a_unit_quaternion_is_a_right_handed_rotation() {
    let m = setting();
    let r = matrix(&m, "d");
    for i in 0..3 {
        for j in 0..3 {
            let product: f64 = (0..3).map(|k| r[k][i] * r[k][j]).sum();
            assert_close(product, if i == j { 1.0 } else { 0.0 });
        }
    }
    let determinant: f64 = (0..3)
        .map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            r[0][i] * (r[1][j] * r[2][k] - r[1][k] * r[2][j])
        })
        .sum();
    assert_close(determinant, 1.0);
    // Rotation by α about z has the parameters (cos α/2, 0, 0, sin α/2).
    let source = with("output y = quat(cos(q/2), 0, 0, sin(q/2)) - rotz(q);");
    let about_z = accept(&source);
    for output in &about_z.outputs {
        assert_close(about_z.graph.evaluate(output.value, &super::state), 0.0);
    }
}

#[test]
fn the_angular_velocity_is_the_vector_of_the_transpose_times_the_rate() {
    let m = setting();
    for name in NAMES {
        let (r, rate) = (matrix(&m, name), matrix(&m, &format!("d{name}")));
        let product = |i: usize, j: usize| -> f64 { (0..3).map(|k| r[k][i] * rate[k][j]).sum() };
        assert_close(at(&m, &format!("w{name}.x")), product(2, 1));
        assert_close(at(&m, &format!("w{name}.y")), product(0, 2));
        assert_close(at(&m, &format!("w{name}.z")), product(1, 0));
    }
}

#[test]
fn the_angular_velocity_of_a_quaternion_is_bilinear() {
    let m = setting();
    let e: [f64; 4] = std::array::from_fn(|i| unit_state(Symbol::Coordinate(i as u32 + 2)));
    let d: [f64; 4] = std::array::from_fn(|i| unit_state(Symbol::Velocity(i as u32 + 2)));
    let x = 2.0 * (-e[1] * d[0] + e[0] * d[1] + e[3] * d[2] - e[2] * d[3]);
    let y = 2.0 * (-e[2] * d[0] - e[3] * d[1] + e[0] * d[2] + e[1] * d[3]);
    let z = 2.0 * (-e[3] * d[0] + e[2] * d[1] - e[1] * d[2] + e[0] * d[3]);
    assert_close(at(&m, "wQ.x"), x);
    assert_close(at(&m, "wQ.y"), y);
    assert_close(at(&m, "wQ.z"), z);
}

#[test]
fn a_rotation_about_one_axis_has_a_plain_angular_velocity() {
    let m = accept(&with("output y = omega(rotz(q)*rotx(w));"));
    let names = |s| m.symbol_text(s);
    assert_eq!(m.graph.text(m.outputs[0].value, &names), "der(w)");
    let flat = accept(&with("output y = omega(rotz(q));"));
    assert_eq!(
        flat.graph
            .text(flat.outputs[2].value, &|s| flat.symbol_text(s)),
        "der(q)"
    );
    assert_close(output(&flat, "y.x"), 0.0);
}

#[test]
fn omega_and_rotations_refuse_what_they_are_not_for() {
    let table = "
        let a = omega([[1, 0, 0], [0, 1, 0]]); ⇒ takes a 2 × 2 or a 3 × 3 matrix
        let a = omega(rotz(der(q))); force a.z on q; ⇒ a force can't contain an acceleration
        let a = quat(1, 0, 0); ⇒ takes 4 arguments, here are 3
        let a = rotz([q, w]); ⇒ the angle of a rotation has to be a number
    ";
    refuse_each(with, table);
}

#[test]
fn the_angular_velocity_in_the_plane_is_a_number() {
    let source = with(
        "let R = rot(q)*transpose(rot(w))*rot(t);
         let S = [[cos(q*w), -sin(q*w)], [sin(q*w), cos(q*w)]];
         output a = omega(R); output b = der(q) - der(w) + 1;
         output c = omega(S); output d = der(q*w);",
    );
    let m = accept(&source);
    assert_close(output(&m, "a"), output(&m, "b"));
    assert_close(output(&m, "c"), output(&m, "d"));
    refuse_saying(
        &with("output a = omega([q, w]);"),
        "a 2 × 2 or a 3 × 3 matrix",
    );
}
