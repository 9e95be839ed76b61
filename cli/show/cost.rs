//! What the programs of the functions that a simulation calls cost.

use bricard_codegen::internals::optimise::Programs;

/// One line for each function that a simulation calls: the arrays that it computes together,
/// and its operations.
pub fn costs(programs: &Programs) -> String {
    let acceleration = match &programs.position {
        Some(_) => "an acceleration (M, p1, G, p2)",
        None => "an acceleration (M, p1)",
    };
    let mut text = "operations\n".to_string();
    for (title, computed) in [
        (acceleration, Some(&programs.terms)),
        ("a projection (M, g, G, b)", programs.position.as_ref()),
        ("the energies", Some(&programs.energy)),
    ] {
        if let Some(computed) = computed {
            text.push_str(&format!("{title}: {}\n", computed.cost));
        }
    }
    text
}
