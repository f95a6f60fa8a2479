//! Tests devices that are lost, out of memory, or not the one on which a light was made: every
//! constructor and every call returns a typed error and never panics.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use wgpu_shadows::{
    Aabb, CascadeLayout, CasterPipeline, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowBindings,
    ShadowBindingsDescriptor, ShadowCaster, ShadowError, SpotLight, SpotShadow,
    SpotShadowDescriptor, caster::CasterPipelineDescriptor, debug::DebugImage, debug::DebugView,
    error::BindingsError, error::CasterError, error::DebugViewError, error::DeviceError,
    error::DeviceRefusal, pool::OmniShadowPool, pool::PoolDescriptor, pool::PoolLight,
    pool::SpotShadowPool, report::ViewStatus,
};

use crate::fixtures::copies::Alone;
use crate::fixtures::frames::{
    Coverage, DirectionalFrame, OmniFrame, PoolFrame, RecordFrame, SpotFrame,
};
use crate::fixtures::gpu::{Gpu, GpuRequest, own_gpu, two_gpus};
use crate::fixtures::picture::{color_pass, color_target};
use crate::fixtures::scene::default_pipeline;
use crate::fixtures::table;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

const COVER: Aabb = Aabb::new(Vec3::NEG_ONE, Vec3::ONE);

/// Holds one of everything that is made on a device.
struct Everything {
    sun: DirectionalShadow,
    spot: SpotShadow,
    lamp: OmniShadow,
    spots: SpotShadowPool,
    lamps: OmniShadowPool,
    view: DebugView,
}

fn sun(gpu: &Gpu) -> Result<DirectionalShadow, ShadowError> {
    let descriptor = DirectionalShadowDescriptor {
        map_size: 16,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    DirectionalShadow::new(&gpu.device, &descriptor)
}

fn spot(gpu: &Gpu) -> Result<SpotShadow, ShadowError> {
    let descriptor = SpotShadowDescriptor {
        map_size: 16,
        ..Default::default()
    };
    SpotShadow::new(&gpu.device, &descriptor)
}

fn lamp(gpu: &Gpu) -> Result<OmniShadow, ShadowError> {
    let descriptor = OmniShadowDescriptor {
        map_size: 16,
        ..Default::default()
    };
    OmniShadow::new(&gpu.device, &descriptor)
}

fn pool() -> PoolDescriptor<'static> {
    PoolDescriptor {
        map_size: 16,
        capacity: 2,
        ..Default::default()
    }
}

fn bindings(gpu: &Gpu, sun: &DirectionalShadow) -> Result<ShadowBindings, BindingsError> {
    let descriptor = ShadowBindingsDescriptor {
        lights: &[("sun", sun.maps())],
        ..Default::default()
    };
    ShadowBindings::new(&gpu.device, &descriptor)
}

impl Everything {
    fn new(gpu: &Gpu) -> Self {
        let device = &gpu.device;
        Self {
            sun: sun(gpu).expect("a sun"),
            spot: spot(gpu).expect("a spot"),
            lamp: lamp(gpu).expect("a lamp"),
            spots: SpotShadowPool::new(device, &pool()).expect("a pool"),
            lamps: OmniShadowPool::new(device, &pool()).expect("a pool"),
            view: DebugView::new(device, FORMAT).expect("a debug view"),
        }
    }

