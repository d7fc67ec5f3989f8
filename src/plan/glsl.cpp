// SPDX-License-Identifier: MIT
#include "plan/glsl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace darkroom::plan {

namespace {

bool is_word_start(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_word(char c) { return is_word_start(c) || (c >= '0' && c <= '9'); }

/// Calls `word` for every identifier outside comments and directives, and `other` for the text between.
template <class Word, class Other>
void scan(std::string_view text, const Word& word, const Other& other) {
    std::size_t i = 0;
    while (i < text.size()) {
        std::size_t end = i + 1;
        if (text[i] == '#' || text.substr(i, 2) == "//") {
            end = std::min(text.find('\n', i), text.size());
        } else if (text.substr(i, 2) == "/*") {
            const std::size_t close = text.find("*/", i + 2);
            end = close == std::string_view::npos ? text.size() : close + 2;
        } else if (is_word_start(text[i])) {
            while (end < text.size() && is_word(text[end])) ++end;
            word(text.substr(i, end - i), i);
            i = end;
            continue;
        } else if (is_word(text[i]) || text[i] == '.') {
            // A number (1e5, 0x1f) or a member access: what follows is no name at file scope.
            while (end < text.size() && (is_word(text[end]) || text[end] == '.')) ++end;
        }
        other(text.substr(i, end - i));
        i = end;
    }
}

std::string_view file_text(std::span<const EffectFile> files, std::string_view name) {
    for (const EffectFile& file : files)
        if (file.name == name) return file.text;
    return {};
}

struct Scalar {
    const char* type;
    const char* suffix;
};
std::span<const Scalar> scalars_of(Kind kind) {
    static constexpr Scalar real[] = {{"float", ""}}, integer[] = {{"int", ""}}, natural[] = {{"uint", ""}};
    static constexpr Scalar vector[] = {{"float", "_x"}, {"float", "_y"}, {"float", "_z"}, {"float", "_w"}};
    static constexpr Scalar rgb[] = {{"float", "_r"}, {"float", "_g"}, {"float", "_b"}};
    switch (kind) {
        case Kind::Float:
            return real;
        case Kind::Int:
            return integer;
        case Kind::Toggle:
        case Kind::Choice:
            return natural;
        case Kind::Vec2:
            return std::span(vector).first(2);
        case Kind::Vec3:
            return std::span(vector).first(3);
        case Kind::Vec4:
            return vector;
        case Kind::Rgb:
            return rgb;
        case Kind::Curve:
        case Kind::Resource:
            break;
    }
    return {};
}

const char* glsl_type(Kind kind) {
    switch (kind) {
        case Kind::Float:
            return "float";
        case Kind::Int:
            return "int";
        case Kind::Toggle:
        case Kind::Choice:
            return "uint";
        case Kind::Vec2:
            return "vec2";
        case Kind::Vec3:
        case Kind::Rgb:
            return "vec3";
        case Kind::Vec4:
            return "vec4";
        case Kind::Curve:
            return "Curve";
        case Kind::Resource:
            break;
    }
    return "";
}

std::string block_prefix(const EffectInfo& info, std::uint32_t entry) {
    return fmt::format("{}{}_", info.name, entry_suffix(entry));
}

Result<void> append_with_includes(std::string& out, std::string_view text, const std::string& shown_name, int depth) {
    out += fmt::format("#line 1 \"effects/{}\"\n", shown_name);
    std::size_t line = 1;
    for (std::size_t i = 0; i < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', i), text.size());
        const std::string_view content = text.substr(i, end - i);
        i = end + 1;
        constexpr std::string_view directive = "#include \"";
        if (!content.starts_with(directive)) {
            out.append(content).push_back('\n');
            continue;
        }
        const std::string_view name = content.substr(directive.size(), content.rfind('"') - directive.size());
        const std::string_view included = file_text(shared_files(), name);
        if (included.empty() || depth > 8)
            return user_error(fmt::format("effects/{}:{}: #include \"{}\": there is no such file in effects/shared",
                                          shown_name, line, name));
        if (const auto ok = append_with_includes(out, included, std::string(name), depth + 1); !ok) return ok;
        out += fmt::format("#line {} \"effects/{}\"\n", line + 1, shown_name);
    }
    return {};
}

/// Lines that include a file of the effect's own folder, replaced by it.
std::string with_own_files(const EffectInfo& info, std::string_view text, std::string_view shown_name) {
    std::string out;
    std::size_t line = 1;
    for (std::size_t i = 0; i < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', i), text.size());
        const std::string_view content = text.substr(i, end - i);
        i = end + 1;
        constexpr std::string_view directive = "#include \"";
        const std::string_view name = content.starts_with(directive)
                                          ? content.substr(directive.size(), content.rfind('"') - directive.size())
                                          : std::string_view{};
        const std::string_view included = file_text(info.files, name);
        if (included.empty())
            out.append(content).push_back('\n');
        else
            out += fmt::format("#line 1 \"effects/{}/{}\"\n{}\n#line {} \"effects/{}\"\n", info.name, name, included,
                               line + 1, shown_name);
    }
    return out;
}

}  // namespace

std::uint32_t block_words(const ParamTable& table) {
    std::uint32_t words = entry_header_words;
    for (const ParamInfo& row : table.rows)
        if (row.kind != Kind::Resource) words += row.words;
    return words;
}

void write_block(const ParamTable& table, std::span<const std::uint32_t> words, std::span<std::uint32_t> block) {
    std::size_t out = entry_header_words;
    for (const ParamInfo& row : table.rows) {
        if (row.kind == Kind::Resource) continue;
        std::copy_n(words.begin() + row.word, row.words, block.begin() + static_cast<std::ptrdiff_t>(out));
        out += row.words;
    }
}

std::string entry_suffix(std::uint32_t entry) { return fmt::format("_e{}", entry); }

std::string frame_members() {
    return "    layout(offset = 0) float frame_time;\n    float frame_delta_time;\n    uint frame_index;\n    uint "
           "frame_view;\n    vec4 frame_projection_scale;\n    vec4 frame_projection_offset;\n"
           "    vec4 frame_view_to_world_x;\n    vec4 frame_view_to_world_y;\n    vec4 frame_view_to_world_z;\n"
           "    vec4 frame_ray;\n    vec4 frame_ray_flat;\n";
}

CameraBlock camera_block(const Camera& camera) {
    const Matrix& p = camera.projection;
    const Matrix& v = camera.view;
    // The picture's v runs down, so where clip space has y up its row changes sign.
    const float down = camera.is_y_down ? 1.0f : -1.0f;
    CameraBlock out{p[0], p[5] * down, p[8], p[9] * down, p[12], p[13] * down, p[11], p[15]};
    // The view matrix turns and moves, so its inverse is the transposed turn, and the eye is -R^T t.
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float eye = 0;
        for (std::size_t row = 0; row < 3; ++row) {
            const float entry = v[axis * 4 + row];
            out[8 + axis * 4 + row] = entry;
            eye -= entry * v[12 + row];
        }
        out[8 + axis * 4 + 3] = eye;
    }
    // x and y of view space, solved from those of clip space: (uv * ray.xy + ray.zw) * planar + uv * flat.xy + flat.zw.
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const float scale = out[axis], shear = out[2 + axis], offset = out[4 + axis];
        out[20 + axis] = -2 * p[11] / scale;
        out[22 + axis] = (p[11] + shear) / scale;
        out[24 + axis] = 2 * p[15] / scale;
        out[26 + axis] = (-p[15] - offset) / scale;
    }
    return out;
}

