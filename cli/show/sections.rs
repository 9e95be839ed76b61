//! The arrays of the equations of motion, entry by entry.

use bricard_codegen::internals::derive::{Equations, Matrix, coriolis_matrix};
use bricard_codegen::internals::expr::{ExprId, Graph, Notation, Symbol};
use bricard_codegen::internals::model::Mechanism;
use bricard_codegen::internals::optimise::in_trig_ring;

/// Terms and factors that an array may have in all, written out.
const SECTION_MOST: u64 = 1_000_000;
/// Those that each of its entries may have at least, however many there are.
const ENTRY_MOST: u64 = 1_000;

/// The most entries of an array of which those that are zero are written, too.
const ZEROS_MOST: usize = 1_000;

/// One array.
pub struct Section {
    title: &'static str,
    symbol: &'static str,
    latex: &'static str,
    entries: Entries,
}

enum Entries {
    Matrix(Matrix),
    Vector(Vec<ExprId>),
}

/// The arrays in the order of their derivation. Those of constraints are left
/// out where there are none.
pub fn sections(mechanism: &mut Mechanism, equations: &Equations) -> Vec<Section> {
    let mut sections = inertia(mechanism, equations);
    sections.extend([
        vector(
            "product C q̇, with the terms of moving frames",
            "Cv",
            "(C\\dot q)",
            &equations.coriolis,
        ),
        vector("potential forces h = ∂Π/∂q", "h", "h", &equations.gravity),
        vector(
            "applied and dissipative forces Q",
            "Q",
            "Q",
            &equations.applied,
        ),
    ]);
    if !equations.jacobian.is_empty() {
        sections.extend([
            vector("constraints g", "g", "g", &equations.residual),
            matrix(
                "constraint Jacobian G = ∂g/∂q",
                "G",
                "G",
                &equations.jacobian,
            ),
            vector(
                "drift b of the velocity level G q̇ + b = 0",
                "b",
                "b",
                &equations.drift,
            ),
            vector(
                "bias p2 of the acceleration level G q̈ = p2",
                "p2",
                "(p_2)",
                &equations.bias,
            ),
        ]);
    }
    sections
}

/// `M` and `C`; of a chain so long that `M` is not derived, what stands for it.
fn inertia(mechanism: &mut Mechanism, equations: &Equations) -> Vec<Section> {
    let Some(mass) = &equations.mass else {
        let title = "product M q̈, of which functions compute M column by column";
        return vec![vector(title, "Ma", "(M\\ddot q)", &equations.inertial())];
    };
    let coriolis = coriolis_matrix(&mut mechanism.graph, mass);
    vec![
        matrix("mass matrix M = ∂²T/∂q̇²", "M", "M", mass),
        matrix(
            "Coriolis matrix C by Christoffel symbols",
            "C",
            "C",
            &coriolis,
        ),
    ]
}

fn matrix(
    title: &'static str,
    symbol: &'static str,
    latex: &'static str,
    entries: &Matrix,
) -> Section {
    Section {
        title,
        symbol,
        latex,
        entries: Entries::Matrix(entries.clone()),
    }
}

fn vector(
    title: &'static str,
    symbol: &'static str,
    latex: &'static str,
    entries: &[ExprId],
) -> Section {
    Section {
        title,
        symbol,
        latex,
        entries: Entries::Vector(entries.to_vec()),
    }
}

/// The entries in the notation of descriptions.
pub fn text(graph: &mut Graph, sections: &[Section], names: &dyn Fn(Symbol) -> String) -> String {
    let mut text = String::new();
    for section in sections {
        text.push_str(&format!("{}\n", section.title));
        for (place, value) in section.written(graph, Notation::Text, names) {
            text.push_str(&format!("{}[{place}] = {value}\n", section.symbol));
        }
        if section.leaves_zeros_out() {
            text.push_str(&format!("all other entries of {} are 0\n", section.symbol));
        }
        text.push('\n');
    }
    text
}

