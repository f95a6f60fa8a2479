
@group(SHADOW_GROUP) @binding(VIEWS_BINDING) var<uniform> shadow_views_NAME: array<ShadowViewUniform, ARRAY_LENGTH>;
@group(SHADOW_GROUP) @binding(MAP_BINDING) var shadow_map_NAME: MAP_TYPE;
