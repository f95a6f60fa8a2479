//! Uploads the matrices of the instances that a frame draws, in the order of its draw calls.

use glam::Mat4;

use crate::cast::instances::append_matrix;
use crate::error::{DeviceError, DeviceRefusal};
use crate::gpu::{Upload, capture_device_errors};
use crate::{ShadowError, cast::mesh_geometry::MeshGeometry};

/// Tells where the matrix of an instance lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct InstancePlace {
    /// Is the index of the buffer.
    pub buffer: u32,
    /// Is the index of the instance in it, counted in strides of the pipeline.
    pub instance: u32,
}

/// Holds the matrices of a frame, and the vertex buffers that they are copied to in the order of
/// the engine's commands. One buffer suffices unless the matrices exceed the device's
/// `max_buffer_size`.
#[derive(Debug)]
pub(crate) struct InstanceMatrices {
    label: String,
    /// Is the size that no buffer may exceed.
    most_bytes: u64,
    bytes: Vec<u8>,
    /// Is the start of each buffer's part of `bytes`.
    starts: Vec<usize>,
    buffers: Vec<wgpu::Buffer>,
}

impl InstanceMatrices {
    pub(super) fn new(device: &wgpu::Device, label: &str) -> Self {
        Self {
            label: format!("{label} instances"),
            most_bytes: device.limits().max_buffer_size,
            bytes: Vec::new(),
            starts: Vec::new(),
            buffers: Vec::new(),
        }
    }

    /// Begins a frame.
    pub(super) fn clear(&mut self) {
        self.bytes.clear();
        self.starts.clear();
    }

    /// Adds an instance for the pipeline of `geometry`. Returns `None` where the pipeline reads no
    /// matrix.
    pub(super) fn add(&mut self, geometry: &MeshGeometry, matrix: &Mat4) -> Option<InstancePlace> {
        let layout = geometry.matrix_layout()?;
        let stride = layout.0 as usize;
        let start = self.starts.last().copied().unwrap_or(0);
        let mut offset = (self.bytes.len() - start).next_multiple_of(stride);
        if self.starts.is_empty() || (offset + stride) as u64 > self.most_bytes {
            self.starts.push(self.bytes.len());
            offset = 0;
        } else {
            self.bytes.resize(start + offset, 0);
        }
        append_matrix(&mut self.bytes, layout, matrix);
        Some(InstancePlace {
            buffer: self.starts.len() as u32 - 1,
            instance: (offset / stride) as u32,
        })
    }

    /// Makes the buffers large enough for the matrices of the frame. Buffers that are replaced stay
    /// alive in the commands that were recorded with them.
    pub(super) fn prepare(&mut self, device: &wgpu::Device) -> Result<(), ShadowError> {
        for index in 0..self.starts.len() {
            let needed = self.part(index).len() as u64;
            if self
                .buffers
                .get(index)
                .is_none_or(|buffer| buffer.size() < needed)
            {
                let size = needed.next_power_of_two().min(self.most_bytes).max(needed);
                let buffer = vertex_buffer(device, &self.label, size).map_err(refused)?;
                self.buffers.truncate(index);
                self.buffers.push(buffer);
            }
        }
        Ok(())
    }

    /// Returns the uploads of the frame.
    pub(super) fn uploads(&self) -> impl Iterator<Item = Upload<'_>> {
        let parts = (0..self.starts.len()).map(|index| self.part(index));
        self.buffers.iter().zip(parts)
    }

    /// Returns the matrices in the buffer at `index`.
    fn part(&self, index: usize) -> &[u8] {
        let end = self.starts.get(index + 1).copied();
        &self.bytes[self.starts[index]..end.unwrap_or(self.bytes.len())]
    }

    /// Returns the buffer at the index of an [`InstancePlace`].
    pub(super) fn buffer(&self, index: u32) -> &wgpu::Buffer {
        &self.buffers[index as usize]
    }
}

fn vertex_buffer(
    device: &wgpu::Device,
    label: &str,
    size: u64,
) -> Result<wgpu::Buffer, DeviceRefusal> {
    capture_device_errors(device, || {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    })
}

fn refused(refusal: DeviceRefusal) -> ShadowError {
    ShadowError::Device(DeviceError {
        object: "the matrices of instances",
        refusal,
    })
}
