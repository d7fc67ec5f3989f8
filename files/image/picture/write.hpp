// SPDX-License-Identifier: MIT
#pragma once
// Pictures into image files. The extension decides the kind of file; the numbers are written as they are given: encoded
// values for integer files, which say that they are sRGB, linear Rec. 709 ones for float files, or those of another
// space. Nothing is tone-mapped or encoded here. A file appears whole or not at all.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "image/codec/decoder.hpp"
#include "image/color/output_space.hpp"
#include "image/frame/kept_layers.hpp"
#include "image/picture/picture.hpp"
#include "image/table/color_chain.hpp"

namespace darkroom {

struct WriteOptions {
    /// Not given: 8-bit for PNG, JPEG and TIFF, 16-bit where another space than sRGB is, half for OpenEXR, float for
    /// Radiance HDR.
    std::optional<SampleKind> samples;
    /// False: the file has no alpha channel, which is opaque everywhere. Colours of floats are given multiplied by it,
    /// and OpenEXR and TIFF say so; those of integers are not, as PNG wants it.
    bool alpha = false;
    bool has_alpha_of_glow = false;  ///< of files of integers: see make_alpha_of_glow
    std::optional<int> quality;      ///< JPEG: 1 to 100, not given: 95
    std::string chroma;              ///< JPEG: see EncodeDesc
    /// PNG: a level, 0 to 12; TIFF: none, packbits, lzw, zip; OpenEXR: none, rle, zips, zip, piz, pxr24, b44, b44a,
    /// dwaa, dwab. Empty: PNG fast, the others zip.
    std::string compression;
    bool is_cropped = false;                          ///< the picture shows another part of the scene than that frame
    bool is_stretched = false;                        ///< its pixels have another shape
    std::shared_ptr<const ExrAttributes> attributes;  ///< of the frame that the picture was made of: into OpenEXR files
    /// The display window, in pixels of the picture, which becomes the data window of OpenEXR files; nothing: both are
    /// it.
    std::optional<PixelWindow> display;
    std::shared_ptr<const KeptLayers> layers;  ///< of that frame, into OpenEXR files of its size; null: none
    /// For pictures of linear Rec. 709: integer files get what this makes of it, and do not say that they are sRGB.
    std::shared_ptr<const ColorChain> view;
    /// What the numbers are; not given: sRGB, and linear Rec. 709 in files of floats. PNG and OpenEXR alone say it.
    std::optional<OutputSpace> space;
    /// JPEG of sRGB: the same picture in linear light, as a brighter display has it, for a gain map; null: none.
    std::shared_ptr<const Picture> light;
    std::size_t max_threads = 0;  ///< that compress, 0: as many as there are processors
    bool follows_links =
        true;  ///< false: the name is not one that the user typed for the picture; see core/own_file.hpp
};

/// The format that a path's extension, in any case, asks for.
[[nodiscard]] Result<const FileFormat*> written_format(const std::filesystem::path& path);

/// The kind of samples that would be written; an error if the format cannot hold what the options ask for, or knows no
/// such quality or compression. Lets a program refuse before it has computed the picture.
[[nodiscard]] Result<SampleKind> sample_kind(const std::filesystem::path& path, const WriteOptions& options);

/// What files of such samples hold, where the options name a space.
[[nodiscard]] std::optional<ColorState> color_of(const WriteOptions& options, SampleKind samples);

/// How many pixels have light that their compression cannot hold, and that is clamped before it packs: DWA keeps
/// halves, and rounds.
[[nodiscard]] std::uint64_t clamped_by_compression(const std::filesystem::path& path, const Picture& picture,
                                                   const WriteOptions& options);

/// Integer files clamp to 0..1 and round to nearest; half and Radiance clamp to what they can hold; NaN is written as
/// 0.
[[nodiscard]] Result<> write_picture(const std::filesystem::path& path, const Picture& picture,
                                     const WriteOptions& options = {});

/// The same for four bytes a pixel, already encoded, into a format of integers. `rgba.size()` must be width * height
/// * 4.
[[nodiscard]] Result<> write_bytes(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                                   std::span<const std::uint8_t> rgba, const WriteOptions& options = {});

}  // namespace darkroom
