// SPDX-License-Identifier: MIT
#include "formats/exr/exr_source.hpp"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <tuple>
#include <type_traits>

#include "core/text/lower.hpp"
#include "formats/exr/exr_zip.hpp"

namespace darkroom {
namespace {

class MemoryStream final : public Imf::IStream {
  public:
    explicit MemoryStream(std::span<const std::byte> bytes) : IStream("memory"), bytes_(bytes) {}
    bool read(char* to, int count) override {
        if (count < 0 || static_cast<std::size_t>(count) > bytes_.size() - position_)
            throw Iex::InputExc("unexpected end of file");
        std::memcpy(to, bytes_.data() + position_, static_cast<std::size_t>(count));
        position_ += static_cast<std::size_t>(count);
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = std::min<std::uint64_t>(position, bytes_.size()); }

  private:
    std::span<const std::byte> bytes_;
    std::size_t position_ = 0;
};

SampleKind kind_of(Imf::PixelType type) {
    return type == Imf::HALF ? SampleKind::Half : type == Imf::FLOAT ? SampleKind::Float : SampleKind::Integer32;
}

struct Channel {
    std::string name;
    Imf::Channel stored;
    std::size_t place = 0;  // in the order of the file

    [[nodiscard]] bool is_subsampled() const { return stored.xSampling != 1 || stored.ySampling != 1; }
    // By layer, and in the order in which people name components.
    [[nodiscard]] auto rank() const {
        const std::size_t dot = name.rfind('.');
        const std::string layer = dot == std::string::npos ? std::string() : name.substr(0, dot);
        const std::string component = name.substr(layer.empty() ? 0 : dot + 1);
        const std::size_t known = component.size() == 1 ? std::string_view("RGBA").find(component) : 4;
        return std::tuple(layer, std::min<std::size_t>(known, 4), component);
    }
};

/// A part and how its channels are stored.
struct OpenPart {
    explicit OpenPart(Imf::MultiPartInputFile& file, int number) : input(file, number) {}

    Imf::InputPart input;
    std::vector<Channel> channels;  // as in FilePart
    bool is_tiled = false, is_luminance_chroma = false;

