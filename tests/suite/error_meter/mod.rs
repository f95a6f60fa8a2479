//! Tests the error meter: its rays, its intervals, and what it notices.

mod agreement;
mod engine_stages;
mod faults;
mod input;
mod interval;
