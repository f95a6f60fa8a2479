//! Scenes in metres under one lamp, as people build them, and lights of every local kind for them with all else at its default.

use glam::{DVec3, Vec3};
use wgpu_shadows::{
    Aabb, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowCaster, ShadowViewUniform, SpotLight,
    SpotShadow, SpotShadowDescriptor, pool::OmniShadowPool, pool::PoolDescriptor, pool::PoolLight,
    pool::ShadowSlot, report::ShadowReport,
};

use crate::support::ask::{Ask, record_omni, record_spot, submitted};
use crate::support::camera::Camera;
use crate::support::frames::{OmniFrame, PoolFrame, RecordFrame, SpotFrame};
use crate::support::gpu::gpu;
use crate::support::local_truth::{Lookup, Settled, settled_in_view};
use crate::support::scene::{Mesh, Scene};

/// Texels per side of the maps: the default of [`OmniShadow`] and [`SpotShadow`].
const MAP_SIZE: u32 = 1024;

/// Half the angle of the spots' cones, in radians; they shine straight down.
const CONE: f64 = 1.2;

/// A scene under one light, before one camera.
pub struct Setting {
    pub name: &'static str,
    pub meshes: Vec<Mesh>,
    pub light: DVec3,
    pub camera: Camera,
}

/// How a lamp over a table is divided into meshes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shade {
    /// Each side of the shade is a mesh of its own, and no box contains the light.
    Panels,
    /// The shade is one mesh, whose box contains the light.
    OneMesh,
    /// The whole scene is one mesh.
    WholeScene,
}

/// One mesh of the triangles of all.
pub fn merged(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    for mesh in meshes {
        let first = all.positions.len() as u32;
        all.positions.extend(&mesh.positions);
        all.indices
            .extend(mesh.indices.iter().map(|index| first + index));
    }
    all
}

fn cuboid(low: [f32; 3], high: [f32; 3]) -> Mesh {
    Mesh::cuboid(low.into(), high.into())
}

fn camera(eye: [f64; 3], target: [f64; 3]) -> Camera {
    Camera::modern(eye.into(), target.into(), 1.1, 1.5)
}

/// The sides and the lid of a shade that is open below, all of them `half` away from the light.
pub fn shade(light: DVec3, half: f64) -> Vec<Mesh> {
    let corner = |x: f64, y: f64, z: f64| (light + DVec3::new(x, y, z) * half).as_vec3();
    let side = 2.0 * half as f32;
    let (across, along, up) = (Vec3::X * side, Vec3::Z * side, Vec3::Y * 0.9 * side);
    vec![
        Mesh::sheet(corner(-1.0, -0.8, -1.0), across, up),
        Mesh::sheet(corner(-1.0, -0.8, 1.0), across, up),
        Mesh::sheet(corner(-1.0, -0.8, -1.0), along, up),
        Mesh::sheet(corner(1.0, -0.8, -1.0), along, up),
        Mesh::sheet(corner(-1.0, 1.0, -1.0), across, along),
    ]
}

/// A lamp in a shade of 0.12 over a table with a cup, on a ground of half side `ground`. The leg of a chair stands 1 mm deep in
/// the ground, so that the ground is among the casters.
pub fn lamp_over_table(kind: Shade, ground: f32) -> Setting {
    let light = DVec3::new(0.3, 1.4, 0.2);
    let mut meshes = vec![
        Mesh::floor(0.0, ground),
        cuboid([-0.4, 0.7, -0.5], [0.8, 0.75, 0.5]),
        cuboid([0.5, 0.75, 0.3], [0.58, 0.85, 0.38]),
        cuboid([1.2, -0.001, -0.2], [1.3, 0.5, -0.1]),
    ];
    let shade = shade(light, 0.12);
    let (name, meshes) = match kind {
        Shade::Panels => {
            meshes.extend(shade);
            ("a shade of panels", meshes)
        }
        Shade::OneMesh => {
            meshes.push(merged(&shade));
            ("a shade of one mesh", meshes)
        }
        Shade::WholeScene => {
            meshes.extend(shade);
            ("a scene of one mesh", vec![merged(&meshes)])
        }
    };
    Setting {
        name,
        meshes,
        light,
        camera: camera([2.5, 2.2, 3.0], [0.2, 0.6, 0.1]),
    }
}

/// A street lamp whose post ends 5 cm below the light, a house and a crate, on a ground of half side `ground`.
pub fn street_lamp(ground: f32) -> Setting {
    Setting {
        name: "a post below",
        meshes: vec![
            Mesh::floor(0.0, ground),
            cuboid([-0.05, -0.001, -0.05], [0.05, 3.95, 0.05]),
            cuboid([4.0, 0.0, -7.0], [9.0, 5.0, -3.0]),
            cuboid([4.5, 0.0, 1.0], [5.1, 0.6, 1.7]),
        ],
        light: DVec3::new(0.0, 4.0, 0.0),
        camera: camera([6.0, 3.5, 9.0], [0.0, 0.5, 0.0]),
    }
}

/// A room of 8 by 5 by 8 with solids, its lamp well below the ceiling.
pub fn room() -> Setting {
    Setting {
        name: "a room",
        meshes: vec![
            cuboid([-4.0, 0.0, -4.0], [4.0, 5.0, 4.0]),
            cuboid([1.9, 0.0, -0.2], [3.1, 1.2, 1.0]),
            cuboid([-2.5, 1.3, 1.6], [-1.5, 2.3, 2.6]),
            cuboid([-1.8, 0.0, -1.6], [-1.0, 0.8, -0.8]),
            cuboid([0.1, 3.3, -0.7], [0.7, 3.9, -0.1]),
        ],
        light: DVec3::new(0.2, 4.5, -0.1),
        camera: camera([3.0, 1.7, 3.0], [0.0, 1.5, 0.0]),
    }
}

