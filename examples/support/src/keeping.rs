//! Checks that maps which are kept are never stale: the same frames are drawn with maps that are
//! kept, and with lights that are invalidated before every frame.

use std::error::Error;
use std::time::Duration;

/// Is one frame of a run.
pub struct Frame {
    pub pixels: Vec<u8>,
    /// Is how long the library took to record it, and the number of passes that it recorded.
    pub record_time: Duration,
    pub passes: u32,
}

/// Is an engine that draws frames with shadows.
pub trait Engine {
    /// Draws a frame. Where it `keeps_nothing`, its lights are invalidated before.
    fn draw(&mut self, frame: u32, keeps_nothing: bool) -> Result<Frame, Box<dyn Error>>;
}

/// Runs two engines, one of which keeps nothing, for `moving` frames and as many in which nothing
/// moves, and checks them.
pub fn compare<E: Engine>(
    moving: u32,
    make: impl Fn() -> Result<E, Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let run = |keeps_nothing: bool| -> Result<Vec<Frame>, Box<dyn Error>> {
        let mut engine = make()?;
        let frames = (0..2 * moving).map(|frame| frame.min(moving - 1));
        frames
            .map(|frame| engine.draw(frame, keeps_nothing))
            .collect()
    };
    Ok(check(&run(false)?, &run(true)?, moving as usize)?)
}

/// Compares the images of two runs bit for bit, and prints what they cost. In the first `moving`
/// frames something moves, in the others nothing does.
pub fn check(kept: &[Frame], fresh: &[Frame], moving: usize) -> Result<(), String> {
    let cost = |name: &str, frames: &[Frame]| {
        let mut times: Vec<_> = frames.iter().map(|frame| frame.record_time).collect();
        times.sort();
        let passes: u32 = frames.iter().map(|frame| frame.passes).sum();
        let (count, median) = (frames.len(), times[times.len() / 2]);
        println!("{name}: {passes} passes in {count} frames, record takes {median:?} (median)");
    };
    cost("moving", &kept[..moving]);
    cost("still", &kept[moving..]);
    cost("nothing kept", fresh);
    let pairs = kept.iter().zip(fresh).enumerate();
    let stale = pairs.filter(|(_, (kept, fresh))| kept.pixels != fresh.pixels);
    let stale: Vec<usize> = stale.map(|(index, _)| index).collect();
    println!("stale frames: {} of {}", stale.len(), kept.len());
    if stale.is_empty() {
        Ok(())
    } else {
        Err(format!("kept maps are stale in frames {stale:?}"))
    }
}
