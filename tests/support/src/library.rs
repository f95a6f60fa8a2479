//! Implements the library as a technique.

use std::error::Error;

use wgpu_shadows::{
    Bias, CascadeLayout, Casters, Coverage, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, Filter, MeshCaster, OmniLight, OmniShadow, OmniShadowDescriptor,
    ShadowBindings, ShadowBindingsDescriptor, ShadowCaster, ShadowError, ShadowFrameDescriptor,
    ShadowScene, SpotLight, SpotShadow, SpotShadowDescriptor, report::ShadowReport,
};

use crate::gpu::Gpu;
use crate::lookup_cost;
use crate::mesh::render_space_pipeline;
use crate::scene::{Light, Scene};
use crate::technique::{Cost, Footprint, LIGHT_NAME, Lookup, Technique};

/// Holds the library's settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LibraryOptions {
    pub filter: Filter,
    pub bias: Bias,
    pub map_size: u32,
    /// States that maps cover what the camera sees; otherwise they cover the bounds of the scene.
    pub fits_camera: bool,
    /// Is the layout of a sun's cascades; other lights ignore it.
    pub layout: CascadeLayout<'static>,
}

/// Holds the meshes of a scene as casters.
pub struct SceneCasters {
    meshes: Vec<MeshCaster>,
}

impl SceneCasters {
    pub fn new(gpu: &Gpu, scene: &Scene) -> Self {
        let pipeline = render_space_pipeline(gpu);
        let meshes = scene.meshes.iter();
        let meshes = meshes.map(|mesh| mesh.caster(gpu, &pipeline, glam::Mat4::IDENTITY));
        Self {
            meshes: meshes.collect(),
        }
    }

    pub fn list(&self) -> Vec<&dyn ShadowCaster> {
        self.meshes
            .iter()
            .map(|mesh| mesh as &dyn ShadowCaster)
            .collect()
    }
}

enum Shadow {
    Sun(Box<DirectionalShadow>),
    Spot(Box<SpotShadow>),
    Point(Box<OmniShadow>),
}

/// Holds one light of the library, with its bindings.
pub struct LibraryTechnique<'a> {
    scene: &'a Scene,
    casters: Vec<&'a dyn ShadowCaster>,
    options: LibraryOptions,
    shadow_scene: ShadowScene,
    shadow: Shadow,
    bindings: ShadowBindings,
    report: ShadowReport,
}

impl<'a> LibraryTechnique<'a> {
    pub fn new(
        gpu: &Gpu,
        scene: &'a Scene,
        casters: &'a SceneCasters,
        options: LibraryOptions,
    ) -> Result<Self, Box<dyn Error>> {
        let shadow = create_shadow(&gpu.device, scene, &options)?;
        let source = match &shadow {
            Shadow::Sun(sun) => sun.maps(),
            Shadow::Spot(spot) => spot.maps(),
            Shadow::Point(point) => point.maps(),
        };
        let bindings = ShadowBindings::new(
            &gpu.device,
            &ShadowBindingsDescriptor {
                visibility: wgpu::ShaderStages::COMPUTE,
                lights: &[(LIGHT_NAME, source)],
                ..Default::default()
            },
        )?;
        Ok(Self {
            scene,
            casters: casters.list(),
            options,
            shadow_scene: ShadowScene::new(),
            shadow,
            bindings,
            report: ShadowReport::default(),
        })
    }
}

fn create_shadow(
    device: &wgpu::Device,
    scene: &Scene,
    options: &LibraryOptions,
) -> Result<Shadow, ShadowError> {
    let LibraryOptions {
        filter,
        bias,
        map_size,
        layout,
        ..
    } = *options;
    Ok(match scene.light {
        Light::Sun { .. } => {
            let descriptor = DirectionalShadowDescriptor {
                label: None,
                map_size,
                layout,
                filter,
                bias,
                ..DirectionalShadowDescriptor::default()
            };
            Shadow::Sun(Box::new(DirectionalShadow::new(device, &descriptor)?))
        }
        Light::Spot { .. } => {
            let descriptor = SpotShadowDescriptor {
                label: None,
                map_size,
                filter,
                bias,
                ..Default::default()
            };
            Shadow::Spot(Box::new(SpotShadow::new(device, &descriptor)?))
        }
        Light::Point { .. } => {
            let descriptor = OmniShadowDescriptor {
                label: None,
                map_size,
                filter,
                bias,
                ..Default::default()
            };
            Shadow::Point(Box::new(OmniShadow::new(device, &descriptor)?))
        }
    })
}

