// Draws a card of leaves as a caster. The library's caster module comes before this text, and the
// host defines `LEAVES_PER_SIDE` and `HALF_LEAF` in front of it.

struct Card {
    @builtin(position) clip: vec4<f32>,
    // Is the place on the card, from -1 to 1.
    @location(0) place: vec2<f32>,
}

@vertex
fn card_vertex(
    @location(0) position: vec3<f32>,
    @location(1) column_x: vec4<f32>,
    @location(2) column_y: vec4<f32>,
    @location(3) column_z: vec4<f32>,
    @location(4) column_w: vec4<f32>,
) -> Card {
    let render_from_model = mat4x4<f32>(column_x, column_y, column_z, column_w);
    var card: Card;
    card.clip = shadow_caster_clip((render_from_model * vec4<f32>(position, 1.0)).xyz);
    card.place = position.xy;
    return card;
}

// Keeps the rhombi that are the leaves.
@fragment
fn card_fragment(card: Card) {
    let cell = fract((card.place + 1.0) * 0.5 * LEAVES_PER_SIDE) * 2.0 - 1.0;
    let across = abs(cell) / HALF_LEAF;
    if across.x + across.y > 1.0 {
        discard;
    }
}
