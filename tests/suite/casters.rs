//! Tests the built-in vertex stage: every position format, both model transforms, strips, and which
//! faces are left out of the map.

use glam::{DVec3, Mat4, Quat, Vec3, Vec4};
use shadow_support::mesh::Mesh;
use shadow_support::readback;
use wgpu::{BufferUsages, VertexFormat};
use wgpu_shadows::{
    Aabb, CascadeLayout, CasterPipeline, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, MeshCaster, ShadowCaster, ShadowView,
    caster::CasterPipelineDescriptor, caster::CasterVertex, caster::MeshCasterDescriptor,
    caster::MeshIndices, caster::ModelTransform, caster::PositionAttribute,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::{Gpu, gpu, vulkan};
use crate::fixtures::probe::record;
use crate::fixtures::slabs::assert_same;

const MAP_SIZE: u32 = 64;

/// Wraps a caster so that its bounds are the unit cube, and all such casters are fitted alike.
struct InCube<'a>(&'a dyn ShadowCaster);

impl ShadowCaster for InCube<'_> {
    fn bounds(&self) -> Aabb {
        Aabb::new(Vec3::ZERO, Vec3::ONE)
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.0.pipeline()
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
        self.0.draw(pass, view);
    }
}

/// Returns the map of `caster` alone under light along -z, in which the unit cube fills the middle.
fn depths(gpu: &Gpu, caster: &dyn ShadowCaster) -> Vec<f32> {
    let descriptor = DirectionalShadowDescriptor {
        map_size: MAP_SIZE,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::NEG_Z),
        coverage: Coverage::Bounds(Aabb::new(Vec3::splat(-0.5), Vec3::splat(1.5))),
        casters: &[&InCube(caster)],
        receivers: &[],
    };
    assert_eq!(record(gpu, &mut shadow, &frame).draws(), 1);
    readback::depth_layer(gpu, shadow.maps().texture(), 0)
}

fn drawn(depths: &[f32]) -> usize {
    depths.iter().filter(|depth| **depth > 0.0).count()
}

fn pipeline(gpu: &Gpu, descriptor: &CasterPipelineDescriptor<'_>) -> CasterPipeline {
    CasterPipeline::new(&gpu.device, descriptor).expect("a valid pipeline")
}

fn built_in(
    position: PositionAttribute,
    model: ModelTransform,
) -> CasterPipelineDescriptor<'static> {
    CasterPipelineDescriptor {
        vertex: CasterVertex::BuiltIn { position, model },
        ..CasterPipelineDescriptor::new()
    }
}

/// Returns a caster of three vertices or more, which are drawn in order.
fn unindexed(
    gpu: &Gpu,
    pipeline: &CasterPipeline,
    vertices: &[u8],
    count: u32,
    render_from_model: Mat4,
) -> MeshCaster {
    MeshCaster::new(
        &gpu.device,
        &MeshCasterDescriptor {
            label: None,
            pipeline,
            vertices: &gpu.buffer(vertices, BufferUsages::VERTEX),
            indices: MeshIndices::None { vertices: 0..count },
            bounds_model: Aabb::new(Vec3::ZERO, Vec3::ONE),
            render_from_model,
        },
    )
    .expect("a valid mesh")
}

/// Returns the bytes of a component that is 0 or 1.
fn component(format: VertexFormat, one: bool) -> Vec<u8> {
    use VertexFormat as F;
    let bits = |bits: u32, bytes: usize| {
        if one {
            bits.to_le_bytes()[..bytes].to_vec()
        } else {
            vec![0; bytes]
        }
    };
    match format {
        F::Float32x2 | F::Float32x3 | F::Float32x4 => bits(1.0_f32.to_bits(), 4),
        F::Float16x2 | F::Float16x4 => bits(0x3c00, 2),
        F::Snorm8x2 | F::Snorm8x4 => bits(0x7f, 1),
        F::Unorm8x2 | F::Unorm8x4 => bits(0xff, 1),
        F::Snorm16x2 | F::Snorm16x4 => bits(0x7fff, 2),
        F::Unorm16x2 | F::Unorm16x4 => bits(0xffff, 2),
        other => panic!("{other:?} has no bytes per component"),
    }
}

