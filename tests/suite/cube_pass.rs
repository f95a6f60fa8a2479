//! Tests that one multiview pass over the six faces of a point light gives the depths of a pass for
//! each face, bit for bit.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use wgpu_shadows::{Aabb, report::ViewStatus};

use crate::fixtures::cube_pair::{
    LIGHT, Look, Pair, behind, cube, culled, furnished, plain, room, straddling,
};
use crate::fixtures::multiview::{device, is_right};

#[test]
fn one_pass_gives_the_depths_of_a_pass_each() {
    for (name, meshes) in [
        ("furnished", furnished()),
        ("straddling", straddling()),
        ("behind", behind()),
        ("culled", culled()),
    ] {
        let mut pair = Pair::new(&meshes);
        assert_eq!(
            pair.one.shadow.maps().texture().format(),
            wgpu::TextureFormat::Depth32Float
        );
        // The light is in the middle, near a wall, and on an axis through a vertex.
        for light in [
            LIGHT,
            DVec3::new(-3.9, 4.1, 3.7),
            DVec3::new(0.0, -1.0, 0.0),
        ] {
            pair.each(|stage| stage.shadow.invalidate());
            pair.record_in_one_pass(name, light);
        }
    }
}

/// Sheets, boxes and balls are at random positions, and so is the light; every other scene is seen
/// by a camera, with a light that does not reach all of it.
#[test]
fn random_scenes_have_the_same_depths() {
    const SCENES: u32 = 80;
    let mut random = Random::new(61);
    let mut in_one_pass = 0;
    for scene in 0..SCENES {
        let wide = scene % 2 == 1;
        // Walls would hide what lies beyond the reach.
        let mut meshes = if wide { vec![] } else { vec![plain(room())] };
        for _ in 0..3 + random.index(12) {
            let half = DVec3::splat(if wide { 20.0 } else { 5.0 });
            let center = random.point(-half, half).as_vec3();
            let size = random.range(0.2, if wide { 10.0 } else { 3.0 }) as f32;
            let axis = random.direction().as_vec3();
            let look = Look {
                transform: Mat4::from_translation(center)
                    * Mat4::from_axis_angle(axis, random.range(0.0, 3.0) as f32),
                ..Default::default()
            };
            let mesh = match random.index(3) {
                0 => Mesh::sheet(Vec3::splat(-size), Vec3::X * 2.0 * size, Vec3::Z * size),
                1 => cube(Vec3::ZERO, size),
                _ => Mesh::sphere(Vec3::ZERO, size, 10),
            };
            meshes.push((mesh, look));
        }
        let light = random.point(DVec3::splat(-4.5), DVec3::splat(4.5));
        let mut pair = Pair::new(&meshes);
        if wide {
            let target = light + random.direction();
            let camera = Camera::modern(light, target, random.range(0.6, 2.0), 1.5).view();
            let range = random.range(5.0, 12.0) as f32;
            pair.each(|stage| (stage.camera, stage.range) = (Some(camera), range));
        }
        let ([one, six], _) = pair.compare(&format!("scene {scene}"), light);
        in_one_pass += u32::from(one.passes < six.passes);
    }
    // One pass is expected for all scenes that are completely seen, and for those others in which
    // more than one face is seen and everything is within reach.
    let wanted = if is_right() { SCENES / 2 } else { 0 };
    assert!(
        in_one_pass >= wanted,
        "{in_one_pass} on {}",
        device().describe()
    );
    assert!(is_right() || in_one_pass == 0, "{in_one_pass}");
}

/// What one pass drew is kept like what a pass for each face drew, and a change in one face redraws
/// only that face.
#[test]
fn faces_drawn_in_one_pass_are_kept_one_by_one() {
    let mut pair = Pair::new(&furnished());
    pair.record_in_one_pass("first", LIGHT);
    for report in pair.record("unchanged", LIGHT) {
        assert_eq!(report.passes, 0);
        assert!(report.views.iter().all(|v| v.status == ViewStatus::Kept));
    }
    // This is the object before the wall at +x.
    pair.each(|stage| {
        let moved = Mat4::from_translation(Vec3::new(2.6, 0.1, 0.0));
        stage.casters[1]
            .mesh
            .set_transform(moved)
            .expect("an affine matrix");
    });
    let reports = pair.record("moved", LIGHT);
    for report in &reports {
        let statuses: Vec<_> = report.views.iter().map(|view| view.status).collect();
        assert_eq!(statuses[0], ViewStatus::Drawn);
        assert!(statuses.contains(&ViewStatus::Kept), "{statuses:?}");
    }
    assert_eq!(reports[0].passes, reports[1].passes);
}

