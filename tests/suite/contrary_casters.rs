//! Tests casters that violate the contract: they return different values within a frame, panic, or
//! belong to another device.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::{Mat4, Vec3};
use shadow_support::readback;
use wgpu_shadows::{
    Aabb, CasterPipeline, DepthFormat, MeshCaster, Revision, ShadowCaster, ShadowError, ShadowView,
    caster::CasterPipelineDescriptor, report::ViewStatus,
};

use crate::fixtures::frames::RecordFrame;
use crate::fixtures::gpu::{gpu, two_gpus};
use crate::fixtures::probe::record;
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::slabs::{assert_same, frame, fresh_map, slab, sun};

/// Is a mesh with two pipelines that it returns in turn, one of which is made for maps of another
/// format.
struct Fickle {
    mesh: MeshCaster,
    other_pipeline: CasterPipeline,
    calls: Cell<u32>,
}

impl ShadowCaster for Fickle {
    fn bounds(&self) -> Aabb {
        self.mesh.bounds()
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.calls.set(self.calls.get() + 1);
        match self.calls.get() % 2 {
            0 => &self.other_pipeline,
            _ => self.mesh.pipeline(),
        }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
        self.mesh.draw(pass, view);
    }
}

/// If the pipeline differs between the check and the draw, the frame is refused, or the map
/// contains everything.
#[test]
fn casters_that_change_their_mind() {
    let gpu = gpu();
    let narrow = CasterPipeline::new(
        &gpu.device,
        &CasterPipelineDescriptor {
            depth_formats: &[DepthFormat::Unorm16],
            ..Default::default()
        },
    )
    .expect("a valid pipeline");
    let caster = Fickle {
        mesh: slab(gpu, &default_pipeline(gpu), 0.0),
        other_pipeline: narrow,
        calls: Cell::new(0),
    };
    let wanted = fresh_map(gpu, &[&caster.mesh]);
    let (mut complete, mut refused) = (0, 0);
    for _ in 0..6 {
        let mut shadow = sun(gpu);
        let mut encoder = gpu.encoder();
        let result = shadow
            .record_frame(&mut encoder, &frame(&[&caster]))
            .cloned();
        gpu.submit(encoder);
        match result {
            Ok(_) => {
                let map = readback::depth_layer(gpu, shadow.maps().texture(), 0);
                assert_same(&map, &wanted, "a fickle caster");
                complete += 1;
            }
            Err(ShadowError::CasterFormat { index: 0, .. }) => refused += 1,
            Err(error) => panic!("{error}"),
        }
    }
    assert!(complete > 0 && refused > 0, "{complete} {refused}");
}

/// Is a mesh that returns fewer triangles at each call, among others that do not change.
struct Shrinking(MeshCaster, Cell<u32>);

impl ShadowCaster for Shrinking {
    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.0.pipeline()
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
        self.0.draw(pass, view);
    }

    fn triangles(&self) -> u32 {
        self.1.set(self.1.get() / 2);
        self.1.get()
    }

    fn revision(&self) -> Option<Revision> {
        self.0.revision()
    }
}

#[test]
fn triangles_that_shrink_while_they_are_counted() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let still: Vec<_> = (0..30)
        .map(|index| Shrinking(slab(gpu, &pipeline, index as f32 * 0.1 - 2.0), Cell::new(0)))
        .collect();
    let mut mover = slab(gpu, &pipeline, 3.0);
    let mut shadow = sun(gpu);
    let mut copied = 0;
    for step in 0..12 {
        mover
            .set_transform(Mat4::from_translation(Vec3::Z * 0.01 * step as f32))
            .expect("a finite matrix");
        still.iter().for_each(|caster| caster.1.set(u32::MAX));
        let mut list: Vec<_> = still.iter().map(|c| c as &dyn ShadowCaster).collect();
        list.push(&mover);
        copied += record(gpu, &mut shadow, &frame(&list)).views[0].copied;
    }
    assert!(copied > 0 || gpu.adapter.backend == wgpu::Backend::Gl);
}

