//! Tests the layer that the lights of a pool share: whatever comes, goes, moves and waits, each
//! light shows its own shadows or none.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CameraView, Casters, Coverage, OmniLight, ShadowCaster, ShadowFrameDescriptor,
    ShadowScene, pool::OmniShadowPool, pool::PoolDescriptor, pool::PoolLight, pool::ShadowSlot,
    report::ShadowReport, report::ViewStatus,
};

use crate::fixtures::ask::{Ask, submitted};
use crate::fixtures::frames::{PoolFrame, RecordFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::scene::default_pipeline;

const CAPACITY: usize = 7;
const HALF: f32 = 9.0;
const FLOOR: Aabb = Aabb::new(Vec3::new(-HALF, -0.1, -HALF), Vec3::new(HALF, 0.0, HALF));

/// Is what the map of a light was drawn from.
#[derive(Clone)]
struct Shown {
    light: OmniLight,
    boxes: Vec<Aabb>,
    camera: CameraView,
}

/// Is a light of the pool with what it should show.
struct Known {
    slot: ShadowSlot,
    light: OmniLight,
    shown: State,
}

#[derive(Clone)]
enum State {
    /// It has never been drawn: everything is lit.
    Lit,
    Shown(Box<Shown>),
    /// It may show an earlier map or none.
    Either,
}

fn sees(camera: &CameraView, point: Vec3) -> bool {
    let clip = camera.clip_from_view * camera.view_from_render * point.extend(1.0);
    clip.w > 0.1 && clip.truncate().abs().truncate().max_element() < 0.95 * clip.w
}

/// Returns the distance from `point` of the first box between it and `light`.
fn occluder(boxes: &[Aabb], point: DVec3, light: DVec3) -> Option<f64> {
    let way = light - point;
    let hits = boxes.iter().filter_map(|bounds| {
        let low = (bounds.min.as_dvec3() - point) / way;
        let high = (bounds.max.as_dvec3() - point) / way;
        let enter = low.min(high).max_element().max(0.0);
        let leave = low.max(high).min_element().min(1.0);
        (enter < leave).then_some(enter * way.length())
    });
    hits.min_by(f64::total_cmp)
}

/// Returns the visibility of a point of the floor, if it is the same all around it, and what hides
/// it is not too near to it.
fn settled(shown: &Shown, point: DVec3, radius: f64) -> Option<f32> {
    let light = shown.light.position_world;
    if point.distance(light) > f64::from(shown.light.range) * 0.98 {
        return None;
    }
    let hidden = occluder(&shown.boxes, point, light);
    let is_near = hidden.is_some_and(|distance| distance < radius);
    let rings = [0.3, 0.65, 1.0].into_iter().flat_map(|share| {
        (0..12).map(move |step| {
            let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 12.0).sin_cos();
            DVec3::new(cos, 0.0, sin) * (share * radius)
        })
    });
    let mut same = rings.map(|offset| occluder(&shown.boxes, point + offset, light).is_some());
    let same = same.all(|around| around == hidden.is_some());
    (same && !is_near).then_some(if hidden.is_some() { 0.0 } else { 1.0 })
}

/// Checks that no two views have a texel in common, and that all are in the layer.
fn check_texels(report: &ShadowReport, map_size: u32) {
    let views = report.views.iter().filter(|view| view.texels.size.x > 0);
    let rects: Vec<_> = views.map(|view| view.texels).collect();
    for (index, rect) in rects.iter().enumerate() {
        assert!(
            (rect.min + rect.size)
                .cmple(glam::UVec2::splat(map_size))
                .all()
        );
        for other in &rects[..index] {
            let meets =
                rect.min.cmplt(other.min + other.size) & other.min.cmplt(rect.min + rect.size);
            assert!(!meets.all(), "{rect:?} and {other:?}");
        }
    }
}

