//! What is sent arrives to the same bits, or not at all.

use super::{Reply, Request, receive, row, send};
use crate::{Column, Drawn, Given, Reached, Scene, Segment};
use bricard_runtime::{
    ConstraintRow, Counters, Direction, Event, Method, Options, Origin, Passage, Quantity,
    Stabilisation, StepControl, Structure,
};
use std::time::Duration;

fn bytes(value: &impl super::Wire) -> Vec<u8> {
    let mut bytes = Vec::new();
    send(&mut bytes, value).expect("there is room in memory");
    bytes
}

fn structure() -> Structure {
    const X: Quantity = Quantity {
        name: "x",
        unit: "m",
        docs: " where it is — in m\n",
    };
    Structure {
        name: "Slider",
        coordinates: &[X],
        unitless_angles: &[0],
        constraints: &[ConstraintRow {
            text: "x = 0",
            line: 7,
            holonomic: true,
        }],
        events: &[Event {
            name: "stop",
            direction: Direction::Falling,
        }],
        conservative: true,
        ..Structure::PLAIN
    }
}

fn segment() -> Segment {
    let mut options = Options::new(1.0, Method::Radau9, StepControl::Fixed { step: 0.1 + 0.2 });
    options.settings.stabilisation = Stabilisation::Baumgarte {
        alpha: 1e-300,
        beta: -0.0,
    };
    options.most_steps = Some(u64::MAX);
    options.origin = Some(Origin {
        t: 0.0,
        energy: -1.5,
        supplied: f64::INFINITY,
    });
    Segment {
        options,
        from: Some(vec![0.3, f64::MIN_POSITIVE]),
        every: None,
        columns: vec![Column::Energy, Column::Reaction(3), Column::Output(0)],
        rows: 12,
        short: true,
    }
}

fn reached() -> Reached {
    Reached {
        state: vec![1.0, 2.0],
        origin: Origin {
            t: 0.0,
            energy: 1.0,
            supplied: 0.0,
        },
        rows: 3,
        error: Some("stuck — at t = 1 s".to_string()),
        steps: 5,
        rejected: 1,
        wall: Duration::new(3, 999_999_999),
        constraint_error: 1e-16,
        energy_error: 0.0,
        energy_exchanged: 2.0,
        passages: vec![Passage {
            t: 0.5,
            sine: 1e-9,
            rank: 2,
            regular: 3,
        }],
        events: vec![(1, 0.25)],
        counters: Counters {
            projections: 4,
            ..Counters::default()
        },
    }
}

#[test]
fn a_row_is_written_like_any_other_message() {
    let mut written = vec![7; 3];
    for values in [vec![], vec![1.5], vec![0.1, -0.0, f64::NAN, 4e300]] {
        row(&values, &mut written);
        assert_eq!(written, bytes(&Reply::Row(values)));
    }
}

#[test]
fn messages_arrive_as_they_were_sent() {
    let given = Given {
        coordinate: 2,
        velocity: true,
        held: false,
        value: -1e-3,
    };
    for request in [
        Request::Parameter(3, 0.1),
        Request::Begin(given),
        Request::Segment(segment()),
        Request::Stop,
        Request::TimedRun(None, segment().options),
        Request::Scene(vec![vec![0.0, 1.5], Vec::new()]),
        Request::RankAtStart,
    ] {
        let arrived: Request = receive(&mut &bytes(&request)[..]).expect("it is whole");
        assert_eq!(arrived, request);
    }
    for reply in [
        Reply::Structure(structure()),
        Reply::Row(vec![0.1, -0.0]),
        Reply::At(1.5, 32),
        Reply::Segment(Ok(reached())),
        Reply::Segment(Err("no start".to_string())),
        Reply::Scene(Ok(Scene {
            parameters: vec![0.5],
            shapes: vec![
                Drawn::Line(2),
                Drawn::Circle,
                Drawn::Polygon(3),
                Drawn::Trace,
            ],
            frames: vec![vec![0.1, -0.0], Vec::new()],
        })),
        Reply::RankAtStart(Ok(4)),
    ] {
        let arrived: Reply = receive(&mut &bytes(&reply)[..]).expect("it is whole");
        assert_eq!(arrived, reply);
    }
}

#[test]
fn numbers_arrive_to_the_same_bits() {
    let values = vec![-0.0, f64::NAN, f64::NEG_INFINITY, 5e-324];
    let sent = bytes(&Reply::Row(values.clone()));
    let Ok(Reply::Row(arrived)) = receive::<Reply>(&mut &sent[..]) else {
        panic!("it was a row");
    };
    let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&arrived), bits(&values));
}

#[test]
fn what_is_cut_short_or_goes_on_is_no_message() {
    let whole = bytes(&Reply::Segment(Ok(reached())));
    for length in 0..whole.len() {
        assert!(receive::<Reply>(&mut &whole[..length]).is_err(), "{length}");
    }
    let mut longer = bytes(&Request::Stop);
    longer[0] += 1;
    longer.push(0);
    assert!(receive::<Request>(&mut &longer[..]).is_err());
    let mut other = bytes(&Request::Stop);
    other[8] = 99;
    assert!(receive::<Request>(&mut &other[..]).is_err());
}
