//! Tests what `ShadowBindings`, `shader::compose` and `DebugView` refuse: each error is provoked,
//! compared as a value, and read as a message.

use shadow_support::readback;
use wgpu_shadows::{
    CascadeLayout, DirectionalShadow, DirectionalShadowDescriptor, ShadowBindings,
    ShadowBindingsDescriptor, debug::DebugImage, debug::DebugView, error::BindingsError,
    error::DebugViewError, shader,
};

use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::picture::{color_pass, color_target};
use crate::fixtures::wgsl;

fn tiny_sun(gpu: &Gpu, cascades: u32) -> DirectionalShadow {
    let descriptor = DirectionalShadowDescriptor {
        map_size: 1,
        layout: CascadeLayout::fixed(cascades),
        ..Default::default()
    };
    DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun")
}

/// An engine's names become WGSL identifiers, so they must be valid identifiers and must differ
/// from the library's own.
#[test]
fn light_names_that_are_no_identifiers() {
    let gpu = gpu();
    let sun = tiny_sun(gpu, 1);
    let bind = |names: &[&str]| {
        let lights: Vec<_> = names.iter().map(|name| (*name, sun.maps())).collect();
        let descriptor = ShadowBindingsDescriptor {
            lights: &lights,
            ..Default::default()
        };
        ShadowBindings::new(&gpu.device, &descriptor).map(|_| ())
    };
    let names = [
        "",
        "Sun",
        "sun1",
        "1sun",
        "sun_",
        "_sun",
        "the__sun",
        "the sun",
        "sun-light",
        "sön",
        // These are names of functions that the library has already.
        "receiver",
        "geometric_normal",
        "gather",
        "kernel",
        "filter_nearest",
        // This is a function of a view, whose name begins as `shadow_view_NAME` does.
        "holds",
        // These are names of functions and variables of a light called `sun`.
        "view_sun",
        "views_sun",
        "map_sun",
        "place_of_sun",
        "axes_of_sun",
        "cascade_of_sun",
    ];
    for name in names {
        let error = bind(&[name]).expect_err(name);
        let name = name.to_owned();
        assert_eq!(error, BindingsError::Name { name: name.clone() });
        let text = error.to_string();
        assert!(
            text.starts_with("ShadowBindingsDescriptor::lights: name must be"),
            "{text}"
        );
        assert!(text.ends_with(&format!("got {name:?}")), "{text}");
    }
    for name in ["sun", "s", "sun_2_high", "s9n", "directional", "local"] {
        assert_eq!(bind(&[name]), Ok(()), "{name}");
    }
    let error = bind(&["sun", "moon", "sun"]).expect_err("twice");
    let name = "sun".to_owned();
    assert_eq!(error, BindingsError::DuplicateName { name });
    assert_eq!(
        error.to_string(),
        "ShadowBindingsDescriptor::lights: names must differ, got \"sun\" twice"
    );
}

