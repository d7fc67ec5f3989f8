// SPDX-License-Identifier: MIT
#include "image/color/interop_space.hpp"

#include <algorithm>
#include <array>

namespace darkroom {
namespace {

using Kind = TransferCurve::Kind;

struct InteropCurve {
    std::string_view name;
    TransferCurve curve;
};
// What is beyond 1 in srgbe and srgbx goes on as below it.
constexpr std::array<InteropCurve, 10> interop_curves{{{"lin", {}},
                                                       {"srgb", {Kind::Srgb}},
                                                       {"srgbe", {Kind::Srgb}},
                                                       {"srgbx", {Kind::Srgb}},
                                                       {"g18", {Kind::Power, 1.8}},
                                                       {"g22", {Kind::Power, 2.2}},
                                                       {"g24", {Kind::Power, 2.4}},
                                                       {"g26", {Kind::Power, 2.6}},
                                                       {"pq", {Kind::Pq}},
                                                       {"hlg", {Kind::Hlg}}}};

struct InteropPrimaries {
    std::string_view name;
    Chromaticities primaries;
};
std::array<InteropPrimaries, 8> interop_primaries() {
    // White is D65, as that of Rec. 709: nothing is adapted.
    constexpr Chromaticities xyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};
    return {{{"rec709", {}},
             {"rec2020", find_input_space("rec2020")->primaries},
             {"p3d65", find_input_space("p3")->primaries},
             {"ap1", find_input_space("acescg")->primaries},
             {"ap0", find_input_space("aces2065-1")->primaries},
             {"adobergb", {.green = {0.21, 0.71}}},
             {"ciexyzd65", xyz},
             {"xyzd65", xyz}}};
}

}  // namespace

std::optional<InteropSpace> find_interop_space(std::string_view id) {
    id.remove_prefix(id.rfind(':') + 1);
    if (id == "data") return InteropSpace{.coding = {.curve = {}}, .is_data = true};
    if (id == "unknown") return InteropSpace{.coding = {.curve = {}}, .is_unknown = true};
    const std::size_t first = id.find('_'), last = id.rfind('_');
    if (first == last || (id.substr(last) != "_scene" && id.substr(last) != "_display")) return std::nullopt;
    const auto* const curve = std::ranges::find(interop_curves, id.substr(0, first), &InteropCurve::name);
    if (curve == interop_curves.end()) return std::nullopt;
    for (const auto& [name, of] : interop_primaries())
        if (name == id.substr(first + 1, last - first - 1)) return InteropSpace{.coding = {of, curve->curve}};
    return std::nullopt;
}

std::string interop_id_of(const Chromaticities& of) {
    for (const auto& [name, primaries] : interop_primaries())
        if (is_near(primaries, of)) return "lin_" + std::string(name) + "_scene";
    return {};
}

}  // namespace darkroom
