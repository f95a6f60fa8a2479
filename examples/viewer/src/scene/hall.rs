//! Builds a hall with a sun through its skylight, four spots and 32 lamps.

use example_support::hall::lights::{Lights, TOWARD_SUN};
use example_support::hall::{EYE, FIELD_OF_VIEW_RADIANS, TARGET, parts};
use example_support::mesh::{Instance, sphere};
use glam::{Mat4, Vec3};

use super::{Light, Model, Role, Scene, day};
use crate::descriptor::LAMP_RADIUS;
use crate::settings::SideSettings;
use crate::viewpoint::Viewpoint;

/// Is the number of steps of the lights' motion in a second.
pub const STEPS_PER_SECOND: f32 = 2.0;

pub fn scene() -> Scene {
    let mut models: Vec<Model> = parts()
        .into_iter()
        .map(|(mesh, instance)| Model::solid(mesh, vec![instance]))
        .collect();
    models.push(Model {
        path: Some(bulbs),
        ..Model::of(Role::Glow, sphere(10), bulbs(0.0))
    });
    let viewpoint = Viewpoint::new(EYE, TARGET, FIELD_OF_VIEW_RADIANS);
    Scene {
        light: Light {
            sun: Vec3::new(1.05, 0.98, 0.86),
            ambient: Vec3::splat(0.035),
            sky: Vec3::new(0.45, 0.60, 0.80),
            haze: f32::INFINITY,
        },
        extent: 26.0,
        sides: [SideSettings::textbook(9.0), SideSettings::library()],
        has_lamps: true,
        ..day("hall", models, viewpoint, TOWARD_SUN)
    }
}

/// Returns glowing balls at the lamps. They cast nothing, since their light comes from inside.
fn bulbs(time: f32) -> Vec<Instance> {
    let lights = Lights::at(time * STEPS_PER_SECOND);
    let bulb = |lamp: &example_support::hall::lights::Lamp| Instance {
        render_from_model: Mat4::from_translation(lamp.place)
            * Mat4::from_scale(Vec3::splat(LAMP_RADIUS)),
        albedo: lamp.color,
        checker: super::UNLIT,
    };
    lights.lamps.iter().map(bulb).collect()
}
