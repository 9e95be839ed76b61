//! What was found, for editors.
//!
//! In:  the findings of the front end.
//! Out: one JSON object. Lines and columns count from 1, columns in characters; an
//!      `end` is behind the last character.

use bricard_codegen::Diagnostics;
use bricard_codegen::internals::diagnostic::{Diagnostic, Label, Position, Severity};
use bricard_codegen::internals::model::Mechanism;
use serde_json::{Value, json};

/// What the front end gives: a mechanism with warnings, or errors.
pub type Examined = Result<(Mechanism, Diagnostics), Diagnostics>;

/// The findings about a file as JSON, with a line feed at the end.
pub fn report(file: &str, examined: &Examined) -> String {
    let (mechanism, findings) = match examined {
        Ok((mechanism, warnings)) => (
            json!({
                "name": mechanism.name,
                "coordinates": mechanism.freedoms(),
                "states": mechanism.states,
                "constraint_equations": mechanism.constraints.len(),
            }),
            warnings,
        ),
        Err(errors) => (Value::Null, errors),
    };
    let messages: Vec<Value> = findings
        .sorted()
        .into_iter()
        .map(|d| message(file, d))
        .collect();
    let report = json!({ "file": file, "mechanism": mechanism, "messages": messages });
    format!("{report:#}\n")
}

fn message(file: &str, diagnostic: &Diagnostic) -> Value {
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    // Of a finding in the library of parts the place is that of its use.
    let (span, text) = (diagnostic.place(), &diagnostic.primary.text);
    let here = diagnostic.secondary.iter().filter(|l| !l.span.library);
    let labels: Vec<Value> = here.map(label).collect();
    json!({
        "file": file,
        "line": span.start.line,
        "column": span.start.column,
        "end": position(span.end),
        "severity": severity,
        "message": diagnostic.message,
        "label": text,
        "labels": labels,
        "help": diagnostic.help,
    })
}

fn label(label: &Label) -> Value {
    json!({
        "line": label.span.start.line,
        "column": label.span.start.column,
        "end": position(label.span.end),
        "text": label.text,
    })
}

fn position(position: Position) -> Value {
    json!({ "line": position.line, "column": position.column })
}
