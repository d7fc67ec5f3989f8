// SPDX-License-Identifier: MIT
#pragma once
// The layers of a frame's file that the picture made of it does not replace: depth, normals, motion, mattes, light
// passes. They go into an OpenEXR file beside the picture, bit for bit.

#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "decoders/file_kind.hpp"
#include "image/frame/channels.hpp"

namespace darkroom {

struct KeptLayers {
    struct Channel {
        std::string name;  ///< with its part's name, where that is another part than the colour's
        SampleKind kind = SampleKind::Half;
        std::vector<float> values;  ///< rows from the top; 0 outside of the file's data window
    };
    std::uint32_t width = 0, height = 0;  ///< of the display window
    std::vector<Channel> channels;
    std::vector<std::string> warnings;  ///< of what cannot go along; one line each, without the file name
};

/// Every channel of an image file but its colour (as find_channels has it) and the shadows of its lights. Left out with
/// a warning: whole numbers of 32 bits, parts of another size, and names that are taken: R, G, B, A are the picture's.
/// The error text begins with the path. `max_threads`: that decode, 0: as many as there are processors.
[[nodiscard]] Result<KeptLayers> read_kept_layers(const std::filesystem::path& path, const LayerNames& names,
                                                  std::size_t max_threads = 0);

}  // namespace darkroom
