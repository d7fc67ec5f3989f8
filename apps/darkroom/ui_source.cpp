// SPDX-License-Identifier: MIT
#include "ui_source.hpp"

#include "image/ui_image.hpp"

namespace app {

darkroom::Result<std::shared_ptr<const std::vector<std::uint8_t>>> UiSource::picture(VkExtent2D extent) {
    const std::lock_guard lock(drawing_);
    const bool is_drawn = extent.width == extent_.width && extent.height == extent_.height;
    if (file_.empty() || is_drawn) return picture_;
    auto made = darkroom::read_ui_image(file_, extent.width, extent.height);
    if (!made) return failure(std::move(made));
    picture_ = std::make_shared<const std::vector<std::uint8_t>>(std::move(*made));
    extent_ = extent;
    return picture_;
}

}  // namespace app
