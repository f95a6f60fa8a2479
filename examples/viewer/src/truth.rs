//! Casts rays for the visibility of the sun, in slices between the frames, and compares.

use std::time::Duration;

use example_support::camera::Camera;
use glam::DVec3;
use shadow_support::camera::{PixelRay, pixel_rays};
use shadow_support::measure::edge::Rings;
use shadow_support::measure::error::{Band, Errors, compare};
use shadow_support::measure::pixels::{Pixel, pixel};
use shadow_support::technique::Footprint;
use shadow_support::truth::{LightInWorld, World};
use web_time::Instant;

use crate::readback;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::side::Side;
use crate::viewpoint::Viewpoint;

/// Is the largest number of pixels that rays are cast for.
const MOST_PIXELS: u32 = 240 * 135;

/// Is the number of points of a light with an extent, per side of their square.
const DISC_SIDE: u32 = 12;

/// Is the number of rays per ring in the search for edges.
const RING_RAYS: u32 = 8;

/// Is everything that the truth depends on.
#[derive(Clone, PartialEq)]
pub struct Subject {
    viewpoint: Viewpoint,
    toward_sun: DVec3,
    sun_degrees: f32,
    time: f32,
    size: [u32; 2],
}

impl Subject {
    /// Makes the subject for a picture of `size` pixels, of which fewer are measured.
    pub fn new(settings: &Settings, time: f32, [width, height]: [u32; 2]) -> Self {
        let shrink = (f64::from(MOST_PIXELS) / f64::from(width * height))
            .sqrt()
            .min(1.0);
        let size = [width, height].map(|side| ((f64::from(side) * shrink) as u32).max(1));
        Self {
            viewpoint: settings.viewpoint,
            toward_sun: settings.toward_sun().as_dvec3().normalize(),
            sun_degrees: settings.sun_degrees,
            time,
            size,
        }
    }

    /// Returns the subject of other settings with the same size.
    pub fn again(&self, settings: &Settings, time: f32) -> Self {
        Self {
            size: self.size,
            ..Self::new(settings, time, self.size)
        }
    }

    pub fn size(&self) -> [u32; 2] {
        self.size
    }
}

/// Holds the truth about what the camera sees, as far as it is known.
pub struct Truth {
    pub subject: Subject,
    world: World,
    rays: Vec<PixelRay>,
    rings: Rings,
    next: usize,
    /// Are the pixels that count: those where a surface faces the sun.
    pub pixels: Vec<Pixel>,
}

/// Is what comes out of a comparison of one side.
pub struct Verdict {
    pub errors: Errors,
    /// Holds the visibility of each of the truth's pixels.
    pub visibilities: Vec<f32>,
}

impl Truth {
    /// Sorts the triangles for rays. Returns an error where there are none.
    pub fn new(scene: &Scene, subject: Subject, camera: &Camera) -> Result<Self, String> {
        let triangles = scene.triangles(subject.time);
        if triangles
            .iter()
            .all(|triangle| triangle.try_normal().is_none())
        {
            return Err("there is no surface that rays could meet".to_owned());
        }
        let light = LightInWorld::Far {
            toward_light: subject.toward_sun,
            disc_tangent: f64::from(subject.sun_degrees.to_radians() * 0.5).tan(),
        };
        let extent = f64::from(scene.extent);
        Ok(Self {
            world: World::from_triangles(&triangles, extent, light),
            rays: pixel_rays(&camera.view, subject.size).collect(),
            rings: Rings::of_diameter(extent, RING_RAYS),
            subject,
            next: 0,
            pixels: Vec::new(),
        })
    }

    /// Casts rays for some time, and returns whether there is nothing left to do.
    pub fn advance(&mut self, limit: Duration) -> bool {
        let start = Instant::now();
        while self.next < self.rays.len() && start.elapsed() < limit {
            // The clock is read once per row or so.
            for _ in 0..64 {
                let Some(ray) = self.rays.get(self.next) else {
                    break;
                };
                let index = self.next as u32;
                let found = pixel(&self.world, index, ray, DISC_SIDE, &self.rings);
                self.pixels.extend(found);
                self.next += 1;
            }
        }
        self.is_done()
    }

    pub fn is_done(&self) -> bool {
        self.next == self.rays.len()
    }

    /// Returns the share of the rays that are cast, 0..=1.
    pub fn progress(&self) -> f32 {
        self.next as f32 / self.rays.len().max(1) as f32
    }

