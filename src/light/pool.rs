//! Pools of local lights: many lights, one texture array, one bind group entry, one WGSL function that takes an index.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::check;
use crate::light::layer_limits::check_layers;
use crate::light::local::{LocalLights, LocalPlacement};
use crate::receive::{
    Sampling, Selection, ShadowMaps, ShadowMapsDescriptor, check_bias, check_filter,
    check_planar_filter,
};
use crate::{Bias, Filter, OmniLight, ShadowError, ShadowFrame, SpotLight, report::ShadowReport};

/// What a pool is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoolDescriptor<'a> {
    /// Label from which all objects derive theirs. Default "shadow pool".
    pub label: wgpu::Label<'a>,
    /// Lights that it can hold at once, fixed for its life: at least 1, and no more than the device's texture layers and
    /// uniform bytes allow (42 point lights or 256 spots by WebGPU's defaults). Default 16.
    pub capacity: u32,
    /// Texels per side of each map, 1 up to the device's `max_texture_dimension_2d`. Default 512.
    pub map_size: u32,
    /// How a map is looked up.
    pub filter: Filter,
    /// How receivers are kept from shadowing themselves.
    pub bias: Bias,
}

impl Default for PoolDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            capacity: 16,
            map_size: 512,
            filter: Filter::default(),
            bias: Bias::Auto,
        }
    }
}

/// A light's place in a pool, from [`OmniShadowPool::insert`] or [`SpotShadowPool::insert`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ShadowSlot {
    index: u32,
    /// Tells pools, and lights that had the slot before, apart.
    ticket: u64,
}

impl ShadowSlot {
    /// The index to hand to the WGSL function: below the pool's capacity, the light's own until it is removed.
    pub const fn index(&self) -> u32 {
        self.index
    }
}

/// A light of a pool in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoolLight<L> {
    /// Its slot.
    pub slot: ShadowSlot,
    /// The light.
    pub light: L,
    /// Who is refreshed first where a budget does not suffice: at least 0, finite; for instance the light's share of the
    /// picture. Only the proportions count. A light that is put off counts for one frame more each time, so that none above 0
    /// starves; one at 0 has what the others leave. An importance above 0 counts for at least 1/4096 of the greatest in the
    /// frame: of `n` lights that always change, one of importance `i` beside a greatest of `g` waits at most
    /// `(n - 1) min(g / i, 4096) + n` frames.
    pub importance: f32,
}

/// Slots of a pool and the tickets they are given out under.
#[derive(Debug)]
struct Slots {
    tickets: Vec<Option<u64>>,
    /// Which were named in the frame being checked.
    seen: Vec<bool>,
}

static NEXT_TICKET: AtomicU64 = AtomicU64::new(0);

impl Slots {
    fn insert(&mut self) -> Result<ShadowSlot, ShadowError> {
        let free = self.tickets.iter().position(Option::is_none);
        let index = free.ok_or(ShadowError::PoolFull {
            capacity: self.tickets.len() as u32,
        })?;
        let ticket = NEXT_TICKET.fetch_add(1, Ordering::Relaxed);
        self.tickets[index] = Some(ticket);
        Ok(ShadowSlot {
            index: index as u32,
            ticket,
        })
    }

    fn check(&self, field: &'static str, slot: ShadowSlot) -> Result<(), ShadowError> {
        match self.tickets.get(slot.index as usize) {
            Some(Some(ticket)) if *ticket == slot.ticket => Ok(()),
            _ => Err(ShadowError::UnknownSlot {
                field,
                index: slot.index,
            }),
        }
    }

    fn check_frame<L>(&mut self, lights: &[PoolLight<L>]) -> Result<(), ShadowError> {
        self.seen.clear();
        self.seen.resize(self.tickets.len(), false);
        for light in lights {
            self.check("PoolLight::slot", light.slot)?;
            let index = light.slot.index;
            if std::mem::replace(&mut self.seen[index as usize], true) {
                return Err(ShadowError::DuplicateSlot {
                    field: "PoolLight::slot",
                    index,
                });
            }
            check::in_range(
                "PoolLight::importance",
                "finite and at least 0",
                light.importance >= 0.0 && light.importance.is_finite(),
                light.importance,
            )?;
        }
        Ok(())
    }
}

fn check_descriptor(
    device: &wgpu::Device,
    descriptor: &PoolDescriptor<'_>,
    views_per_light: u32,
) -> Result<(), ShadowError> {
    let field = "PoolDescriptor::capacity";
    check::in_range(
        field,
        "at least 1",
        descriptor.capacity > 0,
        descriptor.capacity,
    )?;
    let layers = u64::from(descriptor.capacity) * u64::from(views_per_light);
    check_layers(device, field, layers)
}

