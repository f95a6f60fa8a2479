//! Tests everything through the public interface, in one binary: one link, one device, many
//! threads.
//!
//! The tests need an adapter (a software one suffices) and fail without one.
//! `SHADOW_TEST_BACKEND=gl` runs them on OpenGL instead of Vulkan, `SHADOW_GOLDEN=update` rewrites
//! the reference images, and `SHADOW_HARD_CASES=update` rewrites the table in `doc/hard_cases.md`
//! (one backend's column per run).

mod fixtures;
mod suite;
