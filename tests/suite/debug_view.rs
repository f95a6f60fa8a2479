//! Tests `DebugView`: a grey level shows a depth or a distance, the cross unfolds as documented,
//! and what cannot be drawn is refused.

use glam::{DVec3, Vec3};
use image::RgbaImage;
use shadow_support::mesh::Mesh;
use shadow_support::readback;
use wgpu_shadows::{
    Aabb, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    OmniLight, OmniShadow, OmniShadowDescriptor, ShadowMaps, SpotLight, SpotShadow,
    SpotShadowDescriptor, debug::DebugImage, debug::DebugView, error::DebugViewError,
    pool::OmniShadowPool, pool::PoolDescriptor, pool::PoolLight,
};

use crate::fixtures::ask::{record_omni, record_spot, submitted};
use crate::fixtures::frames::{
    Coverage, DirectionalFrame, OmniFrame, PoolFrame, RecordFrame, SpotFrame,
};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::picture::{COLOR, color_pass, color_target};
use crate::fixtures::probe::record;
use crate::fixtures::scene::Scene;

/// Draws into the upper left `width` by `height` pixels of a square target.
fn picture(
    gpu: &Gpu,
    source: &ShadowMaps,
    picture: DebugImage,
    [width, height]: [u32; 2],
) -> Result<RgbaImage, DebugViewError> {
    let view = DebugView::new(&gpu.device, COLOR)?;
    let target = color_target(gpu, width.max(height));
    let mut encoder = gpu.encoder();
    let mut pass = color_pass(&mut encoder, &target);
    pass.set_viewport(0.0, 0.0, width as f32, height as f32, 0.0, 1.0);
    let drawn = view.draw(&mut pass, source, picture);
    drop(pass);
    gpu.submit(encoder);
    drawn.map(|()| readback::rgba8(gpu, &target))
}

/// Asserts that a pixel is grey, opaque, and at most half a step of 8 bits (and f32's rounding of
/// it) from `wanted`.
fn assert_grey(image: &RgbaImage, [x, y]: [u32; 2], wanted: f64, name: &str) {
    let [r, g, b, a] = image.get_pixel(x, y).0;
    assert!(r == g && g == b && a == 255, "{name} at {x}, {y}");
    let error = (f64::from(r) - wanted * 255.0).abs();
    assert!(
        error <= 0.51,
        "{name} at {x}, {y}: {r}, wanted {}",
        wanted * 255.0
    );
}

const MAP: u32 = 48;

fn sun() -> (DirectionalShadow, Vec<f32>) {
    let gpu = gpu();
    let descriptor = DirectionalShadowDescriptor {
        map_size: MAP,
        layout: CascadeLayout::fixed(2),
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let sphere = Mesh::sphere(Vec3::new(0.2, 1.0, 0.0), 0.9, 12);
    let scene = Scene::new(gpu, &[Mesh::floor(0.0, 2.0), sphere]);
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::new(0.4, -1.0, 0.2)),
        coverage: Coverage::Bounds(Aabb::new(Vec3::splat(-2.0), Vec3::splat(2.0))),
        casters: &scene.list(),
        receivers: &[],
    };
    record(gpu, &mut shadow, &frame);
    let depths = readback::depth_layer(gpu, shadow.maps().texture(), 0);
    (shadow, depths)
}

#[test]
fn a_sun_shows_its_depth() {
    let (shadow, depths) = sun();
    let layer = picture(gpu(), shadow.maps(), DebugImage::Layer(0), [MAP; 2]);
    let image = layer.expect("a layer of the map");
    for (index, depth) in (0..).zip(&depths) {
        let pixel = [index % MAP, index / MAP];
        assert_grey(&image, pixel, 1.0 - f64::from(*depth), "sun");
    }
    let steps = depths.iter().map(|depth| (depth * 255.0) as u32);
    assert!(steps.collect::<std::collections::BTreeSet<_>>().len() > 20);
    // Nothing casts into the second cascade.
    let empty = picture(gpu(), shadow.maps(), DebugImage::Layer(1), [MAP; 2]);
    let empty = empty.expect("a layer of the map");
    assert!(empty.pixels().all(|pixel| pixel.0 == [255; 4]));
}

