// SPDX-License-Identifier: MIT
#include "image/exr/write.hpp"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>

#include "core/files.hpp"
#include "core/own_file.hpp"
#include "formats/exr/exr_source.hpp"
#include "image/color/interop_space.hpp"

namespace darkroom {
namespace {

class MemoryOutput final : public Imf::OStream {
  public:
    MemoryOutput() : OStream("memory") {}
    void write(const char* from, int count) override {
        const std::size_t end = position_ + static_cast<std::size_t>(count);
        if (end > bytes.size()) bytes.resize(end);
        std::memcpy(bytes.data() + position_, from, static_cast<std::size_t>(count));
        position_ = end;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::vector<std::byte> bytes;

  private:
    std::size_t position_ = 0;
};

float clamped(float value, float largest) { return std::isnan(value) ? 0.0f : std::clamp(value, -largest, largest); }

bool is_dwa(Imf::Compression compression) {
    return compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
}

/// Rows of one channel as they are stored.
void convert(const ExrChannel& channel, Imf::Compression compression, std::size_t first, std::size_t count,
             std::vector<std::byte>& to) {
    const float* from = channel.values + first * channel.stride;
    to.resize(count * size_of(channel.kind));
    const bool is_cosine = is_dwa(compression) && is_changed_by(compression, channel.name, channel.kind);
    if (channel.kind == SampleKind::Half) {
        const float largest_half = is_cosine ? largest_in_dwa : 65504.0F;
        for (std::size_t i = 0; i < count; ++i, from += channel.stride) {
            const std::uint16_t bits = imath_float_to_half(channel.is_clamped ? clamped(*from, largest_half) : *from);
            std::memcpy(to.data() + i * sizeof bits, &bits, sizeof bits);
        }
        return;
    }
    const float largest_float = is_cosine ? largest_in_dwa : std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < count; ++i, from += channel.stride) {
        const float value = channel.is_clamped ? clamped(*from, largest_float) : *from;
        std::memcpy(to.data() + i * sizeof value, &value, sizeof value);
    }
}

/// `file` is an Imf::OutputFile or a part of several.
template <class File>
void write_pixels(File& file, const ExrPart& part) {
    const Imath::Box2i& window = part.header.dataWindow();
    const int width = window.max.x - window.min.x + 1;
    constexpr int band = 128;  // whole chunks of most compressions, and several of them
    std::vector<std::vector<std::byte>> samples(part.channels.size());
    for (int row = window.min.y; row <= window.max.y; row += band) {
        const int rows = std::min(band, window.max.y - row + 1);
        const std::size_t first = static_cast<std::size_t>(row - window.min.y) * static_cast<std::size_t>(width);
        Imf::FrameBuffer buffer;
        for (std::size_t i = 0; i < part.channels.size(); ++i) {
            const ExrChannel& channel = part.channels[i];
            convert(channel, part.header.compression(), first,
                    static_cast<std::size_t>(width) * static_cast<std::size_t>(rows), samples[i]);
            buffer.insert(channel.name, Imf::Slice::Make(type_of(channel.kind), samples[i].data(),
                                                         Imath::V2i(window.min.x, row), width, rows));
        }
        file.setFrameBuffer(buffer);
        file.writePixels(rows);
    }
}

}  // namespace

bool is_changed_by(Imf::Compression compression, std::string_view channel, SampleKind kind) {
    if (compression == Imf::PXR24_COMPRESSION) return kind == SampleKind::Float;
    if (compression == Imf::B44_COMPRESSION || compression == Imf::B44A_COMPRESSION) return kind == SampleKind::Half;
    constexpr std::array<std::string_view, 6> by_cosine{"R", "G", "B", "Y", "RY", "BY"};
    return is_dwa(compression) && std::ranges::count(by_cosine, channel.substr(channel.rfind('.') + 1)) > 0;
}

Imf::Header exr_header(std::uint32_t width, std::uint32_t height, std::string_view compression) {
    Imf::Header header(static_cast<int>(width), static_cast<int>(height));
    const auto known = std::ranges::find(exr_compressions, compression);
    header.compression() = known == exr_compressions.end()
                               ? Imf::ZIP_COMPRESSION
                               : static_cast<Imf::Compression>(known - exr_compressions.begin());
    return header;
}

void add_primaries(Imf::Header& header, const Chromaticities& of) {
    const auto point = [](const Chromaticity& c) {
        return Imath::V2f(static_cast<float>(c.x), static_cast<float>(c.y));
    };
    Imf::addChromaticities(header, {point(of.red), point(of.green), point(of.blue), point(of.white)});
    if (const std::string id = interop_id_of(of); !id.empty())
        header.insert("colorInteropID", Imf::StringAttribute(id));
}

Result<std::vector<std::byte>> encode_exr(std::span<const ExrPart> parts, std::size_t max_threads) {
    if (max_threads != 1) start_exr_threads();
    const int threads = max_threads == 1 ? 0 : Imf::globalThreadCount();
    MemoryOutput memory;
    try {
        std::vector<Imf::Header> headers;
        for (const ExrPart& part : parts) {
            Imf::Header& header = headers.emplace_back(part.header);
            for (const ExrChannel& channel : part.channels)
                header.channels().insert(channel.name, Imf::Channel(type_of(channel.kind)));
            if (parts.size() > 1) header.setType(Imf::SCANLINEIMAGE);
        }
        if (parts.size() == 1) {
            Imf::OutputFile file(memory, headers.front(), threads);
            write_pixels(file, parts.front());
        } else {
            Imf::MultiPartOutputFile file(memory, headers.data(), static_cast<int>(headers.size()), true, threads);
            for (std::size_t i = 0; i < parts.size(); ++i) {
                Imf::OutputPart output(file, static_cast<int>(i));
                write_pixels(output, parts[i]);
            }
        }
    } catch (const std::exception& exception) {
        return machine_error(
            fmt::format("cannot be written as {}: {}", exr_format().name, one_printable_line(exception.what())));
    }
    return std::move(memory.bytes);
}

Result<> write_exr(const std::filesystem::path& path, std::span<const ExrPart> parts, std::size_t max_threads,
                   bool follows_links) {
    const auto bytes = encode_exr(parts, max_threads);
    if (!bytes) return failure({bytes.error().fault, fmt::format("{}: {}", path.string(), bytes.error().text)});
    return follows_links ? write_file(path, *bytes) : write_own_file(path, *bytes, FileOwner::Anyone);
}

}  // namespace darkroom
