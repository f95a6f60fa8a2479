//! Tests bad frames of a sun: each is refused with field and value, nothing of it is recorded, and
//! the last valid shadows remain.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use wgpu_shadows::{
    Aabb, CameraView, CascadeLayout, Casters, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, ShadowCaster, ShadowError, ShadowFrameDescriptor, ShadowScene,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::watched::Watched;

const BOX: Aabb = Aabb::new(Vec3::new(-4.0, -0.5, -4.0), Vec3::new(4.0, 4.0, 4.0));
const NAN: Vec3 = Vec3::new(f32::NAN, 2.0, 3.0);

fn slab() -> Watched {
    let mesh = Mesh::cuboid(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 1.2, 1.0));
    Watched::new(mesh.caster(gpu(), &default_pipeline(gpu()), Mat4::IDENTITY))
}

fn good_frame<'a>(casters: &'a [&'a dyn ShadowCaster]) -> DirectionalFrame<'a> {
    DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::NEG_Y),
        coverage: Coverage::Bounds(BOX),
        casters,
        receivers: &[],
    }
}

/// Holds a sun that has recorded a valid frame.
struct Stage {
    shadow: DirectionalShadow,
    probe: SunProbe,
    good: Watched,
}

impl Stage {
    fn new() -> Self {
        let descriptor = DirectionalShadowDescriptor {
            map_size: 64,
            layout: CascadeLayout::fixed(2),
            ..Default::default()
        };
        let mut shadow = DirectionalShadow::new(&gpu().device, &descriptor).expect("a valid sun");
        let good = slab();
        let report = record(gpu(), &mut shadow, &good_frame(&[&good]));
        assert_eq!((report.passes, good.draws.get()), (1, 1));
        Self {
            probe: SunProbe::new(gpu(), &shadow),
            shadow,
            good,
        }
    }

    fn assert_good_shadows(&self) {
        let points = [
            Point::new(Vec3::ZERO, Vec3::Y),
            Point::new(Vec3::new(2.5, 0.0, 0.0), Vec3::Y),
        ];
        assert_eq!(self.probe.ask(gpu(), &points), [0.0, 1.0]);
    }

    /// Records a bad frame, submits the encoder all the same, and checks that it had no effect.
    fn refuse(&mut self, frame: &DirectionalFrame<'_>) -> ShadowError {
        let before = (
            self.shadow.maps().report().clone(),
            self.shadow.maps().view_uniforms().to_vec(),
        );
        let mut encoder = gpu().encoder();
        let result = self.shadow.record_frame(&mut encoder, frame);
        let error = result.expect_err("a bad frame").clone();
        gpu().submit(encoder);
        let after = (
            self.shadow.maps().report().clone(),
            self.shadow.maps().view_uniforms().to_vec(),
        );
        assert_eq!(before, after, "{error}");
        self.assert_good_shadows();
        // The map is still known to be valid: the same valid frame again takes no pass.
        let again = record(gpu(), &mut self.shadow, &good_frame(&[&self.good]));
        assert_eq!((again.passes, self.good.draws.get()), (0, 1), "{error}");
        error
    }

    fn assert_refused(
        &mut self,
        frame: &DirectionalFrame<'_>,
        wanted: &ShadowError,
        message: &str,
    ) {
        let error = self.refuse(frame);
        assert_eq!(&error, wanted);
        assert_eq!(error.to_string(), message);
    }
}

#[test]
fn numbers_that_are_not_finite() {
    let mut stage = Stage::new();
    let slab = slab();
    let casters: [&dyn ShadowCaster; 1] = [&slab];
    let good = good_frame(&casters);
    let with_light = |direction, up| DirectionalFrame {
        light: DirectionalLight { direction, up },
        ..good
    };
    let bad_origin = DirectionalFrame {
        origin: DVec3::new(0.0, f64::INFINITY, 0.0),
        ..good
    };
    let cases = [
        (bad_origin, "ShadowFrameDescriptor::origin", "[0, inf, 0]"),
        (
            with_light(NAN, Vec3::Y),
            "DirectionalLight::direction",
            "[NaN, 2, 3]",
        ),
        (
            with_light(Vec3::NEG_Y, Vec3::X * f32::NEG_INFINITY),
            "DirectionalLight::up",
            "[-inf, NaN, NaN]",
        ),
    ];
    for (frame, field, value) in cases {
        let wanted = ShadowError::NotFinite {
            field,
            value: value.to_owned(),
        };
        let message = format!("{field} must be finite, got {value}");
        stage.assert_refused(&frame, &wanted, &message);
    }
    assert_eq!(slab.draws.get(), 0);
}

