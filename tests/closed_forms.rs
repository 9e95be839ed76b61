//! Motions that can be written down: the heavy top in elliptic functions, the skate on
//! a slope, a rolling disc on its circle, Bennett's linkage.

use bricard_runtime::{DynamicsError, Whole, assemble, simulate};
use bricard_runtime::{Observer, Options, Probe, Step};
use std::ops::ControlFlow;

/// How long (s).
const SPAN: f64 = 10.0;

/// Tolerance of the integration, next to round-off.
const TOLERANCE: f64 = 1e-14;

/// What a run may be off (m, rad, or without unit).
const ERROR: f64 = 1e-9;

/// Compares a motion with its closed form at the end of every step.
struct Compare<F> {
    /// What is off at a state: time, coordinates, velocities.
    off: F,
    largest: f64,
    steps: usize,
}

impl<const N: usize, F: FnMut(f64, &[f64], &[f64]) -> f64> Observer<f64, N> for Compare<F> {
    fn step(
        &mut self,
        step: &Step<f64, N>,
        _probe: &mut dyn Probe<f64, N>,
    ) -> Result<ControlFlow<()>, DynamicsError<f64>> {
        let end = step.end();
        let off = (self.off)(end.t, end.q.as_slice(), end.v.as_slice());
        // A comparison with what is not a number has to fail too.
        self.largest = if off.is_nan() {
            off
        } else {
            self.largest.max(off)
        };
        self.steps += 1;
        Ok(ControlFlow::Continue(()))
    }
}

/// Runs a mechanism from its start, some values changed, beside its closed form.
fn check<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    velocities: &[(usize, f64)],
    off: impl FnMut(f64, &[f64], &[f64]) -> f64,
) {
    let mut start = mechanism.start();
    for (i, value) in velocities {
        start.v[*i].value = *value;
    }
    let state = assemble(mechanism, &start, 0.0).expect("the start assembles");
    let mut compare = Compare {
        off,
        largest: 0.0,
        steps: 0,
    };
    let options = Options::dop853(SPAN, TOLERANCE);
    let ran = simulate(mechanism, &state, &options, &mut [&mut compare]);
    assert!(ran.is_ok(), "{:?}", ran.map_err(|failure| failure.error));
    assert!(compare.steps > 20, "{} steps", compare.steps);
    assert!(
        compare.largest <= ERROR,
        "off by {:e} at most",
        compare.largest
    );
}

/// Jacobi's sn, cn and dn by descending Landen transformations (Abramowitz & Stegun,
/// 16.4), parameter m = k².
fn jacobi(u: f64, m: f64) -> [f64; 3] {
    let (mut a, mut b, mut c) = (vec![1.0], (1.0 - m).sqrt(), vec![m.sqrt()]);
    while c[c.len() - 1] > f64::EPSILON * a[a.len() - 1] {
        let last = a[a.len() - 1];
        a.push((last + b) / 2.0);
        c.push((last - b) / 2.0);
        b = (last * b).sqrt();
    }
    let n = a.len() - 1;
    let mut phi = a[n] * u * f64::powi(2.0, i32::try_from(n).expect("a few steps"));
    for i in (1..=n).rev() {
        phi = (phi + (c[i] / a[i] * phi.sin()).asin()) / 2.0;
    }
    let sn = phi.sin();
    [sn, phi.cos(), (1.0 - m * sn * sn).sqrt()]
}

#[test]
fn jacobis_functions_are_right_at_a_tabulated_argument() {
    // K(1/2) = Γ(1/4)²/(4 √π), half of which has closed forms.
    let half_period = 1.854_074_677_301_371_9;
    let [sn, cn, dn] = jacobi(half_period / 2.0, 0.5);
    let complement = 0.5_f64.sqrt();
    assert!((sn - 1.0 / (1.0 + complement).sqrt()).abs() < 1e-15);
    assert!((cn - (complement / (1.0 + complement)).sqrt()).abs() < 1e-15);
    assert!((dn - complement.sqrt()).abs() < 1e-15);
}