/// Lights come and go, move and are left out, casters move, the camera wanders and cuts, and the
/// budget is anything from one view to all. In every frame, the lights that were refreshed show the
/// shadows of that frame, those that were deferred show the shadows of the frame in which they were
/// refreshed last, and new ones show none.
///
/// A point is asked where a disc around it is all lit or all hidden whose radius is that of a
/// kernel with its displacement: the default filter reaches 2.5 texels, the bias moves by 0.1, and
/// a texel is at most as large as at the end of the reach. Toward a corner it is √2 times that:
/// 3.7, and 5 with the rise of the floor across the view.
#[test]
fn each_light_shows_its_own_shadows_whatever_happens() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let frames = if std::env::var_os("SHADOW_LONG").is_some() {
        4000
    } else {
        500
    };
    let map_size = 1000;
    let descriptor = PoolDescriptor {
        capacity: CAPACITY as u32,
        map_size,
        ..Default::default()
    };
    let mut pool = OmniShadowPool::new(&gpu.device, &descriptor).expect("a valid pool");
    let value = "shadow_lights(u32(length(point.normal) + 0.5) - 1u, point.position, normalize(point.normal))";
    let ask = Ask::new(gpu, &[("lights", pool.maps())], value);
    let mut random = Random::new(97);
    let shape = Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5));
    let mut casters: Vec<_> = (0..9)
        .map(|_| shape.caster(gpu, &pipeline, Mat4::IDENTITY))
        .collect();
    let mut boxes = vec![Aabb::new(Vec3::ZERO, Vec3::ONE); casters.len()];
    let mut known: Vec<Known> = Vec::new();
    let mut eye = DVec3::new(0.0, 5.0, 11.0);
    let (mut asked, mut dark, mut deferred, mut sizes) =
        (0, 0, 0, std::collections::BTreeSet::new());
    for step in 0..frames {
        for (caster, bounds) in casters.iter_mut().zip(&mut boxes) {
            if step == 0 || random.chance(0.02) {
                let place = random.point(DVec3::new(-7.0, 0.7, -7.0), DVec3::new(7.0, 1.2, 7.0));
                let size = random.point(DVec3::splat(0.4), DVec3::new(2.0, 0.6, 2.0));
                let (place, size) = (place.as_vec3(), size.as_vec3());
                let transform = Mat4::from_translation(place) * Mat4::from_scale(size);
                caster.set_transform(transform).expect("a finite matrix");
                *bounds = Aabb::new(place - size * 0.5, place + size * 0.5);
            }
        }
        let new_place = |random: &mut Random| {
            random.point(DVec3::new(-6.0, 2.2, -6.0), DVec3::new(6.0, 4.5, 6.0))
        };
        if known.len() < CAPACITY && random.chance(0.1) {
            known.push(Known {
                slot: pool.insert().expect("a free slot"),
                light: OmniLight {
                    position_world: new_place(&mut random),
                    range: random.between(4.0, 12.0),
                },
                shown: State::Lit,
            });
        }
        if !known.is_empty() && random.chance(0.02) {
            let gone = known.swap_remove(random.index(known.len()));
            pool.remove(gone.slot).expect("a slot in use");
        }
        for known in &mut known {
            if random.chance(0.03) {
                known.light.position_world = new_place(&mut random);
            } else if random.chance(0.1) {
                known.light.position_world.x += 0.01;
            }
        }
        eye += random.point(DVec3::splat(-0.1), DVec3::splat(0.1));
        if random.chance(0.02) {
            eye = random.point(DVec3::new(-9.0, 2.0, -9.0), DVec3::new(9.0, 7.0, 9.0));
        }
        let target = DVec3::new(0.5 * eye.x.sin(), 0.0, 0.3);
        let camera = Camera::modern(eye, target, 0.9, 1.6).view();
        if random.chance(0.01) {
            pool.reset_history();
        }
        if random.chance(0.01) {
            pool.invalidate();
            for known in &mut known {
                known.shown = State::Lit;
            }
        }
        let (listed, unlisted): (Vec<_>, Vec<_>) =
            known.iter_mut().partition(|_| random.chance(0.97));
        let lights: Vec<_> = listed
            .iter()
            .map(|known| PoolLight {
                slot: known.slot,
                light: known.light,
                importance: 1.0,
            })
            .collect();
        let list: Vec<&dyn ShadowCaster> = casters.iter().map(|caster| caster as _).collect();
        let frame = PoolFrame {
            origin: DVec3::ZERO,
            lights: &lights,
            camera: Some(camera),
            casters: &list,
            receivers: &[FLOOR],
            max_views: (step % 200 > 20).then(|| 1 + random.index(9) as u32),
        };
        let report = submitted(gpu, |encoder| pool.record_frame(encoder, &frame));
        let report = report.expect("a valid frame");
        check_texels(&report, map_size);
        sizes.extend(report.views.iter().map(|view| view.texels.size.x));
        let (mut points, mut wanted) = (Vec::new(), Vec::new());
        let mut add = |place: DVec3, slot: ShadowSlot, answer: f32| {
            let normal = DVec3::Y * f64::from(slot.index() + 1);
            points.push(Point::rounded(place, normal));
            wanted.push((slot.index(), answer));
        };
        let mut place = || random.point(DVec3::new(-8.0, 0.0, -8.0), DVec3::new(8.0, 0.0, 8.0));
        for known in unlisted {
            add(place(), known.slot, 1.0);
            if let State::Shown(_) = known.shown {
                known.shown = State::Either;
            }
        }
        for (known, views) in listed.into_iter().zip(report.views.chunks(6)) {
            let waits = |view: &&_| {
                let view: &wgpu_shadows::report::ViewReport = view;
                view.status == ViewStatus::Deferred
            };
            let waiting = views.iter().filter(waits).count();
            deferred += waiting;
            match waiting {
                0 => {
                    known.shown = State::Shown(Box::new(Shown {
                        light: known.light,
                        boxes: boxes.clone(),
                        camera,
                    }));
                }
                6 => {}
                _ => known.shown = State::Either,
            }
            let texels = views.iter().map(|view| view.texel_size_world.max_element());
            let radius = 5.0 * f64::from(texels.fold(0.0, f32::max));
            for _ in 0..40 {
                let place = place();
                match &known.shown {
                    State::Lit => add(place, known.slot, 1.0),
                    State::Either => {}
                    State::Shown(shown) => {
                        let seen = [&camera, &shown.camera];
                        if seen.iter().all(|camera| sees(camera, place.as_vec3())) {
                            if let Some(answer) = settled(shown, place, radius) {
                                dark += usize::from(answer == 0.0);
                                add(place, known.slot, answer);
                            }
                        }
                    }
                }
            }
        }
        if points.is_empty() {
            continue;
        }
        asked += points.len();
        for ((seen, (slot, wanted)), point) in
            ask.points(gpu, &points).iter().zip(wanted).zip(&points)
        {
            assert!(
                (seen - wanted).abs() < 1e-3,
                "slot {slot} in frame {step}: {seen} instead of {wanted} at {:?}",
                point.position
            );
        }
    }
    assert!(
        asked > 20 * frames && dark > frames && deferred > frames,
        "{asked} {dark} {deferred}"
    );
    assert!(sizes.len() > 3, "{sizes:?}");
}

