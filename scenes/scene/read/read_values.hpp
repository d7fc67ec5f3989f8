// SPDX-License-Identifier: MIT
#pragma once
// Takes the values of one table of a scene: whoever reads it names each key once, with what is allowed, and what
// remains is reported as unknown. A value of the wrong kind is an error; one out of range is a slip and leaves what
// `out` held before.

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <darkroom/result.hpp>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/math.hpp"
#include "toml/toml_text.hpp"

namespace darkroom::scene::reading {

// The tables of scene files as a tree that can be merged: prefabs lay overrides over templates, archetypes lie under
// entities, and every value keeps the place it came from. Leaves point into the parsed files, which outlive the tree.

// What is wrong with a scene, collected with its places while the reading goes on, so that one run lists it all. Texts
// are made only for what may be shown: a hostile file has millions of faults.

/// A place in one of the files that a scene is made of; file 0 is the scene itself, others hold prefabs.
struct Place {
    std::uint32_t file = 0, line = 0, column = 0;
    friend auto operator<=>(const Place&, const Place&) = default;
};

class Report {
  public:
    explicit Report(bool is_strict) : is_strict_(is_strict) {}

    std::uint32_t add_file(std::string shown_name);
    [[nodiscard]] bool is_strict() const { return is_strict_; }
    /// "file:line:column"
    [[nodiscard]] std::string show(Place place) const;

    /// `text` is a function that makes the text. An error ends the reading, once everything has been looked at.
    template <class Text>
    void error(Place place, Text&& text) {
        add(errors_, place, std::forward<Text>(text));
    }
    /// A warning, or an error if the reading is strict.
    template <class Text>
    void slip(Place place, Text&& text) {
        add(is_strict_ ? errors_ : warnings_, place, std::forward<Text>(text));
    }
    /// ", did you mean 'x'?" or nothing; nothing either after many, since looking for names is slow.
    [[nodiscard]] std::string suggestion(std::string_view wrong, std::span<const std::string> names);

    /// The warnings in the order of the files go to the list, the errors become one line.
    [[nodiscard]] Result<> finish(std::vector<std::string>* warnings);

  private:
    struct Problem {
        Place place;
        std::string text;
    };
    struct Problems {
        std::vector<Problem> kept;
        std::size_t count = 0;
    };
    static constexpr std::size_t max_kept = 1000, max_shown = 20, max_suggestions = 64;

    template <class Text>
    void add(Problems& problems, Place place, Text&& text) {
        ++problems.count;
        if (problems.kept.size() < max_kept) problems.kept.push_back({place, text()});
    }
    [[nodiscard]] std::vector<std::string> lines(Problems& problems) const;

    bool is_strict_;
    std::vector<std::string> shown_names_;
    Problems errors_, warnings_;
    std::size_t suggestions_ = 0;
};

struct Member;

struct Value {
    const toml::node* node = nullptr;  ///< as the file has it; of a merged table: that of the lower layer
    Place place;
    std::string_view text;        ///< of a string, with its prefix put in
    std::vector<Member> members;  ///< of a table, sorted by key
    [[nodiscard]] bool is_table() const { return node != nullptr && node->is_table(); }
    [[nodiscard]] bool is_text() const { return node != nullptr && node->is_string(); }
};

struct Member {
    std::string_view key;
    Place place;
    Value value;
};

[[nodiscard]] const Value* find(const Value& table, std::string_view key);
/// How many values a table holds, at any depth.
[[nodiscard]] std::size_t member_count(const Value& table);
/// Lays `over` on `base`, table into table; anything else is replaced.
void merge(Value& base, const Value& over);
/// "1.5", "\"yes\"", "[1, 2, 3]", "a table".
[[nodiscard]] std::string show(const Value& value);

[[nodiscard]] inline Place place_of(const toml::source_region& source, std::uint32_t file) {
    return {file, source.begin.line, source.begin.column};
}

/// Makes trees, and owns the texts that prefixes were put into.
class TreeBuilder {
  public:
    explicit TreeBuilder(Report& report) : report_(report) {}
    /// `prefix` goes where the text has ${PREFIX}; null: texts stay as they are.
    [[nodiscard]] Value build(const toml::node& node, std::uint32_t file, const std::string* prefix = nullptr);
    /// Counts values that are copied; false, and an error, where that makes more than a scene may hold.
    [[nodiscard]] bool charge(std::size_t members, Place place);
    /// A copy of `text` that lives as long as the builder.
    [[nodiscard]] std::string_view keep(std::string text);

  private:
    [[nodiscard]] Value build(const toml::node& node, std::uint32_t file, const std::string* prefix, int depth);

