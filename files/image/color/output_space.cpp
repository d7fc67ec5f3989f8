// SPDX-License-Identifier: MIT
#include "image/color/output_space.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

constexpr ColorState light_of(Primaries primaries) { return {.primaries = primaries}; }

constexpr std::array<OutputSpace, 5> output_spaces{{
    {"srgb", srgb_color, light_of(Primaries::Rec709)},
    {"p3", p3_color, light_of(Primaries::P3)},
    {"rec2020", std::nullopt, light_of(Primaries::Rec2020)},
    {"pq", pq_color, std::nullopt},
    {"hlg", hlg_color, std::nullopt},
}};

template <class Holds>
std::vector<std::string> names_where(Holds holds) {
    std::vector<std::string> out;
    for (const OutputSpace& space : output_spaces)
        if (holds(space)) out.emplace_back(space.name);
    return out;
}
bool is_any(const OutputSpace&) { return true; }

}  // namespace

Result<OutputSpace> find_output_space(std::string_view name) {
    const auto* const found = std::ranges::find(output_spaces, lower(name), &OutputSpace::name);
    if (found != output_spaces.end()) return *found;
    return user_error(fmt::format("'{}' is not a color space that pictures can be written in{}",
                                  printable(std::string(name)), alternatives(std::string(name), names_where(is_any))));
}

std::string output_space_names(std::string_view separator) {
    return fmt::format("{}", fmt::join(names_where(is_any), separator));
}

std::string output_space_names_of(bool is_integer) {
    return fmt::format("{}", fmt::join(names_where([=](const OutputSpace& space) {
                                           return (is_integer ? space.integers : space.floats).has_value();
                                       }),
                                       ", "));
}

}  // namespace darkroom
