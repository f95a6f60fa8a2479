//! Samples a technique for the visibility at each pixel, and measures how long that takes.

use std::collections::HashMap;
use std::time::Instant;

use glam::DVec3;
use wgpu_shadows::ShadowError;

use crate::gpu::Gpu;
use crate::probe::{Point, PointShader, points_group, points_layout};
use crate::readback;
use crate::technique::{Technique, asked_position};

/// Holds the pixels of a scene on the device, and a buffer for the results.
pub struct Questions {
    count: u32,
    answers: wgpu::Buffer,
    in_render_space: wgpu::BindGroup,
    in_world_space: wgpu::BindGroup,
}

/// Holds seconds on the device's own clock, or on the wall's where the device has none. Only ratios
/// of these are meaningful.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    pub maps: f64,
    pub lookups: f64,
}

impl Times {
    pub fn total(&self) -> f64 {
        self.maps + self.lookups
    }
}

/// Holds compute pipelines that replace an engine's shading pass.
pub struct Prober<'a> {
    gpu: &'a Gpu,
    points_layout: wgpu::BindGroupLayout,
    shaders: HashMap<String, PointShader>,
    clock: Option<Clock>,
}

struct Clock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
}

const MARKS: u32 = 3;

impl<'a> Prober<'a> {
    pub fn new(gpu: &'a Gpu) -> Self {
        let clock = gpu.has_timestamps.then(|| Clock {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("times"),
                ty: wgpu::QueryType::Timestamp,
                count: MARKS,
            }),
            resolved: gpu.empty_buffer(
                8 * u64::from(MARKS),
                wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            ),
        });
        Self {
            gpu,
            points_layout: points_layout(gpu),
            shaders: HashMap::new(),
            clock,
        }
    }

    pub fn gpu(&self) -> &'a Gpu {
        self.gpu
    }

    /// Uploads points (position and normal in a render space that begins at `origin`) to the
    /// device.
    pub fn questions(&self, places: &[(DVec3, DVec3)], origin: DVec3) -> Questions {
        let answers = readback::storage(self.gpu, 4 * places.len() as u64);
        let group = |in_world: bool| {
            let point = |&(position, normal): &(DVec3, DVec3)| {
                let position = asked_position(position, origin, in_world);
                Point::new(position, normal.as_vec3())
            };
            let points: Vec<Point> = places.iter().map(point).collect();
            points_group(self.gpu, &self.points_layout, &points, &answers)
        };
        Questions {
            count: places.len() as u32,
            in_render_space: group(false),
            in_world_space: group(true),
            answers,
        }
    }

    /// Fills the maps and samples every pixel.
    pub fn run(
        &mut self,
        technique: &mut dyn Technique,
        questions: &Questions,
    ) -> Result<Times, ShadowError> {
        let shader = self.shader(technique);
        let gpu = self.gpu;
        let Some(clock) = &self.clock else {
            let mut encoder = gpu.encoder();
            technique.record(gpu, &mut encoder)?;
            let maps = seconds(|| gpu.submit(encoder));
            let mut encoder = gpu.encoder();
            look_up(&mut encoder, &shader, technique, questions);
            let lookups = seconds(|| gpu.submit(encoder));
            return Ok(Times { maps, lookups });
        };
        let mut encoder = gpu.encoder();
        encoder.write_timestamp(&clock.queries, 0);
        technique.record(gpu, &mut encoder)?;
        encoder.write_timestamp(&clock.queries, 1);
        look_up(&mut encoder, &shader, technique, questions);
        encoder.write_timestamp(&clock.queries, 2);
        encoder.resolve_query_set(&clock.queries, 0..MARKS, &clock.resolved, 0);
        gpu.submit(encoder);
        let ticks: Vec<u64> = readback::buffer(gpu, &clock.resolved);
        let period = f64::from(gpu.queue.get_timestamp_period()) * 1e-9;
        let between =
            |from: usize, to: usize| ticks[to].saturating_sub(ticks[from]) as f64 * period;
        Ok(Times {
            maps: between(0, 1),
            lookups: between(1, 2),
        })
    }

    /// Returns the results of the last run.
    pub fn answers(&self, questions: &Questions) -> Vec<f32> {
        readback::buffer(self.gpu, &questions.answers)
    }

    /// Returns the shader for a technique's WGSL; equal texts have equal layouts.
    fn shader(&mut self, technique: &dyn Technique) -> PointShader {
        let lookup = technique.lookup();
        if let Some(shader) = self.shaders.get(lookup.wgsl) {
            return shader.clone();
        }
        let value = "shadow_light(point.position, point.normal)";
        let shader = PointShader::new(self.gpu, lookup.wgsl, "f32", value, lookup.layout);
        self.shaders.insert(lookup.wgsl.to_owned(), shader.clone());
        shader
    }
}

fn look_up(
    encoder: &mut wgpu::CommandEncoder,
    shader: &PointShader,
    technique: &dyn Technique,
    questions: &Questions,
) {
    let group_0 = if technique.takes_world_positions() {
        &questions.in_world_space
    } else {
        &questions.in_render_space
    };
    let group_1 = technique.lookup().bind_group;
    shader.record(encoder, group_0, group_1, questions.count);
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}
