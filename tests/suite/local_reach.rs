//! How far a spot or point light reaches: as far as receivers are seen, whatever else there is in
//! the scene, and without drawing its maps again for it.

use glam::{DQuat, DVec3, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use wgpu_shadows::Aabb;

use crate::fixtures::gpu::gpu;
use crate::fixtures::lamp_scenes::{Lamp, Setting, Shade, lamp_over_table, room, street_lamp};
use crate::fixtures::scene::Scene;
use crate::fixtures::table;

/// A ground, a wall or a sky that no camera sees changes no bit of what the light is looked up
/// with. All of these stand where their shadows fall on nothing that is seen.
#[test]
fn what_nobody_sees_changes_nothing() {
    let gpu = gpu();
    let setting = lamp_over_table(Shade::Panels, 5.0);
    let away = setting.camera.pose.axes.z_axis.with_y(0.0).normalize();
    let unseen = [1e2, 1e4, 1e6].map(|distance| {
        let middle = (setting.camera.pose.eye + away * distance).as_vec3();
        Mesh::cuboid(
            middle - distance as f32 * 0.3,
            middle + distance as f32 * 0.3,
        )
    });
    for mut lamp in Lamp::each_kind() {
        let camera = Some(&setting.camera);
        let alone = Scene::new(gpu, &setting.meshes);
        lamp.record(setting.light, f32::INFINITY, camera, &alone.list(), &[]);
        let wanted = lamp.uniforms().to_vec();
        for mesh in &unseen {
            let mut meshes = setting.meshes.clone();
            meshes.push(mesh.clone());
            let scene = Scene::new(gpu, &meshes);
            lamp.record(setting.light, f32::INFINITY, camera, &scene.list(), &[]);
            let bounds = mesh.bounds();
            assert_eq!(wanted, lamp.uniforms(), "{} beside {bounds:?}", lamp.name());
        }
    }
}

/// The reported texel is that at the farthest receiver that is seen: the depths of a view end
/// there, give or take a quantized size step of 1.19, and for a spot only what lies in its cone
/// counts.
#[test]
fn the_reach_ends_where_the_last_receiver_is_seen() {
    // Seen from above, all of the floor and nothing else; the lamp's farthest corner of it, and the
    // spot's.
    let floor = Aabb::new(Vec3::new(-40.0, 0.0, -30.0), Vec3::new(40.0, 0.0, 30.0));
    let thing = Mesh::cuboid(Vec3::new(0.2, 0.5, 0.2), Vec3::new(0.6, 1.0, 0.7));
    let scene = Scene::new(gpu(), &[thing]);
    let light = DVec3::new(0.0, 4.0, 0.0);
    let lens = |fov| Camera::modern(DVec3::new(0.0, 90.0, 0.1), DVec3::ZERO, fov, 1.5);
    let cone = 1.2_f64.tan();
    for (camera, whole) in [(lens(1.5), true), (lens(0.1), false)] {
        for mut lamp in [Lamp::omni(), Lamp::spot()] {
            let is_spot = lamp.name() == "spot";
            // The image spans tan(fov / 2) * 90 upright and 1.5 times as much across.
            let seen = if whole {
                DVec3::new(40.0, 4.0, 30.0)
            } else {
                DVec3::new(1.5, 0.0, 1.0) * (0.05_f64.tan() * 90.0) + DVec3::Y * 4.0
            };
            let farthest = match is_spot && whole {
                true => DVec3::new(4.0 * cone, 4.0, 4.0 * cone).length(),
                false => seen.length(),
            };
            let report = lamp.record(light, f32::INFINITY, Some(&camera), &scene.list(), &[floor]);
            for view in report.views.iter().filter(|view| view.casters > 0) {
                let reach = f64::from(view.depth_range_world);
                // The near plane lies between the light and the thing, and the camera stands a
                // little aside.
                let expected = farthest - 4.0..farthest * 1.19 * 1.02;
                let name = lamp.name();
                assert!(expected.contains(&reach), "{name}: {reach}, {expected:?}");
            }
        }
    }
}

/// Steps of a walk at 1.5 units a second and 60 frames, that turns by 20 degrees a second.
fn walk(setting: &Setting, frame: u32) -> Camera {
    let time = f64::from(frame) / 60.0;
    let ahead = -setting.camera.pose.axes.z_axis;
    let turned = DQuat::from_rotation_y((20.0 * time).to_radians()) * ahead;
    let eye = setting.camera.pose.eye + ahead.with_y(0.0).normalize() * (1.5 * time);
    Camera::modern(eye, eye + turned, 1.1, 1.5)
}

/// Passes over 100 frames of a walk, by a light that stands still in a scene that stands still.
fn passes(setting: &Setting, mut lamp: Lamp, range: f32) -> u32 {
    let scene = Scene::new(gpu(), &setting.meshes);
    let frames = (0..100).map(|frame| {
        let camera = walk(setting, frame);
        let report = lamp.record(setting.light, range, Some(&camera), &scene.list(), &[]);
        report.passes
    });
    frames.sum()
}

/// What a camera sees changes how far a light without an end reaches, and that alone draws no map
/// again: over a walk the light takes no more passes than one that ends at 20, whose reach never
/// changes, but for casters that it alone reaches.
#[test]
fn a_walk_draws_no_more_for_an_endless_range() {
    let settings = [
        room(),
        lamp_over_table(Shade::Panels, 50.0),
        lamp_over_table(Shade::OneMesh, 1e3),
        street_lamp(50.0),
        street_lamp(1e3),
        street_lamp(1e5),
    ];
    let (mut endless, mut ending) = (0, 0);
    for setting in &settings {
        for kind in [Lamp::omni, Lamp::spot] {
            let [with, without] = [20.0, f32::INFINITY].map(|range| passes(setting, kind(), range));
            let name = setting.name;
            assert!(without <= with, "{name}: {without} passes, {with} at 20");
            endless += without;
            ending += with;
        }
    }
    table::record(
        "a walk of 100 frames around still lamps, endless range, grounds of half side 50 to 1e5",
        "no more passes than with a range of 20",
        format!("{endless} passes, {ending} with a range of 20"),
    );
}

/// A caster that begins exactly where the light's reach ends leaves its view a depth range.
#[test]
fn casters_that_begin_where_the_range_ends() {
    let plate = Mesh::cuboid(Vec3::new(-1.0, -20.0, -1.0), Vec3::new(1.0, -16.0, 1.0));
    let scene = Scene::new(gpu(), &[plate]);
    let everywhere = [Aabb::new(Vec3::splat(-40.0), Vec3::splat(40.0))];
    for mut lamp in Lamp::each_kind() {
        let report = lamp.record(DVec3::ZERO, 16.0, None, &scene.list(), &everywhere);
        for view in report.views.iter().filter(|view| view.casters > 0) {
            assert!(view.depth_range_world > 0.0, "{}: {view:?}", lamp.name());
        }
    }
}
