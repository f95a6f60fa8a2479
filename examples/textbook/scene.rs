//! Holds the tutorial's scene on the device, and what its maps cover.

use example_support::mesh::{Object, Vertex};
use example_support::textbook;
use glam::Vec3;
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
        let [floor, cubes @ ..] =
            textbook::parts().map(|(mesh, instance)| Object::new(device, &mesh, instance));
        Self {
            floor,
            cubes,
            toward_light: textbook::TOWARD_SUN.normalize(),
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
