// SPDX-License-Identifier: MIT
#pragma once
// What the host reads of a plan's values: each recording copies them into a place of its own, and the next one in that
// place, which is made when this one has finished, keeps them for whoever asks.

#include <darkroom/composer.hpp>
#include <span>
#include <vector>

#include "gpu/resource/resources.hpp"
#include "plan/program.hpp"

namespace darkroom::compose {

class ValueCopies {
  public:
    struct Recording {
        std::uint64_t number = 0;  ///< counted from 1; 0: there was none
        std::uint64_t frame_index = 0;
        std::uint32_t view = 0;
    };
    [[nodiscard]] static Result<ValueCopies> create(gpu::Context& context,
                                                    std::span<const plan::Program::NamedValue> values,
                                                    std::uint32_t slots);
    /// Keeps what the last recording of the slot left.
    void begin(std::uint32_t slot);
    /// Copies one value from a buffer that a copy may read.
    void record(VkCommandBuffer commands, std::uint32_t slot, std::size_t value, VkBuffer from,
                VkDeviceSize offset) const;
    /// The host will read what was copied.
    void end(VkCommandBuffer commands, std::uint32_t slot, const Recording& recording);
    void take_back(std::uint32_t slot);
    /// Of the newest recording of the view that begin() kept.
    [[nodiscard]] ValueReading find(std::size_t value, std::uint32_t view) const;

  private:
    gpu::Context* context_ = nullptr;
    gpu::Buffer buffer_;
    std::vector<std::size_t> first_;         ///< per value: its first number in a slot; then how many there are
    std::vector<Recording> written_, kept_;  ///< per slot
    std::vector<float> numbers_;             ///< of the kept ones
};

}  // namespace darkroom::compose
