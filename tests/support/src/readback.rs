//! Copies textures and buffers back to the CPU.

use crate::gpu::Gpu;

/// Returns one layer of a depth texture, rows from the top.
///
/// A compute shader gathers the texels: the OpenGL backend neither copies nor loads from depth
/// textures.
pub fn depth_layer(gpu: &Gpu, texture: &wgpu::Texture, layer: u32) -> Vec<f32> {
    let size = texture.width();
    let texels = u64::from(size) * u64::from(size);
    let shader = gpu.shader(DEPTH_SHADER);
    let pipeline = gpu
        .device
        .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("depth readback"),
            layout: None,
            module: &shader,
            entry_point: Some("read"),
            compilation_options: Default::default(),
            cache: None,
        });
    let output = storage(gpu, texels * 4);
    let layer_buffer = gpu.buffer(&[layer, 0, 0, 0], wgpu::BufferUsages::UNIFORM);
    let sampler = gpu.device.create_sampler(&Default::default());
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("depth readback"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: output.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 2,
                resource: layer_buffer.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 3,
                resource: wgpu::BindingResource::Sampler(&sampler),
            },
        ],
    });
    let mut encoder = gpu.encoder();
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.dispatch_workgroups(size.div_ceil(8), size.div_ceil(8), 1);
    }
    gpu.submit(encoder);
    buffer(gpu, &output)
}

const DEPTH_SHADER: &str = "
@group(0) @binding(0) var map: texture_depth_2d_array;
@group(0) @binding(1) var<storage, read_write> depths: array<f32>;
@group(0) @binding(2) var<uniform> layer: vec4<u32>;
@group(0) @binding(3) var point_sampler: sampler;

@compute @workgroup_size(8, 8)
fn read(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(map);
    if all(id.xy < size) {
        // This is the corner where four texels meet; the last component of the gather is the upper
        // left one.
        let corner = vec2<f32>(id.xy + 1u) / vec2<f32>(size);
        depths[id.y * size.x + id.x] = textureGather(map, point_sampler, corner, layer.x).w;
    }
}
";

/// Creates a zeroed buffer that a shader may write and [`buffer`] may read.
pub fn storage(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.empty_buffer(
        size,
        wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
    )
}

/// Returns the contents of a buffer created with `COPY_SRC`.
pub fn buffer<T: bytemuck::Pod>(gpu: &Gpu, source: &wgpu::Buffer) -> Vec<T> {
    try_buffer(gpu, source).expect("the buffer is read back")
}

/// Does the same, and returns the error of a device that stopped.
pub fn try_buffer<T: bytemuck::Pod>(gpu: &Gpu, source: &wgpu::Buffer) -> Result<Vec<T>, String> {
    let staging = staging(gpu, source.size());
    let mut encoder = gpu.encoder();
    encoder.copy_buffer_to_buffer(source, 0, &staging, 0, source.size());
    gpu.try_submit(encoder)?;
    Ok(bytemuck::pod_collect_to_vec(&mapped(gpu, &staging)?))
}

/// Returns the pixels of a texture of four bytes per pixel, created with `COPY_SRC`.
pub fn rgba8(gpu: &Gpu, texture: &wgpu::Texture) -> image::RgbaImage {
    let pixels = texels(gpu, gpu.encoder(), texture).expect("the texture is read back");
    image::RgbaImage::from_raw(texture.width(), texture.height(), pixels)
        .expect("rows of four bytes a pixel")
}

/// Submits `encoder`, and returns the texels of a colour texture created with `COPY_SRC`, row by
/// row from the top.
pub fn texels(
    gpu: &Gpu,
    mut encoder: wgpu::CommandEncoder,
    texture: &wgpu::Texture,
) -> Result<Vec<u8>, String> {
    let texel_bytes = texture.format().block_copy_size(None);
    let row = texture.width() * texel_bytes.ok_or("a format that cannot be copied")?;
    let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let staging = staging(gpu, u64::from(padded_row) * u64::from(texture.height()));
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &staging,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded_row),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    gpu.try_submit(encoder)?;
    let rows = mapped(gpu, &staging)?;
    let rows = rows.chunks_exact(padded_row as usize);
    Ok(rows
        .flat_map(|padded| &padded[..row as usize])
        .copied()
        .collect())
}

fn staging(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.empty_buffer(
        size,
        wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
    )
}

fn mapped(gpu: &Gpu, staging: &wgpu::Buffer) -> Result<Vec<u8>, String> {
    let (sender, receiver) = std::sync::mpsc::channel();
    staging.map_async(wgpu::MapMode::Read, .., move |result| {
        let _ = sender.send(result);
    });
    let failed = |error: &dyn std::fmt::Display| format!("cannot read back: {error}");
    // The call-back may come from another thread's poll, so this waits for the channel.
    loop {
        gpu.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map_err(|error| failed(&error))?;
        if let Ok(result) = receiver.recv_timeout(std::time::Duration::from_millis(100)) {
            result.map_err(|error| failed(&error))?;
            break;
        }
    }
    let bytes = staging.get_mapped_range(..);
    Ok(bytes.map_err(|error| failed(&error))?.to_vec())
}
