// The surface under a fragment: its material with textures, and its normal. Needs frame.glsl, mesh_varyings_in.glsl and
// the constants has_textures and has_mip_bias before it. Textures that a material lacks are white, so their values need no test.
layout(set = 1, binding = 0) uniform sampler2D base_color_texture;          // sRGB
layout(set = 1, binding = 1) uniform sampler2D metallic_roughness_texture;  // green: roughness; blue: metallic
layout(set = 1, binding = 2) uniform sampler2D normal_texture;
layout(set = 1, binding = 3) uniform sampler2D occlusion_texture;  // red
layout(set = 1, binding = 4) uniform sampler2D emissive_texture;   // sRGB
layout(set = 1, binding = 5) uniform sampler2D specular_texture;        // alpha
layout(set = 1, binding = 6) uniform sampler2D specular_color_texture;  // sRGB
layout(set = 1, binding = 7) uniform sampler2D clearcoat_texture;            // red
layout(set = 1, binding = 8) uniform sampler2D clearcoat_roughness_texture;  // green
layout(set = 1, binding = 9) uniform sampler2D clearcoat_normal_texture;
layout(set = 1, binding = 10) uniform sampler2D sheen_color_texture;      // sRGB
layout(set = 1, binding = 11) uniform sampler2D sheen_roughness_texture;  // alpha
const uint Texture_base_color = 0u;
const uint Texture_metallic_roughness = 1u;
const uint Texture_normal = 2u;
const uint Texture_occlusion = 3u;
const uint Texture_emissive = 4u;
const uint Texture_specular = 5u;
const uint Texture_specular_color = 6u;
const uint Texture_clearcoat = 7u;
const uint Texture_clearcoat_roughness = 8u;
const uint Texture_clearcoat_normal = 9u;
const uint Texture_sheen_color = 10u;
const uint Texture_sheen_roughness = 11u;

struct Surface {
    vec3 base_color;
    float alpha;
    float metallic;
    float roughness;
    float occlusion;
    vec3 emissive;
    vec3 normal;           // shaded, toward the camera's side
    vec3 geometry_normal;  // interpolated, toward the camera's side
    float facing;          // -1: the back is seen of what has two sides
};

// Coordinates of one of the material's textures, and how they change over the screen. Gradients are those of what is
// interpolated, transformed: pixels beside a triangle, which exist for gradients alone, need not read buffers (on the
// software driver they read zeros).
struct Coordinates {
    vec2 place;
    vec2 x_gradient;
    vec2 y_gradient;
};
Coordinates texture_coordinates(uint texture_number) {
    float gradient_scale = has_mip_bias ? 1.0 + frame.camera_forward.w : 1.0;
    vec4 x_gradient = dFdx(uv) * gradient_scale;
    vec4 y_gradient = dFdy(uv) * gradient_scale;
    bool is_second = (materials[material_index].flags.z & (1u << texture_number)) != 0u;
    vec3 u_row = materials[material_index].uv_rows[2u * texture_number].xyz;
    vec3 v_row = materials[material_index].uv_rows[2u * texture_number + 1u].xyz;
    vec3 place = vec3(is_second ? uv.zw : uv.xy, 1.0);
    vec2 x_change = is_second ? x_gradient.zw : x_gradient.xy;
    vec2 y_change = is_second ? y_gradient.zw : y_gradient.xy;
    return Coordinates(vec2(dot(u_row, place), dot(v_row, place)),
                       vec2(dot(u_row.xy, x_change), dot(v_row.xy, x_change)),
                       vec2(dot(u_row.xy, y_change), dot(v_row.xy, y_change)));
}
vec4 texel_of(sampler2D image, uint texture_number) {
    Coordinates at = texture_coordinates(texture_number);
    return textureGrad(image, at.place, at.x_gradient, at.y_gradient);
}

bool has_flag(uint flag) { return (materials[material_index].flags.x & flag) != 0u; }