/// Returns a corner of the unit cube in `format`. A fourth component is 0: it must be ignored.
fn encoded(format: VertexFormat, corner: [bool; 3]) -> Vec<u8> {
    if format == VertexFormat::Unorm10_10_10_2 {
        let part = |axis: usize| (u32::from(corner[axis]) * 1023) << (10 * axis);
        return (part(0) | part(1) | part(2)).to_le_bytes().to_vec();
    }
    let size = component(format, true).len();
    let components = format.size() as usize / size;
    let padded = [corner[0], corner[1], corner[2], false];
    padded[..components]
        .iter()
        .flat_map(|one| component(format, *one))
        .collect()
}

/// Two triangles that touch all of the formats' extremes have the same depths for each format, bit
/// for bit.
#[test]
fn every_position_format_draws_the_same() {
    use VertexFormat as F;
    let gpu = gpu();
    let corners = [
        [false, false, true],
        [true, false, false],
        [false, true, false],
        [true, true, true],
        [false, true, false],
        [true, false, false],
    ];
    let map_of = |format: VertexFormat, corners: &[[bool; 3]]| {
        let position = PositionAttribute {
            array_stride: 4 + format.size().next_multiple_of(4) + 8,
            offset: 4,
            format,
        };
        let mut bytes = Vec::new();
        for corner in corners {
            let end = bytes.len() + position.array_stride as usize;
            bytes.extend([0xff; 4]);
            bytes.extend(encoded(format, *corner));
            bytes.resize(end, 0xff);
        }
        let pipeline = pipeline(gpu, &built_in(position, ModelTransform::Identity));
        let caster = unindexed(gpu, &pipeline, &bytes, corners.len() as u32, Mat4::IDENTITY);
        depths(gpu, &caster)
    };
    let solid = map_of(F::Float32x3, &corners);
    let levelled = corners.map(|[x, y, _]| [x, y, false]);
    let level = map_of(F::Float32x3, &levelled);
    assert!(drawn(&solid) > 200 && solid != level, "{}", drawn(&solid));
    let with_z = [
        F::Float32x4,
        F::Float16x4,
        F::Snorm8x4,
        F::Snorm16x4,
        F::Unorm8x4,
        F::Unorm16x4,
        F::Unorm10_10_10_2,
    ];
    for format in with_z {
        assert_same(&map_of(format, &corners), &solid, &format!("{format:?}"));
    }
    // Without a third component, z is 0.
    let without_z = [
        F::Float32x2,
        F::Float16x2,
        F::Snorm8x2,
        F::Snorm16x2,
        F::Unorm8x2,
        F::Unorm16x2,
    ];
    for format in without_z {
        assert_same(&map_of(format, &corners), &level, &format!("{format:?}"));
    }
}

fn vertex_bytes(positions: &[Vec3]) -> Vec<u8> {
    bytemuck::cast_slice(positions).to_vec()
}

