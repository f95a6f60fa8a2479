//! Tests extents that no motion of the camera changes, splits at given depths, and what a walk
//! through a town changes.

use glam::DVec3;
use shadow_support::camera::Camera;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    CascadeLayout, CascadeSplit, DirectionalShadow, DirectionalShadowDescriptor, ShadowError,
    Stability, reference,
};

use crate::fixtures::frames::RecordFrame;
use crate::fixtures::gpu::gpu;
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::rounding::U;
use crate::fixtures::scene::Scene;
use crate::fixtures::town::{town, town_frame, walker};

fn sun(descriptor: &DirectionalShadowDescriptor<'_>) -> DirectionalShadow {
    DirectionalShadow::new(&gpu().device, descriptor).expect("a valid sun")
}

/// Over 200 frames of the walk, a point of the floor that the same cascade covers with the same
/// texel size before and after keeps its visibility, to the rounding of texel coordinates (`28uN`
/// in each frame, times the sharpness of three and two axes), except for ties of comparisons, one
/// in five hundred. Texel sizes change for at most a twentieth of the cascades per frame.
#[test]
fn a_walk_changes_shadows_only_with_a_rung() {
    const FRAMES: u32 = 200;
    const MAP_SIZE: u32 = 512;
    let scene = Scene::new(gpu(), &town(31));
    let list = scene.list();
    let mut shadow = sun(&DirectionalShadowDescriptor {
        map_size: MAP_SIZE,
        layout: CascadeLayout::fixed(4),
        ..Default::default()
    });
    let probe = SunProbe::new(gpu(), &shadow);
    let mut random = Random::new(3);
    let places: Vec<_> = (0..3000)
        .map(|_| {
            let place = random.point(DVec3::new(-25.0, 0.0, -30.0), DVec3::new(45.0, 0.0, 45.0));
            place.as_vec3().as_dvec3()
        })
        .collect();
    let points: Vec<_> = places
        .iter()
        .map(|place| Point::rounded(*place, DVec3::Y))
        .collect();
    let band = (2.0 * 28.0 * U * f64::from(MAP_SIZE) * 6.0) as f32 + 1e-5;
    let mut before: Option<(Vec<_>, Vec<f32>, [glam::Vec2; 4])> = None;
    let (mut compared, mut changed, mut rescaled) = (0_u32, 0, 0_u32);
    for index in 0..FRAMES {
        let camera = walker(index);
        let report = record(gpu(), &mut shadow, &town_frame(&list, &camera, 120.0));
        let sizes = [0, 1, 2, 3].map(|layer| report.views[layer].texel_size_world);
        let served: Vec<_> = places
            .iter()
            .map(|place| {
                let uniforms = shadow.maps().view_uniforms();
                let seen = camera.sees(*place, 120.0, 0.001);
                seen.then(|| {
                    uniforms
                        .iter()
                        .position(|view| reference::holds(view, *place))
                })
                .flatten()
            })
            .collect();
        let seen = probe.ask(gpu(), &points);
        if let Some((served_before, seen_before, sizes_before)) = &before {
            rescaled += (0..4).filter(|&l| sizes[l] != sizes_before[l]).count() as u32;
            for point in 0..places.len() {
                let layer = served[point].filter(|_| served[point] == served_before[point]);
                if layer.is_some_and(|layer| sizes[layer] == sizes_before[layer]) {
                    compared += 1;
                    changed += u32::from((seen[point] - seen_before[point]).abs() > band);
                }
            }
        }
        before = Some((served, seen, sizes));
    }
    assert!(compared > 50_000, "{compared}");
    assert!(changed * 500 <= compared, "{changed} of {compared}");
    let windows = 4 * FRAMES;
    assert!(
        rescaled > 0 && rescaled * 20 <= windows,
        "{rescaled} of {windows}"
    );
}

/// Whatever the camera does, the texels of a sphere's cascades are those of the first frame, to the
/// bit, and what the camera sees in the slice is covered.
#[test]
fn no_motion_changes_a_spheres_texels() {
    let scene = Scene::new(gpu(), &town(31));
    let list = scene.list();
    let mut shadow = sun(&DirectionalShadowDescriptor {
        map_size: 256,
        layout: CascadeLayout::fixed(3),
        stability: Stability::BoundingSphere,
        ..Default::default()
    });
    let mut random = Random::new(8);
    let mut texels = [None; 3];
    let mut held = 0;
    for _ in 0..60 {
        let eye = random.point(DVec3::new(-60.0, 1.0, -60.0), DVec3::new(60.0, 9.0, 60.0));
        let mut way = random.direction();
        way.y = -0.3 * way.y.abs();
        let camera = Camera::modern(eye, eye + way, 1.0, 1.5);
        let report = record(gpu(), &mut shadow, &town_frame(&list, &camera, 80.0));
        for (texel, view) in texels.iter_mut().zip(&report.views) {
            let now = view.texel_size_world;
            if now.x > 0.0 {
                assert_eq!(now.x, now.y);
                assert_eq!(*texel.get_or_insert(now), now);
            }
        }
        for _ in 0..50 {
            let place = random.point(DVec3::new(-90.0, 0.0, -90.0), DVec3::new(90.0, 0.0, 90.0));
            if camera.sees(place, 80.0, 0.001) {
                let mut views = shadow.maps().view_uniforms().iter();
                let is_held = views.any(|view| reference::holds(view, place));
                let serves = report.views.iter().all(|view| view.casters > 0);
                assert!(is_held || !serves, "{place}");
                held += usize::from(is_held);
            }
        }
    }
    assert!(held > 100, "{held}");
    assert!(texels.iter().all(Option::is_some), "{texels:?}");
}

