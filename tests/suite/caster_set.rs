//! Compares maps of a set of casters with maps of a list of the same casters in random order: fits,
//! reports and bits are the same over random insertions, removals, changes and re-use of places.
//! The tests run on Vulkan alone, since reading maps back is slow on OpenGL.

use std::collections::HashSet;

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, CasterId, CasterPipeline, CasterSet, Casters, Coverage, MeshCaster, Revision,
    ShadowCaster, ShadowError, ShadowFrameDescriptor, ShadowScene, ShadowView,
    caster::CasterPipelineDescriptor, caster::CasterShape, report::ViewReport, report::ViewStatus,
};

use crate::fixtures::any_light::AnyLight;
use crate::fixtures::gpu::{Gpu, vulkan};
use crate::fixtures::texture_bytes::TextureBytes;

/// Is a mesh whose bounds may be broken, and which may look different in every frame.
struct Thing {
    mesh: MeshCaster,
    is_broken: bool,
    is_restless: bool,
}

impl ShadowCaster for Thing {
    fn bounds(&self) -> Aabb {
        if self.is_broken {
            Aabb::new(Vec3::NAN, Vec3::ONE)
        } else {
            self.mesh.bounds()
        }
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.mesh.pipeline()
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
        self.mesh.draw(pass, view);
    }

    fn casts(&self) -> bool {
        self.mesh.casts()
    }

    fn receives(&self) -> bool {
        self.mesh.receives()
    }

    fn shape(&self) -> CasterShape {
        self.mesh.shape()
    }

    fn keeps_pass_state(&self) -> bool {
        true
    }

    fn triangles(&self) -> u32 {
        self.mesh.triangles()
    }

    fn revision(&self) -> Option<Revision> {
        self.mesh.revision().filter(|_| !self.is_restless)
    }
}

/// Holds the casters, and the ids that were taken back.
struct World<'a> {
    gpu: &'a Gpu,
    pipeline: CasterPipeline,
    set: CasterSet<Thing>,
    ids: Vec<CasterId>,
    gone: Vec<CasterId>,
    random: Random,
}

impl<'a> World<'a> {
    fn new(gpu: &'a Gpu, seed: u64) -> Self {
        let pipeline = CasterPipeline::new(&gpu.device, &CasterPipelineDescriptor::new())
            .expect("a valid pipeline");
        let mut world = Self {
            gpu,
            pipeline,
            set: CasterSet::new(),
            ids: Vec::new(),
            gone: Vec::new(),
            random: Random::new(seed),
        };
        let ground = Mesh::cuboid(Vec3::new(-60.0, -1.0, -60.0), Vec3::new(60.0, 0.0, 60.0));
        let mut things = vec![world.thing(&ground)];
        things[0].mesh.set_shape(CasterShape::Cuboid);
        things.extend((0..24).map(|_| world.random_thing()));
        world.ids = world.set.insert_all(things);
        world
    }

    fn thing(&self, mesh: &Mesh) -> Thing {
        Thing {
            mesh: mesh.caster(self.gpu, &self.pipeline, Mat4::IDENTITY),
            is_broken: false,
            is_restless: false,
        }
    }

    fn random_thing(&mut self) -> Thing {
        let random = &mut self.random;
        let low = random.point(DVec3::new(-12.0, 0.0, -12.0), DVec3::new(11.0, 3.0, 11.0));
        let high = low + random.point(DVec3::splat(0.3), DVec3::splat(1.7));
        let (roles, is_broken) = (random.index(8), random.unit() < 0.1);
        let mut thing = self.thing(&Mesh::cuboid(low.as_vec3(), high.as_vec3()));
        thing.mesh.set_roles(roles != 0, roles != 1);
        thing.is_broken = is_broken;
        thing
    }

    fn any_id(&mut self) -> CasterId {
        self.ids[self.random.index(self.ids.len())]
    }

