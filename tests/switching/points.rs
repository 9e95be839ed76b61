//! Points of long tables, for the files that descriptions read and for their closed forms.

/// Seconds, or metres, that a table covers.
pub const SPAN: f64 = 4.0;

/// Points of a zigzag about a wave, at uneven distances.
pub fn points(count: usize) -> Vec<[f64; 2]> {
    let point = |i: usize| {
        let uneven = 0.3 * ((i * 7919 % 101) as f64 / 101.0);
        let place = SPAN * (i as f64 + uneven) / count as f64;
        let sign = if i.is_multiple_of(2) { 0.5 } else { -0.5 };
        [place, 3.0 * (2.0 * place).sin() + sign]
    };
    (0..count).map(point).collect()
}
