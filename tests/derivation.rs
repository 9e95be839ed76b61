//! The derived equations against dual numbers through the energies and constraints
//! as they are written.
//!
//! The only things believed are `T`, `Π`, `R`, the forces and the constraints;
//! along any path `q(s)` with given `q̇`, `q̈`, `q⃛` the equations must say what the
//! derivatives of those are.

use crate::dense::{dot, size};
use crate::dual::evaluate;
use crate::library::{Derived, Point, everything};
use bricard_codegen::internals::derive::coriolis_matrix;
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_testkit::Random;
use num_dual::{Dual2_64, Dual64, HyperDual64};

/// What values may differ by, relative to the largest of what was added up.
const ROUND_OFF: f64 = 1e-12;

/// Random states for each mechanism.
const STATES: usize = 40;

/// What a check needs of a mechanism at one random state.
struct Case<'a> {
    of: &'a Derived,
    point: Point,
    /// `q̈` of the path through the point.
    acceleration: Vec<f64>,
    seed: u64,
}

/// Runs a check on every mechanism at random states.
fn check(claim: impl Fn(&Case)) {
    for derived in everything() {
        for seed in 0..STATES as u64 {
            let mut random = Random::seeded(seed);
            let point = derived.point(&mut random);
            let n = derived.n();
            let acceleration = random.vector(n, -3.0, 3.0);
            claim(&Case {
                of: &derived,
                point,
                acceleration,
                seed,
            });
        }
    }
}

impl Case<'_> {
    /// The symbols on dual numbers; `q`, `q̇` and `t` as the functions say.
    fn dual<D: crate::dual::Dual>(
        &self,
        e: ExprId,
        coordinate: impl Fn(usize) -> D,
        velocity: impl Fn(usize) -> D,
        time: D,
    ) -> D {
        evaluate(&self.of.mechanism.graph, e, &|symbol| match symbol {
            Symbol::Time => time,
            Symbol::Coordinate(i) => coordinate(i as usize),
            Symbol::Velocity(i) => velocity(i as usize),
            _ => D::from(self.point.value(symbol)),
        })
    }

    /// `∂e/∂q_i` or `∂e/∂q̇_i`.
    fn partial(&self, e: ExprId, i: usize, by_velocity: bool) -> f64 {
        let seed = |x: &[f64], k: usize, here: bool| {
            Dual64::new(x[k], if here && k == i { 1.0 } else { 0.0 })
        };
        let Point { q, v, t, .. } = &self.point;
        let t = Dual64::from_re(*t);
        self.dual(
            e,
            |k| seed(q, k, !by_velocity),
            |k| seed(v, k, by_velocity),
            t,
        )
        .eps
    }

    /// `∂e/∂t`, all else at rest.
    fn by_time(&self, e: ExprId) -> f64 {
        let Point { q, v, t, .. } = &self.point;
        let at = |x: &[f64], k: usize| Dual64::from_re(x[k]);
        self.dual(e, |k| at(q, k), |k| at(v, k), Dual64::new(*t, 1.0))
            .eps
    }

    /// The derivatives of an expression along the path.
    fn along(&self, e: ExprId) -> Dual2_64 {
        let Point { q, v, t, .. } = &self.point;
        let a = &self.acceleration;
        let coordinate = |i: usize| Dual2_64::new(q[i], v[i], a[i]);
        // No third derivative of the coordinates is asked for.
        let velocity = |i: usize| Dual2_64::new(v[i], a[i], f64::NAN);
        self.dual(e, coordinate, velocity, Dual2_64::new(*t, 1.0, 0.0))
    }

    fn vector(&self, entries: &[ExprId]) -> Vec<f64> {
        self.of.vector(entries, &self.point)
    }

    fn matrix(&self, rows: &[Vec<ExprId>]) -> Vec<Vec<f64>> {
        self.of.matrix(rows, &self.point)
    }

    /// Sums of what the description lists, each summand by itself.
    fn total<'b>(
        &self,
        summands: impl IntoIterator<Item = &'b ExprId>,
        f: &dyn Fn(ExprId) -> f64,
    ) -> f64 {
        summands.into_iter().map(|&e| f(e)).sum()
    }

    fn kinetic(&self) -> Vec<ExprId> {
        self.of
            .mechanism
            .kinetic
            .iter()
            .map(|summand| summand.value)
            .collect()
    }

    fn potential(&self) -> Vec<ExprId> {
        self.of
            .mechanism
            .potential
            .iter()
            .map(|summand| summand.value)
            .collect()
    }

    fn dissipation(&self) -> Vec<ExprId> {
        self.of
            .mechanism
            .dissipation
            .iter()
            .map(|summand| summand.value)
            .collect()
    }

    /// `Q_i` by virtual work.
    fn applied(&self, i: usize) -> f64 {
        let loss = self.total(&self.dissipation(), &|e| self.partial(e, i, true));
        let work = |force: &bricard_codegen::internals::model::Force| -> f64 {
            let parts = force.force.iter().zip(&force.on);
            parts
                .map(|(&f, &x)| self.of.value(f, &self.point) * self.partial(x, i, false))
                .sum()
        };
        self.of.mechanism.forces.iter().map(work).sum::<f64>() - loss
    }

    /// `d/dt ∂T/∂q̇_i` along the path.
    fn momentum_rate(&self, i: usize) -> f64 {
        let Point { q, v, t, .. } = &self.point;
        let coordinate = |k: usize| HyperDual64::new(q[k], v[k], 0.0, 0.0);
        let velocity = |k: usize| {
            HyperDual64::new(
                v[k],
                self.acceleration[k],
                if k == i { 1.0 } else { 0.0 },
                0.0,
            )
        };
        let time = HyperDual64::new(*t, 1.0, 0.0, 0.0);
        self.total(&self.kinetic(), &|e| {
            self.dual(e, coordinate, velocity, time).eps1eps2
        })
    }

    fn same(&self, found: f64, exact: f64, scale: f64, what: &str) {
        let Derived { name, .. } = self.of;
        assert!(
            (found - exact).abs() <= ROUND_OFF * (1.0 + scale.abs().max(exact.abs())),
            "{name}, seed {}: {what} is {found:e}, should be {exact:e}",
            self.seed
        );
    }
}

