//! Defines bind group 0 of a depth pass: the view being rendered, as a caster's vertex stage reads
//! it.

use bytemuck::{Pod, Zeroable};

use crate::ShadowView;
use crate::gpu::FACE_COUNT;

/// Mirrors `ShadowCasterView` in `wgsl/caster.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct CasterViewUniform {
    pub clip_from_anchor: [[f32; 4]; 4],
    pub anchor_render: [f32; 3],
    pub map_size: f32,
}

pub(crate) const VIEW_UNIFORM_BYTES: u64 = size_of::<CasterViewUniform>() as u64;

impl CasterViewUniform {
    pub(super) fn of(view: &ShadowView) -> Self {
        Self {
            clip_from_anchor: view.clip_from_anchor().to_cols_array_2d(),
            anchor_render: view.anchor_render().to_array(),
            map_size: view.texels().size.max_element() as f32,
        }
    }
}

/// Returns the layout of bind group 0: the view being rendered, chosen by a dynamic offset.
pub(crate) fn view_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    uniform_layout(device, "shadow caster view", VIEW_UNIFORM_BYTES, true)
}

/// Returns the layout of bind group 0 where six faces are rendered at once.
pub(crate) fn multiview_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let bytes = VIEW_UNIFORM_BYTES * u64::from(FACE_COUNT);
    uniform_layout(device, "shadow caster faces", bytes, false)
}

fn uniform_layout(
    device: &wgpu::Device,
    label: &str,
    bytes: u64,
    has_dynamic_offset: bool,
) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset,
                min_binding_size: wgpu::BufferSize::new(bytes),
            },
            count: None,
        }],
    })
}
