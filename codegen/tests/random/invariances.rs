//! The same mechanism, written in another manner, has the same equations.

use super::description::{Joint, Manner, Random, any, state};
use super::{Case, agree, config};
use proptest::prelude::*;

/// Millimetres to the metre.
const MILLIMETRES: i32 = 1000;

/// Seconds to the hour.
const HOUR: i32 = 3600;

/// Coordinates in another unit of length: angles stay.
fn rescaled(random: &Random, values: &[f64], scale: f64) -> Vec<f64> {
    let scaled = |(body, x): (_, &f64)| match body {
        Joint::Slide => x * scale,
        Joint::Hinge(_) => *x,
    };
    let joints = random.bodies.iter().map(|body| body.joint);
    joints.zip(values).map(scaled).collect()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn the_unit_of_length_changes_nothing_but_scales(random in any(), (q, v) in state()) {
        let scale = f64::from(MILLIMETRES);
        let plain = Case::new(&random.text(Manner::PLAIN), q.clone(), v.clone())?;
        let manner = Manner { scale: MILLIMETRES, ..Manner::PLAIN };
        let (q, v) = (rescaled(&random, &q, scale), rescaled(&random, &v, scale));
        let large = Case::new(&random.text(manner), q, v)?;
        let square = scale * scale;
        let largest = plain.vector(&plain.equations.force);
        let largest = largest.into_iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let (a, b) = (plain.equations.energies, large.equations.energies);
        agree("T", large.value(b.kinetic) / square, plain.value(a.kinetic), 0.0)?;
        agree("Π", large.value(b.potential) / square, plain.value(a.potential), 100.0)?;
        let units = rescaled(&random, &vec![1.0; random.n()], scale);
        let forces = large.vector(&large.equations.force);
        for (i, exact) in plain.vector(&plain.equations.force).into_iter().enumerate() {
            agree("p₁", forces[i] * units[i] / square, exact, largest)?;
        }
    }

    #[test]
    fn the_unit_of_time_changes_nothing_but_scales(random in any(), (q, v) in state()) {
        let hour = f64::from(HOUR);
        let plain = Case::new(&random.text(Manner::PLAIN), q.clone(), v.clone())?;
        let manner = Manner { time_unit: HOUR, ..Manner::PLAIN };
        let fast = v.iter().map(|v| v * hour).collect();
        let hours = Case::new(&random.text(manner), q, fast)?;
        let square = hour * hour;
        let (a, b) = (plain.equations.energies, hours.equations.energies);
        agree("T", hours.value(b.kinetic) / square, plain.value(a.kinetic), 0.0)?;
        agree("Π", hours.value(b.potential) / square, plain.value(a.potential), 100.0)?;
        let [forces, biases] = [&plain.equations.force, &plain.equations.bias];
        let exact = plain.vector(forces);
        let largest = exact.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for (x, y) in hours.vector(&hours.equations.force).into_iter().zip(exact) {
            agree("p₁", x / square, y, largest)?;
        }
        for (x, y) in hours.vector(&hours.equations.bias).into_iter().zip(plain.vector(biases)) {
            agree("p₂", x / square, y, 100.0)?;
        }
    }

    #[test]
    fn the_order_of_coordinates_and_constraints_changes_nothing_but_order(
        random in any(), (q, v) in state(),
    ) {
        let n = random.n();
        let plain = Case::new(&random.text(Manner::PLAIN), q[..n].to_vec(), v[..n].to_vec())?;
        let manner = Manner { reversed: true, ..Manner::PLAIN };
        let backwards = |x: &[f64]| x[..n].iter().rev().copied().collect::<Vec<f64>>();
        let turned = Case::new(&random.text(manner), backwards(&q), backwards(&v))?;
        let (a, b) = (plain.matrix(plain.mass()), turned.matrix(turned.mass()));
        let (f, g) = (plain.vector(&plain.equations.force), turned.vector(&turned.equations.force));
        let largest = f.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for i in 0..n {
            agree("p₁", g[n - 1 - i], f[i], largest)?;
            for j in 0..n {
                agree("M", b[n - 1 - i][n - 1 - j], a[i][j], a[i][i] + a[j][j])?;
            }
        }
        let (f, g) = (plain.vector(&plain.equations.residual), turned.vector(&turned.equations.residual));
        for (x, y) in f.iter().zip(g.iter().rev()) {
            agree("g", *y, *x, 10.0)?;
        }
    }

    #[test]
    fn a_constraint_written_twice_is_two_equal_rows(random in any(), (q, v) in state()) {
        let plain = Case::new(&random.text(Manner::PLAIN), q.clone(), v.clone())?;
        let manner = Manner { copies: 2, ..Manner::PLAIN };
        let double = Case::new(&random.text(manner), q, v)?;
        let once = plain.matrix(&plain.equations.jacobian);
        let twice = double.matrix(&double.equations.jacobian);
        prop_assert_eq!(twice.len(), 2 * once.len());
        for (i, row) in twice.iter().enumerate() {
            prop_assert_eq!(row, &once[i / 2]);
        }
        let (f, g) = (plain.vector(&plain.equations.force), double.vector(&double.equations.force));
        prop_assert_eq!(f, g);
    }
}
