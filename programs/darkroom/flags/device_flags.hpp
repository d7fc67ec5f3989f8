// SPDX-License-Identifier: MIT
#pragma once
// The flags that say where and how the work is done, and texts of flags to values.

#include <darkroom/device.hpp>
#include <optional>
#include <string>

#include "develop/developer.hpp"
#include "flags.hpp"
#include "image/picture/resize.hpp"
#include "image/picture/video_frame.hpp"
#include "image/picture/write.hpp"

namespace app {

class DeviceFlags {
  public:
    void add_to(CommandFlags command);
    [[nodiscard]] darkroom::Result<darkroom::KernelStage> stage() const;
    [[nodiscard]] darkroom::Result<darkroom::Device> create() const;
    /// For what runs no kernel: an assumed device, unless --device names one.
    [[nodiscard]] darkroom::Result<darkroom::Device> create_if_named() const;
    /// For what compiles kernels and runs none: null devices, too.
    [[nodiscard]] darkroom::Result<darkroom::Device> create_compiler() const;
    [[nodiscard]] const std::string& name() const { return device_; }
    [[nodiscard]] bool is_fused() const { return !is_unfused_; }

  private:
    std::string device_;
    std::string kernels_ = "auto";
    bool is_unfused_ = false;
};

/// "1920x1080". Each side at least 1.
[[nodiscard]] darkroom::Result<VkExtent2D> parse_size(const std::string& text, std::string_view flag = "--size");
/// The same with what becomes of another ratio behind it: "1280x1280:fill".
[[nodiscard]] darkroom::Result<darkroom::NewSize> parse_new_size(const std::string& text);
/// "8", "16", "half", "float".
[[nodiscard]] darkroom::Result<darkroom::SampleKind> parse_bits(const std::string& text);
[[nodiscard]] darkroom::DevelopTarget target_for(darkroom::SampleKind samples);
/// What such files are made of: encoded pictures, or for a view of a display linear ones.
[[nodiscard]] darkroom::DevelopTarget target_for(darkroom::SampleKind samples, const darkroom::WriteOptions& options);
[[nodiscard]] darkroom::DevelopTarget target_for(darkroom::VideoFormat format);
/// Exit code 2 if the validation layer has spoken.
[[nodiscard]] int finish(const darkroom::Device& device, int code);

}  // namespace app
