//! Lists the faults, each with what is wrong and what is right.

use glam::{DVec3, Vec3};
use wgpu_shadows::{Bias, CascadeLayout, DirectionalShadowDescriptor};

use crate::painter::Setup;
use crate::props;

/// Is a fault.
pub struct Fault {
    /// Is the name of its image.
    pub name: &'static str,
    pub wrong: Setup,
    pub right: Setup,
}

/// Is where the scene lies that is far from the origin, in metres.
const FAR: DVec3 = DVec3::new(400_000.0, 0.0, 400_000.0);

/// Returns all faults.
pub fn all() -> Vec<Fault> {
    let cubes = || Setup::of(props::cubes());
    let avenue = || Setup {
        eye: Vec3::new(10.5, 3.0, 5.0),
        target: Vec3::new(0.0, -0.9, 0.9),
        ..Setup::of(props::avenue())
    };
    let fence = || Setup {
        eye: Vec3::new(3.6, 1.3, -1.6),
        target: Vec3::new(1.0, -0.2, 1.2),
        ..Setup::of(props::fence())
    };
    let sheets = || Setup {
        eye: Vec3::new(6.2, 3.4, 4.4),
        target: Vec3::new(1.2, -0.2, 1.2),
        ..Setup::of(props::sheets())
    };
    let with_shadow = |shadow, setup| Setup { shadow, ..setup };
    let manual = |constant, slope| DirectionalShadowDescriptor {
        map_size: 512,
        layout: CascadeLayout::fixed(1),
        bias: Bias::Manual { constant, slope },
        ..Default::default()
    };
    let coarse = |map_size| DirectionalShadowDescriptor {
        map_size,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let fault = |name, wrong, right| Fault { name, wrong, right };
    vec![
        fault(
            "normal",
            Setup {
                visibility: "shadow_sun(surface.position, -normal)",
                ..cubes()
            },
            cubes(),
        ),
        fault(
            "smooth-normal",
            Setup {
                visibility: "shadow_sun(surface.position, normalize(surface.normal))",
                ..Setup::of(props::balls())
            },
            Setup::of(props::balls()),
        ),
        fault(
            "other-position",
            Setup {
                visibility: "shadow_sun(surface.position - 0.01 * normal * sin(30.0 * surface.position.x), normal)",
                ..cubes()
            },
            cubes(),
        ),
        fault("acne", with_shadow(manual(0.0, 0.0), cubes()), cubes()),
        fault(
            "far",
            Setup {
                place_world: FAR,
                ..cubes()
            },
            Setup {
                place_world: FAR,
                origin: FAR,
                ..cubes()
            },
        ),
        fault(
            "reversed",
            Setup {
                direction: -cubes().direction,
                ..cubes()
            },
            cubes(),
        ),
        fault(
            "dome",
            Setup::of(props::under_a_dome()),
            Setup::of(props::out_of_view(props::under_a_dome(), 4, false)),
        ),
        fault(
            "peter-panning",
            with_shadow(manual(0.3, 0.0), fence()),
            fence(),
        ),
        fault("thin", with_shadow(coarse(48), fence()), fence()),
        fault(
            "sheets",
            Setup {
                cull: Some(wgpu::Face::Back),
                ..sheets()
            },
            sheets(),
        ),
        fault(
            "end",
            Setup {
                max_distance: 10.5,
                ..avenue()
            },
            avenue(),
        ),
        fault(
            "vanished",
            Setup::of(props::out_of_view(props::cubes(), 1, false)),
            Setup::of(props::out_of_view(props::cubes(), 1, true)),
        ),
        fault(
            "late",
            Setup::of(props::a_frame_later(props::cubes())),
            cubes(),
        ),
        fault("coarse", with_shadow(coarse(32), cubes()), cubes()),
    ]
}
