// SPDX-License-Identifier: MIT
#include "formats/file_color.hpp"

#include <fmt/format.h>

#include "formats/icc_profile.hpp"

namespace darkroom {

FileColor color_of_profile(std::span<const std::byte> profile, bool is_integer) {
    if (profile.empty()) return {};
    const std::string name = profile_description(profile);
    const std::string said = fmt::format("ICC profile '{}'", name);
    if (const std::optional<ColorCoding> coding = profile_coding(profile)) return {.coding = coding, .said = said};
    const bool is_table = is_integer && !has_curves(profile);
    if (is_table && name.find("sRGB") != std::string::npos) return {.coding = ColorCoding{}, .said = said};
    if (is_table && name.find("Display P3") != std::string::npos)
        return {.coding = ColorCoding{find_input_space("p3")->primaries, {TransferCurve::Kind::Srgb}}, .said = said};
    return {.warning =
                fmt::format("its ICC profile{} is not read: taken as {}, --input-space says otherwise",
                            name.empty() ? "" : fmt::format(" '{}'", name), is_integer ? "sRGB" : "linear Rec. 709")};
}

}  // namespace darkroom
