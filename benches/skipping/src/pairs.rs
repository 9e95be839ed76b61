//! Pairs of descriptions that differ in one thing, which the first needs and the second does
//! not. The build script compiles them, and the program runs them.

/// Two descriptions that differ in one thing.
pub struct Pair {
    /// A name for its modules.
    pub name: &'static str,
    /// What the first needs and the second does not.
    pub what: &'static str,
    /// What is left out then.
    pub left_out: &'static str,
    /// The body that both begin with.
    pub common: &'static str,
    /// What the first adds, and the second.
    pub adds: [&'static str; 2],
}

/// A cart with a mass on a rod.
const CART: &str = "const m: kg = 1; const l: m = 2; const w: 1/s = 1; coord x: m; coord a: rad;
    kinetic 1/2*m*der(x)^2; start { a = 1; der(x) = 0.1; }";

/// A mass on a circle or elsewhere.
const HUNG: &str = "const m: kg = 1; const l: m = 1; const g: m/s^2 = 9.81;
    coord x: m; coord y: m; potential m*g*y; start { x = 0.6; y ~ -0.8; }";

const FREE: &str = "kinetic 1/2*m*(der(x)^2 + der(y)^2); potential m*g*l;";
const ON_CIRCLE: &str = "kinetic 1/2*m*(der(x)^2 + der(y)^2); constraint x^2 + y^2 = l^2;";

/// A parallelogram that swings through the position in which its rods lie in one line.
const ROW: &str = "const m: kg = 1; const l: m = 1; const g: m/s^2 = 9.81;
    coord a: rad; coord b: rad; coord c: rad;
    let left = l*[cos(a), sin(a)]; let right = l*[1 + cos(b), sin(b)];
    kinetic 1/6*m*l^2*(der(a)^2 + der(b)^2) + 1/2*m*norm2(der(left)) + 1/24*m*l^2*der(c)^2;
    potential m*g*(left.y + right.y); start { a = 0.5; der(a) = -9; b ~ 0.5; c ~ 0; }";

/// Two such parallelograms, of which one swings through that position.
const TWO_ROWS: &str = "const m: kg = 1; const l: m = 1; const g: m/s^2 = 9.81;
    coord a[2]: rad; coord b[2]: rad; coord c[2]: rad;
    for i in 0..2 {
        let left = l*[cos(a[i]), sin(a[i])]; let right = l*[1 + cos(b[i]), sin(b[i])];
        kinetic 1/6*m*l^2*(der(a[i])^2 + der(b[i])^2) + 1/2*m*norm2(der(left)) + 1/24*m*l^2*der(c[i])^2;
        potential m*g*(left.y + right.y);
        constraint left + l*[cos(c[i]), sin(c[i])] = right;
    }
    start { a[0] = 0.5; der(a[0]) = -9; b[0] ~ 0.5; c[0] ~ 0; a[1] = -1.5; b[1] ~ -1.5; c[1] ~ 0; }";

/// All pairs.
pub const PAIRS: &[Pair] = &[
    Pair {
        name: "mass",
        what: "a mass matrix that changes",
        left_out: "Coriolis terms, slopes of M, and its factorisation but for the first",
        common: CART,
        adds: [
            "let P = [x + l*sin(a), -l*cos(a)]; kinetic 1/2*m*norm2(der(P)); potential m*l^2*w^2*(1 - cos(a));",
            "let P = [x + l*a, l]; kinetic 1/2*m*norm2(der(P)); potential m*l^2*w^2*(1 - cos(a));",
        ],
    },
    Pair {
        name: "ignorable",
        what: "the value of a coordinate",
        left_out: "functions of the coordinate",
        common: CART,
        adds: [
            "let P = [x + l*sin(a), -l*cos(a)]; kinetic 1/2*m*norm2(der(P)); potential m*l^2*w^2*(1 - cos(a)) + m*l^2*w^2*sin(x/l);",
            "let P = [x + l*sin(a), -l*cos(a)]; kinetic 1/2*m*norm2(der(P)); potential m*l^2*w^2*(1 - cos(a));",
        ],
    },
    Pair {
        name: "constraints",
        what: "constraints",
        left_out: "multipliers, corrections, verification, singular configurations",
        common: HUNG,
        adds: [ON_CIRCLE, FREE],
    },
    Pair {
        name: "rank",
        what: "constraints that a parameter may make dependent",
        left_out: "the search for singular configurations",
        common: HUNG,
        adds: [
            "param r = 1; kinetic 1/2*m*(der(x)^2 + der(y)^2); constraint x^2 + y^2 = r*l^2;",
            ON_CIRCLE,
        ],
    },
    Pair {
        name: "clock",
        what: "time in the constraints",
        left_out: "derivatives of the constraints with respect to time",
        common: HUNG,
        adds: [
            "const w: 1/s = 1; kinetic 1/2*m*(der(x)^2 + der(y)^2); constraint x^2 + y^2 = (l*(1 + 0.1*sin(w*t)))^2;",
            ON_CIRCLE,
        ],
    },
    Pair {
        name: "zeros",
        what: "all entries of M",
        left_out: "what zeros would be multiplied with",
        common: HUNG,
        adds: [
            "kinetic 1/2*m*(der(x)^2 + der(y)^2 + der(x)*der(y)); constraint x^2 + y^2 = l^2;",
            ON_CIRCLE,
        ],
    },
    Pair {
        name: "ties",
        what: "a tie between two parts",
        left_out: "entries of one part for the other",
        common: "const m: kg = 1; const l: m = 1; const g: m/s^2 = 9.81;
            coord x: m; coord y: m; coord u: m; coord v: m;
            constraint x^2 + y^2 = l^2; constraint u^2 + v^2 = l^2;
            start { x = 0.6; y ~ -0.8; u = 0.8; v ~ -0.6; }",
        adds: [
            "const k: N/m = 5; kinetic 1/2*m*(der(x)^2 + der(y)^2 + der(u)^2 + der(v)^2) + 1/4*m*(der(x) + der(u))^2; potential m*g*(y + v) + 1/2*k*((x - u)^2 + (y - v)^2);",
            "kinetic 1/2*m*(der(x)^2 + der(y)^2 + der(u)^2 + der(v)^2); potential m*g*(y + v);",
        ],
    },
    Pair {
        name: "parameters",
        what: "parameters that can be set",
        left_out: "what can be computed when the code is generated",
        common: "const l: m = 2; const w: 1/s = 1; coord x: m; coord a: rad;
            let P = [x + l*sin(a), -l*cos(a)]; start { a = 1; der(x) = 0.1; }
            kinetic 1/2*m*der(x)^2 + 1/2*n*norm2(der(P)); potential n*l^2*w^2*(1 - cos(a)) + 1/2*k*x^2;",
        adds: [
            "param m: kg = 1; param n: kg = 2; param k: N/m = 3;",
            "const m: kg = 1; const n: kg = 2; const k: N/m = 3;",
        ],
    },
    Pair {
        name: "conditions",
        what: "conditions in the forces",
        left_out: "the search for where they change",
        common: HUNG,
        adds: [
            "kinetic 1/2*m*(der(x)^2 + der(y)^2); constraint x^2 + y^2 = l^2; force (if x < -5*l then m*g else -m*g) on x;",
            ON_CIRCLE,
        ],
    },
    Pair {
        name: "passage",
        what: "constraints that move, through a singular position",
        left_out: "nodes for each state: those of the first serve all",
        common: ROW,
        adds: [
            "const w: 1/s = 1; param shake = 0; constraint left + l*[cos(c), sin(c)] = right + l*[shake*sin(w*t), 0];",
            "constraint left + l*[cos(c), sin(c)] = right;",
        ],
    },
    Pair {
        name: "sheets",
        what: "a tie between the masses of two loops, of which one passes a singular position",
        left_out: "all that is sought there for the other",
        common: TWO_ROWS,
        adds: ["kinetic 1/50*m*l^2*der(a[0])*der(a[1]);", ""],
    },
];
