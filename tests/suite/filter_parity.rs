//! Tests every filter under every bias on the device against the CPU reference,
//! `wgpu_shadows::reference`.
//!
//! A comparison is undecided where reference depth and texel are closer than f32 resolves. So the
//! CPU reference is evaluated not once but nine times, at the receiver and at the corners of its
//! rounding band (`fixtures/rounding.rs`), and the device's result must lie between the least and
//! the greatest of these, up to the rounding of the weighted sum. Receivers for which they differ
//! are *undecided*: the test proves little about them, and limits their share.

use bytemuck::Zeroable;
use glam::{DVec2, DVec3, Vec2, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::readback;
use wgpu_shadows::reference::{self, DepthLayer, Receiver};
use wgpu_shadows::{
    Aabb, Bias, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    Filter, ShadowViewUniform,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::rounding::{Band, U, band};
use crate::fixtures::scene::Scene;
use crate::fixtures::view_member::{member, texel_and_depth};

pub(super) const BIASES: [Bias; 3] = [
    Bias::Auto,
    Bias::NormalOffset,
    Bias::Manual {
        constant: 0.02,
        slope: 0.15,
    },
];

const POINTS: usize = 4000;

/// Returns every filter, each sharpened kind once more with another sharpness, and a soft light.
pub(super) fn filters() -> impl Iterator<Item = Filter> {
    Filter::PLANAR.iter().copied().chain([
        Filter::Bilinear { sharpness: 4.0 },
        Filter::Tent3 { sharpness: 3.0 },
        Filter::Tent5 { sharpness: 2.0 },
        Filter::Tent7 { sharpness: 1.5 },
        Filter::Pcss { light_size: 0.1 },
        Filter::PcssRotated { light_size: 0.1 },
    ])
}

/// Returns a floor, solids, a sheet that leans by 80 degrees and one that hangs obliquely.
pub(super) fn scene() -> Scene {
    Scene::new(
        gpu(),
        &[
            Mesh::floor(0.0, 6.0),
            Mesh::cuboid(Vec3::new(-3.0, 0.0, -3.5), Vec3::new(-1.2, 2.5, -1.0)),
            Mesh::sphere(Vec3::new(1.5, 1.6, -1.5), 1.1, 12),
            Mesh::sheet(
                Vec3::new(-2.0, 0.1, 2.0),
                Vec3::new(3.0, 0.0, 0.4),
                Vec3::new(0.1, 3.0, 0.53),
            ),
            Mesh::sheet(
                Vec3::new(1.0, 2.0, 1.0),
                Vec3::new(0.3, 0.4, 2.5),
                Vec3::new(2.4, 0.9, -0.2),
            ),
        ],
    )
}

/// Holds a sun over the scene and its map, read back.
pub(super) struct Lit {
    pub shadow: DirectionalShadow,
    pub view: ShadowViewUniform,
    depths: Vec<f32>,
}

impl Lit {
    pub fn new(gpu: &Gpu, scene: &Scene, map_size: u32, filter: Filter, bias: Bias) -> Self {
        let descriptor = DirectionalShadowDescriptor {
            map_size,
            filter,
            bias,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        };
        let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
        let report = record(
            gpu,
            &mut shadow,
            &DirectionalFrame {
                origin: DVec3::ZERO,
                light: DirectionalLight::new(LIGHT),
                coverage: Coverage::Bounds(BOX),
                casters: &scene.list(),
                receivers: &[],
            },
        );
        assert_eq!(report.passes, 1);
        let depths = readback::depth_layer(gpu, shadow.maps().texture(), 0);
        let drawn = depths.iter().filter(|depth| **depth > 0.0).count();
        assert!(drawn > depths.len() / 10, "{drawn} texels drawn");
        Self {
            view: shadow.maps().view_uniforms()[0],
            shadow,
            depths,
        }
    }

    fn layer(&self) -> DepthLayer<'_> {
        DepthLayer {
            size: self.shadow.maps().texture().width(),
            depths: &self.depths,
        }
    }
}

const LIGHT: Vec3 = Vec3::new(0.45, -1.0, 0.3);
const BOX: Aabb = Aabb::new(Vec3::new(-5.0, -1.0, -5.0), Vec3::new(5.0, 4.0, 5.0));

/// Returns random receivers: a quarter anywhere, also far beyond the box, with any normal; a
/// quarter on the floor along the borders of shadows; the rest on surfaces, mostly with the normal
/// of the side that the light sees.
pub(super) fn points(scene: &Scene, seed: u64) -> Vec<Point> {
    let mut random = Random::new(seed);
    let light = LIGHT.as_dvec3();
    let reach = DVec3::new(14.0, 7.0, 14.0);
    (0..POINTS)
        .map(|index| {
            if index % 4 == 0 {
                return Point::rounded(random.point(-reach, reach), random.direction());
            }
            let triangle = scene.triangles[random.index(scene.triangles.len())];
            if index % 4 == 1 {
                let [start, end, _] = triangle.0;
                let edge = start.lerp(end, random.unit());
                let jitter = DVec3::new(random.range(-0.1, 0.1), 0.0, random.range(-0.1, 0.1));
                return Point::rounded(edge - light * (edge.y / light.y) + jitter, DVec3::Y);
            }
            let place = triangle.point(random.unit(), random.unit());
            let normal = triangle.normal();
            let flip = (normal.dot(light) > 0.0) != (index % 20 == 2);
            Point::rounded(place, if flip { -normal } else { normal })
        })
        .collect()
}

pub(super) fn place(point: &Point) -> (DVec3, DVec3) {
    let wide = |v| Vec3::from_array(v).as_dvec3();
    (wide(point.position), wide(point.normal))
}

/// Returns whether a position is so close to a border of what the map covers that rounding decides
/// on which side it is.
pub(super) fn at_border(view: &ShadowViewUniform, position: DVec3, band: &Band) -> bool {
    let (texel, depth) = texel_and_depth(view, position);
    let pair = |name| Vec2::from_array(member(view, name)).as_dvec2();
    let from_border = (texel - pair("mapping.middle")).abs() - pair("mapping.inner");
    from_border.abs().cmple(band.texel).any() || depth.abs() <= band.depth
}

/// Returns the least and the greatest visibility over the rounding band.
fn bounds(filter: Filter, map: &DepthLayer<'_>, receiver: &Receiver, band: &Band) -> (f64, f64) {
    let depth = band.reference_depth(filter, receiver);
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    let corners = (0..8).map(|bits| {
        let sign = |bit: u32| if bits >> bit & 1 == 1 { 1.0 } else { -1.0 };
        (DVec2::new(sign(0), sign(1)), sign(2))
    });
    for (side, toward) in corners.chain([(DVec2::ZERO, 0.0)]) {
        let moved = Receiver {
            texel: receiver.texel + side * band.texel,
            depth: receiver.depth + toward * depth,
            ..*receiver
        };
        let visibility = reference::visibility(filter, map, &moved);
        range = (range.0.min(visibility), range.1.max(visibility));
    }
    range
}

/// Returns the rounding error of the sum of comparisons: at most 64 products and sums, stretched by
/// the sharpness. For the sampler's own comparison it is the step of its weights, whose number of
/// bits depends on the adapter (8 on every desktop GPU and on llvmpipe, 4 at least by the
/// specifications), once along each axis.
fn sum_error(gpu: &Gpu, filter: Filter) -> f64 {
    let rounding = f64::from(filter.sharpness()) * 80.0 * U;
    match filter {
        Filter::Hardware if gpu.adapter.name.contains("llvmpipe") => rounding + 2.0 / 256.0,
        Filter::Hardware => rounding + 2.0 / 16.0,
        _ => rounding,
    }
}

/// Counts the results of one filter under one bias.
#[derive(Debug, Default)]
struct Tally {
    compared: usize,
    undecided: usize,
    dark: usize,
    partial: usize,
    wrong: Vec<String>,
}

fn compare(gpu: &Gpu, scene: &Scene, map_size: u32, filter: Filter, bias: Bias) -> Tally {
    let lit = Lit::new(gpu, scene, map_size, filter, bias);
    let points = points(scene, u64::from(map_size));
    let answers = SunProbe::new(gpu, &lit.shadow).ask(gpu, &points);
    let tolerance = sum_error(gpu, filter);
    let mut tally = Tally::default();
    for (point, answer) in points.iter().zip(answers) {
        let (position, normal) = place(point);
        let receiver = reference::receiver(&lit.view, filter, bias, position, normal);
        let answer = f64::from(answer);
        if !(0.0..=1.0).contains(&answer) {
            tally
                .wrong
                .push(format!("{point:?}: {answer} is no visibility"));
            continue;
        }
        let Some(band) = band(&lit.view, filter, bias, position, normal, &receiver) else {
            tally.undecided += 1;
            continue;
        };
        if at_border(&lit.view, position, &band) {
            tally.undecided += 1;
            continue;
        }
        let (low, high) = bounds(filter, &lit.layer(), &receiver, &band);
        tally.compared += 1;
        tally.undecided += usize::from(high - low > tolerance + 1e-3);
        tally.dark += usize::from(high < 0.5);
        tally.partial += usize::from(low > 0.01 && high < 0.99);
        if answer < low - tolerance || answer > high + tolerance {
            tally.wrong.push(format!(
                "{point:?} at texel {} depth {}: {answer} outside {low}..{high} ± {tolerance}",
                receiver.texel, receiver.depth
            ));
        }
    }
    tally
}

impl Tally {
    /// Returns what would make the comparison worthless: too few results of a kind, or too many
    /// that prove nothing.
    fn weakness(&self, filter: Filter) -> Option<String> {
        let weak = self.undecided > POINTS / 200
            || self.compared < POINTS * 9 / 10
            || self.dark < POINTS / 5
            || (self.partial < 10 && filter != Filter::Nearest);
        weak.then(|| format!("{self:?}"))
    }
}

#[test]
fn visibilities_are_those_of_the_reference() {
    let gpu = gpu();
    let scene = scene();
    let mut failures = Vec::new();
    for filter in filters() {
        for bias in BIASES {
            // The size is not a power of two, so that coordinates are rounded on their way to the
            // sampler, and it is much larger than the kernel.
            let map_size = (93.0 + 9.0 * filter.reach_texels()) as u32;
            let tally = compare(gpu, &scene, map_size, filter, bias);
            if let Some(first) = tally.wrong.first() {
                let count = tally.wrong.len();
                failures.push(format!("{filter:?} {bias:?}: {count} wrong, first {first}"));
            } else if let Some(weakness) = tally.weakness(filter) {
                failures.push(format!("{filter:?} {bias:?}: {weakness}"));
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{}\n{}",
        gpu.describe(),
        failures.join("\n")
    );
}

/// A straight edge is sampled with each kernel: visibility rises from 0 to 1 over exactly twice the
/// reach that the filter states (less where sharpened), never decreases in between, and is
/// symmetric around the edge.
#[test]
fn kernels_are_even_and_reach_as_far_as_they_say() {
    const SIZE: u32 = 24;
    const EDGE: f64 = 12.0;
    let depths: Vec<f32> = (0..SIZE * SIZE)
        .map(|texel| {
            if f64::from(texel % SIZE) < EDGE {
                1.0
            } else {
                0.0
            }
        })
        .collect();
    let map = DepthLayer {
        size: SIZE,
        depths: &depths,
    };
    let nowhere = reference::receiver(
        &ShadowViewUniform::zeroed(),
        Filter::Nearest,
        Bias::Auto,
        DVec3::ZERO,
        DVec3::Y,
    );
    let seen = |filter, x| {
        let receiver = Receiver {
            texel: DVec2::new(x, 11.3),
            depth: 0.5,
            gradient: DVec2::ZERO,
            inside: true,
            ..nowhere
        };
        reference::visibility(filter, &map, &receiver)
    };
    let with_kernels = |filter: &Filter| filter.light_size() == 0.0;
    for filter in filters().filter(with_kernels) {
        let reach = filter.reach_texels();
        // A texel has weight while its centre is nearer than the reach, and texels have their
        // centres half a texel from the edge.
        let ramp = reach - 0.5;
        let mut last = 0.0;
        for step in -600..=600 {
            // These positions avoid the centres and borders of texels, where the result changes
            // from one value to the next.
            let x = f64::from(step) / 100.0 + 0.003;
            let (here, there) = (seen(filter, EDGE + x), seen(filter, EDGE - x));
            assert!((here + there - 1.0).abs() < 1e-12, "{filter:?} at {x}");
            assert!(here >= last - 1e-12, "{filter:?} at {x}: {here} < {last}");
            assert!(x < ramp || here > 1.0 - 1e-12, "{filter:?} at {x}: {here}");
            let plain = filter.sharpness() == 1.0 && x.abs() < ramp - 0.01;
            assert!(
                !plain || (1e-9..1.0 - 1e-9).contains(&here),
                "{filter:?} at {x}: {here}"
            );
            last = here;
        }
    }
}
