//! Tests one frame for all lights: several cameras that share the maps, and what the coverage
//! means.

use glam::{DMat4, DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::triangle::{Triangle, occluded};
use wgpu_shadows::{
    Aabb, CameraView, CascadeLayout, Casters, Coverage, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, MeshCaster, OmniLight, OmniShadow, OmniShadowDescriptor,
    ShadowCaster, ShadowFrameDescriptor, ShadowScene, ShadowView, SpotLight, SpotShadow,
    SpotShadowDescriptor, Stability, report::ShadowReport, report::ViewStatus,
};

use crate::fixtures::ask::Ask;
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::local_truth::Settled;
use crate::fixtures::scene::default_pipeline;

const SUN: DVec3 = DVec3::new(0.35, -1.0, 0.2);
const MAP_SIZE: u32 = 2048;

/// Holds two yards a hundred units apart, each with boxes on a floor and a camera of its own.
struct Yards {
    casters: Vec<MeshCaster>,
    triangles: Vec<Triangle>,
    floors: [Aabb; 2],
    middles: [DVec3; 2],
}

impl Yards {
    fn new(gpu: &Gpu) -> Self {
        let middles = [DVec3::ZERO, DVec3::new(100.0, 0.0, 40.0)];
        let mut random = Random::new(5);
        let meshes: Vec<_> = middles
            .iter()
            .flat_map(|middle| {
                let mut one = || {
                    let low = random.point(DVec3::new(-3.5, 0.0, -3.5), DVec3::new(1.0, 0.5, 1.0));
                    let size = random.point(DVec3::splat(1.6), DVec3::new(2.6, 2.5, 2.6));
                    let low = (*middle + low).as_vec3();
                    Mesh::cuboid(low, low + size.as_vec3())
                };
                [one(), one(), one(), one()]
            })
            .collect();
        let pipeline = default_pipeline(gpu);
        let casters = meshes
            .iter()
            .map(|mesh| mesh.caster(gpu, &pipeline, Mat4::IDENTITY));
        let floor = |middle: DVec3| {
            let half = Vec3::new(5.0, 0.0, 5.0);
            Aabb::new(middle.as_vec3() - half, middle.as_vec3() + half)
        };
        Self {
            casters: casters.collect(),
            triangles: meshes
                .iter()
                .flat_map(|mesh| mesh.triangles(&Mat4::IDENTITY))
                .collect(),
            floors: middles.map(floor),
            middles,
        }
    }

    fn list(&self) -> Vec<&dyn ShadowCaster> {
        self.casters.iter().map(|caster| caster as _).collect()
    }

    /// Returns the camera of one yard.
    fn camera(&self, yard: usize) -> Camera {
        let middle = self.middles[yard];
        Camera::modern(middle + DVec3::new(1.0, 7.0, 9.0), middle, 0.9, 1.5)
    }

    /// Returns positions of a yard's floor that its camera sees and whose truth toward the light is
    /// the same for `around` world units.
    fn settled(&self, yard: usize, toward_light: impl Fn(DVec3) -> DVec3, around: f64) -> Settled {
        let mut random = Random::new(9 + yard as u64);
        let mut settled = Settled::default();
        let clip_from_render = self.camera(yard).view();
        let clip_from_render = clip_from_render.clip_from_view * clip_from_render.view_from_render;
        for _ in 0..3000 {
            let place = random.point(DVec3::new(-4.5, 0.0, -4.5), DVec3::new(4.5, 0.0, 4.5));
            let place = (self.middles[yard] + place).as_vec3().as_dvec3();
            let clip = clip_from_render * place.as_vec3().extend(1.0);
            if clip.x.abs() > clip.w || clip.y.abs() > clip.w {
                continue;
            }
            let is_dark = |place: DVec3| occluded(&self.triangles, place, toward_light(place), 0.0);
            let dark = is_dark(place);
            let ring = (0..16).map(|step| {
                let angle = f64::from(step) / 16.0 * std::f64::consts::TAU;
                place + DVec3::new(angle.cos(), 0.0, angle.sin()) * around
            });
            if ring.into_iter().all(|near| is_dark(near) == dark) {
                settled.points.push(Point::rounded(place, DVec3::Y));
                settled.dark.push(dark);
            } else {
                settled.at_edges += 1;
            }
        }
        let [dark, lit] = settled.counts();
        assert!(dark > 30 && lit > 300, "{dark} dark, {lit} lit");
        settled
    }
}

fn sun(gpu: &Gpu, stability: Stability, cascades: u32) -> DirectionalShadow {
    let descriptor = DirectionalShadowDescriptor {
        map_size: MAP_SIZE,
        layout: CascadeLayout::fixed(cascades),
        stability,
        ..Default::default()
    };
    DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun")
}

/// Asserts that the visibilities of `shadow` at a yard's settled positions are the truth.
fn assert_yard(gpu: &Gpu, yards: &Yards, ask: &Ask, yard: usize, texel: f64, what: &str) {
    // A kernel reaches 2.83 texels to its corner; the floor is slanted by at most the light's own
    // slope.
    let settled = yards.settled(yard, |_| -SUN.normalize(), 4.5 * texel);
    let seen = ask.points(gpu, &settled.points);
    settled.assert_agrees(&seen, &format!("{what}, yard {yard}"));
}

/// Two cameras that see different parts of the world share one light's maps, and while nothing
/// moves the maps are kept. The light-space bounds over both yards are some 110 units wide.
#[test]
fn two_cameras_share_the_maps_of_a_sun() {
    let gpu = gpu();
    let yards = Yards::new(gpu);
    let list = yards.list();
    let view = |yard: usize| yards.camera(yard).view().with_max_distance(25.0);
    let cameras = [view(0), view(1)];
    for (stability, cascades) in [
        (Stability::TightFit, 1),
        (Stability::TightFit, 3),
        (Stability::BoundingSphere, 2),
    ] {
        let mut shadow = sun(gpu, stability, cascades);
        let ask = Ask::light(gpu, shadow.maps());
        let mut scene = ShadowScene::new();
        for step in 0..3 {
            let frame = scene
                .frame(&ShadowFrameDescriptor {
                    origin: DVec3::ZERO,
                    coverage: Coverage::Cameras(&cameras),
                    casters: Casters::List(&list),
                    receivers: &yards.floors,
                })
                .expect("a valid frame");
            let mut encoder = gpu.encoder();
            let light = DirectionalLight::new(SUN.as_vec3());
            let report = shadow.record(&mut encoder, &frame, &light);
            let report = report.expect("a valid frame").clone();
            gpu.submit(encoder);
            let drawn = |status| report.views.iter().any(|view| view.status == status);
            assert_eq!(drawn(ViewStatus::Drawn), step == 0, "{step}: {report:?}");
            assert!(drawn(ViewStatus::Kept) || step == 0);
        }
        let texel = shadow
            .maps()
            .views()
            .map(|view| view.texel_size_world().max_element());
        let texel = f64::from(texel.fold(0.0, f32::max));
        let what = format!("{stability:?}, {cascades} cascades");
        for yard in 0..2 {
            assert_yard(gpu, &yards, &ask, yard, texel, &what);
        }
    }
}

/// An additional camera costs no texels of a light whose fit it does not widen, and a mirrored one
/// counts like any other.
#[test]
fn a_mirror_sees_what_its_camera_sees() {
    let gpu = gpu();
    let yards = Yards::new(gpu);
    let list = yards.list();
    let camera = yards.camera(0).view().with_max_distance(25.0);
    // The camera is upside down: the handedness of the image is reversed, and what is seen is the
    // same.
    let flip = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)).as_mat4();
    let mirrored = CameraView {
        clip_from_view: flip * camera.clip_from_view,
        ..camera
    };
    let mut scene = ShadowScene::new();
    let mut placed = |cameras: &[CameraView]| {
        let frame = scene
            .frame(&ShadowFrameDescriptor {
                origin: DVec3::ZERO,
                coverage: Coverage::Cameras(cameras),
                casters: Casters::List(&list),
                receivers: &yards.floors,
            })
            .expect("a valid frame");
        let mut shadow = sun(gpu, Stability::TightFit, 2);
        let mut encoder = gpu.encoder();
        shadow
            .record(&mut encoder, &frame, &DirectionalLight::new(SUN.as_vec3()))
            .expect("a valid frame");
        shadow
            .maps()
            .views()
            .map(ShadowView::clip_from_render)
            .collect::<Vec<_>>()
    };
    let one = placed(&[camera]);
    assert_eq!(one.len(), 2);
    assert_eq!(placed(&[camera, camera]), one);
    assert_eq!(placed(&[mirrored, camera]), one);
    assert_eq!(placed(&[mirrored]), one);
    assert_eq!(placed(&[]), []);
}

