//! Spot and point lights without an end of their range, as glTF has them by default: what stands
//! close to the light casts, and what a camera sees has its shadows, whatever the size of the
//! ground.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;

use super::stage::scene;
use super::table;
use crate::fixtures::gpu::gpu;
use crate::fixtures::lamp_scenes::{Lamp, Setting, Shade, lamp_over_table, room, street_lamp};
use crate::fixtures::rounding::U;
use crate::fixtures::view_member::member;

/// Half sides of the grounds.
const GROUNDS: [f32; 6] = [5.0, 50.0, 200.0, 1e3, 1e4, 1e5];

/// Returns by how much what lies before a ground of such a half side must rise above it: the
/// ground's depths are displaced by up to 4u of the half side, and receivers are set back by as
/// much.
pub fn lift(ground: f64) -> f64 {
    8.0 * U * ground
}

/// By which share of its way to the light a receiver may be set back for the depths of a ground of
/// such a half side. OpenGL clips depths to -1..1: the ground's err by `s`, u of the half side over
/// the near plane, relative to themselves, and receivers allow for as much. A small caster is then
/// told from a receiver that is farther by 1 + s.
pub fn nearer(lamp: &Lamp, ground: f64) -> f64 {
    if gpu().adapter.backend != wgpu::Backend::Gl {
        return 0.0;
    }
    let drawn = lamp
        .uniforms()
        .iter()
        .filter(|view| member::<f32>(view, "mapping.depth_scale") > 0.0);
    let near = drawn.map(|view| f64::from(member::<f32>(view, "mapping.depth_scale")));
    let error = U * ground / near.fold(f64::INFINITY, f64::min);
    error / (1.0 + error)
}

