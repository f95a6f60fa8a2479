//! Reads and writes members of a view's uniform by their names in WGSL, in its bytes: in Rust they are not public.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::LazyLock;

use bytemuck::Pod;
use wgpu_shadows::{ShadowViewUniform, shader};

use crate::support::wgsl;

/// Returns the member that is called `name` in WGSL. `T` must have the member's size.
pub fn member<T: Pod>(view: &ShadowViewUniform, name: &str) -> T {
    bytemuck::pod_read_unaligned(&bytemuck::bytes_of(view)[bytes_of_member(name)])
}

/// Returns `view` with another value for the member that is called `name` in WGSL. `T` must have the member's size.
pub fn with_member<T: Pod>(mut view: ShadowViewUniform, name: &str, value: T) -> ShadowViewUniform {
    let bytes = &mut bytemuck::bytes_of_mut(&mut view)[bytes_of_member(name)];
    bytes.copy_from_slice(bytemuck::bytes_of(&value));
    view
}

/// Returns the range of bytes that a member occupies.
fn bytes_of_member(name: &str) -> Range<usize> {
    static MEMBERS: LazyLock<BTreeMap<String, Range<usize>>> = LazyLock::new(members);
    let member = MEMBERS.get(name);
    member.unwrap_or_else(|| panic!("no member {name}")).clone()
}

/// Returns the ranges of bytes of all members of the WGSL struct, as naga lays it out.
fn members() -> BTreeMap<String, Range<usize>> {
    let source = shader::compose(&["view"]).expect("a module of the table");
    let module = wgsl::validate(&source).unwrap_or_else(|error| panic!("{error}"));
    let mut types = module.types.iter().map(|(_, ty)| ty);
    let uniform = types.find(|ty| ty.name.as_deref() == Some("ShadowViewUniform"));
    let Some(naga::TypeInner::Struct { members, span }) = uniform.map(|ty| &ty.inner) else {
        panic!("no struct ShadowViewUniform");
    };
    assert_eq!(u64::from(*span), ShadowViewUniform::SIZE_BYTES);
    let members = members.iter().map(|member| {
        let (start, size) = (
            member.offset,
            module.types[member.ty].inner.size(module.to_ctx()),
        );
        let name = member.name.clone().expect("a named member");
        (name, start as usize..(start + size) as usize)
    });
    members.collect()
}
