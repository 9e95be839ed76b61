//! The equations of motion, as data.

use crate::expr::ExprId;

/// A matrix of expressions, row by row.
pub type Matrix = Vec<Vec<ExprId>>;

/// The equations of motion of a mechanism with `N` coordinates and `R`
/// constraint equations: `M q̈ + r = p₁`, `A q̈ = p₂`, `g = 0`.
#[derive(Clone, Debug)]
pub struct Equations {
    /// `M`, `N × N`; none where `inertia` is all that the code is made of: without constraints,
    /// nothing needs the entries.
    pub mass: Option<Matrix>,
    /// `M q̈`, `N`, where writing down the entries of `M` is longer; functions compute `M` from it.
    pub inertia: Option<Vec<ExprId>>,
    /// `C q̇` and the terms of moving frames: `d/dt ∂T/∂q̇ − M q̈ − ∂T/∂q`, `N`.
    pub coriolis: Vec<ExprId>,
    /// `h = ∂Π/∂q`, `N`.
    pub gravity: Vec<ExprId>,
    /// `Q`: applied forces and dissipation, `N`.
    pub applied: Vec<ExprId>,
    /// `p₁ = Q − C q̇ − h`, `N`.
    pub force: Vec<ExprId>,
    /// The constraints `g`, `R`; zero for velocity constraints.
    pub residual: Vec<ExprId>,
    /// `A q̇ + b`, `R`.
    pub speed: Vec<ExprId>,
    /// `∂(A q̇ + b)/∂q`, `R × N`.
    pub turn: Matrix,
    /// `A`, `R × N`.
    pub jacobian: Matrix,
    /// Rows of `A` that take part in the metric `M + AᵀWA`, because `M` alone is singular.
    pub weighed: Vec<usize>,
    /// Rows of `A` that follow from the others wherever the constraints hold.
    pub redundant: Vec<usize>,
    /// There are positions at which that metric is singular.
    pub metric_degenerates: bool,
    /// The connected components of the constraints and `M`; none where all coordinates are in
    /// one.
    pub components: Vec<ConnectedComponent>,
    /// `b`, `R`, of the velocity level `A q̇ + b = 0`.
    pub drift: Vec<ExprId>,
    /// `p₂ = −(Ȧ q̇ + ḃ)`, `R`.
    pub bias: Vec<ExprId>,
    /// The energies.
    pub energies: Energies,
    /// Equations of the start for positions, those that are held first: `g` and `∂g/∂q`.
    pub start_positions: StartRows,
    /// Equations of the start for velocities, those that are held first: `b` and `A` of `A q̇ + b =
    /// 0`.
    pub start_velocities: StartRows,
}

impl Equations {
    /// `N` and `R`.
    pub fn sizes(&self) -> (usize, usize) {
        (self.force.len(), self.jacobian.len())
    }

    /// The form in which inertia is written down: `M q̈`, or else the entries of `M`.
    pub fn inertial(&self) -> Vec<ExprId> {
        let entries = || self.mass.iter().flatten().flatten().copied().collect();
        self.inertia.clone().unwrap_or_else(entries)
    }

    /// All expressions in them.
    pub fn expressions(&self) -> Vec<ExprId> {
        let matrices = [&self.jacobian, &self.turn].into_iter().chain(&self.mass);
        let starts = [&self.start_positions, &self.start_velocities];
        let slopes = starts.map(|rows| &rows.slopes);
        let errors = starts.map(|rows| &rows.errors);
        let vectors = [
            &self.coriolis,
            &self.gravity,
            &self.applied,
            &self.force,
            &self.residual,
            &self.speed,
            &self.drift,
            &self.bias,
        ];
        let vectors = vectors.into_iter().chain(errors).chain(&self.inertia);
        let entries = matrices.chain(slopes).flatten().chain(vectors);
        let energies = self.energies;
        let mut all: Vec<ExprId> = entries.flatten().copied().collect();
        all.extend([energies.kinetic, energies.potential]);
        all.extend([energies.balance, energies.power]);
        all
    }
}

/// Coordinates that constraints or `M` tie together, and the rows of these constraints.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConnectedComponent {
    /// Coordinates, in their order.
    pub coordinates: Vec<usize>,
    /// Rows of `A`, in their order.
    pub rows: Vec<usize>,
    /// Whether the rows restrict positions only, to the same ones at all times.
    pub scleronomic: bool,
}

/// Equations of the start.
#[derive(Clone, Debug)]
pub struct StartRows {
    /// What they are off by; for velocities, at rest.
    pub errors: Vec<ExprId>,
    /// Their derivatives by coordinates or velocities.
    pub slopes: Matrix,
}

/// Scalar quantities of a mechanism.
#[derive(Clone, Copy, Debug)]
pub struct Energies {
    /// `T`.
    pub kinetic: ExprId,
    /// `Π`.
    pub potential: ExprId,
    /// `T₂ − T₀ + Π`.
    pub balance: ExprId,
    /// `Q·q̇ + ∂Π/∂t − ∂T/∂t`.
    pub power: ExprId,
}
