//! Holds the scene on the device: one vertex, one index and one instance buffer, and a bind group
//! per material.

use std::ops::Range;

use example_support::gltf_file::scene::{Material, Picture, Scene, Vertex};
use shadow_support::gpu::Gpu;
use wgpu::util::DeviceExt;

/// Describes the vertices in slot 0.
pub const VERTEX_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<Vertex>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2],
};

/// Describes the matrices in slot 1.
pub const INSTANCE_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: 64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![
        3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x4
    ],
};

/// Is one draw call.
#[derive(Clone)]
pub struct Draw {
    pub indices: Range<u32>,
    pub base_vertex: i32,
    pub material: usize,
    /// Is the index of its matrix.
    pub instance: usize,
    /// States that the transform mirrors, so that front faces wind the other way.
    pub mirrored: bool,
}

pub struct Geometry {
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub matrices: wgpu::Buffer,
    pub draws: Vec<Draw>,
    pub materials: Vec<Material>,
    pub material_layout: wgpu::BindGroupLayout,
    pub material_groups: Vec<wgpu::BindGroup>,
}

/// Mirrors `Material` in `shade.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct MaterialUniform {
    base_color: [f32; 4],
    alpha_cutoff: f32,
    padding: [f32; 3],
}

impl Geometry {
    pub fn upload(gpu: &Gpu, scene: &Scene) -> Result<Self, String> {
        let (mut vertices, mut indices, mut ranges) = (Vec::new(), Vec::<u32>::new(), Vec::new());
        for mesh in &scene.meshes {
            let first = indices.len() as u32;
            indices.extend_from_slice(&mesh.indices);
            ranges.push((
                first..indices.len() as u32,
                vertices.len() as i32,
                mesh.material,
            ));
            vertices.extend_from_slice(&mesh.vertices);
        }
        let matrices: Vec<[f32; 16]> = scene
            .instances
            .iter()
            .map(|instance| instance.render_from_model.to_cols_array())
            .collect();
        let draws = scene
            .instances
            .iter()
            .enumerate()
            .map(|(index, instance)| {
                let (indices, base_vertex, material) = ranges[instance.mesh].clone();
                Draw {
                    indices,
                    base_vertex,
                    material,
                    instance: index,
                    mirrored: instance.render_from_model.determinant() < 0.0,
                }
            })
            .collect();
        let material_layout = material_layout(&gpu.device);
        Ok(Self {
            vertices: buffer(
                gpu,
                "vertices",
                bytemuck::cast_slice(&vertices),
                wgpu::BufferUsages::VERTEX,
            )?,
            indices: buffer(
                gpu,
                "indices",
                bytemuck::cast_slice(&indices),
                wgpu::BufferUsages::INDEX,
            )?,
            matrices: buffer(
                gpu,
                "matrices",
                bytemuck::cast_slice(&matrices),
                wgpu::BufferUsages::VERTEX,
            )?,
            draws,
            materials: scene.materials.clone(),
            material_groups: material_groups(gpu, scene, &material_layout)?,
            material_layout,
        })
    }

    /// Sets buffers and draws; pipeline and material are set already.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, draw: &Draw) {
        let matrix = 64 * draw.instance as u64;
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.matrices.slice(matrix..matrix + 64));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(draw.indices.clone(), draw.base_vertex, 0..1);
    }
}

fn buffer(
    gpu: &Gpu,
    label: &str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, String> {
    let most = gpu.device.limits().max_buffer_size;
    if contents.len() as u64 > most {
        return Err(format!(
            "{label} take {} bytes, and the device holds {most} in one buffer",
            contents.len()
        ));
    }
    Ok(gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents,
            usage,
        }))
}

fn material_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("material"),
        entries: &[
            entry(
                0,
                wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
            ),
            entry(
                1,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: true },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
            ),
            entry(
                2,
                wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            ),
        ],
    })
}

fn material_groups(
    gpu: &Gpu,
    scene: &Scene,
    layout: &wgpu::BindGroupLayout,
) -> Result<Vec<wgpu::BindGroup>, String> {
    let white = Picture {
        width: 1,
        height: 1,
        rgba: vec![255; 4],
    };
    let textures: Vec<wgpu::TextureView> = scene
        .images
        .iter()
        .chain([&white])
        .map(|picture| upload_texture(gpu, picture))
        .collect::<Result<_, _>>()?;
    let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let make = |material: &Material| {
        let uniform = MaterialUniform {
            base_color: material.base_color.to_array(),
            alpha_cutoff: material.alpha_cutoff,
            padding: [0.0; 3],
        };
        let uniform = gpu
            .device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("material"),
                contents: bytemuck::bytes_of(&uniform),
                usage: wgpu::BufferUsages::UNIFORM,
            });
        let texture = &textures[material.image.unwrap_or(textures.len() - 1)];
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("material"),
            layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: uniform.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::TextureView(texture),
                },
                wgpu::BindGroupEntry {
                    binding: 2,
                    resource: wgpu::BindingResource::Sampler(&sampler),
                },
            ],
        })
    };
    Ok(scene.materials.iter().map(make).collect())
}

fn upload_texture(gpu: &Gpu, picture: &Picture) -> Result<wgpu::TextureView, String> {
    let most = gpu.device.limits().max_texture_dimension_2d;
    let (width, height) = (picture.width, picture.height);
    if width == 0 || height == 0 || width.max(height) > most {
        return Err(format!(
            "a texture of {width}x{height} does not fit the device (at most {most})"
        ));
    }
    let texture = gpu.device.create_texture_with_data(
        &gpu.queue,
        &wgpu::TextureDescriptor {
            label: Some("base colour"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8UnormSrgb,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        &picture.rgba,
    );
    Ok(texture.create_view(&Default::default()))
}
