//! Tests that the depths that a map contains of a plane are as near to the plane's own as the
//! uniforms state: the errors that the bias allows for are those that the device makes.

use glam::{DVec2, DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use shadow_support::readback;
use wgpu_shadows::{
    Aabb, CascadeLayout, DepthFormat, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::probe::record;
use crate::fixtures::scene::Scene;
use crate::fixtures::table;
use crate::fixtures::view_member::{member, texel_from_anchor};

const MAP_SIZE: u32 = 256;

/// Is a sheet near the origin at `tilt` degrees to the light, with coverage of everything that lies
/// `range` around it.
struct Sheet {
    scene: Scene,
    light: DVec3,
    cover: Aabb,
}

impl Sheet {
    fn new(tilt: f64, range: f64, random: &mut Random) -> Self {
        let normal = random.direction();
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        let side = u.rotate_axis(normal, random.range(0.0, 6.2));
        let toward_light = normal * tilt.to_radians().cos() + side * tilt.to_radians().sin();
        // The sheet fills much of the map, at a position that is not a round number.
        let half = range * 0.5;
        let center = random.direction() * (range * 0.11);
        let corner = center - (u + v) * half;
        let sheet = Mesh::sheet(
            corner.as_vec3(),
            (u * 2.0 * half).as_vec3(),
            (v * 2.0 * half).as_vec3(),
        );
        let around = Vec3::splat(range as f32);
        Self {
            scene: Scene::new(gpu(), &[sheet]),
            light: -toward_light,
            cover: Aabb::new(-around, around),
        }
    }

    /// Returns the largest difference of a stored depth from the plane's, as a fraction of what the
    /// uniforms allow for it.
    fn worst(&self, shadow: &mut DirectionalShadow) -> (f64, usize) {
        let gpu = gpu();
        let frame = DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(self.light.as_vec3()),
            coverage: Coverage::Bounds(self.cover),
            casters: &self.scene.list(),
            receivers: &[],
        };
        record(gpu, shadow, &frame);
        let view = shadow.maps().view_uniforms()[0];
        let texel_from_anchor = texel_from_anchor(&view);
        let anchor = Vec3::from_array(member(&view, "anchor")).as_dvec3();
        let corners = self.scene.triangles[0].0;
        let [a, b, c] = corners.map(|at| texel_from_anchor.transform_point3(at - anchor));
        let normal = (b - a).cross(c - a);
        let gradient = DVec2::new(-normal.x / normal.z, -normal.y / normal.z);
        let steep = gradient.abs().element_sum();
        let error = |name| f64::from(member::<f32>(&view, name));
        let allowed = error("depth_error") + error("lateral_error") * steep;
        let depths = readback::depth_layer(gpu, shadow.maps().texture(), 0);
        let (mut worst, mut count) = (0.0_f64, 0);
        for (index, stored) in (0_u32..).zip(depths).filter(|(_, stored)| *stored > 0.0) {
            let texel = DVec2::new(f64::from(index % MAP_SIZE), f64::from(index / MAP_SIZE)) + 0.5;
            let plane = a.z + gradient.dot(texel - a.truncate());
            worst = worst.max((f64::from(stored) - plane).abs() / allowed);
            count += 1;
        }
        (worst, count)
    }
}

/// In ndc a depth errs by 6u of the range, by one step of a 16-bit format, and by the plane's slope
/// over the rounding of texel coordinates and the snapping of vertices. No texel of any sheet errs
/// by more, and some err by a tenth of that at least, so that the bound is needed.
#[test]
fn stored_depths_err_by_no_more_than_the_uniforms_say() {
    let mut words = Vec::new();
    for depth_format in [DepthFormat::Float32, DepthFormat::Unorm16] {
        let descriptor = DirectionalShadowDescriptor {
            map_size: MAP_SIZE,
            depth_format,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        };
        let mut shadow = DirectionalShadow::new(&gpu().device, &descriptor).expect("a valid sun");
        let mut random = Random::new(127);
        let (mut worst, mut texels) = (0.0_f64, 0);
        for tilt in [0.0, 0.0, 0.0, 20.0, 50.0, 75.0, 85.0, 89.0] {
            for range in [1.0, 10.0, 1e3, 1e5] {
                let sheet = Sheet::new(tilt, range, &mut random);
                let (error, count) = sheet.worst(&mut shadow);
                assert!(
                    error <= 1.0,
                    "{depth_format:?} tilt {tilt} range {range} on {}: {error} of what is allowed",
                    gpu().describe()
                );
                worst = worst.max(error);
                texels += count;
            }
        }
        assert!(worst > 0.1 && texels > 10_000, "{worst} in {texels} texels");
        words.push(format!("{worst:.2} of that in {depth_format:?}"));
    }
    table::record(
        "stored depths of planes at 0 to 89 degrees to the light, depth ranges of 1 to 1e5",
        "within 6u of the range, a step of 16 bits, and the slope over the rounding of a texel",
        words.join(", "),
    );
}
