//! Opens a window of the engine `graphics` with two lights, and shadows of both.

mod shadows;

use std::f32::consts::TAU;

use graphics::{
    ControlScheme, EngineUpdates, Entity, EntityUpdate, GraphicsSettings, LightType, Lighting,
    Mesh, PointLight, RIGHT_VEC, Scene, UP_VEC, UiSettings,
};
use lin_alg::f32::{Quaternion, Vec3};

/// Is the number of the entity that moves.
const MOVING: usize = 1;

fn main() {
    let settings = GraphicsSettings {
        mesh_extension: Some(shadows::make),
        ..Default::default()
    };
    graphics::run(
        0.0_f32,
        scene(),
        UiSettings::default(),
        settings,
        |seconds, scene, since_last| {
            *seconds += since_last;
            scene.entities[MOVING].position = moving_at(*seconds);
            EngineUpdates {
                entities: EntityUpdate::All,
                request_redraw: true,
                ..Default::default()
            }
        },
        |_, _, _, _, _| EngineUpdates::default(),
        |_, _, _, _| EngineUpdates::default(),
        |_, _, _| EngineUpdates::default(),
    );
}

fn moving_at(seconds: f32) -> Vec3 {
    let angle = 0.8 * seconds;
    Vec3::new(1.6 * angle.cos(), 1.4, 1.6 * angle.sin())
}

fn scene() -> Scene {
    let entity = |mesh, place: [f32; 3], angle, scale, color| {
        let turn = Quaternion::from_axis_angle(UP_VEC, angle);
        let place = Vec3::new(place[0], place[1], place[2]);
        Entity::new(mesh, place, turn, scale, color, 8.0)
    };
    let mut entities = vec![
        entity(0, [0.0, -0.1, 0.0], 0.0, 1.0, (0.75, 0.75, 0.72)),
        entity(2, [1.6, 1.4, 0.0], 0.0, 0.35, (0.9, 0.5, 0.3)),
    ];
    for index in 0..7 {
        let angle = TAU * index as f32 / 7.0;
        let place = [3.0 * angle.cos(), 0.5, 3.0 * angle.sin()];
        entities.push(entity(1, place, 0.7 * angle, 1.0, (0.4, 0.55, 0.7)));
    }
    entities.push(entity(3, [0.0, 0.0, 0.0], 0.4, 1.0, (0.5, 0.65, 0.4)));
    let light = |place: [f32; 3], color: [f32; 4]| PointLight {
        type_: LightType::Omnidirectional,
        position: Vec3::new(place[0], place[1], place[2]),
        diffuse_color: color,
        specular_color: color,
        diffuse_intensity: 1.1,
        specular_intensity: 0.4,
    };
    let mut scene = Scene {
        meshes: vec![
            Mesh::new_box(14.0, 0.2, 14.0),
            Mesh::new_box(0.6, 1.0, 0.6),
            Mesh::new_sphere(1.0, 3),
            Mesh::new_pyramid(1.2, 0.8, 5),
        ],
        entities,
        lighting: Lighting {
            ambient_color: [1.0, 1.0, 1.0, 1.0],
            ambient_intensity: 0.15,
            point_lights: vec![
                light([-3.5, 5.0, -3.0], [1.0, 0.95, 0.85, 1.0]),
                light([2.2, 2.6, -1.0], [0.7, 0.8, 1.0, 1.0]),
            ],
        },
        background_color: (0.45, 0.55, 0.7),
        window_title: "shadows in graphics".to_owned(),
        window_size: (960.0, 600.0),
        ..Default::default()
    };
    scene.input_settings.control_scheme = ControlScheme::Arc {
        center: Vec3::new_zero(),
    };
    scene.camera.position = Vec3::new(0.0, 5.0, -8.0);
    scene.camera.orientation = Quaternion::from_axis_angle(RIGHT_VEC, 0.55);
    scene.camera.far = 100.0;
    scene.camera.update_proj_mat();
    scene
}
