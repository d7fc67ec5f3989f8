// One Material of the storage buffer; see frame_block.glsl. Textures in order: base color, metallic-roughness, normal,
// occlusion, emissive, specular, specular color, clearcoat, clearcoat roughness, clearcoat normal, sheen color,
// sheen roughness.
vec4 base_color;  // with opacity in alpha
vec4 emissive;    // w: alpha cutoff
vec4 factors;     // metallic, roughness, normal scale, occlusion strength
uvec4 flags;      // bits Material_...; y: bit i: texture i is given; z: bit i: texture i uses uv set 1
vec4 specular;    // F0 of the dielectric, w: its weight; of Layer_specular
vec4 clearcoat;   // weight, roughness, normal scale; of Layer_clearcoat
vec4 sheen;       // color, w: roughness; of Layer_sheen
vec4 uv_rows[24];  // of texture i: rows 2i and 2i + 1 of its transform, applied to (u, v, 1)
