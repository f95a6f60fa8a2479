//! Is a material of kiss3d: it shades with the library's shadows, and from its hooks the shadows
//! of a frame are recorded.

use std::cell::RefCell;
use std::collections::HashSet;
use std::error::Error;
use std::rc::Rc;
use std::time::{Duration, Instant};

use kiss3d::prelude::*;
use kiss3d::resource::{RenderContext, RenderPhase};
use wgpu_shadows::CameraView;

use crate::light::Light;
use crate::object::{self, Placement, SceneObject};
use crate::shadows::Shadows;

/// Is as many lights as kiss3d's own shader has in its uniforms.
const MAX_LIGHTS: usize = 8;

/// Gives the objects of scenes the library's shadows.
pub struct ShadowedScene {
    state: Rc<RefCell<State>>,
    material: Rc<RefCell<Box<dyn Material3d>>>,
}

impl ShadowedScene {
    /// Makes the shadows and registers their material, in place of an earlier one. A window must
    /// exist.
    pub fn new() -> Result<Self, Box<dyn Error>> {
        let state = Rc::new(RefCell::new(State::new()?));
        let material: Box<dyn Material3d> = Box::new(ShadowedMaterial(state.clone()));
        let material = Rc::new(RefCell::new(material));
        // Materials that the manager knows get the hooks of a frame.
        MaterialManager3d::get_global_manager(|manager| manager.add(material.clone(), "shadowed"));
        Ok(Self { state, material })
    }

    /// Gives all objects of a scene the shadows, mirrors excepted. It is called again after objects
    /// were added.
    pub fn attach(&self, scene: &mut SceneNode3d) {
        scene.apply_to_objects_mut_recursive(&mut |object| {
            let mut state = self.state.borrow_mut();
            let is_new = state.shadows.get(object.segmentation_id()).is_none();
            if is_new && object.reflector().is_none() {
                let object = SceneObject::new(object, &state.object_layout);
                state.shadows.insert(object);
            }
            drop(state);
            if is_new && object.reflector().is_none() {
                object.set_material(self.material.clone());
            }
        });
    }

    pub fn state(&self) -> std::cell::RefMut<'_, State> {
        self.state.borrow_mut()
    }
}

/// Is what the material keeps from hook to hook.
pub struct State {
    pub shadows: Shadows,
    /// Is how long the library took to record the last frame, without submissions, and the number
    /// of passes that it recorded.
    pub record_time: Duration,
    pub passes: u32,
    begins_frame: bool,
    /// States that every map is drawn anew in every frame.
    pub keeps_nothing: bool,
    object_layout: wgpu::BindGroupLayout,
    pipeline: PipelineCache,
    frame: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    main_camera: CameraView,
    mirror_cameras: Vec<CameraView>,
    /// Is the number of mirrors that were drawn in this frame so far.
    mirrors: usize,
    in_mirror: bool,
    clip_plane: [f32; 4],
    visited: HashSet<u32>,
    /// Is what the hooks were told since the last one that begins a frame.
    view: Option<View>,
}

struct View {
    camera: CameraView,
    eye: Vec3,
    ambient: f32,
    lights: Vec<Light>,
}

struct ShadowedMaterial(Rc<RefCell<State>>);

struct NoData;

impl GpuData for NoData {
    fn as_any(&self) -> &dyn std::any::Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn std::any::Any {
        self
    }
}

impl Material3d for ShadowedMaterial {
    fn create_gpu_data(&self) -> Box<dyn GpuData> {
        Box::new(NoData)
    }

    fn begin_frame(&mut self) {
        let state = &mut *self.0.borrow_mut();
        state.view = None;
        state.visited.clear();
    }

    fn set_capture_mode(&mut self, on: bool) {
        let state = &mut *self.0.borrow_mut();
        state.in_mirror = on;
        // Before its mirrors kiss3d visits the scene with the camera of the image.
        if let (true, Some(view)) = (on, &state.view) {
            state.main_camera = view.camera;
        }
    }

    fn set_clip_plane(&mut self, plane: Option<[f32; 4]>) {
        self.0.borrow_mut().clip_plane = plane.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    }