/// Local lights draw the faces and the part of a cone that any of the cameras sees.
#[test]
fn two_cameras_share_the_maps_of_local_lights() {
    let gpu = gpu();
    let yards = Yards::new(gpu);
    let list = yards.list();
    let place = DVec3::new(50.0, 30.0, 20.0);
    let lamp = OmniLight {
        position_world: place,
        range: 70.0,
    };
    let spot = SpotLight {
        position_world: place,
        direction: Vec3::NEG_Y,
        outer_angle_radians: 1.3,
        range: 70.0,
    };
    let cameras = [0, 1].map(|yard| yards.camera(yard).view());
    let mut both = OmniShadow::new(
        &gpu.device,
        &OmniShadowDescriptor {
            map_size: 2048,
            ..Default::default()
        },
    )
    .expect("a valid lamp");
    let mut cone = SpotShadow::new(
        &gpu.device,
        &SpotShadowDescriptor {
            map_size: 4096,
            ..Default::default()
        },
    )
    .expect("a valid spot");
    let asks = [Ask::light(gpu, both.maps()), Ask::light(gpu, cone.maps())];
    let mut scene = ShadowScene::new();
    let frame = scene
        .frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(&cameras),
            casters: Casters::List(&list),
            receivers: &yards.floors,
        })
        .expect("a valid frame");
    let mut encoder = gpu.encoder();
    let report = both.record(&mut encoder, &frame, &lamp).cloned();
    let empty = |report: &ShadowReport| {
        let views = report.views.iter();
        views
            .filter(|view| view.status == ViewStatus::Empty)
            .count()
    };
    assert!(
        empty(&report.expect("a valid frame")) >= 2,
        "faces that nobody sees"
    );
    cone.record(&mut encoder, &frame, &spot)
        .expect("a valid frame");
    gpu.submit(encoder);
    let coarsest = |texels: &mut dyn Iterator<Item = f32>| f64::from(texels.fold(0.0, f32::max));
    let texel = |view: &ShadowView| view.texel_size_world().max_element();
    let texels = [
        coarsest(&mut both.maps().views().map(texel)),
        coarsest(&mut cone.maps().views().map(texel)),
    ];
    for yard in 0..2 {
        for (ask, texel) in asks.iter().zip(texels) {
            // A kernel reaches 2.83 texels to its corner, stretched by the low angle at which the
            // light meets the floor.
            let settled = yards.settled(yard, |at| place - at, 2.83 * texel / 0.3);
            let seen = ask.points(gpu, &settled.points);
            settled.assert_agrees(&seen, &format!("yard {yard}"));
        }
    }
}

