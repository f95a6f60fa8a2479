//! Compares the structs that Rust writes and WGSL reads, member by member.

use std::collections::BTreeMap;
use std::mem::offset_of;

use wgpu_shadows::{ShadowViewUniform, shader};

use crate::support::wgsl;

/// Maps each member to its offset and size in bytes.
type Layout = BTreeMap<String, (usize, usize)>;

/// Returns the members and the span of a WGSL struct, as naga lays it out.
fn wgsl_layout(module: &str, name: &str) -> (Layout, usize) {
    let source = shader::compose(&[module]).expect("a module of the table");
    let parsed = wgsl::validate(&source).unwrap_or_else(|error| panic!("{error}"));
    let mut layouter = naga::proc::Layouter::default();
    layouter.update(parsed.to_ctx()).expect("a laid out module");
    let found = parsed
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some(name));
    let (_, ty) = found.unwrap_or_else(|| panic!("no struct {name}"));
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{name} is no struct");
    };
    let members = members
        .iter()
        .map(|member| {
            let size = layouter[member.ty].size as usize;
            let name = member.name.clone().expect("a named member");
            (name, (member.offset as usize, size))
        })
        .collect();
    (members, *span as usize)
}

macro_rules! rust_layout {
    ($ty:ty { $($member:ident),* $(,)? }) => {{
        let value = <$ty as bytemuck::Zeroable>::zeroed();
        Layout::from([
            $((stringify!($member).to_owned(), (offset_of!($ty, $member), size_of_val(&value.$member)))),*
        ])
    }};
}

/// Every member has the same offset and size under the same name, and the whole has the same size, so that arrays of it
/// have one stride.
#[test]
fn shadow_view_is_one_layout() {
    let (wgsl, span) = wgsl_layout("view", "ShadowView");
    let rust = rust_layout!(ShadowViewUniform {
        texel_from_anchor,
        plane_across,
        plane_down,
        plane_depth,
        light,
        anchor,
        layer,
        inner,
        map_size,
        depth_error,
        depth_error_relative,
        lateral_error,
        offset_texels,
        offset_world,
        manual_constant,
        manual_slope,
        sharpness,
        range,
        cone_cosine,
        sample_radius,
        viewer,
        penumbra,
        fade_texels,
        grid,
    });
    assert_eq!(wgsl, rust);
    assert_eq!(span, size_of::<ShadowViewUniform>());
    let bytes: usize = rust.values().map(|(_, size)| size).sum();
    assert_eq!(bytes, span, "padding would be uploaded uninitialised");
    // A uniform array needs a stride that is a multiple of 16.
    assert_eq!(span % 16, 0);
}