/// The entries as LaTeX, one `align*` for each array.
pub fn latex(graph: &mut Graph, sections: &[Section], names: &dyn Fn(Symbol) -> String) -> String {
    let mut text = String::new();
    for section in sections {
        let lines = section.lines(graph, names).into_iter();
        let mut lines: Vec<String> = lines
            .map(|[entry, value]| format!("{entry} &= {value}"))
            .collect();
        if section.leaves_zeros_out() {
            lines.push(format!(
                "{}_{{ij}} &= 0 \\text{{ otherwise}}",
                section.latex
            ));
        }
        text.push_str(&format!("% {}\n\\begin{{align*}}\n", section.title));
        text.push_str(&lines.join(" \\\\\n"));
        text.push_str("\n\\end{align*}\n\n");
    }
    text
}

impl Section {
    /// What it is.
    pub fn title(&self) -> &'static str {
        self.title
    }

    /// Whether it is so large that entries that are zero are not written.
    fn leaves_zeros_out(&self) -> bool {
        match &self.entries {
            Entries::Matrix(rows) => rows.iter().map(Vec::len).sum::<usize>() > ZEROS_MOST,
            Entries::Vector(_) => false,
        }
    }

    /// How many terms and factors it has, written out.
    pub fn length(&self, graph: &Graph) -> u64 {
        let entries: Vec<ExprId> = places(&self.entries).map(|(_, entry)| entry).collect();
        let lengths = graph.lengths(&entries);
        lengths.into_iter().fold(0, u64::saturating_add)
    }

    /// Each entry and its value, in LaTeX.
    pub fn lines(&self, graph: &mut Graph, names: &dyn Fn(Symbol) -> String) -> Vec<[String; 2]> {
        let written = self.written(graph, Notation::Latex, names).into_iter();
        written
            .map(|(place, value)| [format!("{}_{{{place}}}", self.latex), value])
            .collect()
    }

    /// Each place and what is written there.
    fn written(
        &self,
        graph: &mut Graph,
        notation: Notation,
        names: &dyn Fn(Symbol) -> String,
    ) -> Vec<(String, String)> {
        let written = |entry: &ExprId| !self.leaves_zeros_out() || !graph.is_zero(*entry);
        let (places, entries): (Vec<String>, Vec<ExprId>) = places(&self.entries)
            .filter(|(_, entry)| written(entry))
            .unzip();
        let most = (SECTION_MOST / entries.len().max(1) as u64).max(ENTRY_MOST);
        let lengths = graph.lengths(&entries);
        let measured = entries.into_iter().zip(lengths);
        let value = |(entry, length)| match length > most {
            true => too_long(length, notation),
            false => shortest(graph, entry, notation, names),
        };
        places.into_iter().zip(measured.map(value)).collect()
    }
}

/// What stands for an entry that nobody would read to its end.
fn too_long(length: u64, notation: Notation) -> String {
    let length = match length {
        u64::MAX => "countless".to_string(),
        length => length.to_string(),
    };
    let text = format!("too long to be written out: {length} terms and factors");
    match notation {
        Notation::Text => format!("({text}; see --programs)"),
        Notation::Latex => format!("\\text{{({text})}}"),
    }
}

/// Each entry with its place, counted from 1.
fn places(entries: &Entries) -> Box<dyn Iterator<Item = (String, ExprId)> + '_> {
    match entries {
        Entries::Matrix(rows) => Box::new(rows.iter().enumerate().flat_map(|(i, row)| {
            let place = move |j: usize| format!("{},{}", i + 1, j + 1);
            row.iter().enumerate().map(move |(j, e)| (place(j), *e))
        })),
        Entries::Vector(entries) => Box::new(
            entries
                .iter()
                .enumerate()
                .map(|(i, e)| ((i + 1).to_string(), *e)),
        ),
    }
}

/// The entry as it is, or as a reduced polynomial in sines and cosines:
/// whichever is shorter.
fn shortest(
    graph: &mut Graph,
    e: ExprId,
    notation: Notation,
    names: &dyn Fn(Symbol) -> String,
) -> String {
    let plain = graph.print(e, notation, names);
    let reduced = in_trig_ring(graph, e);
    let reduced = graph.print(reduced, notation, names);
    if reduced.chars().count() < plain.chars().count() {
        reduced
    } else {
        plain
    }
}
