//! Finds the driver.

use std::path::{Path, PathBuf};

use crate::IsaError;

/// Is the installed driver for AMD chips.
#[derive(Clone, Debug)]
pub struct Driver {
    manifest: PathBuf,
}

impl Driver {
    /// Finds the driver where distributions install it.
    ///
    /// # Errors
    /// Returns [`IsaError::NoDriver`] where it is not installed.
    pub fn find() -> Result<Self, IsaError> {
        let folder = Path::new("/usr/share/vulkan/icd.d");
        let entries = folder.read_dir().into_iter().flatten().flatten();
        let mut manifests: Vec<_> = entries.map(|entry| entry.path()).collect();
        manifests.sort();
        let is_radeon = |path: &PathBuf| {
            let name = path.file_name().and_then(|name| name.to_str());
            name.is_some_and(|name| name.starts_with("radeon_icd"))
        };
        let manifest = manifests.into_iter().find(is_radeon);
        let manifest = manifest.ok_or_else(|| IsaError::NoDriver {
            folder: folder.display().to_string(),
        })?;
        Ok(Self { manifest })
    }

    /// Returns the environment variables under which a process compiles for the chips of `family`,
    /// such as `NAVI21`.
    pub fn variables(&self, family: &str) -> [(&'static str, String); 3] {
        [
            ("VK_DRIVER_FILES", self.manifest.display().to_string()),
            ("RADV_FORCE_FAMILY", family.to_owned()),
            // Compilation itself is measured, so no shader may come from the driver's cache.
            ("MESA_SHADER_CACHE_DISABLE", "true".to_owned()),
        ]
    }
}
