//! Builds a room of ten metres with five cubes in it, and moves the light.

use std::f32::consts::PI;

use example_support::camera::Camera;
use example_support::mesh::{Instance, Object, Vertex, cube, inside_out, sphere};
use glam::{Mat4, Quat, Vec3};
use wgpu_shadows::{
    Aabb, CasterPipeline, MeshCaster, ShadowCaster, caster::CasterPipelineDescriptor,
    caster::CasterVertex, caster::ModelTransform, caster::PositionAttribute, error::CasterError,
};

/// Is half the side of the room.
const HALF: f32 = 5.0;

/// Holds walls and cubes, and which of them cast.
pub struct Room {
    walls: Object,
    cubes: Vec<Object>,
    casters: Vec<MeshCaster>,
    wall_caster: MeshCaster,
}

impl Room {
    pub fn new(device: &wgpu::Device) -> Result<Self, CasterError> {
        let mesh = cube();
        let walls = Instance {
            render_from_model: Mat4::from_scale(Vec3::splat(HALF)),
            albedo: Vec3::new(0.62, 0.54, 0.45),
            checker: 0.08,
        };
        let walls = Object::new(device, &inside_out(&mesh), walls);
        let tilted = Quat::from_axis_angle(Vec3::new(1.0, 0.0, 1.0).normalize(), PI / 3.0);
        let upright = Quat::IDENTITY;
        let cubes: Vec<Object> = [
            (Vec3::new(4.0, -3.5, 0.0), 0.5, upright, [0.75, 0.30, 0.20]),
            (Vec3::new(2.0, 3.0, 1.0), 0.75, upright, [0.35, 0.55, 0.30]),
            (Vec3::new(-3.0, -1.0, 0.0), 0.5, upright, [0.25, 0.42, 0.70]),
            (Vec3::new(-1.5, 1.0, 1.5), 0.5, upright, [0.72, 0.62, 0.22]),
            (Vec3::new(-1.5, 2.0, -3.0), 0.75, tilted, [0.55, 0.35, 0.60]),
        ]
        .into_iter()
        .map(|(center, half, turn, albedo)| {
            let scale = Vec3::splat(half);
            let instance = Instance {
                render_from_model: Mat4::from_scale_rotation_translation(scale, turn, center),
                albedo: albedo.into(),
                checker: 0.0,
            };
            Object::new(device, &mesh, instance)
        })
        .collect();
        let pipeline = caster_pipeline(device)?;
        Ok(Self {
            casters: cubes
                .iter()
                .map(|cube| cube.caster(device, &pipeline))
                .collect::<Result<_, _>>()?,
            wall_caster: walls.caster(device, &pipeline)?,
            walls,
            cubes,
        })
    }

    /// Returns everything that is drawn except the light.
    pub fn objects(&self) -> impl Iterator<Item = &Object> {
        std::iter::once(&self.walls).chain(&self.cubes)
    }

    /// Returns the cubes as casters.
    pub fn cubes(&self) -> Vec<&dyn ShadowCaster> {
        self.casters.iter().map(|caster| caster as _).collect()
    }

    /// Returns cubes and walls as casters. Nothing lies behind the walls, so that they need not
    /// cast; here they do, to be seen in the map.
    pub fn cubes_and_walls(&self) -> Vec<&dyn ShadowCaster> {
        let mut casters = self.cubes();
        casters.push(&self.wall_caster);
        casters
    }

    /// Returns the walls as boxes without thickness, since they receive.
    pub fn walls(&self) -> [Aabb; 6] {
        [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z].map(|out| {
            let along = (Vec3::ONE - out.abs()) * HALF;
            Aabb::new(out * HALF - along, out * HALF + along)
        })
    }
}

/// Returns a camera in a corner that looks across the room.
pub fn camera(size: [u32; 2]) -> Camera {
    let eye = Vec3::new(4.6, -0.4, 4.8);
    Camera::new(eye, Vec3::new(-1.2, -0.6, -1.8), 1.3, size)
}

/// Returns the position of the light in frame `index` of `count`: half a swing of the tutorial's,
/// along z through the middle.
pub fn lamp_place(index: u32, count: u32) -> Vec3 {
    let share = (index as f32 + 0.5) / count as f32;
    Vec3::new(0.0, 0.0, 3.0 * (PI * (share - 0.5)).sin())
}

/// Returns a glowing ball at the light. It casts nothing, since all of its light comes from inside.
pub fn bulb(device: &wgpu::Device, place: Vec3) -> Object {
    let instance = Instance {
        render_from_model: Mat4::from_translation(place) * Mat4::from_scale(Vec3::splat(0.08)),
        // The light does not reach its outside; this makes the ambient light on it white.
        albedo: Vec3::splat(20.0),
        checker: 0.0,
    };
    Object::new(device, &sphere(12), instance)
}

fn caster_pipeline(device: &wgpu::Device) -> Result<CasterPipeline, CasterError> {
    CasterPipeline::new(
        device,
        &CasterPipelineDescriptor {
            label: Some("room caster"),
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(size_of::<Vertex>() as u64),
                model: ModelTransform::INSTANCE_MATRIX,
            },
            ..Default::default()
        },
    )
}
