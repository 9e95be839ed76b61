//! Constraints that are independent by their form, against their rank at random positions.

use super::weighed::derived;
use bricard_codegen::internals::derive::Equations;
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::model::Mechanism;

/// Positions at which rows are looked at.
const POSITIONS: u32 = 50;

fn with(constraints: &str) -> (Mechanism, Equations) {
    derived(&format!(
        "mechanism Test {{
            param k = 1; const d = 2; const none = 0;
            coord a; coord b; coord c; coord x; coord y; coord z;
            kinetic 1/2*(der(a)^2 + der(b)^2 + der(c)^2 + der(x)^2 + der(y)^2 + der(z)^2);
            potential x; {constraints}
        }}"
    ))
}

/// Entries of the constraint Jacobian at a random position, some coordinates of which are
/// multiples of a quarter turn or zero.
fn rows(mechanism: &Mechanism, equations: &Equations, position: u32) -> Vec<Vec<f64>> {
    let value = |symbol| match symbol {
        Symbol::Coordinate(i) => match (i + position) % 3 {
            0 => f64::from(i * position % 5) * std::f64::consts::FRAC_PI_2,
            _ => (f64::from(i + 1) * 1.37 + f64::from(position) * 0.73).sin() * 3.0,
        },
        _ => 1.0,
    };
    let value = |e: &ExprId| mechanism.graph.evaluate(*e, &value);
    let rows = equations.jacobian.iter();
    rows.map(|row| row.iter().map(value).collect()).collect()
}

/// The rank by elimination with complete pivoting.
fn rank(mut rows: Vec<Vec<f64>>) -> usize {
    let mut rank = 0;
    while !rows.is_empty() {
        let places = (0..rows.len()).flat_map(|i| (0..rows[i].len()).map(move |j| (i, j)));
        let size = |&(i, j): &(usize, usize)| rows[i][j].abs();
        let Some((i, j)) = places.max_by(|one, other| size(one).total_cmp(&size(other))) else {
            break;
        };
        if size(&(i, j)) < 1e-9 {
            break;
        }
        let pivot = rows.swap_remove(i);
        for row in &mut rows {
            let share = row[j] / pivot[j];
            row.iter_mut()
                .zip(&pivot)
                .for_each(|(entry, other)| *entry -= share * other);
        }
        rank += 1;
    }
    rank
}

#[test]
fn rows_with_coordinates_of_their_own_are_independent() {
    for constraints in [
        "constraint x = cos(a);",
        "constraint 3*x - d*sin(a)*b^2 = t;",
        // A chain in any order.
        "constraint [x, y] = [cos(a), sin(a)]; constraint z = x + y*cos(b);",
        "constraint z = x + y*cos(b); constraint [x, y] = [cos(a), sin(a)];",
        // Velocities: a wheel that rolls, a skate on either side.
        "constraint der(x) = d*der(a)*cos(b); constraint der(y) = d*der(a)*sin(b);",
        "constraint der(x)*sin(a) = der(y)*cos(a);",
        "constraint d*sin(a)*der(x) + 3*cos(a)*der(y) = der(a);",
    ] {
        let (mechanism, equations) = with(constraints);
        assert!(equations.are_independent(&mechanism.graph), "{constraints}");
        for position in 0..POSITIONS {
            let rows = rows(&mechanism, &equations, position);
            assert_eq!(rank(rows.clone()), rows.len(), "{constraints} {rows:?}");
        }
    }
}

#[test]
fn squares_that_do_not_add_up_to_zero_have_a_gradient_where_they_do() {
    for constraints in [
        "constraint a^2 + b^2 = 1;",
        "constraint 2*a^2 - d*b^2 = 1; constraint x = a*b;",
        "constraint norm2([a, b, c]) = d; constraint [x, y] = [a*b, c^2];",
    ] {
        let (mechanism, equations) = with(constraints);
        assert!(equations.are_independent(&mechanism.graph), "{constraints}");
    }
}

#[test]
fn what_may_lose_rank_is_not_called_independent() {
    for constraints in [
        // A triangle of rods, and points where one row vanishes.
        "constraint cos(a) + cos(b) = 1; constraint sin(a) + sin(b) = 0;",
        "constraint sin(a) = 0;",
        "constraint x^2 = cos(a);",
        "constraint a^2 + b^2 = none;",
        "constraint a^2 + b^2 = k;",
        "constraint a^2 + b^2 = cos(x);",
        "constraint a^2 + a*b = 1;",
        "constraint a^3 + b^2 = 1;",
        // Numbers and functions that are not of one row alone.
        "constraint x = cos(a); constraint x = sin(b);",
        "constraint x + y = 1; constraint x + y = cos(a);",
        "constraint a^2 + b^2 = 1; constraint a^2 + c^2 = 1;",
        "constraint x = 1; constraint 2*x = 2;",
        // What a parameter decides, or a coordinate.
        "constraint k*x = cos(a);",
        "constraint x*y = 1;",
        "constraint sin(a)*x = 1;",
        "constraint der(x)*sin(a) = der(y)*sin(a);",
        "constraint der(x)*sin(a) = der(y)*cos(b);",
        "constraint der(x)*sin(a) + der(x)*cos(a) = 0;",
        "constraint der(x)*b = der(y)*a;",
    ] {
        let (mechanism, equations) = with(constraints);
        assert!(
            !equations.are_independent(&mechanism.graph),
            "{constraints}"
        );
    }
}

#[test]
fn bodies_in_a_chain_are_independent_and_those_of_a_loop_are_not() {
    let chain = |end: &str| {
        format!(
            "mechanism Bodies {{
                const N = 3;
                coord x[N]; coord y[N]; coord z[N];
                coord e0[N]; coord e1[N]; coord e2[N]; coord e3[N];
                let c[i in 0..N] = [x[i], y[i], z[i]];
                let R[i in 0..N] = quat(e0[i], e1[i], e2[i], e3[i]);
                let h[i in 0..N] = R[i]*[0.5, 0, 0];
                for i in 0..N {{
                    kinetic 1/2*norm2(der(c[i])) + 1/2*norm2(omega(R[i]));
                    constraint e0[i]^2 + e1[i]^2 + e2[i]^2 + e3[i]^2 = 1;
                }}
                potential 9.81*z[0];
                constraint c[0] = h[0];
                for i in 0..N-1 {{ constraint c[i] + h[i] = c[i+1] - h[i+1]; }}
                {end}
            }}"
        )
    };
    for (end, expected) in [
        ("", true),
        ("constraint c[N-1] + h[N-1] = [1, 0, 0];", false),
    ] {
        let (mechanism, equations) = derived(&chain(end));
        assert_eq!(
            equations.are_independent(&mechanism.graph),
            expected,
            "{end}"
        );
    }
}
