//! Tests that the shadows of static casters do not change while other casters move.

use glam::{DVec3, Mat4, Quat, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use wgpu_shadows::{
    CascadeLayout, DirectionalShadowDescriptor, MeshCaster, OmniLight, OmniShadow,
    OmniShadowDescriptor, ShadowCaster,
};

use super::stage::{Sun, level, shining};
use super::table;
use crate::fixtures::ask::{Ask, record_omni};
use crate::fixtures::frames::{Coverage, OmniFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::scene::default_pipeline;

const FRAMES: u32 = 300;

/// Returns receivers on the ground around the static box.
fn samples() -> Vec<DVec3> {
    let steps = || (0..70).map(|step| -0.7 + f64::from(step) * 0.0311);
    let positions = steps().flat_map(|x| steps().map(move |z| DVec3::new(x, 0.0, z)));
    positions
        .map(|position| position.as_vec3().as_dvec3())
        .collect()
}

/// Describes the moving casters of a scene, each a box around the origin, and their transforms in a
/// frame.
struct Motion {
    name: &'static str,
    boxes: Vec<Vec3>,
    transforms: fn(usize, f32) -> Mat4,
}

fn motions() -> [Motion; 4] {
    let crowd = (0..24).map(|_| Vec3::new(0.2, 0.8, 0.2)).collect();
    [
        Motion {
            name: "a walker",
            boxes: vec![Vec3::new(0.2, 0.85, 0.2)],
            transforms: |_, time| Mat4::from_translation(Vec3::new(2.0 + 1.4 * time, 0.85, -1.0)),
        },
        Motion {
            name: "a bouncing ball",
            boxes: vec![Vec3::splat(0.2)],
            transforms: |_, time| {
                let height = 0.2 + 2.0 * (3.0 * time).sin().abs();
                Mat4::from_translation(Vec3::new(2.0, height, 0.5))
            },
        },
        Motion {
            name: "a turning fan",
            boxes: vec![Vec3::new(1.5, 0.02, 0.1)],
            transforms: |_, time| {
                let turn = Quat::from_rotation_y(2.0 * time);
                Mat4::from_rotation_translation(turn, Vec3::new(2.5, 1.5, 0.0))
            },
        },
        Motion {
            name: "a growing crowd",
            boxes: crowd,
            // Every twelve frames another caster rises from below the ground, each a little farther
            // away.
            transforms: |index, time| {
                let joined = time * 60.0 >= 12.0 * index as f32;
                let angle = index as f32 * 2.4;
                let away = 1.5 + 0.25 * index as f32;
                let height = if joined { 0.8 } else { -5.0 };
                Mat4::from_translation(Vec3::new(away * angle.cos(), height, away * angle.sin()))
            },
        },
    ]
}

/// Counts the changes of the static shadow over the frames.
#[derive(Default)]
struct Changes {
    frames: u32,
    sizes: u32,
    coarsest: f64,
    finest: f64,
}

impl Changes {
    fn words(&self, name: &str) -> String {
        format!(
            "{name}: {} frames, {} sizes, texels at most {:.2} times the first",
            self.frames,
            self.sizes,
            self.coarsest / self.finest
        )
    }

    /// Asserts that the still shadow changed in at most one frame of a hundred, and returns the
    /// words.
    fn few(&self, name: &str) -> String {
        let words = self.words(name);
        assert!(self.frames * 100 <= FRAMES, "{words}");
        words
    }

    fn texel(&mut self, texel: f64, last: f64) {
        self.sizes += u32::from(texel != last && last > 0.0);
        self.coarsest = self.coarsest.max(texel);
        if self.finest == 0.0 {
            self.finest = texel;
        }
    }
}

/// Plays a motion and looks up the visibilities of receivers onto which no moving caster ever
/// casts.
fn play(
    motion: &Motion,
    mut record: impl FnMut(&[&dyn ShadowCaster]) -> f64,
    mut ask: impl FnMut() -> Vec<f32>,
) -> Changes {
    let pipeline = default_pipeline(gpu());
    let still = [
        Mesh::floor(0.0, 20.0),
        Mesh::cuboid(Vec3::new(-0.3, 0.0, -0.3), Vec3::new(0.3, 0.7, 0.3)),
    ];
    let still: Vec<MeshCaster> = still
        .iter()
        .map(|mesh| mesh.caster(gpu(), &pipeline, Mat4::IDENTITY))
        .collect();
    let mut moving: Vec<MeshCaster> = motion
        .boxes
        .iter()
        .map(|half| Mesh::cuboid(-*half, *half).caster(gpu(), &pipeline, Mat4::IDENTITY))
        .collect();
    let mut changes = Changes::default();
    let mut last: Option<Vec<f32>> = None;
    let mut last_texel = 0.0;
    for frame in 0..FRAMES {
        for (index, caster) in moving.iter_mut().enumerate() {
            let transform = (motion.transforms)(index, frame as f32 / 60.0);
            caster.set_transform(transform).expect("a finite transform");
        }
        let list: Vec<&dyn ShadowCaster> = still
            .iter()
            .chain(&moving)
            .map(|caster| caster as &dyn ShadowCaster)
            .collect();
        let texel = record(&list);
        changes.texel(texel, last_texel);
        let seen = ask();
        if let Some(last) = &last {
            // A change by a tenth is visible as a twitch. Rounding is far below it.
            let twitches = last.iter().zip(&seen).any(|(a, b)| (a - b).abs() > 0.1);
            changes.frames += u32::from(twitches);
        }
        last = Some(seen);
        last_texel = texel;
    }
    changes
}

/// Checks that a static shadow changes in at most one frame of a hundred because other casters
/// move.
#[test]
fn still_shadows_stay_still_beside_moving_casters() {
    let mut words = Vec::new();
    let light = DVec3::new(0.35, -1.0, 0.3);
    let camera = Camera::modern(
        DVec3::new(4.0, 6.0, 9.0),
        DVec3::new(2.0, 0.0, 0.0),
        0.9,
        1.6,
    );
    let points = level(&samples(), DVec3::ZERO);
    for motion in &motions() {
        // The walker and the crowd cast their shadows away from the box. The ball and the fan are
        // beside it.
        let changes = |descriptor: &DirectionalShadowDescriptor<'_>| {
            let sun = std::cell::RefCell::new(Sun::new(descriptor));
            play(
                motion,
                |list| {
                    let coverage = Coverage::Camera(camera.view());
                    let mut sun = sun.borrow_mut();
                    sun.record(DVec3::ZERO, shining(light), coverage, list, &[]);
                    sun.texel()
                },
                || sun.borrow().ask(&points),
            )
        };
        let fixed = DirectionalShadowDescriptor {
            map_size: 512,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        };
        words.push(changes(&fixed).few(motion.name));
        let automatic = DirectionalShadowDescriptor {
            layout: CascadeLayout::Automatic { max_cascades: 4 },
            ..fixed
        };
        changes(&automatic).few(motion.name);
    }
    table::record(
        "casters that move beside a still box under a sun, 300 frames each",
        "the still shadow changes in at most 3 of them",
        words.join("; "),
    );
}

#[test]
fn still_shadows_of_a_lamp_stay_still_beside_moving_casters() {
    let mut words = Vec::new();
    let points = level(&samples(), DVec3::ZERO);
    for motion in &motions() {
        let descriptor = OmniShadowDescriptor {
            map_size: 512,
            ..Default::default()
        };
        let shadow = OmniShadow::new(&gpu().device, &descriptor).expect("a valid lamp");
        let ask = Ask::light(gpu(), shadow.maps());
        let shadow = std::cell::RefCell::new(shadow);
        let camera = Camera::modern(
            DVec3::new(4.0, 6.0, 9.0),
            DVec3::new(2.0, 0.0, 0.0),
            0.9,
            1.6,
        );
        let changes = play(
            motion,
            |list| {
                let frame = OmniFrame {
                    origin: DVec3::ZERO,
                    light: OmniLight {
                        position_world: DVec3::new(-0.6, 3.0, -0.4),
                        range: 30.0,
                    },
                    camera: Some(camera.view()),
                    casters: list,
                    receivers: &[],
                };
                let mut shadow = shadow.borrow_mut();
                let report = record_omni(gpu(), &mut shadow, &frame).expect("a valid frame");
                // The face that looks down contains the receivers.
                f64::from(report.views[3].texel_size_world.max_element())
            },
            || ask.points(gpu(), &points),
        );
        words.push(changes.few(motion.name));
    }
    table::record(
        "casters that move beside a still box under a lamp, 300 frames each",
        "the still shadow changes in at most 3 of them",
        words.join("; "),
    );
}
