// SPDX-License-Identifier: MIT
#pragma once
// Which channels of a file are the colour, the depth, the normals and the motion of a frame. It works on names alone:
// those of Darkroom, Blender and V-Ray are known, a caller's mapping goes before them.

#include <array>
#include <cstdint>
#include <darkroom/result.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/codec/decoder.hpp"

namespace darkroom {

/// Samples of an image that is read: 4 GiB, what a picture of four channels may have.
inline constexpr std::uint64_t max_samples = std::uint64_t{1} << 30;

/// Channels of one part, by their index there; -1: none. Colour: red, green, blue, alpha. Depth: the first only.
struct ChannelSet {
    std::size_t part = 0;
    std::array<int, 4> channels{-1, -1, -1, -1};
    std::string prefix;  ///< the layer's name, without the component: "ViewLayer.Depth", "" for plain R, G, B
};

struct FrameChannels {
    ChannelSet color;
    bool is_gray = false;  ///< red, green and blue are the same channel
    std::optional<ChannelSet> depth;
    std::optional<ChannelSet> normals;
    std::optional<ChannelSet> velocity;
    std::optional<ChannelSet> reactive;      ///< the first channel only
    std::optional<ChannelSet> transparency;  ///< red, green, blue
    bool is_velocity_y_up = false;           ///< Blender's Vector pass
    bool is_depth_along_ray = false;         ///< Mitsuba's NAME.T: the ray's length from the near clip, 0: nothing
    float depth_scale = 1;                   ///< metres for each unit, as far as the layer's name tells
    std::vector<std::string> views;          ///< of a stereo picture, if there are several
    std::string view;                        ///< that the colour is of; may be empty
    std::vector<std::string> other_colors;   ///< layers that might as well be the colour, where no name decided
    std::vector<std::string> left_out;       ///< of layers that look like one of these: why they are not, in a sentence
};

/// What the caller calls the layers: "color", "depth", "normals" or "velocity" to a channel or to what is before the
/// dot. no_layer: the frame is read without it.
using LayerNames = std::map<std::string, std::string, std::less<>>;
inline constexpr std::string_view no_layer = "none";

/// Does the part hold the cascades of a light? It is shadow0, shadow1 and so on, with channels cascade0, cascade1 and
/// so on alone, and is no layer of the frame.
[[nodiscard]] bool is_shadow_part(const FilePart& part);

/// Every channel of the file by its full name, part name first where the file has several parts.
[[nodiscard]] std::vector<std::string> channel_names(std::span<const FilePart> parts);

/// Of several layers in colour the first of these is it: R, G, B of a file of one part; Composite; Combined; rgba; rgb;
/// C; beauty; default; R, G, B of the first part; Y alone; the first layer with colour. Red, green, blue and alpha in
/// full are R, G, B, A. Parts with shadows are passed over, unless a mapping names one of their channels. `view`: of a
/// stereo picture; empty: the first that has a colour. An error names the channels that were found and what was looked
/// for, without the file name.
[[nodiscard]] Result<FrameChannels> find_channels(std::span<const FilePart> parts, const LayerNames& names,
                                                  const std::string& view = {});

/// Adds "depth=NAME", "normals=PREFIX", "velocity=PREFIX" or "color=PREFIX".
[[nodiscard]] Result<> add_mapping(LayerNames& names, std::string_view mapping);

}  // namespace darkroom
