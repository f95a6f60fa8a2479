//! Tests bad input, encoders that are not submitted, and frames in flight.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use wgpu_shadows::meter::{ErrorMeter, ErrorMeterDescriptor, MeasuredLight, MeterReport, Receiver};
use wgpu_shadows::{
    Aabb, Casters, Coverage, DepthFormat, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, OmniLight, ShadowCaster, ShadowError, ShadowFrameDescriptor,
    ShadowScene, SpotLight,
};

use crate::fixtures::gpu::{Gpu, GpuRequest, gpu, own_gpu};
use crate::fixtures::scene::{Scene, default_pipeline};

const LIGHT: DirectionalLight = DirectionalLight::new(Vec3::new(0.2, -1.0, 0.1));
const BELOW: Receiver = Receiver {
    position_render: Vec3::ZERO,
    normal: Vec3::Y,
};
const BESIDE: Receiver = Receiver {
    position_render: Vec3::new(3.0, 0.0, 0.0),
    normal: Vec3::Y,
};

fn scene(gpu: &Gpu) -> Scene {
    let slab = Mesh::cuboid(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 1.2, 1.0));
    Scene::new(gpu, &[slab, Mesh::floor(0.0, 5.0)])
}

fn sun(gpu: &Gpu, depth_format: DepthFormat) -> DirectionalShadow {
    let descriptor = DirectionalShadowDescriptor {
        map_size: 64,
        depth_format,
        ..Default::default()
    };
    DirectionalShadow::new(&gpu.device, &descriptor).expect("a sun")
}

/// Records a frame of the sun and the meter.
fn record(
    encoder: &mut wgpu::CommandEncoder,
    (sun, meter): (&mut DirectionalShadow, &mut ErrorMeter),
    casters: &[&dyn ShadowCaster],
    light: &MeasuredLight<'_>,
    receivers: &[Receiver],
) -> Result<MeterReport, ShadowError> {
    let mut scene = ShadowScene::new();
    let frame = scene.frame(&ShadowFrameDescriptor {
        origin: DVec3::ZERO,
        coverage: Coverage::Bounds(Aabb::new(Vec3::splat(-5.0), Vec3::splat(5.0))),
        casters: Casters::List(casters),
        receivers: &[],
    })?;
    sun.record(encoder, &frame, &LIGHT)?;
    meter
        .record(encoder, &frame, sun.maps(), light, receivers)
        .copied()
}

fn wait(gpu: &Gpu) {
    let polled = gpu.device.poll(wgpu::PollType::wait_indefinitely());
    polled.expect("the device works");
}

#[test]
fn bad_input_is_refused_with_field_and_value() {
    let gpu = gpu();
    let scene = scene(gpu);
    let mut sun = sun(gpu, DepthFormat::Float32);
    let new = |places_per_frame, window_frames| {
        let descriptor = ErrorMeterDescriptor {
            places_per_frame,
            window_frames,
            ..ErrorMeterDescriptor::new(sun.maps())
        };
        let refused = ErrorMeter::new(&descriptor).err();
        refused.map_or(String::new(), |error| error.to_string())
    };
    let field = "ErrorMeterDescriptor::places_per_frame must be in 1..=4096, got";
    assert_eq!(new(0, 1), format!("{field} 0"));
    assert_eq!(new(4097, 1), format!("{field} 4097"));
    let field = "ErrorMeterDescriptor::window_frames must be at least 1, got";
    assert_eq!(new(1, 0), format!("{field} 0"));

    let mut meter = ErrorMeter::new(&ErrorMeterDescriptor::new(sun.maps())).expect("a meter");
    let directional = MeasuredLight::Directional(&LIGHT);
    let spot = SpotLight {
        position_world: DVec3::Y,
        direction: Vec3::NEG_Y,
        outer_angle_radians: 0.5,
        range: 9.0,
    };
    let omni = OmniLight {
        position_world: DVec3::Y,
        range: 9.0,
    };
    let dark = DirectionalLight::new(Vec3::ZERO);
    let at = |x: f32, y: f32| Receiver {
        position_render: Vec3::new(x, 0.0, 0.0),
        normal: Vec3::new(0.0, y, 0.0),
    };
    let lost = at(f32::NAN, 1.0);
    let (flat, endless) = (at(0.0, 0.0), at(0.0, f32::INFINITY));
    let cases = [
        (
            directional,
            lost,
            "Receiver::position_render must be finite, got [NaN, 0, 0]",
        ),
        (
            directional,
            flat,
            "Receiver::normal must not have length zero",
        ),
        (
            directional,
            endless,
            "Receiver::normal must be finite, got [0, inf, 0]",
        ),
        (
            MeasuredLight::Spot(&spot),
            BELOW,
            "MeasuredLight must be of the kind of ErrorMeterDescriptor::maps, got Spot",
        ),
        (
            MeasuredLight::Omni(&omni),
            BELOW,
            "MeasuredLight must be of the kind of ErrorMeterDescriptor::maps, got Omni",
        ),
        (
            MeasuredLight::OmniPool(&[]),
            BELOW,
            "MeasuredLight must be of the kind of ErrorMeterDescriptor::maps, got OmniPool",
        ),
        (
            MeasuredLight::Directional(&dark),
            BELOW,
            "DirectionalLight::direction must not have length zero",
        ),
    ];
    let list = scene.list();
    for (light, receiver, message) in cases {
        let mut encoder = gpu.encoder();
        let receivers = [BESIDE, receiver];
        let objects = (&mut sun, &mut meter);
        let error = record(&mut encoder, objects, &list, &light, &receivers).expect_err(message);
        assert_eq!(error.to_string(), message);
        gpu.submit(encoder);
    }
    let mut other = self::sun(gpu, DepthFormat::Float32);
    let objects = (&mut other, &mut meter);
    let error = record(&mut gpu.encoder(), objects, &list, &directional, &[BELOW]);
    let message = "ErrorMeter::record: maps must be those of ErrorMeterDescriptor::maps, \
                   got the maps of another light";
    assert_eq!(error.expect_err(message).to_string(), message);
    wait(gpu);
    assert_eq!(meter.measured().samples, 0.0);
}

