// SPDX-License-Identifier: MIT
#pragma once
// What editors do to a look, each for LookDocument::edit. Entries are named as darkroom::entry_names has them. A flat
// look holds values and switches alone: what changes its order, or something of an entry that the flat table has no key
// for, makes it the stack that it stands for, with what is off where a hand or a file has set it. Errors name the
// entry, the value and what is allowed.

#include <cstdint>
#include <darkroom/look.hpp>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom::edit {

/// Sets a parameter of the entry's effect to `words` of its kind. An amount above 0 switches an entry of the flat table
/// on, 0 off, as in a file.
Result<> set_value(Look& look, std::string_view entry, std::string_view parameter,
                   std::span<const std::uint32_t> words);
Result<> reset_value(Look& look, std::string_view entry, std::string_view parameter);
/// All parameters of its effect.
Result<> reset_entry(Look& look, std::string_view entry);
/// Sets one of the entry's own rows: enabled, opacity, blend, scale, format (darkroom::entry_rows).
Result<> set_state(Look& look, std::string_view entry, std::string_view row, std::span<const std::uint32_t> words);
/// Wires an entry: `wire` is input, source, second or mask, and `name` an output before it, "scene", "alpha", "ui",
/// "NAME.previous", the file of a picture, or empty; or `wire` is name or output, the entry's own.
Result<> set_wire(Look& look, std::string_view entry, std::string_view wire, const std::string& name,
                  const LookOptions& options);
/// Gives a parameter of kind Resource a file, relative to the options' folder; an empty name takes it away.
Result<> set_file(Look& look, std::string_view entry, std::string_view parameter, const std::string& file,
                  const LookOptions& options);

/// Puts another look in its place. What that one names beside `from`, its folder, is named from `to`; entries of the
/// same names stay the same to pulses, layers and whoever has chosen one.
void take_look(Look& look, Look other, const std::filesystem::path& from, const std::filesystem::path& to);

/// What add_effect() without a `before` would do.
struct Addition {
    enum class Kind : std::uint8_t {
        SwitchesOn,  ///< the look has a place for it, and it is off there
        IsThere,     ///< the same, and it is on
        Inserts,     ///< into the stack
        MakesStack,  ///< a flat table, which has no place for it, becomes a stack
    };
    Kind kind{};
    std::string entry{};  ///< of the first two: its name
};
[[nodiscard]] Addition addition_of(const Look& look, const EffectInfo& effect);

/// Puts an entry in front of another; an empty `before`: behind the last of the picture's chain.
Result<> move_entry(Look& look, std::string_view entry, std::string_view before);
/// What the flat table, or that of the interface, holds is switched off there.
Result<> remove_entry(Look& look, std::string_view entry);
/// Puts a copy behind it, without its output's name. Returns the copy's name.
Result<std::string> duplicate_entry(Look& look, std::string_view entry);
/// Adds an effect in front of an entry, or where the picture is in a domain that it accepts (place_entry). What the
/// look has already and is off, in a flat table or in the interface's, is switched on there. Returns its name.
Result<std::string> add_effect(Look& look, const EffectInfo& effect, std::string_view before = {});
/// The same for an entry with its values, such as that of a custom effect (darkroom::custom_entry).
Result<std::string> add_entry(Look& look, LookEntry entry, std::string_view before = {});

/// Values, switches and opacities of a Composer which follows a look, to tell what others (a console) set in it.
class ComposerValues {
  public:
    explicit ComposerValues(const Composer& composer);
    /// Takes over what is another in the Composer since then. Tables are the look's.
    Result<> take_changes(Look& look, const Composer& now) const;

  private:
    struct Entry {
        std::vector<std::uint32_t> words;
        bool is_enabled = true;
        float opacity = 1;
    };
    std::map<std::string, Entry> entries_;
};

}  // namespace darkroom::edit