/// A sphere needs a finite end: a camera without a far plane must have a distance limit.
#[test]
fn a_sphere_around_an_endless_view_is_refused() {
    let scene = Scene::new(gpu(), &town(31));
    let list = scene.list();
    let mut shadow = sun(&DirectionalShadowDescriptor {
        map_size: 64,
        stability: Stability::BoundingSphere,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    });
    let mut encoder = gpu().encoder();
    let endless = town_frame(&list, &walker(0), f32::INFINITY);
    let error = shadow
        .record_frame(&mut encoder, &endless)
        .expect_err("no end");
    let named = "CameraView::max_distance";
    assert!(
        matches!(&error, ShadowError::OutOfRange { field, .. } if *field == named),
        "{error}"
    );
    assert!(
        shadow
            .record_frame(&mut encoder, &town_frame(&list, &walker(0), 50.0))
            .is_ok()
    );
}

/// Each position is covered by the cascade of its depth or a finer one, unless no shadow reaches
/// it.
#[test]
fn explicit_splits_end_where_they_say() {
    let scene = Scene::new(gpu(), &town(31));
    let list = scene.list();
    let ends = &[15.0, 40.0];
    let mut shadow = sun(&DirectionalShadowDescriptor {
        map_size: 256,
        layout: CascadeLayout::Fixed {
            cascades: 3,
            split: CascadeSplit::Explicit { ends },
        },
        ..Default::default()
    });
    let camera = walker(0);
    let report = record(gpu(), &mut shadow, &town_frame(&list, &camera, 80.0));
    let texels: Vec<_> = report
        .views
        .iter()
        .map(|view| view.texel_size_world.x)
        .collect();
    assert!(
        texels.is_sorted() && texels[2] > 2.0 * texels[0],
        "{texels:?}"
    );
    let mut random = Random::new(12);
    let (mut by_cascade, mut left_out) = ([0; 3], Vec::new());
    for _ in 0..12_000 {
        let place = random.point(DVec3::new(-30.0, 0.0, -50.0), DVec3::new(60.0, 0.0, 50.0));
        if camera.sees(place, 80.0, 0.001) {
            let depth = (camera.pose.eye - place).dot(camera.pose.axes.z_axis);
            let cascade = usize::from(depth > 15.0) + usize::from(depth > 40.0);
            let holds = |view: &_| reference::holds(view, place);
            let uniforms = shadow.maps().view_uniforms();
            let held = holds(&uniforms[cascade]);
            if !held && !uniforms[..cascade].iter().any(holds) {
                left_out.push(Point::rounded(place, DVec3::Y));
            }
            by_cascade[cascade] += usize::from(held);
        }
    }
    assert!(by_cascade.iter().all(|count| *count > 20), "{by_cascade:?}");
    // What neither its own nor a finer cascade covers is out of the reach of every shadow.
    left_out.push(Point::rounded(camera.pose.eye + DVec3::Y * 100.0, DVec3::Y));
    let seen = SunProbe::new(gpu(), &shadow).ask(gpu(), &left_out);
    assert!(seen.iter().all(|seen| *seen > 0.999), "{seen:?}");
    // Ends before everything that is seen leave their cascades empty.
    let mut shadow = sun(&DirectionalShadowDescriptor {
        map_size: 256,
        layout: CascadeLayout::Fixed {
            cascades: 3,
            split: CascadeSplit::Explicit {
                ends: &[0.01, 0.02],
            },
        },
        ..Default::default()
    });
    let report = record(gpu(), &mut shadow, &town_frame(&list, &camera, 80.0));
    let empty = |index: usize| report.views[index].texel_size_world.x == 0.0;
    assert!(empty(0) && empty(1) && !empty(2), "{report:?}");
    // Ends that do not grow or are not finite are refused.
    for ends in [
        &[2.0, 2.0][..],
        &[3.0, 1.0],
        &[f32::NAN, 3.0],
        &[1.0, f32::INFINITY],
        &[],
        &[1.0],
        &[1.0, 2.0, 3.0],
    ] {
        let refused = DirectionalShadow::new(
            &gpu().device,
            &DirectionalShadowDescriptor {
                layout: CascadeLayout::Fixed {
                    cascades: 3,
                    split: CascadeSplit::Explicit { ends },
                },
                ..Default::default()
            },
        );
        assert!(
            matches!(refused, Err(ShadowError::OutOfRange { .. })),
            "{ends:?}"
        );
    }
}
