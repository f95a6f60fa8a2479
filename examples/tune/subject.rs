//! Turns a file's triangles, one of its lights and one of its cameras into a scene to measure.

use std::path::Path;

use example_support::gltf_file;
use example_support::gltf_file::scene::{
    Instance, Light as FileLight, LightKind, Scene as FileScene,
};
use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::scene::{Light, Scene};
use shadow_support::scenes;

use crate::options::Options;

/// Returns the scene that the options name.
pub fn scene(options: &Options) -> Result<Scene, String> {
    let mut scene = match &options.file {
        Some(path) => from_file(path, options)?,
        None if options.light > 0 || options.camera > 0 => {
            return Err("--light and --camera choose from a FILE, and none is given".to_owned());
        }
        None => {
            println!("no file is given: boxes under a sun are measured");
            scenes::boxes("boxes", DVec3::ZERO)
        }
    };
    set_extent(&mut scene.light, options)?;
    Ok(scene)
}

fn from_file(path: &Path, options: &Options) -> Result<Scene, String> {
    let file = gltf_file::load(path, options.picture_size(), options.camera)?;
    let count = file.lights.len();
    let light = *file.lights.get(options.light).ok_or(format!(
        "there is no light {}: {} has {count}",
        options.light,
        path.display()
    ))?;
    println!(
        "{}: {} triangles, light {} of {count} ({})",
        path.display(),
        file.triangle_count(),
        options.light,
        match light.kind {
            LightKind::Directional => "a sun",
            LightKind::Spot { .. } => "a spot",
            LightKind::Point => "a point light",
        }
    );
    let masked = file.materials.iter().any(|m| m.alpha_cutoff > 0.0);
    let masked = masked.then(|| "surfaces with alpha masks count as solid".to_owned());
    for note in file.notes.iter().chain(&masked) {
        println!("note: {note}");
    }
    let meshes: Vec<Mesh> = baked(&file);
    let corners = || meshes.iter().flat_map(|mesh| &mesh.positions);
    if !corners().all(|corner| corner.is_finite()) {
        return Err(format!("{} is too large for f32", path.display()));
    }
    let mut triangles = meshes
        .iter()
        .flat_map(|mesh| mesh.triangles(&Mat4::IDENTITY));
    if !triangles.any(|triangle| triangle.try_normal().is_some()) {
        return Err(format!("{} has no triangle with an area", path.display()));
    }
    let farthest = corners().map(|corner| corner.distance(light.position_render));
    let farthest = farthest.fold(0.0, f32::max);
    Ok(Scene {
        name: "the file",
        light: convert(&light, file.origin, farthest)?,
        camera: file.camera,
        origin: file.origin,
        meshes,
    })
}

/// Returns every instance with its transform multiplied out, so that rays and device meet the same
/// corners to the bit.
fn baked(file: &FileScene) -> Vec<Mesh> {
    let bake = |instance: &Instance| {
        let mesh = &file.meshes[instance.mesh];
        let place = instance.render_from_model.as_dmat4();
        let corner = |position: [f32; 3]| {
            let position = Vec3::from_array(position).as_dvec3();
            place.transform_point3(position).as_vec3()
        };
        Mesh {
            positions: mesh.vertices.iter().map(|v| corner(v.position)).collect(),
            indices: mesh.indices.clone(),
        }
    };
    file.instances.iter().map(bake).collect()
}

/// Converts the light without its extent. One without a range reaches all corners.
fn convert(light: &FileLight, origin: DVec3, farthest: f32) -> Result<Light, String> {
    let range = light.range.min(1.01 * farthest);
    let position_world = origin + light.position_render.as_dvec3();
    if !position_world.is_finite() || range.is_nan() || range <= 0.0 {
        return Err("the light stands at no finite place, or reaches nothing".to_owned());
    }
    Ok(match light.kind {
        LightKind::Directional => Light::sun(light.direction),
        LightKind::Spot { .. } => Light::Spot {
            position_world,
            direction: light.direction,
            outer_angle_radians: light.kind.outer_angle_radians(),
            range,
            radius_world: 0.0,
        },
        LightKind::Point => Light::Point {
            position_world,
            range,
            radius_world: 0.0,
        },
    })
}

fn set_extent(light: &mut Light, options: &Options) -> Result<(), String> {
    match light {
        Light::Sun {
            angular_diameter_radians,
            ..
        } => {
            if options.light_radius.is_some() {
                return Err("the extent of a sun is its --angular-diameter".to_owned());
            }
            *angular_diameter_radians = options.angular_diameter.map_or(0.0, f64::from);
            if *angular_diameter_radians >= std::f64::consts::PI {
                return Err("--angular-diameter must be below π".to_owned());
            }
        }
        Light::Spot { radius_world, .. } | Light::Point { radius_world, .. } => {
            if options.angular_diameter.is_some() {
                return Err("the extent of a spot or point light is its --light-radius".to_owned());
            }
            *radius_world = options.light_radius.unwrap_or(0.0);
        }
    }
    Ok(())
}
