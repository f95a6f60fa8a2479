//! Tests that positions that no map covers are lit, and that nothing that can cast is cut off from
//! the map.

use glam::{DVec2, DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::readback;
use shadow_support::triangle::occluded;
use wgpu_shadows::reference::receiver;
use wgpu_shadows::{
    Aabb, Bias, CameraView, CascadeLayout, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, Filter,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::{Gpu, GpuRequest, gpu, own_gpu};
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::scene::Scene;
use crate::fixtures::table;
use crate::fixtures::view_member::member;

const LIGHT: Vec3 = Vec3::new(0.3, -1.0, 0.2);
const MAP_SIZE: u32 = 128;

/// Holds a box of floor, in a camera's view, under a roof that extends far beyond the map on all
/// sides: every position that the map covers is dark.
struct Hall {
    shadow: DirectionalShadow,
    probe: SunProbe,
    bias: Bias,
    name: String,
}

impl Hall {
    fn new(gpu: &Gpu, filter: Filter, bias: Bias) -> Self {
        let descriptor = DirectionalShadowDescriptor {
            map_size: MAP_SIZE,
            filter,
            bias,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        };
        let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
        let roof = Mesh::cuboid(Vec3::new(-40.0, 2.0, -40.0), Vec3::new(40.0, 2.2, 40.0));
        let mut scene = Scene::new(gpu, &[roof]);
        scene.casters[0].set_roles(true, false);
        let camera = Camera::modern(DVec3::new(0.0, 20.0, 1.0), DVec3::ZERO, 0.9, 1.0);
        record(
            gpu,
            &mut shadow,
            &DirectionalFrame {
                origin: DVec3::ZERO,
                light: DirectionalLight::new(LIGHT),
                coverage: Coverage::Camera(camera.view()),
                casters: &scene.list(),
                receivers: &[Aabb::new(
                    Vec3::new(-4.0, -0.5, -4.0),
                    Vec3::new(4.0, 0.5, 4.0),
                )],
            },
        );
        Self {
            probe: SunProbe::new(gpu, &shadow),
            shadow,
            bias,
            name: format!("{filter:?} {bias:?}"),
        }
    }

    fn ask(&self, places: &[DVec3]) -> Vec<f32> {
        let points: Vec<_> = places
            .iter()
            .map(|place| Point::rounded(*place, DVec3::Y))
            .collect();
        self.probe.ask(gpu(), &points)
    }

    fn assert_all(&self, places: &[DVec3], wanted: f32, what: &str) {
        for (place, seen) in places.iter().zip(self.ask(places)) {
            // The tolerance covers a sum of at most 64 weights in f32.
            let error = (seen - wanted).abs();
            assert!(
                error <= 64.0 * f32::EPSILON,
                "{}: {seen} {what} at {place}",
                self.name
            );
        }
    }
}

fn halls(gpu: &Gpu) -> Vec<Hall> {
    let biases = [Bias::Auto, Bias::NormalOffset];
    Filter::PLANAR
        .iter()
        .copied()
        .flat_map(|filter| biases.map(|bias| Hall::new(gpu, filter, bias)))
        .collect()
}

#[test]
fn receivers_around_the_map_are_lit() {
    let mut random = Random::new(31);
    let toward_light = -LIGHT.as_dvec3().normalize();
    let inside: Vec<_> = (0..256)
        .map(|_| random.point(DVec3::new(-3.5, 0.0, -3.5), DVec3::new(3.5, 0.0, 3.5)))
        .collect();
    for hall in halls(gpu()) {
        let view = hall.shadow.maps().views().next().expect("a view");
        let range = f64::from(view.depth_range_world());
        let width = f64::from(view.texel_size_world().max_element()) * f64::from(MAP_SIZE);
        let moved = |by: &dyn Fn(&DVec3) -> DVec3| inside.iter().map(by).collect::<Vec<_>>();
        hall.assert_all(&inside, 0.0, "under the roof");
        let beside = moved(&|place| {
            let away = place.with_y(0.0).normalize();
            *place + away * (1.5 * width)
        });
        hall.assert_all(&beside, 1.0, "beside the map");
        let below = moved(&|place| *place - toward_light * range);
        hall.assert_all(&below, 1.0, "beyond the far plane");
        let above = moved(&|place| *place + toward_light * range);
        hall.assert_all(&above, 1.0, "before the near plane");
        // These positions are above the roof and still within the map's depth range: they are lit
        // by comparison, not by a limit.
        let on_top = moved(&|place| *place + toward_light * (2.4 / toward_light.y));
        hall.assert_all(&on_top, 1.0, "on the roof");
    }
    table::record(
        "receivers beside the map, beyond its far plane and before its near plane",
        "lit, under every filter and derived bias",
        "all lit",
    );
}

/// Toward the border the visibility changes once, from the roof's shadow to light, before the
/// kernel would leave the map. No texel from outside ever contributes, and no more of the map is
/// left unused than kernel and bias can need.
#[test]
fn the_border_is_where_the_kernel_ends() {
    const STEPS: usize = 4000;
    for (hall, filter) in halls(gpu())
        .iter()
        .zip(doubled(Filter::PLANAR.iter().copied()))
    {
        let view = hall.shadow.maps().views().next().expect("a view");
        let uniform = hall.shadow.maps().view_uniforms()[0];
        let from_side = |texel: DVec2| {
            let opposite = DVec2::splat(f64::from(MAP_SIZE)) - texel;
            texel.min(opposite).min_element()
        };
        // The bias moves a receiver across the map before it is sampled; the CPU reference computes
        // where to.
        let looked_up = |place: DVec3| {
            let place = place.as_vec3().as_dvec3();
            from_side(receiver(&uniform, filter, hall.bias, place, DVec3::Y).texel)
        };
        let clip = view.clip_from_render().as_dmat4();
        let stands = |place: DVec3| {
            let ndc = (clip * place.extend(1.0)).truncate().truncate();
            from_side((ndc + 1.0) * (0.5 * f64::from(MAP_SIZE)))
        };
        let center = Vec3::from_array(member(&uniform, "anchor"))
            .as_dvec3()
            .with_y(0.0);
        for direction in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::new(1.0, 0.0, -1.0)] {
            // This distance is certain to leave the map.
            let way = f64::from(view.texel_size_world().max_element()) * f64::from(MAP_SIZE) * 1.25;
            let places: Vec<_> = (0..STEPS)
                .map(|step| center + direction * (way * step as f64 / STEPS as f64))
                .collect();
            let seen = hall.ask(&places);
            let first_lit = seen.iter().position(|v| *v != 0.0).expect("an end");
            assert!(first_lit > STEPS / 10, "{}: {first_lit}", hall.name);
            assert!(seen[first_lit..].iter().all(|v| *v == 1.0), "{}", hall.name);
            let reach = filter.reach_texels();
            let last = looked_up(places[first_lit - 1]);
            // 1e-4 texels are more than the error of f32 in a map of this size
            // (`fixtures/rounding.rs`).
            assert!(last >= reach - 1e-4, "{}: {last} < {reach}", hall.name);
            // |nx| + |ny| of the normal is at most the square root of two.
            let sideways =
                f64::from(member::<f32>(&uniform, "offset_texels")) * std::f64::consts::SQRT_2;
            let next = stands(places[first_lit]);
            assert!(
                next <= reach + sideways + 0.05,
                "{}: {next} > {reach}",
                hall.name
            );
        }
    }
    table::record(
        "kernels at the border of a map",
        "one step from the map's shadow to light, where the kernel would leave the map",
        "as expected, under every filter and derived bias",
    );
}

fn doubled<T: Copy>(items: impl IntoIterator<Item = T>) -> impl Iterator<Item = T> {
    items.into_iter().flat_map(|item| [item, item])
}

/// Whatever an engine passes, the result is a visibility.
#[test]
fn receivers_that_are_not_numbers_get_an_answer() {
    let odd = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        0.0,
        1e-38,
    ];
    let mut points = Vec::new();
    for value in odd {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE] {
            points.push(Point::new(Vec3::new(0.5, 0.0, 0.5), axis * value));
            points.push(Point::new(axis * value, Vec3::Y));
        }
    }
    for hall in halls(gpu()) {
        for (point, seen) in points.iter().zip(hall.probe.ask(gpu(), &points)) {
            assert!(
                (0.0..=1.0).contains(&seen),
                "{}: {seen} at {point:?}",
                hall.name
            );
        }
    }
    table::record(
        "receivers and normals of NaN, infinity, the largest and the least numbers",
        "answers in 0..=1, under every filter and derived bias",
        "as expected",
    );
}

