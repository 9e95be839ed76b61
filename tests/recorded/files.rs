//! Tables from files beside the description.

use crate::rows::{methods, record};
use bricard_driver::Column;
use bricard_recorded::sampled::Sampled;

#[test]
fn a_mass_pushed_by_a_file_is_where_its_integrals_say() {
    let columns = [Column::Input(0), Column::Output(0)];
    for options in methods(4.0) {
        let rows = record::<_, 2, 0>(Sampled::default(), options, &columns);
        let method = options.method;
        let all = rows.each(["t", "der(x)", "push", "wave"]);
        for [t, v, push, wave] in &all {
            let (wanted, speed) = match t {
                t if *t < 0.5 => (40.0 * t, 20.0 * t * t),
                t if *t < 2.0 => (20.0, 5.0 + 20.0 * (t - 0.5)),
                t if *t < 2.5 => {
                    let left = 2.5 - t;
                    (40.0 * left, 40.0 - 20.0 * left * left)
                }
                _ => (0.0, 40.0),
            };
            assert!((push - wanted).abs() < 1e-12, "{method} at {t}: {push}");
            assert!((v - speed).abs() < 1e-11, "{method} at {t}: {v}");
            let point = [(0.0, 0.0), (0.5, 1.0), (2.0, 0.0), (2.5, -1.0), (4.0, 0.0)];
            if let Some((_, exact)) = point.iter().find(|(at, _)| (at - t).abs() < 1e-12) {
                assert!((wave - exact).abs() < 1e-12, "{method} at {t}: {wave}");
            }
        }
    }
}
