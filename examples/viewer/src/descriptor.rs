//! Makes the library's descriptors of what is set, and writes them as Rust.
//!
//! This is the only place that knows the fields of a descriptor.

use wgpu_shadows::{
    CascadeLayout, CascadeSplit, DirectionalShadowDescriptor, Filter, pool::PoolDescriptor,
};

use crate::settings::{Covers, SideSettings};

/// Is the least size of a light that a filter of penumbrae accepts; smaller ones are hard anyway.
const LEAST_LIGHT_SIZE: f32 = 1e-4;

/// Is the radius of a lamp in world units.
pub const LAMP_RADIUS: f32 = 0.06;

impl SideSettings {
    /// Returns the descriptor of the sun's shadows, for a sun of this angular diameter.
    pub fn sun(&self, sun_radians: f32) -> DirectionalShadowDescriptor<'static> {
        DirectionalShadowDescriptor {
            label: None,
            map_size: self.map_size,
            layout: self.layout(),
            filter: with_light_size(self.filter, sun_radians),
            bias: self.bias,
            blend: self.blend,
            fade: self.fade,
            stability: self.stability,
            depth_format: self.depth_format,
        }
    }

    fn layout(&self) -> CascadeLayout<'static> {
        if self.divides_map {
            CascadeLayout::Automatic {
                max_cascades: self.cascades,
            }
        } else {
            CascadeLayout::Fixed {
                cascades: self.cascades,
                split: self.split,
            }
        }
    }

    /// Returns the descriptor of a pool of lamps.
    pub fn lamps(&self, capacity: u32) -> PoolDescriptor<'static> {
        PoolDescriptor {
            label: None,
            capacity,
            map_size: self.lamp_map_size,
            filter: with_light_size(self.lamp_filter, LAMP_RADIUS),
            bias: self.bias,
            fade: 0.0,
        }
    }

    /// Returns the descriptor of a pool of spot lights, which take no filter of directions, and
    /// have a quarter of the texels of the lamps.
    pub fn spots(&self, capacity: u32) -> PoolDescriptor<'static> {
        let lamps = self.lamps(capacity);
        PoolDescriptor {
            map_size: (self.lamp_map_size / 2).max(1),
            filter: match lamps.filter {
                Filter::DirectionGrid { .. } | Filter::DirectionStar { .. } => Filter::Box,
                filter => filter,
            },
            ..lamps
        }
    }

    /// Returns Rust that makes [`SideSettings::sun`]: the members that differ from the default.
    pub fn sun_rust(&self, sun_radians: f32) -> String {
        let own = self.sun(sun_radians);
        let default = DirectionalShadowDescriptor::default();
        let mut members = Members::default();
        members.add("map_size", own.map_size, default.map_size, "");
        members.add_text(
            "layout",
            own.layout != default.layout,
            layout_rust(own.layout),
        );
        members.add("filter", own.filter, default.filter, "Filter::");
        members.add("bias", own.bias, default.bias, "Bias::");
        members.add("blend", own.blend, default.blend, "");
        members.add("fade", own.fade, default.fade, "");
        let (format, default_format) = (own.depth_format, default.depth_format);
        members.add("stability", own.stability, default.stability, "Stability::");
        members.add("depth_format", format, default_format, "DepthFormat::");
        members.of("DirectionalShadowDescriptor")
    }

    /// Returns Rust that makes [`SideSettings::lamps`].
    pub fn lamps_rust(&self, capacity: u32) -> String {
        pool_rust(&self.lamps(capacity))
    }

    /// Returns Rust that makes [`SideSettings::spots`].
    pub fn spots_rust(&self, capacity: u32) -> String {
        pool_rust(&self.spots(capacity))
    }

    /// Returns what of the settings belongs to a frame and not to a descriptor, as comments.
    pub fn frame_comments(&self) -> String {
        let mut text = String::new();
        if self.covers == Covers::Scene {
            text +=
                "// In ShadowFrameDescriptor: coverage: Coverage::Bounds(bounds_of_the_scene)\n";
        }
        if self.max_distance > 0.0 {
            text += &format!("// In CameraView: max_distance: {:?}\n", self.max_distance);
        }
        text
    }
}

fn pool_rust(own: &PoolDescriptor<'_>) -> String {
    let default = PoolDescriptor::default();
    let mut members = Members::default();
    members.add("capacity", own.capacity, default.capacity, "");
    members.add("map_size", own.map_size, default.map_size, "");
    members.add("filter", own.filter, default.filter, "Filter::");
    members.add("bias", own.bias, default.bias, "Bias::");
    members.add("fade", own.fade, default.fade, "");
    members.of("PoolDescriptor")
}

