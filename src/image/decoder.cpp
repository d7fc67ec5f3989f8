// SPDX-License-Identifier: MIT
#include "image/decoder.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <tuple>

#include "core/files.hpp"
#include "image/exr_check.hpp"
#include "image/memory_input.hpp"

namespace darkroom {
namespace {

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

// The fewest bytes that a picture of this kind can take, so that a few damaged bytes of header cannot ask for
// gigabytes. PNG and TIFF: deflate makes at most 1032 bytes from one; TIFF may also hold fax runs, hence the smaller
// claim. JPEG: a bit for each block of 8x8 (ITU-T T.81). Radiance: 4 bytes a line, and 2 for each run of at most 127 in
// each of the 4 components; lines shorter than 8 or longer than 32767 pixels are not packed.
double smallest_size(FileKind kind, const OIIO::ImageSpec& spec) {
    const double width = spec.width;
    const double height = spec.height;
    switch (kind) {
        case FileKind::OpenExr:
        case FileKind::Png:
            return 0;  // check_exr and check_png have seen to it
        case FileKind::Jpeg:
            return width * height / 64 / 8;
        case FileKind::Tiff:
            return width * height / 8 / 4096;
        case FileKind::Radiance:
            return height *
                   (width < 8 || width > 32767 ? 4 * width : 4 + 8 * static_cast<double>((spec.width + 126) / 127));
    }
    return 0;
}

}  // namespace

std::string_view name_of(FileKind kind) {
    switch (kind) {
        case FileKind::OpenExr:
            return "OpenEXR";
        case FileKind::Png:
            return "PNG";
        case FileKind::Jpeg:
            return "JPEG";
        case FileKind::Tiff:
            return "TIFF";
        case FileKind::Radiance:
            return "Radiance HDR";
    }
    return "";
}

std::string_view name_of(SampleKind kind) {
    switch (kind) {
        case SampleKind::Integer8:
            return "8-bit integer";
        case SampleKind::Integer16:
            return "16-bit integer";
        case SampleKind::Integer32:
            return "32-bit integer";
        case SampleKind::Half:
            return "half";
        case SampleKind::Float:
            return "float";
    }
    return "";
}

std::string one_printable_line(std::string_view text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
    std::string result(text.substr(0, std::min<std::size_t>(text.find('\n'), 300)));
    for (char& character : result)
        if (character < ' ' || character > '~') character = '?';
    return result;
}

struct Decoder::State {
    std::string path;
    std::vector<std::byte> bytes;
    std::optional<MemoryInput> memory;  // after `bytes`
    std::vector<FilePart> parts;
    std::vector<OIIO::ImageSpec> specs;

    [[nodiscard]] Failure error(std::string_view what) const {
        return user_error(fmt::format("{}: {}", path, one_printable_line(what)));
    }
    [[nodiscard]] Result<> add_parts();
    [[nodiscard]] Result<> add_part(const OIIO::ImageSpec& spec);
};

Result<> Decoder::State::add_parts() {
    OIIO::ImageInput& input = memory->input();
    do {
        if (auto added = add_part(input.spec()); !added) return added;
    } while (memory->kind() == FileKind::OpenExr && parts.size() < 256 &&
             input.seek_subimage(static_cast<int>(parts.size()), 0));
    std::ignore = input.geterror();
    return {};
}

Result<> Decoder::State::add_part(const OIIO::ImageSpec& spec) {
    if (spec.deep) return error("has deep pixels, which are not read here; flatten it first");
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.full_width < 1 || spec.full_height < 1)
        return error(fmt::format("the picture is {}x{}, at least 1x1 is needed", spec.width, spec.height));
    if (std::max({spec.width, spec.height, spec.full_width, spec.full_height}) > max_picture_side)
        return error(fmt::format("the picture is {}x{}, at most {} a side is allowed", spec.width, spec.height,
                                 max_picture_side));
    // Only what would take much memory is refused unread: the decoder knows better what is wrong with a small file.
    constexpr double large = 1 << 22;
    if (static_cast<double>(spec.width) * spec.height > large &&
        static_cast<double>(bytes.size()) < smallest_size(memory->kind(), spec))
        return error(fmt::format("a picture of {}x{} cannot be in a file of {} bytes: truncated, or a damaged header",
                                 spec.width, spec.height, bytes.size()));
    FilePart part;
    part.name = spec.get_string_attribute("oiio:subimagename");
    part.view = spec.get_string_attribute("view");
    part.channels = spec.channelnames;
    part.channels.resize(static_cast<std::size_t>(spec.nchannels));
    for (int channel = 0; channel < spec.nchannels; ++channel) {
        const auto sample_kind = sample_kind_of(spec.channelformat(channel));
        if (!sample_kind)
            return error(fmt::format("samples of type {}; 8 or 16 bits, half or float are needed",
                                     spec.channelformat(channel).c_str()));
        part.kinds.push_back(*sample_kind);
    }
    part.width = static_cast<std::uint32_t>(spec.width);
    part.height = static_cast<std::uint32_t>(spec.height);
    if (memory->kind() == FileKind::OpenExr) {
        part.x = spec.x - spec.full_x;
        part.y = spec.y - spec.full_y;
        part.display_width = static_cast<std::uint32_t>(spec.full_width);
        part.display_height = static_cast<std::uint32_t>(spec.full_height);
    } else {
        part.display_width = part.width;
        part.display_height = part.height;
    }
    parts.push_back(std::move(part));
    specs.push_back(spec);
    return {};
}

