//! The scalar: functions against values of 40 digits, text, edges of the range.

mod sines;

use bricard_reference::DoubleDouble;
use bricard_runtime::Real;
use num_traits::{Num, Zero};

/// Units in the last of 106 places that a function may be off by.
const UNITS: f64 = 16.0;

/// Function, argument, value.
const VALUES: [(&str, &str, &str); 45] = [
    ("sin", "0.1", "0.09983341664682815230681419841062202698992"),
    ("sin", "0.75", "0.6816387600233341667332419527798939353384"),
    ("sin", "2.5", "0.5984721441039564940518547021861622717036"),
    (
        "sin",
        "-40.3",
        "-0.5147401169238356705051600214115419977931",
    ),
    (
        "sin",
        "1000.7",
        "0.9947269042801553365882103415036296594008",
    ),
    (
        "sin",
        "3.14159265358979",
        "3.23846264338327950288419716939371446727e-15",
    ),
    ("cos", "0.1", "0.9950041652780257660955619878038702948386"),
    ("cos", "1.5", "0.07073720166770291008818985143426870908509"),
    ("cos", "2.5", "-0.8011436155469337148335027904673516644286"),
    (
        "cos",
        "-40.3",
        "-0.8573462614540498378279150753949845492776",
    ),
    (
        "cos",
        "1000.7",
        "-0.1025591824324798462586088983817173534621",
    ),
    ("tan", "0.3", "0.3093362496096232330353036796982946672578"),
    ("tan", "-1.2", "-2.572151622126318935409994236033363956529"),
    ("tan", "4", "1.15782128234957758313734241826732392312"),
    (
        "asin",
        "0.001",
        "0.001000000166666741666711309554191490626145",
    ),
    ("asin", "0.5", "0.5235987755982988730771072305465838140329"),
    (
        "asin",
        "-0.99",
        "-1.429256853470469400485532334664724427105",
    ),
    ("acos", "0.001", "1.569796326628229877564610382085559951472"),
    ("acos", "0.5", "1.047197551196597746154214461093167628066"),
    ("acos", "-0.99", "3.000053180265366019716854026304475869203"),
    (
        "atan",
        "0.001",
        "0.0009999996666668666665238096349205440116209",
    ),
    ("atan", "1", "0.7853981633974483096156608458198757210493"),
    (
        "atan",
        "-1e10",
        "-1.570796326694896619231321691640084775432",
    ),
    (
        "sinh",
        "1e-10",
        "0.0000000001000000000000000000001666666666666666667",
    ),
    ("sinh", "0.3", "0.304520293447142618958435267005095229098"),
    ("sinh", "-2", "-3.626860407847018767668213982801261704886"),
    ("sinh", "20", "242582597.7048951379539766040514913653593"),
    ("cosh", "0.3", "1.04533851412886048502530904632291210128"),
    ("cosh", "-2", "3.762195691083631459562213477773746108294"),
    ("cosh", "20", "242582597.7048951400151302264900491933253"),
    (
        "tanh",
        "1e-5",
        "0.00000999999999966666666667999999999946031746",
    ),
    ("tanh", "0.3", "0.2913126124515909058182212728237659281536"),
    ("tanh", "-2", "-0.964027580075816883946413724100923150255"),
    ("tanh", "60", "1.0"),
    ("exp", "1e-10", "1.000000000100000000005000000000166666667"),
    ("exp", "1", "2.718281828459045235360287471352662497757"),
    (
        "exp",
        "-30.5",
        "5.675685232632722461872788723806651277148e-14",
    ),
    (
        "exp",
        "100",
        "2.688117141816135448412625551580013587361e+43",
    ),
    ("ln", "0.5", "-0.6931471805599453094172321214581765680755"),
    ("ln", "2", "0.6931471805599453094172321214581765680755"),
    ("ln", "1e100", "230.2585092994045684017991454684364207601"),
    ("ln", "3e-100", "-229.1598970107364587104039002315138950555"),
    ("sqrt", "2", "1.41421356237309504880168872420969807857"),
    (
        "sqrt",
        "1e-7",
        "0.000316227766016837933199889354443271853372",
    ),
    (
        "sqrt",
        "3e200",
        "1.732050807568877293527446341505872366943e+100",
    ),
];

