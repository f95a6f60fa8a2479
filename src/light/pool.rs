//! Defines pools of local lights: many lights share one texture, one bind group entry and one WGSL
//! function, which takes an index.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::check;
use crate::light::local::{LocalLights, LocalPlacement};
use crate::receive::{
    Sampling, Selection, ShadowMaps, ShadowMapsDescriptor, check_bias, check_fade, check_filter,
    check_planar_filter,
};
use crate::{Bias, Filter, OmniLight, ShadowError, ShadowFrame, SpotLight, report::ShadowReport};

/// Describes what a pool is made of. [`OmniShadowPool::new`] and [`SpotShadowPool::new`] return
/// [`ShadowError::OutOfRange`] for values outside the ranges given here, and
/// [`ShadowError::OverDeviceLimit`] for those beyond the device's limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoolDescriptor<'a> {
    /// Is the label from which all wgpu objects of the pool derive theirs; "shadow pool" if `None`,
    /// the default.
    pub label: wgpu::Label<'a>,
    /// Is the number of lights that the pool can contain at once, fixed for its lifetime: at least
    /// 1, and no more than the device's limit on uniform bytes allows (42 point lights or 256 spot
    /// lights with WebGPU's default limits). The default is 16. It costs uniforms, and no texels.
    pub capacity: u32,
    /// Is the number of texels per side of the one layer that all views of the pool share, so that
    /// its square is their budget: at least one for each view in a square of 2ⁿ times 2ⁿ views, and
    /// at most the device's `max_texture_dimension_2d`. The default is 2048, the texels of one
    /// directional light by default (16 MiB), or of 16 maps of 512².
    ///
    /// The pool divides them by what the cameras of the frame see: see [`OmniShadowPool`]. If too
    /// few, shadows near the camera are blurred by coarse texels; if too many, memory is wasted,
    /// and each view takes longer to draw. The blur and the displacement of an edge shrink in
    /// proportion to it.
    pub map_size: u32,
    /// Selects how a map is sampled. The default is that of [`Filter`]. A [`SpotShadowPool`]
    /// refuses filters for point lights only.
    pub filter: Filter,
    /// Selects how receivers are kept from shadowing themselves. The default is [`Bias::Auto`].
    pub bias: Bias,
    /// Is the fraction of a light's range, in 0..=1, over which shadows fade to light before they
    /// end there. The default is 0: they end at once.
    pub fade: f32,
}

impl Default for PoolDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            capacity: 16,
            map_size: 2048,
            filter: Filter::default(),
            bias: Bias::Auto,
            fade: 0.0,
        }
    }
}

/// Identifies a light in a pool. [`OmniShadowPool::insert`] and [`SpotShadowPool::insert`] return
/// it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ShadowSlot {
    index: u32,
    /// Is unique in the process. It distinguishes this slot from slots of other pools and from
    /// earlier uses of the same index.
    ticket: u64,
}

impl ShadowSlot {
    /// Returns the index to pass to the WGSL function. It is below the pool's capacity, and belongs
    /// to this light alone until the light is removed.
    pub const fn index(&self) -> u32 {
        self.index
    }
}

/// Describes a light of a pool in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoolLight<L> {
    /// Is the slot of the light. A frame may list each slot at most once.
    pub slot: ShadowSlot,
    /// Describes the light.
    pub light: L,
    /// Determines which lights are refreshed first where the budget does not suffice for all: at
    /// least 0 and finite, for example the fraction of the image that the light covers. Only the
    /// ratios between importances matter. Each frame for which a light is deferred raises its
    /// urgency, so that none of importance above 0 waits for ever; lights of importance 0 are
    /// refreshed from what the others leave of the budget. An importance above 0 counts for at
    /// least 1/4096 of the greatest in the frame: of `n` lights that change in every frame, one of
    /// importance `i` beside a greatest importance of `g` waits at most `(n - 1) min(g / i, 4096) +
    /// n` frames.
    pub importance: f32,
}

