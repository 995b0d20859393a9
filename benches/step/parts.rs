//! Criterion benches: the coupled step and each thing inside it, alone.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion};
use idc_cell::arm::chain::MAX_JOINTS;
use idc_cell::arm::dynamics::inverse_dynamics;
use idc_cell::cell::Cell;
use idc_cell::device::{Device, PistonMotion};
use idc_cell::workpiece::ContactSurface;

use crate::job::{Following, follow_span, holding_world};

/// Short enough for the whole bench to take less than two minutes.
pub fn criterion() -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_millis(1200))
        .sample_size(20)
        .configure_from_args()
}

/// Everything.
pub fn all(criterion: &mut Criterion, cell: &Cell) {
    coupled(criterion, cell);
    rigid_bodies(criterion, cell);
    device(criterion, cell);
    path_and_servo(criterion, cell);
    contact_search(criterion, cell);
}

fn coupled(criterion: &mut Criterion, cell: &Cell) {
    let mut following = Following::new(cell);
    let id = BenchmarkId::new("coupled step", "whole cell");
    let mut group = criterion.benchmark_group("cell");
    group.bench_function(id, |bencher| {
        bencher.iter_custom(|steps| following.run(steps as usize, None));
    });
    group.finish();
}

/// Rapier with the same arm and laws and nothing of ours but the contact.
fn rigid_bodies(criterion: &mut Criterion, cell: &Cell) {
    let mut group = criterion.benchmark_group("rigid bodies");
    for (name, lift) in [("on the edge", 0.0), ("off the edge", 0.01)] {
        let mut world = holding_world(cell, lift);
        let touching = world.force() > 0.0;
        assert_eq!(touching, lift == 0.0, "the ball must be {name}");
        group.bench_function(BenchmarkId::new("step", name), |bencher| {
            bencher.iter(|| world.step());
        });
    }
    group.finish();
}

fn device(criterion: &mut Criterion, cell: &Cell) {
    let scenario = &cell.setup.scenario;
    let device = &Device::new(&cell.setup.actual.device);
    let pressure = 1e5;
    let stroke = scenario.process.working_stroke;
    let mut group = criterion.benchmark_group("device");
    for substeps in [1, 2, 4] {
        let mut state = device.at_rest(stroke, pressure);
        let mut speed = 1e-3;
        group.bench_function(BenchmarkId::new("substeps", substeps), |bencher| {
            bencher.iter(|| {
                // Back and forth, so that air flows and the stroke stays.
                speed = -speed;
                device.advance(
                    &mut state,
                    pressure,
                    PistonMotion { stroke, speed },
                    scenario.simulation.step,
                    substeps,
                )
            });
        });
    }
    group.finish();
}

fn path_and_servo(criterion: &mut Criterion, cell: &Cell) {
    let (start, end) = follow_span(cell);
    let step = cell.setup.scenario.simulation.step;
    let mut group = criterion.benchmark_group("path and servo");
    let mut time = start;
    group.bench_function("reference", |bencher| {
        bencher.iter(|| {
            time = if time + step < end {
                time + step
            } else {
                start
            };
            cell.plan.reference(black_box(time))
        });
    });
    let chain = &cell.setup.arm_with_slide;
    let count = chain.len();
    let reference = cell.plan.reference(f64::midpoint(start, end));
    let gravity = cell.setup.scenario.simulation.gravity;
    let base = cell.setup.scenario.arm.world_from_base.rotation;
    group.bench_function("inverse dynamics", |bencher| {
        bencher.iter(|| {
            let reference = black_box(&reference);
            let mut torque = [0.0; MAX_JOINTS];
            let (q, qd, qdd) = (
                &reference.position,
                &reference.velocity,
                &reference.acceleration,
            );
            inverse_dynamics(
                chain,
                base,
                gravity,
                &q[..count],
                &qd[..count],
                &qdd[..count],
                &mut torque[..count],
            );
            torque
        });
    });
    group.finish();
}

fn contact_search(criterion: &mut Criterion, cell: &Cell) {
    let surface = ContactSurface::new(&cell.setup.part.mesh_in_world);
    let reach = cell.setup.scenario.nominal.mounting.tool_radius + 1e-3;
    let (start, end) = follow_span(cell);
    let step = cell.setup.scenario.simulation.step;
    // Places along the path, so that it is not always the same triangles.
    let count = ((end - start) / step) as usize;
    let centres: Vec<_> = (0..count)
        .map(|i| cell.plan.reference(start + i as f64 * step).centre)
        .collect();
    let mut found = Vec::new();
    let mut group = criterion.benchmark_group("contact search");
    let id = BenchmarkId::new("triangles", cell.setup.part.mesh_in_world.triangles().len());
    group.bench_function(id, |bencher| {
        bencher.iter_custom(|rounds| {
            let clock = Instant::now();
            for centre in centres.iter().cycle().take(rounds as usize) {
                surface.genuine_contacts(black_box(*centre), reach, &mut found);
                black_box(&found);
            }
            clock.elapsed()
        });
    });
    group.finish();
}
