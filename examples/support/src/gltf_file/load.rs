//! Loads a glTF file as triangles, textures, lights and a camera, with every node transform
//! multiplied out in f64.

use std::collections::HashMap;
use std::path::Path;

use glam::{DMat4, DQuat, DVec3, Vec3, Vec4};
use gltf::camera::Projection;
use gltf::khr_lights_punctual::Kind;
use shadow_support::measure::parallel;
use wgpu_shadows::Aabb;

use super::images;
use super::primitive;
use super::scene::{Instance, Lens, Light, LightKind, Material, Mesh, Scene, camera_view};

/// Is a node that carries something, with its transform.
struct Placed<'a> {
    node: gltf::Node<'a>,
    world_from_node: DMat4,
}

/// Loads `path` for an image of `size` pixels, seen by the file's `camera` (counted from 0).
pub fn load(path: &Path, size: [u32; 2], camera: usize) -> Result<Scene, String> {
    let name = path.display().to_string();
    let file = gltf::Gltf::open(path).map_err(|error| format!("cannot read {name}: {error}"))?;
    build(file, path.parent(), &name, size, camera)
}

/// Loads the bytes of a file that has everything in itself, as a .glb file has; `name` is that of
/// messages.
pub fn load_bytes(
    bytes: &[u8],
    name: &str,
    size: [u32; 2],
    camera: usize,
) -> Result<Scene, String> {
    let file = gltf::Gltf::from_slice(bytes);
    let file = file.map_err(|error| format!("cannot read {name}: {error}"))?;
    build(file, None, name, size, camera)
}

fn build(
    file: gltf::Gltf,
    folder: Option<&Path>,
    name: &str,
    size: [u32; 2],
    camera: usize,
) -> Result<Scene, String> {
    let failed = |error: gltf::Error| format!("cannot read {name}: {error}");
    let gltf::Gltf { document, blob } = file;
    let buffers = gltf::import_buffers(&document, folder, blob).map_err(failed)?;
    let images = images::load(&document, folder, &buffers).map_err(failed)?;
    let placed = placed_nodes(&document)?;
    let mut notes = Vec::new();
    let (meshes, ranges) = load_meshes(&document, &buffers, &mut notes);
    let world = world_instances(&placed, &meshes, &ranges)?;
    let bounds = world
        .iter()
        .fold(DBounds::EMPTY, |all, w| all.union(&w.bounds));
    if !bounds.is_finite() {
        return Err(format!("{name} has no triangles at finite places"));
    }

    let aspect = size[0] as f32 / size[1] as f32;
    let (world_from_view, lens) = find_camera(&placed, camera, &bounds, &mut notes)?;
    let (origin, camera) = camera_view(&world_from_view, &lens, aspect);
    let instances = world
        .into_iter()
        .map(|w| w.in_render_space(origin))
        .collect();
    let lights = find_lights(&placed, origin, &mut notes);
    if document.skins().next().is_some() {
        notes.push("skins are drawn in the pose of their vertices".to_owned());
    }
    Ok(Scene {
        origin,
        camera,
        meshes,
        materials: load_materials(&document),
        images,
        instances,
        lights,
        notes,
    })
}

/// Returns the nodes of the default scene, or of all scenes where none is the default.
fn placed_nodes(document: &gltf::Document) -> Result<Vec<Placed<'_>>, String> {
    let mut open: Vec<(gltf::Node<'_>, DMat4)> = match document.default_scene() {
        Some(scene) => scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect(),
        None => document
            .scenes()
            .flat_map(|scene| scene.nodes())
            .map(|node| (node, DMat4::IDENTITY))
            .collect(),
    };
    open.reverse();
    let mut placed = Vec::new();
    while let Some((node, world_from_parent)) = open.pop() {
        if placed.len() > document.nodes().len() {
            return Err("the node hierarchy has a loop".to_owned());
        }
        let world_from_node = world_from_parent * parent_from_node(&node.transform());
        let first_child = open.len();
        open.extend(node.children().map(|child| (child, world_from_node)));
        // The order is depth first as in the file, so that "the first camera" is what a reader of
        // the file would call so.
        open[first_child..].reverse();
        placed.push(Placed {
            node,
            world_from_node,
        });
    }
    Ok(placed)
}

