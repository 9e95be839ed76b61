//! Selection of one of two sheets that cross.
//!
//! In:  a state in a singular configuration, or next to one.
//! Out: the tangent space of the sheet that it is on, or the news that nothing tells.

use crate::dynamics::{
    Constrained, CoordinateScale, Independent, RETURNING_GRADIENT, SingularValueDecomposition,
    choose_rows, second_derivatives,
};
use crate::equations::At;
use crate::linalg::{
    Workspace, add_scaled, count_above, diagonalise, dot, is_zero, length,
    multiply_upper_transposed, norm, orthonormal, remove, solve_upper_transposed,
};
use crate::once::compiled_once;
use crate::tolerance::{critical, difference, regular, round_off, window};
use crate::{DynamicsError, Real};

/// A sheet is selected if the state is nearer to it than to the other by this factor.
const NEARER: f64 = 4.0;
/// A velocity that is not nearer to one sheet than to the other by this factor is off both.
const CLEARLY_NEARER: f64 = 1e3;
/// Eigenvalues of `H` below this part of the largest are zero.
const FLAT: f64 = 0.1;

/// Fills `free` with an orthonormal basis of the directions that are left when `remove` takes away
/// the others, lowered.
fn span_free<T: Real>(
    factor: &[T],
    free: &mut [T],
    n: usize,
    remove: &dyn Fn(&mut [T]),
    workspace: &Workspace<'_, T>,
) {
    orthonormal(free, n, remove, workspace);
    for column in free.chunks_exact_mut(n) {
        solve_upper_transposed(factor, column);
    }
}

/// Finds the tangent space in a singular configuration or next to one; whether anything tells.
pub(super) fn singular_tangent<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    tangent: &mut [T],
    workspace: &Workspace<'_, T>,
) -> Result<bool, DynamicsError<T>> {
    let n = state.q.len();
    let count = n - tangent.len() / n;
    let all = solver.learn().rows.all_independent();
    let least = if all { regular() } else { window() };
    if tangent_of_rows(solver, (n, least), tangent, workspace) {
        return Ok(true);
    }
    if !all {
        choose_rows(solver, workspace);
        if tangent_of_rows(solver, (n, regular()), tangent, workspace) {
            return Ok(true);
        }
    }
    let decomposition = SingularValueDecomposition::here(solver, state.t, workspace)?;
    let values = &decomposition.values[..count];
    if count_above(values, regular()) == count {
        let remove = |axis: &mut [T]| remove(axis, decomposition.decided(count));
        span_free(solver.known().factor, tangent, n, &remove, workspace);
        return Ok(true);
    }
    let still = is_zero(solver.constraints().drift);
    if tangent_along(solver, state, tangent, workspace)? {
        return Ok(true);
    }
    let near = values.iter().filter(|value| **value < window()).count();
    if near != 1 || !solver.known().holonomic.iter().all(|row| *row) || !still {
        return Ok(false);
    }
    one_of_two(solver, state, &decomposition, tangent, workspace)
}

/// Finds the tangent space where the constraints were evaluated last; `false` where it is not
/// sure that the singular values of the chosen rows are above a bound.
fn tangent_of_rows<T: Real>(
    solver: &mut dyn Constrained<T>,
    (n, least): (usize, T),
    tangent: &mut [T],
    workspace: &Workspace<'_, T>,
) -> bool {
    let count = n - tangent.len() / n;
    workspace.scope(|workspace| {
        let (rows, chosen) = (workspace.indices(count), solver.learn().rows);
        if chosen.active().len() != count {
            return false;
        }
        rows.copy_from_slice(chosen.active());
        let found = Independent::here(solver, rows, least, workspace);
        let is_sure = found.is_some();
        if let Some(mut rows) = found {
            rows.span_free(solver.known().factor, tangent, workspace);
        }
        is_sure
    })
}

/// Finds the tangent space of the sheet that the velocity leads along: on it, the gradient
/// that is lost returns in the direction of the sheet's normal. `false` where the velocity
/// leads along the singular set, or is zero.
fn tangent_along<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    tangent: &mut [T],
    workspace: &Workspace<'_, T>,
) -> Result<bool, DynamicsError<T>> {
    let n = state.q.len();
    let count = n - tangent.len() / n;
    let moved = workspace.numbers(n);
    let speed = length(solver.known().factor, state.v);
    if speed == T::zero() {
        return Ok(false);
    }
    let span = difference::<T>() * solver.known().coordinate_scale.range / speed;
    let mut best = difference::<T>() * T::from_f64(RETURNING_GRADIENT);
    let mut found = false;
    for span in [span, -span] {
        moved.copy_from_slice(state.q);
        add_scaled(moved, span, state.v);
        solver.visit(state.t + span, moved)?;
        workspace.scope(|workspace| {
            let decomposition = SingularValueDecomposition::here(solver, state.t, workspace)?;
            let values = decomposition.values[..count].iter();
            let least = values.fold(T::one(), |a, b| a.min(*b));
            if least > best {
                (best, found) = (least, true);
                let remove = |axis: &mut [T]| remove(axis, decomposition.decided(count));
                span_free(solver.known().factor, tangent, n, &remove, workspace);
            }
            Ok(())
        })?;
    }
    solver.visit(state.t, state.q)?;
    Ok(found)
}

