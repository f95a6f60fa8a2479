//! Reads buffers back without waiting: a browser gives the contents only after the frame has ended.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use shadow_support::gpu::Gpu;

/// Is a buffer on its way.
pub struct Readback {
    buffer: wgpu::Buffer,
    done: Receiver<Result<(), wgpu::BufferAsyncError>>,
}

/// Is a copy that was recorded, and is to be asked for after the submission.
pub struct Copied {
    buffer: wgpu::Buffer,
}

/// Is the layout of a copied texture: bytes from one row to the next.
pub fn padded_row(width: u32) -> u32 {
    (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

/// Records the copy of a texture of four bytes a texel.
pub fn copy_texture(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    texture: &wgpu::Texture,
) -> Copied {
    let row = padded_row(texture.width());
    let copied = copy_target(gpu, u64::from(row) * u64::from(texture.height()));
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &copied.buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    copied
}

/// Records the copy of a buffer.
pub fn copy_buffer(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer) -> Copied {
    let copied = copy_target(gpu, buffer.size());
    encoder.copy_buffer_to_buffer(buffer, 0, &copied.buffer, 0, buffer.size());
    copied
}

fn copy_target(gpu: &Gpu, bytes: u64) -> Copied {
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
    Copied {
        buffer: gpu.empty_buffer(bytes, usage),
    }
}

impl Copied {
    /// Asks for the contents, after the commands were submitted.
    pub fn read(self) -> Readback {
        let (sender, done) = channel();
        self.buffer
            .map_async(wgpu::MapMode::Read, .., move |result| {
                // Nobody waits any more where the receiver is gone.
                let _ = sender.send(result);
            });
        Readback {
            buffer: self.buffer,
            done,
        }
    }
}

impl Readback {
    /// Returns the bytes once they are there, or the reason why they never will be.
    pub fn poll(&self, gpu: &Gpu) -> Option<Result<Vec<u8>, String>> {
        let failed = |error: &dyn std::fmt::Display| format!("cannot read back: {error}");
        if let Err(error) = gpu.device.poll(wgpu::PollType::Poll) {
            return Some(Err(failed(&error)));
        }
        match self.done.try_recv() {
            Err(TryRecvError::Empty) => None,
            Err(error) => Some(Err(failed(&error))),
            Ok(Err(error)) => Some(Err(failed(&error))),
            Ok(Ok(())) => Some(match self.buffer.get_mapped_range(..) {
                Ok(bytes) => Ok(bytes.to_vec()),
                Err(error) => Err(failed(&error)),
            }),
        }
    }
}

/// Returns the rows of a copied texture without what pads them.
pub fn rows(bytes: &[u8], width: u32) -> impl Iterator<Item = &[u8]> {
    let used = 4 * width as usize;
    bytes
        .chunks_exact(padded_row(width) as usize)
        .map(move |row| &row[..used])
}
