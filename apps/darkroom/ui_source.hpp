// SPDX-License-Identifier: MIT
#pragma once
// The interface that commands put over their pictures: a file, drawn at each picture's size.

#include <vulkan/vulkan.h>

#include <cstdint>
#include <darkroom/look.hpp>
#include <darkroom/result.hpp>
#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

namespace app {

class UiSource {
  public:
    /// Of a look as LookFlags gives it.
    explicit UiSource(const darkroom::Look& look) : file_(look.ui ? look.ui->document : std::string()) {}
    /// As DevelopInput::ui has it; empty: there is none. From any thread.
    [[nodiscard]] darkroom::Result<std::shared_ptr<const std::vector<std::uint8_t>>> picture(VkExtent2D extent);

  private:
    std::filesystem::path file_;
    std::mutex drawing_;
    VkExtent2D extent_{};
    std::shared_ptr<const std::vector<std::uint8_t>> picture_ = std::make_shared<const std::vector<std::uint8_t>>();
};

}  // namespace app