/// Holds a floor, and a slab three kilometres away toward the light, with nothing between it and
/// the camera's volume.
struct FarSlab {
    scene: Scene,
    light: DVec3,
    coverage: Coverage,
}

impl FarSlab {
    fn new(gpu: &Gpu) -> Self {
        let light = DVec3::new(0.4, -1.0, 0.25);
        let above = (light * -3000.0).as_vec3();
        let slab = Mesh::cuboid(
            above - Vec3::new(5.0, 1.0, 4.0),
            above + Vec3::new(5.0, 1.0, 4.0),
        );
        let camera = Camera::modern(DVec3::new(0.0, 12.0, 24.0), DVec3::ZERO, 1.0, 1.5);
        Self {
            scene: Scene::new(gpu, &[Mesh::floor(0.0, 20.0), slab]),
            light,
            coverage: Coverage::Camera(camera.view()),
        }
    }

    fn record(&self, gpu: &Gpu) -> DirectionalShadow {
        let descriptor = DirectionalShadowDescriptor {
            map_size: 512,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        };
        let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
        let report = record(
            gpu,
            &mut shadow,
            &DirectionalFrame {
                origin: DVec3::ZERO,
                light: DirectionalLight::new(self.light.as_vec3()),
                coverage: self.coverage,
                casters: &self.scene.list(),
                receivers: &[],
            },
        );
        assert!(report.views[0].depth_range_world > 3000.0);
        shadow
    }
}

