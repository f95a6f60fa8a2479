//! Tests that cascades meet without a seam, and that each shows the truth.

use glam::DVec3;
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use wgpu_shadows::reference::receiver;
use wgpu_shadows::{Bias, CascadeLayout, CascadeSplit, DirectionalShadowDescriptor, Filter};

use super::stage::{MARGIN, Sun, Verdict, bounds_of, boxes, level, scene, shining, world};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;
use crate::fixtures::random_scene::World;
use crate::fixtures::view_member::member;

const LIGHT: DVec3 = DVec3::new(0.5, -1.0, 0.35);

/// Returns rows of boxes to the horizon, over a floor that only receives, before a camera that
/// looks along them.
fn avenue() -> (World, Vec<Mesh>) {
    let camera = Camera::modern(
        DVec3::new(-1.0, 2.6, -9.0),
        DVec3::new(1.0, 0.5, 30.0),
        1.0,
        1.5,
    );
    let mut world = world(LIGHT, camera);
    for row in 1..6 {
        for (low, high) in boxes() {
            let shift = DVec3::Z * 11.3 * f64::from(row);
            world.boxes.push((low + shift, high + shift));
        }
    }
    let meshes = world
        .boxes
        .iter()
        .map(|(low, high)| Mesh::cuboid(low.as_vec3(), high.as_vec3()))
        .collect();
    (world, meshes)
}

/// Returns the layer with which a position on the floor is sampled.
fn layer_of(sun: &Sun, place: DVec3) -> Option<usize> {
    let position = place.as_vec3().as_dvec3();
    let filter = Filter::default();
    sun.shadow
        .maps()
        .view_uniforms()
        .iter()
        .position(|view| receiver(view, filter, Bias::Auto, position, DVec3::Y).inside)
}

fn cascaded(cascades: u32, split: CascadeSplit, world: &World, meshes: &[Mesh]) -> Sun {
    let mut sun = Sun::new(&DirectionalShadowDescriptor {
        map_size: 256,
        layout: CascadeLayout::Fixed { cascades, split },
        ..Default::default()
    });
    let floor = Mesh::floor(0.0, 80.0).bounds();
    let report = sun.record(
        DVec3::ZERO,
        shining(world.light),
        Coverage::Camera(world.camera.view().with_max_distance(60.0)),
        &scene(meshes).list(),
        &[floor],
    );
    assert!(bounds_of(meshes).max.z < 80.0);
    let layers = report.views.iter().map(|view| view.layer);
    assert!(layers.eq(0..cascades), "one report a layer");
    let uniforms = sun.shadow.maps().view_uniforms();
    assert!(
        uniforms
            .iter()
            .all(|view| member::<u32>(view, "layer") < cascades)
    );
    sun
}

/// With 1 to 8 cascades and every split, receivers all over the image are as dark as the ray-traced
/// truth, wherever it is the same for three texels of their own cascade around. Along lines into
/// the depth, where one cascade ends and the next begins, the visibilities on both sides of the
/// border agree unless an edge lies within three of the coarser texels: there is no seam.
#[test]
fn every_cascade_shows_the_truth_and_borders_are_no_seams() {
    let (world, meshes) = avenue();
    let mut places = world.floor_around_shadows(2500);
    for line in 0..12 {
        let x = f64::from(line) * 0.77 - 5.0;
        places.extend((0..300).map(|step| DVec3::new(x, 0.0, -6.0 + f64::from(step) * 0.2)));
    }
    places.retain(|place| world.camera.sees(*place, 60.0, 0.002));
    let mut all = Verdict::default();
    let mut borders = 0;
    let splits = [
        CascadeSplit::Uniform,
        CascadeSplit::Logarithmic,
        CascadeSplit::Practical { lambda: 0.5 },
    ];
    for cascades in 1..=8 {
        for split in splits {
            let sun = cascaded(cascades, split, &world, &meshes);
            let texels: Vec<_> = sun
                .shadow
                .maps()
                .report()
                .views
                .iter()
                .map(|view| f64::from(view.texel_size_world.max_element()))
                .collect();
            let coarsest = texels.iter().copied().fold(0.0, f64::max);
            let seen = sun.ask(&level(&places, DVec3::ZERO));
            let mut verdict = Verdict::default();
            let mut used = vec![0; cascades as usize];
            let mut before: Option<(usize, Option<bool>, f32)> = None;
            for (place, seen) in places.iter().zip(&seen) {
                let layer = layer_of(&sun, *place);
                let texel = layer.map_or(coarsest, |layer| texels[layer]);
                let truth = world.truth(*place, texel, MARGIN);
                verdict.count(truth, *seen);
                if let Some(layer) = layer {
                    used[layer] += 1;
                    if let Some((other, other_truth, other_seen)) = before
                        && other != layer
                        && truth.is_some()
                        && truth == other_truth
                    {
                        borders += 1;
                        let jump = (seen - other_seen).abs();
                        assert!(jump <= 2.0 * super::stage::SUM_ERROR, "{place}: {jump}");
                    }
                    before = Some((layer, truth, *seen));
                }
            }
            verdict.assert_right(&format!("{cascades} cascades, {split:?}"));
            let idle = used.iter().filter(|count| **count == 0).count();
            assert!(
                idle <= cascades as usize / 2,
                "{cascades} {split:?} on {}: {used:?}",
                gpu().describe()
            );
            all.add(&verdict);
        }
    }
    assert!(borders > 100, "{borders} borders crossed");
    table::record(
        "1 to 8 cascades, three splits",
        "settled receivers as the truth says, no jump at a border",
        format!("{}, no jump at {borders} borders", all.words()),
    );
}