/// A lamp in a shade and a street lamp on a post: the nearest caster begins 12 and 5 cm from the
/// light, and the ground may end at the horizon. All receivers that the camera sees are as rays
/// have them, but for a gap of the rounding that the far corners of a ground of two triangles are
/// drawn with.
#[test]
fn endless_lights_are_as_the_truth_says() {
    let (mut failures, mut receivers, mut dark_receivers) = (Vec::new(), 0, 0);
    for mut lamp in Lamp::each_kind() {
        for ground in GROUNDS {
            let mut settings = vec![
                lamp_over_table(Shade::Panels, ground),
                lamp_over_table(Shade::OneMesh, ground),
                street_lamp(ground),
            ];
            // A box that contains the light says nothing of how near the mesh is: the share of what
            // is seen has to do.
            if ground <= 200.0 {
                settings.push(lamp_over_table(Shade::WholeScene, ground));
            }
            for setting in settings {
                let scene = scene(&setting.meshes);
                let (casters, camera) = (&scene.list()[..], Some(&setting.camera));
                lamp.reset_history();
                // The least range has the nearest near plane.
                lamp.record(setting.light, 20.0, camera, casters, &[]);
                let ground = f64::from(ground);
                let rounding = (lift(ground), nearer(&lamp, ground));
                let truth = lamp.truth(&setting, &scene, rounding);
                let [dark, lit] = truth.counts();
                assert!(dark > 500 && lit > 500, "{dark} dark, {lit} lit");
                for range in [f32::INFINITY, 500.0, 20.0] {
                    lamp.record(setting.light, range, camera, casters, &[]);
                    let seen = lamp.ask().points(gpu(), &truth.points);
                    let [leaks, false_shadows] = truth.leaks_and_false_shadows(&seen);
                    if leaks + false_shadows > 0 {
                        failures.push(format!(
                            "{} over {}, ground {ground}, range {range}: {leaks} of {dark} lit, {false_shadows} of {lit} dark",
                            lamp.name(),
                            setting.name
                        ));
                    }
                    receivers += dark + lit;
                    dark_receivers += dark;
                }
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{}\n{}",
        gpu().describe(),
        failures.join("\n")
    );
    table::record(
        "lamps in a shade of 0.12 and on a post 0.05 below, endless range, grounds of half side 5 to 1e5",
        "settled receivers in view as the truth says, where it holds 8u of the half side above them; on OpenGL also s / (1 + s) of the way nearer to the light, s = u of the half side over the near plane",
        format!("0 wrong of {receivers} settled receivers, {dark_receivers} of them dark"),
    );
}

/// A bulb of 3 cm around the light hides all, before a ground of 5 and one of a kilometre.
#[test]
fn a_bulb_around_the_light_hides_all() {
    for mut lamp in Lamp::each_kind() {
        for ground in [5.0, 1e3] {
            let mut setting = street_lamp(ground);
            let bulb = Mesh::sphere(setting.light.as_vec3(), 0.015, 8);
            setting.meshes.push(bulb);
            let scene = scene(&setting.meshes);
            let (casters, camera) = (&scene.list()[..], Some(&setting.camera));
            lamp.reset_history();
            lamp.record(setting.light, f32::INFINITY, camera, casters, &[]);
            let truth = lamp.truth(&setting, &scene, (0.0, 0.0));
            assert_eq!(truth.counts()[1], 0);
            let seen = lamp.ask().points(gpu(), &truth.points);
            let lit = seen.iter().filter(|seen| **seen > 0.0).count();
            let (name, count) = (lamp.name(), seen.len());
            assert_eq!(lit, 0, "{name}, ground {ground}: {lit} of {count}");
        }
    }
}

/// The rounding that a receiver allows for is that of its own distance from the light, not of the
/// farthest thing in sight: a sheet 1 cm above a table keeps its shadow before a ground that ends
/// at the horizon. (The ground casts onto nothing.)
#[test]
fn sheets_close_to_a_surface_cast_before_a_wide_ground() {
    let light = DVec3::new(0.2, 2.0, 0.1);
    let mut random = Random::new(31);
    let points: Vec<_> = (0..500)
        .map(|_| {
            let (low, high) = (DVec3::new(-0.15, 0.75, -0.15), DVec3::new(0.15, 0.75, 0.15));
            Point::rounded(random.point(low, high), DVec3::Y)
        })
        .collect();
    for mut lamp in Lamp::each_kind() {
        for ground in [5.0, 1e3, 1e5, 1e6] {
            let setting = Setting {
                meshes: vec![
                    Mesh::floor(0.0, ground),
                    Mesh::cuboid(Vec3::new(-0.6, 0.7, -0.6), Vec3::new(0.6, 0.75, 0.6)),
                    Mesh::sheet(Vec3::new(-0.2, 0.76, -0.2), Vec3::Z * 0.4, Vec3::X * 0.4),
                ],
                light,
                ..lamp_over_table(Shade::Panels, ground)
            };
            let (scene, camera) = (scene(&setting.meshes), Some(&setting.camera));
            lamp.record(light, f32::INFINITY, camera, &scene.list(), &[]);
            let seen = lamp.ask().points(gpu(), &points);
            let lit = seen.iter().filter(|seen| **seen > 0.0).count();
            assert_eq!(lit, 0, "{}, ground {ground}: {lit} of 500", lamp.name());
        }
    }
}

/// A lamp on a ceiling, within rounding before or behind its surface, costs the room below little
/// contact: the reported gap is at most twice that of a lamp 10 cm below, and what is seen is as
/// the truth says.
#[test]
fn a_lamp_on_a_ceiling_resolves_the_room() {
    let mut failures = Vec::new();
    let attic = Mesh::cuboid(Vec3::new(-5.0, 5.2, -5.0), Vec3::new(5.0, 8.0, 5.0));
    let slab = Mesh::cuboid(Vec3::new(-4.0, 5.0, -4.0), Vec3::new(4.0, 5.2, 4.0));
    let sheet = Mesh::sheet(Vec3::new(-4.0, 5.0, -4.0), Vec3::X * 8.0, Vec3::Z * 8.0);
    let tile = Mesh::cuboid(Vec3::new(-0.3, 5.0, -0.4), Vec3::new(0.6, 5.01, 0.5));
    for (ceiling, name) in [(slab, "a slab"), (sheet, "a sheet"), (tile, "a tile")] {
        for mut lamp in [Lamp::omni(), Lamp::spot()] {
            let mut gap_below = None;
            for below in [0.1, 1e-3, 1e-4, 1e-7, 0.0, -1e-7, -1e-4] {
                let mut setting = room();
                setting.meshes[0] = Mesh::floor(0.0, 4.0);
                setting.meshes.extend([ceiling.clone(), attic.clone()]);
                setting.light.y = 5.0 - below;
                let scene = scene(&setting.meshes);
                let truth = lamp.truth(&setting, &scene, (0.0, 0.0));
                let (casters, camera) = (&scene.list()[..], Some(&setting.camera));
                let report = lamp.record(setting.light, f32::INFINITY, camera, casters, &[]);
                let gaps = report.views.iter().map(|view| view.max_peter_panning_world);
                let gap = gaps.fold(0.0, f32::max);
                let gap_below = *gap_below.get_or_insert(gap);
                // The rest of the gap is the kernel's; a near plane at the surface itself would
                // make it endless.
                if gap > 2.0 * gap_below {
                    failures.push(format!(
                        "{} {below} below {name}: a gap of {gap}, {gap_below} at 0.1",
                        lamp.name()
                    ));
                }
                let seen = lamp.ask().points(gpu(), &truth.points);
                let wrong = truth.leaks_and_false_shadows(&seen);
                let counts = truth.counts();
                // From behind its surface the ceiling hides the room, but for a near plane that
                // lies beyond it.
                if below >= 0.0 && wrong != [0, 0] {
                    failures.push(format!(
                        "{} {below} below {name}: {wrong:?} wrong of {counts:?}",
                        lamp.name()
                    ));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
