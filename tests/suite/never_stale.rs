//! Compares maps that are kept, wholly or in part, with maps that are drawn completely: the bits
//! are the same, over thousands of random frames. The tests run on Vulkan alone: on wgpu's OpenGL
//! backend, which copies no depth textures, layers of their own have no static-caster caches, and
//! reading maps back is slow.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CascadeLayout, CasterPipeline, DepthFormat, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, MeshCaster, OmniLight, OmniShadow, OmniShadowDescriptor,
    ShadowCaster, ShadowView, caster::CasterPipelineDescriptor, report::ShadowReport,
    report::ViewReport, report::ViewStatus,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame, OmniFrame, RecordFrame};
use crate::fixtures::gpu::{Gpu, vulkan};
use crate::fixtures::multiview::{device, is_right};
use crate::fixtures::texture_bytes::TextureBytes;

/// Holds boxes of which some move, all move, or none does, for some frames each; some appear and
/// disappear.
struct Crowd {
    casters: Vec<MeshCaster>,
    shown: Vec<bool>,
    movers: usize,
    random: Random,
}

impl Crowd {
    fn new(gpu: &Gpu, pipeline: &CasterPipeline, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let casters: Vec<_> = (0..24)
            .map(|_| {
                let low = random.point(DVec3::new(-8.0, 0.0, -8.0), DVec3::new(7.0, 3.0, 7.0));
                let high = low + random.point(DVec3::splat(0.3), DVec3::splat(1.7));
                Mesh::cuboid(low.as_vec3(), high.as_vec3()).caster(gpu, pipeline, Mat4::IDENTITY)
            })
            .collect();
        Self {
            shown: vec![true; casters.len()],
            casters,
            movers: 1,
            random,
        }
    }

    fn step(&mut self) {
        if self.random.unit() < 0.04 {
            self.movers = [0, 1, 1, 2, self.casters.len()][self.random.index(5)];
        }
        for index in 0..self.movers {
            let shift = self.random.point(DVec3::splat(-2.0), DVec3::splat(2.0));
            self.casters[index]
                .set_transform(Mat4::from_translation(shift.as_vec3()))
                .expect("a finite matrix");
        }
        if self.random.unit() < 0.03 {
            let index = self.random.index(self.casters.len());
            self.shown[index] = !self.shown[index];
        }
        if self.random.unit() < 0.01 {
            let (a, b) = (self.random.index(24), self.random.index(24));
            self.casters.swap(a, b);
        }
    }

    fn list(&self) -> Vec<&dyn ShadowCaster> {
        let shown = self.casters.iter().zip(&self.shown);
        shown
            .filter_map(|(caster, shown)| shown.then_some(caster as &dyn ShadowCaster))
            .collect()
    }
}

/// Is a mesh that does not report its triangles: it is never copied from a static-caster cache, nor
/// drawn into six faces at once.
struct Untold<'a>(&'a dyn ShadowCaster);

impl ShadowCaster for Untold<'_> {
    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.0.pipeline()
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
        self.0.draw(pass, view);
    }
}

/// Counts how often a layer was filled in each way.
#[derive(Debug, Default)]
struct Ways {
    kept: u32,
    drawn: u32,
    copied: u32,
    /// Counts the frames in which faces were drawn in one pass.
    one_pass: u32,
}

impl Ways {
    fn count(&mut self, report: &ShadowReport) {
        let drawn = |view: &&ViewReport| view.status == ViewStatus::Drawn;
        let drawn = report.views.iter().filter(drawn).count();
        self.one_pass += u32::from(report.passes == 1 && drawn > 1);
        for view in &report.views {
            match view.status {
                ViewStatus::Kept => self.kept += 1,
                ViewStatus::Drawn if view.copied > 0 => self.copied += 1,
                ViewStatus::Drawn => self.drawn += 1,
                _ => {}
            }
        }
    }

    fn assert_all_taken(&self, least: u32) {
        let Self {
            kept,
            drawn,
            copied,
            ..
        } = *self;
        assert!(kept.min(drawn).min(copied) >= least, "{self:?}");
    }
}

/// Records a frame of both lights, so that they have the same history, into an encoder that is
/// dropped.
fn throw_away<F, L: RecordFrame<F>>(gpu: &Gpu, lights: [&mut L; 2], frame: &F) {
    let mut thrown_away = gpu.encoder();
    for light in lights {
        let report = light.record_frame(&mut thrown_away, frame);
        report.expect("a valid frame");
    }
}

