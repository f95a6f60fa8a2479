//! Defines bind group 0 of a depth pass: the view being rendered, as a caster's vertex stage reads
//! it.

use bytemuck::{Pod, Zeroable};

use crate::error::DeviceError;
use crate::gpu::{FACE_COUNT, Upload, UploadBuffer, capture_device_errors};
use crate::{ShadowError, ShadowView};

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

/// Holds the uniforms of several views, of which a dynamic offset chooses the one being rendered.
#[derive(Debug)]
pub(crate) struct ViewUniforms {
    buffer: UploadBuffer,
    /// Holds what the buffer is to hold.
    bytes: Vec<u8>,
    stride: u64,
    bind_group: wgpu::BindGroup,
}

impl ViewUniforms {
    /// Makes the buffer and the bind group for `views` views.
    pub(super) fn new(device: &wgpu::Device, label: &str, views: u32) -> Result<Self, ShadowError> {
        let alignment = u64::from(device.limits().min_uniform_buffer_offset_alignment);
        let stride = VIEW_UNIFORM_BYTES.next_multiple_of(alignment);
        let label = &format!("{label} caster views");
        let buffer = UploadBuffer::new(device, label, stride * u64::from(views))?;
        let create = || {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(label),
                layout: &view_layout(device),
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: buffer.buffer(),
                        offset: 0,
                        size: wgpu::BufferSize::new(VIEW_UNIFORM_BYTES),
                    }),
                }],
            })
        };
        let bind_group = capture_device_errors(device, create).map_err(|refusal| {
            ShadowError::Device(DeviceError {
                object: "the bind group of the casters",
                refusal,
            })
        })?;
        Ok(Self {
            buffer,
            bytes: Vec::new(),
            stride,
            bind_group,
        })
    }

    /// Begins a frame of `views` views.
    pub(super) fn clear(&mut self, views: usize) {
        self.bytes.clear();
        self.bytes.resize(self.stride as usize * views, 0);
    }

    /// Sets the view at an index below the number of the frame's views.
    pub(super) fn set(&mut self, index: u32, view: &ShadowView) {
        let uniform = CasterViewUniform::of(view);
        let start = self.stride as usize * index as usize;
        self.bytes[start..][..size_of_val(&uniform)].copy_from_slice(bytemuck::bytes_of(&uniform));
    }

    /// Returns the upload of the frame, if one is needed.
    pub(super) fn upload(&self) -> Option<Upload<'_>> {
        self.buffer.upload(&self.bytes)
    }

    /// States that the upload has been recorded.
    pub(super) fn set_written(&mut self) {
        self.buffer.set_written(&self.bytes);
    }

    /// Forgets what was uploaded.
    pub(super) fn invalidate(&mut self) {
        self.buffer.invalidate();
    }

    /// Returns the bind group and the dynamic offset of the view at an index.
    pub(super) fn group(&self, index: u32) -> (&wgpu::BindGroup, u32) {
        (&self.bind_group, (self.stride * u64::from(index)) as u32)
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
