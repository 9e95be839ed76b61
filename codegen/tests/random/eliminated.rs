//! Coordinates that constraints give, left out of random mechanisms: the equations that
//! are left are those of the whole, seen along the motions that the constraints allow.
//!
//! With `q = f(z, t)`, `J = ∂f/∂z` and any `z`, `ż`, `z̈`:
//! `p₁′ − M′z̈ = Jᵀ(p₁ − M q̈)`, and each constraint that is left has the value, the rate
//! and the rate after that which it has in the whole.

use super::description::{Manner, Random, any, state};
use super::{agree, config, dot, size};
use bricard_codegen::CompileSettings;
use bricard_codegen::internals::analyse;
use bricard_codegen::internals::derive::{Equations, derive, eliminate};
use bricard_codegen::internals::expr::{ExprId, Symbol};
use bricard_codegen::internals::model::Mechanism;
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

/// When (s).
const TIME: f64 = 0.3;

/// Two coordinates in a chain that constraints give, with everything on them that a
/// description can say, and two constraints that stay.
fn with_given(random: &Random) -> String {
    let last = random.n() - 1;
    let text = random.text(Manner::PLAIN);
    let inside = text.trim_end().trim_end_matches('}');
    format!(
        "{inside}
        coord s; coord w;
        constraint w = s*q0 + p{last}.y/2 + sin(t)/3;
        constraint 2*s = p{last}.x - q0;
        constraint s^2 + w*q{last} = 1;
        constraint der(w)*q0 + der(s)*cos(t) = der(q{last});
        kinetic 3/5*der(s)^2 + (1 + s^2)/7*der(w)^2 + der(s)*der(q{last})/9;
        potential s*w + w^3/3;
        dissipation der(w)^2/5 + der(s)^2*w^2/9;
        force sin(w) - der(s)*w on w*q0;
        }}"
    )
}

/// A mechanism with its equations at a motion: coordinates and two rates.
struct Scene {
    mechanism: Mechanism,
    equations: Equations,
    motion: [Vec<f64>; 3],
}

impl Scene {
    fn new(mut mechanism: Mechanism, motion: [Vec<f64>; 3]) -> Result<Self, TestCaseError> {
        let equations = derive(&mut mechanism);
        let equations = equations.map_err(|_| TestCaseError::fail("too long"))?;
        Ok(Self {
            mechanism,
            equations,
            motion,
        })
    }

    /// The entries of `M`, which every short mechanism has.
    fn mass(&self) -> &[Vec<ExprId>] {
        self.equations.mass.as_deref().expect("a short mechanism")
    }

    fn vector(&self, entries: &[ExprId]) -> Vec<f64> {
        let [q, v, a] = &self.motion;
        let symbol = |symbol| match symbol {
            Symbol::Time => TIME,
            Symbol::Coordinate(i) => q[i as usize],
            Symbol::Velocity(i) => v[i as usize],
            Symbol::Acceleration(i) => a[i as usize],
            _ => 0.0,
        };
        self.mechanism.graph.evaluate_all(entries, &symbol)
    }

    /// `left − rows·x`, with the size of what was added up.
    fn less(&self, left: &[ExprId], rows: &[Vec<ExprId>], x: &[f64]) -> Vec<(f64, f64)> {
        let left = self.vector(left).into_iter();
        let row = |(left, row): (f64, &Vec<ExprId>)| {
            let row = self.vector(row);
            (left - dot(&row, x), left.abs() + size(&row, x))
        };
        left.zip(rows).map(row).collect()
    }

    /// For each constraint its value, and what its two rates leave over.
    fn constraints(&self) -> Vec<Vec<(f64, f64)>> {
        let e = &self.equations;
        let [_, _, a] = &self.motion;
        let plain = |entries: &[ExprId]| -> Vec<(f64, f64)> {
            let values = self.vector(entries).into_iter();
            values.map(|x| (x, x.abs())).collect()
        };
        vec![
            plain(&e.residual),
            plain(&e.speed),
            self.less(&e.bias, &e.jacobian, a),
        ]
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn what_is_left_says_what_the_whole_says(
        random in any(), (q, v) in state(), a in proptest::collection::vec(-2.0..2.0_f64, 4),
    ) {
        let source = with_given(&random);
        let analysed = analyse(&source, &CompileSettings::default());
        let (mechanism, _) =
            analysed.map_err(|errors| TestCaseError::fail(errors.render("random.mech", &source)))?;
        let less = eliminate(mechanism.clone());
        let less = less.map_err(|_| TestCaseError::fail("too long"))?;
        prop_assert_eq!(less.described.len(), random.n() + 2);
        prop_assert_eq!(less.coordinates.len(), random.n());
        let described = less.described.clone();
        let mut less = Scene::new(less, [q, v, a])?;
        let accelerations: Vec<ExprId> = described.iter().map(|c| c.acceleration).collect();
        let motion = [
            less.vector(&described.iter().map(|c| c.position).collect::<Vec<_>>()),
            less.vector(&described.iter().map(|c| c.velocity).collect::<Vec<_>>()),
            less.vector(&accelerations),
        ];
        let whole = Scene::new(mechanism, motion)?;

        let reactions = whole.less(&whole.equations.force, whole.mass(), &whole.motion[2]);
        for (coordinate, (exact, scale)) in described.iter().zip(&reactions) {
            agree("r", less.vector(&[coordinate.reaction])[0], *exact, *scale)?;
        }
        let left = less.less(&less.equations.force, less.mass(), &less.motion[2]);
        for (j, (found, scale)) in left.into_iter().enumerate() {
            let slope = |e| less.mechanism.graph.differentiate(e, Symbol::Velocity(j as u32));
            let column: Vec<ExprId> = described.iter().map(|c| c.velocity).map(slope).collect();
            let column = less.vector(&column);
            let parts: Vec<f64> = reactions.iter().map(|(r, _)| *r).collect();
            let sizes: Vec<f64> = reactions.iter().map(|(_, size)| *size).collect();
            agree("p₁ − M z̈", found, dot(&column, &parts), scale + size(&column, &sizes))?;
        }

        let texts = |scene: &Scene| -> Vec<String> {
            scene.mechanism.constraints.iter().map(|row| row.text.clone()).collect()
        };
        let (rows, kept) = (texts(&whole), texts(&less));
        let (all, rest) = (whole.constraints(), less.constraints());
        for (order, (all, rest)) in all.iter().zip(&rest).enumerate() {
            for (text, (found, scale)) in kept.iter().zip(rest) {
                let row = rows.iter().position(|row| row == text);
                let (exact, size) = all[row.expect("a constraint of the whole")];
                agree(&format!("{text}, rate {order}"), *found, exact, scale + size)?;
            }
        }
    }
}