/// The camera and the light are still most of the time and sometimes jump; sometimes an encoder is
/// dropped.
#[test]
fn kept_maps_of_a_sun_are_what_would_be_drawn() {
    const AUTOMATIC: CascadeLayout<'_> = CascadeLayout::Automatic { max_cascades: 2 };
    for (format, layout, frames) in [
        (DepthFormat::Float32, CascadeLayout::fixed(2), 1500),
        (DepthFormat::Unorm16, CascadeLayout::fixed(2), 500),
        (DepthFormat::Float32, AUTOMATIC, 600),
        (DepthFormat::Unorm16, AUTOMATIC, 300),
    ] {
        let gpu = vulkan();
        let pipeline = CasterPipeline::new(
            &gpu.device,
            &CasterPipelineDescriptor {
                depth_formats: &[format],
                ..Default::default()
            },
        )
        .expect("a valid pipeline");
        let mut crowd = Crowd::new(gpu, &pipeline, 5);
        let descriptor = DirectionalShadowDescriptor {
            // A smaller map is not divided.
            map_size: match layout {
                CascadeLayout::Fixed { .. } => 128,
                _ => 256,
            },
            layout,
            depth_format: format,
            ..Default::default()
        };
        let sun = || DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
        let (mut kept, mut fresh) = (sun(), sun());
        let [kept_bytes, fresh_bytes] =
            [&kept, &fresh].map(|sun| TextureBytes::new(gpu, sun.maps().texture()));
        let mut random = Random::new(91);
        let mut camera = Camera::modern(DVec3::new(0.0, 6.0, 14.0), DVec3::ZERO, 1.0, 1.5);
        let mut light = Vec3::new(0.4, -1.0, 0.3);
        let mut ways = Ways::default();
        let mut divided = false;
        for frame_index in 0..frames {
            crowd.step();
            if random.unit() < 0.02 {
                let eye = random.point(DVec3::new(-9.0, 3.0, 9.0), DVec3::new(9.0, 9.0, 15.0));
                camera = Camera::modern(eye, DVec3::ZERO, 1.0, 1.5);
            }
            if random.unit() < 0.005 {
                light.x = random.range(-1.0, 1.0) as f32;
            }
            let list = crowd.list();
            let frame = DirectionalFrame {
                origin: DVec3::ZERO,
                light: DirectionalLight::new(light),
                coverage: Coverage::Camera(camera.view()),
                casters: &list,
                receivers: &[],
            };
            if random.unit() < 0.02 {
                throw_away(gpu, [&mut kept, &mut fresh], &frame);
                kept.invalidate();
            }
            let mut encoder = gpu.encoder();
            let report = kept.record_frame(&mut encoder, &frame);
            ways.count(report.expect("a valid frame"));
            fresh.invalidate();
            let report = fresh.record_frame(&mut encoder, &frame);
            let report = report.expect("a valid frame").clone();
            kept_bytes.copy(&mut encoder);
            fresh_bytes.copy(&mut encoder);
            gpu.submit(encoder);
            let (now, wanted) = (kept_bytes.read(gpu), fresh_bytes.read(gpu));
            kept_bytes.assert_same_views(&report, [&now, &wanted], || {
                format!("{format:?}, {layout:?}, frame {frame_index}: {ways:?}")
            });
            let drawn = |view: &&ViewReport| view.status == ViewStatus::Drawn;
            let mut drawn = report.views.iter().filter(drawn);
            divided |= drawn.any(|view| view.texels.size.x < descriptor.map_size);
        }
        ways.assert_all_taken(frames / 20);
        assert_eq!(divided, layout == AUTOMATIC);
    }
}

/// The same holds for the six faces of a point light that sometimes jumps: drawn in one pass or in
/// a pass each, whichever is cheaper, they equal those of a pass each.
#[test]
fn kept_faces_of_a_lamp_are_what_would_be_drawn() {
    let gpu = device();
    let pipeline = CasterPipeline::new(&gpu.device, &CasterPipelineDescriptor::new())
        .expect("a valid pipeline");
    let mut crowd = Crowd::new(gpu, &pipeline, 6);
    let descriptor = OmniShadowDescriptor {
        map_size: 64,
        ..Default::default()
    };
    let lamp = || OmniShadow::new(&gpu.device, &descriptor).expect("a valid lamp");
    let (mut kept, mut fresh) = (lamp(), lamp());
    let [kept_bytes, fresh_bytes] =
        [&kept, &fresh].map(|lamp| TextureBytes::new(gpu, lamp.maps().texture()));
    let mut random = Random::new(92);
    let mut position_world = DVec3::new(0.3, 1.7, -0.4);
    let mut ways = Ways::default();
    for frame_index in 0..500 {
        crowd.step();
        if random.unit() < 0.02 {
            position_world = random.point(DVec3::splat(-4.0), DVec3::splat(4.0));
        }
        let list = crowd.list();
        let frame = OmniFrame {
            origin: DVec3::ZERO,
            light: OmniLight {
                position_world,
                range: 15.0,
            },
            camera: None,
            casters: &list,
            receivers: &[],
        };
        if random.unit() < 0.02 {
            throw_away(gpu, [&mut kept, &mut fresh], &frame);
            kept.invalidate();
        }
        let mut encoder = gpu.encoder();
        let report = kept.record_frame(&mut encoder, &frame);
        ways.count(report.expect("a valid frame"));
        fresh.invalidate();
        let untold: Vec<_> = list.iter().map(|caster| Untold(*caster)).collect();
        let untold: Vec<&dyn ShadowCaster> = untold.iter().map(|caster| caster as _).collect();
        let frame = OmniFrame {
            casters: &untold,
            ..frame
        };
        let report = fresh.record_frame(&mut encoder, &frame);
        let report = report.expect("a valid frame").clone();
        let drawn = |view: &&ViewReport| view.status == ViewStatus::Drawn;
        let drawn = report.views.iter().filter(drawn).count() as u32;
        assert_eq!(report.passes, drawn, "a pass each");
        kept_bytes.copy(&mut encoder);
        fresh_bytes.copy(&mut encoder);
        gpu.submit(encoder);
        let (now, wanted) = (kept_bytes.read(gpu), fresh_bytes.read(gpu));
        kept_bytes.assert_same_views(&report, [&now, &wanted], || {
            format!("frame {frame_index}: {ways:?}")
        });
    }
    ways.assert_all_taken(25);
    assert_eq!(ways.one_pass >= 25, is_right(), "{ways:?}");
}
