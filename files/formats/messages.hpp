// SPDX-License-Identifier: MIT
#pragma once
// What a program and its darkroom_decode say to each other: a request, its places, and with it up to two files, that of
// the picture where the process does not have it open, and memory for samples where it has none as large; a reply, and
// behind it the text of an error or a description of the picture. Samples lie in the memory pixel by pixel, those of
// one pixel in the order of the places, each as wide as the widest of them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/file_part.hpp"

namespace darkroom {

struct DecodeRequest {
    std::uint64_t source = 0;       ///< a number of the program's for the picture
    std::uint64_t file_size = 0;    ///< bytes; 0: it is open already, and no file comes with this
    std::uint64_t memory_size = 0;  ///< bytes; 0: that of the last request is large enough
    std::uint32_t format = 0;       ///< in all_formats()
    std::uint32_t max_threads = 0;
    std::uint32_t max_seconds = 0;              ///< after which darkroom_decode ends itself
    std::uint32_t part = 0, row = 0, rows = 0;  ///< no rows: to be described
    std::uint32_t place_count = 0;
};
struct DecodePlace {
    std::uint32_t channel = 0;
    std::uint32_t kind = 0;  ///< SampleKind
};
enum class DecodeOutcome : std::uint32_t {
    Done,
    Error,
    NeedsOpenImageIo,  ///< a process that has it may read the picture
};
struct DecodeReply {
    DecodeOutcome outcome = DecodeOutcome::Done;
    std::uint32_t size = 0;  ///< bytes behind it
};

/// The largest description, and error: attributes of OpenEXR have 32 MiB (formats/exr/exr_check.hpp).
inline constexpr std::uint32_t max_reply_bytes = std::uint32_t{256} << 20;
/// Channels that are read at once.
inline constexpr std::uint32_t max_places = 1024;

struct PictureDescription {
    struct Attribute {
        std::string name;
        std::vector<double> numbers;
    };
    struct Part {
        FilePart part;
        std::uint32_t row_unit = 1;
        std::vector<Attribute> attributes;
    };
    std::vector<Part> parts;
};

[[nodiscard]] std::vector<std::byte> packed(const PictureDescription& description);
/// Nothing where the bytes are no description, or one that no file of ours has: counts, sides and places are those that
/// are allowed of files.
[[nodiscard]] std::optional<PictureDescription> unpacked(std::span<const std::byte> bytes);

}  // namespace darkroom
