// SPDX-License-Identifier: MIT
#include "formats/tiff/tiff_source.hpp"

#include <Imath/half.h>
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/attributed_source.hpp"
#include "formats/integer_rows.hpp"

namespace darkroom {
namespace {

/// A file in memory, as libtiff asks for it.
class TiffFile {
  public:
    explicit TiffFile(std::span<const std::byte> bytes) : bytes_(bytes) {
        const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                       TIFFOpenOptionsFree);
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, this);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), pass_over, this);
        // Without a map of the file: it would be read past what its tags say.
        tiff_ =
            TIFFClientOpenExt("memory", "rm", this, read, write, seek, close, size, nullptr, nullptr, options.get());
    }
    TiffFile(const TiffFile&) = delete;
    TiffFile& operator=(const TiffFile&) = delete;
    ~TiffFile() {
        if (tiff_ != nullptr) TIFFClose(tiff_);
    }

    [[nodiscard]] TIFF* get() const { return tiff_; }
    template <class T>
    [[nodiscard]] T field(std::uint32_t tag, T otherwise) const {
        T value{};
        return TIFFGetFieldDefaulted(tiff_, tag, &value) == 1 ? value : otherwise;
    }

    std::string error;

  private:
    static int keep_error(TIFF* /*tiff*/, void* file, const char* /*place*/, const char* format, std::va_list values) {
        char text[300] = {};
        std::vsnprintf(text, sizeof text, format, values);
        auto& error = static_cast<TiffFile*>(file)->error;
        if (error.empty()) error = one_printable_line(text);
        return 1;
    }
    static int pass_over(TIFF* /*tiff*/, void* /*file*/, const char* /*place*/, const char* /*format*/,
                         std::va_list /*values*/) {
        return 1;
    }
    static tmsize_t read(thandle_t handle, void* to, tmsize_t count) {
        auto& file = *static_cast<TiffFile*>(handle);
        const std::size_t left = file.bytes_.size() - std::min(file.at_, file.bytes_.size());
        const std::size_t size = std::min(left, static_cast<std::size_t>(std::max<tmsize_t>(count, 0)));
        if (size > 0) std::memcpy(to, file.bytes_.data() + file.at_, size);
        file.at_ += size;
        return static_cast<tmsize_t>(size);
    }
    static tmsize_t write(thandle_t /*handle*/, void* /*from*/, tmsize_t /*count*/) { return 0; }
    static toff_t seek(thandle_t handle, toff_t offset, int from) {
        auto& file = *static_cast<TiffFile*>(handle);
        file.at_ = offset + (from == SEEK_CUR ? file.at_ : from == SEEK_END ? file.bytes_.size() : 0);
        return file.at_;
    }
    static int close(thandle_t /*handle*/) { return 0; }
    static toff_t size(thandle_t handle) { return static_cast<TiffFile*>(handle)->bytes_.size(); }

    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
    TIFF* tiff_ = nullptr;
};

template <class From, class To>
void put_real(const IntegerRow& row, const SamplePlace& place, std::byte* to) {
    const std::byte* from = row.first + place.channel * sizeof(From);
    for (std::size_t x = 0; x < row.width; ++x, from += sizeof(From) * row.channels, to += place.pixel_bytes) {
        From value;
        std::memcpy(&value, from, sizeof value);
        const To converted(value);
        std::memcpy(to, &converted, sizeof converted);
    }
}

class TiffSource final : public AttributedSource {
  public:
    explicit TiffSource(std::span<const std::byte> bytes) : file_(bytes) {}

