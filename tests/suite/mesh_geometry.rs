//! Tests that `MeshCaster::set_geometry` takes other buffers and ranges, that maps are drawn again
//! for them, and that what it refuses changes nothing.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::readback;
use wgpu_shadows::{
    Aabb, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    ShadowCaster, caster::MeshIndices, error::CasterError, report::ViewStatus,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::{gpu, two_gpus};
use crate::fixtures::probe::record;
use crate::fixtures::scene::default_pipeline;
use shadow_support::gpu::Gpu;

/// Records a frame with one caster and returns what became of its view.
fn status(gpu: &Gpu, shadow: &mut DirectionalShadow, caster: &dyn ShadowCaster) -> ViewStatus {
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::new(0.5, -1.0, 0.25)),
        coverage: Coverage::Bounds(Aabb::new(Vec3::splat(-4.0), Vec3::splat(4.0))),
        casters: &[caster],
        receivers: &[],
    };
    record(gpu, shadow, &frame).views[0].status
}

fn sun(gpu: &Gpu) -> DirectionalShadow {
    let descriptor = DirectionalShadowDescriptor {
        map_size: 64,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun")
}

fn depths(gpu: &Gpu, shadow: &DirectionalShadow) -> Vec<f32> {
    readback::depth_layer(gpu, shadow.maps().texture(), 0)
}

fn through(gpu: &Gpu, numbers: &[u32], base_vertex: i32) -> MeshIndices {
    let first = numbers.len() as u32 - 36;
    MeshIndices::Buffer {
        buffer: gpu.buffer(numbers, wgpu::BufferUsages::INDEX),
        format: wgpu::IndexFormat::Uint32,
        indices: first..first + 36,
        base_vertex,
    }
}

/// Checks that the engine may move a mesh to larger buffers, where it lies behind another one, and
/// then to vertices without indices.
#[test]
fn other_buffers_and_ranges_are_drawn() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let small = Mesh::cuboid(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(0.0, 1.0, 0.5));
    let large = Mesh::cuboid(Vec3::new(-2.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.5));
    let mut caster = small.caster(gpu, &pipeline, Mat4::IDENTITY);
    let mut shadow = sun(gpu);
    assert_eq!(status(gpu, &mut shadow, &caster), ViewStatus::Drawn);
    let first = depths(gpu, &shadow);
    assert_eq!(status(gpu, &mut shadow, &caster), ViewStatus::Kept);

    let mut wanted = sun(gpu);
    status(
        gpu,
        &mut wanted,
        &large.caster(gpu, &pipeline, Mat4::IDENTITY),
    );
    let wanted = depths(gpu, &wanted);
    assert!(first != wanted);

    let positions = [small.positions.clone(), large.positions.clone()].concat();
    let vertices = gpu.buffer(&positions, wgpu::BufferUsages::VERTEX);
    let numbers = [small.indices.clone(), large.indices.clone()].concat();
    let indices = through(gpu, &numbers, small.positions.len() as i32);
    caster
        .set_geometry(&vertices, indices, large.bounds())
        .expect("valid buffers");
    assert_eq!(caster.bounds(), large.bounds());
    assert_eq!(status(gpu, &mut shadow, &caster), ViewStatus::Drawn);
    assert!(depths(gpu, &shadow) == wanted);
    assert_eq!(status(gpu, &mut shadow, &caster), ViewStatus::Kept);

    let corners = small.indices.iter();
    let corners: Vec<_> = corners
        .map(|&corner| small.positions[corner as usize])
        .collect();
    let vertices = gpu.buffer(&corners, wgpu::BufferUsages::VERTEX);
    let all = MeshIndices::None { vertices: 0..36 };
    caster
        .set_geometry(&vertices, all, small.bounds())
        .expect("valid buffers");
    assert_eq!(caster.triangles(), 12);
    // The depth range that the large mesh needed would be kept for some time.
    shadow.reset_history();
    assert_eq!(status(gpu, &mut shadow, &caster), ViewStatus::Drawn);
    assert!(depths(gpu, &shadow) == first);
}

/// Checks that each refusal names its field, and that bounds, revision and map stay.
#[test]
fn what_cannot_be_drawn_is_refused() {
    use wgpu::BufferUsages as U;
    let [gpu, other] = &two_gpus();
    let pipeline = default_pipeline(gpu);
    let mesh = Mesh::cuboid(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(0.0, 1.0, 0.5));
    let mut caster = mesh.caster(gpu, &pipeline, Mat4::IDENTITY);
    let before = (caster.bounds(), caster.revision());
    let mut shadow = sun(gpu);
    status(gpu, &mut shadow, &caster);
    let vertices = gpu.buffer(&mesh.positions, U::VERTEX);
    let indices = || through(gpu, &mesh.indices, 0);
    let endless = Aabb::new(Vec3::ZERO, Vec3::INFINITY);
    let none = |vertices| MeshIndices::None { vertices };
    let bounds = mesh.bounds();
    let cases = [
        (gpu.buffer(&mesh.positions, U::STORAGE), indices(), bounds),
        (vertices.clone(), none(0..9), bounds),
        (vertices.clone(), none(3..3), bounds),
        (other.buffer(&mesh.positions, U::VERTEX), indices(), bounds),
        (vertices.clone(), through(other, &mesh.indices, 0), bounds),
        (vertices.clone(), indices(), endless),
    ];
    let refused = cases.map(|(vertices, indices, bounds)| {
        let refused = caster.set_geometry(&vertices, indices, bounds);
        assert_eq!((caster.bounds(), caster.revision()), before, "{refused:?}");
        assert_eq!(status(gpu, &mut shadow, &caster), ViewStatus::Kept);
        refused.expect_err("an invalid mesh")
    });
    assert!(
        matches!(
            refused,
            [
                CasterError::BufferUsage { .. },
                CasterError::BufferTooSmall {
                    needed: 108,
                    got: 96,
                    ..
                },
                CasterError::EmptyRange { start: 3, .. },
                CasterError::Buffer {
                    field: "MeshCasterDescriptor::vertices",
                    ..
                },
                CasterError::Buffer {
                    field: "MeshCasterDescriptor::indices.buffer",
                    ..
                },
                CasterError::NotFinite { .. }
            ]
        ),
        "{refused:?}"
    );
}