vec4 surface_base_color() {
    vec4 color = materials[material_index].base_color * vertex_color;
    if (has_textures) color *= texel_of(base_color_texture, Texture_base_color);
    return color;
}

// From the texture's tangent space, whose y points against the second texture coordinate (glTF 2.0, 3.7.2.1), to the
// world. Where vertices have no tangents, the gradients of the coordinates over the screen give them: Schueler, "Normal
// Mapping without Precomputed Tangents", 2013. Derivatives are taken before any branch, as GLSL demands.
vec3 mapped_normal(vec3 n, sampler2D normals, uint texture_number, float strength) {
    Coordinates coordinates = texture_coordinates(texture_number);
    vec3 texel = textureGrad(normals, coordinates.place, coordinates.x_gradient, coordinates.y_gradient).xyz;
    texel = texel * 2.0 - 1.0;
    texel.xy *= strength;
    vec3 position_x = dFdx(world_position);
    vec3 position_y = dFdy(world_position);
    vec2 uv_x = coordinates.x_gradient;
    vec2 uv_y = coordinates.y_gradient;

    vec3 tangent;
    vec3 bitangent;
    if (dot(world_tangent.xyz, world_tangent.xyz) > 1e-30) {
        tangent = normalize(world_tangent.xyz - n * dot(n, world_tangent.xyz));
        bitangent = cross(n, tangent) * (world_tangent.w < 0.0 ? -1.0 : 1.0);
    } else {
        vec3 across_y = cross(position_y, n);
        vec3 across_x = cross(n, position_x);
        float side = dot(cross(position_x, position_y), n) < 0.0 ? -1.0 : 1.0;
        vec3 u_gradient = across_y * uv_x.x + across_x * uv_y.x;
        vec3 v_gradient = across_y * uv_x.y + across_x * uv_y.y;
        float longest = max(dot(u_gradient, u_gradient), dot(v_gradient, v_gradient));
        float scale = longest > 0.0 ? side * inversesqrt(longest) : 0.0;
        tangent = u_gradient * scale;
        bitangent = -v_gradient * scale;
    }
    vec3 mapped = tangent * texel.x + bitangent * texel.y + n * texel.z;
    bool is_given = (materials[material_index].flags.y & (1u << texture_number)) != 0u && dot(mapped, mapped) > 1e-12;
    return is_given ? normalize(mapped) : n;
}

Surface surface_at_fragment() {
    Surface surface;
    vec4 base_color = surface_base_color();
    surface.base_color = base_color.rgb;
    surface.alpha = base_color.a;
    vec4 factors = materials[material_index].factors;
    surface.metallic = factors.x;
    surface.roughness = factors.y;
    surface.occlusion = 1.0;
    surface.emissive = materials[material_index].emissive.rgb;

    float squared_length = dot(world_normal, world_normal);
    vec3 n = squared_length > 1e-37 ? world_normal * inversesqrt(squared_length) : vec3(0.0, 1.0, 0.0);
    surface.normal = n;
    if (has_textures) {
        vec4 metallic_roughness = texel_of(metallic_roughness_texture, Texture_metallic_roughness);
        surface.metallic *= metallic_roughness.b;
        surface.roughness *= metallic_roughness.g;
        float occlusion = texel_of(occlusion_texture, Texture_occlusion).r;
        surface.occlusion = 1.0 + factors.w * (occlusion - 1.0);
        surface.emissive *= texel_of(emissive_texture, Texture_emissive).rgb;
        surface.normal = mapped_normal(n, normal_texture, Texture_normal, factors.z);
    }
    // The back of a thin sheet is the same sheet seen from behind, bumps and all.
    float facing = has_flag(Material_double_sided) && !gl_FrontFacing ? -1.0 : 1.0;
    surface.normal *= facing;
    surface.geometry_normal = n * facing;
    surface.facing = facing;
    return surface;
}