#[test]
fn a_caster_three_kilometres_up_casts() {
    let gpu = gpu();
    let slab = FarSlab::new(gpu);
    let shadow = slab.record(gpu);
    let texel = f64::from(
        shadow.maps().report().views[0]
            .texel_size_world
            .max_element(),
    );
    let mut random = Random::new(37);
    let (mut dark, mut lit) = (0, 0);
    let mut places = Vec::new();
    for _ in 0..2000 {
        let place = random.point(DVec3::new(-12.0, 0.0, -12.0), DVec3::new(12.0, 0.0, 12.0));
        // Three texels are more than the default's two; the slanting light stretches them on the
        // ground by less than two.
        let around = [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z].map(|d| d * 6.0 * texel);
        let blocked = |at: DVec3| occluded(&slab.scene.triangles, at, -slab.light, 1e-6);
        let here = blocked(place);
        if around.iter().all(|step| blocked(place + *step) == here) {
            places.push((place, here));
            dark += usize::from(here);
            lit += usize::from(!here);
        }
    }
    assert!(dark > 100 && lit > 100, "{dark} dark, {lit} lit");
    let points: Vec<_> = places
        .iter()
        .map(|(place, _)| Point::rounded(*place, DVec3::Y))
        .collect();
    let seen = SunProbe::new(gpu, &shadow).ask(gpu, &points);
    for ((place, blocked), seen) in places.iter().zip(seen) {
        let wanted = if *blocked { 0.0 } else { 1.0 };
        assert!((seen - wanted).abs() < 1e-5, "{seen} at {place}");
    }
    table::record(
        "a caster 3000 above a camera's volume",
        "settled receivers as the truth says",
        format!("0 wrong of {} settled receivers", places.len()),
    );
}

/// The optional feature changes nothing: the map is the same, bit for bit, on a device with it and
/// on one without it.
#[test]
fn depth_clip_control_changes_nothing() {
    let with_feature = own_gpu(GpuRequest {
        features: wgpu::Features::DEPTH_CLIP_CONTROL,
        ..Default::default()
    });
    let maps = [gpu(), &with_feature].map(|gpu| {
        let slab = FarSlab::new(gpu);
        let shadow = slab.record(gpu);
        readback::depth_layer(gpu, shadow.maps().texture(), 0)
    });
    let drawn = maps[0].iter().filter(|depth| **depth > 0.0).count();
    assert!(drawn > 1000, "{drawn} texels drawn");
    let differ = maps[0]
        .iter()
        .zip(&maps[1])
        .filter(|(a, b)| a.to_bits() != b.to_bits())
        .count();
    assert_eq!(differ, 0, "texels differ");
}

#[test]
fn an_identity_camera_sees_the_clip_volume() {
    // A camera whose matrices are both the identity sees the box -1..1, -1..1, 0..1: the simplest
    // projection.
    let gpu = gpu();
    let scene = Scene::new(
        gpu,
        &[
            Mesh::floor(0.0, 3.0),
            Mesh::cuboid(Vec3::new(-0.3, 0.4, 0.3), Vec3::new(0.3, 0.6, 0.6)),
        ],
    );
    let mut shadow = DirectionalShadow::new(&gpu.device, &Default::default()).expect("a valid sun");
    let camera = CameraView::new(Mat4::IDENTITY, Mat4::IDENTITY);
    record(
        gpu,
        &mut shadow,
        &DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(Vec3::NEG_Y),
            coverage: Coverage::Camera(camera),
            casters: &scene.list(),
            receivers: &[],
        },
    );
    let points = [
        Point::new(Vec3::new(0.0, 0.0, 0.45), Vec3::Y),
        Point::new(Vec3::new(0.0, 0.0, 0.1), Vec3::Y),
    ];
    assert_eq!(SunProbe::new(gpu, &shadow).ask(gpu, &points), [0.0, 1.0]);
}
