//! Defines what is compared: anything that fills maps and provides
//! `shadow_light(position, normal)`.

use glam::{DMat4, DVec2, DVec3, Vec3};
use wgpu_shadows::{ShadowError, ShadowView};

use crate::gpu::Gpu;

/// Is the name of the light in every technique's WGSL.
pub const LIGHT_NAME: &str = "light";

/// Is a way of making shadows for one light of one scene.
pub trait Technique {
    /// Records the passes that fill the maps, all of them again.
    fn record(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder) -> Result<(), ShadowError>;

    /// Returns WGSL with `shadow_light(position: vec3<f32>, normal: vec3<f32>) -> f32` and what it
    /// reads, in group 1.
    fn lookup(&self) -> Lookup<'_>;

    /// Returns what the map's texels cover.
    fn footprint(&self) -> Footprint;

    /// Returns what the last recording took, and what a lookup takes.
    fn cost(&self) -> Cost;

    /// Returns the number of texels to either side of an edge within which errors count as the
    /// edge's own.
    fn band_texels(&self) -> f64;

    /// Returns by how many world units the band is wider, for filters whose width is given in them.
    fn band_world(&self) -> f64 {
        0.0
    }

    /// Returns whether positions are absolute world coordinates, instead of render space.
    fn takes_world_positions(&self) -> bool;
}

/// Describes how a shader samples the technique.
pub struct Lookup<'a> {
    pub wgsl: &'a str,
    pub layout: &'a wgpu::BindGroupLayout,
    pub bind_group: &'a wgpu::BindGroup,
}

/// Holds counts that are the same on every machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cost {
    pub texels_allocated: u64,
    pub texels_cleared: u64,
    pub draws: u32,
    pub passes: u32,
    pub bytes: u64,
    /// Is the number of SIMD cycles of the lookup per shaded pixel, on the chip of
    /// [`lookup_cost`](crate::lookup_cost).
    pub lookup_cycles: f64,
    /// Is the number per shaded pixel.
    pub texels_touched: u32,
}

impl Cost {
    /// Returns the one number that orders techniques: the work of a frame of 1920×1080 shaded
    /// pixels, which is the texels of the maps cleared once and the cycles of every pixel's lookup.
    pub fn frame_work(&self) -> f64 {
        const PIXELS: f64 = 1920.0 * 1080.0;
        self.texels_cleared as f64 + PIXELS * self.lookup_cycles
    }
}

/// Holds the views of a technique's maps, for the size of their texels.
#[derive(Clone, Debug, Default)]
pub struct Footprint {
    views: Vec<FootprintView>,
}

#[derive(Clone, Copy, Debug)]
struct FootprintView {
    clip_from_anchor: DMat4,
    anchor_render: DVec3,
    /// Counts the texels along x and y.
    size_texels: DVec2,
}

impl Footprint {
    pub fn of_views<'a>(views: impl Iterator<Item = &'a ShadowView>) -> Self {
        let views = views
            .map(|view| FootprintView {
                clip_from_anchor: view.clip_from_anchor().as_dmat4(),
                anchor_render: view.anchor_render().as_dvec3(),
                size_texels: view.texels().size.as_dvec2(),
            })
            .collect();
        Self { views }
    }

    pub fn of_matrices(clip_from_render: impl IntoIterator<Item = DMat4>, map_size: u32) -> Self {
        let views = clip_from_render
            .into_iter()
            .map(|clip_from_anchor| FootprintView {
                clip_from_anchor,
                anchor_render: DVec3::ZERO,
                size_texels: DVec2::splat(f64::from(map_size)),
            })
            .collect();
        Self { views }
    }

    /// Returns the world size of a texel across the light's rays, at a position; that of the first
    /// view that covers it.
    pub fn texel_world(&self, place: DVec3) -> Option<f64> {
        self.views.iter().find_map(|view| view.texel_world(place))
    }
}

impl FootprintView {
    fn texel_world(&self, place: DVec3) -> Option<f64> {
        let clip = self.clip_from_anchor * (place - self.anchor_render).extend(1.0);
        if clip.w <= 0.0 || clip.x.abs() > clip.w || clip.y.abs() > clip.w {
            return None;
        }
        let rows = [0, 1, 3].map(|row| self.clip_from_anchor.row(row).truncate());
        let axis = rows[2].normalize_or_zero();
        let scale = |row: DVec3| (row - axis * row.dot(axis)).length();
        let texels = self.size_texels * DVec2::new(scale(rows[0]), scale(rows[1]));
        Some(2.0 * clip.w / texels.min_element())
    }
}

/// Returns the position at which a technique is sampled, in the coordinates that it takes.
pub fn asked_position(position: DVec3, origin: DVec3, in_world: bool) -> Vec3 {
    if in_world {
        (position + origin).as_vec3()
    } else {
        position.as_vec3()
    }
}
