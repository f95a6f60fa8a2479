//! Defines the configurations that are compared.

use std::fmt;

use wgpu_shadows::{Bias, CascadeLayout, DirectionalShadowDescriptor, Filter};

use super::chart::Mark;
use crate::scene::{Light, SUN_DIAMETER_RADIANS};

/// Is a technique with its settings, the same for every scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configuration {
    pub method: Method,
    /// Is the number of texels per side of a sun's map. Spot lights and the faces of point lights
    /// have half of that, as the library's defaults do.
    pub map_size: u32,
    /// States that maps cover what the camera sees; otherwise they cover the whole scene.
    pub fits_camera: bool,
    /// Is the layout of a sun's cascades; other lights ignore it.
    pub layout: CascadeLayout<'static>,
}

/// Selects how shadows are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    Library {
        filter: Filter,
        bias: Bias,
    },
    /// Uses the tutorial's final version for suns and spot lights, and its grid of 64 for point
    /// lights.
    Textbook,
    /// Uses the tutorial's 20 directions, for point lights.
    TextbookStar,
}

/// Is the manual bias that is measured in addition to the derived ones: the tutorial's constants in
/// metres, over a depth of four.
const MANUAL: Bias = Bias::Manual {
    constant: 0.02,
    slope: 0.2,
};

/// Selects how many configurations to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Measures every filter with every bias.
    Full,
    /// Measures every filter with its own bias, and two filters with every bias.
    Quick,
}

impl Configuration {
    /// Returns the library's default configuration.
    pub fn shipped_default() -> Self {
        Self::shipped(&DirectionalShadowDescriptor::default())
    }

    /// Returns the configuration of a descriptor of the library, for a camera.
    pub fn shipped(descriptor: &DirectionalShadowDescriptor<'static>) -> Self {
        Self {
            method: Method::Library {
                filter: descriptor.filter,
                bias: descriptor.bias,
            },
            map_size: descriptor.map_size,
            fits_camera: true,
            layout: descriptor.layout,
        }
    }

    /// Is the tutorial with its map of 1024 texels per side, by which times are divided.
    pub const BASELINE: Self = Self {
        method: Method::Textbook,
        map_size: 1024,
        fits_camera: false,
        layout: CascadeLayout::fixed(1),
    };

    /// Returns what the library recommends, cheapest first, by the name it has there.
    pub fn presets() -> [(&'static str, Self); 3] {
        [
            ("CHEAP", DirectionalShadowDescriptor::CHEAP),
            ("default", DirectionalShadowDescriptor::default()),
            ("ACCURATE", DirectionalShadowDescriptor::ACCURATE),
        ]
        .map(|(name, descriptor)| (name, Self::shipped(&descriptor)))
    }

    /// Returns the name under which the library recommends it, if it does.
    pub fn preset_name(&self) -> Option<&'static str> {
        let presets = Self::presets();
        let own = presets.iter().find(|(_, preset)| preset == self);
        own.map(|(name, _)| *name)
    }

    pub fn is_textbook(&self) -> bool {
        !matches!(self.method, Method::Library { .. })
    }

    /// Returns whether the library derives the bias.
    pub fn has_derived_bias(&self) -> bool {
        matches!(
            self.method,
            Method::Library {
                bias: Bias::Auto,
                ..
            }
        )
    }

    /// Returns the texels per side for this kind of light.
    pub fn map_size_for(&self, light: &Light) -> u32 {
        match light {
            Light::Sun { .. } => self.map_size,
            Light::Spot { .. } | Light::Point { .. } => self.map_size / 2,
        }
    }

    /// Returns whether the configuration suits a light: direction-space filters are for point
    /// lights only, and those with a light size for lights that have one.
    pub fn suits(&self, light: &Light) -> bool {
        let is_point = matches!(light, Light::Point { .. });
        match self.method {
            Method::Textbook => true,
            Method::TextbookStar => is_point,
            Method::Library { filter, .. } => {
                (is_point || filter.radius_world() == 0.0)
                    && (light.is_soft() || filter.light_size() == 0.0)
            }
        }
    }

    /// Returns the settings without the map's size.
    pub fn series(&self) -> String {
        let coverage = match (self.fits_camera, self.layout) {
            (true, CascadeLayout::Automatic { .. }) => "camera",
            (true, _) => "camera, 1 cascade",
            (false, _) => "scene",
        };
        match self.method {
            Method::Textbook => "textbook".to_owned(),
            Method::TextbookStar => "textbook, 20 directions".to_owned(),
            Method::Library { filter, bias } => {
                let filter = filter_name(filter);
                match bias_name(bias) {
                    "auto" => format!("{filter}, {coverage}"),
                    bias => format!("{filter}, {bias}, {coverage}"),
                }
            }
        }
    }

