// SPDX-License-Identifier: MIT
#pragma once
// The frames that subjects are tried on: a made scene with everything that a frame may bring, so that no effect is left
// out. Its numbers are such as images hold exactly, so GPU and references start from the same.

#include <array>
#include <cstdint>
#include <darkroom/reference.hpp>
#include <random>
#include <vector>

#include "develop/developer.hpp"
#include "develop/reference_chain.hpp"

namespace darkroom::verify {

// What a device may round, put into the numbers that a reference starts from.

/// By how much numbers are moved. Some drivers cut off what they round, so that all numbers err to one side.
struct Disturbance {
    enum class Toward : std::uint8_t { Zero, Infinity, EitherSide };
    double relative = 0;  ///< of each number
    double filter = 0;    ///< of the span of the texels around
    double absolute = 0;
    Toward toward = Toward::EitherSide;
};

/// The same numbers, each moved by as much as the disturbance says; those of the sky stay.
[[nodiscard]] ReferenceImage moved(const ReferenceImage& image, std::mt19937& random, const Disturbance& by);

inline constexpr std::uint32_t frame_count = 3;  ///< of a sequence, for effects with a history

class SceneFrame {
  public:
    /// Frame `number` of the sequence. `output`: of the picture that is made of it, where that is another: there is no
    /// interface then.
    SceneFrame(VkExtent2D extent, std::uint32_t number, VkExtent2D output = {});

    /// The same numbers, each moved at random.
    [[nodiscard]] SceneFrame disturbed(std::mt19937& random, const Disturbance& by) const;
    /// Both name the frame's own storage.
    [[nodiscard]] DevelopInput input() const;
    [[nodiscard]] ReferenceChainInput reference_input() const;
    [[nodiscard]] VkExtent2D output() const { return output_; }
    [[nodiscard]] VkExtent2D extent() const { return {color_.width, color_.height}; }
    [[nodiscard]] const ReferenceImage& color() const { return color_; }

  private:
    void make_layers(std::uint32_t number);
    void make_color();
    void make_ui();
    void make_light();
    void make_camera(std::uint32_t number);
    /// The floats that input() names, from the images.
    void keep_floats();

    std::uint32_t number_ = 0;
    VkExtent2D output_{};
    ReferenceImage color_, depth_, normals_, velocity_, reactive_, transparency_, exposure_, ui_;
    std::vector<float> color_floats_, depth_floats_, normal_floats_, velocity_floats_, reactive_floats_,
        transparency_floats_, exposure_floats_;
    std::vector<std::uint8_t> ui_bytes_;
    std::vector<ReferenceLight> lights_;
    Camera camera_{.depth = DepthKind::Planar};
};

}  // namespace darkroom::verify
