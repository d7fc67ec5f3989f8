// SPDX-License-Identifier: MIT
#pragma once
// A whole stack by its CPU references alone, in double precision: the truth that the chain on the GPU is compared with,
// and what `develop --reference` runs. It needs no device, since Device::assumed() does for the Composer that holds the
// stack, and it is slow.

#include <array>
#include <darkroom/composer.hpp>
#include <darkroom/reference.hpp>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace darkroom {

/// What a stack carries from one frame to the next of a view.
struct ReferenceHistories {
    std::map<std::uint32_t, ReferenceHistory> entries;  ///< by Handle::id: of those that the last frame ran
    std::map<std::uint32_t, ReferenceImage> outputs;    ///< of those that are read one frame later
    /// Of the last frame, by entry: the picture that it got. One of another size starts its history anew.
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> sizes;
    Matrix camera{};  ///< its Camera::view
};

/// What a frame brings beside its colour: images by their kind, those that are not there null. As ReferenceInput has
/// them, and the interface encoded and premultiplied.
class ReferenceImages {
  public:
    ReferenceImages() = default;
    ReferenceImages(std::initializer_list<std::pair<FrameImage, const ReferenceImage*>> given) {
        for (const auto& [which, image] : given) images_[static_cast<std::size_t>(which)] = image;
    }
    [[nodiscard]] const ReferenceImage* operator[](FrameImage which) const {
        return images_[static_cast<std::size_t>(which)];
    }

  private:
    std::array<const ReferenceImage*, frame_image_count> images_{};
};

struct ReferenceChainInput {
    const ReferenceImage* color = nullptr;
    ReferenceImages images{};
    VkExtent2D target_extent{};  ///< as CompileDesc has it; (0, 0): as large as the picture at the end
    std::span<const ReferenceLight> lights;
    Camera camera;
    double time = 0;
    double delta_time = 0;  ///< as Frame has it
    std::uint64_t frame_index = 0;
    ReferenceHistories* histories = nullptr;   ///< null: a frame by itself
    bool is_color_associated = false;          ///< as CompileDesc has it
    std::optional<ColorState> target_color{};  ///< as CompileDesc has it; unset: what the two members below say
    Domain target_domain = Domain::Encoded;    ///< SceneLinear: encode and dither are skipped
    /// Whether a picture that the stack leaves unencoded is sRGB-encoded for an Encoded target: by a kernel or, for an
    /// SRGB format, by the format. The output is what such a target holds.
    bool encodes_target = true;
};

struct ReferenceChainOutput {
    ReferenceImage picture;             ///< not rounded
    std::vector<std::string> left_out;  ///< as in Plan
};

/// Errors name the entry: an effect without a reference, a second picture that is missing.
[[nodiscard]] Result<ReferenceChainOutput> run_reference(const Composer& composer, const ReferenceChainInput& input);

/// To 8 bits: clamped to [0, 1], rounded half up, NaN is 0.
[[nodiscard]] std::vector<std::uint8_t> round_to_bytes(const ReferenceImage& image);

}  // namespace darkroom