/// Records a spot light over a floor at height 0.
fn spot_over_floor(gpu: &Gpu, light: SpotLight, receivers: Aabb) -> SpotShadow {
    let descriptor = SpotShadowDescriptor {
        map_size: MAP,
        ..Default::default()
    };
    let mut shadow = SpotShadow::new(&gpu.device, &descriptor).expect("a valid spot");
    let scene = Scene::new(gpu, &[Mesh::floor(0.0, 9.0)]);
    let frame = SpotFrame {
        origin: DVec3::ZERO,
        light,
        camera: None,
        casters: &scene.list(),
        receivers: &[receivers],
    };
    record_spot(gpu, &mut shadow, &frame).expect("a valid frame");
    shadow
}

/// A spot light shines on a plane: each pixel shows how far along the ray through its texel the
/// plane lies, as a fraction of the range.
#[test]
fn a_spot_shows_distances() {
    let gpu = gpu();
    let (place, range) = (DVec3::new(0.3, 3.0, -0.2), 6.0);
    let light = SpotLight {
        position_world: place,
        direction: Vec3::new(0.3, -1.0, 0.2),
        outer_angle_radians: 0.7,
        range: range as f32,
    };
    let receivers = Aabb::new(Vec3::splat(-9.0), Vec3::splat(9.0));
    let shadow = spot_over_floor(gpu, light, receivers);
    let layer = picture(gpu, shadow.maps(), DebugImage::Layer(0), [MAP; 2]);
    let image = layer.expect("a layer of the map");
    let view = shadow.maps().views().next().expect("a view");
    let anchor_from_clip = view.clip_from_anchor().as_dmat4().inverse();
    let mut drawn = 0;
    for y in 0..MAP {
        for x in 0..MAP {
            let ndc = |texel: u32| (f64::from(texel) + 0.5) * 2.0 / f64::from(MAP) - 1.0;
            let near = anchor_from_clip * DVec3::new(ndc(x), -ndc(y), 1.0).extend(1.0);
            let ray = (near.truncate() / near.w).normalize();
            let distance = place.y / -ray.y;
            // Where there is nothing, or only what lies beyond the range, the pixel is white.
            let wanted = if ray.y < -1e-3 {
                (distance / range).min(1.0)
            } else {
                1.0
            };
            // The floor ends nine metres out, farther than the range.
            assert_grey(&image, [x, y], wanted, "spot");
            drawn += u32::from(wanted < 1.0);
        }
    }
    assert!(drawn > MAP * MAP / 2, "{drawn}");
}

/// Are the distances of six walls, all different.
const WALLS: [f32; 6] = [3.0, 4.0, 2.5, 3.5, 4.5, 2.0];

/// Describes a room with the light at the origin and a small ball in each face, beside its middle:
/// by the direction of the ball, and by where the cross must show it, in cells of the four by three
/// from the upper left.
///
/// The cross shows what a viewer sees who stands at the light and looks along -z, with the other
/// walls folded outward: right is +x and up is +y, the ceiling's lower border is the upper border
/// of the wall ahead, and the wall behind is outermost on the right.
const BALLS: [(Vec3, [f32; 2]); 6] = [
    (Vec3::new(1.0, 0.5, -0.5), [2.25, 1.25]),
    (Vec3::new(-1.0, 0.5, -0.5), [0.75, 1.25]),
    (Vec3::new(0.5, 1.0, -0.5), [1.75, 0.75]),
    (Vec3::new(0.5, -1.0, -0.5), [1.75, 2.25]),
    (Vec3::new(-0.5, 0.5, 1.0), [3.75, 1.25]),
    (Vec3::new(0.5, 0.5, -1.0), [1.75, 1.25]),
];

