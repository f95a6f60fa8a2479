//! Loads a glTF character and poses it: its skin, its morph target and its animation.

use std::error::Error;

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Quat, Vec3};
use gltf::animation::util::ReadOutputs;
use gltf::buffer::Data;
use wgpu_shadows::Aabb;

/// Is the number of joints for which the shaders have room.
pub const MAX_JOINTS: usize = 16;

/// Mirrors `SkinVertex` in `skin.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct SkinVertex {
    pub position: Vec3,
    pub normal: Vec3,
    pub morph_offset: Vec3,
    pub joints: [u8; 4],
    pub weights: [f32; 4],
}

/// Is a character as the file has it.
pub struct Character {
    pub vertices: Vec<SkinVertex>,
    pub indices: Vec<u32>,
    nodes: Vec<Node>,
    joints: Vec<Joint>,
    channels: Vec<Channel>,
    /// Is the length of the animation, in seconds.
    duration: f32,
}

/// Is a node of the skeleton; parents precede their children.
struct Node {
    index: usize,
    parent: Option<usize>,
    translation: Vec3,
    rotation: Quat,
    scale: Vec3,
}

struct Joint {
    /// Is its place in the list of nodes.
    node: usize,
    joint_from_bind: Mat4,
    /// Bounds the vertices that the joint moves, in the space of the bind pose, for weights of the
    /// morph target from 0 to 1.
    bounds_bind: Aabb,
}

/// Is what an animation changes of one node.
struct Channel {
    node: usize,
    times: Vec<f32>,
    values: Values,
}

enum Values {
    Translations(Vec<Vec3>),
    Rotations(Vec<Quat>),
    MorphWeights(Vec<f32>),
}

/// Is a character at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    pub render_from_bind: [Mat4; MAX_JOINTS],
    pub morph_weight: f32,
    pub bounds_render: Aabb,
}

impl Character {
    /// Reads the first skinned mesh of a file, with the first animation.
    pub fn load(file: &[u8]) -> Result<Self, Box<dyn Error>> {
        let (document, buffers, _) = gltf::import_slice(file)?;
        let figure = document
            .nodes()
            .find(|node| node.skin().is_some() && node.mesh().is_some());
        let figure = figure.ok_or("the file has no skinned mesh")?;
        let (mesh, skin) = (figure.mesh(), figure.skin());
        let (mesh, skin) = mesh.zip(skin).ok_or("the file has no skinned mesh")?;
        let primitive = mesh.primitives().next().ok_or("the mesh is empty")?;
        let (vertices, indices) = read_vertices(&primitive, &buffers)?;
        let mut nodes = Vec::new();
        let scene = document.scenes().next().ok_or("the file has no scene")?;
        for root in scene.nodes() {
            add_node(&mut nodes, &root, None);
        }
        let place = |index: usize| nodes.iter().position(|node| node.index == index);
        let inverses: Vec<Mat4> = skin
            .reader(|buffer| Some(&buffers[buffer.index()]))
            .read_inverse_bind_matrices()
            .ok_or("the skin has no inverse bind matrices")?
            .map(|matrix| Mat4::from_cols_array_2d(&matrix))
            .collect();
        if inverses.len() > MAX_JOINTS {
            return Err(format!("{} joints, of at most {MAX_JOINTS}", inverses.len()).into());
        }
        let mut joints = Vec::new();
        for ((index, joint), joint_from_bind) in skin.joints().enumerate().zip(inverses) {
            joints.push(Joint {
                node: place(joint.index()).ok_or("a joint is not in the scene")?,
                joint_from_bind,
                bounds_bind: moved_by(&vertices, index),
            });
        }
        let mut channels = Vec::new();
        if let Some(animation) = document.animations().next() {
            for channel in animation.channels() {
                let node = place(channel.target().node().index());
                let node = node.ok_or("an animated node is not in the scene")?;
                channels.extend(read_channel(&channel, node, &buffers));
            }
        }
        let ends = channels.iter().filter_map(|channel| channel.times.last());
        Ok(Self {
            duration: ends.copied().fold(0.0, f32::max),
            vertices,
            indices,
            nodes,
            joints,
            channels,
        })
    }

    /// Returns the pose at a time of the animation, which repeats.
    pub fn pose(&self, seconds: f32, render_from_model: Mat4) -> Pose {
        let time = seconds.rem_euclid(self.duration.max(f32::MIN_POSITIVE));
        let locals = self.nodes.iter();
        let mut locals: Vec<_> = locals
            .map(|node| (node.scale, node.rotation, node.translation))
            .collect();
        let mut morph_weight = 0.0;
        for channel in &self.channels {
            let (before, share) = channel.at(time);
            let local = &mut locals[channel.node];
            match &channel.values {
                Values::Translations(all) => local.2 = all[before].lerp(all[before + 1], share),
                Values::Rotations(all) => local.1 = all[before].slerp(all[before + 1], share),
                Values::MorphWeights(all) => {
                    morph_weight = all[before] + (all[before + 1] - all[before]) * share;
                }
            }
        }
        let mut render_from_node: Vec<Mat4> = Vec::with_capacity(self.nodes.len());
        for (node, (scale, rotation, translation)) in self.nodes.iter().zip(locals) {
            let parent = node
                .parent
                .map_or(render_from_model, |p| render_from_node[p]);
            let local = Mat4::from_scale_rotation_translation(scale, rotation, translation);
            render_from_node.push(parent * local);
        }
        let mut pose = Pose {
            render_from_bind: [Mat4::IDENTITY; MAX_JOINTS],
            morph_weight,
            bounds_render: Aabb::EMPTY,
        };
        for (joint, render_from_bind) in self.joints.iter().zip(&mut pose.render_from_bind) {
            *render_from_bind = render_from_node[joint.node] * joint.joint_from_bind;
            // A vertex is a mean of where its joints would put it, so that it is within the bounds
            // of all of them.
            if !joint.bounds_bind.is_empty() {
                let moved = joint.bounds_bind.transformed(render_from_bind);
                pose.bounds_render = pose.bounds_render.union(moved);
            }
        }
        // The weights of a vertex have the sum 1 within rounding.
        let bounds = &mut pose.bounds_render;
        let margin = 8.0 * f32::EPSILON * bounds.min.abs().max(bounds.max.abs());
        (bounds.min, bounds.max) = (bounds.min - margin, bounds.max + margin);
        pose
    }

