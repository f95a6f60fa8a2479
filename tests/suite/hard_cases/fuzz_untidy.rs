//! Tests random scenes as people build them: grounds of any size that cast, with thickness, feet
//! that are sunk into them, domes, and one object with broken or far too large bounds. All settings
//! are the defaults, and receivers are compared with rays.
//!
//! The long run is `PROPTEST_CASES=10000 cargo test --test suite hard_cases::fuzz_untidy`.

use std::cell::RefCell;

use glam::{DVec3, Mat4, Vec3};
use proptest::prelude::*;
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::triangle::{Triangle, occluded};
use wgpu_shadows::report::ViewReport;
use wgpu_shadows::{Aabb, DirectionalShadowDescriptor, ShadowCaster};

use super::fuzz_grounds::{eye, ground};
use super::fuzz_values::run;
use super::stage::{Sun, Verdict, shaped, shining};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::watched::Watched;

/// Describes a scene of some boxes on a ground.
#[derive(Clone, Debug)]
struct Untidy {
    /// Is half the side of the ground, from 1 to 1e5.
    half: f32,
    /// Is the thickness of the ground; 0 for a sheet.
    thickness: f32,
    /// Holds the least corner and the size of each box. Some boxes are sunk into the ground.
    boxes: Vec<(Vec3, Vec3)>,
    light: DVec3,
    eye: DVec3,
    dome: Option<f32>,
    /// Is a coordinate of the bounds of an additional object.
    wild: Option<f32>,
}

/// Describes how coarse the map is around a receiver, in world units.
struct Coarseness {
    /// Is the size of a texel.
    texel: f64,
    /// Is the height within which an occluder may have no shadow.
    gap: f64,
}

fn untidy() -> impl Strategy<Value = Untidy> {
    let light = (0.25..1.5, 0.0..std::f64::consts::TAU).prop_map(|(height, side): (f64, f64)| {
        DVec3::new(
            height.cos() * side.cos(),
            -height.sin(),
            height.cos() * side.sin(),
        )
    });
    let dome = prop::option::of(prop_oneof![Just(200.0_f32), Just(1e4_f32), Just(1e6_f32)]);
    let far_too_large = (5.0..9.0_f64).prop_map(|exponent| 10_f64.powf(exponent) as f32);
    let wild = prop::option::of(prop_oneof![
        Just(f32::NAN),
        Just(f32::INFINITY),
        far_too_large
    ]);
    (ground(), light, eye(), dome, wild).prop_map(
        |((half, thickness, boxes), light, eye, dome, wild)| Untidy {
            half,
            thickness,
            boxes,
            light,
            eye,
            dome,
            wild,
        },
    )
}

impl Untidy {
    fn ground(&self) -> Mesh {
        if self.thickness == 0.0 {
            return Mesh::floor(0.0, self.half);
        }
        let corner = Vec3::new(self.half, 0.0, self.half);
        Mesh::cuboid(-corner - Vec3::Y * self.thickness, corner)
    }