impl Technique for LibraryTechnique<'_> {
    fn record(&mut self, _: &Gpu, encoder: &mut wgpu::CommandEncoder) -> Result<(), ShadowError> {
        let scene = self.scene;
        let frame = self.shadow_scene.frame(&ShadowFrameDescriptor {
            origin: scene.origin,
            coverage: if self.options.fits_camera {
                Coverage::Cameras(std::slice::from_ref(&scene.camera))
            } else {
                Coverage::Bounds(scene.bounds())
            },
            casters: Casters::List(&self.casters),
            receivers: &[],
        })?;
        let report = match (&mut self.shadow, scene.light) {
            (Shadow::Sun(sun), Light::Sun { direction, .. }) => {
                sun.invalidate();
                sun.record(encoder, &frame, &DirectionalLight::new(direction))
            }
            (
                Shadow::Spot(spot),
                Light::Spot {
                    position_world,
                    direction,
                    outer_angle_radians,
                    range,
                    ..
                },
            ) => {
                spot.invalidate();
                let light = SpotLight {
                    position_world,
                    direction,
                    outer_angle_radians,
                    range,
                };
                spot.record(encoder, &frame, &light)
            }
            (
                Shadow::Point(point),
                Light::Point {
                    position_world,
                    range,
                    ..
                },
            ) => {
                point.invalidate();
                let light = OmniLight {
                    position_world,
                    range,
                };
                point.record(encoder, &frame, &light)
            }
            _ => unreachable!("the shadow is made for the scene's light"),
        };
        self.report = report?.clone();
        Ok(())
    }

    fn lookup(&self) -> Lookup<'_> {
        Lookup {
            wgsl: self.bindings.wgsl(),
            layout: self.bindings.layout(),
            bind_group: self.bindings.bind_group(),
        }
    }

    fn footprint(&self) -> Footprint {
        match &self.shadow {
            Shadow::Sun(sun) => Footprint::of_views(sun.maps().views()),
            Shadow::Spot(spot) => Footprint::of_views(spot.maps().views()),
            Shadow::Point(point) => Footprint::of_views(point.maps().views()),
        }
    }

    fn cost(&self) -> Cost {
        Cost {
            texels_allocated: self.report.bytes_held / 4,
            texels_cleared: self.report.texels(),
            draws: self.report.draws(),
            passes: self.report.passes,
            bytes: self.report.bytes_held,
            lookup_cycles: lookup_cost::library(
                &self.scene.light,
                self.options.layout,
                self.options.filter,
                self.options.bias,
            ),
            texels_touched: texels_touched(self.options.filter),
        }
    }

    fn band_texels(&self) -> f64 {
        self.options.filter.reach_texels() + 1.0
    }

    fn band_world(&self) -> f64 {
        // These are the corners of the cube of offsets, which grows up to twofold with the distance
        // from the camera.
        2.0 * 3f64.sqrt() * f64::from(self.options.filter.radius_world())
    }

    fn takes_world_positions(&self) -> bool {
        false
    }
}

/// Returns the number of texels from which the weights of one lookup are made.
fn texels_touched(filter: Filter) -> u32 {
    match filter {
        Filter::Nearest => 1,
        Filter::Hardware | Filter::Bilinear { .. } => 4,
        Filter::Box => 9,
        Filter::Tent3 { .. } => 16,
        Filter::Tent5 { .. } => 36,
        Filter::Tent7 { .. } => 64,
        // There are four texels per gather.
        Filter::Pcss { .. } | Filter::PcssRotated { .. } => 4 * filter.texture_instructions(),
        // There is one texel per sample.
        _ => filter.texture_instructions(),
    }
}
