//! Asks the light's own lookup at the places of a frame, and reads the depths of their rays, in a
//! compute pass.

use crate::error::{BindingsError, DeviceError};
use crate::gpu::{DepthMap, Upload, capture_device_errors};
use crate::meter::places::PlaceUniform;
use crate::receive::{ErrorMeterPass, ShadowMaps};
use crate::{ShadowBindings, ShadowBindingsDescriptor, ShadowError, shader};

/// Is the name of the light in the meter's own WGSL.
const NAME: &str = "measured";

/// Is the size of a place's results: the visibility, and the depths of two rays.
pub(super) const RESULT_BYTES: u64 = size_of::<[f32; 4]>() as u64;

/// Is the number of places that a workgroup asks for.
pub(super) const WORKGROUP_SIZE: u32 = 64;

/// Is the path of what determines the bindings, for errors.
const MAPS_FIELD: &str = "ErrorMeterDescriptor::maps";

/// Holds the pipeline of the pass, and the buffers that it reads and writes.
#[derive(Debug)]
pub(super) struct Lookup {
    bindings: ShadowBindings,
    pipeline: wgpu::ComputePipeline,
    places: wgpu::Buffer,
    results: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl Lookup {
    /// Makes the pass for at most `places` places of `maps`, whose rays are drawn into `rays`.
    pub(super) fn new(
        maps: &ShadowMaps,
        label: &str,
        places: u32,
        rays: &DepthMap,
    ) -> Result<Self, ShadowError> {
        let device = maps.device();
        let bindings = ShadowBindings::new(
            device,
            &ShadowBindingsDescriptor {
                label: Some(label),
                group: 1,
                visibility: wgpu::ShaderStages::COMPUTE,
                lights: &[(NAME, maps)],
            },
        )
        .map_err(bindings_refused)?;
        let is_pool = maps.sampled().indexed;
        let pass = ErrorMeterPass {
            name: NAME,
            index: if is_pool { "place.slot" } else { "" },
        };
        let source = [bindings.wgsl(), shader::ERROR_METER.source, &pass.fill()].concat();
        let create = || {
            let layout = create_layout(device, label);
            let pipeline = create_pipeline(device, label, &[&layout, bindings.layout()], source);
            let buffer = |bytes, usage| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(label),
                    size: bytes,
                    usage: wgpu::BufferUsages::STORAGE | usage,
                    mapped_at_creation: false,
                })
            };
            let place_bytes = size_of::<PlaceUniform>() as u64 * u64::from(places);
            let result_bytes = RESULT_BYTES * u64::from(places);
            let places = buffer(place_bytes, wgpu::BufferUsages::COPY_DST);
            let results = buffer(result_bytes, wgpu::BufferUsages::COPY_SRC);
            let bind_group = create_bind_group(device, label, &layout, [&places, &results], rays);
            (pipeline, places, results, bind_group)
        };
        let (pipeline, places, results, bind_group) = capture_device_errors(device, create)
            .map_err(|refusal| {
                ShadowError::Device(DeviceError {
                    object: "the lookup of an error meter",
                    refusal,
                })
            })?;
        Ok(Self {
            bindings,
            pipeline,
            places,
            results,
            bind_group,
        })
    }

    /// Returns the upload of the places of a frame.
    pub(super) fn upload<'a>(&'a self, places: &'a [PlaceUniform]) -> Upload<'a> {
        (&self.places, bytemuck::cast_slice(places))
    }

    /// Returns the buffer that holds the results, one after the other.
    pub(super) fn results(&self) -> &wgpu::Buffer {
        &self.results
    }

    /// Records the pass for `count` places.
    pub(super) fn record(&self, encoder: &mut wgpu::CommandEncoder, label: &str, count: u32) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(label),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[]);
        pass.set_bind_group(1, self.bindings.bind_group(), &[]);
        pass.dispatch_workgroups(count.div_ceil(WORKGROUP_SIZE), 1, 1);
    }
}

/// Returns the error of the bindings as one of the meter. Its name and group are valid.
fn bindings_refused(error: BindingsError) -> ShadowError {
    match error {
        BindingsError::OverDeviceLimit {
            limit,
            needed,
            maximum,
        } => ShadowError::OverDeviceLimit {
            field: MAPS_FIELD,
            limit,
            maximum,
            value: needed,
        },
        BindingsError::Device(error) => ShadowError::Device(error),
        other => ShadowError::OutOfRange {
            field: MAPS_FIELD,
            rule: "maps that shaders of the device can sample",
            value: other.to_string(),
        },
    }
}

fn create_layout(device: &wgpu::Device, label: &str) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    };
    let storage = |read_only| wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let depths = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[
            entry(0, storage(true)),
            entry(1, storage(false)),
            entry(2, depths),
            entry(3, sampler),
        ],
    })
}

fn create_pipeline(
    device: &wgpu::Device,
    label: &str,
    groups: &[&wgpu::BindGroupLayout; 2],
    source: String,
) -> wgpu::ComputePipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups.map(Some),
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        module: &module,
        entry_point: Some("shadow_meter"),
        compilation_options: Default::default(),
        cache: None,
    })
}

fn create_bind_group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    [places, results]: [&wgpu::Buffer; 2],
    rays: &DepthMap,
) -> wgpu::BindGroup {
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some(label),
        ..Default::default()
    });
    let resources = [
        places.as_entire_binding(),
        results.as_entire_binding(),
        wgpu::BindingResource::TextureView(rays.array_view()),
        wgpu::BindingResource::Sampler(&sampler),
    ];
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}