    /// Compares the visibilities that a side drew, as they were read back.
    pub fn judge(&self, side: &Side, bytes: &[u8]) -> Verdict {
        let width = self.subject.size[0];
        let drawn: Vec<f32> = readback::rows(bytes, width)
            .flat_map(|row| row.chunks_exact(4))
            .map(bytemuck::pod_read_unaligned)
            .collect();
        let visibilities: Vec<f32> = self
            .pixels
            .iter()
            .map(|pixel| drawn.get(pixel.index as usize).copied().unwrap_or(f32::NAN))
            .collect();
        let footprint = Footprint::of_views(side.sun_maps().views());
        let texels: Vec<_> = self
            .pixels
            .iter()
            .map(|pixel| footprint.texel_world(pixel.position))
            .collect();
        let band = Band {
            texels: side.settings().filter.reach_texels() + 1.0,
            world: 0.0,
        };
        Verdict {
            errors: compare(&self.pixels, &visibilities, &texels, band),
            visibilities,
        }
    }

    /// Returns the picture of the truth: four bytes a pixel.
    pub fn picture(&self) -> Vec<u8> {
        self.paint(|_, pixel| {
            let grey = (15.0 + 230.0 * pixel.visibility) as u8;
            [grey, grey, grey, 255]
        })
    }

    /// Returns the picture of a difference: red where the drawn visibility is too dark (acne), and
    /// blue where it is too bright (a leak), on the grey of the truth.
    pub fn difference(&self, verdict: &Verdict) -> Vec<u8> {
        self.paint(|number, pixel| {
            let error = verdict.visibilities[number] - pixel.visibility as f32;
            let base = 60.0 + 110.0 * pixel.visibility as f32;
            let strength = error.abs().min(1.0).sqrt();
            let color = if error < 0.0 {
                [255.0, 30.0, 20.0]
            } else {
                [30.0, 90.0, 255.0]
            };
            let [r, g, b] = color.map(|level| (base + (level - base) * strength) as u8);
            [r, g, b, 255]
        })
    }

    fn paint(&self, color: impl Fn(usize, &Pixel) -> [u8; 4]) -> Vec<u8> {
        let mut picture = [40, 43, 51, 255].repeat(self.rays.len());
        for (number, pixel) in self.pixels.iter().enumerate() {
            let at = 4 * pixel.index as usize;
            picture[at..at + 4].copy_from_slice(&color(number, pixel));
        }
        picture
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    #[test]
    fn the_truth_of_the_textbook_is_found_in_slices() {
        let scene = scene::built_in("textbook").expect("a scene");
        let settings = scene.settings();
        let subject = Subject::new(&settings, 0.0, [64, 36]);
        assert_eq!(subject.size(), [64, 36]);
        let camera = settings.viewpoint.camera(subject.size(), 0.0);
        let mut truth = Truth::new(&scene, subject.clone(), &camera).expect("triangles");
        let mut slices = 0;
        while !truth.advance(Duration::ZERO) {
            slices += 1;
            assert!(truth.progress() <= 1.0);
            if slices > 4 {
                truth.advance(Duration::from_secs(600));
            }
            // A slice of no time does nothing, and does not end.
            if slices > 10 {
                break;
            }
        }
        assert!(truth.is_done());
        let lit = truth
            .pixels
            .iter()
            .filter(|pixel| pixel.visibility == 1.0)
            .count();
        let hidden = truth
            .pixels
            .iter()
            .filter(|pixel| pixel.visibility == 0.0)
            .count();
        assert_eq!(
            lit + hidden,
            truth.pixels.len(),
            "a sun without extent has no penumbra"
        );
        assert!(hidden > 20 && lit > hidden, "{lit} lit, {hidden} hidden");
        assert_eq!(truth.picture().len(), 4 * 64 * 36);

        // A perfect side has no error and no colour in the picture of its difference.
        let visibilities: Vec<f32> = truth.pixels.iter().map(|p| p.visibility as f32).collect();
        let texels = vec![Some(0.01); visibilities.len()];
        let band = Band {
            texels: 1.0,
            world: 0.0,
        };
        let errors = compare(&truth.pixels, &visibilities, &texels, band);
        assert_eq!(errors.rmse, 0.0);
        let verdict = Verdict {
            errors,
            visibilities,
        };
        let is_grey = |pixel: &[u8]| pixel[0] == pixel[1] || pixel == [40, 43, 51, 255];
        assert!(truth.difference(&verdict).chunks(4).all(is_grey));
        let other = Subject::new(&settings, 1.0, [64, 36]);
        assert!(subject != other);
    }
}