fn parent_from_node(transform: &gltf::scene::Transform) -> DMat4 {
    match transform {
        gltf::scene::Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
        }
        gltf::scene::Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => DMat4::from_scale_rotation_translation(
            DVec3::from_array(scale.map(f64::from)),
            DQuat::from_array(rotation.map(f64::from)).normalize(),
            DVec3::from_array(translation.map(f64::from)),
        ),
    }
}

/// Returns all triangle meshes, and for each glTF mesh the indices of its primitives among them.
fn load_meshes(
    document: &gltf::Document,
    buffers: &[gltf::buffer::Data],
    notes: &mut Vec<String>,
) -> (Vec<Mesh>, HashMap<usize, Vec<usize>>) {
    let bar = parallel::bar("meshes", document.meshes().len());
    let default_material = document.materials().len();
    let (mut meshes, mut ranges) = (Vec::new(), HashMap::new());
    for mesh in document.meshes() {
        let mut own = Vec::new();
        for primitive in mesh.primitives() {
            let material = primitive.material();
            let uv_set = material
                .pbr_metallic_roughness()
                .base_color_texture()
                .map_or(0, |texture| texture.tex_coord());
            let index = material.index().unwrap_or(default_material);
            match primitive::triangles(&primitive, buffers, index, uv_set) {
                Ok(triangles) if triangles.indices.is_empty() => {}
                Ok(triangles) => {
                    own.push(meshes.len());
                    meshes.push(triangles);
                }
                Err(reason) => notes.push(format!(
                    "mesh {} primitive {} is left out: {reason}",
                    mesh.index(),
                    primitive.index()
                )),
            }
        }
        ranges.insert(mesh.index(), own);
        bar.inc(1);
    }
    bar.finish_and_clear();
    (meshes, ranges)
}

fn load_materials(document: &gltf::Document) -> Vec<Material> {
    let mut materials: Vec<Material> = document
        .materials()
        .map(|material| {
            let pbr = material.pbr_metallic_roughness();
            Material {
                base_color: Vec4::from_array(pbr.base_color_factor()),
                image: pbr
                    .base_color_texture()
                    .map(|texture| texture.texture().source().index()),
                double_sided: material.double_sided(),
                alpha_cutoff: match material.alpha_mode() {
                    gltf::material::AlphaMode::Mask => material.alpha_cutoff().unwrap_or(0.5),
                    _ => 0.0,
                },
            }
        })
        .collect();
    // Primitives without a material refer to this one.
    materials.push(Material {
        base_color: Vec4::ONE,
        image: None,
        double_sided: false,
        alpha_cutoff: 0.0,
    });
    materials
}

/// Is a box in world space, in f64.
struct DBounds {
    min: DVec3,
    max: DVec3,
}

impl DBounds {
    const EMPTY: Self = Self {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };

    fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }
}

struct WorldInstance {
    mesh: usize,
    world_from_model: DMat4,
    bounds: DBounds,
}

impl WorldInstance {
    fn in_render_space(self, origin: DVec3) -> Instance {
        let render_from_model = DMat4::from_translation(-origin) * self.world_from_model;
        Instance {
            mesh: self.mesh,
            render_from_model: render_from_model.as_mat4(),
            bounds_render: Aabb::new(
                (self.bounds.min - origin).as_vec3(),
                (self.bounds.max - origin).as_vec3(),
            ),
        }
    }
}

