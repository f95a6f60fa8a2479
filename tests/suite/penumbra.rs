//! Tests `Filter::Pcss`: the device against the CPU reference, and both against the true shadow of
//! a light with a size.
//!
//! The closed form is this: a half-plane whose edge hides a disk-shaped light transmits the part of
//! the disk that lies beyond a chord. With t the distance of a receiver from the middle of the
//! penumbra divided by the half-width R of the penumbra, that is 1/2 + (t √(1 - t²) + asin t) / π.
//! A sun of angular diameter a spreads R = h tan(a/2) under an edge of height h; a disk of radius r
//! at height H spreads R = r h / (H - h).

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::readback;
use wgpu_shadows::reference::{self, DepthLayer, Receiver};
use wgpu_shadows::{
    Aabb, Bias, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    Filter, SpotLight, SpotShadow, SpotShadowDescriptor,
};

use crate::fixtures::ask::{Ask, record_spot};
use crate::fixtures::frames::{Coverage, DirectionalFrame, SpotFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::rounding::band;
use crate::fixtures::scene::Scene;
use crate::fixtures::table;
use crate::suite::filter_parity::{Lit, at_border, place, points, scene};

/// Is the error of the samples' positions: WGSL guarantees sine and cosine to 2^-11 of the unit
/// circle, and the widest disk is 32 texels.
const SAMPLE_ERROR_TEXELS: f64 = 32.0 / 2048.0;

/// Each result lies between the least and the greatest of the CPU reference's around the receiver:
/// at the corners of its rounding band, widened by the error of the samples' positions. A single
/// sample can fall to the other side of a texel's border, which changes the mean height of the
/// occluders, and with it the radius, by a fraction of itself; one in a hundred results may be off
/// by that.
#[test]
fn penumbrae_are_those_of_the_reference() {
    let gpu = gpu();
    let scene = scene();
    let sizes = [0.01, 0.2, 0.8];
    let fixed = sizes.map(|light_size| Filter::Pcss { light_size });
    let turned = sizes.map(|light_size| Filter::PcssRotated { light_size });
    for filter in fixed.into_iter().chain(turned) {
        let bias = Bias::Auto;
        let lit = Lit::new(gpu, &scene, 131, filter, bias);
        let depths = readback::depth_layer(gpu, lit.shadow.maps().texture(), 0);
        let map = DepthLayer {
            size: 131,
            depths: &depths,
        };
        let points = points(&scene, 7);
        let answers = SunProbe::new(gpu, &lit.shadow).ask(gpu, &points);
        let (mut compared, mut partial, mut outside) = (0, 0, Vec::new());
        for (point, answer) in points.iter().zip(answers) {
            let (position, normal) = place(point);
            let receiver = reference::receiver(&lit.view, filter, bias, position, normal);
            assert!((0.0..=1.0).contains(&answer), "{answer} at {point:?}");
            let Some(band) = band(&lit.view, filter, bias, position, normal, &receiver) else {
                continue;
            };
            if at_border(&lit.view, position, &band) {
                continue;
            }
            let texel = band.texel + SAMPLE_ERROR_TEXELS;
            let depth = band.reference_depth(filter, &receiver);
            let references = (0..9).map(|corner| {
                let sign = |bit: u32| f64::from(corner >> bit & 1) * 2.0 - 1.0;
                let (aside, toward) = match corner {
                    8 => (DVec2::ZERO, 0.0),
                    _ => (DVec2::new(sign(0), sign(1)), sign(2)),
                };
                let moved = Receiver {
                    texel: receiver.texel + aside * texel,
                    depth: receiver.depth + toward * depth,
                    ..receiver
                };
                reference::visibility(filter, &map, &moved)
            });
            let (low, high) = references.fold((1.0_f64, 0.0_f64), |(low, high), seen| {
                (low.min(seen), high.max(seen))
            });
            // The tolerance covers sums of 128 products, and the tent's sharpness of three.
            let tolerance = 1e-4;
            let answer = f64::from(answer);
            compared += 1;
            partial += usize::from(low > 0.02 && high < 0.98);
            let off = (low - answer).max(answer - high);
            if off > tolerance {
                outside.push(off);
            }
        }
        let worst = outside.iter().copied().fold(0.0, f64::max);
        let count = outside.len();
        assert!(
            compared > 3500 && partial > 100,
            "{compared} compared, {partial} partial"
        );
        assert!(
            count <= compared / 100 && worst < 0.1,
            "{filter:?}: {count} of {compared} off, by {worst} at worst"
        );
    }
}

/// Returns the fraction of a disk of radius 1 that lies beyond a chord at -t.
pub(super) fn beyond_chord(t: f64) -> f64 {
    let t = t.clamp(-1.0, 1.0);
    0.5 + (t * (1.0 - t * t).sqrt() + t.asin()) / PI
}

/// Returns where the closed form reaches `share`, in half-widths.
fn chord_of(share: f64) -> f64 {
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if beyond_chord(middle) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Is the number of positions along x from -2R to 2R, on lines along z whose starts are spread over
/// a texel.
pub(super) const STEPS: usize = 161;
const LINES: usize = 12;

/// Holds the visibilities across an edge at x = 0 under rotation by `turn` around y, against the
/// closed form of half-width `radius`.
pub(super) struct Profile {
    /// Is the mean over the lines at each step.
    mean: Vec<f64>,
    /// Is the root mean square error over all positions.
    rmse: f64,
}

impl Profile {
    pub(super) fn across(step: usize) -> f64 {
        (step as f64 / (STEPS - 1) as f64 - 0.5) * 4.0
    }

    fn measure(radius: f64, turn: f64, ask: impl Fn(&[Point]) -> Vec<f32>) -> Self {
        let turned = |v: DVec3| v.rotate_axis(DVec3::Y, turn);
        let points: Vec<_> = (0..LINES)
            .flat_map(|line| (0..STEPS).map(move |step| (line, step)))
            .map(|(line, step)| {
                let z = (line as f64 - 5.5) * 0.0371;
                let place = DVec3::new(Self::across(step) * radius, 0.0, z);
                Point::rounded(turned(place), DVec3::Y)
            })
            .collect();
        let seen = ask(&points);
        let mut mean = vec![0.0; STEPS];
        let mut square = 0.0;
        for (index, seen) in seen.iter().enumerate() {
            let step = index % STEPS;
            mean[step] += f64::from(*seen) / LINES as f64;
            square += (f64::from(*seen) - beyond_chord(Self::across(step))).powi(2);
        }
        Self {
            mean,
            rmse: (square / seen.len() as f64).sqrt(),
        }
    }

    /// Returns the distance between 10 % and 90 %, in half-widths, by the first crossing of either.
    fn width(&self) -> f64 {
        let crossing = |share: f64| {
            let after = self.mean.iter().position(|seen| *seen >= share);
            let after = after.expect("the profile rises to 1").max(1);
            let (before, here) = (self.mean[after - 1], self.mean[after]);
            let part = (share - before) / (here - before);
            Self::across(after - 1) + part * (Self::across(1) - Self::across(0))
        };
        crossing(0.9) - crossing(0.1)
    }

    /// Returns the relative error of the width in relation to the closed form's, and the rmse.
    pub(super) fn assert_true(&self, name: &str) -> [f64; 2] {
        let wanted = chord_of(0.9) - chord_of(0.1);
        let width = self.width();
        assert!(
            (width / wanted - 1.0).abs() <= 0.1,
            "{name}: {width} half-widths wide, {wanted} by the closed form"
        );
        assert!(self.rmse <= 0.05, "{name}: rmse {}", self.rmse);
        [(width / wanted - 1.0).abs(), self.rmse]
    }
}

fn larger(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].max(b[1])]
}

