//! Tests contact shadows: objects that lie on a surface cast onto it as soon as they are thicker
//! than the gap that the report gives.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, Bias, CascadeLayout, DepthFormat, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, Filter, ShadowCaster,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::scene::Scene;
use crate::fixtures::table;

const BIASES: [Bias; 4] = [
    Bias::Auto,
    Bias::NormalOffset,
    Bias::Manual {
        constant: 0.02,
        slope: 0.3,
    },
    Bias::Manual {
        constant: 0.01,
        slope: 0.02,
    },
];

/// Describes how depths are stored, over what range, and how large map and sheets are.
#[derive(Clone, Copy, Debug)]
struct Setting {
    depth_format: DepthFormat,
    /// Is the least depth range of the map.
    range: f32,
    map_size: u32,
    /// Is half the width of the lower sheet's footprint, seen along the vertical light.
    half: f64,
}

const PLAIN: Setting = Setting {
    depth_format: DepthFormat::Float32,
    range: 0.0,
    map_size: 512,
    half: 4.0,
};

/// Lists both formats over short and long ranges. In the longest range the step of 16 bits is 1.5,
/// and texels are no finer than 1/20; there the sheets are larger.
const SETTINGS: [Setting; 4] = [
    PLAIN,
    Setting {
        range: 1e5,
        map_size: 1024,
        half: 40.0,
        ..PLAIN
    },
    Setting {
        depth_format: DepthFormat::Unorm16,
        ..PLAIN
    },
    Setting {
        depth_format: DepthFormat::Unorm16,
        range: 1e5,
        map_size: 1024,
        half: 40.0,
    },
];

/// Holds a sheet under a vertical light, and a plate parallel to it, `thickness` above it along the
/// normal.
struct Plate {
    name: String,
    scene: Scene,
    points: Vec<Point>,
}

impl Plate {
    fn new(gpu: &Gpu, half: f64, (tilt, azimuth): (f64, f64), thickness: f64) -> Self {
        let along = DVec3::new(azimuth.to_radians().cos(), 0.0, azimuth.to_radians().sin());
        let along = along * tilt.to_radians().tan();
        let on_sheet = |x: f64, z: f64| DVec3::new(x, along.x * x + along.z * z, z);
        let normal = (DVec3::Y - along).normalize();
        let sheet = |half: f64, lift: DVec3| {
            let corner = on_sheet(-half, -half);
            Mesh::sheet(
                (corner + lift).as_vec3(),
                (on_sheet(-half, half) - corner).as_vec3(),
                (on_sheet(half, -half) - corner).as_vec3(),
            )
        };
        // The offset moves the plate sideways, by less than its margin around the points.
        assert!(thickness < half / 8.0, "plates are thin: {thickness}");
        let meshes = [
            sheet(half, DVec3::ZERO),
            sheet(half / 2.0, normal * thickness),
        ];
        let mut random = Random::new(23);
        let points = (0..512)
            .map(|_| {
                let (x, z) = (random.range(-1.0, 1.0), random.range(-1.0, 1.0));
                Point::rounded(on_sheet(x * half / 4.0, z * half / 4.0), normal)
            })
            .collect();
        Self {
            name: format!("tilt {tilt} azimuth {azimuth} thickness {thickness}"),
            scene: Scene::new(gpu, &meshes),
            points,
        }
    }

    /// Draws the plate on its sheet, and returns the gap that the report gives and the visibilities
    /// of the receivers under the plate.
    ///
    /// What is covered reaches at least `range` down from the highest point, so the map's depth
    /// range is no less.
    fn look(
        &self,
        gpu: &Gpu,
        shadow: &mut DirectionalShadow,
        probe: &SunProbe,
        range: f32,
    ) -> (f64, Vec<f32>) {
        let casters = self.scene.list();
        let bounds = |all: Aabb, caster: &&dyn ShadowCaster| all.union(caster.bounds());
        let mut covered = casters.iter().fold(Aabb::EMPTY, bounds);
        covered.min.y = covered.min.y.min(covered.max.y - range);
        let frame = DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(Vec3::NEG_Y),
            coverage: Coverage::Bounds(covered),
            casters: &casters,
            receivers: &[],
        };
        let report = record(gpu, shadow, &frame);
        let gap = f64::from(report.views[0].max_peter_panning_world);
        (gap, probe.ask(gpu, &self.points))
    }
}

