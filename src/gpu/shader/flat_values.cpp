// SPDX-License-Identifier: MIT
#include "gpu/shader/flat_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "gpu/device/context.hpp"

namespace darkroom::gpu {

namespace {

// 128 components, less the 7 of what every vertex shader may write: position, point size, clip and cull distance.
constexpr std::size_t most_flat_vectors = 30;
constexpr std::uint32_t components_of_vertices = 128;
constexpr std::string_view custom = "custom";

/// NAME[1], NAME(1), vec4 NAME(int index) and its NAME[1 + index]. An array whose index is found out for each pixel
/// must stay in memory.
bool is_literal(GlslScanner after_name) {
    const auto next = [&] {
        Token token = after_name.next();
        while (token.kind == Token::Kind::Blank) token = after_name.next();
        return token;
    };
    next();
    const Token index = next();
    if (index.kind != Token::Kind::Number) return index.text == "int";
    const std::string_view mark = next().text;
    return mark == "]" || mark == ")" || (mark == "+" && next().text == "index");
}

std::uint32_t vector_count(std::span<const BlockMember> members) { return (word_count(members) + 3) / 4; }

/// The input that a vector is, if it is one.
std::optional<std::size_t> location_of(const std::vector<std::uint32_t>& vectors, std::uint32_t vector) {
    const auto found = std::ranges::find(vectors, vector);
    if (found == vectors.end()) return std::nullopt;
    return static_cast<std::size_t>(found - vectors.begin());
}

std::string value_of(std::string_view type, std::size_t location, std::uint32_t word) {
    const std::string_view cast = type == "float" || type == "vec4" ? "uintBitsToFloat" : type;
    const bool is_vector = type.ends_with("4");
    return fmt::format("{}(darkroom_values[{}]{})", cast, location, is_vector ? "" : fmt::format("[{}]", word % 4));
}

struct MembersText {
    std::string globals, rest;
};

MembersText members_text(std::span<const BlockMember> members, std::uint32_t first_vector,
                         const std::vector<std::uint32_t>& vectors, std::size_t first_location) {
    MembersText out;
    visit_members(members, 4 * first_vector, [&](const BlockMember& member, std::uint32_t word) {
        const auto location = location_of(vectors, word / 4);
        const std::string_view type = member.type_name();
        if (location)
            out.globals +=
                fmt::format("{} {} = {};\n", type, member.name, value_of(type, first_location + *location, word));
        else
            out.rest += member_source(member, word);
    });
    return out;
}

}  // namespace

bool writes_flat_values(const Context& context) {
    if (context.is_assumed) return true;
    VkPhysicalDeviceProperties properties{};
    context.vk.GetPhysicalDeviceProperties(context.physical_device, &properties);
    const VkPhysicalDeviceLimits& limits = properties.limits;
    return std::min(limits.maxVertexOutputComponents, limits.maxFragmentInputComponents) >= components_of_vertices;
}

std::uint32_t first_custom_vector(const KernelSpec& spec) {
    return vectors_of_output + vectors_per_image * static_cast<std::uint32_t>(spec.images.size()) +
           (spec.compute ? static_cast<std::uint32_t>(spec.outputs.size()) : 0);
}

std::uint32_t first_member_vector(const KernelSpec& spec) { return first_custom_vector(spec) + spec.custom_vectors; }

bool takes_flat_values(const KernelSpec& spec, Stage stage) { return stage == Stage::Raster && spec.is_software; }

WordsOfBlocks::WordsOfBlocks(const KernelSpec& spec) : has_custom_(spec.custom_vectors > 0) {
    for (const std::string_view function : {"size", "load_clamped", "sample_linear"}) asked_.insert(function);
    for (const BlockMember& member : spec.frame) asked_.insert(member.name);
    for (const BlockMember& member : spec.members) asked_.insert(member.name);
}

void WordsOfBlocks::visit(std::string_view word, const GlslScanner& after) {
    if (asked_.contains(word)) found.insert(word);
    if (has_custom_ && word.size() >= custom.size() && word.find(custom) != std::string_view::npos)
        has_literal_indices &= is_literal(after);
}

FlatValues flat_values(const KernelSpec& spec, const WordsOfBlocks& words) {
    FlatValues out;
    const auto add = [&](std::vector<std::uint32_t>& vectors, std::uint32_t vector) {
        const bool is_new = vectors.empty() || vectors.back() != vector;
        if (is_new && out.frame.size() + out.own.size() < most_flat_vectors) vectors.push_back(vector);
    };
    const auto add_named = [&](std::span<const BlockMember> members, std::uint32_t first_vector,
                               std::vector<std::uint32_t>& vectors) {
        visit_members(members, 4 * first_vector, [&](const BlockMember& member, std::uint32_t word) {
            if (words.found.contains(member.name)) add(vectors, word / 4);
        });
    };
    const auto is_read_by_size = [&](const KernelImage& image) {
        const bool filters_loads = image.is_filtered_by_loads || image.storage_format != VK_FORMAT_UNDEFINED;
        return image.is_depth || (filters_loads && words.found.contains("sample_linear"));
    };
    const bool asks_sizes = words.found.contains("size") || words.found.contains("load_clamped");
    for (std::uint32_t vector = 0; vector < first_custom_vector(spec); ++vector) {
        const bool is_size = (vector - vectors_of_output) % vectors_per_image + 1 == vectors_per_image;
        // Of whole images only the size is asked for, if that.
        if (vector < vectors_of_output || !spec.is_whole ||
            (is_size && (asks_sizes || is_read_by_size(spec.images[(vector - vectors_of_output) / vectors_per_image]))))
            add(out.own, vector);
    }
    add_named(spec.frame, 0, out.frame);
    add_named(spec.members, first_member_vector(spec), out.own);
    const bool has_room = out.frame.size() + out.own.size() + spec.custom_vectors <= most_flat_vectors;
    if (words.has_literal_indices && has_room)
        for (std::uint32_t i = 0; i < spec.custom_vectors; ++i) add(out.own, first_custom_vector(spec) + i);
    return out;
}

std::string flat_inputs(const KernelSpec& spec, const FlatValues& values) {
    std::string source = fmt::format("layout(location = 0) flat in uvec4 darkroom_values[{}];\n",
                                     values.frame.size() + values.own.size());
    const auto text = std::back_inserter(source);
    std::string own;
    const auto write = [&](std::uint32_t vector, std::string_view type, std::string_view name) {
        if (const auto location = location_of(values.own, vector))
            fmt::format_to(text, "{} {} = {};\n", type, name, value_of(type, values.frame.size() + *location, 0));
        else
            own += fmt::format("    layout(offset = {}) {} {};\n", 16 * vector, type, name);
    };
    write(0, "ivec4", "darkroom_output");
    write(1, "vec4", "darkroom_texel");
    std::uint32_t vector = vectors_of_output;
    for (const KernelImage& image : spec.images) {
        write(vector++, "vec4", fmt::format("darkroom_uv_{}", image.name));
        write(vector++, "vec4", fmt::format("darkroom_bounds_{}", image.name));
        write(vector++, "ivec4", fmt::format("darkroom_region_{}", image.name));
    }
    if (spec.custom_vectors > 0 && location_of(values.own, vector)) {
        fmt::format_to(text, "vec4 custom[] = vec4[](");
        for (std::uint32_t i = 0; i < spec.custom_vectors; ++i)
            fmt::format_to(text, "{}{}", i == 0 ? "" : ", ",
                           value_of("vec4", values.frame.size() + *location_of(values.own, vector + i), 0));
        fmt::format_to(text, ");\n");
    } else if (spec.custom_vectors > 0) {
        own += fmt::format("    layout(offset = {}) vec4 custom[{}];\n", 16 * vector, spec.custom_vectors);
    }
    const MembersText frame = members_text(spec.frame, 0, values.frame, 0);
    const MembersText members = members_text(spec.members, first_member_vector(spec), values.own, values.frame.size());
    own += members.rest;
    if (!frame.rest.empty())
        fmt::format_to(text, "layout(std140, set = 0, binding = 0) uniform DarkroomFrame {{\n{}}};\n", frame.rest);
    if (!own.empty()) fmt::format_to(text, "layout(std140, set = 0, binding = 1) uniform DarkroomOwn {{\n{}}};\n", own);
    return source + frame.globals + members.globals;
}

bool reads_flat_inputs(std::span<const std::uint32_t> fragment) {
    // SPIR-V specification: instructions begin with their length and opcode, decorations come before variables.
    constexpr std::uint32_t header_words = 5, op_variable = 59, op_decorate = 71, location = 30, input = 1;
    std::unordered_set<std::uint32_t> located;
    for (std::size_t i = header_words; i + 3 < fragment.size(); i += std::max(fragment[i] >> 16U, 1U)) {
        const std::uint32_t opcode = fragment[i] & 0xFFFFU;
        if (opcode == op_decorate && fragment[i + 2] == location) located.insert(fragment[i + 1]);
        if (opcode == op_variable && fragment[i + 3] == input && located.contains(fragment[i + 2])) return true;
    }
    return false;
}

std::string flat_vertex_source(const KernelSpec& spec, const FlatValues& values) {
    std::string source = "#version 460\n";
    const auto text = std::back_inserter(source);
    if (!values.frame.empty())
        fmt::format_to(text, "layout(std140, set = 0, binding = 0) uniform Frame {{ uvec4 frame[{}]; }};\n",
                       vector_count(spec.frame));
    fmt::format_to(text,
                   "layout(std140, set = 0, binding = 1) uniform Own {{ uvec4 own[{}]; }};\n"
                   "layout(location = 0) flat out uvec4 darkroom_values[{}];\n"
                   "void main() {{\n"
                   "    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.0, 1.0);\n",
                   own_block_size(spec) / 16, values.frame.size() + values.own.size());
    std::size_t location = 0;
    for (const std::uint32_t vector : values.frame)
        fmt::format_to(text, "    darkroom_values[{}] = frame[{}];\n", location++, vector);
    for (const std::uint32_t vector : values.own)
        fmt::format_to(text, "    darkroom_values[{}] = own[{}];\n", location++, vector);
    source += "}\n";
    return source;
}

}  // namespace darkroom::gpu
