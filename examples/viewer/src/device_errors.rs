//! Collects what the device refuses beside any call, for the window to tell.

use std::sync::{Arc, Mutex, PoisonError};

use crate::host;

/// Holds the messages that nobody has taken yet.
pub struct DeviceErrors(Arc<Mutex<Vec<String>>>);

impl DeviceErrors {
    /// Listens to a device. `wake` is called after each message.
    pub fn listen(device: &wgpu::Device, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let messages = Arc::new(Mutex::new(Vec::new()));
        let own = messages.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let message = error.to_string();
            host::log(&message);
            let mut messages = own.lock().unwrap_or_else(PoisonError::into_inner);
            messages.push(message);
            drop(messages);
            wake();
        }));
        Self(messages)
    }

    /// Returns the messages since the last call.
    pub fn take(&self) -> Vec<String> {
        let mut messages = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut messages)
    }
}