#[test]
fn depth_formats_are_those_of_the_light() {
    let gpu = gpu();
    let scene = scene(gpu);
    for format in [DepthFormat::Float32, DepthFormat::Unorm16] {
        let mut sun = sun(gpu, format);
        let mut meter = ErrorMeter::new(&ErrorMeterDescriptor::new(sun.maps())).expect("a meter");
        let mut encoder = gpu.encoder();
        let light = MeasuredLight::Directional(&LIGHT);
        let objects = (&mut sun, &mut meter);
        let report = record(
            &mut encoder,
            objects,
            &scene.list(),
            &light,
            &[BELOW, BESIDE],
        );
        assert_eq!(report.expect("a frame").places, 2);
        gpu.submit(encoder);
        wait(gpu);
        meter.measured();
        let seen: Vec<_> = meter
            .last_places()
            .iter()
            .map(|place| place.visibility_by_rays)
            .collect();
        assert_eq!(seen, [0.0, 1.0]);
    }
}

/// While nothing is submitted no more than four frames are measured, and none waits. A dropped
/// encoder leaves nothing behind.
#[test]
fn frames_in_flight_and_dropped_encoders_do_no_harm() {
    let gpu = gpu();
    let scene = scene(gpu);
    let mut sun = sun(gpu, DepthFormat::Float32);
    let mut meter = ErrorMeter::new(&ErrorMeterDescriptor::new(sun.maps())).expect("a meter");
    let (list, light) = (scene.list(), MeasuredLight::Directional(&LIGHT));
    let mut encoders: Vec<_> = (0..6).map(|_| gpu.encoder()).collect();
    let passes: Vec<_> = encoders
        .iter_mut()
        .map(|encoder| {
            let objects = (&mut sun, &mut meter);
            let report = record(encoder, objects, &list, &light, &[BELOW, BESIDE]);
            report.expect("a frame").passes
        })
        .collect();
    assert_eq!(passes, [2, 2, 2, 2, 0, 0]);
    encoders.truncate(3);
    let submitted = encoders.len() as f64;
    for encoder in encoders {
        gpu.submit(encoder);
    }
    wait(gpu);
    let measured = meter.measured();
    assert!(
        (measured.samples - 2.0 * submitted).abs() < 0.01,
        "{measured:?}"
    );
    assert_eq!(measured.rmse.value, 0.0);
    // The fourth buffer has come back with its dropped encoder.
    let mut encoder = gpu.encoder();
    for _ in 0..4 {
        let objects = (&mut sun, &mut meter);
        let report = record(&mut encoder, objects, &list, &light, &[BELOW]);
        assert_eq!(report.expect("a frame").passes, 2);
    }
    meter.reset();
    gpu.submit(encoder);
    wait(gpu);
    assert_eq!(
        meter.measured().samples,
        0.0,
        "what was on its way is forgotten"
    );
}

#[test]
fn places_that_cannot_be_measured_are_counted() {
    let gpu = gpu();
    let scene = scene(gpu);
    let mut sun = sun(gpu, DepthFormat::Float32);
    let mut meter = ErrorMeter::new(&ErrorMeterDescriptor::new(sun.maps())).expect("a meter");
    let below = Receiver {
        normal: Vec3::NEG_Y,
        ..BELOW
    };
    let light = MeasuredLight::Directional(&LIGHT);
    let objects = (&mut sun, &mut meter);
    let receivers = [below, BELOW, below];
    let mut encoder = gpu.encoder();
    let report = record(&mut encoder, objects, &scene.list(), &light, &receivers);
    let report = report.expect("a frame");
    assert_eq!((report.places, report.facing_away), (1, 2));
    // A caster whose bounds are of another order than its geometry hides what a ray could see.
    let vast = Mesh::cuboid(Vec3::splat(-1e9), Vec3::splat(1e9));
    let vast = vast.caster(gpu, &default_pipeline(gpu), Mat4::IDENTITY);
    let mut list = scene.list();
    list.push(&vast);
    let objects = (&mut sun, &mut meter);
    let report = record(&mut encoder, objects, &list, &light, &[BELOW]);
    let report = report.expect("a frame");
    assert_eq!((report.places, report.unresolved), (0, 1));
    gpu.submit(encoder);
}

#[test]
fn devices_without_compute_shaders_are_refused() {
    let gpu = own_gpu(GpuRequest {
        limits: wgpu::Limits::downlevel_webgl2_defaults(),
        ..Default::default()
    });
    let sun = sun(&gpu, DepthFormat::Float32);
    let error = ErrorMeter::new(&ErrorMeterDescriptor::new(sun.maps())).err();
    let message = "the compute pass of an ErrorMeter: \
                   the device's max_compute_invocations_per_workgroup must be at least 64, and it is 0";
    assert_eq!(
        error.map(|error| error.to_string()).as_deref(),
        Some(message)
    );
}
