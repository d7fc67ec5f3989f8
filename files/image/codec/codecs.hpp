// SPDX-License-Identifier: MIT
#pragma once
// What OpenImageIO does here: Radiance and rare TIFF files are read by it, JPEG, TIFF and Radiance written, pictures
// resampled. It brings some 250 shared libraries, which take five times as long to load as the program; so it is a
// module of its own, loaded when it is first needed, and this is all that both sides know of each other.

#include <cstdint>
#include <darkroom/result.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "decoders/picture_source.hpp"

namespace darkroom {

/// A picture to encode: `samples` are of kind `kind`, rows from the top, `channels` a pixel (3, or 4 with alpha).
struct EncodeDesc {
    FileKind file = FileKind::Jpeg;
    SampleKind kind = SampleKind::Integer8;
    std::uint32_t width = 0, height = 0, channels = 3;
    std::optional<int> quality;  ///< JPEG, 1 to 100
    std::string chroma;          ///< JPEG: 4:4:4, 4:2:2 or 4:2:0; empty: by the quality
    bool is_associated = false;  ///< colours were multiplied by alpha, and the file says so
    std::string compression;     ///< TIFF: none, lzw, zip, packbits; empty: zip
    const void* samples = nullptr;
};

/// Four floats a pixel, rows from the top.
struct FloatPixels {
    std::uint32_t width = 0, height = 0;
    float* rgba = nullptr;
};

struct Codecs {
    /// Looks for all that is looked for once, before a process gives up files.
    void (*prepare)();
    Result<std::unique_ptr<PictureSource>> (*open)(FileKind kind, std::span<const std::byte> bytes);
    Result<std::vector<std::byte>> (*encode)(const EncodeDesc& desc);
    /// By a triangle filter.
    Result<> (*resample)(const FloatPixels& from, const FloatPixels& to);
};

/// Loads the module the first time. The error is the machine's: the module is not where it was installed.
[[nodiscard]] Result<const Codecs*> codecs();

}  // namespace darkroom