/// The camera stands beside one of two lamps until its texels are settled, cuts to the other, where
/// it stays, and cuts back. Nothing changes after a cut; the lamp that is near comes to have as
/// many texels as the other, or more, all the same.
#[test]
fn texels_follow_a_camera_that_cuts_and_stands_still() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let descriptor = PoolDescriptor {
        capacity: 2,
        map_size: 1024,
        ..Default::default()
    };
    let mut pool = OmniShadowPool::new(&gpu.device, &descriptor).expect("a valid pool");
    let places = [-7.0, 7.0];
    let lights = places.map(|x| PoolLight {
        slot: pool.insert().expect("a free slot"),
        light: OmniLight {
            position_world: DVec3::new(x, 2.5, 0.0),
            range: 6.0,
        },
        importance: 1.0,
    });
    let cube = Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5));
    let casters = places.map(|x| {
        let transform = Mat4::from_translation(Vec3::new(x as f32 + 0.8, 0.5, 0.4));
        cube.caster(gpu, &pipeline, transform)
    });
    let list: Vec<&dyn ShadowCaster> = casters.iter().map(|caster| caster as _).collect();
    let mut scene = ShadowScene::new();
    for watched in [0, 1, 0] {
        let x = places[watched];
        let mut texels = [0; 2];
        let eye = DVec3::new(1.6 * x, 5.0, 7.0);
        let camera = Camera::modern(eye, DVec3::ZERO, 0.9, 1.6).view();
        // Sizes change by predictions, which are made every 16 frames and have to agree. The cut
        // comes between two of them.
        for _ in 0..75 {
            let frame = scene.frame(&ShadowFrameDescriptor {
                origin: DVec3::ZERO,
                coverage: Coverage::Cameras(&[camera]),
                casters: Casters::List(&list),
                receivers: &[FLOOR],
            });
            let mut encoder = gpu.encoder();
            let report = pool.record(&mut encoder, &frame.expect("a frame"), &lights, None);
            let views = &report.expect("a valid frame").views;
            let area = |light: usize| -> u32 {
                let own = &views[6 * light..6 * light + 6];
                own.iter()
                    .map(|view| view.texels.size.element_product())
                    .sum()
            };
            texels = [area(0), area(1)];
            gpu.submit(encoder);
        }
        assert!(
            texels[watched] >= texels[1 - watched],
            "{watched}: {texels:?}"
        );
    }
}