fn words([width, rmse]: [f64; 2]) -> String {
    format!("width within {:.1} %, rmse {rmse:.3}", 100.0 * width)
}

/// Returns a floor, and a half-plane at height `height` that covers x < 0, rotated around y.
fn half_plane(gpu: &Gpu, height: f64, turn: f64) -> Scene {
    let turned = |v: DVec3| v.rotate_axis(DVec3::Y, turn).as_vec3();
    let sheet = Mesh::sheet(
        turned(DVec3::new(-8.0, height, -8.0)),
        turned(DVec3::new(0.0, 0.0, 16.0)),
        turned(DVec3::new(8.0, 0.0, 0.0)),
    );
    Scene::new(gpu, &[Mesh::floor(0.0, 4.0), sheet])
}

/// Returns the profile of a sun whose penumbra has a half-width of `radius` texels of a map over 8
/// metres.
pub(super) fn sun_profile(
    gpu: &Gpu,
    height: f64,
    filter: Filter,
    map_size: u32,
    turn: f64,
) -> (Profile, f64) {
    let diameter = f64::from(filter.light_size());
    let descriptor = DirectionalShadowDescriptor {
        map_size,
        filter,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let scene = half_plane(gpu, height, turn);
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::NEG_Y),
        coverage: Coverage::Bounds(Aabb::new(
            Vec3::new(-4.0, -0.5, -4.0),
            Vec3::new(4.0, 0.5, 4.0),
        )),
        casters: &scene.list(),
        receivers: &[],
    };
    let report = record(gpu, &mut shadow, &frame);
    let texel = f64::from(report.views[0].texel_size_world.x);
    let probe = SunProbe::new(gpu, &shadow);
    let radius = height * (diameter * 0.5).tan();
    let profile = Profile::measure(radius, turn, |points| probe.ask(gpu, points));
    (profile, radius / texel)
}

