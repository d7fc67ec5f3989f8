// SPDX-License-Identifier: MIT
// Level i+1 onto level i, added. custom[0].x = gain.
#include "bloom_upsample_texels.glsl"

vec4 shade(Pixel pixel) {
    return vec4(bloom_by_texels(pixel) * custom[0].x, 0.0);
}