/// Lists the middles of the cells of +x, -x, +y, -y, +z, -z.
const CELLS: [[f32; 2]; 6] = [
    [2.5, 1.5],
    [0.5, 1.5],
    [1.5, 0.5],
    [1.5, 2.5],
    [3.5, 1.5],
    [1.5, 1.5],
];

const RANGE: f32 = 6.0;
const CELL: u32 = 41;
const CROSS: [u32; 2] = [4 * CELL, 3 * CELL];

fn room(gpu: &Gpu) -> Scene {
    let low = Vec3::new(-WALLS[1], -WALLS[3], -WALLS[5]);
    let high = Vec3::new(WALLS[0], WALLS[2], WALLS[4]);
    let balls = BALLS.map(|(direction, _)| Mesh::sphere(direction * 1.2, 0.15, 16));
    let meshes: Vec<_> = balls.into_iter().chain([Mesh::cuboid(low, high)]).collect();
    Scene::new(gpu, &meshes)
}

/// Lists receivers beyond the walls, so that the walls are drawn.
const BEYOND: [Aabb; 1] = [Aabb::new(Vec3::splat(-9.0), Vec3::splat(9.0))];

const LAMP: OmniLight = OmniLight {
    position_world: DVec3::ZERO,
    range: RANGE,
};

fn lamp(gpu: &Gpu) -> OmniShadow {
    let descriptor = OmniShadowDescriptor {
        map_size: 256,
        ..Default::default()
    };
    let mut shadow = OmniShadow::new(&gpu.device, &descriptor).expect("a valid lamp");
    let room = room(gpu);
    let frame = OmniFrame {
        origin: DVec3::ZERO,
        light: LAMP,
        camera: None,
        casters: &room.list(),
        receivers: &BEYOND,
    };
    let report = record_omni(gpu, &mut shadow, &frame).expect("a valid frame");
    assert_eq!(report.passes, 6);
    shadow
}

fn pixel(cell: [f32; 2]) -> [u32; 2] {
    cell.map(|place| (place * CELL as f32) as u32)
}

#[test]
fn a_cross_shows_the_walls_of_a_room() {
    let gpu = gpu();
    let shadow = lamp(gpu);
    let image = picture(gpu, shadow.maps(), DebugImage::Cross, CROSS).expect("a cube");
    for (wall, cell) in WALLS.into_iter().zip(CELLS) {
        // The ray points straight ahead: the middle of an odd cell is the middle of a pixel, and
        // half a texel from that of a texel.
        assert_grey(&image, pixel(cell), f64::from(wall / RANGE), "wall");
    }
    for (direction, cell) in BALLS {
        // The cell shows the ball's front, and at the opposite position the wall, which is farther
        // than any ball.
        let front = (direction * 1.2).length() - 0.15;
        let grey = f32::from(image.get_pixel(pixel(cell)[0], pixel(cell)[1]).0[0]) / 255.0;
        // One pixel from the ball's middle the surface is a little farther away: by at most a fifth
        // of the radius.
        let distance = grey * RANGE;
        assert!(
            (distance - front).abs() < 0.03 + RANGE / 255.0,
            "{direction}: {distance}, {front}"
        );
        let middle = cell.map(|place| place.floor() + 0.5);
        let opposite = [0, 1].map(|axis| 2.0 * middle[axis] - cell[axis]);
        let [x, y] = pixel(opposite);
        let grey = f32::from(image.get_pixel(x, y).0[0]) / 255.0;
        assert!(grey * RANGE > 1.95, "{direction}: {}", grey * RANGE);
    }
    // Outside the cross the image is grey.
    for cell in [[0.5, 0.5], [2.5, 0.5], [3.5, 2.5]] {
        let [x, y] = pixel(cell);
        assert!([127, 128].contains(&image.get_pixel(x, y).0[0]));
    }
}

