//! Tests what a sun refuses at construction: each error is provoked, compared as a value, and read
//! as a message that names field, rule and value.

use wgpu_shadows::{
    Bias, CascadeLayout, CascadeSplit, DirectionalShadow, DirectionalShadowDescriptor, Filter,
    ShadowError,
};

use crate::fixtures::gpu::{Gpu, gpu};

fn sun(gpu: &Gpu, descriptor: &DirectionalShadowDescriptor<'_>) -> Result<(), ShadowError> {
    DirectionalShadow::new(&gpu.device, descriptor).map(|_| ())
}

#[test]
fn descriptors_out_of_range() {
    let good = DirectionalShadowDescriptor {
        map_size: 16,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let sharpness = |sharpness| DirectionalShadowDescriptor {
        filter: Filter::Tent5 { sharpness },
        ..good
    };
    let bias = |constant, slope| DirectionalShadowDescriptor {
        bias: Bias::Manual { constant, slope },
        ..good
    };
    let split = |lambda| DirectionalShadowDescriptor {
        layout: CascadeLayout::Fixed {
            cascades: 1,
            split: CascadeSplit::Practical { lambda },
        },
        ..good
    };
    let cascades = |cascades| DirectionalShadowDescriptor {
        layout: CascadeLayout::fixed(cascades),
        ..good
    };
    let size = |map_size| DirectionalShadowDescriptor { map_size, ..good };
    let filter_rule = "a filter with a finite sharpness of at least 1";
    let bias_rule = "a bias with a finite constant and slope of at least 0";
    let cases = [
        (
            cascades(0),
            "layout",
            "a layout with a number of cascades in 1..=8",
            "0",
        ),
        (
            cascades(9),
            "layout",
            "a layout with a number of cascades in 1..=8",
            "9",
        ),
        (size(0), "map_size", "at least 1", "0"),
        (sharpness(0.5), "filter", filter_rule, "0.5"),
        (sharpness(f32::NAN), "filter", filter_rule, "NaN"),
        (sharpness(f32::INFINITY), "filter", filter_rule, "inf"),
        (
            bias(-0.25, 1.0),
            "bias",
            bias_rule,
            "constant -0.25, slope 1",
        ),
        (
            bias(0.0, f32::NAN),
            "bias",
            bias_rule,
            "constant 0, slope NaN",
        ),
        (
            split(1.5),
            "layout",
            "a split with a lambda in 0..=1",
            "1.5",
        ),
        (
            split(f32::NAN),
            "layout",
            "a split with a lambda in 0..=1",
            "NaN",
        ),
    ];
    assert_eq!(sun(gpu(), &good), Ok(()));
    for (descriptor, field, rule, value) in cases {
        let error = sun(gpu(), &descriptor).expect_err(field);
        let path = format!("DirectionalShadowDescriptor::{field}");
        assert_eq!(
            error.to_string(),
            format!("{path} must be {rule}, got {value}")
        );
        assert!(matches!(error, ShadowError::OutOfRange { field, .. } if field == path));
    }
}

#[test]
fn maps_larger_than_the_device_allows() {
    let maximum = gpu().device.limits().max_texture_dimension_2d;
    let descriptor = DirectionalShadowDescriptor {
        map_size: maximum + 1,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let error = sun(gpu(), &descriptor).expect_err("too large");
    let wanted = ShadowError::OverDeviceLimit {
        field: "DirectionalShadowDescriptor::map_size",
        limit: "max_texture_dimension_2d",
        maximum: maximum.into(),
        value: u64::from(maximum) + 1,
    };
    assert_eq!(error, wanted);
    assert_eq!(
        error.to_string(),
        format!(
            "DirectionalShadowDescriptor::map_size: the device's max_texture_dimension_2d must be at least {}, and it is {maximum}",
            maximum + 1
        )
    );
}
