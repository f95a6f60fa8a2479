//! Tests casters that leave the pass in another state than they found it: those after them are
//! drawn as if they had not.

use wgpu_shadows::{
    Aabb, CasterPipeline, DepthFormat, MeshCaster, ShadowCaster, ShadowView,
    caster::CasterPipelineDescriptor,
};

use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::slabs::{assert_same, fresh_map, slab};

/// Lists what a caster may do to the pass before it draws.
#[derive(Clone, Copy, Debug)]
enum Habit {
    Viewport,
    DepthRange,
    Scissor,
    Group,
    Pipeline,
    Bundle,
}

/// Is a mesh that draws and leaves the pass in another state than it found it.
struct Untidy {
    mesh: MeshCaster,
    habit: Habit,
    /// Is the bind group of a view that looks elsewhere.
    group: wgpu::BindGroup,
    bundle: wgpu::RenderBundle,
    other: CasterPipeline,
}

impl ShadowCaster for Untidy {
    fn bounds(&self) -> Aabb {
        self.mesh.bounds()
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.mesh.pipeline()
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
        self.mesh.draw(pass, view);
        let size = view.map_size() as f32;
        match self.habit {
            Habit::Viewport => pass.set_viewport(0.0, 0.0, size / 4.0, size / 4.0, 0.0, 1.0),
            Habit::DepthRange => pass.set_viewport(0.0, 0.0, size, size, 0.25, 0.5),
            Habit::Scissor => pass.set_scissor_rect(0, 0, 3, 3),
            Habit::Group => pass.set_bind_group(0, &self.group, &[0]),
            Habit::Pipeline => {
                let other = self.other.wgpu_pipeline(DepthFormat::Float32);
                pass.set_pipeline(other.expect("a pipeline for 32 bits"));
            }
            Habit::Bundle => pass.execute_bundles([&self.bundle]),
        }
    }
}

/// Returns a bind group like the library's own, with a view that sees nothing.
fn blind_group(gpu: &Gpu) -> wgpu::BindGroup {
    let layout = gpu
        .device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: true,
                    min_binding_size: wgpu::BufferSize::new(80),
                },
                count: None,
            }],
        });
    let buffer = gpu.buffer(&[0.0_f32; 64], wgpu::BufferUsages::UNIFORM);
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &buffer,
                offset: 0,
                size: wgpu::BufferSize::new(80),
            }),
        }],
    })
}

fn empty_bundle(gpu: &Gpu) -> wgpu::RenderBundle {
    let encoder = gpu
        .device
        .create_render_bundle_encoder(&wgpu::RenderBundleEncoderDescriptor {
            label: None,
            color_formats: &[],
            depth_stencil: Some(wgpu::RenderBundleDepthStencil {
                format: wgpu::TextureFormat::Depth32Float,
                depth_read_only: false,
                stencil_read_only: true,
            }),
            sample_count: 1,
            multiview: None,
        });
    encoder.finish(&wgpu::RenderBundleDescriptor { label: None })
}

/// The casters after one that changes the state of the pass are drawn as if it had not.
#[test]
fn casters_find_the_pass_as_it_should_be() {
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    // This pipeline culls the side of the slabs that is seen.
    let other = CasterPipeline::new(
        &gpu.device,
        &CasterPipelineDescriptor {
            primitive: wgpu::PrimitiveState {
                cull_mode: Some(wgpu::Face::Back),
                front_face: wgpu::FrontFace::Cw,
                ..Default::default()
            },
            ..Default::default()
        },
    )
    .expect("a valid pipeline");
    let last = slab(gpu, &pipeline, 2.0);
    let tidy = slab(gpu, &pipeline, -2.0);
    let wanted = fresh_map(gpu, &[&tidy, &last]);
    for habit in [
        Habit::Viewport,
        Habit::DepthRange,
        Habit::Scissor,
        Habit::Group,
        Habit::Pipeline,
        Habit::Bundle,
    ] {
        let untidy = Untidy {
            mesh: slab(gpu, &pipeline, -2.0),
            habit,
            group: blind_group(gpu),
            bundle: empty_bundle(gpu),
            other: other.clone(),
        };
        let map = fresh_map(gpu, &[&untidy, &last]);
        assert_same(&map, &wanted, &format!("{habit:?}"));
    }
}