    /// Changes some of the casters, or none.
    fn step(&mut self) {
        for _ in 0..[0, 0, 1, 1, 3, 12][self.random.index(6)] {
            let id = self.any_id();
            let way = if self.random.unit() < 0.1 { 40.0 } else { 0.4 };
            let shift = self
                .random
                .point(DVec3::splat(-way), DVec3::splat(way))
                .as_vec3();
            let changed = self.set.update(id, |thing| {
                let moved = Mat4::from_translation(shift) * thing.mesh.render_from_model();
                thing.mesh.set_transform(moved)
            });
            changed.expect("a known caster").expect("a finite matrix");
        }
        let chance = self.random.unit();
        if chance < 0.05 && self.ids.len() > 2 {
            let index = self.random.index(self.ids.len());
            let id = self.ids.swap_remove(index);
            self.set.remove(id).expect("a known caster");
            self.gone.push(id);
        } else if chance < 0.1 && self.ids.len() < 60 {
            let thing = self.random_thing();
            let id = self.set.insert(thing);
            self.ids.push(id);
        } else if chance < 0.13 {
            let id = self.any_id();
            let flag = self.random.index(3);
            let changed = self.set.update(id, |thing| match flag {
                0 => thing.is_broken = !thing.is_broken,
                1 => thing.is_restless = !thing.is_restless,
                _ => thing
                    .mesh
                    .set_roles(thing.mesh.receives(), thing.mesh.casts()),
            });
            changed.expect("a known caster");
        }
        for &id in &self.gone {
            assert!(self.set.get(id).is_none());
            let refused = self.set.update(id, |_| ());
            assert!(matches!(refused, Err(ShadowError::UnknownCaster { .. })));
            assert!(self.set.remove(id).is_err());
        }
        assert_eq!(self.set.len(), self.ids.len());
    }
}

