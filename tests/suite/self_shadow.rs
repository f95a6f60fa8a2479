//! Tests that a flat surface does not shadow itself: at no angle to the light, under no filter, at
//! no resolution, in no depth range.
//!
//! No tolerance is needed: the bias is derived so that it allows for every rounding on the way, so
//! the number of receivers darker than 1 - 1/255 must be zero.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::readback;
use wgpu_shadows::{
    Aabb, Bias, CascadeLayout, DepthFormat, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, Filter, report::ShadowReport,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::scene::Scene;
use crate::fixtures::table;

const TILTS_DEGREES: [f64; 12] = [
    0.0, 0.01, 1.0, 15.0, 45.0, 60.0, 75.0, 85.0, 88.0, 89.0, 89.9, 89.99,
];
const AZIMUTHS_DEGREES: [f64; 3] = [0.0, 22.5, 135.0];
const RANGES: [f64; 3] = [1e1, 1e3, 1e5];
const POINTS: usize = 1024;
const FLOAT: DepthFormat = DepthFormat::Float32;

/// Returns all filters, with the default's sharpness and with a soft light, under the biases that
/// guarantee this.
fn samplings() -> Vec<(Filter, Bias)> {
    let more = [Filter::default(), Filter::Pcss { light_size: 0.02 }];
    Filter::PLANAR
        .iter()
        .copied()
        .chain(more)
        .flat_map(|filter| [(filter, Bias::Auto), (filter, Bias::NormalOffset)])
        .collect()
}

/// Holds a sheet, the light that grazes it, and the box that is covered.
struct Slope {
    name: String,
    tilt: f64,
    scene: Scene,
    light: Vec3,
    bounds: Aabb,
    points: Vec<Point>,
}

impl Slope {
    fn new(
        gpu: &Gpu,
        (tilt, name): (f64, String),
        sheet: Mesh,
        light: DVec3,
        bounds: Aabb,
    ) -> Self {
        let scene = Scene::new(gpu, &[sheet]);
        let mut random = Random::new(11);
        let points = (0..POINTS)
            .map(|index| {
                let triangle = scene.triangles[index % 2];
                let normal = triangle.normal();
                let lit_side = -normal.dot(light).signum();
                Point::rounded(
                    triangle.point(random.unit(), random.unit()),
                    normal * lit_side,
                )
            })
            .collect();
        Self {
            name,
            tilt,
            scene,
            light: light.as_vec3(),
            bounds,
            points,
        }
    }

    /// Returns an upright box under a vertical light. Its light-space box is tight, so the sheet
    /// fills the map, and the depth range is the one that is given: the covered box ends `range`
    /// below the sheet's highest point, or at its lowest where that is deeper.
    fn upright(gpu: &Gpu, tilt: f64, azimuth: f64, range: f64) -> Self {
        let slope = tilt.to_radians().tan();
        let along = DVec3::new(azimuth.to_radians().cos(), 0.0, azimuth.to_radians().sin()) * slope;
        let steepest = along.x.abs() + along.z.abs();
        let half = (0.5 * range / steepest.max(1e-9)).min(8.0) as f32;
        let height = |x: f32, z: f32| (along.x * f64::from(x) + along.z * f64::from(z)) as f32;
        let corner = Vec3::new(-half, height(-half, -half), -half);
        let sheet = Mesh::sheet(
            corner,
            Vec3::new(0.0, 2.0 * height(0.0, half), 2.0 * half),
            Vec3::new(2.0 * half, 2.0 * height(half, 0.0), 0.0),
        );
        let mut bounds = sheet.bounds();
        bounds.min.y = bounds.min.y.min(bounds.max.y - range as f32);
        let name = format!("tilt {tilt} azimuth {azimuth} range {range}");
        Self::new(gpu, (tilt, name), sheet, DVec3::NEG_Y, bounds)
    }

    /// Returns a sheet in any orientation under a light in any direction, about `distance` away
    /// from the render origin.
    fn oblique(gpu: &Gpu, tilt: f64, distance: f64, random: &mut Random) -> Self {
        let normal = random.direction();
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        let side = u.rotate_axis(normal, random.range(0.0, 6.2));
        let toward_light = normal * tilt.to_radians().cos() + side * tilt.to_radians().sin();
        let size = random.range(1.0, 20.0);
        let center = random.direction() * distance;
        let sheet = Mesh::sheet(
            (center - (u + v) * (0.5 * size)).as_vec3(),
            (u * size).as_vec3(),
            (v * size).as_vec3(),
        );
        // A margin on all sides makes the fit include a sheet that has nothing behind it.
        let mut bounds = sheet.bounds();
        bounds.min -= Vec3::ONE;
        bounds.max += Vec3::ONE;
        let name = format!(
            "tilt {tilt} at {center} normal {normal} light {}",
            -toward_light
        );
        Self::new(gpu, (tilt, name), sheet, -toward_light, bounds)
    }

    fn record(&self, gpu: &Gpu, shadow: &mut DirectionalShadow) -> ShadowReport {
        record(
            gpu,
            shadow,
            &DirectionalFrame {
                origin: DVec3::ZERO,
                light: DirectionalLight::new(self.light),
                coverage: Coverage::Bounds(self.bounds),
                casters: &self.scene.list(),
                receivers: &[],
            },
        )
    }

    /// Asserts that the map contains about as many texels of the sheet as the sheet should cover,
    /// except for those along its border.
    fn assert_drawn(&self, gpu: &Gpu, shadow: &DirectionalShadow, report: &ShadowReport) {
        let texel = report.views[0].texel_size_world.as_dvec2();
        let light = self.light.as_dvec3();
        let sides = self.scene.triangles[0].0;
        let (u, v) = (sides[1] - sides[0], sides[2] - sides[1]);
        let area = u.cross(v).dot(light.normalize()).abs() / (texel.x * texel.y);
        let across = |side: DVec3| side.reject_from(light).length() / texel.min_element();
        let border = 2.0 * (across(u) + across(v)) + 4.0;
        let depths = readback::depth_layer(gpu, shadow.maps().texture(), 0);
        let drawn = depths.iter().filter(|depth| **depth > 0.0).count() as f64;
        assert!(
            (drawn - area).abs() <= border,
            "{}: {drawn} texels drawn, {area} ± {border} expected",
            self.name
        );
    }
}

/// Holds a sun and its probe, which are made once for all the slopes.
struct Sun {
    shadow: DirectionalShadow,
    probe: SunProbe,
    name: String,
}

impl Sun {
    fn new(
        gpu: &Gpu,
        map_size: u32,
        filter: Filter,
        bias: Bias,
        depth_format: DepthFormat,
    ) -> Self {
        let descriptor = DirectionalShadowDescriptor {
            map_size,
            filter,
            bias,
            depth_format,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        };
        let shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
        Self {
            probe: SunProbe::new(gpu, &shadow),
            shadow,
            name: format!("{filter:?} {bias:?} map {map_size} {depth_format:?}"),
        }
    }

    /// Returns how many receivers are in shadow, and how dark the darkest is.
    fn false_shadows(&self, gpu: &Gpu, slope: &Slope) -> (usize, f32) {
        let visibilities = self.probe.ask(gpu, &slope.points);
        let darkest = visibilities.iter().copied().fold(1.0, f32::min);
        let lit = 1.0 - 1.0 / 255.0..=1.0;
        let dark = visibilities.iter().filter(|seen| !lit.contains(*seen));
        (dark.count(), darkest)
    }
}

fn upright_slopes(gpu: &Gpu) -> Vec<Slope> {
    let mut slopes = Vec::new();
    for tilt in TILTS_DEGREES {
        for azimuth in AZIMUTHS_DEGREES {
            for range in RANGES {
                slopes.push(Slope::upright(gpu, tilt, azimuth, range));
            }
        }
    }
    slopes
}

/// Returns how many receivers were sampled.
fn assert_no_false_shadow(format: DepthFormat, map_sizes: &[u32], slopes: &[Slope]) -> usize {
    let gpu = gpu();
    let mut failures = Vec::new();
    let mut asked = 0;
    for map_size in map_sizes {
        for (filter, bias) in samplings() {
            let mut sun = Sun::new(gpu, *map_size, filter, bias, format);
            for slope in slopes {
                let report = slope.record(gpu, &mut sun.shadow);
                let (dark, darkest) = sun.false_shadows(gpu, slope);
                asked += POINTS;
                if report.draws() != 1 {
                    failures.push(format!("{} {}: not drawn", sun.name, slope.name));
                } else if dark > 0 {
                    failures.push(format!(
                        "{} {}: {dark} of {POINTS} in shadow, down to {darkest}",
                        sun.name, slope.name
                    ));
                }
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{}: {} failures\n{}",
        gpu.describe(),
        failures.len(),
        failures.join("\n")
    );
    asked
}

const LIT: &str = "no receiver darker than lit less 1/255, under every filter and derived bias";

fn lit(asked: usize) -> String {
    format!("0 of {asked} receivers")
}

/// Maps are as small as a single texel, smaller than their filters' kernels: the scene is drawn
/// into them all the same.
#[test]
fn slopes_in_tiny_maps_are_lit() {
    let slopes: Vec<_> = upright_slopes(gpu()).into_iter().step_by(7).collect();
    let asked = assert_no_false_shadow(FLOAT, &[1, 2, 3, 8, 16, 64], &slopes);
    table::record(
        "planes at 0 to 89.99 degrees to the light in maps of 1 to 64 texels a side",
        LIT,
        lit(asked),
    );
}

#[test]
fn slopes_in_small_maps_are_lit() {
    assert_no_false_shadow(FLOAT, &[170], &upright_slopes(gpu()));
}

#[test]
fn slopes_in_middling_maps_are_lit() {
    assert_no_false_shadow(FLOAT, &[512], &upright_slopes(gpu()));
}

#[test]
fn slopes_in_large_maps_are_lit() {
    let asked = assert_no_false_shadow(FLOAT, &[2048], &upright_slopes(gpu()));
    table::record(
        "planes at 0 to 89.99 degrees to the light, depth ranges of 10 to 1e5, 32-bit maps",
        LIT,
        lit(asked),
    );
}

/// The step of 16 bits, 1.5 units at a range of 1e5, is part of the derived bias: no angle and no
/// range causes acne.
#[test]
fn slopes_in_16_bit_maps_are_lit() {
    let slopes = upright_slopes(gpu());
    let asked = assert_no_false_shadow(DepthFormat::Unorm16, &[170, 1024], &slopes);
    table::record(
        "planes at 0 to 89.99 degrees to the light, depth ranges of 10 to 1e5, 16-bit maps",
        LIT,
        lit(asked),
    );
}

#[test]
fn oblique_slopes_are_lit() {
    let gpu = gpu();
    let mut random = Random::new(3);
    let slopes: Vec<_> = TILTS_DEGREES
        .into_iter()
        .flat_map(|tilt| [tilt; 4])
        .map(|tilt| Slope::oblique(gpu, tilt, 30.0, &mut random))
        .collect();
    let asked = assert_no_false_shadow(FLOAT, &[256], &slopes)
        + assert_no_false_shadow(DepthFormat::Unorm16, &[256], &slopes);
    table::record(
        "planes in any orientation at 0 to 89.99 degrees to light from any side, both depth formats",
        LIT,
        lit(asked),
    );
}

/// Far from the render origin, where positions, the sheet's corners among them, are rounded to a
/// fraction of a texel and more, a sheet still does not shadow itself. (An f32 has steps of 1/128
/// at a hundred thousand units.)
#[test]
fn slopes_far_from_the_render_origin_are_lit() {
    let gpu = gpu();
    let mut random = Random::new(19);
    let mut slopes = Vec::new();
    for distance in [1e2, 1e3, 1e4, 1e5] {
        // Nearer to edge-on, the rounding of the corners alone turns a sheet's other side to the
        // light.
        for tilt in [0.0, 30.0, 60.0, 75.0, 85.0] {
            slopes.extend((0..3).map(|_| Slope::oblique(gpu, tilt, distance, &mut random)));
        }
    }
    let asked = assert_no_false_shadow(FLOAT, &[200, 1024], &slopes)
        + assert_no_false_shadow(DepthFormat::Unorm16, &[200], &slopes);
    table::record(
        "planes 1e2 to 1e5 from the render origin, up to 85 degrees to the light, both depth formats",
        LIT,
        lit(asked),
    );
}

/// The sheets are really in the maps of the tests above, with all of their area; and without a bias
/// they shadow themselves, so these tests would notice it.
#[test]
fn the_slopes_are_in_the_map_and_would_shadow_themselves() {
    let gpu = gpu();
    let mut random = Random::new(3);
    let oblique = TILTS_DEGREES.map(|tilt| Slope::oblique(gpu, tilt, 30.0, &mut random));
    let none = Bias::Manual {
        constant: 0.0,
        slope: 0.0,
    };
    let filter = Filter::Bilinear { sharpness: 1.0 };
    let mut sun = Sun::new(gpu, 384, filter, none, FLOAT);
    for slope in upright_slopes(gpu).iter().chain(&oblique) {
        let report = slope.record(gpu, &mut sun.shadow);
        assert_eq!((report.passes, report.draws()), (1, 1), "{}", slope.name);
        slope.assert_drawn(gpu, &sun.shadow, &report);
        let (dark, _) = sun.false_shadows(gpu, slope);
        // Half of a kernel lies behind a plane that leans, in depth as well where it leans enough;
        // a sheet that is nearly edge-on falls between the texels' centres.
        let (upright, level) = (slope.light == Vec3::NEG_Y, slope.tilt < 2.0);
        let least = match slope.tilt {
            _ if upright => POINTS / 2,
            tilt if tilt < 89.5 => POINTS / 4,
            _ => 1,
        };
        assert!(level || dark >= least, "{}: {dark} in shadow", slope.name);
    }
}
