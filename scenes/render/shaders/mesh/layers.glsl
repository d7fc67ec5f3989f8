// What a surface reflects under a fragment, with the layers of its material. Needs surface.glsl and light/brdf.glsl
// before it.
Reflectance specular_at_fragment(Surface surface) {
    vec4 specular = materials[material_index].specular;
    if (has_textures) {
        specular.rgb *= texel_of(specular_color_texture, Texture_specular_color).rgb;
        specular.a *= texel_of(specular_texture, Texture_specular).a;
    }
    return reflectance_with_specular(surface.base_color, surface.metallic, surface.roughness, specular.rgb, specular.a);
}

Sheen sheen_at_fragment(Surface surface, vec3 v) {
    vec4 given = materials[material_index].sheen;
    if (has_textures) {
        given.rgb *= texel_of(sheen_color_texture, Texture_sheen_color).rgb;
        given.a *= texel_of(sheen_roughness_texture, Texture_sheen_roughness).a;
    }
    return sheen(given.rgb, given.a, max(dot(surface.normal, v), 0.0));
}

// A coat has bumps of its own, or none.
Clearcoat clearcoat_at_fragment(Surface surface, vec3 v) {
    vec4 given = materials[material_index].clearcoat;
    vec3 normal = surface.geometry_normal;
    if (has_textures) {
        given.x *= texel_of(clearcoat_texture, Texture_clearcoat).r;
        given.y *= texel_of(clearcoat_roughness_texture, Texture_clearcoat_roughness).g;
        normal = mapped_normal(normal * surface.facing, clearcoat_normal_texture, Texture_clearcoat_normal, given.z) *
                 surface.facing;
    }
    return clearcoat(given.x, given.y, normal, v);
}

Reflectance material_at_fragment(Surface surface, vec3 v) {
    Reflectance material = has_specular_layer
                               ? specular_at_fragment(surface)
                               : reflectance(surface.base_color, surface.metallic, surface.roughness);
    if (has_sheen) material.sheen = sheen_at_fragment(surface, v);
    if (has_clearcoat) material.coat = clearcoat_at_fragment(surface, v);
    return material;
}
