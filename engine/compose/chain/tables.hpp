// SPDX-License-Identifier: MIT
#pragma once
// The constant images of programs: tables of effects, pictures of the host and 1x1 neutral ones. Made at compile, those
// that the program before has taken over from it, uploaded by the first recording, never written again.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compose/worker.hpp"
#include "gpu/resource/resources.hpp"
#include "plan/program.hpp"

namespace darkroom::compose {

class Tables {
  public:
    /// `older`: of the program before, made of `older_images`; may be null.
    [[nodiscard]] static Result<Tables> create(gpu::Context& context, std::span<const plan::FixedImage> images,
                                               const Tables* older = nullptr,
                                               std::span<const plan::FixedImage> older_images = {});
    /// The first time: copies and barriers. Later: nothing. `recording` is the number of the recording it is for.
    void upload(VkCommandBuffer commands, std::uint64_t recording);
    /// What an upload was copied from, once no recording uses it: `recording` is the next one's number, and the last
    /// `unfinished` before it may still run. To be taken out and freed; null: nothing, or not yet.
    [[nodiscard]] std::unique_ptr<Garbage>* spent_staging(std::uint64_t recording, std::uint64_t unfinished);
    /// That recording will not be submitted: what it uploaded is uploaded again.
    void take_back(std::uint64_t recording);
    [[nodiscard]] gpu::Binding binding(std::size_t index) const;

  private:
    struct Table {
        gpu::Image image;
        VkDeviceSize offset = 0;
        VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        bool is_nearest = false;
    };
    struct Staging : Garbage {
        gpu::Buffer buffer;
    };
    /// Images that came together; freed with the last program that has one of them.
    struct Batch {
        gpu::Memory memory;  ///< of all images
        std::vector<Table> tables;
        std::unique_ptr<Garbage> staging;
        VkBuffer staged = VK_NULL_HANDLE;  ///< its buffer
        std::optional<std::uint64_t> uploaded_by;
    };
    struct Place {
        std::size_t batch = 0, table = 0;
    };
    [[nodiscard]] static Result<std::shared_ptr<Batch>> make(gpu::Context& context,
                                                             std::span<const plan::FixedImage* const> images);

    std::vector<std::shared_ptr<Batch>> batches_;
    std::vector<Place> places_;  ///< per image
};

/// Stands in for the shadow map of a light that a frame does not have: lit everywhere.
class LitShadowMap {
  public:
    LitShadowMap() = default;
    [[nodiscard]] static Result<LitShadowMap> create(gpu::Context& context);
    /// The first time, records its clearing. Does nothing for one that was not created.
    void upload(VkCommandBuffer commands, std::uint64_t recording);
    void take_back(std::uint64_t recording);
    ImageRef reference;

  private:
    gpu::Image image_;
    std::optional<std::uint64_t> uploaded_by_;
};

}  // namespace darkroom::compose
