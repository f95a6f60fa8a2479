//! Draws the picture: both sides of the divider into one texture.

use example_support::camera::Camera;
use example_support::phong::{DEPTH_FORMAT, Lighting};
use shadow_support::gpu::Gpu;
use wgpu_shadows::{ShadowMaps, debug::DebugImage, debug::DebugView};

use crate::settings::Show;
use crate::side::{PICTURE_FORMAT, Side, Stroke};
use crate::stage::Stage;

/// Holds the texture of the picture, and the depths behind it.
pub struct Picture {
    pub size: [u32; 2],
    pub color: wgpu::Texture,
    depth: wgpu::TextureView,
    debug: DebugView,
}

/// Describes what is drawn.
pub struct Contents<'a> {
    pub stage: &'a Stage,
    /// Holds left and right with their cameras, which differ in the distance where shadows end.
    pub sides: [(&'a Side, &'a Camera); 2],
    pub lighting: &'a Lighting,
    pub show: Show,
    /// Is the number of columns that the left side has.
    pub left_columns: u32,
}

impl Picture {
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, String> {
        let texture = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("picture"),
                size: wgpu::Extent3d {
                    width: size[0],
                    height: size[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage
                    | wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        let depth = texture(DEPTH_FORMAT, wgpu::TextureUsages::empty());
        Ok(Self {
            size,
            color: texture(PICTURE_FORMAT, wgpu::TextureUsages::COPY_SRC),
            depth: depth.create_view(&Default::default()),
            debug: DebugView::new(&gpu.device, PICTURE_FORMAT)
                .map_err(|error| error.to_string())?,
        })
    }

    /// Draws the contents after the commands of `encoder`.
    pub fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        contents: &Contents<'_>,
    ) -> Result<(), String> {
        let target = self.color.create_view(&Default::default());
        let map = match contents.show {
            Show::SunMap(layer) => Some((0, DebugImage::Layer(layer))),
            Show::SpotMap(layer) => Some((1, DebugImage::Layer(layer))),
            Show::LampCross(lamp) => Some((2, DebugImage::PoolCross(lamp))),
            _ => None,
        };
        if let Some((light, image)) = map {
            return self.draw_maps(encoder, &target, contents, light, image);
        }
        let is_grey = matches!(
            contents.show,
            Show::Visibility | Show::Truth | Show::Difference
        );
        let stroke = if is_grey {
            Stroke::Grey
        } else {
            Stroke::Picture
        };
        let mut pass = scene_pass(encoder, &target, &self.depth, sky(contents));
        for (columns, (side, camera)) in self.columns(contents) {
            pass.set_scissor_rect(columns[0], 0, columns[1], self.size[1]);
            side.draw(
                gpu,
                &mut pass,
                contents.stage,
                camera,
                contents.lighting,
                stroke,
            );
        }
        drop(pass);
        if contents.show == Show::Cascades {
            let mut pass = color_pass(encoder, &target, wgpu::LoadOp::Load);
            for (columns, (side, camera)) in self.columns(contents) {
                pass.set_scissor_rect(columns[0], 0, columns[1], self.size[1]);
                let render_from_clip = camera.clip_from_render().inverse();
                self.debug
                    .draw_cascades(&mut pass, side.sun_maps(), &self.depth, render_from_clip)
                    .map_err(|error| error.to_string())?;
            }
        }
        Ok(())
    }

    /// Draws a map of each side in the middle of its columns. A side that lacks it stays dark.
    fn draw_maps(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        contents: &Contents<'_>,
        light: usize,
        image: DebugImage,
    ) -> Result<(), String> {
        let dark = wgpu::LoadOp::Clear(wgpu::Color {
            r: 0.08,
            g: 0.08,
            b: 0.10,
            a: 1.0,
        });
        let mut pass = color_pass(encoder, target, dark);
        for ([start, width], (side, _)) in self.columns(contents) {
            let maps = side.maps();
            let Some((_, maps)) = maps.get(light) else {
                continue;
            };
            if !has(maps, image) {
                continue;
            }
            let ratio = match image {
                DebugImage::Layer(_) => 1.0,
                _ => 4.0 / 3.0,
            };
            let height = (self.size[1] as f32).min(width as f32 / ratio) * 0.94;
            let [x, y] = [
                start as f32 + 0.5 * (width as f32 - height * ratio),
                0.5 * (self.size[1] as f32 - height),
            ];
            pass.set_viewport(x, y, height * ratio, height, 0.0, 1.0);
            self.debug
                .draw(&mut pass, maps, image)
                .map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// Returns the first column and the number of columns of each side that has some.
    fn columns<'a>(
        &self,
        contents: &Contents<'a>,
    ) -> impl Iterator<Item = ([u32; 2], (&'a Side, &'a Camera))> {
        let left = contents.left_columns.min(self.size[0]);
        let columns = [[0, left], [left, self.size[0] - left]];
        columns
            .into_iter()
            .zip(contents.sides)
            .filter(|([_, width], _)| *width > 0)
    }
}

/// Draws the visibilities of one side into a texture of its own, for reading back.
pub fn draw_visibility(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    target: &wgpu::Texture,
    (side, camera): (&Side, &Camera),
    stage: &Stage,
    lighting: &Lighting,
) {
    let size = [target.width(), target.height()];
    let depth = gpu.target(DEPTH_FORMAT, size, 1);
    let views = [target, &depth].map(|texture| texture.create_view(&Default::default()));
    let mut pass = scene_pass(encoder, &views[0], &views[1], wgpu::Color::WHITE);
    side.draw(gpu, &mut pass, stage, camera, lighting, Stroke::Visibility);
}

fn has(maps: &ShadowMaps, image: DebugImage) -> bool {
    let layers = maps.view_uniforms().len() as u32;
    match image {
        DebugImage::Layer(layer) => layer < layers,
        DebugImage::PoolCross(index) => 6 * index < layers,
        _ => false,
    }
}

/// Returns the sky as the target stores it.
fn sky(contents: &Contents<'_>) -> wgpu::Color {
    if matches!(contents.show, Show::Scene | Show::Cascades) {
        let code = |light: f32| f64::from(light).clamp(0.0, 1.0).powf(1.0 / 2.2);
        let [r, g, b] = contents.lighting.sky.to_array().map(code);
        wgpu::Color { r, g, b, a: 1.0 }
    } else {
        wgpu::Color {
            r: 0.16,
            g: 0.17,
            b: 0.20,
            a: 1.0,
        }
    }
}

fn scene_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    target: &wgpu::TextureView,
    depth: &wgpu::TextureView,
    sky: wgpu::Color,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("picture"),
        color_attachments: &[Some(attachment(target, wgpu::LoadOp::Clear(sky)))],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            // Depth is reversed: the far end of the world is 0.
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

fn color_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    target: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("picture"),
        color_attachments: &[Some(attachment(target, load))],
        ..Default::default()
    })
}

fn attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load,
            store: wgpu::StoreOp::Store,
        },
    }
}