    [[nodiscard]] const Imf::Header& header() const { return input.header(); }
    [[nodiscard]] const Imath::Box2i& window() const { return header().dataWindow(); }
    [[nodiscard]] bool is_zip() const {
        const Imf::Compression compression = header().compression();
        return !is_tiled &&
               (compression == Imf::NO_COMPRESSION || compression == Imf::ZIP_COMPRESSION ||
                compression == Imf::ZIPS_COMPRESSION) &&
               std::none_of(channels.begin(), channels.end(), [](const Channel& c) { return c.is_subsampled(); });
    }
};

const char* name_of_compression(Imf::Compression compression) {
    constexpr std::array names{"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"};
    return static_cast<std::size_t>(compression) < names.size() ? names[static_cast<std::size_t>(compression)] : "";
}

template <class Vector>
std::vector<double> all_of(const Vector& vector, std::size_t count) {
    std::vector<double> out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<double>(vector.getValue()[i]);
    return out;
}

std::vector<double> numbers_of(const Imf::Attribute& attribute) {
    if (const auto* one = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) return {one->value()};
    if (const auto* one = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) return {one->value()};
    if (const auto* one = dynamic_cast<const Imf::IntAttribute*>(&attribute))
        return {static_cast<double>(one->value())};
    if (const auto* list = dynamic_cast<const Imf::FloatVectorAttribute*>(&attribute))
        return {list->value().begin(), list->value().end()};
    if (const auto* m = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) return all_of(m->value(), 16);
    if (const auto* m = dynamic_cast<const Imf::M44dAttribute*>(&attribute)) return all_of(m->value(), 16);
    if (const auto* m = dynamic_cast<const Imf::M33fAttribute*>(&attribute)) return all_of(m->value(), 9);
    if (const auto* v = dynamic_cast<const Imf::V2fAttribute*>(&attribute)) return all_of(v->value(), 2);
    if (const auto* v = dynamic_cast<const Imf::V3fAttribute*>(&attribute)) return all_of(v->value(), 3);
    if (const auto* v = dynamic_cast<const Imf::V2dAttribute*>(&attribute)) return all_of(v->value(), 2);
    if (const auto* v = dynamic_cast<const Imf::V3dAttribute*>(&attribute)) return all_of(v->value(), 3);
    if (const auto* c = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&attribute)) {
        const Imf::Chromaticities& in = c->value();
        return {in.red.x, in.red.y, in.green.x, in.green.y, in.blue.x, in.blue.y, in.white.x, in.white.y};
    }
    return {};
}

// Luminance and its chroma are offered as the colour that OpenEXR makes of them.
Result<> turn_into_color(OpenPart& part, std::size_t part_count) {
    const Imf::ChannelList& stored = part.header().channels();
    const Imf::Channel *const ry = stored.findChannel("RY"), *const by = stored.findChannel("BY");
    part.is_luminance_chroma = part_count == 1 && stored.findChannel("Y") != nullptr && ry != nullptr && by != nullptr;
    if (!part.is_luminance_chroma) return {};
    // OpenEXR makes a grey picture of any other.
    for (const Imf::Channel* const chroma : {ry, by})
        if (chroma->xSampling != 2 || chroma->ySampling != 2)
            return user_error(fmt::format("RY and BY are sampled every {} x {} pixels: allowed is 2 x 2",
                                          chroma->xSampling, chroma->ySampling));
    for (Channel& channel : part.channels)
        for (const auto& [luminance_chroma, color] : {std::pair("RY", "R"), std::pair("Y", "G"), std::pair("BY", "B")})
            if (channel.name == luminance_chroma) channel.name = color;
    return {};
}

FilePart describe(const OpenPart& part) {
    const Imf::Header& header = part.header();
    const Imath::Box2i &data = part.window(), &display = header.displayWindow();
    FilePart out{.name = header.hasName() ? header.name() : "",
                 .view = header.hasView() ? header.view() : "",
                 .compression = name_of_compression(header.compression()),
                 .x = data.min.x - display.min.x,
                 .y = data.min.y - display.min.y,
                 .width = static_cast<std::uint32_t>(data.max.x - data.min.x + 1),
                 .height = static_cast<std::uint32_t>(data.max.y - data.min.y + 1),
                 .display_width = static_cast<std::uint32_t>(display.max.x - display.min.x + 1),
                 .display_height = static_cast<std::uint32_t>(display.max.y - display.min.y + 1),
                 .is_associated = true};
    if (const auto* const id = header.findTypedAttribute<Imf::StringAttribute>("colorInteropID"))
        out.color_space = id->value();
    out.has_primaries = !out.color_space.empty() || Imf::hasChromaticities(header);
    if (Imf::hasMultiView(header)) out.views = Imf::multiView(header);
    for (const Channel& channel : part.channels) {
        out.channels.push_back(channel.name);
        out.kinds.push_back(kind_of(channel.stored.type));
    }
    return out;
}

}  // namespace

struct ExrSource::State {
    std::span<const std::byte> bytes;
    std::size_t max_threads = 0;
    MemoryStream stream;
    std::unique_ptr<Imf::MultiPartInputFile> file;
    std::vector<OpenPart> parts;

    State(std::span<const std::byte> file_bytes, std::size_t threads)
        : bytes(file_bytes), max_threads(threads), stream(file_bytes) {}

    [[nodiscard]] int thread_count() const { return max_threads == 1 ? 0 : Imf::globalThreadCount(); }

    void read_plain(OpenPart& part, std::uint32_t row, std::uint32_t rows, std::span<const SamplePlace> places) const {
        const Imath::V2i origin(part.window().min.x, part.window().min.y + static_cast<int>(row));
        const std::int64_t width = part.window().max.x - part.window().min.x + 1;
        Imf::FrameBuffer buffer;
        for (const SamplePlace& place : places)
            buffer.insert(part.channels[place.channel].name,
                          Imf::Slice::Make(type_of(place.kind), place.first, origin, width, rows,
                                           static_cast<std::size_t>(place.pixel_bytes),
                                           static_cast<std::size_t>(place.row_bytes)));
        part.input.setFrameBuffer(buffer);
        part.input.readPixels(origin.y, origin.y + static_cast<int>(rows) - 1);
        part.input.setFrameBuffer({});  // it keeps hundreds of bytes for a channel
    }

