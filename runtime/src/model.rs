//! What generated code provides, and what the runtime asks of it.
//!
//! [`Mechanism`] carries the equations, [`Interface`] what a program that
//! handles any mechanism needs besides (parameters, start, outputs, pictures),
//! [`Structure`] what was known when the code was generated.
//!
//! The buffers ([`Terms`], [`Position`], [`Linearised`]) know which mechanism filled them last.
//! Generated code writes what does not change once, and what is zero never: a buffer of another
//! mechanism is cleared first.

use crate::assembly::StartFault;
use crate::zeroed::{spoil, zeroed};
use crate::{Condition, Real, Sides, State, Structure, Switches};
use core::ptr;
use nalgebra::{SMatrix, SVector};

/// The equations of motion of a mechanism with `N` coordinates and `R`
/// constraint equations, at one state.
///
/// `M q̈ + r = p₁`, `A q̈ = p₂`, where `r` are the generalized reaction forces of
/// ideal constraints. Source: Phong & Hoang (2012), eqs. 2.1–2.10.
///
/// A mechanism without constraints (`R = 0`) does not provide
/// [`position`](Self::position), which then writes nothing.
pub trait Mechanism<T: Real, const N: usize, const R: usize> {
    /// What was known when the code was generated.
    fn structure(&self) -> &'static Structure;

    /// Everything one acceleration needs: `M`, `p₁`, `A`, `p₂`.
    fn terms(&self, state: &State<T, N>, out: &mut Terms<T, N, R>);

    /// The acceleration where the constraints are regular, as straight-line code
    /// with this mechanism's sparsity; `false` if it is not provided.
    ///
    /// Not to be used where one of [`Acceleration::pivots`] is small.
    fn acceleration(&self, _state: &State<T, N>, _out: &mut Acceleration<T, N, R>) -> bool {
        false
    }

    /// Everything a projection needs: `M`, `g`, `A`, `b`. Reads `t` and `q` only.
    fn position(&self, _state: &State<T, N>, _out: &mut Position<T, N, R>) {}

    /// The corrections that a projection makes where the constraints are regular,
    /// as straight-line code with this mechanism's sparsity; `false` if they are
    /// not provided.
    ///
    /// Not to be used where one of [`Correction::pivots`] is small.
    fn correction(&self, _state: &State<T, N>, _out: &mut Correction<T, N, R>) -> bool {
        false
    }

    /// Moves a start onto the equations of the `start` block that are no values of
    /// coordinates and velocities; of which most mechanisms have none.
    ///
    /// # Errors
    ///
    /// [`StartFault`] if they don't hold together with the held values.
    fn begin(&self, _start: &mut Start<T, N>, _t: T) -> Result<(), StartFault<T, N>> {
        Ok(())
    }

    /// What decides the conditions of the forces by its sign, and its rate at an
    /// acceleration, as many as `out` has room for; the conditions.
    fn switches(
        &self,
        _state: &State<T, N>,
        _acceleration: &SVector<T, N>,
        _out: &mut Switches<'_, T>,
    ) -> &'static [Condition] {
        &[]
    }

    /// Energies and the power that is supplied from outside.
    fn energy(&self, state: &State<T, N>) -> Energy<T>;

    /// The equations of motion linearised about a motion with this acceleration and
    /// these multipliers `λ` of the constraints, `r = Aᵀλ`; `false` if they are not
    /// provided.
    fn linearised(
        &self,
        _state: &State<T, N>,
        _acceleration: &SVector<T, N>,
        _multiplier: &SVector<T, R>,
        _out: &mut Linearised<T, N, R>,
    ) -> bool {
        false
    }
}

/// A reference to a mechanism is one. By it the parts of the runtime that are not called in
/// every evaluation take any mechanism as `&dyn Mechanism<T, N, R>`, so that they are
/// compiled once for each pair of sizes.
impl<T: Real, M, const N: usize, const R: usize> Mechanism<T, N, R> for &M
where
    M: Mechanism<T, N, R> + ?Sized,
{
    fn structure(&self) -> &'static Structure {
        (**self).structure()
    }

    fn terms(&self, state: &State<T, N>, out: &mut Terms<T, N, R>) {
        (**self).terms(state, out);
    }

    fn acceleration(&self, state: &State<T, N>, out: &mut Acceleration<T, N, R>) -> bool {
        acceleration(*self, state, out)
    }

    fn position(&self, state: &State<T, N>, out: &mut Position<T, N, R>) {
        (**self).position(state, out);
    }

    fn correction(&self, state: &State<T, N>, out: &mut Correction<T, N, R>) -> bool {
        correction(*self, state, out)
    }

    fn begin(&self, start: &mut Start<T, N>, t: T) -> Result<(), StartFault<T, N>> {
        (**self).begin(start, t)
    }

    fn switches(
        &self,
        state: &State<T, N>,
        acceleration: &SVector<T, N>,
        out: &mut Switches<'_, T>,
    ) -> &'static [Condition] {
        (**self).switches(state, acceleration, out)
    }

    fn energy(&self, state: &State<T, N>) -> Energy<T> {
        (**self).energy(state)
    }

    fn linearised(
        &self,
        state: &State<T, N>,
        acceleration: &SVector<T, N>,
        multiplier: &SVector<T, R>,
        out: &mut Linearised<T, N, R>,
    ) -> bool {
        (**self).linearised(state, acceleration, multiplier, out)
    }
}

