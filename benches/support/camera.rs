//! Provides the cameras of scenes.

use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
use glam::{DMat4, DVec3, Vec3};
use wgpu_shadows::CameraView;

/// Is the aspect ratio of the images of generated scenes: width by height.
const ASPECT: f32 = 16.0 / 9.0;

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

/// Returns a camera at `eye` that looks at `target`, right-handed, with reversed depth and without a far plane.
pub fn looking(eye: Vec3, target: Vec3, fov_y_radians: f32) -> CameraView {
    CameraView::new(
        look_at_mat4(eye, target, Vec3::Y),
        perspective_infinite_reverse(fov_y_radians, ASPECT, 0.1),
    )
}

/// Returns the position of a camera in render space.
pub fn eye(camera: &CameraView) -> Vec3 {
    let render_from_view = camera.view_from_render.as_dmat4().inverse();
    render_from_view.w_axis.truncate().as_vec3()
}

/// Returns rays through the centres of the pixels, row by row from the top, of any projection with reversed depth.
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
    let at_depth = |depth: f64| *render_from_clip * glam::DVec4::new(x, y, depth, 1.0);
    let (near, middle, far) = (at_depth(1.0), at_depth(0.5), at_depth(0.0));
    let place = |clip: glam::DVec4| clip.truncate() / clip.w;
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
