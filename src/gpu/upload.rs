//! Defines small uniform buffers that are written in the order of the engine's own commands.

use crate::error::DeviceError;
use crate::gpu::{capture_device_errors, filled_buffer};
use crate::{ShadowError, error::DeviceRefusal};

/// Is a uniform buffer whose writes go through the engine's encoder, so that two frames recorded
/// before one submission each see their own values. Unchanged contents are not written again.
#[derive(Debug)]
pub(crate) struct UploadBuffer {
    buffer: wgpu::Buffer,
    written: Vec<u8>,
}

/// Holds bytes to be copied, made before anything is recorded, so that a device that refuses leaves
/// the encoder untouched.
pub(crate) struct PendingUpload {
    staging: wgpu::Buffer,
    bytes: Vec<u8>,
}

impl UploadBuffer {
    /// Makes a zeroed buffer of `size` bytes.
    pub fn new(device: &wgpu::Device, label: &str, size: u64) -> Result<Self, ShadowError> {
        capture_device_errors(device, || {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        })
        .map(|buffer| Self {
            buffer,
            written: Vec::new(),
        })
        .map_err(refused)
    }

    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Stages `bytes` (at most the buffer's size, a multiple of 4). Returns `None` where the buffer
    /// holds them already or there are none.
    pub fn prepare(
        &self,
        device: &wgpu::Device,
        bytes: &[u8],
    ) -> Result<Option<PendingUpload>, ShadowError> {
        if self.written == bytes || bytes.is_empty() {
            return Ok(None);
        }
        let usage = wgpu::BufferUsages::COPY_SRC;
        let staging = filled_buffer(device, "shadow upload", bytes, usage).map_err(refused)?;
        Ok(Some(PendingUpload {
            staging,
            bytes: bytes.to_owned(),
        }))
    }

    /// Records the copy.
    pub fn commit(&mut self, encoder: &mut wgpu::CommandEncoder, pending: Option<PendingUpload>) {
        if let Some(pending) = pending {
            let size = pending.bytes.len() as u64;
            encoder.copy_buffer_to_buffer(&pending.staging, 0, &self.buffer, 0, size);
            self.written = pending.bytes;
        }
    }

    /// Forgets what was written: the next bytes are copied whatever they are.
    pub fn invalidate(&mut self) {
        self.written.clear();
    }
}

fn refused(refusal: DeviceRefusal) -> ShadowError {
    ShadowError::Device(DeviceError {
        object: "a uniform buffer",
        refusal,
    })
}
