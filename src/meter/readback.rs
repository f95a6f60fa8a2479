//! Copies results to the CPU without waiting for them.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use crate::ShadowError;
use crate::error::DeviceError;
use crate::gpu::capture_device_errors;

/// Is the number of frames whose results may be on their way: engines keep two or three frames in
/// flight.
const FRAMES_IN_FLIGHT: usize = 4;

/// Holds buffers that results are copied into. `T` is what a frame remembers until its results
/// arrive.
#[derive(Debug)]
pub(super) struct Readback<T> {
    free: Vec<wgpu::Buffer>,
    /// Holds the frames in the order in which they were recorded.
    pending: VecDeque<Pending<T>>,
}

#[derive(Debug)]
struct Pending<T> {
    buffer: wgpu::Buffer,
    /// Tells when the buffer is mapped. The sender is dropped where the encoder was.
    mapped: Receiver<bool>,
    bytes: u64,
    frame: T,
}

impl<T> Readback<T> {
    /// Makes the buffers, of `bytes` bytes each.
    pub(super) fn new(device: &wgpu::Device, label: &str, bytes: u64) -> Result<Self, ShadowError> {
        let create = || {
            let buffer = |_| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(label),
                    size: bytes,
                    usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                })
            };
            (0..FRAMES_IN_FLIGHT).map(buffer).collect()
        };
        let free = capture_device_errors(device, create).map_err(|refusal| {
            ShadowError::Device(DeviceError {
                object: "the buffers of an error meter",
                refusal,
            })
        })?;
        Ok(Self {
            free,
            pending: VecDeque::new(),
        })
    }

    /// Returns whether the results of another frame can be copied.
    pub(super) fn has_room(&self) -> bool {
        !self.free.is_empty()
    }

    /// Records the copy of the first `bytes` bytes of `results`. The buffer is mapped once the
    /// encoder has been submitted.
    pub(super) fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        results: &wgpu::Buffer,
        bytes: u64,
        frame: T,
    ) {
        let Some(buffer) = self.free.pop() else {
            return;
        };
        encoder.copy_buffer_to_buffer(results, 0, &buffer, 0, bytes);
        let (sender, mapped) = channel();
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, 0..bytes, move |result| {
            let _ = sender.send(result.is_ok());
        });
        self.pending.push_back(Pending {
            buffer,
            mapped,
            bytes,
            frame,
        });
    }

    /// Calls `take` with the results that have arrived, frame by frame. Frames whose encoder was
    /// dropped, or whose device was lost, are left out.
    pub(super) fn collect(&mut self, mut take: impl FnMut(T, &[u8])) {
        while let Some(first) = self.pending.front() {
            let is_mapped = match first.mapped.try_recv() {
                Ok(is_mapped) => is_mapped,
                Err(TryRecvError::Disconnected) => false,
                Err(TryRecvError::Empty) => return,
            };
            let Some(first) = self.pending.pop_front() else {
                return;
            };
            let buffer = first.buffer;
            if is_mapped {
                if let Ok(bytes) = buffer.get_mapped_range(0..first.bytes) {
                    take(first.frame, &bytes);
                }
                buffer.unmap();
            }
            self.free.push(buffer);
        }
    }
}
