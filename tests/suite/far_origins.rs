//! Tests suns at origins of any finite magnitude: a frame is correct or is refused. Nothing is
//! drawn with a matrix that is not finite, and no view is reported as empty that is not.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::triangle::{Triangle, occluded};
use wgpu_shadows::{
    Aabb, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    MeshCaster, ShadowCaster, ShadowError, ShadowView, ShadowViewUniform, Stability,
    report::ViewStatus,
};

use crate::fixtures::ask::submitted;
use crate::fixtures::frames::{Coverage, DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::probe::SunProbe;
use crate::fixtures::report::assert_whole;
use crate::fixtures::scene::{Scene, default_pipeline};
use crate::fixtures::view_member::member;

/// Describe a slab close above the floor, in units of `unit`.
const SLAB_HALF: f32 = 2.5;
const SLAB_LOW: f32 = 0.4;
const FLOOR_HALF: f32 = 4.0;

pub(super) fn meshes(unit: f32) -> [Mesh; 2] {
    let slab = Mesh::cuboid(
        Vec3::new(-SLAB_HALF, SLAB_LOW, -SLAB_HALF) * unit,
        Vec3::new(SLAB_HALF, SLAB_LOW + 0.1, SLAB_HALF) * unit,
    );
    [slab, Mesh::floor(0.0, FLOOR_HALF * unit)]
}

/// Returns origins of all magnitudes up to where the steps of f64 exceed the scene, and some of
/// every size beyond.
pub(super) fn origins() -> Vec<DVec3> {
    let axes = [
        DVec3::X,
        DVec3::NEG_Y,
        DVec3::Z,
        DVec3::new(0.61, 0.73, -0.31),
    ];
    let exponents = (0..=24).chain([30, 50, 100, 153, 155, 200, 300]);
    let lengths = exponents.map(|exponent| 1.7 * 10_f64.powi(exponent));
    let mut origins = vec![DVec3::ZERO];
    origins.extend(lengths.flat_map(|length| axes.map(|axis| axis * length)));
    origins
}

pub(super) fn assert_finite<'a>(
    views: impl Iterator<Item = &'a ShadowView>,
    uniforms: &[ShadowViewUniform],
    what: &str,
) {
    for view in views {
        assert!(view.clip_from_anchor().is_finite(), "{what}: {view:?}");
        assert!(view.clip_from_render().is_finite(), "{what}: {view:?}");
        assert!(view.anchor_render().is_finite(), "{what}: {view:?}");
    }
    for uniform in uniforms {
        let mapping: [f32; 12] = member(uniform, "mapping");
        let vectors = ["right", "down", "toward", "anchor"];
        let vectors = vectors.map(|name| member::<[f32; 3]>(uniform, name));
        let mut numbers = vectors.iter().flatten().chain(&mapping);
        assert!(
            numbers.all(|number| number.is_finite()),
            "{what}: {uniform:?}"
        );
    }
}

/// Returns the points of the floor where the ray-traced truth is the same for `margin` around.
pub(super) fn settled(
    triangles: &[Triangle],
    unit: f64,
    margin: f64,
    toward_light: impl Fn(DVec3) -> DVec3,
) -> Vec<(DVec3, bool)> {
    let dark = |place: DVec3| occluded(triangles, place, toward_light(place), 1e-6 * unit);
    let steps = || (-9..=9).map(|step| f64::from(step) * 0.43 * unit);
    let places = steps().flat_map(|x| steps().map(move |z| DVec3::new(x, 0.0, z)));
    places
        .filter_map(|place| {
            let here = dark(place);
            let around = (0..8).map(|corner| {
                let angle = f64::from(corner) * std::f64::consts::FRAC_PI_4;
                place + DVec3::new(angle.cos(), 0.0, angle.sin()) * margin
            });
            let mut same = around.map(|near| dark(near) == here);
            same.all(|same| same).then_some((place, here))
        })
        .collect()
}

pub(super) fn assert_right(wanted: &[(DVec3, bool)], seen: &[f32], what: &str) {
    let dark = wanted.iter().filter(|(_, dark)| *dark).count();
    assert!(
        dark > 0 && dark < wanted.len(),
        "{what}: {dark} of {} dark",
        wanted.len()
    );
    for ((place, dark), seen) in wanted.iter().zip(seen) {
        let right = if *dark { 0.0 } else { 1.0 };
        // The tolerance covers a sum of at most 64 weights in f32.
        assert!(
            (seen - right).abs() < 1e-4,
            "{what}: {seen} at {place}, dark: {dark}"
        );
    }
}