/// [`Mechanism::acceleration`], which is inlined wherever it is called; this is not, so that there
/// is one copy of a long one.
#[inline(never)]
pub(crate) fn acceleration<T: Real, const N: usize, const R: usize>(
    mechanism: &(impl Mechanism<T, N, R> + ?Sized),
    state: &State<T, N>,
    out: &mut Acceleration<T, N, R>,
) -> bool {
    mechanism.acceleration(state, out)
}

/// [`Mechanism::correction`], likewise.
#[inline(never)]
pub(crate) fn correction<T: Real, const N: usize, const R: usize>(
    mechanism: &(impl Mechanism<T, N, R> + ?Sized),
    state: &State<T, N>,
    out: &mut Correction<T, N, R>,
) -> bool {
    mechanism.correction(state, out)
}

/// What a program needs to handle a mechanism it knows nothing about.
pub trait Interface<T: Real, const N: usize> {
    /// The value of a parameter, by its place in [`Structure::parameters`].
    fn parameter(&self, index: usize) -> Option<T>;
    /// Sets a parameter; `false` if there is none at this place.
    fn set_parameter(&mut self, index: usize, value: T) -> bool;
    /// Holds an input at a value, or returns it to its default law with `None`;
    /// `false` if there is no input at this place of [`Structure::inputs`].
    fn set_input(&mut self, index: usize, value: Option<T>) -> bool;
    /// Held values and guesses of the initial state, from the `start` block.
    fn start(&self) -> Start<T, N>;
    /// Writes the outputs in the order of [`Structure::outputs`], as many as
    /// `values` has room for. Those of accelerations are left as they are.
    fn outputs(&self, state: &State<T, N>, values: &mut [T]);
    /// Writes the outputs of accelerations into the places that [`outputs`](Self::outputs)
    /// left, and the inputs, held or by their laws, in the order of
    /// [`Structure::inputs`]; as many as there is room for. Nothing where there are
    /// neither.
    fn signals(
        &self,
        _state: &State<T, N>,
        _acceleration: &SVector<T, N>,
        _outputs: &mut [T],
        _inputs: &mut [T],
    ) {
    }
    /// Writes the event functions in the order of [`Structure::events`], as many
    /// as `values` has room for.
    fn events(&self, state: &State<T, N>, values: &mut [T]);
    /// Draws the mechanism at a state.
    fn draw(&self, state: &State<T, N>, canvas: &mut dyn Canvas<T>);
    /// Writes the coordinates that the description declares, in the order of
    /// [`Structure::described`], as many as `values` has room for; nothing where all of
    /// them are coordinates of the state.
    fn described(
        &self,
        _state: &State<T, N>,
        _acceleration: &SVector<T, N>,
        _values: &mut [Described<T>],
    ) {
    }
}

/// A mechanism whose derivatives programs in other languages may ask for. It is implemented
/// where modules are generated for them.
pub trait Differentiated<T: Real, const N: usize> {
    /// Writes how forces, outputs and events change, at a state with this acceleration;
    /// `false` if that is not provided, because its code would be too long or
    /// [`Mechanism::linearised`] is not.
    fn partials(
        &self,
        _state: &State<T, N>,
        _acceleration: &SVector<T, N>,
        _out: &mut Partials<'_, T>,
    ) -> bool {
        false
    }
}

/// A mechanism and what a program needs to handle it, as one object.
///
/// Functions over `&dyn Whole<T, N, R>` are compiled once for each pair of sizes;
/// functions over `M: Mechanism<T, N, R>` once for each mechanism, which is faster
/// where it runs and slower where it is built.
pub trait Whole<T: Real, const N: usize, const R: usize>:
    Mechanism<T, N, R> + Interface<T, N>
{
}

