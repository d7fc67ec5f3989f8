// SPDX-License-Identifier: MIT
// How far normals count of one surface, by their cosine: in full up to some 18 degrees, not from 37 on.
vec4 ssao_turned(vec4 cosine) { return clamp(cosine * (1.0 / 0.15) - 0.8 / 0.15, 0.0, 1.0); }
