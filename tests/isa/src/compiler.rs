//! Makes pipelines of shaders, and reads what the compiler says of their stages.

use std::ffi::{CStr, CString};

use ash::{khr, vk};
use shadow_backends::spirv;

use crate::{Figures, IsaError};

/// Compiles shaders for the chip that `RADV_FORCE_FAMILY` names.
pub struct Compiler {
    // The functions of the library are valid as long as it is loaded.
    _entry: ash::Entry,
    instance: ash::Instance,
    device: ash::Device,
    executables: khr::pipeline_executable_properties::Device,
    driver: String,
}

impl Compiler {
    /// Opens the device. The process must run under the variables of
    /// [`Driver::variables`](crate::Driver::variables).
    ///
    /// # Errors
    /// Returns an error where Vulkan or the device is missing.
    pub fn new() -> Result<Self, IsaError> {
        // SAFETY: all handles are used only while their parents exist, since `Compiler` owns them
        // and destroys them in order; all structures live until the calls that take them return.
        unsafe {
            let entry = ash::Entry::load()?;
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
            let instance = vk::InstanceCreateInfo::default().application_info(&application);
            let instance = entry.create_instance(&instance, None)?;
            let physical = instance.enumerate_physical_devices()?;
            let physical = *physical.first().ok_or(IsaError::NoDevice)?;
            let mut properties_1_2 = vk::PhysicalDeviceVulkan12Properties::default();
            let mut properties =
                vk::PhysicalDeviceProperties2::default().push_next(&mut properties_1_2);
            instance.get_physical_device_properties2(physical, &mut properties);
            let driver = text(&properties_1_2.driver_info);
            let queue = [vk::DeviceQueueCreateInfo::default()
                .queue_family_index(0)
                .queue_priorities(&[1.0])];
            let mut executable =
                vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
                    .pipeline_executable_info(true);
            let mut features_1_3 = vk::PhysicalDeviceVulkan13Features::default()
                .dynamic_rendering(true)
                .robust_image_access(true);
            let mut features_1_1 = vk::PhysicalDeviceVulkan11Features::default().multiview(true);
            let mut robustness = vk::PhysicalDeviceRobustness2FeaturesEXT::default()
                .robust_buffer_access2(true)
                .robust_image_access2(true);
            let features = vk::PhysicalDeviceFeatures::default().robust_buffer_access(true);
            let extensions = [
                khr::pipeline_executable_properties::NAME.as_ptr(),
                ash::ext::robustness2::NAME.as_ptr(),
            ];
            let device = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queue)
                .enabled_features(&features)
                .enabled_extension_names(&extensions)
                .push_next(&mut executable)
                .push_next(&mut features_1_3)
                .push_next(&mut features_1_1)
                .push_next(&mut robustness);
            let device = instance.create_device(physical, &device, None)?;
            let executables = khr::pipeline_executable_properties::Device::new(&instance, &device);
            Ok(Self {
                _entry: entry,
                instance,
                device,
                executables,
                driver,
            })
        }
    }

    /// Returns the version of the driver.
    pub fn driver(&self) -> &str {
        &self.driver
    }

    /// Compiles a pipeline of `wgsl`, and returns the figures of its last stage: the entry point
    /// `fragment`, or `vertex` in a pipeline without a fragment stage, which draws depth alone.
    /// Arguments of `vertex` by location are read as `vec4<f32>`. A vertex stage that has a view
    /// index draws six views at once.
    ///
    /// # Errors
    /// Returns an error for WGSL that is not valid, and where the driver fails.
    pub fn compile(
        &self,
        wgsl: &str,
        vertex: &str,
        fragment: Option<&str>,
    ) -> Result<Figures, IsaError> {
        let (module, words) = spirv::write(wgsl, spirv::Target::Robust13)?;
        // SAFETY: as in `new`.
        unsafe {
            let mut sets = Vec::new();
            for bindings in bindings(&module) {
                let set = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
                sets.push(self.device.create_descriptor_set_layout(&set, None)?);
            }
            let layout = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
            let layout = self.device.create_pipeline_layout(&layout, None)?;
            let shader = vk::ShaderModuleCreateInfo::default().code(&words);
            let shader = self.device.create_shader_module(&shader, None)?;
            let pipeline = self.pipeline(&module, shader, layout, vertex, fragment);
            let figures = pipeline.and_then(|pipeline| {
                let figures = self.figures(pipeline, fragment.is_some());
                self.device.destroy_pipeline(pipeline, None);
                figures
            });
            self.device.destroy_shader_module(shader, None);
            self.device.destroy_pipeline_layout(layout, None);
            for set in sets {
                self.device.destroy_descriptor_set_layout(set, None);
            }
            figures
        }
    }

    /// # Safety
    /// The handles must be those of this device.
    unsafe fn pipeline(
        &self,
        module: &naga::Module,
        shader: vk::ShaderModule,
        layout: vk::PipelineLayout,
        vertex: &str,
        fragment: Option<&str>,
    ) -> Result<vk::Pipeline, IsaError> {
        let has_fragment = fragment.is_some();
        let entry = module
            .entry_points
            .iter()
            .find(|entry| entry.name == vertex);
        let entry = entry.ok_or_else(|| IsaError::Entry(vertex.to_owned()))?;
        let names = [vertex, fragment.unwrap_or_default()].map(CString::new);
        let [vertex, fragment] = names.map(Result::unwrap_or_default);
        let stage = |stage, name| {
            vk::PipelineShaderStageCreateInfo::default()
                .stage(stage)
                .module(shader)
                .name(name)
        };
        let stages = [
            stage(vk::ShaderStageFlags::VERTEX, &*vertex),
            stage(vk::ShaderStageFlags::FRAGMENT, &*fragment),
        ];
        let stages = &stages[..1 + usize::from(has_fragment)];
        let attributes = attributes(entry);
        let buffers = [vk::VertexInputBindingDescription::default()
            .binding(0)
            .stride(256)];
        let vertex = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&buffers)
            .vertex_attribute_descriptions(&attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(!has_fragment)
            .depth_write_enable(!has_fragment)
            .depth_compare_op(vk::CompareOp::GREATER_OR_EQUAL);
        let write_all = [vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let colors = usize::from(has_fragment);
        let blend =
            vk::PipelineColorBlendStateCreateInfo::default().attachments(&write_all[..colors]);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let color_formats = [vk::Format::R8G8B8A8_UNORM];
        let depth_format = if has_fragment {
            vk::Format::UNDEFINED
        } else {
            vk::Format::D32_SFLOAT
        };
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&color_formats[..colors])
            .depth_attachment_format(depth_format)
            .view_mask(if has_view_index(entry) { 0b11_1111 } else { 0 });
        let info = vk::GraphicsPipelineCreateInfo::default()
            .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
            .stages(stages)
            .vertex_input_state(&vertex)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .push_next(&mut rendering);
        // SAFETY: the caller's.
        let made = unsafe {
            self.device
                .create_graphics_pipelines(vk::PipelineCache::null(), &[info], None)
        };
        let pipelines = made.map_err(|(_, error)| error)?;
        pipelines.first().copied().ok_or(IsaError::NoDevice)
    }

    /// # Safety
    /// The pipeline must be one of this device.
    unsafe fn figures(
        &self,
        pipeline: vk::Pipeline,
        has_fragment: bool,
    ) -> Result<Figures, IsaError> {
        let stage = if has_fragment {
            vk::ShaderStageFlags::FRAGMENT
        } else {
            vk::ShaderStageFlags::VERTEX
        };
        let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
        // SAFETY: the caller's.
        let executables = unsafe { self.executables.get_pipeline_executable_properties(&info)? };
        let index = executables
            .iter()
            .position(|found| found.stages.contains(stage));
        let info = vk::PipelineExecutableInfoKHR::default()
            .pipeline(pipeline)
            .executable_index(index.ok_or(IsaError::NoDevice)? as u32);
        // SAFETY: the caller's.
        let statistics = unsafe { self.executables.get_pipeline_executable_statistics(&info)? };
        let figure = |name| {
            let found = statistics.iter().find(|found| text(&found.name) == name);
            found
                .filter(|found| found.format == vk::PipelineExecutableStatisticFormatKHR::UINT64)
                // SAFETY: the format says which member of the union is valid.
                .map(|found| unsafe { found.value.u64 })
                .ok_or(IsaError::Figure(name))
        };
        Ok(Figures {
            vgprs: figure("VGPRs")?,
            waves: figure("Subgroups per SIMD")?,
            instructions: figure("Instructions")?,
            latency: figure("Latency")?,
            inverse_throughput: figure("Inverse Throughput")?,
        })
    }
}

