// SPDX-License-Identifier: MIT
#pragma once
// An image file in memory whose structure has been read and whose samples have not. Third-party decoders read it in a
// confined process (image/confined).

#include <cstddef>
#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/files.hpp"
#include "formats/file_format.hpp"

namespace darkroom {

struct OpenedSource {
    const FileFormat* format = nullptr;
    std::unique_ptr<PictureSource> source;
};

/// Which format the first 16 bytes (or fewer) belong to.
[[nodiscard]] Result<const FileFormat*> format_of_file(std::span<const std::byte> start);

/// Bytes of an image file at most.
inline constexpr std::uintmax_t max_image_file = std::uintmax_t{4} << 30;

/// The bytes of a file whose first ones are those of a known format; no others are read to their end.
[[nodiscard]] Result<std::vector<std::byte>> read_image_file(const std::filesystem::path& path,
                                                             ReadFileOptions options = {});

enum class DecodingPlace {
    Confined,    ///< all of it in a confined process
    FramesHere,  ///< of OpenEXR the header here, and samples that are packed by ZIP or not at all: sequences are fast
};

/// Tells the format by its content, checks its structure and its sizes, and opens it. The bytes outlive the
/// source. `max_threads` decode one picture, 0: as many as there are processors. Errors name no file.
[[nodiscard]] Result<OpenedSource> open_source(std::span<const std::byte> bytes, std::size_t max_threads = 0,
                                               DecodingPlace place = DecodingPlace::Confined);

}  // namespace darkroom
