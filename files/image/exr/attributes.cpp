// SPDX-License-Identifier: MIT
#include "image/exr/attributes.hpp"

#include <OpenEXR/ImfAttribute.h>
#include <OpenEXR/ImfHeader.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "core/text/lower.hpp"

namespace darkroom {
namespace {

template <std::size_t count>
bool is_one_of(std::string_view name, const std::array<std::string_view, count>& names) {
    return std::ranges::find(names, name) != names.end();
}

/// Written anew, or not at all.
bool is_layout(std::string_view name) {
    constexpr std::array<std::string_view, 19> layout{"channels",
                                                      "compression",
                                                      "dataWindow",
                                                      "displayWindow",
                                                      "lineOrder",
                                                      "tiles",
                                                      "type",
                                                      "name",
                                                      "version",
                                                      "chunkCount",
                                                      "chromaticities",
                                                      "preview",
                                                      "multiView",
                                                      "maxSamplesPerPixel",
                                                      "whiteLuminance",
                                                      "adoptedNeutral",
                                                      "renderingTransform",
                                                      "dwaCompressionLevel",
                                                      "deepImageState"};
    return is_one_of(name, layout) || name.starts_with("darkroom:light");
}

bool is_cryptomatte(std::string_view name) { return name.starts_with("cryptomatte/"); }

/// What it says of colours and layers, which a picture says anew.
bool is_claim(std::string_view name) {
    constexpr std::array<std::string_view, 6> claims{"acesImageContainerFlag", "BlenderMultiChannel",
                                                     "colorInteropID",         "ColorSpace",
                                                     "oiio:ColorSpace",        "originalImageFlag"};
    return is_one_of(name, claims) || is_cryptomatte(name);
}

/// Who made a frame, when, with what, and from where: OpenEXR's standard attributes (ImfStandardAttributes.h of 3.4),
/// and what renderers, editors and cameras stamp on a frame, whatever its case.
bool is_of_any_picture(std::string_view name) {
    constexpr std::string_view names =
        "|altitude|aperture|artist|ascframingdecisionlist|capdate|capturerate|comments|copyright|date|datetime|"
        "description|document name|effectivefocallength|entrancepupiloffset|envmap|exposuretime|exptime|file|fnumber|"
        "focallength|focus|frame|frame range|framespersecond|generatedby|host|hostcomputer|hostname|imagecounter|"
        "imagedescription|isospeed|keycode|latitude|longitude|make|marker|memory|model|nominalfocallength|note|owner|"
        "pinholefocallength|pixelaspectratio|reelname|rendertime|scene|sequencer strip|shot|show|shutterangle|"
        "software|take|time|timecode|title|tstop|utcoffset|view|worldtocamera|worldtondc|xdensity|";
    constexpr std::array<std::string_view, 14> starts{"cycles.",      "arnold/", "camera",    "darkroom:", "exif:",
                                                      "gps:",         "iptc:",   "lens",      "nuke/",     "renderman/",
                                                      "screenwindow", "sensor",  "vrayinfo/", "xmp:"};
    const std::string lowered = lower(name);
    if (lowered == "exif:colorspace" || lowered.find('|') != std::string::npos) return false;
    return names.find("|" + lowered + "|") != std::string_view::npos ||
           std::ranges::any_of(starts, [&](std::string_view start) { return lowered.starts_with(start); });
}

/// Which part of the scene a picture shows.
bool is_framing(std::string_view name) {
    const std::string lowered = lower(name);
    return lowered == "worldtondc" || lowered.starts_with("screenwindow") ||
           (lowered.starts_with("darkroom:") && lowered.find("projection") != std::string::npos);
}

/// Adds it unless `header` says it: every header says some, at values that say nothing.
void add(const char* name, const Imf::Attribute& value, Imf::Header& header) {
    const std::string_view of = name;
    const bool is_default = of == "pixelAspectRatio" || of == "screenWindowCenter" || of == "screenWindowWidth";
    if (is_default || header.find(name) == header.end()) header.insert(name, value);
}

}  // namespace

ExrAttributes::ExrAttributes(const Imf::Header& header, Of of) : kept_(std::make_unique<Imf::Header>()) {
    for (auto found = header.begin(); found != header.end(); ++found) {
        const std::string_view name = found.name();
        if (is_layout(name)) continue;
        if (of == Of::Layers || is_of_any_picture(name))
            kept_->insert(found.name(), found.attribute());
        else if (!is_claim(name))
            dropped_.emplace_back(name);
    }
}

ExrAttributes::~ExrAttributes() = default;

void ExrAttributes::add_to(Imf::Header& header, bool is_cropped, bool is_stretched) const {
    for (auto found = kept_->begin(); found != kept_->end(); ++found) {
        const std::string_view name = found.name();
        const bool is_untrue = (is_cropped && is_framing(name)) || (is_stretched && lower(name) == "pixelaspectratio");
        if (!is_layout(name) && !is_untrue) add(found.name(), found.attribute(), header);
    }
}

void ExrAttributes::add_cryptomatte_to(Imf::Header& header) const {
    for (auto found = kept_->begin(); found != kept_->end(); ++found)
        if (is_cryptomatte(found.name())) add(found.name(), found.attribute(), header);
}

}  // namespace darkroom
