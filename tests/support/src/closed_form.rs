//! Checks the ray caster against closed forms, before anything is measured with it.

use glam::{DVec3, Mat4, Vec3};

use crate::mesh::Mesh;
use crate::random::Random;
use crate::truth::{LightInWorld, World};

/// Panics where the ray caster errs.
pub fn check_ray_caster() {
    shadow_of_a_box_is_a_rectangle();
    shadow_of_a_sphere_is_a_cone();
    sun_behind_an_edge_is_covered_in_proportion();
}

/// Under parallel light in the plane z = 0, the shadow of an axis-aligned box on level ground is a
/// rectangle.
fn shadow_of_a_box_is_a_rectangle() {
    let slant = 0.7;
    let mesh = Mesh::floor(0.0, 10.0).joined(Mesh::cuboid(
        Vec3::new(-1.0, 0.5, -1.5),
        Vec3::new(1.0, 2.0, 1.5),
    ));
    let world = world(&mesh, DVec3::new(slant, 1.0, 0.0), 0.0);
    // Rays rise along (slant, 1, 0), so x + slant * height must meet -1..1 at a height in 0.5..2.
    let (x, z) = (-1.0 - 2.0 * slant..=1.0 - 0.5 * slant, -1.5..=1.5);
    let mut random = Random::new(11);
    for _ in 0..20_000 {
        let place = DVec3::new(8.0 * random.unit() - 4.0, 0.0, 8.0 * random.unit() - 4.0);
        let expected = x.contains(&place.x) && z.contains(&place.z);
        assert_eq!(
            world.is_hidden(place, DVec3::Y),
            expected,
            "shadow of a box at {place}"
        );
    }
    for (edge, inside) in [(x.start(), 1.0), (x.end(), -1.0)] {
        for step in [1e-7, -1e-7] {
            let place = DVec3::new(edge + inside * step, 0.0, 0.3);
            let hidden = world.is_hidden(place, DVec3::Y);
            assert_eq!(hidden, step > 0.0, "edge of a box's shadow at {place}");
        }
    }
}

/// From a point, a sphere hides the cone whose half-angle has the sine radius / distance. The mesh
/// lies inside the sphere, by at most the height of its patches.
fn shadow_of_a_sphere_is_a_cone() {
    let (middle, radius, rings) = (DVec3::new(0.3, 3.0, -0.2), 1.0, 64);
    let light = DVec3::new(1.0, 7.0, 0.5);
    let mesh = Mesh::floor(0.0, 10.0).joined(Mesh::sphere(middle.as_vec3(), radius as f32, rings));
    let near = LightInWorld::Near {
        position: light,
        range: 1e3,
        radius: 0.0,
        axis: DVec3::Y,
        cone_cosine: -2.0,
    };
    let triangles = mesh.triangles(&Mat4::IDENTITY);
    let world = World::from_triangles(&triangles, 20.0, near);
    let sagitta = radius * (1.0 - (std::f64::consts::PI / f64::from(rings)).cos());
    let mut random = Random::new(12);
    let (mut hidden, mut lit) = (0, 0);
    for _ in 0..20_000 {
        let place = DVec3::new(8.0 * random.unit() - 4.0, 0.0, 8.0 * random.unit() - 4.0);
        let ray = (light - place).normalize();
        let miss = (middle - place).cross(ray).length();
        let is_hidden = world.is_hidden(place, DVec3::Y);
        if miss < radius - 2.0 * sagitta {
            assert!(is_hidden, "{place} lies in the cone");
            hidden += 1;
        } else if miss > radius + 1e-6 {
            assert!(!is_hidden, "{place} lies beside the cone");
            lit += 1;
        }
    }
    assert!(hidden > 1_000 && lit > 1_000, "both sides must be tried");
}

/// A half-plane whose edge passes `offset` radii from the middle of the disc leaves the area of a
/// circle's segment.
fn sun_behind_an_edge_is_covered_in_proportion() {
    let tangent = 0.01;
    let height = 5.0;
    let mesh = Mesh::sheet(
        Vec3::new(0.0, height, -9.0),
        Vec3::new(0.0, 0.0, 18.0),
        Vec3::new(9.0, 0.0, 0.0),
    );
    let world = world(&mesh, DVec3::Y, tangent);
    for offset in [-0.9, -0.5, 0.0, 0.3, 0.8] {
        // The sheet covers x > 0 at `height`; seen from x0 the disc's middle is x0 / height to one
        // side of the edge.
        let place = DVec3::new(offset * tangent * f64::from(height), 0.0, 0.0);
        let visible = world.visibility(place, DVec3::Y, 32);
        let expected =
            (f64::acos(offset) - offset * f64::sqrt(1.0 - offset * offset)) / std::f64::consts::PI;
        assert!(
            (visible - expected).abs() < 0.01,
            "{visible} of the sun is seen past an edge at {offset} radii, {expected} expected"
        );
    }
}

fn world(mesh: &Mesh, toward_light: DVec3, disc_tangent: f64) -> World {
    let triangles = mesh.triangles(&Mat4::IDENTITY);
    let light = LightInWorld::Far {
        toward_light: toward_light.normalize(),
        disc_tangent,
    };
    World::from_triangles(&triangles, 20.0, light)
}