/// A light without an end of its range shows distances as shares of the distance up to which
/// receivers are seen: the farthest corner of the floor's box here, rounded up by at most a
/// quantized size step of 1.19.
#[test]
fn an_endless_light_shows_distances() {
    let gpu = gpu();
    let light = SpotLight {
        position_world: DVec3::Y * 3.0,
        direction: Vec3::NEG_Y,
        outer_angle_radians: 0.7,
        range: f32::INFINITY,
    };
    let receivers = Aabb::new(Vec3::new(-9.0, -3.0, -9.0), Vec3::new(9.0, 0.0, 9.0));
    let shadow = spot_over_floor(gpu, light, receivers);
    let image = picture(gpu, shadow.maps(), DebugImage::Layer(0), [MAP; 2]).expect("a layer");
    // The cone's square meets the box's lower side in corners at 6 (tan 0.7, 1, tan 0.7).
    let farthest = 6.0 * (2.0 * 0.7_f64.tan().powi(2) + 1.0).sqrt();
    let grey = f64::from(image.get_pixel(MAP / 2, MAP / 2).0[0]) / 255.0;
    let wanted = 3.0 / (farthest * 1.2)..3.0 / farthest + 1.0 / 255.0;
    assert!(wanted.contains(&grey), "{grey}, {wanted:?}");
}

/// A pool shows each of its lights as that light alone is shown.
#[test]
fn a_pool_shows_one_of_its_lights() {
    let gpu = gpu();
    let alone = lamp(gpu);
    let wanted = picture(gpu, alone.maps(), DebugImage::Cross, CROSS).expect("a cube");
    let descriptor = PoolDescriptor {
        capacity: 3,
        map_size: 1024,
        ..Default::default()
    };
    let mut pool = OmniShadowPool::new(&gpu.device, &descriptor).expect("a valid pool");
    pool.insert().expect("a free slot");
    let slot = pool.insert().expect("a free slot");
    let lights = [PoolLight {
        slot,
        light: LAMP,
        importance: 1.0,
    }];
    let room = room(gpu);
    let frame = PoolFrame {
        origin: DVec3::ZERO,
        lights: &lights,
        camera: None,
        casters: &room.list(),
        receivers: &BEYOND,
        max_views: None,
    };
    submitted(gpu, |encoder| pool.record_frame(encoder, &frame)).expect("a valid frame");
    let draw = |what| picture(gpu, pool.maps(), what, CROSS);
    assert!(draw(DebugImage::PoolCross(1)).expect("a light") == wanted);
    // All cells of a slot without a light are white.
    let empty = draw(DebugImage::PoolCross(0)).expect("a slot");
    assert!(
        CELLS
            .map(pixel)
            .iter()
            .all(|[x, y]| empty.get_pixel(*x, *y).0 == [255; 4])
    );
    for index in [3, 4, u32::MAX] {
        let refused = draw(DebugImage::PoolCross(index)).expect_err("no such slot");
        assert!(matches!(refused, DebugViewError::Layer { layers: 18, .. }));
    }
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let gpu = gpu();
    let (shadow, _) = sun();
    let draw = |what| picture(gpu, shadow.maps(), what, [8; 2]);
    for layer in [2, 3, u32::MAX] {
        let refused = draw(DebugImage::Layer(layer));
        assert_eq!(
            refused.err(),
            Some(DebugViewError::Layer { layer, layers: 2 })
        );
    }
    let not_a_cube = DebugViewError::NotACube { layers: 2 };
    assert_eq!(draw(DebugImage::Cross).err(), Some(not_a_cube.clone()));
    assert_eq!(draw(DebugImage::PoolCross(0)).err(), Some(not_a_cube));
    use wgpu::TextureFormat::{
        Bc1RgbaUnorm, Depth32Float, R32Uint, Rgba8Sint, Rgba8Snorm, Stencil8,
    };
    for format in [
        Depth32Float,
        Stencil8,
        R32Uint,
        Rgba8Sint,
        Rgba8Snorm,
        Bc1RgbaUnorm,
    ] {
        let refused = DebugView::new(&gpu.device, format).map(|_| ());
        assert_eq!(refused, Err(DebugViewError::Format { format }));
    }
}
