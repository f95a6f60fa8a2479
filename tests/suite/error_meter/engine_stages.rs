//! Tests casters that exist only in the engine's own stages: displaced by the vertex stage, and
//! with holes that the fragment stage discards.

use glam::{DVec3, Vec3};
use shadow_support::random::Random;
use wgpu_shadows::meter::Receiver;
use wgpu_shadows::{
    Aabb, CasterPipeline, Coverage, DirectionalShadowDescriptor, OmniLight, OmniShadow,
    OmniShadowDescriptor, ShadowCaster, ShadowView, caster::CasterPipelineDescriptor,
    caster::CasterVertex,
};

use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::meter::{Metered, View};

/// Is the height to which the vertex stage lifts a sheet that lies on the ground.
const HEIGHT: f64 = 2.0;

/// Is the side of the sheet's squares, of which every other is a hole.
const SQUARE: f64 = 0.25;

/// Draws a sheet with holes, lifted from the ground.
const STAGES: &str = "
struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) place: vec2<f32>,
}

@vertex
fn vertex(@location(0) position: vec3<f32>) -> Vertex {
    let lifted = position + vec3<f32>(0.0, 2.0, 0.0);
    return Vertex(shadow_caster_clip(lifted), position.xz);
}

@fragment
fn fragment(vertex: Vertex) {
    let square = vec2<i32>(floor(vertex.place * 4.0));
    if ((square.x + square.y) & 1) == 0 {
        discard;
    }
}
";

struct Sheet {
    pipeline: CasterPipeline,
    vertices: wgpu::Buffer,
}

impl Sheet {
    fn new(gpu: &Gpu) -> Self {
        let attributes = [wgpu::VertexAttribute {
            format: wgpu::VertexFormat::Float32x3,
            offset: 0,
            shader_location: 0,
        }];
        let descriptor = CasterPipelineDescriptor {
            vertex: CasterVertex::Wgsl {
                source: STAGES,
                vertex_entry: "vertex",
                fragment_entry: Some("fragment"),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: 12,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &attributes,
                })],
                bind_group_layouts: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                ..Default::default()
            },
            ..CasterPipelineDescriptor::new()
        };
        let corners = [[-3.0, -3.0], [3.0, -3.0], [-3.0, 3.0], [3.0, 3.0]];
        let corners = corners.map(|[x, z]: [f32; 2]| Vec3::new(x, 0.0, z));
        Self {
            pipeline: CasterPipeline::new(&gpu.device, &descriptor).expect("a valid pipeline"),
            vertices: gpu.buffer(&corners, wgpu::BufferUsages::VERTEX),
        }
    }
}

impl ShadowCaster for Sheet {
    fn bounds(&self) -> Aabb {
        Aabb::new(Vec3::new(-3.0, 2.0, -3.0), Vec3::new(3.0, 2.0, 3.0))
    }

    fn pipeline(&self) -> &CasterPipeline {
        &self.pipeline
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _view: &ShadowView) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..4, 0..1);
    }
}

/// Returns whether the sheet is solid where the ray from the ground at `place` along `toward` meets
/// it; `None` within `blind` of the edge of a square.
fn is_solid(place: DVec3, toward: DVec3, blind: f64) -> Option<bool> {
    let on_sheet = place + toward * ((HEIGHT - place.y) / toward.y);
    let in_squares = [on_sheet.x / SQUARE, on_sheet.z / SQUARE];
    let near_edge = in_squares.map(|at| (at - at.round()).abs() * SQUARE < blind);
    let square = in_squares.map(|at| at.floor() as i64);
    let outside = on_sheet.x.abs().max(on_sheet.z.abs()) > 3.0;
    (!near_edge.contains(&true)).then(|| !outside && (square[0] + square[1]) % 2 != 0)
}

#[test]
fn masked_and_displaced_casters_are_measured_as_the_engine_draws_them() {
    let gpu = gpu();
    let sheet = Sheet::new(gpu);
    let mut random = Random::new(29);
    let receivers: Vec<_> = (0..4096)
        .map(|_| Receiver {
            position_render: Vec3::new(random.between(-3.5, 3.5), 0.0, random.between(-3.5, 3.5)),
            normal: Vec3::Y,
        })
        .collect();
    let direction = DVec3::new(0.3, -1.0, 0.2);
    let lamp = OmniLight {
        position_world: DVec3::new(0.4, 5.0, -0.3),
        range: 50.0,
    };
    let omni = OmniShadow::new(&gpu.device, &OmniShadowDescriptor::default()).expect("a lamp");
    let lights = [
        Metered::sun(gpu, direction, &DirectionalShadowDescriptor::default()),
        Metered::Omni(Box::new(omni), lamp),
    ];
    for mut light in lights {
        let mut meter = light.meter(4096);
        let list: [&dyn ShadowCaster; 1] = [&sheet];
        let view = View {
            origin: DVec3::ZERO,
            coverage: Coverage::Bounds(Aabb::new(Vec3::splat(-4.0), Vec3::splat(4.0))),
            casters: &list,
            all_casters: &list,
        };
        let report = light
            .measure(gpu, &mut meter, &view, &receivers)
            .expect("a frame");
        meter.measured();
        let (mut solid, mut holes, mut unsettled) = (0, 0, 0);
        for place in meter.last_places() {
            let toward = match light {
                Metered::Omni(..) => lamp.position_world - place.position_world,
                _ => -direction,
            };
            match is_solid(
                place.position_world,
                toward,
                report.largest_blind_height_world,
            ) {
                None => unsettled += 1,
                Some(is_solid) => {
                    let by_rays = place.visibility_by_rays;
                    assert_eq!(by_rays == 0.0, is_solid, "{place:?}");
                    *if is_solid { &mut solid } else { &mut holes } += 1;
                }
            }
        }
        assert!(
            solid > 1000 && holes > 1000 && unsettled < 20,
            "{solid} {holes} {unsettled}"
        );
    }
}
