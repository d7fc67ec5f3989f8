// SPDX-License-Identifier: MIT
#pragma once
// What OpenImageIO does here: rare TIFF files are read by it, JPEG and TIFF written, pictures
// resampled. It brings some 250 shared libraries, which take five times as long to load as the program; so it is a
// module of its own, loaded when it is first needed, and this is all that both sides know of each other.

#include <cstdint>
#include <darkroom/result.hpp>
#include <memory>
#include <span>
#include <vector>

#include "formats/file_format.hpp"

namespace darkroom {

/// Four floats a pixel, rows from the top.
struct FloatPixels {
    std::uint32_t width = 0, height = 0;
    float* rgba = nullptr;
};

struct Codecs {
    /// Looks for all that is looked for once, before a process gives up files.
    void (*prepare)();
    Result<std::unique_ptr<PictureSource>> (*open)(const FileFormat& format, std::span<const std::byte> bytes);
    Result<std::vector<std::byte>> (*encode)(const FileFormat& format, const EncodeDesc& desc);
    /// By a triangle filter.
    Result<> (*resample)(const FloatPixels& from, const FloatPixels& to);
};

/// Loads the module the first time. The error is the machine's: the module is not where it was installed.
[[nodiscard]] Result<const Codecs*> codecs();

}  // namespace darkroom
