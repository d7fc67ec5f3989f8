// SPDX-License-Identifier: MIT
#pragma once
// The layers of a frame's file that the picture made of it does not replace: depth, normals, motion, mattes, light
// passes, the other eye. They go into an OpenEXR file beside the picture, bit for bit, in the parts that they came in.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/primaries.hpp"
#include "formats/file_part.hpp"
#include "image/exr/attributes.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {

struct KeptLayers {
    struct Channel {
        std::string name;  ///< as the file has it
        SampleKind kind = SampleKind::Half;
        std::vector<float> values;  ///< of the part's window, rows from the top
    };
    struct Part {
        std::string name;
        PixelWindow window;              ///< of its data, in pixels of the display window
        std::vector<std::string> views;  ///< that its channels are of
        std::vector<Channel> channels;
        std::shared_ptr<const ExrAttributes> attributes;
    };
    std::uint32_t width = 0, height = 0;  ///< of the display window
    std::vector<Part> parts;              ///< in the order of the file
    std::size_t color_part = 0;           ///< of `parts`: where the picture goes; its window is the display window
    std::string color_prefix;             ///< of the picture's channels: "right.", where the file has eyes as channels
    std::optional<Chromaticities> primaries;  ///< of layers in colour, where there are any and the file says
    std::vector<std::string> warnings;        ///< of what cannot go along; one line each, without the file name
};

/// Every channel of an image file but its colour (as find_channels has it) and the shadows of its lights. What the
/// colour's part has outside of its data window is 0, and sky where it is a depth. Left out with a warning: whole
/// numbers of 32 bits, parts of another size, and names that are the picture's. The error text begins with the path.
[[nodiscard]] Result<KeptLayers> read_kept_layers(const std::filesystem::path& path, const FrameOptions& options);

}  // namespace darkroom
