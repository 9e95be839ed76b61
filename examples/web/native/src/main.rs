//! The runs that the module is compared with, here and by the clock.
//!
//! In:  cases as JSON on the standard input: `{"method", "step" | "rtol", "until", "every",
//!      "torque", "repeat"}`.
//! Out: for each a line of JSON: the bits of the states, and the shortest time (s).

use bricard_runtime::{Interface, Method, Settings, State, StepControl, Stepper, assemble};
use engine::Engine;
use serde_json::{Value, json};
use std::error::Error;
use std::io::stdin;
use std::time::Instant;

bricard_runtime::include_mechanism!("engine");

fn main() -> Result<(), Box<dyn Error>> {
    let cases: Vec<Value> = serde_json::from_reader(stdin())?;
    for case in &cases {
        let mut shortest = f64::INFINITY;
        let mut states = Vec::new();
        for _ in 0..number(case, "repeat")? as u32 {
            let begin = Instant::now();
            states = run(case)?;
            shortest = shortest.min(begin.elapsed().as_secs_f64());
        }
        println!("{}", json!({ "states": states, "seconds": shortest }));
    }
    Ok(())
}

fn number(case: &Value, name: &str) -> Result<f64, String> {
    let value = case[name].as_f64();
    value.ok_or_else(|| format!("{case} has no number `{name}`"))
}

/// The states of a run at equal intervals, as bits.
fn run(case: &Value) -> Result<Vec<Vec<String>>, Box<dyn Error>> {
    let mut engine = Engine::<f64>::default();
    engine.inputs.torque = Some(number(case, "torque")?);
    let mut state: State<f64, 3> = assemble(&engine, &engine.start(), 0.0)?;
    let method = match case["method"].as_str() {
        Some("rk4") => Method::Rk4,
        Some("dop853") => Method::Dop853,
        Some("radau5") => Method::Radau5,
        _ => return Err(format!("{case} has no known method").into()),
    };
    let step_control = match case["step"].as_f64() {
        Some(step) => StepControl::Fixed { step },
        None => StepControl::Adaptive {
            relative: number(case, "rtol")?,
            absolute: number(case, "rtol")?,
        },
    };
    let mut stepper = Stepper::<f64, 3, 2>::new(method, step_control, Settings::default())?;
    let every = number(case, "every")?;
    let mut states = Vec::new();
    for place in 1..=(number(case, "until")? / every).round() as u32 {
        let span = f64::from(place) * every - state.t;
        stepper.step(&engine, &mut state, span)?;
        let numbers = [state.t].into_iter().chain(state.q.iter().copied());
        let numbers = numbers.chain(state.v.iter().copied());
        states.push(numbers.map(|x| format!("{:016x}", x.to_bits())).collect());
    }
    Ok(states)
}
