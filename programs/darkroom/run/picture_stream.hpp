// SPDX-License-Identifier: MIT
#pragma once
// Pictures through standard output into another program: what `-o -` means.

#include <darkroom/result.hpp>
#include <optional>
#include <string_view>

#include "develop/developer.hpp"
#include "image/picture/video_frame.hpp"
#include "image/picture/write.hpp"

namespace app {

/// What stands for the output's name.
inline constexpr std::string_view stream_name = "-";

struct StreamDesc {
    darkroom::VideoFormat format = darkroom::VideoFormat::Y4m;
    darkroom::FrameRate rate;
    bool has_alpha = false, has_alpha_of_glow = false;  ///< as of WriteOptions
};

/// Pictures are packed by any thread, and written in their order by one at a time.
class PictureStream {
  public:
    /// Standard output is the stream's alone from here on, and a reader that ends is an error, not a signal.
    explicit PictureStream(const StreamDesc& desc);
    [[nodiscard]] std::vector<std::byte> pack(darkroom::DevelopedPicture picture) const;
    /// Errors: the picture has another size than the first, in the words of `name`; nobody reads any more.
    [[nodiscard]] darkroom::Result<> write(std::span<const std::byte> packed, VkExtent2D extent, std::string_view name);

  private:
    StreamDesc desc_;
    std::optional<VkExtent2D> extent_;
};

}  // namespace app
