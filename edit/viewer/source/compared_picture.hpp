// SPDX-License-Identifier: MIT
#pragma once
// A picture of a file, to be compared with what is shown: as it is, through no look.

#include <filesystem>

#include "develop/upload.hpp"
#include "image/picture/display_picture.hpp"
#include "window/pane.hpp"

namespace app {

class ComparedPicture {
  public:
    /// What was read of a file becomes an image of the device. Errors: VkResult.
    [[nodiscard]] static darkroom::Result<ComparedPicture> create(darkroom::Device& device,
                                                                  darkroom::ComparablePicture picture);
    /// Before it is shown; uploads it once.
    void record(const darkroom::Device& device, VkCommandBuffer commands);
    [[nodiscard]] darkroom::window::PaneView pane() const;

  private:
    darkroom::ComparablePicture picture_;
    darkroom::FrameUpload upload_;
    darkroom::ImageRef image_;
};

/// Is it one that is shown, and no look?
[[nodiscard]] bool is_picture_file(const std::filesystem::path& file);

}  // namespace app
