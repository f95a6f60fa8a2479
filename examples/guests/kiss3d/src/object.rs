//! Knows where kiss3d draws an object, and draws it: for the image and for depth maps alike.

use std::cell::RefCell;
use std::rc::Rc;

use glam::{Mat3, Mat4, Vec3};
use kiss3d::prelude::{Context, GpuMesh3d, InstancesBuffer3d, Object3d, ObjectData3d, Pose3};
use kiss3d::resource::vertex_index::VERTEX_INDEX_FORMAT;

/// Declares the uniforms of an object, and where its vertices are in the world.
pub const WGSL: &str = "
struct Object { pose: mat4x4<f32>, scale: vec4<f32>, color: vec4<f32> }
@group(1) @binding(0) var<uniform> object: Object;

fn object_turned(vector: vec3<f32>, x: vec3<f32>, y: vec3<f32>, z: vec3<f32>) -> vec3<f32> {
    return (object.pose * vec4(mat3x3(x, y, z) * vector, 0.0)).xyz;
}
fn object_position(
    vertex: vec3<f32>, offset: vec3<f32>, x: vec3<f32>, y: vec3<f32>, z: vec3<f32>,
) -> vec3<f32> {
    return object_turned(object.scale.xyz * vertex, x, y, z) + object.pose[3].xyz + offset;
}
";

/// Draws an object into a depth map.
pub const CASTER_WGSL: &str = "
@vertex fn object_caster(
    @location(0) vertex: vec3<f32>, @location(1) offset: vec3<f32>,
    @location(2) x: vec3<f32>, @location(3) y: vec3<f32>, @location(4) z: vec3<f32>,
) -> @builtin(position) vec4<f32> {
    return shadow_caster_clip(object_position(vertex, offset, x, y, z));
}
";

/// Lists the buffers: positions of vertices, positions of instances, the columns of the instances'
/// deformations, and then normals and the instances' colours, which depth maps do not need.
pub static BUFFERS: [Option<wgpu::VertexBufferLayout<'static>>; 5] = [
    buffer(
        &wgpu::vertex_attr_array![0 => Float32x3],
        wgpu::VertexStepMode::Vertex,
        12,
    ),
    buffer(
        &wgpu::vertex_attr_array![1 => Float32x3],
        wgpu::VertexStepMode::Instance,
        12,
    ),
    buffer(
        &wgpu::vertex_attr_array![2 => Float32x3, 3 => Float32x3, 4 => Float32x3],
        wgpu::VertexStepMode::Instance,
        36,
    ),
    buffer(
        &wgpu::vertex_attr_array![5 => Float32x3],
        wgpu::VertexStepMode::Vertex,
        12,
    ),
    buffer(
        &wgpu::vertex_attr_array![6 => Float32x4],
        wgpu::VertexStepMode::Instance,
        16,
    ),
];

const fn buffer(
    attributes: &'static [wgpu::VertexAttribute],
    step_mode: wgpu::VertexStepMode,
    array_stride: u64,
) -> Option<wgpu::VertexBufferLayout<'static>> {
    Some(wgpu::VertexBufferLayout {
        array_stride,
        step_mode,
        attributes,
    })
}

/// Holds what one of kiss3d's objects is drawn from.
pub struct SceneObject {
    /// Is the number that kiss3d gives the object.
    pub number: u32,
    /// Counts the changes of what is drawn, colours apart.
    pub version: u64,
    mesh: Rc<RefCell<GpuMesh3d>>,
    instances: Rc<RefCell<InstancesBuffer3d>>,
    uniforms: wgpu::Buffer,
    group: wgpu::BindGroup,
    placement: Placement,
}

/// Is where and how an object is drawn.
#[derive(Clone, Copy, Default, PartialEq)]
pub struct Placement {
    pose: Mat4,
    scale: Vec3,
    casts: bool,
}

impl Placement {
    pub fn new(pose: Pose3, scale: kiss3d::prelude::Vec3, data: &ObjectData3d) -> Self {
        Self {
            pose: Mat4::from_cols_array(&pose.to_mat4().to_cols_array()),
            scale: vec3(scale),
            casts: data.casts_shadows() && data.surface_rendering_active(),
        }
    }
}

