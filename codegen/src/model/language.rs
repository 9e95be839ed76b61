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

/// Names that other languages have for the same.
pub const ELSEWHERE: [(&str, &str); 43] = [
    ("integral", "state z; der(z) = x;"),
    ("integrate", "state z; der(z) = x;"),
    ("int", "state z; der(z) = x;"),
    ("sqr", "x^2"),
    ("square", "x^2"),
    ("len", "norm(v)"),
    ("mag", "norm(v)"),
    ("magnitude", "norm(v)"),
    ("dist", "norm(a - b)"),
    ("fabs", "abs(x)"),
    ("arcsin", "asin(x)"),
    ("arccos", "acos(x)"),
    ("arctan", "atan(x)"),
    ("arctan2", "atan2(y, x)"),
    ("log", "ln(x)"),
    ("log10", "ln(x)/ln(10)"),
    ("log2", "ln(x)/ln(2)"),
    ("pow", "x^n"),
    ("sgn", "sign(x)"),
    ("diff", "der(x)"),
    ("ddot", "der(der(x))"),
    ("ddt", "der(x)"),
    ("d", "der(x)"),
    ("length", "norm(v)"),
    ("hypot", "norm([x, y])"),
    ("cot", "1/tan(x)"),
    ("cbrt", "x^(1/3)"),
    ("velocity", "der(x)"),
    ("vel", "der(x)"),
    ("derivative", "der(x)"),
    ("deriv", "der(x)"),
    ("D", "der(x)"),
    ("acceleration", "der(der(x))"),
    ("acc", "der(der(x))"),
    ("der2", "der(der(x))"),
    ("sind", "sin(x*deg)"),
    ("cosd", "cos(x*deg)"),
    ("tand", "tan(x*deg)"),
    ("radians", "x*deg"),
    ("deg2rad", "x*deg"),
    ("degrees", "x/deg"),
    ("rad2deg", "x/deg"),
    ("power", "x^n"),
];

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
