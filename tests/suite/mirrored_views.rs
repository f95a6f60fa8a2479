//! Tests `shadow_geometric_normal` under cameras of either handedness: the normal is on the given
//! side, so that a scene seen in a mirror has no more acne than the scene itself.

use glam::{DMat4, DVec3, Mat4, Vec3};
use shadow_support::camera::{Camera, Lens};
use shadow_support::mesh::Mesh;
use shadow_support::triangle::occluded;
use wgpu_shadows::{
    Bias, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    ShadowBindings, ShadowBindingsDescriptor,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::probe::record;
use crate::fixtures::scene::Scene;
use crate::fixtures::triangles::{SIZE, VERTEX, draw};

const LIGHT: Vec3 = Vec3::new(-0.7, -1.0, 0.35);

/// Writes the visibility, and where something was drawn at all.
const VISIBILITY: &str = "
@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let toward_viewer = eye.place.xyz - eye.place.w * in.position;
    let normal = shadow_geometric_normal(in.position, toward_viewer);
    return vec4<f32>(shadow_sun(in.position, normal), 1.0, 0.0, 1.0);
}
";

/// Describes how the scene is looked at: the camera as the library knows it, and the transforms of
/// space before it and of clip space after it.
struct View {
    name: &'static str,
    camera: Camera,
    /// Reflects in a plane, or changes nothing.
    mirror: DMat4,
    /// Is 1, or -1 for a target whose y points down.
    clip_y: f64,
}

impl View {
    fn clip_from_render(&self) -> Mat4 {
        let flip = DMat4::from_scale(DVec3::new(1.0, self.clip_y, 1.0));
        let camera = self.camera.clip_from_view() * self.camera.view_from_render();
        (flip * camera * self.mirror).as_mat4()
    }

    /// Returns the ray of a pixel, in the space of the scene.
    fn ray(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let across = x / f64::from(SIZE);
        let down = y / f64::from(SIZE);
        let up = if self.clip_y > 0.0 { 1.0 - down } else { down };
        let (start, direction) = self.camera.ray(across, up);
        // A reflection is its own inverse.
        let start = self.mirror.transform_point3(start);
        (start, self.mirror.transform_vector3(direction))
    }

    /// Returns the contents of `Eye`.
    fn uniform(&self) -> Vec<f32> {
        let place = match self.camera.lens {
            Lens::Perspective { .. } => self
                .mirror
                .transform_point3(self.camera.pose.eye)
                .extend(1.0),
            Lens::Orthographic { .. } => self
                .mirror
                .transform_vector3(self.camera.pose.axes.z_axis)
                .extend(0.0),
        };
        let matrix = self.clip_from_render().to_cols_array();
        matrix
            .into_iter()
            .chain(place.as_vec4().to_array())
            .collect()
    }
}

fn views() -> Vec<View> {
    let eye = DVec3::new(1.5, 4.2, 6.0);
    let perspective = Camera::modern(eye, DVec3::new(-0.2, 0.4, 0.0), 0.8, 1.0);
    let perspective = Camera {
        reversed: false,
        ..perspective
    };
    let orthographic = Camera {
        lens: Lens::Orthographic {
            sides: [-3.0, 3.0, -3.0, 3.0],
            near: 0.1,
            far: 20.0,
        },
        ..perspective
    };
    // One mirror is on a wall at x = -0.5, and the other leans.
    let wall = reflection(DVec3::X, -0.5);
    let leaning = reflection(DVec3::new(0.8, 0.1, 0.59).normalize(), 0.2);
    let still = DMat4::IDENTITY;
    let view = |name, camera, mirror, clip_y| View {
        name,
        camera,
        mirror,
        clip_y,
    };
    vec![
        view("plain", perspective, still, 1.0),
        view("y downward", perspective, still, -1.0),
        view("wall mirror", perspective, wall, 1.0),
        view("leaning mirror", perspective, leaning, 1.0),
        view("wall mirror, y downward", perspective, wall, -1.0),
        view("orthographic", orthographic, still, 1.0),
        view("orthographic, y downward", orthographic, still, -1.0),
        view("orthographic, wall mirror", orthographic, wall, 1.0),
    ]
}

/// Returns the reflection in the plane of the points p with normal · p = distance.
fn reflection(normal: DVec3, distance: f64) -> DMat4 {
    let image = |axis: DVec3| axis - normal * (2.0 * normal.dot(axis));
    DMat4::from_cols(
        image(DVec3::X).extend(0.0),
        image(DVec3::Y).extend(0.0),
        image(DVec3::Z).extend(0.0),
        (normal * (2.0 * distance)).extend(1.0),
    )
}

/// Returns a floor, a block and a board that leans, all of flat faces.
fn meshes() -> [Mesh; 3] {
    [
        Mesh::floor(0.0, 6.0),
        Mesh::cuboid(Vec3::new(-1.0, 0.0, -1.3), Vec3::new(0.3, 1.3, 0.1)),
        Mesh::sheet(
            Vec3::new(1.0, 0.0, -0.4),
            Vec3::new(1.1, 0.0, 0.9),
            Vec3::new(0.2, 1.3, -0.5),
        ),
    ]
}

