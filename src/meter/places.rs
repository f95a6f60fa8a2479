//! Chooses the places of a frame that are measured, and the rays toward the light from each.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, UVec2, Vec3};

use crate::cast::RayDraws;
use crate::fit::{RayView, ShadowRay};
use crate::meter::light::{MeasuredLight, TowardLight};
use crate::meter::measured::MeterReport;
use crate::meter::random::Random;
use crate::receive::{Selection, ShadowMaps};
use crate::{ShadowError, ShadowFrame, check};

/// Is a point of a surface on which the engine looks shadows up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// Is the position in render space, on the surface as the engine draws it: off by no more than
    /// the rounding of f32. A position below its surface is measured in the surface's own shadow.
    pub position_render: Vec3,
    /// Is the geometric normal, on the side that is shaded: finite and of any length but zero. It
    /// is what the engine passes to the light's lookup. An interpolated one makes rays near the
    /// horizon of the surface count as lit that the surface blocks.
    pub normal: Vec3,
}

/// Is the number of rays from each place toward a light with an extent: the product of two
/// independent differences is an unbiased estimate of the squared error.
pub(super) const RAYS_PER_PLACE: usize = 2;

/// Is what is known of a ray before it is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) enum RayAnswer {
    /// It meets no bounds of casters.
    Lit,
    /// It leads below the surface.
    Blocked,
    /// Its texel will tell.
    Drawn,
}

/// Is a place whose results are awaited.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub position_world: DVec3,
    pub normal: Vec3,
    pub slot: u32,
    pub rays: [RayAnswer; RAYS_PER_PLACE],
}

/// Mirrors `ShadowMeterPlace` in `wgsl/pass/error_meter.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct PlaceUniform {
    position: [f32; 3],
    slot: u32,
    normal: [f32; 3],
    rays: u32,
}

/// Holds the places of a frame. Its memory is reused.
#[derive(Debug, Default)]
pub(super) struct Places {
    pub places: Vec<Place>,
    pub uniforms: Vec<PlaceUniform>,
    pub rays: Vec<RayDraws>,
    /// Holds the casters that the rays meet.
    pub met: Vec<u32>,
}

/// Is what rays of a frame have in common.
pub(super) struct RaySetting<'a> {
    pub frame: &'a ShadowFrame<'a>,
    pub maps: &'a ShadowMaps,
    pub light: &'a MeasuredLight<'a>,
    /// Is the number of texels per side of the map of the rays.
    pub map_size: u32,
    /// Is the largest number of places.
    pub most_places: usize,
}

impl RaySetting<'_> {
    /// Returns the size of the light's extent: an angle or a radius.
    fn light_size(&self) -> f64 {
        f64::from(self.maps.sampling().filter.light_size())
    }

    /// Returns the direction and the length of a ray toward a random point of the light.
    fn target(&self, toward: &TowardLight, random: &mut Random) -> (DVec3, f64) {
        let size = self.light_size();
        if size == 0.0 {
            return (toward.direction, toward.distance);
        }
        let tangent = if self.maps.sampled().selection == Selection::Cascades {
            (0.5 * size).tan()
        } else {
            size / toward.distance
        };
        let (across, along) = toward.direction.any_orthonormal_pair();
        let [x, y] = random.on_disc();
        let way = toward.direction + (across * x + along * y) * tangent;
        (way.normalize(), toward.distance * way.length())
    }
}

impl Places {
    /// Fills the lists from the first of `receivers` that can be measured.
    pub(super) fn choose(
        &mut self,
        setting: &RaySetting<'_>,
        receivers: &[Receiver],
        random: &mut Random,
    ) -> Result<MeterReport, ShadowError> {
        self.places.clear();
        self.uniforms.clear();
        self.rays.clear();
        self.met.clear();
        let mut report = MeterReport::default();
        for receiver in receivers {
            let position = receiver.position_render.as_dvec3();
            check::finite_vector("Receiver::position_render", position)?;
            check::direction("Receiver::normal", receiver.normal.as_dvec3())?;
        }
        for receiver in receivers {
            if self.places.len() == setting.most_places {
                break;
            }
            self.add(setting, receiver, random, &mut report);
        }
        report.places = self.places.len() as u32;
        report.rays = self.rays.len() as u32;
        Ok(report)
    }

