// SPDX-License-Identifier: MIT
#include "formats/jpeg/jpeg_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// After <cstdio>, which it needs.
#include <jpeglib.h>

#include "formats/attributed_source.hpp"
#include "formats/exif.hpp"
#include "formats/integer_rows.hpp"
#include "formats/jpeg/gain_map.hpp"
#include "formats/jpeg/jpeg_marks.hpp"

namespace darkroom {
namespace {

/// libjpeg leaves by longjmp: between a setjmp and what may fail lies nothing that has a destructor.
class JpegReader {
  public:
    explicit JpegReader(std::span<const std::byte> bytes) : bytes_(bytes) {
        jpeg_.err = jpeg_std_error(&errors_);
        jpeg_.client_data = this;
        errors_.error_exit = [](j_common_ptr jpeg) { leave(jpeg); };
        // What it would warn of is damage.
        errors_.emit_message = [](j_common_ptr jpeg, int level) {
            if (level < 0) leave(jpeg);
        };
        errors_.output_message = [](j_common_ptr) {};
    }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;
    ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }

    /// `is_ycc`: rows of luma and chroma stay so, which are as exact as the file.
    [[nodiscard]] bool read_header(bool is_ycc = false) {
        if (setjmp(return_) != 0) return false;
        jpeg_create_decompress(&jpeg_);
        jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
        jpeg_save_markers(&jpeg_, JPEG_APP0 + 1, 0xffff);
        jpeg_read_header(&jpeg_, TRUE);
        is_ink = jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK;
        if (is_ink) jpeg_.out_color_space = JCS_CMYK;
        has_luma = is_ycc && jpeg_.jpeg_color_space == JCS_YCbCr;
        if (has_luma) jpeg_.out_color_space = JCS_YCbCr;
        jpeg_calc_output_dimensions(&jpeg_);
        width = jpeg_.output_width;
        height = jpeg_.output_height;
        components = static_cast<std::uint32_t>(jpeg_.output_components);
        return true;
    }
    /// To be called once, before rows are read.
    [[nodiscard]] bool start() {
        if (setjmp(return_) != 0) return false;
        jpeg_start_decompress(&jpeg_);
        return true;
    }
    [[nodiscard]] bool read_row(std::uint8_t* row) {
        if (setjmp(return_) != 0) return false;
        return jpeg_read_scanlines(&jpeg_, &row, 1) == 1;
    }
    /// How many times as wide as high pixels are, by JFIF; 0: unknown.
    [[nodiscard]] double aspect() const {
        return jpeg_.X_density == 0 ? 0 : static_cast<double>(jpeg_.Y_density) / jpeg_.X_density;
    }
    [[nodiscard]] std::uint8_t orientation() const {
        constexpr std::string_view name("Exif\0\0", 6);
        for (auto marker = jpeg_.marker_list; marker != nullptr; marker = marker->next) {
            const std::string_view data(reinterpret_cast<const char*>(marker->data), marker->data_length);
            if (data.starts_with(name)) return orientation_of_exif(std::as_bytes(std::span(data.substr(name.size()))));
        }
        return 1;
    }

    std::uint32_t width = 0, height = 0, components = 0;
    bool is_ink = false, has_luma = false;
    char error[JMSG_LENGTH_MAX] = {};

  private:
    [[noreturn]] static void leave(j_common_ptr jpeg) {
        auto& reader = *static_cast<JpegReader*>(jpeg->client_data);
        jpeg->err->format_message(jpeg, reader.error);
        std::longjmp(reader.return_, 1);
    }

    std::span<const std::byte> bytes_;
    jpeg_decompress_struct jpeg_{};
    jpeg_error_mgr errors_{};
    std::jmp_buf return_{};
};

/// Programs store how much light each ink leaves.
void light_of_inks(const std::uint8_t* inks, std::uint8_t* rgb, std::size_t width) {
    const auto share = [](std::uint8_t value) { return static_cast<float>(value) * (1.0F / 255); };
    for (std::size_t x = 0; x < width; ++x, inks += 4, rgb += 3)
        for (std::size_t c = 0; c < 3; ++c)
            rgb[c] = static_cast<std::uint8_t>(share(inks[c]) * share(inks[3]) * 255 + 0.5F);
}

/// Light of rows of codes; between two codes where luma and chroma say more than red, green and blue of 8 bits, which
/// would be up to 2 % off in the dark.
class LightOfCodes {
  public:
    explicit LightOfCodes(const TransferCurve& curve) {
        constexpr double most = std::tuple_size_v<decltype(light_)> - 1;
        for (std::size_t i = 0; i < light_.size(); ++i)
            light_[i] = static_cast<float>(curve.decode(static_cast<double>(i) / most));
    }

