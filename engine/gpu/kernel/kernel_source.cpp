// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "core/assert.hpp"
#include "gpu/kernel/kernel_pipeline.hpp"
#include "gpu/resource/formats.hpp"
#include "gpu/shader/rewrite.hpp"

namespace darkroom::gpu {

namespace {

constexpr std::array<std::string_view, 8> image_functions{"sample_linear", "load", "load_clamped", "gather_red",
                                                          "gather_green",  "size", "store",        "as_stored"};

/// Words of the own block before its members: two vectors of the output, three of each image, one of each output of a
/// compute pass, custom.
std::uint32_t first_member_word(const KernelSpec& spec) {
    const std::size_t outputs = spec.compute ? spec.outputs.size() : 0;
    return 4 * (2 + 3 * static_cast<std::uint32_t>(spec.images.size()) + static_cast<std::uint32_t>(outputs) +
                spec.custom_vectors);
}

constexpr std::string_view preamble = R"(#version 460
#extension GL_GOOGLE_cpp_style_line_directive : require
#extension GL_EXT_control_flow_attributes : require
struct Pixel { ivec2 texel; vec2 uv; ivec2 size; };
)";

// Both stages reach pixel.uv by the same operations in the same order; gl_FragCoord would not do.
constexpr std::string_view pixel_functions = R"(ivec2 output_size() { return darkroom_output.zw; }
Pixel darkroom_pixel(ivec2 texel) {
    return Pixel(texel, fma(vec2(texel), darkroom_texel.xy, darkroom_texel.zw), darkroom_output.zw);
}
)";

using Text = std::back_insert_iterator<std::string>;

std::string_view prefix_of(Numeric numeric) {
    switch (numeric) {
        case Numeric::Signed:
            return "i";
        case Numeric::Unsigned:
            return "u";
        case Numeric::Float:
            break;
    }
    return "";
}

/// "v", "iv" or "uv" + "ec4" of what a sampler returns.
std::string_view prefix_of_sampler(std::string_view type) {
    return type.starts_with("i") ? "i" : type.starts_with("u") ? "u" : "";
}

bool is_plain_2d(std::string_view sampler_type) {
    return sampler_type == "sampler2D" || sampler_type == "usampler2D" || sampler_type == "isampler2D";
}

void write_blocks(Text text, const KernelSpec& spec) {
    if (!spec.frame.empty()) {
        fmt::format_to(text, "layout(std140, set = 0, binding = 0) uniform DarkroomFrame {{\n{}}};\n",
                       block_source(spec.frame, 0));
    }
    fmt::format_to(text,
                   "layout(std140, set = 0, binding = 1) uniform DarkroomOwn {{\n"
                   "    ivec4 darkroom_output;\n    vec4 darkroom_texel;\n");
    for (const KernelImage& image : spec.images) {
        fmt::format_to(text,
                       "    vec4 darkroom_uv_{0};\n    vec4 darkroom_bounds_{0};\n    ivec4 darkroom_region_{0};\n",
                       image.name);
    }
    if (spec.compute)
        for (const std::string& output : spec.compute->outputs)
            fmt::format_to(text, "    ivec4 darkroom_region_{};\n", output);
    if (spec.custom_vectors > 0) fmt::format_to(text, "    vec4 custom[{}];\n", spec.custom_vectors);
    fmt::format_to(text, "{}}};\n", block_source(spec.members, first_member_word(spec)));
}

/// Vulkan 1.3 specification, "Texel Filtering", with the address mode CLAMP_TO_EDGE, by four loads.
/// At the centre of a texel no other is looked at, which may be NaN.
void write_filter(Text text, std::string_view name) {
    fmt::format_to(text,
                   "vec4 sample_linear_{0}(vec2 uv) {{\n"
                   "    ivec2 last = size_{0}() - 1;\n"
                   "    vec2 place = clamp(uv * vec2(last + 1), vec2(0), vec2(last + 1)) - 0.5;\n"
                   "    place = round(place * 16384.0) / 16384.0;\n"
                   "    ivec2 low = max(ivec2(floor(place)), 0), high = min(ivec2(ceil(place)), last);\n"
                   "    vec2 weight = place - floor(place);\n"
                   "    return mix(mix(load_{0}(low), load_{0}(ivec2(high.x, low.y)), weight.x),\n"
                   "               mix(load_{0}(ivec2(low.x, high.y)), load_{0}(high), weight.x), weight.y);\n"
                   "}}\n",
                   name);
}

