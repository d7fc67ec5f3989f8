// SPDX-License-Identifier: MIT
#include "formats/png/png_source.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "formats/attributed_source.hpp"
#include "formats/integer_rows.hpp"

namespace darkroom {
namespace {

/// libpng leaves by longjmp: between a setjmp and what may fail lies nothing that has a destructor.
class PngReader {
  public:
    explicit PngReader(std::span<const std::byte> bytes) : left_(bytes) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, keep_error, keep_warning);
        info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

    [[nodiscard]] bool read_header() {
        if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) return false;
        png_set_read_fn(png_, this, give);
        // The check has compared them, and bounds what is worth it.
        png_set_crc_action(png_, PNG_CRC_QUIET_USE, PNG_CRC_QUIET_USE);
        png_set_user_limits(png_, 65536, 65536);
        png_read_info(png_, info_);
        png_set_expand(png_);
        if (std::endian::native == std::endian::little) png_set_swap(png_);
        is_interlaced = png_set_interlace_handling(png_) > 1;
        png_read_update_info(png_, info_);
        width = png_get_image_width(png_, info_);
        height = png_get_image_height(png_, info_);
        channels = png_get_channels(png_, info_);
        bits = png_get_bit_depth(png_, info_);
        aspect = static_cast<double>(png_get_pixel_aspect_ratio(png_, info_));
        // check_png() writes it anew: 26 bytes.
        png_uint_32 count = 0;
        png_bytep exif = nullptr;
        if (png_get_eXIf_1(png_, info_, &count, &exif) != 0 && count == 26) orientation = exif[19];
        return true;
    }
    /// So many rows from where it stands, or all of what is interlaced.
    [[nodiscard]] bool read_rows(std::uint8_t** rows, std::uint32_t count) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        if (is_interlaced)
            png_read_image(png_, rows);
        else
            png_read_rows(png_, rows, nullptr, count);
        return true;
    }

    std::uint32_t width = 0, height = 0, channels = 0, bits = 0, orientation = 1;
    double aspect = 0;
    bool is_interlaced = false;
    std::array<char, 128> error{};

  private:
    [[noreturn]] static void keep_error(png_structp png, png_const_charp text) {
        auto& to = static_cast<PngReader*>(png_get_error_ptr(png))->error;
        std::strncpy(to.data(), text, to.size() - 1);
        png_longjmp(png, 1);
    }
    static void keep_warning(png_structp /*png*/, png_const_charp /*text*/) {}
    static void give(png_structp png, png_bytep to, std::size_t size) {
        auto& left = static_cast<PngReader*>(png_get_io_ptr(png))->left_;
        if (size > left.size()) png_error(png, "unexpected end of file");
        std::memcpy(to, left.data(), size);
        left = left.subspan(size);
    }

    std::span<const std::byte> left_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

class PngSource final : public AttributedSource {
  public:
    [[nodiscard]] static Result<std::unique_ptr<PictureSource>> open(std::span<const std::byte> bytes) {
        auto out = std::make_unique<PngSource>();
        out->file_ = bytes;
        DARKROOM_TRY(out->begin());
        const PngReader& png = *out->png_;
        FilePart part{
            .width = png.width, .height = png.height, .display_width = png.width, .display_height = png.height};
        part.channels =
            png.channels < 3 ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"R", "G", "B", "A"};
        part.channels.resize(png.channels);
        part.kinds.assign(png.channels, png.bits == 16 ? SampleKind::Integer16 : SampleKind::Integer8);
        out->parts_.push_back(std::move(part));
        if (png.orientation != 1) out->attributes_.emplace_back("Orientation", png.orientation);
        if (png.aspect != 0 && png.aspect != 1) out->attributes_.emplace_back("PixelAspectRatio", png.aspect);
        return std::unique_ptr<PictureSource>(std::move(out));
    }

    std::uint32_t row_unit(std::size_t /*part*/) const override { return 32; }

  private:
    [[nodiscard]] std::string reason() const { return one_printable_line(png_->error.data()); }
    [[nodiscard]] std::size_t row_bytes() const { return std::size_t{png_->width} * png_->channels * png_->bits / 8; }

    [[nodiscard]] Result<> begin() {
        png_ = std::make_unique<PngReader>(file_);
        next_ = 0;
        if (!png_->read_header()) return user_error(fmt::format("cannot be read as PNG: {}", reason()));
        return {};
    }

    /// Leaves the rows at the begin of `samples_`, or all of them.
    [[nodiscard]] bool decode(std::uint32_t row, std::uint32_t rows) {
        const std::uint32_t count = png_->is_interlaced ? png_->height : rows;
        if (png_->is_interlaced && next_ > 0) return true;
        samples_.resize(count * row_bytes());
        std::vector<std::uint8_t*> pointers(count);
        for (std::uint32_t y = 0; y < count; ++y)
            pointers[y] = reinterpret_cast<std::uint8_t*>(samples_.data()) + y * row_bytes();
        // What lies between is decoded and forgotten.
        for (; !png_->is_interlaced && next_ < row; ++next_)
            if (!png_->read_rows(pointers.data(), 1)) return false;
        if (!png_->read_rows(pointers.data(), count)) return false;
        next_ += count;
        return true;
    }

    Result<> read(std::size_t /*part*/, std::uint32_t row, std::uint32_t rows,
                  std::span<const SamplePlace> places) override {
        if (has_failed_ || (!png_->is_interlaced && row < next_)) DARKROOM_TRY(begin());
        has_failed_ = !decode(row, rows);
        if (has_failed_)
            return user_error(fmt::format("damaged or truncated: rows {} to {} of {}: {}", row + 1, row + rows,
                                          png_->height, reason()));
        const std::byte* const first = samples_.data() + (png_->is_interlaced ? row * row_bytes() : 0);
        for (std::uint32_t y = 0; y < rows; ++y) {
            const IntegerRow decoded{first + y * row_bytes(), png_->width, png_->channels, png_->bits};
            for (const SamplePlace& place : places)
                DARKROOM_TRY(put_integers(decoded, place, place.first + std::ptrdiff_t{y} * place.row_bytes));
        }
        return {};
    }

    std::span<const std::byte> file_;
    std::unique_ptr<PngReader> png_;
    std::uint32_t next_ = 0;  // row
    bool has_failed_ = false;
    std::vector<std::byte> samples_;
};

}  // namespace

Result<std::unique_ptr<PictureSource>> open_png(std::span<const std::byte> bytes) { return PngSource::open(bytes); }

}  // namespace darkroom
