//! Tests random scenes as people build them under lamps: a shade of panels or of one mesh close to
//! the light, an endless range, grounds of any size, with thickness, and feet that are sunk into
//! them. All settings are the defaults, and receivers are compared with rays.
//!
//! The long run is `PROPTEST_CASES=10000 cargo test --test suite hard_cases::fuzz_untidy_lamps`.

use std::cell::RefCell;
use std::ops::Range;

use glam::{DVec2, DVec3, Vec3};
use proptest::prelude::*;
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;

use super::endless_lamps::{lift, nearer};
use super::fuzz_grounds::{eye, ground};
use super::fuzz_values::run;
use super::stage::scene;
use super::table;
use crate::fixtures::gpu::gpu;
use crate::fixtures::lamp_scenes::{Lamp, Setting, merged, shade};
use crate::fixtures::scene::Scene;

/// Describes a scene of some boxes on a ground, under a lamp in a shade that is open below.
#[derive(Clone, Debug)]
struct Lit {
    /// Is half the side of the ground, from 1 to 1e5.
    half: f32,
    /// Is the thickness of the ground; 0 for a sheet.
    thickness: f32,
    /// Holds the least corner and the size of each box. Some boxes are sunk into the ground.
    boxes: Vec<(Vec3, Vec3)>,
    light: DVec3,
    /// Is half the side of the shade.
    shade: f64,
    /// States that the shade is one mesh, whose bounds contain the light.
    one_mesh: bool,
    eye: DVec3,
}

fn lit() -> impl Strategy<Value = Lit> {
    let light = (-1.0..1.0, 2.0..4.0, -1.0..1.0).prop_map(DVec3::from);
    let shade = (0.03..0.3, any::<bool>());
    (ground(), light, shade, eye()).prop_map(
        |((half, thickness, boxes), light, (shade, one_mesh), eye)| Lit {
            half,
            thickness,
            boxes,
            light,
            shade,
            one_mesh,
            eye,
        },
    )
}

impl Lit {
    fn setting(&self) -> Setting {
        let boxes = self.boxes.iter();
        let mut meshes: Vec<_> = boxes
            .map(|(corner, size)| Mesh::cuboid(*corner, *corner + *size))
            .collect();
        meshes.push(if self.thickness == 0.0 {
            Mesh::floor(0.0, self.half)
        } else {
            let corner = Vec3::new(self.half, 0.0, self.half);
            Mesh::cuboid(-corner - Vec3::Y * self.thickness, corner)
        });
        let shade = shade(self.light, self.shade);
        if self.one_mesh {
            meshes.push(merged(&shade));
        } else {
            meshes.extend(shade);
        }
        Setting {
            name: "a random scene",
            meshes,
            light: self.light,
            camera: Camera::modern(self.eye, DVec3::new(0.0, 0.3, 0.0), 0.9, 1.6),
        }
    }
}

/// Returns whether an edge of a shadow or of the surface crosses the footprint of a lookup, as
/// [`Lamp::truth`] has it, by many more rays than decide there: a corner may lie between those.
/// Beyond an edge of the surface, rasterizers snap vertices to 1/256 of a texel, so that a side
/// that falls away steeply may reach over the edge and darken a corner of the footprint.
fn has_edge_near(scene: &Scene, light: DVec3, point: &Point, tangent: f64) -> bool {
    let meets = |at: DVec3, along: Range<f64>| {
        let hits = scene.triangles.iter();
        let mut hits = hits.filter_map(|triangle| triangle.hit(light, at - light));
        hits.any(|hit| along.contains(&hit))
    };
    let hidden = |at| meets(at, 0.0..1.0 - 1e-6);
    let on_surface = |at| meets(at, 1.0 - 1e-6..1.0 + 1e-6);
    let [place, normal] = [point.position, point.normal].map(|at| Vec3::from(at).as_dvec3());
    let from_light = place - light;
    let side = from_light.normalize().any_orthonormal_vector();
    let across = side.cross(from_light.normalize());
    let here = hidden(place);
    let at = |step: i32| f64::from(step) / 15.5 - 1.0;
    let square = (0..32 * 32).map(|ray| DVec2::new(at(ray % 32), at(ray / 32)));
    let mut disc = square.filter(|ray| ray.length() <= 1.0);
    disc.any(|ray| {
        let aside = (side * ray.x + across * ray.y) * tangent * from_light.length();
        let direction = from_light + aside;
        let at = light + direction * (normal.dot(from_light) / normal.dot(direction));
        hidden(at) != here || !on_surface(at)
    })
}

