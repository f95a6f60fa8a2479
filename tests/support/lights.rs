//! Provides one light of every kind over the same small scene, for tests of what all kinds have in common.

use glam::{DVec3, Vec3};
use wgpu_shadows::{
    Aabb, Bias, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor, Filter,
    OmniLight, OmniShadow, OmniShadowDescriptor, ShadowMaps, SpotLight, SpotShadow,
    SpotShadowDescriptor, pool::OmniShadowPool, pool::PoolDescriptor, pool::PoolLight,
    pool::SpotShadowPool,
};

use crate::support::ask::{record_omni, record_spot, submitted};
use crate::support::camera::Camera;
use crate::support::frames::{
    Coverage, DirectionalFrame, OmniFrame, PoolFrame, RecordFrame, SpotFrame,
};
use crate::support::gpu::Gpu;
use crate::support::probe::record;
use crate::support::scene::{Mesh, Scene};

/// Is a light of any kind.
pub trait Light {
    fn maps(&self) -> &ShadowMaps;
}

macro_rules! light {
    ($($kind:ty),*) => {
        $(impl Light for $kind {
            fn maps(&self) -> &ShadowMaps {
                <$kind>::maps(self)
            }
        })*
    };
}
light!(
    DirectionalShadow,
    SpotShadow,
    OmniShadow,
    SpotShadowPool,
    OmniShadowPool
);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Is a sun with that many cascades, which blend into each other over a tenth of their width or end at once.
    Sun {
        cascades: u32,
        blends: bool,
    },
    Spot,
    Lamp,
    /// Is a pool of spot lights in which the light is in both of two slots.
    Spots,
    Lamps,
}

impl Kind {
    pub const ALL: [Self; 7] = [
        Self::Sun {
            cascades: 1,
            blends: false,
        },
        Self::Sun {
            cascades: 4,
            blends: false,
        },
        Self::Sun {
            cascades: 4,
            blends: true,
        },
        Self::Spot,
        Self::Lamp,
        Self::Spots,
        Self::Lamps,
    ];

    /// Returns whether the kind accepts direction-space filters.
    pub fn has_cube(self) -> bool {
        matches!(self, Self::Lamp | Self::Lamps)
    }

    /// Returns the WGSL that samples a light of this kind.
    pub fn call(self, name: &str, position: &str, normal: &str) -> String {
        let index = match self {
            Self::Spots | Self::Lamps => "1u, ",
            _ => "",
        };
        format!("shadow_{name}({index}{position}, {normal})")
    }

    /// Returns the light without any frame: everything is lit.
    pub fn blank(self, gpu: &Gpu, map_size: u32, filter: Filter, bias: Bias) -> Box<dyn Light> {
        let device = &gpu.device;
        match self {
            Self::Sun { .. } => Box::new(self.sun(gpu, map_size, filter, bias)),
            Self::Spot => Box::new(spot(gpu, map_size, filter, bias)),
            Self::Lamp => Box::new(lamp(gpu, map_size, filter, bias)),
            Self::Spots => {
                let pool = pool(map_size, filter, bias);
                Box::new(SpotShadowPool::new(device, &pool).expect("a valid pool"))
            }
            Self::Lamps => {
                let pool = pool(map_size, filter, bias);
                Box::new(OmniShadowPool::new(device, &pool).expect("a valid pool"))
            }
        }
    }

