//! Builds the tutorial's scene: a floor of 50 by 50, three cubes, and a sun that shines from (-2,
//! 4, -1) to the origin.

use example_support::mesh::{Instance, Object, Vertex, cube, square};
use glam::{Mat4, Quat, Vec3};
use wgpu_shadows::{
    Aabb, CameraView, CasterPipeline, Coverage, DirectionalLight, MeshCaster,
    caster::CasterPipelineDescriptor, caster::CasterVertex, caster::ModelTransform,
    caster::PositionAttribute, error::CasterError,
};

/// Selects what a step's map covers.
#[derive(Clone, Copy)]
pub enum MapRegion {
    /// Covers a box around the cubes, the same for every camera, as in the tutorial.
    FixedBox,
    /// Covers what the camera sees of the shadows.
    Camera,
}

impl MapRegion {
    /// Returns the region as the library takes it.
    pub fn coverage(self, cameras: &[CameraView]) -> Coverage<'_> {
        match self {
            Self::FixedBox => Coverage::Bounds(FIXED_BOX),
            Self::Camera => Coverage::Cameras(cameras),
        }
    }
}

/// Is the fixed box. It extends below the floor, so that the floor is drawn into the map, and a
/// little beyond the cubes' shadows. The map's far plane then cuts the floor in sight of the
/// camera, about where the tutorial's does.
const FIXED_BOX: Aabb = Aabb::new(Vec3::new(-9.0, -0.6, -9.0), Vec3::new(3.2, 2.2, 2.6));

/// Holds floor, cubes and sun.
pub struct Scene {
    pub floor: Object,
    pub cubes: [Object; 3],
    pub toward_light: Vec3,
}

impl Scene {
    pub fn new(device: &wgpu::Device) -> Self {
        let floor = Instance {
            render_from_model: Mat4::from_translation(Vec3::new(0.0, -0.5, 0.0))
                * Mat4::from_scale(Vec3::splat(25.0)),
            albedo: Vec3::new(0.58, 0.50, 0.40),
            checker: 0.12,
        };
        let mesh = cube();
        let cube = |center, half, rotation, albedo| {
            let scale = Vec3::splat(half);
            let instance = Instance {
                render_from_model: Mat4::from_scale_rotation_translation(scale, rotation, center),
                albedo,
                checker: 0.0,
            };
            Object::new(device, &mesh, instance)
        };
        let (red, green, blue) = (
            Vec3::new(0.75, 0.30, 0.20),
            Vec3::new(0.35, 0.55, 0.30),
            Vec3::new(0.25, 0.42, 0.70),
        );
        let upright = Quat::IDENTITY;
        let diagonal = Vec3::new(1.0, 0.0, 1.0).normalize();
        let tilted = Quat::from_axis_angle(diagonal, 60_f32.to_radians());
        Self {
            floor: Object::new(device, &square(Vec3::Y, 0.0), floor),
            cubes: [
                cube(Vec3::new(0.0, 1.5, 0.0), 0.5, upright, red),
                cube(Vec3::new(2.0, 0.0, 1.0), 0.5, upright, green),
                cube(Vec3::new(-1.0, 0.0, 2.0), 0.25, tilted, blue),
            ],
            toward_light: Vec3::new(-2.0, 4.0, -1.0).normalize(),
        }
    }

    /// Returns floor and cubes.
    pub fn objects(&self) -> impl Iterator<Item = &Object> {
        std::iter::once(&self.floor).chain(&self.cubes)
    }

    /// Returns all objects as casters. Faces of the kind `cull` are left out of the map: the floor,
    /// which has no back, is left out completely where fronts are culled.
    pub fn casters(
        &self,
        device: &wgpu::Device,
        cull: Option<wgpu::Face>,
    ) -> Result<Vec<MeshCaster>, CasterError> {
        let pipeline = CasterPipeline::new(
            device,
            &CasterPipelineDescriptor {
                label: Some("textbook caster"),
                vertex: CasterVertex::BuiltIn {
                    position: PositionAttribute::float32x3(size_of::<Vertex>() as u64),
                    model: ModelTransform::INSTANCE_MATRIX,
                },
                primitive: wgpu::PrimitiveState {
                    cull_mode: cull,
                    ..Default::default()
                },
                ..Default::default()
            },
        )?;
        self.objects()
            .map(|object| object.caster(device, &pipeline))
            .collect()
    }

    /// Returns the sun as the library takes it.
    pub fn sun(&self) -> DirectionalLight {
        DirectionalLight::new(-self.toward_light)
    }
}
