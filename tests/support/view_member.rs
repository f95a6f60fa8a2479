//! Reads and writes members of a view's uniform by their names in WGSL, in its bytes: in Rust they are not public. A
//! member of its mapping is called `mapping.texel_scale` and so on.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::LazyLock;

use bytemuck::Pod;
use glam::{DMat4, DVec2, DVec3, DVec4, Vec2, Vec3};
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

/// Returns the matrix from coordinates relative to the anchor to homogeneous texel x, texel y, ndc
/// depth and w that a view's members describe.
pub fn texel_from_anchor(view: &ShadowViewUniform) -> DMat4 {
    let number = |name| f64::from(member::<f32>(view, name));
    let pair = |name| Vec2::from_array(member(view, name)).as_dvec2();
    let vector = |name| Vec3::from_array(member(view, name)).as_dvec3();
    let [texel_scale, texel_offset] = ["mapping.texel_scale", "mapping.texel_offset"].map(pair);
    let [right, down, toward] = ["right", "down", "toward"].map(vector);
    let depth_scale = number("mapping.depth_scale");
    let middle = texel_offset + pair("middle");
    let (w, depth) = if number("is_local") > 0.0 {
        (
            DVec4::from((-toward, 0.0)),
            DVec4::new(0.0, 0.0, 0.0, depth_scale),
        )
    } else {
        let depth = DVec4::from((toward * depth_scale, number("depth_offset")));
        (DVec4::W, depth)
    };
    let across = DVec4::from((right * texel_scale.x, 0.0)) + w * middle.x;
    let down = DVec4::from((down * texel_scale.y, 0.0)) + w * middle.y;
    DMat4::from_cols(across, down, depth, w).transpose()
}

/// Returns the rows of the inverse transpose of that matrix, which give a plane's components along
/// texel x, texel y and depth.
pub fn plane_rows(view: &ShadowViewUniform) -> [DVec4; 3] {
    let anchor_from_texel = texel_from_anchor(view).inverse();
    [0, 1, 2].map(|column| anchor_from_texel.col(column))
}

/// Returns where a position of render space falls in the map: texel and ndc depth.
pub fn texel_and_depth(view: &ShadowViewUniform, position: DVec3) -> (DVec2, f64) {
    let anchor = Vec3::from_array(member(view, "anchor")).as_dvec3();
    let place = texel_from_anchor(view).project_point3(position - anchor);
    (place.truncate(), place.z)
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
    let mut found = BTreeMap::new();
    let mut add = |prefix: &str, members: &[naga::StructMember], from: u32| {
        for member in members {
            let size = module.types[member.ty].inner.size(module.to_ctx());
            let name = member.name.as_deref().expect("a named member");
            let start = (from + member.offset) as usize;
            found.insert(format!("{prefix}{name}"), start..start + size as usize);
        }
    };
    add("", members, 0);
    for member in members {
        if let naga::TypeInner::Struct { members: inner, .. } = &module.types[member.ty].inner {
            let name = member.name.as_deref().expect("a named member");
            add(&format!("{name}."), inner, member.offset);
        }
    }
    found
}
