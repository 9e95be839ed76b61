//! A program that generates a mechanism: a chain of as many pendulums as it is told.
//!
//! Prints the description. A build script would hand the model to
//! `bricard_codegen::Builder::compile_model` instead.
//!
//! ```text
//! cargo run -p bricard-codegen --example chain 5 > chain.mech
//! bricard check chain.mech
//! ```

use bricard_codegen::{Drawing, Formula, Model, ModelError};
use std::env;

fn main() -> Result<(), ModelError> {
    let links = env::args().nth(1).and_then(|text| text.parse().ok());
    print!("{}", chain(links.unwrap_or(3)).text()?);
    Ok(())
}

/// A chain that hangs from a point, each link with an angle of its own.
fn chain(links: usize) -> Model {
    let mut model = Model::new("Chain")
        .docs("A hanging chain of pendulums.")
        .constant("g", "m/s^2", 9.81)
        .parameter("L", "m", 0.2)
        .docs("length of a link")
        .parameter("m", "kg", 0.1)
        .docs("mass at the end of a link");
    let mut joints = vec![Formula::from("[0, 0]")];
    for i in 0..links {
        let q = format!("q{i}");
        let link = format!("L*[sin({q}), -cos({q})]");
        let place = format!("p{i}");
        let from = joints
            .last()
            .map_or(String::new(), |joint| format!("{joint} + "));
        model = model
            .coordinate(&q, "rad")
            .quantity(&place, format!("{from}{link}"))
            .kinetic(format!("1/2*m*norm2(der({place}))"))
            .potential(format!("m*g*{place}.y"))
            .held(q.as_str(), "20*deg");
        joints.push(Formula::from(place));
    }
    model.draw(Drawing::Line, joints)
}