/// Over frames in which everything moves, little moves, and everything moves again, the light is
/// drawn in one pass, by copies of static-caster caches, and in one pass again.
#[test]
fn one_pass_and_copied_layers_take_turns() {
    let mut pair = Pair::new(&furnished());
    let (mut in_one_pass, mut copied) = (0, 0);
    for frame in 0..36_u32 {
        let moving = if (8..26).contains(&frame) { 1..2 } else { 0..7 };
        pair.each(|stage| {
            for told in &mut stage.casters[moving.clone()] {
                let step = Vec3::new(0.0, 0.01, 0.02) * if frame % 2 == 0 { 1.0 } else { -1.0 };
                let moved = Mat4::from_translation(step) * told.mesh.render_from_model();
                told.mesh.set_transform(moved).expect("an affine matrix");
            }
        });
        let [one, _] = pair.record(&format!("frame {frame}"), LIGHT);
        in_one_pass += u32::from(one.passes == 1 && one.draws() == 7);
        copied += one.views.iter().map(|view| view.copied).sum::<u32>();
    }
    let wanted = if is_right() { 18 } else { 0 };
    assert_eq!(in_one_pass, wanted, "on {}", device().describe());
    assert!(copied > 0);
}

/// One pass clears the layers of faces that are empty: when these have casters again they are
/// drawn, though nothing in them has changed.
#[test]
fn a_face_that_was_empty_for_a_frame_comes_back() {
    let mut pair = Pair::new(&furnished());
    pair.record_in_one_pass("all around", LIGHT);
    // A camera at the light looks one way, and slightly another way the next time: some faces are
    // empty, the others change.
    pair.each(|stage| {
        let target = LIGHT + DVec3::new(1.0, 0.9, 0.2);
        stage.camera = Some(Camera::modern(LIGHT, target, 1.0, 1.0).view());
        stage.shadow.reset_history();
    });
    let [one, _] = pair.record_in_one_pass("one way", LIGHT);
    assert!(one.views.iter().any(|v| v.status == ViewStatus::Empty));
    pair.each(|stage| stage.camera = None);
    let [_, six] = pair.record("all around again", LIGHT);
    // Otherwise no face would have had casters again.
    assert!(six.views.iter().any(|v| v.status == ViewStatus::Kept));
}

/// What lies beyond the reach is not drawn into a face that the near part does not touch. Here a
/// plate extends from the +z face, where it is near, behind what the +x face shows, and one pass
/// would draw it there.
#[test]
fn casters_beyond_the_reach_take_a_pass_each() {
    let pairs_of_cubes = [
        cube(Vec3::new(4.8, -0.4, -0.4), 0.05),
        cube(Vec3::new(4.8, 0.4, 0.4), 0.05),
        cube(Vec3::new(-0.4, -0.4, 4.8), 0.05),
        cube(Vec3::new(0.4, 3.0, 4.8), 0.05),
    ];
    let plate = Mesh::sheet(Vec3::new(-1.0, 3.3, 8.0), Vec3::X * 121.0, Vec3::Z * 12.0);
    let meshes: Vec<_> = pairs_of_cubes
        .into_iter()
        .chain([plate])
        .map(plain)
        .collect();
    let mut pair = Pair::new(&meshes);
    // The plate itself is too far away for the camera, so that the faces cover no more than the
    // others need.
    let camera = Camera::modern(DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0), 2.4, 1.0).view();
    pair.each(|stage| {
        stage.camera = Some(camera.with_max_distance(6.0));
        stage.receivers = vec![
            Aabb::new(Vec3::new(4.5, -0.5, -0.5), Vec3::new(5.5, 0.5, 0.5)),
            Aabb::new(Vec3::new(-0.5, -0.5, 4.0), Vec3::new(0.5, 3.5, 8.4)),
        ];
        stage.range = 12.0;
    });
    let [one, six] = pair.record("plate", DVec3::ZERO);
    assert_eq!((one.passes, six.passes), (2, 2));
    // Without the plate one pass is used, and so it is with a floor that extends under the light as
    // far as one can see.
    pair.each(|stage| {
        stage.casters.truncate(4);
        // The face that the plate was not drawn into would be kept.
        stage.shadow.invalidate();
    });
    pair.record_in_one_pass("cubes alone", DVec3::ZERO);
    let floor = Mesh::floor(-2.0, 500.0);
    let meshes: Vec<_> = furnished()
        .into_iter()
        .skip(1)
        .chain([plain(floor)])
        .collect();
    let mut pair = Pair::new(&meshes);
    pair.each(|stage| stage.range = 9.0);
    pair.record_in_one_pass("a floor wider than the reach", LIGHT);
}
