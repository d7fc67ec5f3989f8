// SPDX-License-Identifier: MIT
#pragma once
// Internal to src/image: an OpenImageIO description and its samples made into the bytes of a file. The file is made in
// memory and then written by write_file, because the codecs do not all notice a disk that is full.

#include <OpenImageIO/imageio.h>

#include <darkroom/result.hpp>
#include <filesystem>

#include "image/decoder.hpp"

namespace darkroom {

/// `samples` are of type `type`, rows from the top, `spec.nchannels` a pixel.
[[nodiscard]] Result<> encode_to_file(const std::filesystem::path& path, FileKind kind, const OIIO::ImageSpec& spec,
                                      OIIO::TypeDesc type, const void* samples);

}  // namespace darkroom
