//! Tests that copies of meshes are drawn in one call for each view, and that the maps have the bits
//! of draws one by one.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use shadow_support::readback;
use wgpu_shadows::{
    CascadeLayout, CasterPipeline, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, MeshCaster, OmniLight, OmniShadow, OmniShadowDescriptor,
    ShadowCaster, ShadowMaps, caster::CasterPipelineDescriptor, caster::CasterVertex,
    caster::ModelTransform, caster::PositionAttribute, report::ShadowReport, report::ViewStatus,
};

use crate::fixtures::copies::{Alone, Shared, list, reflected, scattered, small_buffers};
use crate::fixtures::frames::{Coverage, DirectionalFrame, OmniFrame, RecordFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::multiview::{device, is_right, portable};
use crate::fixtures::scene::default_pipeline;

/// Holds what a light made of a frame: its report and the drawn layers.
struct Made {
    report: ShadowReport,
    layers: Vec<Option<Vec<f32>>>,
}

impl Made {
    fn new(gpu: &Gpu, maps: &ShadowMaps) -> Self {
        let report = maps.report().clone();
        let layer = |view: &wgpu_shadows::report::ViewReport| {
            let is_drawn = view.status == ViewStatus::Drawn;
            is_drawn.then(|| readback::depth_layer(gpu, maps.texture(), view.layer))
        };
        Self {
            layers: report.views.iter().map(layer).collect(),
            report,
        }
    }

    /// Asserts that both drew the same views with the same bits, and that they are no empty maps.
    fn assert_same(&self, other: &Self, what: &str) {
        let bits = |layers: &[Option<Vec<f32>>]| -> Vec<Option<Vec<u32>>> {
            let of = |layer: &Vec<f32>| layer.iter().map(|depth| depth.to_bits()).collect();
            layers.iter().map(|layer| layer.as_ref().map(of)).collect()
        };
        assert!(bits(&self.layers) == bits(&other.layers), "{what}");
        let drawn = self.layers.iter().flatten().flatten();
        assert!(drawn.filter(|depth| **depth > 0.0).count() > 100, "{what}");
        for (own, other) in self.report.views.iter().zip(&other.report.views) {
            assert_eq!(
                (own.casters, own.culled, own.triangles),
                (other.casters, other.culled, other.triangles),
                "{what}, layer {}",
                own.layer
            );
        }
    }
}

/// Records four cascades before a camera that sees to the end of the ground.
fn sun(gpu: &Gpu, casters: &[&dyn ShadowCaster]) -> Made {
    let descriptor = DirectionalShadowDescriptor {
        map_size: 64,
        layout: CascadeLayout::fixed(4),
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let camera = Camera::modern(DVec3::new(0.0, 3.0, 22.0), DVec3::ZERO, 0.9, 1.5);
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::new(-0.5, -1.0, -0.3)),
        coverage: Coverage::Camera(camera.view()),
        casters,
        receivers: &[],
    };
    let mut encoder = gpu.encoder();
    let report = shadow.record_frame(&mut encoder, &frame);
    report.expect("a valid frame");
    gpu.submit(encoder);
    Made::new(gpu, shadow.maps())
}

/// Records the six faces of a lamp in the middle of the ground.
fn lamp(gpu: &Gpu, casters: &[&dyn ShadowCaster]) -> Made {
    let descriptor = OmniShadowDescriptor {
        map_size: 64,
        ..Default::default()
    };
    let mut shadow = OmniShadow::new(&gpu.device, &descriptor).expect("a valid lamp");
    let frame = OmniFrame {
        origin: DVec3::ZERO,
        light: OmniLight {
            position_world: DVec3::new(0.3, 1.1, -0.2),
            range: 30.0,
        },
        camera: None,
        casters,
        receivers: &[],
    };
    let mut encoder = gpu.encoder();
    let report = shadow.record_frame(&mut encoder, &frame);
    report.expect("a valid frame");
    gpu.submit(encoder);
    Made::new(gpu, shadow.maps())
}

