//! Returns device errors as values: wgpu reports them to an error scope, or, where the device is
//! lost, not at all.
//!
//! A browser's WebGPU resolves an error scope later, in a promise. There is no error to return by
//! then, and a scope that was closed without waiting would swallow it. So in a browser no scope is
//! opened: errors go where the engine listens for them, to `Device::on_uncaptured_error` and
//! `Device::set_device_lost_callback`.

use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

use crate::error::DeviceRefusal;

/// Runs `create` and returns what it made if the device made all of it. In a browser with WebGPU no
/// error is captured, and an object that could not be made is an invalid one, as WebGPU specifies.
pub(crate) fn capture_device_errors<T>(
    device: &wgpu::Device,
    create: impl FnOnce() -> T,
) -> Result<T, DeviceRefusal> {
    scoped(device, || {
        let made = create();
        is_alive(device).then_some(made)
    })
}

/// Makes a buffer that holds `contents` (a multiple of 4 bytes, not empty).
pub(crate) fn filled_buffer(
    device: &wgpu::Device,
    label: &str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, DeviceRefusal> {
    filled_buffer_of(device, label, std::iter::once(contents), usage)
}

/// Makes a buffer that holds several contents one after the other, each of which begins at a
/// multiple of `wgpu::MAP_ALIGNMENT`.
pub(crate) fn filled_buffer_of<'a>(
    device: &wgpu::Device,
    label: &str,
    contents: impl Iterator<Item = &'a [u8]> + Clone,
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, DeviceRefusal> {
    let end = |start: u64, contents: &[u8]| {
        start.next_multiple_of(wgpu::MAP_ALIGNMENT) + contents.len() as u64
    };
    scoped(device, || {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: contents.clone().fold(0, end),
            usage,
            mapped_at_creation: true,
        });
        let mut offset = 0;
        for contents in contents {
            let end = end(offset, contents);
            let range = end - contents.len() as u64..end;
            let mut mapped = buffer.get_mapped_range_mut(range).ok()?;
            mapped.copy_from_slice(contents);
            offset = end;
        }
        buffer.unmap();
        Some(buffer)
    })
}

/// Returns whether the device is not lost. wgpu does not report the loss of a device to error
/// scopes and returns invalid objects. A buffer that is mapped at its creation is the exception:
/// its memory cannot be reached. This probe needs no queue and waits for nothing.
fn is_alive(device: &wgpu::Device) -> bool {
    let probe = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("shadow device probe"),
        size: wgpu::COPY_BUFFER_ALIGNMENT,
        usage: wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: true,
    });
    probe.get_mapped_range_mut(..).is_ok()
}

/// Runs `create` in error scopes. `create` returns `None` where the device did not make its object;
/// if the device reports no error with that, it is lost.
fn scoped<T>(
    device: &wgpu::Device,
    create: impl FnOnce() -> Option<T>,
) -> Result<T, DeviceRefusal> {
    if answers_later(device) {
        return create().ok_or(DeviceRefusal::Lost);
    }
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let made = create();
    let invalid = poll_once(validation.pop()).flatten();
    let out_of_memory = poll_once(memory.pop()).flatten();
    let failed = poll_once(internal.pop()).flatten();
    // Out of memory comes first: errors about the missing object are only its consequence.
    if out_of_memory.is_some() {
        return Err(DeviceRefusal::OutOfMemory);
    }
    match (invalid.or(failed), made) {
        (Some(error), _) => Err(DeviceRefusal::Refused(error.to_string())),
        (None, None) => Err(DeviceRefusal::Lost),
        (None, Some(made)) => Ok(made),
    }
}

/// Returns whether error scopes of the device are resolved later than the call that closes them.
/// WebGL in a browser is wgpu's own and resolves at once.
fn answers_later(device: &wgpu::Device) -> bool {
    cfg!(target_family = "wasm") && device.adapter_info().backend == wgpu::Backend::BrowserWebGpu
}

fn poll_once<F: Future>(future: F) -> Option<F::Output> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(output) => Some(output),
        Poll::Pending => None,
    }
}