pub(super) fn points(wanted: &[(DVec3, bool)]) -> Vec<Point> {
    wanted
        .iter()
        .map(|(place, _)| Point::rounded(*place, DVec3::Y))
        .collect()
}

/// Describes a sun over the scene of one unit, with the coverage that a test needs.
struct Case {
    unit: f32,
    direction: Vec3,
    map_size: u32,
    cascades: u32,
    stability: Stability,
    coverage: Coverage,
}

impl Case {
    fn coverages(unit: f32) -> [(u32, Stability, Coverage); 3] {
        let eye = DVec3::new(0.3, 6.0, 7.0) * f64::from(unit);
        let camera = Camera::modern(eye, DVec3::ZERO, 1.2, 1.0).view();
        let bounds = Aabb::new(Vec3::splat(-4.5 * unit), Vec3::splat(4.5 * unit));
        let near = camera.with_max_distance(20.0 * unit);
        [
            (1, Stability::TightFit, Coverage::Bounds(bounds)),
            (2, Stability::TightFit, Coverage::Camera(camera)),
            (1, Stability::BoundingSphere, Coverage::Camera(near)),
        ]
    }

    fn all() -> Vec<Self> {
        let mut cases = Vec::new();
        for unit in [0.125, 1.0, 1000.0] {
            for direction in [
                Vec3::NEG_Y,
                Vec3::new(0.3, -1.0, 0.2),
                Vec3::new(0.0, -1.0, 1.0),
            ] {
                for map_size in [4, 64, 256] {
                    for (cascades, stability, coverage) in Self::coverages(unit) {
                        cases.push(Self {
                            unit,
                            direction,
                            map_size,
                            cascades,
                            stability,
                            coverage,
                        });
                    }
                }
            }
        }
        cases
    }

    fn words(&self) -> String {
        format!(
            "unit {}, light {}, {} texels, {:?}, {} cascades",
            self.unit, self.direction, self.map_size, self.stability, self.cascades
        )
    }
}

/// Returns the longer sides of the finest and of the coarsest view's texels.
fn texels(shadow: &DirectionalShadow) -> (f64, f64) {
    let sides = shadow
        .maps()
        .views()
        .map(|view| f64::from(view.texel_size_world().max_element()));
    sides.fold((f64::INFINITY, 0.0), |(finest, coarsest), side| {
        (side.min(finest), side.max(coarsest))
    })
}

/// Scans all origins, and returns the number of frames that were compared with the truth.
fn scan(case: &Case, scene: &Scene, casters: &[MeshCaster]) -> usize {
    let gpu = gpu();
    let descriptor = DirectionalShadowDescriptor {
        map_size: case.map_size,
        layout: CascadeLayout::fixed(case.cascades),
        stability: case.stability,
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let probe = SunProbe::new(gpu, &shadow);
    let casters: Vec<&dyn ShadowCaster> = casters.iter().map(|caster| caster as _).collect();
    let toward_light = -case.direction.as_dvec3().normalize();
    let mut at_zero = (0.0, 0.0);
    let mut judged = 0;
    for origin in origins() {
        let what = format!("{} at {origin}", case.words());
        // The casters keep their positions in render space, so each origin puts them elsewhere in
        // the world without a change of their revisions.
        shadow.invalidate();
        shadow.reset_history();
        let frame = DirectionalFrame {
            origin,
            light: DirectionalLight::new(case.direction),
            coverage: case.coverage,
            casters: &casters,
            receivers: &[],
        };
        let record = submitted(gpu, |encoder| shadow.record_frame(encoder, &frame));
        let spacing = f64::EPSILON * origin.length();
        let report = match record {
            Ok(report) => report,
            Err(ShadowError::ViewNotRepresentable { .. }) => {
                // A frame is refused where four steps exceed a texel of its extent. Margins and
                // size steps make texels coarser than that, by a factor below eight.
                let least_of_64 = (f64::from(case.map_size) / 64.0).min(1.0);
                let (finest, _) = at_zero;
                assert!(spacing * 32.0 > finest * least_of_64, "{what} is refused");
                continue;
            }
            Err(error) => panic!("{what}: {error}"),
        };
        assert_whole(&report, &what);
        assert_finite(shadow.maps().views(), shadow.maps().view_uniforms(), &what);
        assert!(
            spacing < f64::from(FLOOR_HALF * case.unit),
            "{what} is taken"
        );
        let drawn = report
            .views
            .iter()
            .filter(|view| view.status != ViewStatus::Empty);
        assert_eq!(drawn.count(), case.cascades as usize, "{what}");
        let (_, texel) = texels(&shadow);
        if origin == DVec3::ZERO {
            at_zero = texels(&shadow);
        }
        assert!(texel <= 2.0 * at_zero.1, "{what}: {texel}");
        // With coarser texels no point of the floor would be settled.
        if texel < 0.3 * f64::from(case.unit) {
            // The default kernel reaches 2.83 texels to its corner.
            let unit = f64::from(case.unit);
            let wanted = settled(&scene.triangles, unit, 3.0 * texel, |_| toward_light);
            assert_right(&wanted, &probe.ask(gpu, &points(&wanted)), &what);
            judged += 1;
        }
    }
    judged
}

#[test]
fn suns_of_any_origin_are_right_or_refused() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let mut judged = 0;
    for case in Case::all() {
        let meshes = meshes(case.unit);
        let scene = Scene::new(gpu, &meshes);
        let casters: Vec<_> = meshes
            .iter()
            .map(|mesh| mesh.caster(gpu, &pipeline, Mat4::IDENTITY))
            .collect();
        judged += scan(&case, &scene, &casters);
    }
    assert!(judged > 1500, "{judged}");
}

