//! Determines whether a device can draw the six faces of a cube in one multiview pass and its
//! driver does so correctly.

use std::num::NonZeroU32;

/// Is the number of faces of a cube: the views of one pass.
pub(crate) const FACE_COUNT: u32 = 6;

/// Is the multiview mask of a pass over all faces.
pub(crate) const ALL_FACES_MASK: Option<NonZeroU32> = NonZeroU32::new((1 << FACE_COUNT) - 1);

/// Is the first Mesa version whose llvmpipe was seen to be correct. Mesa's llvmpipe, which lavapipe
/// (Vulkan) rasterises with, draws the triangles of a vertex batch into wrong layers where the
/// batch is clipped: with 22.3.6, in a room with a ball around the lamp, up to a quarter of a
/// face's texels are wrong. The versions between are not trusted.
const FIRST_CORRECT_LLVMPIPE: [u32; 3] = [25, 0, 7];

/// Returns true where the engine enabled the feature and the limit, and the driver is not one known
/// to be wrong.
pub(crate) fn supports_cube_multiview(device: &wgpu::Device) -> bool {
    device.features().contains(wgpu::Features::MULTIVIEW)
        && device.limits().max_multiview_view_count >= FACE_COUNT
        && !is_known_wrong(&device.adapter_info())
}

fn is_known_wrong(adapter: &wgpu::AdapterInfo) -> bool {
    let is_llvmpipe =
        adapter.driver.contains("llvmpipe") || adapter.name.to_lowercase().contains("llvmpipe");
    // A version that cannot be read counts as an old one.
    is_llvmpipe && mesa_version(&adapter.driver_info).unwrap_or_default() < FIRST_CORRECT_LLVMPIPE
}

/// Returns the numbers after "Mesa" in "Mesa 25.0.7-2 (LLVM 15.0.6)". A missing second or third
/// number is 0; without a first one the result is `None`.
fn mesa_version(driver_info: &str) -> Option<[u32; 3]> {
    let (_, version) = driver_info.split_once("Mesa ")?;
    let end = version
        .find(|letter: char| !letter.is_ascii_digit() && letter != '.')
        .unwrap_or(version.len());
    let mut numbers = version[..end]
        .split('.')
        .map_while(|part| part.parse().ok());
    let major = numbers.next()?;
    let mut next = || numbers.next().unwrap_or(0);
    Some([major, next(), next()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read() {
        for (info, version) in [
            ("Mesa 22.3.6 (LLVM 15.0.6)", Some([22, 3, 6])),
            ("Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)", Some([25, 0, 7])),
            ("Mesa 26.1.0-devel (git-0123456789)", Some([26, 1, 0])),
            ("Mesa 25.1", Some([25, 1, 0])),
            ("4.5 (Core Profile) Mesa 22.3.6", Some([22, 3, 6])),
            ("Mesa devel", None),
            ("551.23", None),
            ("", None),
        ] {
            assert_eq!(mesa_version(info), version, "{info:?}");
        }
    }

    #[test]
    fn only_old_llvmpipe_is_wrong() {
        for (name, driver, driver_info, wrong) in [
            (
                "llvmpipe (LLVM 15.0.6, 256 bits)",
                "llvmpipe",
                "Mesa 22.3.6 (LLVM 15.0.6)",
                true,
            ),
            (
                "llvmpipe (LLVM 15.0.6, 256 bits)",
                "llvmpipe",
                "Mesa 25.0.6",
                true,
            ),
            (
                "llvmpipe (LLVM 15.0.6, 256 bits)",
                "llvmpipe",
                "Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)",
                false,
            ),
            (
                "llvmpipe (LLVM 20.1, 512 bits)",
                "llvmpipe",
                "Mesa 26.0.0",
                false,
            ),
            ("llvmpipe", "", "", true),
            (
                "AMD Radeon RX 7800 XT (RADV NAVI32)",
                "radv",
                "Mesa 22.3.6",
                false,
            ),
            ("NVIDIA GeForce RTX 4070", "NVIDIA", "551.23", false),
        ] {
            let adapter = wgpu::AdapterInfo {
                name: name.to_owned(),
                driver: driver.to_owned(),
                driver_info: driver_info.to_owned(),
                ..wgpu::AdapterInfo::new(wgpu::DeviceType::Cpu, wgpu::Backend::Vulkan)
            };
            assert_eq!(is_known_wrong(&adapter), wrong, "{name} {driver_info}");
        }
    }
}
