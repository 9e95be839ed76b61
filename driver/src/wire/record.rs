//! Structs and enums of the runtime as bytes: field by field, variant by variant.

use super::Wire;
use crate::{
    Around, Changes, Column, Drawn, Exact, Given, Path, Reached, Scene, Segment, TimedRun,
};
use bricard_runtime::{
    Audit, ConnectedComponent, ConstraintRow, Counters, Declared, Direction, Event, Form, Method,
    Multiplier, Options, Origin, Passage, Quantity, Settings, Stabilisation, StepControl,
    Structure,
};

/// Structs by their fields. A field that is missing here does not compile.
macro_rules! records {
    ($($name:ident $(<$scalar:ty>)? { $($field:ident),* })*) => {$(
        impl Wire for $name $(<$scalar>)? {
            fn put(&self, out: &mut Vec<u8>) {
                let Self { $($field),* } = self;
                $($field.put(out);)*
            }

            fn take(from: &mut &[u8]) -> Option<Self> {
                $(let $field = Wire::take(from)?;)*
                Some(Self { $($field),* })
            }
        }
    )*};
}

/// Enums by numbers of their variants. A variant that is missing here does not compile.
macro_rules! choices {
    ($($name:ident $(<$scalar:ty>)? {
        $($number:literal => $variant:ident $(($($part:ident),*))? $({ $($field:ident),* })?),*
    })*) => {$(
        impl Wire for $name $(<$scalar>)? {
            fn put(&self, out: &mut Vec<u8>) {
                match self {
                    $(Self::$variant $(($($part),*))? $({ $($field),* })? => {
                        let number: u8 = $number;
                        number.put(out);
                        $($($part.put(out);)*)?
                        $($($field.put(out);)*)?
                    })*
                }
            }

            fn take(from: &mut &[u8]) -> Option<Self> {
                Some(match u8::take(from)? {
                    $($number => {
                        $($(let $part = Wire::take(from)?;)*)?
                        $($(let $field = Wire::take(from)?;)*)?
                        Self::$variant $(($($part),*))? $({ $($field),* })?
                    })*
                    _ => return None,
                })
            }
        }
    )*};
}
pub(super) use choices;

records! {
    Structure {
        name, docs, file, coordinates, unitless_angles, states, described, parameters, inputs, outputs, accelerated, events,
        constraints, multipliers, weighed, redundant, metric_degenerates, components, constant_mass, conservative, scleronomic,
        independent, drawn, assumed_regular
    }
    ConnectedComponent { coordinates, rows, scleronomic }
    Quantity { name, unit, docs }
    Declared { quantity, given_by }
    ConstraintRow { text, line, holonomic }
    Multiplier { quantity, row }
    Event { name, direction }
    Options<f64> { until, method, step_control, settings, keep_energy, audit, most_steps, origin }
    Settings<f64> { form, stabilisation, published, across_switches }
    Audit { constraints, energy, passages }
    Origin<f64> { t, energy, supplied }
    Passage<f64> { t, sine, rank, regular }
    Counters {
        cheap_accelerations, beside_accelerations, robust_accelerations, rank_decisions,
        undetermined, mass_factorisations, constraint_factorisations, row_choices,
        projections, projection_iterations, robust_projections
    }
    Given { coordinate, velocity, held, value }
    TimedRun { end, steps, evaluations, wall }
    Changes { parameters, inputs, given }
    Exact { end, error }
    Around { about, places, span }
    Path { passage, rows }
    Scene { parameters, shapes, frames }
    Segment { options, from, every, columns, rows, short }
    Reached {
        state, origin, rows, error, steps, rejected, wall, constraint_error, energy_error,
        energy_exchanged, passages, events, counters
    }
}

choices! {
    Direction { 0 => Rising, 1 => Falling, 2 => Crossing }
    Method { 0 => Rk4, 1 => Dp5, 2 => Dop853, 3 => Radau5, 4 => Radau9 }
    StepControl<f64> { 0 => Fixed { step }, 1 => Adaptive { relative, absolute } }
    Form { 0 => Reduced, 1 => Full, 2 => Multipliers, 3 => Partitioning }
    Stabilisation<f64> { 0 => Projection, 1 => Baumgarte { alpha, beta }, 2 => None }
    Column {
        0 => Energy, 1 => Kinetic, 2 => Potential, 3 => ConstraintError, 4 => VelocityError,
        5 => Rank, 6 => Reaction(place), 7 => Output(place), 8 => Acceleration(place),
        9 => Multiplier(place), 10 => Input(place)
    }
    Drawn { 0 => Line(points), 1 => Circle, 2 => Polygon(points), 3 => Trace }
}