std::string_view place_of(const KernelImage& image) { return image.is_single ? "ivec2(0)" : "texel"; }

void write_storage_input(Text text, const KernelImage& image, std::uint32_t binding, bool is_whole) {
    const FormatTraits traits = format_traits(image.storage_format);
    const std::string_view prefix = prefix_of(traits.numeric);
    fmt::format_to(text, "layout(set = 0, binding = {}, {}) uniform readonly {}image2D {};\n", binding,
                   traits.glsl_qualifier, prefix, image.name);
    fmt::format_to(
        text,
        "ivec2 size_{0}() {{ return darkroom_region_{0}.zw; }}\n"
        "{1}vec4 load_{0}(ivec2 texel) {{ return imageLoad({0}, {3}{2}); }}\n"
        "{1}vec4 load_clamped_{0}(ivec2 texel) {{ return load_{0}(clamp(texel, ivec2(0), size_{0}() - 1)); }}\n",
        image.name, prefix, is_whole ? "" : fmt::format(" + darkroom_region_{}.xy", image.name), place_of(image));
    if (prefix.empty()) write_filter(text, image.name);
}

void write_sampled_input(Text text, const KernelSpec& spec, const KernelImage& image, std::uint32_t binding,
                         Stage stage) {
    const bool is_whole = spec.is_whole;
    fmt::format_to(text, "layout(set = 0, binding = {}) uniform {} {};\n", binding, image.sampler_type, image.name);
    if (!is_plain_2d(image.sampler_type)) return;
    const std::string_view prefix = prefix_of_sampler(image.sampler_type);
    const std::string offset = is_whole ? "" : fmt::format(" + darkroom_region_{}.xy", image.name);
    const std::string load = fmt::format("texelFetch({}, {}{}, 0)", image.name, place_of(image), offset);
    // The sampler clamps to the edge of the whole image.
    const std::string place = is_whole
                                  ? "    return uv;\n"
                                  : fmt::format(
                                        "    precise vec2 place = uv * darkroom_uv_{0}.xy + darkroom_uv_{0}.zw;\n"
                                        "    return clamp(place, darkroom_bounds_{0}.xy, darkroom_bounds_{0}.zw);\n",
                                        image.name);
    // Hardware rounds coordinates to 2^-subTexelPrecisionBits of a texel, and at a texel's centre may so pick up the
    // four on the other side of it. A quarter of a texel nearer to the region's middle the four inside it are meant,
    // too.
    const std::string corner = is_whole
                                   ? "    return uv;\n"
                                   : fmt::format(
                                         "    vec2 quarter = 0.25 / vec2(textureSize({0}, 0));\n"
                                         "    return clamp(darkroom_place_{0}(uv), darkroom_bounds_{0}.xy + quarter,\n"
                                         "                 darkroom_bounds_{0}.zw - quarter);\n",
                                         image.name);
    fmt::format_to(
        text,
        "ivec2 size_{0}() {{ return darkroom_region_{0}.zw; }}\n"
        "{1}vec4 load_{0}(ivec2 texel) {{ return {2}; }}\n"
        "{1}vec4 load_clamped_{0}(ivec2 texel) {{ return load_{0}(clamp(texel, ivec2(0), size_{0}() - 1)); }}\n"
        "vec2 darkroom_place_{0}(vec2 uv) {{\n{3}}}\n"
        "vec2 darkroom_corner_{0}(vec2 uv) {{\n{4}}}\n"
        "{1}vec4 gather_red_{0}(vec2 uv) {{ return textureGather({0}, darkroom_corner_{0}(uv), 0); }}\n"
        "{1}vec4 gather_green_{0}(vec2 uv) {{ return textureGather({0}, darkroom_corner_{0}(uv), 1); }}\n",
        image.name, prefix, load, place, corner);
    if (image.is_filtered_by_loads) return write_filter(text, image.name);
    // A view has one mip level, so the implicit level of detail changes no bit; some drivers filter much faster with
    // it.
    const std::string_view function = stage == Stage::Raster ? "texture" : "textureLod";
    const std::string_view level = stage == Stage::Raster ? "" : ", 0.0";
    fmt::format_to(text, "{1}vec4 sample_linear_{0}(vec2 uv) {{ return {2}({0}, darkroom_place_{0}(uv){3}); }}\n",
                   image.name, prefix, function, level);
}