    /// Returns the filter with whose floor the aliasing of edges is compared.
    pub fn floor_filter(&self) -> Filter {
        match self.method {
            Method::Library { filter, .. } => filter,
            Method::Textbook => Filter::Box,
            Method::TextbookStar => Filter::Nearest,
        }
    }

    /// Returns the part of the settings that a chart shows by colour.
    pub fn family(&self) -> String {
        match self.method {
            Method::Textbook | Method::TextbookStar => "textbook".to_owned(),
            Method::Library { filter, .. } => filter_name(filter),
        }
    }

    /// Returns the part of the settings that a chart shows by the shape of the mark.
    pub fn mark(&self) -> Mark {
        match self.method {
            Method::Textbook | Method::TextbookStar => Mark::Cross,
            Method::Library {
                bias: Bias::Auto, ..
            } if self.fits_camera => Mark::Circle,
            Method::Library {
                bias: Bias::Auto, ..
            } => Mark::Square,
            Method::Library { .. } => Mark::Triangle,
        }
    }
}

impl fmt::Display for Configuration {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}, {}", self.series(), self.map_size)
    }
}

/// Returns all configurations to measure, the textbook last.
pub fn all(extent: Extent, map_sizes: &[u32]) -> Vec<Configuration> {
    let mut methods = Vec::new();
    for filter in filters(extent) {
        for bias in [Bias::Auto, Bias::NormalOffset, MANUAL] {
            let exemplary = matches!(filter, Filter::Hardware) || filter == Filter::default();
            // The comparison sampler's own bias is the normal offset.
            let again = filter == Filter::Hardware && bias == Bias::NormalOffset;
            if bias == Bias::Auto || !again && (extent == Extent::Full || exemplary) {
                methods.push(Method::Library { filter, bias });
            }
        }
    }
    let mut all = Vec::new();
    for &map_size in map_sizes {
        let found = CascadeLayout::default();
        let single = CascadeLayout::fixed(1);
        for (fits_camera, layout) in [(true, found), (true, single), (false, single)] {
            let own = methods.iter().map(|&method| Configuration {
                method,
                map_size,
                fits_camera,
                layout,
            });
            // Other biases are compared under one layout for each kind of coverage.
            all.extend(
                own.filter(|own| own.has_derived_bias() || !fits_camera || layout != single),
            );
        }
        for method in [Method::Textbook, Method::TextbookStar] {
            all.push(Configuration {
                method,
                map_size,
                ..Configuration::BASELINE
            });
        }
    }
    all
}

fn filters(extent: Extent) -> Vec<Filter> {
    let mut filters = Filter::PLANAR.to_vec();
    filters.extend([
        Filter::default(),
        Filter::Tent5 { sharpness: 4.0 },
        Filter::Tent7 { sharpness: 5.0 },
        Filter::Pcss {
            light_size: SUN_DIAMETER_RADIANS as f32,
        },
        Filter::PcssRotated {
            light_size: SUN_DIAMETER_RADIANS as f32,
        },
        Filter::DirectionGrid { radius: 0.1 },
        Filter::DirectionStar { radius: 0.04 },
    ]);
    if extent == Extent::Full {
        filters.extend([
            Filter::Bilinear { sharpness: 2.0 },
            Filter::Tent3 { sharpness: 2.0 },
            Filter::Tent5 { sharpness: 2.0 },
            Filter::Tent7 { sharpness: 3.0 },
        ]);
    }
    filters
}

/// Returns the name of a filter as in tables: its kind, and its sharpness where that is not 1.
pub fn filter_name(filter: Filter) -> String {
    let kind = match filter {
        Filter::Nearest => "nearest",
        Filter::Hardware => "hardware 2x2",
        Filter::Box => "box 3x3",
        Filter::Bilinear { .. } => "bilinear 2x2",
        Filter::Tent3 { .. } => "tent 3x3",
        Filter::Tent5 { .. } => "tent 5x5",
        Filter::Tent7 { .. } => "tent 7x7",
        Filter::Pcss { .. } => "PCSS",
        Filter::PcssRotated { .. } => "PCSS rotated",
        Filter::DirectionGrid { .. } => "direction grid",
        Filter::DirectionStar { .. } => "direction star",
        _ => "other",
    };
    if filter.sharpness() > 1.0 && filter.light_size() == 0.0 {
        format!("{kind} sharp {}", filter.sharpness())
    } else {
        kind.to_owned()
    }
}

pub fn bias_name(bias: Bias) -> &'static str {
    match bias {
        Bias::Auto => "auto",
        Bias::NormalOffset => "normal offset",
        Bias::Manual { .. } => "manual",
        _ => "other",
    }
}
