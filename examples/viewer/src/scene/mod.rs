//! Builds the scenes, as triangles and where they stand.
//!
//! ```text
//! textbook.rs   the tutorial's floor and cubes
//! town.rs       a town with a walker
//! hall.rs       a hall of lamps
//! grove.rs      trees whose leaves are cut out of cards
//! penumbrae.rs  poles, slats and balls under a large light
//! sky.rs        a sky dome and a ground of ten kilometres
//! file.rs       a glTF file
//! ```

mod file;
mod grove;
pub mod hall;
mod penumbrae;
mod sky;
mod textbook;
mod town;

use example_support::mesh::{Instance, Vertex};
use glam::{Mat4, Vec3};
use shadow_support::triangle::Triangle;
use wgpu_shadows::Aabb;

#[cfg(target_arch = "wasm32")]
pub use file::from_bytes;
#[cfg(not(target_arch = "wasm32"))]
pub use file::from_path;

use crate::settings::{SUN_DEGREES, Settings, Show, SideSettings};
use crate::viewpoint::Viewpoint;

/// Holds a scene.
pub struct Scene {
    pub name: String,
    pub models: Vec<Model>,
    pub viewpoint: Viewpoint,
    pub toward_sun: Vec3,
    /// Is the angular diameter of the sun in degrees.
    pub sun_degrees: f32,
    pub light: Light,
    /// Is the size in world units of what is looked at, from which the truth takes its measure.
    pub extent: f32,
    /// Is the textbook's technique and the library's for this scene.
    pub sides: [SideSettings; 2],
    /// States that the hall's spots and lamps shine.
    pub has_lamps: bool,
    /// Lists what a file lacks.
    pub notes: Vec<String>,
}

/// Is the colours of the light.
#[derive(Clone, Copy)]
pub struct Light {
    pub sun: Vec3,
    pub ambient: Vec3,
    pub sky: Vec3,
    /// Is the distance in world units over which the haze takes all but 37 % of the light.
    pub haze: f32,
}

/// Is a mesh with its instances.
pub struct Model {
    pub vertices: Vec<Vertex>,
    pub instances: Vec<Instance>,
    pub role: Role,
    /// Returns the instances at a time in seconds, for a model that moves.
    pub path: Option<fn(f32) -> Vec<Instance>>,
}

/// States what a model does with light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Casts and receives shadows.
    Solid,
    /// Is the outlines of [`leaves`](crate::leaves), which cast and receive.
    Leaves,
    /// Only receives.
    Ground,
    /// Does neither: a sky, or a lamp.
    Glow,
}

/// Marks an instance that is drawn in its own colour, whatever the light; its place is where
/// others have the contrast of their squares.
pub const UNLIT: f32 = -1.0;

/// Lists the names of the built-in scenes.
pub const NAMES: [&str; 6] = ["textbook", "town", "hall", "penumbrae", "sky", "grove"];

/// Returns a built-in scene.
pub fn built_in(name: &str) -> Option<Scene> {
    Some(match name {
        "textbook" => textbook::scene(),
        "town" => town::scene(),
        "hall" => hall::scene(),
        "penumbrae" => penumbrae::scene(),
        "sky" => sky::scene(),
        "grove" => grove::scene(),
        _ => return None,
    })
}

impl Light {
    const DAY: Self = Self {
        sun: Vec3::new(1.15, 1.0, 0.80),
        ambient: Vec3::new(0.14, 0.18, 0.25),
        sky: Vec3::new(0.45, 0.58, 0.75),
        haze: f32::INFINITY,
    };
}

impl Scene {
    /// Returns the settings that the scene begins with.
    pub fn settings(&self) -> Settings {
        let mut settings = Settings {
            scene: self.name.clone(),
            viewpoint: self.viewpoint,
            elevation_degrees: 0.0,
            azimuth_degrees: 0.0,
            sun_degrees: self.sun_degrees,
            show: Show::Scene,
            is_split: true,
            divider: 0.5,
            picture_scale: 1.0,
            sides: self.sides,
        };
        settings.set_toward_sun(self.toward_sun);
        settings
    }

    /// Returns the bounds of what casts or receives.
    pub fn bounds(&self) -> Aabb {
        self.models
            .iter()
            .filter(|model| model.role != Role::Glow)
            .map(Model::bounds)
            .fold(Aabb::EMPTY, Aabb::union)
    }

