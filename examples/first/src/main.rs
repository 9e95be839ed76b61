//! The program on the front page: a mechanism, end to end.

use bricard_runtime::{Interface, Options, assemble, simulate};
bricard_runtime::include_mechanism!("engine");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut engine = engine::Engine::<f64>::default();
    engine.parameters.l = 0.4;
    let start = assemble(&engine, &engine.start(), 0.0)?;
    let summary = simulate(&engine, &start, &Options::dop853(10.0, 1e-10), &mut [])?;
    println!("{summary}");
    Ok(())
}
