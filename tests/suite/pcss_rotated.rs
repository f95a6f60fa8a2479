//! Tests `Filter::PcssRotated`: it is as wide and as accurate as the fixed pattern, with noise that
//! is fixed in the world.

use glam::{DVec3, Vec2};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use wgpu_shadows::{
    Bias, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor, Filter,
    reference,
};

use super::penumbra::sun_profile;
use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::probe::record;
use crate::fixtures::scene::Scene;
use crate::fixtures::view_member::member;

/// Widths are within 10 % of the closed form and the rmse is at most 0.05, as for the fixed
/// pattern.
#[test]
fn turned_penumbrae_are_as_wide_as_the_light_makes_them() {
    for (height, diameter, map_size) in [(1.0, 0.2, 512), (3.0, 0.2, 512), (1.0, 0.5, 700)] {
        let filter = Filter::PcssRotated {
            light_size: diameter,
        };
        let (profile, texels) = sun_profile(gpu(), height, filter, map_size, 0.4);
        profile.assert_true(&format!("turned, {texels:.1} texels"));
    }
}

/// While the light-space bounds move under a walking camera and keep their texels, a position of
/// the world keeps its cell of the grid, which rotates its patterns. Positions at the border of two
/// cells are omitted.
#[test]
fn the_grain_is_fixed_in_the_world() {
    let gpu = gpu();
    let filter = Filter::PcssRotated { light_size: 0.05 };
    let mut shadow = DirectionalShadow::new(
        &gpu.device,
        &DirectionalShadowDescriptor {
            map_size: 512,
            filter,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        },
    )
    .expect("a valid sun");
    let mut meshes = vec![Mesh::floor(0.0, 60.0)];
    for step in 0..40 {
        let low = DVec3::new(f64::from(step * 7 % 40) - 20.0, 0.0, f64::from(step) - 20.0);
        meshes.push(Mesh::cuboid(low.as_vec3(), (low + 1.0).as_vec3()));
    }
    let scene = Scene::new(gpu, &meshes);
    let place = DVec3::new(0.37, 0.0, -0.61);
    let mut cells: Vec<(Vec2, [i64; 2])> = Vec::new();
    let mut windows = Vec::new();
    for step in 0..160 {
        let eye = DVec3::new(0.05 * f64::from(step) - 4.0, 4.0, 6.0);
        let camera = Camera::modern(eye, eye + DVec3::new(0.0, -0.7, -1.0), 0.9, 1.5);
        let frame = DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2).as_vec3()),
            coverage: Coverage::Camera(camera.view().with_max_distance(12.0)),
            casters: &scene.list(),
            receivers: &[],
        };
        if step % 10 == 0 {
            shadow.reset_history();
        }
        let report = record(gpu, &mut shadow, &frame);
        let view = &shadow.maps().view_uniforms()[0];
        let at = reference::receiver(view, filter, Bias::Auto, place, DVec3::Y);
        let part = at.texel.fract();
        let at_border = part.min_element() < 0.02 || part.max_element() > 0.98;
        if !reference::holds(view, place) || at_border {
            continue;
        }
        let grid: u32 = member(view, "grid");
        let first = [grid & 0xffff, grid >> 16].map(i64::from);
        let texel = at.texel.floor().as_i64vec2();
        let cell = [first[0] + texel.x, first[1] + texel.y].map(|c| c.rem_euclid(65_536));
        cells.push((report.views[0].texel_size_world, cell));
        windows.push(grid);
    }
    windows.dedup();
    assert!(windows.len() > 5, "{} windows", windows.len());
    let mut kept = 0;
    for pair in cells.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        assert_eq!(pair[0].1, pair[1].1);
        kept += 1;
    }
    assert!(kept > 40, "{kept}");
}