    /// False: it is not for this one.
    [[nodiscard]] Result<bool> describe() {
        if (file_.get() == nullptr) return user_error(fmt::format("cannot be read as TIFF: {}", file_.error));
        const auto samples = file_.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
        const auto bits = file_.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
        const auto format = file_.field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
        const auto compression = file_.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
        std::uint16_t meaning = 0;
        if (TIFFGetField(file_.get(), TIFFTAG_PHOTOMETRIC, &meaning) != 1) return false;
        const bool is_integer = format == SAMPLEFORMAT_UINT && (bits == 8 || bits == 16);
        const bool is_real = format == SAMPLEFORMAT_IEEEFP && (bits == 16 || bits == 32);
        const bool is_palette = meaning == PHOTOMETRIC_PALETTE && (bits == 1 || bits == 2 || bits == 4 || bits == 8) &&
                                format == SAMPLEFORMAT_UINT && samples == 1;
        if ((!is_integer && !is_real && !is_palette) || compression == COMPRESSION_JPEG) return false;
        FilePart part;
        is_negative_ = meaning == PHOTOMETRIC_MINISWHITE;
        if (meaning == PHOTOMETRIC_MINISBLACK || is_negative_) part.channels = {"Y"};
        if (meaning == PHOTOMETRIC_RGB || (is_palette && read_palette(bits))) part.channels = {"R", "G", "B"};
        if (part.channels.empty()) return false;
        if (const std::optional<bool> is_associated = alpha(); is_associated && samples == part.channels.size() + 1) {
            part.channels.emplace_back("A");
            part.is_associated = *is_associated;
        }
        if (!is_palette && samples != part.channels.size()) return false;
        part.kinds.assign(part.channels.size(), is_real ? bits == 16 ? SampleKind::Half : SampleKind::Float
                                                : bits == 16 || is_palette ? SampleKind::Integer16
                                                                           : SampleKind::Integer8);
        part.width = part.display_width = file_.field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
        part.height = part.display_height = file_.field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
        sample_bytes_ = is_palette ? 2 : bits / 8;
        is_apart_ = samples > 1 && file_.field<std::uint16_t>(TIFFTAG_PLANARCONFIG, 1) == PLANARCONFIG_SEPARATE;
        is_tiled_ = TIFFIsTiled(file_.get()) != 0;
        chunk_width_ = is_tiled_ ? file_.field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0) : part.width;
        chunk_height_ = is_tiled_
                            ? file_.field<std::uint32_t>(TIFFTAG_TILELENGTH, 0)
                            : std::min(file_.field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, part.height), part.height);
        if (part.width == 0 || part.height == 0 || chunk_width_ == 0 || chunk_height_ == 0) return false;
        const auto orientation = file_.field<std::uint16_t>(TIFFTAG_ORIENTATION, 1);
        if (orientation != 1) attributes_.emplace_back("Orientation", orientation);
        const auto across = file_.field<float>(TIFFTAG_XRESOLUTION, 0),
                   down = file_.field<float>(TIFFTAG_YRESOLUTION, 0);
        if (across > 0 && down > 0) attributes_.emplace_back("PixelAspectRatio", down / across);
        parts_.push_back(std::move(part));
        return true;
    }

    std::uint32_t row_unit(std::size_t /*part*/) const override { return is_tiled_ ? chunk_height_ : 32; }

  private:
    /// Whether colours are multiplied by it; nothing where there is none.
    [[nodiscard]] std::optional<bool> alpha() const {
        std::uint16_t count = 0;
        std::uint16_t* what = nullptr;
        if (TIFFGetField(file_.get(), TIFFTAG_EXTRASAMPLES, &count, &what) != 1 || count != 1) return std::nullopt;
        if (what[0] != EXTRASAMPLE_ASSOCALPHA && what[0] != EXTRASAMPLE_UNASSALPHA) return std::nullopt;
        return what[0] == EXTRASAMPLE_ASSOCALPHA;
    }
    /// The colours that numbers of so many bits name. False where 8 bits hold each of them, too, as other decoders read
    /// them.
    [[nodiscard]] bool read_palette(std::uint16_t bits) {
        std::array<std::uint16_t*, 3> map{};
        if (TIFFGetField(file_.get(), TIFFTAG_COLORMAP, &map[0], &map[1], &map[2]) != 1) return false;
        index_bits_ = bits;
        palette_.resize(std::size_t{1} << bits);
        bool is_fine = false, is_wide = false;
        for (std::size_t color = 0; color < palette_.size(); ++color)
            for (std::size_t channel = 0; channel < map.size(); ++channel) {
                const std::uint16_t value = palette_[color][channel] = map[channel][color];
                is_fine = is_fine || value % 257 != 0;
                is_wide = is_wide || value > 255;  // some programs write numbers of 8 bits
            }
        return is_fine && is_wide;
    }
    [[nodiscard]] std::size_t index(const std::byte* row, std::size_t x) const {
        const std::size_t bit = x * index_bits_;
        return std::to_integer<std::size_t>(row[bit / 8]) >> (8 - index_bits_ - bit % 8) & (palette_.size() - 1);
    }
    /// Of a picture whose 0 is white: grey, and alpha as it is.
    void turn_around() {
        const std::size_t step = pixel_bytes();
        for (std::size_t at = 0; at < band_.size(); at += step) {
            const bool is_half = parts_[0].kinds[0] == SampleKind::Half;
            if (parts_[0].kinds[0] == SampleKind::Float) {
                float value = 0;
                std::memcpy(&value, &band_[at], sizeof value);
                value = 1 - value;
                std::memcpy(&band_[at], &value, sizeof value);
            } else if (is_half) {
                Imath::half value;
                std::memcpy(&value, &band_[at], sizeof value);
                value = 1 - value;
                std::memcpy(&band_[at], &value, sizeof value);
            } else {
                for (std::size_t i = 0; i < sample_bytes_; ++i) band_[at + i] = ~band_[at + i];
            }
        }
    }
    [[nodiscard]] std::size_t pixel_bytes() const { return sample_bytes_ * parts_[0].channels.size(); }

    /// A strip, or the tiles beside each other, whose rows become the band's, pixel by pixel.
    [[nodiscard]] bool load(std::uint32_t band) {
        const std::uint32_t width = parts_[0].width, first = band * chunk_height_;
        const std::uint32_t rows = std::min(chunk_height_, parts_[0].height - first);
        const std::size_t pixel = is_apart_ ? sample_bytes_ : pixel_bytes();
        const std::size_t planes = is_apart_ ? parts_[0].channels.size() : 1;
        band_.resize(pixel_bytes() * width * rows);
        const std::size_t chunk_row =
            palette_.empty() ? pixel * chunk_width_ : (std::size_t{chunk_width_} * index_bits_ + 7) / 8;
        chunk_.resize(chunk_row * (is_tiled_ ? chunk_height_ : rows));
        for (std::size_t plane = 0; plane < planes; ++plane)
            for (std::uint32_t x = 0; x < width; x += chunk_width_) {
                const auto sample = static_cast<std::uint16_t>(plane);
                const auto size = static_cast<tmsize_t>(chunk_.size());
                const tmsize_t read =
                    is_tiled_ ? TIFFReadEncodedTile(file_.get(), TIFFComputeTile(file_.get(), x, first, 0, sample),
                                                    chunk_.data(), size)
                              : TIFFReadEncodedStrip(file_.get(), TIFFComputeStrip(file_.get(), first, sample),
                                                     chunk_.data(), size);
                if (read != size) return false;
                for (std::uint32_t y = 0; y < rows; ++y) {
                    const std::byte* from = chunk_.data() + chunk_row * y;
                    std::byte* to = band_.data() + pixel_bytes() * (std::size_t{width} * y + x) + plane * sample_bytes_;
                    const std::uint32_t count = std::min(chunk_width_, width - x);
                    if (!palette_.empty())
                        for (std::uint32_t i = 0; i < count; ++i, to += pixel_bytes())
                            std::memcpy(to, &palette_[index(from, i)], pixel_bytes());
                    else if (!is_apart_)
                        std::memcpy(to, from, pixel * count);
                    else
                        for (std::uint32_t i = 0; i < count; ++i, from += pixel, to += pixel_bytes())
                            std::memcpy(to, from, pixel);
                }
            }
        if (is_negative_) turn_around();
        return true;
    }

    Result<> read(std::size_t /*part*/, std::uint32_t row, std::uint32_t rows,
                  std::span<const SamplePlace> places) override {
        for (std::uint32_t y = 0; y < rows; ++y) {
            const std::uint32_t band = (row + y) / chunk_height_;
            if (band_number_ != band + 1) {
                band_number_ = 0;
                file_.error.clear();
                if (!load(band))
                    return user_error(fmt::format("damaged or truncated: rows {} to {} of {}: {}", row + 1, row + rows,
                                                  parts_[0].height,
                                                  file_.error.empty() ? "they cannot be decoded" : file_.error));
                band_number_ = band + 1;
            }
            const std::size_t at = pixel_bytes() * parts_[0].width * ((row + y) % chunk_height_);
            const IntegerRow decoded{band_.data() + at, parts_[0].width, parts_[0].channels.size(), sample_bytes_ * 8};
            for (const SamplePlace& place : places)
                DARKROOM_TRY(put_row(decoded, place, place.first + std::ptrdiff_t{y} * place.row_bytes));
        }
        return {};
    }

    [[nodiscard]] Result<> put_row(const IntegerRow& row, const SamplePlace& place, std::byte* to) const {
        const SampleKind kind = parts_[0].kinds[0];
        if (kind != SampleKind::Half && kind != SampleKind::Float) return put_integers(row, place, to);
        if (kind == SampleKind::Half && place.kind == SampleKind::Half)
            put_real<Imath::half, Imath::half>(row, place, to);
        else if (kind == SampleKind::Half && place.kind == SampleKind::Float)
            put_real<Imath::half, float>(row, place, to);
        else if (place.kind == SampleKind::Float)
            put_real<float, float>(row, place, to);
        else if (place.kind == SampleKind::Half)
            put_real<float, Imath::half>(row, place, to);
        else
            return user_error(fmt::format("{} is not read as {}", name_of(kind), name_of(place.kind)));
        return {};
    }

    TiffFile file_;
    std::size_t sample_bytes_ = 1;
    bool is_apart_ = false, is_tiled_ = false, is_negative_ = false;
    std::uint32_t chunk_width_ = 1, chunk_height_ = 1;
    std::uint32_t band_number_ = 0;  ///< one more than that which `band_` holds
    std::vector<std::byte> band_, chunk_;
    std::vector<std::array<std::uint16_t, 3>> palette_;  ///< empty: samples are of the picture itself
    std::size_t index_bits_ = 8;
};

}  // namespace

Result<std::unique_ptr<PictureSource>> open_tiff(std::span<const std::byte> bytes) {
    auto out = std::make_unique<TiffSource>(bytes);
    DARKROOM_TRY_VALUE(const bool is_plain, out->describe());
    if (!is_plain) return std::unique_ptr<PictureSource>();
    return std::unique_ptr<PictureSource>(std::move(out));
}

}  // namespace darkroom
