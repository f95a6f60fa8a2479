//! Provides random scenes under random suns before random cameras, and the truth about their floors.

use glam::{DVec2, DVec3, Vec3};
use proptest::prelude::*;
use wgpu_shadows::{
    Aabb, CameraView, CascadeSplit, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, report::ShadowReport,
};

use crate::support::camera::{Camera, Lens, Pose};
use crate::support::frames::{Coverage, DirectionalFrame};
use crate::support::gpu::Gpu;
use crate::support::probe::record;
use crate::support::random::Random;
use crate::support::scene::{Mesh, Scene};

/// Is half the width of the floor, which lies at height 0.
pub const FLOOR_HALF: f64 = 32.0;

/// Describes boxes on and above a level floor. Coordinates are whole 64ths, so that shifts and scales by powers of two
/// are exact.
#[derive(Clone, Debug)]
pub struct World {
    pub boxes: Vec<(DVec3, DVec3)>,
    pub light: DVec3,
    pub camera: Camera,
    pub max_distance: f64,
    pub cascades: u32,
    pub split: CascadeSplit<'static>,
    /// States that the floor casts as well as receives; otherwise it only receives.
    pub floor_casts: bool,
}

fn whole(value: f64) -> f64 {
    (value * 64.0).round() / 64.0
}

fn boxes() -> impl Strategy<Value = Vec<(DVec3, DVec3)>> {
    let one = (
        (-20.0..20.0, -20.0..20.0),
        (0.5..7.0, 0.3..6.0, 0.5..7.0),
        // Boxes are on the floor, a little above it, or high up.
        prop_oneof![Just(0.0), 0.1..6.0, 6.0..60.0],
    );
    let corners = one.prop_map(|((x, z), (width, height, depth), base)| {
        let low = DVec3::new(whole(x), whole(base), whole(z));
        (
            low,
            low + DVec3::new(whole(width), whole(height), whole(depth)),
        )
    });
    prop::collection::vec(corners, 1..8)
}

fn camera() -> impl Strategy<Value = Camera> {
    let pose = (
        (-30.0..30.0, 1.0..25.0, -30.0..30.0),
        (-15.0..15.0, -15.0..15.0),
    )
        .prop_map(|((x, y, z), (target_x, target_z))| {
            let eye = DVec3::new(whole(x), whole(y), whole(z));
            // The camera looks slightly off the vertical, along which its orientation would be undefined.
            Pose::looking_at(eye, DVec3::new(target_x + 0.03, 0.0, target_z + 0.02))
        });
    let size = || 0.15..1.2_f64;
    let sides = (size(), size(), size(), size(), prop::bool::ANY).prop_map(
        |(left, right, bottom, top, symmetric)| {
            if symmetric {
                [-right, right, -top, top]
            } else {
                [-left, right, -bottom, top]
            }
        },
    );
    let far = prop_oneof![Just(f64::INFINITY), 20.0..200.0];
    let lens = (sides, 0.05..2.0_f64, far, 0..4).prop_map(|(sides, near, far, kind)| {
        if kind == 0 {
            let sides = sides.map(|side: f64| side * 20.0);
            let far = if far.is_finite() { far } else { 100.0 };
            Lens::Orthographic {
                sides,
                near: -near,
                far,
            }
        } else {
            Lens::Perspective { sides, near, far }
        }
    });
    (pose, lens, prop::bool::ANY).prop_map(|(pose, lens, reversed)| Camera {
        pose,
        lens,
        reversed,
    })
}

pub fn world() -> impl Strategy<Value = World> {
    let split = prop_oneof![
        Just(CascadeSplit::Logarithmic),
        Just(CascadeSplit::Uniform),
        Just(CascadeSplit::Practical { lambda: 0.6 }),
    ];
    // The light comes from 12 degrees above the horizon to the zenith, from all sides.
    let light = (0.2..1.57, 0.0..std::f64::consts::TAU).prop_map(|(height, side): (f64, f64)| {
        DVec3::new(
            height.cos() * side.cos(),
            -height.sin(),
            height.cos() * side.sin(),
        )
        .as_vec3()
        .as_dvec3()
    });
    let limit = prop_oneof![3 => Just(f64::INFINITY), 1 => 15.0..60.0];
    (
        boxes(),
        light,
        camera(),
        limit,
        1..=4u32,
        split,
        prop::bool::ANY,
    )
        .prop_map(
            |(boxes, light, camera, max_distance, cascades, split, floor_casts)| World {
                boxes,
                light,
                camera,
                max_distance,
                cascades,
                split,
                floor_casts,
            },
        )
}

/// Holds a world as an engine sees it whose render space begins at `origin` and counts in `1 / scale` of the world's
/// units.
pub struct Placed {
    pub shadow: DirectionalShadow,
    pub report: ShadowReport,
    pub scene: Scene,
    pub origin: DVec3,
    pub scale: f64,
}

impl Placed {
    pub fn render(&self, world: DVec3) -> DVec3 {
        (world - self.origin) * self.scale
    }
}