impl Drop for Compiler {
    fn drop(&mut self) {
        // SAFETY: nothing that was made of the device or the instance is left.
        unsafe {
            self.device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}

/// Returns the bindings of each bind group that a module declares.
fn bindings(module: &naga::Module) -> Vec<Vec<vk::DescriptorSetLayoutBinding<'static>>> {
    let mut groups = vec![Vec::new(); 4];
    for (_, variable) in module.global_variables.iter() {
        let Some(binding) = &variable.binding else {
            continue;
        };
        let ty = match (&variable.space, &module.types[variable.ty].inner) {
            (naga::AddressSpace::Uniform, _) => vk::DescriptorType::UNIFORM_BUFFER,
            (naga::AddressSpace::Storage { .. }, _) => vk::DescriptorType::STORAGE_BUFFER,
            (_, naga::TypeInner::Sampler { .. }) => vk::DescriptorType::SAMPLER,
            _ => vk::DescriptorType::SAMPLED_IMAGE,
        };
        groups[binding.group as usize].push(
            vk::DescriptorSetLayoutBinding::default()
                .binding(binding.binding)
                .descriptor_type(ty)
                .descriptor_count(1)
                .stage_flags(vk::ShaderStageFlags::ALL_GRAPHICS),
        );
    }
    groups
}

/// Returns the vertex attributes of the arguments that have a location.
fn attributes(vertex: &naga::EntryPoint) -> Vec<vk::VertexInputAttributeDescription> {
    let arguments = vertex.function.arguments.iter();
    let locations = arguments.filter_map(|argument| match argument.binding {
        Some(naga::Binding::Location { location, .. }) => Some(location),
        _ => None,
    });
    locations
        .map(|location| {
            vk::VertexInputAttributeDescription::default()
                .location(location)
                .binding(0)
                .format(vk::Format::R32G32B32A32_SFLOAT)
                .offset(16 * location)
        })
        .collect()
}

/// Returns whether a vertex stage draws several views at once.
fn has_view_index(vertex: &naga::EntryPoint) -> bool {
    let view_index = Some(naga::Binding::BuiltIn(naga::BuiltIn::ViewIndex));
    let mut arguments = vertex.function.arguments.iter();
    arguments.any(|argument| argument.binding == view_index)
}

/// Returns the text of a C string in an array.
fn text(characters: &[std::ffi::c_char]) -> String {
    // SAFETY: Vulkan ends every string that it returns in an array with a zero.
    let text = unsafe { CStr::from_ptr(characters.as_ptr()) };
    text.to_string_lossy().into_owned()
}
