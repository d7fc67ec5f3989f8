// SPDX-License-Identifier: MIT
#include "plan/text/glsl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "gpu/shader/glsl_scan.hpp"
#include "plan/text/effect_files.hpp"

namespace darkroom::plan {

namespace {

/// How a row's value stands in shaders, and which scalars of a block it is.
struct Form {
    Kind kind{};
    std::string_view type;
    gpu::BlockMember::Type scalar{};
    std::string_view components{};  ///< none: it is one scalar
};
constexpr std::array forms{Form{Kind::Float, "float", gpu::BlockMember::Type::Float},
                           Form{Kind::Int, "int", gpu::BlockMember::Type::Int},
                           Form{Kind::Toggle, "uint", gpu::BlockMember::Type::Uint},
                           Form{Kind::Choice, "uint", gpu::BlockMember::Type::Uint},
                           Form{Kind::Vec2, "vec2", gpu::BlockMember::Type::Float, "xy"},
                           Form{Kind::Vec3, "vec3", gpu::BlockMember::Type::Float, "xyz"},
                           Form{Kind::Vec4, "vec4", gpu::BlockMember::Type::Float, "xyzw"},
                           Form{Kind::Rgb, "vec3", gpu::BlockMember::Type::Float, "rgb"}};

/// Of a curve the effect makes vectors (PassBuilder::end_constants), of a resource tables.
bool is_in_block(const ParamInfo& row) { return row.kind != Kind::Curve && row.kind != Kind::Resource; }
const Form& form_of(const ParamInfo& row) { return *std::ranges::find(forms, row.kind, &Form::kind); }

/// Calls visit(name) for each scalar of a row.
template <class Visit>
void for_each_scalar(const ParamInfo& row, const std::string& prefix, const Visit& visit) {
    const std::string name = fmt::format("{}{}", prefix, row.name);
    if (form_of(row).components.empty()) visit(name);
    for (const char component : form_of(row).components) visit(fmt::format("{}_{}", name, component));
}

std::string block_prefix(const EffectInfo& info, std::uint32_t place) {
    return fmt::format("{}{}_", info.name, place_suffix(place));
}

/// Names in the shared files keep theirs, even where they begin with an effect's name.
const std::unordered_set<std::string_view>& shared_words() {
    static const std::unordered_set<std::string_view> words = [] {
        std::unordered_set<std::string_view> out;
        out.reserve(4096);
        for (const EffectFile& file : shared_files()) {
            gpu::GlslScanner scanner(file.text);
            for (gpu::Token token = scanner.next_word(); token.kind != gpu::Token::Kind::End;
                 token = scanner.next_word())
                out.insert(token.text);
        }
        return out;
    }();
    return words;
}

}  // namespace

std::uint32_t parameter_words(const ParamTable& table) {
    std::uint32_t words = 0;
    for (const ParamInfo& row : table.rows)
        if (is_in_block(row)) words += row.words;
    return words;
}

void write_parameters(const ParamTable& table, std::span<const std::uint32_t> words, std::span<std::uint32_t> out) {
    auto place = out.begin();
    for (const ParamInfo& row : table.rows)
        if (is_in_block(row)) place = std::copy_n(words.begin() + row.word, row.words, place);
}

std::string place_suffix(std::uint32_t place) { return fmt::format("_e{}", place); }

std::span<const gpu::BlockMember> frame_members() {
    using enum gpu::BlockMember::Type;
    static const std::array<gpu::BlockMember, 11> members{{{Float, "frame_time"},
                                                           {Float, "frame_delta_time"},
                                                           {Uint, "frame_index"},
                                                           {Uint, "frame_view"},
                                                           {Vec4, "frame_projection_scale"},
                                                           {Vec4, "frame_projection_offset"},
                                                           {Vec4, "frame_view_to_world_x"},
                                                           {Vec4, "frame_view_to_world_y"},
                                                           {Vec4, "frame_view_to_world_z"},
                                                           {Vec4, "frame_ray"},
                                                           {Vec4, "frame_ray_flat"}}};
    return members;
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

bool rays_meet(const Camera& camera) {
    const Matrix& p = camera.projection;
    return p[11] != 0 && p[15] == 0 && p[12] == 0 && p[13] == 0;
}

void append_finish_members(Finish finish, std::vector<gpu::BlockMember>& out) {
    using enum gpu::BlockMember::Type;
    if (!is_by_frame(finish)) return;
    out.push_back({Uint, "finish_"});
    if (finish == Finish::OfFrame) return;
    for (const char* const name : {"finish_scale_", "finish_limit_", "finish_ootf_", "finish_target_ootf_"})
        out.push_back({Float, name});
}

void append_header_members(const FusedStep& step, std::vector<gpu::BlockMember>& out) {
    using enum gpu::BlockMember::Type;
    const std::string prefix = block_prefix(*step.info, step.place);
    out.push_back({Uint, prefix + "enabled_"});
    out.push_back({Float, prefix + "opacity_"});
    out.push_back({Uint, prefix + "blend_"});
    if (!step.is_wrapped) return;
    out.push_back({Uint, prefix + "work_"});
    for (const char* const name : {"work_scale_", "work_limit_", "work_ootf_"}) out.push_back({Float, prefix + name});
}

void append_parameter_members(const EffectInfo& info, std::uint32_t place, std::vector<gpu::BlockMember>& out) {
    const std::string prefix = block_prefix(info, place);
    for (const ParamInfo& row : info.parameters.rows)
        if (is_in_block(row))
            for_each_scalar(row, prefix, [&](std::string name) {
                out.push_back({form_of(row).scalar, std::move(name)});
            });
}

namespace {

/// `struct Bloom_e0 { float intensity; ... };` and a constant for every choice: Bloom_mode_additive_e0. One for each
/// place: effects of several files may have one name.
std::string parameter_struct(const ParamTable& table, std::uint32_t place) {
    const std::string suffix = place_suffix(place);
    std::string members, constants;
    for (const ParamInfo& row : table.rows) {
        if (!is_in_block(row)) continue;
        members += fmt::format("    {} {};\n", form_of(row).type, row.name);
        for (std::size_t i = 0; i < row.choices.size(); ++i)
            constants +=
                fmt::format("const uint {}_{}_{}{} = {}u;\n", table.struct_name, row.name, row.choices[i], suffix, i);
    }
    if (members.empty()) members = "    uint unused_;\n";
    return fmt::format("struct {}{} {{\n{}}};\n{}", table.struct_name, suffix, members, constants);
}

/// `Bloom_e3 bloom_parameters_e3() { return Bloom_e3(bloom_e3_intensity, ...); }`
std::string parameter_loader(const EffectInfo& info, std::uint32_t place, std::span<const Baked> baked) {
    const std::string prefix = block_prefix(info, place);
    std::string arguments;
    for (const ParamInfo& row : info.parameters.rows) {
        if (!is_in_block(row)) continue;
        if (!arguments.empty()) arguments += ", ";
        if (const auto found = std::ranges::find(baked, &row, &Baked::row); found != baked.end()) {
            arguments += fmt::format("{}({}u)", form_of(row).type, found->value);
            continue;
        }
        std::string components;
        for_each_scalar(row, prefix, [&](const std::string& name) {
            components += fmt::format("{}{}", components.empty() ? "" : ", ", name);
        });
        arguments += fmt::format("{}({})", form_of(row).type, components);
    }
    if (arguments.empty()) arguments = "0u";
    return fmt::format("{0}{2} {1}_parameters{2}() {{\n    return {0}{2}({3});\n}}\n", info.parameters.struct_name,
                       info.name, place_suffix(place), arguments);
}

}  // namespace

Result<EffectText> effect_text(const EffectInfo& info, std::string_view name, std::uint32_t place,
                               std::span<const std::string> images) {
    const OwnText own = own_text(info, name);
    if (own.glsl.empty()) return user_error(fmt::format("{}: there is no such file", own.shown));

    EffectText out;
    std::unordered_set<std::string_view> members;
    const std::string prefix = std::string(info.name) + "_", loader = prefix + "parameters";
    const std::string suffix = place_suffix(place);
    const std::string_view type = info.parameters.struct_name;
    const std::string choice_prefix = std::string(type) + "_";
    std::string renamed;
    std::size_t copied = 0;  // up to where the file is in `renamed`
    gpu::GlslScanner scanner(own.glsl);
    for (gpu::Token token = scanner.next(); token.kind != gpu::Token::Kind::End; token = scanner.next()) {
        if (token.kind == gpu::Token::Kind::Blank) continue;
        if (token.kind == gpu::Token::Kind::Member) members.insert(token.text);
        if (token.kind != gpu::Token::Kind::Word) continue;
        const bool is_own =
            token.text == info.name || (token.text.starts_with(prefix) && !shared_words().contains(token.text));
        const bool is_of_type = token.text == type || token.text.starts_with(choice_prefix);
        if (is_own || is_of_type || std::ranges::find(images, token.text) != images.end()) {
            renamed.append(own.glsl, copied, scanner.place() - copied).append(suffix);
            copied = scanner.place();
        }
        out.asks_parameters |= token.text == loader;
    }
    renamed.append(own.glsl, copied);
    for (const ParamInfo& row : info.parameters.rows) {
        const bool may_be_literal = row.is_loop_count || row.kind == Kind::Choice || row.kind == Kind::Toggle;
        if (may_be_literal && members.contains(row.name)) out.literal_rows.push_back(&row);
    }
    DARKROOM_TRY(append_with_includes(out.glsl, renamed, own.shown));
    out.asks_rays_meet = out.glsl.find("rays_meet") != std::string::npos;
    return out;
}

std::string pass_body(const FusedStep& step) {
    if (!step.text->asks_parameters) return step.text->glsl;
    return parameter_struct(step.info->parameters, step.place) + parameter_loader(*step.info, step.place, step.baked) +
           step.text->glsl;
}

namespace {

/// What the text of a step reads its second picture by: the steps before it hold its reading, if it has one.
std::string second_function(const FusedStep& step, std::span<const FusedStep> before) {
    const std::string suffix = place_suffix(step.place), image = "second" + suffix;
    const std::string name = fmt::format("{}_second{}", step.info->name, suffix);
    const bool has_reading = std::ranges::any_of(before, [&](const FusedStep& other) { return other.reads == image; });
    const std::string plain = step.is_second_resampled ? fmt::format("sample_linear({}, pixel.uv)", image)
                                                       : fmt::format("load({}, pixel.texel)", image);
    if (has_reading) return reading_function(name, image, before, plain);
    return fmt::format("vec4 {}(Pixel pixel) {{ return {}; }}\n", name, plain);
}

}  // namespace

bool is_moved(std::span<const FusedStep> steps) {
    if (steps.empty() || steps.front().is_merge) return false;
    return steps.front().info->touch == Touch::Warp || steps.front().reads == picture_name;
}

namespace {

/// In integers: a pixel's centre, in half texels, lies on a texel's centre or between two.
constexpr std::string_view closest_function = R"(vec4 closest_texel(Pixel pixel) {
    ivec2 twice = 2 * pixel.size, place = (2 * pixel.texel + 1) * size(picture) - pixel.size;
    ivec2 low = (place + twice) / twice - 1, high = low + ivec2(notEqual(low * twice, place));
    float a = load_clamped(picture, low).r, b = load_clamped(picture, ivec2(high.x, low.y)).r;
    float c = load_clamped(picture, ivec2(low.x, high.y)).r, d = load_clamped(picture, high).r;
    float least = min(min(a, b), min(c, d)), most = max(max(a, b), max(c, d));
    return vec4(custom[0].x != 0.0 ? most : least);
}
)";

/// The lines that finish for the target.
std::string finish_code(Finish finish, std::uint32_t word) {
    const std::string by = finish == Finish::Convert ? fmt::format("{}u", word) : "finish_";
    const std::string conversion = fmt::format(
        "color.rgb = color_state_convert(color.rgb, {}, finish_scale_, finish_limit_, finish_ootf_, "
        "finish_target_ootf_);",
        by);
    std::string out;
    for (const auto& [kind, call] :
         {std::pair<Finish, std::string_view>{Finish::EncodeSrgb, "color.rgb = srgb_encode(color.rgb);"},
          {Finish::DecodeSrgb, "color.rgb = srgb_decode(color.rgb);"},
          {Finish::Convert, conversion}}) {
        if (finish == kind) return fmt::format("    {}\n", call);
        const bool is_whole_word = finish == Finish::OfFrameOrConvert;
        if (!is_by_frame(finish) || (kind == Finish::Convert && !is_whole_word)) continue;
        out += fmt::format("    if ({} == {}u) {}\n", is_whole_word ? "(finish_ & 3u)" : "finish_",
                           static_cast<unsigned>(kind), call);
    }
    return out;
}

std::string work_word(const FusedStep& step, std::string_view prefix) {
    return step.work ? fmt::format("{}u", *step.work) : fmt::format("{}work_", prefix);
}

/// Of an effect that mixes pixels: from the picture's numbers to light, multiplied by alpha where frames are, and back.
std::string light_functions(const FusedStep& step, std::string_view prefix, std::string_view suffix) {
    const auto function = [&](std::string_view name, std::string_view turned) {
        std::string out = fmt::format("vec4 {}_{}{}(vec4 color) {{\n", step.info->name, name, suffix);
        if (step.is_wrapped && step.work != 0u) {
            out += fmt::format("    if ({} == 0u) return color;\n", work_word(step, prefix));
            if (step.divides_alpha) out += "    color = alpha_divided(color);\n";
            out += fmt::format("    color.rgb = {};\n", turned);
            if (step.divides_alpha) out += "    color = alpha_multiplied(color);\n";
        }
        return out + "    return color;\n}\n";
    };
    const std::string word = work_word(step, prefix);
    return function("light", fmt::format("color_state_to_light(color.rgb, {}, {}work_ootf_)", word, prefix)) +
           function("coded",
                    fmt::format("color_state_from_light(color.rgb, {0}, {1}work_limit_, {1}work_ootf_)", word, prefix));
}

}  // namespace

