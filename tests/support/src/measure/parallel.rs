//! Runs work on all cores, in order, with a progress bar.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use indicatif::{ProgressBar, ProgressStyle};

const BLOCK: usize = 128;

/// Returns a bar for `count` steps of what `label` names, on standard error; it is silent where
/// that is not a terminal.
pub fn bar(label: &str, count: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:32} {bar:40} {pos}/{len} {eta}")
        .expect("a valid template");
    ProgressBar::new(count as u64)
        .with_style(style)
        .with_message(label.to_owned())
}

/// Returns `make` of every item, computed on all cores, in the order of the items.
pub fn map<I: Sync, T: Send>(label: &str, items: &[I], make: impl Fn(&I) -> T + Sync) -> Vec<T> {
    let bar = bar(label, items.len());
    let next = AtomicUsize::new(0);
    let blocks = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        let workers = std::thread::available_parallelism().map_or(1, usize::from);
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let block = next.fetch_add(1, Ordering::Relaxed);
                    let Some(part) = items.chunks(BLOCK).nth(block) else {
                        return;
                    };
                    let made: Vec<T> = part.iter().map(&make).collect();
                    bar.inc(part.len() as u64);
                    blocks
                        .lock()
                        .expect("no worker panicked")
                        .push((block, made));
                }
            });
        }
    });
    bar.finish_and_clear();
    let mut blocks = blocks.into_inner().expect("no worker panicked");
    blocks.sort_by_key(|(block, _)| *block);
    blocks.into_iter().flat_map(|(_, made)| made).collect()
}
