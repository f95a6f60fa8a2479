//! Records many frames with lights that move, change and are made again: nothing accumulates, and
//! what is dropped is freed.
//!
//! `SHADOW_LONG=1` runs ten thousand frames instead of three hundred.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use wgpu::util::DeviceExt;
use wgpu_shadows::{
    Aabb, CascadeLayout, CasterPipeline, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, MeshCaster, OmniLight, OmniShadow, OmniShadowDescriptor,
    ShadowBindings, ShadowBindingsDescriptor, ShadowCaster, SpotLight, SpotShadow,
    SpotShadowDescriptor, caster::CasterPipelineDescriptor, caster::MeshCasterDescriptor,
    caster::MeshIndices, pool::PoolDescriptor, pool::PoolLight, pool::ShadowSlot,
    pool::SpotShadowPool,
};

use super::table;
use crate::fixtures::frames::{
    Coverage, DirectionalFrame, OmniFrame, PoolFrame, RecordFrame, SpotFrame,
};
use crate::fixtures::gpu::gpu;

/// Is the number of frames after which every light is made again, in another size.
const LIFE: u32 = 25;

/// Holds an instance of its own, whose objects are counted.
struct Counted {
    instance: wgpu::Instance,
    device: wgpu::Device,
    queue: wgpu::Queue,
}

impl Counted {
    fn new() -> Self {
        let backends = wgpu::Backends::from(gpu().adapter.backend);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(backends));
        let adapter = adapters
            .iter()
            .find(|adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu)
            .or(adapters.first())
            .expect("the adapter of the run");
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))
            .expect("a second device");
        device.on_uncaptured_error(std::sync::Arc::new(|error: wgpu::Error| {
            panic!("uncaptured device error: {error}")
        }));
        Self {
            instance,
            device,
            queue,
        }
    }

    /// Returns the number of objects by kind, once the device has finished its work and freed what
    /// was dropped.
    fn objects(&self) -> [(&'static str, usize); 10] {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device finishes its work");
        let report = self.instance.generate_report().expect("a native instance");
        let hub = report.hub_report();
        [
            ("buffers", hub.buffers.num_kept_from_user),
            ("textures", hub.textures.num_kept_from_user),
            ("texture views", hub.texture_views.num_kept_from_user),
            ("samplers", hub.samplers.num_kept_from_user),
            ("bind groups", hub.bind_groups.num_kept_from_user),
            ("layouts", hub.bind_group_layouts.num_kept_from_user),
            ("shaders", hub.shader_modules.num_kept_from_user),
            ("pipelines", hub.render_pipelines.num_kept_from_user),
            ("encoders", hub.command_encoders.num_kept_from_user),
            ("command buffers", hub.command_buffers.num_kept_from_user),
        ]
    }
}

/// Holds one light of every kind, with the probes that sample them.
struct Lights {
    sun: DirectionalShadow,
    spot: SpotShadow,
    lamp: OmniShadow,
    pool: SpotShadowPool,
    slots: Vec<ShadowSlot>,
    _bindings: ShadowBindings,
}

impl Lights {
    fn new(device: &wgpu::Device, map_size: u32) -> Self {
        let sun = DirectionalShadow::new(
            device,
            &DirectionalShadowDescriptor {
                map_size,
                layout: CascadeLayout::fixed(2),
                ..Default::default()
            },
        );
        let spot = SpotShadow::new(
            device,
            &SpotShadowDescriptor {
                map_size,
                ..Default::default()
            },
        );
        let lamp = OmniShadow::new(
            device,
            &OmniShadowDescriptor {
                map_size,
                ..Default::default()
            },
        );
        let pool = SpotShadowPool::new(
            device,
            &PoolDescriptor {
                map_size,
                capacity: 3,
                ..Default::default()
            },
        );
        let (sun, spot) = (sun.expect("a sun"), spot.expect("a spot"));
        let (lamp, pool) = (lamp.expect("a lamp"), pool.expect("a pool"));
        let lights = [
            ("sun", sun.maps()),
            ("spot", spot.maps()),
            ("lamp", lamp.maps()),
            ("pool", pool.maps()),
        ];
        let bindings = ShadowBindings::new(
            device,
            &ShadowBindingsDescriptor {
                lights: &lights,
                ..Default::default()
            },
        );
        Self {
            _bindings: bindings.expect("bindings"),
            sun,
            spot,
            lamp,
            pool,
            slots: Vec::new(),
        }
    }

