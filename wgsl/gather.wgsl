// Compares raw depths of a map with the receiver's reference depths at their texels. These are
// never farther from the light than the receiver itself.
//
// CPU reference: src/receive/reference. Requires: view, texels.

// Describes where a kernel lies on the map.
struct ShadowKernel {
    // Is the texel whose centre is next to the receiver, toward the upper left.
    base: vec2<f32>,
    // Is the distance of the receiver from that centre, from 0 to 1 along x and y.
    fraction: vec2<f32>,
    // Is the depth of the receiver's plane at that centre.
    depth: f32,
}

// Returns where the kernel of a receiver lies.
fn shadow_kernel(receiver: ShadowReceiver) -> ShadowKernel {
    let from_centers = receiver.texel - 0.5;
    let base = floor(from_centers);
    let fraction = from_centers - base;
    return ShadowKernel(base, fraction, receiver.depth - dot(receiver.gradient, fraction));
}

// Returns the depths of the receiver's plane in rows `row` and `row + 1` from a kernel's base, in
// the base's column.
fn shadow_kernel_rows(receiver: ShadowReceiver, kernel: ShadowKernel, row: f32) -> vec2<f32> {
    return kernel.depth + receiver.gradient.y * vec2<f32>(row, row + 1.0);
}

// Compares a block of 2x2 texels, whose left column is `column` columns from the kernel's base.
// `rows` is the depth of the plane in its two rows, in the base's column, and `weights` the weight
// of its two columns. Returns for each row `before`, to which the weights of the lit texels are
// added.
fn shadow_lit_rows(
    receiver: ShadowReceiver,
    rows: vec2<f32>,
    column: f32,
    weights: vec2<f32>,
    depths: vec4<f32>,
    before: vec2<f32>,
) -> vec2<f32> {
    // Written by components, fewer values are held at once than with vectors.
    let left = receiver.gradient.x * column;
    let right = receiver.gradient.x * (column + 1.0);
    var upper = before.x + select(0.0, weights.x, max(rows.x + left, receiver.depth) >= depths.x);
    upper += select(0.0, weights.y, max(rows.x + right, receiver.depth) >= depths.y);
    var lower = before.y + select(0.0, weights.x, max(rows.y + left, receiver.depth) >= depths.z);
    lower += select(0.0, weights.y, max(rows.y + right, receiver.depth) >= depths.w);
    return vec2<f32>(upper, lower);
}

// Returns the visibility that a kernel's weighted sum of lit texels means, with a sharper edge: the
// ramp is stretched around one half.
fn shadow_ramped(receiver: ShadowReceiver, sum: f32) -> f32 {
    return clamp(sum * receiver.ramp.x + receiver.ramp.y, 0.0, 1.0);
}

// Returns the receiver's reference depths at the texels (first), (first + x), (first + y), (first +
// x + y).
fn shadow_references(receiver: ShadowReceiver, first: vec2<f32>) -> vec4<f32> {
    let to_first = first + 0.5 - receiver.texel;
    let rise = dot(receiver.gradient, to_first);
    let along = vec4<f32>(
        0.0,
        receiver.gradient.x,
        receiver.gradient.y,
        receiver.gradient.x + receiver.gradient.y,
    );
    return receiver.depth + max(vec4<f32>(rise) + along, vec4<f32>(0.0));
}

// Returns 1 where lit and 0 where shadowed, for the same texels.
fn shadow_gather(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    first: vec2<f32>,
) -> vec4<f32> {
    let depths = shadow_texels(map, map_sampler, receiver, first + 1.0);
    let lit = shadow_references(receiver, first) >= depths;
    return select(vec4<f32>(0.0), vec4<f32>(1.0), lit);
}