    /// Records a frame of every light on `gpu`, and returns the error of each that has none.
    fn record(&mut self, gpu: &Gpu, casters: &[&dyn ShadowCaster]) -> Vec<Option<ShadowError>> {
        let (origin, receivers) = (DVec3::ZERO, &[COVER][..]);
        let mut encoder = gpu.encoder();
        let lamp = OmniLight {
            position_world: DVec3::new(0.0, 3.0, 0.0),
            range: 9.0,
        };
        let spot = SpotLight {
            position_world: lamp.position_world,
            direction: Vec3::NEG_Y,
            outer_angle_radians: 0.6,
            range: 9.0,
        };
        let sun_frame = DirectionalFrame {
            origin,
            light: DirectionalLight::new(Vec3::NEG_Y),
            coverage: Coverage::Bounds(COVER),
            casters,
            receivers,
        };
        let spot_frame = SpotFrame {
            origin,
            light: spot,
            camera: None,
            casters,
            receivers,
        };
        let lamp_frame = OmniFrame {
            origin,
            light: lamp,
            camera: None,
            casters,
            receivers,
        };
        let spots = [PoolLight {
            slot: self.spots.insert().expect("a slot"),
            light: spot,
            importance: 1.0,
        }];
        let lamps = [PoolLight {
            slot: self.lamps.insert().expect("a slot"),
            light: lamp,
            importance: 1.0,
        }];
        let results = [
            self.sun.record_frame(&mut encoder, &sun_frame).err(),
            self.spot.record_frame(&mut encoder, &spot_frame).err(),
            self.lamp.record_frame(&mut encoder, &lamp_frame).err(),
            self.spots
                .record_frame(&mut encoder, &pool_frame(&spots, casters))
                .err(),
            self.lamps
                .record_frame(&mut encoder, &pool_frame(&lamps, casters))
                .err(),
        ];
        gpu.queue.submit([encoder.finish()]);
        results.to_vec()
    }
}

fn pool_frame<'a, L>(
    lights: &'a [PoolLight<L>],
    casters: &'a [&'a dyn ShadowCaster],
) -> PoolFrame<'a, L> {
    PoolFrame {
        origin: DVec3::ZERO,
        lights,
        camera: None,
        casters,
        receivers: &[COVER],
        max_views: None,
    }
}

/// Once the device is lost, nothing is created on it and no frame is recorded, and each call
/// returns that error.
#[test]
fn a_lost_device_makes_nothing() {
    let lost = own_gpu(GpuRequest::default());
    let device = &lost.device;
    let mesh = Mesh::cuboid(Vec3::splat(-0.2), Vec3::splat(0.2));
    let pipeline = default_pipeline(&lost);
    let caster = mesh.caster(&lost, &pipeline, Mat4::IDENTITY);
    let vertices = lost.buffer(&mesh.positions, wgpu::BufferUsages::VERTEX);
    let mut all = Everything::new(&lost);
    bindings(&lost, &all.sun).expect("bindings");
    assert_eq!(all.record(&lost, &[]), [const { None }; 5], "before");
    let target = color_target(&lost, 4);
    device.destroy();

    let refusal = DeviceRefusal::Lost;
    let errors = [
        sun(&lost).err(),
        spot(&lost).err(),
        lamp(&lost).err(),
        SpotShadowPool::new(device, &pool()).err(),
        OmniShadowPool::new(device, &pool()).err(),
    ];
    for error in errors {
        let error = error.expect("no light");
        let wanted = ShadowError::Device(DeviceError {
            object: "the depth map",
            refusal: refusal.clone(),
        });
        assert_eq!(error, wanted);
        let text = "the device did not make the depth map: the device is lost";
        assert_eq!(error.to_string(), text);
    }
    let error = CasterPipeline::new(device, &CasterPipelineDescriptor::new());
    let wanted = CasterError::Device(DeviceError {
        object: "a caster pipeline",
        refusal: refusal.clone(),
    });
    assert_eq!(error.expect_err("no pipeline"), wanted);
    let error = wgpu_shadows::MeshCaster::new(
        device,
        &wgpu_shadows::caster::MeshCasterDescriptor {
            label: None,
            pipeline: &pipeline,
            vertices: &vertices,
            indices: wgpu_shadows::caster::MeshIndices::None { vertices: 0..3 },
            bounds_model: mesh.bounds(),
            render_from_model: Mat4::IDENTITY,
        },
    );
    let wanted = CasterError::Device(DeviceError {
        object: "a mesh",
        refusal: refusal.clone(),
    });
    assert_eq!(error.expect_err("no mesh"), wanted);
    let wanted = BindingsError::Device(DeviceError {
        object: "the bind group of the lights",
        refusal: refusal.clone(),
    });
    assert_eq!(bindings(&lost, &all.sun).expect_err("no bindings"), wanted);
    let wanted = DebugViewError::Device(DeviceError {
        object: "the pipelines of a debug view",
        refusal: refusal.clone(),
    });
    let error = DebugView::new(device, FORMAT).expect_err("no debug view");
    assert_eq!(error, wanted);

    for error in all.record(&lost, &[&caster]) {
        let wanted = ShadowError::Device(DeviceError {
            object: "the matrices of instances",
            refusal: refusal.clone(),
        });
        assert_eq!(error, Some(wanted));
    }
    assert_eq!(
        all.sun.maps().views().len(),
        0,
        "the last good state is kept"
    );
    let mut encoder = lost.encoder();
    let mut pass = color_pass(&mut encoder, &target);
    let picture = DebugImage::Layer(0);
    let error = all.view.draw(&mut pass, all.sun.maps(), picture);
    let wanted = DebugViewError::Device(DeviceError {
        object: "the bind group of a debug view",
        refusal,
    });
    assert_eq!(error, Err(wanted));
    table::record(
        "a lost device",
        "every constructor and every frame that draws is a typed error, nothing is recorded, no panic",
        "as expected, 9 constructors, 5 frames, 1 draw",
    );
}

