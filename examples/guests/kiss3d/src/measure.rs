//! Is what measuring needs of the shadows beyond what the engine does.

use crate::shadows::Shadows;

impl Shadows {
    /// Makes the next frame draw everything.
    pub fn invalidate(&mut self) {
        self.sun.invalidate();
        self.spots.invalidate();
        self.lamps.invalidate();
    }

    /// Returns the passes of the last frame and the bytes of all maps.
    pub fn totals(&self) -> (u32, u64) {
        let maps = [self.sun.maps(), self.spots.maps(), self.lamps.maps()];
        let reports = maps.map(|maps| maps.report());
        (
            reports.iter().map(|report| report.passes).sum(),
            reports.iter().map(|report| report.bytes_held).sum(),
        )
    }
}
