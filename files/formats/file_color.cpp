// SPDX-License-Identifier: MIT
#include "formats/file_color.hpp"

#include <fmt/format.h>

#include "formats/exif.hpp"
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

FileColor with_exif(FileColor found, std::span<const std::byte> exif) {
    // Adobe Systems, "Adobe RGB (1998) Color Image Encoding", 2005, 4.3.
    const ColorCoding adobe{{.green = {0.21, 0.71}}, {TransferCurve::Kind::Power, 563.0 / 256}};
    const ExifColor says = color_of_exif(exif);
    if (says == ExifColor::AdobeRgb && found.coding) {
        if (!is_near(found.coding->primaries, adobe.primaries) && found.warning.empty())
            found.warning =
                fmt::format("EXIF says Adobe RGB (1998), and {} another space, which is obeyed", found.said);
    } else if (says == ExifColor::AdobeRgb) {
        if (const std::size_t end = found.warning.find(": taken"); end != std::string::npos)
            found.warning.replace(end, std::string::npos, ": taken as Adobe RGB (1998), by EXIF");
        found.coding = adobe;
        found.said = "EXIF: Adobe RGB (1998)";
    } else if (!found.coding && found.warning.empty()) {
        if (says == ExifColor::Uncalibrated)
            found.warning = "EXIF says that its colors are uncalibrated, and nothing says what they are: taken as sRGB";
        if (says == ExifColor::Contradictory)
            found.warning = "EXIF says sRGB in one place and Adobe RGB in another: taken as sRGB";
    }
    return found;
}

}  // namespace darkroom
