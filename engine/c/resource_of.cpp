// SPDX-License-Identifier: MIT
#include "c/resource_of.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <darkroom/effect.hpp>
#include <string>
#include <vector>

#include "core/text/param_text.hpp"

namespace darkroom::c {

namespace {

std::vector<float> copied(const float* numbers, std::size_t count) {
    return numbers == nullptr ? std::vector<float>{} : std::vector<float>(numbers, numbers + count);
}

/// The domain of a table's numbers; all 0: from 0 to 1.
void domain_of(const float (&from)[3], const float (&to)[3], std::array<float, 3>& min, std::array<float, 3>& max) {
    const auto is_zero = [](float number) { return number == 0; };
    if (std::ranges::all_of(from, is_zero) && std::ranges::all_of(to, is_zero)) return;
    std::ranges::copy(from, min.begin());
    std::ranges::copy(to, max.begin());
}

}  // namespace

ColorTable table_of(const DarkroomTable& given) {
    // What is larger is refused by its size alone.
    constexpr std::uint32_t longest = 65536, widest = 256;
    ColorTable out;
    out.shaper_size = given.shaper_size;
    out.size = given.size;
    domain_of(given.shaper_min, given.shaper_max, out.shaper_min, out.shaper_max);
    domain_of(given.min, given.max, out.min, out.max);
    if (given.shaper_size <= longest) out.shaper = copied(given.shaper, std::size_t{3} * given.shaper_size);
    if (given.size <= widest) out.cube = copied(given.cube, std::size_t{3} * given.size * given.size * given.size);
    return out;
}

ResourceImage picture_of(const DarkroomPicture& given) {
    constexpr std::uint32_t largest = 16384;
    ResourceImage out{.width = given.width, .height = given.height};
    if (given.width <= largest && given.height <= largest)
        out.rgba = copied(given.rgba, std::size_t{4} * given.width * given.height);
    return out;
}

Result<const EffectInfo*> effect_named(std::string_view name) {
    if (const EffectInfo* const found = find_effect(name)) return found;
    std::vector<std::string> names;
    for (const EffectInfo* effect : all_effects()) names.emplace_back(effect->name);
    return user_error(fmt::format("effect '{}': there is none of that name{}", name, suggestion(name, names)));
}

}  // namespace darkroom::c
