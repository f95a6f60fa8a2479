//! Provides a sun, its probe, and boxes on a floor whose truth is known.

use glam::{DMat3, DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CascadeLayout, CascadeSplit, CasterPipeline, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, MeshCaster, ShadowCaster, caster::caster_shape,
    report::ShadowReport,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::random_scene::World;
use crate::fixtures::scene::{Scene, default_pipeline};

/// Bounds the rounding of a sum of at most 64 weights in f32, stretched three times by the
/// default's sharpness.
pub const SUM_ERROR: f32 = 192.0 * f32::EPSILON;

/// Is the distance in texels of a settled receiver from every edge of a shadow: the default kernel
/// reaches 2 per axis, at most 2.83 to its corner; the rest is for the snapping of vertices.
pub const MARGIN: f64 = 3.0;

/// Holds a sun with the probe that samples it.
pub struct Sun {
    pub shadow: DirectionalShadow,
    pub probe: SunProbe,
}

impl Sun {
    pub fn new(descriptor: &DirectionalShadowDescriptor<'_>) -> Self {
        let gpu = gpu();
        let shadow = DirectionalShadow::new(&gpu.device, descriptor).expect("a valid sun");
        Self {
            probe: SunProbe::new(gpu, &shadow),
            shadow,
        }
    }

    /// Makes a sun with one map and the default filter.
    pub fn of_size(map_size: u32) -> Self {
        Self::new(&DirectionalShadowDescriptor {
            map_size,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        })
    }

    pub fn record(
        &mut self,
        origin: DVec3,
        light: DirectionalLight,
        coverage: Coverage,
        casters: &[&dyn ShadowCaster],
        receivers: &[Aabb],
    ) -> ShadowReport {
        let frame = DirectionalFrame {
            origin,
            light,
            coverage,
            casters,
            receivers,
        };
        record(gpu(), &mut self.shadow, &frame)
    }

    pub fn ask(&self, points: &[Point]) -> Vec<f32> {
        self.probe.ask(gpu(), points)
    }

    /// Returns the side of a texel of the first view.
    pub fn texel(&self) -> f64 {
        let view = self.shadow.maps().views().next().expect("a view");
        f64::from(view.texel_size_world().max_element())
    }
}

/// Returns boxes on, above and high above a floor at height zero, off every dyadic grid.
pub fn boxes() -> Vec<(DVec3, DVec3)> {
    let mut random = Random::new(17);
    let base = [0.0, 0.0, 0.0, 0.71, 1.37, 2.93];
    base.iter()
        .map(|base| {
            let low = random.point(DVec3::new(-5.3, 0.0, -5.3), DVec3::new(4.1, 0.0, 4.1));
            let size = random.point(DVec3::splat(0.43), DVec3::new(1.6, 2.1, 1.6));
            let low = (low.with_y(*base)).as_vec3().as_dvec3();
            (low, (low + size).as_vec3().as_dvec3())
        })
        .collect()
}

/// Returns the boxes as a world, for its truth.
pub fn world(light: DVec3, camera: Camera) -> World {
    World {
        boxes: boxes(),
        light: light.normalize().as_vec3().as_dvec3(),
        camera,
        max_distance: f64::INFINITY,
        cascades: 1,
        split: CascadeSplit::Logarithmic,
        floor_casts: true,
    }
}

/// Returns a camera for worlds that are not looked at.
pub fn any_camera() -> Camera {
    Camera::modern(DVec3::new(9.0, 7.0, 11.0), DVec3::ZERO, 1.0, 1.5)
}

/// Returns the meshes of `boxes` and of a floor that extends `half` from the middle, rotated by
/// `turn` and moved by `shift`.
pub fn meshes(boxes: &[(DVec3, DVec3)], half: f32, turn: DMat3, shift: DVec3) -> Vec<Mesh> {
    let cuboids = boxes
        .iter()
        .map(|(low, high)| Mesh::cuboid(low.as_vec3(), high.as_vec3()));
    cuboids
        .chain([Mesh::floor(0.0, half)])
        .map(|mut mesh| {
            for position in &mut mesh.positions {
                *position = (turn * position.as_dvec3() + shift).as_vec3();
            }
            mesh
        })
        .collect()
}

/// Returns the bounds of all of `meshes`.
pub fn bounds_of(meshes: &[Mesh]) -> Aabb {
    meshes
        .iter()
        .fold(Aabb::EMPTY, |all, mesh| all.union(mesh.bounds()))
}

pub fn scene(meshes: &[Mesh]) -> Scene {
    Scene::new(gpu(), meshes)
}

/// Returns a mesh as the only caster.
pub fn caster(gpu: &Gpu, mesh: &Mesh, transform: Mat4) -> MeshCaster {
    mesh.caster(gpu, &default_pipeline(gpu), transform)
}

/// Returns a caster whose shape is the one that `caster_shape` finds for its mesh.
pub fn shaped(mesh: &Mesh, pipeline: &CasterPipeline) -> MeshCaster {
    let mut caster = mesh.caster(gpu(), pipeline, Mat4::IDENTITY);
    caster.set_shape(caster_shape(&mesh.positions, &mesh.indices));
    caster
}

/// Returns what `dark` says of a position on level ground, if it says the same `margin` around it.
pub fn settled(dark: impl Fn(DVec3) -> bool, position: DVec3, margin: f64) -> Option<bool> {
    let here = dark(position);
    let is_unchanged = (0..12).all(|step| {
        let angle = f64::from(step) * std::f64::consts::TAU / 12.0;
        dark(position + DVec3::new(angle.cos(), 0.0, angle.sin()) * margin) == here
    });
    is_unchanged.then_some(here)
}

/// Returns whether two visibilities are further apart than `band`, or are NaN.
pub fn differ(a: f32, b: f32, band: f32) -> bool {
    !(0.0..=band).contains(&(a - b).abs())
}

/// Counts what was found at receivers whose truth is settled.
#[derive(Clone, Copy, Debug, Default)]
pub struct Verdict {
    pub dark: usize,
    pub lit: usize,
    pub undecided: usize,
    pub wrong: usize,
}

impl Verdict {
    /// Compares the visibilities of receivers at `places` with the truth, where that is settled for
    /// `margin` texels around.
    pub fn of(world: &World, places: &[DVec3], seen: &[f32], texel: f64, margin: f64) -> Self {
        let mut verdict = Self::default();
        for (place, seen) in places.iter().zip(seen) {
            verdict.count(world.truth(*place, texel, margin), *seen);
        }
        verdict
    }

    pub fn count(&mut self, truth: Option<bool>, seen: f32) {
        let wanted = match truth {
            None => {
                self.undecided += 1;
                return;
            }
            Some(true) => 0.0,
            Some(false) => 1.0,
        };
        self.dark += usize::from(wanted == 0.0);
        self.lit += usize::from(wanted == 1.0);
        self.wrong += usize::from(differ(seen, wanted, SUM_ERROR));
    }

    /// Asserts that nothing is wrong, and that there were enough receivers of each kind.
    pub fn assert_right(&self, what: &str) {
        let enough = self.dark.min(self.lit) >= 20;
        assert!(
            self.wrong == 0 && enough,
            "{what} on {}: {self:?}",
            gpu().describe()
        );
    }

    /// Returns the counts in words, for the table.
    pub fn words(&self) -> String {
        let settled = self.dark + self.lit;
        format!("{} wrong of {settled} settled receivers", self.wrong)
    }

    pub fn add(&mut self, other: &Self) {
        self.dark += other.dark;
        self.lit += other.lit;
        self.undecided += other.undecided;
        self.wrong += other.wrong;
    }
}

/// Returns a light along `light` with +Y as the up axis.
pub fn shining(light: DVec3) -> DirectionalLight {
    DirectionalLight::new(light.as_vec3())
}

/// Returns level receivers at `places`, moved by `shift`.
pub fn level(places: &[DVec3], shift: DVec3) -> Vec<Point> {
    places
        .iter()
        .map(|place| Point::new((*place + shift).as_vec3(), Vec3::Y))
        .collect()
}
