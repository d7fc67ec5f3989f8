// SPDX-License-Identifier: MIT
#include "image/memory_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <optional>
#include <string_view>

#include "image/exr_check.hpp"
#include "image/jpeg_check.hpp"
#include "image/png_check.hpp"

namespace darkroom {
namespace {

// OpenImageIO 2.4 subtracts without asking whether the position is past the end, and its JPEG reader wants this very
// class, so the bounds are checked in a class derived from it.
class MemoryReader final : public OIIO::Filesystem::IOMemReader {
  public:
    explicit MemoryReader(std::span<const std::byte> bytes) : IOMemReader(bytes.data(), bytes.size()) {}

    size_t pread(void* buffer, size_t size, int64_t offset) override {
        const std::size_t available = m_buf.size();
        if (offset < 0 || static_cast<std::size_t>(offset) >= available) return 0;
        const std::size_t count = std::min(size, available - static_cast<std::size_t>(offset));
        std::memcpy(buffer, m_buf.data() + offset, count);
        return count;
    }
    size_t read(void* buffer, size_t size) override {
        const std::size_t count = pread(buffer, size, m_pos);
        m_pos += static_cast<int64_t>(count);
        return count;
    }
};

std::optional<FileKind> kind_of(std::span<const std::byte> bytes) {
    const std::string_view start(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 16));
    if (start.starts_with("\x76\x2f\x31\x01")) return FileKind::OpenExr;
    if (start.starts_with("\x89PNG\r\n\x1a\n")) return FileKind::Png;
    if (start.starts_with("\xff\xd8\xff")) return FileKind::Jpeg;
    if (start.starts_with("#?")) return FileKind::Radiance;
    const std::string_view tiff = start.substr(0, 4);
    if (tiff == std::string_view("II*\0", 4) || tiff == std::string_view("MM\0*", 4) ||
        tiff == std::string_view("II+\0", 4) || tiff == std::string_view("MM\0+", 4))
        return FileKind::Tiff;
    return std::nullopt;
}

const char* reader_of(FileKind kind) {
    switch (kind) {
        case FileKind::OpenExr:
            return "openexr";
        case FileKind::Png:
            return "png";
        case FileKind::Jpeg:
            return "jpeg";
        case FileKind::Tiff:
            return "tiff";
        case FileKind::Radiance:
            return "hdr";
    }
    return "";
}

Result<> check(FileKind kind, std::span<const std::byte> bytes) {
    if (kind == FileKind::OpenExr) return check_exr(bytes);
    if (kind == FileKind::Png) return check_png(bytes);
    if (kind == FileKind::Jpeg) return check_jpeg(bytes);
    return {};
}

}  // namespace

Result<MemoryInput> MemoryInput::open(std::span<const std::byte> bytes) {
    if (bytes.empty()) return user_error("is empty");
    const auto kind = kind_of(bytes);
    if (!kind) return user_error("is no image file that is known here (OpenEXR, PNG, JPEG, TIFF, Radiance HDR)");
    if (auto checked = check(*kind, bytes); !checked) return failure(std::move(checked));
    MemoryInput out;
    out.kind_ = *kind;
    out.memory_ = std::make_unique<MemoryReader>(bytes);
    try {
        out.input_ = OIIO::ImageInput::create(reader_of(*kind));
        if (!out.input_) return user_error(fmt::format("OpenImageIO was built without {}", name_of(*kind)));
        out.input_->set_ioproxy(out.memory_.get());
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);
        OIIO::ImageSpec spec;
        // The extension keeps readers content that also look at the name.
        if (!out.input_->open(fmt::format("memory.{}", reader_of(*kind)), spec, config))
            return user_error(fmt::format("cannot be read as {}: {}", name_of(*kind), out.reason()));
    } catch (const std::exception& exception) {
        return user_error(fmt::format("cannot be read as {}: {}", name_of(*kind), exception.what()));
    }
    return out;
}

std::string MemoryInput::reason() const {
    std::string message = one_printable_line(input_->geterror());
    for (const std::string_view name : {" from image file \"memory.openexr\"", "\"memory.openexr\": "})
        if (const std::size_t place = message.find(name); place != std::string::npos) message.erase(place, name.size());
    return message.empty() ? "damaged" : message;
}

}  // namespace darkroom