/// Returns the largest visibility of the receivers under a plate of `share` times the reported gap,
/// at each of the angles.
fn brightest(
    (filter, bias): (Filter, Bias),
    setting: Setting,
    share: f64,
    angles: &[(f64, f64)],
) -> Vec<(String, f32)> {
    let gpu = gpu();
    let descriptor = DirectionalShadowDescriptor {
        map_size: setting.map_size,
        filter,
        bias,
        depth_format: setting.depth_format,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let probe = SunProbe::new(gpu, &shadow);
    let look = |&angle: &(f64, f64)| {
        // The light-space bounds, and with them the gap, are those of the sheet, so a first frame
        // with any plate gives them.
        let first = Plate::new(gpu, setting.half, angle, 1e-3);
        let (gap, _) = first.look(gpu, &mut shadow, &probe, setting.range);
        let plate = Plate::new(gpu, setting.half, angle, gap * share);
        let (_, seen) = plate.look(gpu, &mut shadow, &probe, setting.range);
        let name = format!("{filter:?} {bias:?} {setting:?} {}, gap {gap}", plate.name);
        (name, seen.into_iter().fold(0.0, f32::max))
    };
    angles.iter().map(look).collect()
}

/// "Above this height a caster on a surface always casts": no receiver under the plate is lit, at
/// any angle, in any depth range of either format.
#[test]
fn a_plate_thicker_than_the_reported_gap_always_casts() {
    let mut angles = Vec::new();
    for tilt in [0.0, 30.0, 60.0, 80.0, 85.0, 89.0] {
        for azimuth in [0.0, 20.0, 45.0] {
            angles.push((tilt, azimuth));
        }
    }
    // Long ranges need large maps, so only a few of the angles are drawn for them.
    let few = [(0.0, 20.0), (30.0, 0.0), (60.0, 45.0), (89.0, 45.0)];
    let mut failures = Vec::new();
    let mut looks = 0;
    for filter in Filter::PLANAR.iter().copied().chain([Filter::default()]) {
        for bias in BIASES {
            for setting in SETTINGS {
                let angles = if setting.range > 0.0 {
                    &few[..]
                } else {
                    &angles
                };
                for (name, brightest) in brightest((filter, bias), setting, 1.1, angles) {
                    looks += 1;
                    if brightest > 1.0 / 255.0 {
                        failures.push(format!("{name}: visibility {brightest}"));
                    }
                }
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{} failures\n{}",
        failures.len(),
        failures.join("\n")
    );
    table::record(
        "plates 1.1 times as thick as the reported gap, depth ranges up to 1e5, both depth formats",
        "no light below them, at any angle, under every filter and bias",
        format!("0 of {looks} plates let light through"),
    );
}

/// The gap is given for the worst angle, grazing and along the diagonal of the texels. There light
/// comes through under a plate of half the height, so the report does not exaggerate. (That is not
/// so for sharpened filters, whose outermost texels have no weight.)
#[test]
fn a_plate_of_half_the_reported_gap_lets_light_through_at_the_worst_angle() {
    let mut failures = Vec::new();
    for filter in Filter::PLANAR.iter().copied() {
        for bias in [Bias::Auto, Bias::NormalOffset] {
            for (name, brightest) in brightest((filter, bias), PLAIN, 0.5, &[(87.0, 45.0)]) {
                if brightest <= 1.0 / 255.0 {
                    failures.push(name);
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    table::record(
        "plates half as thick as the reported gap",
        "light below them at the worst angle: the report does not exaggerate twofold",
        "so under every filter and derived bias",
    );
}
