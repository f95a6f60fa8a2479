//! Builds the scene of a glTF file, in the colours of its materials.

use std::path::Path;

use example_support::gltf_file::scene::{LightKind, Material, Mesh, Picture, Scene as Loaded};
use example_support::gltf_file::{load, load_bytes};
use example_support::mesh::{Instance, Vertex};
use glam::Vec3;

use super::{Model, Scene, day};
use crate::settings::SideSettings;
use crate::viewpoint::Viewpoint;

/// Is the size that the loader makes a camera for; only the ratio counts.
const SIZE: [u32; 2] = [16, 9];

/// Is the largest number of triangles; every one of them is a leaf of the tree for rays.
const MOST_TRIANGLES: usize = 4_000_000;

/// Reads a file.
pub fn from_path(path: &Path) -> Result<Scene, String> {
    let name = path.file_name().unwrap_or(path.as_os_str());
    of(load(path, SIZE, 0)?, &name.to_string_lossy())
}

/// Reads the bytes of a .glb file.
pub fn from_bytes(bytes: &[u8], name: &str) -> Result<Scene, String> {
    of(load_bytes(bytes, name, SIZE, 0)?, name)
}

fn of(loaded: Loaded, name: &str) -> Result<Scene, String> {
    let triangles = loaded.triangle_count();
    if triangles > MOST_TRIANGLES {
        return Err(format!(
            "{name} has {triangles} triangles, and the viewer takes {MOST_TRIANGLES} at most"
        ));
    }
    let colors: Vec<Vec3> = loaded
        .materials
        .iter()
        .map(|material| color(material, &loaded.images))
        .collect();
    let mut models: Vec<Model> = Vec::new();
    for (index, mesh) in loaded.meshes.iter().enumerate() {
        let albedo = colors[mesh.material];
        let own = loaded.instances.iter();
        let instances: Vec<Instance> = own
            .filter(|instance| instance.mesh == index)
            .map(|instance| Instance {
                render_from_model: instance.render_from_model,
                albedo,
                checker: 0.0,
            })
            .collect();
        if instances.is_empty() {
            continue;
        }
        let material = &loaded.materials[mesh.material];
        models.push(Model::solid(corners(mesh, material.double_sided), instances));
    }
    let bounds = loaded.bounds_render();
    let diameter = (bounds.max - bounds.min).length();
    let render_from_view = loaded.camera.view_from_render.inverse();
    let eye = render_from_view.w_axis.truncate();
    let forward = -render_from_view.z_axis.truncate();
    let middle = (bounds.min + bounds.max) * 0.5;
    let distance = (middle - eye).dot(forward).max(0.05 * diameter);
    let viewpoint = Viewpoint::new(eye, eye + forward * distance, field_of_view(&loaded));
    let sun = loaded.lights.iter().find(|light| light.kind == LightKind::Directional);
    let toward_sun = sun.map_or(Vec3::new(0.5, 0.766, 0.405), |sun| -sun.direction);
    let mut notes = loaded.notes;
    if loaded.lights.iter().any(|light| light.kind != LightKind::Directional) {
        notes.push("spots and lamps of the file are not shown, only a sun".to_owned());
    }
    if loaded.materials.iter().any(|material| material.image.is_some()) {
        notes.push("textures are shown by their mean colour, without holes".to_owned());
    }
    Ok(Scene {
        extent: diameter,
        sides: [SideSettings::textbook(diameter), SideSettings::library(4)],
        notes,
        ..day(name, models, viewpoint, toward_sun)
    })
}

fn field_of_view(loaded: &Loaded) -> f32 {
    let matrix = loaded.camera.clip_from_view;
    let is_perspective = matrix.w_axis.w == 0.0;
    if is_perspective {
        2.0 * (1.0 / matrix.y_axis.y).atan()
    } else {
        0.8
    }
}

/// Returns the corners of all triangles, with the facet's normal where the file has none. Triangles
/// of two sides come twice, since the viewer draws front faces.
fn corners(mesh: &Mesh, double_sided: bool) -> Vec<Vertex> {
    let triangles = mesh.indices.chunks_exact(3).map(|indices| {
        let corners = [0, 1, 2].map(|corner| &mesh.vertices[indices[corner] as usize]);
        let positions = corners.map(|corner| Vec3::from_array(corner.position));
        let [a, b, c] = positions;
        let facet = (b - a).cross(c - a).normalize_or(Vec3::Y);
        [0, 1, 2].map(|corner| Vertex {
            position: positions[corner],
            normal: Vec3::from_array(corners[corner].normal).try_normalize().unwrap_or(facet),
        })
    });
    let fronts: Vec<Vertex> = triangles.flatten().collect();
    if !double_sided {
        return fronts;
    }
    let backs = example_support::mesh::inside_out(&fronts);
    fronts.into_iter().chain(backs).collect()
}

/// Returns the base colour times the mean of its texture, in linear light.
fn color(material: &Material, images: &[Picture]) -> Vec3 {
    let factor = material.base_color.truncate();
    let Some(image) = material.image.and_then(|index| images.get(index)) else {
        return factor;
    };
    let mut sum = Vec3::ZERO;
    let mut count = 0.0;
    // Every 97th pixel is enough for a mean.
    for pixel in image.rgba.chunks_exact(4).step_by(97) {
        let level = |byte: u8| (f32::from(byte) / 255.0).powf(2.2);
        sum += Vec3::new(level(pixel[0]), level(pixel[1]), level(pixel[2]));
        count += 1.0;
    }
    factor * (sum / f32::max(count, 1.0))
}
