//! Tests casters with the engine's own WGSL and bind groups: a leaf card with holes, and a flag
//! that moves.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use wgpu::util::DeviceExt;
use wgpu_shadows::{
    Aabb, CascadeLayout, CasterPipeline, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, Revision, ShadowCaster, ShadowView,
    caster::CasterPipelineDescriptor, caster::CasterVertex, report::ViewStatus,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::table;

/// Draws a square card one unit above the ground; its texture coordinates are x and z from 0 to 1.
const LEAF: &str = "
@group(1) @binding(0) var leaf: texture_2d<f32>;

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vertex(@location(0) position: vec3<f32>) -> Vertex {
    return Vertex(shadow_caster_clip(position), position.xz);
}

@fragment
fn fragment(vertex: Vertex) {
    let texel = vec2<u32>(vertex.uv * vec2<f32>(textureDimensions(leaf)));
    if textureLoad(leaf, texel, 0).a < 0.5 {
        discard;
    }
}
";

/// Draws the same card, displaced by wind.
const FLAG: &str = "
@group(1) @binding(0) var<uniform> wind: vec4<f32>;

@vertex
fn vertex(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return shadow_caster_clip(position + wind.xyz);
}
";

/// Is a caster as an engine writes it: buffers, one bind group, and a version that it counts
/// itself.
struct Card {
    pipeline: CasterPipeline,
    vertices: wgpu::Buffer,
    group: wgpu::BindGroup,
    bounds: Aabb,
    version: u64,
}

impl Card {
    fn new(
        gpu: &Gpu,
        source: &str,
        fragment_entry: Option<&str>,
        ty: wgpu::BindingType,
        resource: wgpu::BindingResource<'_>,
    ) -> Self {
        let layout = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("card"),
                entries: &[wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                    ty,
                    count: None,
                }],
            });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("card"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource,
            }],
        });
        let attributes = [wgpu::VertexAttribute {
            format: wgpu::VertexFormat::Float32x3,
            offset: 0,
            shader_location: 0,
        }];
        let pipeline = CasterPipeline::new(
            &gpu.device,
            &CasterPipelineDescriptor {
                vertex: CasterVertex::Wgsl {
                    source,
                    vertex_entry: "vertex",
                    fragment_entry,
                    buffers: &[Some(wgpu::VertexBufferLayout {
                        array_stride: 12,
                        step_mode: wgpu::VertexStepMode::Vertex,
                        attributes: &attributes,
                    })],
                    bind_group_layouts: &[Some(&layout)],
                },
                primitive: wgpu::PrimitiveState {
                    topology: wgpu::PrimitiveTopology::TriangleStrip,
                    ..Default::default()
                },
                ..CasterPipelineDescriptor::new()
            },
        )
        .expect("a valid pipeline");
        let corner = |x, z| Vec3::new(x, 1.0, z);
        let corners = [
            corner(0.0, 0.0),
            corner(1.0, 0.0),
            corner(0.0, 1.0),
            corner(1.0, 1.0),
        ];
        Self {
            pipeline,
            vertices: gpu.buffer(&corners, wgpu::BufferUsages::VERTEX),
            group,
            bounds: Aabb::from_points(corners),
            version: 0,
        }
    }
}

impl ShadowCaster for Card {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn pipeline(&self) -> &CasterPipeline {
        &self.pipeline
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _view: &ShadowView) {
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..4, 0..1);
    }

    fn revision(&self) -> Option<Revision> {
        Some(Revision::new(u64::MAX, self.version))
    }
}

/// Holds a sun that shines straight down on a field of five by five units.
struct Field {
    shadow: DirectionalShadow,
    probe: SunProbe,
}

impl Field {
    fn new(gpu: &Gpu) -> Self {
        let descriptor = DirectionalShadowDescriptor {
            map_size: 256,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        };
        let shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
        Self {
            probe: SunProbe::new(gpu, &shadow),
            shadow,
        }
    }

