// SPDX-License-Identifier: MIT
#pragma once
// An Inspector without a host: pictures in main memory, one after the other, and the values of pixels.

#include "develop/developer.hpp"
#include "develop/inspect/inspector.hpp"

namespace darkroom {

/// Where values that are not finite first appear in the whole picture.
struct NonFiniteBirth {
    std::optional<std::size_t> entry;  ///< of InspectedPixel::entries; none: the scene has them already
    VkOffset2D at{};                   ///< that is nearest to the pixel that was asked about, in pixels of the frame
    std::uint64_t pixels = 0;          ///< how many there are, in pixels of the frame
};

class Prober {
  public:
    /// The device must be one that the library created. Of `desc`, the target and the kernels count.
    Prober(Device& device, const DevelopDesc& desc, std::uint32_t max_pixels);
    Prober(Prober&&) noexcept;
    Prober& operator=(Prober&&) noexcept;
    ~Prober();

    /// How many can be asked about at once in such a stack.
    [[nodiscard]] static std::size_t max_pixels(const Composer& composer);
    /// Runs one frame of the stack, and waits.
    [[nodiscard]] Result<Inspection> probe(const Composer& composer, const DevelopInput& input,
                                           std::span<const VkOffset2D> pixels);
    /// Looks for them in every output of the frame that probe() ran last, which is run again for each: an effect that
    /// reads around its pixels may have brought one from far. None: all outputs are finite.
    [[nodiscard]] Result<std::optional<NonFiniteBirth>> find_birth(const Composer& composer, const DevelopInput& input,
                                                                   VkOffset2D from);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace darkroom