std::string finish_member(std::uint32_t word) {
    return fmt::format("    layout(offset = {}) uint finish_;\n", word * 4);
}

std::string entry_members(const EffectInfo& info, std::uint32_t entry, std::uint32_t first_word) {
    const std::string prefix = block_prefix(info, entry);
    std::string out =
        fmt::format("    layout(offset = {}) uint {}enabled_;\n    float {}opacity_;\n    uint {}blend_;\n",
                    first_word * 4, prefix, prefix, prefix);
    for (const ParamInfo& row : info.parameters.rows) {
        if (row.kind == Kind::Curve)
            out += fmt::format("    uint {0}{1}_count;\n    float {0}{1}_x[{2}];\n    float {0}{1}_y[{2}];\n", prefix,
                               row.name, Curve::capacity);
        for (const Scalar& scalar : scalars_of(row.kind))
            out += fmt::format("    {} {}{}{};\n", scalar.type, prefix, row.name, scalar.suffix);
    }
    return out;
}

std::string curve_struct() {
    return fmt::format("struct Curve {{\n    uint count;\n    float x[{0}];\n    float y[{0}];\n}};\n",
                       Curve::capacity);
}

std::string parameter_struct(const ParamTable& table) {
    std::string members, constants;
    for (const ParamInfo& row : table.rows) {
        if (row.kind == Kind::Resource) continue;
        members += fmt::format("    {} {};\n", glsl_type(row.kind), row.name);
        for (std::size_t i = 0; i < row.choices.size(); ++i)
            constants += fmt::format("const uint {}_{}_{} = {}u;\n", table.struct_name, row.name, row.choices[i], i);
    }
    if (members.empty()) members = "    uint unused_;\n";
    return fmt::format("struct {} {{\n{}}};\n{}", table.struct_name, members, constants);
}