    void put(std::span<const std::uint8_t> row, const JpegReader& jpeg, std::span<float> rgb) const {
        const std::size_t step = jpeg.components == 1 ? 1 : 3, last = step - 1;
        for (std::size_t x = 0; x < jpeg.width; ++x) {
            const std::uint8_t* const from = &row[x * step];
            std::array<float, 3> code{float(from[0]), float(from[last / 2]), float(from[last])};
            if (jpeg.has_luma) {  // ITU-T T.871, 7
                const float luma = code[0], blue = code[1] - 128, red = code[2] - 128;
                code = {luma + 1.402f * red, luma - 0.344136f * blue - 0.714136f * red, luma + 1.772f * blue};
            }
            for (std::size_t c = 0; c < 3; ++c) rgb[x * 3 + c] = at(code[c]);
        }
    }

  private:
    [[nodiscard]] float at(float code) const {
        const float place = std::clamp(code / 255, 0.0f, 1.0f) * static_cast<float>(light_.size() - 1);
        const auto first = static_cast<std::size_t>(place);
        const std::size_t second = std::min(first + 1, light_.size() - 1);
        return std::lerp(light_[first], light_[second], place - static_cast<float>(first));
    }

    std::array<float, 4096> light_{};
};

class JpegSource final : public AttributedSource {
  public:
    [[nodiscard]] static Result<std::unique_ptr<PictureSource>> open(std::span<const std::byte> bytes) {
        auto out = std::make_unique<JpegSource>();
        out->file_ = bytes;
        out->map_ = find_gain_map(bytes).map;
        DARKROOM_TRY(out->begin());
        const JpegReader& jpeg = *out->jpeg_;
        if (jpeg.components != 1 && jpeg.components != 3 && !jpeg.is_ink)
            return user_error(fmt::format("has {} components: 1, 3 or 4 are read", jpeg.components));
        FilePart part{
            .width = jpeg.width, .height = jpeg.height, .display_width = jpeg.width, .display_height = jpeg.height};
        if (out->map_) DARKROOM_TRY(out->check_map());
        const bool is_gray = jpeg.components == 1 && !out->map_;
        part.channels = is_gray ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
        part.kinds.assign(part.channels.size(), out->map_ ? SampleKind::Float : SampleKind::Integer8);
        out->parts_.push_back(std::move(part));
        if (jpeg.orientation() != 1) out->attributes_.emplace_back("Orientation", jpeg.orientation());
        if (jpeg.aspect() != 0 && jpeg.aspect() != 1) out->attributes_.emplace_back("PixelAspectRatio", jpeg.aspect());
        return std::unique_ptr<PictureSource>(std::move(out));
    }

    std::uint32_t row_unit(std::size_t /*part*/) const override { return 32; }

  private:
    [[nodiscard]] std::string reason() const { return one_printable_line(jpeg_->error); }

    [[nodiscard]] Result<> begin() {
        jpeg_ = std::make_unique<JpegReader>(file_);
        next_ = 0;
        has_started_ = false;
        if (!jpeg_->read_header(map_.has_value()))
            return user_error(fmt::format("cannot be read as JPEG: {}", reason()));
        return {};
    }

    [[nodiscard]] Result<> check_map() {
        JpegReader jpeg(map_->picture);
        if (!jpeg.read_header()) return map_error(one_printable_line(jpeg.error));
        if (jpeg.components != 1 && (jpeg.components != 3 || jpeg.is_ink))
            return map_error(fmt::format("has {} components: 1 or 3 are read", jpeg.components));
        if (jpeg.width > jpeg_->width || jpeg.height > jpeg_->height)
            return map_error(fmt::format("is {}x{}, its picture's {}x{} is allowed", jpeg.width, jpeg.height,
                                         jpeg_->width, jpeg_->height));
        light_of_codes_.emplace(color_of_jpeg(file_).coding.value_or(ColorCoding{}).curve);
        return {};
    }

