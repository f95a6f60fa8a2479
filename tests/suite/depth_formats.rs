//! Tests maps of 16 bits: what they contain, what they cost, and casters that were not made for
//! them.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::readback;
use wgpu_shadows::{
    Aabb, CascadeLayout, CasterPipeline, DepthFormat, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, ShadowCaster, ShadowError, caster::CasterPipelineDescriptor,
    error::CasterError,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::{SunProbe, record};

const BOX: Aabb = Aabb::new(Vec3::new(-4.0, -1.0, -4.0), Vec3::new(4.0, 4.0, 4.0));

fn sun(gpu: &Gpu, depth_format: DepthFormat) -> DirectionalShadow {
    DirectionalShadow::new(
        &gpu.device,
        &DirectionalShadowDescriptor {
            map_size: 128,
            depth_format,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        },
    )
    .expect("a valid sun")
}

fn pipeline(gpu: &Gpu, depth_formats: &[DepthFormat]) -> Result<CasterPipeline, CasterError> {
    CasterPipeline::new(
        &gpu.device,
        &CasterPipelineDescriptor {
            depth_formats,
            ..Default::default()
        },
    )
}

fn frame<'a>(casters: &'a [&'a dyn ShadowCaster]) -> DirectionalFrame<'a> {
    DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::new(0.3, -1.0, 0.2)),
        coverage: Coverage::Bounds(BOX),
        casters,
        receivers: &[],
    }
}

/// For the same scene in both formats, depths differ by a step at most, visibilities away from
/// edges do not differ, and the memory is half. The reported gap is larger by two steps of
/// `depth_range / 65535`: the receiver's and the caster's.
#[test]
fn sixteen_bits_hold_the_same_depths_to_a_step() {
    let gpu = gpu();
    let both = pipeline(gpu, &[DepthFormat::Unorm16, DepthFormat::Float32]).expect("both formats");
    let slab = Mesh::cuboid(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 1.3, 1.0));
    let slab = slab.caster(gpu, &both, Mat4::from_rotation_z(0.3));
    let casters: [&dyn ShadowCaster; 1] = [&slab];
    let mut found = Vec::new();
    for format in [DepthFormat::Float32, DepthFormat::Unorm16] {
        let mut shadow = sun(gpu, format);
        assert_eq!(shadow.maps().texture().format(), format.texture_format());
        let report = record(gpu, &mut shadow, &frame(&casters));
        let depths = readback::depth_layer(gpu, shadow.maps().texture(), 0);
        let points: Vec<_> = (0..400)
            .map(|index| {
                let (column, row) = (index % 20, index / 20);
                let place = Vec3::new(column as f32 * 0.2 - 2.0, 0.0, row as f32 * 0.2 - 2.0);
                Point::new(place, Vec3::Y)
            })
            .collect();
        let seen = SunProbe::new(gpu, &shadow).ask(gpu, &points);
        found.push((report, depths, seen));
    }
    let [
        (wide, wide_depths, wide_seen),
        (narrow, narrow_depths, narrow_seen),
    ] = &found[..]
    else {
        unreachable!("two formats")
    };
    let step = 1.0 / 65_535.0;
    let mut covered = 0;
    for (wide, narrow) in wide_depths.iter().zip(narrow_depths) {
        assert!((wide - narrow).abs() <= step, "{wide} {narrow}");
        covered += usize::from(*wide > 0.0);
    }
    assert!(covered > 200, "{covered}");
    let dark = narrow_seen.iter().filter(|seen| **seen == 0.0).count();
    assert!(dark > 20, "{dark}");
    for (wide, narrow) in wide_seen.iter().zip(narrow_seen) {
        assert!((wide - narrow).abs() < 1e-5, "{wide} {narrow}");
    }
    let allocated = found[0].0.bytes_held;
    assert_eq!(narrow.bytes_held * 2, allocated);
    let gaps = [wide, narrow].map(|report| report.views[0].max_peter_panning_world);
    let wanted = 2.0 * narrow.views[0].depth_range_world * step;
    assert!((gaps[1] - gaps[0] - wanted).abs() <= 4.0 * f32::EPSILON * gaps[1]);
}

/// A caster without a pipeline for the map's format is an error that names it; nothing is recorded,
/// and the next valid frame is drawn. Casters that the view does not need are not checked.
#[test]
fn casters_of_another_format_are_refused() {
    let gpu = gpu();
    let wide = pipeline(gpu, &[DepthFormat::Float32]).expect("one format");
    let narrow = pipeline(gpu, &[DepthFormat::Unorm16]).expect("one format");
    assert!(wide.wgpu_pipeline(DepthFormat::Unorm16).is_none());
    let cube = |at: f32, pipeline| {
        let low = Vec3::new(at, 1.0, 0.0);
        Mesh::cuboid(low, low + 1.0).caster(gpu, pipeline, Mat4::IDENTITY)
    };
    let (good, bad, bad_but_far) = (cube(-1.0, &narrow), cube(1.0, &wide), cube(900.0, &wide));
    let mut shadow = sun(gpu, DepthFormat::Unorm16);
    let casters: [&dyn ShadowCaster; 2] = [&good, &bad];
    let mut encoder = gpu.encoder();
    let refused = shadow.record_frame(&mut encoder, &frame(&casters));
    assert_eq!(
        refused.expect_err("a caster of another format"),
        ShadowError::CasterFormat {
            field: "ShadowFrameDescriptor::casters",
            index: 1,
            format: DepthFormat::Unorm16,
        }
    );
    gpu.submit(encoder);
    let casters: [&dyn ShadowCaster; 2] = [&good, &bad_but_far];
    assert_eq!(record(gpu, &mut shadow, &frame(&casters)).draws(), 1);
}

#[test]
fn a_pipeline_for_no_format_is_refused() {
    let refused = pipeline(gpu(), &[]).expect_err("no format");
    assert_eq!(refused, CasterError::NoDepthFormat);
}