fn alone<'a>(casters: &'a [&'a dyn ShadowCaster]) -> Vec<Alone<'a>> {
    casters.iter().map(|caster| Alone(*caster)).collect()
}

/// The sun of a yard of 200 spheres takes a call for each cascade and another for the ground, be
/// the spheres casters of their own or one.
#[test]
fn a_yard_takes_two_calls_a_cascade() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let sphere = Shared::new(gpu, &Mesh::sphere(Vec3::ZERO, 1.0, 8));
    let ground = Mesh::floor(0.0, 20.0).caster(gpu, &pipeline, Mat4::IDENTITY);
    let transforms = scattered(&mut Random::new(3), 200, 19.0);
    let copies = sphere.copies(gpu, &pipeline, &transforms);
    let instanced = sphere.instanced(gpu, &pipeline, &transforms);

    let mut separate = list(&copies);
    separate.insert(77, &ground);
    let batched = sun(gpu, &separate);
    assert!(batched.report.draws() <= 8, "{}", batched.report.draws());
    let alone = alone(&separate);
    let one_by_one = sun(gpu, &list(&alone));
    batched.assert_same(&one_by_one, "copies that are casters of their own");
    let casters: u32 = one_by_one
        .report
        .views
        .iter()
        .map(|view| view.casters)
        .sum();
    assert_eq!(one_by_one.report.draws(), casters);
    assert!(casters > 200, "{casters} casters are no yard");

    let as_one = sun(gpu, &[&instanced, &ground]);
    as_one.assert_same(&one_by_one, "copies that are one caster");
    assert_eq!(as_one.report.draws(), batched.report.draws());
    // Each cascade sees some of them, and no cascade all.
    assert!(as_one.report.views.iter().all(|view| view.culled > 0));
}

/// Returns casters of every kind in a mixed order: two meshes in one pair of buffers and one in
/// another, pipelines that cull and that do not, transforms that mirror, matrices in wider
/// instances, vertices without an index buffer and in render space.
fn mixed(gpu: &Gpu, random: &mut Random) -> Vec<MeshCaster> {
    let plain = default_pipeline(gpu);
    let make = |descriptor: &CasterPipelineDescriptor<'_>| {
        CasterPipeline::new(&gpu.device, descriptor).expect("a valid pipeline")
    };
    let culling = make(&CasterPipelineDescriptor {
        primitive: wgpu::PrimitiveState {
            cull_mode: Some(wgpu::Face::Front),
            ..Default::default()
        },
        ..Default::default()
    });
    let built_in = |model| CasterPipelineDescriptor {
        vertex: CasterVertex::BuiltIn {
            position: PositionAttribute::float32x3(12),
            model,
        },
        ..Default::default()
    };
    let wide = make(&built_in(ModelTransform::InstanceMatrix {
        array_stride: 84,
        offset: 12,
    }));
    let unmoved = make(&built_in(ModelTransform::Identity));
    let half = Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5));
    let sphere = Mesh::sphere(Vec3::ZERO, 0.5, 5);
    let [boxes, balls] = Shared::of_meshes(gpu, [&half, &sphere]);
    let others = Shared::new(gpu, &Mesh::rod(Vec3::NEG_Y, Vec3::Y, 0.2, 5));
    let corners: Vec<Vec3> = sphere
        .indices
        .iter()
        .map(|&i| sphere.positions[i as usize])
        .collect();
    let loose = Shared {
        vertices: gpu.buffer(&corners, wgpu::BufferUsages::VERTEX),
        indices: wgpu_shadows::caster::MeshIndices::None {
            vertices: 0..corners.len() as u32,
        },
        bounds: sphere.bounds(),
    };
    let mut casters = Vec::new();
    for transform in scattered(random, 90, 12.0) {
        let shared = [&boxes, &balls, &others, &loose][random.index(4)];
        let pipeline = [&plain, &culling, &wide, &unmoved][random.index(4)];
        let mirrors = random.unit() < 0.3;
        let transform = if mirrors {
            reflected(transform)
        } else {
            transform
        };
        casters.push(shared.copy(gpu, pipeline, transform));
    }
    casters
}

