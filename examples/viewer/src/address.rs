//! Writes the settings as the text behind the `#` of an address, and reads them.
//!
//! The text is `key=value&key=value`. Values that are missing keep what a scene begins with, and
//! what cannot be read is told and left out.

use glam::Vec3;
use wgpu_shadows::{Bias, CascadeSplit, DepthFormat, Filter, Stability};

use crate::scene;
use crate::settings::{Covers, Settings, Show, SideSettings};

const SIDES: [&str; 2] = ["left", "right"];

/// Returns the text of all settings.
pub fn write(settings: &Settings) -> String {
    let Settings {
        scene,
        viewpoint,
        elevation_degrees,
        azimuth_degrees,
        sun_degrees,
        show,
        is_split,
        divider,
        picture_scale,
        sides,
    } = settings;
    let [x, y, z] = viewpoint.eye.to_array();
    // The scene of a file cannot be opened again by its name.
    let scene = scene::NAMES.iter().find(|name| *name == scene);
    let mut pairs: Vec<String> = scene
        .map(|name| format!("scene={name}"))
        .into_iter()
        .collect();
    pairs.extend([
        format!("eye={x},{y},{z}"),
        format!("look={},{}", viewpoint.yaw, viewpoint.pitch),
        format!("distance={}", viewpoint.distance),
        format!("view={}", viewpoint.field_of_view_radians),
        format!("sun={elevation_degrees},{azimuth_degrees},{sun_degrees}"),
        format!("show={}", show_name(*show)),
        format!("split={}", u8::from(*is_split)),
        format!("divider={divider}"),
        format!("scale={picture_scale}"),
    ]);
    for (name, side) in SIDES.iter().zip(sides) {
        pairs.extend(side_pairs(side).map(|(key, value)| format!("{name}.{key}={value}")));
    }
    pairs.join("&")
}

/// Returns the name of the scene in a text.
pub fn scene_name(text: &str) -> Option<&str> {
    pairs(text)
        .find(|(key, _)| *key == "scene")
        .map(|(_, name)| name)
}

/// Reads a text over `settings`, but for the scene. Returns what it does not understand.
pub fn read(text: &str, settings: &mut Settings) -> Vec<String> {
    pairs(text)
        .filter(|(key, value)| set(settings, key, value).is_none())
        .map(|(key, value)| format!("the address says {key}={value}, which is no setting"))
        .collect()
}

fn pairs(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.trim_start_matches('#')
        .split('&')
        .filter_map(|pair| pair.split_once('='))
}

fn set(settings: &mut Settings, key: &str, value: &str) -> Option<()> {
    if let Some((side, key)) = key.split_once('.') {
        let side = SIDES.iter().position(|name| *name == side)?;
        return set_side(&mut settings.sides[side], key, value);
    }
    let viewpoint = &mut settings.viewpoint;
    match key {
        "scene" => {}
        "eye" => viewpoint.eye = Vec3::from_array(numbers(value)?),
        "look" => [viewpoint.yaw, viewpoint.pitch] = numbers(value)?,
        "distance" => viewpoint.distance = number(value, 1e-3, 1e6)?,
        "view" => viewpoint.field_of_view_radians = number(value, 0.01, 3.0)?,
        "sun" => {
            let [elevation, azimuth, size] = numbers(value)?;
            settings.elevation_degrees = elevation.clamp(-5.0, 90.0);
            settings.azimuth_degrees = azimuth.rem_euclid(360.0);
            settings.sun_degrees = size.clamp(0.0, 20.0);
        }
        "show" => settings.show = show(value)?,
        "split" => settings.is_split = value == "1",
        "divider" => settings.divider = number(value, 0.0, 1.0)?,
        "scale" => settings.picture_scale = number(value, 0.1, 2.0)?,
        _ => return None,
    }
    Some(())
}

