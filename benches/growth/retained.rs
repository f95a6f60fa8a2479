//! Measures frames over a retained set of many casters: nothing moves, the camera walks, some
//! casters move, all of them move.

use std::time::Instant;

use glam::{DVec3, Vec3};
use shadow_support::camera;
use shadow_support::gpu::Gpu;
use shadow_support::measure::statistics::Spread;
use shadow_support::mesh::{Mesh, render_space_pipeline};
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CameraView, CasterId, CasterPipeline, CasterSet, Casters, Coverage, Filter, Revision,
    ShadowCaster, ShadowFrameDescriptor, ShadowView,
};

use super::crowd;
use super::lamps::Lamps;
use super::processor;
use super::stage::Stage;
use super::table::Growth;

/// Is the number of frames before those that are measured.
const SETTLING: u32 = 12;
const LAMPS: u32 = 32;
const CASTERS_OF_LAMPS: u32 = 2_000;

/// Is what moves in a frame.
#[derive(Clone, Copy, PartialEq)]
enum Motion {
    Nothing,
    /// Moves the camera by 0.1 m.
    Walk,
    /// Moves so many of a thousand casters by up to 0.1 m, and tells the set.
    PerMille(u32),
}

const MOTIONS: [Motion; 4] = [
    Motion::Nothing,
    Motion::Walk,
    Motion::PerMille(10),
    Motion::PerMille(1000),
];

/// Is a box that moves. All of them draw the same small mesh: encoding a draw costs the same, and a
/// million meshes would need too much memory.
pub struct Mover {
    pipeline: CasterPipeline,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
    bounds: Aabb,
    velocity: Vec3,
    id: u64,
    version: u64,
}

impl Mover {
    fn step(&mut self, frame: u32) {
        // Each goes to and fro, so that the crowd stays a crowd.
        let way = if (frame / 40).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        self.bounds.min += self.velocity * way;
        self.bounds.max += self.velocity * way;
        self.version += 1;
    }
}

impl ShadowCaster for Mover {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn pipeline(&self) -> &CasterPipeline {
        &self.pipeline
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _: &ShadowView) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.index_count, 0, 0..1);
    }

    fn keeps_pass_state(&self) -> bool {
        true
    }

    fn triangles(&self) -> u32 {
        self.index_count / 3
    }

    fn revision(&self) -> Option<Revision> {
        Some(Revision::new(self.id, self.version))
    }
}

/// Makes `count` boxes with four metres of ground each.
fn movers(gpu: &Gpu, count: u32) -> (CasterSet<Mover>, Vec<CasterId>) {
    let half = crowd::half_side(count);
    let mesh = Mesh::standing_box(Vec3::ZERO, Vec3::splat(0.5), 0.0);
    let pipeline = render_space_pipeline(gpu);
    let vertices = gpu.buffer(&mesh.positions, wgpu::BufferUsages::VERTEX);
    let indices = gpu.buffer(&mesh.indices, wgpu::BufferUsages::INDEX);
    let mut random = Random::new(31);
    let mut set = CasterSet::new();
    let ids = set.insert_all((0..count).map(|id| {
        let mut between = |low, high| random.between(low, high);
        let foot = Vec3::new(between(-half, half), 0.0, between(-half, half));
        let size = Vec3::new(between(0.3, 1.0), between(0.3, 3.0), between(0.3, 1.0));
        let velocity = Vec3::new(between(-0.1, 0.1), 0.0, between(-0.1, 0.1));
        Mover {
            pipeline: pipeline.clone(),
            vertices: vertices.clone(),
            indices: indices.clone(),
            index_count: mesh.indices.len() as u32,
            bounds: Aabb::new(foot, foot + size),
            velocity,
            id: u64::from(id),
            version: 0,
        }
    }));
    (set, ids)
}

/// Measures `frame` and `record` of a sun with four cascades and of many lamps, update of the set
/// included.
pub fn retained(stage: &Stage<'_>, most: u32) {
    for count in [100_000, 1_000_000] {
        if count <= 10 * most {
            suns(stage, count);
        }
    }
    lamps(stage);
}

fn table(title: String) -> Growth {
    Growth::new(
        title,
        &[
            "moving ‰ (-1: camera)",
            "set µs",
            "of it update µs",
            "allocs",
            "passes",
            "draws",
            "list µs",
        ],
    )
}

fn per_mille(motion: Motion) -> f64 {
    match motion {
        Motion::Walk => -1.0,
        Motion::Nothing => 0.0,
        Motion::PerMille(share) => f64::from(share),
    }
}

