//! Owns the shadows of the hall's spots and lamps.

use example_support::hall::lights::{LAMPS, LightUniform, Lights, SPOTS};
use glam::Vec3;
use shadow_support::gpu::Gpu;
use wgpu_shadows::{
    ShadowError, ShadowFrame, ShadowMaps, pool::OmniShadowPool, pool::PoolLight, pool::ShadowSlot,
    pool::SpotShadowPool,
};

use crate::scene::hall::STEPS_PER_SECOND;
use crate::settings::SideSettings;

/// Holds two pools, and the lights as the fragment stage reads them.
pub struct Lamps {
    spots: SpotShadowPool,
    spot_slots: Vec<ShadowSlot>,
    lamps: OmniShadowPool,
    lamp_slots: Vec<ShadowSlot>,
    uniforms: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
}

impl Lamps {
    pub fn new(gpu: &Gpu, settings: &SideSettings) -> Result<Self, ShadowError> {
        let device = &gpu.device;
        let mut spots = SpotShadowPool::new(device, &settings.spots(SPOTS as u32))?;
        let mut lamps = OmniShadowPool::new(device, &settings.lamps(LAMPS as u32))?;
        let spot_slots = (0..SPOTS)
            .map(|_| spots.insert())
            .collect::<Result<_, _>>()?;
        let lamp_slots = (0..LAMPS)
            .map(|_| lamps.insert())
            .collect::<Result<_, _>>()?;
        let uniforms = gpu.empty_buffer(
            ((SPOTS + LAMPS) * size_of::<LightUniform>()) as u64,
            wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        );
        let layout = shadow_support::bind::layout(
            gpu,
            wgpu::ShaderStages::FRAGMENT,
            &[shadow_support::bind::UNIFORM],
        );
        let group = shadow_support::bind::group(gpu, &layout, &[uniforms.as_entire_binding()]);
        Ok(Self {
            spots,
            spot_slots,
            lamps,
            lamp_slots,
            uniforms,
            layout,
            group,
        })
    }

    /// Records the depth passes of what has changed.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        eye: Vec3,
        time: f32,
    ) -> Result<(), ShadowError> {
        let lights = Lights::at(time * STEPS_PER_SECOND);
        let uniforms = lights.uniforms();
        gpu.queue
            .write_buffer(&self.uniforms, 0, bytemuck::cast_slice(&uniforms));
        let spots = self.spot_slots.iter().zip(&lights.spots);
        let spots: Vec<_> = spots
            .map(|(slot, spot)| PoolLight {
                slot: *slot,
                light: spot.light(),
                importance: 1.0,
            })
            .collect();
        self.spots.record(encoder, frame, &spots, None)?;
        let lamps = self.lamp_slots.iter().zip(&lights.lamps);
        let lamps: Vec<_> = lamps
            .map(|(slot, lamp)| PoolLight {
                slot: *slot,
                light: lamp.light(),
                importance: eye.distance(lamp.place).max(1.0).recip(),
            })
            .collect();
        self.lamps.record(encoder, frame, &lamps, None)?;
        Ok(())
    }

    /// Returns the maps of the spots, and those of the lamps.
    pub fn maps(&self) -> [&ShadowMaps; 2] {
        [self.spots.maps(), self.lamps.maps()]
    }

    /// Returns the bind group of the lights for the fragment stage, and its layout.
    pub fn lights(&self) -> (&wgpu::BindGroupLayout, wgpu::BindGroup) {
        (&self.layout, self.group.clone())
    }
}
