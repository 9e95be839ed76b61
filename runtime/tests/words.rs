//! Errors speak of coordinates and constraints as the description does.

use crate::mechanisms::structure;
use bricard_runtime::{ConstraintRow, DynamicsError, Form, Quantity, Structure};

static CRANK: Structure = structure(
    &[
        Quantity {
            name: "crank",
            unit: "rad",
            docs: "",
        },
        Quantity {
            name: "theta[3]",
            unit: "rad",
            docs: "",
        },
    ],
    &[ConstraintRow {
        text: "pin = [x, 0] [y]",
        line: 17,
        holonomic: true,
    }],
);

#[test]
fn a_coordinate_without_inertia_is_named() {
    let error = DynamicsError::MassSingular {
        t: 1.5,
        coordinate: 1,
        structure: &CRANK,
    };
    let said = error.to_string();
    assert!(
        said.starts_with("at t = 1.5 s the coordinate `theta[3]` can move without"),
        "{said}"
    );
}

#[test]
fn a_constraint_that_comes_apart_is_named_with_its_line() {
    let error = DynamicsError::ProjectionFailed {
        t: 1.5,
        residual: 0.25,
        row: 0,
        structure: &CRANK,
    };
    let said = error.to_string();
    let expected = "at t = 1.5 s the constraint `pin = [x, 0] [y]` (line 17) is violated by 0.25";
    assert!(said.starts_with(expected), "{said}");
}

#[test]
fn constraints_that_depend_on_each_other_are_named() {
    let error = DynamicsError::SingularPosition {
        t: 1.5,
        form: Form::Multipliers,
        rank: 0,
        structure: &CRANK,
    };
    let said = error.to_string();
    let expected = "at t = 1.5 s the gradient of the only constraint equation, \
                    `pin = [x, 0] [y]` (line 17), vanishes, and the form `multipliers`";
    assert!(said.starts_with(expected), "{said}");
}