fn side_pairs(side: &SideSettings) -> impl Iterator<Item = (&'static str, String)> {
    let SideSettings {
        covers,
        max_distance,
        map_size,
        cascades,
        divides_map,
        split,
        filter,
        bias,
        blend,
        fade,
        stability,
        depth_format,
        lamp_map_size,
        lamp_filter,
    } = *side;
    let is_scene = u8::from(covers == Covers::Scene);
    [
        ("scene", is_scene.to_string()),
        ("end", max_distance.to_string()),
        ("map", map_size.to_string()),
        ("cascades", cascades.to_string()),
        ("found", u8::from(divides_map).to_string()),
        ("splits", split_name(split)),
        ("filter", filter_name(filter)),
        ("bias", bias_name(bias)),
        ("blend", blend.to_string()),
        ("fade", fade.to_string()),
        (
            "still",
            u8::from(stability == Stability::BoundingSphere).to_string(),
        ),
        (
            "half",
            u8::from(depth_format == DepthFormat::Unorm16).to_string(),
        ),
        ("lamp_map", lamp_map_size.to_string()),
        ("lamp_filter", filter_name(lamp_filter)),
    ]
    .into_iter()
}

fn set_side(side: &mut SideSettings, key: &str, value: &str) -> Option<()> {
    match key {
        "scene" => {
            side.covers = if value == "1" {
                Covers::Scene
            } else {
                Covers::Camera
            }
        }
        "end" => side.max_distance = number(value, 0.0, 1e9)?,
        "map" => side.map_size = value.parse().ok().filter(|n| (1..=16384).contains(n))?,
        "cascades" => side.cascades = value.parse().ok().filter(|n| (1..=8).contains(n))?,
        "found" => side.divides_map = value == "1",
        "splits" => side.split = split(value)?,
        "filter" => side.filter = filter(value)?,
        "bias" => side.bias = bias(value)?,
        "blend" => side.blend = number(value, 0.0, 0.5)?,
        "fade" => side.fade = number(value, 0.0, 1.0)?,
        "still" if value == "1" => side.stability = Stability::BoundingSphere,
        "still" => side.stability = Stability::TightFit,
        "half" if value == "1" => side.depth_format = DepthFormat::Unorm16,
        "half" => side.depth_format = DepthFormat::Float32,
        "lamp_map" => {
            side.lamp_map_size = value.parse().ok().filter(|n| (16..=4096).contains(n))?
        }
        "lamp_filter" => side.lamp_filter = filter(value)?,
        _ => return None,
    }
    Some(())
}

fn show_name(show: Show) -> String {
    match show {
        Show::Scene => "scene".to_owned(),
        Show::Visibility => "visibility".to_owned(),
        Show::Cascades => "cascades".to_owned(),
        Show::SunMap(layer) => format!("map,{layer}"),
        Show::LampCross(lamp) => format!("lamp,{lamp}"),
        Show::SpotMap(spot) => format!("spot,{spot}"),
        Show::Truth => "truth".to_owned(),
        Show::Difference => "difference".to_owned(),
    }
}

fn show(text: &str) -> Option<Show> {
    let (name, number) = text.split_once(',').unwrap_or((text, "0"));
    let number = number.parse().ok()?;
    Some(match name {
        "scene" => Show::Scene,
        "visibility" => Show::Visibility,
        "cascades" => Show::Cascades,
        "map" => Show::SunMap(number),
        "lamp" => Show::LampCross(number),
        "spot" => Show::SpotMap(number),
        "truth" => Show::Truth,
        "difference" => Show::Difference,
        _ => return None,
    })
}

fn split_name(split: CascadeSplit<'_>) -> String {
    match split {
        CascadeSplit::Uniform => "uniform".to_owned(),
        CascadeSplit::Practical { lambda } => format!("practical,{lambda}"),
        _ => "logarithmic".to_owned(),
    }
}

fn split(text: &str) -> Option<CascadeSplit<'static>> {
    let (name, value) = text.split_once(',').unwrap_or((text, "0.5"));
    Some(match name {
        "uniform" => CascadeSplit::Uniform,
        "logarithmic" => CascadeSplit::Logarithmic,
        "practical" => CascadeSplit::Practical {
            lambda: number(value, 0.0, 1.0)?,
        },
        _ => return None,
    })
}

fn filter_name(filter: Filter) -> String {
    match filter {
        Filter::Nearest => "nearest".to_owned(),
        Filter::Hardware => "hardware".to_owned(),
        Filter::Box => "box".to_owned(),
        Filter::Bilinear { sharpness } => format!("bilinear,{sharpness}"),
        Filter::Tent3 { sharpness } => format!("tent3,{sharpness}"),
        Filter::Tent5 { sharpness } => format!("tent5,{sharpness}"),
        Filter::Tent7 { sharpness } => format!("tent7,{sharpness}"),
        Filter::Pcss { .. } => "pcss".to_owned(),
        Filter::PcssRotated { .. } => "pcss_rotated".to_owned(),
        Filter::DirectionGrid { radius } => format!("grid,{radius}"),
        Filter::DirectionStar { radius } => format!("star,{radius}"),
        _ => "tent3,3".to_owned(),
    }
}

