// Members of the uniform block Lights; see frame_block.glsl. Colours are multiplied by intensity.
vec4 directional_direction[4];  // toward the light; w: its shadow map, or -1
vec4 directional_color[4];
vec4 point_position[16];  // w: range
vec4 point_color[16];     // w: the first of its six tiles, or -1
vec4 spot_position[8];   // w: range
vec4 spot_direction[8];  // from the light into the scene; w: cosine of the outer angle
vec4 spot_color[8];      // w: cosine of the inner angle
vec4 spot_tiles[8];      // x: the first, or -1; y: how many
