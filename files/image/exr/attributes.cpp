// SPDX-License-Identifier: MIT
#include "image/exr/attributes.hpp"

#include <OpenEXR/ImfAttribute.h>
#include <OpenEXR/ImfHeader.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace darkroom {
namespace {

bool is_of_the_file(std::string_view name) {
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
    return std::ranges::find(layout, name) != layout.end() || name.starts_with("darkroom:light");
}

}  // namespace

ExrAttributes::ExrAttributes(const Imf::Header& header) : kept_(std::make_unique<Imf::Header>()) {
    for (auto found = header.begin(); found != header.end(); ++found)
        if (!is_of_the_file(found.name())) kept_->insert(found.name(), found.attribute());
}

ExrAttributes::~ExrAttributes() = default;

void ExrAttributes::add_to(Imf::Header& header) const {
    for (auto found = kept_->begin(); found != kept_->end(); ++found) {
        // Every header has these, at values that say nothing.
        const std::string_view name = found.name();
        const bool is_default =
            name == "pixelAspectRatio" || name == "screenWindowCenter" || name == "screenWindowWidth";
        if (is_of_the_file(name) || (!is_default && header.find(found.name()) != header.end())) continue;
        header.insert(found.name(), found.attribute());
    }
}

}  // namespace darkroom