    /// Returns the light over `stage`, after one frame.
    pub fn lit(self, gpu: &Gpu, stage: &Scene, filter: Filter, bias: Bias) -> Box<dyn Light> {
        // The size is not a multiple of that of the images, so that no pixel lies between two texels.
        const MAP_SIZE: u32 = 97;
        let (device, casters) = (&gpu.device, stage.list());
        let sun = DirectionalLight::new(Vec3::new(0.5, -1.0, 0.3));
        let spot_light = SpotLight {
            position_world: PLACE,
            direction: -PLACE.as_vec3(),
            outer_angle_radians: 0.7,
            range: 9.0,
        };
        let omni_light = OmniLight {
            position_world: PLACE,
            range: 9.0,
        };
        match self {
            Self::Sun { .. } => {
                let mut shadow = self.sun(gpu, MAP_SIZE, filter, bias);
                let frame = DirectionalFrame {
                    origin: DVec3::ZERO,
                    light: sun,
                    coverage: Coverage::Camera(camera().view()),
                    casters: &casters,
                    receivers: &[],
                };
                record(gpu, &mut shadow, &frame);
                Box::new(shadow)
            }
            Self::Spot => {
                let mut shadow = spot(gpu, MAP_SIZE, filter, bias);
                let frame = SpotFrame {
                    origin: DVec3::ZERO,
                    light: spot_light,
                    camera: None,
                    casters: &casters,
                    receivers: &EVERYWHERE,
                };
                record_spot(gpu, &mut shadow, &frame).expect("a valid frame");
                Box::new(shadow)
            }
            Self::Lamp => {
                let mut shadow = lamp(gpu, MAP_SIZE, filter, bias);
                let frame = OmniFrame {
                    origin: DVec3::ZERO,
                    light: omni_light,
                    camera: None,
                    casters: &casters,
                    receivers: &EVERYWHERE,
                };
                record_omni(gpu, &mut shadow, &frame).expect("a valid frame");
                Box::new(shadow)
            }
            Self::Spots => {
                let pool = pool(MAP_SIZE, filter, bias);
                let mut pool = SpotShadowPool::new(device, &pool).expect("a valid pool");
                let slots = [(); 2].map(|()| pool.insert().expect("a free slot"));
                let lights = slots.map(|slot| in_pool(slot, spot_light));
                let frame = pool_frame(&lights, &casters);
                submitted(gpu, |encoder| pool.record_frame(encoder, &frame))
                    .expect("a valid frame");
                Box::new(pool)
            }
            Self::Lamps => {
                let pool = pool(MAP_SIZE, filter, bias);
                let mut pool = OmniShadowPool::new(device, &pool).expect("a valid pool");
                let slots = [(); 2].map(|()| pool.insert().expect("a free slot"));
                let lights = slots.map(|slot| in_pool(slot, omni_light));
                let frame = pool_frame(&lights, &casters);
                submitted(gpu, |encoder| pool.record_frame(encoder, &frame))
                    .expect("a valid frame");
                Box::new(pool)
            }
        }
    }

    fn sun(self, gpu: &Gpu, map_size: u32, filter: Filter, bias: Bias) -> DirectionalShadow {
        let Self::Sun { cascades, blends } = self else {
            unreachable!("only a sun has cascades");
        };
        let descriptor = DirectionalShadowDescriptor {
            map_size,
            cascades,
            filter,
            bias,
            blend: if blends { 0.1 } else { 0.0 },
            ..Default::default()
        };
        DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun")
    }
}

/// Returns a floor of four by four units around the origin, and a box on it, beside the middle.
pub fn stage(gpu: &Gpu) -> Scene {
    let solid = Mesh::cuboid(Vec3::new(-0.9, 0.0, -0.8), Vec3::new(-0.1, 0.9, 0.4));
    Scene::new(gpu, &[Mesh::floor(0.0, 2.0), solid])
}

/// Is the position of the local lights.
const PLACE: DVec3 = DVec3::new(-1.2, 2.6, -0.6);

const EVERYWHERE: [Aabb; 1] = [Aabb::new(Vec3::splat(-9.0), Vec3::splat(9.0))];

/// Returns a camera that sees the whole floor, which the cascades of suns cover.
pub fn camera() -> Camera {
    Camera::modern(DVec3::new(0.4, 4.0, 4.5), DVec3::ZERO, 0.9, 1.0)
}

fn spot(gpu: &Gpu, map_size: u32, filter: Filter, bias: Bias) -> SpotShadow {
    let descriptor = SpotShadowDescriptor {
        map_size,
        filter,
        bias,
        ..Default::default()
    };
    SpotShadow::new(&gpu.device, &descriptor).expect("a valid spot")
}

fn lamp(gpu: &Gpu, map_size: u32, filter: Filter, bias: Bias) -> OmniShadow {
    let descriptor = OmniShadowDescriptor {
        map_size,
        filter,
        bias,
        ..Default::default()
    };
    OmniShadow::new(&gpu.device, &descriptor).expect("a valid lamp")
}

fn pool(map_size: u32, filter: Filter, bias: Bias) -> PoolDescriptor<'static> {
    PoolDescriptor {
        capacity: 2,
        map_size,
        filter,
        bias,
        ..Default::default()
    }
}

fn in_pool<L>(slot: wgpu_shadows::pool::ShadowSlot, light: L) -> PoolLight<L> {
    PoolLight {
        slot,
        light,
        importance: 1.0,
    }
}

fn pool_frame<'a, L>(
    lights: &'a [PoolLight<L>],
    casters: &'a [&'a dyn wgpu_shadows::ShadowCaster],
) -> PoolFrame<'a, L> {
    PoolFrame {
        origin: DVec3::ZERO,
        lights,
        camera: None,
        casters,
        receivers: &EVERYWHERE,
        max_views: None,
    }
}
