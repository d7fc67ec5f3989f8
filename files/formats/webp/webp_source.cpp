// SPDX-License-Identifier: MIT
#include "formats/webp/webp_source.hpp"

#include <fmt/format.h>
#include <webp/decode.h>

#include <cstring>

namespace darkroom {
namespace {

class WebpSource final : public PictureSource {
  public:
    WebpSource(std::span<const std::byte> bytes, const WebPBitstreamFeatures& features) : bytes_(bytes) {
        FilePart part{.channels = {"R", "G", "B"},
                      .width = static_cast<std::uint32_t>(features.width),
                      .height = static_cast<std::uint32_t>(features.height)};
        if (features.has_alpha != 0) part.channels.emplace_back("A");
        part.kinds.assign(part.channels.size(), SampleKind::Integer8);
        part.display_width = part.width;
        part.display_height = part.height;
        parts_.push_back(std::move(part));
    }

    std::vector<double> numbers(std::size_t /*part*/, std::string_view /*attribute*/) const override { return {}; }
    std::vector<std::string> attributes(std::size_t /*part*/) const override { return {}; }
    std::uint32_t row_unit(std::size_t /*part*/) const override { return 32; }

  private:
    [[nodiscard]] Result<> decode() {
        const FilePart& part = parts_[0];
        const std::size_t row = part.channels.size() * part.width;
        samples_.resize(row * part.height);
        const auto* const from = reinterpret_cast<const std::uint8_t*>(bytes_.data());
        const auto into = part.channels.size() == 4 ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
        if (into(from, bytes_.size(), samples_.data(), samples_.size(), static_cast<int>(row)) != nullptr) return {};
        samples_.clear();
        return user_error("damaged or truncated: its picture cannot be decoded");
    }

    Result<> read(std::size_t /*part*/, std::uint32_t row, std::uint32_t rows,
                  std::span<const SamplePlace> places) override {
        if (samples_.empty()) DARKROOM_TRY(decode());
        const std::size_t channels = parts_[0].channels.size(), width = parts_[0].width;
        for (const SamplePlace& place : places)
            for (std::uint32_t y = 0; y < rows; ++y) {
                const std::uint8_t* from = samples_.data() + (row + y) * width * channels + place.channel;
                std::byte* to = place.first + static_cast<std::ptrdiff_t>(y) * place.row_bytes;
                for (std::size_t x = 0; x < width; ++x, from += channels, to += place.pixel_bytes)
                    if (!put(*from, place.kind, to))
                        return user_error(fmt::format("8-bit integers are not read as {}", name_of(place.kind)));
            }
        return {};
    }

    static bool put(std::uint8_t value, SampleKind kind, std::byte* to) {
        if (kind == SampleKind::Integer8) {
            *to = std::byte{value};
        } else if (kind == SampleKind::Integer16) {
            const auto wide = static_cast<std::uint16_t>(value * 257);
            std::memcpy(to, &wide, sizeof(wide));
        } else if (kind == SampleKind::Float) {
            const float share = static_cast<float>(value) / 255;
            std::memcpy(to, &share, sizeof(share));
        } else {
            return false;
        }
        return true;
    }

    std::span<const std::byte> bytes_;
    std::vector<std::uint8_t> samples_;
};

}  // namespace

Result<std::unique_ptr<PictureSource>> open_webp(std::span<const std::byte> bytes) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), &features) !=
            VP8_STATUS_OK ||
        features.width < 1 || features.height < 1)
        return user_error("damaged: cannot be read as WebP");
    return std::make_unique<WebpSource>(bytes, features);
}

}  // namespace darkroom