fn world_instances(
    placed: &[Placed<'_>],
    meshes: &[Mesh],
    ranges: &HashMap<usize, Vec<usize>>,
) -> Result<Vec<WorldInstance>, String> {
    let bar = parallel::bar("instances", placed.len());
    let mut instances = Vec::new();
    for Placed {
        node,
        world_from_node,
    } in placed
    {
        bar.inc(1);
        let Some(mesh) = node.mesh() else { continue };
        if !world_from_node.is_finite() {
            return Err(format!(
                "node {} has a transform that is not finite",
                node.index()
            ));
        }
        for &index in ranges.get(&mesh.index()).into_iter().flatten() {
            let mut bounds = DBounds::EMPTY;
            for vertex in &meshes[index].vertices {
                let position = DVec3::from_array(vertex.position.map(f64::from));
                let world = world_from_node.transform_point3(position);
                bounds = bounds.union(&DBounds {
                    min: world,
                    max: world,
                });
            }
            instances.push(WorldInstance {
                mesh: index,
                world_from_model: *world_from_node,
                bounds,
            });
        }
    }
    bar.finish_and_clear();
    Ok(instances)
}

/// Returns the camera of that number, or in a file without cameras one that sees everything from
/// above its corner.
fn find_camera(
    placed: &[Placed<'_>],
    number: usize,
    bounds: &DBounds,
    notes: &mut Vec<String>,
) -> Result<(DMat4, Lens), String> {
    let cameras: Vec<_> = placed
        .iter()
        .filter_map(|placed| Some((placed.world_from_node, placed.node.camera()?)))
        .collect();
    if number > 0 && number >= cameras.len() {
        return Err(format!(
            "there is no camera {number}: the file has {}",
            cameras.len()
        ));
    }
    if let Some((world_from_view, camera)) = cameras.get(number) {
        let lens = match camera.projection() {
            Projection::Perspective(lens) => Lens::Perspective {
                fov_y_radians: lens.yfov(),
                near: lens.znear(),
                far: lens.zfar(),
            },
            Projection::Orthographic(lens) => Lens::Orthographic {
                half_height: lens.ymag(),
                near: lens.znear(),
                far: lens.zfar(),
            },
        };
        return Ok((*world_from_view, lens));
    }
    notes.push("the file has no camera: it is seen from above its corner".to_owned());
    let center = (bounds.min + bounds.max) * 0.5;
    let radius = ((bounds.max - bounds.min).length() * 0.5).max(1e-6);
    let fov_y_radians = 0.8_f32;
    // The bounding sphere touches the upper and lower edge of the image.
    let distance = radius / f64::from(fov_y_radians * 0.5).sin();
    let eye = center + DVec3::new(0.55, 0.5, 0.8).normalize() * distance;
    let lens = Lens::Perspective {
        fov_y_radians,
        near: ((distance - radius) * 0.5).max(distance * 1e-3) as f32,
        far: None,
    };
    Ok((
        glam::dcamera::rh::view::look_at_mat4(eye, center, DVec3::Y).inverse(),
        lens,
    ))
}

/// Returns the lights of the file, or one sun.
fn find_lights(placed: &[Placed<'_>], origin: DVec3, notes: &mut Vec<String>) -> Vec<Light> {
    let mut lights: Vec<Light> = placed
        .iter()
        .filter_map(|placed| Some((placed.world_from_node, placed.node.light()?)))
        .map(|(world_from_light, light)| Light {
            kind: match light.kind() {
                Kind::Directional => LightKind::Directional,
                Kind::Point => LightKind::Point,
                Kind::Spot {
                    inner_cone_angle,
                    outer_cone_angle,
                } => LightKind::Spot {
                    inner_cone_radians: inner_cone_angle,
                    outer_cone_radians: outer_cone_angle,
                },
            },
            intensity: Vec3::from_array(light.color()) * light.intensity(),
            direction: world_from_light
                .transform_vector3(DVec3::NEG_Z)
                .normalize_or(DVec3::NEG_Y)
                .as_vec3(),
            position_render: (world_from_light.w_axis.truncate() - origin).as_vec3(),
            range: light.range().unwrap_or(f32::INFINITY),
        })
        .collect();
    if lights.is_empty() {
        notes.push("the file has no light: a sun is put 50 degrees high".to_owned());
        lights.push(Light {
            kind: LightKind::Directional,
            intensity: Vec3::ONE,
            direction: Vec3::new(-0.5, -0.766, -0.405).normalize(),
            position_render: Vec3::ZERO,
            range: f32::INFINITY,
        });
    }
    lights
}