    Report& report_;
    std::deque<std::string> texts_;
    std::size_t members_ = 0;
};

inline constexpr std::string_view prefix_mark = "${PREFIX}";
/// `text` with every ${PREFIX} replaced.
[[nodiscard]] std::string with_prefix(std::string_view text, std::string_view prefix);

/// Bounds of a number. Without others, a magnitude that float and the maths of a renderer can bear.
struct Interval {
    double low = -1e9, high = 1e9;
    bool is_open = false;  ///< the bounds themselves are not allowed
    std::string_view unit;
    [[nodiscard]] bool holds(double value) const {
        return is_open ? value > low && value < high : value >= low && value <= high;
    }
};
inline constexpr Interval anything{};
inline constexpr Interval fraction{.low = 0, .high = 1};
inline constexpr Interval not_negative{.low = 0, .high = 1e9};
inline constexpr Interval positive{.low = 0, .high = 1e9, .is_open = true};
/// Light in scene-linear units: half floats end at 65504, but intensities multiply colours and fall off.
inline constexpr Interval light_values{.low = 0, .high = 1e6};

/// Where a table stands in its file, for messages: "entities.lamp.light", "camera.path[2]".
struct Where {
    const Where* up = nullptr;
    std::string_view name;
    std::optional<std::size_t> index;
    [[nodiscard]] std::string text() const;
};

struct Reader {
    Report& report;
    TreeBuilder& trees;
    std::size_t keys_left = 1'000'000;  ///< of all paths together, which prefabs multiply
};

template <class Choice, std::size_t Count>
using ChoiceNames = std::array<std::pair<std::string_view, Choice>, Count>;

class TableReader {
  public:
    TableReader(Reader& reader, const Value& table, const Where& where)
        : reader_(reader), table_(table), where_(where) {}

    [[nodiscard]] bool has(std::string_view key) const { return find(table_, key) != nullptr; }
    [[nodiscard]] bool is_number(std::string_view key) const;
    [[nodiscard]] const Value& table() const { return table_; }
    [[nodiscard]] const Where& where() const { return where_; }
    [[nodiscard]] Place place() const { return table_.place; }
    /// That of a key's value; of the table if it is not there.
    [[nodiscard]] Place place_of_value(std::string_view key) const;
    [[nodiscard]] std::string name(std::string_view key) const;
    [[nodiscard]] Reader& reader() { return reader_; }
    [[nodiscard]] Report& report() { return reader_.report; }

    bool number(std::string_view key, double& out, Interval allowed = {});
    bool number(std::string_view key, float& out, Interval allowed = {});
    bool number(std::string_view key, std::optional<float>& out, Interval allowed = {});
    bool count(std::string_view key, std::uint32_t& out, std::uint32_t low, std::uint32_t high);
    bool flag(std::string_view key, bool& out);
    bool text(std::string_view key, std::string& out, std::size_t longest = 4096);
    bool path(std::string_view key, std::filesystem::path& out);
    /// As an array, or as a table {x, y, z} whose missing members stay as they are.
    bool vector(std::string_view key, vec3& out, Interval allowed = {});
    /// [x, y, z, w], normalised.
    bool rotation_quaternion(std::string_view key, quat& out);
    /// [r, g, b], or {r, g, b}. A fourth number goes to `alpha`, and is a slip where there is none.
    bool color(std::string_view key, vec3& out, std::optional<float>* alpha = nullptr);
    bool color(std::string_view key, vec4& out);
    template <class Choice, std::size_t Count>
    bool choice(std::string_view key, Choice& out, const ChoiceNames<Choice, Count>& list);
    template <class Choice, std::size_t Count>
    bool choice(std::string_view key, std::optional<Choice>& out, const ChoiceNames<Choice, Count>& list,
                std::string_view current = "the default");
    /// The tables of an array of tables.
    [[nodiscard]] std::vector<Value> tables(std::string_view key);

    /// A key that is known and means nothing here.
    void pass_over(std::string_view key) { static_cast<void>(take(key)); }
    /// A slip about one key's value, which the text follows as "name = value: text". Nothing once a value of the table
    /// was of the wrong kind: what is compared then is not what the file says.
    void slip(std::string_view key, std::string_view text);
    /// Reports the keys that nobody asked for.
    void finish();

  private:
    const Value* take(std::string_view key);
    std::optional<double> number_of(const toml::node& node, Place place, std::string_view key, Interval allowed,
                                    std::string_view used);
    std::optional<double> number_at(std::string_view key, Interval allowed, std::string_view used);
    // Sets the numbers that are given, one bit each; 0 if there are none, or one is wrong.
    unsigned numbers_at(std::string_view key, std::span<float> out, std::string_view letters, std::size_t fewest,
                        Interval allowed);
    unsigned numbers_of_array(const Value& value, std::string_view key, std::span<float> out, std::string_view letters,
                              std::size_t fewest, Interval allowed);
    unsigned numbers_of_table(const Value& value, std::string_view key, std::span<float> out, std::string_view letters,
                              Interval allowed);
    std::optional<std::size_t> choice_at(std::string_view key, std::span<const std::string_view> names,
                                         std::string_view used);
    void wrong_kind(std::string_view key, const Value& value, std::string_view expected);
    std::string used(std::string_view what) const;

    Reader& reader_;
    const Value& table_;
    const Where& where_;
    std::vector<std::string_view> known_;
    std::size_t taken_ = 0;
    bool is_wrong_ = false;  ///< a value was of the wrong kind
};

template <class Choice, std::size_t Count>
bool TableReader::choice(std::string_view key, Choice& out, const ChoiceNames<Choice, Count>& list) {
    std::optional<Choice> chosen;
    const auto current = std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.second == out; });
    choice(key, chosen, list, current == list.end() ? std::string_view() : current->first);
    if (chosen) out = *chosen;
    return chosen.has_value();
}

template <class Choice, std::size_t Count>
bool TableReader::choice(std::string_view key, std::optional<Choice>& out, const ChoiceNames<Choice, Count>& list,
                         std::string_view current) {
    std::array<std::string_view, Count> names;
    std::transform(list.begin(), list.end(), names.begin(), [](const auto& item) { return item.first; });
    const std::optional<std::size_t> chosen = choice_at(key, names, current);
    if (chosen) out = list[*chosen].second;
    return chosen.has_value();
}

}  // namespace darkroom::scene::reading
