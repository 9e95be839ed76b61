//! Simulates the pendulum of the tutorial for two seconds.

use bricard_runtime::{Interface, Options, Recorder, assemble, simulate};

bricard_runtime::include_mechanism!("swing");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pendulum = swing::Swing::<f64>::default();
    let start = assemble(&pendulum, &pendulum.start(), 0.0)?;
    let mut recorder = Recorder::new(0.5)?;
    let options = Options::dop853(2.0, 1e-9);
    let summary = simulate(&pendulum, &start, &options, &mut [&mut recorder])?;
    for state in recorder.rows() {
        println!("{:4.1} s  {:8.3}°", state.t, state.q[0].to_degrees());
    }
    println!("{summary}");
    Ok(())
}