    fn record(&mut self, counted: &Counted, frame: u32, casters: &[&dyn ShadowCaster]) -> u32 {
        let device = &counted.device;
        let mut encoder = device.create_command_encoder(&Default::default());
        let t = f64::from(frame);
        let eye = DVec3::new((t * 0.1).sin() * 4.0, 3.0, 5.0);
        let camera = Camera::modern(eye, DVec3::ZERO, 1.0, 1.5).view();
        let place = DVec3::new((t * 0.3).sin(), 3.0 + (t * 0.2).cos(), 0.2);
        let receivers = [Aabb::new(
            Vec3::new(-6.0, -0.1, -6.0),
            Vec3::new(6.0, 0.0, 6.0),
        )];
        let direction = Vec3::new((t * 0.05).sin() as f32, -1.0, 0.3);
        let sun = DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(direction),
            coverage: Coverage::Camera(camera),
            casters,
            receivers: &receivers,
        };
        let spot_light = SpotLight {
            position_world: place,
            direction,
            outer_angle_radians: 0.8,
            range: 10.0,
        };
        let spot = SpotFrame {
            origin: DVec3::ZERO,
            light: spot_light,
            camera: Some(camera),
            casters,
            receivers: &receivers,
        };
        let lamp = OmniFrame {
            origin: DVec3::ZERO,
            light: OmniLight {
                position_world: place,
                range: 8.0,
            },
            camera: None,
            casters,
            receivers: &receivers,
        };
        // Slots are removed and inserted again, so that all three are used in turn.
        if self.slots.len() < 3 {
            self.slots.push(self.pool.insert().expect("a free slot"));
        } else {
            let oldest = self.slots.remove(0);
            self.pool.remove(oldest).expect("a slot of this pool");
        }
        let lights: Vec<_> = self
            .slots
            .iter()
            .map(|slot| PoolLight {
                slot: *slot,
                light: spot_light,
                importance: 1.0,
            })
            .collect();
        let pool = PoolFrame {
            origin: DVec3::ZERO,
            lights: &lights,
            camera: None,
            casters,
            receivers: &receivers,
            max_views: Some(2),
        };
        let mut passes = 0;
        let reports = [
            self.sun.record_frame(&mut encoder, &sun),
            self.spot.record_frame(&mut encoder, &spot),
            self.lamp.record_frame(&mut encoder, &lamp),
            self.pool.record_frame(&mut encoder, &pool),
        ];
        for report in reports {
            passes += report.expect("a frame").passes;
        }
        counted.queue.submit([encoder.finish()]);
        passes
    }
}

fn mesh_caster(device: &wgpu::Device, pipeline: &CasterPipeline, mesh: &Mesh) -> MeshCaster {
    let buffer = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage,
        })
    };
    let positions = bytemuck::cast_slice(&mesh.positions);
    let indices = bytemuck::cast_slice(&mesh.indices);
    let descriptor = MeshCasterDescriptor {
        label: None,
        pipeline,
        vertices: &buffer(positions, wgpu::BufferUsages::VERTEX),
        indices: MeshIndices::Buffer {
            buffer: buffer(indices, wgpu::BufferUsages::INDEX),
            format: wgpu::IndexFormat::Uint32,
            indices: 0..mesh.indices.len() as u32,
            base_vertex: 0,
        },
        bounds_model: mesh.bounds(),
        render_from_model: Mat4::IDENTITY,
    };
    MeshCaster::new(device, &descriptor).expect("a valid mesh")
}

/// Objects are counted at the end of each lifetime of the lights, at which all lifetimes have the
/// same: there are as many after the last as after the second (the first warms up), and after
/// everything is dropped, as many as before anything was made.
#[test]
fn nothing_piles_up_and_everything_is_freed() {
    let long = std::env::var("SHADOW_LONG").as_deref() == Ok("1");
    let frames = if long { 10_000 } else { 300 };
    let counted = Counted::new();
    let before = counted.objects();
    let mut warm = None;
    let mut passes = 0;
    {
        let pipeline =
            CasterPipeline::new(&counted.device, &CasterPipelineDescriptor::new()).expect("valid");
        let mesh = Mesh::cuboid(Vec3::new(-0.5, 0.5, -0.5), Vec3::new(0.5, 1.2, 0.5));
        let mut lights = None;
        let mut casters = Vec::new();
        for frame in 0..frames {
            let life = frame / LIFE;
            if frame % LIFE == 0 {
                lights = None;
                casters = (0..3)
                    .map(|_| mesh_caster(&counted.device, &pipeline, &mesh))
                    .collect();
            }
            let lights = lights.get_or_insert_with(|| {
                Lights::new(&counted.device, [16, 33, 64][life as usize % 3])
            });
            for (index, caster) in (0_u8..).zip(&mut casters) {
                let turn = f32::from(index) + frame as f32 * 0.1;
                let place = Vec3::new(turn.sin() * 2.0, 0.0, turn.cos() * 2.0);
                let moved = caster.set_transform(Mat4::from_translation(place));
                moved.expect("a finite matrix");
            }
            let list: Vec<&dyn ShadowCaster> = casters
                .iter()
                .map(|caster| caster as &dyn ShadowCaster)
                .collect();
            passes += lights.record(&counted, frame, &list);
            if frame % LIFE == LIFE - 1 && life >= 1 {
                let now = counted.objects();
                let warm = *warm.get_or_insert(now);
                assert_eq!(now, warm, "frame {frame} on {}", gpu().describe());
            }
        }
    }
    let warm = warm.expect("enough frames");
    let total = |objects: [(&str, usize); 10]| objects.iter().map(|(_, n)| n).sum::<usize>();
    assert!(
        total(warm) > total(before) + 10,
        "nothing was counted: {warm:?}"
    );
    assert!(passes > 5 * frames, "{passes} passes");
    assert_eq!(counted.objects(), before, "after everything is dropped");
    table::record(
        "300 frames (10 000 with SHADOW_LONG=1) of lights made anew every 25",
        "as many device objects after the last as after the second life, none after all is dropped",
        format!(
            "{} objects throughout {frames} frames, {} at the end",
            total(warm),
            total(before)
        ),
    );
}
