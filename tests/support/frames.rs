//! Provides frames of one light each, with a scene of their own: what most tests need of a frame, in one value.

use glam::DVec3;
use wgpu_shadows::{
    Aabb, CameraView, DirectionalLight, DirectionalShadow, OmniLight, OmniShadow, ShadowCaster,
    ShadowError, ShadowFrameDescriptor, ShadowScene, SpotLight, SpotShadow, pool::OmniShadowPool,
    pool::PoolLight, pool::SpotShadowPool, report::ShadowReport,
};

/// Selects what the maps of a directional light cover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coverage {
    Bounds(Aabb),
    Camera(CameraView),
}

/// Is a frame of a directional light.
#[derive(Clone, Copy)]
pub struct DirectionalFrame<'a> {
    pub origin: DVec3,
    pub light: DirectionalLight,
    pub coverage: Coverage,
    pub casters: &'a [&'a dyn ShadowCaster],
    pub receivers: &'a [Aabb],
}

/// Is a frame of a spot light; without a camera, everything counts.
#[derive(Clone, Copy)]
pub struct SpotFrame<'a> {
    pub origin: DVec3,
    pub light: SpotLight,
    pub camera: Option<CameraView>,
    pub casters: &'a [&'a dyn ShadowCaster],
    pub receivers: &'a [Aabb],
}

/// Is a frame of a point light; without a camera, everything counts.
#[derive(Clone, Copy)]
pub struct OmniFrame<'a> {
    pub origin: DVec3,
    pub light: OmniLight,
    pub camera: Option<CameraView>,
    pub casters: &'a [&'a dyn ShadowCaster],
    pub receivers: &'a [Aabb],
}

/// Is a frame of a pool; without a camera, everything counts.
#[derive(Clone, Copy)]
pub struct PoolFrame<'a, L> {
    pub origin: DVec3,
    pub lights: &'a [PoolLight<L>],
    pub camera: Option<CameraView>,
    pub casters: &'a [&'a dyn ShadowCaster],
    pub receivers: &'a [Aabb],
    pub max_views: Option<u32>,
}

/// Is a light that records frames of its own kind.
pub trait RecordFrame<F> {
    fn record_frame(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &F,
    ) -> Result<&ShadowReport, ShadowError>;
}

impl RecordFrame<DirectionalFrame<'_>> for DirectionalShadow {
    fn record_frame(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &DirectionalFrame<'_>,
    ) -> Result<&ShadowReport, ShadowError> {
        let cameras;
        let coverage = match frame.coverage {
            Coverage::Bounds(bounds) => wgpu_shadows::Coverage::Bounds(bounds),
            Coverage::Camera(camera) => {
                cameras = [camera];
                wgpu_shadows::Coverage::Cameras(&cameras)
            }
        };
        let mut scene = ShadowScene::new();
        let checked = scene.frame(&ShadowFrameDescriptor {
            origin: frame.origin,
            coverage,
            casters: frame.casters,
            receivers: frame.receivers,
        })?;
        self.record(encoder, &checked, &frame.light)
    }
}

/// Implements the trait for a kind of local light. The four kinds differ in what `record` takes.
macro_rules! record_local {
    ($light:ty, $frame:ty, |$self:ident, $encoder:ident, $checked:ident, $given:ident| $record:expr) => {
        impl RecordFrame<$frame> for $light {
            fn record_frame(
                &mut $self,
                $encoder: &mut wgpu::CommandEncoder,
                $given: &$frame,
            ) -> Result<&ShadowReport, ShadowError> {
                let cameras;
                let coverage = match $given.camera {
                    None => wgpu_shadows::Coverage::Everything,
                    Some(camera) => {
                        cameras = [camera];
                        wgpu_shadows::Coverage::Cameras(&cameras)
                    }
                };
                let mut scene = ShadowScene::new();
                let $checked = scene.frame(&ShadowFrameDescriptor {
                    origin: $given.origin,
                    coverage,
                    casters: $given.casters,
                    receivers: $given.receivers,
                })?;
                $record
            }
        }
    };
}

record_local!(
    SpotShadow,
    SpotFrame<'_>,
    |self, encoder, checked, frame| self.record(encoder, &checked, &frame.light)
);
record_local!(
    OmniShadow,
    OmniFrame<'_>,
    |self, encoder, checked, frame| self.record(encoder, &checked, &frame.light)
);
record_local!(
    SpotShadowPool,
    PoolFrame<'_, SpotLight>,
    |self, encoder, checked, frame| {
        self.record(encoder, &checked, frame.lights, frame.max_views)
    }
);
record_local!(
    OmniShadowPool,
    PoolFrame<'_, OmniLight>,
    |self, encoder, checked, frame| {
        self.record(encoder, &checked, frame.lights, frame.max_views)
    }
);