    /// Returns whether something moves by itself.
    pub fn moves(&self) -> bool {
        self.has_lamps || self.models.iter().any(|model| model.path.is_some())
    }

    /// Returns the triangles that cast or receive at a time in seconds.
    pub fn triangles(&self, time: f32) -> Vec<Triangle> {
        let models = self.models.iter().filter(|model| model.role != Role::Glow);
        models.flat_map(|model| model.triangles(time)).collect()
    }
}

impl Model {
    fn solid(vertices: Vec<Vertex>, instances: Vec<Instance>) -> Self {
        Self::of(Role::Solid, vertices, instances)
    }

    fn of(role: Role, vertices: Vec<Vertex>, instances: Vec<Instance>) -> Self {
        Self {
            vertices,
            instances,
            role,
            path: None,
        }
    }

    /// Returns the bounds of all instances as they are at the start.
    pub fn bounds(&self) -> Aabb {
        let model = Aabb::from_points(self.vertices.iter().map(|vertex| vertex.position));
        let instances = self.instances.iter();
        instances
            .map(|instance| model.transformed(&instance.render_from_model))
            .fold(Aabb::EMPTY, Aabb::union)
    }

    fn triangles(&self, time: f32) -> impl Iterator<Item = Triangle> {
        let instances = match self.path {
            Some(path) => path(time),
            None => self.instances.clone(),
        };
        instances.into_iter().flat_map(move |instance| {
            let matrix = instance.render_from_model.as_dmat4();
            self.vertices.chunks_exact(3).map(move |corners| {
                Triangle(
                    [0, 1, 2]
                        .map(|corner| matrix.transform_point3(corners[corner].position.as_dvec3())),
                )
            })
        })
    }
}

/// Returns an instance of a plain colour.
fn plain(render_from_model: Mat4, albedo: Vec3) -> Instance {
    Instance {
        render_from_model,
        albedo,
        checker: 0.0,
    }
}

/// Returns an instance of the cube from -1 to 1: a box with this middle and half its size.
fn cuboid(center: Vec3, half: Vec3, albedo: Vec3) -> Instance {
    plain(
        Mat4::from_translation(center) * Mat4::from_scale(half),
        albedo,
    )
}

/// Returns a scene by day, with the sun's own size.
fn day(name: &str, models: Vec<Model>, viewpoint: Viewpoint, toward_sun: Vec3) -> Scene {
    Scene {
        name: name.to_owned(),
        models,
        viewpoint,
        toward_sun,
        sun_degrees: SUN_DEGREES,
        light: Light::DAY,
        extent: 20.0,
        sides: [SideSettings::textbook(10.0), SideSettings::library()],
        has_lamps: false,
        notes: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_is_whole_and_seen() {
        for name in NAMES {
            let scene = built_in(name).expect("a scene of that name");
            assert_eq!(scene.name, name);
            let bounds = scene.bounds();
            assert!(bounds.min.is_finite() && bounds.max.is_finite(), "{name}");
            assert!(
                scene.toward_sun.y > 0.0,
                "{name}: the sun is below the horizon"
            );
            for model in &scene.models {
                assert!(
                    !model.vertices.is_empty() && model.vertices.len() % 3 == 0,
                    "{name}"
                );
                assert!(!model.instances.is_empty(), "{name}");
                if let Some(path) = model.path {
                    // The number of instances is that of the buffer.
                    assert_eq!(path(1.7).len(), model.instances.len(), "{name}");
                }
            }
            let settings = scene.settings();
            let angle = settings
                .toward_sun()
                .angle_between(scene.toward_sun.normalize());
            // The angle of two unit vectors in f32 is known to the root of its epsilon.
            assert!(angle < 4.0 * f32::EPSILON.sqrt(), "{name}: {angle}");
        }
        assert!(built_in("nowhere").is_none());
    }

    #[test]
    fn triangles_follow_what_moves() {
        let town = built_in("town").expect("a scene");
        assert!(town.moves());
        let [start, later] = [0.0, 3.0].map(|time| town.triangles(time));
        assert_eq!(start.len(), later.len());
        let moved = start.iter().zip(&later).filter(|(a, b)| a.0 != b.0).count();
        // Five boxes of 12 triangles, and a head of 8 rings of 16 quadrilaterals.
        assert_eq!(moved, 5 * 12 + 8 * 16 * 2);
    }
}
