//! Holds one scene on a device that draws the six faces of a point light in one pass, and on one that draws a pass for
//! each.

use glam::{DVec3, Mat4, Vec3};
use wgpu_shadows::{
    Aabb, CameraView, CasterPipeline, MeshCaster, OmniLight, OmniShadow, OmniShadowDescriptor,
    Revision, ShadowCaster, ShadowView, caster::CasterPipelineDescriptor, report::ShadowReport,
    report::ViewStatus,
};

use crate::support::frames::{OmniFrame, RecordFrame};
use crate::support::gpu::Gpu;
use crate::support::multiview::{device, is_right, portable};
use crate::support::readback;
use crate::support::scene::Mesh;

pub const MAP: u32 = 128;
pub const LIGHT: DVec3 = DVec3::new(0.1, 0.2, -0.3);

/// Is a mesh that reports a chosen number of triangles and whether it is the same in every view.
pub struct Told {
    pub mesh: MeshCaster,
    pub triangles: u32,
    pub same_in_every_view: bool,
    pub pipeline: Option<CasterPipeline>,
}

impl ShadowCaster for Told {
    fn bounds(&self) -> Aabb {
        self.mesh.bounds()
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.pipeline.as_ref().unwrap_or(self.mesh.pipeline())
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
        self.mesh.draw(pass, view);
    }

    fn triangles(&self) -> u32 {
        self.triangles
    }

    fn same_in_every_view(&self) -> bool {
        self.same_in_every_view
    }

    fn revision(&self) -> Option<Revision> {
        self.mesh.revision()
    }
}

/// Describes how a mesh is drawn.
#[derive(Clone, Copy, Default)]
pub struct Look {
    pub transform: Mat4,
    pub cull: Option<wgpu::Face>,
}

/// Holds meshes around a light, on one device.
pub struct Stage<'a> {
    pub gpu: &'a Gpu,
    pub shadow: OmniShadow,
    pub casters: Vec<Told>,
    pub range: f32,
    pub camera: Option<CameraView>,
    pub receivers: Vec<Aabb>,
}

impl<'a> Stage<'a> {
    /// Makes the stage. Each caster reports one triangle, so that one pass is the cheaper way wherever it is possible.
    pub fn new(gpu: &'a Gpu, meshes: &[(Mesh, Look)]) -> Self {
        let descriptor = OmniShadowDescriptor {
            map_size: MAP,
            ..Default::default()
        };
        let casters = meshes.iter().map(|(mesh, look)| {
            let pipeline = CasterPipeline::new(
                &gpu.device,
                &CasterPipelineDescriptor {
                    primitive: wgpu::PrimitiveState {
                        cull_mode: look.cull,
                        ..Default::default()
                    },
                    ..Default::default()
                },
            )
            .expect("a valid pipeline");
            Told {
                mesh: mesh.caster(gpu, &pipeline, look.transform),
                triangles: 1,
                same_in_every_view: true,
                pipeline: None,
            }
        });
        Self {
            gpu,
            shadow: OmniShadow::new(&gpu.device, &descriptor).expect("a valid light"),
            casters: casters.collect(),
            range: 60.0,
            camera: None,
            receivers: Vec::new(),
        }
    }

    pub fn record(&mut self, light: DVec3) -> ShadowReport {
        let list: Vec<&dyn ShadowCaster> = self
            .casters
            .iter()
            .map(|caster| caster as &dyn ShadowCaster)
            .collect();
        let mut encoder = self.gpu.encoder();
        let frame = OmniFrame {
            origin: DVec3::ZERO,
            light: OmniLight {
                position_world: light,
                range: self.range,
            },
            camera: self.camera,
            casters: &list,
            receivers: &self.receivers,
        };
        let report = self
            .shadow
            .record_frame(&mut encoder, &frame)
            .expect("a valid frame")
            .clone();
        self.gpu.submit(encoder);
        report
    }

    pub fn layer(&self, layer: u32) -> Vec<u32> {
        let depths = readback::depth_layer(self.gpu, self.shadow.maps().texture(), layer);
        depths.into_iter().map(f32::to_bits).collect()
    }
}

/// Holds the same scene on a device that draws six views at once, and on one that does not.
pub struct Pair {
    pub one: Stage<'static>,
    pub six: Stage<'static>,
}

impl Pair {
    pub fn new(meshes: &[(Mesh, Look)]) -> Self {
        Self {
            one: Stage::new(device(), meshes),
            six: Stage::new(portable(), meshes),
        }
    }

