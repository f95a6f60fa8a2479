//! Turns the engine's camera, given as any pair of matrices, into half-spaces and depth along the
//! view.

use glam::{BVec3, DMat4, DVec2, DVec3, DVec4, Mat4};

use crate::fit::image_corners::{ImageCorners, SliceSphere};
use crate::fit::region::{HalfSpace, HalfSpaces};
use crate::{Aabb, ShadowError};

/// Describes the camera for whose image the shadows are rendered.
///
/// Any projection with WebGPU's clip volume (`-w ≤ x, y ≤ w`, `0 ≤ z ≤ w`) is accepted: perspective
/// with finite or infinite far plane, forward or reversed depth, off-centre, orthographic. Only the
/// volume counts, not the depth convention.
///
/// A matrix that is not finite or has no finite inverse makes
/// [`ShadowScene::frame`](crate::ShadowScene::frame) return [`ShadowError::CameraMatrix`]. Matrices
/// of another camera than the one that draws the image leave receivers outside the maps, and these
/// are then lit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraView {
    /// Transforms render space to view space; a rigid transform in all but exotic engines. Its
    /// translation must be relative to the frame's `origin`, as render space is.
    pub view_from_render: Mat4,
    /// Transforms view space to clip space. An orthographic camera is taken to look along -z of
    /// view space; a perspective one looks in the direction in which its w grows.
    pub clip_from_view: Mat4,
    /// Is the distance along the view, in world units, beyond which receivers are left lit: above
    /// 0, infinity allowed. Any other value is [`ShadowError::OutOfRange`]. `f32::INFINITY` (the
    /// default of [`CameraView::new`]) covers all that the projection and the receivers' bounds
    /// make visible. Too large a value costs resolution; too small a value ends the shadows in
    /// plain sight.
    ///
    /// A directional light's shadows end at this depth, on a plane across the view. Several cameras
    /// share the farthest of their planes if all of them have a distance and look the same way to
    /// within 20 degrees, as the eyes of a headset do; otherwise shadows end where the maps end.
    /// Shadows of spot and point lights end at the light's range instead; beyond this distance
    /// nothing is fitted to, so that they may be missing there.
    pub max_distance: f32,
}

impl CameraView {
    /// Makes a camera with no distance limit of its own.
    pub const fn new(view_from_render: Mat4, clip_from_view: Mat4) -> Self {
        Self {
            view_from_render,
            clip_from_view,
            max_distance: f32::INFINITY,
        }
    }

    /// Returns the same camera with shadows out to `max_distance` world units along the view.
    pub const fn with_max_distance(self, max_distance: f32) -> Self {
        Self {
            max_distance,
            ..self
        }
    }

    /// Returns the visible volume in render space. `camera` is the index in the frame's list, for
    /// errors.
    pub(crate) fn frustum(&self, camera: usize) -> Result<CameraFrustum, ShadowError> {
        const VIEW: &str = "CameraView::view_from_render";
        let view_from_render = checked(&self.view_from_render, VIEW, camera)?;
        let clip_from_view = checked(&self.clip_from_view, "CameraView::clip_from_view", camera)?;
        if self.max_distance.is_nan() || self.max_distance <= 0.0 {
            return Err(ShadowError::OutOfRange {
                field: "CameraView::max_distance",
                rule: "above 0 (infinity allowed)",
                value: self.max_distance.to_string(),
            });
        }
        let clip_from_render = clip_from_view * view_from_render;
        let rows = [0, 1, 2, 3].map(|row| clip_from_render.row(row));
        let sides = [
            rows[3] + rows[0],
            rows[3] - rows[0],
            rows[3] + rows[1],
            rows[3] - rows[1],
            rows[2],
            rows[3] - rows[2],
        ];
        let mut planes = HalfSpaces::default();
        for side in sides {
            // An infinite far plane has no direction and keeps everything: w - z is a constant, or
            // vanishes at this scale.
            let scale = rows[3].truncate().length() + side.w.abs();
            if side.truncate().length() > 1e-12 * scale {
                planes.push(HalfSpace::from_homogeneous(side));
            }
        }
        let w_row = clip_from_view.row(3);
        let forward_view = if w_row.truncate().length() > 1e-12 * w_row.w.abs() {
            w_row.truncate().normalize()
        } else {
            DVec3::NEG_Z
        };
        let render_from_view = view_from_render.inverse();
        let eye = render_from_view.transform_point3(DVec3::ZERO);
        let forward = render_from_view.transform_vector3(forward_view).normalize();
        if !(eye.is_finite() && forward.is_finite()) {
            return Err(camera_matrix(VIEW, camera, &self.view_from_render));
        }
        if self.max_distance.is_finite() {
            planes.push(HalfSpace {
                normal: -forward,
                offset: forward.dot(eye) + f64::from(self.max_distance),
            });
        }
        Ok(CameraFrustum {
            planes,
            clip_from_render,
            eye,
            forward,
            render_from_view,
            corners: ImageCorners::new(&clip_from_view, forward_view),
            max_distance: f64::from(self.max_distance),
        })
    }
}

/// Holds the volume that a camera sees, in render space.
#[derive(Debug)]
pub(crate) struct CameraFrustum {
    pub planes: HalfSpaces,
    clip_from_render: DMat4,
    eye: DVec3,
    forward: DVec3,
    render_from_view: DMat4,
    corners: ImageCorners,
    max_distance: f64,
}

