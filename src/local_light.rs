//! What spot and point lights share: the fit of their perspective views, and the frame's path to the maps.

use glam::DVec3;

use crate::cast::{ShadowCaster, ViewDraws};
use crate::check;
use crate::fit::{CameraFrustum, LightAxes, LocalFit, LocalInput, MAX_LOCAL_VIEWS};
use crate::light_maps::{LightMaps, MapsFrame};
use crate::{Aabb, CameraView, ShadowError, ShadowReport, ShadowView};

/// Per-frame state of a local light's views.
#[derive(Debug, Default)]
pub(crate) struct LocalViews {
    fit: LocalFit,
    bounds: Vec<Aabb>,
}

/// A frame of a local light, checked but for casters, receivers and camera.
pub(crate) struct LocalFrame<'a> {
    pub origin: DVec3,
    pub position_world: DVec3,
    pub range: f32,
    pub views: &'a [LightAxes],
    /// Tangent of half the angle of a view, without border.
    pub tangent: f64,
    pub cone_cosine: f64,
    pub camera: Option<&'a CameraView>,
    pub casters: &'a [&'a dyn ShadowCaster],
    pub receivers: &'a [Aabb],
    pub fields: &'static LocalFields,
}

/// Paths of a light's fields, for its errors.
pub(crate) struct LocalFields {
    pub origin: &'static str,
    pub position: &'static str,
    pub range: &'static str,
    pub camera: [&'static str; 3],
    pub casters: &'static str,
    pub receivers: &'static str,
}

impl LocalViews {
    /// Fits, culls, uploads and records into `maps`.
    pub fn record<'m>(
        &mut self,
        maps: &'m mut LightMaps,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        frame: &LocalFrame<'_>,
    ) -> Result<&'m ShadowReport, ShadowError> {
        let fields = frame.fields;
        check::finite_vector(fields.origin, frame.origin)?;
        check::finite_vector(fields.position, frame.position_world)?;
        check::in_range(
            fields.range,
            "above 0 (infinity allowed)",
            frame.range > 0.0,
            frame.range,
        )?;
        let [view_field, clip_field, distance_field] = fields.camera;
        let camera = frame
            .camera
            .map(|camera| camera.frustum(view_field, clip_field, distance_field))
            .transpose()?;
        let viewer_render = camera.as_ref().map(CameraFrustum::eye_render);
        check::caster_bounds(fields.casters, frame.casters, &mut self.bounds)?;
        check::receiver_bounds(fields.receivers, frame.receivers)?;

        let margin_texels = maps.sampling().margin_texels();
        let input = LocalInput {
            origin: frame.origin,
            position_world: frame.position_world,
            range: f64::from(frame.range),
            views: frame.views,
            receiver_tangent: frame.tangent,
            caster_tangent: frame.tangent
                * border(maps.map_size(), maps.sampling().border_texels()),
            camera,
            casters: &self.bounds,
            receivers: frame.receivers,
            map_size: maps.map_size(),
            margin_texels,
        };
        let mut drawn: [Vec<u32>; MAX_LOCAL_VIEWS] = std::array::from_fn(|_| maps.spare_list());
        let fit = self.fit.fit(&input, &mut drawn);
        let mut views = Vec::with_capacity(frame.views.len());
        for ((layer, axes), casters) in (0u32..).zip(frame.views).zip(drawn) {
            if let Some(window) = &fit.windows[layer as usize] {
                let view = ShadowView::perspective(
                    axes,
                    frame.position_world,
                    window,
                    &fit,
                    frame.cone_cosine,
                    frame.origin,
                    layer,
                );
                views.push(ViewDraws {
                    view: view.checked()?,
                    casters,
                    drawn: false,
                });
            }
        }
        let anchor_render = (frame.position_world - frame.origin).as_vec3();
        let maps_frame = MapsFrame {
            views,
            anchor_render,
            reach_world: fit.reach,
            viewer_render,
            casters: frame.casters,
        };
        let report = maps.record(device, encoder, maps_frame)?;
        self.fit = fit;
        Ok(report)
    }
}

/// How much wider than its receivers a view of `map_size` texels is rendered, so that no kernel leaves it: tan(fov/2) grows by
/// N / (N - 2 border). A map smaller than its borders keeps its middle half.
fn border(map_size: u32, border_texels: f64) -> f64 {
    let size = f64::from(map_size);
    size / (size - 2.0 * border_texels.min(size * 0.25))
}
