//! Solves of mechanisms whose mass matrix alone is singular, against dense elimination of
//! the equations as they are.

use super::solve::dense;
use bricard_codegen::CompileSettings;
use bricard_codegen::internals::analyse;
use bricard_codegen::internals::derive::{Equations, derive};
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::model::Mechanism;
use bricard_codegen::internals::optimise::{Layout, Slot, acceleration_solve, interpret, optimise};

/// A chain of bodies in Euler parameters that hangs from a point.
const BODIES: &str = "mechanism Bodies {
    const N = 3;
    coord x[N]; coord y[N]; coord z[N];
    coord e0[N]; coord e1[N]; coord e2[N]; coord e3[N];
    let c[i in 0..N] = [x[i], y[i], z[i]];
    let R[i in 0..N] = quat(e0[i], e1[i], e2[i], e3[i]);
    let h[i in 0..N] = R[i]*[0.5, 0, 0];
    for i in 0..N {
        let w = omega(R[i]);
        kinetic 1/2*norm2(der(c[i])) + 0.01*w.x^2 + 0.1*w.y^2 + 0.2*w.z^2;
        potential 9.81*z[i];
    }
    constraint c[0] - h[0] = 0;
    for i in 0..N-1 { constraint c[i] + h[i] = c[i+1] - h[i+1]; }
    for i in 0..N { constraint e0[i]^2 + e1[i]^2 + e2[i]^2 + e3[i]^2 = 1; }
}";

/// A slider of a crank, without mass.
const MASSLESS: &str = "mechanism Massless {
    coord phi; coord psi; coord x;
    kinetic 1/2*der(phi)^2 + 1/3*der(psi)^2 + 1/4*der(phi)*der(psi)*cos(phi - psi);
    potential sin(phi);
    constraint cos(phi) + 2*cos(psi) = x;
    constraint sin(phi) + 2*sin(psi) = 0;
}";

/// A rod without mass between two cranks, and a slider on it, whose inertia about the joint of the
/// rod vanishes where it runs across that.
const ROD: &str = "mechanism Rod {
    coord a; coord b; coord c; coord u;
    let A = [cos(a), sin(a)];
    let B = [2 + cos(b), sin(b)];
    let P = A + (u - 0.25)*[cos(c), sin(c)];
    kinetic 1/2*der(a)^2 + 1/2*der(b)^2 + 1/2*norm2(der(P));
    potential 9.81*P.y;
    constraint A + 2*[cos(c), sin(c)] = B;
}";

/// Two loops of cranks, joined by couplers without mass: no row alone holds the angle of one
/// wherever it points.
const COUPLERS: &str = "mechanism Couplers {
    param r = 0.5; param d = 2;
    coord a[3]; coord s[2];
    let tip[i in 0..3] = [i*d, 0] + r*[cos(a[i]), sin(a[i])];
    for i in 0..3 { kinetic 1/2*(i + 1)*der(a[i])^2; potential tip[i].y; }
    for i in 0..2 { constraint tip[i] + d*[cos(s[i]), sin(s[i])] = tip[i+1]; }
}";

/// A mechanism and its equations.
pub(super) fn derived(source: &str) -> (Mechanism, Equations) {
    let (mut mechanism, _) = analyse(source, &CompileSettings::default()).expect("it is right");
    let equations = derive(&mut mechanism).expect("equations of a usual length");
    (mechanism, equations)
}

fn weighed(source: &str) -> Vec<usize> {
    derived(source).1.weighed
}

fn state(symbol: Symbol) -> f64 {
    match symbol {
        Symbol::Coordinate(i) => 0.4 + (f64::from(i) * 0.37).sin(),
        Symbol::Velocity(i) => (f64::from(i) * 1.13).cos(),
        Symbol::Parameter(i) => 0.5 + f64::from(i),
        _ => unreachable!("neither has {symbol:?}"),
    }
}

