// SPDX-License-Identifier: MIT
// Images, and the passes that write them. Every image is written once, and read behind that, so there is an order, no
// cycle, and nothing that is read and written at the same time.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/text/param_text.hpp"
#include "custom/description.hpp"
#include "custom/words.hpp"
#include "plan/text/glsl_names.hpp"

namespace darkroom::custom {

namespace {

constexpr Names<VkFormat, 10> formats{{{"rgba16f", VK_FORMAT_R16G16B16A16_SFLOAT},
                                       {"rgba32f", VK_FORMAT_R32G32B32A32_SFLOAT},
                                       {"rgba8", VK_FORMAT_R8G8B8A8_UNORM},
                                       {"rg16f", VK_FORMAT_R16G16_SFLOAT},
                                       {"rg32f", VK_FORMAT_R32G32_SFLOAT},
                                       {"rg8", VK_FORMAT_R8G8_UNORM},
                                       {"r16f", VK_FORMAT_R16_SFLOAT},
                                       {"r32f", VK_FORMAT_R32_SFLOAT},
                                       {"r8", VK_FORMAT_R8_UNORM},
                                       {"r11f_g11f_b10f", VK_FORMAT_B10G11R11_UFLOAT_PACK32}}};

struct TableFormat {
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::size_t channels = 1;
    bool is_float = true;
};
constexpr Names<TableFormat, 4> table_formats{{{"r32f", {VK_FORMAT_R32_SFLOAT}},
                                               {"rgba32f", {VK_FORMAT_R32G32B32A32_SFLOAT, 4}},
                                               {"r8", {VK_FORMAT_R8_UNORM, 1, false}},
                                               {"rgba8", {VK_FORMAT_R8G8B8A8_UNORM, 4, false}}}};

constexpr std::string_view previous_end = "_previous";

/// "1/2" or "1".
std::optional<OutputScale> parse_ratio(std::string_view text) {
    constexpr std::uint32_t most = 64, largest = 2;
    const std::size_t slash = text.find('/');
    const auto numerator = parse_count(text.substr(0, slash), most);
    const auto denominator =
        slash == std::string_view::npos ? std::optional(1u) : parse_count(text.substr(slash + 1), most);
    if (!numerator || !denominator || *numerator > largest * *denominator) return std::nullopt;
    return OutputScale{*numerator, *denominator};
}

Result<> read_values(FileImage& image, const TableFormat& format, std::string_view text) {
    const std::size_t count = std::size_t{image.table.extent.width} * image.table.extent.height * format.channels;
    std::vector<std::string_view> words;
    if (!trimmed(text).empty()) words = split(text, ',');
    if (words.size() != count)
        return user_error(fmt::format("{}: {} values, its {} x {} texels of {} take {}", image.name, words.size(),
                                      image.table.extent.width, image.table.extent.height,
                                      format.channels == 1 ? "one" : "four", count));
    for (const std::string_view word : words) {
        const auto value = parse_number(word);
        const bool is_allowed =
            value && std::isfinite(static_cast<float>(*value)) && (format.is_float || (*value >= 0 && *value <= 1));
        if (!is_allowed)
            return user_error(fmt::format("{}: value {}: expected {}", image.name, printable(word),
                                          format.is_float ? "a number" : "a number in [0, 1]"));
        const auto number = static_cast<float>(*value);
        std::array<std::byte, sizeof number> bytes{static_cast<std::byte>(std::lround(number * 255))};
        if (format.is_float) std::memcpy(bytes.data(), &number, sizeof number);
        image.table.data.insert(image.table.data.end(), bytes.begin(), bytes.begin() + (format.is_float ? 4 : 1));
    }
    return {};
}

/// "64x1 r32f = 0.1, 0.2"
Result<> read_table(FileImage& image, std::string_view text) {
    const std::size_t equals = text.find('=');
    std::string_view head = text.substr(0, equals);
    const std::string_view extent = next_word(head), format_name = next_word(head);
    if (equals == std::string_view::npos || !head.empty())
        return user_error(
            fmt::format("{}: expected `@table {}: WIDTHxHEIGHT FORMAT = VALUE, VALUE`", image.name, image.name));
    const std::size_t cross = extent.find('x');
    const auto width = parse_count(extent.substr(0, cross), max_table_texels);
    const auto height =
        cross == std::string_view::npos ? std::nullopt : parse_count(extent.substr(cross + 1), max_table_texels);
    if (!width || !height || std::size_t{*width} * *height > max_table_texels)
        return user_error(fmt::format("{}: {}: expected WIDTHxHEIGHT, at most {} texels", image.name, printable(extent),
                                      max_table_texels));
    const auto format = named(table_formats, format_name);
    if (!format)
        return user_error(
            fmt::format("{}: {}: allowed is {}", image.name, printable(format_name), listed(table_formats)));
    image.format = format->format;
    image.table = {.name = std::string(image.name), .format = format->format, .extent = {*width, *height, 1}};
    return read_values(image, *format, text.substr(equals + 1));
}

Result<> check_image_name(Description& out, FileImage::Kind kind, std::string_view name) {
    DARKROOM_TRY(check_own_name(out, name));
    const std::string previous = std::string(name) + std::string(previous_end);
    if (kind == FileImage::Kind::History && out.find_image(previous) != nullptr)
        return user_error(fmt::format("{}: declared twice", name));
    if (out.images.size() == max_images)
        return user_error(fmt::format("{}: a file has at most {} images", name, max_images));
    return {};
}

std::string readable(const Description& from) {
    std::vector<std::string> names{"picture", "source"};
    for (const FileImage& image : from.images) {
        names.emplace_back(image.name);
        if (image.kind == FileImage::Kind::History) names.push_back(names.back() + std::string(previous_end));
    }
    for (const FileBuffer& buffer : from.buffers) names.emplace_back(buffer.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

/// `reader`: "pass across" or "@end".
Result<> check_input(Description& from, const std::string& reader, std::string_view name) {
    if (name == "picture" || name == "source") return {};
    if (name.ends_with(previous_end)) {
        const FileImage* const image = from.find_image(name.substr(0, name.size() - previous_end.size()));
        if (image != nullptr && image->kind == FileImage::Kind::History) return {};
    }
    const FileImage* const image = from.find_image(name);
    if (image == nullptr)
        return user_error(fmt::format("{} reads '{}': there is no such image, there are {}", reader, printable(name),
                                      readable(from)));
    if (image->kind != FileImage::Kind::Table && !image->is_written)
        return user_error(fmt::format("{} reads '{}', which no pass before it writes", reader, name));
    return {};
}

Result<> read_inputs(Description& from, FileFunction& out, const std::string& reader, std::string_view text) {
    while (!text.empty()) {
        const std::string_view name = next_word(text);
        if (std::ranges::find(out.inputs, name) != out.inputs.end() ||
            std::ranges::find(out.buffers, name, &FileBufferUse::name) != out.buffers.end())
            return user_error(fmt::format("{} reads '{}' twice", reader, printable(name)));
        if (const FileBuffer* const buffer = from.find_buffer(name)) {
            if (!buffer->is_value && !out.is_compute)
                return user_error(
                    fmt::format("{} reads '{}': a buffer is for @compute passes, a @value for all", reader, name));
            if (!buffer->is_written)
                return user_error(fmt::format("{} reads '{}', which no pass before it writes", reader, name));
            out.buffers.push_back({.name = buffer->name});
            continue;
        }
        DARKROOM_TRY(check_input(from, reader, name));
        out.inputs.push_back(from.keep(name));
        if (out.inputs.size() > max_inputs)
            return user_error(fmt::format("{} reads more than {} images", reader, max_inputs));
    }
    return {};
}

}  // namespace

Result<> check_own_name(Description& out, std::string_view name) {
    DARKROOM_TRY(check_name(name));
    const bool is_reserved = name == "source" || name == "second" || name.ends_with(previous_end) ||
                             name.starts_with("frame_") || name.starts_with("shared_") || name.starts_with("darkroom_");
    if (is_reserved || plan::is_function_name(name))
        return user_error(fmt::format("{}: is taken by the notation or by GLSL; choose another name", name));
    if (out.find_image(name) != nullptr || out.find_buffer(name) != nullptr)
        return user_error(fmt::format("{}: declared twice", name));
    return {};
}

FileImage* Description::find_image(std::string_view name) {
    const auto found = std::ranges::find(images, name, &FileImage::name);
    return found == images.end() ? nullptr : &*found;
}

Result<> read_image(Description& out, FileImage::Kind kind, std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string_view name = trimmed(text.substr(0, colon));
    DARKROOM_TRY(check_image_name(out, kind, name));
    std::string_view rest = colon == std::string_view::npos ? std::string_view{} : trimmed(text.substr(colon + 1));
    FileImage image{.name = out.keep(name), .kind = kind};
    if (kind == FileImage::Kind::Table) {
        DARKROOM_TRY(read_table(image, rest));
    } else {
        const std::string_view ratio = next_word(rest), format_name = next_word(rest);
        const auto scale = parse_ratio(ratio);
        if (!scale)
            return user_error(fmt::format("{}: size {}: expected its share of the picture, as 1, 1/2 or 3/4, at most 2",
                                          name, ratio.empty() ? "nothing" : printable(ratio)));
        const auto format = named(formats, format_name);
        if (!format || !rest.empty())
            return user_error(fmt::format("{}: format {}: allowed is {}", name,
                                          format ? printable(rest) : printable(format_name), listed(formats)));
        image.ratio = *scale;
        image.format = *format;
    }
    out.images.push_back(std::move(image));
    return {};
}

Result<> read_result(Description& out, std::string_view text) {
    const FileImage* const image = out.find_image(text);
    if (image == nullptr || image->kind == FileImage::Kind::Table)
        return user_error(
            fmt::format("@result {}: expected an image or a history that a line before it declares", printable(text)));
    if (!out.result.empty()) return user_error("a second @result; an effect has one");
    out.result = image->name;
    out.info.output_scale = {.numerator = image->ratio.numerator, .denominator = image->ratio.denominator};
    return {};
}

Result<> read_pre_roll(Description& out, std::string_view text) {
    const auto frames = text == "0" ? std::optional(0u) : parse_count(text, max_pre_roll);
    if (!frames)
        return user_error(
            fmt::format("@pre_roll {}: expected a number of frames in [0, {}]", printable(text), max_pre_roll));
    out.pre_roll = frames;
    return {};
}

Result<FileFunction> read_arrow(Description& out, FileFunction pass, std::string_view text, std::string_view usage) {
    const std::string_view name = pass.name;
    DARKROOM_TRY(check_name(name));
    if (name == "parameters" || name == "custom")
        return user_error(fmt::format("{}: is taken by the notation or by GLSL; choose another name", name));
    if (std::ranges::find(out.passes, name, &FileFunction::name) != out.passes.end())
        return user_error(fmt::format("pass {}: declared twice", name));
    if (out.passes.size() == max_passes)
        return user_error(fmt::format("pass {}: a file has at most {} passes", name, max_passes));
    const std::size_t colon = text.find(':'), arrow = text.find("->");
    if (colon == std::string_view::npos || arrow == std::string_view::npos || arrow < colon)
        return user_error(fmt::format("pass {}: expected `{}`", name, usage));
    pass.name = out.keep(name);
    DARKROOM_TRY(
        read_inputs(out, pass, fmt::format("pass {}", name), trimmed(text.substr(colon + 1, arrow - colon - 1))));
    for (std::string_view rest = trimmed(text.substr(arrow + 2)); !rest.empty();)
        pass.outputs.push_back(next_word(rest));
    if (pass.outputs.size() > max_outputs)
        return user_error(
            fmt::format("pass {} writes {} images; at most {} are allowed", name, pass.outputs.size(), max_outputs));
    return pass;
}

Result<FileImage*> take_output(Description& out, std::string_view pass, std::string_view name) {
    FileImage* const image = out.find_image(name);
    if (image == nullptr || image->kind == FileImage::Kind::Table)
        return user_error(
            fmt::format("pass {} writes '{}': expected an image or a history of the file", pass, printable(name)));
    if (image->is_written)
        return user_error(fmt::format("pass {} writes '{}', which a pass before it writes", pass, name));
    image->is_written = true;
    return image;
}

Result<FileFunction> read_pass(Description& out, std::string_view text) {
    const std::string_view name = trimmed(text.substr(0, text.find(':')));
    DARKROOM_TRY_VALUE(auto pass,
                       read_arrow(out, {.name = name}, text, fmt::format("@pass {}: IMAGE IMAGE -> IMAGE", name)));
    if (pass.outputs.empty()) pass.outputs.emplace_back();
    const FileImage* first = nullptr;
    for (std::string_view& output : pass.outputs) {
        DARKROOM_TRY_VALUE(const auto image, take_output(out, pass.name, output));
        output = image->name;
        if (first == nullptr) first = image;
        const OutputScale &a = first->ratio, &b = image->ratio;
        if (a.numerator * b.denominator != b.numerator * a.denominator)
            return user_error(
                fmt::format("pass {} writes '{}' and '{}', which differ in size", pass.name, first->name, output));
    }
    return pass;
}

Result<FileFunction> read_end(Description& out, std::string_view text) {
    if (!out.result.empty())
        return user_error(fmt::format("@end: the effect's picture is @result {}, it has no end", out.result));
    FileFunction end;
    DARKROOM_TRY(read_inputs(out, end, "@end", text));
    if (std::ranges::find(end.inputs, "picture") != end.inputs.end())
        return user_error("@end reads 'picture': the end has it as `color` already");
    return end;
}

Result<> check_passes(Description& out) {
    const auto is_history = [](const FileImage& image) { return image.kind == FileImage::Kind::History; };
    const bool has_history = std::ranges::any_of(out.images, is_history);
    const std::string prefix = std::string(out.info.name) + "_";
    for (const FileImage& image : out.images) {
        if (image.name == out.info.name || image.name.starts_with(prefix))
            return user_error(
                fmt::format("image {}: names that begin with the effect's name are for functions", image.name));
        if (image.kind != FileImage::Kind::Table && !image.is_written)
            return user_error(fmt::format("image {}: no pass writes it", image.name));
    }
    for (const FileBuffer& buffer : out.buffers) {
        const std::string_view kind = buffer.is_value ? "value" : "buffer";
        if (buffer.name == out.info.name || buffer.name.starts_with(prefix))
            return user_error(
                fmt::format("{} {}: names that begin with the effect's name are for functions", kind, buffer.name));
        if (!buffer.is_written) return user_error(fmt::format("{} {}: no pass writes it", kind, buffer.name));
    }
    if (has_history && !out.pre_roll)
        return user_error(
            "a history without `@pre_roll FRAMES`, the number of earlier frames that a right picture needs");
    if (!has_history && out.pre_roll) return user_error("@pre_roll: the file has no history");
    if (out.result.empty()) return {};
    if (out.info.touch == Touch::Warp) return user_error("@touch warp: with @result the passes make the picture");
    if (out.info.has_second())
        return user_error("@needs second: the end alone reads it, and with @result there is none");
    out.info.touch = has_history ? Touch::History : Touch::Neighbourhood;
    return {};
}

}  // namespace darkroom::custom
