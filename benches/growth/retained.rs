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
    Aabb, CameraView, CasterId, CasterSet, Casters, Coverage, Filter, ShadowCaster,
    ShadowFrameDescriptor,
};

use super::crowd::{self, BoxCaster};
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
    /// Moves so many of a thousand casters by up to 0.1 m, and updates the set.
    PerMille(u32),
}

const MOTIONS: [Motion; 4] = [
    Motion::Nothing,
    Motion::Walk,
    Motion::PerMille(10),
    Motion::PerMille(1000),
];

/// Holds boxes in a set, with four metres of ground each. All of them draw the same small mesh:
/// encoding a draw costs the same, and a million meshes would need too much memory.
struct Movers {
    set: CasterSet<BoxCaster>,
    ids: Vec<CasterId>,
    /// Holds what each box moves by in a frame.
    velocities: Vec<Vec3>,
}

impl Movers {
    fn new(gpu: &Gpu, count: u32) -> Self {
        let half = crowd::half_side(count);
        let mesh = Mesh::standing_box(Vec3::ZERO, Vec3::splat(0.5), 0.0);
        let pipeline = render_space_pipeline(gpu);
        let vertices = gpu.buffer(&mesh.positions, wgpu::BufferUsages::VERTEX);
        let indices = gpu.buffer(&mesh.indices, wgpu::BufferUsages::INDEX);
        let mut random = Random::new(31);
        let mut velocities = Vec::new();
        let mut set = CasterSet::new();
        let ids = set.insert_all((0..count).map(|id| {
            let mut between = |low, high| random.between(low, high);
            let foot = Vec3::new(between(-half, half), 0.0, between(-half, half));
            let size = Vec3::new(between(0.3, 1.0), between(0.3, 3.0), between(0.3, 1.0));
            velocities.push(Vec3::new(between(-0.1, 0.1), 0.0, between(-0.1, 0.1)));
            BoxCaster {
                pipeline: pipeline.clone(),
                vertices: vertices.clone(),
                indices: indices.clone(),
                first_vertex: 0,
                index_count: mesh.indices.len() as u32,
                told_triangles: mesh.indices.len() as u32 / 3,
                bounds: Aabb::new(foot, foot + size),
                id: u64::from(id),
                version: Some(0),
            }
        }));
        Self {
            set,
            ids,
            velocities,
        }
    }

    /// Moves casters, the same in each frame, and updates the set. Each goes to and fro, so that
    /// the crowd stays a crowd.
    fn step(&mut self, motion: Motion, frame: u32) {
        let Motion::PerMille(share) = motion else {
            return;
        };
        let way = if (frame / 40).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        let all = self.ids.iter().zip(&self.velocities);
        for (&id, velocity) in all.step_by((1000 / share) as usize) {
            let moved = self.set.update(id, |caster| {
                caster.bounds.min += velocity * way;
                caster.bounds.max += velocity * way;
                caster.version = caster.version.map(|version| version + 1);
            });
            moved.expect("a caster of the set");
        }
    }

    /// Returns the same casters as a list.
    fn list(&self) -> Vec<&dyn ShadowCaster> {
        let members = self.ids.iter().filter_map(|id| self.set.get(*id));
        members.map(|member| member as _).collect()
    }

    /// Measures frames of a motion: with the set, and in turn with a list if there is one. `record`
    /// records a frame of the set (0) or of the list (1) and returns its passes and draw calls.
    /// Returns a row of the table.
    fn measure(
        &mut self,
        stage: &Stage<'_>,
        motion: Motion,
        with_list: bool,
        mut record: impl FnMut(usize, &mut wgpu::CommandEncoder, Casters<'_>, u32) -> (u32, u32),
    ) -> [f64; 6] {
        let mut times: [Vec<processor::Effort>; 2] = Default::default();
        let mut updates = Vec::new();
        let (mut passes, mut draws) = (0, 0);
        for frame in 0..SETTLING + stage.repeats {
            let mut counts = (0, 0);
            let effort = processor::measure(
                1,
                || stage.gpu.encoder(),
                |encoder| {
                    let start = Instant::now();
                    self.step(motion, frame);
                    updates.push(start.elapsed().as_secs_f64() * 1e6);
                    counts = record(0, encoder, Casters::Set(&self.set), frame);
                },
            );
            let list = if with_list { self.list() } else { Vec::new() };
            let list_effort = with_list.then(|| {
                let record = |encoder: &mut wgpu::CommandEncoder| {
                    record(1, encoder, Casters::List(&list), frame)
                };
                processor::measure(1, || stage.gpu.encoder(), record)
            });
            if frame >= SETTLING {
                times[0].push(effort);
                passes += counts.0;
                draws += counts.1;
                times[1].extend(list_effort);
            }
        }
        let [set, list] = times.map(|times| processor::median(&times));
        [
            set.microseconds,
            Spread::of(updates[SETTLING as usize..].iter().copied()).median,
            set.allocations,
            f64::from(passes) / f64::from(stage.repeats),
            f64::from(draws) / f64::from(stage.repeats),
            list.microseconds,
        ]
    }
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
            "passes, mean",
            "draws, mean",
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
        let mut movers = Movers::new(stage.gpu, count);
        let mut suns = [(); 2].map(|()| stage.sun(1024, 4, Filter::default()));
        // A list of a million casters takes long.
        let with_list = count <= 100_000;
        let row = movers.measure(
            stage,
            motion,
            with_list,
            |which, encoder, casters, frame| {
                let walked = if motion == Motion::Walk {
                    0.1 * frame as f32
                } else {
                    0.0
                };
                let eye = Vec3::new(walked, 2.0, 0.0);
                let camera = camera::looking(eye, eye + Vec3::new(9.0, -1.0, 5.0), 0.9);
                let cameras = [camera.with_max_distance(60.0)];
                let report = suns[which].record(encoder, &frame_of(&cameras, casters));
                (report.passes, report.draws())
            },
        );
        table.add(per_mille(motion), row);
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
        let mut movers = Movers::new(stage.gpu, CASTERS_OF_LAMPS);
        let mut lamps = [(); 2].map(|()| Lamps::new(stage.gpu, LAMPS));
        let row = movers.measure(stage, motion, true, |which, encoder, casters, _| {
            let counts = lamps[which].record(encoder, casters, half);
            (counts.passes, counts.draws)
        });
        table.add(per_mille(motion), row);
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