/// Checks that a frame is taken up to where four steps of f64 are as large as a texel of the extent
/// that the error states, `2⁵⁰ extent / size`, and is refused beyond, as
/// `ShadowFrameDescriptor::origin` and `ShadowError::ViewNotRepresentable` say.
#[test]
fn frames_are_taken_as_far_as_the_docs_say() {
    let gpu = gpu();
    let scene = Scene::new(gpu, &meshes(1.0));
    let casters = scene.list();
    for (cascades, stability, coverage) in Case::coverages(1.0) {
        for map_size in [16_u32, 64, 256, 1024] {
            let descriptor = DirectionalShadowDescriptor {
                map_size,
                layout: CascadeLayout::fixed(cascades),
                stability,
                ..Default::default()
            };
            let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
            let mut is_taken = |distance: f64| {
                let frame = DirectionalFrame {
                    origin: DVec3::X * distance,
                    light: DirectionalLight::new(Vec3::NEG_Y),
                    coverage,
                    casters: &casters,
                    receivers: &[],
                };
                shadow.reset_history();
                match submitted(gpu, |encoder| shadow.record_frame(encoder, &frame)) {
                    Ok(_) => Ok(()),
                    Err(ShadowError::ViewNotRepresentable { extent_world, .. }) => {
                        Err(extent_world)
                    }
                    Err(error) => panic!("{error}"),
                }
            };
            let extent = is_taken(1e20).expect_err("far beyond any limit");
            let limit = 2.0_f64.powi(50) * extent / f64::from(map_size.max(64));
            // The scene itself is a few units away from its origin.
            assert_eq!(
                is_taken(0.99 * limit - 20.0),
                Ok(()),
                "{map_size} {stability:?}"
            );
            let refused = is_taken(1.01 * limit + 20.0);
            assert!(refused.is_err(), "{map_size} {stability:?}: {extent}");
        }
    }
}

/// Where nothing casts, nothing is reported and nothing is refused, however far the origin is.
#[test]
fn an_empty_world_is_empty_at_any_origin() {
    let gpu = gpu();
    let mut shadow = DirectionalShadow::new(&gpu.device, &Default::default()).expect("a valid sun");
    for origin in origins() {
        for (_, _, coverage) in Case::coverages(1.0) {
            let frame = DirectionalFrame {
                origin,
                light: DirectionalLight::new(Vec3::new(0.3, -1.0, 0.2)),
                coverage,
                casters: &[],
                receivers: &[Aabb::new(Vec3::splat(-1.0), Vec3::splat(1.0))],
            };
            let record = submitted(gpu, |encoder| shadow.record_frame(encoder, &frame));
            let report = record.expect("nothing to refuse");
            assert_eq!(report.views[0].status, ViewStatus::Empty);
            assert_whole(&report, &format!("{origin}"));
        }
    }
}