#[test]
fn the_mass_matrix_is_the_second_derivative_of_the_kinetic_energy() {
    check(|case| {
        let mass = case.matrix(&case.of.mass);
        let Point { q, v, t, .. } = &case.point;
        for (i, row) in mass.iter().enumerate() {
            for (j, &entry) in row.iter().enumerate() {
                let one = |k: usize, at: usize| if k == at { 1.0 } else { 0.0 };
                let velocity = |k: usize| HyperDual64::new(v[k], one(k, i), one(k, j), 0.0);
                let at = |k: usize| HyperDual64::from_re(q[k]);
                let time = HyperDual64::from_re(*t);
                let exact = case.total(&case.kinetic(), &|e| {
                    case.dual(e, at, velocity, time).eps1eps2
                });
                case.same(entry, exact, 0.0, &format!("M[{i},{j}]"));
                case.same(entry, mass[j][i], 0.0, "the other half of M");
            }
        }
    });
}

#[test]
fn the_kinetic_energy_is_its_value_at_rest_its_slope_there_and_half_the_quadratic_form() {
    check(|case| {
        let mass = case.matrix(&case.of.mass);
        let resting = Point {
            v: vec![0.0; case.of.n()],
            ..case.point.clone()
        };
        let rest = Case {
            point: resting,
            acceleration: vec![],
            ..*case
        };
        let v = &case.point.v;
        let slope: Vec<f64> = (0..v.len())
            .map(|i| case.total(&case.kinetic(), &|e| rest.partial(e, i, true)))
            .collect();
        let at_rest = case.total(&case.kinetic(), &|e| case.of.value(e, &rest.point));
        let momentum: Vec<f64> = mass.iter().map(|row| dot(row, v)).collect();
        let exact = case.total(&case.kinetic(), &|e| case.of.value(e, &case.point));
        let found = at_rest + dot(&slope, v) + 0.5 * dot(&momentum, v);
        case.same(found, exact, size(&momentum, v) + at_rest, "T");
    });
}

