// SPDX-License-Identifier: MIT
#include "picture_stream.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "image/picture/alpha.hpp"
#include "report.hpp"

namespace app {

using darkroom::Result;
using darkroom::VideoFormat;

namespace {

Result<> write_all(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return darkroom::machine_error(fmt::format("standard output: {}", std::strerror(errno)));
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

}  // namespace

PictureStream::PictureStream(const StreamDesc& desc) : desc_(desc) {
    leave_standard_output();
    survive_closed_pipes();
}

std::vector<std::byte> PictureStream::pack(darkroom::DevelopedPicture picture) const {
    if (desc_.has_alpha_of_glow) darkroom::make_alpha_of_glow(picture.pixels);
    return desc_.format == VideoFormat::Rgba64le ? darkroom::video_frame_16(picture.pixels, desc_.has_alpha)
                                                 : darkroom::video_frame(desc_.format, picture.bytes);
}

Result<> PictureStream::write(std::span<const std::byte> packed, VkExtent2D extent, std::string_view name) {
    if (!extent_) {
        const std::string head = video_head(desc_.format, extent.width, extent.height, desc_.rate);
        DARKROOM_TRY(write_all(std::as_bytes(std::span(head))));
        extent_ = extent;
    }
    if (extent_->width != extent.width || extent_->height != extent.height)
        return darkroom::user_error(fmt::format("{}: {}x{}, the stream is {}x{}; --size makes them the same", name,
                                                extent.width, extent.height, extent_->width, extent_->height));
    return write_all(packed);
}

}  // namespace app
