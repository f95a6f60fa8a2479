//! Tests `InstancedMeshCaster`: what changes of its copies do to maps, and what it refuses.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::{Mesh, render_space_pipeline};
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CascadeLayout, CasterPipeline, CasterSet, Casters, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, InstancedMeshCaster, ShadowCaster, ShadowFrameDescriptor,
    ShadowScene, caster::CasterPipelineDescriptor, error::CasterError, report::BrokenBounds,
    report::ViewStatus,
};

use crate::fixtures::copies::{Alone, Shared, scattered, small_buffers};
use crate::fixtures::frames::{Coverage, DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::{Gpu, gpu, two_gpus, vulkan};
use crate::fixtures::probe::record;
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::slabs::{assert_same, frame, fresh_map};
use crate::fixtures::texture_bytes::TextureBytes;

fn cube(gpu: &Gpu) -> Shared {
    Shared::new(gpu, &Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5)))
}

fn at(x: f32, z: f32) -> Mat4 {
    Mat4::from_translation(Vec3::new(x, 1.0, z))
}

/// Holds cascades that cover a wide ground, the first of them only the near part.
fn cascades(gpu: &Gpu) -> DirectionalShadow {
    let descriptor = DirectionalShadowDescriptor {
        map_size: 64,
        layout: CascadeLayout::fixed(3),
        ..Default::default()
    };
    DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun")
}

/// A change of a copy draws the views again that see it, and no other; no change draws none.
#[test]
fn only_the_views_that_see_a_change_are_drawn_again() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let ground = Mesh::floor(0.0, 60.0).caster(gpu, &pipeline, Mat4::IDENTITY);
    let transforms: Vec<Mat4> = (0..100)
        .map(|index| {
            at(
                (index % 10) as f32 * 6.0 - 27.0,
                (index / 10) as f32 * 6.0 - 27.0,
            )
        })
        .collect();
    let mut copies = cube(gpu).instanced(gpu, &pipeline, &transforms);
    let mut shadow = cascades(gpu);
    let camera = Camera::modern(DVec3::new(0.0, 3.0, 32.0), DVec3::ZERO, 0.9, 1.5);
    let mut statuses = |copies: &InstancedMeshCaster| {
        let frame = DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(Vec3::new(0.2, -1.0, 0.1)),
            coverage: Coverage::Camera(camera.view()),
            casters: &[&ground, copies],
            receivers: &[],
        };
        let report = record(gpu, &mut shadow, &frame);
        let views = report.views.iter();
        views.map(|view| view.status).collect::<Vec<_>>()
    };
    use ViewStatus::{Drawn, Kept};
    assert_eq!(statuses(&copies), [Drawn; 3]);
    assert_eq!(statuses(&copies), [Kept; 3]);
    // A cube at the far end, which only the last cascade sees, turns about itself.
    let turned = transforms[4] * Mat4::from_rotation_y(0.5);
    copies.set_transforms(4, &[turned]).expect("a copy");
    assert_eq!(statuses(&copies), [Kept, Kept, Drawn]);
    copies.set_transforms(4, &[turned]).expect("a copy");
    assert_eq!(copies.transform(4), Some(&turned));
    assert_eq!(statuses(&copies), [Kept; 3]);
    copies.set_transforms(0, &transforms).expect("all copies");
    assert_eq!(statuses(&copies), [Kept, Kept, Drawn]);
    copies.geometry_changed(copies_bounds()).expect("bounds");
    assert_eq!(statuses(&copies), [Drawn; 3]);
}

fn copies_bounds() -> Aabb {
    Aabb::new(Vec3::splat(-0.5), Vec3::splat(0.5))
}