/// Checks that a set and a list in another order each frame give the same views, uniforms, reports
/// and maps, and that these are the maps that are drawn anew, while all may change; and that
/// nothing is drawn where nothing changed.
#[test]
fn a_set_and_a_list_in_any_order_give_the_same_maps() {
    let gpu = vulkan();
    let mut world = World::new(gpu, 17);
    let [mut of_set, mut of_list, mut anew] = [0; 3].map(|_| AnyLight::all(gpu));
    let bytes = |lights: &[AnyLight]| -> Vec<TextureBytes> {
        let bytes = |light: &AnyLight| TextureBytes::new(gpu, light.maps().texture());
        lights.iter().map(bytes).collect()
    };
    let [set_bytes, list_bytes, anew_bytes] = [bytes(&of_set), bytes(&of_list), bytes(&anew)];
    let (mut set_scene, mut list_scene) = (ShadowScene::new(), ShadowScene::new());
    let mut random = Random::new(4);
    let camera = |eye: DVec3| Camera::modern(eye, DVec3::ZERO, 1.0, 1.5).view();
    let mut cameras = vec![camera(DVec3::new(0.0, 6.0, 14.0)).with_max_distance(50.0)];
    let (mut place, mut direction) = (DVec3::new(0.3, 4.0, -0.4), Vec3::new(0.4, -1.0, 0.3));
    let (mut kind, mut kept, mut drawn, mut divided) = (0, 0, 0, false);
    let mut seen_indices = HashSet::new();
    for frame in 0..400 {
        // The last frames are still for longer than extents are kept that are larger than needed.
        let is_still = frame >= 240;
        if !is_still {
            world.step();
            if random.unit() < 0.1 {
                let eye = random.point(DVec3::new(-9.0, 3.0, 9.0), DVec3::new(9.0, 9.0, 15.0));
                cameras[0] = camera(eye).with_max_distance(50.0);
                cameras.truncate(1);
                if random.unit() < 0.3 {
                    cameras.push(camera(eye * 1.1).with_max_distance(30.0));
                }
            }
            if random.unit() < 0.05 {
                place = random.point(DVec3::new(-6.0, 0.5, -6.0), DVec3::new(6.0, 5.0, 6.0));
                direction.x = random.range(-1.0, 1.0) as f32;
            }
            if random.unit() < 0.05 {
                kind = random.index(4);
            }
        }
        if frame == 240 {
            // No caster is restless in a still frame.
            for id in world.ids.clone() {
                let calm = world.set.update(id, |thing| thing.is_restless = false);
                calm.expect("a known caster");
            }
            kind = 0;
        }
        let coverage = match kind {
            0 | 1 => Coverage::Cameras(&cameras),
            2 => Coverage::Bounds(Aabb::new(Vec3::splat(-6.0), Vec3::splat(6.0))),
            _ => Coverage::Everything,
        };
        let receivers = [Aabb::new(
            Vec3::new(-2.0, 4.0, -2.0),
            Vec3::new(2.0, 4.0, 2.0),
        )];
        let descriptor = |casters| ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage,
            casters,
            receivers: &receivers,
        };
        let mut members: Vec<(CasterId, &Thing)> = world.set.iter().collect();
        seen_indices.extend(members.iter().map(|(id, _)| (id.index(), *id)));
        for last in (1..members.len()).rev() {
            members.swap(last, random.index(last + 1));
        }
        let list: Vec<&dyn ShadowCaster> = members
            .iter()
            .map(|(_, thing)| *thing as &dyn ShadowCaster)
            .collect();
        let set_frame = set_scene.frame(&descriptor(Casters::Set(&world.set)));
        let set_frame = set_frame.expect("a valid frame");
        let list_frame = list_scene.frame(&descriptor(Casters::List(&list)));
        let list_frame = list_frame.expect("a valid frame");
        let [mut set_broken, mut list_broken] = [&set_frame, &list_frame].map(|frame| {
            let index = |broken: &wgpu_shadows::report::BrokenBounds| broken.index;
            frame.broken_bounds().iter().map(index).collect::<Vec<_>>()
        });
        for index in &mut list_broken {
            *index = members[*index].0.index() as usize;
        }
        set_broken.sort_unstable();
        list_broken.sort_unstable();
        assert_eq!(set_broken, list_broken, "frame {frame}");
        let mut encoder = gpu.encoder();
        for (index, light) in of_set.iter_mut().enumerate() {
            let what = format!("frame {frame}, light {index}");
            let mut report = light.record(&mut encoder, &set_frame, place, direction);
            let other = &mut of_list[index];
            let mut list_report = other.record(&mut encoder, &list_frame, place, direction);
            report.broken_bounds.clear();
            list_report.broken_bounds.clear();
            assert_eq!(report, list_report, "{what}");
            let (views, list_views) = (light.maps().views(), other.maps().views());
            assert_eq!(
                views.collect::<Vec<_>>(),
                list_views.collect::<Vec<_>>(),
                "{what}"
            );
            let uniforms = bytemuck::cast_slice::<_, u8>(light.maps().view_uniforms());
            let list_uniforms = bytemuck::cast_slice::<_, u8>(other.maps().view_uniforms());
            assert!(uniforms == list_uniforms, "{what}");
            anew[index].invalidate();
            anew[index].record(&mut encoder, &list_frame, place, direction);
            drawn += report.passes;
            kept += report
                .views
                .iter()
                .filter(|v| v.status == ViewStatus::Kept)
                .count();
        }
        let reads = !is_still || frame % 40 == 0;
        if reads {
            for bytes in [&set_bytes, &list_bytes, &anew_bytes].into_iter().flatten() {
                bytes.copy(&mut encoder);
            }
        }
        gpu.submit(encoder);
        if !reads {
            continue;
        }
        for (index, light) in of_set.iter().enumerate() {
            let [now, listed, fresh] =
                [&set_bytes, &list_bytes, &anew_bytes].map(|bytes| bytes[index].read(gpu));
            let (report, readers) = (light.maps().report(), &set_bytes[index]);
            let what =
                |than: &str| format!("frame {frame}, light {index}: another map than {than}");
            readers.assert_same_views(report, [&now, &listed], || what("of a list"));
            readers.assert_same_views(report, [&now, &fresh], || what("as drawn anew"));
            let map_size = light.maps().texture().width();
            let has_map = |view: &&ViewReport| view.status != ViewStatus::Empty;
            let mut views = report.views.iter().filter(has_map);
            divided |= views.any(|view| view.texels.size.x < map_size);
        }
    }
    let indices: HashSet<u32> = seen_indices.iter().map(|(index, _)| *index).collect();
    assert!(
        indices.len() < seen_indices.len(),
        "some places are used again"
    );
    assert!(kept > 1000 && drawn > 1000, "{kept} {drawn}");
    assert!(divided, "cascades share a layer");
}