fn suns(stage: &Stage<'_>, count: u32) {
    let mut table = table(format!(
        "set of {count} casters, four cascades of 1024 texels out to 60 m: `update`, `frame` and `record` on the CPU, and \
         beside them, in turn, the same with a list",
    ));
    for motion in MOTIONS {
        let (mut set, ids) = movers(stage.gpu, count);
        let mut suns = [(); 2].map(|()| stage.sun(1024, 4, Filter::default()));
        let [of_set, of_list] = &mut suns;
        let mut frame = 0;
        let mut times: [Vec<processor::Effort>; 2] = Default::default();
        let mut updates = Vec::new();
        // A list of a million casters takes long.
        let with_list = count <= 100_000;
        let mut counts = (0, 0);
        for round in 0..SETTLING + stage.repeats {
            frame += 1;
            let walked = if motion == Motion::Walk {
                0.1 * frame as f32
            } else {
                0.0
            };
            let eye = Vec3::new(walked, 2.0, 0.0);
            let camera = camera::looking(eye, eye + Vec3::new(9.0, -1.0, 5.0), 0.9);
            let cameras = [camera.with_max_distance(60.0)];
            let mut encoder = Some(stage.gpu.encoder());
            let effort = processor::measure(
                1,
                || encoder.take().expect("one call"),
                |encoder| {
                    let start = Instant::now();
                    step(&mut set, &ids, motion, frame);
                    updates.push(start.elapsed().as_secs_f64() * 1e6);
                    let report = of_set.record(encoder, &frame_of(&cameras, Casters::Set(&set)));
                    counts = (report.passes, report.draws());
                },
            );
            let list_effort = with_list.then(|| {
                let members: Vec<&Mover> = ids.iter().filter_map(|id| set.get(*id)).collect();
                let list: Vec<&dyn ShadowCaster> = members.iter().map(|m| *m as _).collect();
                let record = |encoder: &mut wgpu::CommandEncoder| {
                    of_list
                        .record(encoder, &frame_of(&cameras, Casters::List(&list)))
                        .passes
                };
                processor::measure(1, || stage.gpu.encoder(), record)
            });
            if round >= SETTLING {
                times[0].push(effort);
                times[1].extend(list_effort);
            }
        }
        let [set_times, list_times] = times;
        let (effort, list) = (
            processor::median(&set_times),
            processor::median(&list_times),
        );
        table.add(
            per_mille(motion),
            [
                effort.microseconds,
                Spread::of(updates[SETTLING as usize..].iter().copied()).median,
                effort.allocations,
                f64::from(counts.0),
                f64::from(counts.1),
                list.microseconds,
            ],
        );
    }
    table.print();
}

fn lamps(stage: &Stage<'_>) {
    let mut table = table(format!(
        "set of {CASTERS_OF_LAMPS} casters, {LAMPS} point lights of 256 texels: the same",
    ));
    let half = crowd::half_side(CASTERS_OF_LAMPS);
    for motion in MOTIONS {
        if motion == Motion::Walk {
            continue;
        }
        let (mut set, ids) = movers(stage.gpu, CASTERS_OF_LAMPS);
        let mut of_set = Lamps::new(stage.gpu, LAMPS);
        let mut of_list = Lamps::new(stage.gpu, LAMPS);
        let mut times: [Vec<processor::Effort>; 2] = Default::default();
        let mut updates = Vec::new();
        let mut counts = super::counts::Counts::default();
        for round in 0..SETTLING + stage.repeats {
            let effort = processor::measure(
                1,
                || stage.gpu.encoder(),
                |encoder| {
                    let start = Instant::now();
                    step(&mut set, &ids, motion, round);
                    updates.push(start.elapsed().as_secs_f64() * 1e6);
                    counts = of_set.record(encoder, Casters::Set(&set), half);
                },
            );
            let members: Vec<&Mover> = ids.iter().filter_map(|id| set.get(*id)).collect();
            let list: Vec<&dyn ShadowCaster> = members.iter().map(|m| *m as _).collect();
            let list_effort = processor::measure(
                1,
                || stage.gpu.encoder(),
                |encoder| of_list.record(encoder, Casters::List(&list), half),
            );
            if round >= SETTLING {
                times[0].push(effort);
                times[1].push(list_effort);
            }
        }
        let [set_times, list_times] = times;
        let (effort, list) = (
            processor::median(&set_times),
            processor::median(&list_times),
        );
        table.add(
            per_mille(motion),
            [
                effort.microseconds,
                Spread::of(updates[SETTLING as usize..].iter().copied()).median,
                effort.allocations,
                f64::from(counts.passes),
                f64::from(counts.draws),
                list.microseconds,
            ],
        );
    }
    table.print();
}

/// Returns the descriptor of a frame that cameras see.
fn frame_of<'d, 'c>(
    cameras: &'d [CameraView],
    casters: Casters<'c>,
) -> ShadowFrameDescriptor<'d, 'c> {
    ShadowFrameDescriptor {
        origin: DVec3::ZERO,
        coverage: Coverage::Cameras(cameras),
        casters,
        receivers: &[],
    }
}

/// Moves the casters of a frame, the same in each, and tells the set.
fn step(set: &mut CasterSet<Mover>, ids: &[CasterId], motion: Motion, frame: u32) {
    let Motion::PerMille(share) = motion else {
        return;
    };
    let stride = (1000 / share) as usize;
    for &id in ids.iter().step_by(stride) {
        set.update(id, |mover| mover.step(frame))
            .expect("a caster of the set");
    }
}
