
// Contains the stages around a lookup: the fragment stage returns visibility alone.

struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
}

@vertex
fn vertex(@location(0) position: vec4<f32>, @location(1) normal: vec4<f32>) -> Surface {
    return Surface(position, position.xyz, normal.xyz);
}

@fragment
fn fragment(surface: Surface) -> @location(0) vec4<f32> {
    return vec4<f32>(visibility(surface.position, surface.normal));
}