std::string parameter_loader(const EffectInfo& info, std::uint32_t entry, std::span<const Baked> baked) {
    const std::string prefix = block_prefix(info, entry);
    std::string arguments;
    for (const ParamInfo& row : info.parameters.rows) {
        if (row.kind == Kind::Resource) continue;
        if (!arguments.empty()) arguments += ", ";
        if (const auto found = std::ranges::find(baked, &row, &Baked::row); found != baked.end()) {
            arguments += fmt::format("{}({}u)", glsl_type(row.kind), found->value);
            continue;
        }
        if (row.kind == Kind::Curve) {
            std::string x, y;
            for (std::size_t i = 0; i < Curve::capacity; ++i) {
                x += fmt::format("{}{}{}_x[{}]", i == 0 ? "" : ", ", prefix, row.name, i);
                y += fmt::format("{}{}{}_y[{}]", i == 0 ? "" : ", ", prefix, row.name, i);
            }
            arguments += fmt::format("Curve({0}{1}_count, float[]({2}), float[]({3}))", prefix, row.name, x, y);
            continue;
        }
        std::string components;
        for (const Scalar& scalar : scalars_of(row.kind))
            components += fmt::format("{}{}{}{}", components.empty() ? "" : ", ", prefix, row.name, scalar.suffix);
        arguments += fmt::format("{}({})", glsl_type(row.kind), components);
    }
    if (arguments.empty()) arguments = "0u";
    return fmt::format("{0} {1}_parameters{2}() {{\n    return {0}({3});\n}}\n", info.parameters.struct_name, info.name,
                       entry_suffix(entry), arguments);
}

Result<std::string> instance_text(const EffectInfo& info, std::string_view file, std::uint32_t entry,
                                  std::span<const std::string> also) {
    std::string_view own = file_text(info.files, file);
    if (own.empty()) own = file_text(shared_files(), file);
    const std::string shown = fmt::format("{}/{}", info.name, file);
    const std::string expanded = with_own_files(info, own, shown);
    own = expanded;
    if (own.empty()) return user_error(fmt::format("effects/{}: there is no such file", shown));

    // Names that the shared files define keep them, even where they begin with the effect's name.
    std::set<std::string_view> shared;
    for (const EffectFile& other : shared_files())
        scan(
            other.text, [&](std::string_view word, std::size_t) { shared.insert(word); }, [](std::string_view) {});

    const std::string prefix = std::string(info.name) + "_";
    std::string renamed;
    scan(
        own,
        [&](std::string_view word, std::size_t) {
            renamed += word;
            const bool is_own = (word == info.name || word.starts_with(prefix)) && !shared.contains(word);
            if (is_own || std::find(also.begin(), also.end(), word) != also.end()) renamed += entry_suffix(entry);
        },
        [&](std::string_view text) { renamed += text; });

    std::string out;
    if (auto ok = append_with_includes(out, renamed, shown, 0); !ok) return failure(std::move(ok));
    return out;
}

