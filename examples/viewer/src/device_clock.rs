//! Measures the time of the depth passes on the device, where it writes timestamps between passes.

use shadow_support::gpu::Gpu;

use crate::readback::{Copied, Readback, copy_buffer};

/// Is the number of timestamps: before and after the passes of each side.
const MARKS: u32 = 4;

/// Holds the queries, and the last times that came back.
pub struct DeviceClock {
    queries: Option<(wgpu::QuerySet, wgpu::Buffer)>,
    nanoseconds_per_tick: f64,
    waiting: Option<Readback>,
    milliseconds: [Option<f64>; 2],
}

impl DeviceClock {
    pub fn new(gpu: &Gpu) -> Self {
        let queries = gpu.has_timestamps.then(|| {
            let set = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("device clock"),
                ty: wgpu::QueryType::Timestamp,
                count: MARKS,
            });
            let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
            (set, gpu.empty_buffer(8 * u64::from(MARKS), usage))
        });
        Self {
            queries,
            nanoseconds_per_tick: f64::from(gpu.queue.get_timestamp_period()),
            waiting: None,
            milliseconds: [None, None],
        }
    }

    pub fn begin(&self, encoder: &mut wgpu::CommandEncoder, side: usize) {
        self.mark(encoder, 2 * side as u32);
    }

    pub fn end(&self, encoder: &mut wgpu::CommandEncoder, side: usize) {
        self.mark(encoder, 2 * side as u32 + 1);
    }

    fn mark(&self, encoder: &mut wgpu::CommandEncoder, index: u32) {
        if let Some((set, _)) = &self.queries {
            encoder.write_timestamp(set, index);
        }
    }

    /// Records the copy of the times, unless earlier ones are still on their way.
    pub fn resolve(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder) -> Option<Copied> {
        let (set, resolved) = self.queries.as_ref()?;
        encoder.resolve_query_set(set, 0..MARKS, resolved, 0);
        self.waiting
            .is_none()
            .then(|| copy_buffer(gpu, encoder, resolved))
    }

    /// Asks for the times, after the commands were submitted.
    pub fn read(&mut self, copied: Option<Copied>) {
        if let Some(copied) = copied {
            self.waiting = Some(copied.read());
        }
    }

    pub fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// Takes the times that have come back. Those that cannot be read stay unknown.
    pub fn poll(&mut self, gpu: &Gpu) {
        let Some(result) = self.waiting.as_ref().and_then(|waiting| waiting.poll(gpu)) else {
            return;
        };
        self.waiting = None;
        let Ok(bytes) = result else { return };
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes);
        for (side, marks) in ticks.chunks_exact(2).take(2).enumerate() {
            let ticks = marks[1].saturating_sub(marks[0]) as f64;
            self.milliseconds[side] = Some(ticks * self.nanoseconds_per_tick * 1e-6);
        }
    }

    /// Returns the time of a side's depth passes.
    pub fn milliseconds(&self, side: usize) -> Option<f64> {
        self.milliseconds[side]
    }
}
