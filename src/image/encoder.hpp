// SPDX-License-Identifier: MIT
#pragma once
// Internal to src/image: OpenImageIO descriptions and their samples made into a file. The codecs do not all notice a
// disk that is full, so what can be made in memory is made there and then written by write_file; the rest is looked
// over.

#include <OpenImageIO/imageio.h>

#include <darkroom/result.hpp>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "image/decoder.hpp"

namespace darkroom {

/// `samples` are of type `type`, rows from the top, `spec.nchannels` a pixel.
[[nodiscard]] Result<> encode_to_file(const std::filesystem::path& path, FileKind kind, const OIIO::ImageSpec& spec,
                                      OIIO::TypeDesc type, const void* samples);

/// A part of an OpenEXR file. Its samples are asked for when the parts before it have been written, and are not kept.
struct EncodedPart {
    OIIO::ImageSpec spec;  ///< with a name, "oiio:subimagename"
    std::function<std::vector<float>()> samples;
};
/// Several parts into one OpenEXR file.
[[nodiscard]] Result<> encode_parts_to_file(const std::filesystem::path& path, std::span<const EncodedPart> parts);

}  // namespace darkroom
