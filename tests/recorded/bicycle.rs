//! The bicycle among the benchmark problems moves as the linearised equations that were published for it say.
//!
//! Source: Meijaard, Papadopoulos, Ruina and Schwab, Linearized dynamics equations for the
//! balance and steer of a bicycle, Proceedings of the Royal Society A 463 (2007) 1955–1982,
//! appendix A: `M q̈ + v C₁ q̇ + (g K₀ + v² K₂) q = 0` for lean and steer, to fourteen
//! digits. The eigenvalues that the paper prints beside them follow from these matrices
//! (its table 2), which is tested here too.

use bricard_recorded::whipple_bicycle::WhippleBicycle;
use bricard_runtime::nalgebra::{Matrix2, Matrix4, Vector4};
use bricard_runtime::{Interface, Mechanism, Options, assemble, simulate};

const G: f64 = 9.81;
const SPEED: f64 = 5.0;
/// The motion is that small (rad/s), so that what is not linear is lost in round-off.
const SMALL: f64 = 1e-5;

/// The rates of lean, steer and their velocities.
fn linear() -> Matrix4<f64> {
    let m = Matrix2::new(
        80.81722,
        2.31941332208709,
        2.31941332208709,
        0.29784188199686,
    );
    let k0 = Matrix2::new(
        -80.95,
        -2.59951685249872,
        -2.59951685249872,
        -0.80329488458618,
    );
    let k2 = Matrix2::new(0.0, 76.59734589573222, 0.0, 2.65431523794604);
    let c1 = Matrix2::new(0.0, 33.86641391492494, -0.85035641456978, 1.68540397397560);
    let inverse = m.try_inverse().expect("a mass matrix");
    let by_place = -inverse * (k0 * G + k2 * SPEED * SPEED);
    let by_speed = -inverse * c1 * SPEED;
    let mut rates = Matrix4::zeros();
    rates
        .fixed_view_mut::<2, 2>(0, 2)
        .copy_from(&Matrix2::identity());
    rates.fixed_view_mut::<2, 2>(2, 0).copy_from(&by_place);
    rates.fixed_view_mut::<2, 2>(2, 2).copy_from(&by_speed);
    rates
}

/// The exponential of a matrix: Taylor's series of a small part of it, squared.
fn exponential(matrix: Matrix4<f64>) -> Matrix4<f64> {
    const HALVINGS: i32 = 12;
    let small = matrix * 0.5_f64.powi(HALVINGS);
    let mut term = Matrix4::identity();
    let mut sum = term;
    for k in 1..12 {
        term = term * small / f64::from(k);
        sum += term;
    }
    (0..HALVINGS).fold(sum, |square, _| square * square)
}

#[test]
fn the_published_matrices_have_the_published_eigenvalues() {
    let found = linear().complex_eigenvalues();
    for (real, imaginary) in [
        (-14.0783896927982, 0.0),
        (-0.775341882195845, 4.46486771378823),
        (-0.775341882195845, -4.46486771378823),
        (-0.322866429004087, 0.0),
    ] {
        let distance =
            |z: &bricard_runtime::nalgebra::Complex<f64>| (z.re - real).hypot(z.im - imaginary);
        let least = found.iter().map(distance).fold(f64::INFINITY, f64::min);
        assert!(least < 1e-11, "{real} + {imaginary} i: {found}");
    }
}

#[test]
fn the_bicycle_leans_and_steers_as_the_linearised_equations_say() {
    let mechanism = WhippleBicycle::default();
    let structure = Mechanism::<f64, 12, 9>::structure(&mechanism);
    let place = |name: &str| {
        let found = structure.coordinates.iter().position(|q| q.name == name);
        found.unwrap_or_else(|| panic!("no {name}"))
    };
    let (lean, steer) = (place("rear.lean"), place("steer"));
    let mut start = mechanism.start();
    start.v[place("rear.turn")].value = SPEED / 0.3;
    start.v[lean].value = SMALL;
    let start = assemble::<_, _, 12, 9>(&mechanism, &start, 0.0).unwrap_or_else(|e| panic!("{e}"));
    for until in [0.5, 1.0, 2.0] {
        let options = Options::dop853(until, 1e-13);
        let end = simulate::<_, _, 12, 9>(&mechanism, &start, &options, &mut [])
            .unwrap_or_else(|failure| panic!("{failure}"))
            .end;
        // Steering is positive to the right there.
        let wanted = exponential(linear() * until) * Vector4::new(0.0, 0.0, SMALL, 0.0);
        let found = Vector4::new(end.q[lean], -end.q[steer], end.v[lean], -end.v[steer]);
        let off = (found - wanted).amax() / SMALL;
        assert!(off < 1e-6, "{off} at {until}: {found} and {wanted}");
    }
}