Decoder::Decoder(std::unique_ptr<State> state) : state_(std::move(state)) {}
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;
Decoder::~Decoder() = default;

Result<Decoder> Decoder::open(const std::filesystem::path& path) {
    // A pipe ends, a device may not.
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status))
        return user_error(fmt::format("{}: is a device, expected an image file", one_printable_line(path.string())));
    auto bytes = read_file(path);
    if (!bytes) return failure(std::move(bytes));
    auto state = std::make_unique<State>();
    state->path = path.string();
    state->bytes = std::move(*bytes);
    auto memory = MemoryInput::open(state->bytes);
    if (!memory) return state->error(memory.error().text);
    state->memory = std::move(*memory);
    try {
        if (auto added = state->add_parts(); !added) return failure(std::move(added).error());
    } catch (const std::exception& exception) {
        return state->error(fmt::format("cannot be read as {}: {}", name_of(state->memory->kind()), exception.what()));
    }
    return Decoder(std::move(state));
}

FileKind Decoder::kind() const { return state_->memory->kind(); }
std::span<const FilePart> Decoder::parts() const { return state_->parts; }

std::vector<float> Decoder::numbers(std::size_t part, const std::string& attribute) const {
    const OIIO::ParamValue* found = state_->specs[part].find_attribute(attribute);
    if (found == nullptr) return {};
    const auto count = static_cast<std::size_t>(found->type().basevalues());
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (found->type().basetype == OIIO::TypeDesc::FLOAT)
            values[i] = static_cast<const float*>(found->data())[i];
        else if (found->type().basetype == OIIO::TypeDesc::DOUBLE)
            values[i] = static_cast<float>(static_cast<const double*>(found->data())[i]);
        else
            return {};
    }
    return values;
}

std::optional<double> Decoder::number(std::size_t part, const std::string& attribute) const {
    const OIIO::ParamValue* found = state_->specs[part].find_attribute(attribute);
    if (found == nullptr || found->type().basevalues() != 1) return std::nullopt;
    if (found->type().basetype == OIIO::TypeDesc::FLOAT) return *static_cast<const float*>(found->data());
    if (found->type().basetype == OIIO::TypeDesc::DOUBLE) return *static_cast<const double*>(found->data());
    if (found->type().basetype == OIIO::TypeDesc::INT32) return *static_cast<const int*>(found->data());
    return std::nullopt;
}

bool Decoder::has_attribute_starting(std::size_t part, std::string_view start) const {
    const auto& attributes = state_->specs[part].extra_attribs;
    return std::any_of(attributes.begin(), attributes.end(),
                       [&](const OIIO::ParamValue& value) { return value.name().string().starts_with(start); });
}

Result<> Decoder::read(std::size_t part, std::uint32_t first, std::uint32_t count, const Sink& sink) {
    const OIIO::ImageSpec& spec = state_->specs[part];
    const int subimage = static_cast<int>(part);
    const int begin = static_cast<int>(first);
    const int end = static_cast<int>(first + count);
    // Bands of 128 rows hold whole chunks of every compression but DWAB (256 rows) and let several be decoded at once.
    const std::string compression = spec.get_string_attribute("compression");
    int unit = compression.starts_with("dwab") ? 256 : 32;
    if (spec.tile_height > 0) unit = spec.tile_height;
    const std::size_t row_values = std::size_t{count} * static_cast<std::size_t>(spec.width);
    constexpr std::size_t most_values = std::size_t{1} << 24;
    const auto fitting = static_cast<int>(std::min<std::size_t>(most_values / row_values, 128));
    const int rows = std::max(unit, fitting / unit * unit);
    try {
        std::vector<float> samples;
        for (int row = 0; row < spec.height; row += rows) {
            const int height = std::min(rows, spec.height - row);
            samples.resize(row_values * static_cast<std::size_t>(height));
            const int top = spec.y + row;
            const bool is_read =
                spec.tile_width > 0
                    ? state_->memory->input().read_tiles(subimage, 0, spec.x, spec.x + spec.width, top, top + height, 0,
                                                         1, begin, end, OIIO::TypeFloat, samples.data())
                    : state_->memory->input().read_scanlines(subimage, 0, top, top + height, 0, begin, end,
                                                             OIIO::TypeFloat, samples.data());
            if (!is_read) return state_->error(fmt::format("damaged or truncated: {}", state_->memory->reason()));
            sink(static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(height), samples);
        }
    } catch (const std::exception& exception) {
        return state_->error(fmt::format("cannot be decoded: {}", exception.what()));
    }
    return {};
}

}  // namespace darkroom
