// SPDX-License-Identifier: MIT
#pragma once
// What the reader, the writer and the overrides of looks share: the names of keys that belong to an entry.

#include <array>
#include <bit>
#include <darkroom/describe.hpp>
#include <darkroom/look.hpp>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "looks/camera_lens.hpp"

namespace darkroom {

/// The wire to the picture as it came.
inline constexpr std::string_view scene_name = "scene";
/// All wires to pictures that no entry makes: that one, its alpha as a grey picture, and the interface's image. Of the
/// last two nobody has the frame before.
using GivenWire = std::pair<std::string_view, Handle>;
inline constexpr std::array<GivenWire, 3> given_wires{
    {{scene_name, scene_color}, {"alpha", scene_alpha}, {"ui", ui_layer}}};
/// Behind another name: that picture one frame before.
inline constexpr std::string_view previous_suffix = ".previous";
inline constexpr const auto& order_names = detail::Enumerators<LookOrder>::names;

struct WireInfo {
    std::string_view key;
    std::string LookEntry::*member;
    bool is_reference;                    ///< names another entry's output
    Handle EntryDesc::*handle = nullptr;  ///< of a reference
    FileUse use = FileUse::Picture;       ///< of a file that it names
};
inline constexpr std::array<WireInfo, 6> wires{{{"name", &LookEntry::name, false},
                                                {"input", &LookEntry::input, true, &EntryDesc::input},
                                                {"source", &LookEntry::source, true, &EntryDesc::source},
                                                {"second", &LookEntry::second, true, &EntryDesc::second},
                                                {"mask", &LookEntry::mask, true, &EntryDesc::mask, FileUse::Numbers},
                                                {"output", &LookEntry::output, false}}};

/// Is the key, which nothing has, what people type for the amount of an effect: "EFFECT_intensity", or "intensity"?
[[nodiscard]] constexpr bool stands_for_amount(std::string_view key, std::string_view effect) {
    if (key.starts_with(effect) && key.substr(effect.size()).starts_with('_')) key.remove_prefix(effect.size() + 1);
    return key == "intensity" || key == "amount" || key == "strength";
}

/// Is this a wire's name of a file, and not of an output?
[[nodiscard]] bool is_file_name(std::string_view wire);

using StateWords = std::array<std::uint32_t, sizeof(EntryState) / 4>;
[[nodiscard]] inline StateWords state_words(const EntryState& state) { return std::bit_cast<StateWords>(state); }

/// What a key names: a row of the entry's effect, one of the entry's own, or one of its wires.
struct LookTarget {
    LookEntry* entry = nullptr;
    const ParamInfo* row = nullptr;
    bool is_state = false;
    const WireInfo* wire = nullptr;
};
/// Of "bloom_intensity", or "ENTRY.parameter". Errors begin with `shown`, and name the nearest.
[[nodiscard]] Result<LookTarget> find_target(Look& look, std::string_view key, const std::string& shown);
inline constexpr std::size_t max_pulses = 256, max_layers = 32;
/// Of what a pulse adds, up or down.
inline constexpr double max_amount = 1e6;
/// What pulses and layers add to a file.
void write_modulation(std::string& out, const Look& look);
/// Does a pulse or a layer move the entry of this name?
[[nodiscard]] bool is_moved(const Look& look, std::string_view entry);
/// What is off is on with an amount of 0, so that it comes and goes without a step: what reading a look does with an
/// entry whose amount a pulse or a layer moves.
void wake(LookEntry& entry);
/// The values of a layer that is the look of a file, named relative to the options' folder: those in which it differs.
/// Entries of `look` that it wakes are woken. Errors: those of the file; it has an entry that `look` lacks.
[[nodiscard]] Result<std::vector<LookLayer::Value>> layer_values(Look& look, const std::string& file,
                                                                 const LookOptions& options);
/// The keys of a lens in [camera], and the rows that they stand in for, of effects that have a focus distance.
struct LensKey {
    std::string_view key, row;
    std::optional<float> CameraLens::*member;
};
inline constexpr std::array<LensKey, 3> lens_keys{{{"aperture", "f_stop", &CameraLens::aperture},
                                                   {"focus", "focus_distance", &CameraLens::focus},
                                                   {"sensor_height", "sensor_height", &CameraLens::sensor_height}}};
/// read_look() and parse_look() for what such a camera sees. Where it says nothing, the [camera] of a look that is a
/// scene's counts.
[[nodiscard]] Result<Look> read_look(const std::filesystem::path& path, const LookOptions& options,
                                     const CameraLens& lens);
[[nodiscard]] Result<Look> parse_look(std::string_view text, std::string shown_name, const LookOptions& options,
                                      const CameraLens& lens);
/// The text of a look's file, if it is one that may be read.
[[nodiscard]] Result<std::string> read_look_text(const std::filesystem::path& path);
/// Letters, digits, '_' and '-', up to 64.
[[nodiscard]] bool is_look_name(std::string_view text);

[[nodiscard]] std::int32_t flat_rank(const EffectInfo& effect, LookOrder order);
/// The entries as they go into a Composer: the flat table in its order and without what that order lacks.
[[nodiscard]] std::vector<const LookEntry*> ordered(const Look& look);
/// What is wrong with the entry's values together, as "fog: ..."; empty: nothing.
[[nodiscard]] std::string conflict_of(const LookEntry& entry);
struct LookProblem {
    std::size_t entry = 0;  ///< its number
    std::string_view key;   ///< of the wire that is wrong; empty: the entry is
    std::string text;
};
/// What the entries of a stack cannot be together: names and outputs that two have, wires to what nobody makes, values
/// that contradict each other. `shown`: what an entry is called.
[[nodiscard]] std::vector<LookProblem> problems_of(const Look& look,
                                                   const std::function<std::string(std::size_t)>& shown);
/// Files of one text are one effect: where the look has the entry's already, that one is taken. Errors: it has another
/// effect of that name.
[[nodiscard]] Result<> share_effect(const Look& look, LookEntry& entry);
/// Does it take the picture from one domain to the next? What is left of a flat table that is switched off.
[[nodiscard]] bool is_domain_change(const EffectInfo& effect);
/// Makes a flat look the stack that it stands for, without what is off.
void make_stack(Look& look);
/// An entry with the effect's defaults.
[[nodiscard]] LookEntry entry_of(const EffectInfo& effect);

}  // namespace darkroom