impl<T: Real, M, const N: usize, const R: usize> Whole<T, N, R> for M where
    M: Mechanism<T, N, R> + Interface<T, N>
{
}

/// One acceleration's worth of terms.
#[derive(Clone, Debug)]
pub struct Terms<T, const N: usize, const R: usize> {
    /// `M`, `N × N`, symmetric; both triangles are filled.
    pub mass: SMatrix<T, N, N>,
    /// `p₁ = Q − C q̇ − h` (and the terms of moving frames), `N`.
    pub force: SVector<T, N>,
    /// `A`, `R × N`: `∂g/∂q`, and the rows of the velocity constraints.
    pub jacobian: SMatrix<T, R, N>,
    /// `p₂ = −(Ȧ q̇ + ḃ)`, `R`.
    pub bias: SVector<T, R>,
    /// What holds the conditions; read, not written.
    pub sides: Sides,
    /// The structure of the mechanism that filled it last.
    filled: Option<&'static Structure>,
}

/// The acceleration where the constraints are regular, and how far it can be trusted.
#[derive(Clone, Debug)]
pub struct Acceleration<T, const N: usize, const R: usize> {
    /// `q̈`, `N`.
    pub acceleration: SVector<T, N>,
    /// What was divided by.
    pub pivots: Pivots<T, N, R>,
    /// Read, not written: the weights `W` of the rows that are [`Structure::weighed`], `R`.
    pub weights: SVector<T, R>,
    /// What holds the conditions; read, not written.
    pub sides: Sides,
}

/// One step of a projection where the constraints are regular, and how far it can be trusted.
#[derive(Clone, Debug)]
pub struct Correction<T, const N: usize, const R: usize> {
    /// `g`, `R`; zero in the rows of velocity constraints.
    pub residual: SVector<T, R>,
    /// The least `Δq` in the kinetic metric with `A Δq = −g`, `N`.
    pub position: SVector<T, N>,
    /// The least `Δq̇` in the kinetic metric with `A Δq̇ = −(A q̇ + b)`, `N`; the right-hand
    /// side is that at `q + Δq`, to first order.
    pub velocity: SVector<T, N>,
    /// What was divided by.
    pub pivots: Pivots<T, N, R>,
    /// Read, not written: the weights `W` of the rows that are [`Structure::weighed`], `R`.
    pub weights: SVector<T, R>,
}

/// The pivots of the metric `M = L D Lᵀ` and of `S = A M⁻¹ Aᵀ = Λ E Λᵀ`. They begin as zeros,
/// and those that are zero by structure are not written: they serve one mechanism.
#[derive(Clone, Debug)]
pub struct Pivots<T, const N: usize, const R: usize> {
    /// `d_i`, `N`; zero where it is `m_ii` itself.
    pub mass_pivots: SVector<T, N>,
    /// `m_ii`, `N`; zero where it is the pivot itself.
    pub mass_diagonal: SVector<T, N>,
    /// `e_i`, `R`: over `s_ii`, the squared sine of the angle between a constraint
    /// row and the rows before it, in the kinetic metric.
    pub row_pivots: SVector<T, R>,
    /// `s_ii`, `R`: the squared size of a constraint row in the kinetic metric. Zero where
    /// it is not asked for: a row is compared with the largest that corrections told.
    pub row_squares: SVector<T, R>,
}

/// What a projection at a position needs.
#[derive(Clone, Debug)]
pub struct Position<T, const N: usize, const R: usize> {
    /// `M`, `N × N`: the metric of the projections.
    pub mass: SMatrix<T, N, N>,
    /// `g`, `R`; zero in the rows of velocity constraints.
    pub residual: SVector<T, R>,
    /// `A`, `R × N`.
    pub jacobian: SMatrix<T, R, N>,
    /// `b`, `R`: the velocity level reads `A q̇ + b = 0`.
    pub drift: SVector<T, R>,
    /// The structure of the mechanism that filled it last.
    filled: Option<&'static Structure>,
}