fn filter(text: &str) -> Option<Filter> {
    let (name, value) = text.split_once(',').unwrap_or((text, "1"));
    let sharpness = number(value, 0.0, 1e6)?.max(1.0);
    let radius = number(value, 0.0, 1e6)?.max(1e-6);
    Some(match name {
        "nearest" => Filter::Nearest,
        "hardware" => Filter::Hardware,
        "box" => Filter::Box,
        "bilinear" => Filter::Bilinear { sharpness },
        "tent3" => Filter::Tent3 { sharpness },
        "tent5" => Filter::Tent5 { sharpness },
        "tent7" => Filter::Tent7 { sharpness },
        "pcss" => Filter::Pcss { light_size: 1.0 },
        "pcss_rotated" => Filter::PcssRotated { light_size: 1.0 },
        "grid" => Filter::DirectionGrid { radius },
        "star" => Filter::DirectionStar { radius },
        _ => return None,
    })
}

fn bias_name(bias: Bias) -> String {
    match bias {
        Bias::NormalOffset => "normal_offset".to_owned(),
        Bias::Manual { constant, slope } => format!("manual,{constant},{slope}"),
        _ => "auto".to_owned(),
    }
}

fn bias(text: &str) -> Option<Bias> {
    Some(match text.split_once(',') {
        None if text == "auto" => Bias::Auto,
        None if text == "normal_offset" => Bias::NormalOffset,
        Some(("manual", values)) => {
            let [constant, slope] = numbers(values)?.map(|value| value.max(0.0));
            Bias::Manual { constant, slope }
        }
        _ => return None,
    })
}

fn number(text: &str, least: f32, most: f32) -> Option<f32> {
    let number: f32 = text.parse().ok()?;
    number.is_finite().then(|| number.clamp(least, most))
}

fn numbers<const N: usize>(text: &str) -> Option<[f32; N]> {
    let numbers: Option<Vec<f32>> = text
        .split(',')
        .map(|text| number(text, -1e9, 1e9))
        .collect();
    numbers?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unusual() -> Settings {
        let mut settings = scene::built_in("town").expect("a scene").settings();
        settings.viewpoint.yaw = 0.1 + 0.2;
        settings.sun_degrees = 3.25;
        settings.show = Show::LampCross(7);
        settings.is_split = false;
        settings.divider = 1.0 / 3.0;
        settings.sides[0] = SideSettings {
            covers: Covers::Scene,
            max_distance: 123.456,
            map_size: 4096,
            cascades: 7,
            divides_map: true,
            split: CascadeSplit::Practical { lambda: 0.7 },
            filter: Filter::Tent7 { sharpness: 5.5 },
            bias: Bias::Manual {
                constant: 1e-7,
                slope: 0.3,
            },
            blend: 0.2,
            fade: 0.9,
            stability: Stability::BoundingSphere,
            depth_format: DepthFormat::Unorm16,
            lamp_map_size: 333,
            lamp_filter: Filter::DirectionStar { radius: 0.04 },
        };
        settings
    }

    #[test]
    fn what_is_written_is_read_again() {
        let wanted = unusual();
        let text = write(&wanted);
        assert_eq!(scene_name(&text), Some("town"));
        let mut settings = scene::built_in("town").expect("a scene").settings();
        assert_eq!(read(&text, &mut settings), Vec::<String>::new());
        assert_eq!(settings, wanted);
        for filter in Filter::PLANAR {
            assert_eq!(super::filter(&filter_name(*filter)), Some(*filter));
        }
    }

    #[test]
    fn nonsense_is_told_and_leaves_the_settings_alone() {
        let mut settings = unusual();
        let text = "eye=1,2&left.filter=tent9,1&sun=a,b,c&view=NaN&left.map=0&middle.map=1&x=y\
                    &left.bias=manual,1";
        assert_eq!(read(text, &mut settings).len(), 8);
        assert_eq!(settings, unusual());
    }
}
