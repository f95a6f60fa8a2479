//! Holds everything that a person sets: what the address of the page keeps.

use glam::Vec3;
use wgpu_shadows::{Bias, CascadeSplit, DepthFormat, Filter, Stability};

use crate::viewpoint::Viewpoint;

/// Is the angular diameter of the sun in degrees.
pub const SUN_DEGREES: f32 = 0.533;

/// Holds the settings of the whole picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Is the name of a built-in scene, or that of a file.
    pub scene: String,
    pub viewpoint: Viewpoint,
    /// Is the height of the sun above the horizon in degrees, -5..=90.
    pub elevation_degrees: f32,
    /// Is the direction toward the sun from +X over +Z, in degrees, 0..=360.
    pub azimuth_degrees: f32,
    /// Is the angular diameter of the light in degrees; 0 for hard shadows.
    pub sun_degrees: f32,
    pub show: Show,
    /// States that the picture is divided: the first setting on the left, the second on the right.
    /// Otherwise the second is shown alone.
    pub is_split: bool,
    /// Is the share of the picture, 0..=1, that the left side has.
    pub divider: f32,
    /// Is the number of drawn pixels per pixel of the screen along each side: 0.25..=2.
    pub picture_scale: f32,
    /// Holds left and right.
    pub sides: [SideSettings; 2],
}

/// Selects what the picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    Scene,
    /// Shows the visibility of the sun as grey.
    Visibility,
    /// Shows the scene, tinted by the cascade that covers each pixel.
    Cascades,
    /// Shows one depth map of the sun.
    SunMap(u32),
    /// Shows the unfolded cube of one lamp.
    LampCross(u32),
    /// Shows the depth map of one spot light.
    SpotMap(u32),
    /// Shows the visibility that rays found.
    Truth,
    /// Shows where the visibility differs from that of the rays.
    Difference,
}

/// Holds the settings of the shadows on one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideSettings {
    pub covers: Covers,
    /// Is the distance from the camera at which shadows end, in world units; 0 for no end.
    pub max_distance: f32,
    pub map_size: u32,
    /// Is the number of cascades, or the largest one where they divide one map.
    pub cascades: u32,
    /// States that one map is divided among the cascades by predicted error; otherwise each has a
    /// map of its own.
    pub divides_map: bool,
    /// Selects where cascades with maps of their own end.
    pub split: CascadeSplit<'static>,
    /// Is the filter; the light size of a filter with penumbrae is that of the sun, whatever is
    /// written here.
    pub filter: Filter,
    pub bias: Bias,
    pub blend: f32,
    pub fade: f32,
    pub stability: Stability,
    pub depth_format: DepthFormat,
    /// Is the number of texels per side of the layer that all lamps share; the spots have half of
    /// it.
    pub lamp_map_size: u32,
    pub lamp_filter: Filter,
}

/// Selects what the maps of the sun cover.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Covers {
    /// Covers what the camera sees.
    Camera,
    /// Covers the bounds of the whole scene, as the tutorial does.
    Scene,
}

impl SideSettings {
    /// Are the library's defaults.
    pub const fn library() -> Self {
        Self {
            covers: Covers::Camera,
            max_distance: 0.0,
            map_size: 2048,
            cascades: 4,
            divides_map: true,
            split: CascadeSplit::Logarithmic,
            filter: Filter::Tent3 { sharpness: 3.0 },
            bias: Bias::Auto,
            blend: 0.0,
            fade: 0.0,
            stability: Stability::TightFit,
            depth_format: DepthFormat::Float32,
            lamp_map_size: 2048,
            lamp_filter: Filter::Tent3 { sharpness: 3.0 },
        }
    }

    /// Returns the technique of the tutorial at learnopengl.com: one map of 1024 texels over the
    /// whole scene, a bias by slope in units of the depth range, 3×3 comparisons, and 64 directions
    /// for lamps.
    pub fn textbook(depth_range_world: f32) -> Self {
        Self {
            covers: Covers::Scene,
            map_size: 1024,
            cascades: 1,
            divides_map: false,
            filter: Filter::Box,
            bias: Bias::Manual {
                constant: 0.005 * depth_range_world,
                slope: 0.05 * depth_range_world,
            },
            lamp_filter: Filter::DirectionGrid { radius: 0.1 },
            ..Self::library()
        }
    }
}

impl Settings {
    /// Returns the unit vector toward the sun.
    pub fn toward_sun(&self) -> Vec3 {
        let (up, across) = self.elevation_degrees.to_radians().sin_cos();
        let (z, x) = self.azimuth_degrees.to_radians().sin_cos();
        Vec3::new(x * across, up, z * across)
    }

    /// Sets the angles of a direction toward the sun.
    pub fn set_toward_sun(&mut self, toward_sun: Vec3) {
        let direction = toward_sun.normalize();
        self.elevation_degrees = direction.y.asin().to_degrees();
        let azimuth = direction.z.atan2(direction.x).to_degrees();
        self.azimuth_degrees = azimuth.rem_euclid(360.0);
    }

    /// Sets the sun of an hour of a day in spring, 6..=18, at the latitude of 40 degrees, with +X
    /// in the east and -Z in the north.
    pub fn set_hour(&mut self, hour: f32) {
        let angle = (hour - 6.0) / 12.0 * std::f32::consts::PI;
        let latitude = 40_f32.to_radians();
        self.set_toward_sun(Vec3::new(
            angle.cos(),
            angle.sin() * latitude.cos(),
            angle.sin() * latitude.sin(),
        ));
    }

    /// Returns the angular diameter of the sun in radians.
    pub fn sun_radians(&self) -> f32 {
        self.sun_degrees.to_radians()
    }
}