/// A matrix of halves and whole numbers gives the same bits in the shader as on the CPU, wherever
/// it lies in its buffer.
#[test]
fn an_instance_matrix_moves_what_identity_leaves() {
    let gpu = gpu();
    let triangle = [
        Vec3::ZERO,
        Vec3::new(1.0, 0.0, 0.25),
        Vec3::new(0.0, 1.0, 0.75),
    ];
    let matrix = Mat4::from_cols(
        Vec4::new(0.5, 0.0, 0.25, 0.0),
        Vec4::new(0.25, 0.5, 0.0, 0.0),
        Vec4::new(0.0, 0.0, -0.5, 0.0),
        Vec4::new(0.25, 0.0, 0.5, 1.0),
    );
    let still = pipeline(
        gpu,
        &built_in(PositionAttribute::float32x3(12), ModelTransform::Identity),
    );
    let moved = triangle.map(|corner| matrix.transform_point3(corner));
    let wanted = depths(
        gpu,
        &unindexed(gpu, &still, &vertex_bytes(&moved), 3, Mat4::IDENTITY),
    );
    let unmoved = depths(
        gpu,
        &unindexed(gpu, &still, &vertex_bytes(&triangle), 3, matrix),
    );
    assert!(drawn(&wanted) > 50 && wanted != unmoved);
    let models = [
        ModelTransform::INSTANCE_MATRIX,
        ModelTransform::InstanceMatrix {
            array_stride: 96,
            offset: 20,
        },
    ];
    for model in models {
        let pipeline = pipeline(gpu, &built_in(PositionAttribute::float32x3(12), model));
        let mut caster = unindexed(gpu, &pipeline, &vertex_bytes(&triangle), 3, matrix);
        assert_same(&depths(gpu, &caster), &wanted, &format!("{model:?}"));
        caster
            .set_transform(Mat4::IDENTITY)
            .expect("a finite matrix");
        assert_same(&depths(gpu, &caster), &unmoved, &format!("{model:?}"));
    }
}

/// Two level quads as one strip with a restart between them give the same depths as the same
/// triangles as a list. (wgpu's OpenGL backend does not restart strips.)
#[test]
fn strips_restart() {
    let gpu = vulkan();
    let quad = |x: f32, z: f32| {
        [(0.0, 0.0), (0.3, 0.0), (0.0, 1.0), (0.3, 1.0)].map(|(dx, y)| Vec3::new(x + dx, y, z))
    };
    let corners = [quad(0.0, 0.25), quad(0.6, 0.75)].concat();
    let vertices = gpu.buffer(&vertex_bytes(&corners), BufferUsages::VERTEX);
    let draw = |pipeline: &CasterPipeline, indices: &[u16]| {
        let mut padded = indices.to_vec();
        padded.resize(indices.len().next_multiple_of(2), 0);
        let caster = MeshCaster::new(
            &gpu.device,
            &MeshCasterDescriptor {
                label: None,
                pipeline,
                vertices: &vertices,
                indices: MeshIndices::Buffer {
                    buffer: gpu.buffer(&padded, BufferUsages::INDEX),
                    format: wgpu::IndexFormat::Uint16,
                    indices: 0..indices.len() as u32,
                    base_vertex: 0,
                },
                bounds_model: Aabb::new(Vec3::ZERO, Vec3::ONE),
                render_from_model: Mat4::IDENTITY,
            },
        );
        depths(gpu, &caster.expect("a valid mesh"))
    };
    let list = pipeline(gpu, &CasterPipelineDescriptor::new());
    let strip = pipeline(
        gpu,
        &CasterPipelineDescriptor {
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                strip_index_format: Some(wgpu::IndexFormat::Uint16),
                ..Default::default()
            },
            ..CasterPipelineDescriptor::new()
        },
    );
    let wanted = draw(&list, &[0, 1, 2, 1, 3, 2, 4, 5, 6, 5, 7, 6]);
    assert!(drawn(&wanted) > 200);
    let restarted = draw(&strip, &[0, 1, 2, 3, u16::MAX, 4, 5, 6, 7]);
    assert_same(&restarted, &wanted, "restarted");
    // Without the restart, a bridge between the quads is drawn as well.
    assert!(drawn(&draw(&strip, &[0, 1, 2, 3, 4, 5, 6, 7])) > drawn(&wanted) + 50);
}