/// The two pools differ in their lights alone.
macro_rules! pool {
    (
        $(#[$doc:meta])* $pool:ident, $light:ty, $views:literal, $selection:expr, $filter_check:path
    ) => {
        $(#[$doc])*
        #[derive(Debug)]
        pub struct $pool {
            maps: ShadowMaps,
            lights: LocalLights,
            slots: Slots,
            /// Empty between frames; kept for its memory.
            placements: Vec<LocalPlacement>,
        }

        impl $pool {
            /// Makes texture and buffers for all slots.
            ///
            /// # Errors
            /// [`ShadowError`] for a descriptor out of range, or a device that cannot hold it.
            pub fn new(
                device: &wgpu::Device,
                descriptor: &PoolDescriptor<'_>,
            ) -> Result<Self, ShadowError> {
                $filter_check("PoolDescriptor::filter", descriptor.filter)?;
                check_bias("PoolDescriptor::bias", descriptor.bias)?;
                check_descriptor(device, descriptor, $views)?;
                let maps = ShadowMaps::new(
                    device,
                    &ShadowMapsDescriptor {
                        label: descriptor.label.unwrap_or("shadow pool"),
                        size_field: "PoolDescriptor::map_size",
                        map_size: descriptor.map_size,
                        layers: descriptor.capacity * $views,
                        sampling: Sampling::new(descriptor.filter, descriptor.bias),
                        selection: $selection,
                        views_per_light: $views,
                        indexed: true,
                    },
                )?;
                Ok(Self {
                    maps,
                    lights: LocalLights::new(device, descriptor.capacity),
                    slots: Slots {
                        tickets: vec![None; descriptor.capacity as usize],
                        seen: Vec::new(),
                    },
                    placements: Vec::new(),
                })
            }

            /// Takes a light in.
            ///
            /// # Errors
            /// [`ShadowError::PoolFull`] where all slots are taken.
            pub fn insert(&mut self) -> Result<ShadowSlot, ShadowError> {
                let slot = self.slots.insert()?;
                self.lights.reset(slot.index);
                Ok(slot)
            }

            /// Gives a light's slot back.
            ///
            /// # Errors
            /// [`ShadowError::UnknownSlot`] for a slot that is not this pool's, or no longer.
            pub fn remove(&mut self, slot: ShadowSlot) -> Result<(), ShadowError> {
                self.slots.check("slot", slot)?;
                self.slots.tickets[slot.index as usize] = None;
                Ok(())
            }

            /// Fits the lights to the frame, culls, writes the uniforms and records the depth passes that are needed and that
            /// the budget allows. A light in which nothing changed costs no pass. Lights of the pool that are not listed are lit
            /// everywhere.
            ///
            /// `max_views` is the budget: the most depth passes (over `map_size`² texels each) to draw in this frame; none for no
            /// limit. A view is one pass, or two where the layer that is kept of what stands still is drawn anew. The most
            /// important lights are refreshed first, and at least one is, whatever it takes; the others show their last map and
            /// are reported as deferred. A light that has never been drawn, or not since `invalidate`, is lit until its turn.
            ///
            /// The encoder must be submitted before anything that asks for these shadows, and encoders in the order in which
            /// they were recorded ([what a kept map relies on](crate#what-a-kept-map-relies-on)).
            ///
            /// # Errors
            /// [`ShadowError`] for lights, bounds or a camera that are not sound, or slots that are not this pool's. Nothing
            /// is recorded then, and the last good maps remain.
            pub fn record(
                &mut self,
                encoder: &mut wgpu::CommandEncoder,
                frame: &ShadowFrame<'_>,
                lights: &[PoolLight<$light>],
                max_views: Option<u32>,
            ) -> Result<&ShadowReport, ShadowError> {
                self.slots.check_frame(lights)?;
                let mut placements = std::mem::take(&mut self.placements);
                placements.clear();
                for entry in lights {
                    let placement = entry.light.placement(entry.slot.index, entry.importance)?;
                    placements.push(placement);
                }
                let report =
                    self.lights
                        .record(&mut self.maps, encoder, frame, &placements, max_views);
                self.placements = placements;
                report
            }

            /// Returns the light's depth texture, uniforms and report.
            pub fn maps(&self) -> &ShadowMaps {
                &self.maps
            }

            /// Says that the maps no longer hold what was recorded ([what a kept map relies on](crate#what-a-kept-map-relies-on)): the
            /// next frame draws every view, or under a budget as many as it allows, and the rest is lit
            /// until its turn.
            pub fn invalidate(&mut self) {
                self.maps.invalidate();
            }
        }
    };
}

pool!(
    /// Shadows of point lights that come and go: six layers of one texture array a slot.
    ///
    /// In WGSL: `shadow_NAME(slot.index(), position, normal)`.
    OmniShadowPool,
    OmniLight,
    6,
    Selection::CubeFace,
    check_filter
);

pool!(
    /// Shadows of spot lights that come and go: one layer of one texture array a slot.
    ///
    /// In WGSL: `shadow_NAME(slot.index(), position, normal)`.
    SpotShadowPool,
    SpotLight,
    1,
    Selection::OneView,
    check_planar_filter
);
