// SPDX-License-Identifier: MIT
#pragma once
// Headless developing: pictures in main memory, or on the device already, go through a Composer on a device of our own
// and come back. It uploads, records, submits, waits and reads back; it reads no files. What hosts do with their own
// command buffers is in darkroom/composer.hpp, and this does the same with buffers of its own.

#include <cstdint>
#include <darkroom/composer.hpp>
#include <darkroom/reference.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "develop/readback.hpp"

namespace darkroom {

/// Row-major, top row first. Empty spans: not given. Of a layer the floats, the halves or the codes are given.
struct DevelopInput {
    VkExtent2D extent{};
    std::span<const float> color;                                ///< red, green, blue, alpha; scene-linear Rec. 709
    std::span<const std::uint8_t> color_codes;                   ///< or the same as code values of sRGB
    std::uint32_t color_channels = 4;                            ///< 3: none of these has alpha, which is then 1
    bool is_color_associated = false;                            ///< as CompileDesc has it
    std::span<const float> depth;                                ///< planar distance
    std::span<const float> normals;                              ///< x, y, z
    std::span<const float> velocity;                             ///< x, y
    std::span<const float> reactive;                             ///< one a pixel
    std::span<const float> transparency;                         ///< red, green, blue
    std::span<const float> exposure;                             ///< one
    std::span<const std::uint16_t> color_halves, normal_halves;  ///< as color, x, y, z, 1 of normals
    std::span<const std::uint16_t> velocity_halves;              ///< two a pixel
    /// The interface: red, green, blue, alpha, sRGB-encoded, premultiplied after that; as large as the picture that is
    /// made, where DevelopDesc says how large that is.
    std::span<const std::uint8_t> ui;
    std::span<const ReferenceLight> lights;
    Camera camera;
    double time = 0;
    double delta_time = 0;  ///< as Frame has it
    std::uint64_t frame_index = 0;
};

/// A frame whose images are on the device, or will be when `record_before` has run.
struct DeviceFrame {
    Frame frame;                                                 ///< without target
    VkImageUsageFlags color_usage = VK_IMAGE_USAGE_SAMPLED_BIT;  ///< of the colour image
    VkImageUsageFlags layer_usage = VK_IMAGE_USAGE_SAMPLED_BIT;  ///< of depth, normals and velocity alike
    std::span<const std::uint8_t> ui;                            ///< as in DevelopInput, if frame.ui is not given
    RecordBefore record_before;                                  ///< goes first, in the same submission
};

/// Encoded8: bytes for the screen, in DevelopedPicture::bytes. EncodedFloat: the same before it is rounded, for 16-bit
/// files. SceneLinear: floats, encode and dither skipped.
enum class DevelopTarget : std::uint32_t { Encoded8, EncodedFloat, SceneLinear };

struct DevelopDesc {
    DevelopTarget target = DevelopTarget::Encoded8;
    /// What the picture is to be, in place of sRGB or linear Rec. 709.
    std::optional<ColorState> color{};
    /// Of the pictures that are made, where frames have another one: CompileDesc::target_extent. (0, 0): as the stack
    /// leaves them.
    VkExtent2D target_extent{};
    KernelStage kernels = KernelStage::Auto;
    bool fuse = true;
    /// Of DevelopInput: how many may be submitted before the first is finished. The Composer has as many.
    std::uint32_t frames_in_flight = 1;
};

/// What the Composer is compiled for, given an input and a target: also what `darkroom plan` plans. Layers whose
/// numbers are all halves are kept as halves, as a renderer has them: the kernels are then the same, and so are the
/// bits.
[[nodiscard]] CompileDesc compile_desc_for(Device& device, const DevelopInput& input, const DevelopDesc& desc);
[[nodiscard]] CompileDesc compile_desc_for(Device& device, const DeviceFrame& input, const DevelopDesc& desc);

/// Can this device hold images of this size?
[[nodiscard]] Result<> check_extent(Device& device, VkExtent2D extent);

class Developer {
  public:
    /// The device must be one that the library created: developing needs its queue.
    Developer(Device& device, const DevelopDesc& desc);
    Developer(Developer&&) noexcept;
    Developer& operator=(Developer&&) noexcept;
    ~Developer();

    /// Develops one picture: submit() and finish(). Nothing is in flight before.
    [[nodiscard]] Result<DevelopedPicture> develop(Composer& composer, const DevelopInput& input);
    /// Uploads and begins one; fewer than frames_in_flight are under way. Compiles the composer first where size or
    /// layers differ from the last one's, and waits for its leaner kernels. Where it fails, nothing was begun.
    [[nodiscard]] Result<> submit(Composer& composer, const DevelopInput& input);
    /// Waits for the oldest one that was begun, of at least one.
    [[nodiscard]] Result<DevelopedPicture> finish();
    [[nodiscard]] std::uint32_t in_flight() const;
    /// The same for images on the device: what draws them, the composer and the read-back are one submission. `layers`:
    /// where what the composer was given goes, if it is wanted.
    [[nodiscard]] Result<DevelopedPicture> develop(Composer& composer, const DeviceFrame& input,
                                                   FrameLayers* layers = nullptr);
    /// The plan of the last develop() or submit().
    [[nodiscard]] const Plan& plan() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace darkroom