/// Holds the pixels whose truth is the same over the whole footprint of a lookup, by that truth:
/// dark or lit.
struct Settled {
    dark: Vec<[u32; 2]>,
    lit: Vec<[u32; 2]>,
}

/// Returns what rays find for each pixel of a view. `footprint` is the reach of a lookup across the
/// light, in world units.
fn settled(scene: &Scene, view: &View, footprint: f64) -> Settled {
    let toward_light = -LIGHT.as_dvec3().normalize();
    let side = toward_light.any_orthonormal_vector();
    let across = toward_light.cross(side);
    let triangles = &scene.triangles;
    // This finds the nearest surface along a pixel's ray: its plane, and the point on it.
    let seen = |x: f64, y: f64| {
        let (start, direction) = view.ray(x, y);
        triangles
            .iter()
            .filter_map(|triangle| Some((triangle.hit(start, direction)?, triangle)))
            .filter(|(t, _)| *t > 0.1)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(t, triangle)| {
                let normal = triangle.normal();
                let normal = normal * -normal.dot(direction).signum();
                (start + direction * t, normal)
            })
    };
    let mut settled = Settled {
        dark: Vec::new(),
        lit: Vec::new(),
    };
    for y in 0..SIZE {
        for x in 0..SIZE {
            let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let Some((place, normal)) = seen(px, py) else {
                continue;
            };
            // Where the image itself has an edge, rounding decides which surface a pixel shows.
            let same_plane = [(-0.1, 0.0), (0.1, 0.0), (0.0, -0.1), (0.0, 0.1)]
                .iter()
                .all(|(dx, dy)| {
                    seen(px + dx, py + dy).is_some_and(|(other, other_normal)| {
                        normal.dot(other_normal) > 0.999 && normal.dot(other - place).abs() < 1e-6
                    })
                });
            // On a face that turns away from the light, or nearly so, the footprint extends over
            // everything around it.
            if !same_plane || normal.dot(toward_light) < 0.15 {
                continue;
            }
            let dark_at = |place: DVec3| occluded(triangles, place, toward_light, 1e-6);
            let dark = dark_at(place);
            let around = (0..16).map(|step| {
                let angle = f64::from(step) * std::f64::consts::TAU / 8.0;
                let radius = footprint * if step < 8 { 1.0 } else { 0.4 };
                let aside = (side * angle.cos() + across * angle.sin()) * radius;
                place + aside - toward_light * (normal.dot(aside) / normal.dot(toward_light))
            });
            let mut around = around;
            if around.all(|place| dark_at(place) == dark) {
                let list = if dark {
                    &mut settled.dark
                } else {
                    &mut settled.lit
                };
                list.push([x, y]);
            }
        }
    }
    settled
}

#[test]
fn a_mirror_shows_no_acne() {
    let gpu = gpu();
    let scene = Scene::new(gpu, &meshes());
    let descriptor = DirectionalShadowDescriptor {
        map_size: 512,
        bias: Bias::Auto,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(LIGHT),
        // One map serves all views.
        coverage: Coverage::Bounds(wgpu_shadows::Aabb::new(
            Vec3::new(-6.0, 0.0, -6.0),
            Vec3::new(6.0, 1.5, 6.0),
        )),
        casters: &scene.list(),
        receivers: &[],
    };
    record(gpu, &mut shadow, &frame);
    let texel = shadow
        .maps()
        .views()
        .next()
        .expect("a view")
        .texel_size_world();
    // The footprint is the tent's reach, and a texel more for the offset and the caster's
    // rasterisation.
    let footprint = 3.0 * f64::from(texel.max_element()) * std::f64::consts::SQRT_2;
    let bindings = ShadowBindings::new(
        &gpu.device,
        &ShadowBindingsDescriptor {
            lights: &[("sun", shadow.maps())],
            ..Default::default()
        },
    )
    .expect("valid bindings");
    let source = format!("{}{VERTEX}{VISIBILITY}", bindings.wgsl());
    let vertices: Vec<Vec3> = meshes()
        .iter()
        .flat_map(|mesh| {
            mesh.indices
                .iter()
                .map(|index| mesh.positions[*index as usize])
        })
        .collect();
    let mut failures = Vec::new();
    for view in views() {
        let picture = draw(gpu, &source, &view.uniform(), &vertices, Some(&bindings));
        let truth = settled(&scene, &view, footprint);
        let (dark, lit) = (truth.dark.len(), truth.lit.len());
        assert!(
            dark > 100 && lit > 3000,
            "{}: {dark} dark, {lit} lit",
            view.name
        );
        let seen = |[x, y]: &[u32; 2]| picture.get_pixel(*x, *y).0;
        // Rays and the rasteriser see the same surfaces.
        assert!(truth.lit.iter().all(|pixel| seen(pixel)[1] == 255));
        let acne = truth
            .lit
            .iter()
            .filter(|pixel| seen(pixel)[0] < 255)
            .count();
        let leaks = truth.dark.iter().filter(|pixel| seen(pixel)[0] > 0).count();
        if (acne, leaks) != (0, 0) {
            failures.push(format!(
                "{}: {acne} of {lit} falsely dark, {leaks} of {dark} falsely lit",
                view.name
            ));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
