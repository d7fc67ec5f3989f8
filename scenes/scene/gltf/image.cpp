// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "scene/gltf/convert.hpp"
#include "scene/image_batch.hpp"

namespace darkroom::scene::gltf {

Result<std::vector<Image>> convert_images(Document& document) {
    const std::vector<ImageSource>& sources = document.images();
    std::vector<EncodedImage> encoded;
    for (const ImageSource& source : sources)
        encoded.push_back({.name = source.name, .bytes = source.bytes, .file = source.file});
    std::vector<Result<Image>> decoded = decode_images(encoded);
    std::vector<Image> images;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (sources[i].fault.empty() && decoded[i]) {
            images.push_back(std::move(*decoded[i]));
            continue;
        }
        // What this machine cannot open now, another or a later run can.
        if (sources[i].fault.empty() && decoded[i].error().fault == Fault::Machine)
            return machine_error(fmt::format("{}: {}", sources[i].shown, decoded[i].error().text));
        images.push_back({.name = sources[i].name});
        const std::string fault = sources[i].fault.empty()
                                      ? fmt::format("{}: {}", sources[i].shown, decoded[i].error().text)
                                      : sources[i].fault;
        document.faults().warn(fmt::format("{}; it is drawn white", fault));
    }
    return images;
}

}  // namespace darkroom::scene::gltf