/// To the nearest of the packed floats of 6 and 5 bits, so that no driver is left to cut off. The largest are those
/// that are finite.
constexpr VkFormat packed_format = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
constexpr std::string_view packed_rounding = R"(vec4 darkroom_rounded(vec4 value) {
    uvec3 bits = floatBitsToUint(clamp(value.rgb, vec3(0.0), vec3(65024.0, 65024.0, 64512.0)));
    bits = bits + uvec3(0x10000u, 0x10000u, 0x20000u) & uvec3(0xfffe0000u, 0xfffe0000u, 0xfffc0000u);
    return vec4(uintBitsToFloat(bits), 1.0);
}
)";

void write_compute_output(Text text, const KernelSpec& spec, std::uint32_t index) {
    const FormatTraits traits = format_traits(spec.outputs[index]);
    const bool is_read = spec.is_additive && index == 0;
    const bool has_qualifier = !traits.glsl_qualifier.empty();
    const auto binding = first_image_binding + static_cast<std::uint32_t>(spec.images.size()) + index;
    const std::string_view separator = has_qualifier ? ", " : "";
    const std::string_view access = is_read ? "" : "writeonly ";
    fmt::format_to(text, "layout(set = 0, binding = {}{}{}) uniform {}{}image2D result_{};\n", binding, separator,
                   traits.glsl_qualifier, access, prefix_of(traits.numeric), index);
    const std::string_view old = is_read ? " + imageLoad(result_0, place)" : "";
    const bool is_packed = spec.outputs[index] == packed_format;
    const std::string name = spec.compute ? spec.compute->outputs[index] : fmt::format("{}", index);
    const std::string offset = spec.is_whole  ? ""
                               : spec.compute ? fmt::format(" + darkroom_region_{}.xy", name)
                                              : " + darkroom_output.xy";
    fmt::format_to(text,
                   "void store_{5}(ivec2 texel, vec4 value) {{\n"
                   "    ivec2 place = texel{3};\n"
                   "    imageStore(result_{0}, place, {4}({1}vec4(value){2}));\n"
                   "}}\n",
                   index, prefix_of(traits.numeric), old, offset, is_packed ? "darkroom_rounded" : "", name);
    if (!spec.compute) return;
    fmt::format_to(text,
                   "ivec2 size_{0}() {{ return darkroom_region_{0}.zw; }}\n"
                   "vec4 as_stored_{0}(vec4 value) {{ return {1}(value); }}\n",
                   name, is_packed ? "darkroom_rounded" : "");
}

void write_outputs(Text text, const KernelSpec& spec, Stage stage) {
    if (stage == Stage::Compute && std::ranges::find(spec.outputs, packed_format) != spec.outputs.end())
        fmt::format_to(text, "{}", packed_rounding);
    for (std::uint32_t index = 0; index < spec.outputs.size(); ++index) {
        if (stage == Stage::Compute) {
            write_compute_output(text, spec, index);
        } else {
            fmt::format_to(text, "layout(location = {0}) out {1}vec4 result_{0};\n", index,
                           prefix_of(format_traits(spec.outputs[index]).numeric));
        }
    }
}

void write_buffers(Text text, const KernelSpec& spec, Stage stage) {
    std::uint32_t binding = first_buffer_binding(spec, stage);
    for (const KernelBuffer& buffer : spec.buffers)
        fmt::format_to(text, "layout(std430, set = 0, binding = {0}) {1}buffer Darkroom_{2} {{ {3} {2}[]; }};\n",
                       binding++, buffer.is_written ? "" : "readonly ", buffer.name, buffer.type);
}