    fn prepare(
        &mut self,
        pass: usize,
        transform: Pose3,
        scale: Vec3,
        camera: &mut dyn Camera3d,
        lights: &LightCollection,
        data: &ObjectData3d,
        _gpu_data: &mut dyn GpuData,
        _width: u32,
        _height: u32,
    ) {
        let state = &mut *self.0.borrow_mut();
        state
            .view
            .get_or_insert_with(|| View::new(camera, pass, lights));
        let (number, placement) = (
            data.segmentation_id(),
            Placement::new(transform, scale, data),
        );
        state.visited.insert(number);
        let placed = state.shadows.place(number, placement);
        placed.expect("an object that was inserted");
        if let Some(object) = state.shadows.get(number) {
            object.paint(data);
        }
    }

    fn flush(&mut self) {
        let state = &mut *self.0.borrow_mut();
        if let Some(view) = state.view.take() {
            if let Err(error) = state.flush(&view) {
                eprintln!("shadows: {error}");
            }
            state.view = Some(view);
        }
    }

    fn render(
        &mut self,
        _pass: usize,
        _transform: Pose3,
        _scale: Vec3,
        _camera: &mut dyn Camera3d,
        _lights: &LightCollection,
        data: &ObjectData3d,
        mesh: &mut GpuMesh3d,
        instances: &mut InstancesBuffer3d,
        _gpu_data: &mut dyn GpuData,
        pass: &mut wgpu::RenderPass<'_>,
        context: &RenderContext,
    ) {
        let state = self.0.borrow();
        let Some(object) = state.shadows.get(data.segmentation_id()) else {
            return;
        };
        if context.phase == RenderPhase::Opaque && data.surface_rendering_active() {
            pass.set_pipeline(&state.pipeline.get(context.sample_count));
            pass.set_bind_group(0, &state.frame_group, &[]);
            pass.set_bind_group(2, state.shadows.bindings.bind_group(), &[]);
            object.draw(pass, mesh, instances);
        }
    }
}

impl View {
    fn new(camera: &dyn Camera3d, pass: usize, lights: &LightCollection) -> Self {
        // The projection is OpenGL's, with depths from -1 to 1. WebGPU cuts off all below 0, so
        // that what is seen is what the product says, whatever it was meant for.
        let (view, projection) = camera.view_transform_pair(pass);
        let matrix = |matrix: [f32; 16]| glam::Mat4::from_cols_array(&matrix);
        Self {
            camera: CameraView::new(
                matrix(view.to_mat4().to_cols_array()),
                matrix(projection.to_cols_array()),
            ),
            eye: camera.eye(),
            ambient: lights.ambient,
            lights: lights.lights.iter().map(Light::from).collect(),
        }
    }
}