    /// Each stored sample stands for a rectangle of pixels.
    template <class Sample>
    static void read_subsampled(OpenPart& part, std::uint32_t row, std::uint32_t rows, const SamplePlace& place) {
        const Channel& channel = part.channels[place.channel];
        const int x_step = channel.stored.xSampling, y_step = channel.stored.ySampling;
        const Imath::Box2i& window = part.window();
        const int top = window.min.y + static_cast<int>(row) / y_step * y_step;
        const int bottom = window.min.y + static_cast<int>(row + rows) - 1;
        const int width = window.max.x - window.min.x + 1;
        const auto columns = static_cast<std::size_t>((width + x_step - 1) / x_step);
        const auto lines = static_cast<std::size_t>((bottom - top) / y_step + 1);
        std::vector<Sample> samples(columns * lines);
        Imf::FrameBuffer buffer;
        buffer.insert(channel.name,
                      Imf::Slice::Make(std::is_same_v<Sample, float> ? Imf::FLOAT : Imf::UINT, samples.data(),
                                       Imath::V2i(window.min.x, top), width, bottom - top + 1, sizeof(Sample),
                                       columns * sizeof(Sample), x_step, y_step));
        part.input.setFrameBuffer(buffer);
        part.input.readPixels(top, bottom);
        for (std::uint32_t i = 0; i < rows; ++i) {
            const auto line = static_cast<std::size_t>((window.min.y + static_cast<int>(row + i) - top) / y_step);
            for (int x = 0; x < width; ++x)
                put(samples[line * columns + static_cast<std::size_t>(x / x_step)], place, i,
                    static_cast<std::uint32_t>(x));
        }
    }

    void read_luminance_chroma(const OpenPart& part, std::uint32_t row, std::uint32_t rows,
                               std::span<const SamplePlace> places) const {
        MemoryStream own(bytes);
        Imf::RgbaInputFile file_of_color(own, thread_count());
        const Imath::Box2i& window = part.window();
        const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
        std::vector<Imf::Rgba> pixels(width * rows);
        const int top = window.min.y + static_cast<int>(row);
        file_of_color.setFrameBuffer(reinterpret_cast<Imf::Rgba*>(reinterpret_cast<std::uintptr_t>(pixels.data()) -
                                                                  (static_cast<std::uintptr_t>(top) * width +
                                                                   static_cast<std::uintptr_t>(window.min.x)) *
                                                                      sizeof(Imf::Rgba)),
                                     1, width);
        file_of_color.readPixels(top, top + static_cast<int>(rows) - 1);
        for (const SamplePlace& place : places) {
            const std::string& name = part.channels[place.channel].name;
            half Imf::Rgba::*const component = name == "R"   ? &Imf::Rgba::r
                                               : name == "G" ? &Imf::Rgba::g
                                               : name == "B" ? &Imf::Rgba::b
                                                             : &Imf::Rgba::a;
            for (std::uint32_t y = 0; y < rows; ++y)
                for (std::uint32_t x = 0; x < width; ++x) put(float{pixels[y * width + x].*component}, place, y, x);
        }
    }

    template <class Sample>
    static void put(Sample value, const SamplePlace& place, std::uint32_t row, std::uint32_t x) {
        static_assert(std::is_same_v<Sample, float> || std::is_same_v<Sample, std::uint32_t>);
        std::byte* const to = place.first + static_cast<std::ptrdiff_t>(row) * place.row_bytes +
                              static_cast<std::ptrdiff_t>(x) * place.pixel_bytes;
        if (place.kind == SampleKind::Half) {
            const std::uint16_t bits = half(static_cast<float>(value)).bits();
            std::memcpy(to, &bits, sizeof bits);
        } else {
            std::memcpy(to, &value, sizeof value);
        }
    }
};

ExrSource::ExrSource(std::unique_ptr<State> state) : state_(std::move(state)) {}
ExrSource::~ExrSource() = default;

void start_exr_threads() {
    static std::once_flag once;
    std::call_once(once, [] {
        try {
            Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
        } catch (const std::exception&) {
            return;  // where none can be started the caller does the work
        }
    });
}

