//! Implements a cube map of distances for a point light.

use glam::{DMat4, DVec3, DVec4};
use wgpu_shadows::ShadowError;

use super::meshes::{ViewUniform, WorldMeshes, depth_pipeline, lookup_types, map_with_sampler};
use crate::bind;
use crate::camera;
use crate::gpu::Gpu;
use crate::lookup_cost;
use crate::scene::{Light, Scene};
use crate::technique::{Cost, Footprint, Lookup, Technique};

/// Is the nearest distance of the faces, as in the tutorial.
const NEAR: f64 = 1.0;

/// Selects one of the two filters with which the chapter "Point Shadows" ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CubeFilter {
    /// Is a grid of 4×4×4 offsets, with a bias of 0.05.
    Grid,
    /// Is 20 fixed directions whose spread grows with the distance from the camera, with a bias of
    /// 0.15.
    Star,
}

/// Implements the chapter "Point Shadows".
pub struct CubeTechnique<'a> {
    meshes: &'a WorldMeshes,
    filter: CubeFilter,
    map_size: u32,
    clip_from_render: [DMat4; 6],
    pipeline: wgpu::RenderPipeline,
    faces: Vec<(wgpu::BindGroup, wgpu::TextureView)>,
    lookup_layout: wgpu::BindGroupLayout,
    lookup_group: wgpu::BindGroup,
    wgsl: String,
}

impl<'a> CubeTechnique<'a> {
    /// Makes the technique for point lights.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        meshes: &'a WorldMeshes,
        map_size: u32,
        filter: CubeFilter,
    ) -> Self {
        let Light::Point {
            position_world,
            range,
            ..
        } = scene.light
        else {
            unreachable!("suns and spots take a flat map");
        };
        let light = position_world.extend(f64::from(range)).as_vec4();
        let viewer = camera::eye(&scene.camera).as_dvec3() + scene.origin;
        let viewer = viewer.as_vec3().extend(1.0);
        let faces_from_light = cube_faces(f64::from(range));
        let clip_from_render = faces_from_light
            .map(|face| face * DMat4::from_translation(scene.origin - position_world));
        let (pipeline, view_layout) =
            depth_pipeline(gpu, include_str!("cube_depth.wgsl"), Some("fragment"));
        let (texture, sampler) = map_with_sampler(gpu, map_size, 6);
        let faces = (0..6).map(|face: u32| {
            let from_world =
                clip_from_render[face as usize] * DMat4::from_translation(-scene.origin);
            let uniform = ViewUniform::new(from_world, light, viewer);
            let buffer = gpu.buffer(&[uniform], wgpu::BufferUsages::UNIFORM);
            let target = texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: face,
                array_layer_count: Some(1),
                ..Default::default()
            });
            let group = bind::group(gpu, &view_layout, &[buffer.as_entire_binding()]);
            (group, target)
        });
        let faces = faces.collect();
        let dimension = wgpu::TextureViewDimension::Cube;
        let cube = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(dimension),
            ..Default::default()
        });
        let lookup_layout =
            bind::layout(gpu, wgpu::ShaderStages::COMPUTE, &lookup_types(dimension));
        let uniform = ViewUniform::new(DMat4::IDENTITY, light, viewer);
        let lookup_group = bind::group(
            gpu,
            &lookup_layout,
            &[
                gpu.buffer(&[uniform], wgpu::BufferUsages::UNIFORM)
                    .as_entire_binding(),
                wgpu::BindingResource::TextureView(&cube),
                wgpu::BindingResource::Sampler(&sampler),
            ],
        );
        let function = match filter {
            CubeFilter::Grid => include_str!("cube_grid.wgsl"),
            CubeFilter::Star => include_str!("cube_star.wgsl"),
        };
        Self {
            meshes,
            filter,
            map_size,
            clip_from_render,
            pipeline,
            faces,
            lookup_layout,
            lookup_group,
            wgsl: [include_str!("cube.wgsl"), function].concat(),
        }
    }
}

impl Technique for CubeTechnique<'_> {
    fn record(&mut self, _: &Gpu, encoder: &mut wgpu::CommandEncoder) -> Result<(), ShadowError> {
        for (view, target) in &self.faces {
            self.meshes.draw(encoder, &self.pipeline, view, target);
        }
        Ok(())
    }

    fn lookup(&self) -> Lookup<'_> {
        Lookup {
            wgsl: &self.wgsl,
            layout: &self.lookup_layout,
            bind_group: &self.lookup_group,
        }
    }

    fn footprint(&self) -> Footprint {
        Footprint::of_matrices(self.clip_from_render, self.map_size)
    }

    fn cost(&self) -> Cost {
        let texels = 6 * u64::from(self.map_size).pow(2);
        let samples = match self.filter {
            CubeFilter::Grid => 64,
            CubeFilter::Star => 20,
        };
        Cost {
            texels_allocated: texels,
            texels_cleared: texels,
            draws: 6 * self.meshes.count(),
            passes: 6,
            bytes: 4 * texels,
            lookup_cycles: lookup_cost::textbook_cube(samples),
            texels_touched: samples,
        }
    }

    fn band_texels(&self) -> f64 {
        1.5
    }

    fn band_world(&self) -> f64 {
        // These are the corners of the cube of offsets: 0.1 wide, or 1/25 and up to twice that with
        // the distance from the camera.
        3f64.sqrt()
            * match self.filter {
                CubeFilter::Grid => 0.1,
                CubeFilter::Star => 0.08,
            }
    }

    fn takes_world_positions(&self) -> bool {
        true
    }
}

/// Returns the clip space of the faces +x, -x, +y, -y, +z, -z from coordinates relative to the
/// light, oriented as cube maps are sampled.
fn cube_faces(far: f64) -> [DMat4; 6] {
    [
        (DVec3::NEG_Z, DVec3::Y, DVec3::X),
        (DVec3::Z, DVec3::Y, DVec3::NEG_X),
        (DVec3::X, DVec3::NEG_Z, DVec3::Y),
        (DVec3::X, DVec3::Z, DVec3::NEG_Y),
        (DVec3::X, DVec3::Y, DVec3::Z),
        (DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z),
    ]
    .map(|(right, up, forward)| {
        let depth = far / (far - NEAR);
        let rows = [
            right.extend(0.0),
            up.extend(0.0),
            DVec4::from((forward * depth, -NEAR * depth)),
            forward.extend(0.0),
        ];
        DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
    })
}
