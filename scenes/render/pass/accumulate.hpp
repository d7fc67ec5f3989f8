// SPDX-License-Identifier: MIT
#pragma once
// The mean of a scene that is drawn several times, each time from another place within the pixel: anti-aliasing of all
// that is drawn, textures, sprites and light included. The layers beside the colour are those of the last place drawn.

#include <array>
#include <memory>
#include <vector>

#include "gpu/kernel/kernel.hpp"
#include "render/targets.hpp"
#include "scene/scene.hpp"

namespace darkroom::render {

/// So many places in a pixel, from its centre, in (-0.5, 0.5) pixels, x right and y down, the one nearest to the centre
/// first: the centre itself where their count is odd. They cover the pixel evenly, no two in one row or column, and their
/// mean is the centre, so that few of them move no edge: a lattice of rank 1 (Korobov 1959) about its origin, of 4 the
/// rotated grid.
[[nodiscard]] std::vector<scene::vec2> positions_in_pixel(std::uint32_t count);

class Accumulate {
  public:
    /// `positions`: [2, scene::max_samples]. `is_weighed`: of c / (1 + max c), else of light itself.
    [[nodiscard]] static Result<Accumulate> create(gpu::Context& context, VkFormat color, std::uint32_t positions,
                                                   bool is_weighed);
    /// Images as large as the targets, whose colour is what it works on; nothing of both is in use by the device.
    Result<> resize(const Targets& targets);
    /// Adds `color`, which is in the layout `from`: the place-th to be drawn, [0, positions).
    void record(VkCommandBuffer commands, const gpu::Image& color, VkImageLayout from, std::uint32_t place) const;
    /// Writes the mean into `color`, behind the last record(). It leaves it as use() says.
    void record_mean(VkCommandBuffer commands, const gpu::Image& color) const;
    [[nodiscard]] ResolveUse use() const;

  private:
    gpu::Context* context_ = nullptr;
    std::uint32_t positions_ = 0;
    bool is_weighed_ = true;
    /// Starts a sum, adds to one, turns it into the mean.
    std::unique_ptr<gpu::Kernel> first_, next_, mean_;
    gpu::DescriptorSets sets_;  ///< of first_, of next_ into each sum, of mean_
    gpu::Buffer blocks_;        ///< one a set
    VkDeviceSize block_stride_ = 0;
    std::array<gpu::Image, 2> sums_;  ///< one is read while the other is written
};

}  // namespace darkroom::render
