//! Draws the images of the hall.

use std::error::Error;

use example_support::camera::Camera;
use example_support::hall::lights::{LAMPS, LightUniform, Lights, SPOTS, TOWARD_SUN};
use example_support::mesh::{Instance, Mesh, sphere, vertex_buffer};
use example_support::phong::{Batch, Lighting, Phong, PhongDescriptor, Picture};
use example_support::picture::halved;
use glam::{Mat4, Vec3};
use shadow_support::gpu::Gpu;
use shadow_support::readback;
use wgpu_shadows::ShadowBindings;

use crate::SIZE;
use crate::hall::Hall;
use crate::shadows::Shadows;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Is the size at which images are drawn: twice their own, and then averaged. Multisampling would
/// shade at the centre of a pixel what only a corner of it shows: at the foot of a wall that is
/// ground outside, in the sun.
const DRAWN_SIZE: [u32; 2] = [2 * SIZE[0], 2 * SIZE[1]];

/// Holds the pass that draws the hall, and the lights that its fragment stage loops over.
pub struct Painter {
    phong: Phong,
    lights: wgpu::Buffer,
    bulb: Mesh,
}

impl Painter {
    pub fn new(gpu: &Gpu, shadows: &ShadowBindings) -> Self {
        let lights = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("lights"),
            size: ((SPOTS + LAMPS) * size_of::<LightUniform>()) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("lights"),
                entries: &[wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: false,
                        min_binding_size: None,
                    },
                    count: None,
                }],
            });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("lights"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: lights.as_entire_binding(),
            }],
        });
        let descriptor = PhongDescriptor {
            visibility_wgsl: shadows.wgsl(),
            fragment_wgsl: example_support::hall::FRAGMENT_WGSL,
            fragment_entry: "fragment",
            shadow_group: shadows.group(),
            shadow_layout: shadows.layout(),
            format: FORMAT,
            sample_count: 1,
        };
        Self {
            phong: Phong::with_lights(gpu, &descriptor, Some((&layout, group))),
            lights,
            bulb: Mesh::new(&gpu.device, &sphere(10)),
        }
    }

    /// Draws the hall after the commands of `encoder`, and reads the image back.
    pub fn draw(
        &self,
        gpu: &Gpu,
        mut encoder: wgpu::CommandEncoder,
        hall: &Hall,
        lights: &Lights,
        shadows: &Shadows,
        camera: &Camera,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let uniforms = lights.uniforms();
        gpu.queue
            .write_buffer(&self.lights, 0, bytemuck::cast_slice(&uniforms));
        let lighting = Lighting {
            light: TOWARD_SUN.normalize().extend(0.0),
            light_color: Vec3::new(1.05, 0.98, 0.86),
            light_range: f32::INFINITY,
            ambient: Vec3::splat(0.035),
            sky: Vec3::new(0.45, 0.60, 0.80),
        };
        let target = gpu.target(FORMAT, DRAWN_SIZE, 1);
        let picture = Picture {
            camera,
            lighting: &lighting,
            shadows: shadows.bindings().bind_group(),
            target: &target,
        };
        // These are glowing balls at the point lights. They cast nothing, since all of their light
        // comes from inside.
        let bulbs: Vec<_> = lights
            .lamps
            .iter()
            .map(|lamp| Instance {
                render_from_model: Mat4::from_translation(lamp.place)
                    * Mat4::from_scale(Vec3::splat(0.06)),
                // No light reaches their outside; this makes the ambient light on them bright.
                albedo: lamp.color * 30.0,
                checker: 0.0,
            })
            .collect();
        let bulbs = vertex_buffer(&gpu.device, &bulbs);
        let bulbs = Batch {
            mesh: &self.bulb,
            instances: &bulbs,
            range: 0..LAMPS as u32,
        };
        let batches = hall.objects().iter().map(Batch::from).chain([bulbs]);
        self.phong.draw(gpu, &mut encoder, &picture, batches);
        Ok(halved(
            &readback::texels(gpu, encoder, &target)?,
            DRAWN_SIZE,
        ))
    }
}
