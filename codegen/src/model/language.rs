//! The functions of the language that take more than a number, and what other languages
//! call them.

/// Functions of more than one number or of something else than a number: name,
/// number of arguments, how they are written.
pub const OTHERS: [(&str, usize, &str); 17] = [
    ("atan2", 2, "atan2(y, x)"),
    ("min", 2, "min(a, b)"),
    ("max", 2, "max(a, b)"),
    ("der", 1, "der(x)"),
    ("dot", 2, "dot(a, b)"),
    ("cross", 2, "cross(a, b)"),
    ("norm", 1, "norm(v)"),
    ("norm2", 1, "norm2(v)"),
    ("transpose", 1, "transpose(R)"),
    ("rot", 2, "rot(angle)` in the plane, `rot(axis, angle)"),
    ("rotx", 1, "rotx(angle)"),
    ("roty", 1, "roty(angle)"),
    ("rotz", 1, "rotz(angle)"),
    ("quat", 4, "quat(e0, e1, e2, e3)"),
    ("omega", 1, "omega(R)"),
    ("table", 2, "table([[0, 1], [2, 3]], x)"),
    ("spline", 2, "spline([[0, 1], [2, 3]], x)"),
];

/// Names that other languages have, and how the same is written here.
const ELSEWHERE: [(&[&str], &str); 25] = [
    (&["integral", "integrate", "int"], "state z; der(z) = x;"),
    (&["sqr", "square"], "x^2"),
    (&["len", "mag", "magnitude", "length"], "norm(v)"),
    (&["dist"], "norm(a - b)"),
    (&["fabs"], "abs(x)"),
    (&["arcsin"], "asin(x)"),
    (&["arccos"], "acos(x)"),
    (&["arctan"], "atan(x)"),
    (&["arctan2"], "atan2(y, x)"),
    (&["log"], "ln(x)"),
    (&["log10"], "ln(x)/ln(10)"),
    (&["log2"], "ln(x)/ln(2)"),
    (&["pow", "power"], "x^n"),
    (&["sgn"], "sign(x)"),
    (&["diff", "ddt", "d", "D"], "der(x)"),
    (&["derivative", "deriv", "velocity", "vel"], "der(x)"),
    (&["ddot", "acceleration", "acc", "der2"], "der(der(x))"),
    (&["hypot"], "norm([x, y])"),
    (&["cot"], "1/tan(x)"),
    (&["cbrt"], "x^(1/3)"),
    (&["sind"], "sin(x*deg)"),
    (&["cosd"], "cos(x*deg)"),
    (&["tand"], "tan(x*deg)"),
    (&["radians", "deg2rad"], "x*deg"),
    (&["degrees", "rad2deg"], "x/deg"),
];

/// How what a name stands for in other languages is written here.
pub fn from_elsewhere(name: &str) -> Option<&'static str> {
    let found = ELSEWHERE.iter().find(|(names, _)| names.contains(&name));
    found.map(|(_, form)| *form)
}

/// Functions of other languages that jump again and again.
pub const JUMPING: [&str; 10] = [
    "mod", "modulo", "fmod", "rem", "floor", "ceil", "ceiling", "round", "trunc", "frac",
];

/// What columns of reactions begin with.
pub const REACTION: &str = "reaction";

/// Whether a name is that of a function (those of one number aside).
pub fn known(name: &str) -> bool {
    other_functions().any(|known| known == name)
}

/// The names of all functions but those of one number.
pub fn other_functions() -> impl Iterator<Item = &'static str> + Clone {
    OTHERS.iter().map(|(name, ..)| *name).chain(["sum"])
}
