//! Tests receivers beyond every cascade, behind the camera and far away from everything: they are
//! lit, and no other light's layer is read.

use glam::{DVec3, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::reference::receiver;
use wgpu_shadows::{
    Aabb, Bias, CascadeLayout, CascadeSplit, DirectionalLight, DirectionalShadowDescriptor, Filter,
    OmniLight, ShadowCaster, SpotLight, pool::OmniShadowPool, pool::PoolDescriptor,
    pool::PoolLight, pool::SpotShadowPool,
};

use super::stage::{SUM_ERROR, Sun, differ, scene};
use super::table;
use crate::fixtures::ask::{Ask, submitted};
use crate::fixtures::frames::{Coverage, PoolFrame, RecordFrame};
use crate::fixtures::gpu::gpu;

/// Under an unbounded roof everything that a cascade covers is dark, and everything else is lit, on
/// both sides of every border; the view function returns no layer that does not exist.
#[test]
fn receivers_beyond_every_cascade_are_lit() {
    let roof = scene(&[Mesh::cuboid(
        Vec3::new(-900.0, 30.0, -900.0),
        Vec3::new(900.0, 31.0, 900.0),
    )]);
    let camera = Camera::modern(
        DVec3::new(0.0, 1.7, 0.0),
        DVec3::new(0.3, 1.0, -5.0),
        1.0,
        1.6,
    );
    let floor = [Mesh::floor(0.0, 300.0).bounds()];
    let mut random = Random::new(103);
    let (mut dark, mut lit, mut wrong, mut ties) = (0, 0, 0, 0);
    for cascades in [1, 3, 8] {
        for filter in [
            Filter::default(),
            Filter::Tent7 { sharpness: 1.0 },
            Filter::Nearest,
        ] {
            let mut sun = Sun::new(&DirectionalShadowDescriptor {
                map_size: 128,
                layout: CascadeLayout::Fixed {
                    cascades,
                    split: CascadeSplit::Practical { lambda: 0.8 },
                },
                filter,
                ..Default::default()
            });
            let limited = camera.view().with_max_distance(60.0);
            sun.record(
                DVec3::ZERO,
                DirectionalLight::new(Vec3::new(0.2, -1.0, 0.3)),
                Coverage::Camera(limited),
                &roof.list(),
                &floor,
            );
            let ask_view = Ask::new(
                gpu(),
                &[("sun", sun.shadow.maps())],
                "f32(shadow_view_sun(point.position))",
            );
            let mut places: Vec<_> = (0..3000)
                .map(|_| {
                    let away = 10_f64.powf(random.range(-1.0, 2.4));
                    let angle = random.range(0.0, std::f64::consts::TAU);
                    DVec3::new(angle.cos() * away, 0.0, angle.sin() * away)
                })
                .collect();
            for axis in [DVec3::X, DVec3::Z, DVec3::ONE, DVec3::NEG_Y] {
                places.extend([1e4, 1e6, 1e12, 1e30].map(|away| axis * away));
                places.extend([1e4, 1e6, 1e12, 1e30].map(|away| axis * -away));
            }
            let points: Vec<_> = places
                .iter()
                .map(|place| Point::rounded(*place, DVec3::Y))
                .collect();
            let seen = sun.ask(&points);
            let layers = ask_view.points(gpu(), &points);
            for ((place, seen), layer) in places.iter().zip(&seen).zip(&layers) {
                assert!(
                    *layer <= cascades as f32,
                    "layer {layer} of {cascades} at {place}"
                );
                let at = place.as_vec3().as_dvec3();
                let inside = |nudge: DVec3| {
                    let forward = -camera.pose.axes.z_axis;
                    if forward.dot(at + nudge - camera.pose.eye) >= 60.0 {
                        return false;
                    }
                    let mut views = sun.shadow.maps().view_uniforms().iter();
                    views
                        .any(|view| receiver(view, filter, Bias::Auto, at + nudge, DVec3::Y).inside)
                };
                // f32 decides within a thousandth of a unit of a border.
                let here = inside(DVec3::ZERO);
                // The distance limit is sharp to a ten-thousandth of the distance.
                let nudge = 1e-2 * (1.0 + at.length() * 1e-2);
                if [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z]
                    .iter()
                    .any(|step| inside(*step * nudge) != here)
                {
                    ties += 1;
                    continue;
                }
                wrong += usize::from(differ(*seen, if here { 0.0 } else { 1.0 }, SUM_ERROR));
                dark += usize::from(here);
                lit += usize::from(!here);
            }
        }
    }
    assert_eq!(
        wrong,
        0,
        "of {dark} inside and {lit} outside on {}",
        gpu().describe()
    );
    assert!(
        dark > 1000 && lit > 3000 && ties * 20 < dark,
        "{dark} {lit} {ties}"
    );
    table::record(
        "receivers behind the camera, beyond the last cascade and up to 1e30 away",
        "lit where no cascade holds them, dark under a roof where one does, no layer that is not there",
        format!(
            "{wrong} wrong of {} receivers, {lit} of them outside",
            dark + lit
        ),
    );
}

/// The views of a pool lie side by side in one layer: beside a light that is completely dark, a
/// light whose map is empty is lit up to the border of its map, and beyond.
#[test]
fn no_light_of_a_pool_reads_its_neighbours() {
    let gpu = gpu();
    let descriptor = PoolDescriptor {
        map_size: 512,
        capacity: 3,
        filter: Filter::Tent7 { sharpness: 1.0 },
        ..Default::default()
    };
    let mut spots = SpotShadowPool::new(&gpu.device, &descriptor).expect("a pool");
    let mut lamps = OmniShadowPool::new(&gpu.device, &descriptor).expect("a pool");
    // The middle light is far from the others, in the open.
    let places = [DVec3::ZERO, DVec3::X * 100.0, DVec3::X * 200.0];
    let shells: Vec<_> = [places[0], places[2]]
        .iter()
        .map(|place| Mesh::cuboid(place.as_vec3() - 1.0, place.as_vec3() + 1.0))
        .collect();
    // Something casts in every view of the middle light as well, so that its layers are drawn:
    // small plates on all sides.
    let plates = [
        Vec3::X,
        Vec3::NEG_X,
        Vec3::Y,
        Vec3::NEG_Y,
        Vec3::Z,
        Vec3::NEG_Z,
    ]
    .map(|axis| {
        let at = places[1].as_vec3() + axis * 2.0;
        Mesh::cuboid(at - 0.01, at + Vec3::splat(0.01))
    });
    let scene = scene(&[&shells[..], &plates].concat());
    let slots = [(); 3].map(|()| (spots.insert().expect("free"), lamps.insert().expect("free")));
    let receivers = [Aabb::new(Vec3::splat(-10.0), Vec3::new(210.0, 10.0, 10.0))];
    let spot_lights: Vec<_> = slots
        .iter()
        .zip(places)
        .map(|((slot, _), position_world)| PoolLight {
            slot: *slot,
            light: SpotLight {
                position_world,
                direction: Vec3::new(0.2, -1.0, 0.1),
                outer_angle_radians: 0.9,
                range: 8.0,
            },
            importance: 1.0,
        })
        .collect();
    let lamp_lights: Vec<_> = slots
        .iter()
        .zip(places)
        .map(|((_, slot), position_world)| PoolLight {
            slot: *slot,
            light: OmniLight {
                position_world,
                range: 8.0,
            },
            importance: 1.0,
        })
        .collect();
    let casters = &scene.list()[..];
    let spot_frame = pool_frame(&spot_lights, casters, &receivers);
    let lamp_frame = pool_frame(&lamp_lights, casters, &receivers);
    submitted(gpu, |encoder| spots.record_frame(encoder, &spot_frame)).expect("a frame");
    submitted(gpu, |encoder| lamps.record_frame(encoder, &lamp_frame)).expect("a frame");
    let mut random = Random::new(107);
    let directions: Vec<_> = (0..4000).map(|_| random.direction()).collect();
    let mut asked = 0;
    let mut check = |ask: &Ask, place: DVec3, dark: bool, wanted: &dyn Fn(DVec3) -> bool| {
        let kept = directions.iter().filter(|direction| wanted(**direction));
        let points: Vec<_> = kept
            .map(|direction| Point::rounded(place + *direction * 5.0, -*direction))
            .collect();
        let right = if dark { 0.0 } else { 1.0 };
        let seen = ask.points(gpu, &points);
        let wrong = seen
            .iter()
            .filter(|seen| differ(**seen, right, SUM_ERROR))
            .count();
        assert_eq!(wrong, 0, "of {} on {}", points.len(), gpu.describe());
        asked += points.len();
    };
    let axis = DVec3::new(0.2, -1.0, 0.1).normalize();
    // The kernel of a plate is 4 texels and a half, of at most 2 tan 0.9 / 64 each; a plate's own
    // corner adds 0.01.
    let clear = |direction: DVec3| direction.abs().max_element() / direction.length() < 0.9;
    for (index, place) in places.into_iter().enumerate() {
        let (spot, lamp) = slots[index];
        let dark = index != 1;
        let ask = Ask::slot(gpu, spots.maps(), spot.index());
        check(&ask, place, dark, &|d| {
            (dark || clear(d)) && d.angle_between(axis) < 0.89
        });
        let ask = Ask::slot(gpu, lamps.maps(), lamp.index());
        check(&ask, place, dark, &|d| dark || clear(d));
    }
    table::record(
        "lights of a pool whose neighbours in the texture are all dark",
        "lit up to the border of their maps; the neighbours dark up to theirs",
        format!("0 wrong of {asked} receivers"),
    );
}

fn pool_frame<'a, L>(
    lights: &'a [PoolLight<L>],
    casters: &'a [&'a dyn ShadowCaster],
    receivers: &'a [Aabb],
) -> PoolFrame<'a, L> {
    PoolFrame {
        origin: DVec3::ZERO,
        lights,
        camera: None,
        casters,
        receivers,
        max_views: None,
    }
}
