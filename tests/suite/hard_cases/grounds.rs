//! Tests grounds of any size that cast, with feet on and in them, and other objects that are far
//! larger than what they shadow.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::{Camera, Lens, Pose};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::triangle::{Triangle, occluded};
use wgpu_shadows::{
    Aabb, CascadeLayout, DirectionalShadowDescriptor, MeshCaster, ShadowCaster, Stability,
};

use super::stage::{SUM_ERROR, Sun, Verdict, differ, settled, shaped, shining};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::watched::Watched;

const LIGHT: DVec3 = DVec3::new(0.527, -0.738, -0.4216);
const LOW_LIGHT: DVec3 = DVec3::new(0.93, -0.31, -0.2);

/// Lists the half sides of the grounds in metres, from a room to a county.
const HALF_SIDES: [f32; 6] = [2.0, 5.0, 50.0, 500.0, 5e3, 5e4];

/// Returns a ground and a robot of 0.8 m whose feet are `sunk` metres below it. The ground is a
/// sheet, or a slab if `thickness` (in metres) is above 0.
fn meshes(half: f32, thickness: f32, sunk: f32) -> Vec<Mesh> {
    let ground = if thickness == 0.0 {
        Mesh::floor(0.0, half)
    } else {
        Mesh::cuboid(
            Vec3::new(-half, -thickness, -half),
            Vec3::new(half, 0.0, half),
        )
    };
    vec![
        ground,
        Mesh::cuboid(Vec3::new(-0.1, -sunk, -0.1), Vec3::new(0.1, 0.4, 0.1)),
        Mesh::cuboid(Vec3::new(-0.2, 0.4, -0.15), Vec3::new(0.2, 0.8, 0.15)),
        Mesh::cuboid(Vec3::new(0.2, 0.7, -0.03), Vec3::new(0.6, 0.76, 0.03)),
    ]
}

fn casters(meshes: &[Mesh]) -> Vec<MeshCaster> {
    let pipeline = default_pipeline(gpu());
    meshes.iter().map(|mesh| shaped(mesh, &pipeline)).collect()
}

fn triangles(meshes: &[Mesh]) -> Vec<Triangle> {
    let of = |mesh: &Mesh| mesh.triangles(&Mat4::IDENTITY);
    meshes.iter().flat_map(of).collect()
}

fn listed(casters: &[MeshCaster]) -> Vec<&dyn ShadowCaster> {
    casters
        .iter()
        .map(|caster| caster as &dyn ShadowCaster)
        .collect()
}

/// Records a frame of the casters, and returns the side of a texel.
fn record(sun: &mut Sun, light: DVec3, coverage: Coverage, casters: &[MeshCaster]) -> f64 {
    let list = listed(casters);
    sun.record(DVec3::ZERO, shining(light), coverage, &list, &[]);
    sun.texel()
}

fn near_camera() -> Camera {
    Camera::modern(
        DVec3::new(1.5, 1.4, 2.2),
        DVec3::new(0.0, 0.4, 0.0),
        0.8,
        1.78,
    )
}

/// Is the distance in metres from the edge of a shadow beyond which a receiver is settled: three
/// texels of 2 mm, stretched by the slant of the light. The map of the robot alone has finer
/// texels.
const SETTLED: f64 = 0.012;

/// Compares the visibilities of the ground around the robot with rays. A receiver is settled where
/// rays from points `margin` metres around it agree. `triangles` does not contain the ground,
/// because the rounding of its far corners would decide the result.
fn around_robot(sun: &Sun, triangles: &[Triangle], light: DVec3, margin: f64) -> Verdict {
    let mut random = Random::new(5);
    let camera = near_camera();
    let (low, high) = (DVec3::new(-1.5, 0.0, -1.5), DVec3::new(1.5, 0.0, 1.5));
    let mut verdict = Verdict::default();
    let (mut points, mut truths) = (Vec::new(), Vec::new());
    while points.len() < 3000 {
        let position = random.point(low, high).as_vec3().as_dvec3();
        if !camera.sees(position, f64::INFINITY, 0.01) {
            continue;
        }
        let dark = |at: DVec3| occluded(triangles, at, -light, 0.0);
        points.push(Point::rounded(position, DVec3::Y));
        truths.push(settled(dark, position, margin));
    }
    for (truth, seen) in truths.iter().zip(sun.ask(&points)) {
        verdict.count(*truth, seen);
    }
    verdict
}

