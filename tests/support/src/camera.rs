//! Provides cameras of every kind that engines have, with the rays of their pixels.

use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
use glam::{DMat3, DMat4, DVec3, DVec4, Vec3};
use wgpu_shadows::CameraView;

/// Is the aspect ratio of the images of generated scenes: width by height.
const ASPECT: f32 = 16.0 / 9.0;

/// Describes the position and orientation of a camera: view space is right-handed and looks along
/// -z.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    pub eye: DVec3,
    /// Has the columns right, up and backward in render space.
    pub axes: DMat3,
}

impl Pose {
    /// Returns the pose at `eye`, looking at `target`, with its upper side up.
    pub fn looking_at(eye: DVec3, target: DVec3) -> Self {
        let backward = (eye - target).normalize();
        let right = DVec3::Y.cross(backward).normalize();
        Self {
            eye,
            axes: DMat3::from_cols(right, backward.cross(right), backward),
        }
    }
}

/// Describes what a camera sees of the space before it.
#[derive(Clone, Copy, Debug)]
pub enum Lens {
    /// Has sides as tangents of angles (left, right, bottom, top), which need not be symmetric;
    /// `far` may be infinite.
    Perspective {
        sides: [f64; 4],
        near: f64,
        far: f64,
    },
    /// Has sides in world units.
    Orthographic {
        sides: [f64; 4],
        near: f64,
        far: f64,
    },
}

#[derive(Clone, Copy, Debug)]
pub struct Camera {
    pub pose: Pose,
    pub lens: Lens,
    /// States that depth is 1 at the near and 0 at the far plane instead of 0 and 1.
    pub reversed: bool,
}

impl Camera {
    /// Returns a symmetric perspective camera with an infinite reversed depth range, as modern
    /// engines have it.
    pub fn modern(eye: DVec3, target: DVec3, fov_y: f64, aspect: f64) -> Self {
        let top = (fov_y * 0.5).tan();
        Self {
            pose: Pose::looking_at(eye, target),
            lens: Lens::Perspective {
                sides: [-top * aspect, top * aspect, -top, top],
                near: 0.1,
                far: f64::INFINITY,
            },
            reversed: true,
        }
    }

    pub fn clip_from_view(&self) -> DMat4 {
        let (sides, perspective, near, far) = self.parts();
        let [left, right, bottom, top] = sides;
        let scale = (2.0 / (right - left), 2.0 / (top - bottom));
        let middle = (
            (right + left) / (right - left),
            (top + bottom) / (top - bottom),
        );
        // This is the depth before the division by w: `a * z + b` with z negative in front of the
        // camera.
        let (a, b) = match (perspective, self.reversed, far.is_finite()) {
            (true, false, true) => (far / (near - far), near * far / (near - far)),
            (true, false, false) => (-1.0, -near),
            (true, true, true) => (near / (far - near), near * far / (far - near)),
            (true, true, false) => (0.0, near),
            (false, false, _) => (-1.0 / (far - near), -near / (far - near)),
            (false, true, _) => (1.0 / (far - near), far / (far - near)),
        };
        let rows = if perspective {
            [
                DVec4::new(scale.0, 0.0, middle.0, 0.0),
                DVec4::new(0.0, scale.1, middle.1, 0.0),
                DVec4::new(0.0, 0.0, a, b),
                DVec4::new(0.0, 0.0, -1.0, 0.0),
            ]
        } else {
            [
                DVec4::new(scale.0, 0.0, 0.0, -middle.0),
                DVec4::new(0.0, scale.1, 0.0, -middle.1),
                DVec4::new(0.0, 0.0, a, b),
                DVec4::new(0.0, 0.0, 0.0, 1.0),
            ]
        };
        DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
    }

    pub fn view_from_render(&self) -> DMat4 {
        let rotation = self.pose.axes.transpose();
        DMat4::from_mat3_translation(rotation, -(rotation * self.pose.eye))
    }

    /// Returns the matrices as an engine passes them.
    pub fn view(&self) -> CameraView {
        CameraView::new(
            self.view_from_render().as_mat4(),
            self.clip_from_view().as_mat4(),
        )
    }

