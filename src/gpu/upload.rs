//! Writes buffers in the order of the engine's own commands.

use crate::ShadowError;
use crate::error::{DeviceError, DeviceRefusal};
use crate::gpu::{capture_device_errors, filled_buffer_of};

/// Is a uniform buffer whose writes go through the engine's encoder, so that two frames recorded
/// before one submission each see their own values. Unchanged contents are not written again.
#[derive(Debug)]
pub(crate) struct UploadBuffer {
    buffer: wgpu::Buffer,
    written: Vec<u8>,
}

/// Is a buffer with the bytes to be copied to its start: a multiple of 4, not empty.
pub(crate) type Upload<'a> = (&'a wgpu::Buffer, &'a [u8]);

/// Holds the bytes of uploads on the device, made before anything is recorded, so that a device
/// that refuses leaves the encoder untouched.
#[derive(Debug)]
pub(crate) struct StagedUploads {
    /// Is a single one unless the bytes of all uploads exceed the device's `max_buffer_size`.
    buffers: Vec<wgpu::Buffer>,
    most_bytes: u64,
}

impl UploadBuffer {
    /// Makes a zeroed buffer of `size` bytes.
    pub(crate) fn new(device: &wgpu::Device, label: &str, size: u64) -> Result<Self, ShadowError> {
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
        .map_err(|refusal| refused("a uniform buffer", refusal))
    }

    pub(crate) fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Returns the upload of `bytes` (at most the buffer's size). Returns `None` where the buffer
    /// holds them already or there are none.
    pub(crate) fn upload<'a>(&'a self, bytes: &'a [u8]) -> Option<Upload<'a>> {
        (self.written != bytes && !bytes.is_empty()).then_some((&self.buffer, bytes))
    }

    /// States that the upload of `bytes`, if there was one, has been recorded.
    pub(crate) fn set_written(&mut self, bytes: &[u8]) {
        if !bytes.is_empty() {
            self.written.clear();
            self.written.extend_from_slice(bytes);
        }
    }

    /// Forgets what was written: the next bytes are copied whatever they are.
    pub(crate) fn invalidate(&mut self) {
        self.written.clear();
    }
}

impl StagedUploads {
    /// Puts the bytes of all uploads on the device, in as few buffers as possible: making one costs
    /// far more than filling it.
    pub(crate) fn new(device: &wgpu::Device, uploads: &[Upload<'_>]) -> Result<Self, ShadowError> {
        let usage = wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC;
        let most_bytes = device.limits().max_buffer_size;
        let groups = Groups {
            uploads,
            most_bytes,
        };
        let buffers = groups.map(|group| {
            let contents = group.iter().map(|(_, bytes)| *bytes);
            let staging = filled_buffer_of(device, "shadow upload", contents, usage);
            staging.map_err(|refusal| refused("the uniforms of a frame", refusal))
        });
        Ok(Self {
            buffers: buffers.collect::<Result<_, _>>()?,
            most_bytes,
        })
    }

    /// Returns whether anything was made on the device.
    pub(crate) fn is_empty(&self) -> bool {
        self.buffers.is_empty()
    }

    /// Records the copies. `uploads` are those that were staged.
    pub(crate) fn commit(self, encoder: &mut wgpu::CommandEncoder, uploads: &[Upload<'_>]) {
        let groups = Groups {
            uploads,
            most_bytes: self.most_bytes,
        };
        for (staging, group) in self.buffers.iter().zip(groups) {
            let mut offset = 0;
            for (buffer, bytes) in group {
                let size = bytes.len() as u64;
                encoder.copy_buffer_to_buffer(staging, offset, buffer, 0, size);
                offset += staged_bytes(bytes);
            }
        }
    }
}

/// Divides uploads into groups of which each fits into one buffer.
struct Groups<'a, 'b> {
    uploads: &'a [Upload<'b>],
    most_bytes: u64,
}

impl<'a, 'b> Iterator for Groups<'a, 'b> {
    type Item = &'a [Upload<'b>];

    fn next(&mut self) -> Option<Self::Item> {
        let mut total = 0;
        let fits = |upload: &&Upload<'_>| {
            total += staged_bytes(upload.1);
            total <= self.most_bytes
        };
        // A single upload is no larger than the buffer that it goes to.
        let count = self.uploads.iter().take_while(fits).count().max(1);
        let (group, others) = self.uploads.split_at_checked(count)?;
        self.uploads = others;
        Some(group)
    }
}

/// Returns the room that an upload takes in a staging buffer.
fn staged_bytes(bytes: &[u8]) -> u64 {
    (bytes.len() as u64).next_multiple_of(wgpu::MAP_ALIGNMENT)
}

fn refused(object: &'static str, refusal: DeviceRefusal) -> ShadowError {
    ShadowError::Device(DeviceError { object, refusal })
}
