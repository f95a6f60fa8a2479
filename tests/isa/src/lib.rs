//! Compiles WGSL for AMD chips that are not there, and returns what their compiler says of it.
//!
//! Mesa's Vulkan driver for AMD chips, RADV, compiles shaders for any chip that it knows when
//! `RADV_FORCE_FAMILY` names one, and tells through `VK_KHR_pipeline_executable_properties` how
//! many registers and instructions it came to. Nothing is drawn. The figures are the same on every
//! machine with the same version of the driver. The variables of [`Driver::variables`] must be set
//! before the process starts, since drivers are found when Vulkan is loaded.
//!
//! The SPIR-V is what wgpu gives to this driver: the same writer with the same options.

#[cfg(not(target_arch = "wasm32"))]
mod compiler;
mod driver;
mod figures;
mod table;

#[cfg(not(target_arch = "wasm32"))]
pub use compiler::Compiler;
pub use driver::Driver;
pub use figures::Figures;
pub use table::{Row, Table};

/// States why a shader could not be compiled.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IsaError {
    /// The driver is not installed.
    #[error(
        "no radeon_icd.*.json in {folder}: install Mesa's Vulkan drivers (Debian: mesa-vulkan-drivers)"
    )]
    NoDriver {
        /// Is the folder that was searched.
        folder: String,
    },
    /// Vulkan could not be loaded.
    #[cfg(not(target_arch = "wasm32"))]
    #[error("Vulkan: {0}")]
    Loading(#[from] ash::LoadingError),
    /// Vulkan returned an error.
    #[cfg(not(target_arch = "wasm32"))]
    #[error("Vulkan: {0}")]
    Vulkan(#[from] ash::vk::Result),
    /// The driver offers no device, because it does not know the chip.
    #[error("no device: RADV_FORCE_FAMILY names a chip that the driver does not know")]
    NoDevice,
    /// The WGSL is not valid, or cannot be written as SPIR-V.
    #[error(transparent)]
    Writing(#[from] shadow_backends::WriteError),
    /// The WGSL has no such entry point.
    #[error("no entry point {0:?}")]
    Entry(String),
    /// The driver does not tell one of the figures.
    #[error("the driver does not tell {0:?}")]
    Figure(&'static str),
}
