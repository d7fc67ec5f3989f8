// Members of the uniform block Shadows; see frame_block.glsl. Light l's cascade c is number 4 * l + c, the lamps' tile t
// is number 16 + t.
mat4 world_to_map[64];  // to x, y in [-1, 1], y down, depth 0 near the light .. 1
vec4 cascade_splits[4];     // of each light: far view distance of its cascades
vec4 cascade_texels[4];     // of each light: world size of a texel of each cascade
vec4 shadow_settings;       // cascades a light, resolution, 1 / resolution, distance where shadows end
vec4 tile_settings;         // texels of a side of a tile, tiles a row, 1 / width and 1 / height of the image of them