    pub fn each(&mut self, change: impl Fn(&mut Stage<'static>)) {
        change(&mut self.one);
        change(&mut self.six);
    }

    /// Records both and asserts that every layer that has a map contains the same bits. Also returns how many texels
    /// something was drawn into.
    pub fn compare(&mut self, name: &str, light: DVec3) -> ([ShadowReport; 2], usize) {
        let reports = [self.one.record(light), self.six.record(light)];
        let [one, six] = &reports;
        let mut filled = 0;
        for (left, right) in one.views.iter().zip(&six.views) {
            let empty = [left, right].map(|view| view.status == ViewStatus::Empty);
            assert_eq!(empty[0], empty[1], "{name}: layer {}", left.layer);
            if !empty[0] {
                let (one, six) = (self.one.layer(left.layer), self.six.layer(left.layer));
                let differing = one.iter().zip(&six).filter(|(one, six)| one != six).count();
                assert_eq!(differing, 0, "{name}: texels of layer {}", left.layer);
                filled += six.iter().filter(|&&bits| bits != 0).count();
            }
        }
        (reports, filled)
    }

    /// Records both as `compare` does, and asserts that something was drawn.
    pub fn record(&mut self, name: &str, light: DVec3) -> [ShadowReport; 2] {
        let (reports, filled) = self.compare(name, light);
        assert!(filled > 100, "{name}: {filled} texels are no picture");
        reports
    }

    /// Records both, one of them in one pass where the driver is correct, and in a pass each where it is not.
    pub fn record_in_one_pass(&mut self, name: &str, light: DVec3) -> [ShadowReport; 2] {
        let reports = self.record(name, light);
        let passes = [reports[0].passes, reports[1].passes];
        let faces = passes[1];
        assert!(faces > 1, "{name}: nothing to compare");
        let wanted = if is_right() { 1 } else { faces };
        assert_eq!(passes[0], wanted, "{name} on {}", device().describe());
        reports
    }
}

pub fn plain(mesh: Mesh) -> (Mesh, Look) {
    (mesh, Look::default())
}

pub fn cube(center: Vec3, half: f32) -> Mesh {
    Mesh::cuboid(center - half, center + Vec3::splat(half))
}

pub fn room() -> Mesh {
    Mesh::cuboid(Vec3::splat(-6.0), Vec3::new(5.0, 6.0, 7.0))
}

/// Returns walls on all sides, and an object before each of them.
pub fn furnished() -> Vec<(Mesh, Look)> {
    let sides = [Vec3::X, Vec3::Y, Vec3::Z].into_iter();
    let things = sides.flat_map(|side| [side, -side]).map(|side| {
        let turned = Mat4::from_rotation_y(0.7) * Mat4::from_rotation_x(0.4);
        let look = Look {
            transform: Mat4::from_translation(side * 2.5) * turned,
            ..Default::default()
        };
        (cube(Vec3::ZERO, 0.8), look)
    });
    [plain(room())].into_iter().chain(things).collect()
}

/// Returns objects of many triangles across several faces: around the light, at corners and edges of the cube, and in
/// front of each other.
pub fn straddling() -> Vec<(Mesh, Look)> {
    let mut meshes = vec![plain(Mesh::sphere(Vec3::new(0.4, -0.1, 0.2), 4.5, 24))];
    for corner in 0..8 {
        let sign = |bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let diagonal = Vec3::new(sign(0), sign(1), sign(2));
        meshes.push(plain(Mesh::sphere(diagonal * 2.0, 0.9, 9)));
        meshes.push(plain(cube(diagonal * Vec3::new(1.3, 1.2, 0.6), 0.4)));
    }
    meshes
}

/// Returns a room, and objects beyond its walls, which hide them.
pub fn behind() -> Vec<(Mesh, Look)> {
    let mut meshes = vec![plain(room())];
    for side in [Vec3::X, Vec3::Y, Vec3::Z] {
        meshes.push(plain(cube(side * 9.0, 2.5)));
        meshes.push(plain(Mesh::sphere(side * -8.5, 2.0, 12)));
    }
    meshes
}

/// Returns solids of which only one side is drawn, mirrored and not.
pub fn culled() -> Vec<(Mesh, Look)> {
    let mirror = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let mut meshes = straddling();
    for (index, (_, look)) in meshes.iter_mut().enumerate() {
        look.transform = if index % 2 == 0 {
            mirror
        } else {
            Mat4::IDENTITY
        };
        look.cull = [None, Some(wgpu::Face::Front), Some(wgpu::Face::Back)][index % 3];
    }
    meshes
}