/// Returns the height along z of what the middle of the map contains, for a box from 0.25 to 0.75.
fn middle_height(gpu: &Gpu, caster: &dyn ShadowCaster) -> f32 {
    let depths = depths(gpu, caster);
    // Depth is linear in height; two known sheets calibrate it.
    let sheet = |z: f32| {
        let sheet = Mesh::sheet(Vec3::new(0.0, 0.0, z), Vec3::X, Vec3::Y);
        let list = pipeline(gpu, &CasterPipelineDescriptor::new());
        self::depths(gpu, &sheet.caster(gpu, &list, Mat4::IDENTITY))[middle()]
    };
    let (low, high) = (sheet(0.25), sheet(0.75));
    0.25 + 0.5 * (depths[middle()] - low) / (high - low)
}

fn middle() -> usize {
    (MAP_SIZE / 2 * MAP_SIZE + MAP_SIZE / 2) as usize
}

/// The light sees the upper face first; without front faces, the map contains the lower one. A
/// transform that mirrors changes neither, whether the mesh was created with it or received it
/// later.
#[test]
fn culling_takes_the_faces_it_names() {
    use wgpu::{Face, FrontFace};
    let gpu = gpu();
    let cube = Mesh::cuboid(Vec3::new(-0.5, -0.5, -0.25), Vec3::new(0.5, 0.5, 0.25));
    let place = Mat4::from_translation(Vec3::splat(0.5));
    let turned = place * Mat4::from_quat(Quat::from_rotation_z(1.0));
    let mirrors = [
        Vec3::new(-1.0, 1.0, 1.0),
        Vec3::new(1.0, 1.0, -1.0),
        Vec3::NEG_ONE,
    ];
    let (upper, lower) = (0.75, 0.25);
    let cases = [
        (None, FrontFace::Ccw, upper),
        (Some(Face::Back), FrontFace::Ccw, upper),
        (Some(Face::Front), FrontFace::Ccw, lower),
        (None, FrontFace::Cw, upper),
        (Some(Face::Back), FrontFace::Cw, lower),
        (Some(Face::Front), FrontFace::Cw, upper),
    ];
    for (cull, front_face, height) in cases {
        let descriptor = CasterPipelineDescriptor {
            primitive: wgpu::PrimitiveState {
                cull_mode: cull,
                front_face,
                ..Default::default()
            },
            ..CasterPipelineDescriptor::new()
        };
        let pipeline = pipeline(gpu, &descriptor);
        let assert_height = |caster: &MeshCaster, what: &str| {
            let found = middle_height(gpu, caster);
            // The tolerance is a few ulps of 2^-24, for depths of about a half over a range of two
            // units.
            let error = (found - height).abs();
            assert!(error < 1e-5, "{cull:?} {front_face:?} {what}: {found}");
        };
        let mut moving = cube.caster(gpu, &pipeline, turned);
        assert_height(&moving, "as it is");
        for mirror in mirrors {
            let mirrored = turned * Mat4::from_scale(mirror);
            assert_height(&cube.caster(gpu, &pipeline, mirrored), "made mirrored");
            moving.set_transform(mirrored).expect("a finite matrix");
            assert_height(&moving, "become mirrored");
            moving.set_transform(turned).expect("a finite matrix");
            assert_height(&moving, "back again");
        }
    }
}

/// The tests' own meshes face outward, so that what the tests find about culling holds for closed
/// solids.
#[test]
fn generated_solids_face_outward() {
    let center = Vec3::new(0.5, 2.0, -1.0);
    let half = Vec3::new(1.0, 2.0, 3.0);
    let solids = [
        Mesh::cuboid(center - half, center + half),
        Mesh::sphere(center, 1.5, 6),
    ];
    for solid in solids {
        for triangle in solid.triangles(&Mat4::IDENTITY) {
            let [a, b, c] = triangle.0;
            let outward = (a + b + c) / 3.0 - center.as_dvec3();
            assert!(triangle.normal().dot(outward) > 0.0, "{triangle:?}");
        }
    }
    let floor = Mesh::floor(0.0, 1.0).triangles(&Mat4::IDENTITY);
    assert!(floor.iter().all(|triangle| triangle.normal().y > 0.999));
}
