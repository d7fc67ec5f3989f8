// SPDX-License-Identifier: MIT
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <mutex>
#include <optional>
#include <type_traits>

#include "core/program_module.hpp"
#include "image/codec/codecs.hpp"

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

std::string name_of(const FileFormat& format) { return std::string(format.openimageio); }

std::optional<SampleKind> sample_kind_of(OIIO::TypeDesc type) {
    switch (type.basetype) {
        case OIIO::TypeDesc::UINT8:
            return SampleKind::Integer8;
        case OIIO::TypeDesc::UINT16:
            return SampleKind::Integer16;
        case OIIO::TypeDesc::UINT32:
            return SampleKind::Integer32;
        case OIIO::TypeDesc::HALF:
            return SampleKind::Half;
        case OIIO::TypeDesc::FLOAT:
            return SampleKind::Float;
        default:
            return std::nullopt;
    }
}

OIIO::TypeDesc type_of(SampleKind kind) {
    switch (kind) {
        case SampleKind::Integer8:
            return OIIO::TypeUInt8;
        case SampleKind::Integer16:
            return OIIO::TypeUInt16;
        case SampleKind::Integer32:
            return OIIO::TypeUInt32;
        case SampleKind::Half:
            return OIIO::TypeHalf;
        case SampleKind::Float:
            break;
    }
    return OIIO::TypeFloat;
}

Result<> flat(const OIIO::ImageSpec& spec) {
    if (spec.deep) return user_error("has deep pixels, which are not read here; flatten it first");
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
        return user_error(fmt::format("the picture is {}x{} with {} channels, at least 1x1 with one is needed",
                                      spec.width, spec.height, spec.nchannels));
    return {};
}

/// Of an integer of so many bytes, as put_integers() has it: OpenImageIO's own of 8 and of 16 bits differ in the last
/// digit.
void put_share(const std::byte* from, std::size_t bytes, std::byte* to) {
    std::uint16_t code = 0;
    std::memcpy(&code, from, bytes);
    const float share = static_cast<float>(code) / (bytes == 1 ? 255.0f : 65535.0f);
    std::memcpy(to, &share, sizeof share);
}