/// The accelerations by the emitted solve with these weights, and by dense elimination of
/// `[M Aᵀ; A 0]`.
fn accelerations(source: &str, weight: fn(u32) -> f64) -> (Vec<f64>, Vec<f64>) {
    let (mut mechanism, equations) = derived(source);
    let (n, r) = equations.sizes();
    let graph = &mut mechanism.graph;
    let value = |e: &ExprId| graph.evaluate(*e, &state);
    let mut whole = vec![vec![0.0; n + r]; n + r];
    for (i, row) in equations.mass.iter().flatten().enumerate() {
        row.iter()
            .enumerate()
            .for_each(|(j, e)| whole[i][j] = value(e));
    }
    for (i, row) in equations.jacobian.iter().enumerate() {
        for (j, e) in row.iter().enumerate() {
            (whole[n + i][j], whole[j][n + i]) = (value(e), value(e));
        }
    }
    let right = equations.force.iter().chain(&equations.bias).map(value);
    let right: Vec<f64> = right.collect();
    let (mut exact, _) = dense(&whole, &right);
    exact.truncate(n);

    let slot = |array, row, column| Slot { array, row, column };
    let mut wanted = Vec::new();
    let mass = equations.mass.as_ref().expect("a short mechanism");
    for (array, matrix) in [("mass", mass), ("jacobian", &equations.jacobian)] {
        for (i, row) in matrix.iter().enumerate() {
            wanted.extend(row.iter().enumerate().map(|(j, e)| (slot(array, i, j), *e)));
        }
    }
    for (array, vector) in [("force", &equations.force), ("bias", &equations.bias)] {
        let entries = vector.iter().enumerate();
        wanted.extend(entries.map(|(i, e)| (slot(array, i, 0), *e)));
    }
    let terms = optimise(graph, &[], &wanted);
    let layout = Layout {
        n,
        r,
        weighed: &equations.weighed,
        redundant: &[],
    };
    let solved = acceleration_solve(&terms, layout).expect("a program");
    let given = |symbol| match symbol {
        Symbol::Weight(row) => Some(weight(row)),
        other => Some(state(other)),
    };
    let outputs = interpret(&solved.program, &given);
    let mut found = vec![0.0; n];
    for (slot, value) in outputs {
        if slot.array == "acceleration" {
            found[slot.row] = value;
        }
    }
    (found, exact)
}

#[test]
fn no_row_takes_part_where_the_masses_do() {
    let with_mass = MASSLESS.replace("1/2*der(phi)^2", "1/2*der(phi)^2 + 1/5*der(x)^2");
    assert_eq!(weighed(&with_mass), [0; 0]);
}

#[test]
fn the_rows_of_unit_length_take_part_for_euler_parameters() {
    // Behind the three equations of each joint.
    assert_eq!(weighed(BODIES), [9, 10, 11]);
}

#[test]
fn the_row_that_holds_a_coordinate_without_inertia_takes_part() {
    assert_eq!(weighed(MASSLESS), [0]);
}

#[test]
fn rows_that_hold_an_angle_without_inertia_together_take_part() {
    assert_eq!(weighed(COUPLERS), [0, 1, 2, 3]);
    // Two rods without mass in a row: where they are in line, nothing holds the joint.
    let rods = "mechanism Rods {
        coord a; coord s[2]; coord b;
        kinetic 1/2*der(a)^2 + 1/2*der(b)^2;
        constraint [cos(a), sin(a)] + [cos(s[0]), sin(s[0])] + [cos(s[1]), sin(s[1])]
            = [2 + cos(b), sin(b)];
    }";
    assert_eq!(weighed(rods), [0; 0]);
}

