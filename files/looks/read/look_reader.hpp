// SPDX-License-Identifier: MIT
#pragma once
// What the readers of the two forms of a look share: collecting problems with their places, and taking a value or
// saying why not.

#include <darkroom/look.hpp>
#include <functional>
#include <string>
#include <vector>

#include "looks/apply/look_resources.hpp"
#include "looks/look_parts.hpp"
#include "toml/toml_text.hpp"

namespace darkroom {

/// Slips (unknown keys, values out of range) are warnings unless the reader is strict.
enum class Weight : std::uint8_t { Slip, Wrong };

class LookReader {
  public:
    LookReader(std::string shown_name, const LookOptions& options, const CameraLens& lens = {})
        : options_(options), shown_name_(std::move(shown_name)), lens_(lens), files_(options.folder, options) {}

    [[nodiscard]] Result<Look> read(const toml::table& file);
    [[nodiscard]] const LookOptions& options() const { return options_; }

    void report(const toml::source_position& place, Weight weight, std::string text) {
        problems_.push_back({place, weight, std::move(text)});
    }
    void report(const toml::node& node, Weight weight, std::string text) {
        report(node.source().begin, weight, std::move(text));
    }
    /// Sets the words of `row` to the node's value. Or reports why not, and leaves the default.
    bool take(const ParamInfo& row, std::span<std::uint32_t> words, const toml::node& node, std::string_view key);
    /// The same for a parameter of the entry's effect, which may name a file.
    bool take(const ParamInfo& row, LookEntry& entry, const toml::node& node, std::string_view key);
    /// Wires the entry to the picture in a file. Or reports why not.
    void take(const WireInfo& wire, LookEntry& entry, const std::string& file, const toml::node& node);
    /// The same for one of the entry's own values.
    bool take(const ParamInfo& row, EntryState& state, const toml::node& node, std::string_view key);
    /// Gives an effect that is told where a lens is focused what the camera says of it, but for the rows that the file
    /// writes. What a row does not allow is for the reader of scenes to report.
    void put_lens(LookEntry& entry, const std::function<bool(std::string_view row)>& is_written) const;
    /// `allowed` says what the nearest known key takes. `meant`: the known key that it stands for; empty: the nearest.
    void report_unknown(const toml::key& key, const toml::node& node, std::span<const std::string> known,
                        const std::function<std::string(const std::string&)>& allowed, const std::string& meant = {});

  private:
    static constexpr std::size_t max_suggestions = 256;

    struct Problem {
        toml::source_position place;
        Weight weight = Weight::Slip;
        std::string text;
    };

    void read_top(const toml::table& file);
    void read_lens(const toml::table& file);
    Result<Look> finish(Look look);

    const LookOptions& options_;
    std::string shown_name_;
    CameraLens lens_;
    ResourceFiles files_;
    std::vector<Problem> problems_;
};

/// The pulses and layers that the file has for a look.
void read_modulation(LookReader& reader, const toml::table& file, Look& look);
/// A table as what the game says: at most 256 numbers, strings and booleans. Errors without a place.
[[nodiscard]] Result<GameTable> game_values(const toml::node& node);
[[nodiscard]] Look read_flat(LookReader& reader, const toml::node* node);
/// Adds the table [ui] to a look.
void read_ui(LookReader& reader, Look& look, const toml::node& node);
[[nodiscard]] Look read_stack(LookReader& reader, const toml::node& node);

}  // namespace darkroom
