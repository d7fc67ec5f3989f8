// SPDX-License-Identifier: MIT
#include "plan/frame/color.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace darkroom::plan {

bool may_need_work(const EffectInfo& info, bool may_be_encoded, bool is_always_encoded) {
    if (info.touch != Touch::Pointwise || is_always_encoded) return false;
    if (info.works_encoded) return true;
    return may_be_encoded && info.accepts.contains(Domain::Encoded) && !info.is_last_step && !info.has_second;
}

Work work_of(const EffectInfo& info, const ColorState& before, const void* parameters) {
    const bool is_wanted = before.domain == Domain::Encoded ? !before.is_standard_code() : info.works_encoded;
    // The interface is sRGB's, primaries included.
    const bool is_other = info.works_encoded && before.primaries != Primaries::Rec709;
    if (!is_wanted && !is_other) return {};
    const float white = info.working_white_nits == nullptr ? before.white_nits : info.working_white_nits(parameters);
    const float unit = before.unit_nits();
    Work out{.word = 1u | static_cast<std::uint32_t>(before.transfer) << 1u |
                     static_cast<std::uint32_t>(before.primaries) << 4u,
             .scale = unit / white};
    if (before.domain == Domain::Encoded) out.limit = before.peak_nits / unit;
    // ITU-R BT.2100, table 5, note 5f.
    if (before.transfer == Transfer::Hlg) out.ootf = 1.2f + 0.42f * std::log10(before.peak_nits / 1000);
    return out;
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
    return state.peak_nits > 0 ? out + fmt::format(", up to {:g} cd/m2", state.peak_nits) : out;
}

}  // namespace darkroom::plan
