//! Tests layouts of cascades that are found: they divide one layer, change rarely, and are looked
//! up where they are.

use glam::{DVec3, UVec2};
use shadow_support::camera::Camera;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor, Filter,
    reference, report::ShadowReport, report::TexelRect, report::ViewStatus,
};

use crate::fixtures::frames::{DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::{gpu, vulkan};
use crate::fixtures::probe::{SunProbe, record};
use crate::fixtures::scene::Scene;
use crate::fixtures::texture_bytes::TextureBytes;
use crate::fixtures::town::{town, town_frame, walker};

const MAP_SIZE: u32 = 256;

const AUTOMATIC: DirectionalShadowDescriptor<'static> = DirectionalShadowDescriptor {
    map_size: MAP_SIZE,
    layout: CascadeLayout::Automatic { max_cascades: 4 },
    ..DirectionalShadowDescriptor::CHEAP
};

fn sun(descriptor: &DirectionalShadowDescriptor<'_>) -> DirectionalShadow {
    DirectionalShadow::new(&gpu().device, descriptor).expect("a valid sun")
}

/// Is the distance at which the shadows of the town end.
const END: f32 = 120.0;

/// Returns the rectangles of the views that have a map.
fn rects(report: &ShadowReport) -> Vec<TexelRect> {
    let views = report.views.iter();
    let views = views.filter(|view| view.status != ViewStatus::Empty);
    views.map(|view| view.texels).collect()
}

fn overlap(a: &TexelRect, b: &TexelRect) -> bool {
    a.min.cmplt(b.min + b.size).all() && b.min.cmplt(a.min + a.size).all()
}

/// Over ten seconds of a walk, rectangles are within the layer and apart from each other, there is
/// more than one of them, and the layout changes at most once in two seconds. Another light of the
/// same kind has the same layouts.
#[test]
fn layouts_of_a_walk_divide_the_layer_and_change_rarely() {
    let scene = Scene::new(gpu(), &town(31));
    let list = scene.list();
    let (mut first, mut second) = (sun(&AUTOMATIC), sun(&AUTOMATIC));
    let mut changes = 0;
    let mut before: Vec<TexelRect> = Vec::new();
    for index in 0..600 {
        let camera = walker(index);
        let report = record(gpu(), &mut first, &town_frame(&list, &camera, END));
        let other = record(gpu(), &mut second, &town_frame(&list, &camera, END));
        assert_eq!(report, other);
        assert_eq!(first.maps().view_uniforms(), second.maps().view_uniforms());
        let texels: Vec<_> = report.views.iter().map(|view| view.texels).collect();
        let rects = rects(&report);
        for (place, rect) in rects.iter().enumerate() {
            assert!((rect.min + rect.size).cmple(UVec2::splat(MAP_SIZE)).all());
            let others = &rects[place + 1..];
            assert!(
                others.iter().all(|other| !overlap(rect, other)),
                "{rects:?}"
            );
        }
        assert!(rects.len() > 1, "{rects:?}");
        let error = report.predicted_error.expect("an automatic layout");
        assert!(error > 0.0 && error < 0.5, "{error}");
        let both = texels.iter().zip(&before);
        let moved = |(now, before): (&TexelRect, &TexelRect)| {
            now != before && now.size != UVec2::ZERO && before.size != UVec2::ZERO
        };
        let changed = texels.len() != before.len() || both.into_iter().any(moved);
        changes += usize::from(index > 0 && changed);
        before = texels;
    }
    assert!(changes <= 5, "{changes}");
}

/// Rectangles that were kept hold what would be drawn, while a caster moves, the layout changes and
/// the camera jumps.
#[test]
fn kept_rectangles_are_what_would_be_drawn() {
    let gpu = vulkan();
    let scene = Scene::new(gpu, &town(31));
    let list = scene.list();
    let sun = || DirectionalShadow::new(&gpu.device, &AUTOMATIC).expect("a valid sun");
    let (mut kept, mut fresh) = (sun(), sun());
    let [kept_bytes, fresh_bytes] =
        [&kept, &fresh].map(|sun| TextureBytes::new(gpu, sun.maps().texture()));
    let mut random = Random::new(17);
    let mut kept_views = 0;
    let mut layouts = std::collections::BTreeSet::new();
    let mut camera = walker(0);
    let mut light = glam::Vec3::new(0.37, -1.0, 0.21);
    for index in 0..300 {
        if random.unit() < 0.1 {
            // The camera cuts to one of four places, so that earlier layouts come back.
            let place = f64::from((random.unit() * 4.0) as u32);
            let eye = DVec3::new(20.0 * place - 30.0, 1.7 + 4.0 * place * place, 1.0);
            camera = Camera::modern(eye, eye + DVec3::new(1.0, -0.1 * place, 0.3), 1.0, 1.5);
            kept.reset_history();
            fresh.reset_history();
        }
        if random.unit() < 0.01 {
            light.x = -light.x;
        }
        // Some of the houses are gone for a frame.
        let part = if random.unit() < 0.3 {
            list.len() - 5
        } else {
            list.len()
        };
        let frame = DirectionalFrame {
            light: DirectionalLight::new(light),
            ..town_frame(&list[..part], &camera, END)
        };
        let mut encoder = gpu.encoder();
        let report = kept.record_frame(&mut encoder, &frame);
        let report = report.expect("a valid frame").clone();
        fresh.invalidate();
        fresh
            .record_frame(&mut encoder, &frame)
            .expect("a valid frame");
        kept_bytes.copy(&mut encoder);
        fresh_bytes.copy(&mut encoder);
        gpu.submit(encoder);
        let (now, wanted) = (kept_bytes.read(gpu), fresh_bytes.read(gpu));
        kept_bytes.assert_same_views(&report, [&now, &wanted], || format!("frame {index}"));
        for view in report
            .views
            .iter()
            .filter(|view| view.status != ViewStatus::Empty)
        {
            kept_views += u32::from(view.status == ViewStatus::Kept);
            let TexelRect { min, size } = view.texels;
            layouts.insert((report.views.len(), [min.x, min.y, size.x, size.y]));
        }
    }
    assert!(kept_views > 100, "{kept_views}");
    assert!(layouts.len() > 4, "{layouts:?}");
}

