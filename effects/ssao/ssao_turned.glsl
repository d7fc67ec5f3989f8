// SPDX-License-Identifier: MIT
// How far normals count of one surface, by their cosine: in full up to some 18 degrees, not from 37 on. `per_turn`: the
// normal here times ssao_per_turn, so that a normal takes three multiply-adds.
const float ssao_per_turn = 1.0 / 0.15, ssao_last_turn = 0.8 / 0.15;

float ssao_turned(vec3 normal, vec3 per_turn) {
    return clamp(normal.x * per_turn.x + (normal.y * per_turn.y + (normal.z * per_turn.z - ssao_last_turn)), 0.0, 1.0);
}

vec4 ssao_turned(vec3 a, vec3 b, vec3 c, vec3 d, vec3 per_turn) {
    return vec4(ssao_turned(a, per_turn), ssao_turned(b, per_turn), ssao_turned(c, per_turn), ssao_turned(d, per_turn));
}
