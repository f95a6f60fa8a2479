//! Measures how far a visibility is from the truth, separated by cause.

use super::pixels::Pixel;

/// Is the distance in texels along the light's ray below which an occluder makes a contact.
const CONTACT_TEXELS: f64 = 16.0;

/// Holds the errors of one image. Percentages are shares of the pixels that could have had the
/// error.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    /// Is the root of the mean squared error of the visibility, over all pixels.
    pub rmse: f64,
    /// Counts the pixels on the wrong side of one half.
    pub misclassified_percent: f64,
    /// Counts shadow on lit pixels away from edges: acne.
    pub false_shadow_percent: f64,
    /// Counts light on shadowed pixels away from edges, where the occluder is close: peter-panning.
    pub contact_light_percent: f64,
    /// Is the largest distance from its occluder, in texels, at which a shadowed pixel is still
    /// lit.
    pub contact_reach_texels: f64,
    /// Counts light on shadowed pixels away from edges, where the occluder is far: bleeding. It is
    /// zero for a correct shadow map.
    pub deep_light_percent: f64,
    /// Is the area on the wrong side of one half per length of edge, in texels.
    pub edge_aliasing_texels: f64,
    /// Is the displacement of edges, in texels: above 0 where the shadow has shrunk.
    pub edge_shift_texels: f64,
    /// Is the error over the penumbra of a light with extent; NaN where there is none.
    pub penumbra_rmse: f64,
    /// Counts the results that are not finite; it must be 0.
    pub non_finite: usize,
}

/// Holds the distance from an edge within which pixels count as edge: a number of texels, and a
/// length.
#[derive(Clone, Copy, Debug)]
pub struct Band {
    pub texels: f64,
    pub world: f64,
}

/// Compares the visibilities of a technique with the truth.
///
/// `texel_world` is the size of a texel at each pixel, across the light's rays; `None` where the
/// technique has no map there.
pub fn compare(
    pixels: &[Pixel],
    answers: &[f32],
    texel_world: &[Option<f64>],
    band: Band,
) -> Errors {
    let mut all = Mean::default();
    let mut wrong = Mean::default();
    let mut lit = Mean::default();
    let mut contact = Mean::default();
    let mut deep = Mean::default();
    let mut aliasing = Mean::default();
    let mut shift = Mean::default();
    let mut width = Mean::default();
    let mut penumbra = Mean::default();
    let mut shadowed = 0usize;
    let mut errors = Errors::default();
    for ((pixel, &answer), texel) in pixels.iter().zip(answers).zip(texel_world) {
        let answer = f64::from(answer);
        if !answer.is_finite() {
            errors.non_finite += 1;
            continue;
        }
        let truth = pixel.visibility;
        let error = answer - truth;
        let is_wrong = f64::from(u8::from((answer >= 0.5) != (truth >= 0.5)));
        all.add(error * error);
        wrong.add(is_wrong);
        let band_world = texel.map(|texel| band.texels * texel + band.world);
        let in_band = band_world.is_some_and(|band_world| pixel.edge_world <= band_world);
        let in_penumbra = truth > 0.0 && truth < 1.0;
        if in_penumbra {
            penumbra.add(error * error);
        }
        if in_band {
            aliasing.add(is_wrong);
            shift.add(error);
            width.add(band.texels + texel.map_or(0.0, |texel| band.world / texel));
        }
        if truth == 0.0 {
            shadowed += 1;
        }
        if truth == 1.0 {
            lit.add(if in_band { 0.0 } else { 1.0 - answer });
        } else if truth == 0.0 && !in_band {
            let distance = pixel.occluder_world.unwrap_or(f64::INFINITY);
            let distance_texels = texel.map_or(f64::INFINITY, |texel| distance / texel);
            if distance_texels <= CONTACT_TEXELS {
                contact.add(answer);
                if answer > 0.5 {
                    errors.contact_reach_texels = errors.contact_reach_texels.max(distance_texels);
                }
            } else {
                deep.add(answer);
            }
        }
    }
    let of_shadowed = |mean: &Mean| 100.0 * mean.sum / shadowed.max(1) as f64;
    Errors {
        rmse: all.value().sqrt(),
        misclassified_percent: 100.0 * wrong.value(),
        false_shadow_percent: 100.0 * lit.value(),
        contact_light_percent: of_shadowed(&contact),
        deep_light_percent: of_shadowed(&deep),
        edge_aliasing_texels: 2.0 * width.value() * aliasing.value(),
        edge_shift_texels: 2.0 * width.value() * shift.value(),
        penumbra_rmse: if penumbra.count == 0 {
            f64::NAN
        } else {
            penumbra.value().sqrt()
        },
        ..errors
    }
}

/// Is a running mean.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    fn value(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}