/// Whatever the casters are, and in whatever order, batches give the bits of single draws under a
/// sun and under a lamp.
#[test]
fn batches_have_the_bits_of_single_draws() {
    let gpu = gpu();
    for seed in 0..4 {
        let casters = mixed(gpu, &mut Random::new(seed));
        let casters = list(&casters);
        let alone = alone(&casters);
        let what = format!("seed {seed}");
        for light in [sun, lamp] {
            let [batched, single] = [light(gpu, &casters), light(gpu, &list(&alone))];
            batched.assert_same(&single, &what);
            let draws = [&batched, &single].map(|made| made.report.draws());
            assert!(3 * draws[0] < 2 * draws[1], "{what}: {draws:?}");
        }
    }
}

/// Copies whose transform mirrors keep the faces that they would have as casters of their own: they
/// take a call more, by the pipeline of the other winding.
#[test]
fn copies_that_are_mirrored() {
    let gpu = gpu();
    let descriptor = CasterPipelineDescriptor {
        primitive: wgpu::PrimitiveState {
            cull_mode: Some(wgpu::Face::Front),
            ..Default::default()
        },
        ..Default::default()
    };
    let pipeline = CasterPipeline::new(&gpu.device, &descriptor).expect("a valid pipeline");
    let boxes = Shared::new(gpu, &Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5)));
    let mut transforms = scattered(&mut Random::new(13), 40, 6.0);
    for transform in transforms.iter_mut().step_by(3) {
        *transform = reflected(*transform);
    }
    let copies = boxes.copies(gpu, &pipeline, &transforms);
    let copies = list(&copies);
    let alone = alone(&copies);
    let instanced = boxes.instanced(gpu, &pipeline, &transforms);
    let as_one = lamp(gpu, &[&instanced]);
    as_one.assert_same(&lamp(gpu, &list(&alone)), "mirrored copies");
    let drawn = as_one.layers.iter().flatten().count() as u32;
    assert!((drawn + 1..=2 * drawn).contains(&as_one.report.draws()));
}

/// Some casters draw themselves among others that do not.
#[test]
fn batches_beside_casters_that_draw_themselves() {
    let gpu = gpu();
    let casters = mixed(gpu, &mut Random::new(11));
    let casters = list(&casters);
    let single = alone(&casters);
    let single = list(&single);
    let half: Vec<&dyn ShadowCaster> = (0..casters.len())
        .map(|index| [casters[index], single[index]][index % 2])
        .collect();
    sun(gpu, &half).assert_same(&sun(gpu, &single), "every second one");
}

/// Six faces in one pass take one call for all copies.
#[test]
fn copies_in_six_faces_at_once() {
    let transforms = scattered(&mut Random::new(5), 40, 6.0);
    let made = [device(), portable()].map(|gpu| {
        let pipeline = default_pipeline(gpu);
        let boxes = Shared::new(gpu, &Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5)));
        let instanced = boxes.instanced(gpu, &pipeline, &transforms);
        lamp(gpu, &[&instanced])
    });
    let [one, six] = &made;
    let drawn = six.layers.iter().flatten().count() as u32;
    assert_eq!((six.report.passes, six.report.draws()), (drawn, drawn));
    if is_right() {
        assert_eq!((one.report.passes, one.report.draws()), (1, 1));
    }
    for (one, six) in one.layers.iter().zip(&six.layers) {
        assert!(six.is_none() || one == six);
    }
}

/// Where the matrices of a frame exceed the largest buffer, they lie in several.
#[test]
fn matrices_beyond_the_largest_buffer() {
    // A buffer holds 256 matrices, and the map is read back in one of this size.
    let small = small_buffers();
    let transforms = scattered(&mut Random::new(7), 250, 12.0);
    let cube = Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5));
    let rod = Mesh::rod(Vec3::NEG_Y, Vec3::Y, 0.2, 5);
    let [few, many] = [&small, gpu()].map(|gpu| {
        let pipeline = default_pipeline(gpu);
        let instanced = [&cube, &rod].map(|mesh| {
            let shared = Shared::new(gpu, mesh);
            shared.instanced(gpu, &pipeline, &transforms)
        });
        sun(gpu, &list(&instanced))
    });
    few.assert_same(&many, "several buffers");
    let casters: u32 = few.report.views.iter().map(|view| view.casters).sum();
    assert!(casters > 512, "{casters} matrices fit two buffers");
    let draws = [&few, &many].map(|made| made.report.draws());
    assert!(draws[0] > draws[1] && draws[0] < 16, "{draws:?}");
}
