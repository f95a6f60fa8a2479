//! Compares many copies of one mesh with one bare instanced draw of the same, and counts the draw
//! calls of a yard.

use glam::{Mat4, Quat, Vec3, Vec4};
use shadow_support::gpu::Gpu;
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use wgpu_shadows::{
    CasterPipeline, Coverage, DepthFormat, Filter, InstancedMeshCaster, MeshCaster, ShadowCaster,
    ShadowView, caster::CasterPipelineDescriptor, caster::InstancedMeshCasterDescriptor,
    caster::MeshCasterDescriptor, caster::MeshIndices,
};

use super::crowd;
use super::processor;
use super::stage::{self, Stage};

const MAP_SIZE: u32 = 2048;

/// Holds copies of one mesh: as one caster, as a caster each, and as one instanced draw without the
/// library.
struct Copies {
    instanced: InstancedMeshCaster,
    each: Vec<MeshCaster>,
    pipeline: CasterPipeline,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
    matrices: wgpu::Buffer,
    count: u32,
}

impl Copies {
    fn new(gpu: &Gpu, mesh: &Mesh, transforms: &[Mat4]) -> Self {
        let pipeline = CasterPipeline::new(&gpu.device, &CasterPipelineDescriptor::new())
            .expect("a valid pipeline");
        let vertices = gpu.buffer(&mesh.positions, wgpu::BufferUsages::VERTEX);
        let buffer = gpu.buffer(&mesh.indices, wgpu::BufferUsages::INDEX);
        let index_count = mesh.indices.len() as u32;
        let indices = MeshIndices::Buffer {
            buffer: buffer.clone(),
            format: wgpu::IndexFormat::Uint32,
            indices: 0..index_count,
            base_vertex: 0,
        };
        let descriptor = InstancedMeshCasterDescriptor {
            label: None,
            pipeline: &pipeline,
            vertices: &vertices,
            indices: indices.clone(),
            bounds_model: mesh.bounds(),
            render_from_model: transforms,
        };
        let instanced = InstancedMeshCaster::new(&gpu.device, &descriptor).expect("valid copies");
        let each = transforms.iter().map(|transform| {
            let descriptor = MeshCasterDescriptor {
                label: None,
                pipeline: &pipeline,
                vertices: &vertices,
                indices: indices.clone(),
                bounds_model: mesh.bounds(),
                render_from_model: *transform,
            };
            MeshCaster::new(&gpu.device, &descriptor).expect("a valid mesh")
        });
        Self {
            each: each.collect(),
            instanced,
            matrices: gpu.buffer(transforms, wgpu::BufferUsages::VERTEX),
            count: transforms.len() as u32,
            pipeline,
            vertices,
            indices: buffer,
            index_count,
        }
    }

    fn each(&self) -> Vec<&dyn ShadowCaster> {
        self.each.iter().map(|copy| copy as _).collect()
    }
}

/// Draws all copies in one call into a map of its own, with the vertex stage of the library.
struct BarePass {
    map: wgpu::TextureView,
    view: wgpu::BindGroup,
}

impl BarePass {
    fn new(gpu: &Gpu, view: &ShadowView) -> Self {
        let device = &gpu.device;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: MAP_SIZE,
                height: MAP_SIZE,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Depth32Float,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: true,
                    min_binding_size: wgpu::BufferSize::new(80),
                },
                count: None,
            }],
        });
        let columns = view.clip_from_anchor().to_cols_array_2d();
        let anchor = view.anchor_render().extend(MAP_SIZE as f32);
        let uniform = columns.map(Vec4::from_array).into_iter().chain([anchor]);
        let uniform: Vec<Vec4> = uniform.collect();
        let buffer = gpu.buffer(&uniform, wgpu::BufferUsages::UNIFORM);
        Self {
            map: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            view: device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &layout,
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: &buffer,
                        offset: 0,
                        size: wgpu::BufferSize::new(80),
                    }),
                }],
            }),
        }
    }

    fn draw(&self, encoder: &mut wgpu::CommandEncoder, copies: &Copies) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.map,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let pipeline = copies.pipeline.wgpu_pipeline(DepthFormat::Float32);
        pass.set_pipeline(pipeline.expect("a pipeline for 32 bits"));
        pass.set_bind_group(0, &self.view, &[0]);
        pass.set_vertex_buffer(0, copies.vertices.slice(..));
        pass.set_vertex_buffer(1, copies.matrices.slice(..));
        pass.set_index_buffer(copies.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..copies.index_count, 0, 0..copies.count);
    }
}

