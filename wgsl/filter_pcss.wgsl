// Renders soft shadows of a light with a size: percentage-closer soft shadows (Fernando 2005),
// calibrated instead of tuned.
//
// An occluder of ndc depth b shadows a point of ndc depth z behind it within a disk whose radius is
// (b - z) times a constant of the view, for orthographic and perspective views alike. With h the
// distance along the axis, a sun of angular diameter a spreads h tan(a/2) in world units; a local
// light of radius r spreads r (1/w_b - 1/w_z) in tangents, which is r / near times the difference
// of depths. `receiver.penumbra` is that constant in texels along x and y.
//
// A first loop finds the mean depth of the occluders that can hide a part of the light. A second
// loop averages visibility over the disk that they spread. The result is exact for one planar
// occluder parallel to the map; elsewhere averaging the occluders causes an error. Every texel is
// compared with the receiver's own plane, as in `gather`.
//
// CPU reference: src/receive/reference. Requires: view, texels, gather, filter_tent3.

// Is the radius of the widest disk in texels. Maps keep this much, and a texel more, free around
// what they cover.
const SHADOW_PENUMBRA_REACH: f32 = 32.0;
// Are the numbers of samples of the two loops.
const SHADOW_PENUMBRA_SEARCH_TAPS: u32 = 24u;
const SHADOW_PENUMBRA_FILTER_TAPS: u32 = 32u;

// Returns the golden angle times `index` in radians, reduced to one turn: sine and cosine are
// accurate only there.
fn shadow_golden_angle(index: u32) -> f32 {
    return fract(f32(index) * 0.38196601) * 6.2831853;
}

// Returns sample `index` of `count` that are spread evenly over the unit disk along a golden-angle
// spiral (Vogel 1979).
fn shadow_disk(index: u32, count: u32) -> vec2<f32> {
    let radius = sqrt((f32(index) + 0.5) / f32(count));
    let angle = shadow_golden_angle(index);
    return radius * vec2<f32>(cos(angle), sin(angle));
}

// Returns sample `index` of `count` of the search for occluders. The samples lie closer together
// toward the middle, since low occluders can hide the light only there. z is the area that the
// sample stands for, up to a factor: the radius t^1.5 at t = (index + 1/2) / count covers an area
// of t^1.5 * t^0.5 per step.
fn shadow_search_disk(index: u32, count: u32) -> vec3<f32> {
    let t = (f32(index) + 0.5) / f32(count);
    let angle = shadow_golden_angle(index);
    return vec3<f32>(t * sqrt(t) * vec2<f32>(cos(angle), sin(angle)), t * t);
}

// Finds the occluders among four texels that can hide a part of the light. Returns the sum of their
// depth differences in x and their number in y.
fn shadow_occluders(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    first: vec2<f32>,
) -> vec2<f32> {
    let depths = shadow_texels(map, map_sampler, receiver, first + 1.0);
    let nearer = depths - shadow_references(receiver, first);
    let height = depths - receiver.depth;
    // An occluder counts within the disk that its height spreads, and half a texel farther for its
    // own size.
    let x = abs(vec4<f32>(0.0, 1.0, 0.0, 1.0) + first.x + 0.5 - receiver.texel.x) - 0.5;
    let y = abs(vec4<f32>(0.0, 0.0, 1.0, 1.0) + first.y + 0.5 - receiver.texel.y) - 0.5;
    let across = max(x, vec4<f32>(0.0)) / receiver.penumbra.x;
    let down = max(y, vec4<f32>(0.0)) / receiver.penumbra.y;
    let within = across * across + down * down <= height * height;
    let counts = select(vec4<f32>(0.0), vec4<f32>(1.0), (nearer > vec4<f32>(0.0)) & within);
    return vec2<f32>(dot(counts, height), dot(counts, vec4<f32>(1.0)));
}

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_pcss(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    return shadow_penumbra(map, map_sampler, receiver, mat2x2<f32>(1.0, 0.0, 0.0, 1.0));
}

// Returns the visibility of the light, in [0, 1], with both sample patterns rotated by `turn`.
fn shadow_penumbra(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    turn: mat2x2<f32>,
) -> f32 {
    let reach = vec2<f32>(SHADOW_PENUMBRA_REACH);
    let widest = clamp(receiver.penumbra * (1.0 - receiver.depth), vec2<f32>(1.0), reach);
    var found = vec2<f32>(0.0);
    for (var i = 0u; i < SHADOW_PENUMBRA_SEARCH_TAPS; i++) {
        let sample = shadow_search_disk(i, SHADOW_PENUMBRA_SEARCH_TAPS);
        let first = floor(receiver.texel + (turn * sample.xy) * widest - 0.5);
        found += sample.z * shadow_occluders(map, map_sampler, receiver, first);
    }
    if found.y == 0.0 {
        return 1.0;
    }
    let radius = min(receiver.penumbra * (found.x / found.y), reach);
    let hard = shadow_filter_tent3(map, map_sampler, receiver);
    if max(radius.x, radius.y) < 1.0 {
        return hard;
    }
    var lit = 0.0;
    for (var i = 0u; i < SHADOW_PENUMBRA_FILTER_TAPS; i++) {
        let offset = turn * shadow_disk(i, SHADOW_PENUMBRA_FILTER_TAPS);
        let from_centers = receiver.texel + offset * radius - 0.5;
        let first = floor(from_centers);
        let s = from_centers - first;
        let block = shadow_gather(map, map_sampler, receiver, first);
        let rows = mix(block.xz, block.yw, s.x);
        lit += mix(rows.x, rows.y, s.y);
    }
    // Between radii of one and two texels the hard filter blends into the disk.
    let share = clamp(max(radius.x, radius.y) - 1.0, 0.0, 1.0);
    return mix(hard, lit / f32(SHADOW_PENUMBRA_FILTER_TAPS), share);
}