    /// Returns the position of a vertex in a pose, as the shaders compute it.
    pub fn position(&self, vertex: &SkinVertex, pose: &Pose) -> Vec3 {
        let morphed = vertex.position + pose.morph_weight * vertex.morph_offset;
        let joints = vertex.joints.iter().zip(vertex.weights);
        joints
            .map(|(&joint, weight)| {
                weight * pose.render_from_bind[usize::from(joint)].transform_point3(morphed)
            })
            .sum()
    }
}

impl Channel {
    /// Returns the number of the key before a time, and the share of the way to the next.
    fn at(&self, time: f32) -> (usize, f32) {
        let after = self.times.partition_point(|key| *key <= time);
        let before = after.clamp(1, self.times.len() - 1) - 1;
        let (low, high) = (self.times[before], self.times[before + 1]);
        (before, ((time - low) / (high - low)).clamp(0.0, 1.0))
    }
}

/// Bounds the vertices of a joint, with the morph target and without.
fn moved_by(vertices: &[SkinVertex], joint: usize) -> Aabb {
    let is_moved = |vertex: &&SkinVertex| {
        let mut joints = vertex.joints.iter().zip(vertex.weights);
        joints.any(|(&index, weight)| usize::from(index) == joint && weight > 0.0)
    };
    let ends = vertices.iter().filter(is_moved);
    Aabb::from_points(ends.flat_map(|v| [v.position, v.position + v.morph_offset]))
}

fn add_node(nodes: &mut Vec<Node>, node: &gltf::Node<'_>, parent: Option<usize>) {
    let (translation, rotation, scale) = node.transform().decomposed();
    nodes.push(Node {
        index: node.index(),
        parent,
        translation: translation.into(),
        rotation: Quat::from_array(rotation),
        scale: scale.into(),
    });
    let place = Some(nodes.len() - 1);
    node.children()
        .for_each(|child| add_node(nodes, &child, place));
}

fn read_vertices(
    primitive: &gltf::Primitive<'_>,
    buffers: &[Data],
) -> Result<(Vec<SkinVertex>, Vec<u32>), Box<dyn Error>> {
    let reader = primitive.reader(|buffer| Some(&buffers[buffer.index()]));
    let positions = reader.read_positions().ok_or("there are no positions")?;
    let normals = reader.read_normals().ok_or("there are no normals")?;
    let joints = reader.read_joints(0).ok_or("there are no joints")?;
    let weights = reader.read_weights(0).ok_or("there are no weights")?;
    let mut vertices = Vec::new();
    for (((position, normal), joints), weights) in positions
        .zip(normals)
        .zip(joints.into_u16())
        .zip(weights.into_f32())
    {
        let joint = |index: u16| {
            u8::try_from(index)
                .ok()
                .filter(|i| usize::from(*i) < MAX_JOINTS)
        };
        let [a, b, c, d] = joints.map(joint);
        let joints = a.zip(b).zip(c.zip(d)).ok_or("a joint is out of range")?;
        vertices.push(SkinVertex {
            position: position.into(),
            normal: normal.into(),
            morph_offset: Vec3::ZERO,
            joints: [joints.0.0, joints.0.1, joints.1.0, joints.1.1],
            weights,
        });
    }
    if let Some((Some(offsets), ..)) = reader.read_morph_targets().next() {
        for (vertex, offset) in vertices.iter_mut().zip(offsets) {
            vertex.morph_offset = offset.into();
        }
    }
    let indices = reader.read_indices().ok_or("there are no indices")?;
    Ok((vertices, indices.into_u32().collect()))
}

/// Returns `None` for what the character does not animate.
fn read_channel(
    channel: &gltf::animation::Channel<'_>,
    node: usize,
    buffers: &[Data],
) -> Option<Channel> {
    let reader = channel.reader(|buffer| Some(&buffers[buffer.index()]));
    let times: Vec<f32> = reader.read_inputs()?.collect();
    let values = match reader.read_outputs()? {
        ReadOutputs::Translations(all) => Values::Translations(all.map(Vec3::from).collect()),
        ReadOutputs::Rotations(all) => {
            Values::Rotations(all.into_f32().map(Quat::from_array).collect())
        }
        ReadOutputs::MorphTargetWeights(all) => Values::MorphWeights(all.into_f32().collect()),
        ReadOutputs::Scales(_) => return None,
    };
    (times.len() >= 2).then_some(Channel {
        node,
        times,
        values,
    })
}
