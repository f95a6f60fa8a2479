//! Casts the shadows of leaves through cards: two triangles each, of which a fragment stage
//! discards all but the leaves.
//!
//! The picture and the rays have the outlines of the same leaves as triangles.

use example_support::mesh::{Instance, Vertex, square, vertex_buffer};
use glam::{Vec2, Vec3};
use wgpu_shadows::{
    Aabb, CasterPipeline, DepthFormat, Revision, ShadowCaster, ShadowView,
    caster::CasterPipelineDescriptor, caster::CasterVertex, error::CasterError,
};

/// Is the number of leaves along each side of a card.
const LEAVES_PER_SIDE: u32 = 3;

/// Is half the length and half the width of a leaf, where the cell that it lies in goes from -1 to
/// 1.
const HALF_LEAF: Vec2 = Vec2::new(0.95, 0.55);

/// Holds cards that cast.
pub struct LeafCaster {
    pipeline: CasterPipeline,
    card: wgpu::Buffer,
    instances: wgpu::Buffer,
    count: u32,
    bounds: Aabb,
    revision: Revision,
}

/// Returns the leaves of a card from -1 to 1 in x and y, as triangles that are seen from both
/// sides.
pub fn outlines() -> Vec<Vertex> {
    let cell = 2.0 / LEAVES_PER_SIDE as f32;
    let half = HALF_LEAF * (0.5 * cell);
    let middle = |index: u32| -1.0 + cell * (index as f32 + 0.5);
    let places = (0..LEAVES_PER_SIDE * LEAVES_PER_SIDE).map(|index| {
        Vec2::new(
            middle(index % LEAVES_PER_SIDE),
            middle(index / LEAVES_PER_SIDE),
        )
    });
    places
        .flat_map(|place| {
            let [right, up] = [Vec2::X * half.x, Vec2::Y * half.y];
            let corners = [right, up, -right, -right, -up, right];
            let front = corners.map(|corner| (corner, Vec3::Z));
            let back = [right, -right, up, -right, right, -up].map(|corner| (corner, -Vec3::Z));
            [front, back]
                .into_iter()
                .flatten()
                .map(move |(corner, normal)| Vertex {
                    position: (place + corner).extend(0.0),
                    normal,
                })
        })
        .collect()
}

/// Makes the pipeline of all cards.
pub fn pipeline(
    device: &wgpu::Device,
    depth_formats: &[DepthFormat],
) -> Result<CasterPipeline, CasterError> {
    let Vec2 { x, y } = HALF_LEAF;
    let source = format!(
        "const LEAVES_PER_SIDE: f32 = {:?};\n\
         const HALF_LEAF: vec2<f32> = vec2<f32>({x:?}, {y:?});\n{}",
        LEAVES_PER_SIDE as f32,
        include_str!("leaves.wgsl")
    );
    let positions = wgpu::vertex_attr_array![0 => Float32x3];
    let columns = wgpu::vertex_attr_array![
        1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4
    ];
    CasterPipeline::new(
        device,
        &CasterPipelineDescriptor {
            label: Some("leaves"),
            vertex: CasterVertex::Wgsl {
                source: &source,
                vertex_entry: "card_vertex",
                fragment_entry: Some("card_fragment"),
                buffers: &[
                    Some(wgpu::VertexBufferLayout {
                        array_stride: size_of::<Vertex>() as u64,
                        step_mode: wgpu::VertexStepMode::Vertex,
                        attributes: &positions,
                    }),
                    Some(wgpu::VertexBufferLayout {
                        array_stride: size_of::<Instance>() as u64,
                        step_mode: wgpu::VertexStepMode::Instance,
                        attributes: &columns,
                    }),
                ],
                bind_group_layouts: &[],
            },
            depth_formats,
            ..Default::default()
        },
    )
}

impl LeafCaster {
    /// Makes the caster of cards that stand still within `bounds`, with the pipeline of
    /// [`pipeline`] and the buffer that their outlines are drawn from. `index` is that of their
    /// model in the scene.
    pub fn new(
        device: &wgpu::Device,
        pipeline: &CasterPipeline,
        (instances, count): (&wgpu::Buffer, u32),
        bounds: Aabb,
        index: usize,
    ) -> Self {
        Self {
            pipeline: pipeline.clone(),
            card: vertex_buffer(device, &square(Vec3::Z, 0.0)),
            instances: instances.clone(),
            count,
            bounds,
            // The library counts its own meshes from below.
            revision: Revision::new(u64::MAX - index as u64, 0),
        }
    }
}

impl ShadowCaster for LeafCaster {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn pipeline(&self) -> &CasterPipeline {
        &self.pipeline
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _: &ShadowView) {
        pass.set_vertex_buffer(0, self.card.slice(..));
        pass.set_vertex_buffer(1, self.instances.slice(..));
        pass.draw(0..6, 0..self.count);
    }

    fn keeps_pass_state(&self) -> bool {
        true
    }

    fn triangles(&self) -> u32 {
        2 * self.count
    }

    fn revision(&self) -> Option<Revision> {
        Some(self.revision)
    }
}
