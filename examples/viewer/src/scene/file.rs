//! Builds the scene of a glTF file, in the colours of its materials.

use example_support::gltf_file;
use example_support::gltf_file::scene::{LightKind, Material, Mesh, Picture, Scene as Loaded};
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
#[cfg(not(target_arch = "wasm32"))]
pub fn from_path(path: &std::path::Path) -> Result<Scene, String> {
    let name = path.file_name().unwrap_or(path.as_os_str());
    of(gltf_file::load(path, SIZE, 0)?, &name.to_string_lossy())
}

/// Reads the bytes of a .glb file.
#[cfg(any(test, target_arch = "wasm32"))]
pub fn from_bytes(bytes: &[u8], name: &str) -> Result<Scene, String> {
    of(gltf_file::load_bytes(bytes, name, SIZE, 0)?, name)
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
        models.push(Model::solid(
            corners(mesh, material.double_sided),
            instances,
        ));
    }
    let bounds = loaded.bounds_render();
    let diameter = (bounds.max - bounds.min).length();
    let render_from_view = loaded.camera.view_from_render.inverse();
    let eye = render_from_view.w_axis.truncate();
    let forward = -render_from_view.z_axis.truncate();
    let middle = (bounds.min + bounds.max) * 0.5;
    let distance = (middle - eye).dot(forward).max(0.05 * diameter);
    let viewpoint = Viewpoint::new(eye, eye + forward * distance, field_of_view(&loaded));
    let sun = loaded
        .lights
        .iter()
        .find(|light| light.kind == LightKind::Directional);
    let toward_sun = sun.map_or(Vec3::new(0.5, 0.766, 0.405), |sun| -sun.direction);
    let mut notes = loaded.notes;
    if loaded
        .lights
        .iter()
        .any(|light| light.kind != LightKind::Directional)
    {
        notes.push("spots and lamps of the file are not shown, only a sun".to_owned());
    }
    if loaded
        .materials
        .iter()
        .any(|material| material.image.is_some())
    {
        notes.push("textures are shown by their mean colour, without holes".to_owned());
    }
    Ok(Scene {
        extent: diameter,
        sides: [SideSettings::textbook(diameter), SideSettings::library()],
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
            normal: Vec3::from_array(corners[corner].normal)
                .try_normalize()
                .unwrap_or(facet),
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a .glb file of one triangle, red and of two sides.
    fn triangle() -> Vec<u8> {
        let mut json = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
            "nodes":[{"mesh":0}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
            "materials":[{"doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}],
            "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
            "min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],
            "buffers":[{"byteLength":36}]}"#
            .to_owned();
        json += &" ".repeat(json.len().next_multiple_of(4) - json.len());
        let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mut file = b"glTF".to_vec();
        let length = 12 + 8 + json.len() + 8 + 36;
        for number in [2, length as u32, json.len() as u32] {
            file.extend(number.to_le_bytes());
        }
        file.extend(b"JSON");
        file.extend(json.as_bytes());
        file.extend(36_u32.to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(bytemuck::cast_slice::<_, u8>(&corners));
        file
    }

    #[test]
    fn a_file_is_shown_in_its_colours_from_both_sides() {
        let scene = from_bytes(&triangle(), "triangle.glb").expect("a valid file");
        assert_eq!(scene.name, "triangle.glb");
        let [model] = &scene.models[..] else {
            panic!("one mesh")
        };
        assert_eq!(model.vertices.len(), 6);
        assert_eq!(model.vertices[0].normal, Vec3::Z);
        assert_eq!(model.vertices[3].normal, Vec3::NEG_Z);
        assert_eq!(model.instances[0].albedo, Vec3::X);
        // The loader's camera looks at the middle of the bounds.
        let way = scene.bounds().max + scene.bounds().min;
        let middle = way * 0.5 - scene.viewpoint.eye;
        assert!(middle.normalize().dot(scene.viewpoint.forward()) > 0.999);
    }

    #[test]
    fn a_file_that_cannot_be_read_is_an_error_that_names_it() {
        let whole = triangle();
        for length in [0, 4, 11, 12, 40, whole.len() - 1] {
            let error = from_bytes(&whole[..length], "cut.glb")
                .err()
                .expect("an error");
            assert!(error.contains("cut.glb"), "{error}");
        }
    }
}