    fn draw(&mut self, gpu: &Gpu, casters: &[&dyn ShadowCaster]) -> ViewStatus {
        let frame = DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(Vec3::NEG_Y),
            coverage: Coverage::Bounds(Aabb::new(
                Vec3::new(-1.0, -0.1, -1.0),
                Vec3::new(4.0, 2.0, 4.0),
            )),
            casters,
            receivers: &[],
        };
        record(gpu, &mut self.shadow, &frame).views[0].status
    }

    /// Returns the visibilities on the ground.
    fn ask(&self, gpu: &Gpu, places: &[(f32, f32)]) -> Vec<f32> {
        let points: Vec<_> = places
            .iter()
            .map(|(x, z)| Point::new(Vec3::new(*x, 0.0, *z), Vec3::Y))
            .collect();
        self.probe.ask(gpu, &points)
    }
}

#[test]
fn a_masked_leaf_has_holes_in_its_shadow() {
    const HOLES: [[u8; 4]; 4] = [[1, 0, 1, 1], [0, 0, 1, 0], [1, 1, 1, 0], [0, 1, 0, 1]];
    let gpu = gpu();
    let texels: Vec<u8> = HOLES
        .iter()
        .flatten()
        .flat_map(|alpha| [40, 160, 30, alpha * 255])
        .collect();
    let texture = gpu.device.create_texture_with_data(
        &gpu.queue,
        &wgpu::TextureDescriptor {
            label: Some("leaf"),
            size: wgpu::Extent3d {
                width: 4,
                height: 4,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        &texels,
    );
    let leaf = Card::new(
        gpu,
        LEAF,
        Some("fragment"),
        wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        wgpu::BindingResource::TextureView(&texture.create_view(&Default::default())),
    );
    // The leaf is drawn between two solid casters, whose pipeline and buffers it must not disturb.
    let pipeline = default_pipeline(gpu);
    let solid = |x: f32| {
        let mesh = Mesh::cuboid(Vec3::new(x, 1.0, 2.0), Vec3::new(x + 1.0, 1.1, 3.0));
        mesh.caster(gpu, &pipeline, Mat4::IDENTITY)
    };
    let (before, after) = (solid(0.0), solid(2.0));
    let mut field = Field::new(gpu);
    assert_eq!(
        field.draw(gpu, &[&before, &leaf, &after]),
        ViewStatus::Drawn
    );
    let middle = |index: usize| (index as f32 + 0.5) / 4.0;
    for (row, alphas) in HOLES.iter().enumerate() {
        for (column, alpha) in alphas.iter().enumerate() {
            let seen = field.ask(gpu, &[(middle(column), middle(row))])[0];
            let wanted = f32::from(1 - alpha);
            assert!((seen - wanted).abs() < 1e-5, "{column}, {row}: {seen}");
        }
    }
    assert_eq!(field.ask(gpu, &[(0.5, 2.5), (2.5, 2.5)]), [0.0, 0.0]);
    assert!(field.ask(gpu, &[(1.5, 2.5)])[0] > 0.999);
    table::record(
        "alpha-masked casters between solid ones",
        "holes where the mask has them, solids beside as without",
        "as expected",
    );
}

#[test]
fn a_displaced_flag_moves_its_shadow() {
    let gpu = gpu();
    let wind = gpu.buffer(
        &[0.0_f32; 4],
        wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
    );
    let mut flag = Card::new(
        gpu,
        FLAG,
        None,
        wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        wind.as_entire_binding(),
    );
    // The bounds contain the flag however the wind moves it.
    flag.bounds.max += Vec3::splat(2.0);
    let mut field = Field::new(gpu);
    assert_eq!(field.draw(gpu, &[&flag]), ViewStatus::Drawn);
    let places = [(0.5, 0.5), (2.5, 1.5)];
    let near = |seen: Vec<f32>, wanted: [f32; 2]| {
        let error = seen.iter().zip(wanted).map(|(a, b)| (a - b).abs());
        assert!(
            error.fold(0.0, f32::max) < 1e-5,
            "{seen:?}, {wanted:?} expected"
        );
    };
    near(field.ask(gpu, &places), [0.0, 1.0]);
    gpu.queue
        .write_buffer(&wind, 0, bytemuck::bytes_of(&[2.0_f32, 0.5, 1.0, 0.0]));
    // The engine has not changed the version, and so the map is kept.
    assert_eq!(field.draw(gpu, &[&flag]), ViewStatus::Kept);
    near(field.ask(gpu, &places), [0.0, 1.0]);
    flag.version += 1;
    assert_eq!(field.draw(gpu, &[&flag]), ViewStatus::Drawn);
    near(field.ask(gpu, &places), [1.0, 0.0]);
}