Result<std::string> fused_body(std::span<const FusedStep> steps, Finish finish, Resampling resampling, bool is_alpha,
                               std::uint32_t finish_word, FinishAlpha alpha) {
    std::string declarations, code;
    bool has_merge = false, has_reading = false, reads_picture = false, has_wrap = false;
    bool has_alpha = alpha.divides || alpha.multiplies;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const FusedStep& step = steps[i];
        const std::string suffix = place_suffix(step.place), prefix = block_prefix(*step.info, step.place);
        const bool is_of_reading = !step.reads.empty(), mixes_light = step.info->works.in == WorkingSpace::Light;
        has_reading |= is_of_reading;
        if (step.info->second == Second::InPlace && !step.is_merge)
            declarations += second_function(step, steps.first(i));
        if (!step.is_merge) {
            declarations += parameter_struct(step.info->parameters, step.place);
            declarations += parameter_loader(*step.info, step.place, step.baked);
            if (step.custom_vectors > 0)
                declarations += fmt::format("vec4 {}_custom{}(int index) {{ return custom[{} + index]; }}\n",
                                            step.info->name, suffix, step.first_vector);
            if (step.info->touch == Touch::Tap)
                declarations += fmt::format("vec4 {}_read{}(vec2 uv) {{ return sample_linear({}, uv); }}\n",
                                            step.info->name, suffix, step.reads);
            if (mixes_light) {
                has_wrap |= step.is_wrapped;
                has_alpha |= step.divides_alpha;
                declarations += light_functions(step, prefix, suffix);
            }
            declarations += step.text->glsl;
        }
        if (is_of_reading && !step.is_layer) {
            reads_picture |= step.reads == picture_name;
            continue;
        }
        if (step.is_layer) declarations += reading_function("reading_" + suffix, picture_name, {&step, 1}, "");
        std::string layer = step.is_merge   ? fmt::format("load(layer{}, pixel.texel)", suffix)
                            : step.is_layer ? fmt::format("reading_{}(pixel)", suffix)
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
        if (!mixes_light && step.is_wrapped && step.work != 0u) {
            has_wrap = true;
            const std::string word = work_word(step, prefix);
            declarations += fmt::format(
                "vec4 wrapped{0}(vec4 color, Pixel pixel) {{\n    bool is_other = {1} != 0u;\n"
                "    if (is_other) color.rgb = color_state_to_srgb(color.rgb, {1}, {2}work_scale_, {2}work_ootf_);\n"
                "    color = {3};\n    if (is_other)\n        color.rgb = color_state_from_srgb(color.rgb, {1}, "
                "{2}work_scale_, {2}work_limit_, {2}work_ootf_);\n    return color;\n}}\n",
                suffix, word, prefix, layer);
            layer = fmt::format("wrapped{}(color, pixel)", suffix);
        }
        if (!mixes_light && step.divides_alpha) {
            has_alpha = true;
            declarations += fmt::format(
                "vec4 without_alpha{}(vec4 color, Pixel pixel) {{\n    color = alpha_divided(color);\n"
                "    return alpha_multiplied({});\n}}\n",
                suffix, layer);
            layer = fmt::format("without_alpha{}(color, pixel)", suffix);
        }
        code += step.is_certain ? fmt::format("    color = {};\n", layer)
                                : fmt::format("    if ({}enabled_ != 0u) color = {};\n", prefix, layer);
    }

    std::string helpers;
    const auto include = [&](std::string_view name) {
        return append_with_includes(helpers, fmt::format("#include \"{}\"\n", name), "fused kernel");
    };
    if (has_merge) DARKROOM_TRY(include("shared/merge.glsl"));
    if (has_reading) DARKROOM_TRY(include("shared/place.glsl"));
    if (has_wrap) DARKROOM_TRY(include("shared/color_state.glsl"));
    if (has_alpha) DARKROOM_TRY(include("shared/alpha.glsl"));
    if (alpha.divides) code += "    color = alpha_divided(color);\n";
    if (finish != Finish::None) {
        DARKROOM_TRY(include("shared/srgb.glsl"));
        const bool may_convert = finish == Finish::Convert || finish == Finish::OfFrameOrConvert;
        if (may_convert && !has_wrap) DARKROOM_TRY(include("shared/color_state.glsl"));
        code += finish_code(finish, finish_word);
    }
    if (alpha.multiplies) code += "    color = alpha_multiplied(color);\n";
    std::string_view read = is_moved(steps) ? "load_clamped(picture, pixel.texel)" : "load(picture, pixel.texel)";
    if (resampling == Resampling::Linear) read = "sample_linear(picture, pixel.uv)";
    // The texel under the pixel's centre; in integers, because a product of floats may fall short of it.
    if (resampling == Resampling::Nearest || resampling == Resampling::Motion)
        read = "load_clamped(picture, (2 * pixel.texel + 1) * size(picture) / (2 * pixel.size))";
    if (resampling == Resampling::Motion) code += "    color *= custom[0];\n";
    if (resampling == Resampling::Closest) {
        declarations += closest_function;
        read = "closest_texel(pixel)";
    }
    if (reads_picture) {
        declarations += reading_function("reading_picture", picture_name, steps, read);
        read = "reading_picture(pixel)";
    }
    if (is_alpha) read = "vec4(vec3(clamp(load(picture, pixel.texel).a, 0.0, 1.0)), 1.0)";
    return fmt::format(
        "{}{}#line 1 \"fused kernel\"\nvec4 shade(Pixel pixel) {{\n    vec4 color = {};\n{}    return color;\n}}\n",
        helpers, declarations, read, code);
}

}  // namespace darkroom::plan