/// Is a mesh that panics instead of being drawn while it is told to.
struct Panicking(MeshCaster, Cell<bool>);

impl ShadowCaster for Panicking {
    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.0.pipeline()
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
        assert!(!self.1.get(), "this caster panics on purpose");
        self.0.draw(pass, view);
    }

    fn triangles(&self) -> u32 {
        self.0.triangles()
    }

    fn revision(&self) -> Option<Revision> {
        self.0.revision()
    }
}

/// An engine that catches the panic of one caster continues with shadows that are correct in the
/// next frame.
#[test]
fn a_caster_that_panics_leaves_nothing_behind() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let first = slab(gpu, &pipeline, -2.0);
    let panicking = Panicking(slab(gpu, &pipeline, 0.0), Cell::new(true));
    let last = slab(gpu, &pipeline, 2.0);
    let list: [&dyn ShadowCaster; 3] = [&first, &panicking, &last];
    let mut shadow = sun(gpu);
    let mut encoder = gpu.encoder();
    let caught = catch_unwind(AssertUnwindSafe(|| {
        let _ = shadow.record_frame(&mut encoder, &frame(&list));
    }));
    assert!(caught.is_err(), "the panic is the engine's to catch");
    gpu.submit(encoder);
    panicking.1.set(false);
    let report = record(gpu, &mut shadow, &frame(&list));
    assert_eq!(report.views[0].status, ViewStatus::Drawn);
    let map = readback::depth_layer(gpu, shadow.maps().texture(), 0);
    assert_same(&map, &fresh_map(gpu, &list), "after a panic");
    let report = record(gpu, &mut shadow, &frame(&list));
    assert_eq!(report.views[0].status, ViewStatus::Kept);
}

/// A caster whose pipeline belongs to another device is refused before anything is recorded.
#[test]
fn pipelines_of_another_device() {
    let [here, there] = two_gpus();
    let own = slab(&here, &default_pipeline(&here), 0.0);
    let foreign = slab(&there, &default_pipeline(&there), 2.0);
    let mut shadow = sun(&here);
    let list: [&dyn ShadowCaster; 2] = [&own, &foreign];
    let mut encoder = here.encoder();
    let error = shadow
        .record_frame(&mut encoder, &frame(&list))
        .expect_err("a foreign pipeline");
    here.submit(encoder);
    let wanted = ShadowError::CasterDevice {
        field: "ShadowFrameDescriptor::casters",
        index: 1,
    };
    assert_eq!(error, wanted);
    assert_eq!(
        error.to_string(),
        "ShadowFrameDescriptor::casters[1]: its CasterPipeline must be made on the device of the light"
    );
    let report = record(&here, &mut shadow, &frame(&[&own]));
    assert_eq!(report.views[0].status, ViewStatus::Drawn);
}

/// If two frames are recorded before either is submitted, each shows the mesh where it was when
/// that frame was recorded.
#[test]
fn two_frames_before_one_submission() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let mut mesh = slab(gpu, &pipeline, -2.0);
    let wanted = fresh_map(gpu, &[&mesh]);
    let mut suns = [sun(gpu), sun(gpu)];
    let mut encoder = gpu.encoder();
    for (step, shadow) in suns.iter_mut().enumerate() {
        mesh.set_transform(Mat4::from_translation(Vec3::X * 3.0 * step as f32))
            .expect("a finite matrix");
        shadow
            .record_frame(&mut encoder, &frame(&[&mesh]))
            .expect("a valid frame");
    }
    gpu.submit(encoder);
    let first = readback::depth_layer(gpu, suns[0].maps().texture(), 0);
    assert_same(&first, &wanted, "the first of two frames");
    let second = readback::depth_layer(gpu, suns[1].maps().texture(), 0);
    assert_same(&second, &fresh_map(gpu, &[&mesh]), "the second");
}