class OiioSource final : public PictureSource {
  public:
    static Result<std::unique_ptr<PictureSource>> open(const FileFormat& format, std::span<const std::byte> bytes) {
        auto out = std::make_unique<OiioSource>();
        out->memory_ = std::make_unique<MemoryReader>(bytes);
        // What OpenImageIO 2.4 lists once, its formats and the words of ICC profiles, it lists without a lock.
        static std::mutex opening;
        const std::lock_guard lock(opening);
        out->input_ = OIIO::ImageInput::create(name_of(format));
        if (!out->input_) return machine_error(fmt::format("OpenImageIO was built without {}", format.name));
        out->input_->set_ioproxy(out->memory_.get());
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);
        // The extension keeps readers content that also look at the name.
        if (!out->input_->open(fmt::format("memory.{}", format.openimageio), out->spec_, config))
            return user_error(fmt::format("cannot be read as {}: {}", format.name, out->reason()));
        DARKROOM_TRY(flat(out->spec_));
        FilePart part{.channels = out->spec_.channelnames,
                      .width = static_cast<std::uint32_t>(out->spec_.width),
                      .height = static_cast<std::uint32_t>(out->spec_.height)};
        part.display_width = part.width;
        part.display_height = part.height;
        part.is_associated =
            out->spec_.alpha_channel >= 0 && out->spec_.get_int_attribute("oiio:UnassociatedAlpha") == 0;
        part.channels.resize(static_cast<std::size_t>(out->spec_.nchannels));
        for (int channel = 0; channel < out->spec_.nchannels; ++channel) {
            const auto sample_kind = sample_kind_of(out->spec_.channelformat(channel));
            if (!sample_kind)
                return user_error(fmt::format("samples of type {}; 8 or 16 bits, half or float are needed",
                                              out->spec_.channelformat(channel).c_str()));
            part.kinds.push_back(*sample_kind);
        }
        out->parts_.push_back(std::move(part));
        return std::unique_ptr<PictureSource>(std::move(out));
    }

    std::vector<double> numbers(std::size_t /*part*/, std::string_view attribute) const override {
        const OIIO::ParamValue* const found = spec_.find_attribute(std::string(attribute));
        if (found == nullptr) return {};
        std::vector<double> values(static_cast<std::size_t>(found->type().basevalues()));
        for (std::size_t i = 0; i < values.size(); ++i) {
            switch (found->type().basetype) {
                case OIIO::TypeDesc::FLOAT:
                    values[i] = static_cast<double>(static_cast<const float*>(found->data())[i]);
                    break;
                case OIIO::TypeDesc::INT32:
                    values[i] = static_cast<const int*>(found->data())[i];
                    break;
                case OIIO::TypeDesc::UINT16:
                    values[i] = static_cast<const std::uint16_t*>(found->data())[i];
                    break;
                default:
                    return {};
            }
        }
        return values;
    }

    std::vector<std::string> attributes(std::size_t /*part*/) const override {
        std::vector<std::string> names;
        for (const OIIO::ParamValue& value : spec_.extra_attribs) names.push_back(value.name().string());
        return names;
    }

    std::uint32_t row_unit(std::size_t /*part*/) const override {
        return spec_.tile_height > 0 ? static_cast<std::uint32_t>(spec_.tile_height) : 32;
    }

  private:
    Result<> read(std::size_t /*part*/, std::uint32_t row, std::uint32_t rows,
                  std::span<const SamplePlace> places) override {
        const auto [least, most] =
            std::minmax_element(places.begin(), places.end(),
                                [](const SamplePlace& a, const SamplePlace& b) { return a.channel < b.channel; });
        const int begin = static_cast<int>(least->channel), end = static_cast<int>(most->channel) + 1;
        const bool is_share = places.front().kind == SampleKind::Float && is_integer(parts_[0].kinds[0]) &&
                              std::ranges::count(parts_[0].kinds, parts_[0].kinds[0]) == spec_.nchannels;
        const SampleKind kind = is_share ? parts_[0].kinds[0] : places.front().kind;
        const std::size_t size = size_of(kind), pixel = size * static_cast<std::size_t>(end - begin);
        const std::size_t width = static_cast<std::size_t>(spec_.width);
        samples_.resize(pixel * width * rows);
        const int top = spec_.y + static_cast<int>(row), bottom = top + static_cast<int>(rows);
        const bool is_read =
            spec_.tile_width > 0
                ? input_->read_tiles(0, 0, spec_.x, spec_.x + spec_.width, top, bottom, 0, 1, begin, end, type_of(kind),
                                     samples_.data())
                : input_->read_scanlines(0, 0, top, bottom, 0, begin, end, type_of(kind), samples_.data());
        if (!is_read)
            return user_error(fmt::format("damaged or truncated: rows {} to {} of {}: {}", row + 1, row + rows,
                                          spec_.height, reason()));
        for (const SamplePlace& place : places) {
            const std::byte* from = samples_.data() + (place.channel - least->channel) * size;
            for (std::uint32_t y = 0; y < rows; ++y) {
                std::byte* to = place.first + static_cast<std::ptrdiff_t>(y) * place.row_bytes;
                for (std::size_t x = 0; x < width; ++x, from += pixel, to += place.pixel_bytes)
                    if (is_share)
                        put_share(from, size, to);
                    else
                        std::memcpy(to, from, size);
            }
        }
        return {};
    }

    std::string reason() const {
        const std::string message = one_printable_line(input_->geterror());
        return message.empty() ? "they cannot be decoded" : message;
    }

    std::unique_ptr<OIIO::Filesystem::IOProxy> memory_;
    OIIO::ImageInput::unique_ptr input_;  // after `memory_`, which it reads from until it is destroyed
    OIIO::ImageSpec spec_;
    std::vector<std::byte> samples_;
};