impl CameraFrustum {
    /// Returns the depths along the view at which the volume begins and ends, whatever is in it;
    /// the end may be infinite.
    pub(crate) fn depth_range(&self) -> (f64, f64) {
        let corners = &self.corners;
        (corners.depth_near, corners.depth_far.min(self.max_distance))
    }

    /// Returns whether the image is equally high at all depths.
    pub(crate) fn is_orthographic(&self) -> bool {
        let (near, far) = (self.image_height(0.0), self.image_height(1.0));
        (near - far).abs() <= 1e-9 * near
    }

    /// Returns the distance limit in world units; infinite if there is no limit.
    pub(crate) fn max_distance(&self) -> f64 {
        self.max_distance
    }

    /// Returns the unit vector along the view.
    pub(crate) fn forward(&self) -> DVec3 {
        self.forward
    }

    /// Returns the world height of the image at a depth along the view. It is infinite where the
    /// image's corners are at infinity, which happens under sufficiently oblique projections.
    pub(crate) fn image_height(&self, depth: f64) -> f64 {
        let [bottom, _, top, _] = self.corners.at(depth);
        let height = bottom.distance(top);
        if height.is_nan() {
            f64::INFINITY
        } else {
            height
        }
    }

    /// Returns the ray through a place of the image, from 0 to 1 along x and y: its point at depth
    /// zero, and what a unit of depth along the view adds.
    pub(crate) fn ray(&self, place: DVec2) -> (DVec3, DVec3) {
        let at = |depth| {
            let [bottom_left, bottom_right, top_left, top_right] = self.corners.at(depth);
            let bottom = bottom_left.lerp(bottom_right, place.x);
            bottom.lerp(top_left.lerp(top_right, place.x), place.y)
        };
        let (start, next) = (at(0.0), at(1.0));
        (
            self.render_from_view.transform_point3(start),
            self.render_from_view.transform_vector3(next - start),
        )
    }

    /// Returns the corners of a rectangle of the image, in the coordinates of
    /// [`ray`](Self::ray), outside of which no ray meets the box. It extends to infinity where part
    /// of the box is behind the camera.
    pub(crate) fn image_rect(&self, bounds: &Aabb) -> (DVec2, DVec2) {
        /// Is the distance by which the rectangle is larger than the box, for rounding.
        const MARGIN: f64 = 1e-6;
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        for corner in 0..8 {
            let chosen = BVec3::new(corner & 1 != 0, corner & 2 != 0, corner & 4 != 0);
            let clip = self.clip_from_render * DVec3::select(chosen, high, low).extend(1.0);
            let place = clip.truncate().truncate() / clip.w * 0.5 + 0.5;
            if clip.w <= 0.0 || !place.is_finite() {
                return (DVec2::NEG_INFINITY, DVec2::INFINITY);
            }
            (min, max) = (min.min(place), max.max(place));
        }
        let margin = MARGIN * (1.0 + min.abs().max(max.abs()));
        (min - margin, max + margin)
    }

    /// Returns a sphere that holds the slice between two depths along the view.
    pub(crate) fn slice_sphere(&self, depth_near: f64, depth_far: f64) -> SliceSphere {
        let (center, radius) = self.corners.sphere_in_view(depth_near, depth_far);
        SliceSphere {
            center_render: self.render_from_view.transform_point3(center),
            radius,
        }
    }

    /// Returns the camera's position in render space.
    pub(crate) fn eye(&self) -> DVec3 {
        self.eye
    }

    /// Returns the depth of a point along the view in world units.
    pub(crate) fn depth(&self, point_render: DVec3) -> f64 {
        self.forward.dot(point_render - self.eye)
    }

    /// Returns the part of the volume between two depths along the view.
    pub(crate) fn slice(&self, depth_near: f64, depth_far: f64) -> HalfSpaces {
        let mut planes = self.planes;
        let at_eye = self.forward.dot(self.eye);
        planes.push(HalfSpace {
            normal: self.forward,
            offset: -at_eye - depth_near,
        });
        planes.push(HalfSpace {
            normal: -self.forward,
            offset: at_eye + depth_far,
        });
        planes
    }
}

fn checked(matrix: &Mat4, field: &'static str, camera: usize) -> Result<DMat4, ShadowError> {
    let matrix_double = matrix.as_dmat4();
    // The determinant's own magnitude says nothing (a scale of 1e-5 gives 1e-20); that the inverse
    // is finite does.
    if matrix.is_finite()
        && matrix_double.determinant() != 0.0
        && matrix_double.inverse().is_finite()
    {
        Ok(matrix_double)
    } else {
        Err(camera_matrix(field, camera, matrix))
    }
}

fn camera_matrix(field: &'static str, camera: usize, matrix: &Mat4) -> ShadowError {
    ShadowError::CameraMatrix {
        field,
        camera,
        value: matrix.to_string(),
    }
}

impl HalfSpace {
    fn from_homogeneous(plane: DVec4) -> Self {
        let length = plane.truncate().length();
        Self {
            normal: plane.truncate() / length,
            offset: plane.w / length,
        }
    }
}