/// Checks that the robot's shadow is as fine on a ground of many kilometres as in a room, with one
/// cascade, all defaults, and a camera without a far limit.
#[test]
fn a_ground_of_any_size_leaves_shadows_sharp() {
    let mut all = Verdict::default();
    let mut coarsest = 0.0_f64;
    for half in HALF_SIDES {
        for (thickness, sunk) in [
            (0.0, 0.0),
            (0.0, 0.001),
            (0.0, 0.02),
            (0.1, 0.001),
            (1.0, 0.0),
        ] {
            let meshes = meshes(half, thickness, sunk);
            let casters = casters(&meshes);
            let mut sun = Sun::new(&DirectionalShadowDescriptor::default());
            let coverage = Coverage::Camera(near_camera().view());
            coarsest = coarsest.max(record(&mut sun, LIGHT, coverage, &casters));
            let verdict = around_robot(&sun, &triangles(&meshes[1..]), LIGHT, SETTLED);
            let words = format!("half side {half}, {thickness} thick, feet {sunk} below");
            verdict.assert_right(&words);
            all.add(&verdict);
        }
    }
    // The robot and its shadow are 1.3 m wide. A map of 2048 texels has texels of 0.6 mm over them,
    // and the quantized size may be one step larger.
    assert!(coarsest < 1.2e-3, "{coarsest}");
    table::record(
        "a robot of 0.8 m on grounds of half side 2 to 5e4 that cast: sheets and slabs, feet on and in them",
        "settled receivers as the truth says, texels below 1.2 mm",
        format!("{}, texels up to {:.2} mm", all.words(), coarsest * 1e3),
    );
}

/// Checks that a ground of two triangles does not shadow itself, however far away its corners are,
/// whether the map follows a camera or covers a fixed box. A foot is sunk into the ground, so that
/// the ground is among the casters.
#[test]
fn a_giant_ground_is_lit() {
    let mut random = Random::new(19);
    let (mut wrong, mut lit) = (0, 0);
    for half in [500.0_f32, 3e3, 5e3, 1e4, 7e4, 2e5] {
        for light in [LIGHT, LOW_LIGHT, DVec3::new(0.7, -1.0, 0.02)] {
            let meshes = meshes(half, 0.0, 0.001);
            // These casters keep the default shape, like those of an engine that does not state
            // one.
            let pipeline = default_pipeline(gpu());
            let casters: Vec<_> = meshes
                .iter()
                .map(|mesh| mesh.caster(gpu(), &pipeline, Mat4::IDENTITY))
                .collect();
            let box_around = Aabb::new(Vec3::splat(-2.0), Vec3::splat(2.0));
            let limited = near_camera().view().with_max_distance(100.0);
            let coverages = [
                (Coverage::Camera(limited), 3, 60.0),
                (Coverage::Bounds(box_around), 1, 2.0),
            ];
            for (coverage, cascades, reach) in coverages {
                let mut sun = Sun::new(&DirectionalShadowDescriptor {
                    map_size: 1024,
                    layout: CascadeLayout::fixed(cascades),
                    ..Default::default()
                });
                sun.record(
                    DVec3::ZERO,
                    shining(light),
                    coverage,
                    &listed(&casters),
                    &[],
                );
                let triangles = triangles(&meshes);
                let robot = &triangles[2..];
                let positions: Vec<_> = (0..2000)
                    .map(|_| {
                        let low = DVec3::new(-reach, 0.0, -reach);
                        random.point(low, -low).as_vec3().as_dvec3()
                    })
                    // Receivers within half a metre of the robot and its shadow are left out.
                    .filter(|position| {
                        let around = |step: DVec3| !occluded(robot, *position + step, -light, 0.0);
                        let steps = [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z];
                        position.abs().max_element() > 0.6
                            && around(DVec3::ZERO)
                            && steps.iter().all(|step| around(*step * 0.5))
                    })
                    .collect();
                let points: Vec<_> = positions
                    .iter()
                    .map(|position| Point::rounded(*position, DVec3::Y))
                    .collect();
                let dark = sun
                    .ask(&points)
                    .into_iter()
                    .filter(|seen| differ(*seen, 1.0, SUM_ERROR));
                let dark = dark.count();
                assert_eq!(
                    dark,
                    0,
                    "half side {half}, light {light}, {coverage:?}, of {}",
                    points.len()
                );
                wrong += dark;
                lit += points.len();
            }
        }
    }
    assert!(lit > 10_000, "{lit}");
    table::record(
        "grounds of two triangles, half side 500 to 2e5, into which a foot dips",
        "no false shadow on them, before a camera and in a fixed box",
        format!("{wrong} of {lit} receivers"),
    );
}

/// Checks that a sky dome that neither casts nor receives does not change the shadows, whatever its
/// radius.
#[test]
fn a_sky_dome_leaves_shadows_alone() {
    let mut all = Verdict::default();
    for radius in [100.0_f32, 1e3, 1e6] {
        let meshes = meshes(50.0, 0.0, 0.001);
        let mut casters = casters(&meshes);
        let dome = Mesh::sphere(Vec3::ZERO, radius, 8);
        let mut dome = dome.caster(gpu(), &default_pipeline(gpu()), Mat4::IDENTITY);
        dome.set_roles(false, false);
        casters.push(dome);
        let mut sun = Sun::new(&DirectionalShadowDescriptor::default());
        let coverage = Coverage::Camera(near_camera().view());
        sun.record(
            DVec3::ZERO,
            shining(LIGHT),
            coverage,
            &listed(&casters),
            &[],
        );
        let verdict = around_robot(&sun, &triangles(&meshes[1..]), LIGHT, SETTLED);
        verdict.assert_right(&format!("a dome of {radius}"));
        all.add(&verdict);
    }
    table::record(
        "sky domes of radius 100 to 1e6 that neither cast nor receive",
        "settled receivers as the truth says, with one cascade",
        all.words(),
    );
}