/// Counts settled receivers, dark and lit, and those of each that are wrong.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    settled: [usize; 2],
    wrong: [usize; 2],
}

impl Lit {
    /// Records the scene and compares the visibilities of what the camera sees with rays.
    fn counts(&self, lamp: &mut Lamp) -> Counts {
        let setting = self.setting();
        let scene = scene(&setting.meshes);
        // The frame before may have been one of another scene.
        lamp.reset_history();
        let camera = Some(&setting.camera);
        lamp.record(setting.light, f32::INFINITY, camera, &scene.list(), &[]);
        let half = f64::from(self.half);
        let rounding = (lift(half), nearer(lamp, half));
        let mut truth = lamp.truth_of_pixels(&setting, &scene, rounding, (48, 30));
        let mut seen = lamp.ask().points(gpu(), &truth.points);
        if truth.leaks_and_false_shadows(&seen) != [0, 0] {
            let tangent = lamp.footprint_tangent();
            let points = truth.points.iter();
            let has_edge = points.map(|point| has_edge_near(&scene, self.light, point, tangent));
            let has_edge: Vec<_> = has_edge.collect();
            let mut edges = has_edge.iter();
            seen.retain(|_| edges.next() == Some(&false));
            edges = has_edge.iter();
            truth.dark.retain(|_| edges.next() == Some(&false));
        }
        Counts {
            settled: truth.counts(),
            wrong: truth.leaks_and_false_shadows(&seen),
        }
    }
}

#[test]
fn untidy_scenes_under_lamps_are_shadowed_as_the_truth_says() {
    let all = RefCell::new(Counts::default());
    let lamps = RefCell::new([Lamp::omni(), Lamp::spot()]);
    run(60, lit(), |lit| {
        for lamp in lamps.borrow_mut().iter_mut() {
            let counts = lit.counts(lamp);
            let mut all = all.borrow_mut();
            for kind in 0..2 {
                all.settled[kind] += counts.settled[kind];
                all.wrong[kind] += counts.wrong[kind];
            }
            prop_assert_eq!(counts.wrong, [0, 0], "{}: {:?}", lamp.name(), counts);
        }
        Ok(())
    });
    let Counts { settled, wrong } = all.into_inner();
    assert!(settled.iter().all(|count| *count > 2000), "{settled:?}");
    table::record(
        "random scenes under lamps in shades of half side 0.03 to 0.3, endless range, grounds of half side 1 to 1e5, sheets and slabs, sunk feet, everything default",
        "settled receivers in view as the truth says, where it holds 8u of the half side above them",
        format!(
            "{} wrong of {} settled receivers, {} of them dark",
            wrong[0] + wrong[1],
            settled[0] + settled[1],
            settled[0]
        ),
    );
}

/// Checks a ground of two triangles that a cube face sees in a strip along its lower side, where
/// they are clipped at the sides of the map: 2u of the distance of their corners did not cover the
/// rounding.
#[test]
fn a_strip_of_a_giant_ground_is_lit() {
    let scene = Lit {
        half: 28_878.957,
        thickness: 0.0,
        boxes: vec![(
            Vec3::new(0.0, -0.024_394_028, 0.0),
            Vec3::new(0.05, 0.2, 0.05),
        )],
        light: DVec3::new(
            -0.053_085_325_766_408_02,
            2.889_928_661_535_239_3,
            0.833_548_848_650_435_9,
        ),
        shade: 0.03,
        one_mesh: false,
        eye: DVec3::new(
            2.274_628_643_516_907_6,
            2.607_763_053_960_616_3,
            -3.389_746_211_234_272,
        ),
    };
    let counts = scene.counts(&mut Lamp::omni());
    assert!(
        counts.wrong == [0, 0] && counts.settled[1] > 500,
        "{counts:?}"
    );
}