Result<std::vector<std::byte>> encode(const FileFormat& format, const EncodeDesc& desc) {
    const auto error = [&](std::string_view why) {
        return machine_error(fmt::format("cannot be written as {}: {}", format.name,
                                         why.empty() ? "unknown reason" : one_printable_line(why)));
    };
    OIIO::ImageSpec spec(static_cast<int>(desc.width), static_cast<int>(desc.height), static_cast<int>(desc.channels),
                         type_of(desc.kind));
    // OpenImageIO would write the time of day, and no file would be the same twice. An unknown time is blanks
    // (EXIF 2.3, 4.6.4, DateTime).
    const bool is_tiff = format.openimageio == "tiff";
    if (is_tiff) spec.attribute("DateTime", "    :  :     :  :  ");
    // Alpha is carried, never applied: without this, writers divide colour by it, or say that it was multiplied.
    if (!desc.is_associated) spec.attribute("oiio:UnassociatedAlpha", 1);
    if (format.openimageio == "jpeg") {
        spec.attribute("oiio:ColorSpace", "sRGB");
        const int quality = desc.quality.value_or(95);
        // Who asks for so much does not want red and blue at half the resolution.
        constexpr int full_chroma = 90;
        spec.attribute("Compression", fmt::format("jpeg:{}", quality));
        spec.attribute("jpeg:subsampling",
                       desc.chroma.empty() ? quality >= full_chroma ? "4:4:4" : "4:2:0" : desc.chroma);
    }
    if (is_tiff) spec.attribute("compression", desc.compression.empty() ? "zip" : desc.compression);
    OIIO::Filesystem::IOVecOutput memory;
    auto output = OIIO::ImageOutput::create(name_of(format));
    if (!output) return error("OpenImageIO was built without it");
    if (!output->set_ioproxy(&memory)) return error("OpenImageIO cannot write it to memory");
    if (!output->open(fmt::format("memory.{}", format.openimageio), spec)) return error(output->geterror());
    if (!output->write_image(type_of(desc.kind), desc.samples)) return error(output->geterror());
    if (!output->close()) return error(output->geterror());
    const std::span<const std::byte> bytes = std::as_bytes(std::span(memory.buffer()));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

Result<> resample(const FloatPixels& from, const FloatPixels& to) {
    const auto buffer = [](const FloatPixels& pixels) {
        const OIIO::ImageSpec spec(static_cast<int>(pixels.width), static_cast<int>(pixels.height), 4, OIIO::TypeFloat);
        return OIIO::ImageBuf(spec, pixels.rgba);
    };
    OIIO::ImageBuf result = buffer(to);
    if (!OIIO::ImageBufAlgo::resize(result, buffer(from), "triangle", 0.0f, result.roi()))
        return machine_error(
            fmt::format("resizing to {}x{} failed: {}", to.width, to.height, one_printable_line(result.geterror())));
    return {};
}

// No exception leaves the module.
template <class T, class... Arguments>
T guarded(T (*work)(Arguments...), std::string_view doing, std::type_identity_t<Arguments>... arguments) {
    try {
        return work(arguments...);
    } catch (const std::exception& exception) {
        return user_error(fmt::format("{}: {}", doing, one_printable_line(exception.what())));
    }
}

}  // namespace
}  // namespace darkroom

extern "C" DARKROOM_MODULE_EXPORT const darkroom::Codecs* darkroom_oiio_codecs() {
    using namespace darkroom;
    static const Codecs codecs{
        .prepare = [] { static_cast<void>(OIIO::ImageInput::create("tiff")); },
        .open =
            [](const FileFormat& format, std::span<const std::byte> bytes) {
                return guarded(OiioSource::open, "cannot be decoded", format, bytes);
            },
        .encode = [](const FileFormat& format,
                     const EncodeDesc& desc) { return guarded(encode, "cannot be encoded", format, desc); },
        .resample = [](const FloatPixels& from,
                       const FloatPixels& to) { return guarded(resample, "cannot be resized", from, to); },
    };
    return &codecs;
}