/// The right-hand sides of the linearised equations of motion,
/// `M δq̈ + Aᵀδλ = ∂(p₁ − M q̈ − Aᵀλ)`, `A δq̈ = ∂(p₂ − A q̈)`, with `q̈` and `λ` given.
#[derive(Clone, Debug)]
pub struct Linearised<T, const N: usize, const R: usize> {
    /// `∂(p₁ − M q̈ − Aᵀλ)/∂q`, `N × N`.
    pub force_by_position: SMatrix<T, N, N>,
    /// `∂p₁/∂q̇`, `N × N`.
    pub force_by_velocity: SMatrix<T, N, N>,
    /// `∂(p₂ − A q̈)/∂q`, `R × N`.
    pub row_by_position: SMatrix<T, R, N>,
    /// `∂p₂/∂q̇`, `R × N`.
    pub row_by_velocity: SMatrix<T, R, N>,
    /// What holds the conditions; read, not written.
    pub sides: Sides,
    /// The structure of the mechanism that filled it last.
    filled: Option<&'static Structure>,
}

/// Partial derivatives, row by row, with `U` inputs; places that begin as zeros. An input
/// that follows its law changes with the state where it is not varied itself.
#[derive(Debug)]
pub struct Partials<'a, T> {
    /// `∂p₁/∂u`, `N × U`.
    pub force_by_input: &'a mut [T],
    /// `∂y/∂(q, q̇, q̈, u)`, a row of `3 N + U` for each output.
    pub outputs: &'a mut [T],
    /// Derivatives of the functions of the events by `(q, q̇, q̈, u)`, a row of `3 N + U` for each
    /// event.
    pub events: &'a mut [T],
}

zeroed!(Terms {
    mass,
    force,
    jacobian,
    bias
} sides);
zeroed!(Position {
    mass,
    residual,
    jacobian,
    drift
});
zeroed!(Linearised {
    force_by_position,
    force_by_velocity,
    row_by_position,
    row_by_velocity
} sides);

impl<T: Real, const N: usize, const R: usize> Default for Pivots<T, N, R> {
    fn default() -> Self {
        Self {
            mass_pivots: SVector::zeros(),
            mass_diagonal: SVector::zeros(),
            row_pivots: SVector::zeros(),
            row_squares: SVector::zeros(),
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Default for Acceleration<T, N, R> {
    fn default() -> Self {
        Self {
            acceleration: SVector::zeros(),
            pivots: Pivots::default(),
            weights: SVector::zeros(),
            sides: Sides::FREE,
        }
    }
}

impl<T: Real, const N: usize, const R: usize> Default for Correction<T, N, R> {
    fn default() -> Self {
        Self {
            residual: SVector::zeros(),
            position: SVector::zeros(),
            velocity: SVector::zeros(),
            pivots: Pivots::default(),
            weights: SVector::zeros(),
        }
    }
}

/// Energies at a state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy<T> {
    /// Kinetic energy `T` (J).
    pub kinetic: T,
    /// Potential energy `Π` (J).
    pub potential: T,
    /// `T₂ − T₀ + Π` (J), where `T₂` is the part of `T` quadratic in `q̇` and `T₀`
    /// the part free of it: the energy whose balance is simple. Equal to
    /// `T + Π` where `T` is purely quadratic.
    pub balance: T,
    /// `Q·q̇ + ∂Π/∂t − ∂T/∂t` (W): the rate of `balance`, but for the power
    /// `r·q̇` of the reactions of moving constraints.
    pub power: T,
}

/// One entry of the `start` block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Initial<T> {
    /// The value (SI).
    pub value: T,
    /// Held (`=`) or a guess (`~`). What `start` does not mention is a guess of
    /// zero.
    pub held: bool,
}

/// The initial state as the description gives it: not yet assembled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<T, const N: usize> {
    /// Coordinates.
    pub q: [Initial<T>; N],
    /// Velocities.
    pub v: [Initial<T>; N],
}

/// A coordinate that the description declares, at a motion of the coordinates that were
/// kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Described<T> {
    /// Its value (SI).
    pub position: T,
    /// Its velocity (SI).
    pub velocity: T,
    /// Its acceleration (SI).
    pub acceleration: T,
    /// The generalized reaction force at it, `r = p₁ − M q̈` (N or N·m), of all
    /// constraints that the description has. For a coordinate in no other constraint than
    /// the one that gives it: the multiplier of that one times the coordinate's
    /// coefficient.
    pub reaction: T,
}

/// Receives the picture of a mechanism, one shape at a time. Points are
/// `(x, y, z)` in metres, `z = 0` in the plane.
pub trait Canvas<T> {
    /// An open polygon through the points.
    fn line(&mut self, points: &[[T; 3]]);
    /// A circle.
    fn circle(&mut self, centre: [T; 3], radius: T);
    /// A closed, filled polygon.
    fn polygon(&mut self, points: &[[T; 3]]);
    /// A point whose path is wanted.
    fn trace(&mut self, point: [T; 3]);
}
