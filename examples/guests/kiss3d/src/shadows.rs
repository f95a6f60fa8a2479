//! Faces `wgpu-shadows`: casters from kiss3d's objects, lights from its collection of lights.

use std::{collections::HashMap, error::Error};

use kiss3d::prelude::Context;
use wgpu_shadows::{caster::*, glam::DVec3, pool::*, *};

use crate::light::{Kind, Light};
use crate::object::{self, Placement, SceneObject};

/// Casts the shadow of one of kiss3d's objects with all its instances.
pub struct Caster(pub SceneObject, CasterPipeline);

impl ShadowCaster for Caster {
    fn bounds(&self) -> Aabb {
        let mesh = Aabb::from_points(self.0.vertices());
        let copies = self.0.copies().into_iter();
        copies.fold(Aabb::EMPTY, |all, copy| all.union(mesh.transformed(&copy)))
    }
    fn pipeline(&self) -> &CasterPipeline {
        &self.1
    }
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _: &ShadowView) {
        self.0.draw_positions(pass);
    }
    fn casts(&self) -> bool {
        self.0.casts()
    }
    fn revision(&self) -> Option<Revision> {
        Some(Revision::new(self.0.number.into(), self.0.version))
    }
}

/// Owns casters by the numbers that kiss3d gives its objects, a sun, and slots for other lights.
pub struct Shadows {
    scene: ShadowScene,
    pipeline: CasterPipeline,
    pub casters: CasterSet<Caster>,
    pub ids: HashMap<u32, CasterId>,
    pub sun: DirectionalShadow,
    pub spots: SpotShadowPool,
    pub lamps: OmniShadowPool,
    spot_slots: Vec<ShadowSlot>,
    lamp_slots: Vec<ShadowSlot>,
    pub bindings: ShadowBindings,
}

impl Shadows {
    pub fn new(object_layout: &wgpu::BindGroupLayout) -> Result<Self, Box<dyn Error>> {
        let device = &Context::get().device;
        let mut pool = PoolDescriptor::default();
        (pool.capacity, pool.map_size) = (4, 1024);
        let sun = DirectionalShadow::new(device, &Default::default())?;
        let mut spots = SpotShadowPool::new(device, &pool)?;
        let mut lamps = OmniShadowPool::new(device, &pool)?;
        let mut bindings = ShadowBindingsDescriptor::default();
        let lights = [
            ("sun", sun.maps()),
            ("spot", spots.maps()),
            ("lamp", lamps.maps()),
        ];
        (bindings.group, bindings.lights) = (2, &lights);
        Ok(Self {
            scene: ShadowScene::new(),
            pipeline: CasterPipeline::new(
                device,
                &CasterPipelineDescriptor {
                    vertex: CasterVertex::Wgsl {
                        source: &[object::WGSL, object::CASTER_WGSL].concat(),
                        vertex_entry: "object_caster",
                        fragment_entry: None,
                        buffers: &object::BUFFERS[..3],
                        bind_group_layouts: &[Some(object_layout)],
                    },
                    ..CasterPipelineDescriptor::new()
                },
            )?,
            casters: CasterSet::new(),
            ids: HashMap::new(),
            bindings: ShadowBindings::new(device, &bindings)?,
            spot_slots: (0..4).map(|_| spots.insert()).collect::<Result<_, _>>()?,
            lamp_slots: (0..4).map(|_| lamps.insert()).collect::<Result<_, _>>()?,
            sun,
            spots,
            lamps,
        })
    }

    /// Adds an object of the scene.
    pub fn insert(&mut self, object: SceneObject) {
        let number = object.number;
        let id = self.casters.insert(Caster(object, self.pipeline.clone()));
        self.ids.insert(number, id);
    }

    /// Tells how kiss3d draws an object in this frame.
    pub fn place(&mut self, number: u32, placement: Placement) -> Result<(), ShadowError> {
        let changed = |object: &SceneObject| object.changed(&placement);
        if self.get(number).is_some_and(changed) {
            let place = |caster: &mut Caster| caster.0.place(placement);
            self.casters.update(self.ids[&number], place)?;
        }
        Ok(())
    }

    /// Returns the object with a number, if it was inserted.
    pub fn get(&self, number: u32) -> Option<&SceneObject> {
        Some(&self.casters.get(*self.ids.get(&number)?)?.0)
    }

    /// Records what changed, for all cameras of the frame.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        cameras: &[CameraView],
        lights: &[Light],
    ) -> Result<(), ShadowError> {
        let frame = self.scene.frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(cameras),
            casters: Casters::Set(&self.casters),
            receivers: &[],
        })?;
        let of = |kind| lights.iter().filter(move |l| l.casts && l.kind == kind);
        if let Some(sun) = of(Kind::Sun).next() {
            let sun = DirectionalLight::new(sun.direction);
            self.sun.record(encoder, &frame, &sun)?;
        }
        let spots = in_slots(&self.spot_slots, of(Kind::Spot), |light| SpotLight {
            position_world: light.position.as_dvec3(),
            direction: light.direction,
            outer_angle_radians: light.cone[1],
            range: light.range,
        });
        self.spots.record(encoder, &frame, &spots, None)?;
        let lamps = in_slots(&self.lamp_slots, of(Kind::Lamp), |light| OmniLight {
            position_world: light.position.as_dvec3(),
            range: light.range,
        });
        self.lamps.record(encoder, &frame, &lamps, None)?;
        Ok(())
    }
}

/// Gives the first lights a slot each; the shader counts lights of a kind in the same order.
fn in_slots<'l, L>(
    slots: &[ShadowSlot],
    lights: impl Iterator<Item = &'l Light>,
    light: impl Fn(&Light) -> L,
) -> Vec<PoolLight<L>> {
    let pooled = |(slot, light)| PoolLight {
        slot,
        light,
        importance: 1.0,
    };
    let slots = slots.iter().copied();
    slots.zip(lights.map(light)).map(pooled).collect()
}
