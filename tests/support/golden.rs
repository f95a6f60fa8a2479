//! Compares images with references in `tests/golden`.
//!
//! Three limits apply together. A pixel *fails* where a channel differs by more than `channel`, which allows for the
//! last bits of another driver's arithmetic. Few pixels may fail, which allows for edges that fall on another pixel.
//! The mean difference detects what is faint and everywhere.

use std::fs;
use std::path::{Path, PathBuf};

use image::{Rgba, RgbaImage};

use crate::support::gpu::Gpu;

/// Limits the difference of an image.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Is the difference of a channel beyond which a pixel fails, in 1/255.
    pub channel: u8,
    /// Is the number of pixels that may fail.
    pub failed_pixels: usize,
    /// Is the mean difference over all pixels and channels, in 1/255.
    pub mean: f64,
}

/// Is the difference of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    pub largest: u8,
    pub failed_pixels: usize,
    pub mean: f64,
}

impl Difference {
    pub fn between(a: &RgbaImage, b: &RgbaImage, limits: &Limits) -> Self {
        assert_eq!(a.dimensions(), b.dimensions());
        let pairs = || a.pixels().zip(b.pixels());
        let channels = pairs().flat_map(|(a, b)| (0..4).map(|k| a.0[k].abs_diff(b.0[k])));
        let sum: u64 = channels.map(u64::from).sum();
        let differences = || pairs().map(|(a, b)| difference(a, b));
        Self {
            largest: differences().max().unwrap_or(0),
            failed_pixels: differences().filter(|d| *d > limits.channel).count(),
            mean: sum as f64 / (4 * a.width() * a.height()) as f64,
        }
    }

    pub fn is_within(&self, limits: &Limits) -> bool {
        self.failed_pixels <= limits.failed_pixels && self.mean <= limits.mean
    }
}

fn difference(a: &Rgba<u8>, b: &Rgba<u8>) -> u8 {
    (0..4).map(|k| a.0[k].abs_diff(b.0[k])).max().unwrap_or(0)
}

/// Fails unless `actual` equals `tests/golden/NAME.png` within `limits`. With `SHADOW_GOLDEN=update` it writes the
/// reference instead.
pub fn assert_golden(gpu: &Gpu, name: &str, actual: &RgbaImage, limits: &Limits) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let reference = root.join("tests/golden").join(format!("{name}.png"));
    assert!(
        actual.width().max(actual.height()) <= 128,
        "references are small"
    );
    if std::env::var("SHADOW_GOLDEN").as_deref() == Ok("update") {
        write(actual, &reference);
    }
    let Ok(expected) = image::open(&reference) else {
        let seen = write_beside(root, name, "actual", actual);
        panic!(
            "no reference {}. The picture is in {}; look at it, and run with SHADOW_GOLDEN=update to keep it.",
            reference.display(),
            seen.display()
        );
    };
    let bytes = fs::metadata(&reference).expect("a readable file").len();
    assert!(
        bytes <= 16 * 1024,
        "{name}: {bytes} bytes in the repository"
    );
    let expected = expected.to_rgba8();
    assert_eq!(actual.dimensions(), expected.dimensions(), "{name}");
    let difference = Difference::between(actual, &expected, limits);
    if !difference.is_within(limits) {
        let seen = write_beside(root, name, "actual", actual);
        let where_it_differs = write_beside(root, name, "difference", &colored(actual, &expected));
        panic!(
            "{name} on {}: {difference:?} exceeds {limits:?}\nsee {} and {}; SHADOW_GOLDEN=update accepts it",
            gpu.describe(),
            seen.display(),
            where_it_differs.display()
        );
    }
}

/// Returns an image that is black where both are equal, and goes from blue over green to red with the difference.
fn colored(a: &RgbaImage, b: &RgbaImage) -> RgbaImage {
    let mut picture = a.clone();
    for (pixel, other) in picture.pixels_mut().zip(b.pixels()) {
        let d = u32::from(difference(pixel, other));
        let ramp = |peak: u32| 255_u32.saturating_sub(4 * d.abs_diff(peak)).min(255) as u8;
        *pixel = match d {
            0 => Rgba([0, 0, 0, 255]),
            _ => Rgba([ramp(d.max(96)), ramp(48), ramp(d.min(16)), 255]),
        };
    }
    picture
}

fn write_beside(root: &Path, name: &str, kind: &str, picture: &RgbaImage) -> PathBuf {
    let path = root
        .join("target/golden")
        .join(format!("{name}-{kind}.png"));
    write(picture, &path);
    path
}

fn write(picture: &RgbaImage, path: &Path) {
    let directory = path.parent().expect("a path with a directory");
    fs::create_dir_all(directory).expect("a writable directory");
    picture.save(path).expect("a writable file");
}

/// The comparison accepts what it should and nothing else.
#[test]
fn each_limit_catches_what_the_others_forgive() {
    let limits = Limits {
        channel: 2,
        failed_pixels: 8,
        mean: 0.1,
    };
    let plain = RgbaImage::from_pixel(64, 64, Rgba([100, 100, 100, 255]));
    let judge = |change: &dyn Fn(u32, u32) -> i16| {
        let mut changed = plain.clone();
        for (x, y, pixel) in changed.enumerate_pixels_mut() {
            pixel.0[1] = (100 + change(x, y)) as u8;
        }
        Difference::between(&changed, &plain, &limits)
    };
    let same = judge(&|_, _| 0);
    assert_eq!((same.largest, same.failed_pixels, same.mean), (0, 0, 0.0));
    // These are the last bit of a tenth of the pixels, and a handful of pixels on edges.
    assert!(judge(&|x, y| i16::from((x + 64 * y) % 10 == 0)).is_within(&limits));
    assert!(judge(&|x, y| if y == 0 && x < 8 { 100 } else { 0 }).is_within(&limits));
    // These are a row that moved, a faint change of everything, and a small patch that is clearly wrong.
    assert!(!judge(&|_, y| if y == 9 { 40 } else { 0 }).is_within(&limits));
    assert!(!judge(&|_, _| -1).is_within(&limits));
    assert!(!judge(&|x, y| if x < 3 && y < 3 { 3 } else { 0 }).is_within(&limits));
}
