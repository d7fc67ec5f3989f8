// SPDX-License-Identifier: MIT
#pragma once
// Internal to files/image: the channels of a frame's layers from the parts of a file into planes as large as the
// display window, each part read once.

#include <cstddef>
#include <cstdint>
#include <darkroom/result.hpp>
#include <span>
#include <string_view>

#include "image/codec/decoder.hpp"
#include "image/frame/channels.hpp"

namespace darkroom {

/// A layer and the plane that its channels go to, `components` samples of kind `kind` a pixel.
struct LayerPlace {
    ChannelSet source;  ///< components beyond `components`, and those that are -1, stay as they are in the plane
    std::uint32_t components = 0;
    SampleKind kind = SampleKind::Float;
    std::byte* plane = nullptr;
    std::uint32_t read = 4;  ///< how many of `source` are read at most
};

/// Are the first `components` of it numbers that are no integers, in a display window of this size? `what` names it.
[[nodiscard]] Result<> check_layer(const FilePart& part, const ChannelSet& set, std::uint32_t components,
                                   std::string_view what, std::uint32_t width, std::uint32_t height);

/// What lies outside the data window stays as it is, what lies outside the display window is left out. Errors as those
/// of Decoder::read_rows.
[[nodiscard]] Result<> read_layers(Decoder& decoder, std::span<const LayerPlace> layers);

}  // namespace darkroom
