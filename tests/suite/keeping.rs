//! Tests when a map is drawn again and when it is kept, and that a kept map is still correct.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::readback;
use wgpu_shadows::{
    Aabb, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    MeshCaster, Revision, ShadowCaster, report::ShadowReport, report::ViewStatus,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::watched::Watched;

const LIGHT: Vec3 = Vec3::new(0.5, -1.0, 0.25);
const BOX: Aabb = Aabb::new(Vec3::new(-4.0, -0.5, -4.0), Vec3::new(4.0, 4.0, 4.0));

/// Holds a sun, its probe, and a slab that floats one unit above the ground around the origin.
struct Stage {
    gpu: &'static Gpu,
    shadow: DirectionalShadow,
    probe: SunProbe,
    light: Vec3,
    origin: DVec3,
    coverage: Coverage,
}

impl Stage {
    fn new() -> Self {
        Self::with_cascades(1)
    }

    fn with_cascades(cascades: u32) -> Self {
        let gpu = gpu();
        let descriptor = DirectionalShadowDescriptor {
            map_size: 128,
            layout: CascadeLayout::fixed(cascades),
            ..Default::default()
        };
        let shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
        Self {
            gpu,
            probe: SunProbe::new(gpu, &shadow),
            shadow,
            light: LIGHT,
            origin: DVec3::ZERO,
            coverage: Coverage::Bounds(BOX),
        }
    }

    fn frame<'a>(&self, casters: &'a [&'a dyn ShadowCaster]) -> DirectionalFrame<'a> {
        DirectionalFrame {
            origin: self.origin,
            light: DirectionalLight::new(self.light),
            coverage: self.coverage,
            casters,
            receivers: &[],
        }
    }

    fn record(&mut self, casters: &[&dyn ShadowCaster]) -> ShadowReport {
        let frame = self.frame(casters);
        record(self.gpu, &mut self.shadow, &frame)
    }

    /// Returns the status of the only view, after checking that passes and draws agree with it.
    fn status(&mut self, casters: &[&dyn ShadowCaster]) -> ViewStatus {
        let report = self.record(casters);
        let drawn = report.views[0].status == ViewStatus::Drawn;
        assert_eq!(report.passes, u32::from(drawn));
        assert_eq!(
            report.draws(),
            if drawn { report.views[0].casters } else { 0 }
        );
        report.views[0].status
    }

    /// Returns whether the ground is dark where the slab's shadow falls when the slab is at `x`.
    fn is_dark_below(&self, x: f32) -> bool {
        let ground = Vec3::new(x, 1.0, 0.0) + LIGHT;
        let seen = self.probe.ask(self.gpu, &[Point::new(ground, Vec3::Y)])[0];
        assert!(seen == 0.0 || seen > 0.999, "on the border: {seen}");
        seen == 0.0
    }
}

fn slab(gpu: &Gpu) -> MeshCaster {
    let mesh = Mesh::cuboid(Vec3::new(-0.5, 1.0, -0.5), Vec3::new(0.5, 1.1, 0.5));
    mesh.caster(gpu, &default_pipeline(gpu), Mat4::IDENTITY)
}

fn shift(x: f32) -> Mat4 {
    Mat4::from_translation(Vec3::new(x, 0.0, 0.0))
}

#[test]
fn an_unchanged_frame_records_nothing() {
    let mut stage = Stage::new();
    let slab = Watched::new(slab(stage.gpu));
    assert_eq!(stage.status(&[&slab]), ViewStatus::Drawn);
    assert_eq!(slab.draws.get(), 1);
    let first = readback::depth_layer(stage.gpu, stage.shadow.maps().texture(), 0);
    for _ in 0..3 {
        assert_eq!(stage.status(&[&slab]), ViewStatus::Kept);
    }
    assert_eq!(slab.draws.get(), 1, "a kept view asks nobody to draw");
    assert!(stage.is_dark_below(0.0) && !stage.is_dark_below(2.0));
    let last = readback::depth_layer(stage.gpu, stage.shadow.maps().texture(), 0);
    assert_eq!(first, last);
}

#[test]
fn a_moved_mesh_is_drawn_again() {
    let mut stage = Stage::new();
    let mut slab = slab(stage.gpu);
    assert_eq!(stage.status(&[&slab]), ViewStatus::Drawn);
    slab.set_transform(shift(2.0)).expect("a finite matrix");
    assert_eq!(stage.status(&[&slab]), ViewStatus::Drawn);
    assert!(stage.is_dark_below(2.0) && !stage.is_dark_below(0.0));
    // Setting the matrix that the slab has already is no change.
    slab.set_transform(shift(2.0)).expect("a finite matrix");
    assert_eq!(stage.status(&[&slab]), ViewStatus::Kept);
    slab.set_transform(shift(0.0)).expect("a finite matrix");
    assert_eq!(stage.status(&[&slab]), ViewStatus::Drawn);
    assert!(stage.is_dark_below(0.0) && !stage.is_dark_below(2.0));
    let bounds = Aabb::new(Vec3::new(-0.5, 1.0, -0.5), Vec3::new(0.5, 1.1, 0.5));
    slab.geometry_changed(bounds).expect("finite bounds");
    assert_eq!(stage.status(&[&slab]), ViewStatus::Drawn);
}

#[test]
fn two_meshes_of_the_same_shape_are_two_things() {
    let mut stage = Stage::new();
    let (first, second) = (slab(stage.gpu), slab(stage.gpu));
    assert_ne!(first.revision(), second.revision());
    assert_eq!(stage.status(&[&first]), ViewStatus::Drawn);
    assert_eq!(stage.status(&[&second]), ViewStatus::Drawn);
    assert_eq!(stage.status(&[&first, &second]), ViewStatus::Drawn);
    assert_eq!(stage.status(&[&second]), ViewStatus::Drawn);
}

/// An engine may number its own casters as it likes: none of them is taken for a mesh, though
/// meshes are numbered too.
#[test]
fn meshes_and_an_engines_own_casters_are_never_the_same() {
    let mut stage = Stage::new();
    let mesh = slab(stage.gpu);
    assert_eq!(stage.status(&[&mesh]), ViewStatus::Drawn);
    let mut own = Watched::new(slab(stage.gpu));
    // Meshes are numbered from zero, and the tests make fewer than these.
    for id in 0..1 << 16 {
        let revision = Some(Revision::new(id, 0));
        if revision == mesh.revision() || id == 0 {
            own.revision = Some(revision);
        }
    }
    assert_eq!(stage.status(&[&own]), ViewStatus::Drawn);
    assert_eq!(stage.status(&[&own]), ViewStatus::Kept);
}

#[test]
fn a_caster_that_says_nothing_is_always_drawn() {
    let mut stage = Stage::new();
    let silent = Watched::with_revision(slab(stage.gpu), None);
    assert_eq!(silent.revision(), None);
    let still = slab(stage.gpu);
    for _ in 0..3 {
        assert_eq!(stage.status(&[&still, &silent]), ViewStatus::Drawn);
    }
}

#[test]
fn invalidated_maps_are_drawn_again() {
    let mut stage = Stage::new();
    let slab = slab(stage.gpu);
    // An encoder that is dropped takes the pass and the uniforms with it.
    let mut lost = stage.gpu.encoder();
    let casters: [&dyn ShadowCaster; 1] = [&slab];
    let frame = stage.frame(&casters);
    let report = stage.shadow.record_frame(&mut lost, &frame);
    assert_eq!(report.expect("a valid frame").passes, 1);
    drop(lost);
    assert!(!stage.is_dark_below(0.0));
    stage.shadow.invalidate();
    assert_eq!(stage.status(&[&slab]), ViewStatus::Drawn);
    assert!(stage.is_dark_below(0.0));
    assert_eq!(stage.status(&[&slab]), ViewStatus::Kept);
}

#[test]
fn a_scene_without_casters_is_empty_and_lit() {
    let mut stage = Stage::new();
    assert!(!stage.is_dark_below(0.0), "lit before the first frame");
    assert_eq!(stage.status(&[]), ViewStatus::Empty);
    assert!(!stage.is_dark_below(0.0));
    assert_eq!(stage.shadow.maps().views().len(), 0);
    let nothing = Watched::with_bounds(slab(stage.gpu), Aabb::EMPTY);
    assert_eq!(stage.status(&[&nothing]), ViewStatus::Empty);
    assert_eq!(nothing.draws.get(), 0);
    let report = stage.shadow.maps().report();
    assert_eq!((report.views[0].casters, report.views[0].culled), (0, 1));
}

#[test]
fn when_casters_vanish_the_old_map_is_not_asked() {
    let mut stage = Stage::new();
    let slab = slab(stage.gpu);
    assert_eq!(stage.status(&[&slab]), ViewStatus::Drawn);
    assert!(stage.is_dark_below(0.0));
    assert_eq!(stage.status(&[]), ViewStatus::Empty);
    let depths = readback::depth_layer(stage.gpu, stage.shadow.maps().texture(), 0);
    assert!(
        depths.iter().any(|depth| *depth > 0.0),
        "the layer still holds it"
    );
    assert!(!stage.is_dark_below(0.0));
    // When the slab is back, it has its shadow, whether the layer was drawn again or not.
    stage.status(&[&slab]);
    assert!(stage.is_dark_below(0.0));
}

#[test]
fn another_light_draws_again() {
    let mut stage = Stage::new();
    let slab = slab(stage.gpu);
    assert_eq!(stage.status(&[&slab]), ViewStatus::Drawn);
    // Only the direction matters, not its length.
    stage.light = LIGHT * 2.0;
    assert_eq!(stage.status(&[&slab]), ViewStatus::Kept);
    stage.light = Vec3::new(-0.5, -1.0, 0.25);
    assert_eq!(stage.status(&[&slab]), ViewStatus::Drawn);
    assert!(!stage.is_dark_below(0.0));
}

/// An engine that moves its render origin by a step that f32 represents exactly sees the same
/// world: the map is kept, and the moved receivers have the same visibilities.
#[test]
fn a_map_outlives_a_moved_origin() {
    let mut stage = Stage::new();
    let mut slab = Watched::new(slab(stage.gpu));
    slab.revision = Some(Some(Revision::new(7, 1)));
    assert_eq!(stage.status(&[&slab]), ViewStatus::Drawn);
    let step = Vec3::new(2.0, -0.5, 16.0);
    let moved = |bounds: Aabb| Aabb::new(bounds.min - step, bounds.max - step);
    stage.origin = step.as_dvec3();
    stage.coverage = Coverage::Bounds(moved(BOX));
    slab.bounds = Some(moved(slab.mesh.bounds()));
    assert_eq!(stage.status(&[&slab]), ViewStatus::Kept);
    for (x, wanted) in [(0.0, 0.0), (2.0, 1.0)] {
        let ground = Vec3::new(x, 1.0, 0.0) + LIGHT - step;
        let seen = stage.probe.ask(stage.gpu, &[Point::new(ground, Vec3::Y)])[0];
        assert!((seen - wanted).abs() < 1e-5, "{seen} at {x}");
    }
}

/// A static scene under a moving camera costs nothing while the quantized size and the position of
/// the light-space bounds still suffice.
#[test]
fn a_trembling_camera_keeps_the_map() {
    let mut stage = Stage::new();
    let pipeline = default_pipeline(stage.gpu);
    let floor = Mesh::floor(0.0, 10.0).caster(stage.gpu, &pipeline, Mat4::IDENTITY);
    let slab = slab(stage.gpu);
    let mut drawn = 0;
    for step in 0..200 {
        let phase = f64::from(step);
        let eye = DVec3::new(0.02 * phase.sin(), 4.0 + 0.01 * (phase * 1.7).cos(), 8.0);
        stage.coverage = Coverage::Camera(Camera::modern(eye, DVec3::ZERO, 0.9, 1.5).view());
        drawn += stage.record(&[&floor, &slab]).passes;
        assert!(stage.is_dark_below(0.0) && !stage.is_dark_below(2.0));
    }
    // The map is drawn in the first frame, and at most twice more, where the jitter crosses a step
    // of the depth range or of the quantized size.
    assert!((1..=3).contains(&drawn), "{drawn} passes");
}

/// Only the cascades that see a change are drawn.
#[test]
fn cascades_are_kept_one_by_one() {
    let mut stage = Stage::with_cascades(3);
    let pipeline = default_pipeline(stage.gpu);
    let camera = Camera::modern(
        DVec3::new(0.0, 3.0, 0.0),
        DVec3::new(0.0, 0.0, 20.0),
        0.8,
        1.5,
    );
    stage.coverage = Coverage::Camera(camera.view());
    let floor = Mesh::sheet(
        Vec3::new(-60.0, 0.0, 0.0),
        Vec3::new(0.0, 0.0, 200.0),
        // The floor rises, so that by its bounds it may shadow itself everywhere.
        Vec3::new(120.0, 6.0, 0.0),
    );
    let floor = floor.caster(stage.gpu, &pipeline, Mat4::IDENTITY);
    let tower = Mesh::cuboid(Vec3::new(-2.0, 0.0, 150.0), Vec3::new(2.0, 5.0, 154.0));
    let mut tower = tower.caster(stage.gpu, &pipeline, Mat4::IDENTITY);
    let near = Mesh::cuboid(Vec3::new(-0.5, 0.0, 8.0), Vec3::new(0.5, 1.0, 9.0));
    let near = near.caster(stage.gpu, &pipeline, Mat4::IDENTITY);
    let first = stage.record(&[&floor, &tower, &near]);
    assert_eq!(first.passes, 3, "{first:?}");
    tower.set_transform(shift(1.0)).expect("a finite matrix");
    let second = stage.record(&[&floor, &tower, &near]);
    let statuses: Vec<_> = second.views.iter().map(|view| view.status).collect();
    assert_eq!(statuses[0], ViewStatus::Kept, "{second:?}");
    assert_eq!(statuses[2], ViewStatus::Drawn, "{second:?}");
}

/// Uniforms are uploaded in the order of the commands: if two frames are recorded before either is
/// submitted, each sees its own.
#[test]
fn frames_in_flight_do_not_mix() {
    let mut stage = Stage::new();
    let gpu = stage.gpu;
    let slab = slab(gpu);
    let casters: [&dyn ShadowCaster; 1] = [&slab];
    let (mut first, mut second) = (gpu.encoder(), gpu.encoder());
    let mut frame = stage.frame(&casters);
    stage
        .shadow
        .record_frame(&mut first, &frame)
        .expect("a valid frame");
    frame.light = DirectionalLight::new(Vec3::new(-1.5, -1.0, 0.25));
    stage
        .shadow
        .record_frame(&mut second, &frame)
        .expect("a valid frame");
    gpu.submit(first);
    assert!(stage.is_dark_below(0.0), "the first frame's shadow");
    gpu.submit(second);
    assert!(!stage.is_dark_below(0.0) && stage.is_dark_below(-2.0));
}