impl SceneObject {
    pub fn new(object: &Object3d, layout: &wgpu::BindGroupLayout) -> Self {
        let context = Context::get();
        let uniforms = context.create_buffer(&wgpu::BufferDescriptor {
            label: Some("object"),
            size: 96,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = context.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("object"),
            layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: uniforms.as_entire_binding(),
            }],
        });
        Self {
            number: object.segmentation_id(),
            version: 0,
            mesh: object.mesh().clone(),
            instances: object.instances().clone(),
            uniforms,
            group,
            placement: Placement::default(),
        }
    }

    /// Returns whether the object is drawn otherwise than when it was last placed.
    pub fn changed(&self, placement: &Placement) -> bool {
        let (mesh, copies) = (self.mesh.borrow(), self.instances.borrow());
        self.placement != *placement
            || mesh.coords().read().unwrap().dirty()
            || mesh.faces().read().unwrap().dirty()
            || copies.positions.dirty()
            || copies.deformations.dirty()
    }

    /// Uploads the object as it is now.
    pub fn place(&mut self, placement: Placement) {
        self.placement = placement;
        self.version += 1;
        let (mesh, mut copies) = (self.mesh.borrow(), self.instances.borrow_mut());
        mesh.coords().write().unwrap().load_to_gpu();
        mesh.faces().write().unwrap().load_to_gpu();
        copies.positions.load_to_gpu();
        copies.deformations.load_to_gpu();
        let pose = placement.pose.to_cols_array();
        let floats = [&pose[..], &placement.scale.to_array()].concat();
        Context::get().write_buffer(&self.uniforms, 0, bytemuck::cast_slice(&floats));
    }

    /// Uploads what only the image needs.
    pub fn paint(&self, data: &ObjectData3d) {
        self.mesh.borrow().normals().write().unwrap().load_to_gpu();
        self.instances.borrow_mut().colors.load_to_gpu();
        let color = data.color();
        let floats = [color.r, color.g, color.b, color.a];
        Context::get().write_buffer(&self.uniforms, 80, bytemuck::cast_slice(&floats));
    }

    pub fn casts(&self) -> bool {
        self.placement.casts
    }

    /// Returns the vertices of the mesh.
    pub fn vertices(&self) -> Vec<Vec3> {
        let mesh = self.mesh.borrow();
        let coords = mesh.coords().read().unwrap();
        coords.data().iter().flatten().map(|&v| vec3(v)).collect()
    }

    /// Returns the indices of the triangles.
    pub fn faces(&self) -> Vec<[u32; 3]> {
        let mesh = self.mesh.borrow();
        let faces = mesh.faces().read().unwrap();
        faces.data().clone().unwrap_or_default()
    }

    /// Returns the matrix of each instance.
    pub fn copies(&self) -> Vec<Mat4> {
        let copies = self.instances.borrow();
        let vectors = |data: &Option<Vec<kiss3d::prelude::Vec3>>| -> Vec<Vec3> {
            data.iter().flatten().map(|&v| vec3(v)).collect()
        };
        let columns = vectors(copies.deformations.data());
        let model = |(offset, c): (&Vec3, &[Vec3])| {
            Mat4::from_translation(*offset)
                * self.placement.pose
                * Mat4::from_mat3(Mat3::from_cols(c[0], c[1], c[2]))
                * Mat4::from_scale(self.placement.scale)
        };
        let offsets = vectors(copies.positions.data());
        offsets.iter().zip(columns.chunks(3)).map(model).collect()
    }

    /// Draws the object with positions alone, as depth maps need it.
    pub fn draw_positions(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.draw_buffers(pass, &self.mesh.borrow(), &self.instances.borrow());
    }

    /// Draws the object with normals and colours. kiss3d has borrowed the mesh and the instances
    /// while it draws, and passes them on.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        mesh: &GpuMesh3d,
        copies: &InstancesBuffer3d,
    ) {
        let normals = mesh.normals().read().unwrap();
        if let (Some(normals), Some(colors)) = (normals.buffer(), copies.colors.buffer()) {
            pass.set_vertex_buffer(3, normals.slice(..));
            pass.set_vertex_buffer(4, colors.slice(..));
            self.draw_buffers(pass, mesh, copies);
        }
    }

    /// Sets bind group 1 and the buffers of positions, and draws. Buffers are replaced when they
    /// grow, so they are looked up in every draw.
    fn draw_buffers(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        mesh: &GpuMesh3d,
        copies: &InstancesBuffer3d,
    ) {
        let (coords, faces) = (mesh.coords().read().unwrap(), mesh.faces().read().unwrap());
        let vectors = [&*coords, &copies.positions, &copies.deformations];
        for (slot, vector) in (0..).zip(vectors) {
            let Some(buffer) = vector.buffer() else {
                return;
            };
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        let Some(indices) = faces.buffer() else {
            return;
        };
        pass.set_index_buffer(indices.slice(..), VERTEX_INDEX_FORMAT);
        pass.set_bind_group(1, &self.group, &[]);
        let (indices, copies) = (3 * faces.len() as u32, copies.len() as u32);
        pass.draw_indexed(0..indices, 0, 0..copies);
    }
}

/// Converts from kiss3d's version of the vector library.
pub fn vec3(vector: kiss3d::prelude::Vec3) -> Vec3 {
    Vec3::from_array(vector.to_array())
}
