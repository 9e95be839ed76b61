//! Every form of expression, its value and its `der`, against dual numbers at random
//! points: the same mathematics, written again in Rust.

use super::accept;
use bricard_codegen::internals::expr::Symbol;
use bricard_testkit::Random;
use num_dual::{Dual64, DualNum};

/// Random points per form.
const POINTS: u64 = 20;

/// What a value may be off, relative to the largest number it is made of here.
const ROUND_OFF: f64 = 1e-13;

/// Two coordinates, the time and a parameter, with their rates.
#[derive(Clone, Copy, Debug)]
struct Point {
    q: Dual64,
    w: Dual64,
    t: Dual64,
    a: Dual64,
}

impl Point {
    /// A point between 0.1 and 0.9, with rates between −1 and 1.
    fn random(seed: u64) -> Self {
        let mut random = Random::seeded(seed);
        let values: [f64; 4] = std::array::from_fn(|_| random.between(0.1, 0.9));
        let rates = [random.within(1.0), random.within(1.0), 1.0, 0.0];
        let [q, w, t, a] = std::array::from_fn(|i| Dual64::new(values[i], rates[i]));
        Point { q, w, t, a }
    }

    fn value(&self, symbol: Symbol) -> f64 {
        match symbol {
            Symbol::Time => self.t.re,
            Symbol::Coordinate(0) => self.q.re,
            Symbol::Coordinate(_) => self.w.re,
            Symbol::Velocity(0) => self.q.eps,
            Symbol::Velocity(_) => self.w.eps,
            Symbol::Parameter(_) => self.a.re,
            other => unreachable!("no form has {other:?}"),
        }
    }
}

type Vector = [Dual64; 3];
type Rows = [Vector; 3];

fn number(x: f64) -> Dual64 {
    Dual64::from(x)
}

/// The rotation about an axis.
fn turn(axis: usize, angle: Dual64) -> Rows {
    let (s, c) = (angle.sin(), angle.cos());
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut rows = [[number(0.0); 3]; 3];
    rows[axis][axis] = number(1.0);
    rows[next][next] = c;
    rows[last][last] = c;
    rows[next][last] = -s;
    rows[last][next] = s;
    rows
}

fn dot(a: Vector, b: Vector) -> Dual64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

fn transpose(m: Rows) -> Rows {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

fn apply(m: Rows, v: Vector) -> Vector {
    m.map(|row| dot(row, v))
}

fn product(m: Rows, n: Rows) -> Rows {
    let columns = transpose(n);
    m.map(|row| columns.map(|column| dot(row, column)))
}

/// The rotation by Hamilton's product e v e⁻¹, of any length of e.
fn by_quaternion(e: [Dual64; 4]) -> Rows {
    let square = e.iter().fold(number(0.0), |sum, x| sum + x * x);
    let imaginary = [e[1], e[2], e[3]];
    let turned = |v: Vector| -> Vector {
        let first = cross(imaginary, v);
        let second = cross(imaginary, first);
        std::array::from_fn(|i| v[i] + (e[0] * first[i] + second[i]) * number(2.0) / square)
    };
    let axis = |k: usize| -> Vector { std::array::from_fn(|i| number(f64::from(i == k))) };
    transpose([turned(axis(0)), turned(axis(1)), turned(axis(2))])
}

/// The angular velocity in the body: the vector of RᵀṘ. No derivative comes with it.
fn spin(m: Rows) -> Vector {
    let entry = |i: usize, j: usize| -> f64 { (0..3).map(|k| m[k][i].re * m[k][j].eps).sum() };
    [entry(2, 1), entry(0, 2), entry(1, 0)].map(number)
}

/// Euler parameters on the unit sphere.
fn unit(p: Point) -> [Dual64; 4] {
    let e = [p.q, p.w, p.t, number(1.0)];
    let length = e.iter().fold(number(0.0), |sum, x| sum + x * x).sqrt();
    e.map(|x| x / length)
}

const EULER: &str = "let E = [q, w, t, 1]/norm([q, w, t, 1]);";

/// A form, names that it needs, and what it is; whether `der` may be taken of it.
struct Form {
    needs: &'static str,
    text: &'static str,
    is: fn(Point) -> Vec<Dual64>,
    smooth: bool,
}

fn smooth(text: &'static str, is: fn(Point) -> Vec<Dual64>) -> Form {
    Form {
        needs: "",
        text,
        is,
        smooth: true,
    }
}

fn with_rates(text: &'static str, is: fn(Point) -> Vec<Dual64>) -> Form {
    Form {
        smooth: false,
        ..smooth(text, is)
    }
}

fn needing(needs: &'static str, form: Form) -> Form {
    Form { needs, ..form }
}

/// The output of a form has the expected components, and so has its derivative.
fn check(forms: &[Form]) {
    for form in forms {
        let Form { needs, text, .. } = form;
        let rate = if form.smooth {
            format!("output r = der({text});")
        } else {
            String::new()
        };
        let m = accept(&format!(
            "mechanism Test {{ param a = 1; coord q; coord w; kinetic der(q)^2 + der(w)^2;
              {needs} output v = {text}; {rate} }}"
        ));
        for seed in 0..POINTS {
            let point = Point::random(seed);
            let expected = (form.is)(point);
            let found = |letter: char| -> Vec<f64> {
                let outputs = m.outputs.iter();
                let outputs = outputs.filter(|o| o.quantity.name.starts_with(letter));
                outputs
                    .map(|o| m.graph.evaluate(o.value, &|symbol| point.value(symbol)))
                    .collect()
            };
            let agree = |found: Vec<f64>, expected: Vec<f64>, what: &str| {
                assert_eq!(found.len(), expected.len(), "{what} of {text}");
                let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
                for (found, expected) in found.iter().zip(&expected) {
                    let error = (found - expected).abs() / scale;
                    assert!(
                        error <= ROUND_OFF,
                        "{what} of {text}, seed {seed}: {found} instead of {expected}"
                    );
                }
            };
            agree(found('v'), expected.iter().map(|x| x.re).collect(), "value");
            if form.smooth {
                agree(found('r'), expected.iter().map(|x| x.eps).collect(), "rate");
            }
        }
    }
}