fn number(text: &str) -> DoubleDouble {
    DoubleDouble::from_str_radix(text, 10).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn function(name: &str, x: DoubleDouble) -> DoubleDouble {
    match name {
        "sin" => x.sin_cos().0,
        "cos" => x.sin_cos().1,
        "tan" => x.tan(),
        "asin" => x.asin(),
        "acos" => x.acos(),
        "atan" => x.atan(),
        "sinh" => x.sinh(),
        "cosh" => x.cosh(),
        "tanh" => x.tanh(),
        "exp" => x.exp(),
        "ln" => x.ln(),
        "sqrt" => x.sqrt(),
        _ => panic!("no function {name}"),
    }
}

#[test]
fn functions_have_thirty_digits() {
    for (name, x, value) in VALUES {
        let (x, exact) = (number(x), number(value));
        let found = function(name, x);
        let error = ((found - exact) / exact).abs();
        // An argument is itself known to a unit in its last place only.
        let nearby = function(name, x * (DoubleDouble::from(1.0) + DoubleDouble::EPSILON));
        let inherited = ((nearby - exact) / exact).abs();
        let bound = DoubleDouble::EPSILON * DoubleDouble::from(UNITS) + inherited;
        assert!(error <= bound, "{name}({x}) = {found}, off by {error:.1}");
    }
}

#[test]
fn arcs_know_their_quadrant() {
    let turn = |y: f64, x: f64| DoubleDouble::from(y).atan2(DoubleDouble::from(x));
    let pi = DoubleDouble::pi();
    assert_eq!(turn(0.0, -1.0), pi);
    assert_eq!(turn(1.0, 0.0) + turn(1.0, 0.0), pi);
    assert!((turn(-1.0, -1.0) + pi * number("0.75")).abs() < DoubleDouble::EPSILON * pi);
    assert!(turn(0.0, 0.0).is_zero());
    assert_eq!(turn(1e300, 1e300), turn(1.0, 1.0));
}

#[test]
fn powers_of_whole_exponents_are_products() {
    let x = number("1.1");
    assert_eq!(x.powf(DoubleDouble::from(3.0)), x * x * x);
    assert_eq!((-x).powf(DoubleDouble::from(2.0)), x * x);
    assert_eq!(x.powf(DoubleDouble::zero()), DoubleDouble::from(1.0));
    let root = x.powf(DoubleDouble::from(0.5)) - x.sqrt();
    assert!(root.abs() <= DoubleDouble::EPSILON);
}

#[test]
fn numbers_read_back_as_they_are_written() {
    for text in [
        "1",
        "-2.5e-7",
        "6.02214076e23",
        "0.1",
        "99999999999999999999.9",
        "1e-200",
    ] {
        let value = number(text);
        let again = number(&value.to_string());
        let error = (again - value).abs();
        assert!(
            error <= value.abs() * DoubleDouble::EPSILON,
            "{text}: {value}"
        );
    }
    assert_eq!(format!("{:.3}", number("9.99996")), "1.000e1");
    assert_eq!(format!("{:.4}", number("-0.000123456")), "-1.2346e-4");
    for text in ["", "-", "1.2.3", "1e", "0x1", "one"] {
        assert!(DoubleDouble::from_str_radix(text, 10).is_err(), "{text}");
    }
}

#[test]
fn what_leaves_the_range_behaves_as_in_53_bits() {
    let infinity = DoubleDouble::from(1.0) / DoubleDouble::zero();
    assert_eq!(infinity.to_f64(), f64::INFINITY);
    assert!(!infinity.is_finite());
    assert_eq!((infinity + DoubleDouble::from(1.0)).to_f64(), f64::INFINITY);
    assert_eq!(
        infinity.min(DoubleDouble::from(2.0)),
        DoubleDouble::from(2.0)
    );
    let none = infinity - infinity;
    assert!(none.to_f64().is_nan());
    for value in [none.max(infinity), infinity.max(none), none.min(infinity)] {
        assert!(
            value.to_f64().is_nan(),
            "what is no number is not swallowed"
        );
    }
    assert_eq!(DoubleDouble::from(1e4).exp().to_f64(), f64::INFINITY);
    assert!(DoubleDouble::from(-1.0).sqrt().to_f64().is_nan());
    assert_eq!(DoubleDouble::zero().sqrt(), DoubleDouble::zero());
}
