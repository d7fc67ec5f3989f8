// SPDX-License-Identifier: MIT
#pragma once
// Images of the device into main memory, within somebody's recording: the picture a Composer made, the layers it was
// given, the picture of a renderer. For headless work; it waits for nothing by itself and reads no files.

#include <cstdint>
#include <darkroom/device.hpp>
#include <darkroom/frame.hpp>
#include <darkroom/reference.hpp>
#include <functional>
#include <optional>
#include <vector>

#include "gpu/resource/resources.hpp"

namespace darkroom {

/// Layers of a frame, row-major, top row first; the ones that were not given are empty.
struct FrameLayers {
    VkExtent2D extent{};
    std::vector<float> color;         ///< red, green, blue, alpha
    std::vector<float> depth;         ///< one number a pixel
    std::vector<float> normals;       ///< x, y, z
    std::vector<float> velocity;      ///< x, y
    std::vector<float> transparency;  ///< red, green, blue
    std::vector<ReferenceLight> lights;
};

/// A finished picture: `bytes` or `pixels`, four a pixel.
struct DevelopedPicture {
    VkExtent2D extent{};
    std::vector<std::uint8_t> bytes;
    std::vector<float> pixels;
};

/// One image and the buffer it is copied to: RGBA8, BGRA8, 16- and 32-bit floats, or 32-bit depth. Of an array all
/// layers that the reference has, one after the other.
class Readback {
  public:
    [[nodiscard]] static Result<Readback> create(gpu::Context& context, const ImageRef& image);
    /// The image must be in its layout, written by whatever came before, and is left in it, for anything that comes.
    void record(VkCommandBuffer commands) const;
    /// The rest when the recording has finished. `channels`: the first of the image's; floats as they are, bytes / 255.
    [[nodiscard]] std::vector<float> floats(std::uint32_t channels) const;
    /// Only of RGBA8 and BGRA8: red, green, blue, alpha.
    [[nodiscard]] std::vector<std::uint8_t> bytes() const;
    [[nodiscard]] VkExtent2D extent() const { return image_.used_region().extent; }

  private:
    gpu::Context* context_ = nullptr;
    ImageRef image_;
    gpu::Buffer buffer_;
};

/// The layers of a frame, all of them, and its lights.
class FrameReadback {
  public:
    [[nodiscard]] static Result<FrameReadback> create(gpu::Context& context, const Frame& frame);
    void record(VkCommandBuffer commands) const;
    [[nodiscard]] FrameLayers layers() const;

  private:
    VkExtent2D extent_{};
    std::optional<Readback> color_, depth_, normals_, velocity_, transparency_;
    std::vector<Light> lights_;
    std::vector<std::optional<Readback>> cascades_;  ///< of each light
};

using RecordBefore = std::function<Result<>(VkCommandBuffer)>;

/// Records `before`, submits, waits and reads. The images are looked at as `before` leaves them.
[[nodiscard]] Result<FrameLayers> read_layers(Device& device, const Frame& frame, const RecordBefore& before);

/// The same for one RGBA8 or float image with four channels.
[[nodiscard]] Result<DevelopedPicture> read_picture(Device& device, const ImageRef& image, const RecordBefore& before);

}  // namespace darkroom
