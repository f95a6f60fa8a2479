//! Samples a technique for the visibility at each pixel, and measures how long that takes.

use std::collections::HashMap;
use std::time::Instant;

use glam::{DVec3, Vec3};
use wgpu_shadows::ShadowError;

use super::gpu::Gpu;
use super::technique::{Technique, asked_position};

/// Holds the pixels of a scene on the device, and a buffer for the results.
pub struct Questions {
    count: u32,
    answers: wgpu::Buffer,
    in_render_space: wgpu::BindGroup,
    in_world_space: wgpu::BindGroup,
}

/// Mirrors `Point` in the shader.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Point {
    position: Vec3,
    pad_position: f32,
    normal: Vec3,
    pad_normal: f32,
}

/// Holds seconds on the device's own clock, or on the wall's where the device has none. Only ratios of these are
/// meaningful.
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
    questions_layout: wgpu::BindGroupLayout,
    pipelines: HashMap<String, wgpu::ComputePipeline>,
    clock: Option<Clock>,
}

struct Clock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
}

const MARKS: u32 = 3;

impl<'a> Prober<'a> {
    pub fn new(gpu: &'a Gpu) -> Self {
        let storage = |binding, read_only| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = wgpu::BindGroupLayoutDescriptor {
            label: Some("questions"),
            entries: &[storage(0, true), storage(1, false)],
        };
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
            questions_layout: gpu.device.create_bind_group_layout(&layout),
            pipelines: HashMap::new(),
            clock,
        }
    }

    pub fn gpu(&self) -> &'a Gpu {
        self.gpu
    }

    /// Uploads points (position and normal in a render space that begins at `origin`) to the device.
    pub fn questions(&self, places: &[(DVec3, DVec3)], origin: DVec3) -> Questions {
        let answers = self.gpu.empty_buffer(
            4 * places.len() as u64,
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        );
        let group = |in_world: bool| {
            let points: Vec<Point> = places
                .iter()
                .map(|&(position, normal)| Point {
                    position: asked_position(position, origin, in_world),
                    pad_position: 0.0,
                    normal: normal.as_vec3(),
                    pad_normal: 0.0,
                })
                .collect();
            let points = self.gpu.buffer(&points, wgpu::BufferUsages::STORAGE);
            self.gpu
                .device
                .create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some("questions"),
                    layout: &self.questions_layout,
                    entries: &[
                        wgpu::BindGroupEntry {
                            binding: 0,
                            resource: points.as_entire_binding(),
                        },
                        wgpu::BindGroupEntry {
                            binding: 1,
                            resource: answers.as_entire_binding(),
                        },
                    ],
                })
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
        let pipeline = self.pipeline(technique);
        let gpu = self.gpu;
        let Some(clock) = &self.clock else {
            let mut encoder = gpu.encoder();
            technique.record(gpu, &mut encoder)?;
            let maps = seconds(|| gpu.submit(encoder));
            let mut encoder = gpu.encoder();
            look_up(&mut encoder, &pipeline, technique, questions);
            let lookups = seconds(|| gpu.submit(encoder));
            return Ok(Times { maps, lookups });
        };
        let mut encoder = gpu.encoder();
        encoder.write_timestamp(&clock.queries, 0);
        technique.record(gpu, &mut encoder)?;
        encoder.write_timestamp(&clock.queries, 1);
        look_up(&mut encoder, &pipeline, technique, questions);
        encoder.write_timestamp(&clock.queries, 2);
        encoder.resolve_query_set(&clock.queries, 0..MARKS, &clock.resolved, 0);
        gpu.submit(encoder);
        let ticks: Vec<u64> = gpu.read(&clock.resolved);
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
        self.gpu.read(&questions.answers)
    }

    /// Returns the pipeline for a technique's WGSL; equal texts have equal layouts.
    fn pipeline(&mut self, technique: &dyn Technique) -> wgpu::ComputePipeline {
        let lookup = technique.lookup();
        if let Some(pipeline) = self.pipelines.get(lookup.wgsl) {
            return pipeline.clone();
        }
        let device = &self.gpu.device;
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("lookup"),
            bind_group_layouts: &[Some(&self.questions_layout), Some(lookup.layout)],
            immediate_size: 0,
        });
        let source = [lookup.wgsl, include_str!("probe.wgsl")].concat();
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("lookup"),
            layout: Some(&layout),
            module: &self.gpu.shader(&source),
            entry_point: Some("ask"),
            compilation_options: Default::default(),
            cache: None,
        });
        self.pipelines
            .insert(lookup.wgsl.to_owned(), pipeline.clone());
        pipeline
    }
}

fn look_up(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::ComputePipeline,
    technique: &dyn Technique,
    questions: &Questions,
) {
    let group_0 = if technique.takes_world_positions() {
        &questions.in_world_space
    } else {
        &questions.in_render_space
    };
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group_0, &[]);
    pass.set_bind_group(1, technique.lookup().bind_group, &[]);
    pass.dispatch_workgroups(questions.count.div_ceil(64), 1, 1);
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}