/// Checks that one object with far too large bounds, finite or not, does not change the shadows of
/// the others.
#[test]
fn one_wild_box_leaves_other_shadows_in_place() {
    let mut all = Verdict::default();
    let limited = near_camera().view().with_max_distance(100.0);
    let nan = Vec3::new(f32::NAN, 1.0, 1.0);
    let boxes = [
        Aabb::new(Vec3::splat(-1e5), Vec3::splat(1e5)),
        Aabb::new(Vec3::splat(-1e6), Vec3::splat(1e6)),
        Aabb::new(Vec3::splat(-1e9), Vec3::splat(1e9)),
        Aabb::new(nan, Vec3::ONE),
        Aabb::new(Vec3::ZERO, nan),
        Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY),
    ];
    for (index, bounds) in boxes.into_iter().enumerate() {
        let meshes = meshes(50.0, 0.0, 0.001);
        let casters = casters(&meshes);
        // The object's own shadow is far from the receivers.
        let small = Mesh::cuboid(Vec3::new(-20.2, 0.0, -20.2), Vec3::new(-20.0, 0.2, -20.0));
        let small = small.caster(gpu(), &default_pipeline(gpu()), Mat4::IDENTITY);
        let wild = Watched::with_bounds(small, bounds);
        let mut list = listed(&casters);
        list.push(&wild);
        let mut sun = Sun::new(&DirectionalShadowDescriptor {
            layout: CascadeLayout::fixed(4),
            ..Default::default()
        });
        let coverage = Coverage::Camera(limited);
        let report = sun.record(DVec3::ZERO, shining(LIGHT), coverage, &list, &[]);
        // The cascade around the robot has texels of 3 mm, and its depths are rounded to three
        // texels.
        let verdict = around_robot(&sun, &triangles(&meshes[1..]), LIGHT, 3.0 * SETTLED);
        verdict.assert_right(&format!("{bounds:?}"));
        all.add(&verdict);
        let named: Vec<_> = report
            .broken_bounds
            .iter()
            .map(|broken| broken.index)
            .collect();
        let wanted: &[usize] = if index < 3 { &[] } else { &[4] };
        assert_eq!(named, wanted, "{bounds:?}");
    }
    table::record(
        "a box of +-1e5 to +-1e9, infinite or NaN for an object of 0.2 m, four cascades",
        "settled receivers in the shadows of others as the truth says, broken bounds named",
        all.words(),
    );
}

/// Checks that the distance of an orthographic camera, which does not change what the camera sees,
/// costs no texels.
#[test]
fn an_orthographic_camera_may_be_far_away() {
    let mut all = Verdict::default();
    let mut coarsest = 0.0_f64;
    let meshes = meshes(50.0, 0.0, 0.001);
    let casters = casters(&meshes);
    for away in [4.0, 100.0, 1e3, 1e4] {
        for stability in [Stability::TightFit, Stability::BoundingSphere] {
            let target = DVec3::new(0.0, 0.4, 0.0);
            let camera = Camera {
                pose: Pose::looking_at(target + DVec3::new(0.5, 0.6, 0.62) * away, target),
                lens: Lens::Orthographic {
                    sides: [-2.0, 2.0, -1.5, 1.5],
                    near: 0.1,
                    far: 2.0 * away,
                },
                reversed: true,
            };
            let mut sun = Sun::new(&DirectionalShadowDescriptor {
                stability,
                layout: CascadeLayout::fixed(1),
                ..Default::default()
            });
            let coverage = Coverage::Camera(camera.view());
            coarsest = coarsest.max(record(&mut sun, LIGHT, coverage, &casters));
            let verdict = around_robot(&sun, &triangles(&meshes[1..]), LIGHT, 2.0 * SETTLED);
            verdict.assert_right(&format!("{stability:?} from {away}"));
            all.add(&verdict);
        }
    }
    // The visible ground is 6 m deep along the view. A sphere around it has a radius of 3.9 m,
    // which gives texels of 3.8 mm.
    assert!(coarsest < 5e-3, "{coarsest}");
    table::record(
        "orthographic cameras 4 to 1e4 away, both stabilities",
        "settled receivers as the truth says, texels below 5 mm in maps of 2048",
        format!("{}, texels up to {:.2} mm", all.words(), coarsest * 1e3),
    );
}