Result<std::unique_ptr<PictureSource>> ExrSource::open(std::span<const std::byte> bytes, std::size_t max_threads,
                                                       OpenElsewhere elsewhere) {
    if (max_threads != 1) start_exr_threads();
    auto state = std::make_unique<State>(bytes, max_threads);
    state->file = std::make_unique<Imf::MultiPartInputFile>(state->stream, state->thread_count());
    std::unique_ptr<ExrSource> out(new ExrSource(std::move(state)));
    out->open_elsewhere_ = std::move(elsewhere);
    State& made = *out->state_;
    for (int number = 0; number < made.file->parts(); ++number) {
        OpenPart& part = made.parts.emplace_back(*made.file, number);
        part.is_tiled = part.header().hasTileDescription();
        const Imf::ChannelList& stored = part.header().channels();
        for (auto channel = stored.begin(); channel != stored.end(); ++channel)
            part.channels.push_back({channel.name(), channel.channel(), part.channels.size()});
        DARKROOM_TRY(turn_into_color(part, static_cast<std::size_t>(made.file->parts())));
        std::sort(part.channels.begin(), part.channels.end(),
                  [](const Channel& a, const Channel& b) { return a.rank() < b.rank(); });
        out->parts_.push_back(describe(part));
    }
    return std::unique_ptr<PictureSource>(std::move(out));
}

const Imf::Header& ExrSource::header(std::size_t part) const { return state_->parts[part].header(); }

std::vector<double> ExrSource::numbers(std::size_t part, std::string_view attribute) const {
    const Imf::Header& from = header(part);
    // Whoever lists them asks for each, by its name.
    if (const auto found = from.find(std::string(attribute)); found != from.end()) return numbers_of(found.attribute());
    const std::string wanted = lower(attribute);
    for (auto found = from.begin(); found != from.end(); ++found)
        if (lower(found.name()) == wanted) return numbers_of(found.attribute());
    return {};
}

std::vector<std::string> ExrSource::attributes(std::size_t part) const {
    std::vector<std::string> names;
    for (auto found = header(part).begin(); found != header(part).end(); ++found) names.emplace_back(found.name());
    return names;
}

std::uint32_t ExrSource::row_unit(std::size_t part) const {
    const OpenPart& of = state_->parts[part];
    if (of.is_tiled) return of.header().tileDescription().ySize;
    // Whole chunks of every compression but DWAB.
    return of.header().compression() == Imf::DWAB_COMPRESSION ? 256 : 32;
}

Result<> ExrSource::read(std::size_t number, std::uint32_t row, std::uint32_t rows,
                         std::span<const SamplePlace> places) {
    OpenPart& part = state_->parts[number];
    for (const SamplePlace& place : places) {
        const SampleKind kind = parts_[number].kinds[place.channel];
        if (place.kind == SampleKind::Integer32 && (kind != place.kind || part.is_luminance_chroma))
            return user_error(fmt::format("{} is not read as {}", name_of(kind), name_of(place.kind)));
    }
    if (part.is_zip()) {
        std::vector<ZipChannel> channels(part.channels.size());
        for (const Channel& channel : part.channels) channels[channel.place].kind = kind_of(channel.stored.type);
        for (const SamplePlace& place : places) channels[part.channels[place.channel].place].place = &place;
        return read_zip_rows(part.input, channels, row, rows, state_->max_threads);
    }
    if (open_elsewhere_) {
        if (elsewhere_ == nullptr) {
            DARKROOM_TRY_VALUE(auto opened, open_elsewhere_());
            const auto is_same = [](const FilePart& a, const FilePart& b) {
                return a.width == b.width && a.height == b.height && a.channels == b.channels;
            };
            if (!std::ranges::equal(opened->parts(), parts_, is_same))
                return user_error("cannot be read as OpenEXR: its decoder fails");
            elsewhere_ = std::move(opened);
        }
        return elsewhere_->read_rows(number, row, rows, places);
    }
    std::vector<SamplePlace> plain, color;
    for (const SamplePlace& place : places) {
        const Channel& channel = part.channels[place.channel];
        if (part.is_luminance_chroma && std::string_view("RGBA").find(channel.name) != std::string_view::npos)
            color.push_back(place);
        else if (channel.is_subsampled())
            place.kind == SampleKind::Integer32 ? State::read_subsampled<std::uint32_t>(part, row, rows, place)
                                                : State::read_subsampled<float>(part, row, rows, place);
        else
            plain.push_back(place);
    }
    if (!color.empty()) state_->read_luminance_chroma(part, row, rows, color);
    if (!plain.empty()) state_->read_plain(part, row, rows, plain);
    return {};
}

}  // namespace darkroom