/// Kept maps, static-caster caches among them, have the bits of maps that are drawn anew, while
/// copies are added, removed and moved.
#[test]
fn kept_maps_of_copies_are_what_would_be_drawn() {
    let gpu = vulkan();
    let pipeline = CasterPipeline::new(&gpu.device, &CasterPipelineDescriptor::new())
        .expect("a valid pipeline");
    let meshes = [
        Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5)),
        Mesh::sphere(Vec3::ZERO, 0.6, 6),
    ];
    let mut random = Random::new(40);
    let mut casters: Vec<_> = meshes
        .iter()
        .map(|mesh| {
            let transforms = scattered(&mut random, 40, 8.0);
            Shared::new(gpu, mesh).instanced(gpu, &pipeline, &transforms)
        })
        .collect();
    let (mut kept, mut fresh) = (cascades(gpu), cascades(gpu));
    let [kept_bytes, fresh_bytes] =
        [&kept, &fresh].map(|sun| TextureBytes::new(gpu, sun.maps().texture()));
    let mut eye = DVec3::new(0.0, 6.0, 14.0);
    let (mut kept_views, mut copied_views) = (0, 0);
    let mut movers = 1;
    for frame_index in 0..400 {
        let chance = random.unit();
        let which = random.index(2);
        let caster = &mut casters[which];
        if chance < 0.02 {
            caster
                .push(&scattered(&mut random, 3, 8.0))
                .expect("copies");
        } else if chance < 0.05 && caster.len() > 20 {
            let index = random.index(caster.len());
            caster.swap_remove(index).expect("a copy");
        } else if chance < 0.07 {
            movers = [0, 1, 1, 3][random.index(4)];
        } else if chance < 0.09 {
            eye = random.point(DVec3::new(-9.0, 3.0, 9.0), DVec3::new(9.0, 9.0, 15.0));
        }
        let moved = scattered(&mut random, movers, 8.0);
        casters[0].set_transforms(0, &moved).expect("copies");
        let list: Vec<&dyn ShadowCaster> = casters.iter().map(|caster| caster as _).collect();
        let frame = DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(Vec3::new(0.4, -1.0, 0.3)),
            coverage: Coverage::Camera(Camera::modern(eye, DVec3::ZERO, 1.0, 1.5).view()),
            casters: &list,
            receivers: &[],
        };
        let mut encoder = gpu.encoder();
        let report = kept.record_frame(&mut encoder, &frame);
        for view in &report.expect("a valid frame").views {
            kept_views += u32::from(view.status == ViewStatus::Kept);
            copied_views += u32::from(view.copied > 0);
        }
        fresh.invalidate();
        let report = fresh.record_frame(&mut encoder, &frame);
        let report = report.expect("a valid frame").clone();
        kept_bytes.copy(&mut encoder);
        fresh_bytes.copy(&mut encoder);
        gpu.submit(encoder);
        let (now, wanted) = (kept_bytes.read(gpu), fresh_bytes.read(gpu));
        let what = || format!("frame {frame_index}");
        kept_bytes.assert_same_views(&report, [&now, &wanted], what);
    }
    assert!(
        kept_views > 40 && copied_views > 40,
        "{kept_views} kept, {copied_views} copied"
    );
}

/// A copy whose transform is not finite, or takes it to infinity, is left out and named; the others
/// keep their shadows.
#[test]
fn copies_without_a_place_are_left_out_and_named() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let shared = cube(gpu);
    let sound = [at(-2.0, 0.0), at(0.0, 1.0), at(2.0, -1.0)];
    let wanted = fresh_map(gpu, &[&shared.instanced(gpu, &pipeline, &sound)]);
    let mut last_row = at(0.0, 0.0);
    last_row.x_axis.w = f32::NAN;
    let bad = [
        Mat4::from_translation(Vec3::new(f32::NAN, 0.0, 0.0)),
        Mat4::from_scale(Vec3::splat(f32::INFINITY)),
        Mat4::from_scale(Vec3::splat(f32::MAX)) * Mat4::from_translation(Vec3::ONE),
        last_row,
    ];
    for bad in bad {
        let transforms = [sound[0], bad, sound[1], sound[2]];
        let mut copies = shared.instanced(gpu, &pipeline, &transforms);
        let mut shadow = crate::fixtures::slabs::sun(gpu);
        let report = record(gpu, &mut shadow, &frame(&[&copies]));
        let [
            BrokenBounds {
                field: "ShadowFrameDescriptor::casters",
                index: 0,
                instance: Some(1),
                ..
            },
        ] = report.broken_bounds[..]
        else {
            panic!("{:?}", report.broken_bounds);
        };
        assert_eq!(report.views[0].casters, 3);
        let found = fresh_map(gpu, &[&copies]);
        assert_same(&found, &wanted, "beside a copy without a place");
        assert_same(
            &fresh_map(gpu, &[&Alone(&copies)]),
            &wanted,
            "drawn by itself",
        );
        copies.set_transforms(1, &[sound[1]]).expect("a copy");
        let report = record(gpu, &mut shadow, &frame(&[&copies]));
        assert!(report.broken_bounds.is_empty());
        assert_eq!(report.views[0].casters, 4);
    }
}