#[test]
fn the_rows_that_hold_a_coordinate_whose_inertia_vanishes_somewhere_take_part() {
    assert_eq!(weighed(ROD), [0, 1]);
    let with_mass = ROD.replace("1/2*der(a)^2", "1/2*der(a)^2 + 1/9*der(c)^2");
    assert_eq!(weighed(&with_mass), [0; 0]);
    // A particle in polar coordinates: nothing holds the angle where the radius is zero.
    let polar = "mechanism Polar { coord r; coord phi; coord z;
        kinetic 1/2*der(r)^2 + 1/2*r^2*der(phi)^2 + 1/2*der(z)^2; constraint z = r^2; }";
    assert_eq!(weighed(polar), [0; 0]);
}

#[test]
fn where_several_coordinates_move_without_kinetic_energy_that_is_known() {
    let degenerates = |source: &str| derived(source).1.metric_degenerates;
    // Crank and coupler in line, with a mass at their end.
    let fold = "mechanism Fold { coord a; coord c; coord b;
        let B = [cos(a) + 2*cos(c), sin(a) + 2*sin(c)];
        kinetic 1/2*norm2(der(B)) + 1/2*der(b)^2;
        constraint B = [2 + cos(b), sin(b)]; }";
    assert!(degenerates(fold));
    assert_eq!(weighed(fold), [0; 0]);
    assert!(!degenerates(
        &fold.replace("1/2*der(b)^2", "1/2*der(b)^2 + 1/99*der(c)^2")
    ));
    // A row of cranks and couplers, which hang together.
    let row = "mechanism Row { const N = 8; coord a[N]; coord c[N]; coord b[N];
        let B[i in 0..N] = [2*i + cos(a[i]) + 2*cos(c[i]), sin(a[i]) + 2*sin(c[i])];
        for i in 0..N { kinetic 1/2*der(b[i])^2; constraint B[i] = [2 + cos(b[i]), sin(b[i])]; }
        for i in 0..N { kinetic 1/2*norm2(der(B[i])); }
        for i in 0..N-1 { kinetic 1/9*norm2(der(B[i]) + der(B[i+1])); } }";
    assert!(degenerates(row));
    assert!(!degenerates(&row.replace(
        "1/2*der(b[i])^2",
        "1/2*der(b[i])^2 + 1/99*der(c[i])^2"
    )));
    // A gear turns the coupler with the crank.
    let geared = fold.replace("constraint", "constraint c = 0.3 - a; constraint");
    assert!(!degenerates(&geared));
    assert_eq!(weighed(&geared), [0]);
    // A slider beside a rod without mass, at the foot of the perpendicular of the pin; far away.
    let slider = "mechanism Slider { coord s; coord c; coord b;
        let P = [(s - 40)*cos(c) - sin(c), (s - 40)*sin(c) + cos(c)];
        kinetic 1/2*norm2(der(P)) + 1/2*der(b)^2; constraint b = c; }";
    assert!(!degenerates(slider));
    assert_eq!(weighed(slider), [0]);
    assert!(degenerates(&slider.replace("b = c", "b = 1")));
    assert!(!degenerates(ROD));
    assert!(!degenerates(BODIES));
}

#[test]
fn what_no_row_holds_brings_no_row_in() {
    let free = MASSLESS.replace("= x;", "= 1;").replace(
        "sin(phi);\n    constraint cos",
        "sin(phi) + x;\n    constraint cos",
    );
    assert_eq!(weighed(&free), [0; 0]);
}

#[test]
fn a_singular_mass_matrix_gives_the_accelerations_of_the_equations_as_they_are() {
    let weights: [fn(u32) -> f64; 3] = [|_| 1.0, |row| 0.1 + f64::from(row), |_| 1e-3];
    for source in [BODIES, MASSLESS, ROD, COUPLERS] {
        for weight in weights {
            let (found, exact) = accelerations(source, weight);
            let largest = exact.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
            for (i, (found, exact)) in found.iter().zip(&exact).enumerate() {
                let error = (found - exact).abs();
                assert!(error <= 1e-9 * largest, "{i}: {found} is not {exact}");
            }
        }
    }
}
