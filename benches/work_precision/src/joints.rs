//! rapier: rigid bodies held together by impulse joints.

use crate::problem::{End, Failed, Problem};
use rapier2d_f64::prelude::{
    MassProperties, PhysicsWorld, PrismaticJointBuilder, RevoluteJointBuilder, RigidBodyBuilder,
    RigidBodyHandle, Vector,
};

/// Runs a problem from a start angle at rest, with steps of a length (s).
///
/// # Errors
///
/// A problem that isn't modelled for rapier: the driven one.
pub fn run(problem: Problem, start: f64, iterations: usize, step: f64) -> Result<End, Failed> {
    let mut model = match problem {
        Problem::Free => slider_crank(start),
        Problem::FourBar => double_four_bar(start),
        Problem::Driven => return Err("not modelled: the moment follows the velocity".into()),
    };
    model.world.integration_parameters.dt = step;
    model.world.integration_parameters.num_solver_iterations = iterations;
    let mut angles: Vec<f64> = model.rods.iter().map(|rod| model.angle(*rod)).collect();
    let steps = (problem.end() / step).round() as u64;
    for _ in 0..steps {
        model.world.step();
        for (angle, rod) in angles.iter_mut().zip(&model.rods) {
            // Angles go on counting beyond a whole turn.
            let turn = model.angle(*rod) - *angle;
            *angle += turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round();
        }
    }
    Ok(match problem {
        Problem::FourBar => angles,
        _ => vec![angles[0], -angles[1], angles[0].cos()],
    })
}

struct Model {
    world: PhysicsWorld,
    rods: Vec<RigidBodyHandle>,
}

impl Model {
    fn new() -> Self {
        Self {
            world: PhysicsWorld::default(),
            rods: Vec::new(),
        }
    }

    fn ground(&mut self) -> RigidBodyHandle {
        self.world.bodies.insert(RigidBodyBuilder::fixed())
    }

    /// A rod of 1 kg and 0.1 kg m² whose middle is at a place.
    fn rod(&mut self, x: f64, y: f64, angle: f64) -> RigidBodyHandle {
        let mass = MassProperties::new(Vector::new(0.0, 0.0), 1.0, 0.1);
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(x, y))
            .rotation(angle)
            .additional_mass_properties(mass)
            .can_sleep(false);
        let handle = self.world.bodies.insert(body);
        self.rods.push(handle);
        handle
    }

    /// Joins two bodies at a point of each, given in its own frame.
    fn pin(&mut self, first: RigidBodyHandle, a: [f64; 2], second: RigidBodyHandle, b: [f64; 2]) {
        let joint = RevoluteJointBuilder::new()
            .local_anchor1(Vector::new(a[0], a[1]))
            .local_anchor2(Vector::new(b[0], b[1]));
        self.world.impulse_joints.insert(first, second, joint, true);
    }

    fn angle(&self, rod: RigidBodyHandle) -> f64 {
        self.world.bodies[rod].rotation().angle()
    }
}

fn slider_crank(q: f64) -> Model {
    let (e, l) = (0.25, 0.5);
    let mut model = Model::new();
    let ground = model.ground();
    let crank = model.rod(e * q.cos(), e * q.sin(), q);
    let rod = model.rod((l + e) * q.cos(), e * q.sin(), -q);
    let mass = MassProperties::new(Vector::new(0.0, 0.0), 0.5, 1.0);
    let slider = RigidBodyBuilder::dynamic()
        .translation(Vector::new(2.0 * l * q.cos(), 0.0))
        .additional_mass_properties(mass)
        .can_sleep(false);
    let slider = model.world.bodies.insert(slider);
    model.pin(ground, [0.0, 0.0], crank, [-e, 0.0]);
    model.pin(crank, [e, 0.0], rod, [-e, 0.0]);
    model.pin(rod, [e, 0.0], slider, [0.0, 0.0]);
    let guide = PrismaticJointBuilder::new(Vector::new(1.0, 0.0));
    model
        .world
        .impulse_joints
        .insert(ground, slider, guide, true);
    model
}

fn double_four_bar(q: f64) -> Model {
    let (r, l) = (0.4, 0.7);
    let mut model = Model::new();
    let ground = model.ground();
    let end = |pivot: f64| [pivot + r * q.cos(), r * q.sin()];
    let crank =
        |model: &mut Model, pivot: f64| model.rod(pivot + 0.5 * r * q.cos(), 0.5 * r * q.sin(), q);
    let first = crank(&mut model, 0.0);
    let coupler = model.rod(end(0.0)[0] + 0.5 * l, end(0.0)[1], 0.0);
    let second = crank(&mut model, l);
    let other = model.rod(end(l)[0] + 0.5 * l, end(l)[1], 0.0);
    let third = crank(&mut model, 2.0 * l);
    for (pivot, crank) in [(0.0, first), (l, second), (2.0 * l, third)] {
        model.pin(ground, [pivot, 0.0], crank, [-0.5 * r, 0.0]);
    }
    let (tip, left, right) = ([0.5 * r, 0.0], [-0.5 * l, 0.0], [0.5 * l, 0.0]);
    model.pin(first, tip, coupler, left);
    model.pin(coupler, right, second, tip);
    model.pin(second, tip, other, left);
    model.pin(other, right, third, tip);
    model
}
