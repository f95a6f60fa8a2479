//! Writes a configuration as the Rust that describes it to the library.

use shadow_support::measure::configuration::{Configuration, Method};
use shadow_support::scene::Light;
use wgpu_shadows::CascadeLayout;

/// Returns the descriptor of a light's shadows; a configuration of the tutorial's method has none.
pub fn descriptor(configuration: &Configuration, light: &Light) -> String {
    let Method::Library { filter, .. } = configuration.method else {
        return String::new();
    };
    let (name, layout) = match light {
        Light::Sun { .. } => ("DirectionalShadowDescriptor", Some(configuration.layout)),
        Light::Spot { .. } => ("SpotShadowDescriptor", None),
        Light::Point { .. } => ("OmniShadowDescriptor", None),
    };
    let map_size = configuration.map_size_for(light);
    let mut lines = vec![format!("    map_size: {map_size},")];
    lines.extend(layout.map(|layout| match layout {
        CascadeLayout::Fixed { cascades, .. } => {
            format!("    layout: CascadeLayout::fixed({cascades}),")
        }
        found => format!("    layout: CascadeLayout::{found:?},"),
    }));
    lines.push(format!("    filter: Filter::{filter:?},"));
    format!(
        "{name} {{\n{}\n    ..Default::default()\n}}",
        lines.join("\n")
    )
}
