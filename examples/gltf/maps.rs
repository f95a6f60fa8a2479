//! Makes the maps of the scene's lights, and the WGSL that chooses among them: a
//! `DirectionalShadow` for each sun, an `OmniShadow` for a point light that is alone, and pools for
//! spots and for several point lights.

use std::fmt::Write;

use example_support::gltf_file::scene::{Light, LightKind};
use shadow_support::gpu::Gpu;
use wgpu_shadows::{
    DirectionalShadow, DirectionalShadowDescriptor, OmniShadow, OmniShadowDescriptor, ShadowMaps,
    pool::OmniShadowPool, pool::PoolDescriptor, pool::ShadowSlot, pool::SpotShadowPool,
    report::ShadowReport,
};

use crate::options::Options;

/// Is the largest number of directional lights with shadows, each of which needs a texture of its
/// own.
const MAX_SUNS: usize = 4;
/// Is the number of local lights in one pool: 40 times six faces have 60 KB of uniforms, within
/// WebGPU's defaults.
const POOL_CAPACITY: usize = 40;

/// Is a set of maps, and the lights of the scene that it belongs to.
pub enum Maps {
    Sun {
        shadow: Box<DirectionalShadow>,
        light: usize,
    },
    Lamp {
        shadow: Box<OmniShadow>,
        light: usize,
    },
    Spots {
        pool: Box<SpotShadowPool>,
        slots: Vec<(ShadowSlot, usize)>,
    },
    Lamps {
        pool: Box<OmniShadowPool>,
        slots: Vec<(ShadowSlot, usize)>,
    },
}

impl Maps {
    pub fn source(&self) -> &ShadowMaps {
        match self {
            Self::Sun { shadow, .. } => shadow.maps(),
            Self::Lamp { shadow, .. } => shadow.maps(),
            Self::Spots { pool, .. } => pool.maps(),
            Self::Lamps { pool, .. } => pool.maps(),
        }
    }

    pub fn report(&self) -> &ShadowReport {
        self.source().report()
    }

    /// Returns the lights of the scene, with their index in the pool.
    pub fn lights(&self) -> Vec<(usize, u32)> {
        match self {
            Self::Sun { light, .. } | Self::Lamp { light, .. } => vec![(*light, 0)],
            Self::Spots { slots, .. } | Self::Lamps { slots, .. } => slots
                .iter()
                .map(|(slot, light)| (*light, slot.index()))
                .collect(),
        }
    }
}

/// Makes maps for suns one by one, for a point light that is alone, and for spots and several point
/// lights in pools.
/// Names end in a letter, as the library requires.
pub fn make_maps(
    gpu: &Gpu,
    lights: &[Light],
    options: &Options,
) -> Result<Vec<(String, Maps)>, String> {
    let of_kind = |wanted: fn(&LightKind) -> bool| -> Vec<usize> {
        (0..lights.len())
            .filter(|&light| wanted(&lights[light].kind))
            .collect()
    };
    let suns = of_kind(|kind| *kind == LightKind::Directional);
    let spots = of_kind(|kind| matches!(kind, LightKind::Spot { .. }));
    let lamps = of_kind(|kind| *kind == LightKind::Point);
    if suns.len() > MAX_SUNS {
        eprintln!(
            "note: {} of {} directional lights have shadows",
            MAX_SUNS,
            suns.len()
        );
    }
    // All lights of a pool share its texels. A few lamps may be as fine as a sun.
    let local_map_size = options.map_size.unwrap_or(4096);
    let letter = |number: usize| (b'a' + number as u8) as char;
    let mut maps = Vec::new();
    for (number, &light) in suns.iter().take(MAX_SUNS).enumerate() {
        let shadow = DirectionalShadow::new(
            &gpu.device,
            &DirectionalShadowDescriptor {
                label: Some("sun"),
                map_size: options.map_size.unwrap_or(2048),
                layout: options.layout(),
                filter: options.sun_filter(),
                bias: options.bias,
                ..Default::default()
            },
        )
        .map_err(|error| error.to_string())?;
        let shadow = Box::new(shadow);
        maps.push((
            format!("sun_{}", letter(number)),
            Maps::Sun { shadow, light },
        ));
    }
    let descriptor = |label, lights: &[usize]| PoolDescriptor {
        label: Some(label),
        capacity: lights.len() as u32,
        map_size: local_map_size,
        filter: options.local_filter(),
        bias: options.bias,
        ..Default::default()
    };
    for (number, lights) in spots.chunks(POOL_CAPACITY).enumerate() {
        let mut pool = SpotShadowPool::new(&gpu.device, &descriptor("spots", lights))
            .map_err(|error| error.to_string())?;
        let slots = take_slots(lights, || pool.insert())?;
        let pool = Box::new(pool);
        maps.push((
            format!("spots_{}", letter(number)),
            Maps::Spots { pool, slots },
        ));
    }
    if let [light] = lamps[..] {
        let default = OmniShadowDescriptor::default();
        let descriptor = OmniShadowDescriptor {
            label: Some("lamp"),
            map_size: options.map_size.unwrap_or(default.map_size),
            filter: options.local_filter(),
            bias: options.bias,
            ..default
        };
        let shadow =
            OmniShadow::new(&gpu.device, &descriptor).map_err(|error| error.to_string())?;
        let shadow = Box::new(shadow);
        maps.push(("lamp_a".to_owned(), Maps::Lamp { shadow, light }));
        return Ok(maps);
    }
    for (number, lights) in lamps.chunks(POOL_CAPACITY).enumerate() {
        let mut pool = OmniShadowPool::new(&gpu.device, &descriptor("lamps", lights))
            .map_err(|error| error.to_string())?;
        let slots = take_slots(lights, || pool.insert())?;
        let pool = Box::new(pool);
        maps.push((
            format!("lamps_{}", letter(number)),
            Maps::Lamps { pool, slots },
        ));
    }
    Ok(maps)
}

fn take_slots(
    lights: &[usize],
    mut insert: impl FnMut() -> Result<ShadowSlot, wgpu_shadows::ShadowError>,
) -> Result<Vec<(ShadowSlot, usize)>, String> {
    lights
        .iter()
        .map(|&light| Ok((insert().map_err(|error| error.to_string())?, light)))
        .collect()
}

/// Returns WGSL that defines `visibility_of_light(maps, index, position, normal)`.
pub fn visibility_of_light(maps: &[(String, Maps)]) -> String {
    let mut text = "fn visibility_of_light(maps: u32, index: u32, position: vec3<f32>, normal: vec3<f32>) -> f32 {\n    switch maps {\n".to_owned();
    for (number, (name, maps)) in (1..).zip(maps) {
        let index = match maps {
            Maps::Sun { .. } | Maps::Lamp { .. } => "",
            Maps::Spots { .. } | Maps::Lamps { .. } => "index, ",
        };
        // Writing to a String does not fail.
        let _ = writeln!(
            text,
            "        case {number}u: {{ return shadow_{name}({index}position, normal); }}"
        );
    }
    text + "        default: { return 1.0; }\n    }\n}\n"
}
