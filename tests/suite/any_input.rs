//! Puts numbers of any magnitude and sign, finite or not, into every field of a frame: each call
//! returns a result or an error, never panics, and causes no error of the device.

use glam::{DVec3, Mat4, Vec3, Vec4};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CameraView, CascadeLayout, CascadeSplit, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, ShadowCaster,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::report::assert_whole;
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::watched::Watched;

/// Draws numbers, of which one in `tameness` is unusual and one more has random bits.
struct Numbers {
    random: Random,
    tameness: usize,
}

impl Numbers {
    fn one(&mut self) -> f32 {
        const ODD: [f32; 7] = [
            0.0,
            f32::NAN,
            f32::INFINITY,
            f32::MAX,
            f32::MIN_POSITIVE,
            1e-45,
            -1e30,
        ];
        match self.random.index(self.tameness) {
            0 => ODD[self.random.index(ODD.len())],
            1 => f32::from_bits(self.random.bits() as u32),
            _ => self.random.range(-10.0, 10.0) as f32,
        }
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.one()))
    }

    fn matrix(&mut self) -> Mat4 {
        let columns = [(); 4].map(|()| Vec4::from((self.vector(), self.one())));
        Mat4::from_cols(columns[0], columns[1], columns[2], columns[3])
    }

    fn camera(&mut self) -> CameraView {
        let fine = Camera::modern(DVec3::ZERO, DVec3::Z, 1.0, 1.0).view();
        let whole = self.random.index(2) == 0;
        CameraView {
            view_from_render: Mat4::from_translation(self.vector()),
            clip_from_view: if whole {
                fine.clip_from_view
            } else {
                self.matrix()
            },
            max_distance: self.one().abs(),
        }
    }
}

#[test]
fn no_frame_breaks_a_sun() {
    let gpu = gpu();
    let descriptor = DirectionalShadowDescriptor {
        map_size: 32,
        layout: CascadeLayout::Fixed {
            cascades: 3,
            split: CascadeSplit::Practical { lambda: 0.5 },
        },
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let probe = SunProbe::new(gpu, &shadow);
    let pipeline = default_pipeline(gpu);
    let mesh = Mesh::cuboid(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 1.2, 1.0));
    let (mut accepted, mut refused) = (0, 0);
    for case in 0..600 {
        let mut numbers = Numbers {
            random: Random::new(case),
            // Every third frame contains mostly ordinary numbers, since few would be accepted
            // otherwise.
            tameness: if case % 3 == 0 { 60 } else { 6 },
        };
        let low = numbers.vector();
        let bounds = Aabb::new(low, low + numbers.vector().abs());
        let slab = Watched::with_bounds(mesh.caster(gpu, &pipeline, Mat4::IDENTITY), bounds);
        let casters: [&dyn ShadowCaster; 1] = [&slab];
        let receivers = [Aabb::new(numbers.vector(), numbers.vector())];
        let frame = DirectionalFrame {
            origin: numbers.vector().as_dvec3(),
            light: DirectionalLight {
                direction: numbers.vector(),
                up: numbers.vector(),
            },
            coverage: if case % 2 == 0 {
                Coverage::Bounds(bounds)
            } else {
                Coverage::Camera(numbers.camera())
            },
            casters: &casters,
            receivers: &receivers,
        };
        let mut encoder = gpu.encoder();
        let result = shadow.record_frame(&mut encoder, &frame);
        let count = if result.is_ok() {
            &mut accepted
        } else {
            &mut refused
        };
        *count += 1;
        if let Ok(report) = result {
            assert_whole(report, &format!("case {case}"));
        }
        gpu.submit(encoder);
        let points = [Point::new(numbers.vector(), numbers.vector())];
        let seen = probe.ask(gpu, &points)[0];
        assert!((0.0..=1.0).contains(&seen), "case {case}: {seen}");
    }
    assert!(
        accepted > 100 && refused > 100,
        "{accepted} accepted, {refused} refused"
    );
    // A valid frame after all of these still has its shadow.
    let slab = mesh.caster(gpu, &pipeline, Mat4::IDENTITY);
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::NEG_Y),
        coverage: Coverage::Bounds(Aabb::new(Vec3::splat(-3.0), Vec3::splat(3.0))),
        casters: &[&slab],
        receivers: &[],
    };
    record(gpu, &mut shadow, &frame);
    let points = [Point::new(Vec3::ZERO, Vec3::Y)];
    assert_eq!(probe.ask(gpu, &points), [0.0]);
}
