//! Measures time on the device, between the commands of one encoder.

use std::time::Instant;

use crate::support::gpu::Gpu;

/// Uses timestamps where the device has them, and otherwise the wall clock around submission and completion.
pub struct Clock<'a> {
    gpu: &'a Gpu,
    queries: Option<(wgpu::QuerySet, wgpu::Buffer)>,
}

impl<'a> Clock<'a> {
    pub fn new(gpu: &'a Gpu) -> Self {
        let queries = gpu.has_timestamps.then(|| {
            let set = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("clock"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            });
            let resolved = gpu.empty_buffer(
                16,
                wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            );
            (set, resolved)
        });
        Self { gpu, queries }
    }

    /// Returns the seconds that the recorded commands take. Only the ratio to another such time is meaningful.
    pub fn seconds(&self, record: impl FnOnce(&mut wgpu::CommandEncoder)) -> f64 {
        let mut encoder = self.gpu.encoder();
        let Some((set, resolved)) = &self.queries else {
            record(&mut encoder);
            let start = Instant::now();
            self.gpu.submit(encoder);
            return start.elapsed().as_secs_f64();
        };
        encoder.write_timestamp(set, 0);
        record(&mut encoder);
        encoder.write_timestamp(set, 1);
        encoder.resolve_query_set(set, 0..2, resolved, 0);
        self.gpu.submit(encoder);
        let ticks: Vec<u64> = self.gpu.read(resolved);
        let period = f64::from(self.gpu.queue.get_timestamp_period()) * 1e-9;
        ticks[1].saturating_sub(ticks[0]) as f64 * period
    }
}