impl State {
    fn new() -> Result<Self, Box<dyn Error>> {
        let context = Context::get();
        let layout = |label, size| {
            context.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries: &[wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                    ty: wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: false,
                        min_binding_size: std::num::NonZeroU64::new(size),
                    },
                    count: None,
                }],
            })
        };
        let frame_bytes = 112 + 64 * MAX_LIGHTS as u64;
        let (frame_layout, object_layout) = (layout("frame", frame_bytes), layout("object", 96));
        let shadows = Shadows::new(&object_layout)?;
        let frame = context.create_buffer(&wgpu::BufferDescriptor {
            label: Some("frame"),
            size: frame_bytes,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let frame_group = context.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &frame_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: frame.as_entire_binding(),
            }],
        });
        let wgsl = [
            shadows.bindings.wgsl(),
            object::WGSL,
            include_str!("shade.wgsl"),
        ]
        .concat();
        let layouts = [
            Some(&frame_layout),
            Some(&object_layout),
            Some(shadows.bindings.layout()),
        ];
        let pipeline_layout = context.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("shadowed"),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        Ok(Self {
            pipeline: pipeline(
                context.create_shader_module(Some("shadowed"), &wgsl),
                pipeline_layout,
            ),
            shadows,
            record_time: Duration::ZERO,
            passes: 0,
            begins_frame: true,
            keeps_nothing: false,
            object_layout,
            frame,
            frame_group,
            main_camera: CameraView::new(glam::Mat4::IDENTITY, glam::Mat4::IDENTITY),
            mirror_cameras: Vec::new(),
            mirrors: 0,
            in_mirror: false,
            clip_plane: [0.0, 0.0, 0.0, 1.0],
            visited: HashSet::new(),
            view: None,
        })
    }

    /// Records the shadows of the frame and uploads the uniforms of the image that comes next,
    /// which is that of a mirror or the window's.
    fn flush(&mut self, view: &View) -> Result<(), Box<dyn Error>> {
        let unseen = |number: &&u32| !self.visited.contains(number);
        let gone: Vec<u32> = self.shadows.ids.keys().filter(unseen).copied().collect();
        for number in gone {
            self.shadows.place(number, Placement::default())?;
        }
        // All images of a frame share the maps. Those of mirrors are submitted one by one before
        // the window's; what the later ones will see is taken from the frame before.
        if self.in_mirror {
            match self.mirror_cameras.get_mut(self.mirrors) {
                Some(camera) => *camera = view.camera,
                None => self.mirror_cameras.push(view.camera),
            }
            self.mirrors += 1;
        } else {
            self.main_camera = view.camera;
            self.mirror_cameras.truncate(self.mirrors);
            self.mirrors = 0;
        }
        let cameras = [&[self.main_camera], &self.mirror_cameras[..]].concat();
        if std::mem::replace(&mut self.begins_frame, !self.in_mirror) {
            (self.record_time, self.passes) = (Duration::ZERO, 0);
            if self.keeps_nothing {
                self.shadows.invalidate();
            }
        }
        let context = Context::get();
        let mut encoder = context.create_command_encoder(Some("shadows"));
        let begin = Instant::now();
        self.shadows.record(&mut encoder, &cameras, &view.lights)?;
        self.record_time += begin.elapsed();
        self.passes += self.shadows.totals().0;
        context.submit([encoder.finish()]);
        context.write_buffer(&self.frame, 0, &self.frame_uniforms(view));
        Ok(())
    }

    fn frame_uniforms(&self, view: &View) -> Vec<u8> {
        let lights = &view.lights[..view.lights.len().min(MAX_LIGHTS)];
        let clip_from_world = view.camera.clip_from_view * view.camera.view_from_render;
        let mut words: Vec<u32> = bits(&clip_from_world.to_cols_array());
        words.extend(bits(&view.eye.to_array()));
        words.push(lights.len() as u32);
        words.extend(bits(&[view.ambient, view.ambient, view.ambient, 0.0]));
        words.extend(bits(&self.clip_plane));
        let mut used = [0; 3];
        for light in lights {
            let next = &mut used[light.kind as usize];
            let slot = if light.casts { *next } else { u32::MAX };
            *next += u32::from(light.casts);
            words.extend(bits(&light.position.to_array()));
            words.push(light.kind as u32);
            words.extend(bits(&light.direction.to_array()));
            words.push(slot);
            words.extend(bits(&light.color.to_array()));
            let [inner, outer] = light.cone.map(f32::cos);
            words.extend(bits(&[light.range, inner, outer, 0.0, 0.0]));
        }
        bytemuck::cast_slice(&words).to_vec()
    }
}

fn bits(floats: &[f32]) -> Vec<u32> {
    floats.iter().map(|float| float.to_bits()).collect()
}

fn pipeline(shader: wgpu::ShaderModule, layout: wgpu::PipelineLayout) -> PipelineCache {
    PipelineCache::new(move |sample_count| {
        Context::get().create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("shadowed"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("surface"),
                buffers: &object::BUFFERS,
                compilation_options: Default::default(),
            },
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("shade"),
                targets: &[Some(Context::render_format().into())],
                compilation_options: Default::default(),
            }),
            // kiss3d's mirrors turn triangles around, and its scale may; nothing is culled.
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: Context::depth_format(),
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: multisample_state(sample_count),
            multiview_mask: None,
            cache: None,
        })
    })
}
