//! Plants faults into a running scene and tests that the meter notices each within 60 frames.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::library::SceneCasters;
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use shadow_support::scene::{Light, Scene};
use shadow_support::scenes;
use shadow_support::triangle::occluded;
use shadow_support::truth::World;
use wgpu_shadows::meter::{ErrorMeter, Estimate, Receiver};
use wgpu_shadows::{Aabb, Bias, Coverage, DirectionalShadowDescriptor, Revision, ShadowCaster};

use crate::fixtures::gpu::gpu;
use crate::fixtures::meter::{Metered, View, drawn, visible};
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::watched::Watched;

/// Is the number of places of a frame.
const PLACES: usize = 64;

/// Is a scene of boxes with what a camera sees of it.
struct Stage {
    scene: Scene,
    /// Are places of the floor.
    receivers: Vec<Receiver>,
    random: Random,
}

impl Stage {
    fn new() -> Self {
        let scene = scenes::boxes("boxes", DVec3::ZERO);
        let mut receivers = visible(&scene, &World::new(&scene), [160, 90]);
        receivers.retain(|receiver| receiver.normal.y > 0.999 && receiver.position_render.y < 0.01);
        Self {
            receivers,
            scene,
            random: Random::new(11),
        }
    }

    fn light(&self, bias: Bias) -> Metered {
        let Light::Sun { direction, .. } = self.scene.light else {
            panic!("the scene has a sun");
        };
        let descriptor = DirectionalShadowDescriptor {
            bias,
            ..Default::default()
        };
        Metered::sun(gpu(), direction.as_dvec3(), &descriptor)
    }

    /// Returns the index of the box whose shadow covers most of the places.
    fn most_visible_shadow(&self) -> usize {
        let Light::Sun { direction, .. } = self.scene.light else {
            panic!("the scene has a sun");
        };
        let shadowed = |mesh: &Mesh| {
            let triangles = mesh.triangles(&Mat4::IDENTITY);
            let places = self.receivers.iter();
            let places = places.map(|receiver| receiver.position_render.as_dvec3());
            places
                .filter(|place| occluded(&triangles, *place, -direction.as_dvec3(), 1e-3))
                .count()
        };
        let meshes = self.scene.meshes.iter().enumerate();
        let most = meshes.max_by_key(|(_, mesh)| shadowed(mesh));
        most.expect("a mesh").0
    }

    /// Measures frames until `until` holds, at most `frames`. Returns their number and the last
    /// estimate.
    fn run(
        &mut self,
        (light, meter): (&mut Metered, &mut ErrorMeter),
        [casters, all_casters]: [&[&dyn ShadowCaster]; 2],
        frames: u32,
        until: impl Fn(&Estimate) -> bool,
    ) -> (u32, Estimate) {
        let view = View {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(std::slice::from_ref(&self.scene.camera)),
            casters,
            all_casters,
        };
        for frame in 1..=frames {
            let places = drawn(&self.receivers, PLACES, &mut self.random);
            let report = light.measure(gpu(), meter, &view, &places);
            assert_eq!(report.expect("a frame").passes, 2);
            let rmse = meter.measured().rmse;
            if until(&rmse) || frame == frames {
                return (frame, rmse);
            }
        }
        unreachable!("the last frame returns");
    }
}

/// Tests that an error is noticed: the lower end of its interval exceeds the upper end of that of
/// `before`.
fn assert_noticed(what: &str, before: &Estimate, (frames, after): (u32, Estimate)) {
    println!("{what}: noticed after {frames} frames, {before:?} before, {after:?} after");
    assert!(
        after.low > before.high,
        "{what}: {before:?} before, {after:?} after {frames} frames"
    );
}

/// Is the number of frames within which a fault is to be noticed.
const FRAMES: u32 = 60;

/// Is the number of frames before it.
const FRAMES_BEFORE: u32 = 100;

/// Boxes move within their bounds while the engine does not change their revisions, so that the
/// map is kept.
#[test]
fn stale_maps_are_noticed() {
    let mut stage = Stage::new();
    let pipeline = default_pipeline(gpu());
    let shift = Vec3::new(2.0, 0.0, 0.0);
    let meshes = (0..).zip(&stage.scene.meshes);
    let mut casters: Vec<_> = meshes
        .map(|(index, mesh)| {
            let moved = Aabb::new(mesh.bounds().min + shift, mesh.bounds().max + shift);
            let drawn = mesh.caster(gpu(), &pipeline, Mat4::IDENTITY);
            Watched {
                bounds: Some(mesh.bounds().union(moved)),
                ..Watched::with_revision(drawn, Some(Revision::new(index, 0)))
            }
        })
        .collect();
    let mut light = stage.light(Bias::Auto);
    let mut meter = light.meter(PLACES as u32);
    let list: Vec<&dyn ShadowCaster> = casters.iter().map(|caster| caster as _).collect();
    let watched = (&mut light, &mut meter);
    let (_, before) = stage.run(watched, [&list, &list], FRAMES_BEFORE, |_| false);
    for caster in &mut casters[1..] {
        let transform = Mat4::from_translation(shift);
        caster
            .mesh
            .set_transform(transform)
            .expect("a finite matrix");
    }
    let list: Vec<&dyn ShadowCaster> = casters.iter().map(|caster| caster as _).collect();
    let watched = (&mut light, &mut meter);
    let noticed = stage.run(watched, [&list, &list], FRAMES, |rmse| {
        rmse.low > before.high
    });
    assert_noticed("stale maps", &before, noticed);
}

/// A caster is missing from the frame that the light is recorded with.
#[test]
fn missing_casters_are_noticed() {
    let mut stage = Stage::new();
    let casters = SceneCasters::new(gpu(), &stage.scene);
    let list = casters.list();
    let mut light = stage.light(Bias::Auto);
    let mut meter = light.meter(PLACES as u32);
    let watched = (&mut light, &mut meter);
    let (_, before) = stage.run(watched, [&list, &list], FRAMES_BEFORE, |_| false);
    let mut incomplete = list.clone();
    incomplete.remove(stage.most_visible_shadow());
    let watched = (&mut light, &mut meter);
    let noticed = stage.run(watched, [&incomplete, &list], FRAMES, |rmse| {
        rmse.low > before.high
    });
    assert_noticed("a missing caster", &before, noticed);
}

/// A bias of half a metre, tuned for another scene, lets light in at the feet of the boxes.
#[test]
fn a_wrong_bias_is_noticed() {
    let mut stage = Stage::new();
    let casters = SceneCasters::new(gpu(), &stage.scene);
    let list = casters.list();
    let mut right = stage.light(Bias::Auto);
    let mut meter = right.meter(PLACES as u32);
    let watched = (&mut right, &mut meter);
    let (_, before) = stage.run(watched, [&list, &list], FRAMES_BEFORE, |_| false);
    let mut wrong = stage.light(Bias::Manual {
        constant: 0.5,
        slope: 0.0,
    });
    let mut meter = wrong.meter(PLACES as u32);
    let watched = (&mut wrong, &mut meter);
    let noticed = stage.run(watched, [&list, &list], FRAMES, |rmse| {
        rmse.low > before.high
    });
    assert_noticed("a wrong bias", &before, noticed);
    let measured = meter.measured();
    let (light, shadow) = (measured.false_light, measured.false_shadow);
    assert!(light.value > 2.0 * shadow.value, "{light:?}, {shadow:?}");
}