/// Compares boxes of one mesh, all of them in the map and all of it drawn, with one instanced draw.
pub fn beside_one_draw(stage: &Stage<'_>) {
    println!(
        "\nsun, {MAP_SIZE} texels a side: copies of one box beside one bare instanced draw of the \
         same (device time), and `frame` and `record` on the CPU"
    );
    for count in [100, 1_000, 10_000] {
        let half = crowd::half_side(count);
        let mut random = Random::new(31);
        let transforms: Vec<Mat4> = (0..count)
            .map(|_| {
                let size = Vec3::new(
                    random.between(0.3, 1.0),
                    random.between(0.3, 3.0),
                    random.between(0.3, 1.0),
                );
                let place = Vec3::new(
                    random.between(-half, half),
                    size.y * 0.5,
                    random.between(-half, half),
                );
                let turn = Quat::from_rotation_y(random.between(0.0, 3.0));
                Mat4::from_scale_rotation_translation(size, turn, place)
            })
            .collect();
        let mesh = Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5));
        let copies = Copies::new(stage.gpu, &mesh, &transforms);
        let each = copies.each();
        let coverage = Coverage::Bounds(copies.instanced.bounds());
        for (name, casters) in [
            ("one caster", &[&copies.instanced as &dyn ShadowCaster][..]),
            ("a caster each", &each),
        ] {
            let frame = stage::frame(casters, coverage);
            let mut sun = stage.sun(MAP_SIZE, 1, Filter::default());
            let drawn = stage.record_effort(&mut sun, &frame, true);
            let kept = stage.record_effort(&mut sun, &frame, false);
            let maps = sun.shadow.maps();
            let view = maps.views().next().expect("boxes cast");
            let bare = BarePass::new(stage.gpu, view);
            let seen = maps.report().views[0].casters;
            let mut encoder = stage.gpu.encoder();
            sun.record_anew(&mut encoder, &frame);
            stage.gpu.submit(encoder);
            let draws = sun.shadow.maps().report().draws();
            let ratio = stage.ratio(
                |encoder| sun.record_anew(encoder, &frame),
                |encoder| bare.draw(encoder, &copies),
            );
            println!(
                "{count:>8} copies as {name}: {seen} in the map, {draws} draw calls, {:.3} times \
                 the bare draw (middle half {:.3} to {:.3}); drawn {:.0} µs and {} allocations, \
                 kept {:.0} µs and {}",
                ratio.median,
                ratio.lower_quartile,
                ratio.upper_quartile,
                drawn.microseconds,
                drawn.allocations,
                kept.microseconds,
                kept.allocations
            );
        }
    }
}

/// Counts what the sun of a yard takes: 200 spheres on a ground, before a camera that sees to its
/// end, in four cascades.
pub fn yard(stage: &Stage<'_>) {
    let half = crowd::half_side(200);
    let mut random = Random::new(8);
    let transforms: Vec<Mat4> = (0..200)
        .map(|_| {
            let radius = random.between(0.2, 0.8);
            let (x, z) = (random.between(-half, half), random.between(-half, half));
            Mat4::from_translation(Vec3::new(x, radius, z)) * Mat4::from_scale(Vec3::splat(radius))
        })
        .collect();
    let copies = Copies::new(stage.gpu, &Mesh::sphere(Vec3::ZERO, 1.0, 16), &transforms);
    let ground = Mesh::floor(0.0, half);
    let ground = ground.caster(stage.gpu, &copies.pipeline, Mat4::IDENTITY);
    let cameras = [stage::to_the_horizon(half)];
    println!("\nyard of 200 spheres and a ground, four cascades of {MAP_SIZE} texels a side");
    let mut each = copies.each();
    each.push(&ground);
    let one: [&dyn ShadowCaster; 2] = [&copies.instanced, &ground];
    for (name, casters) in [("one caster", &one[..]), ("a caster each", &each)] {
        let frame = stage::frame(casters, Coverage::Cameras(&cameras));
        let mut sun = stage.sun(MAP_SIZE, 4, Filter::default());
        let effort = processor::measure(
            stage.repeats,
            || stage.gpu.encoder(),
            |encoder| sun.record_anew(encoder, &frame),
        );
        let report = sun.shadow.maps().report();
        let seen: u32 = report.views.iter().map(|view| view.casters).sum();
        println!(
            "spheres as {name}: {} draw calls for {seen} casters in the cascades, {:.0} µs and {} allocations to draw all",
            report.draws(),
            effort.microseconds,
            effort.allocations
        );
    }
}