#[test]
fn the_equations_of_motion_are_lagranges() {
    check(|case| {
        let equations = &case.of.equations;
        let (mass, force) = (case.matrix(&case.of.mass), case.vector(&equations.force));
        for i in 0..case.of.n() {
            let inertia =
                case.momentum_rate(i) - case.total(&case.kinetic(), &|e| case.partial(e, i, false));
            let slope = case.total(&case.potential(), &|e| case.partial(e, i, false));
            let exact = inertia + slope - case.applied(i);
            let found = dot(&mass[i], &case.acceleration) - force[i];
            let scale = size(&mass[i], &case.acceleration) + inertia.abs() + slope.abs();
            case.same(found, exact, scale, &format!("row {i} of M q̈ − p₁"));
        }
    });
}

#[test]
fn the_force_is_made_of_its_parts() {
    check(|case| {
        let equations = &case.of.equations;
        let [force, gravity, applied, coriolis] = [
            &equations.force,
            &equations.gravity,
            &equations.applied,
            &equations.coriolis,
        ]
        .map(|entries| case.vector(entries));
        for i in 0..case.of.n() {
            let slope = case.total(&case.potential(), &|e| case.partial(e, i, false));
            case.same(gravity[i], slope, 0.0, &format!("h[{i}]"));
            case.same(applied[i], case.applied(i), 0.0, &format!("Q[{i}]"));
            let sum = applied[i] - coriolis[i] - gravity[i];
            case.same(
                force[i],
                sum,
                coriolis[i].abs() + gravity[i].abs(),
                &format!("p₁[{i}]"),
            );
        }
    });
}

/// The Coriolis matrices of all mechanisms whose mass matrix does not know time.
fn with_coriolis(claim: impl Fn(&Case, &[Vec<f64>])) {
    for mut derived in everything().filter(|derived| !derived.mass_knows_time()) {
        let entries = coriolis_matrix(&mut derived.mechanism.graph, &derived.mass.clone());
        for seed in 0..STATES as u64 {
            let point = derived.point(&mut Random::seeded(seed));
            let coriolis = derived.matrix(&entries, &point);
            let case = Case {
                of: &derived,
                point,
                acceleration: Vec::new(),
                seed,
            };
            claim(&case, &coriolis);
        }
    }
}

#[test]
fn the_coriolis_matrix_times_the_velocities_is_the_coriolis_force() {
    with_coriolis(|case, coriolis| {
        let graph = &case.of.mechanism.graph;
        let odd = |e: &ExprId| graph.depends_on(*e, Symbol::Time);
        if case.kinetic().iter().any(odd) {
            return;
        }
        let force = case.vector(&case.of.equations.coriolis);
        for (i, row) in coriolis.iter().enumerate() {
            let v = &case.point.v;
            case.same(
                dot(row, v),
                force[i],
                size(row, v),
                &format!("row {i} of C q̇"),
            );
        }
    });
}

#[test]
fn the_rate_of_the_mass_matrix_less_twice_the_coriolis_matrix_is_skew() {
    with_coriolis(|case, coriolis| {
        let Point { q, v, t, .. } = &case.point;
        let rate = |e: ExprId| {
            let coordinate = |k: usize| Dual64::new(q[k], v[k]);
            let velocity = |k: usize| Dual64::from_re(v[k]);
            case.dual(e, coordinate, velocity, Dual64::new(*t, 1.0)).eps
        };
        let mass = &case.of.mass;
        let entry = |i: usize, j: usize| rate(mass[i][j]) - 2.0 * coriolis[i][j];
        let places = (0..coriolis.len()).flat_map(|i| (0..=i).map(move |j| (i, j)));
        for (i, j) in places {
            let scale = coriolis[i][j].abs() + coriolis[j][i].abs();
            let what = format!("(Ṁ − 2C)[{i},{j}]");
            case.same(entry(i, j), -entry(j, i), scale, &what);
        }
    });
}

