// SPDX-License-Identifier: MIT
#pragma once
// What hosts get wrong when they first give frames to an effect that gathers them: jitter that was left in the motion
// vectors, a sign, the direction of depth. Of numbers in main memory, once, while a host is being made; nothing for a
// frame loop.
//
//     for (const std::string& mistake : darkroom::check_temporal({.camera = camera, .extent = extent, .depth = depth,
//                                                                 .velocity = velocity}))
//         log(mistake);

#include <darkroom/frame.hpp>
#include <span>
#include <string>
#include <vector>

namespace darkroom {

/// A frame as its host has it, row by row from the top. What is empty is not looked at.
struct TemporalFrame {
    Camera camera;                    ///< as Frame::camera
    VkExtent2D extent{};              ///< of Frame::color
    std::span<const float> depth;     ///< the numbers of Frame::depth, as Camera::depth says
    std::span<const float> velocity;  ///< x, y of Frame::velocity, as Camera::velocity says
};

/// A sentence for each mistake that the frame shows, with what was found and what was told; empty: none. A camera that
/// stands still shows jitter in its vectors, one that moves shows signs and depth, too. Things that move by themselves
/// do no harm where most of the picture stands. Spans of another size than the extent's are a mistake, too.
[[nodiscard]] std::vector<std::string> check_temporal(const TemporalFrame& frame);

}  // namespace darkroom