#[test]
fn the_heavy_top_nods_by_jacobis_functions() {
    let top = bricard::heavy_top::HeavyTop::<f64>::default();
    let p = top.parameters;
    let inertia = p.j1 + p.m * p.a * p.a;
    // With u the cosine of the lean, released at u₀ without precession,
    // u'² = (u₀ − u)(β(1 − u²) − a²(u₀ − u)), a between two of its zeros.
    let u0 = p.lean.cos();
    let a = p.j3 * p.spin0 / inertia;
    let beta = 2.0 * p.m * 9.81 * p.a / inertia;
    let root = (a.powi(4) - 4.0 * beta * (a * a * u0 - beta)).sqrt();
    let far = (a * a + root) / (2.0 * beta);
    // The product of these two is (a² u₀ − β)/β, which does not cancel.
    let low = (a * a * u0 - beta) / (beta * far);
    let rate = (beta * (far - low)).sqrt() / 2.0;
    let modulus = (u0 - low) / (far - low);
    let nod = |t: f64| {
        let [_, cn, dn] = jacobi(rate * t, modulus);
        low + (u0 - low) * (cn / dn).powi(2)
    };
    check(&top, &[], |t, e, _| {
        let u = e[0] * e[0] - e[1] * e[1] - e[2] * e[2] + e[3] * e[3];
        (u - nod(t)).abs()
    });
}

#[test]
fn the_skate_runs_across_the_slope_along_cycloids() {
    let skate = bricard::knife_edge::KnifeEdge::<f64>::default();
    let (turn, fall) = (2.0, 9.81 * skate.parameters.slope.sin());
    let size = fall / (2.0 * turn * turn);
    check(&skate, &[], |t, q, _| {
        let angle = turn * t;
        let down = size * angle.sin().powi(2);
        let across = size * (angle - (2.0 * angle).sin() / 2.0);
        let off = [q[0] - down, q[1] - across, q[2] - angle];
        off.into_iter().map(f64::abs).fold(0.0, f64::max)
    });
}

#[test]
fn a_leaning_disc_rolls_along_a_circle() {
    let disc = bricard::rolling_disc::RollingDisc::<f64>::default();
    let (r, g, lean) = (disc.parameters.r, 9.81, 10_f64.to_radians());
    // The moment of the contact force about the centre keeps the angular momentum
    // going round: Ω cos θ (3 s/2 − Ω sin θ/4) = −(g/r) sin θ, s = Ω sin θ + φ'.
    let turn: f64 = 1.0;
    let (sin, cos) = lean.sin_cos();
    let spin = (turn * turn * sin * cos / 4.0 - g / r * sin) / (1.5 * turn * cos);
    let roll = spin - turn * sin;
    let radius = r * roll / turn;
    check(&disc, &[(2, turn), (4, roll)], |t, q, _| {
        let angle = turn * t;
        let place = [radius * angle.sin(), radius * (1.0 - angle.cos())];
        let exact = [place[0], place[1], angle, lean, roll * t];
        let off = exact.iter().zip(q).map(|(x, y)| (x - y).abs());
        off.fold(0.0, f64::max)
    });
}

#[test]
fn the_angles_of_bennetts_linkage_are_tied_by_half_tangents() {
    let linkage = bricard::bennett::Bennett::<f64>::default();
    let (alpha, beta) = (linkage.parameters.alpha, linkage.parameters.beta);
    // Bennett (1903): the product of the half tangents is constant, and opposite
    // angles are opposite. Without its poles: s₁ s₂ sin((β−α)/2) = −c₁ c₂ sin((β+α)/2).
    let (less, more) = (((beta - alpha) / 2.0).sin(), ((beta + alpha) / 2.0).sin());
    check(&linkage, &[], |_, q, _| {
        let (s1, c1) = (q[0] / 2.0).sin_cos();
        let (s2, c2) = (q[1] / 2.0).sin_cos();
        let tied = s1 * s2 * less + c1 * c2 * more;
        let opposite = ((q[1] - q[2]) / 2.0).sin();
        tied.abs().max(opposite.abs())
    });
}
