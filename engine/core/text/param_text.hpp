// SPDX-License-Identifier: MIT
#pragma once
// The one place where values of parameters become text and text becomes values: TOML, flags, consoles and pages all
// come here. It knows rows (darkroom/param.hpp) and words, no files and no effects. Error texts name thing, value and
// what is allowed; the caller puts the place in front.

#include <array>
#include <cstdint>
#include <darkroom/param.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/try.hpp"

namespace darkroom {

using CurvePoints = std::vector<std::array<double, 2>>;
/// A value as files and flags have it, before it is one of a parameter.
using ParamValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>, CurvePoints>;

/// Why a value is not taken. A reader of files may go on with the default after OutOfRange, but not after WrongKind.
struct ParamProblem {
    enum class Why : std::uint8_t { WrongKind, OutOfRange };
    Why why = Why::WrongKind;
    std::string text;  ///< "bloom_intensity = -1: allowed is [0, 16]"
};

/// Writes `value` into the words of the whole struct, or says why not and changes nothing. Whole numbers are taken for
/// floats, and integral floats for whole numbers; NaN and infinity for nothing. `shown` is the key that the text names.
[[nodiscard]] std::optional<ParamProblem> try_assign(const ParamInfo& info, std::span<std::uint32_t> words,
                                                     const ParamValue& value, std::string_view shown);
/// The same as a Result. Without `shown`, the text names the row.
[[nodiscard]] Result<> assign(const ParamInfo& info, std::span<std::uint32_t> words, const ParamValue& value,
                              std::string_view shown = {});
/// Are `words` (those of this row only) a value that the row allows?
[[nodiscard]] Result<> check_words(const ParamInfo& info, std::span<const std::uint32_t> words,
                                   std::string_view shown = {});

/// Reads a flag's or console's text: "1.5", "on" or "off", "1,0.5,0.2", a choice's name, "0:0,0.5:0.2,1:1" for a curve;
/// for multipliers of light also stops, "1.5ev"; for sizes "2.5%" of the picture's height, which is returned as it is:
/// assign() sets the row's Reach, too.
/// Its errors name neither key nor place; ranges are assign's to check.
[[nodiscard]] Result<ParamValue> parse_text(const ParamInfo& info, std::string_view text);
/// on/off, true/false, yes/no, 1/0.
[[nodiscard]] std::optional<bool> parse_toggle(std::string_view text);
/// A whole text that is one finite number; no locale, no surrounding blanks.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// The value as TOML; floats are the shortest text that reads back as the same bits. `words` are those of the struct.
[[nodiscard]] std::string format(const ParamInfo& info, std::span<const std::uint32_t> words);
/// The same for files, where a size whose Reach is Height stands in % of it: "2.5%".
[[nodiscard]] std::string format_for_file(const ParamInfo& info, std::span<const std::uint32_t> words);
/// "[0, 16]", "[1, 64] px", "srgb, gamma22 or none", "true or false".
[[nodiscard]] std::string interval(const ParamInfo& info);
/// The row's sentence, and more where its text may be in stops or a change needs a compile.
[[nodiscard]] std::string full_doc(const ParamInfo& info);
/// What a value of this kind looks like: "a number", "an array of 3 numbers".
[[nodiscard]] std::string_view expected_kind(Kind kind);

/// Key of the flat table: <effect>_<member>, or the effect's name alone for the member of that name.
[[nodiscard]] std::string flat_key(std::string_view effect, std::string_view member);
/// bloom_intensity -> --bloom-intensity
[[nodiscard]] std::string flag_name(std::string_view key);

/// The name that `wrong` was most likely meant to be, by edit distance; empty if none is near.
[[nodiscard]] std::string nearest(std::string_view wrong, std::span<const std::string> names);
/// ", did you mean 'x'?" or nothing.
[[nodiscard]] std::string suggestion(std::string_view wrong, std::span<const std::string> names);
/// What could stand in the place of `wrong`: ", did you mean 'x'? allowed is x, y and 20 more", or ": allowed is x, y
/// and 20 more" where no name is near.
[[nodiscard]] std::string alternatives(std::string_view wrong, std::span<const std::string> names,
                                       std::string_view lead = "allowed is");
/// "a, b and c", with `last` before the last; of many names the first, and how many more there are.
[[nodiscard]] std::string some_of(std::span<const std::string> names, std::string_view last);
/// Text from outside made fit for one line of a terminal: control bytes and broken UTF-8 as \x1B, long texts cut.
[[nodiscard]] std::string printable(std::string_view text);

/// The parameters of an effect as a table in Markdown: the generated part of its page.
[[nodiscard]] std::string documentation(const ParamTable& table, std::string_view effect);

}  // namespace darkroom
