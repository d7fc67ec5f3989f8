// SPDX-License-Identifier: MIT
#pragma once
// A stored frame with every second or fourth pixel each way, to be developed while a hand moves its look.

#include <array>

#include "develop/upload.hpp"

namespace app {

class ReducedFrame {
  public:
    /// `input` and what it refers to stay as long as this. `divisor`: a power of two.
    ReducedFrame(const darkroom::DevelopInput& input, std::uint32_t divisor);

    /// Its extent is the reduced one; its layers are those of layers().
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
