// SPDX-License-Identifier: MIT
#include "image/codec/decoder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/files.hpp"
#include "formats/exr/exr_source.hpp"
#include "image/color/interop_space.hpp"
#include "image/picture/oriented_source.hpp"

namespace darkroom {

struct Decoder::State {
    std::string path;
    std::vector<std::byte> bytes;
    OpenedSource opened;  // after `bytes`

    [[nodiscard]] Failure error(const Error& of) const {
        return failure({of.fault, fmt::format("{}: {}", path, of.text)});
    }
};

Decoder::Decoder(std::unique_ptr<State> state) : state_(std::move(state)) {}
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;
Decoder::~Decoder() = default;

Result<Decoder> Decoder::open(const std::filesystem::path& path, std::size_t max_threads, DecodingPlace place) {
    auto state = std::make_unique<State>();
    state->path = path.string();
    DARKROOM_TRY_VALUE(state->bytes, read_image_file(path));
    auto opened = open_upright(state->bytes, max_threads, place);
    if (!opened) return state->error(opened.error());
    state->opened = std::move(*opened);
    return Decoder(std::move(state));
}

const FileFormat& Decoder::format() const { return *state_->opened.format; }
FileColor Decoder::color(std::size_t part) const {
    const std::vector<float> values = numbers(part, "chromaticities");
    FileColor out;
    if (format().color != nullptr) out = format().color(state_->bytes, is_integer(parts()[part].kinds.front()));
    if (values.size() == 8)
        out = {.coding = ColorCoding{{.red = {values[0], values[1]},
                                      .green = {values[2], values[3]},
                                      .blue = {values[4], values[5]},
                                      .white = {values[6], values[7]}},
                                     {}},
               .said = "chromaticities"};
    const std::string& id = parts()[part].color_space;
    if (id.empty()) return out;
    const std::string shown = one_printable_line(id);
    const std::optional<InteropSpace> space = find_interop_space(id);
    if (!space)
        out.warning = fmt::format("colorInteropID '{}' is no name that is known, and is not obeyed", shown);
    else if (space->is_data)
        out = {.warning = "colorInteropID says that its color is data: taken as linear Rec. 709"};
    else if (!space->is_unknown) {
        if (out.coding && !is_near(out.coding->primaries, space->coding.primaries))
            out.warning = fmt::format("colorInteropID '{}' and the chromaticities differ: the first is obeyed", shown);
        out.coding = space->coding;
        out.said = "colorInteropID " + shown;
    }
    return out;
}
std::string Decoder::left_out() const { return format().left_out == nullptr ? "" : format().left_out(state_->bytes); }
std::span<const FilePart> Decoder::parts() const { return state_->opened.source->parts(); }

std::vector<float> Decoder::numbers(std::size_t part, const std::string& attribute) const {
    std::vector<float> out;
    for (const double value : state_->opened.source->numbers(part, attribute)) out.push_back(static_cast<float>(value));
    return out;
}

std::optional<double> Decoder::number(std::size_t part, const std::string& attribute) const {
    const std::vector<double> values = state_->opened.source->numbers(part, attribute);
    return values.size() == 1 ? std::optional(values.front()) : std::nullopt;
}

bool Decoder::has_attribute_starting(std::size_t part, std::string_view start) const {
    const std::vector<std::string> names = state_->opened.source->attributes(part);
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) { return name.starts_with(start); });
}

std::shared_ptr<const ExrAttributes> Decoder::attributes(std::size_t part, ExrAttributes::Of of) const {
    const auto* const exr = dynamic_cast<const ExrSource*>(state_->opened.source.get());
    return exr == nullptr ? nullptr : std::make_shared<const ExrAttributes>(exr->header(part), of);
}

std::uint32_t Decoder::band_rows(std::size_t part, std::size_t row_bytes) const {
    constexpr std::size_t max_bytes = std::size_t{1} << 26;
    const std::uint32_t unit = state_->opened.source->row_unit(part);
    const auto fitting = static_cast<std::uint32_t>(std::clamp<std::size_t>(max_bytes / row_bytes, 1, 128));
    return std::max(unit, fitting / unit * unit);
}

void Decoder::set_display_window(const PixelWindow& window) { state_->opened.source->set_display_window(window); }

Result<> Decoder::read(std::size_t part, std::uint32_t first, std::uint32_t count, const Sink& sink) {
    const FilePart& of = parts()[part];
    const std::size_t row_values = std::size_t{count} * of.width;
    const std::uint32_t band = band_rows(part, row_values * sizeof(float));
    std::vector<float> samples;
    for (std::uint32_t row = 0; row < of.height; row += band) {
        const std::uint32_t rows = std::min(band, of.height - row);
        samples.resize(row_values * rows);
        std::vector<SamplePlace> places;
        for (std::uint32_t c = 0; c < count; ++c)
            places.push_back({.channel = first + c,
                              .first = reinterpret_cast<std::byte*>(samples.data() + c),
                              .pixel_bytes = static_cast<std::ptrdiff_t>(count * sizeof(float)),
                              .row_bytes = static_cast<std::ptrdiff_t>(row_values * sizeof(float))});
        DARKROOM_TRY(read_rows(part, row, rows, places));
        sink(row, rows, samples);
    }
    return {};
}

Result<> Decoder::read_rows(std::size_t part, std::uint32_t row, std::uint32_t rows,
                            std::span<const SamplePlace> places) {
    auto done = state_->opened.source->read_rows(part, row, rows, places);
    return done ? done : state_->error(done.error());
}

}  // namespace darkroom
