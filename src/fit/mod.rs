//! Determines what each light's views must cover, as pure f64 mathematics that returns values and
//! does not use wgpu.
//!
//! ```text
//! camera.rs       the engine's camera as half-spaces and depth along the view
//! camera_rays.rs  where rays through its image meet receivers
//! region.rs       exact vertices of (convex region ∩ box)
//! axes.rs         world-fixed light axes, light space and boxes in it
//! footprint.rs    which part of a slice of the view a map rectangle covers
//! size_step.rs    quantized size steps with hysteresis
//! map_rect.rs     the rectangle of a map plane that a view covers, snapped to whole texels
//! spacing.rs      how finely f64 distinguishes positions, far from the world's origin
//! split.rs        the depths at which one cascade ends and the next begins
//! stability.rs    what may change the extent of a cascade
//! image_corners.rs  the sphere around a slice of a camera's view
//! bounds_tree/    a tree over boxes; boxes.rs: lists of boxes, with a tree or without
//! change_log.rs   which boxes have changed lately
//! culling.rs      for what the casters of a cascade are culled
//! directional_casters.rs  the casters of a frame as a directional light sees them
//! visible.rs      what a camera sees of the receivers
//! extruded_rect.rs  what reaches into the extruded map rectangle
//! caster_shape.rs  what an engine may say of a caster's surface
//! caster_parts.rs  the parts of large casters behind which receivers lie; large_casters.rs: which
//!                 casters these are
//! required.rs     what a cascade must cover of the receivers
//! cascade_bounds.rs  the light-space bounds of a cascade
//! cascade_layout.rs  how texels may be divided among cascades
//! layout.rs       the layout of a light, from frame to frame
//! layout_choice.rs  the layout with the least predicted error; layout_samples.rs: what predicts it;
//!                 predicted_error.rs: how; layout_pack.rs: the rectangles of a layer;
//!                 point_grid.rs: points in a rectangle
//! directional.rs  the complete fit of a directional light; directional_input.rs: its input
//! reached.rs      what a local light reaches; box_arrays.rs: many boxes compared at once
//! nearest.rs      how near to a local light its near planes may be
//! local.rs        the complete fit of a spot or point light's views; local_input.rs: its input;
//!                 local_view.rs: one view
//! local_need.rs   how many texels the views of local lights need
//! square_sizes.rs  the sizes of the squares of a layer that views share; square_packing.rs: where
//!                 they lie
//! shadow_ray.rs   the view along one ray from a receiver to a light
//! texel_rect.rs   the rectangle of a layer that a view is rendered into
//! view.rs         ShadowView: the value that maps are rendered and sampled with
//! view_placement.rs  where a view is in the world
//! view_rounding.rs  the rounding errors of a view
//! ```

mod axes;
mod bounds_tree;
mod box_arrays;
mod boxes;
mod camera;
mod camera_rays;
mod cascade_bounds;
mod cascade_layout;
mod caster_parts;
mod caster_shape;
mod change_log;
mod culling;
mod directional;
mod directional_casters;
mod directional_input;
mod extruded_rect;
mod footprint;
mod image_corners;
mod large_casters;
mod layout;
mod layout_choice;
mod layout_pack;
mod layout_samples;
mod local;
mod local_input;
mod local_need;
mod local_view;
mod map_rect;
mod nearest;
mod point_grid;
mod predicted_error;
mod reached;
mod region;
mod required;
mod shadow_ray;
mod size_step;
mod spacing;
mod split;
mod square_packing;
mod square_sizes;
mod stability;
mod texel_rect;
mod view;
mod view_placement;
mod view_rounding;
mod visible;

pub(crate) use axes::LightAxes;
pub(crate) use axes::{LightBox, LightSpace};
pub(crate) use bounds_tree::BoundsTree;
pub(crate) use boxes::{Boxes, CasterBox, Role};
pub(crate) use camera::CameraFrustum;
pub use camera::CameraView;
pub use cascade_layout::CascadeLayout;
pub use caster_shape::CasterShape;
pub(crate) use change_log::{ChangeLog, ChangedBoxes};
pub(crate) use directional::{DirectionalFit, FitScratch};
pub(crate) use directional_input::{FitInput, FitLimits, Region};
pub use footprint::SliceReport;
pub(crate) use local::LocalFit;
pub(crate) use local_input::{LocalInput, MAX_LOCAL_VIEWS};
pub(crate) use local_need::{LightShape, LocalNeeds, ViewNeed};
pub(crate) use map_rect::{LightSpaceBounds, MapRect};
pub(crate) use predicted_error::{
    FRAMES_BETWEEN_PREDICTIONS, LARGEST_TEXEL_PIXELS, root_mean_error,
};
pub(crate) use reached::Reached;
pub(crate) use region::HalfSpaces;
pub(crate) use shadow_ray::{RayView, ShadowRay};
pub use split::CascadeSplit;
pub(crate) use split::MAX_CASCADES;
pub(crate) use square_packing::{Hold, Packing, side_texels};
pub(crate) use square_sizes::{SquareSizes, Wanted};
pub use stability::Stability;
pub use texel_rect::TexelRect;
pub(crate) use view::PerspectiveView;
pub use view::ShadowView;
pub(crate) use view_placement::ViewPlacement;
pub(crate) use visible::Receivers;