    /// Records the scene and compares the visibilities of the ground around the boxes with rays.
    fn verdict(&self) -> Verdict {
        let pipeline = default_pipeline(gpu());
        let shaped = |mesh: &Mesh| shaped(mesh, &pipeline);
        let meshes: Vec<_> = self
            .boxes
            .iter()
            .map(|(corner, size)| Mesh::cuboid(*corner, *corner + *size))
            .collect();
        let mut casters: Vec<_> = meshes.iter().map(shaped).collect();
        casters.push(shaped(&self.ground()));
        if let Some(radius) = self.dome {
            let mut dome = shaped(&Mesh::sphere(Vec3::ZERO, radius, 6));
            dome.set_roles(false, false);
            casters.push(dome);
        }
        let wild = self.wild.map(|value| {
            let low = if value.is_finite() { -value } else { 0.0 };
            let bounds = Aabb::new(Vec3::splat(low), Vec3::splat(value));
            Watched::with_bounds(shaped(&meshes[0]), bounds)
        });
        let listed = casters.iter().map(|caster| caster as &dyn ShadowCaster);
        let list: Vec<_> = listed
            .chain(wild.iter().map(|caster| caster as &dyn ShadowCaster))
            .collect();
        let camera = Camera::modern(self.eye, DVec3::new(0.0, 0.3, 0.0), 0.9, 1.6);
        // Bounds of such a size are covered as far as the camera sees.
        let is_huge = self.wild.is_some_and(f32::is_finite);
        let max_distance = if is_huge { 100.0 } else { f32::INFINITY };
        let mut sun = Sun::new(&DirectionalShadowDescriptor::default());
        let coverage = Coverage::Camera(camera.view().with_max_distance(max_distance));
        let report = sun.record(DVec3::ZERO, shining(self.light), coverage, &list, &[]);
        let coarseness = |position: DVec3| {
            if !is_huge {
                // The boxes extend over three metres and their shadows over twelve metres at most,
                // so that one cascade of 2048 texels has texels of 7 mm; more are used where that
                // makes them finer.
                return Some(Coarseness {
                    texel: 0.007,
                    gap: 0.0,
                });
            }
            let depth = -camera.pose.axes.z_axis.dot(position - camera.pose.eye);
            let ends_behind = |view: &&ViewReport| {
                let slice = view.slice.as_ref();
                slice.is_some_and(|slice| f64::from(slice.depth_far) >= depth)
            };
            let view = report.views.iter().find(ends_behind)?;
            // Behind bounds of such a size any ground counts as casting, whose own rounding the
            // reported height contains, beside that of the depths.
            Some(Coarseness {
                texel: f64::from(view.texel_size_world.max_element()),
                gap: f64::from(view.max_peter_panning_world),
            })
        };

        let triangles: Vec<Triangle> = meshes
            .iter()
            .flat_map(|mesh| mesh.triangles(&Mat4::IDENTITY))
            .collect();
        let light = self.light.as_vec3().as_dvec3();
        let dark = |position: DVec3| occluded(&triangles, position, -light, 0.0);
        let mut random = Random::new(3);
        let mut verdict = Verdict::default();
        let (mut points, mut truths) = (Vec::new(), Vec::new());
        let reach = f64::from(self.half).min(3.0);
        for _ in 0..400 {
            let low = DVec3::new(-reach, 0.0, -reach);
            let position = random.point(low, -low).as_vec3().as_dvec3();
            if !camera.sees(position, f64::INFINITY, 0.01) {
                continue;
            }
            let Some(Coarseness { texel, gap }) = coarseness(position) else {
                continue;
            };
            // The margin is three texels, stretched by the slant of the light.
            let margin = 3.0 * texel / -self.light.y + 0.005;
            let here = dark(position);
            // A thin shadow, or a thin gap between two, may lie between any places around. A ray
            // that passes a box at no more than the margin meets the box that is wider by as much,
            // and one that is in it by the margin meets the box that is narrower.
            let meets = |place: DVec3, wider: f64| {
                let wider = Vec3::splat(wider as f32);
                let mut boxes = self.boxes.iter().map(|(corner, size)| {
                    // No light comes from below the ground.
                    let low = *corner - wider * Vec3::new(1.0, 0.0, 1.0);
                    (low, *corner + *size + wider)
                });
                boxes.any(|(low, high)| {
                    let triangles = Mesh::cuboid(low, high).triangles(&Mat4::IDENTITY);
                    low.cmplt(high).all() && occluded(&triangles, place, -light, 0.0)
                })
            };
            let settled = if here {
                let places = [position, position + DVec3::Y * gap];
                places.into_iter().all(|place| meets(place, -margin))
            } else {
                !meets(position, margin)
            };
            points.push(Point::rounded(position, DVec3::Y));
            truths.push(settled.then_some(here));
        }
        if !points.is_empty() {
            for (truth, seen) in truths.iter().zip(sun.ask(&points)) {
                verdict.count(*truth, seen);
            }
        }
        verdict
    }
}

#[test]
fn untidy_scenes_are_shadowed_as_the_truth_says() {
    let all = RefCell::new(Verdict::default());
    run(120, untidy(), |scene| {
        let verdict = scene.verdict();
        all.borrow_mut().add(&verdict);
        prop_assert_eq!(verdict.wrong, 0, "{:?}", verdict);
        Ok(())
    });
    let all = all.into_inner();
    assert!(all.dark > 500 && all.lit > 5000, "{all:?}");
    table::record(
        "random grounds of half side 1 to 1e5, sheets and slabs, sunk feet, domes, one object with broken bounds or with bounds of +-1e5 to +-1e9, everything else default",
        "settled receivers as the truth says",
        all.words(),
    );
}
