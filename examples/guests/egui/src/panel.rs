//! Is a panel of egui that shows a scene: its callback records the shadows into egui's encoder
//! before egui's pass, and draws within the pass.

use std::error::Error;
use std::time::{Duration, Instant};

use egui_wgpu::{CallbackResources, CallbackTrait, ScreenDescriptor};
use example_support::camera::Camera;
use example_support::mesh::Object;
use example_support::phong::{Batch, Lighting, Phong, PhongDescriptor};
use example_support::textbook;
use glam::{Mat4, Quat, Vec3};
use shadow_support::gpu::Gpu;
use wgpu_shadows::DirectionalLight;

use crate::shadows::Shadows;

/// Is the shader's fragment stage; `phong.wgsl` and the library's functions precede it.
const FRAGMENT_WGSL: &str = "
@fragment fn fragment(surface: Surface) -> @location(0) vec4<f32> {
    let normal = shadow_geometric_normal(surface.position, frame.eye - surface.position);
    let color = shade(surface, shadow_sun(surface.position, normal));
    // egui's target takes sRGB codes.
    return vec4(pow(color, vec3(1.0 / 2.2)), 1.0);
}";

/// Is what egui's controls set.
#[derive(Clone, Copy)]
pub struct State {
    pub sun_angle: f32,
    pub cube_angle: f32,
    /// Is the width of the panel by its height.
    pub aspect: f32,
    pub keeps_nothing: bool,
}

/// Is kept among the renderer's resources.
pub struct Scene {
    gpu: Gpu,
    phong: Phong,
    objects: Vec<Object>,
    state: State,
    pub shadows: Shadows,
    pub record_time: Duration,
}

impl Scene {
    pub fn new(gpu: Gpu, format: wgpu::TextureFormat) -> Result<Self, Box<dyn Error>> {
        let parts = textbook::parts();
        let parts = parts
            .iter()
            .map(|(mesh, instance)| Object::new(&gpu.device, mesh, *instance));
        let objects: Vec<Object> = parts.collect();
        let shadows = Shadows::new(&gpu.device, &objects)?;
        let phong = Phong::new(
            &gpu,
            &PhongDescriptor {
                visibility_wgsl: shadows.bindings.wgsl(),
                fragment_wgsl: FRAGMENT_WGSL,
                fragment_entry: "fragment",
                shadow_group: shadows.bindings.group(),
                shadow_layout: shadows.bindings.layout(),
                format,
                sample_count: 1,
            },
        );
        Ok(Self {
            gpu,
            phong,
            objects,
            state: State {
                sun_angle: 0.0,
                cube_angle: 0.0,
                aspect: 1.0,
                keeps_nothing: false,
            },
            shadows,
            record_time: Duration::ZERO,
        })
    }

    fn toward_sun(&self) -> Vec3 {
        Quat::from_rotation_y(self.state.sun_angle) * textbook::TOWARD_SUN
    }

    fn camera(&self) -> Camera {
        let size = [(1000.0 * self.state.aspect) as u32, 1000];
        Camera::new(
            textbook::EYE,
            textbook::TARGET,
            textbook::FIELD_OF_VIEW_RADIANS,
            size,
        )
    }

    fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        state: State,
    ) -> Result<(), Box<dyn Error>> {
        if std::mem::replace(&mut self.state, state).cube_angle != state.cube_angle {
            let turn = Mat4::from_rotation_y(state.cube_angle);
            let (mesh, mut instance) = textbook::parts().into_iter().nth(1).expect("a cube");
            instance.render_from_model *= turn;
            self.objects[1] = Object::new(&self.gpu.device, &mesh, instance);
            self.shadows.place(1, &self.objects[1])?;
        }
        if state.keeps_nothing {
            self.shadows.sun.invalidate();
        }
        let light = DirectionalLight::new(-self.toward_sun());
        let camera = self.camera();
        let begin = Instant::now();
        self.shadows.record(encoder, camera.view, &light)?;
        self.record_time = begin.elapsed();
        Ok(())
    }
}

/// Is added to a `Ui` where the scene is to appear.
pub struct Panel(pub State);

impl CallbackTrait for Panel {
    fn prepare(
        &self,
        _device: &wgpu::Device,
        _queue: &wgpu::Queue,
        _screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(scene) = resources.get_mut::<Scene>()
            && let Err(error) = scene.record(encoder, self.0)
        {
            eprintln!("shadows: {error}");
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        let Some(scene) = resources.get::<Scene>() else {
            return;
        };
        let lighting = Lighting {
            light: scene.toward_sun().normalize().extend(0.0),
            light_color: Vec3::ONE,
            light_range: f32::INFINITY,
            ambient: Vec3::splat(0.2),
            sky: Vec3::ZERO,
        };
        let group = scene.shadows.bindings.bind_group();
        let batches = scene.objects.iter().map(Batch::from);
        scene
            .phong
            .draw_in_pass(&scene.gpu, pass, &scene.camera(), &lighting, group, batches);
    }
}
