// SPDX-License-Identifier: MIT
// Compute passes: their workgroups, shared variables, buffers and values.
#include <fmt/format.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "custom/description.hpp"
#include "custom/words.hpp"
#include "gpu/shader/glsl_scan.hpp"

namespace darkroom::custom {

namespace {

using Access = ComputePassDesc::Access;
using gpu::Token;

constexpr Names<std::uint32_t, 8> types{
    {{"uint", 4}, {"int", 4}, {"float", 4}, {"vec2", 8}, {"vec4", 16}, {"ivec2", 8}, {"ivec4", 16}, {"uvec4", 16}}};
/// Formats of images that compute passes write: every device stores these.
constexpr std::array stored_formats{VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT,
                                    VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32_SFLOAT};

Result<> add_buffer(Description& out, FileBuffer buffer, std::string_view name, std::string_view count) {
    DARKROOM_TRY(check_own_name(out, name));
    const auto number = parse_count(count, max_numbers);
    if (!number)
        return user_error(fmt::format("{}: {}: expected a count in [1, {}]", name,
                                      count.empty() ? "nothing" : printable(count), max_numbers));
    if (out.buffers.size() == max_images)
        return user_error(fmt::format("{}: a file has at most {} buffers and values", name, max_images));
    buffer.name = out.keep(name);
    buffer.count = *number;
    out.buffers.push_back(buffer);
    return {};
}

/// "NAME: REST", whose parts may be missing.
std::pair<std::string_view, std::string_view> halves(std::string_view text) {
    const std::size_t colon = std::min(text.find(':'), text.size());
    return {trimmed(text.substr(0, colon)), trimmed(text.substr(std::min(colon + 1, text.size())))};
}

/// "16x8", of no more invocations than every device has.
std::optional<std::array<std::uint32_t, 2>> parse_workgroup(std::string_view text) {
    const std::size_t cross = text.find('x');
    if (cross == std::string_view::npos) return std::nullopt;
    const auto width = parse_count(text.substr(0, cross), max_invocations),
               height = parse_count(text.substr(cross + 1), max_invocations);
    if (!width || !height || *width * *height > max_invocations) return std::nullopt;
    return std::array{*width, *height};
}

Result<> take_buffer(FileFunction& pass, FileBuffer& buffer) {
    if (std::ranges::find(pass.buffers, buffer.name, &FileBufferUse::name) != pass.buffers.end())
        return user_error(
            fmt::format("pass {} names '{}' twice: what it writes it may read, too", pass.name, buffer.name));
    // A value is what an earlier frame made of it.
    const bool is_there = buffer.is_written || buffer.is_value;
    pass.buffers.push_back({buffer.name, is_there ? Access::ReadWrite : Access::Write});
    buffer.is_written = true;
    return {};
}

Result<> take_outputs(Description& out, FileFunction& pass) {
    const std::vector<std::string_view> names = std::exchange(pass.outputs, {});
    for (const std::string_view name : names) {
        if (FileBuffer* const buffer = out.find_buffer(name)) {
            DARKROOM_TRY(take_buffer(pass, *buffer));
            continue;
        }
        DARKROOM_TRY_VALUE(const auto image, take_output(out, pass.name, name));
        if (std::ranges::find(stored_formats, image->format) == stored_formats.end())
            return user_error(fmt::format("pass {} writes '{}': allowed for @compute is rgba16f, rgba32f, rgba8, r32f",
                                          pass.name, name));
        pass.outputs.push_back(image->name);
    }
    if (pass.buffers.size() > max_buffers)
        return user_error(fmt::format("pass {} has {} buffers and values; at most {} are allowed", pass.name,
                                      pass.buffers.size(), max_buffers));
    if (pass.outputs.empty() && pass.groups[0] == 0 && pass.inputs.empty())
        return user_error(
            fmt::format("pass {}: no image whose size says how many groups there are: give their number, "
                        "as in `@compute {} 64x1 1x1`",
                        pass.name, pass.name));
    return {};
}

/// Bytes of `TYPE NAME[COUNT]...`; none: it is something else.
std::optional<std::uint32_t> bytes_of(std::span<const std::string_view> words) {
    if (words.size() < 2 || (words.size() - 2) % 3 != 0) return std::nullopt;
    const auto type = named(types, words[0]);
    if (!type) return std::nullopt;
    std::uint64_t bytes = *type;
    for (std::size_t i = 2; i < words.size(); i += 3) {
        const auto count = parse_count(words[i + 1], max_shared_bytes);
        if (words[i] != "[" || !count || words[i + 2] != "]") return std::nullopt;
        bytes = std::min<std::uint64_t>(bytes * *count, max_shared_bytes + 1);
    }
    return static_cast<std::uint32_t>(bytes);
}

}  // namespace

FileBuffer* Description::find_buffer(std::string_view name) {
    const auto found = std::ranges::find(buffers, name, &FileBuffer::name);
    return found == buffers.end() ? nullptr : &*found;
}

Result<> declare_value(Description& out, std::string_view text) {
    const auto [name, count] = halves(text);
    return add_buffer(out, {.is_value = true}, name, count);
}

Result<> declare_buffer(Description& out, std::string_view text) {
    auto [name, rest] = halves(text);
    const std::string_view count = next_word(rest);
    const auto type = std::ranges::find(types, rest, &decltype(types)::value_type::first);
    DARKROOM_TRY(check_name(name));
    if (type == types.end())
        return user_error(
            fmt::format("{}: type {}: allowed is {}", name, rest.empty() ? "nothing" : printable(rest), listed(types)));
    return add_buffer(out, {.type = type->first, .element_bytes = type->second}, name, count);
}

Result<FileFunction> read_compute(Description& out, std::string_view text) {
    std::string_view head = trimmed(text.substr(0, text.find(':')));
    FileFunction pass{.name = next_word(head), .is_compute = true};
    const std::string_view workgroup = next_word(head), groups = next_word(head);
    const auto own = parse_workgroup(workgroup);
    DARKROOM_TRY(check_name(pass.name));
    if (!own)
        return user_error(fmt::format("pass {}: workgroup {}: expected WIDTHxHEIGHT, at most {} together", pass.name,
                                      workgroup.empty() ? "nothing" : printable(workgroup), max_invocations));
    pass.workgroup = *own;
    if (!groups.empty()) {
        const auto number = parse_workgroup(groups);
        if (!number || !head.empty())
            return user_error(fmt::format("pass {}: groups {}: expected WIDTHxHEIGHT, at most {} together", pass.name,
                                          printable(number ? head : groups), max_invocations));
        pass.groups = *number;
    }
    DARKROOM_TRY_VALUE(auto made, read_arrow(out, std::move(pass), text,
                                             "@compute NAME WIDTHxHEIGHT: IMAGE ... -> IMAGE, BUFFER or VALUE ..."));
    DARKROOM_TRY(take_outputs(out, made));
    return made;
}

Result<> read_shared(FileFunction& function, std::string_view code, std::size_t& line) {
    line = 1;
    gpu::GlslScanner scanner(code);
    std::optional<std::vector<std::string_view>> words;  // of a declaration
    std::uint32_t bytes = 0;
    for (Token token = scanner.next(); token.kind != Token::Kind::End; token = scanner.next()) {
        const std::size_t lines = static_cast<std::size_t>(std::ranges::count(token.text, '\n'));
        if (words && token.text == ";") {
            const auto size = bytes_of(*words);
            if (!size)
                return user_error(
                    fmt::format("shared: expected `shared TYPE NAME[COUNT];`, TYPE one of {}", listed(types)));
            bytes += *size;
            if (bytes > max_shared_bytes)
                return user_error(fmt::format("shared: more than {} bytes; as many are allowed", max_shared_bytes));
            words.reset();
        } else if (words && token.kind != Token::Kind::Blank) {
            words->push_back(token.text);
        } else if (token.kind == Token::Kind::Word && token.text == "shared") {
            if (!function.is_compute) return user_error("shared: the code of a @compute pass alone has such variables");
            words.emplace();
        }
        line += lines;
    }
    function.shared_bytes = bytes;
    return {};
}

}  // namespace darkroom::custom