impl World {
    /// Builds and records the world. `coverage` is called with the render-space bounds of the whole scene.
    pub fn place(
        &self,
        gpu: &Gpu,
        map_size: u32,
        origin: DVec3,
        scale: f64,
        coverage: impl Fn(Aabb) -> Coverage,
    ) -> Placed {
        let render = |world: DVec3| ((world - origin) * scale).as_vec3();
        let corner = DVec3::new(-FLOOR_HALF, 0.0, -FLOOR_HALF);
        let side = (2.0 * FLOOR_HALF * scale) as f32;
        let floor = Mesh::sheet(render(corner), Vec3::Z * side, Vec3::X * side);
        let floor_bounds = floor.bounds();
        let cuboids = self
            .boxes
            .iter()
            .map(|(low, high)| Mesh::cuboid(render(*low), render(*high)));
        let meshes: Vec<_> = cuboids.chain(self.floor_casts.then_some(floor)).collect();
        let all = meshes
            .iter()
            .fold(floor_bounds, |all, mesh| all.union(mesh.bounds()));
        let scene = Scene::new(gpu, &meshes);
        let descriptor = DirectionalShadowDescriptor {
            map_size,
            cascades: self.cascades,
            split: self.split,
            ..Default::default()
        };
        let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
        let report = record(
            gpu,
            &mut shadow,
            &DirectionalFrame {
                origin: origin * scale,
                light: DirectionalLight::new(self.light.as_vec3()),
                coverage: coverage(all),
                casters: &scene.list(),
                receivers: &[floor_bounds],
            },
        );
        Placed {
            shadow,
            report,
            scene,
            origin,
            scale,
        }
    }

    /// Returns what the camera sees, in a render space that is the world times `scale`.
    pub fn camera_view(&self, scale: f64) -> CameraView {
        let mut camera = self.camera;
        camera.pose.eye *= scale;
        match &mut camera.lens {
            Lens::Perspective { near, far, .. } => {
                *near *= scale;
                *far *= scale;
            }
            Lens::Orthographic { sides, near, far } => {
                *sides = sides.map(|side| side * scale);
                *near *= scale;
                *far *= scale;
            }
        }
        camera
            .view()
            .with_max_distance((self.max_distance * scale) as f32)
    }

    /// Returns positions of the floor that the camera sees within its distance limit: under a grid of `side` by `side`
    /// pixels, and as many again in and around the shadows of the boxes. What boxes hide counts as seen.
    pub fn visible_floor(&self, side: u32) -> Vec<DVec3> {
        let mut places = Vec::new();
        for pixel in 0..side * side {
            let share = |index: u32| (f64::from(index) + 0.5) / f64::from(side);
            let (start, direction) = self.camera.ray(share(pixel % side), share(pixel / side));
            places.push(start - direction * (start.y / direction.y));
        }
        places.extend(self.floor_around_shadows(side * side));
        places.retain(|place| {
            // The outermost border of the image is excluded, where f32 matrices decide what is visible.
            self.camera.sees(*place, self.max_distance, 0.001)
                && place.abs().max_element() < FLOOR_HALF * 0.999
        });
        for place in &mut places {
            place.y = 0.0;
        }
        places
    }

    /// Returns positions of the floor in and around the shadows of the boxes.
    pub fn floor_around_shadows(&self, count: u32) -> Vec<DVec3> {
        let mut random = Random::new(41);
        (0..count)
            .map(|_| {
                let (low, high) = self.boxes[random.index(self.boxes.len())];
                let grown = (high - low) * 0.2;
                let place = random.point(low - grown, high + grown);
                (place - self.light * (place.y / self.light.y)).with_y(0.0)
            })
            .collect()
    }

    /// Returns the truth for a position on the floor, if it is the same for `margin` texels all around as the light
    /// sees it.
    pub fn truth(&self, place: DVec3, texel: f64, margin: f64) -> Option<bool> {
        let (across, up) = self.light.any_orthonormal_pair();
        let on_map = |world: DVec3| DVec2::new(across.dot(world), up.dot(world)) / texel;
        let center = on_map(place);
        let mut lit = true;
        for (low, high) in &self.boxes {
            let corners = (0..8).map(|corner| {
                let pick = |axis: usize| {
                    if corner >> axis & 1 == 1 {
                        high[axis]
                    } else {
                        low[axis]
                    }
                };
                on_map(DVec3::new(pick(0), pick(1), pick(2)))
            });
            let outside = distance_outside(&hull(corners.collect()), center);
            // A box darkens a whole kernel only where it is higher than the kernel's own extent along the floor.
            let extent = self.light.with_y(0.0).length() * texel * margin * 1.5;
            if outside < -margin && high.y > extent {
                return Some(true);
            }
            lit &= outside > margin;
        }
        lit.then_some(false)
    }
}

/// Returns the convex hull, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut chain: Vec<DVec2> = Vec::new();
    for pass in 0..2 {
        let floor = chain.len() + 1;
        for &point in &points {
            while chain.len() > floor {
                let [.., a, b] = chain[..] else { break };
                if (b - a).perp_dot(point - b) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        if pass == 0 {
            points.reverse();
        }
    }
    chain
}

/// Returns how far a position lies outside a convex polygon: at most its distance outside, exactly minus its distance
/// inside.
fn distance_outside(hull: &[DVec2], place: DVec2) -> f64 {
    let next = hull.iter().cycle().skip(1);
    hull.iter()
        .zip(next)
        .map(|(a, b)| (place - *a).perp_dot((*b - *a).normalize()))
        .fold(f64::NEG_INFINITY, f64::max)
}
