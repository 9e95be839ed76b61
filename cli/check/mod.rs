//! `bricard check`: the front end alone.
//!
//! In:  a file.
//! Out: what is wrong or doubtful in it: for people on standard error, or as JSON on
//!      standard output.

mod json;

use crate::arguments::Check;
use crate::captions::sizes;
use crate::description::{read, say_doubts, wrong};
use crate::error::CommandError;
use crate::mechanism::names;
use crate::output::print;
use bricard_codegen::internals::diagnostic::{Diagnostic, Position, Span};
use bricard_codegen::internals::model::Mechanism;
use bricard_codegen::internals::{NotUtf8, examine};
use bricard_codegen::{CompileSettings, Diagnostics};

/// Checks a description.
pub fn check(arguments: &Check) -> Result<(), CommandError> {
    let file = arguments.file.display().to_string();
    if names().any(|name| name == file) && !arguments.file.exists() {
        return Err(CommandError::NoFile(file));
    }
    let source = match read(&arguments.file) {
        Err(error) if arguments.json => {
            print(&json::report(&file, &Err(unread(&error))))?;
            return Err(CommandError::Said);
        }
        source => source?,
    };
    let examined = examine(&source, &CompileSettings::beside(&arguments.file));
    if arguments.json {
        print(&json::report(&file, &examined))?;
        return examined.map(|_| ()).map_err(|_| CommandError::Said);
    }
    let (mechanism, warnings) = examined.map_err(wrong(&arguments.file, &source))?;
    say_doubts(&arguments.file, &source, &warnings);
    print(&in_order(&file, &mechanism))
}

/// Why a file can't be read, as a finding: at the place where another encoding shows, else at the
/// beginning.
fn unread(error: &CommandError) -> Diagnostics {
    let finding = match error {
        CommandError::Read(_, error) => error.get_ref().and_then(|e| e.downcast_ref()),
        _ => None,
    };
    let finding = match finding {
        Some(NotUtf8 { place }) => {
            let end = Position {
                column: place.column + 1,
                offset: place.offset + 1,
                ..*place
            };
            let span = Span {
                start: *place,
                end,
                library: false,
            };
            Diagnostic::error(span, "this is not UTF-8").help(NotUtf8::HELP)
        }
        None => Diagnostic::error(Span::START, error.to_string()),
    };
    let mut findings = Diagnostics::new();
    findings.push(finding);
    findings
}

fn in_order(file: &str, mechanism: &Mechanism) -> String {
    let sizes = sizes(mechanism);
    format!("{file}: `{}` is in order: {sizes}\n", mechanism.name)
}