#[test]
fn a_sun_spreads_as_its_diameter_says() {
    let gpu = gpu();
    let mut worst = [0.0; 2];
    for (height, diameter, map_size) in [
        (1.0, 0.2, 512),
        (3.0, 0.2, 512),
        (2.0, 0.1, 1024),
        (6.0, 0.0093, 2048),
        (1.0, 0.5, 700),
    ] {
        for turn in [0.0, 0.4, PI / 4.0] {
            let filter = Filter::Pcss {
                light_size: diameter,
            };
            let (profile, texels) = sun_profile(gpu, height, filter, map_size, turn);
            // The penumbra is wider than the tent that replaces narrow ones, and narrower than the
            // limit of 32 texels.
            assert!((4.0..30.0).contains(&texels), "{texels}");
            let name =
                format!("height {height} diameter {diameter} turn {turn:.1} ({texels:.1} texels)");
            worst = larger(worst, profile.assert_true(&name));
        }
    }
    table::record(
        "penumbrae of a half-plane under suns of 0.0093 to 0.5 radians",
        "widths within 10 % of the closed form, rmse at most 0.05",
        words(worst),
    );
}

#[test]
fn a_spot_spreads_as_its_radius_says() {
    let gpu = gpu();
    let mut worst = [0.0; 2];
    let above = 6.0;
    for (height, light_size) in [(1.5, 0.2), (3.0, 0.1), (2.0, 0.15)] {
        let descriptor = SpotShadowDescriptor {
            map_size: 512,
            filter: Filter::Pcss { light_size },
            ..Default::default()
        };
        let mut shadow = SpotShadow::new(&gpu.device, &descriptor).expect("a valid spot");
        let scene = half_plane(gpu, height, 0.3);
        let frame = SpotFrame {
            origin: DVec3::ZERO,
            light: SpotLight {
                position_world: DVec3::new(0.0, above, 0.0),
                direction: Vec3::NEG_Y,
                outer_angle_radians: 0.4,
                range: 20.0,
            },
            camera: None,
            casters: &scene.list(),
            receivers: &[],
        };
        record_spot(gpu, &mut shadow, &frame).expect("a valid frame");
        let ask = Ask::light(gpu, shadow.maps());
        let radius = f64::from(light_size) * height / (above - height);
        let profile = Profile::measure(radius, 0.3, |points| ask.points(gpu, points));
        let name = format!("spot, height {height} radius {light_size}");
        worst = larger(worst, profile.assert_true(&name));
    }
    table::record(
        "penumbrae of a half-plane under spots of radius 0.1 to 0.2",
        "widths within 10 % of the closed form, rmse at most 0.05",
        words(worst),
    );
}

/// The side of the shadow next to the foot of a wall is hard, within the two texels of the tent;
/// two metres further it is as wide as the light makes it.
#[test]
fn shadows_are_hard_where_the_caster_touches() {
    let gpu = gpu();
    let diameter = 0.2_f32;
    let descriptor = DirectionalShadowDescriptor {
        map_size: 1024,
        filter: Filter::Pcss {
            light_size: diameter,
        },
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    // The wall is a sheet: of a thick wall a map contains the front, and the blur follows the
    // front's distance.
    let wall = Mesh::sheet(Vec3::new(0.0, 0.0, -9.0), Vec3::Z * 9.0, Vec3::Y * 6.0);
    let scene = Scene::new(gpu, &[Mesh::floor(0.0, 4.0), wall]);
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::new(1.0, -1.0, 0.0)),
        coverage: Coverage::Bounds(Aabb::new(
            Vec3::new(-4.0, -0.1, -4.0),
            Vec3::new(4.0, 0.1, 4.0),
        )),
        casters: &scene.list(),
        receivers: &[],
    };
    let report = record(gpu, &mut shadow, &frame);
    let texel = report.views[0].texel_size_world.max_element();
    let probe = SunProbe::new(gpu, &shadow);
    // This counts, along z across the side of the shadow, at a distance from the wall, how much of
    // it is neither dark nor lit.
    let partial = |distance: f32, half: f32| {
        let points: Vec<_> = (0..400)
            .map(|step| half * (step as f32 / 199.5 - 1.0))
            .map(|z| Point::new(Vec3::new(distance, 0.0, z), Vec3::Y))
            .collect();
        let seen = probe.ask(gpu, &points);
        assert!(
            seen[0] < 0.02 && seen[399] > 0.98,
            "{distance}: {} {}",
            seen[0],
            seen[399]
        );
        let between = seen
            .iter()
            .filter(|seen| (0.1..=0.9).contains(*seen))
            .count();
        between as f32 * half / 200.0
    };
    // The edge at distance d is that of an occluder at d times the root of two along the ray.
    let radius = |distance: f32| distance * 2.0_f32.sqrt() * (diameter * 0.5).tan();
    let close = 0.5 * texel / radius(1.0);
    let hard = partial(close, 6.0 * texel);
    assert!(hard <= 2.0 * texel, "{hard} wide, a texel is {texel}");
    let soft = partial(1.5, 3.0 * radius(1.5));
    assert!(
        soft > 8.0 * hard && soft > 0.7 * radius(1.5),
        "{soft} against {hard}"
    );
    // Behind the wall, a texel from its foot, everything is dark.
    let foot: Vec<_> = (1..200)
        .map(|step| Point::new(Vec3::new(texel, 0.0, -0.01 * step as f32 - 0.1), Vec3::Y))
        .collect();
    let lightest = probe.ask(gpu, &foot).into_iter().fold(0.0, f32::max);
    assert!(lightest <= 1e-5, "{lightest} at the foot of the wall");
}
