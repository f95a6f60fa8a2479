//! Device errors as values: wgpu reports them to an error scope, not as results.

use std::future::Future;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// Why the device did not make an object.
#[derive(Debug)]
pub(crate) enum DeviceRefusal {
    OutOfMemory,
    Refused(String),
}

/// Runs `create` and tells whether the device accepted all of it.
///
/// Native backends answer at once. On the web the answer comes later: there the object is returned, and an error makes it an
/// invalid object, as WebGPU has it.
pub(crate) fn capture_device_errors<T>(
    device: &wgpu::Device,
    create: impl FnOnce() -> T,
) -> Result<T, DeviceRefusal> {
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let made = create();
    let invalid = poll_once(validation.pop()).flatten();
    let out_of_memory = poll_once(memory.pop()).flatten();
    let failed = poll_once(internal.pop()).flatten();
    // Out of memory comes first: what is then made of the missing object is invalid only in consequence.
    if out_of_memory.is_some() {
        return Err(DeviceRefusal::OutOfMemory);
    }
    match invalid.or(failed) {
        None => Ok(made),
        Some(error) => Err(DeviceRefusal::Refused(error.to_string())),
    }
}

fn poll_once<F: Future>(future: F) -> Option<F::Output> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(output) => Some(output),
        Poll::Pending => None,
    }
}
