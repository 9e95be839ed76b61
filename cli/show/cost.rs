//! What the programs of the functions that a simulation calls cost.

use bricard_codegen::internals::optimise::Programs;

/// One line for each function that a simulation calls: the arrays that it computes together,
/// and its operations; those of the mass matrix of a long chain by themselves.
pub fn costs(programs: &Programs) -> String {
    let columns = programs.inertia.as_ref();
    let mass = if columns.is_some() { "" } else { "M, " };
    let rows = programs.position.as_ref().map_or("", |_| ", G, p2");
    let acceleration = format!("an acceleration ({mass}p1{rows})");
    let projection = format!("a projection ({mass}g, G, b)");
    let mut text = "operations\n".to_string();
    for (title, computed) in [
        ("a column of M", columns),
        (&*acceleration, Some(&programs.terms)),
        (&projection, programs.position.as_ref()),
        ("the energies", Some(&programs.energy)),
    ] {
        if let Some(computed) = computed {
            text.push_str(&format!("{title}: {}\n", computed.cost));
        }
    }
    text
}
