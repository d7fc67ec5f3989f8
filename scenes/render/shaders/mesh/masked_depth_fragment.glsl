// Holes of masked materials in shadow maps: what base colour's alpha leaves out lets light through.
layout(constant_id = 0) const bool has_textures = true;
const bool has_mip_bias = false;  // that of the picture is none of the shadow's

#include "frame.glsl"
#include "mesh/mesh_varyings_in.glsl"
#include "mesh/surface.glsl"

void main() {
    if (surface_base_color().a < materials[material_index].emissive.w) discard;
}