/// Names that would coincide with the library's own variables or with those of another light are
/// refused or spelled differently: what is emitted compiles.
#[test]
fn light_names_that_meet_others() {
    let gpu = gpu();
    let sun = tiny_sun(gpu, 1);
    let sets: [&[&str]; 8] = [
        &["point_sampler"],
        &["comparison_sampler"],
        &["sun", "views_sun"],
        &["sun", "map_sun"],
        &["sun", "view_sun"],
        &["view_sun", "sun"],
        &["views_sun", "sun"],
        &["map_sun", "views_map_sun", "map_views_sun"],
    ];
    let mut failures = Vec::new();
    for names in sets {
        let lights: Vec<_> = names.iter().map(|name| (*name, sun.maps())).collect();
        let descriptor = ShadowBindingsDescriptor {
            lights: &lights,
            ..Default::default()
        };
        let result = ShadowBindings::new(&gpu.device, &descriptor);
        if let Ok(bindings) = result {
            if let Err(error) = wgsl::validate(bindings.wgsl()) {
                failures.push(format!("{names:?}: {error}"));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn bindings_beyond_the_devices_limits() {
    let gpu = gpu();
    let limits = gpu.device.limits();
    let sun = tiny_sun(gpu, 1);
    let bind = |group, lights: &[_]| {
        let descriptor = ShadowBindingsDescriptor {
            group,
            lights,
            ..Default::default()
        };
        ShadowBindings::new(&gpu.device, &descriptor).map(|_| ())
    };
    let (group, maximum) = (limits.max_bind_groups, limits.max_bind_groups);
    let error = bind(group, &[("sun", sun.maps())]).expect_err("a group");
    assert_eq!(error, BindingsError::Group { group, maximum });
    let message = "ShadowBindingsDescriptor::group must be below the device's max_bind_groups = ";
    assert_eq!(
        error.to_string(),
        format!("{message}{maximum}, got {group}")
    );

    // A stage has the fewest bindings for uniform buffers: as many lights are accepted, and one
    // more is refused.
    let most = limits.max_uniform_buffers_per_shader_stage as usize;
    let letter = |index: usize| char::from(b'a' + (index % 26) as u8);
    let names: Vec<_> = (0..=most)
        .map(|index| format!("{}{}", letter(index / 26), letter(index)))
        .collect();
    let lights: Vec<_> = names
        .iter()
        .map(|name| (name.as_str(), sun.maps()))
        .collect();
    assert_eq!(bind(1, &lights[..most]), Ok(()));
    let (needed, maximum) = (most as u64 + 1, most as u64);
    let error = bind(1, &lights).expect_err("too many");
    let limit = "max_uniform_buffers_per_shader_stage";
    assert_eq!(
        error,
        BindingsError::OverDeviceLimit {
            limit,
            needed,
            maximum
        }
    );
    assert_eq!(
        error.to_string(),
        format!(
            "ShadowBindingsDescriptor::lights: the device's {limit} must be at least {needed}, and it is {maximum}"
        )
    );
}

#[test]
fn modules_that_do_not_exist() {
    let error = shader::compose(&["view", "no_such"]).expect_err("no module");
    let name = "no_such".to_owned();
    assert_eq!(error, BindingsError::UnknownModule { name });
    assert_eq!(
        error.to_string(),
        "shader::compose: every name must be that of a module in shader::MODULES, got \"no_such\""
    );
}

#[test]
fn debug_views_that_cannot_be_drawn() {
    use wgpu::TextureFormat as F;
    let gpu = gpu();
    for format in [F::Depth32Float, F::Rgba8Uint, F::Bc1RgbaUnorm, F::R32Sint] {
        let error = DebugView::new(&gpu.device, format).expect_err("a format");
        assert_eq!(error, DebugViewError::Format { format });
        let message = "DebugView: the target must be a renderable float colour format, got ";
        assert_eq!(error.to_string(), format!("{message}{format:?}"));
    }
    let view = DebugView::new(&gpu.device, F::Rgba8Unorm).expect("a renderable format");
    let sun = tiny_sun(gpu, 2);
    let target = color_target(gpu, 4);
    let mut encoder = gpu.encoder();
    {
        let mut pass = color_pass(&mut encoder, &target);
        let mut draw = |picture| view.draw(&mut pass, sun.maps(), picture);
        let error = draw(DebugImage::Layer(2)).expect_err("no layer");
        assert_eq!(
            error,
            DebugViewError::Layer {
                layer: 2,
                layers: 2
            }
        );
        let message = "DebugView: layer must be below the map's 2 layers, got 2";
        assert_eq!(error.to_string(), message);
        let error = draw(DebugImage::Cross).expect_err("no cube");
        assert_eq!(error, DebugViewError::NotACube { layers: 2 });
        assert_eq!(
            error.to_string(),
            "DebugView: a cross needs the six faces of a point light, got a light with 2 layers"
        );
    }
    gpu.submit(encoder);
    // Nothing was drawn: the target still has the colour it was cleared to.
    let pixels = readback::rgba8(gpu, &target);
    assert!(pixels.pixels().all(|pixel| pixel.0 == [0, 0, 0, 255]));
}

#[test]
fn modules_that_do_not_go_together() {
    let names = ["texels_by_samples", "texels_by_offsets", "filter_tent3"];
    let error = shader::compose(&names).expect_err("gathers where there are none");
    let conflict = BindingsError::ConflictingModules {
        name: "texels_by_offsets",
        other: "texels_by_samples",
    };
    assert_eq!(error, conflict);
    assert_eq!(
        error.to_string(),
        "shader::compose: names must be of modules that go together, got \"texels_by_offsets\" and \"texels_by_samples\""
    );
}
