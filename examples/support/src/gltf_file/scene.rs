//! Defines a scene once it is loaded. World space is f64; render space is world minus the camera's
//! position, in f32.

use glam::camera::rh::proj::directx as proj;
use glam::{DMat4, DVec3, Mat4, Vec3, Vec4};
use wgpu_shadows::{Aabb, CameraView};

/// Is a vertex as the shaders read it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Vertex {
    /// Is in model space.
    pub position: [f32; 3],
    /// Is in model space; zero where the file has none, in which case the facet's own is used.
    pub normal: [f32; 3],
    /// Holds the texture coordinates of the base colour.
    pub uv: [f32; 2],
}

/// Is a triangle list of one material.
pub struct Mesh {
    pub vertices: Vec<Vertex>,
    pub indices: Vec<u32>,
    pub material: usize,
}

/// Holds base colour and sidedness.
#[derive(Clone, Copy)]
pub struct Material {
    pub base_color: Vec4,
    /// Is the index into the scene's images.
    pub image: Option<usize>,
    pub double_sided: bool,
    /// Makes fragments of less alpha holes; 0 for a solid material.
    pub alpha_cutoff: f32,
}

/// Is an image in RGBA, 8 bits, sRGB.
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub rgba: Vec<u8>,
}

/// Is a mesh with its transform.
pub struct Instance {
    pub mesh: usize,
    pub render_from_model: Mat4,
    /// Holds the exact bounds of the transformed vertices.
    pub bounds_render: Aabb,
}

/// Lists the kinds of `KHR_lights_punctual`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    Directional,
    Point,
    Spot {
        inner_cone_radians: f32,
        outer_cone_radians: f32,
    },
}

impl LightKind {
    /// Returns half of the angle that a spot light spans, which is slightly below a right angle at
    /// most.
    pub fn outer_angle_radians(self) -> f32 {
        match self {
            Self::Spot {
                outer_cone_radians, ..
            } => outer_cone_radians.clamp(1e-3, 1.57),
            Self::Directional | Self::Point => std::f32::consts::PI,
        }
    }
}

/// Is a light of the file.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    pub kind: LightKind,
    /// Is the linear colour times intensity: lux for directional lights, candela for the others.
    pub intensity: Vec3,
    /// Is the direction in which it shines, of unit length.
    pub direction: Vec3,
    pub position_render: Vec3,
    /// Is the distance beyond which it gives no light; infinite where the file does not state one.
    pub range: f32,
}

/// Holds a file, ready to be drawn.
pub struct Scene {
    /// Is the world position of render space's origin: the camera.
    pub origin: DVec3,
    pub camera: CameraView,
    pub meshes: Vec<Mesh>,
    pub materials: Vec<Material>,
    pub images: Vec<Picture>,
    pub instances: Vec<Instance>,
    pub lights: Vec<Light>,
    /// Lists what was omitted or invented.
    pub notes: Vec<String>,
}

impl Scene {
    /// Returns the bounds of everything, in render space.
    pub fn bounds_render(&self) -> Aabb {
        self.instances.iter().fold(Aabb::EMPTY, |bounds, instance| {
            bounds.union(instance.bounds_render)
        })
    }

    pub fn triangle_count(&self) -> usize {
        self.instances
            .iter()
            .map(|instance| self.meshes[instance.mesh].indices.len() / 3)
            .sum()
    }
}

/// Is a perspective or orthographic lens, with reversed depth.
#[derive(Clone, Copy, Debug)]
pub enum Lens {
    Perspective {
        fov_y_radians: f32,
        near: f32,
        far: Option<f32>,
    },
    Orthographic {
        half_height: f32,
        near: f32,
        far: f32,
    },
}

impl Lens {
    /// Returns the matrix to clip space (depth 1 near, 0 far) from view space.
    pub fn clip_from_view(&self, aspect: f32) -> Mat4 {
        match *self {
            // Exchanging near and far reverses the depth.
            Self::Perspective {
                fov_y_radians,
                near,
                far: Some(far),
            } => proj::perspective(fov_y_radians, aspect, far, near),
            Self::Perspective {
                fov_y_radians,
                near,
                far: None,
            } => proj::perspective_infinite_reverse(fov_y_radians, aspect, near),
            Self::Orthographic {
                half_height,
                near,
                far,
            } => {
                let half_width = half_height * aspect;
                proj::orthographic(
                    -half_width,
                    half_width,
                    -half_height,
                    half_height,
                    far,
                    near,
                )
            }
        }
    }
}

/// Returns camera and origin of a camera that stands at `world_from_view`.
pub fn camera_view(world_from_view: &DMat4, lens: &Lens, aspect: f32) -> (DVec3, CameraView) {
    let origin = world_from_view.w_axis.truncate();
    // glTF cameras ignore scale, and view matrices are rigid.
    let right = world_from_view.x_axis.truncate().normalize_or(DVec3::X);
    let back = world_from_view.z_axis.truncate();
    let back = (back - right * back.dot(right)).normalize_or(DVec3::Z);
    let view_from_render = glam::DMat3::from_cols(right, back.cross(right), back).transpose();
    let view_from_render = Mat4::from_mat3(view_from_render.as_mat3());
    (
        origin,
        CameraView::new(view_from_render, lens.clip_from_view(aspect)),
    )
}
