// SPDX-License-Identifier: MIT
#include "custom/light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "plan/text/glsl_names.hpp"

namespace darkroom::custom {

namespace {

constexpr std::array<std::string_view, 3> light_functions{"lit", "light_direction", "light_color"};

/// Keeps what is lit off its own shadow.
constexpr float depth_bias = 0.002f;

}  // namespace

void write_light(const void*, const PassContext& context, std::span<PassVector> out) {
    std::ranges::fill(out, PassVector{});
    const Light* const light = shadow_light(context.lights, 0);
    if (light == nullptr) return;
    const auto cascades = std::min<std::size_t>(light->cascade_count, Light::max_cascades);
    for (std::size_t i = 0; i < cascades; ++i) {
        const Matrix& m = light->world_to_cascade[i];
        for (std::size_t row = 0; row < 3; ++row) {
            // x and y from [-1, 1] to [0, 1]; depth as it is.
            const float scale = row == 2 ? 1.0f : 0.5f, offset = row == 2 ? -depth_bias : 0.5f;
            out[3 * i + row] = {m[row] * scale, m[4 + row] * scale, m[8 + row] * scale, m[12 + row] * scale + offset};
        }
        out[3 * Light::max_cascades][i] = light->splits[i];
    }
    const auto& [x, y, z] = light->direction;
    const auto& [r, g, b] = light->color;
    out[light_vectors - 2] = {x, y, z, static_cast<float>(cascades)};
    out[light_vectors - 1] = {r, g, b, 0};
}

bool reads_light(std::string_view code, std::string_view effect) {
    return std::ranges::any_of(light_functions, [&](std::string_view function) {
        return plan::calls_name(code, fmt::format("{}_{}", effect, function));
    });
}

std::string light_code(std::string_view effect, bool is_pass) {
    std::string out = is_pass ? fmt::format("vec4 {}_custom(int index) {{ return custom[index]; }}\n", effect) : "";
    return out + fmt::format(R"(float {0}_lit(vec3 world, float planar) {{
    int count = int({0}_custom({1}).w);
    for (int i = 0; i < count; ++i) {{
        if (planar >= {0}_custom({2})[i]) continue;
        vec4 place = vec4(world, 1.0);
        vec2 uv = vec2(dot({0}_custom(3 * i), place), dot({0}_custom(3 * i + 1), place));
        return texture(frame_shadow, vec4(uv, float(i), min(dot({0}_custom(3 * i + 2), place), 1.0)));
    }}
    return 1.0;
}}
vec3 {0}_light_direction() {{ return {0}_custom({1}).xyz; }}
vec3 {0}_light_color() {{ return {0}_custom({3}).rgb; }}
)",
                             effect, light_vectors - 2, 3 * Light::max_cascades, light_vectors - 1);
}

}  // namespace darkroom::custom
