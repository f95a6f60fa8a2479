//! Sorts the casters of a pass into draw calls: one for all instances of equal geometry.

use std::num::NonZeroU32;
use std::ops::Range;

use crate::cast::instance_matrices::{InstanceMatrices, InstancePlace};
use crate::cast::instances::Instance;
use crate::cast::mesh_geometry::MeshGeometry;
use crate::cast::{CasterPipeline, FrameCasters};

/// Is a call that draws.
#[derive(Clone, Copy, Debug)]
pub(crate) enum DrawCall<'a> {
    /// Lets a caster of the engine's own draw itself.
    Caster {
        /// Is its index among the casters of the frame.
        index: u32,
        pipeline: &'a CasterPipeline,
    },
    /// Draws instances of one geometry.
    Instances {
        geometry: &'a MeshGeometry,
        pipeline: &'a CasterPipeline,
        /// Is the place of the first matrix; `None` where the pipeline reads no matrix.
        first: Option<InstancePlace>,
        count: u32,
    },
}

/// Is what one entry of a frame's casters draws.
#[derive(Clone, Copy, Debug)]
struct Item<'a> {
    /// Orders the draws: by pipeline, then by geometry, then as the engine lists them.
    sort_key: (u64, u64, u32),
    pipeline: &'a CasterPipeline,
    /// Is `None` for a caster that draws itself.
    instance: Option<(&'a MeshGeometry, &'a Instance)>,
}

/// Holds the draw calls of the passes of a frame, one pass after the other. Its memory is reused.
#[derive(Debug, Default)]
pub(crate) struct DrawLists<'a> {
    items: Vec<Item<'a>>,
    calls: Vec<DrawCall<'a>>,
}

impl<'a> DrawLists<'a> {
    /// Returns the calls of a pass by the range that [`DrawLists::add`] returned.
    pub(super) fn calls(&self, range: Range<usize>) -> &[DrawCall<'a>] {
        &self.calls[range]
    }

    /// Removes all lists.
    pub(super) fn clear(&mut self) {
        self.calls.clear();
    }

    /// Adds the draw calls of a pass that draws `drawn`, and their matrices to `matrices`. `check`
    /// may refuse the pipeline of a caster; the list is then incomplete.
    pub(super) fn add<E>(
        &mut self,
        drawn: impl Iterator<Item = u32>,
        casters: &FrameCasters<'a>,
        matrices: &mut InstanceMatrices,
        check: impl Fn(u32, &CasterPipeline) -> Result<(), E>,
    ) -> Result<Range<usize>, E> {
        let start = self.calls.len();
        self.items.clear();
        for index in drawn {
            let item = item(index, casters);
            check(index, item.pipeline)?;
            self.items.push(item);
        }
        self.items.sort_unstable_by_key(|item| item.sort_key);
        for &Item {
            sort_key: (.., index),
            pipeline,
            instance,
        } in &self.items
        {
            let Some((geometry, instance)) = instance else {
                self.calls.push(DrawCall::Caster { index, pipeline });
                continue;
            };
            let place = matrices.add(geometry, &instance.render_from_model);
            let last = self.calls[start..].last_mut();
            if !last.is_some_and(|call| call.takes(geometry, pipeline, place)) {
                self.calls.push(DrawCall::Instances {
                    geometry,
                    pipeline,
                    first: place,
                    count: 1,
                });
            }
        }
        Ok(start..self.calls.len())
    }

    /// Returns an empty value that reuses the memory of this one, for casters of another frame.
    pub(super) fn recycled<'b>(mut self) -> DrawLists<'b> {
        self.items.clear();
        self.calls.clear();
        // The standard library collects into the memory of the vector that is consumed.
        DrawLists {
            items: self.items.into_iter().map_while(|_| None).collect(),
            calls: self.calls.into_iter().map_while(|_| None).collect(),
        }
    }
}

impl<'a> DrawCall<'a> {
    /// Adds an instance to the call if the call can draw it as well, and returns whether it does.
    fn takes(
        &mut self,
        other: &MeshGeometry,
        other_pipeline: &CasterPipeline,
        place: Option<InstancePlace>,
    ) -> bool {
        let Self::Instances {
            geometry,
            pipeline,
            first,
            count,
        } = self
        else {
            return false;
        };
        let next = first.map(|first| InstancePlace {
            instance: first.instance + *count,
            ..first
        });
        let takes =
            next == place && pipeline.draws_like(other_pipeline) && geometry.draws_the_same(other);
        // Without a matrix all instances are the same, and one stands for all.
        if takes && place.is_some() {
            *count += 1;
        }
        takes
    }

    pub(super) fn pipeline(&self) -> &'a CasterPipeline {
        match self {
            Self::Caster { pipeline, .. } | Self::Instances { pipeline, .. } => pipeline,
        }
    }
}

fn item<'a>(index: u32, casters: &FrameCasters<'a>) -> Item<'a> {
    let (pipeline, geometry_key, instance) = match casters.instance(index) {
        Some((geometry, instance)) => {
            let pipeline = geometry.pipeline(instance.mirrors);
            (pipeline, geometry.sort_key(), Some((geometry, instance)))
        }
        None => (casters.caster(index).pipeline(), 0, None),
    };
    Item {
        sort_key: (pipeline.sort_key(), geometry_key, index),
        pipeline,
        instance,
    }
}

/// Counts the draw calls of casters without sorting them. It is exact for casters that draw
/// themselves. Instances are told apart by a hash of what they draw, so that it counts up to 4096
/// different geometries, and fewer than there are where hashes collide.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawCounter {
    seen: [u64; 64],
    draws: u64,
}

impl DrawCounter {
    pub(super) const fn new() -> Self {
        Self {
            seen: [0; 64],
            draws: 0,
        }
    }

    /// Counts a caster by the batch that it belongs to.
    pub(super) fn add(&mut self, batch: Option<NonZeroU32>) {
        let Some(batch) = batch else {
            self.draws += 1;
            return;
        };
        let word = &mut self.seen[batch.get() as usize >> 6 & 63];
        let bit = 1 << (batch.get() & 63);
        self.draws += u64::from(*word & bit == 0);
        *word |= bit;
    }

    pub(super) fn draws(&self) -> u64 {
        self.draws
    }
}