#[test]
fn the_constraints_and_their_derivatives_are_those_along_any_path() {
    check(|case| {
        let equations = &case.of.equations;
        let jacobian = case.matrix(&equations.jacobian);
        let [bias, drift, speed, residual] = [
            &equations.bias,
            &equations.drift,
            &equations.speed,
            &equations.residual,
        ]
        .map(|entries| case.vector(entries));
        for (i, constraint) in case.of.mechanism.constraints.iter().enumerate() {
            let path = case.along(constraint.residual);
            let levels = if constraint.holonomic {
                case.same(residual[i], path.re, 0.0, &format!("g[{i}]"));
                [path.v1, path.v2]
            } else {
                case.same(residual[i], 0.0, 0.0, &format!("g[{i}]"));
                [path.re, path.v1]
            };
            let (a, Case { acceleration, .. }) = (&jacobian[i], case);
            let found = [
                dot(a, &case.point.v) + drift[i],
                dot(a, acceleration) - bias[i],
            ];
            let scale = size(a, acceleration) + bias[i].abs();
            for (order, (found, exact)) in found.into_iter().zip(levels).enumerate() {
                case.same(
                    found,
                    exact,
                    scale,
                    &format!("derivative {order} of row {i}"),
                );
            }
            case.same(speed[i], found[0], 0.0, &format!("speed of row {i}"));
        }
    });
}

#[test]
fn the_jacobian_is_the_slope_of_the_constraints() {
    check(|case| {
        let jacobian = case.matrix(&case.of.equations.jacobian);
        for (i, constraint) in case.of.mechanism.constraints.iter().enumerate() {
            for (j, &entry) in jacobian[i].iter().enumerate() {
                let exact = case.partial(constraint.residual, j, !constraint.holonomic);
                case.same(entry, exact, 0.0, &format!("A[{i},{j}]"));
            }
        }
    });
}

/// `d/dt balance = power + r·q̇` whatever the motion, with `r = M q̈ − p₁`.
#[test]
fn the_energy_balance_is_the_power_supplied() {
    check(|case| {
        let equations = &case.of.equations;
        let energies = equations.energies;
        let (mass, force) = (case.matrix(&case.of.mass), case.vector(&equations.force));
        let reaction: Vec<f64> = mass
            .iter()
            .zip(&force)
            .map(|(row, force)| dot(row, &case.acceleration) - force)
            .collect();
        let rate = case.along(energies.balance).v1;
        let power = case.of.value(energies.power, &case.point);
        let v = &case.point.v;
        let scale = size(&reaction, v) + size(&force, v);
        case.same(rate - dot(&reaction, v), power, scale, "the power");
    });
}

#[test]
fn the_energies_are_the_sums_of_what_is_written() {
    check(|case| {
        let energies = case.of.equations.energies;
        let value = |e: ExprId| case.of.value(e, &case.point);
        let kinetic = case.total(&case.kinetic(), &value);
        let potential = case.total(&case.potential(), &value);
        case.same(value(energies.kinetic), kinetic, 0.0, "T");
        case.same(value(energies.potential), potential, 0.0, "Π");
        let work: f64 = (0..case.of.n())
            .map(|i| case.applied(i) * case.point.v[i])
            .sum();
        let explicit = case.total(&case.potential(), &|e| case.by_time(e))
            - case.total(&case.kinetic(), &|e| case.by_time(e));
        case.same(
            value(energies.power),
            work + explicit,
            work.abs(),
            "the power",
        );
    });
}