#[test]
fn arithmetic_and_functions_have_the_values_and_rates_of_dual_numbers() {
    check(&[
        smooth("q + w - t - -a", |p| vec![p.q + p.w - p.t + p.a]),
        smooth("q*w/t/a*3", |p| vec![p.q * p.w / p.t / p.a * number(3.0)]),
        smooth("-q^2 + 2^-1*w^-3", |p| {
            vec![-(p.q * p.q) + p.w.powi(-3) * number(0.5)]
        }),
        smooth("q^2^3 + w^0.5 + t^(1/3)", |p| {
            vec![p.q.powi(8) + p.w.sqrt() + p.t.powf(1.0 / 3.0)]
        }),
        smooth("q^w + a^t", |p| vec![p.q.powd(p.w) + p.a.powd(p.t)]),
        smooth("sin(q*w) + cos(t - q) + tan(a*w)", |p| {
            vec![(p.q * p.w).sin() + (p.t - p.q).cos() + (p.a * p.w).tan()]
        }),
        smooth("asin(q*w) + acos(t*a) + atan(q/w)", |p| {
            vec![(p.q * p.w).asin() + (p.t * p.a).acos() + (p.q / p.w).atan()]
        }),
        smooth("atan2(q - w, t) + atan2(-q, -w)", |p| {
            vec![(p.q - p.w).atan2(p.t) + (-p.q).atan2(-p.w)]
        }),
        smooth("sinh(q*t) + cosh(w - a) + tanh(q + w)", |p| {
            vec![(p.q * p.t).sinh() + (p.w - p.a).cosh() + (p.q + p.w).tanh()]
        }),
        smooth("exp(q*w) + ln(t*w) + sqrt(a + q)", |p| {
            vec![(p.q * p.w).exp() + (p.t * p.w).ln() + (p.a + p.q).sqrt()]
        }),
        smooth("pi*q + 30*deg*w", |p| {
            let third = std::f64::consts::PI / 6.0;
            vec![p.q * number(std::f64::consts::PI) + p.w * number(third)]
        }),
        smooth("sum(i in 1..4, q^i*sum(j in 0..i, w + j))", |p| {
            let inner = |i: i32| (0..i).fold(number(0.0), |sum, j| sum + p.w + f64::from(j));
            vec![(1..4).fold(number(0.0), |sum, i| sum + p.q.powi(i) * inner(i))]
        }),
    ]);
}

#[test]
fn what_has_kinks_has_the_values_of_dual_numbers() {
    check(&[
        with_rates("abs(q - w) + sign(w - t)*q", |p| {
            let sign = (p.w.re - p.t.re).signum();
            vec![number((p.q.re - p.w.re).abs()) + p.q * number(sign)]
        }),
        with_rates("min(q, w) - 2*max(q*a, t)", |p| {
            let (least, most) = (p.q.re.min(p.w.re), (p.q.re * p.a.re).max(p.t.re));
            vec![number(least - 2.0 * most)]
        }),
        with_rates(
            "if q < w then der(q) else if w >= t then q*der(w) else -t",
            |p| {
                let choice = match (p.q.re < p.w.re, p.w.re >= p.t.re) {
                    (true, _) => p.q.eps,
                    (_, true) => p.q.re * p.w.eps,
                    _ => -p.t.re,
                };
                vec![number(choice)]
            },
        ),
        with_rates("if q != w then [q, w, t] else [1, 1, 1]", |p| {
            vec![p.q, p.w, p.t]
        }),
        with_rates(
            "if q == w then 1 else if q > 2 then 2 else if w <= 3 then a else 3",
            |p| vec![p.a],
        ),
        with_rates("der(q)^2*w + der(w*q)/der(t + w)", |p| {
            let rate = (p.w * p.q).eps / (1.0 + p.w.eps);
            vec![number(p.q.eps * p.q.eps * p.w.re + rate)]
        }),
    ]);
}