/// A frame in which a caster draws itself, with the uniforms of the frame before, uploads nothing,
/// and is an error all the same; one that keeps its map makes no call to the device.
#[test]
fn a_lost_device_draws_nothing() {
    let lost = own_gpu(GpuRequest::default());
    let mesh = Mesh::cuboid(Vec3::splat(-0.2), Vec3::splat(0.2));
    let mut caster = mesh.caster(&lost, &default_pipeline(&lost), Mat4::IDENTITY);
    let mut sun = sun(&lost).expect("a sun");
    let mut status = |caster: &dyn ShadowCaster| {
        let frame = DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(Vec3::NEG_Y),
            coverage: Coverage::Bounds(COVER),
            casters: &[caster],
            receivers: &[],
        };
        let mut encoder = lost.encoder();
        let report = sun.record_frame(&mut encoder, &frame);
        let status = report.map(|report| report.views[0].status);
        lost.queue.submit([encoder.finish()]);
        status
    };
    assert_eq!(status(&caster), Ok(ViewStatus::Drawn));
    let changed = caster.geometry_changed(mesh.bounds());
    changed.expect("finite bounds");
    assert_eq!(status(&Alone(&caster)), Ok(ViewStatus::Drawn));
    lost.device.destroy();
    assert_eq!(status(&Alone(&caster)), Ok(ViewStatus::Kept));
    let changed = caster.geometry_changed(mesh.bounds());
    changed.expect("finite bounds");
    let error = |object| {
        Err(ShadowError::Device(DeviceError {
            object,
            refusal: DeviceRefusal::Lost,
        }))
    };
    assert_eq!(status(&Alone(&caster)), error("a depth pass"));
    // What is drawn in batches uploads its matrices.
    assert_eq!(status(&caster), error("the uniforms of a frame"));
}

/// A light of another device is refused before anything is made or drawn, and frames are recorded
/// on the light's own device.
#[test]
fn a_light_of_another_device_is_refused() {
    let [here, there] = two_gpus();
    let mut all = Everything::new(&here);
    let error = bindings(&there, &all.sun).expect_err("no bindings");
    let wanted = BindingsError::OtherDevice {
        name: "sun".to_owned(),
    };
    assert_eq!(error, wanted);
    assert_eq!(
        error.to_string(),
        "ShadowBindingsDescriptor::lights: \"sun\" must have been made on the device that is passed"
    );
    let view = DebugView::new(&there.device, FORMAT).expect("a debug view");
    let target = color_target(&there, 4);
    let mut encoder = there.encoder();
    {
        let mut pass = color_pass(&mut encoder, &target);
        let picture = DebugImage::Layer(0);
        let error = view.draw(&mut pass, all.sun.maps(), picture);
        assert_eq!(error, Err(DebugViewError::OtherDevice));
    }
    there.submit(encoder);
    // Frames are recorded on the light's own device, whatever other devices exist.
    assert_eq!(all.record(&here, &[]), [const { None }; 5]);
    table::record(
        "a light of another device",
        "refused by bindings and debug views",
        "as expected",
    );
}
