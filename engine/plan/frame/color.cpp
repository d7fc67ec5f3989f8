// SPDX-License-Identifier: MIT
#include "plan/frame/color.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "gpu/resource/formats.hpp"

namespace darkroom::plan {

namespace {

std::uint32_t word_of(const ColorState& state) {
    return 1u | static_cast<std::uint32_t>(state.transfer) << 1u | static_cast<std::uint32_t>(state.primaries) << 4u;
}

/// As hlg_ootf of effects/shared/color_state.glsl has it.
float ootf_of(const ColorState& state) {
    if (state.transfer != Transfer::Hlg) return 1.0f;
    const float peak = state.peak_nits / 1000;
    return peak >= 0.4f && peak <= 2.0f ? 1.2f + 0.42f * std::log10(peak) : 1.2f * std::pow(1.111f, std::log2(peak));
}

/// What a kernel writes: an SRGB format encodes by itself.
ColorState written_state(ColorState target, VkFormat format) {
    if (gpu::format_traits(format).is_srgb) target.transfer = Transfer::Linear;
    return target;
}

}  // namespace

bool may_need_work(const EffectInfo& info, bool may_be_encoded, bool is_always_encoded) {
    if (info.works.in == WorkingSpace::Light) return may_be_encoded || is_always_encoded;
    if (info.touch != Touch::Pointwise || is_always_encoded) return false;
    if (info.works.in == WorkingSpace::Encoded) return true;
    return may_be_encoded && info.accepts.contains(Domain::Encoded) && !info.is_last_step && !info.has_second();
}

Work work_of(const EffectInfo& info, const ColorState& before, const void* parameters) {
    if (info.works.in == WorkingSpace::Light) {
        if (before.domain != Domain::Encoded) return {};
        // A mix is the same in all primaries.
        ColorState own = before;
        own.primaries = Primaries::Rec709;
        return {.word = word_of(own), .limit = before.peak_nits / before.unit_nits(), .ootf = ootf_of(before)};
    }
    const bool works_encoded = info.works.in == WorkingSpace::Encoded;
    const bool is_wanted = before.domain == Domain::Encoded ? !before.is_standard_code() : works_encoded;
    // The interface is sRGB's, primaries included.
    const bool is_other = works_encoded && before.primaries != Primaries::Rec709;
    if (!is_wanted && !is_other) return {};
    const float white = info.works.white_nits == nullptr ? before.white_nits : info.works.white_nits(parameters);
    const float unit = before.unit_nits();
    Work out{.word = word_of(before), .scale = unit / white, .ootf = ootf_of(before)};
    if (before.domain == Domain::Encoded) out.limit = before.peak_nits / unit;
    return out;
}

Conversion conversion_of(const ColorState& from, const ColorState& to) {
    const bool is_same_light = from.primaries == to.primaries && from.unit_nits() == to.unit_nits();
    if (is_same_light && from.transfer == to.transfer) return {};
    if (is_same_light && from.transfer == Transfer::Linear && to.transfer == Transfer::Srgb)
        return {.kind = Finish::EncodeSrgb};
    if (is_same_light && from.transfer == Transfer::Srgb && to.transfer == Transfer::Linear)
        return {.kind = Finish::DecodeSrgb};
    Conversion out{.kind = Finish::Convert,
                   .from = word_of(from),
                   .to = word_of(to),
                   .scale = from.unit_nits() / to.unit_nits(),
                   .ootf = ootf_of(from),
                   .target_ootf = ootf_of(to)};
    if (to.domain == Domain::Encoded) out.limit = to.peak_nits / to.unit_nits();
    return out;
}

Conversion finish_of(const ColorState& picture, const CompileDesc& desc) {
    if (desc.target_color) return conversion_of(picture, written_state(*desc.target_color, desc.target.format));
    if (target_domain(desc) != Domain::Encoded) return {};
    const gpu::FormatTraits& traits = gpu::format_traits(desc.target.format);
    if (picture.domain == Domain::Encoded) return {.kind = traits.is_srgb ? Finish::DecodeSrgb : Finish::None};
    const bool is_encoded_here = !traits.is_srgb && desc.encodes_target.value_or(!traits.is_float);
    return {.kind = is_encoded_here ? Finish::EncodeSrgb : Finish::None};
}

Domain target_domain(const CompileDesc& desc) {
    if (desc.target_color) return desc.target_color->domain;
    return desc.target_domain.value_or(gpu::format_traits(desc.target.format).is_float ? Domain::SceneLinear
                                                                                       : Domain::Encoded);
}

ColorState scene_state(const CompileDesc& desc) {
    return {.white_nits = desc.target_color ? desc.target_color->white_nits : ColorState{}.white_nits,
            .is_associated = desc.is_color_associated};
}

bool maps_without_alpha(const EffectInfo& info, bool is_wrapped, bool is_associated) {
    if (info.works.in == WorkingSpace::Light) return is_associated && is_wrapped;
    return is_associated && info.touch == Touch::Pointwise && (info.works.in == WorkingSpace::Straight || is_wrapped);
}

FinishAlpha finish_alpha(const CompileDesc& desc, Finish finish) {
    const bool before = desc.is_color_associated;
    const bool behind = desc.target_color ? desc.target_color->is_associated : before;
    if (before == behind && finish == Finish::None) return {};
    return {.divides = before, .multiplies = behind};
}

Result<> check_target_color(const CompileDesc& desc) {
    if (!desc.target_color) return {};
    const ColorState& color = *desc.target_color;
    const bool is_code = color.domain == Domain::Encoded;
    const auto is_luminance = [](float nits) { return nits >= 1 && nits <= 10000; };
    if (!is_luminance(color.white_nits))
        return user_error(fmt::format("target_color.white_nits = {:g}: allowed are 1 to 10000", color.white_nits));
    if (is_code && !is_luminance(color.peak_nits))
        return user_error(fmt::format("target_color.peak_nits = {:g}: allowed are 1 to 10000", color.peak_nits));
    if (!is_code && color.transfer != Transfer::Linear)
        return user_error("target_color.transfer: light has none: allowed is Linear");
    if (gpu::format_traits(desc.target.format).is_srgb && (!is_code || color.transfer != Transfer::Srgb))
        return user_error("target_color.transfer: an SRGB format has the curve of sRGB: allowed is Srgb");
    return {};
}

std::string text_of(const ColorState& state) {
    constexpr std::array domains{"scene light", "display light", "code values"};
    constexpr std::array primaries{"Rec. 709", "Rec. 2020", "P3"};
    constexpr std::array transfers{"linear", "sRGB", "power of 2.2", "PQ", "HLG", "scRGB"};
    std::string out = fmt::format("{}, {}", domains[static_cast<std::size_t>(state.domain)],
                                  primaries[static_cast<std::size_t>(state.primaries)]);
    if (state.domain == Domain::Encoded)
        out += fmt::format(", {}", transfers[static_cast<std::size_t>(state.transfer)]);
    out += fmt::format(", white {:g} cd/m2", state.white_nits);
    if (state.peak_nits > 0) out += fmt::format(", up to {:g} cd/m2", state.peak_nits);
    return state.is_associated ? out + ", multiplied by alpha" : out;
}

}  // namespace darkroom::plan