/// Finds the tangent space of one of two sheets that cross.
fn one_of_two<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    decomposition: &SingularValueDecomposition<'_, T>,
    tangent: &mut [T],
    workspace: &Workspace<'_, T>,
) -> Result<bool, DynamicsError<T>> {
    let n = state.q.len();
    let freedoms = tangent.len() / n;
    let weakest = n - freedoms - 1;
    let strong = decomposition.decided(weakest);
    let kernel = workspace.numbers(n * (freedoms + 1));
    orthonormal(kernel, n, &|axis| remove(axis, strong), workspace);
    let normals = workspace.numbers(2 * n);
    let weak = (decomposition.left(weakest), &*kernel);
    if !find_normals(solver, state, weak, normals, workspace) {
        return Ok(false);
    }
    let velocity = workspace.numbers(n);
    multiply_upper_transposed(solver.known().factor, state.v, velocity);
    let sheets = [(); 2].map(|()| workspace.numbers(tangent.len()));
    let mut away = [T::zero(); 2];
    for (i, normal) in normals.chunks_exact(n).enumerate() {
        away[i] = dot(normal, velocity).abs();
        let remove = |axis: &mut [T]| {
            remove(axis, strong);
            remove(axis, normal);
        };
        span_free(solver.known().factor, sheets[i], n, &remove, workspace);
    }
    let sheets = [&*sheets[0], &*sheets[1]];
    let distances = distances(solver, state, sheets, workspace)?;
    let selected = select(
        (away, norm(velocity)),
        distances,
        solver.known().coordinate_scale,
    );
    if let Some(selected) = selected {
        tangent.copy_from_slice(sheets[selected]);
    }
    Ok(selected.is_some())
}

/// Selects one of two sheets, from how far the velocity and the position are off them.
fn select<T: Real>(
    (away, speed): ([T; 2], T),
    distances: Option<[T; 2]>,
    coordinate_scale: CoordinateScale<T>,
) -> Option<usize> {
    let crosses = larger(away) > regular::<T>() * speed;
    let by_velocity = nearer(away, T::from_f64(CLEARLY_NEARER)).filter(|_| crosses);
    // Distances that are nothing but round-off tell nothing.
    let least = match crosses {
        true => regular::<T>() * coordinate_scale.range,
        false => round_off::<T>() * critical() * coordinate_scale.size,
    };
    let known = distances.filter(|away| larger(*away) > least);
    let by_position = known.map(|away| nearer(away, T::from_f64(NEARER)));
    match (by_velocity, by_position) {
        (Some(one), None) => Some(one),
        (None, Some(other)) => other,
        (one, other) if Some(one) == other => one,
        _ => None,
    }
}

/// How far a state is off two sheets; `None` where that can't be told.
fn distances<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    sheets: [&[T]; 2],
    workspace: &Workspace<'_, T>,
) -> Result<Option<[T; 2]>, DynamicsError<T>> {
    let mut distances = [T::zero(); 2];
    let mut known = true;
    for (sheet, distance) in sheets.into_iter().zip(&mut distances) {
        let found = workspace.scope(|workspace| solver.distance(state, sheet, workspace));
        known &= found.is_some();
        *distance = found.unwrap_or_default();
        solver.visit(state.t, state.q)?;
    }
    Ok(known.then_some(distances))
}

/// Finds the normals of two sheets from the second derivatives of a combination of rows, among
/// the directions that the others leave free; `false` where they do not show two sheets that cross.
fn find_normals<T: Real>(
    solver: &mut dyn Constrained<T>,
    state: At<'_, T>,
    (combination, kernel): (&[T], &[T]),
    normals: &mut [T],
    workspace: &Workspace<'_, T>,
) -> bool {
    let n = state.q.len();
    let count = kernel.len() / n;
    let second = workspace.numbers(count * count);
    let vectors = workspace.numbers(count * count);
    second_derivatives(solver, state, combination, kernel, second, workspace);
    diagonalise(second, vectors, count);
    let value = |k: usize| second[k * (count + 1)];
    let (mut up, mut down) = (0, 0);
    for k in 0..count {
        if value(k) > value(up) {
            up = k;
        }
        if value(k) < value(down) {
            down = k;
        }
    }
    let most = value(up).max(-value(down));
    let flat = most * T::from_f64(FLAT);
    let others = (0..count).filter(|k| *k != up && *k != down);
    let curved = others.fold(T::zero(), |most: T, k| most.max(value(k).abs()));
    let least = flat * flat / most;
    // Comparisons with NaN are false: where all values are zero, there are no two sheets.
    let two = value(up) > least && -value(down) > least && curved <= flat;
    if !two {
        return false;
    }
    let (more, less) = (value(up).sqrt(), (-value(down)).sqrt());
    let size = (more * more + less * less).sqrt();
    let vector = |k: usize| vectors[k * count..][..count].iter();
    for (normal, less) in normals.chunks_exact_mut(n).zip([less, -less]) {
        for (axis, (up, down)) in kernel.chunks_exact(n).zip(vector(up).zip(vector(down))) {
            add_scaled(normal, (more * *up + less * *down) / size, axis);
        }
    }
    true
}

fn larger<T: Real>([first, second]: [T; 2]) -> T {
    first.max(second)
}

/// Which of two distances is smaller by this factor, if one is.
fn nearer<T: Real>([first, second]: [T; 2], factor: T) -> Option<usize> {
    if first * factor < second {
        Some(0)
    } else if second * factor < first {
        Some(1)
    } else {
        None
    }
}

compiled_once! {
    /// [`singular_tangent`].
    pub(super) fn finding_tangent<T>: fn(
        &mut dyn Constrained<T>,
        At<'_, T>,
        &mut [T],
        &Workspace<'_, T>,
    ) -> Result<bool, DynamicsError<T>> = singular_tangent;
}
