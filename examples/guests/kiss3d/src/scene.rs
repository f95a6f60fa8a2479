//! Builds the scene that both kinds of shadows are shown in.

use kiss3d::prelude::*;

/// Holds the scene and the nodes of it that change.
pub struct Demo {
    pub root: SceneNode3d,
    pub sun: SceneNode3d,
    pub spot: SceneNode3d,
    pub lamp: SceneNode3d,
    pub mirror: SceneNode3d,
    pub ball: SceneNode3d,
    posts: SceneNode3d,
    hidden: SceneNode3d,
}

impl Demo {
    pub fn new() -> Self {
        let mut root = SceneNode3d::empty();
        root.add_cube(16.0, 0.4, 16.0)
            .set_position(Vec3::new(0.0, -0.2, 0.0));

        // A tower in two groups, one within the other, with uneven scales.
        let mut tower = root.add_group().set_position(Vec3::new(-3.0, 0.0, -1.0));
        tower.set_rotation(Quat::from_axis_angle(Vec3::Y, 0.5));
        tower
            .add_cube(1.6, 1.0, 1.2)
            .set_position(Vec3::new(0.0, 0.5, 0.0));
        let mut upper = tower.add_group().set_position(Vec3::new(0.0, 1.0, 0.0));
        upper.set_rotation(Quat::from_axis_angle(Vec3::X, 0.3));
        upper
            .add_sphere(0.6)
            .set_local_scale(1.5, 2.4, 0.8)
            .set_position(Vec3::new(0.0, 0.9, 0.0));
        let hidden = upper
            .add_cube(2.2, 0.12, 0.12)
            .set_position(Vec3::new(0.0, 1.9, 0.0));

        // Two hooks, of which one is mirrored by its scale.
        for side in [-1.0, 1.0] {
            root.add_trimesh(hook().0, hook().1, Vec3::ONE, true)
                .set_local_scale(side, 1.0, 1.0)
                .set_position(Vec3::new(side * 0.3 + 0.4, 0.0, 2.4));
        }

        let mut posts = root.add_cube(0.16, 1.0, 0.16);
        posts.set_position(Vec3::new(2.6, 0.5, -2.0));
        posts.set_instances(&circle(24));

        let ball = root.add_sphere(0.5).set_position(Vec3::new(2.6, 1.4, -2.0));
        let mirror = root
            .add_reflector(5.0, 2.6)
            .set_position(Vec3::new(4.6, 1.4, 2.6))
            .set_rotation(Quat::from_axis_angle(Vec3::Y, -2.1))
            .set_metallic(1.0)
            .set_roughness(0.05)
            .set_casts_shadows(false);

        let sun =
            root.add_light(Light::directional(Vec3::new(-0.7, -1.0, -0.4)).with_intensity(1.1));
        let spot = root.add_light(
            Light::spot(0.42, 0.5, 30.0)
                .with_color(Color::new(0.5, 0.8, 1.0, 1.0))
                .with_intensity(1.8),
        );
        let spot = aim(spot, Vec3::new(-5.0, 6.0, 5.0), Vec3::new(-1.5, 0.0, 0.0));
        let lamp = root
            .add_light(
                Light::point(9.0)
                    .with_color(Color::new(1.0, 0.7, 0.4, 1.0))
                    .with_intensity(1.6),
            )
            .set_position(LAMP);
        Self {
            root,
            sun,
            spot,
            lamp,
            mirror,
            ball,
            posts,
            hidden,
        }
    }

    /// Moves the ball in every frame, and in some of them what an application changes at times: a
    /// node that hides, instances that become more, a lamp that moves.
    pub fn advance(&mut self, frame: u32) {
        let angle = frame as f32 * 0.1;
        let offset = Vec3::new(
            angle.cos() * 1.4,
            1.4 + 0.6 * (2.0 * angle).sin(),
            angle.sin() * 1.4,
        );
        self.ball.set_position(Vec3::new(2.6, 0.0, -2.0) + offset);
        match frame {
            20 => self.hidden.set_visible(false),
            30 => self.posts.set_instances(&circle(40)),
            40 => self.hidden.set_visible(true),
            50.. => self
                .lamp
                .set_position(LAMP + Vec3::new(0.02 * (frame - 50) as f32, 0.0, 0.0)),
            _ => return,
        };
    }
}

const LAMP: Vec3 = Vec3::new(0.9, 1.9, -0.6);

/// Lets a spot light, which shines along -z, shine from `eye` to `target`.
fn aim(mut light: SceneNode3d, eye: Vec3, target: Vec3) -> SceneNode3d {
    let turn = Quat::from_rotation_arc(Vec3::NEG_Z, (target - eye).normalize());
    light.set_rotation(turn).set_position(eye)
}

/// Places the posts: each is turned, stretched and sheared in its own way.
fn circle(count: u32) -> Vec<InstanceData3d> {
    let post = |index: u32| {
        let angle = index as f32 * std::f32::consts::TAU / 24.0;
        let ring = if index < 24 { 2.2 } else { 1.2 };
        let height = 0.6 + 0.4 * (angle * 3.0).sin();
        let turned = Mat3::from_rotation_y(angle);
        let sheared = Mat3::from_cols(Vec3::X, Vec3::new(0.3, height, 0.0), Vec3::Z);
        InstanceData3d {
            position: Vec3::new(angle.cos() * ring, 0.5 * height - 0.5, angle.sin() * ring),
            deformation: turned * sheared,
            color: Color::new(0.9, 0.8 - 0.02 * index as f32, 0.6, 1.0),
            ..Default::default()
        }
    };
    (0..count).map(post).collect()
}

/// Makes a post with an arm to one side, of two boxes.
fn hook() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut mesh = (Vec::new(), Vec::new());
    add_box(
        &mut mesh,
        Vec3::new(-0.1, 0.0, -0.1),
        Vec3::new(0.1, 1.6, 0.1),
    );
    add_box(
        &mut mesh,
        Vec3::new(0.1, 1.3, -0.1),
        Vec3::new(0.9, 1.5, 0.1),
    );
    mesh
}

fn add_box(mesh: &mut (Vec<Vec3>, Vec<[u32; 3]>), low: Vec3, high: Vec3) {
    // Each side has corners of its own, so that its normals are its own.
    for axis in 0..3 {
        for (side, corner) in [(0, low), (1, high)] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let first = mesh.0.len() as u32;
            for (a, b) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let mut vertex = Vec3::ZERO;
                vertex[axis] = corner[axis];
                vertex[u] = if a == 0 { low[u] } else { high[u] };
                vertex[v] = if b == 0 { low[v] } else { high[v] };
                mesh.0.push(vertex);
            }
            let order = if side == 1 {
                [0, 1, 2, 3]
            } else {
                [0, 3, 2, 1]
            };
            let [a, b, c, d] = order.map(|corner| first + corner);
            mesh.1.extend([[a, b, c], [a, c, d]]);
        }
    }
}
