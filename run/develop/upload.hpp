// SPDX-License-Identifier: MIT
#pragma once
// Internal to run/develop and proof/verify: layers in main memory, what they become on the device, and the way there.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "develop/developer.hpp"
#include "gpu/resource/resources.hpp"

namespace darkroom {

/// A layer of the frame: what it is made of and where it goes. `values`, `codes` of sRGB, or `halves`, or `bytes` as
/// the image has them.
struct UploadLayer {
    const char* name = "";
    VkExtent2D extent{};
    std::span<const float> values;
    std::span<const std::uint16_t> halves;
    std::span<const std::uint8_t> bytes, codes;
    std::uint32_t given = 0;         ///< numbers a pixel in `values` and `codes`
    std::uint32_t given_halves = 0;  ///< numbers a pixel in `halves`
    std::uint32_t kept = 0;          ///< numbers a pixel in the image; three-component formats are rarely sampled
    VkFormat format = VK_FORMAT_UNDEFINED;
    bool is_half = false;

    [[nodiscard]] bool is_given() const {
        return !values.empty() || !halves.empty() || !bytes.empty() || !codes.empty();
    }
    [[nodiscard]] VkDeviceSize texel() const { return VkDeviceSize{kept} * (!bytes.empty() ? 1 : is_half ? 2 : 4); }
};
/// Colour, depth, normals, velocity, reactive mask, colour before transparency, exposure, interface.
using UploadLayers = std::array<UploadLayer, 8>;

/// Layers whose numbers are all halves are kept as halves. `output`: of the picture that is made; (0, 0): as the frame.
[[nodiscard]] UploadLayers layers_of(const DevelopInput& input, VkExtent2D output = {});
/// How images of such a format are used by what a Composer records.
[[nodiscard]] VkImageUsageFlags shader_usage(const gpu::Context& context, VkFormat format);
/// An image of ours as a Composer is told of it, with everything before it finished.
[[nodiscard]] ImageRef reference_to(const gpu::Image& image, VkImageLayout before, VkImageLayout after);

/// Images for layers and lights from main memory, and the buffers that fill them.
class FrameUpload {
  public:
    /// Forgets the layers: the next ones may be of another size or format.
    void reset() { layers_.reset(); }
    /// Makes what is missing and fills the buffers. What was recorded before has finished.
    [[nodiscard]] Result<> prepare(gpu::Context& context, const DevelopInput& input, const UploadLayers& layers);
    void record(const gpu::Context& context, VkCommandBuffer commands) const;
    /// The frame as record() leaves it, without a target.
    [[nodiscard]] Frame frame(const DevelopInput& input) const;

  private:
    struct Layers {
        std::array<std::optional<gpu::Image>, std::tuple_size_v<UploadLayers>> images;
        std::array<std::optional<gpu::Buffer>, std::tuple_size_v<UploadLayers>> buffers;
    };
    /// The cascades of one light, an array, and the buffer that fills it.
    struct Shadow {
        gpu::Image image;
        gpu::Buffer buffer;
        std::uint32_t resolution = 0, count = 0;
    };

    [[nodiscard]] static Result<Layers> make_layers(gpu::Context& context, const UploadLayers& layers);
    [[nodiscard]] static Result<Shadow> make_shadow(gpu::Context& context, const ReferenceLight& light);
    [[nodiscard]] Result<> prepare_lights(gpu::Context& context, std::span<const ReferenceLight> given);

    std::optional<Layers> layers_;
    std::vector<Shadow> shadows_;  ///< of the lights that have some
    std::vector<Light> lights_;    ///< of the frame that is being developed
};

}  // namespace darkroom
