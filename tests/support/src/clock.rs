//! Measures time on the device, between the commands of one encoder.

use std::time::Instant;

use crate::gpu::Gpu;
use crate::readback;

/// Uses timestamps where the device has them, and otherwise the wall clock around submission and
/// completion.
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

    /// Returns the seconds that the commands of `record` take. On a software rasterizer only the
    /// ratio to another such time is meaningful.
    pub fn seconds(&self, record: impl FnOnce(&mut wgpu::CommandEncoder)) -> f64 {
        let seconds = self.try_seconds(|encoder| {
            record(encoder);
            Ok(())
        });
        seconds.expect("the device finishes its work")
    }

    /// Does the same, and returns the error of `record` or of a device that stopped.
    pub fn try_seconds(
        &self,
        record: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<(), String>,
    ) -> Result<f64, String> {
        let mut encoder = self.gpu.encoder();
        let Some((set, resolved)) = &self.queries else {
            record(&mut encoder)?;
            let start = Instant::now();
            self.gpu.try_submit(encoder)?;
            return Ok(start.elapsed().as_secs_f64());
        };
        encoder.write_timestamp(set, 0);
        record(&mut encoder)?;
        encoder.write_timestamp(set, 1);
        encoder.resolve_query_set(set, 0..2, resolved, 0);
        self.gpu.try_submit(encoder)?;
        let ticks: Vec<u64> = readback::try_buffer(self.gpu, resolved)?;
        let period = f64::from(self.gpu.queue.get_timestamp_period()) * 1e-9;
        Ok(ticks[1].saturating_sub(ticks[0]) as f64 * period)
    }
}
