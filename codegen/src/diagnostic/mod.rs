//! What is wrong, where, and what to write instead.
//!
//! In:  findings of any stage, in any order.
//! Out: [`Diagnostics`], the error of the front end: sorted by place, each
//!      finding with its source line, labels and help.
//!
//! Not here: the decision to stop. A stage collects all it finds; the pipeline
//! stops between stages.

mod figure;
mod library;
mod render;
mod span;
mod suggest;

pub use figure::figure;
pub use library::LIBRARY;
pub use span::{Position, Span};
pub use suggest::nearest;

use std::fmt;

/// More findings than this about one file help nobody; the rest is dropped.
const KEPT: usize = 500;

/// The uses of functions and parts that a finding names: the outermost and these.
const USES: usize = 3;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// No code can be generated.
    Error,
    /// Code is generated, but something is probably not as meant.
    Warning,
}

/// A place and what there is to say about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// What is there.
    pub text: String,
}

/// One finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// Where, with a word about that place (which may be empty).
    pub primary: Label,
    /// Other places that belong to it.
    pub secondary: Vec<Label>,
    /// What to write instead.
    pub help: Option<String>,
}

impl Diagnostic {
    /// A finding that stops the generator.
    pub fn error(span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, span, message.into())
    }

    /// A finding that doesn't stop the generator.
    pub fn warning(span: Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, span, message.into())
    }

    fn new(severity: Severity, span: Span, message: String) -> Self {
        let primary = Label {
            span,
            text: String::new(),
        };
        Self {
            severity,
            message,
            primary,
            secondary: Vec::new(),
            help: None,
        }
    }

    /// Its place in the description: for a finding in the library of parts that of the
    /// outermost use.
    pub fn place(&self) -> Span {
        let own = std::iter::once(&self.primary).chain(&self.secondary);
        let own = own.map(|label| label.span).find(|span| !span.library);
        own.unwrap_or(self.primary.span)
    }

    /// Says what is at the place itself.
    pub fn labelled(mut self, text: impl Into<String>) -> Self {
        self.primary.text = text.into();
        self
    }

    /// Points to another place.
    pub fn also(mut self, span: Span, text: impl Into<String>) -> Self {
        self.secondary.push(Label {
            span,
            text: text.into(),
        });
        self
    }

    /// Says what to write instead.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.help = Some(text.into());
        self
    }

    /// Says what to write instead, where there is something to say.
    pub fn maybe_help(mut self, text: Option<String>) -> Self {
        self.help = text.or(self.help);
        self
    }
}

/// Findings about one file.
///
/// Displayed as a list of places and messages; [`Diagnostics::render`] shows the
/// source lines too.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    /// Where that is used which is being looked at, from outside inwards.
    uses: Vec<Label>,
}

impl Diagnostics {
    /// No findings.
    pub fn new() -> Self {
        Self::default()
    }

    /// Records a finding. The same words about the same place are recorded once:
    /// the body of a loop is read many times.
    /// Inside a function or a part the place of its use belongs to a finding, and the
    /// first use stands for all.
    pub fn push(&mut self, mut diagnostic: Diagnostic) {
        let same = |d: &Diagnostic| {
            d.message == diagnostic.message && d.primary.span == diagnostic.primary.span
        };
        let known = match self.uses.is_empty() {
            true => self.list.contains(&diagnostic),
            false => self.list.iter().any(same),
        };
        if self.list.len() < KEPT && !known {
            let inner = self.uses.len().saturating_sub(USES).max(1);
            let shown = self.uses.iter().enumerate();
            let shown = shown.filter(|(i, _)| *i == 0 || *i >= inner);
            diagnostic
                .secondary
                .extend(shown.map(|(_, label)| label.clone()));
            self.list.push(diagnostic);
        }
    }

    /// From here on findings are about something that is used at a place, in words.
    pub(crate) fn enter(&mut self, span: Span, text: String) {
        self.uses.push(Label { span, text });
    }

    /// Replaces the uses that findings are about, and returns those before.
    pub(crate) fn look_from(&mut self, uses: Vec<Label>) -> Vec<Label> {
        std::mem::replace(&mut self.uses, uses)
    }

    /// Ends what [`Diagnostics::enter`] began.
    pub(crate) fn leave(&mut self) {
        self.uses.pop();
    }

    /// The number of findings.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Forgets the findings behind the first ones.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.list.truncate(count);
    }

    /// Adds the findings of another collection.
    pub(crate) fn append(&mut self, other: Diagnostics) {
        other
            .list
            .into_iter()
            .for_each(|diagnostic| self.push(diagnostic));
    }

    /// Adds the findings of another collection about places that nothing is said
    /// about yet.
    pub(crate) fn append_elsewhere(&mut self, mut other: Diagnostics) {
        let known = |d: &Diagnostic| self.list.iter().any(|k| k.primary.span == d.primary.span);
        other.list.retain(|diagnostic| !known(diagnostic));
        self.append(other);
    }

    /// Whether something that stops the generator is known of a place.
    pub(crate) fn is_wrong(&self, place: Span) -> bool {
        let errors = self.list.iter().filter(|d| d.severity == Severity::Error);
        errors.map(|d| d.primary.span).any(|span| span == place)
    }

    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The number of findings that stop the generator.
    pub fn error_count(&self) -> usize {
        self.list
            .iter()
            .filter(|d| d.severity == Severity::Error)
            .count()
    }

    /// The findings in the order of their places.
    pub fn sorted(&self) -> Vec<&Diagnostic> {
        let mut sorted: Vec<_> = self.list.iter().collect();
        sorted.sort_by_key(|d| (d.place().start.offset, d.place().end.offset));
        sorted
    }

    /// The findings without the warnings among them.
    pub(crate) fn into_errors(mut self) -> Self {
        self.list.retain(|d| d.severity == Severity::Error);
        self
    }
}

/// The text behind a byte order mark. Offsets count from there.
pub fn without_mark(source: &str) -> &str {
    source.strip_prefix('\u{feff}').unwrap_or(source)
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for diagnostic in self.sorted() {
            writeln!(f, "{}: {}", diagnostic.place(), diagnostic.message)?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}