/// Holds the slots of a pool.
#[derive(Debug)]
struct Slots {
    /// Has one entry per slot: the ticket of the light in it, or `None` for a free slot.
    tickets: Vec<Option<u64>>,
    /// Has one entry per slot, true for those already listed in the frame that is being checked.
    seen: Vec<bool>,
}

static NEXT_TICKET: AtomicU64 = AtomicU64::new(0);

impl Slots {
    /// Occupies a free slot.
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

    /// Accepts slots of this pool that have not been removed.
    fn check(&self, field: &'static str, slot: ShadowSlot) -> Result<(), ShadowError> {
        match self.tickets.get(slot.index as usize) {
            Some(Some(ticket)) if *ticket == slot.ticket => Ok(()),
            _ => Err(ShadowError::UnknownSlot {
                field,
                index: slot.index,
            }),
        }
    }

    /// Accepts frames that list each light once, with a valid importance.
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

/// Defines a pool. The two pools differ only in the lights that they contain.
macro_rules! pool {
    (
        $(#[$doc:meta])* $pool:ident, $light:ty, $views:literal, $selection:expr, $filter_check:path
    ) => {
        $(#[$doc])*
        #[derive(Debug)]
        pub struct $pool {
            lights: LocalLights,
            slots: Slots,
            /// Is reused from frame to frame for its memory.
            placements: Vec<LocalPlacement>,
        }

        impl $pool {
            /// Creates the texture and the buffers for all slots.
            ///
            /// # Errors
            /// Returns [`ShadowError`] for a descriptor with a value out of range, and for a device
            /// whose limits or memory do not suffice or that is lost.
            pub fn new(
                device: &wgpu::Device,
                descriptor: &PoolDescriptor<'_>,
            ) -> Result<Self, ShadowError> {
                $filter_check("PoolDescriptor::filter", descriptor.filter)?;
                check_bias("PoolDescriptor::bias", descriptor.bias)?;
                check_fade("PoolDescriptor::fade", descriptor.fade)?;
                check::in_range(
                    "PoolDescriptor::capacity",
                    "at least 1",
                    descriptor.capacity > 0,
                    descriptor.capacity,
                )?;
                let lights = LocalLights::new(
                    device,
                    &ShadowMapsDescriptor {
                        label: descriptor.label.unwrap_or("shadow pool"),
                        map_size: descriptor.map_size,
                        size_field: "PoolDescriptor::map_size",
                        lights: descriptor.capacity,
                        layers_field: "PoolDescriptor::capacity",
                        sampling: Sampling {
                            fade: descriptor.fade,
                            ..Sampling::new(descriptor.filter, descriptor.bias)
                        },
                        views_per_light: $views,
                        selection: $selection,
                        shares_layer: true,
                        indexed: true,
                    },
                )?;
                Ok(Self {
                    lights,
                    slots: Slots {
                        tickets: vec![None; descriptor.capacity as usize],
                        seen: Vec::new(),
                    },
                    placements: Vec::new(),
                })
            }

            /// Reserves a slot for a light. The light is lit everywhere until its map is first
            /// drawn.
            ///
            /// # Errors
            /// Returns [`ShadowError::PoolFull`] if every slot is occupied.
            pub fn insert(&mut self) -> Result<ShadowSlot, ShadowError> {
                let slot = self.slots.insert()?;
                self.lights.reset(slot.index);
                Ok(slot)
            }

            /// Frees a light's slot.
            ///
            /// # Errors
            /// Returns [`ShadowError::UnknownSlot`] for a slot of another pool or one that was
            /// removed already.
            pub fn remove(&mut self, slot: ShadowSlot) -> Result<(), ShadowError> {
                self.slots.check("slot", slot)?;
                self.slots.tickets[slot.index as usize] = None;
                Ok(())
            }

            /// Fits the lights to the frame, culls the casters, writes the uniforms, and records
            /// the depth pass that is needed, of the views that the budget allows. A light in
            /// which nothing changed is not drawn. Lights of the pool that are not listed cast no shadow
            /// in this frame: every surface is lit.
            ///
            /// `max_views` is the budget: the largest number of views to render in this frame, or
            /// `None` for no limit. A view counts twice where its static-caster cache is rendered
            /// as well. A view whose size changes counts, and so does a view that has to make room
            /// for another. One depth pass renders all of them, and a second one renders the
            /// static-caster caches. The most important lights are refreshed first, and
            /// at least one is, whatever it costs. The others keep their last map and are reported
            /// as [`Deferred`](crate::report::ViewStatus::Deferred). A light that has never been
            /// drawn, or not since `invalidate`, is lit everywhere until it is refreshed.
            ///
            /// The encoder must be submitted before any work that samples these shadows, and
            /// encoders must be submitted in the order in which they were recorded ([what a kept
            /// map relies on](crate#what-a-kept-map-relies-on)).
            ///
            /// # Errors
            /// Returns [`ShadowError`] for a slot that is not this pool's or is listed twice, for
            /// an importance that is negative or not finite, for a light with an invalid value, for
            /// a view that cannot be represented, for casters whose pipelines do not fit the pool,
            /// and for a device that is lost or out of memory. Nothing is recorded then, and the
            /// maps of the last successful frame remain.
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
                let report = self.lights.record(encoder, frame, &placements, max_views);
                self.placements = placements;
                report
            }

            /// Returns the pool's depth texture, uniforms and report.
            pub fn maps(&self) -> &ShadowMaps {
                self.lights.maps()
            }

            /// Discards the extents of earlier frames. Without this call, extents grow at once and
            /// shrink only after some time, so that moving objects do not change the texels of
            /// static ones. Call it where the camera cuts to another scene.
            pub fn reset_history(&mut self) {
                self.lights.reset_history();
            }

            /// Declares the contents of the maps invalid ([what a kept map relies
            /// on](crate#what-a-kept-map-relies-on)): the next frame draws every view, or as many
            /// as its budget allows; the other lights are lit everywhere until they are refreshed.
            pub fn invalidate(&mut self) {
                self.lights.invalidate();
            }
        }
    };
}

pool!(
    /// Renders the shadows of point lights that are inserted and removed at run time. The faces of
    /// all of them share one layer of texels.
    ///
    /// # How the texels are divided
    /// Every face gets a square by what the cameras see of the receivers on which its shadows can
    /// fall: a face in which nothing casts onto a visible receiver has none, and one close to a
    /// camera has many. If there are more lights than fit, all get fewer; as many as the capacity
    /// always have a place. Without a camera in the frame, all have the same.
    ///
    /// Every 16 frames, and when a face is needed that was not, what the cameras see is sampled by
    /// some rays through the images. As under
    /// [`CascadeLayout::Automatic`](crate::CascadeLayout::Automatic), the squared error is taken to
    /// be in proportion to the density of shadow edges and the size of a texel, both in pixels, and
    /// [`predicted_error`](crate::report::ShadowReport::predicted_error) tells what comes of it,
    /// over all pairs of a visible point and a light. Sides are the layer's over a power of two.
    /// They change when the error would be lower by 8 percent for three predictions, or by 20
    /// percent at once, and a face keeps its size as long as it is within 3/4 of a power of two of
    /// the ideal. A face that changes is drawn once more; all others keep what they have, but for
    /// those that are moved because the gaps left are too small.
    /// [`ViewReport::texels`](crate::report::ViewReport::texels) tells where each face is.
    ///
    /// The WGSL function is `shadow_NAME(slot.index(), position, normal)`.
    OmniShadowPool,
    OmniLight,
    6,
    Selection::CubeFace,
    check_filter
);

pool!(
    /// Renders the shadows of spot lights that are inserted and removed at run time. All of them
    /// share one layer of texels, which is divided as that of an [`OmniShadowPool`].
    ///
    /// The WGSL function is `shadow_NAME(slot.index(), position, normal)`.
    SpotShadowPool,
    SpotLight,
    1,
    Selection::OneView,
    check_planar_filter
);