/// If two frames are recorded before either is submitted, each shows the copies where they were
/// when that frame was recorded.
#[test]
fn copies_move_between_two_frames_of_one_submission() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let shared = cube(gpu);
    let places = [[at(-2.0, 0.0), at(2.0, 0.0)], [at(0.0, -2.0), at(0.0, 2.0)]];
    let mut copies = shared.instanced(gpu, &pipeline, &[]);
    assert!(copies.is_empty() && copies.bounds().is_empty());
    copies.push(&places[0]).expect("copies");
    let mut suns = [(); 2].map(|()| crate::fixtures::slabs::sun(gpu));
    let mut encoder = gpu.encoder();
    for (sun, places) in suns.iter_mut().zip(&places) {
        copies.set_transforms(0, places).expect("copies");
        let report = sun.record_frame(&mut encoder, &frame(&[&copies]));
        assert_eq!(report.expect("a valid frame").draws(), 1);
    }
    // One sun records twice, and the second frame is larger.
    copies.push(&[at(1.0, 1.0)]).expect("a copy");
    let report = suns[1].record_frame(&mut encoder, &frame(&[&copies]));
    assert_eq!(report.expect("a valid frame").views[0].casters, 3);
    gpu.submit(encoder);
    let last = [&places[1][..], &[at(1.0, 1.0)]].concat();
    for (sun, places) in suns.iter().zip([&places[0][..], &last]) {
        let wanted = fresh_map(gpu, &[&shared.instanced(gpu, &pipeline, places)]);
        let found = shadow_support::readback::depth_layer(gpu, sun.maps().texture(), 0);
        assert_same(&found, &wanted, "one of two frames");
    }
}

/// Each refusal names its field, and changes nothing.
#[test]
fn what_copies_refuse() {
    let small = small_buffers();
    let pipeline = default_pipeline(&small);
    let shared = cube(&small);
    let create = |pipeline: &CasterPipeline, count| {
        let transforms = vec![Mat4::IDENTITY; count];
        InstancedMeshCaster::new(&small.device, &shared.descriptor(pipeline, &transforms))
    };
    let too_many = |field| CasterError::OverDeviceLimit {
        field,
        limit: "max_buffer_size",
        maximum: 16_384,
        value: 16_448,
    };
    let error = create(&pipeline, 257).expect_err("too many copies");
    assert_eq!(
        error,
        too_many("InstancedMeshCasterDescriptor::render_from_model")
    );
    let mut copies = create(&pipeline, 256).expect("as many as fit");
    let revision = copies.revision();
    let error = copies.push(&[Mat4::IDENTITY]).expect_err("one too many");
    assert_eq!(error, too_many("render_from_model"));

    let error = create(&render_space_pipeline(&small), 1).expect_err("no matrix");
    let field = "InstancedMeshCasterDescriptor::pipeline";
    assert_eq!(error, CasterError::NoInstanceMatrix { field });
    assert_eq!(
        error.to_string(),
        format!("{field} must have the built-in vertex stage with an instance matrix")
    );

    let error = copies
        .set_transforms(255, &[Mat4::IDENTITY; 2])
        .expect_err("255..257");
    let text = "first must lie in the 256 instances of the caster, got 255..257";
    assert_eq!(error.to_string(), text);
    let error = copies
        .set_transforms(usize::MAX, &[])
        .expect_err("far beyond");
    assert!(
        matches!(error, CasterError::NoSuchInstance { count: 256, .. }),
        "{error}"
    );
    let error = copies.swap_remove(256).expect_err("no copy");
    let text = "index must lie in the 256 instances of the caster, got 256..257";
    assert_eq!(error.to_string(), text);
    let endless = Aabb::new(Vec3::ZERO, Vec3::INFINITY);
    let error = copies
        .geometry_changed(endless)
        .expect_err("endless bounds");
    assert!(matches!(error, CasterError::NotFinite { .. }), "{error}");
    assert_eq!((copies.len(), copies.revision()), (256, revision));

    let [here, there] = two_gpus();
    let (own, foreign) = (cube(&here), cube(&there));
    let pipeline = default_pipeline(&here);
    let error = InstancedMeshCaster::new(&here.device, &foreign.descriptor(&pipeline, &[]))
        .expect_err("buffers of another device");
    let CasterError::Buffer { field, .. } = error else {
        panic!("{error}");
    };
    assert_eq!(field, "InstancedMeshCasterDescriptor::vertices");
    let other = default_pipeline(&there);
    let error = InstancedMeshCaster::new(&here.device, &own.descriptor(&other, &[]))
        .expect_err("a pipeline of another device");
    let field = "InstancedMeshCasterDescriptor::pipeline";
    assert_eq!(error, CasterError::OtherDevice { field });
}

