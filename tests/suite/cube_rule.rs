//! Tests when the six faces of a point light are drawn in one pass, and what the report says about
//! it.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use wgpu_shadows::{
    CasterPipeline, OmniLight, OmniShadow, OmniShadowDescriptor, caster::CasterPipelineDescriptor,
    caster::CasterVertex, report::ViewStatus,
};

use crate::fixtures::cube_pair::{LIGHT, Pair, Stage, furnished, room};
use crate::fixtures::frames::{OmniFrame, RecordFrame};
use crate::fixtures::gpu::Gpu;
use crate::fixtures::multiview::{device, is_right};
use crate::fixtures::scene::default_pipeline;

#[test]
fn the_report_tells_of_one_pass() {
    if !is_right() {
        // On such a driver the other tests assert that each face takes a pass.
        assert_eq!(Stage::new(device(), &furnished()).record(LIGHT).passes, 6);
        return;
    }
    let mut pair = Pair::new(&furnished());
    let [one, six] = pair.record_in_one_pass("furnished", LIGHT);
    // Seven casters are drawn once each, with the one triangle that each reports, into all six
    // faces.
    assert_eq!((one.passes, one.draws(), one.triangles()), (1, 7, 42));
    assert_eq!(six.passes, 6);
    assert!(six.draws() > 7 && six.triangles() < 42, "{six:?}");
    for report in [&one, &six] {
        let drawn = |status| status == ViewStatus::Drawn;
        assert!(report.views.iter().all(|view| drawn(view.status)));
    }
    for view in &one.views {
        assert_eq!((view.casters, view.culled, view.triangles), (7, 0, 7));
    }
}

/// The rule that `OmniShadow` states is tested at its border: 4000 triangles per saved pass, 96 per
/// saved draw call.
#[test]
fn the_rule_is_the_one_that_is_stated() {
    let mut pair = Pair::new(&furnished());
    let [_, six] = pair.record("one triangle each", LIGHT);
    let draws_saved = six.draws() - 7;
    assert!(draws_saved > 0);
    let worth = 4000 * 5 + 96 * draws_saved;
    // Six casters report one triangle each, and the room the rest; each triangle counts for six
    // faces.
    for (room, passes) in [(worth.div_ceil(6) - 7, 1), (worth.div_ceil(6) - 6, 6)] {
        pair.each(|stage| {
            stage.casters[0].triangles = room;
            stage.shadow.invalidate();
        });
        let [one, _] = pair.record("at the border", LIGHT);
        let wanted = if is_right() { passes } else { 6 };
        assert_eq!(one.passes, wanted, "{room} triangles");
    }
}

/// Ready-made meshes report everything that the rule needs.
#[test]
fn meshes_are_drawn_in_one_pass_unless_they_are_dense() {
    let lamp = |mesh: Mesh| {
        let gpu = device();
        let pipeline = default_pipeline(gpu);
        let caster = mesh.caster(gpu, &pipeline, Mat4::IDENTITY);
        let mut shadow =
            OmniShadow::new(&gpu.device, &OmniShadowDescriptor::default()).expect("a valid light");
        let mut encoder = gpu.encoder();
        let frame = OmniFrame {
            origin: DVec3::ZERO,
            light: OmniLight {
                position_world: LIGHT,
                range: 60.0,
            },
            camera: None,
            casters: &[&caster],
            receivers: &[],
        };
        let report = shadow
            .record_frame(&mut encoder, &frame)
            .expect("a valid frame");
        report.passes
    };
    assert_eq!(lamp(room()), if is_right() { 1 } else { 6 });
    // Drawing 39 600 triangles into six faces costs more than five passes and five draw calls.
    assert_eq!(lamp(Mesh::sphere(Vec3::ZERO, 5.0, 100)), 6);
}

/// Is a name and a change of the stage.
type Change<'a> = (&'a str, &'a dyn Fn(&mut Stage<'static>));

/// A caster that does not report its triangles, that depends on the view it is drawn into, or that
/// has WGSL of the engine's own, prevents the single pass.
#[test]
fn casters_that_one_pass_cannot_serve_take_a_pass_each() {
    let own_wgsl = |gpu: &Gpu| {
        let positions = wgpu::VertexBufferLayout {
            array_stride: 12,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3],
        };
        let vertex = CasterVertex::Wgsl {
            source: "@vertex fn own(@location(0) at: vec3<f32>) -> @builtin(position) vec4<f32> {
                return shadow_caster_clip(at);
            }",
            vertex_entry: "own",
            fragment_entry: None,
            buffers: &[Some(positions)],
            bind_group_layouts: &[],
        };
        let descriptor = CasterPipelineDescriptor {
            vertex,
            ..Default::default()
        };
        CasterPipeline::new(&gpu.device, &descriptor).expect("a valid pipeline")
    };
    let changes: [Change<'_>; 3] = [
        ("untold triangles", &|stage| stage.casters[3].triangles = 0),
        ("looks at the view", &|stage| {
            stage.casters[3].same_in_every_view = false;
        }),
        ("own WGSL", &|stage| {
            let pipeline = own_wgsl(stage.gpu);
            stage.casters[0].pipeline = Some(pipeline);
        }),
    ];
    for (name, change) in changes {
        let mut pair = Pair::new(&furnished());
        pair.each(change);
        let [one, six] = pair.record(name, LIGHT);
        assert_eq!((one.passes, six.passes), (6, 6), "{name}");
    }
}
