// Contains the town's fragment stages. The text before this one defines Blinn-Phong, and the one
// before that `shadow_sun`.

// Is the width and height of the wall around a window, in metres.
const WINDOW_CELL: vec2<f32> = vec2<f32>(2.4, 3.0);

const HAZE: vec3<f32> = vec3<f32>(0.45, 0.58, 0.75);

// Returns the fraction of a pixel of `width` at `place` that lies between `low` and `high` of each
// unit.
fn covered(place: vec2<f32>, width: vec2<f32>, low: vec2<f32>, high: vec2<f32>) -> vec2<f32> {
    let start = place - 0.5 * width;
    let end = place + 0.5 * width;
    let until_start = floor(start) * (high - low) + clamp(fract(start) - low, vec2<f32>(0.0), high - low);
    let until_end = floor(end) * (high - low) + clamp(fract(end) - low, vec2<f32>(0.0), high - low);
    return (until_end - until_start) / width;
}

// Adds windows to all upright walls, averaged over a pixel. No triangle of a dome is upright.
fn with_windows(surface: Surface, normal: vec3<f32>) -> Surface {
    let cells = along_surface(surface) / WINDOW_CELL;
    let width = max(fwidth(cells), vec2<f32>(1e-4));
    let shares = covered(cells, width, vec2<f32>(0.28, 0.30), vec2<f32>(0.72, 0.80));
    let upright = select(0.0, 1.0, abs(normal.y) < 0.02);
    var glazed = surface;
    glazed.albedo = mix(surface.albedo, vec3<f32>(0.10, 0.12, 0.15), 0.85 * upright * shares.x * shares.y);
    return glazed;
}

fn in_the_haze(color: vec3<f32>, position: vec3<f32>) -> vec3<f32> {
    let clear = exp(-distance(position, frame.eye) / 2500.0);
    return mix(HAZE, color, clear);
}

fn lit_town(surface: Surface, normal: vec3<f32>) -> vec3<f32> {
    let visibility = shadow_sun(surface.position, normal);
    return shade(with_windows(surface, normal), visibility);
}

@fragment
fn fragment(surface: Surface) -> @location(0) vec4<f32> {
    // Domes are shaded as round but consist of flat triangles; shadows need the normals of these.
    let normal = shadow_geometric_normal(surface.position, frame.eye - surface.position);
    return vec4<f32>(in_the_haze(lit_town(surface, normal), surface.position), 1.0);
}

// Writes how many texels of its map a pixel covers along its longer side, as (log2 + 8) / 16, and 0
// where no map covers it.
@fragment
fn fragment_density(surface: Surface) -> @location(0) vec4<f32> {
    let across = dpdx(surface.position);
    let down = dpdy(surface.position);
    let view = shadow_view_sun(surface.position);
    if view == 4u {
        return vec4<f32>(0.0);
    }
    let texel_scale = shadow_views_sun[view].mapping.texel_scale;
    let texels_across = shadow_light_from_render(shadow_views_sun[0], across).xy * texel_scale;
    let texels_down = shadow_light_from_render(shadow_views_sun[0], down).xy * texel_scale;
    let texels = max(length(texels_across), length(texels_down));
    return vec4<f32>(clamp((log2(texels) + 8.0) / 16.0, 1.0 / 255.0, 1.0), 0.0, 0.0, 1.0);
}

@fragment
fn fragment_cascades(surface: Surface) -> @location(0) vec4<f32> {
    var tints = array<vec3<f32>, 5>(
        vec3<f32>(1.0, 0.25, 0.2),
        vec3<f32>(0.25, 0.9, 0.2),
        vec3<f32>(0.2, 0.4, 1.0),
        vec3<f32>(1.0, 0.8, 0.15),
        vec3<f32>(0.6, 0.6, 0.6),
    );
    let normal = shadow_geometric_normal(surface.position, frame.eye - surface.position);
    let color = lit_town(surface, normal);
    let tint = tints[shadow_view_sun(surface.position)];
    return vec4<f32>(tint * (0.12 + 0.88 * dot(color, vec3<f32>(0.3, 0.5, 0.2))), 1.0);
}