/// Copies of a mesh in a set give the same views, draw calls and maps as in a list, while copies
/// come, go and move, and while their caster is removed and inserted again.
#[test]
fn copies_in_a_set_are_those_in_a_list() {
    let gpu = vulkan();
    let pipeline = default_pipeline(gpu);
    let ground = Mesh::floor(0.0, 60.0).caster(gpu, &pipeline, Mat4::IDENTITY);
    let mut random = Random::new(23);
    let start = scattered(&mut random, 12, 20.0);
    let mut listed = cube(gpu).instanced(gpu, &pipeline, &start);
    let mut set: CasterSet<InstancedMeshCaster> = CasterSet::new();
    let other = cube(gpu).instanced(gpu, &pipeline, &start);
    let ground_copy = Shared::new(gpu, &Mesh::floor(0.0, 60.0));
    set.insert(ground_copy.instanced(gpu, &pipeline, &[Mat4::IDENTITY]));
    let mut id = set.insert(other);
    let (mut of_set, mut of_list) = (cascades(gpu), cascades(gpu));
    let bytes = [&of_set, &of_list].map(|sun| TextureBytes::new(gpu, sun.maps().texture()));
    let (mut set_scene, mut list_scene) = (ShadowScene::new(), ShadowScene::new());
    let camera = Camera::modern(DVec3::new(0.0, 5.0, 25.0), DVec3::ZERO, 0.9, 1.5);
    let cameras = [camera.view().with_max_distance(80.0)];
    let light = DirectionalLight::new(Vec3::new(0.3, -1.0, 0.2));
    let mut drawn = 0;
    for frame in 0..120 {
        let step = random.index(6);
        let some = scattered(&mut random, 3, 20.0);
        let index = random.index(listed.len().max(1));
        let change = |copies: &mut InstancedMeshCaster| {
            // A change that is refused because there are too few copies is none.
            match step {
                0 => copies.push(&some).expect("few copies"),
                1 => drop(copies.swap_remove(index)),
                2 => drop(copies.set_transforms(index, &some[..1])),
                3 if frame % 20 == 0 => copies.clear(),
                _ => {}
            }
        };
        change(&mut listed);
        set.update(id, change).expect("a known caster");
        if frame % 17 == 0 {
            let taken = set.remove(id).expect("a known caster");
            id = set.insert(taken);
        }
        let list: [&dyn ShadowCaster; 2] = [&ground, &listed];
        let descriptor = |casters| ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: wgpu_shadows::Coverage::Cameras(&cameras),
            casters,
            receivers: &[],
        };
        let mut encoder = gpu.encoder();
        let frame_of_set = set_scene.frame(&descriptor(Casters::Set(&set)));
        let report = of_set.record(&mut encoder, &frame_of_set.expect("a valid frame"), &light);
        let set_report = report.expect("a valid light").clone();
        let frame_of_list = list_scene.frame(&descriptor(Casters::List(&list)));
        let report = of_list.record(&mut encoder, &frame_of_list.expect("a valid frame"), &light);
        let list_report = report.expect("a valid light").clone();
        assert_eq!(set_report, list_report, "frame {frame}");
        bytes.iter().for_each(|bytes| bytes.copy(&mut encoder));
        gpu.submit(encoder);
        let [now, wanted] = bytes.each_ref().map(|bytes| bytes.read(gpu));
        assert!(now == wanted, "frame {frame}");
        drawn += set_report.draws();
    }
    assert!(drawn > 100, "{drawn}");
}