/// Declares `vec4 result[N]` and fills it.
void write_shade_call(Text text, std::size_t output_count) {
    if (output_count == 1) {
        fmt::format_to(text, "        vec4 result[1] = vec4[1](shade(darkroom_pixel(texel)));\n");
    } else {
        fmt::format_to(text, "        vec4 result[{}];\n        shade(darkroom_pixel(texel), result);\n", output_count);
    }
}

void write_main(Text text, const KernelSpec& spec, Stage stage) {
    if (spec.compute) {
        fmt::format_to(text, "void main() {{ run(); }}\n");
        return;
    }
    const bool is_compute = stage == Stage::Compute;
    const std::string place =
        is_compute ? "ivec2(gl_GlobalInvocationID.xy)"
                   : fmt::format("ivec2(gl_FragCoord.xy){}", spec.is_whole ? "" : " - darkroom_output.xy");
    const std::string_view condition = is_compute ? "if (all(lessThan(texel, darkroom_output.zw))) " : "";
    fmt::format_to(text, "void main() {{\n    ivec2 texel = {};\n    {}{{\n", place, condition);
    write_shade_call(text, spec.outputs.size());
    for (std::size_t index = 0; index < spec.outputs.size(); ++index) {
        if (is_compute) {
            fmt::format_to(text, "        store_{0}(texel, result[{0}]);\n", index);
        } else {
            const std::string_view prefix = prefix_of(format_traits(spec.outputs[index]).numeric);
            fmt::format_to(text, "        result_{0} = {1}vec4(result[{0}]);\n", index, prefix);
        }
    }
    fmt::format_to(text, "    }}\n}}\n");
}

/// Of the texels along one side, in uv.
struct TexelPlaces {
    float step = 1.0F, first = 0.5F;
};

/// The middle texel of an odd number lies at 0.5 exactly, however `step` was rounded.
TexelPlaces places_of(std::uint32_t extent) {
    const float step = 1.0F / static_cast<float>(extent);
    return {.step = step, .first = static_cast<float>(0.5 - 0.5 * (extent - 1.0) * static_cast<double>(step))};
}

struct Axis {
    float scale = 1.0F, offset = 0.0F, lowest = 0.0F, highest = 1.0F;
};

Axis axis_of(std::int32_t offset, std::uint32_t extent, std::uint32_t image, std::uint32_t sub_texel_bits) {
    if (image == 0) return {};
    // Where the region ends inside the image, its edge texel must not be mixed with its neighbour, not even with a
    // weight of zero: that may be an infinity. Samplers snap coordinates to 2^-subTexelPrecisionBits of a texel (Vulkan
    // specification, "Limits"), so the bound stays one such step inside the texel's centre: nearer, and it could snap
    // to the centre itself, or single precision could step over it.
    const double size = image, guard = std::ldexp(1.0, -static_cast<int>(sub_texel_bits)) / size;
    const double last = offset + static_cast<double>(extent) - 1.0;
    const bool ends_inside = offset + static_cast<double>(extent) < size;
    return {
        .scale = static_cast<float>(extent / size),
        .offset = static_cast<float>(offset / size),
        .lowest = offset > 0 ? static_cast<float>((offset + 0.5) / size + guard) : 0.0F,
        .highest = ends_inside ? static_cast<float>((last + 0.5) / size - guard) : 1.0F,
    };
}

template <class Value>
void append(std::span<std::byte>& out, const Value& value) {
    std::memcpy(out.data(), &value, sizeof value);
    out = out.subspan(sizeof value);
}

std::array<std::int32_t, 4> rectangle(const Region& region) {
    return {region.offset.x, region.offset.y, static_cast<std::int32_t>(region.extent.width),
            static_cast<std::int32_t>(region.extent.height)};
}

/// The names by which a body calls its images.
std::vector<std::string_view> image_names(const KernelSpec& spec) {
    std::vector<std::string_view> names;
    for (const KernelImage& image : spec.images) names.emplace_back(image.name);
    if (spec.compute) names.insert(names.end(), spec.compute->outputs.begin(), spec.compute->outputs.end());
    return names;
}

