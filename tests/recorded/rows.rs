//! Rows of a run.

use bricard_driver::{Column, Reached, Segment, Watch, erase_type, heads};
use bricard_runtime::{Method, Options, StepControl, Structure, Whole};
use std::ops::ControlFlow;

/// Every method, adaptive where it can be.
pub fn methods(until: f64) -> Vec<Options<f64>> {
    let fixed = StepControl::Fixed { step: 1e-3 };
    let adaptive = StepControl::Adaptive {
        relative: 1e-10,
        absolute: 1e-10,
    };
    let adaptive = [Method::Dp5, Method::Dop853, Method::Radau5, Method::Radau9]
        .map(|method| Options::new(until, method, adaptive));
    let rk4 = Options::new(until, Method::Rk4, fixed);
    std::iter::once(rk4).chain(adaptive).collect()
}

/// The rows of a run.
pub struct Rows {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
    pub reached: Reached,
}

struct Keep(Vec<Vec<f64>>);

impl Watch for Keep {
    fn row(&mut self, values: &[f64]) -> ControlFlow<()> {
        self.0.push(values.to_vec());
        ControlFlow::Continue(())
    }

    fn at(&mut self, _t: f64, _steps: u64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Runs a mechanism from its start and records columns.
pub fn record<M, const N: usize, const R: usize>(
    mechanism: M,
    options: Options<f64>,
    columns: &[Column],
) -> Rows
where
    M: Whole<f64, N, R> + 'static,
{
    let structure: &'static Structure = mechanism.structure();
    let segment = Segment {
        options,
        from: None,
        every: Some(0.05),
        columns: columns.to_vec(),
        rows: 0,
        short: false,
    };
    let mut names = heads(structure);
    names.extend(columns.iter().map(|column| column.name(structure)));
    let mut keep = Keep(Vec::new());
    let reached = erase_type::<N, R>(Box::new(mechanism))
        .segment(&segment, &mut keep)
        .unwrap_or_else(|error| panic!("{error}"));
    Rows {
        names,
        rows: keep.0,
        reached,
    }
}

impl Rows {
    /// What each row says in some columns.
    pub fn each<const K: usize>(&self, names: [&str; K]) -> Vec<[f64; K]> {
        let places = names.map(|name| {
            let place = self.names.iter().position(|known| known == name);
            place.unwrap_or_else(|| panic!("{name} in {:?}", self.names))
        });
        assert!(self.rows.len() > 10, "{} rows", self.rows.len());
        self.rows.iter().map(|row| places.map(|i| row[i])).collect()
    }

    pub fn names(&self) -> &[String] {
        &self.names
    }
}
