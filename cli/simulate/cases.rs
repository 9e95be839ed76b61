//! The runs that a command line asks for: one, or one for each value of a list.
//!
//! In:  the options of `simulate`.
//! Out: [`Case`]s, and what differs from one to the next.

use crate::arguments::Simulate;
use crate::error::{CommandError, TooMany};
use crate::formula::{Assignment, Setting};
use crate::number::exact;
use bricard_codegen::internals::diagnostic::figure;

/// Runs that the colours of a picture tell apart.
const PICTURED: usize = 7;

/// What one run changes of the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Parameters and inputs.
    pub set: Vec<Setting>,
    /// Values at the start.
    pub start: Vec<Assignment>,
}

/// What differs from run to run.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied {
    option: &'static str,
    name: String,
    /// The case of the first value.
    pub first: Case,
    runs: Vec<(f64, Case)>,
}

/// The run of a command line without lists.
pub fn single(arguments: &Simulate) -> Case {
    Case {
        set: arguments.set.iter().map(|set| set.first.clone()).collect(),
        start: arguments.start.iter().map(|x| x.first.clone()).collect(),
    }
}

/// The runs of a command line with a list; `None` if it has none.
///
/// # Errors
///
/// [`CommandError::TwoLists`].
pub fn varied(arguments: &Simulate) -> Result<Option<Varied>, CommandError> {
    let mut all = Vec::new();
    for (place, choice) in arguments.set.iter().enumerate() {
        let mut varied = Varied::of(("--set", choice.first.name()), arguments);
        for setting in choice.all() {
            // A list holds numbers alone.
            if let Setting::Number(number) = setting {
                let mut case = single(arguments);
                case.set[place] = setting.clone();
                varied.runs.push((number.value, case));
            }
        }
        all.push(varied);
    }
    for (place, choice) in arguments.start.iter().enumerate() {
        let mut varied = Varied::of(("--start", &choice.first.name), arguments);
        for given in choice.all() {
            let mut case = single(arguments);
            case.start[place] = given.clone();
            varied.runs.push((given.value, case));
        }
        all.push(varied);
    }
    let mut lists = all.into_iter().filter(|varied| varied.runs.len() > 1);
    let found = lists.next();
    if let (Some(one), Some(other)) = (&found, lists.next()) {
        let options = [one.called(), other.called()];
        return Err(CommandError::TwoLists { options });
    }
    Ok(found)
}

/// Refuses a list where there is one run only.
///
/// # Errors
///
/// [`CommandError::TwoLists`], [`CommandError::Runs`].
pub fn only_one(arguments: &Simulate, what: &'static str) -> Result<(), CommandError> {
    match varied(arguments)? {
        Some(varied) => Err(varied.refused(what, GIVE_ONE)),
        None => Ok(()),
    }
}

/// What to do where a list is too much.
const GIVE_ONE: &str = "give it one value";

impl Varied {
    fn of((option, name): (&'static str, &str), arguments: &Simulate) -> Self {
        Self {
            option,
            name: name.to_string(),
            first: single(arguments),
            runs: Vec::new(),
        }
    }

    /// The option as it is written, without its values.
    fn called(&self) -> String {
        format!("{} {}", self.option, self.name)
    }

    /// The option and its name as a JSON object has them.
    pub fn key(&self) -> [&str; 2] {
        [self.option.trim_start_matches('-'), &self.name]
    }

    /// The column of a table that tells the runs apart. It is called after the option, since
    /// a coordinate or an input may be a column itself.
    pub fn column(&self) -> String {
        let [option, name] = self.key();
        format!("{option}({name})")
    }

    /// Each run with its value.
    pub fn runs(&self) -> impl Iterator<Item = (f64, &Case)> {
        self.runs.iter().map(|(value, case)| (*value, case))
    }

    /// What a run is called: in few digits where these tell all runs apart.
    pub fn label(&self, value: f64) -> String {
        let mut short: Vec<String> = self.runs.iter().map(|(x, _)| figure(*x)).collect();
        short.sort();
        short.dedup();
        let value = match short.len() == self.runs.len() {
            true => figure(value),
            false => exact(value),
        };
        format!("{} = {value}", self.name)
    }

    /// Refuses what makes no sense for several runs.
    ///
    /// # Errors
    ///
    /// [`CommandError::Runs`].
    pub fn check(&self, arguments: &Simulate) -> Result<(), CommandError> {
        if arguments.checkpoint.is_some() {
            return Err(self.refused("--checkpoint is of one run", GIVE_ONE));
        }
        if arguments.resume.is_some() {
            return Err(self.refused("--resume goes on with one run", GIVE_ONE));
        }
        if arguments.live {
            let instead =
                "give it one value, which a slider changes, or compare the runs without --live";
            return Err(self.refused("--live moves one run", instead));
        }
        if arguments.film.is_some() {
            let instead = "give it one value, or compare the runs by --plot";
            return Err(self.refused("--film shows one run", instead));
        }
        if arguments.plot.is_some() && self.runs.len() > PICTURED {
            let instead = "give it fewer values, or write the rows by --out alone";
            return Err(self.refused("a picture has colours for seven runs", instead));
        }
        Ok(())
    }

    fn refused(&self, what: &'static str, instead: &'static str) -> CommandError {
        CommandError::Runs(TooMany {
            what,
            varied: self.called(),
            count: self.runs.len(),
            instead,
        })
    }
}
