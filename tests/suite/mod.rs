//! One module per thing that could be wrong.

mod any_input;
mod binding_errors;
mod caster_errors;
mod casters;
mod contact;
mod depth_texture;
mod emitted_wgsl;
mod engine_wgsl;
mod errors;
mod filter_parity;
mod fit_images;
mod frame_errors;
mod golden;
mod keeping;
mod mesh_errors;
mod out_of_range;
mod receiver_parity;
mod self_shadow;
mod shader_validation;
mod uniform_layout;