    /// Returns the ray through a position of the image, whose coordinates are in 0..1: its start,
    /// and its direction per unit of depth.
    pub fn ray(&self, across: f64, up: f64) -> (DVec3, DVec3) {
        let (sides, perspective, ..) = self.parts();
        let [left, right, bottom, top] = sides;
        let place = (left + (right - left) * across, bottom + (top - bottom) * up);
        let axes = self.pose.axes;
        let offset = axes.x_axis * place.0 + axes.y_axis * place.1;
        let forward = -axes.z_axis;
        if perspective {
            (self.pose.eye, forward + offset)
        } else {
            (self.pose.eye + offset, forward)
        }
    }

    /// Returns whether a point is in the image, nearer than `limit` along the view, and not within
    /// `margin` (a fraction of the image and of the depth) of its borders.
    pub fn sees(&self, point: DVec3, limit: f64, margin: f64) -> bool {
        let (sides, perspective, near, far) = self.parts();
        let [left, right, bottom, top] = sides;
        let place = self.pose.axes.transpose() * (point - self.pose.eye);
        let depth = -place.z;
        let slack = margin * depth.abs().max(near.abs());
        if depth < near + slack || depth > far.min(limit) - slack {
            return false;
        }
        let scale = if perspective { depth } else { 1.0 };
        let across = (place.x / scale - left) / (right - left);
        let up = (place.y / scale - bottom) / (top - bottom);
        let inner = margin..=1.0 - margin;
        inner.contains(&across) && inner.contains(&up)
    }

    fn parts(&self) -> ([f64; 4], bool, f64, f64) {
        match self.lens {
            Lens::Perspective { sides, near, far } => (sides, true, near, far),
            Lens::Orthographic { sides, near, far } => (sides, false, near, far),
        }
    }
}

/// Is the ray of a pixel, in render space.
#[derive(Clone, Copy, Debug)]
pub struct PixelRay {
    /// Is on the near plane.
    pub start: DVec3,
    /// Has unit length.
    pub direction: DVec3,
    /// Is the distance from the start to the far plane; infinite where there is none.
    pub reach: f64,
}

/// Returns a camera at `eye` that looks at `target`, right-handed, with reversed depth and without
/// a far plane, for images of 16 by 9.
pub fn looking(eye: Vec3, target: Vec3, fov_y_radians: f32) -> CameraView {
    perspective(eye, target, fov_y_radians, ASPECT)
}

/// Returns such a camera for images of any ratio of width to height.
pub fn perspective(eye: Vec3, target: Vec3, fov_y_radians: f32, aspect: f32) -> CameraView {
    CameraView::new(
        look_at_mat4(eye, target, Vec3::Y),
        perspective_infinite_reverse(fov_y_radians, aspect, 0.1),
    )
}

/// Returns the position of a camera in render space.
pub fn eye(camera: &CameraView) -> Vec3 {
    let render_from_view = camera.view_from_render.as_dmat4().inverse();
    render_from_view.w_axis.truncate().as_vec3()
}

/// Returns rays through the centres of the pixels, row by row from the top, of any projection with
/// reversed depth.
pub fn pixel_rays(
    camera: &CameraView,
    [width, height]: [u32; 2],
) -> impl Iterator<Item = PixelRay> + use<> {
    let clip_from_render = camera.clip_from_view.as_dmat4() * camera.view_from_render.as_dmat4();
    let render_from_clip = clip_from_render.inverse();
    (0..width * height).map(move |index| {
        let x = 2.0 * (f64::from(index % width) + 0.5) / f64::from(width) - 1.0;
        let y = 1.0 - 2.0 * (f64::from(index / width) + 0.5) / f64::from(height);
        pixel_ray(&render_from_clip, x, y)
    })
}

fn pixel_ray(render_from_clip: &DMat4, x: f64, y: f64) -> PixelRay {
    let at_depth = |depth: f64| *render_from_clip * DVec4::new(x, y, depth, 1.0);
    let (near, middle, far) = (at_depth(1.0), at_depth(0.5), at_depth(0.0));
    let place = |clip: DVec4| clip.truncate() / clip.w;
    let start = place(near);
    // Without a far plane w is zero there, except for rounding.
    let has_far = far.w > 1e-9 * near.w;
    PixelRay {
        start,
        direction: (place(middle) - start).normalize(),
        reach: if has_far {
            (place(far) - start).length()
        } else {
            f64::INFINITY
        },
    }
}
