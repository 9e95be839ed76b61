//! Every error of the runtime can be provoked, and says when, what and what to try.
//!
//! The tables have whole messages, with `…` for a number that depends on steps, and stand
//! on the page of messages. The kinds of each error are read from its source, so that a new
//! one needs a case.

mod point;
mod runs;
mod starts;

use bricard_runtime::{
    AssemblyError, BadInterval, DynamicsError, IntegrateError, SimulateError, Singularity, Watched,
};
use bricard_testkit::page::{hold_section, prose, row};
use bricard_testkit::variants;
use std::path::Path;

/// What is provoked, how, in words and in Rust, and what is said then.
type Case = (&'static str, &'static str, fn() -> Said, &'static str);

/// The tables, each with what it is about.
const TABLES: [(&str, &[Case]); 4] = [
    ("Starts", starts::STARTS),
    ("Where a motion can't go on", runs::MOTIONS),
    ("Steps and tolerances", runs::STEPS),
    ("What can't be asked of a run", runs::ASKED),
];

const INTRODUCTION: &str = "\
These are said by `bricard simulate`, and by the runtime to programs of one's own. \
Here they are about a unit mass in the plane with the coordinates `x` and `y`, on one \
constraint, which they call `g = 0` (line 3); `…` stands for a number that depends on the \
steps.
";

/// An error that was provoked: the names of its variant and of those within it.
struct Said {
    variants: Vec<&'static str>,
    text: String,
}

impl Said {
    fn of<V, E: Variants + std::error::Error>(result: Result<V, E>) -> Self {
        match result {
            Ok(_) => Self {
                variants: Vec::new(),
                text: "nothing".to_string(),
            },
            Err(error) => Self {
                variants: all_of(&error),
                text: error.to_string(),
            },
        }
    }
}

/// An error of several kinds.
trait Variants {
    const ALL: &'static [&'static str];
    fn name(&self) -> &'static str;
    /// The names of the errors in this one.
    fn within(&self) -> Vec<&'static str>;
}

/// Lists the variants of an error, and what is within some.
macro_rules! variants {
    ($error:ident $(<$($of:tt),+>)?: $($variant:ident),+; $($holds:pat => $inner:expr),*) => {
        impl Variants for $error $(<$($of),+>)? {
            const ALL: &'static [&'static str] =
                &[$(concat!(stringify!($error), "::", stringify!($variant))),+];

            fn name(&self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => {
                        concat!(stringify!($error), "::", stringify!($variant))
                    })+
                    _ => "an error that is not listed here",
                }
            }

            fn within(&self) -> Vec<&'static str> {
                match self {
                    $($holds => all_of($inner),)*
                    _ => Vec::new(),
                }
            }
        }
    };
}

fn all_of<E: Variants>(error: &E) -> Vec<&'static str> {
    let mut all = vec![error.name()];
    all.extend(error.within());
    all
}

variants!(Singularity: Unresolved, Turning, Touching, Drifted, Undetermined, Vanishing, Kink;);
variants!(
    Watched: KineticEnergy, PotentialEnergy, Power, ConstraintError, Event, Condition;
);
variants!(
    DynamicsError<f64>:
    NotFinite, WatchedNotFinite, SingularPosition, SingularConfiguration, NotRegular,
    MassSingular, SharedReaction, Sticks, AngleTooLarge, ProjectionFailed;
    Self::WatchedNotFinite { quantity, .. } => quantity,
    Self::SingularConfiguration { kind, .. } => kind
);
variants!(
    IntegrateError<f64>:
    Dynamics, StepUnderflow, NotFinite, NewtonDiverged, ToleranceNotPositive,
    ToleranceTooSmall, BadBound;
    Self::Dynamics(error) => error
);
variants!(
    SimulateError<f64>:
    Integrate, Observe, StepNotPositive, StepLost, NoErrorEstimate, BadEnd, StartNotFinite,
    NotConservative, TooManySteps, TooMuchWork, TooManyEvents;
    Self::Integrate(error) => error,
    Self::Observe(error) => error
);
variants!(
    AssemblyError<f64, 2, 1>:
    NotFinite, Positions, Velocities, NoBranch, ManyBranches, Vanishing, Start, NegativeInertia;
);

impl Variants for BadInterval<f64> {
    const ALL: &'static [&'static str] = &["BadInterval"];

    fn name(&self) -> &'static str {
        "BadInterval"
    }

    fn within(&self) -> Vec<&'static str> {
        Vec::new()
    }
}

fn cases() -> impl Iterator<Item = Case> {
    TABLES.into_iter().flat_map(|(_, cases)| cases).copied()
}

/// Whether a text is as expected, whatever stands for `…`.
fn agrees(text: &str, expected: &str) -> bool {
    let (first, rest) = expected.split_once('…').unwrap_or((expected, ""));
    if first.len() == expected.len() {
        return text == expected;
    }
    let Some(text) = text.strip_prefix(first) else {
        return false;
    };
    let ends = text.char_indices().map(|(at, _)| at);
    ends.chain([text.len()]).any(|at| {
        let number = text[..at].parse::<f64>();
        number.is_ok() && agrees(&text[at..], rest)
    })
}

#[test]
fn every_case_provokes_its_error_which_says_what_the_table_says() {
    let mut wrong = String::new();
    for (variant, _, provoke, expected) in cases() {
        let Said { variants, text } = provoke();
        if !variants.contains(&variant) || !agrees(&text, expected) {
            wrong += &format!("{variant}: {variants:?} says\n  {text}\nand not\n  {expected}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn every_error_is_provoked() {
    let provoked: Vec<&str> = cases()
        .flat_map(|(_, _, provoke, _)| provoke().variants)
        .collect();
    let all = [
        Singularity::ALL,
        Watched::ALL,
        DynamicsError::ALL,
        IntegrateError::ALL,
        SimulateError::ALL,
        AssemblyError::<f64, 2, 1>::ALL,
        BadInterval::ALL,
    ];
    let all = all.into_iter().flatten();
    let silent: Vec<&&str> = all.filter(|name| !provoked.contains(name)).collect();
    assert!(silent.is_empty(), "no case provokes {silent:?}");
}

#[test]
fn every_kind_that_a_source_declares_is_listed() {
    let declared: [(&str, &[&str]); 6] = [
        ("error.rs", Singularity::ALL),
        ("error.rs", Watched::ALL),
        ("error.rs", DynamicsError::<f64>::ALL),
        ("integrator/error.rs", IntegrateError::<f64>::ALL),
        ("simulate/error.rs", SimulateError::<f64>::ALL),
        ("assembly/error.rs", AssemblyError::<f64, 2, 1>::ALL),
    ];
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for (file, listed) in declared {
        let (error, _) = listed[0].split_once("::").expect("a qualified name");
        let names = variants(&sources.join(file), error);
        let names: Vec<String> = names.iter().map(|v| format!("{error}::{v}")).collect();
        let sorted = |mut names: Vec<String>| {
            names.sort_unstable();
            names
        };
        let listed = listed.iter().map(|name| (*name).to_string()).collect();
        assert_eq!(sorted(names), sorted(listed), "{file}");
    }
}

/// The order of the tables is that of the page: a reader looks for what is alike.
#[test]
fn the_page_of_messages_shows_what_is_said_about_starts_and_runs() {
    let mut text = INTRODUCTION.to_string();
    for (about, cases) in TABLES {
        text += &format!("\n### {about}\n\n| message | brought about by |\n|---|---|\n");
        for (_, how, _, said) in cases {
            text += &row(&[prose(said), prose(how)]);
        }
    }
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/messages.md");
    hold_section(&page, "Starts and runs", &text);
}