#[test]
fn vectors_and_matrices_have_the_values_and_rates_of_dual_numbers() {
    let v = "let u = [q, w*t, sin(w)]; let v = [t, a, q*w];";
    fn u(p: Point) -> Vector {
        [p.q, p.w * p.t, p.w.sin()]
    }
    fn w(p: Point) -> Vector {
        [p.t, p.a, p.q * p.w]
    }
    fn m(p: Point) -> Rows {
        [u(p), w(p), [number(1.0), p.q, p.w]]
    }
    let rows = "let u = [q, w*t, sin(w)]; let v = [t, a, q*w]; let M = [u, v, [1, q, w]];";
    check(&[
        needing(
            v,
            smooth("u + 2*v - u/a", |p| {
                (0..3)
                    .map(|i| u(p)[i] + w(p)[i] * number(2.0) - u(p)[i] / p.a)
                    .collect()
            }),
        ),
        needing(v, smooth("-u*q", |p| u(p).map(|x| -x * p.q).to_vec())),
        needing(
            v,
            smooth("dot(u, v) + u.x*v.y - u[2]*v.z", |p| {
                let (u, w) = (u(p), w(p));
                vec![dot(u, w) + u[0] * w[1] - u[2] * w[2]]
            }),
        ),
        needing(
            v,
            smooth("norm(u) + norm2(v)", |p| {
                vec![dot(u(p), u(p)).sqrt() + dot(w(p), w(p))]
            }),
        ),
        needing(v, smooth("cross(u, v)", |p| cross(u(p), w(p)).to_vec())),
        smooth("cross([q, w], [t, a])", |p| vec![p.q * p.a - p.w * p.t]),
        needing(rows, smooth("M*u", |p| apply(m(p), u(p)).to_vec())),
        needing(
            rows,
            smooth("transpose(M)*v", |p| apply(transpose(m(p)), w(p)).to_vec()),
        ),
        needing(
            rows,
            smooth("M*transpose(M)", |p| {
                product(m(p), transpose(m(p))).concat()
            }),
        ),
        needing(
            rows,
            smooth("q*M - M/w + -M", |p| {
                let part = |x: &Dual64| *x * p.q - *x / p.w - *x;
                m(p).concat().iter().map(part).collect()
            }),
        ),
        needing(
            rows,
            smooth("M[1][2] + M[2].y + dot(M[0], v)", |p| {
                vec![m(p)[1][2] + m(p)[2][1] + dot(m(p)[0], w(p))]
            }),
        ),
        needing(
            "let h[i in 0..4] = if i == 0 then q else h[i-1]*w + i;",
            smooth("h[3]", |p| {
                let step = |h: Dual64, i: i32| h * p.w + f64::from(i);
                vec![(1..4).fold(p.q, step)]
            }),
        ),
        needing(
            "let h[i in 1..4] = [q^i, w*i];",
            smooth("sum(i in 1..4, h[i].x*h[4-i].y)", |p| {
                let term = |i: i32| p.q.powi(i) * p.w * f64::from(4 - i);
                vec![(1..4).fold(number(0.0), |sum, i| sum + term(i))]
            }),
        ),
    ]);
}

#[test]
fn rotations_and_their_angular_velocity_are_those_of_dual_numbers() {
    let chain = "let R = rotz(q)*rotx(w*t)*roty(a*q - w);";
    fn r(p: Point) -> Rows {
        let first = product(turn(2, p.q), turn(0, p.w * p.t));
        product(first, turn(1, p.a * p.q - p.w))
    }
    fn euler(p: Point) -> Rows {
        by_quaternion(unit(p))
    }
    check(&[
        smooth("rotx(q)", |p| turn(0, p.q).concat()),
        smooth("roty(q*t)", |p| turn(1, p.q * p.t).concat()),
        smooth("rotz(w - a)", |p| turn(2, p.w - p.a).concat()),
        needing(chain, smooth("R", |p| r(p).concat())),
        needing(chain, with_rates("omega(R)", |p| spin(r(p)).to_vec())),
        needing(
            chain,
            with_rates("omega(transpose(R))", |p| spin(transpose(r(p))).to_vec()),
        ),
        needing(
            chain,
            with_rates("R*omega(R)", |p| apply(r(p), spin(r(p))).to_vec()),
        ),
        needing(
            EULER,
            smooth("quat(E[0], E[1], E[2], E[3])", |p| euler(p).concat()),
        ),
        needing(
            EULER,
            with_rates("omega(quat(E[0], E[1], E[2], E[3]))", |p| {
                spin(euler(p)).to_vec()
            }),
        ),
        needing(
            EULER,
            with_rates("omega(rotz(q)*quat(E[0], E[1], E[2], E[3]))", |p| {
                spin(product(turn(2, p.q), euler(p))).to_vec()
            }),
        ),
        with_rates(
            "omega([[cos(q), -sin(q), 0], [sin(q), cos(q), 0], [0, 0, 1]])",
            |p| vec![number(0.0), number(0.0), number(p.q.eps)],
        ),
    ]);
}
