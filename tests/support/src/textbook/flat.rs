//! Implements one depth map for a sun or a spot light.

use glam::{DMat4, DVec3, DVec4};
use wgpu_shadows::ShadowError;

use super::meshes::{ViewUniform, WorldMeshes, depth_pipeline, lookup_types, map_with_sampler};
use crate::bind;
use crate::gpu::Gpu;
use crate::lookup_cost;
use crate::scene::{Light, Scene};
use crate::technique::{Cost, Footprint, Lookup, Technique};

/// Is the nearest distance of a spot light's map in world units, as in the tutorial.
const SPOT_NEAR: f64 = 1.0;

/// Draws the depth pass of one map, and nothing else.
pub struct DepthDrawer {
    pipeline: wgpu::RenderPipeline,
    view: wgpu::Buffer,
    view_group: wgpu::BindGroup,
    target: wgpu::TextureView,
    sampler: wgpu::Sampler,
}

impl DepthDrawer {
    pub fn new(gpu: &Gpu, uniform: &ViewUniform, map_size: u32) -> Self {
        let view = gpu.buffer(&[*uniform], wgpu::BufferUsages::UNIFORM);
        let (pipeline, view_layout) = depth_pipeline(gpu, include_str!("flat_depth.wgsl"), None);
        let (texture, sampler) = map_with_sampler(gpu, map_size, 1);
        Self {
            pipeline,
            view_group: bind::group(gpu, &view_layout, &[view.as_entire_binding()]),
            view,
            target: texture.create_view(&Default::default()),
            sampler,
        }
    }

    pub fn draw(&self, encoder: &mut wgpu::CommandEncoder, meshes: &WorldMeshes) {
        meshes.draw(encoder, &self.pipeline, &self.view_group, &self.target);
    }
}

/// Implements the chapter "Shadow Mapping".
pub struct FlatTechnique<'a> {
    meshes: &'a WorldMeshes,
    map_size: u32,
    clip_from_render: DMat4,
    drawer: DepthDrawer,
    lookup_layout: wgpu::BindGroupLayout,
    lookup_group: wgpu::BindGroup,
}

impl<'a> FlatTechnique<'a> {
    /// Makes the technique for suns and spot lights.
    pub fn new(gpu: &Gpu, scene: &Scene, meshes: &'a WorldMeshes, map_size: u32) -> Self {
        let (clip_from_render, sun) = match scene.light {
            Light::Sun { direction, .. } => {
                let direction = direction.as_dvec3().normalize();
                (orthographic(scene, direction), -direction)
            }
            Light::Spot {
                position_world,
                direction,
                outer_angle_radians,
                range,
                ..
            } => {
                let position = position_world - scene.origin;
                let angle = f64::from(outer_angle_radians);
                let matrix = perspective(position, direction.as_dvec3(), angle, f64::from(range));
                (matrix, DVec3::ZERO)
            }
            Light::Point { .. } => unreachable!("a point light takes a cube"),
        };
        let light = match scene.light {
            Light::Spot { position_world, .. } => position_world.extend(1.0),
            _ => DVec4::ZERO,
        };
        let clip_from_world = clip_from_render * DMat4::from_translation(-scene.origin);
        let uniform = ViewUniform::new(clip_from_world, light.as_vec4(), sun.as_vec3().extend(0.0));
        let drawer = DepthDrawer::new(gpu, &uniform, map_size);
        let lookup_layout = bind::layout(
            gpu,
            wgpu::ShaderStages::COMPUTE,
            &lookup_types(wgpu::TextureViewDimension::D2),
        );
        Self {
            meshes,
            map_size,
            clip_from_render,
            lookup_group: bind::group(
                gpu,
                &lookup_layout,
                &[
                    drawer.view.as_entire_binding(),
                    wgpu::BindingResource::TextureView(&drawer.target),
                    wgpu::BindingResource::Sampler(&drawer.sampler),
                ],
            ),
            lookup_layout,
            drawer,
        }
    }
}

impl Technique for FlatTechnique<'_> {
    fn record(&mut self, _: &Gpu, encoder: &mut wgpu::CommandEncoder) -> Result<(), ShadowError> {
        self.drawer.draw(encoder, self.meshes);
        Ok(())
    }

    fn lookup(&self) -> Lookup<'_> {
        Lookup {
            wgsl: include_str!("flat.wgsl"),
            layout: &self.lookup_layout,
            bind_group: &self.lookup_group,
        }
    }

    fn footprint(&self) -> Footprint {
        Footprint::of_matrices([self.clip_from_render], self.map_size)
    }

    fn cost(&self) -> Cost {
        let texels = u64::from(self.map_size).pow(2);
        Cost {
            texels_allocated: texels,
            texels_cleared: texels,
            draws: self.meshes.count(),
            passes: 1,
            bytes: 4 * texels,
            lookup_cycles: lookup_cost::textbook_flat(),
            texels_touched: 9,
        }
    }

    fn band_texels(&self) -> f64 {
        2.5
    }

    fn takes_world_positions(&self) -> bool {
        true
    }
}

/// Returns the scene's bounds as seen along `direction`: -1 to 1 across, depth 0 to 1 away from the
/// light.
fn orthographic(scene: &Scene, direction: DVec3) -> DMat4 {
    let light_from_render = looking_along(direction);
    let bounds = scene.bounds();
    let corners = (0..8).map(|corner| {
        let pick = |axis: usize| {
            let side = if corner >> axis & 1 == 1 {
                bounds.max
            } else {
                bounds.min
            };
            f64::from(side[axis])
        };
        light_from_render.transform_point3(DVec3::new(pick(0), pick(1), pick(2)))
    });
    let (min, max) = corners.fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(min, max), corner| (min.min(corner), max.max(corner)),
    );
    // A scene that is flat as seen from the light has no depth.
    let scale = DVec3::new(2.0, 2.0, -1.0) / (max - min).max(DVec3::splat(1e-9));
    // Light space looks along -z, so the nearest corner has the greatest z.
    let from = DVec3::new((min.x + max.x) * 0.5, (min.y + max.y) * 0.5, max.z);
    DMat4::from_scale(scale) * DMat4::from_translation(-from) * light_from_render
}

/// Returns a square view of `2 * outer_angle` with standard depth.
fn perspective(position: DVec3, direction: DVec3, outer_angle: f64, far: f64) -> DMat4 {
    let scale = 1.0 / outer_angle.tan();
    let depth = far / (SPOT_NEAR - far);
    let clip_from_light = DMat4::from_cols(
        DVec4::new(scale, 0.0, 0.0, 0.0),
        DVec4::new(0.0, scale, 0.0, 0.0),
        DVec4::new(0.0, 0.0, depth, -1.0),
        DVec4::new(0.0, 0.0, SPOT_NEAR * depth, 0.0),
    );
    clip_from_light * looking_along(direction) * DMat4::from_translation(-position)
}

/// Returns right-handed axes that look along `direction`, as `lookAt` with +Y up does, and with
/// another up vector where they look along +Y.
fn looking_along(direction: DVec3) -> DMat4 {
    let back = -direction.normalize();
    let right = DVec3::Y.cross(back).try_normalize().unwrap_or(DVec3::X);
    let up = back.cross(right);
    DMat4::from_mat3(glam::DMat3::from_cols(right, up, back).transpose())
}