#[test]
fn directions_without_length() {
    let mut stage = Stage::new();
    let slab = slab();
    let casters: [&dyn ShadowCaster; 1] = [&slab];
    let good = good_frame(&casters);
    let cases = [
        (Vec3::ZERO, Vec3::Y, "DirectionalLight::direction"),
        (Vec3::NEG_Y, Vec3::ZERO, "DirectionalLight::up"),
    ];
    for (direction, up, field) in cases {
        let frame = DirectionalFrame {
            light: DirectionalLight { direction, up },
            ..good
        };
        let message = format!("{field} must not have length zero");
        stage.assert_refused(&frame, &ShadowError::ZeroDirection { field }, &message);
    }
}

#[test]
fn a_covered_box_that_is_not_finite() {
    let mut stage = Stage::new();
    let slab = slab();
    let casters: [&dyn ShadowCaster; 1] = [&slab];
    let endless = Aabb::new(Vec3::ZERO, Vec3::splat(f32::INFINITY));
    let field = "ShadowFrameDescriptor::coverage";
    let value = "[0, 0, 0]..[inf, inf, inf]";
    let frame = DirectionalFrame {
        coverage: Coverage::Bounds(endless),
        ..good_frame(&casters)
    };
    let wanted = ShadowError::BoundsNotFinite {
        field,
        value: value.to_owned(),
    };
    let message = format!("{field} must have finite corners, got {value}");
    stage.assert_refused(&frame, &wanted, &message);
    assert_eq!(slab.draws.get(), 0);
}

#[test]
fn cameras_that_see_nothing() {
    let mut stage = Stage::new();
    let slab = slab();
    let casters: [&dyn ShadowCaster; 1] = [&slab];
    let camera = Camera::modern(DVec3::new(0.0, 3.0, 6.0), DVec3::ZERO, 0.8, 1.0).view();
    let flat = Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0));
    let matrices = [
        (
            CameraView {
                view_from_render: Mat4::NAN,
                ..camera
            },
            "CameraView::view_from_render",
            Mat4::NAN,
        ),
        (
            CameraView {
                view_from_render: flat,
                ..camera
            },
            "CameraView::view_from_render",
            flat,
        ),
        (
            CameraView {
                clip_from_view: Mat4::ZERO,
                ..camera
            },
            "CameraView::clip_from_view",
            Mat4::ZERO,
        ),
    ];
    for (view, field, matrix) in matrices {
        let frame = DirectionalFrame {
            coverage: Coverage::Camera(view),
            ..good_frame(&casters)
        };
        let value = matrix.to_string();
        let message = format!("{field} of camera 0 must be finite and invertible, got {value}");
        let wanted = ShadowError::CameraMatrix {
            field,
            camera: 0,
            value,
        };
        stage.assert_refused(&frame, &wanted, &message);
    }
    for distance in [0.0, -3.5, f32::NAN, f32::NEG_INFINITY] {
        let frame = DirectionalFrame {
            coverage: Coverage::Camera(camera.with_max_distance(distance)),
            ..good_frame(&casters)
        };
        let wanted = ShadowError::OutOfRange {
            field: "CameraView::max_distance",
            rule: "above 0 (infinity allowed)",
            value: distance.to_string(),
        };
        let message =
            format!("CameraView::max_distance must be above 0 (infinity allowed), got {distance}");
        stage.assert_refused(&frame, &wanted, &message);
    }
}

#[test]
fn views_that_f32_cannot_hold() {
    let mut stage = Stage::new();
    let mut slab = slab();
    let huge = Aabb::new(Vec3::splat(-1e30), Vec3::splat(1e30));
    slab.bounds = Some(huge);
    let casters: [&dyn ShadowCaster; 1] = [&slab];
    let frame = DirectionalFrame {
        coverage: Coverage::Bounds(huge),
        ..good_frame(&casters)
    };
    let error = stage.refuse(&frame);
    let ShadowError::ViewNotRepresentable {
        extent_world,
        distance_world,
        coordinate_world,
    } = error
    else {
        panic!("{error:?}");
    };
    assert!(
        extent_world >= 2e30 && distance_world.is_finite(),
        "{error}"
    );
    let message = format!(
        "the fitted view must be representable in f32 and f64, got an extent of {extent_world} world units at {distance_world} from the render origin and {coordinate_world} from the world origin"
    );
    assert_eq!(error.to_string(), message);
}

/// Errors of a frame name the camera, of several, that is invalid.
#[test]
fn errors_name_the_camera() {
    let good = CameraView::new(Mat4::IDENTITY, Mat4::IDENTITY);
    let bad = CameraView::new(Mat4::IDENTITY, Mat4::ZERO);
    let mut scene = ShadowScene::new();
    let error = scene
        .frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: wgpu_shadows::Coverage::Cameras(&[good, good, bad]),
            casters: Casters::List(&[]),
            receivers: &[],
        })
        .err()
        .expect("a camera without volume");
    let wanted = ShadowError::CameraMatrix {
        field: "CameraView::clip_from_view",
        camera: 2,
        value: Mat4::ZERO.to_string(),
    };
    assert_eq!(error, wanted);
    assert!(
        error
            .to_string()
            .starts_with("CameraView::clip_from_view of camera 2 must be")
    );
}