/// Lookups in rectangles are those of the reference for the texels that the layer contains, but for
/// ties of comparisons and rounding at the sides of cascades, one in a hundred; and they are nearly
/// those of a finer map without rectangles.
#[test]
fn lookups_read_the_rectangle_of_their_cascade() {
    let gpu = vulkan();
    let scene = Scene::new(gpu, &town(31));
    let list = scene.list();
    for blend in [0.0, 0.2] {
        for filter in [Filter::Hardware, Filter::Tent3 { sharpness: 3.0 }] {
            let descriptor = DirectionalShadowDescriptor {
                filter,
                blend,
                ..AUTOMATIC
            };
            let fine = DirectionalShadowDescriptor {
                map_size: 2048,
                layout: CascadeLayout::fixed(1),
                filter,
                ..AUTOMATIC
            };
            let mut fine = DirectionalShadow::new(&gpu.device, &fine).expect("a valid sun");
            let fine_probe = SunProbe::new(gpu, &fine);
            let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
            let probe = SunProbe::new(gpu, &shadow);
            let bytes = TextureBytes::new(gpu, shadow.maps().texture());
            let camera = walker(0);
            record(gpu, &mut shadow, &town_frame(&list, &camera, END));
            record(gpu, &mut fine, &town_frame(&list, &camera, END));
            let mut encoder = gpu.encoder();
            bytes.copy(&mut encoder);
            gpu.submit(encoder);
            let layer: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes.read(gpu)[0]);
            let map = reference::DepthLayer {
                size: MAP_SIZE,
                depths: &layer,
            };
            let mut random = Random::new(5);
            let places: Vec<DVec3> = (0..20_000)
                .map(|_| random.point(DVec3::new(-20.0, 0.0, -60.0), DVec3::new(100.0, 0.0, 60.0)))
                .map(|place| place.as_vec3().as_dvec3())
                .collect();
            let points: Vec<_> = places
                .iter()
                .map(|place| Point::rounded(*place, DVec3::Y))
                .collect();
            let seen = probe.ask(gpu, &points);
            let fine = fine_probe.ask(gpu, &points);
            let uniforms = shadow.maps().view_uniforms();
            let mut by_view = [0; 4];
            let (mut shadowed, mut wrong, mut apart) = (0, 0, 0);
            for ((place, seen), fine) in places.iter().zip(&seen).zip(&fine) {
                let visible = camera.sees(*place, 120.0, 0.001);
                apart += u32::from(visible && (seen - fine).abs() > 0.5);
                let (mut lit, mut share) = (0.0, 0.0);
                for (index, view) in uniforms.iter().enumerate() {
                    if share == 1.0 || !reference::holds(view, *place) {
                        continue;
                    }
                    by_view[index] += 1;
                    let weight = if blend > 0.0 {
                        reference::weight(view, *place)
                    } else {
                        1.0
                    };
                    let part = (1.0 - share) * weight;
                    let bias = descriptor.bias;
                    let receiver = reference::receiver(view, filter, bias, *place, DVec3::Y);
                    lit += part * reference::visibility(filter, &map, &receiver);
                    share += part;
                }
                let wanted = if share > 0.0 { lit / share } else { 1.0 };
                shadowed += u32::from(wanted < 0.5);
                // The tolerance is far above rounding and far below what a wrong rectangle gives.
                wrong += u32::from((wanted - f64::from(*seen)).abs() > 0.02);
            }
            let served = by_view.iter().filter(|count| **count > 100).count();
            assert!(served > 1, "{by_view:?}");
            assert!(shadowed > 1000, "{shadowed}");
            assert!(wrong <= 200, "{wrong} of {}", places.len());
            // Near the edges of shadows, coarser texels see another side. The shadows of another
            // rectangle would be wrong at a third of the places.
            assert!(apart <= 400, "{apart} of {}", places.len());
        }
    }
}

/// Maps that are too small to be divided have one cascade, and nothing panics.
#[test]
fn small_maps_are_not_divided() {
    let scene = Scene::new(gpu(), &town(31));
    let list = scene.list();
    for map_size in [1, 2, 3, 17, 40] {
        let mut shadow = sun(&DirectionalShadowDescriptor {
            map_size,
            layout: CascadeLayout::Automatic { max_cascades: 8 },
            ..AUTOMATIC
        });
        for index in 0..3 {
            let report = record(
                gpu(),
                &mut shadow,
                &town_frame(&list, &walker(index * 40), END),
            );
            let whole = TexelRect {
                min: UVec2::ZERO,
                size: UVec2::splat(map_size),
            };
            assert_eq!(rects(&report), [whole]);
        }
    }
}