/// `body`: with its calls of images rewritten.
std::string source_of(const KernelSpec& spec, Stage stage, std::string_view body) {
    std::string source(preamble);
    source.reserve(2 * body.size() + 4096);
    const Text text = std::back_inserter(source);
    if (stage == Stage::Compute) {
        fmt::format_to(text, "layout(local_size_x = {}, local_size_y = {}) in;\n", spec.workgroup[0],
                       spec.workgroup[1]);
    }
    fmt::format_to(text, "const bool loads_outside_are_zero = {};\nconst bool rays_meet = {};\n",
                   spec.has_robust_images && spec.is_whole, spec.rays_meet);
    write_blocks(text, spec);
    source += pixel_functions;
    std::uint32_t binding = first_image_binding;
    for (const KernelImage& image : spec.images) {
        if (image.storage_format != VK_FORMAT_UNDEFINED) {
            write_storage_input(text, image, binding++, spec.is_whole);
        } else {
            write_sampled_input(text, spec, image, binding++, stage);
        }
    }
    write_outputs(text, spec, stage);
    write_buffers(text, spec, stage);
    source.append("#line 1 \"kernel\"\n").append(body).append("\n#line 1 \"kernel: main\"\n");
    write_main(text, spec, stage);
    return source;
}

}  // namespace

std::string kernel_source(const KernelSpec& spec, Stage stage) { return KernelText(spec, stage).source; }

std::string without_file_names(std::string_view source) {
    constexpr std::string_view line = "#line ";
    std::string out;
    out.reserve(source.size());
    std::size_t copied = 0;
    // There are far fewer of these marks than lines.
    for (std::size_t at = source.find('#'); at != std::string_view::npos; at = source.find('#', at + 1)) {
        if (at == 0 || source[at - 1] != '\n' || !source.substr(at).starts_with(line)) continue;
        const std::size_t name = std::min(source.find_first_of("\"\n", at), source.size());
        out += source.substr(copied, name - copied);
        copied = std::min(source.find('\n', at), source.size());
    }
    return out.append(source.substr(copied));
}

KernelText::KernelText(const KernelSpec& spec, Stage stage)
    : source(source_of(spec, stage, rewrite_image_calls(spec.body, image_functions, image_names(spec)))),
      digest(sha256(without_file_names(source))) {}

std::size_t own_block_size(const KernelSpec& spec) {
    constexpr std::size_t vector_size = 16;
    const std::size_t size = 4 * (std::size_t{first_member_word(spec)} + word_count(spec.members));
    return (size + vector_size - 1) / vector_size * vector_size;
}

void write_own_block(const KernelSpec& spec, const Region& output, std::span<const Binding> images,
                     std::span<const std::array<float, 4>> custom, std::span<const std::uint32_t> words,
                     std::span<std::byte> out, std::span<const Binding> outputs) {
    DARKROOM_ASSERT(images.size() == spec.images.size());
    DARKROOM_ASSERT(custom.size() == spec.custom_vectors);
    DARKROOM_ASSERT(out.size() >= own_block_size(spec));
    append(out, rectangle(output));
    const TexelPlaces columns = places_of(output.extent.width), rows = places_of(output.extent.height);
    append(out, std::array{columns.step, rows.step, columns.first, rows.first});
    for (const Binding& image : images) {
        const Region& region = image.region;
        const Axis x = axis_of(region.offset.x, region.extent.width, region.image.width, spec.sub_texel_bits);
        const Axis y = axis_of(region.offset.y, region.extent.height, region.image.height, spec.sub_texel_bits);
        append(out, std::array{x.scale, y.scale, x.offset, y.offset});
        append(out, std::array{x.lowest, y.lowest, x.highest, y.highest});
        append(out, rectangle(region));
    }
    if (spec.compute) {
        DARKROOM_ASSERT(outputs.size() == spec.outputs.size());
        for (const Binding& binding : outputs) append(out, rectangle(binding.region));
    }
    for (const std::array<float, 4>& vector : custom) append(out, vector);
    if (!words.empty()) std::memcpy(out.data(), words.data(), words.size_bytes());
}

}  // namespace darkroom::gpu