    /// Adds a receiver, or counts why it cannot be measured.
    fn add(
        &mut self,
        setting: &RaySetting<'_>,
        receiver: &Receiver,
        random: &mut Random,
        report: &mut MeterReport,
    ) {
        let normal = receiver.normal.as_dvec3().normalize();
        let position_world = receiver.position_render.as_dvec3() + setting.frame.origin;
        let Some(toward) = setting.light.toward(position_world, random) else {
            report.out_of_reach += 1;
            return;
        };
        if normal.dot(toward.direction) <= 0.0 {
            report.facing_away += 1;
            return;
        }
        let rays_before = (self.rays.len(), self.met.len());
        let count = if setting.light_size() > 0.0 {
            RAYS_PER_PLACE
        } else {
            1
        };
        let mut answers = [RayAnswer::Lit; RAYS_PER_PLACE];
        let mut numbers = [0; RAYS_PER_PLACE];
        for ray in 0..count {
            let target = setting.target(&toward, random);
            let number = self.rays.len() as u32;
            let Some(answer) = self.add_ray(setting, receiver, normal, target, report) else {
                self.rays.truncate(rays_before.0);
                self.met.truncate(rays_before.1);
                report.unresolved += 1;
                return;
            };
            // A light without an extent has one ray, which counts as both.
            answers[ray..].fill(answer);
            numbers[ray..].fill(if matches!(answer, RayAnswer::Drawn) {
                number
            } else {
                0
            });
        }
        let normal = normal.as_vec3();
        self.uniforms.push(PlaceUniform {
            position: receiver.position_render.to_array(),
            slot: toward.slot,
            normal: normal.to_array(),
            rays: numbers[0] | numbers[1] << 16,
        });
        self.places.push(Place {
            position_world,
            normal,
            slot: toward.slot,
            rays: answers,
        });
    }

    /// Adds the view along a ray, if there is anything to draw into it. Returns `None` where
    /// rounding hides too much.
    fn add_ray(
        &mut self,
        setting: &RaySetting<'_>,
        receiver: &Receiver,
        normal: DVec3,
        (toward_light, length): (DVec3, f64),
        report: &mut MeterReport,
    ) -> Option<RayAnswer> {
        let cosine = normal.dot(toward_light);
        if cosine <= 0.0 {
            return Some(RayAnswer::Blocked);
        }
        let ray = ShadowRay {
            start_render: receiver.position_render,
            toward_light,
            cosine,
            length,
        };
        let first = self.met.len();
        let casters = setting.frame.casters.casting();
        let Some(reach) = ray.find(&casters, &mut self.met) else {
            return Some(RayAnswer::Lit);
        };
        let (index, size) = (self.rays.len() as u32, setting.map_size);
        let texel = UVec2::new(index % size, index / size);
        let RayView {
            view,
            blind_height_world,
        } = ray.view(
            &reach,
            setting.frame.origin,
            (index, texel, size),
            setting.maps.sampling().depth_format.step_ndc(),
        )?;
        let position = receiver.position_render.as_dvec3();
        let mut views = setting.maps.views();
        let texel = views.find_map(|view| view.texel_size_at(position));
        if texel.is_some_and(|texel| blind_height_world > texel) {
            return None;
        }
        let largest = &mut report.largest_blind_height_world;
        *largest = largest.max(blind_height_world);
        self.rays.push(RayDraws {
            view,
            casters: first..self.met.len(),
        });
        Some(RayAnswer::Drawn)
    }
}