Result<std::string> fused_body(std::span<const FusedStep> steps, Finish finish, Resampling resampling) {
    std::string declarations, code;
    std::set<std::string_view> structs;
    bool has_merge = false;
    for (const FusedStep& step : steps) {
        const std::string suffix = entry_suffix(step.entry), prefix = block_prefix(*step.info, step.entry);
        if (!step.is_merge) {
            if (structs.insert(step.info->parameters.struct_name).second)
                declarations += parameter_struct(step.info->parameters);
            declarations += parameter_loader(*step.info, step.entry, step.baked);
            auto text = instance_text(*step.info, fmt::format("{}.glsl", step.info->name), step.entry, step.sides);
            if (!text) return failure(std::move(text));
            declarations += *text;
        }
        std::string layer = step.is_merge ? fmt::format("load(layer{}, pixel.texel)", suffix)
                            : step.info->touch == Touch::Warp
                                ? fmt::format("{0}{1}(pixel, {0}_parameters{1}())", step.info->name, suffix)
                                : fmt::format("{0}{1}(color, pixel, {0}_parameters{1}())", step.info->name, suffix);
        if (!step.is_plain) {
            has_merge = true;
            const std::string opacity =
                step.has_mask ? fmt::format("{}opacity_ * mask_weight(load(mask{}, pixel.texel))", prefix, suffix)
                              : fmt::format("{}opacity_", prefix);
            layer = fmt::format("merge_layer(color, {}, {}, {}blend_)", layer, opacity, prefix);
        }
        code += step.is_certain ? fmt::format("    color = {};\n", layer)
                                : fmt::format("    if ({}enabled_ != 0u) color = {};\n", prefix, layer);
    }

    std::string helpers;
    if (has_merge) {
        if (auto ok =
                append_with_includes(helpers, file_text(shared_files(), "shared/merge.glsl"), "shared/merge.glsl", 0);
            !ok)
            return failure(std::move(ok));
    }
    if (finish != Finish::None) {
        if (auto ok =
                append_with_includes(helpers, file_text(shared_files(), "shared/srgb.glsl"), "shared/srgb.glsl", 0);
            !ok)
            return failure(std::move(ok));
        for (const auto& [kind, call] : {std::pair{Finish::EncodeSrgb, "color.rgb = srgb_encode(color.rgb);"},
                                         std::pair{Finish::DecodeSrgb, "color.rgb = srgb_decode(color.rgb);"}}) {
            if (finish == Finish::OfFrame)
                code += fmt::format("    if (finish_ == {}u) {}\n", static_cast<unsigned>(kind), call);
            else if (finish == kind)
                code += fmt::format("    {}\n", call);
        }
    }
    const bool is_warp = !steps.empty() && steps.front().info->touch == Touch::Warp && !steps.front().is_merge;
    std::string_view read = is_warp ? "load_clamped(picture, pixel.texel)" : "load(picture, pixel.texel)";
    if (resampling == Resampling::Linear) read = "sample_linear(picture, pixel.uv)";
    // The texel under the pixel's centre; in integers, because a product of floats may fall short of it.
    if (resampling == Resampling::Nearest)
        read = "load_clamped(picture, (2 * pixel.texel + 1) * size(picture) / (2 * pixel.size))";
    return fmt::format(
        "{}{}{}#line 1 \"fused kernel\"\nvec4 shade(Pixel pixel) {{\n    vec4 color = {};\n{}    return color;\n}}\n",
        curve_struct(), helpers, declarations, read, code);
}

}  // namespace darkroom::plan