/// Returns Rust that makes a layout.
fn layout_rust(layout: CascadeLayout<'_>) -> String {
    match layout {
        CascadeLayout::Fixed {
            cascades,
            split: CascadeSplit::Logarithmic,
        } => format!("CascadeLayout::fixed({cascades})"),
        CascadeLayout::Fixed { cascades, split } => {
            let split = format!("CascadeSplit::{split:?}");
            format!("CascadeLayout::Fixed {{ cascades: {cascades}, split: {split} }}")
        }
        other => format!("CascadeLayout::{other:?}"),
    }
}

/// Returns the filter with the size of the light, if it has one.
fn with_light_size(filter: Filter, size: f32) -> Filter {
    let light_size = size.max(LEAST_LIGHT_SIZE);
    match filter {
        Filter::Pcss { .. } => Filter::Pcss { light_size },
        Filter::PcssRotated { .. } => Filter::PcssRotated { light_size },
        filter => filter,
    }
}

/// Collects the members of a struct expression.
#[derive(Default)]
struct Members(Vec<String>);

impl Members {
    /// Adds a member if it differs from the default. `path` precedes the value.
    fn add<T: PartialEq + std::fmt::Debug>(&mut self, name: &str, own: T, default: T, path: &str) {
        self.add_text(name, own != default, format!("{path}{own:?}"));
    }

    /// Adds a member whose value is given as Rust if it differs from the default.
    fn add_text(&mut self, name: &str, differs: bool, value: String) {
        if differs {
            self.0.push(format!("    {name}: {value},\n"));
        }
    }

    fn of(self, name: &str) -> String {
        let members = self.0.concat();
        format!("{name} {{\n{members}    ..Default::default()\n}}")
    }
}

#[cfg(test)]
mod tests {
    use wgpu_shadows::{Bias, DepthFormat, Stability};

    use super::*;

    fn without_spaces(text: &str) -> String {
        // rustfmt ends a list with a comma, where `stringify` sees it.
        text.split_whitespace()
            .collect::<String>()
            .replace(",}", "}")
    }

    /// Compiles the Rust, and compares its text and its value.
    macro_rules! check {
        ($text:expr, $value:expr, $rust:expr) => {
            assert_eq!(without_spaces(&$text), without_spaces(stringify!($rust)));
            assert_eq!($value, $rust);
        };
    }

    #[test]
    fn the_default_is_short() {
        let side = SideSettings::library();
        check!(
            side.sun_rust(0.01),
            side.sun(0.01),
            DirectionalShadowDescriptor {
                ..Default::default()
            }
        );
    }

    #[test]
    fn every_member_is_written_as_rust_that_compiles() {
        let side = SideSettings {
            map_size: 512,
            cascades: 3,
            divides_map: false,
            split: CascadeSplit::Practical { lambda: 0.75 },
            filter: Filter::PcssRotated { light_size: 9.0 },
            bias: Bias::Manual {
                constant: 1e-7,
                slope: 2.0,
            },
            blend: 0.1,
            fade: 0.25,
            stability: Stability::BoundingSphere,
            depth_format: DepthFormat::Unorm16,
            ..SideSettings::library()
        };
        check!(
            side.sun_rust(0.5),
            side.sun(0.5),
            DirectionalShadowDescriptor {
                map_size: 512,
                layout: CascadeLayout::Fixed {
                    cascades: 3,
                    split: CascadeSplit::Practical { lambda: 0.75 }
                },
                filter: Filter::PcssRotated { light_size: 0.5 },
                bias: Bias::Manual {
                    constant: 1e-7,
                    slope: 2.0
                },
                blend: 0.1,
                fade: 0.25,
                stability: Stability::BoundingSphere,
                depth_format: DepthFormat::Unorm16,
                ..Default::default()
            }
        );
    }

    #[test]
    fn pools_are_written_as_rust_that_compiles() {
        let side = SideSettings::textbook(20.0);
        check!(
            side.lamps_rust(32),
            side.lamps(32),
            PoolDescriptor {
                capacity: 32,
                filter: Filter::DirectionGrid { radius: 0.1 },
                bias: Bias::Manual {
                    constant: 0.099999994,
                    slope: 1.0
                },
                ..Default::default()
            }
        );
        check!(
            side.spots_rust(4),
            side.spots(4),
            PoolDescriptor {
                capacity: 4,
                map_size: 1024,
                filter: Filter::Box,
                bias: Bias::Manual {
                    constant: 0.099999994,
                    slope: 1.0
                },
                ..Default::default()
            }
        );
    }
}
