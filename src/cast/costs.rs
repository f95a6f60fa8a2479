//! Holds what the choices between two ways of drawing assume that passes, draws, triangles and
//! copies cost beside each other. No image depends on them.
//!
//! `cargo bench --bench cost -- --card` measures both ways of each choice where the library takes
//! one and where it takes the other, and prints them as a row of `doc/measured_on.md`. The figures
//! here are of a software rasteriser: on a GPU triangles cost less beside calls.

/// Is the largest number of triangles, counted over all faces of a cube, for which one pass for all
/// faces is worth one saved draw call.
///
/// Measured on lavapipe of Mesa 25.0.7 by `cargo bench --bench cost -- --only faces`: with 50 to
/// 200 casters one pass and a pass each cost the same where one pass puts through 100 to 250
/// triangles for each draw call that it saves. This is the lower end.
pub(crate) const TRIANGLES_PER_SAVED_DRAW: u64 = 96;

/// Is the largest number of triangles, counted over all faces of a cube, for which one pass for all
/// faces is worth one saved pass.
///
/// Measured as [`TRIANGLES_PER_SAVED_DRAW`] is: with a dozen casters or fewer, where passes weigh
/// most, both ways cost the same at 4000 to 20000 triangles for each saved pass. This is the lower
/// end.
pub(crate) const TRIANGLES_PER_SAVED_PASS: u64 = 4000;

/// Is the number of copied texels that cost as much as one draw. A static-caster cache pays where
/// drawing its casters again would cost more than copying a layer.
///
/// Measured by `cargo bench --bench cost -- --only static-cache`: in software a draw of a box costs
/// as much as copying 100 000 texels. A third of that leaves room for devices that draw faster in
/// relation to their memory.
pub(crate) const TEXELS_PER_DRAW: u64 = 32_768;

/// Is the number of copied texels that cost as much as one triangle.
///
/// Not measured: it compares the memory that a copied texel moves (8 bytes) with the corners that a
/// triangle fetches and transforms (some 100 bytes where corners are shared); a software rasteriser
/// takes far longer over triangles.
pub(crate) const TEXELS_PER_TRIANGLE: u64 = 16;