    /// All of it: a row of the picture lies between two of the map.
    [[nodiscard]] Result<> read_map() {
        JpegReader jpeg(map_->picture);
        bool is_read = jpeg.read_header();
        const std::size_t row = std::size_t{jpeg.width} * jpeg.components;
        std::vector<std::uint8_t> samples(row * jpeg.height);
        is_read = is_read && jpeg.start();
        for (std::size_t y = 0; is_read && y < jpeg.height; ++y) is_read = jpeg.read_row(samples.data() + y * row);
        if (!is_read) return map_error(fmt::format("damaged or truncated: {}", one_printable_line(jpeg.error)));
        gain_.emplace(*map_, std::move(samples), jpeg.width, jpeg.height);
        light_.resize(std::size_t{jpeg_->width} * 3);
        return {};
    }
    [[nodiscard]] static Failure map_error(const std::string& why) { return user_error("its gain map: " + why); }

    /// The row in `row_` as light, to its places.
    [[nodiscard]] Result<> put_light(std::span<const SamplePlace> places, std::uint32_t row, std::uint32_t y) {
        light_of_codes_->put(row_, *jpeg_, light_);
        gain_->apply(light_, row + y, jpeg_->height);
        for (const SamplePlace& place : places) {
            if (place.kind != SampleKind::Float)
                return user_error(fmt::format("light of a gain map is not read as {}", name_of(place.kind)));
            std::byte* to = place.first + std::ptrdiff_t{y} * place.row_bytes;
            for (std::size_t x = 0; x < jpeg_->width; ++x, to += place.pixel_bytes)
                std::memcpy(to, &light_[x * 3 + place.channel], sizeof(float));
        }
        return {};
    }

    /// Into `row_`.
    [[nodiscard]] bool decode_row() {
        row_.resize(std::size_t{jpeg_->width} * jpeg_->components);
        if (!has_started_ && !jpeg_->start()) return false;
        has_started_ = true;
        if (!jpeg_->read_row(row_.data())) return false;
        ++next_;
        return true;
    }

    Result<> read(std::size_t /*part*/, std::uint32_t row, std::uint32_t rows,
                  std::span<const SamplePlace> places) override {
        if (has_failed_ || row < next_) DARKROOM_TRY(begin());
        has_failed_ = true;
        if (map_ && !gain_) DARKROOM_TRY(read_map());
        for (std::uint32_t y = 0; y < rows;) {
            const bool is_wanted = next_ >= row;
            if (!decode_row())
                return user_error(fmt::format("damaged or truncated: rows {} to {} of {}: {}", row + 1, row + rows,
                                              jpeg_->height, reason()));
            if (!is_wanted) continue;
            // What is kept of a pixel is never behind what is yet to be read of it.
            if (jpeg_->is_ink) light_of_inks(row_.data(), row_.data(), jpeg_->width);
            if (gain_) {
                DARKROOM_TRY(put_light(places, row, y));
                ++y;
                continue;
            }
            const IntegerRow decoded{.first = reinterpret_cast<const std::byte*>(row_.data()),
                                     .width = jpeg_->width,
                                     .channels = parts_[0].channels.size(),
                                     .bits = 8};
            for (const SamplePlace& place : places)
                DARKROOM_TRY(put_integers(decoded, place, place.first + std::ptrdiff_t{y} * place.row_bytes));
            ++y;
        }
        has_failed_ = false;
        return {};
    }

    std::span<const std::byte> file_;
    std::unique_ptr<JpegReader> jpeg_;
    std::uint32_t next_ = 0;  // row
    bool has_started_ = false, has_failed_ = false;
    std::vector<std::uint8_t> row_;
    std::optional<GainMap> map_;
    std::optional<GainRows> gain_;  // of `map_`, once rows are read
    std::optional<LightOfCodes> light_of_codes_;
    std::vector<float> light_;
};

}  // namespace

Result<std::vector<float>> light_of_jpeg(std::span<const std::byte> bytes) {
    JpegReader jpeg(bytes);
    bool is_read = jpeg.read_header(true) && (jpeg.components == 1 || jpeg.components == 3) && jpeg.start();
    const LightOfCodes codes({TransferCurve::Kind::Srgb});
    std::vector<std::uint8_t> row(std::size_t{jpeg.width} * jpeg.components);
    std::vector<float> out(std::size_t{jpeg.width} * jpeg.height * 3);
    for (std::size_t y = 0; is_read && y < jpeg.height; ++y) {
        is_read = jpeg.read_row(row.data());
        codes.put(row, jpeg, std::span(out).subspan(y * jpeg.width * 3));
    }
    if (!is_read) return machine_error(fmt::format("cannot be read back: {}", one_printable_line(jpeg.error)));
    return out;
}

Result<std::unique_ptr<PictureSource>> open_jpeg(std::span<const std::byte> bytes) { return JpegSource::open(bytes); }

}  // namespace darkroom