/// The coverage of a frame means the same for all lights: without a limit everything counts, and
/// with a box what lies in it.
#[test]
fn coverage_is_one_for_all_lights() {
    let gpu = gpu();
    let yards = Yards::new(gpu);
    let list = yards.list();
    let mut scene = ShadowScene::new();
    let around = |middle: DVec3| {
        let middle = middle.as_vec3();
        Aabb::new(
            middle - Vec3::new(5.0, 0.5, 5.0),
            middle + Vec3::new(5.0, 3.0, 5.0),
        )
    };
    let mut texels = Vec::new();
    for coverage in [
        Coverage::Everything,
        Coverage::Bounds(around(yards.middles[0])),
        Coverage::Bounds(Aabb::EMPTY),
    ] {
        let frame = scene
            .frame(&ShadowFrameDescriptor {
                origin: DVec3::ZERO,
                coverage,
                casters: Casters::List(&list),
                receivers: &yards.floors,
            })
            .expect("a valid frame");
        let mut shadow = sun(gpu, Stability::TightFit, 1);
        let mut cone =
            SpotShadow::new(&gpu.device, &SpotShadowDescriptor::default()).expect("a valid spot");
        let spot = SpotLight {
            position_world: DVec3::new(50.0, 30.0, 20.0),
            direction: Vec3::NEG_Y,
            outer_angle_radians: 1.3,
            range: f32::INFINITY,
        };
        let ask = Ask::light(gpu, shadow.maps());
        let mut encoder = gpu.encoder();
        let light = DirectionalLight::new(SUN.as_vec3());
        let of =
            |report: &ShadowReport| (report.views[0].status, report.views[0].texel_size_world.x);
        let sun_view = of(shadow
            .record(&mut encoder, &frame, &light)
            .expect("a frame"));
        let spot_view = of(cone.record(&mut encoder, &frame, &spot).expect("a frame"));
        gpu.submit(encoder);
        if coverage == Coverage::Everything {
            let texel = f64::from(sun_view.1);
            for yard in 0..2 {
                assert_yard(gpu, &yards, &ask, yard, texel, "everything");
            }
        }
        texels.push((sun_view, spot_view));
    }
    let [everything, boxed, nothing] = texels[..] else {
        unreachable!("three coverages")
    };
    assert_eq!(everything.0.0, ViewStatus::Drawn);
    assert!(boxed.0.1 < 0.3 * everything.0.1 && boxed.1.1 < everything.1.1);
    assert_eq!(
        (nothing.0.0, nothing.1.0),
        (ViewStatus::Empty, ViewStatus::Empty)
    );
}
