//! Tests `DebugView::draw_cascades`: each pixel has the colour of the view that covers what is seen
//! there.

use glam::{DVec3, DVec4, Mat4};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use wgpu_shadows::{
    CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    debug::DebugView, error::DebugViewError, error::DeviceError, reference,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::{gpu, vulkan};
use crate::fixtures::picture::{COLOR, color_target};
use crate::fixtures::probe::record;
use crate::fixtures::scene::Scene;
use crate::fixtures::tint::{cleared, tint};

const SIZE: u32 = 96;

/// Lists the colours of `wgsl/pass/cascade_tint.wgsl` for three cascades and for none.
const TINTS: [[f64; 3]; 4] = [
    [1.0, 0.35, 0.3],
    [0.35, 1.0, 0.3],
    [0.35, 0.5, 1.0],
    [0.6, 0.6, 0.6],
];

/// On planes at several depths, every pixel has the colour of the first cascade that covers its
/// position in f64. Positions within `1e-3` of their own magnitude of a border are undecided:
/// matrices of f32 err by 1e-6 of a distance of some tens.
#[test]
fn pixels_have_the_colours_of_their_cascades() {
    let gpu = gpu();
    let mut meshes = vec![Mesh::floor(0.0, 60.0)];
    for row in 0..8 {
        let low = DVec3::new(-2.0, 0.0, 3.0 + 6.0 * f64::from(row)).as_vec3();
        meshes.push(Mesh::cuboid(low, low + 2.0));
    }
    let scene = Scene::new(gpu, &meshes);
    let camera = Camera::modern(
        DVec3::new(0.0, 3.0, -4.0),
        DVec3::new(0.5, 0.0, 20.0),
        0.9,
        1.0,
    );
    let mut shadow = DirectionalShadow::new(
        &gpu.device,
        &DirectionalShadowDescriptor {
            map_size: 128,
            layout: CascadeLayout::fixed(3),
            ..Default::default()
        },
    )
    .expect("a valid sun");
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2).as_vec3()),
        coverage: Coverage::Camera(camera.view().with_max_distance(50.0)),
        casters: &scene.list(),
        receivers: &[],
    };
    record(gpu, &mut shadow, &frame);
    let render_from_clip = (camera.clip_from_view() * camera.view_from_render()).inverse();
    let mut seen = [0; 4];
    for distance in [3.0, 6.0, 12.0, 25.0, 45.0] {
        let along = camera.pose.eye - camera.pose.axes.z_axis * distance;
        let clip = camera.clip_from_view() * camera.view_from_render() * along.extend(1.0);
        let depth = (clip.z / clip.w) as f32;
        let image = tint(gpu, shadow.maps(), &camera, SIZE, depth);
        for (x, y, pixel) in image.enumerate_pixels() {
            let ndc = |pixel: u32| (f64::from(pixel) + 0.5) / f64::from(SIZE) * 2.0 - 1.0;
            let place = render_from_clip * DVec4::new(ndc(x), -ndc(y), f64::from(depth), 1.0);
            let place = place.truncate() / place.w;
            let serving = |place: DVec3| {
                let mut views = shadow.maps().view_uniforms().iter();
                views
                    .position(|view| reference::holds(view, place))
                    .unwrap_or(3)
            };
            let cascade = serving(place);
            let near = [-1e-3, 1e-3].map(|share| {
                let to_light = DVec3::new(-0.3, 1.0, -0.2).normalize();
                let aside = camera.pose.axes.x_axis + camera.pose.axes.y_axis + to_light;
                serving(place + aside * share * distance)
            });
            if near != [cascade; 2] {
                continue;
            }
            seen[cascade] += 1;
            for (channel, wanted) in pixel.0.iter().zip(TINTS[cascade]) {
                // The tolerance is half a step of 8 bits, and f32's rounding of it.
                let error = (f64::from(*channel) - wanted * 255.0).abs();
                assert!(
                    error <= 0.51,
                    "{x}, {y} at {distance}: {pixel:?} for {cascade}"
                );
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 200), "{seen:?}");
    // Where nothing is drawn, by either depth convention, the image stays as it is.
    for sky in [0.0, 1.0] {
        let image = tint(gpu, shadow.maps(), &camera, SIZE, sky);
        assert!(image.pixels().all(|pixel| pixel.0 == [255; 4]), "{sky}");
    }
}

/// A target that cannot be blended can show maps but no tints; a texture that is not a depth
/// texture is refused. The pass can be used further. This runs on Vulkan, since the OpenGL driver
/// has no format that is renderable and cannot be blended.
#[test]
fn what_cannot_be_tinted_is_refused() {
    let gpu = vulkan();
    let shadow = DirectionalShadow::new(
        &gpu.device,
        &DirectionalShadowDescriptor {
            map_size: 16,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        },
    )
    .expect("a valid sun");
    let target = color_target(gpu, 16);
    let target_view = target.create_view(&Default::default());
    let unblendable = DebugView::new(&gpu.device, wgpu::TextureFormat::Rgba32Float);
    let unblendable = unblendable.expect("a renderable float format");
    let blendable = DebugView::new(&gpu.device, COLOR).expect("a format for pictures");
    let mut encoder = gpu.encoder();
    let mut pass = cleared(&mut encoder, Some(&target_view), None);
    let mut draw = |view: &DebugView, depth| {
        view.draw_cascades(&mut pass, shadow.maps(), depth, Mat4::IDENTITY)
    };
    let refused = draw(&unblendable, &target_view).expect_err("no blending");
    assert!(
        matches!(refused, DebugViewError::Format { .. }),
        "{refused}"
    );
    let other = color_target(gpu, 16).create_view(&Default::default());
    let refused = draw(&blendable, &other).expect_err("no depth");
    assert!(
        matches!(refused, DebugViewError::Device(DeviceError { .. })),
        "{refused}"
    );
    drop(pass);
    gpu.submit(encoder);
}
