//! Everything that is tested through the public interface, as one binary: one link, one device, many threads.
//!
//! The tests need an adapter (a software one will do) and fail without one. `SHADOW_TEST_BACKEND=gl` runs them on OpenGL
//! instead of Vulkan, `SHADOW_GOLDEN=update` rewrites the reference images, `SHADOW_HARD_CASES=update` the table in
//! `doc/hard_cases.md` (one backend's column a run).

mod suite;
mod support;
