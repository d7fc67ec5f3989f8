// SPDX-License-Identifier: MIT
#pragma once
// The images of the frame that a file's functions may name, and how they are made.

#include <array>
#include <darkroom/effect.hpp>
#include <string_view>

#include "shared/scene_images.hpp"

namespace darkroom::custom {

struct FrameImageRow {
    std::string_view need_name;
    bool Needs::*need;
    std::string_view name;  ///< in GLSL
    PassImage (*make)(PassBuilder&);
    PassVector neutral;
};

inline constexpr std::array<FrameImageRow, 5> frame_images{
    {{"depth", &Needs::depth, "frame_depth", linear_depth, {1e10f, 0, 0, 0}},
     {"normals",
      &Needs::normals,
      "frame_normals",
      [](PassBuilder& builder) { return view_normals(builder, NormalSource::Image); },
      {}},
     {"velocity", &Needs::velocity, "frame_velocity", [](PassBuilder& builder) { return velocity(builder); }, {}},
     {"ui", &Needs::ui, "frame_ui", [](PassBuilder& builder) { return builder.frame_image(FrameImage::Ui); }, {}},
     {"shadows", &Needs::shadows, "frame_shadow", [](PassBuilder& builder) { return builder.shadow_map(0); }, {}}}};

}  // namespace darkroom::custom