/// A local light of some kind.
pub enum Lamp {
    Omni(OmniShadow),
    Spot(SpotShadow),
    Pool(OmniShadowPool, ShadowSlot),
}

impl Lamp {
    /// A point light, a spot that shines straight down, and a point light of a pool.
    pub fn each_kind() -> [Self; 3] {
        let device = &gpu().device;
        let descriptor = PoolDescriptor {
            capacity: 1,
            map_size: MAP_SIZE,
            ..Default::default()
        };
        let mut pool = OmniShadowPool::new(device, &descriptor).expect("a pool");
        let slot = pool.insert().expect("a free slot");
        [Self::omni(), Self::spot(), Self::Pool(pool, slot)]
    }

    pub fn omni() -> Self {
        let descriptor = OmniShadowDescriptor::default();
        Self::Omni(OmniShadow::new(&gpu().device, &descriptor).expect("a lamp"))
    }

    pub fn spot() -> Self {
        let descriptor = SpotShadowDescriptor::default();
        Self::Spot(SpotShadow::new(&gpu().device, &descriptor).expect("a spot"))
    }

    pub fn name(&self) -> &'static str {
        match self {
            Self::Omni(_) => "lamp",
            Self::Spot(_) => "spot",
            Self::Pool(..) => "lamp of a pool",
        }
    }

    /// Records and submits a frame of the light at `light` with such a range; without a camera everything counts.
    pub fn record(
        &mut self,
        light: DVec3,
        range: f32,
        camera: Option<&Camera>,
        casters: &[&dyn ShadowCaster],
        receivers: &[Aabb],
    ) -> ShadowReport {
        let (gpu, origin, camera) = (gpu(), DVec3::ZERO, camera.map(Camera::view));
        let omni = OmniLight {
            position_world: light,
            range,
        };
        match self {
            Self::Omni(lamp) => {
                let frame = OmniFrame {
                    origin,
                    light: omni,
                    camera,
                    casters,
                    receivers,
                };
                record_omni(gpu, lamp, &frame)
            }
            Self::Spot(spot) => {
                let frame = SpotFrame {
                    origin,
                    light: SpotLight {
                        position_world: light,
                        direction: Vec3::NEG_Y,
                        outer_angle_radians: CONE as f32,
                        range,
                    },
                    camera,
                    casters,
                    receivers,
                };
                record_spot(gpu, spot, &frame)
            }
            Self::Pool(pool, slot) => {
                let frame = PoolFrame {
                    origin,
                    lights: &[PoolLight {
                        slot: *slot,
                        light: omni,
                        importance: 1.0,
                    }],
                    camera,
                    casters,
                    receivers,
                    max_views: None,
                };
                submitted(gpu, |encoder| pool.record_frame(encoder, &frame))
            }
        }
        .expect("a frame")
    }

    /// Returns how far aside the footprint of a lookup reaches, as a tangent seen from the light:
    /// the reach of the default filter, half a texel of stairs and the residual offset, toward a
    /// map's corner along both axes at once.
    pub fn footprint_tangent(&self) -> f64 {
        let half_side = match self {
            Self::Spot(_) => CONE.tan(),
            Self::Omni(_) | Self::Pool(..) => 1.0,
        };
        3.5 * 2.0_f64.sqrt() * 1.05 * 2.0 * half_side / f64::from(MAP_SIZE)
    }

    /// Discards what the light keeps of earlier frames.
    pub fn reset_history(&mut self) {
        match self {
            Self::Omni(lamp) => lamp.reset_history(),
            Self::Spot(spot) => spot.reset_history(),
            Self::Pool(pool, _) => pool.reset_history(),
        }
    }

    pub fn ask(&self) -> Ask {
        match self {
            Self::Omni(lamp) => Ask::light(gpu(), lamp.maps()),
            Self::Spot(spot) => Ask::light(gpu(), spot.maps()),
            Self::Pool(pool, slot) => Ask::slot(gpu(), pool.maps(), slot.index()),
        }
    }

    pub fn uniforms(&self) -> &[ShadowViewUniform] {
        match self {
            Self::Omni(lamp) => lamp.maps().view_uniforms(),
            Self::Spot(spot) => spot.maps().view_uniforms(),
            Self::Pool(pool, _) => pool.maps().view_uniforms(),
        }
    }

    /// The receivers that the camera of `setting` sees and the light shines on, and that are settled: around them, `lift` above
    /// them along the normal, and a share `nearer` of their way to the light.
    pub fn truth(&self, setting: &Setting, scene: &Scene, rounding: (f64, f64)) -> Settled {
        self.truth_of_pixels(setting, scene, rounding, (150, 100))
    }

    /// The same for an image of `pixels`.
    pub fn truth_of_pixels(
        &self,
        setting: &Setting,
        scene: &Scene,
        (lift, nearer): (f64, f64),
        pixels: (u32, u32),
    ) -> Settled {
        let is_spot = matches!(self, Self::Spot(_));
        let light = setting.light;
        let in_cone = |position: DVec3| {
            !is_spot || (position - light).angle_between(DVec3::NEG_Y) < CONE - 0.02
        };
        settled_in_view(
            &scene.triangles,
            &setting.camera,
            pixels,
            &Lookup {
                light,
                tangent: self.footprint_tangent(),
                lift,
                nearer,
            },
            in_cone,
        )
    }
}
