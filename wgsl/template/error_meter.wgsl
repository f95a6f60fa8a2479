
// Writes, for each place, the visibility that the light's lookup returns and the depths of its two
// rays.
@compute @workgroup_size(64)
fn shadow_meter(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&shadow_meter_places) {
        let place = shadow_meter_places[id.x];
        shadow_meter_results[id.x] = vec4<f32>(
            shadow_NAME(INDEX, place.position, place.normal),
            shadow_meter_depth(place.rays & 0xffffu),
            shadow_meter_depth(place.rays >> 16u),
            0.0,
        );
    }
}
