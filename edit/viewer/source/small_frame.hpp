// SPDX-License-Identifier: MIT
#pragma once
// A stored frame with fewer pixels, to be developed while a hand moves its look, and for pictures of effects.

#include <array>

#include "develop/upload.hpp"

namespace app {

class SmallFrame {
  public:
    /// `input` and what it refers to stay as long as this. Each pixel is the one in the middle of those it stands for.
    SmallFrame(const darkroom::DevelopInput& input, VkExtent2D extent);

    /// Refers to layers(), whose formats are those of the whole frame.
    [[nodiscard]] const darkroom::DevelopInput& input() const { return input_; }
    [[nodiscard]] const darkroom::UploadLayers& layers() const { return layers_; }

  private:
    darkroom::DevelopInput input_;
    darkroom::UploadLayers layers_;
    struct Kept {
        std::vector<float> values;
        std::vector<std::uint16_t> halves;
        std::vector<std::uint8_t> bytes, codes;
    };
    std::array<Kept, std::tuple_size_v<darkroom::UploadLayers>> kept_;
};

}  // namespace app
